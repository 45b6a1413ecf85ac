/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: exact equilibria after bonds broke, from the factor of an earlier stiffness.
 *
 * At the base of the inverse (symbols as in inverse.h) the displacements u_b of all load cases
 * were in equilibrium. Since then refreshes have changed K by W D W', and the constant forces by W p. The
 * displacement is u = u_b + G x, and the residual is W r with
 *
 *     r = p - x - D u_T,    u_T = (u_b)_T + H x;                        (t numbers, for each load case)
 *
 * each event solves (1 + D H) dx = r and adds dx to x, so that errors of earlier events are corrected and do
 * not add up, and what nothing holds any more stays where the last event left it.
 *
 * A block of events: the solution of each event is kept as its x (t numbers a case) from one
 * event_solver_base or event_solver_flush to the next, so that displacements of many events can be asked for
 * together (event_solver_block), and the solver can go back to any of them (event_solver_back). */
#ifndef PG_EVENT_SOLVER_H
#define PG_EVENT_SOLVER_H
#include "solve/system/inverse.h"

enum { EVENT_CASES = 2, EVENT_MOST = 64 };             /* most load cases; most events of a block */

/* A load case; vectors of touched unknowns have length event_solver.room. */
typedef struct {
    double  time;                                      /* load factor of the case */
    double *base, *constant;                           /* u_b; residual of u = 0 at the base, N (ndof) */
    double *x, *p;                                     /* force numbers x and p of the head of this file, N */
    double *q;  /* part of the residual that a correction of the base leaves, N: added to p */
    double *old;                                       /* x before the last update */
    double *u;                                         /* displacement of the touched unknowns, m */
    double *X[EVENT_MOST + 1];  /* x of events of the block, zero beyond tX; number 0: before the first */
} event_case;

typedef struct event_solver {
    inverse *inverse;
    int      cases;
    event_case of[EVENT_CASES];
    size_t   room;
    double  *r;                                        /* workspace (room) */
    double   scale;                                    /* reference force at the base, N */
    double   residual;                                 /* residual of the last update over scale */
    int      count;                                    /* number of events of the block */
    size_t   tX[EVENT_MOST + 1];                       /* number of touched unknowns at each event */
    /* watched nodes; their rows of G (node by node, components x t), the first `filled` columns of which are
     * made */
    int     *watched;  size_t nwatched, filled;
    double  *rows;  size_t room_rows;
} event_solver;

/* Creates a solver for the system of a run. cases: 1 (load factor 1) or 2 (load factors 0 and 1): time[c] is
 * the load factor of case c. *out NULL: not available (solver.plain, no matrix, a force without `change`). */
pg_status event_solver_create (event_solver **out, pg_system *s, int cases, const double *time);
void      event_solver_free   (event_solver **e);
/* Sets other load factors of both cases; the base is given up where they differ. */
void      event_solver_at     (event_solver *e, double first, double second);

/* Makes a new base: K of the last refresh is factored if it is stale, and u[c] (ndof, full unknowns, first
 * guesses on entry) become its equilibria by system_solve, with the failures of that; *residual: the larger
 * one. The block is empty. Where the system is now solved without a factor there is no base afterwards, and
 * every update is lost. */
pg_status event_solver_base   (event_solver *e, double *const *u, double *residual);
int       event_solver_has_base (const event_solver *e);
/* Gives up the base. */
void      event_solver_drop     (event_solver *e);

/* Called after system_refresh: takes in what K lost and solves for the new equilibria. The event is the next
 * one of the block. INVERSE_SAME, INVERSE_LOST: u is as it was; lost also if the residual contradicts the
 * result. */
pg_status event_solver_update (event_solver *e, inverse_outcome *outcome);

/* ---- the solution of the last update ------------------------------------------------------------------- */
/* Sets the nodes whose displacements will be asked for after every update: their rows of G are kept together,
 * so that all are one product of a small matrix and x. Sorted; copied. */
pg_status event_solver_watch  (event_solver *e, size_t n, const int *node);
/* u = unknowns of the watched nodes of a case, in their order (n x components). */
pg_status event_solver_watched (event_solver *e, int which, double *u);
/* u = whole displacement of a case (ndof). */
pg_status event_solver_full   (event_solver *e, int which, double *u);
/* u = displacement of a case (ndof); *residual: measured by the force itself, over the reference force. Where
 * it is above `enough` u and the base are corrected once; then the block's events have no displacements any
 * more: flush it. */
pg_status event_solver_settle (event_solver *e, int which, double enough, double *u, double *residual);

/* ---- blocks of events ---------------------------------------------------------------------------------- */
/* Forgets the events of the block, which are those since the base or the last flush (at most EVENT_MOST); the
 * solution and D stay. */
pg_status event_solver_flush  (event_solver *e);
/* u = whole displacements of events list[0..n-1] of the block for one case, u[unknown * n + k]: the unknowns
 * of a node side by side, event by event within each, so that loops over k are contiguous. Event -1: before
 * the first one of the block. */
pg_status event_solver_block  (event_solver *e, int which, int n, const int *list, double *u);
/* Goes back to the solution of event k of the block (-1: before its first). The caller has refreshed the
 * force with the bonds of the later events intact again; the change of K is taken in here. */
pg_status event_solver_back   (event_solver *e, int k, inverse_outcome *outcome);

/* ---- for checkpoints ----------------------------------------------------------------------------------- */
pg_status event_solver_keep   (event_solver *e, const pg_keeper *k);
pg_status event_solver_restore (event_solver *e);  /* makes again what is not kept, as inverse_restore does */
#endif
