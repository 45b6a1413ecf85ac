/* SPDX-License-Identifier: GPL-3.0-or-later
 * Approximate rows of K for preconditioners of forces with dilatations, which reach no further than bonds; K
 * itself couples neighbours of neighbours. In the energy of a point's dilatation, A theta^2 / (2 d) V, theta
 * is taken from the displacement gradient over the nearest points only (within half the horizon, 1.5 spacings
 * at most). This is exact for uniform strain, so that coarse grids have the true bulk modulus. Where bonds to
 * or among these points are broken, pair forces that are at least as stiff (d A / q) are used instead. */
#include "dilatation.h"
#include <math.h>
#include <stdint.h>
#include <string.h>

enum { MOST = 36, NEAR = 40 };                         /* most numbers of a block; most nearest points */
struct dilatation_rows {
    size_t *start;  int *node;                         /* nearest points of each point (n + 1; start[n]) */
    double *inverse;  /* inverse of sum V xi x xi over the nearest points, 1/m^5 (n x dim x dim) */
    double *stiff;  /* C / q, or B / q where theta is taken from the nearest points (n) */
    /* narrow: 1: theta is taken from the nearest points; uniform: 1: the row is the shared one (n) */
    unsigned char *narrow, *uniform;
    unsigned char *intact;                             /* 1: no bond of the point is broken (n) */
    double *whole;                                     /* the shared row of blocks; NULL: there is none */
};

/* Frees the rows of the last preconditioner, if there are any. */
void dilatation_rows_free (bond_force *b)
{
    dilatation_rows *r = b->dilatation->rows;
    if (!r) return;
    pg_free (r->start), pg_free (r->node), pg_free (r->inverse), pg_free (r->stiff), pg_free (r->narrow),
        pg_free (r->uniform), pg_free (r->intact), pg_free (r->whole);
    pg_free (r);
    b->dilatation->rows = NULL;
}

/* ---- nearest points ------------------------------------------------------------------------------------ */
/* Bond vector from point i to point j, m. */
static void offset (const bond_force *b, size_t i, size_t j, double *xi)
{
    for (size_t k = 0; k < (size_t) b->dim; k++)
        xi[k] = b->problem->cloud.x[j * (size_t) b->dim + k] - b->problem->cloud.x[i * (size_t) b->dim + k];
}

/* Lists the nearest points of point i, at most NEAR (-1 if the bond to one is broken); returns their number.
 * They lie within half the horizon, so that they are each other's neighbours (a kernel that vanishes at the
 * horizon: less). */
static size_t nearest (const bond_force *b, size_t i, int *node)
{
    const pg_family *f = b->family;
    double h = pg_problem_spacing (b->problem, PG_NODES, i), ratio = h / b->problem->cloud.h, xi[3];
    double half = 0.5 * b->problem->sums->rule.horizon * ratio, same = pg_cloud_same (&b->problem->cloud),
           reach = fmin (half + (b->problem->sums->rule.kernel->closed ? same : -same), 1.5 * h + same);
    size_t m = 0;
    for (size_t e = f->start[i]; e < f->start[i + 1] && m < NEAR; e++) {
        double rr = 0;
        offset (b, i, (size_t) f->node[e], xi);
        for (int k = 0; k < b->dim; k++) rr += xi[k] * xi[k];
        if (rr <= reach * reach) node[m++] = bond_force_lives (b, e) ? f->node[e] : -1;
    }
    return m;
}

/* Returns the entry of the bond from i to j in the family, by bisection; -1: it is broken, or there is
 * none. */
static long entry_of (const bond_force *b, size_t i, int j)
{
    const int *node = b->family->node;
    size_t low = b->family->start[i], high = b->family->start[i + 1];
    while (high > low + 1) {
        size_t middle = (low + high) / 2;
        if (node[middle] <= j) low = middle;
        else high = middle;
    }
    return low < high && node[low] == j && bond_force_lives (b, low) ? (long) low : -1;
}

