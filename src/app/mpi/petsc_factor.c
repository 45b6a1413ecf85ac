/* SPDX-License-Identifier: GPL-3.0-or-later
 * A linear solver that ranks share: matrix and factor are distributed by rows, by PETSc (Balay et al.,
 * PETSc/TAO Users Manual) and MUMPS (Amestoy et al. 2001, SIAM J. Matrix Anal. Appl. 23). Every rank calls
 * with the same matrix and right-hand sides (lock-step, perigal/ranks.h), keeps its own rows, and gets the
 * whole solution with the same bits. */
#include "petsc_factor.h"
#include "petsc_library.h"
#include <mpi.h>
#include <string.h>

/* State of the solver. This rank has the rows first .. last - 1 of both triangles: start (rows + 1), column,
 * and the entry of A from which each value is copied. */
typedef struct {
    Mat   A, F;
    int   size, *count, *begin;                        /* number of ranks; rows of each, and its first row */
    long  first, last;
    size_t n;
    PetscInt *start, *column;
    long  *from;
    double *value, *local;  size_t cap_local;
    double entries, flops;
    PetscInt room;                                     /* extra memory of MUMPS, percent */
    PetscInt order;                                    /* number of the ordering in MUMPS */
} shared;

enum { FIRST_ROOM = 40, MOST_ROOM = 1000 };

static pg_status said (PetscErrorCode code, const char *what) { return petsc_said (code, what); }

static void shared_free (void **self)
{
    shared *s = *self;
    if (!s) return;
    if (s->F) MatDestroy (&s->F);
    if (s->A) MatDestroy (&s->A);
    pg_free (s->count), pg_free (s->begin), pg_free (s->start), pg_free (s->column), pg_free (s->from),
        pg_free (s->value), pg_free (s->local);
    pg_free (s);
    *self = NULL;
}

/* Gives every rank the same number of nodes, with all their rows. */
static pg_status divide_rows (shared *s, int block)
{
    pg_status status = PG_OK;
    int rank = 0;
    long nodes = (long) s->n / block;
    MPI_Comm_rank (MPI_COMM_WORLD, &rank);
    MPI_Comm_size (MPI_COMM_WORLD, &s->size);
    PG_ALLOC (s->count, (size_t) s->size);
    PG_ALLOC (s->begin, (size_t) s->size + 1);
    for (int r = 0; r <= s->size; r++) s->begin[r] = (int) (nodes * r / s->size * block);
    s->begin[s->size] = (int) s->n;
    for (int r = 0; r < s->size; r++) s->count[r] = s->begin[r + 1] - s->begin[r];
    s->first = s->begin[rank], s->last = s->begin[rank + 1];
done:
    return status;
}

/* Notes entry p of A (one triangle) at (row, column), if this rank has the row. */
static void note (shared *s, long row, long column, long p, PetscInt *fill)
{
    if (row < s->first || row >= s->last) return;
    PetscInt at = fill[row - s->first]++;
    s->column[at] = (PetscInt) column, s->from[at] = p;
}

/* Builds the rows of this rank from the triangle A. */
static pg_status take_rows (shared *s, const pg_sparse *A)
{
    pg_status status = PG_OK;
    size_t rows = (size_t) (s->last - s->first);
    PetscInt *fill = NULL;
    PG_ALLOC (s->start, rows + 1);
    PG_ALLOC (fill, rows + 1);
    for (size_t j = 0; j < A->ncol; j++)
        for (long p = A->start[j]; p < A->start[j + 1]; p++) {
            long i = A->row[p];
            if (i >= s->first && i < s->last) s->start[i - s->first + 1]++;
            if ((size_t) i != j && (long) j >= s->first && (long) j < s->last)
                s->start[(long) j - s->first + 1]++;
        }
    for (size_t r = 0; r < rows; r++) s->start[r + 1] += s->start[r], fill[r] = s->start[r];
    PG_ALLOC (s->column, (size_t) s->start[rows]);
    PG_ALLOC (s->from, (size_t) s->start[rows]);
    PG_ALLOC (s->value, (size_t) s->start[rows]);
    /* each row gets its columns up to the diagonal first, then those beyond it: columns ascend */
    for (size_t j = 0; j < A->ncol; j++)
        for (long p = A->start[j]; p < A->start[j + 1]; p++)
            note (s, (long) j, A->row[p], p, fill);
    for (size_t j = 0; j < A->ncol; j++)
        for (long p = A->start[j]; p < A->start[j + 1]; p++)
            if ((size_t) A->row[p] != j) note (s, A->row[p], (long) j, p, fill);
done:
    pg_free (fill);
    return status;
}

