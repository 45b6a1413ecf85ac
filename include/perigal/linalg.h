/* SPDX-License-Identifier: GPL-3.0-or-later
 * linalg.h: sparse matrices, matrix-free operators, assembly, linear solvers and preconditioners. A solver
 * is an entry of the catalogue: src/linalg/NAME.c and one line in list.h. */
#ifndef PERIGAL_LINALG_H
#define PERIGAL_LINALG_H
#include "perigal/base.h"
#include "perigal/ranks.h"

PG_API_BEGIN

/* ---- operators and matrices ---------------------------------------------------------------------------- */
/* A linear operator without a matrix, n x n. */
typedef struct {
    /* Number of unknowns. */
    size_t n;
    /* Passed to the functions: y = A x, and d = diagonal of A. */
    void  *context;
    void (*apply)    (void *context, const double *x, double *y);
    void (*diagonal) (void *context, double *d);
} pg_operator;

/* A sparse matrix by compressed columns: entries of column j are start[j] .. start[j + 1] - 1, rows
 * ascending. */
typedef struct {
    /* Numbers of rows and columns. */
    size_t  nrow, ncol;
    /* 1: the matrix is symmetric, and only its upper triangle (row <= column) is stored. */
    int     symmetric;
    /* First entry of each column (ncol + 1). */
    long   *start;
    /* Row and value of each entry (start[ncol]). */
    long   *row;
    double *value;
} pg_sparse;
/* Allocates a matrix with room for nnz entries, all zero, columns empty. PG_E_MEMORY. */
pg_status pg_sparse_create   (pg_sparse *out, size_t nrow, size_t ncol, size_t nnz, int symmetric);
void      pg_sparse_clear    (pg_sparse *A);
/* y = A x and y = A' x; x and y may not overlap. */
void      pg_sparse_multiply (const pg_sparse *A, const double *x, double *y);
void      pg_sparse_multiply_transposed (const pg_sparse *A, const double *x, double *y);
/* B = T' A T, upper triangle, for a symmetric A; B is created. Its pattern depends on the patterns of A and
 * T only, not on the values, so that one symbolic analysis serves all. PG_E_MEMORY. */
pg_status pg_sparse_congruence (pg_sparse *B, const pg_sparse *A, const pg_sparse *T);
/* The matrix as an operator; A is borrowed. */
pg_operator pg_sparse_operator (pg_sparse *A);

/* ---- assembly ------------------------------------------------------------------------------------------ */
/* Lists of nodes in compressed rows: those of item i are node[start[i]] .. node[start[i + 1] - 1],
 * ascending. */
typedef struct { size_t n; size_t *start; int *node; } pg_adjacency;

/* A global matrix of dense node blocks is the sum of what its sources couple. A source is a list of points,
 * each of which couples all pairs of the nodes that it sees (an element of a mesh, an evaluation point, a
 * bond). Assembly goes by rows: the row of a node collects from all points that see the node. So no two
 * threads write to the same place, sums have the same order for any number of threads, and redoing some
 * rows after a change is the same routine as the first assembly. */
typedef struct {
    /* The nodes that each point sees; borrowed. */
    const pg_adjacency *seen;
    void *context;
    /* Blocks K_ab (block x block, row-major) of point p between its local nodes a and b = 0 .. m - 1,
     * written one behind the other to out, which is zero on entry. Called by several threads. */
    void (*blocks) (void *context, size_t p, size_t a, size_t m, double *out);
    /* Instead (blocks NULL): block rows of m block numbers, row i that of unknown i of node a, entry
     * b block + j for unknown j of node b; out is zero on entry. They are summed over all points of the
     * source first, many numbers at a time. finish: the rows of K, in place of sums for m nodes, where these
     * are other numbers of which the blocks follow; NULL: they are rows of K. */
    void (*rows)   (void *context, size_t p, size_t a, size_t m, double *out);
    void (*finish) (void *context, size_t m, double *rows);
    /* What another assembly of this source alone has come to: taken once, when all rows are first computed,
     * and borrowed until then. NULL: not known. */
    const struct pg_assembly *known;
} pg_assembly_source;

