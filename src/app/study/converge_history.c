/* SPDX-License-Identifier: GPL-3.0-or-later
 * The last state of a run, and its largest forces, from history.csv. */
#include "converge.h"
#include <math.h>
#include <string.h>

/* Finds or creates a quantity; a new one is unknown (NAN) at all sizes. */
pg_quantity *pg_study_quantity (pg_study *s, const char *name, const char *unit)
{
    pg_status status = PG_OK;
    for (size_t k = 0; k < s->nquantity; k++) if (strcmp (s->list[k].name, name) == 0) return &s->list[k];
    PG_GROW (s->list, s->cap, s->nquantity + 1);
done:
    if (status != PG_OK) return NULL;
    pg_quantity *q = &s->list[s->nquantity++];
    memset (q, 0, sizeof *q);
    snprintf (q->name, sizeof q->name, "%.127s", name);
    snprintf (q->unit, sizeof q->unit, "%.31s", unit);
    for (int k = 0; k < PG_CONVERGE_SIZES; k++) q->value[k] = NAN;
    return q;
}

/* 0 for columns with counts and flags, which say nothing about convergence. */
static int wanted (const char *name)
{
    static const char *const not_these[] = { "step",     "time",        "load_factor", "broken", "iterations",
                                             "residual", "utilisation", "event",       "level" };
    for (size_t k = 0; k < sizeof not_these / sizeof *not_these; k++)
        if (strcmp (name, not_these[k]) == 0) return 0;
    return 1;
}

/* Takes a value at size k, under `what` and the name of its column without the unit. */
static pg_status put (pg_study *s, size_t k, const char *what, const char *column, double value)
{
    pg_status status = PG_OK;
    char name[PG_CONVERGE_NAME], unit[32] = "";
    const char *open = strrchr (column, '[');
    size_t n = open ? (size_t) (open - column) : strlen (column);
    while (n > 0 && column[n - 1] == ' ') n--;
    if (open) snprintf (unit, sizeof unit, "%.*s", (int) strcspn (open + 1, "]"), open + 1);
    snprintf (name, sizeof name, "%s%.*s", what, (int) (n < 100 ? n : 100), column);
    if (!wanted (name)) goto done;
    pg_quantity *q = pg_study_quantity (s, name, unit);
    if (!q) PG_FAIL (PG_E_MEMORY, "no memory for %s", name);
    q->value[k] = value;
done:
    return status;
}

/* Takes the last row, and the largest magnitude of each force if there are several rows. Empty
 * cells were not measured and are skipped. */
pg_status pg_converge_history (pg_study *s, size_t k, const char *folder)
{
    pg_status status = PG_OK;
    char path[4096];
    pg_csv csv = { 0 };
    snprintf (path, sizeof path, "%s/history.csv", folder);
    PG_TRY (pg_csv_read (&csv, path));
    for (size_t c = 0; csv.nrow && c < csv.ncolumn; c++) {
        double last = csv.value[(csv.nrow - 1) * csv.ncolumn + c], peak = 0;
        if (isnan (last)) continue;                    /* empty: not measured */
        PG_TRY (put (s, k, "", csv.name[c], last));
        if (csv.nrow < 2 || !strstr (csv.name[c], ".force_")) continue;
        for (size_t r = 0; r < csv.nrow; r++) peak = fmax (peak, fabs (csv.value[r * csv.ncolumn + c]));
        PG_TRY (put (s, k, "peak ", csv.name[c], peak));
    }
done:
    pg_csv_clear (&csv);
    return status;
}
