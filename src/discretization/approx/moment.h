/* SPDX-License-Identifier: GPL-3.0-or-later
 * moment.h: the live bonds of one place, their basis and moment matrix, shared by all
 * approximations. Lengths are in horizons: z = (x_j - x) / a with the support radius a at the
 * place (that of its nearest node where spacings differ; each weight w_j has the radius a_j of
 * its own node, and nothing but rounding depends on a). The weights of a place sum to 1, so
 * that neither a unit nor a scale of volumes enters. */
#ifndef PERIGAL_APPROX_MOMENT_H
#define PERIGAL_APPROX_MOMENT_H
#include "perigal/approx.h"

/* Largest basis: 1 + 3 + 6 in three dimensions. */
enum { PG_BASIS_MAX = 10 };
/* Largest a |dN| for which the bonds that are left count as able to carry the basis (intact:
 * up to 3). */
#define PG_STEEPEST 12.0
#define PG_STEEPEST_QUADRATIC 20.0
/* A direction counts as lost where the second moment along it is below this times h^2. */
#define PG_THINNEST 1e-3

/* The live bonds of one place. */
typedef struct {
    /* Dimension; order of the basis in use (1 linear, 2 quadratic) and number of its
     * functions. */
    int     dim, order, size;
    /* 1: the basis begins with 1; 0: it does not (nosb at a node). */
    int     constant;
    /* Support radius and spacing at the place, m; of a stretched support along and across it, and how much
     * longer than wide it is (1: a ball). */
    double  a, h, slender;
    /* How much wider than others this support is; 1: N and dN are refined. */
    double  wide;
    int     refined;
    /* a / a_j of each bond (n); NULL: all are 1. */
    double *ratio;
    /* Number of live bonds with a weight above zero. */
    size_t  n;
    /* Entry of the own node in the row, where constant = 0. */
    size_t  own;
    /* 1: a node that must be in its own family is not. */
    int     stray;
    /* A row with a weight that is not finite, plus 1; 0: none. */
    size_t  strange;
    /* 1: a bond of the family is dead. */
    int     lost;
    /* 1: as long as no bond is lost the neighbours may spread as little as the factor of A
     * allows. */
    int     extrapolates;
    /* Entry of each bond in the row (n). */
    size_t *entry;
    /* Bonds in horizons (n x dim). */
    double *z;
    /* Weights (n). */
    double *w;
    /* a dw/dx at the place, in the scale of the weights (n x dim); sloped = 0: not computed, since nobody
     * asks for derivatives. */
    double *slope;
    int     sloped;
    /* Basis at each z (n x size). */
    double *p;
    /* Arguments, values and derivatives of the kernel (n, tensor support: n x dim). */
    double *q, *k, *dk;
    /* 1: what is left of a linear basis may be used. */
    int     project;
    /* 1: it is used: p is taken about `centre`, and G stands in for A^-1. */
    int     projected;
    /* Cholesky factor of A = sum w p p'. */
    double  L[PG_BASIS_MAX * PG_BASIS_MAX];
    /* Generalised inverse of A (size x size). */
    double  G[16];
    /* Weighted mean of z (dim). */
    double  centre[3];
} pg_neighbourhood;

/* What an approximation adds to the common loop. about_node = 1: at a place that is a node it
 * expands about the value of that node (basis without the 1, the own node is no neighbour).
 * fill writes N (one row) and dN (row x dim, 1/m), both zero on entry, at a place with a full,
 * lowered or projected basis. values (NULL: there is none) writes N alone, with the same bits. */
typedef struct {
    int about_node;
    void (*fill) (const pg_neighbourhood *around, double *N, double *dN);
    void (*values) (const pg_neighbourhood *around, double *N);
} pg_formula;

/* The loop over places: gathers live bonds, applies the rule for too few of them, calls the
 * formula. Arguments as those of pg_approx_type.evaluate. PG_E_USAGE: a bad order, dimension
 * or horizon, or a node that is missing in its own family. */
pg_status pg_moment_evaluate (const pg_formula *formula, const pg_approx *a, const pg_cloud *cloud,
                           pg_rows *rows, const unsigned char *alive, size_t count, const size_t *list,
                           int threads);

/* Chooses the richest basis of at most `order` that the bonds can carry, fills p and L (or G),
 * and returns a PG_GRADE_...; h is the spacing, m. */
int  pg_neighbourhood_grade   (pg_neighbourhood *around, int order, double h);
/* Finds the directions of the linear basis that are left, fills p, G and centre; 0: none is
 * left. */
int  pg_neighbourhood_project (pg_neighbourhood *around, double h);
/* The second moment M (dim x dim, lower triangle) = sum w (z - centre) (z - centre)'. */
void pg_neighbourhood_spread  (const pg_neighbourhood *around, const double *centre, double *M);
/* centre (dim) = sum w z. */
void pg_neighbourhood_centre  (const pg_neighbourhood *around, double *centre);
/* Replaces b by A^-1 b, or by G b for a projected basis. */
void pg_neighbourhood_invert  (const pg_neighbourhood *around, double *b);
/* b = A^-1 e_row; for row 0 of a projected basis the right side is p at the place itself, (1,
 * - centre). */
void pg_neighbourhood_solve   (const pg_neighbourhood *around, int row, double *b);
/* N_j = w_j p_j . b, written to the entries of the bonds in the row. */
void pg_neighbourhood_shape   (const pg_neighbourhood *around, const double *b, double *N);
/* dN_j / dx_k = (1/a) e_k' A^-1 p_j w_j, where e_k is the row of z_k: E1 with the constant, D1
 * without it. */
void pg_neighbourhood_differential (const pg_neighbourhood *around, double *dN);
/* Iterative refinement of N and dN (NULL: of which there are none): where sums of the basis, in which linear
 * fields are reproduced, miss by more than 1e-14, the residual is taken off by the moment matrix that is
 * there, at most twice. */
void pg_neighbourhood_refine  (const pg_neighbourhood *around, double *N, double *dN);
/* p (z): the constant, if there is one, then z_k, then the products z_k z_l with l >= k. Inlined where the
 * compiler knows the numbers. */
static inline __attribute__ ((always_inline)) void pg_basis (int dim, int order, int constant,
                                                             const double *z, double *p)
{
    int m = 0;
    if (constant) p[m++] = 1;
    for (int k = 0; k < dim; k++) p[m++] = z[k];
    for (int k = 0; order == 2 && k < dim; k++)
        for (int l = k; l < dim; l++) p[m++] = z[k] * z[l];
}

/* The gradient of b . p with respect to z at z (dim), for a basis with the constant. */
static inline __attribute__ ((always_inline)) void pg_basis_slope (int dim, int order, const double *z,
                                                                   const double *b, double *slope)
{
    int m = 1 + dim;
    for (int k = 0; k < dim; k++) slope[k] = b[1 + k];
    for (int k = 0; order == 2 && k < dim; k++)
        for (int l = k; l < dim; l++, m++) {
            slope[k] += b[m] * z[l];
            slope[l] += b[m] * z[k];
        }
}
#endif
