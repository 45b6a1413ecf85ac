/* SPDX-License-Identifier: GPL-3.0-or-later
 * Shape functions of the evaluation points for stiffness and force. With consistent integration the
 * derivatives of a cell obey the divergence identity as long as no bond of its points, or of the points of a
 * neighbouring cell, is broken; after that they are the uncorrected ones of its intact bonds. */
#include "galerkin.h"
#include <stdlib.h>
#include <string.h>

/* Creates g->sums: the rows of the shape functions themselves or, with consistent integration, copies with
 * derivatives of their own. */
pg_status galerkin_consistent_create (galerkin *g)
{
    pg_status status = PG_OK;
    const pg_consistency *c = g->problem->form.consistency;
    g->sums = g->rows[g->bulk];
    if (!c) return PG_OK;
    g->sums.family = c->family;
    g->sums.N = g->sums.dN = g->sums.w = NULL;
    g->sums.weight = NULL;
    PG_ALLOC (g->sums.weight, g->sums.n);
    memcpy (g->sums.weight, g->rows[g->bulk].weight, g->sums.n * sizeof *g->sums.weight);
    PG_ALLOC (g->whole, c->cells->n);
    PG_TRY (galerkin_ended_create (g));
    if (g->borrows)
        g->sums.N = g->problem->quality.intact->sums.N, g->sums.dN = g->problem->quality.intact->sums.dN;
done:
    return status;
}

/* Frees the rows, except those borrowed from the shape functions. */
void galerkin_consistent_free (galerkin *g)
{
    if (g->problem->form.consistency && !g->borrows) pg_free (g->sums.N), pg_free (g->sums.dN);
    if (g->problem->form.consistency) pg_free (g->sums.weight);
    galerkin_ended_free (g);
    pg_free (g->whole);
}

/* Are all bonds of the cell's points intact, and are linear fields reproduced at all points of the cell and
 * of its faces? Else the correction would make derivatives worse. */
static int bonds_complete (const galerkin *g, const pg_state *state, size_t cell)
{
    const pg_consistency *c = g->problem->form.consistency;
    const unsigned char *grade = galerkin_ended_faces (g)->grade;
    for (size_t p = c->first[cell]; p < c->first[cell + 1]; p++)
        if (g->rows[g->bulk].grade[p] > PG_GRADE_LOWERED) return 0;
    for (size_t k = c->faces.of[cell]; k < c->faces.of[cell + 1]; k++) {
        size_t face = (size_t) c->faces.face[k];
        for (size_t q = c->faces.start[face]; q < c->faces.start[face + 1]; q++)
            if (grade[q] > PG_GRADE_LOWERED) return 0;
    }
    const size_t *start = g->rows[g->bulk].family.start;
    const unsigned char *alive = state->alive + g->problem->bonds.first[g->bulk];
    for (size_t e = start[c->first[cell]]; e < start[c->first[cell + 1]]; e++) if (!alive[e]) return 0;
    return 1;
}

/* Marks the cells that need this cell complete (itself, its neighbours, hosts of these) as no longer
 * whole. */
static void open_around (galerkin *g, size_t cell)
{
    const pg_family *f = &g->problem->form.consistency->opens;
    for (size_t k = f->start[cell]; k < f->start[cell + 1]; k++) g->whole[f->node[k]] = 0;
}

/* Have all cells their bonds that this one needs for its derivatives to be corrected? */
static int complete_around (const galerkin *g, const pg_state *state, size_t cell)
{
    const pg_family *f = &g->problem->form.consistency->needs;
    for (size_t k = f->start[cell]; k < f->start[cell + 1]; k++)
        if (!bonds_complete (g, state, (size_t) f->node[k])) return 0;
    return 1;
}

/* After a change of the cell: decides by the present bonds whether it and the cells that need it are whole
 * (bonds broken in a trial step may be intact again). Appends those that change to list; returns its
 * length. */
static size_t judge_around (galerkin *g, const pg_state *state, size_t cell, size_t *list, size_t n)
{
    const pg_consistency *c = g->problem->form.consistency;
    for (size_t k = c->opens.start[cell]; k < c->opens.start[cell + 1]; k++) {
        size_t other = (size_t) c->opens.node[k];
        int now = complete_around (g, state, other);
        if (now == g->whole[other]) continue;
        g->whole[other] = (unsigned char) now;
        list[n++] = other;
    }
    return n;
}

/* For qsort: ascending. */
static int compare (const void *a, const void *b)
{
    size_t i = *(const size_t *) a, j = *(const size_t *) b;
    return (i > j) - (i < j);
}

/* Sorts numbers and removes duplicates; returns how many are left. */
static size_t unique (size_t *list, size_t n)
{
    size_t kept = 0;
    pg_sort (list, n, sizeof *list, compare);
    for (size_t k = 0; k < n; k++) if (kept == 0 || list[k] != list[kept - 1]) list[kept++] = list[k];
    return kept;
}

