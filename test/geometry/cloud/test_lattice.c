/* SPDX-License-Identifier: GPL-3.0-or-later
 * The lattice: steps that divide the box, ties decided alike on all sides, offsets, limits. */
#include "parsed.h"

static pg_lattice fitted (const char *text, double spacing, const double *offset)
{
    pg_scene *scene = parsed (text);
    pg_body body;
    pg_lattice l;
    check_ok (pg_body_read (&body, scene));
    check_ok (pg_lattice_fit (&l, &body, spacing, offset));
    pg_body_clear (&body);
    pg_scene_free (&scene);
    return l;
}

static size_t cells_of (const pg_lattice *l)
{
    return (size_t) l->count[0] * (size_t) l->count[1] * (size_t) l->count[2];
}

static size_t kept (const pg_lattice *l)
{
    size_t n = 0;
    for (size_t i = 0; i < cells_of (l); i++) n += l->in[i];
    return n;
}

static int at (const pg_lattice *l, int a, int b) { return l->in[b * l->count[0] + a]; }

static void steps_divide_each_side_of_the_box (void **state)
{
    (void) state;
    pg_lattice l = fitted ("dimension: 3\nbody: [{add: {box: {low: [0, 0, 0], high: [1, 0.26, 0.02]}}}]", 0.1,
                           NULL);
    assert_int_equal (l.count[0], 10);
    assert_int_equal (l.count[1], 3);
    assert_int_equal (l.count[2], 1);                          /* never none */
    check_relative (l.step[1], 0.26 / 3, 1e-15);
    assert_int_equal (kept (&l), 30);
    pg_lattice_clear (&l);
}

static void corners_are_exact_and_the_middle_of_a_centred_body_is_zero (void **state)
{
    (void) state;
    for (double size = 1e-9; size < 1e10; size *= 7.3) {
        pg_shape box = {.kind = PG_BOX, .add = 1, .low = {-size, 0.1 * size}, .high = {size, 0.7 * size}};
        pg_body body = {
            .dim = 2, .shape = &box, .n = 1, .low = { -size, 0.1 * size }, .high = { size, 0.7 * size }
        };
        pg_lattice l;
        check_ok (pg_lattice_fit (&l, &body, size / 17, NULL));
        assert_int_equal (l.count[0], 34);
        check_relative (pg_lattice_at (&l, 0, 0), -size, 0);
        check_relative (pg_lattice_at (&l, 0, 34), size, 0);
        check_relative (pg_lattice_at (&l, 1, l.count[1]), 0.7 * size, 0);
        assert_true (pg_lattice_at (&l, 0, 17) == 0);
        for (int i = 0; i <= 34; i++)
            assert_true (pg_lattice_at (&l, 0, i) == -pg_lattice_at (&l, 0, 34 - i));
        pg_lattice_clear (&l);
    }
}

/* Cell centres on the circle: 5 spacings from the centre in the directions 3-4-5. */
static void centres_on_the_surface_are_kept_on_every_side (void **state)
{
    (void) state;
    const char *text = "dimension: 2\nbody: [{add: {box: {low: [-0.55, -0.55], high: [0.55, 0.55]}}}, "
                       "{subtract: {box: {low: [-1, -1], high: [1, 1]}}},"
                       " {add: {disk: {center: [0, 0], radius: 0.5}}}]";
    pg_lattice l = fitted (text, 0.1, NULL);
    assert_int_equal (l.count[0], 11);
    int x[12][2] = { { 5, 0 },  { 4, 3 },   { 3, 4 },   { 0, 5 },  { -3, 4 }, { -4, 3 },
                     { -5, 0 }, { -4, -3 }, { -3, -4 }, { 0, -5 }, { 3, -4 }, { 4, -3 } };
    for (int k = 0; k < 12; k++) assert_true (at (&l, 5 + x[k][0], 5 + x[k][1]));
    pg_lattice_clear (&l);
}

