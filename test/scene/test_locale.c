/* SPDX-License-Identifier: GPL-3.0-or-later
 * Numbers of scenes have decimal points, also in a program whose locale has commas: its localeconv and strtod
 * are those of this file, as there is no such locale on every machine. */
#include "check.h"
#include "scene/quantity/unit.h"
#include <locale.h>
#include <stdlib.h>

static int commas;

struct lconv *localeconv (void)
{
    static char point[] = ".", comma[] = ",", none[] = "";
    static struct lconv c;
    c.decimal_point = commas ? comma : point, c.thousands_sep = none, c.grouping = none;
    return &c;
}

/* Up to what is no part of a number in that locale. */
double strtod (const char *restrict text, char **restrict end)
{
    char copy[500];
    size_t n = 0;
    for (; text[n] && n + 1 < sizeof copy && !(commas && text[n] == '.'); n++)
        copy[n] = commas && text[n] == ',' ? '.' : text[n];
    copy[n] = 0;
    char *last;
    long double value = strtold (copy, &last);
    if (end) *end = (char *) (uintptr_t) text + (last - copy);   /* as the function of the C library does */
    return (double) value;
}

static void points_are_read_where_commas_are_meant (void **state)
{
    (void) state;
    static const struct {
        const char *text;
        double expected;
    } row[] = {
        { "0.5", 0.5 }, { "12.25 mm", 12.25e-3 }, { "-1.5e-3 m", -1.5e-3 }, { ".125", 0.125 }, { "3", 3 },
        { "2.", 2 }
    };
    for (commas = 0; commas < 2; commas++)
        for (size_t k = 0; k < sizeof row / sizeof *row; k++) {
            double value = NAN;
            check_ok (pg_unit_parse (&value, row[k].text, "m"));
            check_relative (value, row[k].expected, 1e-15);
        }
    commas = 1;
    assert_true (strtod ("1,5", NULL) == 1.5 && strtod ("1.5", NULL) == 1);      /* it is in force */
    commas = 0;
}

int main (void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test (points_are_read_where_commas_are_meant) };
    return cmocka_run_group_tests_name ("scene/locale", tests, NULL, NULL);
}
