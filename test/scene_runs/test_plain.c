/* SPDX-License-Identifier: GPL-3.0-or-later
 * Whole runs with all shortcuts beside the same with `solver.plain`, which factors at every change of K and
 * looks at every bond and evaluates all anew: the same bonds die in the same steps, load factors,
 * times, energies and displacements agree to 1e-8 of the largest. Solves leave a residual of 1e-11. Where a
 * part of a broken body hangs by a few bonds it moves by that residual over their stiffness: steps end
 * before. */
#include "run.h"
#include <string.h>

#define PLATE \
    "dimension: 2\nplane: stress\nthickness: 10 mm\nbody: [{add: {box: {low: [0, 0], high: [1 m, 1 m]}}}]\n"
#define BLOCK \
    "dimension: 3\nbody: [{add: {box: {low: [0, 0, 0], high: [0.6 m, 0.8 m, 0.4 m]}}}]\n" \
    "spacing: 0.1 m\n"
#define EDGE "cracks: [{from: [-0.1 m, 0.5 m], to: [0.3 m, 0.5 m]}]\n"
#define FLAW \
    "cracks: [{polygon: [[-0.1, 0.45, -0.1], [0.25, 0.45, -0.1], [0.25, 0.35, 0.5], [-0.1, 0.35, 0.5]]}]\n"
#define ROCK "materials: {rock: {youngs_modulus: 30 GPa, poissons_ratio: 0.2, density: 2500}}\n"
#define PULL "boundary: [{set: bottom, displacement: {x: 0, y: 0}}, {set: top, displacement: {y: 1 mm}}]\n"
#define PULL_3D \
    "boundary: [{set: bottom, displacement: {x: 0, y: 0, z: 0}}, {set: top, displacement: {y: 1 mm}}]\n"
#define STRETCH "failure: {criterion: stretch, critical_stretch: 3e-4, exclude: [bottom, top]}\n"
#define STRESS "failure: {criterion: principal_stress, tensile_strength: 5 MPa, exclude: [bottom, top]}\n"
#define EVENTS "solver: {stepping: event, max_events: 40, tolerance: 1e-11"

typedef struct { const char *what, *scene, *solver; long steps; int breaks; } pair;

static const pair pairs[] = {
    { "cantilever in space",
      "dimension: 3\nbody: [{add: {box: {low: [0, 0, 0], high: [1.6 m, 0.4 m, 0.4 m]}}}]\n"
      "spacing: 0.1 m\n" ROCK
      "boundary: [{set: left, displacement: {x: 0, y: 0, z: 0}}, {set: right, traction: {y: 1 MPa}}]\n",
      "solver: {tolerance: 1e-11", 1, 0 },
    { "single bonds by events", PLATE "spacing: 0.05 m\n" EDGE ROCK PULL STRETCH, EVENTS, 40, 1 },
    { "stresses by events, points moved",
      PLATE "spacing: 0.05 m\nperturb: {amount: 0.2}\n" EDGE ROCK PULL STRESS, EVENTS, 40, 1 },
    { "nodal integration", PLATE "spacing: 0.05 m\nmethod: {integration: nodal}\n" EDGE ROCK PULL STRETCH,
      EVENTS, 40, 1 },
    { "consistent integration",
      PLATE "spacing: 0.05 m\nmethod: {integration: consistent}\n" EDGE ROCK PULL STRESS, EVENTS, 30, 1 },
    { "shear and tension",
      PLATE "spacing: 0.05 m\n" EDGE ROCK
            "boundary: [{set: bottom, displacement: {x: 0, y: 0}}, {set: top, displacement: {y: -1 mm}}]\n"
            "failure: {criterion: mohr_coulomb, cohesion: 10 MPa, friction_angle: 30 deg, "
            "tensile_strength: 3 MPa, exclude: [bottom, top]}\n",
      EVENTS, 30, 1 },
    { "a constant part of the load",
      PLATE "spacing: 0.05 m\n" EDGE ROCK
            "boundary: [{set: bottom, displacement: {x: 0, y: 0}}, {set: top, displacement: {y: 1 mm}}, "
            "{set: right, traction: {x: -1 MPa}, ramp: constant}]\n" STRETCH,
      EVENTS, 30, 1 },
    { "events in space", BLOCK FLAW ROCK PULL_3D STRETCH, EVENTS, 25, 1 },
    { "fixed steps",
      PLATE "spacing: 0.05 m\n" EDGE ROCK PULL STRETCH,
      "solver: {stepping: fixed, steps: 20, tolerance: 1e-11, break: fraction, break_fraction: 10 %", 11, 1 },
    { "newmark, in space",
      BLOCK FLAW ROCK "boundary: [{set: bottom, displacement: {x: 0, y: 0, z: 0}}, {set: top, "
                      "velocity: {y: 0.5 m/s}}]\nmethod: {essential: transformation}\nfailure: {criterion: "
                      "stretch, critical_stretch: 1e-4, exclude: [bottom, top]}\n",
      "solver: {kind: newmark, dt: 12 us, end: 2.4 ms, tolerance: 1e-11, rayleigh: {stiffness: 2 us}, break: "
      "fraction, break_fraction: 10 %", 20, 1 },
    { "explicit steps of shape functions",
      PLATE "spacing: 0.05 m\n" EDGE ROCK "boundary: [{set: bottom, displacement: {x: 0, y: 0}}, {set: top, "
      "velocity: {y: 1 m/s}}]\nmethod: {essential: nitsche}\n" STRETCH,
      "solver: {kind: central, end: 1 ms", 60, 1 },
    { "explicit steps of bonds",
      PLATE "spacing: 0.01 m\nlattice: cells\n" EDGE ROCK "boundary: [{set: bottom, displacement: {x: 0, "
      "y: 0}}, {set: top, velocity: {y: 2 m/s}}]\nmethod: {force: bond, horizon: 3 spacing}\n" STRETCH,
      "solver: {kind: verlet, end: 0.6 ms", 100, 1 },
    { "relaxation of bonds",
      PLATE "spacing: 0.025 m\nlattice: cells\n" EDGE ROCK PULL "method: {force: bond, horizon: 3 spacing}\n"
      STRETCH, "solver: {kind: adr, stages: 6, imbalance: 1e-10", 6, 1 },
    { "bonds by events", PLATE "spacing: 0.05 m\nlattice: cells\n" EDGE ROCK PULL
      "method: {force: bond, horizon: 3 spacing}\n" STRETCH, EVENTS, 30, 1 },
};

