/* SPDX-License-Identifier: GPL-3.0-or-later
 * Event stepping: from one break to the next. Between breaks everything is linear in the load factor lambda,
 * so that d = lambda d_1 and the factor of the next break follows in closed form (theory F6): go there, break
 * the bonds that reach their limit (ties included), solve for the new d_1, and so on; levels that the user
 * wants are reported as they are passed. Loads that have a constant part need two equilibria, at the ends
 * of a line, and the next break is looked for on it (event_stepping_affine.c); all else is the same. */
#include "solve/contact/contact.h"
#include "event_stepping.h"
#include "solve/growth/facet_growth.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

static const double rounding = 1e-12;                  /* relative rounding of a load factor */

/* Finds the displacement of the intact body at load factor 1, with affine loads that at 0 too. A run that
 * goes on from a state begins with its displacement. */
pg_status event_start (pg_solver *s, const pg_state *state)
{
    pg_status status = PG_OK;
    event_stepping *e = events_of (s);
    int affine = PG_OWN (pg_static_options, &s->options)->affine;
    if (!e->unit) PG_ALLOC (e->unit, state->ndof);
    if (affine && !e->base) PG_ALLOC (e->base, state->ndof);
    if (affine) {
        memcpy (e->unit, state->d, state->ndof * sizeof *e->unit);
        memcpy (e->base, state->d, state->ndof * sizeof *e->base);
    } else
        for (size_t i = 0; state->factor != 0 && i < state->ndof; i++)
            e->unit[i] = state->d[i] / state->factor;
    if (!s->break_loop.growth && !s->break_loop.system.contact && !pg_problem_removes (s->problem)
        && !e->engine)
        PG_TRY (event_solver_create (&e->engine, &s->break_loop.system, affine ? 2 : 1,
                                     affine ? (const double[2]) { 0, 1 } : (const double[2]) { 1, 0 }));
    PG_TRY (event_solve (s));
done:
    return status;
}

/* Finds the equilibria by the event solver: from the last ones where it knows the change, else from a new
 * base. */
static pg_status solve_by_engine (event_stepping *e)
{
    pg_status status = PG_OK;
    double *const u[2] = { e->base ? e->base : e->unit, e->unit };
    inverse_outcome outcome = INVERSE_LOST;
    if (event_solver_has_base (e->engine)) PG_TRY (event_solver_update (e->engine, &outcome));
    if (outcome == INVERSE_SAME) return PG_OK;
    if (outcome != INVERSE_LOST) {
        for (int c = 0; c < (e->base ? 2 : 1); c++) PG_TRY (event_solver_full (e->engine, c, u[c]));
        e->unit_residual = fmax (e->engine_residual, e->engine->residual);
    }
    if (outcome == INVERSE_TAKEN) return PG_OK;
    PG_TRY (event_solver_base (e->engine, u, &e->engine_residual));
    e->unit_residual = e->engine_residual;
done:
    return status;
}

/* Finds the equilibria for the present bonds. Affine loads: one factorization, two solves. */
pg_status event_solve (pg_solver *s)
{
    pg_status status = PG_OK;
    event_stepping *e = events_of (s);
    double first = 0, second;
    pg_system *sys = &s->break_loop.system;
    if (e->engine) {
        event_solver_at (e->engine, e->base ? stage_start (s) : stage_end (s), stage_end (s));
        return solve_by_engine (e);
    }
    if (e->base && sys->contact)
        return contact_route_begin (sys, stage_start (s), e->base, e->unit, &e->unit_residual);
    stage_bear (s, stage_start (s));
    if (e->base) PG_TRY (system_solve (sys, stage_start (s), e->base, NULL, &first));
    stage_bear (s, stage_end (s));
    PG_TRY (system_solve (sys, stage_end (s), e->unit, NULL, &second));
    e->unit_residual = fmax (first, second);
done:
    return status;
}

