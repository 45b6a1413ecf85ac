/* SPDX-License-Identifier: GPL-3.0-or-later
 * Products with sparse matrices and B = T' A T, against dense ones. */
#include "systems.h"

static dense random_dense (size_t nrow, size_t ncol, double share, int symmetric)
{
    dense D = dense_new (nrow, ncol);
    for (size_t i = 0; i < nrow; i++)
        for (size_t j = symmetric ? i : 0; j < ncol; j++) {
            if (0.5 + 0.5 * random_number () >= share && !(symmetric && i == j)) continue;
            dense_set (&D, i, j, random_number ());
            if (symmetric) dense_set (&D, j, i, dense_at (&D, i, j));
        }
    return D;
}

static void products_equal_dense_ones (void **state)
{
    (void) state;
    static const size_t sizes[][2] = { { 1, 1 }, { 40, 40 }, { 30, 50 }, { 50, 30 } };
    for (int s = 0; s < 4; s++)
        for (int symmetric = 0; symmetric <= (sizes[s][0] == sizes[s][1]); symmetric++) {
            dense D = random_dense (sizes[s][0], sizes[s][1], 0.2, symmetric);
            pg_sparse A = sparse_of (&D, symmetric);
            double x[50], y[50], goal[50];
            for (int i = 0; i < 50; i++) x[i] = random_number ();
            multiply (&D, x, goal);
            pg_sparse_multiply (&A, x, y);
            for (size_t i = 0; i < D.nrow; i++) check_absolute (y[i], goal[i], 1e-14);
            pg_sparse_multiply_transposed (&A, x, y);
            for (size_t j = 0; j < D.ncol; j++) {
                double sum = 0;
                for (size_t i = 0; i < D.nrow; i++) sum += dense_at (&D, i, j) * x[i];
                check_absolute (y[j], sum, 1e-14);
            }
            pg_sparse_clear (&A);
            dense_free (&D);
        }
}

static void the_operator_of_a_matrix_is_the_matrix (void **state)
{
    (void) state;
    for (int symmetric = 0; symmetric < 2; symmetric++) {
        dense D = random_dense (30, 30, 0.2, symmetric);
        pg_sparse A = sparse_of (&D, symmetric);
        pg_operator op = pg_sparse_operator (&A);
        double x[30], y[30], goal[30], d[30];
        for (int i = 0; i < 30; i++) x[i] = random_number ();
        assert_int_equal (op.n, 30);
        op.apply (op.context, x, y);
        op.diagonal (op.context, d);
        multiply (&D, x, goal);
        for (size_t i = 0; i < 30; i++) {
            check_absolute (y[i], goal[i], 1e-14);
            assert_true (d[i] == dense_at (&D, i, i));
        }
        pg_sparse_clear (&A);
        dense_free (&D);
    }
}

/* T' A T, dense */
static dense congruent (const dense *A, const dense *T)
{
    dense B = dense_new (T->ncol, T->ncol);
    for (size_t m = 0; m < T->ncol; m++)
        for (size_t k = 0; k < T->ncol; k++) {
            double sum = 0;
            for (size_t i = 0; i < A->nrow; i++)
                for (size_t j = 0; j < A->ncol; j++)
                    sum += dense_at (T, i, m) * dense_at (A, i, j) * dense_at (T, j, k);
            dense_set (&B, m, k, sum);
        }
    return B;
}

static void congruence_equals_the_dense_one (void **state)
{
    (void) state;
    static const size_t cols[] = { 1, 7, 25, 40 };
    for (int s = 0; s < 4; s++) {
        dense A = random_dense (40, 40, 0.1, 1), T = random_dense (40, cols[s], 0.1, 0),
              B = congruent (&A, &T);
        pg_sparse a = sparse_of (&A, 1), t = sparse_of (&T, 0), b;
        check_ok (pg_sparse_congruence (&b, &a, &t));
        assert_int_equal (b.ncol, cols[s]);
        assert_int_equal (b.nrow, cols[s]);
        assert_true (b.symmetric);
        for (size_t k = 0; k < b.ncol; k++) {
            for (long p = b.start[k]; p < b.start[k + 1]; p++) {
                assert_true ((size_t) b.row[p] <= k && (p == b.start[k] || b.row[p] > b.row[p - 1]));
                check_absolute (b.value[p], dense_at (&B, (size_t) b.row[p], k), 1e-13);
                dense_set (&B, (size_t) b.row[p], k, 0);
            }
            /* nothing was left out */
            for (size_t m = 0; m <= k; m++) check_absolute (dense_at (&B, m, k), 0, 1e-13);
        }
        pg_sparse_clear (&a), pg_sparse_clear (&t), pg_sparse_clear (&b);
        dense_free (&A), dense_free (&T), dense_free (&B);
    }
}

