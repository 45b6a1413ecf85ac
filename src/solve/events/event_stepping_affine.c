/* SPDX-License-Identifier: GPL-3.0-or-later
 * The next event under loads that are a constant part and factor lambda times another: between breaks d = d_0
 * + lambda (d_1 - d_0), with two equilibria, at lambda = 0 and 1. Every utilisation is convex in lambda (a
 * length, the largest eigenvalue, an energy of something affine), so that what a bond admits is an interval
 * of lambda: from a factor that all bonds admit there is one limit to each side, found by chords of every
 * bond and then by regula falsi on the largest. After a break no factor at or below the present one may be
 * left: then the constant part drives the crack, the factor is held and the worst bonds break one after the
 * other.
 *
 * With contact all this holds within a stretch, between two changes of status of pieces (contact_route.c):
 * base and unit are the line of the stretch at hand, a step goes from stretch to stretch, accounting work at
 * every change, and no state is ever found by interpolation across one. Upwards the faces go on from where
 * they are; the way back from a facet after which the crack does not rest is, with the facet, one increment
 * from the state before it. */
#include "solve/contact/contact.h"
#include "event_stepping.h"
#include "solve/growth/facet_growth.h"
#include <math.h>
#include <string.h>

static const double close = 1e-12;                     /* utilisation this close to its limit is at it */
enum { MOST_LOOKS = 80, MOST_THIRDS = 52 };

/* Finds the utilisation of every bond at this factor; *top: the largest. With facets: the largest alone. */
static pg_status look (pg_solver *s, pg_state *state, double factor, double *utilisation, double *top)
{
    pg_status status = PG_OK;
    break_loop *b = &s->break_loop;
    double t0 = pg_seconds ();
    event_displacement (s, factor, state->d);
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

/* The factor at which the first chord reaches the limit: all bonds are below it at `in` (b->factor), some are
 * not at `out` (b->utilisation). */
static double first_chord (const pg_solver *s, const pg_state *state, double in, double out)
{
    const break_loop *b = &s->break_loop;
    double share = 1;
    for (size_t i = 0; i < state->nbond; i++)
        if (b->utilisation[i] > 1 && break_loop_owns (b, i))
            share = fmin (share, (1 - fmin (b->factor[i], 1)) / (b->utilisation[i] - fmin (b->factor[i], 1)));
    return in - system_most (&b->system, -share) * (out - in);
}

/* Finds the limit between a factor that all bonds admit (but for rounding) and one that some do not;
 * b->utilisation is that at *factor. Regula falsi, Illinois variant. */
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

/* Lower bound of a convex function between the first and the last of four equidistant points with these
 * values: outside of its chord the function lies above it, so in the middle third above the outer chords, in
 * an outer third above the middle chord. */
static double least_of_convex (const double f[4])
{
    double outer = fmin (2 * f[1] - f[2], 2 * f[2] - f[1]);
    double fall = f[1] - f[0], rise = f[3] - f[2];         /* change over an outer third, by its chord */
    if (!(fall < 0 && rise > 0)) return fmin (outer, fmin (f[1], f[2]));
    double x = (f[2] - rise - f[1]) / (fall - rise);  /* their intersection, in thirds from the first one */
    return fmin (outer, f[1] + fall * fmin (fmax (x, 0), 1));
}

/* Searches a factor between `low` and `from` that all bonds admit, though these two are not admitted:
 * division in thirds of a convex function that is known at both ends. *found 0: there is none. */
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

/* Warns once that the constant loads drive the crack: it does not rest at any lower factor either. */
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

/* Makes base and unit those of the line that leads on from here. *leapt 1: forces and gaps jumped at its
 * start. */
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

/* Goes back from a facet after which the crack does not rest: down in total form from the present state to
 * the first stretch in which it rests, or the start of the stage. *in: factor at which it rests, *out: at
 * which it does not, both in that stretch. account 1: accounts the work of all changes on the way; 0: marks
 * them. */
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
        PG_TRY (event_measure (s, state));
        PG_TRY (look (s, state, *out, s->break_loop.factor, &here));
        PG_TRY (look (s, state, low, s->break_loop.factor, &there));
        if ((*found = there <= 1)) *in = low;
        else PG_TRY (search (s, state, low, *out, there, here, in, found));
        if (*found) break;
        event_displacement (s, low, state->d);
        PG_TRY (contact_route_go (sys, low));
        if (account) PG_TRY (event_account (s, state, low, 0));
        PG_TRY (contact_route_mark (sys));
        *out = low;
        if (low > start) PG_TRY (contact_route_behind (sys));
        *out = fmin (low, sys->contact->now.at);
    }
