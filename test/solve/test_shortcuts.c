/* SPDX-License-Identifier: GPL-3.0-or-later
 * Work that a run skips changes nothing: Newmark steps without a matrix or factor, conjugate gradients by the
 * factor of an earlier K, K x without K - each against the plain path, on bodies that break. */
#include "scene_runs/run.h"
#include <stdint.h>
#include <string.h>

#define BLOCK \
    "dimension: 3\nbody: [{add: {box: {low: [0, 0, 0], high: [0.8 m, 1 m, 0.4 m]}}}]\nspacing: 0.1 " \
    "m\nperturb: {amount: 0.1}\n" \
    "cracks: [{polygon: [[-0.1, 0.55, -0.1], [0.25, 0.55, -0.1], [0.25, 0.45, 0.5], [-0.1, 0.45, 0.5]]}]\n" \
    "materials: {rock: {youngs_modulus: 30 GPa, poissons_ratio: 0.2, density: 2500}}\n" \
    "failure: {criterion: stretch, critical_stretch: 1e-4, exclude: [bottom, top]}\n"
#define PULLED \
    "boundary: [{set: bottom, displacement: {x: 0, y: 0, z: 0}}, {set: top, velocity: {y: 0.5 " \
    "m/s}}]\nmethod: {essential: transformation}\n"
#define SMALL \
    "solver: {kind: newmark, dt: 12 us, end: 2.4 ms, tolerance: 1e-11, break: fraction, break_fraction: 10 " \
    "%%, linear: %s}\n"

/* Both runs step by step: the same bonds die, displacements agree. */
static void compare (run *a, run *b, long steps, double tolerance)
{
    size_t n = a->state->ndof, nbond = a->state->nbond;
    for (long k = 0; k < steps && a->state->broken < 300; k++) {
        advance (a), advance (b);
        assert_memory_equal (a->state->alive, b->state->alive, nbond);
        double top = largest_of (a->state->d, n), off = largest_difference (a->state->d, b->state->d, n);
        assert_true (off <= tolerance * top);
    }
}

static void a_small_step_factors_nothing_and_says_so (void **state)
{
    (void) state;
    run a = scene_of (1, BLOCK PULLED SMALL, "auto"), b = scene_of (1, BLOCK PULLED SMALL, "cholmod");
    compare (&a, &b, 18, 1e-9);
    const pg_statistics *r = pg_solver_report (a.solver, a.state),
                        *plain = pg_solver_report (b.solver, b.state);
    print_message ("%ld bonds broken, %zu iterations in %ld solves; plain: %ld factorizations\n", r->broken,
                   r->linear.cg_iterations, r->linear.solves, plain->linear.factorizations);
    assert_true (r->broken > 5);
    assert_int_equal (r->linear.factorizations, 0);
    assert_true (plain->linear.factorizations > 2);
    int told = 0;
    for (size_t k = 0; k < r->nskipped; k++)
        told |= strstr (r->skipped[k].what, "factorization")
                && strstr (r->skipped[k].why, "the mass dominates");
    assert_true (told);
    clear (&a), clear (&b);
}

static void a_large_step_factors (void **state)
{
    (void) state;
    run a = scene_of (
        1, "dimension: 3\nbody: [{add: {box: {low: [0, 0, 0], high: [0.8 m, 1 m, 0.4 m]}}}]\nspacing: 0.1 m\n"
           "materials: {rock: {youngs_modulus: 30 GPa, poissons_ratio: 0.2, density: 2500}}\n" PULLED
           "solver: {kind: newmark, dt: 1 ms, end: 10 ms}\n");
    advance (&a);
    const pg_statistics *r = pg_solver_report (a.solver, a.state);
    assert_true (r->linear.factorizations >= 1);
    for (size_t k = 0; k < r->nskipped; k++) assert_null (strstr (r->skipped[k].what, "factorization"));
    clear (&a);
}

#define STRIP \
    "dimension: 3\nbody: [{add: {box: {low: [0, 0, 0], high: [1 m, 1 m, 0.5 m]}}}]\nspacing: 0.1 " \
    "m\nperturb: {amount: 0.1}\n" \
    "cracks: [{polygon: [[-0.1, 0.55, -0.1], [0.25, 0.55, -0.1], [0.25, 0.45, 0.6], [-0.1, 0.45, 0.6]]}]\n" \
    "materials: {rock: {youngs_modulus: 30 GPa, poissons_ratio: 0.2, density: 2500}}\n" \
    "failure: {criterion: stretch, critical_stretch: 1e-4, exclude: [bottom, top]}\n" \
    "boundary: [{set: bottom, displacement: {x: 0, y: 0, z: 0}}, {set: top, displacement: {y: 0.4 mm}}]\n"

