/* SPDX-License-Identifier: GPL-3.0-or-later
 * Speeds of waves: Rayleigh's against his cubic solved in closed form and values of the textbooks; the
 * modes. */
#include "check.h"
#include "perigal/material.h"

/* x^2 = (c / c_s)^2 solves z^3 - 8 z^2 + (24 - 16 q) z - 16 (1 - q) = 0, q = (c_s / c_p)^2: Newton on the
 * cubic. */
static double by_cubic (double q)
{
    double z = 0.9;
    for (int k = 0; k < 100; k++)
        z -= (((z - 8) * z + 24 - 16 * q) * z - 16 * (1 - q)) / ((3 * z - 16) * z + 24 - 16 * q);
    return sqrt (z);
}

static void rayleigh_solves_its_cubic (void **state)
{
    (void) state;
    for (double nu = -0.5; nu < 0.499; nu += 0.01) {
        double q = (1 - 2*nu) / (2 * (1 - nu));
        check_relative (pg_rayleigh_speed (3000 / sqrt (q), 3000), 3000 * by_cubic (q), 1e-12);
    }
    /* nu = 1/4: known in closed form */
    check_relative (pg_rayleigh_speed (sqrt (3), 1), sqrt (2 - 2 / sqrt (3)), 1e-14);
    check_relative (pg_rayleigh_speed (1e9, 1), 0.955312, 1e-6);  /* incompressible */
}

static void without_shear_there_is_none (void **state)
{
    (void) state;
    assert_true (pg_rayleigh_speed (5000, 0) == 0);
    assert_true (pg_rayleigh_speed (0, 0) == 0);
    assert_true (pg_rayleigh_speed (NAN, 1) == 0);
    assert_true (pg_rayleigh_speed (1, 1) == 0);
}

static pg_waves waves (pg_mode mode, double E, double nu, double density)
{
    pg_material m = {.mode = mode, .density = density, .modulus = E};
    pg_elastic_tangent (mode, E, nu, m.D);
    return pg_material_waves (&m);
}

static void every_mode_has_its_own (void **state)
{
    (void) state;
    double E = 72e9, nu = 1.0 / 3, rho = 2440;
    pg_waves thin = waves (PG_PLANE_STRESS, E, nu, rho), deep = waves (PG_PLANE_STRAIN, E, 0.25, rho),
             solid = waves (PG_SOLID, E, 0.25, rho), bar = waves (PG_LINE, E, 0, rho);
    check_relative (thin.pressure, sqrt (E / (1 - nu*nu) / rho), 1e-14);
    check_relative (thin.shear, sqrt (E / (2 * (1 + nu)) / rho), 1e-14);
    check_relative (deep.pressure, sqrt (1.2 * E / rho), 1e-14);
    check_relative (solid.pressure, deep.pressure, 1e-14);
    check_relative (solid.rayleigh, deep.rayleigh, 1e-14);
    check_relative (bar.pressure, sqrt (E / rho), 1e-14);
    assert_true (bar.shear == 0 && bar.rayleigh == 0);
    assert_true (waves (PG_SOLID, E, nu, 0).rayleigh == 0);
    assert_true (thin.rayleigh > 0.87 * thin.shear && thin.rayleigh < 0.96 * thin.shear);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (rayleigh_solves_its_cubic),
        cmocka_unit_test (without_shear_there_is_none),
        cmocka_unit_test (every_mode_has_its_own),
    };
    return cmocka_run_group_tests_name ("mechanics/material/waves", tests, NULL, NULL);
}
