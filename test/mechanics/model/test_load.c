/* SPDX-License-Identifier: GPL-3.0-or-later
 * Loads and supports: values in space and time, ramps and tables, prescribed velocities, what is refused. */
#include "scenes.h"

static const double here[3] = { 0.3, 0.4, 0 };
#define NEWMARK "solver: {kind: newmark, dt: 0.01, end: 2}\n"

/* Value of component k of the only load, given as the inside of {set: right, ...}. */
static double value (const char *load, const char *rest, int k, double t)
{
    char text[1000];
    snprintf (text, sizeof text, PLATE "boundary: [{set: right, %s}]\n%s", load, rest);
    built b = build (text);
    const pg_load *l = &b.problem->boundary.load[0];
    double v = pg_load_value (l, k, 2, here, t);
    if (l->over_area > 0) v *= l->over_area;           /* a total force on a side is a traction there */
    unbuild (&b);
    return v;
}

static void a_load_grows_linearly_unless_told (void **state)
{
    (void) state;
    check_relative (value ("displacement: {x: 3 mm}", "", 0, 0.25), 0.75e-3, 1e-15);
    check_relative (value ("displacement: {x: 3 mm}", "", 0, 1), 3e-3, 1e-15);
    check_relative (value ("traction: {y: 3 MPa}, ramp: linear", "", 1, 0.5), 1.5e6, 1e-15);
    /* over the run */
    check_relative (value ("traction: {y: 3 MPa}, ramp: linear", NEWMARK, 1, 0.5), 0.75e6, 1e-15);
    check_relative (value ("traction: {y: 3 MPa}, ramp: constant", "", 1, 0), 3e6, 1e-15);
    assert_true (value ("displacement: {x: 3 mm}", "", 1, 1) == 0);
}

static void a_load_may_vary_in_space (void **state)
{
    (void) state;
    check_relative (value ("traction: {x: 2 MPa/m * y}, ramp: constant", "", 0, 1), 0.8e6, 1e-15);
    check_relative (value ("displacement: {x: r * sin(angle)}", "", 0, 1), 0.4, 1e-14);
    check_relative (value ("pressure: 5 Pa/m * x", "", 0, 1), 1.5, 1e-14);
}

/* The angle of a place runs from 0 along x over a quarter along y to a whole turn. */
static void angles_are_those_of_a_whole_turn (void **state)
{
    (void) state;
    for (int k = 0; k < 12; k++) {
        double a = (k + 0.5) * 3.14159265358979323846 / 6, x[2] = { 2 * cos (a), 2 * sin (a) };
        pg_place at = pg_place_of (2, x, 0);
        check_relative (at.angle, a, 1e-14);
        check_relative (at.r, 2, 1e-14);
    }
}

static void a_ramp_is_an_expression_in_t (void **state)
{
    (void) state;
    check_relative (value ("force: {x: 2 N}, ramp: t^2", "", 0, 0.5), 0.5, 1e-15);
    check_relative (value ("force: {x: 2 N}, ramp: sin(3*t)", NEWMARK, 0, 1.7), 2 * sin (5.1), 1e-14);
    check_relative (value ("displacement: {x: 1 mm * t^3}, ramp: constant", NEWMARK, 0, 1.5), 3.375e-3,
                    1e-14);
}

static void a_table_is_linear_between_and_constant_beyond (void **state)
{
    (void) state;
    const char *load = "force: {x: 2 N}, table: [[0.5, 1], [1, 3], [2, -1]]";
    static const double t[] = { 0, 0.5, 0.75, 1, 1.25, 2, 5 }, factor[] = { 1, 1, 2, 3, 2, -1, -1 };
    for (int i = 0; i < 7; i++) check_relative (value (load, NEWMARK, 0, t[i]), 2 * factor[i], 1e-14);
}

static void a_velocity_is_integrated (void **state)
{
    (void) state;
    for (double t = 0; t < 2.1; t += 0.25) {
        check_absolute (value ("velocity: {x: 3 m/s}", NEWMARK, 0, t), 3 * t, 1e-14);
        check_absolute (value ("velocity: {x: 3 m/s}, ramp: linear", NEWMARK, 0, t), 3 * t * t / 4, 1e-14);
    }
}

static double table_velocity (double t)
{
    return t < 0.5 ? 1 : t < 1 ? 1 + 4 * (t - 0.5) : t < 2 ? 3 - 4 * (t - 1) : -1;
}

static void a_velocity_table_is_integrated (void **state)
{
    (void) state;
    const char *load = "velocity: {x: 2 m/s}, table: [[0.5, 1], [1, 3], [2, -1]]";
    double sum = 0, step = 0.125;  /* breaks of the table fall on steps: the trapezium rule is exact */
    for (double t = 0; t < 4; t += step) {
        check_absolute (value (load, NEWMARK, 0, t), 2 * sum, 1e-13);
        sum += 0.5 * step * (table_velocity (t) + table_velocity (t + step));
    }
    /* a table that starts before the run: what lies before t = 0 does not count */
    check_absolute (value ("velocity: {x: 2 m/s}, table: [[-1, 0], [1, 2]]", NEWMARK, 0, 1), 2 * 1.5, 1e-14);
    assert_true (value ("velocity: {x: 2 m/s}, table: [[-1, 0], [1, 2]]", NEWMARK, 0, 0) == 0);
}

static int proportional (const char *loads)
{
    char text[1000];
    snprintf (text, sizeof text, PLATE "boundary: [%s]\n", loads);
    built b = build (text);
    int is = pg_problem_proportional (b.problem);
    unbuild (&b);
    return is;
}

