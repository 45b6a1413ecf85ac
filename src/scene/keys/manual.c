/* SPDX-License-Identifier: GPL-3.0-or-later
 * Writes doc/input.md: an introduction, then one section with a table of keys for each top-level word of a
 * scene (input file). */
#include "keys.h"
#include "scene/quantity/expression.h"
#include <string.h>

/* Text of the manual before the tables. */
static const char introduction[] = "# The scene file\n\n"
                                   "This page is written by the program from the tables that also check a "
                                   "scene; `perigal help KEY` prints one entry.\n\n"
                                   "A scene is a YAML map. Every key is checked: an unknown key, a missing "
                                   "one, a wrong unit or a value out of range is\n"
                                   "reported with its line and column, all of them in one pass. In the "
                                   "tables `{}` stands for a name of your choice and\n"
                                   "`[]` for an element of a list.\n\n"
                                   "## Units\n\n"
                                   "A number is followed by its unit: `10 GPa`, `-1 um`, `2500 kg/m3`, `40 "
                                   "deg`, `5 %`, `0.1 ms`. Without a unit it is in\n"
                                   "SI (m, kg, s, N, Pa, rad). A unit of another kind (`72 mm` for a "
                                   "pressure) is an error. Where the unit is given as\n"
                                   "`m, spacing` the value may also be a multiple of the distance of points: "
                                   "`2.0 spacing`. Units are those of udunits2,\n"
                                   "plus `deg`; powers are written `mm2` or `mm^2`, products `kN m`.\n\n";

static const char overrides[] =
    "## Overrides\n\n"
    "`--set KEY=VALUE` on the command line replaces or adds one value before the scene is checked; VALUE is "
    "YAML, KEY is a\n"
    "path such as `method.horizon` or `cracks[0].from`. Maps on the way are made when they are missing, and "
    "a list grows by\n"
    "naming the element after its last. Overrides enter the hash by which results name their scene.\n\n";

/* Writes the section about expressions, from the tables of variables and functions. */
static void write_expressions (FILE *to)
{
    fprintf (to, "## Expressions\n\nA value of kind *expression* is a number with unit or a formula. Numbers "
                 "in it may carry units;\n"
                 "adding or comparing different units is an error. A number without unit is SI and fits "
                 "anywhere.\n\n");
    fprintf (to, "| variable | meaning |\n|---|---|\n");
    for (size_t k = 0; pg_expression_variable (k); k++)
        fprintf (to, "| `%s` | %s |\n", pg_expression_variable (k)->name, pg_expression_variable (k)->doc);
    fprintf (to, "\n| function | meaning |\n|---|---|\n");
    for (size_t k = 0; pg_expression_function (k); k++) {
        const pg_function *f = pg_expression_function (k);
        fprintf (to, "| `%s (%s)` | %s |\n", f->name,
                 f->arguments == 1  ? "a"
                 : f->arguments < 0 ? "a, b, ..."
                                    : "a, b",
                 f->doc);
    }
    fprintf (to, "\nOperators, from loose to tight: `or`, `and`, `not`, one of `< <= > >= == !=`, `+ -`, `* "
                 "/`, sign, `^`.\n"
                 "`pi` is the number. A *condition* (unit `bool`) is an expression such as `r >= 48 mm and y "
                 "> 0`.\n\n");
}

/* Writes names "a|b" in back quotes. */
static void write_list (FILE *to, const char *names)
{
    fprintf (to, "`");
    for (; *names; names++) {
        if (*names == '|') fprintf (to, "`, `");
        else fputc (*names, to);
    }
    fprintf (to, "`");
}

/* Writes one key as a row of a table. */
static void write_row (FILE *to, const pg_schema *s, const pg_key *key)
{
    char first[PG_LEVEL_NAMES];
    const char *choices = pg_key_choices (key), *fallback = pg_key_default (key, first);
    fprintf (to, "| `%s` | %s%s", key->path, pg_key_kind (key), key->unit ? ", " : "");
    if (key->unit) write_list (to, key->unit);
    fprintf (to, " | %s%s%s", key->range ? "`" : "", key->range ? key->range : "", key->range ? "`" : "");
    if (choices && *choices) write_list (to, choices);
    fprintf (to, " | ");
    if (fallback && *fallback) fprintf (to, "`%s`", fallback);
    else if (!key->fallback && !key->group) fprintf (to, "**required**");
    fprintf (to, " | ");
    pg_help_meaning (to, s, key);
    if (key->group) {
        const char *rule = strrchr (key->group, ':');
        int one = rule && strcmp (rule, ":one") == 0;
        fprintf (to, " %s of the group *%.*s*.", one ? "Exactly one" : "At most one",
                 (int) strcspn (key->group, ":"), key->group);
    }
    fprintf (to, " |\n");
}

/* Length of the first word of a path. */
static size_t top_length (const char *path) { return strcspn (path, ".["); }

/* Do two paths begin with the same word? */
static int same_top (const char *a, const char *b)
{
    size_t n = top_length (a);
    return top_length (b) == n && strncmp (a, b, n) == 0;
}

/* Number of rows with the same first word as row k, among the first `end`. */
static size_t companions (const pg_schema *s, size_t k, size_t end)
{
    size_t n = 0;
    for (size_t j = 0; j < end; j++) n += same_top (s->row[j]->path, s->row[k]->path);
    return n;
}

/* Is row k the only one with its first word? */
static int stands_alone (const pg_schema *s, size_t k)
{
    return !strpbrk (s->row[k]->path, ".[") && companions (s, k, s->n) == 1;
}

/* Writes the title and head of a table. */
static void write_title (FILE *to, const char *title, size_t n)
{
    fprintf (
        to,
        "### %.*s\n\n| key | kind, unit | range or choices | default | meaning |\n|---|---|---|---|---|\n",
        (int) n, title);
}

/* Writes the tables of keys. Keys that stand alone come first, in one table. */
static void write_sections (FILE *to, const pg_schema *s)
{
    static const char first[] = "The whole scene";
    write_title (to, first, strlen (first));
    for (size_t k = 0; k < s->n; k++)
        if (stands_alone (s, k)) write_row (to, s, s->row[k]);
    for (size_t k = 0; k < s->n; k++) {
        const char *top = s->row[k]->path;
        if (stands_alone (s, k) || companions (s, k, k) > 0) continue;
        fprintf (to, "\n");
        write_title (to, top, top_length (top));
        for (size_t j = k; j < s->n; j++)
            if (same_top (s->row[j]->path, top)) write_row (to, s, s->row[j]);
    }
}

/* Write errors are found at the end, by ferror. */
pg_status pg_manual_write (FILE *to, const pg_schema *s)
{
    fprintf (to, "%s", introduction);
    write_expressions (to);
    fprintf (to, "%s## Keys\n\n", overrides);
    write_sections (to, s);
    return ferror (to) ? pg_error (PG_E_FILE, PG_HERE, "the manual could not be written") : PG_OK;
}
