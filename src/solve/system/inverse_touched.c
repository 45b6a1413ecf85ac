/* SPDX-License-Identifier: GPL-3.0-or-later
 * The dense system of the touched unknowns, (1 + D H) y = r, solved by LU with partial pivoting. M = 1 + D H
 * is kept and updated: new unknowns add columns D H and rows of the unit matrix; a change of D on a few
 * unknowns c adds D_cc H_c to their rows. Unknowns that nothing holds any more get a spring on the diagonal
 * of this system alone and stay where they were; the effect of springs on other unknowns is corrected by
 * refinement. */
#include "inverse.h"
#include <math.h>
#include <string.h>

/* Operations a second of a dense LU, on the scale of system_factor_cost: some hundred unknowns reach two
 * thirds of the rate of a supernodal factor (30 and 45 GFLOP/s, which count as 20 there). */
static const double lu_rate = 14e9;
/* A diagonal entry below this share of its value at the base is rounding: nothing holds the unknown. */
static const double gone = 1e-12;

void touched_free (inverse *v)
{
    touched_unknowns *w = &v->touched;
    pg_free (w->dof), pg_free (w->at), pg_free (w->D), pg_free (w->stay), pg_free (w->H), pg_free (w->M);
    pg_free (w->factor), pg_free (w->pivot), pg_free (w->pack), pg_free (w->product);
}

void touched_clear (inverse *v)
{
    touched_unknowns *w = &v->touched;
    for (size_t i = 0; i < w->t; i++) w->at[w->dof[i]] = 0;
    w->t = v->columns.ngroup = 0, w->factored = 0;
    if (v->keeps == INVERSE_HALVES) columns_drop (v);
}

/* Widens a matrix of t columns, from `from` to `cap` numbers from column to column. */
static pg_status widen (double **a, size_t t, size_t from, size_t cap)
{
    pg_status status = PG_OK;
    double *b = NULL;
    PG_ALLOC (b, cap * cap);
    for (size_t j = 0; j < t; j++) memcpy (b + j * cap, *a + j * from, t * sizeof *b);
    pg_free (*a);
    *a = b;
done:
    return status;
}

pg_status touched_reserve (inverse *v, size_t count)
{
    touched_unknowns *w = &v->touched;
    pg_status status = PG_OK;
    size_t cap = w->cap ? w->cap : 64, room = w->cap, same = w->cap, also = w->cap;
    if (count <= w->cap) return PG_OK;
    while (cap < count) cap *= 2;
    PG_GROW (w->dof, room, cap);
    PG_GROW (w->pivot, same, cap);
    PG_GROW (w->stay, also, cap);
    PG_TRY (widen (&w->D, w->t, w->cap, cap));
    PG_TRY (widen (&w->H, w->t, w->cap, cap));
    PG_TRY (widen (&w->M, w->t, w->cap, cap));
    PG_TRY (widen (&w->factor, 0, 0, cap));
    w->cap = cap, w->factored = 0;
done:
    return status;
}

/* ---- growth -------------------------------------------------------------------------------------------- */
/* Extends D and M for the unknowns from `first` on, which are unchanged yet: new columns of M are (D + stay)
 * H, new rows those of the unit matrix. */
static void extend (inverse *v, size_t first)
{
    touched_unknowns *w = &v->touched;
    size_t cap = w->cap, fresh = w->t - first;
    for (size_t j = 0; j < w->t; j++)
        for (size_t i = j < first ? first : 0; i < w->t; i++) w->D[i + j * cap] = 0;
    for (size_t j = first; j < w->t; j++) w->stay[j] = 0;
    pg_dense_multiply (0, first, fresh, first, 1, w->D, cap, w->H + first * cap, cap, 0, w->M + first * cap,
                       cap);
    for (size_t j = first; j < w->t; j++)
        for (size_t i = 0; i < first; i++) w->M[i + j * cap] += w->stay[i] * w->H[i + j * cap];
    for (size_t j = 0; j < w->t; j++)
        for (size_t i = first; i < w->t; i++) w->M[i + j * cap] = i == j;
}

pg_status inverse_grow (inverse *v, size_t count, const size_t *dof)
{
    green_columns *g = &v->columns;
    touched_unknowns *w = &v->touched;
    pg_status status = PG_OK;
    size_t first = w->t;
    if (count == 0) return PG_OK;
    PG_TRY (touched_reserve (v, w->t + count));
    PG_GROW (g->group, g->room_group, g->ngroup + 1);
    g->group[g->ngroup++] = count;
    w->factored = 0;                                   /* the factor is that of a smaller matrix */
    for (size_t k = 0; k < count; k++) {
        w->dof[w->t] = dof[k];
        w->at[dof[k]] = (int) ++w->t;
    }
    PG_TRY (columns_make (v, first));
    extend (v, first);
done:
    return status;
}

/* ---- changes ------------------------------------------------------------------------------------------- */
/* Stiffness of the spring that holds an unknown in the system, N/m: the spring of the base where breaking has
 * weakened the unknown; where nothing is left, its own old stiffness, or base.bare. */
