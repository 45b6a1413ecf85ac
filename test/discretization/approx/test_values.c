/* SPDX-License-Identifier: GPL-3.0-or-later
 * Printed values of shape functions and derivatives (verification table E-1 ... E-9). */
#include "check.h"
#include "lattice.h"

/* Nodes first ... first + n - 1 of a line: N or dN at x */
static void line (const char *type, int order, double a, double x, int first, int n, const double *want,
                  int slope, double tolerance)
{
    pg_cloud c = lattice (1, 11, 1, 0);
    pg_approx p = make (type, "cubic_spline", order, PG_RADIAL, a);
    pg_rows r = rows_at (&p, &c, 1, &x, NULL);
    for (int j = 0; j < n; j++)
        check_absolute (slope ? dN_of (&r, 0, first + j, 0) : N_of (&r, 0, first + j), want[j], tolerance);
    double rest = 0;
    for (int j = 0; j < 11; j++) if (j < first || j >= first + n) rest += fabs (N_of (&r, 0, j));
    check_absolute (rest, 0, 1e-12);
    assert_int_equal (r.grade[0], PG_GRADE_FULL);
    pg_rows_clear (&r);
    lattice_clear (&c);
}

static void line_shape_functions (void **state)
{
    (void) state;
    const double want[4] = { .0703125, .6119791667, .3151041667, .0026041667 };
    line ("rkpm", 1, 2, 5.25, 4, 4, want, 0, 1e-10);
    line ("pddo", 1, 2, 5.25, 4, 4, want, 0, 1e-10);
    line ("nosb", 1, 2, 5.25, 4, 4, want, 0, 1e-10);
}

static void line_reproducing_derivative (void **state)
{
    (void) state;
    const double want[4] = { -.28125, -.40625, .65625, .03125 };
    line ("rkpm", 1, 2, 5.25, 4, 4, want, 1, 1e-10);
}

static void line_differential_operator (void **state)
{
    (void) state;
    const double want[4] = { -.26367188, -.45898438, .70898438, .01367188 };
    line ("pddo", 1, 2, 5.25, 4, 4, want, 1, 1e-8);
    line ("nosb", 1, 2, 5.25, 4, 4, want, 1, 1e-8);
}

static void near_the_end_of_the_line (void **state)
{
    (void) state;
    /* N from exact fractions: w = 3541/6000, 2089/6000, 27/6000 */
    const double N[3] = { .702282050234942, .295435899530116, .002282050234942 },
                 rk[3] = { -.96461007, .92922014, .03538993 };
    const double pd[3] = { -.9684, .93679999, .0316 };
    line ("rkpm", 1, 2, 0.3, 0, 3, N, 0, 1e-14);
    line ("rkpm", 1, 2, 0.3, 0, 3, rk, 1, 1e-7);
    line ("pddo", 1, 2, 0.3, 0, 3, pd, 1, 1e-7);
}

static void quadratic_line (void **state)
{
    (void) state;
    const double N[6] = { -.03285339, .06534773, .65958218, .36395097, -.05377246, -.00225504 },
                 end[3] = { -1.5, 2, -.5 };
    line ("rkpm", 2, 3, 5.25, 3, 6, N, 0, 1e-8);
    line ("rkpm", 2, 3, 0, 0, 3, end, 1, 1e-10);
}

/* One node of a lattice, seen from x: N, reproducing derivative, differential operator */
static void one_node (int dim, size_t per_axis, int order, double a, const double *x, int node,
                      const double *want, double tolerance)
{
    pg_cloud c = lattice (dim, per_axis, 1, 0);
    pg_approx rk = make ("rkpm", "cubic_spline", order, PG_RADIAL, a),
              pd = make ("pddo", "cubic_spline", order, PG_RADIAL, a);
    pg_rows r = rows_at (&rk, &c, 1, x, NULL), p = rows_at (&pd, &c, 1, x, NULL);
    check_absolute (N_of (&r, 0, node), want[0], tolerance);
    check_absolute (N_of (&p, 0, node), want[0], tolerance);
    for (int k = 0; k < dim; k++) {
        check_absolute (dN_of (&r, 0, node, k), want[1 + k], tolerance);
        check_absolute (dN_of (&p, 0, node, k), want[1 + dim + k], tolerance);
    }
    pg_rows_clear (&r);
    pg_rows_clear (&p);
    lattice_clear (&c);
}

static void plane_linear (void **state)
{
    (void) state;
    const double x[2] = { 2.3, 1.6 };
    const double want[5] = { .325495435270, -.263467533757, .341733327345, -.309824710123, .414352120335 };
    one_node (2, 5, 1, 2, x, 12, want, 1e-10);
}

static void plane_quadratic (void **state)
{
    (void) state;
    const double x[2] = { 2.3, 1.6 };
    const double want[5] = { .361805219644, -.191530468942, .261248733568, -.075702217212, .102819129682 };
    one_node (2, 5, 2, 3, x, 12, want, 1e-10);
}

static void solid_linear (void **state)
{
    (void) state;
    const double x[3] = { 1.3, 1.6, 1.2 };
    const double want[7] = { .165871866589, -.13673288, -.26986945, -.09133871,
                             -.16582858,    -.33213629, -.10946922 };
    one_node (3, 4, 1, 2, x, 1 + 4 + 16, want, 1e-8);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (line_shape_functions),
        cmocka_unit_test (line_reproducing_derivative),
        cmocka_unit_test (line_differential_operator),
        cmocka_unit_test (near_the_end_of_the_line),
        cmocka_unit_test (quadratic_line),
        cmocka_unit_test (plane_linear),
        cmocka_unit_test (plane_quadratic),
        cmocka_unit_test (solid_linear),
    };
    return cmocka_run_group_tests_name ("discretization/approx/values", tests, NULL, NULL);
}
