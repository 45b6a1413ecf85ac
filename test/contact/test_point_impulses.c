/* SPDX-License-Identifier: GPL-3.0-or-later
 * Contact by search, points held apart by impulses: the law in single steps; bodies that collide keep
 * momentum, moment of momentum and energy, and do not overlap; friction; supports; bodies that touch at the
 * start; threads, checkpoints, refused steps; units and directions; what is refused. */
#include "collisions.h"
#include "refused.h"
#include "solve/tape.h"

#define HOW ", enforcement: impulses"

/* ---- the law ------------------------------------------------------------------------------------------- */
static double noise (unsigned long long *seed)         /* in [-1, 1) */
{
    *seed = *seed * 6364136223846793005ull + 1442695040888963407ull;
    return (double) (*seed >> 11) * 0x1p-52 - 1;
}

/* Two boxes of moved points, a spacing apart at most, of two materials. */
static run boxes (int dim, double friction, int threads)
{
    char contact[120];
    snprintf (contact, sizeof contact, friction > 0 ? "friction, coefficient: %g" : "normal", friction);
    return scene_of (threads,
                     "%sspacing: 1\nlattice: cells\nperturb: {amount: 0.2}\nmaterials:\n  a: "
                     "{youngs_modulus: "
                     "100, poissons_ratio: 0.25, density: 1}\n  b: {youngs_modulus: 300, poissons_ratio: "
                     "0.25, "
                     "density: 2}\nblocks: [{where: \"x >= 6\", material: b}, {where: \"x < 6\", material: "
                     "a}]\n"
                     "method: {force: bond, horizon: 2.5 spacing, accept_inexact: yes}\n"
                     "contact: {kind: %s, search: short_range" HOW "}\nsolver: {kind: verlet, end: 1}\n",
                     dim == 2 ? "dimension: 2\nplane: stress\nbody: [{add: {box: {low: [0, 0], high: [6, "
                                "9]}}}, "
                                "{add: {box: {low: [6, 0], high: [12, 9]}}}]\n"
                                "cracks: [{from: [6, -1], to: [6, 10]}]\n"
                              : "dimension: 3\nbody: [{add: {box: {low: [0, 0, 0], high: [12, 4, 4]}}}]\n"
                                "cracks: [{disc: {center: [6, 2, 2], radius: 9, normal: [1, 0, 0]}}]\n",
                     contact);
}

/* What a step makes of the pairs at hand: no pair ends it too near, the forces of all points are in balance,
 * and without friction do no work. */
typedef struct { long held; double worst, momentum, work; } law;
static void check_law (const run *r, pg_short_range *c, const pg_point_ways *w, double friction, law *out)
{
    size_t n = r->problem->cloud.n, dim = (size_t) r->problem->dim;
    const double *F = pg_short_range_forces (c), *x = r->problem->cloud.x, *d = r->state->d;
    double sum[3] = { 0 }, size = 0, taken = 0;
    for (size_t i = 0; i < n; i++)
        for (size_t k = 0; k < dim; k++) {
            sum[k] += F[i * dim + k], size += fabs (F[i * dim + k]);
            taken += 0.5 * F[i * dim + k]
                     * (w->back[i * dim + k] + w->ahead[i * dim + k]
                        + w->gain * w->inverse[i * dim + k] * F[i * dim + k]);
        }
    for (size_t k = 0; k < dim; k++)
        out->momentum = fmax (out->momentum, fabs (sum[k]) / fmax (size, 1e-300));
    /* all that forces take is what friction takes */
    double most = 0;
    for (size_t i = 0; i < n * dim; i++) most += fabs (F[i] * w->back[i]);
    if (!(most > 0)) return;
    if (!(friction > 0)) out->work = fmax (out->work, fabs (taken) / most);
    for (size_t i = 0; i < n; i++)
        for (size_t j = i + 1; j < n; j++) {
            double now = 0, end = 0, before = 0, start = 0;
            for (size_t k = 0; k < dim; k++) {
                double X = x[j * dim + k] - x[i * dim + k], y = X + d[j * dim + k] - d[i * dim + k],
                       back = w->back[j * dim + k] - w->back[i * dim + k],
                       ahead = w->ahead[j * dim + k] + w->gain * w->inverse[j * dim + k] * F[j * dim + k]
                               - w->ahead[i * dim + k] - w->gain * w->inverse[i * dim + k] * F[i * dim + k];
                start += X * X, now += y * y, end += (y + ahead) * (y + ahead),
                    before += (y - back) * (y - back);
            }
            int joined = 0;
            const pg_family *f = &r->problem->bonds.rows[PG_NODES].family;
            for (size_t e = f->start[i]; e < f->start[i + 1]; e++)
                joined |= (size_t) f->node[e] == j && r->state->alive[r->problem->bonds.first[PG_NODES] + e];
            double reach = fmin (1, sqrt (start));
            if (joined || now < reach * reach) continue;
            out->worst = fmax (out->worst, reach - sqrt (end));
            out->held += sqrt (end) < reach + 5e-3;
        }
}

