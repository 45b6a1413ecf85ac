/* SPDX-License-Identifier: GPL-3.0-or-later
 * scenes.h: problems from text. */
#ifndef PERIGAL_TEST_SCENES_H
#define PERIGAL_TEST_SCENES_H
#include "refused.h"

#define PLATE \
    "dimension: 2\nbody: [{add: {box: {low: [0, 0], high: [1, 0.5]}}}]\nspacing: 0.1\nthickness: 0.2\n" \
    "materials: {rock: {youngs_modulus: 10, poissons_ratio: 0.2, density: 3}}\n"

typedef struct { pg_scene *scene; pg_problem *problem; } built;

static inline built build (const char *text)
{
    built b = { 0 };
    check_ok (pg_scene_parse (&b.scene, text, "test.yaml"));
    check_ok (pg_problem_build (&b.problem, b.scene, 1));
    return b;
}

static inline void unbuild (built *b)
{
    pg_problem_free (&b->problem);
    pg_scene_free (&b->scene);
}

/* The problem of a scene built with each allocation failing in turn: told as that, and nothing is left
 * behind. */
static inline void each_allocation_may_fail (const char *text)
{
    pg_scene *scene = NULL;
    check_ok (pg_scene_parse (&scene, text, "test.yaml"));
    size_t used = pg_memory_used (), k = 0;
    pg_status status = PG_E_MEMORY;
    while (status != PG_OK) {
        pg_problem *problem = NULL;
        pg_memory_fail_at (++k);
        status = pg_problem_build (&problem, scene, 1);
        pg_memory_fail_at (0);
        if (status != PG_OK) {
            assert_int_equal (status, PG_E_MEMORY);
            assert_null (problem);
        }
        pg_problem_free (&problem);
        assert_int_equal (pg_memory_used (), used);
        assert_true (k < 5000);
    }
    assert_true (k > 50);
    pg_scene_free (&scene);
}
#endif
