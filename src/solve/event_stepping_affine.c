/* SPDX-License-Identifier: GPL-3.0-or-later
 * Event stepping under loads that are a constant part and factor lambda times another: between breaks d = d_0
 * + lambda (d_1 - d_0), with two equilibria, at lambda = 0 and 1. Every utilisation is convex in lambda (a
 * length, the largest eigenvalue, an energy of something affine), so that what a bond admits is an interval
 * of lambda: from a place that all bonds admit there is one way out to each side, found by chords of every
 * bond and then by regula falsi on the largest. After a break no place at or below the present factor may be
 * left: then the constant part drives the crack, the factor is held and the worst bonds break one after the
 * other.
 *
 * With contact all this holds within a stretch, between two changes of status of pieces (contact_route.c):
 * base and unit are the line of the stretch at hand, a step goes from stretch to stretch, accounting work at
 * every change, and no state is ever found by interpolation across one. Upwards the faces go on from where
 * they are; the way back from a facet after which the crack does not rest is, with the facet, one increment
 * from the state before it. */
#include "contact.h"
#include "event_stepping.h"
#include "facet_growth.h"
#include <math.h>
#include <string.h>

static const double close = 1e-12;                     /* of utilisation to its limit */
enum { MOST_LOOKS = 80, MOST_THIRDS = 52 };

/* Utilisation of every bond at this factor; *top the largest. Of facets the largest alone. */
static pg_status look (pg_solver *s, pg_state *state, double factor, double *utilisation, double *top)
{
    pg_status status = PG_OK;
    break_loop *b = &s->break_loop;
    double t0 = pg_seconds ();
    event_move (s, state, factor);
    if (b->growth) {
        *top = facet_utilisation (b, state, factor - stage_start (s));
        goto done;
    }
    PG_TRY (b->system.force->judge (b->system.self, state, state->d,
                                    &(pg_judging){ .utilisation = utilisation, .kind = b->kind }));
    *top = break_loop_largest (b, utilisation);
done:
    s->report.seconds[PG_SECONDS_BREAK] += pg_seconds () - t0;
    return status;
}

/* Where the first chord reaches the limit: at `in` all bonds are below it (b->factor), at `out` some are not
 * (b->utilisation). */
static double first_chord (const pg_solver *s, const pg_state *state, double in, double out)
{
    const break_loop *b = &s->break_loop;
    double share = 1;
    for (size_t i = 0; i < state->nbond; i++)
        if (b->utilisation[i] > 1 && break_loop_owns (b, i))
            share = fmin (share, (1 - fmin (b->factor[i], 1)) / (b->utilisation[i] - fmin (b->factor[i], 1)));
    return in - system_most (&b->system, -share) * (out - in);
}

/* The way out between a factor that all bonds admit (but for rounding) and one that some do not;
 * b->utilisation is that of *factor. Regula falsi after Illinois. */
static pg_status way_out (pg_solver *s, pg_state *state, double in, double out, double *factor)
{
    pg_status status = PG_OK;
    break_loop *b = &s->break_loop;
    double low, high, top;
    PG_TRY (look (s, state, in, b->factor, &low));
    PG_TRY (look (s, state, out, b->utilisation, &high));
    low = fmin (low - 1, 0), high -= 1;
    double at = b->growth ? in - low / (high - low) * (out - in) : first_chord (s, state, in, out);
    for (int k = 0, side = 0; k < MOST_LOOKS; k++) {
        *factor = at;
        PG_TRY (look (s, state, at, b->utilisation, &top));
        if (fabs (top - 1) <= close || fabs (out - in) <= 1e-15 * fmax (fabs (in), fabs (out))) break;
        if (top > 1) {
            out = at, high = top - 1;
            if (side > 0) low *= 0.5;
            side = 1;
        } else {
            in = at, low = top - 1;
            if (side < 0) high *= 0.5;
            side = -1;
        }
        at = in + low / (low - high) * (out - in);
        if (!(at > fmin (in, out) && at < fmax (in, out))) at = 0.5 * (in + out);
    }
done:
    return status;
}

