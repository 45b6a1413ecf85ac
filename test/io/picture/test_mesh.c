/* SPDX-License-Identifier: GPL-3.0-or-later
 * Pictures of meshes: curved edges are curved, values vary within elements, what is nearer hides what is
 * behind, sets have their colours, colours over decades; what cannot be drawn is said, whatever allocation
 * fails. */
#include "check.h"
#include "fonts.h"
#include "io/output/sample.h"
#include "meshes.h"
#include "perigal/picture.h"
#include <cairo.h>
#include <math.h>

enum {
    LOW = 0x2a1752,
    HIGH = 0xfbec6e,
    GREY = 0x9e9e9e,
    INNER = 0x9db4d4,
    OUTER = 0xeeb79a,
    FIRST = 0x124a99,
    START = 0xd6540f
};
typedef struct { size_t near; int from[2], to[2]; } counts;

static int beside = 120;

/* Pixels near a colour: how many, the box they fill. */
static counts count (const char *path, unsigned colour, int slack)
{
    cairo_surface_t *m = cairo_image_surface_create_from_png (path);
    assert_int_equal (cairo_surface_status (m), CAIRO_STATUS_SUCCESS);
    const unsigned char *byte = cairo_image_surface_get_data (m);
    counts c = { .from = { 1 << 20, 1 << 20 } };
    int bar = cairo_image_surface_get_width (m) - beside;      /* the colour bar or legend does not count */
    for (int y = 0; y < cairo_image_surface_get_height (m); y++)
        for (int x = 0; x < bar; x++) {
            unsigned p;
            int near = 1, at[2] = { x, y };
            memcpy (&p, byte + y * cairo_image_surface_get_stride (m) + 4 * x, 4);
            for (int k = 0; k < 24; k += 8)
                near &= abs ((int) (p >> k & 255) - (int) (colour >> k & 255)) <= slack;
            if (!near) continue;
            for (int k = 0; k < 2; k++)
                c.from[k] = at[k] < c.from[k] ? at[k] : c.from[k],
                c.to[k] = at[k] > c.to[k] ? at[k] : c.to[k];
            c.near++;
        }
    cairo_surface_destroy (m);
    return c;
}

static double along_x (const double *x) { return x[0]; }
static double three (const double *x) { (void) x; return 3; }
static double nothing (const double *x) { (void) x; return NAN; }
static double decades (const double *x) { return x[0] < 1 ? 0 : -pow (10, x[0] / 40); }
static int no_corner (const int *c) { return c[0] < 3 || c[1] < 3; }
static const mesh_plan ring = { to_ring, { 4, 14, 1 }, 2, 1, PG_TRI6, NULL },
                       plate = { to_box, { 5, 4, 1 }, 2, 0, PG_QUAD4, NULL },
                       tube = { to_pipe, { 2, 12, 6 }, 3, 1, PG_HEX20, NULL },
                       box = { to_box, { 4, 3, 2 }, 3, 0, PG_HEX8, NULL },
                       bracket = { to_box, { 6, 6, 3 }, 3, 0, PG_HEX8, no_corner };

static const char *drawn (const mesh_plan *plan, double (*f) (const double *), const pg_picture_style *style)
{
    const char *path = file_at ("mesh.png");
    pg_mesh m;
    make_mesh (&m, plan);
    double *value = f ? over_nodes (&m, f) : NULL;
    check_ok (pg_picture_mesh (path, &m, value, style));
    pg_free (value);
    pg_mesh_clear (&m);
    return path;
}

/* 14 tri6 around: chords would cut 3.3 % off the outer circle. Its share of its own bounding square is that
 * of a circle less that of the hole. */
static void curved_edges_are_curved (void **state)
{
    (void) state;
    counts c = count (drawn (&ring, three,
                             &(pg_picture_style){ .low = 2, .high = 3, .edges = -1, .length = 1e-3 }),
                      HIGH, 3);
    /* with half of the rim's line */
    double width = c.to[0] - c.from[0] + 3, height = c.to[1] - c.from[1] + 3;
    check_relative (width, height, 0.01);
    check_relative ((double) c.near / (width * height), 0.7853981633974483 * (1 - 0.09), 0.012);
}

