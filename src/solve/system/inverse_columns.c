/* SPDX-License-Identifier: GPL-3.0-or-later
 * Green columns: G = T A^-1 T' E, the displacement of all unknowns under a unit force on each of the touched
 * ones (E selects them), by the factor of the base. T is the elimination of supports, d = T q + g: a force
 * on a full unknown acts on the free ones through T'. Prescribed unknowns that nothing depends on have
 * columns of zeros.
 *
 * Where no displacement of all unknowns is asked for, only H = E' G, half a solve does for each column:
 * with A = P' L L' P and y_i = L^-1 P T' e_i it is H_ij = y_i . y_j (halve_columns). Of a block that
 * serves once no column is kept. */
#include "inverse.h"
#include <string.h>

/* Operations a second of products of large dense matrices, on the scale of system_factor_cost. */
static const double dense_rate = 20e9;

/* Writes T' e_i into the right-hand sides, for `count` touched unknowns i from `first` on. While a resumed
 * run makes its columns again group by group, unknowns of later groups are touched already. */
static void unit_forces (inverse *v, size_t first, size_t count)
{
    green_columns *g = &v->columns;
    touched_unknowns *w = &v->touched;
    const pg_sparse *T = system_basis (v->s);
    size_t nred = v->s->nred;
    memset (g->rhs, 0, count * nred * sizeof *g->rhs);
    if (!T) {
        for (size_t k = 0; k < count; k++) g->rhs[k * nred + w->dof[first + k]] = 1;
        return;
    }
    for (size_t j = 0; j < T->ncol; j++)
        for (long q = T->start[j]; q < T->start[j + 1]; q++) {
            int at = w->at[T->row[q]];
            if (at <= (int) first || at > (int) (first + count)) continue;
            g->rhs[((size_t) at - 1 - first) * nred + j] = T->value[q];
        }
}

/* Allocates that many columns, zero at first, and right-hand sides for `count` new ones. */
static pg_status make_room (inverse *v, size_t columns, size_t count)
{
    green_columns *g = &v->columns;
    pg_status status = PG_OK;
    PG_GROW (g->chunk, g->room_chunk, (columns + CHUNK - 1) / CHUNK);
    for (; g->nchunk * CHUNK < columns; g->nchunk++) {
        g->chunk[g->nchunk] = NULL;
        PG_ALLOC (g->chunk[g->nchunk], CHUNK * v->s->ndof);
    }
    PG_GROW (g->rhs, g->room_rhs, count * v->s->nred);
done:
    return status;
}

/* Solves for the columns of `count` unknowns from `first` on at once and stores them in G from column `place`
 * on; fills their rows and columns of H. */
static pg_status solve_columns (inverse *v, size_t first, size_t count, size_t place)
{
    green_columns *g = &v->columns;
    touched_unknowns *w = &v->touched;
    pg_status status = PG_OK;
    pg_system *s = v->s;
    const pg_linear_type *linear = s->direct.linear;
    PG_TRY (make_room (v, place + count, count));
    PG_GROW (g->solved, g->room_solved, count * s->nred);
    unit_forces (v, first, count);
    PG_TRY ((linear->solve_few ? linear->solve_few : linear->solve) (s->direct.factor, count, g->rhs,
                                                                     g->solved));
    for (size_t k = 0; k < count; k++) {
        size_t j = first + k;
        double *to = g->chunk[(place + k) / CHUNK] + (place + k) % CHUNK * s->ndof;
        system_expand (s, g->solved + k * s->nred, to);
        for (size_t i = 0; i <= j; i++) w->H[i + j * w->cap] = w->H[j + i * w->cap] = to[w->dof[i]];
    }
done:
    return status;
}

/* H_ij += y_i . y_j over one interval, for na touched unknowns i from a and nb from b, each in one chunk. */
static void add_products (inverse *v, size_t a, size_t na, size_t b, size_t nb, size_t from, size_t end)
{
    pg_dense_multiply (1, na, nb, end - from, 1, green_column (v, a) + from, v->s->ndof,
                       green_column (v, b) + from, v->s->ndof, 1, v->touched.H + a + b * v->touched.cap,
                           v->touched.cap);
}

/* Makes H by half of each solve, as only few entries of the factor are reached by a unit force and nothing
 * else is asked for. A halved column is of length nred, in a column of ndof numbers. The triangle above the
 * diagonal counts, so that H is symmetric to the last bit. */
static pg_status halve_columns (inverse *v, size_t first)
{
    green_columns *g = &v->columns;
    touched_unknowns *w = &v->touched;
    pg_status status = PG_OK;
    pg_system *s = v->s;
    size_t count = w->t - first, n;
    const size_t *interval;
    pg_linear_info info;
    PG_TRY (make_room (v, w->t, count));
    PG_GROW (g->half, g->room_half, count);
    for (size_t k = 0; k < count; k++)
        g->half[k] = g->chunk[(first + k) / CHUNK] + (first + k) % CHUNK * v->s->ndof;
    unit_forces (v, first, count);
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
                add_products (v, a, na, b, nb, interval[2 * k], interval[2 * k + 1]);
        }
    }
    for (size_t j = first; j < w->t; j++)
        for (size_t i = 0; i < j; i++) w->H[j + i * w->cap] = w->H[i + j * w->cap];
done:
    return status;
}

pg_status columns_make (inverse *v, size_t first)
{
    pg_status status = PG_OK;
    size_t end = v->touched.t;
    if (v->keeps == INVERSE_HALVES) return halve_columns (v, first);
    if (v->keeps == INVERSE_COLUMNS) return solve_columns (v, first, end - first, first);
    for (size_t k = first; k < end; k += CHUNK)
        PG_TRY (solve_columns (v, k, end - k < CHUNK ? end - k : CHUNK, 0));
done:
    return status;
}

void columns_unload (const inverse *v, const double *y, double *r)
{
    const pg_sparse *T = system_basis (v->s);
    for (size_t i = 0; !T && i < v->touched.t; i++) r[v->touched.dof[i]] -= y[i];
    for (size_t j = 0; T && j < T->ncol; j++)
        for (long q = T->start[j]; q < T->start[j + 1]; q++) {
            int at = v->touched.at[T->row[q]];
            if (at) r[j] -= T->value[q] * y[at - 1];
        }
}

void columns_times (const inverse *v, double a, const double *x, double *y)
{
    const touched_unknowns *w = &v->touched;
    if (w->t == 0 && a == 0) memset (y, 0, v->s->ndof * sizeof *y);
    for (size_t i = 0; i < w->t; i += CHUNK) {
        size_t some = w->t - i < CHUNK ? w->t - i : CHUNK;
        pg_dense_multiply (0, v->s->ndof, 1, some, 1, green_column (v, i), v->s->ndof, x + i, some,
                           i ? 1 : a, y, v->s->ndof);
    }
}

/* Frees the columns; halves must be zero where they were not written, as fresh memory is. */
void columns_drop (inverse *v)
{
    for (size_t k = 0; k < v->columns.nchunk; k++) pg_free (v->columns.chunk[k]);
    v->columns.nchunk = 0;
}

void columns_free (inverse *v)
{
    green_columns *g = &v->columns;
    columns_drop (v);
    pg_free (g->half), pg_free (g->chunk), pg_free (g->rhs), pg_free (g->solved), pg_free (g->group);
}
