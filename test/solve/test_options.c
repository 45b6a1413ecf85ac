/* SPDX-License-Identifier: GPL-3.0-or-later
 * Options of the solver: defaults, what follows from the loads, and what is refused with which words. */
#include "mechanics/model/scenes.h"

#define PULLED PLATE "boundary: [{set: left, displacement: {x: 0, y: 0}}, {set: right, traction: {x: 1}}]\n"
#define HELD \
    PLATE "boundary: [{set: left, displacement: {x: 0, y: 0}}, {set: right, traction: {x: 1}, ramp: " \
          "constant}]\n"
#define BREAKS "failure: {criterion: stretch, critical_stretch: 1e-3}\n"

static pg_solver_options options_of (const char *text)
{
    built b = build (text);
    pg_solver_options o;
    check_ok (pg_solver_options_read (&o, b.problem, b.scene));
    unbuild (&b);
    return o;
}

static void defaults_are_those_of_the_manual (void **state)
{
    (void) state;
    pg_solver_options o = options_of (PULLED BREAKS);
    assert_string_equal (o.kind, "static");
    assert_string_equal (o.linear, "auto");
    assert_int_equal (o.break_mode, PG_BREAK_WORST);
    check_relative (o.tolerance, 1e-8, 1e-15);
    check_relative (o.tie, 1e-4, 1e-15);
    assert_int_equal (o.steps, 20);
    assert_int_equal (o.levels, 20);
    assert_null (o.stop_set);
}

static void stepping_follows_the_loads (void **state)
{
    (void) state;
    assert_true (options_of (PULLED BREAKS).event);
    assert_false (options_of (HELD BREAKS).event);
    assert_false (options_of (PULLED BREAKS "solver: {stepping: fixed}\n").event);
    assert_true (options_of (PULLED BREAKS "solver: {stepping: event}\n").event);
    assert_false (options_of (PULLED BREAKS "solver: {break: all}\n").event);
    assert_false (options_of (PULLED "solver: {kind: newmark, dt: 1, end: 10}\n").event);
}

static void steps_follow_levels_unless_given (void **state)
{
    (void) state;
    assert_int_equal (options_of (HELD "output: {at: {levels: 50}}\n").steps, 50);
    assert_int_equal (options_of (HELD "output: {at: {levels: 50}}\nsolver: {steps: 30}\n").steps, 30);
    assert_int_equal (options_of (HELD "output: {at: {levels: 5}}\n").steps, 20);
}

static void time_steps_fill_the_run (void **state)
{
    (void) state;
    assert_int_equal (options_of (HELD "solver: {kind: newmark, dt: 0.1, end: 1}\n").steps, 10);  /* not 11 */
    assert_int_equal (options_of (HELD "solver: {kind: newmark, dt: 0.3, end: 1}\n").steps, 4);
    assert_int_equal (options_of (HELD "solver: {kind: newmark, dt: 1 us, end: 1 ms}\n").steps, 1000);
}

#define BONDS  PLATE "method: {force: bond}\n"
#define MOVED  BONDS "boundary: [{set: left, displacement: {x: 0, y: 0}}, {set: right, velocity: {x: 1}}]\n"

