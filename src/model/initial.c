/* SPDX-License-Identifier: GPL-3.0-or-later
 * initial: the velocity of every point at the start of a dynamic run. Direct forces only: their unknowns are
 * displacements of points. */
#include "model.h"
#include <math.h>
#include <string.h>

/* Component k of the velocity at the start, an expression in x, y, z (m/s); time has no place in it. */
static pg_status read_component (pg_problem *p, const pg_scene *scene, int k)
{
    pg_status status = PG_OK;
    const char *text = pg_scene_text (scene, "initial.velocity.%c", "xyz"[k]);
    char path[32];
    if (!text || !*text) return PG_OK;
    snprintf (path, sizeof path, "initial.velocity.%c", "xyz"[k]);
    if (k >= p->dim) {
        pg_scene_fault (scene, path, "a %dD body has no such component", p->dim);
        return PG_OK;
    }
    PG_TRY (pg_expression_compile (&p->initial[k], text, "m/s"));
    if (pg_expression_uses (p->initial[k], 't'))
        pg_scene_fault (scene, path, "it holds at the start: it does not change with t");
done:
    return status;
}

/* Ignored by quasi-static solvers, which know no velocity. */
pg_status pg_initial_read (pg_problem *p, const pg_scene *scene)
{
    pg_status status = PG_OK;
    const char *kind = pg_scene_text (scene, "solver.kind");
    char names[160];
    if (!pg_scene_given (scene, "initial.velocity")) return PG_OK;
    if (pg_solver_is (kind, PG_SOLVER_QUASI_STATIC)) {
        pg_problem_note (p, "ignored with solver: %s: initial", kind);
        return PG_OK;
    }
    if (p->method->shape_functions)
        pg_scene_fault (scene, "initial.velocity", "not with force: %s so far: use %s", p->method->name,
                        pg_methods_of_points (p, names, sizeof names));
    for (int k = 0; !p->method->shape_functions && k < 3; k++) PG_TRY (read_component (p, scene, k));
done:
    return status;
}

/* Component k at a place, m/s. */
static double velocity_at (const pg_problem *p, const double *x, size_t k)
{
    pg_place at = pg_place_of (p->dim, x, 0);
    return p->initial[k] ? pg_expression_value (p->initial[k], &at) : 0;
}

/* dv_k / dx_a at point i by the difference over one spacing, 1/s; 0 where the expression has no value
 * there. */
static double slope_at (const pg_problem *p, size_t i, size_t k, size_t a)
{
    size_t dim = (size_t) p->dim;
    double x[3] = { 0 }, v[2];
    for (int end = 0; end < 2; end++) {
        memcpy (x, p->cloud.x + i * dim, dim * sizeof *x);
        x[a] += (end - 0.5) * p->cloud.h;
        v[end] = velocity_at (p, x, k);
    }
    double slope = (v[1] - v[0]) / p->cloud.h;
    return isfinite (slope) ? slope : 0;
}

/* Points with rotations turn with the velocity of the body about them, half its curl (unknown: spacing times
 * rotation): a body that spins is at rest in itself. */
void pg_initial_set (const pg_problem *p, double *v)
{
    size_t dim = (size_t) p->dim, stride = (size_t) pg_problem_unknowns (p);
    int rotations = pg_problem_rotations (p);
    if (!p->initial[0] && !p->initial[1] && !p->initial[2]) return;
    for (size_t i = 0; i < p->cloud.n; i++) {
        double *own = v + i * stride;
        for (size_t k = 0; k < dim; k++) own[k] = velocity_at (p, p->cloud.x + i * dim, k);
        if (rotations == 1) own[2] = 0.5 * p->cloud.h * (slope_at (p, i, 1, 0) - slope_at (p, i, 0, 1));
        for (size_t t = 0; rotations == 3 && t < 3; t++) {
            size_t y = (t + 1) % 3, z = (t + 2) % 3;
            own[3 + t] = 0.5 * p->cloud.h * (slope_at (p, i, z, y) - slope_at (p, i, y, z));
        }
    }
}

/* Also where nothing was given. */
void pg_initial_clear (pg_problem *p)
{
    for (int k = 0; k < 3; k++) pg_expression_free (&p->initial[k]);
}
