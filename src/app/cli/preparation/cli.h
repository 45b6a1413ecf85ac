/* SPDX-License-Identifier: GPL-3.0-or-later
 * The commands of the program perigal. Each gets its own words (argv[0] is its name), prints
 * what a person should read, and returns the exit code: 0 done, 64 wrong use, 65 wrong scene,
 * 70 failed, 130 interrupted. What commands compute belongs to the library; here are command
 * lines, words and their order only. */
#ifndef PERIGAL_CLI_H
#define PERIGAL_CLI_H
#include "perigal.h"
#include <time.h>

/* SCENE [-o DIR] [--resume | --force] ...: solves and leaves a folder of results (run.c). */
int pg_cli_run   (int argc, char **argv);
/* pg_cli_run as one of several ranks (perigal/ranks.h). *together 0: this rank has failed in a way that the
 * others do not know of, and they wait for it. */
int pg_cli_run_ranks (int argc, char **argv, int *together);
/* SCENE [--json] [--solve] [--spectrum] ...: what is wrong with a scene, or what it amounts to
 * (check.c). */
int pg_cli_check (int argc, char **argv);
/* DIR [REFERENCE] ...: a result against what is known of it (compare.c). */
int pg_cli_compare (int argc, char **argv);
/* KIND [-o DIR]: a scene to start from (new.c). */
int pg_cli_new   (int argc, char **argv);
/* SCENE [-o PICTURE] [--csv FILE]: the cracks of a scene alone (cracks.c). */
int pg_cli_cracks (int argc, char **argv);
/* The entries of all catalogues; the keys of the scene (inquiry.c). */
int pg_cli_list  (int argc, char **argv);
int pg_cli_help  (int argc, char **argv);
/* Error and cost of methods and sizes (bench.c). */
int pg_cli_bench (int argc, char **argv);
/* SCENE --set KEY=A,B,C ...: all combinations of values (sweep.c). */
int pg_cli_sweep (int argc, char **argv);
/* Orders of convergence (converge.c). */
int pg_cli_converge (int argc, char **argv);
/* What bench and converge start in a new process (trial.c). */
int pg_cli_trial (int argc, char **argv);
int pg_cli_trial_of_mesh (int argc, char **argv);

/* How far a run is, on stderr: on a terminal one line that is written again and again and fits
 * its width; otherwise a line for every tenth of the run, and now and then one between
 * (progress.c). */
typedef struct {
    /* Start of the run, and when a line was last written, s. */
    double start, last;
    /* Two earlier moments; the pace is that since mark[0]. */
    struct { double at, share, events; } mark[2];
    /* tenths shown so far; stderr is a terminal; nothing is shown; explicit time steps; stages
     * of relaxation; a first share is known. */
    int    tenth, tty, quiet, steps_in_time, staged, begun;
} progress;
/* Begins; settled: the options as the solver has settled them, which say what a step is. */
void progress_start (progress *p, int quiet, const pg_solver_options *settled);
/* Shows a line if it is time. within = 1: between two rounds of a step that is not done, whose
 * numbers so far are in `step`. */
void progress_show (progress *p, const pg_progress *at, const pg_step *step, const pg_statistics *report,
                    int within);
/* Removes the line from the terminal. */
void progress_end   (progress *p);

/* From now on a signal that asks this process to stop is noted: its number, 0 while there was none; the
 * second one of its kind, half a second later or more, ends the process (signals.c). */
void run_listen        (void);
int  run_asked_to_stop (void);
/* There is a folder of results now, which a signal has to leave in order: until then it ends the process at
 * once. */
void run_opens         (void);
/* 1: a signal that comes now belongs to the request that came `since` then (CLOCK_MONOTONIC). */
int  command_same_request (const struct timespec *since);
/* From now on SIGINT, SIGTERM and SIGHUP are counted, for studies of many runs (stops.c). */
const volatile sig_atomic_t *command_stops (void);
/* usage.c: prints what a command says of itself; 0: there is no such command. */
int       command_usage (FILE *to, const char *name);

/* What the command line of run and check says (command.c). */
typedef struct {
    const char *scene, *folder, *matrix, *set[64];
    size_t nset;
    /* Options as flags; threads is never 0. */
    int threads, quiet, resume, force, json, solve, spectrum, echo;
    /* Processes of --ranks; 0: not given. */
    int ranks;
    /* Bytes of --memory; 0: not given. */
    double memory;
    /* Runs of --seeds, and how many at a time; 0: not given. */
    long seeds;
    int  jobs;
    /* The text of --threads, to repeat it in messages; NULL: not given. */
    const char *given;
} command;
/* Reads a command line; -1: go on, otherwise the exit code, the message being printed. */
int       command_parse (command *c, int argc, char **argv);
/* 1 if words follow a --set that belong to its value but lost their quotes; `out` gets the
 * message. */
int       command_unquoted (char *out, size_t size, int argc, char **argv);
/* The exit code of a program that ended with this one: what it printed must have been written (command.c). */
int       command_written (const char *program, int code);
int       command_threads (void);
/* Shares processors and memory among so many jobs: threads of each, and its limit of memory as text. threads,
 * memory: what was asked for, 0: nothing (sweep.c). */
void      command_share (int jobs, int *threads, double memory, char text[32]);
/* The runs of --seeds; returns the exit code (seeds.c). */
int       command_seeds (const command *c);
/* Loads the scene with the --set options. A file that cannot be read counts as a wrong scene.
 * The scene may be partial: it then has faults but can be looked at for more. */
pg_status command_scene (const command *c, pg_scene **scene);
/* Builds the problem and reads the options of the solver; all faults of the scene are reported
 * at once. */
