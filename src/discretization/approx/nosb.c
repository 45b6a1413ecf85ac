/* SPDX-License-Identifier: GPL-3.0-or-later
 * The derivative of non-ordinary state-based peridynamics at a node (Cui 2022, equations (4)
 * and (5); doc/method.md D1):
 *
 *   dN_j = w_j V_j K xi_ij,   K = (sum_j w_j V_j xi_ij xi_ij')^-1,   own node: minus the sum of the others
 *
 * and N is 1 at the node itself. With the quadratic basis the same holds with z_k and z_k z_l
 * in place of xi. A place that is no node has no value of its own to expand about: there the
 * basis gains the constant, which makes it the peridynamic differential operator (pddo.c). */
#include "entries.h"
#include "moment.h"

/* The derivative of the own node is minus the sum of the others, so that a constant field has no gradient. */
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
    return pg_moment_evaluate (&formula, a, cloud, rows, alive, count, list, threads);
}

const pg_approx_type pg_approx_nosb = {
    .name = "nosb",
    .summary = "non-ordinary state-based: deformation gradient at nodes from the shape tensor",
    .use_volume = 1,
    .interpolates = 1,
    .tip = { .linear = 0.26, .quadratic = 0.29, .nodal = 0.45 },
    .evaluate = evaluate
};
