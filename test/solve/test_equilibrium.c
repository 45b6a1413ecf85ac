/* SPDX-License-Identifier: GPL-3.0-or-later
 * Static equilibrium without a matrix: the multilevel preconditioner against factors and the diagonal, on
 * plates with holes and cracks, solids, points off a lattice, bodies cut in two; cascades of breaking; loose
 * parts; which way `auto` goes. */
#include "scene_runs/run.h"

#define ROCK "materials: {rock: {youngs_modulus: 72 GPa, poissons_ratio: %s, density: 2500}}\n"
#define PLATE \
    "dimension: 2\nthickness: 2 mm\nbody: [{add: {box: {low: [0, 0], high: [50 mm, 50 mm]}}}, {subtract: " \
    "{disk: {center: [25 mm, 25 mm], diameter: 10 mm}}}]\n" \
    "spacing: 1 mm\nmaterials: {rock: {youngs_modulus: 72 GPa, poissons_ratio: 0.3333, density: 2500}}\n"
#define SOLID \
    "dimension: 3\nbody: [{add: {box: {low: [0, 0, 0], high: [9 mm, 12 mm, 8 mm]}}}]\nspacing: 1 mm\n" \
    "materials: {rock: {youngs_modulus: 72 GPa, poissons_ratio: 0.25, density: 2500}}\n"
#define PULL2 \
    "boundary: [{set: bottom, displacement: {x: 0, y: 0}}, {set: top, displacement: {y: 10 um}}]\nmethod: " \
    "{force: bond}\n"
#define PULL3 \
    "boundary: [{set: bottom, displacement: {x: 0, y: 0, z: 0}}, {set: top, displacement: {y: 10 " \
    "um}}]\nmethod: {force: bond}\n"
#define ONCE "solver: {stepping: fixed, steps: 1, %s}\noutput: {at: {levels: 1}}\n"

static const pg_statistics *report_of (run *r) { return pg_solver_report (r->solver, r->state); }
static double difference (const run *a, const run *b)
{
    return largest_difference (a->state->d, b->state->d, a->state->ndof)
           / largest_of (b->state->d, b->state->ndof);
}

static void answers_agree (void **state)
{
    (void) state;
    static const struct { const char *what, *body;
    } cases[] = {
        { "plate with a hole", PLATE "lattice: cells\ncells: staircase\n" PULL2 },
        { "with a crack", PLATE "cracks: [{from: [-1 mm, 17.3 mm], to: [30.2 mm, 20.3 mm]}]\n" PULL2 },
        { "cut in two, both held",
          PLATE "cracks: [{from: [-1 mm, 17.3 mm], to: [51 mm, 18.3 mm]}]\nboundary: [{set: bottom, "
                "displacement: {x: 0, y: 0}}, "
                "{set: top, displacement: {x: 1 um, y: 10 um}}]\nsets: {left_half: {where: \"x < 25 mm and y "
                "> 20 mm and y < 24 mm\"}}\nmethod: {force: bond}\n" },
        { "off the lattice", PLATE
          "perturb: {amount: 0.2}\ncracks: [{from: [-1 mm, 17.3 mm], to: [20.2 mm, 17.3 mm]}]\n" PULL2 },
        { "cells cut by the hole", PLATE "lattice: cells\ncells: cut\n" PULL2 },
        { "by its surfaces corrected",
          PLATE "lattice: cells\n"
                "boundary: [{set: bottom, displacement: {x: 0, y: 0}}, {set: top, traction: {y: 1 MPa}}]\n"
                "method: {force: bond, horizon: 4 spacing, surface_correction: product}\n" },
        { "solid", SOLID PULL3 },
        { "solid with a crack", SOLID "cracks: [{polygon: [[-1 mm, 5.6 mm, -1 mm], [5.2 mm, 5.6 mm, -1 mm], "
                                      "[5.2 mm, 6.3 mm, 10 mm], [-1 mm, 6.3 mm, 10 mm]]}]\n" PULL3 },
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        run a = scene_of (2, "%s" ONCE, cases[k].body, "linear: pcg"),
            b = scene_of (1, "%s" ONCE, cases[k].body, "linear: cholmod");
        run c = scene_of (1, "%s" ONCE, cases[k].body, "linear: pcg, preconditioner: jacobi");
        to_the_end (&a), to_the_end (&b), to_the_end (&c);
        print_message ("%s: %zu iterations, by the diagonal %zu; difference %.1e\n", cases[k].what,
                       report_of (&a)->linear.cg_iterations, report_of (&c)->linear.cg_iterations,
                       difference (&a, &b));
        check_below (a.step.residual, 1e-8);
        check_below (difference (&a, &b), 1e-8);
        check_below (difference (&c, &b), 1e-7);
        assert_true (report_of (&a)->linear.cg_iterations <= 20
                     && 3 * report_of (&a)->linear.cg_iterations < report_of (&c)->linear.cg_iterations);
        check_contains (report_of (&a)->linear.preconditioner, "multilevel");
        assert_string_equal (report_of (&c)->linear.preconditioner, "jacobi");
        assert_int_equal (report_of (&a)->linear.preconditioners, 1);
        clear (&a), clear (&b), clear (&c);
    }
}

