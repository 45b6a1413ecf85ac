/* SPDX-License-Identifier: GPL-3.0-or-later
 * Quasi-static loading. fixed: equal load steps, each with the break loop. event: between breaks everything
 * is linear in the load factor, so d = lambda d_1 and the factor of the next break follows in closed form
 * (theory F6): go there, break the bonds that reach their limit (ties included), solve for the new d_1, and
 * so on; user levels are reported as they are passed. */
#include "solve.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

static double level_factor (const pg_solver *s, long level)
{
    return (double) level / (double) s->options.levels;
}

static pg_status static_start (pg_solver *s, pg_state *state)
{
    pg_status status = PG_OK;
    double residual;
    PG_TRY (system_refresh (&s->break_loop.system, state, NULL));
    s->next_level = 1;
    if (s->options.event && PG_OWN (pg_static_options, &s->options)->affine) {
        PG_ALLOC (s->unit, state->ndof);
        PG_ALLOC (s->base, state->ndof);
        memcpy (s->unit, state->d, state->ndof * sizeof *s->unit);
        memcpy (s->base, state->d, state->ndof * sizeof *s->base);
        PG_TRY (affine_solve (s));
    } else if (s->options.event) {
        PG_ALLOC (s->unit, state->ndof);
        for (size_t i = 0; state->factor != 0 && i < state->ndof; i++)
            s->unit[i] = state->d[i] / state->factor;
        PG_TRY (system_solve (&s->break_loop.system, 1, s->unit, NULL, &residual));
        s->unit_residual = residual;
    }
done:
    return status;
}

/* ---- fixed --------------------------------------------------------------------------------------------- */
static pg_status step_fixed (pg_solver *s, pg_state *state, pg_step *step)
{
    pg_status status = PG_OK;
    break_loop *b = &s->break_loop;
    double t = (double) (state->step + 1) / (double) s->options.steps;
    PG_TRY (equilibrate (b, state, t, state->d, NULL, step));
    b->system.borne = fmax (b->system.borne, b->system.reference);
    state->factor = state->time = t;
    s->report.energy_strain = b->work_balance.strain;
    step->dissipated = b->work - b->work0 - (b->work_balance.strain - b->stored0);
    step->factor = step->time = t;
    while (level_factor (s, s->next_level) <= t * (1 + 1e-12)) s->next_level++, step->level = 1;
    int arrived;
    PG_TRY (break_loop_arrived (b, state, state->d, &arrived));
    if (arrived)
        pg_statistics_warn (&s->report, "the crack has arrived at %s: the run ends at load factor %.6g",
                            s->options.stop_set->name, t);
    if (arrived || state->step + 1 >= s->options.steps) s->finished = 1;
done:
    return status;
}

/* ---- event --------------------------------------------------------------------------------------------- */
static double smallest (const double *a, size_t n)
{
    double low = INFINITY;
    for (size_t i = 0; i < n; i++) if (a[i] < low) low = a[i];
    return low;
}

/* d = factor * unit; energies are quadratic in the factor. */
static pg_status settle (pg_solver *s, pg_state *state, double factor)
{
    pg_status status = PG_OK;
    for (size_t i = 0; i < state->ndof; i++) state->d[i] = factor * s->unit[i];
    state->factor = state->time = factor;
    if (!s->work_balance_fresh) PG_TRY (break_loop_account (&s->break_loop, 1, s->unit, NULL, factor));
    else PG_TRY (break_loop_book (&s->break_loop, factor));
    s->work_balance_fresh = 1;
    s->report.energy_strain = factor * factor * s->break_loop.work_balance.strain;
done:
    return status;
}

/* Work per squared load factor: a stiffness under prescribed displacements, a compliance under forces. */
static double secant (const break_loop *b)
{
    double sum = 0;
    for (size_t k = 0; k < b->work_balance.npair; k++)
        sum += b->work_balance.force[k] * b->work_balance.displacement[k];
    return sum;
}

int event_ended (pg_solver *s, const pg_state *state, double factor, pg_status now)
{
    if (now != PG_E_EQUILIBRIUM && now != PG_E_NOT_SPD && now != PG_E_SINGULAR) return 0;
    s->ended = now;
    snprintf (s->why, sizeof s->why, "after event %ld at load factor %.6g: %s", state->events, factor,
              pg_last_error ());
    return 1;
}

