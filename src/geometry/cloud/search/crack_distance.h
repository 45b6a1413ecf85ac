/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: the distance between two cracks, and the size of one. Slots are measured by their middle lines or
 * planes, outlines by their area. */
#ifndef PERIGAL_CLOUD_CRACK_DISTANCE_H
#define PERIGAL_CLOUD_CRACK_DISTANCE_H
#include "perigal/cloud.h"

/* A ball that holds the crack: its middle and its radius, m. */
void   crack_ball     (const pg_crack *c, int dim, double *middle, double *radius);
/* Least distance of a point on one crack from a point on the other, m; 0 where they touch or cross. A disc
 * counts as its polygon of 64 corners, which lies inside by at most 0.0013 of the radius. */
double crack_distance (const pg_crack *a, const pg_crack *b, int dim);
/* Area (2D) or volume (3D) that a slot removes, m^2 or m^3; 0 of a sharp crack. */
double crack_removed  (const pg_crack *c, int dim);
/* Length of a crack: largest distance of two corners, m. */
double crack_length   (const pg_crack *c, int dim);
/* Axis along a crack in 2D, or normal to it in 3D: a unit vector, of either sign. */
void   crack_axis     (const pg_crack *c, int dim, double *axis);
#endif
