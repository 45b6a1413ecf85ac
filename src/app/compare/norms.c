/* SPDX-License-Identifier: GPL-3.0-or-later
 * Norms of the difference of two samplers over quadrature points, and over the rows of tables.
 *
 *   L2        sqrt (sum_q w_q |u - u_ref|^2)
 *   energy    sqrt (sum_q w_q (s - s_ref) : D^-1 : (s - s_ref))
 *   maxima    over the quadrature points
 *
 * Samplers may use threads inside, but the sums run over the places in their order, so that
 * the norms have the same bits with any number of threads. */
#include "compare.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

/* CHUNK: points sampled at a time, which bounds the memory. Cells are taken in PARTS of at least PLACES
 * points: for each part a sampler finds out again what it has to know of the whole body (that no bond is
 * broken, which field it is), and only where a part has enough points does it look for points with alike
 * neighbourhoods. */
enum { CHUNK = 16384, PARTS = 64, PLACES = 8192 };

/* A measurement in progress. */
typedef struct {
    /* Dimension; Voigt components of it; bits of the displacement components compared; 1 if
     * stress is. */
    int     dim, nv, u, stress;
    /* Index among xx yy zz xy yz zx of each Voigt component of the dimension. */
    int     part[6];
    /* Cholesky factor of D of each material (36 values each). */
    double *L;
    const pg_norm_options *options;
    /* Samples of one chunk: displacement of value and reference (room x 3), stresses of both (room x 6). */
    size_t  room;
    double *v, *w, *s, *t;
    /* Sums of squares: displacement difference and reference, energies likewise; the largest
     * |u_ref| and |s_ref|. */
    double  sum[4], top_u, top_s;
    pg_norms *out;
} measuring;

/* Computes the relative norm from difference and reference. */
static void close_norm (pg_norm *n)
{
    n->relative = n->difference == 0 ? 0 : n->reference > 0 ? n->difference / n->reference : INFINITY;
}

/* 1 if all of the n values whose bit is set are finite. */
static int finite_all (const double *a, int n, int bits)
{
    for (int k = 0; k < n; k++) if ((bits >> k & 1) && !isfinite (a[k])) return 0;
    return 1;
}

/* s : D^-1 : s = |L^-1 s|^2 for a stress s in the Voigt components of the dimension: twice the complementary
 * energy density. */
static double complementary (const measuring *m, size_t material, const double *s)
{
    const double *L = m->L + 36 * material;
    double y[6], sum = 0;
    for (int k = 0; k < m->nv; k++) {
        double rest = s[k];
        for (int l = 0; l < k; l++) rest -= L[k * m->nv + l] * y[l];
        y[k] = rest / L[k * m->nv + k];
        sum += y[k] * y[k];
    }
    return sum;
}

/* Updates the largest difference and its position x. */
static void largest (pg_norm *n, double size, int dim, const double *x)
{
    if (!(size > n->difference)) return;
    n->difference = size;
    for (int k = 0; k < dim; k++) n->place[k] = x[k];
}

/* Adds a place with displacements v and w (reference) to L2 and maximum norm. */
static void add_displacement (measuring *m, const double *x, const double *v, const double *w, double weight)
{
    double d2 = 0, r2 = 0;
    for (int k = 0; k < m->dim; k++)
        if (m->u >> k & 1) d2 += (v[k] - w[k]) * (v[k] - w[k]), r2 += w[k] * w[k];
    m->sum[0] += weight * d2, m->sum[1] += weight * r2;
    largest (&m->out->maximum, sqrt (d2), m->dim, x);
    m->top_u = fmax (m->top_u, sqrt (r2));
}

/* Adds a place with stresses s and t (reference) to energy and maximum norm. In the maximum
 * norm shears count twice, in the energy norm the engineering shears of D do the same. */