/* A matrix under assembly: pattern, values, and what is needed to compute rows anew. */
typedef struct pg_assembly pg_assembly;
/* Finds the pattern of all sources on n nodes with `block` unknowns each; no values yet. The sources are
 * copied, their lists borrowed. PG_E_MEMORY. */
pg_status pg_assembly_create (pg_assembly **out, size_t n, int block, size_t nsource,
                              const pg_assembly_source *sources);
void      pg_assembly_free   (pg_assembly **assembly);
/* Frees what computes rows: from then on it serves as `known` alone. */
void      pg_assembly_settle (pg_assembly *assembly);
/* Computes the rows of the nodes list[0 .. count - 1] anew (list NULL: those of nodes 0 .. count - 1). */
pg_status pg_assembly_gather (pg_assembly *assembly, size_t count, const int *list, int threads);
/* The matrix, borrowed: its upper triangle; zeros that the pattern holds are stored. */
pg_sparse *pg_assembly_matrix (pg_assembly *assembly);

/* The graph of the nodes alone: entry (J, I), J <= I, where a point of some list sees both (values NULL). */
pg_status pg_assembly_graph (pg_sparse *out, size_t n, size_t nlist, const pg_adjacency *const *lists);
/* The graph of the nodes of pairwise forces: entry (J, I), J <= I, where node I sees node J itself, and the
 * diagonal (values NULL). seen: symmetric lists without the node's own number. */
pg_status pg_assembly_graph_pairwise (pg_sparse *out, const pg_adjacency *seen);

/* ---- solvers ------------------------------------------------------------------------------------------- */
/* Options of a linear solver. */
typedef struct {
    /* Unknowns per node where they are numbered node by node, else 1: nodes are ordered instead of
     * unknowns. */
    int    block;
    /* Dimension of space. */
    int    dim;
    /* Threads that the solver may use. */
    int    threads;
    /* Iterative solvers stop at |r| <= tolerance |b| (Euclidean norms). */
    double tolerance;
    /* 1: many factorisations or solves will follow, so that an order of fewer operations pays. */
    int    many;
} pg_linear_options;

/* What a solver reports. */
typedef struct {
    /* Fill-reducing ordering: "amd", "metis", "none". */
    const char *ordering;
    /* Predicted entries of the factor and operations of a factorisation. */
    double factor_entries, flops;
    /* Iterative solvers: sum over all solves. */
    size_t iterations;
    /* Smallest over largest pivot of the last symmetric factor, about; 0: not known. */
    double pivots;
    /* Operations of all half solves so far. */
    double half_flops;
} pg_linear_info;

