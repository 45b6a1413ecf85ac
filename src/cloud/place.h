/* SPDX-License-Identifier: GPL-3.0-or-later
 * place.h: what points of a lattice, of a file and of a mesh share. */
#ifndef PERIGAL_CLOUD_PLACE_H
#define PERIGAL_CLOUD_PLACE_H
#include "perigal/cloud.h"
#include <stdint.h>

/* Uniform in [-1, 1), a function of seed, site and axis only. */
double    pg_place_shift  (uint64_t seed, uint64_t site, int axis);
/* low, high of the points. */
void      pg_place_bounds (pg_cloud *cloud);
#endif
