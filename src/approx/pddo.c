/* SPDX-License-Identifier: GPL-3.0-or-later
 * Peridynamic differential operator: N_j = e_0' A^-1 p_j w_j V_j, dN_j/dx_k = (1/a) e_k' A^-1 p_j w_j V_j.
 * Cui 2022 eqs (11)-(12), theory E1. */
#include "entries.h"
#include "moment.h"

static void fill (const pg_neighbourhood *s, double *N, double *dN)
{
    double b[PG_BASIS_MAX];
    pg_neighbourhood_solve (s, 0, b);
    pg_neighbourhood_shape (s, b, N);
    pg_neighbourhood_differential (s, dN);
}

static const pg_formula formula = { .about_node = 0, .fill = fill };

static pg_status evaluate (const pg_approx *a, const pg_cloud *cloud, pg_rows *rows,
                           const unsigned char *alive, size_t count, const size_t *list, int threads)
{
    return pg_moment_sweep (&formula, a, cloud, rows, alive, count, list, threads);
}

const pg_approx_type pg_approx_pddo = {
    .name = "pddo",
    .summary = "peridynamic differential operator: derivatives by weighted least squares",
    .use_volume = 1,
    .tip = { .linear = 0.26, .quadratic = 0.29, .nodal = 1.1 },
    .evaluate = evaluate
};
