/* SPDX-License-Identifier: GPL-3.0-or-later
 * Cracks with a width and outlines: what they take from the body, which bonds they cut; polylines, ellipses;
 * tables of cracks, written and read; what a network amounts to. */
#include "parsed.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#define PLATE                                                                                                \
    "dimension: 2\nthickness: 1\nspacing: 0.1\nbody: [{add: {box: {low: [-1, -1], high: [1, 1]}}}]\n"
#define CUBE  "dimension: 3\nspacing: 0.1\nbody: [{add: {box: {low: [-1, -1, -1], high: [1, 1, 1]}}}]\n"

typedef struct { pg_scene *scene; pg_body body; pg_cracks sharp, slots; } cracked;

static cracked cracked_of (const char *text)
{
    cracked c = { .scene = parsed (text) };
    check_ok (pg_body_read (&c.body, c.scene));
    check_ok (pg_cracks_read (&c.sharp, c.scene));
    check_ok (pg_slots_read (&c.slots, c.scene));
    return c;
}

static void clear (cracked *c)
{
    pg_cracks_clear (&c->sharp), pg_cracks_clear (&c->slots);
    pg_body_clear (&c->body);
    pg_scene_free (&c->scene);
}

static void must_fault (const char *text, const char *part)
{
    pg_scene *scene = parsed (text);
    pg_body body;
    check_fails (pg_body_read (&body, scene), PG_E_SCENE);
    check_contains (pg_last_error (), part);
    pg_scene_free (&scene);
}

/* Share of the places of a fine lattice over the box that lie in the body. */
static double share_inside (const pg_body *b, const double *low, const double *high, int n)
{
    double in = 0, all = 0, x[3] = { 0 };
    int last = b->dim == 3 ? n : 1;
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++)
            for (int k = 0; k < last; k++) {
                const double part[3] = { (i + 0.5) / n, (j + 0.5) / n, (k + 0.5) / n };
                for (int a = 0; a < b->dim; a++) x[a] = low[a] + part[a] * (high[a] - low[a]);
                all++, in += pg_body_inside (b, x, 0);
            }
    return in / all;
}

/* ---- in the plane -------------------------------------------------------------------------------------- */
static void a_slot_takes_its_rectangle (void **state)
{
    (void) state;
    cracked c = cracked_of (PLATE "cracks: [{from: [-0.3, -0.4], to: [0.3, 0.4], width: 0.2}]\n");
    const double low[2] = { -1, -1 }, high[2] = { 1, 1 };
    assert_int_equal (c.sharp.n, 0);
    assert_int_equal (c.slots.n, 1);
    check_absolute (1 - share_inside (&c.body, low, high, 800), 0.2 / 4, 2e-4);
    /* t along it, n across: (0.6, 0.8) and (-0.8, 0.6) */
    static const struct { double t, n; int in;
    } places[] = { { 0, 0, 0 },    { 0.49, 0.09, 0 }, { -0.49, -0.09, 0 },
                   { 0.51, 0, 1 }, { 0, 0.11, 1 },    { 0.4, -0.11, 1 } };
    for (size_t k = 0; k < sizeof places / sizeof *places; k++) {
        double x[3] = { 0.6 * places[k].t - 0.8 * places[k].n, 0.8 * places[k].t + 0.6 * places[k].n, 0 };
        assert_int_equal (pg_body_inside (&c.body, x, 0), places[k].in);
    }
    double at[3] = { 0.11 * -0.8, 0.11 * 0.6, 0 }, d;
    assert_string_equal (c.body.shape[pg_body_nearest (&c.body, at, &d)].boundary, "slot");
    check_absolute (d, 0.01, 1e-12);
    clear (&c);
}

static void a_width_may_count_in_spacings (void **state)
{
    (void) state;
    cracked c = cracked_of (PLATE "cracks: [{from: [-0.3, 0], to: [0.3, 0], width: 1.5 spacing}]\n");
    check_relative (c.slots.crack[0].slot, 0.15, 1e-14);
    clear (&c);
    must_fault (
        "dimension: 2\nmesh: {file: none.inp}\ncracks: [{from: [0, 0], to: [1, 0], width: 2 spacing}]\n",
        "there is no spacing");
}

