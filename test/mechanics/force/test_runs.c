/* SPDX-License-Identifier: GPL-3.0-or-later
 * Points that are alike and summed many at a time: K x is that of the plain sum for every way of integration,
 * in the plane and in space, whole, with holes, two materials and broken bonds; what has changed is looked at
 * again, and nothing depends on what was there before or on the number of threads. */
#include "scene_runs/run.h"

static uint64_t seed = 88172645463325252u;
static double random_number (void)
{
    seed ^= seed << 13, seed ^= seed >> 7, seed ^= seed << 17;
    return (double) (seed >> 11) / 4503599627370496.0 - 1;
}

#define ROCK "rock: {youngs_modulus: 10 GPa, poissons_ratio: 0.2}"
/* The second body has holes, whose cells are cut, the third two materials. */
static const char *const bodies[] = {
    "dimension: 2\nplane: strain\nbody: [{add: {box: {low: [0, 0], high: [2.1 m, 0.8 m]}}}]\nspacing: 0.1 m\n"
    "materials: {" ROCK "}\nboundary: [{set: left, displacement: {x: 1 mm, y: 0}}]\n",
    "dimension: 2\nplane: strain\nbody: [{add: {box: {low: [0, 0], high: [3 m, 1 m]}}}, {subtract: {disk: "
    "{center: [0.7 m, 0.5 m], diameter: 0.4 m}}}]\nspacing: 0.1 m\n"
    "materials: {" ROCK "}\nboundary: [{set: left, displacement: {x: 1 mm, y: 0}}]\n",
    "dimension: 3\nbody: [{add: {box: {low: [0, 0, 0], high: [1.7 m, 0.4 m, 0.4 m]}}}]\nspacing: 0.1 m\n"
    "materials: {" ROCK ", soft: {youngs_modulus: 1 GPa, poissons_ratio: 0.3}}\n"
    "blocks: [{where: z > -1, material: rock}, {where: x > 0.8, material: soft}]\n"
    "boundary: [{set: left, displacement: {x: 1 mm, y: 0, z: 0}}]\n",
};
static const char *const methods[] = {
    "method: {approximation: rkpm, integration: gauss, horizon: 2 spacing}\n",
    "method: {approximation: rkpm, integration: consistent, horizon: 1.8 spacing}\n",
    "method: {approximation: pddo, integration: nodal, horizon: 2 spacing}\n",
    "method: {approximation: nosb, integration: nodal, horizon: 2 spacing, stabilization: silling}\n",
    "method: {approximation: rkpm, integration: gauss, horizon: 2 spacing, dilatation: projected}\n",
};
enum { BODIES = 3, METHODS = 5 };

static int ascending (const void *a, const void *b)
{
    size_t i = *(const size_t *) a, j = *(const size_t *) b;
    return (i > j) - (i < j);
}

static run body_of (int threads, int body, int method, const char *more)
{
    return scene_of (threads, "%s%ssolver: {kind: static%s}\n", bodies[body], methods[method], more);
}

static void multiply (const run *r, const double *x, double *y)
{
    void *self;
    const pg_operator *op = pg_solver_force (r->solver, &self)->operator_ (self);
    op->apply (op->context, x, y);
}

/* The product of a run and of its plain twin: the same up to rounding, also that of bonds (2^-40 horizons)
 * before shape functions are evaluated. It has to differ in some bit: else no
 * point would have been alike, and nothing tested. */
static void compare (const run *r, const run *plain, int differs)
{
    size_t n = r->state->ndof;
    double *x = pg_calloc (3 * n, sizeof *x), *y = x + n, *z = x + 2 * n, top = 0;
    for (size_t i = 0; i < n; i++) x[i] = random_number ();
    multiply (r, x, y), multiply (plain, x, z);
    for (size_t i = 0; i < n; i++) top = fmax (top, fabs (z[i]));
    for (size_t i = 0; i < n; i++) check_scaled (y[i], z[i], 1e-11, top);
    assert_int_equal (memcmp (y, z, n * sizeof *y) != 0, differs);
    pg_free (x);
}

static void the_product_is_that_of_the_plain_sum (void **state)
{
    (void) state;
    for (int b = 0; b < BODIES; b++)
        for (int m = 0; m < METHODS; m++) {
            run r = body_of (1, b, m, ""), plain = body_of (1, b, m, ", plain: true");
            refresh (&r, NULL), refresh (&plain, NULL);
            compare (&r, &plain, 1);
            clear (&r), clear (&plain);
        }
}

