/* SPDX-License-Identifier: GPL-3.0-or-later
 * Reads tables of places with values: a first row of names with units in brackets, then
 * numbers. Commas, semicolons and tabs separate columns; empty cells and nan are missing
 * values; columns with other names are skipped; # starts a comment. The tables that this
 * library writes (pg_table) have this form. */
#include "compare.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_COLUMNS = 64, PLACE = 16 };                /* PLACE + k: coordinate k */

/* Reads a text file. A zero byte would hide the rest of the text from the string functions, so it is
 * refused. */
pg_status pg_compare_load_text (const char *path, char **text)
{
    pg_status status = PG_OK;
    size_t size;
    PG_TRY (pg_file_text (text, &size, path));
    if (memchr (*text, 0, size)) PG_FAIL (PG_E_FILE, "%s is not a text file", path);
done:
    if (status != PG_OK) pg_free (*text), *text = NULL;
    return status;
}

/* Names of the columns of values; `longer` are the names of fields in result.e, which are accepted too. */
static const char *const names[9] = { "u_x", "u_y", "u_z", "s_xx", "s_yy", "s_zz", "s_xy", "s_yz", "s_zx" };
static const char *const longer[9] = { "displacement_x", "displacement_y", "displacement_z",
                                       "stress_xx",      "stress_yy",      "stress_zz",
                                       "stress_xy",      "stress_yz",      "stress_zx" };
const char *pg_column_name (int column) { return column >= 0 && column < 9 ? names[column] : ""; }
const char *pg_column_unit (int column) { return column < 3 ? "m" : "Pa"; }

/* A table that is being read. */
typedef struct {
    const char *path;
    pg_line *line;
    /* What each column holds: 0 to 8 a component, PLACE + k the coordinate k, -1 nothing of
     * interest. */
    int    meaning[MOST_COLUMNS];
    /* Factor from the unit of the column to SI, the factor of the table included for values. */
    double scale[MOST_COLUMNS];
    /* Columns of the header (0: not read yet); line of the file, from 1; capacities of the arrays. */
    size_t columns, at, cap_x, cap_value;
    double unit, factor;
    const double *along;
} reader;

/* Cuts a row at commas, semicolons or tabs and takes blanks and quotes off the cells, in
 * place. Returns the number of cells, which may exceed MOST_COLUMNS; only so many are filled
 * in. */
static size_t split (char *row, char *cell[MOST_COLUMNS])
{
    size_t n = 0;
    for (char *s = row;; n++) {
        char *end = s + strcspn (s, ",;\t"), *tail = end;
        int last = !*end;
        s += strspn (s, " \"");
        while (tail > s && strchr (" \"", tail[-1])) tail--;
        *tail = 0;
        if (n < MOST_COLUMNS) cell[n] = s < end ? s : tail;
        if (last) return n + 1;
        s = end + 1;
    }
}

/* What a column of this name holds in a body of that dimension; -1: nothing, the column is
 * skipped. In 2D the stress zz may stand in the table, although the norms do not use it. */
static int meaning_of (const char *name, int dim)
{
    static const int place_of[3] = { 'x', 'y', 'z' };
    for (int k = 0; k < dim; k++) if (name[0] == place_of[k] && !name[1]) return PLACE + k;
    for (int k = 0; k < 9; k++) {
        int beyond = k < 3 ? k >= dim : dim == 1 ? k > 3 : dim == 2 ? k > 6 : 0;
        if (!beyond && (strcmp (name, names[k]) == 0 || strcmp (name, longer[k]) == 0)) return k;
    }
    return -1;
}

/* Reads one cell of the header, such as "u_x [mm]": name and unit. Two columns with the same
 * meaning are a fault. */
static pg_status read_name (reader *r, size_t k, char *cell)
{
    pg_status status = PG_OK;
    const char *text;
    int closed = pg_column_cut (cell, &text) == PG_OK, what = r->meaning[k] = meaning_of (cell, r->line->dim);
    if (what >= 0 && !closed)
        PG_FAIL (PG_E_FILE, "%s:%zu: column %zu, %s: %s", r->path, r->at, k + 1, cell, pg_last_error ());
    r->scale[k] = what < 0 || (what >= 3 && what < PLACE) ? 1 : r->unit;
    if (what >= 0 && *text
        && pg_column_scale (&r->scale[k], text, what >= PLACE ? "m" : pg_column_unit (what)) != PG_OK)
        PG_FAIL (PG_E_FILE, "%s:%zu: column %s: %s", r->path, r->at, cell, pg_last_error ());
    for (size_t j = 0; j < k; j++)
        if (what >= 0 && r->meaning[j] == what)
            PG_FAIL (PG_E_FILE, "%s:%zu: there are two columns %s", r->path, r->at, cell);
    if (what >= 0 && what < PLACE) r->line->column[r->line->ncolumn++] = what, r->scale[k] *= r->factor;
done:
    return status;
}

/* Reads the first row and so fixes meaning and unit of each column; at least one coordinate
 * and one value are needed, else the file is no such table. */
