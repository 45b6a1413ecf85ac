/* SPDX-License-Identifier: GPL-3.0-or-later
 * Products K x and forces of bodies with Silling's stabilisation (Silling 2017; doc/method.md D3a), where
 * the evaluation points are the nodes. With eta_j = d_j - d_own, H = sum_j eta_j g_j' (g_j: derivatives of
 * the shape functions), z_j = eta_j - H xi_j and the energy (1/2) c sum_j w_j |z_j|^2 of a point, its forces
 * are
 *
 *    f_j = c (w_j z_j - M g_j),   M = sum_j w_j z_j xi_j' = sum_j w_j eta_j xi_j' - H A,
 *    A = sum_j w_j xi_j xi_j',
 *
 * minus their sum at the own node. A, q = sum_j w_j |xi_j|^2 and sum_j w_j xi_j depend on the bonds alone
 * and are stored. Two passes over the bonds suffice, one for H and M, one for the forces, which include the
 * stress: f_j = T g_j + c w_j z_j with T = weight sigma - c M. The own node is treated like all others: its
 * eta and its w are zero, and its g is minus the sum of those of the others. */
#include "galerkin.h"
#include <string.h>

#define INLINE static inline __attribute__ ((always_inline))

/* Stored numbers of each point: A (3 x 3), sum of w xi (3), c over the weight of the point, Pa / m^5. */
enum { A = 0, WXI = 9, C = 12, KEPT = 13 };

/* Strength Gs mu of a point, Pa; 0 where it carries no stress. */
double galerkin_silling_modulus (const galerkin *g, size_t p)
{
    const pg_material *m = galerkin_material (g, g->bulk, p);
    return g->rows[g->bulk].grade[p] >= PG_GRADE_SHEPARD ? 0 : g->options->silling * m->mu;
}

/* kept: the sums of point p over its intact bonds. */
static void keep_point (const galerkin *g, size_t p, double *kept)
{
    const pg_rows *r = &g->sums;
    size_t dim = (size_t) g->dim;
    double q = 0;
    memset (kept, 0, KEPT * sizeof *kept);
    for (size_t k = r->family.start[p]; k < r->family.start[p + 1]; k++) {
        const double *at = g->problem->cloud.x + (size_t) r->family.node[k] * dim;
        if (r->w[k] == 0 || r->family.node[k] == r->own[p]) continue;
        for (size_t a = 0; a < dim; a++) {
            double xi = at[a] - r->x[p * dim + a];
            q += r->w[k] * xi * xi, kept[WXI + a] += r->w[k] * xi;
            for (size_t b = 0; b < dim; b++) kept[A + a*3 + b] += r->w[k] * xi * (at[b] - r->x[p * dim + b]);
        }
    }
    if (q > 0) kept[C] = galerkin_silling_modulus (g, p) * (double) (dim * (dim + 2)) / q;
}

/* Allocates memory, and positions with four numbers a node; nothing without stabilisation. */
pg_status galerkin_silling_create (galerkin *g)
{
    pg_status status = PG_OK;
    size_t dim = (size_t) g->dim;
    if (!(g->options->silling > 0)) return PG_OK;
    PG_ALLOC (g->kept, g->sums.n * KEPT);
    PG_ALLOC (g->place, 4 * g->n);
    for (size_t i = 0; i < g->n; i++)
        for (size_t c = 0; c < dim; c++) g->place[4 * i + c] = g->problem->cloud.x[i * dim + c];
done:
    return status;
}

void galerkin_silling_free (galerkin *g) { pg_free (g->kept), pg_free (g->place); }

/* Computes the stored sums of listed points, whose rows have changed (list NULL: of the first `count`). */
void galerkin_silling_update (galerkin *g, size_t count, const size_t *list)
{
    for (size_t i = 0; g->kept && i < count; i++) {
        size_t p = list ? list[i] : i;
        keep_point (g, p, g->kept + p * KEPT);
    }
}

/* ---- one point ----------------------------------------------------------------------------------------- */
/* T: weight sigma as a matrix, column by column; s: sigma in Voigt order, or NULL: that of the gradient H. */
INLINE void stress_columns (int dim, const galerkin *g, size_t p, const double *s, const four *H, four *T)
{
    double own[6], e[6], w = g->sums.weight[p];
    const double *D = galerkin_plain (g, g->bulk, p)->D;
    int nv = dim == 3 ? 6 : 2 * dim - 1;
    if (!s) {
        if (dim == 3)
            e[0] = H[0][0], e[1] = H[1][1], e[2] = H[2][2], e[3] = H[1][0] + H[0][1],
            e[4] = H[2][1] + H[1][2], e[5] = H[0][2] + H[2][0];
        else if (dim == 2) e[0] = H[0][0], e[1] = H[1][1], e[2] = H[1][0] + H[0][1];
        else e[0] = H[0][0];
        for (int v = 0; v < nv; v++) {
            own[v] = 0;
            for (int k = 0; k < nv; k++) own[v] += D[v * nv + k] * e[k];
        }
        s = own;
    }
    if (dim == 3)
        T[0] = (four) { w * s[0], w * s[3], w * s[5], 0 }, T[1] = (four) { w * s[3], w * s[1], w * s[4], 0 },
        T[2] = (four) { w * s[5], w * s[4], w * s[2], 0 };
    else if (dim == 2) T[0] = (four) { w * s[0], w * s[2], 0, 0 }, T[1] = (four) { w * s[2], w * s[1], 0, 0 };
    else T[0] = (four) { w * s[0], 0, 0, 0 };
}

