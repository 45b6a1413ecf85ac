/* SPDX-License-Identifier: GPL-3.0-or-later
 * Axes: round ticks, texts without noise, factors and prefixes in the label, room between texts; colour
 * maps. */
#include "check.h"
#include "fonts.h"
#include "io/picture/picture_private.h"

static cairo_surface_t *surface;
static cairo_t *cr;

static int open_canvas (void **unused)
{
    (void) unused;
    assert_int_equal (pg_cairo_load (), PG_OK);
    surface = cairo_image_surface_create (CAIRO_FORMAT_A8, 1, 1);
    cr = cairo_create (surface);
    return 0;
}

static int close_canvas (void **unused)
{
    (void) unused;
    cairo_destroy (cr);
    cairo_surface_destroy (surface);
    return 0;
}

static pg_axis fit (double low, double high, double length, const char *label, pg_side side, int log,
                    int grow)
{
    pg_axis a;
    pg_axis_request wish = { label, side, log, grow, 0 };
    pg_axis_fit (&a, cr, low, high, length, &wish);
    return a;
}

static void check_texts (const pg_axis *a, const char *expected)
{
    char all[1000] = "";
    for (int k = 0; k < a->n; k++) strcat (strcat (all, k ? " " : ""), a->text[k]);
    assert_string_equal (all, expected);
}

static void ticks_are_round_and_without_noise (void **state)
{
    (void) state;
    pg_axis a = fit (0, 0.7, 700, "", PG_BOTTOM, 0, 0);
    check_texts (&a, "0.0 0.2 0.4 0.6");
    a = fit (0, 100, 600, "", PG_LEFT, 0, 0);
    check_texts (&a, "0 20 40 60 80 100");
    a = fit (-0.05, 0.051, 500, "", PG_LEFT, 0, 0);
    check_texts (&a, "\xe2\x88\x92" "0.04 \xe2\x88\x92" "0.02 0.00 0.02 0.04");
}

static void a_growing_axis_ends_on_ticks (void **state)
{
    (void) state;
    pg_axis a = fit (0.3, 13.2, 500, "", PG_LEFT, 0, 1);
    check_texts (&a, "0 5 10 15");
    assert_true (a.low == 0 && a.high == 15);
    check_relative (pg_axis_at (&a, 7.5), 0.5, 1e-14);
}

static void no_unit_is_special (void **state)
{
    (void) state;
    pg_axis one = fit (0, 7, 500, "x", PG_LEFT, 0, 0);
    for (int k = -18; k <= 18; k += 3) {
        pg_axis a = fit (0, 7 * pow (10, k), 500, "x", PG_LEFT, 0, 0);
        assert_int_equal (a.n, one.n);
        for (int t = 1; t < a.n; t++) check_relative (a.tick[t], one.tick[t] * pow (10, k), 1e-12);
    }
}

static void small_and_large_values_take_a_factor (void **state)
{
    (void) state;
    pg_axis a = fit (0, 4e-6, 500, "error", PG_LEFT, 0, 0);
    assert_string_equal (a.label, "error (\xc3\x97" "10^{\xe2\x88\x92" "6})");
    check_texts (&a, "0 1 2 3 4");
    a = fit (0, 3e7, 500, "moment (N2)", PG_LEFT, 0, 0);
    assert_string_equal (a.label, "moment (\xc3\x97" "10^{6} N2)");
    a = fit (0, 300, 500, "force (N)", PG_LEFT, 0, 0);
    assert_string_equal (a.label, "force (N)");
}

static void units_take_prefixes (void **state)
{
    (void) state;
    static const struct { double top; const char *label, *expected;
    } row[] = {
        { 4e6, "stress (Pa)", "stress (MPa)" },
        { 2e-6, "u (m)", "u (\xc2\xb5m)" },
        { 2e4, "F (N)", "F (kN)" },
        { 3e-4, "t (s)", "t (\xc2\xb5s)" },
        { 5e5, "k (N/m)", "k (kN/m)" },
        { 2e10, "E (Pa)", "E (GPa)" },
        { 2, "u (m)", "u (m)" },
    };
    for (size_t k = 0; k < sizeof row / sizeof *row; k++) {
        pg_axis a = fit (0, row[k].top, 500, row[k].label, PG_LEFT, 0, 0);
        assert_string_equal (a.label, row[k].expected);
    }
}

