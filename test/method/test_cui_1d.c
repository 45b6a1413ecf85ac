/* SPDX-License-Identifier: GPL-3.0-or-later
 * The bar of Cui 2022 section 2.4 (theory E4, table H E-10): consistency of u and u', balance under constant
 * stress, error of -u'' = 1, for RKPM and PDDO; and the same bar as an ordinary scene. */
#include "check.h"
#include "perigal.h"
#include "../../bench/cui_1d.h"

static const double a_over_D[4] = { 1.5, 2, 2.5, 3 };

static bar make (const char *approximation, size_t cells, double L, double a)
{
    bar b;
    check_ok (bar_create (&b, approximation, cells, L, a));
    return b;
}

/* ---- figure 1 ------------------------------------------------------------------------------------------ */
enum { PLACES = 1001 };
static pg_rows sampled (const bar *b)
{
    double x[PLACES];
    pg_rows r;
    for (size_t k = 0; k < PLACES; k++) x[k] = b->L * (double) k / (PLACES - 1);
    check_ok (bar_rows_at (&r, b, PLACES, x, NULL));
    return r;
}

static void linear_field_and_slope_are_exact (void **state)
{
    (void) state;
    const char *const type[2] = { "rkpm", "pddo" };
    for (int k = 0; k < 8; k++) {
        bar b = make (type[k % 2], 10, 10, a_over_D[k / 2]);
        pg_rows r = sampled (&b);
        for (size_t q = 0; q < r.n; q++) {
            double u = 0, slope = 0;
            for (size_t e = r.family.start[q]; e < r.family.start[q + 1]; e++)
                u += r.N[e] * b.cloud.x[r.family.node[e]], slope += r.dN[e] * b.cloud.x[r.family.node[e]];
            check_below (fabs (u - r.x[q]) / b.L, 1e-14);
            check_below (fabs (slope - 1), 2e-14);
        }
        pg_rows_clear (&r);
        bar_clear (&b);
    }
}

/* Both reproduce a line, and yet are not the same: max |N,x (RK) - N,x (PDDO)|, D = 1. */
static void the_two_derivatives_differ (void **state)
{
    (void) state;
    static const double expected[4] = { .0424, .0938, .1474, .2087 };
    for (int k = 0; k < 4; k++) {
        bar b = make ("rkpm", 10, 10, a_over_D[k]), c = make ("pddo", 10, 10, a_over_D[k]);
        pg_rows r = sampled (&b), s = sampled (&c);
        double most = 0;
        assert_int_equal (r.family.start[r.n], s.family.start[s.n]);
        for (size_t e = 0; e < r.family.start[r.n]; e++) most = fmax (most, fabs (r.dN[e] - s.dN[e]));
        check_relative (most, expected[k], 0.01);
        pg_rows_clear (&r), pg_rows_clear (&s);
        bar_clear (&b), bar_clear (&c);
    }
}

/* ---- figure 2 ------------------------------------------------------------------------------------------ */
static void balance_under_constant_stress (void **state)
{
    (void) state;
    static const int points[3] = { 0, 2, 5 };
    static const double expected[3][3][2] = {  /* a = 2, 2.5, 3; nodal, 2, 5 points; RK, PDDO (0: rounding) */
        { { 0, 0 }, { 3.238e-3, 8.463e-3 }, { 1.065e-5, 1.251e-2 } },
        { { 6.142e-2, 3.701e-2 }, { 7.500e-4, 8.714e-2 }, { 2.009e-5, 8.682e-2 } },
        { { 6.602e-2, 8.138e-2 }, { 6.189e-4, 1.283e-1 }, { 1.305e-5, 1.288e-1 } } };
    for (int a = 0; a < 3; a++)
        for (int p = 0; p < 3; p++)
            for (int t = 0; t < 2; t++) {
                bar b = make (t ? "pddo" : "rkpm", 10, 1, a_over_D[a + 1]);
                double off = NAN;
                check_ok (bar_imbalance (&b, points[p], &off));
                if (expected[a][p][t] == 0) check_below (off, 1e-14);
                else check_relative (off, expected[a][p][t], 0.01);
                bar_clear (&b);
            }
}

/* ---- figure 3 ------------------------------------------------------------------------------------------ */
static const struct { double a; int points; double rk[4], pddo[4]; } errors[6] = {
    { 2,   0, { 2.203e-3, 5.68e-4, 1.44e-4, 3.63e-5 }, { 2.203e-3, 5.68e-4, 1.44e-4, 3.63e-5 } },
    { 2,   2, { 4.156e-4, 9.41e-5, 2.62e-5, 8.43e-6 }, { 6.83e-4, 1.91e-4, 5.96e-5, 1.98e-5 } },
    { 2.5, 0, { 4.56e-3, 1.98e-3, 1.01e-3, 5.23e-4 },  { 2.68e-3, 9.9e-4, 4.6e-4, 2.3e-4 } },
    { 2.5, 2, { 2.11e-4, 5.23e-5, 1.37e-5, 3.91e-6 },  { 1.16e-2, 4.99e-3, 2.26e-3, 1.06e-3 } },
    { 3,   0, { 1.09e-2, 6.57e-3, 3.58e-3, 1.86e-3 },  { 1.21e-2, 6.2e-3, 3.1e-3, 1.55e-3 } },
    { 3,   2, { 1.81e-4, 5.40e-5, 1.67e-5, 5.40e-6 },  { 6.31e-2, 3.12e-2, 1.53e-2, 7.57e-3 } },
};

