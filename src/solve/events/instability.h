/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: what a static run does where growth goes on by itself, at the load at which it began
 * (solver.on_instability): the policies are in include/perigal/solve.h, the method in instability.c. */
#ifndef PG_SOLVE_INSTABILITY_H
#define PG_SOLVE_INSTABILITY_H
#include "solve/newmark/newmark_state.h"

typedef struct {                                       /* a part of the state of event stepping */
    newmark  scheme;
    int      phase;                                    /* PHASE_... of instability.c; 0: at rest */
    int      held;                                     /* 1: the last event was one at a held load */
    long     count, settling;  /* instabilities so far; steps of settling in this motion */
    double   time, last_break;                         /* since the motion began, s */
    double   needed, dissipated;                       /* by facets in motion, in all, J */
    double   dt, quiet, longest;                       /* s, as settled */
    int      mode[2];  /* how K (0) and K with the mass (1) were last solved: SYSTEM_... */
    double  *before, *rest;  /* displacement before the event at hand, and at rest after it (ndof) */
    double  *reaction;                                 /* the last ones in motion, N (nload x 3) */
} instability;

/* solver.on_instability and solver.motion of the scene; once solver.stepping is read. */
void      instability_read  (pg_solver_options *o, const pg_problem *problem, const pg_scene *scene);
extern const pg_key_table instability_keys;
/* After the first refresh. */
pg_status instability_start (pg_solver *s, instability *u);
void      instability_free  (instability *u);
pg_status instability_keep  (pg_solver *s, instability *u, const pg_keeper *k);
pg_status instability_moved (pg_solver *s, instability *u, const pg_keeper *k);

/* over: bonds that live are over their limit at the present load. 1: it is to be held, and the worst of them
 * break; 0: the load goes where they are at their limit. Counts instabilities. */
int       instability_holds (pg_solver *s, instability *u, int over);
/* Before bonds of an event die at the state. */
void      instability_before (const pg_solver *s, instability *u, const pg_state *state);
/* After they died and the equilibria without them were looked for, with this outcome. *moves 1: the body is
 * in motion from now on, the state and its energies are those at the start of it, and the outcome is of no
 * matter. */
pg_status instability_after (pg_solver *s, instability *u, pg_state *state, double factor, pg_status solved,
                             int *moves);
int       instability_moves (const instability *u);
/* A time step of the motion. */
pg_status instability_step  (pg_solver *s, instability *u, pg_state *state, pg_step *step);
/* Inertia and damping of the motion at hand, with its k K + m M; NULL at rest. */
const dynamics *instability_dynamics (instability *u);
#endif
