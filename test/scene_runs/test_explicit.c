/* SPDX-License-Identifier: GPL-3.0-or-later
 * Explicit and relaxed methods with bonds that break: energy, threads, units, mirror images, levels and rows,
 * the state that a static run ends in, stages that are raised, dead bonds. */
#include "run.h"

#define NOTCHED \
    "dimension: 2\nplane: stress\nthickness: 2 mm\nbody: [{add: {box: {low: [0, 0], high: [60 mm, 24 " \
    "mm]}}}]\nspacing: 2 mm\nlattice: cells\n" \
    "cracks: [{from: [30 mm, 0], to: [30 mm, 9 mm]}]\n" \
    "materials: {m: {youngs_modulus: 10 GPa, poissons_ratio: 0.33333333333333333, density: 2500 " \
    "kg/m3}}\nmethod: {force: bond}\n" \
    "output: {at: {levels: 4}}\n"
#define BREAKS "failure: {criterion: stretch, critical_stretch: 1e-3}\n"
#define PULLED \
    "boundary: [{name: left, set: left, displacement: {x: 0, y: 0}}, {name: right, set: right, velocity: " \
    "{x: 2 m/s}}]\n"

static void what_breaking_takes_is_never_given_back (void **state)
{
    (void) state;
    static const char *const kinds[2] = { "verlet", "central" };
    for (int k = 0; k < 2; k++) {
        run r = scene_of (1, NOTCHED BREAKS PULLED "solver: {kind: %s, end: 60 us}\n", kinds[k]);
        double taken = 0, last = -1;
        long broken = 0;
        while (!pg_solver_done (r.solver, r.state)) {
            advance (&r);
            const pg_statistics *p = pg_solver_report_now (r.solver);
            assert_true (p->energy.dissipated >= taken - 1e-12 * p->energy.external);
            assert_true (r.step.nbroken > 0 || p->energy.dissipated <= taken + 1e-12 * p->energy.external);
            check_scaled (r.step.dissipated, p->energy.dissipated - taken, 1e-9, p->energy.external);
            taken = p->energy.dissipated, broken += (long) r.step.nbroken;
            for (size_t i = 0; i < r.step.nbroken; i++) {
                assert_true (r.step.broken[i].time >= last && r.step.broken[i].time <= r.step.time
                             && !r.state->alive[r.step.broken[i].bond]);
                last = r.step.broken[i].time;
            }
        }
        assert_true (broken > 100 && taken > 0);
        assert_int_equal (r.state->broken, broken);
        assert_int_equal (pg_solver_report_now (r.solver)->broken, broken);
        check_relative (r.state->time, 60e-6, 1e-15);
        size_t dead = 0;
        run fresh = scene_of (1, NOTCHED BREAKS PULLED "solver: {kind: %s, end: 60 us}\n", kinds[k]);
        for (size_t i = 0; i < r.state->nbond; i++) dead += fresh.state->alive[i] && !r.state->alive[i];
        assert_int_equal (dead, broken);
        clear (&r), clear (&fresh);
    }
}

/* The largest difference of two runs' displacements over the largest displacement. */
static double apart (const run *a, const run *b, double scale)
{
    double top = 0, off = 0;
    assert_int_equal (a->state->ndof, b->state->ndof);
    for (size_t i = 0; i < a->state->ndof; i++) {
        top = fmax (top, fabs (a->state->d[i]));
        off = fmax (off, fabs (scale * b->state->d[i] - a->state->d[i]));
    }
    return off / top;
}

static void threads_do_not_change_a_bit (void **state)
{
    (void) state;
    static const char *const kinds[4] = { "verlet, end: 40 us", "central, end: 40 us", "adr, stages: 4",
                                          "relax, stages: 4" };
    for (int k = 0; k < 4; k++) {
        const char *pull = k < 2 ? PULLED
                                 : "boundary: [{set: left, displacement: {x: 0, y: 0}}, {set: right, "
                                   "displacement: {x: 40 um}}]\n";
        run one = scene_of (1, NOTCHED BREAKS "%ssolver: {kind: %s}\n", pull, kinds[k]),
            two = scene_of (2, NOTCHED BREAKS "%ssolver: {kind: %s}\n", pull, kinds[k]);
        to_the_end (&one), to_the_end (&two);
        assert_true (one.state->broken > 10);
        assert_memory_equal (one.state->d, two.state->d, one.state->ndof * sizeof (double));
        assert_memory_equal (one.state->alive, two.state->alive, one.state->nbond);
        assert_true (pg_solver_report_now (one.solver)->energy.external
                     == pg_solver_report_now (two.solver)->energy.external);
        clear (&one), clear (&two);
    }
}

