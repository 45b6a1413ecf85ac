/* SPDX-License-Identifier: GPL-3.0-or-later
 * Cracks of the scene: what is read and what is refused. */
#include "parsed.h"

#define PLATE \
    "dimension: 2\nbody: [{add: {box: {low: [-1, -1], high: [1, 1]}}}, {subtract: {disk: {center: [0, 0], " \
    "radius: 0.5}}}]\n"
#define CUBE "dimension: 3\nbody: [{add: {box: {low: [-1, -1, -1], high: [1, 1, 1]}}}]\n"

static pg_cracks cracks_of (const char *text)
{
    pg_scene *scene = parsed (text);
    pg_cracks cracks;
    check_ok (pg_cracks_read (&cracks, scene));
    pg_scene_free (&scene);
    return cracks;
}

static void must_fault (const char *text, const char *part)
{
    pg_scene *scene = parsed (text);
    pg_cracks cracks;
    check_fails (pg_cracks_read (&cracks, scene), PG_E_SCENE);
    check_contains (pg_last_error (), part);
    pg_scene_free (&scene);
}

static void segments_have_a_unit_normal (void **state)
{
    (void) state;
    pg_cracks c = cracks_of (
        PLATE "cracks: [{from: [-0.9, -0.9], to: [-0.6, -0.5]}, {from: [900 mm, 0], to: [0.6, 0]}]\n");
    assert_int_equal (c.n, 2);
    check_absolute (c.crack[0].normal[0], -0.8, 1e-14);
    check_absolute (c.crack[0].normal[1], 0.6, 1e-14);
    check_relative (c.crack[1].vertex[0], 0.9, 1e-15);
    pg_cracks_clear (&c);
}

static void polygons_and_discs_have_a_unit_normal (void **state)
{
    (void) state;
    pg_cracks c = cracks_of (CUBE
                             "cracks:\n  - polygon: [[0, 0, 0], [0.5, 0, 0.5], [0.5, 0.5, 0.5], [0, 0.5, "
                             "0]]\n  - disc: {center: [0, 0, 0.1], normal: [0, 3, 4], radius: 50 mm}\n");
    check_relative (fabs (c.crack[0].normal[0]), sqrt (0.5), 1e-14);
    check_relative (c.crack[0].normal[2], -c.crack[0].normal[0], 1e-14);
    check_relative (c.crack[1].normal[2], 0.8, 1e-14);
    assert_int_equal (c.crack[1].nvertex, 64);
    for (size_t i = 0; i < 64; i++) {
        double r[3], d = 0, l = 0;
        for (size_t k = 0; k < 3; k++)
            r[k] = c.crack[1].vertex[3 * i + k] - c.crack[1].centre[k], d += r[k] * c.crack[1].normal[k],
            l += r[k] * r[k];
        check_absolute (d, 0, 1e-15);
        check_relative (l, 0.0025, 1e-13);
    }
    pg_cracks_clear (&c);
}

static void no_cracks_is_an_empty_list (void **state)
{
    (void) state;
    pg_cracks c = cracks_of (PLATE);
    assert_int_equal (c.n, 0);
    pg_cracks_clear (&c);
}

static void a_crack_of_another_dimension_is_a_fault (void **state)
{
    (void) state;
    must_fault (PLATE "cracks: [{disc: {center: [0, 0], normal: [0, 1], radius: 1}}]",
                "in 2D give from and to");
    must_fault (CUBE "cracks: [{from: [0, 0, 0], to: [1, 0, 0]}]", "in 3D give a polygon or a disc");
    must_fault ("dimension: 1\nbody: [{add: {box: {low: [0], high: [1]}}}]\ncracks: [{from: [0], to: [1]}]",
                "needs dimension 2 or 3");
}

static void cracks_without_extent_are_faults (void **state)
{
    (void) state;
    must_fault (PLATE "cracks: [{from: [0.7, 0], to: [0.7, 0]}]", "no length");
    must_fault (PLATE "cracks: [{from: [0.7, 0]}]", "needs to");
    must_fault (CUBE "cracks: [{polygon: [[0, 0, 0], [1, 1, 1]]}]", "three vertices");
    must_fault (CUBE "cracks: [{polygon: [[0, 0, 0], [0.25, 0.25, 0.25], [0.5, 0.5, 0.5]]}]", "no area");
    must_fault (CUBE "cracks: [{disc: {center: [0, 0, 0], normal: [0, 0, 0], radius: 1}}]",
                "normal has no length");
}

