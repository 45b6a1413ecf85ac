/* SPDX-License-Identifier: GPL-3.0-or-later
 * moment.h: the live bonds of one point (its star), their basis and moment matrix; shared by all
 * approximations. Lengths are in horizons: z = (x_j - x) / a, a the support at the point (that of its nearest
 * node where spacings differ; w_j has its own a_j, and nothing but rounding depends on a). The weights of a
 * star sum to 1: no unit and no volume scale enters. */
#ifndef PERIGAL_APPROX_MOMENT_H
#define PERIGAL_APPROX_MOMENT_H
#include "perigal/approx.h"

enum { PG_BASIS_MAX = 10 };
#define PG_STEEPEST 12.0  /* a |dN| above it: the bonds left cannot bear the basis */
#define PG_STEEPEST_QUADRATIC 20.0
#define PG_THINNEST 1e-3  /* a direction is lost where the second moment is below this h^2 */

typedef struct {
    int     dim, order, size;  /* basis in use: 1 linear, 2 quadratic; number of functions */
    int     constant;  /* 1: the basis starts with 1; 0: no 1 (nosb about a node) */
    double  a, h;                                      /* support and spacing at the point, m */
    double *ratio;                                     /* a / a_j; NULL: 1 (n) */
    size_t  n;                                         /* live bonds with w > 0 */
    size_t  own;  /* place of the own node in the row, where constant = 0 */
    int     stray;                                     /* 1: a node that must be in its own family is not */
    int     lost;                                      /* 1: a bond of the family is dead */
    int     extrapolates;  /* 1: unless it has, its neighbours may spread as little as the factor bears */
    size_t *entry;                                     /* place in the row (n) */
    double *z;                                         /* bond in horizons (n x dim) */
    double *w;                                         /* weight (n) */
    double *slope;                                     /* a dw/dx (n x dim) */
    double *p;                                         /* basis at z (n x size) */
    double *q, *k, *dk;                                /* arguments and values of the kernel (n x dim) */
    int     project;                                   /* 1: what is left of a linear basis may be used */
    int     projected;                                 /* 1: it is: p about `centre`, G in place of L */
    double  L[PG_BASIS_MAX * PG_BASIS_MAX];            /* Cholesky factor of A = sum w p p' */
    double  G[16];                                     /* generalised inverse of A (size x size) */
    double  centre[3];                                 /* sum w z (dim) */
} pg_neighbourhood;

/* values (NULL: it has none): N alone, the same bits. What an approximation adds to the common loop: N (row)
 * and dN (row x dim, 1/m), zero on entry, of a point with a full, lowered or projected basis. about_node: a
 * point that is a node expands about its own value (basis without 1, own node no neighbour). */
typedef struct {
    int about_node;
    void (*fill) (const pg_neighbourhood *star, double *N, double *dN);
    void (*values) (const pg_neighbourhood *star, double *N);
} pg_formula;

/* The loop over points: live bonds, degenerate rule, formula. */
pg_status pg_moment_sweep (const pg_formula *formula, const pg_approx *a, const pg_cloud *cloud,
                           pg_rows *rows, const unsigned char *alive, size_t count, const size_t *list,
                           int threads);

/* Chooses the basis (`order` or less), fills p and L or G; spacing h in m. Returns a PG_GRADE_... */
int  pg_neighbourhood_grade   (pg_neighbourhood *star, int order, double h);
/* Finds the directions of the linear basis that are left, fills p, G and centre; 0: none is. */
int  pg_neighbourhood_project (pg_neighbourhood *star, double h);
/* M (dim x dim) = sum w (z - centre) (z - centre)', lower triangle */
void pg_neighbourhood_spread  (const pg_neighbourhood *star, const double *centre, double *M);
/* centre (dim) = sum w z */
void pg_neighbourhood_centre  (const pg_neighbourhood *star, double *centre);
/* b = A^-1 b */
void pg_neighbourhood_invert  (const pg_neighbourhood *star, double *b);
/* b with A b = unit vector `row` of the basis, or p at the point itself for the row of the 1. */
void pg_neighbourhood_solve   (const pg_neighbourhood *star, int row, double *b);
/* N_j = w_j p_j . b */
void pg_neighbourhood_shape   (const pg_neighbourhood *star, const double *b, double *N);
/* dN_j = (1/a) e_k' A^-1 p_j w_j, e_k the row of z_k: theory E1 (with the 1), D1 (without). */
void pg_neighbourhood_differential (const pg_neighbourhood *star, double *dN);
/* d (b . p) / dz at z (dim), for a basis with the 1 */
void pg_basis_slope  (const pg_neighbourhood *star, const double *z, const double *b, double *slope);
#endif
