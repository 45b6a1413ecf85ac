/* SPDX-License-Identifier: GPL-3.0-or-later
 * Points that turn, as a user and an enemy meet them: one bond at its limits, chains that twist freely,
 * bodies seen from other sides, energies of motion with rotations, threads. */
#include <unistd.h>
#include "run.h"

#define STONE "materials: {stone: {youngs_modulus: 10 GPa, poissons_ratio: 0.2, density: 2500 kg/m3}}\n"

/* ---- one bond ------------------------------------------------------------------------------------------ */
/* Two points 1 m apart, all of whose unknowns are prescribed: what the far one gets, shares of the three
 * limits. */
typedef struct { const char *name, *modes; double stretch, shear, bending, breaks_at; char kind; } trial;

static double limit_of (const run *r, int k) { return r->problem->criterion->parameter[k]; }

static run one_bond (const char *path, int dim, const trial *t, const double *limit)
{
    double s = t->stretch * limit[0], g = t->shear * limit[1], k = t->bending * limit[2];
    char near_turn[60], far_turn[60];
    snprintf (near_turn, sizeof near_turn, dim == 3 ? "{x: 0, y: 0, z: %.17g}" : "{z: %.17g}", -0.5 * k);
    snprintf (far_turn, sizeof far_turn, dim == 3 ? "{x: 0, y: 0, z: %.17g}" : "{z: %.17g}", 0.5 * k);
    return scene_of (1,
                     "dimension: %d\n%spoints: %s\n" STONE
                     "method: {force: gmpd, horizon: 1.5}\nfailure: {criterion: beam_limits, "
                     "fracture_energy: 30 J/m2, modes: %s}\n"
                     "sets: {a: {where: 'x < 0.5'}, b: {where: 'x > 0.5'}}\nboundary:\n  - {set: a, "
                     "displacement: {x: 0, y: 0%s}}\n  - {set: b, displacement: {x: %.17g, y: %.17g%s}}\n"
                     "  - {set: a, rotation: %s}\n  - {set: b, rotation: %s}\nsolver: {kind: "
                     "static}\noutput: {at: {levels: 1}}\n",
                     dim, dim == 2 ? "plane: stress\nthickness: 0.3\n" : "", path, t->modes,
                     dim == 3 ? ", z: 0" : "", s, g, dim == 3 ? ", z: 0" : "", near_turn, far_turn);
}

