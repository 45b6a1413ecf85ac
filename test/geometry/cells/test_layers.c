/* SPDX-License-Identifier: GPL-3.0-or-later
 * Layers outside a body: whole cells beside those of the body alone, their sets, whole and cut cells, nodes
 * and centres, faults, memory. */
#include "model.h"

#define BOX \
    "dimension: 2\nthickness: 2 mm\nbody: [{add: {box: {low: [-25 mm, 1 mm], high: [25 mm, 11 " \
    "mm]}}}]\nspacing: 0.51 mm\n"
#define HOLE \
    "dimension: 2\nthickness: 2 mm\nbody:\n  - add: {box: {low: [-25 mm, 1 mm], high: [25 mm, 11 mm]}}\n  " \
    "- subtract: {disk: {center: [0, 6 mm], radius: 3 mm}}\nspacing: 0.51 mm\n"
#define GRIPS \
    "layers: [{name: above, side: top, thickness: 3 spacing}, {name: below, side: bottom, thickness: 1.4 " \
    "mm}]\n"

static double total (const double *v, size_t n)
{
    double sum = 0;
    for (size_t i = 0; i < n; i++) sum += v[i];
    return sum;
}

/* 98 x 20 cells of the body alone; 3 rows above, round (1.4 / 0.5) = 3 below: those of the body stay where
 * they were. */
static void the_body_keeps_its_cells (void **state)
{
    (void) state;
    model with, alone;
    check_ok (make (&with, BOX "lattice: cells\n" GRIPS, 0));
    check_ok (make (&alone, BOX "lattice: cells\n", 0));
    assert_int_equal (alone.lattice.count[1], 20);
    assert_int_equal (with.lattice.count[0], alone.lattice.count[0]);
    assert_int_equal (with.lattice.count[1], 26);
    size_t row = (size_t) alone.lattice.count[0];
    assert_int_equal (with.cloud.n, 26 * row);
    for (int k = 0; k < 2; k++) assert_true (with.lattice.step[k] == alone.lattice.step[k]);
    for (size_t i = 0; i < alone.cloud.n; i++)
        for (size_t k = 0; k < 2; k++)
            check_scaled (with.cloud.x[(i + 3 * row) * 2 + k], alone.cloud.x[i * 2 + k], 1e-14, 25e-3);
    check_relative (total (with.cloud.volume, with.cloud.n), 50e-3 * 13e-3 * 2e-3, 1e-12);
    check_relative (with.body.low[1], -0.5e-3, 1e-12);
    check_relative (with.body.high[1], 12.5e-3, 1e-12);
    drop (&with), drop (&alone);
}

/* Equal layers on both sides: the points stay mirror images, bit by bit, where the body alone is centred. */
static void equal_layers_keep_the_mirror (void **state)
{
    (void) state;
    model m;
    check_ok (make (
        &m,
        "dimension: 2\nbody: [{add: {box: {low: [-0.3, -0.07], high: [0.3, 0.07]}}}]\nspacing: "
        "0.0033\nlattice: cells\n"
        "layers: [{name: a, side: top, thickness: 3 spacing}, {name: b, side: bottom, thickness: 3 spacing}]",
        0));
    size_t n = m.cloud.n;
    for (size_t i = 0; i < n; i++)
        for (size_t k = 0; k < 2; k++) assert_true (m.cloud.x[i * 2 + k] == -m.cloud.x[(n - 1 - i) * 2 + k]);
    drop (&m);
}

static void check_sets (const model *m, size_t rows, size_t per_row)
{
    const pg_set *above = find (m, "above"), *below = find (m, "below");
    assert_int_equal (above->npoint, rows * per_row);
    assert_int_equal (below->npoint, rows * per_row);
    assert_int_equal (find (m, "above.left")->npoint + find (m, "above.right")->npoint
                          + (per_row % 2 ? rows : 0),
                      above->npoint);
    for (size_t i = 0; i < above->npoint; i++)
        assert_true (m->cloud.x[above->point[i] * 2 + 1] > 11e-3 + 1e-5);
    for (size_t i = 0; i < below->npoint; i++)
        assert_true (m->cloud.x[below->point[i] * 2 + 1] < 1e-3 - 1e-5);
    double area = 0;
    for (size_t f = 0; f < above->nfacet; f++) area += m->cells.area[above->facet[f]];
    check_relative (area, (50e-3 + 2 * 1.5e-3) * 2e-3, 1e-12);
    for (size_t f = 0; f < find (m, "top")->nfacet; f++)   /* of the whole: the outer face */
        check_relative (m->cells.facet_centre[find (m, "top")->facet[f] * 2 + 1], 12.5e-3, 1e-12);
}

static void a_set_holds_the_points_beyond_the_face (void **state)
{
    (void) state;
    for (int cut = 0; cut < 2; cut++) {
        model m;
        check_ok (make (&m, HOLE "lattice: cells\n" GRIPS, cut));
        check_sets (&m, 3, 98);
        drop (&m);
        check_ok (make (&m, HOLE "lattice: nodes\n" GRIPS, cut));
        check_sets (&m, 3, 99);                            /* the row on the body's own face is the body's */
        drop (&m);
        check_ok (make (&m, BOX "perturb: {amount: 0.45, seed: 3}\nlattice: nodes\n" GRIPS, cut));
        assert_int_equal (find (&m, "above")->npoint, 3 * 99);
        assert_int_equal (find (&m, "below")->npoint, 3 * 99);
        drop (&m);
    }
}

