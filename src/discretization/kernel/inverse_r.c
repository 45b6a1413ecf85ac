/* SPDX-License-Identifier: GPL-3.0-or-later
 * w = 1/q. A node closer than 1e-9 horizons is the point itself: its weight is 1e3 (that of q = 1e-3),
 * because with an infinite one its neighbours would count nothing. NOSB skips the own node and never uses
 * this value. */
#include "entries.h"

static const double itself = 1e-9, own_weight = 1e3;

static void value (size_t n, const double *q, double *w, double *dw)
{
    for (size_t i = 0; i < n; i++) w[i] = q[i] > itself ? 1 / q[i] : own_weight;
    for (size_t i = 0; dw && i < n; i++) dw[i] = q[i] > itself ? -1 / (q[i] * q[i]) : 0;
}

const pg_kernel pg_kernel_inverse_r = { "inverse_r", "1/q, the own node 1e3", 1, value };