/* An entry of the catalogue. */
typedef struct pg_linear_type {
    /* The value of `solver.linear` in a scene, and one line of description. */
    const char *name, *summary;
    /* 1: takes the upper triangle of a symmetric positive definite matrix. */
    int symmetric;
    /* 1: solves by a factor of A; 0: by products with A. */
    int factors;
    /* Creates the solver's state from the pattern of A; values are not read. */
    pg_status (*analyse) (void **self, const pg_sparse *A, const pg_linear_options *options);
    /* Takes the values of A, of the same pattern. PG_E_NOT_SPD, PG_E_SINGULAR: the message names the row. */
    pg_status (*factor)  (void *self, const pg_sparse *A);
    /* Solves for nrhs right-hand sides, column by column (n x nrhs); b and x may not overlap. */
    pg_status (*solve)   (void *self, size_t nrhs, const double *b, double *x);
    /* Solves for nrhs right-hand sides (n x nrhs) that are zero but for a few places near each other, such as
     * unit forces; NULL: solve does. */
    pg_status (*solve_few) (void *self, size_t nrhs, const double *b, double *x);
    /* Half of it: y_i such that b_i . A^-1 b_j = y_i . y_j. y: nrhs columns, each of length n; written are
     * the numbers from first[2 k] to before first[2 k + 1], k < *count (borrowed until the next call), all
     * others are to be taken for zero. NULL: not known. */
    pg_status (*half_few) (void *self, size_t nrhs, const double *b, double *const *y, size_t *count,
                           const size_t **first);
    /* Fills in the report; frees the state. */
    void      (*info)    (const void *self, pg_linear_info *info);
    void      (*free)    (void **self);
    /* As factor; `taken` hears once A has been read, before the factor is made: whoever needs A no longer can
     * free it there, so that both are never in memory together. May be called once or not at all. NULL: not
     * known. */
    pg_status (*factor_taking) (void *self, const pg_sparse *A, void (*taken) (void *context), void *context);
} pg_linear_type;
/* The entry of that name, NULL: there is none. */
const pg_linear_type *pg_linear_find  (const char *name);
/* A program adds an entry of its own (perigal-mpi: by PETSc), which then is the usual solver of its kind;
 * NULL: it is taken away. Borrowed; one at a time. */
void                  pg_linear_add   (const pg_linear_type *type);
/* The one that solver.linear: auto takes: what was added, where it is of that kind, else pg_linear_first. */
const pg_linear_type *pg_linear_usual (int symmetric, int factors);
/* The first entry of the list with these flags, NULL: there is none. Symmetric with a factor: the usual
 * one, for K; not symmetric: for matrices that are indefinite or not symmetric; without a factor: by
 * products with A only. */
const pg_linear_type *pg_linear_first (int symmetric, int factors);
/* All names, separated by |, and "auto". */
const char           *pg_linear_names (void);

/* Threads that the BLAS under factorizations uses from here on. BLAS is loaded with the first factorization,
 * and until then this does nothing: the variable OPENBLAS_NUM_THREADS of the environment counts then. Returns
 * how many it used before. */
int  pg_linear_threads (int threads);

/* Predicts what the factor of a matrix with dense blocks (block x block) on `graph` will hold and cost: the
 * same ordering, and a symbolic analysis of the graph of the nodes alone. graph: upper triangle, diagonal
 * included; values are ignored. many: as in pg_linear_options. */
pg_status pg_linear_forecast (const pg_sparse *graph, int block, int many, pg_linear_info *info);

/* Conjugate gradients with the diagonal as preconditioner. x: first guess in, solution out. Stops at |r| <=
 * tolerance |b|. PG_E_EQUILIBRIUM after `limit` iterations, PG_E_NOT_SPD where p.A p <= 0. Sums are taken
 * in chunks of fixed size, so that the bits do not depend on the number of threads. */
pg_status pg_conjugate_gradients (const pg_operator *A, const double *b, double *x, double tolerance,
                                  size_t limit, size_t *iterations);

/* A preconditioner, symmetric positive definite: z = P^-1 r. threads: of the vector loops beside it. */
typedef struct {
    void *context;
    pg_status (*solve) (void *context, const double *r, double *z);
    int threads;
} pg_preconditioner;
/* pg_conjugate_gradients with a preconditioner P of the caller's; P NULL: the diagonal of A. */
pg_status pg_conjugate_gradients_with (const pg_operator *A, const pg_preconditioner *P, const double *b,
                                       double *x, double tolerance, size_t limit, size_t *iterations);
/* `n` numbers; begins as zero, cleared by pg_free (room.v). */
typedef struct { double *v; size_t n; } pg_cg_room;
/* Who watches conjugate gradients: `stepped` (NULL: nobody) hears after every iteration that x has gone on by
 * alpha times the vector that A was applied to last. Whoever keeps more of that product than the rows solved
 * for, such as those of prescribed unknowns, can keep b - A x of all rows so. `residual` is |b - A x| / |b|.
 * *stop = 1 ends the iterations as if the tolerance were met; an error ends them too, and is returned. */
