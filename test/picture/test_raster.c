/* SPDX-License-Identifier: GPL-3.0-or-later
 * The rasteriser: cells tile without gaps or growth, the nearest point owns a pixel, moved points leave no
 * holes, cracks stay open. */
#include "check.h"
#include "picture/picture_private.h"
#include <stdlib.h>

enum { SIZE = 200, SIDE = 23 };
static int owner[SIZE * SIZE];
static double place[2 * SIDE * SIDE];

/* SIDE x SIDE cells of `step` pixels from (10, 10); `shake` in steps. */
static pg_spots lattice (double step, double shake, double reach)
{
    unsigned seed = 7;
    for (int k = 0; k < SIDE * SIDE; k++)
        for (int a = 0; a < 2; a++) {
            seed = seed * 1664525u + 1013904223u;
            place[2 * k + a] =
                10 + step * ((a ? k / SIDE : k % SIDE) + 0.5 + shake * (2 * (seed / 4294967296.0) - 1));
        }
    return (pg_spots) { .n = SIDE * SIDE, .place = place, .size = { step, step }, .reach = reach };
}

static int covered (int x, int y) { return owner[y * SIZE + x] >= 0; }

static void cells_tile_without_gap_or_growth (void **state)
{
    (void) state;
    static const double steps[] = { 3, 7.31, 5.5, 0.9, 8 };
    for (int s = 0; s < 5; s++) {
        double step = steps[s], last = 10 + SIDE * step;
        pg_spots spots = lattice (step, 0, 1.9);
        check_ok (pg_raster (&spots, SIZE, SIZE, owner));
        for (int y = 0; y < SIZE; y++)
            for (int x = 0; x < SIZE; x++) {
                double cx = x + 0.5, cy = y + 0.5;
                if (fabs (cx - last) < 1e-6 || fabs (cy - last) < 1e-6) continue;
                int inside = cx > 10 && cx < last && cy > 10 && cy < last;
                assert_int_equal (covered (x, y), inside);
                if (!inside) continue;
                int i = (int) ((cx - 10) / step), j = (int) ((cy - 10) / step), k = owner[y * SIZE + x];
                assert_true (fabs (place[2 * k] - cx) <= 0.5 * step + 1e-5
                             && fabs (place[2 * k + 1] - cy) <= 0.5 * step + 1e-5);
                assert_true (abs (k % SIDE - i) <= 1 && abs (k / SIDE - j) <= 1);
            }
    }
}

static void the_nearest_point_owns_a_pixel (void **state)
{
    (void) state;
    double at[] = { 60, 60, 72, 60 };
    pg_spots spots = { .n = 2, .place = at, .size = { 40, 40 }, .reach = 1.5 };
    check_ok (pg_raster (&spots, SIZE, SIZE, owner));
    assert_int_equal (owner[60 * SIZE + 64], 0);
    assert_int_equal (owner[60 * SIZE + 67], 1);
    assert_int_equal (owner[60 * SIZE + 41], 0);
    assert_int_equal (owner[60 * SIZE + 91], 1);
    assert_false (covered (93, 60));
    assert_false (covered (38, 60));
    assert_false (covered (60, 82));
}

static void moved_points_leave_no_holes (void **state)
{
    (void) state;
    pg_spots spots = lattice (7.31, 0.2, 1.9);
    check_ok (pg_raster (&spots, SIZE, SIZE, owner));
    int low = (int) (10 + 7.31), high = (int) (10 + (SIDE - 1) * 7.31);
    for (int y = low; y < high; y++) for (int x = low; x < high; x++) assert_true (covered (x, y));
}

static void an_opened_crack_stays_open (void **state)
{
    (void) state;
    double at[2 * 2];
    pg_spots spots = { .n = 2, .place = at, .size = { 20, 20 }, .reach = 1.3 };
    at[0] = 60, at[1] = 60, at[3] = 60;
    at[2] = 87;                                        /* a gap of a third of a cell, 70 to 77 */
    check_ok (pg_raster (&spots, SIZE, SIZE, owner));
    assert_false (covered (73, 60));
    at[2] = 83;                                        /* stretch by 15 %: 70 to 73 is closed */
    check_ok (pg_raster (&spots, SIZE, SIZE, owner));
    for (int x = 70; x < 73; x++) assert_true (covered (x, 60));
}

