/* SPDX-License-Identifier: GPL-3.0-or-later
 * linalg.h: sparse matrices, matrix-free operators, linear solvers. Catalogue: src/linalg/<name>.c + one line
 * in list.h. */
#ifndef PERIGAL_LINALG_H
#define PERIGAL_LINALG_H
#include "perigal/base.h"

PG_API_BEGIN

/* ---- operators and matrices ---------------------------------------------------------------------------- */
typedef struct {                                       /* y = A x without a matrix */
    size_t n;
    void  *context;
    void (*apply)    (void *context, const double *x, double *y);
    void (*diagonal) (void *context, double *d);
} pg_operator;

typedef struct {                                       /* compressed columns, rows ascending in each column */
    size_t  nrow, ncol;
    int     symmetric;                                 /* 1: only the upper triangle is stored */
    long   *start;                                     /* (ncol + 1) */
    long   *row;                                       /* (nnz) */
    double *value;                                     /* (nnz) */
} pg_sparse;
pg_status pg_sparse_create   (pg_sparse *out, size_t nrow, size_t ncol, size_t nnz, int symmetric);
void      pg_sparse_clear    (pg_sparse *A);
void      pg_sparse_multiply (const pg_sparse *A, const double *x, double *y);             /* y = A x */
void      pg_sparse_multiply_transposed (const pg_sparse *A, const double *x, double *y);  /* y = A' x */
/* B = T' A T, upper triangle, A symmetric. The pattern depends on the patterns only. B is created anew. */
pg_status pg_sparse_congruence (pg_sparse *B, const pg_sparse *A, const pg_sparse *T);
pg_operator pg_sparse_operator (pg_sparse *A);

/* ---- assembly ------------------------------------------------------------------------------------------ */
/* Lists of nodes, compressed: those of item i are node[start[i]..start[i + 1]), ascending. */
typedef struct { size_t n; size_t *start; int *node; } pg_adjacency;

/* A global matrix of dense node blocks is the sum of what its sources couple. A source is a list of
 * points, each of which couples all pairs of the nodes that it sees (an element of a mesh, an evaluation
 * point, a bond). Assembly goes by rows: the row of a node collects from all points that see the node. So
 * no two threads write to the same place, sums have the same order for any number of threads, and redoing
 * some rows after a change is the same routine as the first assembly. */
typedef struct {
    const pg_adjacency *seen;                          /* points -> nodes, borrowed */
    void *context;
    /* Blocks (block x block, row-major) K_ab of point p between its local nodes a and b = 0..m-1, written
     * to out (zero on entry). */
    void (*blocks) (void *context, size_t p, size_t a, size_t m, double *out);
} pg_assembly_source;

typedef struct pg_assembly pg_assembly;
/* The pattern of all sources on n nodes with `block` dofs each. The sources are copied, their lists
 * borrowed. */
pg_status pg_assembly_create (pg_assembly **out, size_t n, int block, size_t nsource,
                              const pg_assembly_source *sources);
void      pg_assembly_free   (pg_assembly **assembly);
/* Computes the rows of the nodes list[0..count) anew (NULL: those of all n). */
pg_status pg_assembly_gather (pg_assembly *assembly, size_t count, const int *list, int threads);
/* The matrix, borrowed: its upper triangle; zeros that the pattern holds are stored. */
pg_sparse *pg_assembly_matrix (pg_assembly *assembly);

/* The graph of the nodes alone: entry (J, I), J <= I, where a point of some list sees both (values NULL). */
pg_status pg_assembly_graph (pg_sparse *out, size_t n, size_t nlist, const pg_adjacency *const *lists);
/* The same for pairwise forces: a node, and the nodes that it sees itself (symmetric lists, without the
 * node's own number). */
pg_status pg_assembly_graph_pairwise (pg_sparse *out, const pg_adjacency *seen);

/* ---- solvers ------------------------------------------------------------------------------------------- */
typedef struct {
    int    block;  /* dofs per node when dofs are numbered node by node, else 1 */
    int    dim;                                        /* of space: chooses the ordering */
    int    threads;
    double tolerance;                                  /* iterative solvers: |r| <= tolerance |b| */
} pg_linear_options;
typedef struct {
    const char *ordering;                              /* "amd", "metis", "none" */
    double factor_entries, flops;                      /* predicted */
    size_t iterations;                                 /* iterative solvers: of all solves */
} pg_linear_info;

