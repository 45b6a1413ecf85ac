/* SPDX-License-Identifier: GPL-3.0-or-later
 * family.h: the two ways to find families, which give the same ones: by boxes (family.c), and by a k-d tree
 * (family_tree.c) for points that lie too scattered for boxes. */
#ifndef PERIGAL_CLOUD_FAMILY_H
#define PERIGAL_CLOUD_FAMILY_H
#include "geometry/cloud/search/boxes.h"
#include <math.h>

/* The distance up to which points belong to a family, m: a margin of 1e-9, and the rounding of coordinates,
 * decides about those at exactly `reach`, which rounding would leave to chance. */
static inline double pg_family_edge (const pg_cloud *cloud, double reach, pg_nearness near)
{
    double margin = 1e-9 * reach + pg_rounding (cloud->dim, cloud->low, cloud->high);
    return near.closed ? reach + margin : fmax (0, reach - margin);
}
/* By the tree; positions are known to be finite. PG_E_MEMORY. */
pg_status pg_family_by_tree (pg_family *out, const pg_cloud *cloud, size_t n, const double *centre,
                             double reach, pg_nearness near);
#endif
