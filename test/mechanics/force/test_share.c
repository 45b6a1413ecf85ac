/* SPDX-License-Identifier: GPL-3.0-or-later
 * Points of a lattice that see their nodes alike share their rows: every row has the bits that it has alone,
 * before bonds break and after; where rows are corrected, or points lie anywhere, none is shared. */
#include <math.h>
#include "../../scene_runs/run.h"
#include "mechanics/galerkin/weak_form/galerkin.h"

#define SOLID "dimension: 3\nbody: [{add: {box: {low: [0, 0, 0], high: [1, 0.63, 0.7]}}}]\nspacing: 0.1\n"
#define PLATE "dimension: 2\nbody: [{add: {box: {low: [0, 0], high: [1, 0.7]}}}, {subtract: {disk: " \
              "{center: [0.4, 0.3], diameter: 0.2}}}]\nspacing: 0.03\n"
#define REST "materials: {rock: {youngs_modulus: 10 GPa, poissons_ratio: 0.2}}\nsolver: {kind: static}\n"

static const char *const sharing[] = {
    SOLID REST "method: {integration: gauss}\n",
    SOLID REST "method: {integration: nodal, approximation: pddo}\n",
    SOLID REST "method: {integration: gauss, dilatation: projected}\n",
    PLATE REST "method: {integration: gauss}\n",
    PLATE REST "method: {integration: gauss, basis: quadratic, horizon: 3 spacing}\n",
};
static const char *const alone[] = {
    SOLID REST "method: {integration: consistent}\n",
    SOLID REST "method: {approximation: nosb, integration: nodal, stabilization: silling}\n",
    SOLID REST "method: {integration: gauss}\nperturb: {amount: 0.1}\n",
};
enum { SHARING = sizeof sharing / sizeof *sharing, ALONE = sizeof alone / sizeof *alone };

static galerkin *force_of (const run *r)
{
    void *self;
    pg_solver_force (r->solver, &self);
    return self;
}

/* Rows of all nodes and points to the bit, and what is made of them. */
static void same_rows (const galerkin *a, const galerkin *b)
{
    size_t dim = (size_t) a->dim;
    for (int s = PG_NODES; s <= PG_POINTS; s++) {
        const pg_rows *r = &a->rows[s], *q = &b->rows[s];
        assert_memory_equal (r->grade, q->grade, r->n);
        for (size_t i = 0; i < r->n; i++) {
            size_t e = r->family.start[i], n = r->family.start[i + 1] - e, at = e + pg_rows_offset (r, i);
            assert_memory_equal (r->N + at, q->N + e, n * sizeof *r->N);
            assert_memory_equal (r->dN + at * dim, q->dN + e * dim, n * dim * sizeof *r->dN);
            assert_memory_equal (r->w + at, q->w + e, n * sizeof *r->w);
        }
    }
}

/* Points that read the row of point p. */
static size_t readers (const pg_rows *r, size_t p)
{
    size_t n = 0;
    for (size_t i = 0; i < r->n; i++) n += r->at[i] == r->at[p];
    return n;
}

static void rows_are_those_of_points_alone (void **state)
{
    (void) state;
    for (int k = 0; k < SHARING; k++) {
        run r = scene_of (2, "%s", sharing[k]), own = scene_of (1, "%s", sharing[k]);
        own.problem->plain = 1;                        /* after the scene: it rounds bonds alike */
        refresh (&r, NULL), refresh (&own, NULL);
        galerkin *a = force_of (&r), *b = force_of (&own);
        const pg_rows *bulk = &a->rows[a->bulk];
        size_t most = 0;
        assert_non_null (bulk->at), assert_null (b->rows[b->bulk].at);
        assert_ptr_equal (a->sums.at, bulk->at), assert_ptr_equal (a->sums.dN, bulk->dN);
        for (size_t i = 0; i < bulk->n; i++) most = bulk->at[i] > most ? bulk->at[i] : most;
        check_below ((double) most, 0.8 * (double) bulk->family.start[bulk->n]);
        same_rows (a, b);
        /* the last point of evaluation loses a bond: it gets a row that nobody else reads */
        size_t bond = r.problem->bonds.first[a->bulk + 1] - 1;
        r.state->alive[bond] = own.state->alive[bond] = 0;
        pg_changes changes = { 1, 1, &bond };
        refresh (&r, &changes), refresh (&own, &changes);
        assert_ptr_equal (a->sums.dN, bulk->dN);
        assert_ptr_equal (a->sums.at, bulk->at), assert_non_null (bulk->at);
        assert_int_equal (readers (bulk, bulk->n - 1), 1);
        same_rows (a, b);
        clear (&r), clear (&own);
    }
}

