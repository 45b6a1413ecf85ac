/* SPDX-License-Identifier: GPL-3.0-or-later
 * Sides of the bounding box are the facets that lie in its planes, and parts of shapes those of that part,
 * whatever the lattice: a traction on them sums to its exact total. A side where the body has no face is a
 * fault that says what to name. */
#include "run.h"

#define ROCK "materials: {m: {youngs_modulus: 1 GPa, poissons_ratio: %s}}\n"
static const double pi = 3.14159265358979323846;

static const struct { const char *method, *nu2, *nu3;
} methods[] = {
    { "method: {integration: gauss}\n", "0.2", "0.2" },
    { "method: {integration: nodal}\n", "0.2", "0.2" },
    { "method: {integration: consistent}\n", "0.2", "0.2" },
    { "method: {approximation: nosb, integration: nodal, horizon: 2.5 spacing}\n", "0.2", "0.2" },
    { "lattice: cells\nmethod: {basis: quadratic, horizon: 3.3 spacing}\n", "0.2", "0.2" },
    { "method: {force: bond, horizon: 3 spacing}\n", "0.33333333333333333", "0.25" },
    { "lattice: cells\nmethod: {force: lps, horizon: 3 spacing}\n", "0.2", "0.2" },
};
enum { METHODS = sizeof methods / sizeof *methods };

/* Force of a traction of 1 Pa along x on a set, N, over the total that it should have. */
static double share (const char *body, int dim, double spacing, const char *rest, int m, const char *set,
                     const char *held, double total)
{
    run r = scene_of (
        1,
        "dimension: %d\n%sbody:\n%sspacing: %.17g\n" ROCK
        "%s%sboundary:\n - {set: %s, traction: {x: 1 Pa}}\n - {set: %s, displacement: {x: 0, y: 0%s}}\n"
        "output: {at: {levels: 1}}\n",
        dim, dim == 2 ? "thickness: 0.5\n" : "", body, spacing, dim == 2 ? methods[m].nu2 : methods[m].nu3,
        methods[m].method, rest, set, held, dim == 3 ? ", z: 0" : "");
    advance (&r);
    double force = r.step.reaction[0] / total;
    check_scaled (r.step.reaction[1], 0, 1e-12, fabs (total));
    clear (&r);
    return force;
}

static const char *const trapezoid = " - add: {polygon: {vertices: [[0, 0], [16, 0], [16, 10], [0, 20]]}}\n";
static const char *const wedge =
    " - add: {prism: {vertices: [[0, 0], [16, 0], [16, 10], [0, 20]], low: 0, high: 8}}\n";

static void a_traction_on_the_side_of_a_trapezoid_has_its_total (void **state)
{
    (void) state;
    static const double spacings[] = { 4, 2, 1.3, 1 };
    static const char *const offsets[] = { "", "lattice_offset: [0.3, 0.6]\n" };
    for (int m = 0; m < METHODS; m++)
        for (int h = 0; h < 4; h++)
            for (int o = 0; o < 2; o++) {
                if (o && m > 4) continue;  /* direct forces: on their own points */
                check_relative (share (trapezoid, 2, spacings[h], offsets[o], m, "right", "left", 5), 1,
                                1e-12);
                check_relative (share (trapezoid, 2, spacings[h], offsets[o], m, "polygon.edge 2",
                                       "polygon.edge 4", 5),
                                1, 1e-12);
                check_relative (share (trapezoid, 2, spacings[h], offsets[o], m, "polygon.edge_3", "bottom",
                                       0.5 * hypot (16, 10)),
                                1, 1e-12);
            }
    for (int m = 0; m < METHODS; m++) {
        check_relative (share (wedge, 3, 4, "", m, "right", "left", 80), 1, 1e-12);
        check_relative (share (wedge, 3, 4, "", m, "front", "left", 240), 1, 1e-12);
        check_relative (share (wedge, 3, 4, "", m, "prism.edge 3", "left", 8 * hypot (16, 10)), 1, 1e-12);
        check_relative (share (wedge, 3, 4, "", m, "prism.back", "left", 240), 1, 1e-12);
    }
}

static const char *const ring = " - {name: outside, add: {disk: {center: [0, 0], radius: 50}}}\n - {name: "
                                "bore, subtract: {disk: {center: [3, -2], radius: 17}}}\n";
static const char *const rod =
    " - add: {cylinder: {center: [0, 0, 0], axis: [0, 0, 1], length: 20, radius: 10}}\n";

static void curved_parts_have_their_total (void **state)
{
    (void) state;
    for (int m = 0; m < METHODS; m++) {
        check_relative (share (ring, 2, 4, "", m, "outside.rim", "bore.rim", 50 * pi), 1, 1e-9);
        check_relative (share (ring, 2, 4, "", m, "bore.rim", "outside.rim.left", 17 * pi), 1, 1e-9);
        check_relative (share (ring, 2, 4,
                               "sets: {jaw: {boundary: outside.rim, angle: [[80 deg, 97 deg]]}}\n", m, "jaw",
                               "bore.rim", 25 * 17 * pi / 180),
                        1, 1e-9);
    }
    for (int m = 0; m < METHODS; m += 2) {
        check_relative (share (rod, 3, 5, "", m, "cylinder.rim", "back", 400 * pi), 1, 1e-9);
        check_relative (share (rod, 3, 5, "", m, "cylinder.end", "cylinder.start", 100 * pi), 1, 1e-9);
        check_relative (share (rod, 3, 5, "", m, "front", "back", 100 * pi), 1, 1e-9);
    }
    check_relative (share (" - add: {sphere: {center: [1, 2, 3], radius: 10}}\n", 3, 5,
                           "sets: {half: {boundary: sphere.rim, where: z > 3}}\n", 0, "sphere.rim", "half",
                           400 * pi),
                    1, 1e-9);
}

