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
 * other ranks cannot know of, so that they would wait for it. */
int pg_cli_run_ranks (int argc, char **argv, int *together);
/* SCENE [--json] [--solve] [--spectrum] ...: reports the faults of a scene, or what a run of it would do
 * (check.c). */
int pg_cli_check (int argc, char **argv);
/* DIR [REFERENCE] ...: a result compared with a reference (compare.c). */
int pg_cli_compare (int argc, char **argv);
/* KIND [-o DIR]: writes a scene to start from (new.c). */
int pg_cli_new   (int argc, char **argv);
/* SCENE [-o PICTURE] [--csv FILE]: describes and draws the cracks of a scene, without a run (cracks.c). */
int pg_cli_cracks (int argc, char **argv);
/* list: prints the entries of all catalogues; help: prints the keys of the scene (inquiry.c). */
int pg_cli_list  (int argc, char **argv);
int pg_cli_help  (int argc, char **argv);
/* Measures error and cost of methods and sizes (bench.c). */
int pg_cli_bench (int argc, char **argv);
/* SCENE --set KEY=A,B,C ...: runs all combinations of values (sweep.c). */
int pg_cli_sweep (int argc, char **argv);
/* Finds orders of convergence (converge.c). */
int pg_cli_converge (int argc, char **argv);
/* One measurement, which bench and converge start in a new process (trial.c). */
int pg_cli_trial (int argc, char **argv);
int pg_cli_trial_of_mesh (int argc, char **argv);

/* Progress of a run on stderr: on a terminal one line that is overwritten and fits its width; otherwise a
 * line for every tenth of the run, and now and then one between (progress.c). */
typedef struct {
    /* Start of the run, and when a line was last written, s. */
    double start, last;
    /* Two earlier moments: time (s), share of the run done, events; the pace is measured since mark[0]. */
    struct { double at, share, events; } mark[2];
    /* tenths shown so far; 1: stderr is a terminal; 1: nothing is shown; 1: explicit time steps; 1: stages of
     * relaxation; 1: a first share is known. */
    int    tenth, tty, quiet, steps_in_time, staged, begun;
} progress;
/* Starts the display; settled: the options as the solver uses them, which say what a step is. */
void progress_start (progress *p, int quiet, const pg_solver_options *settled);
/* Shows a line if it is time. within = 1: the call comes between two iterations of a step that is not done,
 * whose numbers so far are in `step`. */
void progress_show (progress *p, const pg_progress *at, const pg_step *step, const pg_statistics *report,
                    int within);
/* Removes the line from the terminal. */
void progress_end   (progress *p);

/* Handles signals from now on: run_asked_to_stop returns the number of the signal that asked this process to
 * stop, 0 if there was none. A second one of its kind, half a second later or more, ends the process
 * (stop_signals.c). */
void run_listen        (void);
int  run_asked_to_stop (void);
/* Called when the result folder exists: from then on a signal must leave the folder in order; earlier ones
 * end the process at once. */
void run_opens         (void);
/* 1: a signal that comes now belongs to the request that came at time `since` (CLOCK_MONOTONIC). */
int  command_same_request (const struct timespec *since);
/* From now on SIGINT, SIGTERM and SIGHUP are counted, for studies of many runs (stops.c). */
const volatile sig_atomic_t *command_stops (void);
/* Prints the usage of a command; 0: there is no such command (usage.c). */
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
/* Returns `code`, or if that is "done" and standard output could not be written, the exit code of a file
 * error (command.c). */
int       command_written (const char *program, int code);
int       command_threads (void);
/* Divides processors and memory among `jobs` processes: threads of each, and its memory limit as text.
 * threads, memory (bytes): what the command line asks for; 0: nothing (sweep.c). */
void      command_share (int jobs, int *threads, double memory, char text[32]);
/* Makes the runs of --seeds; returns the exit code (seeds.c). */
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
/* Prints to stderr the command that continues this run. */
void      command_again (const command *c);

/* What a run has before its first step (prepare.c). */
typedef struct {
    pg_scene   *scene;
    pg_forecast forecast;
    pg_problem *problem;
    pg_solver_options options;
    pg_solver  *solver;
    pg_state   *state;
} preparation;
/* From the reading of the scene on, this program sets the threads of libraries itself, those of BLAS
 * included. */
void      settle_blas_too (void);
/* Makes the problem from the scene, which the caller has loaded, and its patch test; fails where memory is
 * short. thorough: as in afford_problem. Where ranks share the body the forecast stays empty. */
