/* SPDX-License-Identifier: GPL-3.0-or-later
 * Green columns: G = T A^-1 T' E, the displacement of all unknowns under a unit force on each of the touched
 * ones (E selects them), by the factor of the base. T is the elimination of supports, d = T q + g: a force
 * on a full unknown acts on the free ones through T'. Prescribed unknowns that nothing depends on have
 * columns of zeros.
 *
 * Where no displacement of all unknowns is asked for, only H = E' G, half a solve does for each column:
 * with A = P' L L' P and y_i = L^-1 P T' e_i it is H_ij = y_i . y_j (columns_halve). */
#include "event_solver_data.h"
#include <string.h>

/* Operations a second of products of large dense matrices, in the measure of system_factor_cost. */
static const double dense_rate = 20e9;

/* Writes T' e_i of the unknowns first .. t - 1 into the right-hand sides. While a resumed run makes its
 * columns again group by group, unknowns of later groups are touched already. */
static void unit_forces (event_solver *e, size_t first, const pg_sparse *T)
{
    green_columns *g = &e->columns;
    touched_unknowns *w = &e->touched;
    size_t count = w->t - first;
    memset (g->rhs, 0, count * e->nred * sizeof *g->rhs);
    if (!T) {
        for (size_t k = 0; k < count; k++) g->rhs[k * e->nred + w->dof[first + k]] = 1;
        return;
    }
    for (size_t j = 0; j < T->ncol; j++)
        for (long q = T->start[j]; q < T->start[j + 1]; q++) {
            int at = w->at[T->row[q]];
            if (at <= (int) first || at > (int) w->t) continue;
            g->rhs[((size_t) at - 1 - first) * e->nred + j] = T->value[q];
        }
}

/* Room for the columns of all touched unknowns, zero, and for as many right-hand sides as are new. */
static pg_status make_room (event_solver *e, size_t count)
{
    green_columns *g = &e->columns;
    pg_status status = PG_OK;
    PG_GROW (g->chunk, g->room_chunk, (e->touched.t + CHUNK - 1) / CHUNK);
    for (; g->nchunk * CHUNK < e->touched.t; g->nchunk++) {
        g->chunk[g->nchunk] = NULL;
        PG_ALLOC (g->chunk[g->nchunk], CHUNK * e->ndof);
    }
    PG_GROW (g->rhs, g->room_rhs, count * e->nred);
done:
    return status;
}

/* All new columns by one solve with as many right-hand sides. */
pg_status columns_make (event_solver *e, size_t first)
{
    green_columns *g = &e->columns;
    pg_status status = PG_OK;
    pg_system *s = e->s;
    const pg_sparse *T = s->force->basis ? s->force->basis (s->self) : NULL;
    size_t count = e->touched.t - first;
    PG_TRY (make_room (e, count));
    PG_GROW (g->solved, g->room_solved, count * e->nred);
    unit_forces (e, first, T);
    const pg_linear_type *linear = s->direct.linear;
    PG_TRY ((linear->solve_few ? linear->solve_few : linear->solve) (s->direct.factor, count, g->rhs,
                                                                     g->solved));
    for (size_t k = 0; k < count; k++) {
        double *to = g->chunk[(first + k) / CHUNK] + (first + k) % CHUNK * e->ndof;
        if (T) pg_sparse_multiply (T, g->solved + k * e->nred, to);
        else memcpy (to, g->solved + k * e->nred, e->ndof * sizeof *to);
    }
done:
    return status;
}

/* H_ij += y_i . y_j over one interval, for na touched unknowns i from a and nb from b, each in one chunk. */
static void add_products (event_solver *e, size_t a, size_t na, size_t b, size_t nb, size_t from, size_t end)
{
    pg_dense_multiply (1, na, nb, end - from, 1, green_column (e, a) + from, e->ndof,
                       green_column (e, b) + from, e->ndof, 1, e->touched.H + a + b * e->touched.cap,
                           e->touched.cap);
}

/* Only half of each solve: places that a unit force reaches in the factor are few, and H is all that is asked
 * for. A halved column is of length nred, in a column of ndof numbers. The triangle above the diagonal
 * counts, so that H is symmetric to the last bit. */
