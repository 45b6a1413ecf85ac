/* SPDX-License-Identifier: GPL-3.0-or-later
 * Disjoint sets of 0 .. n - 1 as a forest (union-find, Tarjan 1975): which points are connected. The loops
 * that run for every bond stand in base.h. */
#include "perigal/base.h"

void pg_disjoint_start (int *parent, size_t n)
{
    for (size_t i = 0; i < n; i++) parent[i] = (int) i;
}
