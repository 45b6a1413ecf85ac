/* SPDX-License-Identifier: GPL-3.0-or-later
 * tree.h: a k-d tree for searches among points: which points lie near a position (families, family.c), and
 * which is the nearest (nearest.c). Elements of a mesh are found by their boxes instead
 * (geometry/mesh/locator.c).
 *
 * The tree needs no pointers. The points are sorted so that the middle one of a range divides the range along
 * one axis: smaller ones come before it, larger ones after it, and both halves are divided in the same way
 * along the next axis. A range of LEAF points or fewer is left as it is. */
#ifndef PERIGAL_CLOUD_TREE_H
#define PERIGAL_CLOUD_TREE_H
#include "perigal/base.h"

enum { PG_TREE_LEAF = 8 };

/* The sorted points. */
typedef struct {
    int     dim;
    size_t  n;
    /* Number of the point at each position of the sorted order (n). */
    size_t *item;
    /* Coordinates of the points in sorted order, m (n x dim). */
    double *x;
} pg_tree;

/* Sorts n points x (n x dim, m), which are copied; equal points are allowed. PG_E_MEMORY. */
pg_status pg_tree_build (pg_tree *out, int dim, size_t n, const double *x);
void      pg_tree_clear (pg_tree *tree);

/* Calls `visit` with ranges first .. last - 1 of the sorted order, which together hold every point within
 * `reach` (m) of `at` along each axis, and some beyond. The ranges do not overlap. */
typedef void (*pg_tree_visit) (void *context, size_t first, size_t last);
void pg_tree_near (const pg_tree *tree, const double *at, double reach, pg_tree_visit visit, void *context);

/* The point nearest to `at` that is not refused (refuse NULL: none is); of equally near ones that with the
 * lowest number; -1: all are refused, or `at` is not finite. *away: its distance, m; may be NULL. */
typedef int (*pg_tree_refuse) (void *context, const double *at, size_t item);
long pg_tree_nearest (const pg_tree *tree, const double *at, pg_tree_refuse refuse, void *context,
                      double *away);
#endif
