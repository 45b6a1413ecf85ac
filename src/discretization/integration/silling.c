/* SPDX-License-Identifier: GPL-3.0-or-later
 * Stabilisation of nodally integrated NOSB after Silling 2017 (Comput. Methods Appl. Mech. Engrg. 322,
 * 42-57; doc/method.md D3a).
 *
 * The deformation at a point predicts the relative displacement of each bond; z_j = eta_j - sum_l (g_l .
 * xi_j) eta_l is what it misses, g_l = derivatives of the shape functions. With c = V Gs mu d (d + 2) / q
 * the energy is
 *
 *     W = (1/2) c sum_j w_j |z_j|^2,    A = sum_j w_j xi_j xi_j',    q = sum_j w_j r_j^2    (w includes V_j),
 *
 * which in the relative displacements eta is a quadratic form with
 *
 *     S_lm = c (w_l delta_lm - w_l xi_l . g_m - w_m xi_m . g_l + g_l . A g_m).
 *
 * As eta_j = d_j - d_own, the row and the column of the own node are minus the sums of the others. W is
 * zero for every linear field, and Gs has no unit. */
#include "perigal/integration.h"

/* Sums over the family of a point: A (3 x 3, m^5), q (m^5), sum of w (m^3) and of w xi (m^4). */
typedef struct { double A[9], q, sum_w, sum_wxi[3]; } moments;

/* Sums over intact bonds (w = 0: broken), without the own node. */
static void gather_moments (const pg_rows *rows, const pg_cloud *cloud, size_t p, moments *m)
{
    int dim = rows->dim;
    *m = (moments) { { 0 }, 0, 0, { 0 } };
    for (size_t e = rows->family.start[p]; e < rows->family.start[p + 1]; e++) {
        double w = rows->w[e], xi[3];
        if (w == 0 || rows->family.node[e] == rows->own[p]) continue;
        for (int k = 0; k < dim; k++)
            xi[k] = cloud->x[(size_t) rows->family.node[e] * (size_t) dim + (size_t) k]
                    - rows->x[p * (size_t) dim + (size_t) k];
        m->sum_w += w;
        for (int k = 0; k < dim; k++) {
            m->q += w * xi[k] * xi[k];
            m->sum_wxi[k] += w * xi[k];
            for (int l = 0; l < dim; l++) m->A[k*3 + l] += w * xi[k] * xi[l];
        }
    }
}

/* Weight, w xi and derivative g of local node b. For the own node they are chosen so that one formula
 * serves every entry of the matrix: the sum of the weights, minus the sum of w xi, and its own g (minus the
 * sum of the others, as derivatives of a constant vanish). */
static void local (const pg_rows *rows, const pg_cloud *cloud, size_t p, size_t b, const moments *m, int *own,
                   double *w, double *wxi, const double **g)
{
    size_t e = rows->family.start[p] + b, dim = (size_t) rows->dim;
    int j = rows->family.node[e];
    *own = j == rows->own[p];
    *w = *own ? m->sum_w : rows->w[e];
    for (size_t k = 0; k < dim; k++)
        wxi[k] = *own ? -m->sum_wxi[k] : rows->w[e] * (cloud->x[(size_t) j * dim + k] - rows->x[p * dim + k]);
    *g = rows->dN + e * dim;
}

/* Adds the stabilisation's blocks (dim x dim) that couple local node a of point p with its nodes 0 .. m - 1
 * (layout m x dim x dim); modulus in Pa, volume in m^3. */
void pg_silling_add (const pg_rows *rows, const pg_cloud *cloud, size_t p, size_t a, size_t m, double modulus,
                     double volume, double *blocks)
{
    moments M;
    int dim = rows->dim, own_a, own_b;
    double wa, wb, xa[3], xb[3];
    const double *ga, *gb;
    gather_moments (rows, cloud, p, &M);
    if (!(M.q > 0)) return;
    double c = volume * modulus * dim * (dim + 2) / M.q;
    local (rows, cloud, p, a, &M, &own_a, &wa, xa, &ga);
    for (size_t b = 0; b < m; b++) {
        local (rows, cloud, p, b, &M, &own_b, &wb, xb, &gb);
        /* The term w_l delta_lm: each neighbour is coupled with the own node only. */
        double s = a == b ? wa : own_a ? -wb : own_b ? -wa : 0;
        for (int k = 0; k < dim; k++) {
            s -= xa[k] * gb[k] + xb[k] * ga[k];
            for (int l = 0; l < dim; l++) s += ga[k] * M.A[k*3 + l] * gb[l];
        }
        for (int k = 0; k < dim; k++)
            blocks[(b * (size_t) dim + (size_t) k) * (size_t) dim + (size_t) k] += c * s;
    }
}
