/* SPDX-License-Identifier: GPL-3.0-or-later
 * Gauss points in background cells and on boundary facets. Whole cells and facets use the rule of their
 * element on the reference element; cut ones the quadrature of cells (pg_cut_cell, pg_cut_facet), whose
 * weights are scaled so that they sum to the exact volume or area at any order. */
#include "perigal/integration.h"
#include <math.h>
#include <string.h>

void pg_quadrature_clear (pg_quadrature *q)
{
    pg_free (q->x), pg_free (q->weight), pg_free (q->normal), pg_free (q->cell);
    memset (q, 0, sizeof *q);
}

/* ---- cells and facets ---------------------------------------------------------------------------------- */
/* The cells, or the facets, to be integrated over, in a common form. */
typedef struct {
    const pg_cells *cells;
    /* facets: 1: facets are integrated, 0: cells. order: Gauss points per direction. */
    int    dim, facets, order;
    /* The first of the cells or facets, and the one behind the last. */
    size_t from, to;
    /* Kinds, first nodes and nodes as in pg_cells. */
    const unsigned char *kind;  const size_t *start;  const double *x;
    /* Number of cut cells or facets, and of those already written; the k-th has the points first[k] ..
     * first[k + 1] - 1 of `cut`. */
    size_t ncut, next;  size_t *first;
    /* Points of all cut cells or facets. */
    pg_cut_points cut;
} mesh;

/* Finds the points of cut cells or facets: only afterwards is their number known. */
static pg_status find_cut (mesh *m)
{
    pg_status status = PG_OK;
    for (size_t e = m->from; e < m->to; e++) m->ncut += m->kind[e] == PG_CUT;
    PG_ALLOC (m->first, m->ncut + 1);
    for (size_t e = m->from, k = 0; e < m->to; e++) {
        if (m->kind[e] != PG_CUT) continue;
        PG_TRY (m->facets ? pg_cut_facet (&m->cut, m->cells, e, m->order)
                          : pg_cut_cell (&m->cut, m->cells, e, m->order));
        m->first[++k] = m->cut.n;
    }
done:
    return status;
}

/* Counts all points and allocates the arrays. */
static pg_status reserve (pg_quadrature *out, const mesh *m)
{
    pg_status status = PG_OK;
    size_t n = m->cut.n, dim = (size_t) m->dim;
    double xi[3 * PG_ELEMENT_POINTS], w[PG_ELEMENT_POINTS];
    int points[PG_ELEMENTS] = { 0 };
    for (size_t e = m->from; e < m->to; e++) {
        int kind = m->kind[e];
        if (kind == PG_CUT) continue;
        if (!points[kind]) points[kind] = pg_element_rule ((pg_element) kind, m->order, xi, w);
        n += (size_t) points[kind];
    }
    PG_ALLOC (out->x, n * dim);
    PG_ALLOC (out->weight, n);
    PG_ALLOC (out->cell, n);
    if (m->facets) PG_ALLOC (out->normal, n * dim);
done:
    return status;
}

/* The quadrature rule of a kind of element: n weights, and at its points the element's shape functions N
 * (PG_ELEMENT_NODES a point) and their derivatives dN (three times as many). */
typedef struct { int kind, n; double w[PG_ELEMENT_POINTS], *N, *dN; } rule;

/* Fills the rule for elements of another kind. */
static void choose_rule (rule *r, int kind, int order)
{
    double xi[3 * PG_ELEMENT_POINTS];
    int d = pg_element_types[kind].dim;
    r->kind = kind, r->n = pg_element_rule ((pg_element) kind, order, xi, r->w);
    for (int k = 0; k < r->n; k++)
        pg_element_shape ((pg_element) kind, xi + k * d, r->N + k * PG_ELEMENT_NODES,
                          r->dN + k * 3 * PG_ELEMENT_NODES);
}

/* Appends the points of the rule, mapped to element e; factor multiplies the weights. */
static void add (pg_quadrature *out, const mesh *m, size_t e, const rule *r, double factor)
{
    size_t dim = (size_t) m->dim;
    pg_element kind = (pg_element) m->kind[e];
    const double *corner = m->x + m->start[e] * dim;
    for (int k = 0; k < r->n; k++, out->n++) {
        double *normal = m->facets ? out->normal + out->n * dim : NULL;
        double size = pg_element_map_by (kind, m->dim, corner, r->N + k * PG_ELEMENT_NODES,
                                         r->dN + k * 3 * PG_ELEMENT_NODES, out->x + out->n * dim, normal);
        out->weight[out->n] = r->w[k] * fabs (size) * factor;
        out->cell[out->n] = (int) e;
    }
}

