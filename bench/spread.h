/* SPDX-License-Identifier: GPL-3.0-or-later
 * spread.h: least, median and largest of repeated measurements, for the CSV rows of the programs in
 * bench/. A program that repeats a measurement prints three columns X_min, X_median, X_max; bench/run
 * reads them and writes doc/benchmarks.md. */
#ifndef PERIGAL_BENCH_SPREAD_H
#define PERIGAL_BENCH_SPREAD_H
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

enum { SPREAD_ROOM = 4096 };
/* Values in the order they were taken; those beyond SPREAD_ROOM are dropped. */
typedef struct { size_t n; double value[SPREAD_ROOM]; } spread;

static inline void spread_add (spread *s, double value)
{
    if (s->n < SPREAD_ROOM) s->value[s->n++] = value;
}

static inline int spread_compare (const void *a, const void *b)
{
    double x = *(const double *) a, y = *(const double *) b;
    return (x > y) - (x < y);
}

/* Sorts the values; k = 0: the least, 1: the median, 2: the largest. NAN: none was added. */
static inline double spread_quantile (spread *s, size_t k)
{
    if (s->n == 0) return NAN;
    qsort (s->value, s->n, sizeof *s->value, spread_compare);
    /* twice the place in order; between two places their mean */
    size_t twice = k * (s->n - 1);
    return 0.5 * (s->value[twice / 2] + s->value[(twice + 1) / 2]);
}

/* Prints "min,median,max," of factor times the values. */
static inline void spread_print (spread *s, double factor)
{
    for (size_t k = 0; k < 3; k++) printf ("%.6g,", factor * spread_quantile (s, k));
}

/* Prints "min,median,max," of rates: an amount over each of the times that the values are. */
static inline void spread_print_rate (spread *s, double amount)
{
    for (size_t k = 3; k-- > 0; ) printf ("%.6g,", amount / spread_quantile (s, k));
}

/* Processor seconds of all threads of this process */
static inline double spread_processor (void)
{
    struct timespec t;
    clock_gettime (CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double) t.tv_sec + 1e-9 * (double) t.tv_nsec;
}
#endif
