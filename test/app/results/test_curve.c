/* SPDX-License-Identifier: GPL-3.0-or-later
 * The load-displacement curve of a run: its sign, where it begins, unloading, the peak and the stiffness in
 * report.json and in words; the crack that broken bonds amount to. */
#include "folder.h"
#include "io/picture/fonts.h"
#include <cairo.h>

#define PLATE \
    "dimension: 2\nthickness: 0.1\nbody: [{add: {box: {low: [0, 0], high: [1, 1]}}}]\nspacing: 0.1\n" \
    "materials: {rock: {youngs_modulus: 1 GPa, poissons_ratio: 0.2}}\n" \
    "output: {pictures: [damage], estimate: " \
    "off, at: {levels: 1}, gauges: [{name: mouth, from: [0.5, 0.2], to: [0.5, 0.8]}]}\n"

#define MOVING \
    "dimension: 2\nthickness: 0.1\nbody: [{add: {box: {low: [0, 0], high: [1, 1]}}}]\nspacing: 0.25\n" \
    "materials: {rock: {youngs_modulus: 1 GPa, poissons_ratio: 0.2, density: 1000}}\n" \
    "output: {pictures: [], estimate: off}\n"

static char where[64], *report, *history, words[3][400];

static void play (const char *format, const char *more)
{
    run r = scene_of (1, "%s%s", format, more);
    pg_result *result = NULL;
    make_folder (where);
    check_ok (pg_result_open (&result, where, r.scene, r.problem, r.solver));
    while (!pg_solver_done (r.solver, r.state)) {
        advance (&r);
        check_ok (pg_result_step (result, r.state, &r.step));
    }
    check_ok (pg_result_finish (result, r.state, NULL, 0, 0));
    for (size_t k = 0; k < 3; k++)
        if (!pg_result_words (result, k, words[k], sizeof words[k])) words[k][0] = 0;
    report = slurp (inside (where, "report.json")), history = slurp (inside (where, "history.csv"));
    pg_result_free (&result);
    clear (&r);
}

static void tidy (void)
{
    pg_free (report), pg_free (history);
    remove_folder (where);
}

/* Pixels of the curve's colour in the upper right corner of the chart (0, 0 when all is negative) and in the
 * lower left one. */
static void corners (size_t *upper, size_t *lower)
{
    cairo_surface_t *s = cairo_image_surface_create_from_png (inside (where, "load_displacement.png"));
    assert_int_equal (cairo_surface_status (s), CAIRO_STATUS_SUCCESS);
    int w = cairo_image_surface_get_width (s), h = cairo_image_surface_get_height (s);
    size_t all = 0;
    *upper = *lower = 0;
    for (int y = 0; y < h; y++)
        for (int x = 0; x < w; x++) {
            unsigned p;
            memcpy (&p, cairo_image_surface_get_data (s) + y * cairo_image_surface_get_stride (s) + 4 * x, 4);
            if (abs ((int) (p >> 16 & 255) - 0x12) > 2 || abs ((int) (p >> 8 & 255) - 0x4a) > 2
                || abs ((int) (p & 255) - 0x99) > 2)
                continue;
            all++, *upper += x > w - 100 && y < 125, *lower += x < 200 && y > h - 160;
        }
    assert_true (all > 500);
    cairo_surface_destroy (s);
}

/* Pushed down, the force on the body points down: the line runs from the origin at the upper right to the
 * lower left, and the ring with it. */
static void a_push_is_negative (void **state)
{
    (void) state;
    size_t upper, lower;
    for (int pull = 0; pull < 2; pull++) {
        char more[300];
        snprintf (more, sizeof more,
                  "boundary: [{name: foot, set: bottom, displacement: {x: 0, y: 0}}, {name: head, set: top, "
                  "displacement: {y: %d mm}}]\n"
                  "solver: {kind: static, stepping: fixed, steps: 4}\n",
                  pull ? 1 : -1);
        play (PLATE, more);
        double force = json_number (report, "peak", "force"),
               place = json_number (report, "peak", "displacement");
        assert_true (pull ? force > 0 && place > 0 : force < 0 && place < 0);
        check_relative (force, number_at (history, 4, "head.force_y [N]"), 1e-15);
        check_relative (place, number_at (history, 4, "head.displacement_y [m]"), 1e-15);
        check_relative (json_number (report, "gauges", "mouth"), number_at (history, 4, "mouth [m]"), 1e-15);
        check_relative (json_number (report, "peak", "step"), 4, 0);
        check_relative (json_number (report, "peak", "load_factor"), 1, 1e-15);
        check_relative (json_number (report, "curve", "stiffness_initial"), force / place, 1e-9);
        check_relative (json_number (report, "curve", "stiffness_at_peak"), force / place, 1e-14);
        assert_null (strstr (report, "new_crack"));
        check_contains (words[0], pull ? "peak load: 1" : "peak load: -1");
        check_contains (words[0], "mouth");
        check_contains (words[1], "secant stiffness");
        corners (&upper, &lower);                      /* the origin; beyond the other end the axes go on */
        assert_true ((pull ? lower : upper) > 20);
        tidy ();
    }
}

