/* SPDX-License-Identifier: GPL-3.0-or-later
 * unit.h: units as a factor to SI and powers of the seven base units; numbers with units. */
#ifndef PG_SCENE_UNIT_H
#define PG_SCENE_UNIT_H
#include "perigal/scene.h"

enum { PG_BASE_UNITS = 7 };                            /* m kg s A K mol cd */
typedef struct {
    double factor;                                     /* value in this unit * factor = value in SI */
    double power[PG_BASE_UNITS];
    double angle;  /* power of rad: 1 in SI, kept to tell 40 deg from 5 % */
} pg_measure;

/* The first `n` characters of text, e.g. "kg/m3", "GPa", "%". PG_E_SCENE: no such unit (message); PG_E_FILE:
 * no database. */
pg_status   pg_measure_read    (pg_measure *m, const char *text, size_t n);
/* same dimension; rad counts as 1 */
int         pg_measure_same    (const pg_measure *a, const pg_measure *b);
int         pg_measure_plain   (const pg_measure *m);                         /* dimensionless */
void        pg_measure_text    (const pg_measure *m, char *out, size_t n);    /* "Pa", "m2 kg", "1" */
const char *pg_measure_example (const pg_measure *m, const char *unit);       /* "10 GPa"; NULL: none known */
double      pg_measure_scale   (double value, const pg_measure *m);  /* to SI; 3 mm is exactly 0.003 */

/* Decimal number at the start of text, in any locale. Returns its end, NULL when there is none. */
const char *pg_number_end  (const char *text);
const char *pg_number_read (const char *text, double *value);
/* "10 GPa" for unit "Pa"; with unit "m|spacing" also "2 spacing" (*spacing = 1, *out = 2). */
pg_status   pg_quantity_read (double *out, int *spacing, const char *text, const char *unit);
/* Refuses sizes whose products would leave the range of a double: beyond 1e60, below 1e-60 (SI). */
pg_status   pg_quantity_sane (double value);
/* What such a value looks like: "a number with a unit of Pa, for example 10 GPa". */
void        pg_quantity_describe (char *out, size_t n, const char *unit);
/* "[0, inf)": 1 when value lies in it (NULL: always). *fault is 1 when the text of the range itself is
 * wrong. */
int         pg_range_holds (const char *range, double value, int *fault);
#endif
