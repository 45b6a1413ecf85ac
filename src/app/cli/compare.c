/* SPDX-License-Identifier: GPL-3.0-or-later
 * perigal compare DIR [REFERENCE]: a result against the reference of its scene, a table,
 * another result or a finite element result. The command line is read here; study.h opens both
 * sides and measures, compare.h has the norms. */
#include "app/cli/preparation/cli.h"
#include <errno.h>
#include <getopt.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Prints a message, whose format takes one text, and returns the exit code for wrong use. */
static int complain (const char *format, const char *text)
{
    fputs ("perigal compare: ", stderr);
    fprintf (stderr, format, text);
    fputc ('\n', stderr);
    return PG_EXIT_USAGE;
}

/* Reads up to three lengths "1, -2 mm, 0" into m; a number without a unit is in m. 0: text is not that. */
static int read_shift (const char *text, double shift[3])
{
    char part[64];
    for (int k = 0; k < 3; k++) {
        size_t n = strcspn (text, ",");
        snprintf (part, sizeof part, "%.*s", (int) (n < 60 ? n : 60), text);
        if (pg_unit_parse (&shift[k], part, "m") != PG_OK) return 0;
        text += n;
        if (!*text) return 1;
        text++;
    }
    return 0;
}

/* Reads a unit of length into m: "mm" is read as "1 mm". Returns 0 for anything else. */
static int read_unit (const char *text, double *unit)
{
    char one[64];
    snprintf (one, sizeof one, "1 %.50s", text);
    return pg_unit_parse (unit, one, "m") == PG_OK && *unit > 0;
}

/* Turns "displacement", "displacement.x", "stress.xx" ... into a column of compare.h; returns 0 for other
 * names. */
static int read_field (const char *text, int *column)
{
    if (strcmp (text, "displacement") == 0) *column = PG_COMPARE_U;
    else if (strcmp (text, "stress") == 0) *column = PG_COMPARE_S;
    else *column = -1;
    for (int c = 0; c < 9 && *column < 0; c++) {
        char name[32];
        snprintf (name, sizeof name, "%s.%s", c < 3 ? "displacement" : "stress", pg_column_name (c) + 2);
        if (strcmp (text, name) == 0) *column = c;
    }
    return *column >= 0;
}

/* Reads the number of a step, -1 for the last one; returns 0 for anything else. */
static int read_step (const char *text, int *step)
{
    char *end;
    long n = strtol (text, &end, 10);
    if (end == text || *end || n < -1 || n > 1000000000) return 0;
    *step = (int) n;
    return 1;
}

/* Reads a finite number; returns 0 for anything else. */
static int read_number (const char *text, double *out)
{
    char *end;
    *out = strtod (text, &end);
    return end != text && !*end && isfinite (*out);
}

/* Reads a number of threads from 0 to 64; 0 means one for each processor. Returns 0 for anything else. */
static int read_threads (const char *text, int *out)
{
    double threads = 0;
    if (!read_number (text, &threads) || threads < 0 || threads > 64) return 0;
    *out = (int) threads;
    return 1;
}

/* Reads one option; -1: go on, else the exit code. */
static int read_option (pg_comparison_request *q, int *json, int option, const char *text)
{
    static const char *const faults[] = {
        ['n'] = "--step %s: expected 0, 1, 2 ... or -1 (the last)",
        ['m'] = "--reference-step %s: expected 0, 1, 2 ... or -1 (the last)",
        ['f'] = "--field %s: displacement, stress, or a part such as displacement.x, stress.xx",
        ['u'] = "--unit %s: a unit of length is needed, such as mm",
        ['d'] = "--shift %s: up to three lengths are needed, such as 0,-5mm",
        ['c'] = "--scale %s: a number is needed",
        ['t'] = "--threads %s: a number from 0 (all) to 64 is needed",
    };
    int good = 1;
    switch (option) {
    case 'n': good = read_step (text, &q->step); break;
    case 'm': good = read_step (text, &q->other_step); break;
    case 'f': good = read_field (text, &q->column); break;
    case 'u': good = read_unit (text, &q->unit); break;
    case 'd': good = read_shift (text, q->shift); break;
    case 'c': good = read_number (text, &q->scale); break;
    case 't': good = read_threads (text, &q->threads); break;
    case 'o': q->picture = text; break;
    case 'j': *json = 1; break;
    default: q->out = NULL; break;
    }
    return good ? -1 : complain (faults[option], text);
}

