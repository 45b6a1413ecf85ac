/* SPDX-License-Identifier: GPL-3.0-or-later
 * Coarse functions over the nodes of any cloud: multilinear functions on a grid, split where cracks run
 * through (multilevel_space.c), for coarse spaces whose matrix the caller assembles. */
#include "multilevel.h"
#include <math.h>
#include <string.h>

void pg_hats_clear (pg_hats *h)
{
    pg_free (h->function), pg_free (h->value), pg_free (h->place);
    pg_free (h->first), pg_free (h->member), pg_free (h->share);
    pg_free (h->cell_first), pg_free (h->cell_node);
    memset (h, 0, sizeof *h);
}

/* Computes the positions of the functions: the vertices of the grid at which they are 1. */
static pg_status find_places (pg_hats *h, const level *l)
{
    pg_status status = PG_OK;
    size_t dim = (size_t) l->dim;
    int at[3] = { 0 };
    PG_ALLOC (h->place, h->count * dim);
    for (size_t v = 0; v < l->grid.nvertex; v++) {
        level_vertex_place (l, v, at);
        for (size_t f = l->coarse.first[v]; f < l->coarse.first[v + 1]; f++)
            for (size_t k = 0; k < dim; k++) h->place[f * dim + k] = l->grid.low[k] + at[k] * l->grid.step[k];
    }
done:
    return status;
}

/* Builds grid and functions as for a level of the multilevel preconditioner; of couplings only nodes are
 * read. */
pg_status pg_hats_create (pg_hats *out, const pg_hats_setting *s)
{
    pg_status status = PG_OK;
    level l = { .dim = s->dim, .block = 1, .threads = s->threads > 1 ? s->threads : 1, .n = s->n, .x = s->x,
                .rows = s->rows };
    memset (out, 0, sizeof *out);
    PG_ALLOC (l.mask, l.n);
    PG_TRY (level_space (&l, s->step));
    *out = (pg_hats) { .n = l.n, .count = l.grid.nfunction, .ncell = l.grid.ncell, .corners = l.corners,
                       .threads = l.threads };
    PG_TRY (find_places (out, &l));
    out->function = l.coarse.function, out->value = l.coarse.weight, out->first = l.coarse.at,
    out->member = l.coarse.member, out->share = l.coarse.share, out->cell_first = l.coarse.cell_start,
    out->cell_node = l.coarse.cell_node;
    l.coarse.function = NULL, l.coarse.weight = NULL, l.coarse.at = NULL, l.coarse.member = NULL,
    l.coarse.share = NULL, l.coarse.cell_start = NULL, l.coarse.cell_node = NULL;
done:
    pg_free (l.mask), pg_free (l.coarse.cell), pg_free (l.coarse.first), pg_free (l.coarse.function),
        pg_free (l.coarse.weight);
    pg_free (l.coarse.at), pg_free (l.coarse.member), pg_free (l.coarse.share), pg_free (l.coarse.cell_start),
        pg_free (l.coarse.cell_node);
    if (status != PG_OK) pg_hats_clear (out);
    return status;
}

/* ---- transfers ----------------------------------------------------------------------------------------- */
typedef struct { const pg_hats *h; size_t block; const double *x; double *y; } transfer;

/* y = H' x: each function sums over its nodes, in their order. */
static void collect (void *context, size_t first, size_t last, int thread)
{
    (void) thread;
    const transfer *t = context;
    for (size_t f = first; f < last; f++)
        for (size_t k = 0; k < t->block; k++) {
            double s = 0;
            for (size_t e = t->h->first[f]; e < t->h->first[f + 1]; e++)
                s += (double) t->h->share[e] * t->x[(size_t) t->h->member[e] * t->block + k];
            t->y[f * t->block + k] = s;
        }
}

void pg_hats_restrict (const pg_hats *h, int block, const double *x, double *y)
{
    transfer t = { h, (size_t) block, x, y };
    pg_parallel (h->threads, h->count, collect, &t);
}

/* y += H x: each node adds the functions at the corners of its cell. */
static void spread (void *context, size_t first, size_t last, int thread)
{
    (void) thread;
    const transfer *t = context;
    size_t corners = (size_t) t->h->corners;
    for (size_t i = first; i < last; i++)
        for (size_t c = i * corners; c < (i + 1) * corners; c++) {
            if (t->h->function[c] < 0) continue;
            const double *x = t->x + (size_t) t->h->function[c] * t->block;
            for (size_t k = 0; k < t->block; k++) t->y[i * t->block + k] += (double) t->h->value[c] * x[k];
        }
}

void pg_hats_add (const pg_hats *h, int block, const double *x, double *y)
{
    transfer t = { h, (size_t) block, x, y };
    pg_parallel (h->threads, h->n, spread, &t);
}