/* d = displacement at a load factor: linear between those at 0 and 1, or at both ends of a stage. */
void event_displacement (const pg_solver *s, double factor, double *d)
{
    const event_stepping *e = events_of (s);
    double share = factor - stage_start (s);
    for (size_t i = 0; i < s->break_loop.system.ndof; i++)
        d[i] = !e->base     ? factor * e->unit[i]
               : share == 1 ? e->unit[i]
                            : e->base[i] + share * (e->unit[i] - e->base[i]);
}

/* Begins a stage of loading: the state is the equilibrium at which the last one ended, from which `base` and
 * `unit` are found again. */
static pg_status begin_stage (pg_solver *s, pg_state *state, double ended)
{
    pg_status status = PG_OK;
    event_stepping *e = events_of (s);
    size_t n = s->break_loop.system.ndof;
    /* share of the previous stage that had been loaded when it ended, 0 to 1 */
    const double share = ended - stage_start (s) + 1;
    for (size_t i = 0; i < n; i++)
        e->base[i] = e->unit[i] = e->base[i] + share * (e->unit[i] - e->base[i]);
    s->break_loop.system.balance.borne =
        fmax (s->break_loop.system.balance.borne, s->break_loop.system.balance.reference);
    memcpy (state->d, e->base, n * sizeof *state->d);
    PG_TRY (stage_remove (s, state));
    e->balance_fresh = 0, e->secant0 = 0;
    if (s->break_loop.system.contact) s->break_loop.system.contact->now.at = stage_start (s);
    if (s->break_loop.growth) s->break_loop.growth->fresh = 0;
    PG_TRY (event_solve (s));
done:
    return status;
}

/* Resets unit and base to the state, as displacements of a failed attempt may be anything; the work balance
 * at hand is no longer that of `unit`. */
void event_equilibrium_lost (pg_solver *s, const pg_state *state)
{
    event_stepping *e = events_of (s);
    double scale = e->base || state->factor == 0 ? 1 : 1 / state->factor;
    for (size_t i = 0; i < state->ndof; i++) e->unit[i] = scale * state->d[i];
    if (e->base) memcpy (e->base, state->d, state->ndof * sizeof *e->base);
    if (e->engine) event_solver_drop (e->engine);
    e->balance_fresh = 0;
}

pg_status event_account (pg_solver *s, const pg_state *state, double factor, int rest)
{
    pg_status status = PG_OK;
    event_stepping *e = events_of (s);
    break_loop *b = &s->break_loop;
    double scale = e->base ? 1 : factor;
    if (e->base) {
        stage_bear (s, factor);
        PG_TRY (break_loop_account (b, factor, state->d, NULL, 0, 1));
    } else if (e->balance_fresh) PG_TRY (break_loop_book (b, factor));
    else PG_TRY (break_loop_account (b, 1, e->unit, NULL, rest, factor));
    e->balance_fresh = 1;
    s->report.energy.strain = scale * scale * b->work_balance.strain;
done:
    return status;
}

/* Work per squared load factor. Proportional loads: from the balance at hand, which is that of `unit`; affine
 * ones: from the differences between load factors 1 and 0. */
pg_status event_secant (pg_solver *s, double *out)
{
    pg_status status = PG_OK;
    event_stepping *e = events_of (s);
    pg_system *sys = &s->break_loop.system;
    const pg_work_balance *b = &s->break_loop.work_balance;
    pg_work_balance zero = { 0 }, one = { 0 };
    *out = 0;
    for (size_t k = 0; !e->base && k < b->npair; k++) *out += b->force[k] * b->displacement[k];
    if (!e->base) *out += platens_secant (sys);
    if (e->base && sys->force->work) {
        PG_TRY (sys->force->work (sys->self, stage_start (s), e->base, NULL, &zero));
        PG_TRY (sys->force->work (sys->self, stage_end (s), e->unit, NULL, &one));
    }
    for (size_t k = 0; k < one.npair; k++)
        *out += (one.force[k] - zero.force[k]) * (one.displacement[k] - zero.displacement[k]);
    *out = system_sum (sys, *out);                     /* each rank has the pairs of its own points */
done:
    pg_work_balance_clear (&zero), pg_work_balance_clear (&one);
    return status;
}

/* 1: there is no equilibrium after a break. This is no error yet, as the event itself is a result: the reason
 * is kept for the step that cannot be made. */
