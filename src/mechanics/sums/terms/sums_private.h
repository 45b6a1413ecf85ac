/* SPDX-License-Identifier: GPL-3.0-or-later
 * sums_private.h: functions that files of mechanics/sums share. */
#ifndef PERIGAL_SUMS_PRIVATE_H
#define PERIGAL_SUMS_PRIVATE_H
#include "perigal/sums.h"

/* Checks that the mode fits the dimension, and that the horizon is positive and finite. */
pg_status pg_sums_check_rule (const pg_sum_rule *rule, int dim);
/* Share of a neighbour's volume that counts at distance r (m), for partial volumes none, or linear over
 * `width` (m) around the horizon. */
double    pg_sums_partial    (pg_partial partial, double r, double horizon, double width);
/* Kernel at distance r (m); beyond the horizon its formula is continued (partial volumes), or 0 if it
 * vanishes there. */
double    pg_sums_kernel     (const pg_sum_rule *rule, double r, double horizon);
/* Integral of k r over the ball of the horizon, m^(dim + 1). */
double    pg_sums_whole      (const pg_sum_rule *rule, int dim);

/* A bond of an irregular cloud between points i and j at distance r (m); beta 0: there is none. Horizon and
 * spacing are the means of both ends; the weight has the factor (horizon of the rule / mean horizon)^(dim +
 * 1), so that one modulus serves all spacings. */
typedef struct { double r, beta, weight; } sums_bond;
sums_bond pg_sums_bond_between (const pg_sum_rule *rule, const pg_cloud *cloud, size_t i, size_t j);
/* Returns the point at an offset (x, y, z), in steps, from a site; -1: there is none. */
int       pg_sums_neighbour    (const pg_sites *sites, int site, const int *offset);
/* Median of the values of those points whose family has at least 0.8 of the largest family volume: points
 * inside the body. volume, value: of each point; ranks that share the points get the median over all ranks.
 * */
pg_status pg_sums_median (double *out, const pg_cloud *cloud, const double *volume, const double *value);
/* Returns the surface correction g_ij of a bond; 1: none. */
double    pg_sums_surface      (const pg_sums *sums, size_t i, size_t j);
/* Fills sums->family_volume of points on a lattice. */
pg_status pg_sums_family_volumes (pg_sums *sums);
#endif
