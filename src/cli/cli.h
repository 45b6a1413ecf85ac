/* SPDX-License-Identifier: GPL-3.0-or-later
 * The commands of perigal; each returns the exit code. */
#ifndef PERIGAL_CLI_H
#define PERIGAL_CLI_H
#include "perigal.h"

int pg_cli_run   (int argc, char **argv);
int pg_cli_check (int argc, char **argv);
int pg_cli_compare (int argc, char **argv);
int pg_cli_list  (int argc, char **argv);
int pg_cli_help  (int argc, char **argv);
int pg_cli_bench (int argc, char **argv);
int pg_cli_converge (int argc, char **argv);
/* trial.c: what bench and converge start */
int pg_cli_trial (int argc, char **argv);
int pg_cli_trial_of_mesh (int argc, char **argv);

/* progress.c: on a terminal one line that rewrites itself and fits; elsewhere a line every tenth, and now and
 * then between. */
typedef struct {
    double start, last;                                /* s; when a line was last written */
    struct { double at, share, events; } mark[2];      /* the pace is that since mark[0] */
    int    tenth, tty, quiet, steps_in_time, staged, begun;
} progress;
void progress_start (progress *p, int quiet, const pg_solver_options *settled);
/* within: between the rounds of a step that is not done yet, `step` so far. */
void progress_show (progress *p, const pg_progress *at, const pg_step *step, const pg_statistics *report,
                    int within);
void progress_end   (progress *p);

/* command.c: options shared by run and check */
typedef struct {
    const char *scene, *folder, *set[64];
    size_t nset;
    int threads, quiet, resume, force, json, solve, spectrum;
    double memory;
    const char *given;
} command;
/* -1: go on; else the exit code (message printed) */
int       command_parse (command *c, int argc, char **argv);
/* 1: what a value without its quotes left behind */
int       command_unquoted (char *out, size_t size, int argc, char **argv);
int       command_usage (FILE *to, const char *name);          /* 0: there is no such command */
/* a file that cannot be read counts as a wrong scene; may be partial */
pg_status command_scene (const command *c, pg_scene **scene);
/* with all faults at once */
pg_status command_problem (const command *c, const pg_scene *scene, pg_problem **problem,
                           pg_solver_options *o);
void      command_complain (pg_status status, const char *text);
void      command_again (const command *c);                    /* how to go on with this run, on stderr */

/* afford.c: PG_E_LIMIT where the run would need more than is available (--memory, else what the machine
 * grants). */
double    afford_available (const command *c);
/* a mesh file so small that the run fits any machine: not worth reading twice */
int       afford_tiny      (const pg_scene *scene);
pg_status afford_scene     (const command *c, pg_forecast *f); /* a wrong scene gives an empty forecast */
pg_status afford_problem (const command *c, pg_forecast *f, const pg_problem *p,
                          int thorough /* analyse whatever is free */);

/* check_spectrum.c: plane waves of the scene's lattice; symbol NULL: not asked for */
typedef struct { pg_symbol *symbol; pg_survey survey; char verdict[400]; } spectrum;
pg_status spectrum_find  (spectrum *out, const pg_scene *scene, const pg_problem *p);
void      spectrum_free  (spectrum *spectrum);
void      spectrum_print (const spectrum *spectrum, const pg_problem *p);
void      spectrum_json  (pg_json *j, const spectrum *spectrum);
/* spectrum.csv, spectrum.png */
pg_status spectrum_write (const spectrum *spectrum, const pg_problem *p, const char *folder);

/* plan.c */
void plan_print      (const pg_problem *p, const pg_solver_options *o);
/* stable: of an explicit method, s; else NAN */
typedef struct {
    const pg_problem *problem;
    const pg_solver_options *options;
    const pg_forecast *forecast;
    double available;
    const pg_first_break *first;
    const spectrum *waves;
    double stable;
    const char *from;
} plan;
/* rad/s, s stable, c_p dt / h of newmark */
typedef struct { double omega, dt, courant; int measured; } plan_times;
plan_times plan_times_of (const plan *p);
/* what the run will not do, as far as known */
size_t plan_skips (const plan *p, pg_skip *skip, size_t most);
void plan_print_long (const plan *p);
pg_status plan_print_json (const plan *p);
void plan_mesh       (const pg_problem *p);  /* plan_mesh.c: nothing without a mesh */
void plan_mesh_json  (pg_json *j, const pg_problem *p);
void plan_settled     (const pg_solver *solver);  /* what the solver has settled: time steps, stages */
void plan_doubts     (const pg_problem *p, const pg_solver_options *o);  /* warnings and notes of the scene */
#endif