/* State-based forces have no matrix; the rows of bonds with the same Young's modulus are near enough,
 * whatever Poisson's ratio. fcbm: sums by FFT. */
static void forces_without_a_matrix (void **state)
{
    (void) state;
    static const struct {
        const char *force, *plane, *nu;
    } cases[] = { { "lps", "stress", "0.1" },
                  { "lps", "stress", "0.45" },
                  { "lps", "strain", "0.4" },
                  { "fcbm", "stress", "0.3333" } };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        static const char text[] =
            "dimension: 2\nthickness: 2 mm\nplane: %s\nspacing: 1 mm\nlattice: cells\ncells: staircase\n" ROCK
            "method: {force: %s}\n"
            "body: [{add: {box: {low: [0, 0], high: [50 mm, 50 mm]}}}, {subtract: {disk: {center: [25 mm, 25 "
            "mm], diameter: 10 mm}}}]\n"
            "cracks: [{from: [-1 mm, 17.3 mm], to: [30.2 mm, 20.3 mm]}]\n"
            "boundary: [{set: bottom, displacement: {x: 0, y: 0}}, {set: top, displacement: {y: 10 "
            "um}}]\n" ONCE;
        run a = scene_of (2, text, cases[k].plane, cases[k].nu, cases[k].force, "linear: pcg");
        run c = scene_of (1, text, cases[k].plane, cases[k].nu, cases[k].force,
                          "linear: pcg, preconditioner: jacobi");
        to_the_end (&a), to_the_end (&c);
        print_message ("%s, %s, %s: %zu iterations, by the diagonal %zu\n", cases[k].force, cases[k].plane,
                       cases[k].nu, report_of (&a)->linear.cg_iterations,
                       report_of (&c)->linear.cg_iterations);
        check_below (difference (&a, &c), 1e-7);
        assert_true (report_of (&a)->linear.cg_iterations <= 20
                     && report_of (&c)->linear.cg_iterations > 100);
        clear (&a), clear (&c);
    }
}

#define BREAKING \
    PLATE "lattice: cells\ncracks: [{from: [-1 mm, 12.5 mm], to: [9.2 mm, 12.5 mm]}]\n" PULL2 \
          "failure: {criterion: stretch, critical_stretch: 1e-4, exclude: [bottom, top]}\n"

/* The same bonds die at the same loads as with factors; the preconditioner is made a few times only. */
static void cascades_are_the_same (void **state)
{
    (void) state;
    run a = scene_of (1, BREAKING "solver: {stepping: event, linear: pcg}\n"),
        b = scene_of (1, BREAKING "solver: {stepping: event, linear: cholmod}\n");
    while (!pg_solver_done (b.solver, b.state) && b.state->events < 30) {
        advance (&a), advance (&b);
        assert_memory_equal (a.state->alive, b.state->alive, a.state->nbond);
        check_relative (a.step.factor, b.step.factor, 1e-7);
        check_below (a.step.residual, 1e-8);
    }
    const pg_statistics *r = report_of (&a);
    print_message ("%ld events, %ld bonds, %zu iterations in %ld solves, %ld preconditioners\n", r->events,
                   r->broken, r->linear.cg_iterations, r->linear.solves, r->linear.preconditioners);
    assert_true (r->events >= 25 && r->linear.preconditioners >= 1
                 && r->linear.preconditioners < r->events / 4 && r->linear.factorizations == 0);
    assert_true (r->linear.cg_iterations < 20 * (size_t) r->linear.solves);
    int told = 0;
    for (size_t k = 0; k < r->nskipped; k++) told |= strstr (r->skipped[k].what, "preconditioner in") != NULL;
    assert_true (told);
    clear (&a), clear (&b);
}

/* Without a tie the one bond that is worst breaks, also when it alone is at the cut; a broken bond lies in
 * the middle of its two ends. */
static void the_worst_bond_breaks_in_its_middle (void **state)
{
    (void) state;
    run a = scene_of (1, BREAKING "solver: {stepping: event, linear: cholmod}\n"), b;
    while (a.step.nbroken == 0) advance (&a);
    b = scene_of (
        1,
        BREAKING
        "solver: {stepping: fixed, steps: %d, break: worst, tie: 0, linear: cholmod, max_iterations: 1000}\n",
        (int) (0.999 / a.step.factor));
    advance (&b);
    assert_true (b.step.nbroken > 0);
    for (size_t k = 0; k < b.step.nbroken; k++) {
        const pg_broken *q = &b.step.broken[k];
        int set;
        size_t point;
        pg_problem_locate (b.problem, q->bond, &set, &point);
        const pg_rows *r = &b.problem->bonds.rows[set];
        const double *from = r->x + 2 * point,
                     *to = b.problem->cloud.x
                           + 2 * (size_t) r->family.node[q->bond - b.problem->bonds.first[set]];
        assert_int_equal (q->set, set);
        for (int c = 0; c < 2; c++)
            check_scaled (q->place[c], 0.5 * (from[c] + to[c]), 1e-14, b.problem->cloud.h);
    }
    clear (&a), clear (&b);
}

