/* SPDX-License-Identifier: GPL-3.0-or-later
 * Points, shape functions, constants and forces of bonds from plain arrays. */
#include "check.h"
#include "perigal/session.h"

enum { EDGE = 7, N = EDGE * EDGE };
static double grid[2 * N];

static int start (void **state)
{
    (void) state;
    for (int i = 0; i < N; i++) grid[2 * i] = 1e-3 * (i % EDGE), grid[2 * i + 1] = 1e-3 * (i / EDGE);
    return 0;
}

static void test_points (void **state)
{
    (void) state;
    pg_cloud c;
    double volume[N], bad[2 * N];
    check_ok (pg_cloud_of_arrays (&c, 2, N, grid, NULL, 1e-3, 5e-3));
    check_relative (c.volume[3], 5e-9, 1e-15);
    assert_true (c.h == 1e-3 && c.low[0] == 0 && c.high[1] == grid[2 * N - 1] && c.n == N);
    pg_cloud_clear (&c);
    for (int i = 0; i < N; i++) volume[i] = i % 2 ? 1e-9 : 3e-9;
    check_ok (pg_cloud_of_arrays (&c, 2, N, grid, volume, 0, 1e-3));
    check_relative (c.h, sqrt (1e-6 * (3 * 25 + 24) / 49), 1e-14);
    assert_true (c.volume[4] == 3e-9);
    pg_cloud_clear (&c);
    check_fails (pg_cloud_of_arrays (&c, 2, N, grid, NULL, 0, 1), PG_E_USAGE);
    check_fails (pg_cloud_of_arrays (&c, 4, 1, grid, NULL, 1, 1), PG_E_USAGE);
    check_fails (pg_cloud_of_arrays (&c, 2, 0, grid, NULL, 1, 1), PG_E_USAGE);
    check_fails (pg_cloud_of_arrays (&c, 2, N, grid, NULL, 1, 0), PG_E_USAGE);
    volume[7] = 0;
    check_fails (pg_cloud_of_arrays (&c, 2, N, grid, volume, 1, 1), PG_E_USAGE);
    check_contains (pg_last_error (), "point 8");
    memcpy (bad, grid, sizeof bad);
    bad[2] = -0.0, bad[3] = 0;                         /* the place of the first point */
    check_fails (pg_cloud_of_arrays (&c, 2, N, bad, NULL, 1, 1), PG_E_USAGE);
    check_contains (pg_last_error (), "points 1 and 2 are at the same place");
    bad[5] = INFINITY;
    check_fails (pg_cloud_of_arrays (&c, 2, N, bad, NULL, 1, 1), PG_E_USAGE);
    check_contains (pg_last_error (), "coordinate 2 of point 3");
}

/* x^a y^b at a place by shape functions. */
static double field (const pg_rows *r, size_t i, int a, int b)
{
    double sum = 0;
    for (size_t e = r->family.start[i]; e < r->family.start[i + 1]; e++) {
        const double *x = grid + 2 * (size_t) r->family.node[e];
        sum += r->N[e] * pow (x[0] / 1e-3, a) * pow (x[1] / 1e-3, b);
    }
    return sum;
}

static void test_shapes (void **state)
{
    (void) state;
    pg_cloud c;
    pg_rows r;
    const double place[] = { 2.3e-3, 3.6e-3, 4.1e-3, 1.9e-3 };
    pg_shape_choice o = { .order = 2, .horizon = 3e-3 };
    check_ok (pg_cloud_of_arrays (&c, 2, N, grid, NULL, 1e-3, 1));
    check_ok (pg_shape_functions (&r, &o, &c, 2, place, NULL, 1));
    for (size_t i = 0; i < 2; i++)
        check_relative (field (&r, i, 1, 1), place[2 * i] * place[2 * i + 1] / 1e-6, 1e-12);
    pg_rows_clear (&r);
    pg_shape_choice own = { .approximation = "nosb", .order = 1, .horizon = 2.5e-3, .weights = "unit" };
    check_ok (pg_shape_functions (&r, &own, &c, 0, NULL, NULL, 1));
    assert_int_equal (r.n, N);
    for (size_t i = 0; i < N; i++) check_scaled (field (&r, i, 2, 0), pow ((double) (i % EDGE), 2), 1e-13, 1);
    pg_rows_clear (&r);
    const struct { pg_shape_choice o; const char *says; } wrong[] = {
        { { .approximation = "fem", .order = 1, .horizon = 3e-3 }, "rkpm" },
        { { .kernel = "box", .order = 1, .horizon = 3e-3 }, "cubic_spline" },
        { { .support = "round", .order = 1, .horizon = 3e-3 }, "radial|tensor" },
        { { .weights = "none", .order = 1, .horizon = 3e-3 }, "auto|unit|volume" },
        { { .degenerate = "projected", .order = 2, .horizon = 3e-3 }, "linear basis" },
        { { .order = 3, .horizon = 3e-3 }, "order" },
        { { .order = 1, .horizon = 0.9e-3 }, "no neighbour" },
    };
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
        check_fails (pg_shape_functions (&r, &wrong[k].o, &c, 2, place, NULL, 1), PG_E_USAGE);
        check_contains (pg_last_error (), wrong[k].says);
        assert_null (r.N);
    }
    pg_cloud_clear (&c);
}

