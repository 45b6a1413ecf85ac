/* SPDX-License-Identifier: GPL-3.0-or-later
 * verlet and central on chains of masses: frequency, order, energy, momentum, supports that move, loads,
 * stable time steps, rows, looks in between, refusals (theory A4, B4, G4). */
#include "chain.h"
#include <float.h>

static const double pi = 3.14159265358979323846;
static const char *const kinds[2] = { "verlet", "central" };

static pg_solver_options options_of (const char *kind, double dt, long steps)
{
    pg_solver_options o = { .linear = "auto",
                            .tolerance = 1e-8,
                            .dt = dt,
                            .time_steps = steps,
                            .levels = 1,
                            .rows = 1,
                            .max_events = 1000000 };
    strcpy (o.kind, kind);
    return o;
}

/* Amplitude q of d = q sin ((i + 1) p) for masses between walls, by projection. */
static double amplitude (const double *d, double p)
{
    double up = 0, down = 0;
    for (size_t i = 0; i < the.n; i++)
        up += d[i] * sin ((double) (i + 1) * p), down += pow (sin ((double) (i + 1) * p), 2);
    return up / down;
}

/* Both ends held: the ground spring of stiffness k on the left, an own mass at the right end that does not
 * move (lead of a mirrored chain would do the same): modes of the fixed-free chain, p = (j - 1/2) pi / (n +
 * 1/2), omega = 2 sqrt (k / m) sin (p / 2). */
static double mode_of (size_t n, int j) { return (j - 0.5) * pi / ((double) n + 0.5); }

static void a_mode_moves_with_the_discrete_frequency (void **state)
{
    (void) state;
    for (int kind = 0; kind < 2; kind++)
        for (int j = 1; j <= 13; j += 4) {
            linked l;
            the = (chain) { .n = 13, .k = 1e6, .ground = 1e6, .m = 0.5 };
            double p = mode_of (13, j), omega = 2 * sqrt (the.k / the.m) * sin (p / 2),
                   dt = 0.3 / sqrt (the.k / the.m);
            double W = acos (1 - omega * omega * dt * dt / 2);
            pg_solver_options o = options_of (kinds[kind], dt, 997);
            link_up (&l, &o, &chain_type);
            for (size_t i = 0; i < the.n; i++) l.state->d[i] = 1e-3 * sin ((double) (i + 1) * p);
            run_all (&l);
            check_scaled (amplitude (l.state->d, p), 1e-3 * cos (997 * W), 1e-9, 1e-3);
            for (size_t i = 0; i < the.n; i++)
                check_scaled (l.state->d[i], 1e-3 * cos (997 * W) * sin ((double) (i + 1) * p), 1e-9, 1e-3);
            unlink_all (&l);
        }
}

/* One mass on a spring to the ground, damped: error against the exact motion at t = 2 s. */
static double oscillator_error (const char *kind, double c, long steps)
{
    linked l;
    the = (chain) { .n = 1, .k = 1, .ground = 100, .m = 1 };
    pg_solver_options o = options_of (kind, 2.0 / (double) steps, steps);
    PG_OWN (pg_explicit_options, &o)->rayleigh_mass = c;
    link_up (&l, &o, &chain_type);
    l.state->d[0] = 0.3, l.state->v[0] = 2;
    run_all (&l);
    double decay = 0.5 * c, omega = sqrt (100 - decay * decay), B = (2 + decay * 0.3) / omega,
           u = exp (-decay * 2) * (0.3 * cos (2 * omega) + B * sin (2 * omega));
    double error = l.state->d[0] - u;
    check_relative (l.state->time, 2, 1e-15);
    unlink_all (&l);
    return error;
}

static void second_order_in_the_time_step (void **state)
{
    (void) state;
    for (int kind = 0; kind < 2; kind++)
        for (double c = 0; c < 5; c += 2) {
            double coarse = oscillator_error (kinds[kind], c, 800),
                   middle = oscillator_error (kinds[kind], c, 1600),
                   fine = oscillator_error (kinds[kind], c, 3200);
            check_relative (coarse / middle, 4, 0.02);
            check_relative (middle / fine, 4, 0.01);
        }
}

