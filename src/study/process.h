/* SPDX-License-Identifier: GPL-3.0-or-later
 * process.h: another program (or this one again) as a process of its own, so that its seconds and its memory
 * are its own. */
#ifndef PG_STUDY_PROCESS_H
#define PG_STUDY_PROCESS_H
#include "perigal/base.h"

enum { PG_PROCESS_TEXT = 16384 };
typedef struct {
    int    code;  /* exit code; 128 + number of the signal that ended it */
    double wall, cpu;                                  /* s, of the process */
    size_t peak;  /* bytes resident, at least those of this process when it started */
    char   text[PG_PROCESS_TEXT];                           /* what it wrote to stdout, cut to size */
} pg_process;
/* program: found in PATH, or NULL: this program; argv as usual, argv[0] names it in messages. folder: where
 * it runs, NULL: here. log: file for stderr, overwritten; NULL: dropped. Runs on one thread unless threads >
 * 1 (OMP_NUM_THREADS and its like). PG_E_FILE: it could not be started. */
pg_status pg_process_run (pg_process *out, const char *program, char *const argv[], const char *folder,
                     const char *log, int threads);
int       pg_process_finds (const char *program);           /* 1: is in PATH */
/* First line of a log that says something, for messages; "" without one. */
void      pg_process_complaint (const char *log, char *text, size_t size);
#endif
