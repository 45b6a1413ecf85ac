/* SPDX-License-Identifier: GPL-3.0-or-later
 * w = q. A point that coincides with a node gives that node no weight. */
#include "entries.h"

static void value (size_t n, const double *q, double *w, double *dw)
{
    for (size_t i = 0; i < n; i++) w[i] = q[i];
    for (size_t i = 0; dw && i < n; i++) dw[i] = 1;
}

const pg_kernel pg_kernel_linear_r = {
    "linear_r", "q: the unit micromodulus of Zhou 2025 eq (6), omega = 1, in terms of k = omega r", 1, value
};