/* The face between body and layer is no surface; the hole is cut as ever. */
static void cut_cells_join_the_layer (void **state)
{
    (void) state;
    model m, alone;
    check_ok (make (&m, HOLE "lattice: cells\n" GRIPS, 1));
    check_ok (make (&alone, HOLE "lattice: cells\n", 1));
    double pi = acos (-1);
    check_relative (total (m.cells.volume, m.cells.n), (50e-3 * 13e-3 - pi * 9e-6) * 2e-3, 1e-10);
    check_relative (total (m.cloud.volume, m.cloud.n), (50e-3 * 13e-3 - pi * 9e-6) * 2e-3, 1e-10);
    check_relative (total (m.cells.area, m.cells.nfacet), (2 * (50e-3 + 13e-3) + 2 * pi * 3e-3) * 2e-3, 1e-8);
    check_relative (total (m.cells.area, m.cells.nfacet),
                    total (alone.cells.area, alone.cells.nfacet) + 2 * 3e-3 * 2e-3, 1e-12);
    drop (&m), drop (&alone);
}

/* A disk meets its layer in a few cells only; the layer is whole all the same. */
static void over_a_round_body_it_covers_the_width_of_the_box (void **state)
{
    (void) state;
    model m;
    check_ok (make (
        &m,
        "dimension: 2\nbody: [{add: {disk: {center: [0, 0], radius: 1}}}]\nspacing: 0.1\nlattice: cells\n"
        "layers: [{name: lid, side: top, thickness: 0.2}]",
        1));
    assert_int_equal (find (&m, "lid")->npoint, 2 * 20);
    check_relative (total (m.cells.volume, m.cells.n), acos (-1) + 0.4, 1e-9);
    check_relative (total (m.cells.area, m.cells.nfacet), 2 * acos (-1) + 2 * 2.2, 1e-6);
    drop (&m);
}

#define L_SHAPE \
    "dimension: 2\nbody:\n  - add: {box: {low: [0, 0], high: [500, 500]}}\n  - subtract: {box: {low: [250, " \
    "0], high: [500, 250]}}\n"
static size_t of_layer (const char *scene, const char *layer, int cut, double volume)
{
    char text[800];
    model m;
    snprintf (text, sizeof text, "%slayers: [{name: foot, %s}]", scene, layer);
    check_ok (make (&m, text, cut));
    size_t n = find (&m, "foot")->npoint;
    if (volume > 0) check_relative (total (m.cells.volume, m.cells.n), volume, 1e-12);
    drop (&m);
    return n;
}

/* The foot of an L is half as wide as its box; its right side begins above the notch. */
static void over_the_body_it_leaves_out_what_has_no_body_below (void **state)
{
    (void) state;
    for (int cut = 0; cut < 2; cut++) {
        assert_int_equal (of_layer (L_SHAPE "spacing: 25\nlattice: cells\n",
                                    "side: bottom, thickness: 3 spacing", cut, 187500 + 500 * 75),
                          60);
        assert_int_equal (of_layer (L_SHAPE "spacing: 25\nlattice: cells\n",
                                    "side: bottom, thickness: 3 spacing, over: body", cut, 187500 + 250 * 75),
                          30);
        assert_int_equal (of_layer (L_SHAPE "spacing: 25\nlattice: cells\n",
                                    "side: right, thickness: 3 spacing, over: body", cut, 187500 + 250 * 75),
                          30);
        assert_int_equal (of_layer (L_SHAPE "spacing: 25\nlattice: cells\n",
                                    "side: top, thickness: 3 spacing, over: body", cut, 187500 + 500 * 75),
                          60);
        assert_int_equal (of_layer (L_SHAPE "spacing: 25\nlattice: nodes\n",
                                    "side: bottom, thickness: 3 spacing, over: body", cut, 0),
                          33);
    }
    /* cells that the notch cuts: the layer ends where the body does */
    of_layer (L_SHAPE "spacing: 30\nlattice: cells\n", "side: bottom, thickness: 1 spacing, over: body", 1,
              187500 + 250 * 500 / 17.0);
    /* in space, along both axes of the side; a disk in the first row of its cells; a box across a notch */
    assert_int_equal (of_layer ("dimension: 3\nspacing: 1\nlattice: cells\nbody: [{add: {box: {low: [0, 0, "
                                "0], high: [9, 4, 6]}}}, {add: {box: {low: [2, 4, 1], high: [5, 7, 3]}}}]\n",
                                "side: top, thickness: 2, over: body", 1, 9 * 4 * 6 + 3 * 3 * 2 + 3 * 2 * 2),
                      12);
    assert_int_equal (of_layer ("dimension: 2\nbody: [{add: {disk: {center: [0, 0], radius: 1}}}]\nspacing: "
                                "0.1\nlattice: cells\n",
                                "side: top, thickness: 0.2, over: body", 0, 0),
                      2 * 6);
    assert_int_equal (of_layer ("dimension: 2\nspacing: 1\nlattice: cells\nbody: [{add: {box: {low: [0, 0], "
                                "high: [9, 4]}}}, {subtract: {box: {low: [3, 0], high: [5, 2]}}}]\n",
                                "side: bottom, thickness: 1, over: body", 0, 32 + 9),
                      9);
}