static void threads_do_not_change_a_bit (void **state)
{
    (void) state;
    run a = scene_of (1, BREAKING "solver: {stepping: event, linear: pcg}\n"),
        b = scene_of (3, BREAKING "solver: {stepping: event, linear: pcg}\n");
    for (int k = 0; k < 25; k++) advance (&a), advance (&b);
    assert_memory_equal (a.state->d, b.state->d, a.state->ndof * sizeof *a.state->d);
    clear (&a), clear (&b);
}

/* Cut off and unloaded a part moves as a rigid body or not at all; loaded there is no equilibrium, whatever
 * solves. */
static void loose_parts (void **state)
{
    (void) state;
    static const char *const solvers[] = { "linear: pcg", "linear: cholmod" };
    for (int k = 0; k < 2; k++) {
        run r = scene_of (1,
                          PLATE "cracks: [{from: [-1 mm, 17.3 mm], to: [51 mm, 18.3 mm]}]\nsets: {low: "
                                "{where: \"y > 9 mm and y < 11 mm\"}}\nmethod: {force: bond}\n"
                                "boundary: [{set: bottom, displacement: {x: 0, y: 0}}, {set: low, "
                                "body_force: {x: 1e6, y: 2e6}}]\n" ONCE,
                          solvers[k]);
        to_the_end (&r);
        check_below (r.step.residual, 1e-8);
        double loose = 0, top = largest_of (r.state->d, r.state->ndof);
        for (size_t i = 0; i < r.problem->cloud.n; i++)
            if (r.problem->cloud.x[2 * i + 1] > 0.02)
                loose = fmax (loose, hypot (r.state->d[2 * i], r.state->d[2 * i + 1]));
        assert_true (top > 0 && loose <= 1e-6 * top);
        clear (&r);
        r = scene_of (
            1,
            PLATE
            "cracks: [{from: [-1 mm, 17.3 mm], to: [51 mm, 18.3 mm]}]\nmethod: {force: bond}\n"
            "boundary: [{set: bottom, displacement: {x: 0, y: 0}}, {set: top, traction: {y: 1 MPa}}]\n" ONCE,
            solvers[k]);
        pg_status now = pg_solver_step (r.solver, r.state, &r.step);
        assert_true (now == PG_E_EQUILIBRIUM || now == PG_E_NOT_SPD);
        clear (&r);
    }
}

static void auto_goes_by_size (void **state)
{
    (void) state;
    static const struct { const char *body; double h; int cg;
    } cases[] = {
        { "dimension: 2\nthickness: 1\nbody: [{add: {box: {low: [0, 0], high: [1, 1]}}}]\n" PULL2, 0.05, 0 },
        { "dimension: 2\nthickness: 1\nbody: [{add: {box: {low: [0, 0], high: [1, 1]}}}]\n" PULL2, 0.02, 1 },
        { "dimension: 2\nthickness: 1\nbody: [{add: {box: {low: [0, 0], high: [1, 1]}}}]\nperturb: {amount: "
          "0.1}\n" PULL2,
          0.02, 1 },
        { "dimension: 3\nbody: [{add: {box: {low: [0, 0, 0], high: [1, 1, 1]}}}]\n" PULL3, 0.2, 0 },
        { "dimension: 3\nbody: [{add: {box: {low: [0, 0, 0], high: [1, 1, 1]}}}]\n" PULL3, 0.1, 1 },
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        run r = scene_of (1, "%sspacing: %g\n" ROCK ONCE, cases[k].body, cases[k].h,
                          strstr (cases[k].body, "n: 3") ? "0.25" : "0.3333", "linear: auto");
        to_the_end (&r);
        assert_int_equal (report_of (&r)->linear.factorizations, !cases[k].cg);
        assert_int_equal (report_of (&r)->linear.preconditioners, cases[k].cg);
        clear (&r);
    }
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (answers_agree),
        cmocka_unit_test (forces_without_a_matrix),
        cmocka_unit_test (cascades_are_the_same), cmocka_unit_test (the_worst_bond_breaks_in_its_middle),
        cmocka_unit_test (threads_do_not_change_a_bit),
        cmocka_unit_test (loose_parts),
        cmocka_unit_test (auto_goes_by_size),
    };
    return cmocka_run_group_tests_name ("solve/equilibrium", tests, NULL, NULL);
}
