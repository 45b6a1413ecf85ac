/* SPDX-License-Identifier: GPL-3.0-or-later
 * Shapes: reading from the input file, signed distance from the surface (exact, negative inside), bounding
 * box.
 *
 * Distances must be true ones, not only of the right sign: pg_body_inside with a radius as tolerance also
 * tells whether a ball may meet the body (crack_meet.c). For intersections of two sets whose surfaces are at
 * right angles (cylinder, prism) the distance is sqrt (p^2 + q^2) outside both, else the larger one. */
#include "shape.h"
#include "geometry/cloud/search/polygon.h"
#include "perigal/vector.h"
#include <math.h>

/* Signed distance from the intersection of two sets whose surfaces are at right angles, from the distances
 * p and q. */
static double both (double p, double q)
{
    if (p <= 0 || q <= 0) return fmax (p, q);
    return sqrt (p*p + q*q);
}

/* ---- box ----------------------------------------------------------------------------------------------- */
/* Reads a box. Errors are recorded and reading goes on, so that all are found in one pass. */
static pg_status read_box (pg_shape *s, int dim, const pg_scene *scene, const char *at)
{
    pg_scene_vector (scene, 3, s->low, "%s.low", at);
    pg_scene_vector (scene, 3, s->high, "%s.high", at);
    for (int k = 0; k < dim; k++)
        if (!(s->low[k] < s->high[k])) {
            pg_scene_fault (scene, at, "low must lie below high, but %c runs from %g to %g m", "xyz"[k],
                            s -> low[k], s -> high[k]);
            break;
        }
    return PG_OK;
}

/* Outside: the Euclidean distance; inside: that of the nearest side. */
static double distance_box (const pg_shape *s, int dim, const double *x, double reach)
{
    (void) reach;
    double out = 0, in = -INFINITY;
    for (int k = 0; k < dim; k++) {
        double q = fmax (s->low[k] - x[k], x[k] - s->high[k]);
        if (q > 0) out += q*q;
        in = fmax (in, q);
    }
    return out > 0 ? sqrt (out) : in;
}

static void box_box (const pg_shape *s, int dim, double *low, double *high)
{
    for (int k = 0; k < dim; k++) low[k] = s->low[k], high[k] = s->high[k];
}

/* ---- disk, sphere -------------------------------------------------------------------------------------- */
/* Reads the radius, which is given as diameter or radius. */
static void read_radius (pg_shape *s, const pg_scene *scene, const char *at)
{
    s->radius = pg_scene_given (scene, "%s.diameter", at) ? 0.5 * pg_scene_number (scene, "%s.diameter", at)
                                                          : pg_scene_number (scene, "%s.radius", at);
}

/* Reads a disk (2D) or a sphere (3D). */
static pg_status read_ball (pg_shape *s, int dim, const pg_scene *scene, const char *at)
{
    (void) dim;
    pg_scene_vector (scene, 3, s->centre, "%s.center", at);
    read_radius (s, scene, at);
    return PG_OK;
}

static double distance_ball (const pg_shape *s, int dim, const double *x, double reach)
{
    (void) reach;
    double r[3];
    for (int k = 0; k < dim; k++) r[k] = x[k] - s->centre[k];
    return pg_size (dim, r) - s->radius;
}

static void box_ball (const pg_shape *s, int dim, double *low, double *high)
{
    for (int k = 0; k < dim; k++) low[k] = s->centre[k] - s->radius, high[k] = s->centre[k] + s->radius;
}

/* ---- cylinder ------------------------------------------------------------------------------------------ */
/* Reads a cylinder; its axis is scaled to unit length. */
static pg_status read_cylinder (pg_shape *s, int dim, const pg_scene *scene, const char *at)
{
    read_ball (s, dim, scene, at);
    s->length = pg_scene_number (scene, "%s.length", at);
    pg_scene_vector (scene, 3, s->axis, "%s.axis", at);
    double size = pg_size (3, s->axis);
    if (!(size > 0)) pg_scene_fault (scene, at, "the axis has no length");
    else for (int k = 0; k < 3; k++) s->axis[k] /= size;
    return PG_OK;
}

/* Distance from the round surface and from the two ends, which meet at right angles. */
static double distance_cylinder (const pg_shape *s, int dim, const double *x, double reach)
{
    (void) reach;
    double r[3], along = 0;
    for (int k = 0; k < dim; k++) r[k] = x[k] - s->centre[k], along += r[k] * s->axis[k];
    for (int k = 0; k < dim; k++) r[k] -= along * s->axis[k];
    return both (pg_size (dim, r) - s->radius, fmax (-along, along - s->length));
}

/* Bounding box: a disc normal to the unit axis a extends R sqrt (1 - a_k^2) along axis k. */
static void box_cylinder (const pg_shape *s, int dim, double *low, double *high)
{
    for (int k = 0; k < dim; k++) {
        double end = s->centre[k] + s->length * s->axis[k],
               wide = s->radius * sqrt (fmax (0, 1 - s->axis[k] * s->axis[k]));
        low[k]  = fmin (s->centre[k], end) - wide;
        high[k] = fmax (s->centre[k], end) + wide;
    }
}

