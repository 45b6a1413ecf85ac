/* SPDX-License-Identifier: GPL-3.0-or-later
 * lattice.h: small clouds for the tests of approximations, points moved at random, volumes of their own. */
#ifndef PERIGAL_TEST_LATTICE_H
#define PERIGAL_TEST_LATTICE_H
#include "check.h"
#include "perigal/approx.h"

static unsigned long long lattice_seed = 2024;
static inline double rnd (void)                        /* in (-1, 1) */
{
    lattice_seed = lattice_seed * 6364136223846793005ull + 1442695040888963407ull;
    return (double) (lattice_seed >> 11) / 4503599627370496.0 - 1;
}

static inline size_t power (size_t base, int exponent)
{
    size_t p = 1;
    while (exponent-- > 0) p *= base;
    return p;
}

/* per_axis^dim nodes h apart from the origin on, moved by up to amount * h; volumes h^dim (1 + 0.3 amount *
 * random). */
static inline pg_cloud lattice (int dim, size_t per_axis, double h, double amount)
{
    pg_cloud c = { .dim = dim, .n = power (per_axis, dim), .h = h, .step = { h, h, h }, .thickness = 1 };
    c.x = pg_calloc (c.n * (size_t) dim, sizeof *c.x);
    c.volume = pg_calloc (c.n, sizeof *c.volume);
    c.block = pg_calloc (c.n, sizeof *c.block);
    for (size_t i = 0; i < c.n; i++) {
        size_t rest = i;
        for (int k = 0; k < dim; k++, rest /= per_axis)
            c.x[i * (size_t) dim + (size_t) k] = h * ((double) (rest % per_axis) + amount * rnd ());
        c.volume[i] = pow (h, dim) * (1 + 0.3 * (amount > 0) * rnd ());
    }
    return c;
}

static inline void lattice_clear (pg_cloud *c)
{
    pg_free (c->x);
    pg_free (c->volume);
    pg_free (c->block);
}

static inline pg_approx make (const char *type, const char *kernel, int order, int shape, double horizon)
{
    const pg_approx_type *t = pg_approx_find (type);
    return (pg_approx) { t, pg_kernel_find (kernel), order, shape, t->use_volume, horizon, 0, 0, 0, 0 };
}

/* Rows at n points, all evaluated with every bond alive. */
static inline pg_rows rows_at (const pg_approx *a, const pg_cloud *c, size_t n, const double *x,
                               const int *own)
{
    pg_rows rows;
    check_ok (pg_rows_create (&rows, a, c, n, x, NULL, own, NULL));
    check_ok (a->type->evaluate (a, c, &rows, NULL, n, NULL, 1));
    return rows;
}

/* Rows at all nodes */
static inline pg_rows rows_at_nodes (const pg_approx *a, const pg_cloud *c)
{
    int *own = pg_calloc (c->n, sizeof *own);
    for (size_t i = 0; i < c->n; i++) own[i] = (int) i;
    pg_rows rows = rows_at (a, c, c->n, c->x, own);
    pg_free (own);
    return rows;
}

/* Place of node j in row i, or (size_t) -1 */
static inline size_t place_of (const pg_rows *r, size_t i, int j)
{
    for (size_t e = r->family.start[i]; e < r->family.start[i + 1]; e++) if (r->family.node[e] == j) return e;
    return (size_t) -1;
}

static inline double N_of (const pg_rows *r, size_t i, int j)
{
    size_t e = place_of (r, i, j);
    return e == (size_t) -1 ? 0 : r->N[e];
}

static inline double dN_of (const pg_rows *r, size_t i, int j, int k)
{
    size_t e = place_of (r, i, j);
    return e == (size_t) -1 ? 0 : r->dN[e * (size_t) r->dim + (size_t) k];
}

/* The derivative at x is that of the shape functions, by differences over `step` both ways. */
static inline void check_derivative (const pg_approx *a, const pg_cloud *c, const double *x, double step)
{
    double y[3];
    pg_rows r = rows_at (a, c, 1, x, NULL);
    for (int k = 0; k < c->dim; k++) {
        memcpy (y, x, (size_t) c->dim * sizeof *y);
        y[k] = x[k] + step;
        pg_rows up = rows_at (a, c, 1, y, NULL);
        y[k] = x[k] - step;
        pg_rows down = rows_at (a, c, 1, y, NULL);
        for (int j = 0; j < (int) c->n; j++)
            check_absolute (dN_of (&r, 0, j, k), (N_of (&up, 0, j) - N_of (&down, 0, j)) / (2 * step), 1e-7);
        pg_rows_clear (&up);
        pg_rows_clear (&down);
    }
    pg_rows_clear (&r);
}
#endif
