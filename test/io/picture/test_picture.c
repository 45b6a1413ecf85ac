/* SPDX-License-Identifier: GPL-3.0-or-later
 * Pictures: right size, not blank, the right colour at the right place, failures named and nothing left
 * behind. */
#include "check.h"
#include "fonts.h"
#include "io/output/sample.h"
#include "perigal/picture.h"
#include <cairo.h>

typedef struct { int width, height, stride; unsigned char *byte; cairo_surface_t *surface; } image;

static void open_image (image *m, const char *path)
{
    m->surface = cairo_image_surface_create_from_png (path);
    assert_int_equal (cairo_surface_status (m->surface), CAIRO_STATUS_SUCCESS);
    m->width = cairo_image_surface_get_width (m->surface);
    m->height = cairo_image_surface_get_height (m->surface);
    m->stride = cairo_image_surface_get_stride (m->surface);
    m->byte = cairo_image_surface_get_data (m->surface);
}

static unsigned pixel (const image *m, int x, int y)
{
    unsigned value;
    memcpy (&value, m->byte + y * m->stride + 4 * x, 4);
    return value & 0xffffff;
}

/* Pixels whose three channels are within `slack` of a colour. */
static size_t count_near (const image *m, unsigned colour, int slack)
{
    size_t n = 0;
    for (int y = 0; y < m->height; y++)
        for (int x = 0; x < m->width; x++) {
            unsigned p = pixel (m, x, y);
            int near = 1;
            for (int c = 0; c < 24; c += 8)
                near &= abs ((int) (p >> c & 255) - (int) (colour >> c & 255)) <= slack;
            n += (size_t) near;
        }
    return n;
}
static size_t count (const image *m, unsigned colour) { return count_near (m, colour, 0); }

/* Variance of the green channel, 0 for a blank picture. */
static double variance (const image *m)
{
    double sum = 0, square = 0, n = (double) m->width * m->height;
    for (int y = 0; y < m->height; y++)
        for (int x = 0; x < m->width; x++) {
            double g = pixel (m, x, y) >> 8 & 255;
            sum += g, square += g * g;
        }
    return square / n - sum * sum / n / n;
}

enum { LOW = 0x2a1752, HIGH = 0xfbec6e, GREY = 0x9e9e9e };

/* A disk of 2 mm cells, D = 100 mm. */
static void make_disk (pg_cloud *c, double **value)
{
    make_cloud (c, 2, 51, 2e-3);
    *value = pg_calloc (c->n, sizeof (double));
    size_t k = 0;
    for (size_t i = 0; i < c->n; i++) {
        double x = c->x[2*i] - 0.048, y = c->x[2*i + 1] - 0.054;
        if (x * x + y * y > 0.0025 * (1 + 1e-9)) continue;
        c->x[2*k] = x, c->x[2*k + 1] = y;
        (*value)[k++] = x < -0.001 ? 0 : 1;
    }
    c->n = k;
}

static void a_field_shows_the_right_colour_at_the_right_place (void **state)
{
    (void) state;
    pg_cloud c;
    double *value;
    image m;
    const char *path = file_at ("disk.png");
    make_disk (&c, &value);
    check_ok (pg_picture_field (path, &c, value, &(pg_picture_style) { .title = "disk", .label = "damage" }));
    open_image (&m, path);
    assert_true (m.width >= 1000 && m.width <= 1400 && m.height > 800);
    assert_true (variance (&m) > 100);
    int y = m.height / 2, first = -1, change = -1, last = -1;
    for (int x = 0; x < m.width; x++) {
        if (pixel (&m, x, y) == LOW && first < 0) first = x;
        if (pixel (&m, x, y) == HIGH && change < 0) change = x;
        if (pixel (&m, x, y) == HIGH) last = x;
    }
    assert_true (first > 0 && change > first && last > change);
    check_relative ((change - first) / (double) (last + 1 - first), 24.0 / 49, 3e-3);
    for (int x = first; x < change; x++) assert_int_equal (pixel (&m, x, y), LOW);
    for (int x = change; x <= last; x++) assert_int_equal (pixel (&m, x, y), HIGH);
    for (y = 0; y < m.height; y++) {                   /* the widest row: the tips of the disk */
        for (int x = 0; x < first; x++) if (pixel (&m, x, y) == LOW) first = x;
        for (int x = m.width - 200; x > last; x--) if (pixel (&m, x, y) == HIGH) last = x;
    }
    double cell = (last + 1 - first) / 51.0;
    check_relative ((double) (count (&m, LOW) + count (&m, HIGH)), (double) c.n * cell * cell, 0.01);
    cairo_surface_destroy (m.surface);
    pg_free (value);
    drop_cloud (&c);
}