static run make (const pair *p, int plain)
{
    char text[4096];
    int n = snprintf (text, sizeof text, "%s%s%s}\n", p->scene, p->solver, plain ? ", plain: true" : "");
    assert_true (n > 0 && n < (int) sizeof text);
    return prepare (1, text);
}

/* Times and load factors to 1e-8 of what they are; energies of the work done; displacements of the largest
 * one. */
static void same_state (const run *a, const run *b)
{
    const pg_statistics *r = pg_solver_report_now (a->solver), *s = pg_solver_report_now (b->solver);
    double top = largest_of (b->state->d, b->state->ndof), all = fabs (s->energy.external) + s->energy.strain;
    assert_memory_equal (a->state->alive, b->state->alive, a->state->nbond);
    check_below (largest_difference (a->state->d, b->state->d, a->state->ndof), 1e-8 * top);
    check_relative (a->state->factor, b->state->factor, 1e-8);
    check_scaled (r->energy.strain, s->energy.strain, 1e-8, all);
    check_scaled (r->energy.external, s->energy.external, 1e-8, all);
    check_scaled (r->energy.kinetic, s->energy.kinetic, 1e-8, all);
}

static void no_shortcut_changes_a_run (void **state)
{
    (void) state;
    for (size_t k = 0; k < sizeof pairs / sizeof *pairs; k++) {
        print_message ("%s\n", pairs[k].what);
        run a = make (&pairs[k], 0), b = make (&pairs[k], 1);
        assert_int_equal (a.options.plain, 0);
        assert_int_equal (b.options.plain, 1);
        const long most = pairs[k].steps / (!longer () && strstr (pairs[k].solver, "event") ? 2 : 1);
        long step = 0;
        for (; step < most && !pg_solver_done (b.solver, b.state); step++) {
            assert_false (pg_solver_done (a.solver, a.state));
            advance (&a), advance (&b);
            assert_int_equal (a.step.nbroken, b.step.nbroken);
            same_state (&a, &b);
        }
        print_message ("  %ld steps, %ld bonds broken\n", step, a.state->broken);
        assert_true ((a.state->broken > 0) == pairs[k].breaks);
        clear (&a), clear (&b);
    }
}

int main (void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test (no_shortcut_changes_a_run) };
    return cmocka_run_group_tests_name ("scene_runs/plain", tests, NULL, NULL);
}