static void both_writings_are_one_method (void **state)
{
    (void) state;
    double end[2][20], v[20], a[20];
    for (int kind = 0; kind < 2; kind++) {
        linked l;
        the = (chain) { .n = 20, .k = 1e5, .ground = 1e5, .m = 1 };
        pg_solver_options o = options_of (kinds[kind], 1e-3, 1000);
        PG_OWN (pg_explicit_options, &o)->rayleigh_mass = 3;
        link_up (&l, &o, &chain_type);
        for (size_t i = 0; i < 20; i++)
            l.state->d[i] = sin (3.0 * (double) i), l.state->v[i] = 100 * cos (5.0 * (double) i);
        run_all (&l);
        memcpy (end[kind], l.state->d, sizeof end[kind]);
        if (kind == 0) memcpy (v, l.state->v, sizeof v), memcpy (a, l.state->a, sizeof a);
        /* half a step ahead */
        for (size_t i = 0; kind == 1 && i < 20; i++)
            check_scaled (l.state->v[i], v[i] + 5e-4 * a[i], 1e-9, 100);
        unlink_all (&l);
    }
    for (size_t i = 0; i < 20; i++) check_scaled (end[1][i], end[0][i], 1e-10, 1);
}

/* ---- what is kept -------------------------------------------------------------------------------------- */
static void free_flight_and_momentum (void **state)
{
    (void) state;
    for (int kind = 0; kind < 2; kind++) {
        linked l;
        the = (chain) { .n = 50, .k = 1e4, .m = 2 };
        pg_solver_options o = options_of (kinds[kind], 1e-2, 10000);
        link_up (&l, &o, &chain_type);
        for (size_t i = 0; i < 50; i++) l.state->v[i] = 3;
        run_all (&l);
        for (size_t i = 0; i < 50; i++) check_relative (l.state->d[i], 300, 1e-11);
        unlink_all (&l);
        link_up (&l, &o, &chain_type);
        double before = 0, after = 0, size = 0;
        for (size_t i = 0; i < 50; i++)
            l.state->v[i] = sin (7.0 * (double) i), l.state->d[i] = 1e-3 * cos (5.0 * (double) i),
            before += l.state->v[i], size += 1;
        run_all (&l);
        for (size_t i = 0; i < 50; i++) after += l.state->v[i];
        check_scaled (after, before, 1e-11, size);
        unlink_all (&l);
    }
}

static void energy_stays_over_ten_thousand_steps (void **state)
{
    (void) state;
    for (int kind = 0; kind < 2; kind++) {
        linked l;
        pg_step step;
        the = (chain) { .n = 60, .k = 1e4, .ground = 1e4, .m = 1 };
        pg_solver_options o = options_of (kinds[kind], 0, 10000);      /* 0.9 of the stable one */
        o.rows = 100;
        link_up (&l, &o, &chain_type);
        for (size_t i = 0; i < 60; i++)
            l.state->v[i] = sin (7.0 * (double) i), l.state->d[i] = 1e-3 * cos (5.0 * (double) i);
        double first = 0;
        while (!pg_solver_done (l.solver, l.state)) {
            check_ok (pg_solver_step (l.solver, l.state, &step));
            const pg_statistics *r = pg_solver_report_now (l.solver);
            if (first == 0) first = r->energy.strain + r->energy.kinetic;
            assert_true (first > 0);
            check_relative (r->energy.strain + r->energy.kinetic, first, 1e-11);
            check_scaled (r->energy.dissipated, 0, 1e-11, first);
        }
        check_relative (pg_solver_settled (l.solver)->dt, 0.9 * 2 / sqrt (4 * the.k / the.m), 1e-12);
        unlink_all (&l);
    }
}

static double swing (double t) { return 5 * sin (40 * t); }
static double speed (double t) { return 2 * t; }
static double throw (double t) { return 0.5 * 3 * t * t; }

