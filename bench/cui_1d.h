/* SPDX-License-Identifier: GPL-3.0-or-later
 * cui_1d.h: the bar of Cui 2022 figures 1 to 3 on the library's own rows: n cells of size D on [0, L], nodes
 * at their ends, shape functions of a linear basis with the cubic spline kernel, V_j = 1 (theory E4).
 * Included by the test and by the bench. */
#ifndef PERIGAL_BENCH_CUI_1D_H
#define PERIGAL_BENCH_CUI_1D_H
#include "perigal/approx.h"
#include "perigal/integration.h"
#include <math.h>

typedef struct { size_t cells; double L, D; pg_cloud cloud; pg_approx approx; } bar;

static inline pg_status bar_create (bar *out, const char *approximation, size_t cells, double L,
                                    double a_over_D)
{
    pg_status status = PG_OK;
    double D = L / (double) cells;
    *out = (bar){ cells,
                  L,
                  D,
                  { .dim = 1, .n = cells + 1, .h = D, .step = { D }, .thickness = 1 },
                  { .type = pg_approx_find (approximation),
                    .kernel = pg_kernel_find ("cubic_spline"),
                    .order = 1,
                    .shape = PG_RADIAL,
                    .horizon = a_over_D * D } };
    PG_ALLOC (out->cloud.x, cells + 1);
    PG_ALLOC (out->cloud.volume, cells + 1);
    for (size_t i = 0; i <= cells; i++) {
        out->cloud.x[i] = L * (double) i / (double) cells;
        out->cloud.volume[i] = i == 0 || i == cells ? D / 2 : D;
    }
done:
    return status;
}

static inline void bar_clear (bar *b) { pg_free (b->cloud.x), pg_free (b->cloud.volume); }

/* Rows at n places x; weight may be NULL. */
static inline pg_status bar_rows_at (pg_rows *out, const bar *b, size_t n, const double *x,
                                     const double *weight)
{
    pg_status status = PG_OK;
    PG_TRY (pg_rows_create (out, &b->approx, &b->cloud, n, x, weight, NULL, NULL));
    PG_TRY (b->approx.type->evaluate (&b->approx, &b->cloud, out, NULL, n, NULL, 1));
done:
    return status;
}

/* Rows of an integration: points = 0: at the nodes, 1 to 5: Gauss points per cell. */
static inline pg_status bar_rows (pg_rows *out, const bar *b, int points)
{
    pg_status status = PG_OK;
    double gx[5], gw[5], *x = NULL, *weight = NULL;
    size_t n = b->cells * (size_t) points;
    *out = (pg_rows) { 0 };
    if (points == 0) return bar_rows_at (out, b, b->cloud.n, b->cloud.x, b->cloud.volume);
    pg_gauss_rule (points, gx, gw);
    PG_ALLOC (x, n);
    PG_ALLOC (weight, n);
    for (size_t q = 0; q < n; q++) {
        x[q] = b->D * ((double) (q / (size_t) points) + 0.5 + 0.5 * gx[q % (size_t) points]);
        weight[q] = 0.5 * b->D * gw[q % (size_t) points];
    }
    PG_TRY (bar_rows_at (out, b, n, x, weight));
done:
    pg_free (x), pg_free (weight);
    return status;
}

/* Figure 2: max_I |int N_I,x - (N_I (L) - N_I (0))|, the out-of-balance force of a bar under stress 1. */
static inline pg_status bar_imbalance (const bar *b, int points, double *out)
{
    pg_status status = PG_OK;
    pg_rows inside = { 0 }, end = { 0 };
    double *f = NULL, ends[2] = { 0, b->L };
    PG_ALLOC (f, b->cloud.n);
    PG_TRY (bar_rows (&inside, b, points));
    PG_TRY (bar_rows_at (&end, b, 2, ends, NULL));
    for (size_t q = 0; q < inside.n; q++)
        for (size_t e = inside.family.start[q]; e < inside.family.start[q + 1]; e++)
            f[inside.family.node[e]] += inside.weight[q] * inside.dN[e];
    for (size_t q = 0; q < 2; q++)
        for (size_t e = end.family.start[q]; e < end.family.start[q + 1]; e++)
            f[end.family.node[e]] -= (q ? 1 : -1) * end.N[e];
    *out = 0;
    for (size_t i = 0; i < b->cloud.n; i++) *out = fmax (*out, fabs (f[i]));
done:
    pg_free (f);
    pg_rows_clear (&inside), pg_rows_clear (&end);
    return status;
}