/* The least that a convex function can be between the first and the last of four places at equal distances
 * where it has these values: it lies above each chord outside of it, so in the middle third above the outer
 * chords, in an outer third above the chord of the middle one. */
static double least_of_convex (const double f[4])
{
    double outer = fmin (2 * f[1] - f[2], 2 * f[2] - f[1]);
    double fall = f[1] - f[0], rise = f[3] - f[2];         /* of the outer chords, in a third */
    if (!(fall < 0 && rise > 0)) return fmin (outer, fmin (f[1], f[2]));
    double x = (f[2] - rise - f[1]) / (fall - rise);       /* where they meet, in thirds behind the first */
    return fmin (outer, f[1] + fall * fmin (fmax (x, 0), 1));
}

/* A factor between `low` and `from` that all bonds admit, though these are none: thirds of a convex function,
 * the values being known at both ends. *found 0: there is none. */
static pg_status search (pg_solver *s, pg_state *state, double low, double from, double at_zero,
                         double at_from, double *at, int *found)
{
    pg_status status = PG_OK;
    double high = from, f_low = at_zero, f_high = at_from, a, b, all = high - low;
    *found = 0;
    for (int k = 0; k < MOST_THIRDS && high - low > 1e-9 * all; k++) {
        double p = low + (high - low) / 3, q = high - (high - low) / 3;
        PG_TRY (look (s, state, q, s->break_loop.factor, &b));
        if ((*found = b <= 1)) *at = q;
        if (*found) break;
        PG_TRY (look (s, state, p, s->break_loop.factor, &a));
        if ((*found = a <= 1)) *at = p;
        if (*found || least_of_convex ((const double[4]) { f_low, a, b, f_high }) > 1) break;
        if (a < b) high = q, f_high = b;
        else low = p, f_low = a;
    }
done:
    return status;
}

/* Nothing below this factor bears its loads either. Told once. */
static void tell_driven (pg_solver *s, const pg_state *state, double factor)
{
    int facets = s->break_loop.growth != NULL;
    events_of (s)->driven = 1;
    if (events_of (s)->constant_events++) return;
    pg_statistics_warn (&s->report,
                        "at load factor %.6g, after event %ld, no lower factor lets %s: %s drive the crack, "
                        "which then runs at a held factor, %s (in truth a dynamic event)",
                        factor, state->events, facets ? "the crack rest" : "the remaining bonds live",
                        stage_start (s) > 0 ? "the loads of earlier stages" : "the constant loads",
                        facets ? "facet by facet" : "bond by bond");
}

/* ---- stretches between changes of status --------------------------------------------------------------- */
static struct system_contact *contact_of (const pg_solver *s) { return s->break_loop.system.contact; }

/* Work at the state at hand, whose forces of contact stand there too. */
static pg_status account_here (pg_solver *s, pg_state *state, double t)
{
    pg_status status = PG_OK;
    stage_bear (s, t);
    PG_TRY (break_loop_account (&s->break_loop, t, state->d, NULL, 0, 1));
    s->report.energy_strain = s->break_loop.work_balance.strain;
done:
    return status;
}

/* base and unit become the line that leads on from here. *leapt: forces and gaps have leapt at its start. */
static pg_status stretch_ahead (pg_solver *s, int *leapt)
{
    pg_status status = PG_OK;
    event_stepping *e = events_of (s);
    int fresh = 0;
    *leapt = 0;
    if (!contact_of (s)) return PG_OK;
    PG_TRY (contact_route_ahead (&s->break_loop.system, e->base, e->unit, &e->unit_residual, &fresh));
    if (fresh && s->break_loop.growth) s->break_loop.growth->fresh = 0;
    *leapt = fresh && contact_route_leapt (&s->break_loop.system);
done:
    return status;
}

