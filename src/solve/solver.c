/* SPDX-License-Identifier: GPL-3.0-or-later
 * The solver object: options, the list of methods, steps with refusal, the report of the run. */
#include "solve.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

#define PG_SOLVER(name) extern const pg_solver_type pg_solver_##name;
#include "list.h"
#undef PG_SOLVER

static const pg_solver_type *const entries[] = {
#define PG_SOLVER(name) &pg_solver_##name,
#include "list.h"
#undef PG_SOLVER
};
enum { COUNT = sizeof entries / sizeof *entries };

const char *pg_solver_names (void)
{
    static char names[256];
    size_t at = 0;
    if (names[0]) return names;
    char text[256];
    for (size_t i = 0; i < COUNT; i++) at += (size_t) snprintf (text + at, sizeof text - at, "%s%s", i ? "|" : "", entries[i]->name);
    memcpy (names, text, sizeof names);
    return names;
}

const char *pg_solver_summary (const char *name)
{
    for (size_t i = 0; i < COUNT; i++) if (strcmp (entries[i]->name, name) == 0) return entries[i]->summary;
    return NULL;
}

pg_status pg_solver_options_read (pg_solver_options *o, const pg_problem *problem, const pg_scene *scene)
{
    const char *stepping = pg_scene_text (scene, "solver.stepping"), *mode = pg_scene_text (scene, "solver.break");
    memset (o, 0, sizeof *o);
    snprintf (o->kind, sizeof o->kind, "%s", pg_scene_text (scene, "solver.kind"));
    snprintf (o->linear, sizeof o->linear, "%s", pg_scene_text (scene, "solver.linear"));
    o->break_mode = strcmp (mode, "all") == 0 ? PG_BREAK_ALL : strcmp (mode, "fraction") == 0 ? PG_BREAK_FRACTION : PG_BREAK_WORST;
    o->break_fraction = pg_scene_number (scene, "solver.break_fraction");
    o->tie = pg_scene_number (scene, "solver.tie");
    o->tolerance = pg_scene_number (scene, "solver.tolerance");
    o->steps = pg_scene_integer (scene, "solver.steps");
    o->max_iterations = pg_scene_integer (scene, "solver.max_iterations");
    o->max_events = pg_scene_integer (scene, "solver.max_events");
    o->dt = pg_scene_number (scene, "solver.dt"), o->end = pg_scene_number (scene, "solver.end");
    o->consistent = strcmp (pg_scene_text (scene, "solver.mass"), "consistent") == 0;
    o->alpha = pg_scene_number (scene, "solver.alpha");
    o->beta = pg_scene_given (scene, "solver.beta") ? pg_scene_number (scene, "solver.beta") : (1 - o->alpha) * (1 - o->alpha) / 4;
    o->gamma = pg_scene_given (scene, "solver.gamma") ? pg_scene_number (scene, "solver.gamma") : 0.5 - o->alpha;
    o->rayleigh_mass = pg_scene_number (scene, "solver.rayleigh.mass");
    o->rayleigh_stiffness = pg_scene_number (scene, "solver.rayleigh.stiffness");
    o->stop_stiffness = pg_scene_number (scene, "solver.stop.stiffness");
    o->stop_damage = pg_scene_number (scene, "solver.stop.damage");
    const char *stop = pg_scene_text (scene, "solver.stop.set");
    if (stop && *stop) o->stop_set = pg_sets_named (&problem->sets, scene, "solver.stop.set", stop);
    o->levels = pg_scene_integer (scene, "output.at.levels");
    int proportional = pg_problem_proportional (problem), is_static = strcmp (o->kind, "static") == 0;
    o->event = is_static && (strcmp (stepping, "event") == 0 || (strcmp (stepping, "auto") == 0 && proportional && o->break_mode != PG_BREAK_ALL));
    if (o->event && !proportional) pg_scene_fault (scene, "solver.stepping", "event stepping needs proportional loads (ramp: linear on every load): use fixed");
    if (o->event && o->break_mode == PG_BREAK_ALL) pg_scene_fault (scene, "solver.break", "all goes with stepping: fixed");
    if (is_static && !pg_scene_given (scene, "solver.steps") && o->levels > o->steps) o->steps = o->levels;
    if (!is_static) {
        if (!pg_scene_given (scene, "solver.dt")) pg_scene_fault (scene, "solver.dt", "newmark needs a time step");
        if (!pg_scene_given (scene, "solver.end")) pg_scene_fault (scene, "solver.end", "newmark needs an end time");
        if (o->dt > 0 && o->end > 0) {
            double steps = ceil (o->end / o->dt * (1 - 1e-12));
            if (steps > 1e9) pg_scene_fault (scene, "solver.dt", "%g time steps are too many", steps);
            o->steps = (long) fmin (steps, 1e9);
            if (fabs (steps * o->dt - o->end) > 1e-9 * o->end) o->dt = o->end / steps;      /* equal steps, none longer than asked */
        }
        if (o->gamma > 2 * o->beta) pg_scene_fault (scene, "solver.beta", "newmark is unconditionally stable only for 2 beta >= gamma");
        for (size_t i = 0; i < problem->nmaterial; i++)
            if (!(problem->material[i].density > 0)) pg_scene_fault (scene, "solver.kind", "newmark needs the density of material %s", problem->material[i].name);
    }
    return pg_scene_verdict (scene);
}