static void damping_and_loads_close_the_balance (void **state)
{
    (void) state;
    for (int kind = 0; kind < 2; kind++)
        for (int held = 0; held < 2; held++) {
            linked l;
            the = (chain){ .n = 40,
                           .k = 1e4,
                           .ground = held ? 0 : 1e4,
                           .m = 1,
                           .push = swing,
                           .lead = held ? throw : NULL };
            pg_solver_options o = options_of (kinds[kind], 0, 3000);
            PG_OWN (pg_explicit_options, &o)->rayleigh_mass = 4, o.rows = 7;
            link_up (&l, &o, &chain_type);
            run_all (&l);
            const pg_statistics *r = pg_solver_report_now (l.solver);
            assert_true (r->energy.damping > 0.01 * fabs (r->energy.external));
            check_scaled (r->energy.dissipated, 0, 1e-11, fabs (r->energy.external));
            unlink_all (&l);
        }
}

/* ---- supports ------------------------------------------------------------------------------------------ */
static void supports_move_as_they_are_told (void **state)
{
    (void) state;
    for (int kind = 0; kind < 2; kind++) {
        linked l;
        pg_step step;
        the = (chain) { .n = 2, .k = 1e-30, .m = 2, .lead = speed };
        pg_solver_options o = options_of (kinds[kind], 1e-3, 100);
        link_up (&l, &o, &chain_type);
        check_ok (pg_solver_step (l.solver, l.state, &step));
        check_relative (l.state->d[0], 0.2, 1e-15);
        check_relative (l.state->v[0], 2, 1e-12);
        check_scaled (l.state->a[0], 0, 1e-8, 1);
        /* set off at once: m v^2 / 2 */
        check_relative (pg_solver_report_now (l.solver)->energy.external, 0.5 * 2 * 4, 1e-12);
        check_relative (pg_solver_report_now (l.solver)->energy.kinetic, 0.5 * 2 * 4, 1e-12);
        unlink_all (&l);
        the.lead = throw;
        link_up (&l, &o, &chain_type);
        check_ok (pg_solver_step (l.solver, l.state, &step));
        check_relative (l.state->d[0], 0.5 * 3 * 0.01, 1e-14);
        check_relative (l.state->v[0], 3 * (0.1 + (kind ? 5e-4 : 0)), 1e-9);
        check_relative (l.state->a[0], 3, 1e-9);
        check_relative (step.reaction[0], 2 * 3, 1e-9);                 /* m a, the spring is nothing */
        unlink_all (&l);
    }
}

static void a_pulled_chain_follows_its_closed_form (void **state)
{
    (void) state;
    the = (chain) { .n = 2, .k = 100, .m = 1, .lead = throw };          /* u'' + 100 u = 100 * 1.5 t^2 */
    for (int kind = 0; kind < 2; kind++) {
        double error[2];
        for (int fine = 0; fine < 2; fine++) {
            linked l;
            pg_solver_options o = options_of (kinds[kind], 1.0 / (500 << fine), 500 << fine);
            link_up (&l, &o, &chain_type);
            run_all (&l);
            error[fine] = l.state->d[1] - (1.5 - 0.03 * (1 - cos (10.0)));
            unlink_all (&l);
        }
        check_below (fabs (error[1]), 1e-6);
        check_relative (error[0] / error[1], 4, 0.02);
    }
}

