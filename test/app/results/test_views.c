/* SPDX-License-Identifier: GPL-3.0-or-later
 * output.views and output.stages: the files they make and are called, what is wrong in them, and that memory
 * may end. */
#include "folder.h"
#include "io/picture/fonts.h"

#define SOLID \
    "dimension: 3\nbody: [{add: {box: {low: [0, 0, 0], high: [1, 1, 0.5]}}}]\nspacing: 0.25\nmaterials: " \
    "{m: {youngs_modulus: 1, poissons_ratio: 0}}\n"
#define PLANE \
    "dimension: 2\nbody: [{add: {box: {low: [0, 0], high: [1, 1]}}}]\nspacing: 0.25\nmaterials: {m: " \
    "{youngs_modulus: 1, poissons_ratio: 0}}\n"

static const char *faults_of (const char *body, const char *view)
{
    run r = scene_of (1, "%soutput: {views: [%s]}\n", body, view);
    pg_status status = pg_result_check (r.scene, r.problem);
    clear (&r);
    return status == PG_OK ? "" : pg_last_error ();
}

static void views_are_files_of_their_field_and_view (void **state)
{
    (void) state;
    static const char *const file[] = { "damage_front.png",          "stress.yy_left.png",
                                        "damage_crack.png",          "damage_iso.png",
                                        "damage_z_25_cm.png",        "mine.png",
                                        "displacement_1_0_1_0.5.png" };
    char where[64];
    pg_result *result = NULL;
    make_folder (where);
    run r = scene_of (1,
                      "%soutput:\n  pictures: []\n  views:\n    - {view: front}\n    - {field: stress.yy, "
                      "view: left, range: [-1, 1]}\n    - {view: crack}\n"
                      "    - {field: damage, direction: [1, 2, 3]}\n    - {section: z = 25 cm}\n    - {view: "
                      "back, above: 0.5, name: mine, magnify: 10}\n"
                      "    - {field: displacement, section: '1, 0, 1 = 0.5'}\n",
                      SOLID);
    check_ok (pg_result_open (&result, where, r.scene, r.problem, r.solver));
    void *self;
    check_ok (pg_solver_force (r.solver, &self)->refresh (self, r.state, NULL));
    check_ok (pg_result_finish (result, r.state, NULL, 0, 0));
    assert_int_equal (pg_result_pictures (result), sizeof file / sizeof *file);
    for (size_t k = 0; k < sizeof file / sizeof *file; k++) {
        assert_string_equal (pg_result_picture (result, k), inside (where, file[k]));
        assert_true (size_of (inside (where, file[k])) > 5000);
    }
    pg_result_free (&result);
    clear (&r);
    remove_folder (where);
}

static void stages_leave_a_picture_for_each_step_of_the_result (void **state)
{
    (void) state;
    char where[64], name[64];
    pg_result *result = NULL;
    size_t n = 0;
    double *time = NULL;
    pg_cloud cloud = { 0 };
    make_folder (where);
    run r = scene_of (
        1,
        "%sboundary: [{set: left, displacement: {x: 0, y: 0}}, {set: right, displacement: {x: 0.01}}]\n"
        "solver: {stepping: fixed, steps: 3}\noutput: {at: {levels: 3}, stages: on, pictures: [damage], "
        "views: [{field: displacement.x, name: ux}]}\n",
        PLANE);
    check_ok (pg_result_open (&result, where, r.scene, r.problem, r.solver));
    while (!pg_solver_done (r.solver, r.state)) {
        advance (&r);
        check_ok (pg_result_step (result, r.state, &r.step));
    }
    check_ok (pg_result_finish (result, r.state, NULL, 0, 0));
    pg_result_free (&result);
    check_ok (pg_exodus_points (inside (where, "result.e"), &cloud, &n, &time));
    assert_true (n >= 3);
    for (size_t k = 0; k <= n; k++) {
        snprintf (name, sizeof name, "stages/ux_%04zu.png", k);
        assert_int_equal (size_of (inside (where, name)) > 5000, k < n);
        snprintf (name, sizeof name, "stages/damage_%04zu.png", k);
        assert_int_equal (size_of (inside (where, name)) > 5000, k < n);
    }
    assert_true (size_of (inside (where, "ux.png")) > 5000);
    pg_free (time);
    pg_cloud_clear (&cloud);
    clear (&r);
    remove_folder (where);
}

