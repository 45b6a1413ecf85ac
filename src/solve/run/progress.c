/* SPDX-License-Identifier: GPL-3.0-or-later
 * How far a run has come towards its end; event stepping: towards the nearest of the ends that it may come
 * to. */
#include "solve.h"
#include <math.h>

/* Keeps the end that is nearest, that with the largest share. */
void progress_offer (pg_progress *p, double share, const char *end, int even)
{
    if (p->end && !(share > p->share)) return;
    p->share = fmin (1, fmax (0, share)), p->end = end, p->even = even;
}

/* Progress of a run; of methods without a function for it: steps done over all steps. */
void pg_solver_progress (const pg_solver *s, const pg_state *state, pg_progress *out)
{
    const pg_solver_options *o = &s->options;
    const break_loop *b = &s->break_loop;
    *out = (pg_progress) { .event = o->event, .stiffness = NAN, .damage = NAN };
    if (o->stop_set && b->looked) out->damage = b->nearest;
    if (s->type->progress)
        progress_offer (out, s->type->progress (s, state),
               (o->flags & PG_SOLVER_EXPLICIT) ? "the time steps" : "the stages", 1);
    else if (!o->event)
        progress_offer (out, (double) state->step / (double) o->steps,
               (o->flags & PG_SOLVER_QUASI_STATIC) ? "the load" : "the time", 1);
    if (s->type->ends) s->type->ends (s, state, out);
}
