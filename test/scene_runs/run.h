/* SPDX-License-Identifier: GPL-3.0-or-later
 * run.h: scenes as text, run through the library: problem, solver, state, fields at the nodes. */
#ifndef PERIGAL_TEST_RUN_H
#define PERIGAL_TEST_RUN_H
#include <stdlib.h>
#include "check.h"
#include "perigal.h"

typedef struct {
    pg_scene   *scene;
    pg_problem *problem;
    pg_solver  *solver;
    pg_state   *state;
    pg_solver_options options;
    pg_step     step;                                  /* the last one */
} run;

/* Problem, options, solver and state of a scene that is read. */
static inline void build (run *r, int threads)
{
    check_ok (pg_problem_build (&r->problem, r->scene, threads));
    check_ok (pg_solver_options_read (&r->options, r->problem, r->scene));
    check_ok (pg_solver_create (&r->solver, r->problem, &r->options));
    check_ok (pg_state_create (&r->state, r->problem, pg_solver_components (r->solver)));
}

/* The problem of a scene; text from a printf format. */
static inline run scene_of (int threads, const char *format, ...)
    __attribute__ ((format (printf, 2, 3), unused));
static inline run prepare (int threads, const char *text)
{
    run r = { 0 };
    check_ok (pg_scene_parse (&r.scene, text, "test.yaml"));
    build (&r, threads);
    return r;
}

/* The problem of a scene file, one thread, with --set options. */
static inline run loaded (const char *path, size_t nset, const char *const *set)
{
    run r = { 0 };
    check_ok (pg_scene_load_with (&r.scene, path, nset, set));
    build (&r, 1);
    return r;
}

static inline run scene_of (int threads, const char *format, ...)
{
    char text[8192];
    va_list args;
    va_start (args, format);
    int length = vsnprintf (text, sizeof text, format, args);
    va_end (args);
    assert_true (length > 0 && length < (int) sizeof text);
    return prepare (threads, text);
}

static inline void advance (run *r) { check_ok (pg_solver_step (r->solver, r->state, &r->step)); }

static inline void to_the_end (run *r) { while (!pg_solver_done (r->solver, r->state)) advance (r); }

static inline void clear (run *r)
{
    pg_state_free (&r->state);
    pg_solver_free (&r->solver);
    pg_problem_free (&r->problem);
    pg_scene_free (&r->scene);
}

/* A field at the nodes for coefficients d (NULL: those of the state), n x *components packed; freed by the
 * caller. */
static inline double *field_of (const run *r, const double *d, const char *name, int *components)
{
    void *self;
    int count;
    const char *unit;
    const pg_force_type *force = pg_solver_force (r->solver, &self);
    double *value = pg_calloc (6 * r->problem->cloud.n, sizeof *value);
    check_ok (force->field (self, r->state, d ? d : r->state->d, name, &count, &unit, value));
    assert_true (count > 0);
    if (components) *components = count;
    return value;
}

static inline double largest_of (const double *a, size_t n)
{
    double top = 0;
    for (size_t i = 0; i < n; i++) if (!(fabs (a[i]) <= top)) top = fabs (a[i]);
    return top;
}

static inline double largest_difference (const double *a, const double *b, size_t n)
{
    double top = 0;
    for (size_t i = 0; i < n; i++) if (!(fabs (a[i] - b[i]) <= top)) top = fabs (a[i] - b[i]);
    return top;
}

/* Brings the caches in line with the alive bits without a step. */
static inline void refresh (run *r, const pg_changes *changes)
{
    void *self;
    const pg_force_type *force = pg_solver_force (r->solver, &self);
    check_ok (force->refresh (self, r->state, changes));
}
#endif
