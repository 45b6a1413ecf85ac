/* SPDX-License-Identifier: GPL-3.0-or-later
 * Options that run and check share, and how a scene becomes a problem for them.
 *
 * Conventions of all commands: long options, with a short form for the most usual ones; a
 * wrong option or value ends with a message that says what is allowed, usually with the
 * nearest name for a misspelt one, and with exit code 64; messages go to stderr, results to
 * stdout. Nothing is asked interactively, so that every command works in scripts. */
#include "cli.h"
#include <errno.h>
#include <getopt.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Reads --threads N, 0 to 64; 0 means one for each processor. The text is kept for command_again. */
static int read_threads (command *c, const char *text)
{
    char *end;
    long n = strtol (text, &end, 10);
    if (end == text || *end || n < 0 || n > 64) {
        fprintf (stderr, "perigal: --threads %s: a number from 0 (all) to 64 is needed\n", text);
        return PG_EXIT_USAGE;
    }
    c->threads = (int) n, c->given = text;
    return -1;
}

/* Returns the bytes of "8GB", "500 MB", "1.5 GiB" or "1e9"; NAN for anything else. Units with an i are powers
 * of 1024, others powers of 1000. */
static double size_of (const char *text)
{
    static const struct { const char *unit; double size; } units[] = {
        { "", 1 }, { "B", 1 }, { "kB", 1e3 }, { "KB", 1e3 }, { "MB", 1e6 }, { "GB", 1e9 }, { "TB", 1e12 },
        { "k", 1e3 }, { "K", 1e3 }, { "M", 1e6 }, { "G", 1e9 }, { "T", 1e12 },
        { "KiB", 1024 }, { "MiB", 1048576 }, { "GiB", 1073741824 }, { "TiB", 1099511627776 } };
    char *end;
    double v = strtod (text, &end);
    if (end == text || !(v > 0) || !isfinite (v)) return NAN;
    while (*end == ' ') end++;
    for (size_t k = 0; k < sizeof units / sizeof *units; k++)
        if (strcmp (end, units[k].unit) == 0) return v * units[k].size;
    return NAN;
}

/* Reads --memory SIZE: a run that needs more is refused. */
static int read_memory (command *c, const char *text)
{
    c->memory = size_of (text);
    if (c->memory > 0) return -1;
    fprintf (stderr, "perigal: --memory %s: a size is needed, such as 500MB or 8GB\n", text);
    return PG_EXIT_USAGE;
}

/* Reads --seeds N: number of runs with different seeds. */
static int read_seeds (command *c, const char *text)
{
    char *end;
    c->seeds = strtol (text, &end, 10);
    if (end != text && !*end && c->seeds >= 1 && c->seeds <= PG_SERIES_RUNS) return -1;
    fprintf (stderr, "perigal: --seeds %s: a number of runs from 1 to %d is needed\n", text, PG_SERIES_RUNS);
    return PG_EXIT_USAGE;
}

/* Reads -j N: number of runs of --seeds at a time. */
static int read_jobs (command *c, const char *text)
{
    char *end;
    long n = strtol (text, &end, 10);
    c->jobs = (int) n;
    if (end != text && !*end && n >= 1 && n <= 64) return -1;
    fprintf (stderr, "perigal: --jobs %s: a number from 1 to 64 is needed\n", text);
    return PG_EXIT_USAGE;
}

/* Reads --ranks N: number of processes whose work check foretells. */
static int read_ranks (command *c, const char *text)
{
    enum { MOST = 1000000 };
    char *end;
    long n = strtol (text, &end, 10);
    if (end != text && !*end && n >= 1 && n <= MOST) {
        c->ranks = (int) n;
        return -1;
    }
    fprintf (stderr, "perigal: --ranks %s: a number of processes from 1 to %d is needed\n", text, MOST);
    return PG_EXIT_USAGE;
}

/* Reads --set KEY=VALUE, at most 64 times; the key is checked when the scene is loaded. */
static int read_set (command *c, const char *text)
{
    if (c->nset >= sizeof c->set / sizeof *c->set || !strchr (text, '=')) {
        fprintf (stderr, "perigal: --set %s: KEY=VALUE is needed, at most %zu times\n", text,
                 sizeof c->set / sizeof *c->set);
        return PG_EXIT_USAGE;
    }
    c->set[c->nset++] = text;
    return -1;
}

/* Reports an unknown option or one without its value: names the nearest option of this command and prints its
 * usage. Returns the exit code. */
