/* SPDX-License-Identifier: GPL-3.0-or-later
 * Moments of influence functions by composite Gauss quadrature: five points on each of 32 panels. A
 * polynomial kernel times q^n is integrated exactly up to degree 9; the knot of the cubic spline at q = 1/2
 * lies between two panels. */
#include "perigal/kernel.h"
#include <math.h>

enum { PANELS = 32, POINTS = 5 };

/* int_0^1 w(q) q^n dq. */
double pg_kernel_moment (const pg_kernel *kernel, int n)
{
    static const double place[POINTS] = { -0.906179845938663992797627, -0.538469310105683091036314, 0,
                                          0.538469310105683091036314, 0.906179845938663992797627 };
    static const double weight[POINTS] = { 0.236926885056189087514264, 0.478628670499366468041292,
                                           0.568888888888888888888889, 0.478628670499366468041292,
                                           0.236926885056189087514264 };
    double sum = 0;
    for (int k = 0; k < PANELS; k++) {
        double q[POINTS], w[POINTS];
        for (int g = 0; g < POINTS; g++) q[g] = (k + (1 + place[g]) / 2) / PANELS;
        kernel->value (POINTS, q, w, NULL);
        for (int g = 0; g < POINTS; g++) sum += weight[g] / (2 * PANELS) * w[g] * pow (q[g], n);
    }
    return sum;
}
