/* SPDX-License-Identifier: GPL-3.0-or-later
 * Families against brute force, open and closed ends, awkward clouds. */
#include "check.h"
#include "perigal/cloud.h"
#include <stdlib.h>

static double next (uint32_t *seed)
{
    *seed = *seed * 1664525u + 1013904223u;
    return (*seed >> 8) / 16777216.0;
}

static int in_family (int dim, const double *c, const double *x, double reach, int shape, int closed)
{
    double sum = 0, most = 0;
    for (int k = 0; k < dim; k++)
        sum += (x[k] - c[k]) * (x[k] - c[k]), most = fmax (most, fabs (x[k] - c[k]));
    double d = shape == PG_RADIAL ? sqrt (sum) : most;
    return closed ? d <= reach * (1 + 1e-9) : d < reach * (1 - 1e-9);
}

static void same_as_brute_force (int dim, size_t n, double *x, size_t m, const double *centre, double reach)
{
    pg_cloud cloud = {.dim = dim, .n = n, .x = x};
    for (int how = 0; how < 4; how++) {
        pg_family f;
        check_ok (pg_family_build (&f, &cloud, m, centre, reach, how % 2, how / 2));
        assert_int_equal (f.n, m);
        assert_int_equal (f.start[0], 0);
        for (size_t i = 0; i < m; i++) {
            size_t e = f.start[i];
            for (size_t j = 0; j < n; j++) {
                if (!in_family (dim, centre + i * (size_t) dim, x + j * (size_t) dim, reach, how % 2,
                                how / 2))
                    continue;
                assert_true (e < f.start[i + 1]);
                assert_int_equal (f.node[e++], j);
            }
            assert_int_equal (e, f.start[i + 1]);
        }
        pg_family_clear (&f);
    }
}

static void random_clouds_match_brute_force (void **state)
{
    (void) state;
    uint32_t seed = 7;
    for (int dim = 1; dim <= 3; dim++) {
        double x[900], c[150];
        for (int i = 0; i < 900; i++) x[i] = next (&seed);
        for (int i = 0; i < 150; i++) c[i] = 1.4 * next (&seed) - 0.2;  /* some centres outside the cloud */
        same_as_brute_force (dim, 900 / (size_t) dim, x, 150 / (size_t) dim, c,
                             dim == 1   ? 0.02
                             : dim == 2 ? 0.1
                                        : 0.3);
    }
}

/* Centres in one place amid the cloud, or a few side by side, whose box leaves most points out at once. */
static void few_centres_match_brute_force (void **state)
{
    (void) state;
    uint32_t seed = 17;
    for (int dim = 1; dim <= 3; dim++)
        for (size_t m = 1; m <= 4; m++) {
            double x[1200], c[12];
            for (int i = 0; i < 1200; i++) x[i] = next (&seed);
            for (int i = 0; i < 12; i++) c[i] = 0.45 + 0.1 * next (&seed);
            same_as_brute_force (dim, 1200 / (size_t) dim, x, m, c, dim == 1 ? 0.05 : dim == 2 ? 0.15 : 0.3);
        }
}

static void lattice_points_lie_on_cell_borders (void **state)
{
    (void) state;
    double x[3 * 512], reach[] = {0.1, 0.2, 0.3 * sqrt (2), 0.1 * sqrt (3)};
    size_t n = 0;
    for (int c = 0; c < 8; c++) for (int b = 0; b < 8; b++) for (int a = 0; a < 8; a++, n++)
        x[3*n] = 0.1 * a, x[3*n + 1] = 0.1 * b, x[3*n + 2] = 0.1 * c;
    for (int k = 0; k < 4; k++) same_as_brute_force (3, n, x, n, x, reach[k]);
}

