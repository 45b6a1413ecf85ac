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
    pg_free (e->dof), pg_free (e->at), pg_free (e->D), pg_free (e->stay), pg_free (e->H), pg_free (e->M);
    pg_free (e->factor), pg_free (e->pivot), pg_free (e->r), pg_free (e->group);
    pg_free (e->pack), pg_free (e->product);
    for (int c = 0; c < EVENT_CASES; c++)
        pg_free (e->x[c]), pg_free (e->p[c]), pg_free (e->old[c]), pg_free (e->q[c]), pg_free (e->u[c]);
}

void touched_clear (event_solver *e)
{
    for (size_t i = 0; i < e->t; i++) e->at[e->dof[i]] = 0;
    e->t = e->ngroup = e->filled = 0, e->factored = 0;
    if (e->halves) columns_drop (e);
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
    pg_status status = PG_OK;
    size_t cap = e->cap ? e->cap : 64, room = e->cap, same = e->cap;
    if (count <= e->cap) return PG_OK;
    while (cap < count) cap *= 2;
    PG_GROW (e->dof, room, cap);
    PG_GROW (e->pivot, same, cap);
    PG_TRY (widen (&e->D, e->t, e->cap, cap));
    PG_TRY (widen (&e->H, e->t, e->cap, cap));
    PG_TRY (widen (&e->M, e->t, e->cap, cap));
    PG_TRY (lengthen (&e->factor, 0, cap * cap));
    PG_TRY (lengthen (&e->stay, e->t, cap));
    PG_TRY (lengthen (&e->r, 0, EVENT_CASES * cap));
    for (int c = 0; c < e->cases; c++) {
        PG_TRY (lengthen (&e->x[c], e->t, cap));
        PG_TRY (lengthen (&e->p[c], e->t, cap));
        PG_TRY (lengthen (&e->old[c], e->t, cap));
        PG_TRY (lengthen (&e->q[c], e->t, cap));
        PG_TRY (lengthen (&e->u[c], e->t, cap));
    }
    e->cap = cap, e->factored = 0;
done:
    return status;
}

/* ---- growth -------------------------------------------------------------------------------------------- */
/* H between all touched unknowns and the new ones, first .. t - 1, symmetric by construction. */
pg_status touched_green (event_solver *e, size_t first)
{
    pg_status status = e->halves ? columns_halve (e, first) : columns_make (e, first);
    if (status != PG_OK || e->halves) return status;
    for (size_t j = first; j < e->t; j++) {
        const double *column = green_column (e, j);
        for (size_t i = 0; i <= j; i++) e->H[i + j * e->cap] = e->H[j + i * e->cap] = column[e->dof[i]];
    }
    return PG_OK;
}

/* Columns and rows of D and M for the unknowns from `first` on, which nothing has changed yet: columns of M
 * are (D + stay) H, rows those of the unit matrix. */
static void extend (event_solver *e, size_t first)
{
    size_t cap = e->cap, fresh = e->t - first;
    for (size_t j = 0; j < e->t; j++)
        for (size_t i = j < first ? first : 0; i < e->t; i++) e->D[i + j * cap] = 0;
    for (size_t j = first; j < e->t; j++) e->stay[j] = 0;
    pg_dense_multiply (0, first, fresh, first, 1, e->D, cap, e->H + first * cap, cap, 0, e->M + first * cap,
                       cap);
    for (size_t j = first; j < e->t; j++)
        for (size_t i = 0; i < first; i++) e->M[i + j * cap] += e->stay[i] * e->H[i + j * cap];
    for (size_t j = 0; j < e->t; j++)
        for (size_t i = first; i < e->t; i++) e->M[i + j * cap] = i == j;
}

/* What is known of the new unknowns before anything has changed on them. */
pg_status touched_grow (event_solver *e, size_t count, const size_t *dof)
{
    pg_status status = PG_OK;
    size_t first = e->t;
    if (count == 0) return PG_OK;
    PG_TRY (touched_reserve (e, e->t + count));
    PG_GROW (e->group, e->room_group, e->ngroup + 1);
    e->group[e->ngroup++] = count;
    e->factored = 0;                                   /* which is that of a smaller matrix */
    for (size_t k = 0; k < count; k++) {
        e->dof[e->t] = dof[k];
        e->at[dof[k]] = (int) ++e->t;
    }
    PG_TRY (touched_green (e, first));
    extend (e, first);
    for (int c = 0; c < e->cases; c++)
        for (size_t i = first; i < e->t; i++) {
            e->x[c][i] = e->p[c][i] = e->q[c][i] = e->old[c][i] = 0;
            double sum = 0;
            for (size_t j = 0; j < first; j++) sum += e->H[j + i * e->cap] * e->x[c][j];
            e->u[c][i] = e->base[c][dof[i - first]] + sum;
        }
done:
    return status;
}

/* ---- changes ------------------------------------------------------------------------------------------- */
/* The spring that holds an unknown in the system: that of a factor on what breaking has weakened, or its own
 * old stiffness where nothing is left. */
static double spring (const event_solver *e, size_t i)
{
    double first = e->diagonal[e->dof[i]], now = first + e->D[i + i * e->cap];
    return now > gone * first ? e->shift : first > 0 ? first : e->shift;
}

