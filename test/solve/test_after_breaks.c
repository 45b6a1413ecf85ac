/* SPDX-License-Identifier: GPL-3.0-or-later
 * What a step leaves when bonds have broken in it: forces of explicit steps are those of the bonds that live,
 * bonds that tie have died in one event. And a load that acts for a moment only is a load. */
#include "scene_runs/run.h"

/* Forces that break bonds by themselves within an evaluation, and those whose utilisation is asked for: the
 * acceleration at the end of a step is that of the bonds that live then. */
static void forces_are_those_after_the_break (void **state)
{
    static const char *const methods[] = {
        "{approximation: nosb, integration: nodal, horizon: 2.5 spacing, essential: transformation}",
        "{force: bond, horizon: 2.5 spacing}",
    };
    (void) state;
    for (size_t m = 0; m < 2; m++) {
        run r = scene_of (1,
                          "dimension: 2\nplane: stress\nthickness: 1\nbody: [{add: {box: {low: [0, 0], "
                              "high: [2, 1]}}}]\n"
                          "spacing: 0.125\nlattice: cells\n"
                          "materials: {m: {youngs_modulus: 1000, poissons_ratio: 0.3333333333333333, "
                              "density: 1}}\n"
                          "method: %s\nfailure: {criterion: stretch, critical_stretch: 0.01}\n"
                          "boundary: [{set: left, displacement: {x: 0, y: 0}}, {set: right, velocity: "
                              "{x: 0.9}}]\n"
                          "solver: {kind: verlet, dt: 0.5 ms, end: 0.1}\noutput: {at: {rows: 200}}\n",
                          methods[m]);
        size_t n = r.problem->cloud.n * 2, broke = 0;
        double *mass = pg_calloc (n, sizeof *mass), *f = pg_calloc (n, sizeof *f), unused;
        void *self;
        const pg_force_type *force = pg_solver_force (r.solver, &self);
        check_ok (force->mass (self, mass, NULL));
        while (!pg_solver_done (r.solver, r.state) && broke < 4) {
            double off = 0, size = 0;
            advance (&r);
            if (!r.step.nbroken) continue;
            broke++;
            check_ok (force->balance (self, r.state->time, r.state->d, f, &unused));
            for (size_t i = 0; i < r.problem->cloud.n; i++) {
                double x = r.problem->cloud.x[2*i];
                if (x < 0.3 || x > 1.7) continue;      /* held, or moved */
                for (size_t c = 0; c < 2; c++) {
                    off = fmax (off, fabs (mass[2*i + c] * r.state->a[2*i + c] - f[2*i + c]));
                    size = fmax (size, fabs (f[2*i + c]));
                }
            }
            check_below (off / size, 1e-9);
        }
        assert_int_equal (broke, 4);
        pg_free (mass), pg_free (f);
        clear (&r);
    }
}

/* Bonds within the width of a tie die in one event: in a plate without symmetry more of them with a wide
 * one, all
 * at a factor near that of the first. */
static void ties_die_together (void **state)
{
    (void) state;
    size_t first[2] = { 0 };
    for (int wide = 0; wide < 2; wide++) {
        run r = scene_of (1,
                          "dimension: 2\nplane: stress\nthickness: 1\nbody: [{add: {box: {low: [0, 0], "
                              "high: [1.5, 1]}}}]\n"
                          "spacing: 0.125\nlattice: cells\nperturb: {amount: 0.2, seed: 3}\n"
                          "materials: {m: {youngs_modulus: 1000, poissons_ratio: 0.3333333333333333}}\n"
                          "method: {force: bond, horizon: 2.5 spacing}\n"
                          "failure: {criterion: stretch, critical_stretch: 0.01}\n"
                          "boundary: [{set: left, displacement: {x: 0, y: 0}}, {set: right, "
                              "displacement: {x: 0.1, y: 0}}]\n"
                          "solver: {kind: static, stepping: event, max_events: 1, tie: %g}\noutput: {at: "
                              "{levels: 1}}\n",
                          wide ? 0.1 : 1e-6);
        while (!r.step.nbroken) advance (&r);
        first[wide] = r.step.nbroken;
        clear (&r);
    }
    assert_int_equal (first[0], 2);                     /* a bond has two ends */
    assert_true (first[1] > 6);
}

/* A load that acts between two rows of its table only, between the moments at which others are looked at. */
static void a_load_of_a_moment_is_a_load (void **state)
{
    (void) state;
    for (int acts = 0; acts < 2; acts++) {
        run r = scene_of (1, "dimension: 2\nthickness: 1\nbody: [{add: {box: {low: [0, 0], high: [1, "
                          "1]}}}]\nspacing: 0.25\n"
                             "materials: {m: {youngs_modulus: 1000, poissons_ratio: 0.25}}\n"
                             "boundary: [{set: bottom, displacement: {x: 0, y: 0}}, {set: top, "
                                 "displacement: {y: 0.01}, table: "
                             "[[0, 0], [0.01, %d], [0.02, 0], [1, 0]]}]\n"
                             "solver: {kind: static, stepping: fixed, steps: 100}\noutput: {at: {levels: "
                                 "1}}\n", acts);
        int told = 0;
        if (acts) advance (&r);
        const pg_statistics *report = pg_solver_report_now (r.solver);
        for (size_t k = 0; k < report->nwarning; k++) told |= strstr (report->warning[k], "nothing loads "
                                                                      "the body") != NULL;
        assert_int_equal (told, !acts);
        clear (&r);
    }
}

int main (void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test (forces_are_those_after_the_break),
                                        cmocka_unit_test (ties_die_together),
                                        cmocka_unit_test (a_load_of_a_moment_is_a_load) };
    return cmocka_run_group_tests_name ("solve/after_breaks", tests, NULL, NULL);
}