static double spring (const inverse *v, size_t i)
{
    const inverse_base *b = &v->base;
    double first = b->diagonal[v->touched.dof[i]], now = first + v->touched.D[i + i * v->touched.cap];
    return now > gone * first ? b->spring : b->bare > 0 ? b->bare : first > 0 ? first : b->spring;
}

/* D_cc += change, and updates the rows c of M. place[k]: index of row k of the change among the touched
 * unknowns; SIZE_MAX: the row is zero. */
static pg_status add_change (inverse *v, const pg_stiffness_change *change, size_t n,
                             const size_t *row, const size_t *place)
{
    touched_unknowns *w = &v->touched;
    pg_status status = PG_OK;
    size_t cap = w->cap, t = w->t;
    double *delta, *Hc;
    PG_GROW (w->pack, w->room_pack, n * n + n * t);
    PG_GROW (w->product, w->room_product, n * t);
    delta = w->pack, Hc = w->pack + n * n;
    for (size_t k = 0; k < n; k++) {
        memcpy (Hc + k * t, w->H + place[k] * cap, t * sizeof *Hc);
        for (size_t l = 0; l < n; l++) {
            delta[l + k * n] = v->base.k * change->K[row[k] * change->width + row[l]];
            w->D[place[l] + place[k] * cap] += delta[l + k * n];
        }
    }
    for (size_t k = 0; k < n; k++) {
        double stay = spring (v, place[k]);
        delta[k + k * n] += stay - w->stay[place[k]];
        w->stay[place[k]] = stay;
    }
    pg_dense_multiply (0, t, n, n, 1, Hc, t, delta, n, 0, w->product, t);
    for (size_t j = 0; j < t; j++)
        for (size_t k = 0; k < n; k++) w->M[place[k] + j * cap] += w->product[j + k * t];
    w->factored = 0;
done:
    return status;
}

/* Finds the rows of the change that are not zero, and their unknowns; returns how many. */
static size_t moved_rows (const inverse *v, const pg_stiffness_change *change, size_t *row, size_t *dof)
{
    size_t m = (size_t) v->s->components, size = change->n * m, count = 0;
    for (size_t i = 0; i < size; i++) {
        const double *a = change->K + i * change->width;
        size_t j = 0;
        while (j < size && a[j] == 0) j++;
        if (j == size) continue;
        row[count] = i, dof[count++] = (size_t) change->node[i / m] * m + i % m;
    }
    return count;
}

pg_status inverse_change (inverse *v, const pg_stiffness_change *change)
{
    pg_status status = PG_OK;
    size_t size = change->n * (size_t) v->s->components, count, nfresh = 0;
    size_t *row = NULL, *dof = NULL, *fresh = NULL;
    PG_ALLOC (row, size + 1);
    PG_ALLOC (dof, size + 1);
    PG_ALLOC (fresh, size + 1);
    count = moved_rows (v, change, row, dof);
    for (size_t k = 0; k < count; k++) if (!v->touched.at[dof[k]]) fresh[nfresh++] = dof[k];
    PG_TRY (inverse_grow (v, nfresh, fresh));
    /* dof becomes the index among the touched unknowns */
    for (size_t k = 0; k < count; k++) dof[k] = (size_t) v->touched.at[dof[k]] - 1;
    if (count) PG_TRY (add_change (v, change, count, row, dof));
done:
    pg_free (row), pg_free (dof), pg_free (fresh);
    return status;
}

void inverse_hold (inverse *v, double stiffness)
{
    touched_unknowns *w = &v->touched;
    v->base.spring = stiffness, w->factored = 0;
    for (size_t i = 0; i < w->t; i++) {
        double now = spring (v, i), more = now - w->stay[i];
        for (size_t j = 0; more != 0 && j < w->t; j++) w->M[i + j * w->cap] += more * w->H[i + j * w->cap];
        w->stay[i] = now;
    }
}

/* ---- solving ------------------------------------------------------------------------------------------- */
static int factor (inverse *v)
{
    touched_unknowns *w = &v->touched;
    size_t t = w->t;
    double least = INFINITY, most = 0;
    for (size_t j = 0; j < t; j++) {
        memcpy (w->factor + j * t, w->M + j * w->cap, t * sizeof *w->M);
        for (size_t i = 0; i < t; i++) most = fmax (most, fabs (w->M[i + j * w->cap]));
    }
    if (!pg_dense_factor (t, w->factor, t, w->pivot)) return 0;
    for (size_t i = 0; i < t; i++) least = fmin (least, fabs (w->factor[i * t + i]));
    w->pivots = most > 0 ? least / most : 1, w->factored = 1;
    v->rent += (double) t * (double) t * (double) t * 2 / 3 / lu_rate;
    return 1;
}

int inverse_substitute (inverse *v, size_t n, double *y)
{
    touched_unknowns *w = &v->touched;
    if (!w->factored && !factor (v)) return 0;
    pg_dense_substitute (w->t, w->factor, w->t, w->pivot, n, y, w->t);
    return 1;
}
