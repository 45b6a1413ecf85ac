/* SPDX-License-Identifier: GPL-3.0-or-later
 * Load factor and events of a step of a result. Event stepping writes the number of its step as the time of
 * result.e; history.csv says how many events had happened by then and at which load factor. */
#include "plot.h"
#include <math.h>
#include <stdio.h>

/* Counts the rows with an event up to the row of that step, and returns its load factor in *factor. Returns 0
 * if there is no such row or no such table. */
int pg_plot_event (const char *folder, double step, long *events, double *factor)
{
    char path[PLOT_PATH];
    pg_csv csv = { 0 };
    int found = 0;
    snprintf (path, sizeof path, "%.2100s/history.csv", folder);
    *events = 0;
    if (pg_csv_read (&csv, path) != PG_OK) return 0;
    long number = pg_csv_column (&csv, "step"), load = pg_csv_column (&csv, "load_factor");
    long event = pg_csv_column (&csv, "event");
    for (size_t i = 0; number >= 0 && load >= 0 && event >= 0 && !found && i < csv.nrow; i++) {
        const double *row = csv.value + i * csv.ncolumn;
        *events += row[event] > 0;
        *factor = row[load];
        found = fabs (row[number] - step) < 0.5;
    }
    pg_csv_clear (&csv);
    return found;
}