static void a_kept_factor_gives_the_same_crack (void **state)
{
    (void) state;
    static const char solver[] = STRIP "solver: {stepping: fixed, steps: 40, tolerance: 1e-11, break: "
                                       "fraction, break_fraction: 10 %%, linear: %s}\n";
    run a = scene_of (1, solver, "auto"), b = scene_of (1, solver, "cholmod");
    compare (&a, &b, longer () ? 14 : 5, 1e-9);
    const pg_statistics *r = pg_solver_report (a.solver, a.state),
                        *plain = pg_solver_report (b.solver, b.state);
    print_message ("%ld bonds broken, %ld factorizations, %zu iterations; plain: %ld\n", r->broken,
                   r->linear.factorizations, r->linear.cg_iterations, plain->linear.factorizations);
    assert_true (r->broken > 5);
    assert_true (r->linear.factorizations < plain->linear.factorizations);
    assert_true (r->nskipped > 0);
    clear (&a), clear (&b);
}

static void events_with_a_kept_factor_are_the_same (void **state)
{
    (void) state;
    static const char solver[] = STRIP "solver: {stepping: event, tolerance: 1e-11, linear: %s}\n";
    run a = scene_of (1, solver, "auto"), b = scene_of (1, solver, "cholmod, plain: true");
    double first = 0;
    for (int k = 0; k < (longer () ? 20 : 8); k++) {
        advance (&a), advance (&b);
        assert_memory_equal (a.state->alive, b.state->alive, a.state->nbond);
        check_scaled (a.state->factor, b.state->factor, 1e-8, b.state->factor);
        if (k == 0) first = a.state->factor;
    }
    assert_true (first > 0);
    assert_true (pg_solver_report (a.solver, a.state)->linear.factorizations
                 < pg_solver_report (b.solver, b.state)->linear.factorizations);
    clear (&a), clear (&b);
}

static void the_frequency_that_bounds_explicit_steps (void **state)
{
    (void) state;
    /* a row of masses and the bar between them: theory of the linear element with its ends: omega^2 = 4 E /
     * (rho h^2) for a = 2 h in 1D, where shape functions at the Gauss points are those of the bar's own cell
     * and its neighbours; found here by brute force instead */
    run r = scene_of (
        1,
        "dimension: 1\nbody: [{add: {box: {low: [0], high: [2 m]}}}]\nspacing: 0.1 m\n"
        "materials: {rock: {youngs_modulus: 4 Pa, poissons_ratio: 0, density: 1}}\n"
        "boundary: [{set: left, displacement: {x: 0}, ramp: constant}]\nmethod: {essential: transformation}\n"
        "solver: {kind: newmark, dt: 1 ms, end: 1 s}\n");
    double omega, best = 0;
    void *self;
    check_ok (pg_solver_fastest (r.solver, r.state, &omega));
    const pg_force_type *f = pg_solver_force (r.solver, &self);
    size_t n = r.state->ndof;
    double *x = pg_calloc (3 * n, sizeof *x), *y = x + n, *mass = x + 2 * n;
    check_ok (f->mass (self, mass, NULL));
    const pg_operator *K = f->operator_ (self);
    for (size_t i = 0; i < n; i++) x[i] = (i % 2 ? 1 : -1) * (1 + 0.1 * (double) (i % 3));
    for (int k = 0; k < 20000; k++) {                  /* power iteration */
        double size = 0;
        K->apply (K->context, x, y);
        for (size_t i = 0; i < n; i++) x[i] = y[i] / mass[i], size = fmax (size, fabs (x[i]));
        for (size_t i = 0; i < n; i++) x[i] /= size;
        best = sqrt (size);
    }
    print_message ("omega %.6f, by power iteration %.6f\n", omega, best);
    assert_true (omega <= best * (1 + 1e-6) && omega >= 0.98 * best);
    pg_free (x);
    clear (&r);
}

/* One solve a step, of the whole matrix: what damping adds to it is not left to corrections. */
static void damping_is_in_the_matrix (void **state)
{
    (void) state;
    size_t solves[2];
    for (int damped = 0; damped < 2; damped++) {
        run r =
            scene_of (1,
                      "dimension: 2\nthickness: 1 mm\nbody: [{add: {box: {low: [0, 0], high: [20 mm, 10 "
                      "mm]}}}]\nspacing: 1 mm\nmaterials: {glass: {youngs_modulus: 72 GPa, poissons_ratio: "
                      "0.22, density: 2500 kg/m3}}\n"
                      "boundary:\n  - {set: bottom, displacement: {x: 0, y: 0}}\n  - {set: top, traction: "
                      "{y: 1 MPa}}\nsolver: {kind: newmark, linear: cholmod, dt: 1 us, end: 20 us%s}\n",
                      damped ? ", rayleigh: {stiffness: 2 us}" : "");
        to_the_end (&r);
        solves[damped] = (size_t) pg_solver_report_now (r.solver)->linear.solves;
        clear (&r);
    }
    print_message ("solves: %zu, damped %zu\n", solves[0], solves[1]);
    assert_int_equal (solves[0], solves[1]);
}

