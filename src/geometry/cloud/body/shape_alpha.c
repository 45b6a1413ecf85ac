/* SPDX-License-Identifier: GPL-3.0-or-later
 * Points as a shape: their alpha shape, grown by a rim. Points come from a CSV file or are the nodes of a
 * mesh.
 *
 * The surface of an alpha shape passes through points. Where these are the middles of cells, such as the
 * points of a particle method, the body reaches half a spacing beyond them on all sides; nodes of finite
 * elements lie on the surface itself. The rim makes up for that: the shape is all positions within the
 * distance `rim` of the simplices, so that faces move outwards by it and convex corners become round with
 * that radius. */
#include "points_file.h"
#include "shape.h"
#include "solid.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

/* ---- reading ------------------------------------------------------------------------------------------- */
/* Reads the nodes of the elements of a mesh (n x dim, m), each once: other nodes, such as those that only
 * hold a load, are no part of the body. */
static pg_status read_nodes (double **out, size_t *n, int dim, const pg_scene *scene, const char *at)
{
    pg_status status = PG_OK;
    char key[128];
    pg_mesh_body part = { 0 };
    unsigned char *used = NULL;
    snprintf (key, sizeof key, "%.100s.mesh", at);
    PG_TRY (mesh_body_at (&part, scene, key));
    const pg_mesh *m = &part.mesh;
    PG_ALLOC (used, m->nnode);
    PG_ALLOC (*out, m->nnode * (size_t) dim);
    for (size_t k = 0; k < m->start[m->n]; k++) used[m->node[k]] = 1;
    for (size_t i = 0; i < m->nnode; i++)
        if (used[i]) memcpy (*out + (*n)++ * (size_t) dim, m->x + 3 * i, (size_t) dim * sizeof **out);
done:
    pg_free (used);
    pg_mesh_body_clear (&part);
    return status;
}

/* Reads the points of a CSV file (n x dim, m) that key AT.points names; at NULL: key points. */
static pg_status read_points (double **out, size_t *n, int dim, const pg_scene *scene, const char *at)
{
    pg_status status = PG_OK;
    char key[128];
    pg_cloud cloud = { .dim = dim };
    snprintf (key, sizeof key, "%.100s%spoints", at ? at : "", at ? "." : "");
    PG_TRY (pg_points_places (&cloud, scene, key));
    *out = cloud.x, *n = cloud.n;
    cloud.x = NULL;
done:
    pg_free (cloud.x), pg_free (cloud.volume), pg_free (cloud.block);
    return status;
}

/* Makes the alpha shape. Unsuitable points are reported as errors of the input file, lack of memory or of
 * Qhull is not. */
static pg_status read_shape (pg_shape *s, int dim, const pg_scene *scene, const char *at)
{
    pg_status status = PG_OK;
    char key[128], why[600];
    double *x = NULL;
    size_t n = 0;
    pg_alpha_shape *cloud = &s->solid->cloud;
    int file = !at || pg_scene_given (scene, "%s.points", at);
    double alpha = at && pg_scene_given (scene, "%s.alpha", at) ? pg_scene_number (scene, "%s.alpha", at) : 0;
    PG_TRY (file ? read_points (&x, &n, dim, scene, at) : read_nodes (&x, &n, dim, scene, at));
    status = pg_alpha_shape_create (cloud, dim, n, x, alpha);
    if (status == PG_E_USAGE || status == PG_E_LIMIT) {
        snprintf (why, sizeof why, "%s", pg_last_error ());
        snprintf (key, sizeof key, "%.100s%s", at ? at : "",
                  !at ? "surface" : alpha > 0 ? ".alpha" : file ? ".points" : ".mesh.file");
        pg_scene_fault (scene, key, "%s", why);
        PG_TRY (pg_scene_verdict (scene));
    }
    if (status != PG_OK) goto done;
    cloud->rim = file ? cloud->spacing / 2 : 0;
    if (at && pg_scene_given (scene, "%s.rim", at)) cloud->rim = pg_scene_number (scene, "%s.rim", at);
    PG_TRY (pg_mesh_locator_create (&s->solid->locator, &cloud->mesh));
    PG_TRY (pg_skin_create (&s->solid->skin, &cloud->mesh));
done:
    pg_free (x);
    return status;
}

/* Reads the shape, unless errors have been reported for its keys. */
pg_status shape_alpha_read (pg_shape *s, int dim, const pg_scene *scene, const char *at)
{
    pg_status status = PG_OK;
    PG_TRY (pg_scene_verdict (scene));
    PG_ALLOC (s->solid, 1);
    PG_TRY (read_shape (s, dim, scene, at));
done:
    if (status != PG_OK) shape_mesh_clear (s);
    return status;
}

const pg_alpha_shape *pg_shape_alpha (const pg_shape *s)
{
    return s->kind == PG_ALPHA_SHAPE ? &s->solid->cloud : NULL;
}

/* ---- queries ------------------------------------------------------------------------------------------- */
/* Outside of the simplices the distance is exact. Inside it is minus the radius of a ball that lies in the
 * shape; the surface may be farther away where two rims meet. The search for the nearest face goes no further
 * than `reach` needs. */
double shape_alpha_distance (const pg_shape *s, int dim, const double *x, double reach)
{
    double xi[3], rim = s->solid->cloud.rim, far = fabs (reach);
    (void) dim;
    if (pg_mesh_locator_find (s->solid->locator, x, xi, NULL) >= 0)
        return far < rim ? -rim : -rim - pg_skin_distance (s->solid->skin, x, far - rim, NULL);
    return pg_skin_distance (s->solid->skin, x, far + rim, NULL) - rim;
}

void shape_alpha_box (const pg_shape *s, int dim, double *low, double *high)
{
    pg_skin_box (s->solid->skin, low, high);
    for (int k = 0; k < dim; k++) low[k] -= s->solid->cloud.rim, high[k] += s->solid->cloud.rim;
}

/* Volume and surface area; returns 0 with a rim, for which there is no closed form. */
int shape_alpha_volume (const pg_shape *s, double *volume, double *surface)
{
    if (s->solid->cloud.rim > 0) return 0;
    *volume = s->solid->cloud.volume, *surface = pg_skin_size (s->solid->skin);
    return 1;
}