/* Reads the command line; -1: go on, else the exit code. A folder is needed, a reference may
 * follow. With --json nothing else is printed. */
static int parse (pg_comparison_request *q, int *json, int argc, char **argv)
{
    static const struct option options[] = {
        { "step", required_argument, NULL, 'n' },    { "reference-step", required_argument, NULL, 'm' },
        { "field", required_argument, NULL, 'f' },   { "unit", required_argument, NULL, 'u' },
        { "shift", required_argument, NULL, 'd' },   { "scale", required_argument, NULL, 'c' },
        { "threads", required_argument, NULL, 't' }, { "out", required_argument, NULL, 'o' },
        { "json", no_argument, NULL, 'j' },          { "quiet", no_argument, NULL, 'q' },
        { "help", no_argument, NULL, 'h' },          { NULL, 0, NULL, 0 }
    };
    *q = (pg_comparison_request) { .step = -1, .other_step = -1, .unit = 1, .scale = 1, .column = -1 };
    q->out = stdout;
    optind = 1, opterr = 0;
    for (int k, wrong = -1; (k = getopt_long (argc, argv, ":o:qh", options, NULL)) != -1;) {
        if (k == 'h') return command_usage (stdout, argv[0]) ? PG_EXIT_DONE : PG_EXIT_USAGE;
        if (k == ':') wrong = complain ("%s needs a value", argv[optind - 1]);
        else if (k == '?') wrong = complain ("unknown option %s", argv[optind - 1]);
        else wrong = read_option (q, json, k, optarg);
        if (wrong >= 0) return wrong;
    }
    if (optind >= argc || optind + 2 < argc) {
        complain ("%s", "a result folder is needed, and at most one reference");
        command_usage (stderr, argv[0]);
        return PG_EXIT_USAGE;
    }
    q->folder = argv[optind], q->reference = optind + 1 < argc ? argv[optind + 1] : NULL;
    if (strlen (q->folder) > 2000) return complain ("%s", "the path is too long");
    if (*json) q->out = NULL;
    if (q->threads < 1) q->threads = command_threads ();
    return -1;
}

/* Prints the comparison as text: which step, how both sides were sampled, and the norms. */
static void print_rows (const pg_comparison *c, const pg_comparison_request *q)
{
    char row[400];
    printf ("%s, step %d, against %s\n  %s", q->folder, c->own->step,
            q->reference ? q->reference : "its scene's reference", c->own->how);
    if (c->note[0]) printf ("\n  %s", c->note);
    printf ("\n");
    for (size_t k = 0; pg_errors_row (&c->errors, k, row, sizeof row); k++) printf ("  %s\n", row);
}

/* Copies compare.json, which is left in the result folder, to stdout. */
static pg_status print_json (const pg_comparison_request *q)
{
    pg_status status = PG_OK;
    char path[4096], part[4096];
    size_t n;
    snprintf (path, sizeof path, "%s/compare.json", q->folder);
    FILE *f = fopen (path, "r");
    if (!f) PG_FAIL (PG_E_FILE, "%s: %s", path, strerror (errno));
    while ((n = fread (part, 1, sizeof part, f)) > 0) fwrite (part, 1, n, stdout);
done:
    if (f) fclose (f);
    return status;
}

/* Runs the command. The norms are printed before the files are written, so that they are seen even if the
 * disk is full. With --json the file compare.json is printed instead. */
int pg_cli_compare (int argc, char **argv)
{
    pg_status status = PG_OK;
    pg_comparison_request q;
    pg_comparison c = { 0 };
    int json = 0;
    int wrong = parse (&q, &json, argc, argv);
    if (wrong >= 0) return wrong;
    PG_TRY (pg_comparison_open (&c, &q));
    if (q.out) print_rows (&c, &q);
    PG_TRY (pg_comparison_write (&c, &q));
    if (json) PG_TRY (print_json (&q));
done:
    if (status != PG_OK) command_complain (status, pg_last_error ());
    pg_comparison_clear (&c);
    return pg_exit_code (status);
}
