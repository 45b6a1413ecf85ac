/* SPDX-License-Identifier: GPL-3.0-or-later
 * Facets within event stepping: one event is one facet (or several that tie). Energy is accounted along
 * the path that growth takes: while the facet opens the load goes from lambda_k, where it began, to
 * lambda_k+1, where the next begins, so that it dissipates lambda_k lambda_k+1 times the drop at load
 * factor 1. At a fixed load the same facet would take more under forces, less under displacements: that
 * jump is not the equilibrium path. Where all that grew has ended in the surface or a crack there is no
 * such lambda_k+1: the path ends where the facet has taken its energy. So it does, with contact, where the
 * crack comes to rest, as one that is unloaded does: what lies between is no path of the crack. */
#include "event_stepping.h"
#include "solve/growth/facet_growth.h"
#include <math.h>
#include <string.h>

/* Finds the equilibria for the present bonds; a body cut in two may have none, which ends the run (*ended
 * 1). */
static pg_status solve_anew (pg_solver *s, pg_state *state, double factor, int *ended)
{
    pg_status status = PG_OK;
    event_stepping *e = events_of (s);
    break_loop *b = &s->break_loop;
    *ended = 0;
    PG_TRY (system_refresh (&b->system, state, &b->changes));
    e->balance_fresh = 0;
    pg_status now = event_solve (s);
    if (event_ended (s, state, factor, now)) {
        *ended = 1;
        if (!b->growth->event.closed) {
            b->growth->needed -= b->growth->event.energy;   /* their energy is not known */
            s->report.energy.fracture = b->growth->needed;
            goto done;
        }
        e->ended = PG_OK, s->finished = 1;
        pg_statistics_warn (
            &s->report,
            "the crack has cut the body, or a loaded part of it, off from its supports: the run "
            "ends at event %ld, load factor %.6g",
            state->events, factor);
        goto done;
    }
    status = now;
done:
    return status;
}

/* *end: load factor at which the next facet begins, at most full load; the present one where none does. A
 * held load does not fall. A new crack forms at once, at the load at which it is possible, as no equilibria
 * lead there. */
static pg_status way_end (pg_solver *s, pg_state *state, double factor, double *end)
{
    pg_status status = PG_OK;
    double next;
    int began = s->break_loop.growth->event.began, affine = events_of (s)->base != NULL;
    if (began && affine && s->break_loop.system.contact) {
        *end = factor;
        return affine_stay (s, state);
    }
    PG_TRY (event_measure (s, state));
    if (affine) PG_TRY (affine_next_growth (s, state, end));
    else {
        PG_TRY (event_next_growth (s, state, &next));
        *end = isfinite (next) ? fmin (next, fmax (factor, 1)) : factor;
    }
    if (s->options.on_instability != PG_UNSTABLE_FOLLOW) *end = fmax (*end, factor);
    if (began) *end = factor;
done:
    return status;
}

/* Accounts the work along the path from before the event at `factor` to after it at `end`, then back to
 * `factor`, which is elastic and has no effect on the dissipated energy. */
static pg_status account (pg_solver *s, pg_state *state, double factor, double end)
{
    pg_status status = PG_OK;
    const double ways[2] = { end, factor };
    if (events_of (s)->base && s->break_loop.system.contact) return affine_account (s, state, end);
    for (int k = 0; k < 2; k++) {
        event_displacement (s, ways[k], state->d);
        PG_TRY (event_account (s, state, ways[k], 0));
    }
done:
    return status;
}

/* Takes energy released beyond that of the event's facets out of the work where nothing grows on: it would be
 * motion, and is no work of static loads. */
static void take_no_more (pg_solver *s, pg_step *step)
{
    double more = step->dissipated - s->break_loop.growth->event.energy;
    if (more > 0) s->break_loop.work -= more, step->dissipated -= more;
}

/* Warns of a trial facet that cuts a loaded part off: its energy release has no bound, and its load is that
 * of rounding. */
static void doubt_load (pg_solver *s, pg_step *step)
{
    if (!s->break_loop.growth->event.tried) return;
    step->unjudged++;
    pg_statistics_warn (&s->report,
                        "the last facet cuts a loaded part of the body off from a tip without room for a "
                        "ring: the load that this part bears is not known; take a smaller spacing");
}

/* Ends the run after event_stops if the body has come apart. */
static void end_apart (pg_solver *s, int cut, double work, double strain, pg_step *step)
{
    if (!event_apart (s, cut, work, strain, step)) return;
    take_no_more (s, step);
    doubt_load (s, step);
}

/* Makes one event: facets, new equilibria, a new measurement, energies. The displacement of the state stays
 * that before the event, to which the reactions of the step belong. */
static pg_status facet_event (pg_solver *s, pg_state *state, double factor, pg_step *step)
{
    pg_status status = PG_OK;
    break_loop *b = &s->break_loop;
    facet_growth *g = b->growth;
    event_stepping *e = events_of (s);
    size_t bytes = state->ndof * sizeof *state->d;
    double strain = s->report.energy.strain, work = b->work, end, now;
    int ended = 0, more = 1, moves = 0;
    if (!g->before) PG_ALLOC (g->before, state->ndof);
    memcpy (g->before, state->d, bytes);
    instability_before (s, &e->unstable, state);
    if (s->options.on_instability == PG_UNSTABLE_DYNAMIC) PG_TRY (facet_hold_before (b, factor, state->d));
    PG_TRY (facet_grow (b, state, factor - stage_start (s), factor));
    step->event = 1;
    state->events++, s->report.events++;
    for (int closed = g->event.closed; more; closed |= g->event.closed) {
        g->event.closed |= closed;
        PG_TRY (solve_anew (s, state, factor, &ended));
        step->nbroken = b->nbroken, step->broken = b->broken;
        if (ended) break;
        PG_TRY (event_measure (s, state));
        PG_TRY (facet_run_out (b, state, factor, &more));
    }
    if (!s->finished) PG_TRY (instability_after (s, &e->unstable, state, factor, e->ended, &moves));
    if (moves) step->dissipated = b->work - work - (s->report.energy.strain - strain);
    if (ended) end_apart (s, 1, work, strain, step);
    if (ended || moves) goto done;
    PG_TRY (way_end (s, state, factor, &end));
    PG_TRY (account (s, state, factor, end));
    step->dissipated = b->work - work - (s->report.energy.strain - strain);
    if (!g->event.going || e->arrested) take_no_more (s, step);
    PG_TRY (event_secant (s, &now));
    memcpy (state->d, g->before, bytes);
    PG_TRY (event_stops (s, state, factor, now));
    if (!s->finished) s->finished = facet_measure_ends (s, state, factor);
    end_apart (s, 0, work, strain, step);
done:
    if (g->before) memcpy (state->d, g->before, bytes);
    return status;
}

const growth_client facet_client = { facet_free, facet_forward, facet_round, facet_event, facet_save,
                                     facet_return };