pg_status event_stops (pg_solver *s, const pg_state *state, double factor, double secant)
{
    pg_status status = PG_OK;
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
    double share = s->secant = secant / s->secant0;
    if (s->problem->nload
        && (share < least || share > 1 / fmax (least, 1e-12))) {
        pg_statistics_warn (&s->report, "the body is apart: the run ends at event %ld, load factor %.6g",
                            state->events, factor);
        s->finished = 1;
    }
done:
    return status;
}

void event_limit (pg_solver *s, const pg_state *state, double factor)
{
    if (state->events < s->options.max_events) return;
    pg_statistics_warn (&s->report, "stopped after solver.max_events = %ld events at load factor %.6g",
                        state->events, factor);
    s->finished = 1;
}

/* Breaks what reaches its limit at `factor` and finds the next unit displacement; where there is none the
 * next step is refused. */
static pg_status break_at (pg_solver *s, pg_state *state, double factor, double scale, pg_step *step)
{
    pg_status status = PG_OK;
    break_loop *b = &s->break_loop;
    const pg_solver_options *o = &s->options;
    double width = o->break_mode == PG_BREAK_FRACTION ? fmax (o->break_fraction, o->tie) : o->tie, residual;
    /* utilisation here */
    for (size_t i = 0; i < state->nbond; i++) b->factor[i] = b->factor[i] > 0 ? factor / b->factor[i] : 0;
    PG_TRY (break_loop_kill (b, state, b->factor, 1 - width, scale, factor));
    step->nbroken = b->nbroken, step->broken = b->broken, step->event = 1;
    state->events++, s->report.events++;
    double strain = s->report.energy_strain, work = b->work;
    PG_TRY (system_refresh (&b->system, state, &b->changes));
    pg_status now = system_solve (&b->system, 1, s->unit, NULL, &residual);
    if (event_ended (s, state, factor, now)) goto done;
    PG_TRY (now);
    s->unit_residual = residual;
    PG_TRY (break_loop_account (b, 1, s->unit, NULL, factor));
    s->report.energy_strain = factor * factor * b->work_balance.strain;
    step->dissipated = b->work - work - (s->report.energy_strain - strain);
    PG_TRY (event_stops (s, state, factor, secant (b)));
done:
    return status;
}

/* Utilisation of the accepted state, from the sweep of the unit displacement: independent of the closed form
 * that gave the factor. Where a measure is not linear (finite stretch) and seems over its limit, the state
 * itself is measured. *scale belongs to the sweep kept. */
static pg_status look_over (pg_solver *s, const pg_state *state, double factor, double *scale, pg_step *step)
{
    pg_status status = PG_OK;
    break_loop *b = &s->break_loop;
    *scale = factor;
    if (!s->problem->criterion->type || !b->system.force->utilisation) return PG_OK;
    long over = break_loop_over (b, state, *scale, &step->utilisation);
    if (over) {
        *scale = 1;
        PG_TRY (
            b->system.force->utilisation (b->system.self, state, state->d, b->utilisation, b->kind, NULL));
        over = break_loop_over (b, state, *scale, &step->utilisation);
    }
    s->report.bonds_over_limit += over;
done:
    return status;
}

static pg_status step_event (pg_solver *s, pg_state *state, pg_step *step)
{
    pg_status status = PG_OK;
    break_loop *b = &s->break_loop;
    double next = INFINITY, level = level_factor (s, s->next_level), scale, t0 = pg_seconds ();
    b->nbroken = 0;
    step->iterations = 1;
    if (s->problem->criterion->type && b->system.force->utilisation) {
        PG_TRY (break_loop_ready (b));
        PG_TRY (b->system.force->utilisation (b->system.self, state, s->unit, b->utilisation, b->kind,
                                              b->factor));
        next = smallest (b->factor, state->nbond);
    }
    s->report.seconds[PG_SECONDS_BREAK] += pg_seconds () - t0;
    double factor = next < level ? next : level;
    PG_TRY (settle (s, state, factor));
    s->top_factor = fmax (s->top_factor, factor);
    if (b->work_balance.reaction)
        memcpy (s->reaction, b->work_balance.reaction, 3 * s->problem->nload * sizeof *s->reaction);
    if (s->secant0 == 0) s->secant0 = secant (b);
    step->factor = step->time = factor;
    step->residual = s->unit_residual;
    PG_TRY (look_over (s, state, factor, &scale, step));
    if (next <= level) PG_TRY (break_at (s, state, factor, scale, step));
    if (!(level > factor)) {
        step->level = 1;
        if (s->next_level++ >= s->options.levels) {
            s->finished = 1;
            if (state->events == 0 && s->options.levels > 1)
                pg_statistics_skip (&s->report,
                                    (double) (s->options.levels - 1) * s->report.seconds[PG_SECONDS_SOLVE],
                                    "solves of all levels but one",
                                    "no bond broke: the answer is linear in the load factor");
        }
    }
    event_limit (s, state, factor);
    for (size_t k = 0; k < 3 * s->problem->nload; k++) s->reaction[k] *= factor;
done:
    return status;
}

