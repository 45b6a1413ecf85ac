/* SPDX-License-Identifier: GPL-3.0-or-later
 * How limits from a fracture energy allow for cracks that grow bond by bond: the measured factor on the
 * lattices on which it was measured, linear between horizons, the formula elsewhere; and what a scene and its
 * plan make of it. */
#include <math.h>
#include <string.h>
#include "scene_runs/run.h"

#define SQUARE "dimension: 2\nthickness: 1\nbody: [{add: {box: {low: [0, 0], high: [20, 20]}}}]\n" \
    "spacing: 1\nboundary: [{set: top, displacement: {x: 0, y: 1}}, " \
    "{set: bottom, displacement: {x: 0, y: 0}}]\n" \
    "solver: {kind: static}\n"
#define STONE "materials: {m: {youngs_modulus: 1, poissons_ratio: 0.3333333333333333}}\n"

static pg_growth growth_of (const char *method)
{
    run r = scene_of (1, SQUARE STONE "lattice: cells\nmethod: {%s}\n", method);
    pg_growth g = pg_sums_growth (r.problem->sums);
    clear (&r);
    return g;
}

static void it_is_known_where_it_was_measured (void **state)
{
    static const char *const unknown[] = { "force: bond, kernel: conical", "force: bond, horizon: 2 spacing",
                                           "force: bond, horizon: 6 spacing", "force: bond, calibrate: off",
                                           "force: lps, kernel: quadratic" };
    pg_growth three = growth_of ("force: bond"), four = growth_of ("force: bond, horizon: 4.015 spacing"),
              between = growth_of ("force: bond, horizon: 3.515 spacing");
    (void) state;
    assert_true (three.mean > four.mean && four.mean > 1);
    assert_true (fabs (between.mean - 0.5 * (three.mean + four.mean)) < 1e-12);
    assert_true (fabs (between.least - 0.5 * (three.least + four.least)) < 1e-12);
    assert_true (three.least < three.mean && three.mean < three.most);
    /* every lattice within 15 % of the mean */
    static const char *const forces[] = { "force: bond", "force: lps", "force: gmpd" };
    for (int k = 0; k < 3; k++) {
        pg_growth g = growth_of (forces[k]);
        assert_true (g.least > 0.85 * g.mean && g.most < 1.15 * g.mean);
    }
    for (size_t k = 0; k < sizeof unknown / sizeof *unknown; k++)
        assert_true (growth_of (unknown[k]).mean == 0);
}

/* The limit with and without it: energies go with the square of the stretch. */
static void limits_allow_for_it (void **state)
{
    double limit[2];
    char text[512];
    pg_growth g = growth_of ("force: bond");
    (void) state;
    for (int theory = 0; theory < 2; theory++) {
        run r = scene_of (1, SQUARE STONE "lattice: cells\nmethod: {force: bond}\n"
                                          "failure: {criterion: stretch, fracture_energy: 1%s}\n",
                          theory ? ", calibration: theory" : "");
        const pg_criterion *c = r.problem->criterion;
        int told = 0;
        limit[theory] = c->parameter[0];
        pg_criterion_describe (c, text, sizeof text);
        assert_int_equal (strstr (text, "measured growth") != NULL, !theory);
        for (size_t k = 0; k < r.problem->notes.n; k++)
            told |= strstr (r.problem->notes.text[k], "failure.calibration: theory") != NULL;
        assert_int_equal (told, !theory);
        clear (&r);
    }
    assert_true (fabs (limit[1] * limit[1] / (limit[0] * limit[0]) - g.mean) < 1e-12);
}

/* The same of micropolar bonds, all three limits. */
static void those_of_beams_too (void **state)
{
    double limit[2][3];
    pg_growth g = growth_of ("force: gmpd");
    (void) state;
    for (int theory = 0; theory < 2; theory++) {
        run r = scene_of (1,
                          SQUARE "materials: {m: {youngs_modulus: 1, poissons_ratio: 0.2}}\nlattice: cells\n"
                                 "method: {force: gmpd}\n"
                                 "failure: {criterion: beam_limits, fracture_energy: 1, calibration: %s}\n",
                          theory ? "theory" : "measured");
        memcpy (limit[theory], r.problem->criterion->parameter, sizeof limit[theory]);
        clear (&r);
    }
    for (int k = 0; k < 3; k++)
        assert_true (fabs (limit[1][k] * limit[1][k] / (limit[0][k] * limit[0][k]) - g.mean) < 1e-12);
}

/* Asked for where it is not known: refused. */
static void what_was_not_measured_is_refused (void **state)
{
    pg_scene *scene = NULL;
    pg_problem *problem = NULL;
    (void) state;
    check_ok (pg_scene_parse (&scene,
                              SQUARE STONE
                              "lattice: cells\nmethod: {force: bond, kernel: conical}\nfailure: {criterion: "
                              "stretch, fracture_energy: 1, calibration: measured}\n",
                              "test.yaml"));
    check_fails (pg_problem_build (&problem, scene, 1), PG_E_SCENE);
    check_contains (pg_last_error (), "was not measured for these bonds");
    pg_scene_free (&scene);
}

int main (void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test (it_is_known_where_it_was_measured),
                                        cmocka_unit_test (limits_allow_for_it),
                                        cmocka_unit_test (those_of_beams_too),
                                        cmocka_unit_test (what_was_not_measured_is_refused) };
    return cmocka_run_group_tests (tests, NULL, NULL);
}
