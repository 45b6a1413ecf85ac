/* SPDX-License-Identifier: GPL-3.0-or-later
 * The result folder: every file with its columns and keys, rows that agree with the steps, fields at the
 * levels asked for, a folder that cannot be made, a report that is written although the run has failed. */
#include "folder.h"
#include <fcntl.h>
#include <unistd.h>
#include "io/picture/fonts.h"

static const char scene_text[] =
    "title: Plate with an edge crack\ndimension: 2\nthickness: 0.1\nbody: [{add: {box: {low: [0, 0], high: "
    "[1, 1]}}}]\nspacing: 0.1\n"
    "cracks: [{from: [-0.1, 0.55], to: [0.35, 0.55]}]\nmaterials: {rock: {youngs_modulus: 1 GPa, "
    "poissons_ratio: 0.2}}\n"
    "failure: {criterion: stretch, critical_stretch: 1e-3, exclude: [bottom, top]}\n"
    "boundary: [{name: foot, set: bottom, displacement: {x: 0, y: 0}}, {name: head, set: top, displacement: "
    "{y: 1 mm}}]\n"
    "solver: {kind: static, stepping: event, max_events: 12, break: fraction, break_fraction: 5 %}\n"
    "output: {at: {levels: 10, events: 5}, fields: [displacement, damage, stress], pictures: [damage, "
    "displacement, stress.yy],\n"
    "  gauges: [{name: mouth, from: [0, 0.5], to: [0, 0.6]}]}\n";

/* One run for all tests, its steps kept. */
enum { MOST = 200 };
static char folder[64];
static double finishing;                                   /* seconds that finishing the result took */
static run r;
static pg_step steps[MOST];
static double opening[MOST], reaction[MOST][6];
static size_t nstep, nbroken, nfield_step, npicture;
static double field_time[MOST], *last_stress;

static void keep_step (void)
{
    void *self;
    const pg_force_type *force = pg_solver_force (r.solver, &self);
    double a[3], b[3];
    assert_true (nstep < MOST);
    check_ok (force->sample (self, r.state, r.state->d, 1, r.problem->boundary.gauge[0].from, a, NULL, NULL));
    check_ok (force->sample (self, r.state, r.state->d, 1, r.problem->boundary.gauge[0].to, b, NULL, NULL));
    opening[nstep] = b[1] - a[1];
    memcpy (reaction[nstep], r.step.reaction, sizeof reaction[nstep]);
    nbroken += r.step.nbroken;
    if (r.step.level || (r.step.event && r.state->events % 5 == 0)) field_time[nfield_step++] = r.step.stamp;
    steps[nstep++] = r.step;
}

static int open_all (void **state)
{
    pg_result *result = NULL;
    char deep[128];
    (void) state;
    make_folder (folder);
    snprintf (deep, sizeof deep, "%s/a/b", folder);
    r = prepare (1, scene_text);
    check_ok (pg_result_open (&result, deep, r.scene, r.problem, r.solver));
    assert_string_equal (pg_result_folder (result), deep);
    while (!pg_solver_done (r.solver, r.state)) {
        advance (&r);
        check_ok (pg_result_step (result, r.state, &r.step));
        keep_step ();
    }
    finishing = pg_seconds ();
    check_ok (pg_result_finish (result, r.state, NULL, 0.25, 3.5));
    finishing = pg_seconds () - finishing;
    if (!(steps[nstep - 1].level || (steps[nstep - 1].event && r.state->events % 5 == 0)))
        field_time[nfield_step++] = r.step.stamp;
    npicture = pg_result_pictures (result);
    for (size_t i = 0; i < npicture; i++) assert_true (size_of (pg_result_picture (result, i)) > 1000);
    assert_null (pg_result_picture (result, npicture));
    pg_result_free (&result);
    assert_null (result);
    last_stress = field_of (&r, NULL, "stress", NULL);
    strcpy (folder, deep);
    return 0;
}

static int close_all (void **state)
{
    (void) state;
    folder[strlen (folder) - strlen ("/a/b")] = 0;
    remove_folder (folder);
    pg_free (last_stress);
    clear (&r);
    return 0;
}