static int refuse (const char *name, int option, const char *argument)
{
    if (option == ':') fprintf (stderr, "perigal %s: %s needs a value\n", name, argument);
    else {
        const char *near =
            pg_nearest_name (argument,
                             strcmp (name, "check") == 0
                                 ? "--json|--solve|--spectrum|--echo|--matrix|--ranks|--out|--threads|"
                                   "--memory|--plain|--set|--quiet|--help"
                                 : "--out|--resume|--force|--threads|--memory|--plain|--set|--seeds|--jobs|"
                                   "--quiet|"
                                   "--help");
        fprintf (stderr, "perigal %s: unknown option %s%s%s%s\n", name, argument,
                 near ? " (did you mean " : "", near ? near : "", near ? "?)" : "");
    }
    command_usage (stderr, name);
    return PG_EXIT_USAGE;
}

/* 1 for a file that exists or whose name ends like that of a scene, so that the scene after a --set is not
 * taken for a part of its value. */
static int is_scene (const char *word)
{
    const char *dot = strrchr (word, '.');
    return access (word, F_OK) == 0 || (dot && (strcmp (dot, ".yaml") == 0 || strcmp (dot, ".yml") == 0));
}

/* Finds a --set value whose quotes are missing: shells split --set method.horizon=2.5 spacing at the blank.
 * Words after a --set that are neither options nor files are taken for the rest of the value, and the message
 * shows the line with quotes. Returns 0 if there are none. */
int command_unquoted (char *out, size_t size, int argc, char **argv)
{
    for (int k = 1; k + 1 < argc; k++) {
        int joined = strncmp (argv[k], "--set=", 6) == 0,
            apart = strcmp (argv[k], "--set") == 0 || strcmp (argv[k], "-s") == 0;
        int first = k + 1 + apart, last = first;
        if (!joined && !apart) continue;
        while (last < argc && argv[last][0] != '-' && !is_scene (argv[last])) last++;
        if (first >= argc || last == first) continue;
        size_t n = (size_t) snprintf (
            out, size, "'%.60s' is not a file: a value with blanks needs quotes: --set '%.200s", argv[first],
            joined ? argv[k] + 6 : argv[k + 1]);
        for (int i = first; i < last && n < size; i++)
            n += (size_t) snprintf (out + n, size - n, " %.100s", argv[i]);
        if (n < size) snprintf (out + n, size - n, "'");
        return 1;
    }
    return 0;
}

/* 1: the option belongs to the command. run and check share all options but --force, --seeds, --jobs of run,
 * and --json, --solve, --spectrum, --echo, --matrix, --ranks of check. */
static int belongs_to (int option, const char *name)
{
    int checks = strcmp (name, "check") == 0;
    return strchr ("fnj", option) ? !checks : checks || !strchr ("kvweMR", option);
}

/* Reads one option of run or check; -1: go on, else the exit code. */
static int read_option (command *c, const char *name, int option, const char *word)
{
    if (!belongs_to (option, name)) return refuse (name, option, word);
    switch (option) {
    case 'h': command_usage (stdout, name); return PG_EXIT_DONE;
    case 'o': c->folder = optarg; return -1;
    case 't': return read_threads (c, optarg);
    case 's': return read_set (c, optarg);
    case 'm': return read_memory (c, optarg);
    case 'q': c->quiet = 1; return -1;
    case 'p': return read_set (c, "solver.plain=on");
    case 'r': c->resume = 1; return -1;
    case 'f': c->force = 1; return -1;
    case 'k': c->json = 1; return -1;
    case 'v': c->solve = 1; return -1;
    case 'w': c->spectrum = 1; return -1;
    case 'n': return read_seeds (c, optarg);
    case 'j': return read_jobs (c, optarg);
    case 'e': c->echo = 1; return -1;
    case 'M': c->matrix = optarg; return -1;
    case 'R': return read_ranks (c, optarg);
    default: return refuse (name, option, word);
    }
}

/* Reads the command line. getopt_long changes the order of the words, so missing quotes are looked for before
 * it. opterr = 0: the messages are our own. Without --threads all processors are used. */
