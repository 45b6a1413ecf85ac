/* SPDX-License-Identifier: GPL-3.0-or-later
 * Pre-cracks that cut a square out of the interior, or single nodes: the run goes on, the loose part is
 * counted and stays put unless it is loaded; then the step is refused and the message names it. */
#include "run.h"

static const char *const square =
    "cracks: [{from: [0.31, 0.31], to: [0.69, 0.31]}, {from: [0.69, 0.31], to: [0.69, 0.69]}, "
    "{from: [0.69, 0.69], to: [0.31, 0.69]}, {from: [0.31, 0.69], to: [0.31, 0.31]}]\n";
static const char *const cell =
    "cracks: [{from: [0.46, 0.46], to: [0.54, 0.46]}, {from: [0.54, 0.46], to: [0.54, 0.54]}, "
    "{from: [0.54, 0.54], to: [0.46, 0.54]}, {from: [0.46, 0.54], to: [0.46, 0.46]}]\n";
static const struct { const char *method; int points_at_nodes; } methods[] = {
    { "approximation: rkpm, integration: gauss, essential: nitsche", 0 },
        { "approximation: rkpm, integration: gauss, essential: transformation", 0 },
    { "approximation: pddo, integration: gauss, essential: nitsche", 0 },
        { "approximation: nosb, integration: nodal, essential: transformation", 1 },
};
enum { METHODS = sizeof methods / sizeof *methods };
enum { FIXED, EVENT };

/* 1 m x 1 m, spacing 1/15 m: no node on a crack */
static run plate (int m, int stepping, const char *cracks, const char *load)
{
    return scene_of (1,
                     "dimension: 2\nthickness: 20 mm\nbody: [{add: {box: {low: [0, 0], high: [1, "
                     "1]}}}]\nspacing: %.17g\n%s"
                     "materials: {rock: {youngs_modulus: 10 GPa, poissons_ratio: 0.25}}\n%smethod: {%s, "
                     "horizon: 2.01 spacing}\n"
                     "sets: {block: {where: 'abs(x - 0.5 m) < 0.18 m and abs(y - 0.5 m) < 0.18 m'}}\n"
                     "boundary:\n  - {set: bottom, displacement: {x: 0, y: 0}}\n  - {set: top, displacement: "
                     "{x: 0.1 mm, y: 1 mm}}\n%s"
                     "solver: {%s}\noutput: {at: {levels: 1}}\n",
                     cracks == cell ? 0.1 : 1.0 / 15, cracks,
                     stepping == EVENT
                         ? "failure: {criterion: stretch, critical_stretch: 5e-4, exclude: [bottom, top]}\n"
                         : "",
                     methods[m].method, load,
                     stepping == EVENT ? "stepping: event, max_events: 30" : "stepping: fixed, steps: 2");
}

static int in_block (const double *x) { return fabs (x[0] - 0.5) < 0.18 && fabs (x[1] - 0.5) < 0.18; }

/* Everything finite; the square still; the rest pulled */
static void check_still (const run *r)
{
    size_t n = r->problem->cloud.n, inside = 0;
    double *u = field_of (r, NULL, "displacement", NULL), *s = field_of (r, NULL, "stress", NULL),
           top = largest_of (u, 2 * n), strength = largest_of (s, 3 * n);
    assert_true (isfinite (top) && top > 0 && isfinite (strength) && strength > 0);
    check_below (top, 2e-3);
    for (size_t i = 0; i < n; i++) {
        if (!in_block (r->problem->cloud.x + 2*i)) continue;
        inside++;
        check_below (largest_of (u + 2*i, 2), 1e-8 * top);
        check_below (largest_of (s + 3*i, 3), 1e-8 * strength);
    }
    assert_true (inside >= 25);
    pg_free (u), pg_free (s);
}

static void a_cut_out_square_is_counted_and_stays (void **state)
{
    (void) state;
    for (int m = 0; m < METHODS; m++) for (int stepping = FIXED; stepping <= EVENT; stepping++) {
        run r = plate (m, stepping, square, "");
        to_the_end (&r);
        const pg_statistics *report = pg_solver_report (r.solver, r.state);
        if (stepping == FIXED) assert_int_equal (report->fragments, 1);        /* breaking may make more */
        assert_true (report->fragments >= 1);
        check_below (report->residual_max, 1e-8);
        check_still (&r);
        clear (&r);
    }
}

