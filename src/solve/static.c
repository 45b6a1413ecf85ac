/* SPDX-License-Identifier: GPL-3.0-or-later
 * Quasi-static equilibria by linear systems. stepping: fixed takes equal load steps, each with the break
 * loop; stepping: event goes from break to break (event_stepping.c). */
#include "solve/contact/contact.h"
#include "solve/events/event_stepping.h"
#include "solve/growth/facet_growth.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

static pg_status static_begin (pg_solver *s, const pg_state *state)
{
    (void) state;
    return s->options.event ? instability_start (s, &events_of (s)->unstable) : PG_OK;
}

static pg_status static_start (pg_solver *s, pg_state *state)
{
    pg_status status = PG_OK;
    PG_TRY (contact_settle_tips (&s->break_loop.system, state));
    if (s->stage.now.number) PG_TRY (stage_remove (s, state));         /* what the first stage removes */
    if (s->options.event) PG_TRY (event_start (s, state));
done:
    return status;
}

/* ---- fixed --------------------------------------------------------------------------------------------- */
static pg_status step_fixed (pg_solver *s, pg_state *state, pg_step *step)
{
    pg_status status = PG_OK;
    break_loop *b = &s->break_loop;
    int meets;
    if (b->round == 0 && stage_next (s, state)) PG_TRY (stage_remove (s, state));
    long made = state->step - s->stage.now.first_step + 1, all = stage_steps (s, s->stage.now.number);
    double t = stage_start (s) + (double) made / (double) all;
    stage_bear (s, t);
    PG_TRY (equilibrate (b, state, t, state->d, NULL, step));
    step->unjudged = facet_unjudged (b, state, 1);
    if (b->growth) PG_TRY (facet_show (s, state, 1));
    b->system.balance.borne = fmax (b->system.balance.borne, b->system.balance.reference);
    contact_accept (&b->system);
    PG_TRY (contact_show (&b->system, 1));
    state->factor = state->time = t;
    s->report.energy.strain = b->work_balance.strain;
    step->dissipated = b->work - b->work0 - (b->work_balance.strain - b->stored0);
    step->factor = step->time = t;
    while ((double) s->next_level / (double) s->options.levels <= (t - stage_start (s)) * (1 + 1e-12))
        s->next_level++, step->level = 1;
    int arrived;
    PG_TRY (break_loop_arrived (b, state, state->d, &arrived));
    if (arrived)
        pg_statistics_warn (&s->report, "the crack has arrived at %s: the run ends at load factor %.6g",
                            s->options.stop_set->name, t);
    PG_TRY (stage_meets (s, state, b->work_balance.reaction, &meets));
    if (s->stage.now.number && made >= all && !meets) s->stage.now.over = STAGE_LOADS;
    if (arrived || (!s->stage.now.number && made >= all)) s->finished = 1;
done:
    return status;
}

static pg_status static_step (pg_solver *s, pg_state *state, pg_step *step)
{
    if (s->options.event) return event_step (s, state, step);
    pg_status status = step_fixed (s, state, step);
    if (status == PG_OK && s->break_loop.work_balance.reaction)
        memcpy (s->reaction, s->break_loop.work_balance.reaction,
                PG_REACTIONS * s->problem->boundary.nload * sizeof *s->reaction);
    return status;
}

/* Fixed load steps keep only the work balance of the last one. */
static pg_status static_moved (pg_solver *s, pg_state *state, const pg_moved *moved, int within)
{
    if (s->options.event) return event_moved (s, state, moved);
    (void) within;
    return state->step > 0 ? moved_balance (&s->break_loop, state->factor, state->d, 1) : PG_OK;
}

/* ---- the entry ----------------------------------------------------------------------------------------- */
static int is (const char *text, const char *word) { return text && strcmp (text, word) == 0; }

static int is_rough (const pg_solver_options *o)
{
    return o->contact.kind != PG_CONTACT_NONE && (o->contact.coefficient > 0 || o->contact.cohesion > 0);
}

/* Event stepping: refuses kinds of contact that it can follow only where all loads grow with the load factor,
 * if some of the loads do not. */
static void check_faces (const pg_solver_options *o, const pg_problem *problem, const pg_scene *scene,
                         int closes)
{
    /* in 3D Coulomb's cone is round: forces are not linear between changes of status */
    if (is_rough (o) && problem->dim == 3)
        pg_scene_fault (scene, "solver.stepping",
                        "event goes with friction in space where all loads grow with the load factor: with a "
                        "constant part, cohesion, or stages, use fixed, or contact.kind: normal");
    else if (closes && pg_criterion_of_bonds (problem->criterion))
        pg_scene_fault (scene, "solver.stepping",
                        "event goes with contact of faces that single broken bonds leave where all loads "
                        "grow with the load factor: with a constant part, cohesion, or stages, use fixed");
}

