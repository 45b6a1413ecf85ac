/* SPDX-License-Identifier: GPL-3.0-or-later
 * random_field (length, seed) in expressions: margins, correlation, units, seeds, and what is refused. */
#include "check.h"
#include "perigal/scene.h"
#include <gsl/gsl_cdf.h>
#include <stdlib.h>

static double at (const pg_expression *e, double x, double y, double z)
{
    pg_place place = { .x = x, .y = y, .z = z };
    return pg_expression_value (e, &place);
}

static pg_expression *compiled (const char *text, const char *unit)
{
    pg_expression *e = NULL;
    check_ok (pg_expression_compile (&e, text, unit));
    return e;
}

static int ascending (const void *a, const void *b)
{
    double p = *(const double *) a, q = *(const double *) b;
    return (p > q) - (p < q);
}

/* Largest difference of the distribution of n values from that of probabilities: below 1.628 / sqrt (n) in 99
 * of 100 samples (Kolmogorov and Smirnov). */
static void check_uniform (size_t n, double *u)
{
    double most = 0;
    qsort (u, n, sizeof *u, ascending);
    for (size_t i = 0; i < n; i++)
        most = fmax (most, fmax ((double) (i + 1) / (double) n - u[i], u[i] - (double) i / (double) n));
    check_below (most, 1.628 / sqrt ((double) n));
}

enum { SIDE = 30, PLACES = SIDE * SIDE };

/* Places ten lengths apart know nothing of each other. */
static void margins_are_normal_and_weibull (void **state)
{
    (void) state;
    double u[PLACES], w[PLACES];
    pg_expression *g = compiled ("random_field (2 mm, 7)", "1"),
                  *s = compiled ("30 MPa * (-log (1 - phi (random_field (2 mm, 7))))^(1/8)", "Pa");
    for (size_t i = 0; i < PLACES; i++) {
        double x = 0.02 * (double) (i % SIDE), y = 0.02 * (double) (i / SIDE);
        u[i] = gsl_cdf_ugaussian_P (at (g, x, y, 0));
        w[i] = gsl_cdf_weibull_P (at (s, x, y, 0), 30e6, 8);
    }
    check_uniform (PLACES, u);
    check_uniform (PLACES, w);
    pg_expression_free (&g), pg_expression_free (&s);
}

/* exp (-r^2 / (2 length^2)), along each axis; the mean of n products has an error of about 1 / sqrt (n). */
static void the_correlation_is_that_of_the_length (void **state)
{
    (void) state;
    static const double distance[] = { 0.5, 1, 2, 5 };
    pg_expression *g = compiled ("random_field (3, 12)", "1");
    for (int k = 0; k < 4; k++)
        for (int axis = 0; axis < 3; axis++) {
            double sum = 0, r = 3 * distance[k];
            for (size_t i = 0; i < 4 * PLACES; i++) {
                double x[3] = { 30.0 * (double) (i % 60), 30.0 * (double) (i / 60), 7 },
                       a = at (g, x[0], x[1], x[2]);
                x[axis] += r;
                sum += a * at (g, x[0], x[1], x[2]) / (4 * PLACES);
            }
            check_absolute (sum, exp (-0.5 * distance[k] * distance[k]), 0.06);
        }
    pg_expression_free (&g);
}

static void a_seed_is_one_field (void **state)
{
    (void) state;
    pg_expression *a = compiled ("random_field (2 mm, 7)", "1"),
                  *b = compiled ("random_field (0.002, 7)", "1"),
                  *c = compiled ("random_field (2 mm, 8)", "1"),
                  *d = compiled ("2 + 3 * random_field (4 mm, 7)", "1");
    for (int i = 0; i < 50; i++) {
        double x = 0.001 * i, y = 0.003 * i;
        assert_true (at (a, x, y, 0.01) == at (b, x, y, 0.01));
        assert_true (at (a, x, y, 0.01) != at (c, x, y, 0.01));
        check_absolute (at (d, 2 * x, 2 * y, 0.02), 2 + 3 * at (a, x, y, 0.01), 1e-12);
    }
    assert_true (pg_expression_uses (a, 'x') && !pg_expression_uses (a, 't'));
    pg_expression_free (&a), pg_expression_free (&b), pg_expression_free (&c), pg_expression_free (&d);
    pg_expression *two = compiled ("random_field (1, 1) - random_field (1, 2) + x / m", "1");
    pg_expression *one = compiled ("random_field (1, 1)", "1"),
                  *other = compiled ("random_field (1, 2)", "1");
    check_absolute (at (two, 0.3, 0.4, 0), at (one, 0.3, 0.4, 0) - at (other, 0.3, 0.4, 0) + 0.3, 1e-14);
    pg_expression_free (&two), pg_expression_free (&one), pg_expression_free (&other);
}

static void what_is_no_field_is_refused (void **state)
{
    (void) state;
    static const struct { const char *text, *part;
    } all[] = { { "random_field (2 MPa, 7)", "is its correlation length" },
                { "random_field (x, 7)", "is its correlation length" },
                { "random_field (0 mm, 7)", "is its correlation length" },
                { "random_field (-1 mm, 7)", "is its correlation length" },
                { "random_field (2 mm, 7.5)", "is its seed" },
                { "random_field (2 mm, 7 mm)", "is its seed" },
                { "random_field (2 mm)", "takes 2 arguments" },
                { "random_field", "needs a length and a seed" },
                { "random_field (2 mm, 7, 8)", "')' is missing" },
                { "random_feld (2 mm, 7)", "did you mean random_field" } };
    for (size_t k = 0; k < sizeof all / sizeof *all; k++) {
        pg_expression *e = NULL;
        check_fails (pg_expression_compile (&e, all[k].text, "1"), PG_E_SCENE);
        check_contains (pg_last_error (), all[k].part);
        assert_null (e);
    }
}

static void any_allocation_may_fail (void **state)
{
    (void) state;
    size_t before = pg_memory_used (), k = 0;
    pg_status status = PG_E_MEMORY;
    while (status != PG_OK) {
        pg_expression *e = NULL;
        pg_memory_fail_at (++k);
        status = pg_expression_compile (&e, "1 + random_field (2, 7) * random_field (3, 8)", "1");
        pg_memory_fail_at (0);
        if (status != PG_OK) assert_int_equal (status, PG_E_MEMORY);
        pg_expression_free (&e);
        assert_int_equal (pg_memory_used (), before);
    }
    assert_true (k > 3);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (margins_are_normal_and_weibull),
        cmocka_unit_test (the_correlation_is_that_of_the_length),
        cmocka_unit_test (a_seed_is_one_field),
        cmocka_unit_test (what_is_no_field_is_refused),
        cmocka_unit_test (any_allocation_may_fail),
    };
    return cmocka_run_group_tests (tests, NULL, NULL);
}
