/* SPDX-License-Identifier: GPL-3.0-or-later
 * cells.h: background cells for integration and boundary facets with normals; named sets of points and facets. */
#ifndef PERIGAL_CELLS_H
#define PERIGAL_CELLS_H
#include "perigal/cloud.h"

typedef struct {
    int     dim, corners;                              /* corners per cell: 2, 4, 8; ordered as Exodus BAR QUAD HEX      */
    size_t  n;
    double *x;                                         /* corner positions, m                (n x corners x dim)         */
    int     facet_corners;                             /* 1, 2, 4                                                        */
    size_t  nfacet;
    double *facet_x;                                   /* m                                  (nfacet x facet_corners x dim) */
    double *normal;                                    /* outward unit normal                (nfacet x dim)              */
    double *area;                                      /* m^2, thickness included            (nfacet)                    */
    int    *facet_cell;                                /* cell behind the facet              (nfacet)                    */
} pg_cells;
pg_status pg_cells_from_lattice (pg_cells *out, const pg_lattice *lattice, double thickness);
void      pg_cells_clear (pg_cells *cells);

/* Named groups: `sets: NAME: {boundary: ..., angle: ..., where: ...}`. NAME.top/.bottom/.left/.right/.front/.back is the part
 * on that side of the centre of the body's bounding box. */
typedef struct {
    char    name[64];
    size_t  npoint, nfacet;
    int    *point, *facet;                             /* ascending                                                      */
} pg_set;
typedef struct { pg_set *set; size_t n; } pg_sets;
/* Makes the predefined sets left right bottom top back front (faces of the bounding box) and all (every point and facet), the
 * sets of the scene, and the parts of each. What has no side in this dimension does not exist. An empty set of the scene is a
 * fault; an empty predefined set or part is not (npoint = nfacet = 0). */
pg_status     pg_sets_build (pg_sets *out, const pg_scene *scene, const pg_body *body, const pg_lattice *lattice, const pg_cloud *cloud, const pg_cells *cells);
const pg_set *pg_sets_find  (const pg_sets *sets, const char *name);
/* The same for a name that the scene gives at `path`: an unknown one is a fault there that names the nearest. */
const pg_set *pg_sets_named (const pg_sets *sets, const pg_scene *scene, const char *path, const char *name);
void          pg_sets_clear (pg_sets *sets);
#endif
