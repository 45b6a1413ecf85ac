/* SPDX-License-Identifier: GPL-3.0-or-later
 * The preconditioner of ranks that divide the body: one cycle of smoothed aggregation (P. Vanek, J. Mandel
 * and M. Brezina, Computing 56 (1996) 179; PETSc's GAMG) with the rows that each rank owns, and the rigid
 * motions of the points as near null space. Nodes are numbered rank by rank. Prescribed unknowns have rows of
 * their own, coupled to no others. The rows are those of K, or of the first coarse grid on a lattice, to
 * which several ranks add (src/linalg/preconditioner/multilevel_ranks.c). */
#include "petsc_factor.h"
#include "petsc_library.h"
#include <mpi.h>
#include <stdio.h>
#include <string.h>

/* State of the preconditioner. Vectors of this rank have `n` nodes of `block` unknowns; node: their numbers
 * among the `held` points, owned ones and ghosts; fixed: 1 for prescribed unknowns. */
typedef struct {
    Mat    A;
    PC     pc;
    Vec    b, x;
    size_t n, block, held;
    int   *node;
    const unsigned char *fixed;
} multigrid;

static pg_status said (PetscErrorCode code, const char *what) { return petsc_said (code, what); }

static void multigrid_free (void **self)
{
    multigrid *m = *self;
    if (!m) return;
    if (m->pc) PCDestroy (&m->pc);
    if (m->A) MatDestroy (&m->A);
    if (m->b) VecDestroy (&m->b);
    if (m->x) VecDestroy (&m->x);
    pg_free (m->node);
    pg_free (m);
    *self = NULL;
}

/* Numbers all nodes held here, as doubles (exact below 2^53): owned nodes continue the numbers of lower
 * ranks; ghosts get theirs from their owners. */
static pg_status number_nodes (multigrid *m, const pg_subdomain *part, double **number)
{
    pg_status status = PG_OK;
    long long mine, before = 0;
    int rank = 0;
    PG_ALLOC (m->node, part->n);
    PG_ALLOC (*number, part->n);
    for (size_t i = 0; i < part->n; i++) if (part->owned[i]) m->node[m->n++] = (int) i;
    mine = (long long) m->n;
    MPI_Comm_rank (MPI_COMM_WORLD, &rank);
    if (MPI_Exscan (&mine, &before, 1, MPI_LONG_LONG, MPI_SUM, MPI_COMM_WORLD) != MPI_SUCCESS)
        PG_FAIL (PG_E_FILE, "ranks lost each other while they counted points");
    if (rank == 0) before = 0;
    for (size_t k = 0; k < m->n; k++) (*number)[m->node[k]] = (double) before + (double) k;
    PG_TRY (pg_subdomain_exchange (part, 1, *number));
done:
    return status;
}

/* ---- rows ---------------------------------------------------------------------------------------------- */
typedef struct {
    const pg_shared_rows *from;
    const double *number;
    int          *node;                                /* nodes coupled to one node */
    double       *value, *line;
    PetscInt     *column;
} reading;

static int is_fixed (const pg_shared_rows *s, size_t node, size_t k)
{
    return s->fixed && s->fixed[node * (size_t) s->block + k];
}

/* Counts the couplings of each row to nodes owned here and to others, for which PETSc has to allocate. */
static pg_status count_couplings (multigrid *m, reading *r, PetscInt *own, PetscInt *other)
{
    pg_status status = PG_OK;
    const pg_shared_rows *s = r->from;
    for (size_t k = 0; k < m->n; k++) {
        size_t count = s->rows.row (s->rows.context, (size_t) m->node[k], 0, r->node, NULL);
        PetscInt here = 0;
        for (size_t c = 0; c < count; c++) here += s->subdomain->owned[r->node[c]];
        if (count == 0) count = 1, here = 1;               /* the diagonal alone */
        for (size_t a = 0; a < m->block; a++)
            own[k * m->block + a] = here * (PetscInt) m->block,
            other[k * m->block + a] = ((PetscInt) count - here) * (PetscInt) m->block;
    }
    return status;
}

/* Sets the diagonal of a row of a node that is coupled to nothing. */
static pg_status put_unit (multigrid *m, PetscInt row, double value)
{
    return said (MatSetValues (m->A, 1, &row, 1, &row, &value, ADD_VALUES), "rows of the preconditioner");
}

/* Sets the rows of one node, with prescribed unknowns removed: their diagonal becomes *mean, the last
 * positive diagonal entry. */
