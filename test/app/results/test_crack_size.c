/* SPDX-License-Identifier: GPL-3.0-or-later
 * output.crack_size: a plate that is cut from side to side has a crack as long as its ligament, by bonds and
 * by points; the column is 0 before anything breaks, never falls and ends at what report.json says; without
 * the key there is no such column. A plate under forces that comes apart: energies of its last row. */
#include "folder.h"

#define PLATE \
    "dimension: 2\nthickness: 1 mm\nbody: [{add: {box: {low: [-20 mm, -20 mm], high: [20 mm, 20 mm]}}}]\n" \
    "spacing: 1 mm\nlattice: cells\n" \
    "materials: {rock: {youngs_modulus: 30 GPa, poissons_ratio: 0.333333333333333}}\n"
#define PULLED \
    "cracks: [{from: [-20 mm, 0], to: [-8 mm, 0]}]\n" \
    "boundary: [{name: top, set: top, displacement: {y: 30 um}}, " \
    "{name: bottom, set: bottom, displacement: {x: 0, y: -30 um}}]\nsolver: {kind: adr, stages: 50}\n"
#define SIZE(on) \
    "output: {pictures: [], fields: [damage], estimate: off, crack_size: " on ", at: {levels: 1}}\n"
#define BONDS \
    "method: {force: bond}\nfailure: {criterion: stretch, fracture_energy: 110 J/m2}\n"
#define POINTS \
    "method: {force: fcbm, evaluation: stencil}\n" \
    "failure: {criterion: node_energy, fracture_energy: 110 J/m2}\n"

typedef struct { double before, last, told; int falls, column; } course;

/* The column of a name in the first row of a table; -1: none. */
static int place_of (const char *table, const char *name)
{
    for (size_t k = 0; k < 80; k++) {
        const char *head = cell (table, 0, k);
        if (strncmp (head, name, strlen (name)) == 0) return (int) k;
        if (strncmp (head, "level", 5) == 0) break;
    }
    return -1;
}

static double number_after (const char *text, const char *key)
{
    const char *at = strstr (text, key);
    assert_non_null (at);
    return strtod (at + strlen (key), NULL);
}

/* Runs a scene; its history.csv and report.json, to be freed. */
static void play (const char *text, char **history, char **report)
{
    char where[64];
    run r = scene_of (1, "%s", text);
    pg_result *result = NULL;
    make_folder (where);
    check_ok (pg_result_open (&result, where, r.scene, r.problem, r.solver));
    while (!pg_solver_done (r.solver, r.state)) {
        advance (&r);
        check_ok (pg_result_step (result, r.state, &r.step));
    }
    check_ok (pg_result_finish (result, r.state, NULL, 0, 0));
    *history = slurp (inside (where, "history.csv")), *report = slurp (inside (where, "report.json"));
    pg_result_free (&result);
    clear (&r);
    remove_folder (where);
}

static course follow (const char *text)
{
    char *history, *report;
    course c = { .before = NAN };
    play (text, &history, &report);
    c.column = place_of (history, "crack.length [m]");
    for (size_t i = 1, n = count_lines (history); c.column >= 0 && i < n; i++) {
        double broken = strtod (cell (history, i, (size_t) place_of (history, "broken [1]")), NULL);
        double now = strtod (cell (history, i, (size_t) c.column), NULL);
        if (broken == 0) c.before = now;
        if (i > 1 && now < c.last) c.falls = 1;
        c.last = now;
    }
    if (c.column >= 0) c.told = number_after (strstr (report, "\"new_crack\""), "\"length\":");
    pg_free (history), pg_free (report);
    return c;
}

/* The ligament is 28 mm wide. */
static void length_of_a_cut (void **unused)
{
    (void) unused;
    static const char *const scene[2] = { PLATE PULLED BONDS SIZE ("on"), PLATE PULLED POINTS SIZE ("on") };
    for (int k = 0; k < 2; k++) {
        course c = follow (scene[k]);
        print_message ("%s: %.2f mm\n", k ? "points" : "bonds", 1e3 * c.last);
        assert_true (c.column >= 0 && c.before == 0 && !c.falls);
        check_relative (c.told, c.last, 1e-12);
        /* bonds that break side by side count as often as they are */
        check_relative (c.last, k ? 28e-3 : 38e-3, k ? .1 : .3);
    }
    assert_int_equal (follow (PLATE PULLED BONDS SIZE ("off")).column, -1);
}

/* Two tractions; corners below are held, the upper part flies away. No energies of the rounding of K. */
static void comes_apart (void **unused)
{
    (void) unused;
    char *history, *report;
    play (PLATE
          "cracks: [{from: [-8.2 mm, -4.1 mm], to: [8.2 mm, 4.1 mm]}]\n"
          "method: {approximation: rkpm, integration: gauss}\n"
          "failure: {criterion: energy_release, fracture_energy: 110 J/m2}\n"
          "sets: {left_corner: {where: x < -19.4 mm and y < -19.4 mm}, "
          "right_corner: {where: x > 19.4 mm and y < -19.4 mm}}\n"
          "boundary: [{name: top, set: top, traction: {y: 10 MPa}}, "
          "{name: bottom, set: bottom, traction: {y: -10 MPa}}, "
          "{name: pin, set: left_corner, essential: penalty, displacement: {x: 0, y: 0}}, "
          "{name: roller, set: right_corner, essential: penalty, displacement: {y: 0}}]\n"
          "solver: {kind: static}\n" SIZE ("off"),
          &history, &report);
    size_t n = count_lines (history), last = n - 1;
    double strain = strtod (cell (history, last, (size_t) place_of (history, "energy_strain")), NULL),
           work = strtod (cell (history, last, (size_t) place_of (history, "energy_external")), NULL),
           spent = strtod (cell (history, last, (size_t) place_of (history, "energy_dissipated")), NULL),
           grown = strtod (cell (history, last, (size_t) place_of (history, "crack.length")), NULL);
    print_message ("strain %.3g, work %.3g, dissipated %.3g J; G0 times the area %.3g J\n", strain, work,
                   spent, 110 * grown * 1e-3);
    assert_true (strstr (report, "the body has separated") || strstr (report, "off from its supports"));
    check_below (strain, work);
    check_relative (spent, work - strain, 1e-9);
    check_relative (spent, 110 * grown * 1e-3, .2);
    pg_free (history), pg_free (report);
}

int main (void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test (length_of_a_cut), cmocka_unit_test (comes_apart) };
    return cmocka_run_group_tests (tests, NULL, NULL);
}
