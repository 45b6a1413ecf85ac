/* SPDX-License-Identifier: GPL-3.0-or-later
 * The dense system of the touched unknowns. With A u = f - W D u_T + W p and u = u_b + G x the forces x on
 * the touched unknowns follow from
 *
 *     (1 + D H) dx = r,    r = p - x - D u_T,    u_T = (u_b)_T + H x,
 *
 * solved by LU with partial pivoting and refined by its own residual. M = 1 + D H is kept and updated: new
 * unknowns add columns D H and rows of the unit matrix, a change of D on a few unknowns c adds D_cc H_c to
 * their rows. Unknowns that nothing holds any more get a spring on the diagonal of the system alone, not in
 * the residual: they stay where they were, and springs on what is held are taken out by the refinement. */
#include "event_solver_data.h"
#include <math.h>
#include <string.h>

enum { MOST_ROUNDS = 4 };
static const double fine = 1e-13, enough = 1e-10;      /* of a residual, over the reference force */
/* Operations a second of a dense LU, in the measure of system_factor_cost: some hundred unknowns reach two
 * thirds of the rate of a supernodal factor (30 and 45 GFLOP/s, of which that measure takes 20). */
static const double lu_rate = 14e9;
/* A diagonal below this share of what it was is rounding: nothing holds the unknown. */
static const double gone = 1e-12;

void touched_free (event_solver *e)
{
    touched_unknowns *w = &e->touched;
    pg_free (w->dof), pg_free (w->at), pg_free (w->D), pg_free (w->stay), pg_free (w->H), pg_free (w->M);
    pg_free (w->factor), pg_free (w->pivot), pg_free (w->r), pg_free (e->columns.group);
    pg_free (w->pack), pg_free (w->product);
    for (int c = 0; c < EVENT_CASES; c++)
        pg_free (w->x[c]), pg_free (w->p[c]), pg_free (w->old[c]), pg_free (w->q[c]), pg_free (w->u[c]);
}

void touched_clear (event_solver *e)
{
    touched_unknowns *w = &e->touched;
    for (size_t i = 0; i < w->t; i++) w->at[w->dof[i]] = 0;
    w->t = e->columns.ngroup = e->columns.filled = 0, w->factored = 0;
    if (e->columns.halves) columns_drop (e);
}

/* A matrix of t columns moves to columns `cap` apart. */
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

/* A vector of t numbers gets room for cap. */
static pg_status lengthen (double **a, size_t t, size_t cap)
{
    pg_status status = PG_OK;
    double *b = NULL;
    PG_ALLOC (b, cap);
    if (t) memcpy (b, *a, t * sizeof *b);
    pg_free (*a);
    *a = b;
done:
    return status;
}

/* Room for `count` touched unknowns. */
pg_status touched_reserve (event_solver *e, size_t count)
{
    touched_unknowns *w = &e->touched;
    pg_status status = PG_OK;
    size_t cap = w->cap ? w->cap : 64, room = w->cap, same = w->cap;
    if (count <= w->cap) return PG_OK;
    while (cap < count) cap *= 2;
    PG_GROW (w->dof, room, cap);
    PG_GROW (w->pivot, same, cap);
    PG_TRY (widen (&w->D, w->t, w->cap, cap));
    PG_TRY (widen (&w->H, w->t, w->cap, cap));
    PG_TRY (widen (&w->M, w->t, w->cap, cap));
    PG_TRY (lengthen (&w->factor, 0, cap * cap));
    PG_TRY (lengthen (&w->stay, w->t, cap));
    PG_TRY (lengthen (&w->r, 0, EVENT_CASES * cap));
    for (int c = 0; c < e->cases; c++) {
        PG_TRY (lengthen (&w->x[c], w->t, cap));
        PG_TRY (lengthen (&w->p[c], w->t, cap));
        PG_TRY (lengthen (&w->old[c], w->t, cap));
        PG_TRY (lengthen (&w->q[c], w->t, cap));
        PG_TRY (lengthen (&w->u[c], w->t, cap));
    }
    w->cap = cap, w->factored = 0;
done:
    return status;
}

