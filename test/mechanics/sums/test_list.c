/* SPDX-License-Identifier: GPL-3.0-or-later
 * The loop over a list of bonds against the plain double loop, on lattices and irregular clouds, with several
 * materials, shuffled numbers, broken bonds and exempt points; all instruction sets and numbers of threads
 * give the same bits. */
#include "sweeps.h"

static const struct { body_wish body; double scatter; int mixed;
} wishes[] = {
    { { { 70, 31, 1 }, 0.1, 0, 0, 2, 3.015, PG_SURFACE_NONE, PG_PARTIAL_OVERLAP, 0, PG_EVALUATE_LIST },
      0,
      0 },
    { { { 70, 31, 1 }, 0.1, 1, 1, 2, 3.015, PG_SURFACE_VOLUME, PG_PARTIAL_OVERLAP, 1, PG_EVALUATE_LIST },
      0,
      1 },
    { { { 50, 40, 1 }, 0.1, 0, 0, 2, 3.1, PG_SURFACE_NONE, PG_PARTIAL_LINEAR, 0, PG_EVALUATE_LIST }, 0.3, 1 },
    { { { 50, 40, 1 }, 0.1, 1, 0, 2, 4.1, PG_SURFACE_VOLUME, PG_PARTIAL_NONE, 1, PG_EVALUATE_LIST }, 0.3, 1 },
    { { { 40, 25, 1 }, 0.2, 0, 0, 2, 3.015, PG_SURFACE_PRODUCT, PG_PARTIAL_LINEAR, 0, PG_EVALUATE_AUTO },
      0.4,
      0 },
    { { { 700, 1, 1 }, 0.05, 1, 0, 1, 3.015, PG_SURFACE_PRODUCT, PG_PARTIAL_LINEAR, 0, PG_EVALUATE_LIST },
      0.3,
      1 },
    { { { 700, 1, 1 }, 0.05, 0, 0, 1, 4.2, PG_SURFACE_NONE, PG_PARTIAL_OVERLAP, 1, PG_EVALUATE_LIST }, 0, 0 },
    { { { 17, 9, 8 }, 0.1, 0, 0, 3, 3.015, PG_SURFACE_VOLUME, PG_PARTIAL_OVERLAP, 0, PG_EVALUATE_LIST },
      0,
      1 },
    { { { 12, 11, 10 }, 0.1, 1, 0, 3, 2.5, PG_SURFACE_NONE, PG_PARTIAL_LINEAR, 1, PG_EVALUATE_LIST },
      0.3,
      1 },
    { { { 35, 5, 6 }, 0, 0, 0, 3, 3.015, PG_SURFACE_VOLUME, PG_PARTIAL_NONE, 0, PG_EVALUATE_LIST }, 0.2, 0 },
    /* fewer points than lanes x 2 */
    { { { 3, 3, 1 }, 0, 0, 0, 2, 3.015, PG_SURFACE_NONE, PG_PARTIAL_NONE, 0, PG_EVALUATE_LIST }, 0, 0 },
    { { { 2, 1, 1 }, 0, 0, 0, 1, 1.5, PG_SURFACE_NONE, PG_PARTIAL_NONE, 1, PG_EVALUATE_LIST }, 0, 0 },
    /* no bond at all */
    { { { 1, 1, 1 }, 0, 0, 0, 2, 3.015, PG_SURFACE_NONE, PG_PARTIAL_NONE, 0, PG_EVALUATE_LIST }, 0, 0 },
};
enum { WISHES = sizeof wishes / sizeof *wishes };

static void wish (body *b, size_t w, uint64_t seed)
{
    body_create_as (b, &wishes[w].body, wishes[w].scatter, wishes[w].mixed, seed);
}
static const swept lists = { "list", wish, WISHES, 0 };

static void forces_and_energy_equal_the_plain_loop (void **state)
{
    (void) state, sums_equal_the_plain_loop (&lists);
}
/* The plain loop looks at each direction by itself. */
static void bonds_break_as_in_the_plain_loop (void **state)
{
    (void) state, breaking_equals_the_plain_loop (&lists);
}
static void changes_equal_a_whole_update (void **state)
{
    (void) state, updates_by_changes_equal_whole_ones (&lists);
}
/* At most 8 bytes for the coefficient and 4 for the end in each direction. */
static void bonds_cost_what_is_said (void **state)
{
    (void) state, steady_sums_cost_what_is_said (&lists, 1, 5, 12);
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
        pg_bond_loop *list = NULL, *stencil = NULL;
        pg_changes first = { 0 }, second = { 0 };
        make_sweep (&list, &b, NULL, 1, 1, 0);
        b.sums->rule.evaluation = PG_EVALUATE_STENCIL;
        make_sweep (&stencil, &b, NULL, 1, 1, 0);
        check_contains (pg_bond_loop_name (list), "list");
        check_contains (pg_bond_loop_name (stencil), "stencil");
        pg_bond_loop_update (list, b.alive, NULL), pg_bond_loop_update (stencil, b.alive, NULL);
        for (size_t i = 0; i < values; i++) b.u[i] *= 2;
        check_ok (pg_bond_loop_force (list, b.u, f, &first));
        check_ok (pg_bond_loop_force (stencil, b.u, g, &second));
        close_to (f, g, values, 1e-13);
        assert_true (first.n > 0);
        assert_int_equal (first.n, second.n);
        assert_memory_equal (first.bond, second.bond, first.n * sizeof *first.bond);
        check_relative (pg_bond_loop_energy (list, b.u), pg_bond_loop_energy (stencil, b.u), 1e-12);
        pg_bond_loop_free (&list), pg_bond_loop_free (&stencil);
        pg_free (f), pg_free (g), pg_free (first.bond), pg_free (second.bond);
        body_free (&b);
    }
}