/* Lengths in a unit a thousand times as small, the same stresses and speeds. */
static void units_do_not_matter (void **state)
{
    (void) state;
    run m = scene_of (1, "dimension: 2\nplane: stress\nthickness: 1\nbody: [{add: {box: {low: [0, 0], high: "
                         "[30, 12]}}}]\nspacing: 1\nlattice: cells\n"
                         "materials: {m: {youngs_modulus: 1e10, poissons_ratio: 0.33333333333333333, "
                         "density: 2500}}\nmethod: {force: bond}\n" BREAKS
                         "boundary: [{set: left, displacement: {x: 0, y: 0}}, {set: right, velocity: {x: "
                         "2}}]\nsolver: {kind: verlet, time_steps: 60}\n");
    run mm = scene_of (1, "dimension: 2\nplane: stress\nthickness: 1 mm\nbody: [{add: {box: {low: [0, 0], "
                          "high: [30 mm, 12 mm]}}}]\nspacing: 1 mm\nlattice: cells\n"
                          "materials: {m: {youngs_modulus: 1e10, poissons_ratio: 0.33333333333333333, "
                          "density: 2500}}\nmethod: {force: bond}\n" BREAKS
                          "boundary: [{set: left, displacement: {x: 0, y: 0}}, {set: right, velocity: {x: "
                          "2}}]\nsolver: {kind: verlet, time_steps: 60}\n");
    to_the_end (&m), to_the_end (&mm);
    assert_true (m.state->broken > 0 && m.state->broken == mm.state->broken);
    check_below (apart (&m, &mm, 1000), 1e-10);
    check_relative (pg_solver_settled (mm.solver)->dt, 1e-3 * pg_solver_settled (m.solver)->dt, 1e-12);
    assert_int_equal (m.state->iterations, 60);
    clear (&m), clear (&mm);
}

/* ---- the end of a static run --------------------------------------------------------------------------- */
#define STRETCHED \
    "boundary: [{name: left, set: left, displacement: {x: 0, y: 0}}, {name: right, set: right, " \
    "displacement: {x: %g um}}]\n"

static void relaxation_reaches_the_static_solution (void **state)
{
    (void) state;
    static const char *const kinds[2] = { "adr", "relax" };
    run s = scene_of (1, NOTCHED STRETCHED "solver: {kind: static, stepping: fixed, steps: 3}\n", 10.0);
    to_the_end (&s);
    for (int k = 0; k < 2; k++) {
        run r = scene_of (1, NOTCHED STRETCHED "solver: {kind: %s, stages: 3, imbalance: 1e-10}\n", 10.0,
                          kinds[k]);
        to_the_end (&r);
        check_below (apart (&s, &r, 1), 1e-8);
        check_below (r.step.residual, 1e-10);
        check_relative (r.step.reaction[3], s.step.reaction[3], 1e-8);
        check_relative (pg_solver_report_now (r.solver)->energy.external,
                        pg_solver_report_now (s.solver)->energy.external, 1e-8);
        clear (&r);
    }
    clear (&s);
}

/* Breaking in balance is what fixed static steps with break: all do, crack and energies alike, down to the
 * dead bonds. */
static void breaking_in_balance_is_the_static_path (void **state)
{
    (void) state;
    static const char *const kinds[2] = { "adr", "relax" };
    static const char *const modes[2] = { "all", "fraction, break_fraction: 5 %" };
    for (int mode = 0; mode < 2; mode++) {
        run s = scene_of (1,
                          NOTCHED BREAKS STRETCHED
                          "solver: {kind: static, stepping: fixed, steps: 4, break: %s}\n",
                          25.0, modes[mode]);
        to_the_end (&s);
        assert_true (s.state->broken > 0);
        for (int k = 0; k < 2; k++) {
            run r = scene_of (1,
                              NOTCHED BREAKS STRETCHED
                              "solver: {kind: %s, stages: 4, break: %s, imbalance: 1e-9}\n",
                              25.0, kinds[k], modes[mode]);
            to_the_end (&r);
            assert_memory_equal (s.state->alive, r.state->alive, s.state->nbond);
            check_below (apart (&s, &r, 1), 1e-6);
            check_relative (pg_solver_report_now (r.solver)->energy.external,
                            pg_solver_report_now (s.solver)->energy.external, 1e-6);
            check_scaled (pg_solver_report_now (r.solver)->energy.dissipated,
                          pg_solver_report_now (s.solver)->energy.dissipated, 1e-5,
                          pg_solver_report_now (s.solver)->energy.external);
            clear (&r);
        }
        clear (&s);
    }
}

/* The default lets bonds go at any iteration: the end is in balance and under every limit, and jolts of the
 * load break nothing. */
