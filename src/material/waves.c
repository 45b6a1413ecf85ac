/* SPDX-License-Identifier: GPL-3.0-or-later
 * Speeds of plane waves and of the surface wave (Rayleigh 1885). */
#include "perigal/material.h"
#include <math.h>

double pg_rayleigh_speed (double pressure, double shear)
{
    double low = 1e-3, high = 1, q = shear * shear / (pressure * pressure);
    if (!(shear > 0 && pressure > shear)) return 0;
    for (int k = 0; k < 200; k++) {  /* x = c / c_s; the equation falls from x = 0, rises to 1 at x = 1 */
        double x = 0.5 * (low + high), x2 = x * x,
               value = (2 - x2) * (2 - x2) - 4 * sqrt ((1 - x2) * (1 - q * x2));
        if (x == low || x == high) break;
        *(value < 0 ? &low : &high) = x;
    }
    return 0.5 * (low + high) * shear;
}

pg_waves pg_material_waves (const pg_material *m)
{
    pg_waves w = {0, 0, 0, 0, 0};
    if (m->mode != PG_LINE) w.lambda = m->D[1], w.mu = m->D[m->mode == PG_SOLID ? 21 : 8];
    if (m->density > 0) w.pressure = sqrt (m->D[0] / m->density), w.shear = sqrt (w.mu / m->density);
    w.rayleigh = pg_rayleigh_speed (w.pressure, w.shear);
    return w;
}
