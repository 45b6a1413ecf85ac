/* SPDX-License-Identifier: GPL-3.0-or-later
 * Shapes: inside, distance, bounding box, names of surfaces, faults. */
#include "parsed.h"

static pg_body body_of (const char *text)
{
    pg_scene *scene = parsed (text);
    pg_body body;
    check_ok (pg_body_read (&body, scene));
    pg_scene_free (&scene);
    return body;
}

static void must_fault (const char *text, const char *part)
{
    pg_scene *scene = parsed (text);
    pg_body body;
    check_fails (pg_body_read (&body, scene), PG_E_SCENE);
    check_contains (pg_last_error (), part);
    check_contains (pg_last_error (), "test.yaml:");
    pg_scene_free (&scene);
}

static double distance (const pg_body *b, double x, double y, double z)
{
    double p[3] = {x, y, z}, d;
    pg_body_nearest (b, p, &d);
    return pg_body_inside (b, p, 0) ? -d : d;
}

static void box_distance_is_exact_in_1d_2d_3d (void **state)
{
    (void) state;
    pg_body a = body_of ("dimension: 1\nbody: [{add: {box: {low: [-1], high: [3]}}}]");
    check_relative (distance (&a, 2, 0, 0), -1, 1e-15);
    check_relative (distance (&a, 5, 0, 0), 2, 1e-15);
    pg_body b = body_of ("dimension: 2\nbody: [{add: {box: {low: [-1, -2], high: [1, 2]}}}]");
    check_relative (distance (&b, 4, 6, 0), 5, 1e-15);
    check_relative (distance (&b, 0.5, 0, 0), -0.5, 1e-15);
    pg_body c = body_of ("dimension: 3\nbody: [{add: {box: {low: [0, 0, 0], high: [1, 1, 1]}}}]");
    check_relative (distance (&c, 2, 3, 3), 3, 1e-15);
    check_relative (distance (&c, 0.5, 0.5, 0.9), -0.1, 1e-14);
    pg_body_clear (&a), pg_body_clear (&b), pg_body_clear (&c);
}

static void round_shapes_measure_from_their_surface (void **state)
{
    (void) state;
    pg_body d = body_of ("dimension: 2\nbody: [{add: {disk: {center: [1, 0], diameter: 2 m}}}]");
    pg_body s = body_of ("dimension: 3\nbody: [{add: {sphere: {center: [0, 0, 0], radius: 2}}}]");
    check_relative (distance (&d, 1, 3, 0), 2, 1e-15);
    check_relative (distance (&d, 1.25, 0, 0), -0.75, 1e-15);
    check_relative (distance (&s, 2, 3, 6), 5, 1e-15);
    pg_body_clear (&d), pg_body_clear (&s);
}

static void tilted_cylinder_has_its_distance_and_box (void **state)
{
    (void) state;
    pg_body c = body_of ("dimension: 3\nbody: [{add: {cylinder: {center: [0, 0, 0], axis: [3, 0, 4], radius: "
                         "1, length: 10}}}]");
    check_relative (distance (&c, 3, 0, 4), -1, 1e-14);         /* on the axis: side nearest */
    check_relative (distance (&c, 3, 2, 4), 1, 1e-14);
    check_relative (distance (&c, 7.2, 0, 9.6), 2, 1e-14);      /* beyond the far end */
    check_relative (c.low[0], -0.8, 1e-14);
    check_relative (c.high[0], 6.8, 1e-14);
    check_relative (c.high[2], 8.6, 1e-14);
    check_relative (c.low[1], -1, 1e-14);
    pg_body_clear (&c);
}

