/* SPDX-License-Identifier: GPL-3.0-or-later
 * Numbers with units ("10 GPa" gives 1e10) and ranges ("[0, 0.5)").
 *
 * A number without a unit is in SI. A unit must have the dimension that the key wants; angles and plain
 * numbers, both dimensionless, are distinguished. Conversions divide where that is exact and multiplication
 * is not, so that "3 mm" is the double nearest to 0.003. */
#include "unit.h"
#include <locale.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Largest number of characters of a number. */
enum { LONGEST_NUMBER = 400 };

/* Return the text after digits, and after blanks. */
static const char *skip_digits (const char *s)
{
    while (*s >= '0' && *s <= '9') s++;
    return s;
}

static const char *skip_space (const char *s)
{
    while (*s == ' ' || *s == '\t' || *s == '\n' || *s == '\r') s++;
    return s;
}

/* A number is a sign, digits with at most one point, and an exponent if it is complete. */
const char *pg_number_end (const char *text)
{
    const char *s = text + (*text == '-' || *text == '+'), *digits = s;
    s = skip_digits (s);
    size_t n = (size_t) (s - digits);
    if (*s == '.') {
        const char *end = skip_digits (s + 1);
        n += (size_t) (end - s - 1);
        s = end;
    }
    if (n == 0) return NULL;
    if (*s == 'e' || *s == 'E') {
        const char *power = s + 1 + (s[1] == '-' || s[1] == '+'), *end = skip_digits (power);
        if (end > power) s = end;
    }
    return s - text < LONGEST_NUMBER ? s : NULL;
}

/* Reads a number. strtod follows the locale of the program: the text gets the decimal point of that
 * locale. */
const char *pg_number_read (const char *text, double *value)
{
    const char *end = pg_number_end (text);
    if (!end) return NULL;
    char copy[LONGEST_NUMBER + 16];
    const char *mark = localeconv ()->decimal_point;
    size_t n = 0, wide = strlen (mark);
    /* A locale without a sensible decimal point. */
    if (wide == 0 || wide > 8) mark = ".", wide = 1;
    for (const char *s = text; s < end; s++) {
        if (*s != '.') copy[n++] = *s;
        else {
            memcpy (copy + n, mark, wide);
            n += wide;
        }
    }
    copy[n] = '\0';
    *value = strtod (copy, NULL);
    return end;
}

/* ---- number with unit ---------------------------------------------------------------------------------- */
/* Length of the unit before the alternative "|spacing"; does the unit have that alternative? */
static size_t unit_length (const char *unit) { return strcspn (unit, "|"); }
static int takes_spacing (const char *unit) { return strstr (unit, "|spacing") != NULL; }

/* An example of a value in this unit. */
static const char *example_of (const char *unit)
{
    static _Thread_local char text[80];
    pg_measure m;
    size_t n = unit_length (unit);
    snprintf (text, sizeof text, "%.*s", (int) n, unit);
    const char *example = pg_measure_read (&m, unit, n) == PG_OK ? pg_measure_example (&m, text) : NULL;
    if (example) snprintf (text, sizeof text, "%s%s", example, takes_spacing (unit) ? " or 2 spacing" : "");
    else snprintf (text, sizeof text, "1 %.*s", (int) n, unit);
    return text;
}

/* Describes the unit in words. */
static const char *unit_words (const char *unit)
{
    static _Thread_local char text[80];
    if (strcmp (unit, "1") == 0) return "a plain number or %";
    snprintf (text, sizeof text, "%.*s%s", (int) unit_length (unit), unit,
              takes_spacing (unit) ? " or spacing" : "");
    return text;
}

void pg_quantity_describe (char *out, size_t n, const char *unit)
{
    if (!unit || strcmp (unit, "1") == 0) snprintf (out, n, "a number, for example 0.25");
    else
        snprintf (out, n, "a number with a unit of %s, for example %s", unit_words (unit), example_of (unit));
}

/* Converts a value with the unit `word` (n bytes) into `unit`. Angles and plain numbers are distinguished: 5
 * % is no angle. */
