/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: equilibrium by damped motion (theory B4 as corrected, C), for adr and relax. One iteration, with
 * masses m, a time step dt and damping c:
 *   v(n+1/2) = ((2 - c dt) v(n-1/2) + 2 dt r_n / m) / (2 + c dt), u_n+1 = u_n + dt v(n+1/2); from rest v(1/2)
 *     = dt r_0 / (2 m). Between iterations state->v is v(n-1/2), state->a the last residual (N); a balanced
 *     state shows both as 0. */
#ifndef PG_RELAXATION_H
#define PG_RELAXATION_H
#include "explicit.h"

enum { RELAXATION_NUMBERS = 7 };
struct relaxation {
    double *mass;                                      /* of every unknown (ndof) */
    /* masses anew where bonds that broke may have stiffened the body; NULL: never */
    pg_status (*weigh) (pg_solver *s);
    double *rate;                                      /* given damping, 1/s; NULL: c (ndof) */
    double dt, c;  /* s; damping, 1/s, by Rayleigh's quotient stiff / heavy */
    double stiff, heavy;  /* v K v dt and v M v of the last iterations, older ones count less */
    double floor;                                      /* hold: off: least c, 1/s */
    double imbalance, worst;                           /* of the last residual; hold: off: the largest */
    double reference;  /* of the imbalance now, N; not kept, as every look finds it anew */
    double most;  /* largest reference of a state that the load has come to, N */
    /* bonds may break; the next iteration starts from rest; the work balance at hand is that before the first
     * break of the stage and not booked; bonds broke at the last residual */
    int    armed, resting, pending, broke;
    /* c, imbalance, worst, most, stiff, heavy and floor at the start of the step at hand */
    double start[RELAXATION_NUMBERS];
    int    read;                                       /* 1: from a checkpoint, which has no masses */
};
static inline const pg_stages_options *stages_of (const pg_solver *s)
{
    return PG_OWN (pg_stages_options, &s->options);
}

/* ---- relaxation.c: the motion -------------------------------------------------------------------------- */
pg_status relaxation_create  (pg_solver *s);  /* motion_of (s)->relaxation; masses and dt are the caller's */
void      relaxation_free    (pg_solver *s);
pg_status relaxation_begin   (pg_solver *s, const pg_state *state);
pg_status relaxation_step    (pg_solver *s, pg_state *state, pg_step *step);
int       relaxation_done    (const pg_solver *s, const pg_state *state);
double    relaxation_progress (const pg_solver *s, const pg_state *state);
void      relaxation_refused (pg_solver *s);
pg_status relaxation_keep    (pg_solver *s, const pg_keeper *keeper);
pg_status relaxation_moved   (pg_solver *s, pg_state *state, const pg_moved *moved, int within);

/* ---- relaxation_damping.c ------------------------------------------------------------------------------ */
/* c from the sums v K v dt and v M v of this iteration and of those before. */
void      relaxation_damp    (struct relaxation *x, int hold, double stiff, double heavy);
/* The least damping of a body that follows its loads without being held, 1/s. */
double    relaxation_least_damping (const pg_solver *s, const pg_state *state);

/* ---- load_stages.c ------------------------------------------------------------------------------------- */
int       relaxation_breaks  (const pg_solver *s);
pg_status relaxation_stages  (pg_solver *s);           /* how many stages and steps; after masses and dt */
void      relaxation_read    (pg_solver_options *o, const pg_problem *problem, const pg_scene *scene);
const char *relaxation_manner (const pg_solver_options *o);
/* What both methods of relaxation share; name, summary, flags, keys, read and prepare are their own. */
#define RELAXATION_ENTRIES \
    .begin = relaxation_begin, .step = relaxation_step, .done = relaxation_done, \
    .refused = relaxation_refused, .free = relaxation_free, .keep = relaxation_keep, \
    .move = relaxation_moved, \
    .own_size = sizeof (motion), .stable = explicit_bound, .progress = relaxation_progress, \
    .manner = relaxation_manner
#endif