/* Appends the points of cut element e. Scaling by size / sum makes the weights sum to the exact volume at any
 * order. */
static void add_cut (pg_quadrature *out, mesh *m, size_t e)
{
    size_t dim = (size_t) m->dim, from = m->first[m->next++], n = m->first[m->next] - from;
    double sum = 0, size = m->facets ? m->cells->area[e] : m->cells->volume[e];
    if (n == 0) return;
    for (size_t k = 0; k < n; k++) sum += m->cut.weight[from + k];
    for (size_t k = 0; k < n; k++) {
        out->weight[out->n + k] = m->cut.weight[from + k] * (size / sum);
        out->cell[out->n + k] = (int) e;
    }
    memcpy (out->x + out->n * dim, m->cut.x + from * dim, n * dim * sizeof *out->x);
    if (m->facets)
        memcpy (out->normal + out->n * dim, m->cut.normal + from * dim, n * dim * sizeof *out->normal);
    out->n += n;
}

/* Appends the points of all elements in order. The rule is looked up again only where the kind changes. */
static pg_status fill (pg_quadrature *out, mesh *m, double factor)
{
    pg_status status = PG_OK;
    rule r = { .kind = -1 };
    memset (out, 0, sizeof *out);
    PG_ALLOC (r.N, 4 * PG_ELEMENT_POINTS * PG_ELEMENT_NODES);
    r.dN = r.N + PG_ELEMENT_POINTS * PG_ELEMENT_NODES;
    PG_TRY (find_cut (m));
    PG_TRY (reserve (out, m));
    for (size_t e = m->from; e < m->to; e++) {
        if (m->kind[e] == PG_CUT) add_cut (out, m, e);
        else {
            if (m->kind[e] != r.kind) choose_rule (&r, m->kind[e], m->order);
            add (out, m, e, &r, factor);
        }
    }
done:
    pg_free (r.N);
    pg_free (m->first);
    pg_cut_points_clear (&m->cut);
    if (status != PG_OK) pg_quadrature_clear (out);
    return status;
}

pg_status pg_cell_points_of (pg_quadrature *out, const pg_cells *c, double thickness, int order, size_t first,
                             size_t last)
{
    mesh m = {
        .cells = c, .dim = c->dim, .order = order, .from = first, .to = last, .kind = c->kind,
        .start = c->start, .x = c->x
    };
    return fill (out, &m, c->dim == 3 ? 1 : thickness);
}

pg_status pg_cell_points (pg_quadrature *out, const pg_cells *c, double thickness, int order)
{
    return pg_cell_points_of (out, c, thickness, order, 0, c->n);
}

/* Replaces the normal of a point by the mean normal of its facet where both agree to 1e-14: a flat facet
 * has one normal, the same in every bit at all its points. */
static void flatten (double *normal, const double *mean, size_t dim)
{
    double cosine = 0, size = 0;
    for (size_t k = 0; k < dim; k++) cosine += normal[k] * mean[k], size += normal[k] * normal[k];
    if (dim == 1 || !(size > 0) || fabs (cosine - 1) < 1e-14) memcpy (normal, mean, dim * sizeof *normal);
}

/* Weights of whole facets are scaled to the stored area, which has the thickness already. */
pg_status pg_facet_points (pg_quadrature *out, const pg_cells *c, int order)
{
    mesh m = { .cells = c,
               .dim = c->dim,
               .facets = 1,
               .order = order,
               .to = c->nfacet,
               .kind = c->facet_kind,
               .start = c->facet_start,
               .x = c->facet_x };
    size_t dim = (size_t) c->dim;
    pg_status status = fill (out, &m, 1);
    for (size_t q = 0, end = 0; q < out->n; q = end) {
        int f = out->cell[q];
        /* The weights are scaled to the area of the facet, which has the thickness already. */
        double sum = 0;
        for (end = q; end < out->n && out->cell[end] == f; end++) sum += out->weight[end];
        for (size_t k = q; k < end; k++) {
            if (c->facet_kind[f] == PG_CUT) continue;
            out->weight[k] *= c->area[f] / sum;
            flatten (out->normal + k * dim, c->normal + (size_t) f * dim, dim);
        }
    }
    return status;
}

const pg_integration_type pg_integration_gauss = { "gauss", "Gauss-Legendre points in background cells", 0, 0,
                                                   pg_cell_points };