/* From one long side to the other, also where it is narrower than the bond is long; past its ends not. */
static void bonds_across_a_slot_are_cut (void **state)
{
    (void) state;
    cracked c = cracked_of (PLATE "cracks: [{from: [-0.5, 0], to: [0.5, 0], width: 0.1}]\n");
    static const struct { double x[2], y[2]; int cut;
    } bonds[] = { { { 0, -0.06 }, { 0, 0.06 }, 1 },
                  { { 0.1, -0.06 }, { 0.4, 0.3 }, 1 },
                  { { 0, 0.06 }, { 0.2, 0.06 }, 0 },
                  { { 0.51, -0.1 }, { 0.51, 0.1 }, 0 } };
    for (size_t k = 0; k < sizeof bonds / sizeof *bonds; k++) {
        assert_int_equal (pg_cracks_cut (&c.slots, bonds[k].x, bonds[k].y, 1e-10) != NULL, bonds[k].cut);
        assert_int_equal (pg_cracks_cut (&c.slots, bonds[k].y, bonds[k].x, 1e-10) != NULL, bonds[k].cut);
    }
    clear (&c);
}

/* Bends are round, so that no wedge of material is left at their outer side. */
static void a_polyline_is_one_slot (void **state)
{
    (void) state;
    cracked c = cracked_of (PLATE "cracks: [{polyline: [[-0.5, 0], [0, 0], [0, 0.5]], width: 0.2}]\n");
    assert_int_equal (c.slots.n, 2);
    double outer[3] = { 0.06, -0.06, 0 }, beyond[3] = { 0.09, -0.09, 0 }, on[3] = { -0.4, 0.09, 0 };
    assert_false (pg_body_inside (&c.body, outer, 0));
    assert_true (pg_body_inside (&c.body, beyond, 0));
    assert_false (pg_body_inside (&c.body, on, 0));
    clear (&c);
    c = cracked_of (PLATE "cracks: [{polyline: [[-0.5, 0], [0, 0], [0, 0.5], [-0.5, 0]]}]\n");
    assert_int_equal (c.sharp.n, 3);                   /* closed, sharp */
    assert_int_equal (c.body.n, 1);
    double in[2] = { -0.1, 0.1 }, out[2] = { 0.1, 0.1 };
    assert_true (pg_cracks_cut (&c.sharp, in, out, 1e-10) != NULL);
    clear (&c);
}

static void outlines_are_slots (void **state)
{
    (void) state;
    const double low[2] = { -1, -1 }, high[2] = { 1, 1 }, pi = acos (-1);
    cracked c =
        cracked_of (PLATE "cracks: [{ellipse: {center: [0.1, 0.2], length: 1.2, breadth: 0.3, angle: 30 "
                          "deg}}, {polygon: [[-0.9, -0.9], [-0.5, -0.9], [-0.7, -0.5]]}]\n");
    check_absolute (1 - share_inside (&c.body, low, high, 800), (pi * 0.6 * 0.15 + 0.08) / 4, 2e-4);
    double x[3] = { 0.1 + 0.59 * cos (pi / 6), 0.2 + 0.59 * sin (pi / 6), 0 },
           y[3] = { 0.1 - 0.14 * sin (pi / 6), 0.2 + 0.14 * cos (pi / 6), 0 };
    assert_false (pg_body_inside (&c.body, x, 0));
    assert_false (pg_body_inside (&c.body, y, 0));
    clear (&c);
}

