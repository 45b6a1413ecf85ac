/* SPDX-License-Identifier: GPL-3.0-or-later
 * Stages of loading in a static run (problem->stage): the present one, when it ends, what was then.
 * Stage k is the stretch k - 1 <= t <= k of the run's t, along which loads are straight lines
 * (mechanics/model/stages.c), so that steps and events within it are those of any run. A stage ends at t
 * = k, or
 * before: then the run goes on at t = k with the loads of where it ended. That changes tables of loads, which
 * are therefore the solver's own copy.
 *
 * Conditions are asked of states that bear their loads: after a fixed step, or where the next event would
 * begin or a level is reached; not while growth goes on at a held load, and not in dynamics. */
#include "solve/run/solve.h"
#include <math.h>
#include <string.h>

static const char *const reasons[] = {
    [STAGE_GOES_ON] = "",
    [STAGE_LOADS] = "loads reached",
    [STAGE_GAUGE] = "gauge",
    [STAGE_FORCE] = "drop of force",
    [STAGE_EVENTS] = "events",
    [STAGE_GROWTH] = "crack growth",
    [STAGE_RUN] = "end of the run",
};
enum { REASONS = sizeof reasons / sizeof *reasons };

/* ---- life ---------------------------------------------------------------------------------------------- */
pg_status stages_create (pg_solver *s)
{
    pg_status status = PG_OK;
    stage_path *p = &s->stage;
    const pg_problem *problem = s->problem;
    if (!problem->boundary.nstage) return PG_OK;
    PG_TRY (pg_problem_staged (&p->staged, problem));
    PG_ALLOC (p->share, problem->boundary.nstage);
    PG_ALLOC (p->record, problem->boundary.nstage);
    PG_ALLOC (p->opening, problem->boundary.nstage * problem->boundary.ngauge + 1);
    PG_ALLOC (p->here, 2 * problem->boundary.ngauge + 1);
    memset (p->here, -1, 2 * problem->boundary.ngauge);
    for (size_t k = 0; k < problem->boundary.nstage; k++)
        p->share[k] = 1, p->record[k].gauge = p->opening + k * problem->boundary.ngauge;
    p->now.number = 1;
    s->problem = p->staged;
done:
    return status;
}

void stages_free (pg_solver *s)
{
    stage_path *p = &s->stage;
    pg_free (p->excavated), pg_free (p->excavated_now);
    pg_free (p->share), pg_free (p->record), pg_free (p->opening), pg_free (p->here);
    pg_problem_staged_free (&p->staged);
}

double stage_start (const pg_solver *s)
{
    return s->stage.now.number ? (double) (s->stage.now.number - 1) : 0;
}

double stage_end (const pg_solver *s) { return stage_start (s) + 1; }

double stage_level (const pg_solver *s)
{
    return stage_start (s) + (double) s->next_level / (double) s->options.levels;
}

long stage_steps (const pg_solver *s, long number)
{
    if (!s->problem->boundary.nstage) return s->options.steps;  /* a caller may have made it one step */
    long own = s->problem->boundary.stage[number - 1].steps;
    return own ? own : PG_OWN (pg_static_options, &s->options)->steps;
}

int stage_moves (const pg_solver *s)
{
    return !s->stage.now.number || pg_stage_loads (s->problem, (size_t) s->stage.now.number - 1);
}

static void follow (pg_solver *s) { pg_stages_follow (s->stage.staged, s->stage.share); }

/* ---- from one to the next ------------------------------------------------------------------------------ */
int stage_next (pg_solver *s, pg_state *state)
{
    stage_path *p = &s->stage;
    if (!p->now.number || p->now.over == STAGE_GOES_ON || s->finished) return 0;
    p->share[p->now.number - 1] = p->now.over == STAGE_LOADS ? 1 : fmin (state->factor - stage_start (s), 1);
    follow (s);
    p->now.number++, p->now.over = STAGE_GOES_ON;
    p->now.first_step = state->step, p->now.first_event = state->events;
    p->now.first_growth = stage_growth (state), p->now.peak = 0, p->now.side = 0;
    state->factor = state->time = stage_start (s);
    s->next_level = 1;
    return 1;
}

