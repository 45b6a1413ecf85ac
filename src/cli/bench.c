/* SPDX-License-Identifier: GPL-3.0-or-later
 * perigal bench: scenes x methods x sizes, each run a process of its own, repeated, measured against the
 * scene's reference. */
#include "cli.h"
#include "spawn.h"
#include "bench.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

int bench_split (bench_words *out, const char *text)
{
    memset (out, 0, sizeof *out);
    out->given = 1;
    for (const char *s = text;; s++) {
        size_t n = strcspn (s, ",");
        if (n == 0 || n >= BENCH_TEXT || out->n >= BENCH_WORDS) return 0;
        snprintf (out->word[out->n++], BENCH_TEXT, "%.*s", (int) n, s);
        s += n;
        if (!*s) return 1;
    }
}

/* ---- command line -------------------------------------------------------------------------------------- */
static const char basis_names[] = "linear|quadratic", cell_names[] = "cut|staircase";
static const char *bases (void) { return basis_names; }
static const char *cell_kinds (void) { return cell_names; }

typedef struct { const char *option; bench_words *words; const char *(*names) (void); } list_option;

static int is_one_of (const char *word, const char *names)
{
    size_t n = strlen (word);
    for (const char *s = names; *s; s += strcspn (s, "|"), s += *s == '|')
        if (strcspn (s, "|") == n && strncmp (s, word, n) == 0) return 1;
    return 0;
}

static pg_status read_list (const list_option *o, const char *value)
{
    pg_status status = PG_OK;
    if (!bench_split (o->words, value))
        PG_FAIL (PG_E_USAGE, "%s %s: expected words separated by commas, at most %d", o->option, value,
                 BENCH_WORDS);
    for (size_t k = 0; o->names && k < o->words->n; k++) {
        const char *word = o->words->word[k], *near;
        if (is_one_of (word, o->names ())) continue;
        near = pg_nearest_name (word, o->names ());
        PG_FAIL (PG_E_USAGE, "%s %s: there is no such entry%s%s%s", o->option, word,
                 near ? " (did you mean " : "", near ? near : "", near ? "?)" : "");
    }
done:
    return status;
}

static pg_status read_count (int *out, const char *name, const char *text, long most)
{
    pg_status status = PG_OK;
    char *end;
    long n = strtol (text, &end, 10);
    if (end == text || *end || n < 1 || n > most)
        PG_FAIL (PG_E_USAGE, "%s %s: a number from 1 to %ld is needed", name, text, most);
    *out = (int) n;
done:
    return status;
}

static pg_status read_option (bench_request *q, const char *name, const char *value)
{
    pg_status status = PG_OK;
    const list_option lists[] = {
        { "--force", &q->force, pg_force_names }, { "--approximation", &q->approximation, pg_approx_names },
        { "--basis", &q->basis, bases },          { "--integration", &q->integration, pg_integration_names },
        { "--cells", &q->cells, cell_kinds },     { "--spacing", &q->spacing, NULL },
        { "--perturb", &q->perturb, NULL },       { "--horizon", &q->horizon, NULL },
        { "--fem-element", &q->element, NULL },   { "--fem-size", &q->size, NULL },
        { "--mesh-size", &q->mesh, NULL }
    };
    char all[512] = "--set|--repeat|--out|--threads|--fem|--quiet";
    for (size_t k = 0; k < sizeof lists / sizeof *lists; k++) {
        size_t n = strlen (all);
        snprintf (all + n, sizeof all - n, "|%s", lists[k].option);
        if (strcmp (name, lists[k].option) != 0) continue;
        if (!value) PG_FAIL (PG_E_USAGE, "%s needs a list", name);
        q->fem |= strncmp (name, "--fem", 5) == 0;
        return read_list (&lists[k], value);
    }
    if (!is_one_of (name, all)) {
        const char *near = pg_nearest_name (name, all);
        PG_FAIL (PG_E_USAGE, "there is no option %s%s%s%s", name, near ? " (did you mean " : "",
                 near ? near : "", near ? "?)" : "");
    }
    if (!value) PG_FAIL (PG_E_USAGE, "%s needs a value", name);
    if (strcmp (name, "--out") == 0) q->folder = value;
    else if (strcmp (name, "--repeat") == 0) PG_TRY (read_count (&q->repeat, name, value, 100));
    else if (strcmp (name, "--threads") == 0) PG_TRY (read_count (&q->threads, name, value, 64));
    else if (!strchr (value, '=')) PG_FAIL (PG_E_USAGE, "--set %s: KEY=VALUE is needed", value);
    else if (q->nset >= TRIAL_SETS / 2) PG_FAIL (PG_E_USAGE, "--set: at most %d times", TRIAL_SETS / 2);
    else q->set[q->nset++] = value;
done:
    return status;
}

