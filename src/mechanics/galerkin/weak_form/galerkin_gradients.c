/* SPDX-License-Identifier: GPL-3.0-or-later
 * Rows of K by products of derivatives, where all points have the same D. With
 *
 *     G_kl (a, b) = sum_p w_p dN_a/dx_k dN_b/dx_l,    K_ij (a, b) = sum_kl C_ikjl G_kl (a, b),
 *
 * where C is D with pairs of axes instead of Voigt numbers, the points add up G alone: in 3D nine products
 * for two nodes at a point instead of 27, for nodes that are adjacent in memory. D is applied once for two
 * nodes, when all points have been summed. A row of G has `dim` parts, one for each k, with the numbers of
 * node b at b dim. */
#include "galerkin.h"
#include <string.h>

/* Number of points that are summed at once. */
enum { BATCH = 32 };

#define INLINE static inline __attribute__ ((always_inline))

/* Of n points: derivatives of the row's node times the weight (dim a point), and the derivatives of all their
 * nodes. */
typedef struct { size_t n; double q[3 * BATCH]; const double *row[BATCH]; } batch;

/* Sums eight numbers of each part (pair: sixteen) of a row of G over the batch, from position `at` on. */
INLINE void add_lanes (int dim, int pair, const batch *b, size_t length, size_t at, double *out)
{
    double *to = out + at, *y = to + length, *z = y + length;
    eight a0 = *(eight *) (void *) to, b0 = *(eight *) (void *) y, c0 = { 0 }, a1 = { 0 }, b1 = { 0 },
          c1 = { 0 };
    if (dim == 3) c0 = *(eight *) (void *) z;
    if (pair) a1 = *(eight *) (void *) (to + 8), b1 = *(eight *) (void *) (y + 8);
    if (pair && dim == 3) c1 = *(eight *) (void *) (z + 8);
    for (size_t i = 0; i < b->n; i++) {
        const double *q = b->q + (size_t) dim * i;
        eight v = *(const eight *) (const void *) (b->row[i] + at);
        a0 += q[0] * v, b0 += q[1] * v;
        if (dim == 3) c0 += q[2] * v;
        if (!pair) continue;
        v = *(const eight *) (const void *) (b->row[i] + at + 8);
        a1 += q[0] * v, b1 += q[1] * v;
        if (dim == 3) c1 += q[2] * v;
    }
    *(eight *) (void *) to = a0, *(eight *) (void *) y = b0;
    if (dim == 3) *(eight *) (void *) z = c0;
    if (pair) *(eight *) (void *) (to + 8) = a1, *(eight *) (void *) (y + 8) = b1;
    if (pair && dim == 3) *(eight *) (void *) (z + 8) = c1;
}

INLINE void add_products (int dim, const batch *b, size_t length, double *out)
{
    size_t at = 0;
    for (; at + 16 <= length; at += 16) add_lanes (dim, 1, b, length, at, out);
    for (; at + 8 <= length; at += 8) add_lanes (dim, 0, b, length, at, out);
    for (; at < length; at++)
        for (size_t i = 0; i < b->n; i++)
            for (int k = 0; k < dim; k++)
                out[(size_t) k * length + at] += b->q[(size_t) dim * i + (size_t) k] * b->row[i][at];
}

PG_WIDEST static void add_solid (const batch *b, size_t length, double *out)
{
    add_products (3, b, length, out);
}

PG_WIDEST static void add_plane (const batch *b, size_t length, double *out)
{
    add_products (2, b, length, out);
}

/* Adds the points first .. last - 1, which have the same nodes, to the row of G of local node a with nodes 0
 * .. m - 1. */
static void sum_points (const galerkin *g, size_t first, size_t last, size_t a, size_t m, double *out)
{
    const pg_rows *r = &g->sums;
    size_t dim = (size_t) g->dim;
    batch b;
    for (size_t p = first; p < last; ) {
        for (b.n = 0; p < last && b.n < BATCH; p++) {
            const double *row = r->dN + (r->family.start[p] + pg_rows_offset (r, p)) * dim;
            if (r->weight[p] == 0) continue;
            for (size_t k = 0; k < dim; k++) b.q[dim * b.n + k] = r->weight[p] * row[dim * a + k];
            b.row[b.n++] = row;
        }
        (dim == 3 ? add_solid : add_plane) (&b, dim * m, out);
    }
}

void galerkin_point_rows (void *context, size_t p, size_t a, size_t m, double *out)
{
    sum_points (context, p, p + 1, a, m, out);
}

void galerkin_cell_rows (void *context, size_t cell, size_t a, size_t m, double *out)
{
    const galerkin *g = context;
    const size_t *first = g->problem->form.consistency->first;
    sum_points (g, first[cell], first[cell + 1], a, m, out);
}

/* Replaces a row of G by that of K, in place, one node after the other. */
void galerkin_finish_rows (void *context, size_t m, double *rows)
{
    static const size_t voigt[3][3] = { { 0, 3, 5 }, { 3, 1, 4 }, { 5, 4, 2 } },
                        plane[2][2] = { { 0, 2 }, { 2, 1 } };
    const galerkin *g = context;
    const double *D = galerkin_plain (g, g->bulk, 0)->D;
    size_t dim = (size_t) g->dim, square = dim * dim, length = dim * m;
    double C[81], G[9];
    for (size_t e = 0; e < square * square; e++) {
        size_t i = e / (square * dim), j = e / square % dim, k = e / dim % dim, l = e % dim,
               ik = dim == 3 ? voigt[i][k] : plane[i][k], jl = dim == 3 ? voigt[j][l] : plane[j][l];
        C[e] = D[ik * (size_t) g->nv + jl];
    }
    for (double *at = rows, *end = rows + length; at < end; at += dim) {
        for (size_t e = 0; e < square; e++) G[e] = at[e / dim * length + e % dim];
        for (size_t e = 0; e < square; e++) {
            double sum = 0;
            for (size_t f = 0; f < square; f++) sum += C[square * e + f] * G[f];
            at[e / dim * length + e % dim] = sum;
        }
    }
}

/* Have all evaluation points the same D, whatever their materials, and is there no stabilisation? */
int galerkin_has_rows (const galerkin *g)
{
    const double *D = NULL;
    if (g->dim < 2 || g->problem->plain || g->options->silling > 0) return 0;
    for (size_t p = 0; p < g->sums.n; p++) {
        const double *own = galerkin_plain (g, g->bulk, p)->D;
        if (!D) D = own;
        if (own != D && memcmp (own, D, (size_t) (g->nv * g->nv) * sizeof *D) != 0) return 0;
    }
    return D != NULL;
}
