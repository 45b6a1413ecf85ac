/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: jumps of the displacement across cracks by one-sided shape functions (jump.c), for all forces. */
#ifndef PG_FORCE_JUMP_H
#define PG_FORCE_JUMP_H
#include "perigal/force.h"

/* As pg_force_type.jump, by the approximation `by` with a linear basis and that radius. */
pg_status jump_rows (const pg_problem *p, const pg_approx *by, const pg_state *state, size_t n,
                     const double *x, const double *normal, double radius, pg_jump_rows *out);
#endif
