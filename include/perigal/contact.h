/* SPDX-License-Identifier: GPL-3.0-or-later
 * contact.h: bodies that touch, and the faces of closed cracks: unilateral contact with Coulomb's friction as
 * a small dense problem of complementarity, and the pieces of cracks that it is asked for.
 *
 * A *pair* of rows belongs to a piece of surface: its mean gap g_n (positive: open) and its mean slip g_t,
 * both linear in the displacement, g = g0 + G d. A force of the pair is conjugate to it: G' f acts on the
 * nodes, so that f_n >= 0 presses the two sides apart and f_t resists the slip. With K u = F + G' f,
 *
 *     g = g0 + C f,    C = G K^-1 G'  (symmetric, positive definite, m/N),    g0: without contact,
 *     g_n >= 0,  f_n >= 0,  f_n g_n = 0,    |f_t| <= mu f_n + c where f_n > 0,  a slip opposes f_t:
 *
 * the stiffness stays as it is, and only pairs of numbers remain (Signorini 1933; Coulomb; condensed as in
 * Klarbring 1986). Pairs in the plane: one normal, one tangent. */
#ifndef PERIGAL_CONTACT_H
#define PERIGAL_CONTACT_H
#include "perigal/fracture.h"

PG_API_BEGIN

/* ---- the problem of complementarity -------------------------------------------------------------------- */
/* How a pair stands: apart; together without slip; sliding towards positive or negative g_t. */
typedef enum { PG_CONTACT_OPEN, PG_CONTACT_STICK, PG_CONTACT_FORWARD, PG_CONTACT_BACKWARD } pg_contact_status;

/* All borrowed. Rows 2 k and 2 k + 1 are the normal and the tangent of pair k. */
typedef struct {
    size_t n;                                          /* pairs */
    const double *C;                                   /* compliance, m/N (2 n x 2 n, symmetric) */
    const double *gap;                                 /* g0: gaps and slips without contact, m (2 n) */
    const double *coefficient;                         /* of friction, mu >= 0 (n); NULL: none */
    const double *cohesion;                            /* c: force that a closed pair bears besides, N (n) */
    /* slip that there was before, m (n): a pair that sticks keeps it; NULL: none */
    const double *slip;
} pg_contact_problem;

/* What solves it; arrays of the caller's. */
typedef struct {
    double *force, *gap;                               /* f, N; g, m (2 n each) */
    unsigned char *status;                             /* pg_contact_status of each pair (n) */
    size_t open, stick, sliding;                       /* pairs of each kind */
    size_t sweeps, passes;                             /* of relaxation; of the active set */
    double violation;                                  /* of the worst condition (pg_contact_violation) */
} pg_contact_solution;

/* Solves it: relaxation of one pair after the other (projected Gauss-Seidel) finds how the pairs stand, a
 * dense solve with the conditions that belong to that makes it exact, until nothing changes. Conditions are
 * homogeneous but for c: k times the gaps give k times the forces. PG_E_EQUILIBRIUM: the pairs do not settle
 * (friction so high that there may be no equilibrium); PG_E_USAGE, PG_E_MEMORY. */
pg_status pg_contact_solve (pg_contact_solution *out, const pg_contact_problem *problem);
/* How far forces and gaps are from solving the problem: the largest of all violations, those of forces turned
 * into lengths by the diagonal of C, over the largest |g0|. */
double pg_contact_violation (const pg_contact_problem *problem, const pg_contact_solution *s);
PG_API_END
#endif
