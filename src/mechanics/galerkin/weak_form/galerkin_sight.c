/* SPDX-License-Identifier: GPL-3.0-or-later
 * Table of the points that have a node in their families, in blocks: where nodal values are zero in most of
 * the body, or have changed in a small part of it only, most points can be skipped. Blocks are consecutive
 * numbers (NODES nodes, GALERKIN_BLOCK points), so that no geometry is needed. The table includes broken
 * bonds and is valid for the whole run. */
#include "galerkin.h"
#include <string.h>

enum { NODES = 2, POINTS = GALERKIN_BLOCK };

/* Block b of nodes is in the families of the blocks of points sees[start[b]] .. sees[start[b + 1] - 1], of
 * n. */
struct galerkin_sight {
    size_t  n, nodes, *start;                          /* nodes: number of blocks of nodes */
    int    *sees;
    /* scratch: 1 for each block of nodes with (changed) values, and for each block of points that depends on
     * one */
    unsigned char *node, *active;
};

static size_t blocks_of (size_t n, size_t size) { return (n + size - 1) / size; }

static void free_one (galerkin_sight *s)
{
    if (!s) return;
    pg_free (s->start), pg_free (s->sees), pg_free (s->node), pg_free (s->active);
    pg_free (s);
}

void galerkin_sight_free (galerkin *g)
{
    for (int set = 0; set < PG_BOND_SETS; set++) free_one (g->measured.sight[set]),
        g->measured.sight[set] = NULL;
}

/* Visits the pairs of blocks joined by bonds, in the order of the blocks of points: counts them in start[b +
 * 1] of the block of nodes (sees NULL), or enters them from start[b] on, which is advanced. last: number + 1
 * of the last block of points visited for every block of nodes. */
static void visit_pairs (galerkin_sight *s, const pg_family *f, size_t *last, int *sees)
{
    memset (last, 0, s->nodes * sizeof *last);
    for (size_t b = 0; b < s->n; b++) {
        size_t end = (b + 1) * POINTS < f->n ? (b + 1) * POINTS : f->n;
        for (size_t e = f->start[b * POINTS]; e < f->start[end]; e++) {
            size_t node = (size_t) f->node[e] / NODES;
            if (last[node] == b + 1) continue;
            last[node] = b + 1;
            if (sees) sees[s->start[node]++] = (int) b;
            else s->start[node + 1]++;
        }
    }
}

static pg_status create (galerkin *g, int set)
{
    pg_status status = PG_OK;
    const pg_family *f = set == g->bulk ? &g->sums.family : &g->rows[set].family;
    galerkin_sight *s = NULL;
    size_t *last = NULL;
    PG_ALLOC (s, 1);
    s->n = blocks_of (f->n, POINTS), s->nodes = blocks_of (g->n, NODES);
    PG_ALLOC (s->start, s->nodes + 1);
    PG_ALLOC (s->active, s->n);
    PG_ALLOC (s->node, s->nodes);
    PG_ALLOC (last, s->nodes);
    visit_pairs (s, f, last, NULL);
    for (size_t b = 0; b < s->nodes; b++) s->start[b + 1] += s->start[b];
    PG_ALLOC (s->sees, s->start[s->nodes]);
    visit_pairs (s, f, last, s->sees);
    for (size_t b = s->nodes; b > 0; b--) s->start[b] = s->start[b - 1];
    s->start[0] = 0;
    g->measured.sight[set] = s, s = NULL;
done:
    pg_free (last);
    if (s) free_one (s);
    return status;
}

/* Makes the tables that are missing. Before its first measure a set needs none, as all its points are new. */
pg_status galerkin_sight_ready (galerkin *g, int products)
{
    pg_status status = PG_OK;
    if (g->problem->plain || g->dilatation) return PG_OK;
    for (int set = 0; set < PG_BOND_SETS; set++)
        if ((g->measured.fresh[set] || (products && set == g->bulk)) && !g->measured.sight[set])
            PG_TRY (create (g, set));
done:
    return status;
}

/* Marks blocks of nodes where x differs from `other` (NULL: from zero). Returns how many. */
static size_t mark_nodes (const galerkin *g, const double *x, const double *other, unsigned char *mark)
{
    size_t marked = 0, width = NODES * (size_t) g->dim, ndof = g->n * (size_t) g->dim;
    for (size_t first = 0, b = 0; first < ndof; first += width, b++) {
        size_t last = first + width < ndof ? first + width : ndof;
        int differs = 0;
        for (size_t i = first; i < last; i++) differs |= x[i] != (other ? other[i] : 0);
        mark[b] = (unsigned char) differs;
        marked += (size_t) differs;
    }
    return marked;
}

unsigned char *galerkin_active (galerkin *g, int set, const double *x, const double *other)
{
    galerkin_sight *s = g->measured.sight[set];
    if (!s || !s->sees) return NULL;
    /* where more than half has changed no block is skipped */
    if (2 * mark_nodes (g, x, other, s->node) > s->nodes) return NULL;
    memset (s->active, 0, s->n);
    for (size_t b = 0; b < s->nodes; b++)
        for (size_t k = s->start[b]; s->node[b] && k < s->start[b + 1]; k++) s->active[s->sees[k]] = 1;
    return s->active;
}
