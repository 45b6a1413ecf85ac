/* SPDX-License-Identifier: GPL-3.0-or-later
 * Stress intensity factors behind a kink: the weight functions of a polyline against the expansions of
 * Amestoy and Leblond (1992), Betti's integral over a ring with exact fields, and runs whose second facet
 * needs the load that linear elastic fracture mechanics gives on the same path (finite elements with
 * quarter-point sizes, bench/kinks.py). */
#include "check.h"
#include "crack/fracture/kinked_crack.h"
#include "perigal/fracture.h"

static const double pi = 3.14159265358979323846;

static double series (const double *c, int n, double m, int first)
{
    double sum = 0;
    for (int k = n - 1; k >= 0; k--) sum = sum * m * m + c[k];
    return sum * (first ? m : 1);
}

/* F (theta), m = theta / pi: K_I, K_II at the end of a short branch under K_I, K_II of the straight crack. */
static void expansions (double theta, double F[2][2])
{
    double p2 = pi * pi, p3 = p2 * pi, p4 = p2 * p2, p5 = p4 * pi, p6 = p4 * p2, m = theta / pi;
    double a[] = { 1, -3 * p2 / 8, p2 - 5 * p4 / 128, p2 / 9 - 11 * p4 / 72 + 119 * p6 / 15360, 5.07790,
                   -2.88312, -0.0925, 2.996, -4.059, 1.63, 4.1 };
    double b[] = { -1.5 * pi, 10 * pi / 3 + p3 / 16, -2 * pi - 133 * p3 / 180 + 59 * p5 / 1280, 12.313906,
                   -7.32433, 1.5793, 4.0216, -6.915, 4.21, 4.56 };
    double c[] = { 0.5 * pi, -4 * pi / 3 - p3 / 48, -2 * pi / 3 + 13 * p3 / 30 - 59 * p5 / 3840, -6.176023,
                   4.44112, -1.5340, -2.0700, 4.684, -3.95, -1.32 };
    double d[] = { 1, -4 - 3 * p2 / 8, 8.0 / 3 + 29 * p2 / 18 - 5 * p4 / 128,
                   -32.0 / 15 - 4 * p2 / 9 - 1159 * p4 / 7200 + 119 * p6 / 15360, 10.58254, -4.78511, -1.8804,
                   7.280, -7.591, 0.25, 12.5 };
    F[0][0] = series (a, 11, m, 0), F[1][0] = series (b, 10, m, 1);
    F[0][1] = series (c, 10, m, 1), F[1][1] = series (d, 11, m, 0);
}

static void branches_have_the_factors_of_the_expansions (void **state)
{
    (void) state;
    static const double degrees[] = { 1, -15, 15, 43.2, 70.5 }, allowed[] = { 1e-6, 1e-6, 1e-6, 1e-5, 1e-4 };
    for (int i = 0; i < 5; i++) {
        double theta = degrees[i] * pi / 180, F[2][2];
        double complex end = cexp (_Complex_I * theta);
        kinked_weights w;
        expansions (theta, F);
        check_ok (kinked_weights_of (&w, 1, &end, 0, NULL, 0));
        for (int l = 0; l < 2; l++)
            for (int k = 0; k < 2; k++) check_absolute (w.k[l][k], F[l][k], allowed[i]);
    }
}

/* A stress T along the straight crack: K over T sqrt (length) is G (theta) of the same expansions. */
static void a_stress_along_the_crack_acts_on_the_branch (void **state)
{
    (void) state;
    double m = 0.15, root = sqrt (2 * pi), length = 1.7;
    double g1[] = { 0, root * root * root, -47.933390, 63.665987, -50.70880, 26.66807, -6.0205, -7.314 },
           g2[] = { -2 * root, 12 * root, -59.565733, 61.174444, -39.90249, 15.6222, 3.0343, -12.781 };
    double complex end = length * cexp (_Complex_I * pi * m);
    kinked_weights w;
    kinked_faces T = { .S = { 3, 0, 0 } };
    check_ok (kinked_weights_of (&w, 1, &end, 1, &T, 0));
    check_absolute (w.own[0][0] / (3 * sqrt (length)), series (g1, 8, m, 0), 1e-5);
    check_absolute (w.own[0][1] / (3 * sqrt (length)), series (g2, 8, m, 1), 1e-5);
}

/* Forces on the faces of the straight part, against those of a straight crack: sqrt (2 / (pi d)) a unit of
 * force at the distance d from its tip (Tada, Paris and Irwin). In two pieces behind the kink. */
static void tractions_of_the_straight_faces_act_on_the_tip (void **state)
{
    (void) state;
    double complex v[2] = { 0.7, 1.3 };
    static const double stress[2][2] = { { 0, 2 }, { 3, 0 } };
    const double reach = 4;
    kinked_weights w;
    check_ok (kinked_weights_of (&w, 2, v, 0, NULL, reach));
    for (int mode = 0; mode < 2; mode++) {
        kinked_moments m;
        double K[2], right = 0;
        memset (&m, 0, sizeof m);
        for (int i = 0; i < KINKED_PLACES; i++) {
            kinked_moments_face (&m, i, stress[mode], 0.5, 3, 2, reach);
            right -= 0.5 * (stress[mode][0] + stress[mode][1]) * reach / KINKED_PLACES
                     * sqrt (2 / (pi * (1.3 + kinked_place_at (reach, i))));
        }
        assert_true (kinked_intensities (&w, &m, 8 * 3 / (2 + 1), 0, K));  /* 8 mu / (kappa + 1) */
        check_relative (K[mode], right, 1e-3);
        check_absolute (K[1 - mode], 0, 1e-9);
    }
}

