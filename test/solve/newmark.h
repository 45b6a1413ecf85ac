/* SPDX-License-Identifier: GPL-3.0-or-later
 * newmark.h: the objects of a dynamic run of a scene. */
#ifndef PERIGAL_TEST_NEWMARK_H
#define PERIGAL_TEST_NEWMARK_H
#include "check.h"
#include "perigal/solve.h"

typedef struct {
    pg_scene *scene; pg_problem *problem; pg_solver *solver; pg_state *state;
    const pg_force_type *force; void *self;
    size_t dim, n;
} dynamic;

static inline dynamic open_run (const char *text)
{
    dynamic r = { 0 };
    pg_solver_options options;
    check_ok (pg_scene_parse (&r.scene, text, "dynamic.yaml"));
    check_ok (pg_problem_build (&r.problem, r.scene, 1));
    check_ok (pg_solver_options_read (&options, r.problem, r.scene));
    check_ok (pg_solver_create (&r.solver, r.problem, &options));
    check_ok (pg_state_create (&r.state, r.problem, pg_solver_components (r.solver)));
    r.force = pg_solver_force (r.solver, &r.self);
    r.dim = (size_t) r.problem->dim, r.n = r.problem->cloud.n;
    return r;
}

static inline void close_run (dynamic *r)
{
    pg_state_free (&r->state);
    pg_solver_free (&r->solver);
    pg_problem_free (&r->problem);
    pg_scene_free (&r->scene);
}

static inline pg_step advance (dynamic *r)
{
    pg_step step;
    check_ok (pg_solver_step (r->solver, r->state, &step));
    return step;
}

static inline void run_to_end (dynamic *r) { while (!pg_solver_done (r->solver, r->state)) advance (r); }
#endif
