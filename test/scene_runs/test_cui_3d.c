/* SPDX-License-Identifier: GPL-3.0-or-later
 * Cui's 3D scenes as shipped, on coarser points: what must hold at any spacing. The scenes themselves take
 * minutes (their README). */
#include "scene_runs/run.h"
#include <math.h>
#include <string.h>

static run coarse (const char *scene, size_t n, const char *const *sets)
{
    run r = { 0 };
    check_ok (pg_scene_load_with (&r.scene, scene, n, sets));
    check_ok (pg_problem_build (&r.problem, r.scene, 1));
    check_ok (pg_solver_options_read (&r.options, r.problem, r.scene));
    check_ok (pg_solver_create (&r.solver, r.problem, &r.options));
    check_ok (pg_state_create (&r.state, r.problem, pg_solver_components (r.solver)));
    return r;
}

/* Runs until `share` of the bonds has broken anew; returns the largest force of the first load along y up to
 * there. */
static double until_broken (run *r, double share)
{
    double top = 0;
    while (!pg_solver_done (r->solver, r->state)
           && (double) r->state->broken < share * (double) r->state->nbond) {
        advance (r);
        top = fmax (top, fabs (r->step.reaction[1]));
        assert_true (r->step.residual <= 1e-8);
    }
    assert_true ((double) r->state->broken >= share * (double) r->state->nbond);
    return top;
}

static void the_shallower_the_crack_the_larger_the_load (void **state)
{
    (void) state;
    static const char *const sets[] = { "spacing=3.4 mm", "solver.stop={}" };
    double load[3];
    static const char *const scene[3] = { "data/cui_disk_10/scene.yaml", "data/cui_disk_6/scene.yaml",
                                          "data/cui_disk_2/scene.yaml" };
    for (int k = 0; k < 3; k++) {
        run r = coarse (scene[k], 2, sets);
        load[k] = until_broken (&r, 0.01);
        const pg_statistics *report = pg_solver_report (r.solver, r.state);
        print_message ("%s: %.1f N when 1 %% is broken, %ld steps, %ld rounds, %zu iterations\n", scene[k],
                       load[k], report->steps, report->iterations, report->linear.cg_iterations);
        assert_int_equal (report->linear.factorizations, 0);
        assert_int_equal (report->bonds_over_limit, 0);
        assert_true (report->nskipped > 0);
        clear (&r);
    }
    assert_true (load[0] < load[1] && load[1] < load[2]);
}

/* The same order from equilibrium, at 5 mm: the deeper the crack the softer the disk, and the less it bears
 * over the first 25 events. PERIGAL_TEST_SIZE=long. */
static void the_deeper_the_crack_the_softer_and_weaker_the_disk (void **state)
{
    (void) state;
    static const char *const sets[] = {
        "spacing=5 mm", "sets.platens.angle=[[80 deg, 100 deg], [260 deg, 280 deg]]",
        ("boundary=[{name: top, set: platens.top, displacement: {x: 0, y: -20 um}}, {name: bottom, set: "
         "platens.bottom, displacement: {x: 0, y: 20 um}}]"),
        "solver={kind: static, linear: pcg, stepping: event, max_events: 25}", "output={}"
    };
    static const char *const scene[3] = { "data/cui_disk_10/scene.yaml", "data/cui_disk_6/scene.yaml",
                                          "data/cui_disk_2/scene.yaml" };
    double stiffness[3] = { 0 }, load[3] = { 0 };
    for (int k = 0; k < 3; k++) {
        run r = coarse (scene[k], 5, sets);
        while (!pg_solver_done (r.solver, r.state)) {
            advance (&r);
            if (stiffness[k] == 0) stiffness[k] = fabs (r.step.reaction[1]) / r.step.factor;
            load[k] = fmax (load[k], fabs (r.step.reaction[1]));
        }
        print_message ("%s: %.5g N at 20 um while whole, at most %.5g N\n", scene[k], stiffness[k], load[k]);
        assert_true (r.state->events >= 25);
        clear (&r);
    }
    for (int k = 1; k < 3; k++) {
        check_below (1.02 * stiffness[k - 1], stiffness[k]);
        check_below (1.5 * load[k - 1], load[k]);
    }
}

/* A crack through the thickness: front and back alike, and the disk point-symmetric; in the short test it is
 * pressed five times as fast. */