int event_ended (pg_solver *s, const pg_state *state, double factor, pg_status now)
{
    event_stepping *e = events_of (s);
    if (!system_no_equilibrium (now)) return 0;
    e->ended = now;
    snprintf (e->why, sizeof e->why, "after event %ld at load factor %.6g: %s", state->events, factor,
              pg_last_error ());
    return 1;
}

/* solver.stop.stiffness; if 0, the run ends only where the body bears no load at all. */
static double least_share (const pg_solver *s)
{
    return fmax (PG_OWN (pg_static_options, &s->options)->stop_stiffness, 1e-12);
}

/* Ends the run where the crack has arrived at a set of points, or the body bears (almost) no load any more by
 * its work per squared load factor. Under forces that is a compliance, which grows instead of falling. */
pg_status event_stops (pg_solver *s, const pg_state *state, double factor, double secant)
{
    pg_status status = PG_OK;
    event_stepping *e = events_of (s);
    const pg_solver_options *o = &s->options;
    int arrived;
    PG_TRY (break_loop_arrived (&s->break_loop, state, state->d, &arrived));
    if (arrived) {
        pg_statistics_warn (&s->report,
                            "the crack has arrived at %s: the run ends at event %ld, load factor %.6g",
                            o->stop_set->name, state->events, factor);
        s->finished = 1;
    }
    double least = PG_OWN (pg_static_options, o)->stop_stiffness;
    double share = e->secant = secant / e->secant0;
    if (s->problem->boundary.nload && stage_moves (s)
        && (share < least || share > 1 / least_share (s))) {
        pg_statistics_warn (&s->report, "the body has separated: the run ends at event %ld, load factor %.6g",
                            state->events, factor);
        s->finished = 1;
    }
done:
    return status;
}

/* 1: the body has come apart. Nothing holds its parts: the displacement at load factor 1 is as large as the
 * rounding of K allows, and so are its energies, which are replaced. */
int event_apart (pg_solver *s, int cut, double work, double strain, pg_step *step)
{
    if (!s->finished || !(cut || events_of (s)->secant > 1 / least_share (s))) return 0;
    s->break_loop.work = work, s->report.energy.strain = 0;
    step->dissipated = strain;
    return 1;
}

/* Ends the run at solver.max_events. */
void event_limit (pg_solver *s, const pg_state *state, double factor)
{
    if (state->events < s->options.max_events) return;
    pg_statistics_warn (&s->report, "stopped after solver.max_events = %ld events at load factor %.6g",
                        state->events, factor);
    s->finished = 1;
}

/* At a held load: finds the utilisation of the state itself, in b->factor, by which the worst bonds break. */
static pg_status worst_here (pg_solver *s, const pg_state *state, double *top, double *scale)
{
    pg_status status = PG_OK;
    break_loop *b = &s->break_loop;
    PG_TRY (b->system.force->judge (b->system.self, state, state->d,
                                    &(pg_judging){ .utilisation = b->utilisation, .kind = b->kind }));
    memcpy (b->factor, b->utilisation, state->nbond * sizeof *b->factor);
    *top = break_loop_largest (b, b->factor), *scale = 1;
done:
    return status;
}

/* Breaks the bonds at their limit and those within the tie; proportional loads: by the load factors at which
 * they reach it. scale: factor of the utilisation kept. */
static pg_status kill_at (pg_solver *s, pg_state *state, double factor, double scale)
{
    pg_status status = PG_OK;
    event_stepping *e = events_of (s);
    break_loop *b = &s->break_loop;
    const pg_solver_options *o = &s->options;
    double width = o->break_mode == PG_BREAK_FRACTION ? fmax (o->break_fraction, o->tie) : o->tie;
    double *here = e->base ? b->utilisation : b->factor, top = e->base ? break_loop_largest (b, here) : 1;
    for (size_t i = 0; !e->base && i < state->nbond; i++) here[i] = here[i] > 0 ? factor / here[i] : 0;
    if (!e->base && e->unstable.held) PG_TRY (worst_here (s, state, &top, &scale));
    instability_before (s, &e->unstable, state);
    PG_TRY (break_loop_kill (b, state, NULL, here, (1 - width) * top, scale, factor));
    ahead_forget (e->ahead);
done:
    return status;
}

