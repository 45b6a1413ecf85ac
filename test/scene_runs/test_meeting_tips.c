/* SPDX-License-Identifier: GPL-3.0-or-later
 * Two cracks that run towards each other under a pull that sets in at once: they meet in the middle, or hook
 * around each other where they are offset, the one as the other turned by 180 degrees, by every solver in
 * motion; and new cracks, which do not begin in motion, are told of. */
#include "run.h"
#include <math.h>

static const char *const solvers[] = { "kind: newmark, dt: 0.4 us", "kind: verlet" };

/* A plate of 0.24 m x 0.1 m with a crack from either side, up and down by `offset`. */
static run plate (const char *solver, double offset, const char *strength)
{
    return scene_of (1,
                     "dimension: 2\nplane: stress\nthickness: 1 m\n"
                     "body: [{add: {box: {low: [0, -0.05], high: [0.24, 0.05]}}}]\nspacing: 0.005\n"
                     "lattice: cells\ncracks:\n  - {from: [-0.02, %g], to: [0.05, %g]}\n"
                     "  - {from: [0.26, %g], to: [0.19, %g]}\n"
                     "materials: {glass: {youngs_modulus: 70 GPa, poissons_ratio: 0.22, density: 2500 "
                     "kg/m3}}\nfailure: {criterion: energy_release, fracture_energy: 8 J/m2%s}\n"
                     "boundary:\n  - {set: bottom, traction: {y: -3 MPa}, ramp: constant}\n"
                     "  - {set: top, traction: {y: 3 MPa}, ramp: constant}\n"
                     "solver: {%s, end: 110 us, branching: off}\noutput: {at: {levels: 1, rows: 200}}\n",
                     offset, offset, -offset, -offset, strength, solver);
}

/* Both tips stay mirror images, and end in the same step. */
static void both_alike (const run *r)
{
    const pg_tip *a = &r->state->paths->tip[0], *b = &r->state->paths->tip[1];
    assert_int_equal (r->state->paths->ntip, 2);
    check_absolute (a->x[0] + b->x[0], 0.24, 1e-9);
    check_absolute (a->x[1] + b->x[1], 0, 1e-9);
    assert_int_equal (a->open, b->open);
}

/* PERIGAL_TEST_SIZE=long: both ways by both solvers, else each by one. */
static void cracks_meet_or_hook (void **state)
{
    (void) state;
    for (int s = 0; s < 2; s++)
        for (int k = longer () ? 0 : s; k < (longer () ? 2 : s + 1); k++) {
            run r = plate (solvers[s], k ? 0.011 : 0, "");
            while (!pg_solver_done (r.solver, r.state) && r.state->paths->tip[0].open)
                advance (&r), both_alike (&r);
            const pg_tip end = r.state->paths->tip[0];
            print_message ("ended at (%.4f, %.4f) m, %.3g us\n", end.x[0], end.x[1], 1e6 * r.state->time);
            assert_false (end.open);
            assert_true (k ? end.x[0] > 0.12 : fabs (end.x[0] - 0.12) < 1e-9);
            if (k) assert_true (end.x[1] < 0);         /* into the face of the other */
            else check_absolute (end.x[1], 0, 1e-9);
            for (int i = 0; i < 5 && !pg_solver_done (r.solver, r.state); i++) advance (&r);
            assert_true (isfinite (r.state->d[0]));
            clear (&r);
        }
}

/* The pull alone is 6 MPa where its waves meet. */
static void places_that_reach_their_strength_are_told (void **state)
{
    (void) state;
    static const char *const strength[] = { ", tensile_strength: 3 MPa", "" };
    for (int k = 0; k < 2; k++) {
        run r = plate (solvers[0], 0, strength[k]);
        int told = 0;
        for (int i = 0; i < 60; i++) advance (&r);
        const pg_statistics *s = pg_solver_report_now (r.solver);
        for (size_t i = 0; i < s->nwarning; i++)
            told += strncmp (s->warning[i], "in motion the stress reaches the strength", 41) == 0;
        assert_int_equal (told, k == 0);
        clear (&r);
    }
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (cracks_meet_or_hook),
        cmocka_unit_test (places_that_reach_their_strength_are_told),
    };
    return cmocka_run_group_tests_name ("scene_runs/meeting_tips", tests, NULL, NULL);
}