static void a_bond_breaks_at_its_limits (void **state)
{
    (void) state;
    static const double root = 0.57735026918962576, none[] = { 0, 0, 0 };
    const trial trials[] = {
        { "stretch", "together", 2, 0, 0, 0.5, 't' },
        { "shear", "together", 0, 2, 0, 0.5, 's' },
        { "bending", "together", 0, 0, 2, 0.5, 'b' },
        { "shear the other way", "together", 0, -2, 0, 0.5, 's' },
        { "bending the other way", "together", 0, 0, -2, 0.5, 'b' },
        { "stretch alone", "single", 2, 0.5, -0.5, 0.5, 't' },
        { "shear alone", "single", 0.5, 2, 0.5, 0.5, 's' },
        { "bending alone", "single", -5, 0.5, 2, 0.5, 'b' },
        { "a third each", "together", 2 * root, 2 * root * 1.0000001, 2 * root, 0.5, 's' },
        { "a third each, singly", "single", 0.99, 0.99, 0.99, INFINITY, 0 },
        { "shortened", "together", -50, 0, 0, INFINITY, 0 },
        { "shortened and sheared", "together", -50, 2, 0, 0.5, 's' },
        { "nearly", "together", 0.6, 0.5999, 0.52, INFINITY, 0 },
        { "just", "together", 0.6, 0.6, 0.52915027, 1, 't' },
    };
    for (int dim = 2; dim <= 3; dim++) {
        char path[] = "/tmp/perigal_points_XXXXXX";
        int file = mkstemp (path);
        const char *text = dim == 2 ? "0, 0, 0.25\n1, 0, 0.25\n" : "0, 0, 0, 0.75\n1, 0, 0, 0.75\n";
        assert_true (file >= 0 && write (file, text, strlen (text)) == (ssize_t) strlen (text)
                     && close (file) == 0);
        trial still = { "", "together", 0, 0, 0, 0, 0 };
        run plan = one_bond (path, dim, &still, none);
        double limit[3] = { limit_of (&plan, 0), limit_of (&plan, 1), limit_of (&plan, 2) };
        clear (&plan);
        for (size_t k = 0; k < sizeof trials / sizeof *trials; k++) {
            run r = one_bond (path, dim, &trials[k], limit);
            double at = INFINITY;
            char kind = 0;
            while (!pg_solver_done (r.solver, r.state)) {
                advance (&r);
                if (r.step.nbroken && isinf (at)) at = r.step.factor, kind = r.step.broken[0].kind;
            }
            if (isinf (trials[k].breaks_at)) assert_true (isinf (at));
            else check_relative (at, trials[k].breaks_at, trials[k].breaks_at < 1 ? 1e-6 : 1e-5);
            if (kind != trials[k].kind && trials[k].breaks_at < 1)
                print_error ("%s\n", trials[k].name), assert_int_equal (kind, trials[k].kind);
            const pg_statistics *report = pg_solver_report (r.solver, r.state);
            check_scaled (report->energy.strain + report->energy.dissipated, report->energy.external, 1e-12,
                          report->energy.external);
            /* what it takes is what it held: four times that of half its limit */
            if (trials[k].breaks_at < 1) {
                trial half = trials[k];
                half.stretch /= 4, half.shear /= 4, half.bending /= 4;
                run q = one_bond (path, dim, &half, limit);
                to_the_end (&q);
                assert_int_equal (q.state->broken, 0);
                check_relative (report->energy.dissipated,
                                4 * pg_solver_report (q.solver, q.state)->energy.strain, 1e-5);
                assert_true (report->energy.strain == 0);
                clear (&q);
            }
            clear (&r);
        }
        unlink (path);
    }
}

/* ---- bodies that their bonds leave free to twist ------------------------------------------------------- */
/* A chain of points across the axes of space: nothing resists twisting (gmpd), or moving across (bond).
 * Pulled, it answers the same by factor and by iteration. */
static void a_chain_twists_freely (void **state)
{
    (void) state;
    char path[] = "/tmp/perigal_points_XXXXXX";
    int file = mkstemp (path);
    FILE *out = fdopen (file, "w");
    assert_non_null (out);
    for (int i = 0; i < 15; i++) fprintf (out, "%.17g, %.17g, %.17g, 1\n", 0.6 * i, 0.5 * i, 0.4 * i);
    fclose (out);
    for (int k = 0; k < 2; k++) {
        double pull[2];
        for (int by = 0; by < 2; by++) {
            run r = scene_of (
                1,
                "dimension: 3\npoints: %s\n" STONE
                "method: {force: %s, horizon: 3}\nsets: {l: {where: 'x < 1.3'}, r: {where: 'x > 7.1'}}\n"
                "boundary:\n  - {set: l, displacement: {x: 0, y: 0, z: 0}}\n  - {set: r, displacement: {x: "
                "6e-4, y: 5e-4, z: 4e-4}}\nsolver: {kind: static, linear: %s}\n"
                "output: {at: {levels: 1}}\n",
                path, k ? "gmpd" : "bond", by ? "pcg, tolerance: 1e-12" : "cholmod");
            to_the_end (&r);
            pull[by] = r.step.reaction[3];
            check_relative (r.step.reaction[4] / r.step.reaction[3], 5.0 / 6, 1e-9);
            clear (&r);
        }
        assert_true (pull[0] > 0);
        check_relative (pull[1], pull[0], 1e-9);
    }
    unlink (path);
}

