/* SPDX-License-Identifier: GPL-3.0-or-later
 * One row per kind of shape: its key, where it may be used, how it is read, its signed distance (m, negative
 * inside) and box. */
#ifndef PERIGAL_CLOUD_SHAPE_H
#define PERIGAL_CLOUD_SHAPE_H
#include "perigal/cloud.h"

typedef struct {
    const char *name;                                  /* key under add: and subtract: */
    int lowest, highest;                               /* dimensions in which it may be used */
    int round;                                         /* its surface is called rim */
    /* at: "body[2].add.disk" */
    pg_status (*read)     (pg_shape *shape, int dim, const pg_scene *scene, const char *at);
    /* farther than reach: any such */
    double    (*distance) (const pg_shape *shape, int dim, const double *x, double reach);
    void      (*box)      (const pg_shape *shape, int dim, double *low, double *high);
} pg_shape_type;

enum { PG_SHAPES = PG_MESH + 1 };                      /* those of a scene; then PG_STAIRS */
extern const pg_shape_type pg_shape_types[PG_SHAPES + 1];/* indexed by pg_shape.kind */
pg_status shape_mesh_read     (pg_shape *shape, int dim, const pg_scene *scene, const char *at);
double    shape_mesh_distance (const pg_shape *shape, int dim, const double *x, double reach);
void      shape_mesh_box      (const pg_shape *shape, int dim, double *low, double *high);
double    shape_mesh_volume   (const pg_shape *shape, double *surface);
void      shape_mesh_clear    (pg_shape *shape);
/* Reads `layers`: each becomes a box behind the shapes, and the bounding box grows. */
pg_status pg_layers_read      (pg_body *body, const pg_scene *scene);
int       pg_layers_taken     (const char *name);      /* a side of the body, or all */
double    shape_stairs_distance (const pg_shape *shape, int dim, const double *x, double reach);
#endif
