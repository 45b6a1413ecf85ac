/* SPDX-License-Identifier: GPL-3.0-or-later
 * w = 1 - 6 q^2 + 8 q^3 - 3 q^4 = (1 - q)^3 (1 + 3 q): theory E1. */
#include "entries.h"

static void value (size_t n, const double *q, double *w, double *dw)
{
    for (size_t i = 0; i < n; i++) {
        double p = q[i] < 1 ? 1 - q[i] : 0;
        w[i] = p * p * p * (1 + 3 * q[i]);
        if (dw) dw[i] = -12 * q[i] * p * p;
    }
}

const pg_kernel pg_kernel_quartic_spline = { "quartic_spline", "1 - 6 q^2 + 8 q^3 - 3 q^4", 0, value };
