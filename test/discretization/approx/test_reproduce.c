/* SPDX-License-Identifier: GPL-3.0-or-later
 * Polynomials up to the order of the basis are reproduced, values and derivatives, on points moved at random;
 * the derivative of the reproducing kernel is the derivative of its shape function. */
#include "check.h"
#include "lattice.h"

static const size_t per_axis[4] = { 0, 12, 8, 6 };

/* A polynomial of the order with fixed coefficients; value and gradient at x (units of h). */
static double polynomial (int dim, int order, const double *x, double *slope)
{
    const double b[3] = { 0.7, -1.3, 0.4 },
                 C[3][3] = { { 0.5, -0.8, 0.3 }, { 0, 0.9, -0.6 }, { 0, 0, -0.2 } };
    double f = 1.5;
    for (int k = 0; k < dim; k++) f += b[k] * x[k], slope[k] = b[k];
    for (int k = 0; order == 2 && k < dim; k++)
        for (int l = k; l < dim; l++) {
            f += C[k][l] * x[k] * x[l];
            slope[k] += C[k][l] * x[l];
            slope[l] += C[k][l] * x[k];
        }
    return f;
}

/* Largest errors of value and gradient over all rows, relative to the size of the field there. */
static void worst (const pg_cloud *c, const pg_rows *r, int order, double *value, double *slope)
{
    *value = *slope = 0;
    for (size_t i = 0; i < r->n; i++) {
        double f = 0, g[3] = { 0 }, exact[3], unused[3], size = 1,
               fx = polynomial (c->dim, order, r->x + i * (size_t) c->dim, exact);
        for (size_t e = r->family.start[i]; e < r->family.start[i + 1]; e++) {
            double fj = polynomial (c->dim, order, c->x + r->family.node[e] * c->dim, unused);
            size = fmax (size, fabs (fj));
            f += r->N[e] * fj;
            for (int k = 0; k < c->dim; k++) g[k] += r->dN[e * (size_t) c->dim + (size_t) k] * fj;
        }
        *value = fmax (*value, fabs (f - fx) / size);
        for (int k = 0; k < c->dim; k++) *slope = fmax (*slope, fabs (g[k] - exact[k]) / size);
    }
}

static double reach (int dim, int order) { return order == 1 ? 2.3 : dim == 1 ? 3.6 : 3.3; }

static void check_family (const char *type, int dim, int order, int at_nodes)
{
    pg_cloud c = lattice (dim, per_axis[dim], 1, 0.2);
    for (size_t n = 0; pg_kernel_entry (n); n++)
        for (int shape = PG_RADIAL; shape <= PG_TENSOR; shape++) {
            /* infinite on planes */
            if (shape == PG_TENSOR && strcmp (pg_kernel_entry (n)->name, "inverse_r") == 0) continue;
            pg_approx a = make (type, pg_kernel_entry (n)->name, order, shape, reach (dim, order));
            double x[150], value, slope;
            for (int k = 0; k < 50 * dim; k++) x[k] = ((double) per_axis[dim] - 1) * (0.5 + 0.5 * rnd ());
            pg_rows r = at_nodes ? rows_at_nodes (&a, &c) : rows_at (&a, &c, 50, x, NULL);
            for (size_t i = 0; i < r.n; i++)
                if (r.grade[i] != PG_GRADE_FULL)
                    fail_msg ("%s, %s, order %d in %dD: grade %d", type, a.kernel->name, order, dim,
                              r.grade[i]);
            for (int o = 0; o <= order; o++) {
                worst (&c, &r, o, &value, &slope);
                if (!(value <= 1e-12) || !(slope <= 1e-12))
                    fail_msg ("%s, %s, %s, order %d of %d in %dD: value %.3g, slope %.3g off", type,
                              a.kernel->name, shape ? "tensor" : "radial", o, order, dim, value, slope);
            }
            pg_rows_clear (&r);
        }
    lattice_clear (&c);
}

