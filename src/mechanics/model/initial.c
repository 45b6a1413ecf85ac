/* SPDX-License-Identifier: GPL-3.0-or-later
 * Key `initial`: initial velocities of a dynamic run. Only for forces without shape functions, whose unknowns
 * are displacements of points. */
#include "model.h"
#include <math.h>
#include <string.h>

/* Component k of a velocity at the start (below the key `where`), an expression in x, y, z (m/s), not in
 * t. */
static pg_status read_component (pg_problem *p, const pg_scene *scene, const char *where, int k,
                                 pg_expression **out)
{
    pg_status status = PG_OK;
    const char *text = pg_scene_text (scene, "%s.%c", where, "xyz"[k]);
    char path[64];
    if (!text || !*text) return PG_OK;
    snprintf (path, sizeof path, "%s.%c", where, "xyz"[k]);
    if (k >= p->dim) {
        pg_scene_fault (scene, path, "a %dD body has no such component", p->dim);
        return PG_OK;
    }
    PG_TRY (pg_expression_compile (out, text, "m/s"));
    if (pg_expression_uses (*out, 't'))
        pg_scene_fault (scene, path, "it holds at the start: it does not change with t");
done:
    return status;
}

/* Reads the initial velocities of n sets. */
static pg_status read_sets (pg_problem *p, const pg_scene *scene, size_t n)
{
    pg_status status = PG_OK;
    PG_ALLOC (p->boundary.motion, n);
    p->boundary.nmotion = n;
    for (size_t i = 0; i < n; i++) {
        char path[64];
        snprintf (path, sizeof path, "initial.sets[%zu].set", i);
        p->boundary.motion[i].set = pg_sets_named (&p->sets, scene, path, pg_scene_text (scene, "%s", path));
        snprintf (path, sizeof path, "initial.sets[%zu].velocity", i);
        for (int k = 0; k < 3; k++)
            PG_TRY (read_component (p, scene, path, k, &p->boundary.motion[i].value[k]));
    }
done:
    return status;
}

/* Reads the section `initial`, which quasi-static solvers ignore. */
pg_status pg_initial_read (pg_problem *p, const pg_scene *scene)
{
    pg_status status = PG_OK;
    const char *kind = pg_scene_text (scene, "solver.kind");
    char names[160];
    size_t parts = pg_scene_count (scene, "initial.sets");
    if (!pg_scene_given (scene, "initial.velocity") && parts == 0) return PG_OK;
    if (pg_scene_entry_is (scene, "solver.kind", PG_SOLVER_QUASI_STATIC)) {
        pg_problem_note (p, "ignored with solver: %s: initial", kind);
        return PG_OK;
    }
    if (p->method->shape_functions)
        pg_scene_fault (scene, parts ? "initial.sets" : "initial.velocity",
                        "not with force: %s so far: use %s", p->method->name,
                        pg_methods_of_points (p, names, sizeof names));
    for (int k = 0; !p->method->shape_functions && k < 3; k++)
        PG_TRY (read_component (p, scene, "initial.velocity", k, &p->boundary.initial[k]));
    if (!p->method->shape_functions && parts) PG_TRY (read_sets (p, scene, parts));
done:
    return status;
}

/* Component k of the initial velocity at x, m/s. */
static double velocity_at (const pg_problem *p, pg_expression *const *value, const double *x, size_t k)
{
    pg_place at = pg_place_of (p->dim, x, 0);
    return value[k] ? pg_expression_value (value[k], &at) : 0;
}

/* dv_k / dx_a at point i by the difference over one spacing, 1/s; 0 where the expression has no value
 * there. */
static double slope_at (const pg_problem *p, pg_expression *const *value, size_t i, size_t k, size_t a)
{
    size_t dim = (size_t) p->dim;
    double x[3] = { 0 }, v[2];
    for (int end = 0; end < 2; end++) {
        memcpy (x, p->cloud.x + i * dim, dim * sizeof *x);
        x[a] += (end - 0.5) * p->cloud.h;
        v[end] = velocity_at (p, value, x, k);
    }
    double slope = (v[1] - v[0]) / p->cloud.h;
    return isfinite (slope) ? slope : 0;
}

/* Sets the initial velocity of point i. Rotations get half the curl of the velocity times h (unknown: spacing
 * times rotation), so that a rigidly rotating body is free of strain rates. */
static void set_point (const pg_problem *p, pg_expression *const *value, size_t i, double *own)
{
    size_t dim = (size_t) p->dim;
    int rotations = pg_problem_rotations (p);
    for (size_t k = 0; k < dim; k++) own[k] = velocity_at (p, value, p->cloud.x + i * dim, k);
    if (rotations == 1)
        own[2] = 0.5 * p->cloud.h * (slope_at (p, value, i, 1, 0) - slope_at (p, value, i, 0, 1));
    for (size_t t = 0; rotations == 3 && t < 3; t++) {
        size_t y = (t + 1) % 3, z = (t + 2) % 3;
        own[3 + t] = 0.5 * p->cloud.h * (slope_at (p, value, i, z, y) - slope_at (p, value, i, y, z));
    }
}

/* Sets the initial velocities of all points, then those of sets, of which later ones prevail. */
void pg_initial_set (const pg_problem *p, double *v)
{
    size_t stride = (size_t) pg_problem_unknowns (p);
    int all = p->boundary.initial[0] || p->boundary.initial[1] || p->boundary.initial[2];
    for (size_t i = 0; all && i < p->cloud.n; i++) set_point (p, p->boundary.initial, i, v + i * stride);
    for (size_t m = 0; m < p->boundary.nmotion; m++)
        for (size_t q = 0; q < p->boundary.motion[m].set->npoint; q++) {
            size_t i = (size_t) p->boundary.motion[m].set->point[q];
            set_point (p, p->boundary.motion[m].value, i, v + i * stride);
        }
}

/* Frees the initial velocities of the scene, if there are any. */
void pg_initial_clear (pg_problem *p)
{
    for (int k = 0; k < 3; k++) pg_expression_free (&p->boundary.initial[k]);
    for (size_t m = 0; m < p->boundary.nmotion; m++)
        for (int k = 0; k < 3; k++) pg_expression_free (&p->boundary.motion[m].value[k]);
    pg_free (p->boundary.motion);
    p->boundary.motion = NULL, p->boundary.nmotion = 0;
}
