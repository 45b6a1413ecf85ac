/* SPDX-License-Identifier: GPL-3.0-or-later
 * The inverse of a matrix that changes: its bases, its changes, solving, checkpoints (algorithm:
 * inverse.h). */
#include "inverse.h"
#include <math.h>
#include <string.h>

/* Most touched unknowns for which the dense system pays; in a block that is used once. Most memory for Green
 * columns, bytes. */
enum { MOST_TOUCHED = 2000, MOST_IN_BLOCK = 3000 };
static const double most_memory = 1.5e9;               /* most memory of Green columns, bytes */
/* Cost of a column among several right-hand sides, over one solve; numbers read from memory in a second. */
static const double column_share = 0.3, memory_rate = 1e9;

/* ---- life ---------------------------------------------------------------------------------------------- */
pg_status inverse_create (inverse **out, pg_system *s, inverse_keeps keeps)
{
    pg_status status = PG_OK;
    inverse *v = NULL;
    *out = NULL;
    int follows = s->force->spares.change && !s->options->plain;
    if (!system_can_factor (s) || !(follows || keeps == INVERSE_BLOCK)) return PG_OK;
    PG_ALLOC (v, 1);
    v->s = s, v->base.k = 1;
    v->keeps = keeps == INVERSE_HALVES && !s->direct.linear->half_few ? INVERSE_COLUMNS : keeps;
    PG_ALLOC (v->touched.at, s->ndof);
    PG_ALLOC (v->base.diagonal, s->ndof);
    *out = v, v = NULL;
done:
    inverse_free (&v);
    return status;
}

void inverse_free (inverse **inverse_)
{
    inverse *v = *inverse_;
    if (!v) return;
    touched_free (v);
    columns_free (v);
    pg_free (v->base.diagonal);
    pg_free (v);
    *inverse_ = NULL;
}

/* ---- bases --------------------------------------------------------------------------------------------- */
int inverse_has_base (const inverse *v) { return v->base.made && !v->restored; }

/* Sets base.made; of a block the system need not know, as it is gone before the factor is used otherwise. */
static void set_base (inverse *v, int made)
{
    v->base.made = made;
    if (v->keeps != INVERSE_BLOCK) v->s->updates.base = made;
}

void inverse_forget (inverse *v) { set_base (v, 0); }

pg_status inverse_renew (inverse *v, double k, double m, double spring)
{
    inverse_base *b = &v->base;
    pg_status status = PG_OK;
    pg_system *s = v->s;
    pg_stiffness_change change;
    inverse_forget (v), touched_clear (v);
    const pg_sparse *K = pg_force_matrix (s->force, s->self);
    /* K may have been freed after it was factored */
    const pg_operator *op = K && K->value ? NULL : s->force->operator_ (s->self);
    if (op) op->diagonal (op->context, b->diagonal);
    for (size_t i = 0; i < s->ndof; i++)
        b->diagonal[i] = k * (op ? b->diagonal[i] : K->value[K->start[i + 1] - 1]);
    if (m != 0) system_add_mass_diagonal (s, m, b->diagonal);
    b->k = k, b->spring = spring, b->factorizations = s->report->linear.factorizations;
    v->rent = v->columns.seconds = 0;
    /* records changes of K from here on */
    if (v->keeps != INVERSE_BLOCK) PG_TRY (s->force->spares.change (s->self, &change));
    set_base (v, 1);
done:
    return status;
}

/* ---- changes ------------------------------------------------------------------------------------------- */
static size_t most_of (const inverse *v)
{
    return v->keeps == INVERSE_BLOCK ? MOST_IN_BLOCK : MOST_TOUCHED;
}

int inverse_has_room (const inverse *v, size_t count)
{
    size_t all = v->touched.t + count;
    return all <= most_of (v)
           && (v->keeps != INVERSE_COLUMNS
               || (double) all * (double) v->s->ndof * sizeof (double) <= most_memory);
}

