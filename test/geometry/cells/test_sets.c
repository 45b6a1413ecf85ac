/* SPDX-License-Identifier: GPL-3.0-or-later
 * Sets: sides of the box, surfaces of shapes, angles, conditions, parts, faults; nodes, cells and points from
 * a file. */
#include "model.h"
#include <stdlib.h>
#include <unistd.h>

#define PLATE \
    "dimension: 2\nbody:\n  - add: {box: {low: [0, 0], high: [2, 1]}}\n  - subtract: {disk: {center: [0.5, " \
    "0.5], radius: 0.22}}\nspacing: 0.1\n"
#define DISK \
    "dimension: 2\nthickness: 10 mm\nbody: [{add: {disk: {center: [0, 0], diameter: 100 mm}}}]\nspacing: 2 " \
    "mm\n"
#define CUBE "dimension: 3\nbody: [{add: {box: {low: [0, 0, 0], high: [1, 2, 3]}}}]\nspacing: 0.5\n"

static double area (const model *m, const char *name)
{
    const pg_set *s = find (m, name);
    double sum = 0;
    for (size_t k = 0; k < s->nfacet; k++) sum += m->cells.area[s->facet[k]];
    return sum;
}

static double angle_at (double x, double y) { double a = atan2 (y, x); return a < 0 ? a + 2 * acos (-1) : a; }

static void sides_of_a_box_have_their_points_and_areas (void **state)
{
    (void) state;
    model m;
    check_ok (make (&m, CUBE, 0));
    const char *name[6] = {"left", "right", "bottom", "top", "back", "front"};
    size_t points[3] = {5 * 7, 3 * 7, 3 * 5};
    double size[3] = {6, 3, 2};
    for (int s = 0; s < 6; s++) {
        const pg_set *set = find (&m, name[s]);
        assert_int_equal (set->npoint, points[s / 2]);
        check_relative (area (&m, name[s]), size[s / 2], 1e-14);
        for (size_t k = 0; k < set->npoint; k++)
            assert_true (m.cloud.x[3 * set->point[k] + s / 2] == (s % 2 ? 1 + s / 2 : 0));
    }
    drop (&m);
}

/* Whole cells stand for the surface: every facet of a part is near it and looks out of the body there. */
static void parts_of_stairs_are_where_they_should_be (void **state)
{
    (void) state;
    static const struct { const char *text; int axis; double at, out, area;
    } part[] = {
#define ROD \
    "dimension: 3\nbody: [{add: {cylinder: {center: [0, 0, -1], axis: [0, 0, 1], radius: 1, length: " \
    "2}}}]\nspacing: 0.2\nsets: {part: {boundary: cylinder."
        { ROD "start}}", 2, -1, -1, 3.14 },      { ROD "end}}", 2, 1, 1, 3.14 },
#define AHEAD "[0.3, 0.2], [0.7, 0.2], [0.7, 0.8], [0.3, 0.8]"
#define BACK "[0.3, 0.8], [0.7, 0.8], [0.7, 0.2], [0.3, 0.2]"
#define WITH(vertices) \
    "dimension: 2\nbody: [{add: {box: {low: [0, 0], high: [1, 1]}}}, {name: pit, subtract: {polygon: " \
    "{vertices: [" vertices "]}}}]\nspacing: 0.1\nsets: {part: {boundary: pit.edge "
        { WITH (AHEAD) "1}}", 1, 0.2, 1, 0.4 },  { WITH (AHEAD) "2}}", 0, 0.7, -1, 0.6 },
        { WITH (AHEAD) "3}}", 1, 0.8, -1, 0.4 }, { WITH (AHEAD) "4}}", 0, 0.3, 1, 0.6 },
        { WITH (BACK) "1}}", 1, 0.8, -1, 0.4 },  { WITH (BACK) "2}}", 0, 0.7, -1, 0.6 },
#define SQUARE \
    "dimension: 2\nbody: [{add: {polygon: {vertices: [" AHEAD \
    "]}}}]\nspacing: 0.1\nsets: {part: {boundary: polygon.edge "
        { SQUARE "1}}", 1, 0.2, -1, 0.4 },       { SQUARE "4}}", 0, 0.3, -1, 0.6 },
    };
    for (size_t k = 0; k < sizeof part / sizeof *part; k++) {
        model m;
        check_ok (make (&m, part[k].text, 0));
        size_t dim = (size_t) m.cells.dim;
        const pg_set *s = find (&m, "part");
        assert_true (s->nfacet > 0);
        check_relative (area (&m, "part"), part[k].area, 0.15);
        for (size_t f = 0; f < s->nfacet; f++) {
            size_t at = (size_t) s->facet[f] * dim + (size_t) part[k].axis;
            check_scaled (m.cells.normal[at], part[k].out, 1e-12, 1);
            assert_true (fabs (m.cells.facet_centre[at] - part[k].at) < 1e-9);
        }
        drop (&m);
    }
}

