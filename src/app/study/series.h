/* SPDX-License-Identifier: GPL-3.0-or-later
 * series.h: what the studies of many runs share: numbers of reports, and histograms. */
#ifndef PG_STUDY_SERIES_H
#define PG_STUDY_SERIES_H
#include "perigal/study.h"

/* A factor for numbers of N, m, J or Pa of that size (largest magnitude), and the unit with its prefix:
 * 1e-3 and "kN"; other units stay. */
double pg_chart_unit (double size, const char *unit, char *out, size_t bytes);
/* A histogram of the finite ones of n values in rising order, whose spread is s, with their mean; unit:
 * theirs. Nothing is drawn of fewer than two values, or of equal ones: *drawn = 0. */
pg_status pg_histogram_draw (int *drawn, const char *path, const pg_spread *s, const double *value,
                             const char *quantity, const char *unit, const char *title);
#endif
