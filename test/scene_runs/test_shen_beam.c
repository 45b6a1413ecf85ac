/* SPDX-License-Identifier: GPL-3.0-or-later
 * Shen's beam by direct sums: deflections of theory C and the whole neutral axis against its table, by the
 * shipped scenes as they are but for the solver; then relaxation and adaptive dynamic relaxation against the
 * static answer on a coarser lattice. */
#include "measured.h"

enum { NODES, CELLS };
static const char *const path[2] = { "data/shen_beam/scene.yaml", "data/shen_beam/scene_cells.yaml" };

/* Mean of a component over a set, as history.csv has it. */
static double mean_on (const run *r, const char *set, int component)
{
    const pg_set *s = pg_sets_find (&r->problem->sets, set);
    double sum = 0;
    assert_true (s && s->npoint > 0);
    for (size_t i = 0; i < s->npoint; i++) sum += r->state->d[2 * (size_t) s->point[i] + (size_t) component];
    return sum / (double) s->npoint;
}

/* deflection: of the middle of the axis, m (theory C); l2: of the axis against its table, the middle of which
 * is off by `middle` of it. */
static void static_beam (int lattice, const char *kernel, const char *calibrate, double deflection, double l2,
                         double middle)
{
    char k[64], c[64];
    snprintf (k, sizeof k, "method.kernel=%s", kernel);
    snprintf (c, sizeof c, "method.calibrate=%s", calibrate);
    const char *const set[] = { "solver={kind: static, linear: pcg}", k, c };
    pg_errors e;
    run r = measured (path[lattice], 3, set, &e);
    double got = -mean_on (&r, "axis_middle", 1);
    print_message ("%s, %s, calibrate %s: middle %.5e m, axis L2 %.2f %%, largest %.2f %%\n",
                   lattice == NODES ? "edges" : "cells", kernel, calibrate, got, 100 * e.line[0].l2.relative,
                   100 * e.line[0].maximum.relative);
    check_relative (got, deflection, 1e-5);
    assert_int_equal (e.line[0].missed, 0);
    assert_int_equal (e.line[0].rows, 21);
    check_absolute (e.line[0].l2.relative, l2, 1e-4);
    check_absolute (e.line[0].maximum.relative, middle, 1e-4);
    pg_errors_clear (&e);
    clear (&r);
}

static void edges (void **state)
{
    (void) state;
    static_beam (NODES, "constant", "off", 1.19904e-5, 0.0830, 0.0826);
    static_beam (NODES, "constant", "on", 1.24802e-5, 0.0455, 0.0452);
    static_beam (NODES, "quadratic", "off", 1.32184e-5, 0.0138, 0.0139);
    static_beam (NODES, "quadratic", "on", 1.26269e-5, 0.0316, 0.0314);
}

static void cells (void **state)
{
    (void) state;
    static_beam (CELLS, "constant", "on", 1.31473e-5, 0.0095, 0.0098);
    static_beam (CELLS, "quadratic", "on", 1.33035e-5, 0.0242, 0.0243);
}

/* 101 x 11 points; solver: all of it. */
static run coarse (const char *solver)
{
    static const char *const where[] = { "spacing=10 mm", "body[0].add.box.low=[-5 mm, -5 mm]",
                                         "body[0].add.box.high=[1005 mm, 105 mm]" };
    const char *const set[] = { where[0], where[1], where[2], solver };
    pg_errors e;
    run r = measured (path[NODES], 4, set, &e);
    assert_int_equal (r.problem->cloud.n, 101 * 11);
    pg_errors_clear (&e);
    return r;
}

/* Damped motion comes to rest where the static solver does, with Shen's damping, one found on the way, and
 * adaptive dynamic relaxation. */
static void relaxed (void **state)
{
    static const char *const solver[] = {
        "solver={kind: relax, damping: 5e6 kg/m3/s, imbalance: 1e-8, stages: 2}",
        "solver={kind: relax, imbalance: 1e-8, stages: 2}", "solver={kind: adr, imbalance: 1e-8, stages: 2}"
    };
    (void) state;
    run r = coarse ("solver={kind: static}");
    for (size_t k = 0; k < 3; k++) {
        run a = coarse (solver[k]);
        double off = largest_difference (a.state->d, r.state->d, r.state->ndof)
                     / largest_of (r.state->d, r.state->ndof);
        print_message ("%s: %ld iterations, off by %.2e\n", a.options.kind, a.state->iterations, off);
        check_below (off, 1e-5);
        check_below (a.step.residual, 1e-8);
        check_relative (a.step.reaction[1] + a.step.reaction[4], 1000, 1e-6);
        clear (&a);
    }
    clear (&r);
}

int main (void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test (edges), cmocka_unit_test (cells),
                                        cmocka_unit_test (relaxed) };
    return cmocka_run_group_tests_name ("scene_runs/shen_beam", tests, NULL, NULL);
}
