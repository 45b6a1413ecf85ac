/* SPDX-License-Identifier: GPL-3.0-or-later
 * Places whose surroundings are alike share their shape functions: these are those of every place by itself
 * to rounding, and to the bit the same whoever else is evaluated, in whatever order and by how many
 * threads. */
#include "check.h"
#include "lattice.h"

enum { GAUSS = 2 };

/* Two places a direction in every cell of a lattice of per_axis^dim nodes, as a Gauss rule has them. */
static size_t places (int dim, size_t per_axis, double h, double *x)
{
    static const double at[GAUSS] = { 0.21132486540518711775, 0.78867513459481288225 };
    size_t n = power ((per_axis - 1) * GAUSS, dim);
    for (size_t i = 0; i < n; i++) {
        size_t rest = i;
        for (int k = 0; k < dim; k++, rest /= (per_axis - 1) * GAUSS) {
            size_t one = rest % ((per_axis - 1) * GAUSS);
            x[i * (size_t) dim + (size_t) k] = h * ((double) (one / GAUSS) + at[one % GAUSS]);
        }
    }
    return n;
}

/* Volumes of a lattice of vertices: halves at each side. */
static void halve_at_sides (pg_cloud *c, size_t per_axis)
{
    for (size_t i = 0; i < c->n; i++) {
        size_t rest = i;
        for (int k = 0; k < c->dim; k++, rest /= per_axis)
            c->volume[i] *= rest % per_axis == 0 || rest % per_axis == per_axis - 1 ? 0.5 : 1;
    }
}

/* Largest difference of two arrays over the largest value of the first. */
static double apart (size_t n, const double *a, const double *b)
{
    double most = 0, size = 0;
    for (size_t k = 0; k < n; k++) most = fmax (most, fabs (a[k] - b[k])), size = fmax (size, fabs (a[k]));
    return most / size;
}

static void check_alike (const pg_rows *a, const pg_rows *b, double most)
{
    size_t nnz = a->family.start[a->n];
    assert_true (apart (nnz, a->N, b->N) <= most);
    assert_true (apart (nnz * (size_t) a->dim, a->dN, b->dN) <= most);
    assert_true (apart (nnz, a->w, b->w) <= most);
    assert_memory_equal (a->grade, b->grade, a->n);
}

/* Every approximation, basis and support, at Gauss points and nodes, of a step that is no binary number. */
static void shared_values_are_those_of_each_place (void **state)
{
    (void) state;
    static const char *const type[3] = { "rkpm", "pddo", "nosb" };
    double *x = pg_calloc (3 * 4096, sizeof *x);
    for (int how = 0; how < 24; how++) {
        int dim = 2 + how % 2, order = 1 + how / 2 % 2, shape = how / 4 % 2, t = how / 8;
        size_t per_axis = dim == 2 ? 12 : 8;
        double h = 0.1 / 3;
        pg_cloud c = lattice (dim, per_axis, h, 0);
        halve_at_sides (&c, per_axis);
        pg_approx a = make (type[t], "cubic_spline", order, shape, (order == 1 ? 1.7 : 2.6) * h);
        size_t n = places (dim, per_axis, h, x);
        pg_rows alone = rows_at (&a, &c, n, x, NULL), nodes = rows_at_nodes (&a, &c);
        a.congruent = 1;
        pg_rows shared = rows_at (&a, &c, n, x, NULL), together = rows_at_nodes (&a, &c);
        check_alike (&alone, &shared, 3e-10);
        check_alike (&nodes, &together, 3e-10);
        pg_rows_clear (&alone), pg_rows_clear (&nodes), pg_rows_clear (&shared), pg_rows_clear (&together);
        lattice_clear (&c);
    }
    pg_free (x);
}