typedef struct {
    pg_status (*stepped) (void *context, double alpha, double residual, int *stop);
    void  *context;
    /* 1: what is left of b is local: entries of directions that only what may stay unbalanced would ask for
     * are zero, so that products need not look there. By the diagonal alone. */
    int    local;
    /* 1: ranks share A (perigal/ranks.h). Vectors are this rank's part of longer ones, in which unknowns of
     * other ranks have the entry 0 wherever sums are taken (b, A x): sums go over all ranks, and all ranks
     * make the same calls. */
    int    shared;
    /* Room for the vectors, kept by the caller from one solve to the next; NULL: own room. */
    pg_cg_room *room;
} pg_cg_watch;
pg_status pg_conjugate_gradients_watched (const pg_operator *A, const pg_preconditioner *P, const double *b,
                                          double *x, double tolerance, size_t limit, size_t *iterations,
                                          const pg_cg_watch *watch);
/* Unknown whose pivot failed in the most recent failed Cholesky factorisation on this thread; -1: none has
 * failed yet. A later success does not reset it. */
long pg_linear_failed_row (void);

/* Solves A X = B for a dense general matrix, column-major (n x n, n x nrhs): A becomes its factors, b the
 * solution. PG_E_SINGULAR, PG_E_MEMORY. */
pg_status pg_dense_lu (size_t n, double *A, size_t nrhs, double *b);
/* pg_dense_lu in two parts: A (n x n, columns lda apart) becomes its factors with pivots (n), 0: a pivot is
 * zero, or there is no BLAS; then b (n x nrhs, columns ldb apart) becomes A^-1 b. */
int  pg_dense_factor (size_t n, double *A, size_t lda, int *pivot);
void pg_dense_substitute (size_t n, const double *A, size_t lda, const int *pivot, size_t nrhs, double *b,
                          size_t ldb);
/* C = alpha A B + beta C, or alpha A' B + beta C, column-major: C m x n, the inner dimension k. */
void pg_dense_multiply (int transposed, size_t m, size_t n, size_t k, double alpha, const double *A,
                        size_t lda, const double *B, size_t ldb, double beta, double *C, size_t ldc);
/* C += A B' (m x k, n x k, columns without gaps). */
void pg_dense_add_product (size_t m, size_t n, size_t k, const double *A, const double *B, double *C);

/* ---- multilevel preconditioner ------------------------------------------------------------------------- */
/* Rows of a matrix of nodes, or of one like it with fewer couplings: it must have the same rigid motions,
 * and its energies must agree within a small factor. The multilevel preconditioner is built from these. */
typedef struct {
    void  *context;
    /* Largest number of couplings of one node, its own block among them. */
    size_t widest;
    /* No two nodes further apart than this are coupled, m. */
    double reach;
    /* Couplings of node i, itself among them, in any order: writes nodes (m) and, unless value is NULL,
     * blocks (m x block x block), and returns m. Called by several threads, each with its own number. */
    size_t (*row) (void *context, size_t i, int thread, int *node, double *value);
    /* Steps of the lattice that the nodes form, m; 0: none. alike (i) says whether node i has the same row
     * as all others for which it says so: equal blocks at equal offsets, in the same order. NULL: not
     * known. */
    double lattice[3];
    int    (*alike) (void *context, size_t i);
} pg_couplings;

