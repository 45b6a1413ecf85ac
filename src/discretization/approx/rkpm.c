/* SPDX-License-Identifier: GPL-3.0-or-later
 * The reproducing kernel particle method (Liu, Jun and Zhang 1995) with the exact derivative
 * of its shape functions (Cui 2022, equation (19); doc/method.md E2):
 *
 *   N_j   = b.p_j w_j,   b = A^-1 p (0)
 *   N_j,k = b,k.p_j w_j + b.p_j,k w_j + b.p_j w_j,k,     A b,k = - A,k b
 *   A,k b = sum_j p_j (w_j,k b.p_j + w_j b.p_j,k) + sum_j w_j (b.p_j) p_j,k
 *
 * The last sum is sum_j N_j p_j,k = - e_k / a, since derivatives of basis functions are
 * reproduced themselves. This saves the sum over all pairs of basis functions for each
 * neighbour. */
#include "entries.h"
#include "moment.h"

/* One entry of b in lane 0, those of r for all k in lanes 1 to 3. */
typedef double four __attribute__ ((vector_size (32), aligned (8)));

#define INLINE static inline __attribute__ ((always_inline))

/* N and r = a A,k b for all k (dim x size). The gradient of b . p at each bond is kept in s->dk. */
INLINE void rates (const pg_neighbourhood *s, int dim, int order, int size, const double *b, double *N,
                   double r[3][PG_BASIS_MAX])
{
    four sum[PG_BASIS_MAX] = { 0 };
    for (int k = 0; k < dim; k++) sum[1 + k][1 + k] = -1;
    for (size_t j = 0; j < s->n; j++) {
        const double *p = s->p + j * (size_t) size, *slope = s->slope + j * (size_t) dim;
        double value = 0, *rise = s->dk + j * (size_t) dim;
        four c = { 0 };
        for (int m = 0; m < size; m++) value += b[m] * p[m];
        N[s->entry[j]] = s->w[j] * value;
        pg_basis_slope (dim, order, s->z + j * (size_t) dim, b, rise); /* p_j,k = -(1/a) dp/dz_k */
        for (int k = 0; k < dim; k++) c[1 + k] = slope[k] * value - s->w[j] * rise[k];
        for (int m = 0; m < size; m++) sum[m] += c * p[m];
    }
    for (int k = 0; k < dim; k++) for (int m = 0; m < size; m++) r[k][m] = sum[m][1 + k];
}

/* The three terms of the derivative for each bond; r = -a b,k. */
INLINE void gradients (const pg_neighbourhood *s, size_t dim, int size, const double *b,
                       double r[3][PG_BASIS_MAX], double *dN)
{
    four all[PG_BASIS_MAX] = { 0 };
    for (int m = 0; m < size; m++) {
        all[m][0] = b[m];
        for (size_t k = 0; k < dim; k++) all[m][1 + k] = r[k][m];
    }
    for (size_t j = 0; j < s->n; j++) {
        const double *p = s->p + j * (size_t) size, *slope = s->slope + j * dim, *rise = s->dk + j * dim;
        four sum = { 0 };                              /* b.p_j, then r.p_j */
        for (int m = 0; m < size; m++) sum += p[m] * all[m];
        for (size_t k = 0; k < dim; k++)
            dN[s->entry[j] * dim + k] = (slope[k] * sum[0] - s->w[j] * (rise[k] + sum[1 + k])) / s->a;
    }
}

/* Calls `rates`, for the usual bases with all loop lengths known. */
PG_WIDE static void moment_rate (const pg_neighbourhood *s, const double *b, double *N,
                                 double r[3][PG_BASIS_MAX])
{
    if (s->dim == 2 && s->size == 6) rates (s, 2, 2, 6, b, N, r);
    else if (s->dim == 3 && s->size == 10) rates (s, 3, 2, 10, b, N, r);
    else if (s->dim == 2 && s->size == 3) rates (s, 2, 1, 3, b, N, r);
    else if (s->dim == 3 && s->size == 4) rates (s, 3, 1, 4, b, N, r);
    else rates (s, s->dim, s->order, s->size, b, N, r);
}

PG_WIDE static void derivatives (const pg_neighbourhood *s, const double *b, double r[3][PG_BASIS_MAX],
                                 double *dN)
{
    if (s->dim == 2 && s->size == 6) gradients (s, 2, 6, b, r, dN);
    else if (s->dim == 3 && s->size == 10) gradients (s, 3, 10, b, r, dN);
    else if (s->dim == 2 && s->size == 3) gradients (s, 2, 3, b, r, dN);
    else if (s->dim == 3 && s->size == 4) gradients (s, 3, 4, b, r, dN);
    else gradients (s, (size_t) s->dim, s->size, b, r, dN);
}

/* Computes N, then b,k, then the derivatives. */
static void fill (const pg_neighbourhood *s, double *N, double *dN)
{
    double b[PG_BASIS_MAX], r[3][PG_BASIS_MAX];
    pg_neighbourhood_solve (s, 0, b);
    moment_rate (s, b, N, r);
    for (int k = 0; k < s->dim; k++) pg_neighbourhood_invert (s, r[k]);
    derivatives (s, b, r, dN);
}

/* N alone, by the same operations in the same order, so with the same bits. */
static void values (const pg_neighbourhood *s, double *N)
{
    double b[PG_BASIS_MAX];
    pg_neighbourhood_solve (s, 0, b);
    pg_neighbourhood_shape (s, b, N);
}

static const pg_formula formula = { .about_node = 0, .fill = fill, .values = values };

static pg_status evaluate (const pg_approx *a, const pg_cloud *cloud, pg_rows *rows,
                           const unsigned char *alive, size_t count, const size_t *list, int threads)
{
    return pg_moment_evaluate (&formula, a, cloud, rows, alive, count, list, threads);
}

const pg_approx_type pg_approx_rkpm = {
    .name = "rkpm",
    .summary = "reproducing kernel particle method: exact derivatives of the shape functions",
    .use_volume = 0,
    .exact = 1,
    .tip = { .linear = 0.2, .quadratic = 0.29, .nodal = 0.75 },
    .evaluate = evaluate
};
