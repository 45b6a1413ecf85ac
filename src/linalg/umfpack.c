/* SPDX-License-Identifier: GPL-3.0-or-later
 * Sparse LU factorisation P R A Q = L U for unsymmetric or indefinite matrices, by UMFPACK of SuiteSparse
 * (64-bit interface), with its iterative refinement. */
#include "suitesparse.h"
#include "perigal/linalg.h"
#include <string.h>

/* State of the solver. */
typedef struct {
    /* The matrix as UMFPACK wants it: both triangles of a symmetric A, else a copy. */
    pg_sparse F;
    /* Where each entry of F comes from: F.value[k] = A.value[from[k]]. */
    long *from;
    /* UMFPACK's symbolic and numeric factors. */
    void *symbolic, *numeric;
    double control[UMFPACK_CONTROL], flops, entries;
} lu;

static void lu_free (void **self)
{
    lu *u = *self;
    if (!u) return;
    umfpack_dl_free_symbolic (&u->symbolic);
    umfpack_dl_free_numeric (&u->numeric);
    pg_sparse_clear (&u->F);
    pg_free (u->from);
    pg_free (u);
    *self = NULL;
}

/* Pattern of F, rows ascending in each column, and `from`. */
static pg_status expand (lu *u, const pg_sparse *A)
{
    pg_status status = PG_OK;
    long *fill = NULL;
    size_t nnz = (size_t) A->start[A->ncol] * (A->symmetric ? 2 : 1);
    PG_TRY (pg_sparse_create (&u->F, A->nrow, A->ncol, nnz, 0));
    PG_ALLOC (u->from, nnz);
    PG_ALLOC (fill, A->ncol);
    /* Numbers of entries of each column, with the lower triangle of a symmetric A. */
    for (size_t j = 0; j < A->ncol; j++)
        for (long p = A->start[j]; p < A->start[j + 1]; p++) {
            u->F.start[j + 1]++;
            if (A->symmetric && (size_t) A->row[p] != j) u->F.start[A->row[p] + 1]++;
        }
    for (size_t j = 0; j < A->ncol; j++) u->F.start[j + 1] += u->F.start[j], fill[j] = u->F.start[j];
    /* Entries of the upper triangle first: all rows i <= j arrive before those i > j, so that rows ascend. */
    for (size_t j = 0; j < A->ncol; j++)
        for (long p = A->start[j]; p < A->start[j + 1]; p++)
            u->F.row[fill[j]] = A->row[p], u->from[fill[j]++] = p;
    if (A->symmetric)
        for (size_t j = 0; j < A->ncol; j++)
            for (long p = A->start[j]; p < A->start[j + 1]; p++) {
                size_t i = (size_t) A->row[p];
                if (i != j) u->F.row[fill[i]] = (long) j, u->from[fill[i]++] = p;
            }
done:
    pg_free (fill);
    return status;
}

/* The symbolic analysis waits for the first values, which UMFPACK uses to choose its strategy. */
static pg_status lu_analyse (void **self, const pg_sparse *A, const pg_linear_options *options)
{
    pg_status status = PG_OK;
    lu *u = NULL;
    (void) options;
    PG_TRY (pg_umfpack_load ());
    PG_ALLOC (u, 1);
    *self = u;
    umfpack_dl_defaults (u->control);
    PG_TRY (expand (u, A));
done:
    if (status != PG_OK) lu_free (self);
    return status;
}

/* A ratio of smallest to largest pivot (of scaled rows) below 1e-14 counts as singular: no digit of the
 * solution would be right. */
static pg_status lu_factor (void *self, const pg_sparse *A)
{
    pg_status status = PG_OK;
    lu *u = self;
    double info[UMFPACK_INFO];
    for (long k = 0; k < u->F.start[u->F.ncol]; k++) u->F.value[k] = A->value[u->from[k]];
    umfpack_dl_free_numeric (&u->numeric);
    long code = 0;
    /* UMFPACK uses the first values to choose its strategy. */
    if (!u->symbolic)
        code = umfpack_dl_symbolic ((long) A->nrow, (long) A->ncol, u->F.start, u->F.row, u->F.value,
                                    &u->symbolic, u->control, info);
    if (code == UMFPACK_OK)
        code = umfpack_dl_numeric (u->F.start, u->F.row, u->F.value, u->symbolic, &u->numeric, u->control,
                                   info);
    /* Ratio of the smallest to the largest pivot of the scaled rows. */
    int lost = code == UMFPACK_OK && !(info[UMFPACK_RCOND] > 1e-14);
    if (code == UMFPACK_WARNING_singular_matrix || lost)
        PG_FAIL (PG_E_SINGULAR, "the matrix of %zu unknowns is singular: a part that can move freely?",
                 A->ncol);
    if (code != UMFPACK_OK)
        PG_FAIL (PG_E_MEMORY, "the LU factorization of %zu unknowns failed (UMFPACK status %ld)", A->ncol,
                 code);
    u->flops = info[UMFPACK_FLOPS], u->entries = info[UMFPACK_LNZ] + info[UMFPACK_UNZ];
done:
    return status;
}

/* Solves with UMFPACK's iterative refinement, which it does by default. */
static pg_status lu_solve (void *self, size_t nrhs, const double *b, double *x)
{
    pg_status status = PG_OK;
    lu *u = self;
    size_t n = u->F.ncol;
    for (size_t k = 0; k < nrhs; k++) {
        long code = umfpack_dl_solve (UMFPACK_A, u->F.start, u->F.row, u->F.value, x + k * n, b + k * n,
                                      u->numeric, u->control, NULL);
        if (code != UMFPACK_OK)
            PG_FAIL (code == UMFPACK_WARNING_singular_matrix ? PG_E_SINGULAR : PG_E_MEMORY,
                     "an LU solve failed (UMFPACK status %ld)", code);
    }
done:
    return status;
}

static void lu_info (const void *self, pg_linear_info *info)
{
    const lu *u = self;
    *info = (pg_linear_info) { .ordering = "umfpack", .factor_entries = u->entries, .flops = u->flops };
}

const pg_linear_type pg_linear_umfpack = {
    "umfpack", "sparse LU factorization (SuiteSparse UMFPACK), for unsymmetric or indefinite matrices", 0, 1,
    lu_analyse, lu_factor, lu_solve, NULL, NULL, lu_info, lu_free, NULL
};
