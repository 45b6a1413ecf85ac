/* SPDX-License-Identifier: GPL-3.0-or-later
 * output.tips: lengths and speeds of a crack that is told to run, rows, report, pictures, going on later,
 * broken memory, a real crack. */
#include "folder.h"

#define GLASS "{youngs_modulus: 72 GPa, poissons_ratio: 0.22, density: 2440 kg/m3}"
#define PLATE_OF(materials) \
    "dimension: 2\nthickness: 1 mm\nbody: [{add: {box: {low: [0, -20 mm], high: [100 mm, 20 " \
    "mm]}}}]\nspacing: 2 mm\nlattice: cells\n" \
    "materials: {glass: " GLASS materials "}\n" \
    "method: {approximation: nosb, integration: nodal, horizon: 2.5 spacing, essential: transformation}\n" \
    "failure: {criterion: stretch, critical_stretch: 0.5}\nboundary: [{set: bottom, displacement: {x: 0, " \
    "y: 0}}, {name: lid, set: top, traction: {y: 1 MPa}}]\n"
#define PLATE PLATE_OF ("")
#define WAVES PLATE "solver: {kind: newmark, dt: 0.5 us, end: 40 us}\n"
#define TIPS \
    "output: {pictures: [damage], fields: [displacement], " \
    "tips: [{name: right, from: [10 mm, 0], along: [2, 0]}, " \
    "{name: up, from: [10 mm, 0], along: [1, 0], damage: 60 %, where: y > 0}," \
    " {name: never, from: [10 mm, 0], along: [-1, 0]}, {name: just, from: [10 mm, 0], along: [1, 0], " \
    "damage: 50 %}, {name: beyond, from: [90 mm, 0], along: [1, 0]}]}\n"

/* An island of damage of 0.9 at 53 to 79 mm, which the crack does not reach: where it ends, at 49 mm, one
 * whole point is between. Damage 0.5 up to x = 30.4 mm and, from 10 us to 30 us, 1000 m/s further; above the
 * middle 0.7 with half that speed. */
static double front (double t, double speed) { return 0.0304 + speed * fmax (0, fmin (t, 30e-6) - 10e-6); }

static pg_force_type running;
static const pg_problem *body;
static int asked;
static pg_status damage (void *self, const pg_state *state, const double *d, const char *name,
                         int *components, const char **unit, double *value)
{
    if (strcmp (name, "damage") != 0)
        return pg_force_find ("galerkin")->field (self, state, d, name, components, unit, value);
    *components = 1, *unit = "";
    asked++;
    for (size_t i = 0; i < body->cloud.n; i++) {
        const double *x = body->cloud.x + 2 * i;
        value[i] = x[0] < 0.01                                         ? 0
                   : x[1] > 0 && x[0] <= front (state->time, 500)      ? 0.7
                   : x[0] <= front (state->time, 1000)                 ? 0.5
                   : x[0] > 0.052 && x[0] < 0.08 && fabs (x[1]) < 4e-3 ? 0.9
                                                                       : 0.3;
    }
    return PG_OK;
}

static run start (const char *text)
{
    run r = scene_of (1, "%s", text);
    running = *pg_force_find ("galerkin");
    running.field = damage;
    body = r.problem;
    pg_solver_free (&r.solver);
    check_ok (pg_solver_create_with (&r.solver, r.problem, &r.options, &running));
    return r;
}

static pg_status go_on (run *r, pg_result *result, int steps)
{
    pg_status status = PG_OK;
    for (int k = 0; k < steps && !pg_solver_done (r->solver, r->state); k++) {
        advance (r);
        /* something has broken as long as the front moves */
        r->state->broken = (long) (1e9 * fmin (r->state->time, 30e-6));
        if (pg_result_step (result, r->state, &r->step) != PG_OK) return PG_E_MEMORY;
    }
    return status;
}

/* Lengths are those of the lattice: centres at 1, 3, 5 ... mm. */
static double on_lattice (double x) { return floor ((x - 1e-3) / 2e-3 + 1e-9) * 2e-3 + 1e-3; }

