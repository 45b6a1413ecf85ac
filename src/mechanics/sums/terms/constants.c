/* SPDX-License-Identifier: GPL-3.0-or-later
 * Constants of bond-based peridynamics: the energy of a uniform strain and of a straight cut, in closed form
 * (theory A1). */
#include "perigal/sums.h"
#include <math.h>

static const double pi = 3.14159265358979323846264338327950288;

/* Pair forces along bonds give Cauchy's relation lambda = mu, thus nu = 1/4 in 3D and in plane strain; in
 * plane stress it is nu = 1/3. */
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

/* c (N/m^6) from a stretch s that is the same in all directions. Bonds store W = 1/4 integral of c k(r) s^2 r
 * over the ball (each bond belongs to two points): A c s^2 m_1 / 2 in 1D, pi t c s^2 m_2 / 2 in 2D, pi c s^2
 * m_3 in 3D. Elasticity stores E s^2 / 2 in 1D; E s^2 / (1 - nu) = 3/2 E s^2 in plane stress; E s^2 / ((1 +
 * nu) (1 - 2 nu)) = 8/5 E s^2 in plane strain; 3 E s^2 in 3D, with nu by pg_bond_poisson. */
double pg_bond_modulus (pg_mode mode, const pg_kernel *kernel, double horizon, double E, double thickness)
{
    switch (mode) {
    case PG_LINE: return E / (thickness * moment (kernel, horizon, 1));
    case PG_PLANE_STRESS: return 3 * E / (pi * thickness * moment (kernel, horizon, 2));
    case PG_PLANE_STRAIN: return 16 * E / (5 * pi * thickness * moment (kernel, horizon, 2));
    default: return 3 * E / (pi * moment (kernel, horizon, 3));
    }
}

/* A bond of length r takes the energy c k(r) s0^2 r / 2 to break. Per unit of area, a plane cuts r dr bonds
 * of this length in 1D, 2 r * r dr in 2D (integral of the cosine over half a circle: 2), pi r * r^2 dr in 3D
 * (over half a sphere: pi). The product, integrated over r, gives the moments below. */
double pg_bond_fracture_energy (pg_mode mode, const pg_kernel *kernel, double horizon, double thickness,
                                double c, double s0)
{
    switch (mode) {
    case PG_LINE: return thickness * c * s0 * s0 * moment (kernel, horizon, 2) / 2;
    case PG_SOLID: return pi / 2 * c * s0 * s0 * moment (kernel, horizon, 4);
    default: return thickness * c * s0 * s0 * moment (kernel, horizon, 3);
    }
}
