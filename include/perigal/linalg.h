/* SPDX-License-Identifier: GPL-3.0-or-later
 * linalg.h: sparse matrices, matrix-free operators, assembly, linear solvers and preconditioners. A solver
 * is an entry of the catalogue: src/linalg/NAME.c and one line in list.h. */
#ifndef PERIGAL_LINALG_H
#define PERIGAL_LINALG_H
#include "perigal/base.h"
#include "perigal/ranks.h"

PG_API_BEGIN

/* ---- operators and matrices ---------------------------------------------------------------------------- */
/* A linear operator A (n x n) given by functions instead of a matrix. */
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

/* A global matrix of dense node blocks is the sum of the contributions of its sources. A source is a list of
 * points (elements of a mesh, evaluation points, or bonds), each of which couples all pairs of its nodes.
 * Assembly goes by rows: the row of a node collects from all points that have the node. So no two threads
 * write to the same place, sums have the same order for any number of threads, and redoing some rows after a
 * change is the same routine as the first assembly. */
typedef struct {
    /* The nodes of each point; borrowed. */
    const pg_adjacency *seen;
    void *context;
    /* Blocks K_ab (block x block, row-major) of point p between its local nodes a and b = 0 .. m - 1,
     * written one behind the other to out, which is zero on entry. Called by several threads. */
    void (*blocks) (void *context, size_t p, size_t a, size_t m, double *out);
    /* Instead (blocks NULL): block rows of m block numbers, row i that of unknown i of node a, entry b block
     * + j for unknown j of node b; out is zero on entry. They are summed over all points of the source first,
     * many numbers at a time. finish: converts sums for m nodes in place into rows of K, where `rows` writes
     * other numbers; NULL: they are rows of K. */
    void (*rows)   (void *context, size_t p, size_t a, size_t m, double *out);
    void (*finish) (void *context, size_t m, double *rows);
    /* Result of another assembly of this source alone, used once, when all rows are first computed; borrowed
     * until then. NULL: none. */
    const struct pg_assembly *known;
} pg_assembly_source;

/* A matrix under assembly: pattern, values, and data for recomputing rows. */
typedef struct pg_assembly pg_assembly;
/* Finds the pattern of all sources on n nodes with `block` unknowns each; no values yet. The sources are
 * copied, their lists borrowed. PG_E_MEMORY. */
pg_status pg_assembly_create (pg_assembly **out, size_t n, int block, size_t nsource,
                              const pg_assembly_source *sources);
void      pg_assembly_free   (pg_assembly **assembly);
/* Frees all data but the values, after which the assembly can only serve as `known` of a source. */
void      pg_assembly_settle (pg_assembly *assembly);
/* Computes the rows of the nodes list[0 .. count - 1] anew (list NULL: those of nodes 0 .. count - 1). */
pg_status pg_assembly_gather (pg_assembly *assembly, size_t count, const int *list, int threads);
/* The matrix, borrowed: its upper triangle; zeros that the pattern holds are stored. */
pg_sparse *pg_assembly_matrix (pg_assembly *assembly);

/* Makes the graph of the nodes: entry (J, I), J <= I, where a point of some list has both nodes (values
 * NULL). */
pg_status pg_assembly_graph (pg_sparse *out, size_t n, size_t nlist, const pg_adjacency *const *lists);
/* Makes the graph of the nodes for pairwise forces: entry (J, I), J <= I, where J is in the list of I, and
 * the diagonal (values NULL). seen: symmetric lists of neighbours without the node's own number. */
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
    /* Solves for nrhs right-hand sides (n x nrhs) with few nonzero entries near each other, such as unit
     * forces; NULL: use solve. */
    pg_status (*solve_few) (void *self, size_t nrhs, const double *b, double *x);
    /* Half a solve: y_i = L^-1 b_i with A = L L', so that b_i . A^-1 b_j = y_i . y_j. y: nrhs columns of
     * length n; only entries from first[2 k] to before first[2 k + 1], k < *count, are written (first:
     * borrowed until the next call); all others are zero. NULL: not available. */
    pg_status (*half_few) (void *self, size_t nrhs, const double *b, double *const *y, size_t *count,
                           const size_t **first);
    /* Fills in the report; frees the state. */
    void      (*info)    (const void *self, pg_linear_info *info);
    void      (*free)    (void **self);
    /* Factorises as `factor`, and calls `taken` (once or not at all) when A has been read, before the factor
     * is made: the caller may free A there, so that both are never in memory together. NULL: not
     * available. */
    pg_status (*factor_taking) (void *self, const pg_sparse *A, void (*taken) (void *context), void *context);
} pg_linear_type;
/* The entry of that name, NULL: there is none. */
const pg_linear_type *pg_linear_find  (const char *name);
/* A program adds an entry of its own (perigal-mpi: by PETSc), which then is the usual solver of its kind;
 * NULL: it is taken away. Borrowed; one at a time. */