done:
    return status;
}

/* Goes back to the state of mark `first` by all marks after it, where the crack rests nowhere. */
static pg_status back_to_mark (pg_solver *s, pg_state *state, size_t first, int account)
{
    pg_status status = PG_OK;
    pg_system *sys = &s->break_loop.system;
    for (size_t k = contact_route_marks (sys); k-- > first;) {
        contact_route_return (sys, k, state->d);
        if (account) PG_TRY (event_account (s, state, sys->contact->now.at, 0));
    }
    if (s->break_loop.growth) s->break_loop.growth->fresh = 0;
done:
    return status;
}

/* Finds the largest factor below that of the state at which the crack rests. */
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
    PG_TRY (event_measure (s, state));
done:
    return status;
}

/* ---- the next event ------------------------------------------------------------------------------------ */
/* Finds the load below the present one at which the crack rests, where it does not rest now; else the load is
 * held. */
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

/* Finds the factor at which the next bonds break, pieces change their status, or the next level is reached;
 * *breaks 1: something breaks there. b->utilisation is that at *factor. arrived 1: this step has come up to
 * the present state. */
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
        event_displacement (s, now, state->d);
        PG_TRY (event_account (s, state, now, 0));
    }
    level = fmin (level, contact_route_end (&s->break_loop.system));
    *breaks = 0, *factor = state->step == 0 ? now : level;
    if (!b->growth && !break_loop_judges (b)) goto done;
    if (b->growth) PG_TRY (event_measure (s, state));
    else PG_TRY (break_loop_ready (b));
    PG_TRY (look (s, state, now, b->utilisation, &top));
    if (instability_holds (s, &events_of (s)->unstable, top > 1 + close)) {
        *breaks = 1, *factor = now, events_of (s)->bears = 0;
        goto done;
    }
    if (top <= 1 + close) {
        if (state->step == 0) goto done;
        PG_TRY (look (s, state, level, b->utilisation, &there));
        if (there <= fmax (top, 1) + close) goto done;     /* at rounding level no crack is driven */
        *breaks = 1;
        status = way_out (s, state, now, level, factor);
        goto done;
    }
    *breaks = 1, *factor = now;
    /* if it rested a moment ago, a change of status has altered what is known of it */
    if (!arrived) status = fall_back (s, state, top, factor);
done:
    return status;
}

/* Goes from stretch to stretch like the run, without accounting work, to where the next facet grows; sets
 * marks. */
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
        PG_TRY (event_measure (s, state));
        PG_TRY (look (s, state, at, s->break_loop.factor, &here));
        if (here > 1 && at == now) {
            PG_TRY (stretches_back (s, state, 0, &in, &out, &found));
            if (found) PG_TRY (way_out (s, state, in, out, end));
            else PG_TRY (back_to_mark (s, state, 0, 0));
            if (found) PG_TRY (contact_route_go (sys, *end));
            break;
        }
        if (here > 1 || !(at < full)) break;
        *end = fmin (full, contact_route_end (&s->break_loop.system));
        PG_TRY (look (s, state, *end, s->break_loop.factor, &there));
        if (there > 1) PG_TRY (way_out (s, state, at, *end, end));
        event_displacement (s, *end, state->d);
        PG_TRY (contact_route_go (sys, *end));
        PG_TRY (contact_route_mark (sys));
    }
    /* the crack comes to rest: the load stays, and so does the facet's energy at this load */
    if (!(here > 1) && !(there > 1)) {
        events_of (s)->arrested = 1, *end = now;
        contact_route_return (sys, 0, state->d);
        contact_route_forget (sys);
        if (s->break_loop.growth) s->break_loop.growth->fresh = 0;
        goto done;
    }
    event_displacement (s, *end, state->d);
done:
    return status;
}

pg_status affine_account (pg_solver *s, pg_state *state, double end)
{
    pg_status status = PG_OK;
    pg_system *sys = &s->break_loop.system;
    PG_TRY (event_account (s, state, end, 0));
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

/* *end: factor at which the next facet grows; from a state over its limit downwards, if the crack rests
 * there; else the present factor. */
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

/* 1: nothing grows on from this state at a held load, so that conditions of a stage may be checked. */
static int rests (const event_stepping *e) { return !e->driven && !e->unstable.held; }

pg_status affine_meets (pg_solver *s, const pg_state *state, const double *reaction, int *stops)
{
    return rests (events_of (s)) ? stage_meets (s, state, reaction, stops) : PG_OK;
}

pg_status affine_aim (pg_solver *s, pg_state *state, double level, int arrived, double *factor, int *breaks,
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