#define PANEL \
    "dimension: 2\nplane: stress\nthickness: 1 mm\n" \
    "body: [{add: {box: {low: [0, 0], high: [60 mm, 40 mm]}}}]\n" \
    "spacing: 1 mm\nlattice: cells\ncracks: [{from: [-1 mm, 20 mm], to: [25 mm, 20 mm]}]\n" \
    "materials: {glass: {youngs_modulus: 72 GPa, poissons_ratio: %s, density: 2440}}\n" \
    "failure: {criterion: stretch, critical_stretch: 0.001}\n" \
    "layers: [{name: grip, side: bottom, thickness: 3 spacing}]\n"

/* Explicit runs and relaxation with all shortcuts against none: the same bonds at the same steps, motion,
 * energies and reactions to rounding; forces by stencils, lists and transforms, bonds, states and beams.
 * Short: every method with one of the two solvers. */
static void explicit_runs_are_those_of_the_plain_path (void **state)
{
    (void) state;
    static const char *const methods[][2] = {
        { "0.333333333333", "force: bond, kernel: constant, horizon: 3.015 spacing" },
        { "0.333333333333", "force: bond, kernel: conical, horizon: 3.015 spacing, stretch: finite" },
        { "0.333333333333", "force: bond, kernel: constant, horizon: 3.015 spacing, evaluation: list" },
        { "0.333333333333", "force: fcbm, horizon: 4 spacing, evaluation: fft" },
        { "0.22", "force: lps, horizon: 3.015 spacing" },
        { "0.22", "force: gmpd, horizon: 3.015 spacing" },
    };
    static const char *const solvers[] = { "verlet, dt: 80 ns, time_steps: 240",
                                           "central, dt: 80 ns, time_steps: 240, rayleigh: {mass: 1000}" };
    for (size_t m = 0; m < sizeof methods / sizeof *methods; m++)
        for (size_t k = longer () ? 0 : m % 2; k < (longer () ? 2 : m % 2 + 1); k++) {
            static const char scene[] = PANEL
                "boundary: [{set: top, traction: {y: 12 MPa}, ramp: constant}, {set: grip, velocity: {y: "
                "-0.5 m/s}}]\nmethod: {%s}\nsolver: {kind: %s%s}\noutput: {at: {rows: 40}}\n";
            run a = scene_of (1, scene, methods[m][0], methods[m][1], solvers[k], ""),
                b = scene_of (1, scene, methods[m][0], methods[m][1], solvers[k], ", plain: true");
            long broken = 0;
            while (!pg_solver_done (a.solver, a.state)) {
                advance (&a), advance (&b);
                const pg_statistics *r = pg_solver_report_now (a.solver),
                                    *plain = pg_solver_report_now (b.solver);
                double top = largest_of (b.state->d, b.state->ndof), all = fabs (plain->energy.external);
                assert_memory_equal (a.state->alive, b.state->alive, a.state->nbond);
                assert_true (largest_difference (a.state->d, b.state->d, a.state->ndof) <= 1e-11 * top);
                check_scaled (r->energy.strain, plain->energy.strain, 1e-10, all);
                check_scaled (r->energy.kinetic, plain->energy.kinetic, 1e-10, all);
                check_scaled (r->energy.external, plain->energy.external, 1e-10, all);
                check_scaled (a.step.reaction[4], b.step.reaction[4], 1e-8, b.step.reaction[4]);
                broken = a.state->broken;
            }
            assert_true (pg_solver_done (b.solver, b.state));
            print_message ("method %zu, solver %zu: %ld bonds broken\n", m, k, broken);
            assert_true (broken > 50);
            const pg_statistics *r = pg_solver_report (a.solver, a.state);
            int told = 0;
            for (size_t i = 0; i < r->nskipped; i++) told |= strstr (r->skipped[i].what, "rows") != NULL;
            assert_true (told);
            assert_int_equal (pg_solver_report (b.solver, b.state)->nskipped, 0);
            clear (&a), clear (&b);
        }
}

/* Of the state before a step only what changes is kept: a step that is refused leaves the bonds that had died
 * before it dead, and those that died in it alive. */