void                  pg_linear_add   (const pg_linear_type *type);
/* Solver for solver.linear: auto: the added entry, if it has these flags, else pg_linear_first. */
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
 * same ordering, and a symbolic analysis of the graph of the nodes alone. graph: upper triangle with
 * diagonal; values are ignored. many: as in pg_linear_options. */
pg_status pg_linear_forecast (const pg_sparse *graph, int block, int many, pg_linear_info *info);

/* Conjugate gradients with the diagonal as preconditioner. x: first guess in, solution out. Stops at |r| <=
 * tolerance |b|. PG_E_EQUILIBRIUM after `limit` iterations, PG_E_NOT_SPD where p.A p <= 0. Sums are taken
 * in chunks of fixed size, so that the bits do not depend on the number of threads. */
pg_status pg_conjugate_gradients (const pg_operator *A, const double *b, double *x, double tolerance,
                                  size_t limit, size_t *iterations);

/* A preconditioner, symmetric positive definite: solve: z = P^-1 r. threads: for the vector operations of the
 * solver. */
typedef struct {
    void *context;
    pg_status (*solve) (void *context, const double *r, double *z);
    int threads;
} pg_preconditioner;
/* pg_conjugate_gradients with a preconditioner P of the caller's; P NULL: the diagonal of A. */
pg_status pg_conjugate_gradients_with (const pg_operator *A, const pg_preconditioner *P, const double *b,
                                       double *x, double tolerance, size_t limit, size_t *iterations);
/* Reusable workspace of n numbers; initially zero, freed by pg_free (room.v). */
typedef struct { double *v; size_t n; } pg_cg_room;
/* Options and callback of conjugate gradients. `stepped` (or NULL) is called after every iteration: x has
 * changed by alpha times the vector to which A was applied last. An operator that keeps more rows of that
 * product than are solved for, such as those of prescribed unknowns, can thus update b - A x of all rows.
 * `residual` is |b - A x| / |b|. *stop = 1 ends the iterations as if the tolerance were met; an error ends
 * them too, and is returned. */
