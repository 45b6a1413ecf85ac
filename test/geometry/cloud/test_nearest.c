/* SPDX-License-Identifier: GPL-3.0-or-later
 * The nearest point against a comparison with all points: random, on a lattice (many equally near ones),
 * crowded, on a line, all at one place; with some refused. */
#include "check.h"
#include "perigal/cloud.h"
#include <math.h>

enum { N = 700, PLACES = 300 };

/* Numbers in [0, 1) that are the same on every machine. */
static double number (unsigned long *seed)
{
    *seed = *seed * 6364136223846793005ul + 1442695040888963407ul;
    return (double) (*seed >> 11) / 9007199254740992.0;
}

static int refuse_odd (void *context, const double *place, size_t i)
{
    (void) context, (void) place;
    return i % 2 == 1;
}

static int refuse_all (void *context, const double *place, size_t i)
{
    (void) context, (void) place, (void) i;
    return 1;
}

static long by_comparison (int dim, size_t n, const double *x, const double *place, pg_refuse refuse)
{
    long best = -1;
    double least = INFINITY;
    for (size_t i = 0; i < n; i++) {
        double d = 0;
        if (refuse && refuse (NULL, place, i)) continue;
        for (int k = 0; k < dim; k++) {
            double step = x[i * (size_t) dim + (size_t) k] - place[k];
            d += step * step;
        }
        if (d < least) least = d, best = (long) i;
    }
    return best;
}

/* Kinds of points: 0 random, 1 lattice, 2 crowded at a corner, 3 on a line, 4 all at one place. */
static void fill (int dim, int kind, double *x, unsigned long *seed)
{
    for (size_t i = 0; i < N; i++)
        for (int k = 0; k < dim; k++) {
            double *v = &x[i * (size_t) dim + (size_t) k], u = number (seed);
            if (kind == 0) *v = u;
            else if (kind == 1) *v = floor (9 * u);
            else if (kind == 2) *v = pow (u, 6);
            else if (kind == 3) *v = k ? 0.5 : u;
            else *v = 0.25;
        }
}

static void equals_a_comparison_with_all_points (void **state)
{
    (void) state;
    unsigned long seed = 7;
    double x[3 * N];
    for (int dim = 1; dim <= 3; dim++)
        for (int kind = 0; kind < 5; kind++) {
            pg_nearest *nearest = NULL;
            fill (dim, kind, x, &seed);
            check_ok (pg_nearest_create (&nearest, dim, N, x));
            for (int p = 0; p < PLACES; p++) {
                double place[3];
                for (int k = 0; k < 3; k++) place[k] = 3 * number (&seed) - 1;
                if (kind == 1) for (int k = 0; k < 3; k++) place[k] = floor (4 * place[k]) + 0.5 * (p % 2);
                assert_int_equal (pg_nearest_find (nearest, place, NULL, NULL),
                                  by_comparison (dim, N, x, place, NULL));
                assert_int_equal (pg_nearest_find (nearest, place, refuse_odd, NULL),
                                  by_comparison (dim, N, x, place, refuse_odd));
            }
            double middle[3] = { 0.5, 0.5, 0.5 }, nowhere[3] = { NAN, 0, 0 };
            assert_int_equal (pg_nearest_find (nearest, middle, refuse_all, NULL), -1);
            assert_int_equal (pg_nearest_find (nearest, nowhere, NULL, NULL), -1);
            pg_nearest_free (&nearest);
        }
}

static void no_points_are_refused (void **state)
{
    (void) state;
    pg_nearest *nearest = NULL;
    double x[2] = { 0, 0 };
    assert_int_equal (pg_nearest_create (&nearest, 2, 0, x), PG_E_USAGE);
    assert_null (nearest);
    pg_nearest_free (&nearest);
}

static void failing_allocations_leave_nothing (void **state)
{
    (void) state;
    double x[20] = { 0 };
    for (size_t k = 1; k < 10; k++) {
        pg_nearest *nearest = NULL;
        size_t used = pg_memory_used ();
        pg_memory_fail_at (k);
        pg_status status = pg_nearest_create (&nearest, 2, 10, x);
        pg_memory_fail_at (0);
        pg_nearest_free (&nearest);
        assert_int_equal (pg_memory_used (), used);
        if (status == PG_OK) return;
        assert_int_equal (status, PG_E_MEMORY);
    }
    fail ();
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (equals_a_comparison_with_all_points),
        cmocka_unit_test (no_points_are_refused),
        cmocka_unit_test (failing_allocations_leave_nothing),
    };
    return cmocka_run_group_tests_name ("geometry/cloud/nearest", tests, NULL, NULL);
}
