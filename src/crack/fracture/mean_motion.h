/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: a displacement field without the mean rigid motion of the nodes around a tip or front. */
#ifndef PG_MEAN_MOTION_H
#define PG_MEAN_MOTION_H
#include "perigal/model.h"

/* d: the field without the motion (ndof); the motion is shift + spin x (x - at); m, rad. In 2D spin[2]
 * only. */
typedef struct { double *d, at[3], shift[3], spin[3]; } mean_motion;

/* Removes the mean rigid motion from the unknowns d, determined by the nodes in the bounding box of n
 * positions x (n x dim, m), enlarged by `reach` (m). To be freed by mean_motion_clear. */
pg_status mean_motion_take  (mean_motion *out, const pg_problem *p, const pg_state *state, const double *d,
                             size_t n, const double *x, double reach);
void      mean_motion_clear (mean_motion *m);
/* Displacement of the mean rigid motion at x, m. */
void      mean_motion_at    (const mean_motion *m, const double *x, int dim, double *u);
#endif