/* Forces and their moments (finite: about the places moved to) cancel on the whole; the work of the forces is
 * twice the energy of linear bonds. */
static void actions_equal_reactions (void **state)
{
    (void) state;
    for (size_t w = 0; w < WISHES; w++) {
        body b;
        wish (&b, w, 3 + w);
        body_wound (&b, 0.2);
        size_t n = b.cloud.n, dim = (size_t) b.cloud.dim;
        double *f = pg_calloc (n * dim, sizeof *f), sum[3] = { 0 }, moment[3] = { 0 }, size = 0, length = 0,
               work = 0;
        pg_bond_loop *s = NULL;
        make_sweep (&s, &b, NULL, 2, 0, 0);
        pg_bond_loop_update (s, b.alive, NULL);
        check_ok (pg_bond_loop_force (s, b.u, f, NULL));
        for (size_t i = 0; i < n; i++) {
            double y[3] = { 0 }, F[3] = { 0 };
            for (size_t d = 0; d < dim; d++) {
                F[d] = f[i * dim + d],
                y[d] = b.cloud.x[i * dim + d] + (wishes[w].body.finite ? b.u[i * dim + d] : 0);
                sum[d] += F[d], size += fabs (F[d]), length = fmax (length, y[d]),
                                                     work -= F[d] * b.u[i * dim + d];
            }
            for (int d = 0; d < 3; d++)
                moment[d] += y[(d + 1) % 3] * F[(d + 2) % 3] - y[(d + 2) % 3] * F[(d + 1) % 3];
        }
        for (int d = 0; d < 3; d++)
            check_scaled (sum[d], 0, 1e-14, size), check_scaled (moment[d], 0, 1e-13, size * length);
        if (!wishes[w].body.finite) check_scaled (work, 2 * pg_bond_loop_energy (s, b.u), 1e-12, 1e-300);
        pg_bond_loop_free (&s);
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
    pg_bond_loop *s = NULL;
    make_sweep (&s, &b, NULL, 1, 0, 0);
    check_ok (pg_bond_loop_force (s, b.u, f, NULL));
    pg_bond_loop_free (&s);
    for (size_t i = 0; i < values; i++) x[i] += 8;
    body_plain (&b, 0, g, NULL);
    make_sweep (&s, &b, NULL, 1, 0, 0);
    check_ok (pg_bond_loop_force (s, b.u, f, NULL));
    close_to (f, g, values, 1e-13);
    pg_bond_loop_free (&s);
    pg_free (f), pg_free (g);
    body_free (&b);
}

static void lack_of_memory_is_reported (void **state)
{
    (void) state;
    body b;
    wish (&b, 2, 3);
    b.exempt[0] = 1;
    size_t values = b.cloud.n * 2;
    pg_bond_loop *s = NULL;
    creation_survives_lack_of_memory (&s, &b, 60);
    /* bonds whose death could not be told live on and are told the next time */
    double *f = pg_calloc (values, sizeof *f), *g = pg_calloc (values, sizeof *g);
    unsigned char *dead = pg_calloc (b.nbond, 1);
    pg_changes broken = { 0 };
    for (size_t i = 0; i < values; i++) b.u[i] *= 3;
    for (size_t k = 1; k <= 2; k++) {
        pg_memory_fail_at (k);
        check_fails (pg_bond_loop_force (s, b.u, f, &broken), PG_E_MEMORY);
        pg_memory_fail_at (0);
        assert_int_equal (broken.n, 0);
    }
    body_plain (&b, 1, g, dead);
    check_ok (pg_bond_loop_force (s, b.u, f, &broken));
    size_t total = 0;
    for (size_t e = 0; e < b.nbond; e++) total += dead[e];
    assert_true (total > 0);
    assert_int_equal (broken.n, total);
    close_to (f, g, values, 1e-13);
    pg_bond_loop_free (&s);
    pg_free (f), pg_free (g), pg_free (dead), pg_free (broken.bond);
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
    return cmocka_run_group_tests_name ("mechanics/sums/list", tests, NULL, NULL);
}
