/* SPDX-License-Identifier: GPL-3.0-or-later
 * After bonds broke: the partly redone K is the K of a fresh assembly, a dead bond leaves no trace in N, dN
 * and K, and what a cut separates is separate: zeros in K, and the parts move freely. */
#include "run.h"

typedef struct { const char *approximation, *integration, *essential, *basis; } method;
static const method methods[] = {
    { "nosb", "nodal", "transformation", "linear" }, { "nosb", "gauss", "nitsche", "linear" },
    { "pddo", "nodal", "transformation", "linear" }, { "pddo", "gauss", "nitsche", "linear" },
    { "rkpm", "nodal", "penalty", "linear" },        { "rkpm", "gauss", "nitsche", "linear" },
    { "rkpm", "gauss", "transformation", "linear" }, { "rkpm", "gauss", "nitsche", "quadratic" },
    { "rkpm", "gauss", "penalty", "quadratic" },
};
enum { METHODS = sizeof methods / sizeof *methods };

/* 1 m x 0.8 m, points 0.1 m apart, moved at random; cracks: a list in YAML */
static run plate (const method *m, double perturb, const char *cracks)
{
    return scene_of (
        1,
        "dimension: 2\nthickness: 20 mm\nbody: [{add: {box: {low: [0, 0], high: [1, 0.8]}}}]\nspacing: 0.1\n"
        "perturb: {amount: %g}\n%s\n"
        "materials: {rock: {youngs_modulus: 10 GPa, poissons_ratio: 0.25}}\n"
        "method: {approximation: %s, integration: %s, essential: %s, basis: %s, horizon: %s spacing}\n"
        "boundary:\n  - {set: bottom, displacement: {x: 0, y: 0}}\n  - {set: top, displacement: {x: 0.2 mm, "
        "y: 1 mm}}\n"
        "solver: {stepping: fixed, steps: 1}\noutput: {at: {levels: 1}}\n",
        perturb, cracks, m->approximation, m->integration, m->essential, m->basis,
        *m->basis == 'q' ? "3.01" : "2.2");
}

static unsigned long long seed = 11;
static double chance (void)
{
    seed = seed * 6364136223846793005ull + 1442695040888963407ull;
    return (double) (seed >> 11) / 9007199254740992.0;
}

/* Breaks every live bond with this probability (never that of a node with itself); the list is ascending. */
static pg_changes break_some (run *r, double probability)
{
    pg_changes changes = { 0 };
    changes.bond = pg_calloc (r->state->nbond, sizeof *changes.bond);
    for (int s = 0; s < PG_BOND_SETS; s++) {
        const pg_rows *rows = &r->problem->bonds.rows[s];
        for (size_t p = 0; p < rows->n; p++)
            for (size_t e = rows->family.start[p]; e < rows->family.start[p + 1]; e++) {
                size_t b = r->problem->bonds.first[s] + e;
                if (rows->family.node[e] == rows->own[p] || !r->state->alive[b] || chance () > probability)
                    continue;
                r->state->alive[b] = 0;
                changes.bond[changes.n++] = b;
            }
    }
    return changes;
}

static const pg_sparse *matrix_of (const run *r)
{
    void *self;
    const pg_force_type *force = pg_solver_force (r->solver, &self);
    check_ok (pg_force_assemble (force, self, NULL));
    return pg_force_matrix (force, self);
}

static void partial_refresh_equals_fresh_assembly (void **state)
{
    (void) state;
    static const double share[] = { 0.01, 0.05, 0.3 };
    for (int m = 0; m < METHODS; m++) {
        run r = plate (&methods[m], 0.15, "");
        refresh (&r, NULL);
        for (int round = 0; round < 3; round++) {
            pg_changes changes = break_some (&r, share[round]);
            assert_true (changes.n > 0);
            refresh (&r, &changes);
            run fresh = plate (&methods[m], 0.15, "");
            check_ok (pg_state_copy (fresh.state, r.state));
            refresh (&fresh, NULL);
            const pg_sparse *A = matrix_of (&r), *B = matrix_of (&fresh);
            size_t nnz = (size_t) A->start[A->ncol];
            assert_int_equal (nnz, B->start[B->ncol]);
            check_below (largest_difference (A->value, B->value, nnz), 1e-15 * largest_of (B->value, nnz));
            void *self, *self_fresh;
            const pg_force_type *force = pg_solver_force (r.solver, &self);
            pg_solver_force (fresh.solver, &self_fresh);
            const pg_sparse *T = force->basis (self), *U = force->basis (self_fresh);
            size_t ntransform = T ? (size_t) T->start[T->ncol] : 0;
            if (T)
                check_below (largest_difference (T->value, U->value, ntransform),
                             1e-15 * largest_of (U->value, ntransform));
            clear (&fresh);
            pg_free (changes.bond);
        }
        clear (&r);
    }
}