/* ---- removal ------------------------------------------------------------------------------------------- */
static void forget_removed (pg_solver *s)
{
    stage_path *p = &s->stage;
    s->break_loop.system.balance.excavated = NULL;
    pg_free (p->excavated), pg_free (p->excavated_now);
    p->excavated = p->excavated_now = NULL;
}

/* The rest of the body gets the forces f = - (P - F) that the removed part exerted at the present
 * displacement, so that nothing moves as its bonds are cut: forces on the new surface (and inside, what
 * the shape functions have changed). Along the stage they fall to zero, as behind the advancing face of a
 * tunnel. */
pg_status stage_remove (pg_solver *s, pg_state *state)
{
    pg_status status = PG_OK;
    stage_path *p = &s->stage;
    break_loop *b = &s->break_loop;
    pg_system *sys = &b->system;
    double reference;
    forget_removed (s);
    if (!s->problem->boundary.stage[p->now.number - 1].remove) return PG_OK;
    PG_ALLOC (p->excavated, sys->ndof);
    PG_ALLOC (p->excavated_now, sys->ndof);
    PG_TRY (pg_stage_removes (s->problem, (size_t) p->now.number - 1, state->alive, &b->changes));
    for (size_t k = 0; k < b->changes.n; k++) state->alive[b->changes.bond[k]] = 0;
    PG_TRY (system_refresh (sys, state, &b->changes));
    PG_TRY (sys->force->balance (sys->self, stage_start (s), state->d, p->excavated, &reference));
    for (size_t i = 0; i < sys->ndof; i++) p->excavated[i] = -p->excavated[i];
done:
    return status;
}

void stage_bear (pg_solver *s, double t)
{
    stage_path *p = &s->stage;
    double left = 1 - (t - stage_start (s));
    s->break_loop.system.balance.excavated = p->excavated && left > 0 ? p->excavated_now : NULL;
    for (size_t i = 0; p->excavated && i < s->break_loop.system.ndof; i++)
        p->excavated_now[i] = left * p->excavated[i];
}

/* Saves what a refused step returns to: the stage in which it began, which is the present one or the one
 * before. */
void stage_save (pg_solver *s)
{
    stage_path *p = &s->stage;
    p->before = p->now, p->level_before = s->next_level;
}

void stage_return (pg_solver *s)
{
    stage_path *p = &s->stage;
    if (!p->now.number) return;
    if (p->now.number > p->before.number) {
        forget_removed (s);
        p->share[p->before.number - 1] = 1;
    }
    p->now = p->before, s->next_level = p->level_before;
    follow (s);
}

/* ---- conditions ---------------------------------------------------------------------------------------- */
double stage_growth (const pg_state *state)
{
    return state->paths ? state->paths->length : state->surfaces ? state->surfaces->area : 0;
}

/* Opening of a gauge: change of distance of its two ends, along the line between them, m. Each end is
 * measured by the rank next to it. */
static pg_status opening_of (pg_solver *s, const pg_state *state, size_t gauge, const double *d, double *out)
{
    pg_status status = PG_OK;
    const pg_gauge *g = &s->problem->boundary.gauge[gauge];
    const pg_system *sys = &s->break_loop.system;
    double end[2][3] = { { NAN, NAN, NAN }, { NAN, NAN, NAN } };
    for (int e = 0; e < 2 && sys->force->sample; e++) {
        const double *place = e ? g->to : g->from;
        signed char *here = &s->stage.here[2 * gauge + (size_t) e];
        PG_TRY (pg_cloud_has_nearest (&s->problem->cloud, place, here));
        PG_TRY (sys->force->sample (sys->self, state, d, 1, place, end[e], NULL, NULL));
        for (int k = 0; k < 3 && !*here; k++) end[e][k] = 0;
    }
    *out = system_sum (sys, pg_gauge_opening (g, s->problem->dim, end[0], end[1]));
done:
    return status;
}

