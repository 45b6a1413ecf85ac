/* SPDX-License-Identifier: GPL-3.0-or-later
 * A crack that runs through a strip between two rigid grips held apart. What the intact strip far ahead
 * stores per length is more than the crack takes, so that it accelerates towards the speed of Rayleigh waves
 * (Marder 1991, Phys. Rev. Lett. 66, 2484-2487): what is left over has to go into waves, not into the
 * facets. */
#include "run.h"
#include <math.h>

/* 0.1 m high, 20 spacings; static until the first facet, which sets off the motion. Lengths are in `unit`. */
static run strip (int millimetres)
{
    const char *u = millimetres ? " mm" : " m";
    double s = millimetres ? 1e3 : 1;
    char text[1600];
    snprintf (text, sizeof text,
              "dimension: 2\nplane: stress\nthickness: 1 m\n"
              "body: [{add: {box: {low: [0, %g%s], high: [%g%s, %g%s]}}}]\nspacing: %g%s\nlattice: cells\n"
              "cracks: [{from: [%g%s, 0], to: [%g%s, 0]}]\n"
              "materials: {glass: {youngs_modulus: 70 GPa, poissons_ratio: 0.22, density: 2500 kg/m3}}\n"
              "failure: {criterion: energy_release, fracture_energy: 8 J/m2}\n"
              "boundary:\n  - {set: bottom, displacement: {x: 0, y: -12 um}}\n"
              "  - {set: top, displacement: {x: 0, y: 12 um}}\n"
              "solver: {kind: static, stepping: event, on_instability: dynamic, branching: off, "
              "motion: {quiet: 0.1 ms}}\noutput: {at: {levels: 1}}\n",
              -0.05 * s, u, 0.3 * s, u, 0.05 * s, u, 0.005 * s, u, -0.02 * s, u, 0.02 * s, u);
    return scene_of (1, "%s", text);
}

/* Length of the crack, m; dissipated energy, J; time in motion, s; the tip's height, m. */
typedef struct { double length, dissipated, time, at; } mark;

static mark mark_of (run *r)
{
    const pg_statistics *report = pg_solver_report_now (r->solver);
    return (mark){ r->state->paths->length, report->energy.dissipated, report->unstable.time,
                   r->state->paths->tip[0].x[1] };
}

static void until (run *r, double length)
{
    while (r->state->paths->length < length * (1 - 1e-9)) advance (r);
}

/* From the tenth facet to the thirtieth, in m and in mm. PERIGAL_TEST_SIZE=long. */
static void facets_take_what_they_may (void **state)
{
    (void) state;
    if (!longer ()) return;
    double c_R = 3064, speed[2] = { 0 };
    mark tenth[2];
    for (int k = 0; k < 2; k++) {
        run r = strip (k);
        until (&r, 0.05);
        mark a = tenth[k] = mark_of (&r);
        until (&r, 0.15);
        mark b = mark_of (&r);
        double taken = (b.dissipated - a.dissipated) / (8 * (b.length - a.length));
        speed[k] = (b.length - a.length) / (b.time - a.time) / c_R;
        print_message ("dissipated %.4f of G0, at %.4f c_R, off by %.3g m\n", taken, speed[k], b.at);
        check_absolute (taken, 1, 0.05);
        check_absolute (b.at, 0, 1e-6);
        assert_true (speed[k] > 0.68 && speed[k] < 0.9);
        clear (&r);
    }
    check_relative (tenth[1].time, tenth[0].time, 1e-6);
    check_relative (tenth[1].dissipated, tenth[0].dissipated, 1e-6);
    check_relative (speed[1], speed[0], 1e-6);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (facets_take_what_they_may),
    };
    return cmocka_run_group_tests_name ("scene_runs/running_strip", tests, NULL, NULL);
}
