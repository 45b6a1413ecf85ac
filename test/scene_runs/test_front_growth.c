/* SPDX-License-Identifier: GPL-3.0-or-later
 * Cracks that grow in space by their fronts, whole runs: straight fronts stay straight and take the load that
 * the energy of the body asks for, on points that lie in no layers along the front; new cracks begin at
 * notches. Discs: test_disc_growth.c. */
#include "run.h"

static const double G0 = 8, E = 70e9, NU = 0.22;

/* ---- what fronts look like ----------------------------------------------------------------------------- */
/* Mean, deviation and extremes of a coordinate over all vertices of open fronts. */
typedef struct { double mean, deviation, low, high; size_t n; } spread;

static spread of_fronts (const run *r, int axis)
{
    size_t nfront;
    const pg_front *front = pg_fronts_of_state (r->problem, r->state, &nfront);
    spread s = { .low = INFINITY, .high = -INFINITY };
    double square = 0;
    for (size_t k = 0; k < nfront; k++)
        for (size_t i = 0; front[k].open && i < front[k].n; i++) {
            double v = front[k].x[3*i + (size_t) axis];
            s.mean += v, square += v * v, s.n++;
            s.low = fmin (s.low, v), s.high = fmax (s.high, v);
        }
    if (s.n) s.mean /= (double) s.n, s.deviation = sqrt (fmax (0, square / (double) s.n - s.mean * s.mean));
    return s;
}

/* ---- a straight front ---------------------------------------------------------------------------------- */
/* A strip between clamps, H high, 1 m the spacing: far ahead of the front a displacement u stores M u^2 / (2
 * H) per area, M = E (1 - nu) / ((1 + nu) (1 - 2 nu)), and nothing behind it: that is G. constant: share of
 * it that is there at load factor 0. depth: along the front. */
static run strip (int depth, double amount, int seed, double constant, int events, int threads)
{
    const double shift = 0.31, H = 10, M = E * (1 - NU) / ((1 + NU) * (1 - 2 * NU)),
                 u = 2 * sqrt (2 * H * G0 / M);
    return scene_of (threads, "dimension: 3\nspacing: 1 m\nperturb: {amount: %g, seed: %d}\n"
                        "body: [{add: {box: {low: [0, -5, 0], high: [%d, 5, %d]}}}]\n"
                        "cracks: [{polygon: [[-0.6, %g, -0.6], [%g, %g, -0.6], [%g, %g, %g], [-0.6, %g, "
                        "%g]]}]\n"
                        "materials: {glass: {youngs_modulus: %g, poissons_ratio: %g}}\n"
                        "boundary: [{set: bottom, displacement: {x: 0, y: %.17g, z: 0}, ramp: constant}, "
                        "{set: top, displacement: {x: 0, y: %.17g, z: 0}}, "
                        "{set: back, displacement: {z: 0}}, {set: front, displacement: {z: 0}}]\n"
                        "method: {horizon: 2.01 spacing}\n"
                        "failure: {criterion: energy_release, fracture_energy: %g}\n"
                        "solver: {max_events: %d}\n", amount, seed, events > 5 ? 34 : 22, depth, shift,
                     8 + shift, shift, 8 + shift, shift, depth + 0.6, shift, depth + 0.6, E, NU,
                     -constant * u, u, G0, events);
}

/* Over so many events; the first front is drawn straight, and the load falls to its own within the first. */
static void stays_straight (int seed, int events, int depth)
{
    run r = strip (depth, 0.2, seed, 0, events, 2);
    double before = 0, spent = 0, load = 0, worst = 0;
    int event = 0;
    while (!pg_solver_done (r.solver, r.state)) {
        advance (&r);
        if (!r.step.event) continue;
        spread x = of_fronts (&r, 0), y = of_fronts (&r, 1);
        print_message ("event %d: load %.4f of G0's, x %.3f +- %.4f, y %.3f +- %.4f, energy %.3f\n", ++event,
                       2 * r.step.factor, x.mean, x.deviation, y.mean, y.deviation,
                       r.step.dissipated / (G0 * (r.state->surfaces->area - before)));
        before = r.state->surfaces->area, spent += r.step.dissipated;
        load += 2 * r.step.factor / events;
        worst = fmax (worst, x.deviation);
        check_below (y.deviation, 0.1);
    }
    assert_int_equal (event, events);
    check_below (worst, 0.05);
    check_relative (load, 1, 0.025);
    check_relative (spent, G0 * r.state->surfaces->area, 0.05);
    /* vertices behind the first go less */
    check_relative (r.state->surfaces->area, 0.96 * events * depth, 0.05);
    clear (&r);
}

