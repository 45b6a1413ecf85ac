/* SPDX-License-Identifier: GPL-3.0-or-later
 * The change of K by breaking bonds. K is a sum over items: evaluation points (with consistent integration
 * cells), facet points under Nitsche's terms, nodes under a penalty, patches of the dilatation. The blocks
 * of an item that a refresh touches are subtracted before its rows are evaluated anew, and added afterwards;
 * the sum is a dense symmetric matrix on the few nodes in the families of the items. Nodes whose blocks in
 * an item are zero (bonds broken before) are left out. */
#include "galerkin.h"
#include <string.h>

enum { MOST_UNKNOWNS = 1500 };                         /* above that a new matrix is cheaper */

typedef void (*blocks) (void *context, size_t p, size_t a, size_t m, double *out);

struct galerkin_change {
    int     lost, basis, loads;              /* flags of pg_stiffness_change; lost: the change is not known */
    int     handed;                         /* the caller has read it: the next refresh begins a new record */
    size_t  n, cap;                                    /* number of nodes; number that K has room for */
    int    *node, *at;                           /* the nodes; position in K + 1 of every node of the cloud */
    size_t  room_node;
    double *K;  /* row-major, cap * dim numbers a row, N/m */
    double *item;  size_t room_item;                   /* blocks of one item (m x m x dim x dim) */
    int    *place;  size_t room_place;      /* position in K of the item's nodes; -1: their blocks are zero */
};

/* Frees the recorded change of K, if there is one. */
void galerkin_change_free (galerkin *g)
{
    galerkin_change *c = g->change;
    if (!c) return;
    pg_free (c->node), pg_free (c->at), pg_free (c->K), pg_free (c->item), pg_free (c->place);
    pg_free (c);
    g->change = NULL;
}

/* Clears the record: K has not changed yet. */
static void clear (galerkin *g)
{
    galerkin_change *c = g->change;
    size_t dim = (size_t) g->dim;
    for (size_t i = 0; i < c->n; i++) c->at[c->node[i]] = 0;
    for (size_t i = 0; i < c->n * dim; i++) memset (c->K + i * c->cap * dim, 0, c->n * dim * sizeof *c->K);
    c->n = 0;
    c->lost = c->basis = c->loads = c->handed = 0;
}

/* Makes room for `count` nodes in K, whose rows become longer. */
static pg_status grow (galerkin *g, size_t count)
{
    pg_status status = PG_OK;
    galerkin_change *c = g->change;
    size_t dim = (size_t) g->dim, cap = c->cap ? c->cap : 32;
    double *K = NULL;
    if (count <= c->cap) return PG_OK;
    while (cap < count) cap *= 2;
    PG_ALLOC (K, cap * dim * cap * dim);
    for (size_t i = 0; i < c->n * dim; i++)
        memcpy (K + i * cap * dim, c->K + i * c->cap * dim, c->n * dim * sizeof *K);
    PG_GROW (c->node, c->room_node, cap);
    pg_free (c->K);
    c->K = K, c->cap = cap, K = NULL;
done:
    pg_free (K);
    return status;
}

/* The position of a node in K, which is entered if it is new. */
static pg_status place_of (galerkin *g, int node, int *place)
{
    pg_status status = PG_OK;
    galerkin_change *c = g->change;
    if (!c->at[node]) {
        PG_TRY (grow (g, c->n + 1));
        c->node[c->n] = node;
        c->at[node] = (int) ++c->n;
    }
    *place = c->at[node] - 1;
done:
    return status;
}

/* Does any of the numbers in row a of the item's blocks differ from zero? K is symmetric, so that columns
 * need not be examined. */
static int moves (const double *row, size_t count)
{
    for (size_t k = 0; k < count; k++) if (row[k] != 0) return 1;
    return 0;
}

