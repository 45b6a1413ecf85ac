/* SPDX-License-Identifier: GPL-3.0-or-later
 * boxes.h: the points of a cloud sorted into equal boxes about one spacing wide, so that the points near a
 * position are found without a search (family.c).
 *
 * The boxes of a row along x follow each other in memory: the points of a row that are near a position are
 * one contiguous range. On a lattice whose points are numbered along x, then y, then z, the ranges of all
 * rows in their order come out ascending, and a family needs no sorting. */
#ifndef PERIGAL_CLOUD_BOXES_H
#define PERIGAL_CLOUD_BOXES_H
#include "perigal/cloud.h"

/* Neighbourhood of a position: a ball or a cube (shape); closed: 1: its boundary belongs to it. */
typedef struct { int shape, closed; } pg_nearness;

/* Boxes of points with about the same reach. */
typedef struct {
    int     dim;
    /* Number of points; of boxes along each axis, 1 beyond dim. */
    size_t  n, count[3];
    /* Lower corner of the first box, m; one over the width of a box, 1/m. */
    double  low[3], inverse[3];
    /* The points of box b are entries start[b] to start[b + 1] - 1 of item (number of boxes + 1). */
    size_t *start;
    /* Numbers in the cloud of the sorted points (n), ascending in each box. */
    int    *item;
    /* Upper bound of the distance within which any of the points is a neighbour, m. */
    double  reach;
} pg_boxes;

/* Sorts the points list[0] .. list[n - 1] of the cloud, which are neighbours within at most `reach` (m).
 * width: of a box along each axis, m. Sets *fits to 0 and does nothing else where the points are so scattered
 * that boxes of this width would by far outnumber them. */
pg_status pg_boxes_create (pg_boxes *out, int *fits, const pg_cloud *cloud, size_t n, const int *list,
                           const double *width, double reach);
void      pg_boxes_clear  (pg_boxes *boxes);
/* Finds the points that can be neighbours of any position in the box low .. high (m), and some more: returns
 * their number, and unless `item` is NULL writes their numbers. ball: 1: neighbourhoods are balls, 0:
 * cubes. */
size_t    pg_boxes_near   (const pg_boxes *boxes, const double *low, const double *high, int ball, int *item);
#endif
