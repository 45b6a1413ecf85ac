/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: contents of a checkpoint of a result folder (resume.c), checkpoints of several processes that
 * shared a body, read together (parts_kept.c), and runs that continue from them (moved_run.c). */
#ifndef PG_RESUME_H
#define PG_RESUME_H
#include "results_private.h"

/* ---- resume.c ------------------------------------------------------------------------------------------ */
/* A checkpoint that is being written or read. */
typedef struct {
    pg_result *r;
    pg_state  *state;
    const char *path;
    int        anywhere;                               /* 1: read it, whichever process wrote it */
    /* Lengths to which the files are to be cut. */
    result_marks now;
    long       rounds, is_pending, threads;
    /* Seconds that the run has taken so far. */
    double     seconds;
    pg_step    pending;
    /* Broken bonds (pending.nbroken) and reactions, N (PG_REACTIONS a load), of the pending step: own memory,
     * since the calls that write them also read them, and a step lends its arrays as constant. */
    pg_broken *broken;  double *reaction;
} resumed;
/* Writes version, scene and files of this run, or checks that those read are equal. */
pg_status resumed_identity (resumed *m, const pg_keeper *k);
/* Writes or reads what is equal for all processes of a run: counters, marks, curve, lengths of cracks. */
pg_status resumed_files    (resumed *m, const pg_keeper *k);
/* Writes or reads a whole checkpoint (pg_keep). */
pg_status resumed_all      (void *context, const pg_keeper *k);
/* Sets the counters of written fields from the marks. */
void      resumed_marks    (pg_result *r, const result_marks *at);
/* Opens tables and fields, cut to the marks, and writes what was due at the checkpoint. */
pg_status resumed_go_on    (pg_result *r, resumed *m);
/* Author of a checkpoint: its number, the number of processes of the run (1: alone), the rank that wrote it,
 * and 1 if they divided the body; number -1: there is none, or it is not complete. */
typedef struct { double number; int count, rank, divided; } resumed_by;
resumed_by resumed_who     (const char *path);

/* ---- parts_kept.c -------------------------------------------------------------------------------------- */

/* A point: its number in the whole body, and its index among the points held here. */
typedef struct { int64_t number; size_t at; } parts_number;
typedef struct {
    char     folder[3200];                             /* the result folder, that of the first process */
    int      count, divided;  /* checkpoints that are read; 1: each had a part of the points, 0: all */
    int      ranks;                                    /* processes that the run had */
    signed char *fresh;                                /* per part: 1: its file still has its new name */
    const pg_problem *problem;
    pg_checkpoint **part;                              /* NULL: not open */
    signed char *used;                                 /* per part: 1: some point held here may be in it */
    /* For each point held here: the part that owned it, its index among the points of that part, and its
     * index among those that the part owned. */
    int     *file;  size_t *at, *among;
    parts_number *number[PG_BOND_SETS];  size_t n[PG_BOND_SETS];       /* sorted by number */
} parts_kept;

/* Writes the points of a checkpoint and their bonds; at: the state when the last step was complete. */
pg_status parts_keep  (const pg_problem *problem, const pg_state *at, const pg_keeper *keeper);
/* Writes the path of the checkpoint of a part in the folder of the first process; fresh 1: of the new one
 * beside it. */
void      parts_path  (char *out, size_t size, const char *folder, int part, int fresh);
/* Opens the parts; folder, count, divided and fresh are set. All ranks call. PG_E_USAGE: they are of other
 * points. */
pg_status parts_open  (parts_kept *parts, const pg_problem *problem);
void      parts_close (parts_kept *parts);
pg_moved  parts_moved (parts_kept *parts);
/* Reads a field of a moment that the earlier processes have written, at the points owned here. */
pg_status parts_field (const parts_kept *parts, const pg_writer *writer, long moment, const char *name,
                       size_t components, double *value /* owned points x components */);

/* ---- moved_run.c --------------------------------------------------------------------------------------- */
/* Finds the newest complete checkpoint, whichever processes wrote it, and sets folder, count, divided, fresh
 * and ranks; count 0: there is none. folder: of this process. All ranks call. */
pg_status moved_find   (parts_kept *parts, const char *folder);
/* 1: the checkpoint was written by other processes than the present ones. */
int       moved_from_others (const parts_kept *parts);
/* Resumes a run of other processes, as pg_result_resume does for its own; *r was prepared. */
pg_status moved_resume (pg_result *r, resumed *m, parts_kept *parts);
#endif
