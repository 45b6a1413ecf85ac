/* SPDX-License-Identifier: GPL-3.0-or-later
 * The loop over the bonds of a lattice: not here yet. */
#include "sweep.h"

static const char *refusal (const pg_sweep_setting *setting) { (void) setting; return "the loop over a lattice is not built in"; }

const pg_sweep_kind pg_sweep_stencil = { .name = "stencil", .refusal = refusal };