static void a_loaded_square_is_refused_and_named (void **state)
{
    (void) state;
    for (int m = 0; m < METHODS; m++) {
        run r = plate (m, FIXED, square, "  - {set: block, body_force: {x: 0, y: -25 kN/m3}}\n");
        pg_status status = pg_solver_step (r.solver, r.state, &r.step);
        assert_int_equal (status, PG_E_EQUILIBRIUM);
        check_contains (pg_last_error (), "a loose part of the body, 36 of its 256 points, around (0.5, "
                                          "0.5) m");
        check_contains (pg_last_error (), "along y (");
        assert_null (strstr (pg_last_error (), "along x"));
        assert_true (r.state->step == 0 && r.state->factor == 0
                     && largest_of (r.state->d, r.state->ndof) == 0);
        clear (&r);
    }
}

/* How many warnings a run has before its first step that begin so. */
static int told (const run *r, const char *words)
{
    pg_statistics now = { 0 };
    int count = 0;
    pg_solver_doubts (&now, r->problem, &r->options);
    for (size_t k = 0; k < now.nwarning; k++) count += strncmp (now.warning[k], words, strlen (words)) == 0;
    return count;
}

static void an_isolated_node_is_counted_and_stays (void **state)
{
    (void) state;
    for (int m = 0; m < METHODS; m++) {
        run r = plate (m, FIXED, cell, "");
        size_t n = r.problem->cloud.n, found = 0;
        assert_int_equal (told (&r, "the cracks leave 1 point without a bond, such as that at (0.5, 0.5) m"),
                          1);
        to_the_end (&r);
        const pg_statistics *report = pg_solver_report (r.solver, r.state);
        double *u = field_of (&r, NULL, "displacement", NULL), *s = field_of (&r, NULL, "stress", NULL);
        assert_true (isfinite (largest_of (u, 2 * n)) && isfinite (largest_of (s, 3 * n)));
        for (size_t i = 0; i < n; i++) {
            const double *x = r.problem->cloud.x + 2*i;
            if (hypot (x[0] - 0.5, x[1] - 0.5) > 0.01) continue;
            found++;
            check_below (largest_of (u + 2*i, 2), 1e-11);
            assert_true (largest_of (s + 3*i, 3) == 0);
        }
        assert_int_equal (found, 1);
        assert_int_equal (report->isolated_nodes, 1);
        assert_int_equal (report->fragments, 0);
        check_below (report->residual_max, 1e-8);
        pg_free (u), pg_free (s);
        clear (&r);
    }
}

/* Nodes that lie on a crack lose their bonds to both sides and are reported. */
static void nodes_on_a_crack_are_eroded (void **state)
{
    (void) state;
    run r = plate (0, FIXED, "cracks: [{from: [0.2, 0.2], to: [0.6, 0.6]}]\n", "");
    assert_int_equal (r.problem->crack.eroded, 5);  /* (4..8)/15 on the diagonal: the tips lie further on */
    check_contains (r.problem->notes.text[r.problem->notes.n - 1],
                    "warning: 5 points lie on a pre-crack and lose all bonds to both sides");
    check_contains (r.problem->notes.text[r.problem->notes.n - 1],
                    "lattice_offset: [0.5, 0] puts it between them");
    to_the_end (&r);
    /* the run warns, and report.json with it */
    assert_int_equal (told (&r, "5 points lie on a pre-crack"), 1);
    assert_int_equal (told (&r, "the cracks leave"), 0);                   /* said once */
    const pg_statistics *report = pg_solver_report (r.solver, r.state);
    assert_int_equal (report->isolated_nodes, 5);
    double *s = field_of (&r, NULL, "stress", NULL);
    assert_true (isfinite (largest_of (s, 3 * r.problem->cloud.n)));
    pg_free (s);
    clear (&r);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (a_cut_out_square_is_counted_and_stays),
        cmocka_unit_test (a_loaded_square_is_refused_and_named),
        cmocka_unit_test (an_isolated_node_is_counted_and_stays),
        cmocka_unit_test (nodes_on_a_crack_are_eroded),
    };
    return cmocka_run_group_tests_name ("scene_runs/loose_parts", tests, NULL, NULL);
}
