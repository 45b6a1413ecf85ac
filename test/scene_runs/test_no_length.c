/* SPDX-License-Identifier: GPL-3.0-or-later
 * With an odd number of Gauss points per direction and points in the middle of the cells, an evaluation point
 * and its node are one place. The bond between them has no length: it decides nothing, wherever the body lies
 * and whichever way it faces. */
#include "run.h"

typedef struct { const char *title, *mode, *failure, *method; } law;

/* Box of 1 m, its top lifted by 20 mm sheared by `side`; low corner at x0. Load factor at which the first
 * bond breaks. */
static double first_break (int dim, const law *l, double x0, double side)
{
    const char *z = dim == 3 ? ", z: 0" : "";
    char low[64], high[64];
    double depth = dim == 3 ? 0.6 : 0;
    snprintf (low, sizeof low, dim == 3 ? "[%.17g, 0, 0]" : "[%.17g, 0]", x0);
    snprintf (high, sizeof high, dim == 3 ? "[%.17g, 1, %g]" : "[%.17g, 1]", x0 + 1, depth);
    run r = scene_of (
        1,
        "dimension: %d\nbody: [{add: {box: {low: %s, high: %s}}}]\nspacing: %g\nlattice: cells\n"
        "materials: {m: {youngs_modulus: 1 GPa, poissons_ratio: 0.25}}\n%sfailure: {%s}\nmethod: {%s}\n"
        "boundary: [{name: t, set: top, displacement: {x: %g mm, y: 20 mm}}, {name: b, set: bottom, "
        "displacement: {x: 0, y: 0%s}}]\n"
        "solver: {kind: static, max_events: 1}\noutput: {at: {levels: 1}, pictures: []}\n",
        dim, low, high, dim == 3 ? 0.2 : 0.1, l->mode, l->failure, l->method, side, z);
    const pg_rows *points = &r.problem->bonds.rows[PG_POINTS];
    size_t short_ones = 0;
    for (size_t p = 0; p < points->n; p++)
        for (size_t e = points->family.start[p]; e < points->family.start[p + 1]; e++)
            short_ones += (size_t) pg_problem_no_bond (r.problem, PG_POINTS, p, e);
    assert_int_equal (short_ones, r.problem->cloud.n);  /* one in every cell: the case in question */
    do advance (&r); while (!r.step.event && !pg_solver_done (r.solver, r.state));
    assert_true (r.step.event);
    double factor = r.step.factor;
    for (size_t b = 0; b < r.step.nbroken; b++) {
        int set;
        size_t point, bond = r.step.broken[b].bond;
        pg_problem_locate (r.problem, bond, &set, &point);
        assert_false (pg_problem_no_bond (r.problem, set, point, bond - r.problem->bonds.first[set]));
    }
    clear (&r);
    return factor;
}

static void where_the_body_lies_does_not_matter (void **state)
{
    static const law laws[] = {
        { "stretch", "", "criterion: stretch, critical_stretch: 0.01",
          "basis: quadratic, horizon: 3 spacing" },
        { "finite", "plane: strain\n", "criterion: stretch, stretch: finite, critical_stretch: 0.01",
          "basis: quadratic, horizon: 3 spacing, integration: consistent" },
        { "stress", "", "criterion: principal_stress, tensile_strength: 10 MPa", "gauss_points: 3" },
    };
    static const double place[] = { 0.1, 1.0 / 3, -7.3, 1234.567 };
    (void) state;
    for (size_t l = 0; l < sizeof laws / sizeof *laws; l++) {
        double first = first_break (2, &laws[l], 1, 0), mirrored[2];
        for (size_t k = 0; k < sizeof place / sizeof *place; k++) {
            double moved = first_break (2, &laws[l], place[k], 0);
            if (!(fabs (moved - first) < 1e-7 * first))
                fail_msg ("%s: first break at %.12g, and at %.12g with the body at %g", laws[l].title, first,
                          moved, place[k]);
        }
        for (int k = 0; k < 2; k++) mirrored[k] = first_break (2, &laws[l], 0.7, k ? 10 : -10);
        if (!(fabs (mirrored[0] - mirrored[1]) < 1e-9 * first))
            fail_msg ("%s: first break at %.12g, mirrored %.12g", laws[l].title, mirrored[0], mirrored[1]);
    }
}

static void the_first_break_is_that_of_the_bonds_with_a_length (void **state)
{
    static const law l = { "stretch", "", "criterion: stretch, critical_stretch: 0.01",
                           "basis: quadratic, horizon: 3 spacing" };
    (void) state;
    check_relative (first_break (2, &l, 1, 0), 0.4497, 1e-3);
}

static void the_same_in_space (void **state)
{
    static const law l = { "stretch", "", "criterion: stretch, critical_stretch: 0.01", "gauss_points: 3" };
    (void) state;
    double first = first_break (3, &l, 1, 0), moved = first_break (3, &l, 1.0 / 3, 0);
    assert_true (fabs (moved - first) < 1e-7 * first);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (the_first_break_is_that_of_the_bonds_with_a_length),
        cmocka_unit_test (where_the_body_lies_does_not_matter),
        cmocka_unit_test (the_same_in_space),
    };
    return cmocka_run_group_tests_name ("bonds without a length", tests, NULL, NULL);
}