static void add_stress (measuring *m, const double *x, const double *s, const double *t, double weight,
                        size_t material)
{
    double d[6], r[6], d2 = 0, r2 = 0;
    for (int k = 0; k < m->nv; k++) {
        d[k] = s[m->part[k]] - t[m->part[k]], r[k] = t[m->part[k]];
        double twice = k < m->dim ? 1 : 2;             /* shears stand for two components */
        d2 += twice * d[k] * d[k], r2 += twice * r[k] * r[k];
    }
    m->sum[2] += weight * complementary (m, material, d),
        m->sum[3] += weight * complementary (m, material, r);
    largest (&m->out->stress_maximum, sqrt (d2), m->dim, x);
    m->top_s = fmax (m->top_s, sqrt (r2));
}

/* Factors the elastic laws D = L L', so that D^-1 s is two triangular solves. A law that is
 * not positive definite (a pivot below 1e-14 of the diagonal) has no energy norm. */
static pg_status factor_laws (measuring *m, size_t n)
{
    pg_status status = PG_OK;
    PG_ALLOC (m->L, 36 * n);
    for (size_t k = 0; k < n; k++) {
        const pg_material *law = &m->options->material[k];
        memcpy (m->L + 36*k, law->D, (size_t) (m->nv * m->nv) * sizeof *law->D);
        if (pg_dense_cholesky (m->nv, m->L + 36*k, 1e-14) != 0)
            PG_FAIL (PG_E_SINGULAR, "the elastic law of %s has no inverse: no energy norm", law->name);
    }
done:
    return status;
}

/* Decides which components are compared. Displacements need one component that both sides know; stress needs
 * all of the dimension and an elastic law, since the energy norm couples them. laws: their number. */
static pg_status prepare (measuring *m, size_t laws, const pg_sampler *value, const pg_sampler *reference)
{
    static const int part[4][6] = { { 0 }, { 0 }, { 0, 1, 3 }, { 0, 1, 2, 3, 4, 5 } };
    pg_status status = PG_OK;
    int needed = 0;
    memset (m->out, 0, sizeof *m->out);
    if (value->dim != reference->dim)
        PG_FAIL (PG_E_USAGE, "a %dD result is compared with a %dD one", value->dim, reference->dim);
    m->dim = value->dim, m->nv = pg_voigt_size (m->dim);
    memcpy (m->part, part[m->dim], sizeof m->part);
    m->u = value->displacement & reference->displacement;
    for (int k = 0; k < m->nv; k++) needed |= 1 << m->part[k];
    m->stress = m->options->material && (value->stress & reference->stress & needed) == needed;
    if (m->stress) PG_TRY (factor_laws (m, laws));
done:
    return status;
}

/* Allocates arrays for the samples of n points. */
static pg_status widen (measuring *m, size_t n)
{
    pg_status status = PG_OK;
    if (n <= m->room) return PG_OK;
    pg_free (m->v), m->v = NULL, m->room = 0;
    PG_ALLOC (m->v, 18 * n);
    m->w = m->v + 3 * n, m->s = m->w + 3 * n, m->t = m->s + 6 * n, m->room = n;
done:
    return status;
}

/* 1 if the condition does not hold at the place. */
static int excluded (const pg_expression *where, int dim, const double *x)
{
    if (!where) return 0;
    pg_place at = pg_place_of (dim, x, 0);
    return pg_expression_value (where, &at) == 0;
}

/* Adds the sampled places first to first + n - 1; those without finite values on both sides,
 * or outside the condition, are counted as skipped, and the volume is that of the places that
 * were compared. */
static void add_chunk (measuring *m, const pg_quadrature *q, size_t first, size_t n)
{
    for (size_t i = 0; i < n; i++) {
        const double *x = q->x + (first + i) * (size_t) m->dim;
        const double *v = m->v + 3*i, *w = m->w + 3*i, *s = m->s + 6*i, *t = m->t + 6*i;
        int bits = 0;
        for (int k = 0; k < m->nv; k++) bits |= 1 << m->part[k];
        if (excluded (m->options->where, m->dim, x) || !finite_all (w, m->dim, m->u)
            || !finite_all (v, m->dim, m->u)
            || (m->stress && (!finite_all (t, 6, bits) || !finite_all (s, 6, bits)))) {
            m->out->skipped++;
            continue;
        }
        m->out->places++, m->out->volume += q->weight[first + i];
        if (m->u) add_displacement (m, x, v, w, q->weight[first + i]);
        if (m->stress)
            add_stress (m, x, s, t, q->weight[first + i],
                        m->options->which ? (size_t) m->options->which[first + i] : 0);
    }
}

