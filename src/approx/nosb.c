/* SPDX-License-Identifier: GPL-3.0-or-later
 * Non-ordinary state-based derivative at a node: dN_j = w_j V_j K xi_ij, K = (sum w V xi xi')^-1, own node
 * -sum; N is 1 at the own node (theory D1). Quadratic: the same with the basis z_k, z_k z_l. At a point that
 * is no node there is no own value to expand about: the basis gains the 1, which is the peridynamic
 * differential operator. */
#include "entries.h"
#include "moment.h"

static void fill (const pg_neighbourhood *s, double *N, double *dN)
{
    size_t dim = (size_t) s->dim;
    pg_neighbourhood_differential (s, dN);
    if (s->constant) {
        double b[PG_BASIS_MAX];
        pg_neighbourhood_solve (s, 0, b);
        pg_neighbourhood_shape (s, b, N);
        return;
    }
    N[s->own] = 1;
    for (size_t k = 0; k < dim; k++) {
        double sum = 0;
        for (size_t j = 0; j < s->n; j++) sum += dN[s->entry[j] * dim + k];
        dN[s->own * dim + k] = -sum;
    }
}

static const pg_formula formula = { .about_node = 1, .fill = fill };

static pg_status evaluate (const pg_approx *a, const pg_cloud *cloud, pg_rows *rows,
                           const unsigned char *alive, size_t count, const size_t *list, int threads)
{
    return pg_moment_sweep (&formula, a, cloud, rows, alive, count, list, threads);
}

const pg_approx_type pg_approx_nosb = {
    .name = "nosb",
    .summary = "non-ordinary state-based: deformation gradient at nodes from the shape tensor",
    .use_volume = 1,
    .interpolates = 1,
    .tip = { .linear = 0.26, .quadratic = 0.29, .nodal = 0.45 },
    .evaluate = evaluate
};