static pg_status convert (double *out, double value, const char *word, size_t n, const char *unit)
{
    pg_measure given, wanted;
    pg_status status = pg_measure_read (&given, word, n);
    if (status == PG_OK) status = pg_measure_read (&wanted, unit, unit_length (unit));
    if (status != PG_OK) return status;
    /* Of dimensionless units the power of rad must agree as well. */
    int fits = pg_measure_same (&given, &wanted)
               && (!pg_measure_plain (&wanted) || given.angle == wanted.angle);
    if (!fits)
        return pg_error (PG_E_SCENE, PG_HERE, "'%.*s' does not fit: expected %s, for example %s",
                         (int) n, word, unit_words (unit), example_of (unit));
    *out = pg_measure_scale (value, &given) / wanted.factor;
    return PG_OK;
}

pg_status pg_quantity_sane (double value)
{
    if (!(fabs (value) <= 1e60))
        return pg_error (PG_E_SCENE, PG_HERE, "is too large for a number: in SI units at most 1e60");
    if (value != 0 && fabs (value) < 1e-60)
        return pg_error (PG_E_SCENE, PG_HERE, "is too small for a number: in SI units 0, or at least 1e-60");
    return PG_OK;
}

/* Reads a number with unit. A comma is reported as such: it is the decimal mark of many languages. */
pg_status pg_quantity_read (double *out, int *spacing, const char *text, const char *unit)
{
    double value;
    char words[200];
    if (!unit) unit = "1";
    *spacing = 0;
    const char *word = pg_number_read (skip_space (text), &value);
    if (!word) {
        pg_quantity_describe (words, sizeof words, unit);
        return pg_error (PG_E_SCENE, PG_HERE, "must be %s", words);
    }
    word = skip_space (word);
    /* What follows the number, without trailing blanks, is the unit. */
    size_t n = strlen (word);
    while (n > 0 && strchr (" \t\n\r", word[n - 1])) n--;
    *out = value;
    if (n == 0) return pg_quantity_sane (value);
    if (*word == ',') return pg_error (PG_E_SCENE, PG_HERE, "is not a number: the decimal mark is a point");
    if (n == 7 && takes_spacing (unit) && memcmp (word, "spacing", n) == 0) {
        *spacing = 1;
        return pg_quantity_sane (value);
    }
    pg_status status = convert (out, value, word, n, unit);
    return status == PG_OK ? pg_quantity_sane (*out) : status;
}

/* Reads a number and its unit as pg_quantity_read does, but for `spacing`, which is no unit here. */
pg_status pg_unit_parse (double *out, const char *text, const char *unit)
{
    int spacing;
    double value;
    pg_status status = pg_quantity_read (&value, &spacing, text, unit);
    if (status == PG_OK && spacing) return pg_error (PG_E_SCENE, PG_HERE, "spacing is not a unit here");
    if (status == PG_OK) *out = value;
    return status;
}

/* ---- ranges -------------------------------------------------------------------------------------------- */
/* Reads a bound of a range: a number, "pi", "2 pi", "pi/2", "inf" or "-inf". NULL: none of these. */
static const char *read_bound (const char *s, double *value)
{
    s = skip_space (s);
    double sign = *s == '-' ? -1 : 1;
    if (*s == '-' || *s == '+') s++;
    if (strncmp (s, "inf", 3) == 0) {
        *value = sign * INFINITY;
        return s + 3;
    }
    const char *end = pg_number_read (s, value);
    /* "pi" alone is 1 times pi. */
    if (!end) *value = 1;
    const char *rest = skip_space (end ? end : s);
    if (strncmp (rest, "pi", 2) == 0) {
        double part = 1;
        end = rest + 2;
        *value *= 3.14159265358979323846;
        if (*end == '/') end = pg_number_read (end + 1, &part);
        if (end) *value /= part;
    }
    *value *= sign;
    return end;
}

/* Does the value lie in the range? A bracket includes its bound, a parenthesis does not. */
int pg_range_holds (const char *range, double value, int *fault)
{
    double low, high;
    *fault = 0;
    if (!range) return 1;
    /* Reads both bounds; nothing may follow. A wrong range in a key table is an error of the program, found
     * by tests. */
    const char *s = *range == '[' || *range == '(' ? read_bound (range + 1, &low) : NULL;
    if (s) s = *(s = skip_space (s)) == ',' ? read_bound (s + 1, &high) : NULL;
    if (s) s = skip_space (s);
    if (!s || (*s != ']' && *s != ')') || s[1] != '\0' || !(low <= high)) {
        *fault = 1;
        return 1;
    }
    int above = *range == '[' ? value >= low : value > low, below = *s == ']' ? value <= high : value < high;
    return above && below;
}
