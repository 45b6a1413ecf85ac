/* SPDX-License-Identifier: GPL-3.0-or-later
 * Loops over the bonds of a lattice against the plain double loop: forces, energy, broken bonds; any number of threads gives the same bits,
 * and so do the instruction sets that fuse products and sums. */
#include "lattice_body.h"

static const char *const sets[] = { "scalar", "avx2", "avx512" };
enum { SETS = 3 };

/* 1: made; 0: this machine lacks the instructions */
static int make_sweep (pg_sweep **out, const body *b, const char *set, int threads, int breaks, int exempt)
{
    pg_sweep_setting setting = { .sums = b->sums, .family = &b->family, .modulus = b->modulus, .limit = breaks ? b->limit : NULL,
                                 .exempt = exempt ? b->exempt : NULL, .threads = threads, .instructions = set };
    pg_status status = pg_sweep_create (out, &setting);
    if (status == PG_E_USAGE && set && strstr (pg_last_error (), "this machine has none")) return 0;
    check_ok (status);
    return 1;
}

static double largest (const double *f, size_t n)
{
    double most = 0;
    for (size_t i = 0; i < n; i++) most = fmax (most, fabs (f[i]));
    return most;
}

static void close_to (const double *f, const double *g, size_t n, double tolerance)
{
    double most = largest (g, n);
    for (size_t i = 0; i < n; i++) check_scaled (f[i], g[i], tolerance, most);
}

static const body_wish wishes[] = {
    { { 70, 11, 1 }, 0.1, 0, 0, 2, 3.015, PG_SURFACE_NONE, PG_PARTIAL_OVERLAP, 0, PG_EVALUATE_STENCIL },
    { { 70, 11, 1 }, 0.1, 0, 0, 2, 3.015, PG_SURFACE_NONE, PG_PARTIAL_OVERLAP, 1, PG_EVALUATE_STENCIL },
    { { 64, 33, 1 }, 0, 0, 0, 2, 3, PG_SURFACE_NONE, PG_PARTIAL_NONE, 0, PG_EVALUATE_STENCIL },
    { { 33, 40, 1 }, 0, 1, 0, 2, 3, PG_SURFACE_PRODUCT, PG_PARTIAL_LINEAR, 0, PG_EVALUATE_STENCIL },
    { { 33, 40, 1 }, 0.3, 1, 0, 2, 3.015, PG_SURFACE_PRODUCT, PG_PARTIAL_OVERLAP, 1, PG_EVALUATE_STENCIL },
    { { 41, 20, 1 }, 0.2, 0, 1, 2, 5.2, PG_SURFACE_PRODUCT, PG_PARTIAL_OVERLAP, 0, PG_EVALUATE_STENCIL },
    { { 150, 1, 1 }, 0.05, 1, 0, 1, 3.015, PG_SURFACE_PRODUCT, PG_PARTIAL_NONE, 0, PG_EVALUATE_STENCIL },
    { { 150, 1, 1 }, 0.05, 0, 0, 1, 4.2, PG_SURFACE_NONE, PG_PARTIAL_LINEAR, 1, PG_EVALUATE_STENCIL },
    { { 17, 9, 8 }, 0.1, 0, 0, 3, 3.015, PG_SURFACE_NONE, PG_PARTIAL_OVERLAP, 0, PG_EVALUATE_STENCIL },
    { { 35, 5, 6 }, 0.1, 1, 1, 3, 3.015, PG_SURFACE_PRODUCT, PG_PARTIAL_NONE, 1, PG_EVALUATE_STENCIL },
    { { 40, 1, 1 }, 0, 0, 0, 2, 3.015, PG_SURFACE_NONE, PG_PARTIAL_NONE, 0, PG_EVALUATE_STENCIL },      /* thin ones */
    { { 2, 40, 1 }, 0, 0, 0, 2, 3.015, PG_SURFACE_NONE, PG_PARTIAL_OVERLAP, 0, PG_EVALUATE_STENCIL },
    { { 3, 3, 40 }, 0, 0, 0, 3, 3.015, PG_SURFACE_NONE, PG_PARTIAL_OVERLAP, 1, PG_EVALUATE_STENCIL },
    { { 40, 1, 2 }, 0, 0, 0, 3, 3.015, PG_SURFACE_PRODUCT, PG_PARTIAL_LINEAR, 0, PG_EVALUATE_STENCIL },
    { { 2, 1, 1 }, 0, 0, 0, 1, 1.5, PG_SURFACE_NONE, PG_PARTIAL_NONE, 0, PG_EVALUATE_STENCIL },
};
enum { WISHES = sizeof wishes / sizeof *wishes };