pg_status command_problem (const command *c, const pg_scene *scene, pg_problem **problem,
                           pg_solver_options *o);
/* Prints a message to stderr. */
void      command_complain (pg_status status, const char *text);
/* Prints to stderr the command that goes on with this run. */
void      command_again (const command *c);

/* A run up to its first step (prepare.c). */
typedef struct {
    pg_scene   *scene;
    pg_forecast forecast;
    pg_problem *problem;
    pg_solver_options options;
    pg_solver  *solver;
    pg_state   *state;
} preparation;
/* The threads of libraries are this program's to settle: once the scene is read, also those of BLAS. */
void      settle_blas_too (void);
/* From the scene, which the caller has loaded, to the problem and its patch test; refused where memory is
 * short. thorough: afford_problem. Of ranks that share the body the forecast stays empty. */
pg_status prepare_problem (preparation *r, const command *c, int thorough);
/* The solver, which settles what the options leave open. */
pg_status prepare_solver  (preparation *r);
/* The state it starts from, all that it does before the first step, and what results are asked for. */
pg_status prepare_start   (preparation *r);
void      prepare_free    (preparation *r);

/* Bytes that the run may use: --memory, or what the machine grants (afford.c). */
double    afford_available (const command *c);
/* 1 for a mesh file so small that the run fits any machine: not worth reading twice. */
int       afford_tiny      (const pg_scene *scene);
/* PG_E_LIMIT if the run would need more memory than there is, judged from the scene before
 * anything large is built; a wrong scene gives an empty forecast. */
pg_status afford_scene     (const command *c, pg_forecast *f);
/* PG_E_LIMIT if the run would need more memory than there is, judged from the built problem. thorough = 1:
 * the matrix is analysed in any case, not only when memory may be short. */
pg_status afford_problem (const command *c, pg_forecast *f, const pg_problem *p,
                          int thorough /* analyse whatever is free */);

/* Plane waves of the scene's lattice (check_spectrum.c); symbol is NULL if they were not asked
 * for. */
typedef struct { pg_symbol *symbol; pg_survey survey; char verdict[400]; } spectrum;
/* Measures the lattice and samples its waves; PG_E_USAGE without a lattice (symbol.h). */
pg_status spectrum_find  (spectrum *out, const pg_scene *scene, const pg_problem *p);
void      spectrum_free  (spectrum *spectrum);
void      spectrum_print (const spectrum *spectrum, const pg_problem *p);
void      spectrum_json  (pg_json *j, const spectrum *spectrum);
/* Writes spectrum.csv and spectrum.png into a folder. */
pg_status spectrum_write (const spectrum *spectrum, const pg_problem *p, const char *folder);

/* The linear system of a scene as files of a folder, NULL: none (check_matrix.c). */
pg_status matrix_write (const pg_problem *p, const pg_solver_options *o, const char *folder);

/* check --ranks (check_ranks.c): what that many processes would do with the scene; returns the exit code. */
int       check_ranks (const command *c);

/* What a scene amounts to (plan.c): in short, before a run; doubts, empty before, gets the warnings. */
void plan_print      (const pg_problem *p, const pg_solver_options *o, pg_statistics *doubts);
/* Everything that check has found out. stable: time step of an explicit method, s, and where
 * it comes from; NAN for others. available: bytes. */
typedef struct {
    const pg_problem *problem;
    const pg_solver_options *options;
    const pg_forecast *forecast;
    double available;
    const pg_first_break *first;
    const spectrum *waves;
    double stable;
    const char *from;
    const pg_crack_statistics *network;
    const pg_solver *solver;                           /* NULL: the body is too large to try */
    int begun;                                         /* 1: all was done that comes before its first step */
    const pg_statistics *warned;                       /* what a run warns of before its first step */
} plan;
/* Beyond so many points check leaves out what it names here. */
#define PLAN_MOST_TRIED 3e5
#define plan_untried "shape functions, contact and the solver at the start"
/* Largest frequency (rad/s), stable time step (s), c_p dt / h of Newmark steps. measured: 0:
 * an estimate, 1: by --solve, 2: by the solver itself. */
typedef struct { double omega, dt, courant; int measured; } plan_times;
/* Largest frequency and stable time step, measured where that was done, else estimated. */
plan_times plan_times_of (const plan *p);
/* What the run will not do, as far as that is known before; returns how many entries were
 * written. */
size_t plan_skips (const plan *p, pg_skip *skip, size_t most);
/* Print all that check has found out: at length for people, and as JSON for programs. */
void plan_print_long (const plan *p);
pg_status plan_print_json (const plan *p);
/* Prints what `write` puts into the JSON file `path`. */
pg_status json_to_stdout (pg_status (*write) (const void *what, const char *path), const void *what);
/* The mesh of a body, if it has one (plan_mesh.c). */
void plan_mesh       (const pg_problem *p);
void plan_mesh_json  (pg_json *j, const pg_problem *p);
/* What of its file is not used. */
void plan_passed     (const pg_problem *p);
/* The cracks of the scene (plan_network.c); nothing without any. */
void plan_network      (const pg_crack_statistics *network);
/* What the solver has settled: time steps, stages. */
void plan_settled     (const pg_solver *solver);
/* Prints the warnings of a report that `before` does not have (NULL: all). */
void plan_warnings   (const pg_statistics *report, const pg_statistics *before);
/* Prints new warnings of a report alone, on stderr, in runs that print nothing else. */
void plan_quiet_warnings (const pg_statistics *report, const pg_statistics *before);
#endif