static pg_status read_arguments (bench_request *q, int argc, char **argv)
{
    pg_status status = PG_OK;
    memset (q, 0, sizeof *q);
    q->repeat = q->threads = 1, q->folder = "out/bench";
    char unquoted[1200];
    if (command_unquoted (unquoted, sizeof unquoted, argc, argv)) PG_FAIL (PG_E_USAGE, "%s", unquoted);
    for (int k = 1; k < argc; k++) {
        const char *name = strcmp (argv[k], "-o") == 0   ? "--out"
                           : strcmp (argv[k], "-s") == 0 ? "--set"
                           : strcmp (argv[k], "-q") == 0 ? "--quiet"
                                                         : argv[k];
        if (strcmp (name, "--fem") == 0) q->fem = 1;
        else if (strcmp (name, "--quiet") == 0) q->quiet = 1;
        else if (name[0] == '-') {
            PG_TRY (read_option (q, name, k + 1 < argc ? argv[k + 1] : NULL));
            k++;
        } else if (q->nscene < BENCH_WORDS) q->scene[q->nscene++] = argv[k];
        else PG_FAIL (PG_E_USAGE, "at most %d scenes at once", BENCH_WORDS);
    }
    if (!q->nscene) q->scene[q->nscene++] = "data/textbook_cantilever/scene.yaml";
done:
    return status;
}

/* ---- runs ---------------------------------------------------------------------------------------------- */
static pg_status make_folders (const bench_request *q)
{
    char path[4096];
    snprintf (path, sizeof path, "%s/run", q->folder);
    return pg_folder_make (path);
}

static pg_status run_once (bench_case *c, const bench_request *q, trial *t)
{
    pg_status status = PG_OK;
    char folder[4096];
    trial_request run = { .scene = q->scene[c->scene], .folder = folder, .threads = q->threads };
    snprintf (folder, sizeof folder, "%s/run", q->folder);
    for (size_t k = 0; k < q->nset; k++) run.set[run.nset++] = q->set[k];
    for (size_t k = 0; k < c->nset; k++) run.set[run.nset++] = c->set[k];
    if (c->element[0] && !c->mesh[0]) PG_TRY (bench_mesh_set (c, q));
    if (c->mesh[0]) run.set[run.nset++] = c->mesh;
    PG_TRY (trial_run (t, &run));
done:
    return status;
}

static void tell_error (const char *name, double error)
{
    if (isnan (error)) printf ("  %s         -", name);
    else printf ("  %s %9.2e", name, error);
}

static void tell (const bench_case *c)
{
    const double *v = c->best.value;
    printf ("  %-22s %-34s", c->name, c->method);
    if (c->runs) {
        printf (" %8.0f dofs", v[TRIAL_DOFS]);
        tell_error ("L2", isnan (v[TRIAL_L2]) ? v[TRIAL_LINES] : v[TRIAL_L2]);
        tell_error ("energy", v[TRIAL_ENERGY]);
        printf ("  %7.2f s CPU  %5.0f MB\n", v[TRIAL_CPU], 1e-6 * v[TRIAL_PEAK]);
    } else printf (" %s\n", c->trouble);
    fflush (stdout);
}

/* A curve of which one size cannot be is left out at once; sizes that fail later only end with a note. */
static pg_status run_all (bench_cases *cases, const bench_request *q)
{
    pg_status status = PG_OK;
    for (int r = 0; r < q->repeat; r++)
        for (size_t k = 0; k < cases->n; k++) {
            bench_case *c = &cases->at[k];
            trial t;
            if (c->trouble[0]) {
                if (!q->quiet && r == 0) tell (c);
                continue;
            }
            pg_status outcome = c->fem ? bench_fem_run (c, q) : run_once (c, q, &t);
            if (outcome == PG_E_INTERRUPTED) PG_TRY (outcome);
            if (outcome != PG_OK) {
                snprintf (c->trouble, sizeof c->trouble, "%s: %s",
                          outcome == PG_E_SCENE ? "skipped" : "failed", pg_last_error ());
                for (size_t i = k + 1;
                     outcome == PG_E_SCENE && i < cases->n && cases->at[i].curve == c->curve; i++)
                    snprintf (cases->at[i].trouble, sizeof c->trouble, "skipped: see the size before");
            } else if (!c->fem && (!c->runs++ || t.value[TRIAL_CPU] < c->best.value[TRIAL_CPU])) c->best = t;
            if (!q->quiet && r == 0) tell (c);
        }
done:
    return status;
}

int pg_cli_bench (int argc, char **argv)
{
    pg_status status = PG_OK;
    bench_request *q = NULL;
    bench_cases cases = { 0 };
    if (argc > 1 && strcmp (argv[1], "--row") == 0) return trial_main (argc - 1, argv + 1);
    if (argc > 1 && strcmp (argv[1], "--fem-row") == 0) return bench_fem_main (argc - 1, argv + 1);
    for (int k = 1; k < argc; k++)
        if (strcmp (argv[k], "--help") == 0 || strcmp (argv[k], "-h") == 0)
            return command_usage (stdout, "bench") ? EXIT_DONE : EXIT_USAGE;
    PG_ALLOC (q, 1);
    PG_TRY (read_arguments (q, argc, argv));
    PG_TRY (make_folders (q));
    PG_TRY (bench_cases_make (&cases, q));
    PG_TRY (run_all (&cases, q));
    PG_TRY (bench_report (&cases, q));
done:
    if (status == PG_E_SCENE) fprintf (stderr, "%s\n", pg_last_error ());
    else if (status != PG_OK) fprintf (stderr, "perigal bench: %s\n", pg_last_error ());
    pg_free (cases.at);
    pg_free (q);
    return exit_code (status);
}
