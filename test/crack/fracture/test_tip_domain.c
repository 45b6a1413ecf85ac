/* SPDX-License-Identifier: GPL-3.0-or-later
 * How large the rings around a tip are: 3 and 8 spacings where there is room, less beside surfaces, loads on
 * points and interfaces, and behind a turn of the crack; what has no K is refused with the reason. */
#include "scene_runs/run.h"

static const char plate[] =
    "dimension: 2\nplane: stress\nthickness: 1\nbody: [{add: {box: {low: [0, -20], high: "
    "[40, 20]}}}]\nspacing: 1\nlattice: cells\n";
#define ONE "materials: {m: {youngs_modulus: 1, poissons_ratio: 0.3}}\n"
#define HELD "{set: right, displacement: {x: 0, y: 0}}"
#define STATIC "solver: {kind: static}\noutput: {at: {levels: 1}}\n"

/* The tip of a crack from the left edge to (to, 0), with `more` of the scene; no load acts. */
static pg_tip_field tip_at (double to, const char *more)
{
    pg_tip_field f;
    void *self;
    run r = scene_of (1, "%scracks: [{from: [-1, 0], to: [%g, 0]}]\n%s" STATIC, plate, to, more);
    const double *d = r.state->d, one = 1;
    const pg_force_type *force = pg_solver_force (r.solver, &self);
    assert_int_equal (r.state->paths->ntip, 1);
    check_ok (force->refresh (self, r.state, NULL));
    check_ok (pg_tip_measure (&f, r.problem, force, self, r.state, 0, 1, &d, &one, NULL, 0));
    check_relative (f.h, 1, 1e-9), check_relative (f.r1, 1, 1e-9);
    check_relative (f.x[0], to, 1e-12), check_relative (f.e[0], 1, 1e-12);
    if (!isnan (f.near)) assert_true (f.J[0][0] == 0 && f.K[0][0] == 0);
    clear (&r);
    return f;
}

static void rings_end_at_surfaces (void **state)
{
    (void) state;
    const char *more = ONE "boundary: [" HELD "]\n",
               *above = ONE "boundary: [{set: top, displacement: {x: 0, y: 0}}]\n";
    pg_tip_field f = tip_at (20, more);
    check_relative (f.near, 3, 1e-9), check_relative (f.wide, 8, 1e-9);
    f = tip_at (35, above);
    check_relative (f.near, 3, 1e-9), check_relative (f.wide, 5, 0.02);
    f = tip_at (38, above);
    check_relative (f.near, 2, 0.05), check_relative (f.wide, 2, 0.05);
    assert_true (isnan (pg_tip_uncertainty (&f, 1, (double[]){ 1 })));
    /* one ring, whose radius was found twice */
    f.wide = f.near * (1 + 1e-15);
    assert_true (isnan (pg_tip_uncertainty (&f, 1, (double[]){ 1 })));
    f = tip_at (39, above);
    assert_true (isnan (f.near) && isnan (f.wide) && isnan (f.J[0][0]) && isnan (f.K[0][0]));
    check_relative (f.room, 1, 0.05);
    f = tip_at (6, more); /* the mouth of the crack */
    check_relative (f.wide, 6, 0.02);
}

static void and_at_loads_and_interfaces (void **state)
{
    (void) state;
    pg_tip_field f = tip_at (20, ONE "sets: {spot: {where: \"hypot(x - 24.5, y - 0.5) < 0.2\"}}\n"
                                     "boundary: [" HELD ", {set: spot, force: {y: 1}}]\n");
    check_relative (f.wide, hypot (4.5, 0.5), 0.01);
    f = tip_at (
        20, "materials: {m: {youngs_modulus: 1, poissons_ratio: 0.3}, n: {youngs_modulus: 2, "
            "poissons_ratio: 0.3}}\nblocks: [{material: m, where: x < 26}, {material: n, where: x >= 26}]\n"
            "boundary: [" HELD "]\n");
    check_relative (f.wide, 6, 0.03), check_relative (f.modulus, 1, 1e-12);
    f = tip_at (20,
                ONE "sets: {part: {where: x > 25}}\nboundary: [" HELD ", {set: part, body_force: {y: 1}}]\n");
    check_relative (f.wide, 5, 0.03);
}

