/* SPDX-License-Identifier: GPL-3.0-or-later
 * converge.h: numbers of one scene at falling sizes. */
#ifndef PG_STUDY_CONVERGE_H
#define PG_STUDY_CONVERGE_H
#include "perigal/study.h"

enum { PG_CONVERGE_NAME = 128 };
typedef struct {
    char   name[PG_CONVERGE_NAME], unit[32];
    int    error;                                      /* 1: its limit is 0 */
    double value[PG_CONVERGE_SIZES];                      /* NAN: not known at that size */
} pg_quantity;
typedef struct {                                       /* one horizon */
    double horizon;  /* in spacings (of the first size with fixed horizon) */
    size_t n;  double h[PG_CONVERGE_SIZES];               /* m, falling */
    size_t nquantity, cap;  pg_quantity *list;
} pg_study;
/* The quantity of that name, made if need be; NULL without memory. */
pg_quantity *pg_study_quantity (pg_study *s, const char *name, const char *unit);
/* Order from the first n sizes of a study. */
pg_observed pg_study_order (const pg_study *s, const pg_quantity *q, size_t n);

/* converge_history.c: takes the last row of DIR/history.csv as size k: forces, displacements, gauges,
 * averages, energies; and the largest magnitude of every force over the rows, where there are several. */
pg_status pg_converge_history (pg_study *s, size_t k, const char *folder);
/* converge_table.c */
void      pg_converge_print   (const pg_study *s, int fixed, FILE *out);
pg_status pg_converge_table   (const pg_study *list, size_t n, const char *folder);
pg_status pg_converge_picture (const pg_study *list, size_t n, const char *folder, const char *title,
                               int *drawn);
#endif