/* Can the dilatation of point i be taken from its nearest points? The bonds to them must be intact, there
 * must be enough, and they must be each other's neighbours, so that their rows of K have the blocks that this
 * needs. */
static int is_narrow (const bond_force *b, const dilatation_rows *r, size_t i, size_t m, const int *node)
{
    int intact = r->intact[i] && b->problem->sums->stencil.n;
    if (!(b->dilatation->A[i] > 0) || m < 2 * (size_t) b->dim) return 0;
    for (size_t k = 0; k < m; k++) {
        if (node[k] < 0) return 0;
        intact &= r->intact[node[k]];
    }
    for (size_t k = 0; k < m && !intact; k++)
        for (size_t l = 0; l < k; l++) if (entry_of (b, (size_t) node[k], node[l]) < 0) return 0;
    return 1;
}

/* Computes the inverse of sum V xi x xi over the nearest points, 1/m^5. Returns 0 if these do not span all
 * directions: if the smallest eigenvalue is less than a tenth of the largest. */
static int invert (const bond_force *b, size_t i, size_t m, const int *node, double *out)
{
    size_t dim = (size_t) b->dim;
    double M[9] = { 0 }, lambda[3], xi[3], copy[9];
    for (size_t k = 0; k < m; k++) {
        offset (b, i, (size_t) node[k], xi);
        for (size_t a = 0; a < dim; a++)
            for (size_t c = 0; c < dim; c++)
                M[a * dim + c] += b->problem->cloud.volume[node[k]] * xi[a] * xi[c];
    }
    memcpy (copy, M, sizeof M);
    pg_dense_eigen (b->dim, copy, lambda, NULL);
    if (!(lambda[dim - 1] > 0.1 * lambda[0]) || pg_dense_cholesky (b->dim, M, 1e-12)) return 0;
    for (size_t a = 0; a < dim; a++) {
        for (size_t c = 0; c < dim; c++) out[a * dim + c] = a == c;
        pg_dense_solve (b->dim, M, out + a * dim);
    }
    return 1;
}

/* Counts the nearest points of each of the points first .. last - 1, and sets `intact`. */
static void count_points (void *context, size_t first, size_t last, int thread)
{
    bond_force *b = context;
    const size_t *start = b->family->start;
    int node[NEAR];
    (void) thread;
    for (size_t i = first; i < last; i++) {
        b->dilatation->rows->start[i + 1] = nearest (b, i, node);
        b->dilatation->rows->intact[i] = !(b->alive
                                           && memchr (b->alive + start[i], 0, start[i + 1] - start[i]));
    }
}

/* Lists the nearest points of points first .. last - 1, and decides whether the dilatation can be taken from
 * them (narrow). stiff: what pair forces must bear: B / q if it can, else C / q. */
static void find_points (void *context, size_t first, size_t last, int thread)
{
    bond_force *b = context;
    dilatation_rows *r = b->dilatation->rows;
    (void) thread;
    for (size_t i = first; i < last; i++) {
        int *node = r->node + r->start[i];
        size_t m = nearest (b, i, node);
        r->narrow[i] = (unsigned char) (is_narrow (b, r, i, m, node)
                                        && invert (b, i, m, node,
                                                   r->inverse + i * (size_t) (b->dim * b->dim)));
        r->stiff[i] = !r->narrow[i] ? b->dilatation->stiff[i] : b->dilatation->q[i] > 0
            ? b->dilatation->B[i] / b->dilatation->q[i] : 0;
    }
}

/* Sets `uniform` for points first .. last - 1 whose row is that of most points of a lattice: they have all
 * bonds, and they and all their neighbours are narrow and have the same B / q. */
static void compare_points (void *context, size_t first, size_t last, int thread)
{
    bond_force *b = context;
    dilatation_rows *r = b->dilatation->rows;
    (void) thread;
    for (size_t i = first; i < last; i++) {
        size_t at = b->family->start[i], end = b->family->start[i + 1];
        int same = end - at == b->problem->sums->stencil.n && r->intact[i] && r->narrow[i];
        for (size_t e = at; e < end && same; e++) {
            size_t j = (size_t) b->family->node[e];
            same = r->narrow[j] && r->stiff[j] == r->stiff[i];
        }
        r->uniform[i] = (unsigned char) same;
    }
}