/* A slanted face that ends in the plane of a side is none of it, cut or not. */
static void a_face_that_ends_in_a_side_is_none_of_it (void **state)
{
    (void) state;
    for (int cut = 0; cut < 2; cut++) {
        model m;
        check_ok (make (&m,
                        "dimension: 2\nbody: [{add: {polygon: {vertices: [[0, 0], [16, 0], [16, 10], [0, "
                        "20]]}}}]\nspacing: 1",
                        cut));
        assert_int_equal (find (&m, "top")->nfacet, 0);
        check_relative (area (&m, "left"), 20, 1e-12);
        check_relative (area (&m, "right"), 10, 1e-12);
        drop (&m);
        check_ok (make (&m,
                        "dimension: 2\nbody: [{add: {box: {low: [0, 0], high: [10, 10]}}}, {subtract: {box: "
                        "{low: [4, 5], high: [6, 7]}}}]\nspacing: 1",
                        cut));
        /* not the floor of the hole below it, which looks up as well */
        check_relative (area (&m, "top"), 10, 1e-12);
        check_relative (area (&m, "all"), 48, 1e-12);
        drop (&m);
    }
}

static void a_bar_has_two_ends (void **state)
{
    (void) state;
    model m;
    check_ok (
        make (&m, "dimension: 1\ncross_section: 3\nbody: [{add: {box: {low: [0], high: [1]}}}]\nspacing: 0.1",
              0));
    assert_int_equal (find (&m, "left")->npoint, 1);
    assert_int_equal (find (&m, "right")->point[0], 10);
    check_relative (area (&m, "right"), 3, 1e-15);
    assert_null (pg_sets_find (&m.sets, "top"));
    assert_int_equal (find (&m, "all.left")->npoint, 5);
    drop (&m);
}

static void all_is_everything (void **state)
{
    (void) state;
    model m;
    check_ok (make (&m, PLATE, 0));
    assert_int_equal (find (&m, "all")->npoint, m.cloud.n);
    assert_int_equal (find (&m, "all")->nfacet, m.cells.nfacet);
    drop (&m);
}

static void a_hole_is_what_lies_nearest_to_its_circle (void **state)
{
    (void) state;
    model m;
    check_ok (
        make (&m, PLATE "sets: {bore: {boundary: hole}, edge: {boundary: side}, whole: {boundary: all}}", 0));
    const pg_set *bore = find (&m, "bore");
    /* a ring has as many corners as edges */
    assert_true (bore->nfacet >= 12 && bore->npoint == bore->nfacet);
    for (size_t k = 0; k < bore->npoint; k++)
        assert_true (hypot (m.cloud.x[2 * bore->point[k]] - 0.5, m.cloud.x[2 * bore->point[k] + 1] - 0.5)
                     < 0.35);
    check_relative (area (&m, "edge"), 6, 1e-13);
    check_relative (area (&m, "edge") + area (&m, "bore"), area (&m, "whole"), 1e-13);
    assert_int_equal (find (&m, "whole")->npoint, bore->npoint + find (&m, "edge")->npoint);
    assert_true (find (&m, "whole")->npoint < m.cloud.n);
    drop (&m);
}

static void boundaries_add_up_and_conditions_narrow_down (void **state)
{
    (void) state;
    model m;
    check_ok (
        make (&m,
              PLATE
              "sets: {ends: {boundary: [left, right]}, corner: {boundary: [left, right], where: y <= 0.27}}",
              0));
    assert_int_equal (find (&m, "ends")->npoint, 22);
    assert_int_equal (find (&m, "corner")->npoint, 6);          /* y = 0, 0.1, 0.2 */
    assert_int_equal (find (&m, "corner")->nfacet, 6);          /* centres at 0.05, 0.15, 0.25 */
    drop (&m);
}

