/* SPDX-License-Identifier: GPL-3.0-or-later
 * Pictures of plane bodies pixel by pixel: they end where the body does, have its area, show no hole inside
 * of it however much the displacement is magnified, and part only where a crack is; clouds of points without
 * an outline have no holes. */
#include "check.h"
#include "fonts.h"
#include "io/output/sample.h"
#include "meshes.h"
#include "perigal/picture.h"
#include "io/picture/tiles.h"
#include <cairo.h>

enum { FILL = 0xfbec6e };                              /* value 1 of 0 to 1 */
/* box: first and last column, row */
typedef struct { int width, height; unsigned char *on; double area; int box[4]; } image;

/* Which pixels of the frame have the colour. The colour bar's own lie apart on the right and are left out. */
static void open_image (image *m, const char *path)
{
    cairo_surface_t *s = cairo_image_surface_create_from_png (path);
    assert_int_equal (cairo_surface_status (s), CAIRO_STATUS_SUCCESS);
    *m = (image) { .width = cairo_image_surface_get_width (s), .height = cairo_image_surface_get_height (s) };
    m->on = pg_calloc ((size_t) (m->width * m->height), 1);
    m->box[0] = m->width, m->box[2] = m->height;
    for (int y = 0; y < m->height; y++)
        for (int x = 0; x < m->width - 160; x++) {
            unsigned p;
            memcpy (&p, cairo_image_surface_get_data (s) + y * cairo_image_surface_get_stride (s) + 4 * x, 4);
            if ((p & 0xffffff) != FILL) continue;
            m->on[y * m->width + x] = 1, m->area++;
            if (x < m->box[0]) m->box[0] = x;
            if (x > m->box[1]) m->box[1] = x;
            if (y < m->box[2]) m->box[2] = y;
            if (y > m->box[3]) m->box[3] = y;
        }
    cairo_surface_destroy (s);
}

/* Pixels that are not coloured and cannot be reached from the first pixel without crossing coloured ones. */
static size_t holes (const image *m)
{
    size_t n = 0, top = 0, all = (size_t) (m->width * m->height);
    unsigned char *seen = pg_calloc (all, 1);
    int *stack = pg_calloc (all, sizeof (int));
    stack[top++] = 0, seen[0] = 1;
    while (top > 0) {
        int p = stack[--top], x = p % m->width, y = p / m->width;
        for (int k = 0; k < 9; k++) {
            int i = x + k % 3 - 1, j = y + k / 3 - 1, q = j * m->width + i;
            if (i < 0 || j < 0 || i >= m->width || j >= m->height || seen[q] || m->on[q]) continue;
            seen[q] = 1, stack[top++] = q;
        }
    }
    for (size_t p = 0; p < all; p++) n += !seen[p] && !m->on[p];
    pg_free (seen), pg_free (stack);
    return n;
}

/* ---- bodies -------------------------------------------------------------------------------------------- */
typedef struct {
    pg_shape shape[2];
    pg_body body;
    pg_outline outline;
    pg_cloud cloud;
    double *one, *u, *damage;
} thing;

/* A disk (round) or a square of size 2 with a round hole of radius 0.3 (hole), by points in or on the corners
 * of cells of 0.1 times unit. */
static void make (thing *t, int round, int hole, int corners, double unit)
{
    *t = (thing){ .shape[0] = { .kind = round ? PG_DISK : PG_BOX,
                                .add = 1,
                                .radius = unit,
                                .low = { -unit, -unit },
                                .high = { unit, unit } },
                  .shape[1] = { .kind = PG_DISK, .radius = 0.3 * unit },
                  .cloud = { .dim = 2, .h = 0.1 * unit, .thickness = 1 } };
    t->body = (pg_body){
        .dim = 2, .shape = t->shape, .n = hole ? 2 : 1, .low = { -unit, -unit }, .high = { unit, unit }
    };
    pg_cloud *c = &t->cloud;
    c->x = pg_calloc (2 * 484, sizeof (double)), c->volume = pg_calloc (484, sizeof (double)),
    c->block = pg_calloc (484, sizeof (int));
    t->one = pg_calloc (484, sizeof (double)), t->u = pg_calloc (968, sizeof (double)),
    t->damage = pg_calloc (484, sizeof (double));
    for (int k = 0; k < 2; k++) c->step[k] = c->h, c->low[k] = -unit, c->high[k] = unit;
    for (int j = 0; j < 21; j++)
        for (int i = 0; i < 21; i++) {
            double x[2] = { (i - 10 + (corners ? 0 : 0.5)) * c->h, (j - 10 + (corners ? 0 : 0.5)) * c->h };
            if (!pg_body_inside (&t->body, x, corners ? 0.8 * c->h : 1e-9 * unit)
                || (!corners && (i == 20 || j == 20)))
                continue;
            memcpy (c->x + 2 * c->n, x, sizeof x);
            c->volume[c->n] = c->h * c->h, t->one[c->n++] = 1;
        }
}

