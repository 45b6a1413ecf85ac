/* SPDX-License-Identifier: GPL-3.0-or-later
 * An intact plate with a hole: the same answer in other units, places, orientations, orders of points and
 * numbers of threads. Rounding: places enter as differences, and a shift by s (here 1000 times the plate,
 * 16000 spacings) leaves a relative error of eps s / h = 4e-12 in them; N, dN and the answer follow with a
 * factor: allowed are 300, seen is about 1. So 1e-10 holds up to shifts of some 1e4 sizes; no code can do
 * better that stores absolute places. */
#include <unistd.h>
#include "view.h"

typedef struct { const char *approximation, *integration, *essential, *basis; } method;
static const method methods[] = {
    { "rkpm", "gauss", "nitsche", "linear" },
    { "rkpm", "gauss", "transformation", "linear" },
    { "rkpm", "gauss", "penalty", "linear" },
    { "rkpm", "gauss", "nitsche", "quadratic" },
    { "pddo", "gauss", "nitsche", "linear" },
    { "nosb", "nodal", "transformation", "linear" },
    { "rkpm", "consistent", "nitsche", "linear" },
    { "rkpm, force: bond", "nodal", "auto", "linear" },
    { "rkpm, force: bond, evaluation: list, surface_correction: volume", "nodal", "auto", "linear" },
    { "rkpm, force: gmpd", "nodal", "auto", "linear" },
    { "rkpm, force: gmpd, evaluation: list", "nodal", "auto", "linear" },
};
enum { METHODS = sizeof methods / sizeof *methods };

/* 1 m x 0.75 m with a hole, spacing 1/16 m, held at one edge, traction on the opposite one */
static run plate (const view *v, const method *m)
{
    char box[200];
    double hole[2];
    seen (v, (double[2]) { 0.62, 0.41 }, hole);
    check_box (v, 1, 0.75, box, sizeof box);
    run r = scene_of (
        v->threads,
        "dimension: 2\nthickness: %.17g\nbody:\n  - add: {box: %s}\n"
        "  - subtract: {disk: {center: [%.17g, %.17g], radius: %.17g}}\n"
        "spacing: %.17g\nmaterials: {rock: {youngs_modulus: %.17g, poissons_ratio: 0.25}}\n"
        "method: {approximation: %s, integration: %s, essential: %s, basis: %s, horizon: %s spacing}\n"
        "boundary:\n  - {set: %s, displacement: {x: 0, y: 0}}\n  - {set: %s, traction: {x: %.17g, y: "
        "%.17g}}\n"
        "solver: {stepping: fixed, steps: 1}\noutput: {at: {levels: 1}}\n",
        0.02 * v->length, box, hole[0], hole[1], 0.1723 * v->length, v->length / 16, 10e9 * v->stress,
        m->approximation, m->integration, m->essential, m->basis, *m->basis == 'q' ? "3.01" : "2.01",
        v->sy > 0 ? "bottom" : "top", v->sy > 0 ? "top" : "bottom", 1e6 * v->stress * v->sx,
        2e6 * v->stress * v->sy);
    to_the_end (&r);
    return r;
}

static void check_view (const view *v, double tolerance)
{
    double worst = 0, worst_stress = 0;
    for (int k = 0; k < METHODS; k++) {
        run a = plate (&plain, &methods[k]), b = plate (v, &methods[k]);
        double stress, u = displacement_difference (v, &a, &b, &stress);
        worst = fmax (worst, u), worst_stress = fmax (worst_stress, stress);
        check_below (u, tolerance);
        check_below (stress, tolerance);
        clear (&a), clear (&b);
    }
    print_message ("%s: displacement %.1e, stress %.1e\n", v->name, worst, worst_stress);
}

static void millimetres_and_megapascals (void **state)
{
    (void) state, check_view (&(view) { "mm, MPa", 1000, 1e-6, 1, 1, 0, 0, 1 }, 1e-10);
}
static void mirrored_left_to_right (void **state)
{
    (void) state, check_view (&(view){ "mirrored in x", 1, 1, -1, 1, 0, 0, 1 }, 1e-10);
}
static void mirrored_top_to_bottom (void **state)
{
    (void) state, check_view (&(view){ "mirrored in y", 1, 1, 1, -1, 0, 0, 1 }, 1e-10);
}
static void rotated_by_180_degrees (void **state)
{
    (void) state, check_view (&(view){ "rotated", 1, 1, -1, -1, 0, 0, 1 }, 1e-10);
}
static void two_threads (void **state)
{
    (void) state, check_view (&(view){ "two threads", 1, 1, 1, 1, 0, 0, 2 }, 1e-12);
}

static void shifted_by_a_thousand_sizes (void **state)
{
    (void) state;
    double shift = 1000.37;
    check_view (&(view){ "shifted by 1000.37, -777.7 m", 1, 1, 1, 1, shift, -777.7, 1 },
                300 * 2.2e-16 * shift * 16);
}

/* Explicit points, moved at random: transformation on sets of points, nodal integration */
static run cloud_run (const char *path, const char *approximation)
{
    run r = scene_of (1,
                      "dimension: 2\nthickness: 0.02\npoints: %s\nmaterials: {rock: {youngs_modulus: 10 GPa, "
                      "poissons_ratio: 0.25}}\n"
                      "sets: {low: {where: 'y < 0.06 m'}, high: {where: 'y > 0.69 m'}}\n"
                      "method: {approximation: %s, integration: nodal, horizon: 0.14}\n"
                      "boundary:\n  - {set: low, displacement: {x: 0, y: 0}}\n  - {set: high, displacement: "
                      "{x: 1e-4, y: 2e-4}}\n"
                      "solver: {stepping: fixed, steps: 1}\n"
                      "output: {at: {levels: 1}}\n",
                      path, approximation);
    to_the_end (&r);
    return r;
}

static void points_in_another_order (void **state)
{
    (void) state;
    char one[] = "/tmp/perigal_points_XXXXXX", two[] = "/tmp/perigal_points_XXXXXX";
    assert_true (close (mkstemp (one)) == 0 && close (mkstemp (two)) == 0);
    write_points (one, 16, 13, 0.0625, 0.15, 0);
    write_points (two, 16, 13, 0.0625, 0.15, 99);
    static const char *const names[] = { "nosb", "pddo", "rkpm", "rkpm, force: bond", "rkpm, force: gmpd" };
    for (int k = 0; k < 5; k++) {
        run a = cloud_run (one, names[k]), b = cloud_run (two, names[k]);
        double stress, u = displacement_difference (&plain, &a, &b, &stress);
        print_message ("%s, shuffled: displacement %.1e, stress %.1e\n", names[k], u, stress);
        check_below (u, 1e-10);
        check_below (stress, 1e-10);
        clear (&a), clear (&b);
    }
    unlink (one), unlink (two);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (millimetres_and_megapascals),
        cmocka_unit_test (mirrored_left_to_right),
        cmocka_unit_test (mirrored_top_to_bottom),
        cmocka_unit_test (rotated_by_180_degrees),
        cmocka_unit_test (two_threads),
        cmocka_unit_test (shifted_by_a_thousand_sizes),
        cmocka_unit_test (points_in_another_order),
    };
    return cmocka_run_group_tests_name ("scene_runs/invariance", tests, NULL, NULL);
}
