/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: plane polygons as lists of (x, y): n >= 3 vertices, closed implicitly. */
#ifndef PERIGAL_CLOUD_POLYGON_H
#define PERIGAL_CLOUD_POLYGON_H
#include <stddef.h>

/* Area, positive if the vertices run counter-clockwise. */
double pg_polygon_area     (size_t n, const double *v);
/* Is x inside? On the outline the answer may be either. */
int    pg_polygon_inside   (size_t n, const double *v, const double *x);
/* Distance from the outline, negative inside. */
double pg_polygon_distance (size_t n, const double *v, const double *x);
/* What is wrong with the outline, as a text; NULL: it is a simple polygon. */
const char *pg_polygon_fault (size_t n, const double *v);
#endif