static pg_status read_header (reader *r, char *row)
{
    pg_status status = PG_OK;
    char *cell[MOST_COLUMNS];
    int places = 0;
    r->columns = split (row, cell);
    if (r->columns > MOST_COLUMNS)
        PG_FAIL (PG_E_FILE, "%s:%zu: more than %d columns", r->path, r->at, MOST_COLUMNS);
    for (size_t k = 0; k < r->columns; k++) {
        PG_TRY (read_name (r, k, cell[k]));
        places += r->meaning[k] >= PLACE;
    }
    if (!places)
        PG_FAIL (
            PG_E_FILE,
            "%s:%zu: no column x%s: the first row names the columns, such as x [mm], u_x [mm], s_xx [MPa]",
            r->path, r->at,
            r->line->dim == 1   ? ""
            : r->line->dim == 2 ? ", y"
                                : ", y, z");
    if (!r->line->ncolumn)
        PG_FAIL (PG_E_FILE,
                 "%s:%zu: no column of values: u_x, u_y ..., s_xx, s_yy, s_xy ... with units in brackets",
                 r->path, r->at);
done:
    return status;
}

/* Reads a cell and converts it to SI; an empty one is NAN, and anything that is not a number
 * is a fault with its line and column. */
static pg_status read_number (const reader *r, const char *cell, size_t k, double *out)
{
    pg_status status = PG_OK;
    char *end;
    *out = NAN;
    if (!*cell) return PG_OK;
    *out = strtod (cell, &end);
    if (end == cell || *end)
        PG_FAIL (PG_E_FILE, "%s:%zu: '%.40s' in column %zu is not a number", r->path, r->at, cell, k + 1);
    *out = pg_column_value (*out, r->scale[k]);
done:
    return status;
}

/* Appends a row: coordinates that are no columns come from `along`. Places must be complete;
 * values may be missing. */
static pg_status read_row (reader *r, char *row)
{
    pg_status status = PG_OK;
    char *cell[MOST_COLUMNS];
    pg_line *l = r->line;
    size_t n = split (row, cell), dim = (size_t) l->dim, c = 0;
    if (n != r->columns)
        PG_FAIL (PG_E_FILE, "%s:%zu: %zu columns, the first row names %zu", r->path, r->at, n, r->columns);
    PG_GROW (l->x, r->cap_x, (l->n + 1) * dim);
    PG_GROW (l->value, r->cap_value, (l->n + 1) * l->ncolumn);
    for (size_t k = 0; k < dim; k++) l->x[l->n * dim + k] = r->along[k];
    for (size_t k = 0; k < n; k++) {
        double v;
        int what = r->meaning[k];
        if (what < 0) continue;
        PG_TRY (read_number (r, cell[k], k, &v));
        if (what >= PLACE && !isfinite (v))
            PG_FAIL (PG_E_FILE, "%s:%zu: the place has no %c", r->path, r->at, "xyz"[what - PLACE]);
        if (what >= PLACE) l->x[l->n * dim + (size_t) (what - PLACE)] = v;
        else l->value[l->n * l->ncolumn + c++] = v;
    }
    l->n++;
done:
    return status;
}

/* Reads a table. The first line that is neither empty nor a comment is the header. A byte order mark at the
 * beginning, which spreadsheets write, is skipped. */
pg_status pg_line_read (pg_line *out, const char *path, int dim, double unit, double factor,
                        const double *along)
{
    pg_status status = PG_OK;
    reader r = { .path = path, .line = out, .unit = unit, .factor = factor, .along = along };
    char *text = NULL;
    const char *slash = strrchr (path, '/');
    memset (out, 0, sizeof *out);
    out->dim = dim;
    snprintf (out->name, sizeof out->name, "%.127s", slash ? slash + 1 : path);
    PG_TRY (pg_compare_load_text (path, &text));
    for (char *row = strncmp (text, "\xEF\xBB\xBF", 3) ? text : text + 3; *row;) {
        size_t length = strcspn (row, "\n");
        char *next = row + length + (row[length] == '\n');
        row[length] = 0;
        row[strcspn (row, "#\r")] = 0;
        r.at++;
        if (row[strspn (row, " \t")]) PG_TRY (r.columns ? read_row (&r, row) : read_header (&r, row));
        row = next;
    }
    if (out->n == 0) PG_FAIL (PG_E_FILE, "%s has no rows", path);
done:
    pg_free (text);
    if (status != PG_OK) pg_line_clear (out);
    return status;
}

/* Samples a field at the rows of a table. Displacements of a table with a datum are relative to it (known up
 * to a rigid translation): the sampled value at the datum is subtracted. */
pg_status pg_line_sample (const pg_line *line, const pg_sampler *value, double *u, double *stress)
{
    pg_status status = PG_OK;
    double at[3], unused[6];
    PG_TRY (value->sample (value->context, line->n, line->x, u, stress));
    if (!line->relative) return PG_OK;
    PG_TRY (value->sample (value->context, 1, line->datum, at, unused));
    for (size_t i = 0; i < 3 * line->n; i++) u[i] -= at[i % 3];
done:
    return status;
}

/* Frees the arrays and zeroes the table; may be called again. */
void pg_line_clear (pg_line *line)
{
    pg_free (line->x), pg_free (line->value);
    memset (line, 0, sizeof *line);
}
