/* SPDX-License-Identifier: GPL-3.0-or-later
 * Structs in checkpoints, by tables of their fields. A file has no structs, which would also carry the gaps
 * between their fields: each is taken apart into whole numbers and others, and put together again. */
#include "perigal/base.h"
#include <stdio.h>

enum { LONGEST_NAME = 128 };
/* What a walk over all fields does: copies them into arrays, checks arrays that were read, copies them
 * back. */
typedef enum { GIVE, CHECK, TAKE } deed;

pg_status pg_kept_within (const char *what, long value, long low, long high)
{
    if (value >= low && value <= high) return PG_OK;
    return pg_error (PG_E_FILE, PG_HERE, "the checkpoint is not of this run: %s is %ld, not from %ld to %ld",
                     what, value, low, high);
}

static size_t values_of (const pg_kept *row)
{
    static const size_t size[PG_KEPT_TYPES] = {
        [PG_KEPT_DOUBLE] = sizeof (double), [PG_KEPT_LONG] = sizeof (long), [PG_KEPT_INT] = sizeof (int),
        [PG_KEPT_UNSIGNED] = sizeof (unsigned), [PG_KEPT_SIZE] = sizeof (size_t), [PG_KEPT_CHAR] = 1,
        [PG_KEPT_BYTE] = 1
    };
    return row->bytes / size[row->type];
}

/* Value j of an array of a type, as a whole number. */
static long get (const void *array, pg_kept_type type, size_t j)
{
    switch (type) {
    case PG_KEPT_INT: return ((const int *) array)[j];
    case PG_KEPT_UNSIGNED: return (long) ((const unsigned *) array)[j];
    case PG_KEPT_SIZE: return (long) ((const size_t *) array)[j];
    case PG_KEPT_CHAR: return ((const char *) array)[j];
    case PG_KEPT_BYTE: return ((const unsigned char *) array)[j];
    default: return ((const long *) array)[j];
    }
}

static void set (void *array, pg_kept_type type, size_t j, long value)
{
    switch (type) {
    case PG_KEPT_INT: ((int *) array)[j] = (int) value; break;
    case PG_KEPT_UNSIGNED: ((unsigned *) array)[j] = (unsigned) value; break;
    case PG_KEPT_SIZE: ((size_t *) array)[j] = (size_t) value; break;
    case PG_KEPT_CHAR: ((char *) array)[j] = (char) value; break;
    case PG_KEPT_BYTE: ((unsigned char *) array)[j] = (unsigned char) value; break;
    default: ((long *) array)[j] = value;
    }
}

/* Copies the values of one field to (GIVE) or from (TAKE) the next entries of the two arrays, or checks
 * these; moves both pointers on. */
static pg_status visit (deed what, const pg_kept *row, void *at, long **count, double **number)
{
    pg_status status = PG_OK;
    size_t m = values_of (row);
    int real = row->type == PG_KEPT_DOUBLE;
    for (size_t j = 0; j < m && real && what == GIVE; j++) (*number)[j] = ((const double *) at)[j];
    for (size_t j = 0; j < m && real && what == TAKE; j++) ((double *) at)[j] = (*number)[j];
    for (size_t j = 0; j < m && !real; j++) {
        if (what == GIVE) (*count)[j] = get (at, row->type, j);
        if (what == CHECK) PG_TRY (pg_kept_within (row->what, (*count)[j], row->low, row->high));
        if (what == TAKE) set (at, row->type, j, (*count)[j]);
    }
    if (real) *number += m;
    else *count += m;
done:
    return status;
}

static pg_status visit_all (deed what, const pg_kept *rows, size_t n, long *count, double *number)
{
    pg_status status = PG_OK;
    for (size_t i = 0; i < n; i++)
        for (const pg_kept *row = rows; row->type; row++)
            PG_TRY (visit (what, row, i ? (char *) row->at + i * row->stride : row->at, &count, &number));
done:
    return status;
}

pg_status pg_keep_fields (const pg_keeper *k, const char *object, const char *counts, const char *numbers,
                          size_t n, const pg_kept *rows)
{
    pg_status status = PG_OK;
    char name[LONGEST_NAME];
    long *count = NULL;
    double *number = NULL;
    size_t whole = 0, real = 0;
    for (const pg_kept *row = rows; row->type; row++)
        *(row->type == PG_KEPT_DOUBLE ? &real : &whole) += n * values_of (row);
    PG_ALLOC (count, whole);
    PG_ALLOC (number, real);
    if (!k->reading) PG_TRY (visit_all (GIVE, rows, n, count, number));
    snprintf (name, sizeof name, "%s.%s", object, counts ? counts : "");
    if (counts) PG_TRY (k->counts (k->context, name, whole, count));
    if (numbers) PG_TRY (pg_keep_numbers (k, object, numbers, real, number));
    if (!k->reading) goto done;
    PG_TRY (visit_all (CHECK, rows, n, count, number));
    PG_TRY (visit_all (TAKE, rows, n, count, number));
done:
    pg_free (count), pg_free (number);
    return status;
}

pg_status pg_keep_numbers (const pg_keeper *k, const char *object, const char *name, size_t n, double *value)
{
    char whole[LONGEST_NAME];
    snprintf (whole, sizeof whole, "%s.%s", object, name);
    return k->numbers (k->context, whole, n, value);
}

pg_status pg_keep_bytes (const pg_keeper *k, const char *name, size_t n, unsigned char *byte, int most,
                         const char *what)
{
    pg_status status = PG_OK;
    PG_TRY (k->bytes (k->context, name, n, byte));
    for (size_t i = 0; k->reading && i < n; i++) PG_TRY (pg_kept_within (what, byte[i], 0, most));
done:
    return status;
}

pg_status pg_keep_text (const pg_keeper *k, const char *name, size_t size, char *text)
{
    pg_status status = k->bytes (k->context, name, size, text);
    if (k->reading) text[size - 1] = 0;
    return status;
}