static void texts_never_touch (void **state)
{
    (void) state;
    static const double offset[] = { 0, 1e3, 123456, -5e7 };
    for (int o = 0; o < 4; o++)
        for (double length = 150; length < 1300; length *= 1.3)
            for (int log = 0; log < 2; log++) {
                pg_axis a = fit (log ? 1e-9 : offset[o], log ? 3e5 : offset[o] + 17.3, length, "", PG_BOTTOM,
                                 log, 0);
                for (int k = 0; k + 1 < a.n; k++) {
                    double gap = (pg_axis_at (&a, a.tick[k + 1]) - pg_axis_at (&a, a.tick[k])) * length;
                    double need = 0.5
                                  * (pg_text (cr, a.text[k], PG_FONT, 0, 0, 0, 0, 0)
                                     + pg_text (cr, a.text[k + 1], PG_FONT, 0, 0, 0, 0, 0));
                    assert_true (gap > need);
                }
            }
}

static void log_axes_have_decades (void **state)
{
    (void) state;
    pg_axis a = fit (2e-5, 0.3, 600, "", PG_LEFT, 1, 1);
    check_texts (&a, "10^{\xe2\x88\x92"
                     "4} 10^{\xe2\x88\x92"
                     "3} 10^{\xe2\x88\x92"
                     "2} 10^{\xe2\x88\x92"
                     "1}");
    assert_true (a.low < 2e-5 && a.high > 0.3 && a.nminor > 20);
    a = fit (0.00625, 0.1, 600, "", PG_LEFT, 1, 1);
    check_texts (&a, "0.005 0.01 0.02 0.05 0.1");
    a = fit (3, 3, 600, "", PG_LEFT, 1, 1);
    check_texts (&a, "2 5");
    assert_true (a.low <= 3 && a.high >= 3);
}

static void equal_values_get_a_range (void **state)
{
    (void) state;
    static const double value[] = { 0, 5, -3e-9, 2e12 };
    for (int k = 0; k < 4; k++) {
        pg_axis a = fit (value[k], value[k], 500, "", PG_LEFT, 0, 0);
        assert_true (a.low < a.high && a.low <= value[k] && a.high >= value[k]);
        assert_true (a.n >= 2);
    }
    double low = 3, high = 3 + 4e-16;
    pg_range_widen (&low, &high);
    check_relative (high - low, 0.6, 1e-12);
}

static void ranges_skip_what_cannot_be_drawn (void **state)
{
    (void) state;
    double v[] = { NAN, 4, -2, INFINITY, 9 }, low, high;
    assert_int_equal (pg_range_of (5, v, 0, &low, &high), 1);
    assert_true (low == -2 && high == 9);
    assert_int_equal (pg_range_of (5, v, 1, &low, &high), 1);
    assert_true (low == 4 && high == 9);
    assert_int_equal (pg_range_of (1, v, 0, &low, &high), 0);
    assert_true (low < high);
}

/* CIE lightness of an sRGB colour */
static double lightness (const double rgb[3])
{
    static const double weight[] = { 0.2126, 0.7152, 0.0722 };
    double y = 0;
    for (int c = 0; c < 3; c++)
        y += weight[c] * (rgb[c] <= 0.04045 ? rgb[c] / 12.92 : pow ((rgb[c] + 0.055) / 1.055, 2.4));
    return 116 * cbrt (y) - 16;
}

static void the_sequential_map_gets_lighter_evenly (void **state)
{
    (void) state;
    double rgb[3], last, first;
    pg_colour_sequential (0, rgb);
    first = last = lightness (rgb);
    for (int k = 1; k <= 20; k++) {
        pg_colour_sequential (k / 20.0, rgb);
        double now = lightness (rgb), mean = (now - first) / k;
        assert_true (now - last > 2.0 && now - last < 6.5 && mean > 3);
        last = now;
    }
    assert_true (last - first > 70);
}

static void the_diverging_map_is_blue_white_red (void **state)
{
    (void) state;
    double low[3], mid[3], high[3];
    pg_colour_diverging (-7, low), pg_colour_diverging (0.5, mid), pg_colour_diverging (NAN, high),
        pg_colour_diverging (7, high);
    assert_true (low[2] > low[0] && high[0] > high[2] && mid[0] > 0.9 && mid[1] > 0.9 && mid[2] > 0.9);
    check_scaled (lightness (low), lightness (high), 0.1, 100);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (ticks_are_round_and_without_noise),
        cmocka_unit_test (a_growing_axis_ends_on_ticks),
        cmocka_unit_test (no_unit_is_special),
        cmocka_unit_test (small_and_large_values_take_a_factor),
        cmocka_unit_test (units_take_prefixes),
        cmocka_unit_test (texts_never_touch),
        cmocka_unit_test (log_axes_have_decades),
        cmocka_unit_test (equal_values_get_a_range),
        cmocka_unit_test (ranges_skip_what_cannot_be_drawn),
        cmocka_unit_test (the_sequential_map_gets_lighter_evenly),
        cmocka_unit_test (the_diverging_map_is_blue_white_red),
    };
    return cmocka_run_group_tests_name ("io/output/axes", tests, open_canvas, close_canvas);
}