/* Breaks what reaches its limit at `factor`, finds the equilibria after it and accounts the work at an
 * unchanged load; without an equilibrium the next step is refused. Events that were found ahead have their
 * bonds and equilibria already. */
static pg_status break_at (pg_solver *s, pg_state *state, double factor, double scale, pg_step *step)
{
    pg_status status = PG_OK, now = PG_OK;
    event_stepping *e = events_of (s);
    break_loop *b = &s->break_loop;
    int ahead = ahead_waits (e->ahead), moves;
    double stiff;
    if (ahead) PG_TRY (ahead_kill (s, state));
    else PG_TRY (kill_at (s, state, factor, scale));
    step->nbroken = b->nbroken, step->broken = b->broken, step->event = 1;
    state->events++, s->report.events++;
    double strain = s->report.energy.strain, work = b->work;
    PG_TRY (system_refresh (&b->system, state, &b->changes));
    e->balance_fresh = 0;
    if (ahead) PG_TRY (ahead_take (s));
    else now = event_solve (s);
    PG_TRY (instability_after (s, &e->unstable, state, factor, now, &moves));
    if (moves) {
        step->dissipated = b->work - work - (s->report.energy.strain - strain);
        goto done;
    }
    if (event_ended (s, state, factor, now)) goto done;
    PG_TRY (now);
    if (e->base) event_displacement (s, factor, state->d);
    PG_TRY (event_account (s, state, factor, 1));
    step->dissipated = b->work - work - (s->report.energy.strain - strain);
    PG_TRY (event_secant (s, &stiff));
    PG_TRY (event_stops (s, state, factor, stiff));
    event_apart (s, 0, work, strain, step);
done:
    return status;
}

/* 1: the utilisation of the worst bond is proportional to the load factor, so that its critical factor is
 * exact. With finite stretch it is only nearly so. */
static int grows_in_proportion (const break_loop *b, const pg_state *state)
{
    double top = break_loop_largest (b, b->utilisation), off = 0;
    size_t worst = 0;
    while (worst < state->nbond && !(b->utilisation[worst] == top && break_loop_owns (b, worst))) worst++;
    if (worst < state->nbond) off = fabs (b->utilisation[worst] * b->factor[worst] - 1);
    return !(system_most (&b->system, off) > 1e-9);
}

/* Finds the utilisation of the accepted state: under proportional loads from that of the unit displacement,
 * independent of the closed form of the factor; where it is not linear (finite stretch) at the state itself.
 * *scale: factor of the utilisation kept. */
static pg_status look_over (pg_solver *s, const pg_state *state, double factor, int breaks, double *scale,
                            pg_step *step)
{
    pg_status status = PG_OK;
    const event_stepping *e = events_of (s);
    break_loop *b = &s->break_loop;
    double share = factor - stage_start (s);
    *scale = e->base ? 1 : factor;
    PG_TRY (contact_show (&b->system, *scale));
    if (b->growth) {
        step->utilisation = facet_utilisation (b, state, share);
        step->unjudged = facet_unjudged (b, state, share);
        return facet_show (s, state, share);
    }
    if (!break_loop_judges (b)) return PG_OK;
    long over = break_loop_over (b, state, *scale, &step->utilisation);
    int some = system_most (&b->system, (double) over) > 0;
    if (!e->base && (some || !grows_in_proportion (b, state))) {
        *scale = 1;
        PG_TRY (b->system.force->judge (b->system.self, state, state->d,
                                        &(pg_judging){ .utilisation = b->utilisation, .kind = b->kind }));
        over = break_loop_over (b, state, *scale, &step->utilisation);
    }
    /* at a held factor bonds over the limit are about to break */
    if ((!e->constant_events && !e->unstable.held) || !breaks) s->report.bonds_over_limit += over;
done:
    return status;
}