static void what_is_wrong_in_a_view_is_named (void **state)
{
    (void) state;
    check_contains (faults_of (SOLID, "{field: strss.xx}"),
                    "output.views[0].field = strss.xx: there is no such picture; did you mean stress.xx?");
    check_contains (faults_of (SOLID, "{section: z 5}"),
                    "output.views[0].section = z 5: expected AXIS = PLACE");
    check_contains (faults_of (SOLID, "{section: z = 7}"), "misses the body, which lies between 0 and 0.5 m");
    check_contains (faults_of (SOLID, "{section: '1, 1, 0 = 2'}"),
                    "misses the body, which lies between 0 and 1.41421 m");
    check_contains (faults_of (SOLID, "{direction: [0, 0, 0]}"), "output.views[0].direction");
    check_contains (faults_of (SOLID, "{range: [1]}"), "must be two ascending numbers");
    check_contains (faults_of (SOLID, "{range: [2, 1]}"), "must be two ascending numbers");
    check_contains (faults_of (SOLID, "{name: a/b}"),
                    "output.views[0].name = a/b: must be a file name of at most 60 letters");
    check_contains (faults_of (SOLID, "{name: load_displacement}"),
                    "another picture is called load_displacement.png");
    check_contains (faults_of (SOLID, "{view: back}, {view: back, magnify: 2}"),
                    "output.views[1]: another picture is called damage_back.png; give another name");
    check_contains (faults_of (SOLID, "{name: damage}"), "another picture is called damage.png");
    check_contains (faults_of (PLANE, "{view: back}"), "output.views[0].view = back: is for dimension 3");
    check_contains (faults_of (PLANE, "{section: z = 0}"), "is for dimension 3");
    check_contains (faults_of (PLANE, "{field: stress.zz}"), "there is no such picture");
    assert_string_equal (faults_of (PLANE, "{field: stress.yy}, {magnify: 3, name: deformed}"), "");
}

static void another_view_is_refused_with_the_nearest (void **state)
{
    (void) state;
    pg_scene *scene = NULL;
    check_fails (pg_scene_parse (&scene, SOLID "output: {views: [{view: frnt}]}\n", "t.yaml"), PG_E_SCENE);
    check_contains (pg_last_error (), "did you mean front?");
    check_fails (pg_scene_parse (&scene, SOLID "output: {views: [{view: front, section: z = 1}]}\n",
                                 "t.yaml"),
                 PG_E_SCENE);
    check_contains (pg_last_error (), "at most one of view, section");
}

static void any_allocation_may_fail (void **state)
{
    (void) state;
    char where[64];
    make_folder (where);
    run r = scene_of (1, "%soutput: {stages: on, pictures: [], views: [{view: crack, field: stress.yy}]}\n",
                      SOLID);
    void *self;
    check_ok (pg_solver_force (r.solver, &self)->refresh (self, r.state, NULL));
    pg_free (field_of (&r, NULL, "damage", NULL));         /* bonds of each node are counted once for all */
    size_t before = pg_memory_used (), k = 1;
    pg_status status = PG_E_MEMORY;
    for (; status != PG_OK && k < 400; k++) {
        pg_result *result = NULL;
        pg_memory_fail_at (k);
        status = pg_result_open (&result, where, r.scene, r.problem, r.solver);
        if (status == PG_OK) status = pg_result_finish (result, r.state, NULL, 0, 0);
        pg_memory_fail_at (0);
        pg_result_free (&result);
        assert_true (status == PG_OK || status == PG_E_MEMORY);
        assert_int_equal (pg_memory_used (), before);
    }
    assert_true (status == PG_OK && k > 30);
    clear (&r);
    remove_folder (where);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (views_are_files_of_their_field_and_view),
        cmocka_unit_test (stages_leave_a_picture_for_each_step_of_the_result),
        cmocka_unit_test (what_is_wrong_in_a_view_is_named),
        cmocka_unit_test (another_view_is_refused_with_the_nearest),
        cmocka_unit_test (any_allocation_may_fail),
    };
    return cmocka_run_group_tests_name ("app/results/views", tests, NULL, NULL);
}
