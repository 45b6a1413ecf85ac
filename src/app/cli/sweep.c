/* SPDX-License-Identifier: GPL-3.0-or-later
 * perigal sweep SCENE --set KEY=A,B,C ...: the command line of a sweep (study.h): keys with several values,
 * how they are combined, how many runs at a time, which columns the table has. */
#include "app/cli/preparation/cli.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { MOST_JOBS = 64 };
/* The request of a sweep, and the texts that it borrows. */
typedef struct {
    pg_sweep_request q;
    char quantities[2048], memory[32];
    int quiet;
} given;

/* Reads an integer from low to high. */
static pg_status read_count (int *out, const char *name, const char *text, int low, int high)
{
    pg_status status = PG_OK;
    char *end;
    long n = strtol (text, &end, 10);
    if (end == text || *end || n < low || n > high)
        PG_FAIL (PG_E_USAGE, "%s %s: a number from %d to %d is needed", name, text, low, high);
    *out = (int) n;
done:
    return status;
}

/* Appends the names of one option --quantity A,B,C; it may be given several times. */
static pg_status read_quantities (given *g, const char *text)
{
    pg_status status = PG_OK;
    size_t at = strlen (g->quantities);
    if (at + strlen (text) + 2 > sizeof g->quantities) PG_FAIL (PG_E_USAGE, "--quantity: too many letters");
    char *word = g->quantities + at + (at > 0);
    if (at) g->quantities[at] = ',';
    strcpy (word, text);
done:
    return status;
}

/* Cuts the names of --quantity at the commas, in place. */
static pg_status cut_quantities (given *g)
{
    pg_status status = PG_OK;
    for (char *s = g->quantities; *s;) {
        size_t n = strcspn (s, ",");
        int last = s[n] == 0;
        if (n == 0) PG_FAIL (PG_E_USAGE, "--quantity: a name is missing before or behind a comma");
        if (g->q.nquantity == PG_SWEEP_QUANTITIES)
            PG_FAIL (PG_E_USAGE, "--quantity: at most %d names", PG_SWEEP_QUANTITIES);
        g->q.quantity[g->q.nquantity++] = s;
        s[n] = 0, s += n + !last;
    }
done:
    return status;
}

/* Reads an option that has a value. */
static pg_status read_option (given *g, const char *name, const char *value)
{
    pg_status status = PG_OK;
    static const char names[] = "--set|--zip|--jobs|--threads|--memory|--out|--resume|--quantity|"
                                "--quiet|--help";
    static const char *const valued[] = { "--set", "--jobs", "--threads", "--memory", "--out", "--quantity" };
    size_t k = 0;
    while (k < sizeof valued / sizeof *valued && strcmp (valued[k], name) != 0) k++;
    if (k == sizeof valued / sizeof *valued) {
        const char *near = pg_nearest_name (name, names);
        PG_FAIL (PG_E_USAGE, "unknown option %s%s%s%s", name, near ? " (did you mean " : "", near ? near : "",
                 near ? "?)" : "");
    }
    if (!value) PG_FAIL (PG_E_USAGE, "%s needs a value", name);
    switch (k) {
    case 0:
        if (!strchr (value, '=')) PG_FAIL (PG_E_USAGE, "--set %s: KEY=VALUE,VALUE,... is needed", value);
        if (g->q.nset == PG_TRIAL_SETS) PG_FAIL (PG_E_USAGE, "--set: at most %d times", PG_TRIAL_SETS);
        g->q.set[g->q.nset++] = value;
        break;
    case 1: PG_TRY (read_count (&g->q.jobs, name, value, 1, MOST_JOBS)); break;
    case 2: PG_TRY (read_count (&g->q.threads, name, value, 0, 64)); break;
    case 3: g->q.memory = value; break;
    case 4: g->q.folder = value; break;
    default: PG_TRY (read_quantities (g, value));
    }
done:
    return status;
}