/* Finds the reactions of all loads from the balance at hand. */
static void take_reactions (pg_solver *s, double factor)
{
    const double *at_hand = s->break_loop.work_balance.reaction, scale = events_of (s)->base ? 1 : factor;
    for (size_t k = 0; at_hand && k < PG_REACTIONS * s->problem->boundary.nload; k++)
        s->reaction[k] = scale * at_hand[k];
}

pg_status event_rest (pg_solver *s, pg_state *state, double factor)
{
    pg_status status = PG_OK;
    double stiff;
    events_of (s)->balance_fresh = 0;
    event_displacement (s, factor, state->d);
    PG_TRY (event_account (s, state, factor, 1));
    take_reactions (s, factor);
    PG_TRY (event_secant (s, &stiff));
    PG_TRY (event_stops (s, state, factor, stiff));
done:
    return status;
}

/* ---- growth by facets ---------------------------------------------------------------------------------- */
/* Measures the tips at the present equilibria, unless they are measured. */
pg_status event_measure (pg_solver *s, const pg_state *state)
{
    const event_stepping *e = events_of (s);
    if (s->break_loop.growth->fresh) return PG_OK;
    return facet_measure (&s->break_loop, state, e->base, e->unit, stage_end (s));
}

/* *next = load factor of the next growth. Under proportional loads everything grows with the load factor. */
pg_status event_next_growth (pg_solver *s, const pg_state *state, double *next)
{
    pg_status status = PG_OK;
    PG_TRY (event_measure (s, state));
    double top = facet_utilisation (&s->break_loop, state, 1);
    *next = top > 0 ? 1 / top : INFINITY;
done:
    return status;
}

/* ---- one step ------------------------------------------------------------------------------------------ */
/* Proportional loads: finds the smallest load factor at which a bond or a facet reaches its limit, or the
 * next level, whichever comes first; *breaks 1: something breaks there. */
static pg_status aim_in_proportion (pg_solver *s, pg_state *state, double level, double *factor, int *breaks,
                                    pg_step *step)
{
    pg_status status = PG_OK;
    event_stepping *e = events_of (s);
    break_loop *b = &s->break_loop;
    double next = INFINITY;
    if (!ahead_waits (e->ahead)) PG_TRY (ahead_look (s, state, level));
    double t0 = pg_seconds ();
    if (b->growth) PG_TRY (event_next_growth (s, state, &next));
    else if (ahead_waits (e->ahead)) next = ahead_factor (e->ahead, &step->utilisation);
    else if (break_loop_judges (b)) {
        PG_TRY (break_loop_ready (b));
        PG_TRY (b->system.force->judge (b->system.self, state, e->unit,
                       &(pg_judging){ .utilisation = b->utilisation, .kind = b->kind, .factor = b->factor }));
        next = break_loop_smallest (b, b->factor);
    }
    s->report.seconds[PG_SECONDS_BREAK] += pg_seconds () - t0;
    int over = next < state->factor * (1 - rounding);
    if (instability_holds (s, &e->unstable, over)) next = state->factor;
    *breaks = next <= level, *factor = next < level ? next : level;
done:
    return status;
}

/* Goes to the state at this factor; finds work and reactions there. */
static pg_status go_to (pg_solver *s, pg_state *state, double factor, pg_step *step)
{
    pg_status status = PG_OK;
    event_stepping *e = events_of (s);
    pg_system *sys = &s->break_loop.system;
    int changes = e->base && sys->contact;
    event_displacement (s, factor, state->d);
    state->factor = state->time = step->factor = step->time = factor;
    e->top_factor = fmax (e->top_factor, factor);
    if (changes) PG_TRY (contact_route_go (sys, factor));
    if (changes) s->report.contact.changes += contact_route_due (sys);
    PG_TRY (event_account (s, state, factor, 1));
    if (e->base) contact_accept (sys);
    take_reactions (s, factor);
    if (e->secant0 == 0) PG_TRY (event_secant (s, &e->secant0));
    step->residual = e->unit_residual;
done:
    return status;
}

/* Takes the level that the load has reached; the last one ends the stage, or the run. A body that an event
 * has set in motion there comes to rest first. */
