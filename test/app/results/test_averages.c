/* SPDX-License-Identifier: GPL-3.0-or-later
 * output.averages: values of uniform fields, one computation per field and step, and what is refused. */
#include "folder.h"

#define BLOCK \
    "dimension: 3\nbody: [{add: {box: {low: [0, 0, 0], high: [0.4, 0.3, 0.3]}}}]\nspacing: 0.1\n" \
    "materials: {rock: {youngs_modulus: 10 GPa, poissons_ratio: 0.25}}\nsets: {topmost: {where: y > " \
    "0.15}}\n" \
    "method: {essential: transformation}\n" \
    "boundary: [{set: all, displacement: {x: 1e-3*x, y: -2e-3*y + 1e-3*x, z: 0}}]\nsolver: {stepping: " \
    "fixed, steps: 2}\n"
#define AVERAGES \
    "output: {pictures: [], gauges: [{name: mouth, from: [0, 0, 0], to: [0.4, 0, 0]}], averages: [%s]}\n"
#define ONE(name, set, field) "{name: " name ", set: " set ", field: " field "}"

static int fields_asked;
static pg_force_type counting;

static pg_status count_field (void *self, const pg_state *state, const double *d, const char *name,
                              int *components, const char **unit, double *value)
{
    fields_asked++;
    return pg_force_find ("galerkin")->field (self, state, d, name, components, unit, value);
}

/* history.csv after two steps; to be freed. */
static char *history_of (const char *averages)
{
    char where[64];
    run r = scene_of (1, BLOCK AVERAGES, averages);
    pg_result *result = NULL;
    counting = *pg_force_find ("galerkin");
    counting.field = count_field;
    pg_solver_free (&r.solver);
    check_ok (pg_solver_create_with (&r.solver, r.problem, &r.options, &counting));
    make_folder (where);
    check_ok (pg_result_open (&result, where, r.scene, r.problem, r.solver));
    advance (&r);
    check_ok (pg_result_step (result, r.state, &r.step));
    advance (&r);
    fields_asked = 0;
    r.step.level = 0;                                  /* no fields but those of the row */
    check_ok (pg_result_step (result, r.state, &r.step));
    pg_result_free (&result);
    char *text = slurp (inside (where, "history.csv"));
    remove_folder (where);
    clear (&r);
    return text;
}

static void a_uniform_field_is_its_own_average (void **state)
{
    (void) state;
    char *text = history_of (
        ONE ("axial", "topmost", "stress.yy") ", " ONE ("eyy", "topmost", "strain.yy") ", " ONE (
            "gxy", "all", "strain.xy") ", " ONE ("szz", "right", "stress.zz") ", " ONE ("broken_share", "all",
                                                                                        "damage"));
    double e = 10e9, nu = 0.25, lambda = e * nu / ((1 + nu) * (1 - 2 * nu)), mu = e / (2 * (1 + nu)),
           sum = 1e-3 - 2e-3;
    check_relative (number_at (text, 2, "axial [Pa]"), lambda * sum - 2 * mu * 2e-3, 1e-6);
    check_relative (number_at (text, 2, "eyy [1]"), -2e-3, 1e-6);
    check_relative (number_at (text, 2, "gxy [1]"), 1e-3, 1e-6);          /* the engineering shear strain */
    check_relative (number_at (text, 2, "szz [Pa]"), lambda * sum, 1e-6);
    check_relative (number_at (text, 1, "axial [Pa]"), 0.5 * (lambda * sum - 2 * mu * 2e-3), 1e-6);
    assert_true (number_at (text, 2, "broken_share [1]") == 0);
    pg_free (text);
}

static void a_displacement_is_averaged_over_the_points_of_the_set (void **state)
{
    (void) state;
    char *text = history_of (
        ONE ("ux", "left", "displacement.x") ", " ONE ("uy", "right",
                                                       "displacement.y") ", " ONE ("mean_x", "all",
                                                                                   "displacement.x"));
    check_below (fabs (number_at (text, 2, "ux [m]")), 1e-12);
    check_relative (number_at (text, 2, "uy [m]"), 1e-3 * 0.4 - 2e-3 * 0.15, 1e-6);
    check_relative (number_at (text, 2, "mean_x [m]"), 1e-3 * 0.2, 1e-6);
    check_relative (number_at (text, 2, "mean_x [m]"), number_at (text, 2, "all.displacement_x [m]"), 1e-9);
    pg_free (text);
}

