/* SPDX-License-Identifier: GPL-3.0-or-later
 * Loops over the bonds of a lattice against the plain double loop: forces, energy, broken bonds; any number
 * of threads gives the same bits, and so do the instruction sets that fuse products and sums. */
#include "sweeps.h"

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
    /* blocks of 32 points that have all their bonds */
    { { 130, 9, 1 }, 0, 0, 0, 2, 3.015, PG_SURFACE_NONE, PG_PARTIAL_OVERLAP, 0, PG_EVALUATE_STENCIL },
    /* thin ones */
    { { 40, 1, 1 }, 0, 0, 0, 2, 3.015, PG_SURFACE_NONE, PG_PARTIAL_NONE, 0, PG_EVALUATE_STENCIL },
    { { 2, 40, 1 }, 0, 0, 0, 2, 3.015, PG_SURFACE_NONE, PG_PARTIAL_OVERLAP, 0, PG_EVALUATE_STENCIL },
    { { 3, 3, 40 }, 0, 0, 0, 3, 3.015, PG_SURFACE_NONE, PG_PARTIAL_OVERLAP, 1, PG_EVALUATE_STENCIL },
    { { 40, 1, 2 }, 0, 0, 0, 3, 3.015, PG_SURFACE_PRODUCT, PG_PARTIAL_LINEAR, 0, PG_EVALUATE_STENCIL },
    { { 2, 1, 1 }, 0, 0, 0, 1, 1.5, PG_SURFACE_NONE, PG_PARTIAL_NONE, 0, PG_EVALUATE_STENCIL },
};
static void wish (body *b, size_t w, uint64_t seed) { body_create (b, &wishes[w], seed); }
static const swept stencils = { "stencil", wish, sizeof wishes / sizeof *wishes, 1 };

static void forces_and_energy_equal_the_plain_loop (void **state)
{
    (void) state, sums_equal_the_plain_loop (&stencils);
}
static void bonds_break_as_in_the_plain_loop (void **state)
{
    (void) state, breaking_equals_the_plain_loop (&stencils);
}
static void changes_equal_a_whole_update (void **state)
{
    (void) state, updates_by_changes_equal_whole_ones (&stencils);
}
static void steady_sums_allocate_nothing (void **state)
{
    (void) state, steady_sums_cost_what_is_said (&stencils, 2, 0.12, 1);
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
    pg_bond_loop *s = NULL;
    pg_changes broken = { 0 };
    make_sweep (&s, &b, NULL, 1, 1, 0);
    check_ok (pg_bond_loop_force (s, b.u, f, NULL));
    close_to (f, g, values, 1e-13);
    pg_bond_loop_free (&s);
    make_sweep (&s, &b, NULL, 1, 0, 0);
    check_ok (pg_bond_loop_force (s, b.u, f, &broken));
    assert_int_equal (broken.n, 0);
    close_to (f, g, values, 1e-13);
    pg_bond_loop_free (&s);
    pg_free (f), pg_free (g);
    body_free (&b);
}

/* A stretch exactly at the limit on a lattice line: both directions of all bonds of that length and direction
 * decide alike. */
static void ties_break_together (void **state)
{
    (void) state;
    for (int finite = 0; finite < 2; finite++)
        for (int k = 0; k < SETS; k++) {
            body_wish wish = { { 45, 9, 1 },       0, 0, 0, 2, 3, PG_SURFACE_NONE, PG_PARTIAL_NONE, finite,
                               PG_EVALUATE_STENCIL };
            body b;
            body_create (&b, &wish, 1);
            for (size_t i = 0; i < b.cloud.n; i++)
                b.u[2 * i] = (b.cloud.x[2 * i] > 22 * cell_side) * 1e-6, b.u[2 * i + 1] = 0;
            double *f = pg_calloc (b.cloud.n * 2, sizeof *f);
            pg_changes broken = { 0 };
            pg_bond_loop *s = NULL;
            if (make_sweep (&s, &b, sets[k], 2, 1, 0)) {
                check_ok (pg_bond_loop_force (s, b.u, f, &broken));
                /* the bond of one step across the middle is stretched by 1e-3, its limit: nine rows, two
                 * directions */
                assert_int_equal (broken.n, 18);
                for (size_t c = 0; c < broken.n; c++) b.alive[broken.bond[c]] = 0;
                for (size_t i = 0; i < b.cloud.n; i++)
                    for (size_t e = b.family.start[i]; e < b.family.start[i + 1]; e++)
                        assert_int_equal (b.alive[e], b.alive[body_reverse (&b, i, e)]);
            }
            pg_bond_loop_free (&s);
            pg_free (broken.bond), pg_free (f);
            body_free (&b);
        }
}

