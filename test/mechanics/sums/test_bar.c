/* SPDX-License-Identifier: GPL-3.0-or-later
 * A bar of plane stress drawn at its ends: what missing bonds at its sides cost, and what factors for the
 * surface make of it (theory A3). */
#include "check.h"
#include "perigal/sums.h"
#include <stdlib.h>

/* K (3 per bond): xx xy yy of c k beta g / r e x e V V */
typedef struct { pg_family family; size_t n; double *K; } matrix;

static void multiply (const matrix *A, const double *u, double *f)
{
    for (size_t i = 0; i < A->n; i++) {
        double sum[2] = {0, 0};
        for (size_t e = A->family.start[i]; e < A->family.start[i + 1]; e++) {
            const double *K = A->K + 3*e;
            size_t j = (size_t) A->family.node[e];
            double x = u[2*i] - u[2*j], y = u[2*i + 1] - u[2*j + 1];
            sum[0] += K[0] * x + K[1] * y, sum[1] += K[1] * x + K[2] * y;
        }
        f[2*i] = sum[0], f[2*i + 1] = sum[1];
    }
}

static double dot (size_t n, const double *a, const double *b)
{
    double sum = 0;
    for (size_t i = 0; i < n; i++) sum += a[i] * b[i];
    return sum;
}

/* Conjugate gradients; loads and displacements have no part of rigid motion. */
static void solve (const matrix *A, const double *b, double *u)
{
    size_t n = 2 * A->n;
    double *r = malloc (n * sizeof *r), *p = malloc (n * sizeof *p), *q = malloc (n * sizeof *q);
    memcpy (r, b, n * sizeof *r), memcpy (p, b, n * sizeof *p), memset (u, 0, n * sizeof *u);
    double rr = dot (n, r, r), end = 1e-20 * rr;
    for (int step = 0; rr > end; step++) {
        assert_true (step < 2000);
        multiply (A, p, q);
        double a = rr / dot (n, p, q), old = rr;
        for (size_t i = 0; i < n; i++) u[i] += a * p[i], r[i] -= a * q[i];
        rr = dot (n, r, r);
        for (size_t i = 0; i < n; i++) p[i] = r[i] + rr / old * p[i];
    }
    free (r), free (p), free (q);
}

static pg_sums *sums_of (pg_cloud *cloud, int nx, int ny, double m, pg_surface surface)
{
    pg_sum_rule rule = { .mode = PG_PLANE_STRESS,
                         .kernel = pg_kernel_find ("constant"),
                         .horizon = m,
                         .surface = surface,
                         .calibrate = 1 };
    pg_lattice lattice = {.dim = 2, .count = {nx, ny, 1}, .step = {1, 1, 1}};
    pg_sums *s;
    *cloud = (pg_cloud) {.dim = 2, .n = (size_t) nx * (size_t) ny, .h = 1, .step = {1, 1, 1}, .thickness = 1};
    cloud->x = malloc (2 * cloud->n * sizeof (double)), cloud->volume = malloc (cloud->n * sizeof (double));
    for (size_t i = 0; i < cloud->n; i++)
        cloud->x[2 * i] = (double) (i % (size_t) nx), cloud->x[2 * i + 1] = (double) (i / (size_t) nx),
                     cloud->volume[i] = 1;
    check_ok (pg_sums_create (&s, &rule, cloud, &lattice));
    return s;
}

static matrix assemble (const pg_sums *s, double c)
{
    matrix A = {.n = s->cloud->n};
    double xi[400], weight[200];
    check_ok (pg_sums_family (&A.family, s, NULL));
    A.K = malloc (3 * A.family.start[A.n] * sizeof *A.K);
    for (size_t i = 0; i < A.n; i++) {
        pg_sums_bonds (s, &A.family, i, xi, weight, NULL);
        for (size_t e = 0; e < A.family.start[i + 1] - A.family.start[i]; e++) {
            double *K = A.K + 3 * (A.family.start[i] + e), x = xi[2 * e], y = xi[2 * e + 1],
                   k = c * weight[e] / pow (x * x + y * y, 1.5);
            K[0] = k * x * x, K[1] = k * x * y, K[2] = k * y * y;
        }
    }
    return A;
}

/* Strains under stress 1 and E = 1: along, over the middle half; across, from side to side in the middle.
 * Elasticity: 1, -1/3 */
static void strains (int ny, double m, pg_surface surface, double *along, double *across)
{
    int nx = 4 * ny, a = nx / 4, b = nx - 1 - a;
    pg_cloud cloud;
    pg_sums *s = sums_of (&cloud, nx, ny, m, surface);
    matrix A = assemble (s, s->calibration * pg_bond_modulus (PG_PLANE_STRESS, s->rule.kernel, m, 1, 1));
    double *load = calloc (2 * A.n, sizeof *load), *u = malloc (2 * A.n * sizeof *u);
    for (int y = 0; y < ny; y++) load[2 * y * nx] = -1, load[2 * (y * nx + nx - 1)] = 1;
    solve (&A, load, u);
    *along = *across = 0;
    for (int y = 0; y < ny; y++) *along += (u[2 * (y * nx + b)] - u[2 * (y * nx + a)]) / (b - a) / ny;
    for (int x = nx / 2 - 1; x <= nx / 2; x++)
        *across += (u[2 * ((ny - 1) * nx + x) + 1] - u[2 * x + 1]) / (ny - 1) / 2;
    pg_family_clear (&A.family);
    pg_sums_free (&s);
    free (A.K), free (load), free (u), free (cloud.x), free (cloud.volume);
}

static void strains_of_a_bar_are_the_printed_ones (void **state)
{
    (void) state;
    static const struct { int ny; double m; pg_surface surface; double along, across;
    } rows[] = {
        { 20, 3.015, PG_SURFACE_NONE, 1.0063, -0.3360 },
        { 20, 3.015, PG_SURFACE_VOLUME, 0.9315, -0.3108 },
        { 20, 3.015, PG_SURFACE_PRODUCT, 0.9306, -0.3100 },
        { 20, 6, PG_SURFACE_NONE, 1.0969, -0.4273 },
        { 20, 6, PG_SURFACE_VOLUME, 0.9507, -0.3733 },
        { 20, 6, PG_SURFACE_PRODUCT, 0.9482, -0.3707 },
        { 40, 6, PG_SURFACE_NONE, 1.0555, 0 },
        { 40, 6, PG_SURFACE_VOLUME, 0.9828, 0 },
        { 40, 6, PG_SURFACE_PRODUCT, 0.9815, 0 },
    };
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        double along, across;
        strains (rows[k].ny, rows[k].m, rows[k].surface, &along, &across);
        check_absolute (along, rows[k].along, 1.5e-4);
        if (rows[k].across < 0) check_absolute (across, rows[k].across, 1.5e-4);
    }
}

int main (void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test (strains_of_a_bar_are_the_printed_ones) };
    return cmocka_run_group_tests_name ("surface of a bar", tests, NULL, NULL);
}
