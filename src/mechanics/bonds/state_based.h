/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: ordinary state-based forces, the linear peridynamic solid: dilatation.h computes all of the
 * force. */
#ifndef PG_STATE_BASED_H
#define PG_STATE_BASED_H
#include "dilatation.h"

typedef struct { bond_force base; } state_based;
pg_status state_based_create (void **self, const pg_problem *problem);
#endif