static pg_status shared_analyse (void **self, const pg_sparse *A, const pg_linear_options *options)
{
    pg_status status = PG_OK;
    shared *s = NULL;
    if (A->ncol > PETSC_MAX_INT) return pg_error (PG_E_LIMIT, PG_HERE, "too many unknowns for PETSC");
    PG_TRY (petsc_load ());
    PG_ALLOC (s, 1);
    *self = s;
    s->n = A->ncol;
    PG_TRY (divide_rows (s, options->block > 0 ? options->block : 1));
    PG_TRY (take_rows (s, A));
done:
    if (status != PG_OK) shared_free (self);
    return status;
}

/* Fills the distributed matrix; its pattern stays, so that MUMPS analyses it once. */
static pg_status fill_matrix (shared *s, const pg_sparse *A)
{
    pg_status status = PG_OK;
    PetscInt rows = (PetscInt) (s->last - s->first);
    for (PetscInt k = 0; k < s->start[rows]; k++) s->value[k] = A->value[s->from[k]];
    if (!s->A) {
        PG_TRY (said (MatCreateMPIAIJWithArrays (MPI_COMM_WORLD, rows, rows, PETSC_DETERMINE,
                                                 PETSC_DETERMINE, s->start, s->column, s->value, &s->A),
                      "the matrix"));
        PG_TRY (said (MatSetOption (s->A, MAT_SYMMETRIC, PETSC_TRUE), "the matrix"));
        goto done;
    }
    for (PetscInt r = 0; r < rows; r++) {
        PetscInt row = (PetscInt) s->first + r;
        PG_TRY (said (MatSetValues (s->A, 1, &row, s->start[r + 1] - s->start[r], s->column + s->start[r],
                                    s->value + s->start[r], INSERT_VALUES), "the matrix"));
    }
    PG_TRY (said (MatAssemblyBegin (s->A, MAT_FINAL_ASSEMBLY), "the matrix"));
    PG_TRY (said (MatAssemblyEnd (s->A, MAT_FINAL_ASSEMBLY), "the matrix"));
done:
    return status;
}

/* Makes the symbolic factorization. room: memory that MUMPS may take beyond its prediction, for delayed
 * pivots, percent. */
static pg_status analyse (shared *s, PetscInt room)
{
    pg_status status = PG_OK;
    MatFactorInfo info;
    if (s->F) PG_TRY (said (MatDestroy (&s->F), "MUMPS"));
    PG_TRY (said (MatFactorInfoInitialize (&info), "the analysis"));
    PG_TRY (said (MatGetFactor (s->A, MATSOLVERMUMPS, MAT_FACTOR_CHOLESKY, &s->F), "MUMPS"));
    /* ordering by METIS, where MUMPS has it, on one rank: equal for any number of ranks */
    PG_TRY (said (MatMumpsSetIcntl (s->F, 28, 1), "MUMPS"));
    PG_TRY (said (MatMumpsSetIcntl (s->F, 7, 5), "MUMPS"));
    /* root without ScaLAPACK: its pivots count too */
    PG_TRY (said (MatMumpsSetIcntl (s->F, 13, 1), "MUMPS"));
    PG_TRY (said (MatMumpsSetIcntl (s->F, 14, room), "MUMPS"));
    PG_TRY (said (MatCholeskyFactorSymbolic (s->F, s->A, NULL, &info), "the analysis"));
    s->room = room;
done:
    return status;
}

/* Computes L D L' by MUMPS; the number of negative entries of D tells whether the matrix is positive
 * definite. If its memory was too small MUMPS has to begin with the analysis again. */