static void where_alone_picks_points_inside_as_well (void **state)
{
    (void) state;
    model m;
    check_ok (make (&m, CUBE "sets: {core: {where: x > 0.2 and x < 0.8 and r > 1 and angle < 90 deg}}", 0));
    const pg_set *s = find (&m, "core");
    size_t n = 0;
    for (size_t i = 0; i < m.cloud.n; i++) {
        const double *x = m.cloud.x + 3*i;
        int in = x[0] > 0.2 && x[0] < 0.8 && sqrt (x[0]*x[0] + x[1]*x[1] + x[2]*x[2]) > 1;
        if (in) assert_int_equal (s->point[n++], i);
    }
    assert_int_equal (s->npoint, n);
    assert_true (n > 10);
    drop (&m);
}

static void platens_of_the_disk_are_found_by_angle (void **state)
{
    (void) state;
    model m;
    check_ok (make (&m,
                    DISK "sets: {platens: {boundary: rim, angle: [[80 deg, 100 deg], [260 deg, 280 deg]]}}",
                    0));
    const pg_set *s = find (&m, "platens"), *top = find (&m, "platens.top"),
                 *bottom = find (&m, "platens.bottom");
    double degree = acos (-1) / 180;
    size_t n = 0;
    assert_int_equal (top->npoint + bottom->npoint, s->npoint);
    assert_int_equal (top->npoint, bottom->npoint);
    assert_int_equal (top->nfacet, bottom->nfacet);
    for (size_t k = 0; k < top->npoint; k++) {
        const double *x = m.cloud.x + 2 * top->point[k];
        double a = angle_at (x[0], x[1]);
        assert_true (x[1] > 0.04 && a >= 80 * degree - 1e-9 && a <= 100 * degree + 1e-9);
    }
    for (size_t i = 0; i < m.cloud.n; i++) {  /* corners of the staircase: not all four cells around */
        double a = angle_at (m.cloud.x[2*i], m.cloud.x[2*i + 1]);
        n += m.cloud.x[2*i + 1] > 0 && m.cloud.volume[i] < 3.99e-8 && a >= 80 * degree && a <= 100 * degree;
    }
    assert_int_equal (top->npoint, n);
    assert_int_equal (find (&m, "platens.left")->npoint, find (&m, "platens.right")->npoint);
    drop (&m);
}

static void angles_wrap_around (void **state)
{
    (void) state;
    model m;
    check_ok (make (&m,
                    DISK "sets: {a: {angle: [[350 deg, 10 deg]]}, b: {angle: [[-10 deg, 10 deg]]}, c: "
                         "{angle: [[710 deg, 730 deg]]}, d: {angle: [[0, 360 deg]]}}",
                    0));
    const pg_set *a = find (&m, "a"), *b = find (&m, "b"), *c = find (&m, "c");
    assert_int_equal (a->npoint, b->npoint);
    assert_int_equal (a->npoint, c->npoint);
    assert_memory_equal (a->point, b->point, a->npoint * sizeof (int));
    assert_memory_equal (a->point, c->point, a->npoint * sizeof (int));
    for (size_t k = 0; k < a->npoint; k++) assert_true (m.cloud.x[2 * a->point[k]] > 0);
    assert_int_equal (find (&m, "d")->npoint, m.cloud.n - 1);   /* the centre has no angle */
    drop (&m);
}

static void parts_leave_out_the_middle (void **state)
{
    (void) state;
    model m;
    check_ok (make (&m, CUBE, 0));
    assert_int_equal (find (&m, "all.left")->npoint, 35);
    assert_int_equal (find (&m, "all.right")->npoint, 35);
    assert_int_equal (find (&m, "all.back")->npoint, 3 * 5 * 3);
    assert_int_equal (find (&m, "left.top")->npoint, 14);
    assert_int_equal (find (&m, "left.right")->npoint, 0);
    assert_int_equal (find (&m, "top.front")->nfacet, 2 * 3);
    drop (&m);
}

static void points_in_cells_take_the_cells_behind_the_facets (void **state)
{
    (void) state;
    model m;
    check_ok (make (&m, PLATE "lattice: cells\nsets: {bore: {boundary: hole}}", 0));
    const pg_set *left = find (&m, "left"), *bore = find (&m, "bore");
    assert_int_equal (left->npoint, 10);
    for (size_t k = 0; k < 10; k++) check_relative (m.cloud.x[2 * left->point[k]], 0.05, 1e-13);
    for (size_t k = 0; k < bore->npoint; k++) {
        double r = hypot (m.cloud.x[2 * bore->point[k]] - 0.5, m.cloud.x[2 * bore->point[k] + 1] - 0.5);
        assert_true (r >= 0.22 && r < 0.36);
    }
    drop (&m);
}

