/* SPDX-License-Identifier: GPL-3.0-or-later
 * A pressure on the faces of cracks opens them as a tension of that size on the body does, for both differ
 * by a uniform stress across the crack: the same K_I and T. It follows the faces that come into being. */
#include "first_tip.h"

#define TENSION "{set: top, traction: {y: 2}}, {set: bottom, traction: {y: -2}}"
#define PRESSURE "{set: cracks, pressure: 2}"

/* Single edge notch of a plate 40 spacings wide and 3 times as high, half its width deep. */
static run notch (double unit, const char *loads, const char *more)
{
    double h = unit / 40;
    return scene_of (
        1,
        "dimension: 2\nplane: stress\nthickness: 0.3\nbody: [{add: {box: {low: [0, %.17g], high: "
        "[%.17g, %.17g]}}}]\nspacing: %.17g\nlattice: cells\nlattice_offset: [0.25, 0.1]\n"
        "cracks: [{from: [%.17g, 0], to: [%.17g, 0]}]\n"
        "materials: {m: {youngs_modulus: 7, poissons_ratio: 0.3}}\n"
        "sets: {pin: {where: x > %.17g and abs(y) < %.17g}}\n"
        "boundary: [%s, {set: pin, displacement: {x: 0, y: 0}, essential: penalty}]\n%s",
        h * 40 * -1.5, unit, 1.5 * unit, h, -0.1 * unit, 0.5 * unit, unit - 1.01 * h, 1.01 * h, loads, more);
}

static pg_tip_field opened (double unit, const char *loads)
{
    run r = notch (unit, loads, "solver: {kind: static}\noutput: {at: {levels: 1}}\n");
    to_the_end (&r);
    pg_tip_field f = first_tip (&r);
    const pg_statistics *now = pg_solver_report_now (r.solver);
    check_relative (now->energy.external, now->energy.strain, 1e-9);
    clear (&r);
    return f;
}

static void as_a_tension_does (void **state)
{
    (void) state;
    for (int k = 0; k < 2; k++) {
        double unit = k ? 1e-3 : 1, one = 1;
        pg_tip_field a = opened (unit, TENSION), b = opened (unit, PRESSURE);
        check_relative (sqrt (b.J[0][0] / a.J[0][0]), 1, 0.002);
        check_relative (b.K_wide[0][0], a.K_wide[0][0], 0.002);
        check_scaled (b.K_wide[1][0], a.K_wide[1][0], 0.003, a.K[0][0]);
        check_scaled (b.T[0], a.T[0], 0.005, 2);
        check_below (pg_tip_uncertainty (&b, 1, &one), 0.02);
    }
}

/* A pressure that does not change beside a tension that does: the constant field has the pressure alone. */
static void and_in_affine_loads (void **state)
{
    (void) state;
    pg_tip_field all = opened (1, PRESSURE);
    run r = notch (1, "{set: cracks, pressure: 2, ramp: constant}, " TENSION,
                   "solver: {kind: static, steps: 1}\noutput: {at: {levels: 1}}\n");
    to_the_end (&r);
    /* both at once: J is that of the sum only if the pressure counts in full */
    pg_tip_field f = first_tip (&r);
    check_relative (f.J[0][0], 4 * all.J[0][0], 0.02);
    check_relative (f.K_wide[0][0], 2 * all.K_wide[0][0], 0.01);
    clear (&r);
}

/* Under pressure alone, on faces old and new, the crack grows where K does under tension, and takes its
 * energy. */
static void new_faces_bear_it (void **state)
{
    (void) state;
    double load[2][5];
    for (int k = 0; k < 2; k++) {
        run r = notch (1, k ? PRESSURE : TENSION,
                       "failure: {criterion: energy_release, fracture_energy: 3}\n"
                       "solver: {kind: static, max_events: 5}\noutput: {at: {levels: 1}}\n");
        for (int i = 0; i < 5; i++) advance (&r), load[k][i] = r.step.factor;
        const pg_statistics *now = pg_solver_report_now (r.solver);
        print_message ("dissipated over fracture energy times area %.4f\n",
                       now->energy.dissipated / (3 * 0.3 * r.state->paths->length));
        check_relative (now->energy.dissipated, 3 * 0.3 * r.state->paths->length, 0.04);
        check_relative (r.state->paths->length, 5.0 / 40, 1e-6);
        clear (&r);
    }
    for (int i = 0; i < 5; i++) {
        print_message ("load under tension %.5f, under pressure %.5f\n", load[0][i], load[1][i]);
        check_relative (load[1][i], load[0][i], 0.001);
    }
}

int main (void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test (as_a_tension_does),
                                        cmocka_unit_test (and_in_affine_loads),
                                        cmocka_unit_test (new_faces_bear_it) };
    return cmocka_run_group_tests_name ("crack/fracture/pressure", tests, NULL, NULL);
}
