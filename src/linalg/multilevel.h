/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: the levels of the multilevel preconditioner. Files: multilevel.c (life, coarsest level),
 * multilevel_space.c (coarse functions of a level), multilevel_matrix.c (their matrix), multilevel_cycle.c
 * (smoothing, transfers, the cycle). Unknown k of node i is i * block + k. A masked unknown (prescribed, or
 * without stiffness) takes no part: 1 / diagonal is 0 there. */
#ifndef PG_MULTILEVEL_H
#define PG_MULTILEVEL_H
#include "perigal/linalg.h"

enum { MOST_LEVELS = 12, MOST_BLOCK = 6 };

typedef struct {
    int     dim, block, threads, corners;              /* corners: of a coarse cell, 2^dim */
    size_t  n, ndof;
    double *x;                                         /* m (n x dim); finest: borrowed */
    double  reach[3];                                  /* m: no coupling goes further along the axes */
    /* the matrix: finest an operator and the caller's rows, else rows of blocks, nodes ascending */
    const pg_operator *A;
    pg_couplings rows;
    size_t *start;  int *node;  double *value;         /* (n + 1), (start[n]), (start[n] x block x block) */
    unsigned char *mask;                               /* bit k: unknown k is masked (n) */
    double *inverse;                                   /* 1 / diagonal, 0: masked (ndof) */
    double  top;                                       /* bound of the eigenvalues of D^-1 A, 1 */
    /* coarse functions: multilinear hats on a grid, one for each connected part of the nodes under a hat */
    double  low[3], step[3];
    /* share_of: lattice steps in a step, nodes in the middle of theirs; 0: no lattice */
    int     cells[3], share_of[3];
    size_t  ncell, nhat, nfunction;
    int    *cell;                                      /* of each node (n) */
    size_t *cell_start;  int *cell_node;               /* nodes of each cell, ascending (ncell + 1), (n) */
    size_t *first;                                     /* first function of each hat (nhat + 1) */
    int    *function;  /* of each corner of a node's cell, -1: none (n x corners) */
    float  *weight;                                    /* its value at the node (n x corners) */
    size_t *at;  int *member;  float *share;  /* the same by functions (nfunction + 1), (at[nfunction]) */
    double *b, *z, *r, *d, *q;                         /* (ndof); finest: b, z are the caller's */
} level;

struct pg_multilevel {
    int     count, degree;                             /* levels; products of a smoothing */
    level   at[MOST_LEVELS];
    void   *factor;                                    /* of the coarsest matrix */
    const pg_linear_type *direct;
    size_t  applications;
};

/* ---- multilevel_space.c -------------------------------------------------------------------------------- */
/* Chooses grid and functions of the next level; step: m, wanted. */
pg_status level_space (level *l, double step);
/* Grid index of corner c of a cell, and of a cell or hat from its place on the grid. */
size_t level_hat (const level *l, size_t cell, int corner);
void   level_hat_place (const level *l, size_t hat, int *at);
/* ---- multilevel_matrix.c ------------------------------------------------------------------------------- */
/* Nodes (m of them, returned) that node i is coupled with and the blocks, row by row; value NULL: nodes
 * only. */
size_t level_row (const level *l, size_t i, int thread, int *node, double *value);
pg_status level_coarsen (level *coarse, const level *fine);
/* mask and inverse from the rows and, on the finest level, the prescribed unknowns. */
pg_status level_diagonal (level *l, const unsigned char *fixed);
/* ---- multilevel_cycle.c -------------------------------------------------------------------------------- */
void      level_multiply (const level *l, const double *x, double *y);
pg_status level_bound (level *l);                      /* sets top */
pg_status multilevel_cycle (pg_multilevel *m, int k, const double *b, double *z);
#endif