/* Also with dead bonds at some places, with a list in another order, alone, and without N. */
static void company_order_and_threads_change_no_bit (void **state)
{
    (void) state;
    double x[3 * 4096], h = 0.3;
    pg_cloud c = lattice (3, 8, h, 0);
    pg_approx a = make ("pddo", "cubic_spline", 1, PG_RADIAL, 1.9 * h);
    halve_at_sides (&c, 8);
    a.congruent = 1;
    size_t n = places (3, 8, h, x);
    pg_rows all = rows_at (&a, &c, n, x, NULL), other = rows_at (&a, &c, n, x, NULL);
    size_t nnz = all.family.start[n], list[50];
    unsigned char *alive = pg_calloc (nnz, 1);
    for (size_t e = 0; e < nnz; e++) alive[e] = e % 1009 != 0;
    for (size_t k = 0; k < 50; k++) list[k] = n - 1 - 41 * k;
    check_ok (a.type->evaluate (&a, &c, &all, alive, n, NULL, 1));
    check_ok (a.type->evaluate (&a, &c, &other, alive, n, NULL, 4));
    assert_memory_equal (all.N, other.N, nnz * sizeof *all.N);
    assert_memory_equal (all.dN, other.dN, 3 * nnz * sizeof *all.dN);
    memset (other.N, 0, nnz * sizeof *other.N), memset (other.dN, 0, 3 * nnz * sizeof *other.dN);
    memset (other.w, 0, nnz * sizeof *other.w);
    check_ok (a.type->evaluate (&a, &c, &other, alive, 50, list, 1));
    for (size_t k = 0; k < 50; k++) {
        size_t first = all.family.start[list[k]], m = all.family.start[list[k] + 1] - first;
        assert_memory_equal (all.N + first, other.N + first, m * sizeof *all.N);
        assert_memory_equal (all.dN + 3 * first, other.dN + 3 * first, 3 * m * sizeof *all.dN);
        assert_memory_equal (all.w + first, other.w + first, m * sizeof *all.w);
    }
    check_ok (a.type->evaluate (&a, &c, &other, alive, 1, list, 1));
    assert_memory_equal (all.dN + 3 * all.family.start[list[0]], other.dN + 3 * all.family.start[list[0]],
                         3 * sizeof *all.dN);
    double *N = other.N;
    other.N = NULL;
    memset (other.dN, 0, 3 * nnz * sizeof *other.dN);
    check_ok (a.type->evaluate (&a, &c, &other, alive, n, NULL, 1));
    assert_memory_equal (all.dN, other.dN, 3 * nnz * sizeof *all.dN);
    other.N = N;
    pg_free (alive);
    pg_rows_clear (&all), pg_rows_clear (&other);
    lattice_clear (&c);
}

/* Nodes that are not alike do not share: of a cloud without order nothing is taken from another place. */
static void places_that_differ_share_nothing (void **state)
{
    (void) state;
    pg_cloud c = lattice (2, 20, 1e-3, 0.2);
    pg_approx a = make ("rkpm", "cubic_spline", 1, PG_RADIAL, 2.1e-3);
    pg_rows alone = rows_at_nodes (&a, &c);
    a.congruent = 1;
    pg_rows shared = rows_at_nodes (&a, &c);
    check_alike (&alone, &shared, 1e-10);
    pg_rows_clear (&alone), pg_rows_clear (&shared);
    lattice_clear (&c);
}

/* Two groups of nodes, equal but for one node, which few numbers about the surroundings do not tell: the
 * places amid them see as many nodes of the same volumes, and yet have shape functions of their own. Each
 * node is moved in its turn, for whichever few numbers are looked at. */
static void one_node_elsewhere_makes_a_difference (void **state)
{
    (void) state;
    enum { SIDE = 7, GROUP = SIDE * SIDE, PLACES = 64 };
    pg_approx a = make ("rkpm", "cubic_spline", 1, PG_RADIAL, 6);
    double x[2 * PLACES];
    /* 1024 is far beyond the support, and adding it rounds nothing. */
    for (size_t k = 0; k < PLACES; k++) x[2*k] = 3.25 + (k % 2 ? 1024 : 0), x[2*k + 1] = 3.5;
    for (size_t moved = 0; moved < GROUP; moved++) {
        pg_cloud c = lattice (2, 10, 1, 0);
        c.n = 2 * GROUP;
        for (size_t i = 0; i < c.n; i++) {
            c.x[2*i] = (double) (i % SIDE) + (i < GROUP ? 0 : 1024);
            c.x[2*i + 1] = (double) (i % GROUP / SIDE);
        }
        c.x[2 * (GROUP + moved)] += 0.25;
        pg_rows alone = rows_at (&a, &c, PLACES, x, NULL);
        a.congruent = 1;
        pg_rows shared = rows_at (&a, &c, PLACES, x, NULL);
        a.congruent = 0;
        assert_int_equal (shared.family.start[2], 2 * GROUP);
        check_alike (&alone, &shared, 1e-10);
        pg_rows_clear (&alone), pg_rows_clear (&shared);
        lattice_clear (&c);
    }
}

static void any_allocation_may_fail (void **state)
{
    (void) state;
    pg_cloud c = lattice (2, 8, 1, 0);
    pg_approx a = make ("rkpm", "cubic_spline", 1, PG_RADIAL, 2);
    a.congruent = 1;
    pg_rows r = rows_at_nodes (&a, &c);
    size_t before = pg_memory_used (), k = 0;
    pg_status status = PG_E_MEMORY;
    while (status != PG_OK) {
        pg_memory_fail_at (++k);
        status = a.type->evaluate (&a, &c, &r, NULL, r.n, NULL, 2);
        pg_memory_fail_at (0);
        assert_true (status == PG_OK || status == PG_E_MEMORY);
        assert_int_equal (pg_memory_used (), before);
    }
    assert_true (k > 6);
    pg_rows_clear (&r);
    lattice_clear (&c);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (shared_values_are_those_of_each_place),
        cmocka_unit_test (company_order_and_threads_change_no_bit),
        cmocka_unit_test (places_that_differ_share_nothing),
        cmocka_unit_test (one_node_elsewhere_makes_a_difference),
        cmocka_unit_test (any_allocation_may_fail),
    };
    return cmocka_run_group_tests_name ("discretization/approx/congruent", tests, NULL, NULL);
}
