/* SPDX-License-Identifier: GPL-3.0-or-later
 * converge.h: numbers of one scene at falling sizes. */
#ifndef PERIGAL_CLI_CONVERGE_H
#define PERIGAL_CLI_CONVERGE_H
#include "perigal.h"

enum { CONVERGE_SIZES = 12, CONVERGE_STUDIES = 12, CONVERGE_NAME = 128 };
typedef struct {
    char   name[CONVERGE_NAME], unit[32];
    int    error;                                      /* 1: its limit is 0 */
    double value[CONVERGE_SIZES];                      /* NAN: not known at that size */
} quantity;
typedef struct {                                       /* one horizon */
    double horizon;  /* in spacings (of the first size with fixed horizon) */
    size_t n;  double h[CONVERGE_SIZES];               /* m, falling */
    size_t nquantity, cap;  quantity *list;
} study;
/* The quantity of that name, made if need be; NULL without memory. */
quantity *study_quantity (study *s, const char *name, const char *unit);
/* Order from the first n sizes of a study. */
pg_observed study_order (const study *s, const quantity *q, size_t n);

/* converge_history.c: takes the last row of DIR/history.csv as size k: forces, displacements, gauges,
 * averages, energies; and the largest magnitude of every force over the rows, where there are several. */
pg_status converge_history (study *s, size_t k, const char *folder);
/* converge_table.c */
void      converge_print   (const study *s, int fixed);
pg_status converge_table   (const study *list, size_t n, const char *folder);
pg_status converge_picture (const study *list, size_t n, const char *folder, const char *title, int *drawn);
#endif
