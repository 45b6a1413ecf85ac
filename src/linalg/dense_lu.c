/* SPDX-License-Identifier: GPL-3.0-or-later
 * Dense matrices of some hundred unknowns, column by column, by BLAS and LAPACK: products, LU with partial
 * pivoting of general matrices. */
#include "perigal/linalg.h"

/* LAPACK and BLAS, as Fortran calls them. */
void dgesv_ (const int *n, const int *nrhs, double *a, const int *lda, int *pivot, double *b, const int *ldb,
             int *info);
void dgetrf_ (const int *m, const int *n, double *a, const int *lda, int *pivot, int *info);
void dgetrs_ (const char *trans, const int *n, const int *nrhs, const double *a, const int *lda,
              const int *pivot, double *b, const int *ldb, int *info);
void dgemm_ (const char *transa, const char *transb, const int *m, const int *n, const int *k,
             const double *alpha, const double *a, const int *lda, const double *b, const int *ldb,
             const double *beta, double *c, const int *ldc);
void dgemv_ (const char *trans, const int *m, const int *n, const double *alpha, const double *a,
             const int *lda, const double *x, const int *incx, const double *beta, double *y,
             const int *incy);

pg_status pg_dense_lu (size_t n, double *A, size_t nrhs, double *b)
{
    pg_status status = PG_OK;
    int order = (int) n, columns = (int) nrhs, info = 0, *pivot = NULL;
    if (n == 0 || nrhs == 0) return PG_OK;
    PG_ALLOC (pivot, n);
    dgesv_ (&order, &columns, A, &order, pivot, b, &order, &info);
    if (info) PG_FAIL (PG_E_SINGULAR, "a dense matrix of %zu unknowns is singular (pivot %d)", n, info);
done:
    pg_free (pivot);
    return status;
}

/* A pivot that is exactly zero is the only failure: how good the factors are the residual tells. */
int pg_dense_factor (size_t n, double *A, size_t lda, int *pivot)
{
    int order = (int) n, width = (int) lda, info = 0;
    if (n) dgetrf_ (&order, &order, A, &width, pivot, &info);
    return info == 0;
}

void pg_dense_substitute (size_t n, const double *A, size_t lda, const int *pivot, size_t nrhs, double *b,
                          size_t ldb)
{
    int order = (int) n, width = (int) lda, columns = (int) nrhs, stride = (int) ldb, info = 0;
    if (n && nrhs) dgetrs_ ("N", &order, &columns, A, &width, pivot, b, &stride, &info);
}

/* One column is a product with a vector, which BLAS does at the speed of memory. */
void pg_dense_multiply (int transposed, size_t m, size_t n, size_t k, double alpha, const double *A,
                        size_t lda, const double *B, size_t ldb, double beta, double *C, size_t ldc)
{
    int rows = (int) m, columns = (int) n, inner = (int) k, la = (int) lda, lb = (int) ldb, lc = (int) ldc,
        one = 1;
    const char *op = transposed ? "T" : "N";
    if (m == 0 || n == 0) return;
    if (n == 1 && k > 0)
        dgemv_ (op, transposed ? &inner : &rows, transposed ? &rows : &inner, &alpha, A, &la, B, &one, &beta,
                C, &one);
    else dgemm_ (op, "N", &rows, &columns, &inner, &alpha, A, &la, B, &lb, &beta, C, &lc);
}