static void drop (thing *t)
{
    drop_cloud (&t->cloud);
    pg_free (t->one), pg_free (t->u), pg_free (t->damage);
}

static void draw (thing *t, pg_picture_style style, image *m)
{
    const char *path = file_at ("tiles.png");
    t->outline = (pg_outline) { .body = &t->body };
    style.outline = &t->outline, style.low = 0, style.high = 1;
    if (style.magnify != 0) style.u = t->u, style.damage = t->damage;
    check_ok (pg_picture_field (path, &t->cloud, t->one, &style));
    open_image (m, path);
}

/* Short: every other combination of four things, so that any two of them go together in all ways. */
static int taken (int k) { return longer () || ((k ^ k >> 1 ^ k >> 2 ^ k >> 3) & 1) == 0; }

/* ---- claims -------------------------------------------------------------------------------------------- */
static void the_body_ends_where_its_shapes_do (void **state)
{
    (void) state;
    for (int k = 0; k < 16; k++) {
        if (!taken (k)) continue;
        thing t;
        image m;
        int hole = k >> 1 & 1;
        make (&t, k & 1, hole, k >> 2 & 1, k & 8 ? 1e-6 : 1e3);
        draw (&t, (pg_picture_style) { .label = "v" }, &m);
        double size = m.box[1] + 1 - m.box[0],
               area = (k & 1 ? 3.14159265358979 : 4) - hole * 0.09 * 3.14159265358979;
        check_relative (m.box[3] + 1 - m.box[2], size, 0.003);
        check_relative (m.area, area * size * size / 4, 0.003);
        double cx = 0.5 * (m.box[0] + m.box[1]), cy = 0.5 * (m.box[2] + m.box[3]);
        for (int y = m.box[2]; y <= m.box[3]; y++)
            for (int x = m.box[0]; x <= m.box[1]; x++) {
                double px = fabs (x - cx), py = fabs (y - cy), r = hypot (px, py),
                       out = k & 1 ? r : fmax (px, py);
                if (out < 0.5 * size - 2 && (!hole || r > 0.15 * size + 2))
                    assert_int_equal (m.on[y * m.width + x], 1);
                if (hole && r < 0.15 * size - 2) assert_int_equal (m.on[y * m.width + x], 0);
            }
        pg_free (m.on);
        drop (&t);
    }
}

/* Which pixels are in the body and which point each belongs to, found by halves of the frame and eight pixels
 * at a time, beside a search over all points for every pixel. Points on their lattice, and moved off it. */