/* All bonds stretched to within rounding of the limit: those die whose measure, as the loops round it, is not
 * below it, from both ends. */
static void rounding_decides_alike_everywhere (void **state)
{
    (void) state;
    for (int k = 0; k < SETS; k++) {
        body_wish wish = { { 64, 20, 1 },      0, 0, 0, 2, 3.015, PG_SURFACE_NONE, PG_PARTIAL_NONE, 0,
                           PG_EVALUATE_STENCIL };
        body b;
        body_create (&b, &wish, 1);
        for (size_t i = 0; i < b.cloud.n * 2; i++) b.u[i] = 1e-3 * b.cloud.x[i];
        double *f = pg_calloc (b.cloud.n * 2, sizeof *f), *xi = pg_calloc (b.cloud.n, sizeof *xi);
        pg_changes broken = { 0 };
        pg_bond_loop *s = NULL;
        size_t at = 0, live = 0, differ = 0;
        if (make_sweep (&s, &b, sets[k], 1, 1, 0)) {
            check_ok (pg_bond_loop_force (s, b.u, f, &broken));
            for (size_t i = 0; i < b.cloud.n; i++) {
                pg_sums_bonds (b.sums, &b.family, i, xi, NULL, NULL);
                for (size_t e = b.family.start[i]; e < b.family.start[i + 1]; e++) {
                    const double *x = xi + 2 * (e - b.family.start[i]),
                                 *v = b.u + 2 * (size_t) b.family.node[e], *u = b.u + 2 * i;
                    double r = sqrt (x[0] * x[0] + x[1] * x[1]),
                           plain = x[0] * (v[0] - u[0]) + x[1] * (v[1] - u[1]);
                    double fused = fma (x[1], v[1] - u[1], x[0] * (v[0] - u[0])), limit = 1e-3 * (r * r);
                    int dead = at < broken.n && broken.bond[at] == e;
                    at += (size_t) dead, live += (size_t) !dead,
                        differ += (plain >= limit) != (fused >= limit);
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
                for (size_t e = b.family.start[i]; e < b.family.start[i + 1]; e++)
                    assert_int_equal (b.alive[e], b.alive[body_reverse (&b, i, e)]);
        }
        pg_bond_loop_free (&s);
        pg_free (broken.bond), pg_free (f), pg_free (xi);
        body_free (&b);
    }
}

/* Finite: a rigid motion, however large, pulls at nothing; linear: a shift does not. Forces on the whole are
 * none. */
static void rigid_motions_pull_at_nothing (void **state)
{
    (void) state;
    for (size_t w = 0; w < 2; w++) {
        body b;
        body_create (&b, &wishes[w], 3);
        size_t values = b.cloud.n * 2;
        double *f = pg_calloc (values, sizeof *f), angle = wishes[w].finite ? 1.1 : 0, sum[2] = { 0, 0 };
        pg_bond_loop *s = NULL;
        make_sweep (&s, &b, NULL, 1, 0, 0);
        check_ok (pg_bond_loop_force (s, b.u, f, NULL));
        double size = largest (f, values);
        for (size_t i = 0; i < values; i++) sum[i % 2] += f[i];
        for (int d = 0; d < 2; d++) check_scaled (sum[d], 0, 1e-12, size);
        for (size_t i = 0; i < b.cloud.n; i++) {
            const double *x = b.cloud.x + 2*i;
            b.u[2 * i] = 0.25 + cos (angle) * x[0] - sin (angle) * x[1] - x[0],
                    b.u[2 * i + 1] = 0.5 + sin (angle) * x[0] + cos (angle) * x[1] - x[1];
        }
        check_ok (pg_bond_loop_force (s, b.u, f, NULL));
        check_below (largest (f, values), 1e-9 * size);
        pg_bond_loop_free (&s);
        pg_free (f);
        body_free (&b);
    }
}

/* ---- folded stencils ----------------------------------------------------------------------------------- */
static pg_bond_loop *folded_or_plain (const body *b, const char *set, int threads, int exempt, int plain)
{
    pg_bond_loop_setting setting = { .sums = b->sums,
                                     .family = &b->family,
                                     .modulus = b->modulus,
                                     .limit = b->limit,
                                     .exempt = exempt ? b->exempt : NULL,
                                     .threads = threads,
                                     .plain = plain,
                                     .instructions = set };
    pg_bond_loop *s = NULL;
    pg_status status = pg_bond_loop_create (&s, &setting);
    if (status == PG_E_USAGE && set && strstr (pg_last_error (), "this machine has none")) return NULL;
    check_ok (status);
    return s;
}

/* A body that a bump tears open while it moves as a whole and is strained; the bump wanders. */
static void move_body (body *b, int step)
{
    for (size_t i = 0; i < b->cloud.n; i++) {
        const double *x = b->cloud.x + 2 * i;
        double at = b->cloud.low[0] + (0.4 + 0.02 * step) * (b->cloud.high[0] - b->cloud.low[0]),
               dx = (x[0] - at) / cell_side,
               dy = (x[1] - 0.5 * (b->cloud.low[1] + b->cloud.high[1])) / cell_side,
               bump = 2e-4 * cell_side * step * exp (-(dx * dx + dy * dy) / 9);
        b->u[2 * i] = 0.8e-3 * x[0] + bump + 5 * cell_side * step;
        b->u[2 * i + 1] = -0.3e-3 * x[1] + 0.4 * bump;
    }
}

/* ... that opens slowly between two blocks of 32 sites, each of which moves as a whole. */
static void open_body (body *b, int step)
{
    for (size_t i = 0; i < b->cloud.n; i++)            /* 160 sites a row, all with points */
        b->u[2 * i] = i % 160 >= 64 ? 1.3e-3 * step / 200.0 * cell_side : 0, b->u[2 * i + 1] = 0;
}

/* Looks that are spared while a body moves slowly come in time. */
static void looks_come_in_time (void **state)
{
    (void) state;
    body b;
    body_create (&b, &(body_wish){ { 160, 24, 1 }, 0, 0, 0, 2, 3.015, PG_SURFACE_NONE, PG_PARTIAL_OVERLAP, 0,
                                   PG_EVALUATE_STENCIL }, 3);
    size_t values = 2 * b.cloud.n;
    double *f = pg_calloc (values, sizeof *f), *g = pg_calloc (values, sizeof *g);
    pg_bond_loop *plain = folded_or_plain (&b, NULL, 1, 0, 1), *folded = folded_or_plain (&b, NULL, 1, 0, 0);
    pg_changes torn = { 0 }, broken = { 0 };
    for (int step = 0; step <= 200; step++) {
        open_body (&b, step);
        check_ok (pg_bond_loop_force (plain, b.u, g, &torn));
        check_ok (pg_bond_loop_force (folded, b.u, f, &broken));
        assert_int_equal (broken.n, torn.n);
        if (torn.n) assert_memory_equal (broken.bond, torn.bond, torn.n * sizeof *torn.bond);
        close_to (f, g, values, 1e-11);
    }
    pg_bond_loop_counts count;
    pg_bond_loop_counted (folded, &count);
    print_message ("%zu bonds broke; %zu folded, %zu looks\n", torn.n, count.folded, count.looks);
    assert_true (torn.n > 20 && 3 * count.looks < count.folded);
    pg_bond_loop_free (&plain), pg_bond_loop_free (&folded);
    pg_free (f), pg_free (g), pg_free (torn.bond), pg_free (broken.bond);
    body_free (&b);
}

static const body_wish wide[] = {
    { { 130, 24, 1 }, 0, 0, 0, 2, 1.5, PG_SURFACE_NONE, PG_PARTIAL_NONE, 0, PG_EVALUATE_STENCIL },
    { { 230, 24, 1 }, 0, 0, 0, 2, 3.015, PG_SURFACE_NONE, PG_PARTIAL_OVERLAP, 0, PG_EVALUATE_STENCIL },
    { { 150, 40, 1 }, 0.002, 0, 0, 2, 3, PG_SURFACE_NONE, PG_PARTIAL_NONE, 0, PG_EVALUATE_STENCIL },
    { { 140, 30, 1 }, 0, 0, 0, 2, 5.2, PG_SURFACE_NONE, PG_PARTIAL_LINEAR, 0, PG_EVALUATE_STENCIL },
};

/* Folded sums are those bond by bond, and so are the bonds that break, whatever the instructions and threads;
 * looks are spared. A loop that is renewed on the way, as by a resumed run, gives the bits of one that was
 * not: what it knows of stretches decides when bonds are looked at, and nothing else. */
static void folding_changes_nothing (void **state)
{
    (void) state;
    for (size_t w = 0; w < sizeof wide / sizeof *wide; w++)
        for (int exempt = 0; exempt < 2; exempt++) {
            body b;
            body_create (&b, &wide[w], 70 + w);
            size_t values = 2 * b.cloud.n;
            double *f = pg_calloc (values, sizeof *f), *g = pg_calloc (values, sizeof *g),
                   *h = pg_calloc (values, sizeof *h);
            unsigned char *alive = pg_calloc (b.nbond, 1);
            for (size_t i = 0; exempt && i < b.cloud.n; i++) b.exempt[i] = body_random (&b) < 0.1;
            pg_bond_loop *plain = folded_or_plain (&b, "scalar", 1, exempt, 1), *loop[5] = { NULL };
            pg_changes torn = { 0 }, broken[5] = { { 0 } };
            for (int k = 0; k < 5; k++)
                loop[k] = folded_or_plain (&b, k < 3 ? sets[k] : NULL, k < 3 ? 1 : k - 1, exempt, 0);
            memset (alive, 1, b.nbond);
            for (int step = 0; step < 16; step++) {
                move_body (&b, step);
                size_t had = torn.n;
                check_ok (pg_bond_loop_force (plain, b.u, g, &torn));
                for (size_t k = had; k < torn.n; k++) alive[torn.bond[k]] = 0;
                for (int k = 0; k < 5; k++) {
                    if (!loop[k]) continue;
                    check_ok (pg_bond_loop_force (loop[k], b.u, f, &broken[k]));
                    assert_int_equal (broken[k].n, torn.n);
                    if (torn.n) assert_memory_equal (broken[k].bond, torn.bond, torn.n * sizeof *torn.bond);
                    close_to (f, g, values, 1e-11);
                    if (k == 1) memcpy (h, f, values * sizeof *f);
                    if (k > 1 && loop[1]) assert_memory_equal (f, h, values * sizeof *f);
                }
                if (step == 9) pg_bond_loop_update (loop[4], alive, NULL);
            }
            pg_bond_loop_counts count;
            pg_bond_loop_counted (loop[3], &count);
            print_message ("m %.3g: %zu bonds broke; of %zu blocks %zu folded, %zu looks\n", wide[w].m,
                           torn.n, count.blocks, count.folded, count.looks);
            assert_true (torn.n > 10 && count.folded > count.blocks / 8 && count.folded < count.blocks);
            assert_true (count.looks > 0 && count.looks < count.folded);
            pg_bond_loop_counted (plain, &count);
            assert_int_equal (count.folded, 0);
            for (int k = 0; k < 5; k++) pg_bond_loop_free (&loop[k]), pg_free (broken[k].bond);
            pg_bond_loop_free (&plain);
            pg_free (f), pg_free (g), pg_free (h), pg_free (alive), pg_free (torn.bond);
            body_free (&b);
        }
}

static void wrong_wishes_are_refused (void **state)
{
    (void) state;
    body b;
    body_create (&b, &wishes[0], 3);
    pg_bond_loop *s = NULL;
    pg_bond_loop_setting setting = { .sums = b.sums,
                                     .family = &b.family,
                                     .modulus = b.modulus,
                                     .limit = b.limit,
                                     .threads = 1,
                                     .instructions = "neon" };
    check_fails (pg_bond_loop_create (&s, &setting), PG_E_USAGE);
    check_contains (pg_last_error (), "neon");
    assert_null (s);
    setting.instructions = NULL;
    b.modulus[7] *= 2;
    check_fails (pg_bond_loop_create (&s, &setting), PG_E_USAGE);
    check_contains (pg_last_error (), "several moduli");
    b.modulus[7] = b.modulus[0], b.limit[3] *= 2;
    check_fails (pg_bond_loop_create (&s, &setting), PG_E_USAGE);
    check_contains (pg_last_error (), "several critical stretches");
    body_free (&b);
    body_wish wish = wishes[0];
    wish.surface = PG_SURFACE_VOLUME;
    body_create (&b, &wish, 3);
    setting = (pg_bond_loop_setting){
        .sums = b.sums, .family = &b.family, .modulus = b.modulus, .threads = 1
    };
    check_fails (pg_bond_loop_create (&s, &setting), PG_E_USAGE);
    check_contains (pg_last_error (), "volume");
    body_free (&b);
}

static void lack_of_memory_is_reported (void **state)
{
    (void) state;
    body b;
    body_create (&b, &wishes[4], 3);
    b.exempt[0] = 1;
    pg_bond_loop *s = NULL;
    creation_survives_lack_of_memory (&s, &b, 50);
    /* ... and when bonds break */
    double *f = pg_calloc (b.cloud.n * 2, sizeof *f);
    pg_changes broken = { 0 };
    for (size_t i = 0; i < b.cloud.n * 2; i++) b.u[i] *= 100;
    pg_memory_fail_at (1);
    check_fails (pg_bond_loop_force (s, b.u, f, &broken), PG_E_MEMORY);
    pg_memory_fail_at (0);
    pg_bond_loop_free (&s);
    pg_free (f), pg_free (broken.bond);
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
        cmocka_unit_test (folding_changes_nothing),
        cmocka_unit_test (looks_come_in_time),
        cmocka_unit_test (wrong_wishes_are_refused),
        cmocka_unit_test (lack_of_memory_is_reported),
        cmocka_unit_test (steady_sums_allocate_nothing),
    };
    return cmocka_run_group_tests_name ("mechanics/sums/bond_loop", tests, NULL, NULL);
}