static void a_polygon_must_be_plane_and_simple (void **state)
{
    (void) state;
    must_fault (CUBE "cracks: [{polygon: [[0, 0, 0], [0.5, 0, 0], [0.5, 0.5, 0.01], [0, 0.5, 0]]}]",
                "is not plane");
    must_fault (CUBE "cracks: [{polygon: [[0, 0, 0], [0.5, 0.6, 0], [0.5, 0, 0], [0, 0.5, 0]]}]",
                "crosses itself");
}

static void a_crack_outside_the_body_is_a_fault (void **state)
{
    (void) state;
    must_fault (PLATE "cracks: [{from: [1.2, 0], to: [2, 0]}]", "cracks[0]: lies outside the body");
    must_fault (PLATE "cracks: [{from: [0.9, 0], to: [0.6, 0]}, {from: [-0.3, 0], to: [0.3, 0]}]",
                "cracks[1]: lies outside the body");
    must_fault (CUBE "cracks: [{polygon: [[2, 0, 0], [3, 0, 0], [3, 1, 0]]}]", "lies outside the body");
    must_fault (CUBE "cracks: [{disc: {center: [0, 0, 3], normal: [0, 0, 1], radius: 1}}]",
                "lies outside the body");
    must_fault (CUBE "cracks: [{disc: {center: [0, 0, 1.01], normal: [0, 0, 1], radius: 1}}]",
                "lies outside the body");
}

static void a_crack_that_reaches_into_the_body_is_kept (void **state)
{
    (void) state;
    pg_cracks a = cracks_of (PLATE "cracks: [{from: [-0.4, 0], to: [-0.51, 0]}, {from: [-30, -0.99], to: "
                                   "[50, -0.99]}, {from: [1, 1], to: [2, 2]}]");
    pg_cracks b = cracks_of (CUBE "cracks: [{polygon: [[-90, -90, 0], [90, -90, 0], [0, 90, 0]]}, {disc: "
                                  "{center: [0, 0, 0], normal: [0, 0, 1], radius: 40}}]");
    assert_int_equal (a.n, 3);
    assert_int_equal (b.n, 2);
    pg_cracks_clear (&a), pg_cracks_clear (&b);
}

static void any_allocation_may_fail (void **state)
{
    (void) state;
    pg_scene *scene = parsed (CUBE "cracks: [{polygon: [[0, 0, 0], [0.5, 0, 0], [0.5, 0.5, 0]]}, {disc: "
                                   "{center: [0, 0, 0], normal: [0, 0, 1], radius: 0.1}}]");
    size_t before = pg_memory_used (), k = 0;
    pg_status status = PG_E_MEMORY;
    while (status != PG_OK) {
        pg_cracks c;
        pg_memory_fail_at (++k);
        status = pg_cracks_read (&c, scene);
        pg_memory_fail_at (0);
        if (status == PG_OK) pg_cracks_clear (&c);
        else assert_int_equal (status, PG_E_MEMORY);
        assert_int_equal (pg_memory_used (), before);
    }
    assert_true (k > 4);
    pg_scene_free (&scene);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (segments_have_a_unit_normal),
        cmocka_unit_test (polygons_and_discs_have_a_unit_normal),
        cmocka_unit_test (no_cracks_is_an_empty_list),
        cmocka_unit_test (a_crack_of_another_dimension_is_a_fault),
        cmocka_unit_test (cracks_without_extent_are_faults),
        cmocka_unit_test (a_polygon_must_be_plane_and_simple),
        cmocka_unit_test (a_crack_outside_the_body_is_a_fault),
        cmocka_unit_test (a_crack_that_reaches_into_the_body_is_kept),
        cmocka_unit_test (any_allocation_may_fail),
    };
    return cmocka_run_group_tests_name ("geometry/cloud/crack_read", tests, NULL, NULL);
}