/* ---- growth -------------------------------------------------------------------------------------------- */
/* H between all touched unknowns and the new ones, first .. t - 1, symmetric by construction. */
pg_status touched_green (event_solver *e, size_t first)
{
    touched_unknowns *w = &e->touched;
    pg_status status = e->columns.halves ? columns_halve (e, first) : columns_make (e, first);
    if (status != PG_OK || e->columns.halves) return status;
    for (size_t j = first; j < w->t; j++) {
        const double *column = green_column (e, j);
        for (size_t i = 0; i <= j; i++) w->H[i + j * w->cap] = w->H[j + i * w->cap] = column[w->dof[i]];
    }
    return PG_OK;
}

/* Columns and rows of D and M for the unknowns from `first` on, which nothing has changed yet: columns of M
 * are (D + stay) H, rows those of the unit matrix. */
static void extend (event_solver *e, size_t first)
{
    touched_unknowns *w = &e->touched;
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

/* What is known of the new unknowns before anything has changed on them. */
pg_status touched_grow (event_solver *e, size_t count, const size_t *dof)
{
    green_columns *g = &e->columns;
    touched_unknowns *w = &e->touched;
    pg_status status = PG_OK;
    size_t first = w->t;
    if (count == 0) return PG_OK;
    PG_TRY (touched_reserve (e, w->t + count));
    PG_GROW (g->group, g->room_group, g->ngroup + 1);
    g->group[g->ngroup++] = count;
    w->factored = 0;                                   /* which is that of a smaller matrix */
    for (size_t k = 0; k < count; k++) {
        w->dof[w->t] = dof[k];
        w->at[dof[k]] = (int) ++w->t;
    }
    PG_TRY (touched_green (e, first));
    extend (e, first);
    for (int c = 0; c < e->cases; c++)
        for (size_t i = first; i < w->t; i++) {
            w->x[c][i] = w->p[c][i] = w->q[c][i] = w->old[c][i] = 0;
            double sum = 0;
            for (size_t j = 0; j < first; j++) sum += w->H[j + i * w->cap] * w->x[c][j];
            w->u[c][i] = e->base.u[c][dof[i - first]] + sum;
        }
done:
    return status;
}

/* ---- changes ------------------------------------------------------------------------------------------- */
/* The spring that holds an unknown in the system: that of a factor on what breaking has weakened, or its own
 * old stiffness where nothing is left. */
static double spring (const event_solver *e, size_t i)
{
    double first = e->base.diagonal[e->touched.dof[i]], now = first + e->touched.D[i + i * e->touched.cap];
    return now > gone * first ? e->base.shift : first > 0 ? first : e->base.shift;
}

/* D_cc += change, and the rows c of M: place[k] is where row k of the change goes among the touched ones;
 * SIZE_MAX: it is zero. */
static pg_status add_change (event_solver *e, const pg_stiffness_change *change, size_t n,
                             const size_t *row, const size_t *place)
{
    touched_unknowns *w = &e->touched;
    pg_status status = PG_OK;
    size_t cap = w->cap, t = w->t;
    double *delta, *Hc;
    PG_GROW (w->pack, w->room_pack, n * n + n * t);
    PG_GROW (w->product, w->room_product, n * t);
    delta = w->pack, Hc = w->pack + n * n;
    for (size_t k = 0; k < n; k++) {
        memcpy (Hc + k * t, w->H + place[k] * cap, t * sizeof *Hc);
        for (size_t l = 0; l < n; l++) {
            delta[l + k * n] = e->base.k * change->K[row[k] * change->width + row[l]];
            w->D[place[l] + place[k] * cap] += delta[l + k * n];
        }
    }
    for (size_t k = 0; k < n; k++) {
        double stay = spring (e, place[k]);
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

/* Rows of the change that are not zero, and the unknowns they belong to. */
static size_t moved_rows (const event_solver *e, const pg_stiffness_change *change, size_t *row, size_t *dof)
{
    size_t m = (size_t) e->s->components, size = change->n * m, count = 0;
    for (size_t i = 0; i < size; i++) {
        const double *a = change->K + i * change->width;
        size_t j = 0;
        while (j < size && a[j] == 0) j++;
        if (j == size) continue;
        row[count] = i, dof[count++] = (size_t) change->node[i / m] * m + i % m;
    }
    return count;
}

pg_status touched_change (event_solver *e, const pg_stiffness_change *change)
{
    pg_status status = PG_OK;
    size_t size = change->n * (size_t) e->s->components, count, nfresh = 0;
    size_t *row = NULL, *dof = NULL, *fresh = NULL;
    PG_ALLOC (row, size + 1);
    PG_ALLOC (dof, size + 1);
    PG_ALLOC (fresh, size + 1);
    count = moved_rows (e, change, row, dof);
    for (size_t k = 0; k < count; k++) if (!e->touched.at[dof[k]]) fresh[nfresh++] = dof[k];
    PG_TRY (touched_grow (e, nfresh, fresh));
    for (size_t k = 0; k < count; k++) dof[k] = (size_t) e->touched.at[dof[k]] - 1;   /* now the place */
    if (count) PG_TRY (add_change (e, change, count, row, dof));
done:
    pg_free (row), pg_free (dof), pg_free (fresh);
    return status;
}

/* ---- solve --------------------------------------------------------------------------------------------- */
void touched_displacement (event_solver *e, int c)
{
    touched_unknowns *w = &e->touched;
    for (size_t i = 0; i < w->t; i++) w->u[c][i] = e->base.u[c][w->dof[i]];
    pg_dense_multiply (0, w->t, 1, w->t, 1, w->H, w->cap, w->x[c], w->cap, 1, w->u[c], w->cap);
}

/* r = p + q - x - D u_T; its Euclidean norm over the reference force. */
static double unbalanced (event_solver *e, int c, double *r)
{
    touched_unknowns *w = &e->touched;
    double sum = 0;
    for (size_t i = 0; i < w->t; i++) r[i] = w->p[c][i] + w->q[c][i] - w->x[c][i];
    pg_dense_multiply (0, w->t, 1, w->t, -1, w->D, w->cap, w->u[c], w->cap, 1, r, w->cap);
    for (size_t i = 0; i < w->t; i++) sum += r[i] * r[i];
    return sqrt (sum) / e->base.scale;
}

int touched_substitute (event_solver *e, double *y)
{
    touched_unknowns *w = &e->touched;
    if (!w->factored) {
        for (size_t j = 0; j < w->t; j++)
            memcpy (w->factor + j * w->t, w->M + j * w->cap, w->t * sizeof *w->M);
        if (!pg_dense_factor (w->t, w->factor, w->t, w->pivot)) return 0;
        w->factored = 1;
        e->rent += (double) w->t * (double) w->t * (double) w->t * 2 / 3 / lu_rate;
    }
    pg_dense_substitute (w->t, w->factor, w->t, w->pivot, 1, y, w->t);
    return 1;
}

/* One case: until the residual is rounding or no longer falls by half. */
static int solve_case (event_solver *e, int c)
{
    touched_unknowns *w = &e->touched;
    double last = INFINITY, now = unbalanced (e, c, w->r);
    for (int k = 0; k < MOST_ROUNDS && now > fine && now < 0.5 * last; k++) {
        if (!touched_substitute (e, w->r)) return 0;
        for (size_t i = 0; i < w->t; i++) w->x[c][i] += w->r[i];
        touched_displacement (e, c);
        last = now, now = unbalanced (e, c, w->r);
    }
    e->rent += 3 * 8.0 * (double) w->t * (double) w->t / 8e9;
    w->residual = fmax (w->residual, now);
    return isfinite (now) && now <= enough;
}

int touched_solve (event_solver *e)
{
    touched_unknowns *w = &e->touched;
    w->residual = 0;
    for (int c = 0; c < e->cases && w->t; c++) memcpy (w->old[c], w->x[c], w->t * sizeof *w->x[c]);
    for (int c = 0; c < e->cases; c++) if (!solve_case (e, c)) return 0;
    return 1;
}

void touched_undo (event_solver *e)
{
    touched_unknowns *w = &e->touched;
    for (int c = 0; c < e->cases && w->t; c++) {
        memcpy (w->x[c], w->old[c], w->t * sizeof *w->x[c]);
        touched_displacement (e, c);
    }
}

void touched_balance (event_solver *e, int c)
{
    touched_unknowns *w = &e->touched;
    touched_displacement (e, c);
    for (size_t i = 0; i < w->t; i++) w->q[c][i] = w->x[c][i] - w->p[c][i];
    pg_dense_multiply (0, w->t, 1, w->t, 1, w->D, w->cap, w->u[c], w->cap, 1, w->q[c], w->cap);
}
