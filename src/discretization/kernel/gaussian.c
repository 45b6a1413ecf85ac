/* SPDX-License-Identifier: GPL-3.0-or-later
 * w = (exp (-(q/c)^2) - exp (-1/c^2)) / (1 - exp (-1/c^2)), c = 0.4: shifted so that w(1) = 0, scaled so that
 * w(0) = 1. */
#include "entries.h"
#include <math.h>

static const double width = 0.4;

static void value (size_t n, const double *q, double *w, double *dw)
{
    double s = 1 / (width * width), rim = exp (-s), scale = 1 / (1 - rim);
    for (size_t i = 0; i < n; i++) {
        double e = q[i] < 1 ? exp (-s * q[i] * q[i]) : rim;
        w[i] = scale * (e - rim);
        if (dw) dw[i] = q[i] < 1 ? -2 * s * q[i] * scale * e : 0;
    }
}

const pg_kernel pg_kernel_gaussian = { "gaussian",
                                       "exp (-(q/0.4)^2), shifted to 0 at q = 1 and scaled to 1 at q = 0", 0,
                                       value };
