/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: marks, one byte (0 or 1) per point and per facet, from which named sets are built: a name or a
 * condition marks points and facets, further conditions take marks away, sets.c gathers what is left. */
#ifndef PERIGAL_CELLS_MARK_H
#define PERIGAL_CELLS_MARK_H
#include "perigal/cells.h"

/* Sides of the bounding box, numbered as the faces of a lattice cell: 2k is the low, 2k + 1 the high side
 * of axis k. */
enum { PG_SIDES = 6 };
/* Their names: left right bottom top back front. */
extern const char *const pg_side_names[PG_SIDES];

/* Marks, and what is needed to find them. Body, lattice, cloud and cells are borrowed. */
typedef struct {
    const pg_body *body;
    const pg_lattice *lattice;
    const pg_cloud *cloud;
    const pg_cells *cells;
    /* Bounding box of the body (of the cloud, where points come from a file), its centre and its longest
     * edge, m. */
    double  low[3], high[3], centre[3], size;
    /* The points of each facet, compressed rows: its own nodes, or the points of the cell behind it. */
    size_t *facet_first;  int *facet_point;
    /* The shape of the body that each facet belongs to, or is nearest to (nfacet). */
    int    *facet_shape;
    /* The marks of points (cloud->n) and facets (cells->nfacet). */
    unsigned char *point, *facet;
} pg_marks;

/* Allocates the marks (all zero) and links facets to points and shapes. On failure nothing remains. */
pg_status pg_marks_create (pg_marks *m, const pg_body *body, const pg_lattice *lattice, const pg_cloud *cloud,
                           const pg_cells *cells);
void      pg_marks_clear  (pg_marks *m);
/* Sets all marks to `value`, 0 or 1. */
void      pg_marks_fill   (pg_marks *m, int value);
/* Adds marks for the boundary of that name: a set of the mesh, a side of the bounding box, all, the surface
 * of a shape, or a part of one. 0: there is no such name. */
int       pg_marks_boundary (pg_marks *m, const char *name);
/* Marks facet f and its points. */
void      cells_mark_facet (pg_marks *m, size_t f);
/* sides.c: does facet f lie in the plane of that side of the bounding box? For a body without facets: is
 * point i within half its spacing of the plane? */
int       cells_facet_on_side (const pg_marks *m, size_t f, int side);
int       cells_point_on_side (const pg_marks *m, size_t i, int side);
/* parts.c: marks the part of a shape called SHAPE.PART; 0: there is none of that name. */
int       cells_mark_part (pg_marks *m, const char *name);
/* Number of the part of the shape called `part`, -1: it has none. The number is cut_surface.part. */
int       cells_part_named (const pg_shape *shape, int dim, const char *part);
/* All names SHAPE.PART of a body, separated by commas, for messages. */
void      cells_parts_list (const pg_body *body, char *out, size_t size);
/* Is facet f on a flat end of a cylinder whose surface carries the default name "rim"? */
int       cells_is_end (const pg_marks *m, size_t f);
/* Is x (m) beyond the centre of the box on that side, by more than 1e-9 of its size? */
int       pg_marks_beyond (const pg_marks *m, int side, const double *x);
/* A condition on a position x (m): of a point, or of the centroid of a facet. */
typedef int (*pg_mark_test) (const pg_marks *m, const double *x, const void *context);
/* Takes away the marks of all points and facets that do not meet the condition. */
void      pg_marks_keep   (pg_marks *m, pg_mark_test test, const void *context);
#endif