/* ---- stable time steps --------------------------------------------------------------------------------- */
static void time_steps_beyond_the_stable_one_are_refused (void **state)
{
    (void) state;
    linked l;
    for (int kind = 0; kind < 2; kind++) {
        the = (chain) { .n = 300, .k = 1e4, .ground = 0, .m = 1 };
        double limit = 2 / (200 * sin (pi * 299 / 600)), bound = 2 / 200.0;  /* free-free chain; row sums */
        pg_solver_options o = options_of (kinds[kind], 1.2 * limit, 10000);
        size_t used = pg_memory_used ();
        check_fails (try_link (&l, &o, &chain_type), PG_E_SCENE);
        check_contains (pg_last_error (), "solver.dt: 0.012");
        check_contains (pg_last_error (), "stable up to 0.0099");
        unlink_all (&l);
        assert_int_equal (pg_memory_used (), used);
        o = options_of (kinds[kind], 0.999 * bound, 10000);
        link_up (&l, &o, &chain_type);
        for (size_t i = 0; i < the.n; i++) l.state->v[i] = i % 2 ? 1 : -1;
        run_all (&l);
        for (size_t i = 0; i < the.n; i++) assert_true (fabs (l.state->d[i]) < 1);
        const char *from;
        check_relative (pg_solver_stable (l.solver, &from), bound, 1e-12);
        check_contains (from, "row sums");
        unlink_all (&l);
    }
    /* the row sum of a free end is not reached: a mass on one spring of stiffness 2 k, omega^2 = 2 k / m
     * against 4 k / m by rows */
    the = (chain) { .n = 2, .k = 1e4, .ground = 0, .m = 1 };
    pg_force_type rough = chain_type;
    rough.motion.bound = NULL;
    pg_solver_options o = options_of ("verlet", 0.97 * 2 / sqrt (2e4), 100);
    link_up (&l, &o, &rough);
    unlink_all (&l);
}

static pg_status wide_bound (void *self, double *omega)
{
    *omega = 3 * sqrt (4 * ((chain *) self)->k / the.m);
    return PG_OK;
}

static void the_frequency_itself_decides_beyond_the_bound (void **state)
{
    (void) state;
    linked l;
    pg_force_type type = chain_type;
    type.motion.bound = wide_bound;
    the = (chain) { .n = 30, .k = 1e4, .ground = 1e4, .m = 1 };
    double limit = 2 / (200 * sin (mode_of (30, 30) / 2));
    pg_solver_options o = options_of ("verlet", 0, 10);
    link_up (&l, &o, &type);
    check_relative (pg_solver_settled (l.solver)->dt, 0.9 * limit / 3, 0.01);
    unlink_all (&l);
    o = options_of ("verlet", 0.97 * limit, 10000);
    link_up (&l, &o, &type);
    l.state->v[3] = 1;
    run_all (&l);
    for (size_t i = 0; i < the.n; i++) assert_true (fabs (l.state->d[i]) < 1);
    unlink_all (&l);
    o = options_of ("verlet", 1.02 * limit, 10);
    check_fails (try_link (&l, &o, &type), PG_E_SCENE);
    unlink_all (&l);
}

/* ---- rows, looks --------------------------------------------------------------------------------------- */
static void rows_and_levels_are_met (void **state)
{
    (void) state;
    linked l;
    pg_step step;
    the = (chain) { .n = 3, .k = 1e4, .ground = 1e4, .m = 1 };
    for (long total = 1; total < 400; total = total * 3 + 1)
        for (long rows = 1; rows < 60; rows += 7) {
            pg_solver_options o = options_of ("verlet", 1e-3, total);
            o.rows = rows, o.levels = 4;
            link_up (&l, &o, &chain_type);
            long n = 0, levels = 0, last = 0;
            while (!pg_solver_done (l.solver, l.state)) {
                check_ok (pg_solver_step (l.solver, l.state, &step));
                n++, levels += step.level, last = l.state->iterations;
                check_relative (step.time, 1e-3 * (double) last, 1e-14);
                assert_true (step.level
                             == (last == (total + 3) / 4 || last == (2 * total + 3) / 4
                                 || last == (3 * total + 3) / 4 || last == total));
            }
            assert_int_equal (last, total);
            assert_true (n <= (rows > 4 ? rows : 4) && (n == total || n >= (rows > 4 ? rows / 4 * 4 : 4)));
            assert_int_equal (n, pg_solver_settled (l.solver)->steps);
            assert_int_equal (levels, total < 4 ? total : 4);
            unlink_all (&l);
        }
}

static pg_status stop_now (void *context, const pg_state *state, const pg_step *so_far)
{
    (void) state, (void) so_far;
    return --*(int *) context < 0 ? pg_error (PG_E_INTERRUPTED, PG_HERE, "enough") : PG_OK;
}

