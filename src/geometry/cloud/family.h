/* SPDX-License-Identifier: GPL-3.0-or-later
 * family.h: two methods to find families (the neighbours within a distance), with equal results: by boxes
 * (family.c), and by a k-d tree (family_tree.c) for points that lie too scattered for boxes. */
#ifndef PERIGAL_CLOUD_FAMILY_H
#define PERIGAL_CLOUD_FAMILY_H
#include "geometry/cloud/search/boxes.h"
#include <math.h>

/* The distance up to which points belong to a family, m: `reach` plus (near.closed) or minus a margin of 1e-9
 * and the rounding of coordinates, so that rounding does not decide about points at exactly `reach`. */
static inline double pg_family_edge (const pg_cloud *cloud, double reach, pg_nearness near)
{
    double margin = 1e-9 * reach + pg_rounding (cloud->dim, cloud->low, cloud->high);
    return near.closed ? reach + margin : fmax (0, reach - margin);
}
/* Finds families by a k-d tree; all positions must be finite. PG_E_MEMORY. */
pg_status pg_family_by_tree (pg_family *out, const pg_cloud *cloud, size_t n, const double *centre,
                             double reach, pg_nearness near);
#endif