/* Reports what does not go together with the kind of stepping that was asked for, or chosen. */
static void check_stepping (const pg_solver_options *o, const pg_problem *problem, const pg_scene *scene,
                            int closes)
{
    int affine = PG_OWN (pg_static_options, o)->affine;
    if (o->event && pg_problem_strained (problem))
        pg_scene_fault (scene, "solver.stepping",
                        "event: the equilibria after each break do not know temperature, shrinkage and pore "
                        "pressure so far: use fixed");
    else if (affine && !pg_problem_affine (problem))
        pg_scene_fault (scene, "solver.stepping",
                        "event stepping needs loads that grow with the load factor (ramp: linear), stay "
                        "(ramp: constant), or both: use fixed, or stages");
    if (affine) check_faces (o, problem, scene, closes);
    if (closes && pg_problem_removes (problem))
        pg_scene_fault (scene, "stages", "remove does not go with contact.kind so far");
    if (o->event && o->break_mode == PG_BREAK_ALL)
        pg_scene_fault (scene, "solver.break", "all goes with stepping: fixed");
}

/* Reads the number of fixed load steps: of a stage, and of the run. */
static void read_steps (pg_solver_options *o, const pg_problem *problem, const pg_scene *scene)
{
    pg_static_options *own = PG_OWN (pg_static_options, o);
    own->steps = pg_scene_integer (scene, "solver.steps");
    if (!pg_scene_given (scene, "solver.steps") && o->levels > own->steps) own->steps = o->levels;
    o->steps = problem->boundary.nstage ? 0 : own->steps;
    for (size_t k = 0; k < problem->boundary.nstage; k++)
        o->steps += problem->boundary.stage[k].steps ? problem->boundary.stage[k].steps : own->steps;
}

/* Reads the options. stepping: auto takes event where loads are proportional to the load factor, which makes
 * it exact and cheap. */
static void static_read (pg_solver_options *o, const pg_problem *problem, const pg_scene *scene)
{
    const char *stepping = pg_scene_text (scene, "solver.stepping");
    int proportional = pg_problem_proportional (problem);
    pg_static_options *own = PG_OWN (pg_static_options, o);
    own->stop_stiffness = pg_scene_number (scene, "solver.stop.stiffness");
    int closes = o->contact.kind != PG_CONTACT_NONE;
    int suits = proportional || problem->boundary.nstage
                || (o->break_mode == PG_BREAK_FACET && pg_problem_affine (problem));
    if (problem->boundary.nplaten) suits = proportional && platens_touch (problem);
    if (is_rough (o) && problem->dim == 3 && (!proportional || o->contact.cohesion > 0)) suits = 0;
    if (closes && pg_criterion_of_bonds (problem->criterion) && (!proportional || o->contact.cohesion > 0))
        suits = 0;
    o->event = is (stepping, "event") || (is (stepping, "auto") && suits && o->break_mode != PG_BREAK_ALL);
    /* cohesion does not grow with the load */
    own->affine = o->event && (!proportional || o->contact.cohesion > 0);
    check_stepping (o, problem, scene, closes);
    instability_read (o, problem, scene);
    read_steps (o, problem, scene);
}

static const char *static_manner (const pg_solver_options *o)
{
    static const char *const by_events[] = {
        [PG_UNSTABLE_FOLLOW] = ", event stepping",
        [PG_UNSTABLE_HOLD] = ", event stepping, the load held where growth goes on by itself",
        [PG_UNSTABLE_DYNAMIC] = ", event stepping, in motion where growth goes on by itself"
    };
    return o->event ? by_events[o->on_instability] : ", fixed load steps";
}

/* The matrix includes inertia while an instability is in motion. */
static const dynamics *static_dynamics (pg_solver *s)
{
    return instability_dynamics (&events_of (s)->unstable);
}

#define ROW PG_SOLVER_KEY
static const pg_key keys[] = {
    ROW ("solver.stepping", PG_NAME, NULL, NULL, "auto", "auto|event|fixed",
         "From break to break (event), or in equal load steps (fixed). event takes loads that grow "
         "with the load factor (in closed form), stay constant (ramp: constant; the first "
         "step is then at load factor 0), or both; auto: event when all loads are proportional, and with "
         "break: facet wherever it can be."),
    ROW ("solver.steps", PG_INTEGER, NULL, "[1, 100000000]", "20", NULL,
         "Number of equal load steps, with stepping: fixed."),
    ROW ("solver.stop.stiffness", PG_NUMBER, "1", "[0, 1)", "1e-3", NULL,
         "Event stepping ends when breaking has brought the work per squared load factor below this share of "
         "its first value (the body has separated)."),
};
static const pg_key_table table = { "solve", keys, sizeof keys / sizeof *keys };

const pg_solver_type pg_solver_static_ = {
    .name = "static",
    .summary = "quasi-static equilibrium, event by event or in fixed load steps",
    .flags = PG_SOLVER_STATIC | PG_SOLVER_EVENTS | PG_SOLVER_FACETS | PG_SOLVER_CONTACT | PG_SOLVER_RANKS,
    .keys = { &table, &solver_keys_breaking, &solver_keys_facets, &solver_keys_linear,
              &instability_keys },
    .read = static_read,
    .begin = static_begin,
    .start = static_start,
    .step = static_step,
    .refused = event_refused,
    .free = event_free,
    .keep = event_keep,
    .move = static_moved,
    .ends = event_ends,
    .own_size = sizeof (event_stepping),
    .manner = static_manner,
    .dynamics = static_dynamics,
};
