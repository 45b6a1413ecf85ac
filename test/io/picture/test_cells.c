/* SPDX-License-Identifier: GPL-3.0-or-later
 * Points of which nothing but their places is known: cells of a lattice tile without gaps or growth, the
 * nearest point owns a pixel, cracks between displaced cells stay open, moved and irregular points leave no
 * holes. */
#include "check.h"
#include "io/picture/tiles.h"
#include <stdlib.h>

enum { SIZE = 200, SIDE = 23 };
static int owner[SIZE * SIZE];
static double place[2 * SIDE * SIDE];

/* Owners of SIZE x SIZE pixels, one to a unit, row 0 being at y = 0; step: edges of the cells. */
static void draw (pg_tiles t, double step)
{
    pg_screen s = { .left = 0, .top = SIZE, .scale = 1 };
    t.dim = 2, t.step[0] = t.step[1] = step;
    check_ok (pg_tiles_open (&t));
    check_ok (pg_screen_open (&s, SIZE, SIZE));
    check_ok (pg_tiles_draw (&t, &s));
    for (int p = 0; p < SIZE * SIZE; p++) owner[(SIZE - 1 - p / SIZE) * SIZE + p % SIZE] = s.owner[p];
    pg_screen_close (&s);
    pg_tiles_close (&t);
}

/* SIDE x SIDE points in cells of `step` from (10, 10); `shake` in steps. */
static pg_tiles lattice (double step, double shake)
{
    unsigned seed = 7;
    for (int k = 0; k < SIDE * SIDE; k++)
        for (int a = 0; a < 2; a++) {
            seed = seed * 1664525u + 1013904223u;
            place[2 * k + a] =
                10 + step * ((a ? k / SIDE : k % SIDE) + 0.5 + shake * (2 * (seed / 4294967296.0) - 1));
        }
    return (pg_tiles) { .n = SIDE * SIDE, .place = place };
}

static int covered (int x, int y) { return owner[y * SIZE + x] >= 0; }

static void cells_tile_without_gap_or_growth (void **state)
{
    (void) state;
    static const double steps[] = { 3, 7.31, 5.5, 0.9, 8 };
    for (int s = 0; s < 5; s++) {
        double step = steps[s], last = 10 + SIDE * step;
        draw (lattice (step, 0), step);
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
    draw ((pg_tiles) { .n = 2, .place = at }, 40);
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
    pg_tiles t = lattice (7.31, 0.2);
    t.loose = 1;
    draw (t, 7.31);
    int low = (int) (10 + 7.31), high = (int) (10 + (SIDE - 1) * 7.31);
    for (int y = low; y < high; y++) for (int x = low; x < high; x++) assert_true (covered (x, y));
}

static void an_opened_crack_stays_open (void **state)
{
    (void) state;
    double at[2 * 2];
    at[0] = 60, at[1] = 60, at[3] = 60;
    at[2] = 87;                                        /* a gap of a third of a cell, 70 to 77 */
    draw ((pg_tiles) { .n = 2, .place = at, .moved = 1 }, 20);
    assert_false (covered (73, 60));
    at[2] = 83;                                        /* stretch by 15 %: 70 to 73 is closed */
    draw ((pg_tiles) { .n = 2, .place = at, .moved = 1 }, 20);
    for (int x = 70; x < 73; x++) assert_true (covered (x, 60));
}

/* A spiral of 500 points of about equal density in a disk: each pixel inside belongs to the nearest point,
 * none is left out, and the disk grows by less than half a spacing; a straight cut opened by five spacings
 * stays open. */
static void points_of_no_lattice_fill_the_body (void **state)
{
    (void) state;
    enum { POINTS = 500 };
    double at[2 * POINTS], R = 80, h = R * sqrt (3.141592653589793 / POINTS);
    for (int open = 0; open < 2; open++) {
        for (int k = 0; k < POINTS; k++) {
            double r = R * sqrt ((k + 0.5) / POINTS), t = 2.399963229728653 * k;
            at[2 * k] = 100 + r * cos (t),
                   at[2 * k + 1] = 100 + r * sin (t) + (open ? (sin (t) > 0 ? 2.5 * h : -2.5 * h) : 0);
        }
        draw ((pg_tiles) { .n = POINTS, .place = at, .loose = 1, .area = 3.141592653589793 * R * R }, h);
        for (int y = 0; y < SIZE; y++)
            for (int x = 0; x < SIZE; x++) {
                double r = hypot (x + 0.5 - 100, y + 0.5 - 100), best = 1e9;
                int nearest = -1;
                if (open && fabs (y + 0.5 - 100) < 1.5 * h && r < R - 3 * h)
                    assert_int_equal (covered (x, y), 0);
                if (open) continue;
                if (r < R - h) assert_true (covered (x, y));
                if (r > R + 0.5 * h) assert_false (covered (x, y));
                for (int k = 0; k < POINTS; k++) {
                    double d = hypot (x + 0.5 - at[2*k], y + 0.5 - at[2*k + 1]);
                    if (d < best - 1e-4) best = d, nearest = k;
                }
                /* pixels are looked up in a finer drawing of the body at rest: up to one of them away */
                if (covered (x, y) && owner[y * SIZE + x] != nearest)
                    check_below (hypot (x + 0.5 - at[2 * owner[y * SIZE + x]],
                                        y + 0.5 - at[2 * owner[y * SIZE + x] + 1]),
                                 best + 1);
            }
    }
}

/* Lattices, also one with a step that is not the nominal one, are told from moved points and a spiral. */
static void lattices_are_told_from_other_points (void **state)
{
    (void) state;
    for (int kind = 0; kind < 4; kind++) {
        double x[2 * SIDE * SIDE], volume[SIDE * SIDE], *spacing;
        pg_tiles made = lattice (1, kind == 1 ? 0.2 : 0);
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
        assert_int_equal (spacing != NULL, kind == 1 || kind == 3);
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
        cmocka_unit_test (points_of_no_lattice_fill_the_body),
        cmocka_unit_test (lattices_are_told_from_other_points),
    };
    return cmocka_run_group_tests_name ("io/output/cells", tests, NULL, NULL);
}