static double stretch_end (const pg_solver *s)
{
    return contact_of (s) ? contact_route_end (&s->break_loop.system) : INFINITY;
}

/* Back from a facet that lets the crack not rest: down in total form from where the state is to the first
 * stretch in which it rests, or the start of the stage. *in: where it rests, *out: where it does not, both in
 * the stretch at hand. account: work of all changes on the way; else they are marked. */
static pg_status stretches_back (pg_solver *s, pg_state *state, int account, double *in, double *out,
                                 int *found)
{
    pg_status status = PG_OK;
    event_stepping *e = events_of (s);
    pg_system *sys = &s->break_loop.system;
    double here, there, start = stage_start (s);
    *found = 0, *out = sys->contact->now.at;
    while (*out > start && !*found) {
        PG_TRY (contact_route_back (sys, e->base, e->unit, &e->unit_residual));
        double low = fmax (start, contact_route_end (sys));
        s->break_loop.growth->fresh = 0;
        PG_TRY (facet_ready (s, state));
        PG_TRY (look (s, state, *out, s->break_loop.factor, &here));
        PG_TRY (look (s, state, low, s->break_loop.factor, &there));
        if ((*found = there <= 1)) *in = low;
        else PG_TRY (search (s, state, low, *out, there, here, in, found));
        if (*found) break;
        event_move (s, state, low);
        PG_TRY (contact_route_go (sys, low));
        if (account) PG_TRY (account_here (s, state, low));
        PG_TRY (contact_route_mark (sys));
        *out = low;
        if (low > start) PG_TRY (contact_route_behind (sys));
        *out = fmin (low, sys->contact->now.at);
    }
done:
    return status;
}

/* Where nothing lets the crack rest, back to where the state was, by the marks from that of it on. */
static pg_status back_to_mark (pg_solver *s, pg_state *state, size_t first, int account)
{
    pg_status status = PG_OK;
    pg_system *sys = &s->break_loop.system;
    for (size_t k = contact_route_marks (sys); k-- > first;) {
        contact_route_return (sys, k, state->d);
        if (account) PG_TRY (account_here (s, state, sys->contact->now.at));
    }
    if (s->break_loop.growth) s->break_loop.growth->fresh = 0;
done:
    return status;
}

/* The factor below that of the state at which the crack rests, and no stretch above it lets it rest. */
static pg_status rest_below (pg_solver *s, pg_state *state, double *factor, int *found)
{
    pg_status status = PG_OK;
    pg_system *sys = &s->break_loop.system;
    double in, out;
    int leapt;
    contact_route_forget (sys);
    PG_TRY (contact_route_mark (sys));
    PG_TRY (stretches_back (s, state, 1, &in, &out, found));
    if (*found) {
        PG_TRY (way_out (s, state, in, out, factor));
        goto done;
    }
    PG_TRY (back_to_mark (s, state, 0, 1));
    PG_TRY (stretch_ahead (s, &leapt));
    PG_TRY (facet_ready (s, state));
done:
    return status;
}

/* ---- one step ------------------------------------------------------------------------------------------ */
/* The loads in which the crack rests below the present one, where it does not; else the load is held. */
static pg_status fall_back (pg_solver *s, pg_state *state, double top, double *factor)
{
    pg_status status = PG_OK;
    break_loop *b = &s->break_loop;
    double now = state->factor, start = stage_start (s), there, in = start;
    int found = now > start;
    events_of (s)->bears = 0;
    if (contact_of (s) && found) PG_TRY (rest_below (s, state, factor, &found));
    else if (found) {
        PG_TRY (look (s, state, start, b->factor, &there));
        if (there > 1) PG_TRY (search (s, state, start, now, there, top, &in, &found));
        if (found) PG_TRY (way_out (s, state, in, now, factor));
    }
    if (found) goto done;
    *factor = now;
    tell_driven (s, state, now);
    PG_TRY (look (s, state, now, b->utilisation, &top));
done:
    return status;
}