/* A traction whose first component is given as zero: the curve follows the one that pulls. */
static void the_axis_that_pulls_is_drawn (void **state)
{
    (void) state;
    play (PLATE, "boundary: [{name: foot, set: bottom, displacement: {x: 0, y: 0}}, {name: head, set: top, "
                 "traction: {x: 0, y: 1 MPa}}]\nsolver: {kind: static, stepping: fixed, steps: 2}\n");
    assert_true (json_number (report, "peak", "force") > 0);
    check_relative (json_number (report, "peak", "force"), number_at (history, 2, "head.force_y [N]"), 1e-15);
    tidy ();
}

/* A support that is moved by a velocity beside one that is displaced: the curve is that of the displacement,
 * whichever is named first, however fast the other one is; alone the velocity has it. */
static void a_displacement_is_preferred_to_a_velocity (void **state)
{
    (void) state;
    static const char *const moves[] = {
        "{name: fast, set: right, velocity: {x: 2 m/s}}, {name: head, set: top, displacement: {y: 1 um}}",
        "{name: head, set: top, displacement: {y: -1 um}}, {name: fast, set: right, velocity: {x: 2 m/s}}",
        "{name: fast, set: right, velocity: {x: 2 m/s}}",
    };
    for (int i = 0; i < 3; i++) {
        char more[500];
        snprintf (more, sizeof more, "lattice: cells\nboundary: [{name: foot, set: bottom, displacement: "
                  "{x: 0, y: 0}}, %s]\n"
                  "solver: {kind: newmark, dt: 1 us, end: 4 us}\n", moves[i]);
        play (MOVING, more);
        check_contains (words[0], i < 2 ? "of head" : "of fast");
        tidy ();
    }
}

/* A cycle: the curve comes back, and the peak is on its way. */
/* Of a body that is confined and then pressed the press is drawn, whichever load is named first; of platens
 * also one that moves in a later stage alone. */
static void the_load_that_comes_last_is_drawn (void **state)
{
    (void) state;
    static const char *const loads[] = {
        "{name: side, set: right, pressure: 1 MPa}, {name: press, set: top, pressure: 2 MPa}]\n"
        "stages: [{name: confine, boundary: {side: 1}}, {name: press, boundary: {press: 1}}]\n",
        "{name: side, set: right, pressure: 1 MPa, ramp: constant}, {name: press, set: top, pressure: 2 MPa}"
        "]\n",
        "{name: side, set: right, pressure: 1 MPa}]\nplatens: [{name: press, point: [0, 1], normal: [0, -1], "
        "displacement: {y: -1 mm}}]\n"
        "stages: [{name: confine, boundary: {side: 1}}, {name: press, boundary: {press: 1}}]\n",
    };
    for (size_t i = 0; i < sizeof loads / sizeof *loads; i++) {
        char more[900];
        snprintf (more, sizeof more, "lattice: cells\nboundary: [{name: foot, set: bottom, displacement: "
                  "{x: 0, y: 0}}, %ssolver: {kind: static, stepping: fixed, steps: 2}\n", loads[i]);
        play (PLATE, more);
        check_contains (words[0], "force of press along y");
        tidy ();
    }
}

/* A traction that bends, or one that pulls obliquely, does work that the mean displacement along one axis
 * does not tell: no stiffness is printed. One along an axis, alike at all points, has one. */
static void only_a_load_with_a_conjugate_displacement_has_a_stiffness (void **state)
{
    (void) state;
    static const char *const loads[] = { "{y: 1 MPa}", "{y: \"10 MPa * x / 1 m\"}",
                                         "{x: 0.7 MPa, y: 0.7 MPa}" };
    for (int i = 0; i < 3; i++) {
        char more[300];
        snprintf (more, sizeof more,
                  "boundary: [{set: bottom, displacement: {x: 0, y: 0}}, {name: head, set: top, "
                  "traction: %s}]\nsolver: {kind: static, stepping: fixed, steps: 2}\n", loads[i]);
        play (PLATE, more);
        check_contains (words[0], "peak load");
        if (i == 0) check_contains (words[1], "secant stiffness");
        else {
            check_contains (report, "\"stiffness_initial\": null");
            assert_string_equal (words[1], "");
        }
        tidy ();
    }
}

