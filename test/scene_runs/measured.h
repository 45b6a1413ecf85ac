/* SPDX-License-Identifier: GPL-3.0-or-later
 * measured.h: a scene of a file, run to its end and measured against its own reference. */
#ifndef PERIGAL_TEST_MEASURED_H
#define PERIGAL_TEST_MEASURED_H
#include "run.h"

/* With --set options; the errors are those of the last step. */
static inline run measured (const char *path, size_t nset, const char *const *set, pg_errors *e)
{
    run r = { 0 };
    pg_reference *reference;
    pg_sampler sampler;
    void *self;
    check_ok (pg_scene_load_with (&r.scene, path, nset, set));
    check_ok (pg_problem_build (&r.problem, r.scene, 1));
    check_ok (pg_reference_read (&reference, r.scene, r.problem));
    check_ok (pg_solver_options_read (&r.options, r.problem, r.scene));
    check_ok (pg_solver_create (&r.solver, r.problem, &r.options));
    check_ok (pg_state_create (&r.state, r.problem, pg_solver_components (r.solver)));
    to_the_end (&r);
    const pg_force_type *force = pg_solver_force (r.solver, &self);
    check_ok (pg_sampler_solution (&sampler, r.problem, force, self, r.state));
    check_ok (pg_errors_measure (e, reference, r.problem, &sampler, 1));
    pg_sampler_clear (&sampler);
    pg_reference_free (&reference);
    return r;
}
#endif