static void polygon_and_prism_work_when_concave (void **state)
{
    (void) state;
    pg_body p = body_of (
        "dimension: 2\nbody: [{add: {polygon: {vertices: [[0, 0], [4, 0], [4, 4], [2, 1], [0, 4]]}}}]");
    assert_false (pg_body_inside (&p, (double[]) {2, 2}, 0));
    assert_true (pg_body_inside (&p, (double[]) {0.5, 2}, 0));
    assert_true (pg_body_inside (&p, (double[]) {2, 1}, 1e-12));
    check_relative (distance (&p, 5, 2, 0), 1, 1e-15);
    pg_body q = body_of (
        "dimension: 3\nbody: [{add: {prism: {vertices: [[0, 0], [1, 0], [0, 1]], low: -1, high: 1}}}]");
    check_relative (distance (&q, 0.2, -0.3, 1.4), 0.5, 1e-14);
    assert_true (pg_body_inside (&q, (double[]) {0.4, 0.4, -0.9}, 0));
    assert_false (pg_body_inside (&q, (double[]) {0.6, 0.6, 0}, 0));
    pg_body_clear (&p), pg_body_clear (&q);
}

static void a_polygon_closed_by_hand_is_the_same (void **state)
{
    (void) state;
    pg_body p = body_of (
        "dimension: 2\nbody: [{add: {polygon: {vertices: [[0, 0], [4, 0], [4, 4], [0, 0]]}}}]");
    assert_int_equal (p.shape[0].nvertex, 3);
    pg_body_clear (&p);
}

static void shapes_act_in_order_and_surfaces_belong_to_the_body (void **state)
{
    (void) state;
    pg_body b = body_of ("dimension: 2\nbody:\n  - add: {box: {low: [-2, -2], high: [2, 2]}}\n  - subtract: "
                         "{disk: {center: [0, 0], radius: 1}}\n"
                         "  - add: {disk: {center: [0, 0], radius: 0.5}}\n");
    assert_true (pg_body_inside (&b, (double[]) {0, 0}, 0));
    assert_false (pg_body_inside (&b, (double[]) {0.7, 0}, 0));
    assert_true (pg_body_inside (&b, (double[]) {1, 0}, 0));
    assert_true (pg_body_inside (&b, (double[]) {2, 2}, 0));
    assert_true (pg_body_inside (&b, (double[]) {2 + 1e-10, 0}, 1e-9));
    assert_true (pg_body_inside (&b, (double[]) {1 - 1e-10, 0}, 1e-9));
    assert_false (pg_body_inside (&b, (double[]) {1 - 1e-10, 0}, 0));
    pg_body_clear (&b);
}

static void the_box_of_the_body_ignores_what_is_subtracted (void **state)
{
    (void) state;
    pg_body b = body_of ("dimension: 2\nbody:\n  - add: {box: {low: [0, 0], high: [2, 1]}}\n  - subtract: "
                         "{disk: {center: [9, 9], radius: 1}}\n");
    check_relative (b.high[0], 2, 0);
    check_relative (b.high[1], 1, 0);
    pg_body_clear (&b);
}

static void surfaces_are_named_by_kind_or_by_the_user (void **state)
{
    (void) state;
    pg_body b = body_of ("dimension: 2\nbody:\n  - add: {box: {low: [-2, -2], high: [2, 2]}}\n  - subtract: "
                         "{disk: {center: [0, 0], radius: 1}}\n"
                         "  - add: {disk: {center: [5, 5], radius: 1}}\n  - subtract: {disk: {center: [5, "
                         "5], radius: 0.1}}\n    name: bore\n");
    assert_string_equal (b.shape[0].boundary, "side");
    assert_string_equal (b.shape[1].boundary, "hole");
    assert_string_equal (b.shape[2].boundary, "rim");
    assert_string_equal (b.shape[3].boundary, "bore");
    assert_int_equal (pg_body_nearest (&b, (double[]) {1.1, 0}, NULL), 1);
    assert_int_equal (pg_body_nearest (&b, (double[]) {1.9, 0}, NULL), 0);
    assert_int_equal (pg_body_nearest (&b, (double[]) {5.1, 5.1}, NULL), 3);
    pg_body_clear (&b);
}

