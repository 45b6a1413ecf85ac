/* SPDX-License-Identifier: GPL-3.0-or-later
 * Dense matrices of some hundred unknowns, column by column, by BLAS and LAPACK: products, LU with partial
 * pivoting of general matrices. */
#include "suitesparse.h"
#include "perigal/linalg.h"
#include <math.h>

/* Until BLAS is loaded, the environment says how many threads it starts with. */
int pg_linear_threads (int threads)
{
    int before = pg_blas.openblas_get_num_threads ? openblas_get_num_threads () : threads;
    if (pg_blas.openblas_set_num_threads) openblas_set_num_threads (threads);
    return before;
}

pg_status pg_dense_lu (size_t n, double *A, size_t nrhs, double *b)
{
    pg_status status = PG_OK;
    int order = (int) n, columns = (int) nrhs, info = 0, *pivot = NULL;
    if (n == 0 || nrhs == 0) return PG_OK;
    PG_TRY (pg_blas_load ());
    PG_ALLOC (pivot, n);
    dgesv_ (&order, &columns, A, &order, pivot, b, &order, &info);
    if (info) PG_FAIL (PG_E_SINGULAR, "a dense matrix of %zu unknowns is singular (pivot %d)", n, info);
done:
    pg_free (pivot);
    return status;
}

/* Only a pivot that is exactly zero counts as failure: the accuracy of the factors shows in the residual. */
int pg_dense_factor (size_t n, double *A, size_t lda, int *pivot)
{
    int order = (int) n, width = (int) lda, info = 0;
    if (pg_blas_load () != PG_OK) return 0;
    if (n) dgetrf_ (&order, &order, A, &width, pivot, &info);
    return info == 0;
}

void pg_dense_substitute (size_t n, const double *A, size_t lda, const int *pivot, size_t nrhs, double *b,
                          size_t ldb)
{
    int order = (int) n, width = (int) lda, columns = (int) nrhs, stride = (int) ldb, info = 0;
    if (n && nrhs) dgetrs_ ("N", &order, &columns, A, &width, pivot, b, &stride, &info);
}

/* For one column, dgemv is faster than dgemm. Without BLAS, whose absence pg_last_error reports, C becomes
 * NaN, so that nothing can be concluded from it. */
void pg_dense_multiply (int transposed, size_t m, size_t n, size_t k, double alpha, const double *A,
                        size_t lda, const double *B, size_t ldb, double beta, double *C, size_t ldc)
{
    int rows = (int) m, columns = (int) n, inner = (int) k, la = (int) lda, lb = (int) ldb, lc = (int) ldc,
        one = 1;
    const char *op = transposed ? "T" : "N";
    if (m == 0 || n == 0) return;
    if (pg_blas_load () != PG_OK) {
        for (size_t j = 0; j < n; j++) for (size_t i = 0; i < m; i++) C[j * ldc + i] = NAN;
        return;
    }
    if (n == 1 && k > 0)
        dgemv_ (op, transposed ? &inner : &rows, transposed ? &rows : &inner, &alpha, A, &la, B, &one, &beta,
                C, &one);
    else dgemm_ (op, "N", &rows, &columns, &inner, &alpha, A, &la, B, &lb, &beta, C, &lc);
}

void pg_dense_add_product (size_t m, size_t n, size_t k, const double *A, const double *B, double *C)
{
    int rows = (int) m, columns = (int) n, inner = (int) k;
    double one = 1;
    if (m && n && k)
        dgemm_ ("N", "T", &rows, &columns, &inner, &one, A, &rows, B, &columns, &one, C, &rows);
}