static void pixels_are_those_of_a_plain_search (void **state)
{
    (void) state;
    for (int k = 0; k < 16; k++) {
        if (!taken (k)) continue;
        thing t;
        double unit = k & 8 ? 1e-6 : 1e3, part = 0;
        make (&t, k & 1, 1, k >> 1 & 1, unit);
        for (size_t i = 0; k & 4 && i < 2 * t.cloud.n; i++)
            t.cloud.x[i] += 0.3 * t.cloud.h * sin (12.9898 * (double) (i + 1));
        t.outline = (pg_outline) { .body = &t.body };
        pg_tiles tiles = { .n = t.cloud.n, .dim = 2, .loose = k >> 2 & 1, .place = t.cloud.x,
                           .step = { t.cloud.h, t.cloud.h }, .outline = &t.outline };
        pg_screen s = { .left = -1.13 * unit, .top = 1.07 * unit, .scale = 131 / unit };
        check_ok (pg_tiles_open (&tiles));
        check_ok (pg_screen_open (&s, 301, 263));
        check_ok (pg_tiles_rest (&tiles, &s));
        for (int p = 0; p < s.width * s.height; p++) {
            double at[2] = { s.left + (p % s.width + 0.5) / s.scale, s.top - (p / s.width + 0.5) / s.scale },
                   least = INFINITY;
            int in = pg_body_inside (&t.body, at, 1e-6 * tiles.widest);
            part += in;
            assert_int_equal (s.owner[p] >= 0, in);
            for (size_t i = 0; in && i < t.cloud.n; i++)
                least = fmin (least, hypot (at[0] - t.cloud.x[2 * i], at[1] - t.cloud.x[2 * i + 1]));
            const double *own = t.cloud.x + 2 * (in ? s.owner[p] : 0);
            if (in) check_relative (hypot (at[0] - own[0], at[1] - own[1]), least, 1e-6);
        }
        assert_true (part > 0.3 * 301 * 263 && part < 0.9 * 301 * 263);
        pg_screen_close (&s);
        pg_tiles_close (&tiles);
        drop (&t);
    }
}

/* Whole cells where the scene has cells: staircase; the elements of a plane mesh, on which the points lie. */
static void stairs_and_meshes_are_outlines_too (void **state)
{
    (void) state;
    thing t;
    image m;
    pg_lattice lattice;
    pg_mesh sheet;
    double cells = 0, one[200], x[400], volume[200];
    make (&t, 1, 1, 1, 1);
    check_ok (pg_lattice_fit (&lattice, &t.body, 0.1, NULL));
    for (int k = 0; k < lattice.count[0] * lattice.count[1]; k++) cells += lattice.in[k];
    pg_outline stairs = { .body = &t.body, .lattice = &lattice }, elements = { .mesh = &sheet };
    const char *path = file_at ("outline.png");
    check_ok (pg_picture_field (path, &t.cloud, t.one,
                                &(pg_picture_style){ .label = "v", .high = 1, .outline = &stairs }));
    open_image (&m, path);
    double size = (m.box[1] + 1 - m.box[0]) / 20.0;    /* pixels of a cell */
    check_relative (m.area, cells * size * size, 0.003);
    pg_free (m.on);
    make_mesh (&sheet, &(mesh_plan) { to_box, { 4, 3, 1 }, 2, 0, PG_TRI6, NULL });
    pg_cloud c = { .dim = 2, .n = sheet.nnode, .x = x, .volume = volume, .h = 10, .thickness = 1 };
    assert_true (c.n < 200);
    for (size_t i = 0; i < c.n; i++)
        one[i] = volume[i] = 1, memcpy (x + 2 * i, sheet.x + 3 * i, 2 * sizeof *x);
    check_ok (pg_picture_field (path, &c, one,
                                &(pg_picture_style){ .label = "v", .high = 1, .outline = &elements }));
    open_image (&m, path);
    assert_int_equal (holes (&m), 0);
    check_relative (m.area, (double) (m.box[1] + 1 - m.box[0]) * (m.box[3] + 1 - m.box[2]), 0.003);
    double low[2] = { INFINITY, INFINITY }, high[2] = { -INFINITY, -INFINITY };
    for (size_t i = 0; i < c.n; i++)
        for (int k = 0; k < 2; k++)
            low[k] = fmin (low[k], x[2 * i + (size_t) k]), high[k] = fmax (high[k], x[2 * i + (size_t) k]);
    check_relative ((double) (m.box[1] + 1 - m.box[0]) / (m.box[3] + 1 - m.box[2]),
                    (high[0] - low[0]) / (high[1] - low[1]), 0.01);
    pg_free (m.on);
    pg_mesh_clear (&sheet);
    pg_lattice_clear (&lattice);
    drop (&t);
}

/* Any linear displacement, also one that stretches cells to twice their size: no hole, and the area grows by
 * its determinant. Short: every other combination. */
