/* SPDX-License-Identifier: GPL-3.0-or-later
 * Loads and supports must be finite numbers wherever and whenever they act: a root of a negative number or a
 * quotient by zero is an error of the scene, found before the first step. Evaluated at the points, or facets,
 * of each entry of `boundary` and at LOOKS times of the run; at other times the residual reveals it. */
#include "model.h"
#include <math.h>
#include <stdio.h>

enum { LOOKS = 16 };

/* Finds the first position (m) and time at which component k is not finite; returns 1: there is one. */
static int finds_none (const pg_problem *p, const pg_load *load, int k, double duration, double *where,
                       double *when, double *value)
{
    const pg_set *s = load->set;
    size_t dim = (size_t) p->dim, n = s->npoint ? s->npoint : s->nfacet;
    int apart = pg_load_separates (load);
    for (int look = 1; look <= LOOKS; look++) {
        double t = duration * look / LOOKS;
        /* separable load: one point suffices for the time factor, one time for the spatial pattern */
        for (size_t i = 0; i < (apart && look < LOOKS && n ? 1 : n); i++) {
            const double *x = s->npoint ? p->cloud.x + (size_t) s->point[i] * dim
                                        : p->cells.facet_centre + (size_t) s->facet[i] * dim;
            *value = pg_load_value (load, k, p->dim, x, t);
            if (isfinite (*value)) continue;
            for (size_t c = 0; c < dim; c++) where[c] = x[c];
            *when = t;
            return 1;
        }
    }
    return 0;
}

void pg_loads_check_finite (const pg_problem *p, const pg_scene *scene, double duration)
{
    size_t own = pg_scene_count (scene, "boundary");
    if (pg_scene_verdict (scene) != PG_OK) return;     /* loads with errors may lack expressions */
    for (size_t i = 0; i < own && i < p->boundary.nload; i++) {
        const pg_load *load = &p->boundary.load[i];
        char path[32];
        int components = load->kind == PG_PRESSURE ? 1 : pg_load_components (load, p->dim);
        for (int k = 0; load->set && k < components; k++) {
            double x[3] = { 0 }, t, value;
            if (!finds_none (p, load, k, duration, x, &t, &value)) continue;
            snprintf (path, sizeof path, "boundary[%zu]", i);
            pg_scene_fault (scene, path,
                            "the value of %s is %s at x %.6g m, y %.6g m, z %.6g m and t = %.6g: it must be "
                            "finite there; such as by max (...) under a root, or a set that ends before",
                            load->name, isnan (value) ? "no number" : "infinite", x[0], x[1], x[2], t);
            break;
        }
    }
}
