/* SPDX-License-Identifier: GPL-3.0-or-later
 * Estimated error of the stress. Every node fits a polynomial of the order of the basis to the stresses at
 * the evaluation points with an intact bond to it (its patch), weighted by kernel and volume; the recovered
 * stress s* at a point is the mean of the polynomials of the nodes in its family, with the same weights.
 * eta^2 = int (s* - s) C (s* - s) dV. Zienkiewicz & Zhu 1992 (patches), Blacker & Belytschko 1994 (mean of
 * polynomials). Patches do not cross cracks (only intact bonds count) nor borders of materials; points with
 * less than a linear basis are excluded. */
#include "galerkin.h"
#include <math.h>
#include <string.h>

enum { TERMS = 10, VOIGT = 6, LANES = 4, WIDEST = TERMS + VOIGT + LANES };
typedef struct {
    galerkin *g;
    const pg_rows *rows;
    const double *stress;                              /* at the points, Pa (points x nv) */
    int     order, terms;                              /* of the polynomials: order, number of terms */
    /* Normal equations A c = b of each node (stride numbers): row a begins at at[a] with nv numbers of b,
     * later replaced by the coefficients, then a + 1 numbers of A; padding follows. */
    size_t  at[TERMS + 1], stride;
    double *fit;
    unsigned char *known;                              /* the node has a polynomial (n) */
    double *error, *size;  /* (s* - s) C (s* - s) and s C s at the points, Pa; NAN: excluded */
    double *L;                                         /* factor of D of each material (36 each) */
} recovery;

/* Does point p take part: has it at least a linear basis? The stress of others is of lower order. */
static int takes_part (const recovery *r, size_t p)
{
    return r->rows->grade[p] <= PG_GRADE_LOWERED && r->rows->weight[p] > 0;
}

/* Number of terms of a polynomial of this order: 1, 1 + dim, ... */
static int terms_of (int dim, int order)
{
    return order == 0 ? 1 : order == 1 ? 1 + dim : 1 + dim + dim * (dim + 1) / 2;
}

/* The terms 1, z_k, z_k z_l at point p about a node, z in horizons from the node, so that all are of the
 * order of 1. */
static void polynomial (const recovery *r, size_t p, size_t node, double *q)
{
    const galerkin *g = r->g;
    size_t dim = (size_t) g->dim;
    double z[3];
    int m = 0;
    for (size_t k = 0; k < dim; k++)
        z[k] = (r->rows->x[p * dim + k] - g->problem->cloud.x[node * dim + k])
               / g->problem->form.approx.horizon;
    q[m++] = 1;
    for (size_t k = 0; k < dim && r->order > 0; k++) q[m++] = z[k];
    for (size_t k = 0; k < dim && r->order > 1; k++)
        for (size_t l = k; l < dim; l++) q[m++] = z[k] * z[l];
}

/* Weight of the bond between point p and its entry e in the fit of that node, kernel per volume; 0: the point
 * is of another material than the node. */
static double weight_of (const recovery *r, size_t p, size_t e)
{
    size_t j = (size_t) r->rows->family.node[e];
    if (r->g->material[r->g->bulk][p] != r->g->material[PG_NODES][j]) return 0;
    return r->rows->w[e + pg_rows_offset (r->rows, p)] / r->g->problem->cloud.volume[j];
}

/* ---- polynomials --------------------------------------------------------------------------------------- */
/* Solves the normal equations of one node for all stress components: the polynomial of the highest order, up
 * to r->order, that the points of its patch determine (the factor exists). Returns 0 if not even a constant
 * is determined. */
static int solve (const recovery *r, double *fit)
{
    int nv = r->g->nv, dim = r->g->dim;
    double mass = fit[nv];
    if (!(mass > 0)) return 0;
    for (int order = r->order; order >= 0; order--) {
        int m = terms_of (dim, order);
        double L[TERMS * TERMS], x[TERMS];
        for (int a = 0; a < m; a++)
            for (int c = 0; c <= a; c++) L[a * m + c] = fit[r->at[a] + (size_t) (nv + c)] / mass;
        if (pg_dense_cholesky (m, L, order > 1 ? 1e-6 : 1e-4) != 0) continue;
        for (int v = 0; v < nv; v++) {
            for (int a = 0; a < m; a++) x[a] = fit[r->at[a] + (size_t) v] / mass;
            pg_dense_solve (m, L, x);
            for (int a = 0; a < r->terms; a++) fit[r->at[a] + (size_t) v] = a < m ? x[a] : 0;
        }
        return 1;
    }
    return 0;
}