/* A bond passes through an outline if it has a part inside; along an edge, or past a corner, it does not. */
static void bonds_pass_outlines_or_not (void **state)
{
    (void) state;
    cracked c =
        cracked_of (PLATE "cracks: [{polygon: [[0, 0], [0.4, 0], [0.4, 0.4], [0.2, 0.1], [0, 0.4]]}]\n");
    static const struct { double x[2], y[2]; int cut; } bonds[] = {
        { { -0.1, 0.2 }, { 0.5, 0.2 }, 1 },  { { -0.1, 0.05 }, { 0.5, 0.05 }, 1 },
        { { -0.1, 0 }, { 0.5, 0 }, 0 },      { { -0.1, 0.1 }, { 0.1, -0.1 }, 0 },
        { { 0.2, 0.15 }, { 0.2, 0.5 }, 0 },  { { -0.1, 0.39 }, { 0.15, 0.3 }, 1 },
        { { -0.5, -0.1 }, { 0.5, -0.1 }, 0 } };
    for (size_t k = 0; k < sizeof bonds / sizeof *bonds; k++)
        assert_int_equal (pg_cracks_cut (&c.slots, bonds[k].x, bonds[k].y, 1e-9) != NULL, bonds[k].cut);
    clear (&c);
}

static void many_slots_answer_as_one_by_one (void **state)
{
    (void) state;
    cracked c =
        cracked_of (PLATE "cracks: [{random: {count: 60, length: 0.2, inside: middle}, width: 0.04}]\n");
    for (int i = 0; i < 3000; i++) {
        double x[3] = { fmod (i * 0.618034, 2) - 1, fmod (i * 0.7548777, 2) - 1, 0 };
        int in = 1;
        for (size_t k = 0; k < c.slots.n; k++) {
            const pg_crack *s = &c.slots.crack[k];
            double d[2] = { x[0] - s->vertex[0], x[1] - s->vertex[1] },
                   t = -d[0] * s->normal[1] + d[1] * s->normal[0],
                   n = d[0] * s->normal[0] + d[1] * s->normal[1];
            /* the direction from the first vertex is (n_y, -n_x) */
            in &= !(fabs (n) < 0.02 && -t > 0 && -t < 0.2);
        }
        assert_int_equal (pg_body_inside (&c.body, x, 0), in);
    }
    clear (&c);
}

/* Points whose centre lies in the slot are no material (Zhou 2025). */
static void points_in_a_slot_are_missing (void **state)
{
    (void) state;
    built b = build (PLATE "lattice: cells\ncracks: [{from: [-0.5, 0], to: [0.5, 0], width: 0.4}]\n");
    size_t missing = 0;
    for (size_t i = 0; i < b.cloud.n; i++)
        assert_false (fabs (b.cloud.x[2*i]) < 0.5 && fabs (b.cloud.x[2*i + 1]) < 0.2);
    missing = 400 - b.cloud.n;
    assert_int_equal (missing, 40);
    unbuild (&b);
}

static void layers_keep_their_material (void **state)
{
    (void) state;
    cracked c =
        cracked_of (PLATE "layers: [{name: grip, side: top, thickness: 2 spacing}]\ncracks: [{from: [0, "
                          "0.5], to: [0, 2], width: 0.2}]\n");
    double in[3] = { 0, 0.9, 0 }, above[3] = { 0, 1.1, 0 };
    assert_false (pg_body_inside (&c.body, in, 0));
    assert_true (pg_body_inside (&c.body, above, 0));
    clear (&c);
}

/* ---- in space ------------------------------------------------------------------------------------------ */
static void plates_and_cylinders_are_taken (void **state)
{
    (void) state;
    const double low[3] = { -1, -1, -1 }, high[3] = { 1, 1, 1 }, pi = acos (-1);
    cracked c =
        cracked_of (CUBE "cracks:\n  - {disc: {center: [0.5, 0.5, 0.5], normal: [1, 2, 2], radius: 0.3}, "
                         "width: 0.2}\n  - {polygon: [[-0.8, -0.8, -0.8], [0, -0.8, -0.2], [0, 0, -0.2], "
                         "[-0.8, 0, -0.8]], width: 0.1}\n");
    double removed = pi * 0.09 * 0.2 + 1 * 0.8 * 0.1;
    check_absolute (1 - share_inside (&c.body, low, high, 120), removed / 8, 1e-4);
    /* the plate is 1 long along (0.8, 0, 0.6), and has the normal (-0.6, 0, 0.8) */
    static const struct { double u, y, n; int in; } places[] = {
        { 0.5, -0.4, 0, 0 }, { 0.01, -0.01, 0.049, 0 }, { 0.99, -0.79, -0.049, 0 }, { 0.5, -0.4, 0.051, 1 },
        { 1.01, -0.4, 0, 1 }, { 0.5, 0.01, 0, 1 } };
    for (size_t k = 0; k < sizeof places / sizeof *places; k++) {
        double x[3] = { -0.8 + 0.8 * places[k].u - 0.6 * places[k].n, places[k].y,
                        -0.8 + 0.6 * places[k].u + 0.8 * places[k].n };
        assert_int_equal (pg_body_inside (&c.body, x, 0), places[k].in);
    }
    clear (&c);
}

