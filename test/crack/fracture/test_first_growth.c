/* SPDX-License-Identifier: GPL-3.0-or-later
 * What `perigal check --solve` finds of a scene whose criterion judges tips: load and place of the first
 * facet, and K at all tips. A clamped strip of height 2 H whose grips part by 2 u releases G = E u^2 / H (1 -
 * nu^2): the scene is made so that it grows at a third of the load. */
#include "scene_runs/run.h"

static pg_first_break first_of (const char *path, size_t nset, const char *const *set)
{
    pg_first_break b = { 0 };
    run r = loaded (path, nset, set);
    check_ok (pg_first_break_find (&b, r.problem, &r.options));
    assert_int_equal (b.solved, 1);
    clear (&r);
    return b;
}

static void the_load_of_first_growth (void **state)
{
    (void) state;
    pg_first_break b = first_of ("data/fracture/strip.yaml", 0, NULL);
    check_relative (b.factor, 1.0 / 3, 0.005);
    assert_int_equal (b.grows, 1), assert_int_equal (b.grown, 1), assert_int_equal (b.ntip, 1);
    check_relative (b.from[0], 0.125, 1e-9), check_scaled (b.from[1], 0, 1e-9, 1);
    check_relative (b.to[0], 0.13, 1e-3), check_scaled (b.to[1], 0, 1e-4, 1);
    /* K at the full load is sqrt (9 E G0) */
    check_relative (b.tip[0].J[0][0], 9 * 8, 0.01);
    check_relative (b.tip[0].K[0][0], 3 * sqrt (70e9 * 8), 0.02);
}

/* Beyond the full load: by the energy that the tip sets free at it. */
static void and_beyond_the_full_load (void **state)
{
    (void) state;
    const char *set[] = { "failure.fracture_energy=800" };
    pg_first_break b = first_of ("data/fracture/strip.yaml", 1, set);
    check_relative (b.factor, 10.0 / 3, 0.005);
    assert_int_equal (b.grows, 0);
}

int main (void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test (the_load_of_first_growth),
                                        cmocka_unit_test (and_beyond_the_full_load) };
    return cmocka_run_group_tests_name ("crack/fracture/first_growth", tests, NULL, NULL);
}