static void clusters_and_flat_clouds_match_brute_force (void **state)
{
    (void) state;
    uint32_t seed = 3;
    double x[600];
    for (int i = 0; i < 600; i++) x[i] = i < 400 ? 1e-4 * next (&seed) : 1e3 * next (&seed);
    same_as_brute_force (2, 300, x, 300, x, 3e-5);
    same_as_brute_force (2, 300, x, 300, x, 1e4);
    for (int i = 1; i < 600; i += 2) x[i] = 5;                 /* all on one line */
    same_as_brute_force (2, 300, x, 300, x, 2e-5);
    for (int i = 0; i < 600; i++) x[i] = 1;                    /* all in one place */
    same_as_brute_force (3, 200, x, 200, x, 1);
    same_as_brute_force (3, 200, x, 200, x, 0);
}

/* Point j reaches centres within reach * size[j] / h of it; sizes over three decades. */
static void own_reaches_match_brute_force (void **state)
{
    (void) state;
    uint32_t seed = 11;
    for (int dim = 1; dim <= 3; dim++)
        for (int how = 0; how < 4; how++) {
            size_t n = 300, d = (size_t) dim;
            double x[900], size[300], reach = 0.04;
            for (size_t i = 0; i < n * d; i++) x[i] = i < n * d / 2 ? 1e-2 * next (&seed) : next (&seed);
            for (size_t i = 0; i < n; i++)
                size[i] = pow (10, 3 * next (&seed) - 2), x[i * d] = i % 7 ? x[i * d] : 0.25;
            pg_cloud cloud = {.dim = dim, .n = n, .x = x, .size = size, .h = 0.5};
            pg_family f;
            size_t bonds = 0, single = 0;
            check_ok (pg_family_build (&f, &cloud, n, x, reach, how % 2, how / 2));
            for (size_t i = 0; i < n; i++) {
                size_t e = f.start[i];
                for (size_t j = 0; j < n; j++) {
                    if (!in_family (dim, x + i * d, x + j * d, reach * (size[j] / 0.5), how % 2, how / 2))
                        continue;
                    assert_true (e < f.start[i + 1]);
                    assert_int_equal (f.node[e++], j);
                    bonds++, single += !in_family (dim, x + j * d, x + i * d, reach * (size[i] / 0.5),
                                                   how % 2, how / 2);
                }
                assert_int_equal (e, f.start[i + 1]);
            }
            assert_true (bonds > 3 * n && single > n);
            pg_family_clear (&f);
        }
}

/* Ellipses of any direction, by boxes and by the tree (scattered: boxes would mostly be empty). */
static void anisotropic_reaches_match_brute_force (void **state)
{
    (void) state;
    uint32_t seed = 17;
    for (int dim = 2; dim <= 3; dim++)
        for (int how = 0; how < 4; how++) {
            size_t n = 300, d = (size_t) dim, bonds = 0, balls = 0;
            int scattered = how % 2, closed = how / 2;
            double x[900], size[300], metric[2700] = { 0 }, reach = 0.3;
            for (size_t i = 0; i < n * d; i++)
                x[i] = (scattered && i >= n * d / 2 ? 1e4 : 0) + next (&seed);
            for (size_t i = 0; i < n; i++) {
                double v[3];
                size[i] = 0.5 + next (&seed);
                for (size_t k = 0; k < d; k++) v[k] = 4 * next (&seed) - 2;
                for (size_t k = 0; k < d * d; k++)
                    metric[i * d * d + k] = (k / d == k % d) + v[k / d] * v[k % d];
            }
            pg_cloud cloud = {.dim = dim, .n = n, .x = x, .size = size, .metric = metric, .h = 1};
            pg_family f;
            if (scattered) cloud.h = 1e-3, reach *= 1e-3;
            check_ok (pg_family_build (&f, &cloud, n, x, reach, PG_RADIAL, closed));
            for (size_t i = 0; i < n; i++) {
                size_t e = f.start[i];
                for (size_t j = 0; j < n; j++) {
                    double z[3], sum = 0, far = reach * size[j] / cloud.h;
                    for (size_t k = 0; k < d; k++) z[k] = x[j * d + k] - x[i * d + k];
                    for (size_t k = 0; k < d * d; k++) sum += metric[j * d * d + k] * z[k / d] * z[k % d];
                    balls += in_family (dim, x + i * d, x + j * d, far, PG_RADIAL, closed);
                    if (!(sqrt (sum) < far)) continue;
                    assert_true (e < f.start[i + 1]);
                    assert_int_equal (f.node[e++], j);
                    bonds++;
                }
                assert_int_equal (e, f.start[i + 1]);
            }
            assert_true (bonds > 2 * n && balls > bonds + n);
            pg_family_clear (&f);
        }
}