static void proportional_loads_are_recognised (void **state)
{
    (void) state;
    assert_true (proportional ("{set: right, traction: {x: 1}}"));
    assert_true (proportional (
        "{set: left, displacement: {x: 0, y: 0}, ramp: constant}, {set: right, displacement: {x: y}}"));
    assert_false (proportional (
        "{set: left, displacement: {x: 1e-30}, ramp: constant}, {set: right, traction: {x: 1}}"));
    assert_false (proportional ("{set: right, traction: {x: 1}, ramp: constant}"));
    assert_false (proportional ("{set: right, traction: {x: 1 Pa * t}}"));
    assert_false (proportional ("{set: right, traction: {x: 1}, ramp: t^2}"));
    assert_false (proportional ("{set: right, traction: {x: 1}, table: [[0, 0], [1, 2]]}"));
    assert_false (proportional ("{set: all, body_force: {x: 1}, ramp: constant}"));
}

static void the_way_of_prescribing_follows_the_method (void **state)
{
    (void) state;
    static const struct { const char *rest; pg_essential how; } cases[] = {
        { "", PG_ESSENTIAL_NITSCHE }, { "method: {essential: penalty}\n", PG_ESSENTIAL_PENALTY },
        { "method: {essential: transformation}\n", PG_ESSENTIAL_TRANSFORMATION },
        { "method: {approximation: nosb, integration: nodal}\n", PG_ESSENTIAL_TRANSFORMATION },
    };
    for (int i = 0; i < 4; i++) {
        char text[1000];
        snprintf (text, sizeof text, PLATE "boundary: [{set: right, displacement: {x: 1}}]\n%s",
                  cases[i].rest);
        built b = build (text);
        assert_int_equal (b.problem->boundary.load[0].essential, cases[i].how);
        unbuild (&b);
    }
    built b = build (
        PLATE
        "sets: {mid: {where: \"abs(x - 0.5) < 0.01\"}}\nboundary: [{set: mid, displacement: {x: 1}}]\n");
    /* points inside have no facet */
    assert_int_equal (b.problem->boundary.load[0].essential, PG_ESSENTIAL_TRANSFORMATION);
    unbuild (&b);
}

static void an_entry_may_choose_its_own_way (void **state)
{
    (void) state;
    built b = build (PLATE "method: {essential: nitsche}\nboundary: [{set: right, displacement: {x: 1}, "
                           "essential: penalty}, {set: left, displacement: {x: 0}}]\n");
    assert_int_equal (b.problem->boundary.load[0].essential, PG_ESSENTIAL_PENALTY);
    assert_int_equal (b.problem->boundary.load[1].essential, PG_ESSENTIAL_NITSCHE);
    unbuild (&b);
    check_refused (PLATE "boundary: [{set: right, displacement: {x: 1}, essential: penalti}]\n",
                   "boundary[0].essential");
}

static void faults_name_key_and_reason (void **state)
{
    (void) state;
#define LOAD(inside) PLATE "boundary: [{" inside "}]\n"
    check_refused (LOAD ("set: rigth, displacement: {x: 1}"),
                   "boundary[0].set = rigth: there is no set of this name (did you mean right?)");
    check_refused (LOAD ("set: right, displacement: {z: 1}"),
                   "boundary[0].displacement.z = 1: a 2D body has no such component");
    check_refused (LOAD ("set: right, displacement: {}"), "at least one component");
    check_refused (LOAD ("set: right, traction: {x: 1 mm}"), "boundary[0].traction.x");
    check_refused (LOAD ("set: right, velocity: {x: 1 m/s}"), "a static run has no velocity");
    check_refused (LOAD ("set: right, traction: {x: 1}, table: [[0, 0], [0, 1]]"), "t must increase");
    check_refused (LOAD ("set: right, traction: {x: 1}, table: [[0, 0, 1]]"), "boundary[0].table[0]");
    check_refused (LOAD ("set: right, traction: {x: 1}, table: []"), "at least one pair");
    check_refused (LOAD ("set: right, traction: {x: 1}, table: [[0, 0]], ramp: linear"), "at most one");
    check_refused (LOAD ("set: right, traction: {x: 1}, pressure: 1"), "exactly one");
    check_refused (LOAD ("set: right"), "exactly one");
    check_refused (LOAD ("set: right, traction: {x: 1}, ramp: linaer"), "boundary[0].ramp = linaer");
    check_refused (
        PLATE "sets: {mid: {where: \"abs(x - 0.5) < 0.01\"}}\nboundary: [{set: mid, traction: {x: 1}}]\n",
        "holds no boundary facet");
    check_refused (LOAD ("set: right, velocity: {x: 1 m/s * t}") NEWMARK, "may not depend on t");
    check_refused (LOAD ("set: right, velocity: {x: 1 m/s}, ramp: t^2") NEWMARK,
                   "a velocity takes ramp constant or linear");
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (a_load_grows_linearly_unless_told),
        cmocka_unit_test (a_load_may_vary_in_space),
        cmocka_unit_test (angles_are_those_of_a_whole_turn),
        cmocka_unit_test (a_ramp_is_an_expression_in_t),
        cmocka_unit_test (a_table_is_linear_between_and_constant_beyond),
        cmocka_unit_test (a_velocity_is_integrated),
        cmocka_unit_test (a_velocity_table_is_integrated),
        cmocka_unit_test (proportional_loads_are_recognised),
        cmocka_unit_test (the_way_of_prescribing_follows_the_method),
        cmocka_unit_test (an_entry_may_choose_its_own_way),
        cmocka_unit_test (faults_name_key_and_reason),
    };
    return cmocka_run_group_tests_name ("mechanics/model/load", tests, NULL, NULL);
}