static void bonds_that_go_on_the_way_leave_a_balanced_state (void **state)
{
    (void) state;
    static const char *const kinds[2] = { "adr", "relax" };
    for (int k = 0; k < 2; k++) {
        run below = scene_of (1, NOTCHED BREAKS STRETCHED "solver: {kind: %s, stages: 1}\n", 12.0, kinds[k]);
        to_the_end (&below);
        /* one stage of 12 um at the end points alone would be far over the limit */
        assert_int_equal (below.state->broken, 0);
        clear (&below);
        run r = scene_of (1, NOTCHED BREAKS STRETCHED "solver: {kind: %s, stages: 4}\n", 40.0, kinds[k]);
        while (!pg_solver_done (r.solver, r.state)) {
            advance (&r);
            double *utilisation = pg_calloc (r.state->nbond, sizeof (double)), top = 0;
            char *kind = pg_calloc (r.state->nbond, 1);
            void *self;
            const pg_force_type *force = pg_solver_force (r.solver, &self);
            check_ok (force->judge (self, r.state, r.state->d,
                                    &(pg_judging){ .utilisation = utilisation, .kind = kind }));
            for (size_t i = 0; i < r.state->nbond; i++)
                if (r.state->alive[i]) top = fmax (top, utilisation[i]);
            check_below (top, 1);
            check_below (r.step.residual, 1e-5);
            pg_free (utilisation), pg_free (kind);
        }
        assert_true (r.state->broken > 100);
        assert_true (pg_solver_report_now (r.solver)->energy.dissipated > 0);
        clear (&r);
    }
}

static void stages_are_raised_where_the_load_alone_would_break_bonds (void **state)
{
    (void) state;
    run r = scene_of (1, NOTCHED "failure: {criterion: stretch, critical_stretch: 1e-6}\n"
                                 "boundary: [{set: left, displacement: {x: 0, y: 0}}, {set: right, traction: "
                                 "{x: 100 MPa}}]\nsolver: {kind: relax, stages: 1}\n");
    const pg_statistics *report = pg_solver_report_now (r.solver);
    assert_true (PG_OWN (pg_stages_options, pg_solver_settled (r.solver))->stages > 1);
    assert_int_equal (report->nwarning, 1);
    check_contains (report->warning[0], "instead of 1");
    clear (&r);
}

static void a_run_ends_when_the_crack_arrives (void **state)
{
    (void) state;
    run r = scene_of (1, NOTCHED BREAKS PULLED
                      "solver: {kind: verlet, end: 200 us, stop: {set: top, damage: 40 %%}}\n");
    to_the_end (&r);
    assert_true (r.state->time < 200e-6);
    check_contains (pg_solver_report_now (r.solver)->warning[0], "the crack has arrived at top");
    clear (&r);
    r = scene_of (1, NOTCHED BREAKS PULLED "solver: {kind: verlet, end: 200 us, max_events: 5}\n");
    to_the_end (&r);
    assert_true (r.state->time < 200e-6 && r.state->events >= 5 && r.state->events < 12);
    clear (&r);
}

/* With shape functions the supports act by Nitsche's terms; their work comes from the work balance. */
static void galerkin_forces_march_too (void **state)
{
    (void) state;
    run r = scene_of (1, "dimension: 2\nplane: stress\nthickness: 2 mm\nbody: [{add: {box: {low: [0, 0], "
                         "high: [40 mm, 16 mm]}}}]\nspacing: 4 mm\n"
                         "materials: {m: {youngs_modulus: 10 GPa, poissons_ratio: 0.2, density: 2500 "
                         "kg/m3}}\nmethod: {approximation: rkpm, essential: nitsche}\n"
                         "boundary: [{set: left, displacement: {x: 0, y: 0}}, {set: right, traction: {x: 1 "
                         "MPa}}]\nsolver: {kind: verlet, end: 100 us}\n");
    double most = 0;
    while (!pg_solver_done (r.solver, r.state)) {
        advance (&r);
        const pg_statistics *p = pg_solver_report_now (r.solver);
        most = fmax (most, p->energy.strain);
        check_scaled (p->energy.dissipated, 0, 1e-3, most);
    }
    assert_true (most > 0);
    clear (&r);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (what_breaking_takes_is_never_given_back),
        cmocka_unit_test (threads_do_not_change_a_bit),
        cmocka_unit_test (units_do_not_matter),
        cmocka_unit_test (relaxation_reaches_the_static_solution),
        cmocka_unit_test (breaking_in_balance_is_the_static_path),
        cmocka_unit_test (bonds_that_go_on_the_way_leave_a_balanced_state),
        cmocka_unit_test (stages_are_raised_where_the_load_alone_would_break_bonds),
        cmocka_unit_test (a_run_ends_when_the_crack_arrives),
        cmocka_unit_test (galerkin_forces_march_too),
    };
    return cmocka_run_group_tests_name ("scene_runs/explicit", tests, NULL, NULL);
}
