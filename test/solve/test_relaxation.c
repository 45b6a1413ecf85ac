/* SPDX-License-Identifier: GPL-3.0-or-later
 * adr and relax on chains of masses: they end in equilibrium, with the work of a static path; stages,
 * imbalance, refusals (theory B4, C, ADR-1). */
#include "chain.h"

static const char *const kinds[2] = { "adr", "relax" };

static pg_solver_options options_of (const char *kind, long stages, double imbalance)
{
    pg_solver_options o = { .linear = "auto",
                            .tolerance = 1e-8,
                            .levels = 1,
                            .max_iterations = 100000,
                            .max_events = 1000000,
                            .break_mode = PG_BREAK_PASSING };
    strcpy (o.kind, kind);
    *PG_OWN (pg_stages_options,
             &o) = (pg_stages_options){ .stages = stages, .hold = 1, .imbalance = imbalance };
    return o;
}

static double push (double t) { return 7 * t; }
static double late (double t) { return 7 * t * t; }
static double lead (double t) { return 0.1 * t; }
static double away (double t) { return 0.1 * t * t; }

static void equilibrium_under_a_load (void **state)
{
    (void) state;
    for (int kind = 0; kind < 2; kind++)
        for (int given = 0; given <= kind; given++) {
            linked l;
            the = (chain) { .n = 60, .k = 1e4, .ground = 1e4, .m = 3, .push = push };
            pg_solver_options o = options_of (kinds[kind], 1, 1e-11);
            double omega = sqrt (1e4 / 3) * 2 * sin (0.25 * 3.14159265358979 / 60.5);
            /* critical for the lowest frequency, volume 1 */
            PG_OWN (pg_stages_options, &o)->damping = given ? 2 * 3 * omega : 0;
            link_up (&l, &o, &chain_type);
            run_all (&l);
            for (size_t i = 0; i < the.n; i++) check_relative (l.state->d[i], 7e-4 * (double) (i + 1), 1e-8);
            for (size_t i = 0; i < the.n; i++) assert_true (l.state->v[i] == 0 && l.state->a[i] == 0);
            const pg_statistics *r = pg_solver_report_now (l.solver);
            check_relative (r->energy.external, 0.5 * 7 * 7e-4 * 60, 1e-7);
            check_scaled (r->energy.dissipated, 0, 1e-7, r->energy.external);
            assert_true (r->energy.kinetic == 0 && r->residual_max <= 1e-11);
            check_below ((double) r->iterations, 1500);
            unlink_all (&l);
        }
}

static void equilibrium_of_a_moved_support (void **state)
{
    (void) state;
    for (int kind = 0; kind < 2; kind++) {
        linked l;
        pg_step step;
        the = (chain) { .n = 40, .k = 1e4, .ground = 0, .m = 3, .lead = lead, .push = push };
        pg_solver_options o = options_of (kinds[kind], 5, 1e-11);
        link_up (&l, &o, &chain_type);
        for (int k = 1; k <= 5; k++) {
            check_ok (pg_solver_step (l.solver, l.state, &step));
            check_relative (step.factor, 0.2 * k, 1e-15);
            for (size_t i = 0; i < the.n; i++)
                check_relative (l.state->d[i], 0.2 * k * (0.1 + 7e-4 * (double) i), 1e-8);
            check_relative (step.reaction[0], -7 * 0.2 * k, 1e-8);
        }
        assert_true (pg_solver_done (l.solver, l.state));
        check_relative (pg_solver_report_now (l.solver)->energy.external,
                        pg_solver_report_now (l.solver)->energy.strain, 1e-7);
        unlink_all (&l);
    }
}

/* Masses of adr from the rows of the matrix are those from the sums that a force tells itself. */
static void sums_of_rows_may_be_left_to_the_matrix (void **state)
{
    (void) state;
    pg_force_type silent = chain_type;
    silent.motion.row_sums = NULL;
    the = (chain) { .n = 40, .k = 1e4, .ground = 0, .m = 3, .lead = lead, .push = push };
    pg_solver_options o = options_of ("adr", 5, 1e-11);
    linked a, b;
    pg_step one, other;
    link_up (&a, &o, &chain_type), link_up (&b, &o, &silent);
    for (int k = 1; k <= 5; k++) {
        check_ok (pg_solver_step (a.solver, a.state, &one));
        check_ok (pg_solver_step (b.solver, b.state, &other));
        for (size_t i = 1; i < the.n; i++)
            check_relative (b.state->d[i], 0.2 * k * (0.1 + 7e-4 * (double) i), 1e-8);
        assert_true (other.iterations <= 2 * one.iterations + 50
                     && one.iterations <= 2 * other.iterations + 50);
    }
    unlink_all (&a), unlink_all (&b);
}

