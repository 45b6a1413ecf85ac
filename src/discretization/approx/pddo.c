/* SPDX-License-Identifier: GPL-3.0-or-later
 * The peridynamic differential operator (Madenci, Barut and Dorduncu 2019; Cui 2022, equations
 * (11) and (12); doc/method.md E1):
 *
 *   N_j = e_0' A^-1 p_j w_j V_j,     dN_j / dx_k = (1/a) e_k' A^-1 p_j w_j V_j.
 *
 * N is that of a moving least squares fit; dN differentiates the fitted polynomial, not the
 * fit, so it is not the gradient of N (doc/method.md E4 has the consequences). */
#include "entries.h"
#include "moment.h"

/* Row 0 of A^-1 gives N, the rows of the linear functions give the derivatives. */
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
    return pg_moment_evaluate (&formula, a, cloud, rows, alive, count, list, threads);
}

const pg_approx_type pg_approx_pddo = {
    .name = "pddo",
    .summary = "peridynamic differential operator: derivatives by weighted least squares",
    .use_volume = 1,
    .tip = { .linear = 0.26, .quadratic = 0.29, .nodal = 1.1 },
    .evaluate = evaluate
};
