/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: exact equilibria after bonds broke, from the factor of an earlier stiffness.
 *
 * At the *base* the stiffness A (after elimination of supports) was factored, and the displacements u_b of
 * all load cases were in equilibrium. Since then refreshes have changed K by W D W', where the columns of W
 * select the t *touched* unknowns and D (t x t, symmetric) is summed up from what the force says it has
 * changed (pg_force_type.change), and the constant forces by W p. With G = A^-1 W (n x t, the Green
 * columns) and H = W' G the displacement is u = u_b + G x, and what is not balanced is W r with
 *
 *     r = p - x - D u_T,    u_T = (u_b)_T + H x;                        (t numbers, for each load case)
 *
 * each event solves (1 + D H) dx = r and adds dx to x, so that errors of earlier events are corrected and do
 * not add up, and what nothing holds any more stays where the last event left it. No sparse matrix is
 * touched. A Green column is computed when its unknown is touched for the first time, by a solve with the
 * factor, together with all others that an event touches.
 *
 * When t grows so far that the dense algebra since the base has cost more than a new base would (counted, by
 * stored rates: rent or buy), the solver says that a new base is due; the caller decides when. Nothing here
 * depends on a clock, and of threads only BLAS knows.
 *
 * A block of events: the solution of each event is kept as its x (t numbers a case) from one
 * event_solver_base or event_solver_flush to the next, so that displacements of many events can be asked for
 * together (event_solver_block), and the solver can go back to any of them (event_solver_back). */
#ifndef PG_EVENT_SOLVER_H
#define PG_EVENT_SOLVER_H
#include "solve.h"

typedef struct event_solver event_solver;

/* What the bonds that broke have done to the equilibria. */
typedef enum {
    EVENT_SAME,                                        /* neither K nor forces changed: u stays */
    EVENT_SOLVED,                                      /* u is the new equilibrium */
    EVENT_DUE,  /* u is the new equilibrium; a new base would pay now */
    /* Not solved, a new base is needed: the force cannot tell its change, elimination (T) changed, too many
     * touched unknowns, or a result that the residual does not bear out. */
    EVENT_LOST
} event_outcome;

enum { EVENT_CASES = 2, EVENT_MOST = 64 };             /* most load cases; most events of a block */

/* A solver for the system of a run. cases: 1 (load factor 1) or 2 (load factors 0 and 1): time[c] is the load
 * factor of case c; 0 (time NULL): a motion. *out NULL: not available (solver.plain, no matrix, a force
 * without `change`). */
pg_status event_solver_create (event_solver **out, pg_system *s, int cases, const double *time);
void      event_solver_free   (event_solver **e);
/* Other load factors of both cases: the base is of no use any more where they differ. */
void      event_solver_at     (event_solver *e, double first, double second);

/* A new base: K of the last refresh is factored if it is stale, and u[c] (ndof, full unknowns, first guesses
 * on entry) become equilibria of it by system_solve, with its failures; *residual: the larger one. The
 * block is empty. There may be no base afterwards, where the system has come to be
 * solved without a factor: then every update is lost. */
pg_status event_solver_base   (event_solver *e, double *const *u, double *residual);
int       event_solver_has_base (const event_solver *e);
/* A base of a motion: the factor at hand is that of k K + m M, and there are no load cases, only what
 * event_solver_correct gives. */
pg_status event_solver_follow (event_solver *e, double k, double m);
/* After system_refresh, of such a base: takes in what K lost, with nothing to be solved for. */
pg_status event_solver_note   (event_solver *e, event_outcome *outcome);
size_t    event_solver_touched (const event_solver *e);        /* unknowns touched since the base */
double    event_solver_filled  (const event_solver *e);        /* touched unknowns over the most allowed */
/* Columns and dense algebra since the base, in seconds by stored rates. */
double    event_solver_spent   (const event_solver *e);
/* The base is of no use any more. */
void      event_solver_drop     (event_solver *e);

/* After system_refresh: takes in what K lost and solves for the new equilibria. The event is the next one of
 * the block. EVENT_LOST leaves u as it was. */
pg_status event_solver_update (event_solver *e, event_outcome *outcome);
/* Why the last update was lost or a base is due: static text. */
const char *event_solver_why  (const event_solver *e);

/* ---- the solution of the last update ------------------------------------------------------------------- */
/* From now on displacements of these nodes will be asked for, after every update: their rows of G are kept
 * together, so that all of them are one product of a small matrix and x. Sorted, and copied. */
pg_status event_solver_watch  (event_solver *e, size_t n, const int *node);
/* Unknowns of the watched nodes, in their order, of a case: n x components. */
pg_status event_solver_watched (event_solver *e, int which, double *u);
/* The whole displacement of a case, ndof. */
pg_status event_solver_full   (event_solver *e, int which, double *u);
/* Displacement u of a case (ndof); *residual: by the force itself, over the reference force. Above `enough` u
 * and the base are corrected once; of the block's events no displacement may be asked for then: flush it. */
pg_status event_solver_settle (event_solver *e, int which, double enough, double *u, double *residual);
/* K^-1 r of any reduced residual, delta (nred): a solve with the base factor, corrected for D. */
pg_status event_solver_correct (event_solver *e, const double *r, double *delta);
/* What the last update left unbalanced on the touched unknowns, over the reference force of the base. */
double    event_solver_residual (const event_solver *e);

/* ---- blocks of events ---------------------------------------------------------------------------------- */
/* Events since the base or the last flush; the next one is number `count`. A block holds EVENT_MOST. */
int       event_solver_count  (const event_solver *e);
/* Forgets the events of the block; the solution and D stay. */
pg_status event_solver_flush  (event_solver *e);
/* Whole displacements of events list[0..n-1] of the block for one case, u[unknown * n + k]: the unknowns of a
 * node side by side, event by event within each, so that loops over k are contiguous. Event -1: that before
 * the first one of the block. */
pg_status event_solver_block  (event_solver *e, int which, int n, const int *list, double *u);
/* Back to the solution of event k of the block (-1: before its first). The caller has refreshed the force
 * with the bonds of the later events alive again; the change of K is taken in here. */
pg_status event_solver_back   (event_solver *e, int k, event_outcome *outcome);

/* ---- for checkpoints ----------------------------------------------------------------------------------- */
/* Base, D, x: a run that is read back goes on bit by bit. After reading, and after the force and the factor
 * of the base (system.base: the bonds that lived then) were made again, event_solver_restore follows before
 * anything else is asked for. */
pg_status event_solver_keep   (event_solver *e, const pg_keeper *k);
pg_status event_solver_restore (event_solver *e);
#endif
