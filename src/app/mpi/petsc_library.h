/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private to perigal-mpi: the functions of PETSc that are called here, and its start. The library, which
 * loads a hundred others and takes longer to load than a small run takes in all, is loaded when the first
 * function is needed (base/library.c): a name below is the entry of a table. Another function needs its name
 * in both lists. */
#ifndef PG_MPI_PETSC_LIBRARY_H
#define PG_MPI_PETSC_LIBRARY_H
#include "perigal/base.h"
#include <petscksp.h>
/* a macro of PETSc, which counts messages in variables of the library */
#undef MPI_Allgatherv

#define PG_PETSC_CALLS(X) \
    X (KSPGetOperators) X (MatAssemblyBegin) X (MatAssemblyEnd) X (MatCholeskyFactorNumeric) \
    X (MatCholeskyFactorSymbolic) X (MatCreate) X (MatCreateDense) X (MatCreateMPIAIJWithArrays) \
    X (MatCreateVecs) X (MatDestroy) X (MatDiagonalSet) X (MatFactorGetError) \
    X (MatFactorInfoInitialize) X (MatGetDiagonal) X (MatGetFactor) X (MatGetSize) \
    X (MatMPIAIJSetPreallocation) X (MatMatSolve) X (MatMumpsGetInfog) X (MatMumpsGetRinfog) \
    X (MatMumpsSetIcntl) X (MatNullSpaceCreateRigidBody) X (MatNullSpaceDestroy) \
    X (MatSeqAIJSetPreallocation) X (MatSetBlockSize) X (MatSetNearNullSpace) X (MatSetOption) \
    X (MatSetPreallocationCOO) X (MatSetSizes) X (MatSetType) X (MatSetValues) X (MatSetValuesCOO) \
    X (PCApply) X (PCCreate) X (PCDestroy) X (PCGAMGSetThreshold) X (PCMGGetLevels) X (PCMGGetSmoother) \
    X (PCSetFromOptions) X (PCSetOperators) X (PCSetOptionsPrefix) X (PCSetType) X (PCSetUp) \
    X (PetscErrorMessage) X (PetscFinalize) X (PetscInitialize) X (PetscOptionsHasName) \
    X (PetscOptionsSetValue) X (PetscPushErrorHandler) X (PetscReturnErrorHandler) X (VecDestroy) \
    X (VecGetArray) X (VecGetArrayRead) X (VecRestoreArray) X (VecRestoreArrayRead) X (VecSetBlockSize)
struct petsc_calls {
#define X(name) __typeof__ (name) *name;
    PG_PETSC_CALLS (X)
#undef X
};
extern struct petsc_calls petsc;
/* Loads PETSc and starts it, once per process; must succeed before any of its functions is called. All ranks
 * call. PETSc does not read the command line, but the variable PETSC_OPTIONS. PG_E_FILE: it is not
 * installed. */
pg_status petsc_load (void);
/* Ends PETSc, if it was started. */
void      petsc_end  (void);
/* Turns an error code of PETSc or MUMPS into a status; what: the work that failed, in words. */
pg_status petsc_said (PetscErrorCode code, const char *what);

