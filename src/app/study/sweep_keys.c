/* SPDX-License-Identifier: GPL-3.0-or-later
 * Values of --set KEY=... of a sweep: a key and its values, one after the other or as a range. */
#include "sweep.h"
#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The end of the value that begins at s: a comma or the end of the text, outside of brackets and quotes. */
static const char *end_of_value (const char *s)
{
    int depth = 0;
    char quote = 0;
    for (; *s; s++) {
        if (quote) quote = *s == quote ? 0 : quote;
        else if (*s == '"' || *s == '\'') quote = *s;
        else if (strchr ("[{(", *s)) depth++;
        else if (strchr ("]})", *s)) depth--;
        else if (*s == ',' && depth <= 0) break;
    }
    return s;
}

/* Appends a value without the blanks around it. */
static pg_status append (sweep_key *k, size_t *capacity, const char *from, const char *to)
{
    pg_status status = PG_OK;
    while (from < to && isspace ((unsigned char) *from)) from++;
    while (from < to && isspace ((unsigned char) to[-1])) to--;
    if (from == to) PG_FAIL (PG_E_USAGE, "--set %s: a value is missing before or behind a comma", k->key);
    if (to - from >= SWEEP_WORD)
        PG_FAIL (PG_E_USAGE, "--set %s: a value has more than %d letters", k->key, SWEEP_WORD - 1);
    if (k->n >= PG_SERIES_RUNS)
        PG_FAIL (PG_E_USAGE, "--set %s: more than %d values", k->key, PG_SERIES_RUNS);
    PG_GROW (k->word, *capacity, k->n + 1);
    snprintf (k->word[k->n++], SWEEP_WORD, "%.*s", (int) (to - from), from);
done:
    return status;
}

/* 1: the text begins like a number; "nan" and "infinity" do not count. */
static int starts_number (const char *s) { return *s && strchr ("+-.0123456789", *s) != NULL; }

/* Reads a range such as "1:20", "1:0.5:3 mm": from, step, to, and a unit. Returns the number of numbers
 * between the colons; 0: this is no range. */
static int read_range (const char *text, double number[3], const char **unit)
{
    int n = 0;
    for (char *end; n < 3; text = end + 1) {
        if (!starts_number (text)) return 0;
        number[n] = strtod (text, &end);
        if (end == text || !isfinite (number[n])) return 0;
        n++, *unit = end;
        if (*end != ':') break;
    }
    return n < 2 || strchr (*unit, ':') ? 0 : n;
}

/* Appends the values of a range, written with at most 12 digits so that 0.1 + 2 x 0.1 becomes 0.3; its end
 * counts if the steps reach it to 1e-9 of a step. */
static pg_status append_range (sweep_key *k, size_t *capacity, int numbers, const double number[3],
                               const char *unit)
{
    pg_status status = PG_OK;
    double step = numbers == 3 ? number[1] : 1, count = (number[numbers - 1] - number[0]) / step;
    char text[SWEEP_WORD];
    if (step == 0 || !(count > -1e-9))
        PG_FAIL (PG_E_USAGE, "--set %s: a range FROM:TO or FROM:STEP:TO must lead from its first to its last "
                             "number", k->key);
    if (count >= PG_SERIES_RUNS)
        PG_FAIL (PG_E_USAGE, "--set %s: more than %d values", k->key, PG_SERIES_RUNS);
    for (double i = 0; i <= floor (count + 1e-9); i++) {
        snprintf (text, sizeof text, "%.12g%.400s", number[0] + i * step, unit);
        PG_TRY (append (k, capacity, text, text + strlen (text)));
    }
done:
    return status;
}

/* ---- numbers ---------------------------------------------------------------------------------------- */
/* Splits a value into its number and its unit, skipping blanks between them; 0: it is no number. */
static int cut_number (const char *word, double *value, const char **unit)
{
    char *end;
    if (!starts_number (word)) return 0;
    *value = strtod (word, &end);
    while (*end == ' ') end++;
    *unit = end;
    for (const char *c = end; *c; c++)
        if (!isalnum ((unsigned char) *c) && !(*c & 0x80) && !strchr (" /^*.-", *c)) return 0;
    return end != word && isfinite (*value) && !isdigit ((unsigned char) *end);
}

/* Reads all values as numbers in the unit of the first one; if units differ, in SI. */
static pg_status read_numbers (sweep_key *k)
{
    pg_status status = PG_OK;
    static const char *const si[] = { "m", "Pa", "s", "N", "1", "J/m2", "kg/m3", "m/s", "rad", "K", "Hz" };
    const char *unit = "", *first = "";
    int same = 1, plain = 1;
    PG_ALLOC (k->number, k->n);
    for (size_t i = 0; i < k->n; i++) {
        if (!cut_number (k->word[i], &k->number[i], &unit)) return PG_OK;
        if (i == 0) first = unit;
        same &= strcmp (unit, first) == 0, plain &= !*unit;
    }
    k->numeric = same && strlen (first) < sizeof k->unit;
    if (k->numeric) snprintf (k->unit, sizeof k->unit, "%.60s", plain ? "" : first);
    for (size_t u = 0, i; !same && !k->numeric && u < sizeof si / sizeof *si; u++) {
        for (i = 0; i < k->n && pg_unit_parse (&k->number[i], k->word[i], si[u]) == PG_OK; i++) continue;
        k->numeric = i == k->n;
        if (k->numeric) snprintf (k->unit, sizeof k->unit, "%s", si[u]);
    }
done:
    return status;
}

pg_status pg_sweep_key_read (sweep_key *k, const char *set)
{
    pg_status status = PG_OK;
    const char *equals = strchr (set, '='), *unit, *s;
    size_t capacity = 0, length = equals ? (size_t) (equals - set) : 0;
    double number[3];
    *k = (sweep_key) { .n = 0 };
    if (length == 0 || length >= sizeof k->key)
        PG_FAIL (PG_E_USAGE, "--set %.200s: KEY=VALUE,VALUE,... is needed", set);
    snprintf (k->key, sizeof k->key, "%.*s", (int) length, set);
    int numbers = read_range (equals + 1, number, &unit);
    if (numbers && !strchr (unit, ',')) PG_TRY (append_range (k, &capacity, numbers, number, unit));
    else for (s = equals + 1;; s++) {
        const char *end = end_of_value (s);
        PG_TRY (append (k, &capacity, s, end));
        s = end;
        if (!*s) break;
    }
    for (size_t i = 0; i < k->n; i++)
        for (size_t j = 0; j < i; j++)
            if (strcmp (k->word[i], k->word[j]) == 0)
                PG_FAIL (PG_E_USAGE, "--set %s: the value %.100s is there twice", k->key, k->word[i]);
    PG_ALLOC (k->setting, k->n);
    for (size_t i = 0; i < k->n; i++)
        snprintf (k->setting[i], sizeof *k->setting, "%s=%s", k->key, k->word[i]);
    const char *dot = strrchr (k->key, '.');
    snprintf (k->label, sizeof k->label, "%s", dot && dot[1] ? dot + 1 : k->key);
    k->seeds = strcmp (k->label, "seed") == 0;
    PG_TRY (read_numbers (k));
done:
    if (status != PG_OK) pg_sweep_key_clear (k);
    return status;
}

void pg_sweep_key_clear (sweep_key *k)
{
    pg_free (k->word), pg_free (k->setting), pg_free (k->number);
    k->word = NULL, k->setting = NULL, k->number = NULL, k->n = 0;
}