/* Lists the cells of the touched points, and those that change with them, each once, ascending. */
static pg_status changed_cells (galerkin *g, const pg_state *state, size_t count, size_t **out, size_t *n)
{
    pg_status status = PG_OK;
    const pg_rows *r = &g->rows[g->bulk];
    size_t *list = NULL, most = g->problem->form.consistency->cells->n;
    PG_ALLOC (list, count + most);
    *n = 0;
    for (size_t k = 0; k < count; k++) {
        size_t cell = (size_t) r->cell[g->list[g->bulk][k]];
        *n = judge_around (g, state, cell, list, *n);
        list[(*n)++] = cell;
    }
    *n = unique (list, *n), *out = list;
done:
    return status;
}

/* ---- cells that a change of bonds changes -------------------------------------------------------------- */
/* Copies of the values at the points of some cells, cell by cell; place (2 a cell): offsets of its bonds and
 * of its points. */
typedef struct { double *N, *dN, *weight; size_t *place; } kept_rows;

static void free_rows (kept_rows *k)
{
    pg_free (k->N), pg_free (k->dN), pg_free (k->weight), pg_free (k->place);
}

/* Number of bonds of a cell's points; *from: the first of them. */
static size_t bonds_of (const galerkin *g, size_t cell, size_t *from)
{
    const pg_consistency *c = g->problem->form.consistency;
    *from = c->family.start[c->first[cell]];
    return c->family.start[c->first[cell + 1]] - *from;
}

static pg_status keep_rows (const galerkin *g, size_t n, const size_t *cell, kept_rows *out)
{
    pg_status status = PG_OK;
    const pg_consistency *c = g->problem->form.consistency;
    size_t dim = (size_t) g->dim, bonds = 0, points = 0, from;
    PG_ALLOC (out->place, 2 * n);
    for (size_t k = 0; k < n; k++) {
        out->place[2*k] = bonds, out->place[2*k + 1] = points;
        bonds += bonds_of (g, cell[k], &from), points += c->first[cell[k] + 1] - c->first[cell[k]];
    }
    PG_ALLOC (out->N, bonds);
    PG_ALLOC (out->dN, bonds * dim);
    PG_ALLOC (out->weight, points);
    for (size_t k = 0; k < n; k++) {
        size_t m = bonds_of (g, cell[k], &from), first = c->first[cell[k]];
        memcpy (out->N + out->place[2*k], g->sums.N + from, m * sizeof *out->N);
        memcpy (out->dN + out->place[2*k] * dim, g->sums.dN + from * dim, m * dim * sizeof *out->dN);
        memcpy (out->weight + out->place[2*k + 1], g->sums.weight + first,
                (c->first[cell[k] + 1] - first) * sizeof *out->weight);
    }
done:
    return status;
}

/* Keeps in the list only cells whose values differ from the copies; returns how many. */
static size_t different (const galerkin *g, size_t n, size_t *cell, kept_rows *old)
{
    const pg_consistency *c = g->problem->form.consistency;
    size_t dim = (size_t) g->dim, kept = 0, from;
    for (size_t k = 0; k < n; k++) {
        size_t m = bonds_of (g, cell[k], &from), first = c->first[cell[k]], at = old->place[2*k];
        if (memcmp (old->N + at, g->sums.N + from, m * sizeof *old->N) == 0
            && memcmp (old->dN + at * dim, g->sums.dN + from * dim, m * dim * sizeof *old->dN) == 0
            && memcmp (old->weight + old->place[2*k + 1], g->sums.weight + first,
                       (c->first[cell[k] + 1] - first) * sizeof *old->weight) == 0) continue;
        cell[kept] = cell[k];
        old->place[2*kept] = at, old->place[2*kept + 1] = old->place[2*k + 1], kept++;
    }
    return kept;
}

static void swap (size_t n, double *a, double *b)
{
    for (size_t i = 0; i < n; i++) {
        double t = a[i];
        a[i] = b[i], b[i] = t;
    }
}

static void swap_rows (galerkin *g, size_t n, const size_t *cell, kept_rows *old)
{
    const pg_consistency *c = g->problem->form.consistency;
    size_t dim = (size_t) g->dim, from;
    for (size_t k = 0; k < n && g->change; k++) {
        size_t m = bonds_of (g, cell[k], &from), first = c->first[cell[k]], at = old->place[2*k];
        swap (m, old->N + at, g->sums.N + from);
        swap (m * dim, old->dN + at * dim, g->sums.dN + from * dim);
        swap (c->first[cell[k] + 1] - first, old->weight + old->place[2*k + 1], g->sums.weight + first);
    }
}

/* Adds to the list the cells near the former and the present cracks, if cracks have moved or bonds have
 * broken. */