pg_status inverse_take (inverse *v, inverse_outcome *outcome)
{
    pg_status status = PG_OK;
    pg_stiffness_change change;
    PG_TRY (v->s->force->spares.change (v->s->self, &change));
    v->loads = change.loads;
    *outcome = INVERSE_LOST;
    if (v->base.made && v->base.factorizations == v->s->report->linear.factorizations && change.known
        && !change.basis) {
        if (change.n == 0 && !change.loads) *outcome = INVERSE_SAME;
        else if (inverse_has_room (v, change.n * (size_t) v->s->components)) *outcome = INVERSE_TAKEN;
    }
    if (*outcome == INVERSE_LOST) inverse_forget (v);
    if (*outcome == INVERSE_TAKEN) PG_TRY (inverse_change (v, &change));
done:
    return status;
}

/* 1: a new base is due by rent or buy: the dense algebra since the base has cost more than another assembly
 * and factor and the columns that would be needed again. */
int inverse_is_due (const inverse *v)
{
    double column = column_share * system_solve_cost (v->s),
        again = fmin ((double) v->touched.t, 80) * column;
    return v->rent > system_assembly_cost (v->s) + system_factor_cost (v->s) + again;
}

double inverse_spent (const inverse *v, double renewal)
{
    return v->rent + v->columns.seconds + (double) v->touched.t / (double) most_of (v) * renewal;
}

/* ---- solving ------------------------------------------------------------------------------------------- */
/* reduced = free unknowns of a full vector, in their order: the rows of T with nothing but a 1. */
static void reduce (const inverse *v, const double *full, double *reduced)
{
    const pg_sparse *T = system_basis (v->s);
    for (size_t j = 0; j < v->s->nred; j++) {
        long q = T ? T->start[j] : 0;
        while (T && T->value[q] != 1) q++;
        reduced[j] = full[T ? (size_t) T->row[q] : j];
    }
}

/* y = (1 + D H)^-1 D u on the touched unknowns, u being their displacements in `full`; y: 2 t numbers. */
static pg_status forces_of_change (inverse *v, const double *full, double *y)
{
    touched_unknowns *w = &v->touched;
    pg_status status = PG_OK;
    double *u = y + w->t + 1;
    for (size_t i = 0; i < w->t; i++) u[i] = full[w->dof[i]], y[i] = w->stay[i] * u[i];
    inverse_add_D (v, 1, u, y);
    if (!inverse_substitute (v, 1, y))
        PG_FAIL (PG_E_SINGULAR, "the system of the touched unknowns is singular");
done:
    return status;
}

/* x = A^-1 r - G y with (1 + D H) y = D W' A^-1 r; if no columns are kept, A^-1 (r - W y) by another
 * solve. */
pg_status inverse_solve (inverse *v, const double *r, double *x)
{
    touched_unknowns *w = &v->touched;
    pg_status status = PG_OK;
    pg_system *s = v->s;
    const pg_linear_type *linear = s->direct.linear;
    double *full = NULL, *part = NULL, *y = NULL;
    PG_TRY (linear->solve (s->direct.factor, 1, r, x));
    if (w->t == 0) goto done;
    PG_ALLOC (full, s->ndof);
    PG_ALLOC (part, s->nred);
    PG_ALLOC (y, 2 * (w->t + 1));
    system_expand (s, x, full);
    PG_TRY (forces_of_change (v, full, y));
    if (v->keeps == INVERSE_COLUMNS) {
        columns_times (v, 0, y, full);
        reduce (v, full, part);
        for (size_t j = 0; j < s->nred; j++) x[j] -= part[j];
        v->rent += (double) w->t * (double) s->ndof / memory_rate;
    } else {
        memcpy (part, r, s->nred * sizeof *part);
        columns_unload (v, y, part);
        PG_TRY (linear->solve (s->direct.factor, 1, part, x));
    }
done:
    pg_free (full), pg_free (part), pg_free (y);
    return status;
}

/* ---- checkpoints --------------------------------------------------------------------------------------- */
/* Writes or reads back a matrix of the touched unknowns; its columns, `cap` apart in memory, are contiguous
 * in the file. Checkpoints have the touched unknowns by groups as they were taken in, D, and M, as the order
 * of its updates shows in its last bits. Green columns are made again by the factor of the base, group by
 * group, to the same bits. */