static void kinds_tell_what_they_do (void **state)
{
    (void) state;
    pg_solver_options o = options_of (PULLED);
    assert_true (o.flags == (PG_SOLVER_STATIC | PG_SOLVER_EVENTS | PG_SOLVER_FACETS
                                 | PG_SOLVER_CONTACT | PG_SOLVER_RANKS));
    o = options_of (HELD "solver: {kind: newmark, dt: 1, end: 10}\n");
    assert_true (o.flags == (PG_SOLVER_IMPLICIT | PG_SOLVER_NEEDS_DENSITY | PG_SOLVER_FACETS
                             | PG_SOLVER_CONTACT | PG_SOLVER_RANKS));
    o = options_of (MOVED "solver: {kind: verlet, end: 10}\n");
    assert_true (o.flags == (PG_SOLVER_EXPLICIT | PG_SOLVER_NEEDS_DENSITY | PG_SOLVER_FACETS
                             | PG_SOLVER_CONTACT | PG_SOLVER_RANKS));
    o = options_of (MOVED "solver: {kind: central, end: 10}\n");
    assert_true (o.flags == (PG_SOLVER_EXPLICIT | PG_SOLVER_NEEDS_DENSITY | PG_SOLVER_FACETS
                             | PG_SOLVER_CONTACT | PG_SOLVER_RANKS));
    o = options_of (BONDS "solver: {kind: adr}\n");
    assert_true ((o.flags & ~PG_SOLVER_NEEDS_DENSITY)
                     == (PG_SOLVER_QUASI_STATIC | PG_SOLVER_STAGED | PG_SOLVER_CONTACT | PG_SOLVER_RANKS)
                 && PG_OWN (pg_stages_options, &o)->hold && PG_OWN (pg_stages_options, &o)->stages == 10
                 && o.break_mode == PG_BREAK_PASSING);
    check_relative (PG_OWN (pg_stages_options, &o)->imbalance, 1e-5, 1e-15);
    o = options_of (BONDS "solver: {kind: relax, hold: off, stages: 7, damping: 5e6, dt: 1 us}\n");
    assert_true ((o.flags & ~PG_SOLVER_NEEDS_DENSITY)
                     == (PG_SOLVER_QUASI_STATIC | PG_SOLVER_STAGED | PG_SOLVER_CONTACT | PG_SOLVER_RANKS)
                 && !PG_OWN (pg_stages_options, &o)->hold && PG_OWN (pg_stages_options, &o)->stages == 7);
    check_relative (PG_OWN (pg_stages_options, &o)->damping, 5e6, 1e-15);
    check_relative (o.dt, 1e-6, 1e-15);
}

static void explicit_times_from_two_of_three (void **state)
{
    (void) state;
    pg_solver_options o = options_of (MOVED "solver: {kind: verlet, dt: 0.3, end: 1}\n");
    assert_int_equal (o.time_steps, 4);
    check_relative (o.dt, 0.25, 1e-15);
    o = options_of (MOVED "solver: {kind: verlet, dt: 0.5, time_steps: 7}\n");
    check_relative (o.end, 3.5, 1e-15);
    o = options_of (MOVED "solver: {kind: verlet, end: 7, time_steps: 14}\n");
    check_relative (o.dt, 0.5, 1e-15);
    o = options_of (MOVED "solver: {kind: verlet, time_steps: 14}\noutput: {at: {rows: 3}}\n");
    assert_true (o.dt == 0 && o.end == 0 && o.time_steps == 14 && o.rows == 3);
    assert_int_equal (options_of (HELD "solver: {kind: newmark, end: 1, time_steps: 25}\n").steps, 25);
    assert_int_equal (options_of (HELD "solver: {kind: newmark, dt: 0.1, time_steps: 25}\n").steps, 25);
}

static void newmark_coefficients_are_those_of_the_method (void **state)
{
    (void) state;
    pg_solver_options o = { .dt = 0.1 };
    *PG_OWN (pg_newmark_options, &o) = (pg_newmark_options) { .beta = 0.3, .gamma = 0.55 };
    double b[8], goal[8] = { 1 / 0.003,  1 / 0.03, 1 / 0.6, 0.55 / 0.03, 0.55 / 0.3, 0.1 * (0.55 / 0.6 - 1),
                             0.1 * 0.45, 0.055 };
    pg_newmark_coefficients (&o, b);
    for (int k = 0; k < 8; k++) check_relative (b[k], goal[k], 1e-14);
}

static void break_modes_are_read (void **state)
{
    (void) state;
    pg_solver_options o = options_of (PULLED BREAKS
                                      "solver: {break: fraction, break_fraction: 5 %, max_events: 7, stop: "
                                      "{set: right, damage: 30 %, stiffness: 0}}\n");
    assert_int_equal (o.break_mode, PG_BREAK_FRACTION);
    check_relative (o.break_fraction, 0.05, 1e-15);
    assert_int_equal (o.max_events, 7);
    assert_true (PG_OWN (pg_static_options, &o)->stop_stiffness == 0);
    check_relative (o.stop_damage, 0.3, 1e-15);
    assert_int_equal (options_of (PULLED BREAKS "solver: {break: all}\n").break_mode, PG_BREAK_ALL);
}

