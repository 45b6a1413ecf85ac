/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: the levels of the multilevel preconditioner, a V-cycle whose coarse spaces are built from
 * grids over the nodes (doc/method.md, How the systems are solved).
 *
 * Files: multilevel.c (creation, coarsest level), multilevel_space.c (coarse functions of a level),
 * multilevel_matrix.c (their matrix), multilevel_cycle.c (smoothing, transfers, the cycle),
 * multilevel_ranks.c (a finest level that ranks share), multilevel_whole.c (coarse levels that each rank
 * has in full).
 *
 * Unknown k of node i has the number i * block + k. A masked unknown (prescribed, or without stiffness)
 * takes no part: its inverse diagonal is stored as 0. Each vertex of a grid has a hat function,
 * multilinear on the grid, 1 at its vertex and 0 at all others; all hat functions together are a
 * partition of unity. A `function` is a hat function, or the part of one on one side of a crack;
 * functions are the nodes of the next level. */
#ifndef PG_MULTILEVEL_H
#define PG_MULTILEVEL_H
#include "perigal/linalg.h"

/* Levels at most; unknowns per node at most. */
enum { MOST_LEVELS = 12, MOST_BLOCK = 6 };

/* Data of a finest level that ranks share. box: lattice sites that each rank owns (size); sites: of the whole
 * lattice along each axis; from: index in the halo of the neighbour that owns each node, or MINE, or NOBODYS
 * (n). While functions are found: joined: disjoint sets of entries of `function` (pg_disjoint); label: number
 * of the function at each entry, the same on all ranks (n x corners). */
enum { MINE = -1, NOBODYS = -2 };
typedef struct {
    pg_box *box;
    size_t  size;
    long long sites[3];
    int    *from, *joined;
    double *label;
} level_ranks;

/* Grid of the coarse functions of a level. */
typedef struct {
    /* Position of its first vertex and its steps, m. */
    double  low[3], step[3];
    /* cells: cells along each axis. share_of: lattice steps per cell along each axis where the nodes form a
     * lattice, each node in the middle of a step unless aligned; 0: no lattice. */
    int     cells[3], share_of[3];
    int     aligned;                                   /* as in pg_multilevel_setting, on all levels */
    /* Numbers of cells, of hat functions, of functions. */
    size_t  ncell, nvertex, nfunction;
} level_grid;
/* The coarse functions of a level: hat functions on the grid, parted where the matrix does not couple. */
typedef struct {
    /* Cell of each node (n). */
    int    *cell;
    /* Nodes of each cell, ascending: cell_start (ncell + 1), cell_node (n). */
    size_t *cell_start;  int *cell_node;
    /* First function of each hat function (nvertex + 1). */
    size_t *first;
    /* Function at each corner of a node's cell, of its parts the one with this node; -1: none (n x
     * corners). */
    int    *function;
    /* Value of this function at the node (n x corners). */
    float  *weight;
    /* Nodes of function f and its values there: entries at[f] .. at[f + 1] - 1 (at: nfunction + 1). */
    size_t *at;  int *member;  float *share;
} level_functions;
/* One level: its matrix, and the functions that make the next level. */
typedef struct {
    /* Dimension, unknowns per node, threads, corners of a coarse cell (2^dim). */
    int     dim, block, threads, corners;
    /* Numbers of nodes and of unknowns. */
    size_t  n, ndof;
    /* Positions of the nodes, m (n x dim): the caller's on the finest level, on coarse levels those of
     * `places`, which are the level's own. */
    const double *x;
    double *places;
    /* No coupling goes further than this along each axis, m. */
    double  reach[3];
    /* The matrix: on the finest level an operator, with the rows of the caller; on coarse levels rows of
     * blocks, below. */
    const pg_operator *A;
    pg_couplings rows;
    /* Coarse levels: rows of blocks, nodes ascending: start (n + 1), node (start[n]), value (start[n] x
     * block x block). */
    size_t *start;  int *node;  double *value;
    /* Bit k is set where unknown k of the node is masked (n). */
    unsigned char *mask;
    /* 1 / diagonal; 0 where masked (ndof). */
    double *inverse;
    /* Upper bound of the eigenvalues of D^-1 A. */
    double  top;
    level_grid grid;                                   /* grid of the coarse functions */
    level_functions coarse;
    /* Vectors of the cycle (ndof): right-hand side and solution (on the finest level the caller's),
     * residual, step, A times step. */
    double *b, *z, *r, *d, *q;
    /* Where ranks share the level: nodes that this rank owns, and the halo (NULL: a single process). made:
     * the same of a coarse level, which owns it. origin: position of site 0 of the whole lattice, m. */
    const pg_subdomain *part;
    pg_subdomain *made;
    level_ranks  *ranks;
    double origin[3];
} level;

