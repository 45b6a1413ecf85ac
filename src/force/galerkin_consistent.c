/* SPDX-License-Identifier: GPL-3.0-or-later
 * Rows of the evaluation points for the sums over them. With consistent integration the derivatives of a cell
 * obey the divergence identity as long as no bond of its points, or of the points of a cell beside it, is
 * broken; after that they are the direct ones of its live bonds. */
#include "galerkin.h"
#include <stdlib.h>
#include <string.h>

/* Rows of the evaluation points for all sums: those of the shape functions themselves or, with consistent
 * integration, copies with derivatives of their own. */
pg_status galerkin_consistent_create (galerkin *g)
{
    pg_status status = PG_OK;
    const pg_consistency *c = g->problem->consistency;
    g->sums = g->rows[g->bulk];
    if (!c) return PG_OK;
    size_t nnz = c->family.start[c->family.n];
    g->sums.family = c->family;
    g->sums.N = g->sums.dN = g->sums.w = NULL;
    PG_ALLOC (g->whole, c->cells->n);
    if (galerkin_borrow_sums (g)) return PG_OK;
    PG_ALLOC (g->sums.N, nnz);
    PG_ALLOC (g->sums.dN, nnz * (size_t) g->dim);
done:
    return status;
}

/* What is borrowed from the shape functions is not freed here. */
void galerkin_consistent_free (galerkin *g)
{
    if (g->problem->consistency && !g->borrows[g->bulk]) pg_free (g->sums.N), pg_free (g->sums.dN);
    pg_free (g->whole);
}

/* Live bonds alone, and linear fields reproduced at all points of the cell and of its faces? Else the
 * identity would spoil what it corrects. */
static int bonds_complete (const galerkin *g, const pg_state *state, size_t cell)
{
    const pg_consistency *c = g->problem->consistency;
    for (size_t p = c->first[cell]; p < c->first[cell + 1]; p++)
        if (g->rows[g->bulk].grade[p] > PG_GRADE_LOWERED) return 0;
    for (size_t k = c->faces.of[cell]; k < c->faces.of[cell + 1]; k++) {
        size_t face = (size_t) c->faces.face[k];
        for (size_t q = c->faces.start[face]; q < c->faces.start[face + 1]; q++)
            if (c->face.grade[q] > PG_GRADE_LOWERED) return 0;
    }
    const size_t *start = g->rows[g->bulk].family.start;
    const unsigned char *alive = state->alive + g->problem->first_bond[g->bulk];
    for (size_t e = start[c->first[cell]]; e < start[c->first[cell + 1]]; e++) if (!alive[e]) return 0;
    return 1;
}

/* The cell and those beside it are no longer whole. */
static void open_around (galerkin *g, size_t cell)
{
    const pg_faces *f = &g->problem->consistency->faces;
    for (size_t k = f->of[cell]; k < f->of[cell + 1]; k++)
        for (int side = 0; side < 2; side++) {
            int beside = f->cell[2 * f->face[k] + side];
            if (beside >= 0) g->whole[beside] = 0;
        }
}

/* Are the cell and all beside it complete? */
static int complete_around (const galerkin *g, const pg_state *state, size_t cell)
{
    const pg_faces *f = &g->problem->consistency->faces;
    for (size_t k = f->of[cell]; k < f->of[cell + 1]; k++)
        for (int side = 0; side < 2; side++) {
            int beside = f->cell[2 * f->face[k] + side];
            if (beside >= 0 && !bonds_complete (g, state, (size_t) beside)) return 0;
        }
    return 1;
}

/* The cell has changed: it and those beside it are whole, or no longer whole, by the bonds that live now
 * (those of a trial live again afterwards). Those that change are appended to list. */
static size_t judge_around (galerkin *g, const pg_state *state, size_t cell, size_t *list, size_t n)
{
    const pg_faces *f = &g->problem->consistency->faces;
    for (size_t k = f->of[cell]; k < f->of[cell + 1]; k++)
        for (int side = 0; side < 2; side++) {
            int beside = f->cell[2 * f->face[k] + side];
            if (beside < 0) continue;
            int now = complete_around (g, state, (size_t) beside);
            if (now == g->whole[beside]) continue;
            g->whole[beside] = (unsigned char) now;
            list[n++] = (size_t) beside;
        }
    return n;
}

/* For qsort. */
static int compare (const void *a, const void *b)
{
    size_t i = *(const size_t *) a, j = *(const size_t *) b;
    return (i > j) - (i < j);
}

/* Cells of the touched points and those that change with them, each once, ascending. */
static pg_status changed_cells (galerkin *g, const pg_state *state, size_t count, size_t **out, size_t *n)
{
    pg_status status = PG_OK;
    const pg_rows *r = &g->rows[g->bulk];
    size_t *list = NULL, most = g->problem->consistency->cells->n, kept = 0;
    PG_ALLOC (list, count + most);
    *n = 0;
    for (size_t k = 0; k < count; k++) {
        size_t cell = (size_t) r->cell[g->list[g->bulk][k]];
        *n = judge_around (g, state, cell, list, *n);
        list[(*n)++] = cell;
    }
    qsort (list, *n, sizeof *list, compare);
    for (size_t k = 0; k < *n; k++) if (k == 0 || list[k] != list[k - 1]) list[kept++] = list[k];
    *n = kept, *out = list;
done:
    return status;
}

/* all: from scratch; else the cells of the *count points in g->list, which is replaced by all points
 * whose rows have changed. */
pg_status galerkin_consistent_update (galerkin *g, const pg_state *state, int all, size_t *count)
{
    pg_status status = PG_OK;
    const pg_consistency *c = g->problem->consistency;
    const pg_rows *r = &g->rows[g->bulk];
    size_t *cells = NULL, n = 0;
    if (all) {
        memset (g->whole, 1, c->cells->n);
        for (size_t cell = 0; cell < c->cells->n; cell++)
            if (!bonds_complete (g, state, cell)) open_around (g, cell);
        if (g->borrows[g->bulk]) return PG_OK;
        PG_TRY (pg_consistency_apply (c, r, &g->sums, g->whole, 0, NULL, g->threads));
        return PG_OK;
    }
    if (*count == 0) return PG_OK;
    PG_TRY (changed_cells (g, state, *count, &cells, &n));
    PG_TRY (galerkin_change_cells (g, n, cells, -1));
    PG_TRY (pg_consistency_apply (c, r, &g->sums, g->whole, n, cells, g->threads));
    PG_TRY (galerkin_change_cells (g, n, cells, 1));
    *count = 0;
    for (size_t k = 0; k < n; k++)
        for (size_t p = c->first[cells[k]]; p < c->first[cells[k] + 1]; p++) g->list[g->bulk][(*count)++] = p;
done:
    pg_free (cells);
    return status;
}
