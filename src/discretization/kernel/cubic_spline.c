/* SPDX-License-Identifier: GPL-3.0-or-later
 * w = 2/3 - 4 q^2 + 4 q^3 for q <= 1/2, (4/3) (1 - q)^3 for q <= 1: Cui 2022 section 2.4. */
#include "entries.h"

static double weight (double q)
{
    double p = 1 - q;
    if (q <= 0.5) return 2.0 / 3 - 4 * q * q * p;
    return q < 1 ? 4.0 / 3 * p * p * p : 0;
}

static double slope (double q)
{
    double p = 1 - q;
    if (q <= 0.5) return q * (12 * q - 8);
    return q < 1 ? -4 * p * p : 0;
}

static void value (size_t n, const double *q, double *w, double *dw)
{
    for (size_t i = 0; i < n; i++) w[i] = weight (q[i]);
    for (size_t i = 0; dw && i < n; i++) dw[i] = slope (q[i]);
}

const pg_kernel pg_kernel_cubic_spline = {
    "cubic_spline", "2/3 - 4 q^2 + 4 q^3, then (4/3) (1 - q)^3 beyond 1/2: two continuous derivatives", 0,
    value
};