static void unloading_is_drawn_and_a_constant_load_has_no_origin (void **state)
{
    (void) state;
    size_t upper, lower;
    static const char ends[] =
        "boundary: [{name: foot, set: bottom, displacement: {x: 0, y: 0}}, {name: head, set: top, "
        "displacement: {y: 1 mm}, table: [[0, 0], [0.5, 1], [1, 0.2]]}";
    char more[400];
    snprintf (more, sizeof more, "%s]\nsolver: {kind: static, stepping: fixed, steps: 10}\n", ends);
    play (PLATE, more);
    check_relative (json_number (report, "peak", "step"), 5, 0);
    check_relative (json_number (report, "peak", "force"), number_at (history, 5, "head.force_y [N]"), 1e-15);
    check_relative (json_number (report, "curve", "stiffness_initial"),
                    json_number (report, "curve", "stiffness_at_peak"), 1e-9);
    corners (&upper, &lower);
    assert_true (lower > 20);
    tidy ();
    snprintf (more, sizeof more,
              "%s, {set: all, body_force: {y: -1 kN/m3}, ramp: 1}]\nsolver: {kind: static, stepping: fixed, "
              "steps: 10}\n",
              ends);
    play (PLATE, more);
    check_contains (report, "\"stiffness_initial\": null");
    assert_string_equal (words[1], "");
    tidy ();
}

/* Event stepping: the largest force of all rows is the peak, and the secant there is no larger than the
 * first: bonds of bond-type forces take with them what they bear (shape functions that lose a bond share its
 * part out anew, and a single component may stiffen by a percent). */
static void the_peak_of_events_is_that_of_the_history (void **state)
{
    (void) state;
    play (PLATE,
          "method: {force: bond}\ncracks: [{from: [-0.1, 0.55], to: [0.35, 0.55]}]\nfailure: {criterion: "
          "stretch, critical_stretch: 1e-3, exclude: [bottom, top]}\n"
          "boundary: [{name: foot, set: bottom, displacement: {x: 0, y: 0}}, {name: head, set: top, "
          "displacement: {y: 0, x: 3 mm}}]\n"
          "solver: {kind: static, stepping: event, max_events: 30, break: fraction, break_fraction: 5 %}\n");
    double most = 0, force = json_number (report, "peak", "force");
    for (size_t k = 1; k < count_lines (history); k++)
        most = fmax (most, fabs (number_at (history, k, "head.force_x [N]")));
    check_relative (fabs (force), most, 1e-15);
    size_t step = (size_t) json_number (report, "peak", "step");
    check_relative (force, number_at (history, step, "head.force_x [N]"), 1e-15);
    check_below (json_number (report, "curve", "stiffness_at_peak"),
                 json_number (report, "curve", "stiffness_initial") * (1 + 1e-9));
    check_relative (json_number (report, "curve", "stiffness_initial"),
                    number_at (history, 1, "head.force_x [N]")
                        / number_at (history, 1, "head.displacement_x [m]"),
                    1e-12);
    double area = json_number (report, "new_crack", "area");
    assert_true (area > 0);
    check_relative (json_number (report, "new_crack", "length"), area / 0.1, 1e-14);
    check_relative (json_number (report, "new_crack", "dissipated_per_area"),
                    json_number (report, "energy", "dissipated") / area, 1e-12);
    check_contains (words[2], "an estimate");
    tidy ();
}

/* ---- cracks -------------------------------------------------------------------------------------------- */
/* All bonds that cross a plane through the middle of the body, given by its angle about z, are dead: the
 * estimate is the plane's area. */
