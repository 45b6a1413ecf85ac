/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: the search for the nearest element without the limits of pg_mesh_locator_find, for skin.c. */
#ifndef MESH_FINDER_H
#define MESH_FINDER_H
#include "perigal/mesh.h"
/* Returns the element (of any dimension up to that of the space) nearest to a position, at most `reach` away;
 * *d: its distance, in the unit of the mesh. -1 and HUGE_VAL: there is none. */
long locator_nearest (const pg_mesh_locator *f, const double *place, double reach, double *d);
#endif
