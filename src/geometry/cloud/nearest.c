/* SPDX-License-Identifier: GPL-3.0-or-later
 * The nearest point of a set, by the k-d tree of tree.h. Of equally near points it is the one with the lowest
 * number: no answer depends on the order in which the tree is walked. */
#include "perigal/cloud.h"
#include "geometry/cloud/search/tree.h"
#include <limits.h>
#include <math.h>

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
    return pg_tree_nearest (&nearest->tree, place, refuse, context, NULL);
}

typedef struct {
    const pg_tree *tree;
    const double *place;
    double away;                                       /* largest distance of points to collect, m */
    pg_refuse refuse;  void *context;
    size_t n, *point;
} collection;

static void collect (void *context, size_t first, size_t last)
{
    collection *c = context;
    size_t dim = (size_t) c->tree->dim;
    for (size_t e = first; e < last && c->n < PG_NEAREST_MOST; e++) {
        double away = 0;
        for (size_t k = 0; k < dim; k++) away = hypot (away, c->tree->x[e * dim + k] - c->place[k]);
        if (away > c->away || (c->refuse && c->refuse (c->context, c->place, c->tree->item[e]))) continue;
        c->point[c->n++] = c->tree->item[e];
    }
}

size_t pg_nearest_all (const pg_nearest *nearest, const double *place, double same, pg_refuse refuse,
                       void *context, size_t *point)
{
    collection c = { .tree = &nearest->tree, .place = place, .refuse = refuse, .context = context,
                     .point = point };
    double away;
    long found = pg_tree_nearest (&nearest->tree, place, refuse, context, &away);
    if (found < 0) return 0;
    c.away = away * (1 + 1e-15) + same;
    pg_tree_near (c.tree, place, c.away, collect, &c);
    return c.n;
}

size_t pg_nearest_seen (const pg_nearest *nearest, const double *place, double same, pg_refuse refuse,
                        void *context, size_t *point)
{
    size_t n = pg_nearest_all (nearest, place, same, refuse, context, point);
    return n || !refuse ? n : pg_nearest_all (nearest, place, same, NULL, NULL, point);
}