typedef struct pg_linear_type {
    const char *name, *summary;
    int symmetric;  /* 1: takes the upper triangle of a symmetric positive definite A */
    int factors;                                       /* 1: by a factor of A; 0: by products with A */
    /* pattern only */
    pg_status (*analyse) (void **self, const pg_sparse *A, const pg_linear_options *options);
    /* PG_E_NOT_SPD / PG_E_SINGULAR: message names the row */
    pg_status (*factor)  (void *self, const pg_sparse *A);
    /* column-major, b and x may not overlap */
    pg_status (*solve)   (void *self, size_t nrhs, const double *b, double *x);
    void      (*info)    (const void *self, pg_linear_info *info);
    void      (*free)    (void **self);
} pg_linear_type;
const pg_linear_type *pg_linear_find  (const char *name);
const char           *pg_linear_names (void);

/* What cholmod's factor of a matrix with dense blocks (block x block) on `graph` (upper triangle, diagonal
 * included; values ignored) will hold and cost, by the same ordering and a symbolic analysis of the graph
 * alone. */
pg_status pg_linear_forecast (const pg_sparse *graph, int block, pg_linear_info *info);

/* Conjugate gradients with diagonal preconditioning on any operator; x holds the first guess and the answer.
 * The same bits for any number of threads. */
pg_status pg_conjugate_gradients (const pg_operator *A, const double *b, double *x, double tolerance,
                                  size_t limit, size_t *iterations);
/* The same with a preconditioner of the caller's: z = P^-1 r, symmetric positive definite (NULL: the
 * diagonal); threads: of the loops beside it. */
typedef struct {
    void *context;
    pg_status (*solve) (void *context, const double *r, double *z);
    int threads;
} pg_preconditioner;
pg_status pg_conjugate_gradients_with (const pg_operator *A, const pg_preconditioner *P, const double *b,
                                       double *x, double tolerance, size_t limit, size_t *iterations);
/* Row whose pivot failed in the last factor call on this thread (-1: none). */
long pg_linear_failed_row (void);

/* ---- multilevel preconditioner ------------------------------------------------------------------------- */
/* the rows of a matrix of nodes, or of one like it with fewer couplings: the same rigid motions, energies
 * within a small factor */
typedef struct {
    void  *context;
    size_t widest;  /* most couplings of one node, its own block among them */
    double reach;                                      /* m: no two nodes further apart are coupled */
    /* Couplings of node i, itself among them, in any order: node (m) and, unless value is NULL, blocks (m x
     * block x block); returns m. Called by several threads, each with a number of its own. */
    size_t (*row) (void *context, size_t i, int thread, int *node, double *value);
    /* Nodes of a lattice, its steps (0: none), m; of all nodes that are alike the rows are the same: blocks
     * and offsets, in order. NULL: not known. */
    double lattice[3];
    int    (*alike) (void *context, size_t i);
} pg_couplings;
typedef struct {
    /* of space; unknowns of a node (numbered node by node), 1 to 6; of the loops */
    int     dim, block, threads;
    size_t  n;                                         /* nodes */
    const double *x;                                   /* their places, m (n x dim), borrowed */
    const unsigned char *fixed;  /* unknowns that are prescribed; NULL: none (n x block) */
    const pg_operator *A;                              /* y = A x, all n x block unknowns, borrowed */
    pg_couplings rows;  /* of the same A; asked while it is created, not later */
    double  step;                                      /* of the first coarse grid over the reach; 0: 4/3 */
    int     degree;                                    /* of the smoothing polynomial; 0: 2 */
} pg_multilevel_setting;
typedef struct {
    int     levels, degree;
    size_t  unknowns[8];                               /* of the finest, the next, ... */
    double  top[8];                                    /* bounds of the spectra of D^-1 A */
    size_t  split;  /* hats of the first coarse grid that cracks or gaps have split */
    size_t  applications;
} pg_multilevel_info;
typedef struct pg_multilevel pg_multilevel;
/* z = M r for A symmetric positive (semi)definite: one symmetric V-cycle, Chebyshev smoothing by products
 * with A, coarse levels of multilinear hats on grids over the nodes, split where a crack runs through (they
 * carry the unknowns of a node each and make its rigid motions and uniform strains), their matrices P' A P,
 * the last by Cholesky. Unknowns that are prescribed or without stiffness: z = 0. The same bits for any
 * number of threads. It stays valid while A loses couplings, only less and less good. PG_E_USAGE,
 * PG_E_MEMORY, PG_E_NOT_SPD. */
pg_status pg_multilevel_create (pg_multilevel **out, const pg_multilevel_setting *setting);
void      pg_multilevel_free   (pg_multilevel **multilevel);
pg_preconditioner pg_multilevel_preconditioner (pg_multilevel *multilevel);
void      pg_multilevel_describe (const pg_multilevel *multilevel, pg_multilevel_info *info);
PG_API_END
#endif