static void the_folder_is_complete (void **state)
{
    static const char *const names[] = { "result.e",         "history.csv",   "events.csv",
                                         "report.json",      "scene.yaml",    "damage.png",
                                         "displacement.png", "stress.yy.png", "load_displacement.png" };
    (void) state;
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        if (size_of (inside (folder, names[i])) <= 0) print_error ("%s is missing or empty\n", names[i]);
        assert_true (size_of (inside (folder, names[i])) > 0);
    }
    assert_int_equal (npicture, 4);
    assert_int_equal (size_of (inside (folder, "report.json.tmp")), -1);
    char *copy = slurp (inside (folder, "scene.yaml"));
    assert_memory_equal (copy, scene_text, strlen (scene_text));
    assert_string_equal (copy + strlen (scene_text), "\n# copied by perigal run from test.yaml\n");
    pg_free (copy);
}

static void the_history_has_its_columns (void **state)
{
    static const char header[] =
        "step [1],time [s],load_factor [1],foot.force_x [N],foot.displacement_x [m],foot.force_y "
        "[N],foot.displacement_y [m],foot.moment_z [N m],"
        "head.force_x [N],head.displacement_x [m],head.force_y [N],head.displacement_y [m],"
        "head.moment_z [N m],mouth [m],"
        "energy_strain [J],energy_kinetic [J],energy_external [J],energy_dissipated [J],broken "
        "[1],iterations [1],residual [1],utilisation [1],event [1],level [1]\n";
    (void) state;
    char *text = slurp (inside (folder, "history.csv"));
    assert_int_equal (strncmp (text, header, strlen (header)), 0);
    pg_free (text);
}

static void the_history_has_a_row_a_step (void **state)
{
    (void) state;
    char *text = slurp (inside (folder, "history.csv"));
    size_t broken = 0;
    assert_true (nstep > 12);
    assert_int_equal (count_lines (text), nstep + 1);
    for (size_t k = 0; k < nstep; k++) {
        broken += steps[k].nbroken;
        check_relative (number_at (text, k + 1, "step [1]"), (double) (k + 1), 0);
        check_relative (number_at (text, k + 1, "load_factor [1]"), steps[k].factor, 1e-15);
        check_relative (number_at (text, k + 1, "foot.force_y [N]"), reaction[k][1], 1e-15);
        check_relative (number_at (text, k + 1, "head.force_y [N]"), reaction[k][4], 1e-15);
        check_relative (number_at (text, k + 1, "head.force_y [N]"), -reaction[k][1], 1e-8);
        check_scaled (number_at (text, k + 1, "head.displacement_y [m]"), 1e-3 * steps[k].factor, 0.02,
                      1e-3 * steps[k].factor);
        check_relative (number_at (text, k + 1, "mouth [m]"), opening[k], 1e-14);
        check_relative (number_at (text, k + 1, "broken [1]"), (double) broken, 0);
        check_relative (number_at (text, k + 1, "iterations [1]"), (double) steps[k].iterations, 0);
        check_relative (number_at (text, k + 1, "residual [1]"), steps[k].residual, 1e-15);
        check_relative (number_at (text, k + 1, "utilisation [1]"), steps[k].utilisation, 1e-15);
        check_relative (number_at (text, k + 1, "event [1]"), steps[k].event, 0);
        check_relative (number_at (text, k + 1, "level [1]"), steps[k].level, 0);
        assert_true (number_at (text, k + 1, "energy_external [J]") > 0
                     && number_at (text, k + 1, "mouth [m]") > 0);
    }
    pg_free (text);
}