static void the_pattern_of_a_congruence_ignores_values (void **state)
{
    (void) state;
    dense A = random_dense (30, 30, 0.1, 1), T = random_dense (30, 12, 0.15, 0);
    pg_sparse a = sparse_of (&A, 1), t = sparse_of (&T, 0), full, zero;
    check_ok (pg_sparse_congruence (&full, &a, &t));
    for (long p = 0; p < a.start[30]; p += 2) a.value[p] = 0;
    for (long p = 0; p < t.start[12]; p += 3) t.value[p] = 0;
    check_ok (pg_sparse_congruence (&zero, &a, &t));
    assert_memory_equal (full.start, zero.start, 13 * sizeof *full.start);
    assert_memory_equal (full.row, zero.row, (size_t) full.start[12] * sizeof *full.row);
    pg_sparse_clear (&a), pg_sparse_clear (&t), pg_sparse_clear (&full), pg_sparse_clear (&zero);
    dense_free (&A), dense_free (&T);
}

/* A selection of unknowns, and the same with twos in place of ones, which goes the general way: all numbers
 * are four times as large, to the bit. */
static void a_selection_takes_entries_over (void **state)
{
    (void) state;
    for (int ascending = 0; ascending < 2; ascending++) {
        dense A = random_dense (40, 40, 0.2, 1), T = dense_new (40, 20);
        for (size_t k = 0; k < 20; k++) dense_set (&T, ascending ? 2 * k + k % 2 : 39 - 2 * k, k, 1);
        pg_sparse a = sparse_of (&A, 1), t = sparse_of (&T, 0), chosen, general;
        check_ok (pg_sparse_congruence (&chosen, &a, &t));
        for (int k = 0; k < 20; k++) t.value[k] = 2;
        check_ok (pg_sparse_congruence (&general, &a, &t));
        size_t nnz = (size_t) general.start[20];
        assert_true (nnz > 40);
        assert_memory_equal (chosen.start, general.start, 21 * sizeof *general.start);
        assert_memory_equal (chosen.row, general.row, nnz * sizeof *general.row);
        for (size_t p = 0; p < nnz; p++) assert_true (4 * chosen.value[p] == general.value[p]);
        pg_sparse_clear (&a), pg_sparse_clear (&t), pg_sparse_clear (&chosen), pg_sparse_clear (&general);
        dense_free (&A), dense_free (&T);
    }
}

static void each_failed_allocation_is_reported (void **state)
{
    (void) state;
    dense A = random_dense (30, 30, 0.1, 1), T = random_dense (30, 12, 0.15, 0);
    pg_sparse a = sparse_of (&A, 1), t = sparse_of (&T, 0), b;
    size_t used = pg_memory_used (), k = 0;
    pg_status status = PG_E_MEMORY;
    while (status != PG_OK) {
        pg_memory_fail_at (++k);
        status = pg_sparse_congruence (&b, &a, &t);
        pg_memory_fail_at (0);
        if (status == PG_OK) break;
        assert_int_equal (status, PG_E_MEMORY);
        assert_int_equal (pg_memory_used (), used);
        assert_true (k < 200);
    }
    assert_true (k > 10);
    pg_sparse_clear (&b);
    pg_sparse_clear (&a), pg_sparse_clear (&t);
    dense_free (&A), dense_free (&T);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (products_equal_dense_ones),
        cmocka_unit_test (the_operator_of_a_matrix_is_the_matrix),
        cmocka_unit_test (congruence_equals_the_dense_one),
        cmocka_unit_test (the_pattern_of_a_congruence_ignores_values),
        cmocka_unit_test (a_selection_takes_entries_over),
        cmocka_unit_test (each_failed_allocation_is_reported),
    };
    return cmocka_run_group_tests_name ("linalg/sparse", tests, NULL, NULL);
}