/* Gauss elimination with row pivots, n x n; b becomes x. */
static inline int bar_eliminate (size_t n, double *A, double *b)
{
    for (size_t k = 0; k < n; k++) {
        size_t top = k;
        for (size_t i = k + 1; i < n; i++) if (fabs (A[i*n + k]) > fabs (A[top*n + k])) top = i;
        if (A[top*n + k] == 0) return 0;
        for (size_t j = 0; j < n; j++) { double s = A[k*n + j]; A[k*n + j] = A[top*n + j], A[top*n + j] = s; }
        double s = b[k];
        b[k] = b[top], b[top] = s;
        for (size_t i = k + 1; i < n; i++) {
            double c = A[i*n + k] / A[k*n + k];
            for (size_t j = k; c != 0 && j < n; j++) A[i*n + j] -= c * A[k*n + j];
            b[i] -= c * b[k];
        }
    }
    for (size_t i = n; i-- > 0;) {
        for (size_t j = i + 1; j < n; j++) b[i] -= A[i*n + j] * b[j];
        b[i] /= A[i*n + i];
    }
    return 1;
}

/* -u'' = 1, u (0) = 0, u' (L) = 0 */
static inline double bar_exact (const bar *b, double x) { return x * (b->L - 0.5 * x); }

/* Coefficients (cloud.n + 1, the last is the multiplier) of -u'' = 1 with u (0) = 0 by a Lagrange
 * multiplier. */
static inline pg_status bar_solve (const bar *b, int points, double *d)
{
    pg_status status = PG_OK;
    pg_rows inside = { 0 }, end = { 0 };
    double *A = NULL, zero = 0;
    size_t n = b->cloud.n, m = n + 1;
    PG_ALLOC (A, m * m);
    PG_TRY (bar_rows (&inside, b, points));
    PG_TRY (bar_rows_at (&end, b, 1, &zero, NULL));
    for (size_t i = 0; i < m; i++) d[i] = 0;
    for (size_t q = 0; q < inside.n; q++) {
        const pg_family *f = &inside.family;
        for (size_t e = f->start[q]; e < f->start[q + 1]; e++) {
            size_t i = (size_t) f->node[e];
            d[i] += inside.weight[q] * inside.N[e];
            for (size_t g = f->start[q]; g < f->start[q + 1]; g++)
                A[i * m + (size_t) f->node[g]] += inside.weight[q] * inside.dN[e] * inside.dN[g];
        }
    }
    for (size_t e = 0; e < end.family.start[1]; e++) {
        size_t i = (size_t) end.family.node[e];
        A[i*m + n] = A[n*m + i] = end.N[e];
    }
    if (!bar_eliminate (m, A, d)) PG_FAIL (PG_E_SINGULAR, "the bar's matrix is singular");
done:
    pg_free (A);
    pg_rows_clear (&inside), pg_rows_clear (&end);
    return status;
}

/* |u - u exact| / |u exact| in L2, by 5 Gauss points per cell. */
static inline pg_status bar_error_of (const bar *b, const double *d, double *out)
{
    pg_status status = PG_OK;
    pg_rows fine = { 0 };
    double off = 0, size = 0;
    PG_TRY (bar_rows (&fine, b, 5));
    for (size_t q = 0; q < fine.n; q++) {
        double u = 0, exact = bar_exact (b, fine.x[q]);
        for (size_t e = fine.family.start[q]; e < fine.family.start[q + 1]; e++)
            u += fine.N[e] * d[fine.family.node[e]];
        off += fine.weight[q] * (u - exact) * (u - exact), size += fine.weight[q] * exact * exact;
    }
    *out = sqrt (off / size);
done:
    pg_rows_clear (&fine);
    return status;
}

/* Figure 3 */
static inline pg_status bar_error (const bar *b, int points, double *out)
{
    pg_status status = PG_OK;
    double *d = NULL;
    PG_ALLOC (d, b->cloud.n + 1);
    PG_TRY (bar_solve (b, points, d));
    PG_TRY (bar_error_of (b, d, out));
done:
    pg_free (d);
    return status;
}
#endif
