/* SPDX-License-Identifier: GPL-3.0-or-later
 * report.h: the result folder of a run: result.e, history.csv, events.csv, report.json, pictures, a copy of the scene. */
#ifndef PERIGAL_REPORT_H
#define PERIGAL_REPORT_H
#include "perigal/output.h"
#include "perigal/solve.h"

/* Faults of output.fields and output.pictures that only the dimension shows; also part of pg_result_open. */
pg_status pg_result_check (const pg_scene *scene, const pg_problem *problem);

typedef struct pg_result pg_result;
pg_status pg_result_open  (pg_result **out, const char *folder, const pg_scene *scene, const pg_problem *problem, pg_solver *solver);
pg_status pg_result_step  (pg_result *result, const pg_state *state, const pg_step *step);
/* Writes the last fields, pictures and report.json; `failure` is NULL or the message of what ended the run; seconds: of the run
 * by phase search, total. The files stay readable whatever happens. */
pg_status pg_result_finish (pg_result *result, const pg_state *state, const char *failure, double search, double total);
void      pg_result_free  (pg_result **result);
const char *pg_result_folder (const pg_result *result);
size_t    pg_result_pictures (const pg_result *result);     /* written                                                   */
const char *pg_result_picture (const pg_result *result, size_t i);
#endif