static pg_status put_rows (multigrid *m, reading *r, size_t k, double *mean)
{
    pg_status status = PG_OK;
    const pg_shared_rows *s = r->from;
    size_t i = (size_t) m->node[k], b = m->block;
    size_t count = s->rows.row (s->rows.context, i, 0, r->node, r->value);
    for (size_t a = 0; a < b; a++) {
        PetscInt row = (PetscInt) r->number[i] * (PetscInt) b + (PetscInt) a;
        if (count == 0) PG_TRY (put_unit (m, row, *mean > 0 ? *mean : 1));
        for (size_t c = 0; c < count; c++) {
            size_t j = (size_t) r->node[c];
            for (size_t e = 0; e < b; e++) {
                double v = s->k * r->value[(c * b + a) * b + e];
                if (j == i && a == e && s->m != 0) v += s->m * s->mass[i * b + a];
                int out = is_fixed (s, i, a) || is_fixed (s, j, e);
                if (j == i && a == e) {
                    if (v > 0) *mean = v;
                    v = out || !(v > 0) ? (*mean > 0 ? *mean : 1) : v, out = 0;
                }
                r->column[c * b + e] = (PetscInt) r->number[j] * (PetscInt) b + (PetscInt) e;
                r->line[c * b + e] = out ? 0 : v;
            }
        }
        PG_TRY (said (MatSetValues (m->A, 1, &row, (PetscInt) (count * b), r->column, r->line, ADD_VALUES),
                      "rows of the preconditioner"));
    }
done:
    return status;
}

static pg_status make_matrix (multigrid *m, reading *r)
{
    pg_status status = PG_OK;
    PetscInt *own = NULL, *other = NULL, rows = (PetscInt) (m->n * m->block);
    double mean = 0;
    PG_ALLOC (own, m->n * m->block);
    PG_ALLOC (other, m->n * m->block);
    PG_TRY (count_couplings (m, r, own, other));
    PG_TRY (said (MatCreate (MPI_COMM_WORLD, &m->A), "the preconditioner"));
    PG_TRY (said (MatSetSizes (m->A, rows, rows, PETSC_DETERMINE, PETSC_DETERMINE), "the preconditioner"));
    PG_TRY (said (MatSetType (m->A, MATAIJ), "the preconditioner"));
    PG_TRY (said (MatSetBlockSize (m->A, (PetscInt) m->block), "the preconditioner"));
    PG_TRY (said (MatSeqAIJSetPreallocation (m->A, 0, own), "room for the preconditioner"));
    PG_TRY (said (MatMPIAIJSetPreallocation (m->A, 0, own, 0, other), "room for the preconditioner"));
    for (size_t k = 0; k < m->n; k++) PG_TRY (put_rows (m, r, k, &mean));
    PG_TRY (said (MatAssemblyBegin (m->A, MAT_FINAL_ASSEMBLY), "rows of the preconditioner"));
    PG_TRY (said (MatAssemblyEnd (m->A, MAT_FINAL_ASSEMBLY), "rows of the preconditioner"));
    PG_TRY (said (MatSetOption (m->A, MAT_SYMMETRIC, PETSC_TRUE), "the preconditioner"));
done:
    pg_free (own), pg_free (other);
    return status;
}

/* ---- rows that are sums over ranks --------------------------------------------------------------------- */
/* Lists the couplings of all nodes held: row, column and value of every entry, preceded by a 0 on the
 * diagonal of each row owned here, which PETSc must allocate. value NULL: counts the entries only. */
static size_t list_entries (const multigrid *m, reading *r, PetscInt *row, PetscInt *column, double *value)
{
    const pg_shared_rows *s = r->from;
    size_t at = 0, b = m->block;
    for (size_t k = 0; k < m->n * b; k++, at++) {
        if (!value) continue;
        row[at] = column[at] = (PetscInt) (r->number[m->node[k / b]] * (double) b) + (PetscInt) (k % b);
        value[at] = 0;
    }
    for (size_t i = 0; i < m->held; i++) {
        size_t count = s->rows.row (s->rows.context, i, 0, r->node, value ? r->value : NULL);
        for (size_t q = 0; q < count * b * b; q++, at++) {
            if (!value) continue;
            size_t c = q / (b * b), a = q / b % b, e = q % b;
            row[at] = (PetscInt) r->number[i] * (PetscInt) b + (PetscInt) a;
            column[at] = (PetscInt) r->number[r->node[c]] * (PetscInt) b + (PetscInt) e;
            value[at] = r->value[q];
        }
    }
    return at;
}

