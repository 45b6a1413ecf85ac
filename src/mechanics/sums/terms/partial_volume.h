/* SPDX-License-Identifier: GPL-3.0-or-later
 * partial_volume.h: private: which share of a neighbour's cell lies inside the horizon. */
#ifndef PERIGAL_SUMS_PARTIAL_VOLUME_H
#define PERIGAL_SUMS_PARTIAL_VOLUME_H
#include "perigal/kernel.h"

/* Share, 0 to 1, of the lattice cell `n` sites from the origin (n >= 0 along each axis) that lies in the ball
 * around the origin; radius: in the unit of the steps. */
double pg_sums_overlap      (int dim, const int *n, const double *step, double radius);
/* Integral of k (|x| / radius) over the part of this cell in the ball, over the volume of the cell; for
 * kernels that vanish at the horizon. */
double pg_sums_overlap_mean (int dim, const int *n, const double *step, double radius,
                             const pg_kernel *kernel);
#endif