static void nan_is_grey (void **state)
{
    (void) state;
    pg_cloud c;
    double *value;
    image m;
    const char *path = file_at ("nan.png");
    make_disk (&c, &value);
    check_ok (pg_picture_field (path, &c, value, &(pg_picture_style) { .label = "v" }));
    open_image (&m, path);
    size_t before = count (&m, GREY);
    cairo_surface_destroy (m.surface);
    for (size_t i = 0; i < 10; i++) value[i] = NAN;
    check_ok (pg_picture_field (path, &c, value, &(pg_picture_style) { .label = "v" }));
    open_image (&m, path);
    assert_true (count (&m, GREY) > before + 2000);
    cairo_surface_destroy (m.surface);
    for (size_t i = 0; i < c.n; i++) value[i] = NAN;
    check_ok (pg_picture_field (path, &c, value, &(pg_picture_style) { .label = "v" }));
    pg_free (value);
    drop_cloud (&c);
}

static void equal_values_are_drawn (void **state)
{
    (void) state;
    static const double constant[] = { 0, -7, 1e9 };
    pg_cloud c;
    double *value;
    make_disk (&c, &value);
    for (int k = 0; k < 6; k++) {
        image m;
        const char *path = file_at ("equal.png");
        for (size_t i = 0; i < c.n; i++) value[i] = constant[k % 3];
        check_ok (
            pg_picture_field (path, &c, value, &(pg_picture_style){ .label = "v", .diverging = k / 3 }));
        open_image (&m, path);
        assert_true (variance (&m) > 10);
        cairo_surface_destroy (m.surface);
    }
    pg_free (value);
    drop_cloud (&c);
}

static void cracks_are_black_lines (void **state)
{
    (void) state;
    pg_cloud c;
    double *value, vertex[] = { -0.02, -0.02, 0.02, 0.02 };
    pg_crack crack = { .kind = PG_CRACK_SEGMENT, .vertex = vertex, .nvertex = 2 };
    pg_cracks cracks = { .dim = 2, .crack = &crack, .n = 1 };
    image with, without;
    make_disk (&c, &value);
    const char *a = file_at ("without.png"), *b = file_at ("with.png");
    check_ok (pg_picture_field (a, &c, value, &(pg_picture_style) { .label = "v" }));
    check_ok (pg_picture_field (b, &c, value, &(pg_picture_style) { .label = "v", .cracks = &cracks }));
    open_image (&without, a), open_image (&with, b);
    assert_int_equal (with.width, without.width);
    assert_true (count_near (&with, 0, 20) > count_near (&without, 0, 20) + 500);
    cairo_surface_destroy (with.surface), cairo_surface_destroy (without.surface);
    pg_free (value);
    drop_cloud (&c);
}

/* Cracks grow: every panel draws those of its own state, of the style only where it has none. */
static void a_panel_has_its_own_cracks (void **state)
{
    (void) state;
    pg_cloud c;
    double *value, vertex[] = { -0.02, -0.02, 0.02, 0.02, -0.02, -0.02, -0.01, -0.01 };
    pg_crack crack[2] = { { .kind = PG_CRACK_SEGMENT, .vertex = vertex, .nvertex = 2 },
                          { .kind = PG_CRACK_SEGMENT, .vertex = vertex + 4, .nvertex = 2, .sided = 1 } };
    pg_cracks grown = { .dim = 2, .crack = crack, .n = 1 }, first = { .dim = 2, .crack = crack + 1, .n = 1 };
    long black[3];
    make_disk (&c, &value);
    for (int k = 0; k < 3; k++) {
        pg_panel panel = { NULL, value, NULL, NULL, NULL, k == 0 ? NULL : k == 1 ? &first : &grown };
        pg_picture_style style = { .label = "v", .cracks = k == 0 ? &grown : &first };
        const char *path = file_at ("panel.png");
        image m;
        check_ok (pg_picture_panels (path, &c, 1, &panel, 1, &style));
        open_image (&m, path);
        black[k] = (long) count_near (&m, 0, 20);
        cairo_surface_destroy (m.surface);
    }
    assert_int_equal (black[0], black[2]);
    assert_true (black[1] < black[0] - 300);
    pg_free (value);
    drop_cloud (&c);
}