/* A unit coefficient at node j shows at node i (displacement, stress) only through a live bond i - j. */
static void a_dead_node_is_absent_from_displacement_and_stress (void **state)
{
    (void) state;
    for (int m = 0; m < METHODS; m++) {
        run r = plate (&methods[m], 0.15, "");
        const pg_rows *rows = &r.problem->bonds.rows[PG_NODES];
        size_t n = rows->n, dead = 0, seen = 0;
        refresh (&r, NULL);
        pg_changes changes = break_some (&r, 0.05);
        refresh (&r, &changes);
        double *d = pg_calloc (2 * n, sizeof *d);
        for (size_t j = 0; j < n; j += 5) {
            d[2*j] = 1;
            double *u = field_of (&r, d, "displacement", NULL), *s = field_of (&r, d, "stress", NULL);
            for (size_t i = 0; i < n; i++) {
                int alive = i == j;
                for (size_t e = rows->family.start[i]; e < rows->family.start[i + 1] && !alive; e++)
                    alive = rows->family.node[e] == (int) j && r.state->alive[e];
                if (alive) {
                    seen += largest_of (s + 3*i, 3) > 0;
                    continue;
                }
                dead++;
                assert_true (largest_of (u + 2*i, 2) == 0 && largest_of (s + 3*i, 3) == 0);
            }
            pg_free (u), pg_free (s);
            d[2*j] = 0;
        }
        assert_true (dead > 0 && seen > 0);
        pg_free (d), pg_free (changes.bond);
        clear (&r);
    }
}

static const char *const through = "cracks: [{from: [-0.2, 0.37], to: [1.2, 0.43]}]";
static double above (const double *x) { return x[1] - (0.37 + 0.06 / 1.4 * (x[0] + 0.2)); }

static void a_cut_leaves_exact_zeros_in_K (void **state)
{
    (void) state;
    for (int m = 0; m < METHODS; m++) {
        run r = plate (&methods[m], 0, through);
        refresh (&r, NULL);
        const pg_sparse *K = matrix_of (&r);
        size_t across = 0;
        for (size_t c = 0; c < K->ncol; c++)
            for (long q = K->start[c]; q < K->start[c + 1]; q++) {
                const double *x = r.problem->cloud.x;
                if (above (x + 2 * (size_t) (K->row[q] / 2)) * above (x + 2 * (c / 2)) > 0) continue;
                across++;
                assert_true (K->value[q] == 0);
            }
        assert_true (across > 0);
        clear (&r);
    }
}

static void separated_parts_move_freely (void **state)
{
    (void) state;
    for (int m = 0; m < METHODS; m++) {
        run r = plate (&methods[m], 0, through);
        pg_census left = { 0 };
        void *self;
        const pg_force_type *force = pg_solver_force (r.solver, &self);
        to_the_end (&r);
        double *u = field_of (&r, NULL, "displacement", NULL), *s = field_of (&r, NULL, "stress", NULL),
               worst = 0;
        for (size_t i = 0; i < r.problem->cloud.n; i++) {
            int up = above (r.problem->cloud.x + 2*i) > 0;
            worst = fmax (worst,
                          largest_difference (u + 2 * i, (double[2]){ up ? 2e-4 : 0, up ? 1e-3 : 0 }, 2));
        }
        check_ok (force->census (self, &left));
        print_message ("%s %s %s %s: displacement off by %.1e, stress %.1e of E pull / height, %ld step, %zu "
                       "degenerate, %zu fragments\n",
                       methods[m].approximation, methods[m].integration, methods[m].essential,
                       methods[m].basis, worst / 1e-3,
                       largest_of (s, 3 * r.problem->cloud.n) / (10e9 * 1e-3 / 0.8), r.state->step,
                       left.degenerate, left.fragments);
        check_below (worst / 1e-3, 1e-9);
        check_below (largest_of (s, 3 * r.problem->cloud.n) / (10e9 * 1e-3 / 0.8), 1e-8);
        assert_int_equal (left.fragments, 1);               /* two parts: the body and one fragment */
        check_below (fabs (r.step.reaction[4]) / (10e9 * 1e-3 / 0.8 * 0.02), 1e-8);
        pg_free (u), pg_free (s);
        clear (&r);
    }
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (partial_refresh_equals_fresh_assembly),
        cmocka_unit_test (a_dead_node_is_absent_from_displacement_and_stress),
        cmocka_unit_test (a_cut_leaves_exact_zeros_in_K),
        cmocka_unit_test (separated_parts_move_freely),
    };
    return cmocka_run_group_tests_name ("scene_runs/broken_bonds", tests, NULL, NULL);
}