static pg_status keep_square (inverse *v, const char *name, double *a, const pg_keeper *k)
{
    touched_unknowns *w = &v->touched;
    pg_status status = PG_OK;
    double *packed = NULL;
    PG_ALLOC (packed, w->t * w->t + 1);
    for (size_t j = 0; j < w->t; j++) memcpy (packed + j * w->t, a + j * w->cap, w->t * sizeof *a);
    PG_TRY (k->numbers (k->context, name, w->t * w->t, packed));
    for (size_t j = 0; j < w->t; j++) memcpy (a + j * w->cap, packed + j * w->t, w->t * sizeof *a);
done:
    pg_free (packed);
    return status;
}

/* Writes or reads back the touched unknowns and their groups; numbers out of range are refused before they
 * are used. */
static pg_status keep_touched (inverse *v, const pg_keeper *k)
{
    green_columns *g = &v->columns;
    touched_unknowns *w = &v->touched;
    pg_status status = PG_OK;
    size_t t = w->t, ngroup = g->ngroup, ndof = v->s->ndof, sum = 0;
    PG_TRY (pg_keep_fields (k, "inverse", "touched", NULL, 1, PG_ROWS (
        PG_KEPT_IN (t, 0, ndof, "the number of touched unknowns"),
        PG_KEPT_IN (ngroup, 0, ndof, "the groups of touched unknowns"))));
    PG_KEEP_BOUND (k, "the groups of touched unknowns", ngroup, 0, t);
    if (k->reading) {
        touched_clear (v);
        PG_TRY (touched_reserve (v, t));
        PG_GROW (g->group, g->room_group, ngroup);
    }
    PG_TRY (pg_keep_fields (k, "inverse", "unknowns", NULL, 1, PG_ROWS (
        PG_ITEMS_IN (w->dof, t, 0, ndof - 1, "a touched unknown"),
        PG_ITEMS_IN (g->group, ngroup, 1, t, "a group of touched unknowns"))));
    for (size_t i = 0; i < ngroup; i++) sum += g->group[i];
    PG_KEEP_BOUND (k, "the sum of the groups", sum, t, t);
    w->t = t, g->ngroup = ngroup;
    for (size_t i = 0; i < t; i++) w->at[w->dof[i]] = (int) i + 1;
done:
    return status;
}

pg_status inverse_keep (inverse *v, const pg_keeper *k)
{
    inverse_base *b = &v->base;
    touched_unknowns *w = &v->touched;
    pg_status status = PG_OK;
    PG_TRY (pg_keep_fields (k, "inverse", "counts", "numbers", 1, PG_ROWS (
        PG_KEPT_IN (b->made, 0, 1, "the base of events"), PG_KEPT (b->spring), PG_KEPT (v->rent),
        PG_KEPT (b->k), PG_KEPT (v->columns.seconds))));
    if (k->reading) v->s->updates.base |= b->made;
    if (!b->made) goto done;
    PG_TRY (k->numbers (k->context, "inverse.diagonal", v->s->ndof, b->diagonal));
    PG_TRY (keep_touched (v, k));
    if (w->t) {
        PG_TRY (keep_square (v, "inverse.D", w->D, k));
        PG_TRY (keep_square (v, "inverse.M", w->M, k));
        PG_TRY (k->numbers (k->context, "inverse.stay", w->t, w->stay));
    }
    if (k->reading) v->restored = 1;
done:
    return status;
}

/* Makes the Green columns again in their old groups; the force records changes anew from here on. */
pg_status inverse_restore (inverse *v)
{
    green_columns *g = &v->columns;
    touched_unknowns *w = &v->touched;
    pg_status status = PG_OK;
    pg_stiffness_change change;
    size_t all = w->t;
    double green = g->seconds;                           /* columns made again are not counted twice */
    if (!v->restored) return PG_OK;
    v->restored = 0;
    if (!v->base.made) return PG_OK;
    for (size_t k = 0, first = 0; k < g->ngroup; first += g->group[k++]) {
        w->t = first + g->group[k];
        PG_TRY (columns_make (v, first));
    }
    w->t = all, w->factored = 0, g->seconds = green;
    v->base.factorizations = v->s->report->linear.factorizations;
    PG_TRY (v->s->force->spares.change (v->s->self, &change));
done:
    return status;
}