/* Samples both sides chunk by chunk, and adds to the norms. */
static pg_status add_places (measuring *m, const pg_quadrature *q, size_t chunk, const pg_sampler *value,
                             const pg_sampler *reference)
{
    pg_status status = PG_OK;
    PG_TRY (widen (m, q->n < chunk ? q->n : chunk));
    for (size_t first = 0; first < q->n; first += chunk) {
        size_t n = q->n - first < chunk ? q->n - first : chunk;
        const double *x = q->x + first * (size_t) m->dim;
        PG_TRY (value->sample (value->context, n, x, m->v, m->stress ? m->s : NULL));
        PG_TRY (reference->sample (reference->context, n, x, m->w, m->stress ? m->t : NULL));
        add_chunk (m, q, first, n);
    }
done:
    return status;
}

/* Computes the norms from the sums of squares. */
static void finish (measuring *m)
{
    pg_norms *out = m->out;
    out->displacement = m->u != 0 && out->places, out->stress = m->stress && out->places;
    out->l2.difference = sqrt (m->sum[0]), out->l2.reference = sqrt (m->sum[1]);
    out->energy.difference = sqrt (m->sum[2]), out->energy.reference = sqrt (m->sum[3]);
    out->maximum.reference = m->top_u, out->stress_maximum.reference = m->top_s;
    close_norm (&out->l2), close_norm (&out->maximum), close_norm (&out->energy),
        close_norm (&out->stress_maximum);
}

pg_status pg_norms_measure (pg_norms *out, const pg_quadrature *q, const pg_sampler *value,
                            const pg_sampler *reference, const pg_norm_options *options)
{
    pg_status status = PG_OK;
    measuring m = { .options = options, .out = out };
    size_t laws = 1;
    for (size_t i = 0; options->which && i < q->n; i++)
        if ((size_t) options->which[i] >= laws) laws = (size_t) options->which[i] + 1;
    PG_TRY (prepare (&m, laws, value, reference));
    PG_TRY (add_places (&m, q, CHUNK, value, reference));
    finish (&m);
done:
    pg_free (m.L), pg_free (m.v);
    return status;
}

/* Finds the material of every quadrature point: that of the nearest evaluation point. */
static void find_materials (const pg_problem *p, const pg_nearest *near, const pg_quadrature *q, int *which)
{
    int bulk = p->form.integration->at_nodes ? PG_NODES : PG_POINTS;
    for (size_t i = 0; i < q->n; i++)
        which[i] = p->at.law_of[bulk][pg_nearest_find (near, q->x + i * (size_t) p->dim, NULL, NULL)];
}

/* Creates the search for the material at a point; NULL where there is one material only. */
static pg_status search_materials (pg_nearest **out, const pg_problem *p)
{
    int bulk = p->form.integration->at_nodes ? PG_NODES : PG_POINTS;
    if (p->at.nlaw < 2) return PG_OK;
    return pg_nearest_create (out, p->dim, p->bonds.rows[bulk].n, p->bonds.rows[bulk].x);
}

/* Takes the cells in parts, since the quadrature points of a large body would take more memory than anything
 * else. */