int command_parse (command *c, int argc, char **argv)
{
    static const struct option options[] = {
        { "out", required_argument, NULL, 'o' }, { "threads", required_argument, NULL, 't' },
        { "set", required_argument, NULL, 's' }, { "resume", no_argument, NULL, 'r' },
        { "force", no_argument, NULL, 'f' },     { "memory", required_argument, NULL, 'm' },
        { "json", no_argument, NULL, 'k' },      { "solve", no_argument, NULL, 'v' },
        { "spectrum", no_argument, NULL, 'w' },  { "quiet", no_argument, NULL, 'q' },
        { "seeds", required_argument, NULL, 'n' }, { "jobs", required_argument, NULL, 'j' },
        { "matrix", required_argument, NULL, 'M' }, { "ranks", required_argument, NULL, 'R' },
        { "plain", no_argument, NULL, 'p' },     { "echo", no_argument, NULL, 'e' },
        { "help", no_argument, NULL, 'h' },      { NULL, 0, NULL, 0 }
    };
    char unquoted[1200];
    int lost = command_unquoted (unquoted, sizeof unquoted, argc, argv);
    memset (c, 0, sizeof *c);
    optind = 1, opterr = 0;
    for (int k; (k = getopt_long (argc, argv, ":o:qs:hj:", options, NULL)) != -1;) {
        int code = read_option (c, argv[0], k, argv[optind - 1]);
        if (code >= 0) return code;
    }
    if (lost) {
        fprintf (stderr, "perigal: %s\n", unquoted);
        return PG_EXIT_USAGE;
    }
    if (optind + 1 != argc) {
        fprintf (stderr, "perigal: %s needs exactly one scene file\n", argv[0]);
        command_usage (stderr, argv[0]);
        return PG_EXIT_USAGE;
    }
    if (c->force && c->resume) {
        fprintf (stderr,
                 "perigal: --resume and --force exclude each other: continue the run, or start it anew\n");
        return PG_EXIT_USAGE;
    }
    if (c->jobs && !c->seeds) {
        fprintf (stderr, "perigal: --jobs is for --seeds: one run is one job; --threads are its threads\n");
        return PG_EXIT_USAGE;
    }
    if (c->ranks && (c->solve || c->spectrum || c->matrix)) {
        fprintf (stderr, "perigal: --ranks does not go with --solve, --spectrum and --matrix, which are for "
                         "one process\n");
        return PG_EXIT_USAGE;
    }
    c->scene = argv[optind];
    if (c->threads < 1) c->threads = command_threads ();
    return -1;
}

/* Returns the number of threads if none is asked for: OMP_NUM_THREADS, by which users share a machine among
 * all their programs, or one per processor. */
int command_threads (void)
{
    const char *shared = getenv ("OMP_NUM_THREADS");
    long n = shared ? strtol (shared, NULL, 10) : 0;
    if (n < 1) n = sysconf (_SC_NPROCESSORS_ONLN);
    return n < 1 ? 1 : n > 64 ? 64 : (int) n;
}

/* Loads the scene. A missing file counts as a wrong scene, so that both have the exit code 65. */
pg_status command_scene (const command *c, pg_scene **scene)
{
    pg_status status = pg_scene_load_some (scene, c->scene, c->nset, c->set);
    return status == PG_E_FILE ? PG_E_SCENE : status;
}

/* Builds the problem and reads solver options and output: each part looks for its faults even if others have
 * found some, and pg_scene_pass keeps them until pg_problem_complete reports all at once. */
pg_status command_problem (const command *c, const pg_scene *scene, pg_problem **problem,
                           pg_solver_options *o)
{
    pg_status status = PG_OK;
    if (pg_scene_partial (scene)) pg_result_check_names (scene);
    PG_TRY (pg_problem_prepare (problem, scene, c->threads));
    status = pg_solver_options_read (o, *problem, scene);
    pg_scene_pass (scene);
    if (status == PG_OK || status == PG_E_SCENE) status = pg_result_check (scene, *problem);
    pg_scene_pass (scene);
    if (status == PG_OK || status == PG_E_SCENE) status = pg_problem_complete (*problem, scene);
done:
    return status;
}

/* Prints a message. Faults of a scene begin with file and line, where editors find them; any other message
 * begins with the name of the program. */
void command_complain (pg_status status, const char *text)
{
    fprintf (stderr, "%s%s\n", status == PG_E_SCENE ? "" : "perigal: ", text);
}

/* Prints a word as the shell would take it, in single quotes where these are needed; a single quote inside is
 * written as '\''. */
static void put_word (const char *word)
{
    if (!*word || word[strcspn (word, " \t\n\"'\\$`!*?[](){}<>|&;#~")]) {
        fputc ('\'', stderr);
        for (; *word; word++) {
            if (*word == '\'') fputs ("'\\'", stderr);
            fputc (*word, stderr);
        }
        fputc ('\'', stderr);
    } else fputs (word, stderr);
}

/* Prints the command that continues the run. All options that change the run are repeated, so that it can be
 * copied. */
void command_again (const command *c)
{
    fputs ("perigal: continue with: ", stderr);
    if (pg_rank_count () > 1) fprintf (stderr, "mpirun -n %d perigal-mpi run ", pg_rank_count ());
    else fputs ("perigal run ", stderr);
    put_word (c->scene);
    if (c->folder) fputs (" -o ", stderr), put_word (c->folder);
    for (size_t k = 0; k < c->nset; k++) fputs (" --set ", stderr), put_word (c->set[k]);
    if (c->given) fprintf (stderr, " --threads %s", c->given);
    fputs (" --resume\n", stderr);
}

int command_written (const char *program, int code)
{
    if (fflush (stdout) == 0 && !ferror (stdout)) return code;
    fprintf (stderr, "%s: the output cannot be written: %s\n", program, strerror (errno ? errno : EIO));
    return code == PG_EXIT_DONE ? pg_exit_code (PG_E_FILE) : code;
}