static void take_level (pg_solver *s, const pg_state *state, pg_step *step)
{
    int stages = s->stage.now.number > 0;
    if (stages && instability_moves (&events_of (s)->unstable)) return;
    step->level = 1;
    if (s->next_level++ < s->options.levels) return;
    if (!stages) s->finished = 1;
    else if (s->stage.now.over == STAGE_GOES_ON) s->stage.now.over = STAGE_LOADS;
    if (!events_of (s)->base && state->events == 0 && s->options.levels > 1)
        pg_statistics_skip (&s->report,
                            (double) (s->options.levels - 1) * s->report.seconds[PG_SECONDS_SOLVE],
                            "solves of all levels but one",
                            "no bond broke: the answer is linear in the load factor");
}

/* Goes to the next break or level, up or down, through changes of contact status, and breaks what is at its
 * limit. Loads with a constant part begin at load factor 0, where that part acts alone. */
static pg_status to_next_event (pg_solver *s, pg_state *state, pg_step *step)
{
    pg_status status = PG_OK;
    event_stepping *e = events_of (s);
    break_loop *b = &s->break_loop;
    double level = stage_level (s), factor, scale = 1;
    int breaks, stops = 0, goes_on = 1, start = e->base && state->step == 0;
    b->nbroken = 0;
    step->iterations = 1;
    for (int k = 0; goes_on; k++) {
        if (!e->base) PG_TRY (aim_in_proportion (s, state, level, &factor, &breaks, step));
        else PG_TRY (affine_aim (s, state, level, k > 0, &factor, &breaks, &stops));
        step->instability = e->unstable.held ? e->unstable.count : 0;
        PG_TRY (go_to (s, state, factor, step));
        goes_on = e->base && b->system.contact && !start && !breaks && !stops && factor < level;
    }
    if (!ahead_waits (e->ahead)) PG_TRY (look_over (s, state, factor, breaks, &scale, step));
    if (e->base && !stops) PG_TRY (affine_meets (s, state, s->reaction, &stops));
    if (breaks && !stops)
        PG_TRY (b->grower ? b->grower->event (s, state, factor, step)
                          : break_at (s, state, factor, scale, step));
    if (start) step->level = 1;
    else if (!(level > factor)) take_level (s, state, step);
    event_limit (s, state, factor);
    if (s->finished) ahead_tell (s);
done:
    return status;
}

pg_status event_step (pg_solver *s, pg_state *state, pg_step *step)
{
    pg_status status = PG_OK;
    event_stepping *e = events_of (s);
    facet_growth *g = s->break_loop.growth;
    if (e->engine) PG_TRY (event_solver_restore (e->engine));
    if (g && s->break_loop.round == 0) g->needed0 = g->needed;
    if (instability_moves (&e->unstable)) return instability_step (s, &e->unstable, state, step);
    if (e->ended != PG_OK) return pg_error (e->ended, PG_HERE, "%s", e->why);
    double ended = state->factor;
    if (stage_next (s, state)) PG_TRY (begin_stage (s, state, ended));
    else if (e->lost) PG_TRY (event_solve (s));
    e->lost = 0;
    PG_TRY (to_next_event (s, state, step));
done:
    return status;
}

/* ---- the run ------------------------------------------------------------------------------------------- */
void event_free (pg_solver *s)
{
    event_stepping *e = events_of (s);
    pg_free (e->unit), pg_free (e->base);
    ahead_free (&e->ahead);
    event_solver_free (&e->engine);
    instability_free (&e->unstable);
}

/* Makes the measurement and the displacements invalid after a refused step, which may have solved for those
 * without the bonds that it broke: they are found again when the step is repeated. (d of the state does not
 * help: it is the one before its last bonds broke.) A motion has its own; a run that has ended fails before
 * it has changed anything. */
void event_refused (pg_solver *s)
{
    event_stepping *e = events_of (s);
    facet_growth *g = s->break_loop.growth;
    ahead_refused (e->ahead);
    if (s->options.event && e->ended == PG_OK && !instability_moves (&e->unstable)) {
        event_equilibrium_lost (s, s->backup);
        e->lost = 1;
    }
    if (g) g->fresh = 0, g->needed = s->report.energy.fracture = g->needed0;
}

