/* SPDX-License-Identifier: GPL-3.0-or-later
 * Bodies with round surfaces by consistent integration, the default there: they fall as Newton has it, bear a
 * load at their end, and turn without stress, in the plane and in space, wherever the lattice lies. */
#include "run.h"
#include <math.h>

#define SOLID "materials: {a: {youngs_modulus: 1e9, poissons_ratio: 0.3, density: 1000}}\n"

/* Without method: the default is asked for. 10 m/s^2 set in along a linear ramp of 1 s: -1/6 * 10 m. */
static void a_free_body_falls (void **state)
{
    static const struct { int dim; const char *body, *gravity; double spacing; } bodies[] = {
        { 2, "disk: {center: [0, 0], radius: 0.5}", "[0, -10]", 0.1 },
        { 3, "sphere: {center: [0, 0, 0], radius: 0.5}", "[0, -10, 0]", 0.2 },
        { 3, "cylinder: {center: [0, 0, 0], axis: [0, 0, 1], length: 0.5, radius: 0.4}",
          "[0, -10, 0]", 0.2 },
    };
    (void) state;
    for (size_t k = 0; k < sizeof bodies / sizeof *bodies; k++) {
        run r = scene_of (1, "dimension: %d\nbody: [{add: {%s}}]\nspacing: %g\n" SOLID
                             "boundary: [{name: g, gravity: %s}]\n"
                             "solver: {kind: newmark, dt: 0.05, end: 1, tolerance: 1e-12}\n"
                             "output: {at: {levels: 1}}\n",
                          bodies[k].dim, bodies[k].body, bodies[k].spacing, bodies[k].gravity);
        assert_true (r.problem->form.integration->consistent);
        to_the_end (&r);
        int components;
        double *u = field_of (&r, NULL, "displacement", &components);
        size_t dim = (size_t) bodies[k].dim;
        for (size_t i = 0; i < r.problem->cloud.n; i++) {
            check_absolute (u[i * dim], 0, 1e-6);
            check_relative (u[i * dim + 1], u[1], 1e-6);
        }
        check_relative (u[1], -10.0 / 6, 2e-3);        /* what the time step is worth */
        pg_free (u);
        clear (&r);
    }
}

/* A cantilever with a hole near its loaded end; finite elements: -0.4031. Forces and moments balance. */
static void a_cantilever_with_a_hole_bends (void **state)
{
    (void) state;
    run r = scene_of (1,
                      "dimension: 2\nplane: stress\nbody: [{add: {box: {low: [0, 0], high: [10, 1]}}}, "
                      "{subtract: {disk: {center: [9.3, 0.5], radius: 0.25}}}]\nspacing: 0.125\n"
                      "materials: {a: {youngs_modulus: 1000, poissons_ratio: 0.3}}\n"
                      "boundary: [{name: L, set: left, about: [0, 0], displacement: {x: 0, y: 0}}, "
                      "{name: R, set: right, about: [0, 0], traction: {y: -0.1}}]\nsolver: {kind: static}\n"
                      "output: {at: {levels: 1}}\n");
    to_the_end (&r);
    int components;
    double *u = field_of (&r, NULL, "displacement", &components), tip = 0;
    for (size_t i = 0; i < r.problem->cloud.n; i++)
        if (r.problem->cloud.x[2*i] > 9.99 && fabs (r.problem->cloud.x[2*i + 1] - 0.5) < 0.01)
            tip = u[2*i + 1];
    check_relative (tip, -0.4029, 1e-3);
    const pg_statistics *s = pg_solver_report (r.solver, r.state);
    assert_true (s->balance.states > 0);
    check_below (fmax (s->balance.force, s->balance.moment), 1e-10);
    pg_free (u);
    clear (&r);
}

/* A cracked square on a shifted lattice whose ends turn as a rigid body does, by Gauss points and by default:
 * K against that of a stress E times the angle (before: 5e-3). */
static void a_turn_gives_no_stress (void **state)
{
    static const char *const method[] = { "", "method: {integration: gauss}\n" };
    (void) state;
    for (int k = 0; k < 2; k++) {
        run r = scene_of (1,
                          "dimension: 2\nplane: strain\nbody: [{add: {box: {low: [0, 0], high: [1, 1]}}}]\n"
                          "spacing: 0.05\nlattice: cells\nlattice_offset: [0.37, 0.21]\n%s"
                          "cracks: [{from: [-0.1, 0.5], to: [0.5, 0.5]}]\n"
                          "materials: {m: {youngs_modulus: 1, poissons_ratio: 0.3}}\n"
                          "failure: {criterion: energy_release, fracture_energy: 1e9}\n"
                          "boundary:\n  - {set: bottom, displacement: {x: '-0.001*y', y: '0.001*x'}}\n"
                          "  - {set: top, displacement: {x: '-0.001*y', y: '0.001*x'}}\n"
                          "solver: {kind: static, stepping: fixed, steps: 1}\noutput: {at: {levels: 1}}\n",
                          method[k]);
        assert_int_equal (r.problem->form.integration->consistent, k == 0);
        to_the_end (&r);
        const pg_tip_values *v = pg_solver_tip (r.solver, r.state->paths->tip[0].id);
        check_below (fmax (fabs (v->K[0]), fabs (v->K[1])), 1e-6 * 1e-3);
        check_below (pg_solver_report (r.solver, r.state)->energy.strain, 1e-20);
        clear (&r);
    }
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (a_free_body_falls),
        cmocka_unit_test (a_cantilever_with_a_hole_bends),
        cmocka_unit_test (a_turn_gives_no_stress),
    };
    return cmocka_run_group_tests (tests, NULL, NULL);
}
