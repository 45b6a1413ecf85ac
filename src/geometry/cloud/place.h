/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: what points of a lattice, of a file and of a mesh share. */
#ifndef PERIGAL_CLOUD_PLACE_H
#define PERIGAL_CLOUD_PLACE_H
#include "geometry/cloud/search/random.h"
#include "perigal/cloud.h"

/* Fills low and high of the cloud. */
void      pg_place_bounds (pg_cloud *cloud);
#endif