static void a_refused_step_restores_all_bonds (void **state)
{
    (void) state;
    run r = scene_of (1,
                      PANEL "boundary: [{set: top, traction: {y: 12 MPa}, ramp: constant}, {set: grip, "
                            "velocity: {y: -0.5 m/s}}]\nmethod: {force: bond, horizon: 3.015 spacing}\n"
                            "solver: {kind: verlet, dt: 80 ns, time_steps: 240}\noutput: {at: {rows: 40}}\n",
                      "0.333333333333");
    while (r.state->broken < 300) advance (&r);
    unsigned char *alive = pg_calloc (r.state->nbond, 1);
    memcpy (alive, r.state->alive, r.state->nbond);
    long before = r.state->broken;
    size_t inside = r.state->ndof / 4 * 2;             /* bonds of a point inside break in the step */
    r.state->v[inside] = INFINITY;
    assert_int_equal (pg_solver_step (r.solver, r.state, &r.step), PG_E_EQUILIBRIUM);
    assert_int_equal (r.state->broken, before);
    assert_memory_equal (r.state->alive, alive, r.state->nbond);
    pg_free (alive);
    clear (&r);
}

#define SHEET \
    "dimension: 2\nthickness: 0.1\nbody: [{add: {box: {low: [0, 0], high: [3, 2]}}}]\nspacing: 0.1\n" \
    "materials: {rock: {youngs_modulus: 30 GPa, poissons_ratio: 0.25}}\n" \
    "boundary: [{set: bottom, displacement: {x: 0, y: 0}}, {set: top, displacement: {y: 0.4 mm}}]\n" \
    "solver: {stepping: fixed, steps: 3, linear: cholmod%s}\nmethod: {%s}\n"

/* Three load steps by one factor, K being gone after the first: supports by Nitsche's terms, by elimination
 * of unknowns that others join, and of those of points. */
static void one_factor_needs_no_matrix_beside_it (void **state)
{
    (void) state;
    static const char *const methods[] = { "essential: nitsche", "essential: transformation", "force: bond" };
    for (int k = 0; k < 3; k++) {
        size_t start = pg_memory_used (), held[2];
        run a = scene_of (1, SHEET, "", methods[k]);
        advance (&a);
        held[0] = pg_memory_used () - start, start = pg_memory_used ();
        run b = scene_of (1, SHEET, ", plain: true", methods[k]);
        advance (&b);
        held[1] = pg_memory_used () - start;
        compare (&a, &b, 2, 1e-9);
        const pg_statistics *r = pg_solver_report (a.solver, a.state);
        int told = 0;
        for (size_t i = 0; i < r->nskipped; i++) told |= strstr (r->skipped[i].what, "memory for K") != NULL;
        print_message ("%s: %zu bytes after the first step, plain %zu\n", methods[k], held[0], held[1]);
        assert_true (told && r->linear.factorizations == 1);
        assert_true (held[0] < 0.8 * held[1]);
        clear (&a), clear (&b);
    }
}

/* What was added to the diagonal of K for its factor is gone again: weak unknowns along a crack, a bond of
 * which may break later, so that K stays. */
static void the_diagonal_is_put_back (void **state)
{
    (void) state;
    static const char *const methods[] = { "essential: nitsche", "essential: transformation", "force: bond" };
    for (int k = 0; k < 3; k++) {
        run r = scene_of (1, SHEET "cracks: [{from: [-0.1, 1.03], to: [1.2, 1.03]}]\n"
                             "failure: {criterion: stretch, critical_stretch: 1}\n", "", methods[k]);
        advance (&r);
        void *self, *fresh = NULL;
        const pg_force_type *force = pg_solver_force (r.solver, &self);
        check_ok (force->create (&fresh, r.problem));
        check_ok (force->refresh (fresh, r.state, NULL));
        check_ok (pg_force_assemble (force, fresh, NULL));
        const pg_sparse *K = pg_force_matrix (force, self), *same = pg_force_matrix (force, fresh);
        assert_non_null (K);
        size_t n = r.state->ndof;
        assert_memory_equal (K->start, same->start, (n + 1) * sizeof *K->start);
        assert_memory_equal (K->value, same->value, (size_t) K->start[n] * sizeof *K->value);
        force->free (&fresh);
        clear (&r);
    }
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (one_factor_needs_no_matrix_beside_it),
        cmocka_unit_test (the_diagonal_is_put_back),
        cmocka_unit_test (a_small_step_factors_nothing_and_says_so),
        cmocka_unit_test (a_large_step_factors),
        cmocka_unit_test (a_kept_factor_gives_the_same_crack),
        cmocka_unit_test (events_with_a_kept_factor_are_the_same),
        cmocka_unit_test (the_frequency_that_bounds_explicit_steps),
        cmocka_unit_test (damping_is_in_the_matrix),
        cmocka_unit_test (explicit_runs_are_those_of_the_plain_path),
        cmocka_unit_test (a_refused_step_restores_all_bonds),
    };
    return cmocka_run_group_tests_name ("solve/shortcuts", tests, NULL, NULL);
}