/* What the preconditioner is built from. */
typedef struct {
    /* Dimension of space; unknowns of a node (numbered node by node), 1 to 6; threads of the loops. */
    int     dim, block, threads;
    /* Number of nodes. */
    size_t  n;
    /* Their positions, m (n x dim); borrowed. */
    const double *x;
    /* 1 for each prescribed unknown; NULL: none is (n x block). */
    const unsigned char *fixed;
    /* y = A x with all n x block unknowns; borrowed. */
    const pg_operator *A;
    /* Rows of A, read only during creation. */
    pg_couplings rows;
    /* Step of the first coarse grid in units of the reach; 0: 4/3. aligned: 1: where nodes form a lattice,
     * vertices of coarse grids lie on nodes rather than in the middle of steps: for couplings that reach
     * one step, which then reach one step on every grid. */
    double  step;
    int     aligned;
    /* Degree of the smoothing polynomial; 0: 2. */
    int     degree;
    /* Of ranks that share the nodes of a lattice (aligned): which are owned, borrowed. Rows of owned nodes
     * are complete, those of others are not read. All ranks call; what is below the first coarse grid each
     * has in full as long as that is little work, else it is given from outside (pg_shared_preconditioner).
     * Vectors are read and written at owned nodes. NULL: alone. */
    const pg_subdomain *subdomain;
} pg_multilevel_setting;

/* What the preconditioner reports. */
typedef struct {
    /* Number of levels, the finest among them; degree of smoothing. */
    int     levels, degree;
    /* Unknowns of each level, the finest first. */
    size_t  unknowns[8];
    /* Upper bounds of the spectra of D^-1 A, D = diagonal of A. */
    double  top[8];
    /* Functions of the first coarse grid that cracks or gaps have split into several. */
    size_t  split;
    /* V-cycles so far. */
    size_t  applications;
} pg_multilevel_info;
typedef struct pg_multilevel pg_multilevel;
/* Builds z = M r for a symmetric positive (semi)definite A: one symmetric V-cycle with Chebyshev smoothing
 * by products with A. Coarse spaces: multilinear functions on grids over the nodes, split where a crack
 * runs through; they carry the unknowns of a node each and so reproduce its rigid motions and uniform
 * strains. Their matrices are P' A P, the last one factored by Cholesky. z = 0 at unknowns that are
 * prescribed or have no stiffness. The bits do not depend on the number of threads. M remains valid while A
 * loses couplings, but becomes less effective. PG_E_USAGE, PG_E_MEMORY, PG_E_NOT_SPD. */
pg_status pg_multilevel_create (pg_multilevel **out, const pg_multilevel_setting *setting);
void      pg_multilevel_free   (pg_multilevel **multilevel);
/* The V-cycle in the form that conjugate gradients take; borrows the multilevel object. */
pg_preconditioner pg_multilevel_preconditioner (pg_multilevel *multilevel);
/* Fills in the report. */
void      pg_multilevel_describe (const pg_multilevel *multilevel, pg_multilevel_info *info);
/* Unknowns of the levels of a preconditioner that ranks share, in words, into text (size bytes). */
void      pg_multilevel_describe_shared (const pg_multilevel *multilevel, char *text, size_t size);
/* ---- a preconditioner that ranks share ----------------------------------------------------------------- */
/* What it is built from: rows of the nodes that this rank owns, whose couplings are with nodes held here.
 * sums: 1: nodes are functions of a coarse grid on a lattice; rows of all nodes held are read, and what all
 * ranks have of the row of a node is to be added up. */
typedef struct {
    /* Dimension of space; unknowns of a node, 1 to 6. */
    int     dim, block, sums;
    /* Of the nodes held here: positions, m (n x dim); 1 for each prescribed unknown, NULL: none is
     * (n x block); which are owned, and the halo (subdomain.n nodes). Borrowed, `fixed` as long as the
     * preconditioner is used. */
    const double *x;
    const unsigned char *fixed;
    const pg_subdomain *subdomain;
    /* Read only during creation, of nodes that are owned: rows of K, and masses of all unknowns held, kg. The
     * matrix is k K + m M (m 0: mass is not read). */
    pg_couplings rows;
    double k, m;
    const double *mass;
} pg_shared_rows;
/* One that all ranks make and use together, given from outside, as the library has none. solve: z = M r, of
 * vectors with an entry for each unknown held here (subdomain.n x block): those of ghosts are neither read
 * nor written; z = 0 at prescribed unknowns. M is symmetric positive definite. describe: in words. */
