/* SPDX-License-Identifier: GPL-3.0-or-later
 * Spacings that differ from point to point: consistency, exact derivatives, and equal spacings as if there
 * were none. */
#include "check.h"
#include "lattice.h"

static const size_t per_axis[4] = { 0, 14, 9, 6 };
static const double growth[4] = { 1, 1.25, 1.25, 1.3 };

/* Steps grow from h by a factor from one to the next, points moved at random; spacing: the longest step,
 * times 1 +- 0.15. */
static pg_cloud graded (int dim)
{
    pg_cloud c = lattice (dim, per_axis[dim], 1, 0);
    double g = growth[dim];
    c.size = pg_calloc (c.n, sizeof *c.size);
    for (size_t i = 0; i < c.n; i++) {
        double size = 0;
        for (int k = 0; k < dim; k++) {
            double *x = &c.x[i * (size_t) dim + (size_t) k], step = pow (g, *x);
            size = fmax (size, step);
            *x = (step - 1) / (g - 1) + 0.15 * step * rnd ();
        }
        c.size[i] = size * (1 + 0.15 * rnd ());
        c.volume[i] = pow (size, dim);
    }
    c.h = 1.7;                                         /* any: only ratios and horizon / h matter */
    return c;
}

static void graded_clear (pg_cloud *c)
{
    pg_free (c->size);
    lattice_clear (c);
}

static double extent (const pg_cloud *c)
{
    double top = 0;
    for (size_t i = 0; i < c->n * (size_t) c->dim; i++) top = fmax (top, c->x[i]);
    return top;
}

static double reach (int dim, int order) { return 1.7 * (order == 1 ? 2.7 : dim == 1 ? 4.5 : 3.4); }

/* Largest errors of 1, x_k (and x_k x_l), values and derivatives, over the largest value in the family and
 * its spacing. */
static void worst (const pg_cloud *c, const pg_rows *r, int order, double *value, double *slope)
{
    size_t dim = (size_t) c->dim;
    *value = *slope = 0;
    for (size_t i = 0; i < r->n; i++)
        for (int t = 0; t < 1 + c->dim + (order == 2) * c->dim * c->dim; t++) {
            int a = t == 0 ? -1 : (t - 1) % c->dim, b = t <= c->dim ? -1 : (t - 1) / c->dim - 1;
            const double *x = r->x + i * dim;
            double f = 0, g[3] = { 0 }, size = 1, step = 0;
            for (size_t e = r->family.start[i]; e < r->family.start[i + 1]; e++) {
                const double *y = c->x + (size_t) r->family.node[e] * dim;
                double fj = (a < 0 ? 1 : y[a] - x[a] + 0.5) * (b < 0 ? 1 : y[b] - x[b] - 0.3);
                size = fmax (size, fabs (fj)),
                step = step > 0 ? fmin (step, c->size[r->family.node[e]]) : c->size[r->family.node[e]];
                f += r->N[e] * fj;
                for (size_t k = 0; k < dim; k++) g[k] += r->dN[e * dim + k] * fj;
            }
            *value = fmax (*value, fabs (f - (a < 0 ? 1 : 0.5) * (b < 0 ? 1 : -0.3)) / size);
            for (int k = 0; k < c->dim; k++) {
                double exact = (a == k ? (b < 0 ? 1 : -0.3) : 0) + (b == k ? 0.5 : 0);
                *slope = fmax (*slope, fabs (g[k] - exact) * step / size);
            }
        }
}

