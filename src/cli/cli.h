/* SPDX-License-Identifier: GPL-3.0-or-later
 * The commands of perigal; each returns the exit code. */
#ifndef PERIGAL_CLI_H
#define PERIGAL_CLI_H
#include "perigal.h"

enum { EXIT_DONE = 0, EXIT_USAGE = 64, EXIT_SCENE = 65, EXIT_FAILED = 70, EXIT_INTERRUPTED = 130 };
int pg_cli_run   (int argc, char **argv);
int pg_cli_check (int argc, char **argv);
int pg_cli_list  (int argc, char **argv);
int pg_cli_help  (int argc, char **argv);

/* progress.c: a line that rewrites itself on a terminal, every tenth elsewhere. */
typedef struct { double start, last; int tenth, tty, quiet; } progress;
void progress_start (progress *p, int quiet);
void progress_show  (progress *p, double share, const pg_step *step, const pg_report *report);
void progress_end   (progress *p);

/* command.c: options shared by run and check */
typedef struct { const char *scene, *folder, *set[64]; size_t nset; int threads, quiet; } command;
int       command_parse (command *c, int argc, char **argv);   /* -1: go on; else the exit code (message printed)         */
int       command_usage (FILE *to, const char *name);          /* 0: there is no such command                             */
pg_status command_scene (const command *c, pg_scene **scene);  /* a file that cannot be read counts as a wrong scene      */
void      command_complain (pg_status status, const char *text);
int       exit_code     (pg_status status);

/* plan.c */
void plan_print      (const pg_problem *p, const pg_solver_options *o);
void plan_print_long (const pg_problem *p, const pg_solver_options *o);
void plan_doubts     (const pg_problem *p, const pg_solver_options *o, FILE *to);
#endif