static void an_ellipse_in_space_is_a_polygon_of_its_area (void **state)
{
    (void) state;
    const double pi = acos (-1);
    cracked c =
        cracked_of (CUBE "cracks: [{ellipse: {center: [0, 0, 0], normal: [0, 0, 1], along: [1, 1, 5], "
                         "length: 1, breadth: 0.4}}]\n");
    pg_network n;
    check_ok (pg_network_measure (&n, &c.sharp, c.scene));
    check_relative (n.size, pi * 0.5 * 0.2, 1e-12);
    double s = sqrt (0.5), in[2][3] = { { 0.49 * s, 0.49 * s, -0.1 }, { 0.49 * s, 0.49 * s, 0.1 } },
           out[2][3] = { { -0.21 * s, 0.21 * s, -0.1 }, { -0.21 * s, 0.21 * s, 0.1 } };
    assert_true (pg_cracks_cut (&c.sharp, in[0], in[1], 1e-10) != NULL);
    assert_true (pg_cracks_cut (&c.sharp, out[0], out[1], 1e-10) == NULL);
    clear (&c);
}

/* ---- tables -------------------------------------------------------------------------------------------- */
static char folder[] = "/tmp/perigal_slots_XXXXXX";

static void write_file (const char *name, const char *text)
{
    char path[256];
    snprintf (path, sizeof path, "%s/%s", folder, name);
    FILE *f = fopen (path, "w");
    assert_non_null (f);
    fputs (text, f), fclose (f);
}

static pg_scene *scene_beside (const char *text)
{
    char path[256];
    pg_scene *scene = NULL;
    write_file ("scene.yaml", text);
    snprintf (path, sizeof path, "%s/scene.yaml", folder);
    check_ok (pg_scene_load (&scene, path));
    return scene;
}

static void a_table_is_read_back_as_the_same_bits (void **state)
{
    (void) state;
    static const struct { const char *body, *cracks, *again;
    } all[] = {
        { PLATE,
          "cracks: [{random: {count: 20, length: 0.3, inside: middle}, width: 0.03}, {from: [0.1, 0.3], to: "
          "[0.7, 0.9]}]\n",
          "cracks: [{file: t.csv}]\n" },
        { PLATE,
          "cracks: [{polyline: [[0, 0], [0.1, 0.3], [0.5, 0.7]], width: 0.01}, {polyline: [[0.5, 0], [0.6, "
          "0.1]]}, {ellipse: {center: [-0.5, -0.5], length: 0.3, breadth: 0.1, angle: 0.3}}]\n",
          "cracks: [{file: t_polyline.csv}, {file: t.csv}, {file: t_polygon.csv}]\n" },
        { CUBE, "cracks: [{random: {count: 20, length: 0.4}, width: 0.03}]\n", "cracks: [{file: t.csv}]\n" },
        { CUBE, "cracks: [{random: {count: 20, length: 0.4, shape: rectangle, aspect: 0.7}}]\n",
          "cracks: [{file: t.csv}]\n" },
    };
    for (size_t k = 0; k < sizeof all / sizeof *all; k++) {
        char text[1200], path[256];
        pg_cracks a, b;
        snprintf (text, sizeof text, "%s%s", all[k].body, all[k].cracks);
        pg_scene *scene = scene_beside (text);
        check_ok (pg_network_read (&a, scene));
        snprintf (path, sizeof path, "%s/t.csv", folder);
        check_ok (pg_cracks_write (&a, path, NULL, NULL));
        pg_scene_free (&scene);
        snprintf (text, sizeof text, "%s%s", all[k].body, all[k].again);
        scene = scene_beside (text);
        check_ok (pg_network_read (&b, scene));
        assert_int_equal (a.n, b.n);
        for (size_t i = 0; i < a.n; i++) {
            size_t n = a.crack[i].nvertex * (size_t) a.dim;
            assert_int_equal (a.crack[i].nvertex, b.crack[i].nvertex);
            assert_int_equal (a.crack[i].kind, b.crack[i].kind);
            assert_int_equal (a.crack[i].bend, b.crack[i].bend);
            assert_memory_equal (a.crack[i].vertex, b.crack[i].vertex, n * sizeof (double));
            assert_memory_equal (a.crack[i].normal, b.crack[i].normal, sizeof a.crack[i].normal);
            assert_true (a.crack[i].slot == b.crack[i].slot && a.crack[i].radius == b.crack[i].radius);
        }
        pg_cracks_clear (&a), pg_cracks_clear (&b);
        pg_scene_free (&scene);
    }
}

