/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: displacements at positions on faces by one-sided shape functions (one_sided.c), for all forces. */
#ifndef PG_FORCE_ONE_SIDED_H
#define PG_FORCE_ONE_SIDED_H
#include "perigal/force.h"

/* Jump of the displacement across a crack, as pg_force_type.jump, by the approximation `by` with a linear
 * basis and that radius (spacings). flat: positions may lie on faces left by bonds that broke one by one;
 * there the plane of the position separates the two sides. */
pg_status jump_rows  (const pg_problem *p, const pg_approx *by, const pg_state *state, size_t n,
                      const double *x, const double *normal, double radius, int flat, pg_jump_rows *out);
/* Displacement on the surface, as pg_force_type.trace, by the approximation `by` as it is. */
pg_status trace_rows (const pg_problem *p, const pg_approx *by, const pg_state *state, size_t n,
                      const double *x, const double *normal, pg_jump_rows *out);
#endif