/* Boxes of the spacing given would be 1e12: the tree finds the same families. */
static void points_too_scattered_for_boxes_match_brute_force (void **state)
{
    (void) state;
    uint32_t seed = 5;
    double x[600];
    for (int i = 0; i < 600; i++) x[i] = (i < 300 ? 0 : 1e3) + 1e-3 * next (&seed);
    pg_cloud cloud = {.dim = 2, .n = 300, .x = x, .h = 1e-4};
    pg_family f;
    size_t bonds = 0;
    check_ok (pg_family_build (&f, &cloud, 300, x, 2e-4, PG_RADIAL, 0));
    for (size_t i = 0; i < 300; i++)
        for (size_t j = 0, e = f.start[i]; j < 300; j++) {
            if (!in_family (2, x + 2 * i, x + 2 * j, 2e-4, PG_RADIAL, 0)) continue;
            assert_true (e < f.start[i + 1]);
            assert_int_equal (f.node[e++], j);
            bonds++;
        }
    assert_int_equal (bonds, f.start[300]);
    assert_true (bonds > 1000);
    pg_family_clear (&f);
}

/* Points sorted once and centres in two lots, on one thread and on four: the families of one call. */
static void lots_and_threads_find_the_same_families (void **state)
{
    (void) state;
    uint32_t seed = 13;
    enum { N = 1000, LOT = 300 };
    double x[3 * N], size[N];
    for (int i = 0; i < 3 * N; i++) x[i] = next (&seed);
    for (int i = 0; i < N; i++) size[i] = 0.05 + 0.1 * next (&seed);
    for (int graded = 0; graded < 2; graded++) {
        pg_cloud cloud = {.dim = 3, .n = N, .x = x, .h = 0.1, .size = graded ? size : NULL};
        pg_family all, lot;
        pg_family_search *search = NULL;
        check_ok (pg_family_build (&all, &cloud, N, x, 0.2, PG_RADIAL, 1));
        check_ok (pg_family_search_create (&search, &cloud, 0.2, PG_RADIAL, 1));
        for (size_t first = 0; first < N; first += LOT) {
            size_t n = N - first < LOT ? N - first : LOT, bonds = all.start[first + n] - all.start[first];
            check_ok (pg_family_find (&lot, search, n, x + 3 * first, first ? 4 : 1));
            for (size_t i = 0; i <= n; i++)
                assert_int_equal (lot.start[i], all.start[first + i] - all.start[first]);
            assert_memory_equal (lot.node, all.node + all.start[first], bonds * sizeof *lot.node);
            pg_family_clear (&lot);
        }
        pg_family_search_free (&search);
        pg_family_clear (&all);
    }
}

static void an_end_exactly_at_the_reach_counts_only_when_closed (void **state)
{
    (void) state;
    double x[11];
    for (int i = 0; i < 11; i++) x[i] = 0.1 * i;                /* 0.1 * 3 != 0.3: rounding must not decide */
    pg_cloud cloud = {.dim = 1, .n = 11, .x = x};
    pg_family f;
    check_ok (pg_family_build (&f, &cloud, 11, x, 0.3, PG_RADIAL, 1));
    for (size_t i = 3; i < 8; i++) assert_int_equal (f.start[i + 1] - f.start[i], 7);
    pg_family_clear (&f);
    check_ok (pg_family_build (&f, &cloud, 11, x, 0.3, PG_RADIAL, 0));
    for (size_t i = 3; i < 8; i++) assert_int_equal (f.start[i + 1] - f.start[i], 5);
    pg_family_clear (&f);
}

