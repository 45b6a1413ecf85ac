/* SPDX-License-Identifier: GPL-3.0-or-later
 * Newmark's method on scenes: order in time, energy, flight, the static limit, supports that move (theory
 * F5). */
#include "newmark.h"
#include <stdio.h>

static const double pi = 3.14159265358979323846;

/* ---- a bar, E = 1, rho = 1, L = 1: waves run at speed 1, the first period of the clamped-free bar is 4 s */
#define RKPM "approximation: rkpm, horizon: 2.5 spacing, essential: transformation"
#define NOSB \
    "approximation: nosb, integration: nodal, kernel: constant, horizon: 2.0 spacing, stabilization: " \
    "silling"
#define CLAMPED "boundary: [{set: left, displacement: {x: 0}}]"

static dynamic bar (int cells, const char *method, const char *boundary, double dt, double end)
{
    char text[1024];
    snprintf (
        text, sizeof text,
        "dimension: 1\nbody: [{add: {box: {low: [0], high: [1 m]}}}]\nspacing: %.17g m\n"
        "materials: {m: {youngs_modulus: 1 Pa, poissons_ratio: 0, density: 1 kg/m3}}\nmethod: {%s}\n%s\n"
        "solver: {kind: newmark, dt: %.17g s, end: %.17g s, tolerance: 1e-9}\n",
        1.0 / cells, method, boundary, dt, end);
    return open_run (text);
}

/* First mode of the clamped-free bar, as coefficients. */
static void first_mode (dynamic *r, double amplitude)
{
    for (size_t i = 0; i < r->n; i++) r->state->d[i] = amplitude * sin (0.5 * pi * r->problem->cloud.x[i]);
}

static double tip (dynamic *r)
{
    double u[3], end = 1;
    check_ok (r->force->sample (r->self, r->state, r->state->d, 1, &end, u, NULL, NULL));
    return u[0];
}

static double tip_after (int cells, const char *method, double time, double dt)
{
    dynamic r = bar (cells, method, CLAMPED, dt, time);
    first_mode (&r, 1e-3);
    run_to_end (&r);
    double u = tip (&r);
    close_run (&r);
    return u;
}

static void free_vibration_converges_with_dt_squared (void **state)
{
    (void) state;
    const char *const method[2] = { RKPM, NOSB };
    for (int k = 0; k < 2; k++) {
        double u[4];
        for (int i = 0; i < 4; i++) u[i] = tip_after (8, method[k], 2.0, 0.04 / (1 << i));
        check_relative ((u[0] - u[1]) / (u[1] - u[2]), 4, 0.05);
        check_relative ((u[1] - u[2]) / (u[2] - u[3]), 4, 0.02);
    }
}

static void a_period_is_that_of_the_wave (void **state)
{
    (void) state;
    check_relative (tip_after (20, RKPM, 4.0, 0.01), 1e-3, 0.01);
    check_relative (tip_after (20, RKPM, 2.0, 0.01), -1e-3, 0.01);
    check_scaled (tip_after (20, RKPM, 1.0, 0.01), 0, 0.01, 1e-3);
}

/* ---- energy -------------------------------------------------------------------------------------------- */
/* d' K d / 2, boundary terms of Nitsche and penalty included, + v' M v / 2 */
static double energy (dynamic *r)
{
    size_t ndof = r->state->ndof;
    const pg_operator *K = r->force->operator_ (r->self);
    double *Kd = pg_calloc (ndof, sizeof *Kd), *mass = pg_calloc (ndof, sizeof *mass), sum = 0;
    K->apply (K->context, r->state->d, Kd);
    check_ok (r->force->mass (r->self, mass, NULL));
    for (size_t i = 0; i < ndof; i++)
        sum += 0.5 * (r->state->d[i] * Kd[i] + mass[i] * r->state->v[i] * r->state->v[i]);
    pg_free (Kd), pg_free (mass);
    return sum;
}

/* 200 steps from the state at hand keep the energy to 1e-9; what the report says as well, but for the last
 * digits. */
