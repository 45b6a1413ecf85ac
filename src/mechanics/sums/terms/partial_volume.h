/* SPDX-License-Identifier: GPL-3.0-or-later
 * partial_volume.h: private: how much of a neighbour's cell lies inside the horizon. */
#ifndef PERIGAL_SUMS_PARTIAL_VOLUME_H
#define PERIGAL_SUMS_PARTIAL_VOLUME_H
#include "perigal/kernel.h"

/* The cell of a lattice `n` sites from the origin (n >= 0 along each axis), and the ball of this radius, in
 * the unit of the steps. */
/* share of the cell inside, 0 to 1 */
double pg_sums_overlap      (int dim, const int *n, const double *step, double radius);
double pg_sums_overlap_mean (int dim, const int *n, const double *step, double radius,
                             const pg_kernel *kernel);
/* ^ integral of k (|x| / radius) over the cell's part in the ball, over the cell's volume; kernels that
 * vanish at the horizon */
#endif