static void families_do_not_depend_on_the_unit (void **state)
{
    (void) state;
    for (double unit = 1e-12; unit < 1e13; unit *= 1e6) {
        double x[11];
        for (int i = 0; i < 11; i++) x[i] = unit * 0.1 * i;
        pg_cloud cloud = {.dim = 1, .n = 11, .x = x};
        pg_family f;
        check_ok (pg_family_build (&f, &cloud, 11, x, unit * 0.3, PG_RADIAL, 1));
        assert_int_equal (f.start[11], 65);
        pg_family_clear (&f);
    }
}

static void no_centres_and_no_points_are_fine (void **state)
{
    (void) state;
    double x[2] = {0, 0};
    pg_cloud cloud = {.dim = 2, .n = 1, .x = x}, none = {.dim = 2};
    pg_family f;
    check_ok (pg_family_build (&f, &cloud, 0, NULL, 1, PG_RADIAL, 1));
    assert_int_equal (f.start[0], 0);
    pg_family_clear (&f);
    check_ok (pg_family_build (&f, &none, 1, x, 1, PG_RADIAL, 1));
    assert_int_equal (f.start[1], 0);
    pg_family_clear (&f);
}

static void bad_numbers_are_refused (void **state)
{
    (void) state;
    double x[2] = {0, 0}, bad[2] = {0, NAN};
    pg_cloud cloud = {.dim = 2, .n = 1, .x = x};
    pg_family f;
    check_fails (pg_family_build (&f, &cloud, 1, x, NAN, PG_RADIAL, 1), PG_E_USAGE);
    check_fails (pg_family_build (&f, &cloud, 1, x, -1, PG_RADIAL, 1), PG_E_USAGE);
    check_fails (pg_family_build (&f, &cloud, 1, bad, 1, PG_RADIAL, 1), PG_E_USAGE);
    cloud.size = bad, cloud.h = 1;                             /* a spacing of 0 */
    check_fails (pg_family_build (&f, &cloud, 1, x, 1, PG_RADIAL, 1), PG_E_USAGE);
    check_contains (pg_last_error (), "point 0 has the spacing 0 m");
}

static void any_allocation_may_fail (void **state)
{
    (void) state;
    double x[20];
    for (int i = 0; i < 20; i++) x[i] = i;
    pg_cloud cloud = {.dim = 1, .n = 20, .x = x};
    size_t before = pg_memory_used (), k = 0;
    pg_status status = PG_E_MEMORY;
    while (status != PG_OK) {
        pg_family f;
        pg_memory_fail_at (++k);
        status = pg_family_build (&f, &cloud, 20, x, 2, PG_RADIAL, 1);
        pg_memory_fail_at (0);
        if (status == PG_OK) pg_family_clear (&f);
        else assert_int_equal (status, PG_E_MEMORY);
        assert_int_equal (pg_memory_used (), before);
    }
    assert_true (k > 3);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (random_clouds_match_brute_force),
        cmocka_unit_test (few_centres_match_brute_force),
        cmocka_unit_test (lattice_points_lie_on_cell_borders),
        cmocka_unit_test (clusters_and_flat_clouds_match_brute_force),
        cmocka_unit_test (points_too_scattered_for_boxes_match_brute_force),
        cmocka_unit_test (lots_and_threads_find_the_same_families),
        cmocka_unit_test (own_reaches_match_brute_force),
        cmocka_unit_test (anisotropic_reaches_match_brute_force),
        cmocka_unit_test (an_end_exactly_at_the_reach_counts_only_when_closed),
        cmocka_unit_test (families_do_not_depend_on_the_unit),
        cmocka_unit_test (no_centres_and_no_points_are_fine),
        cmocka_unit_test (bad_numbers_are_refused),
        cmocka_unit_test (any_allocation_may_fail),
    };
    return cmocka_run_group_tests_name ("geometry/cloud/family", tests, NULL, NULL);
}