/* Of the named shape alone, and only what bounds the body. */
static void parts_of_boxes_are_what_is_left_of_them (void **state)
{
    (void) state;
    static const char *const frame = " - {name: plate, add: {box: {low: [0, 0], high: [20, 12]}}}\n - {name: "
                                     "slot, subtract: {box: {low: [6, 5], high: [30, 7]}}}\n";
    for (int m = 0; m < METHODS; m++)
        for (int h = 0; h < 2; h++) {
            double spacing = h ? 1.7 : 1;
            check_relative (share (frame, 2, spacing, "", m, "right", "left", 5), 1, 1e-12);
            check_relative (share (frame, 2, spacing, "", m, "plate.right", "left", 5), 1, 1e-12);
            check_relative (share (frame, 2, spacing, "", m, "slot.left", "left", 1), 1, 1e-12);
            check_relative (share (frame, 2, spacing, "", m, "slot.top", "left", 7), 1, 1e-12);
        }
}

/* ---- points, stairs, units ----------------------------------------------------------------------------- */
/* Points of a side lie in its plane; stairs are sides where the body is flat, and there alone. */
static void sides_hold_points_of_their_plane (void **state)
{
    (void) state;
    static const char *const cells[] = { "cut", "staircase" };
    for (int c = 0; c < 2; c++)
        for (double unit = 1e-9; unit < 2e3; unit *= 1e6) {
            run r = scene_of (1,
                              "dimension: 2\nbody: [{add: {polygon: {vertices: [[0, 0], [%.17g, 0], [%.17g, "
                              "%.17g], [0, %.17g]]}}}]\nspacing: %.17g\ncells: %s\n" ROCK,
                              16 * unit, 16 * unit, 10 * unit, 20 * unit, unit, cells[c], "0.2");
            const pg_set *right = pg_sets_find (&r.problem->sets, "right"),
                         *bottom = pg_sets_find (&r.problem->sets, "bottom");
            assert_int_equal (right->npoint, 11);
            assert_int_equal (right->nfacet, 10);
            assert_int_equal (bottom->npoint, 17);
            for (size_t k = 0; k < right->npoint; k++)
                check_relative (r.problem->cloud.x[2 * right->point[k]], 16 * unit, 1e-14);
            assert_int_equal (pg_sets_find (&r.problem->sets, "top")->npoint, 0);
            clear (&r);
        }
}

static void must_say (const char *body, const char *rest, const char *part)
{
    char text[2048];
    pg_scene *scene;
    pg_problem *problem = NULL;
    snprintf (text, sizeof text, "dimension: 2\n%sspacing: 4 mm\n" ROCK "%s", body, "0.2", rest);
    check_ok (pg_scene_parse (&scene, text, "test.yaml"));
    check_fails (pg_problem_build (&problem, scene, 1), PG_E_SCENE);
    check_contains (pg_last_error (), part);
    pg_problem_free (&problem);
    pg_scene_free (&scene);
}

static void a_side_that_is_only_touched_says_what_to_name (void **state)
{
    (void) state;
    static const char *const
        disk = "body: [{add: {disk: {center: [0, 0], diameter: 100 mm}}}]\n",
        *const stairs = "body: [{add: {disk: {center: [0, 0], diameter: 100 mm}}}]\ncells: staircase\n";
    static const char *const why = "= top: top is the part of the surface in the plane y = 0.05 m of the "
                                   "bounding box, where the body has no face";
    must_say (disk, "boundary: [{set: top, displacement: {y: 0}}]\n", why);
    must_say (stairs, "boundary: [{set: top, traction: {y: 1 MPa}}]\n", why);
    must_say (disk, "failure: {criterion: stretch, critical_stretch: 1, exclude: [top]}\n",
              "failure.exclude[0] = top: top is the part");
    must_say (disk, "sets: {a: {boundary: [rim, left]}}\n",
              "sets.a.boundary: left is the part of the surface in the plane x = -0.05 m");
    must_say (disk, "boundary: [{set: top, displacement: {y: 0}}]\n", "angle: [[80 deg, 100 deg]]");
    must_say (disk, "boundary: [{set: top, displacement: {y: 0}}]\n", "(here: disk.rim)");
    must_say (disk, "boundary: [{set: disk.left, displacement: {y: 0}}]\n", "there is no set of this name");
    must_say (disk, "sets: {a: {boundary: disk.edge 1}}\n", "no boundary is called 'disk.edge 1'");
    must_say ("body: [{add: {polygon: {vertices: [[0, 0], [50 mm, 0], [0, 50 mm]]}}}]\n",
              "sets: {a: {boundary: polygon.edge 4}}\n", "parts of shapes: polygon.edge 1 ...");
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (a_traction_on_the_side_of_a_trapezoid_has_its_total),
        cmocka_unit_test (curved_parts_have_their_total),
        cmocka_unit_test (parts_of_boxes_are_what_is_left_of_them),
        cmocka_unit_test (sides_hold_points_of_their_plane),
        cmocka_unit_test (a_side_that_is_only_touched_says_what_to_name),
    };
    return cmocka_run_group_tests_name ("scene_runs/sides", tests, NULL, NULL);
}
