/* SPDX-License-Identifier: GPL-3.0-or-later
 * Newmark's method on one degree of freedom, m u'' + c u' + k u = p, through the solver and a force of our
 * own (theory F5, table H F-1, F-2). Every run is made with the matrix and matrix-free. */
#include "check.h"
#include "perigal/solve.h"

/* ---- the force ----------------------------------------------------------------------------------------- */
/* hold: p acts up to here, s */
typedef struct {
    pg_sparse K;
    long start[2], row[1];
    double value[1];
    pg_operator op;
    double k, m, p, hold;
} spring;
static spring the;

static void apply (void *context, const double *x, double *y) { y[0] = ((spring *) context)->k * x[0]; }
static void diagonal (void *context, double *d) { d[0] = ((spring *) context)->k; }

static pg_status spring_create (void **self, const pg_problem *problem)
{
    (void) problem;
    the.start[1] = 1, the.value[0] = the.k;
    the.K = (pg_sparse) { 1, 1, 1, the.start, the.row, the.value };
    the.op = (pg_operator) { 1, &the, apply, diagonal };
    *self = &the;
    return PG_OK;
}
static void spring_free (void **self) { *self = NULL; }
static size_t spring_fields (const void *self, size_t max, pg_field *out)
{
    (void) self;
    if (max) out[0] = (pg_field) { "displacement", "m", 1 };
    return 1;
}
static pg_status spring_refresh (void *self, const pg_state *state, const pg_changes *changes)
{
    (void) self, (void) state, (void) changes;
    return PG_OK;
}
static pg_status spring_balance (void *self, double t, const double *d, double *residual, double *reference)
{
    spring *s = self;
    double p = t <= s->hold ? s->p : 0;
    residual[0] = p - s->k * d[0];
    *reference = fmax (fabs (p), fabs (s->k * d[0]));
    return PG_OK;
}
static pg_status spring_mass (void *self, double *mass, const pg_sparse **consistent)
{
    if (consistent) *consistent = NULL;
    if (mass) mass[0] = ((spring *) self)->m;
    return PG_OK;
}
static const pg_operator *spring_operator (void *self) { return &((spring *) self)->op; }
static pg_status spring_matrix (void *self, pg_matrix_want want, const pg_sparse **K)
{
    (void) want;
    *K = &((spring *) self)->K;
    return PG_OK;
}

static const pg_force_type spring_types[2] = { { .method = { .name = "spring" },
                                                 .create = spring_create,
                                                 .free = spring_free,
                                                 .fields = spring_fields,
                                                 .refresh = spring_refresh,
                                                 .balance = spring_balance,
                                                 .mass = spring_mass,
                                                 .operator_ = spring_operator,
                                                 .matrix = spring_matrix },
                                               { .method = { .name = "spring" },
                                                 .create = spring_create,
                                                 .free = spring_free,
                                                 .fields = spring_fields,
                                                 .refresh = spring_refresh,
                                                 .balance = spring_balance,
                                                 .mass = spring_mass,
                                                 .operator_ = spring_operator } };

/* ---- runs ---------------------------------------------------------------------------------------------- */
typedef struct { double u, v, a; } motion;

static pg_solver_options options_of (double dt, long steps, double c)
{
    pg_solver_options o = { .kind = "newmark",
                            .linear = "auto",
                            .tolerance = 1e-8,
                            .steps = steps,
                            .max_iterations = 10,
                            .dt = dt,
                            .end = dt * (double) steps,
                            .levels = 1 };
    *PG_OWN (pg_newmark_options,
             &o) = (pg_newmark_options){ .beta = 0.25, .gamma = 0.5, .rayleigh_mass = c / the.m };
    return o;
}

static int by_stiffness;                               /* damping as a share of K instead of M */

