/* SPDX-License-Identifier: GPL-3.0-or-later
 * Strains and stresses are kept between calls and redone only where bonds died: residual, utilisation and
 * work_balance must equal, bit by bit, those of a force made afresh from the same alive bits. */
#include "check.h"
#include "perigal.h"

static const char plate[] =
    "dimension: %d\n%s\n"
    "body: [{add: {box: {low: %s, high: %s}}}]\nspacing: 1 mm\n"
    "materials: {rock: {youngs_modulus: 10 GPa, poissons_ratio: 0.25}}\n"
    "failure: {criterion: %s}\n"
    "method: {approximation: %s, integration: %s, kernel: cubic_spline, horizon: 2.0 spacing}\n"
    "boundary:\n  - {name: foot, set: bottom, displacement: {%s}}\n  - {name: head, set: top, displacement: "
    "{x: 2 um, y: 20 um}}\n"
    "solver: {kind: static, stepping: event, max_events: 12}\n";

typedef struct {
    const char *head, *from, *to, *criterion, *approximation, *integration, *foot;
    int dim;
} plan;

static double *numbers (size_t n)
{
    double *a = pg_calloc (n, sizeof *a);
    assert_non_null (a);
    return a;
}

/* Residual, utilisation and factors of two forces at the same displacement. */
static void compare (const pg_force_type *type, void *kept, void *fresh, const pg_state *state,
                     const double *d)
{
    double *r[2] = { numbers (state->ndof), numbers (state->ndof) },
           *u[2] = { numbers (state->nbond), numbers (state->nbond) };
    double *f[2] = { numbers (state->nbond), numbers (state->nbond) }, reference[2];
    char *kind = pg_calloc (state->nbond, 1);
    for (int k = 0; k < 2; k++) {
        void *self = k ? fresh : kept;
        check_ok (type->balance (self, 1, d, r[k], &reference[k]));
        check_ok (type->judge (self, state, d,
                               &(pg_judging){ .utilisation = u[k], .kind = kind, .factor = f[k] }));
    }
    assert_memory_equal (r[0], r[1], state->ndof * sizeof (double));
    assert_memory_equal (u[0], u[1], state->nbond * sizeof (double));
    assert_memory_equal (f[0], f[1], state->nbond * sizeof (double));
    assert_true (reference[0] == reference[1]);
    for (int k = 0; k < 2; k++) pg_free (r[k]), pg_free (u[k]), pg_free (f[k]);
    pg_free (kind);
}

/* Bonds die right after a measure at the displacement that is asked for again. */
static void break_by_hand (const pg_force_type *type, void *kept, const pg_problem *problem, pg_state *state)
{
    void *fresh = NULL;
    pg_changes dead = { 0 };
    double *r = numbers (state->ndof), reference;
    dead.bond = pg_calloc (state->nbond, sizeof *dead.bond);
    assert_non_null (dead.bond);
    check_ok (type->balance (kept, 1, state->d, r, &reference));
    for (size_t b = 7; b < state->nbond; b += 101)
        if (state->alive[b]) dead.bond[dead.n++] = b, state->alive[b] = 0;
    check_ok (type->refresh (kept, state, &dead));
    check_ok (type->create (&fresh, problem));
    check_ok (type->refresh (fresh, state, NULL));
    compare (type, kept, fresh, state, state->d);
    type->free (&fresh);
    pg_free (r), pg_free (dead.bond);
}

static void run_plan (const plan *a)
{
    char text[2048];
    pg_scene *scene = NULL;
    pg_problem *problem = NULL;
    pg_solver *solver = NULL;
    pg_state *state = NULL;
    pg_solver_options options;
    pg_step step;
    void *kept, *fresh = NULL;
    snprintf (text, sizeof text, plate, a->dim, a->head, a->from, a->to, a->criterion, a->approximation,
              a->integration, a->foot);
    check_ok (pg_scene_parse (&scene, text, "plate.yaml"));
    check_ok (pg_problem_build (&problem, scene, 1));
    check_ok (pg_solver_options_read (&options, problem, scene));
    check_ok (pg_solver_create (&solver, problem, &options));
    check_ok (pg_state_create (&state, problem, pg_solver_components (solver)));
    const pg_force_type *type = pg_solver_force (solver, &kept);
    double *other = numbers (state->ndof);
    while (!pg_solver_done (solver, state)) {
        check_ok (pg_solver_step (solver, state, &step));
        check_ok (type->create (&fresh, problem));
        check_ok (type->refresh (fresh, state, NULL));
        for (size_t i = 0; i < state->ndof; i++) other[i] = state->d[i] * (1 + 0.1 * (double) (i % 7));
        compare (type, kept, fresh, state, state->d);
        /* another displacement, and back: what is kept must not answer */
        compare (type, kept, fresh, state, other);
        compare (type, kept, fresh, state, state->d);
        type->free (&fresh);
    }
    assert_true (state->broken > 0);
    break_by_hand (type, kept, problem, state);
    pg_free (other);
    pg_state_free (&state);
    pg_solver_free (&solver);
    pg_problem_free (&problem);
    pg_scene_free (&scene);
}

static const char stress[] = "mohr_coulomb, tensile_strength: 1 MPa, cohesion: 5 MPa, friction_angle: 40 deg",
                  stretch[] = "stretch, critical_stretch: 1e-4";

static void test_kept_measures_equal_fresh_ones_in_2d_with_gauss_points (void **unused)
{
    (void) unused;
    run_plan (&(plan){ "plane: stress\nthickness: 1 mm", "[0, 0]", "[8 mm, 10 mm]", stress, "rkpm", "gauss",
                       "x: 0, y: 0", 2 });
}

static void test_kept_measures_equal_fresh_ones_in_2d_at_nodes (void **unused)
{
    (void) unused;
    run_plan (&(plan){ "plane: strain\nthickness: 1 mm", "[0, 0]", "[8 mm, 10 mm]", stretch, "pddo", "nodal",
                       "x: 0, y: 0", 2 });
}

static void test_kept_measures_equal_fresh_ones_with_consistent_derivatives (void **unused)
{
    (void) unused;
    run_plan (&(plan){ "plane: stress\nthickness: 1 mm", "[0, 0]", "[8 mm, 10 mm]", stress, "rkpm",
                       "consistent", "x: 0, y: 0", 2 });
    run_plan (&(plan){ "", "[0, 0, 0]", "[3 mm, 5 mm, 3 mm]", stretch, "rkpm", "consistent",
                       "x: 0, y: 0, z: 0", 3 });
}

static void test_kept_measures_equal_fresh_ones_in_3d (void **unused)
{
    (void) unused;
    run_plan (
        &(plan){ "", "[0, 0, 0]", "[3 mm, 5 mm, 3 mm]", stretch, "rkpm", "gauss", "x: 0, y: 0, z: 0", 3 });
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (test_kept_measures_equal_fresh_ones_in_2d_with_gauss_points),
        cmocka_unit_test (test_kept_measures_equal_fresh_ones_in_2d_at_nodes),
        cmocka_unit_test (test_kept_measures_equal_fresh_ones_with_consistent_derivatives),
        cmocka_unit_test (test_kept_measures_equal_fresh_ones_in_3d),
    };
    return cmocka_run_group_tests_name ("mechanics/force/measure", tests, NULL, NULL);
}
