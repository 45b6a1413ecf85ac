/* SPDX-License-Identifier: GPL-3.0-or-later
 * perigal.h: everything. Read in this order: scene, model, solve, results; then the catalogues.
 *
 *     pg_scene *scene = NULL; pg_problem *problem = NULL; pg_solver *solver = NULL; pg_state *state = NULL;
 *     pg_solver_options options; pg_step step;
 *     PG_TRY (pg_scene_load (&scene, "scene.yaml"));
 *     PG_TRY (pg_problem_build (&problem, scene, 1));
 *     PG_TRY (pg_solver_options_read (&options, problem, scene));
 *     PG_TRY (pg_solver_create (&solver, problem, &options));
 *     PG_TRY (pg_state_create (&state, problem, pg_solver_components (solver)));
 *     while (!pg_solver_done (solver, state)) PG_TRY (pg_solver_step (solver, state, &step));
 *
 * What comes out through **out is yours (free it with its _free); what comes back through const * is
 * borrowed. Nothing is kept from the scene. SI units throughout; Voigt order xx yy zz xy yz zx with
 * engineering shears. */
#ifndef PERIGAL_H
#define PERIGAL_H
#include "perigal/base.h"
#include "perigal/scene.h"
#include "perigal/kernel.h"
#include "perigal/material.h"
#include "perigal/criterion.h"
#include "perigal/linalg.h"
#include "perigal/netcdf.h"
#include "perigal/mesh.h"
#include "perigal/mesh_files.h"
#include "perigal/cloud.h"
#include "perigal/cells.h"
#include "perigal/approx.h"
#include "perigal/integration.h"
#include "perigal/sums.h"
#include "perigal/model.h"
#include "perigal/force.h"
#include "perigal/fracture.h"
#include "perigal/contact.h"
#include "perigal/symbol.h"
#include "perigal/solve.h"
#include "perigal/output.h"
#include "perigal/picture.h"
#include "perigal/compare.h"
#include "perigal/results.h"
#include "perigal/plan.h"
#include "perigal/session.h"
#include "perigal/study.h"
#endif
