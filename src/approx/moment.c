/* SPDX-License-Identifier: GPL-3.0-or-later
 * Basis p (z) = [1] z_k [z_k z_l], moment matrix A = sum w p p' = L L', and what is left of the basis where
 * too few bonds live. Theory E1, D1; degenerate rule: approx.h. */
#include "moment.h"
#include <string.h>

static int basis_size (int dim, int order, int constant)
{
    return constant + dim + (order == 2 ? dim * (dim + 1) / 2 : 0);
}

static void basis (const pg_neighbourhood *s, const double *z, double *p)
{
    int m = 0;
    if (s->constant) p[m++] = 1;
    for (int k = 0; k < s->dim; k++) p[m++] = z[k];
    for (int k = 0; s->order == 2 && k < s->dim; k++)
        for (int l = k; l < s->dim; l++) p[m++] = z[k] * z[l];
}

void pg_basis_slope (const pg_neighbourhood *s, const double *z, const double *b, double *slope)
{
    int m = 1 + s->dim;
    for (int k = 0; k < s->dim; k++) slope[k] = b[1 + k];
    for (int k = 0; s->order == 2 && k < s->dim; k++)
        for (int l = k; l < s->dim; l++, m++) {
            slope[k] += b[m] * z[l];
            slope[l] += b[m] * z[k];
        }
}

/* A (size x size, all of it: whole rows make even steps) += w p p' */
static inline void add_moment (int size, double w, const double *p, double *A)
{
    for (int r = 0; r < size; r++) {
        double c = w * p[r];
        for (int k = 0; k < size; k++) A[r*size + k] += c * p[k];
    }
}

/* Fills p and L; 0 where A is singular to working accuracy. */
static int factor (pg_neighbourhood *s, double tiny)
{
    int size = s->size;
    double A[PG_BASIS_MAX * PG_BASIS_MAX] = { 0 };
    for (size_t j = 0; j < s->n; j++) {
        double *p = s->p + j * (size_t) size, w = s->w[j];
        basis (s, s->z + j * (size_t) s->dim, p);
        if (size == 6) add_moment (6, w, p, A);        /* the usual ones, their loops known */
        else if (size == 10) add_moment (10, w, p, A);
        else if (size == 4) add_moment (4, w, p, A);
        else add_moment (size, w, p, A);
    }
    memcpy (s->L, A, sizeof A);
    return pg_dense_cholesky (size, s->L, tiny) == 0;
}

void pg_neighbourhood_centre (const pg_neighbourhood *s, double *centre)
{
    int dim = s->dim;
    for (int k = 0; k < dim; k++) centre[k] = 0;
    for (size_t j = 0; j < s->n; j++)
        for (int k = 0; k < dim; k++) centre[k] += s->w[j] * s->z[j * (size_t) dim + (size_t) k];
}

void pg_neighbourhood_spread (const pg_neighbourhood *s, const double *centre, double *M)
{
    int dim = s->dim;
    for (int k = 0; k < dim * dim; k++) M[k] = 0;
    for (size_t j = 0; j < s->n; j++) {
        const double *z = s->z + j * (size_t) dim;
        for (int k = 0; k < dim; k++)
            for (int l = 0; l <= k; l++) M[k*dim + l] += s->w[j] * (z[k] - centre[k]) * (z[l] - centre[l]);
    }
}

/* Is the smallest eigenvalue of the centred second moment below 1e-3 h^2? It is not where M - 1e-3 h^2 I has
 * a factor. */
static int flat (const pg_neighbourhood *s, double h)
{
    int dim = s->dim;
    double centre[3], M[9];
    pg_neighbourhood_centre (s, centre);
    pg_neighbourhood_spread (s, centre, M);
    for (int k = 0; k < dim; k++) M[k*dim + k] -= PG_THINNEST * (h / s->a) * (h / s->a);
    return pg_dense_cholesky (dim, M, 0) != 0;
}

/* Where the neighbours spread too little */
static int left_over (pg_neighbourhood *s, int order, double h)
{
    if (!s->project || order != 1) return PG_GRADE_SHEPARD;
    s->order = 1;
    s->size = basis_size (s->dim, 1, s->constant);
    s->projected = pg_neighbourhood_project (s, h);
    return s->projected ? PG_GRADE_PROJECTED : PG_GRADE_SHEPARD;
}

int pg_neighbourhood_grade (pg_neighbourhood *s, int order, double h)
{
    s->projected = 0;
    if (s->n == 0) return PG_GRADE_DEAD;
    if (s->n < (size_t) s->dim + 1 || ((s->lost || !s->extrapolates) && flat (s, h)))
        return left_over (s, order, h);
    for (s->order = order; s->order >= 1; s->order--) {
        s->size = basis_size (s->dim, s->order, s->constant);
        if (s->n >= (size_t) s->size && factor (s, s->order == 2 ? 1e-10 : 1e-8))
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
