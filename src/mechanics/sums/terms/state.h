/* SPDX-License-Identifier: GPL-3.0-or-later
 * state.h: constants that all loops of state-based theory need (private; theory B6). For a point, with w = k
 * beta / r and the bonds that count: q = sum w r^2 V, factor = A d / q^2, beta = B / q; all 0 if no bond
 * counts. */
#ifndef PERIGAL_SUMS_STATE_H
#define PERIGAL_SUMS_STATE_H
#include "bond_loop.h"

static inline double state_factor (const pg_bond_loop_setting *s, size_t i, double q)
{
    return q > 0 ? s->dilation[i] * s->sums->cloud->dim / (q * q) : 0;
}

static inline double state_beta (const pg_bond_loop_setting *s, size_t i, double q)
{
    return q > 0 ? s->deviation[i] / q : 0;
}

/* Returns why state-based sums cannot have this rule; NULL: they can. */
const char *pg_state_loop_refusal (const pg_bond_loop_setting *setting);
#endif
