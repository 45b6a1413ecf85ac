/* SPDX-License-Identifier: GPL-3.0-or-later
 * Pictures of 3D bodies as files: front differs from back where the field does, hidden values stay hidden,
 * sections show one layer, panels share a colour bar, no picture is blank. */
#include "check.h"
#include "fonts.h"
#include "io/output/sample.h"
#include "perigal/picture.h"
#include <cairo.h>

enum { LOW = 0x2a1752, HIGH = 0xfbec6e, M = 9 };

typedef struct { int width, height; size_t high, low, dark; double variance; unsigned hash; } look;

/* What a picture shows: pixels of the ends of the colour map, dark pixels of lines and texts, variance of
 * green. */
static look look_at (const char *path)
{
    look l = { .hash = 1 };
    double sum = 0, square = 0;
    cairo_surface_t *image = cairo_image_surface_create_from_png (path);
    assert_int_equal (cairo_surface_status (image), CAIRO_STATUS_SUCCESS);
    l.width = cairo_image_surface_get_width (image), l.height = cairo_image_surface_get_height (image);
    for (int y = 0; y < l.height; y++)
        for (int x = 0; x < l.width; x++) {
            unsigned p;
            memcpy (&p,
                    cairo_image_surface_get_data (image) + y * cairo_image_surface_get_stride (image) + 4 * x,
                    4);
            p &= 0xffffff;
            double green = p >> 8 & 255;
            l.high += p == HIGH, l.low += p == LOW, l.dark += p < 0x101010;
            sum += green, square += green * green, l.hash = (l.hash ^ p) * 16777619u;
        }
    cairo_surface_destroy (image);
    double n = (double) l.width * l.height;
    l.variance = square / n - sum * sum / n / n;
    return l;
}

static look picture_of (const pg_cloud *c, const double *value, pg_picture_style style)
{
    const char *path = file_at ("view.png");
    style.label = "v", style.title = "t";
    check_ok (pg_picture_field (path, c, value, &style));
    look l = look_at (path);
    assert_true (l.variance > 100 && l.width > 600 && l.height > 300);
    return l;
}

static double *make_body (pg_cloud *c)
{
    make_cloud (c, 3, M, 1e-3);
    for (size_t i = 0; i < c->n; i++) c->volume[i] = 1e-9;
    return pg_calloc (c->n, sizeof (double));
}

static void front_and_back_differ_as_the_field_does (void **state)
{
    (void) state;
    pg_cloud c;
    double *value = make_body (&c);
    for (size_t i = 0; i < c.n; i++) value[i] = i >= c.n - M * M;       /* z high */
    look front = picture_of (&c, value, (pg_picture_style) { .view = PG_VIEW_FRONT, .high = 1 });
    look back = picture_of (&c, value, (pg_picture_style) { .view = PG_VIEW_BACK, .high = 1 });
    assert_true (front.high > 400000 && front.low < 500);
    assert_true (back.low > 400000 && back.high < 500);
    pg_free (value);
    drop_cloud (&c);
}

static void what_is_inside_is_hidden_from_every_side (void **state)
{
    (void) state;
    pg_cloud c;
    double *value = make_body (&c);
    for (int view = PG_VIEW_FRONT; view <= PG_VIEW_ISO; view += longer () ? 1 : 2) {
        value[c.n / 2] = 0;
        look without = picture_of (&c, value, (pg_picture_style) { .view = view, .high = 1 });
        value[c.n / 2] = 1;
        look with = picture_of (&c, value, (pg_picture_style) { .view = view, .high = 1 });
        assert_int_equal (with.hash, without.hash);
        value[0] = value[c.n - 1] = 1;                 /* opposite corners: one of them is in sight */
        assert_int_not_equal (picture_of (&c, value, (pg_picture_style){ .view = view, .high = 1 }).hash,
                              without.hash);
        value[0] = value[c.n - 1] = 0;
    }
    pg_free (value);
    drop_cloud (&c);
}

static void only_points_above_the_limit_are_drawn (void **state)
{
    (void) state;
    pg_cloud c;
    double *value = make_body (&c);
    value[c.n / 2] = 1;
    look all = picture_of (&c, value, (pg_picture_style) { .view = PG_VIEW_FRONT, .high = 1 });
    look some = picture_of (&c, value,
                            (pg_picture_style){
                                .view = PG_VIEW_FRONT, .high = 1, .select = value, .above = 0.5 });
    assert_true (all.low > 400000 && all.high < 500);
    assert_true (some.low < 500 && some.high > 5000);
    pg_free (value);
    drop_cloud (&c);
}