static void faults_name_key_and_reason (void **state)
{
    (void) state;
    check_refused (PULLED "solver: {kind: newmark, end: 1}\n", "solver.dt: newmark needs a time step");
    check_refused (PULLED "solver: {kind: newmark, dt: 1}\n", "solver.end: newmark needs an end time");
    check_refused (PULLED "solver: {kind: newmark, dt: 1e-12, end: 1}\n", "time steps are too many");
    check_refused (PULLED "solver: {kind: newmark, dt: 1, end: 10, beta: 0.2, gamma: 0.5}\n",
                   "unconditionally stable only for 2 beta >= gamma");
    pg_solver_options held = options_of (HELD BREAKS "solver: {stepping: event}\n"),
                      pulled = options_of (PULLED BREAKS);
    assert_true (PG_OWN (pg_static_options, &held)->affine && !PG_OWN (pg_static_options, &pulled)->affine);
    check_refused (PLATE "boundary: [{set: left, displacement: {x: 0, y: 0}}, {set: right, traction: {x: 1}, "
                         "ramp: t^2}]\n" BREAKS "solver: {stepping: event}\n",
                   "solver.stepping = event: event stepping needs loads that grow with the load factor "
                   "(ramp: linear), stay (ramp: constant), or both: use fixed");
    check_refused (PULLED BREAKS "solver: {stepping: event, break: all}\n",
                   "solver.break = all: all goes with stepping: fixed");
    check_refused (PULLED "solver: {stop: {set: nowhere}}\n",
                   "solver.stop.set = nowhere: there is no set of this name");
    check_refused (PULLED "solver: {kind: sttaic}\n", "did you mean static");
    check_refused (PULLED "solver: {tolerance: 1}\n", "solver.tolerance");
    check_refused (PULLED "solver: {steps: 0}\n", "solver.steps");
    check_refused (PULLED "solver: {linear: mumps}\n", "solver.linear");
    check_refused ("dimension: 1\nbody: [{add: {box: {low: [0], high: [1]}}}]\nspacing: 0.1\nmaterials: {m: "
                   "{youngs_modulus: 1, poissons_ratio: 0}}\n"
                   "solver: {kind: newmark, dt: 1, end: 10}\n",
                   "newmark needs the density of material m");
}

static void unknown_solvers_are_refused (void **state)
{
    (void) state;
    built b = build (PULLED);
    pg_solver_options o;
    pg_solver *solver = NULL;
    check_ok (pg_solver_options_read (&o, b.problem, b.scene));
    o.scene = NULL;                                     /* as of a program that sets options by itself */
    size_t used = pg_memory_used ();
    strcpy (o.kind, "euler");
    check_fails (pg_solver_create (&solver, b.problem, &o), PG_E_USAGE);
    strcpy (o.kind, "static"), strcpy (o.linear, "mumps");
    check_fails (pg_solver_create (&solver, b.problem, &o), PG_E_USAGE);
    check_contains (pg_last_error (), "mumps");
    const pg_method unknown = { .name = "unknown" }, *known = b.problem->method;
    strcpy (o.linear, "auto"), b.problem->method = &unknown;
    check_fails (pg_solver_create (&solver, b.problem, &o), PG_E_USAGE);
    b.problem->method = known;
    assert_null (solver);
    assert_int_equal (pg_memory_used (), used);
    assert_string_equal (pg_solver_names (), "static|newmark|verlet|central|adr|relax");
    unbuild (&b);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (defaults_are_those_of_the_manual),
        cmocka_unit_test (stepping_follows_the_loads),
        cmocka_unit_test (steps_follow_levels_unless_given),
        cmocka_unit_test (time_steps_fill_the_run),
        cmocka_unit_test (kinds_tell_what_they_do),
        cmocka_unit_test (explicit_times_from_two_of_three),
        cmocka_unit_test (newmark_coefficients_are_those_of_the_method),
        cmocka_unit_test (break_modes_are_read),
        cmocka_unit_test (faults_name_key_and_reason),
        cmocka_unit_test (unknown_solvers_are_refused),
    };
    return cmocka_run_group_tests_name ("solve/options", tests, NULL, NULL);
}