pg_status prepare_problem (preparation *r, const command *c, int thorough);
/* Creates the solver, which sets the options that are left open. */
pg_status prepare_solver  (preparation *r);
/* Creates the first state, does all that a run does before the first step, and checks which results are asked
 * for. */
pg_status prepare_start   (preparation *r);
void      prepare_free    (preparation *r);

/* Bytes that the run may use: --memory, or what the machine grants (afford.c). */
double    afford_available (const command *c);
/* 1 for a mesh file so small that the run fits any machine, so that it is not worth reading twice for a
 * forecast. */
int       afford_tiny      (const pg_scene *scene);
/* Forecasts the memory from the scene, before anything large is built. PG_E_LIMIT: the run would need more
 * than there is; a wrong scene gives an empty forecast. */
pg_status afford_scene     (const command *c, pg_forecast *f);
/* Forecasts the memory from the built problem. PG_E_LIMIT: the run would need more than there is. thorough =
 * 1: the matrix is analysed in any case, not only when memory may be short. */
pg_status afford_problem (const command *c, pg_forecast *f, const pg_problem *p,
                          int thorough /* 1: analyse in any case */);

/* Plane waves of the scene's lattice (check_spectrum.c); symbol is NULL if --spectrum was not given. */
typedef struct { pg_symbol *symbol; pg_survey survey; char verdict[400]; } spectrum;
/* Measures the lattice and samples its waves; PG_E_USAGE without a lattice (symbol.h). */
pg_status spectrum_find  (spectrum *out, const pg_scene *scene, const pg_problem *p);
void      spectrum_free  (spectrum *spectrum);
void      spectrum_print (const spectrum *spectrum, const pg_problem *p);
void      spectrum_json  (pg_json *j, const spectrum *spectrum);
/* Writes spectrum.csv and spectrum.png into a folder. */
pg_status spectrum_write (const spectrum *spectrum, const pg_problem *p, const char *folder);

/* Writes the linear system of a scene as files of a folder; folder NULL: does nothing (check_matrix.c). */
pg_status matrix_write (const pg_problem *p, const pg_solver_options *o, const char *folder);

/* Runs check --ranks: prints what c->ranks processes would do with the scene (check_ranks.c); returns the
 * exit code. */
int       check_ranks (const command *c);

/* Prints a summary of the problem and the solver before a run (plan.c); doubts, empty before, gets the
 * warnings. */
void plan_print      (const pg_problem *p, const pg_solver_options *o, pg_statistics *doubts);
/* Everything that check has found out. available: memory, bytes; stable: time step of an explicit method, s,
 * and `from`, how it was found; NAN for other methods. */
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
    const pg_solver *solver;                           /* NULL: the body is too large to create one */
    int begun;                                         /* 1: all that precedes its first step was done */
    const pg_statistics *warned;                       /* warnings of a run before its first step */
} plan;
/* Number of points beyond which check leaves out what plan_untried names. */
#define PLAN_MOST_TRIED 3e5
#define plan_untried "shape functions, contact and the solver at the start"
/* Largest frequency (rad/s), stable time step (s), c_p dt / h of Newmark steps. measured 0: estimated, 1: by
 * --solve, 2: by the solver itself. */
typedef struct { double omega, dt, courant; int measured; } plan_times;
/* Largest frequency and stable time step, measured where that was done, else estimated. */
plan_times plan_times_of (const plan *p);
/* Lists the work that the run will skip, as far as that is known before; returns how many entries were
 * written. */
size_t plan_skips (const plan *p, pg_skip *skip, size_t most);
/* Print all that check has found out: at length for people, and as JSON for programs. */
void plan_print_long (const plan *p);
pg_status plan_print_json (const plan *p);
/* Prints what `write` puts into the JSON file `path`. */
pg_status json_to_stdout (pg_status (*write) (const void *what, const char *path), const void *what);
/* Prints the mesh of a body, if it has one (plan_mesh.c). */
void plan_mesh       (const pg_problem *p);
void plan_mesh_json  (pg_json *j, const pg_problem *p);
/* Prints which parts of the mesh file are not used. */
void plan_passed     (const pg_problem *p);
/* Prints the cracks of the scene (plan_network.c); nothing if there are none. */
void plan_network      (const pg_crack_statistics *network);
/* Prints what the solver has set: time steps, stages. */
void plan_settled     (const pg_solver *solver);
/* Prints the warnings of a report that `before` does not have (NULL: all). */
void plan_warnings   (const pg_statistics *report, const pg_statistics *before);
/* Prints new warnings of a report on stderr and nothing else, for runs with --quiet. */
void plan_quiet_warnings (const pg_statistics *report, const pg_statistics *before);
#endif
