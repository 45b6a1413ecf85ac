/* SPDX-License-Identifier: GPL-3.0-or-later
 * Crack fronts in space and materials that meet ahead of them: of unlike stiffness, where nothing is known of
 * J and the front stays; of the same stiffness, which it does not feel but for the energy that it takes. */
#include "run.h"

/* A strip between clamps, spacing 1 m, crack up to x = 5; beyond x = 8 another material. */
static run strip (double stiffness, double energy, int events)
{
    const double E = 70e9, nu = 0.22, M = E * (1 - nu) / ((1 + nu) * (1 - 2 * nu)),
                 u = 2 * sqrt (2 * 6 * 8 / M);
    return scene_of (1, "dimension: 3\nspacing: 1 m\nbody: [{add: {box: {low: [0, -3, 0], high: [14, 3, "
                        "4]}}}]\n"
                        "cracks: [{polygon: [[-0.6, 0.3, -0.6], [5, 0.3, -0.6], [5, 0.3, 4.6], [-0.6, 0.3, "
                        "4.6]]}]\n"
                        "materials: {a: {youngs_modulus: %g, poissons_ratio: %g}, b: {youngs_modulus: %g, "
                        "poissons_ratio: %g, failure: {fracture_energy: %g}}}\n"
                        "blocks: [{material: a, where: x == x}, {material: b, where: x > 8}]\n"
                        "boundary: [{set: bottom, displacement: {x: 0, y: 0, z: 0}}, "
                        "{set: top, displacement: {x: 0, y: %.17g, z: 0}}, "
                        "{set: back, displacement: {z: 0}}, {set: front, displacement: {z: 0}}]\n"
                        "method: {horizon: 2.01 spacing}\n"
                        "failure: {criterion: energy_release, fracture_energy: 8}\n"
                        "solver: {max_events: %d}\n", E, nu, E * stiffness, nu, energy, u, events);
}

/* How far the fronts reach along x. */
static double tip (const run *r)
{
    size_t n;
    const pg_front *front = pg_fronts_of_state (r->problem, r->state, &n);
    double far = 0;
    for (size_t k = 0; k < n; k++)
        for (size_t i = 0; i < front[k].n; i++) far = fmax (far, front[k].x[3*i]);
    return far;
}

static int is_told (const run *r, const char *words)
{
    const pg_statistics *report = pg_solver_report (r->solver, r->state);
    int told = 0;
    for (size_t k = 0; k < report->nwarning; k++) told |= strstr (report->warning[k], words) != NULL;
    return told;
}

static void a_front_stays_before_another_stiffness (void **state)
{
    (void) state;
    run r = strip (3, 8, 8);
    while (!pg_solver_done (r.solver, r.state)) advance (&r);
    print_message ("%ld events, front up to %.3f\n", (long) r.state->events, tip (&r));
    assert_true (r.state->events >= 1);
    check_below (5.5, tip (&r));
    check_below (tip (&r), 8);
    assert_true (is_told (&r, "materials of unlike stiffness meet"));
    clear (&r);
}

/* Up to the interface the same loads as without it, to the last bit; beyond it those of twice the energy. */
static void a_front_passes_into_the_same_stiffness (void **state)
{
    (void) state;
    run r = strip (1, 16, 6), one = strip (1, 8, 6);
    double before = 0, beyond = 0;
    while (!pg_solver_done (r.solver, r.state)) {
        double from = tip (&r);
        advance (&r), advance (&one);
        if (!r.step.event) continue;
        print_message ("from %.3f: load %.6f, %.6f\n", from, r.step.factor, one.step.factor);
        if (from < 6.5) assert_true (r.step.factor == one.step.factor), before = r.step.factor;
        if (from > 8.2 && !(beyond > 0)) beyond = r.step.factor;
    }
    check_below (8.2, tip (&r));
    check_relative (beyond / before, sqrt (2), 0.03);
    assert_false (is_told (&r, "unlike stiffness"));
    clear (&r), clear (&one);
}

int main (void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test (a_front_stays_before_another_stiffness),
                                        cmocka_unit_test (a_front_passes_into_the_same_stiffness) };
    return cmocka_run_group_tests (tests, NULL, NULL);
}
