/* SPDX-License-Identifier: GPL-3.0-or-later
 * Utilisation and load factor of all criteria. parameter[]: stretch {limit, finite}, principal_stress {T},
 * mohr_coulomb {T, c, phi}. */
#include "check.h"
#include "perigal/criterion.h"
#include <math.h>

static unsigned long long seed = 4711;
static double rnd (void)                               /* in (-1, 1) */
{
    seed = seed * 6364136223846793005ull + 1442695040888963407ull;
    return (double) (seed >> 11) / 4503599627370496.0 - 1;
}

static pg_criterion make (const char *name, double a, double b, double c)
{
    return (pg_criterion) { .type = pg_criterion_find (name), .parameter = { a, b, c } };
}

static pg_criterion rock (void)
{
    return make ("mohr_coulomb", 0.5e6, 5e6, 40 * 3.14159265358979323846 / 180);
}

static double stress_use (const pg_criterion *c, double s1, double s3, char *kind)
{
    double u;
    char k;
    const double s2 = s3;
    const pg_bond_measures m = { .n = 1, .dim = 3, .s1 = &s1, .s2 = &s2, .s3 = &s3 };
    c->type->utilisation (c, &m, &u, &k);
    if (kind) *kind = k;
    return u;
}

/* Shares add up as squares, or the largest counts; shortening has none. */
static void beams_break_by_energy (void **state)
{
    (void) state;
    const double xi[3][2] = { { 2, 0 }, { 0, 1 }, { 1, 0 } },
                 eta[3][2] = { { 0.2, 5 }, { 7, -0.3 }, { 0.06, 0 } }, shear[3] = { 0.01, 0.02, 0.08 },
                 bending[3] = { 0.3, 0.1, 0 };
    double u[3], f[3];
    char kind[3];
    pg_criterion c = { .type = pg_criterion_find ("beam_limits"), .parameter = { 0.1, 0.1, 0.4, 1 } };
    const pg_bond_measures m = {
        .n = 3, .dim = 2, .xi = &xi[0][0], .eta = &eta[0][0], .shear = shear, .bending = bending
    };
    for (int single = 0; single < 2; single++) {
        c.single = single;
        c.type->utilisation (&c, &m, u, kind);
        c.type->factor (&c, &m, f);
        check_relative (u[0], single ? 1 : sqrt (1 + 0.01 + 0.5625), 1e-12);
        check_relative (u[1], single ? 0.25 : hypot (0.2, 0.25), 1e-12);
        check_relative (u[2], single ? 0.8 : 1, 1e-12);
        assert_memory_equal (kind, "tbs", 3);
        for (int k = 0; k < 3; k++) check_relative (f[k] * u[k], 1, 1e-12);
    }
}

static void the_catalogue_lists_seven (void **state)
{
    (void) state;
    assert_string_equal (pg_criterion_names (),
                         "stretch|principal_stress|mohr_coulomb|drucker_prager|node_energy|beam_limits|"
                         "energy_release");
    assert_null (pg_criterion_find ("energy"));
    assert_int_equal (pg_criterion_find ("stretch")->needs, PG_NEEDS_STRETCH);
    assert_int_equal (pg_criterion_find ("mohr_coulomb")->needs, PG_NEEDS_STRESS);
    assert_int_equal (pg_criterion_find ("drucker_prager")->needs, PG_NEEDS_STRESS);
    assert_int_equal (pg_criterion_find ("node_energy")->needs, PG_NEEDS_ENERGY);
    assert_int_equal (pg_criterion_find ("beam_limits")->needs, PG_NEEDS_BEAMS);
}

static double cone_use (const pg_criterion *c, double s1, double s2, double s3, char *kind)
{
    double u, f;
    const pg_bond_measures m = { .n = 1, .dim = 3, .s1 = &s1, .s2 = &s2, .s3 = &s3 };
    c->type->utilisation (c, &m, &u, kind);
    c->type->factor (c, &m, &f);
    if (u > 0) check_relative (f * u, 1, 1e-12);
    else assert_true (isinf (f));
    return u;
}

/* The cone of Drucker and Prager goes through the compressive edges of Mohr-Coulomb's pyramid: where the
 * two larger stresses are equal both criteria agree; elsewhere it bears more, by up to what pure shear
 * shows. Without friction it is von Mises. */