/* Offers the ends of event stepping: full load, max_events or a damage; the nearest tells the progress. */
void event_ends (const pg_solver *s, const pg_state *state, pg_progress *out)
{
    const pg_solver_options *o = &s->options;
    const break_loop *b = &s->break_loop;
    const event_stepping *e = events_of (s);
    if (!o->event) return;
    if (e->secant > 0) out->stiffness = e->secant;
    double stages = s->problem->boundary.nstage ? (double) s->problem->boundary.nstage : 1;
    progress_offer (out,
                    fmax (e->top_factor, stage_start (s) + (double) (s->next_level - 1) / (double) o->levels)
                        / stages,
                    "the load", state->events == 0);
    if (s->problem->criterion->type)
        progress_offer (out, (double) state->events / (double) o->max_events, "max_events", 1);
    if (o->stop_set && b->nearest > b->nearest0)
        progress_offer (out, (b->nearest - b->nearest0) / (o->stop_damage - b->nearest0), "stop.damage", 0);
}

/* Keeps the reason of an end that was found already, residuals, the first stiffness. *unit 1: the
 * displacement at load factor 1 is kept too. */
static pg_status keep_ends (event_stepping *e, int *unit, const pg_keeper *k)
{
    pg_status status = PG_OK;
    *unit = e->unit != NULL;
    PG_TRY (pg_keep_fields (k, "event_stepping", "counts", "numbers", 1, PG_ROWS (
        PG_KEPT_IN (e->ended, 0, 63, "the end of the run"), PG_KEPT (e->balance_fresh), PG_KEPT (*unit),
        PG_KEPT (e->constant_events), PG_KEPT (e->lost), PG_KEPT (e->unit_residual), PG_KEPT (e->secant0))));
    PG_TRY (pg_keep_text (k, "event_stepping.why", sizeof e->why, e->why));
done:
    return status;
}

/* Checkpoint of event stepping: its ends, and the displacements at load factor 1 (and 0). */
pg_status event_keep (pg_solver *s, const pg_keeper *k)
{
    pg_status status = PG_OK;
    event_stepping *e = events_of (s);
    size_t ndof = s->break_loop.system.ndof;
    int unit;
    PG_TRY (keep_ends (e, &unit, k));
    if (unit && e->unit) PG_TRY (k->numbers (k->context, "event_stepping.unit", ndof, e->unit));
    if (e->base) PG_TRY (k->numbers (k->context, "event_stepping.base", ndof, e->base));
    PG_TRY (ahead_keep (s, k));
    if (e->engine) {
        event_solver_at (e->engine, e->base ? stage_start (s) : stage_end (s), stage_end (s));
        PG_TRY (k->numbers (k->context, "event_stepping.engine", 1, &e->engine_residual));
        PG_TRY (event_solver_keep (e->engine, k));
    }
    PG_TRY (facet_keep (&s->break_loop, k));
    PG_TRY (instability_keep (s, &e->unstable, k));
done:
    return status;
}

/* Reads the equilibria of the present bonds as the earlier ranks had them; they are solved for again before
 * the next step, as the solvers have to be made anew. Events found ahead are searched again. */
pg_status event_moved (pg_solver *s, pg_state *state, const pg_moved *moved)
{
    pg_status status = PG_OK;
    event_stepping *e = events_of (s);
    break_loop *b = &s->break_loop;
    size_t components = (size_t) b->system.components;
    int unit;
    PG_TRY (keep_ends (e, &unit, moved->alike));
    PG_TRY (moved->points (moved->context, "event_stepping.unit", components, e->unit));
    if (e->base) PG_TRY (moved->points (moved->context, "event_stepping.base", components, e->base));
    e->lost = 1, e->balance_fresh = 0;
    if (e->engine) event_solver_drop (e->engine);
    ahead_refused (e->ahead);
    PG_TRY (instability_moved (s, &e->unstable, moved->alike));
    event_displacement (s, state->factor, b->system.balance.scratch);
    PG_TRY (moved_balance (b, state->factor, b->system.balance.scratch, 1));
done:
    return status;
}
