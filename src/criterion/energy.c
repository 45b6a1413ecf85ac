/* SPDX-License-Identifier: GPL-3.0-or-later
 * Critical stretch s0 and fracture energy G0 of bond-based theory: s0^2 = a G0 m_n / (E m_{n+1}) with the kernel's moments
 * m_n = int_0^horizon k(r) r^n dr (theory A1). n and a: bar 1, 2; plane stress 2, pi/3; plane strain 2, 5 pi/16; solid 3, 2/3. */
#include "perigal/criterion.h"
#include "perigal/kernel.h"
#include <math.h>

/* s0^2 = ratio * G0 */
static double ratio (const pg_criterion_setting *s)
{
    static const double pi = 3.14159265358979323846;
    const double a[] = { [PG_LINE] = 2, [PG_PLANE_STRESS] = pi / 3, [PG_PLANE_STRAIN] = 5 * pi / 16, [PG_SOLID] = 2.0 / 3 };
    static const int order[] = { [PG_LINE] = 1, [PG_PLANE_STRESS] = 2, [PG_PLANE_STRAIN] = 2, [PG_SOLID] = 3 };
    const pg_kernel *kernel = pg_kernel_find (s->kernel);
    if (!kernel) return 0;
    int n = order[s->mode];
    double tough = s->toughness > 0 ? s->toughness : 1;        /* of a lattice (theory A2)                                */
    return a[s->mode] * pg_kernel_moment (kernel, n) / (pg_kernel_moment (kernel, n + 1) * s->horizon * s->modulus * tough);
}

double pg_stretch_from_energy (const pg_criterion_setting *setting, double G0)
{
    return sqrt (ratio (setting) * G0);
}

double pg_energy_from_stretch (const pg_criterion_setting *setting, double s0)
{
    double r = ratio (setting);
    return r > 0 ? s0 * s0 / r : 0;
}
