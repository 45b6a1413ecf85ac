/* SPDX-License-Identifier: GPL-3.0-or-later
 * The observed order of made sequences is the one they were made with; what swings, parts or stands still has
 * none. */
#include "check.h"
#include "perigal/compare.h"

static void exact_orders (void **unused)
{
    static const double h[2][4] = { { 0.8, 0.4, 0.2, 0.1 }, { 1, 0.7, 0.4, 0.1 } };
    static const double orders[] = { 0.5, 1, 2, 3.7, 8 };
    (void) unused;
    for (int s = 0; s < 2; s++)
        for (size_t k = 0; k < sizeof orders / sizeof *orders; k++)
            for (int sign = -1; sign <= 1; sign += 2) {
                double v[4];
                for (int i = 0; i < 4; i++) v[i] = 7 + sign * 0.3 * pow (h[s][i], orders[k]);
                pg_observed o = pg_observed_of_values (4, h[s], v);
                assert_null (o.why);
                check_relative (o.order, orders[k], 1e-4);
                check_relative (o.limit, 7, 1e-9);
                check_scaled (o.error, fabs (v[3] - o.limit), 1e-12, 7);
            }
}

/* Only the last three count: a first value far off changes nothing. */
static void last_three (void **unused)
{
    static const double h[] = { 1, 0.5, 0.25, 0.125 };
    double v[] = { 99, 1 + 0.25, 1 + 0.0625, 1 + 0.015625 };
    (void) unused;
    pg_observed o = pg_observed_of_values (4, h, v);
    check_relative (o.order, 2, 1e-10);
    check_relative (o.limit, 1, 1e-10);
}

static void no_order (void **unused)
{
    static const double h[] = { 1, 0.5, 0.25 }, rising[] = { 0.25, 0.5, 1 };
    static const struct { double v[3]; const char *why;
    } cases[] = { { { 1, 2, 1.5 }, "oscillates" },
                  { { 1, 2, 4 }, "diverges" },
                  { { 1, 2, 3 }, "diverges" },
                  { { 3, 3, 3 }, "always the same" },
                  { { 0, 0, 0 }, "always the same" },
                  { { 4, 3, 3 }, "no longer changes" },
                  { { 1, NAN, 3 }, "a value is missing" },
                  { { 1e9, 1, 0.5 }, "last change too small" } };
    (void) unused;
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        pg_observed o = pg_observed_of_values (3, h, cases[k].v);
        assert_true (isnan (o.order));
        assert_string_equal (o.why, cases[k].why);
    }
    assert_string_equal (pg_observed_of_values (2, h, cases[0].v).why, "three sizes are needed");
    assert_string_equal (pg_observed_of_values (3, rising, cases[0].v).why, "the sizes do not fall");
}

static void of_errors (void **unused)
{
    static const double h[] = { 1, 0.5, 0.3 }, e[] = { 0.4, 0.1, 0.1 * 0.36 }, grows[] = { 0.1, 0.1, 0.2 },
                        zero[] = { 1, 1, 0 };
    (void) unused;
    pg_observed o = pg_observed_of_errors (3, h, e);
    check_relative (o.order, 2, 1e-12);
    check_relative (o.error, 0.036, 1e-12);
    assert_true (isnan (pg_observed_of_errors (3, h, grows).order));
    assert_string_equal (pg_observed_of_errors (3, h, grows).why, "diverges");
    assert_string_equal (pg_observed_of_errors (3, h, zero).why, "an error is zero");
    assert_string_equal (pg_observed_of_errors (1, h, e).why, "two sizes are needed");
}

static void crossing (void **unused)
{
    static const double e[] = { 1e-2, 1e-3, 1e-5 }, s[] = { 0.1, 1, 100 }, back[] = { 1e-5, 1e-3, 1e-2 },
                        t[] = { 100, 1, 0.1 };
    (void) unused;
    check_relative (pg_loglog_at (3, e, s, 1e-4), 10, 1e-12);
    check_relative (pg_loglog_at (3, back, t, 1e-4), 10, 1e-12);
    check_relative (pg_loglog_at (3, e, s, 1e-3), 1, 1e-12);
    assert_true (isnan (pg_loglog_at (3, e, s, 1e-6)));
    assert_true (isnan (pg_loglog_at (3, e, s, 0.1)));
    assert_true (isnan (pg_loglog_at (1, e, s, 1e-2)));
}

int main (void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test (exact_orders), cmocka_unit_test (last_three),
                                        cmocka_unit_test (no_order), cmocka_unit_test (of_errors),
                                        cmocka_unit_test (crossing) };
    return cmocka_run_group_tests (tests, NULL, NULL);
}
