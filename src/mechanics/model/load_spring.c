/* SPDX-License-Identifier: GPL-3.0-or-later
 * Springs at a set or a position: stiffness, and displacement of their other ends. */
#include "model.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

double pg_load_share (const pg_load *load, size_t i)
{
    return load->share ? load->share[i] : 1 / (double) pg_set_points (load->set);
}
const double *pg_load_site (const pg_load *load, const double *x) { return load->own ? load->at : x; }

/* Distributes the spring stiffness over the points of a set by their volumes; for a position between points
 * by weights, of which negative ones are set to 0. */
static pg_status share_stiffness (const pg_problem *p, pg_load *load)
{
    pg_status status = PG_OK;
    double sum = 0;
    size_t n = load->set->npoint;
    if (!load->own) PG_ALLOC (load->share, n);
    for (size_t i = 0; i < n; i++) {
        load->share[i] = load->own ? fmax (load->share[i], 0) : p->cloud.volume[load->set->point[i]];
        sum += pg_cloud_owns (&p->cloud, (size_t) load->set->point[i]) ? load->share[i] : 0;
    }
    PG_TRY (pg_cloud_sum (&p->cloud, 1, &sum));
    for (size_t i = 0; i < n; i++) load->share[i] /= sum;
done:
    return status;
}

/* Reads the displacement (m) of the other end of springs along axis k. */
static pg_status read_end (const pg_problem *p, pg_load *load, const pg_scene *scene, size_t i, int k)
{
    pg_status status = PG_OK;
    char path[64];
    int sprung = k < p->dim && load->stiffness[k] > 0;
    snprintf (path, sizeof path, "boundary[%zu].spring_end.%c", i, "xyz"[k]);
    int moved = pg_scene_given (scene, "%s", path);
    if (moved && pg_scene_entry_is (scene, "solver.kind", PG_SOLVER_EXPLICIT))
        pg_scene_fault (scene, path,
                        "explicit steps do not know the work of springs whose ends move: use newmark, or "
                        "leave it out");
    if (moved && !sprung) pg_scene_fault (scene, path, "there is no spring along %c", "xyz"[k]);
    if (!sprung) return PG_OK;
    PG_TRY (pg_expression_compile (&load->value[k], moved ? pg_scene_text (scene, "%s", path) : "0", "m"));
    if (load->value[k] && pg_expression_uses (load->value[k], 't')) load->proportional = 0;
done:
    return status;
}

/* Reads boundary[].spring and spring_end. */
pg_status pg_load_read_spring (const pg_problem *p, pg_load *load, const pg_scene *scene, size_t i)
{
    pg_status status = PG_OK;
    char path[64];
    int found = 0;
    for (int k = 0; k < 3; k++) {
        snprintf (path, sizeof path, "boundary[%zu].spring.%c", i, "xyz"[k]);
        int own = pg_scene_given (scene, "%s", path);
        if (own && k >= p->dim) pg_scene_fault (scene, path, "a %dD body has no such component", p->dim);
        if (!own) snprintf (path, sizeof path, "boundary[%zu].spring.all", i);
        if (k < p->dim && pg_scene_given (scene, "%s", path))
            load->stiffness[k] = pg_scene_number (scene, "%s", path);
        found |= own || load->stiffness[k] > 0;
        PG_TRY (read_end (p, load, scene, i, k));
    }
    snprintf (path, sizeof path, "boundary[%zu].spring", i);
    if (!found) pg_scene_fault (scene, path, "at least one of x, y, z, all is needed");
    PG_TRY (share_stiffness (p, load));
done:
    return status;
}
