/* SPDX-License-Identifier: GPL-3.0-or-later
 * Time step, end and number of steps of dynamic solvers. */
#include "solve.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { MOST_STEPS = 1000000000 };

static int is (const char *text, const char *word) { return text && strcmp (text, word) == 0; }
static int given (const pg_scene *scene, const char *key) { return pg_scene_given (scene, "%s", key); }

/* 1: the load is a spring or prescribes zeros only, and needs no ramp. */
static int stands_still (const pg_problem *p, const pg_load *load)
{
    for (size_t i = 0; i < load->set->npoint; i++)
        for (int k = 0; k < pg_load_components (load, p->dim); k++)
            if (load->value[k]
                && pg_load_value (load, k, p->dim,
                                  p->cloud.x + (size_t) load->set->point[i] * (size_t) p->dim, 1)
                       != 0)
                return 0;
    return pg_load_prescribes (load) || load->kind == PG_SPRING;
}

/* A linear ramp has no slope where the end of the run is not known. */
static void need_end (const pg_problem *problem, const pg_scene *scene)
{
    char path[64];
    for (size_t i = 0; i < problem->boundary.nload; i++) {
        snprintf (path, sizeof path, "boundary[%zu].ramp", i);
        int linear = given (scene, path)
                         ? is (pg_scene_text (scene, "%s", path), "linear")
                         : problem->boundary.load[i].kind != PG_VELOCITY && !problem->boundary.load[i].ntable;
        if (linear && !stands_still (problem, &problem->boundary.load[i]))
            pg_scene_fault (scene, path,
                            "linear rises up to the end of the run: give solver.end, or solver.dt beside "
                            "solver.time_steps");
    }
}

/* Reports what is missing of step, end and number of steps, and what is given twice. stable 1: the solver can
 * choose the step by the largest frequency of the body, so that one of the last two is enough. */
static void check_times (const pg_solver_options *o, const pg_scene *scene, int stable)
{
    if (!stable && !given (scene, "solver.dt") && !(o->end > 0 && o->time_steps))
        pg_scene_fault (scene, "solver.dt", "%s needs a time step", o->kind);
    if (!(o->end > 0) && !o->time_steps)
        pg_scene_fault (scene, "solver.end", "%s needs an end time%s", o->kind,
                        stable ? ", or solver.time_steps" : "");
    if (o->dt > 0 && o->end > 0 && o->time_steps)
        pg_scene_fault (scene, "solver.time_steps",
                        "solver.dt and solver.end say how many time steps there are: give two of the three");
}

/* Computes the third of step, end and number of steps from two of them. Equal steps fill the run, none longer
 * than asked. */
static void complete_times (pg_solver_options *o, const pg_scene *scene)
{
    if (o->time_steps && o->end > 0) o->dt = o->end / (double) o->time_steps;
    else if (o->time_steps && o->dt > 0) o->end = o->dt * (double) o->time_steps;
    else if (o->dt > 0 && o->end > 0) {
        double steps = ceil (o->end / o->dt * (1 - 1e-12));
        if (steps > MOST_STEPS) pg_scene_fault (scene, "solver.dt", "%g time steps are too many", steps);
        o->time_steps = (long) fmin (steps, MOST_STEPS);
        if (fabs (steps * o->dt - o->end) > 1e-9 * o->end) o->dt = o->end / steps;
    }
}

/* Reads the times of dynamic methods. Explicit ones choose the step themselves where none is given, so that
 * either the end or the number of steps may be left open until then. */
void options_read_times (pg_solver_options *o, const pg_problem *problem, const pg_scene *scene)
{
    int stable = (o->flags & PG_SOLVER_EXPLICIT) != 0;
    o->dt = options_number (scene, "solver.dt");
    o->end = options_number (scene, "solver.end");
    o->time_steps = options_integer (scene, "solver.time_steps");
    check_times (o, scene, stable);
    if (!(o->dt > 0 && o->end > 0 && o->time_steps)) complete_times (o, scene);
    if (!stable) o->steps = o->time_steps;
    if (stable && o->time_steps && !(o->end > 0)) need_end (problem, scene);
}