static void lengths_and_speeds_are_those_of_the_front (void **state)
{
    (void) state;
    char where[64];
    run r = start (WAVES TIPS);
    pg_result *result = NULL;
    make_folder (where);
    check_ok (pg_result_open (&result, where, r.scene, r.problem, r.solver));
    asked = 0;
    check_ok (go_on (&r, result, 1000));
    assert_true (asked >= 60 && asked <= 62);              /* not asked again when nothing has broken; */
    check_ok (pg_result_finish (result, r.state, NULL, 0, 0));
    assert_int_equal (pg_result_pictures (result), 4);     /* damage, load-displacement, tip, tip_speed */
    assert_true (size_of (inside (where, "tip.png")) > 5000
                 && size_of (inside (where, "tip_speed.png")) > 5000);
    char *text = slurp (inside (where, "history.csv")), *report = slurp (inside (where, "report.json"));
    for (size_t k = 1; k <= 80; k++) {
        double t = 0.5e-6 * (double) k;
        check_scaled (number_at (text, k, "right [m]"), on_lattice (front (t, 1000)) - 0.01, 1e-9, 1);
        check_scaled (number_at (text, k, "up [m]"), on_lattice (front (t, 500)) - 0.01, 1e-9, 1);
        assert_true (number_at (text, k, "never [m]") == 0);
        /* damage is exactly 0.5 */
        assert_true (number_at (text, k, "just [m]") == number_at (text, k, "right [m]"));
        /* the island is the crack nearest to it, and lies behind */
        assert_true (number_at (text, k, "beyond [m]") == 0);
    }
    double rayleigh = pg_material_waves (&r.problem->material[0]).rayleigh;
    const char *at = strstr (report, "\"right\"");
    check_relative (json_number (at, NULL, "first"), 0.019, 1e-9);
    check_relative (json_number (at, NULL, "last"), 0.039, 1e-9);
    /* the front passes 31 mm at 10.6 us, 49 mm at 28.6 us: the rows after */
    check_relative (json_number (at, NULL, "started"), 11e-6, 1e-9);
    check_relative (json_number (at, NULL, "stopped"), 29e-6, 1e-9);
    check_relative (json_number (at, NULL, "mean_speed"), 1000, 0.06);
    check_relative (json_number (at, NULL, "largest_speed"), 1000, 0.12);
    check_relative (json_number (at, NULL, "rayleigh_speed"), rayleigh, 1e-12);
    check_relative (json_number (at, NULL, "mean_over_rayleigh"),
                    json_number (at, NULL, "mean_speed") / rayleigh, 1e-12);
    check_relative (json_number (strstr (report, "\"up\""), NULL, "mean_speed"), 500, 0.12);
    at = strstr (report, "\"never\"");
    assert_true (json_number (at, NULL, "last") == 0 && json_number (at, NULL, "mean_speed") == 0);
    assert_int_equal (strncmp (json_value (at, NULL, "started"), "null", 4), 0);
    pg_free (text), pg_free (report);
    pg_result_free (&result);
    remove_folder (where);
    clear (&r);
}

/* Of two materials, whichever comes first. */
static void the_faster_material_limits (void **state)
{
    (void) state;
    static const char *const text[] = {
        PLATE_OF (", zinc: {youngs_modulus: 1 GPa, poissons_ratio: 0.22, density: 7000 kg/m3}"),
        PLATE_OF (", iron: {youngs_modulus: 210 GPa, poissons_ratio: 0.22, density: 2440 kg/m3}")
    };
    for (int k = 0; k < 2; k++) {
        char where[64], whole[2048];
        snprintf (whole, sizeof whole,
                  "%sblocks: [{material: glass, where: x < 50 mm}, {material: %s, where: x >= 50 "
                  "mm}]\nsolver: {kind: newmark, dt: 2 us, end: 16 us}\n%s",
                  text[k], k ? "iron" : "zinc", TIPS);
        run r = start (whole);
        pg_result *result = NULL;
        make_folder (where);
        check_ok (pg_result_open (&result, where, r.scene, r.problem, r.solver));
        check_ok (go_on (&r, result, 100));
        check_ok (pg_result_finish (result, r.state, NULL, 0, 0));
        char *report = slurp (inside (where, "report.json"));
        assert_int_equal (r.problem->nmaterial, 2);
        check_relative (json_number (strstr (report, "\"right\""), NULL, "rayleigh_speed"),
                        pg_material_waves (&r.problem->material[k]).rayleigh, 1e-12);
        pg_free (report);
        pg_result_free (&result);
        remove_folder (where);
        clear (&r);
    }
}

