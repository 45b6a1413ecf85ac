/* SPDX-License-Identifier: GPL-3.0-or-later
 * When a step of a result was: event stepping writes the number of its step, and history.csv says which event
 * and load factor that is. */
#include "plot.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int column_of (const char *header, const char *name)
{
    int k = 0;
    for (const char *s = header; *s; s += strcspn (s, ","), s += *s == ',', k++)
        if (strncmp (s, name, strlen (name)) == 0 && strchr (" [,\r\n", s[strlen (name)])) return k;
    return -1;
}

static double cell_of (const char *row, int column)
{
    for (; column > 0 && *row; column--) row += strcspn (row, ","), row += *row == ',';
    return strtod (row, NULL);
}

int pg_plot_event (const char *folder, double step, long *events, double *factor)
{
    char path[PLOT_PATH], *row = NULL;
    size_t width = 0;
    int column[3] = { -1, -1, -1 }, found = 0;
    snprintf (path, sizeof path, "%.2100s/history.csv", folder);
    FILE *file = fopen (path, "r");
    if (!file) return 0;
    *events = 0;
    if (getline (&row, &width, file) > 0)
        for (int k = 0; k < 3; k++)
            column[k] = column_of (row, (const char *const[]){ "step", "load_factor", "event" }[k]);
    while (column[0] >= 0 && column[1] >= 0 && column[2] >= 0 && !found && getline (&row, &width, file) > 0) {
        *events += cell_of (row, column[2]) > 0;
        *factor = cell_of (row, column[1]);
        found = fabs (cell_of (row, column[0]) - step) < 0.5;
    }
    free (row);                                        /* of getline */
    fclose (file);
    return found;
}
