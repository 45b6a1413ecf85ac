/* SPDX-License-Identifier: GPL-3.0-or-later
 * Disjoint sets of 0 .. n - 1 as a forest (union-find, Tarjan 1975): which points are connected. Path
 * halving makes every other node on a path point to its grandparent, which keeps the trees flat without
 * ranks. */
#include "perigal/base.h"

void pg_disjoint_start (int *parent, size_t n)
{
    for (size_t i = 0; i < n; i++) parent[i] = (int) i;
}

int pg_disjoint_root (int *parent, int i)
{
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
}

/* The root of the second set wins, so that a caller can keep data at that root. */
int pg_disjoint_join (int *parent, int a, int b)
{
    int below = pg_disjoint_root (parent, a), root = pg_disjoint_root (parent, b);
    parent[below] = root;
    return root;
}
