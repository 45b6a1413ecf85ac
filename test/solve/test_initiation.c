/* SPDX-License-Identifier: GPL-3.0-or-later
 * Facets that are tried: what they set free is J times their area; tips beside the surface grow by it;
 * where no crack is one begins when strength and energy both suffice, at a load that does not depend on
 * the lattice, on units or on which way the body lies, and what it takes is its fracture energy. */
#include "scene_runs/run.h"

static void first_event (run *r)
{
    while (r->state->events == 0 && !pg_solver_done (r->solver, r->state)) advance (r);
}

/* ---- energy against J ---------------------------------------------------------------------------------- */
#define STRIP \
    "dimension: 2\nplane: stress\nspacing: 0.05 m\nlattice: cells\n" \
    "body: [{add: {box: {low: [0, 0], high: [3 m, 1 m]}}}]\n" \
    "materials: {glass: {youngs_modulus: 70 GPa, poissons_ratio: 0.22}}\n" \
    "boundary: [{set: bottom, displacement: {x: 0, y: 0}}, {set: top, displacement: {x: 0, y: 0.1 mm}}]\n"

static void a_facet_releases_J (void **state)
{
    (void) state;
    run r = scene_of (1, STRIP "cracks: [{from: [-0.1, 0.5], to: [1.2, 0.5]}]\n"
                               "solver: {stepping: fixed, steps: 1}\n");
    advance (&r);
    /* what the strip stores per length ahead of the tip: E/(1 - nu^2) u^2/(2 height) */
    double G = 0.5 * 70e9 / (1 - 0.22 * 0.22) * 1e-4 * 1e-4;
    void *self;
    const pg_force_type *force = pg_solver_force (r.solver, &self);
    const double *d[1] = { r.state->d }, t[1] = { 1 };
    pg_tip_field field;
    check_ok (pg_tip_measure (&field, r.problem, force, self, r.state, 0, 1, d, t, NULL, 0));
    check_relative (field.J[0][0], G, 0.01);
    pg_state *tried = NULL;
    check_ok (pg_state_create (&tried, r.problem, pg_solver_components (r.solver)));
    for (int k = 1; k <= 4; k++) {                     /* a facet of k spacings */
        double l = 0.05 * k, to[3] = { 1.2 + l, 0.5, 0 }, release[3];
        pg_changes cut = { 0 };
        check_ok (pg_state_copy (tried, r.state));
        check_ok (pg_crack_grow (tried, r.problem, 0, to, 0, &cut));
        check_ok (pg_solver_release (r.solver, r.state, 1, d, t, 1, &cut, 0, release));
        check_relative (release[0] / l, field.J[0][0], 0.01);
        pg_free (cut.bond);
    }
    pg_state_free (&tried);
    clear (&r);
}

/* ---- tips without room --------------------------------------------------------------------------------- */
/* An edge crack of 1.4 spacings: no ring fits around its tip. Its first facet, of one spacing, needs
 * int_a^(a + l) 1.1215^2 s^2 pi a/E da = G0 l. */
static void a_tip_beside_the_surface_grows_by_energy (void **state)
{
    (void) state;
    const double h = 0.05, a = 1.4 * h, G0 = 8, E = 70e9;
    run r = scene_of (1, "dimension: 2\nplane: stress\nspacing: %g m\nlattice: cells\n"
                         "body: [{add: {box: {low: [0, 0], high: [2 m, 2 m]}}}]\n"
                         "cracks: [{from: [-0.1, 1], to: [%g, 1]}]\n"
                         "materials: {glass: {youngs_modulus: %g, poissons_ratio: 0.22}}\n"
                         "sets: {pin: {where: \"hypot (x - 1.9, y - 1) < 0.06\"}}\n"
                         "boundary: [{set: bottom, traction: {y: -10 MPa}}, "
                         "{set: top, traction: {y: 10 MPa}}, "
                         "{set: pin, displacement: {x: 0, y: 0}, essential: penalty}]\n"
                         "failure: {criterion: energy_release, fracture_energy: %g}\n"
                         "solver: {max_events: 1}\n", h, a, E, G0);
    first_event (&r);
    double s = sqrt (G0 * h * E / (1.1215 * 1.1215 * acos (-1) * 0.5 * ((a + h) * (a + h) - a * a)));
    assert_int_equal (r.state->events, 1);
    check_relative (r.step.factor * 10e6, s, 0.06);
    check_relative (r.state->paths->tip[0].x[0], a + h, 1e-9);
    clear (&r);
}

