/* SPDX-License-Identifier: GPL-3.0-or-later
 * The last state of a run, and the largest forces on the way, from its history.csv. */
#include "converge.h"
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { COLUMNS = 512 };

quantity *study_quantity (study *s, const char *name, const char *unit)
{
    pg_status status = PG_OK;
    for (size_t k = 0; k < s->nquantity; k++) if (strcmp (s->list[k].name, name) == 0) return &s->list[k];
    PG_GROW (s->list, s->cap, s->nquantity + 1);
done:
    if (status != PG_OK) return NULL;
    quantity *q = &s->list[s->nquantity++];
    memset (q, 0, sizeof *q);
    snprintf (q->name, sizeof q->name, "%.127s", name);
    snprintf (q->unit, sizeof q->unit, "%.31s", unit);
    for (int k = 0; k < CONVERGE_SIZES; k++) q->value[k] = NAN;
    return q;
}

/* Cell at *s of a row (RFC 4180) and what follows it; 0 at the end of the row. */
static int cut_cell (char **s, char **cell)
{
    char *p = *s, *to = p;
    if (!p) return 0;
    int quoted = *p == '"';
    *cell = p;
    if (quoted) p++;
    for (; *p && (quoted || !strchr (",\r\n", *p)); p++) {
        if (quoted && *p == '"') {
            if (p[1] != '"') {
                quoted = 0;
                continue;
            }
            p++;
        }
        *to++ = *p;
    }
    *s = *p == ',' ? p + 1 : NULL;
    *to = 0;
    return 1;
}

/* Counts and flags say nothing about convergence. */
static int wanted (const char *name)
{
    static const char *const not_these[] = { "step",     "time",        "load_factor", "broken", "iterations",
                                             "residual", "utilisation", "event",       "level" };
    for (size_t k = 0; k < sizeof not_these / sizeof *not_these; k++)
        if (strcmp (name, not_these[k]) == 0) return 0;
    return 1;
}

static pg_status put (study *s, size_t k, const char *what, const char *column, double value)
{
    pg_status status = PG_OK;
    char name[CONVERGE_NAME], unit[32] = "";
    const char *open = strrchr (column, '[');
    size_t n = open ? (size_t) (open - column) : strlen (column);
    while (n > 0 && column[n - 1] == ' ') n--;
    if (open) snprintf (unit, sizeof unit, "%.*s", (int) strcspn (open + 1, "]"), open + 1);
    snprintf (name, sizeof name, "%s%.*s", what, (int) (n < 100 ? n : 100), column);
    if (!wanted (name)) goto done;
    quantity *q = study_quantity (s, name, unit);
    if (!q) PG_FAIL (PG_E_MEMORY, "no memory for %s", name);
    q->value[k] = value;
done:
    return status;
}

pg_status converge_history (study *s, size_t k, const char *folder)
{
    pg_status status = PG_OK;
    char path[4096], *header = NULL, *row = NULL, *cell, *at, *name[COLUMNS];
    size_t width[2] = { 0, 0 }, n = 0, rows = 0;
    double last[COLUMNS], peak[COLUMNS];
    snprintf (path, sizeof path, "%s/history.csv", folder);
    FILE *f = fopen (path, "r");
    if (!f) PG_FAIL (PG_E_FILE, "%s: %s", path, strerror (errno));
    if (getline (&header, &width[0], f) < 0) PG_FAIL (PG_E_FILE, "%s is empty", path);
    for (at = header; n < COLUMNS && cut_cell (&at, &cell); n++) name[n] = cell, last[n] = NAN, peak[n] = 0;
    for (; getline (&row, &width[1], f) > 0; rows++) {
        at = row;
        for (size_t c = 0; c < n && cut_cell (&at, &cell); c++)
            last[c] = *cell ? strtod (cell, NULL) : NAN, peak[c] = fmax (peak[c], fabs (last[c]));
    }
    for (size_t c = 0; rows && c < n; c++) {
        if (isnan (last[c])) continue;                 /* empty: not measured */
        PG_TRY (put (s, k, "", name[c], last[c]));
        if (rows > 1 && strstr (name[c], ".force_")) PG_TRY (put (s, k, "peak ", name[c], peak[c]));
    }
done:
    if (f) fclose (f);
    free (header), free (row);
    return status;
}