static void energy_stays (dynamic *r)
{
    double first = 0, told = 0;
    for (int k = 0; k < 201; k++) {
        advance (r);
        const pg_statistics *report = pg_solver_report_now (r->solver);
        if (k == 0) first = energy (r), told = report->energy.strain + report->energy.kinetic;
        assert_true (first > 0);
        check_relative (energy (r), first, 1e-9);
        check_relative (report->energy.strain + report->energy.kinetic, told, 1e-9);
    }
    check_relative (told, first, 1e-9);
    close_run (r);
}

static void a_free_bar_keeps_its_energy (void **state)
{
    (void) state;
    const char *const method[3] = { RKPM, NOSB, "approximation: pddo, horizon: 2.5 spacing" };
    for (int k = 0; k < 3; k++) {
        dynamic r = bar (20, method[k], "", 0.02, 10);
        for (size_t i = 0; i < r.n; i++)
            r.state->d[i] = 1e-3 * sin (3 * r.problem->cloud.x[i]),
            r.state->v[i] = 1e-3 * r.problem->cloud.x[i];
        energy_stays (&r);
    }
}

static void a_held_bar_keeps_its_energy (void **state)
{
    (void) state;
    const char *const method[4] = { RKPM, NOSB, "approximation: rkpm, essential: nitsche",
                                    "approximation: rkpm, essential: penalty" };
    for (int k = 0; k < 4; k++) {
        dynamic r = bar (20, method[k], CLAMPED, 0.02, 10);
        first_mode (&r, 1e-3);
        energy_stays (&r);
    }
}

/* ---- a plate ------------------------------------------------------------------------------------------- */
#define PLATE \
    "dimension: 2\nthickness: 5 mm\nbody: [{add: {box: {low: [0, 0], high: [60 mm, 40 mm]}}}]\nspacing: 5 " \
    "mm\nperturb: {amount: 0.2}\n" \
    "materials: {m: {youngs_modulus: 70 GPa, poissons_ratio: 0.3, density: 2700 kg/m3}}\n"

static void a_plate_keeps_its_energy (void **state)
{
    (void) state;
    const char *const rest[3] = {
        "method: {approximation: rkpm}\n",
        "method: {approximation: nosb, integration: nodal, kernel: constant, horizon: 3.015 spacing}\n",
        ("method: {approximation: rkpm, essential: transformation}\nboundary: [{set: left, displacement: "
         "{x: 0, y: 0}}]\n")
    };
    for (int k = 0; k < 3; k++) {
        char text[1024];
        snprintf (text, sizeof text, "%s%ssolver: {kind: newmark, dt: 1 us, end: 201 us}\n", PLATE, rest[k]);
        dynamic r = open_run (text);
        for (size_t i = 0; i < r.n; i++) {
            const double *x = r.problem->cloud.x + 2*i;
            r.state->d[2*i] = 1e-3 * x[0] * x[1], r.state->d[2*i + 1] = 1e-2 * x[0] * x[0];
        }
        energy_stays (&r);
    }
}

/* Without supports and loads: a translation and nothing else, at steps far below and far above the period of
 * the lattice. */
static void a_free_plate_flies (void **state)
{
    (void) state;
    const double dt[3] = { 1e-9, 1e-6, 1e-4 };
    for (int k = 0; k < 3; k++) {
        char text[1024];
        snprintf (text, sizeof text, "%ssolver: {kind: newmark, dt: %g s, end: %g s}\n", PLATE, dt[k],
                  20 * dt[k]);
        dynamic r = open_run (text);
        for (size_t i = 0; i < r.n; i++) r.state->v[2*i] = 3, r.state->v[2*i + 1] = -2;
        run_to_end (&r);
        for (size_t i = 0; i < r.n; i++) {
            check_relative (r.state->d[2*i], 60 * dt[k], 1e-9);
            check_relative (r.state->d[2*i + 1], -40 * dt[k], 1e-9);
        }
        close_run (&r);
    }
}