/* ---- a row --------------------------------------------------------------------------------------------- */
/* Derivative g (1/m) of the dilatation of point k, taken from its nearest points, by the displacement of
 * point j: theta_k = sum_j g_j . (u_j - u_k); for j = k minus the sum of the others. */
static void gradient (const bond_force *b, size_t k, int j, double *g)
{
    const dilatation_rows *r = b->dilatation->rows;
    size_t dim = (size_t) b->dim;
    double xi[3], sum[3] = { 0 };
    for (size_t e = r->start[k]; e < r->start[k + 1]; e++) {
        if ((size_t) j != k && r->node[e] != j) continue;
        offset (b, k, (size_t) r->node[e], xi);
        for (size_t a = 0; a < dim; a++)
            for (size_t c = 0; c < dim; c++)
                sum[a] += b->problem->cloud.volume[r->node[e]] * r->inverse[(k * dim + a) * dim + c] * xi[c];
    }
    for (size_t a = 0; a < dim; a++) g[a] = (size_t) j == k ? -sum[a] : sum[a];
}

/* Adds the share of the dilatation of point k to the row of point i: V A / d g_i x g_j for k and its nearest
 * points j. node: nodes of the row's n blocks, i last. */
static void add_dilatation (const bond_force *b, size_t i, size_t k, size_t n, const int *node, double *value)
{
    const dilatation_rows *r = b->dilatation->rows;
    size_t dim = (size_t) b->dim, m = (size_t) b->stride, near = r->start[k + 1] - r->start[k];
    double mine[3], other[3], scale = b->problem->cloud.volume[k] * b->dilatation->A[k] / b->dim;
    gradient (b, k, (int) i, mine);
    for (size_t e = 0; e <= near; e++) {
        int j = e < near ? r->node[r->start[k] + e] : (int) k;
        size_t low = 0, high = n - 1;
        while (high > low + 1) {
            size_t middle = (low + high) / 2;
            if (node[middle] <= j) low = middle;
            else high = middle;
        }
        if ((size_t) j == i) low = n - 1;
        if (node[low] != j) continue;                  /* never happens: i and j are neighbours */
        gradient (b, k, j, other);
        for (size_t a = 0; a < dim; a++)
            for (size_t c = 0; c < dim; c++) value[low * m * m + a * m + c] += scale * mine[a] * other[c];
    }
}

/* Blocks of bond e: of the micropolar bond, if any, and of the pair force that replaces the dilatation. */
static void pull_block (const bond_force *b, size_t i, const point_bonds *s, size_t e, double *own,
                        double *other)
{
    size_t mm = (size_t) (b->stride * b->stride);
    if (b->theory->alone) b->theory->alone (b, i, s, e, own, other);
    else memset (own, 0, mm * sizeof *own), memset (other, 0, mm * sizeof *other);
    dilatation_pull (b, i, s, e, b->dilatation->rows->stiff[i] + b->dilatation->rows->stiff[s->node[e]], own,
                     other);
}

/* Row of point i: blocks of all its intact bonds, its own last, plus the shares of the dilatations of the
 * point and of its neighbours. node: their nodes. Returns the number of blocks. */
