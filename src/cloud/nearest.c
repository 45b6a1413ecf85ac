/* SPDX-License-Identifier: GPL-3.0-or-later
 * The nearest point of a set, by the k-d tree of tree.h. Of equally near points it is the one with the lowest
 * number: no answer depends on the order in which the tree is walked. */
#include "perigal/cloud.h"
#include "tree.h"
#include <limits.h>

/* The tree; a structure of its own, so that the header of the tree stays private. */
struct pg_nearest { pg_tree tree; };

pg_status pg_nearest_create (pg_nearest **out, int dim, size_t n, const double *x)
{
    pg_status status = PG_OK;
    pg_nearest *nearest = NULL;
    *out = NULL;
    if (n == 0 || n > INT_MAX) PG_FAIL (PG_E_USAGE, "the nearest of %zu points is asked for", n);
    PG_ALLOC (nearest, 1);
    PG_TRY (pg_tree_build (&nearest->tree, dim, n, x));
    *out = nearest;
    nearest = NULL;
done:
    pg_nearest_free (&nearest);
    return status;
}

void pg_nearest_free (pg_nearest **nearest)
{
    if (!*nearest) return;
    pg_tree_clear (&(*nearest)->tree);
    pg_free (*nearest);
    *nearest = NULL;
}

/* pg_refuse and pg_tree_refuse are the same type of function. */
long pg_nearest_find (const pg_nearest *nearest, const double *place, pg_refuse refuse, void *context)
{
    return pg_tree_nearest (&nearest->tree, place, refuse, context);
}
