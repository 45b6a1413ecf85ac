/* SPDX-License-Identifier: GPL-3.0-or-later
 * results.h: the result folder of a run. It holds fields (result.e, or what output.format says),
 * history.csv (a row per step), events.csv (a row per broken bond), report.json (what the run
 * did), pictures, a copy of the scene, and while the run is unfinished checkpoint.nc. Which
 * fields, when, and which columns is decided here; how files are written is output.h.
 *
 * A folder belongs to one run at a time and is never overwritten silently: an unfinished run,
 * and a scene that the user put there, are protected. Everything written so far is readable
 * whatever ends the run. */
#ifndef PERIGAL_RESULTS_H
#define PERIGAL_RESULTS_H
#include "perigal/compare.h"
#include "perigal/output.h"
#include "perigal/solve.h"

PG_API_BEGIN

/* Reports errors of the section `output` of a scene that depend on the dimension of the problem, as errors of
 * the scene. pg_result_open does this as well. */
pg_status pg_result_check (const pg_scene *scene, const pg_problem *problem);
/* The part of pg_result_check that needs no problem: names of pictures that do not exist in this dimension.
 * Used by `perigal check` of a scene with other faults, too. */
void      pg_result_check_names (const pg_scene *scene);

/* ---- statistics of the cracks of a scene -------------------------------------------------------------- */
enum { PG_CRACK_SETS = 16 };
/* Statistics of all cracks, and, if there are several entries of `cracks` and one contains several cracks, of
 * each entry (0, 1, ...); at most 16. */
typedef struct {
    int        dim;
    pg_network all;
    size_t     nset;
    struct { size_t entry; pg_network of; } set[PG_CRACK_SETS];
} pg_crack_statistics;
/* Computes the statistics of the cracks of a scene (pg_network_read). */
pg_status pg_crack_statistics_measure (pg_crack_statistics *out, const pg_cracks *all,
                                       const pg_scene *scene);
/* Writes the statistics as a JSON object of that name; nothing without cracks. SI units, angles in
 * degrees. */
void      pg_crack_statistics_json (pg_json *j, const char *name, const pg_crack_statistics *s);
/* Mean direction of cracks in the plane, degrees from the x axis, 0 to 180. */
double    pg_network_direction (const pg_network *n);

/* Does all that pg_result_open does before it opens files: fields, views, averages, tips, reference.
 * PG_E_SCENE: what the scene asks for cannot be had. */
pg_status pg_result_plan (const pg_scene *scene, const pg_problem *problem, pg_solver *solver);
/* An open result folder. */
typedef struct pg_result pg_result;
/* The folder in which this process keeps its tables and its checkpoint: `folder`, or in parallel runs
 * (perigal/ranks.h) on all ranks but the first, ranks/RANK below it. */
void pg_result_rank_folder (char *out, size_t size, const char *folder);
/* Makes the folder and locks it (DIR/run.lock) until pg_result_free. Problem and solver are
 * borrowed. PG_E_USAGE: another run uses the folder, and the reasons of pg_result_may_open. */
pg_status pg_result_open (pg_result **out, const char *folder, const pg_scene *scene,
                          const pg_problem *problem, pg_solver *solver);
/* PG_E_USAGE if a run in this folder would replace one that is not finished (a checkpoint, or
 * rows without a report of another scene), or overwrite a scene.yaml that no run put there, or
 * if `folder` is a file. */
pg_status pg_result_may_open (const char *folder, const pg_scene *scene);
/* 1: a parallel run with so many points joins its fields at the end (output.format, output.join) */
int       pg_result_joins (const pg_scene *scene, double points);
/* Name of the file in the folder that contains the fields. */
const char *pg_result_fields (const pg_result *result);
/* 1: the folder has a checkpoint from which the run can continue. */
int       pg_result_kept (const pg_result *result);
/* Removes the checkpoint and the rows of an unfinished run; the rest of the folder stays.
 * PG_E_USAGE: a run uses it. */