static size_t make_row (const bond_force *b, size_t i, int thread, int *node, double *value)
{
    const dilatation_rows *r = b->dilatation->rows;
    size_t bb = (size_t) (b->stride * b->stride), m = 0;
    double own[MOST] = { 0 }, part[MOST];
    point_bonds s;
    point_bonds_at (b, i, thread, &s);
    for (size_t e = 0; e < s.m; e++) {
        if (!bond_force_lives (b, s.first + e)) continue;
        pull_block (b, i, &s, e, part, value + m * bb);
        for (size_t k = 0; k < bb; k++) own[k] += part[k];
        node[m++] = s.node[e];
    }
    memcpy (value + m * bb, own, bb * sizeof *own);
    node[m++] = (int) i;
    if (r->narrow[i]) add_dilatation (b, i, i, m, node, value);
    for (size_t e = 0; e + 1 < m; e++)                 /* neighbours that have i among their nearest points */
        if (r->narrow[node[e]])
            for (size_t k = r->start[node[e]]; k < r->start[node[e] + 1]; k++)
                if ((size_t) r->node[k] == i) add_dilatation (b, i, (size_t) node[e], m, node, value);
    return m;
}

/* pg_couplings.row: blocks of the row of point i; value NULL: only nodes. */
static size_t row (void *context, size_t i, int thread, int *node, double *value)
{
    const bond_force *b = context;
    const dilatation_rows *r = b->dilatation->rows;
    size_t first = b->family->start[i], m = 0;
    if (value && r->whole && r->uniform[i]) {
        m = b->family->start[i + 1] - first;
        memcpy (node, b->family->node + first, m * sizeof *node);
        memcpy (value, r->whole, (m + 1) * (size_t) (b->stride * b->stride) * sizeof *value);
        node[m] = (int) i;
        return m + 1;
    }
    if (value) return make_row (b, i, thread, node, value);
    for (size_t e = first; e < b->family->start[i + 1]; e++)
        if (bond_force_lives (b, e)) node[m++] = b->family->node[e];
    node[m++] = (int) i;
    return m;
}

/* pg_couplings.alike: 1: point i has the shared row. */
static int is_uniform (void *context, size_t i)
{
    return ((const bond_force *) context)->dilatation->rows->uniform[i];
}

/* ---- all rows ------------------------------------------------------------------------------------------ */
/* Makes the shared row: on a lattice with equal volumes, one material and no surface correction. */
static pg_status find_whole (bond_force *b, pg_couplings *out)
{
    pg_status status = PG_OK;
    const pg_sums *sums = b->problem->sums;
    size_t i = 0, n = sums->stencil.n;
    int *node = NULL;
    if (!n || !sums->ordered || sums->share || sums->family_volume || b->problem->at.nlaw > 1) return PG_OK;
    pg_parallel (b->threads, b->n, compare_points, b);
    while (i < b->n && !b->dilatation->rows->uniform[i]) i++;
    if (i == b->n) return PG_OK;
    PG_ALLOC (node, n + 1);
    PG_ALLOC (b->dilatation->rows->whole, (n + 1) * (size_t) (b->stride * b->stride));
    make_row (b, i, 0, node, b->dilatation->rows->whole);
    out->alike = is_uniform;
    for (int k = 0; k < b->dim; k++) out->lattice[k] = sums->sites.step[k];
done:
    pg_free (node);
    return status;
}

/* Makes the data of rows anew for each preconditioner, for the bonds that are intact then. */
pg_status dilatation_couplings (bond_force *b, pg_couplings *out)
{
    pg_status status = PG_OK;
    dilatation_rows *r = NULL;
    dilatation_rows_free (b);
    PG_TRY (dilatation_weigh (b));
    PG_ALLOC (r, 1);
    b->dilatation->rows = r;
    PG_ALLOC (r->start, b->n + 1);
    PG_ALLOC (r->inverse, b->n * (size_t) (b->dim * b->dim));
    PG_ALLOC (r->stiff, b->n);
    PG_ALLOC (r->narrow, b->n);
    PG_ALLOC (r->uniform, b->n);
    PG_ALLOC (r->intact, b->n);
    pg_parallel (b->threads, b->n, count_points, b);
    for (size_t i = 0; i < b->n; i++) r->start[i + 1] += r->start[i];
    PG_ALLOC (r->node, r->start[b->n]);
    pg_parallel (b->threads, b->n, find_points, b);
    out->row = row;
    PG_TRY (find_whole (b, out));
done:
    return status;
}