static void everywhere (const char *type)
{
    for (int dim = 1; dim <= 3; dim++)
        for (int order = 1; order <= 2; order++)
            for (int at_nodes = 0; at_nodes <= 1; at_nodes++) check_family (type, dim, order, at_nodes);
}

static void rkpm_reproduces_its_basis (void **state) { (void) state; everywhere ("rkpm"); }
static void pddo_reproduces_its_basis (void **state) { (void) state; everywhere ("pddo"); }
static void nosb_reproduces_its_basis (void **state) { (void) state; everywhere ("nosb"); }

static void rkpm_derivative_is_that_of_its_shape_function (void **state)
{
    (void) state;
    const char *const open[5] = { "quadratic", "conical", "cubic_spline", "quartic_spline", "gaussian" };
    for (int t = 0; t < 5 * 12; t++) {
        int dim = 1 + t / 5 % 3, order = 1 + t / 15 % 2, shape = t / 30;
        pg_cloud c = lattice (dim, per_axis[dim], 1, 0.2);
        pg_approx a = make ("rkpm", open[t % 5], order, shape, reach (dim, order));
        a.use_volume = t & 1;
        for (int s = 0; s < 4; s++) {
            double x[3];
            for (int k = 0; k < dim; k++) x[k] = ((double) per_axis[dim] - 1) * (0.5 + 0.5 * rnd ());
            check_derivative (&a, &c, x, 1e-5);
        }
        lattice_clear (&c);
    }
}

/* N and h dN of every approximation, and those of the same points in other units and far from the origin */
static void compare_scaled (double unit, double shift, double tolerance)
{
    const char *const type[3] = { "rkpm", "pddo", "nosb" };
    for (int t = 0; t < 3; t++)
        for (int dim = 1; dim <= 3; dim++)
            for (int order = 1; order <= 2; order++) {
                pg_cloud c = lattice (dim, per_axis[dim], 1, 0.2), d = lattice (dim, per_axis[dim], unit, 0);
                for (size_t k = 0; k < c.n * (size_t) dim; k++) d.x[k] = unit * (c.x[k] + shift);
                for (size_t k = 0; k < c.n; k++) d.volume[k] = pow (unit, dim) * c.volume[k];
                pg_approx a = make (type[t], "cubic_spline", order, PG_RADIAL, reach (dim, order)), b = a;
                b.horizon *= unit;
                pg_rows r = rows_at_nodes (&a, &c), s = rows_at_nodes (&b, &d);
                for (size_t i = 0; i < c.n; i++) {
                    assert_int_equal (r.grade[i], s.grade[i]);
                    for (size_t e = r.family.start[i]; e < r.family.start[i + 1]; e++) {
                        check_absolute (N_of (&s, i, r.family.node[e]), r.N[e], tolerance);
                        for (int k = 0; k < dim; k++)
                            check_absolute (unit * dN_of (&s, i, r.family.node[e], k),
                                            r.dN[e * (size_t) dim + (size_t) k], tolerance);
                    }
                }
                pg_rows_clear (&r);
                pg_rows_clear (&s);
                lattice_clear (&c);
                lattice_clear (&d);
            }
}

static void the_unit_of_length_does_not_matter (void **state)
{
    (void) state;
    compare_scaled (1e-6, 0, 1e-11);
    compare_scaled (1e6, 0, 1e-11);
    compare_scaled (0x1p-20, 0, 1e-13);
}

static void the_origin_does_not_matter (void **state)
{
    (void) state;
    compare_scaled (1, 1e3, 1e-10);
    compare_scaled (1e-6, -1e3, 1e-10);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (rkpm_reproduces_its_basis),
        cmocka_unit_test (pddo_reproduces_its_basis),
        cmocka_unit_test (nosb_reproduces_its_basis),
        cmocka_unit_test (rkpm_derivative_is_that_of_its_shape_function),
        cmocka_unit_test (the_unit_of_length_does_not_matter),
        cmocka_unit_test (the_origin_does_not_matter),
    };
    return cmocka_run_group_tests_name ("discretization/approx/reproduce", tests, NULL, NULL);
}