static double estimate_of (const char *scene, double angle)
{
    run r = scene_of (1, "%soutput: {pictures: [], estimate: off}\n", scene);
    const pg_problem *p = r.problem;
    pg_result *result = NULL;
    void *self;
    make_folder (where);
    check_ok (pg_result_open (&result, where, r.scene, r.problem, r.solver));
    for (int set = 0; set < PG_BOND_SETS; set++)
        for (size_t i = 0; i < p->bonds.rows[set].n; i++)
            for (size_t b = p->bonds.rows[set].family.start[i]; b < p->bonds.rows[set].family.start[i + 1];
                 b++) {
                const double *a = p->bonds.rows[set].x + i * (size_t) p->dim,
                             *c = p->cloud.x + (size_t) p->bonds.rows[set].family.node[b] * (size_t) p->dim;
                double s = -sin (angle) * (a[0] - 0.501) + cos (angle) * (a[1] - 0.503),
                       e = -sin (angle) * (c[0] - 0.501) + cos (angle) * (c[1] - 0.503);
                if (s * e < 0) r.state->alive[p->bonds.first[set] + b] = 0, r.state->broken++;
            }
    check_ok (pg_solver_force (r.solver, &self)->refresh (self, r.state, NULL));
    check_ok (pg_result_finish (result, r.state, NULL, 0, 0));
    report = slurp (inside (where, "report.json"));
    double area = json_number (report, "new_crack", "area");
    pg_free (report), report = NULL;
    pg_result_free (&result);
    clear (&r);
    remove_folder (where);
    return area;
}

static void a_plane_of_broken_bonds_has_its_area (void **state)
{
    (void) state;
    static const char *const scene[] = {
        "dimension: 2\nthickness: 0.2\nbody: [{add: {box: {low: [0, 0], high: [1, 1]}}}]\nspacing: "
        "0.025\nlattice: cells\nmaterials: {m: {youngs_modulus: 1, poissons_ratio: 0.333333333333333}}\n"
        "failure: {criterion: stretch, critical_stretch: 1}\nmethod: {force: bond, horizon: 3.015 spacing}\n",
        "dimension: 2\nthickness: 0.2\nbody: [{add: {box: {low: [0, 0], high: [1, 1]}}}]\nspacing: "
        "0.025\nmaterials: {m: {youngs_modulus: 1, poissons_ratio: 0.2}}\n"
        "failure: {criterion: stretch, critical_stretch: 1}\nmethod: {integration: gauss, horizon: 2 "
        "spacing}\n",
        "dimension: 2\nthickness: 0.2\nbody: [{add: {box: {low: [0, 0], high: [1, 1]}}}]\nspacing: "
        "0.025\nmaterials: {m: {youngs_modulus: 1, poissons_ratio: 0.2}}\n"
        "failure: {criterion: stretch, critical_stretch: 1}\nmethod: {integration: nodal, horizon: 2.5 "
        "spacing}\n",
        "dimension: 3\nbody: [{add: {box: {low: [0, 0, 0], high: [1, 1, 0.2]}}}]\nspacing: 0.05\nlattice: "
        "cells\nmaterials: {m: {youngs_modulus: 1, poissons_ratio: 0.25}}\n"
        "failure: {criterion: stretch, critical_stretch: 1}\nmethod: {force: bond, horizon: 3.015 spacing}\n",
    };
    for (size_t k = 0; k < sizeof scene / sizeof *scene; k++) {
        check_relative (estimate_of (scene[k], 0), 0.2, 0.12);
        check_relative (estimate_of (scene[k], 0.55), 0.2 / cos (0.55), 0.12);
    }
}

/* Points of `lattice: cells` lie half a spacing behind the facets that conditions act on: a support moves
 * as far as is prescribed, a loaded face by the mean over its facets, so that half of force times
 * displacement is the work. */
static void displacements_are_those_of_the_facets (void **state)
{
    static const char bar[] =
        "dimension: 2\nthickness: 0.1\nbody: [{add: {box: {low: [0, 0], high: [1, 2]}}}]\nspacing: 0.1\n"
        "lattice: cells\nlattice_offset: [0.3, %s]\n"
        "materials: {a: {youngs_modulus: 50, poissons_ratio: 0}, b: {youngs_modulus: 1, poissons_ratio: 0}}\n"
        "blocks: [{material: a, where: y < 1}, {material: b, where: y >= 1}]\noutput: {pictures: [], "
        "estimate: "
        "off, at: {levels: 1}}\nboundary: [{set: bottom, displacement: {x: 0, y: 0}}, {name: head, set: "
        "top, %s}]\n";
    static const char *const head[] = { "displacement: {y: 0.02}",
                                        "displacement: {y: 0.02}, essential: penalty",
                                        "traction: {y: 0.02}" };
    char text[1024];
    (void) state;
    for (int k = 0; k < 3; k++)
        for (int shift = 0; shift < 2; shift++) {
            snprintf (text, sizeof text, bar, shift ? "0.4" : "0", head[k]);
            play (text, "");
            double u = number_at (history, 1, "head.displacement_y [m]"), f = number_at (history, 1,
                "head.force_y [N]"),
                   work = json_number (report, "energy", "external");
            print_message ("u %.6g, F u / 2 over the work %.8f\n", u, 0.5 * f * u / work);
            if (k < 2) check_relative (u, 0.02, 1e-12);
            check_relative (0.5 * f * u, work, k == 2 ? 1e-4 : 1e-9);
            tidy ();
        }
}

