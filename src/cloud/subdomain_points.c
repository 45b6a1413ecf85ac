/* SPDX-License-Identifier: GPL-3.0-or-later
 * The subdomains of points that no lattice gives: recursive bisection by coordinates (Berger and Bokhari
 * 1987), the list of points being cut across the longest side of its box into shares of the ranks. Every rank
 * knows all places, as it has read the file, finds by itself who owns what, and keeps its own points and, as
 * ghosts, those of others within the layer around the box of its own. */
#include "subdomain.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A point of a list that is to be cut, and its coordinate across the cut. */
typedef struct { double at; int point; } place;

/* Along the cut, then by number, so that the order is one. */
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

/* Ranks first .. first + ranks - 1 share the points of a list. */
static void bisect (place *list, size_t n, const pg_cloud *c, int first, int ranks, int *owner)
{
    if (ranks == 1 || n == 0) {
        for (size_t i = 0; i < n; i++) owner[list[i].point] = first;
        return;
    }
    int axis = longest (c, list, n), half = ranks / 2;
    size_t cut = (size_t) (((double) n * half) / ranks + 0.5);
    for (size_t i = 0; i < n; i++) list[i].at = coordinate (c, list[i].point, axis);
    qsort (list, n, sizeof *list, ascending);
    bisect (list, cut, c, first, half, owner);
    bisect (list + cut, n - cut, c, first + half, ranks - half, owner);
}

pg_status cloud_bisect (int **owner, const pg_cloud *c, int size)
{
    pg_status status = PG_OK;
    place *list = NULL;
    PG_ALLOC (*owner, c->n);
    PG_ALLOC (list, c->n);
    for (size_t i = 0; i < c->n; i++) list[i].point = (int) i;
    bisect (list, c->n, c, 0, size, *owner);
done:
    pg_free (list);
    return status;
}

/* The box of the points of a rank and the layer of ghosts around it, m. */
typedef struct { double low[3], high[3]; } region;

static region region_of (const pg_cloud *c, const int *owner, int rank, double width)
{
    region box;
    for (int k = 0; k < c->dim; k++) {
        box.low[k] = INFINITY, box.high[k] = -INFINITY;
        for (size_t i = 0; i < c->n; i++) {
            if (owner[i] != rank) continue;
            box.low[k] = fmin (box.low[k], coordinate (c, (int) i, k) - width);
            box.high[k] = fmax (box.high[k], coordinate (c, (int) i, k) + width);
        }
    }
    return box;
}

static int within (const region *box, const pg_cloud *c, size_t i)
{
    for (int k = 0; k < c->dim; k++)
        if (coordinate (c, (int) i, k) < box->low[k] || coordinate (c, (int) i, k) > box->high[k]) return 0;
    return 1;
}

/* With every other rank: what it needs of the points here, and what is needed of its. at: number of each
 * point among those held, -1: not held. */
static pg_status make_halo (pg_halo *h, const pg_cloud *c, const int *owner, double width, int rank, int size,
                            const int *at)
{
    pg_status status = PG_OK;
    size_t nsend = 0, nreceive = 0, cap_send = 0, cap_receive = 0;
    region mine = region_of (c, owner, rank, width);
    PG_ALLOC (h->rank, (size_t) size);
    PG_ALLOC (h->send_first, (size_t) size + 1);
    PG_ALLOC (h->receive_first, (size_t) size + 1);
    for (int r = 0; r < size; r++) {
        if (r == rank) continue;
        region other = region_of (c, owner, r, width);
        for (size_t i = 0; i < c->n; i++) {
            if (owner[i] == rank && within (&other, c, i)) {
                PG_GROW (h->send, cap_send, nsend + 1);
                h->send[nsend++] = at[i];
            }
            if (owner[i] == r && within (&mine, c, i)) {
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

pg_status cloud_subdomain_of_points (pg_subdomain **out, const pg_cloud *c, const int *owner, double width,
                                     int rank, int size)
{
    pg_status status = PG_OK;
    pg_subdomain *d = NULL;
    int *at = NULL;
    double ratio = 1;
    for (size_t i = 0; i < c->n; i++) ratio = fmax (ratio, pg_cloud_ratio (c, i));
    width *= ratio;                                    /* horizons follow the spacing of a graded cloud */
    region mine = region_of (c, owner, rank, width * (1 + 1e-9));
    PG_ALLOC (d, 1);
    PG_ALLOC (at, c->n);
    d->width = width, d->total = (int64_t) c->n;
    for (size_t i = 0; i < c->n; i++) at[i] = owner[i] == rank || within (&mine, c, i) ? (int) d->n++ : -1;
    PG_ALLOC (d->owned, d->n);
    PG_ALLOC (d->number, d->n);
    for (size_t i = 0; i < c->n; i++) {
        if (at[i] < 0) continue;
        d->owned[at[i]] = owner[i] == rank, d->nowned += owner[i] == rank;
        d->number[at[i]] = (int64_t) i;
    }
    PG_TRY (make_halo (&d->halo, c, owner, width * (1 + 1e-9), rank, size, at));
    *out = d;
    d = NULL;
done:
    pg_free (at);
    pg_subdomain_free (&d);
    return status;
}

/* The arrays keep their room: what is behind the points held is nothing. */
void cloud_keep_held (pg_cloud *c, const pg_subdomain *d)
{
    size_t dim = (size_t) c->dim;
    for (size_t i = 0; i < d->n; i++) {
        size_t from = (size_t) d->number[i];
        memmove (c->x + i * dim, c->x + from * dim, dim * sizeof *c->x);
        c->volume[i] = c->volume[from];
        if (c->block) c->block[i] = c->block[from];
        if (c->size) c->size[i] = c->size[from];
    }
    c->n = d->n;
}