static void no_pair_ends_a_step_too_near (void **state)
{
    (void) state;
    for (int k = 0; k < 4; k++) {
        int dim = 2 + k / 2;
        double friction = k % 2 ? 0.4 : 0, dt = 0.01;
        run r = boxes (dim, friction, 1 + k % 2);
        size_t nd = r.problem->cloud.n * (size_t) dim;
        double *back = pg_calloc (nd, sizeof *back), *ahead = pg_calloc (nd, sizeof *ahead),
               *inverse = pg_calloc (nd, sizeof *inverse), *f = pg_calloc (nd, sizeof *f);
        pg_short_range *c;
        unsigned long long seed = 11;
        law seen = { 0 };
        check_ok (pg_short_range_create (&c, r.problem, &r.options.contact, (size_t) dim));
        for (size_t i = 0; i < nd; i++)
            inverse[i] = 1 / pg_problem_law (r.problem, PG_NODES, i / (size_t) dim)->density;
        for (int step = 0; step < 40; step++) {
            /* bodies press on each other, points swing */
            pg_point_ways ways = { back, ahead, inverse, dt * dt, 0 };
            for (size_t i = 0; i < nd; i++) {
                double x = r.problem->cloud.x[i / (size_t) dim * (size_t) dim];
                double press = i % (size_t) dim ? 0 : x < 6 ? 3e-3 : -3e-3;
                ahead[i] = 0.7 * back[i] + 2e-3 * noise (&seed) + press;
                f[i] = 0;
            }
            check_ok (pg_short_range_hold (c, r.state, NULL, 1, &ways, INFINITY, f));
            for (size_t i = 0; i < nd; i++) assert_true (f[i] == pg_short_range_forces (c)[i]);
            check_law (&r, c, &ways, friction, &seen);
            for (size_t i = 0; i < nd; i++) {
                back[i] = ahead[i] + ways.gain * inverse[i] * f[i];
                r.state->d[i] += back[i];
            }
        }
        const pg_short_range_report *now = pg_short_range_now (c);
        print_message ("%d dimensions, friction %g: %ld near, nearer by %.1e, momentum %.1e, work %.1e, %ld "
                       "sweeps, "
                       "%ld unsettled\n", dim, friction, seen.held, seen.worst, seen.momentum, seen.work,
                           now->sweeps,
                       now->unsettled);
        assert_true (seen.held > 100 && now->sweeps > 40 && now->unsettled == 0);
        /* points that pass each other along an arc come nearer by half the square of what they slip in a
         * step */
        check_below (seen.worst, 1e-4);
        check_below (seen.momentum, 1e-14);
        check_below (seen.work, 1e-3);
        if (friction > 0) assert_true (now->friction > 0);
        else assert_true (now->friction == 0);
        pg_short_range_free (&c);
        pg_free (back), pg_free (ahead), pg_free (inverse), pg_free (f);
        clear (&r);
    }
}

/* ---- bodies that collide ------------------------------------------------------------------------------- */
/* Bars of 200 points exchange their velocities within 2 L / c; short ones keep the energy as well, in
 * whichever moment of a step they meet. */
