/* SPDX-License-Identifier: GPL-3.0-or-later
 * Alpha shapes: of lattices, whose cells they give back; of the nodes of meshes beside the bodies that were
 * meshed; holes, parts, strange clouds; the same shape in other units and places; grown by a rim. */
#include "check.h"
#include "perigal/cloud.h"
#include <stdlib.h>
#include <string.h>

static const double pi = 3.14159265358979323846;

/* Points that a test collects. */
typedef struct { int dim; size_t n, room; double *x; } points;

static void put (points *p, double x, double y, double z)
{
    double at[3] = { x, y, z };
    if (p->n == p->room) {
        p->room = 2 * p->room + 64;
        p->x = pg_resize (p->x, p->room * (size_t) p->dim, sizeof *p->x);
        assert_non_null (p->x);
    }
    memcpy (p->x + p->n++ * (size_t) p->dim, at, (size_t) p->dim * sizeof *at);
}

/* A number in [-1, 1) that depends on i only. */
static double scatter (size_t i)
{
    uint64_t v = (i + 1) * 0x9E3779B97F4A7C15u;
    v ^= v >> 31, v *= 0xBF58476D1CE4E5B9u, v ^= v >> 29, v *= 0x94D049BB133111EBu, v ^= v >> 32;
    return (double) (v >> 11) / 4503599627370496.0 - 1;
}

/* n x n lattice points of step h, moved by up to `amount` h, without those within r of the middle. */
static points plate (size_t n, double h, double amount, double r)
{
    points p = { .dim = 2 };
    double middle = 0.5 * h * (double) (n - 1);
    for (size_t j = 0; j < n; j++)
        for (size_t i = 0; i < n; i++) {
            double x = h * ((double) i + amount * scatter (2 * (j * n + i))),
                   y = h * ((double) j + amount * scatter (2 * (j * n + i) + 1));
            if (hypot (x - middle, y - middle) > r) put (&p, x, y, 0);
        }
    return p;
}

static pg_alpha_shape shape_of (const points *p, double alpha)
{
    pg_alpha_shape a;
    check_ok (pg_alpha_shape_create (&a, p->dim, p->n, p->x, alpha));
    return a;
}

static void refused (const points *p, double alpha, const char *words)
{
    pg_alpha_shape a;
    assert_int_equal (pg_alpha_shape_create (&a, p->dim, p->n, p->x, alpha), PG_E_USAGE);
    check_contains (pg_last_error (), words);
    pg_free (p->x);
}

/* ---- lattices ------------------------------------------------------------------------------------------ */
static void a_lattice_has_its_area_and_spacing (void **state)
{
    (void) state;
    points p = plate (21, 0.25, 0, -1);
    pg_alpha_shape a = shape_of (&p, 0);
    check_relative (a.volume, 25, 1e-12), check_relative (a.spacing, 0.25, 1e-12);
    check_relative (a.alpha, 1.5 * 0.25 / sqrt (2), 1e-3);
    assert_int_equal (a.parts, 1), assert_int_equal (a.holes, 0), assert_int_equal (a.loose, 0);
    assert_int_equal (a.mesh.n, 800);
    pg_alpha_shape_clear (&a), pg_free (p.x);
}

static void a_cubic_lattice_too (void **state)
{
    (void) state;
    points p = { .dim = 3 };
    for (int c = 0; c < 7; c++)
        for (int b = 0; b < 8; b++)
            for (int i = 0; i < 9; i++) put (&p, 1e-3 * i, 1e-3 * b, 1e-3 * c);
    pg_alpha_shape a = shape_of (&p, 0);
    check_relative (a.volume, 8 * 7 * 6 * 1e-9, 1e-12), check_relative (a.spacing, 1e-3, 1e-3);
    assert_int_equal (a.parts, 1), assert_int_equal (a.holes, 0), assert_int_equal (a.loose, 0);
    /* alpha as large as the half diagonal of a cell, no larger */
    pg_alpha_shape b = shape_of (&p, 1e-3 * sqrt (3) / 2);
    check_relative (b.volume, a.volume, 1e-12);
    assert_int_equal (b.holes, 0);
    pg_alpha_shape_clear (&a), pg_alpha_shape_clear (&b), pg_free (p.x);
}

