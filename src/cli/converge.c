/* SPDX-License-Identifier: GPL-3.0-or-later
 * perigal converge: a scene at falling sizes, each run a process of its own; orders of all that it gives. */
#include "cli.h"
#include "bench.h"
#include "converge.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct {
    const char *scene, *folder, *set[TRIAL_SETS / 2];
    size_t      nset, sizes;
    double      ratio, horizon[CONVERGE_STUDIES];
    size_t      nhorizon;
    int         fixed, quiet, threads;                 /* fixed: the horizon stays */
} request;

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

static pg_status read_horizons (request *q, const char *value)
{
    pg_status status = PG_OK;
    bench_words *words = NULL;
    PG_ALLOC (words, 1);
    if (!bench_split (words, value) || words->n > CONVERGE_STUDIES)
        PG_FAIL (PG_E_USAGE, "--horizon %s: at most %d numbers separated by commas", value, CONVERGE_STUDIES);
    for (q->nhorizon = 0; q->nhorizon < words->n; q->nhorizon++)
        PG_TRY (read_number (&q->horizon[q->nhorizon], "--horizon", words->word[q->nhorizon], 1, 50));
done:
    pg_free (words);
    return status;
}

static pg_status read_option (request *q, const char *name, const char *value)
{
    pg_status status = PG_OK;
    static const char names[] = "--spacing|--ratio|--horizon|--delta|--m|--out|--set|--threads|--quiet";
    const char *known[] = { "--spacing", "--ratio", "--horizon", "--out", "--set", "--threads" };
    double number;
    size_t k = 0;
    while (k < sizeof known / sizeof *known && strcmp (known[k], name) != 0) k++;
    if (k == sizeof known / sizeof *known) {
        const char *near = pg_nearest_name (name, names);
        PG_FAIL (PG_E_USAGE, "there is no option %s%s%s%s", name, near ? " (did you mean " : "",
                 near ? near : "", near ? "?)" : "");
    }
    if (!value) PG_FAIL (PG_E_USAGE, "%s needs a value", name);
    if (k == 0) {
        PG_TRY (read_number (&number, name, value, 2, CONVERGE_SIZES));
        q->sizes = (size_t) number;
    } else if (k == 1) PG_TRY (read_number (&q->ratio, name, value, 1.05, 10));
    else if (k == 2) PG_TRY (read_horizons (q, value));
    else if (k == 3) q->folder = value;
    else if (k == 5) {
        PG_TRY (read_number (&number, name, value, 1, 64));
        q->threads = (int) number;
    } else if (!strchr (value, '=')) PG_FAIL (PG_E_USAGE, "--set %s: KEY=VALUE is needed", value);
    else if (q->nset >= TRIAL_SETS / 2) PG_FAIL (PG_E_USAGE, "--set: at most %d times", TRIAL_SETS / 2);
    else q->set[q->nset++] = value;
done:
    return status;
}

