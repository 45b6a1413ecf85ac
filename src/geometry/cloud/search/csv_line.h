/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: the fields of a line of a table of points or cracks. */
#ifndef PG_CLOUD_CSV_LINE_H
#define PG_CLOUD_CSV_LINE_H
#include <stddef.h>

/* Divides a line into fields in place; if there is a semicolon anywhere, only semicolons separate, else if
 * there is a comma, only commas. Returns how many fields there are, even those beyond the first `most`, which
 * are not stored. */
size_t csv_split (char *line, char **field, size_t most);
#endif