static void a_section_shows_its_own_layer (void **state)
{
    (void) state;
    pg_cloud c;
    image m;
    const char *path = file_at ("section.png");
    make_cloud (&c, 3, 5, 1e-3);
    double *value = pg_calloc (c.n, sizeof (double));
    int named = 0;  /* height of a picture whose title says where it cuts: the layer nobody asked for */
    for (int section = 0; section <= 3; section++) {
        int axis = section ? section - 1 : 2;
        double at = c.low[axis] + 2 * c.step[axis];
        for (size_t i = 0; i < c.n; i++) value[i] = fabs (c.x[3*i + (size_t) axis] - at) < 1e-9 ? 1 : 0;
        check_ok (pg_picture_field (path, &c, value,
                                    &(pg_picture_style){
                                        .label = "v", .low = 0, .high = 1, .section = section, .at = at }));
        open_image (&m, path);
        assert_true (count (&m, HIGH) > 400000 && count (&m, LOW) < 200);
        if (section == 0) named = m.height;
        else if (section == 3) assert_true (named > m.height + 30);
        cairo_surface_destroy (m.surface);
    }
    check_fails (pg_picture_field (path, &c, value, &(pg_picture_style){ .section = 1, .at = 1 }),
                 PG_E_USAGE);
    pg_free (value);
    drop_cloud (&c);
}

static void points_on_a_line_make_a_chart (void **state)
{
    (void) state;
    pg_cloud c;
    image m;
    const char *path = file_at ("line.png");
    make_cloud (&c, 1, 40, 1e-3);
    check_ok (
        pg_picture_field (path, &c, c.volume, &(pg_picture_style){ .title = "bar", .label = "volume (m3)" }));
    open_image (&m, path);
    assert_true (m.width == 1200 && variance (&m) > 10);
    cairo_surface_destroy (m.surface);
    drop_cloud (&c);
}

static void every_curve_has_its_colour (void **state)
{
    (void) state;
    double x[] = { 0, 1, 2, 3 }, y[] = { 0, 2, NAN, 1 }, z[] = { 1, 1.5, 0.5, 0.2 };
    pg_curve curves[] = { { "a", 4, x, y, 0 }, { "b", 4, x, z, 1 } };
    image m;
    const char *path = file_at ("chart.png");
    check_ok (
        pg_picture_chart (path, 2, curves, &(pg_chart_style){ .title = "t", .xlabel = "x", .ylabel = "y" }));
    open_image (&m, path);
    assert_true (count_near (&m, 0x124a99, 2) > 300 && count_near (&m, 0xd6540f, 2) > 300);
    cairo_surface_destroy (m.surface);
}

/* 12 curves: two colours occur twice, solid and dashed; the legend moves beside the frame where it would hide
 * one. */
static void many_curves_stay_apart (void **state)
{
    (void) state;
    double x[] = { 1, 2, 4, 8 }, y[12][4];
    pg_curve curve[12];
    image m;
    for (int k = 0; k < 12; k++) {
        for (int i = 0; i < 4; i++) y[k][i] = pow (2, k) * x[i] * x[i];
        curve[k] = (pg_curve) { "a method", 4, x, y[k], PG_CURVE_LINE };
    }
    const char *path = file_at ("many.png");
    size_t solid, dashed;
    check_ok (pg_picture_chart (path, 1, curve, &(pg_chart_style) { .logx = 1, .logy = 1 }));
    open_image (&m, path);
    solid = count_near (&m, 0x124a99, 2);
    assert_int_equal (m.width, 1200);
    cairo_surface_destroy (m.surface);
    pg_curve ninth[9] = { [8] = { "a method", 4, x, y[0], PG_CURVE_LINE } };
    check_ok (pg_picture_chart (path, 9, ninth, &(pg_chart_style) { .logx = 1, .logy = 1 }));
    open_image (&m, path);
    dashed = count_near (&m, 0x124a99, 2);
    assert_true (dashed > solid / 3 && dashed < 0.9 * (double) solid);
    cairo_surface_destroy (m.surface);
    check_ok (pg_picture_chart (path, 12, curve, &(pg_chart_style) { .logx = 1, .logy = 1 }));
    open_image (&m, path);
    assert_true (m.width > 1300);
    cairo_surface_destroy (m.surface);
}