/* What is not proportional to the load factor is not foreseen: stages still end in equilibrium. */
static void loads_need_not_be_proportional (void **state)
{
    (void) state;
    for (int kind = 0; kind < 2; kind++) {
        linked l;
        the = (chain) { .n = 40, .k = 1e4, .ground = 0, .m = 3, .lead = away, .push = late };
        pg_solver_options o = options_of (kinds[kind], 7, 1e-11);
        link_up (&l, &o, &chain_type);
        run_all (&l);
        for (size_t i = 0; i < the.n; i++) check_relative (l.state->d[i], 0.1 + 7e-4 * (double) i, 1e-8);
        assert_true (pg_solver_report_now (l.solver)->iterations > 500);
        unlink_all (&l);
    }
}

static void proportional_stages_take_no_iterations (void **state)
{
    (void) state;
    linked l;
    pg_step step;
    the = (chain) { .n = 40, .k = 1e4, .ground = 1e4, .m = 3, .push = push };
    pg_solver_options o = options_of ("adr", 9, 1e-9);
    link_up (&l, &o, &chain_type);
    l.load.proportional = 1;
    check_ok (pg_solver_step (l.solver, l.state, &step));
    assert_true (step.iterations > 20);
    while (!pg_solver_done (l.solver, l.state)) {
        check_ok (pg_solver_step (l.solver, l.state, &step));
        assert_true (step.iterations <= 20);
        check_below (step.residual, 1e-9);
    }
    unlink_all (&l);
}

static void nothing_to_do_is_balance (void **state)
{
    (void) state;
    linked l;
    the = (chain) { .n = 4, .k = 1e4, .ground = 1e4, .m = 3 };
    for (int kind = 0; kind < 2; kind++) {
        pg_solver_options o = options_of (kinds[kind], 3, 1e-9);
        link_up (&l, &o, &chain_type);
        run_all (&l);
        assert_int_equal (pg_solver_report_now (l.solver)->iterations, 0);
        for (size_t i = 0; i < the.n; i++) assert_true (l.state->d[i] == 0);
        unlink_all (&l);
    }
}

/* A chain that nothing holds runs away from its load. */
static void what_finds_no_balance_is_refused (void **state)
{
    (void) state;
    for (int kind = 0; kind < 2; kind++) {
        linked l;
        pg_step step;
        the = (chain) { .n = 10, .k = 1e4, .m = 3, .push = push };
        pg_solver_options o = options_of (kinds[kind], 3, 1e-6);
        o.max_iterations = 500;
        link_up (&l, &o, &chain_type);
        check_fails (pg_solver_step (l.solver, l.state, &step), PG_E_EQUILIBRIUM);
        check_contains (pg_last_error (), "no balance after 500 iterations");
        check_contains (pg_last_error (), "solver.max_iterations");
        check_contains (pg_last_error (), "at point ");
        for (size_t i = 0; i < the.n; i++) assert_true (l.state->d[i] == 0);
        unlink_all (&l);
    }
}

static void one_iteration_a_stage_follows_slow_loads (void **state)
{
    (void) state;
    double error[2];
    for (int kind = 0; kind < 2; kind++) {
        for (int fine = 0; fine < 2; fine++) {
            linked l;
            pg_step step;
            the = (chain) { .n = 20, .k = 1e4, .ground = 0, .m = 3, .lead = lead };
            pg_solver_options o = options_of (kinds[kind], fine ? 8000 : 1000, 1e-6);
            PG_OWN (pg_stages_options, &o)->hold = 0, o.rows = 30;
            link_up (&l, &o, &chain_type);
            while (!pg_solver_done (l.solver, l.state)) check_ok (pg_solver_step (l.solver, l.state, &step));
            error[fine] = fabs (l.state->d[19] / 0.1 - 1);
            const pg_statistics *r = pg_solver_report_now (l.solver);
            assert_int_equal (r->iterations, fine ? 8000 : 1000);
            assert_int_equal (r->steps, 30);
            assert_true (r->residual_max > 0);
            check_contains (r->warning[r->nwarning - 1], "not in equilibrium");
            unlink_all (&l);
        }
        check_below (error[0], 0.2);
        check_below (error[1], 0.3 * error[0]);
    }
}

static pg_status stop_now (void *context, const pg_state *state, const pg_step *so_far)
{
    (void) state, (void) so_far;
    return --*(int *) context < 0 ? pg_error (PG_E_INTERRUPTED, PG_HERE, "enough") : PG_OK;
}