static void forces_and_energy_equal_the_plain_loop (void **state)
{
    (void) state;
    for (size_t w = 0; w < WISHES; w++) {
        body b;
        body_create (&b, &wishes[w], 11 + w);
        body_wound (&b, 0.2);
        size_t values = b.cloud.n * (size_t) b.cloud.dim;
        double *f = pg_calloc (values, sizeof *f), *g = pg_calloc (values, sizeof *g), *first = pg_calloc (values, sizeof *first), energy = body_plain (&b, 0, g, NULL), stored = 0;
        for (int k = 0; k < SETS; k++)
            for (int threads = 1; threads <= 3; threads++) {
                pg_sweep *s = NULL;
                if (!make_sweep (&s, &b, sets[k], threads, 0, 0)) continue;
                check_contains (pg_sweep_name (s), "stencil");
                check_contains (pg_sweep_name (s), sets[k]);
                pg_sweep_update (s, b.alive, NULL);
                memset (f, 0x7f, values * sizeof *f);
                check_ok (pg_sweep_force (s, b.u, f, NULL));
                close_to (f, g, values, 1e-13);
                double now = pg_sweep_energy (s, b.u);
                check_relative (now, energy, 1e-12);
                if (threads == 1 && k < 2) {
                    memcpy (first, f, values * sizeof *f);
                    stored = now;
                }
                assert_memory_equal (f, first, values * sizeof *f);
                check_ok (pg_sweep_energies (s, b.u, f));
                close_to (f, b.W, b.cloud.n, 1e-12);
                assert_true (now == stored);
                pg_sweep_free (&s);
                assert_null (s);
            }
        pg_free (f), pg_free (g), pg_free (first);
        body_free (&b);
    }
}

/* Every round moves the points a little more; broken bonds, and then forces, are those of the plain loop. */
static void bonds_break_as_in_the_plain_loop (void **state)
{
    (void) state;
    for (size_t w = 0; w < WISHES; w++)
        for (int k = 0; k < 2 * SETS; k++) {
            body b;
            body_create (&b, &wishes[w], 100 + w);
            body_wound (&b, 0.1);
            int exempt = k >= SETS;
            for (size_t i = 0; exempt && i < b.cloud.n; i++) b.exempt[i] = body_random (&b) < 0.2;
            size_t values = b.cloud.n * (size_t) b.cloud.dim, total = 0;
            double *f = pg_calloc (values, sizeof *f), *g = pg_calloc (values, sizeof *g);
            unsigned char *dead = pg_calloc (b.nbond, 1);
            pg_changes broken = { 0 };
            pg_sweep *s = NULL;
            if (make_sweep (&s, &b, sets[k % SETS], 1 + k % 2, 1, exempt)) {
                pg_sweep_update (s, b.alive, NULL);
                for (int round = 0; round < 4; round++) {
                    for (size_t i = 0; i < values; i++) b.u[i] *= 1.4;
                    memset (dead, 0, b.nbond);
                    body_plain (&b, 1, g, dead);
                    broken.n = 0;
                    check_ok (pg_sweep_force (s, b.u, f, &broken));
                    size_t at = 0;
                    for (size_t e = 0; e < b.nbond; e++) {
                        if (!dead[e]) continue;
                        assert_true (at < broken.n);
                        assert_int_equal (broken.bond[at], e);
                        at++;
                    }
                    assert_int_equal (at, broken.n);
                    assert_int_equal (broken.n % 2, 0);
                    close_to (f, g, values, 1e-13);
                    total += broken.n;
                }
                if (b.nbond > 100) assert_true (total > 0 && total < b.nbond);
            }
            pg_sweep_free (&s);
            pg_free (broken.bond), pg_free (f), pg_free (g), pg_free (dead);
            body_free (&b);
        }
}