/* Points that turn: the whole body as it is told to. */
static void rotations_are_averaged_where_points_turn (void **state)
{
    (void) state;
    for (int dim = 2; dim <= 3; dim++) {
        char where[64];
        pg_result *result = NULL;
        run r =
            scene_of (1,
                      "dimension: %d\n%sbody: [{add: {box: {low: %s, high: %s}}}]\nspacing: 0.1\nlattice: "
                      "cells\nmethod: {force: gmpd}\n"
                      "materials: {rock: {youngs_modulus: 10 GPa, poissons_ratio: 0.2}}\nboundary: [{set: "
                      "all, displacement: {x: 0}}, {set: all, rotation: {z: '1e-3 + x * 1e-3 / (1 m)'}}]\n"
                      "solver: {stepping: fixed, steps: 1}\noutput: {pictures: [], averages: [{name: turn, "
                      "set: right, field: %s}]}\n",
                      dim, dim == 2 ? "plane: stress\nthickness: 1\n" : "", dim == 2 ? "[0, 0]" : "[0, 0, 0]",
                      dim == 2 ? "[0.4, 0.3]" : "[0.4, 0.3, 0.3]", dim == 2 ? "rotation" : "rotation.z");
        make_folder (where);
        check_ok (pg_result_open (&result, where, r.scene, r.problem, r.solver));
        to_the_end (&r);
        check_ok (pg_result_step (result, r.state, &r.step));
        pg_result_free (&result);
        char *text = slurp (inside (where, "history.csv"));
        check_relative (number_at (text, 1, "turn [rad]"), 1.35e-3, 1e-12);
        remove_folder (where);
        pg_free (text);
        clear (&r);
    }
}

static void a_field_is_computed_once_a_step (void **state)
{
    (void) state;
    pg_free (history_of (ONE ("a", "all", "stress.xx")));
    int one = fields_asked;
    pg_free (history_of (
        ONE ("a", "all", "stress.xx") ", " ONE ("b", "left", "stress.xx") ", " ONE ("c", "topmost",
                                                                                    "stress.zx")));
    assert_int_equal (fields_asked, one);
    pg_free (history_of (
        ONE ("a", "all", "stress.xx") ", " ONE ("b", "left", "strain.xx") ", " ONE ("c", "topmost",
                                                                                    "stress.zx")));
    assert_int_equal (fields_asked, one + 1);
}

static void must_refuse (const char *averages, const char *part)
{
    run r = scene_of (1, BLOCK AVERAGES, averages);
    check_fails (pg_result_check (r.scene, r.problem), PG_E_SCENE);
    check_contains (pg_last_error (), part);
    clear (&r);
}

static void what_is_no_component_is_refused_with_the_nearest (void **state)
{
    (void) state;
    must_refuse (ONE ("a", "all", "stress.zy"), "output.averages[0].field = stress.zy: must be one component "
                                                "of a field in 3D: damage, displacement.x");
    must_refuse (ONE ("a", "all", "rotation.z"), "must be one component");  /* these points do not turn */
    must_refuse (ONE ("a", "all", "stres.zz"), "did you mean stress.zz?");
    must_refuse (ONE ("a", "all", "displacement"), "did you mean displacement.");
    must_refuse (ONE ("a", "all", "'damage|stress.xx'"), "must be one component");
    must_refuse (ONE ("a", "all", "''"), "must be one component");
}

static void names_of_columns_are_unique (void **state)
{
    (void) state;
    must_refuse (ONE ("a", "all", "damage") ", " ONE ("a", "left", "damage"),
                 "output.averages[1].name = a: output.averages[0] has this name too");
    must_refuse (ONE ("mouth", "all", "damage"),
                 "output.averages[0].name = mouth: output.gauges[0] has this name too");
    must_refuse (ONE ("utilisation", "all", "damage"), "history.csv has a column of this name anyway");
    must_refuse (ONE ("'a [Pa]'", "all", "damage"), "a column's name has 1 to 31 characters without");
}

static void the_set_must_exist_and_hold_points (void **state)
{
    (void) state;
    pg_scene *scene = NULL;
    char text[1024];
    must_refuse (ONE ("a", "topmost.botom", "damage"), "output.averages[0].set = topmost.botom");
    must_refuse (ONE ("a", "topmost.bottom.left", "damage"), "output.averages[0].set");
    snprintf (text, sizeof text, BLOCK AVERAGES, ONE ("a", "topmst", "damage"));
    /* known before anything is built */
    check_fails (pg_scene_parse (&scene, text, "test.yaml"), PG_E_SCENE);
    check_contains (pg_last_error (), "there is no set of this name (did you mean topmost?)");
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (a_uniform_field_is_its_own_average),
        cmocka_unit_test (a_displacement_is_averaged_over_the_points_of_the_set),
        cmocka_unit_test (rotations_are_averaged_where_points_turn),
        cmocka_unit_test (a_field_is_computed_once_a_step),
        cmocka_unit_test (what_is_no_component_is_refused_with_the_nearest),
        cmocka_unit_test (names_of_columns_are_unique),
        cmocka_unit_test (the_set_must_exist_and_hold_points),
    };
    return cmocka_run_group_tests_name ("app/results/averages", tests, NULL, NULL);
}