/* Points moved by 0.4 h: no spurious holes, all points in, whatever the arrangement. */
static void scattered_points_leave_no_gaps (void **state)
{
    (void) state;
    points p = plate (60, 1, 0.4, -1);
    pg_alpha_shape a = shape_of (&p, 0);
    assert_int_equal (a.parts, 1), assert_int_equal (a.holes, 0), assert_int_equal (a.loose, 0);
    check_relative (a.volume, 59 * 59, 0.02), check_relative (a.spacing, 1, 0.02);
    pg_alpha_shape_clear (&a), pg_free (p.x);
}

/* ---- holes and parts ----------------------------------------------------------------------------------- */
static void holes_and_parts_are_counted (void **state)
{
    (void) state;
    points p = plate (41, 1, 0, 8), q = plate (11, 1, 0, -1);
    for (size_t i = 0; i < q.n; i++) put (&p, q.x[2 * i] + 400, q.x[2 * i + 1] - 70, 0);
    pg_alpha_shape a = shape_of (&p, 0), b = shape_of (&p, 9), c = shape_of (&p, 1000);
    assert_int_equal (a.parts, 2), assert_int_equal (a.holes, 1);
    assert_int_equal (b.parts, 2), assert_int_equal (b.holes, 0);
    check_relative (b.volume, 1600 + 100, 1e-12);
    assert_true (a.volume < b.volume - pi * 7 * 7 && a.volume > b.volume - pi * 9 * 9);
    assert_int_equal (c.parts, 1);
    assert_true (c.volume > 4 * b.volume);
    pg_alpha_shape_clear (&a), pg_alpha_shape_clear (&b), pg_alpha_shape_clear (&c);
    pg_free (p.x), pg_free (q.x);
}

static void a_cavity_is_a_hole_of_a_solid (void **state)
{
    (void) state;
    points p = { .dim = 3 };
    for (int c = -6; c <= 6; c++)
        for (int b = -6; b <= 6; b++)
            for (int i = -6; i <= 6; i++)
                if (i * i + b * b + c * c > 10) put (&p, i, b, c);
    pg_alpha_shape a = shape_of (&p, 0);
    assert_int_equal (a.parts, 1), assert_int_equal (a.holes, 1), assert_int_equal (a.loose, 0);
    pg_alpha_shape_clear (&a), pg_free (p.x);
}

/* ---- the same shape ------------------------------------------------------------------------------------ */
static void units_place_and_direction_do_not_matter (void **state)
{
    (void) state;
    points p = plate (30, 1, 0.3, 6);
    pg_alpha_shape a = shape_of (&p, 0);
    static const struct { double scale, turn, mirror, x, y; } how[] = {
        { 1e-3, 0, 1, 0, 0 }, { 1, 0, 1, 1e5, -3e4 }, { 1, 0.7, 1, 0, 0 }, { 1, 0, -1, 0, 0 },
        { 25.4, 2, -1, 9, 9 } };
    for (size_t k = 0; k < sizeof how / sizeof *how; k++) {
        points q = { .dim = 2 };
        double s = how[k].scale, co = s * cos (how[k].turn), si = s * sin (how[k].turn);
        for (size_t i = 0; i < p.n; i++) {
            double x = how[k].mirror * p.x[2 * i], y = p.x[2 * i + 1];
            put (&q, co * x - si * y + how[k].x, si * x + co * y + how[k].y, 0);
        }
        pg_alpha_shape b = shape_of (&q, 0);
        check_relative (b.volume, s * s * a.volume, 1e-9), check_relative (b.alpha, s * a.alpha, 1e-3);
        check_relative (b.spacing, s * a.spacing, 1e-9);
        assert_int_equal (b.mesh.n, a.mesh.n), assert_int_equal (b.holes, 1);
        pg_alpha_shape_clear (&b), pg_free (q.x);
    }
    pg_alpha_shape_clear (&a), pg_free (p.x);
}

