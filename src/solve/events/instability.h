/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: what a static run does where cracks grow on at an unchanged load (solver.on_instability): the
 * policies are in include/perigal/solve.h, the method in instability.c. */
#ifndef PG_SOLVE_INSTABILITY_H
#define PG_SOLVE_INSTABILITY_H
#include "solve/newmark/newmark_state.h"

typedef struct {                                       /* a part of the state of event stepping */
    newmark  scheme;
    int      phase;                                    /* PHASE_... of instability.c; 0: static */
    int      held;                                     /* 1: the last event was one at an unchanged load */
    long     count, settling;  /* instabilities so far; steps since this motion began to be damped away */
    double   time, last_break;  /* time of the motion, and of the last break in it, s */
    double   needed, dissipated;  /* energy that facets in dynamics took; that they dissipated, J */
    double   dt, quiet, longest;                       /* times of the options, completed, s */
    int      mode[2];  /* SYSTEM_...: how K (0) and K with the mass (1) were last solved */
    double  *before, *rest;  /* displacement before the event at hand; static one after it (ndof) */
    double  *reaction;                                 /* the last ones in the motion, N (nload x 3) */
} instability;

/* Reads solver.on_instability and solver.motion of the scene, after solver.stepping. */
void      instability_read  (pg_solver_options *o, const pg_problem *problem, const pg_scene *scene);
extern const pg_key_table instability_keys;
/* Prepares the treatment of instabilities, after the first refresh. */
pg_status instability_start (pg_solver *s, instability *u);
void      instability_free  (instability *u);
pg_status instability_keep  (pg_solver *s, instability *u, const pg_keeper *k);
pg_status instability_moved (pg_solver *s, instability *u, const pg_keeper *k);

/* over: intact bonds are over their limit at the present load. Returns 1: the load is held, and the worst of
 * them break; 0: the load goes to where they are at their limit. Counts instabilities. */
int       instability_holds (pg_solver *s, instability *u, int over);
/* Called before bonds of an event break at the state. */
void      instability_before (const pg_solver *s, instability *u, const pg_state *state);
/* Called after an event's bonds broke and its equilibria were looked for, outcome `solved`. *moves 1: the
 * body is in motion from now on, the state and its energies are those at the start of it, and the outcome
 * does not matter. */
pg_status instability_after (pg_solver *s, instability *u, pg_state *state, double factor, pg_status solved,
                             int *moves);
int       instability_moves (const instability *u);
/* Makes a time step of the motion that an instability has begun. */
pg_status instability_step  (pg_solver *s, instability *u, pg_state *state, pg_step *step);
/* Inertia and damping of the present motion, with its k K + m M; NULL in statics. */
const dynamics *instability_dynamics (instability *u);
#endif