static void a_table_may_have_units_and_any_order (void **state)
{
    (void) state;
    write_file ("u.csv", "# two cracks\nwidth [um], y1 [mm], x1 [mm], x2 (cm), y2\n\n0, 100, 200, 30, 0.4  # "
                         "sharp\n2000, 0, 0, 1, 0\n");
    write_file ("plain.csv", "0.1 0.2 0.3 0.4\n0.5 0.5 0.6 0.5\n");
    pg_scene *scene = scene_beside (PLATE "cracks: [{file: u.csv}, {file: plain.csv, width: 1 mm}]\n");
    pg_cracks c;
    static const double expected[4][5] = { { 0.2, 0.1, 0.3, 0.4, 0 },
                                           { 0, 0, 0.01, 0, 0.002 },
                                           { 0.1, 0.2, 0.3, 0.4, 0.001 },
                                           { 0.5, 0.5, 0.6, 0.5, 0.001 } };
    check_ok (pg_network_read (&c, scene));
    assert_int_equal (c.n, 4);
    for (size_t i = 0; i < 4; i++) {
        for (size_t k = 0; k < 4; k++) check_relative (c.crack[i].vertex[k], expected[i][k], 1e-15);
        check_relative (c.crack[i].slot, expected[i][4], 1e-15);
    }
    pg_cracks_clear (&c);
    pg_scene_free (&scene);
}

static void a_wrong_table_is_told_with_its_line (void **state)
{
    (void) state;
    static const struct { const char *table, *cracks, *part; } all[] = {
        { "x1, y1, x2, y2\n0, 0, 1, 0\n0, 0, 1\n", "", "t.csv:3: 3 columns, but there are 4" },
        { "x1, y1, x2, y3\n", "", "column 4 is none of them" },
        { "x1, y1, x2\n", "", "make no cracks in 2D: give x1, y1, x2, y2" },
        { "x1 [kg], y1, x2, y2\n", "", "t.csv:1: column 1, 'x1'" },
        { "0, 0, 1, abc\n", "", "'abc' in column 4 (y2) is not a finite number" },
        { "0, 0, 1, 0, -1\n", "", "negative" },
        { "0, 0, 1, 0, 0.1\n", ", width: 1 mm", "only one of them" },
        { "0, 0, 0, 0\n", "", "two ends are one place" },
        { "polygon, x, y\n1, 0, 0\n1, 1, 0\n2, 0, 0\n", "", "t.csv:2: polygon 1 needs three vertices" },
        { "polyline, x, y\n1, 0, 0\n2, 1, 0\n2, 0, 0\n", "", "polyline 1 needs two vertices" },
        { "polyline, x, y, width\n1, 0, 0, 1\n1, 1, 0, 2\n", "", "the width of one crack changes" },
        { "# nothing\n", "", "holds no crack" },
        { "0, 0, 0\n", "", "3 columns; without a header 4 are expected" },
        { "5, 5, 6, 6\n", "", "lies outside the body" },
    };
    for (size_t k = 0; k < sizeof all / sizeof *all; k++) {
        char text[600];
        pg_cracks c;
        write_file ("t.csv", all[k].table);
        snprintf (text, sizeof text, PLATE "cracks: [{file: t.csv%s}]\n", all[k].cracks);
        pg_scene *scene = scene_beside (text);
        check_fails (pg_network_read (&c, scene), PG_E_SCENE);
        check_contains (pg_last_error (), all[k].part);
        pg_scene_free (&scene);
    }
}