static const pg_stage *stage_of (const pg_solver *s)
{
    return s->stage.now.number ? &s->problem->boundary.stage[s->stage.now.number - 1] : NULL;
}

/* 1: the opening has reached its limit, coming from the side on which it was at the start of the stage. */
static int has_arrived (stage_path *p, double opening, double limit)
{
    if (p->now.side == 0) p->now.side = opening <= limit ? 1 : -1;
    return p->now.side * (opening - limit) >= 0;
}

/* Between events openings are linear in t, so that the crossing is found in closed form. */
pg_status stage_cross (pg_solver *s, const pg_state *state, const double *base, const double *unit,
                       double now, double *factor, int *crosses)
{
    pg_status status = PG_OK;
    const pg_stage *stage = stage_of (s);
    double at[2];
    *crosses = 0;
    if (!stage || stage->gauge < 0) return PG_OK;
    PG_TRY (opening_of (s, state, (size_t) stage->gauge, base, &at[0]));
    PG_TRY (opening_of (s, state, (size_t) stage->gauge, unit, &at[1]));
    double slope = at[1] - at[0], start = stage_start (s);
    int first = s->stage.now.side == 0;
    int here = has_arrived (&s->stage, at[0] + (now - start) * slope, stage->opening),
        there = has_arrived (&s->stage, at[0] + (*factor - start) * slope, stage->opening);
    if (here != there && !(first && here)) *factor = start + (stage->opening - at[0]) / slope;
    *crosses = here || there;
    if (*crosses) s->stage.now.over = STAGE_GAUGE;
done:
    return status;
}

/* 1: the force of the load that until names, N, summed over ranks, has dropped by the given share of its
 * maximum in this stage, which is kept in `peak`. */
static int has_fallen (pg_solver *s, const pg_stage *stage, const double *reaction)
{
    stage_path *p = &s->stage;
    double sum = 0;
    for (int k = 0; k < 3; k++) {
        double force = system_sum (&s->break_loop.system, reaction[3 * stage->load + k]);
        sum += force * force;
    }
    p->now.peak = fmax (p->now.peak, sqrt (sum));
    return sqrt (sum) <= (1 - stage->drop) * p->now.peak && p->now.peak > 0;
}

pg_status stage_meets (pg_solver *s, const pg_state *state, const double *reaction, int *meets)
{
    pg_status status = PG_OK;
    stage_path *p = &s->stage;
    const pg_stage *stage = stage_of (s);
    double opening;
    *meets = 0;
    if (!stage || p->now.over != STAGE_GOES_ON) return PG_OK;
    if (stage->load >= 0 && reaction && has_fallen (s, stage, reaction)) p->now.over = STAGE_FORCE;
    if (stage->events && state->events - p->now.first_event >= stage->events) p->now.over = STAGE_EVENTS;
    if (stage->growth > 0 && stage_growth (state) - p->now.first_growth >= stage->growth * (1 - 1e-9))
        p->now.over = STAGE_GROWTH;
    if (stage->gauge >= 0 && !s->options.event) {
        PG_TRY (opening_of (s, state, (size_t) stage->gauge, state->d, &opening));
        if (has_arrived (p, opening, stage->opening)) p->now.over = STAGE_GAUGE;
    }
    *meets = p->now.over != STAGE_GOES_ON;
done:
    return status;
}

