/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: forces that follow from the dilatations of both ends of a bond, of state-based theory (Silling
 * et al. 2007; theory B6) and beside micropolar bonds (theory G3): q = sum w r^2 V, theta = (d / q) sum w
 * xi.eta V, t = (A theta / q) w r + (B / q) w e.eta, f = (t_i + t_j) e, w = k beta / r. Their K couples
 * neighbours of neighbours: there is its product, its diagonal and rows for preconditioners. */
#ifndef PG_DILATATION_H
#define PG_DILATATION_H
#include "bond_force.h"

typedef struct dilatation_rows dilatation_rows;        /* dilatation_rows.c */
typedef struct dilatation {
    /* of each point, Pa; beside micropolar bonds B is 0 (n) */
    double *A, *B;
    double *q;  unsigned long weighed;                 /* weighted volumes at that revision, m^5 (n) */
    /* C / q, C = B + d max (A, 0): bonds alone with the constant C_i / q_i + C_j / q_j are at least as
     * stiff as these forces (n) */
    double *stiff;
    unsigned char *counted;                            /* bonds that no pre-crack cuts; NULL: all */
    dilatation_rows *rows;                             /* of the last preconditioner, NULL until then */
} dilatation;
/* Sets b->dilatation, A and B still 0, and fills its part of b->setting. */
pg_status dilatation_create (bond_force *b);
void      dilatation_free   (bond_force *b);          /* b->dilatation may be NULL */
pg_status dilatation_weigh  (bond_force *b);  /* q and stiff of the live bonds; no dilatation: nothing */
/* bond_theory.find_dying */
pg_status dilatation_dying  (bond_force *b, const double *d, size_t *count);
/* k beta: dilatations know no factors of surfaces. */
double    dilatation_weight (const bond_force *b, size_t i, const point_bonds *s, size_t e);
/* Added to blocks: a pull along the bond with the constant `both`, N/m^6. */
void      dilatation_pull   (const bond_force *b, size_t i, const point_bonds *s, size_t e, double both,
                             double *own, double *other);
/* diagonal block of K */
void      dilatation_own    (const bond_force *b, size_t i, const point_bonds *s, double *D);
/* Of omega^2 times density, whatever bonds die. */
double    dilatation_bound  (const bond_force *b, size_t i, const point_bonds *s);
/* T += sum t x xi V, Pa. */
void      dilatation_virial (const bond_force *b, size_t i, const point_bonds *s, const unsigned char *alive,
                             const double *d, double *T);
pg_status dilatation_couplings (bond_force *b, pg_couplings *out);   /* row, alike and lattice of these */
void      dilatation_rows_free (bond_force *b);
#endif
