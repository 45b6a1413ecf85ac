/* SPDX-License-Identifier: GPL-3.0-or-later
 * An influence function that the catalogue does not hold: w = (1 + cos (pi q)) / 2, smooth at both ends. */
#include "entries.h"
#include <math.h>

static const double pi = 3.14159265358979323846;

static void value (size_t n, const double *q, double *w, double *dw)
{
    for (size_t i = 0; i < n; i++) w[i] = q[i] < 1 ? 0.5 * (1 + cos (pi * q[i])) : 0;
    for (size_t i = 0; dw && i < n; i++) dw[i] = q[i] < 1 ? -0.5 * pi * sin (pi * q[i]) : 0;
}

const pg_kernel pg_kernel_cosine = { "cosine", "(1 + cos (pi q)) / 2", 0, value };
