/* SPDX-License-Identifier: GPL-3.0-or-later
 * Adaptive dynamic relaxation (Kilic and Madenci 2010; theory B4) as a plain loop on a plate of 60 x 20 points: theory H, ADR-1. Three
 * columns at the left end are held; the right end is drawn by as many, or bent by forces on its last column. The answer is that of a
 * factorisation. Density D_i = 1/4 sum_j |K_ij|, dt = 1. The update that Zhou's paper prints, u += dt v^n with v^n = (v^(n-1/2) + v^(n+1/2)) / 2, diverges. */
#include "direct.h"

enum { GRIP = 3 };
enum { DRAWN, BENT };
static const char plate[] = "dimension: 2\nbody: [{add: {box: {low: [0, 0], high: [60 mm, 20 mm]}}}]\nspacing: 1 mm\nlattice: cells\nthickness: 1 mm\n";

typedef struct { direct b; size_t n; double *u, *P, *exact, *K_abs; } problem;      /* P: N                             */

static void make (problem *p, int how)
{
    direct_build (&p->b, plate, "constant", 3.015e-3, 192e9, 1, PG_PARTIAL_NONE);
    p->n = 2 * p->b.n;
    p->u = pg_calloc (p->n, sizeof *p->u), p->P = pg_calloc (p->n, sizeof *p->P);
    p->exact = pg_calloc (p->n, sizeof *p->exact), p->K_abs = pg_calloc (p->n, sizeof *p->K_abs);
    assert_int_equal (p->b.n, 60 * 20);
    direct_assemble (&p->b);                           /* nothing held yet: the whole matrix                              */
    for (size_t i = 0; i < p->b.n; i++) {
        double x = p->b.cloud.x[2*i];
        if (how == BENT && x > 0.059) p->P[2*i + 1] = 1;
        if (x > GRIP * 1e-3 && (how == BENT || x < (60 - GRIP) * 1e-3)) continue;
        p->b.held[2*i] = p->b.held[2*i + 1] = 1;
        p->u[2*i] = x < 0.03 ? 0 : 6e-5;
    }
    for (size_t j = 0; j < p->n; j++)
        for (long k = p->b.K.start[j]; k < p->b.K.start[j + 1]; k++) {
            p->K_abs[j] += fabs (p->b.K.value[k]);
            if ((size_t) p->b.K.row[k] != j) p->K_abs[p->b.K.row[k]] += fabs (p->b.K.value[k]);
        }
}

static void clear (problem *p)
{
    pg_free (p->u), pg_free (p->P), pg_free (p->exact), pg_free (p->K_abs);
    direct_clear (&p->b);
}

/* P - K u on the free dofs, 0 on the held ones. */
static void out_of_balance (const problem *p, const double *u, double *f)
{
    pg_sparse_multiply (&p->b.K, u, f);
    for (size_t i = 0; i < p->n; i++) f[i] = p->b.held[i] ? 0 : p->P[i] - f[i];
}

static void solve_exactly (problem *p)
{
    double *f = pg_calloc (p->n, sizeof *f), *d = pg_calloc (p->n, sizeof *d);
    pg_sparse whole = p->b.K;
    out_of_balance (p, p->u, f);
    direct_assemble (&p->b);                           /* now with the held ones                                          */
    void *factor = direct_factor (&p->b);
    check_ok (pg_linear_find ("cholmod")->solve (factor, 1, f, d));
    for (size_t i = 0; i < p->n; i++) p->exact[i] = p->u[i] + d[i];
    pg_linear_find ("cholmod")->free (&factor);
    pg_sparse_clear (&p->b.K);
    p->b.K = whole;
    pg_free (f), pg_free (d);
}

static double error_of (const problem *p)
{
    double sum = 0, all = 0;
    for (size_t i = 0; i < p->n; i++) sum += pow (p->u[i] - p->exact[i], 2), all += pow (p->exact[i], 2);
    return sqrt (sum / all);
}

/* c^n of theory B4 from the forces of this and the last iteration; D = K_abs / 4. */
static double damping (const problem *p, const double *f, const double *before, const double *v)
{
    double uku = 0, uu = 0;
    for (size_t i = 0; i < p->n; i++) {
        double D = p->K_abs[i] / 4, k = p->b.held[i] || v[i] == 0 ? 0 : -(f[i] - before[i]) / (D * v[i]);
        if (p->b.held[i]) continue;
        uku += p->u[i] * k * p->u[i], uu += p->u[i] * p->u[i];
    }
    double c = uu > 0 && uku > 0 ? 2 * sqrt (uku / uu) : 0;
    return fmin (c, 1.9);
}

/* Goes on from u = 0 inside; error[k] after (k + 1) * every iterations. as_printed: Zhou's (20). */
static void relax (problem *p, int iterations, int every, int as_printed, double *error)
{
    double *f = pg_calloc (p->n, sizeof *f), *before = pg_calloc (p->n, sizeof *before), *v = pg_calloc (p->n, sizeof *v);
    for (int n = 0; n < iterations; n++) {
        memcpy (before, f, p->n * sizeof *f);
        out_of_balance (p, p->u, f);
        double c = n ? damping (p, f, before, v) : 0;
        for (size_t i = 0; i < p->n; i++) {
            double a = p->b.held[i] ? 0 : 4 * f[i] / p->K_abs[i], old = v[i];
            v[i] = n ? ((2 - c) * v[i] + 2 * a) / (2 + c) : a / 2;
            p->u[i] += as_printed && n ? (old + v[i]) / 2 : v[i];
        }
        if ((n + 1) % every == 0) error[n / every] = error_of (p);
    }
    pg_free (f), pg_free (before), pg_free (v);
}

/* Errors after 500 and 1000 iterations. */
static void converges (int how, double *error)
{
    problem p;
    make (&p, how);
    solve_exactly (&p);
    relax (&p, 1000, 500, 0, error);
    print_message ("%s: error after 500 iterations %.2e, 1000: %.2e\n", how == BENT ? "bent" : "drawn", error[0], error[1]);
    clear (&p);
}

static void drawn (void **state)                       /* ADR-1                                                          */
{
    (void) state;
    double error[2];
    converges (DRAWN, error);
    check_below (error[0], 1e-6);
    check_below (error[1], 1e-11);
}

/* Its lowest frequency is far below that of stretching: much slower, but it arrives. */
static void bent (void **state)
{
    (void) state;
    double error[2];
    converges (BENT, error);
    check_below (error[0], 0.2);
    check_below (error[1], 0.01);
}

static void diverges_as_printed (void **state)
{
    (void) state;
    double error[2];
    problem p;
    make (&p, DRAWN);
    solve_exactly (&p);
    relax (&p, 200, 100, 1, error);
    print_message ("as printed: error after 100 iterations %.2e, 200: %.2e\n", error[0], error[1]);
    assert_true (error[0] > 1e6 && error[1] > 1e10 * error[0]);
    clear (&p);
}

int main (void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test (drawn), cmocka_unit_test (bent), cmocka_unit_test (diverges_as_printed) };
    return cmocka_run_group_tests_name ("method/adr", tests, NULL, NULL);
}