/* Adds a point with weight w to the normal equations of a node, four numbers at a time. row: its stress, then
 * the terms. */
PG_WIDE static void add_point (const recovery *r, double w, const double *row, double *fit)
{
    for (int a = 0; a < r->terms; a++) {
        double c = w * row[r->g->nv + a];
        for (size_t k = r->at[a]; k < r->at[a + 1]; k += LANES)
            *(four *) (void *) (fit + k) += c * *(const four *) (const void *) (row + k - r->at[a]);
    }
}

/* Fits the polynomials of nodes first .. last - 1. Each thread reads all points in ascending order and uses
 * those with bonds to its own nodes: sums do not depend on the number of threads. */
static void fit_nodes (void *context, size_t first, size_t last, int thread)
{
    recovery *r = context;
    const pg_family *f = &r->rows->family;
    double row[WIDEST] = { 0 };
    int nv = r->g->nv;
    (void) thread;
    for (size_t p = 0; p < f->n; p++) {
        if (!takes_part (r, p)) continue;
        memcpy (row, r->stress + p * (size_t) nv, (size_t) nv * sizeof *row);
        for (size_t e = f->start[p]; e < f->start[p + 1]; e++) {
            size_t j = (size_t) f->node[e];
            if (j < first || j >= last) continue;
            double w = weight_of (r, p, e) * r->rows->weight[p];
            if (!(w > 0)) continue;
            polynomial (r, p, j, row + nv);
            add_point (r, w, row, r->fit + j * r->stride);
        }
    }
    for (size_t j = first; j < last; j++) r->known[j] = (unsigned char) solve (r, r->fit + j * r->stride);
}

/* ---- error --------------------------------------------------------------------------------------------- */
/* s D^-1 s, Pa: twice the complementary energy density of a stress. */
static double complementary (const recovery *r, size_t p, const double *s)
{
    double e[VOIGT], sum = 0;
    memcpy (e, s, (size_t) r->g->nv * sizeof *s);
    pg_dense_solve (r->g->nv, r->L + 36 * (size_t) r->g->problem->at.law_of[r->g->bulk][p], e);
    for (int v = 0; v < r->g->nv; v++) sum += s[v] * e[v];
    return sum;
}

/* s += w times the polynomials of a node at terms q (eight numbers; those from nv on are unused). */
PG_WIDE static void add_values (const recovery *r, double w, const double *q, const double *fit, double *s)
{
    four *sum = (four *) (void *) s;
    for (int a = 0; a < r->terms; a++) {
        const four *c = (const four *) (const void *) (fit + r->at[a]);
        sum[0] += w * q[a] * c[0];
        if (r->g->nv > LANES) sum[1] += w * q[a] * c[1];
    }
}

/* Energy norms of the difference of recovered and computed stress, and of the computed one, at a range of
 * points; NAN where no node has a polynomial. */
static void compare_points (void *context, size_t first, size_t last, int thread)
{
    recovery *r = context;
    const pg_family *f = &r->rows->family;
    int nv = r->g->nv;
    double q[TERMS];
    (void) thread;
    for (size_t p = first; p < last; p++) {
        const double *s = r->stress + p * (size_t) nv;
        double sum = 0, recovered[2 * LANES] = { 0 };
        r->error[p] = r->size[p] = NAN;
        if (!takes_part (r, p)) continue;
        for (size_t e = f->start[p]; e < f->start[p + 1]; e++) {
            size_t j = (size_t) f->node[e];
            double w = r->known[j] ? weight_of (r, p, e) : 0;
            if (!(w > 0)) continue;
            polynomial (r, p, j, q);
            add_values (r, w, q, r->fit + j * r->stride, recovered);
            sum += w;
        }
        if (!(sum > 0)) continue;
        for (int v = 0; v < nv; v++) recovered[v] = recovered[v] / sum - s[v];
        r->error[p] = complementary (r, p, recovered), r->size[p] = complementary (r, p, s);
    }
}