pg_status pg_solver_create (pg_solver **out, const pg_problem *problem, const pg_solver_options *options)
{
    const pg_force_type *force = pg_force_find (problem->force);
    if (!force) return pg_error (PG_E_USAGE, PG_HERE, "there is no force %s", problem->force);
    return pg_solver_create_with (out, problem, options, force);
}

pg_status pg_solver_create_with (pg_solver **out, const pg_problem *problem, const pg_solver_options *options, const pg_force_type *force)
{
    pg_status status = PG_OK;
    pg_solver *s = NULL;
    PG_ALLOC (s, 1);
    s->problem = problem, s->options = *options;
    for (size_t i = 0; i < COUNT; i++) if (strcmp (entries[i]->name, options->kind) == 0) s->type = entries[i];
    if (!s->type) PG_FAIL (PG_E_USAGE, "there is no solver %s", options->kind);
    pg_system *sys = &s->breaker.system;
    sys->problem = problem, sys->force = force, sys->options = &s->options, sys->report = &s->report;
    PG_TRY (breaker_create (&s->breaker));
    PG_ALLOC (s->reaction, 3 * problem->nload);
    PG_ALLOC (s->work1, sys->ndof);
    PG_ALLOC (s->work2, sys->ndof);
    PG_TRY (pg_state_create (&s->backup, problem, sys->components));
    if (options->break_mode == PG_BREAK_ALL && problem->criterion->type)
        pg_report_warn (&s->report, "break: all breaks every bond over its limit at once: the peak load depends on the increment");
    *out = s;
    s = NULL;
done:
    pg_solver_free (&s);
    return status;
}

void pg_solver_free (pg_solver **solver)
{
    pg_solver *s = *solver;
    if (!s) return;
    breaker_free (&s->breaker);
    pg_free (s->unit), pg_free (s->reaction), pg_free (s->work1), pg_free (s->work2), pg_free (s->work3), pg_free (s->work4), pg_free (s->support), pg_free (s->force0);
    pg_state_free (&s->backup);
    pg_free (s);
    *solver = NULL;
}

int pg_solver_components (const pg_solver *s) { return s->breaker.system.components; }

const pg_force_type *pg_solver_force (const pg_solver *s, void **self)
{
    if (self) *self = s->breaker.system.self;
    return s->breaker.system.force;
}

