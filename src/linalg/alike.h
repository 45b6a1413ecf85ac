/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: rows of a matrix that are alike. On a lattice most are: row first + k of a run has the numbers of
 * row `first`, for nodes that are k higher. Products take eight of them at a time, whose nodes lie side by
 * side in memory, and read the numbers of the first row only. */
#ifndef PG_LINALG_ALIKE_H
#define PG_LINALG_ALIKE_H
#include "perigal/linalg.h"

/* Finds the runs of alike rows, ascending, each of at least `least` rows; other rows are in no run. value:
 * `width` numbers for each coupling, which may differ between alike rows by rounding errors of floats. */
pg_status rows_alike (pg_row_runs *out, size_t least, size_t n, const size_t *start, const int *node,
                      const float *value, size_t width);
/* Returns the index of the first run that ends behind `row`; runs->n: none does. */
size_t    rows_alike_at (const pg_row_runs *runs, size_t row);
#endif