/* The same crack pressed together: its faces would overlap, which also sets energy free, but it does not
 * grow. */
static void a_pressed_tip_does_not_grow (void **state)
{
    (void) state;
    run r = scene_of (1, "dimension: 2\nplane: stress\nspacing: 0.05 m\nlattice: cells\n"
                         "body: [{add: {box: {low: [0, 0], high: [2 m, 2 m]}}}]\n"
                         "cracks: [{from: [-0.1, 1], to: [0.07, 1]}]\n"
                         "materials: {glass: {youngs_modulus: 70 GPa, poissons_ratio: 0.22}}\n"
                         "sets: {pin: {where: \"hypot (x - 1.9, y - 1) < 0.06\"}}\n"
                         "boundary: [{set: bottom, traction: {y: 10 MPa}}, "
                         "{set: top, traction: {y: -10 MPa}}, "
                         "{set: pin, displacement: {x: 0, y: 0}, essential: penalty}]\n"
                         "failure: {criterion: energy_release, fracture_energy: 8}\n"
                         "solver: {max_events: 1}\n");
    to_the_end (&r);
    assert_int_equal (r.state->events, 0);
    clear (&r);
}

/* ---- new cracks ---------------------------------------------------------------------------------------- */
/* A beam on two supports, span four depths, without a notch; l_ch = E G0/f^2 is half its depth. Lengths in
 * units of `unit` m, turned by a quarter if `upright`, shifted by `shift` spacings; constant: share of the
 * load that is there from the beginning. */
static run beam (double unit, int n, int upright, double shift_x, double shift_y, double constant,
                 const char *strength)
{
    static const double outline[][2] = { { -2.2, 0 }, { 2.2, 0 }, { 2.2, 1 }, { -2.2, 1 } };
    char vertices[400] = "", loads[1600] = "";
    size_t at = 0;
    for (int k = 0; k < 4; k++) {
        double x = unit * outline[k][0], y = unit * outline[k][1];
        at += (size_t) snprintf (vertices + at, sizeof vertices - at, "%s[%.17g, %.17g]", k ? ", " : "",
                                 upright ? -y : x, upright ? x : y);
    }
    /* tractions of a cosine over the span on the upper face, of the same size on the ends: no singular
     * places */
    const double E = 70e9, G0 = 8, f = sqrt (E * G0 / (0.5 * unit)), p = 1.2 * f;
    at = 0;
    for (int part = 0; part < (constant > 0 ? 2 : 1); part++) {
        double share = constant > 0 ? (part ? 1 - constant : constant) : 1;
        const char *s = upright ? "y" : "x", *ramp = constant > 0 && !part ? ", ramp: constant" : "";
        const char *v = upright ? "x" : "y";
        double sign = upright ? 1 : -1, q = share * p;
        at += (size_t) snprintf (loads + at, sizeof loads - at,
                                 "  - {set: polygon.edge 3, traction: "
                                 "{%s: %.17g * cos (pi * %s / (%.17g m))}%s}\n",
                                 v, sign * q, s, 4.4 * unit, ramp);
        for (int e = 0; e < 2; e++)
            at += (size_t) snprintf (loads + at, sizeof loads - at,
                                     "  - {set: polygon.edge %d, traction: {%s: %.17g}%s}\n", e ? 4 : 2, v,
                                     -sign * q * 4.4 / acos (-1), ramp);
    }
    return scene_of (1, "dimension: 2\nplane: stress\nspacing: %.17g\nlattice: cells\n"
                        "lattice_offset: [%g, %g]\nbody: [{add: {polygon: {vertices: [%s]}}}]\n"
                        "materials: {glass: {youngs_modulus: 70 GPa, poissons_ratio: 0.22}}\n"
                        "sets: {pin: {where: \"hypot (x - %.17g, y - %.17g) < %.17g\"}}\n"
                        "boundary:\n%s  - {set: pin, displacement: {x: 0, y: 0}, essential: penalty}\n"
                        "failure: {criterion: energy_release, fracture_energy: 8 J/m2%s}\n"
                        "solver: {max_events: 1, stepping: event}\n",
                     unit / n, shift_x, shift_y, vertices, upright ? -unit * 0.9 : -2.1 * unit,
                     upright ? -2.1 * unit : 0.9 * unit, 1.1 * unit / n, loads, strength);
}

