/* SPDX-License-Identifier: GPL-3.0-or-later
 * Two columns of a run's history.csv as a chart. */
#include "plot.h"
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { CELL = 256, LIST = 4096 };

/* Reads one cell of a CSV row at *s (RFC 4180, cut to size) and steps over the comma; 0 at the end of the row. */
static int next_cell (const char **s, char *cell, size_t size)
{
    const char *p = *s;
    size_t n = 0;
    if (!p) return 0;
    int quoted = *p == '"';
    if (quoted) p++;
    for (; *p; p++) {
        if (quoted && *p == '"' && p[1] != '"') quoted = 0;
        else if (!quoted && strchr (",\r\n", *p)) break;
        else {
            if (quoted && *p == '"') p++;
            if (n + 1 < size) cell[n++] = *p;
        }
    }
    cell[n] = 0;
    *s = *p == ',' ? p + 1 : NULL;
    return 1;
}

/* Is `column`, as "name [unit]", the one wanted by name or in full? */
static int is_column (const char *column, const char *wanted)
{
    size_t n = strlen (wanted), name = strcspn (column, "[");
    while (name > 0 && column[name - 1] == ' ') name--;
    return strcmp (column, wanted) == 0 || (n == name && strncmp (column, wanted, n) == 0);
}

/* Column of the header and its label, "name (unit)". */
static pg_status find_column (const char *path, const char *header, const char *wanted, int *column, char *label)
{
    pg_status status = PG_OK;
    char cell[CELL], all[LIST] = "";
    const char *s = header;
    size_t used = 0;
    for (int k = 0; next_cell (&s, cell, sizeof cell); k++) {
        size_t name = strcspn (cell, "[");
        while (name > 0 && cell[name - 1] == ' ') name--;
        if (used + name + 2 < sizeof all) used += (size_t) snprintf (all + used, sizeof all - used, "%s%.*s", k ? "|" : "", (int) name, cell);
        if (!is_column (cell, wanted)) continue;
        snprintf (label, CELL, "%s", cell);
        char *open = strrchr (label, '['), *close = strrchr (label, ']');
        if (open && close > open + 1) *open = '(', *close = ')';
        else if (open) label[name] = 0;
        *column = k;
        goto done;
    }
    const char *near = pg_nearest_name (wanted, all);
    PG_FAIL (PG_E_USAGE, "%s has no column '%s'%s%s%s; it has %s", path, wanted, near ? " (did you mean '" : "", near ? near : "",
             near ? "'?)" : "", all);
done:
    return status;
}

/* Value of one column in a row, NaN when it is no number. */
static double cell_of (const char *row, int column)
{
    char cell[CELL] = "", *end;
    for (int k = 0; k <= column; k++) if (!next_cell (&row, cell, sizeof cell)) return NAN;
    double value = strtod (cell, &end);
    return end == cell ? NAN : value;
}

pg_status pg_plot_curve (const char *path, const char *directory, const char *x, const char *y)
{
    pg_status status = PG_OK;
    char table[LIST], label[2][CELL], *row = NULL;
    double *at[2] = { NULL, NULL };
    size_t room[2] = { 0, 0 }, width = 0, n = 0;
    int column[2];
    snprintf (table, sizeof table, "%s/history.csv", directory);
    FILE *file = fopen (table, "r");
    if (!file) PG_FAIL (PG_E_FILE, "%s: %s", table, strerror (errno));
    if (getline (&row, &width, file) < 0) PG_FAIL (PG_E_FILE, "%s is empty", table);
    PG_TRY (find_column (table, row, x, &column[0], label[0]));
    PG_TRY (find_column (table, row, y, &column[1], label[1]));
    for (; getline (&row, &width, file) > 0; n++)
        for (int c = 0; c < 2; c++) {
            PG_GROW (at[c], room[c], n + 1);
            at[c][n] = cell_of (row, column[c]);
        }
    if (n == 0) PG_FAIL (PG_E_FILE, "%s has no rows yet", table);
    pg_curve curve = { .name = y, .n = n, .x = at[0], .y = at[1], .points = n < 3 };
    PG_TRY (pg_picture_chart (path, 1, &curve, &(pg_chart_style) { .title = NULL, .xlabel = label[0], .ylabel = label[1] }));
done:
    for (int c = 0; c < 2; c++) pg_free (at[c]);
    free (row);                                        /* of getline */
    if (file) fclose (file);
    return status;
}
