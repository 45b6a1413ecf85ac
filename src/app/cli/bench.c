/* SPDX-License-Identifier: GPL-3.0-or-later
 * perigal bench: the command line of benchmarks (study.h): scenes, lists of methods and sizes
 * to combine, repeats. Lists of catalogue entries are checked here, so that a misspelt name
 * does not end a benchmark after an hour. The options --row and --fem-row are for the
 * processes that a benchmark starts (trial.c). */
#include "app/cli/preparation/cli.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- command line -------------------------------------------------------------------------------------- */
static const char basis_names[] = "linear|quadratic", cell_names[] = "cut|staircase";
static const char *bases (void) { return basis_names; }
static const char *cell_kinds (void) { return cell_names; }

/* A list option: array of its words, and the names that are allowed (NULL: any). */
typedef struct { const char *option; pg_word_list *words; const char *(*names) (void); } list_option;

/* 1 if the word is in "a|b|c", as a whole word. */
static int is_one_of (const char *word, const char *names)
{
    size_t n = strlen (word);
    for (const char *s = names; *s; s += strcspn (s, "|"), s += *s == '|')
        if (strcspn (s, "|") == n && strncmp (s, word, n) == 0) return 1;
    return 0;
}

/* Cuts the value of a list option and checks each word against the names that are allowed; the
 * message offers the nearest one. */
static pg_status read_list (const list_option *o, const char *value)
{
    pg_status status = PG_OK;
    if (!pg_word_list_split (o->words, value))
        PG_FAIL (PG_E_USAGE, "%s %s: expected at most %d words separated by commas", o->option, value,
                 PG_LIST_WORDS);
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

/* Reads an integer from 1 to `most`; the whole text must be one. */
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

/* Reads one option with its value: options with lists first, from a table, then the others. Options of
 * CalculiX (--fem-...) switch it on. */
static pg_status read_option (pg_bench_request *q, const char *name, const char *value)
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
        PG_FAIL (PG_E_USAGE, "unknown option %s%s%s%s", name, near ? " (did you mean " : "",
                 near ? near : "", near ? "?)" : "");
    }
    if (!value) PG_FAIL (PG_E_USAGE, "%s needs a value", name);
    if (strcmp (name, "--out") == 0) q->folder = value;
    else if (strcmp (name, "--repeat") == 0) PG_TRY (read_count (&q->repeat, name, value, 100));
    else if (strcmp (name, "--threads") == 0) PG_TRY (read_count (&q->threads, name, value, 64));
    else if (!strchr (value, '=')) PG_FAIL (PG_E_USAGE, "--set %s: KEY=VALUE is needed", value);
    else if (q->nset >= PG_TRIAL_SETS / 2) PG_FAIL (PG_E_USAGE, "--set: at most %d times", PG_TRIAL_SETS / 2);
    else q->set[q->nset++] = value;
done:
    return status;
}

/* Reads the command line: words that are no options are scenes. Without a scene the cantilever
 * of the textbook is taken, the default output folder is out/bench. */
static pg_status read_arguments (pg_bench_request *q, int argc, char **argv)
{
    pg_status status = PG_OK;
    memset (q, 0, sizeof *q);
    q->repeat = q->threads = 1, q->folder = "out/bench", q->out = stdout;
    char unquoted[1200];
    if (command_unquoted (unquoted, sizeof unquoted, argc, argv)) PG_FAIL (PG_E_USAGE, "%s", unquoted);
    for (int k = 1; k < argc; k++) {
        const char *name = strcmp (argv[k], "-o") == 0   ? "--out"
                           : strcmp (argv[k], "-s") == 0 ? "--set"
                           : strcmp (argv[k], "-q") == 0 ? "--quiet"
                                                         : argv[k];
        if (strcmp (name, "--fem") == 0) q->fem = 1;
        else if (strcmp (name, "--quiet") == 0) q->out = NULL;
        else if (name[0] == '-') {
            PG_TRY (read_option (q, name, k + 1 < argc ? argv[k + 1] : NULL));
            k++;
        } else if (q->nscene < PG_LIST_WORDS) q->scene[q->nscene++] = argv[k];
        else PG_FAIL (PG_E_USAGE, "at most %d scenes at once", PG_LIST_WORDS);
    }
    if (!q->nscene) q->scene[q->nscene++] = "data/textbook_cantilever/scene.yaml";
done:
    return status;
}

/* --row and --fem-row are what the processes of a benchmark are started with; they come first
 * and have a command line of their own. */
int pg_cli_bench (int argc, char **argv)
{
    pg_status status = PG_OK;
    pg_bench_request *q = NULL;
    if (argc > 1 && strcmp (argv[1], "--row") == 0) return pg_cli_trial (argc - 1, argv + 1);
    if (argc > 1 && strcmp (argv[1], "--fem-row") == 0) return pg_cli_trial_of_mesh (argc - 1, argv + 1);
    for (int k = 1; k < argc; k++)
        if (strcmp (argv[k], "--help") == 0 || strcmp (argv[k], "-h") == 0)
            return command_usage (stdout, "bench") ? PG_EXIT_DONE : PG_EXIT_USAGE;
    PG_ALLOC (q, 1);
    PG_TRY (read_arguments (q, argc, argv));
    PG_TRY (pg_bench_run (q));
done:
    if (status == PG_E_SCENE) fprintf (stderr, "%s\n", pg_last_error ());
    else if (status != PG_OK) fprintf (stderr, "perigal bench: %s\n", pg_last_error ());
    pg_free (q);
    return pg_exit_code (status);
}
