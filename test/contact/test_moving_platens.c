/* SPDX-License-Identifier: GPL-3.0-or-later
 * Rigid platens in explicit steps: walls, impactors with a mass, motions that are prescribed, friction;
 * momentum, energy; threads, checkpoints, refused steps; what is refused. */
#include "refused.h"
#include "scene_runs/run.h"
#include "solve/tape.h"

/* A block of 20 x 12 spacings at x from 0; its velocity; what the platen is; more lines. unit: m. */
static run block (double unit, int threads, const char *solver, double v, const char *platen,
                  const char *more)
{
    return scene_of (threads,
                     "dimension: 2\nplane: stress\nthickness: %.17g\nbody: [{add: {box: {low: [0, 0], high: "
                     "[%.17g, %.17g]}}}]\nspacing: %.17g\nlattice: cells\nmaterials: {m: {youngs_modulus: "
                     "1000, "
                     "poissons_ratio: 0.333333333333333, density: 1}}\nmethod: {force: bond, accept_inexact: "
                     "yes}\ninitial: {velocity: {x: %.17g}}\nplatens: [{name: anvil, %s}]\n"
                     "solver: {%s}\noutput: {at: {levels: 1, rows: 400}}\n%s",
                     unit, 20 * unit, 12 * unit, unit, v, platen, solver, more);
}

static double momentum (const run *r, size_t k, double *size)
{
    double p = 0;
    *size = 0;
    for (size_t i = 0; i < r->problem->cloud.n; i++) {
        double m = r->problem->material->density * r->problem->cloud.volume[i];
        p += m * r->state->v[2 * i + k], *size += fabs (m * r->state->v[2 * i + k]);
    }
    return p;
}

/* A wall throws a block back: its momentum turns round, but for what goes on as vibration; energy stays. */
static void walls_throw_back (void **state)
{
    (void) state;
    for (int k = 0; k < 2; k++) {
        double unit = k ? 1e-3 : 1, size, before, after;
        char platen[200];
        snprintf (platen, sizeof platen, "point: [%.17g, 0], normal: [-2, 0]", 21 * unit);
        char solver[80];
        snprintf (solver, sizeof solver, "kind: verlet, end: %.17g", 8 * unit);
        run r = block (unit, 1, solver, 0.5, platen, "");
        before = momentum (&r, 0, &size);
        to_the_end (&r);
        after = momentum (&r, 0, &size);
        const pg_statistics *s = pg_solver_report (r.solver, r.state);
        size_t n;
        const pg_platen_values *platens = pg_solver_platens (r.solver, &n);
        print_message ("wall: momentum %.4f of that before, energy %.1e, overlap %.3g spacings\n",
                       after / before, s->energy.dissipated / s->energy.external,
                       s->contact.overlap_max / unit);
        check_relative (after, -before, 0.1);
        /* a face that meets a plane all at once, a length of 20 spacings: elsewhere it is below 1e-3 */
        check_below (fabs (s->energy.dissipated), 2e-3 * s->energy.external);
        assert_int_equal (n, 1);
        assert_true (s->contact.touching == 0 && platens[0].force[0] == 0 && platens[0].motion[0] == 0);
        assert_true (s->contact.overlap_max > 0 && s->contact.overlap_max < 0.05 * unit);
        clear (&r);
    }
}

/* A round impactor with a mass of its own: momentum of both stays, and energy. */
static void impactors_share_momentum (void **state)
{
    (void) state;
    run r = block (1, 1, "kind: central, end: 6", 0,
                   "shape: cylinder, point: [26.5, 4], radius: 6, mass: 60, velocity: [-2, 0.5], friction: "
                   "0.4",
                   "");
    to_the_end (&r);
    size_t n;
    double size, p = momentum (&r, 0, &size), q = momentum (&r, 1, &size);
    const pg_platen_values *platen = pg_solver_platens (r.solver, &n);
    const pg_statistics *s = pg_solver_report (r.solver, r.state);
    print_message ("impactor: body %.4f %.4f, energy %.2e, friction %.3g of %.3g J, moved %.3f %.3f\n", p, q,
                   s->energy.dissipated / s->energy.external, s->energy.friction, s->energy.external,
                   platen->motion[0], platen->motion[1]);
    check_below (fabs (s->energy.dissipated), 1e-3 * s->energy.external);
    assert_true (p < -60 && s->energy.friction > 0);
    clear (&r);
}

