/* SPDX-License-Identifier: GPL-3.0-or-later
 * moment.h: the intact bonds of one position, their basis and moment matrix, shared by all approximations.
 * Lengths are in horizons: z = (x_j - x) / a with the support radius a at the position x (that of its
 * nearest node where spacings differ; each weight w_j has the radius a_j of its own node, and nothing but
 * rounding depends on a). The weights of a position sum to 1, so that neither a unit nor a scale of volumes
 * enters. */
#ifndef PERIGAL_APPROX_MOMENT_H
#define PERIGAL_APPROX_MOMENT_H
#include "perigal/approx.h"

/* Largest basis: 1 + 3 + 6 in three dimensions. */
enum { PG_BASIS_MAX = 10 };
/* Largest a |dN| (a: support radius) of positions that have lost bonds, with a linear and a quadratic basis;
 * above it a lower basis is used. Intact: up to 3. */
#define PG_STEEPEST 12.0
#define PG_STEEPEST_QUADRATIC 20.0
/* A direction is dropped from the basis where the second moment of the neighbours along it is below this
 * times h^2 (h: spacing). */
#define PG_THINNEST 1e-3

/* The intact bonds of one position. */
typedef struct {
    /* Dimension; order of the basis in use (1 linear, 2 quadratic) and number of its
     * functions. */
    int     dim, order, size;
    /* 1: the basis contains the constant function; 0: it does not (nosb at a node). */
    int     constant;
    /* Support radius and spacing at the position, m; of an anisotropic support along its long and its short
     * axis, whose ratio `slender` is (1: a ball). */
    double  a, h, slender;
    /* Radius of this support over the usual one; refined: 1: N and dN are iteratively refined. */
    double  wide;
    int     refined;
    /* a / a_j of each bond (n); NULL: all are 1. */
    double *ratio;
    /* Number of intact bonds with a weight above zero. */
    size_t  n;
    /* Entry of the node at the position itself in the row, where constant = 0. */
    size_t  own;
    /* 1: a node is missing in its own family, where it must be (an error). */
    int     stray;
    /* Number + 1 of a row with a weight that is not finite; 0: none. */
    size_t  strange;
    /* 1: a bond of the family is broken. */
    int     lost;
    /* 1: as long as no bond is lost, neighbours that lie almost on a line or plane are accepted, if only the
     * Cholesky factor of A exists. */
    int     extrapolates;
    /* Entry of each of these bonds in the row (n). */
    size_t *entry;
    /* Bond vectors in horizons (n x dim). */
    double *z;
    /* Weights (n). */
    double *w;
    /* a dw/dx at the position, in the scale of the weights (n x dim); sloped = 0: not computed, since no
     * derivatives are needed. */
    double *slope;
    int     sloped;
    /* Basis functions at each z (n x size). */
    double *p;
    /* Arguments, values and derivatives of the kernel (n, tensor support: n x dim). */
    double *q, *k, *dk;
    /* 1: where neighbours lie on a line or plane, a linear basis may be projected on it. */
    int     project;
    /* 1: the projected basis is in use: p is taken about `centre`, and G replaces A^-1. */
    int     projected;
    /* Cholesky factor of A = sum w p p'. */
    double  L[PG_BASIS_MAX * PG_BASIS_MAX];
    /* Generalised inverse of A (size x size). */
    double  G[16];
    /* Weighted mean of z (dim). */
    double  centre[3];
} pg_neighbourhood;

/* What an approximation adds to the common loop. about_node = 1: at a position that is a node it expands
 * about the value of that node (basis without the constant, the node is not its own neighbour). fill writes N
 * (one row) and dN (row x dim, 1/m), both zero on entry, from a full, lowered or projected basis. values
 * (NULL: there is none) writes N alone, with the same bits. */
typedef struct {
    int about_node;
    void (*fill) (const pg_neighbourhood *around, double *N, double *dN);
    void (*values) (const pg_neighbourhood *around, double *N);
} pg_formula;

/* The loop over evaluation points: gathers intact bonds, lowers the basis where they are too few, calls the
 * formula. Arguments as those of pg_approx_type.evaluate. PG_E_USAGE: a bad order, dimension or horizon, or a
 * node that is missing in its own family. */
pg_status pg_moment_evaluate (const pg_formula *formula, const pg_approx *a, const pg_cloud *cloud,
                           pg_rows *rows, const unsigned char *alive, size_t count, const size_t *list,
                           int threads);

/* Chooses the richest basis of at most `order` that the bonds can carry, fills p and L (or G),
 * and returns a PG_GRADE_...; h is the spacing, m. */
int  pg_neighbourhood_grade   (pg_neighbourhood *around, int order, double h);
/* Finds the directions of the linear basis in which the neighbours spread, fills p, G and centre. Returns 0
 * if there is none. */
int  pg_neighbourhood_project (pg_neighbourhood *around, double h);
/* The second moment M (dim x dim, lower triangle) = sum w (z - centre) (z - centre)'. */
void pg_neighbourhood_spread  (const pg_neighbourhood *around, const double *centre, double *M);
/* centre (dim) = sum w z. */
void pg_neighbourhood_centre  (const pg_neighbourhood *around, double *centre);
/* Replaces b by A^-1 b, or by G b for a projected basis. */
void pg_neighbourhood_invert  (const pg_neighbourhood *around, double *b);
/* b = A^-1 e_row; for row 0 of a projected basis the right side is p at the position itself, (1, -
 * centre). */
void pg_neighbourhood_solve   (const pg_neighbourhood *around, int row, double *b);
/* N_j = w_j p_j . b, written to the entries of the bonds in the row. */
void pg_neighbourhood_shape   (const pg_neighbourhood *around, const double *b, double *N);
/* dN_j / dx_k = (1/a) e_k' A^-1 p_j w_j, where e_k selects the function z_k: E1 of doc/method.md with the
 * constant, D1 without it. */
void pg_neighbourhood_differential (const pg_neighbourhood *around, double *dN);
/* Iterative refinement of N and dN (NULL: not wanted): where the reproducing conditions are missed by more
 * than 1e-14, the correction by the factored moment matrix is subtracted, at most twice. */
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
