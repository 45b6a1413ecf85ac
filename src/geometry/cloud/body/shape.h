/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: one row per kind of shape: its key, the dimensions it may be used in, how it is read, its signed
 * distance (m, negative inside) and its box. */
#ifndef PERIGAL_CLOUD_SHAPE_H
#define PERIGAL_CLOUD_SHAPE_H
#include "perigal/cloud.h"

/* A kind of shape. */
typedef struct {
    /* Key under add: and subtract:. */
    const char *name;
    /* Dimensions in which it may be used. */
    int lowest, highest;
    /* 1: its surface is called rim. */
    int round;
    /* Reads a shape from the map at path `at` of the input file, such as "body[2].add.disk". */
    pg_status (*read)     (pg_shape *shape, int dim, const pg_scene *scene, const char *at);
    /* Signed distance of x from the surface, m; beyond `reach` any value of the right sign and at least that
     * size. */
    double    (*distance) (const pg_shape *shape, int dim, const double *x, double reach);
    void      (*box)      (const pg_shape *shape, int dim, double *low, double *high);
} pg_shape_type;

/* Number of kinds that an input file may use; PG_STAIRS, PG_PLATE and PG_FACETED follow them. */
enum { PG_SHAPES = PG_ALPHA_SHAPE + 1 };
/* Indexed by pg_shape.kind. */
extern const pg_shape_type pg_shape_types[PG_FACETED + 1];
/* Shapes from a mesh (shape_mesh.c). */
pg_status shape_mesh_read     (pg_shape *shape, int dim, const pg_scene *scene, const char *at);
double    shape_mesh_distance (const pg_shape *shape, int dim, const double *x, double reach);
void      shape_mesh_box      (const pg_shape *shape, int dim, double *low, double *high);
double    shape_mesh_volume   (const pg_shape *shape, double *surface);
void      shape_mesh_clear    (pg_shape *shape);
/* Alpha shapes of points (shape_alpha.c). */
pg_status shape_alpha_read     (pg_shape *shape, int dim, const pg_scene *scene, const char *at);
double    shape_alpha_distance (const pg_shape *shape, int dim, const double *x, double reach);
void      shape_alpha_box      (const pg_shape *shape, int dim, double *low, double *high);
int       shape_alpha_volume   (const pg_shape *shape, double *volume, double *surface);
/* Reads `layers`: each becomes a box behind the shapes, and the bounding box grows. */
pg_status pg_layers_read      (pg_body *body, const pg_scene *scene);
/* Is this the name of a side of the bounding box, or `all`? */
int       pg_layers_taken     (const char *name);
double    shape_stairs_distance (const pg_shape *shape, int dim, const double *x, double reach);
double    shape_facets_distance (const pg_shape *shape, int dim, const double *x, double reach);
#endif
