/* SPDX-License-Identifier: GPL-3.0-or-later
 * Options of the solver from the keys of a scene, and what does not go together. */
#include "solve.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { MOST_STEPS = 1000000000 };

static int is (const char *text, const char *word) { return text && strcmp (text, word) == 0; }
static int given (const pg_scene *scene, const char *key) { return pg_scene_given (scene, "%s", key); }
static double number_if (const pg_scene *scene, const char *key)
{
    return given (scene, key) ? pg_scene_number (scene, "%s", key) : 0;
}
static long integer_if (const pg_scene *scene, const char *key)
{
    return given (scene, key) ? pg_scene_integer (scene, "%s", key) : 0;
}

static void read_breaking (pg_solver_options *o, const pg_problem *problem, const pg_scene *scene)
{
    const char *mode = pg_scene_text (scene, "solver.break"),
               *stop = pg_scene_text (scene, "solver.stop.set");
    o->break_mode = is (mode, "all")        ? PG_BREAK_ALL
                    : is (mode, "fraction") ? PG_BREAK_FRACTION
                    : is (mode, "passing")  ? PG_BREAK_PASSING
                                            : PG_BREAK_WORST;
    o->break_fraction = pg_scene_number (scene, "solver.break_fraction");
    o->tie = pg_scene_number (scene, "solver.tie");
    o->max_events = pg_scene_integer (scene, "solver.max_events");
    o->stop_stiffness = pg_scene_number (scene, "solver.stop.stiffness");
    o->stop_damage = pg_scene_number (scene, "solver.stop.damage");
    if (stop && *stop) o->stop_set = pg_sets_named (&problem->sets, scene, "solver.stop.set", stop);
    if (o->break_mode == PG_BREAK_PASSING && !o->staged && !o->marching)
        pg_scene_fault (scene, "solver.break", "passing goes with solver.kind: adr and relax");
}

static void read_static (pg_solver_options *o, const pg_problem *problem, const pg_scene *scene)
{
    const char *stepping = pg_scene_text (scene, "solver.stepping");
    int proportional = pg_problem_proportional (problem);
    o->steps = pg_scene_integer (scene, "solver.steps");
    o->event = is (stepping, "event")
               || (is (stepping, "auto") && proportional && o->break_mode != PG_BREAK_ALL);
    o->affine = o->event && !proportional;
    if (o->affine && !pg_problem_affine (problem))
        pg_scene_fault (scene, "solver.stepping",
                        "event stepping needs loads that grow with the load factor (ramp: linear), stay "
                        "(ramp: constant), or both: use fixed");
    if (o->event && o->break_mode == PG_BREAK_ALL)
        pg_scene_fault (scene, "solver.break", "all goes with stepping: fixed");
    if (!given (scene, "solver.steps") && o->levels > o->steps) o->steps = o->levels;
}

/* Nothing prescribed but zero needs no ramp. */
static int stands_still (const pg_problem *p, const pg_load *load)
{
    for (size_t i = 0; i < load->set->npoint; i++)
        for (int k = 0; k < pg_load_components (load, p->dim); k++)
            if (load->value[k]
                && pg_load_value (load, k, p->dim,
                                  p->cloud.x + (size_t) load->set->point[i] * (size_t) p->dim, 1)
                       != 0)
                return 0;
    return pg_load_prescribes (load);
}

static void need_end (const pg_problem *problem, const pg_scene *scene)
{
    char path[64];
    for (size_t i = 0; i < problem->nload; i++) {
        snprintf (path, sizeof path, "boundary[%zu].ramp", i);
        int linear = given (scene, path) ? is (pg_scene_text (scene, "%s", path), "linear")
                                         : problem->load[i].kind != PG_VELOCITY && !problem->load[i].ntable;
        if (linear && !stands_still (problem, &problem->load[i]))
            pg_scene_fault (scene, path,
                            "linear rises up to the end of the run: give solver.end, or solver.dt beside "
                            "solver.time_steps");
    }
}

/* dt, end and time_steps: newmark needs two of them, explicit methods one of the last two. Equal steps fill
 * the run, none longer than asked. */