/* A beam bent by a force: the crack comes so near to where the force acts that no ring fits. The run ends
 * there and says so, where its load went up to full load on an elastic body, which was the peak. */
static void the_peak_is_one_of_judged_rows (void **state)
{
    (void) state;
    play ("dimension: 2\nplane: strain\nthickness: 1\nbody: [{add: {box: {low: [-40, 0], high: [40, 20]}}}]\n"
          "spacing: 1\nlattice: cells\ncracks: [{from: [0, 0], to: [0, 4]}]\n"
          "materials: {m: {youngs_modulus: 20800, poissons_ratio: 0.3}}\n"
          "failure: {criterion: energy_release, fracture_energy: 0.5}\n"
          "sets: {l: {where: x < -38.8 and y < 1.2}, r: {where: x > 38.8 and y < 1.2}}\n"
          "boundary: [{name: l, set: l, displacement: {x: 0, y: 0}}, {name: r, set: r, displacement: {y: "
          "0}},\n"
          "  {name: p, at: [0, 19.5], force: {y: -400}}]\noutput: {pictures: [], estimate: off}\n", "");
    double peak = json_number (report, "peak", "force"), largest = 0, factor = json_number (report,
        "peak", "load_factor");
    long rows = -1;
    for (const char *s = history; *s; s++) rows += *s == '\n';
    for (long i = 1; i <= rows; i++) largest = fmax (largest, fabs (number_at (history, (size_t) i,
        "p.force_y [N]")));
    print_message ("peak %.6g at load factor %.4g, %ld rows, largest force %.6g\n", peak, factor, rows,
        largest);
    check_relative (-peak, largest, 1e-12);
    check_below (factor, 0.9);
    assert_non_null (strstr (report, "\"ended_by\": \"the measure of a crack tip ended\""));
    assert_non_null (strstr (report, "has no ring any more: the load p is"));
    tidy ();
}

/* A strength that the spacing does not resolve: the one in use stands beside it, sqrt (E G0 / 8 h), in the
 * report and in a warning with the spacing that it needs. */
static void the_strength_in_use_is_told (void **state)
{
    (void) state;
    play ("dimension: 2\nthickness: 1\nbody: [{add: {box: {low: [0, 0], high: [10, 4]}}}]\nspacing: 1\n"
          "materials: {m: {youngs_modulus: 3200, poissons_ratio: 0}}\n"
          "failure: {criterion: energy_release, fracture_energy: 0.25, tensile_strength: 20}\n"
          "boundary: [{set: left, displacement: {x: 0, y: 0}}, {set: right, displacement: {x: 0.001}}]\n"
          "output: {pictures: [], estimate: off, at: {levels: 1}}\n", "");
    check_relative (json_number (report, "m", "asked"), 20, 1e-12);
    check_relative (json_number (report, "m", "in_use"), 10, 1e-12);
    check_relative (json_number (report, "m", "spacing_needed"), 0.25, 1e-12);
    assert_non_null (strstr (report, "of its strength of 20 Pa only 10 Pa are in use"));
    tidy ();
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (displacements_are_those_of_the_facets),
        cmocka_unit_test (the_peak_is_one_of_judged_rows),
        cmocka_unit_test (the_strength_in_use_is_told),
        cmocka_unit_test (a_push_is_negative),
        cmocka_unit_test (the_axis_that_pulls_is_drawn),
        cmocka_unit_test (the_load_that_comes_last_is_drawn),
        cmocka_unit_test (a_displacement_is_preferred_to_a_velocity),
        cmocka_unit_test (only_a_load_with_a_conjugate_displacement_has_a_stiffness),
        cmocka_unit_test (unloading_is_drawn_and_a_constant_load_has_no_origin),
        cmocka_unit_test (the_peak_of_events_is_that_of_the_history),
        cmocka_unit_test (a_plane_of_broken_bonds_has_its_area),
    };
    return cmocka_run_group_tests_name ("app/results/curve", tests, NULL, NULL);
}
