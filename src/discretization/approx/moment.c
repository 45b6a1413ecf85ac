/* SPDX-License-Identifier: GPL-3.0-or-later
 * The moment matrix of a point and what follows from it, shared by all approximations. With z_j = (x_j - x)
 * / a, the bond to the neighbour j in horizons,
 *
 *     p (z) = [1], z_k, [z_k z_l]         A = sum_j w_j p_j p_j' = L L'
 *     N_j = e_0' A^-1 p_j w_j             dN_j / dx_k = (1/a) e_k' A^-1 p_j w_j
 *
 * (doc/method.md E1; without the 1 it is the shape tensor of D1). Lengths in horizons and weights of sum 1
 * keep A well scaled in any unit. A is factored by Cholesky, which also shows whether the neighbours suffice
 * for the basis: a pivot below 1e-8 (quadratic: 1e-10) of the diagonal counts as zero. */
#include "moment.h"
#include <math.h>
#include <string.h>

/* Number of functions: [1] + dim + dim (dim + 1) / 2. */
static int basis_size (int dim, int order, int constant)
{
    return constant + dim + (order == 2 ? dim * (dim + 1) / 2 : 0);
}

/* A (size x size) += w p p'. Both triangles are filled, because loops of constant length over whole rows
 * become vector instructions. */
static inline __attribute__ ((always_inline)) void add_moment (int size, double w, const double *p, double *A)
{
    for (int r = 0; r < size; r++) {
        double c = w * p[r];
        for (int k = 0; k < size; k++) A[r*size + k] += c * p[k];
    }
}

/* Computes p of all neighbours, and A (size x size). */
static inline __attribute__ ((always_inline)) void moments (pg_neighbourhood *s, int dim, int order,
                                                            int constant, int size, double *A)
{
    for (size_t j = 0; j < s->n; j++) {
        double *p = s->p + j * (size_t) size;
        pg_basis (dim, order, constant, s->z + j * (size_t) dim, p);
        add_moment (size, s->w[j], p, A);
    }
}

/* Sums up A; for quadratic and linear bases in 2D and 3D by code with all loop lengths known. */
PG_WIDE static void fill_moments (pg_neighbourhood *s, double *A)
{
    int plane = s->constant && s->dim == 2, solid = s->constant && s->dim == 3;
    if (plane && s->order == 2) moments (s, 2, 2, 1, 6, A);
    else if (solid && s->order == 2) moments (s, 3, 2, 1, 10, A);
    else if (plane) moments (s, 2, 1, 1, 3, A);
    else if (solid) moments (s, 3, 1, 1, 4, A);
    else moments (s, s->dim, s->order, s->constant, s->size, A);
}

/* L from A; returns 0 where A is singular to working accuracy. */
static int factor (pg_neighbourhood *s, const double *A, double tiny)
{
    memcpy (s->L, A, (size_t) (s->size * s->size) * sizeof *A);
    return pg_dense_cholesky (s->size, s->L, tiny) == 0;
}

void pg_neighbourhood_centre (const pg_neighbourhood *s, double *centre)
{
    int dim = s->dim;
    for (int k = 0; k < dim; k++) centre[k] = 0;
    for (size_t j = 0; j < s->n; j++)
        for (int k = 0; k < dim; k++) centre[k] += s->w[j] * s->z[j * (size_t) dim + (size_t) k];
}

static inline __attribute__ ((always_inline)) void spread (const pg_neighbourhood *s, int dim,
                                                           const double *centre, double *M)
{
    for (int k = 0; k < dim * dim; k++) M[k] = 0;
    for (size_t j = 0; j < s->n; j++) {
        const double *z = s->z + j * (size_t) dim;
        for (int k = 0; k < dim; k++)
            for (int l = 0; l <= k; l++) M[k*dim + l] += s->w[j] * (z[k] - centre[k]) * (z[l] - centre[l]);
    }
}

void pg_neighbourhood_spread (const pg_neighbourhood *s, const double *centre, double *M)
{
    if (s->dim == 3) spread (s, 3, centre, M);
    else if (s->dim == 2) spread (s, 2, centre, M);
    else spread (s, 1, centre, M);
}

/* 1 if the smallest eigenvalue of the centred second moment M is below 1e-3 h^2, h being the
 * spacing: the neighbours then lie almost on a line or plane. No eigenvalue is computed: M -
 * 1e-3 h^2 I has a Cholesky factor exactly if all eigenvalues are above. */
static int thin (const pg_neighbourhood *s, double h, double *M)
{
    int dim = s->dim;
    for (int k = 0; k < dim; k++) M[k*dim + k] -= PG_THINNEST * (h / s->a) * (h / s->a);
    return pg_dense_cholesky (dim, M, 0) != 0;
}

/* Do the neighbours lie almost on a line or plane? For a basis without the constant, from the bonds. */
static int flat (const pg_neighbourhood *s, double h)
{
    double centre[3] = { 0 }, M[9];
    pg_neighbourhood_centre (s, centre);
    pg_neighbourhood_spread (s, centre, M);
    return thin (s, h, M);
}

/* Do the neighbours lie almost on a line or plane? For a basis with the constant, from A, whose first row
 * holds the centre, and whose other entries the second moment about the position. */
