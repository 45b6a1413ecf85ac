/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: what a displacement field is beside the rigid motion of the nodes around a tip or front. */
#ifndef PG_MEAN_MOTION_H
#define PG_MEAN_MOTION_H
#include "perigal/model.h"

/* The field without that motion (ndof), and the motion: shift + spin x (x - at); m, rad. In the plane the
 * spin is its third component. */
typedef struct { double *d, at[3], shift[3], spin[3]; } mean_motion;

/* Of the unknowns d, by the nodes in the box around n places x (n x dim) and `reach` beyond it, m;
 * mean_motion_clear. */
pg_status mean_motion_take  (mean_motion *out, const pg_problem *p, const pg_state *state, const double *d,
                             size_t n, const double *x, double reach);
void      mean_motion_clear (mean_motion *m);
/* Displacement of that motion at x, m. */
void      mean_motion_at    (const mean_motion *m, const double *x, int dim, double *u);
#endif