static void a_crack_that_is_not_there_leaves_the_outline (void **state)
{
    (void) state;
    pg_cloud c;
    double *value = make_body (&c),
           vertex[] = { 0, 3e-3, 5e-3, 4e-3, 3e-3, 5e-3, 4e-3, 6e-3, 9e-3, 0, 6e-3, 9e-3 };
    pg_crack crack = { .kind = PG_CRACK_POLYGON, .vertex = vertex, .nvertex = 4 };
    pg_cracks cracks = { .dim = 3, .crack = &crack, .n = 1 };
    pg_picture_style style = {
        .view = PG_VIEW_CRACK, .select = value, .above = PG_CRACK_DAMAGE, .by_depth = 1
    };
    look plain = picture_of (&c, value, style);
    style.cracks = &cracks;
    look outlined = picture_of (&c, value, style);
    assert_true (outlined.dark > plain.dark + 500);
    value[c.n / 2] = 1;
    assert_int_not_equal (picture_of (&c, value, style).hash, outlined.hash);
    pg_free (value);
    drop_cloud (&c);
}

static void another_direction_is_another_picture (void **state)
{
    (void) state;
    pg_cloud c;
    double *value = make_body (&c);
    value[0] = 1;                                      /* the corner x, y, z low */
    look usual = picture_of (&c, value, (pg_picture_style) { .view = PG_VIEW_ISO, .high = 1 });
    look below = picture_of (&c, value,
                             (pg_picture_style){
                                 .view = PG_VIEW_ISO, .high = 1, .direction = { -1, -1, -1 } });
    value[0] = 0;
    assert_int_equal (picture_of (&c, value, (pg_picture_style){ .view = PG_VIEW_ISO, .high = 1 }).hash,
                      usual.hash);
    assert_int_not_equal (picture_of (&c, value,
                                      (pg_picture_style){
                                          .view = PG_VIEW_ISO, .high = 1, .direction = { -1, -1, -1 } })
                              .hash,
                          below.hash);
    picture_of (&c, value, (pg_picture_style) { .view = PG_VIEW_ISO, .direction = { 0, -3, 0 } });
    pg_free (value);
    drop_cloud (&c);
}

/* Perturbed points, value = number of the layer: a section of any height shows one layer whole, and no
 * other. */
static void a_section_shows_the_nearest_layer_whole (void **state)
{
    (void) state;
    static const double height[] = { -0.5, -0.3, 0.2, 0.5, 0.8, 3.49, 3.51, 7.6, 8.2, 8.5 };
    static const int layer[] = { 0, 0, 0, 0, 1, 3, 4, 8, 8, 8 };
    pg_cloud c;
    double *value = make_body (&c);
    for (size_t i = 0; i < c.n; i++)
        for (size_t a = 0; a < 3; a++) {
            int k = (int) (a == 0 ? i % M : a == 1 ? i / M % M : i / (M * M));
            if (k > 0 && k < M - 1)
                c.x[3 * i + a] += 0.3e-3 * sin (12.9898 * (double) i + 78.233 * (double) a);
        }
    for (size_t h = 0; h < sizeof height / sizeof *height; h++)
        for (int section = longer () ? 1 : 1 + (int) h % 3; section <= (longer () ? 3 : 1 + (int) h % 3);
             section++) {                              /* short: one of the three at each height */
            size_t stride = section == 1 ? 1 : section == 2 ? M : M * M;
            for (size_t i = 0; i < c.n; i++) value[i] = (int) (i / stride % M) == layer[h];
            look l = picture_of (&c, value,
                                 (pg_picture_style){ .high = 1,
                                                     .section = section,
                                                     .at = c.low[section - 1] + height[h] * 1e-3 });
            assert_true (l.high > 400000 && l.low < 500);
        }
    check_fails (pg_picture_field (file_at ("none.png"), &c, value,
                                   &(pg_picture_style){ .section = 1, .at = c.low[0] - 0.7e-3 }),
                 PG_E_USAGE);
    check_fails (pg_picture_field (file_at ("none.png"), &c, value,
                                   &(pg_picture_style){ .section = 3, .at = c.high[2] + 0.7e-3 }),
                 PG_E_USAGE);
    check_contains (pg_last_error (), "meets no points");
    check_fails (pg_picture_field (file_at ("none.png"), &c, value,
                                   &(pg_picture_style){ .section = 4, .direction = { 1, 1, 0 }, .at = 1 }),
                 PG_E_USAGE);
    pg_free (value);
    drop_cloud (&c);
}