static void the_events_have_a_row_a_bond (void **state)
{
    (void) state;
    char *text = slurp (inside (folder, "events.csv"));
    size_t row = 1;
    static const char header[] = "step [1],load_factor [1],time [s],x [m],y [m],z [m],utilisation "
                                 "[1],energy_of_step [J],bond_code [1],kind_code [1],"
                                 "bond [name],kind [name]\n";
    assert_int_equal (strncmp (text, header, strlen (header)), 0);
    assert_true (nbroken > 12);
    assert_int_equal (count_lines (text), nbroken + 1);
    for (size_t k = 0; k < nstep; k++) {
        double energy = 0;
        for (size_t b = 0; b < steps[k].nbroken; b++, row++) {
            energy += number_at (text, row, "energy_of_step [J]");     /* of all bonds of the step together */
            check_relative (number_at (text, row, "step [1]"), (double) (k + 1), 0);
            check_relative (number_at (text, row, "load_factor [1]"), steps[k].factor, 1e-9);
            check_relative (number_at (text, row, "utilisation [1]"), 1, 0.0501);
            assert_true (number_at (text, row, "x [m]") > 0.2
                         && fabs (number_at (text, row, "y [m]") - 0.55) < 0.2);
            assert_string_equal (cell (text, row, column_of (text, "kind [name]")), "tension");
            const char *set = cell (text, row, column_of (text, "bond [name]"));
            assert_true (strcmp (set, "node-node") == 0 || strcmp (set, "point-node") == 0);
            check_relative (number_at (text, row, "bond_code [1]"), strcmp (set, "point-node") == 0, 0);
            check_relative (number_at (text, row, "kind_code [1]"), 0, 0);
            for (size_t c = 0; c < 10; c++) {          /* numbers before the names */
                const char *number = cell (text, row, c);
                assert_int_equal (strspn (number, "0123456789.e+-"), strlen (number));
            }
        }
        if (steps[k].nbroken) check_relative (energy, steps[k].dissipated, 1e-9);
    }
    pg_free (text);
}

static void fields_are_written_at_levels_and_events (void **state)
{
    (void) state;
    pg_cloud cloud = { 0 };
    size_t n, count;
    int components;
    double *time = NULL, *value = NULL;
    char unit[16], (*names)[32] = NULL;
    check_ok (pg_exodus_points (inside (folder, "result.e"), &cloud, &n, &time));
    assert_int_equal (cloud.n, r.problem->cloud.n);
    assert_int_equal (n, nfield_step);
    for (size_t k = 0; k < n; k++) check_relative (time[k], field_time[k], 1e-15);
    check_ok (pg_exodus_fields (inside (folder, "result.e"), &names, &count));
    assert_int_equal (count, 5);
    for (size_t k = 0; k < 5; k++)
        assert_string_equal (names[k], ((const char *[]){ "displacement", "damage", "stress", "coefficient",
                                                          "volume" })[k]);
    check_ok (pg_exodus_read (inside (folder, "result.e"), "stress", -1, &count, &components, &value));
    assert_int_equal (count, cloud.n);
    assert_int_equal (components, 3);
    double top = largest_of (last_stress, 3 * count);
    check_below (largest_difference (value, last_stress, 3 * count), 1e-6 * top);
    check_ok (pg_exodus_unit (inside (folder, "result.e"), "stress", unit));
    assert_string_equal (unit, "Pa");
    pg_free (time), pg_free (value), pg_free (names);
    pg_cloud_clear (&cloud);
}

static void the_report_has_its_keys (void **state)
{
    static const char *const keys[] = { "version",
                                        "scene",
                                        "scene_sha256",
                                        "points",
                                        "bonds",
                                        "dofs",
                                        "steps",
                                        "events",
                                        "iterations",
                                        "broken",
                                        "bonds_over_limit",
                                        "utilisation_max",
                                        "residual_max",
                                        "factorizations",
                                        "updates",
                                        "solves",
                                        "cg_iterations",
                                        "degenerate_points",
                                        "fragments",
                                        "energy",
                                        "seconds",
                                        "peak_bytes",
                                        "threads",
                                        "skipped",
                                        "warnings" };
    static const char *const energies[] = { "strain", "kinetic", "external", "dissipated" };
    static const char *const phases[] = { "search", "shape", "assemble", "analyse", "factor", "update",
                                          "solve",  "force", "break",    "write",   "total" };
    (void) state;
    char *text = slurp (inside (folder, "report.json"));
    for (size_t i = 0; i < sizeof keys / sizeof *keys; i++) {
        if (!json_value (text, NULL, keys[i])) print_error ("report.json lacks %s\n", keys[i]);
        assert_non_null (json_value (text, NULL, keys[i]));
    }
    for (size_t i = 0; i < sizeof energies / sizeof *energies; i++) json_number (text, "energy", energies[i]);
    for (size_t i = 0; i < sizeof phases / sizeof *phases; i++)
        assert_true (json_number (text, "seconds", phases[i]) >= 0);
    pg_free (text);
}

