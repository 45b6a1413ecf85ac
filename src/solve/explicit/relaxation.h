/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: equilibrium by damped motion (dynamic relaxation; theory B4 as corrected, C), for adr and relax.
 * One iteration, with masses m, a time step dt and damping c: v(n+1/2) = ((2 - c dt) v(n-1/2) + 2 dt r_n / m)
 * / (2 + c dt), u_n+1 = u_n + dt v(n+1/2); the first one from rest: v(1/2) = dt r_0 / (2 m). Between
 * iterations state->v is v(n-1/2), state->a the last residual (N); a balanced state has both 0. */
#ifndef PG_RELAXATION_H
#define PG_RELAXATION_H
#include "explicit.h"

enum { RELAXATION_NUMBERS = 7 };
struct relaxation {
    double *mass;  /* of every unknown (ndof): fictitious (adr), or that of the body, kg (relax) */
    /* sets the masses again after breaking, which may have stiffened the body; NULL: never */
    pg_status (*weigh) (pg_solver *s);
    double *rate;                                      /* given damping, 1/s; NULL: c (ndof) */
    double dt, c;  /* s; damping, 1/s, by Rayleigh's quotient stiff / heavy */
    double stiff, heavy;  /* sums v K v dt and v M v of the last iterations, with decreasing weight */
    double floor;                                      /* hold: off: smallest c, 1/s */
    double imbalance, worst;  /* residual over reference, the last one; hold: off: the largest */
    /* reference force of the present imbalance, N; not in checkpoints, as every look finds it again */
    double reference;
    double most;  /* largest reference force of a state under the full load of its stage, N */
    /* armed 1: bonds may break; resting 1: the next iteration starts from rest; pending 1: the work balance
     * at hand is that before the first break of the stage and not booked; broke 1: bonds broke at the last
     * residual */
    int    armed, resting, pending, broke;
    /* c, imbalance, worst, most, stiff, heavy and floor at the start of the step at hand */
    double start[RELAXATION_NUMBERS];
    int    read;                                       /* 1: read from a checkpoint, which has no masses */
};
static inline const pg_stages_options *stages_of (const pg_solver *s)
{
    return PG_OWN (pg_stages_options, &s->options);
}

/* ---- relaxation.c: the motion -------------------------------------------------------------------------- */
pg_status relaxation_create  (pg_solver *s);  /* fills motion_of (s)->relaxation; masses, dt: the caller */
void      relaxation_free    (pg_solver *s);
pg_status relaxation_begin   (pg_solver *s, const pg_state *state);
pg_status relaxation_step    (pg_solver *s, pg_state *state, pg_step *step);
int       relaxation_done    (const pg_solver *s, const pg_state *state);
double    relaxation_progress (const pg_solver *s, const pg_state *state);
void      relaxation_refused (pg_solver *s);
pg_status relaxation_keep    (pg_solver *s, const pg_keeper *keeper);
pg_status relaxation_moved   (pg_solver *s, pg_state *state, const pg_moved *moved, int within);

/* ---- relaxation_damping.c ------------------------------------------------------------------------------ */
/* Sets c by the sums v K v dt and v M v of this iteration and of those before. */
void      relaxation_damp    (struct relaxation *x, int hold, double stiff, double heavy);
/* Smallest damping of a body whose stages are not held until they balance (hold: off), 1/s. */
double    relaxation_least_damping (const pg_solver *s, const pg_state *state);

/* ---- load_stages.c ------------------------------------------------------------------------------------- */
int       relaxation_breaks  (const pg_solver *s);
pg_status relaxation_stages  (pg_solver *s);           /* sets number of stages, steps, after masses and dt */
void      relaxation_read    (pg_solver_options *o, const pg_problem *problem, const pg_scene *scene);
const char *relaxation_manner (const pg_solver_options *o);
/* Entries that both methods of relaxation share; name, summary, flags, keys, read and prepare are their
 * own. */
#define RELAXATION_ENTRIES \
    .begin = relaxation_begin, .step = relaxation_step, .done = relaxation_done, \
    .refused = relaxation_refused, .free = relaxation_free, .keep = relaxation_keep, \
    .move = relaxation_moved, \
    .own_size = sizeof (motion), .stable = explicit_bound, .progress = relaxation_progress, \
    .manner = relaxation_manner
#endif