static const char *strength_of (double unit)
{
    static char text[80];
    snprintf (text, sizeof text, ", tensile_strength: %.17g", sqrt (70e9 * 8 / (0.5 * unit)));
    return text;
}

/* The outer fibre stress over the strength at which the crack comes into being: int_0^l K^2 = E G0 l
 * together with strength at its end, with K of pure bending (Tada, Paris, Irwin), which at these lengths
 * is that of the beam. */
static double closed_form (void)
{
    double best = INFINITY, total = 0, step = 1e-4, pi = acos (-1);
    for (double a = 0.5 * step; a < 0.4; a += step) {
        double half = pi * a / 2, l = a + 0.5 * step;
        double K = sqrt (pi * a) * sqrt (tan (half) / half) * (0.923 + 0.199 * pow (1 - sin (half), 4))
                   / cos (half);
        total += K * K * step;
        best = fmin (best, fmax (1 / (1 - 2 * l), sqrt (0.5 * l / total)));
    }
    return best;
}

static void a_beam_breaks_at_one_load_on_every_lattice (void **state)
{
    (void) state;
    static const double shift[3][2] = { { 0, 0 }, { 0.37, 0.21 }, { 0.1, -0.45 } };
    double least = INFINITY, most = 0, taken = 0;
    for (int k = 0; k < 3; k++) {
        run r = beam (0.1, 20, 0, shift[k][0], shift[k][1], 0, strength_of (0.1));
        first_event (&r);
        const pg_crack_paths *paths = r.state->paths;
        assert_int_equal (r.state->events, 1);
        assert_int_equal (paths->cracks.n, 1);
        least = fmin (least, r.step.factor), most = fmax (most, r.step.factor);
        /* its energy is that of its length, to what the place of its tip among the points is worth */
        check_relative (r.step.dissipated, 8 * paths->length, 0.13);
        taken += r.step.dissipated / (8 * paths->length) / 3;
        check_below (fabs (paths->tip[0].x[0]), 0.3 * 0.1);
        clear (&r);
    }
    check_below (most / least - 1, 0.05);
    check_relative (taken, 1, 0.05);
    /* M = 1.2 f (4.4/pi)^2 depth^2 at full load: outer fibre stress 6 M/depth^2 */
    double full = 6 * 1.2 * pow (4.4 / acos (-1), 2);
    check_relative (0.5 * (least + most) * full, closed_form (), 0.03);
}

static void units_and_axes_make_no_difference (void **state)
{
    (void) state;
    run a = beam (0.1, 20, 0, 0.37, 0.21, 0, strength_of (0.1)),
        b = beam (1e-4, 20, 0, 0.37, 0.21, 0, strength_of (1e-4));
    first_event (&a), first_event (&b);
    check_relative (b.step.factor, a.step.factor, 1e-7);
    check_relative (b.state->paths->length, 1e-3 * a.state->paths->length, 1e-6);
    clear (&b);
    /* upright: shifts turn with the body */
    b = beam (0.1, 20, 1, -0.21, 0.37, 0, strength_of (0.1));
    first_event (&b);
    check_relative (b.step.factor, a.step.factor, 1e-6);
    clear (&a), clear (&b);
}

static void a_constant_part_is_a_head_start (void **state)
{
    (void) state;
    run a = beam (0.1, 20, 0, 0.37, 0.21, 0, strength_of (0.1)),
        b = beam (0.1, 20, 0, 0.37, 0.21, 0.02, strength_of (0.1));
    first_event (&a), first_event (&b);
    /* shares of the load factor, by which hot spots are compared, are others */
    check_relative (0.02 + 0.98 * b.step.factor, a.step.factor, 1e-3);
    check_relative (b.state->paths->length, a.state->paths->length, 0.01);
    clear (&a), clear (&b);
}

static void without_a_strength_nothing_begins (void **state)
{
    (void) state;
    run r = beam (0.1, 20, 0, 0, 0, 0, "");
    to_the_end (&r);
    assert_int_equal (r.state->events, 0);
    clear (&r);
}

/* Between the strength of a point (a third of the strength) and that of a plate without the hole; on both
 * sides of a symmetric one at once. */