/* Where the next bonds break, or pieces change their status, or the next level; *breaks: something breaks
 * there. b->utilisation is that of *factor. arrived: this step has come up to where the state is. */
static pg_status choose (pg_solver *s, pg_state *state, double level, int arrived, double *factor,
                         int *breaks)
{
    pg_status status = PG_OK;
    break_loop *b = &s->break_loop;
    double now = state->factor, top, there;
    int leapt;
    events_of (s)->driven = 0, events_of (s)->bears = 1;
    PG_TRY (stretch_ahead (s, &leapt));
    if (leapt) {
        event_move (s, state, now);
        PG_TRY (account_here (s, state, now));
    }
    level = fmin (level, stretch_end (s));
    *breaks = 0, *factor = state->step == 0 ? now : level;
    if (!b->growth && !break_loop_judges (b)) goto done;
    if (b->growth) PG_TRY (facet_ready (s, state));
    else PG_TRY (break_loop_ready (b));
    PG_TRY (look (s, state, now, b->utilisation, &top));
    if (instability_holds (s, &events_of (s)->unstable, top > 1 + close)) {
        *breaks = 1, *factor = now, events_of (s)->bears = 0;
        goto done;
    }
    if (top <= 1 + close) {
        if (state->step == 0) goto done;
        PG_TRY (look (s, state, level, b->utilisation, &there));
        if (there <= fmax (top, 1) + close) goto done;     /* rounding alone drives no crack */
        *breaks = 1;
        status = way_out (s, state, now, level, factor);
        goto done;
    }
    *breaks = 1, *factor = now;
    /* it rested a moment ago, and what is known of it has changed with a status */
    if (!arrived) status = fall_back (s, state, top, factor);
done:
    return status;
}

/* From stretch to stretch, as if the run went on, but for the work: marks are left on the way. */
static pg_status next_through_stretches (pg_solver *s, pg_state *state, double *end)
{
    pg_status status = PG_OK;
    pg_system *sys = &s->break_loop.system;
    double now = state->factor, full = stage_end (s), here, there = 0, in, out;
    int leapt, found;
    contact_route_forget (sys);
    PG_TRY (contact_route_mark (sys));
    *end = now, here = 0;
    for (double at = now; there <= 1 && (at == now || at < full); at = *end) {
        PG_TRY (stretch_ahead (s, &leapt));
        if (leapt) PG_TRY (contact_route_mark (sys));
        PG_TRY (facet_ready (s, state));
        PG_TRY (look (s, state, at, s->break_loop.factor, &here));
        if (here > 1 && at == now) {
            PG_TRY (stretches_back (s, state, 0, &in, &out, &found));
            if (found) PG_TRY (way_out (s, state, in, out, end));
            else PG_TRY (back_to_mark (s, state, 0, 0));
            if (found) PG_TRY (contact_route_go (sys, *end));
            break;
        }
        if (here > 1 || !(at < full)) break;
        *end = fmin (full, stretch_end (s));
        PG_TRY (look (s, state, *end, s->break_loop.factor, &there));
        if (there > 1) PG_TRY (way_out (s, state, at, *end, end));
        event_move (s, state, *end);
        PG_TRY (contact_route_go (sys, *end));
        PG_TRY (contact_route_mark (sys));
    }
    /* it comes to rest: the load stays, and the facet takes what it takes there */
    if (!(here > 1) && !(there > 1)) {
        events_of (s)->arrested = 1, *end = now;
        contact_route_return (sys, 0, state->d);
        contact_route_forget (sys);
        if (s->break_loop.growth) s->break_loop.growth->fresh = 0;
        goto done;
    }
    event_move (s, state, *end);
done:
    return status;
}

pg_status affine_account (pg_solver *s, pg_state *state, double end)
{
    pg_status status = PG_OK;
    pg_system *sys = &s->break_loop.system;
    PG_TRY (account_here (s, state, end));
    PG_TRY (back_to_mark (s, state, 0, 1));
    contact_route_forget (sys);
done:
    return status;
}

