/* SPDX-License-Identifier: GPL-3.0-or-later
 * K of a crack that stands still in a body that moves, by ring integrals with inertia: a wave of tension that
 * meets the crack (closed form), and a load so slow that it is static. */
#include "run.h"
#include <math.h>

/* Plane strain, 2.5 m x 2 m between smooth walls on the left and right, so that a pull on its top and bottom
 * sends plane waves; the crack is 1 m long, and by the wall on its left half of one of 2 m. */
static run plate (const char *more, const char *ramp, const char *solver)
{
    return scene_of (1,
                     "dimension: 2\nplane: strain\nthickness: 1 m\nbody: [{add: {box: {low: [0, -1], high: "
                     "[2.5, 1]}}}]\nspacing: 0.05\nlattice: cells\ncracks: [{from: [-0.1, 0.012], to: [1, "
                     "0.012]}]\n"
                     "materials: {m: {youngs_modulus: 10 GPa, poissons_ratio: 0.25, density: 2500 kg/m3}}\n%s"
                     "boundary:\n"
                     "  - {set: left, displacement: {x: 0}}\n  - {set: right, displacement: {x: 0}}\n"
                     "  - {set: top, traction: {y: 1 MPa}%s}\n  - {set: bottom, traction: {y: -1 MPa}%s}\n"
                     "solver: {%s}\noutput: {at: {levels: 1}}\n",
                     more, ramp, ramp, solver);
}

/* K_I by the wide ring, with the inertia of the state. */
static double measured (run *r, double t)
{
    void *self;
    const pg_force_type *force = pg_solver_force (r->solver, &self);
    pg_tip_field f = { 0 };
    const double *d = r->state->d;
    assert_true (r->state->paths && r->state->paths->ntip == 1);
    check_ok (pg_tip_measure (&f, r->problem, force, self, r->state, 0, 1, &d, &t, NULL, 0));
    return f.K_wide[0][0];
}

/* Both waves meet at the crack at t = H / c, where they would make a stress of 2 MPa together. From then on,
 * until waves come back, K_I (t) = 2 s sqrt ((1 - 2 nu) c t / pi) / (1 - nu) (Freund 1990, Dynamic Fracture
 * Mechanics, section 2.5). PERIGAL_TEST_SIZE=long. */
static void a_wave_opens_a_crack_as_the_root_of_time (void **state)
{
    (void) state;
    if (!longer ()) return;
    double c = sqrt (10e9 * 0.75 / (1.25 * 0.5) / 2500), pi = acos (-1), mean = 0;
    run r = plate ("", ", ramp: constant", "kind: newmark, dt: 8 us, end: 1.05 ms");
    long looks = 0;
    while (!pg_solver_done (r.solver, r.state)) {
        advance (&r);
        double t = r.state->time - 1 / c;
        if (!(c * t > 0.4)) continue;
        double share = measured (&r, r.state->time) / (2 * 2e6 * sqrt (0.5 * c * t / pi) / 0.75);
        check_absolute (share, 1, 0.04);
        mean += share, looks++;
    }
    assert_true (looks > 20);
    check_absolute (mean / (double) looks, 1, 0.015);
    clear (&r);
}

/* A load that grows over many periods of the body. */
static void a_slow_load_is_static (void **state)
{
    (void) state;
    run a = plate ("", "", "kind: newmark, dt: 2 ms, end: 0.2 s, alpha: -0.3"),
        b = plate ("", "", "kind: static, stepping: fixed, steps: 1");
    to_the_end (&a), to_the_end (&b);
    check_relative (measured (&a, a.state->time), measured (&b, 1), 0.005);
    clear (&a), clear (&b);
}

/* ---- a crack that runs --------------------------------------------------------------------------------- */
enum { TIMES = 5 };
typedef struct { double length[TIMES], dissipated[TIMES], needed[TIMES], share, last; long looks; } course;

/* The crack of the first test with the fracture energy that its K reaches when the waves have gone on by
 * 0.25 m: from then on K (v, t) = k (v) K (t) at any place (Freund 1990, section 7.4), so that v = c_R (1 -
 * t0 / t). Lengths at c t = 0.6, 0.9, 1.2, 1.5 and 1.8 m, before the waves are back; what was dissipated
 * until then, and what the facets take as far as they are open; the mean of G (v) / G0 from the fifth facet
 * on. */
static course crack_runs (const char *solver)
{
    double c = sqrt (10e9 * 0.75 / (1.25 * 0.5) / 2500);
    course out = { .looks = 0 };
    run r = plate ("failure: {criterion: energy_release, fracture_energy: 106.1}\n", ", ramp: constant",
                   solver);
    int k = 0;
    while (k < TIMES) {
        advance (&r);
        const pg_tip_values *tip = pg_solver_tip (r.solver, 1);
        double length = r.state->paths->length, ct = c * r.state->time - 1;
        if (length > 0.22) out.share += tip->J / 106.1, out.looks++;
        if (!(ct >= 0.6 + 0.3 * k)) continue;
        const pg_statistics *report = pg_solver_report_now (r.solver);
        out.dissipated[k] = report->energy.dissipated, out.needed[k] = report->energy.fracture;
        out.length[k++] = length;
    }
    out.share /= (double) out.looks;
    out.last = r.state->paths->tip[0].x[1];
    clear (&r);
    return out;
}

/* Facets begin to open when they are cut and end four facets later: the crack is about 1.5 facets shorter
 * than its path, which is known to a facet. PERIGAL_TEST_SIZE=long: by velocity Verlet as well. */
static void a_crack_runs_as_fast_as_it_takes_its_energy (void **state)
{
    (void) state;
    static const char *const solver[] = { "kind: newmark, dt: 8 us, end: 1.3 ms, branching: off",
                                          "kind: verlet, end: 1.3 ms, branching: off" };
    double c = sqrt (10e9 * 0.75 / (1.25 * 0.5) / 2500), c_R = 1163;
    for (int s = 0; s < 1 + longer (); s++) {
        course at = crack_runs (solver[s]);
        double taken = at.dissipated[TIMES - 1] / at.needed[TIMES - 1],
               late = (at.dissipated[TIMES - 1] - at.dissipated[1]) / (at.needed[TIMES - 1] - at.needed[1]);
        print_message ("G (v) = %.3f G0, dissipated %.3f, late %.3f, off by %.3f m:", at.share, taken, late,
                       at.last - 0.012);
        for (int k = 0; k < TIMES; k++) {
            double t = 0.6 + 0.3 * k, closed = c_R / c * (t - 0.25 - 0.25 * log (t / 0.25));
            print_message (" %.3f (%.3f)", at.length[k], closed + 0.075);
            check_absolute (at.length[k], closed + 0.075, 0.08);
        }
        print_message ("\n");
        check_absolute (at.share, 1, 0.08);
        check_absolute (taken, 1, 0.05);
        check_absolute (late, 1, 0.05);
        check_absolute (at.last, 0.012, 0.025);
    }
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (a_wave_opens_a_crack_as_the_root_of_time),
        cmocka_unit_test (a_slow_load_is_static),
        cmocka_unit_test (a_crack_runs_as_fast_as_it_takes_its_energy),
    };
    return cmocka_run_group_tests_name ("scene_runs/stepped_crack", tests, NULL, NULL);
}
