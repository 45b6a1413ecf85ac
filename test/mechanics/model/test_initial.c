/* SPDX-License-Identifier: GPL-3.0-or-later
 * initial.velocity: a free body flies and spins on, a stretching one has the velocity asked for, by every
 * dynamic method; what is refused. */
#include <string.h>
#include "../../scene_runs/run.h"

#define PLATE \
    "dimension: 2\nplane: stress\nthickness: 1 mm\nbody: [{add: {box: {low: [-5 mm, -4 mm], high: [5 mm, 4 " \
    "mm]}}}]\nspacing: 1 mm\nlattice: cells\n" \
    "materials: {m: {youngs_modulus: 10 GPa, poissons_ratio: 0.3333333333333333, density: 2500 kg/m3}}\n"

static void a_free_body_flies_on (void **state)
{
    (void) state;
    static const char *const kinds[3] = { "verlet", "central", "newmark" };
    for (int k = 0; k < 3; k++) {
        run r = scene_of (1,
                          PLATE "method: {force: bond}\ninitial: {velocity: {x: 3 m/s, y: -4 m/s}}\nsolver: "
                                "{kind: %s, dt: 0.1 us, time_steps: 50}\n",
                          kinds[k]);
        to_the_end (&r);
        for (size_t i = 0; i < r.problem->cloud.n; i++) {
            check_relative (r.state->d[2*i], 15e-6, 1e-9);
            check_relative (r.state->d[2*i + 1], -20e-6, 1e-9);
        }
        check_relative (pg_solver_report_now (r.solver)->energy.kinetic, 0.5 * 2500 * 80e-9 * 25, 1e-9);
        clear (&r);
    }
}

static void each_point_has_its_own_velocity (void **state)
{
    (void) state;
    run r = scene_of (1, PLATE "method: {force: bond}\ninitial: {velocity: {y: 800 / s * y}}\nsolver: {kind: "
                               "verlet, time_steps: 5}\n");
    for (size_t i = 0; i < r.problem->cloud.n; i++) {
        assert_true (r.state->v[2*i] == 0);
        check_scaled (r.state->v[2*i + 1], 800 * r.problem->cloud.x[2*i + 1], 1e-14, 3.2);
    }
    clear (&r);
    r = scene_of (1, PLATE "method: {force: bond}\nboundary: [{set: left, displacement: {x: 0, y: "
                           "0}}]\ninitial: {velocity: {y: 1}}\nsolver: {kind: static, steps: 2}\n");
    int noted = 0;
    for (size_t k = 0; k < r.problem->notes.n; k++)
        noted |= strstr (r.problem->notes.text[k], "ignored with solver: static: initial") != NULL;
    assert_true (noted);
    assert_true (largest_of (r.state->v, r.state->ndof) == 0);
    clear (&r);
}

/* Points that turn spin with the body: no bond is strained, and the spin goes on, by every dynamic method. */
static void a_spinning_body_is_at_rest_in_itself (void **state)
{
    (void) state;
    static const char *const kinds[3] = { "verlet", "central", "newmark" };
    for (int k = 0; k < 6; k++) {
        int dim = 2 + k / 3;
        run r = scene_of (1,
                          "dimension: %d\n%sbody: [{add: {box: {low: %s, high: %s}}}]\nspacing: 1 "
                          "mm\nlattice: cells\nmethod: {force: gmpd}\n"
                          "materials: {m: {youngs_modulus: 10 GPa, poissons_ratio: 0.2, density: 2500 "
                          "kg/m3}}\ninitial: {velocity: {x: -300 / s * y, y: 300 / s * x%s}}\n"
                          "solver: {kind: %s, dt: 0.1 us, time_steps: 50}\n",
                          dim, dim == 2 ? "plane: stress\nthickness: 1 mm\n" : "",
                          dim == 2 ? "[-5 mm, -4 mm]" : "[-3 mm, -4 mm, -2 mm]",
                          dim == 2 ? "[5 mm, 4 mm]" : "[3 mm, 4 mm, 2 mm]",
                          dim == 2 ? "" : " + 100 / s * z, z: -100 / s * y", kinds[k % 3]);
        to_the_end (&r);
        const pg_statistics *p = pg_solver_report_now (r.solver);
        assert_true (p->energy.kinetic > 0);
        check_below (p->energy.strain, (k % 3 == 2 ? 1e-12 : 1e-18) * p->energy.kinetic);
        size_t m = (size_t) (pg_problem_unknowns (r.problem));
        for (size_t i = 0; i < r.problem->cloud.n; i++) {
            const double *own = r.state->d + i * m;
            check_scaled (own[0], -300 * 5e-6 * r.problem->cloud.x[i * (size_t) dim + 1], 1e-7, 6e-6);
            check_relative (own[m - 1], 1e-3 * 300 * 5e-6, 1e-7);
        }
        clear (&r);
    }
}