pg_status affine_stay (pg_solver *s, pg_state *state)
{
    pg_status status = PG_OK;
    pg_system *sys = &s->break_loop.system;
    events_of (s)->arrested = 0;
    contact_route_forget (sys);
    PG_TRY (contact_route_mark (sys));
    contact_route_return (sys, 0, state->d);
    contact_route_forget (sys);
done:
    return status;
}

/* From a place where something is over its limit the way is back, if there is one; it ends here else. */
pg_status affine_next_growth (pg_solver *s, pg_state *state, double *end)
{
    pg_status status = PG_OK;
    double now = state->factor, start = stage_start (s), full = stage_end (s), here, there;
    events_of (s)->arrested = 0;
    if (contact_of (s)) return next_through_stretches (s, state, end);
    *end = now;
    PG_TRY (look (s, state, now, s->break_loop.factor, &here));
    PG_TRY (look (s, state, here > 1 ? start : full, s->break_loop.factor, &there));
    if (here <= 1 && there <= 1) *end = fmax (now, full);
    else if (here <= 1) PG_TRY (way_out (s, state, now, full, end));
    else if (there <= 1) PG_TRY (way_out (s, state, start, now, end));
done:
    return status;
}

/* Breaks the bonds at their limit (and ties) at this load factor, solves both equilibria anew and accounts
 * the work at an unchanged load. */
static pg_status break_here (pg_solver *s, pg_state *state, double factor, pg_step *step)
{
    pg_status status = PG_OK;
    break_loop *b = &s->break_loop;
    const pg_solver_options *o = &s->options;
    double width = o->break_mode == PG_BREAK_FRACTION ? fmax (o->break_fraction, o->tie) : o->tie,
           top = break_loop_largest (b, b->utilisation), now;
    instability_before (s, &events_of (s)->unstable, state);
    PG_TRY (break_loop_kill (b, state, b->utilisation, (1 - width) * top, 1, factor));
    step->nbroken = b->nbroken, step->broken = b->broken, step->event = 1;
    state->events++, s->report.events++;
    double strain = s->report.energy_strain, work = b->work;
    PG_TRY (system_refresh (&b->system, state, &b->changes));
    pg_status solved = event_solve (s);
    int moves;
    PG_TRY (instability_after (s, &events_of (s)->unstable, state, factor, solved, &moves));
    if (moves) {
        step->dissipated = b->work - work - (s->report.energy_strain - strain);
        goto done;
    }
    if (event_ended (s, state, factor, solved)) goto done;
    PG_TRY (solved);
    event_move (s, state, factor);
    stage_bear (s, factor);
    PG_TRY (break_loop_account (b, factor, state->d, NULL, 0, 1));
    s->report.energy_strain = b->work_balance.strain;
    step->dissipated = b->work - work - (s->report.energy_strain - strain);
    PG_TRY (event_secant (s, &now));
    PG_TRY (event_stops (s, state, factor, now));
    event_apart (s, 0, work, strain, step);
done:
    return status;
}

/* The load has come to a level; the last one is the end of the stage, or of the run. A body that an event has
 * set in motion there comes to rest first, and the level is taken then. */
static void take_level (pg_solver *s, pg_step *step)
{
    int stages = s->stage.now.number > 0;
    if (stages && instability_moves (&events_of (s)->unstable)) return;
    step->level = 1;
    if (s->next_level++ < s->options.levels) return;
    if (!stages) s->finished = 1;
    else if (s->stage.now.over == STAGE_GOES_ON) s->stage.now.over = STAGE_LOADS;
}

/* A state from which nothing goes on at a held load: conditions of a stage may be asked of it. */
static int rests (const event_stepping *e) { return !e->driven && !e->unstable.held; }

/* Where this step goes, *breaks: to break something there; *stops: to end the stage, since a condition is met
 * by what the last event has left behind, or by a gauge on the way. */