static void magnified_bodies_have_no_holes (void **state)
{
    (void) state;
    static const double gradient[][4] = { { 1, 0, 0, 0.2 }, { 0.5, 0.8, 0, 0.1 }, { -0.3, 0.2, -0.2, 1.5 } };
    for (int k = 0; k < 12; k++) {
        if (!longer () && (k % 3 + k / 3) % 2) continue;
        thing t;
        image rest, m;
        const double *g = gradient[k % 3];
        make (&t, k / 3 & 1, 0, k / 6, 1e-3);
        draw (&t, (pg_picture_style) { .label = "v" }, &rest);
        double unit = (rest.box[1] + 1 - rest.box[0]) / 2.0, body = rest.area / (unit * unit);
        for (size_t i = 0; i < t.cloud.n; i++)
            for (int c = 0; c < 2; c++)
                t.u[2 * i + (size_t) c] = 1e-4
                                          * (g[2 * c] * t.cloud.x[2 * i]
                                             + g[2 * c + 1] * t.cloud.x[2 * i + 1]);
        draw (&t, (pg_picture_style) { .label = "v", .magnify = 1e4 }, &m);
        assert_int_equal (holes (&m), 0);
        double det = (1 + g[0]) * (1 + g[3]) - g[1] * g[2], width = m.box[1] + 1 - m.box[0];
        /* width of the sheared body, in units: of a square |1 + gxx| + |gxy| on either side, of a disk the
         * root of the squares */
        double half = k / 3 & 1 ? hypot (1 + g[0], g[1]) : fabs (1 + g[0]) + fabs (g[1]);
        check_relative (m.area, body * det * (width / (2 * half)) * (width / (2 * half)), 0.01);
        pg_free (rest.on), pg_free (m.on);
        drop (&t);
    }
}

/* Halves that move apart along y = 0: a gap where a pre-crack or broken bonds are, none where all points are
 * whole. */
static void only_cracks_open (void **state)
{
    (void) state;
    double vertex[] = { -1.1, 0.01, 1.1, 0.01 };
    pg_crack crack = { .kind = PG_CRACK_SEGMENT, .vertex = vertex, .nvertex = 2, .normal = { 0, 1 } };
    pg_cracks cracks = { .dim = 2, .crack = &crack, .n = 1 };
    for (int kind = 0; kind < 3; kind++) {
        thing t;
        image m;
        make (&t, 0, 0, 0, 1);
        for (size_t i = 0; i < t.cloud.n; i++) {
            double y = t.cloud.x[2*i + 1];
            t.u[2*i + 1] = y > 0 ? 0.2 : -0.2;
            if (kind && fabs (y) < 0.2) t.damage[i] = 0.4;
        }
        draw (&t, (pg_picture_style){ .label = "v", .magnify = 1, .cracks = kind == 2 ? &cracks : NULL }, &m);
        int middle = (m.box[0] + m.box[1]) / 2, gap = 0;
        for (int y = m.box[2]; y <= m.box[3]; y++) gap += !m.on[y * m.width + middle];
        double unit = (m.box[1] + 1 - m.box[0]) / 2.0;
        if (kind == 0) assert_int_equal (gap, 0);
        else check_scaled (gap, 0.4 * unit, 0.05, 0);
        pg_free (m.on);
        drop (&t);
    }
}

/* A spiral of points whose distance grows fourfold outwards: no hole, and as much body as its volumes say,
 * also displaced. */
