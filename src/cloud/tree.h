/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: positions sorted into halves along x, y, z, x, ..., for searches of very different reach. */
#ifndef PERIGAL_CLOUD_TREE_H
#define PERIGAL_CLOUD_TREE_H
#include "perigal/base.h"

/* The items in the order of the tree; x is borrowed (n x dim), m. */
typedef struct { int dim; size_t n, *item; const double *x; } pg_tree;
pg_status pg_tree_build (pg_tree *out, int dim, size_t n, const double *x);
void      pg_tree_clear (pg_tree *tree);
/* Calls tell for all items in the cube of half width `reach` about `at`, and for some beyond. */
typedef void (*pg_tree_teller) (void *context, size_t item);
void pg_tree_near (const pg_tree *tree, const double *at, double reach, pg_tree_teller tell, void *context);
#endif
