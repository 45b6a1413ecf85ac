/* SPDX-License-Identifier: GPL-3.0-or-later
 * Small cells lean on a neighbour: a cut cell of next to no volume, whose derivatives the divergence identity
 * would make as large as its size is small, keeps its direct derivatives, and the identity of its host is
 * that of both (cell aggregation: Badia, Verdugo, Martin 2018, doi 10.1016/j.cma.2018.03.022). The host is
 * the cell beyond its largest inner face, or the host of that if it is small as well. */
#include "consistent.h"
#include <math.h>
#include <string.h>

/* Share of the volume of a whole cell below which a cut cell is small. */
static const double SMALL = 0.1;
/* Hosts of small cells among small cells are sought so many times over. */
enum { PASSES = 4 };

static int is_small (const pg_cells *c, size_t cell)
{
    double whole = c->dim == 3 ? 1 : c->thickness;
    if (c->kind[cell] != PG_CUT || c->dim == 1) return 0;
    for (int k = 0; k < c->dim; k++) {
        double low = INFINITY, high = -INFINITY;
        for (size_t i = c->start[cell]; i < c->start[cell + 1]; i++) {
            double x = c->x[i * (size_t) c->dim + (size_t) k];
            low = fmin (low, x), high = fmax (high, x);
        }
        whole *= high - low;
    }
    return c->volume[cell] < SMALL * whole;
}

static double area_of (const pg_faces *f, size_t face)
{
    double sum = 0;
    for (size_t q = f->start[face]; q < f->start[face + 1]; q++) {
        double square = 0;
        for (int k = 0; k < f->dim; k++) square += pow (f->flux[q * (size_t) f->dim + (size_t) k], 2);
        sum += sqrt (square);
    }
    return sum;
}

/* The host of a small cell beyond its largest inner face to a cell that is not small or has a host (so far:
 * before this pass); -1: there is none. */
static int host_of (const pg_consistency *c, size_t cell, const unsigned char *small, const int *so_far)
{
    const pg_faces *f = &c->faces;
    double most = 0;
    int host = -1;
    for (size_t k = f->of[cell]; k < f->of[cell + 1]; k++) {
        size_t face = (size_t) f->face[k];
        int other = f->cell[2 * face] == (int) cell ? f->cell[2 * face + 1] : f->cell[2 * face];
        if (other < 0 || c->first[other] == c->first[other + 1]) continue;
        if (small[other] && so_far[other] < 0) continue;
        double area = area_of (f, face);
        if (!(area > most)) continue;
        most = area, host = small[other] ? so_far[other] : other;
    }
    return host;
}

/* Compressed rows of pairs (from -> to), in the order of `from`, ascending in `to` if they come so. */
static pg_status gather (pg_family *out, size_t n, size_t npair, const int *pair)
{
    pg_status status = PG_OK;
    size_t *next = NULL;
    out->n = n;
    PG_ALLOC (out->start, n + 1);
    PG_ALLOC (out->node, npair);
    PG_ALLOC (next, n);
    for (size_t k = 0; k < npair; k++) out->start[pair[2*k] + 1]++;
    for (size_t i = 0; i < n; i++) out->start[i + 1] += out->start[i], next[i] = out->start[i];
    for (size_t k = 0; k < npair; k++) out->node[next[pair[2*k]]++] = pair[2*k + 1];
done:
    pg_free (next);
    return status;
}

static pg_status find_hosts (pg_consistency *c)
{
    pg_status status = PG_OK;
    size_t n = c->cells->n, count = 0;
    unsigned char *small = NULL;
    int *before = NULL, *pair = NULL;
    PG_ALLOC (c->host, n);
    PG_ALLOC (small, n);
    PG_ALLOC (before, n);
    for (size_t cell = 0; cell < n; cell++)
        small[cell] = (unsigned char) is_small (c->cells, cell), c->host[cell] = -1;
    for (int pass = 0; pass < PASSES; pass++) {
        memcpy (before, c->host, n * sizeof *before);
        for (size_t cell = 0; cell < n; cell++)
            if (small[cell] && before[cell] < 0) c->host[cell] = host_of (c, cell, small, before);
    }
    PG_ALLOC (pair, 2 * n);
    for (size_t cell = 0; cell < n; cell++)
        if (c->host[cell] >= 0) pair[2 * count] = c->host[cell], pair[2 * count++ + 1] = (int) cell;
    PG_TRY (gather (&c->guests, n, count, pair));
done:
    pg_free (small), pg_free (before), pg_free (pair);
    return status;
}

/* The cells that must be complete for a cell to be whole: it, those beside it, and the same of its guests;
 * and the other way round. */
static pg_status find_needs (pg_consistency *c)
{
    pg_status status = PG_OK;
    const pg_faces *f = &c->faces;
    size_t n = c->cells->n, count = 0, cap = 0, *seen = NULL;
    int *pair = NULL;
    PG_ALLOC (seen, n);
    for (size_t cell = 0; cell < n; cell++)
        for (size_t g = c->guests.start[cell]; g <= c->guests.start[cell + 1]; g++) {
            size_t of = g < c->guests.start[cell + 1] ? (size_t) c->guests.node[g] : cell;
            for (size_t k = f->of[of]; k <= f->of[of + 1]; k++)
                for (int side = 0; side < 2; side++) {
                    int beside = k < f->of[of + 1] ? f->cell[2 * f->face[k] + side] : (int) of;
                    if (beside < 0 || seen[beside] == cell + 1) continue;
                    seen[beside] = cell + 1;
                    PG_GROW (pair, cap, 2 * (count + 1));
                    pair[2 * count] = (int) cell, pair[2 * count++ + 1] = beside;
                }
        }
    PG_TRY (gather (&c->needs, n, count, pair));
    for (size_t k = 0; k < count; k++) {
        int t = pair[2*k];
        pair[2*k] = pair[2*k + 1], pair[2*k + 1] = t;
    }
    PG_TRY (gather (&c->opens, n, count, pair));
done:
    pg_free (seen), pg_free (pair);
    return status;
}

pg_status consistent_hosts (pg_consistency *c)
{
    pg_status status = PG_OK;
    PG_TRY (find_hosts (c));
    PG_TRY (find_needs (c));
done:
    return status;
}