static void a_through_crack_is_symmetric (void **state)
{
    (void) state;
    static const char *const sets[] = { "spacing=5 mm",
                                        "sets.platens.angle=[[80 deg, 100 deg], [260 deg, 280 deg]]",
                                        "boundary[0].velocity.y=-50 mm/s", "boundary[1].velocity.y=50 mm/s" };
    run r = coarse ("data/cui_disk_10/scene.yaml", longer () ? 2 : 4, sets);
    until_broken (&r, 0.01);
    const pg_statistics *report = pg_solver_report (r.solver, r.state);
    print_message ("%ld steps, %ld rounds, %zu iterations\n", report->steps, report->iterations,
                   report->linear.cg_iterations);
    assert_int_equal (report->linear.factorizations, 0);
    assert_int_equal (report->bonds_over_limit, 0);
    assert_true (report->nskipped > 0);
    double *damage = field_of (&r, NULL, "damage", NULL);
    const double *x = r.problem->cloud.x;
    size_t n = r.problem->cloud.n, pairs = 0;
    for (size_t i = 0; i < n; i++)
        for (size_t j = 0; j < n; j++) {
            int across = fabs (x[3 * i] - x[3 * j]) < 1e-9 && fabs (x[3 * i + 1] - x[3 * j + 1]) < 1e-9
                         && fabs (x[3 * i + 2] + x[3 * j + 2] - 0.01) < 1e-9;
            int turned = fabs (x[3 * i] + x[3 * j]) < 1e-9 && fabs (x[3 * i + 1] + x[3 * j + 1]) < 1e-9
                         && fabs (x[3 * i + 2] - x[3 * j + 2]) < 1e-9;
            if (!across && !turned) continue;
            check_scaled (damage[i], damage[j], 1e-12, 1);
            pairs++;
        }
    assert_true (pairs >= 2 * n - 2);
    pg_free (damage);
    clear (&r);
}

/* The crack leaves the tilted mouth and crosses the plate near the height of its middle, and it is upright
 * there. PERIGAL_TEST_SIZE=long. */
static void the_plate_parts_near_the_middle_of_the_mouth (void **state)
{
    (void) state;
    const char *const sets[] = { "spacing=0.1 m", "boundary[1].traction.y=30 MPa", "solver.dt=1 ms",
                                 "solver.break_fraction=10 %" };
    if (!longer ()) return;
    run r = coarse ("data/cui_plate/scene.yaml", 4, sets);
    to_the_end (&r);
    double *damage = field_of (&r, NULL, "damage", NULL), height[2] = { 0, 0 }, weight[2] = { 0, 0 };
    const pg_cloud *c = &r.problem->cloud;
    for (size_t i = 0; i < c->n; i++) {
        const double *x = c->x + 3 * i;
        if (x[0] < 0.45 || x[0] > 0.85) continue;
        int back = x[2] < 0.1;
        if (damage[i] > 0.2) height[back] += damage[i] * x[1], weight[back] += damage[i];
    }
    const pg_statistics *report = pg_solver_report (r.solver, r.state);
    print_message ("ends at t = %g s, %ld bonds, %ld rounds, %ld factorizations, %zu iterations\n",
                   r.state->time, report->broken, report->iterations, report->linear.factorizations,
                   report->linear.cg_iterations);
    assert_true (weight[0] > 0 && weight[1] > 0);
    print_message ("crack at y = %.3f m (front half), %.3f m (back half)\n", height[0] / weight[0],
                   height[1] / weight[1]);
    assert_true (fabs (height[0] / weight[0] - 1) < 0.1 && fabs (height[1] / weight[1] - 1) < 0.1);
    /* the mouth: 0.1 m apart on average */
    assert_true (fabs (height[0] / weight[0] - height[1] / weight[1]) < 0.07);
    assert_true (report->residual_max <= 1e-8);
    pg_free (damage);
    clear (&r);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (a_through_crack_is_symmetric),
        cmocka_unit_test (the_plate_parts_near_the_middle_of_the_mouth),
    /* make test-long only */
    }, minutes[] = { cmocka_unit_test (the_shallower_the_crack_the_larger_the_load),
                     cmocka_unit_test (the_deeper_the_crack_the_softer_and_weaker_the_disk) };
    if (longer () && cmocka_run_group_tests_name ("scene_runs/cui_3d, long", minutes, NULL, NULL) != 0)
        return 1;
    return cmocka_run_group_tests_name ("scene_runs/cui_3d", tests, NULL, NULL);
}
