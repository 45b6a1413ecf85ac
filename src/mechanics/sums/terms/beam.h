/* SPDX-License-Identifier: GPL-3.0-or-later
 * beam.h: one micropolar bond (private): forces and moments of its ends, in unknowns u and q = length theta.
 * From the other end all terms have the opposite sign or the same, bit by bit. */
#ifndef PERIGAL_SUMS_BEAM_H
#define PERIGAL_SUMS_BEAM_H
#include "perigal/sums.h"

/* Unknowns of a point: dim displacements, and one or three rotations times the length, so that all are in
 * m. */
static inline int beam_unknowns (int dim) { return dim == 2 ? 3 : 6; }

/* Computes w = eta - lever (q_i + q_j) x xi and diff = q_j - q_i, m; lever: 1 / (2 length), 1/m. */
static inline void beam_motion (int dim, double lever, const double *xi, const double *di, const double *dj,
                                double *w, double *diff)
{
    double sum[3];
    int turns = dim == 2 ? 1 : 3;
    for (int k = 0; k < turns; k++)
        sum[k] = lever * (di[dim + k] + dj[dim + k]), diff[k] = dj[dim + k] - di[dim + k];
    if (dim == 2) {
        w[0] = (dj[0] - di[0]) + sum[0] * xi[1];
        w[1] = (dj[1] - di[1]) - sum[0] * xi[0];
        return;
    }
    w[0] = (dj[0] - di[0]) - (sum[1] * xi[2] - sum[2] * xi[1]);
    w[1] = (dj[1] - di[1]) - (sum[2] * xi[0] - sum[0] * xi[2]);
    w[2] = (dj[2] - di[2]) - (sum[0] * xi[1] - sum[1] * xi[0]);
}

/* Returns a . b of n components, summed from first to last as in the loops. */
static inline double beam_dot (int n, const double *a, const double *b)
{
    double sum = a[0] * b[0];
    for (int k = 1; k < n; k++) sum += a[k] * b[k];
    return sum;
}

/* Adds force and moment (over the length) on i to f, N; inverse: 1 / (xi . xi), 1/m^2. */
static inline void beam_pull (int dim, double lever, const double *xi, double inverse, const pg_beam *b,
                              const double *w, const double *diff, double *f)
{
    double along = (b->along - b->shear) * (beam_dot (dim, xi, w) * inverse), g[3];
    for (int k = 0; k < dim; k++) g[k] = b->shear * w[k] + along * xi[k], f[k] += g[k];
    if (dim == 2) {
        f[2] += lever * (xi[0] * g[1] - xi[1] * g[0]) + b->bending * diff[0];
        return;
    }
    double twist = beam_dot (3, xi, diff) * inverse;
    f[3] += lever * (xi[1] * g[2] - xi[2] * g[1]) + b->bending * (diff[0] - twist * xi[0]);
    f[4] += lever * (xi[2] * g[0] - xi[0] * g[2]) + b->bending * (diff[1] - twist * xi[1]);
    f[5] += lever * (xi[0] * g[1] - xi[1] * g[0]) + b->bending * (diff[2] - twist * xi[2]);
}

/* Measures of a bond for criteria: stretch s, gamma^2 with gamma = |w_perp| / r, and kappa^2 from the
 * relative rotation across the bond. per_length: 1 / length, 1/m; or 1: kappa is multiplied by the length,
 * m. */
static inline void beam_measures (int dim, double per_length, const double *xi, double inverse,
                                  const double *w, const double *diff, double *s, double *shear2,
                                  double *bending2)
{
    double along = beam_dot (dim, xi, w) * inverse, across = 0, turn = 0,
           twist = dim == 3 ? beam_dot (3, xi, diff) * inverse : 0;
    for (int k = 0; k < dim; k++) across += (w[k] - along * xi[k]) * (w[k] - along * xi[k]);
    if (dim == 2) turn = diff[0] * diff[0];
    else for (int k = 0; k < 3; k++) turn += (diff[k] - twist * xi[k]) * (diff[k] - twist * xi[k]);
    *s = along, *shear2 = across * inverse, *bending2 = turn * (per_length * per_length);
}

/* Twice the energy of the bond, J */
static inline double beam_energy (int dim, const double *xi, double rr, const pg_beam *b, const double *w,
                                  const double *diff)
{
    double s, shear2, turn2;
    beam_measures (dim, 1, xi, 1 / rr, w, diff, &s, &shear2, &turn2);
    return (b->along * (s * s) + b->shear * shear2) * rr + b->bending * turn2;
}
#endif
