/* SPDX-License-Identifier: GPL-3.0-or-later
 * The subdomain of a rank on a lattice. Cells are divided into one box a rank (pg_boxes_divide); a rank owns
 * the vertices at the low corners of its cells (and those at the end of the lattice), or the centres of its
 * cells, and holds ghosts in a layer as wide as the method needs. Sites at the rim of what it holds, around
 * which cells are missing, are points too, but too far away to matter, and are never updated. As boxes are
 * known on all ranks, every rank finds by itself what each of the others needs from it, without messages. */
#include "subdomain.h"
#include <float.h>
#include <math.h>
#include <string.h>

/* Sites of the whole lattice along an axis. */
static int sites_along (const pg_lattice *l, int k, int centred)
{
    return k < l->dim ? l->whole[k] + !centred : 1;
}

/* The sites owned by the rank that owns a box of cells. */
static pg_box sites_of (const pg_box *cells, const pg_lattice *l, int centred)
{
    pg_box out = *cells;
    for (int k = 0; k < 3; k++)
        if (k >= l->dim) out.low[k] = 0, out.high[k] = 1;
        else if (out.high[k] == l->whole[k]) out.high[k] = sites_along (l, k, centred);
    return out;
}

/* A box of sites widened by as many layers of ghosts as `width` (m) needs, within the lattice. */
static pg_box widened (pg_box b, const pg_lattice *l, int centred, double width)
{
    for (int k = 0; k < l->dim; k++) {
        double layers = ceil (width / l->step[k] + 1e-6);
        int more = layers < 1e9 ? (int) layers : 1000000000, end = sites_along (l, k, centred);
        b.low[k] = b.low[k] > more ? b.low[k] - more : 0;
        b.high[k] = b.high[k] < end - more ? b.high[k] + more : end;
    }
    return b;
}

/* ---- division ------------------------------------------------------------------------------------------ */
typedef struct { const pg_lattice *l; const pg_body *body; } counting;

/* Counts the cells in a plane of a box that lie in the body. */
static double count_plane (const void *context, const pg_box *box, int axis, int plane)
{
    const counting *c = context;
    double n = 0, tolerance = pg_lattice_tolerance (c->l);
    int i[3], low[3], high[3];
    for (int k = 0; k < 3; k++) low[k] = k == axis ? plane : box->low[k],
                                high[k] = k == axis ? plane + 1 : box->high[k];
    for (i[2] = low[2]; i[2] < high[2]; i[2]++)
        for (i[1] = low[1]; i[1] < high[1]; i[1]++)
            for (i[0] = low[0]; i[0] < high[0]; i[0]++) {
                double x[3] = {0, 0, 0};
                for (int k = 0; k < c->l->dim; k++) x[k] = pg_lattice_at (c->l, k, i[k] + 0.5);
                n += pg_body_inside (c->body, x, tolerance) != 0;
            }
    return n;
}

pg_status cloud_divide (pg_box **boxes, const pg_lattice *l, const pg_body *body, int size)
{
    pg_status status = PG_OK;
    counting c = { l, body };
    pg_box whole = {{0, 0, 0}, {1, 1, 1}};
    PG_ALLOC (*boxes, (size_t) size);
    for (int k = 0; k < 3; k++) whole.high[k] = l->count[k];
    PG_TRY (pg_boxes_divide (*boxes, &whole, l->step, size, count_plane, &c));
done:
    return status;
}

pg_box cloud_cells_held (const pg_box *cells, const pg_lattice *l, double width, int centred)
{
    pg_lattice as_whole = *l;
    memcpy (as_whole.whole, l->count, sizeof as_whole.whole);
    memcpy (as_whole.whole_origin, l->origin, sizeof l->origin);
    memcpy (as_whole.whole_high, l->high, sizeof l->high);
    pg_box held = widened (sites_of (cells, &as_whole, centred), &as_whole, centred, width);
    /* the cells around these sites: of vertex v those from v - 1 to v, of a centre its neighbours too */
    for (int k = 0; k < l->dim; k++) {
        held.low[k] = held.low[k] > 0 ? held.low[k] - 1 : 0;
        held.high[k] = held.high[k] + centred < l->count[k] ? held.high[k] + centred : l->count[k];
    }
    return held;
}

