/* SPDX-License-Identifier: GPL-3.0-or-later
 * Order of the points of a list of bonds: slabs of equal numbers of points along one axis are cut along the
 * next axes into compact chunks, and these into tiles; in a tile points with many bonds out of the chunk come
 * first, then those with many bonds in it, so that the slots of a slice are full. */
#include "list.h"
#include <math.h>
#include <stdlib.h>

enum { TILE = 256 };  /* points of a tile, whose records fit into the first cache */

typedef struct { double key; int point; } item;
/* Numbers of bonds of a point to other chunks (out) and to later points of its own chunk (in). */
typedef struct { int out, in, point, rank; } load;

/* Compares positions along an axis; equal ones by number, so that the order does not depend on the sort. */
static int by_key (const void *a, const void *b)
{
    const item *p = a, *q = b;
    return p->key < q->key ? -1 : p->key > q->key ? 1 : (p->point > q->point) - (p->point < q->point);
}

/* Compares loads: most bonds out of the chunk first, then most within it, then by rank. */
static int by_load (const void *a, const void *b)
{
    const load *p = a, *q = b;
    return p->out != q->out ? q->out - p->out
           : p->in != q->in ? q->in - p->in
                            : (p->rank > q->rank) - (p->rank < q->rank);
}

/* Sorts n items along `axis`, cuts them into slabs of whole chunks, about as thick as a chunk is wide, and
 * these along the axes below. wide: extent of the items along each axis, m; chunk: points of a chunk. */
static void cut (item *items, size_t n, const pg_cloud *cloud, const double *wide, size_t chunk, int axis)
{
    size_t dim = (size_t) cloud->dim, pieces = (n + chunk - 1) / chunk;
    for (size_t k = 0; k < n; k++) items[k].key = cloud->x[(size_t) items[k].point * dim + (size_t) axis];
    pg_sort (items, n, sizeof *items, by_key);
    if (axis == 0 || pieces <= 1) return;
    double length = items[n - 1].key - items[0].key, space = (double) pieces;
    for (int k = 0; k < axis; k++) {
        space *= wide[k] > 0 ? length / wide[k] : 1;
    }
    double slabs = fmin (fmax (1, round (pow (space, 1.0 / (axis + 1)))), (double) pieces);
    size_t step = (pieces + (size_t) slabs - 1) / (size_t) slabs * chunk;
    for (size_t k = 0; k < n; k += step)
        cut (items + k, n - k < step ? n - k : step, cloud, wide, chunk, axis - 1);
}

/* Sorts the points into compact chunks, and those of every chunk into compact tiles. */
static void cut_all (item *items, size_t n, const pg_cloud *cloud, size_t chunk)
{
    int dim = cloud->dim;
    double wide[3];
    for (int c = 0; c < dim; c++) wide[c] = cloud->high[c] - cloud->low[c];
    cut (items, n, cloud, wide, chunk, dim - 1);
    for (size_t k = 0; k < n; k += chunk) {
        size_t m = n - k < chunk ? n - k : chunk;
        for (int c = 0; c < dim; c++) {
            double low = INFINITY, high = -INFINITY;
            for (size_t i = k; i < k + m; i++) {
                double x = cloud->x[(size_t) items[i].point * (size_t) dim + (size_t) c];
                low = fmin (low, x), high = fmax (high, x);
            }
            wide[c] = high - low;
        }
        cut (items + k, m, cloud, wide, TILE, dim - 1);
    }
}

/* Counts for each point first .. last - 1 of a chunk the bonds that leave the chunk, and the bonds to later
 * points of it, which are stored at this point. */
static void count_bonds (load *loads, const bond_list *list, size_t first, size_t last)
{
    const pg_family *family = list->family;
    for (size_t p = first; p < last; p++) {
        size_t i = (size_t) list->point[p];
        load *l = &loads[p - first];
        *l = (load) { 0, 0, (int) i, (int) p };
        for (size_t e = family->start[i]; e < family->start[i + 1]; e++) {
            size_t q = (size_t) list->rank[family->node[e]];
            if (q < first || q >= last) l->out++;
            else l->in += q > p;
        }
    }
}

/* Fills point (old number by new one), rank (new number by old one) and before, the rank before the points of
 * a tile were sorted by load: a shared bond is stored at the end for which it is lower, which spreads bonds
 * evenly. */
pg_status pg_list_order (bond_list *list)
{
    pg_status status = PG_OK;
    const pg_cloud *cloud = list->sums->cloud;
    item *items = NULL;
    load *loads = NULL;
    PG_ALLOC (items, list->n);
    PG_ALLOC (loads, list->chunk);
    for (size_t i = 0; i < list->n; i++) items[i].point = (int) i;
    cut_all (items, list->n, cloud, list->chunk);
    for (size_t p = 0; p < list->n; p++)
        list->point[p] = items[p].point, list->rank[items[p].point] = (int) p;
    for (size_t first = 0; first < list->n; first += list->chunk) {
        size_t last = list->n - first < list->chunk ? list->n : first + list->chunk;
        count_bonds (loads, list, first, last);
        for (size_t k = first; k < last; k += TILE)
            pg_sort (loads + (k - first), last - k < TILE ? last - k : TILE, sizeof *loads, by_load);
        for (size_t p = first; p < last; p++) list->point[p] = loads[p - first].point;
    }
    for (size_t p = 0; p < list->n; p++) list->before[list->point[p]] = list->rank[list->point[p]];
    for (size_t p = 0; p < list->n; p++) list->rank[list->point[p]] = (int) p;
done:
    pg_free (items);
    pg_free (loads);
    return status;
}