/* path[0..steps]: start and what follows */
static void run (const pg_solver_options *o, int matrix_free, motion start, motion *path)
{
    double x = 0, volume = 1;
    int block = 0;
    pg_problem problem = { .dim = 1,
                           .threads = 1,
                           .cloud = {
                               .dim = 1, .n = 1, .x = &x, .volume = &volume, .block = &block, .h = 1 } };
    pg_solver *solver = NULL;
    pg_state *state = NULL;
    pg_step step;
    long k = 0;
    check_ok (pg_solver_create_with (&solver, &problem, o, &spring_types[matrix_free]));
    check_ok (pg_state_create (&state, &problem, pg_solver_components (solver)));
    assert_int_equal (state->ndof, 1);
    state->d[0] = start.u, state->v[0] = start.v;
    path[0] = start;
    while (!pg_solver_done (solver, state)) {
        check_ok (pg_solver_step (solver, state, &step));
        path[++k] = (motion) { state->d[0], state->v[0], state->a[0] };
    }
    assert_int_equal (k, o->steps);
    pg_state_free (&state);
    pg_solver_free (&solver);
}

/* ---- F-1, F-2 ------------------------------------------------------------------------------------------ */
static void five_steps_of_the_damped_oscillator (void **state)
{
    (void) state;
    for (int free = 0; free < 2; free++) {
        motion path[6];
        the = (spring) { .k = 100, .m = 1, .p = 1, .hold = INFINITY };
        pg_solver_options o = options_of (0.02, 5, 2);
        run (&o, free, (motion) { 0 }, path);
        check_relative (path[5].u, 0.00428226, 1e-6);
        check_relative (path[5].v, 0.076193, 1e-6);
        check_relative (path[5].a, 0.41938785, 1e-6);
    }
}

static void coefficients (void **state)
{
    (void) state;
    pg_solver_options o = { .dt = 1e-4 };
    *PG_OWN (pg_newmark_options, &o) = (pg_newmark_options) { .beta = 0.25, .gamma = 0.5 };
    static const double expected[8] = { 4e8, 4e4, 2, 2e4, 2, 0, 5e-5, 5e-5 };
    double b[8];
    pg_newmark_coefficients (&o, b);
    for (int k = 0; k < 8; k++) assert_true (b[k] == expected[k]);
}

/* ---- against the exact motion -------------------------------------------------------------------------- */
enum { LONG = 1600 };

/* Largest error of u over a run from (u0, v0) without load, relative to the amplitude; period 2 pi / 10 s. */
static double worst_error (double dt, long steps, double c, motion start, double gamma, int free)
{
    static motion path[LONG + 1];
    the = (spring) { .k = 100, .m = 1 };
    pg_solver_options o = options_of (dt, steps, c);
    if (by_stiffness)
        PG_OWN (pg_newmark_options, &o)->rayleigh_stiffness = c / the.k,
                                    PG_OWN (pg_newmark_options, &o)->rayleigh_mass = 0;
    PG_OWN (pg_newmark_options, &o)->gamma = gamma,
                                PG_OWN (pg_newmark_options, &o)->beta = 0.25 * (gamma + 0.5) * (gamma + 0.5);
    run (&o, free, start, path);
    double decay = 0.5 * c, omega = sqrt (100 - decay * decay), B = (start.v + decay * start.u) / omega,
           worst = 0;
    for (long k = 0; k <= steps; k++) {
        double t = dt * (double) k;
        worst = fmax (worst, fabs (path[k].u
                                   - exp (-decay * t) * (start.u * cos (omega * t) + B * sin (omega * t))));
    }
    return worst / hypot (start.u, B);
}

static void second_order (double c, motion start)
{
    for (int free = 0; free < 2; free++) {
        double coarse = worst_error (4e-3, 200, c, start, 0.5, free),
               middle = worst_error (2e-3, 400, c, start, 0.5, free);
        double fine = worst_error (1e-3, 800, c, start, 0.5, free);
        check_relative (coarse / middle, 4, 0.03);
        check_relative (middle / fine, 4, 0.01);
        check_below (fine, 1e-3);
    }
}