/* Where the last kept row begins. */
static size_t last_row (const pg_rows *r)
{
    size_t most = 0;
    for (size_t p = 0; p < r->n; p++) most = r->at[p] > most ? r->at[p] : most;
    return most;
}

/* Breaks the first live bond of a point, or (whole: 1) mends all of its bonds, in both runs. */
static void change (run *r, run *own, size_t base, size_t point, int whole)
{
    const galerkin *g = force_of (r);
    size_t bond[64], n = 0, first = base + g->rows[g->bulk].family.start[point],
           last = base + g->rows[g->bulk].family.start[point + 1];
    for (size_t e = first; e < last && n < 64; e++) {
        if (r->state->alive[e] == whole) continue;
        r->state->alive[e] = own->state->alive[e] = (unsigned char) whole;
        bond[n++] = e;
        if (!whole) break;
    }
    pg_changes changes = { n, n, bond };
    refresh (r, &changes), refresh (own, &changes);
}

/* Bonds break one after the other at points whose rows others read and at those that have lost some, and are
 * mended again; every row stays what it is by itself, and so do the products that are made of them. What is
 * no longer read makes room. */
static void rows_stay_what_they_are_by_themselves (void **state)
{
    (void) state;
    for (int k = 0; k < 2; k++) {
        const char *scene = k ? sharing[3] : sharing[0];
        run r = scene_of (2, "%s", scene), own = scene_of (1, "%s", scene);
        own.problem->plain = 1;
        refresh (&r, NULL), refresh (&own, NULL);
        galerkin *a = force_of (&r), *b = force_of (&own);
        const pg_rows *bulk = &a->rows[a->bulk];
        size_t base = r.problem->bonds.first[a->bulk], n = r.state->ndof;
        double *x = pg_calloc (3 * n, sizeof *x), *y = x + n, *z = x + 2 * n, top = 0;
        for (size_t i = 0; i < n; i++) x[i] = sin (12.9898 * (double) i);
        for (size_t round = 0; round < 40; round++) {
            change (&r, &own, base, 37 * (round / 3) % bulk->n, round % 6 == 5);
            assert_non_null (bulk->at);
            same_rows (a, b);
            galerkin_apply (a, x, y), galerkin_apply (b, x, z);
            for (size_t i = 0; i < n; i++) top = fmax (top, fabs (z[i]));
            for (size_t i = 0; i < n; i++) check_scaled (y[i], z[i], 1e-11, top);
        }
        size_t most = last_row (bulk);
        for (size_t p = 0; p < 700; p++)
            change (&r, &own, base, p % bulk->n, 0), change (&r, &own, base, p % bulk->n, 1);
        assert_true (last_row (bulk) < most + 64 * 64);
        same_rows (a, b);
        refresh (&r, NULL), refresh (&own, NULL);
        same_rows (a, b);
        pg_free (x);
        clear (&r), clear (&own);
    }
}

static void corrected_and_irregular_rows_are_alone (void **state)
{
    (void) state;
    for (int k = 0; k < ALONE; k++) {
        run r = scene_of (1, "%s", alone[k]);
        refresh (&r, NULL);
        const galerkin *g = force_of (&r);
        assert_null (g->rows[g->bulk].at), assert_null (g->sums.at);
        clear (&r);
    }
}

/* Memory that ends while rows are made, or parted, is told; then the force makes all rows anew. */
static void memory_that_ends_is_told (void **state)
{
    (void) state;
    run own = scene_of (1, "%s", sharing[3]);
    size_t bond = own.problem->bonds.first[PG_POINTS] + 100;
    own.problem->plain = 1, own.state->alive[bond] = 0;
    refresh (&own, NULL);
    for (int parted = 0; parted <= 1; parted++)
        for (size_t k = 1, failed = 1; failed; k++) {
            run r = scene_of (1, "%s", sharing[3]);
            galerkin *g = force_of (&r);
            void *self;
            pg_changes changes = { 1, 1, &bond };
            if (parted) refresh (&r, NULL), r.state->alive[bond] = 0;
            pg_memory_fail_at (k);
            failed = pg_solver_force (r.solver, &self)->refresh (g, r.state, parted ? &changes : NULL)
                     != PG_OK;
            pg_memory_fail_at (0);
            r.state->alive[bond] = 0;
            if (failed) refresh (&r, NULL);
            if (failed || parted) same_rows (g, force_of (&own));
            clear (&r);
        }
    clear (&own);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (rows_are_those_of_points_alone),
        cmocka_unit_test (rows_stay_what_they_are_by_themselves),
        cmocka_unit_test (corrected_and_irregular_rows_are_alone),
        cmocka_unit_test (memory_that_ends_is_told),
    };
    return cmocka_run_group_tests_name ("mechanics/force/share", tests, NULL, NULL);
}
