/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: what clouds of points from a lattice, from a file and from a mesh share. */
#ifndef PERIGAL_CLOUD_PLACE_H
#define PERIGAL_CLOUD_PLACE_H
#include "geometry/cloud/search/random.h"
#include "perigal/cloud.h"

/* Fills low and high of the cloud, its bounding box, m. */
void      pg_place_bounds (pg_cloud *cloud);
#endif