/* A moment about the chain finds no resistance: said so, whoever solves. */
static void a_loaded_twist_is_refused (void **state)
{
    (void) state;
    static const char *const linear[] = { "cholmod", "pcg" };
    for (int k = 0; k < 2; k++) {
        run r = scene_of (
            1,
            "dimension: 3\nbody: [{add: {box: {low: [0, 0, 0], high: [12, 1, 1]}}}]\nspacing: 1\nlattice: "
            "cells\n" STONE "method: {force: gmpd}\n"
            "sets: {l: {where: 'x < 3'}, r: {where: 'x > 9'}}\nboundary: [{set: l, displacement: {x: 0, y: "
            "0, z: 0}}, {set: l, rotation: {x: 0, y: 0, z: 0}}, {set: r, moment: {x: 1 kN m}}]\n"
            "solver: {kind: static, linear: %s}\noutput: {at: {levels: 1}}\n",
            linear[k]);
        assert_true (pg_solver_step (r.solver, r.state, &r.step) != PG_OK);
        check_contains (pg_last_error (), "12 of its 12 points, around (6, 0.5, 0.5) m, is a line of "
                                          "points");
        check_contains (pg_last_error (), "moments of 1e+03 N m about it find no resistance; it is loaded "
                                          "by r");
        clear (&r);
    }
}

/* Forces at two sides of a body that nothing holds turn it about z; moments on its points hold it, or do
 * not. */
static void moments_on_points_balance_forces (void **state)
{
    (void) state;
    static const char *const body[] = { "dimension: 2\nbody: [{add: {box: {low: [0, 0], high: [6, 10]}}}]\n",
                                        "dimension: 3\nbody: [{add: {box: {low: [0, 0, 0], high: [3, 10, "
                                        "2]}}}]\n" };
    static const char *const moment[] = { "1.8e4", "-1.8e4" };
    for (int dim = 2; dim <= 3; dim++)
        for (int k = 0; k < 4; k++) {
            int balance = k % 2 == 0;
            run r = scene_of (
                1,
                "%sspacing: 1\nlattice: cells\n" STONE
                "method: {force: gmpd, accept_inexact: yes}\n"
                "sets: {low: {where: 'y < 1'}, high: {where: 'y > 9'}, in: {where: 'y > 4 and y < 6'}}\n"
                "boundary: [{set: low, force: {x: -2 kN}}, {set: high, force: {x: 2 kN}}, {set: in, moment: "
                "{z: %s}}]\n"
                "solver: {kind: static, linear: %s}\noutput: {at: {levels: 1}}\n",
                body[dim - 2], moment[!balance], k < 2 ? "cholmod" : "pcg");
            pg_status status = pg_solver_step (r.solver, r.state, &r.step);
            if (balance) {
                size_t unknowns = (size_t) (3 * dim - 3);
                double along = 0;
                check_ok (status);
                for (size_t i = 0; i < r.problem->cloud.n; i++) along += r.state->d[i * unknowns];
                check_below (fabs (along), 1e-9 * largest_of (r.state->d, r.state->ndof));
            } else {
                assert_int_equal (status, PG_E_EQUILIBRIUM);
                check_contains (pg_last_error (), "nothing holds the body: it is free to move about z "
                                                  "(3.6e+04 N m), where its loads do not balance");
            }
            clear (&r);
        }
}

/* ---- other sides --------------------------------------------------------------------------------------- */
/* Axis of the seen body for each of the plain one, and its sign. */
typedef struct { const char *name; int axis[3]; double sign[3]; int threads; const char *more; } side;

static void seen_vector (const side *v, const double *a, int axial, double *out)
{
    double handed = v->sign[0] * v->sign[1] * v->sign[2];
    if ((v->axis[1] - v->axis[0] + 3) % 3 == 2) handed = -handed;
    for (int k = 0; k < 3; k++) out[v->axis[k]] = v->sign[k] * a[k] * (axial ? handed : 1);
}

