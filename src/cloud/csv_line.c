/* SPDX-License-Identifier: GPL-3.0-or-later
 * Lines of tables as spreadsheets and scripts write them: fields apart by commas or by blanks, with or
 * without quotes. */
#include "csv_line.h"
#include <string.h>

size_t csv_split (char *line, char **field, size_t most)
{
    int comma = strchr (line, ',') != NULL;
    size_t n = 0;
    for (char *s = line; ; ) {
        /* Blanks around a field do not belong to it. */
        s += strspn (s, " \t");
        if (!*s && !comma) return n;
        char *end = s + strcspn (s, comma ? "," : " \t"), *tail = end;
        int last = !*end;
        while (tail > s && (tail[-1] == ' ' || tail[-1] == '\t')) tail--;
        *tail = '\0';
        /* Quotes as spreadsheets write them. */
        if (tail > s + 1 && *s == '"' && tail[-1] == '"') s++, tail[-1] = '\0';
        if (n < most) field[n] = s;
        n++;
        if (last) return n;
        s = end + 1;
    }
}