/* ---- records ------------------------------------------------------------------------------------------- */
pg_status stage_close_step (pg_solver *s, const pg_state *state, pg_step *step)
{
    pg_status status = PG_OK;
    stage_path *p = &s->stage;
    const pg_statistics *r = &s->report;
    if (!p->now.number) return PG_OK;
    step->stage = p->now.number;
    if (s->finished && p->now.over == STAGE_GOES_ON) p->now.over = STAGE_RUN;
    if (p->now.over == STAGE_GOES_ON) goto done;
    step->level = 1;
    if (p->now.number == (long) s->problem->boundary.nstage) s->finished = 1;
    pg_stage_record *record = &p->record[p->now.number - 1];
    const pg_system *sys = &s->break_loop.system;
    double *gauge = record->gauge;
    *record = (pg_stage_record) { .done = 1,
                                  .why = reasons[p->now.over],
                                  .step = state->step,
                                  .events = state->events - p->now.first_event,
                                  .share = state->factor - stage_start (s),
                                  .strain = system_sum (sys, r->energy.strain),
                                  .external = system_sum (sys, r->energy.external),
                                  .dissipated = system_sum (sys, r->energy.dissipated),
                                  .growth = stage_growth (state) - p->now.first_growth,
                                  .reason = p->now.over,
                                  .gauge = gauge };
    for (size_t g = 0; g < s->problem->boundary.ngauge; g++)
        PG_TRY (opening_of (s, state, g, state->d, &gauge[g]));
done:
    return status;
}

const pg_stage_record *pg_solver_stages (const pg_solver *s, size_t *n)
{
    *n = s->problem->boundary.nstage;
    return s->stage.record;
}

/* ---- checkpoint ---------------------------------------------------------------------------------------- */
static pg_status keep_place (stage_place *at, long nstage, const char *name, const pg_keeper *k)
{
    return pg_keep_fields (k, name, "counts", "numbers", 1, PG_ROWS (
        PG_KEPT_IN (at->number, 1, nstage, "the stage of loading"),
        PG_KEPT_IN (at->over, 0, REASONS - 1, "why a stage ended"), PG_KEPT (at->first_step),
        PG_KEPT (at->first_event), PG_KEPT (at->first_growth), PG_KEPT (at->peak), PG_KEPT (at->side)));
}

pg_status stages_keep (pg_solver *s, const pg_keeper *k)
{
    pg_status status = PG_OK;
    stage_path *p = &s->stage;
    pg_stage_record *r = p->record;
    size_t n = s->problem->boundary.nstage;
    if (!p->now.number) return PG_OK;
    PG_TRY (keep_place (&p->now, (long) n, "stage.now", k));
    PG_TRY (keep_place (&p->before, (long) n, "stage.before", k));
    PG_TRY (k->counts (k->context, "stage.level", 1, &p->level_before));
    PG_TRY (k->numbers (k->context, "stage.share", n, p->share));
    long removes = p->excavated != NULL;
    PG_TRY (k->counts (k->context, "stage.removes", 1, &removes));
    if (k->reading && !removes) forget_removed (s);
    if (removes && !p->excavated) {
        PG_ALLOC (p->excavated, s->break_loop.system.ndof);
        PG_ALLOC (p->excavated_now, s->break_loop.system.ndof);
    }
    if (removes)
        PG_TRY (k->numbers (k->context, "stage.excavated", s->break_loop.system.ndof, p->excavated));
    PG_TRY (k->numbers (k->context, "stage.borne", 1, &s->break_loop.system.balance.borne));
    PG_TRY (pg_keep_fields (k, "stage", "records", "record_values", n, PG_ROWS (
        PG_EACH (r, done), PG_EACH_IN (r, reason, 0, REASONS - 1, "why a stage ended"), PG_EACH (r, step),
        PG_EACH (r, events), PG_EACH (r, share), PG_EACH (r, strain), PG_EACH (r, external),
        PG_EACH (r, dissipated), PG_EACH (r, growth), PG_ITEMS (p->opening, s->problem->boundary.ngauge))));
    for (size_t i = 0; k->reading && i < n; i++) r[i].why = reasons[r[i].reason];
    follow (s);
done:
    return status;
}

/* Stages are equal on all ranks of the earlier run, and read as such. */
pg_status stages_moved (pg_solver *s, const pg_moved *m, int within)
{
    pg_status status = PG_OK;
    PG_TRY (stages_keep (s, m->alike));
    if (within) stage_return (s);
done:
    return status;
}
