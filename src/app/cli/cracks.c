/* SPDX-License-Identifier: GPL-3.0-or-later
 * perigal cracks: the cracks of a scene alone: their statistics, a picture, and a table that a scene can read
 * again. Nothing is computed, so that a network can be looked at, and its seed chosen, in no time. */
#include "app/cli/preparation/cli.h"
#include "perigal/picture.h"
#include <math.h>
#include <string.h>

/* What the command line asks for. */
typedef struct { const char *scene, *picture, *csv, *set[64]; size_t nset; int quiet; } request;

/* The long name of a short option; other words stay as they are. */
static const char *long_name (const char *word)
{
    static const char *const names[][2] = { { "-o", "--out" }, { "-s", "--set" }, { "-q", "--quiet" } };
    for (size_t k = 0; k < sizeof names / sizeof *names; k++)
        if (strcmp (word, names[k][0]) == 0) return names[k][1];
    return word;
}

/* Reads an option with a value. */
static pg_status read_option (request *q, const char *name, const char *value)
{
    pg_status status = PG_OK;
    int out = strcmp (name, "--out") == 0, csv = strcmp (name, "--csv") == 0;
    if (!out && !csv && strcmp (name, "--set") != 0) {
        const char *near = pg_nearest_name (name, "--out|--csv|--set|--quiet|--help");
        PG_FAIL (PG_E_USAGE, "unknown option %s%s%s%s", name, near ? " (did you mean " : "", near ? near : "",
                 near ? "?)" : "");
    }
    if (!value) PG_FAIL (PG_E_USAGE, "%s needs a value", name);
    if (out) q->picture = value;
    else if (csv) q->csv = value;
    else if (!strchr (value, '=')) PG_FAIL (PG_E_USAGE, "--set %s: KEY=VALUE is needed", value);
    else if (q->nset >= sizeof q->set / sizeof *q->set) PG_FAIL (PG_E_USAGE, "--set: at most 64 times");
    else q->set[q->nset++] = value;
done:
    return status;
}

static pg_status read_arguments (request *q, int argc, char **argv)
{
    pg_status status = PG_OK;
    char unquoted[1200];
    memset (q, 0, sizeof *q);
    if (command_unquoted (unquoted, sizeof unquoted, argc, argv)) PG_FAIL (PG_E_USAGE, "%s", unquoted);
    for (int k = 1; k < argc; k++) {
        const char *name = long_name (argv[k]);
        if (strcmp (name, "--quiet") == 0) q->quiet = 1;
        else if (name[0] == '-') {
            PG_TRY (read_option (q, name, k + 1 < argc ? argv[k + 1] : NULL));
            k++;
        } else if (!q->scene) q->scene = argv[k];
        else PG_FAIL (PG_E_USAGE, "one scene at a time: %s, %s", q->scene, argv[k]);
    }
    if (!q->scene) PG_FAIL (PG_E_USAGE, "a scene file is needed");
done:
    return status;
}

static void said (void *context, const char *name)
{
    const request *q = context;
    if (!q->quiet) printf ("  written             %s\n", name);
}

/* Runs the command: reads the cracks, measures them, then writes what was asked for. */
int pg_cli_cracks (int argc, char **argv)
{
    pg_status status = PG_OK;
    request q;
    pg_scene *scene = NULL;
    pg_body body = { 0 };
    pg_cracks all = { 0 };
    pg_crack_statistics n;
    for (int k = 1; k < argc; k++)
        if (strcmp (argv[k], "--help") == 0 || strcmp (argv[k], "-h") == 0)
            return command_usage (stdout, "cracks") ? PG_EXIT_DONE : PG_EXIT_USAGE;
    PG_TRY (read_arguments (&q, argc, argv));
    PG_TRY (pg_scene_load_some (&scene, q.scene, q.nset, q.set));
    PG_TRY (pg_body_read (&body, scene));
    PG_TRY (pg_network_read (&all, scene));
    if (all.n == 0) PG_FAIL (PG_E_USAGE, "%s has no cracks", q.scene);
    PG_TRY (pg_crack_statistics_measure (&n, &all, scene));
    PG_TRY (pg_cracks_index (&all));
    if (!q.quiet) printf ("%s\n", q.scene), plan_network (&n);
    if (q.csv) PG_TRY (pg_cracks_write (&all, q.csv, said, &q));
    if (q.picture) {
        PG_TRY (pg_picture_network (q.picture, &body, &all, pg_scene_text (scene, "title")));
        said (&q, q.picture);
    }
done:
    if (status == PG_E_SCENE) fprintf (stderr, "%s\n", pg_last_error ());
    else if (status != PG_OK) fprintf (stderr, "perigal cracks: %s\n", pg_last_error ());
    if (status == PG_E_USAGE && !scene) command_usage (stderr, "cracks");
    pg_cracks_clear (&all);
    pg_body_clear (&body);
    pg_scene_free (&scene);
    return pg_exit_code (status);
}
