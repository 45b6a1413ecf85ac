/* SPDX-License-Identifier: GPL-3.0-or-later
 * linalg.h: sparse matrices, matrix-free operators, linear solvers. Catalogue: src/linalg/<name>.c + one line in list.h. */
#ifndef PERIGAL_LINALG_H
#define PERIGAL_LINALG_H
#include "perigal/base.h"

/* ---- operators and matrices ------------------------------------------------------------------------------------------ */
typedef struct {                                       /* y = A x without a matrix                                       */
    size_t n;
    void  *context;
    void (*apply)    (void *context, const double *x, double *y);
    void (*diagonal) (void *context, double *d);
} pg_operator;

typedef struct {                                       /* compressed columns, rows ascending in each column              */
    size_t  nrow, ncol;
    int     symmetric;                                 /* 1: only the upper triangle is stored                           */
    long   *start;                                     /* (ncol + 1)                                                     */
    long   *row;                                       /* (nnz)                                                          */
    double *value;                                     /* (nnz)                                                          */
} pg_sparse;
pg_status pg_sparse_create   (pg_sparse *out, size_t nrow, size_t ncol, size_t nnz, int symmetric);
void      pg_sparse_clear    (pg_sparse *A);
void      pg_sparse_multiply (const pg_sparse *A, const double *x, double *y);             /* y = A x                    */
void      pg_sparse_multiply_transposed (const pg_sparse *A, const double *x, double *y);  /* y = A' x                   */
/* B = T' A T, upper triangle, A symmetric. The pattern depends on the patterns only. B is created anew. */
pg_status pg_sparse_congruence (pg_sparse *B, const pg_sparse *A, const pg_sparse *T);
pg_operator pg_sparse_operator (pg_sparse *A);

/* ---- solvers ---------------------------------------------------------------------------------------------------------- */
typedef struct {
    int    block;                                      /* dofs per node when dofs are numbered node by node, else 1      */
    int    dim;                                        /* of space: chooses the ordering                                 */
    int    threads;
    double tolerance;                                  /* iterative solvers: |r| <= tolerance |b|                        */
} pg_linear_options;
typedef struct {
    const char *ordering;                              /* "amd", "metis", "none"                                         */
    double factor_entries, flops;                      /* predicted                                                      */
    size_t iterations;                                 /* iterative solvers: of all solves                               */
} pg_linear_info;

typedef struct pg_linear_type {
    const char *name, *summary;
    int symmetric;                                     /* 1: takes the upper triangle of a symmetric positive definite A  */
    pg_status (*analyse) (void **self, const pg_sparse *A, const pg_linear_options *options);   /* pattern only          */
    pg_status (*factor)  (void *self, const pg_sparse *A);  /* PG_E_NOT_SPD / PG_E_SINGULAR: message names the row         */
    pg_status (*solve)   (void *self, size_t nrhs, const double *b, double *x);   /* column-major, b and x may not overlap */
    void      (*info)    (const void *self, pg_linear_info *info);
    void      (*free)    (void **self);
} pg_linear_type;
const pg_linear_type *pg_linear_find  (const char *name);
const char           *pg_linear_names (void);

/* What cholmod's factor of a matrix with dense blocks (block x block) on `graph` (upper triangle, diagonal included; values ignored)
 * will hold and cost, by the same ordering and a symbolic analysis of the graph alone. */
pg_status pg_linear_forecast (const pg_sparse *graph, int block, pg_linear_info *info);

/* Conjugate gradients with diagonal preconditioning on any operator; x holds the first guess and the answer. */
pg_status pg_conjugate_gradients (const pg_operator *A, const double *b, double *x, double tolerance, size_t limit, size_t *iterations);
/* The same with a preconditioner of the caller's: z = P^-1 r, symmetric positive definite (NULL: the diagonal). */
typedef struct { void *context; pg_status (*solve) (void *context, const double *r, double *z); } pg_preconditioner;
pg_status pg_conjugate_gradients_with (const pg_operator *A, const pg_preconditioner *P, const double *b, double *x, double tolerance, size_t limit,
                                       size_t *iterations);
/* Row whose pivot failed in the last factor call on this thread (-1: none). */
long pg_linear_failed_row (void);
#endif