/* Index of the cell around x along an axis; positions beyond the lattice get the one at its end. */
static int cell_at (const pg_lattice *l, int k, double x)
{
    int part = l->whole[0] > 0;
    double i = floor ((x - (part ? l->whole_origin : l->origin)[k]) / l->step[k]);
    return (int) fmin (fmax (i, 0), (part ? l->whole : l->count)[k] - 1);
}

int pg_lattice_owns (const pg_lattice *l, const pg_subdomain *d, const double *x)
{
    for (int k = 0; d && k < l->dim; k++) {
        int i = cell_at (l, k, x[k]);
        if (i < d->own.low[k] || i >= d->own.high[k]) return 0;
    }
    return 1;
}

int64_t pg_lattice_cell (const pg_lattice *l, const double *x)
{
    int64_t number = 0;
    for (int k = l->dim - 1; k >= 0; k--)
        number = number * (l->whole[0] > 0 ? l->whole : l->count)[k] + cell_at (l, k, x[k]);
    return number;
}

/* One layer of cells is added to `width` (m), as cell i has the sites i and i + 1 at its ends, or site i in
 * its middle. */
pg_box pg_subdomain_cells (const pg_subdomain *d, const pg_lattice *l, double width)
{
    pg_box out = d->own;
    for (int k = 0; k < l->dim; k++) {
        int more = 1 + (int) fmin (ceil (width / l->step[k] + 1e-6), 1e9);
        out.low[k] -= more, out.high[k] += more;
    }
    return out;
}

/* ---- sites of the lattice ------------------------------------------------------------------------------ */
/* Indices of a site in the whole lattice. */
static void place_of (const sites *s, const pg_lattice *l, size_t i, int *at)
{
    for (int k = 0; k < 3; i /= s->size[k++]) at[k] = (int) (i % s->size[k]) + (k < l->dim ? l->first[k] : 0);
}

static int within (const pg_box *b, const int *at)
{
    for (int k = 0; k < 3; k++) if (at[k] < b->low[k] || at[k] >= b->high[k]) return 0;
    return 1;
}

int64_t cloud_site_number (const sites *s, const pg_lattice *l, size_t i)
{
    int at[3], centred = s->shift > 0;
    place_of (s, l, i, at);
    return ((int64_t) at[2] * sites_along (l, 1, centred) + at[1]) * sites_along (l, 0, centred) + at[0];
}

/* ---- exchange of ghosts (halo) ------------------------------------------------------------------------- */
/* The sites of two boxes in common; 0: none. */
static int common (pg_box *out, const pg_box *a, const pg_box *b)
{
    for (int k = 0; k < 3; k++) {
        out->low[k] = a->low[k] > b->low[k] ? a->low[k] : b->low[k];
        out->high[k] = a->high[k] < b->high[k] ? a->high[k] : b->high[k];
        if (out->low[k] >= out->high[k]) return 0;
    }
    return 1;
}

typedef struct { int *list; size_t n, capacity; } numbers;

/* Appends the points of a box, in the order of the lattice. at: point of each site, -1: none. */
static pg_status take (numbers *out, const pg_box *b, const sites *s, const pg_lattice *l, const int *at)
{
    pg_status status = PG_OK;
    int i[3], first[3] = { 0, 0, 0 };
    for (int k = 0; k < l->dim; k++) first[k] = l->first[k];
    for (i[2] = b->low[2]; i[2] < b->high[2]; i[2]++)
        for (i[1] = b->low[1]; i[1] < b->high[1]; i[1]++)
            for (i[0] = b->low[0]; i[0] < b->high[0]; i[0]++) {
                size_t site = ((size_t) (i[2] - first[2]) * s->size[1] + (size_t) (i[1] - first[1]))
                              * s->size[0] + (size_t) (i[0] - first[0]);
                if (at[site] < 0) continue;
                PG_GROW (out->list, out->capacity, out->n + 1);
                out->list[out->n++] = at[site];
            }
done:
    return status;
}

