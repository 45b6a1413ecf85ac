/* SPDX-License-Identifier: GPL-3.0-or-later
 * The subdomains of points that stand on no lattice (points of a file, or of a mesh): recursive bisection by
 * coordinates (Berger and Bokhari 1987), the list of points being cut across the longest side of its box into
 * shares of the ranks. Every rank knows all positions, as it has read the file, finds by itself who owns
 * what, and keeps its own points and, as ghosts, those of others within the layer around the box of its
 * own. */
#include "subdomain.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A point of a list that is to be cut, and its coordinate across the cut. */
typedef struct { double at; int point; } place;

/* Orders points by their coordinate, then by their number, so that the order is unique. */
static int ascending (const void *a, const void *b)
{
    const place *x = a, *y = b;
    if (x->at != y->at) return x->at < y->at ? -1 : 1;
    return (x->point > y->point) - (x->point < y->point);
}

static double coordinate (const pg_cloud *c, int point, int axis)
{
    return c->x[(size_t) point * (size_t) c->dim + (size_t) axis];
}

/* The axis along which the points of a list spread most. */
static int longest (const pg_cloud *c, const place *list, size_t n)
{
    double best = -1;
    int axis = 0;
    for (int k = 0; k < c->dim; k++) {
        double low = INFINITY, high = -INFINITY;
        for (size_t i = 0; i < n; i++) {
            double x = coordinate (c, list[i].point, k);
            low = fmin (low, x), high = fmax (high, x);
        }
        if (high - low > best * (1 + 1e-9)) best = high - low, axis = k;
    }
    return axis;
}

/* Divides the points of a list among the ranks first .. first + ranks - 1. */
static void bisect (place *list, size_t n, const pg_cloud *c, int first, int ranks, int *owner)
{
    if (ranks == 1 || n == 0) {
        for (size_t i = 0; i < n; i++) owner[list[i].point] = first;
        return;
    }
    int axis = longest (c, list, n), half = ranks / 2;
    size_t cut = (size_t) (((double) n * half) / ranks + 0.5);
    for (size_t i = 0; i < n; i++) list[i].at = coordinate (c, list[i].point, axis);
    pg_sort (list, n, sizeof *list, ascending);
    bisect (list, cut, c, first, half, owner);
    bisect (list + cut, n - cut, c, first + half, ranks - half, owner);
}

/* The box of the points of each rank, m. */
static void find_boxes (cloud_division *d, const pg_cloud *c)
{
    for (int r = 0; r < d->size; r++)
        for (int k = 0; k < 3; k++) d->box[r].low[k] = INFINITY, d->box[r].high[k] = -INFINITY;
    for (size_t i = 0; i < c->n; i++)
        for (int k = 0; k < c->dim; k++) {
            cloud_region *box = &d->box[d->owner[i]];
            double x = coordinate (c, (int) i, k);
            box->low[k] = fmin (box->low[k], x), box->high[k] = fmax (box->high[k], x);
        }
}

/* Is point i in a box, or within `width` of it along each axis? */
static int within (const cloud_region *box, double width, const pg_cloud *c, size_t i)
{
    for (int k = 0; k < c->dim; k++) {
        double x = coordinate (c, (int) i, k);
        if (x < box->low[k] - width || x > box->high[k] + width) return 0;
    }
    return 1;
}

/* Finds the width of each rank's layer of ghosts, m. Horizons follow the spacing of a graded cloud: the width
 * is `width` times the largest spacing ratio among the points in a layer that is as wide as the largest ratio
 * of all requires. */
static void find_widths (cloud_division *d, const pg_cloud *c, double width)
{
    double most = 1;
    for (size_t i = 0; i < c->n; i++) most = fmax (most, pg_cloud_ratio (c, i));
    for (int r = 0; r < d->size; r++) {
        double ratio = 1;
        for (size_t i = 0; i < c->n && most > 1; i++)
            if (within (&d->box[r], most * width, c, i)) ratio = fmax (ratio, pg_cloud_ratio (c, i));
        d->width[r] = ratio * width * (1 + 1e-9);
    }
}

pg_status cloud_divide_points (cloud_division *d, const pg_cloud *c, double width, int size)
{
    pg_status status = PG_OK;
    place *list = NULL;
    memset (d, 0, sizeof *d);
    d->size = size;
    PG_ALLOC (d->owner, c->n);
    PG_ALLOC (d->box, (size_t) size);
    PG_ALLOC (d->width, (size_t) size);
    PG_ALLOC (list, c->n);
    for (size_t i = 0; i < c->n; i++) list[i].point = (int) i;
    bisect (list, c->n, c, 0, size, d->owner);
    find_boxes (d, c);
    find_widths (d, c, width);
done:
    pg_free (list);
    return status;
}