static void a_shifted_lattice_still_has_its_sides (void **state)
{
    (void) state;
    model m;
    check_ok (make (&m,
                    "dimension: 2\nbody: [{add: {box: {low: [0, 0], high: [2, 1]}}}]\nspacing: "
                    "0.1\nlattice_offset: [0.3, -0.6]\n",
                    0));
    check_relative (area (&m, "left"), 1, 1e-13);
    check_relative (area (&m, "right"), 1, 1e-13);
    check_relative (area (&m, "top"), 2, 1e-13);
    check_relative (area (&m, "bottom"), 2, 1e-13);
    drop (&m);
}

static void members_ascend (void **state)
{
    (void) state;
    model m;
    check_ok (make (&m, DISK "sets: {platens: {boundary: [rim, all]}}", 0));
    for (size_t k = 0; k < m.sets.n; k++) {
        const pg_set *s = &m.sets.set[k];
        for (size_t i = 1; i < s->npoint; i++) assert_true (s->point[i - 1] < s->point[i]);
        for (size_t i = 1; i < s->nfacet; i++) assert_true (s->facet[i - 1] < s->facet[i]);
    }
    drop (&m);
}

static void points_from_a_file_have_sides_but_no_facets (void **state)
{
    (void) state;
    char path[] = "/tmp/perigal_sets_XXXXXX", text[200];
    int handle = mkstemp (path);
    FILE *f = fdopen (handle, "w");
    assert_non_null (f);
    for (int j = 0; j < 5; j++) for (int i = 0; i < 9; i++) fprintf (f, "%g,%g,0.01\n", 0.1 * i, 0.1 * j);
    fclose (f);
    snprintf (text, sizeof text,
              "dimension: 2\npoints: %s\nsets: {low: {where: y < 0.15}, ring: {boundary: all}}\n", path);
    model m;
    check_ok (make (&m, text, 0));
    assert_int_equal (find (&m, "left")->npoint, 5);
    assert_int_equal (find (&m, "top")->npoint, 9);
    assert_int_equal (find (&m, "low")->npoint, 18);
    assert_int_equal (find (&m, "ring")->npoint, 24);
    assert_int_equal (find (&m, "low")->nfacet, 0);
    drop (&m);
    snprintf (text, sizeof text, "dimension: 2\npoints: %s\nsets: {low: {boundary: rim}}\n", path);
    must_fault (text, "no boundary is called 'rim'");
    unlink (path);
}

static void an_empty_set_of_the_scene_is_a_fault (void **state)
{
    (void) state;
    must_fault (PLATE "sets: {far: {where: x > 5}}", "test.yaml:6:8: sets.far: the set is empty");
    must_fault (PLATE "sets: {far: {boundary: left, where: x > 1}}", "sets.far: the set is empty");
}

static void unknown_boundaries_name_the_known_ones (void **state)
{
    (void) state;
    must_fault (PLATE "sets: {a: {boundary: hle}}", "did you mean hole?");
    must_fault (PLATE "sets: {a: {boundary: front}}", "no boundary is called 'front'");
    must_fault (PLATE "sets: {a: {boundary: [left, qqqqqq]}}",
                "there are left|right|bottom|top|all|side|hole");
}

static void conditions_that_make_no_sense_are_faults (void **state)
{
    (void) state;
    must_fault (PLATE "sets: {a: {angle: [[1, 2, 3]]}}", "range 1 must be a pair");
    must_fault (PLATE "sets: {a: {angle: []}}", "has no range");
    must_fault (PLATE "sets: {a: {where: t > 0.5 s}}", "does not change with t");
    must_fault ("dimension: 1\nbody: [{add: {box: {low: [0], high: [1]}}}]\nspacing: 0.1\nsets: {a: {angle: "
                "[[0, 1]]}}",
                "needs dimension 2 or 3");
    must_fault (PLATE "sets: {a: {}}", "give boundary, angle or where");
}

