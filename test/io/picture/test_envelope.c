/* SPDX-License-Identifier: GPL-3.0-or-later
 * The envelope of an event path: what a test with rising displacement shows, worked out by hand; any sign and
 * unit; the length of a cloud of events against that of its envelope; quantities in words. */
#include "check.h"
#include "perigal/output.h"
#include "perigal/picture.h"

/* Springs of falling stiffness 2, 1.5, 1.2, 0.5 that give way at displacements 1, 0.8, 1.5, 1.4; NaN counts
 * for nothing. */
static const double px[] = { 1, 0.8, 1.5, NAN, 1.4 }, py[] = { 2, 1.2, 1.8, 5, 0.7 };

static void a_path_has_the_envelope_worked_out_by_hand (void **state)
{
    (void) state;
    static const double lx[] = { 0, 1, 1, 1.5, 1.5 }, ly[] = { 0, 2, 1.2, 1.8, 0.75 }, jx[] = { 1, 1.5 },
                        jy[] = { 2, 1.8 };
    static const double unit[][2] = { { 1, 1 }, { -1e-6, -15e6 }, { 1e3, -1e-3 } };
    for (size_t k = 0; k < sizeof unit / sizeof *unit; k++) {
        double x[5], y[5], ex[12], ey[12];
        size_t peak;
        for (int i = 0; i < 5; i++) x[i] = unit[k][0] * px[i], y[i] = unit[k][1] * py[i];
        assert_int_equal (pg_envelope (5, x, y, 1, ex, ey, &peak), 5);
        assert_int_equal (peak, 1);
        for (int i = 0; i < 5; i++)
            check_scaled (ex[i], unit[k][0] * lx[i], 1e-15, 0),
                check_scaled (ey[i], unit[k][1] * ly[i], 1e-15, 0);
        assert_int_equal (pg_envelope (5, x, y, 0, ex, ey, &peak), 2);
        assert_int_equal (peak, 0);
        for (int i = 0; i < 2; i++)
            check_relative (ex[i], unit[k][0] * jx[i], 0), check_relative (ey[i], unit[k][1] * jy[i], 0);
    }
}

static void states_that_hold_make_no_teeth (void **state)
{
    (void) state;
    double x[] = { 0.1, 0.2, 0.3 }, y[] = { 0.7, 1.4, 2.1 }, ex[8], ey[8];
    size_t peak;
    assert_int_equal (pg_envelope (3, x, y, 1, ex, ey, &peak), 4);         /* the origin and the three */
    assert_int_equal (peak, 3);
    assert_int_equal (pg_envelope (0, x, y, 1, ex, ey, &peak), 1);
    assert_int_equal (pg_envelope (0, x, y, 0, ex, ey, &peak), 0);
}

/* A stiffness that falls by a thousandth an event, at displacements drawn at random: the path goes up and
 * down by hundreds of peaks, its envelope by fewer than four; no event lies above it. */
static void a_cloud_of_events_has_a_short_envelope (void **state)
{
    (void) state;
    enum { EVENTS = 3000 };
    static double x[EVENTS], y[EVENTS], ex[2 * EVENTS + 2], ey[2 * EVENTS + 2];
    unsigned seed = 3;
    double path = 0, line = 0;
    size_t peak, n;
    for (int i = 0; i < EVENTS; i++) {
        seed = seed * 1664525u + 1013904223u;
        x[i] = (1 + 0.5 * i / EVENTS) * (0.4 + 0.6 * (seed / 4294967296.0)), y[i] = -pow (0.999, i) * x[i];
        if (i) path += fabs (y[i] - y[i - 1]);
    }
    n = pg_envelope (EVENTS, x, y, 1, ex, ey, &peak);
    for (size_t k = 1; k < n; k++) line += fabs (ey[k] - ey[k - 1]), assert_true (ex[k] >= ex[k - 1]);
    assert_true (path > 200 * fabs (ey[peak]));
    check_below (line, 4 * fabs (ey[peak]));
    for (int i = 0; i < EVENTS; i++) assert_true (fabs (y[i]) <= fabs (ey[peak]));
}

static void quantities_have_prefixes (void **state)
{
    (void) state;
    static const struct {
        double v;
        const char *unit, *text;
    } of[] = { { -1.5034e7, "N", "-15.03 MN" }, { 0, "N", "0 N" },
               { 2.5e-3, "m", "2.5 mm" },       { 2.5e6, "m", "2500 km" },
               { 1.7e-3, "m2", "0.0017 m2" },   { 5.7e7, "N/m", "57 MN/m" },
               { 0.999999, "J/m2", "1 J/m2" },  { -36e-3, "J/m2", "-36 mJ/m2" } };
    char text[48];
    for (size_t k = 0; k < sizeof of / sizeof *of; k++) {
        pg_picture_quantity (of[k].v, of[k].unit, text, sizeof text);
        assert_string_equal (text, of[k].text);
    }
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (a_path_has_the_envelope_worked_out_by_hand),
        cmocka_unit_test (states_that_hold_make_no_teeth),
        cmocka_unit_test (a_cloud_of_events_has_a_short_envelope),
        cmocka_unit_test (quantities_have_prefixes),
    };
    return cmocka_run_group_tests_name ("io/output/envelope", tests, NULL, NULL);
}
