/* SPDX-License-Identifier: GPL-3.0-or-later
 * place.h: what points of a lattice, of a file and of a mesh share. */
#ifndef PERIGAL_CLOUD_PLACE_H
#define PERIGAL_CLOUD_PLACE_H
#include "perigal/cloud.h"
#include <stdint.h>

/* Uniform in [-1, 1), a function of seed, site and axis only. */
double    pg_place_shift  (uint64_t seed, uint64_t site, int axis);
/* Path of a file that the scene names: beside the scene unless it is absolute; pg_free. */
pg_status pg_place_beside (char **out, const pg_scene *scene, const char *name);
/* low, high of the points. */
void      pg_place_bounds (pg_cloud *cloud);
#endif
