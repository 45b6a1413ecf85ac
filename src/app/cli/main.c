/* SPDX-License-Identifier: GPL-3.0-or-later
 * perigal: finds the command and starts it. Numbers of threads of the libraries (OpenBLAS, OpenMP) are set in
 * the environment before these are loaded, which happens when the first matrix is factored (base/library.c).
 * All else is in the files of the commands. */
#include "app/cli/preparation/cli.h"
#include "app/cli/plots/plot.h"
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* The commands, in the order of the usage. */
static const struct { const char *name; int (*run) (int, char **); const char *summary;
} commands[] = {
    { "run", pg_cli_run,
      "run SCENE.yaml [-o DIR] [--set KEY=VALUE]  solve a scene and write a result folder" },
    { "check", pg_cli_check,
      "check SCENE.yaml [--set KEY=VALUE]         validate a scene and show what a run would do" },
    { "plot", pg_cli_plot, "plot DIR [--field NAME] [--step N]         draw pictures from a result folder" },
    { "cracks", pg_cli_cracks,
      "cracks SCENE.yaml [-o FILE.png] [--csv FILE]  the cracks of a scene alone" },
    { "compare", pg_cli_compare,
      "compare DIR [REFERENCE]                    compare a result with a reference" },
    { "bench", pg_cli_bench,
      "bench [SCENE...] [--fem]                   error and cost of methods and sizes, also of CalculiX" },
    { "converge", pg_cli_converge,
      "converge SCENE.yaml [--m]                  orders of convergence of all results of a scene" },
    { "sweep", pg_cli_sweep,
      "sweep SCENE.yaml --set KEY=A,B,C [-j N]    all combinations of values, a table of them" },
    { "new", pg_cli_new, "new KIND [-o DIR]                          write a commented scene that runs" },
    { "list", pg_cli_list,
      "list                                       methods, kernels, criteria ... of this build" },
    { "help", pg_cli_help, "help [KEY | COMMAND | --manual | --schema] explain the keys of the scene file" },
};

/* Prints commands and exit codes. */
static void usage (FILE *to)
{
    fprintf (to, "Perigal " PG_VERSION
                 ": peridynamic Galerkin solver for brittle and quasi-brittle fracture\n\nusage:\n");
    for (size_t k = 0; k < sizeof commands / sizeof *commands; k++)
        fprintf (to, "  perigal %s\n", commands[k].summary);
    fprintf (to, "\nexit codes: 0 done, 64 wrong usage, 65 invalid scene, 70 failed (numerics, memory,\n"
                 "            files), 130 interrupted\n");
}

/* Returns the number that --threads gives; 0: it is not given, or 0. getopt_long, which reads the options
 * later, takes "--threads N", "--threads=N" and every abbreviation of the word that fits no other option; if
 * it is given twice the last one counts. */
static long threads_given (int argc, char **argv)
{
    static const char word[] = "--threads";
    long n = 0;
    for (int k = 2; k < argc && strcmp (argv[k], "--") != 0; k++) {
        size_t length = strcspn (argv[k], "=");
        if (length < 3 || length >= sizeof word || strncmp (argv[k], word, length) != 0) continue;
        if (argv[k][length] == '=') n = atol (argv[k] + length + 1);
        else if (k + 1 < argc) n = atol (argv[++k]);
    }
    return n > 0 ? n : 0;
}

/* Sets the environment so that OpenMP has one thread: the OpenMP threads of CHOLMOD only slow it down beside
 * a threaded BLAS, and OpenMP and BLAS read their limits from the environment when they are loaded. If
 * OMP_THREAD_LIMIT is set already, by the user or a program that started this one, nothing is done. */
static void settle_threads (int argc, char **argv)
{
    char count[16];
    long n = command_threads ();
    if (getenv ("OMP_THREAD_LIMIT")) return;
    settle_blas_too ();
    if (threads_given (argc, argv) > 0) n = threads_given (argc, argv);
    snprintf (count, sizeof count, "%ld", n < 1 ? 1 : n > 64 ? 64 : n);
    setenv ("OMP_THREAD_LIMIT", "1", 1);
    setenv ("OMP_WAIT_POLICY", "passive", 1);
    setenv ("OPENBLAS_NUM_THREADS", count, 0);
}

/* Finds the command, keeps freed memory in the process (pg_memory_keep) and runs it. Only run
 * and check (the first two commands) factor matrices and need the changed environment. */
int main (int argc, char **argv)
{
    if (argc < 2) {
        usage (stderr);
        return PG_EXIT_USAGE;
    }
    if (strcmp (argv[1], "--version") == 0) {
        printf ("perigal " PG_VERSION "\n");
        return command_written ("perigal", PG_EXIT_DONE);
    }
    if (strcmp (argv[1], "--help") == 0 || strcmp (argv[1], "-h") == 0) {
        usage (stdout);
        return command_written ("perigal", PG_EXIT_DONE);
    }
    for (size_t k = 0; k < sizeof commands / sizeof *commands; k++)
        if (strcmp (argv[1], commands[k].name) == 0) {
            if (k <= 1) settle_threads (argc, argv);
            pg_memory_keep ();
            return command_written ("perigal", commands[k].run (argc - 1, argv + 1));
        }
    const char *near =
        pg_nearest_name (argv[1], "run|check|plot|cracks|compare|bench|converge|sweep|new|list|"
                                 "help|--version|--help");
    fprintf (stderr, "perigal: unknown %s %s%s%s%s\n", argv[1][0] == '-' ? "option" : "command", argv[1],
             near ? " (did you mean " : "", near ? near : "", near ? "?)" : "");
    usage (stderr);
    return PG_EXIT_USAGE;
}
