/* SPDX-License-Identifier: GPL-3.0-or-later
 * Which points see which nodes, in blocks: of nodal values that are zero in most of the body, or have changed
 * in a small part of it only, most points need not be looked at. Blocks are numbers that follow each other,
 * so that no geometry is asked for: of nodes NODES, of points GALERKIN_BLOCK. The table is of the families,
 * dead bonds and all, and holds for a whole run. */
#include "galerkin.h"
#include <string.h>

enum { NODES = 2, POINTS = GALERKIN_BLOCK };

/* Block b of points sees the blocks of nodes seen[start[b]] .. seen[start[b + 1] - 1]. */
struct galerkin_sight {
    size_t  n, *start;                                 /* blocks of points */
    int    *seen;
    unsigned char *node, *active;                      /* scratch: marks of blocks */
};

static size_t blocks_of (size_t n, size_t size) { return (n + size - 1) / size; }

static void free_one (galerkin_sight *s)
{
    if (!s) return;
    pg_free (s->start), pg_free (s->seen), pg_free (s->node), pg_free (s->active);
    pg_free (s);
}

void galerkin_sight_free (galerkin *g)
{
    for (int set = 0; set < PG_BOND_SETS; set++) free_one (g->sight[set]), g->sight[set] = NULL;
}

/* The blocks of nodes that a block of points sees, appended to the table; mark: zeros before and after. */
static pg_status list_seen (galerkin_sight *s, const pg_family *f, size_t b, size_t *room,
                            unsigned char *mark)
{
    pg_status status = PG_OK;
    size_t last = (b + 1) * POINTS < f->n ? (b + 1) * POINTS : f->n, at = s->start[b];
    for (size_t e = f->start[b * POINTS]; e < f->start[last]; e++) {
        int block = f->node[e] / NODES;
        if (mark[block]) continue;
        mark[block] = 1;
        PG_GROW (s->seen, *room, at + 1);
        s->seen[at++] = block;
    }
    for (size_t k = s->start[b]; k < at; k++) mark[s->seen[k]] = 0;
    s->start[b + 1] = at;
done:
    return status;
}

static pg_status create (galerkin *g, int set)
{
    pg_status status = PG_OK;
    const pg_family *f = set == g->bulk ? &g->sums.family : &g->rows[set].family;
    galerkin_sight *s = NULL;
    size_t room = 0;
    PG_ALLOC (s, 1);
    s->n = blocks_of (f->n, POINTS);
    PG_ALLOC (s->start, s->n + 1);
    PG_ALLOC (s->active, s->n);
    PG_ALLOC (s->node, blocks_of (g->n, NODES));
    for (size_t b = 0; b < s->n; b++) PG_TRY (list_seen (s, f, b, &room, s->node));
    g->sight[set] = s, s = NULL;
done:
    if (s) free_one (s);
    return status;
}

/* Before the first measure of a set all of it is new: it needs no table yet. */
pg_status galerkin_sight_ready (galerkin *g, int products)
{
    pg_status status = PG_OK;
    if (g->problem->plain || g->dilatation) return PG_OK;
    for (int set = 0; set < PG_BOND_SETS; set++)
        if ((g->fresh[set] || (products && set == g->bulk)) && !g->sight[set]) PG_TRY (create (g, set));
done:
    return status;
}

/* Marks blocks of nodes whose values differ from those of `other` (NULL: from zero). Returns how many. */
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
    galerkin_sight *s = g->sight[set];
    if (!s || !s->seen) return NULL;
    /* where much has changed all is looked at */
    if (2 * mark_nodes (g, x, other, s->node) > blocks_of (g->n, NODES)) return NULL;
    for (size_t b = 0; b < s->n; b++) {
        unsigned char active = 0;
        for (size_t k = s->start[b]; k < s->start[b + 1] && !active; k++) active = s->node[s->seen[k]];
        s->active[b] = active;
    }
    return s->active;
}