/* The triangle of the right slope is filled in the pale colour of its curve: half of its box of pixels; none
 * on linear axes. */
static void slopes_are_drawn_under_their_curve (void **state)
{
    (void) state;
    double x[] = { 1, 10, 100 }, y[] = { 1, 100, 10000 };
    pg_curve curve = { NULL, 3, x, y, PG_CURVE_BOTH };
    pg_chart_slope slope[] = { { 2, 0, 2, 50 }, { 2, 7, 0, 0 }, { 2, 0, 200, 300 } };
    image m;
    const char *path = file_at ("slope.png");
    for (int log = 0; log < 2; log++) {
        check_ok (
            pg_picture_chart (path, 1, &curve,
                              &(pg_chart_style){ .logx = log, .logy = 1, .nslope = 3, .slopes = slope }));
        open_image (&m, path);
        size_t pale = count_near (&m, 0xe1e8f2, 4);
        double box = 0.6 * 1000 * 0.6 * 700;  /* share of the axes that ln 25 takes of about ln 1000 */
        if (log) assert_true ((double) pale > 0.25 * box && (double) pale < 0.75 * box);
        else assert_true (pale < 1000);                /* edges of curve and grid */
        cairo_surface_destroy (m.surface);
    }
}

/* A path behind a curve is pale and in the legend; a mark is a ring around its place, with a text that hides
 * no curve. */
static void paths_are_pale_and_peaks_are_ringed (void **state)
{
    (void) state;
    double x[] = { 0, -1, -2, -2 }, y[] = { 0, -3, -4, -1 }, px[] = { -1, -0.5, -2, -0.4 },
           py[] = { -3, -1, -2, -0.2 };
    pg_curve curve = { "envelope", 4, x, y, PG_CURVE_LINE }, path = { "path", 4, px, py, PG_CURVE_LINE };
    pg_chart_mark mark = { 0, -2, -4, "peak" };
    size_t full[3], pale[3], dark[3];
    const char *file = file_at ("marks.png");
    image m;
    for (int k = 0; k < 3; k++) {
        check_ok (pg_picture_chart (file, 1, &curve,
                                    &(pg_chart_style){
                                        .npale = k > 0, .pale = &path, .nmark = k > 1, .marks = &mark }));
        open_image (&m, file);
        full[k] = count_near (&m, 0x124a99, 45), pale[k] = count_near (&m, 0xb5c6df, 28),
        dark[k] = count_near (&m, 0, 20);
        assert_int_equal (m.width, 1200);
        cairo_surface_destroy (m.surface);
    }
    assert_true (pale[1] > pale[0] + 300);
    assert_true (full[1] > full[0] + 100);             /* the sample in the legend */
    assert_true (full[2] > full[1] + 40);
    assert_true (dark[2] > dark[1] + 100);
}

static void a_chart_of_nothing_is_drawn (void **state)
{
    (void) state;
    double x[] = { NAN, -1 }, y[] = { 1, -1 };
    pg_curve curve = { NULL, 2, x, y, 0 };
    check_ok (pg_picture_chart (file_at ("nothing.png"), 0, NULL, &(pg_chart_style) { .logx = 1 }));
    check_ok (
        pg_picture_chart (file_at ("negative.png"), 1, &curve, &(pg_chart_style){ .logx = 1, .logy = 1 }));
}

static void svg_is_written_by_the_ending (void **state)
{
    (void) state;
    pg_cloud c;
    double *value;
    char text[200] = "";
    const char *path = file_at ("disk.svg");
    make_disk (&c, &value);
    check_ok (pg_picture_field (path, &c, value, &(pg_picture_style) { .title = "disk", .label = "damage" }));
    FILE *file = fopen (path, "r");
    assert_true (fread (text, 1, sizeof text - 1, file) > 100);
    fclose (file);
    check_contains (text, "<svg");
    check_fails (pg_picture_field (file_at ("disk.pdf"), &c, value, &(pg_picture_style){ .label = "" }),
                 PG_E_USAGE);
    pg_free (value);
    drop_cloud (&c);
}