/* ---- static limit -------------------------------------------------------------------------------------- */
static void huge_steps_are_static (void **state)
{
    (void) state;
    const char *const method[3] = {
        "approximation: rkpm, essential: transformation", "approximation: rkpm, essential: nitsche",
        "approximation: nosb, integration: nodal, kernel: constant, horizon: 3.015 spacing"
    };
    const char *const load[2] = { "traction: {x: 3 MPa, y: 1 MPa}",
                                  "displacement: {x: 0.1 mm, y: -0.05 mm}" };
    for (int k = 0; k < 6; k++) {
        char common[1024], text[1536];
        snprintf (common, sizeof common,
                  "%smethod: {%s}\nboundary: [{set: left, displacement: {x: 0, y: 0}}, {set: right, %s}]\n",
                  PLATE, method[k % 3], load[k / 3]);
        snprintf (text, sizeof text,
                  "%ssolver: {kind: static, stepping: fixed, steps: 4}\noutput: {at: {levels: 1}}\n", common);
        dynamic still = open_run (text);
        snprintf (text, sizeof text, "%ssolver: {kind: newmark, dt: 100 s, end: 400 s}\n", common);
        dynamic slow = open_run (text);
        while (!pg_solver_done (slow.solver, slow.state)) {
            double worst = 0, size = 0;
            advance (&still), advance (&slow);
            for (size_t i = 0; i < 2 * still.n; i++) {
                worst = fmax (worst, fabs (slow.state->d[i] - still.state->d[i]));
                size = fmax (size, fabs (still.state->d[i]));
            }
            check_below (worst / size, 1e-9);
        }
        close_run (&still), close_run (&slow);
    }
}

/* ---- supports that move -------------------------------------------------------------------------------- */
/* u = x g (t) with g = 0.01 t^2 needs the body force x g'' = 0.02 x: give it, and every node follows. */
static void a_prescribed_motion_is_followed (void **state)
{
    (void) state;
    const char *const method[2] = { "approximation: rkpm, horizon: 2.0 spacing, essential: transformation",
                                    RKPM };
    for (int k = 0; k < 2; k++) {
        dynamic r = bar (20, method[k],
                         "boundary: [{set: left, displacement: {x: 0}}, {set: right, displacement: {x: 0.01 "
                         "m}, ramp: \"(t / 1 s)^2\"}, "
                         "{set: all, body_force: {x: \"0.02 N/m3 * x / 1 m\"}, ramp: constant}]",
                         0.05, 2);
        run_to_end (&r);
        check_relative (tip (&r), 0.04, 1e-9);
        for (size_t i = 0; i < r.n; i++)
            check_scaled (r.state->d[i], 0.04 * r.problem->cloud.x[i], 1e-3, 0.04);
        close_run (&r);
    }
}

/* A free bar pulled at its right end, until the wave reaches the left one: the support feels rho c A g'. Its
 * velocity and acceleration are those of g from the first step on (a = 2 D: the coefficient is the
 * displacement), and the books balance. */
static void pull (const char *load, int power, double tolerance_work)
{
    const double U = 1e-3;
    dynamic r = bar (50, "approximation: rkpm, horizon: 2.0 spacing, essential: transformation", load, 0.01,
                     0.9);
    while (!pg_solver_done (r.solver, r.state)) {
        pg_step step = advance (&r);
        double t = step.time, v = power * U * pow (t, power - 1),
               a = power * (power - 1) * U * pow (t, power - 2);
        const pg_statistics *report = pg_solver_report_now (r.solver);
        check_scaled (r.state->d[r.n - 1], U * pow (t, power), 1e-9, 1e-12);
        check_scaled (r.state->v[r.n - 1], v, 1e-6, U);
        check_scaled (r.state->a[r.n - 1], a, 1e-3, U);
        if (power > 1) check_scaled (step.reaction[0], v, 0.01, U);
        check_below (fabs (report->energy.dissipated), tolerance_work * U * U);
    }
    close_run (&r);
}

static void a_pulled_end_feels_the_impedance (void **state)
{
    (void) state;
    pull ("boundary: [{set: right, velocity: {x: 1e-3 m/s}}]", 1, 1e-9);
    pull ("boundary: [{set: right, displacement: {x: 1e-3 m}, ramp: \"(t / 1 s)^2\"}]", 2, 1e-9);
    pull ("boundary: [{set: right, displacement: {x: 1e-3 m}, ramp: \"(t / 1 s)^3\"}]", 3, 1e-5);
}

/* The velocity of a held node stays that of its support when bonds at the support break (C changes under C v
 * = g'). */