/* ---- strange clouds ------------------------------------------------------------------------------------ */
static void points_without_a_shape_are_refused (void **state)
{
    (void) state;
    points line = { .dim = 2 }, two = { .dim = 2 }, one = { .dim = 2 }, none = { .dim = 2 },
           flat = { .dim = 3 };
    for (int i = 0; i < 50; i++) put (&line, 0.1 * i, 0.3 * i - 7, 0);
    for (int i = 0; i < 50; i++) put (&flat, scatter ((size_t) i), 0.1 * i, 4);
    put (&two, 0, 0, 0), put (&two, 1, 0, 0);
    for (int i = 0; i < 100; i++) put (&one, 3, 4, 0);
    refused (&line, 0, "all 50 points lie on one line"), refused (&flat, 0, "all 50 points lie in one plane");
    refused (&two, 0, "2 different points; a shape in the plane needs 3 or more");
    refused (&one, 0, "1 different point;"), refused (&none, 0, "no points");
    points p = plate (10, 1, 0, -1);
    refused (&p, 0.5, "no triangle is as small as alpha = 0.5 m: the smallest circle through neighbours "
                      "has a radius of 0.707 m");
    p = plate (10, 1, 0, -1);
    p.x[7] = NAN;
    refused (&p, 0, "point 4 has a coordinate that is not finite");
}

static void a_point_far_away_is_refused_or_left_out (void **state)
{
    (void) state;
    points p = plate (12, 1, 0.2, -1);
    put (&p, 2000, 1, 0);
    pg_alpha_shape a = shape_of (&p, 1.5), b;
    assert_int_equal (a.loose, 1), assert_int_equal (a.first_loose, 144), assert_int_equal (a.parts, 1);
    assert_int_equal (pg_alpha_shape_create (&b, 2, p.n, p.x, 0), PG_E_USAGE);
    check_contains (pg_last_error (), "no radius fits all points: point 145 at (2000, 1) m");
    pg_alpha_shape_clear (&a), pg_free (p.x);
}

/* All points on a circle, alone and many times: every triangle has its radius. */
static void a_circle_and_many_twins (void **state)
{
    (void) state;
    points p = { .dim = 2 };
    for (int k = 0; k < 300; k++)
        for (int i = 0; i < 32; i++) put (&p, 5 + cos (pi * i / 16), sin (pi * i / 16), 0);
    pg_alpha_shape a = shape_of (&p, 0);
    assert_int_equal (a.twins, 299 * 32);
    assert_int_equal (a.mesh.nnode, 32), assert_int_equal (a.mesh.n, 30);
    check_relative (a.volume, 16 * sin (pi / 16), 1e-9), check_relative (a.alpha, 1.5, 1e-2);
    pg_alpha_shape_clear (&a), pg_free (p.x);
}

/* Parts at 1e6 spacings of each other: digits are lost, no shape is wrong. */
static void far_parts_are_kept_apart (void **state)
{
    (void) state;
    points p = plate (12, 1, 0.2, -1), q = plate (12, 1, 0.2, -1);
    for (size_t i = 0; i < q.n; i++) put (&p, q.x[2 * i] + 1e6, q.x[2 * i + 1] + 3e5, 0);
    pg_alpha_shape one = shape_of (&q, 0), both = shape_of (&p, 0);
    assert_int_equal (both.parts, 2), assert_int_equal (both.holes, 0);
    check_relative (both.volume, 2 * one.volume, 1e-3);
    pg_alpha_shape_clear (&one), pg_alpha_shape_clear (&both), pg_free (p.x), pg_free (q.x);
}

