/* SPDX-License-Identifier: GPL-3.0-or-later
 * Constants of bond-based peridynamics against quadrature of the energy of a strain and of a cut, and against
 * printed numbers. */
#include "check.h"
#include "perigal/sums.h"

enum { PANELS = 400 };
static const pg_mode modes[] = {PG_LINE, PG_PLANE_STRESS, PG_PLANE_STRAIN, PG_SOLID};
static const double gauss[3] = { -0.77459666924148338, 0, 0.77459666924148338 },
                    weight[3] = { 5.0 / 9, 8.0 / 9, 5.0 / 9 };
static const double delta = 3e-3, E = 70e9, pi = 3.14159265358979323846;

static int dim_of (pg_mode mode) { return mode == PG_LINE ? 1 : mode == PG_SOLID ? 3 : 2; }

static double kernel_at (const pg_kernel *kernel, double r)
{
    double q = r / delta, w;
    kernel->value (1, &q, &w, NULL);
    return w;
}

/* Mean over directions of (e_x^2 exx + e_y^2 eyy + e_x e_y gxy)^2, by points on the circle or Gauss points in
 * z */
static double mean_stretch2 (int dim, const double *strain)
{
    double sum = 0;
    if (dim == 1) return strain[0] * strain[0];
    for (int k = 0; k < PANELS; k++)
        for (int g = 0; g < 3; g++) {
            double z = dim == 3 ? (k + (1 + gauss[g]) / 2) / PANELS : 0,
                   part = dim == 3 ? weight[g] / 2 / PANELS : 1.0 / 3 / PANELS;
            for (int a = 0; a < 16; a++) {
                double t = 2 * pi * (a + 0.5 * k / PANELS) / 16, x = sqrt (1 - z * z) * cos (t),
                       y = sqrt (1 - z * z) * sin (t);
                double s = strain[0] * x*x + strain[1] * y*y + strain[2] * x*y;
                sum += part / 16 * s * s;
            }
        }
    return sum;
}

/* W = 1/2 int 1/2 c k r s^2 dV of a ball (theory section 0) */
static double energy (pg_mode mode, const pg_kernel *kernel, double c, double thickness, const double *strain)
{
    int dim = dim_of (mode);
    double radial = 0, sphere = dim == 1 ? 2 : dim == 2 ? 2 * pi : 4 * pi;
    for (int k = 0; k < PANELS; k++)
        for (int g = 0; g < 3; g++) {
            double r = delta * (k + (1 + gauss[g]) / 2) / PANELS;
            radial += weight[g] / 2 * delta / PANELS * 0.25 * c * kernel_at (kernel, r) * r
                      * pow (r, dim - 1);
        }
    return radial * sphere * thickness * mean_stretch2 (dim, strain);
}

/* for all kernels, all modes, three strains; uniaxial .5 .5625 .6 .6 of E */
static void energies_of_uniform_strains_are_those_of_elasticity (void **state)
{
    (void) state;
    static const double uniaxial[] = { 0.5, 0.5625, 0.6, 0.6 },
                        strain[3][3] = { { 1, 0, 0 }, { 1, 1, 0 }, { 0.3, -0.2, 0.7 } };
    const pg_kernel *kernel;
    for (size_t k = 0; (kernel = pg_kernel_entry (k)); k++)
        for (int m = 0; m < 4; m++) {
            double t = modes[m] == PG_SOLID ? 1 : 0.02, c = pg_bond_modulus (modes[m], kernel, delta, E, t),
                   D[36];
            int nv = pg_voigt_size (dim_of (modes[m])), shear = dim_of (modes[m]) == 3 ? 3 : 2;
            pg_elastic_tangent (modes[m], E, pg_bond_poisson (modes[m]), D);
            check_relative (energy (modes[m], kernel, c, t, strain[0]) / E, uniaxial[m], 1e-9);
            for (int s = 0; m > 0 && s < 3; s++) {
                const double *e = strain[s];
                double W = 0.5
                           * (D[0] * e[0] * e[0] + 2 * D[1] * e[0] * e[1] + D[nv + 1] * e[1] * e[1]
                              + D[shear * nv + shear] * e[2] * e[2]);
                check_relative (energy (modes[m], kernel, c, t, e), W, 1e-9);
            }
        }
}

