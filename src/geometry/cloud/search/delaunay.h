/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: the Delaunay triangulation of points in two and three dimensions, by Qhull. */
#ifndef PERIGAL_CLOUD_DELAUNAY_H
#define PERIGAL_CLOUD_DELAUNAY_H
#include "perigal/base.h"

/* Triangles or tetrahedra that fill the convex hull of the points. */
typedef struct {
    int     dim;
    /* Number of simplices. */
    size_t  n;
    /* The points at the corners of each simplex, in positive orientation (n x (dim + 1)). */
    int    *vertex;
    /* The simplex beyond the face that lies opposite to vertex k; -1: none, the face is part of the hull
     * (n x (dim + 1)). */
    int    *beside;
    /* Radius of the sphere (circle) through the vertices, in the unit of x (n). */
    double *radius;
} pg_delaunay;

/* Triangulates n points x (n x dim), no two of which are equal. apart: distance of each from its nearest
 * neighbour (n). Where more than dim + 1 points lie on one empty sphere, as on a lattice, the
 * triangulation is not unique and may hold simplices without volume. Each point is therefore moved at
 * random, the same way every time: by 1e-4 of its distance `apart` along each axis at most, on a lattice
 * and where that does not suffice by more. Triangulation and orientations are those of the moved points,
 * as are the radii of flat simplices; the union of the simplices is that of the points themselves.
 * PG_E_USAGE: all points lie on one line or plane (to 1e-3 of
 * the median distance), or they are fewer than dim + 1; PG_E_FILE: Qhull is not installed; PG_E_LIMIT: it
 * gave up; PG_E_MEMORY. */
pg_status pg_delaunay_create (pg_delaunay *out, int dim, size_t n, const double *x, const double *apart);
void      pg_delaunay_clear  (pg_delaunay *d);
#endif
