/* SPDX-License-Identifier: GPL-3.0-or-later
 * K of the bonds for small displacements: K_ij = - kappa xi x xi, K_ii = sum_j kappa xi x xi over live bonds, as a product by the sweep, as a
 * sparse matrix whose columns are made again when a bond of their point breaks, its diagonal and row sums, and the bound
 * omega^2 <= 2 lambda_max (P_i) / rho_i, P_i = sum_j kappa xi x xi / V_i (theory A4). */
#include "bond.h"
#include <math.h>
#include <string.h>

typedef struct { double *y; int failed; } negation;
static void negate (void *context, size_t first, size_t last, int thread)
{
    (void) thread;
    const negation *w = context;
    double *y = w->y;
    if (w->failed) for (size_t i = first; i < last; i++) y[i] = NAN;
    else for (size_t i = first; i < last; i++) y[i] = -y[i];
}

/* K x = - forces at displacement x. A sweep does not fail without breaking; making that of finite stretch may: then K x is not a number. */
void bond_apply (void *context, const double *x, double *y)
{
    bond *b = context;
    pg_sweep *sweep;
    size_t ndof = b->n * (size_t) b->dim;
    int failed = bond_tangent_sweep (b, &sweep) != PG_OK || pg_sweep_force (sweep, x, y, NULL) != PG_OK;
    negation w = { y, failed };
    pg_parallel (b->threads, ndof, negate, &w);
}

/* sum_j kappa xi x xi over the live (or all) bonds of a point */
static void own_block (const bond *b, size_t i, const bond_star *s, int all, double *D)
{
    size_t dim = (size_t) b->dim;
    memset (D, 0, dim * dim * sizeof *D);
    for (size_t e = 0; e < s->m; e++) {
        const double *xi = s->xi + e * dim;
        if (!all && !bond_lives (b, s->first + e)) continue;
        double kappa = bond_kappa (b, i, s, e, NULL);
        for (size_t a = 0; a < dim; a++)
            for (size_t c = 0; c < dim; c++) D[a * dim + c] += kappa * xi[a] * xi[c];
    }
}

typedef struct { const bond *b; double *out; } job;

static void diagonal_points (void *context, size_t first, size_t last, int thread)
{
    const job *w = context;
    size_t dim = (size_t) w->b->dim;
    bond_star s;
    double D[9];
    for (size_t i = first; i < last; i++) {
        bond_star_at (w->b, i, thread, &s);
        own_block (w->b, i, &s, 0, D);
        for (size_t k = 0; k < dim; k++) w->out[i * dim + k] = D[k * dim + k];
    }
}

void bond_diagonal (void *context, double *d)
{
    bond *b = context;
    size_t ndof = b->n * (size_t) b->dim;
    if (b->diagonal && b->diagonal_of == b->revision) {
        memcpy (d, b->diagonal, ndof * sizeof *d);
        return;
    }
    job w = { b, d };
    pg_parallel (b->threads, b->n, diagonal_points, &w);
    if (!b->diagonal) b->diagonal = pg_calloc (ndof, sizeof *d);       /* kept where there is room for it                */
    if (b->diagonal) memcpy (b->diagonal, d, ndof * sizeof *d), b->diagonal_of = b->revision;
}

static void row_sum_points (void *context, size_t first, size_t last, int thread)
{
    const job *w = context;
    size_t dim = (size_t) w->b->dim;
    bond_star s;
    double D[9];
    for (size_t i = first; i < last; i++) {
        bond_star_at (w->b, i, thread, &s);
        own_block (w->b, i, &s, 0, D);
        double *sum = w->out + i * dim;
        for (size_t a = 0; a < dim; a++) {
            sum[a] = 0;
            for (size_t c = 0; c < dim; c++) sum[a] += fabs (D[a * dim + c]);
        }
        for (size_t e = 0; e < s.m; e++) {
            const double *xi = s.xi + e * dim;
            double reach = 0;
            if (!bond_lives (w->b, s.first + e)) continue;
            for (size_t c = 0; c < dim; c++) reach += fabs (xi[c]);
            double kappa = bond_kappa (w->b, i, &s, e, NULL);
            for (size_t a = 0; a < dim; a++) sum[a] += kappa * fabs (xi[a]) * reach;
        }
    }
}

pg_status bond_row_sums (void *self, double *sum)
{
    bond *b = self;
    job w = { b, sum };
    pg_parallel (b->threads, b->n, row_sum_points, &w);
    return PG_OK;
}

/* Row of blocks of a point over live bonds, its own block last. */
static size_t couplings_of (void *context, size_t i, int thread, int *node, double *value)
{
    const bond *b = context;
    size_t dim = (size_t) b->dim, bb = dim * dim, m = 0;
    if (!value) {
        for (size_t e = b->family->start[i]; e < b->family->start[i + 1]; e++) if (bond_lives (b, e)) node[m++] = b->family->node[e];
        node[m++] = (int) i;
        return m;
    }
    bond_star s;
    double own[9] = { 0 };
    bond_star_at (b, i, thread, &s);
    for (size_t e = 0; e < s.m; e++) {
        const double *xi = s.xi + e * dim;
        if (!bond_lives (b, s.first + e)) continue;
        double kappa = bond_kappa (b, i, &s, e, NULL), *v = value + m * bb;
        for (size_t a = 0; a < dim; a++)
            for (size_t c = 0; c < dim; c++) v[a * dim + c] = -(kappa * xi[a] * xi[c]), own[a * dim + c] -= v[a * dim + c];
        node[m++] = s.node[e];
    }
    memcpy (value + m * bb, own, bb * sizeof *own);
    node[m++] = (int) i;
    return m;
}