static void a_shape_of_another_dimension_is_a_fault (void **state)
{
    (void) state;
    must_fault ("dimension: 3\nbody: [{add: {disk: {center: [0, 0, 0], radius: 1}}}]",
                "a disk needs dimension 2, this scene has 3");
    must_fault ("dimension: 2\nbody: [{add: {sphere: {center: [0, 0], radius: 1}}}]",
                "a sphere needs dimension 3");
    must_fault ("dimension: 3\nbody: [{add: {polygon: {vertices: [[0, 0], [1, 0], [0, 1]]}}}]",
                "a polygon needs dimension 2");
}

static void impossible_shapes_are_faults (void **state)
{
    (void) state;
    must_fault ("dimension: 2\nbody: [{add: {box: {low: [0, 1], high: [1, 1]}}}]",
                "low must lie below high, but y");
    must_fault ("dimension: 2\nbody: [{add: {polygon: {vertices: [[0, 0], [1, 0]]}}}]", "three vertices");
    must_fault ("dimension: 2\nbody: [{add: {polygon: {vertices: [[0, 0], [1, 1], [1, 0], [0, 1]]}}}]",
                "crosses itself");
    must_fault ("dimension: 2\nbody: [{add: {polygon: {vertices: [[0, 0], [1, 1], [2, 2]]}}}]", "polygon");
    must_fault ("dimension: 2\nbody: [{add: {polygon: {vertices: [[0, 0, 0], [1, 0], [0, 1]]}}}]",
                "vertex 1 must be a pair");
    must_fault (
        "dimension: 3\nbody: [{add: {cylinder: {center: [0, 0, 0], axis: [0, 0, 0], radius: 1, length: 1}}}]",
        "axis has no length");
    must_fault ("dimension: 3\nbody: [{add: {prism: {vertices: [[0, 0], [1, 0], [0, 1]], low: 1, high: 1}}}]",
                "low must lie below high");
}

static void a_body_needs_something_added (void **state)
{
    (void) state;
    must_fault ("dimension: 2\nbody: [{subtract: {disk: {center: [0, 0], radius: 1}}}]", "nothing is added");
    must_fault ("dimension: 2\n", "body: is missing");
}

static void a_surface_may_not_take_the_name_of_a_side (void **state)
{
    (void) state;
    must_fault ("dimension: 2\nbody: [{add: {disk: {center: [0, 0], radius: 1}}, name: left}]",
                "already names a side");
    must_fault ("dimension: 2\nbody: [{add: {disk: {center: [0, 0], radius: 1}}, name: "
                "abcdefghijklmnopqrstuvwxyzabcdefghijk}]",
                "at most 31 letters");
}

static void all_faults_of_a_body_come_together (void **state)
{
    (void) state;
    const char *text = "dimension: 2\nbody:\n  - add: {box: {low: [0, 1], high: [1, 1]}}\n  - add: {sphere: "
                       "{center: [0, 0], radius: 1}}\n";
    must_fault (text, "a sphere needs");
    must_fault (text, "low must lie");
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (box_distance_is_exact_in_1d_2d_3d),
        cmocka_unit_test (round_shapes_measure_from_their_surface),
        cmocka_unit_test (tilted_cylinder_has_its_distance_and_box),
        cmocka_unit_test (polygon_and_prism_work_when_concave),
        cmocka_unit_test (a_polygon_closed_by_hand_is_the_same),
        cmocka_unit_test (shapes_act_in_order_and_surfaces_belong_to_the_body),
        cmocka_unit_test (the_box_of_the_body_ignores_what_is_subtracted),
        cmocka_unit_test (surfaces_are_named_by_kind_or_by_the_user),
        cmocka_unit_test (a_shape_of_another_dimension_is_a_fault),
        cmocka_unit_test (impossible_shapes_are_faults),
        cmocka_unit_test (a_body_needs_something_added),
        cmocka_unit_test (a_surface_may_not_take_the_name_of_a_side),
        cmocka_unit_test (all_faults_of_a_body_come_together),
    };
    return cmocka_run_group_tests_name ("geometry/cloud/body", tests, NULL, NULL);
}