/* Unless they are asked for, nothing breaks. */
static void nothing_breaks_unasked (void **state)
{
    (void) state;
    body b;
    body_create (&b, &wishes[0], 5);
    size_t values = b.cloud.n * 2;
    double *f = pg_calloc (values, sizeof *f), *g = pg_calloc (values, sizeof *g);
    for (size_t i = 0; i < values; i++) b.u[i] *= 1e3;
    body_plain (&b, 0, g, NULL);
    pg_sweep *s = NULL;
    pg_changes broken = { 0 };
    make_sweep (&s, &b, NULL, 1, 1, 0);
    check_ok (pg_sweep_force (s, b.u, f, NULL));
    close_to (f, g, values, 1e-13);
    pg_sweep_free (&s);
    make_sweep (&s, &b, NULL, 1, 0, 0);
    check_ok (pg_sweep_force (s, b.u, f, &broken));
    assert_int_equal (broken.n, 0);
    close_to (f, g, values, 1e-13);
    pg_sweep_free (&s);
    pg_free (f), pg_free (g);
    body_free (&b);
}

/* A stretch exactly at the limit on a lattice line: both directions of all bonds of that length and direction decide alike. */
static void ties_break_together (void **state)
{
    (void) state;
    for (int finite = 0; finite < 2; finite++)
        for (int k = 0; k < SETS; k++) {
            body_wish wish = { { 45, 9, 1 }, 0, 0, 0, 2, 3, PG_SURFACE_NONE, PG_PARTIAL_NONE, finite, PG_EVALUATE_STENCIL };
            body b;
            body_create (&b, &wish, 1);
            for (size_t i = 0; i < b.cloud.n; i++) b.u[2*i] = (b.cloud.x[2*i] > 22 * cell_side) * 1e-6, b.u[2*i + 1] = 0;
            double *f = pg_calloc (b.cloud.n * 2, sizeof *f);
            pg_changes broken = { 0 };
            pg_sweep *s = NULL;
            if (make_sweep (&s, &b, sets[k], 2, 1, 0)) {
                check_ok (pg_sweep_force (s, b.u, f, &broken));
                /* the bond of one step across the middle is stretched by 1e-3, its limit: nine rows, two directions */
                assert_int_equal (broken.n, 18);
                for (size_t c = 0; c < broken.n; c++) b.alive[broken.bond[c]] = 0;
                for (size_t i = 0; i < b.cloud.n; i++)
                    for (size_t e = b.family.start[i]; e < b.family.start[i + 1]; e++) assert_int_equal (b.alive[e], b.alive[body_reverse (&b, i, e)]);
            }
            pg_sweep_free (&s);
            pg_free (broken.bond), pg_free (f);
            body_free (&b);
        }
}

/* All bonds stretched to within rounding of the limit: those die whose measure, as the loops round it, is not below it, from both ends. */
static void rounding_decides_alike_everywhere (void **state)
{
    (void) state;
    for (int k = 0; k < SETS; k++) {
        body_wish wish = { { 64, 20, 1 }, 0, 0, 0, 2, 3.015, PG_SURFACE_NONE, PG_PARTIAL_NONE, 0, PG_EVALUATE_STENCIL };
        body b;
        body_create (&b, &wish, 1);
        for (size_t i = 0; i < b.cloud.n * 2; i++) b.u[i] = 1e-3 * b.cloud.x[i];
        double *f = pg_calloc (b.cloud.n * 2, sizeof *f), *xi = pg_calloc (b.cloud.n, sizeof *xi);
        pg_changes broken = { 0 };
        pg_sweep *s = NULL;
        size_t at = 0, live = 0, differ = 0;
        if (make_sweep (&s, &b, sets[k], 1, 1, 0)) {
            check_ok (pg_sweep_force (s, b.u, f, &broken));
            for (size_t i = 0; i < b.cloud.n; i++) {
                pg_sums_bonds (b.sums, &b.family, i, xi, NULL, NULL);
                for (size_t e = b.family.start[i]; e < b.family.start[i + 1]; e++) {
                    const double *x = xi + 2 * (e - b.family.start[i]), *v = b.u + 2 * (size_t) b.family.node[e], *u = b.u + 2*i;
                    double r = sqrt (x[0] * x[0] + x[1] * x[1]), plain = x[0] * (v[0] - u[0]) + x[1] * (v[1] - u[1]);
                    double fused = fma (x[1], v[1] - u[1], x[0] * (v[0] - u[0])), limit = 1e-3 * (r * r);
                    int dead = at < broken.n && broken.bond[at] == e;
                    at += (size_t) dead, live += (size_t) !dead, differ += (plain >= limit) != (fused >= limit);
#ifndef __FP_FAST_FMA
                    if (k == 0) fused = plain;
#endif
                    assert_int_equal (dead, fused >= limit);
                    b.alive[e] = !dead;
                }
            }
            assert_int_equal (at, broken.n);
            assert_true (at > 0 && live > 0 && differ > 0);
            for (size_t i = 0; i < b.cloud.n; i++)
                for (size_t e = b.family.start[i]; e < b.family.start[i + 1]; e++) assert_int_equal (b.alive[e], b.alive[body_reverse (&b, i, e)]);
        }
        pg_sweep_free (&s);
        pg_free (broken.bond), pg_free (f), pg_free (xi);
        body_free (&b);
    }
}

