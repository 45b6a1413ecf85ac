/* SPDX-License-Identifier: GPL-3.0-or-later
 * direct.h: bodies whose bonds carry the force themselves, built by hand for tests: cloud of a lattice of
 * points, bonds of the sums, plain stiffness matrix with some dofs held, equilibrium and lowest frequency by
 * factorisation. */
#ifndef PERIGAL_TEST_DIRECT_H
#define PERIGAL_TEST_DIRECT_H
#include "check.h"
#include "perigal/sums.h"
#include "perigal/linalg.h"

typedef struct {
    pg_scene  *scene;
    pg_body    body;
    pg_lattice lattice;
    pg_cloud   cloud;
    pg_sums   *sums;
    pg_family  family;
    double     c;                                      /* c_h, N/m^6 */
    size_t     n, bonds;                               /* points; bonds of the whole family of one */
    unsigned char *held;                               /* per dof: does not move */
    pg_sparse  K;                                      /* upper triangle; held dofs: identity */
} direct;

/* The body of a scene's text; E (Pa); plane stress. In place: the sums keep the address of the cloud. */
static inline void direct_build (direct *b, const char *text, const char *kernel, double horizon, double E,
                                 int calibrate, pg_partial partial)
{
    *b = (direct) { 0 };
    check_ok (pg_scene_parse (&b->scene, text, "test.yaml"));
    check_ok (pg_body_read (&b->body, b->scene));
    check_ok (pg_cloud_build (&b->cloud, &b->lattice, &b->body, b->scene));
    pg_sum_rule rule = { .mode = PG_PLANE_STRESS,
                         .kernel = pg_kernel_find (kernel),
                         .horizon = horizon,
                         .partial = partial,
                         .surface = PG_SURFACE_NONE,
                         .calibrate = calibrate };
    check_ok (pg_sums_create (&b->sums, &rule, &b->cloud, &b->lattice));
    check_ok (pg_sums_family (&b->family, b->sums, NULL));
    b->n = b->cloud.n;
    b->bonds = b->sums->stencil.n;
    b->c = b->sums->calibration * pg_bond_modulus (rule.mode, rule.kernel, horizon, E, b->cloud.thickness);
    b->held = pg_calloc (2 * b->n, 1);
    assert_true (b->held != NULL);
}

static inline void direct_clear (direct *b)
{
    pg_sparse_clear (&b->K);
    pg_family_clear (&b->family);
    pg_sums_free (&b->sums);
    pg_cloud_clear (&b->cloud);
    pg_lattice_clear (&b->lattice);
    pg_body_clear (&b->body);
    pg_scene_free (&b->scene);
    pg_free (b->held);
}

/* The point at a place (to a tenth of a spacing). */
static inline size_t direct_point (const direct *b, double x, double y)
{
    for (size_t i = 0; i < b->n; i++)
        if (hypot (b->cloud.x[2*i] - x, b->cloud.x[2*i + 1] - y) < 0.1 * b->cloud.h) return i;
    fail_msg ("no point at (%g, %g)", x, y);
    return 0;
}

/* Stiffness c w / r e e' V_i V_j of the bonds of point i (N/m), 2 x 2 each. */
static inline void direct_blocks (const direct *b, size_t i, double *block, double *xi, double *weight)
{
    size_t first = b->family.start[i], m = b->family.start[i + 1] - first;
    pg_sums_bonds (b->sums, &b->family, i, xi, weight, NULL);
    for (size_t k = 0; k < m; k++) {
        const double *e = xi + 2*k;
        size_t j = (size_t) b->family.node[first + k];
        double r2 = e[0] * e[0] + e[1] * e[1],
               s = b->c * weight[k] * b->cloud.volume[i] * b->cloud.volume[j] / (r2 * sqrt (r2));
        for (int a = 0; a < 4; a++) block[4*k + (size_t) a] = s * e[a / 2] * e[a % 2];
    }
}

/* Entry (row, column) of one block; held dofs leave the identity. */
static inline void direct_enter (direct *b, size_t *nnz, size_t row, size_t column, double value)
{
    if (row > column) return;
    b->K.row[*nnz] = (long) row;
    b->K.value[(*nnz)++] = b->held[row] || b->held[column] ? row == column : value;
}

static inline void direct_assemble (direct *b)
{
    size_t most = 0, nnz = 0, all = b->family.start[b->n];
    for (size_t i = 0; i < b->n; i++)
        most = b->family.start[i + 1] - b->family.start[i] > most
                   ? b->family.start[i + 1] - b->family.start[i]
                   : most;
    double *xi = pg_calloc (2 * most, sizeof *xi), *weight = pg_calloc (most, sizeof *weight),
           *block = pg_calloc (4 * most, sizeof *block);
    check_ok (pg_sparse_create (&b->K, 2 * b->n, 2 * b->n, 2 * all + 3 * b->n, 1));
    for (size_t i = 0; i < b->n; i++) {
        size_t first = b->family.start[i], m = b->family.start[i + 1] - first;
        double own[4] = { 0 };
        direct_blocks (b, i, block, xi, weight);
        for (size_t k = 0; k < m; k++) for (int a = 0; a < 4; a++) own[a] += block[4*k + (size_t) a];
        for (size_t l = 0; l < 2; l++) {
            for (size_t k = 0; k < m && (size_t) b->family.node[first + k] < i; k++)
                for (size_t a = 0; a < 2; a++)
                    direct_enter (b, &nnz, 2 * (size_t) b->family.node[first + k] + a, 2 * i + l,
                                  -block[4 * k + 2 * a + l]);
            for (size_t a = 0; a <= l; a++) direct_enter (b, &nnz, 2*i + a, 2*i + l, own[2*a + l]);
            b->K.start[2*i + l + 1] = (long) nnz;
        }
    }
    pg_free (xi), pg_free (weight), pg_free (block);
}

static inline void *direct_factor (const direct *b)
{
    const pg_linear_type *cholmod = pg_linear_find ("cholmod");
    const pg_linear_options options = { .block = 2, .dim = 2, .threads = 1 };
    void *self = NULL;
    check_ok (cholmod->analyse (&self, &b->K, &options));
    check_ok (cholmod->factor (self, &b->K));
    return self;
}

/* Lowest eigenfrequency (rad/s) of K x = omega^2 rho V x by inverse iteration. */
static inline double direct_lowest (const direct *b, void *factor, double density, int rounds)
{
    size_t n = 2 * b->n;
    double *x = pg_calloc (n, sizeof *x), *y = pg_calloc (n, sizeof *y), omega2 = 0;
    for (size_t i = 0; i < n; i++) x[i] = !b->held[i];
    for (int k = 0; k < rounds; k++) {
        double xMx = 0, xMy = 0;
        for (size_t i = 0; i < n; i++) xMx += density * b->cloud.volume[i / 2] * x[i] * x[i];
        for (size_t i = 0; i < n; i++) x[i] *= density * b->cloud.volume[i / 2];
        check_ok (pg_linear_find ("cholmod")->solve (factor, 1, x, y));
        for (size_t i = 0; i < n; i++) xMy += x[i] * y[i];
        omega2 = xMx / xMy;                            /* x M x / x M K^-1 M x, the quotient of K^-1 M */
        double size = sqrt (xMx);
        for (size_t i = 0; i < n; i++) x[i] = b->held[i] ? 0 : y[i] / size;
    }
    pg_free (x), pg_free (y);
    return sqrt (omega2);
}
#endif
