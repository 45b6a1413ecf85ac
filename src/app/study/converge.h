/* SPDX-License-Identifier: GPL-3.0-or-later
 * The numbers that one scene gives at decreasing spacings ("sizes"), and the orders of convergence that
 * follow from them. */
#ifndef PG_STUDY_CONVERGE_H
#define PG_STUDY_CONVERGE_H
#include "perigal/study.h"

enum { PG_CONVERGE_NAME = 128 };
/* One number that the runs give, such as a reaction, at each size. */
typedef struct {
    char   name[PG_CONVERGE_NAME], unit[32];
    /* 1: it is an error, whose limit is 0. */
    int    error;
    /* The number at each size; NAN where it is not known. */
    double value[PG_CONVERGE_SIZES];
} pg_quantity;
/* A study with one horizon. */
typedef struct {
    /* Horizon in spacings (with a fixed horizon: spacings of the first size). */
    double horizon;
    /* Number of sizes so far, and their spacings, m, decreasing. */
    size_t n;  double h[PG_CONVERGE_SIZES];
    size_t nquantity, cap;  pg_quantity *list;
} pg_study;
/* Returns the quantity of that name, created if there is none; NULL without memory. Pointers to other
 * quantities become invalid. */
pg_quantity *pg_study_quantity (pg_study *s, const char *name, const char *unit);
/* Order from the first n sizes of a study. */
pg_observed pg_study_order (const pg_study *s, const pg_quantity *q, size_t n);

/* Takes from the last row of DIR/history.csv, as size k: forces, displacements, gauges, averages, energies;
 * and of every force with several rows its largest magnitude. */
pg_status pg_converge_history (pg_study *s, size_t k, const char *folder);
/* Prints the table of a study, writes all studies as convergence.csv, draws them. *drawn: 0 if
 * there was nothing to draw. */
void      pg_converge_print   (const pg_study *s, int fixed, FILE *out);
pg_status pg_converge_table   (const pg_study *list, size_t n, const char *folder);
pg_status pg_converge_picture (const pg_study *list, size_t n, const char *folder, const char *title,
                               int *drawn);
#endif
