/* SPDX-License-Identifier: GPL-3.0-or-later
 * What the graph of the nodes tells about the factor of the dofs before there is a matrix. */
#include "check.h"
#include <stdlib.h>
#include "perigal/linalg.h"

/* Upper triangle of a lattice whose nodes are coupled up to `reach` steps along each axis, in dense
 * blocks. */
static void lattice_matrix (pg_sparse *A, size_t side, int dim, int reach, size_t block)
{
    size_t n = 1, nnz = 0;
    for (int k = 0; k < dim; k++) n *= side;
    for (int pass = 0; pass < 2; pass++) {
        if (pass) check_ok (pg_sparse_create (A, n * block, n * block, nnz, 1));
        nnz = 0;
        for (size_t i = 0; i < n; i++)
            for (size_t b = 0; b < block; b++) {
                for (size_t j = 0; j <= i; j++) {
                    size_t p = i, q = j, near = 1;
                    for (int k = 0; k < dim; k++, p /= side, q /= side)
                        near &= labs ((long) (p % side) - (long) (q % side)) <= reach;
                    for (size_t a = 0; near && a < block && (j < i || a <= b); a++, nnz++)
                        if (pass)
                            A->row[nnz] = (long) (j * block + a), A->value[nnz] = i == j && a == b ? 1e3 : -1;
                }
                if (pass) A->start[i * block + b + 1] = (long) nnz;
            }
    }
}

static void forecast_of (size_t side, int dim, int reach, int block)
{
    pg_sparse G, A;
    pg_linear_info told, found;
    void *self = NULL;
    const pg_linear_type *chol = pg_linear_find ("cholmod");
    pg_linear_options o = { block, dim, 1, 0, 0 };
    lattice_matrix (&G, side, dim, reach, 1);
    lattice_matrix (&A, side, dim, reach, (size_t) block);
    check_ok (pg_linear_forecast (&G, block, 0, &told));
    check_ok (chol->analyse (&self, &A, &o));
    chol->info (self, &found);
    assert_string_equal (told.ordering, found.ordering);
    check_relative (told.factor_entries, found.factor_entries, 1e-15);
    check_relative (told.flops, found.flops, 1e-12);
    chol->free (&self);
    pg_sparse_clear (&A), pg_sparse_clear (&G);
}

static void test_bar (void **state)        { (void) state; forecast_of (200, 1, 3, 1); }
static void test_plate (void **state)      { (void) state; forecast_of (20, 2, 2, 2); }
/* 3528 unknowns: METIS */
static void test_large_plate (void **state) { (void) state; forecast_of (42, 2, 2, 2); }
static void test_solid (void **state)      { (void) state; forecast_of (8, 3, 1, 3); }
/* 3993 unknowns: METIS */
static void test_large_solid (void **state) { (void) state; forecast_of (11, 3, 2, 3); }

static void test_dense_block_is_a_triangle (void **state)
{
    (void) state;
    pg_sparse G;
    pg_linear_info info;
    lattice_matrix (&G, 5, 1, 5, 1);
    check_ok (pg_linear_forecast (&G, 3, 0, &info));
    assert_true (info.factor_entries == 15 * 16 / 2);
    assert_true (info.flops == 15 * 16 * 31 / 6);
    pg_sparse_clear (&G);
}

static void test_failing_allocations (void **state)
{
    (void) state;
    pg_sparse G;
    pg_linear_info info;
    lattice_matrix (&G, 6, 2, 1, 1);
    size_t used = pg_memory_used ();
    for (size_t k = 1;; k++) {
        pg_memory_fail_at (k);
        pg_status status = pg_linear_forecast (&G, 2, 0, &info);
        pg_memory_fail_at (0);
        assert_int_equal (pg_memory_used (), used);
        if (status == PG_OK) break;
        assert_int_equal (status, PG_E_MEMORY);
    }
    pg_sparse_clear (&G);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (test_bar),
        cmocka_unit_test (test_plate),
        cmocka_unit_test (test_large_plate),
        cmocka_unit_test (test_solid),
        cmocka_unit_test (test_large_solid),
        cmocka_unit_test (test_dense_block_is_a_triangle),
        cmocka_unit_test (test_failing_allocations),
    };
    return cmocka_run_group_tests_name ("linalg/forecast", tests, NULL, NULL);
}
