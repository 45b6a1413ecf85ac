/* SPDX-License-Identifier: GPL-3.0-or-later
 * The linear basis where the neighbours of a position lie on a line or on a plane (doc/method.md F3, item
 * 3). About their centre c the basis is p = (1, z - c), so that A = diag (1, M) with M = sum w (z - c)(z -
 * c)'. With M+, the inverse on the directions that are left, G = diag (1, M+) replaces A^-1. With P the
 * projection on these directions:
 *
 *     A G p (0) = (1, - P c) = p (foot of the position on the line or plane),    A G e_k = P e_k.
 *
 * So the shape functions sum to 1 and their derivatives to 0 for any position. The Moore-Penrose inverse of
 * A about the position itself gives the same if it lies on the line or plane; elsewhere p (0) leaves the
 * range of A, and both sums are lost. At a node of nosb c = 0: M is A itself, and lines and planes pass
 * through the node. */
#include "moment.h"

/* M+ (dim x dim) of the symmetric M (lower triangle given): directions with an eigenvalue
 * below the limit are dropped. Returns the number of directions kept. */
static int invert_spread (int dim, double *M, double limit, double *inverse)
{
    int kept = 0;
    double value[3], V[9];
    for (int k = 0; k < dim; k++)
        for (int l = 0; l < k; l++) M[l*dim + k] = M[k*dim + l];
    pg_dense_eigen (dim, M, value, V);
    for (int k = 0; k < dim * dim; k++) inverse[k] = 0;
    for (int i = 0; i < dim; i++) {
        if (!(value[i] >= limit)) continue;
        for (int k = 0; k < dim; k++)
            for (int l = 0; l < dim; l++) inverse[k*dim + l] += V[k*dim + i] * V[l*dim + i] / value[i];
        kept++;
    }
    return kept;
}

/* Basis p = ([1] z - c) about the weighted centre c. A second pass removes the rounding of c, which M+ would
 * enlarge where the weights are very uneven. */
static void centred_basis (pg_neighbourhood *s)
{
    size_t dim = (size_t) s->dim, one = (size_t) s->constant, size = dim + one;
    double rest[3] = { 0 };
    for (size_t k = 0; k < dim; k++) s->centre[k] = 0;
    if (one) pg_neighbourhood_centre (s, s->centre);
    for (size_t j = 0; j < s->n; j++) {
        double *p = s->p + j * size;
        if (one) p[0] = 1;
        for (size_t k = 0; k < dim; k++) {
            p[one + k] = s->z[j*dim + k] - s->centre[k];
            rest[k] += s->w[j] * p[one + k];
        }
    }
    for (size_t k = 0; k < dim && one; k++) {
        for (size_t j = 0; j < s->n; j++) s->p[j*size + one + k] -= rest[k];
        s->centre[k] += rest[k];
    }
}

int pg_neighbourhood_project (pg_neighbourhood *s, double h)
{
    int dim = s->dim, one = s->constant, size = s->size;
    double M[9], inverse[9];
    if (s->n < 2) return 0;
    centred_basis (s);
    pg_neighbourhood_spread (s, s->centre, M);
    if (!invert_spread (dim, M, PG_THINNEST * (h / s->a) * (h / s->a), inverse)) return 0;
    for (int k = 0; k < size * size; k++) s->G[k] = k == 0;
    for (int k = 0; k < dim; k++)
        for (int l = 0; l < dim; l++) s->G[(k + one) * size + l + one] = inverse[k*dim + l];
    return 1;
}