/* PERIGAL_TEST_SIZE=long: over ten spacings, on points moved in three ways. */
static void a_straight_front_stays_straight (void **state)
{
    (void) state;
    for (int seed = 1; seed <= (longer () ? 3 : 1); seed++)
        stays_straight (seed, longer () ? 10 : 3, longer () ? 8 : 6);
}

/* Whatever part of the opening is there from the beginning, growth begins at the same opening. Two threads
 * give the bits of one. */
static void loads_may_have_a_constant_part (void **state)
{
    (void) state;
    const int depth = longer () ? 8 : 3;
    run r[3] = { strip (depth, 0.2, 1, 0, 1, 1), strip (depth, 0.2, 1, 0, 1, 2),
                 strip (depth, 0.2, 1, 0.3, 1, 1) };
    for (int k = 0; k < 3; k++) while (r[k].state->events == 0) advance (&r[k]);
    size_t n = r[0].state->ndof * sizeof (double);
    assert_memory_equal (r[0].state->d, r[1].state->d, n);
    assert_true (r[0].step.factor == r[1].step.factor);
    check_relative (r[2].step.factor + 0.3, r[0].step.factor, 1e-5);
    check_relative (r[2].state->surfaces->area, r[0].state->surfaces->area, 1e-4);
    for (int k = 0; k < 3; k++) clear (&r[k]);
}

/* ---- new cracks ---------------------------------------------------------------------------------------- */
/* A beam with a round notch in bending has no crack at first: one begins at the root of the notch, across the
 * tension, and sets free what its area takes; the same with millimetres. */
static void a_crack_begins_at_the_root_of_a_notch (void **state)
{
    (void) state;
    const double side = longer () ? 8 : 6, depth = longer () ? 6 : 4;
    double factor[2];
    for (int unit = 0; unit < 2; unit++) {
        double m = unit ? 1e-3 : 1;
        run r = scene_of (1,
                          "dimension: 3\nspacing: %.17g m\n"
                          "body: [{add: {box: {low: [%.17g, 0, 0], high: [%.17g, %.17g, %.17g]}}}, "
                          "{subtract: {cylinder: {center: [0, 0, %.17g], axis: [0, 0, 1], length: %.17g, "
                          "radius: %.17g}}}]\n"
                          "materials: {glass: {youngs_modulus: %g, poissons_ratio: %g}}\n"
                          "failure: {criterion: energy_release, fracture_energy: %.17g, "
                          "tensile_strength: 8 MPa}\nmethod: {horizon: 2.01 spacing}\n"
                          "boundary: [{set: left, displacement: {x: \"-2e-3*(%.17g - y)\", y: 0, z: 0}}, "
                          "{set: right, displacement: {x: \"2e-3*(%.17g - y)\", y: 0, z: 0}}]\n"
                          "solver: {max_events: 1}\n",
                          m, -side * m, side * m, 8 * m, depth * m, -m, (depth + 2) * m, 2 * m, E, NU,
                          G0 * 1e3 * m, 4 * m, 4 * m);
        assert_int_equal (r.problem->crack.nfront, 0);
        while (r.state->events == 0 && !pg_solver_done (r.solver, r.state)) advance (&r);
        size_t nfront;
        const pg_front *front = pg_fronts_of_state (r.problem, r.state, &nfront);
        assert_int_equal (nfront, 1);
        assert_false (front->closed);
        spread x = of_fronts (&r, 0), y = of_fronts (&r, 1);
        print_message ("factor %.5f, %zu vertices, x %.4f to %.4f, y %.3f to %.3f, energy %.3f\n",
                       r.step.factor,
                       x.n, x.low / m, x.high / m, y.low / m, y.high / m,
                       r.step.dissipated / (G0 * 1e3 * m * r.state->surfaces->area));
        check_below (fmax (x.high, -x.low), 0.05 * m);
        check_below (2 * m, y.high);
        check_below (y.low, 2.5 * m);
        factor[unit] = r.step.factor;
        clear (&r);
    }
    check_relative (factor[1], factor[0], 1e-4);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (a_straight_front_stays_straight),
        cmocka_unit_test (loads_may_have_a_constant_part),
        cmocka_unit_test (a_crack_begins_at_the_root_of_a_notch),
    };
    return cmocka_run_group_tests (tests, NULL, NULL);
}