/* D_cc += change, and the rows c of M: place[k] is where row k of the change goes among the touched ones;
 * SIZE_MAX: it is zero. */
static pg_status add_change (event_solver *e, const pg_stiffness_change *change, size_t n,
                             const size_t *row, const size_t *place)
{
    pg_status status = PG_OK;
    size_t cap = e->cap, t = e->t;
    double *delta, *Hc;
    PG_GROW (e->pack, e->room_pack, n * n + n * t);
    PG_GROW (e->product, e->room_product, n * t);
    delta = e->pack, Hc = e->pack + n * n;
    for (size_t k = 0; k < n; k++) {
        memcpy (Hc + k * t, e->H + place[k] * cap, t * sizeof *Hc);
        for (size_t l = 0; l < n; l++) {
            delta[l + k * n] = e->k * change->K[row[k] * change->width + row[l]];
            e->D[place[l] + place[k] * cap] += delta[l + k * n];
        }
    }
    for (size_t k = 0; k < n; k++) {
        double stay = spring (e, place[k]);
        delta[k + k * n] += stay - e->stay[place[k]];
        e->stay[place[k]] = stay;
    }
    pg_dense_multiply (0, t, n, n, 1, Hc, t, delta, n, 0, e->product, t);
    for (size_t j = 0; j < t; j++)
        for (size_t k = 0; k < n; k++) e->M[place[k] + j * cap] += e->product[j + k * t];
    e->factored = 0;
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
    for (size_t k = 0; k < count; k++) if (!e->at[dof[k]]) fresh[nfresh++] = dof[k];
    PG_TRY (touched_grow (e, nfresh, fresh));
    for (size_t k = 0; k < count; k++) dof[k] = (size_t) e->at[dof[k]] - 1;   /* now the place */
    if (count) PG_TRY (add_change (e, change, count, row, dof));
done:
    pg_free (row), pg_free (dof), pg_free (fresh);
    return status;
}

/* ---- solve --------------------------------------------------------------------------------------------- */
void touched_displacement (event_solver *e, int c)
{
    for (size_t i = 0; i < e->t; i++) e->u[c][i] = e->base[c][e->dof[i]];
    pg_dense_multiply (0, e->t, 1, e->t, 1, e->H, e->cap, e->x[c], e->cap, 1, e->u[c], e->cap);
}

/* r = p + q - x - D u_T; its Euclidean norm over the reference force. */
static double unbalanced (event_solver *e, int c, double *r)
{
    double sum = 0;
    for (size_t i = 0; i < e->t; i++) r[i] = e->p[c][i] + e->q[c][i] - e->x[c][i];
    pg_dense_multiply (0, e->t, 1, e->t, -1, e->D, e->cap, e->u[c], e->cap, 1, r, e->cap);
    for (size_t i = 0; i < e->t; i++) sum += r[i] * r[i];
    return sqrt (sum) / e->scale;
}

int touched_substitute (event_solver *e, double *y)
{
    if (!e->factored) {
        for (size_t j = 0; j < e->t; j++)
            memcpy (e->factor + j * e->t, e->M + j * e->cap, e->t * sizeof *e->M);
        if (!pg_dense_factor (e->t, e->factor, e->t, e->pivot)) return 0;
        e->factored = 1;
        e->rent += (double) e->t * (double) e->t * (double) e->t * 2 / 3 / lu_rate;
    }
    pg_dense_substitute (e->t, e->factor, e->t, e->pivot, 1, y, e->t);
    return 1;
}

/* One case: until the residual is rounding or no longer falls by half. */
static int solve_case (event_solver *e, int c)
{
    double last = INFINITY, now = unbalanced (e, c, e->r);
    for (int k = 0; k < MOST_ROUNDS && now > fine && now < 0.5 * last; k++) {
        if (!touched_substitute (e, e->r)) return 0;
        for (size_t i = 0; i < e->t; i++) e->x[c][i] += e->r[i];
        touched_displacement (e, c);
        last = now, now = unbalanced (e, c, e->r);
    }
    e->rent += 3 * 8.0 * (double) e->t * (double) e->t / 8e9;
    e->residual = fmax (e->residual, now);
    return isfinite (now) && now <= enough;
}

int touched_solve (event_solver *e)
{
    e->residual = 0;
    for (int c = 0; c < e->cases && e->t; c++) memcpy (e->old[c], e->x[c], e->t * sizeof *e->x[c]);
    for (int c = 0; c < e->cases; c++) if (!solve_case (e, c)) return 0;
    return 1;
}

void touched_undo (event_solver *e)
{
    for (int c = 0; c < e->cases && e->t; c++) {
        memcpy (e->x[c], e->old[c], e->t * sizeof *e->x[c]);
        touched_displacement (e, c);
    }
}

void touched_balance (event_solver *e, int c)
{
    touched_displacement (e, c);
    for (size_t i = 0; i < e->t; i++) e->q[c][i] = e->x[c][i] - e->p[c][i];
    pg_dense_multiply (0, e->t, 1, e->t, 1, e->D, e->cap, e->u[c], e->cap, 1, e->q[c], e->cap);
}
