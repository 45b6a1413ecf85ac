/* SPDX-License-Identifier: GPL-3.0-or-later
 * The linear system of a scene by PETSc alone, for doc/scale.md: how many iterations its conjugate gradients
 * with GAMG and the rigid motions as near null space need, set up as its examples do.
 *
 *     perigal check SCENE --matrix FOLDER;  mpirun -n RANKS gamg FOLDER TOLERANCE
 *
 * Unknowns are displacements of points, supports hold single ones (T.mtx selects the free). Each rank takes
 * an equal part of the points, in the order of points.csv. */
#include <petscksp.h>
#include <stdio.h>
#include <string.h>

typedef struct { FILE *file; long rows, columns, entries; int mirrored; } table;

/* Opens a Matrix Market file and reads its head. */
static int open_table (table *t, const char *folder, const char *name)
{
    char line[4096];
    snprintf (line, sizeof line, "%s/%s", folder, name);
    *t = (table) { .file = fopen (line, "r") };
    if (!t->file || !fgets (line, sizeof line, t->file)) return 0;
    t->mirrored = strstr (line, "symmetric") != NULL;
    int vector = strstr (line, "array") != NULL;
    while (fgets (line, sizeof line, t->file) && line[0] == '%') {}
    if (vector) return sscanf (line, "%ld %ld", &t->rows, &t->columns) == 2;
    return sscanf (line, "%ld %ld %ld", &t->rows, &t->columns, &t->entries) == 3;
}

static PetscErrorCode read_vector (const char *folder, const char *name, double *out, long n)
{
    table t;
    PetscCheck (open_table (&t, folder, name) && t.rows == n, PETSC_COMM_SELF, PETSC_ERR_FILE_READ, "%s",
                name);
    for (long i = 0; i < n; i++)
        PetscCheck (fscanf (t.file, "%lf", out + i) == 1, PETSC_COMM_SELF, PETSC_ERR_FILE_READ, "%s", name);
    fclose (t.file);
    return 0;
}

typedef struct { long n; int dim; double *f, *g, *x; unsigned char *is_free; } scene;

static PetscErrorCode read_scene (scene *s, const char *folder, long n)
{
    table t;
    char line[4096];
    s->n = n;
    PetscCall (PetscCalloc4 (n, &s->f, n, &s->g, n, &s->x, n, &s->is_free));
    PetscCall (read_vector (folder, "f.mtx", s->f, n));
    PetscCall (read_vector (folder, "g.mtx", s->g, n));
    PetscCheck (open_table (&t, folder, "T.mtx"), PETSC_COMM_SELF, PETSC_ERR_FILE_READ, "T.mtx");
    for (long k = 0, row, column; k < t.entries && fscanf (t.file, "%ld %ld %*f", &row, &column) == 2; k++)
        s->is_free[row - 1] = 1;
    fclose (t.file);
    snprintf (line, sizeof line, "%s/points.csv", folder);
    FILE *file = fopen (line, "r");
    PetscCheck (file && fgets (line, sizeof line, file), PETSC_COMM_SELF, PETSC_ERR_FILE_READ, "points.csv");
    s->dim = strstr (line, "z [m]") ? 3 : 2;
    for (long i = 0; i < n; i++)
        PetscCheck (fscanf (file, "%lf%*c", s->x + i) == 1
                        && (i % s->dim < s->dim - 1 || fscanf (file, "%*f") == 0),
                    PETSC_COMM_SELF, PETSC_ERR_FILE_READ, "points.csv");
    fclose (file);
    return 0;
}

/* One entry of K: in rows owned here, supports moved to the right. */
static PetscErrorCode put (Mat A, Vec b, const scene *s, long i, long j, double v)
{
    PetscInt first, last, row = (PetscInt) i, column = (PetscInt) j;
    PetscCall (MatGetOwnershipRange (A, &first, &last));
    if (row < first || row >= last) return 0;
    if (s->is_free[i] && !s->is_free[j]) PetscCall (VecSetValue (b, row, -v * s->g[j], ADD_VALUES));
    if ((s->is_free[i] && s->is_free[j]) || i == j)
        PetscCall (MatSetValue (A, row, column, v, INSERT_VALUES));
    return 0;
}

