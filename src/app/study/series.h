/* SPDX-License-Identifier: GPL-3.0-or-later
 * Functions that studies of many runs share: units of charts, and histograms. */
#ifndef PG_STUDY_SERIES_H
#define PG_STUDY_SERIES_H
#include "perigal/study.h"

/* Returns a factor for numbers in N, m, J or Pa whose largest magnitude is `size`, and writes the unit with
 * its prefix: 1e-3 and "kN"; other units stay. */
double pg_chart_unit (double size, const char *unit, char *out, size_t bytes);
/* Draws a histogram of s->n finite values in ascending order, whose spread is s, with their mean, in the
 * given unit. *drawn 0: nothing was drawn, as there are fewer than two values, or they are equal. */
pg_status pg_histogram_draw (int *drawn, const char *path, const pg_spread *s, const double *value,
                             const char *quantity, const char *unit, const char *title);
#endif