static void bars_exchange_velocities (void **state)
{
    (void) state;
    const int points[2] = { 200, 20 };
    for (int k = 0; k < 2; k++)
        for (int phase = 0; phase < (k ? 10 : 2); phase++) {
            int n = points[k];
            run r = bars (n, phase % 2 ? "central" : "verlet", 1, HOW);
            double first = NAN, last = NAN, off = 0, mean[2] = { 0 }, p, turn, size, size_turn;
            for (int i = 0; i < n; i++) r.state->d[i] = 0.0007 * phase;
            while (!pg_solver_done (r.solver, r.state)) {
                advance (&r);
                const pg_statistics *s = pg_solver_report (r.solver, r.state);
                if (s->contact.touching > 0 && isnan (first)) first = r.step.time;
                if (s->contact.touching > 0) last = r.step.time;
                off = fmax (off, fabs (s->energy.dissipated / s->energy.external));
            }
            momentum_of (&r, &p, &turn, &size, &size_turn);
            for (size_t i = 0; i < r.problem->cloud.n; i++)
                mean[r.problem->cloud.x[i] > n] += r.state->v[i] / n;
            const pg_statistics *s = pg_solver_report (r.solver, r.state);
            print_message ("%d points: contact %.4f of 2 L / c, velocities %.4f %.4f, energy %.1e, overlap "
                           "%.1e\n", n,
                           (last - first) / (2 * n / 10.0), mean[0] / 0.01, mean[1] / 0.01, off,
                               s->contact.overlap_max);
            check_relative (p, 0.01 * 2 * n, 1e-12);
            check_below (off, 1e-8);
            check_below (s->contact.overlap_max, 1e-6);
            if (n == 200) check_relative (last - first, 2 * n / 10.0, 0.03);
            check_absolute (mean[1] / 0.01, 1, n == 200 ? 0.02 : 0.1);
            clear (&r);
        }
}

static void disks_keep_momentum_and_energy (void **state)
{
    (void) state;
    for (int k = 0; k < 5; k++) {
        const char *const force[5] = { "bond, stretch: finite", "bond", "lps", "fcbm",
                                       "bond, stretch: finite" };
        disks l = { .unit = k == 4 ? 1e-3 : 1, .friction = k == 1 || k == 4 ? 0.5 : 0, .threads = 1,
                    .force = force[k], .how = HOW };
        run r = disks_run (&l);
        double p[2], p0[2], turn, turn0, size, size_turn, off = 0;
        momentum_of (&r, p0, &turn0, &size, &size_turn);
        while (!pg_solver_done (r.solver, r.state)) {
            advance (&r);
            const pg_statistics *s = pg_solver_report (r.solver, r.state);
            off = fmax (off, fabs (s->energy.dissipated / s->energy.external));
        }
        momentum_of (&r, p, &turn, &size, &size_turn);
        const pg_statistics *s = pg_solver_report (r.solver, r.state);
        print_message ("%s, friction %g: energy %.2e, friction %.3g of the energy, overlap %.1e spacings\n",
                       force[k], l.friction, off, s->energy.friction / s->energy.external,
                       s->contact.overlap_max / l.unit);
        for (int a = 0; a < 2; a++) check_scaled (p[a], p0[a], 1e-12, size);
        if (k == 0) check_scaled (turn, turn0, 1e-11, size_turn);
        /* where bonds turn their force is no linear one, and leapfrog itself keeps less */
        check_below (off, strstr (force[k], "finite") ? 2e-3 : 1e-8);
        check_below (s->contact.overlap_max / l.unit, 1e-5);
        if (l.friction > 0) assert_true (s->energy.friction > 1e-3 * s->energy.external);
        else assert_true (s->energy.friction == 0);
        clear (&r);
    }
}

/* Bodies that touch at the start and fly at each other collide at once: nothing overlaps, nothing is lost. */
static void bodies_may_touch_at_the_start (void **state)
{
    (void) state;
    run r = scene_of (1, "dimension: 2\nplane: stress\nbody: [{add: {box: {low: [0, 0], high: [20, "
                         "4]}}}]\nspacing: 1\n"
                      "lattice: cells\ncracks: [{from: [10, -1], to: [10, 5]}]\nmaterials: {m: "
                      "{youngs_modulus: 1000, "
                      "poissons_ratio: 0.333333333333333, density: 1}}\nmethod: {force: bond, "
                      "accept_inexact: yes}\n"
                      "sets: {one: {where: \"x < 10\"}}\ninitial: {sets: [{set: one, velocity: {x: 0.1}}]}\n"
                      "contact: {kind: normal, search: short_range" HOW "}\nsolver: {kind: verlet, end: 2}\n"
                      "output: {at: {levels: 1, rows: 50}}\n");
    double p[2], turn, size, size_turn, off = 0, right = 0;
    while (!pg_solver_done (r.solver, r.state)) {
        advance (&r);
        const pg_statistics *s = pg_solver_report (r.solver, r.state);
        off = fmax (off, fabs (s->energy.dissipated / (0.5 * 40 * 0.01)));
    }
    momentum_of (&r, p, &turn, &size, &size_turn);
    for (size_t i = 0; i < r.problem->cloud.n; i++)
        right += r.problem->cloud.x[2 * i] > 10 ? r.state->v[2 * i] / 40 : 0;
    print_message ("touching bars: energy %.1e, second bar at %.4f of the velocity, overlap %.1e\n", off,
                   right / 0.1,
                   pg_solver_report (r.solver, r.state)->contact.overlap_max);
    check_relative (p[0], 0.1 * 40, 1e-12);
    check_below (off, 1e-8);
    check_below (pg_solver_report (r.solver, r.state)->contact.overlap_max, 1e-6);
    check_absolute (right / 0.1, 1, 0.1);
    clear (&r);
}

