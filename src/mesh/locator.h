/* SPDX-License-Identifier: GPL-3.0-or-later
 * locator.h: the search of pg_mesh_locator without its limits, for skin.c. */
#ifndef MESH_FINDER_H
#define MESH_FINDER_H
#include "perigal/mesh.h"
/* The element (of any dimension up to that of the space) nearest to a place, at most `reach` away; d: how
 * far. -1, HUGE_VAL: none. */
long locator_nearest (const pg_mesh_locator *f, const double *place, double reach, double *d);
#endif
