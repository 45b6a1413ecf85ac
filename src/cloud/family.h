/* SPDX-License-Identifier: GPL-3.0-or-later
 * family.h: the two ways to find families, which give the same ones: by boxes (family.c), and by a k-d tree
 * (family_tree.c) for points that lie too scattered for boxes. */
#ifndef PERIGAL_CLOUD_FAMILY_H
#define PERIGAL_CLOUD_FAMILY_H
#include "boxes.h"

/* The distance up to which points belong to a family, m: a relative margin of 1e-9 decides about those at
 * exactly `reach`, which rounding would leave to chance. */
static inline double pg_family_edge (double reach, pg_nearness near)
{
    return reach * (near.closed ? 1 + 1e-9 : 1 - 1e-9);
}
/* By the tree; positions are known to be finite. PG_E_MEMORY. */
pg_status pg_family_by_tree (pg_family *out, const pg_cloud *cloud, size_t n, const double *centre,
                             double reach, pg_nearness near);
#endif