static void the_report_tells_what_happened (void **state)
{
    (void) state;
    char *text = slurp (inside (folder, "report.json"));
    const pg_statistics *report = pg_solver_report_now (r.solver);
    check_relative (json_number (text, NULL, "points"), 121, 0);
    check_relative (json_number (text, NULL, "dofs"), 242, 0);
    check_relative (json_number (text, NULL, "bonds"), (double) r.problem->bonds.first[PG_BOND_SETS], 0);
    check_relative (json_number (text, NULL, "steps"), (double) nstep, 0);
    check_relative (json_number (text, NULL, "events"), 12, 0);
    check_relative (json_number (text, NULL, "broken"), (double) nbroken, 0);
    check_relative (json_number (text, NULL, "updates"), 12, 0);
    check_relative (json_number (text, "energy", "external"), report->energy.external, 1e-12);
    check_relative (json_number (text, "seconds", "search"), 0.25, 1e-15);
    /* what finishing took is added to the seconds before it, no more than that */
    assert_true (json_number (text, "seconds", "total") > 3.5);
    assert_true (json_number (text, "seconds", "total") <= (3.5 + finishing) * (1 + 1e-6));
    assert_true (json_number (text, "seconds", "update") > 0
                 && json_number (text, "seconds", "assemble") > 0);
    check_contains (json_value (text, NULL, "scene_sha256"), pg_scene_hash (r.scene));
    check_contains (json_value (text, NULL, "warnings"), "max_events = 12");
    assert_int_equal (strncmp (json_value (text, NULL, "outcome"), "\"done\"", 6), 0);
    check_below (json_number (text, NULL, "residual_max"), 1e-8);
    pg_free (text);
}

/* Bonds that break within a row of several time steps: the load factor of each is that of its own time, not
 * of the row. */
static void bonds_break_at_their_own_time (void **state)
{
    (void) state;
    char where[64];
    pg_result *result = NULL;
    size_t broken = 0, within = 0;
    make_folder (where);
    run m = prepare (
        1, "dimension: 2\nthickness: 0.1\nbody: [{add: {box: {low: [0, 0], high: [1, 0.6]}}}]\nspacing: 0.1\n"
           "materials: {rock: {youngs_modulus: 1 GPa, poissons_ratio: 0.3333, density: 2000}}\nmethod: "
           "{force: bond}\n"
           "failure: {criterion: stretch, critical_stretch: 1e-3, exclude: [left, right]}\n"
           "boundary: [{set: left, velocity: {x: -2 m/s}}, {set: right, velocity: {x: 2 m/s}}]\n"
           "solver: {kind: verlet, dt: 20 us, end: 2 ms}\noutput: {at: {rows: 4}, pictures: []}\n");
    check_ok (pg_result_open (&result, where, m.scene, m.problem, m.solver));
    while (!pg_solver_done (m.solver, m.state)) {
        advance (&m);
        check_ok (pg_result_step (result, m.state, &m.step));
    }
    pg_result_free (&result);
    char *events = slurp (inside (where, "events.csv")), *history = slurp (inside (where, "history.csv"));
    double end = pg_solver_settled (m.solver)->end;
    for (size_t row = 1; row < count_lines (events); row++, broken++) {
        size_t step = (size_t) number_at (events, row, "step [1]");
        double time = number_at (events, row, "time [s]"), last = number_at (history, step, "time [s]");
        assert_true (time <= last * (1 + 1e-9)
                     && (step == 1 || time > number_at (history, step - 1, "time [s]")));
        check_relative (number_at (events, row, "load_factor [1]"), time / end, 1e-8);
        within += time < 0.999 * last;
    }
    assert_true (broken > 10 && within > 5);
    pg_free (events), pg_free (history);
    clear (&m);
    remove_folder (where);
}

/* The device that is always full in the place of one of the two tables, which are then open: the step is not
 * taken for written. */
static void a_row_that_cannot_be_written_is_told (void **state)
{
    (void) state;
    static const char *const name[] = { "history.csv", "events.csv" };
    for (int which = 0; which < 2; which++) {
        char where[64], link[64], path[256];
        pg_result *result = NULL;
        make_folder (where);
        run f = prepare (1, scene_text);
        check_ok (pg_result_open (&result, where, f.scene, f.problem, f.solver));
        int full = open ("/dev/full", O_WRONLY), found = 0;
        assert_true (full >= 0);
        for (int file = 3; file < 256; file++) {
            snprintf (link, sizeof link, "/proc/self/fd/%d", file);
            ssize_t n = readlink (link, path, sizeof path - 1);
            if (n <= 0) continue;
            path[n] = 0;
            if (strstr (path, where) && strstr (path, name[which])) found += dup2 (full, file) == file;
        }
        close (full);
        assert_int_equal (found, 1);
        pg_status status = PG_OK;
        while (status == PG_OK && !pg_solver_done (f.solver, f.state)) {
            advance (&f);
            status = pg_result_step (result, f.state, &f.step);
        }
        assert_int_equal (status, PG_E_FILE);
        check_contains (pg_last_error (), name[which]);
        check_contains (pg_last_error (), "No space left");
        pg_result_free (&result);
        clear (&f);
        remove_folder (where);
    }
}