static pg_status static_step (pg_solver *s, pg_state *state, pg_step *step)
{
    if (s->ended != PG_OK) return pg_error (s->ended, PG_HERE, "%s", s->why);
    pg_status status = !s->options.event   ? step_fixed (s, state, step)
                       : PG_OWN (pg_static_options, &s->options)->affine ? affine_step (s, state, step)
                                           : step_event (s, state, step);
    if (status == PG_OK && !s->options.event && s->break_loop.work_balance.reaction)
        memcpy (s->reaction, s->break_loop.work_balance.reaction,
                3 * s->problem->nload * sizeof *s->reaction);
    return status;
}

/* ---- the entry ----------------------------------------------------------------------------------------- */
static int is (const char *text, const char *word) { return text && strcmp (text, word) == 0; }

static void static_read (pg_solver_options *o, const pg_problem *problem, const pg_scene *scene)
{
    const char *stepping = pg_scene_text (scene, "solver.stepping");
    int proportional = pg_problem_proportional (problem);
    pg_static_options *own = PG_OWN (pg_static_options, o);
    own->stop_stiffness = pg_scene_number (scene, "solver.stop.stiffness");
    o->steps = pg_scene_integer (scene, "solver.steps");
    o->event = is (stepping, "event")
               || (is (stepping, "auto") && proportional && o->break_mode != PG_BREAK_ALL);
    own->affine = o->event && !proportional;
    if (own->affine && !pg_problem_affine (problem))
        pg_scene_fault (scene, "solver.stepping",
                        "event stepping needs loads that grow with the load factor (ramp: linear), stay "
                        "(ramp: constant), or both: use fixed");
    if (o->event && o->break_mode == PG_BREAK_ALL)
        pg_scene_fault (scene, "solver.break", "all goes with stepping: fixed");
    if (!pg_scene_given (scene, "solver.steps") && o->levels > o->steps) o->steps = o->levels;
}

static const char *static_manner (const pg_solver_options *o)
{
    return o->event ? ", event stepping" : ", fixed load steps";
}

#define ROW PG_SOLVER_KEY
static const pg_key keys[] = {
    ROW ("solver.stepping", PG_NAME, NULL, NULL, "auto", "auto|event|fixed",
         "From break to break (event), or in equal load steps (fixed). event takes loads that grow "
         "with the load factor (in closed form), stay constant (ramp: constant; the first "
         "step is then at load factor 0), or both; auto: event when all loads are proportional."),
    ROW ("solver.steps", PG_INTEGER, NULL, "[1, 100000000]", "20", NULL,
         "Number of equal load steps, with stepping: fixed."),
    ROW ("solver.stop.stiffness", PG_NUMBER, "1", "[0, 1)", "1e-3", NULL,
         "Event stepping ends when breaking has brought the work per squared load factor below this share of "
         "its first value (the body is apart)."),
};
static const pg_key_table table = { "solve", keys, sizeof keys / sizeof *keys };

const pg_solver_type pg_solver_static_ = {
    .name = "static",
    .summary = "quasi-static equilibrium, event by event or in fixed load steps",
    .flags = PG_SOLVER_STATIC | PG_SOLVER_EVENTS,
    .keys = { &table, &solver_keys_breaking, &solver_keys_linear },
    .read = static_read,
    .start = static_start,
    .step = static_step,
    .manner = static_manner,
};
