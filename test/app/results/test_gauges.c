/* SPDX-License-Identifier: GPL-3.0-or-later
 * Gauges across cracks: an end beside a crack takes the displacement of its own face, however near the crack
 * it lies and on whatever side the nearest point is. */
#include "folder.h"

#define GAUGES \
    "output: {at: {levels: 1}, pictures: [], estimate: off, gauges: [{name: hair, from: [%s-1e-9%s], to: " \
    "[%s1e-9%s]}, " \
    "{name: near, from: [%s-0.02%s], to: [%s0.02%s]}, {name: far, from: [%s-0.075%s], to: [%s0.075%s]}]}\n"
#define SQUARE \
    "dimension: 2\nthickness: 1\nbody: [{add: {box: {low: [0, -1], high: [1, 1]}}}]\nspacing: " \
    "0.05\nmaterials: {m: {youngs_modulus: 1 GPa, poissons_ratio: 0.25}}\n" \
    "cracks: [{from: [-0.1, 0], to: [0.5, 0]}]\nboundary: [{name: low, set: low, displacement: {x: 0, y: " \
    "0}, essential: penalty}, {name: high, set: high, displacement: {y: 1 mm}, essential: penalty}]\n" \
    "sets: {low: {where: y < -0.86}, high: {where: y > 0.86}}\n"
#define CUBE \
    "dimension: 3\nbody: [{add: {box: {low: [0, -0.6, 0], high: [0.6, 0.6, 0.4]}}}]\nspacing: " \
    "0.1\nmaterials: {m: {youngs_modulus: 1 GPa, poissons_ratio: 0.25}}\n" \
    "cracks: [{polygon: [[-0.1, 0, -0.1], [0.3, 0, -0.1], [0.3, 0, 0.5], [-0.1, 0, 0.5]]}]\nsets: {low: " \
    "{where: y < -0.41}, high: {where: y > 0.41}}\n" \
    "boundary: [{name: low, set: low, displacement: {x: 0, y: 0, z: 0}, essential: penalty}, {name: high, " \
    "set: high, displacement: {y: 1 mm}, essential: penalty}]\n"

/* Openings by the gauges of history.csv, in the order of the scene. */
static void read_openings (const char *text, double *opening)
{
    static const char *const name[3] = { "hair [m]", "near [m]", "far [m]" };
    char folder[64];
    run r = prepare (1, text);
    pg_result *result = NULL;
    make_folder (folder);
    check_ok (pg_result_open (&result, folder, r.scene, r.problem, r.solver));
    while (!pg_solver_done (r.solver, r.state)) {
        advance (&r);
        check_ok (pg_result_step (result, r.state, &r.step));
    }
    check_ok (pg_result_finish (result, r.state, NULL, 0, 0));
    char *history = slurp (inside (folder, "history.csv"));
    for (int k = 0; k < 3; k++) opening[k] = number_at (history, count_lines (history) - 1, name[k]);
    pg_free (history);
    pg_result_free (&result);
    remove_folder (folder);
    clear (&r);
}

/* The faces move apart by 1 mm less what the material between the ends stretches: at a hair's distance,
 * within half a spacing and beyond it openings differ by little. The lattice is shifted across the crack, so
 * that the points nearest to both ends lie on one side of it. */
static void gauges_across_a_crack_read_its_opening (void **state)
{
    static const char *const method[] = {
        "method: {}",
        "method: {integration: consistent}",
        "method: {basis: quadratic, horizon: 3 spacing}",
        "method: {approximation: nosb, integration: nodal, horizon: 2.5 spacing}",
        "method: {approximation: pddo, integration: nodal, horizon: 2.5 spacing}",
        "method: {force: bond}",
        "method: {force: lps}",
        "method: {force: gmpd}\nsolver: {linear: umfpack}"
    };
    (void) state;
    for (size_t m = 0; m < sizeof method / sizeof *method; m++)
        for (int solid = 0; solid < 2; solid++) {
            char text[3000], gauges[900];
            double opening[3];
            const char *low = solid ? "0.12, " : "0.12, ", *high = solid ? ", 0.2" : "";
            if (solid && m > 1 && m < 5) continue;
            snprintf (gauges, sizeof gauges, GAUGES, low, high, low, high, low, high, low, high, low, high,
                      low, high);
            snprintf (text, sizeof text, "%slattice: cells\nlattice_offset: %s\n%s\n%s",
                      solid ? CUBE : SQUARE, solid ? "[0, 0.3, 0]" : "[0, 0.3]", method[m], gauges);
            read_openings (text, opening);
            print_message ("%s %dD: %.4e %.4e %.4e\n", method[m], solid ? 3 : 2, opening[0], opening[1],
                           opening[2]);
            check_relative (opening[1], opening[0], 0.05);
            check_relative (opening[2], opening[0], 0.15);
            assert_true (opening[0] > 0.5e-3);
        }
}

/* What comes nearer is negative, whichever end is named first. */
static void a_gauge_that_closes_reads_less_than_nothing (void **state)
{
    (void) state;
    double opening[3];
    read_openings (
        "dimension: 2\nthickness: 1\nbody: [{add: {box: {low: [0, 0], high: [1, 1]}}}]\nspacing: "
        "0.1\nmaterials: {m: {youngs_modulus: 1 GPa, poissons_ratio: 0.25}}\n"
        "boundary: [{set: all, displacement: {x: -1e-3*x, y: 2e-3*y}}]\noutput: {at: {levels: 1}, pictures: "
        "[], gauges: [{name: hair, from: [0.2, 0.5], to: [0.6, 0.5]}, "
        "{name: near, from: [0.6, 0.5], to: [0.2, 0.5]}, {name: far, from: [0.2, 0.2], to: [0.8, 0.6]}]}\n",
        opening);
    check_relative (opening[0], -0.4e-3, 1e-4);
    check_relative (opening[1], -0.4e-3, 1e-4);
    check_relative (opening[2], (-0.36e-3 + 0.32e-3) / sqrt (0.52), 1e-3);
}

/* An end on the crack has the displacements of both faces. */
static void an_end_on_a_crack_is_told (void **state)
{
    (void) state;
    run r = prepare (1, SQUARE "output: {gauges: [{name: mouth, from: [0.1, 0], to: [0.1, 0.2]}, {name: "
                               "other, from: [0.1, -0.1], to: [0.1, 0.1]}]}\n");
    int told = 0;
    for (size_t k = 0; k < r.problem->notes.n; k++) {
        told += strstr (r.problem->notes.text[k], "warning: gauge mouth: from lies on a crack") != NULL;
        assert_null (strstr (r.problem->notes.text[k], "gauge other"));
    }
    assert_int_equal (told, 1);
    clear (&r);
}

int main (void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test (gauges_across_a_crack_read_its_opening),
                                        cmocka_unit_test (a_gauge_that_closes_reads_less_than_nothing),
                                        cmocka_unit_test (an_end_on_a_crack_is_told) };
    return cmocka_run_group_tests (tests, NULL, NULL);
}
