/* SPDX-License-Identifier: GPL-3.0-or-later
 * Principal stresses against closed forms and against tensors with known values, turned at random. */
#include "check.h"
#include "perigal/material.h"

static unsigned long long seed = 12345;
static double rnd (void)                               /* in (-1, 1) */
{
    seed = seed * 6364136223846793005ull + 1442695040888963407ull;
    return (double) (seed >> 11) / 4503599627370496.0 - 1;
}

/* s = Q diag (v) Q' with a random rotation from a unit quaternion */
static void turned (const double *v, double *s)
{
    double q[4], norm = 0, Q[3][3], M[3][3] = { { 0 } };
    for (int k = 0; k < 4; k++) q[k] = rnd (), norm += q[k] * q[k];
    for (int k = 0; k < 4; k++) q[k] /= sqrt (norm);
    double w = q[0], x = q[1], y = q[2], z = q[3];
    const double R[3][3] = { { 1 - 2 * (y*y + z*z), 2 * (x*y - w*z), 2 * (x*z + w*y) },
                             { 2 * (x*y + w*z), 1 - 2 * (x*x + z*z), 2 * (y*z - w*x) },
                             { 2 * (x*z - w*y), 2 * (y*z + w*x), 1 - 2 * (x*x + y*y) } };
    memcpy (Q, R, sizeof Q);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            for (int k = 0; k < 3; k++) M[i][j] += Q[i][k] * v[k] * Q[j][k];
    const double voigt[6] = { M[0][0], M[1][1], M[2][2], M[0][1], M[1][2], M[2][0] };
    memcpy (s, voigt, sizeof voigt);
}

static void turned_tensor_gives_back_its_values (void **state)
{
    (void) state;
    const double set[7][3] = { { 3, 1, -2 },
                               { 3, 3, -2 },
                               { 3, -2, -2 },
                               { 5, 5, 5 },
                               { 1e-9, 0, -1e-9 },
                               { 1, 1 - 1e-7, -1 },
                               { 1e3, 999.9999, 999.9998 } };
    double s[6], p[3];
    for (int t = 0; t < 7; t++)
        for (int k = 0; k < 200; k++) {
            double top = fmax (fabs (set[t][0]), fabs (set[t][2]));
            turned (set[t], s);
            pg_principal (3, 1, s, NULL, p);
            for (int i = 0; i < 3; i++) check_scaled (p[i], set[t][i], 3e-14, top);
        }
}

static void random_tensors_agree_with_the_eigenvalue_solver (void **state)
{
    (void) state;
    double s[6], p[3], lambda[3];
    for (int k = 0; k < 5000; k++) {
        for (int i = 0; i < 6; i++) s[i] = 1e6 * rnd ();
        const double M[9] = { s[0], s[3], s[5], s[3], s[1], s[4], s[5], s[4], s[2] };
        pg_principal (3, 1, s, NULL, p);
        pg_dense_eigen (3, M, lambda, NULL);
        for (int i = 0; i < 3; i++) check_scaled (p[i], lambda[i], 1e-13, 1e6);
    }
}

/* Bounds without angles are on the safe side, by little; where two values are equal, too. */
static void bounds_hold_and_are_tight (void **state)
{
    (void) state;
    const double set[6][3] = { { 3, 3, -2 }, { 3, -2, -2 }, { 5, 5, 5 }, { 0, 0, -4 }, { 1, 1 - 1e-7, -1 },
                               { 0, 0, 0 } };
    double s[6], p[3], most, least, loosest = 0;
    for (int k = 0; k < 20000; k++) {
        for (int i = 0; i < 6; i++) s[i] = rnd () * (i < 3 ? 3 : 1);
        if (k < 1200) turned (set[k % 6], s);
        pg_principal (3, 1, s, NULL, p);
        pg_principal_bounds (3, 1, s, NULL, &most, &least);
        assert_true (most >= p[0] && least <= p[2]);
        double shear = 0.5 * (p[0] - p[2]), slack = fmax (most - p[0], p[2] - least);
        assert_true (slack <= 5e-5 * shear + 1e-10);
        loosest = fmax (loosest, slack / fmax (shear, 1e-6));
    }
    print_message ("slack %.2g of the largest shear\n", loosest);
    pg_principal (2, 1, s, NULL, p);
    pg_principal_bounds (2, 1, s, NULL, &most, &least);
    assert_true (most == p[0] && least == p[2]);
}

static void plane_tensor_sorts_the_stress_across (void **state)
{
    (void) state;
    const double s[12] = { 3, 1, 0, 3, 1, 0, 3, 1, 0, 1, 1, 2 }, zz[4] = { 5, 2, -1, 0 };
    const double want[12] = { 5, 3, 1, 3, 2, 1, 3, 1, -1, 3, 0, -1 };
    double p[12];
    pg_principal (2, 4, s, zz, p);
    for (int i = 0; i < 12; i++) check_absolute (p[i], want[i], 1e-15);
}

static void without_stress_across_it_is_zero (void **state)
{
    (void) state;
    const double s[3] = { -4, -1, 0 }, want[3] = { 0, -1, -4 };
    double p[3];
    pg_principal (2, 1, s, NULL, p);
    for (int i = 0; i < 3; i++) check_absolute (p[i], want[i], 1e-15);
}

static void a_bar_has_one_principal_stress (void **state)
{
    (void) state;
    const double s[2] = { 2, -3 }, want[6] = { 2, 0, 0, 0, 0, -3 };
    double p[6];
    pg_principal (1, 2, s, NULL, p);
    for (int i = 0; i < 6; i++) check_absolute (p[i], want[i], 1e-15);
}

static void no_stress_gives_zeros (void **state)
{
    (void) state;
    const double s[6] = { 0 };
    double p[3] = { 1, 1, 1 };
    pg_principal (3, 1, s, NULL, p);
    for (int i = 0; i < 3; i++) check_absolute (p[i], 0, 0);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (turned_tensor_gives_back_its_values),
        cmocka_unit_test (random_tensors_agree_with_the_eigenvalue_solver),
        cmocka_unit_test (bounds_hold_and_are_tight),
        cmocka_unit_test (plane_tensor_sorts_the_stress_across),
        cmocka_unit_test (without_stress_across_it_is_zero),
        cmocka_unit_test (a_bar_has_one_principal_stress),
        cmocka_unit_test (no_stress_gives_zeros),
    };
    return cmocka_run_group_tests_name ("mechanics/material/principal", tests, NULL, NULL);
}