static void a_failed_write_is_named (void **state)
{
    (void) state;
    static const char *const name[] = { "full.png", "full.svg" };
    double x[] = { 0, 1 };
    pg_curve curve = { NULL, 2, x, x, 0 };
    check_fails (pg_picture_chart (file_at ("missing/a.png"), 1, &curve, &(pg_chart_style){ .logx = 0 }),
                 PG_E_FILE);
    check_contains (pg_last_error (), "missing/a.png: No such file");
    for (int k = 0; k < 2; k++) {
        const char *path = file_at (name[k]);
        assert_int_equal (symlink ("/dev/full", path), 0);
        check_fails (pg_picture_chart (path, 1, &curve, &(pg_chart_style) { .logx = 0 }), PG_E_FILE);
        check_contains (pg_last_error (), path);
        check_contains (pg_last_error (), "No space left");
    }
}

static void any_allocation_may_fail (void **state)
{
    (void) state;
    double x[] = { 0, 1 };
    pg_curve curve = { NULL, 2, x, x, 0 };
    for (int kind = 0; kind < 3; kind++) {
        pg_cloud c;
        make_cloud (&c, kind == 1 ? 1 : 2, 5, 1);
        size_t before = pg_memory_used (), k = 1;
        pg_status status = PG_E_MEMORY;
        const char *path = file_at ("sweep.png");
        for (; status != PG_OK && k < 50; k++) {
            pg_memory_fail_at (k);
            status = kind == 2 ? pg_picture_chart (path, 1, &curve, &(pg_chart_style) { .logx = 0 })
                               : pg_picture_field (path, &c, c.volume, &(pg_picture_style) { .label = "v" });
            pg_memory_fail_at (0);
            assert_true (status == PG_OK || status == PG_E_MEMORY);
            assert_int_equal (access (path, F_OK) == 0, status == PG_OK);
            assert_int_equal (pg_memory_used (), before);
        }
        assert_true (status == PG_OK && k > 2);
        remove (path);
        drop_cloud (&c);
    }
}

static void a_time_is_told_in_its_own_unit (void **state)
{
    (void) state;
    static const struct {
        double t;
        const char *text;
    } of[] = { { 0, "0 s" },
               { 1.33670000001e-5, "13.37 \xc2\xb5s" },
               { 5e-5, "50 \xc2\xb5s" },
               { 2.5, "2.5 s" },
               { 1e-3, "1 ms" },
               { 0.99996e-3, "1 ms" },
               { 4e-11, "0.04 ns" },
               { 7200, "7200 s" } };
    char text[32];
    for (size_t k = 0; k < sizeof of / sizeof *of; k++) {
        pg_picture_time (of[k].t, text, sizeof text);
        assert_string_equal (text, of[k].text);
    }
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (a_time_is_told_in_its_own_unit),
        cmocka_unit_test (a_field_shows_the_right_colour_at_the_right_place),
        cmocka_unit_test (nan_is_grey),
        cmocka_unit_test (equal_values_are_drawn),
        cmocka_unit_test (cracks_are_black_lines),
        cmocka_unit_test (a_panel_has_its_own_cracks),
        cmocka_unit_test (a_section_shows_its_own_layer),
        cmocka_unit_test (points_on_a_line_make_a_chart),
        cmocka_unit_test (every_curve_has_its_colour),
        cmocka_unit_test (many_curves_stay_apart),
        cmocka_unit_test (slopes_are_drawn_under_their_curve),
        cmocka_unit_test (paths_are_pale_and_peaks_are_ringed),
        cmocka_unit_test (a_chart_of_nothing_is_drawn),
        cmocka_unit_test (svg_is_written_by_the_ending),
        cmocka_unit_test (a_failed_write_is_named),
        cmocka_unit_test (any_allocation_may_fail),
    };
    return cmocka_run_group_tests_name ("io/output/picture", tests, NULL, remove_folder);
}
