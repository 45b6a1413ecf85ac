/* SPDX-License-Identifier: GPL-3.0-or-later
 * report.h: the result folder of a run: result.e, history.csv, events.csv, report.json, pictures, a copy of
 * the scene, checkpoint.nc. */
#ifndef PERIGAL_REPORT_H
#define PERIGAL_REPORT_H
#include "perigal/compare.h"
#include "perigal/output.h"
#include "perigal/solve.h"

PG_API_BEGIN

/* Faults of output.fields and output.pictures that only the dimension shows; also part of pg_result_open. */
pg_status pg_result_check (const pg_scene *scene, const pg_problem *problem);
/* Of that what needs no problem: pictures that no body of this dimension has, as faults of a scene that
 * pg_scene_partial tells from others. */
void      pg_result_check_names (const pg_scene *scene);

typedef struct pg_result pg_result;
/* Makes the folder and locks it (DIR/run.lock) until pg_result_free. PG_E_USAGE: another run has it, and as
 * pg_result_may_open. */
pg_status pg_result_open (pg_result **out, const char *folder, const pg_scene *scene,
                          const pg_problem *problem, pg_solver *solver);
/* PG_E_USAGE: a run here would replace one that is not finished (a checkpoint, or rows without a report of
 * another scene), write over a scene.yaml that no run put there, or `folder` is a file. */
pg_status pg_result_may_open (const char *folder, const pg_scene *scene);
/* Gives up what an unfinished run left; the rest of the folder stays. PG_E_USAGE: a run has it. */
pg_status pg_result_discard (const char *folder);
pg_status pg_result_step  (pg_result *result, const pg_state *state, const pg_step *step);
/* In the middle of a step (a pg_watch): fields, when another share output.at.broken of the bonds has
 * broken. */
pg_status pg_result_stage (pg_result *result, const pg_state *state, const pg_step *so_far);
/* The step at hand was refused: the state is that of its start again. */
void      pg_result_refused (pg_result *result);
/* Writes the last fields, pictures and report.json; `failure` is NULL or the message of what ended the run;
 * seconds: of the run by phase search, total. The files stay readable whatever happens. */
pg_status pg_result_finish (pg_result *result, const pg_state *state, const char *failure, double search,
                            double total);
void      pg_result_free  (pg_result **result);

/* ---- going on later ------------------------------------------------------------------------------------ */
/* checkpoint.nc: the run as it is, the files of the folder synced before. Also after a refused step, after
 * pg_result_step has failed, in the middle of a step after pg_result_stage. pg_result_finish removes it when
 * all is done. */
pg_status pg_result_checkpoint (pg_result *result, pg_state *state);
/* The walk that pg_result_checkpoint writes to its file; keeper->reading must be 0. */
pg_status pg_result_keep   (pg_result *result, pg_state *state, const pg_keeper *keeper);
int       pg_result_due    (const pg_result *result);  /* output.checkpoint has passed since the last one */
/* steps done, break rounds of the next */
typedef struct { long step, rounds; double seconds; int threads; } pg_resumed;
/* Brings solver and state to where the checkpoint of the folder was written, cuts off what the files have got
 * since. */
pg_status pg_result_resume (pg_result **out, const char *folder, const pg_scene *scene,
                            const pg_problem *problem, pg_solver *solver, pg_state *state, pg_resumed *from);
/* 1: the folder holds the whole results of this scene and no checkpoint. */
int       pg_result_finished (const char *folder, const pg_scene *scene);
/* What pg_result_finish measured against the scene's reference; NULL: there is none. */
const pg_errors *pg_result_errors (const pg_result *result);
/* After pg_result_finish: the estimated error of the last stress; NULL: none was made. */
const pg_estimate *pg_result_estimate (const pg_result *result);
/* The k-th of output.tips in words: how far its crack has come, when and how fast. 0: there is no such. */
int       pg_result_tip    (const pg_result *result, size_t k, char *out, size_t size /* 256 */);
/* After pg_result_finish: the largest force and where, secant stiffness, new crack and what it cost, a line
 * each. 0: there are no more. */
int       pg_result_words  (const pg_result *result, size_t k, char *out, size_t size /* 1 or more */);
const char *pg_result_folder (const pg_result *result);
size_t    pg_result_pictures (const pg_result *result);     /* written */
const char *pg_result_picture (const pg_result *result, size_t i);
PG_API_END
#endif
