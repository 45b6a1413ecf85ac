/* SPDX-License-Identifier: GPL-3.0-or-later
 * Plane polygons as lists of (x, y): n >= 3 vertices, closed implicitly. */
#ifndef PERIGAL_CLOUD_POLYGON_H
#define PERIGAL_CLOUD_POLYGON_H
#include <stddef.h>

double pg_polygon_area     (size_t n, const double *v);                    /* signed: > 0 counter-clockwise */
int    pg_polygon_inside   (size_t n, const double *v, const double *x);   /* crossing number */
/* to the outline, negative inside */
double pg_polygon_distance (size_t n, const double *v, const double *x);
/* What is wrong with the outline: a static text, or NULL when it is a simple polygon. */
const char *pg_polygon_fault (size_t n, const double *v);
#endif