typedef struct {
    pg_status (*create)   (void **self, const pg_shared_rows *setting);
    pg_status (*solve)    (void *self, const double *r, double *z);
    void      (*describe) (const void *self, char *text, size_t size);
    void      (*free)     (void **self);
} pg_shared_preconditioner;
/* NULL: none from now on. Borrowed. */
void pg_shared_preconditioner_give (const pg_shared_preconditioner *type);
const pg_shared_preconditioner *pg_shared_preconditioner_now (void);

/* ---- finite elements as a preconditioner --------------------------------------------------------------- */
/* Rows of a matrix that are alike: row first + k has the numbers of row `first`, for nodes k higher. */
typedef struct { size_t first, count; } pg_row_run;
typedef struct { size_t n, cap; pg_row_run *run; } pg_row_runs;

/* A symmetric matrix of node blocks as a sum of element matrices, by rows with both triangles: row of node i
 * start[i] .. start[i + 1] - 1, nodes ascending, blocks row-major. Float: it serves preconditioners. */
typedef struct {
    /* Unknowns of a node; threads of its products. */
    int     block, threads;
    /* Number of nodes; most couplings of one of them. */
    size_t  n, widest;
    /* First coupling of each row (n + 1), its node (start[n]), its block (start[n] x block x block). */
    size_t *start;  int *node;  float *value;
    /* pg_block_settle: rows that are alike; numbers of the first row of each run, and where they begin (run);
     * vectors of a product, one for each unknown of a node. */
    pg_row_runs alike;
    double *model;  size_t *model_at;
    double *part[6];
} pg_block_matrix;
/* Pattern of the elements, whose nodes `elements` lists; all values zero. PG_E_MEMORY. */
pg_status pg_block_create (pg_block_matrix *out, size_t n, int block, const pg_adjacency *elements,
                           int threads);
void      pg_block_clear  (pg_block_matrix *A);
/* Adds the matrix of an element with m nodes (m block x m block, symmetric to the bit), of the pattern. */
void      pg_block_add    (pg_block_matrix *A, size_t m, const int *node, const double *K);
/* Adds to the diagonal of an unknown; nothing where the node is in no element. */
void      pg_block_add_diagonal (pg_block_matrix *A, size_t unknown, double value);
/* All has been added: products go faster from here on, where rows are alike. PG_E_MEMORY. */
pg_status pg_block_settle (pg_block_matrix *A);
/* As an operator, and as rows for pg_multilevel (reach: pg_couplings.reach); both borrow A. */
pg_operator  pg_block_operator  (pg_block_matrix *A);
pg_couplings pg_block_couplings (pg_block_matrix *A, double reach);

/* Multilinear functions ("hats") on a grid over the nodes of a cloud; where the couplings leave the nodes
 * under one in several parts, each part has a function of its own. Together they reproduce every linear
 * field. */
typedef struct {
    /* Dimension; threads. */
    int     dim, threads;
    /* Number of nodes and their positions, m (n x dim). */
    size_t  n;
    const double *x;
    /* Which nodes are coupled; asked for nodes only. */
    pg_couplings rows;
    /* Step of the grid, m. */
    double  step;
} pg_hats_setting;
typedef struct {
    /* Numbers of nodes, functions, cells of the grid; functions at a node (2^dim); threads of transfers. */
    size_t  n, count, ncell;
    int     corners, threads;
    /* Functions at each node, -1: none, and their values there (n x corners). */
    int    *function;  float *value;
    /* Where each function stands, m (count x dim). */
    double *place;
    /* Nodes of each function, and its values there, from first[f] to first[f + 1] - 1 (first: count + 1). */
    size_t *first;  int *member;  float *share;
    /* Nodes of each cell of the grid, ascending, in the same way (ncell + 1). */
    size_t *cell_first;  int *cell_node;
} pg_hats;
pg_status pg_hats_create (pg_hats *out, const pg_hats_setting *setting);
void      pg_hats_clear  (pg_hats *hats);
/* y = H' x and y += H x: x and y have block numbers a node, or a function. */
void      pg_hats_restrict (const pg_hats *hats, int block, const double *x, double *y);
void      pg_hats_add      (const pg_hats *hats, int block, const double *x, double *y);