/* Adds the forces of point p to f (4 numbers a node, from node `low` on) for nodal values x (4 numbers a
 * node); s: its stress, or NULL: that of x. Each column of a matrix is a vector. */
INLINE void sum_point (int dim, const galerkin *g, size_t p, const double *s, const double *x, double *f,
                       size_t low)
{
    const pg_rows *r = &g->sums;
    size_t own = (size_t) r->own[p], first = r->family.start[p], last = r->family.start[p + 1];
    size_t d = (size_t) dim;
    const double *kept = g->kept + p * KEPT, *place = g->place;
    four at = *(const four *) (x + 4 * own), here = *(const four *) (place + 4 * own);
    four H[3] = { { 0 } }, M[3] = { { 0 } }, T[3] = { { 0 } }, sum = { 0 };
    for (size_t k = first; k < last; k++) {
        size_t j = (size_t) r->family.node[k];
        const double *q = r->dN + k * d;
        four eta = *(const four *) (x + 4 * j) - at, xi = *(const four *) (place + 4 * j) - here,
             part = r->w[k] * eta;
        for (int b = 0; b < dim; b++) H[b] += q[b] * eta, M[b] += xi[b] * part;
        sum += part;
    }
    double c = r->weight[p] * kept[C];
    stress_columns (dim, g, p, s, H, T);
    for (int b = 0; b < dim; b++) {
        for (int a = 0; a < dim; a++) M[b] -= kept[A + a*3 + b] * H[a];
        T[b] -= c * M[b], sum -= kept[WXI + b] * H[b];
    }
    for (size_t k = first; k < last; k++) {
        size_t j = (size_t) r->family.node[k];
        const double *q = r->dN + k * d;
        four z = *(const four *) (x + 4 * j) - at, xi = *(const four *) (place + 4 * j) - here, force = { 0 };
        for (int b = 0; b < dim; b++) z -= xi[b] * H[b], force += q[b] * T[b];
        *(four *) (f + 4 * (j - low)) += force + (c * r->w[k]) * z;
    }
    *(four *) (f + 4 * (own - low)) -= c * sum;
}

/* Adds the forces of points first .. last - 1; stress: 6 numbers a point, NULL: those of x. */
PG_WIDE static void sum_solid (const galerkin *g, size_t first, size_t last, const double *stress,
                            const double *x, double *f, size_t low)
{
    for (size_t p = first; p < last; p++) sum_point (3, g, p, stress ? stress + 6 * p : NULL, x, f, low);
}

PG_WIDE static void sum_plane (const galerkin *g, size_t first, size_t last, const double *stress,
                            const double *x, double *f, size_t low)
{
    for (size_t p = first; p < last; p++) sum_point (2, g, p, stress ? stress + 3 * p : NULL, x, f, low);
}

/* In 1D H is one number, and the vectors are used for one component. */
static void sum_line (const galerkin *g, size_t first, size_t last, const double *stress, const double *x,
                      double *f, size_t low)
{
    for (size_t p = first; p < last; p++) sum_point (1, g, p, stress ? stress + p : NULL, x, f, low);
}

void galerkin_silling_sum (const galerkin *g, size_t first, size_t last, const double *stress,
                           const double *x, double *f, size_t low)
{
    (g->dim == 3 ? sum_solid : g->dim == 2 ? sum_plane : sum_line) (g, first, last, stress, x, f, low);
}

/* ---- eight points with equal rows ---------------------------------------------------------------------- */
/* Values of eight points: entry (a, b) of a matrix has number 3 a + b; w: weights of the points, 0 beyond the
 * run. */
typedef struct { eight H[9], T[9], own[3], w, c; } eight_points;

/* First pass over the bonds of eight points: displacement gradients H and T = weight sigma - c M (head of the
 * file); sum: sum_j w_j z_j. */