/* A block 8 x 6 x 5 m with a notch, sheared and twisted until bonds break. */
static run block_of (const side *v, const char *solver)
{
    const double low[3] = { -4, -3, -2.5 }, notch[2][3] = { { -0.6, -3, -3 }, { 0.4, -1, 3 } };
    double a[3], b[3], from[3], to[3], push[3], turn[3];
    char text[2][40], axes[] = "xyz";
    seen_vector (v, low, 0, a);
    for (int k = 0; k < 3; k++) a[k] = -fabs (a[k]), b[k] = -a[k];
    seen_vector (v, notch[0], 0, from), seen_vector (v, notch[1], 0, to);
    for (int k = 0; k < 3; k++) {
        double least = fmin (from[k], to[k]);
        to[k] = fmax (from[k], to[k]), from[k] = least;
    }
    seen_vector (v, (double[3]){ 3e-3, 2e-3, -1e-3 }, 0, push),
        seen_vector (v, (double[3]){ 2e-3, -1e-3, 1e-3 }, 1, turn);
    for (int e = 0; e < 2; e++)
        snprintf (text[e], sizeof text[e], "%c %s", axes[v->axis[0]], (v->sign[0] > 0) == e ? "> 3" : "< -3");
    return scene_of (
        v->threads,
        "dimension: 3\nbody:\n  - add: {box: {low: [%g, %g, %g], high: [%g, %g, %g]}}\n  - subtract: {box: "
        "{low: [%g, %g, %g], high: [%g, %g, %g]}}\n"
        "spacing: 1\nlattice: cells\n" STONE
        "method: {force: gmpd, beam: timoshenko, shear_parameter: 0.3, horizon: 2.1 spacing%s}\n"
        "failure: {criterion: beam_limits, fracture_energy: 200 J/m2, exclude: [l, r]}\nsets: {l: {where: "
        "'%s'}, r: {where: '%s'}}\nboundary:\n"
        "  - {set: l, displacement: {x: 0, y: 0, z: 0}}\n  - {set: l, rotation: {x: 0, y: 0, z: 0}}\n  - "
        "{set: r, displacement: {x: %.17g, y: %.17g, z: %.17g}}\n"
        "  - {set: r, rotation: {x: %.17g, y: %.17g, z: %.17g}}\nsolver: {%s}\noutput: {at: {levels: 1}}\n",
        a[0], a[1], a[2], b[0], b[1], b[2], from[0], from[1], from[2], to[0], to[1], to[2], v->more, text[0],
        text[1], push[0], push[1], push[2], turn[0], turn[1], turn[2], solver);
}

static size_t image_of (const side *v, const run *a, const run *b, size_t i)
{
    double x[3];
    size_t j = 0;
    seen_vector (v, a->problem->cloud.x + 3 * i, 0, x);
    while (j < b->problem->cloud.n
           && hypot (hypot (b->problem->cloud.x[3 * j] - x[0], b->problem->cloud.x[3 * j + 1] - x[1]),
                     b->problem->cloud.x[3 * j + 2] - x[2])
                  > 1e-6)
        j++;
    assert_true (j < b->problem->cloud.n);
    return j;
}

