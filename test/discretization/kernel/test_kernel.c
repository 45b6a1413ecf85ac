/* SPDX-License-Identifier: GPL-3.0-or-later
 * Influence functions: catalogue, values, derivatives, moments. */
#include "check.h"
#include "perigal/kernel.h"

static double at (const pg_kernel *k, double q, double *slope)
{
    double w, dw;
    k->value (1, &q, &w, &dw);
    if (slope) *slope = dw;
    return w;
}

static void every_entry_is_found_by_its_name_and_listed (void **state)
{
    (void) state;
    char joined[512] = "";
    size_t n = 0;
    for (; pg_kernel_entry (n); n++) {
        const pg_kernel *k = pg_kernel_entry (n);
        assert_ptr_equal (pg_kernel_find (k->name), k);
        if (n) strcat (joined, "|");
        strcat (joined, k->name);
    }
    assert_int_equal (n, 8);
    assert_string_equal (joined, pg_kernel_names ());
    assert_null (pg_kernel_find ("cubic"));
    assert_null (pg_kernel_find (NULL));
}

static void derivative_equals_finite_difference (void **state)
{
    (void) state;
    double step = 1e-6, dw;
    for (size_t n = 0; pg_kernel_entry (n); n++)
        for (double q = 0.013; q < 1 - step; q += 0.0217) {
            const pg_kernel *k = pg_kernel_entry (n);
            double difference = (at (k, q + step, NULL) - at (k, q - step, NULL)) / (2 * step);
            at (k, q, &dw);
            check_absolute (dw, difference, 2e-6);
        }
}

static void values_are_the_same_without_derivatives (void **state)
{
    (void) state;
    const double q[5] = { 0, 0.2, 0.5, 0.7, 1 };
    double a[5], b[5], dw[5];
    for (size_t n = 0; pg_kernel_entry (n); n++) {
        pg_kernel_entry (n)->value (5, q, a, NULL);
        pg_kernel_entry (n)->value (5, q, b, dw);
        assert_memory_equal (a, b, sizeof a);
    }
}

static void moments_are_those_of_the_closed_forms (void **state)
{
    (void) state;
    for (int n = 0; n <= 4; n++) {
        const double m = n, want[] = { 1 / (m + 1), 1 / (m + 1) - 1 / (m + 2), 1 / (m + 1) - 1 / (m + 3),
                                       1 / (m + 2), 1 / (m + 1) - 6 / (m + 3) + 8 / (m + 4) - 3 / (m + 5) };
        static const char *const name[] = { "constant", "conical", "quadratic", "linear_r",
                                            "quartic_spline" };
        for (int k = 0; k < 5; k++)
            check_relative (pg_kernel_moment (pg_kernel_find (name[k]), n), want[k], 1e-13);
        if (n > 0) check_relative (pg_kernel_moment (pg_kernel_find ("inverse_r"), n), 1 / m, 1e-13);
    }
}

static void open_kernels_vanish_at_the_horizon_and_closed_ones_do_not (void **state)
{
    (void) state;
    for (size_t n = 0; pg_kernel_entry (n); n++) {
        const pg_kernel *k = pg_kernel_entry (n);
        if (k->closed) assert_true (at (k, 1, NULL) > 0);
        else check_scaled (at (k, 1, NULL), 0, 1e-300, 1);
    }
}

static void kernels_are_finite_and_not_negative_everywhere (void **state)
{
    (void) state;
    for (size_t n = 0; pg_kernel_entry (n); n++)
        for (int i = 0; i <= 1000; i++) {
            double dw, w = at (pg_kernel_entry (n), i / 1000.0, &dw);
            assert_true (w >= 0 && isfinite (w) && isfinite (dw));
        }
}

static void splines_take_their_printed_values (void **state)
{
    (void) state;
    const pg_kernel *cubic = pg_kernel_find ("cubic_spline"), *quartic = pg_kernel_find ("quartic_spline");
    double s = 0.3, t = 0.8;
    check_relative (at (cubic, 0, NULL), 2.0 / 3, 1e-15);
    check_relative (at (cubic, s, NULL), 2.0 / 3 - 4 * s * s + 4 * s * s * s, 1e-15);
    check_relative (at (cubic, 0.5, NULL), 1.0 / 6, 1e-15);
    check_absolute (at (cubic, t, NULL), 4.0 / 3 - 4 * t + 4 * t * t - 4.0 / 3 * t * t * t, 1e-15);
    check_absolute (at (quartic, t, NULL), 1 - 6 * t * t + 8 * t * t * t - 3 * t * t * t * t, 1e-15);
}

static void inverse_r_limits_the_weight_of_the_own_node_only (void **state)
{
    (void) state;
    const pg_kernel *k = pg_kernel_find ("inverse_r");
    check_relative (at (k, 0, NULL), 1e3, 0);
    check_relative (at (k, 1e-15, NULL), 1e3, 0);
    check_relative (at (k, 1e-4, NULL), 1e4, 1e-15);
    check_relative (at (k, 0.25, NULL), 4, 1e-15);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (every_entry_is_found_by_its_name_and_listed),
        cmocka_unit_test (derivative_equals_finite_difference),
        cmocka_unit_test (values_are_the_same_without_derivatives),
        cmocka_unit_test (moments_are_those_of_the_closed_forms),
        cmocka_unit_test (open_kernels_vanish_at_the_horizon_and_closed_ones_do_not),
        cmocka_unit_test (kernels_are_finite_and_not_negative_everywhere),
        cmocka_unit_test (splines_take_their_printed_values),
        cmocka_unit_test (inverse_r_limits_the_weight_of_the_own_node_only),
    };
    return cmocka_run_group_tests_name ("discretization/kernel/kernel", tests, NULL, NULL);
}
