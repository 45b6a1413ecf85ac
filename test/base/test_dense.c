/* SPDX-License-Identifier: GPL-3.0-or-later
 * Small dense algebra against random matrices of every size it takes, well and badly scaled. */
#include "check.h"
#include <float.h>

enum { MOST = 16 };
static uint64_t seed = 88172645463325252u;

static double random_number (void)                     /* in [-1, 1) */
{
    seed ^= seed << 13, seed ^= seed >> 7, seed ^= seed << 17;
    return (double) (seed >> 11) / 4503599627370496.0 - 1;
}

/* A = G G' + shift I, scaled */
static void random_spd (int n, double shift, double scale, double *A)
{
    double G[MOST * MOST];
    for (int i = 0; i < n * n; i++) G[i] = random_number ();
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++) {
            double s = i == j ? shift : 0;
            for (int k = 0; k < n; k++) s += G[i*n + k] * G[j*n + k];
            A[i*n + j] = scale * s;
        }
}

static void cholesky_gives_back_the_matrix (void **state)
{
    (void) state;
    for (int n = 1; n <= MOST; n++)
        for (int power = -200; power <= 200; power += 100) {
            double A[MOST * MOST], L[MOST * MOST], scale = pow (10, power);
            random_spd (n, 0.5, scale, A);
            memcpy (L, A, sizeof L);
            assert_int_equal (pg_dense_cholesky (n, L, 1e-14), 0);
            for (int i = 0; i < n; i++)
                for (int j = 0; j <= i; j++) {
                    double s = 0;
                    for (int k = 0; k <= j; k++) s += L[i*n + k] * L[j*n + k];
                    check_scaled (s, A[i*n + j], 1e-14, n * scale);
                }
        }
}

static void solve_gives_back_the_answer (void **state)
{
    (void) state;
    for (int n = 1; n <= MOST; n++) {
        double A[MOST * MOST], x[MOST], b[MOST];
        random_spd (n, 0.5, 1e9, A);
        for (int i = 0; i < n; i++) x[i] = random_number ();
        for (int i = 0; i < n; i++) {
            b[i] = 0;
            for (int j = 0; j < n; j++) b[i] += A[i*n + j] * x[j];
        }
        assert_int_equal (pg_dense_cholesky (n, A, 1e-14), 0);
        pg_dense_solve (n, A, b);
        for (int i = 0; i < n; i++) check_scaled (b[i], x[i], 1e-12, 1);
    }
}

static void cholesky_names_the_row_that_fails (void **state)
{
    (void) state;
    for (int n = 1; n <= MOST; n++)
        for (int bad = 0; bad < n; bad++) {
            double A[MOST * MOST];
            random_spd (n, 0.5, 1, A);
            A[bad*n + bad] = -1;                       /* rows above stay positive definite */
            assert_int_equal (pg_dense_cholesky (n, A, 1e-14), bad + 1);
        }
}

static void a_rank_deficit_is_seen_at_every_scale (void **state)
{
    (void) state;
    for (int power = -150; power <= 150; power += 50) {
        double s = pow (10, power), A[9] = { s, 2*s, 3*s, 2*s, 4*s, 6*s, 3*s, 6*s, 9*s };
        assert_int_equal (pg_dense_cholesky (3, A, 1e-12), 2);
    }
    double nan[1] = { NAN }, zero[1] = { 0 };
    assert_int_equal (pg_dense_cholesky (1, nan, 1e-12), 1);
    assert_int_equal (pg_dense_cholesky (1, zero, 1e-12), 1);
}

static void eigenpairs_rebuild_the_matrix (void **state)
{
    (void) state;
    for (int n = 1; n <= MOST; n++)
        for (int power = -100; power <= 100; power += 100) {
            double A[MOST * MOST] = { 0 }, keep[MOST * MOST], lambda[MOST], V[MOST * MOST];
            double scale = pow (10, power);
            for (int i = 0; i < n; i++)
                for (int j = 0; j <= i; j++) A[i * n + j] = A[j * n + i] = scale * random_number ();
            memcpy (keep, A, sizeof keep);
            pg_dense_eigen (n, A, lambda, V);
            assert_memory_equal (A, keep, (size_t) (n * n) * sizeof *A);
            for (int i = 1; i < n; i++) assert_true (lambda[i - 1] >= lambda[i]);
            for (int i = 0; i < n; i++)
                for (int j = 0; j < n; j++) {
                    double s = 0, dot = 0;
                    for (int k = 0; k < n; k++)
                        s += V[i * n + k] * lambda[k] * V[j * n + k], dot += V[k * n + i] * V[k * n + j];
                    check_scaled (s, A[i*n + j], 1e-13, n * scale);
                    check_absolute (dot, i == j, 1e-13);
                }
        }
}

static void eigenvalues_of_known_matrices (void **state)
{
    (void) state;
    double lambda[MOST], T[64] = { 0 }, I[9] = { 4, 0, 0, 0, 4, 0, 0, 0, 4 }, zero[4] = { 0 };
    for (int i = 0; i < 8; i++) T[i*8 + i] = 2;
    for (int i = 1; i < 8; i++) T[i*8 + i - 1] = T[(i - 1)*8 + i] = -1;
    pg_dense_eigen (8, T, lambda, NULL);
    for (int k = 0; k < 8; k++)
        check_absolute (lambda[k], 2 - 2 * cos ((8 - k) * 3.14159265358979323846 / 9), 1e-14);
    pg_dense_eigen (3, I, lambda, NULL);
    for (int k = 0; k < 3; k++) check_relative (lambda[k], 4, 1e-15);
    pg_dense_eigen (2, zero, lambda, NULL);
    assert_true (lambda[0] == 0 && lambda[1] == 0);
}

static void determinant_is_the_product_of_eigenvalues (void **state)
{
    (void) state;
    for (int n = 1; n <= 3; n++)
        for (int trial = 0; trial < 100; trial++) {
            double A[9], lambda[3], product = 1;
            for (int i = 0; i < n; i++)
                for (int j = 0; j <= i; j++) A[i * n + j] = A[j * n + i] = random_number ();
            pg_dense_eigen (n, A, lambda, NULL);
            for (int k = 0; k < n; k++) product *= lambda[k];
            check_absolute (pg_dense_det (n, A), product, 1e-14);
        }
    double skew[9] = { 0, 2, 0, 0, 0, 3, 4, 0, 0 };    /* a cyclic permutation: + 24 */
    check_relative (pg_dense_det (3, skew), 24, 1e-15);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (cholesky_gives_back_the_matrix),
        cmocka_unit_test (solve_gives_back_the_answer),
        cmocka_unit_test (cholesky_names_the_row_that_fails),
        cmocka_unit_test (a_rank_deficit_is_seen_at_every_scale),
        cmocka_unit_test (eigenpairs_rebuild_the_matrix),
        cmocka_unit_test (eigenvalues_of_known_matrices),
        cmocka_unit_test (determinant_is_the_product_of_eigenvalues),
    };
    return cmocka_run_group_tests_name ("base/dense", tests, NULL, NULL);
}
