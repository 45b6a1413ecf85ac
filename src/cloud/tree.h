/* SPDX-License-Identifier: GPL-3.0-or-later
 * tree.h: places sorted into halves along x, y, z, x, ... for searches of very different reach. */
#ifndef PERIGAL_CLOUD_TREE_H
#define PERIGAL_CLOUD_TREE_H
#include "perigal/base.h"

typedef struct { int dim; size_t n, *item; const double *x; } pg_tree;   /* x borrowed (n x dim), m */
pg_status pg_tree_build (pg_tree *out, int dim, size_t n, const double *x);
void      pg_tree_clear (pg_tree *tree);
/* Calls tell for the items in a box about `at` that holds the cube of half width `reach`, and for some
 * beyond. */
typedef void (*pg_tree_teller) (void *context, size_t item);
void pg_tree_near (const pg_tree *tree, const double *at, double reach, pg_tree_teller tell, void *context);
#endif
