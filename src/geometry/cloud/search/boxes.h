/* SPDX-License-Identifier: GPL-3.0-or-later
 * boxes.h: the points of a cloud sorted into equal boxes about one spacing wide, so that the points near a
 * place are read off instead of searched for (family.c).
 *
 * The boxes of a row along x follow each other in memory: what a place sees of a row is one stretch of
 * points. On a lattice whose points are numbered along x, then y, then z, the stretches of all rows in their
 * order come out ascending, and a family needs no sorting. */
#ifndef PERIGAL_CLOUD_BOXES_H
#define PERIGAL_CLOUD_BOXES_H
#include "perigal/cloud.h"

/* Who is near: a ball or a cube about a place; `closed`: its edge belongs to it. */
typedef struct { int shape, closed; } pg_nearness;

/* Points of about the same reach. */
typedef struct {
    int     dim;
    /* Number of points; of boxes along each axis, 1 beyond dim. */
    size_t  n, count[3];
    /* Lower corner of the first box, m; one over the width of a box, 1/m. */
    double  low[3], inverse[3];
    /* Points of box b: places start[b] to start[b + 1] - 1 of the order (boxes + 1). */
    size_t *start;
    /* Number in the cloud of the point of a place (n), ascending in each box. */
    int    *item;
    /* No less than the distance at which any of the points is seen, m. */
    double  reach;
} pg_boxes;

/* Sorts the points list[0] .. list[n - 1] of the cloud, which are seen from at most `reach` (m). width: of a
 * box along each axis, m. 0 in *fits and nothing else: the points are scattered so thinly over their
 * surroundings that boxes of this width would be many times as many as they. */
pg_status pg_boxes_create (pg_boxes *out, int *fits, const pg_cloud *cloud, size_t n, const int *list,
                           const double *width, double reach);
void      pg_boxes_clear  (pg_boxes *boxes);
/* The points that can be seen from anywhere in the box low .. high (m), and some more: their number, and
 * unless `item` is NULL their numbers. ball: 1: each is seen from a ball, 0: from a cube. */
size_t    pg_boxes_near   (const pg_boxes *boxes, const double *low, const double *high, int ball, int *item);
#endif