static void must_refuse (const char *rest, const char *part)
{
    char text[2048];
    pg_scene *scene = NULL;
    pg_problem *problem = NULL;
    snprintf (text, sizeof text, PLATE "solver: {kind: verlet, dt: 0.1 us, time_steps: 5}\n%s", rest);
    check_ok (pg_scene_parse (&scene, text, "test.yaml"));
    assert_int_equal (pg_problem_build (&problem, scene, 1), PG_E_SCENE);
    if (!strstr (pg_last_error (), part)) fail_msg ("'%s' says nothing of '%s'", pg_last_error (), part);
    assert_null (problem);
    pg_scene_free (&scene);
}

/* Sets have velocities of their own, the last one that holds a point counts, others that of all points. */
static void sets_have_their_own_velocities (void **state)
{
    (void) state;
    run r = scene_of (1, PLATE "method: {force: bond}\nsets: {low: {where: \"y < 0\"}, corner: {where: "
                               "\"y < 0 and x < 0\"}}\n"
                               "initial: {velocity: {x: 5}, sets: [{set: low, velocity: {y: 2 / s * x}}, "
                               "{set: corner, velocity: {x: -1, y: 3}}]}\n"
                               "solver: {kind: verlet, end: 1e-6}\n");
    size_t seen[3] = { 0 };
    for (size_t i = 0; i < r.problem->cloud.n; i++) {
        const double *x = r.problem->cloud.x + 2 * i, *v = r.state->v + 2 * i;
        int part = x[1] >= 0 ? 0 : x[0] >= 0 ? 1 : 2;
        seen[part]++;
        assert_true (v[0] == (part == 0 ? 5 : part == 1 ? 0 : -1));
        check_scaled (v[1], part == 0 ? 0 : part == 1 ? 2 * x[0] : 3, 1e-15, 1);
    }
    assert_true (seen[0] && seen[1] && seen[2]);
    clear (&r);
}

static void what_cannot_be_is_refused (void **state)
{
    (void) state;
    must_refuse ("method: {force: bond}\ninitial: {velocity: {z: 1 m/s}}\n",
                 "initial.velocity.z = 1 m/s: a 2D body has no such component");
    must_refuse ("method: {force: bond}\ninitial: {velocity: {x: 1 m/s2 * t}}\n", "does not change with t");
    must_refuse ("initial: {velocity: {x: 1 m/s}}\n", "not with force: galerkin so far");
    must_refuse ("initial: {sets: [{set: all, velocity: {x: 1 m/s}}]}\n", "not with force: galerkin so far");
    must_refuse ("method: {force: bond}\ninitial: {sets: [{set: left, velocity: {z: 1}}]}\n",
                 "initial.sets[0].velocity.z = 1: a 2D body has no such component");
}

int main (void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test (a_free_body_flies_on),
                                        cmocka_unit_test (each_point_has_its_own_velocity),
                                        cmocka_unit_test (a_spinning_body_is_at_rest_in_itself),
                                        cmocka_unit_test (sets_have_their_own_velocities),
                                        cmocka_unit_test (what_cannot_be_is_refused) };
    return cmocka_run_group_tests_name ("mechanics/model/initial", tests, NULL, NULL);
}