/* ---- what goes wrong ----------------------------------------------------------------------------------- */
static void a_folder_that_cannot_be_made_is_refused (void **state)
{
    (void) state;
    pg_result *result = NULL;
    size_t used = pg_memory_used ();
    char path[256];
    snprintf (path, sizeof path, "%s/report.json/inside", folder);     /* a file is in the way */
    check_fails (pg_result_open (&result, path, r.scene, r.problem, r.solver), PG_E_FILE);
    check_contains (pg_last_error (), path);
    assert_null (result);
    snprintf (path, sizeof path, "%s/taken", folder);
    assert_int_equal (mkdir (path, 0777), 0);
    snprintf (path, sizeof path, "%s/taken/history.csv", folder);
    assert_int_equal (mkdir (path, 0777), 0);                           /* a folder is in the way of a file */
    snprintf (path, sizeof path, "%s/taken", folder);
    check_fails (pg_result_open (&result, path, r.scene, r.problem, r.solver), PG_E_FILE);
    assert_null (result);
    assert_int_equal (pg_memory_used (), used);
}

static void a_failed_run_leaves_its_report (void **state)
{
    (void) state;
    char where[64];
    pg_result *result = NULL;
    make_folder (where);
    run f = prepare (1, scene_text);
    check_ok (pg_result_open (&result, where, f.scene, f.problem, f.solver));
    advance (&f);
    check_ok (pg_result_step (result, f.state, &f.step));
    check_ok (pg_result_finish (result, f.state, "step 2 is refused: \"too hard\"", 0, 1));
    pg_result_free (&result);
    char *text = slurp (inside (where, "report.json"));
    check_contains (json_value (text, NULL, "outcome"), "step 2 is refused: \\\"too hard\\\"");
    pg_free (text);
    text = slurp (inside (where, "history.csv"));
    assert_int_equal (count_lines (text), 2);
    pg_free (text);
    clear (&f);
    remove_folder (where);
}

static void a_picture_that_fails_costs_a_warning_and_nothing_else (void **state)
{
    (void) state;
    char where[64];
    pg_result *result = NULL;
    make_folder (where);
    run f = prepare (1, scene_text);
    check_ok (pg_result_open (&result, where, f.scene, f.problem, f.solver));
    advance (&f);
    check_ok (pg_result_step (result, f.state, &f.step));
    assert_int_equal (mkdir (inside (where, "damage.png"), 0777), 0);
    check_ok (pg_result_finish (result, f.state, NULL, 0, 1));
    pg_result_free (&result);
    char *text = slurp (inside (where, "report.json"));
    check_contains (text, "pictures could not be drawn, damage.png among them: ");
    check_contains (text, "\"outcome\": \"done\"");
    assert_null (strstr (strstr (text, "pictures could not be drawn") + 1, "pictures could not be drawn"));
    pg_free (text);
    clear (&f);
    remove_folder (where);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (the_folder_is_complete),
        cmocka_unit_test (the_history_has_its_columns),
        cmocka_unit_test (the_history_has_a_row_a_step),
        cmocka_unit_test (the_events_have_a_row_a_bond),
        cmocka_unit_test (bonds_break_at_their_own_time),
        cmocka_unit_test (a_row_that_cannot_be_written_is_told),
        cmocka_unit_test (fields_are_written_at_levels_and_events),
        cmocka_unit_test (the_report_has_its_keys),
        cmocka_unit_test (the_report_tells_what_happened),
        cmocka_unit_test (a_folder_that_cannot_be_made_is_refused),
        cmocka_unit_test (a_failed_run_leaves_its_report),
        cmocka_unit_test (a_picture_that_fails_costs_a_warning_and_nothing_else),
    };
    return cmocka_run_group_tests_name ("app/results/result", tests, open_all, close_all);
}
