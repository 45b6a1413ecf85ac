/* SPDX-License-Identifier: GPL-3.0-or-later
 * N of the preconditioner (linalg.h, pg_elements): values of the shape functions at the nodes.
 *
 * P^-1 = p (N) V p (N)' treats displacements that alternate from node to node as nearly free of energy, as
 * shape functions smooth them: p (N) magnifies them by 1 / N. Evaluation points that lost bonds to a crack
 * do not smooth. One that lies beyond the last nodes of its side extrapolates: of the next layer only the
 * node nearest to it lies within its support, with a steep derivative, and an alternating pattern there has
 * as much energy as any other. P of such patterns is too large by K / (N' Q N): 69 for a crack 0.1 spacings
 * beside a lattice plane, where 2 is the largest of the intact body. The rows of N there are therefore mixed
 * with the unit row, s N + (1 - s) I. An alternating pattern then has the energy (1 - s)^2 Q, which is
 * chosen as the excess of K over the usual:
 *
 *    (1 - s_i)^2 = rho_i - c rho,   rho_i = tr K_ii / tr Q_ii,
 *
 * with K_ii of the evaluation points, rho the median of all nodes, and c = 1.55, which nodes on a free
 * surface have without harm. */
#include "galerkin_elements.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Largest s in the row of a node that has lost bonds itself (measured: 1 and 0.85 need 1.4 and 1.1 times the
 * iterations). */
static const double most_share = 0.93;
/* c: rho of nodes on a free surface over the median of all nodes. */
static const double on_surface = 1.55;

/* Has point p of r lost a bond? */
static int has_lost (const galerkin *g, const pg_rows *r, size_t p)
{
    for (size_t e = r->family.start[p]; e < r->family.start[p + 1]; e++)
        if (elements_broken (g, r, p, e)) return 1;
    return 0;
}

/* beside (n): 1 for nodes with an intact bond to an evaluation point that has lost others. Returns whether
 * there are any. */
static int find_beside (const galerkin *g, unsigned char *beside)
{
    const pg_rows *r = &g->rows[g->bulk];
    int any = 0;
    for (size_t p = 0; p < r->n; p++) {
        if (!has_lost (g, r, p)) continue;
        any = 1;
        for (size_t e = r->family.start[p]; e < r->family.start[p + 1]; e++)
            if (r->w[e + pg_rows_offset (r, p)] > 0) beside[r->family.node[e]] = 1;
    }
    return any;
}

/* rho (n): trace of K_ii, for isotropic D that of w B' D B = w (D_11 + (dim - 1) mu) |dN|^2, over that of
 * Q_ii; 0 where node i has no Q_ii. */
static void compare_diagonals (const galerkin *g, const pg_block_matrix *Q, double *rho)
{
    const pg_rows *r = &g->rows[g->bulk];
    size_t dim = (size_t) g->dim;
    for (size_t p = 0; p < r->n; p++) {
        const pg_material *m = galerkin_plain (g, g->bulk, p);
        double w = r->weight[p] * (m->D[0] + (double) (dim - 1) * m->mu);
        for (size_t e = r->family.start[p]; e < r->family.start[p + 1]; e++) {
            const double *q = r->dN + (e + pg_rows_offset (r, p)) * dim;
            for (size_t k = 0; k < dim; k++) rho[r->family.node[e]] += w * q[k] * q[k];
        }
    }
    for (size_t i = 0; i < g->n; i++) {
        double own = 0;
        for (size_t e = Q->start[i]; e < Q->start[i + 1]; e++)
            for (size_t k = 0; k < dim && Q->node[e] == (int) i; k++)
                own += (double) Q->value[(e * dim + k) * dim + k];
        rho[i] = own > 0 ? rho[i] / own : 0;
    }
}

/* share (n): weights s of the rows of N, 1 away from cracks. */
static pg_status find_shares (const galerkin *g, const pg_block_matrix *Q, double *share)
{
    pg_status status = PG_OK;
    unsigned char *beside = NULL;
    double *rho = NULL, *sorted = NULL;
    for (size_t i = 0; i < g->n; i++) share[i] = 1;
    if (!g->rows[g->bulk].dN || !g->rows[g->bulk].weight) return PG_OK;
    PG_ALLOC (beside, g->n);
    if (!find_beside (g, beside)) goto done;
    PG_ALLOC (rho, g->n);
    PG_ALLOC (sorted, g->n);
    compare_diagonals (g, Q, rho);
    memcpy (sorted, rho, g->n * sizeof *rho);
    pg_sort (sorted, g->n, sizeof *sorted, pg_ascending_numbers);
    double usual = on_surface * sorted[g->n / 2];
    for (size_t i = 0; i < g->n; i++)
        if (beside[i]) share[i] = fmax (0, 1 - sqrt (fmax (0, rho[i] - usual)));
done:
    pg_free (beside), pg_free (rho), pg_free (sorted);
    return status;
}

/* Writes row i of N, `share` times the shape functions plus (1 - share) times the unit row, from entry *at
 * on. */
static void write_row (const pg_rows *r, size_t i, double share, pg_node_matrix *N, size_t *at)
{
    int own = 0;
    for (size_t e = r->family.start[i]; e < r->family.start[i + 1]; e++) {
        int self = (size_t) r->family.node[e] == i;
        double value = share * r->N[e + pg_rows_offset (r, i)] + (self ? 1 - share : 0);
        if (value == 0) continue;
        own |= self, N->node[*at] = r->family.node[e], N->value[(*at)++] = (float) value;
    }
    if (!own && share < 1) N->node[*at] = (int) i, N->value[(*at)++] = (float) (1 - share);
    N->start[i + 1] = *at;
}

/* Makes N. Nodes whose displacement is not interpolated, because too few neighbours are left, get the unit
 * row. */
pg_status elements_values (const galerkin *g, const pg_block_matrix *Q, pg_node_matrix *N)
{
    pg_status status = PG_OK;
    const pg_rows *r = &g->rows[PG_NODES];
    double *share = NULL;
    size_t nnz = 0, at = 0;
    N->n = g->n;
    PG_ALLOC (share, g->n);
    PG_TRY (find_shares (g, Q, share));
    PG_ALLOC (N->start, g->n + 1);
    for (size_t i = 0; i < g->n; i++)
        for (size_t e = r->family.start[i]; e < r->family.start[i + 1]; e++)
            nnz += r->N[e + pg_rows_offset (r, i)] != 0;
    PG_ALLOC (N->node, nnz + g->n);
    PG_ALLOC (N->value, nnz + g->n);
    for (size_t i = 0; i < g->n; i++)
        if (r->grade[i] >= PG_GRADE_SHEPARD) share[i] = 0;
        else if (has_lost (g, r, i)) share[i] = fmin (share[i], most_share);
    PG_TRY (pg_subdomain_exchange (g->problem->cloud.subdomain, 1, share));
    for (size_t i = 0; i < g->n; i++) write_row (r, i, share[i], N, &at);
done:
    pg_free (share);
    return status;
}