static void a_resumed_run_knows_the_way_so_far (void **state)
{
    (void) state;
    char one[64], two[64];
    pg_result *result = NULL;
    pg_resumed from;
    make_folder (one), make_folder (two);
    for (int cut = 0; cut < 2; cut++) {
        run r = start (WAVES TIPS);
        check_ok (pg_result_open (&result, cut ? two : one, r.scene, r.problem, r.solver));
        check_ok (go_on (&r, result, cut ? 41 : 1000));
        if (cut) {
            check_ok (pg_result_checkpoint (result, r.state));
            check_ok (go_on (&r, result, 5));              /* rows that a killed run left */
            pg_result_free (&result);
            clear (&r);
            r = start (WAVES TIPS);
            check_ok (pg_result_resume (&result, two, r.scene, r.problem, r.solver, r.state, &from));
            assert_int_equal (from.step, 41);
            check_ok (go_on (&r, result, 1000));
        }
        check_ok (pg_result_finish (result, r.state, NULL, 0, 0));
        pg_result_free (&result);
        clear (&r);
    }
    char *a = slurp (inside (one, "history.csv")), *b = slurp (inside (two, "history.csv"));
    assert_string_equal (a, b);
    pg_free (a), pg_free (b);
    a = slurp (inside (one, "report.json")), b = slurp (inside (two, "report.json"));
    size_t length = strcspn (strstr (a, "\"tips\""), "]");
    assert_memory_equal (strstr (a, "\"tips\""), strstr (b, "\"tips\""), length);
    pg_free (a), pg_free (b);
    remove_folder (one), remove_folder (two);
}

static void broken_memory_is_told (void **state)
{
    (void) state;
    char where[64];
    run r = start (PLATE "solver: {kind: newmark, dt: 0.5 us, end: 1.5 us}\n" TIPS);
    int failed = 0, done = 0;
    for (size_t k = 1; k < 4000 && !done; k++) {
        pg_result *result = NULL;
        make_folder (where);
        pg_memory_fail_at (k);
        pg_status status = pg_result_open (&result, where, r.scene, r.problem, r.solver);
        pg_memory_fail_at (0);
        if (status != PG_OK) {
            assert_int_equal (status, PG_E_MEMORY);
            assert_null (result);
            failed++;
        } else done = 1;
        pg_result_free (&result);
        remove_folder (where);
    }
    assert_true (done && failed > 10);
    clear (&r);
}

static void must_refuse (const char *tips, const char *part)
{
    run r = scene_of (
        1,
        PLATE "output: {pictures: [], gauges: [{name: mouth, from: [0, 0], to: [0, 10 mm]}], tips: [%s]}\n",
        tips);
    check_fails (pg_result_check (r.scene, r.problem), PG_E_SCENE);
    check_contains (pg_last_error (), part);
    clear (&r);
}

