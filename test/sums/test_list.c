/* SPDX-License-Identifier: GPL-3.0-or-later
 * The loop over a list of bonds against the plain double loop, on lattices and irregular clouds, with several materials, shuffled numbers, broken
 * bonds and exempt points; all instruction sets and numbers of threads give the same bits. */
#include "lattice_body.h"

static const char *const sets[] = { "scalar", "avx2", "avx512" };
enum { SETS = 3 };

static const struct { body_wish body; double scatter; int mixed; } wishes[] = {
    { { { 70, 31, 1 }, 0.1, 0, 0, 2, 3.015, PG_SURFACE_NONE, PG_PARTIAL_OVERLAP, 0, PG_EVALUATE_LIST }, 0, 0 },
    { { { 70, 31, 1 }, 0.1, 1, 1, 2, 3.015, PG_SURFACE_VOLUME, PG_PARTIAL_OVERLAP, 1, PG_EVALUATE_LIST }, 0, 1 },
    { { { 50, 40, 1 }, 0.1, 0, 0, 2, 3.1, PG_SURFACE_NONE, PG_PARTIAL_LINEAR, 0, PG_EVALUATE_LIST }, 0.3, 1 },
    { { { 50, 40, 1 }, 0.1, 1, 0, 2, 4.1, PG_SURFACE_VOLUME, PG_PARTIAL_NONE, 1, PG_EVALUATE_LIST }, 0.3, 1 },
    { { { 40, 25, 1 }, 0.2, 0, 0, 2, 3.015, PG_SURFACE_PRODUCT, PG_PARTIAL_LINEAR, 0, PG_EVALUATE_AUTO }, 0.4, 0 },
    { { { 700, 1, 1 }, 0.05, 1, 0, 1, 3.015, PG_SURFACE_PRODUCT, PG_PARTIAL_LINEAR, 0, PG_EVALUATE_LIST }, 0.3, 1 },
    { { { 700, 1, 1 }, 0.05, 0, 0, 1, 4.2, PG_SURFACE_NONE, PG_PARTIAL_OVERLAP, 1, PG_EVALUATE_LIST }, 0, 0 },
    { { { 17, 9, 8 }, 0.1, 0, 0, 3, 3.015, PG_SURFACE_VOLUME, PG_PARTIAL_OVERLAP, 0, PG_EVALUATE_LIST }, 0, 1 },
    { { { 12, 11, 10 }, 0.1, 1, 0, 3, 2.5, PG_SURFACE_NONE, PG_PARTIAL_LINEAR, 1, PG_EVALUATE_LIST }, 0.3, 1 },
    { { { 35, 5, 6 }, 0, 0, 0, 3, 3.015, PG_SURFACE_VOLUME, PG_PARTIAL_NONE, 0, PG_EVALUATE_LIST }, 0.2, 0 },
    { { { 3, 3, 1 }, 0, 0, 0, 2, 3.015, PG_SURFACE_NONE, PG_PARTIAL_NONE, 0, PG_EVALUATE_LIST }, 0, 0 },     /* fewer points than lanes x 2 */
    { { { 2, 1, 1 }, 0, 0, 0, 1, 1.5, PG_SURFACE_NONE, PG_PARTIAL_NONE, 1, PG_EVALUATE_LIST }, 0, 0 },
    { { { 1, 1, 1 }, 0, 0, 0, 2, 3.015, PG_SURFACE_NONE, PG_PARTIAL_NONE, 0, PG_EVALUATE_LIST }, 0, 0 },     /* no bond at all */
};
enum { WISHES = sizeof wishes / sizeof *wishes };

static void wish (body *b, size_t w, uint64_t seed) { body_create_as (b, &wishes[w].body, wishes[w].scatter, wishes[w].mixed, seed); }