typedef struct {
    pg_status (*stepped) (void *context, double alpha, double residual, int *stop);
    void  *context;
    /* 1: the residual is local: entries of search directions where the residual is within tolerance are set
     * to zero, so that products can skip them. Only with the diagonal preconditioner. */
    int    local;
    /* 1: A is distributed over MPI ranks (perigal/ranks.h): vectors are this rank's part, with entries 0 (in
     * b, A x) for unknowns of other ranks; dot products are summed over all ranks, and all ranks make the
     * same calls. */
    int    shared;
    /* Workspace for the vectors, kept by the caller between solves; NULL: allocated per solve. */
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
/* Rows of a matrix of node blocks, or of a sparser approximation of it, which must have the same rigid
 * motions and energies that agree within a small factor. The multilevel preconditioner is built from
 * these. */
typedef struct {
    void  *context;
    /* Largest number of couplings of one node, its own block among them. */
    size_t widest;
    /* No two nodes further apart than this are coupled, m. */
    double reach;
    /* Couplings of node i, itself among them, in any order: writes nodes (m) and, unless value is NULL,
     * blocks (m x block x block), and returns m. Called by several threads, each with its own number. */
    size_t (*row) (void *context, size_t i, int thread, int *node, double *value);
    /* Steps of the lattice that the nodes form, m; 0: none. alike (i): 1: the row of node i equals those of
     * all other nodes with 1: equal blocks at equal offsets, in the same order. NULL: not known. */
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
    /* Parallel runs, nodes on a lattice (aligned): which nodes this rank owns, borrowed. Only rows of owned
     * nodes are read, which are complete. All ranks call; levels below the first coarse grid are replicated
     * on every rank while they are small, else solved by a pg_shared_preconditioner. Vectors are read and
     * written at owned nodes. NULL: serial run. */
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
    /* Number of functions of the first coarse grid that cracks or gaps have split. */
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
/* Describes the numbers of unknowns on the levels of a distributed preconditioner in text (size bytes). */
void      pg_multilevel_describe_shared (const pg_multilevel *multilevel, char *text, size_t size);
/* ---- distributed preconditioner ------------------------------------------------------------------------ */
/* Data of a distributed preconditioner: rows of the nodes that this rank owns, coupled with nodes stored here
 * (owned or ghosts). sums: 1: nodes are functions of a coarse grid on a lattice; the rows of all nodes stored
 * are read, and contributions of all ranks to a row are to be added. */
typedef struct {
    /* Dimension of space; unknowns of a node, 1 to 6. */
    int     dim, block, sums;
    /* Nodes stored here (n = subdomain.n): positions, m (n x dim); 1 for each prescribed unknown, NULL: none
     * is (n x block); which are owned, and the exchange of ghosts. Borrowed, `fixed` as long as the
     * preconditioner is used. */
    const double *x;
    const unsigned char *fixed;
    const pg_subdomain *subdomain;
    /* The matrix is k K + m M: rows of K for owned nodes, and masses of all unknowns stored here, kg (not
     * read if m = 0). Read only during creation. */
    pg_couplings rows;
    double k, m;
    const double *mass;
} pg_shared_rows;
/* A distributed preconditioner, which all ranks create and use together; it comes from the calling program,
 * as the library has none. solve: z = M r, vectors with an entry for each unknown stored here (subdomain.n x
 * block): those of ghosts are neither read nor written; z = 0 at prescribed unknowns. M is symmetric positive
 * definite. describe: in words. */
typedef struct {
    pg_status (*create)   (void **self, const pg_shared_rows *setting);
    pg_status (*solve)    (void *self, const double *r, double *z);
    void      (*describe) (const void *self, char *text, size_t size);
    void      (*free)     (void **self);
} pg_shared_preconditioner;
/* Sets the distributed preconditioner of the program (borrowed); NULL: none from now on. */
void pg_shared_preconditioner_give (const pg_shared_preconditioner *type);
const pg_shared_preconditioner *pg_shared_preconditioner_now (void);

/* ---- finite elements as a preconditioner --------------------------------------------------------------- */
/* A run of equal matrix rows: row first + k has the values of row `first`, at column nodes k higher. */
typedef struct { size_t first, count; } pg_row_run;
typedef struct { size_t n, cap; pg_row_run *run; } pg_row_runs;

/* A symmetric matrix of node blocks as a sum of element matrices, by rows with both triangles: row of node i
 * start[i] .. start[i + 1] - 1, nodes ascending, blocks row-major. Single precision, for preconditioners. */
typedef struct {
    /* Unknowns of a node; threads of its products. */
    int     block, threads;
    /* Number of nodes; most couplings of one of them. */
    size_t  n, widest;
    /* First coupling of each row (n + 1), its node (start[n]), its block (start[n] x block x block). */
    size_t *start;  int *node;  float *value;
    /* Made by pg_block_settle: runs of equal rows; values of the first row of each run, and their start
     * (run); workspace of products, one vector for each unknown of a node. */
    pg_row_runs alike;
    double *model;  size_t *model_at;
    double *part[6];
} pg_block_matrix;
/* Creates the sparsity pattern of elements with the nodes listed in `elements`; all values zero.
 * PG_E_MEMORY. */
pg_status pg_block_create (pg_block_matrix *out, size_t n, int block, const pg_adjacency *elements,
                           int threads);
void      pg_block_clear  (pg_block_matrix *A);
/* Adds the matrix of an element of the pattern with m nodes (m block x m block, exactly symmetric). */
void      pg_block_add    (pg_block_matrix *A, size_t m, const int *node, const double *K);
/* Adds to the diagonal of an unknown; nothing where the node is in no element. */
void      pg_block_add_diagonal (pg_block_matrix *A, size_t unknown, double value);
/* Ends the assembly and prepares faster products for equal rows. PG_E_MEMORY. */
pg_status pg_block_settle (pg_block_matrix *A);
/* The matrix as an operator, and as rows for pg_multilevel (reach: pg_couplings.reach, m); both borrow A. */
pg_operator  pg_block_operator  (pg_block_matrix *A);
pg_couplings pg_block_couplings (pg_block_matrix *A, double reach);

/* Multilinear functions ("hats") on a grid over the nodes of a cloud; where the nodes under a hat are in
 * several parts without couplings between them, each part has a function of its own. Together they reproduce
 * every linear field. */
typedef struct {
    /* Dimension; threads. */
    int     dim, threads;
    /* Number of nodes and their positions, m (n x dim). */
    size_t  n;
    const double *x;
    /* Which nodes are coupled; its values are not read. */
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
    /* Grid vertex of each function, m (count x dim). */
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
    /* Stiffness matrix of the elements, N/m, supports included. */
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
    /* Constraints by stiff springs: W (unknowns x constraints), whose columns give the constrained
     * displacements; spring stiffness, N/m, and the unknown of the elements that corresponds to each of these
     * displacements (W.ncol each). None: W.ncol 0. */
    pg_sparse W;
    double *held;
    size_t *holds;
    /* Number of terms of the polynomial p that interpolates 1 / sqrt (x^2 + floor^2) on [low, high]. */
    int     terms;
    double  low, high, floor;
} pg_elements;
void pg_elements_clear (pg_elements *elements);

/* Setting of the preconditioner by finite elements. */
typedef struct {
    /* Dimension of space. */
    int     dim;
    /* Positions of the nodes, m (n x dim); borrowed. */
    const double *x;
    /* 1: the displacement of this unknown is prescribed (n x block); NULL: none is. Borrowed. */
    const unsigned char *fixed;
    /* Parallel runs: which nodes this rank owns; V (where the nodes are no lattice: all of it) is then the
     * distributed preconditioner (pg_shared_preconditioner_now). Vectors are read and written at owned nodes,
     * z = 0 at ghosts. NULL: serial run. Borrowed. */
    const pg_subdomain *subdomain;
} pg_element_setting;
typedef struct pg_element_preconditioner pg_element_preconditioner;
/* Creates z = p (N) V p (N)' r, V one cycle of pg_multilevel on Q, p a polynomial approximating 1 / x; with
 * elements on a coarse grid z = D^-1 r + H V H' r. Symmetric positive definite where no unknown is fixed.
 * Stiff springs beside K, K + W h W' with h >> K, are treated separately: S p V p' S + W (W'W)^-1 h^-1
 * (W'W)^-1 W' with S = I - W (W'W)^-1 W' and elements fixed there. Takes ownership of the elements, which are
 * empty afterwards, also on failure. */
pg_status pg_element_preconditioner_create (pg_element_preconditioner **out, pg_elements *elements,
                                            const pg_element_setting *setting);
void      pg_element_preconditioner_free   (pg_element_preconditioner **preconditioner);
/* The preconditioner in the form used by conjugate gradients; borrowed. */
pg_preconditioner pg_element_preconditioner_of (pg_element_preconditioner *preconditioner);
/* Describes V in words in parallel runs. */
void pg_element_preconditioner_describe (const pg_element_preconditioner *preconditioner, char *text,
                                         size_t size);
/* Returns 1: the elements are on a coarse grid. */
int pg_element_preconditioner_on_grid (const pg_element_preconditioner *preconditioner);
/* The multilevel preconditioner V, for reports. */
const pg_multilevel *pg_element_preconditioner_levels (const pg_element_preconditioner *preconditioner);
PG_API_END
#endif