/* The same by the library itself: impulses on the body and on the platen are equal and opposite. */
static void impulses_are_equal_and_opposite (void **state)
{
    (void) state;
    for (int dim = 2; dim <= 3; dim++) {
        run r = scene_of (1,
                          "dimension: %d\n%sbody: [{add: {box: {low: [0, 0%s], high: [8, 8%s]}}}]\nspacing: "
                          "1\n"
                          "lattice: cells\nperturb: {amount: 0.1}\nmaterials: {m: {youngs_modulus: 1000, "
                          "poissons_ratio: 0.25, density: 1}}\nmethod: {force: bond, accept_inexact: yes}\n"
                          "platens: [{name: ball, shape: %s, point: [13, 4.5%s], radius: 4, mass: 20, "
                          "velocity: "
                          "[-3, 0.7%s], friction: 0.3}]\nsolver: {kind: verlet, end: 1}\n",
                          dim, dim == 2 ? "plane: strain\n" : "", dim == 3 ? ", 0" : "", dim == 3 ? ", "
                              "8" : "",
                          dim == 3 ? "sphere" : "cylinder", dim == 3 ? ", 3.5" : "", dim == 3 ? ", 0.2" : "");
        size_t d = (size_t) dim, n = r.problem->cloud.n;
        double *v = pg_calloc (n * d, sizeof *v), *f = pg_calloc (n * d, sizeof *f), start[3], sum[3] = { 0 },
               dt = 0.005, touched = 0, size = 0;
        pg_moving_platens *w;
        check_ok (pg_moving_platens_create (&w, r.problem, &r.options.contact, d));
        memcpy (start, r.problem->boundary.platen->velocity, sizeof start);
        for (int step = 0; step <= 120; step++) {
            memset (f, 0, n * d * sizeof *f);
            check_ok (pg_moving_platens_add (w, r.state->d, v, step * dt, step ? dt : 0, dt,
                                             dt * largest_of (v, n * d) * sqrt (dim), f));
            for (size_t i = 0; i < n * d; i++) {
                double change = (step ? dt : 0.5 * dt) * f[i] / r.problem->cloud.volume[i / d];
                v[i] += change, r.state->d[i] += dt * v[i];
                sum[i % d] += change * r.problem->cloud.volume[i / d], size = fmax (size, fabs (sum[i % d]));
            }
            const pg_moving_report *now = pg_moving_platens_now (w);
            touched += (double) now->touching;
            for (size_t k = 0; k < d; k++)
                check_scaled (20 * (now->platen->velocity[k] - start[k]), -sum[k], 1e-12, size);
        }
        assert_true (touched > 10 && size > 1 && fabs (sum[1]) > 1e-3);
        assert_in_range (pg_moving_platens_now (w)->looks, 2, 40);
        pg_moving_platens_free (&w);
        pg_free (v), pg_free (f);
        clear (&r);
    }
}

/* A platen that is moved does work: it pushes a free block away; what it does is strain and motion. */
static void prescribed_motion_does_work (void **state)
{
    (void) state;
    run r = block (1, 1, "kind: verlet, end: 6", 0,
                   "point: [-0.25, 0], normal: [1, 0], displacement: {x: \"0.3 m/s * t\"}, ramp: constant",
                       "");
    double impulse = 0, time = 0, size;
    while (!pg_solver_done (r.solver, r.state)) {
        size_t n;
        advance (&r);
        impulse += (r.step.time - time) * pg_solver_platens (r.solver, &n)->force[0], time = r.step.time;
        check_relative (pg_solver_platens (r.solver, &n)->motion[0], 0.3 * time, 1e-12);
    }
    const pg_statistics *s = pg_solver_report (r.solver, r.state);
    double p = momentum (&r, 0, &size);
    print_message ("pushed: mean velocity %.4f of twice the platen's, work %.4f J, energy %.1e, impulse "
        "%.3f\n",
                   p / 240 / 0.6, s->energy.external, s->energy.dissipated / s->energy.external, impulse / p);
    check_relative (p / 240, 0.6, 0.05);               /* e = 1 */
    check_relative (s->energy.external, 0.3 * p, 1e-3);          /* force times velocity, over time */
    check_relative (impulse, p, 0.02);
    check_below (fabs (s->energy.dissipated), 1e-3 * s->energy.external);
    clear (&r);
}

/* A block slides on a plane that it is pressed on: tangential impulse = coefficient times normal impulse. */
static void friction_is_coulombs (void **state)
{
    (void) state;
    double mu = 0.3, g = 2, T = 8, size;
    char more[200];
    snprintf (more, sizeof more, "boundary: [{name: weight, set: all, body_force: {y: %g}, ramp: "
        "constant}]\n", -g);
    run r = block (1, 1, "kind: verlet, end: 8", 6, "point: [0, 0], normal: [0, 1], friction: 0.3", more);
    to_the_end (&r);
    double lost = 240 * 6 - momentum (&r, 0, &size), normal = momentum (&r, 1, &size) + 240 * g * T;
    const pg_statistics *s = pg_solver_report (r.solver, r.state);
    print_message ("friction: %.5f of mu N, speed left %.4f (%.4f), friction work %.4g of %.4g J, energy "
        "%.1e\n",
                   lost / (mu * normal), momentum (&r, 0, &size) / 240, 6 - mu * g * T, s->energy.friction,
                   0.5 * 240 * (36 - pow (6 - mu * g * T, 2)), s->energy.dissipated / s->energy.external);
    check_relative (lost, mu * normal, 0.01);
    check_relative (momentum (&r, 0, &size) / 240, 6 - mu * g * T, 0.05);
    check_below (fabs (s->energy.dissipated), 1e-3 * s->energy.external);
    clear (&r);
}