pg_status columns_halve (event_solver *e, size_t first)
{
    green_columns *g = &e->columns;
    touched_unknowns *w = &e->touched;
    pg_status status = PG_OK;
    pg_system *s = e->s;
    const pg_sparse *T = s->force->basis ? s->force->basis (s->self) : NULL;
    size_t count = w->t - first, n;
    const size_t *interval;
    pg_linear_info info;
    PG_TRY (make_room (e, count));
    PG_GROW (g->half, g->room_half, count);
    for (size_t k = 0; k < count; k++)
        g->half[k] = g->chunk[(first + k) / CHUNK] + (first + k) % CHUNK * e->ndof;
    unit_forces (e, first, T);
    s->direct.linear->info (s->direct.factor, &info);
    double before = info.half_flops, flops = 0;
    PG_TRY (s->direct.linear->half_few (s->direct.factor, count, g->rhs, g->half, &n, &interval));
    s->direct.linear->info (s->direct.factor, &info);
    for (size_t k = 0; k < n; k++)
        flops += 2 * (double) count * (double) w->t * (double) (interval[2 * k + 1] - interval[2 * k]);
    g->seconds += (info.half_flops - before + flops) / dense_rate;
    for (size_t j = first; j < w->t; j++) memset (w->H + j * w->cap, 0, w->t * sizeof *w->H);
    for (size_t b = first, nb; b < w->t; b += nb) {
        nb = CHUNK - b % CHUNK < w->t - b ? CHUNK - b % CHUNK : w->t - b;
        for (size_t a = 0, na; a < b + nb; a += na) {
            na = CHUNK < b + nb - a ? CHUNK : b + nb - a;
            for (size_t k = 0; k < n; k++)
                add_products (e, a, na, b, nb, interval[2 * k], interval[2 * k + 1]);
        }
    }
    for (size_t j = first; j < w->t; j++)
        for (size_t i = 0; i < j; i++) w->H[j + i * w->cap] = w->H[i + j * w->cap];
done:
    return status;
}

void columns_unload (const event_solver *e, const double *y, double *r)
{
    const pg_sparse *T = e->s->force->basis ? e->s->force->basis (e->s->self) : NULL;
    for (size_t i = 0; !T && i < e->touched.t; i++) r[e->touched.dof[i]] -= y[i];
    for (size_t j = 0; T && j < T->ncol; j++)
        for (long q = T->start[j]; q < T->start[j + 1]; q++) {
            int at = e->touched.at[T->row[q]];
            if (at) r[j] -= T->value[q] * y[at - 1];
        }
}

void columns_times (const event_solver *e, double a, const double *x, double *y)
{
    const touched_unknowns *w = &e->touched;
    if (w->t == 0 && a == 0) memset (y, 0, e->ndof * sizeof *y);
    for (size_t i = 0; i < w->t; i += CHUNK) {
        size_t some = w->t - i < CHUNK ? w->t - i : CHUNK;
        pg_dense_multiply (0, e->ndof, 1, some, 1, green_column (e, i), e->ndof, x + i, some, i ? 1 : a, y,
                           e->ndof);
    }
}

/* Columns of full length are far apart in memory: of those that came since the last call the few numbers that
 * are wanted again and again are gathered once. */
pg_status columns_watch (event_solver *e)
{
    green_columns *g = &e->columns;
    pg_status status = PG_OK;
    size_t m = (size_t) e->s->components, size = g->nwatched * m;
    PG_GROW (g->rows, g->room_rows, size * e->touched.t);
    for (; g->filled < e->touched.t; g->filled++) {
        const double *G = green_column (e, g->filled);
        double *to = g->rows + g->filled * size;
        for (size_t k = 0; k < g->nwatched; k++)
            for (size_t a = 0; a < m; a++) to[k * m + a] = G[(size_t) g->watched[k] * m + a];
    }
done:
    return status;
}

/* Halves are zero where they were never written, on pages that nothing has touched. */
void columns_drop (event_solver *e)
{
    for (size_t k = 0; k < e->columns.nchunk; k++) pg_free (e->columns.chunk[k]);
    e->columns.nchunk = 0;
}

void columns_free (event_solver *e)
{
    green_columns *g = &e->columns;
    columns_drop (e);
    pg_free (g->half), pg_free (g->chunk), pg_free (g->rhs), pg_free (g->solved);
    pg_free (g->watched), pg_free (g->rows);
}
