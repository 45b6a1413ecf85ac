/* SPDX-License-Identifier: GPL-3.0-or-later
 * w = 1 (the classical bond of peridynamics). */
#include "entries.h"

static void value (size_t n, const double *q, double *w, double *dw)
{
    (void) q;
    for (size_t i = 0; i < n; i++) w[i] = 1;
    for (size_t i = 0; dw && i < n; i++) dw[i] = 0;
}

const pg_kernel pg_kernel_constant = { "constant", "1: prototype microelastic brittle bonds", 1, value };