static void panels_share_one_range (void **state)
{
    (void) state;
    pg_cloud c;
    double *zero = make_body (&c), *one = pg_calloc (c.n, sizeof (double));
    for (size_t i = 0; i < c.n; i++) one[i] = 1;
    for (int dim = 2; dim <= 3; dim++) {
        pg_cloud flat = c;
        flat.dim = dim, flat.n = dim == 3 ? c.n : M * M;
        double *plane = pg_calloc (2 * flat.n, sizeof (double));
        for (size_t i = 0; i < flat.n; i++)
            plane[2 * i] = (double) (i % M) * 1e-3, plane[2 * i + 1] = (double) (i / M) * 1e-3;
        if (dim == 2) flat.x = plane;
        pg_panel panel[5] = { { "a", zero, NULL, NULL, NULL, NULL },
                              { "b", one, NULL, NULL, NULL, NULL },
                              { "c", one, NULL, NULL, NULL, NULL },
                              { "d", zero, NULL, NULL, NULL, NULL },
                              { "e", one, NULL, NULL, NULL, NULL } };
        const char *path = file_at ("panels.png");
        check_ok (
            pg_picture_panels (path, &flat, 4, panel, 0,
                               &(pg_picture_style){ .title = "t", .label = "v", .view = PG_VIEW_FRONT }));
        look four = look_at (path);
        assert_true (four.high > 200000 && four.low > 200000 && four.width < 2000 && four.height < 2000);
        check_relative ((double) four.high, (double) four.low, 0.01);
        check_ok (pg_picture_panels (path, &flat, 5, panel, 5,
                                     &(pg_picture_style){ .label = "v", .view = PG_VIEW_FRONT }));
        look five = look_at (path);
        assert_true (five.width > 3 * five.height);
        check_relative ((double) five.high, 1.5 * (double) five.low, 0.01);
        pg_free (plane);
    }
    pg_free (one), pg_free (zero);
    drop_cloud (&c);
}

static void a_fragment_that_flies_does_not_shrink_the_body (void **state)
{
    (void) state;
    pg_cloud c;
    double *value = make_body (&c), *u = pg_calloc (3 * c.n, sizeof (double));
    for (size_t i = 0; i < c.n; i++) value[i] = u[3 * i] = 1e-5 * (double) (i % M);
    pg_picture_style style = { .view = PG_VIEW_FRONT, .u = u, .magnify = 1, .clip = 1 };
    look near = picture_of (&c, value, style);
    u[3 * (c.n / 2)] = value[c.n / 2] = 1;
    look far = picture_of (&c, value, style);
    assert_true (far.width >= near.width - 20 && far.width <= near.width + 20);
    /* a line below says what the colours leave out */
    assert_true (far.height >= near.height + 30 && far.height <= near.height + 56);
    assert_true (far.high > near.high / 2);
    pg_free (u), pg_free (value);
    drop_cloud (&c);
}

static void the_range_leaves_out_few_values_far_away (void **state)
{
    (void) state;
    double v[1000], low, high;
    int found;
    for (int i = 0; i < 1000; i++) v[i] = i;
    check_ok (pg_picture_range (1000, v, 2, &low, &high, &found));
    assert_true (found && low == 0 && high == 999);
    v[500] = 1e5, v[501] = -1e5, v[502] = NAN;
    check_ok (pg_picture_range (1000, v, 2, &low, &high, &found));
    assert_true (low > -1 && low < 10 && high > 980 && high < 1000);
    check_ok (pg_picture_range (1000, v, 0, &low, &high, &found));
    assert_true (low == -1e5 && high == 1e5);
    for (int i = 0; i < 60; i++) v[i] = i;             /* a single point of a coarse body */
    v[30] = 1e4;
    check_ok (pg_picture_range (60, v, 2, &low, &high, &found));
    assert_true (low >= 0 && low <= 1 && high >= 58 && high <= 59);
    for (int i = 0; i < 1000; i++) v[i] = NAN;
    check_ok (pg_picture_range (1000, v, 2, &low, &high, &found));
    assert_true (!found && low == 0 && high == 1);
}

static int by_size (const void *a, const void *b)
{
    double p = *(const double *) a, q = *(const double *) b;
    return (p > q) - (p < q);
}

