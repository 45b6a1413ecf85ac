/* SPDX-License-Identifier: GPL-3.0-or-later
 * Nodal forces of a uniform stress on the facet points (PG_FACETS), P = sum w N sigma n, and of a pressure
 * in cracks. */
#include "galerkin.h"
#include <string.h>

/* P += nodal forces of a uniform stress on the surface, N. Components carried by a support on points are
 * omitted (pg_patch_probe). */
pg_status galerkin_surface (void *self, const double *stress, double *P)
{
    galerkin *g = self;
    const pg_rows *r = &g->rows[PG_FACETS];
    size_t dim = (size_t) g->dim;
    for (size_t q = 0; q < r->n; q++) {
        const double *n = g->problem->bonds.facet_normal + q * dim;
        double t[3] = { 0 };
        for (size_t k = 0; k < dim; k++)
            for (size_t c = 0;
                 c < dim && !(g->problem->quality.borne && g->problem->quality.borne[r->cell[q]] >> k & 1);
                 c++)
                t[k] += stress[pg_voigt_at (g->dim, (int) k, (int) c)] * n[c] * r->weight[q];
        for (size_t e = r->family.start[q]; e < r->family.start[q + 1]; e++)
            for (size_t k = 0; k < dim; k++) P[(size_t) r->family.node[e] * dim + k] += r->N[e] * t[k];
    }
    return PG_OK;
}

/* P += nodal forces of a uniform pressure, `factor` Pa, on all faces of cracks. It does the work p V, V being
 * the volume enclosed by the faces. With the outward normal n of the body, which on faces points into the
 * crack, the divergence theorem gives
 * 
 *     V = - int_faces u.n dA = int_surface u.n dA - int_body div u dV,
 * 
 * so that the nodal forces follow from the surface without the cracks and from the body, whatever cracks
 * there are: a shape function that ends at a face jumps there. New faces are loaded as they form, and without
 * a crack the sum is zero as far as the quadrature is consistent. */
void galerkin_crack_pressure (galerkin *g, double factor, double *P)
{
    const pg_rows *r = &g->sums;
    size_t dim = (size_t) g->dim;
    double stress[6] = { 0 };
    for (size_t k = 0; k < dim; k++) stress[pg_voigt_at (g->dim, (int) k, (int) k)] = factor;
    galerkin_surface (g, stress, P);
    for (size_t q = 0; q < r->n; q++)
        for (size_t e = r->family.start[q]; e < r->family.start[q + 1]; e++)
            for (size_t k = 0; k < dim; k++)
                P[(size_t) r->family.node[e] * dim + k]
                    -= factor * r->weight[q] * r->dN[(e + pg_rows_offset (r, q)) * dim + k];
}

double galerkin_crack_volume (galerkin *g, const double *d)
{
    size_t ndof = g->n * (size_t) g->dim;
    double sum = 0;
    memset (g->work, 0, ndof * sizeof *g->work);
    galerkin_crack_pressure (g, 1, g->work);
    for (size_t i = 0; i < ndof; i++) sum += g->work[i] * d[i];
    return sum;
}
