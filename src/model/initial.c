/* SPDX-License-Identifier: GPL-3.0-or-later
 * initial: the velocity of every point at the start of a dynamic run. Direct forces only: their unknowns are displacements of points. */
#include "model.h"
#include <string.h>

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
    if (pg_expression_uses (p->initial[k], 't')) pg_scene_fault (scene, path, "it holds at the start: it does not change with t");
done:
    return status;
}

pg_status pg_initial_read (pg_problem *p, const pg_scene *scene)
{
    pg_status status = PG_OK;
    const char *kind = pg_scene_text (scene, "solver.kind");
    if (!pg_scene_given (scene, "initial.velocity")) return PG_OK;
    if (pg_kind_quasi_static (kind)) {
        pg_problem_note (p, "without meaning for solver: %s: initial", kind);
        return PG_OK;
    }
    if (!p->direct) pg_scene_fault (scene, "initial.velocity", "only with force: bond so far");
    for (int k = 0; p->direct && k < 3; k++) PG_TRY (read_component (p, scene, k));
done:
    return status;
}

void pg_initial_set (const pg_problem *p, double *v)
{
    size_t dim = (size_t) p->dim, stride = dim + (size_t) p->turns;
    for (size_t k = 0; k < dim; k++) {
        if (!p->initial[k]) continue;
        for (size_t i = 0; i < p->cloud.n; i++) {
            pg_place at = pg_place_of (p->dim, p->cloud.x + i * dim, 0);
            v[i * stride + k] = pg_expression_value (p->initial[k], &at);
        }
    }
}

void pg_initial_clear (pg_problem *p)
{
    for (int k = 0; k < 3; k++) pg_expression_free (&p->initial[k]);
}