/* Of values in any order, many of them equal, the ends are those of all values in ascending order. */
static void the_range_is_that_of_sorted_values (void **state)
{
    (void) state;
    enum { MOST = 700 };
    double v[MOST], sorted[MOST], low, high;
    unsigned seed = 3;
    int found;
    for (size_t n = 1; n <= MOST; n++) {
        size_t m = 0;
        for (size_t i = 0; i < n; i++) {
            seed = seed * 1664525u + 1013904223u;
            double x = (double) (seed >> 8) / 16777216.0;
            v[i] = n % 5 == 0   ? floor (4 * x)
                   : n % 5 == 1 ? (double) i
                   : n % 5 == 2 ? -(double) i
                                : pow (x, 9);
            if (n % 7 == 0 && i % 11 == 3) v[i] = NAN;
            else sorted[m++] = v[i];
        }
        qsort (sorted, m, sizeof *sorted, by_size);
        size_t cut = m / 100 ? m / 100 : m >= 50;
        double from = sorted[cut], to = sorted[m - 1 - cut];
        check_ok (pg_picture_range (n, v, 1e-9, &low, &high, &found));
        assert_true (found);
        if (to > from) assert_true (low == from && high == to);
    }
}

static void sections_are_read_as_written (void **state)
{
    (void) state;
    static const struct {
        const char *text;
        int section;
        double at;
    } good[] = { { "z = 5 mm", 3, 5e-3 },
                 { "x=0.01", 1, 0.01 },
                 { " y =-2 cm", 2, -0.02 },
                 { "1, 0, -1 = 3 mm", 4, 3e-3 },
                 { "0,1e-3,0=0", 4, 0 } };
    static const char *const bad[] = { "",         "z",        "z 5",         "w = 1",       "z = ",
                                       "z = 5 kg", "1, 2 = 3", "0, 0, 0 = 1", "1, 2, x = 3", "zz = 1",
                                       "z = 1 2" };
    for (size_t k = 0; k < sizeof good / sizeof *good; k++) {
        pg_picture_style style = { .view = PG_VIEW_ISO };
        check_ok (pg_picture_section (&style, good[k].text));
        assert_int_equal (style.section, good[k].section);
        assert_int_equal (style.view, PG_SECTION);
        check_relative (style.at, good[k].at, 1e-12);
    }
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
        pg_picture_style style = { .at = 7 };
        pg_status status = pg_picture_section (&style, bad[k]);
        if (status == PG_OK) print_error ("'%s' was read\n", bad[k]);
        assert_int_not_equal (status, PG_OK);
        assert_true (style.section == 0 && style.at == 7);
    }
}

static void directions_are_three_numbers (void **state)
{
    (void) state;
    static const char *const bad[] = { "",      "1,2",   "0,0,0",   "1,2,3,4",
                                       "1,2,x", "1 2 3", "inf,0,0", "1e200,1e200,0" };
    double d[3] = { 0 };
    check_ok (pg_picture_direction (d, "1, -0.5,2"));
    assert_true (d[0] == 1 && d[1] == -0.5 && d[2] == 2);
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++)
        check_fails (pg_picture_direction (d, bad[k]), PG_E_USAGE);
}

static void svg_holds_the_view (void **state)
{
    (void) state;
    pg_cloud c;
    double *value = make_body (&c);
    char text[200] = "";
    const char *path = file_at ("view.svg");
    check_ok (pg_picture_field (path, &c, value, &(pg_picture_style) { .view = PG_VIEW_ISO, .label = "v" }));
    FILE *file = fopen (path, "r");
    assert_true (fread (text, 1, sizeof text - 1, file) > 100);
    fclose (file);
    check_contains (text, "<svg");
    pg_free (value);
    drop_cloud (&c);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (front_and_back_differ_as_the_field_does),
        cmocka_unit_test (what_is_inside_is_hidden_from_every_side),
        cmocka_unit_test (only_points_above_the_limit_are_drawn),
        cmocka_unit_test (a_crack_that_is_not_there_leaves_the_outline),
        cmocka_unit_test (another_direction_is_another_picture),
        cmocka_unit_test (a_section_shows_the_nearest_layer_whole),
        cmocka_unit_test (panels_share_one_range),
        cmocka_unit_test (a_fragment_that_flies_does_not_shrink_the_body),
        cmocka_unit_test (the_range_leaves_out_few_values_far_away),
        cmocka_unit_test (the_range_is_that_of_sorted_values),
        cmocka_unit_test (sections_are_read_as_written),
        cmocka_unit_test (directions_are_three_numbers),
        cmocka_unit_test (svg_holds_the_view),
    };
    return cmocka_run_group_tests_name ("io/output/picture_view", tests, NULL, remove_folder);
}