/* A block thrown on one that is held slides over it: friction gives and takes momentum along, as the
 * coefficient says, and what it takes of the energy is what is missing. */
static void blocks_slide_with_friction (void **state)
{
    (void) state;
    run r = scene_of (1, "dimension: 2\nplane: stress\nbody: [{add: {box: {low: [0, 0], high: [40, 4]}}}, "
                      "{add: {box: {low: [10, 4], high: [18, 10]}}}]\nspacing: 1\nlattice: cells\n"
                      "cracks: [{from: [9, 4], to: [19, 4]}]\nmaterials: {m: {youngs_modulus: 1000, "
                      "poissons_ratio: 0.333333333333333, density: 1}}\nmethod: {force: bond, "
                      "accept_inexact: yes}\n"
                      "sets: {one: {where: \"y > 4\"}}\n"
                      "initial: {sets: [{set: one, velocity: {x: 0.01, y: -0.01}}]}\n"
                      "boundary: [{name: foot, set: bottom, displacement: {x: 0, y: 0}}]\n"
                      "contact: {kind: friction, coefficient: 0.2, search: short_range" HOW "}\n"
                      "solver: {kind: verlet, end: 4}\noutput: {at: {levels: 1, rows: 50}}\n");
    double p[2] = { 0 }, m = 48, off = 0;
    while (!pg_solver_done (r.solver, r.state)) {
        advance (&r);
        const pg_statistics *s = pg_solver_report (r.solver, r.state);
        off = fmax (off, fabs (s->energy.dissipated / (0.5 * m * 2e-4)));
    }
    for (size_t i = 0; i < r.problem->cloud.n; i++)
        for (size_t k = 0; k < 2; k++)
            p[k] += r.problem->cloud.x[2 * i + 1] > 4 ? r.state->v[2 * i + k] : 0;
    double press = p[1] + 0.01 * m, shear = 0.01 * m - p[0];
    const pg_statistics *s = pg_solver_report (r.solver, r.state);
    print_message ("impulses along over across %.5f of the coefficient; energy %.1e, friction %.3f of it, "
                   "overlap %.1e\n",
                   shear / press / 0.2, off, s->energy.friction / (0.5 * m * 2e-4), s->contact.overlap_max);
    assert_true (press > 0.01 * m && s->energy.friction > 0);
    check_relative (shear / press, 0.2, 0.02);
    check_below (off, 1e-3);
    check_below (s->contact.overlap_max, 1e-4);
    clear (&r);
}

/* ---- the same result ----------------------------------------------------------------------------------- */
static void threads_shortcuts_and_stops_change_nothing (void **state)
{
    (void) state;
    static const char breaks[] = "failure: {criterion: stretch, critical_stretch: 4e-3}\n";
    disks l = { .unit = 1, .friction = 0.5, .threads = 1, .more = breaks, .how = HOW }, many = l, plain = l;
    many.threads = 4, plain.plain = 1;
    run one = disks_run (&l), four = disks_run (&many), simple = disks_run (&plain), back = disks_run (&l);
    tape t = { 0 };
    int row = 0;
    while (!pg_solver_done (one.solver, one.state)) {
        advance_alike (&one, &four);
        advance (&simple);
        assert_memory_equal (one.state->d, simple.state->d, one.state->ndof * sizeof *one.state->d);
        if (++row == 120) {
            const pg_statistics *s = pg_solver_report (one.solver, one.state);
            assert_true (s->energy.friction > 0 && one.state->broken > 0);
            keep (&one, &t, 0), keep (&back, &t, 1);
        } else if (row > 120) {
            advance (&back);
            assert_memory_equal (one.state->d, back.state->d, one.state->ndof * sizeof *one.state->d);
            assert_true (one.step.dissipated == back.step.dissipated);
        }
    }
    const pg_statistics *a = pg_solver_report (one.solver, one.state),
                        *b = pg_solver_report (back.solver, back.state);
    assert_true (row > 150 && a->energy.friction == b->energy.friction
                 && a->energy.contact == b->energy.contact
                 && a->contact.overlap_max == b->contact.overlap_max);
    print_message ("with %ld broken bonds: overlap %.1e spacings\n", one.state->broken,
                   a->contact.overlap_max);
    check_below (a->contact.overlap_max, 1e-4);
    pg_free (t.byte);
    clear (&one), clear (&four), clear (&simple), clear (&back);
}