static void mirrored_and_turned_bodies_give_mirrored_and_turned_cells (void **state)
{
    (void) state;
    const char *shape = "dimension: 2\nbody:\n  - add: {box: {low: [-1.3, -0.7], high: [1.3, 0.7]}}\n"
                        "  - subtract: {disk: {center: [%g, %g], radius: 0.3}}\n  - subtract: {polygon: "
                        "{vertices: [[%g, %g], [%g, %g], [%g, %g]]}}\n";
    double v[4][2] = {{0.4, 0.2}, {-1, -0.5}, {-0.5, -0.5}, {-0.75, 0.1}};
    pg_lattice l[4];
    for (int k = 0; k < 4; k++) {
        char text[500];
        double s = k % 2 ? -1 : 1, t = k / 2 ? -1 : 1;
        snprintf (text, sizeof text, shape, s * v[0][0], t * v[0][1], s * v[1][0], t * v[1][1], s * v[2][0],
                  t * v[2][1], s * v[3][0], t * v[3][1]);
        l[k] = fitted (text, 0.1, NULL);
    }
    int n = l[0].count[0], m = l[0].count[1];
    assert_true (kept (&l[0]) < cells_of (&l[0]));
    for (int b = 0; b < m; b++)
        for (int a = 0; a < n; a++) {
            assert_int_equal (at (&l[0], a, b), at (&l[1], n - 1 - a, b));
            assert_int_equal (at (&l[0], a, b), at (&l[2], a, m - 1 - b));
            assert_int_equal (at (&l[0], a, b), at (&l[3], n - 1 - a, m - 1 - b));
        }
    for (int k = 0; k < 4; k++) pg_lattice_clear (&l[k]);
}

/* As above, where one rounding of a coordinate (2e-9 m) is more than 1e-9 of a step. */
static void a_body_far_from_the_origin_has_the_same_cells (void **state)
{
    (void) state;
    pg_lattice l[2];
    for (int k = 0; k < 2; k++) {
        char text[400];
        double x = k * 1.7e7, y = k * -1.3e7;
        snprintf (text, sizeof text,
                  "dimension: 2\nbody: [{add: {box: {low: [%.2f, %.2f], high: [%.2f, %.2f]}}}, {subtract: "
                  "{box: {low: [-1e9, -1e9], high: [1e9, 1e9]}}},"
                  " {add: {disk: {center: [%.2f, %.2f], radius: 0.5}}}]",
                  x - 0.55, y - 0.55, x + 0.55, y + 0.55, x, y);
        l[k] = fitted (text, 0.1, NULL);
    }
    assert_int_equal (cells_of (&l[0]), 121);
    assert_int_equal (cells_of (&l[1]), 121);
    assert_memory_equal (l[0].in, l[1].in, 121);
    pg_lattice_clear (&l[0]), pg_lattice_clear (&l[1]);
}

static void an_offset_shifts_the_lattice_and_covers_the_body (void **state)
{
    (void) state;
    double offset[2] = {0.25, -0.25};
    pg_lattice l = fitted ("dimension: 2\nbody: [{add: {box: {low: [0, 0], high: [1, 1]}}}]", 0.1, offset);
    assert_int_equal (l.count[0], 11);
    assert_int_equal (l.count[1], 11);
    check_relative (l.origin[0], -0.075, 1e-14);
    check_relative (l.origin[1], -0.025, 1e-14);
    for (int k = 0; k < 2; k++) {
        check_relative (l.high[k], l.origin[k] + 1.1, 1e-14);
        assert_true (l.origin[k] <= 0 && l.high[k] >= 1);
    }
    assert_int_equal (kept (&l), 100);
    pg_lattice_clear (&l);
}

static void too_many_cells_are_a_limit_and_no_spacing_a_misuse (void **state)
{
    (void) state;
    pg_shape box = {.kind = PG_BOX, .add = 1, .high = {1, 1, 1}};
    pg_body body = {.dim = 3, .shape = &box, .n = 1, .high = {1, 1, 1}};
    pg_lattice l;
    check_fails (pg_lattice_fit (&l, &body, 1e-5, NULL), PG_E_LIMIT);
    check_fails (pg_lattice_fit (&l, &body, 1e-300, NULL), PG_E_LIMIT);
    check_fails (pg_lattice_fit (&l, &body, 0, NULL), PG_E_USAGE);
    check_fails (pg_lattice_fit (&l, &body, NAN, NULL), PG_E_USAGE);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (steps_divide_each_side_of_the_box),
        cmocka_unit_test (corners_are_exact_and_the_middle_of_a_centred_body_is_zero),
        cmocka_unit_test (centres_on_the_surface_are_kept_on_every_side),
        cmocka_unit_test (mirrored_and_turned_bodies_give_mirrored_and_turned_cells),
        cmocka_unit_test (a_body_far_from_the_origin_has_the_same_cells),
        cmocka_unit_test (an_offset_shifts_the_lattice_and_covers_the_body),
        cmocka_unit_test (too_many_cells_are_a_limit_and_no_spacing_a_misuse),
    };
    return cmocka_run_group_tests_name ("geometry/cloud/lattice", tests, NULL, NULL);
}
