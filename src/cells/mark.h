/* SPDX-License-Identifier: GPL-3.0-or-later
 * Marks (0/1 per point and per facet) from which sets are made. */
#ifndef PERIGAL_CELLS_MARK_H
#define PERIGAL_CELLS_MARK_H
#include "perigal/cells.h"

enum { PG_SIDES = 6 };
/* left right bottom top back front: side 2k low, 2k + 1 high x_k */
extern const char *const pg_side_names[PG_SIDES];

typedef struct {
    const pg_body *body;
    const pg_lattice *lattice;
    const pg_cloud *cloud;
    const pg_cells *cells;
    double  low[3], high[3], centre[3], size;  /* box of the body (points from a file: of the cloud), m */
    size_t *facet_first;  int *facet_point;  /* points on, or in the cells behind, each facet (CSR) */
    int    *facet_shape;                               /* nearest shape (nfacet) */
    unsigned char *point, *facet;                      /* the marks */
} pg_marks;

pg_status pg_marks_create (pg_marks *m, const pg_body *body, const pg_lattice *lattice, const pg_cloud *cloud,
                           const pg_cells *cells);
void      pg_marks_clear  (pg_marks *m);
void      pg_marks_fill   (pg_marks *m, int value);
/* Adds the part of the boundary of that name; 0: there is no such name. */
int       pg_marks_boundary (pg_marks *m, const char *name);
void      cells_mark_facet (pg_marks *m, size_t f);        /* and its points */
/* sides.c: does the facet lie in the plane of the bounding box there; of a body without facets: is the point
 * within half its spacing of it? */
int       cells_facet_on_side (const pg_marks *m, size_t f, int side);
int       cells_point_on_side (const pg_marks *m, size_t i, int side);
/* parts.c: adds the part of a shape called SHAPE.PART, 0: there is none. Number of a part of a shape, -1: it
 * has none of this name. All names, for messages. */
int       cells_mark_part (pg_marks *m, const char *name);
int       cells_part_named (const pg_shape *shape, int dim, const char *part);
void      cells_parts_list (const pg_body *body, char *out, size_t size);
/* the flat end of a cylinder whose surface has no name of its own */
int       cells_is_end (const pg_marks *m, size_t f);
/* Position beyond the centre of the box on that side? */
int       pg_marks_beyond (const pg_marks *m, int side, const double *x);
/* Takes away the marks of all that does not pass the test. */
typedef int (*pg_mark_test) (const pg_marks *m, const double *x, const void *context);
void      pg_marks_keep   (pg_marks *m, pg_mark_test test, const void *context);
#endif