static void threads_shortcuts_and_stops_change_nothing (void **state)
{
    (void) state;
    static const char ball[] = "shape: cylinder, point: [26.5, 4], radius: 6, mass: 60, velocity: [-2, 0.5], "
                               "friction: 0.4";
    run one = block (1, 1, "kind: verlet, end: 4", 0, ball, ""),
        four = block (1, 4, "kind: verlet, end: 4", 0, ball, ""),
        plain = block (1, 1, "kind: verlet, end: 4, plain: yes", 0, ball, ""),
        back = block (1, 1, "kind: verlet, end: 4", 0, ball, "");
    tape t = { 0 };
    int row = 0;
    size_t n;
    while (!pg_solver_done (one.solver, one.state)) {
        advance_alike (&one, &four);
        advance (&plain);
        assert_memory_equal (one.state->d, plain.state->d, one.state->ndof * sizeof *one.state->d);
        if (++row == 60) {
            assert_true (pg_solver_report (one.solver, one.state)->contact.touching > 0);
            keep (&one, &t, 0), keep (&back, &t, 1);
            /* a step that is refused is as if it had not been */
            double v = back.state->v[0];
            back.state->v[0] = INFINITY;
            check_fails (pg_solver_step (back.solver, back.state, &back.step), PG_E_EQUILIBRIUM);
            back.state->v[0] = v;
        } else if (row > 60) {
            advance (&back);
            assert_memory_equal (one.state->d, back.state->d, one.state->ndof * sizeof *one.state->d);
            assert_true (one.step.dissipated == back.step.dissipated);
            assert_memory_equal (pg_solver_platens (one.solver, &n), pg_solver_platens (back.solver, &n),
                                 sizeof (pg_platen_values));
        }
    }
    const pg_statistics *a = pg_solver_report (one.solver, one.state),
                        *b = pg_solver_report (back.solver, back.state);
    assert_true (a->energy.friction == b->energy.friction && a->energy.friction > 0
                 && a->energy.external == b->energy.external
                 && a->contact.overlap_max == b->contact.overlap_max);
    pg_free (t.byte);
    clear (&one), clear (&four), clear (&plain), clear (&back);
}

static void must_refuse (const char *text, const char *part)
{
    char all[2048];
    snprintf (all, sizeof all,
              "dimension: 2\nplane: stress\nbody: [{add: {box: {low: [0, 0], high: [9, 9]}}}]\nspacing: 1\n"
              "lattice: cells\nmaterials: {m: {youngs_modulus: 1, poissons_ratio: 0.3, density: 1}}\n%s",
                  text);
    check_refused (all, part);
}

#define BOND "method: {force: bond, accept_inexact: yes}\nsolver: {kind: verlet, end: 1}\n"
static void what_it_cannot_do_is_refused (void **state)
{
    (void) state;
    must_refuse (BOND "platens: [{name: a, point: [0, 3], normal: [0, 1]}]\n",
                 "m inside it: put it outside the body");
    must_refuse (BOND "platens: [{name: a, point: [0, -3], normal: [0, 1], tilt: free}]\n", "do not turn");
    must_refuse (BOND "platens: [{name: a, point: [0, -3], normal: [0, 1], force: {y: 1}}]\n",
                 "platens[0].mass: a platen that a force moves needs it");
    must_refuse (BOND "platens: [{name: a, point: [0, -3], normal: [0, 1], velocity: [0, 1]}]\n",
                 "is that of a platen with a mass");
    must_refuse ("solver: {kind: verlet, end: 1}\nmethod: {force: galerkin, approximation: rkpm}\n"
                 "platens: [{name: a, point: [0, -3], normal: [0, 1]}]\n", "in explicit steps they press "
                 "points");
    must_refuse ("solver: {kind: static}\nplatens: [{name: a, point: [0, -3], normal: [0, 1], mass: 2}]\n",
                 "has a meaning in explicit steps alone");
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (walls_throw_back),
        cmocka_unit_test (impactors_share_momentum),
        cmocka_unit_test (impulses_are_equal_and_opposite),
        cmocka_unit_test (prescribed_motion_does_work),
        cmocka_unit_test (friction_is_coulombs),
        cmocka_unit_test (threads_shortcuts_and_stops_change_nothing),
        cmocka_unit_test (what_it_cannot_do_is_refused),
    };
    return cmocka_run_group_tests_name ("contact/moving_platens", tests, NULL, NULL);
}