/* On a lattice: the constants that its sums have; of theory: closed forms; a stretch that consumes G0. */
static void test_constants (void **state)
{
    (void) state;
    const double E = 65e9, G = 135, d = 3e-3, pi = acos (-1);
    pg_bond_constants k, h;
    pg_bond_choice o = { .mode = PG_PLANE_STRESS, .horizon = d, .modulus = E, .poisson = 0.25,
                         .thickness = 1e-3, .fracture_energy = G };
    check_ok (pg_bond_constants_find (&k, &o));
    check_relative (k.micromodulus, 9 * E / (pi * 1e-3 * d * d * d), 1e-13);
    check_relative (k.stretch, sqrt (4 * pi * G / (9 * E * d)), 1e-12);
    assert_true (isnan (k.growth) && k.calibration == 1 && k.toughness == 1);
    o.spacing = 1e-3;
    check_ok (pg_bond_constants_find (&h, &o));
    check_relative (h.micromodulus, k.micromodulus * h.calibration, 1e-14);
    check_relative (h.stretch, k.stretch / sqrt (h.toughness), 1e-13);
    assert_true (fabs (h.calibration - 1) > 1e-3 && fabs (h.calibration - 1) < 0.05 && h.growth > 1);
    /* G0 of a straight cut by each limit of a beam alone; bending as stiff as Euler's */
    check_relative (h.beam_limit[1] * h.beam_limit[1] * 12, h.beam_limit[2] * h.beam_limit[2], 1e-12);
    assert_true (h.shear > 0 && h.bending == h.shear);
    check_relative (h.energy, G / (2 * d), 1e-15);
    o.poisson = 0.4;
    check_ok (pg_bond_constants_find (&h, &o));
    assert_true (isnan (h.shear) && isfinite (h.state_stretch));
    o.mode = PG_LINE, o.spacing = 0, o.fracture_energy = 0;
    check_ok (pg_bond_constants_find (&h, &o));
    assert_true (h.micromodulus > 0 && isnan (h.stretch) && isnan (h.axial));
    o.kernel = "box";
    check_fails (pg_bond_constants_find (&h, &o), PG_E_USAGE);
    o.kernel = NULL, o.spacing = 4e-3;
    check_fails (pg_bond_constants_find (&h, &o), PG_E_USAGE);
    o.spacing = 1e-5;
    check_fails (pg_bond_constants_find (&h, &o), PG_E_USAGE);
    check_contains (pg_last_error (), "leave out the spacing");
}

/* Of every kernel, closed at the horizon or open: what the bonds of a scene have on the same lattice,
 * alone and as beams. */
static void test_constants_of_scenes (void **state)
{
    const double E = 65e9, G = 135;
    int open = 0;
    (void) state;
    for (size_t i = 0; pg_kernel_entry (i); i++)
        for (int dim = 2; dim <= 3; dim++)
            for (int beams = 0; beams < 2; beams++) {
                const pg_kernel *kernel = pg_kernel_entry (i);
                char text[900];
                pg_scene *scene = NULL;
                pg_problem *p = NULL;
                snprintf (text, sizeof text,
                          "dimension: %d\n%sbody: [{add: {box: {low: [0, 0%s], high: [8 mm, 8 "
                              "mm%s]}}}]\nspacing: 1 mm\n"
                          "materials: {m: {youngs_modulus: 65 GPa, poissons_ratio: %s}}\n"
                          "method: {force: %s, kernel: %s, horizon: 2.5 spacing}\n"
                          "boundary: [{set: bottom, displacement: {x: 0}}]\n",
                          dim, dim == 2 ? "plane: stress\nthickness: 1 mm\n" : "", dim == 2 ? "" : ", 0",
                          dim == 2 ? "" : ", 8 mm", beams ? "0.2" : dim == 2 ? "0.3333333333333333" : "0.25",
                          beams ? "gmpd" : "bond", kernel->name);
                if (pg_scene_parse (&scene, text, "lattice.yaml") != PG_OK
                    || pg_problem_build (&p, scene, 1) != PG_OK) {
                    /* too singular for the shear of beams: then session has none either */
                    check_contains (pg_last_error (), kernel->name);
                    pg_scene_free (&scene);
                    continue;
                }
                double nu = p->material[0].nu, axial, shear;
                pg_bond_choice o = { .mode = p->mode, .kernel = kernel->name, .horizon = 2.5e-3, .modulus = E,
                                     .spacing = 1e-3, .thickness = dim == 2 ? 1e-3 : 1, .poisson = nu,
                                     .fracture_energy = G };
                pg_bond_constants k;
                check_ok (pg_bond_constants_find (&k, &o));
                assert_true (k.calibration != 1 && fabs (k.calibration - 1) < 0.6);
                check_relative (k.calibration, p->sums->calibration, 1e-12);
                if (!beams) check_relative (k.toughness, pg_sums_toughness (p->sums, E, nu), 1e-12);
                if (beams) {
                    pg_beam_sums sums;
                    check_ok (pg_beam_measure (&sums, p->sums));
                    check_ok (pg_beam_moduli (&axial, &shear, p->mode, kernel, 2.5e-3, E, nu, o.thickness));
                    assert_true (sums.calibration != 1);
                    check_relative (k.axial, p->sums->calibration * axial, 1e-12);
                    check_relative (k.shear, sums.calibration * shear, 1e-12);
                }
                open += !kernel->closed;
                pg_problem_free (&p), pg_scene_free (&scene);
            }
    assert_true (open > 8);
}

