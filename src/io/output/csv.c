/* SPDX-License-Identifier: GPL-3.0-or-later
 * Reads CSV tables (RFC 4180): a header of names and rows of numbers. The text is cut in place:
 * quotes are taken off the cells, and each cell ends in a zero byte where its comma was. */
#include "perigal/output.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Cuts the cell at *at out of the text and moves *at behind it. Returns the character that ended it: ','
 * when another cell of the row follows, '\n' at the end of the row, 0 at the end of the text. */
static char cut_cell (char **at, char **cell)
{
    char *from = *at, *to = from;
    int quoted = *from == '"';
    *cell = to;
    if (quoted) from++;
    for (; *from && (quoted || !strchr (",\n", *from)); from++) {
        if (quoted && *from == '"' && from[1] != '"') {
            quoted = 0;
            continue;
        }
        if (quoted && *from == '"') from++;            /* two quotes stand for one */
        *to++ = *from;
    }
    char end = *from;
    if (to > *cell && to[-1] == '\r') to--;
    *at = end ? from + 1 : from;
    *to = 0;
    return end;
}

/* Reads the names of the columns from the first row of the text at *at. */
static pg_status read_header (pg_csv *csv, char **at)
{
    pg_status status = PG_OK;
    size_t cap = 0;
    char *cell, end = ',';
    while (end == ',') {
        end = cut_cell (at, &cell);
        PG_GROW (csv->name, cap, csv->ncolumn + 1);
        csv->name[csv->ncolumn++] = cell;
    }
done:
    return status;
}

/* Reads the rows below the header; empty lines are skipped. Missing cells and words become NAN,
 * and cells beyond the header are dropped, so that every row has ncolumn values. */
static pg_status read_rows (pg_csv *csv, char *at)
{
    pg_status status = PG_OK;
    size_t cap = 0;
    while (*at) {
        size_t column = 0;
        char *cell, *rest, end = ',';
        if (*at == '\n') {
            at++;
            continue;
        }
        PG_GROW (csv->value, cap, (csv->nrow + 1) * csv->ncolumn);
        double *row = csv->value + csv->nrow++ * csv->ncolumn;
        for (size_t k = 0; k < csv->ncolumn; k++) row[k] = NAN;
        for (; end == ','; column++) {
            end = cut_cell (&at, &cell);
            double value = strtod (cell, &rest);
            if (column < csv->ncolumn && rest != cell) row[column] = value;
        }
    }
done:
    return status;
}

/* The names point into the text, which therefore stays in memory. After a failure the table is
 * empty. */
pg_status pg_csv_read (pg_csv *csv, const char *path)
{
    pg_status status = PG_OK;
    memset (csv, 0, sizeof *csv);
    PG_TRY (pg_file_text (&csv->text, NULL, path));
    if (!csv->text[0]) PG_FAIL (PG_E_FILE, "%s is empty", path);
    char *at = csv->text;
    PG_TRY (read_header (csv, &at));
    PG_TRY (read_rows (csv, at));
done:
    if (status != PG_OK) pg_csv_clear (csv);
    return status;
}

/* May be called for a table that was never read. Names are parts of the text and go with it. */
void pg_csv_clear (pg_csv *csv)
{
    pg_free (csv->text), pg_free (csv->name), pg_free (csv->value);
    memset (csv, 0, sizeof *csv);
}

/* Length of a column's name: it ends before the bracket of the unit, blanks taken off. */
size_t pg_csv_name (const char *column)
{
    size_t n = strcspn (column, "[");
    while (n > 0 && column[n - 1] == ' ') n--;
    return n;
}

/* Number of a column, -1: there is none. Each is compared with the full header cell, then with the name
 * without its unit: "force" finds "force [N]", and of two that fit the first. */
long pg_csv_column (const pg_csv *csv, const char *wanted)
{
    size_t n = strlen (wanted);
    for (size_t k = 0; k < csv->ncolumn; k++) {
        const char *column = csv->name[k];
        if (strcmp (column, wanted) == 0) return (long) k;
        if (n == pg_csv_name (column) && strncmp (column, wanted, n) == 0) return (long) k;
    }
    return -1;
}
