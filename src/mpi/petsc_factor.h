/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private to perigal-mpi: the linear solver that ranks share (petsc_factor.c), and the preconditioner of
 * those that divide the body (petsc_multigrid.c). */
#ifndef PG_MPI_PETSC_FACTOR_H
#define PG_MPI_PETSC_FACTOR_H
#include "perigal/linalg.h"
#include <petscmat.h>

extern const pg_linear_type petsc_factor;
extern const pg_shared_preconditioner petsc_multigrid;
/* What PETSc or MUMPS says becomes a status; what: the work that failed, in words. */
pg_status petsc_said (int code, const char *what);
/* Interpolations from coarse grids on a lattice (petsc_grids.c), the finest first, until a grid has `enough`
 * unknowns or there are `most`. node (n): owned nodes, numbered from `number` on. *P: those made so far, also
 * where it fails. */
pg_status petsc_grids (const pg_shared_rows *setting, size_t n, const int *node, long long number,
                       size_t enough, int most, Mat *P, int *count);
/* Starts PETSc (after MPI) and makes its solver the usual one; ends it. Nothing of the command line is read;
 * the variable PETSC_OPTIONS is. */
pg_status petsc_start (void);
/* Scenes may name it, without a start: perigal-mpi check. */
void      petsc_name (void);
void      petsc_end   (void);
#endif
