/* SPDX-License-Identifier: GPL-3.0-or-later
 * Checks what does not go together with platens. */
#include "solve/contact/contact.h"
#include <math.h>
#include <stdio.h>

/* 1: a facet lies on the platen, face to face. */
static int lies_on (const pg_problem *p, const pg_platen *platen, size_t facet)
{
    size_t dim = (size_t) p->dim;
    const double *x = p->cells.facet_centre + facet * dim, *outward = p->cells.normal + facet * dim;
    double normal[3], along = 0, away = pg_platen_distance (platen, p->dim, x, normal);
    for (size_t k = 0; k < dim; k++) along += normal[k] * outward[k];
    return fabs (away) <= PG_NO_LENGTH * p->cloud.h && along < -1 + 1e-9;
}

int platens_touch (const pg_problem *p)
{
    for (size_t i = 0; i < p->boundary.nplaten; i++) {
        size_t f = 0;
        while (f < p->cells.nfacet && !lies_on (p, &p->boundary.platen[i], f)) f++;
        if (f == p->cells.nfacet) return 0;
    }
    return 1;
}

static int finds_equilibria (const pg_solver_type *type, const void *unused)
{
    (void) unused;
    return (type->flags & PG_SOLVER_STATIC) == PG_SOLVER_STATIC;
}

static void check_stepping (const pg_solver_options *o, const pg_problem *problem, const pg_scene *scene)
{
    if (!o->event) return;
    if (PG_OWN (pg_static_options, o)->affine)
        pg_scene_fault (scene, "solver.stepping",
                        "event does not go with platens where loads have a constant part, or stages: use "
                        "fixed");
    else if (!platens_touch (problem))
        pg_scene_fault (scene, "solver.stepping",
                        "event needs platens that touch the body from the start, face to face, as equilibria "
                        "do not grow in proportion to the load else: use fixed");
}

/* Refuses keys that have a meaning in explicit dynamics alone. */
static void refuse_masses (const pg_problem *problem, const pg_scene *scene)
{
    static const char *const key[2] = { "mass", "velocity" };
    char path[64];
    for (size_t i = 0; i < problem->boundary.nplaten; i++)
        for (int k = 0; k < 2; k++) {
            snprintf (path, sizeof path, "platens[%zu].%s", i, key[k]);
            if (pg_scene_given (scene, "%s", path))
                pg_scene_fault (scene, path, "has a meaning in explicit steps alone: leave it out");
        }
}

/* Refuses points of the body inside a platen at the start, which would be thrown out. */
static void refuse_inside (const pg_problem *problem, size_t i, const pg_scene *scene)
{
    size_t dim = (size_t) problem->dim, at = 0;
    const double *x = problem->cloud.x;
    double normal[3], worst = 0;
    char path[64];
    for (size_t k = 0; k < problem->cloud.n; k++) {
        double h = problem->cloud.size ? problem->cloud.size[k] : problem->cloud.h,
               away = pg_platen_distance (&problem->boundary.platen[i], problem->dim, x + k * dim, normal);
        if (away < -PG_NO_LENGTH * h && away < worst) worst = away, at = k;
    }
    if (!(worst < 0)) return;
    snprintf (path, sizeof path, "platens[%zu].point", i);
    pg_scene_fault (scene, path,
                    "the platen holds points of the body at the start, the one at (%.6g, %.6g, %.6g) m lies "
                    "%.3g m inside it: put it outside the body, its normal towards the body", x[at * dim],
                    dim > 1 ? x[at * dim + 1] : 0, dim > 2 ? x[at * dim + 2] : 0, -worst);
}

/* Checks platens in explicit steps, which act by a penalty on displacements of points. */
static void check_moving (const pg_problem *problem, const pg_scene *scene)
{
    char path[64];
    if (problem->method->shape_functions && !problem->form.approx.type->interpolates)
        pg_scene_fault (scene, "platens",
                        "in explicit steps they press points, whose displacements the unknowns of "
                        "method.approximation: %s are not: take another force, or supports on sets",
                        problem->form.approx.type->name);
    for (size_t i = 0; i < problem->boundary.nplaten; i++) {
        const pg_platen *p = &problem->boundary.platen[i];
        snprintf (path, sizeof path, "platens[%zu].tilt", i);
        if (p->tilts) pg_scene_fault (scene, path, "platens do not turn in explicit steps so far: use held");
        snprintf (path, sizeof path, "platens[%zu].mass", i);
        if (p->force >= 0 && !(p->mass > 0))
            pg_scene_fault (scene, path, "a platen that a force moves needs it in explicit steps");
        snprintf (path, sizeof path, "platens[%zu].velocity", i);
        if (pg_scene_given (scene, "%s", path) && !(p->mass > 0))
            pg_scene_fault (scene, path, "is that of a platen with a mass: give the mass, or a displacement "
                            "of velocity times t (ramp: constant)");
        refuse_inside (problem, i, scene);
    }
}

void platens_check (const pg_solver_options *o, const pg_problem *problem, const pg_scene *scene)
{
    const pg_force_type *force = pg_force_of (problem);
    char names[200];
    if (!problem->boundary.nplaten) return;
    if (o->flags & PG_SOLVER_EXPLICIT) {
        check_moving (problem, scene);
        return;
    }
    refuse_masses (problem, scene);
    solver_names_that (finds_equilibria, NULL, names, sizeof names);
    if (force && !force->surfaces.trace)
        pg_scene_fault (scene, "platens",
                        "force: %s does not show the displacement of the surface: take a force with shape "
                        "functions", problem->method->name);
    if (!problem->cells.nfacet)
        pg_scene_fault (scene, "platens", "a body of explicit points has no surface that could touch them");
    if ((o->flags & PG_SOLVER_STATIC) != PG_SOLVER_STATIC) {
        pg_scene_fault (scene, "platens", "solver.kind: %s does not know rigid platens so far: use %s, or "
                        "supports on sets", o->kind, names);
        return;
    }
    if (problem->criterion->type && !pg_criterion_of_tips (problem->criterion))
        pg_scene_fault (scene, "platens",
                        "go with cracks that grow by facets, not with single bonds that break: judge tips "
                        "(break: facet), or leave failure out");
    else if (options_begin_cracks (problem))
        pg_scene_fault (scene, "platens",
                        "do not go with a strength yet, at which new cracks begin: leave "
                        "failure.tensile_strength and failure.cohesion out");
    for (size_t k = 0; k < problem->boundary.nstage; k++)
        if (problem->boundary.stage[k].remove)
            pg_scene_fault (scene, "platens",
                            "do not know parts that stages take out of the body: leave their remove out");
    if (o->on_instability != PG_UNSTABLE_FOLLOW)
        pg_scene_fault (scene, "solver.on_instability",
                        "with platens the load follows equilibrium only: use follow");
    check_stepping (o, problem, scene);
}
