/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: Newmark's scheme as an object of its own, for the solver of that name and for motions that begin
 * when a static equilibrium is lost (instability.c). newmark.c: the step; newmark_start.c: where it starts,
 * and supports by elimination. */
#ifndef PG_SOLVE_NEWMARK_H
#define PG_SOLVE_NEWMARK_H
#include "solve/run/solve.h"

typedef struct {
    pg_system *system;                                 /* what moves: forces, masses, supports */
    pg_newmark_options setting;
    double     dt;                                     /* s */
    int        creeps;                                 /* 1: dt is no time, only a way to come to rest */
    /* 1: loads and supports stay as they are at the t of each step, which is then no time: a load factor */
    int        held;
    double    *work1, *work2, *work3, *work4;          /* room for vectors (ndof; work4: 3 x ndof) */
    double    *force0;  /* with alpha: loads less resistance at the last step's end, N */
    dynamics   dyn;                                    /* coefficients of the matrix */
    int        joined;  /* the residual to be completed has the damping by stiffness in it */
    double    *support;                                /* motion z, z', z'' of prescribed nodes (3 x ndof) */
    long       support_updates;  /* report.updates when it was found: breaking changes z */
} newmark;

/* Room for its vectors, and the mass; after the first refresh of the system, which is set already. */
pg_status newmark_open     (newmark *n);
void      newmark_close    (newmark *n);
/* Acceleration at the start from the loads at t, what resists and the motion of the supports. */
pg_status newmark_launch   (newmark *n, pg_state *state, double t);
/* Energies of the state (strain, kinetic, J) into the report, and its work balance, with inertia, as the last
 * one that work is counted from. */
pg_status newmark_account  (newmark *n, break_loop *b, const pg_state *state, double t);
/* One time step from the state `from` to loads at t: a guess, equilibrium with inertia and breaking, the
 * rates that belong to it. */
pg_status newmark_advance  (newmark *n, break_loop *b, const pg_state *from, pg_state *state, double t,
                            pg_step *step);
const dynamics *newmark_matrix (newmark *n);           /* what the factored matrix is made of */

pg_status newmark_supports (newmark *n, double t, int start);          /* fills `support` for time t */
/* V and A of prescribed nodes from support */
void      newmark_follow   (newmark *n, double t, double *v, double *a);
void      newmark_damp     (newmark *n, const double *v, double *residual);                   /* -= C v */
pg_status newmark_remember (newmark *n, double t, const pg_state *state);  /* fills force0 */
/* A knows nothing of contact: a less M^-1 G' f of the step's end. */
pg_status newmark_without_contact (newmark *n, double *a);
/* Gives back to V what faces lost that have met since `from`. */
pg_status newmark_rebound (newmark *n, const pg_state *from, double *v);
double    newmark_kinetic  (newmark *n, const double *v);              /* J */

/* Damping, mass and scheme from the scene, below this map; its other keys are the caller's. */
void      newmark_read_setting (pg_newmark_options *own, const pg_problem *problem, const pg_scene *scene,
                                const char *map);
#endif