static int flat_by_moments (const pg_neighbourhood *s, double h, const double *A)
{
    double M[9];
    const double *centre = A + 1;
    for (int k = 0; k < s->dim; k++)
        for (int l = 0; l <= k; l++)
            M[k * s->dim + l] = A[(1 + k) * s->size + 1 + l] - centre[k] * centre[l];
    return thin (s, h, M);
}

/* The basis where the neighbours spread too little: a projected one if that is allowed, else Shepard's (the
 * constant). */
static int left_over (pg_neighbourhood *s, int order, double h)
{
    if (!s->project || order != 1) return PG_GRADE_SHEPARD;
    s->order = 1;
    s->size = basis_size (s->dim, 1, s->constant);
    s->projected = pg_neighbourhood_project (s, h);
    return s->projected ? PG_GRADE_PROJECTED : PG_GRADE_SHEPARD;
}

/* Tries the basis of the given order, then the next lower one. Rounding in the quadratic moments is larger,
 * so its pivots may be smaller before they count as zero. */
int pg_neighbourhood_grade (pg_neighbourhood *s, int order, double h)
{
    int look = s->lost || !s->extrapolates;
    s->projected = 0;
    if (s->n == 0) return PG_GRADE_DEAD;
    if (s->n < (size_t) s->dim + 1 || (look && !s->constant && flat (s, h))) return left_over (s, order, h);
    for (s->order = order; s->order >= 1; s->order--) {
        double A[PG_BASIS_MAX * PG_BASIS_MAX] = { 0 };
        s->size = basis_size (s->dim, s->order, s->constant);
        if (s->n < (size_t) s->size) continue;
        fill_moments (s, A);
        if (look && s->constant && flat_by_moments (s, h, A)) return left_over (s, order, h);
        if (factor (s, A, s->order == 2 ? 1e-10 : 1e-8))
            return s->order == order ? PG_GRADE_FULL : PG_GRADE_LOWERED;
    }
    return PG_GRADE_SHEPARD;
}

void pg_neighbourhood_invert (const pg_neighbourhood *s, double *b)
{
    if (!s->projected) {
        pg_dense_solve (s->size, s->L, b);
        return;
    }
    double c[4] = { 0 };
    for (int r = 0; r < s->size; r++)
        for (int k = 0; k < s->size; k++) c[r] += s->G[r * s->size + k] * b[k];
    memcpy (b, c, (size_t) s->size * sizeof *b);
}

void pg_neighbourhood_solve (const pg_neighbourhood *s, int row, double *b)
{
    for (int k = 0; k < s->size; k++) b[k] = k == row;
    for (int k = 0; k < s->dim && s->projected && s->constant && row == 0; k++) b[1 + k] = -s->centre[k];
    pg_neighbourhood_invert (s, b);
}

/* Scalar product of n numbers. */
static double dot (int n, const double *a, const double *b)
{
    double sum = 0;
    for (int k = 0; k < n; k++) sum += a[k] * b[k];
    return sum;
}

void pg_neighbourhood_shape (const pg_neighbourhood *s, const double *b, double *N)
{
    for (size_t j = 0; j < s->n; j++)
        N[s->entry[j]] = s->w[j] * dot (s->size, b, s->p + j * (size_t) s->size);
}

void pg_neighbourhood_differential (const pg_neighbourhood *s, double *dN)
{
    size_t dim = (size_t) s->dim;
    double b[PG_BASIS_MAX];
    for (int k = 0; k < s->dim; k++) {
        pg_neighbourhood_solve (s, s->constant + k, b);
        for (size_t j = 0; j < s->n; j++)
            dN[s->entry[j] * dim + (size_t) k] = s->w[j] * dot (s->size, b, s->p + j * (size_t) s->size)
                                                 / s->a;
    }
}

/* Refines one column of values (`stride` apart): sum_j p_j value_j should be `target` for function `row` of
 * the basis and 0 for the others. */
static void refine (const pg_neighbourhood *s, double *value, size_t stride, int row, double target)
{
    for (int pass = 0; pass < 2; pass++) {
        double r[PG_BASIS_MAX] = { 0 }, most = 0;
        for (size_t j = 0; j < s->n; j++) {
            double v = value[s->entry[j] * stride];
            const double *p = s->p + j * (size_t) s->size;
            for (int k = 0; k < s->size; k++) r[k] += p[k] * v;
        }
        r[row] -= target;
        for (int k = 0; k < s->size; k++) most = fmax (most, fabs (r[k]));
        if (most <= 1e-14 * target) return;
        pg_neighbourhood_invert (s, r);
        for (size_t j = 0; j < s->n; j++)
            value[s->entry[j] * stride] -= s->w[j] * dot (s->size, r, s->p + j * (size_t) s->size);
    }
}

void pg_neighbourhood_refine (const pg_neighbourhood *s, double *N, double *dN)
{
    if (s->projected || !s->constant) return;
    if (N) refine (s, N, 1, 0, 1);
    for (int k = 0; dN && k < s->dim; k++) refine (s, dN + k, (size_t) s->dim, 1 + k, 1 / s->a);
}
