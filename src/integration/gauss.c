/* SPDX-License-Identifier: GPL-3.0-or-later
 * Gauss-Legendre points in background cells (multilinear map of the corners) and on boundary facets. */
#include "perigal/integration.h"
#include <math.h>
#include <string.h>

void pg_gauss_rule (int order, double *x, double *w)
{
    static const double X[5][5] = {
        { 0 }, { -0.57735026918962576451, 0.57735026918962576451 },
        { -0.77459666924148337704, 0, 0.77459666924148337704 },
        { -0.86113631159405257522, -0.33998104358485626480, 0.33998104358485626480, 0.86113631159405257522 },
        { -0.90617984593866399280, -0.53846931010568309104, 0, 0.53846931010568309104, 0.90617984593866399280 } };
    static const double W[5][5] = {
        { 2 }, { 1, 1 }, { 5.0 / 9, 8.0 / 9, 5.0 / 9 },
        { 0.34785484513745385737, 0.65214515486254614263, 0.65214515486254614263, 0.34785484513745385737 },
        { 0.23692688505618908751, 0.47862867049936646804, 128.0 / 225, 0.47862867049936646804, 0.23692688505618908751 } };
    order = order < 1 ? 1 : order > 5 ? 5 : order;
    memcpy (x, X[order - 1], (size_t) order * sizeof *x);
    memcpy (w, W[order - 1], (size_t) order * sizeof *w);
}

void pg_quadrature_clear (pg_quadrature *q)
{
    pg_free (q->x), pg_free (q->weight), pg_free (q->cell);
    memset (q, 0, sizeof *q);
}

/* Signs of corner c (Exodus order) along axis k of the reference cube. */
static double sign (int c, int k)
{
    static const int corner[8][3] = { { -1, -1, -1 }, { 1, -1, -1 }, { 1, 1, -1 }, { -1, 1, -1 },
                                      { -1, -1, 1 }, { 1, -1, 1 }, { 1, 1, 1 }, { -1, 1, 1 } };
    return corner[c][k];
}

/* x and the Jacobian J[axis][reference axis] of the multilinear map with 2^nref corners in dim-space. */
static void map_point (int dim, int nref, const double *corner, const double *xi, double *x, double J[3][3])
{
    int nc = 1 << nref;
    for (int a = 0; a < dim; a++) {
        x[a] = 0;
        for (int r = 0; r < 3; r++) J[a][r] = 0;
    }
    for (int c = 0; c < nc; c++) {
        double N = 1;
        for (int r = 0; r < nref; r++) N *= (1 + sign (c, r) * xi[r]) / 2;
        for (int a = 0; a < dim; a++) x[a] += N * corner[c * dim + a];
        for (int r = 0; r < nref; r++) {
            double D = sign (c, r) / 2;
            for (int o = 0; o < nref; o++) if (o != r) D *= (1 + sign (c, o) * xi[o]) / 2;
            for (int a = 0; a < dim; a++) J[a][r] += D * corner[c * dim + a];
        }
    }
}

/* Size of the image of the reference element: length, area or volume factor. */
static double measure (int dim, int nref, double J[3][3])
{
    if (nref == 0) return 1;
    if (nref == 1) {
        double s = 0;
        for (int a = 0; a < dim; a++) s += J[a][0] * J[a][0];
        return sqrt (s);
    }
    if (nref == 2 && dim == 2) return fabs (J[0][0] * J[1][1] - J[0][1] * J[1][0]);
    double n[3] = { J[1][0] * J[2][1] - J[2][0] * J[1][1], J[2][0] * J[0][1] - J[0][0] * J[2][1], J[0][0] * J[1][1] - J[1][0] * J[0][1] };
    if (nref == 2) return sqrt (n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    return fabs (n[0] * J[0][2] + n[1] * J[1][2] + n[2] * J[2][2]);
}

/* order^nref points in each of n elements with 2^nref corners; scale multiplies the weights. */
static pg_status fill (pg_quadrature *out, int dim, int nref, size_t n, const double *corners, const double *scale, double factor, int order)
{
    pg_status status = PG_OK;
    double gx[5], gw[5], J[3][3];
    size_t per = 1, nc = (size_t) 1 << nref;
    for (int r = 0; r < nref; r++) per *= (size_t) order;
    memset (out, 0, sizeof *out);
    PG_ALLOC (out->x, n * per * (size_t) dim);
    PG_ALLOC (out->weight, n * per);
    PG_ALLOC (out->cell, n * per);
    out->n = n * per;
    pg_gauss_rule (order, gx, gw);
    for (size_t e = 0; e < n; e++)
        for (size_t k = 0; k < per; k++) {
            double xi[3] = { 0, 0, 0 }, w = 1;
            size_t rest = k;
            for (int r = 0; r < nref; r++, rest /= (size_t) order) xi[r] = gx[rest % (size_t) order], w *= gw[rest % (size_t) order];
            size_t q = e * per + k;
            map_point (dim, nref, corners + e * nc * (size_t) dim, xi, out->x + q * (size_t) dim, J);
            out->weight[q] = w * measure (dim, nref, J) * factor;
            if (nref == 0) out->weight[q] = scale[e];
            out->cell[q] = (int) e;
        }
done:
    if (status != PG_OK) pg_quadrature_clear (out);
    return status;
}

static pg_status gauss_points (pg_quadrature *out, const pg_cells *cells, double thickness, int order)
{
    return fill (out, cells->dim, cells->dim, cells->n, cells->x, NULL, cells->dim == 3 ? 1 : thickness, order);
}

pg_status pg_facet_points (pg_quadrature *out, const pg_cells *cells, int order)
{
    pg_status status = fill (out, cells->dim, cells->dim - 1, cells->nfacet, cells->facet_x, cells->area, 1, order);
    if (status != PG_OK || cells->nfacet == 0) return status;
    size_t per = out->n / cells->nfacet;
    for (size_t f = 0; f < cells->nfacet; f++) {       /* the facet's own area carries the thickness                     */
        double sum = 0;
        for (size_t k = 0; k < per; k++) sum += out->weight[f * per + k];
        for (size_t k = 0; k < per; k++) out->weight[f * per + k] *= cells->area[f] / sum;
    }
    return PG_OK;
}

const pg_integration_type pg_integration_gauss = { "gauss", "Gauss-Legendre points in background cells", 0, gauss_points };