/* Irregular points have nothing alike: the sums are the same to the bit. */
static void irregular_points_are_summed_one_by_one (void **state)
{
    (void) state;
    run r = body_of (1, 2, 0, "}\nperturb: {amount: 0.1"),
        plain = body_of (1, 2, 0, ", plain: true}\nperturb: {amount: 0.1");
    refresh (&r, NULL), refresh (&plain, NULL);
    compare (&r, &plain, 0);
    clear (&r), clear (&plain);
}

/* Bonds break one after the other: the product stays that of the plain sum, and has the bits of a force that
 * comes to the same bonds at once. Three threads give the same bits as one. */
static void broken_bonds_are_no_longer_alike (void **state)
{
    (void) state;
    for (int b = 0; b < BODIES; b++)
        for (int m = 0; m < METHODS; m++) {
            run r = body_of (1, b, m, ""), plain = body_of (1, b, m, ", plain: true"),
                fresh = body_of (3, b, m, "");
            size_t n = r.state->ndof;
            double *x = pg_calloc (3 * n, sizeof *x), *y = x + n, *z = x + 2 * n;
            refresh (&r, NULL), refresh (&plain, NULL);
            for (size_t i = 0; i < n; i++) x[i] = random_number ();
            for (int round = 0; round < 4; round++) {
                size_t bond[40], count = 0;
                for (size_t i = 0; i < r.state->nbond && count < 40; i++)
                    if (0.5 + 0.5 * random_number () < 0.001 * round && r.state->alive[i]) bond[count++] = i;
                for (size_t i = 0; i < count; i++) r.state->alive[bond[i]] = plain.state->alive[bond[i]] = 0;
                refresh (&r, &(pg_changes) { count, 40, bond });
                refresh (&plain, &(pg_changes) { count, 40, bond });
                compare (&r, &plain, 1);
            }
            check_ok (pg_state_copy (fresh.state, r.state));
            refresh (&fresh, NULL);
            multiply (&r, x, y), multiply (&fresh, x, z);
            assert_memory_equal (y, z, n * sizeof *y);
            pg_free (x);
            clear (&r), clear (&plain), clear (&fresh);
        }
}

/* What breaking changes of K x is the share of the points that lost a bond, before less after, unless more
 * depends on them: stabilised points, cells as a whole, patches, supported facets. */
static void the_share_of_points_is_what_changes (void **state)
{
    (void) state;
    for (int m = 0; m < METHODS; m++) {
        run r = body_of (1, 1, m, "");
        void *self;
        const pg_force_type *force = pg_solver_force (r.solver, &self);
        size_t n = r.state->ndof, known = 0, base = r.problem->bonds.first[m == 2 ? PG_NODES : PG_POINTS];
        double *x = pg_calloc (5 * n, sizeof *x), *y = x + n, *z = y + n, *before = z + n,
               *after = before + n;
        for (size_t i = 0; i < n; i++) x[i] = random_number ();
        refresh (&r, NULL);
        for (int round = 0; round < 6; round++) {
            int can, still;
            size_t bond[9], count = 0, last = base;
            double top = 0;
            for (int k = 0; k < 9; k++) {
                size_t next = last + 1 + (size_t) (400 * (1 + random_number ()));
                last = next;
                if (next >= r.state->nbond || !r.state->alive[next]) continue;
                r.state->alive[next] = 0, bond[count++] = next;
            }
            pg_changes changes = { count, 9, bond };
            multiply (&r, x, y);
            check_ok (force->spares.share_of (self, x, &changes, before, &can));
            refresh (&r, &changes);
            check_ok (force->spares.share_of (self, x, &changes, after, &still));
            multiply (&r, x, z);
            assert_int_equal (can, still);
            known += (size_t) can;
            for (size_t i = 0; i < n; i++) top = fmax (top, fabs (z[i]));
            for (size_t i = 0; i < n && can; i++)
                check_scaled (z[i] - y[i], after[i] - before[i], 1e-11, top);
        }
        if (m == 0 || m == 2) assert_true (known > 0);
        else assert_int_equal (known, 0);
        pg_free (x);
        clear (&r);
    }
}

/* A plate in which points become alike and unlike again: of rows of cells the same bond breaks, a few cells
 * in a round, to the right of those before and to their left, and bonds here and there. Whatever is taken
 * over from the round before, the product has the bits of a force that comes to the same bonds at once. */