static void bases_are_reproduced (void **state)
{
    (void) state;
    const char *const type[3] = { "rkpm", "pddo", "nosb" };
    for (int t = 0; t < 3; t++)
        for (int dim = 1; dim <= 3; dim++)
            for (int order = 1; order <= 2; order++)
                for (int shape = PG_RADIAL; shape <= PG_TENSOR; shape++)
                    for (int nodes = 0; nodes <= 1; nodes++) {
                        pg_cloud c = graded (dim);
                        pg_approx a = make (type[t], "cubic_spline", order, shape, reach (dim, order));
                        double x[150], value, slope, top = extent (&c) * 0.9;
                        for (int k = 0; k < 50 * dim; k++) x[k] = top * (0.5 + 0.5 * rnd ());
                        pg_rows r = nodes ? rows_at_nodes (&a, &c) : rows_at (&a, &c, 50, x, NULL);
                        for (size_t i = 0; i < r.n; i++)
                            if (r.grade[i] != PG_GRADE_FULL)
                                fail_msg ("%s, order %d in %dD: grade %d", type[t], order, dim, r.grade[i]);
                        worst (&c, &r, order, &value, &slope);
                        if (!(value <= 1e-11) || !(slope <= 1e-11))
                            fail_msg ("%s, order %d in %dD: value %.3g, slope %.3g off", type[t], order, dim,
                                      value, slope);
                        pg_rows_clear (&r);
                        graded_clear (&c);
                    }
}

static void derivatives_are_those_of_the_shape_functions (void **state)
{
    (void) state;
    const char *const kernel[4] = { "quadratic", "conical", "cubic_spline", "quartic_spline" };
    for (int t = 0; t < 4 * 12; t++) {
        int dim = 1 + t / 4 % 3, order = 1 + t / 12 % 2, shape = t / 24;
        pg_cloud c = graded (dim);
        pg_approx a = make ("rkpm", kernel[t % 4], order, shape, reach (dim, order));
        for (int s = 0; s < 4; s++) {
            double x[3], top = extent (&c) * 0.9;
            for (int k = 0; k < dim; k++) x[k] = top * (0.5 + 0.5 * rnd ());
            check_derivative (&a, &c, x, 1e-5);
        }
        graded_clear (&c);
    }
}

static void equal_spacings_change_no_bit (void **state)
{
    (void) state;
    const char *const type[3] = { "rkpm", "pddo", "nosb" };
    for (int t = 0; t < 3; t++)
        for (int dim = 1; dim <= 3; dim++)
            for (size_t n = 0; pg_kernel_entry (n); n++)
                for (int order = 1; order <= 2; order++) {
                    int shape = n % 2 && strcmp (pg_kernel_entry (n)->name, "inverse_r") ? PG_TENSOR
                                                                                         : PG_RADIAL;
                    pg_cloud c = lattice (dim, per_axis[dim], 0.3, n % 3 ? 0.2 : 0), d = c;
                    pg_approx a = make (type[t], pg_kernel_entry (n)->name, order, shape,
                                        0.3 * (order == 1 ? 2 : 3));
                    d.size = pg_calloc (c.n, sizeof *d.size);
                    for (size_t i = 0; i < c.n; i++) d.size[i] = c.h;
                    pg_rows r = rows_at_nodes (&a, &c), s = rows_at_nodes (&a, &d);
                    size_t nnz = r.family.start[r.n];
                    assert_memory_equal (r.family.start, s.family.start, (r.n + 1) * sizeof *r.family.start);
                    assert_memory_equal (r.family.node, s.family.node, nnz * sizeof *r.family.node);
                    assert_memory_equal (r.N, s.N, nnz * sizeof *r.N);
                    assert_memory_equal (r.dN, s.dN, nnz * (size_t) dim * sizeof *r.dN);
                    assert_memory_equal (r.w, s.w, nnz * sizeof *r.w);
                    assert_memory_equal (r.grade, s.grade, r.n);
                    pg_rows_clear (&r);
                    pg_rows_clear (&s);
                    pg_free (d.size);
                    lattice_clear (&c);
                }
}

/* A body that is turned and drawn out by F, its supports with it, |F^-1 z| < horizon, is the body of balls
 * seen through a lens: the same neighbours, the same N, and derivatives F^-T dN. A = s^2 F^-T F^-1, s the
 * most that F draws out. */