static void the_cone_touches_the_pyramid (void **state)
{
    (void) state;
    char kind;
    pg_criterion cone = rock (), pyramid = rock ();
    cone.type = pg_criterion_find ("drucker_prager");
    const double phi = pyramid.parameter[2], strength = 2 * 5e6 * cos (phi) / (1 - sin (phi));
    check_relative (cone_use (&cone, 0, 0, -strength, &kind), 1, 1e-12);
    assert_int_equal (kind, 's');
    for (int k = 0; k < 200; k++) {
        double low = -1e7 * (2 + rnd ()), high = low + 1e7 * (1 + rnd ()),
               middle = low + (high - low) * 0.5 * (1 + rnd ());
        if (high > 0) continue;
        double edge = cone_use (&cone, high, high, low, NULL),
               most = cone_use (&pyramid, high, high, low, NULL);
        check_scaled (edge, most, 1e-12, 1);
        assert_true (cone_use (&cone, high, middle, low, NULL)
                     <= cone_use (&pyramid, high, middle, low, NULL) + 1e-12);
    }
    assert_true (cone_use (&cone, -1e6, -1e6, -1e6, NULL) == 0);
    check_relative (cone_use (&cone, 0.25e6, 0, 0, &kind), 0.5, 1e-12);
    assert_int_equal (kind, 't');
    pg_criterion mises = make ("drucker_prager", 1e9, 5e6, 0);
    for (int k = 0; k < 100; k++) {
        double s[3] = { 3e6 + 1e6 * rnd (), 2e6 * rnd (), -3e6 + 1e6 * rnd () };
        double equivalent = sqrt (0.5 * ((s[0] - s[1]) * (s[0] - s[1]) + (s[1] - s[2]) * (s[1] - s[2])
                                         + (s[2] - s[0]) * (s[2] - s[0])));
        check_relative (cone_use (&mises, s[0], s[1], s[2], NULL), equivalent / 1e7, 1e-12);
    }
}

/* Where spacings differ: limits by an energy per area go with horizon^(-1/2), a stretch that is given is the
 * same everywhere. */
static void limits_follow_the_horizon_where_an_energy_gives_them (void **state)
{
    (void) state;
    const double xi[4] = { 1, 0, 2, 0 }, eta[4] = { 1e-3, 0, 2e-3, 0 }, reach[2] = { 1, 4 },
                 energy[2] = { 9, 9 }, shear[2] = { 0.2, 0.2 }, bending[2] = { 0.4, 0.4 };
    const pg_bond_measures m = { .n = 2,
                                 .dim = 2,
                                 .xi = xi,
                                 .eta = eta,
                                 .reach = reach,
                                 .energy = energy,
                                 .shear = shear,
                                 .bending = bending };
    double u[2], f[2];
    for (int finite = 0; finite < 2; finite++)
        for (int derived = 0; derived < 2; derived++) {
            pg_criterion c = { .type = pg_criterion_find ("stretch"),
                               .parameter = { 1e-3, finite, 1, derived, 1 } };
            c.type->utilisation (&c, &m, u, NULL);
            c.type->factor (&c, &m, f);
            check_relative (u[0], 1, 1e-12);
            check_relative (u[1], derived ? 2 : 1, 1e-12);
            check_relative (f[1], derived ? 0.5 : 1, 1e-9);
        }
    pg_criterion point = { .type = pg_criterion_find ("node_energy"), .parameter = { 9 } },
                 beam = { .type = pg_criterion_find ("beam_limits"), .parameter = { 1, 0.2, 4 } };
    point.type->utilisation (&point, &m, u, NULL);
    check_relative (u[0], 1, 1e-12);
    check_relative (u[1], 2, 1e-12);
    for (beam.single = 0; beam.single < 2; beam.single++) {
        beam.type->utilisation (&beam, &m, u, NULL);
        beam.type->factor (&beam, &m, f);
        check_relative (u[0], beam.single ? 1 : sqrt (1e-6 + 1 + 0.01), 1e-12);
        check_relative (u[1], 2 * u[0], 1e-12);
        check_relative (f[1] * u[1], 1, 1e-12);
    }
}

static void stretch_along_the_bond_counts_and_turning_does_not (void **state)
{
    (void) state;
    pg_criterion c = make ("stretch", 1e-3, 0, 0);
    const double xi[6] = { 3, 4, 3, 4, 3, 4 }, eta[6] = { 0.003, 0.004, -0.4, 0.3, -0.003, -0.004 };
    const pg_bond_measures m = { .n = 3, .dim = 2, .xi = xi, .eta = eta };
    double u[3];
    char kind[3];
    c.type->utilisation (&c, &m, u, kind);
    check_relative (u[0], 1, 1e-13);
    check_absolute (u[1], 0, 1e-13);
    check_absolute (u[2], 0, 0);
    assert_int_equal (kind[0], 't');
}