/* A facet of 5 spacings that turns by 40 degrees: the wide ring ends behind it. */
static void and_behind_turns (void **state)
{
    (void) state;
    run r =
        scene_of (1, "%scracks: [{from: [-1, 0], to: [20, 0]}]\n" ONE "boundary: [" HELD "]\n" STATIC, plate);
    void *self;
    const pg_force_type *force = pg_solver_force (r.solver, &self);
    const double *d = r.state->d, one = 1;
    pg_changes cut = { 0 };
    double c = cos (0.7), s = sin (0.7);
    for (int k = 1; k <= 5; k++) {
        double to[3] = { 20 + c * k, s * k, 0 };
        check_ok (pg_crack_grow (r.state, r.problem, 0, to, 0, &cut));
    }
    for (size_t i = 0; i < cut.n; i++) r.state->alive[cut.bond[i]] = 0;
    check_ok (force->refresh (self, r.state, NULL));
    pg_tip_field f;
    check_ok (pg_tip_measure (&f, r.problem, force, self, r.state, 0, 1, &d, &one, NULL, 0));
    check_relative (f.e[0], c, 1e-9), check_relative (f.e[1], s, 1e-9);
    /* around the turn: from 0.75 beyond the tip to 12, and the outer half of that */
    check_relative (f.r1, 5.75, 1e-9), check_relative (f.near, 8.875, 1e-9);
    check_relative (f.wide, 12, 1e-9);
    check_absolute (f.kink[0], 20, 1e-9), check_absolute (f.kink[1], 0, 1e-9);
    pg_free (cut.bond);
    clear (&r);
}

static void what_has_no_K_is_refused (void **state)
{
    (void) state;
    static const char wood[] =
        "materials: {w: {model: orthotropic, youngs_modulus_1: 10, youngs_modulus_2: 1, "
        "poissons_ratio_12: 0.3, shear_modulus_12: 0.5}}\n";
    run r = scene_of (1, "%scracks: [{from: [-1, 0], to: [20, 0]}]\n%sboundary: [" HELD "]\n" STATIC, plate,
                      wood);
    void *self;
    const pg_force_type *force = pg_solver_force (r.solver, &self);
    const double *d = r.state->d, one = 1;
    pg_tip_field f;
    check_contains (pg_tip_refuses (r.problem, force), "isotropic");
    check_fails (pg_tip_measure (&f, r.problem, force, self, r.state, 0, 1, &d, &one, NULL, 0), PG_E_USAGE);
    check_contains (pg_last_error (), "isotropic");
    clear (&r);
    r = scene_of (
        1, "dimension: 3\nbody: [{add: {box: {low: [0, 0, 0], high: [4, 4, 4]}}}]\nspacing: 1\nmethod: "
           "{gauss_points: 1}\n" ONE "boundary: [" HELD "]\n" STATIC);
    force = pg_solver_force (r.solver, &self), d = r.state->d;
    assert_null (pg_tip_refuses (r.problem, force));   /* fronts in space have theirs */
    check_fails (pg_tip_measure (&f, r.problem, force, self, r.state, 0, 1, &d, &one, NULL, 0), PG_E_USAGE);
    check_fails (pg_front_measure (&f, r.problem, force, self, r.state, 0, 1, &d, &one, NULL), PG_E_USAGE);
    clear (&r);
}

int main (void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test (rings_end_at_surfaces),
                                        cmocka_unit_test (and_at_loads_and_interfaces),
                                        cmocka_unit_test (and_behind_turns),
                                        cmocka_unit_test (what_has_no_K_is_refused) };
    return cmocka_run_group_tests_name ("crack/fracture/tip_domain", tests, NULL, NULL);
}
