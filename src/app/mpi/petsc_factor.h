/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private to perigal-mpi: the linear solver that ranks share (petsc_factor.c), and the preconditioner of
 * ranks that divide the body (petsc_multigrid.c). */
#ifndef PG_MPI_PETSC_FACTOR_H
#define PG_MPI_PETSC_FACTOR_H
#include "perigal/linalg.h"

extern const pg_linear_type petsc_factor;
extern const pg_shared_preconditioner petsc_multigrid;
/* Registers solver and preconditioner as the defaults of ranks; removes them again. */
void petsc_give      (void);
void petsc_take_back (void);
#endif
