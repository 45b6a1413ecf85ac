/* SPDX-License-Identifier: GPL-3.0-or-later
 * Runs another program, or this one again, as a process of its own, so that its seconds and its memory can be
 * measured. */
#ifndef PG_STUDY_PROCESS_H
#define PG_STUDY_PROCESS_H
#include "perigal/base.h"

enum { PG_PROCESS_TEXT = 16384 };
/* Results of a process that has ended. */
typedef struct {
    /* Exit code; 128 + number of the signal that ended it. */
    int    code;
    /* Seconds on the clock, and CPU seconds of all its threads. */
    double wall, cpu;
    /* Largest resident memory, bytes; at least that of this process when it started the other. */
    size_t peak;
    /* What it wrote to stdout, cut to this size. */
    char   text[PG_PROCESS_TEXT];
} pg_process;
/* Runs a program to its end. program: found in PATH, or NULL for this program; argv[0] names it in messages.
 * folder: current folder of the process, NULL: that of this one. log: file for stderr, overwritten; NULL:
 * dropped. Its libraries get `threads` threads (at least one). PG_E_FILE: cannot be started;
 * PG_E_INTERRUPTED: it was interrupted (SIGINT). */
pg_status pg_process_run (pg_process *out, const char *program, const char *const argv[], const char *folder,
                     const char *log, int threads);
/* Another process of this program, which runs at the same time; pg_child_ended tells whether it has ended. */
typedef struct {
    long   id;
    double start;
    /* Exit code (128 + signal that ended it); seconds on the clock, CPU seconds; largest memory, bytes. */
    int    code;
    double wall, cpu;
    size_t peak;
} pg_child;
/* Starts a child; arguments as in pg_process_run, what it writes to stdout is dropped. It belongs to a group
 * of its own, so that an interrupt typed at a terminal reaches this process only, which passes it on
 * (pg_child_signal); if this process is killed, the child is asked to stop (SIGTERM). PG_E_FILE, PG_E_MEMORY:
 * it cannot be started. */
pg_status pg_child_start  (pg_child *out, const char *const argv[], const char *log, int threads);
/* 1 once the child has ended; then code, wall, cpu and peak are set. Never waits. */
int       pg_child_ended  (pg_child *child);
/* Sends a signal to the child. */
void      pg_child_signal (const pg_child *child, int number);
/* 1 if a program of that name is in PATH. */
int       pg_process_finds (const char *program);
/* First line of a log that is not empty and no warning of a run, for messages; "" without one. */
void      pg_process_complaint (const char *log, char *text, size_t size);
#endif