INLINE void first_pass (int dim, const galerkin_bundle *b, eight_points *e, eight *sum)
{
    const galerkin *g = b->g;
    const pg_rows *r = &g->sums;
    size_t p = b->run->point, own = (size_t) r->own[p];
    const double *kept = g->kept + p * KEPT, *here = g->place + 4 * own, *D;
    eight M[9] = { { 0 } }, strain[6] = { { 0 } };
    for (int a = 0; a < dim; a++)
        e->own[a] = *(const eight *) (b->x[a] + own + b->lane), sum[a] = (eight) { 0 };
    for (int k = 0; k < 9; k++) e->H[k] = (eight) { 0 };
    for (size_t k = r->family.start[p]; k < r->family.start[p + 1]; k++) {
        size_t j = (size_t) r->family.node[k];
        const double *q = r->dN + k * (size_t) dim, *there = g->place + 4 * j;
#pragma GCC unroll 3
        for (int a = 0; a < dim; a++) {
            eight eta = *(const eight *) (b->x[a] + j + b->lane) - e->own[a], part = r->w[k] * eta;
            sum[a] += part;
#pragma GCC unroll 3
            for (int c = 0; c < dim; c++)
                e->H[3*a + c] += q[c] * eta, M[3*a + c] += (there[c] - here[c]) * part;
        }
    }
    e->c = kept[C] * e->w;
    D = galerkin_plain (g, g->bulk, p)->D;
    if (dim == 3)
        strain[3] = e->H[1] + e->H[3], strain[4] = e->H[5] + e->H[7], strain[5] = e->H[6] + e->H[2];
    else strain[2] = e->H[1] + e->H[3];
    for (int a = 0; a < dim; a++) strain[a] = e->H[4 * a];
    for (int a = 0; a < dim; a++)
        for (int c = 0; c < dim; c++) {
            const double *row = D + pg_voigt_at (dim, a, c) * g->nv;
            eight m = M[3*a + c], s = { 0 };
            for (int k = 0; k < dim; k++) m -= kept[A + 3*k + c] * e->H[3*a + k];
            for (int k = 0; k < g->nv; k++) s += row[k] * strain[k];
            e->T[3*a + c] = e->w * s - e->c * m;
        }
    for (int a = 0; a < dim; a++)
        for (int c = 0; c < dim; c++) sum[a] -= kept[WXI + c] * e->H[3*a + c];
}

/* Second pass over the bonds: adds the forces of eight points, node by node. */
INLINE void sum_eight (int dim, const galerkin_bundle *b)
{
    const galerkin *g = b->g;
    const pg_rows *r = &g->sums;
    size_t p = b->run->point, own = (size_t) r->own[p];
    const double *here = g->place + 4 * own;
    double w[GALERKIN_LANES] = { 0 };
    eight_points e;
    eight sum[3];
    for (size_t k = 0; k < b->left; k++) w[k] = r->weight[p + b->lane + k];
    e.w = *(const eight *) w;
    first_pass (dim, b, &e, sum);
    for (size_t k = 0; k < b->run->entries; k++) {
        size_t bond = b->entry[k].bond, j = (size_t) b->entry[k].node + b->lane;
        const double *q = r->dN + bond * (size_t) dim, *there = g->place + 4 * (j - b->lane);
        eight c = r->w[bond] * e.c;
#pragma GCC unroll 3
        for (int a = 0; a < dim; a++) {
            eight z = *(const eight *) (b->x[a] + j) - e.own[a], f = { 0 };
#pragma GCC unroll 3
            for (int i = 0; i < dim; i++) z -= (there[i] - here[i]) * e.H[3*a + i], f += q[i] * e.T[3*a + i];
            *(eight *) (b->f[a] + (j - b->low)) += f + c * z;
        }
    }
    for (int a = 0; a < dim; a++) *(eight *) (b->f[a] + (own + b->lane - b->low)) -= e.c * sum[a];
}

PG_WIDEST static void eight_solid (const galerkin_bundle *b) { sum_eight (3, b); }
PG_WIDEST static void eight_plane (const galerkin_bundle *b) { sum_eight (2, b); }

void galerkin_silling_bundle (const galerkin_bundle *b) { (b->g->dim == 3 ? eight_solid : eight_plane) (b); }

/* ---- energy -------------------------------------------------------------------------------------------- */
/* Energy of the stabilisation at point p at displacement d (dim numbers a node), J: z is small against eta,
 * so its square is summed directly. */
double galerkin_silling_energy (const galerkin *g, size_t p, const double *d)
{
    const pg_rows *r = &g->sums;
    size_t dim = (size_t) g->dim, own = (size_t) r->own[p];
    double H[9] = { 0 }, energy = 0, c = r->weight[p] * g->kept[p * KEPT + C];
    for (size_t k = r->family.start[p]; c > 0 && k < r->family.start[p + 1]; k++)
        for (size_t a = 0; a < dim; a++)
            for (size_t b = 0; b < dim; b++)
                H[a*3 + b] += r->dN[k * dim + b]
                              * (d[(size_t) r->family.node[k] * dim + a] - d[own * dim + a]);
    for (size_t k = r->family.start[p]; c > 0 && k < r->family.start[p + 1]; k++) {
        size_t j = (size_t) r->family.node[k];
        for (size_t a = 0; a < dim; a++) {
            double z = d[j * dim + a] - d[own * dim + a];
            for (size_t b = 0; b < dim; b++)
                z -= H[a*3 + b] * (g->problem->cloud.x[j * dim + b] - r->x[p * dim + b]);
            energy += 0.5 * c * r->w[k] * z * z;
        }
    }
    return energy;
}
