/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: the point of one element that is nearest to a position outside it, for the search for the nearest
 * element and for distances from a surface. */
#ifndef MESH_CLOSEST_H
#define MESH_CLOSEST_H
#include "perigal/mesh.h"
/* Finds the point of an element (nodes x: nodes x dim, dim at least its own) nearest to `place`: writes its
 * reference coordinates xi, and returns the distance. Exact for linear simplices; curved elements may have
 * several local minima, of which the one reached from the centre is returned. */
double closest_in_element (pg_element kind, int dim, const double *x, const double *place, double *xi);
#endif
