/* SPDX-License-Identifier: GPL-3.0-or-later
 * cells.h: background cells for integration and boundary facets with normals; named sets of points and
 * facets. */
#ifndef PERIGAL_CELLS_H
#define PERIGAL_CELLS_H
#include "perigal/cloud.h"
#include "perigal/mesh.h"

PG_API_BEGIN

/* kind of a cell or facet that the surface of the body cuts: its points come from `cut`; its corners are
 * those of the lattice cell, or the facet's box */
enum { PG_CUT = PG_ELEMENTS };
typedef struct {
    char    name[64];
    size_t  npoint, nfacet;
    int    *point, *facet;                             /* ascending */
    /* points that none of its facets reaches: a set with an inside. None where it was made of faces */
    size_t  ninner;  int *inner;
} pg_set;

typedef struct {
    int     dim;
    size_t  n;
    unsigned char *kind;                               /* pg_element or PG_CUT (n) */
    size_t *start;                                     /* nodes of cell c: start[c]..start[c + 1] (n + 1) */
    double *x;                                         /* their places, m, in Exodus order (start[n] x dim) */
    double *volume;                                    /* m^3, thickness included (n) */
    int    *block;                                     /* block of the mesh; 0 (n) */
    size_t  nfacet;
    unsigned char *facet_kind;                         /* pg_element or PG_CUT (nfacet) */
    size_t *facet_start;                               /* as start (nfacet + 1) */
    double *facet_x;                                   /* m (facet_start[nfacet] x dim) */
    double *facet_centre;                              /* centroid, m (nfacet x dim) */
    double *normal;                                    /* mean outward normal, unit (nfacet x dim) */
    double *area;                                      /* m^2, thickness included (nfacet) */
    int    *facet_cell;                                /* cell behind the facet (nfacet) */
    int    *facet_surface;  /* surface of `cut`; -1: a face of a whole cell (nfacet) */
    /* of a mesh: point of the cloud at each node of a facet, -1: none (facet_start[nfacet]) */
    int    *facet_point;
    pg_set *given;  size_t ngiven;                     /* sets that the mesh brought */
    double  thickness;                                 /* 2D m; 1D cross-section m^2; 3D 1 */
    const struct pg_cut *cut;                          /* owned; NULL without cut cells */
    int     cut_order;  /* least order of quadrature in cut cells and on cut facets */
} pg_cells;
/* All arrays for n cells with nx nodes and nfacet facets with nfx nodes together, zeroed; dim and thickness
 * set. */
pg_status pg_cells_reserve (pg_cells *out, int dim, double thickness, size_t n, size_t nx, size_t nfacet,
                            size_t nfx);
/* The kept cells of a lattice: bars, quads, hexes. */
pg_status pg_cells_from_lattice (pg_cells *out, const pg_lattice *lattice, double thickness);
/* The same lattice over the exact body: cells that its surface crosses are cut (kind PG_CUT) and kept while
 * their share of volume is above 1e-13, wherever their centre lies; facets are pieces of the surface, one for
 * each cell and surface, parted by the rays given. The shapes of the body must outlive the cells. */
typedef struct { double centre[2], direction[2]; } pg_ray;  /* in the xy plane; direction of unit length */
pg_status pg_cells_cut (pg_cells *out, const pg_body *body, const pg_lattice *lattice, double thickness,
                        size_t nray, const pg_ray *ray);
/* The ends of the angle ranges of all sets of the scene (pg_free): facets are parted there. */
pg_status pg_sets_rays (pg_ray **out, size_t *n, const pg_scene *scene, const pg_body *body);
/* Volumes of the points become those of the cells: each cell is shared equally by its points (vertices, or
 * its centre); one without any goes to the nearest point, or in equal parts to those equally near. */
pg_status pg_cells_share (pg_cloud *cloud, const pg_cells *cells, const pg_lattice *lattice);
/* The elements of a mesh (block: index into its blocks) and its surface, after pg_mesh_body_cloud. Its side
 * sets become sets of facets and of their points, without faces inside the body; its node sets become sets of
 * points and of the facets whose nodes all belong to them. */
pg_status pg_cells_from_mesh (pg_cells *out, const pg_mesh_body *body, double thickness);
/* The name of a mesh's set as the scene writes it: what is no letter, digit, - or _ becomes _; at most 56
 * letters; all: mesh_all. */
void      pg_set_name (char out[57], const char *name);
void      pg_cells_clear (pg_cells *cells);

/* ---- cut cells ----------------------------------------------------------------------------------------- */
/* Quadrature of given order in a cell of kind PG_CUT, or on a facet of that kind, appended to `out` (zero at
 * first): all weights positive, m^3 or m^2 with the thickness, their sum exact to the order only. Errors:
 * PG_E_MEMORY. Dimension reduction: Saye 2015, doi 10.1137/140966290. */
/* normal: of facets, outward, unit; n x dim */
typedef struct { size_t n, capacity; double *x, *weight, *normal; } pg_cut_points;
pg_status pg_cut_cell   (pg_cut_points *out, const pg_cells *cells, size_t cell, int order);
pg_status pg_cut_facet  (pg_cut_points *out, const pg_cells *cells, size_t facet, int order);
/* The part of a face (-x +x -y +y -z +z) of a cell of any lattice kind that has the body on both of its
 * sides; dim > 1, no normals. */
pg_status pg_cut_face   (pg_cut_points *out, const pg_cells *cells, size_t cell, int face, int order);
void      pg_cut_points_clear (pg_cut_points *points);
/* Of a surface (facet_surface >= 0): the shape of the body it belongs to; whether it is a flat end of a
 * cylinder. */
int       pg_cut_shape  (const struct pg_cut *cut, int surface);
int       pg_cut_is_end (const struct pg_cut *cut, int surface);

/* Named groups: `sets: NAME: {boundary: ..., angle: ..., where: ...}`.
 * NAME.top/.bottom/.left/.right/.front/.back is the part on that side of the centre of the body's bounding
 * box. */
typedef struct {
    pg_set *set; size_t n;
    double plane[6];  /* of left right bottom top back front, m; NAN: none in this dimension */
    char   parts[320];                                 /* SHAPE.PART of all shapes, for messages */
} pg_sets;
/* Makes the predefined sets left right bottom top back front (the facets that lie in the planes of the
 * bounding box, and their points; of a body without facets the points within half their spacing of the
 * planes) and all (every point and facet), the sets of the scene, the parts of shapes (SHAPE.PART) that
 * loads, averages, exclude and stop name, and the parts of each. What has no side in this dimension does not
 * exist. An empty set of the scene is a fault; an empty predefined set or part is not (npoint = nfacet = 0).
 * Sets of a mesh come before those of the scene, with their parts, and take the place of predefined ones of
 * the same name. With PG_E_SCENE all sets are there all the same, for the caller to look for more faults and
 * to clear. */
pg_status pg_sets_build (pg_sets *out, const pg_scene *scene, const pg_body *body, const pg_lattice *lattice,
                         const pg_cloud *cloud, const pg_cells *cells);
const pg_set *pg_sets_find  (const pg_sets *sets, const char *name);
/* 1: a predefined side in whose plane the body has no face (a disk's top). */
int           pg_sets_empty_side (const pg_sets *sets, const pg_set *set);
/* As pg_sets_find, for a name that the scene gives at `path`: an unknown one is a fault there that names the
 * nearest, an empty side one that says what to name. */
const pg_set *pg_sets_named (const pg_sets *sets, const pg_scene *scene, const char *path, const char *name);
void          pg_sets_clear (pg_sets *sets);
PG_API_END
#endif