static void memory_that_fails_is_told (void **state)
{
    (void) state;
    points p = plate (6, 1, 0, -1);
    size_t used = pg_memory_used ();
    for (size_t k = 1; ; k++) {
        pg_alpha_shape a;
        pg_memory_fail_at (k);
        pg_status status = pg_alpha_shape_create (&a, 2, p.n, p.x, 0);
        pg_memory_fail_at (0);
        if (status == PG_OK) {
            pg_alpha_shape_clear (&a);
            assert_true (k > 10);
            break;
        }
        assert_int_equal (status, PG_E_MEMORY);
        assert_true (pg_memory_used () == used);
    }
    assert_true (pg_memory_used () == used);
    pg_free (p.x);
}

/* ---- in a scene ---------------------------------------------------------------------------------------- */
/* A body of a scene, filled by a lattice. */
typedef struct { pg_scene *scene; pg_body body; pg_lattice lattice; } filled;

static filled fill (const char *text, double spacing)
{
    filled f = { 0 };
    check_ok (pg_scene_parse (&f.scene, text, "test.yaml"));
    check_ok (pg_body_read (&f.body, f.scene));
    check_ok (pg_lattice_fit (&f.lattice, &f.body, spacing, NULL));
    return f;
}

static void drop (filled *f)
{
    pg_lattice_clear (&f->lattice), pg_body_clear (&f->body), pg_scene_free (&f->scene);
}

/* Writes points, in mm, into a file of the test's own folder; returns its path. */
static const char *write_points (const points *p)
{
    static char path[64];
    snprintf (path, sizeof path, "/tmp/perigal_cloud_XXXXXX");
    int id = mkstemp (path);
    FILE *file = fdopen (id, "w");
    assert_non_null (file);
    fprintf (file, p->dim == 2 ? "y [mm], note, x [mm]\n" : "y [mm], note, x [mm], z [mm]\n");
    for (size_t i = 0; i < p->n; i++) {
        const double *x = p->x + i * (size_t) p->dim;
        fprintf (file, "%.17g, 7, %.17g", x[1], x[0]);
        if (p->dim == 3) fprintf (file, ", %.17g", x[2]);
        fprintf (file, "\n");
    }
    fclose (file);
    return path;
}

/* The middles of the cells of a lattice give back that lattice: half a spacing lies around them. */
static void middles_of_cells_give_back_their_lattice (void **state)
{
    (void) state;
    char text[300];
    points p = plate (24, 2, 0, 9);
    const char *path = write_points (&p);
    snprintf (text, sizeof text, "dimension: 2\nbody: [{add: {alpha_shape: {points: %s}}}]\nspacing: 2 mm\n",
              path);
    filled f = fill (text, 2e-3);
    size_t in = 0;
    for (int k = 0; k < 24 * 24; k++) {
        double x = 2e-3 * (k % 24 - 11.5), y = 2e-3 * (k / 24 - 11.5);
        assert_int_equal (f.lattice.in[k], hypot (x, y) > 9e-3);
        in += f.lattice.in[k];
    }
    assert_int_equal (f.lattice.count[0], 24), assert_int_equal (f.lattice.count[1], 24);
    assert_int_equal (in, p.n);
    check_relative (f.body.high[0] - f.body.low[0], 48e-3, 1e-9);
    const pg_alpha_shape *a = pg_shape_alpha (f.body.shape);
    assert_non_null (a);
    check_relative (a->rim, 1e-3, 1e-9);
    /* how far places are from the grown surface */
    double x[2] = { -3e-3, 20e-3 }, d;
    pg_body_nearest (&f.body, x, &d);
    check_relative (d, 2e-3, 1e-9);
    x[0] = 10e-3, x[1] = 0.5e-3;
    pg_body_nearest (&f.body, x, &d);
    check_relative (d, 1.5e-3, 1e-9);
    remove (path), pg_free (p.x), drop (&f);
}

/* The nodes of a mesh of a ring, radii 0.4 and 1: the mask is that of the ring but for cells that its circles
 * pass within half a cell. Added and subtracted. */