/* ---- faults, and what a network amounts to ------------------------------------------------------------- */
static void what_cannot_be_is_said (void **state)
{
    (void) state;
    must_fault (PLATE "cracks: [{polygon: [[0, 0], [0.5, 0], [0, 0.5]], width: 1 mm}]\n", "leave width out");
    must_fault (PLATE "cracks: [{polygon: [[0, 0], [0.5, 0]]}]\n", "three vertices");
    must_fault (PLATE "cracks: [{ellipse: {center: [0, 0], length: 0.1, breadth: 0.2}}]\n",
                "broader than long");
    must_fault (PLATE "cracks: [{ellipse: {center: [0, 0], length: 0.2, breadth: 0.1, along: [1, 0]}}]\n",
                "is for 3D");
    must_fault (PLATE "cracks: [{polyline: [[0, 0], [0, 0], [1, 0]], width: 0.1}]\n",
                "twice in a row: 1 and 2");
    must_fault (CUBE "cracks: [{ellipse: {center: [0, 0, 0], length: 0.2, breadth: 0.1}, width: 0.01}]\n",
                "needs normal and along");
    must_fault (CUBE
                "cracks: [{ellipse: {center: [0, 0, 0], length: 0.2, breadth: 0.1, normal: [0, 0, 2], along: "
                "[0, 0, 1]}, width: 0.01}]\n",
                "long axis lies along its normal");
    must_fault ("dimension: 2\npoints: none.csv\ncracks: [{from: [0, 0], to: [1, 0], width: 0.1}]\n",
                "from a body of shapes only");
}

static void a_network_is_measured (void **state)
{
    (void) state;
    /* a cross, one that leaves the body by a quarter of its length, one alone, and one outside in a file */
    write_file ("t.csv", "-0.2, 0, 0.2, 0\n0, -0.2, 0, 0.2\n0.9, 0.5, 1.3, 0.5\n3, 3, 3, 4\n");
    pg_scene *scene =
        scene_beside (PLATE "cracks: [{file: t.csv}, {from: [-0.5, -0.9], to: [-0.5, -0.8], width: "
                            "0.02}]\n");
    pg_cracks c;
    pg_network n;
    check_ok (pg_network_read (&c, scene));
    check_ok (pg_network_measure (&n, &c, scene));
    assert_int_equal (n.n, 5);
    assert_int_equal (n.slots, 1);
    assert_int_equal (n.crossing, 2);
    assert_int_equal (n.leaving, 1);
    assert_int_equal (n.outside, 1);
    check_relative (n.size, 0.4 + 0.4 + 0.4 + 1 + 0.1, 1e-12);
    check_relative (n.inside, 0.4 + 0.4 + 0.1 + 0.1, 1e-12);
    check_relative (n.removed, 0.002, 1e-12);
    check_relative (n.body, 4, 1e-12);
    check_relative (n.mean, 2.3 / 5, 1e-12);
    check_relative (n.least, 0.1, 1e-12), check_relative (n.most, 1, 1e-12);
    check_relative (n.order, fabs (0.8 - 1.5) / 2.3, 1e-12);
    check_absolute (fabs (n.axis[1]), 1, 1e-12);
    assert_true (n.nearest == 0);
    pg_cracks_clear (&c);
    pg_scene_free (&scene);
}