/* The long name of a short option; "-j4" is not accepted, as "-o" and "-s" elsewhere take their value as the
 * next word. */
static const char *long_name (const char *word)
{
    static const char *const names[][2] = { { "-o", "--out" },  { "-s", "--set" },   { "-j", "--jobs" },
                                            { "-q", "--quiet" } };
    for (size_t k = 0; k < sizeof names / sizeof *names; k++)
        if (strcmp (word, names[k][0]) == 0) return names[k][1];
    return word;
}

static pg_status read_words (given *g, int argc, char **argv)
{
    pg_status status = PG_OK;
    char unquoted[1200], joined[64];
    if (command_unquoted (unquoted, sizeof unquoted, argc, argv)) PG_FAIL (PG_E_USAGE, "%s", unquoted);
    for (int k = 1; k < argc; k++) {
        const char *name = long_name (argv[k]), *equals = strchr (name, '=');
        if (strcmp (name, "--zip") == 0) g->q.zip = 1;
        else if (strcmp (name, "--resume") == 0) g->q.resume = 1;
        else if (strcmp (name, "--quiet") == 0) g->quiet = 1;
        else if (strncmp (name, "--", 2) == 0 && equals && equals - name < (long) sizeof joined) {
            snprintf (joined, sizeof joined, "%.*s", (int) (equals - name), name);
            PG_TRY (read_option (g, joined, equals + 1));
        } else if (name[0] == '-' && name[1]) {
            PG_TRY (read_option (g, name, k + 1 < argc ? argv[k + 1] : NULL));
            k++;
        } else if (!g->q.scene) g->q.scene = argv[k];
        else PG_FAIL (PG_E_USAGE, "one scene at a time: %s, %s", g->q.scene, argv[k]);
    }
    if (!g->q.scene) PG_FAIL (PG_E_USAGE, "a scene file is needed");
    PG_TRY (cut_quantities (g));
done:
    return status;
}

/* Shares processors and memory among the runs that go on at one time, unless the command line says how
 * many. */
void command_share (int jobs, int *threads, double memory, char text[32])
{
    int each = command_threads () / jobs;
    command machine = { .threads = 1 };
    if (*threads == 0) *threads = each < 1 ? 1 : each;
    snprintf (text, 32, "%.0f", floor (memory > 0 ? memory : afford_available (&machine) / jobs));
}

/* Sets threads and memory limit of each run; one run at a time needs no limit. */
static void share (given *g)
{
    command_share (g->q.jobs, &g->q.threads, 0, g->memory);
    if (!g->q.memory && g->q.jobs > 1) g->q.memory = g->memory;
}

/* Runs the command. Exit codes: 0 all runs done, 64 wrong use, 65 a combination is wrong, 70 some runs
 * failed, 130 interrupted. */
int pg_cli_sweep (int argc, char **argv)
{
    pg_status status = PG_OK;
    given *g = NULL;
    for (int k = 1; k < argc; k++)
        if (strcmp (argv[k], "--help") == 0 || strcmp (argv[k], "-h") == 0)
            return command_usage (stdout, "sweep") ? PG_EXIT_DONE : PG_EXIT_USAGE;
    PG_ALLOC (g, 1);
    g->q.folder = "out/sweep", g->q.jobs = 1;
    PG_TRY (read_words (g, argc, argv));
    share (g);
    g->q.out = g->quiet ? NULL : stdout, g->q.stop = command_stops ();
    PG_TRY (pg_sweep_run (&g->q));
done:
    if (status == PG_E_SCENE) fprintf (stderr, "%s\n", pg_last_error ());
    else if (status != PG_OK) fprintf (stderr, "perigal sweep: %s\n", pg_last_error ());
    if (status == PG_E_INTERRUPTED)
        fprintf (stderr, "perigal sweep: the same command with --resume goes on\n");
    if (status == PG_E_USAGE && !(g && g->q.scene && g->q.nset)) command_usage (stderr, "sweep");
    pg_free (g);
    return pg_exit_code (status);
}