/* Reads K twice: how long the rows are, then their entries. */
static PetscErrorCode read_matrix (Mat *A, Vec *b, scene *s, const char *folder)
{
    PetscInt *length = NULL;
    for (int pass = 0; pass < 2; pass++) {
        table t;
        double v;
        long i, j;
        PetscCheck (open_table (&t, folder, "K.mtx"), PETSC_COMM_SELF, PETSC_ERR_FILE_READ, "K.mtx");
        if (pass == 0) {
            PetscCall (read_scene (s, folder, t.rows));
            PetscCall (PetscCalloc1 (t.rows, &length));
        } else {
            PetscInt first, last, most = 0;
            PetscCall (MatCreate (PETSC_COMM_WORLD, A));
            PetscInt own = PETSC_DECIDE, nodes = (PetscInt) (t.rows / s->dim);
            PetscCall (PetscSplitOwnership (PETSC_COMM_WORLD, &own, &nodes));
            PetscCall (MatSetSizes (*A, own * s->dim, own * s->dim, PETSC_DETERMINE, PETSC_DETERMINE));
            PetscCall (MatSetType (*A, MATAIJ));
            PetscCall (MatSetBlockSize (*A, s->dim));
            for (long k = 0; k < t.rows; k++) most = length[k] > most ? length[k] : most;
            PetscCall (MatSeqAIJSetPreallocation (*A, most, NULL));
            PetscCall (MatMPIAIJSetPreallocation (*A, most, NULL, most, NULL));
            PetscCall (MatCreateVecs (*A, NULL, b));
            PetscCall (VecGetOwnershipRange (*b, &first, &last));
            for (PetscInt k = first; k < last; k++)
                if (s->is_free[k]) PetscCall (VecSetValue (*b, k, s->f[k], ADD_VALUES));
        }
        for (long k = 0; k < t.entries && fscanf (t.file, "%ld %ld %lf", &i, &j, &v) == 3; k++) {
            if (pass == 0) length[i - 1]++, length[j - 1] += t.mirrored && i != j;
            else {
                PetscCall (put (*A, *b, s, i - 1, j - 1, v));
                if (t.mirrored && i != j) PetscCall (put (*A, *b, s, j - 1, i - 1, v));
            }
        }
        fclose (t.file);
    }
    PetscCall (PetscFree (length));
    PetscCall (MatAssemblyBegin (*A, MAT_FINAL_ASSEMBLY));
    PetscCall (MatAssemblyEnd (*A, MAT_FINAL_ASSEMBLY));
    PetscCall (VecAssemblyBegin (*b));
    PetscCall (VecAssemblyEnd (*b));
    return MatSetOption (*A, MAT_SYMMETRIC, PETSC_TRUE);
}

/* The rigid motions of the points owned here. */
static PetscErrorCode tell_motions (Mat A, const scene *s)
{
    Vec where;
    MatNullSpace motions;
    PetscInt first, last;
    PetscCall (MatCreateVecs (A, &where, NULL));
    PetscCall (VecSetBlockSize (where, s->dim));
    PetscCall (VecGetOwnershipRange (where, &first, &last));
    for (PetscInt k = first; k < last; k++) PetscCall (VecSetValue (where, k, s->x[k], INSERT_VALUES));
    PetscCall (VecAssemblyBegin (where));
    PetscCall (VecAssemblyEnd (where));
    PetscCall (MatNullSpaceCreateRigidBody (where, &motions));
    PetscCall (MatSetNearNullSpace (A, motions));
    PetscCall (MatNullSpaceDestroy (&motions));
    return VecDestroy (&where);
}

int main (int argc, char **argv)
{
    scene s;
    Mat A;
    Vec b, x;
    KSP ksp;
    PC pc;
    PetscInt iterations;
    PetscCall (PetscInitialize (&argc, &argv, NULL, NULL));
    PetscCheck (argc == 3, PETSC_COMM_SELF, PETSC_ERR_USER, "usage: mpirun -n RANKS gamg FOLDER TOLERANCE");
    PetscCall (read_matrix (&A, &b, &s, argv[1]));
    PetscCall (tell_motions (A, &s));
    PetscCall (VecDuplicate (b, &x));
    PetscCall (KSPCreate (PETSC_COMM_WORLD, &ksp));
    PetscCall (KSPSetOperators (ksp, A, A));
    PetscCall (KSPSetType (ksp, KSPCG));
    PetscCall (KSPSetNormType (ksp, KSP_NORM_UNPRECONDITIONED));
    PetscCall (KSPSetTolerances (ksp, atof (argv[2]), PETSC_DEFAULT, PETSC_DEFAULT, 1000));
    PetscCall (KSPGetPC (ksp, &pc));
    PetscCall (PCSetType (pc, PCGAMG));
    PetscCall (KSPSetFromOptions (ksp));
    double start = MPI_Wtime ();
    PetscCall (KSPSetUp (ksp));
    double ready = MPI_Wtime ();
    PetscCall (KSPSolve (ksp, b, x));
    double done = MPI_Wtime ();
    PetscCall (KSPGetIterationNumber (ksp, &iterations));
    PetscCall (PetscPrintf (PETSC_COMM_WORLD, "unknowns,iterations,set_up_s,solve_s\n%ld,%ld,%.6g,%.6g\n",
                            s.n, (long) iterations, ready - start, done - ready));
    PetscCall (KSPDestroy (&ksp));
    PetscCall (MatDestroy (&A));
    PetscCall (VecDestroy (&b));
    PetscCall (VecDestroy (&x));
    PetscCall (PetscFree4 (s.f, s.g, s.x, s.is_free));
    return PetscFinalize ();
}