/* Updating by changes is updating all. */
static void changes_equal_a_whole_update (void **state)
{
    (void) state;
    for (size_t w = 0; w < WISHES; w++) {
        body b;
        body_create (&b, &wishes[w], 31 + w);
        size_t values = b.cloud.n * (size_t) b.cloud.dim;
        double *f = pg_calloc (values, sizeof *f), *g = pg_calloc (values, sizeof *g);
        pg_sweep *s = NULL, *t = NULL;
        make_sweep (&s, &b, NULL, 1, 0, 0), make_sweep (&t, &b, NULL, 2, 0, 0);
        for (int round = 0; round < 3; round++) {
            pg_changes changes = { 0 };
            changes.bond = pg_calloc (b.nbond, sizeof *changes.bond);
            unsigned char *before = pg_calloc (b.nbond, 1);
            memcpy (before, b.alive, b.nbond);
            body_wound (&b, 0.1);
            for (size_t e = 0; e < b.nbond; e++) if (before[e] && !b.alive[e]) changes.bond[changes.n++] = e;
            pg_sweep_update (s, b.alive, &changes);
            pg_sweep_update (t, b.alive, NULL);
            check_ok (pg_sweep_force (s, b.u, f, NULL));
            check_ok (pg_sweep_force (t, b.u, g, NULL));
            assert_memory_equal (f, g, values * sizeof *f);
            pg_free (changes.bond), pg_free (before);
        }
        memset (b.alive, 1, b.nbond);                  /* resurrection: a state may be read back */
        pg_sweep_update (s, b.alive, NULL);
        body_plain (&b, 0, g, NULL);
        check_ok (pg_sweep_force (s, b.u, f, NULL));
        close_to (f, g, values, 1e-13);
        pg_sweep_free (&s), pg_sweep_free (&t);
        pg_free (f), pg_free (g);
        body_free (&b);
    }
}

/* Finite: a rigid motion, however large, pulls at nothing; linear: a shift does not. Forces on the whole are none. */
static void rigid_motions_pull_at_nothing (void **state)
{
    (void) state;
    for (size_t w = 0; w < 2; w++) {
        body b;
        body_create (&b, &wishes[w], 3);
        size_t values = b.cloud.n * 2;
        double *f = pg_calloc (values, sizeof *f), angle = wishes[w].finite ? 1.1 : 0, sum[2] = { 0, 0 };
        pg_sweep *s = NULL;
        make_sweep (&s, &b, NULL, 1, 0, 0);
        check_ok (pg_sweep_force (s, b.u, f, NULL));
        double size = largest (f, values);
        for (size_t i = 0; i < values; i++) sum[i % 2] += f[i];
        for (int d = 0; d < 2; d++) check_scaled (sum[d], 0, 1e-12, size);
        for (size_t i = 0; i < b.cloud.n; i++) {
            const double *x = b.cloud.x + 2*i;
            b.u[2*i] = 0.25 + cos (angle) * x[0] - sin (angle) * x[1] - x[0], b.u[2*i + 1] = 0.5 + sin (angle) * x[0] + cos (angle) * x[1] - x[1];
        }
        check_ok (pg_sweep_force (s, b.u, f, NULL));
        check_below (largest (f, values), 1e-9 * size);
        pg_sweep_free (&s);
        pg_free (f);
        body_free (&b);
    }
}

