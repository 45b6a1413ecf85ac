/* SPDX-License-Identifier: GPL-3.0-or-later
 * The functions of CHOLMOD, UMFPACK, BLAS and LAPACK that are called here. The libraries are loaded when the
 * first of them is needed (see base/library.c): a name below is the entry of a table. Another function needs
 * its name in both lists of its library. Outside of linalg they are reached through linalg.h. */
#ifndef PERIGAL_LINALG_SUITESPARSE_H
#define PERIGAL_LINALG_SUITESPARSE_H
#include "perigal/base.h"
#include <cholmod.h>
#include <umfpack.h>

/* BLAS and LAPACK as Fortran calls them: matrices stored by columns, all arguments by pointers. */
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
void dsyrk_ (const char *uplo, const char *trans, const int *n, const int *k, const double *alpha,
             const double *a, const int *lda, const double *beta, double *c, const int *ldc);
void dsymm_ (const char *side, const char *uplo, const int *m, const int *n, const double *alpha,
             const double *a, const int *lda, const double *b, const int *ldb, const double *beta, double *c,
             const int *ldc);
void dpotrf_ (const char *uplo, const int *n, double *a, const int *lda, int *info);
void dpotrs_ (const char *uplo, const int *n, const int *nrhs, const double *a, const int *lda, double *b,
              const int *ldb, int *info);
void dtrsm_ (const char *side, const char *uplo, const char *trans, const char *diag, const int *m,
             const int *n, const double *alpha, const double *a, const int *lda, double *b, const int *ldb);
void dtrmm_ (const char *side, const char *uplo, const char *trans, const char *diag, const int *m,
             const int *n, const double *alpha, const double *a, const int *lda, double *b, const int *ldb);
/* Extensions of OpenBLAS: the number of threads that it uses. */
void openblas_set_num_threads (int threads);
int  openblas_get_num_threads (void);

/* BLAS and LAPACK, from OpenBLAS: every function, as X (name), and the table of pointers. */
#define PG_BLAS_CALLS(X) \
    X (dgesv_) X (dgetrf_) X (dgetrs_) X (dgemm_) X (dgemv_) X (dsyrk_) X (dpotrf_) \
    X (dpotrs_) X (dtrsm_) X (dtrmm_) X (dsymm_) X (openblas_set_num_threads) \
    X (openblas_get_num_threads)
struct pg_blas_calls {
#define X(name) __typeof__ (name) *name;
    PG_BLAS_CALLS (X)
#undef X
};
extern struct pg_blas_calls pg_blas;
/* Loads BLAS and LAPACK; must have succeeded before any of their functions is called. PG_E_FILE: the library
 * is not installed. */
pg_status pg_blas_load (void);

#define dgesv_(...)                   pg_blas.dgesv_ (__VA_ARGS__)
#define dgetrf_(...)                  pg_blas.dgetrf_ (__VA_ARGS__)
#define dgetrs_(...)                  pg_blas.dgetrs_ (__VA_ARGS__)
#define dgemm_(...)                   pg_blas.dgemm_ (__VA_ARGS__)
#define dgemv_(...)                   pg_blas.dgemv_ (__VA_ARGS__)
#define dsyrk_(...)                   pg_blas.dsyrk_ (__VA_ARGS__)
#define dpotrf_(...)                  pg_blas.dpotrf_ (__VA_ARGS__)
#define dpotrs_(...)                  pg_blas.dpotrs_ (__VA_ARGS__)
#define dtrsm_(...)                   pg_blas.dtrsm_ (__VA_ARGS__)
#define dtrmm_(...)                   pg_blas.dtrmm_ (__VA_ARGS__)
#define dsymm_(...)                   pg_blas.dsymm_ (__VA_ARGS__)
#define openblas_set_num_threads(...) pg_blas.openblas_set_num_threads (__VA_ARGS__)
#define openblas_get_num_threads(...) pg_blas.openblas_get_num_threads (__VA_ARGS__)

