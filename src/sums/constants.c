/* SPDX-License-Identifier: GPL-3.0-or-later
 * Constants of bond-based peridynamics: the energy of a uniform strain and of a straight cut, in closed form
 * (theory A1). */
#include "perigal/sums.h"
#include <math.h>

static const double pi = 3.14159265358979323846264338327950288;

double pg_bond_poisson (pg_mode mode)
{
    switch (mode) {
    case PG_LINE: return 0;
    case PG_PLANE_STRESS: return 1.0 / 3;
    default: return 0.25;
    }
}

/* m_n = int_0^horizon k(r) r^n dr */
static double moment (const pg_kernel *kernel, double horizon, int n)
{
    return pow (horizon, n + 1) * pg_kernel_moment (kernel, n);
}

double pg_bond_modulus (pg_mode mode, const pg_kernel *kernel, double horizon, double E, double thickness)
{
    switch (mode) {
    case PG_LINE: return E / (thickness * moment (kernel, horizon, 1));
    case PG_PLANE_STRESS: return 3 * E / (pi * thickness * moment (kernel, horizon, 2));
    case PG_PLANE_STRAIN: return 16 * E / (5 * pi * thickness * moment (kernel, horizon, 2));
    default: return 3 * E / (pi * moment (kernel, horizon, 3));
    }
}

double pg_bond_fracture_energy (pg_mode mode, const pg_kernel *kernel, double horizon, double thickness,
                                double c, double s0)
{
    switch (mode) {
    case PG_LINE: return thickness * c * s0 * s0 * moment (kernel, horizon, 2) / 2;
    case PG_SOLID: return pi / 2 * c * s0 * s0 * moment (kernel, horizon, 4);
    default: return thickness * c * s0 * s0 * moment (kernel, horizon, 3);
    }
}
