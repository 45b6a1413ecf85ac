/* SPDX-License-Identifier: GPL-3.0-or-later
 * Adaptive dynamic relaxation (Kilic and Madenci 2010; theory B4) on a plate of 60 x 20 points: theory H,
 * ADR-1. Three columns at the left end are held; the right end is drawn by as many, or bent by forces on its
 * last column. The solver `adr` arrives at the answer of a factorization, in so many iterations. The update
 * that Zhou's paper prints, u += dt v^n with v^n = (v^(n-1/2) + v^(n+1/2)) / 2, diverges: density D_i = 1/4
 * sum_j |K_ij|, dt = 1. */
#include "scene_runs/run.h"

static const char plate[] =
    "dimension: 2\nplane: stress\nbody: [{add: {box: {low: [0, 0], high: [60 mm, 20 mm]}}}]\nspacing: 1 "
    "mm\nlattice: cells\nthickness: 1 mm\n"
    "materials: {iron: {youngs_modulus: 192 GPa, poissons_ratio: 0.333333333333333}}\nmethod: {force: bond, "
    "horizon: 3.015 spacing, partial_volume: none, surface_correction: none}\n"
    "sets: {l: {where: x < 3 mm}, r: {where: x > 57 mm}, last: {where: x > 59 mm}}\n";
#define DRAWN "boundary: [{set: l, displacement: {x: 0, y: 0}}, {set: r, displacement: {x: 60 um, y: 0}}]\n"
#define BENT "boundary: [{set: l, displacement: {x: 0, y: 0}}, {set: last, force: {y: 20 N}}]\n"

static run solved (const char *ends, const char *solver)
{
    run r = scene_of (1, "%s%ssolver: {%s}\n", plate, ends, solver);
    assert_int_equal (r.problem->cloud.n, 60 * 20);
    to_the_end (&r);
    return r;
}

static double apart (size_t n, const double *u, const double *exact)
{
    double sum = 0, all = 0;
    for (size_t i = 0; i < n; i++) sum += pow (u[i] - exact[i], 2), all += pow (exact[i], 2);
    return sqrt (sum / all);
}

/* Relative error in the displacement and iterations at an imbalance of forces. */
static double error_at (const char *ends, const char *imbalance, long *iterations)
{
    char solver[100];
    snprintf (solver, sizeof solver, "kind: adr, stages: 1, imbalance: %s", imbalance);
    run exact = solved (ends, "kind: static, linear: cholmod, stepping: fixed, steps: 1"),
        r = solved (ends, solver);
    double error = apart (r.state->ndof, r.state->d, exact.state->d);
    *iterations = r.step.iterations;
    print_message ("imbalance %s: error %.2e after %ld iterations\n", imbalance, error, *iterations);
    clear (&exact), clear (&r);
    return error;
}

static void drawn (void **state)                       /* ADR-1 */
{
    (void) state;
    long few, many;
    check_below (error_at (DRAWN, "1e-5", &few), 2e-5);
    check_below (error_at (DRAWN, "1e-10", &many), 2e-10);
    check_below ((double) few, 300);
    check_below ((double) many, 500);
}

/* Its lowest frequency is far below that of stretching: much slower, but it arrives. */
static void bent (void **state)
{
    (void) state;
    long few, many;
    check_below (error_at (BENT, "1e-5", &few), 5e-4);
    check_below (error_at (BENT, "1e-8", &many), 5e-7);
    check_below ((double) many, 2700);
    assert_true (many > few);
}

/* ---- as printed ---------------------------------------------------------------------------------------- */
/* c^n of theory B4 from the forces of this and the last iteration */
static double damping (const run *r, const double *D, const double *u, const double *f, const double *before,
                       const double *v)
{
    double uku = 0, uu = 0;
    for (size_t i = 0; i < r->state->ndof; i++) {
        double x = r->problem->cloud.x[i / 2 * 2], k = v[i] == 0 ? 0 : -(f[i] - before[i]) / (D[i] * v[i]);
        if (x < 0.003 || x > 0.057) continue;
        uku += u[i] * k * u[i], uu += u[i] * u[i];
    }
    return fmin (uu > 0 && uku > 0 ? 2 * sqrt (uku / uu) : 0, 1.9);
}

static void the_printed_update_diverges (void **state)
{
    (void) state;
    run r = solved (DRAWN, "kind: static, linear: cholmod, stepping: fixed, steps: 1");
    void *self;
    const pg_force_type *force = pg_solver_force (r.solver, &self);
    size_t n = r.state->ndof;
    double *u = pg_calloc (n, sizeof *u), *f = pg_calloc (n, sizeof *f), *before = pg_calloc (n, sizeof *f),
           *v = pg_calloc (n, sizeof *f), *D = pg_calloc (n, sizeof *f);
    double reference, error[2] = { 0 };
    check_ok (force->motion.row_sums (self, D));
    check_ok (force->impose (self, 1, u));
    for (size_t i = 0; i < n; i++) D[i] /= 4;
    for (int k = 0; k < 200; k++) {
        memcpy (before, f, n * sizeof *f);
        check_ok (force->balance (self, 1, u, f, &reference));
        for (size_t i = 0; i < n; i++)
            if (r.problem->cloud.x[i / 2 * 2] < 0.003 || r.problem->cloud.x[i / 2 * 2] > 0.057) f[i] = 0;
        double c = k ? damping (&r, D, u, f, before, v) : 0;
        for (size_t i = 0; i < n; i++) {
            double a = f[i] / D[i], old = v[i];
            v[i] = k ? ((2 - c) * v[i] + 2 * a) / (2 + c) : a / 2;
            u[i] += k ? (old + v[i]) / 2 : v[i];
        }
        if (k % 100 == 99) error[k / 100] = apart (n, u, r.state->d);
    }
    print_message ("as printed: error after 100 iterations %.2e, 200: %.2e\n", error[0], error[1]);
    assert_true (error[0] > 1e6 && error[1] > 1e10 * error[0]);
    pg_free (u), pg_free (f), pg_free (before), pg_free (v), pg_free (D);
    clear (&r);
}

int main (void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test (drawn), cmocka_unit_test (bent),
                                        cmocka_unit_test (the_printed_update_diverges) };
    return cmocka_run_group_tests_name ("method/adr", tests, NULL, NULL);
}
