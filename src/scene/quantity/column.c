/* SPDX-License-Identifier: GPL-3.0-or-later
 * Headers of columns of tables, "u_x [mm]": splits name and unit, and converts values from that unit. */
#include "unit.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

/* Ends the text at `end`, without the blanks before it. */
static void cut_blanks (char *end, const char *start)
{
    while (end > start && (end[-1] == ' ' || end[-1] == '\t')) end--;
    *end = 0;
}

/* Splits a header into name and unit, which may be in square brackets or in parentheses. */
pg_status pg_column_cut (char *header, const char **unit)
{
    char *open = header + strcspn (header, "[("), *shut;
    *unit = "";
    if (!*open) {
        cut_blanks (open, header);
        return PG_OK;
    }
    shut = strrchr (open, *open == '[' ? ']' : ')');
    cut_blanks (open, header);
    if (!shut) return pg_error (PG_E_SCENE, PG_HERE, "the bracket of its unit does not close");
    if (shut[1 + strspn (shut + 1, " \t")])
        return pg_error (PG_E_SCENE, PG_HERE, "something follows the bracket of its unit");
    open += 1 + strspn (open + 1, " \t");
    cut_blanks (shut, open);
    *unit = open;
    return PG_OK;
}

/* Finds the factor of a unit by reading "1 mm" as a quantity, which also checks the dimension. */
pg_status pg_column_scale (double *scale, const char *unit, const char *kind)
{
    char one[96];
    *scale = 1;
    if (!*unit) return PG_OK;
    if (strlen (unit) > 80) return pg_error (PG_E_SCENE, PG_HERE, "unknown unit '%.40s...'", unit);
    snprintf (one, sizeof one, "1 %s", unit);
    return pg_unit_parse (scale, one, kind);
}

/* Converts by pg_measure_scale, which divides by 1000 where a product with 0.001 would be rounded. */
double pg_column_value (double value, double scale)
{
    const pg_measure m = { .factor = scale };
    return pg_measure_scale (value, &m);
}