/* Sets the diagonal of rows without a positive one to the mean of the others: they are coupled to nothing. */
static pg_status fill_diagonal (multigrid *m)
{
    pg_status status = PG_OK;
    Vec d = NULL;
    PetscScalar *at;
    double sum[2] = { 0 };
    PG_TRY (said (MatCreateVecs (m->A, &d, NULL), "the preconditioner"));
    PG_TRY (said (MatGetDiagonal (m->A, d), "the preconditioner"));
    PG_TRY (said (VecGetArray (d, &at), "the preconditioner"));
    for (size_t k = 0; k < m->n * m->block; k++) if (at[k] > 0) sum[0] += at[k], sum[1]++;
    PG_TRY (pg_ranks_sum (2, sum));
    for (size_t k = 0; k < m->n * m->block; k++) at[k] = at[k] > 0 ? 0 : sum[1] > 0 ? sum[0] / sum[1] : 1;
    PG_TRY (said (VecRestoreArray (d, &at), "the preconditioner"));
    PG_TRY (said (MatDiagonalSet (m->A, d, ADD_VALUES), "the preconditioner"));
done:
    if (d) VecDestroy (&d);
    return status;
}

static pg_status add_up (multigrid *m, reading *r)
{
    pg_status status = PG_OK;
    PetscInt *row = NULL, *column = NULL, rows = (PetscInt) (m->n * m->block);
    double *value = NULL;
    size_t n = list_entries (m, r, NULL, NULL, NULL);
    PG_ALLOC (row, n);
    PG_ALLOC (column, n);
    PG_ALLOC (value, n);
    n = list_entries (m, r, row, column, value);
    PG_TRY (said (MatCreate (MPI_COMM_WORLD, &m->A), "the preconditioner"));
    PG_TRY (said (MatSetSizes (m->A, rows, rows, PETSC_DETERMINE, PETSC_DETERMINE), "the preconditioner"));
    PG_TRY (said (MatSetType (m->A, MATAIJ), "the preconditioner"));
    PG_TRY (said (MatSetBlockSize (m->A, (PetscInt) m->block), "the preconditioner"));
    PG_TRY (said (MatSetPreallocationCOO (m->A, (PetscCount) n, row, column), "room for the preconditioner"));
    PG_TRY (said (MatSetValuesCOO (m->A, value, ADD_VALUES), "rows of the preconditioner"));
    PG_TRY (fill_diagonal (m));
    PG_TRY (said (MatSetOption (m->A, MAT_SYMMETRIC, PETSC_TRUE), "the preconditioner"));
done:
    pg_free (row), pg_free (column), pg_free (value);
    return status;
}

/* Gives PETSc the rigid motions of the points as near null space, orthonormal over all ranks. Points with
 * rotational degrees of freedom get PETSc's default instead: one motion per unknown of a block. */
static pg_status tell_motions (multigrid *m, const pg_shared_rows *s)
{
    pg_status status = PG_OK;
    Vec where = NULL;
    MatNullSpace motions = NULL;
    PetscScalar *at;
    if (s->block != s->dim) return PG_OK;
    PG_TRY (said (MatCreateVecs (m->A, &where, NULL), "coordinates"));
    PG_TRY (said (VecSetBlockSize (where, s->dim), "coordinates"));
    PG_TRY (said (VecGetArray (where, &at), "coordinates"));
    for (size_t k = 0; k < m->n; k++)
        for (size_t c = 0; c < m->block; c++) at[k * m->block + c] = s->x[(size_t) m->node[k] * m->block + c];
    PG_TRY (said (VecRestoreArray (where, &at), "coordinates"));
    PG_TRY (said (MatNullSpaceCreateRigidBody (where, &motions), "rigid motions"));
    PG_TRY (said (MatSetNearNullSpace (m->A, motions), "rigid motions"));
done:
    if (motions) MatNullSpaceDestroy (&motions);
    if (where) VecDestroy (&where);
    return status;
}

/* Threshold of GAMG for functions of a coarse grid, each coupled to many others: only those next to each
 * other, which have the larger couplings, are aggregated, so that cracks stay open. Iterations of a plate of
 * 21260 unknowns: 11, with the cracks of test/ranks/test_rest.sh 22; grids of twice the step, which cracks do
 * not split, need 10 and 71. */
static const PetscReal close_by = 0.03;

/* Sets an option of PETSc unless the user has given it; the function for it has no effect (PETSc 3.18). */
static pg_status set_option (const char *name, const char *value)
{
    pg_status status = PG_OK;
    PetscBool given = PETSC_FALSE;
    PG_TRY (said (PetscOptionsHasName (NULL, NULL, name, &given), "GAMG"));
    if (!given) PG_TRY (said (PetscOptionsSetValue (NULL, name, value), "GAMG"));
done:
    return status;
}

/* Sets up one GAMG cycle. Users give options in PETSC_OPTIONS with the prefix perigal_, for functions of a
 * coarse grid perigal_coarse_. */