static void free_vibration_is_of_second_order (void **state)
{
    (void) state;
    second_order (0, (motion){ .u = 1e-3 });
}
static void start_with_a_velocity (void **state)
{
    (void) state;
    second_order (0, (motion){ .v = 1e-2 });
}
static void damping_counts_from_the_first_step (void **state)
{
    (void) state;
    second_order (4, (motion){ .u = 1e-3, .v = 1e-2 });
}
static void damping_by_stiffness                (void **state)
{
    (void) state;
    by_stiffness = 1;
    second_order (4, (motion) { .u = 1e-3, .v = 1e-2 });
    by_stiffness = 0;
}

static void gamma_above_a_half_is_of_first_order (void **state)
{
    (void) state;
    motion start = { .u = 1e-3 };
    check_relative (worst_error (2e-3, 400, 0, start, 0.6, 0) / worst_error (1e-3, 800, 0, start, 0.6, 0), 2,
                    0.1);
}

/* beta = 1/4, gamma = 1/2 keep k u^2 + m v^2, at any step: here 0.6 to 60 steps a period. */
static void energy_is_kept (void **state)
{
    (void) state;
    static motion path[201];
    for (int k = 0; k < 9; k++) {
        double dt = (k % 3 == 0 ? 1e-2 : k % 3 == 1 ? 0.1 : 1.0);
        motion start = { k / 3 != 1 ? 1e-3 : 0, k / 3 != 0 ? -2e-2 : 0, 0 };
        the = (spring) { .k = 100, .m = 1 };
        pg_solver_options o = options_of (dt, 200, 0);
        run (&o, 0, start, path);
        for (int i = 1; i <= 200; i++)
            check_relative (100 * path[i].u * path[i].u + path[i].v * path[i].v,
                            100 * start.u * start.u + start.v * start.v, 1e-9);
    }
}

/* Without a spring: u = v t + p t^2 / 2, exactly for every step. */
static void a_free_mass_flies (void **state)
{
    (void) state;
    motion path[51];
    for (int load = 0; load < 2; load++) {
        the = (spring) { .k = 0, .m = 3, .p = load ? 6 : 0, .hold = INFINITY };
        pg_solver_options o = options_of (0.1, 50, 0);
        run (&o, 1, (motion) { .v = 2 }, path);
        for (int i = 1; i <= 50; i++) {
            double t = 0.1 * i;
            check_relative (path[i].u, 2 * t + load * t * t, 1e-11);
            check_relative (path[i].v, 2 + 2 * load * t, 1e-11);
        }
    }
}

/* beta = 1/2, gamma = 1 have no memory of the acceleration: one step of 1e8 periods is the static answer. */
static void a_huge_step_is_static (void **state)
{
    (void) state;
    motion path[2];
    for (int free = 0; free < 2; free++) {
        the = (spring) { .k = 100, .m = 1, .p = 5, .hold = INFINITY };
        pg_solver_options o = options_of (6e7, 1, 0);
        PG_OWN (pg_newmark_options, &o)->beta = 0.5, PG_OWN (pg_newmark_options, &o)->gamma = 1;
        run (&o, free, (motion) { 0 }, path);
        check_relative (path[1].u, 0.05, 1e-12);
    }
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (five_steps_of_the_damped_oscillator),
        cmocka_unit_test (coefficients),
        cmocka_unit_test (free_vibration_is_of_second_order),
        cmocka_unit_test (start_with_a_velocity),
        cmocka_unit_test (damping_counts_from_the_first_step),
        cmocka_unit_test (damping_by_stiffness),
        cmocka_unit_test (gamma_above_a_half_is_of_first_order),
        cmocka_unit_test (energy_is_kept),
        cmocka_unit_test (a_free_mass_flies),
        cmocka_unit_test (a_huge_step_is_static),
    };
    return cmocka_run_group_tests_name ("solve/newmark_sdof", tests, NULL, NULL);
}