static void nodes_of_a_ring_fill_the_ring (void **state)
{
    (void) state;
    static const char *const file[] = { "disk_tri6_41b.msh", "disk_quad8.msh", "disk_tri3.msh" };
    for (size_t k = 0; k < sizeof file / sizeof *file; k++) {
        char text[300];
        const double h = 0.1;
        snprintf (text, sizeof text,
                  "dimension: 2\nbody: [{add: {box: {low: [-1.5, -1.5], high: [1.5, 1.5]}}}, "
                  "{subtract: {alpha_shape: {mesh: {file: data/mesh/%s}}}}]\nspacing: 0.1\n", file[k]);
        filled f = fill (text, h);
        assert_int_equal (pg_shape_alpha (&f.body.shape[1])->holes, 1);
        size_t wrong = 0;
        for (int j = 0; j < f.lattice.count[1]; j++)
            for (int i = 0; i < f.lattice.count[0]; i++) {
                double x = pg_lattice_at (&f.lattice, 0, i + 0.5), y = pg_lattice_at (&f.lattice, 1, j + 0.5),
                       r = hypot (x, y);
                int out = r < 0.4 || r > 1;
                if (f.lattice.in[j * f.lattice.count[0] + i] == out) continue;
                wrong++;
                assert_true (fabs (r - 0.4) < h / 2 || fabs (r - 1) < h / 2);
            }
        assert_true (wrong < 60);
        drop (&f);
    }
}

/* The nodes of the bracket beside its elements: the same lattice, but for cells at its curved faces. */
static void nodes_of_a_bracket_fill_the_bracket (void **state)
{
    (void) state;
    filled part = fill ("dimension: 3\nbody: [{add: {mesh: {file: data/bracket/bracket.inp, unit: mm}}}]\n"
                        "spacing: 2 mm\n", 2e-3),
           cloud = fill ("dimension: 3\nbody: [{add: {alpha_shape: {mesh: {file: data/bracket/bracket.inp, "
                         "unit: mm}}}}]\nspacing: 2 mm\n", 2e-3);
    size_t n = 1, differ = 0, in = 0;
    for (int k = 0; k < 3; k++) {
        assert_int_equal (part.lattice.count[k], cloud.lattice.count[k]), n *= (size_t) part.lattice.count[k];
        check_relative (cloud.body.high[k], part.body.high[k], 1e-9);
    }
    for (size_t i = 0; i < n; i++) {
        double x[3], d;
        size_t row = (size_t) part.lattice.count[0], rows = (size_t) part.lattice.count[1],
               at[3] = { i % row, i / row % rows, i / row / rows };
        in += part.lattice.in[i];
        if (part.lattice.in[i] == cloud.lattice.in[i]) continue;
        differ++;
        for (int k = 0; k < 3; k++) x[k] = pg_lattice_at (&part.lattice, k, (double) at[k] + 0.5);
        pg_body_nearest (&part.body, x, &d);
        assert_true (d < 1e-3);
    }
    assert_int_equal (pg_shape_alpha (cloud.body.shape)->parts, 1);
    printf ("# %zu of %zu cells differ\n", differ, in);
    assert_true (differ < in / 50);
    drop (&part), drop (&cloud);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (a_lattice_has_its_area_and_spacing),
        cmocka_unit_test (a_cubic_lattice_too),
        cmocka_unit_test (scattered_points_leave_no_gaps),
        cmocka_unit_test (holes_and_parts_are_counted),
        cmocka_unit_test (a_cavity_is_a_hole_of_a_solid),
        cmocka_unit_test (units_place_and_direction_do_not_matter),
        cmocka_unit_test (points_without_a_shape_are_refused),
        cmocka_unit_test (a_point_far_away_is_refused_or_left_out),
        cmocka_unit_test (a_circle_and_many_twins),
        cmocka_unit_test (far_parts_are_kept_apart),
        cmocka_unit_test (memory_that_fails_is_told),
        cmocka_unit_test (middles_of_cells_give_back_their_lattice),
        cmocka_unit_test (nodes_of_a_ring_fill_the_ring),
        cmocka_unit_test (nodes_of_a_bracket_fill_the_bracket),
    };
    return cmocka_run_group_tests (tests, NULL, NULL);
}
