/* SPDX-License-Identifier: GPL-3.0-or-later
 * A crack inclined to the load under a constant confinement and a growing pull: load of first growth and
 * direction in closed form. Unstable growth of facets at a held load, and in motion. */
#include "run.h"
#include "solve/tape.h"

/* A plate of 1.2 m x 1.2 m with a crack of 2 a = 0.2 m in its middle, off the lattice, at `angle` (rad) to
 * the x axis, pulled along y by up to `pull`, pressed along x by `pressure` (Pa) throughout. */
static run plate (double angle, double pull, double pressure)
{
    double c = 0.1 * cos (angle), s = 0.1 * sin (angle);
    return scene_of (
        1,
        "dimension: 2\nplane: stress\nthickness: 1 m\nbody: [{add: {box: {low: [-0.6, -0.6], high: [0.6, "
        "0.6]}}}]\nspacing: 0.01\nlattice: cells\ncracks: [{from: [%.17g, %.17g], to: [%.17g, %.17g]}]\n"
        "materials: {glass: {youngs_modulus: 70 GPa, poissons_ratio: 0.22}}\n"
        "failure: {criterion: energy_release, fracture_energy: 8 J/m2}\n"
        "sets: {pin: {where: 'hypot (x - 0.59, y) < 0.011'}}\nboundary:\n"
        "  - {name: top, set: top, traction: {y: %.17g}}\n"
        "  - {name: bottom, set: bottom, traction: {y: %.17g}}\n"
        "  - {name: left, set: left, traction: {x: %.17g}, ramp: constant}\n"
        "  - {name: right, set: right, traction: {x: %.17g}, ramp: constant}\n"
        "  - {name: pin, set: pin, displacement: {x: 0, y: 0}, essential: penalty}\n"
        "solver: {stepping: event, max_events: 1}\noutput: {at: {levels: 1}}\n",
        0.0037 - c, 0.0021 - s, 0.0037 + c, 0.0021 + s, pull, -pull, pressure, -pressure);
}

/* Largest hoop stress around the tip, in terms of K, at a load factor: normal stress -p sin^2 + s cos^2 and
 * shear (s + p) sin cos on the crack make K_I and K_II = F sqrt (pi a) times them; F = 1.039 of a square
 * plate with a / W = 1/6 under a stress across the crack (Isida 1971, Int. J. Fract. Mech. 7, 301-316). */
static double hoop (double angle, double pull, double pressure, double factor)
{
    double c = cos (angle), s = sin (angle), F = 1.039 * sqrt (acos (-1) * 0.1), most = 0;
    double K_I = F * (factor * pull * c * c - pressure * s * s),
           K_II = F * (factor * pull + pressure) * s * c;
    for (int k = -1700; k <= 1700; k++) {
        double t = k / 1000.0, h = cos (t / 2);
        most = fmax (most, h * (K_I * h * h - 1.5 * K_II * sin (t)));
    }
    return most;
}

/* PERIGAL_TEST_SIZE=long: in three cases, else in the last. */
static void growth_begins_at_the_load_of_the_closed_form (void **state)
{
    (void) state;
    double toughness = sqrt (70e9 * 8), pull = 2 * toughness / sqrt (acos (-1) * 0.1), pi = acos (-1);
    static const struct { double angle, pressure;
    } cases[] = { { 45, 0 }, { 45, 0.15 }, { 30, 0.25 } };
    for (int k = longer () ? 0 : 2; k < 3; k++) {
        double angle = cases[k].angle * pi / 180, pressure = cases[k].pressure * pull, low = 0, high = 1;
        for (int i = 0; i < 60; i++) {
            double middle = 0.5 * (low + high);
            if (hoop (angle, pull, pressure, middle) > toughness) high = middle;
            else low = middle;
        }
        run r = plate (angle, pull, pressure);
        while (!r.step.event) {
            assert_false (pg_solver_done (r.solver, r.state));
            advance (&r);
        }
        if (fabs (r.state->factor / low - 1) > 0.02) print_error ("case %d\n", k);
        check_relative (r.state->factor, low, 0.02);
        check_relative (r.step.utilisation, 1, 1e-9);
        clear (&r);
    }
}