static pg_status aim (pg_solver *s, pg_state *state, double level, int arrived, double *factor, int *breaks,
                      int *stops)
{
    pg_status status = PG_OK;
    event_stepping *e = events_of (s);
    double now = state->factor;
    *stops = 0;
    PG_TRY (choose (s, state, level, arrived, factor, breaks));
    if (*breaks && *factor > level) *factor = level;
    if (e->bears) PG_TRY (stage_meets (s, state, s->break_loop.work_balance.reaction, stops));
    if (*stops) *factor = now;
    else if (rests (e)) PG_TRY (stage_cross (s, state, e->base, e->unit, now, factor, stops));
done:
    return status;
}

/* The state at this factor, work and reactions there. */
static pg_status go_to (pg_solver *s, pg_state *state, double factor, pg_step *step)
{
    pg_status status = PG_OK;
    event_stepping *e = events_of (s);
    break_loop *b = &s->break_loop;
    event_move (s, state, factor);
    state->factor = state->time = step->factor = step->time = factor;
    e->top_factor = fmax (e->top_factor, factor);
    if (contact_of (s)) PG_TRY (contact_route_go (&b->system, factor));
    if (contact_of (s)) s->report.contact_changes += contact_route_due (&b->system);
    PG_TRY (account_here (s, state, factor));
    contact_accept (&b->system);
    if (b->work_balance.reaction)
        memcpy (s->reaction, b->work_balance.reaction,
                PG_REACTIONS * s->problem->nload * sizeof *s->reaction);
    if (state->step == 0 || (s->stage.now.number && e->secant0 == 0)) PG_TRY (event_secant (s, &e->secant0));
    step->residual = e->unit_residual;
done:
    return status;
}

/* How near to their limits bonds or facets are there. */
static pg_status judge (pg_solver *s, const pg_state *state, double factor, int breaks, pg_step *step)
{
    pg_status status = PG_OK;
    const event_stepping *e = events_of (s);
    break_loop *b = &s->break_loop;
    PG_TRY (contact_show (&b->system, 1));
    if (b->growth) {
        step->utilisation = facet_utilisation (b, state, factor - stage_start (s));
        step->unjudged = facet_unjudged (b, state, factor - stage_start (s));
        return facet_show (s, state, factor - stage_start (s));
    }
    if (!break_loop_judges (b)) return PG_OK;
    long over = break_loop_over (b, state, 1, &step->utilisation);
    /* at a held factor they are about to break */
    if ((!e->constant_events && !e->unstable.held) || !breaks) s->report.bonds_over_limit += over;
done:
    return status;
}

/* One step: to the next break or level, in either direction; at load factor 0 first, where the constant
 * part acts alone. */
pg_status affine_step (pg_solver *s, pg_state *state, pg_step *step)
{
    pg_status status = PG_OK;
    event_stepping *e = events_of (s);
    break_loop *b = &s->break_loop;
    double level = stage_level (s), factor;
    int breaks, stops, start = state->step == 0, changes = 1;
    b->nbroken = 0;
    step->iterations = 1;
    for (int k = 0; changes; k++) {
        PG_TRY (aim (s, state, level, k > 0, &factor, &breaks, &stops));
        step->instability = e->unstable.held ? e->unstable.count : 0;
        PG_TRY (go_to (s, state, factor, step));
        changes = contact_of (s) && !start && !breaks && !stops && factor < level;
    }
    PG_TRY (judge (s, state, factor, breaks, step));
    if (!stops && rests (e)) PG_TRY (stage_meets (s, state, s->reaction, &stops));
    if (breaks && !stops)
        PG_TRY (b->growth ? facet_event (s, state, factor, step) : break_here (s, state, factor, step));
    if (start) step->level = 1;
    else if (!(level > factor)) take_level (s, step);
    event_limit (s, state, factor);
done:
    return status;
}
