/* SPDX-License-Identifier: GPL-3.0-or-later
 * Constants of bond-based peridynamics: the energy of a uniform strain and of a straight cut, in closed form
 * (theory A1). */
#include "perigal/sums.h"
#include <math.h>

static const double pi = 3.14159265358979323846264338327950288;

/* Bonds that pull along themselves alone make Cauchy's relation lambda = mu in three dimensions and in
 * plane strain, thus nu = 1/4; in a plane of bonds it is nu = 1/3. */
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

/* c from a stretch s that is the same in all directions. Bonds store W = 1/4 integral of c k(r) s^2 r
 * over the ball (each bond belongs to two points): A c s^2 m_1 / 2 on a line, pi t c s^2 m_2 / 2 in a
 * plane, pi c s^2 m_3 in space. Elasticity stores E s^2 / 2; E s^2 / (1 - nu) = 3/2 E s^2 in plane
 * stress; E s^2 / ((1 + nu) (1 - 2 nu)) = 8/5 E s^2 in plane strain; 3 E s^2 in a solid, with the nu of
 * above. */
double pg_bond_modulus (pg_mode mode, const pg_kernel *kernel, double horizon, double E, double thickness)
{
    switch (mode) {
    case PG_LINE: return E / (thickness * moment (kernel, horizon, 1));
    case PG_PLANE_STRESS: return 3 * E / (pi * thickness * moment (kernel, horizon, 2));
    case PG_PLANE_STRAIN: return 16 * E / (5 * pi * thickness * moment (kernel, horizon, 2));
    default: return 3 * E / (pi * moment (kernel, horizon, 3));
    }
}

/* A bond of length r takes c k(r) s0^2 r / 2 to break. A plane cuts, of the bonds of this length, those
 * whose end lies beyond it: r per unit of area on a line, 2 r * r dr in a plane (the cosine over half a
 * circle is 2), pi r * r^2 dr in space (over half a sphere pi). The product, integrated over r, is the
 * moment below. */
double pg_bond_fracture_energy (pg_mode mode, const pg_kernel *kernel, double horizon, double thickness,
                                double c, double s0)
{
    switch (mode) {
    case PG_LINE: return thickness * c * s0 * s0 * moment (kernel, horizon, 2) / 2;
    case PG_SOLID: return pi / 2 * c * s0 * s0 * moment (kernel, horizon, 4);
    default: return thickness * c * s0 * s0 * moment (kernel, horizon, 3);
    }
}
