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

/* options shared by run and check */
typedef struct { const char *scene, *folder, *set[64]; size_t nset; int threads, quiet; } command;
int command_parse (command *c, int argc, char **argv);       /* 0 or EXIT_USAGE (message printed)                         */
int exit_code     (pg_status status);
#endif