static void what_makes_no_sense_is_refused (void **state)
{
    (void) state;
    must_refuse ("{name: a, from: [0, 0], along: [0, 0]}", "output.tips[0].along: must not be zero");
    must_refuse ("{name: a, from: [1, 0], along: [1, 0]}", "no point of the body lies that way");
    must_refuse ("{name: a, from: [0, 0], along: [1, 0], where: y > 1}", "where the condition holds");
    must_refuse ("{name: a, from: [0, 0], along: [1, 0], where: x > t * 1 m}", "do not change with t");
    must_refuse ("{name: mouth, from: [0, 0], along: [1, 0]}", "output.gauges[0] has this name too");
    must_refuse ("{name: broken, from: [0, 0], along: [1, 0]}",
                 "history.csv has a column of this name anyway");
    run r = scene_of (1, "dimension: 1\nbody: [{add: {box: {low: [0], high: [1]}}}]\nspacing: "
                         "0.1\nmaterials: {a: {youngs_modulus: 1, poissons_ratio: 0}}\n"
                         "boundary: [{set: left, displacement: {x: 0}}, {name: pull, set: right, "
                         "displacement: {x: 1}}]\noutput: {tips: [{name: a, from: [0], along: [1]}]}");
    check_fails (pg_result_check (r.scene, r.problem), PG_E_SCENE);
    check_contains (pg_last_error (), "nothing can break");
    clear (&r);
}

/* Pulled apart by fixed steps: the length starts at the pre-crack's and grows; no time, no speed. */
static void a_static_crack_has_a_length (void **state)
{
    (void) state;
    char where[64];
    run r = scene_of (
        1, "dimension: 2\nbody: [{add: {box: {low: [0, 0], high: [40 mm, 40 mm]}}}]\nspacing: 2 mm\nlattice: "
           "cells\ncracks: [{from: [-1 mm, 20 mm], to: [14 mm, 20 mm]}]\n"
           "materials: {glass: {youngs_modulus: 72 GPa, poissons_ratio: 0.22}}\nmethod: {approximation: "
           "nosb, integration: nodal, essential: transformation, horizon: 3.015 spacing}\n"
           "failure: {criterion: stretch, critical_stretch: 1e-3}\nboundary: [{set: bottom, displacement: "
           "{x: 0, y: 0}}, {name: lid, set: top, displacement: {y: 0.1 mm}}]\n"
           "solver: {stepping: event, max_events: 200, stop: {stiffness: 20 %%}}\n"
           "output: {pictures: [damage], "
           "tips: [{name: tip, from: [0, 20 mm], along: [1, 0], damage: 30 %%}]}\n");
    pg_result *result = NULL;
    make_folder (where);
    check_ok (pg_result_open (&result, where, r.scene, r.problem, r.solver));
    while (!pg_solver_done (r.solver, r.state)) {
        advance (&r);
        check_ok (pg_result_step (result, r.state, &r.step));
    }
    check_ok (pg_result_finish (result, r.state, NULL, 0, 0));
    char *text = slurp (inside (where, "history.csv")), *report = slurp (inside (where, "report.json"));
    size_t rows = count_lines (text) - 1;
    double first = number_at (text, 1, "tip [m]"), last = number_at (text, rows, "tip [m]"), before = 0;
    assert_true (first > 8e-3 && first < 16e-3);
    assert_true (last > first + 6e-3);
    for (size_t k = 1; k <= rows; k++) {
        double now = number_at (text, k, "tip [m]");
        assert_true (now >= before);
        before = now;
    }
    assert_true (size_of (inside (where, "tip.png")) > 5000 && size_of (inside (where, "tip_speed.png")) < 0);
    assert_null (json_value (report, "tips", "mean_speed"));
    assert_true (json_number (report, "tips", "started_at_factor") > 0);
    pg_free (text), pg_free (report);
    pg_result_free (&result);
    remove_folder (where);
    clear (&r);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (lengths_and_speeds_are_those_of_the_front),
        cmocka_unit_test (the_faster_material_limits),
        cmocka_unit_test (a_resumed_run_knows_the_way_so_far),
        cmocka_unit_test (broken_memory_is_told),
        cmocka_unit_test (what_makes_no_sense_is_refused),
        cmocka_unit_test (a_static_crack_has_a_length),
    };
    return cmocka_run_group_tests_name ("app/results/tips", tests, NULL, NULL);
}