static void a_hole_cracks_on_both_sides (void **state)
{
    (void) state;
    const double f = sqrt (70e9 * 8 / 0.04);
    run r = scene_of (1, "dimension: 2\nplane: stress\nspacing: 4 mm\nlattice: cells\n"
                         "body: [{add: {box: {low: [-0.12, -0.12], high: [0.12, 0.12]}}}, "
                         "{subtract: {disk: {center: [0, 0], radius: 20 mm}}}]\n"
                         "materials: {glass: {youngs_modulus: 70 GPa, poissons_ratio: 0.22}}\n"
                         "sets: {pin: {where: \"hypot (x, y - 0.1) < 3 mm\"}, "
                         "left_pin: {where: \"hypot (x + 0.1, y) < 3 mm\"}, "
                         "right_pin: {where: \"hypot (x - 0.1, y) < 3 mm\"}}\n"
                         "boundary: [{set: bottom, traction: {y: -%.17g}}, {set: top, traction: {y: %.17g}}, "
                         "{set: pin, displacement: {x: 0}, essential: penalty}, "
                         "{set: left_pin, displacement: {y: 0}, essential: penalty}, "
                         "{set: right_pin, displacement: {y: 0}, essential: penalty}]\n"
                         "failure: {criterion: energy_release, fracture_energy: 8 J/m2, "
                         "tensile_strength: %.17g}\nsolver: {max_events: 1}\n", f, f, f);
    first_event (&r);
    const pg_crack_paths *paths = r.state->paths;
    assert_int_equal (r.state->events, 1);
    assert_true (r.step.factor > 1.0 / 3 && r.step.factor < 1);
    assert_int_equal (paths->ntip, 2);
    check_below (fabs (paths->tip[0].x[0] + paths->tip[1].x[0]), 0.1 * 4e-3);
    for (int k = 0; k < 2; k++) check_below (fabs (paths->tip[k].x[1]), 4e-3);
    clear (&r);
}

/* A hole of two spacings: the stress falls off within a spacing, and yet cracks begin there and not at the
 * straight sides of the plate, which reach the strength at a load factor of 0.333 only. */
static void a_small_hole_cracks_first (void **state)
{
    (void) state;
    const double strength = sqrt (70e9 * 8 / 0.04);
    run r = scene_of (1, "dimension: 2\nplane: stress\nspacing: 5 mm\nlattice: cells\n"
                         "body: [{add: {box: {low: [-0.06, -0.09], high: [0.06, 0.09]}}}, "
                         "{subtract: {disk: {center: [0, 0], radius: 10 mm}}}]\n"
                         "materials: {glass: {youngs_modulus: 70 GPa, poissons_ratio: 0.22}}\n"
                         "sets: {pin: {where: \"hypot (x + 0.055, y + 0.085) < 5.5 mm\"}}\n"
                         "boundary: [{set: bottom, traction: {y: -%.17g}}, {set: top, traction: {y: %.17g}}, "
                         "{set: pin, displacement: {x: 0, y: 0}, essential: penalty}]\n"
                         "failure: {criterion: energy_release, fracture_energy: 8 J/m2, "
                         "tensile_strength: %.17g}\nsolver: {max_events: 1}\n",
                      3 * strength, 3 * strength, strength);
    first_event (&r);
    const pg_crack_paths *paths = r.state->paths;
    assert_true (paths->ntip > 0 && r.step.factor < 0.31);
    for (size_t k = 0; k < paths->ntip; k++) {
        check_below (fabs (paths->tip[k].x[1]), 5e-3);
        check_below (fabs (paths->tip[k].x[0]), 0.03);
    }
    clear (&r);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (a_facet_releases_J),
        cmocka_unit_test (a_tip_beside_the_surface_grows_by_energy),
        cmocka_unit_test (a_pressed_tip_does_not_grow),
        cmocka_unit_test (a_beam_breaks_at_one_load_on_every_lattice),
        cmocka_unit_test (units_and_axes_make_no_difference),
        cmocka_unit_test (a_constant_part_is_a_head_start),
        cmocka_unit_test (without_a_strength_nothing_begins),
        cmocka_unit_test (a_hole_cracks_on_both_sides),
        cmocka_unit_test (a_small_hole_cracks_first),
    };
    return cmocka_run_group_tests (tests, NULL, NULL);
}