static void farthest_points (void *context, size_t first, size_t last, int thread)
{
    (void) thread;
    const job *w = context;
    size_t dim = (size_t) w->b->dim;
    const pg_family *f = w->b->family;
    const double *x = w->b->problem->cloud.x;
    for (size_t i = first; i < last; i++) {
        w->out[i] = 0;
        for (size_t e = f->start[i]; e < f->start[i + 1]; e++)
            for (size_t k = 0; k < dim; k++) {
                double far = fabs (x[(size_t) f->node[e] * dim + k] - x[i * dim + k]);
                if (far > w->out[i]) w->out[i] = far;
            }
    }
}

pg_status bond_couplings (void *self, pg_couplings *out)
{
    bond *b = self;
    const pg_stencil *t = &b->problem->sums->stencil;
    double far = 0;
    *out = (pg_couplings) { b, b->widest + 1, 0, couplings_of };
    if (t->n) for (size_t e = 0; e < t->n * (size_t) t->dim; e++) far = fmax (far, fabs (t->xi[e]));
    else {
        job w = { b, b->work };
        pg_parallel (b->threads, b->n, farthest_points, &w);
        for (size_t i = 0; i < b->n; i++) far = fmax (far, b->work[i]);
    }
    out->reach = far * (1 + 1e-9);
    return PG_OK;
}

static void bound_points (void *context, size_t first, size_t last, int thread)
{
    const job *w = context;
    const pg_problem *p = w->b->problem;
    bond_star s;
    double P[9], lambda[3];
    for (size_t i = first; i < last; i++) {
        double mass = p->material[p->block[PG_NODES][i]].density * p->cloud.volume[i];
        bond_star_at (w->b, i, thread, &s);
        own_block (w->b, i, &s, 1, P);
        pg_dense_eigen (w->b->dim, P, lambda, NULL);
        w->out[i] = 2 * lambda[0] / mass;
    }
}

pg_status bond_bound (void *self, double *omega)
{
    bond *b = self;
    double top = 0;
    job w = { b, b->work };
    for (size_t m = 0; m < b->problem->nmaterial; m++)
        if (!(b->problem->material[m].density > 0))
            return pg_error (PG_E_USAGE, PG_HERE, "material %s has no density: there is no frequency", b->problem->material[m].name);
    pg_parallel (b->threads, b->n, bound_points, &w);
    for (size_t i = 0; i < b->n; i++) top = fmax (top, b->work[i]);
    *omega = sqrt (top);
    return PG_OK;
}

/* ---- the matrix ---------------------------------------------------------------------------------------------------------------- */
/* Bonds of point i to points before it. */
static size_t lower (const bond *b, size_t i)
{
    size_t at = b->family->start[i], first = at;
    while (at < b->family->start[i + 1] && (size_t) b->family->node[at] < i) at++;
    return at - first;
}

static pg_status create_matrix (bond *b)
{
    pg_status status = PG_OK;
    size_t dim = (size_t) b->dim, nnz = 0;
    for (size_t i = 0; i < b->n; i++) nnz += lower (b, i) * dim * dim + dim * (dim + 1) / 2;
    PG_TRY (pg_sparse_create (&b->K, b->n * dim, b->n * dim, nnz, 1));
    long at = 0;
    for (size_t i = 0; i < b->n; i++) {
        size_t below = lower (b, i);
        const int *node = b->family->node + b->family->start[i];
        for (size_t c = 0; c < dim; c++) {
            for (size_t e = 0; e < below; e++)
                for (size_t a = 0; a < dim; a++) b->K.row[at++] = (long) ((size_t) node[e] * dim + a);
            for (size_t a = 0; a <= c; a++) b->K.row[at++] = (long) (i * dim + a);
            b->K.start[i * dim + c + 1] = at;
        }
    }
    b->all_stale = 1;
done:
    if (status != PG_OK) pg_sparse_clear (&b->K);
    return status;
}

static void make_columns (void *context, size_t first, size_t last, int thread)
{
    const job *w = context;
    const bond *b = w->b;
    size_t dim = (size_t) b->dim;
    bond_star s;
    double D[9];
    for (size_t i = first; i < last; i++) {
        if (!b->all_stale && !b->stale[i]) continue;
        bond_star_at (b, i, thread, &s);
        own_block (b, i, &s, 0, D);
        size_t below = lower (b, i);
        for (size_t e = 0; e < below; e++) {
            const double *xi = s.xi + e * dim;
            double kappa = bond_lives (b, s.first + e) ? bond_kappa (b, i, &s, e, NULL) : 0;
            for (size_t c = 0; c < dim; c++)
                for (size_t a = 0; a < dim; a++) b->K.value[b->K.start[i * dim + c] + (long) (e * dim + a)] = kappa == 0 ? 0 : -(kappa * xi[a] * xi[c]);
        }
        for (size_t c = 0; c < dim; c++)
            for (size_t a = 0; a <= c; a++) b->K.value[b->K.start[i * dim + c] + (long) (below * dim + a)] = D[a * dim + c];
    }
}

pg_status bond_assemble (void *self)
{
    pg_status status = PG_OK;
    bond *b = self;
    if (!b->K.row) PG_TRY (create_matrix (b));
    job w = { b, NULL };
    pg_parallel (b->threads, b->n, make_columns, &w);
    b->all_stale = 0;
    memset (b->stale, 0, b->n);
done:
    return status;
}

const pg_sparse *bond_matrix (void *self)
{
    bond *b = self;
    return b->K.row ? &b->K : NULL;
}