static void check_seen (const side *v, const char *solver, double tolerance)
{
    const side plain = { "", { 0, 1, 2 }, { 1, 1, 1 }, 1, strstr (v->more, "volumetric") ? v->more : "" };
    run a = block_of (&plain, solver), b = block_of (v, solver);
    const char *fields[] = { "displacement", "rotation", "damage" };
    to_the_end (&a), to_the_end (&b);
    double worst = 0;
    assert_true (a.state->broken > 20);
    assert_int_equal (a.state->broken, b.state->broken);
    assert_int_equal (a.problem->cloud.n, b.problem->cloud.n);
    for (int f = 0; f < 3; f++) {
        int parts;
        double *one = field_of (&a, NULL, fields[f], &parts), *other = field_of (&b, NULL, fields[f], NULL);
        double top = largest_of (one, a.problem->cloud.n * (size_t) parts);
        assert_true (top > 0);
        for (size_t i = 0; i < a.problem->cloud.n; i++) {
            size_t j = image_of (v, &a, &b, i);
            double out[3] = { one[i * (size_t) parts] };
            if (parts == 3) seen_vector (v, one + 3 * i, f == 1, out);
            worst = fmax (worst, largest_difference (out, other + j * (size_t) parts, (size_t) parts) / top);
        }
        pg_free (one), pg_free (other);
    }
    print_message ("%s, %s: %ld bonds broken, fields %.1e\n", v->name, solver, (long) a.state->broken, worst);
    check_below (worst, tolerance);
    clear (&a), clear (&b);
}

static void the_same_block_from_all_sides (void **state)
{
    (void) state;
    static const side sides[] = {
        { "axes in turn", { 1, 2, 0 }, { 1, 1, 1 }, 1, "" },
        { "mirrored in x", { 0, 1, 2 }, { -1, 1, 1 }, 1, "" },
        { "mirrored in z", { 0, 1, 2 }, { 1, 1, -1 }, 2, "" },
        { "x and y exchanged", { 1, 0, 2 }, { 1, 1, 1 }, 1, "" },
        { "turned, with a dilatation", { 2, 0, 1 }, { -1, 1, 1 }, 1, ", volumetric: on, bond_poisson: 0.05" },
        { "upside down, by list", { 2, 0, 1 }, { -1, -1, 1 }, 3, ", evaluation: list" },
    };
    for (size_t k = 0; k < sizeof sides / sizeof *sides; k++) {
        int state_too = strstr (sides[k].more, "volumetric") != NULL;
        if (k % 2 == 0)
            check_seen (&sides[k],
                        state_too ? "kind: static, stepping: fixed, steps: 2, break: all, tolerance: 1e-12"
                                  : "kind: static, stepping: fixed, steps: 2, break: all, linear: cholmod",
                        1e-9);
        check_seen (&sides[k], "kind: verlet, end: 30 ms", 1e-9);
    }
}

/* The same bits with any number of threads, in explicit steps and by the linear solver. */
static void threads_change_no_bit (void **state)
{
    (void) state;
    static const char *const solvers[] = { "kind: verlet, end: 20 ms",
                                           "kind: newmark, end: 20 ms, dt: 10 ms, break: all" };
    static const char *const methods[] = { "", ", evaluation: list", ", volumetric: on, bond_poisson: 0.05" };
    for (int k = 0; k < 2; k++)
        for (int m = 0; m < 3; m++) {
            side v = { "", { 0, 1, 2 }, { 1, 1, 1 }, 1, methods[m] };
            run a = block_of (&v, solvers[k]);
            to_the_end (&a);
            assert_true (a.state->broken > 0);
            for (v.threads = 2; v.threads <= 3 - k; v.threads++) {
                run b = block_of (&v, solvers[k]);
                to_the_end (&b);
                assert_memory_equal (a.state->d, b.state->d, a.state->ndof * sizeof *a.state->d);
                assert_memory_equal (a.state->alive, b.state->alive, a.state->nbond);
                clear (&b);
            }
            clear (&a);
        }
}

/* ---- energies of motion -------------------------------------------------------------------------------- */
#define BAR \
    "dimension: 2\nplane: strain\nbody: [{add: {box: {low: [0, 0], high: [20, 6]}}}]\nspacing: 1\nlattice: " \
    "cells\n" STONE "method: {force: gmpd}\nsets: {l: {where: 'x < 3'}, r: {where: 'x > 17'}}\n"

/* Held at one end and set off: what Newmark's average acceleration keeps, rotations with their inertia among
 * it, stays. */
