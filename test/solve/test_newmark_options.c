/* SPDX-License-Identifier: GPL-3.0-or-later
 * Newmark's method with numerical damping (Hilber, Hughes and Taylor) and with consistent mass. */
#include "solve/newmark.h"
#include <math.h>
#include <string.h>

#define BAR \
    "dimension: 1\ncross_section: 1 m2\nbody: [{add: {box: {low: [0], high: [1 m]}}}]\nspacing: %g m\n" \
    "materials: {rock: {youngs_modulus: 1 Pa, poissons_ratio: 0, density: 1}}\n" \
    "boundary: [{set: left, displacement: {x: 0}, ramp: constant}]\nmethod: {essential: transformation}\n" \
    "solver: {kind: newmark, dt: %g s, end: %g s, mass: %s, alpha: %g, tolerance: 1e-9}\n"
static const double pi = 3.14159265358979323846;

static dynamic bar (double h, double dt, double end, const char *mass, double alpha)
{
    char text[2048];
    snprintf (text, sizeof text, BAR, h, dt, end, mass, alpha);
    return open_run (text);
}

/* Starts in the mode sin (m pi x / 2), m odd, of a bar that is held on the left; returns the displacement of
 * the free end after the run. */
static double free_end (dynamic *r, int m)
{
    for (size_t i = 0; i < r->n; i++) r->state->d[i] = sin (m * pi * r->problem->cloud.x[i] / 2);
    run_to_end (r);
    size_t end = 0;
    for (size_t i = 0; i < r->n; i++) if (r->problem->cloud.x[i] > r->problem->cloud.x[end]) end = i;
    return r->state->d[end];
}

/* Period 4 s: u (1) = cos (omega). */
static void both_masses_give_the_frequency_of_the_bar (void **state)
{
    (void) state;
    dynamic a = bar (0.05, 1e-3, 1, "lumped", 0), b = bar (0.05, 1e-3, 1, "consistent", 0);
    double omega[2] = { acos (free_end (&a, 1)), acos (free_end (&b, 1)) };
    print_message ("lumped %.7f, consistent %.7f, exact %.7f\n", omega[0], omega[1], pi / 2);
    for (int c = 0; c < 2; c++) assert_true (fabs (omega[c] / (pi / 2) - 1) < 1e-3);
    assert_true (fabs (omega[1] - omega[0]) > 1e-5);
    close_run (&a), close_run (&b);
}

/* Fields 1 and x are reproduced, so their kinetic energy is exact: rho int 1 and rho int |x|^2; that of the
 * lumped mass is not. */
static void consistent_mass_is_exact_for_linear_motion (void **state)
{
    (void) state;
    dynamic r = open_run ("dimension: 3\nbody: [{add: {box: {low: [0, 0, 0], high: [0.4, 0.3, "
                          "0.5]}}}]\nspacing: 0.1\nperturb: {amount: 0.2}\n"
                          "materials: {rock: {youngs_modulus: 1, poissons_ratio: 0.2, density: 2500}}\n"
                          "boundary: [{set: left, displacement: {x: 0}, ramp: constant}]\nsolver: {kind: "
                          "newmark, dt: 1, end: 2, mass: consistent}\n");
    advance (&r);
    const pg_sparse *M;
    check_ok (r.force->mass (r.self, NULL, &M));
    double mass = 0, spread = 0, lumped = 0, *m = pg_calloc (3 * r.n, sizeof *m);
    const double *x = r.problem->cloud.x;
    check_ok (r.force->mass (r.self, m, NULL));
    for (size_t J = 0; J < M->ncol; J++) {
        for (long q = M->start[J]; q < M->start[J + 1]; q++) {
            size_t I = (size_t) M->row[q];
            double twice = M->value[q] * (I == J ? 1 : 2);
            mass += twice;
            for (int c = 0; c < 3; c++) spread += twice * x[3 * I + (size_t) c] * x[3 * J + (size_t) c];
        }
        for (int c = 0; c < 3; c++) lumped += m[3 * J] * x[3 * J + (size_t) c] * x[3 * J + (size_t) c];
    }
    double exact = 150 * (0.16 + 0.09 + 0.25) / 3;
    check_scaled (mass, 150, 1e-12, 150);
    check_scaled (spread, exact, 1e-12, exact);
    assert_true (fabs (lumped / exact - 1) > 1e-3);
    pg_free (m);
    close_run (&r);
}

static void energy_stays_with_consistent_mass (void **state)
{
    (void) state;
    dynamic r = bar (0.05, 5e-3, 4, "consistent", 0);
    free_end (&r, 3);
    const pg_statistics *report = pg_solver_report_now (r.solver);
    double energy = report->energy.strain + report->energy.kinetic;
    assert_true (energy > 0);
    check_scaled (report->energy.dissipated, 0, 1e-8, energy);
    close_run (&r);
}

/* Of second order in the step, like Newmark's own method. */
static void numerical_damping_keeps_second_order (void **state)
{
    (void) state;
    double last = 0, exact = 0;
    for (int k = -1; k < 3; k++) {
        double dt = k < 0 ? 2e-4 : 0.04 / (1 << k);
        dynamic r = bar (0.1, dt, 1, "lumped", k < 0 ? 0 : -0.1);
        double u = free_end (&r, 1);
        close_run (&r);
        if (k < 0) { exact = u; continue; }
        double error = fabs (u - exact);
        print_message ("dt = %g: error %.3e\n", dt, error);
        if (k > 0) assert_true (last / error > 3.4 && last / error < 4.6);
        last = error;
    }
}

/* A mode that the step does not resolve dies out; the lowest one hardly feels it. Without alpha neither
 * does. */
static void numerical_damping_takes_what_the_step_cannot_resolve (void **state)
{
    (void) state;
    double kept[2][2];
    for (int a = 0; a < 2; a++)
        for (int m = 0; m < 2; m++) {
            dynamic r = bar (0.05, 0.1, 20, "lumped", a ? -0.3 : 0);
            free_end (&r, m ? 31 : 1);
            const pg_statistics *report = pg_solver_report_now (r.solver);
            kept[a][m] = (report->energy.strain + report->energy.kinetic) / (report->energy.external);
            close_run (&r);
        }
    print_message ("energy kept: without %.4f and %.4f, with alpha %.4f (lowest) and %.2e (high)\n",
                   kept[0][0], kept[0][1], kept[1][0], kept[1][1]);
    assert_true (kept[0][0] > 0.99 && kept[0][1] > 0.99);
    assert_true (kept[1][0] > 0.9 && kept[1][1] < 1e-3);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (both_masses_give_the_frequency_of_the_bar),
        cmocka_unit_test (consistent_mass_is_exact_for_linear_motion),
        cmocka_unit_test (energy_stays_with_consistent_mass),
        cmocka_unit_test (numerical_damping_keeps_second_order),
        cmocka_unit_test (numerical_damping_takes_what_the_step_cannot_resolve),
    };
    return cmocka_run_group_tests_name ("solve/newmark_options", tests, NULL, NULL);
}