static void read_times (pg_solver_options *o, const pg_problem *problem, const pg_scene *scene)
{
    const char *kind = o->kind;
    o->end = number_if (scene, "solver.end");
    o->time_steps = integer_if (scene, "solver.time_steps");
    if (!o->marching && !given (scene, "solver.dt") && !(o->end > 0 && o->time_steps))
        pg_scene_fault (scene, "solver.dt", "%s needs a time step", kind);
    if (!(o->end > 0) && !o->time_steps)
        pg_scene_fault (scene, "solver.end", "%s needs an end time%s", kind,
                        o->marching ? ", or solver.time_steps" : "");
    if (o->dt > 0 && o->end > 0 && o->time_steps)
        pg_scene_fault (scene, "solver.time_steps",
                        "solver.dt and solver.end say how many time steps there are: give two of the three");
    else if (o->time_steps && o->end > 0) o->dt = o->end / (double) o->time_steps;
    else if (o->time_steps && o->dt > 0) o->end = o->dt * (double) o->time_steps;
    else if (o->dt > 0 && o->end > 0) {
        double steps = ceil (o->end / o->dt * (1 - 1e-12));
        if (steps > MOST_STEPS) pg_scene_fault (scene, "solver.dt", "%g time steps are too many", steps);
        o->time_steps = (long) fmin (steps, MOST_STEPS);
        if (fabs (steps * o->dt - o->end) > 1e-9 * o->end) o->dt = o->end / steps;
    }
    if (!o->marching) o->steps = o->time_steps;
    if (o->marching && o->time_steps && !(o->end > 0)) need_end (problem, scene);
}

static void need_density (const pg_solver_options *o, const pg_problem *problem, const pg_scene *scene)
{
    for (size_t i = 0; i < problem->nmaterial; i++)
        if (!(problem->material[i].density > 0))
            pg_scene_fault (scene, "solver.kind", "%s needs the density of material %s", o->kind,
                            problem->material[i].name);
}

static void read_newmark (pg_solver_options *o, const pg_problem *problem, const pg_scene *scene)
{
    const pg_force_type *force = pg_force_find (problem->force);
    o->consistent = is (pg_scene_text (scene, "solver.mass"), "consistent");
    if (o->consistent && force && !force->mass_matrix)
        pg_scene_fault (scene, "solver.mass", "force: %s has no consistent mass: use lumped", problem->force);
    o->alpha = pg_scene_number (scene, "solver.alpha");
    o->beta = given (scene, "solver.beta") ? pg_scene_number (scene, "solver.beta")
                                           : (1 - o->alpha) * (1 - o->alpha) / 4;
    o->gamma = given (scene, "solver.gamma") ? pg_scene_number (scene, "solver.gamma") : 0.5 - o->alpha;
    if (o->gamma > 2 * o->beta)
        pg_scene_fault (scene, "solver.beta", "newmark is unconditionally stable only for 2 beta >= gamma");
}

/* What the explicit methods leave to newmark. */
static void read_explicit (pg_solver_options *o, const pg_scene *scene)
{
    if (is (pg_scene_text (scene, "solver.mass"), "consistent"))
        pg_scene_fault (scene, "solver.mass", "%s needs the lumped mass", o->kind);
    if (o->rayleigh_stiffness > 0)
        pg_scene_fault (
            scene, "solver.rayleigh.stiffness",
            "%s is damped by the mass alone: damping by the stiffness would shrink the stable time step",
            o->kind);
}

static void read_stages (pg_solver_options *o, const pg_scene *scene)
{
    o->stages = pg_scene_integer (scene, "solver.stages");
    o->hold = pg_scene_bool (scene, "solver.hold");
    o->imbalance = pg_scene_number (scene, "solver.imbalance");
    o->damping = number_if (scene, "solver.damping");
    if (!given (scene, "solver.break")) o->break_mode = PG_BREAK_PASSING;
    if (!o->hold && o->break_mode != PG_BREAK_PASSING)
        pg_scene_fault (scene, "solver.break",
                        "%s goes by balanced states, which there are none with hold: off",
                        pg_scene_text (scene, "solver.break"));
    if (is (o->kind, "adr")) o->damping = o->dt = 0;  /* left over from relax: its own damping, a step of 1 */
}