static pg_status near_cells (galerkin *g, const pg_state *state, size_t **list, size_t *n)
{
    pg_status status = PG_OK;
    int moved;
    size_t *out = NULL, *changed = NULL, m = 0, before = galerkin_ended_near (g, NULL), count = *n;
    if (!g->ended) return PG_OK;
    PG_ALLOC (out, before);
    galerkin_ended_near (g, out);
    PG_TRY (galerkin_ended_plan (g, state, &moved));
    if (!moved && *n == 0) goto done;
    size_t now = galerkin_ended_near (g, NULL), cap = 0;
    PG_GROW (*list, cap, count + before + now);
    size_t *grown = *list;
    memcpy (grown + count, out, before * sizeof *out);
    galerkin_ended_near (g, grown + count + before);
    count = unique (grown, count + before + now);
    PG_ALLOC (changed, g->problem->form.consistency->cells->n);
    for (size_t k = 0; k < count; k++) m = judge_around (g, state, grown[k], changed, m);
    galerkin_ended_mark (g);
    PG_GROW (*list, cap, count + m);
    memcpy (*list + count, changed, m * sizeof *changed);
    *n = unique (*list, count + m);
done:
    pg_free (out), pg_free (changed);
    return status;
}

/* Adds the hosts and guests of its cells to the list: what identity a host obeys depends on which of these
 * are whole. */
static pg_status add_hosts (const galerkin *g, size_t **list, size_t *n)
{
    pg_status status = PG_OK;
    const pg_consistency *c = g->problem->form.consistency;
    size_t cap = 0, count = *n;
    for (size_t k = 0; k < *n; k++) {
        size_t cell = (*list)[k], guests = c->guests.start[cell + 1] - c->guests.start[cell],
               hosts = c->hosts.start[cell + 1] - c->hosts.start[cell];
        PG_GROW (*list, cap, count + hosts + guests);
        for (size_t e = c->hosts.start[cell]; e < c->hosts.start[cell + 1]; e++)
            (*list)[count++] = (size_t) c->hosts.node[e];
        for (size_t e = c->guests.start[cell]; e < c->guests.start[cell + 1]; e++)
            (*list)[count++] = (size_t) c->guests.node[e];
    }
    if (count > *n) *n = unique (*list, count);
done:
    return status;
}

/* Recomputes the shape functions in g->sums of the listed cells. */
static pg_status renew (galerkin *g, size_t n, const size_t *cell)
{
    pg_status status = PG_OK;
    const pg_rows *r = &g->rows[g->bulk];
    PG_TRY (pg_consistency_apply (g->problem->form.consistency, r, &g->sums, g->whole,
                                  galerkin_ended_faces (g)->N, n, cell, g->threads));
    PG_TRY (galerkin_ended_apply (g, n, cell));
done:
    return status;
}

/* Updates g->sums. all: all cells; else the cells of the *count points in g->list, which is replaced by all
 * points whose rows have changed. */
pg_status galerkin_consistent_update (galerkin *g, const pg_state *state, int all, size_t *count)
{
    pg_status status = PG_OK;
    const pg_consistency *c = g->problem->form.consistency;
    const pg_rows *r = &g->rows[g->bulk];
    size_t *cells = NULL, n = 0;
    kept_rows old = { 0 };
    int moved = 0;
    if (all) {
        if (!g->borrows) PG_TRY (galerkin_ended_plan (g, state, &moved));
        memset (g->whole, 1, c->cells->n);
        for (size_t cell = 0; cell < c->cells->n; cell++)
            if (!bonds_complete (g, state, cell)) open_around (g, cell);
        if (g->borrows) return PG_OK;
        size_t bonds = c->family.start[c->family.n];
        if (!g->sums.N) PG_ALLOC (g->sums.N, bonds);
        if (!g->sums.dN) PG_ALLOC (g->sums.dN, bonds * (size_t) g->dim);
        galerkin_ended_mark (g);
        PG_TRY (pg_consistency_apply (c, r, &g->sums, g->whole, galerkin_ended_faces (g)->N, 0, NULL,
                                      g->threads));
        PG_ALLOC (cells, c->cells->n);
        for (n = 0; n < c->cells->n; n++) cells[n] = n;
        PG_TRY (galerkin_ended_apply (g, n, cells));
        goto done;
    }
    PG_TRY (changed_cells (g, state, *count, &cells, &n));
    PG_TRY (near_cells (g, state, &cells, &n));
    if (n == 0) goto done;
    PG_TRY (add_hosts (g, &cells, &n));
    PG_TRY (keep_rows (g, n, cells, &old));
    PG_TRY (renew (g, n, cells));
    n = different (g, n, cells, &old);
    swap_rows (g, n, cells, &old);
    PG_TRY (galerkin_change_cells (g, n, cells, -1));
    swap_rows (g, n, cells, &old);
    PG_TRY (galerkin_change_cells (g, n, cells, 1));
    *count = 0;
    for (size_t k = 0; k < n; k++)
        for (size_t p = c->first[cells[k]]; p < c->first[cells[k] + 1]; p++) g->list[g->bulk][(*count)++] = p;
done:
    free_rows (&old);
    pg_free (cells);
    return status;
}
