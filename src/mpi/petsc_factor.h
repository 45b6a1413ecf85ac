/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private to perigal-mpi: the linear solver that ranks share (petsc_factor.c), and the preconditioner of
 * those that divide the body (petsc_multigrid.c). */
#ifndef PG_MPI_PETSC_FACTOR_H
#define PG_MPI_PETSC_FACTOR_H
#include "perigal/linalg.h"

extern const pg_linear_type petsc_factor;
extern const pg_shared_preconditioner petsc_multigrid;
/* What PETSc or MUMPS says becomes a status; what: the work that failed, in words. */
pg_status petsc_said (int code, const char *what);
/* Starts PETSc (after MPI) and makes its solver the usual one; ends it. Nothing of the command line is read;
 * the variable PETSC_OPTIONS is. */
pg_status petsc_start (void);
/* Scenes may name it, without a start: perigal-mpi check. */
void      petsc_name (void);
void      petsc_end   (void);
#endif