static void test_bond_sums (void **state)
{
    (void) state;
    pg_cloud c;
    pg_bond_sum *s;
    double u[2 * N], f[2 * N], W[N], modulus, total = 0, most = 0;
    const unsigned char *alive;
    unsigned char mask[N * 40];
    pg_sum_rule rule = { .mode = PG_PLANE_STRESS, .kernel = pg_kernel_find ("constant"), .horizon = 2e-3,
                         .threads = 1, .calibrate = 1 };
    check_ok (pg_cloud_of_arrays (&c, 2, N, grid, NULL, 1e-3, 1e-3));
    check_ok (pg_bond_sum_create (&s, &c, &rule, 1e21));
    pg_cloud_clear (&c);                               /* it was copied */
    for (int i = 0; i < 2 * N; i++) u[i] = 1e-6 * sin (7 * i);
    check_ok (pg_bond_sum_force (s, u, f, W));
    const pg_family *family = pg_bond_sum_family (s, &alive);
    size_t n = family->start[N];
    double *xi = pg_calloc (2 * n, sizeof *xi), *w = pg_calloc (n, sizeof *w);
    pg_bond_sum_bonds (s, xi, w, NULL, &modulus);
    for (int i = 0; i < 2 * N; i++) most = fmax (most, fabs (f[i]));
    for (size_t i = 0; i < N; i++) {
        double g[2] = { 0, 0 };
        for (size_t e = family->start[i]; e < family->start[i + 1]; e++) {
            const double *x = xi + 2 * e, *a = u + 2 * i, *b = u + 2 * (size_t) family->node[e];
            double r2 = x[0] * x[0] + x[1] * x[1], r = sqrt (r2),
                   t = modulus * w[e] * (x[0] * (b[0] - a[0]) + x[1] * (b[1] - a[1])) / r2 * 1e-18;
            g[0] += t * x[0] / r, g[1] += t * x[1] / r;
        }
        check_scaled (f[2 * i], g[0], 1e-12, most);
        check_scaled (f[2 * i + 1], g[1], 1e-12, most);
        total += W[i] * 1e-9;
    }
    double work = 0;
    for (int i = 0; i < 2 * N; i++) work -= 0.5 * f[i] * u[i];
    check_relative (total, work, 1e-12);
    memset (mask, 1, sizeof mask);
    mask[0] = 0;                                       /* one direction of one bond */
    check_ok (pg_bond_sum_mask (s, mask));
    size_t dead = 0;
    for (size_t e = 0; e < n; e++) dead += !alive[e];
    assert_int_equal (dead, 2);
    u[9] = NAN;
    check_fails (pg_bond_sum_force (s, u, f, NULL), PG_E_USAGE);
    pg_bond_sum_free (&s);
    check_ok (pg_cloud_of_arrays (&c, 2, N, grid, NULL, 1e-3, 1e-3));
    check_fails (pg_bond_sum_create (&s, &c, &rule, 0), PG_E_USAGE);
    rule.state = 1;
    check_fails (pg_bond_sum_create (&s, &c, &rule, 1), PG_E_USAGE);
    assert_null (s);
    pg_cloud_clear (&c), pg_free (xi), pg_free (w);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (test_points),
        cmocka_unit_test (test_shapes),
        cmocka_unit_test (test_constants),
        cmocka_unit_test (test_constants_of_scenes),
        cmocka_unit_test (test_bond_sums),
    };
    return cmocka_run_group_tests (tests, start, NULL);
}
