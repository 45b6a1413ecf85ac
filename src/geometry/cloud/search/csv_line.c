/* SPDX-License-Identifier: GPL-3.0-or-later
 * Lines of tables as spreadsheets and scripts write them: fields separated by semicolons, commas or blanks,
 * with or without quotes. Where semicolons separate numbers a comma is the decimal mark. */
#include "csv_line.h"
#include <string.h>

static int is_digit (char c) { return c >= '0' && c <= '9'; }

/* Replaces a decimal comma by a point, "1,5" by "1.5": digits on both sides of the only comma, and no
 * point. */
static void mend_mark (char *s)
{
    char *comma = strchr (s, ',');
    if (!comma || strchr (s, '.') || strchr (comma + 1, ',') || comma == s) return;
    if (is_digit (comma[-1]) && is_digit (comma[1])) *comma = '.';
}

size_t csv_split (char *line, char **field, size_t most)
{
    const char *between = strchr (line, ';') ? ";" : strchr (line, ',') ? "," : " \t";
    int blanks = *between == ' ';
    size_t n = 0;
    for (char *s = line; ; ) {
        /* Blanks around a field do not belong to it. */
        s += strspn (s, " \t");
        if (!*s && blanks) return n;
        char *end = s + strcspn (s, between), *tail = end;
        int last = !*end;
        while (tail > s && (tail[-1] == ' ' || tail[-1] == '\t')) tail--;
        *tail = '\0';
        /* Quotes as spreadsheets write them. */
        if (tail > s + 1 && *s == '"' && tail[-1] == '"') s++, tail[-1] = '\0';
        if (*between == ';') mend_mark (s);
        if (n < most) field[n] = s;
        n++;
        if (last) return n;
        s = end + 1;
    }
}