static void check_column (const char *type, int pddo)
{
    for (int row = 0; row < 6; row++)
        for (int k = 0; k < 4; k++) {
            bar b = make (type, (size_t) 10 << k, 1, errors[row].a);
            double error = NAN, expected = (pddo ? errors[row].pddo : errors[row].rk)[k];
            double tolerance = expected == 2.3e-4 ? 0.05 / 2.3 : 0.01;  /* printed with two digits */
            check_ok (bar_error (&b, errors[row].points, &error));
            check_relative (error, expected, tolerance);
            bar_clear (&b);
        }
}

static void rkpm_errors (void **state) { (void) state; check_column ("rkpm", 0); }
static void pddo_errors (void **state) { (void) state; check_column ("pddo", 1); }

/* ---- as a scene ---------------------------------------------------------------------------------------- */
/* Coefficients of the static solution of a scene (n of them). */
static void solve_scene (pg_scene *scene, size_t n, double *d)
{
    pg_problem *problem = NULL;
    pg_solver *solver = NULL;
    pg_state *state = NULL;
    pg_solver_options options;
    pg_step step;
    check_ok (pg_problem_build (&problem, scene, 1));
    check_ok (pg_solver_options_read (&options, problem, scene));
    check_ok (pg_solver_create (&solver, problem, &options));
    check_ok (pg_state_create (&state, problem, pg_solver_components (solver)));
    while (!pg_solver_done (solver, state)) check_ok (pg_solver_step (solver, state, &step));
    assert_int_equal (state->ndof, n);
    memcpy (d, state->d, n * sizeof *d);
    pg_state_free (&state);
    pg_solver_free (&solver);
    pg_problem_free (&problem);
}

/* Elimination in the library = Lagrange multiplier here, every scheme of figure 3. */
static void a_scene_gives_the_same_bar (void **state)
{
    (void) state;
    for (int k = 0; k < 12; k++) {
        int points = errors[k / 2].points;
        double d[21], e[22], worst = 0;
        char text[1024];
        pg_scene *scene = NULL;
        bar b = make (k % 2 ? "pddo" : "rkpm", 20, 1, errors[k / 2].a);
        snprintf (
            text, sizeof text,
            "dimension: 1\nbody: [{add: {box: {low: [0], high: [1 m]}}}]\nspacing: 0.05 m\nmaterials: {m: "
            "{youngs_modulus: 1 Pa, poissons_ratio: 0}}\n"
            "method: {approximation: %s, weights: unit, horizon: %g spacing, essential: transformation, %s}\n"
            "boundary: [{set: left, displacement: {x: 0}}, {set: all, body_force: {x: 1 N/m3}}]\nsolver: "
            "{steps: 1}\noutput: {at: {levels: 1}}\n",
            k % 2 ? "pddo" : "rkpm", errors[k / 2].a,
            points ? "integration: gauss, gauss_points: 2" : "integration: nodal");
        check_ok (pg_scene_parse (&scene, text, "bar.yaml"));
        solve_scene (scene, 21, d);
        check_ok (bar_solve (&b, points, e));
        for (int i = 0; i < 21; i++) worst = fmax (worst, fabs (d[i] - e[i]));
        check_below (worst, 1e-11);
        bar_clear (&b);
        pg_scene_free (&scene);
    }
}

static void the_data_scene_has_the_error_of_the_figure (void **state)
{
    (void) state;
    double d[11], error = NAN;
    pg_scene *scene = NULL;
    bar b = make ("rkpm", 10, 1, 2.5);
    check_ok (pg_scene_load (&scene, "data/cui_1d/scene.yaml"));
    solve_scene (scene, 11, d);
    check_ok (bar_error_of (&b, d, &error));
    check_relative (error, 2.11e-4, 0.01);
    bar_clear (&b);
    pg_scene_free (&scene);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (linear_field_and_slope_are_exact),
        cmocka_unit_test (the_two_derivatives_differ),
        cmocka_unit_test (balance_under_constant_stress),
        cmocka_unit_test (rkpm_errors),
        cmocka_unit_test (pddo_errors),
        cmocka_unit_test (a_scene_gives_the_same_bar),
        cmocka_unit_test (the_data_scene_has_the_error_of_the_figure),
    };
    return cmocka_run_group_tests_name ("method/cui_1d", tests, NULL, NULL);
}