static void final_state (const char *kind, int hold, int threads, int stops, double *out)
{
    linked l;
    pg_step step;
    the = (chain) { .n = 390, .k = 1e4, .m = 1, .push = push, .lead = away };
    pg_solver_options o = options_of (kind, hold ? 3 : 5000, 1e-9);
    PG_OWN (pg_stages_options, &o)->hold = hold, o.rows = 2;
    link_up (&l, &o, &chain_type);
    l.problem.threads = threads;
    int left = stops, stopped = 0;
    while (!pg_solver_done (l.solver, l.state)) {
        pg_solver_watch (l.solver, stops >= 0 ? stop_now : NULL, &left);
        pg_status status = pg_solver_step (l.solver, l.state, &step);
        if (status == PG_E_INTERRUPTED) left = 100, stopped = 1;
        else check_ok (status);
    }
    assert_int_equal (stopped, stops >= 0);
    memcpy (out, l.state->d, the.n * sizeof *out);
    const pg_statistics *r = pg_solver_report_now (l.solver);
    out[the.n] = r->energy.external, out[the.n + 1] = (double) r->iterations,
    out[the.n + 2] = r->residual_max;
    unlink_all (&l);
}

static void bits_do_not_depend_on_threads_or_looks (void **state)
{
    (void) state;
    double plain[MOST + 8] = { 0 }, other[MOST + 8] = { 0 };
    for (int kind = 0; kind < 2; kind++)
        for (int hold = 0; hold < 2; hold++) {
            final_state (kinds[kind], hold, 1, -1, plain);
            final_state (kinds[kind], hold, 2, -1, other);
            assert_memory_equal (plain, other, sizeof plain);
            final_state (kinds[kind], hold, 1, 0, other);
            assert_memory_equal (plain, other, sizeof plain);
            final_state (kinds[kind], hold, 1, 2, other);
            assert_memory_equal (plain, other, sizeof plain);
        }
}

static void options_that_cannot_be_are_refused (void **state)
{
    (void) state;
    linked l;
    the = (chain) { .n = 4, .k = 1e4, .ground = 1e4, .m = 3 };
    for (int kind = 0; kind < 2; kind++) {
        pg_solver_options o = options_of (kinds[kind], 0, 1e-9);
        check_fails (try_link (&l, &o, &chain_type), PG_E_USAGE);
        unlink_all (&l);
        o = options_of (kinds[kind], 3, 0);
        check_fails (try_link (&l, &o, &chain_type), PG_E_USAGE);
        unlink_all (&l);
    }
    pg_force_type blind = chain_type;
    blind.matrix = NULL, blind.motion.row_sums = NULL;
    pg_solver_options o = options_of ("adr", 3, 1e-9);
    check_fails (try_link (&l, &o, &blind), PG_E_USAGE);
    check_contains (pg_last_error (), "use relax");
    unlink_all (&l);
    blind.matrix = chain_matrix;                       /* row sums from the matrix are the same */
    for (int k = 0; k < 2; k++) {
        link_up (&l, &o, k ? &blind : &chain_type);
        unlink_all (&l);
    }
    o = options_of ("relax", 3, 1e-9), o.dt = 1;
    check_fails (try_link (&l, &o, &chain_type), PG_E_SCENE);
    check_contains (pg_last_error (), "too large");
    unlink_all (&l);
}

static void every_allocation_may_fail (void **state)
{
    (void) state;
    the = (chain) { .n = 5, .k = 1e4, .m = 1, .lead = lead, .push = push };
    for (int kind = 0; kind < 2; kind++) {
        pg_solver_options o = options_of (kinds[kind], 2, 1e-6);
        each_allocation_may_fail (&o);
    }
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (equilibrium_under_a_load),
        cmocka_unit_test (equilibrium_of_a_moved_support),
        cmocka_unit_test (sums_of_rows_may_be_left_to_the_matrix),
        cmocka_unit_test (loads_need_not_be_proportional),
        cmocka_unit_test (proportional_stages_take_no_iterations),
        cmocka_unit_test (nothing_to_do_is_balance),
        cmocka_unit_test (what_finds_no_balance_is_refused),
        cmocka_unit_test (one_iteration_a_stage_follows_slow_loads),
        cmocka_unit_test (bits_do_not_depend_on_threads_or_looks),
        cmocka_unit_test (options_that_cannot_be_are_refused),
        cmocka_unit_test (every_allocation_may_fail),
    };
    return cmocka_run_group_tests_name ("solve/relaxation", tests, NULL, NULL);
}