static void in_one_and_three_dimensions (void **state)
{
    (void) state;
    model m;
    check_ok (make (&m,
                    "dimension: 1\nbody: [{add: {box: {low: [0], high: [1]}}}]\nspacing: 0.1\nlattice: "
                    "nodes\nlayers: [{name: end, side: left, thickness: 2 spacing}]",
                    1));
    assert_int_equal (find (&m, "end")->npoint, 2);
    assert_int_equal (m.cloud.n, 13);
    drop (&m);
    check_ok (make (&m,
                    "dimension: 3\nbody: [{add: {box: {low: [0, 0, 0], high: [1, 2, 3]}}}]\nspacing: "
                    "0.5\nlattice: cells\n"
                    "layers: [{name: front_grip, side: front, thickness: 1}, {name: l, side: left, "
                    "thickness: 1 spacing}]",
                    1));
    assert_int_equal (find (&m, "front_grip")->npoint, 2 * 4 * 2);
    assert_int_equal (find (&m, "l")->npoint, 4 * 6);      /* each over the face of the body alone */
    check_relative (total (m.cloud.volume, m.cloud.n), 6 + 2 + 3, 1e-12);
    drop (&m);
}

static void what_cannot_be_is_a_fault (void **state)
{
    (void) state;
    must_fault (BOX "layers: [{name: a, side: front, thickness: 1 mm}]", "a 2D body has no such side");
    must_fault (BOX "layers: [{name: a, side: top, thickness: 0.2 mm}]", "less than half a cell (0.0005 m)");
    must_fault (BOX "layers: [{name: a, side: top, thickness: 1e9 m}]", "too many");
    must_fault (BOX "layers: [{name: a, side: top, thickness: 1e5 m}]", "too fine");
    must_fault (BOX "layers: [{name: top, side: top, thickness: 1 mm}]", "already names a side");
    must_fault (BOX "layers: [{name: side, side: top, thickness: 1 mm}]", "surface of a shape");
    must_fault (BOX "layers: [{name: a.b, side: top, thickness: 1 mm}]", "no space");
    must_fault (BOX
                "layers: [{name: a, side: top, thickness: 1 mm}, {name: a, side: bottom, thickness: 1 mm}]",
                "another layer");
    must_fault (BOX "layers: [{name: a, side: top, thickness: 1 mm}, {name: b, side: top, thickness: 1 mm}]",
                "layer a is on this side already");
    must_fault (BOX "lattice_offset: [0.5, 0]\nlayers: [{name: a, side: top, thickness: 1 mm}]",
                "lattice_offset");
    must_fault (BOX "layers: [{name: a, side: top, thickness: 1 mm}]\nsets: {a: {boundary: left}}",
                "is a layer");
    must_fault ("dimension: 2\nbody: [{add: {polygon: {vertices: [[0, 0], [10, 0], [5, 7]]}}}]\nspacing: "
                "1\nlayers: [{name: a, side: top, thickness: 1, over: body}]",
                "in a corner only");
    must_fault ("dimension: 2\npoints: none.csv\nlayers: [{name: a, side: top, thickness: 1 mm}]",
                "a file of points has none");
}

static void broken_memory_leaves_nothing_behind (void **state)
{
    (void) state;
    int failed = 0;
    for (size_t at = 1; at < 400; at++) {
        model m;
        memset (&m, 0, sizeof m);
        check_ok (pg_scene_parse (&m.scene, HOLE "lattice: cells\n" GRIPS, "test.yaml"));
        pg_memory_fail_at (at);
        pg_status status = pg_body_read (&m.body, m.scene);
        pg_memory_fail_at (0);
        if (status != PG_OK) {
            assert_int_equal (status, PG_E_MEMORY);
            assert_null (m.body.shape), assert_null (m.body.layer);
            failed++;
        }
        pg_body_clear (&m.body);
        pg_scene_free (&m.scene);
        if (status == PG_OK) break;
    }
    assert_true (failed >= 2);                             /* shapes, layers */
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (the_body_keeps_its_cells),
        cmocka_unit_test (equal_layers_keep_the_mirror),
        cmocka_unit_test (a_set_holds_the_points_beyond_the_face),
        cmocka_unit_test (cut_cells_join_the_layer),
        cmocka_unit_test (over_a_round_body_it_covers_the_width_of_the_box),
        cmocka_unit_test (over_the_body_it_leaves_out_what_has_no_body_below),
        cmocka_unit_test (in_one_and_three_dimensions),
        cmocka_unit_test (what_cannot_be_is_a_fault),
        cmocka_unit_test (broken_memory_leaves_nothing_behind),
    };
    return cmocka_run_group_tests (tests, NULL, NULL);
}