/* 2500 steps: looks at 1000 and 2000, for a chain without bonds. */
static void final_state (const char *kind, long rows, int threads, int stops, double *out)
{
    linked l;
    pg_step step;
    the = (chain) { .n = 130, .k = 1e4, .m = 1, .push = swing, .lead = throw };
    pg_solver_options o = options_of (kind, 0, 2500);
    o.rows = rows, PG_OWN (pg_explicit_options, &o)->rayleigh_mass = 0.7;
    link_up (&l, &o, &chain_type);
    l.problem.threads = threads;
    int left = stops;
    while (!pg_solver_done (l.solver, l.state)) {
        pg_solver_watch (l.solver, stops >= 0 ? stop_now : NULL, &left);
        pg_status status = pg_solver_step (l.solver, l.state, &step);
        if (status == PG_E_INTERRUPTED) left = 100;
        else check_ok (status);
    }
    memcpy (out, l.state->d, the.n * sizeof *out);
    memcpy (out + the.n, l.state->v, the.n * sizeof *out);
    const pg_statistics *r = pg_solver_report_now (l.solver);
    out[2 * the.n] = r->energy.external, out[2 * the.n + 1] = r->energy.damping,
            out[2 * the.n + 2] = r->energy.kinetic;
    unlink_all (&l);
}

static void bits_do_not_depend_on_rows_threads_or_looks (void **state)
{
    (void) state;
    double plain[3 * MOST] = { 0 }, other[3 * MOST] = { 0 };
    for (int kind = 0; kind < 2; kind++) {
        final_state (kinds[kind], 1, 1, -1, plain);
        final_state (kinds[kind], 1, 1, 0, other);
        assert_memory_equal (plain, other, sizeof plain);
        final_state (kinds[kind], 1, 1, 1, other);
        assert_memory_equal (plain, other, sizeof plain);
        final_state (kinds[kind], 333, 1, -1, other);
        assert_memory_equal (plain, other, sizeof plain);
        final_state (kinds[kind], 1, 2, -1, other);
        assert_memory_equal (plain, other, sizeof plain);
    }
}

/* ---- a row that is repeated ---------------------------------------------------------------------------- */
static int balances, fails_at;
static pg_status failing_balance (void *self, double t, const double *d, double *residual, double *reference)
{
    if (++balances == fails_at) return pg_error (PG_E_MEMORY, PG_HERE, "no memory");
    return chain_balance (self, t, d, residual, reference);
}

/* Energies of a damped chain in rows of ten time steps; of an evaluation that fails the row is made again. */
static void energies_of_rows (const char *kind, int fails, double *out)
{
    linked l;
    pg_step step;
    pg_force_type type = chain_type;
    int refused = 0;
    the = (chain) { .n = 12, .k = 1e4, .ground = 1e4, .m = 1, .push = swing };
    pg_solver_options o = options_of (kind, 1e-3, 60);
    o.rows = 6, PG_OWN (pg_explicit_options, &o)->rayleigh_mass = 5;
    type.balance = failing_balance;
    balances = 0, fails_at = fails;
    link_up (&l, &o, &type);
    while (!pg_solver_done (l.solver, l.state)) {
        pg_status status = pg_solver_step (l.solver, l.state, &step);
        refused += status != PG_OK;
        assert_true (status == PG_OK || (status == PG_E_MEMORY && refused == 1));
    }
    assert_int_equal (refused, fails > 0);
    const pg_statistics *r = pg_solver_report_now (l.solver);
    out[0] = r->energy.external, out[1] = r->energy.damping, out[2] = r->energy.kinetic, out[3] =
        r->energy.dissipated;
    unlink_all (&l);
}

static void a_row_that_is_repeated_damps_once (void **state)
{
    (void) state;
    for (int kind = 0; kind < 2; kind++) {
        double whole[4], again[4];
        energies_of_rows (kinds[kind], 0, whole), energies_of_rows (kinds[kind], 38, again);
        assert_true (whole[1] > 0.01 * fabs (whole[0]));
        for (int k = 0; k < 3; k++) check_relative (again[k], whole[k], 1e-12);
        check_scaled (again[3], whole[3], 1e-11, fabs (whole[0]));
    }
}