/* 1: made; 0: this machine lacks the instructions */
static int make_sweep (pg_sweep **out, const body *b, const char *set, int threads, int breaks)
{
    pg_sweep_setting setting = { .sums = b->sums, .family = &b->family, .modulus = b->modulus, .limit = breaks ? b->limit : NULL,
                                 .exempt = b->exempt, .threads = threads, .instructions = set };
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

static void forces_and_energy_equal_the_plain_loop (void **state)
{
    (void) state;
    for (size_t w = 0; w < WISHES; w++) {
        body b;
        wish (&b, w, 11 + w);
        body_wound (&b, 0.2);
        size_t values = b.cloud.n * (size_t) b.cloud.dim;
        double *f = pg_calloc (values, sizeof *f), *g = pg_calloc (values, sizeof *g), *first = NULL, energy = body_plain (&b, 0, g, NULL), stored = 0;
        for (int k = 0; k < SETS; k++)
            for (int threads = 1; threads <= 3; threads++) {
                pg_sweep *s = NULL;
                if (!make_sweep (&s, &b, sets[k], threads, 0)) continue;
                check_contains (pg_sweep_name (s), "list");
                check_contains (pg_sweep_name (s), sets[k]);
                pg_sweep_update (s, b.alive, NULL);
                memset (f, 0x7f, values * sizeof *f);
                check_ok (pg_sweep_force (s, b.u, f, NULL));
                close_to (f, g, values, 1e-13);
                double now = pg_sweep_energy (s, b.u);
                check_scaled (now, energy, 1e-12, 1e-300);
                if (!first) {
                    first = pg_calloc (values, sizeof *first), stored = now;
                    memcpy (first, f, values * sizeof *f);
                }
                assert_memory_equal (f, first, values * sizeof *f);
                assert_true (now == stored);
                check_ok (pg_sweep_energies (s, b.u, f));
                close_to (f, b.W, b.cloud.n, 1e-12);
                pg_sweep_free (&s);
                assert_null (s);
            }
        pg_free (f), pg_free (g), pg_free (first);
        body_free (&b);
    }
}

/* Every round moves the points a little more; broken bonds, and then forces, are those of the plain loop, which looks at each direction by itself. */
static void bonds_break_as_in_the_plain_loop (void **state)
{
    (void) state;
    for (size_t w = 0; w < WISHES; w++)
        for (int k = 0; k < 2 * SETS; k++) {
            body b;
            wish (&b, w, 100 + w);
            body_wound (&b, 0.1);
            for (size_t i = 0; k >= SETS && i < b.cloud.n; i++) b.exempt[i] = body_random (&b) < 0.2;
            size_t values = b.cloud.n * (size_t) b.cloud.dim, total = 0;
            double *f = pg_calloc (values, sizeof *f), *g = pg_calloc (values, sizeof *g);
            unsigned char *dead = pg_calloc (b.nbond, 1);
            pg_changes broken = { 0 };
            pg_sweep *s = NULL;
            int made = make_sweep (&s, &b, sets[k % SETS], 1 + k % 2, 1);
            if (made) pg_sweep_update (s, b.alive, NULL);
            for (int round = 0; made && round < 4; round++) {
                for (size_t i = 0; i < values; i++) b.u[i] *= 1.4;
                memset (dead, 0, b.nbond);
                body_plain (&b, 1, g, dead);
                size_t had = broken.n, at = had;
                check_ok (pg_sweep_force (s, b.u, f, &broken));
                for (size_t e = 0; e < b.nbond; e++) {
                    if (!dead[e]) continue;
                    assert_true (at < broken.n);
                    assert_int_equal (broken.bond[at++], e);
                }
                assert_int_equal (at, broken.n);
                close_to (f, g, values, 1e-13);
                total += broken.n - had;
            }
            if (made && b.nbond > 100) assert_true (total > 0 && total < b.nbond);
            pg_sweep_free (&s);
            pg_free (broken.bond), pg_free (f), pg_free (g), pg_free (dead);
            body_free (&b);
        }
}

static void changes_equal_a_whole_update (void **state)
{
    (void) state;
    for (size_t w = 0; w < WISHES; w++) {
        body b;
        wish (&b, w, 31 + w);
        size_t values = b.cloud.n * (size_t) b.cloud.dim;
        double *f = pg_calloc (values, sizeof *f), *g = pg_calloc (values, sizeof *g);
        pg_sweep *s = NULL, *t = NULL;
        make_sweep (&s, &b, NULL, 1, 0), make_sweep (&t, &b, NULL, 2, 0);
        for (int round = 0; round < 3; round++) {
            pg_changes changes = { 0 };
            unsigned char *before = pg_calloc (b.nbond, 1);
            changes.bond = pg_calloc (b.nbond, sizeof *changes.bond);
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

/* What a stencil can sum, a list sums as well: forces, energies, broken bonds. */
static void lists_equal_stencils (void **state)
{
    (void) state;
    static const body_wish both[] = {
        { { 90, 40, 1 }, 0.1, 0, 0, 2, 3.015, PG_SURFACE_NONE, PG_PARTIAL_OVERLAP, 0, PG_EVALUATE_LIST },
        { { 45, 60, 1 }, 0.1, 1, 1, 2, 4.2, PG_SURFACE_PRODUCT, PG_PARTIAL_LINEAR, 1, PG_EVALUATE_LIST },
        { { 700, 1, 1 }, 0.1, 0, 0, 1, 3.015, PG_SURFACE_PRODUCT, PG_PARTIAL_NONE, 0, PG_EVALUATE_LIST },
        { { 15, 14, 13 }, 0.1, 0, 0, 3, 3.015, PG_SURFACE_NONE, PG_PARTIAL_OVERLAP, 0, PG_EVALUATE_LIST },
        { { 15, 14, 13 }, 0.1, 0, 0, 3, 2.2, PG_SURFACE_NONE, PG_PARTIAL_OVERLAP, 1, PG_EVALUATE_LIST },
    };
    for (size_t w = 0; w < sizeof both / sizeof *both; w++) {
        body b;
        body_create (&b, &both[w], 7 + w);
        body_wound (&b, 0.05);
        size_t values = b.cloud.n * (size_t) b.cloud.dim;
        double *f = pg_calloc (values, sizeof *f), *g = pg_calloc (values, sizeof *g);
        pg_sweep *list = NULL, *stencil = NULL;
        pg_changes first = { 0 }, second = { 0 };
        make_sweep (&list, &b, NULL, 1, 1);
        b.sums->rule.evaluation = PG_EVALUATE_STENCIL;
        make_sweep (&stencil, &b, NULL, 1, 1);
        check_contains (pg_sweep_name (list), "list");
        check_contains (pg_sweep_name (stencil), "stencil");
        pg_sweep_update (list, b.alive, NULL), pg_sweep_update (stencil, b.alive, NULL);
        for (size_t i = 0; i < values; i++) b.u[i] *= 2;
        check_ok (pg_sweep_force (list, b.u, f, &first));
        check_ok (pg_sweep_force (stencil, b.u, g, &second));
        close_to (f, g, values, 1e-13);
        assert_true (first.n > 0);
        assert_int_equal (first.n, second.n);
        assert_memory_equal (first.bond, second.bond, first.n * sizeof *first.bond);
        check_relative (pg_sweep_energy (list, b.u), pg_sweep_energy (stencil, b.u), 1e-12);
        pg_sweep_free (&list), pg_sweep_free (&stencil);
        pg_free (f), pg_free (g), pg_free (first.bond), pg_free (second.bond);
        body_free (&b);
    }
}

/* Forces and their moments (finite: about the places moved to) cancel on the whole; the work of the forces is twice the energy of linear bonds. */
static void actions_equal_reactions (void **state)
{
    (void) state;
    for (size_t w = 0; w < WISHES; w++) {
        body b;
        wish (&b, w, 3 + w);
        body_wound (&b, 0.2);
        size_t n = b.cloud.n, dim = (size_t) b.cloud.dim;
        double *f = pg_calloc (n * dim, sizeof *f), sum[3] = { 0 }, moment[3] = { 0 }, size = 0, length = 0, work = 0;
        pg_sweep *s = NULL;
        make_sweep (&s, &b, NULL, 2, 0);
        pg_sweep_update (s, b.alive, NULL);
        check_ok (pg_sweep_force (s, b.u, f, NULL));
        for (size_t i = 0; i < n; i++) {
            double y[3] = { 0 }, F[3] = { 0 };
            for (size_t d = 0; d < dim; d++) {
                F[d] = f[i*dim + d], y[d] = b.cloud.x[i*dim + d] + (wishes[w].body.finite ? b.u[i*dim + d] : 0);
                sum[d] += F[d], size += fabs (F[d]), length = fmax (length, y[d]), work -= F[d] * b.u[i*dim + d];
            }
            for (int d = 0; d < 3; d++) moment[d] += y[(d + 1) % 3] * F[(d + 2) % 3] - y[(d + 2) % 3] * F[(d + 1) % 3];
        }
        for (int d = 0; d < 3; d++) check_scaled (sum[d], 0, 1e-14, size), check_scaled (moment[d], 0, 1e-13, size * length);
        if (!wishes[w].body.finite) check_scaled (work, 2 * pg_sweep_energy (s, b.u), 1e-12, 1e-300);
        pg_sweep_free (&s);
        pg_free (f);
        body_free (&b);
    }
}

/* A body 160 times its size away from the origin is summed no worse. */
static void places_far_away_do_no_harm (void **state)
{
    (void) state;
    body b;
    wish (&b, 2, 17);
    size_t values = b.cloud.n * 2;
    double *f = pg_calloc (values, sizeof *f), *g = pg_calloc (values, sizeof *g), *x = b.cloud.x;
    pg_sweep *s = NULL;
    make_sweep (&s, &b, NULL, 1, 0);
    check_ok (pg_sweep_force (s, b.u, f, NULL));
    pg_sweep_free (&s);
    for (size_t i = 0; i < values; i++) x[i] += 8;
    body_plain (&b, 0, g, NULL);
    make_sweep (&s, &b, NULL, 1, 0);
    check_ok (pg_sweep_force (s, b.u, f, NULL));
    close_to (f, g, values, 1e-13);
    pg_sweep_free (&s);
    pg_free (f), pg_free (g);
    body_free (&b);
}

static void lack_of_memory_is_reported (void **state)
{
    (void) state;
    body b;
    wish (&b, 2, 3);
    b.exempt[0] = 1;
    size_t before = pg_memory_used (), k = 1, values = b.cloud.n * 2;
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
        assert_true (k < 60);
    }
    assert_true (k > 8);
    /* bonds whose death could not be told live on and are told the next time */
    double *f = pg_calloc (values, sizeof *f), *g = pg_calloc (values, sizeof *g);
    unsigned char *dead = pg_calloc (b.nbond, 1);
    pg_changes broken = { 0 };
    for (size_t i = 0; i < values; i++) b.u[i] *= 3;
    for (k = 1; k <= 2; k++) {
        pg_memory_fail_at (k);
        check_fails (pg_sweep_force (s, b.u, f, &broken), PG_E_MEMORY);
        pg_memory_fail_at (0);
        assert_int_equal (broken.n, 0);
    }
    body_plain (&b, 1, g, dead);
    check_ok (pg_sweep_force (s, b.u, f, &broken));
    size_t total = 0;
    for (size_t e = 0; e < b.nbond; e++) total += dead[e];
    assert_true (total > 0);
    assert_int_equal (broken.n, total);
    close_to (f, g, values, 1e-13);
    pg_sweep_free (&s);
    pg_free (f), pg_free (g), pg_free (dead), pg_free (broken.bond);
    body_free (&b);
}

/* Bytes say what a bond costs: at most 8 for the coefficient and 4 for the end in each direction; steady sums allocate nothing. */
static void bonds_cost_what_is_said (void **state)
{
    (void) state;
    body b;
    wish (&b, 0, 3);
    double *f = pg_calloc (b.cloud.n * 2, sizeof *f), per_bond, per_point;
    pg_changes broken = { 0 };
    pg_sweep *s = NULL;
    make_sweep (&s, &b, NULL, 1, 1);
    pg_sweep_bytes (s, &per_bond, &per_point);
    assert_true (per_bond > 5 && per_bond < 12 && per_point > 60 && per_point < 140);
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
        cmocka_unit_test (changes_equal_a_whole_update),
        cmocka_unit_test (lists_equal_stencils),
        cmocka_unit_test (actions_equal_reactions),
        cmocka_unit_test (places_far_away_do_no_harm),
        cmocka_unit_test (lack_of_memory_is_reported),
        cmocka_unit_test (bonds_cost_what_is_said),
    };
    return cmocka_run_group_tests_name ("sums/list", tests, NULL, NULL);
}