/* ---- polygon, prism ------------------------------------------------------------------------------------ */
/* Reads a polygon. A last vertex equal to the first closes the polygon twice and is dropped. */
static pg_status read_polygon (pg_shape *s, int dim, const pg_scene *scene, const char *at)
{
    pg_status status = PG_OK;
    size_t n = pg_scene_count (scene, "%s.vertices", at);
    (void) dim;
    PG_ALLOC (s->vertex, 2 * n);
    s->nvertex = n;
    for (size_t i = 0; i < n; i++) {
        double v[3] = {0, 0, 0};
        if (pg_scene_vector (scene, 3, v, "%s.vertices[%zu]", at, i) != 2)
            pg_scene_fault (scene, at, "vertex %zu must be a pair [x, y]", i + 1);
        s->vertex[2*i] = v[0], s->vertex[2*i + 1] = v[1];
    }
    /* the last vertex repeats the first */
    if (n > 1 && s->vertex[0] == s->vertex[2*n - 2] && s->vertex[1] == s->vertex[2*n - 1]) s->nvertex = n - 1;
    const char *why = pg_polygon_fault (s->nvertex, s->vertex);
    if (why) pg_scene_fault (scene, at, "the polygon %s", why);
done:
    return status;
}

/* Reads a prism: its base is a polygon in the x-y plane. */
static pg_status read_prism (pg_shape *s, int dim, const pg_scene *scene, const char *at)
{
    s->low[2]  = pg_scene_number (scene, "%s.low", at);
    s->high[2] = pg_scene_number (scene, "%s.high", at);
    if (!(s->low[2] < s->high[2]))
        pg_scene_fault (scene, at, "low must lie below high, but z runs from %g to %g m", s->low[2],
                        s->high[2]);
    return read_polygon (s, dim, scene, at);
}

static double distance_polygon (const pg_shape *s, int dim, const double *x, double reach)
{
    (void) reach;
    (void) dim;
    return pg_polygon_distance (s->nvertex, s->vertex, x);
}

/* Distance from the sides and from the two ends, which meet at right angles. */
static double distance_prism (const pg_shape *s, int dim, const double *x, double reach)
{
    return both (distance_polygon (s, dim, x, reach), fmax (s->low[2] - x[2], x[2] - s->high[2]));
}

/* Box of the vertices. */
static void box_polygon (const pg_shape *s, int dim, double *low, double *high)
{
    (void) dim;
    for (int k = 0; k < 2; k++) {
        low[k] = INFINITY, high[k] = -INFINITY;
        for (size_t i = 0; i < s->nvertex; i++)
            low[k] = fmin (low[k], s->vertex[2 * i + k]), high[k] = fmax (high[k], s->vertex[2 * i + k]);
    }
}

static void box_prism (const pg_shape *s, int dim, double *low, double *high)
{
    box_polygon (s, dim, low, high);
    low[2] = s->low[2], high[2] = s->high[2];
}

/* ---- plate ----------------------------------------------------------------------------------------------
 */
/* Distance from the edges, in the plane of the plate, and from its two faces, which meet at right angles. */
static double distance_plate (const pg_shape *s, int dim, const double *x, double reach)
{
    double r[3], flat[2] = { 0, 0 }, off = 0;
    for (int k = 0; k < 3; k++) {
        int p = (k + 1) % 3, q = (k + 2) % 3;
        r[k] = x[k] - s->centre[k], off += r[k] * s->axis[k], flat[0] += r[k] * s->along[k];
        flat[1] += (x[k] - s->centre[k]) * (s->axis[p] * s->along[q] - s->axis[q] * s->along[p]);
    }
    return both (distance_polygon (s, dim, flat, reach), fabs (off) - 0.5 * s->length);
}

/* Bounding box of the vertices in 3D, and half the thickness along the axis. */
static void box_plate (const pg_shape *s, int dim, double *low, double *high)
{
    for (int k = 0; k < dim; k++) {
        int p = (k + 1) % 3, q = (k + 2) % 3;
        double wide = 0.5 * s->length * fabs (s->axis[k]),
               other = s->axis[p] * s->along[q] - s->axis[q] * s->along[p];
        low[k] = INFINITY, high[k] = -INFINITY;
        for (size_t i = 0; i < s->nvertex; i++) {
            double x = s->centre[k] + s->vertex[2*i] * s->along[k] + s->vertex[2*i + 1] * other;
            low[k] = fmin (low[k], x - wide), high[k] = fmax (high[k], x + wide);
        }
    }
}

/* The kinds of shapes: name, lowest and highest dimension, round, functions. */
const pg_shape_type pg_shape_types[PG_FACETED + 1] = {
    [PG_BOX]      = {"box",      1, 3, 0, read_box,      distance_box,      box_box},
    [PG_DISK]     = {"disk",     2, 2, 1, read_ball,     distance_ball,     box_ball},
    [PG_CYLINDER] = {"cylinder", 3, 3, 1, read_cylinder, distance_cylinder, box_cylinder},
    [PG_SPHERE]   = {"sphere",   3, 3, 1, read_ball,     distance_ball,     box_ball},
    [PG_POLYGON]  = {"polygon",  2, 2, 0, read_polygon,  distance_polygon,  box_polygon},
    [PG_PRISM]    = {"prism",    3, 3, 0, read_prism,    distance_prism,    box_prism},
    [PG_MESH]     = {"mesh",     2, 3, 0, shape_mesh_read, shape_mesh_distance, shape_mesh_box},
    [PG_ALPHA_SHAPE] = {"alpha_shape", 2, 3, 0, shape_alpha_read, shape_alpha_distance, shape_alpha_box},
    [PG_STAIRS]   = {"stairs",   2, 3, 0, NULL, shape_stairs_distance, shape_mesh_box},
    [PG_PLATE]    = {"plate",    3, 3, 0, NULL, distance_plate,        box_plate},
    [PG_FACETED]  = {"facets",   2, 3, 0, NULL, shape_facets_distance, shape_mesh_box},
};