static pg_status read_arguments (request *q, int argc, char **argv)
{
    pg_status status = PG_OK;
    int delta = 0;
    memset (q, 0, sizeof *q);
    q->threads = 1, q->ratio = 2, q->folder = "out/converge";
    char unquoted[1200];
    if (command_unquoted (unquoted, sizeof unquoted, argc, argv)) PG_FAIL (PG_E_USAGE, "%s", unquoted);
    for (int k = 1; k < argc; k++) {
        const char *name = strcmp (argv[k], "-o") == 0   ? "--out"
                           : strcmp (argv[k], "-s") == 0 ? "--set"
                           : strcmp (argv[k], "-q") == 0 ? "--quiet"
                                                         : argv[k];
        if (strcmp (name, "--m") == 0) q->fixed = 1;
        else if (strcmp (name, "--delta") == 0) delta = 1;
        else if (strcmp (name, "--quiet") == 0) q->quiet = 1;
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

/* ---- runs ---------------------------------------------------------------------------------------------- */
static pg_status take_errors (study *s, size_t k, const trial *t)
{
    pg_status status = PG_OK;
    static const struct { int id; const char *name;
    } errors[] = { { TRIAL_L2, "L2 error" },
                   { TRIAL_ENERGY, "energy error" },
                   { TRIAL_MAXIMUM, "maximum error" },
                   { TRIAL_LINES, "error on lines" } };
    for (size_t e = 0; e < sizeof errors / sizeof *errors; e++) {
        if (isnan (t->value[errors[e].id])) continue;
        quantity *q = study_quantity (s, errors[e].name, "1");
        if (!q) PG_FAIL (PG_E_MEMORY, "no memory for %s", errors[e].name);
        q->error = 1, q->value[k] = t->value[errors[e].id];
    }
done:
    return status;
}

static pg_status run_study (study *s, const request *q, const bench_base *b)
{
    pg_status status = PG_OK;
    for (size_t k = 0; k < q->sizes; k++) {
        char folder[4096], spacing[64], horizon[64];
        double h = b->spacing / pow (q->ratio, (double) k);
        trial_request run = { .scene = q->scene, .folder = folder, .threads = q->threads };
        trial t;
        snprintf (folder, sizeof folder, "%s/%s%g_%zu", q->folder, q->fixed ? "m" : "h", s->horizon, k + 1);
        snprintf (spacing, sizeof spacing, "spacing=%.15g", h);
        if (q->fixed) snprintf (horizon, sizeof horizon, "method.horizon=%.15g m", s->horizon * b->spacing);
        else snprintf (horizon, sizeof horizon, "method.horizon=%.15g spacing", s->horizon);
        for (size_t i = 0; i < q->nset; i++) run.set[run.nset++] = q->set[i];
        run.set[run.nset++] = spacing, run.set[run.nset++] = horizon;              /* the later one counts */
        PG_TRY (trial_run (&t, &run));
        if (k && !(t.value[TRIAL_SPACING] < s->h[k - 1]))
            PG_FAIL (PG_E_SCENE,
                     "%s: spacing %g m is no smaller than the one before: does the scene take its points "
                     "from a file?",
                     q->scene, t.value[TRIAL_SPACING]);
        s->h[k] = t.value[TRIAL_SPACING], s->n = k + 1;
        PG_TRY (take_errors (s, k, &t));
        PG_TRY (converge_history (s, k, folder));
        if (!q->quiet)
            printf ("  horizon %g, spacing %.6g m: %.0f points, %.2f s CPU\n", s->horizon, s->h[k],
                    t.value[TRIAL_POINTS], t.value[TRIAL_CPU]),
                fflush (stdout);
    }
done:
    return status;
}

static pg_status study_all (study *list, request *q)
{
    pg_status status = PG_OK;
    bench_base b;
    PG_TRY (bench_look (&b, q->scene, q->nset, q->set));
    if (!(b.spacing > 0))
        PG_FAIL (PG_E_SCENE,
                 "%s: converge changes the spacing, and this scene has none: it needs a body and spacing",
                 q->scene);
    if (!q->nhorizon) q->horizon[q->nhorizon++] = b.horizon;
    PG_TRY (pg_folder_make (q->folder));
    for (size_t k = 0; k < q->nhorizon; k++) {
        list[k].horizon = q->horizon[k];
        PG_TRY (run_study (&list[k], q, &b));
    }
    for (size_t k = 0; k < q->nhorizon && !q->quiet; k++) converge_print (&list[k], q->fixed);
    PG_TRY (converge_table (list, q->nhorizon, q->folder));
    int drawn = 0;
    PG_TRY (converge_picture (list, q->nhorizon, q->folder, b.name, &drawn));
    if (!q->quiet)
        printf ("  table %s/convergence.csv%s%s%s\n", q->folder, drawn ? ", picture " : "",
                drawn ? q->folder : "", drawn ? "/convergence.png" : "");
done:
    return status;
}

int pg_cli_converge (int argc, char **argv)
{
    pg_status status = PG_OK;
    request q;
    study *list = NULL;
    for (int k = 1; k < argc; k++)
        if (strcmp (argv[k], "--help") == 0 || strcmp (argv[k], "-h") == 0)
            return command_usage (stdout, "converge") ? EXIT_DONE : EXIT_USAGE;
    PG_TRY (read_arguments (&q, argc, argv));
    PG_ALLOC (list, CONVERGE_STUDIES);
    PG_TRY (study_all (list, &q));
done:
    if (status == PG_E_SCENE) fprintf (stderr, "%s\n", pg_last_error ());
    else if (status != PG_OK) fprintf (stderr, "perigal converge: %s\n", pg_last_error ());
    if (status == PG_E_USAGE) command_usage (stderr, "converge");
    for (size_t k = 0; list && k < CONVERGE_STUDIES; k++) pg_free (list[k].list);
    pg_free (list);
    return exit_code (status);
}