static void refused_steps_leave_no_trace (void **state)
{
    (void) state;
    disks l = { .unit = 1, .friction = 0.5, .threads = 1, .how = HOW };
    run a = disks_run (&l), b = disks_run (&l);
    for (int row = 0; row < 110; row++) advance (&a), advance (&b);
    double friction = pg_solver_report (b.solver, b.state)->energy.friction, v = b.state->v[0];
    assert_true (friction > 0);
    b.state->v[0] = INFINITY;
    check_fails (pg_solver_step (b.solver, b.state, &b.step), PG_E_EQUILIBRIUM);
    b.state->v[0] = v;
    assert_true (pg_solver_report (b.solver, b.state)->energy.friction == friction);
    for (int row = 0; row < 20; row++) advance_alike (&a, &b);
    assert_true (pg_solver_report (a.solver, a.state)->energy.friction
                 == pg_solver_report (b.solver, b.state)->energy.friction);
    clear (&a), clear (&b);
}

/* A quarter turn and another unit of length. */
static void units_and_directions_do_not_matter (void **state)
{
    (void) state;
    disks l = { .unit = 1, .friction = 0.3, .threads = 1, .how = HOW }, turned = l, small = l;
    turned.turn = 1.5707963267948966, small.unit = 1e-3;
    run a = disks_run (&l), b = disks_run (&turned), c = disks_run (&small);
    to_the_end (&a), to_the_end (&b), to_the_end (&c);
    const pg_statistics *s = pg_solver_report (a.solver, a.state), *t = pg_solver_report (b.solver, b.state),
                        *u = pg_solver_report (c.solver, c.state);
    check_relative (t->energy.friction, s->energy.friction, 1e-5);
    check_relative (u->energy.friction, s->energy.friction * 1e-9, 1e-5);
    clear (&a), clear (&b), clear (&c);
}

/* Impulses do not ask for smaller time steps. */
static void the_time_step_is_that_of_the_body (void **state)
{
    (void) state;
    run r = bars (20, "verlet", 1, HOW);
    pg_solver_options o = r.options;
    pg_solver *without;
    o.contact.kind = PG_CONTACT_NONE;
    check_ok (pg_solver_create (&without, r.problem, &o));
    assert_true (pg_solver_settled (r.solver)->dt == pg_solver_settled (without)->dt);
    pg_solver_free (&without);
    clear (&r);
}

static void must_refuse (const char *text, const char *part)
{
    char all[2048];
    snprintf (all, sizeof all,
              "dimension: 2\nplane: stress\nbody: [{add: {box: {low: [0, 0], high: [9, 9]}}}]\nspacing: 1\n"
              "materials: {m: {youngs_modulus: 1, poissons_ratio: 0.3, density: 1}}\n%s", text);
    check_refused (all, part);
}

static void what_it_cannot_do_is_refused (void **state)
{
    (void) state;
    must_refuse ("contact: {kind: normal, search: short_range, stiffness: 2" HOW "}\nmethod: {force: bond, "
                 "accept_inexact: yes}\nsolver: {kind: verlet, end: 1}\n", "is that of springs");
    must_refuse ("contact: {kind: normal" HOW "}\nsolver: {kind: static}\n",
                 "has a meaning with contact.search: short_range alone");
    must_refuse ("contact: {kind: normal, search: short_range" HOW "}\nmethod: {force: galerkin}\nsolver: "
                                                                   "{kind: "
                 "verlet, end: 1}\n", "impulses act on points with a mass of their own");
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (no_pair_ends_a_step_too_near),
        cmocka_unit_test (bars_exchange_velocities),
        cmocka_unit_test (disks_keep_momentum_and_energy),
        cmocka_unit_test (bodies_may_touch_at_the_start),
        cmocka_unit_test (blocks_slide_with_friction),
        cmocka_unit_test (threads_shortcuts_and_stops_change_nothing),
        cmocka_unit_test (refused_steps_leave_no_trace),
        cmocka_unit_test (units_and_directions_do_not_matter),
        cmocka_unit_test (the_time_step_is_that_of_the_body),
        cmocka_unit_test (what_it_cannot_do_is_refused),
    };
    return cmocka_run_group_tests_name ("contact/point_impulses", tests, NULL, NULL);
}