/* Up to version 6 the functions by which all of SuiteSparse gets its memory are a variable. */
#if SUITESPARSE_MAIN_VERSION < 7
#define PG_SUITESPARSE_MEMORY(X) X (SuiteSparse_config)
#else
#define PG_SUITESPARSE_MEMORY(X)
#endif
/* CHOLMOD: every function, as X (name), and the table of pointers. */
#define PG_CHOLMOD_CALLS(X) \
    X (cholmod_l_amd) X (cholmod_l_analyze_p) X (cholmod_l_factorize) X (cholmod_l_finish) \
    X (cholmod_l_free_dense) X (cholmod_l_free_factor) X (cholmod_l_free_sparse) X (cholmod_l_metis) \
    X (cholmod_l_ptranspose) X (cholmod_l_rcond) X (cholmod_l_solve) X (cholmod_l_solve2) \
    X (cholmod_l_start) X (cholmod_l_super_numeric) X (cholmod_l_updown) PG_SUITESPARSE_MEMORY (X)
struct pg_cholmod_calls {
#define X(name) __typeof__ (name) *name;
    PG_CHOLMOD_CALLS (X)
#undef X
};
extern struct pg_cholmod_calls pg_cholmod;
/* Loads CHOLMOD, and BLAS before it. PG_E_FILE: the library is not installed. */
pg_status pg_cholmod_load (void);

#define cholmod_l_amd(...)           pg_cholmod.cholmod_l_amd (__VA_ARGS__)
#define cholmod_l_analyze_p(...)     pg_cholmod.cholmod_l_analyze_p (__VA_ARGS__)
#define cholmod_l_factorize(...)     pg_cholmod.cholmod_l_factorize (__VA_ARGS__)
#define cholmod_l_finish(...)        pg_cholmod.cholmod_l_finish (__VA_ARGS__)
#define cholmod_l_free_dense(...)    pg_cholmod.cholmod_l_free_dense (__VA_ARGS__)
#define cholmod_l_free_factor(...)   pg_cholmod.cholmod_l_free_factor (__VA_ARGS__)
#define cholmod_l_free_sparse(...)   pg_cholmod.cholmod_l_free_sparse (__VA_ARGS__)
#define cholmod_l_metis(...)         pg_cholmod.cholmod_l_metis (__VA_ARGS__)
#define cholmod_l_ptranspose(...)    pg_cholmod.cholmod_l_ptranspose (__VA_ARGS__)
#define cholmod_l_solve2(...)        pg_cholmod.cholmod_l_solve2 (__VA_ARGS__)
#define cholmod_l_start(...)         pg_cholmod.cholmod_l_start (__VA_ARGS__)
#define cholmod_l_super_numeric(...) pg_cholmod.cholmod_l_super_numeric (__VA_ARGS__)
#define cholmod_l_updown(...)        pg_cholmod.cholmod_l_updown (__VA_ARGS__)
#define cholmod_l_rcond(...)         pg_cholmod.cholmod_l_rcond (__VA_ARGS__)
#define cholmod_l_solve(...)         pg_cholmod.cholmod_l_solve (__VA_ARGS__)

/* UMFPACK: every function, as X (name), and the table of pointers. */
#define PG_UMFPACK_CALLS(X) \
    X (umfpack_dl_defaults) X (umfpack_dl_free_numeric) X (umfpack_dl_free_symbolic) \
    X (umfpack_dl_numeric) X (umfpack_dl_solve) X (umfpack_dl_symbolic)
struct pg_umfpack_calls {
#define X(name) __typeof__ (name) *name;
    PG_UMFPACK_CALLS (X)
#undef X
};
extern struct pg_umfpack_calls pg_umfpack;
/* Loads UMFPACK, and BLAS before it. PG_E_FILE: the library is not installed. */
pg_status pg_umfpack_load (void);

#define umfpack_dl_defaults(...)      pg_umfpack.umfpack_dl_defaults (__VA_ARGS__)
#define umfpack_dl_free_numeric(...)  pg_umfpack.umfpack_dl_free_numeric (__VA_ARGS__)
#define umfpack_dl_free_symbolic(...) pg_umfpack.umfpack_dl_free_symbolic (__VA_ARGS__)
#define umfpack_dl_numeric(...)       pg_umfpack.umfpack_dl_numeric (__VA_ARGS__)
#define umfpack_dl_solve(...)         pg_umfpack.umfpack_dl_solve (__VA_ARGS__)
#define umfpack_dl_symbolic(...)      pg_umfpack.umfpack_dl_symbolic (__VA_ARGS__)
#endif
