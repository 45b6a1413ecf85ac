/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: what points of a lattice, of a file and of a mesh share. */
#ifndef PERIGAL_CLOUD_PLACE_H
#define PERIGAL_CLOUD_PLACE_H
#include "perigal/cloud.h"
#include <stdint.h>

/* Uniform in [-1, 1), a function of seed, site and axis only: independent of order and threads. */
double    pg_place_shift  (uint64_t seed, uint64_t site, int axis);
/* Fills low and high of the cloud. */
void      pg_place_bounds (pg_cloud *cloud);
#endif
