/* SPDX-License-Identifier: GPL-3.0-or-later
 * systems.h: sparse test matrices and their dense counterparts. */
#ifndef PERIGAL_TEST_SYSTEMS_H
#define PERIGAL_TEST_SYSTEMS_H
#include "check.h"
#include "perigal/linalg.h"

static uint64_t systems_seed = 88172645463325252u;
static inline double random_number (void)              /* in [-1, 1) */
{
    systems_seed ^= systems_seed << 13, systems_seed ^= systems_seed >> 7, systems_seed ^= systems_seed << 17;
    return (double) (systems_seed >> 11) / 4503599627370496.0 - 1;
}

/* Entries of a matrix in any order; the last word on a place counts. */
typedef struct { size_t nrow, ncol; double *a; unsigned char *in; } dense;
static inline dense dense_new (size_t nrow, size_t ncol)
{
    dense D = { nrow, ncol, pg_calloc (nrow * ncol, sizeof (double)), pg_calloc (nrow * ncol, 1) };
    assert_true (D.a && D.in);
    return D;
}
static inline void dense_free (dense *D) { pg_free (D->a), pg_free (D->in); }
static inline void dense_set (dense *D, size_t i, size_t j, double value)
{
    D->a[i * D->ncol + j] = value, D->in[i * D->ncol + j] = 1;
}
static inline double dense_at (const dense *D, size_t i, size_t j) { return D->a[i * D->ncol + j]; }

/* The pattern is where values were set, zeros included. */
static inline pg_sparse sparse_of (const dense *D, int symmetric)
{
    pg_sparse A;
    size_t nnz = 0;
    for (size_t i = 0; i < D->nrow; i++)
        for (size_t j = 0; j < D->ncol; j++) nnz += D->in[i * D->ncol + j] && (!symmetric || i <= j);
    check_ok (pg_sparse_create (&A, D->nrow, D->ncol, nnz, symmetric));
    nnz = 0;
    for (size_t j = 0; j < D->ncol; j++) {
        for (size_t i = 0; i < D->nrow; i++)
            if (D->in[i * D->ncol + j] && (!symmetric || i <= j))
                A.row[nnz] = (long) i, A.value[nnz++] = dense_at (D, i, j);
        A.start[j + 1] = (long) nnz;
    }
    return A;
}

static inline void multiply (const dense *D, const double *x, double *y)
{
    for (size_t i = 0; i < D->nrow; i++) {
        y[i] = 0;
        for (size_t j = 0; j < D->ncol; j++) y[i] += dense_at (D, i, j) * x[j];
    }
}

/* Laplacian of a lattice of side^dim nodes with random SPD blocks per edge and a share of the identity: SPD,
 * full pattern. */
static inline dense random_laplacian (size_t side, int dim, size_t block)
{
    size_t n = 1, step[3] = { 1, side, side * side };
    for (int k = 0; k < dim; k++) n *= side;
    dense D = dense_new (n * block, n * block);
    for (size_t i = 0; i < n * block; i++) dense_set (&D, i, i, 0.05);
    for (size_t i = 0; i < n; i++)
        for (int k = 0; k < dim; k++) {
            size_t j = i + step[k];
            double G[9], S[9];
            if (i / step[k] % side + 1 == side) continue;
            for (size_t q = 0; q < block * block; q++) G[q] = random_number ();
            for (size_t a = 0; a < block; a++)
                for (size_t b = 0; b < block; b++) {
                    S[a * block + b] = a == b ? 0.3 : 0;
                    for (size_t c = 0; c < block; c++)
                        S[a * block + b] += G[a * block + c] * G[b * block + c];
                }
            for (size_t a = 0; a < block; a++)
                for (size_t b = 0; b < block; b++) {
                    double s = S[a * block + b];
                    dense_set (&D, i * block + a, i * block + b,
                               dense_at (&D, i * block + a, i * block + b) + s);
                    dense_set (&D, j * block + a, j * block + b,
                               dense_at (&D, j * block + a, j * block + b) + s);
                    dense_set (&D, i * block + a, j * block + b, -s);
                    dense_set (&D, j * block + b, i * block + a, -s);
                }
        }
    return D;
}

/* max |A x - b| over columns, relative to max |b| */
static inline double misfit (const dense *D, size_t nrhs, const double *x, const double *b)
{
    double worst = 0, top = 0, *y = pg_calloc (D->nrow, sizeof *y);
    for (size_t k = 0; k < nrhs; k++) {
        multiply (D, x + k * D->ncol, y);
        for (size_t i = 0; i < D->nrow; i++)
            worst = fmax (worst, fabs (y[i] - b[k * D->nrow + i])),
            top = fmax (top, fabs (b[k * D->nrow + i]));
    }
    pg_free (y);
    return worst / top;
}
#endif
