/* SPDX-License-Identifier: GPL-3.0-or-later
 * Properties of a problem: default criterion, crack growth, time dependence of loads; notes. */
#include "model.h"
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

/* Returns 1: the limit is given in `failure` or for one of the materials. */
static int limit_given (const pg_problem *p, const pg_scene *scene, const char *limit)
{
    int given = pg_scene_given (scene, "failure.%s", limit);
    for (size_t m = 0; m < p->nmaterial; m++)
        given |= pg_scene_given (scene, "materials.%s.failure.%s", p->material[m].name, limit);
    return given;
}

/* Default criterion where `failure` names none: that of the force, or by the limits given: with a fracture
 * energy the criterion of tips if possible (2D: unless solver.break differs; 3D: only with solver.break:
 * facet), else that of stretch. */
const char *pg_problem_usual_criterion (const pg_problem *p, const pg_scene *scene)
{
    if (p->method->judged_by) return pg_criterion_by_need (p->method->judged_by);
    int energy = pg_scene_given (scene, "failure.fracture_energy"),
        how = pg_scene_given (scene, "solver.break"),
        facets = how ? strcmp (pg_scene_text (scene, "solver.break"), "facet") == 0 : p->dim == 2,
        tips = p->dim > 1 && facets && p->method->shape_functions && (p->method->shows & PG_NEEDS_FACETS)
               && pg_scene_entry_is (scene, "solver.kind", PG_SOLVER_FACETS)
               && pg_scene_entry_is (scene, "solver.kind", PG_SOLVER_STATIC);
    if (tips && limit_given (p, scene, "fracture_energy")) return pg_criterion_by_need (PG_NEEDS_FACETS);
    return energy || pg_scene_given (scene, "failure.critical_stretch")
               ? pg_criterion_by_need (PG_NEEDS_STRETCH) : NULL;
}

int pg_problem_by_facets (const pg_problem *p, const pg_scene *scene)
{
    int given = pg_scene_given (scene, "failure.criterion");
    const char *named = given ? pg_scene_text (scene, "failure.criterion")
                              : pg_problem_usual_criterion (p, scene);
    const pg_criterion_type *type = named ? pg_criterion_find (named) : NULL;
    return type && (type->needs & PG_NEEDS_FACETS);
}

/* Adds a note; beyond the maximum number notes are dropped. */
void pg_problem_note (pg_problem *p, const char *format, ...)
{
    va_list args;
    if (p->notes.n == sizeof p->notes.text / sizeof *p->notes.text) return;
    va_start (args, format);
    vsnprintf (p->notes.text[p->notes.n++], sizeof *p->notes.text, format, args);
    va_end (args);
}

/* 1: the criterion applies to tips, so that cracks (2D: lines, 3D: surfaces) grow by facets. */
int pg_problem_grows (const pg_problem *p)
{
    return p->dim >= 2 && p->criterion && p->criterion->type && (p->criterion->type->needs & PG_NEEDS_FACETS);
}

/* Returns 1: all loads are proportional to t, u = t u_1 and F = t F_1, so that event stepping can scale one
 * solution (solve/events/event_stepping.c). Displacements that are zero at three arbitrary positions and
 * times count as proportional. */
int pg_problem_proportional (const pg_problem *p)
{
    if (p->boundary.nstage || pg_problem_strained (p)) return 0;
    for (size_t i = 0; i < p->boundary.nload; i++) {
        if (p->boundary.load[i].proportional) continue;
        /* a zero displacement is proportional, too */
        static const double places[3][3] = { { 0.37, -0.21, 0.83 },
                                             { -1.3, 2.7, 0.11 },
                                             { 5.1, 0.77, -3.9 } };
        int held = pg_load_prescribes (&p->boundary.load[i]) || p->boundary.load[i].kind == PG_SPRING;
        for (int k = 0; k < pg_load_components (&p->boundary.load[i], p->dim) && held; k++)
            for (int q = 0; q < 9 && held; q++)
                held = pg_load_value (&p->boundary.load[i], k, p->dim, places[q % 3], 0.1 + 0.4 * (q / 3))
                       == 0;
        if (!held) return 0;
    }
    return 1;
}

/* Returns 1: component k of the load at x is linear in t between 0 and 1, as tested at fifteen times and at
 * the rows of a table, to rounding. */
static int is_affine (const pg_load *load, int k, int dim, const double *x)
{
    double a = pg_load_value (load, k, dim, x, 0), b = pg_load_value (load, k, dim, x, 1),
           size = fmax (fabs (a), fabs (b));
    for (int q = 1; q < 16; q++) {
        double t = q / 16.0 + 0.01;
        if (fabs (pg_load_value (load, k, dim, x, t) - a - t * (b - a)) > 1e-12 * size) return 0;
    }
    for (size_t row = 0; row < load->ntable; row++) {
        double t = load->table[2 * row];
        if (t > 0 && t < 1 && fabs (pg_load_value (load, k, dim, x, t) - a - t * (b - a)) > 1e-12 * size)
            return 0;
    }
    return 1;
}

/* Returns 1: all loads are a + b t between t = 0 and 1, so that event stepping can scale the difference of
 * two solutions. Separable loads are tested at one position, others at every point of their set. */
int pg_problem_affine (const pg_problem *p)
{
    if (pg_problem_strained (p)) return 0;             /* event stepping does not support free strains */
    if (p->boundary.nstage) return 1;                           /* loads are linear within each stage */
    double middle[3] = { 0 };
    for (int k = 0; k < p->dim; k++) middle[k] = 0.37 * p->cloud.low[k] + 0.63 * p->cloud.high[k];
    for (size_t l = 0; l < p->boundary.nload; l++) {
        const pg_load *load = &p->boundary.load[l];
        int components = load->kind == PG_PRESSURE ? 1 : pg_load_components (load, p->dim);
        size_t n = pg_load_separates (load) ? 0 : load->set->npoint;
        for (int k = 0; k < components; k++) {
            if (!is_affine (load, k, p->dim, middle)) return 0;
            for (size_t i = 0; i < n; i++)
                if (!is_affine (load, k, p->dim, p->cloud.x + (size_t) load->set->point[i] * (size_t) p->dim))
                    return 0;
        }
    }
    return 1;
}
