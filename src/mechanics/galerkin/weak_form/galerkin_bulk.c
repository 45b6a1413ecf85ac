/* SPDX-License-Identifier: GPL-3.0-or-later
 * Galerkin bulk terms: eps = B d, sigma = D eps, K_ab = w B_a' D B_b (+ stabilisation), f_a = w B_a' sigma.
 * Cui 2022 eqs (6), (7); theory D1: with nodal integration and NOSB derivatives this is NOSB-PD itself. */
#include "galerkin.h"
#include <string.h>

/* The material of a point of a bond set. */
const pg_material *galerkin_material (const galerkin *g, int set, size_t p)
{
    return pg_problem_law (g->problem, set, p);
}

/* strain += B_a d for one node a: q: its gradient of N, 1/m. Voigt order xx yy zz xy yz zx, engineering
 * shears. */
static void add_strain (int dim, const double *q, const double *d, double *e)
{
    if (dim == 1) e[0] += q[0] * d[0];
    else if (dim == 2) e[0] += q[0] * d[0], e[1] += q[1] * d[1], e[2] += q[1] * d[0] + q[0] * d[1];
    else {
        e[0] += q[0] * d[0], e[1] += q[1] * d[1], e[2] += q[2] * d[2];
        e[3] += q[1] * d[0] + q[0] * d[1], e[4] += q[2] * d[1] + q[1] * d[2],
            e[5] += q[2] * d[0] + q[0] * d[2];
    }
}

/* 2D: all four entries of a block lie in one register: row by row they are products of D B_a with q[0] and
 * q[1]. */
PG_WIDE static void add_plane_blocks (const double *DB, size_t m, const double *q, double *k)
{
    const four x = { DB[0], DB[2], DB[3], DB[5] }, y = { DB[2], DB[1], DB[5], DB[4] };
    four *block = (four *) (void *) k;
    for (size_t n = 0; n < m; n++, q += 2) block[n] += q[0] * x + q[1] * y;
}

/* 3D: a block has nine entries, and each is a sum over the components of q: eight of them are computed at
 * once and stored in the block, whatever its alignment. */
PG_WIDEST static void add_solid_blocks (const double *DB, size_t m, const double *q, double *k)
{
    /* Voigt number of the stress that multiplies q[l] in f[c] */
    static const int of[3][3] = { { 0, 3, 5 }, { 3, 1, 4 }, { 5, 4, 2 } };
    double part[3][9];
    eight x, y, z;
    for (int l = 0; l < 3; l++)
        for (int e = 0; e < 9; e++) part[l][e] = DB[6 * (e / 3) + of[l][e % 3]];
    for (int e = 0; e < 8; e++) x[e] = part[0][e], y[e] = part[1][e], z[e] = part[2][e];
    for (size_t n = 0; n < m; n++, q += 3, k += 9) {
        *(eight *) (void *) k += q[0] * x + q[1] * y + q[2] * z;
        k[8] += q[0] * part[0][8] + q[1] * part[1][8] + q[2] * part[2][8];
    }
}

/* Blocks (dim x dim) += w (D B_a)' B_b for b = 0..m-1; DB: (D B_a)' as dim x nv */
static void add_blocks (int dim, const double *DB, size_t m, const double *q, double *k)
{
    if (dim == 2) {
        add_plane_blocks (DB, m, q, k);
        return;
    }
    if (dim == 3) add_solid_blocks (DB, m, q, k);
    for (size_t n = 0; n < m && dim == 1; n++) k[n] += q[n] * DB[0];
}

/* Adds to out the blocks of K by which evaluation point p couples its local node a with nodes 0 .. m - 1. */
static void add_point (galerkin *g, size_t p, size_t a, size_t m, double *out)
{
    const pg_rows *r = &g->sums;
    size_t dim = (size_t) g->dim, nv = (size_t) g->nv,
           first = r->family.start[p] + pg_rows_offset (r, p);
    const double *D = galerkin_plain (g, g->bulk, p)->D, *qa = r->dN + (first + a) * dim;
    double DB[18], unit[3];
    for (size_t v = 0; v < 3 && dim == 2; v++) {         /* rows of weight (D B_a)' in 2D, written out */
        DB[v] = (D[3 * v] * qa[0] + D[3 * v + 2] * qa[1]) * r->weight[p];
        DB[3 + v] = (D[3 * v + 1] * qa[1] + D[3 * v + 2] * qa[0]) * r->weight[p];
    }
    /* row c of (D B_a)': D applied to the strain of a unit dof */
    for (size_t c = 0; c < dim && dim != 2; c++)
        for (size_t v = 0; v < nv; v++) {
            double row[6] = { 0 };
            memset (unit, 0, sizeof unit);
            unit[c] = 1;
            add_strain (g->dim, qa, unit, row);
            DB[c * nv + v] = 0;
            for (size_t w = 0; w < nv; w++) DB[c * nv + v] += D[v * nv + w] * row[w];
            DB[c * nv + v] *= r->weight[p];
        }
    add_blocks (g->dim, DB, m, r->dN + first * dim, out);
}

/* Adds w B_a' D B_b of one point, and its stabilisation, for local node a and nodes b = 0 .. m - 1. */
void galerkin_bulk_blocks (void *context, size_t p, size_t a, size_t m, double *out)
{
    galerkin *g = context;
    const pg_rows *r = &g->sums;
    if (r->weight[p] == 0) return;
    add_point (g, p, a, m, out);
    double Gs = g->options->silling > 0 ? galerkin_silling_modulus (g, p) : 0;
    if (Gs > 0) pg_silling_add (r, &g->problem->cloud, p, a, m, Gs, r->weight[p], out);
}

/* Adds w B_a' D B_b summed over all points of a cell, which share the nodes of the cell; without
 * stabilisation. */
void galerkin_cell_blocks (void *context, size_t cell, size_t a, size_t m, double *out)
{
    galerkin *g = context;
    const size_t *first = g->problem->form.consistency->first;
    for (size_t p = first[cell]; p < first[cell + 1]; p++) add_point (g, p, a, m, out);
}

/* f += internal force, N, by the stresses of the last galerkin_measure at d. */
void galerkin_bulk_force (galerkin *g, const double *d, double *f) { galerkin_sum_stress (g, d, f); }

/* y += K x of the bulk, without assembling K. */
void galerkin_bulk_apply (galerkin *g, const double *x, double *y)
{
    galerkin_sum_tangent (g, x, y);
    if (g->dilatation) galerkin_dilatation_apply (g, x, y);
}

/* Strain energy of the bulk, J: half of stress times strain over all owned points, and that of the
 * stabilisation. */
double galerkin_bulk_energy (const galerkin *g, const double *d)
{
    const pg_rows *r = &g->sums;
    size_t nv = (size_t) g->nv;
    double sum = 0;
    for (size_t p = 0; p < r->n; p++) {
        double w = 0;
        if (!pg_problem_owns (g->problem, g->bulk, p)) continue;
        for (size_t v = 0; v < nv; v++)
            w += 0.5 * g->measured.stress[g->bulk][p * nv + v] * g->measured.strain[g->bulk][p * nv + v];
        sum += r->weight[p] * (w - galerkin_eigen_energy (g, p));
        if (g->kept) sum += galerkin_silling_energy (g, p, d);
    }
    return sum;
}

double galerkin_squared (const galerkin *g, const double *force)
{
    size_t dim = (size_t) g->dim;
    double s = 0;
    for (size_t i = 0; i < g->n * dim; i++)
        if (pg_cloud_owns (&g->problem->cloud, i / dim)) s += force[i] * force[i];
    return s;
}