static pg_status shared_factor (void *self, const pg_sparse *A)
{
    pg_status status = PG_OK;
    shared *s = self;
    MatFactorInfo info;
    MatFactorError error = MAT_FACTOR_OUTMEMORY;
    PetscInt negative = 0, entries = 0, code = 0, detail = 0;
    PetscReal flops = 0;
    PG_TRY (fill_matrix (s, A));
    PG_TRY (said (MatFactorInfoInitialize (&info), "the factor"));
    if (!s->F) PG_TRY (analyse (s, FIRST_ROOM));
    for (;;) {
        PG_TRY (said (MatCholeskyFactorNumeric (s->F, s->A, &info), "the factorization"));
        PG_TRY (said (MatFactorGetError (s->F, &error), "the factorization"));
        if (error != MAT_FACTOR_OUTMEMORY || s->room > MOST_ROOM) break;
        PG_TRY (analyse (s, 2 * s->room));
    }
    PG_TRY (said (MatMumpsGetInfog (s->F, 1, &code), "the factorization"));
    PG_TRY (said (MatMumpsGetInfog (s->F, 2, &detail), "the factorization"));
    if (error == MAT_FACTOR_OUTMEMORY)
        PG_FAIL (PG_E_MEMORY, "no memory for the factor of %zu unknowns on %d ranks (MUMPS: %ld, %ld)", s->n,
                 s->size, (long) code, (long) detail);
    if (error != MAT_FACTOR_NOERROR)
        PG_FAIL (PG_E_NOT_SPD, "the matrix of %zu unknowns has no factor (MUMPS: %ld, %ld): a part that can "
                 "move freely?", s->n, (long) code, (long) detail);
    PG_TRY (said (MatMumpsGetInfog (s->F, 12, &negative), "the factorization"));
    if (negative > 0)
        PG_FAIL (PG_E_NOT_SPD, "the matrix of %zu unknowns is not positive definite: %ld pivots are negative",
                 s->n, (long) negative);
    PG_TRY (said (MatMumpsGetInfog (s->F, 7, &s->order), "the factorization"));
    PG_TRY (said (MatMumpsGetInfog (s->F, 29, &entries), "the factorization"));
    PG_TRY (said (MatMumpsGetRinfog (s->F, 3, &flops), "the factorization"));
    s->entries = entries < 0 ? -1e6 * entries : entries, s->flops = flops;
done:
    return status;
}

/* Solves for several right-hand sides at once: each rank gives its own rows of b and gets all rows of x. */
static pg_status shared_solve (void *self, size_t nrhs, const double *b, double *x)
{
    pg_status status = PG_OK;
    shared *s = self;
    size_t rows = (size_t) (s->last - s->first);
    Mat B = NULL, X = NULL;
    PG_GROW (s->local, s->cap_local, 2 * rows * nrhs + 1);
    double *own = s->local, *found = s->local + rows * nrhs;
    for (size_t k = 0; k < nrhs; k++)
        memcpy (own + k * rows, b + k * s->n + s->first, rows * sizeof *own);
    PG_TRY (said (MatCreateDense (MPI_COMM_WORLD, (PetscInt) rows, PETSC_DECIDE, PETSC_DETERMINE,
                                  (PetscInt) nrhs, own, &B), "a solve"));
    PG_TRY (said (MatCreateDense (MPI_COMM_WORLD, (PetscInt) rows, PETSC_DECIDE, PETSC_DETERMINE,
                                  (PetscInt) nrhs, found, &X), "a solve"));
    PetscInt why = 0, detail = 0;
    if (MatMatSolve (s->F, B, X) != 0) {
        MatMumpsGetInfog (s->F, 1, &why), MatMumpsGetInfog (s->F, 2, &detail);
        PG_FAIL (PG_E_MEMORY, "a solve of %zu unknowns on %d ranks failed (MUMPS: %ld, %ld)", s->n, s->size,
                 (long) why, (long) detail);
    }
    for (size_t k = 0; k < nrhs; k++)
        if (MPI_Allgatherv (found + k * rows, (int) rows, MPI_DOUBLE, x + k * s->n, s->count, s->begin,
                            MPI_DOUBLE, MPI_COMM_WORLD) != MPI_SUCCESS)
            PG_FAIL (PG_E_FILE, "ranks lost each other in a solve");
done:
    if (B) MatDestroy (&B);
    if (X) MatDestroy (&X);
    return status;
}

static void shared_info (const void *self, pg_linear_info *info)
{
    static const char *const name[] = { "amd", "user", "amf", "scotch", "pord", "metis", "qamd" };
    const shared *s = self;
    int known = s->order >= 0 && s->order < (PetscInt) (sizeof name / sizeof *name);
    *info = (pg_linear_info) { .ordering = known ? name[s->order] : "none",
                               .factor_entries = s->entries, .flops = s->flops };
}

const pg_linear_type petsc_factor = {
    .name = "petsc",
    .summary = "L D L' on all ranks (PETSc, MUMPS)",
    .symmetric = 1, .factors = 1,
    .analyse = shared_analyse, .factor = shared_factor, .solve = shared_solve, .info = shared_info,
    .free = shared_free,
};

void petsc_give (void)
{
    pg_linear_add (&petsc_factor), pg_shared_preconditioner_give (&petsc_multigrid);
}

void petsc_take_back (void)
{
    pg_linear_add (NULL), pg_shared_preconditioner_give (NULL);
}