/* A plate through the middle of another, far from all of its edges, crosses it; one above it does not. */
static void crossing_in_space_is_seen (void **state)
{
    (void) state;
    static const double low[2] = { -0.4, 0.1 }, nearest[2] = { 0, 0.1 };
    for (int k = 0; k < 2; k++) {
        char text[600];
        pg_cracks c;
        pg_network n;
        snprintf (text, sizeof text,
                  CUBE
                  "cracks: [{polygon: [[-0.5, -0.5, 0], [0.5, -0.5, 0], [0.5, 0.5, 0], [-0.5, 0.5, 0]]}, "
                  "{polygon: [[0, -0.1, %g], [0, 0.1, %g], [0, 0.1, 0.4], [0, -0.1, 0.4]]}]\n",
                  low[k], low[k]);
        pg_scene *scene = parsed (text);
        check_ok (pg_network_read (&c, scene));
        check_ok (pg_network_measure (&n, &c, scene));
        assert_int_equal (n.crossing, k ? 0 : 2);
        check_absolute (n.nearest, nearest[k], 1e-14);
        pg_cracks_clear (&c);
        pg_scene_free (&scene);
    }
}

static void any_allocation_may_fail (void **state)
{
    (void) state;
    write_file ("t.csv", "polygon, x, y\n1, 0, 0\n1, 0.1, 0\n1, 0, 0.1\n");
    pg_scene *scene =
        scene_beside (PLATE "cracks: [{polyline: [[0, 0], [0.3, 0], [0.5, 0.1]], width: 0.1}, {file: "
                            "t.csv}]\n");
    size_t before = pg_memory_used (), k = 0;
    pg_status status = PG_E_MEMORY;
    while (status != PG_OK) {
        pg_body body;
        pg_memory_fail_at (++k);
        status = pg_body_read (&body, scene);
        pg_memory_fail_at (0);
        if (status == PG_OK) pg_body_clear (&body);
        else assert_int_equal (status, PG_E_MEMORY);
        assert_int_equal (pg_memory_used (), before);
    }
    assert_true (k > 8);
    pg_scene_free (&scene);
}

static int make_folder (void **state)
{
    (void) state;
    return mkdtemp (folder) == NULL;
}

static int remove_folder (void **state)
{
    static const char *const names[] = { "t.csv", "t_polygon.csv", "t_polyline.csv", "u.csv", "plain.csv",
                                         "scene.yaml" };
    char path[256];
    (void) state;
    for (size_t k = 0; k < sizeof names / sizeof *names; k++)
        snprintf (path, sizeof path, "%s/%s", folder, names[k]), remove (path);
    return rmdir (folder);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (a_slot_takes_its_rectangle),
        cmocka_unit_test (a_width_may_count_in_spacings),
        cmocka_unit_test (bonds_across_a_slot_are_cut),
        cmocka_unit_test (a_polyline_is_one_slot),
        cmocka_unit_test (outlines_are_slots),
        cmocka_unit_test (bonds_pass_outlines_or_not),
        cmocka_unit_test (many_slots_answer_as_one_by_one),
        cmocka_unit_test (points_in_a_slot_are_missing),
        cmocka_unit_test (layers_keep_their_material),
        cmocka_unit_test (plates_and_cylinders_are_taken),
        cmocka_unit_test (an_ellipse_in_space_is_a_polygon_of_its_area),
        cmocka_unit_test (a_table_is_read_back_as_the_same_bits),
        cmocka_unit_test (a_table_may_have_units_and_any_order),
        cmocka_unit_test (a_wrong_table_is_told_with_its_line),
        cmocka_unit_test (what_cannot_be_is_said),
        cmocka_unit_test (a_network_is_measured),
        cmocka_unit_test (crossing_in_space_is_seen),
        cmocka_unit_test (any_allocation_may_fail),
    };
    return cmocka_run_group_tests (tests, make_folder, remove_folder);
}
