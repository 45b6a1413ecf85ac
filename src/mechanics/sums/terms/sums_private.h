/* SPDX-License-Identifier: GPL-3.0-or-later
 * sums_private.h: what the files of this folder share. */
#ifndef PERIGAL_SUMS_PRIVATE_H
#define PERIGAL_SUMS_PRIVATE_H
#include "perigal/sums.h"

/* Does the mode fit the dimension, is the horizon one? */
pg_status pg_sums_check_rule (const pg_sum_rule *rule, int dim);
/* Share of a neighbour's volume that counts: none or linear over `width` about the horizon. */
double    pg_sums_partial    (pg_partial partial, double r, double horizon, double width);
/* Kernel at a distance; beyond the horizon its formula goes on, 0 for one that vanishes there. */
double    pg_sums_kernel     (const pg_sum_rule *rule, double r, double horizon);
/* S_d m_d: integral of k r over the ball, m^(dim + 1) */
double    pg_sums_whole      (const pg_sum_rule *rule, int dim);

/* A bond of an irregular cloud between points i and j, r apart; beta 0: there is none. Horizon and spacing
 * are the means of both ends; the weight carries (horizon of the rule / mean horizon)^(dim + 1), so that one
 * modulus serves all spacings. */
typedef struct { double r, beta, weight; } sums_bond;
sums_bond pg_sums_bond_between (const pg_sum_rule *rule, const pg_cloud *cloud, size_t i, size_t j);
/* The point at an offset (x, y, z) from a site; -1: none. */
int       pg_sums_neighbour    (const pg_sites *sites, int site, const int *offset);
/* Median of the values of those points whose family's volume is nearly the largest (0.8 of it): points inside
 * the body. volume, value: of each point; ranks that share the points get the median of all. */
pg_status pg_sums_median (double *out, const pg_cloud *cloud, const double *volume, const double *value);
/* g_ij; 1: no correction */
double    pg_sums_surface      (const pg_sums *sums, size_t i, size_t j);
/* Fills sums->family_volume of points on a lattice. */
pg_status pg_sums_family_volumes (pg_sums *sums);
#endif