/* Keys of the solver that only other kinds heed: left over from one of them, they are no fault. */
static void find_unused (pg_solver_options *o, const pg_scene *scene)
{
    enum {
        STATIC = 1,
        NEWMARK = 2,
        MARCHING = 4,
        ADR = 8,
        RELAX = 16,
        IMPLICIT = STATIC | NEWMARK,
        TIMED = NEWMARK | MARCHING,
        STAGED = ADR | RELAX
    };
    static const struct { const char *key; int kinds;
    } keys[] = {
        { "stepping", STATIC },
        { "steps", STATIC },
        { "stop.stiffness", STATIC },
        { "break", IMPLICIT | STAGED },
        { "break_fraction", IMPLICIT | STAGED },
        { "tie", IMPLICIT | STAGED },
        { "tolerance", IMPLICIT },
        { "max_iterations", IMPLICIT | STAGED },
        { "linear", IMPLICIT },
        { "preconditioner", IMPLICIT },
        { "dt", TIMED | RELAX },
        { "end", TIMED },
        { "time_steps", TIMED },
        { "stages", STAGED },
        { "hold", STAGED },
        { "imbalance", STAGED },
        { "damping", RELAX },
        { "mass", TIMED },
        { "alpha", NEWMARK },
        { "beta", NEWMARK },
        { "gamma", NEWMARK },
        { "rayleigh.mass", TIMED },
        { "rayleigh.stiffness", TIMED },
    };
    int kind = o->marching             ? MARCHING
               : !o->quasi_static      ? NEWMARK
               : !o->staged            ? STATIC
               : is (o->kind, "relax") ? RELAX
                                       : ADR;
    size_t used = 0;
    for (size_t k = 0; k < sizeof keys / sizeof *keys; k++)
        if (!(keys[k].kinds & kind) && pg_scene_given (scene, "solver.%s", keys[k].key)
            && used < sizeof o->unused)
            used += (size_t) snprintf (o->unused + used, sizeof o->unused - used, "%s%s", used ? ", " : "",
                                       keys[k].key);
}

pg_status pg_solver_options_read (pg_solver_options *o, const pg_problem *problem, const pg_scene *scene)
{
    memset (o, 0, sizeof *o);
    o->scene = scene;
    snprintf (o->kind, sizeof o->kind, "%s", pg_scene_text (scene, "solver.kind"));
    snprintf (o->linear, sizeof o->linear, "%s", pg_scene_text (scene, "solver.linear"));
    const pg_solver_type *type = solver_type_find (o->kind);
    snprintf (o->preconditioner, sizeof o->preconditioner, "%s",
              pg_scene_text (scene, "solver.preconditioner"));
    o->quasi_static = pg_kind_quasi_static (o->kind);
    o->marching = type && type->way == MARCHES, o->staged = type && type->way == RELAXES;
    o->tolerance = pg_scene_number (scene, "solver.tolerance");
    o->max_iterations = pg_scene_integer (scene, "solver.max_iterations");
    o->levels = pg_scene_integer (scene, "output.at.levels");
    o->rayleigh_mass = pg_scene_number (scene, "solver.rayleigh.mass");
    o->rayleigh_stiffness = pg_scene_number (scene, "solver.rayleigh.stiffness");
    o->dt = number_if (scene, "solver.dt");
    read_breaking (o, problem, scene);
    o->rows = o->marching || o->staged ? integer_if (scene, "output.at.rows") : 0;
    if (o->marching) read_explicit (o, scene);
    if (o->staged) read_stages (o, scene);
    else if (o->quasi_static) read_static (o, problem, scene);
    if (!o->quasi_static) read_times (o, problem, scene);
    if (!o->quasi_static && !o->marching) read_newmark (o, problem, scene);
    find_unused (o, scene);
    if (!o->quasi_static || is (o->kind, "relax")) need_density (o, problem, scene);
    const pg_force_type *force = pg_force_find (problem->force);
    const char *why = force && force->refuses ? force->refuses (problem, o->kind) : NULL;
    if (why) pg_scene_fault (scene, "solver.kind", "%s", why);
    return pg_scene_verdict (scene);
}