static void names_of_sets_are_checked (void **state)
{
    (void) state;
    must_fault (PLATE "sets: {left: {where: x > 1}}", "always there");
    must_fault (PLATE "sets: {a123456789a123456789a123456789a123456789a123456789a1234567: {where: x > 1}}",
                "at most 56 letters");
    model m;
    check_ok (make (&m,
                    PLATE "sets: {a123456789a123456789a123456789a123456789a123456789a12345: {where: x > 1}}",
                    0));
    find (&m, "a123456789a123456789a123456789a123456789a123456789a12345.bottom");
    drop (&m);
}

static void all_faulty_sets_are_reported_together (void **state)
{
    (void) state;
    const char *text = PLATE "sets:\n  a: {where: x > 9}\n  b: {boundary: hle}\n  c: {where: y < -1}\n";
    must_fault (text, "sets.a: the set is empty");
    must_fault (text, "sets.b.boundary = hle: no boundary");
    must_fault (text, "sets.c: the set is empty");
}

static void any_allocation_may_fail (void **state)
{
    (void) state;
    model m;
    check_ok (make (&m, PLATE "sets: {a: {boundary: hole, angle: [[0, 6.3]], where: x > 0.1}}", 0));
    pg_sets_clear (&m.sets);
    size_t before = pg_memory_used (), k = 0;
    pg_status status = PG_E_MEMORY;
    while (status != PG_OK) {
        pg_memory_fail_at (++k);
        status = pg_sets_build (&m.sets, m.scene, &m.body, &m.lattice, &m.cloud, &m.cells);
        pg_memory_fail_at (0);
        if (status == PG_OK) pg_sets_clear (&m.sets);
        else assert_int_equal (status, PG_E_MEMORY);
        assert_int_equal (pg_memory_used (), before);
    }
    assert_true (k > 20);
    drop (&m);
}

/* The round surface of a cylinder is its rim, its flat ends are not. */
static void the_rim_of_a_cylinder_is_round (void **state)
{
    (void) state;
    model m;
    check_ok (make (&m,
                    "dimension: 3\nbody: [{add: {cylinder: {center: [0, 0, 0], length: 10 mm, diameter: 40 "
                    "mm}}}]\nspacing: 2 mm\n"
                    "sets: {platens: {boundary: rim, angle: [[80 deg, 100 deg]]}, ends: {boundary: side}, "
                    "skin: {boundary: all}}",
                    0));
    const pg_set *platens = pg_sets_find (&m.sets, "platens"), *ends = pg_sets_find (&m.sets, "ends"),
                 *skin = pg_sets_find (&m.sets, "skin");
    assert_true (platens->npoint > 0 && platens->nfacet > 0);
    for (size_t i = 0; i < platens->npoint; i++)
        assert_true (m.cloud.x[3 * (size_t) platens->point[i] + 1] > 17e-3);
    for (size_t i = 0; i < platens->nfacet; i++)
        assert_true (fabs (m.cells.normal[3 * (size_t) platens->facet[i] + 2]) < 0.5);
    for (size_t i = 0; i < ends->nfacet; i++)
        assert_true (fabs (m.cells.normal[3 * (size_t) ends->facet[i] + 2]) > 0.5);
    size_t flat = 0;
    for (size_t i = 0; i < skin->nfacet; i++)
        flat += fabs (m.cells.normal[3 * (size_t) skin->facet[i] + 2]) > 0.5;
    assert_int_equal (ends->nfacet, flat);
    drop (&m);
}

/* A hole within one cell about the centre, where all rays begin: two ranges are divided, three that adjoin
 * have four ends, three apart are refused. */