static void finite_stretch_is_the_change_of_length (void **state)
{
    (void) state;
    pg_criterion c = make ("stretch", 0.02, 1, 0);
    for (int t = 0; t < 500; t++) {
        double xi[3], eta[3], before = 0, after = 0, u;
        for (int k = 0; k < 3; k++) {
            xi[k] = rnd (), eta[k] = rnd ();
            before += xi[k] * xi[k];
            after += (xi[k] + eta[k]) * (xi[k] + eta[k]);
        }
        double s = sqrt (after / before) - 1;
        const pg_bond_measures m = { .n = 1, .dim = 3, .xi = xi, .eta = eta };
        c.type->utilisation (&c, &m, &u, NULL);
        check_scaled (u, s > 0 ? s / 0.02 : 0, 1e-12, 1 / 0.02);
    }
}

static void finite_stretch_keeps_its_digits_for_tiny_strains (void **state)
{
    (void) state;
    pg_criterion c = make ("stretch", 1, 1, 0);
    const double xi[2] = { 3, 4 }, eta[2] = { 3e-12, 4e-12 };
    const pg_bond_measures m = { .n = 1, .dim = 2, .xi = xi, .eta = eta };
    double u;
    c.type->utilisation (&c, &m, &u, NULL);
    check_relative (u, 1e-12, 1e-14);
}

static void finite_stretch_factor_reaches_the_limit_exactly (void **state)
{
    (void) state;
    pg_criterion c = make ("stretch", 0.02, 1, 0);
    for (int t = 0; t < 2000; t++) {
        double xi[2], eta[2], f, length = 0, grown = 0, gap = 0;
        for (int k = 0; k < 2; k++) xi[k] = rnd (), eta[k] = 0.1 * rnd ();
        const pg_bond_measures m = { .n = 1, .dim = 2, .xi = xi, .eta = eta };
        c.type->factor (&c, &m, &f);
        for (int k = 0; k < 2; k++) {
            length += xi[k] * xi[k];
            grown += (xi[k] + f * eta[k]) * (xi[k] + f * eta[k]);
            gap += eta[k] * eta[k];
        }
        assert_true (f > 0);
        /* the root is known to the rounding of `grown`, whose terms are as large as (|xi| + f |eta|)^2 */
        double size = (sqrt (length) + f * sqrt (gap)) * (sqrt (length) + f * sqrt (gap)) / length;
        check_scaled (grown / length, 1.02 * 1.02, 1e-13 / 4, 4 * size);
    }
}

static void finite_and_linear_stretch_agree_for_small_strains (void **state)
{
    (void) state;
    pg_criterion a = make ("stretch", 1e-9, 0, 0), b = make ("stretch", 1e-9, 1, 0);
    const double xi[3] = { 1, 2, 2 }, eta[3] = { 1e-4, 2e-4, 2e-4 };
    const pg_bond_measures m = { .n = 1, .dim = 3, .xi = xi, .eta = eta };
    double f, g;
    a.type->factor (&a, &m, &f);
    b.type->factor (&b, &m, &g);
    check_relative (f, g, 2e-9);
}

/* The elongation that a utilisation is told to mean is the one of the bond. */
static void utilisation_grows_with_elongation_alone (void **state)
{
    (void) state;
    for (int finite = 0; finite < 2; finite++)
        for (int k = 0; k < 20; k++) {
            pg_criterion c = make ("stretch", 0.02, finite, 0);
            double xi[3] = { 1, -2, 2 }, eta[3], u, square = -1, rr = 0, re = 0, ee = 0;
            for (int i = 0; i < 3; i++) eta[i] = 0.3 * sin (7 * k + i) + 0.05 * xi[i];
            const pg_bond_measures m = { .n = 1, .dim = 3, .xi = xi, .eta = eta };
            c.type->utilisation (&c, &m, &u, NULL);
            if (!(u > 0)) continue;
            for (int i = 0; i < 3; i++) rr += xi[i] * xi[i], re += xi[i] * eta[i], ee += eta[i] * eta[i];
            double e = c.type->elongation (&c, u, &square);
            assert_true (square == finite);
            check_relative (e, (2 * re + finite * ee) / rr, 1e-12);
        }
}

static void without_motion_no_factor_breaks_the_bond (void **state)
{
    (void) state;
    const double xi[2] = { 1, 0 }, eta[2] = { 0, 0 }, zero = 0;
    const pg_bond_measures bond = { .n = 1, .dim = 2, .xi = xi, .eta = eta, .s1 = &zero, .s3 = &zero };
    pg_criterion all[4] = { make ("stretch", 1e-3, 0, 0), make ("stretch", 1e-3, 1, 0),
                            make ("principal_stress", 1e6, 0, 0), rock () };
    for (int k = 0; k < 4; k++) {
        double f, u;
        all[k].type->factor (&all[k], &bond, &f);
        all[k].type->utilisation (&all[k], &bond, &u, NULL);
        assert_true (isinf (f) && f > 0);
        check_absolute (u, 0, 0);
    }
}