static void points_outside_or_nowhere_do_no_harm (void **state)
{
    (void) state;
    double at[] = { -1e30, 5, 5, 1e30, NAN, 3, -4, -4, 1e9, -1e9 };
    pg_spots spots = { .n = 5, .place = at, .size = { 10, 10 }, .reach = 1.5 };
    check_ok (pg_raster (&spots, SIZE, SIZE, owner));
    assert_int_equal (owner[0], 3);
    for (int p = 2; p < SIZE * SIZE; p++) if (p % SIZE > 3) assert_int_equal (owner[p], -1);
}

/* A spiral of 500 points of about equal density in a disk: each pixel inside belongs to the nearest point,
 * none is left out, and the disk grows by less than half a spacing; a straight cut opened by three spacings
 * stays open. */
static void points_of_no_lattice_fill_the_body (void **state)
{
    (void) state;
    enum { POINTS = 500 };
    double at[2 * POINTS], spacing[POINTS], R = 80, h = R * sqrt (3.141592653589793 / POINTS);
    pg_spots spots = { .n = POINTS, .place = at, .spacing = spacing };
    for (int open = 0; open < 2; open++) {
        for (int k = 0; k < POINTS; k++) {
            double r = R * sqrt ((k + 0.5) / POINTS), t = 2.399963229728653 * k;
            at[2 * k] = 100 + r * cos (t),
                   at[2 * k + 1] = 100 + r * sin (t) + (open ? (sin (t) > 0 ? 1.5 * h : -1.5 * h) : 0);
            spacing[k] = h;
        }
        check_ok (pg_raster (&spots, SIZE, SIZE, owner));
        for (int y = 0; y < SIZE; y++)
            for (int x = 0; x < SIZE; x++) {
                double r = hypot (x + 0.5 - 100, y + 0.5 - 100), best = 1e9;
                int nearest = -1;
                if (open && fabs (y + 0.5 - 100) < 0.9 * h && r < R) assert_int_equal (covered (x, y), 0);
                if (open) continue;
                if (r < R - h) assert_true (covered (x, y));
                if (r > R + 0.5 * h) assert_false (covered (x, y));
                for (int k = 0; k < POINTS; k++) {
                    double d = hypot (x + 0.5 - at[2*k], y + 0.5 - at[2*k + 1]);
                    if (d < best - 1e-4) best = d, nearest = k;
                }
                if (covered (x, y) && owner[y * SIZE + x] != nearest)
                    check_relative (hypot (x + 0.5 - at[2 * owner[y * SIZE + x]],
                                           y + 0.5 - at[2 * owner[y * SIZE + x] + 1]),
                                    best, 1e-3);
            }
    }
}

/* Lattices, moved or not, with a step that is not the nominal one, are none; a spiral is. */
static void lattices_are_told_from_other_points (void **state)
{
    (void) state;
    for (int kind = 0; kind < 4; kind++) {
        double x[2 * SIDE * SIDE], volume[SIDE * SIDE], *spacing;
        pg_spots made = lattice (1, kind == 1 ? 0.2 : 0, 1);
        pg_cloud c = { .dim = 2, .n = SIDE * SIDE, .x = x, .volume = volume, .h = 1 };
        for (size_t i = 0; i < c.n; i++) {
            for (int a = 0; a < 2; a++)
                x[2 * i + (size_t) a] = made.place[2 * i + (size_t) a] * (kind == 2 ? 1.07 : 1);
            if (kind == 3)
                x[2 * i] = sqrt ((double) i) * cos (2.4 * (double) i),
                      x[2 * i + 1] = sqrt ((double) i) * sin (2.4 * (double) i);
            volume[i] = i % 23 ? 2 : 0.5;
        }
        check_ok (pg_loose_spacing (&c, &spacing));
        assert_int_equal (spacing != NULL, kind == 3);
        if (spacing) check_relative (spacing[1], 1, 1e-12);
        if (spacing) check_relative (spacing[0], 0.5, 1e-12);
        pg_free (spacing);
    }
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (cells_tile_without_gap_or_growth),
        cmocka_unit_test (the_nearest_point_owns_a_pixel),
        cmocka_unit_test (moved_points_leave_no_holes),
        cmocka_unit_test (an_opened_crack_stays_open),
        cmocka_unit_test (points_outside_or_nowhere_do_no_harm),
        cmocka_unit_test (points_of_no_lattice_fill_the_body),
        cmocka_unit_test (lattices_are_told_from_other_points),
    };
    return cmocka_run_group_tests_name ("output/raster", tests, NULL, NULL);
}
