/* SPDX-License-Identifier: GPL-3.0-or-later
 * Dense systems of some hundred unknowns, general matrices: LU with partial pivoting by LAPACK. */
#include "perigal/linalg.h"

/* LAPACK, as Fortran calls it. */
void dgesv_ (const int *n, const int *nrhs, double *a, const int *lda, int *pivot, double *b, const int *ldb,
             int *info);

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