/* A sparse matrix with one number for each pair of nodes, by rows (n + 1, start[n]). */
typedef struct { size_t n; size_t *start; int *node; float *value; } pg_node_matrix;
void pg_node_matrix_clear (pg_node_matrix *A);

/* Finite elements on the nodes of a smooth approximation, or on a coarse grid over them. */
typedef struct {
    /* Their stiffness, N/m, supports included. */
    pg_block_matrix Q;
    /* Elements on a coarse grid: the functions whose coefficients are the unknowns of Q, and the diagonal of
     * K without stiff springs, N/m (unknowns of the nodes). Without: count 0, NULL. */
    pg_hats hats;
    double *diagonal;
    /* Row i: values of the shape functions at node i; start NULL: the unit matrix. */
    pg_node_matrix  N;
    /* Spacing of the nodes; no two nodes of an element are further apart than `reach`; steps of the
     * lattice that the nodes form, 0: none. m. */
    double spacing, reach, lattice[3];
    /* Constraints by stiff springs, each a column of W (unknowns x constraints) that makes the displacement
     * it holds, their stiffness (W.ncol), N/m, and the unknown of the elements that this displacement is.
     * None: W.ncol 0. */
    pg_sparse W;
    double *held;
    size_t *holds;
    /* Terms of the polynomial p, which interpolates 1 / sqrt (x^2 + floor^2) on [low, high]. */
    int     terms;
    double  low, high, floor;
} pg_elements;
void pg_elements_clear (pg_elements *elements);

/* How the preconditioner is made. */
typedef struct {
    /* Dimension of space. */
    int     dim;
    /* Positions of the nodes, m (n x dim); borrowed. */
    const double *x;
    /* 1: the displacement of this unknown is prescribed (n x block); NULL: none is. Borrowed. */
    const unsigned char *fixed;
    /* Of ranks that share the body: which nodes are owned; V, all of it where they are no lattice, is what
     * ranks have in common (pg_shared_preconditioner_now). Vectors are read and written at owned nodes, z = 0
     * at ghosts. NULL: the process is alone. Borrowed. */
    const pg_subdomain *subdomain;
} pg_element_setting;
typedef struct pg_element_preconditioner pg_element_preconditioner;
/* z = p (N) V p (N)' r, V one cycle of pg_multilevel on Q, p a polynomial for 1 / x; with elements on a
 * coarse grid z = D^-1 r + H V H' r. Symmetric positive definite where no unknown is fixed. Stiff springs
 * beside K, K + W h W' with h >> K, are taken on their own: S p V p' S + W (W'W)^-1 h^-1 (W'W)^-1 W' with
 * S = I - W (W'W)^-1 W' and elements that are held there. Takes over the elements, which are empty
 * afterwards, also where it fails. */
pg_status pg_element_preconditioner_create (pg_element_preconditioner **out, pg_elements *elements,
                                            const pg_element_setting *setting);
void      pg_element_preconditioner_free   (pg_element_preconditioner **preconditioner);
/* In the form that conjugate gradients take; borrows it. */
pg_preconditioner pg_element_preconditioner_of (pg_element_preconditioner *preconditioner);
/* V in words, where ranks share it. */
void pg_element_preconditioner_describe (const pg_element_preconditioner *preconditioner, char *text,
                                         size_t size);
/* 1: elements on a coarse grid. */
int pg_element_preconditioner_on_grid (const pg_element_preconditioner *preconditioner);
/* The levels of V, for reports. */
const pg_multilevel *pg_element_preconditioner_levels (const pg_element_preconditioner *preconditioner);
PG_API_END
#endif
