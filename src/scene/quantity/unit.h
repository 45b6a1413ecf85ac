/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: units as a factor to SI and powers of the seven base units; numbers with units. */
#ifndef PG_SCENE_UNIT_H
#define PG_SCENE_UNIT_H
#include "perigal/scene.h"

/* Number of base units: m kg s A K mol cd. */
enum { PG_BASE_UNITS = 7 };

/* A unit of measurement. */
typedef struct {
    /* A value in this unit times the factor is the value in SI. */
    double factor;
    /* Powers of the base units. */
    double power[PG_BASE_UNITS];
    /* Power of rad, which is 1 in SI: distinguishes 40 deg from 5 %. */
    double angle;
} pg_measure;

/* Reads the unit in the first n characters of a text: "kg/m3", "GPa", "%". PG_E_SCENE: there is none
 * (message); PG_E_FILE: the database of units cannot be read. */
pg_status   pg_measure_read    (pg_measure *m, const char *text, size_t n);
/* Have the two units the same dimension? rad counts as 1. */
int         pg_measure_same    (const pg_measure *a, const pg_measure *b);
/* Is the measure dimensionless? */
int         pg_measure_plain   (const pg_measure *m);
/* Name of the dimension: "Pa", "m^2 kg", "1"; an example of a value: "10 GPa", NULL: none is known. */
void        pg_measure_text    (const pg_measure *m, char *out, size_t n);
const char *pg_measure_example (const pg_measure *m, const char *unit);
/* Converts a value in the unit m to SI; 3 mm is exactly 0.003 m. */
double      pg_measure_scale   (double value, const pg_measure *m);

/* Returns the end of the decimal number at the beginning of text, NULL: there is none; pg_number_read also
 * reads its value, in any locale. */
const char *pg_number_end  (const char *text);
const char *pg_number_read (const char *text, double *value);
/* Reads "10 GPa" for unit "Pa"; with unit "m|spacing" also "2 spacing" (*spacing = 1, *out = 2).
 * PG_E_SCENE: the message says what is wrong. */
pg_status   pg_quantity_read (double *out, int *spacing, const char *text, const char *unit);
/* Refuses sizes whose products would leave the range of a double: beyond 1e60, below 1e-60 (SI). */
pg_status   pg_quantity_sane (double value);
/* Describes the values that a key with this unit takes: "a number with a unit of Pa, for example 10 GPa". */
void        pg_quantity_describe (char *out, size_t n, const char *unit);
/* Does the value lie in a range such as "[0, inf)" (NULL: always)? *fault = 1: the text of the range is
 * wrong. */
int         pg_range_holds (const char *range, double value, int *fault);
#endif