void cloud_division_clear (cloud_division *d)
{
    pg_free (d->owner), pg_free (d->box), pg_free (d->width);
    memset (d, 0, sizeof *d);
}

/* Do the layers of two ranks reach each other's points? */
static int near_by (const cloud_division *d, int dim, int a, int b)
{
    double width = fmax (d->width[a], d->width[b]);
    for (int k = 0; k < dim; k++)
        if (d->box[a].low[k] > d->box[b].high[k] + width || d->box[b].low[k] > d->box[a].high[k] + width)
            return 0;
    return 1;
}

/* Lists for every other rank which points of this rank it needs, and which of its points are needed here. at:
 * number of each point among those held, -1: not held. */
static pg_status make_halo (pg_halo *h, const pg_cloud *c, const cloud_division *d, int rank, const int *at)
{
    pg_status status = PG_OK;
    size_t nsend = 0, nreceive = 0, cap_send = 0, cap_receive = 0;
    PG_ALLOC (h->rank, (size_t) d->size);
    PG_ALLOC (h->send_first, (size_t) d->size + 1);
    PG_ALLOC (h->receive_first, (size_t) d->size + 1);
    for (int r = 0; r < d->size; r++) {
        if (r == rank || !near_by (d, c->dim, r, rank)) continue;
        for (size_t i = 0; i < c->n; i++) {
            if (d->owner[i] == rank && within (&d->box[r], d->width[r], c, i)) {
                PG_GROW (h->send, cap_send, nsend + 1);
                h->send[nsend++] = at[i];
            }
            if (d->owner[i] == r && within (&d->box[rank], d->width[rank], c, i)) {
                PG_GROW (h->receive, cap_receive, nreceive + 1);
                h->receive[nreceive++] = at[i];
            }
        }
        if (nsend == h->send_first[h->n] && nreceive == h->receive_first[h->n]) continue;
        h->rank[h->n++] = r;
        h->send_first[h->n] = nsend, h->receive_first[h->n] = nreceive;
    }
done:
    return status;
}

pg_status cloud_subdomain_of_points (pg_subdomain **out, const pg_cloud *c, const cloud_division *how,
                                     int rank)
{
    pg_status status = PG_OK;
    pg_subdomain *d = NULL;
    int *at = NULL;
    PG_ALLOC (d, 1);
    PG_ALLOC (at, c->n);
    d->width = how->width[rank], d->total = (int64_t) c->n;
    for (size_t i = 0; i < c->n; i++)
        at[i] = within (&how->box[rank], d->width, c, i) ? (int) d->n++ : -1;
    PG_ALLOC (d->owned, d->n);
    PG_ALLOC (d->number, d->n);
    for (size_t i = 0; i < c->n; i++) {
        if (at[i] < 0) continue;
        d->owned[at[i]] = how->owner[i] == rank, d->nowned += how->owner[i] == rank;
        d->number[at[i]] = (int64_t) i;
    }
    PG_TRY (make_halo (&d->halo, c, how, rank, at));
    *out = d;
    d = NULL;
done:
    pg_free (at);
    pg_subdomain_free (&d);
    return status;
}

/* Shrinks an array to the n values that are still needed. */
static void *shrunk (void *array, size_t n, size_t size)
{
    void *less = array ? pg_resize (array, n, size) : NULL;
    return less ? less : array;
}

void pg_cloud_keep (pg_cloud *c)
{
    const pg_subdomain *d = c->subdomain;
    size_t dim = (size_t) c->dim, square = dim * dim;
    for (size_t i = 0; i < d->n; i++) {
        size_t from = (size_t) d->number[i];
        memmove (c->x + i * dim, c->x + from * dim, dim * sizeof *c->x);
        c->volume[i] = c->volume[from];
        if (c->block) c->block[i] = c->block[from];
        if (c->size) c->size[i] = c->size[from];
        if (c->metric)
            memmove (c->metric + i * square, c->metric + from * square, square * sizeof *c->metric);
    }
    c->n = d->n;
    c->x = shrunk (c->x, c->n * dim, sizeof *c->x), c->volume = shrunk (c->volume, c->n, sizeof *c->volume);
    c->block = shrunk (c->block, c->n, sizeof *c->block), c->size = shrunk (c->size, c->n, sizeof *c->size);
    c->metric = shrunk (c->metric, c->n * square, sizeof *c->metric);
}