pg_status pg_solver_step (pg_solver *s, pg_state *state, pg_step *step)
{
    pg_status status = PG_OK;
    memset (step, 0, sizeof *step);
    if (!s->started) PG_TRY (s->type->start (s, state));
    s->started = 1;
    breaker *b = &s->breaker;
    b->began = b->round, b->stopped = 0;
    if (b->round == 0) {                               /* else the step goes on where it was stopped                     */
        PG_TRY (pg_state_copy (s->backup, state));
        b->work0 = b->work, b->stored0 = s->report.energy_strain + s->report.energy_kinetic;
    }
    step->number = state->step + 1;
    PG_TRY (s->type->step (s, state, step));
    state->step++;
    state->iterations += step->iterations;
    state->work = s->breaker.work;
    step->stamp = s->options.event ? (double) step->number : step->time;
    step->reaction = s->reaction;
    pg_report *r = &s->report;
    r->steps++, r->iterations += step->iterations, r->broken += (long) step->nbroken;
    r->residual_max = fmax (r->residual_max, step->residual);
    r->utilisation_max = fmax (r->utilisation_max, step->utilisation);
    if (step->level && s->breaker.system.force->overlap)
        r->overlap_max = fmax (r->overlap_max, s->breaker.system.force->overlap (s->breaker.system.self, state, state->d));
    r->energy_external = s->breaker.work;
    r->energy_dissipated = r->energy_external - r->energy_strain - r->energy_kinetic;
done:
    if (status != PG_OK && s->started && !s->breaker.stopped) {
        char text[2048];
        snprintf (text, sizeof text, "%s", pg_last_error ());
        system_refresh (&s->breaker.system, s->backup, NULL);      /* fields asked for now are those of the accepted state       */
        s->breaker.work = s->backup->work, s->breaker.round = 0;
        if (status != PG_E_MEMORY) pg_error (status, PG_HERE, "step %ld at load factor %.6g is refused: %s", state->step + 1, state->factor, text);
        pg_state_copy (state, s->backup);
    }
    return status;
}

void pg_solver_watch (pg_solver *s, pg_watch watch, void *context) { s->breaker.watch = watch, s->breaker.watching = context; }

int pg_solver_done (const pg_solver *s, const pg_state *state) { return s->finished || (s->type->done && s->type->done (s, state)); }

double pg_solver_progress (const pg_solver *s, const pg_state *state)
{
    double p = s->options.event ? (double) (s->next_level - 1) / (double) s->options.levels : (double) state->step / (double) s->options.steps;
    return fmin (1, fmax (0, p));
}

static double largest_displacement (const pg_solver *s, const pg_state *state)
{
    double top = 0;
    for (size_t i = 0; i < s->breaker.system.ndof; i++) top = fmax (top, fabs (state->d[i]));
    return top;
}

const pg_report *pg_solver_report (pg_solver *s, const pg_state *state)
{
    pg_system *sys = &s->breaker.system;
    if (sys->force->census) sys->force->census (sys->self, &s->report.degenerate_points, &s->report.isolated_nodes, &s->report.fragments);
    if (sys->force->overlap) s->report.overlap_max = fmax (s->report.overlap_max, sys->force->overlap (sys->self, state, state->d));
    if (sys->kept && !s->skips_told && s->report.factorizations) {
        char what[96];
        snprintf (what, sizeof what, "factorization after %ld break rounds", sys->kept);
        pg_report_skip (&s->report, (double) sys->kept * s->report.seconds[PG_SECONDS_FACTOR] / (double) s->report.factorizations, what,
                        "only bonds broke that do not enter K (node-node bonds under Gauss integration)");
        s->skips_told = 1;
    }
    if (sys->spared && !s->spared_told && s->report.factorizations) {
        char what[96];
        snprintf (what, sizeof what, "factorization in %ld solves after a break", sys->spared);
        pg_report_skip (&s->report, (double) sys->spared * s->report.seconds[PG_SECONDS_FACTOR] / (double) s->report.factorizations, what,
                        "the factor of an earlier K preconditions conjugate gradients until a new one would pay (their time is not taken off)");
        s->spared_told = 1;
    }
    if (!s->energy_told && s->report.broken > 0 && s->report.energy_dissipated < -0.01 * s->report.energy_external) {
        pg_report_warn (&s->report, "breaking has fed %.3g J into the body instead of dissipating energy (external work %.3g J): single bonds are not an "
                        "objective measure of fracture", -s->report.energy_dissipated, s->report.energy_external);
        s->energy_told = 1;
    }
    if (!s->overlap_told && s->report.overlap_max > 1e-3 * largest_displacement (s, state)) {
        pg_report_warn (&s->report, "crack faces overlap by up to %.3g m (contact is not modelled)", s->report.overlap_max);
        s->overlap_told = 1;
    }
    return &s->report;
}

const pg_report *pg_solver_report_now (const pg_solver *s) { return &s->report; }
