/* SPDX-License-Identifier: GPL-3.0-or-later
 * Critical stretch s0 and fracture energy G0 of bond-based theory: s0^2 = a G0 m_n / (E m_{n+1}) with the kernel's moments
 * m_n = int_0^horizon k(r) r^n dr (theory A1). n and a: bar 1, 2; plane stress 2, pi/3; plane strain 2, 5 pi/16; solid 3, 2/3. */
#include "perigal/criterion.h"
#include "perigal/kernel.h"
#include <math.h>

enum { PANELS = 32, POINTS = 5 };

/* int_0^1 w(q) q^n dq by five Gauss points on each of 32 panels (a spline's knot at 1/2 lies between panels) */
static double moment (const pg_kernel *kernel, int n)
{
    static const double place[POINTS] = { -0.906179845938663992797627, -0.538469310105683091036314, 0,
                                          0.538469310105683091036314, 0.906179845938663992797627 };
    static const double weight[POINTS] = { 0.236926885056189087514264, 0.478628670499366468041292, 0.568888888888888888888889,
                                           0.478628670499366468041292, 0.236926885056189087514264 };
    double sum = 0;
    for (int k = 0; k < PANELS; k++) {
        double q[POINTS], w[POINTS];
        for (int g = 0; g < POINTS; g++) q[g] = (k + (1 + place[g]) / 2) / PANELS;
        kernel->value (POINTS, q, w, NULL);
        for (int g = 0; g < POINTS; g++) sum += weight[g] / (2 * PANELS) * w[g] * pow (q[g], n);
    }
    return sum;
}

/* s0^2 = ratio * G0 */
static double ratio (const pg_criterion_setting *s)
{
    static const double pi = 3.14159265358979323846;
    const double a[] = { [PG_LINE] = 2, [PG_PLANE_STRESS] = pi / 3, [PG_PLANE_STRAIN] = 5 * pi / 16, [PG_SOLID] = 2.0 / 3 };
    static const int order[] = { [PG_LINE] = 1, [PG_PLANE_STRESS] = 2, [PG_PLANE_STRAIN] = 2, [PG_SOLID] = 3 };
    const pg_kernel *kernel = pg_kernel_find (s->kernel);
    if (!kernel) return 0;
    int n = order[s->mode];
    return a[s->mode] * moment (kernel, n) / (moment (kernel, n + 1) * s->horizon * s->modulus);
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
