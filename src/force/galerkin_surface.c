/* SPDX-License-Identifier: GPL-3.0-or-later
 * What a uniform stress does on the points of PG_FACETS: P = sum w N sigma n. */
#include "galerkin.h"

/* Components that a support on points bears are left out (pg_patch_probe). */
pg_status galerkin_surface (void *self, const double *stress, double *P)
{
    galerkin *g = self;
    const pg_rows *r = &g->rows[PG_FACETS];
    size_t dim = (size_t) g->dim;
    for (size_t q = 0; q < r->n; q++) {
        const double *n = g->problem->facet_normal + q * dim;
        double t[3] = { 0 };
        for (size_t k = 0; k < dim; k++)
            for (size_t c = 0; c < dim && !(g->problem->borne && g->problem->borne[r->cell[q]] >> k & 1); c++)
                t[k] += stress[pg_voigt_at (g->dim, (int) k, (int) c)] * n[c] * r->weight[q];
        for (size_t e = r->family.start[q]; e < r->family.start[q + 1]; e++)
            for (size_t k = 0; k < dim; k++) P[(size_t) r->family.node[e] * dim + k] += r->N[e] * t[k];
    }
    return PG_OK;
}
