/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: Newmark's scheme as an object of its own, for the solver of that name and for dynamic phases that
 * begin when a static equilibrium is lost (instability.c). newmark.c: the step; newmark_start.c: its start,
 * and supports by elimination. */
#ifndef PG_SOLVE_NEWMARK_H
#define PG_SOLVE_NEWMARK_H
#include "solve/run/solve.h"

typedef struct {
    pg_system *system;                                 /* what moves: forces, masses, supports */
    pg_newmark_options setting;
    double     dt;                                     /* time step, s */
    int        creeps;  /* 1: dt is no physical time, steps only lead to rest */
    /* 1: loads and supports stay as they are at the t of each step, which is then a load factor */
    int        held;
    double    *work1, *work2, *work3, *work4;          /* workspaces (ndof; work4: 3 x ndof) */
    double    *force0;  /* with alpha: loads less resistance at the last step's end, N */
    dynamics   dyn;                                    /* k and m of the matrix */
    int        joined;  /* 1: the residual already contains the damping by stiffness */
    double    *support;                                /* z, z', z'' of prescribed nodes (3 x ndof) */
    long       support_updates;  /* report.linear.updates when `support` was found: breaking changes z */
} newmark;

/* Allocates its vectors and finds the mass, after the first refresh of `system`, which the caller has set. */
pg_status newmark_open     (newmark *n);
void      newmark_close    (newmark *n);
/* Finds the acceleration at the start from the loads at t, the internal and damping forces and the motion of
 * the supports. */
pg_status newmark_launch   (newmark *n, pg_state *state, double t);
/* Puts strain and kinetic energy, J, of the state into the report, and makes its work balance, with inertia,
 * the last one that work is counted from. */
pg_status newmark_account  (newmark *n, break_loop *b, const pg_state *state, double t);
/* Advances by one time step from the state `from` to loads at t: first guess, equilibrium with inertia and
 * breaking, velocities and accelerations. */
pg_status newmark_advance  (newmark *n, break_loop *b, const pg_state *from, pg_state *state, double t,
                            pg_step *step);
const dynamics *newmark_matrix (newmark *n);           /* coefficients of the factored matrix */

pg_status newmark_supports (newmark *n, double t, int start);          /* fills `support` for time t */
/* Sets V and A of prescribed nodes from `support`. */
void      newmark_follow   (newmark *n, double t, double *v, double *a);
void      newmark_damp     (newmark *n, const double *v, double *residual);  /* residual -= C v */
pg_status newmark_remember (newmark *n, double t, const pg_state *state);  /* force0 = forces of the state */
/* a -= M^-1 G' f of the contact forces f in the equations at the end of the step, as A does not contain
 * contact. */
pg_status newmark_without_contact (newmark *n, double *a);
/* Gives the energy that faces meeting since `from` have lost back to the velocities v. */
pg_status newmark_rebound (newmark *n, const pg_state *from, double *v);
double    newmark_kinetic  (newmark *n, const double *v);              /* kinetic energy, J */

/* Reads damping, mass and scheme from the map `map` of the scene; its other keys are the caller's. */
void      newmark_read_setting (pg_newmark_options *own, const pg_problem *problem, const pg_scene *scene,
                                const char *map);
#endif
