/* SPDX-License-Identifier: GPL-3.0-or-later
 * output.fields and output.pictures: what a body of each dimension can show, and the words for what it
 * cannot. */
#include "folder.h"
#include "io/picture/fonts.h"

static const char *const bodies[] = {
    "",
    "dimension: 1\nbody: [{add: {box: {low: [0], high: [1]}}}]\nspacing: 0.2\nmaterials: {m: "
    "{youngs_modulus: 1, poissons_ratio: 0}}\n",
    "dimension: 2\nbody: [{add: {box: {low: [0, 0], high: [1, 1]}}}]\nspacing: 0.25\nmaterials: {m: "
    "{youngs_modulus: 1, poissons_ratio: 0}}\n",
    "dimension: 3\nbody: [{add: {box: {low: [0, 0, 0], high: [1, 1, 1]}}}]\nspacing: 0.25\nmaterials: {m: "
    "{youngs_modulus: 1, poissons_ratio: 0}}\n"
};

static pg_status check_requests (int dim, const char *requests)
{
    run r = scene_of (1, "%soutput: {%s}\n", bodies[dim], requests);
    pg_status status = pg_result_check (r.scene, r.problem);
    clear (&r);
    return status;
}

static void every_part_of_every_field_has_a_picture (void **state)
{
    (void) state;
    static const char *const good[] = {
        "",
        "damage, displacement, displacement.x, velocity, velocity.x, stress, stress.xx, strain, strain.xx, "
        "error_estimate",
        "damage, displacement, displacement.x, displacement.y, velocity.y, stress.xx, stress.yy, stress.xy, "
        "strain.xx, strain.yy, strain.xy, error_estimate",
        "damage, displacement, displacement.z, velocity.z, stress.xx, stress.yy, stress.zz, stress.xy, "
        "stress.yz, stress.zx, strain.zx, error_estimate"
    };
    for (int dim = 1; dim <= 3; dim++) {
        char where[64], rest[400];
        pg_result *result = NULL;
        make_folder (where);
        snprintf (rest, sizeof rest,
                  "boundary: [{set: left, displacement: {x: 0}}, {set: right, displacement: {x: "
                  "0.01}}]\noutput: {fields: [damage, velocity, strain], pictures: [%s]}\n",
                  good[dim]);
        run r = scene_of (1, "%s%s", bodies[dim], rest);
        pg_solver_options o = r.options;
        assert_int_equal (o.levels, 20);
        check_ok (pg_result_open (&result, where, r.scene, r.problem, r.solver));
        void *self;
        check_ok (pg_solver_force (r.solver, &self)->refresh (self, r.state, NULL));
        check_ok (pg_result_finish (result, r.state, NULL, 0, 0));
        size_t wanted = 1;
        for (const char *c = good[dim]; *c; c++) wanted += *c == ',';
        assert_int_equal (pg_result_pictures (result), wanted);
        pg_result_free (&result);
        clear (&r);
        remove_folder (where);
    }
}

/* Static runs that ended well, unless output.estimate is off; as a field in Pa in result.e. */
static void the_error_estimate_is_reported (void **state)
{
    (void) state;
    static const struct {
        const char *output, *failure;
        int there;
    } turn[] = { { "fields: [error_estimate]", NULL, 1 },
                 { "estimate: off", NULL, 0 },
                 { "pictures: []", "it broke", 0 } };
    for (int k = 0; k < 3; k++) {
        char where[64], unit[16];
        pg_result *result = NULL;
        make_folder (where);
        run r = scene_of (1,
                          "%sboundary: [{set: left, displacement: {x: 0}}, {set: right, displacement: {x: "
                          "0.01}}]\noutput: {%s}\n",
                          bodies[2], turn[k].output);
        check_ok (pg_result_open (&result, where, r.scene, r.problem, r.solver));
        while (!pg_solver_done (r.solver, r.state)) {
            advance (&r);
            check_ok (pg_result_step (result, r.state, &r.step));
        }
        check_ok (pg_result_finish (result, r.state, turn[k].failure, 0, 0));
        char *text = slurp (inside (where, "report.json"));
        assert_int_equal (strstr (text, "\"error_estimate\": {") != NULL, turn[k].there);
        assert_int_equal (pg_result_estimate (result) != NULL, turn[k].there);
        if (turn[k].there) {
            const pg_estimate *e = pg_result_estimate (result);
            double *value = NULL;
            size_t n;
            int components;
            check_contains (text, "\"kind\": \"estimate\"");
            assert_true (e->norm > 0 && e->relative >= 0 && e->relative < 1 && e->points > 0);
            check_ok (
                pg_exodus_read (inside (where, "result.e"), "error_estimate", -1, &n, &components, &value));
            check_ok (pg_exodus_unit (inside (where, "result.e"), "error_estimate", unit));
            assert_int_equal (components, 1);
            assert_string_equal (unit, "Pa");
            pg_free (value);
        }
        pg_free (text);
        pg_result_free (&result);
        clear (&r);
        remove_folder (where);
    }
}

