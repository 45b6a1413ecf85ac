/* SPDX-License-Identifier: GPL-3.0-or-later
 * w = 1 - q, a cone. The derivative jumps at q = 0, where dw is the one-sided slope, -1. */
#include "entries.h"

static void value (size_t n, const double *q, double *w, double *dw)
{
    for (size_t i = 0; i < n; i++) w[i] = q[i] < 1 ? 1 - q[i] : 0;
    for (size_t i = 0; dw && i < n; i++) dw[i] = q[i] < 1 ? -1 : 0;
}

const pg_kernel pg_kernel_conical = { "conical", "1 - q", 0, value };
