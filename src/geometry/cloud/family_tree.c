/* SPDX-License-Identifier: GPL-3.0-or-later
 * Families of points that are too scattered for boxes (family.c): the centres are sorted into a k-d tree;
 * the points then visit, in ascending order, the centres near them, so that each family comes out sorted.
 * O(n log n), however crowded some places are. */
#include "family.h"
#include "geometry/cloud/search/tree.h"
#include <math.h>
#include <string.h>

/* ---- members of a family ------------------------------------------------------------------------------- */
/* State of one pass over all points. */
typedef struct {
    /* Tree of the centres. */
    const pg_tree *tree;
    /* Reach of the search, a little more than the largest distance of a member, m. */
    double  reach;
    /* Largest distance of a member (radial: its square). */
    double  limit;
    int     shape, closed;
    /* For each centre the index in `node` of its next member; counts up. */
    size_t *next;
    /* Members of all families; NULL in the counting pass. */
    int    *node;
    /* Bounding box of the centres, m: points farther from it than their reach belong to no family. */
    double  low[3], high[3];
    /* The visiting point: its position (m) and number. */
    const double *x;  int j;
    /* The cloud where supports are ellipsoids; NULL: they are balls. */
    const pg_cloud *anisotropic;
} search;

/* Does the visiting point belong to the family of the centre c? */
static inline int belongs (const search *s, int dim, const double *c)
{
    double d = 0, bond[3] = { 0 };
    if (s->anisotropic) {
        for (int k = 0; k < dim; k++) bond[k] = s->x[k] - c[k];
        d = pg_cloud_length2 (s->anisotropic, (size_t) s->j, bond);
        return s->closed ? d <= s->limit : d < s->limit;
    }
    for (int k = 0; k < dim; k++) {
        double z = fabs (s->x[k] - c[k]);
        d = s->shape == PG_RADIAL ? d + z*z : fmax (d, z);
    }
    return s->closed ? d <= s->limit : d < s->limit;
}

/* Enters the visiting point into the families of some centres. */
static void join (void *context, size_t first, size_t last)
{
    search *s = context;
    const pg_tree *t = s->tree;
    for (size_t e = first; e < last; e++) {
        if (!belongs (s, t->dim, t->x + e * (size_t) t->dim)) continue;
        size_t i = t->item[e];
        if (s->node) s->node[s->next[i]] = s->j;
        s->next[i]++;
    }
}

/* Can the visiting point be within its reach of a centre? Few centres, such as positions around the tip of a
 * crack, are then found without a search of the tree for every point of the body. */
static inline int meets_box (const search *s, int dim)
{
    for (int k = 0; k < dim; k++)
        if (s->x[k] < s->low[k] - s->reach || s->x[k] > s->high[k] + s->reach) return 0;
    return 1;
}

/* The points visit the centres one after the other, so that each family comes out in ascending order; the
 * reach of a point follows its spacing. */
static void visit_points (const search *all, const pg_cloud *cloud, double reach)
{
    search s = *all;
    for (size_t j = 0; j < cloud->n; j++) {
        s.x = cloud->x + j * (size_t) cloud->dim, s.j = (int) j;
        if (cloud->size) {
            double far = reach * pg_cloud_ratio (cloud, j);
            s.reach = all->reach * pg_cloud_ratio (cloud, j);
            s.limit = s.shape == PG_RADIAL ? far * far : far;
        }
        if (!meets_box (&s, cloud->dim)) continue;
        pg_tree_near (s.tree, s.x, s.reach, join, &s);
    }
}

/* Two passes: the first counts, the second writes. The search is a little wider than the reach. */
pg_status pg_family_by_tree (pg_family *out, const pg_cloud *cloud, size_t n, const double *centre,
                             double reach, pg_nearness near)
{
    pg_status status = PG_OK;
    pg_tree tree = { 0 };
    double far = pg_family_edge (cloud, reach, near);
    search s = { .tree = &tree, .reach = fmax (reach, far) * (1 + 1e-8),
                 .shape = near.shape, .closed = near.closed,
                 .limit = near.shape == PG_RADIAL ? far * far : far,
                 .anisotropic = cloud->metric ? cloud : NULL };
    memset (out, 0, sizeof *out);
    for (int k = 0; k < cloud->dim; k++) {
        s.low[k] = INFINITY, s.high[k] = -INFINITY;
        for (size_t i = 0; i < n; i++) {
            s.low[k] = fmin (s.low[k], centre[i * (size_t) cloud->dim + (size_t) k]);
            s.high[k] = fmax (s.high[k], centre[i * (size_t) cloud->dim + (size_t) k]);
        }
    }
    PG_TRY (pg_tree_build (&tree, cloud->dim, n, centre));
    PG_ALLOC (out->start, n + 1);
    PG_ALLOC (s.next, n);
    out->n = n;
    /* First pass: numbers of members. */
    visit_points (&s, cloud, far);
    /* next becomes the index of the first member of each family. */
    for (size_t i = 0; i < n; i++) {
        out->start[i + 1] = out->start[i] + s.next[i];
        s.next[i] = out->start[i];
    }
    PG_ALLOC (out->node, out->start[n]);
    s.node = out->node;
    visit_points (&s, cloud, far);
done:
    pg_free (s.next);
    pg_tree_clear (&tree);
    if (status != PG_OK) pg_family_clear (out);
    return status;
}