/* Lists, for every other rank, what is received (points of its box within this rank's layer of ghosts) and
 * what is sent (points of this rank's box within its layer). */
static pg_status make_halo (pg_subdomain *d, const sites *s, const pg_lattice *l, const pg_box *boxes,
                            int rank, int size, const int *at)
{
    pg_status status = PG_OK;
    int centred = s->shift > 0;
    numbers send = { 0 }, receive = { 0 };
    pg_halo *h = &d->halo;
    PG_ALLOC (h->rank, (size_t) size);
    PG_ALLOC (h->send_first, (size_t) size + 1);
    PG_ALLOC (h->receive_first, (size_t) size + 1);
    for (int r = 0; r < size; r++) {
        if (r == rank) continue;
        pg_box own = sites_of (&boxes[r], l, centred), held = widened (own, l, centred, d->width), both;
        if (common (&both, &d->own, &held)) PG_TRY (take (&send, &both, s, l, at));
        if (common (&both, &d->held, &own)) PG_TRY (take (&receive, &both, s, l, at));
        if (send.n == h->send_first[h->n] && receive.n == h->receive_first[h->n]) continue;
        h->rank[h->n++] = r;
        h->send_first[h->n] = send.n, h->receive_first[h->n] = receive.n;
    }
    h->send = send.list, h->receive = receive.list;
    send.list = receive.list = NULL;
done:
    pg_free (send.list), pg_free (receive.list);
    return status;
}

pg_status cloud_subdomain (pg_subdomain **out, const sites *s, const pg_lattice *l, const pg_box *boxes,
                           double width, int rank, int size)
{
    pg_status status = PG_OK;
    pg_subdomain *d = NULL;
    int *at = NULL, place[3], centred = s->shift > 0;
    size_t n = 0;
    PG_ALLOC (d, 1);
    PG_ALLOC (at, s->n);
    d->width = width;
    d->own = sites_of (&boxes[rank], l, centred);
    d->held = widened (d->own, l, centred, width);
    for (size_t i = 0; i < s->n; i++) d->n += s->around[i] != 0;
    PG_ALLOC (d->owned, d->n);
    PG_ALLOC (d->number, d->n);
    for (size_t i = 0; i < s->n; i++) {
        at[i] = s->around[i] ? (int) n : -1;
        if (at[i] < 0) continue;
        place_of (s, l, i, place);
        d->owned[n] = (unsigned char) within (&d->own, place);
        d->nowned += d->owned[n];
        d->number[n++] = cloud_site_number (s, l, i);
    }
    PG_TRY (make_halo (d, s, l, boxes, rank, size, at));
    *out = d;
    d = NULL;
done:
    pg_free (at);
    pg_subdomain_free (&d);
    return status;
}

/* Refuses ranks without points, which would wait for the others in every step and have nothing to do. */
pg_status cloud_count_owned (double total, int empty, int size)
{
    if (!empty) return PG_OK;
    return pg_error (PG_E_LIMIT, PG_HERE, "a rank would have no point: the body has %.0f, take fewer ranks "
                     "than %d", total, size);
}

pg_status pg_cloud_has_nearest (const pg_cloud *c, const double *place, signed char *here)
{
    pg_status status = PG_OK;
    size_t dim = (size_t) c->dim;
    double best = INFINITY;
    if (!c->subdomain) *here = 1;
    if (*here >= 0) return PG_OK;
    for (size_t i = 0; i < c->n; i++) {
        double sum = 0;
        for (size_t k = 0; k < dim; k++) {
            double way = c->x[i * dim + k] - place[k];
            sum += way * way;
        }
        if (c->subdomain->owned[i] && sum < best) best = sum;
    }
    double least = -best, rank = -DBL_MAX;
    PG_TRY (pg_ranks_most (1, &least));
    if (best == -least) rank = -(double) pg_rank ();
    PG_TRY (pg_ranks_most (1, &rank));
    *here = (int) -rank == pg_rank ();
done:
    return status;
}