/* ---- refusals ------------------------------------------------------------------------------------------ */
static double burst (double t) { return t > 0.05 ? DBL_MAX : 0; }

static void refusals_say_what_to_do (void **state)
{
    (void) state;
    linked l;
    pg_step step;
    pg_solver_options o = options_of ("verlet", 1e-3, 100);
    the = (chain) { .n = 5, .k = 1e4, .m = 1, .lead = speed, .tied = 1 };
    check_fails (try_link (&l, &o, &chain_type), PG_E_SCENE);
    check_contains (pg_last_error (), "essential: nitsche");
    unlink_all (&l);
    the = (chain) { .n = 5, .k = 1e4, .ground = 1, .m = 0 };
    check_fails (try_link (&l, &o, &chain_type), PG_E_SCENE);
    check_contains (pg_last_error (), "needs mass");
    unlink_all (&l);
    o.dt = 0;
    the = (chain) { .n = 5, .k = 0, .m = 1 };
    check_fails (try_link (&l, &o, &chain_type), PG_E_SCENE);
    check_contains (pg_last_error (), "give solver.dt");
    unlink_all (&l);
    o.dt = 1e-3, o.time_steps = 0;
    check_fails (try_link (&l, &o, &chain_type), PG_E_USAGE);
    check_contains (pg_last_error (), "solver.end");
    unlink_all (&l);
    for (int kind = 0; kind < 2; kind++) {
        o = options_of (kinds[kind], 1e-3, 100), o.rows = 4;
        the = (chain) { .n = 5, .k = 1e4, .ground = 1e4, .m = 1, .push = burst };
        link_up (&l, &o, &chain_type);
        check_ok (pg_solver_step (l.solver, l.state, &step));
        l.state->v[0] = 0;
        pg_status status = PG_OK;
        while (status == PG_OK && !pg_solver_done (l.solver, l.state))
            status = pg_solver_step (l.solver, l.state, &step);
        assert_int_equal (status, PG_E_EQUILIBRIUM);
        check_contains (pg_last_error (), "no longer finite");
        assert_int_equal (l.state->step, 2);
        for (size_t i = 0; i < 5; i++) assert_true (isfinite (l.state->d[i]) && isfinite (l.state->v[i]));
        unlink_all (&l);
    }
}

static void every_allocation_may_fail (void **state)
{
    (void) state;
    the = (chain) { .n = 5, .k = 1e4, .m = 1, .lead = speed, .push = swing };
    for (int kind = 0; kind < 2; kind++) {
        pg_solver_options o = options_of (kinds[kind], 1e-3, 10);
        each_allocation_may_fail (&o);
    }
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (a_mode_moves_with_the_discrete_frequency),
        cmocka_unit_test (second_order_in_the_time_step),
        cmocka_unit_test (both_writings_are_one_method),
        cmocka_unit_test (free_flight_and_momentum),
        cmocka_unit_test (energy_stays_over_ten_thousand_steps),
        cmocka_unit_test (damping_and_loads_close_the_balance),
        cmocka_unit_test (supports_move_as_they_are_told),
        cmocka_unit_test (a_pulled_chain_follows_its_closed_form),
        cmocka_unit_test (time_steps_beyond_the_stable_one_are_refused),
        cmocka_unit_test (the_frequency_itself_decides_beyond_the_bound),
        cmocka_unit_test (rows_and_levels_are_met),
        cmocka_unit_test (bits_do_not_depend_on_rows_threads_or_looks),
        cmocka_unit_test (a_row_that_is_repeated_damps_once),
        cmocka_unit_test (refusals_say_what_to_do),
        cmocka_unit_test (every_allocation_may_fail),
    };
    return cmocka_run_group_tests_name ("solve/explicit", tests, NULL, NULL);
}