static void breaking_at_a_support_gives_it_no_velocity (void **state)
{
    (void) state;
    char text[1536];
    snprintf (text, sizeof text,
              "%sfailure: {criterion: principal_stress, tensile_strength: 30 MPa}\nmethod: {approximation: "
              "rkpm, horizon: 2.5 spacing, essential: transformation}\n"
              "boundary: [{set: left, displacement: {x: -50 um, y: 0}, ramp: constant}, {set: right, "
              "displacement: {x: 50 um, y: 0}, ramp: constant}]\n"
              "solver: {kind: newmark, dt: 0.2 us, end: 4 us, break: all}\n",
              PLATE);
    dynamic r = open_run (text);
    double *v = pg_calloc (6 * r.n, sizeof *v);
    long broken = 0;
    while (!pg_solver_done (r.solver, r.state)) {
        int components;
        const char *unit;
        double most = 0;
        broken += (long) advance (&r).nbroken;
        check_ok (r.force->field (r.self, r.state, r.state->d, "velocity", &components, &unit, v));
        for (size_t i = 0; i < 2 * r.n; i++) most = fmax (most, fabs (v[i]));
        const pg_set *left = pg_sets_find (&r.problem->sets, "left");
        for (size_t i = 0; i < 2 * left->npoint; i++)
            check_below (fabs (v[2 * left->point[i / 2] + (int) (i % 2)]), 1e-9 * most);
    }
    assert_true (broken > 0);
    pg_free (v);
    close_run (&r);
}

/* ---- books --------------------------------------------------------------------------------------------- */
/* What the report calls dissipated: nothing without damping, whether a load acts from the start or the run
 * starts with energy. */
static void nothing_is_lost_without_damping (void **state)
{
    (void) state;
    const char *const load[3] = {
        CLAMPED,
        "boundary: [{set: left, displacement: {x: 0}}, {set: right, traction: {x: 1e-3 Pa}, ramp: constant}]",
        "boundary: [{set: left, displacement: {x: 1 mm}, ramp: constant}]"
    };
    const char *const method[3] = { RKPM, NOSB, "approximation: rkpm, essential: nitsche" };
    for (int k = 0; k < 9; k++) {
        dynamic r = bar (20, method[k % 3], load[k / 3], 0.02, 4);
        if (k / 3 == 0) first_mode (&r, 1e-3);
        while (!pg_solver_done (r.solver, r.state)) {
            advance (&r);
            const pg_statistics *report = pg_solver_report_now (r.solver);
            assert_true (report->energy.external > 0);
            check_below (fabs (report->energy.dissipated), 1e-9 * report->energy.external);
        }
        close_run (&r);
    }
}

/* dt that does not divide the run: equal steps, the last ends at the end. */
static void the_run_ends_at_its_end (void **state)
{
    (void) state;
    dynamic r = bar (10, RKPM, CLAMPED, 0.3, 1.0), s = bar (10, RKPM, CLAMPED, 0.25, 1.0);
    first_mode (&r, 1e-3), first_mode (&s, 1e-3);
    run_to_end (&r), run_to_end (&s);
    assert_int_equal (r.state->step, 4);
    check_relative (r.state->time, 1.0, 1e-15);
    for (size_t i = 0; i < r.n; i++) check_scaled (r.state->d[i], s.state->d[i], 1e-12, 1e-3);
    close_run (&r), close_run (&s);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (free_vibration_converges_with_dt_squared),
        cmocka_unit_test (a_period_is_that_of_the_wave),
        cmocka_unit_test (a_free_bar_keeps_its_energy),
        cmocka_unit_test (a_held_bar_keeps_its_energy),
        cmocka_unit_test (a_plate_keeps_its_energy),
        cmocka_unit_test (a_free_plate_flies),
        cmocka_unit_test (huge_steps_are_static),
        cmocka_unit_test (a_prescribed_motion_is_followed),
        cmocka_unit_test (a_pulled_end_feels_the_impedance),
        cmocka_unit_test (breaking_at_a_support_gives_it_no_velocity),
        cmocka_unit_test (nothing_is_lost_without_damping),
        cmocka_unit_test (the_run_ends_at_its_end),
    };
    return cmocka_run_group_tests_name ("solve/newmark_bar", tests, NULL, NULL);
}