static void newmark_keeps_energy (void **state)
{
    (void) state;
    run r = scene_of (
        1,
        BAR "boundary: [{set: l, displacement: {x: 0, y: 0}}, {set: l, rotation: {z: 0}}, {name: m, set: r, "
            "moment: {z: 1 MN m}, table: [[0, 0], [0.01, 1], [0.0100001, 0]]}]\n"
            "solver: {kind: newmark, end: 60 ms, dt: 0.5 ms, tolerance: 1e-12}\noutput: {at: {levels: 1}}\n");
    double given = NAN, worst = 0;
    while (!pg_solver_done (r.solver, r.state)) {
        advance (&r);
        const pg_statistics *p = pg_solver_report_now (r.solver);
        if (r.state->time < 10.6e-3) continue;
        double all = p->energy.strain + p->energy.kinetic;
        if (isnan (given)) given = all;
        worst = fmax (worst, fabs (all / given - 1));
    }
    assert_true (given > 0);
    check_below (worst, 1e-9);
    clear (&r);
}

/* An end that is turned as time goes on: the work of its moment is the energy of the motion. */
static void work_of_a_turning_end (void **state)
{
    (void) state;
    static const char *const solvers[] = { "verlet", "central", "newmark, dt: 0.2 ms, tolerance: 1e-12" };
    for (int k = 0; k < 3; k++) {
        run r =
            scene_of (1,
                      BAR
                      "boundary: [{set: l, displacement: {x: 0, y: 0}}, {set: l, rotation: {z: 0}}, {set: r, "
                      "rotation: {z: '1e-3 * (1 - cos (100 * t / (1 s))) / 2'}, ramp: constant}]\n"
                      "solver: {kind: %s, end: 50 ms}\noutput: {at: {levels: 1}}\n",
                      solvers[k]);
        to_the_end (&r);
        const pg_statistics *p = pg_solver_report_now (r.solver);
        assert_true (p->energy.kinetic > 0 && p->energy.strain > 0);
        assert_true (fabs (r.step.reaction[8]) + fabs (r.step.reaction[6]) > 0);
        check_relative (p->energy.strain + p->energy.kinetic, p->energy.external, 1e-9);
        clear (&r);
    }
}

/* Work of the loads less what is stored and moves: taken by bonds that break, in the steps in which they do,
 * and never given back. */
static void what_breaking_takes_stays_taken (void **state)
{
    (void) state;
    static const char *const solvers[] = { "kind: verlet, end: 30 ms", "kind: central, end: 30 ms" },
                             *const methods[] = { "", ", evaluation: list",
                                                  ", volumetric: on, bond_poisson: 0.05" };
    for (int k = 0; k < 2; k++)
        for (int m = 0; m < 3; m++) {
            const side v = { "", { 0, 1, 2 }, { 1, 1, 1 }, 1, methods[m] };
            run r = block_of (&v, solvers[k]);
            double taken = 0;
            while (!pg_solver_done (r.solver, r.state)) {
                advance (&r);
                const pg_statistics *p = pg_solver_report_now (r.solver);
                assert_true (p->energy.dissipated >= taken - 1e-12 * p->energy.external);
                if (r.step.nbroken == 0)
                    check_scaled (p->energy.dissipated, taken, 1e-12, p->energy.external);
                taken = p->energy.dissipated;
            }
            assert_true (taken > 0 && r.state->broken > 100);
            clear (&r);
        }
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (a_bond_breaks_at_its_limits), cmocka_unit_test (a_chain_twists_freely),
        cmocka_unit_test (a_loaded_twist_is_refused),
        cmocka_unit_test (moments_on_points_balance_forces),
        cmocka_unit_test (the_same_block_from_all_sides),
        cmocka_unit_test (threads_change_no_bit),       cmocka_unit_test (newmark_keeps_energy),
        cmocka_unit_test (work_of_a_turning_end),       cmocka_unit_test (what_breaking_takes_stays_taken)
    };
    return cmocka_run_group_tests_name ("scene_runs/micropolar", tests, NULL, NULL);
}