static void clouds_are_filled (void **state)
{
    (void) state;
    enum { POINTS = 900 };
    for (int moved = 0; moved < 2; moved++) {
        double x[2 * POINTS], volume[POINTS], one[POINTS], u[2 * POINTS], damage[POINTS] = { 0 }, sum = 0,
                                                                          far = 0;
        pg_cloud c = { .dim = 2, .n = POINTS, .x = x, .volume = volume, .h = 0.03, .thickness = 0.5 };
        image m;
        for (int k = 0; k < POINTS; k++) {
            double s = sqrt ((k + 0.5) / POINTS), r = pow (s, 1.6), t = 2.399963229728653 * k;
            x[2*k] = r * cos (t), x[2*k + 1] = r * sin (t), one[k] = 1;
            volume[k] = 0.5 * 3.14159265358979 / POINTS * 1.6 * pow (s, 1.2), sum += volume[k] / 0.5;
            u[2*k] = 0.7 * x[2*k], u[2*k + 1] = 0.3 * x[2*k];
            far = fmax (far, fabs (x[2*k]));
        }
        const char *path = file_at ("cloud.png");
        check_ok (
            pg_picture_field (path, &c, one,
                              &(pg_picture_style){
                                  .label = "v", .high = 1, .magnify = moved, .u = u, .damage = damage }));
        open_image (&m, path);
        assert_int_equal (holes (&m), 0);
        double unit = (m.box[1] + 1 - m.box[0]) / 2.0 / (moved ? 1.7 : 1);  /* about the radius of the disk */
        check_relative (m.area, sum * (moved ? 1.7 : 1) * unit * unit, 0.06);
        pg_free (m.on);
    }
}

static void any_allocation_may_fail (void **state)
{
    (void) state;
    thing t;
    make (&t, 1, 1, 1, 1);
    for (size_t i = 0; i < t.cloud.n; i++) t.u[2*i] = 0.1 * t.cloud.x[2*i + 1], t.damage[i] = 0.2;
    t.outline = (pg_outline) { .body = &t.body };
    for (int kind = 0; kind < 2; kind++) {
        const char *path = file_at ("memory.png");
        size_t before = pg_memory_used (), k = 1;
        pg_status status = PG_E_MEMORY;
        for (; status == PG_E_MEMORY; k++) {
            pg_memory_fail_at (k);
            status = pg_picture_field (path, &t.cloud, t.one,
                                       &(pg_picture_style){ .label = "v",
                                                            .outline = &t.outline,
                                                            .u = t.u,
                                                            .damage = t.damage,
                                                            .magnify = kind });
            pg_memory_fail_at (0);
            assert_int_equal (pg_memory_used (), before);
            assert_true (k < 200);
        }
        check_ok (status);
        assert_true (k > 5);
    }
    drop (&t);
}

/* Points on a pre-crack are on both sides of it: their cells show them, but for the line of the crack
 * itself. */
static void points_on_a_crack_are_shown (void **state)
{
    (void) state;
    thing t;
    image m;
    double ends[] = { -0.55, 0, 0.55, 0 };
    pg_crack crack = { .kind = PG_CRACK_SEGMENT, .vertex = ends, .nvertex = 2, .normal = { 0, 1, 0 } };
    pg_cracks cracks = { .dim = 2, .crack = &crack, .n = 1 };
    make (&t, 0, 0, 1, 1);
    draw (&t, (pg_picture_style) { .label = "v" }, &m);
    double size = m.box[1] + 1 - m.box[0], cell = size * size / 400;
    pg_free (m.on);
    size_t on = 0;
    for (size_t i = 0; i < t.cloud.n; i++) {
        t.one[i] = fabs (t.cloud.x[2*i + 1]) < 1e-9 && fabs (t.cloud.x[2*i]) < 0.55;
        on += t.one[i] > 0;
    }
    assert_int_equal (on, 11);
    draw (&t, (pg_picture_style) { .label = "v", .cracks = &cracks }, &m);
    assert_true (m.area > 0.7 * 11 * cell && m.area < 1.02 * 11 * cell);
    pg_free (m.on);
    drop (&t);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (points_on_a_crack_are_shown),
        cmocka_unit_test (the_body_ends_where_its_shapes_do),
        cmocka_unit_test (pixels_are_those_of_a_plain_search),
        cmocka_unit_test (stairs_and_meshes_are_outlines_too),
        cmocka_unit_test (magnified_bodies_have_no_holes),
        cmocka_unit_test (only_cracks_open),
        cmocka_unit_test (clouds_are_filled),
        cmocka_unit_test (any_allocation_may_fail),
    };
    return cmocka_run_group_tests_name ("io/output/picture_tiles", tests, NULL, remove_folder);
}