/* A crack that goes straight on keeps its K; two pieces in one line are one. */
static void collinear_pieces_are_one (void **state)
{
    (void) state;
    double complex straight[3] = { 0.4, 1.1, 2 }, one = 1.5 * cexp (0.8 * _Complex_I),
                   three[3] = { 0.2 * one, 0.7 * one, one };
    kinked_weights a, b;
    check_ok (kinked_weights_of (&a, 3, straight, 0, NULL, 0));
    check_absolute (a.k[0][0], 1, 1e-5), check_absolute (a.k[1][1], 1, 1e-5);
    check_absolute (a.k[0][1], 0, 1e-12), check_absolute (a.k[1][0], 0, 1e-12);
    check_ok (kinked_weights_of (&a, 1, &one, 0, NULL, 0));
    check_ok (kinked_weights_of (&b, 3, three, 0, NULL, 0));
    for (int l = 0; l < 2; l++)
        for (int k = 0; k < 2; k++) check_absolute (a.k[l][k], b.k[l][k], 1e-4);
}

/* ---- Betti's integral ---------------------------------------------------------------------------------- */
static const double mu = 0.4, kappa = 1.9;

/* Potentials c z^power with free faces on the negative axis: Omega = Phi for half powers, -Phi for whole
 * ones with a real factor. */
static void power_field (double complex c, double power, double complex z, double complex *u, double s[3])
{
    int half = fabs (power - floor (power) - 0.5) < 1e-9;
    double sign = half ? 1 : -1;
    double complex w = conj (z), Phi = c * cpow (z, power), slope = c * power * cpow (z, power - 1),
                   Omega = sign * c * cpow (w, power),
                   across = Phi + Omega + (z - w) * conj (slope), phi = Phi * z / (power + 1),
                   omega = Omega * w / (power + 1);
    double sum = 4 * creal (Phi);
    *u = (kappa * phi - omega - (z - w) * conj (Phi)) / (2 * mu);
    s[1] = creal (across), s[2] = -cimag (across), s[0] = sum - s[1];
}

/* K at the end of the polyline by the ring r1 .. r2 about a field of that power and strength. */
static void by_ring (const kinked_weights *w, double complex c, double power, double r1, double r2,
                     double extent, double K[2])
{
    enum { R = 60, A = 96 };
    double dr = (r2 - r1) / R, da = 2 * pi / A, modulus = 8 * mu / (kappa + 1);
    kinked_moments m;
    memset (&m, 0, sizeof m);
    for (int i = 0; i < R; i++)
        for (int j = 0; j < A; j++) {
            double r = r1 + (i + 0.5) * dr, a = -pi + (j + 0.5) * da, s[3], Z = (r - r1) / (r2 - r1),
                   slope = -6 * Z * (1 - Z) / (r2 - r1), g[2] = { slope * cos (a), slope * sin (a) },
                   area = r * dr * da;
            double complex z = r * cexp (_Complex_I * a), u;
            power_field (c, power, z, &u, s);
            kinked_place at = { .z = z,
                                .t = area * (s[0] * g[0] + s[2] * g[1]
                                             + _Complex_I * (s[2] * g[0] + s[1] * g[1])),
                                .M = { area * creal (u) * g[0], area * cimag (u) * g[1],
                                       0.5 * area * (creal (u) * g[1] + cimag (u) * g[0]) } };
            kinked_moments_add (&m, &at, mu, kappa, extent);
        }
    assert_true (kinked_intensities (w, &m, modulus, 0, K));
}

/* The singular field of the straight crack and the stress along it load the polyline as the system of
 * dislocations says, also beyond two turns; what decays from the kink does not count. */
static void betti_gives_what_loads_the_kink (void **state)
{
    (void) state;
    double complex v[2] = { 0.8 * cexp (0.7 * _Complex_I), 0.8 * cexp (0.7 * _Complex_I) + 0.9 };
    double extent = cabs (v[1]), K[2];
    kinked_weights w, T;
    kinked_faces along = { .S = { 4, 0, 0 } };
    check_ok (kinked_weights_of (&w, 2, v, 0, NULL, 0));
    check_ok (kinked_weights_of (&T, 2, v, 1, &along, 0));
    for (int outer = 0; outer < 2; outer++) {
        double r1 = outer ? 4 : 1.15 * extent, r2 = 7;
        for (int l = 0; l < 2; l++) {
            by_ring (&w, (l ? -_Complex_I : 1) / (2 * sqrt (2 * pi)), -0.5, r1, r2, extent, K);
            check_absolute (K[0], w.k[l][0], 1e-3), check_absolute (K[1], w.k[l][1], 1e-3);
        }
        by_ring (&w, 1, 0, r1, r2, extent, K);         /* Phi = 1: sigma_11 = 4 */
        check_scaled (K[0], T.own[0][0], 1e-3, 4), check_scaled (K[1], T.own[0][1], 1e-3, 4);
        for (int l = 0; l < 2; l++) {
            by_ring (&w, l ? _Complex_I : 1, -1.5, r1, r2, extent, K);
            check_absolute (K[0], 0, 2e-3), check_absolute (K[1], 0, 2e-3);
        }
    }
}

int main (void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test (branches_have_the_factors_of_the_expansions),
                                        cmocka_unit_test (a_stress_along_the_crack_acts_on_the_branch),
                                        cmocka_unit_test (tractions_of_the_straight_faces_act_on_the_tip),
                                        cmocka_unit_test (collinear_pieces_are_one),
                                        cmocka_unit_test (betti_gives_what_loads_the_kink) };
    return cmocka_run_group_tests_name ("crack/fracture/kinked_crack", tests, NULL, NULL);
}