pg_status pg_norms_of_cells (pg_norms *out, const pg_problem *p, int order, const pg_expression *where,
                             const pg_sampler *value, const pg_sampler *reference)
{
    pg_status status = PG_OK;
    pg_norm_options options = { p->at.law, NULL, where };
    measuring m = { .options = &options, .out = out };
    pg_nearest *near = NULL;
    pg_quadrature q = { 0 };
    int *which = NULL;
    size_t few = PLACES, part = p->cells.n / PARTS + 1;
    for (int k = 0; k < p->dim; k++) few /= (size_t) order;
    part = part > few ? part : few + 1;
    PG_TRY (prepare (&m, p->at.nlaw < 2 ? 1 : p->at.nlaw, value, reference));
    PG_TRY (search_materials (&near, p));
    for (size_t first = 0; first < p->cells.n; first += part) {
        size_t last = first + part < p->cells.n ? first + part : p->cells.n;
        PG_TRY (pg_cell_points_of (&q, &p->cells, p->cloud.thickness, order, first, last));
        if (near) {
            PG_ALLOC (which, q.n);
            find_materials (p, near, &q, which);
        }
        options.which = which;
        PG_TRY (add_places (&m, &q, q.n, value, reference));
        pg_quadrature_clear (&q), pg_free (which), which = NULL;
    }
    finish (&m);
done:
    pg_quadrature_clear (&q), pg_nearest_free (&near);
    pg_free (m.L), pg_free (m.v), pg_free (which);
    return status;
}

/* ---- tables -------------------------------------------------------------------------------------------- */
/* Norms of column k of a table over its rows, unweighted. Rows with a reference near zero
 * (below 1e-3 of the largest) have no meaningful relative error and count in the other norms
 * only. */
static void measure_column (pg_line_norms *out, const pg_line *line, size_t k, const double *u,
                            const double *s)
{
    double sum = 0, ref = 0, top = 0, worst = 0;
    size_t dim = (size_t) line->dim;
    *out = (pg_line_norms) { .column = line->column[k] };
    snprintf (out->file, sizeof out->file, "%s", line->name);
    for (size_t i = 0; i < line->n; i++) {
        double r = line->value[i * line->ncolumn + k];
        if (isfinite (r)) top = fmax (top, fabs (r));
    }
    for (size_t i = 0; i < line->n; i++) {
        double r = line->value[i * line->ncolumn + k],
               v = out->column < 3 ? u[3 * i + (size_t) out->column] : s[6 * i + (size_t) out->column - 3];
        if (!isfinite (r) || !isfinite (v)) {
            out->missed++;
            continue;
        }
        double d = fabs (v - r);
        out->rows++, sum += d * d, ref += r * r;
        largest (&out->maximum, d, line->dim, line->x + i * dim);
        if (fabs (r) > 1e-3 * top && d > worst * fabs (r)) {
            worst = d / fabs (r);
            memset (out->place, 0, sizeof out->place);
            memcpy (out->place, line->x + i * dim, dim * sizeof *line->x);
        }
    }
    out->pointwise = worst, out->maximum.reference = top;
    out->l2.difference = sqrt (sum), out->l2.reference = sqrt (ref);
    close_norm (&out->l2), close_norm (&out->maximum);
}

/* Measures all columns of a table, which share one sampling of its rows. */
pg_status pg_line_measure (pg_line_norms *out, const pg_line *line, const pg_sampler *value)
{
    pg_status status = PG_OK;
    double *u = NULL, *s = NULL;
    if (value->dim != line->dim)
        PG_FAIL (PG_E_USAGE, "%s: a table of a %dD body is compared with a %dD result", line->name, line->dim,
                 value->dim);
    PG_ALLOC (u, 3 * line->n);
    PG_ALLOC (s, 6 * line->n);
    PG_TRY (pg_line_sample (line, value, u, s));
    for (size_t k = 0; k < line->ncolumn; k++) measure_column (&out[k], line, k, u, s);
done:
    pg_free (u), pg_free (s);
    return status;
}

pg_status pg_compare_materials (const pg_problem *p, const pg_quadrature *q, int **which)
{
    pg_status status = PG_OK;
    pg_nearest *near = NULL;
    PG_TRY (search_materials (&near, p));
    if (!near) return PG_OK;
    PG_ALLOC (*which, q->n);
    find_materials (p, near, q, *which);
done:
    pg_nearest_free (&near);
    return status;
}