/* ---- unstable ------------------------------------------------------------------------------------------ */
/* A strip under forces at its left end, which open its crack: the longer, the less it bears. */
static run opened (const char *solver)
{
    return scene_of (1,
                     "dimension: 2\nplane: stress\nthickness: 1 m\nbody: [{add: {box: {low: [0, -0.5], "
                     "high: [2, 0.5]}}}]\nspacing: 0.0666666666666\nlattice: cells\ncracks: [{from: [-0.1, "
                     "0.014], to: [0.7, 0.014]}]\nmaterials: {m: {youngs_modulus: 10 GPa, poissons_ratio: "
                     "0.33, density: 2500 kg/m3}}\nfailure: {criterion: energy_release, fracture_energy: 100 "
                     "J/m2, path: [[0, 0.014], [2, 0.014]]}\nsets: {up: {where: 'x < 0.07 and y > "
                     "0.43'}, down: {where: 'x < 0.07 and y < -0.43'}}\nboundary:\n  - {set: right, "
                     "displacement: {x: 0, y: 0}}\n  - {set: up, force: {y: 2 MN}}\n"
                     "  - {set: down, force: {y: -2 MN}}\nsolver: {stepping: event, %s}\n"
                     "output: {at: {levels: 1}}\n",
                     solver);
}

/* Under forces growth does not stop at the load at which it begins: at a held load the crack runs, and every
 * step of it is one at that load. */
static void facets_run_at_a_held_load (void **state)
{
    (void) state;
    run a = opened ("on_instability: follow, max_events: 6"),
        b = opened ("on_instability: hold, max_events: 6");
    double first = 0;
    for (int k = 0; k < 6; k++) {
        double before = a.state->factor;
        advance (&a), advance (&b);
        assert_true (a.step.event && b.step.event);
        if (k == 0) first = a.state->factor;
        else assert_true (a.state->factor < before);
        assert_true (b.state->factor == first);
        assert_true (b.step.instability == (k > 0));
        if (k == 1) assert_true (b.step.utilisation > 1.001);
        assert_true (a.state->paths->length == b.state->paths->length);
    }
    assert_int_equal (pg_solver_report_now (b.solver)->unstable.count, 1);
    assert_int_equal (pg_solver_report_now (b.solver)->unstable.steps, 5);
    clear (&a), clear (&b);
}

/* In motion the crack is slower than the Rayleigh wave (1139 m/s), reactions go on smoothly, and a run that
 * is resumed in its middle goes on bit by bit. */
static void facets_run_in_motion (void **state)
{
    (void) state;
    static const char *const dynamic = "on_instability: dynamic, motion: {quiet: 2 ms}";
    run a = opened (dynamic), b = opened (dynamic);
    tape t = { 0 };
    while (!(a.step.motion > 0)) advance (&a);
    check_below (pg_solver_report_now (a.solver)->unstable.jump, 1e-8);
    double began = a.step.motion, length = a.state->paths->length;
    for (int k = 0; k < 30; k++) advance (&a);
    keep (&a, &t, 0);
    keep (&b, &t, 1);
    assert_int_equal (t.at, t.n);
    for (int k = 0; k < 60 && !pg_solver_done (a.solver, a.state); k++) {
        advance (&a), advance (&b);
        assert_true (a.state->factor == b.state->factor && a.step.nbroken == b.step.nbroken);
        assert_memory_equal (a.state->d, b.state->d, a.state->ndof * sizeof *a.state->d);
    }
    double speed = (a.state->paths->length - length - 0.067) / (a.step.motion - began);
    assert_true (a.state->paths->length > length);
    check_below (speed, 1139);
    pg_free (t.byte);
    clear (&a), clear (&b);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (growth_begins_at_the_load_of_the_closed_form),
        cmocka_unit_test (facets_run_at_a_held_load),
        cmocka_unit_test (facets_run_in_motion),
    };
    return cmocka_run_group_tests_name ("scene_runs/confined_crack", tests, NULL, NULL);
}
