/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: what a checkpoint of a result folder holds (resume.c), checkpoints of several processes that
 * shared a body, read together (parts_kept.c), and runs that go on from them (moved_run.c). */
#ifndef PG_RESUME_H
#define PG_RESUME_H
#include "results_private.h"

/* ---- resume.c ------------------------------------------------------------------------------------------ */
/* A checkpoint that is being written or read. */
typedef struct {
    pg_result *r;
    pg_state  *state;
    const char *path;
    int        anywhere;                               /* 1: whoever wrote it, it is read */
    /* Where the files are to be cut. */
    result_marks now;
    long       rounds, is_pending, threads;
    /* Seconds that the run has taken so far. */
    double     seconds;
    pg_step    pending;
    /* Broken bonds (pending.nbroken) and reactions, N (PG_REACTIONS a load), of the pending step: own
     * memory, since
     * the same calls that write them also read them, and a step lends its arrays as constant. */
    pg_broken *broken;  double *reaction;
} resumed;
/* Version, scene and files are those of this run. */
pg_status resumed_identity (resumed *m, const pg_keeper *k);
/* What all processes of a run know alike of its files: counters, marks, curve, lengths of cracks. */
pg_status resumed_files    (resumed *m, const pg_keeper *k);
/* The whole of a checkpoint (pg_keep). */
pg_status resumed_all      (void *context, const pg_keeper *k);
/* Takes over what the marks say of the last fields. */
void      resumed_marks    (pg_result *r, const result_marks *at);
/* Opens tables and fields, cut to the marks, and writes what was due. */
pg_status resumed_go_on    (pg_result *r, resumed *m);
/* The number of a checkpoint, the processes of the run (1: alone), whose rank wrote it, and whether they
 * divided the body; number -1: there is none, or it is not whole. */
typedef struct { double number; int count, rank, divided; } resumed_by;
resumed_by resumed_who     (const char *path);

/* ---- parts_kept.c -------------------------------------------------------------------------------------- */

/* A point by its number, and which of the points held here it is. */
typedef struct { int64_t number; size_t at; } parts_number;
typedef struct {
    char     folder[3200];                             /* the result folder, that of the first process */
    int      count, divided;  /* checkpoints that are read; 1: each had a part of the points, 0: all */
    int      ranks;                                    /* processes that the run had */
    signed char *fresh;                                /* per part: 1: it is still under its new name */
    const pg_problem *problem;
    pg_checkpoint **part;                              /* NULL: not open */
    signed char *used;                                 /* per part: 1: some point held here may be in it */
    /* Of each point held here: the part that owned it, which of the points of that part it is, and which of
     * those that it owned. */
    int     *file;  size_t *at, *among;
    parts_number *number[PG_BOND_SETS];  size_t n[PG_BOND_SETS];       /* ascending */
} parts_kept;

/* What a checkpoint says of its points and their bonds; at: the state when the last step was made. */
pg_status parts_keep  (const pg_problem *problem, const pg_state *at, const pg_keeper *keeper);
/* The checkpoint of a part in the folder of the first, or the new one beside it. */
void      parts_path  (char *out, size_t size, const char *folder, int part, int fresh);
/* folder, count, divided and fresh are there. All ranks call. PG_E_USAGE: of other points. */
pg_status parts_open  (parts_kept *parts, const pg_problem *problem);
void      parts_close (parts_kept *parts);
pg_moved  parts_moved (parts_kept *parts);
/* A field of a moment that those before have written, at the points owned here. */
pg_status parts_field (const parts_kept *parts, const pg_writer *writer, long moment, const char *name,
                       size_t components, double *value /* owned points x components */);

/* ---- moved_run.c --------------------------------------------------------------------------------------- */
/* Fills in folder, count, divided, fresh and ranks of the newest checkpoint that is whole, whoever wrote it;
 * count 0: there is none. folder: of this process. All ranks call. */
pg_status moved_find   (parts_kept *parts, const char *folder);
/* 1: by others than this process and those beside it. */
int       moved_from_others (const parts_kept *parts);
/* As pg_result_resume, of a run of others; out was prepared. */
pg_status moved_resume (pg_result *r, resumed *m, parts_kept *parts);
#endif
