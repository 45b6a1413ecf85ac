/* SPDX-License-Identifier: GPL-3.0-or-later
 * The errors of a trial, that is one measured run or finite element result (trial_errors.c). */
#ifndef PG_STUDY_TRIAL_H
#define PG_STUDY_TRIAL_H
#include "perigal/study.h"

/* Copies l2, energy, maximum and lines from measured errors into a trial. */
void      pg_trial_take   (pg_trial *t, const pg_errors *errors);
/* Measures a state against the reference of its scene; without one the numbers stay unknown. */
pg_status pg_trial_errors (pg_trial *t, const pg_scene *scene, const pg_problem *problem, pg_solver *solver,
                           const pg_state *state, int dynamic);
#endif