static void factor_is_one_over_utilisation_where_the_measure_is_of_degree_one (void **state)
{
    (void) state;
    enum { N = 400 };
    double xi[2*N], eta[2*N], s1[N], s3[N], u[N], f[N];
    for (int i = 0; i < 2*N; i++) xi[i] = rnd (), eta[i] = 1e-3 * rnd ();
    for (int i = 0; i < N; i++) {
        double a = 1e6 * rnd (), b = 1e6 * rnd ();
        s1[i] = fmax (a, b), s3[i] = fmin (a, b);
    }
    const pg_bond_measures m = { .n = N, .dim = 2, .xi = xi, .eta = eta, .s1 = s1, .s3 = s3 };
    pg_criterion all[3] = { make ("stretch", 1e-3, 0, 0), make ("principal_stress", 5e5, 0, 0), rock () };
    for (int k = 0; k < 3; k++) {
        int finite = 0;
        all[k].type->utilisation (&all[k], &m, u, NULL);
        all[k].type->factor (&all[k], &m, f);
        for (int i = 0; i < N; i++) {
            if (u[i] > 0) check_relative (f[i] * u[i], 1, 1e-14), finite++;
            else assert_true (isinf (f[i]));
        }
        assert_true (finite > N / 4);
    }
}

static void principal_stress_breaks_at_the_tensile_strength (void **state)
{
    (void) state;
    pg_criterion c = make ("principal_stress", 2e6, 0, 0);
    check_relative (stress_use (&c, 3e6, -1e9, NULL), 1.5, 1e-15);
    check_absolute (stress_use (&c, -1e6, -1e9, NULL), 0, 0);
}

static void rock_has_the_printed_strengths (void **state)
{
    (void) state;
    pg_criterion c = rock (), uncut = c;
    char kind;
    uncut.parameter[0] = 1e9;
    check_relative (stress_use (&c, 0, -21.4450692e6, &kind), 1, 1e-8);
    assert_int_equal (kind, 's');
    check_relative (stress_use (&uncut, 4.6630766e6, 0, &kind), 1, 1e-8);
    check_relative (stress_use (&c, -2e6, -30.6428891e6, NULL), 1, 1e-8);
    check_relative (stress_use (&c, 0.5e6, -19.1456142e6, NULL), 1, 1e-8);
    check_relative (stress_use (&uncut, 0.5e6, -19.1456142e6, NULL), 1, 1e-8);
    check_relative (stress_use (&c, 0.5e6, 0, &kind), 1, 1e-14);
    assert_int_equal (kind, 't');
}

static void description_names_the_constants (void **state)
{
    (void) state;
    char text[256];
    pg_criterion c = rock (), s = make ("stretch", 1e-3, 1, 0), p = make ("principal_stress", 2e6, 0, 0);
    c.type->describe (&c, text, sizeof text);
    check_contains (text, "friction angle 40 deg");
    check_contains (text, "2.14451e+07");
    s.type->describe (&s, text, sizeof text);
    check_contains (text, "finite stretch >= 0.001 (given)");
    p.type->describe (&p, text, sizeof text);
    check_contains (text, "2e+06 Pa");
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (the_catalogue_lists_seven),
        cmocka_unit_test (the_cone_touches_the_pyramid), cmocka_unit_test (beams_break_by_energy),
        cmocka_unit_test (limits_follow_the_horizon_where_an_energy_gives_them),
        cmocka_unit_test (stretch_along_the_bond_counts_and_turning_does_not),
        cmocka_unit_test (finite_stretch_is_the_change_of_length),
        cmocka_unit_test (finite_stretch_keeps_its_digits_for_tiny_strains),
        cmocka_unit_test (finite_stretch_factor_reaches_the_limit_exactly),
        cmocka_unit_test (finite_and_linear_stretch_agree_for_small_strains),
        cmocka_unit_test (utilisation_grows_with_elongation_alone),
        cmocka_unit_test (without_motion_no_factor_breaks_the_bond),
        cmocka_unit_test (factor_is_one_over_utilisation_where_the_measure_is_of_degree_one),
        cmocka_unit_test (principal_stress_breaks_at_the_tensile_strength),
        cmocka_unit_test (rock_has_the_printed_strengths),
        cmocka_unit_test (description_names_the_constants),
    };
    return cmocka_run_group_tests_name ("mechanics/criterion/criterion", tests, NULL, NULL);
}