/* Energy of all bonds from a depth z below a cut to the far side, over all depths (theory A1: 1D, 2D, 3D) */
static double cut (int dim, const pg_kernel *kernel, double c, double thickness, double s0)
{
    double sum = 0;
    for (int k = 0; k < PANELS; k++)
        for (int g = 0; g < 3; g++) {
            double r = delta * (k + (1 + gauss[g]) / 2) / PANELS,
                   w0 = 0.5 * c * kernel_at (kernel, r) * r * s0 * s0, depths = 0;
            for (int a = 0; a < 64; a++)
                for (int h = 0; h < 3; h++) {
                    double t = pi / 2 * (a + (1 + gauss[h]) / 2) / 64, z = r * cos (t),
                           dz = weight[h] / 2 * pi / 2 / 64 * r * sin (t);
                    depths += dz
                              * (dim == 1   ? 1
                                 : dim == 2 ? 2 * acos (z / r) * r
                                            : 2 * pi * r * r * (1 - z / r));
                }
            sum += weight[g] / 2 * delta / PANELS * w0 * depths;
        }
    return sum * thickness;
}

/* */
static void fracture_energy_is_that_of_the_bonds_across_a_plane (void **state)
{
    (void) state;
    const pg_kernel *kernel;
    for (size_t k = 0; (kernel = pg_kernel_entry (k)); k++)
        for (int m = 0; m < 4; m++) {
            double t = modes[m] == PG_SOLID ? 1 : 0.02,
                   G = pg_bond_fracture_energy (modes[m], kernel, delta, t, 2e25, 1e-3);
            check_relative (G, cut (dim_of (modes[m]), kernel, 2e25, t, 1e-3), 1e-9);
        }
}

/* s0 = sqrt (a G0 / (E delta)) with the a of theory A1 */
static void critical_stretches_are_the_printed_ones (void **state)
{
    (void) state;
    static const char *name[] = {"constant", "quadratic", "conical", "linear_r", "inverse_r"};
    const double a[5][4] = { { 3, 4 * pi / 9, 5 * pi / 12, 5.0 / 6 },
                             { 15.0 / 4, 8 * pi / 15, pi / 2, 35.0 / 36 },
                             { 4, 5 * pi / 9, 25 * pi / 48, 1 },
                             { 8.0 / 3, 5 * pi / 12, 25 * pi / 64, 4.0 / 5 },
                             { 4, pi / 2, 15 * pi / 32, 8.0 / 9 } };
    for (int k = 0; k < 5; k++)
        for (int m = 0; m < 4; m++) {
            const pg_kernel *kernel = pg_kernel_find (name[k]);
            double t = modes[m] == PG_SOLID ? 1 : 0.02, G0 = 135,
                   c = pg_bond_modulus (modes[m], kernel, delta, E, t);
            check_relative (pg_bond_fracture_energy (modes[m], kernel, delta, t, c,
                                                     sqrt (a[k][m] * G0 / (E * delta))),
                            G0, 1e-12);
        }
}

static void moduli_are_the_printed_ones (void **state)
{
    (void) state;
    const pg_kernel *one = pg_kernel_find ("constant"), *quadratic = pg_kernel_find ("quadratic");
    check_relative (pg_bond_modulus (PG_LINE, one, delta, E, 1e-4), 2 * E / (1e-4 * pow (delta, 2)), 1e-13);
    check_relative (pg_bond_modulus (PG_PLANE_STRESS, one, delta, E, 0.01),
                    9 * E / (pi * 0.01 * pow (delta, 3)), 1e-13);
    check_relative (pg_bond_modulus (PG_PLANE_STRAIN, one, delta, E, 0.01),
                    48 * E / (5 * pi * 0.01 * pow (delta, 3)), 1e-13);
    check_relative (pg_bond_modulus (PG_SOLID, one, delta, E, 1), 12 * E / (pi * pow (delta, 4)), 1e-13);
    check_relative (pg_bond_modulus (PG_PLANE_STRESS, quadratic, delta, E, 0.01),
                    45 * E / (2 * pi * 0.01 * pow (delta, 3)), 1e-13);
    check_relative (pg_bond_modulus (PG_SOLID, quadratic, delta, E, 1), 36 * E / (pi * pow (delta, 4)),
                    1e-13);
    /* k = r / delta here, k = r in the table: c is delta times the table's */
    check_relative (pg_bond_modulus (PG_SOLID, pg_kernel_find ("linear_r"), delta, E, 1),
                    15 * E / (pi * pow (delta, 4)), 1e-13);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (energies_of_uniform_strains_are_those_of_elasticity),
        cmocka_unit_test (fracture_energy_is_that_of_the_bonds_across_a_plane),
        cmocka_unit_test (critical_stretches_are_the_printed_ones),
        cmocka_unit_test (moduli_are_the_printed_ones),
    };
    return cmocka_run_group_tests_name ("constants of bonds", tests, NULL, NULL);
}