static void wrong_wishes_are_refused (void **state)
{
    (void) state;
    body b;
    body_create (&b, &wishes[0], 3);
    pg_sweep *s = NULL;
    pg_sweep_setting setting = { .sums = b.sums, .family = &b.family, .modulus = b.modulus, .limit = b.limit, .threads = 1, .instructions = "neon" };
    check_fails (pg_sweep_create (&s, &setting), PG_E_USAGE);
    check_contains (pg_last_error (), "neon");
    assert_null (s);
    setting.instructions = NULL;
    b.modulus[7] *= 2;
    check_fails (pg_sweep_create (&s, &setting), PG_E_USAGE);
    check_contains (pg_last_error (), "several moduli");
    b.modulus[7] = b.modulus[0], b.limit[3] *= 2;
    check_fails (pg_sweep_create (&s, &setting), PG_E_USAGE);
    check_contains (pg_last_error (), "several critical stretches");
    body_free (&b);
    body_wish wish = wishes[0];
    wish.surface = PG_SURFACE_VOLUME;
    body_create (&b, &wish, 3);
    setting = (pg_sweep_setting) { .sums = b.sums, .family = &b.family, .modulus = b.modulus, .threads = 1 };
    check_fails (pg_sweep_create (&s, &setting), PG_E_USAGE);
    check_contains (pg_last_error (), "volume");
    body_free (&b);
}

static void lack_of_memory_is_reported (void **state)
{
    (void) state;
    body b;
    body_create (&b, &wishes[4], 3);
    b.exempt[0] = 1;
    size_t before = pg_memory_used (), k = 1;
    pg_sweep *s = NULL;
    pg_sweep_setting setting = { .sums = b.sums, .family = &b.family, .modulus = b.modulus, .limit = b.limit, .exempt = b.exempt, .threads = 1 };
    for (pg_status status = PG_E_MEMORY; status != PG_OK; k++) {
        pg_memory_fail_at (k);
        status = pg_sweep_create (&s, &setting);
        pg_memory_fail_at (0);
        if (status == PG_OK) break;
        assert_int_equal (status, PG_E_MEMORY);
        assert_null (s);
        assert_int_equal (pg_memory_used (), before);
        assert_true (k < 50);
    }
    assert_true (k > 8);
    /* ... and when bonds break */
    double *f = pg_calloc (b.cloud.n * 2, sizeof *f);
    pg_changes broken = { 0 };
    for (size_t i = 0; i < b.cloud.n * 2; i++) b.u[i] *= 100;
    pg_memory_fail_at (1);
    check_fails (pg_sweep_force (s, b.u, f, &broken), PG_E_MEMORY);
    pg_memory_fail_at (0);
    pg_sweep_free (&s);
    pg_free (f), pg_free (broken.bond);
    body_free (&b);
}

static void steady_sums_allocate_nothing (void **state)
{
    (void) state;
    body b;
    body_create (&b, &wishes[0], 3);
    double *f = pg_calloc (b.cloud.n * 2, sizeof *f), per_bond, per_point;
    pg_changes broken = { 0 };
    pg_sweep *s = NULL;
    make_sweep (&s, &b, NULL, 2, 1, 0);
    pg_sweep_bytes (s, &per_bond, &per_point);
    assert_true (per_bond > 0.12 && per_bond < 1 && per_point > 60 && per_point < 140);
    size_t calls = pg_memory_calls ();
    for (int k = 0; k < 5; k++) check_ok (pg_sweep_force (s, b.u, f, &broken));
    assert_int_equal (broken.n, 0);
    assert_int_equal (pg_memory_calls (), calls);
    pg_sweep_free (&s);
    pg_free (f);
    body_free (&b);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (forces_and_energy_equal_the_plain_loop),
        cmocka_unit_test (bonds_break_as_in_the_plain_loop),
        cmocka_unit_test (nothing_breaks_unasked),
        cmocka_unit_test (ties_break_together),
        cmocka_unit_test (rounding_decides_alike_everywhere),
        cmocka_unit_test (changes_equal_a_whole_update),
        cmocka_unit_test (rigid_motions_pull_at_nothing),
        cmocka_unit_test (wrong_wishes_are_refused),
        cmocka_unit_test (lack_of_memory_is_reported),
        cmocka_unit_test (steady_sums_allocate_nothing),
    };
    return cmocka_run_group_tests_name ("sums/sweep", tests, NULL, NULL);
}