static void anisotropic_supports_are_balls_of_a_stretched_body (void **state)
{
    (void) state;
    const char *const type[3] = { "rkpm", "pddo", "nosb" };
    const double turn[9] = { 0.8, -0.6, 0, 0.6, 0.8, 0, 0, 0, 1 }, draw[3] = { 2.5, 0.7, 1.1 };
    for (int t = 0; t < 3; t++)
        for (int dim = 2; dim <= 3; dim++)
            for (int order = 1; order <= 2; order++) {
                size_t d = (size_t) dim;
                pg_cloud c = graded (dim), s = c;
                pg_approx a = make (type[t], "cubic_spline", order, PG_RADIAL, reach (dim, order));
                s.x = pg_calloc (c.n * d, sizeof *s.x), s.size = pg_calloc (c.n, sizeof *s.size);
                s.metric = pg_calloc (c.n * d * d, sizeof *s.metric);
                for (size_t i = 0; i < c.n; i++) {
                    s.size[i] = c.size[i] * draw[0];
                    for (size_t k = 0; k < d; k++)
                        for (size_t l = 0; l < d; l++) {
                            s.x[i * d + k] += turn[3 * k + l] * draw[l] * c.x[i * d + l];
                            for (size_t m = 0; m < d; m++)
                                s.metric[(i * d + k) * d + l] += turn[3 * k + m] * turn[3 * l + m]
                                                                 * pow (draw[0] / draw[m], 2);
                        }
                }
                pg_rows r = rows_at_nodes (&a, &c), q = rows_at_nodes (&a, &s);
                assert_memory_equal (r.family.start, q.family.start, (r.n + 1) * sizeof *r.family.start);
                assert_memory_equal (r.family.node, q.family.node,
                                     r.family.start[r.n] * sizeof *r.family.node);
                assert_memory_equal (r.grade, q.grade, r.n);
                for (size_t e = 0; e < r.family.start[r.n]; e++) {
                    check_absolute (q.N[e], r.N[e], 1e-9);
                    for (size_t k = 0; k < d; k++) {
                        double slope = 0;
                        for (size_t l = 0; l < d; l++)
                            slope += turn[3 * k + l] / draw[l] * r.dN[e * d + l];
                        check_absolute (q.dN[e * d + k], slope, 1e-8);
                    }
                }
                pg_rows_clear (&r), pg_rows_clear (&q);
                pg_free (s.x), pg_free (s.size), pg_free (s.metric);
                graded_clear (&c);
            }
}

/* Supports that differ in shape from point to point: polynomials and derivatives are exact all the same. */
static void anisotropic_supports_reproduce (void **state)
{
    (void) state;
    for (int dim = 2; dim <= 3; dim++)
        for (int order = 1; order <= 2; order++) {
            size_t d = (size_t) dim;
            pg_cloud c = graded (dim);
            pg_approx a = make ("rkpm", "cubic_spline", order, PG_RADIAL, 1.6 * reach (dim, order));
            c.metric = pg_calloc (c.n * d * d, sizeof *c.metric);
            for (size_t i = 0; i < c.n; i++) {
                double v[3], more = 1 + rnd ();
                for (size_t k = 0; k < d; k++) v[k] = rnd ();
                for (size_t k = 0; k < d; k++)
                    for (size_t l = 0; l < d; l++)
                        c.metric[(i * d + k) * d + l] = (k == l) + more * v[k] * v[l];
            }
            double x[3], value, slope, top = extent (&c) * 0.9;
            pg_rows r = rows_at_nodes (&a, &c);
            worst (&c, &r, order, &value, &slope);
            check_below (value, 1e-11);
            check_below (slope, 1e-11);
            for (int s = 0; s < 4; s++) {
                for (int k = 0; k < dim; k++) x[k] = top * (0.5 + 0.5 * rnd ());
                check_derivative (&a, &c, x, 1e-5);
            }
            pg_rows_clear (&r);
            pg_free (c.metric);
            graded_clear (&c);
        }
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (bases_are_reproduced),
        cmocka_unit_test (derivatives_are_those_of_the_shape_functions),
        cmocka_unit_test (equal_spacings_change_no_bit),
        cmocka_unit_test (anisotropic_supports_are_balls_of_a_stretched_body),
        cmocka_unit_test (anisotropic_supports_reproduce),
    };
    return cmocka_run_group_tests_name ("discretization/approx/graded", tests, NULL, NULL);
}
