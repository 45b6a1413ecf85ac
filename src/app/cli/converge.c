/* SPDX-License-Identifier: GPL-3.0-or-later
 * perigal converge: the command line of a study of convergence (study.h): a scene, how many
 * spacings, their ratio, the horizons, and whether the horizon falls with the spacing
 * (--delta, the default) or keeps its length (--m). */
#include "app/cli/preparation/cli.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Reads a number from low to high. */
static pg_status read_number (double *out, const char *name, const char *text, double low, double high)
{
    pg_status status = PG_OK;
    char *end;
    *out = strtod (text, &end);
    if (end == text || *end || !(*out >= low && *out <= high))
        PG_FAIL (PG_E_USAGE, "%s %s: a number from %g to %g is needed", name, text, low, high);
done:
    return status;
}

/* Reads --horizon LIST, in spacings, 1 to 50; each horizon gives a study of its own. */
static pg_status read_horizons (pg_converge_request *q, const char *value)
{
    pg_status status = PG_OK;
    pg_word_list *words = NULL;
    PG_ALLOC (words, 1);
    if (!pg_word_list_split (words, value) || words->n > PG_CONVERGE_STUDIES)
        PG_FAIL (PG_E_USAGE, "--horizon %s: at most %d numbers separated by commas", value,
                 PG_CONVERGE_STUDIES);
    for (q->nhorizon = 0; q->nhorizon < words->n; q->nhorizon++)
        PG_TRY (read_number (&q->horizon[q->nhorizon], "--horizon", words->word[q->nhorizon], 1, 50));
done:
    pg_free (words);
    return status;
}

/* Reads one option with its value; options without one are read by read_arguments. */
static pg_status read_option (pg_converge_request *q, const char *name, const char *value)
{
    pg_status status = PG_OK;
    static const char names[] = "--spacing|--ratio|--horizon|--delta|--m|--out|--set|--threads|--quiet";
    const char *known[] = { "--spacing", "--ratio", "--horizon", "--out", "--set", "--threads" };
    double number;
    size_t k = 0;
    while (k < sizeof known / sizeof *known && strcmp (known[k], name) != 0) k++;
    if (k == sizeof known / sizeof *known) {
        const char *near = pg_nearest_name (name, names);
        PG_FAIL (PG_E_USAGE, "unknown option %s%s%s%s", name, near ? " (did you mean " : "",
                 near ? near : "", near ? "?)" : "");
    }
    if (!value) PG_FAIL (PG_E_USAGE, "%s needs a value", name);
    if (k == 0) {
        PG_TRY (read_number (&number, name, value, 2, PG_CONVERGE_SIZES));
        q->sizes = (size_t) number;
    } else if (k == 1) PG_TRY (read_number (&q->ratio, name, value, 1.05, 10));
    else if (k == 2) PG_TRY (read_horizons (q, value));
    else if (k == 3) q->folder = value;
    else if (k == 5) {
        PG_TRY (read_number (&number, name, value, 1, 64));
        q->threads = (int) number;
    } else if (!strchr (value, '=')) PG_FAIL (PG_E_USAGE, "--set %s: KEY=VALUE is needed", value);
    else if (q->nset >= PG_TRIAL_SETS / 2) PG_FAIL (PG_E_USAGE, "--set: at most %d times", PG_TRIAL_SETS / 2);
    else q->set[q->nset++] = value;
done:
    return status;
}

/* The long name of a short option; other words stay as they are. */
static const char *long_name (const char *word)
{
    static const char *const names[][2] = { { "-o", "--out" }, { "-s", "--set" }, { "-q", "--quiet" } };
    for (size_t k = 0; k < sizeof names / sizeof *names; k++)
        if (strcmp (word, names[k][0]) == 0) return names[k][1];
    return word;
}

/* Reads the command line; the default is four spacings, or three with a fixed horizon, where the number of
 * neighbours grows with every refinement. */
static pg_status read_arguments (pg_converge_request *q, int argc, char **argv)
{
    pg_status status = PG_OK;
    int delta = 0;
    char unquoted[1200];
    memset (q, 0, sizeof *q);
    q->threads = 1, q->ratio = 2, q->folder = "out/converge", q->out = stdout;
    if (command_unquoted (unquoted, sizeof unquoted, argc, argv)) PG_FAIL (PG_E_USAGE, "%s", unquoted);
    for (int k = 1; k < argc; k++) {
        const char *name = long_name (argv[k]);
        if (strcmp (name, "--m") == 0) q->fixed = 1;
        else if (strcmp (name, "--delta") == 0) delta = 1;
        else if (strcmp (name, "--quiet") == 0) q->out = NULL;
        else if (name[0] == '-') {
            PG_TRY (read_option (q, name, k + 1 < argc ? argv[k + 1] : NULL));
            k++;
        } else if (!q->scene) q->scene = argv[k];
        else PG_FAIL (PG_E_USAGE, "one scene at a time: %s, %s", q->scene, argv[k]);
    }
    if (!q->scene) PG_FAIL (PG_E_USAGE, "a scene file is needed");
    if (delta && q->fixed) PG_FAIL (PG_E_USAGE, "--delta and --m exclude each other");
    if (!q->sizes) q->sizes = q->fixed ? 3 : 4;
done:
    return status;
}

/* Runs the command. After a wrong command line its usage is printed; the message about a wrong scene has file
 * and line. */
int pg_cli_converge (int argc, char **argv)
{
    pg_status status = PG_OK;
    pg_converge_request q;
    for (int k = 1; k < argc; k++)
        if (strcmp (argv[k], "--help") == 0 || strcmp (argv[k], "-h") == 0)
            return command_usage (stdout, "converge") ? PG_EXIT_DONE : PG_EXIT_USAGE;
    PG_TRY (read_arguments (&q, argc, argv));
    PG_TRY (pg_converge_run (&q));
done:
    if (status == PG_E_SCENE) fprintf (stderr, "%s\n", pg_last_error ());
    else if (status != PG_OK) fprintf (stderr, "perigal converge: %s\n", pg_last_error ());
    if (status == PG_E_USAGE) command_usage (stderr, "converge");
    return pg_exit_code (status);
}
