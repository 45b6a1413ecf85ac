/* SPDX-License-Identifier: GPL-3.0-or-later
 * What a linear basis still can do where the neighbours of a point lie on a line or a plane (theory F3 item 3). With c their
 * centre, M = sum w (z - c)(z - c)' and M+ its inverse on the directions that are left,
 *     A = T diag (1, M) T',  T = [1 0; c I],     G = T'^-1 diag (1, M+) T^-1 = [1 + c'M+ c, -c'M+; -M+ c, M+].
 * A G p (0) = p (foot of the point on that line or plane) and A G e_k = P e_k, P the projector on its directions: shape functions
 * sum to 1 and their derivatives to 0 for any point. (The Moore-Penrose inverse of A agrees where the point lies on the line or
 * plane and loses both properties beside it: there p (0) is not in the range of A.)
 * About a node of nosb c = 0: M is A itself, and the lines and planes pass through the node. */
#include "moment.h"

/* M+ of the symmetric M (lower triangle): eigenvalues below the limit are dropped. Returns the number of those kept. */
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

int pg_star_project (pg_star *s, double h)
{
    int dim = s->dim, size = s->size, one = s->constant;
    double centre[3] = { 0 }, M[9], inverse[9], shift[3] = { 0 };
    if (s->n < 2) return 0;
    if (one) pg_star_centre (s, centre);
    pg_star_spread (s, centre, M);
    if (!invert_spread (dim, M, PG_THINNEST * (h / s->a) * (h / s->a), inverse)) return 0;
    for (int k = 0; k < dim; k++)
        for (int l = 0; l < dim; l++) {
            s->G[(k + one) * size + l + one] = inverse[k*dim + l];
            shift[k] += inverse[k*dim + l] * centre[l];
        }
    if (!one) return 1;
    s->G[0] = 1;
    for (int k = 0; k < dim; k++) {
        s->G[0] += shift[k] * centre[k];
        s->G[k + 1] = s->G[(k + 1) * size] = -shift[k];
    }
    return 1;
}
