/* SPDX-License-Identifier: GPL-3.0-or-later
 * platens.h: what runs with platens show; after scene_runs/run.h. */
#ifndef PERIGAL_TEST_PLATENS_H
#define PERIGAL_TEST_PLATENS_H
static inline const pg_platen_values *platen_of (const run *r, size_t i)
{
    size_t n;
    const pg_platen_values *v = pg_solver_platens (r->solver, &n);
    assert_true (i < n);
    return &v[i];
}
#endif