/* The levels, the factor of the coarsest matrix, and counts. */
struct pg_multilevel {
    /* Number of levels; products with A in one smoothing. */
    int     count, degree;
    level   at[MOST_LEVELS];
    /* State of the direct solver on the coarsest level. */
    void   *factor;
    const pg_linear_type *direct;
    size_t  applications;
    /* Where ranks share the finest level: `meet` has the coarse functions that this rank holds, and what the
     * nodes that it owns contribute to their matrix and right-hand side. The sums over all ranks are level 1
     * on every rank (whole: index of each function there), or go to a preconditioner that the ranks build
     * together (shared, made by `below`) and that replaces all coarse levels; slot, total: workspace of the
     * sums. unknowns: of the finest level, of all ranks. */
    level   meet;
    int    *whole, *slot;
    double *total;
    void   *shared;
    const pg_shared_preconditioner *below;
    double  unknowns;
};

/* ---- multilevel_space.c -------------------------------------------------------------------------------- */
/* Chooses grid and functions of the next level; step: wanted size of its cells, m. */
pg_status level_space (level *l, double step);
/* Returns the hat function at a corner of a cell (bit k of corner: high along axis k). level_vertex_place:
 * indices of a hat function's vertex on the grid (3). */
size_t level_vertex (const level *l, size_t cell, int corner);
void   level_vertex_place (const level *l, size_t vertex, int *at);
/* ---- multilevel_matrix.c ------------------------------------------------------------------------------- */
/* Lists the nodes that node i is coupled with, and their blocks, row-major (value NULL: nodes only). Returns
 * how many. */
size_t level_row (const level *l, size_t i, int thread, int *node, double *value);
/* Builds the matrix of the next level, P' A P. */
pg_status level_coarsen (level *coarse, const level *fine);
/* Fills mask and inverse from the matrix; fixed: prescribed unknowns (finest level), or NULL. */
pg_status level_diagonal (level *l, const unsigned char *fixed);
/* ---- multilevel_cycle.c -------------------------------------------------------------------------------- */
/* y = A x on this level. */
void      level_multiply (const level *l, const double *x, double *y);
/* Sets l->top, the upper bound of the eigenvalues of D^-1 A. */
pg_status level_bound (level *l);
/* z = M b: a V-cycle over the levels from k down. */
pg_status multilevel_cycle (pg_multilevel *m, int k, const double *b, double *z);
/* ---- multilevel_ranks.c: in a single process these do nothing ------------------------------------------ */
/* Called before the functions of the finest level are made: all ranks agree on the step (the largest, m), on
 * masked unknowns and on the origin. */
pg_status level_join (level *l, double *step);
void      level_ranks_free (level_ranks **ranks);
/* Moves the first vertex of the grid down along an axis to a vertex of the grid that all ranks have in
 * common. */
void      level_align (level *l, int axis);
/* Finds the parts of hat functions over all ranks from the sets `joined` of each: sets `function` to the part
 * that each node is in; parts: number of parts of each hat function with nodes held here. */
pg_status level_agree_parts (level *l, size_t *parts);
/* Copies the values of x (ndof) at ghosts from their owners. */
pg_status level_exchange (const level *l, double *x);
/* Returns the sum of `mine` over all ranks; NaN if the exchange fails. */
double    level_sum (const level *l, double mine);
/* Makes level 1 on every rank, or the preconditioner that the ranks build together, from m->meet; l:
 * finest. */
pg_status multilevel_meet (pg_multilevel *m, const level *l);
/* Sums meet.b over the ranks and solves by level 1, or by the common preconditioner, for meet.z. */
pg_status multilevel_solve_together (pg_multilevel *m);
/* ---- multilevel_whole.c -------------------------------------------------------------------------------- */
/* A coarse function: its number and vertex (the same on all ranks), the rank that owns it, whether nodes
 * owned by this rank contribute to its row, and its position, m. */
typedef struct { int64_t key, vertex; int owner, touched; double place[3]; } function_of_all;
/* Makes level 1 from the functions held here (meet.n) and their rows of m->meet. All ranks must call. */
pg_status multilevel_gather (pg_multilevel *m, const function_of_all *held);
#endif