static void another_name_is_a_fault_with_the_list (void **state)
{
    (void) state;
    check_fails (check_requests (2, "pictures: [damage, strss.xx]"), PG_E_SCENE);
    check_contains (pg_last_error (), "test.yaml:5:");
    check_contains (pg_last_error (),
                    "output.pictures[1] = strss.xx: there is no such picture; did you mean stress.xx?");
    check_contains (pg_last_error (), "damage, displacement, displacement.x, displacement.y, velocity");
    check_fails (check_requests (2, "pictures: temperature"), PG_E_SCENE);
    check_contains (
        pg_last_error (),
        "output.pictures[0] = temperature: there is no such picture: one of damage, displacement");
}

static void parts_depend_on_the_dimension (void **state)
{
    (void) state;
    check_ok (check_requests (3, "pictures: [displacement.z]"));
    check_fails (check_requests (2, "pictures: [displacement.z]"), PG_E_SCENE);
    check_fails (check_requests (2, "pictures: [stress.zz]"), PG_E_SCENE);
    check_fails (check_requests (1, "pictures: [stress.yy]"), PG_E_SCENE);
    check_fails (check_requests (2, "pictures: [stress]"), PG_E_SCENE);  /* which part? */
    check_fails (check_requests (2, "pictures: [stress.]"), PG_E_SCENE);
    check_fails (check_requests (2, "pictures: ['']"), PG_E_SCENE);
    check_fails (check_requests (2, "pictures: ['damage|displacement']"), PG_E_SCENE);
}

static void names_come_once (void **state)
{
    (void) state;
    check_ok (check_requests (2, "fields: []\n  , pictures: []"));
    check_fails (check_requests (2, "pictures: [damage, stress.xx, damage]"), PG_E_SCENE);
    check_contains (pg_last_error (), "output.pictures[2] = damage: is given twice");
    check_fails (check_requests (2, "fields: [damage, damage]"), PG_E_SCENE);
    check_contains (pg_last_error (), "output.fields[1] = damage: is given twice");
}

static void a_result_is_not_opened_with_such_names (void **state)
{
    (void) state;
    run r = scene_of (1, "%soutput: {pictures: [temperature]}\n", bodies[2]);
    pg_result *result = NULL;
    check_fails (pg_result_open (&result, "/tmp/perigal_test_never_made", r.scene, r.problem, r.solver),
                 PG_E_SCENE);
    assert_null (result);
    assert_int_equal (size_of ("/tmp/perigal_test_never_made"), -1);
    clear (&r);
}

static void a_share_of_broken_bonds_writes_fields (void **state)
{
    (void) state;
    char where[64];
    pg_result *result = NULL;
    make_folder (where);
    run r = scene_of (
        1,
        "%sboundary: [{set: left, displacement: {x: 0, y: 0}}, {set: right, displacement: {x: 0.01}}]\n"
        "failure: {criterion: stretch, critical_stretch: 1e-3}\nsolver: {max_events: 30}\noutput: {at: "
        "{levels: 1, broken: 1 %%}, pictures: []}\n",
        bodies[2]);
    check_ok (pg_result_open (&result, where, r.scene, r.problem, r.solver));
    size_t expected = 0, share = 0;
    int last = 0;
    while (!pg_solver_done (r.solver, r.state)) {
        advance (&r);
        check_ok (pg_result_step (result, r.state, &r.step));
        size_t now = (size_t) (100 * (double) r.state->broken / (double) r.state->nbond);
        last = now > share || r.step.level;
        expected += (size_t) last, share = now;
    }
    check_ok (pg_result_finish (result, r.state, NULL, 0, 0));
    pg_result_free (&result);
    size_t n;
    double *time = NULL;
    pg_cloud cloud = { 0 };
    check_ok (pg_exodus_points (inside (where, "result.e"), &cloud, &n, &time));
    assert_true (share >= 2);
    assert_int_equal (n, expected + !last);
    pg_free (time);
    pg_cloud_clear (&cloud);
    clear (&r);
    remove_folder (where);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (every_part_of_every_field_has_a_picture),
        cmocka_unit_test (the_error_estimate_is_reported),
        cmocka_unit_test (another_name_is_a_fault_with_the_list),
        cmocka_unit_test (parts_depend_on_the_dimension),
        cmocka_unit_test (names_come_once),
        cmocka_unit_test (a_result_is_not_opened_with_such_names),
        cmocka_unit_test (a_share_of_broken_bonds_writes_fields),
    };
    return cmocka_run_group_tests_name ("app/results/requests", tests, NULL, NULL);
}