pg_status pg_result_discard (const char *folder);
/* Writes the rows of a finished step and, where they are due, its fields. */
pg_status pg_result_step  (pg_result *result, const pg_state *state, const pg_step *step);
/* To be called in the middle of a step, between two rounds of breaking (pg_watch): writes fields when a
 * further fraction output.at.broken of all bonds has broken. */
pg_status pg_result_stage (pg_result *result, const pg_state *state, const pg_step *so_far);
/* To be called when the current step was rejected and the state has been reset to that at its start. */
void      pg_result_refused (pg_result *result);
/* Writes the last fields, the pictures and report.json. failure: NULL, or the message of what
 * ended the run; search and total: seconds spent in the search for neighbours and in the whole
 * run before this call, whose own are added in the report. */
pg_status pg_result_finish (pg_result *result, const pg_state *state, const char *failure, double search,
                            double total);
/* Closes the files and gives up the lock; accepts a pointer to NULL. */
void      pg_result_free  (pg_result **result);

/* ---- going on later ------------------------------------------------------------------------------------ */
/* Writes checkpoint.nc, the run as it is, after the files of the folder have been synced.
 * Allowed also after a refused step, after pg_result_step has failed, and in the middle of a
 * step after pg_result_stage. pg_result_finish removes the file when the run is complete. */
pg_status pg_result_checkpoint (pg_result *result, pg_state *state);
/* Passes everything that a checkpoint holds to a keeper; keeper->reading must be 0. Tests
 * compare runs by it. */
pg_status pg_result_keep   (pg_result *result, pg_state *state, const pg_keeper *keeper);
/* 1 if the time output.checkpoint has passed since the last checkpoint. */
int       pg_result_due    (const pg_result *result);
/* Where a resumed run begins: steps done, rounds of breaking done in the next one, seconds
 * that the run took so far, threads and ranks (1: one process alone) that it had. */
typedef struct { long step, rounds; double seconds; int threads, ranks; } pg_resumed;
/* Restores solver and state from the checkpoint of the folder and truncates its files to that time, so that
 * the run continues with the same bits; if the number of ranks has changed, it continues from the last
 * complete step, up to rounding. *out NULL: the run was killed before its first checkpoint and must begin
 * anew by pg_result_open. PG_E_USAGE: no checkpoint, or one of another scene, version or points; PG_E_FILE: a
 * damaged one. */
pg_status pg_result_resume (pg_result **out, const char *folder, const pg_scene *scene,
                            const pg_problem *problem, pg_solver *solver, pg_state *state, pg_resumed *from);
/* 1 if the folder holds the complete results of this scene and no checkpoint. */
int       pg_result_finished (const char *folder, const pg_scene *scene);
/* Completes the folder of a run that was killed after its end: adds the faces of cracks to result.e, removes
 * folders and parts left by ranks. PG_E_FILE; PG_E_USAGE: another process uses the folder. */
pg_status pg_result_complete (const char *folder);
/* What pg_result_finish measured against the reference of the scene; NULL if there is none. */
const pg_errors *pg_result_errors (const pg_result *result);
/* The estimated error of the last stress, after pg_result_finish; NULL if none was made. */
const pg_estimate *pg_result_estimate (const pg_result *result);
/* Describes entry k of output.tips in words: how far its crack has grown, when and how fast. Returns 0 past
 * the end. */
int       pg_result_tip    (const pg_result *result, size_t k, char *out, size_t size /* 256 */);
/* Writes line k of a summary after pg_result_finish: the largest force and where it was reached, the secant
 * stiffness, the new crack and its energy. Returns 0 past the end. */
int       pg_result_words  (const pg_result *result, size_t k, char *out, size_t size /* 1 or more */);
const char *pg_result_folder (const pg_result *result);
/* The cracks of a result folder at the time of fields in its result.e, from cracks.csv, for pictures; none
 * where it has no such file. To be freed with pg_cracks_clear. PG_E_FILE: the file is damaged. */
pg_status pg_result_cracks (pg_cracks *out, const char *folder, double time);
/* Number of pictures written, stages not counted; pg_result_picture has their paths. */
size_t    pg_result_pictures (const pg_result *result);
const char *pg_result_picture (const pg_result *result, size_t i);
PG_API_END
#endif
