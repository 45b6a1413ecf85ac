/* SPDX-License-Identifier: GPL-3.0-or-later
 * What a program that links the library reads at the first crack tip of a run. */
#ifndef TEST_FRACTURE_FIRST_TIP_H
#define TEST_FRACTURE_FIRST_TIP_H
#include "scene_runs/run.h"
#include "perigal/fracture.h"

/* At the displacement that the state has. */
static inline pg_tip_field first_tip (const run *r)
{
    void *self;
    const pg_force_type *force = pg_solver_force (r->solver, &self);
    const double *d = r->state->d, one = 1;
    pg_tip_field f;
    check_ok (pg_tip_measure (&f, r->problem, force, self, r->state, 0, 1, &d, &one, NULL, 0));
    return f;
}
#endif