#define KSPGetOperators(...)             petsc.KSPGetOperators (__VA_ARGS__)
#define MatAssemblyBegin(...)            petsc.MatAssemblyBegin (__VA_ARGS__)
#define MatAssemblyEnd(...)              petsc.MatAssemblyEnd (__VA_ARGS__)
#define MatCholeskyFactorNumeric(...)    petsc.MatCholeskyFactorNumeric (__VA_ARGS__)
#define MatCholeskyFactorSymbolic(...)   petsc.MatCholeskyFactorSymbolic (__VA_ARGS__)
#define MatCreate(...)                   petsc.MatCreate (__VA_ARGS__)
#define MatCreateDense(...)              petsc.MatCreateDense (__VA_ARGS__)
#define MatCreateMPIAIJWithArrays(...)   petsc.MatCreateMPIAIJWithArrays (__VA_ARGS__)
#define MatCreateVecs(...)               petsc.MatCreateVecs (__VA_ARGS__)
#define MatDestroy(...)                  petsc.MatDestroy (__VA_ARGS__)
#define MatDiagonalSet(...)              petsc.MatDiagonalSet (__VA_ARGS__)
#define MatFactorGetError(...)           petsc.MatFactorGetError (__VA_ARGS__)
#define MatFactorInfoInitialize(...)     petsc.MatFactorInfoInitialize (__VA_ARGS__)
#define MatGetDiagonal(...)              petsc.MatGetDiagonal (__VA_ARGS__)
#define MatGetFactor(...)                petsc.MatGetFactor (__VA_ARGS__)
#define MatGetSize(...)                  petsc.MatGetSize (__VA_ARGS__)
#define MatMPIAIJSetPreallocation(...)   petsc.MatMPIAIJSetPreallocation (__VA_ARGS__)
#define MatMatSolve(...)                 petsc.MatMatSolve (__VA_ARGS__)
#define MatMumpsGetInfog(...)            petsc.MatMumpsGetInfog (__VA_ARGS__)
#define MatMumpsGetRinfog(...)           petsc.MatMumpsGetRinfog (__VA_ARGS__)
#define MatMumpsSetIcntl(...)            petsc.MatMumpsSetIcntl (__VA_ARGS__)
#define MatNullSpaceCreateRigidBody(...) petsc.MatNullSpaceCreateRigidBody (__VA_ARGS__)
#define MatNullSpaceDestroy(...)         petsc.MatNullSpaceDestroy (__VA_ARGS__)
#define MatSeqAIJSetPreallocation(...)   petsc.MatSeqAIJSetPreallocation (__VA_ARGS__)
#define MatSetBlockSize(...)             petsc.MatSetBlockSize (__VA_ARGS__)
#define MatSetNearNullSpace(...)         petsc.MatSetNearNullSpace (__VA_ARGS__)
#define MatSetOption(...)                petsc.MatSetOption (__VA_ARGS__)
#define MatSetPreallocationCOO(...)      petsc.MatSetPreallocationCOO (__VA_ARGS__)
#define MatSetSizes(...)                 petsc.MatSetSizes (__VA_ARGS__)
#define MatSetType(...)                  petsc.MatSetType (__VA_ARGS__)
#define MatSetValues(...)                petsc.MatSetValues (__VA_ARGS__)
#define MatSetValuesCOO(...)             petsc.MatSetValuesCOO (__VA_ARGS__)
#define PCApply(...)                     petsc.PCApply (__VA_ARGS__)
#define PCCreate(...)                    petsc.PCCreate (__VA_ARGS__)
#define PCDestroy(...)                   petsc.PCDestroy (__VA_ARGS__)
#define PCGAMGSetThreshold(...)          petsc.PCGAMGSetThreshold (__VA_ARGS__)
#define PCMGGetLevels(...)               petsc.PCMGGetLevels (__VA_ARGS__)
#define PCMGGetSmoother(...)             petsc.PCMGGetSmoother (__VA_ARGS__)
#define PCSetFromOptions(...)            petsc.PCSetFromOptions (__VA_ARGS__)
#define PCSetOperators(...)              petsc.PCSetOperators (__VA_ARGS__)
#define PCSetOptionsPrefix(...)          petsc.PCSetOptionsPrefix (__VA_ARGS__)
#define PCSetType(...)                   petsc.PCSetType (__VA_ARGS__)
#define PCSetUp(...)                     petsc.PCSetUp (__VA_ARGS__)
#define PetscErrorMessage(...)           petsc.PetscErrorMessage (__VA_ARGS__)
#define PetscFinalize(...)               petsc.PetscFinalize (__VA_ARGS__)
#define PetscInitialize(...)             petsc.PetscInitialize (__VA_ARGS__)
#define PetscOptionsHasName(...)         petsc.PetscOptionsHasName (__VA_ARGS__)
#define PetscOptionsSetValue(...)        petsc.PetscOptionsSetValue (__VA_ARGS__)
#define PetscPushErrorHandler(...)       petsc.PetscPushErrorHandler (__VA_ARGS__)
#define PetscReturnErrorHandler(...)     petsc.PetscReturnErrorHandler (__VA_ARGS__)
#define VecDestroy(...)                  petsc.VecDestroy (__VA_ARGS__)
#define VecGetArray(...)                 petsc.VecGetArray (__VA_ARGS__)
#define VecGetArrayRead(...)             petsc.VecGetArrayRead (__VA_ARGS__)
#define VecRestoreArray(...)             petsc.VecRestoreArray (__VA_ARGS__)
#define VecRestoreArrayRead(...)         petsc.VecRestoreArrayRead (__VA_ARGS__)
#define VecSetBlockSize(...)             petsc.VecSetBlockSize (__VA_ARGS__)
#endif