static pg_status make_cycle (multigrid *m, int functions)
{
    pg_status status = PG_OK;
    PetscReal threshold = close_by;
    PG_TRY (said (PCCreate (MPI_COMM_WORLD, &m->pc), "GAMG"));
    PG_TRY (said (PCSetOperators (m->pc, m->A, m->A), "GAMG"));
    PG_TRY (said (PCSetType (m->pc, PCGAMG), "GAMG"));
    if (functions) PG_TRY (set_option ("-perigal_coarse_pc_gamg_aggressive_coarsening", "0"));
    if (functions) PG_TRY (said (PCGAMGSetThreshold (m->pc, &threshold, 1), "GAMG"));
    PG_TRY (said (PCSetOptionsPrefix (m->pc, functions ? "perigal_coarse_" : "perigal_"), "GAMG"));
    PG_TRY (said (PCSetFromOptions (m->pc), "GAMG"));
    PG_TRY (said (PCSetUp (m->pc), "GAMG"));
    PG_TRY (said (MatCreateVecs (m->A, &m->x, &m->b), "GAMG"));
done:
    return status;
}

static pg_status multigrid_create (void **self, const pg_shared_rows *setting)
{
    pg_status status = PG_OK;
    multigrid *m = NULL;
    double *number = NULL;
    reading r = { .from = setting };
    PG_TRY (petsc_load ());
    PG_ALLOC (m, 1);
    *self = m;
    m->block = (size_t) setting->block, m->held = setting->subdomain->n, m->fixed = setting->fixed;
    PG_TRY (number_nodes (m, setting->subdomain, &number));
    r.number = number;
    PG_ALLOC (r.node, setting->rows.widest);
    PG_ALLOC (r.value, setting->rows.widest * m->block * m->block);
    PG_ALLOC (r.line, setting->rows.widest * m->block);
    PG_ALLOC (r.column, setting->rows.widest * m->block);
    PG_TRY (setting->sums ? add_up (m, &r) : make_matrix (m, &r));
    PG_TRY (tell_motions (m, setting));
    PG_TRY (make_cycle (m, setting->sums));
done:
    pg_free (number), pg_free (r.node), pg_free (r.value), pg_free (r.line), pg_free (r.column);
    if (status != PG_OK) multigrid_free (self);
    return status;
}

static pg_status multigrid_solve (void *self, const double *r, double *z)
{
    pg_status status = PG_OK;
    multigrid *m = self;
    PetscScalar *to;
    const PetscScalar *from;
    PG_TRY (said (VecGetArray (m->b, &to), "a cycle"));
    for (size_t k = 0; k < m->n; k++)
        for (size_t c = 0; c < m->block; c++) {
            size_t i = (size_t) m->node[k] * m->block + c;
            to[k * m->block + c] = m->fixed && m->fixed[i] ? 0 : r[i];
        }
    PG_TRY (said (VecRestoreArray (m->b, &to), "a cycle"));
    PG_TRY (said (PCApply (m->pc, m->b, m->x), "a cycle"));
    PG_TRY (said (VecGetArrayRead (m->x, &from), "a cycle"));
    for (size_t k = 0; k < m->n; k++)
        for (size_t c = 0; c < m->block; c++) {
            size_t i = (size_t) m->node[k] * m->block + c;
            z[i] = m->fixed && m->fixed[i] ? 0 : from[k * m->block + c];
        }
    PG_TRY (said (VecRestoreArrayRead (m->x, &from), "a cycle"));
done:
    return status;
}

static void multigrid_describe (const void *self, char *text, size_t size)
{
    const multigrid *m = self;
    PetscInt levels = 0;
    size_t at = (size_t) snprintf (text, size, "GAMG (PETSc)");
    if (PCMGGetLevels (m->pc, &levels) != 0) return;
    at += (size_t) snprintf (text + at, size > at ? size - at : 0, ", %ld levels of", (long) levels);
    for (PetscInt k = levels; k-- > 0 && at < size;) {
        KSP ksp;
        Mat A;
        PetscInt n = 0;
        if (PCMGGetSmoother (m->pc, k, &ksp) != 0 || KSPGetOperators (ksp, &A, NULL) != 0
            || MatGetSize (A, &n, NULL) != 0)
            return;
        at += (size_t) snprintf (text + at, size - at, "%s%ld", k == levels - 1 ? " " : ", ", (long) n);
    }
    if (at < size) snprintf (text + at, size - at, " unknowns");
}

const pg_shared_preconditioner petsc_multigrid = {
    multigrid_create, multigrid_solve, multigrid_describe, multigrid_free
};