/* x on 5 x 4 elements: colours rise from left to right also within an element; the same value everywhere when
 * all are beyond the bar. */
static void values_vary_within_elements (void **state)
{
    (void) state;
    const char *path = drawn (&plate, along_x, &(pg_picture_style) { .low = 0, .high = 16, .edges = -1 });
    counts high = count (path, HIGH, 3);
    /* from x = 16 to 80 */
    check_relative ((high.to[0] - high.from[0]) / 64.0, (high.to[1] - high.from[1]) / 60.0, 0.03);
    path = drawn (&plate, along_x, &(pg_picture_style) { .low = 0, .high = 160, .edges = -1 });
    assert_int_equal (count (path, HIGH, 3).near, 0);
    path = drawn (&plate, nothing, &(pg_picture_style) { .edges = -1 });
    assert_true (count (path, GREY, 0).near > 100000);
}

/* Blocks split along x: from the right only the outer one is seen, from the left only the inner, from above
 * both. */
static void what_is_nearer_hides_what_is_behind (void **state)
{
    (void) state;
    for (int view = PG_VIEW_LEFT; view <= PG_VIEW_TOP; view++) {
        const char *path = drawn (&box, NULL,
                                  &(pg_picture_style){ .view = view, .edges = -1, .length = 1e-3 });
        assert_int_equal (count (path, INNER, 6).near > 10000, view != PG_VIEW_RIGHT);
        assert_int_equal (count (path, OUTER, 6).near > 10000, view != PG_VIEW_LEFT);
    }
    counts c = count (drawn (&bracket, three,
                             &(pg_picture_style){ .view = PG_VIEW_FRONT, .low = 2, .high = 3, .edges = -1 }),
                      HIGH, 3);
    /* an L */
    check_relative ((double) c.near / ((c.to[0] - c.from[0]) * (double) (c.to[1] - c.from[1])), 0.75, 0.02);
}

static void a_bent_pipe_is_drawn_bent (void **state)
{
    (void) state;
    pg_mesh m;
    const char *path = file_at ("bent.png");
    make_mesh (&m, &tube);
    double *v = over_nodes (&m, three), *u = pg_calloc (3 * m.nnode, sizeof *u);
    for (size_t i = 0; i < m.nnode; i++) u[3 * i + 1] = 0.01 * m.x[3 * i];
    for (int bent = 0; bent < 2; bent++) {
        pg_picture_style style = {
            .view = PG_VIEW_FRONT, .low = 2, .high = 3, .edges = -1, .u = u, .magnify = bent ? 50 : 0
        };
        check_ok (pg_picture_mesh (path, &m, v, &style));
        cairo_surface_t *image = cairo_image_surface_create_from_png (path);
        int height = cairo_image_surface_get_height (image);
        assert_true (bent ? height > 1000 : height < 900);             /* 100 high instead of 60, 80 wide */
        cairo_surface_destroy (image);
    }
    pg_free (u), pg_free (v);
    pg_mesh_clear (&m);
}

/* The inner circle is the set of sides, one node that of nodes; in 3D a face of the box. */
static void sets_have_their_colours (void **state)
{
    (void) state;
    beside = 240;
    const char *path = drawn (&ring, three, &(pg_picture_style) { .sets = 1 });
    counts c = count (path, FIRST, 4), dot = count (path, START, 4);
    assert_true (c.near > 2000 && c.near < 12000);
    check_relative (c.to[0] - c.from[0], c.to[1] - c.from[1], 0.03);
    assert_true (dot.near > 40 && dot.near < 200);
    path = drawn (&box, NULL, &(pg_picture_style) { .sets = 1, .view = PG_VIEW_LEFT, .edges = -1 });
    assert_true (count (path, FIRST, 4).near > 100000);
    path = drawn (&box, NULL, &(pg_picture_style) { .sets = 1, .view = PG_VIEW_RIGHT, .edges = -1 });
    assert_int_equal (count (path, FIRST, 4).near, 0);
    beside = 120;
}