static void points_become_alike_by_breaking (void **state)
{
    (void) state;
    enum { TRAINS = 12, ROUNDS = 14, MOST = TRAINS * 4 + 2 };
    run r = body_of (1, 1, 0, "");
    size_t n = r.state->ndof, first[TRAINS], last[TRAINS], number[TRAINS];
    double *x = pg_calloc (3 * n, sizeof *x), *y = x + n, *z = x + 2 * n;
    refresh (&r, NULL);
    for (size_t i = 0; i < n; i++) x[i] = random_number ();
    const pg_family *f = &r.problem->bonds.rows[PG_POINTS].family;
    size_t base = r.problem->bonds.first[PG_POINTS];
    for (size_t k = 0; k < TRAINS; k++) {
        first[k] = last[k] = (size_t) ((0.5 + 0.5 * random_number ()) * (double) (f->n - 1));
        number[k] = (size_t) ((0.5 + 0.5 * random_number ()) * 9);
    }
    for (int round = 0; round < ROUNDS; round++) {
        size_t bond[MOST], count = 0;
        for (size_t k = 0; k < TRAINS; k++)
            for (size_t i = 0; i < 3; i++) {
                int left = (round + (int) k) % 3 == 0;
                size_t point = left ? first[k] : last[k];
                if (point >= f->n) continue;
                bond[count++] = base + f->start[point] + number[k];
                if (left) first[k] = point >= 4 ? point - 4 : SIZE_MAX;
                else last[k] = point + 4;
            }
        bond[count++] = base + (size_t) ((0.5 + 0.5 * random_number ()) * (double) (f->start[f->n] - 1));
        size_t kept = 0;
        qsort (bond, count, sizeof *bond, ascending);
        for (size_t i = 0; i < count; i++) {
            if (!r.state->alive[bond[i]]) continue;
            r.state->alive[bond[i]] = 0, bond[kept++] = bond[i];
        }
        refresh (&r, &(pg_changes) { kept, MOST, bond });
        run fresh = body_of (1, 1, 0, "");
        check_ok (pg_state_copy (fresh.state, r.state));
        refresh (&fresh, NULL);
        multiply (&r, x, y), multiply (&fresh, x, z);
        assert_memory_equal (y, z, n * sizeof *y);
        clear (&fresh);
    }
    pg_free (x);
    clear (&r);
}

/* Rows of K by products of derivatives, and rows of supports on facets, are those of blocks. On irregular
 * points both ways have the same shape functions. The two ways differ in some bit, with more than one
 * material at the supports alone. */
static void rows_of_products_equal_blocks (void **state)
{
    (void) state;
    static const char *const solid =
        "dimension: 3\nbody: [{add: {box: {low: [0, 0, 0], "
        "high: [0.6 m, 0.4 m, 0.4 m]}}}]\nspacing: 0.1 m\nmaterials: {" ROCK "}\n"
        "boundary: [{set: left, displacement: {x: 1 mm, y: 0, z: 0}}]\n";
    for (int b = 0; b < 4; b++)
        for (int m = 0; m < METHODS; m++) {
            const char *const way[] = { "", ", plain: true" };
            pg_sparse K[2];
            run r[2];
            for (int k = 0; k < 2; k++) {
                void *self;
                r[k] = scene_of (1, "%s%sperturb: {amount: 0.1}\nsolver: {kind: static%s}\n",
                                 b < BODIES ? bodies[b] : solid, methods[m], way[k]);
                refresh (&r[k], NULL);
                const pg_force_type *f = pg_solver_force (r[k].solver, &self);
                check_ok (pg_force_assemble (f, self, NULL));
                K[k] = *pg_force_matrix (f, self);
            }
            size_t entries = (size_t) K[0].start[K[0].ncol];
            double top = 0;
            for (size_t e = 0; e < entries; e++) top = fmax (top, fabs (K[0].value[e]));
            for (size_t e = 0; e < entries; e++) check_scaled (K[0].value[e], K[1].value[e], 1e-14, top);
            int other = memcmp (K[0].value, K[1].value, entries * sizeof *K[0].value) != 0;
            assert_int_equal (other, m != 3);          /* 3: stabilised, and no support on facets */
            clear (&r[0]), clear (&r[1]);
        }
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (rows_of_products_equal_blocks),
        cmocka_unit_test (the_product_is_that_of_the_plain_sum),
        cmocka_unit_test (irregular_points_are_summed_one_by_one),
        cmocka_unit_test (broken_bonds_are_no_longer_alike),
        cmocka_unit_test (the_share_of_points_is_what_changes),
        cmocka_unit_test (points_become_alike_by_breaking),
    };
    return cmocka_run_group_tests_name ("mechanics/force/runs", tests, NULL, NULL);
}