/* Distributes the error of every point to its nearest node, or to all equally near (two passes: the smallest
 * distance, then the nodes at that distance). value: root of E times the mean error density, Pa, so that it
 * can be compared with stresses. */
static void to_nodes (const recovery *r, double *volume, double *value)
{
    const galerkin *g = r->g;
    const pg_family *f = &r->rows->family;
    size_t dim = (size_t) g->dim;
    memset (value, 0, g->n * sizeof *value);
    for (size_t p = 0; p < f->n; p++) {
        double nearest = INFINITY;
        for (int pass = 0; pass < 2 && isfinite (r->error[p]); pass++)
            for (size_t e = f->start[p]; e < f->start[p + 1]; e++) {
                size_t j = (size_t) f->node[e];
                double s = 0;
                for (size_t k = 0; k < dim; k++)
                    s += pow (r->rows->x[p * dim + k] - g->problem->cloud.x[j * dim + k], 2);
                if (pass == 0) nearest = fmin (nearest, s);
                else if (s <= nearest * (1 + 1e-6))
                    value[j] += r->rows->weight[p] * r->error[p], volume[j] += r->rows->weight[p];
            }
    }
    for (size_t j = 0; j < g->n; j++)
        value[j] = volume[j] > 0 ? sqrt (galerkin_material (g, PG_NODES, j)->modulus * value[j] / volume[j])
                                 : 0;
}

/* Sums up the norms over the body; relative: the error over the norm of the recovered stress, at most 1. */
static void add_up (const recovery *r, pg_estimate *out)
{
    double error = 0, size = 0;
    for (size_t p = 0; p < r->rows->n; p++) {
        int counts = isfinite (r->error[p]);
        if (counts) error += r->rows->weight[p] * r->error[p], size += r->rows->weight[p] * r->size[p];
        out->points += (size_t) counts, out->left_out += (size_t) !counts;
    }
    out->error = sqrt (error), out->norm = sqrt (size);
    out->relative = size + error > 0 ? sqrt (error / (size + error)) : 0;
}

/* Computes the estimate; value (n): the error at every node, Pa, unless NULL. D of each material is factored
 * once. */
pg_status galerkin_estimate (void *self, const double *d, pg_estimate *out, double *value)
{
    pg_status status = PG_OK;
    galerkin *g = self;
    const pg_problem *p = g->problem;
    recovery r = { .g = g, .rows = &g->rows[g->bulk], .order = p->form.approx.order };
    double *volume = NULL, start = pg_seconds ();
    size_t points = r.rows->n;
    *out = (pg_estimate) { 0 };
    r.terms = terms_of (g->dim, r.order);
    for (int a = 0; a < r.terms; a++)
        r.at[a + 1] = r.at[a] + (size_t) (g->nv + a + 1 + LANES - 1) / LANES * LANES;
    r.stride = r.at[r.terms];
    PG_ALLOC (r.fit, g->n * r.stride);
    PG_ALLOC (r.known, g->n);
    PG_ALLOC (r.error, points);
    PG_ALLOC (r.size, points);
    PG_ALLOC (r.L, 36 * p->at.nlaw);
    PG_ALLOC (volume, g->n);
    for (size_t m = 0; m < p->at.nlaw; m++) {
        memcpy (r.L + 36 * m, p->at.law[m].D, 36 * sizeof *r.L);
        if (pg_dense_cholesky (g->nv, r.L + 36 * m, 1e-12) != 0)
            PG_FAIL (PG_E_NOT_SPD, "material %s: its stiffness has no inverse", p->at.law[m].name);
    }
    galerkin_measure (g, g->bulk, d);
    r.stress = g->measured.stress[g->bulk];
    pg_parallel_heavy (g->threads, g->n, fit_nodes, &r);
    pg_parallel (g->threads, points, compare_points, &r);
    add_up (&r, out);
    if (value) to_nodes (&r, volume, value);
    out->seconds = pg_seconds () - start;
done:
    pg_free (volume), pg_free (r.L), pg_free (r.size), pg_free (r.error), pg_free (r.known), pg_free (r.fit);
    return status;
}
