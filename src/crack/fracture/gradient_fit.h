/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: the displacement gradient at any position for forces without shape functions (bond, lps, gmpd
 * ...), which have displacements at points only. */
#ifndef PG_GRADIENT_FIT_H
#define PG_GRADIENT_FIT_H
#include "perigal/force.h"

typedef struct gradient_fit gradient_fit;
/* Borrows the problem and the state, whose current cracks and intact bonds determine which points are
 * visible. PG_E_MEMORY. */
pg_status gradient_fit_create (gradient_fit **out, const pg_problem *problem, const pg_state *state);
void      gradient_fit_free   (gradient_fit **fit);
/* Displacement (m) and its gradient at x (dim, m) of each of n <= 2 fields of unknowns d (ndof: dim and
 * rotations per point): u[3 f + c], 0 beyond dim, or u NULL: not wanted; gradient[9 f + c dim + k] =
 * du_c/dx_k. Returns the degree of polynomials that the fit reproduces there: 2, 1, or 0 where the intact
 * bonds of the nearest visible point do not span all directions: the gradient is NAN then. */
int       gradient_fit_at (const gradient_fit *fit, const double *x, size_t n, const double *const *d,
                           double *u, double *gradient);
/* pg_force_type.sample for all forces: by the shape functions of those that have them, else by the fit, with
 * the stress from the gradient and the elastic law. stress, gradient NULL: not wanted. */
pg_status gradient_sample (const pg_problem *p, const pg_force_type *force, void *self,
                           const pg_state *state, const double *d, size_t n, const double *x, double *u,
                           double *stress, double *gradient);
#endif