/* Signs do not count, zero has the lowest colour and is no missing value; of points, six decades below the
 * largest. */
static void colours_over_decades (void **state)
{
    (void) state;
    const char *path = drawn (&plate, decades,
                              &(pg_picture_style){ .log = 1, .low = 1, .high = 100, .edges = -1 });
    assert_true (count (path, GREY, 0).near < 100);            /* of letters */
    assert_true (count (path, LOW, 3).near > 100);
    pg_cloud c;
    make_cloud (&c, 2, 9, 1e-3);
    double *v = pg_calloc (c.n, sizeof *v);
    /* columns 1e-8 ... 1e-1 */
    for (size_t i = 0; i < c.n; i++) v[i] = i % 9 == 0 ? 0 : -pow (10, (double) (i % 9) - 9);
    check_ok (pg_picture_field (path, &c, v, &(pg_picture_style) { .log = 1 }));
    beside = 180;
    counts low = count (path, LOW, 3);  /* six decades: zero and 1e-8 lie below, 2 of 9 columns */
    check_relative ((double) (low.to[0] - low.from[0] + 1) / (low.to[1] - low.from[1] + 1), 2.0 / 9, 0.01);
    assert_true (count (path, GREY, 0).near < 100);            /* of letters */
    beside = 120;
    pg_free (v);
    drop_cloud (&c);
}

static void what_cannot_be_drawn_is_said (void **state)
{
    (void) state;
    pg_mesh m, line = { .dim = 1, .n = 1 }, none = { .dim = 2 };
    make_mesh (&m, &box);
    check_fails (pg_picture_mesh (file_at ("a.png"), &line, NULL, &(pg_picture_style) { 0 }), PG_E_USAGE);
    check_fails (pg_picture_mesh (file_at ("a.png"), &none, NULL, &(pg_picture_style) { 0 }), PG_E_USAGE);
    check_fails (pg_picture_mesh (file_at ("a.png"), &m, NULL, &(pg_picture_style){ .section = 3 }),
                 PG_E_USAGE);
    check_contains (pg_last_error (), "sections of meshes are not drawn");
    check_fails (pg_picture_mesh (file_at ("no/a.png"), &m, NULL, &(pg_picture_style) { 0 }), PG_E_FILE);
    check_fails (pg_picture_mesh (file_at ("a.jpg"), &m, NULL, &(pg_picture_style) { 0 }), PG_E_USAGE);
    check_ok (pg_picture_mesh (file_at ("a.svg"), &m, NULL, &(pg_picture_style) { 0 }));
    pg_mesh_clear (&m);
}

static void any_allocation_may_fail (void **state)
{
    (void) state;
    pg_mesh m;
    make_mesh (&m, &plate);
    double *v = over_nodes (&m, along_x);
    size_t used = pg_memory_used ();
    for (int sets = 0; sets < 2; sets++) {
        pg_status status = PG_E_MEMORY;
        size_t k;
        for (k = 1; k < 60 && status == PG_E_MEMORY; k++) {
            pg_memory_fail_at (k);
            status = pg_picture_mesh (file_at ("memory.png"), &m, v, &(pg_picture_style) { .sets = sets });
            pg_memory_fail_at (0);
            assert_int_equal (pg_memory_used (), used);
        }
        check_ok (status);
        assert_true (k > 8);
    }
    pg_free (v);
    pg_mesh_clear (&m);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (curved_edges_are_curved), cmocka_unit_test (values_vary_within_elements),
        cmocka_unit_test (what_is_nearer_hides_what_is_behind), cmocka_unit_test (a_bent_pipe_is_drawn_bent),
        cmocka_unit_test (sets_have_their_colours), cmocka_unit_test (colours_over_decades),
        cmocka_unit_test (what_cannot_be_drawn_is_said), cmocka_unit_test (any_allocation_may_fail),
    };
    return cmocka_run_group_tests_name ("io/output/picture_mesh", tests, NULL, remove_folder);
}