static void more_rays_than_divide_a_cell_are_refused (void **state)
{
    static const struct { const char *angle; double share; const char *fault; } cases[] = {
        { "[[10 deg, 40 deg], [100 deg, 190 deg]]", 120.0 / 360, NULL },
        { "[[0 deg, 90 deg], [90 deg, 180 deg], [180 deg, 225 deg]]", 225.0 / 360, NULL },
        { "[[10 deg, 40 deg], [100 deg, 190 deg], [200 deg, 230 deg]]", 0,
          "sets.holes.angle: 6 ends of ranges meet in one cell" },
    };
    (void) state;
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        char text[500];
        model m = { 0 };
        pg_ray *ray;
        size_t n;
        double length = 0;
        snprintf (text, sizeof text,
                  "dimension: 2\nlattice: cells\nspacing: 0.2\nbody: [{add: {box: {low: [-1.1, -1.1], high: "
                  "[1.1, 1.1]}}}, {subtract: {disk: {center: [0, 0], radius: 0.05}}}]\n"
                  "sets: {holes: {boundary: hole, angle: %s}}\n", cases[k].angle);
        check_ok (pg_scene_parse (&m.scene, text, "test.yaml"));
        check_ok (pg_body_read (&m.body, m.scene));
        check_ok (pg_cloud_build (&m.cloud, &m.lattice, &m.body, m.scene));
        check_ok (pg_sets_rays (&ray, &n, m.scene, &m.body));
        check_ok (pg_cells_cut (&m.cells, &m.body, &m.lattice, 1, n, ray));
        pg_free (ray);
        pg_status status = pg_sets_build (&m.sets, m.scene, &m.body, &m.lattice, &m.cloud, &m.cells);
        if (cases[k].fault) {
            assert_int_equal (status, PG_E_SCENE);
            check_contains (pg_last_error (), cases[k].fault);
        } else {
            check_ok (status);
            const pg_set *s = pg_sets_find (&m.sets, "holes");
            for (size_t f = 0; f < s->nfacet; f++) length += m.cells.area[s->facet[f]];
            check_relative (length, 2 * acos (-1) * 0.05 * cases[k].share, 1e-10);
        }
        drop (&m);
    }
}

/* Two edges of a polygon that lie in one line share a facet of a cell between them: each has its own length,
 * whatever cell the vertex lies in (edge 3 and 4: hypot (0.87, 0.7); of the prism times its height 1). */
static void edges_in_one_line_have_their_lengths (void **state)
{
    (void) state;
    static const char corners[] = "[[0, 0], [1, 0], [2, 0.6], [1.13, 1.3], [0.26, 2], [-1, 1.4]]";
    static const double spacing[] = { 0.1, 0.13, 0.17, 0.21, 0.3 };
    for (int solid = 0; solid < 2; solid++)
        for (size_t k = 0; k < 5 - 2 * (size_t) solid; k++)
            for (int edge = 3; edge < 5; edge++) {
                model m;
                char text[600];
                double area = 0;
                snprintf (text, sizeof text,
                          "dimension: %d\nbody: [{add: {%s: {vertices: %s%s}}}]\nspacing: %g\n"
                          "sets: {part: {boundary: %s.edge %d}}\n",
                          2 + solid, solid ? "prism" : "polygon", corners, solid ? ", low: 0, high: 1" : "",
                          spacing[4 - k], solid ? "prism" : "polygon", edge);
                check_ok (make (&m, text, 1));
                const pg_set *part = find (&m, "part");
                for (size_t f = 0; f < part->nfacet; f++) area += m.cells.area[part->facet[f]];
                check_relative (area, hypot (0.87, 0.7), 1e-12);
                drop (&m);
            }
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (edges_in_one_line_have_their_lengths),
        cmocka_unit_test (sides_of_a_box_have_their_points_and_areas),
        cmocka_unit_test (parts_of_stairs_are_where_they_should_be),
        cmocka_unit_test (a_face_that_ends_in_a_side_is_none_of_it),
        cmocka_unit_test (a_bar_has_two_ends),
        cmocka_unit_test (all_is_everything),
        cmocka_unit_test (a_hole_is_what_lies_nearest_to_its_circle),
        cmocka_unit_test (boundaries_add_up_and_conditions_narrow_down),
        cmocka_unit_test (where_alone_picks_points_inside_as_well),
        cmocka_unit_test (platens_of_the_disk_are_found_by_angle),
        cmocka_unit_test (angles_wrap_around),
        cmocka_unit_test (parts_leave_out_the_middle),
        cmocka_unit_test (points_in_cells_take_the_cells_behind_the_facets),
        cmocka_unit_test (a_shifted_lattice_still_has_its_sides),
        cmocka_unit_test (members_ascend),
        cmocka_unit_test (points_from_a_file_have_sides_but_no_facets),
        cmocka_unit_test (an_empty_set_of_the_scene_is_a_fault),
        cmocka_unit_test (unknown_boundaries_name_the_known_ones),
        cmocka_unit_test (conditions_that_make_no_sense_are_faults),
        cmocka_unit_test (names_of_sets_are_checked),
        cmocka_unit_test (all_faulty_sets_are_reported_together),
        cmocka_unit_test (any_allocation_may_fail),
        cmocka_unit_test (the_rim_of_a_cylinder_is_round),
        cmocka_unit_test (more_rays_than_divide_a_cell_are_refused),
    };
    return cmocka_run_group_tests_name ("geometry/cells/sets", tests, NULL, NULL);
}