/* K += sign times the blocks of one item. */
static pg_status add_item (galerkin *g, const pg_family *f, blocks make, size_t p, double sign)
{
    pg_status status = PG_OK;
    galerkin_change *c = g->change;
    size_t dim = (size_t) g->dim, m = f->start[p + 1] - f->start[p], row = m * dim * dim;
    const int *node = f->node + f->start[p];
    if (c->lost) return PG_OK;
    PG_GROW (c->item, c->room_item, m * row);
    PG_GROW (c->place, c->room_place, m);
    memset (c->item, 0, m * row * sizeof *c->item);
    for (size_t a = 0; a < m; a++) {
        make (g, p, a, m, c->item + a * row);
        c->place[a] = -1;
        if (moves (c->item + a * row, row)) PG_TRY (place_of (g, node[a], &c->place[a]));
    }
    for (size_t a = 0; a < m; a++)
        for (size_t b = 0; b < m && c->place[a] >= 0; b++) {
            if (c->place[b] < 0) continue;
            const double *block = c->item + a * row + b * dim * dim;
            for (size_t r = 0; r < dim; r++) {
                double *to = c->K + ((size_t) c->place[a] * dim + r) * c->cap * dim
                             + (size_t) c->place[b] * dim;
                for (size_t s = 0; s < dim; s++) to[s] += sign * block[r * dim + s];
            }
        }
    if (c->n * dim > MOST_UNKNOWNS) c->lost = 1;
done:
    return status;
}

/* ---- during a refresh ---------------------------------------------------------------------------------- */
/* Begins the record of a refresh, before it evaluates anything; all: it concerns all bonds, so that the
 * change is not known. */
void galerkin_change_begin (galerkin *g, int all)
{
    galerkin_change *c = g->change;
    if (!c) return;
    if (c->handed) clear (g);
    c->lost |= all;
}

/* Records points of a set, about to be evaluated anew (sign -1) or just evaluated (1). With consistent
 * integration the bulk is recorded by cells: galerkin_change_cells. */
pg_status galerkin_change_points (galerkin *g, int set, size_t count, const size_t *list, double sign)
{
    pg_status status = PG_OK;
    if (!g->change || g->change->lost) return PG_OK;
    if (sign > 0 && galerkin_boundary_loaded (g, set, count, list)) g->change->loads = 1;
    for (size_t k = 0; k < count; k++) {
        if (set == g->bulk && !g->whole)
            PG_TRY (add_item (g, &g->sums.family, galerkin_bulk_blocks, list[k], sign));
        if (set == PG_FACETS && g->supports.nnitsche)
            PG_TRY (add_item (g, &g->rows[PG_FACETS].family, galerkin_facet_blocks, list[k], sign));
        long q = set == PG_NODES && g->supports.npenalty ? galerkin_penalty_of (g, list[k]) : -1;
        if (q >= 0) PG_TRY (add_item (g, &g->supports.penalty_family, galerkin_penalty_blocks, (size_t) q,
                                      sign));
    }
done:
    return status;
}

/* Records cells with consistent integration, about to be evaluated anew (sign -1) or just evaluated (1). */
pg_status galerkin_change_cells (galerkin *g, size_t count, const size_t *cell, double sign)
{
    pg_status status = PG_OK;
    if (!g->change) return PG_OK;
    for (size_t k = 0; k < count; k++)
        PG_TRY (
            add_item (g, &g->problem->form.consistency->cell_family, galerkin_cell_blocks, cell[k], sign));
done:
    return status;
}

/* Records a patch of the dilatation; at supported facets its flux is in the constant forces as well. */
pg_status galerkin_change_patch (galerkin *g, size_t patch, int supported, double sign)
{
    if (!g->change) return PG_OK;
    g->change->loads |= supported;
    return add_item (g, galerkin_dilatation_family (g), galerkin_dilatation_blocks, patch, sign);
}

/* Records that the elimination T has changed. */
void galerkin_change_basis (galerkin *g) { if (g->change) g->change->basis = 1; }

/* ---- handing out the change ---------------------------------------------------------------------------- */
/* Hands out the change of K since the last call (pg_force_type.change). The first call begins the record. */
pg_status galerkin_change_of (void *self, pg_stiffness_change *out)
{
    pg_status status = PG_OK;
    galerkin *g = self;
    int first = g->change == NULL;
    memset (out, 0, sizeof *out);
    if (first) {
        PG_ALLOC (g->change, 1);
        PG_ALLOC (g->change->at, g->n);
        g->change->lost = 1;
    }
    galerkin_change *c = g->change;
    if (c->handed) clear (g);
    *out = (pg_stiffness_change) { .known = !c->lost,
                                   .basis = c->basis,
                                   .loads = c->loads,
                                   .n = c->n,
                                   .width = c->cap * (size_t) g->dim,
                                   .node = c->node,
                                   .K = c->K };
    c->handed = 1;
done:
    return status;
}
