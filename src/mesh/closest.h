/* SPDX-License-Identifier: GPL-3.0-or-later
 * closest.h: the place of one element that is nearest to a place outside it. */
#ifndef MESH_CLOSEST_H
#define MESH_CLOSEST_H
#include "perigal/mesh.h"
/* xi in the reference element that brings the element (nodes x: nodes x dim; dim at least its own) nearest to
 * `place`; the distance. Newton's method for |x (xi) - place|^2 (Gauss-Newton) under the bounds of the
 * reference element; exact for linear simplices. */
double closest_in_element (pg_element kind, int dim, const double *x, const double *place, double *xi);
#endif
