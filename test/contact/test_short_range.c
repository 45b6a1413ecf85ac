/* SPDX-License-Identifier: GPL-3.0-or-later
 * Short-range contact in explicit steps: the search finds what looking at all pairs finds; forces, slips and
 * energies against sums written anew; bars that collide; momentum, energy; threads, checkpoints, refused
 * steps; units and directions; what is refused. */
#include "collisions.h"
#include "refused.h"
#include "scene_runs/run.h"
#include "solve/tape.h"

static double noise (unsigned long long *seed)         /* in [-1, 1) */
{
    *seed = *seed * 6364136223846793005ull + 1442695040888963407ull;
    return (double) (*seed >> 11) * 0x1p-52 - 1;
}

/* Two bodies of perturbed points with a crack in one of them, of two materials. */
static run cloud (int dim, const char *contact, int threads)
{
    const char *plane[2] = { "dimension: 2\nplane: stress\n", "dimension: 3\n" },
               *boxes[2] = { "[{add: {box: {low: [0, 0], high: [12, 9]}}}, {add: {box: {low: [15.2, 0], "
                             "high: [24, 9]}}}]\ncracks: [{from: [0, 4.4], to: [7, 4.4]}]\n",
                             "[{add: {box: {low: [0, 0, 0], high: [6, 6, 5]}}}, {add: {box: {low: [9.2, 0, "
                             "0], "
                             "high: [14, 6, 5]}}}]\n" };
    return scene_of (threads,
                     "%sbody: %sspacing: 1\nlattice: cells\nperturb: {amount: 0.2}\nmaterials:\n  a: "
                     "{youngs_modulus: 100, poissons_ratio: 0.25, density: 1}\n  b: {youngs_modulus: 300, "
                     "poissons_ratio: 0.25, density: 2}\nblocks: [{where: \"x >= 7.5\", material: b}, "
                     "{where: \"x < 7.5\", material: a}]\nmethod: {force: bond, horizon: 2.5 spacing, "
                     "accept_inexact: yes}\n"
                     "contact: %s\nsolver: {kind: verlet, end: 1}\n",
                     plane[dim - 2], boxes[dim - 2], contact);
}

/* ---- against all pairs --------------------------------------------------------------------------------- */
static int joined (const run *r, size_t i, size_t j)
{
    const pg_family *f = &r->problem->bonds.rows[PG_NODES].family;
    for (size_t e = f->start[i]; e < f->start[i + 1]; e++)
        if ((size_t) f->node[e] == j) return r->state->alive[r->problem->bonds.first[PG_NODES] + e];
    return 0;
}

static double apart (const run *r, size_t i, size_t j, const double *d, double *e)
{
    size_t dim = (size_t) r->problem->dim;
    double rr = 0;
    for (size_t k = 0; k < dim; k++) {
        e[k] = r->problem->cloud.x[j * dim + k] - r->problem->cloud.x[i * dim + k];
        if (d) e[k] += d[j * dim + k] - d[i * dim + k];
        rr += e[k] * e[k];
    }
    for (size_t k = 0; k < dim; k++) e[k] /= sqrt (rr);
    return sqrt (rr);
}

/* Forces of all pairs as the header says, slips (n x n x 3, of i < j) by the step dt v, distances of those
 * whose bond broke under pressure (n x n; 0: others); returns the pairs that touch. */
static size_t all_pairs (const run *r, const pg_contact_setting *c, const double *v, double dt, double *slip,
                         double *shorter, double *f, double *energy, double *friction)
{
    const pg_problem *p = r->problem;
    size_t n = p->cloud.n, dim = (size_t) p->dim, count = 0;
    memset (f, 0, n * dim * sizeof *f);
    *energy = 0;
    for (size_t i = 0; i < n; i++)
        for (size_t j = i + 1; j < n; j++) {
            const pg_material *a = &p->material[p->block[PG_NODES][i]],
                              *b = &p->material[p->block[PG_NODES][j]];
            double e[3], start[3], *q = slip + 3 * (i * n + j), s = p->cloud.h,
                   M = 2 * a->D[0] * b->D[0] / (a->D[0] + b->D[0]), G = 2 * a->mu * b->mu / (a->mu + b->mu),
                   area = fmin (p->cloud.volume[i], p->cloud.volume[j]) / (s * s), along = 0, size = 0,
                   full = fmin (c->distance * s, apart (r, i, j, NULL, start)),
                   rest = apart (r, i, j, r->state->d, e), *own = &shorter[i * n + j];
            if (rest >= full) *own = 0;
            double reach = *own > 0 ? *own : full, press = c->stiffness * M * area * (reach - rest),
                   across = c->stiffness * G * area, before = 0, work = 0;
            int touches = rest < reach && !joined (r, i, j);
            for (size_t k = 0; k < dim; k++) {
                double move = dt * (v[j * dim + k] - v[i * dim + k]);
                before += 0.5 * across * q[k] * q[k], work += 0.5 * across * q[k] * move;
                q[k] = touches ? q[k] + move : 0;
                along += q[k] * e[k];
            }
            for (size_t k = 0; k < dim; k++) q[k] = touches ? q[k] - along * e[k] : 0, size += q[k] * q[k];
            double limit = c->coefficient * press / across / fmax (sqrt (size), 1e-300), held = 0;
            if (c->kind != PG_CONTACT_FRICTION) limit = 0;
            for (size_t k = 0; k < dim; k++) {
                q[k] *= touches ? fmin (1, limit) : 0;
                held += 0.5 * across * q[k] * q[k];
                work += 0.5 * across * q[k] * dt * (v[j * dim + k] - v[i * dim + k]);
                double force = touches ? press * e[k] - across * q[k] : 0;
                f[j * dim + k] += force, f[i * dim + k] -= force;
            }
            *friction += work - (held - before);
            *energy += touches ? 0.5 * press * (reach - rest) + held : 0;
            count += (size_t) touches;
        }
    return count;
}

/* Bonds of a point that die now, in both directions, as a force tells them. */
static void kill_bonds (run *r, size_t i, pg_changes *out)
{
    const pg_family *f = &r->problem->bonds.rows[PG_NODES].family;
    out->n = 0;
    for (size_t a = 0; a < r->problem->cloud.n; a++)
        for (size_t e = f->start[a]; e < f->start[a + 1]; e++) {
            size_t bond = r->problem->bonds.first[PG_NODES] + e;
            if ((a != i && (size_t) f->node[e] != i) || !r->state->alive[bond]) continue;
            out->bond[out->n++] = bond, r->state->alive[bond] = 0;
        }
}

/* Of bonds that have just died, and whose ends nothing joins any more. */
static void note_distances (const run *r, const pg_changes *broken, double *shorter)
{
    const pg_family *f = &r->problem->bonds.rows[PG_NODES].family;
    size_t n = r->problem->cloud.n;
    for (size_t k = 0; k < broken->n; k++) {
        int set;
        size_t i, j;
        double e[3];
        pg_problem_locate (r->problem, broken->bond[k], &set, &i);
        j = (size_t) f->node[broken->bond[k] - r->problem->bonds.first[PG_NODES]];
        shorter[i < j ? i * n + j : j * n + i] = apart (r, i, j, r->state->d, e);
    }
}

/* Points wander, bodies come together and bonds break, told and untold. */
static void nothing_is_missed (void **state)
{
    (void) state;
    for (int dim = 2; dim <= 3; dim++)
        for (int friction = 0; friction < 2; friction++) {
            run r = cloud (dim, friction ? "{kind: friction, coefficient: 0.4, search: short_range}"
                                         : "{kind: normal, search: short_range, distance: 1.2, stiffness: "
                                             "0.7}",
                           friction + 1);
            size_t n = r.problem->cloud.n, nd = n * (size_t) dim, seen = 0;
            double *v = pg_calloc (nd, sizeof *v), *f = pg_calloc (nd, sizeof *f),
                   *g = pg_calloc (nd, sizeof *g),
                   *slip = pg_calloc (3 * n * n, sizeof *slip),
                   *shorter = pg_calloc (n * n, sizeof *shorter), energy, lost = 0, dt = 0.01;
            pg_short_range *c;
            pg_changes broken = { 0, 0, pg_calloc (r.state->nbond, sizeof *broken.bond) };
            unsigned long long seed = 7;
            check_ok (pg_short_range_create (&c, r.problem, &r.options.contact, (size_t) dim));
            for (int step = 0; step < 60; step++) {
                for (size_t i = 0; i < nd; i++)
                    v[i] = 3 * noise (&seed)
                           + (i % (size_t) dim == 0 && r.problem->cloud.x[i] > 7.5 ? -4.5 : 0),
                    r.state->d[i] += dt * v[i];
                broken.n = 0;
                if (step % 3 == 1) kill_bonds (&r, (size_t) (0.5 * (1 + noise (&seed)) * (double) n),
                                               &broken);
                memset (f, 0, nd * sizeof *f);
                /* how far they went: as it is, or not known */
                double way = step % 4 < 2 ? dt * largest_of (v, nd) * sqrt (dim) : INFINITY;
                check_ok (pg_short_range_add (c, r.state, step % 2 ? &broken : NULL, step % 2 == 0, v, dt,
                                              way,
                                              f));
                for (size_t i = 0; i < nd; i++) assert_true (pg_short_range_forces (c)[i] == f[i]);
                if (step % 2) note_distances (&r, &broken, shorter);
                size_t count = all_pairs (&r, &r.options.contact, v, dt, slip, shorter, g, &energy, &lost),
                       told;
                const pg_short_range_report *now = pg_short_range_now (c);
                pg_contact_pair *pair;
                check_ok (pg_short_range_pairs (c, r.state, &told, &pair));
                pg_free (pair);
                assert_int_equal (now->touching, count);
                assert_int_equal (told, count);
                for (size_t i = 0; i < nd; i++) check_scaled (f[i], g[i], 1e-12, largest_of (g, nd));
                check_scaled (now->energy, energy, 1e-12, energy);
                check_scaled (now->friction, lost, 1e-11, fmax (lost, energy));
                seen += count;
            }
            assert_true (seen > 1000);
            if (friction) assert_true (lost > 0.01 * energy);
            pg_short_range_free (&c);
            pg_free (v), pg_free (f), pg_free (g), pg_free (slip), pg_free (shorter);
            pg_free (broken.bond);
            clear (&r);
        }
}

/* While little moves there are few searches. */
static void the_skin_spares_searches (void **state)
{
    (void) state;
    run r = cloud (2, "{kind: normal, search: short_range}", 1);
    size_t n = r.problem->cloud.n;
    double *f = pg_calloc (2 * n, sizeof *f);
    pg_short_range *c;
    check_ok (pg_short_range_create (&c, r.problem, &r.options.contact, 2));
    for (int step = 0; step < 100; step++) {
        for (size_t i = 0; i < n; i++) r.state->d[2 * i] += 0.01;
        check_ok (pg_short_range_add (c, r.state, NULL, 0, f, 0, 0.01, f));
    }
    assert_in_range (pg_short_range_now (c)->searches, 4, 5);    /* a spacing, half a skin being a quarter */
    pg_short_range_free (&c);
    pg_free (f);
    clear (&r);
}

/* ---- bodies that collide ------------------------------------------------------------------------------- */
/* Equal bars exchange their velocities: contact lasts 2 L / c (d'Alembert), afterwards the first one
 * rests. */
static void bars_exchange_velocities (void **state)
{
    (void) state;
    for (int k = 0; k < 3; k++) {
        int n = 200;
        double unit = k == 2 ? 1e-3 : 1, c = 10, first = NAN, last = NAN, rest = 0, mean[2] = { 0 }, p, turn,
               size, size_turn;
        run r = bars (n, k == 1 ? "central" : "verlet", unit, "");
        double impulse = 0.01 * 2 * n * unit;          /* density times length times velocity */
        while (!pg_solver_done (r.solver, r.state)) {
            advance (&r);
            if (r.step.nbroken) fail ();
            const pg_statistics *s = pg_solver_report (r.solver, r.state);
            int touches = s->contact.touching > 0;
            if (touches && isnan (first)) first = r.step.time;
            if (touches) last = r.step.time;
            rest = s->energy.dissipated / s->energy.external;
            if (s->energy.external > 0) check_below (fabs (rest), 1e-3);
        }
        momentum_of (&r, &p, &turn, &size, &size_turn);
        check_relative (p, impulse, 1e-12);
        for (size_t i = 0; i < r.problem->cloud.n; i++)
            mean[r.problem->cloud.x[i] > n * unit] += r.state->v[i] / n;
        /* the way between the points, less a spacing, at the first velocity */
        check_relative (first, 3 * unit / 0.01, 1e-3);
        print_message ("contact %.4f of 2 L / c, velocities %.4f %.4f, energy %.1e, overlap %.3g spacings\n",
                       (last - first) / (2 * n * unit / c), mean[0] / 0.01, mean[1] / 0.01, rest,
                       pg_solver_report (r.solver, r.state)->contact.overlap_max / unit);
        check_relative (last - first, 2 * n * unit / c, 0.03);
        check_absolute (mean[0] / 0.01, 0, 0.01);
        check_absolute (mean[1] / 0.01, 1, 0.01);
        clear (&r);
    }
}

static void disks_keep_momentum_and_energy (void **state)
{
    (void) state;
    for (int k = 0; k < 4; k++) {
        /* forces along bonds as they turn keep the moment of momentum as well */
        const char *const force[4] = { "bond, stretch: finite", "bond", "lps", "fcbm" };
        disks l = { .unit = 1, .friction = k == 1 ? 0.5 : 0, .threads = 1, .force = force[k] };
        run r = disks_run (&l);
        double p[2], p0[2], turn, turn0, size, size_turn, lost = 0;
        momentum_of (&r, p0, &turn0, &size, &size_turn);
        while (!pg_solver_done (r.solver, r.state)) advance (&r), lost += r.step.dissipated;
        momentum_of (&r, p, &turn, &size, &size_turn);
        const pg_statistics *s = pg_solver_report (r.solver, r.state);
        print_message ("%s, friction %g: energy %.2e, friction work %.3g of %.3g J, overlap %.3g, pairs "
            "%ld\n",
                       force[k], l.friction, s->energy.dissipated / s->energy.external, s->energy.friction,
                       s->energy.external, s->contact.overlap_max, s->contact.pairs);
        for (int a = 0; a < 2; a++) check_scaled (p[a], p0[a], 1e-12, size);
        if (k == 0) check_scaled (turn, turn0, 1e-11, size_turn);
        check_below (fabs (s->energy.dissipated), 1e-3 * s->energy.external);
        check_scaled (lost, s->energy.dissipated, 1e-10, s->energy.external);
        assert_true (s->contact.overlap_max > 0);
        if (l.friction > 0) assert_true (s->energy.friction > 1e-3 * s->energy.external);
        else assert_true (s->energy.friction == 0);
        clear (&r);
    }
}

/* ---- the same result ----------------------------------------------------------------------------------- */
/* Unknowns that are no displacements: forces of contact do their work on the points. Two bars of Galerkin
 * forces collide, are stopped on the way, and one goes on. */
static run galerkin_bars (const char *approximation, const char *contact)
{
    return scene_of (1, "dimension: 2\nplane: stress\nbody: [{add: {box: {low: [0, 0], high: [12, 4]}}}, "
                     "{add: {box: {low: [14, 0], high: [26, 4]}}}]\nspacing: 1\nlattice: cells\n"
                     "materials: {m: {youngs_modulus: 100, poissons_ratio: 0.2, density: 1}}\n"
                     "method: {force: galerkin, approximation: %s}\ncontact: %s\n"
                     "solver: {kind: central, end: 12}\n"
                     "output: {at: {levels: 1, rows: 100}}\n", approximation, contact);
}

static void unknowns_of_shape_functions_collide (void **state)
{
    (void) state;
    const char *approximations[2] = { "rkpm", "pddo" },
               *contacts[2] = { "{kind: normal, search: short_range, stiffness: 4}",
                                "{kind: friction, coefficient: 0.3, search: short_range, stiffness: 4}" };
    for (int k = 0; k < 2; k++) {
        run r = galerkin_bars (approximations[k], contacts[k]),
            b = galerkin_bars (approximations[k], contacts[k]);
        tape t = { 0 };
        void *self;
        const pg_force_type *f = pg_solver_force (r.solver, &self);
        double *mass = pg_calloc (r.state->ndof, sizeof *mass), start = 0, half = 0, right = 0, off = 0,
               work = 0;
        int kept = 0;
        check_ok (f->mass (self, mass, NULL));
        for (size_t i = 0; i < r.state->ndof; i += 2)
            if (r.problem->cloud.x[i] < 13) r.state->v[i] = 0.5, start += 0.5 * mass[i], half += mass[i];
        while (!pg_solver_done (r.solver, r.state)) {
            double sum[2] = { 0 };
            if (kept) advance_alike (&r, &b);
            else advance (&r);
            for (size_t i = 0; i < r.state->ndof; i++) sum[i % 2] += mass[i] * r.state->v[i];
            check_absolute (sum[0], start, 1e-11 * start);
            check_absolute (sum[1], 0, 1e-11 * start);
            const pg_statistics *s = pg_solver_report (r.solver, r.state);
            double energy = s->energy.kinetic + s->energy.strain + s->energy.contact + s->energy.friction;
            off = fmax (off, fabs (energy / (0.25 * start) - 1));
            work = fmax (work, s->energy.contact / (0.25 * start));
            if (kept || !(s->contact.touching > 0)) continue;
            keep (&r, &t, 0);
            check_ok (pg_state_copy (b.state, r.state));
            keep (&b, &t, 1);
            kept = 1;
        }
        for (size_t i = 0; i < r.state->ndof; i += 2)
            if (r.problem->cloud.x[i] > 13) right += mass[i] * r.state->v[i] / half;
        print_message ("%s: second bar at %.4f of the velocity, energy off by %.1e, contact held %.2e\n",
                       approximations[k], right / 0.5, off, work);
        assert_true (kept && right > 0.9 * 0.5 && right < 1.01 * 0.5 && off <= 1e-2 && work > 1e-3);
        pg_free (mass), pg_free (t.byte);
        clear (&r), clear (&b);
    }
}

static void threads_shortcuts_and_stops_change_nothing (void **state)
{
    (void) state;
    static const char breaks[] = "failure: {criterion: stretch, critical_stretch: 4e-3}\n";
    disks l = { .unit = 1, .friction = 0.5, .threads = 1, .more = breaks }, many = l, plain = l;
    many.threads = 4, plain.plain = 1;
    run one = disks_run (&l), four = disks_run (&many), simple = disks_run (&plain), back = disks_run (&l);
    tape t = { 0 };
    int row = 0;
    while (!pg_solver_done (one.solver, one.state)) {
        advance_alike (&one, &four);
        advance (&simple);
        assert_memory_equal (one.state->d, simple.state->d, one.state->ndof * sizeof *one.state->d);
        /* amid contact, with slips */
        if (++row == 120) {
            const pg_statistics *s = pg_solver_report (one.solver, one.state);
            assert_true (s->contact.touching > 0 && s->energy.friction > 0 && one.state->broken > 0);
            keep (&one, &t, 0), keep (&back, &t, 1);
        } else if (row > 120) {
            advance (&back);
            assert_memory_equal (one.state->d, back.state->d, one.state->ndof * sizeof *one.state->d);
            assert_true (one.step.dissipated == back.step.dissipated);
        }
    }
    assert_true (row > 150);
    const pg_statistics *a = pg_solver_report (one.solver, one.state),
                        *b = pg_solver_report (back.solver, back.state);
    assert_true (a->energy.friction == b->energy.friction && a->energy.contact == b->energy.contact
                 && a->contact.overlap_max == b->contact.overlap_max);
    pg_free (t.byte);
    clear (&one), clear (&four), clear (&simple), clear (&back);
}


static void refused_steps_leave_no_trace (void **state)
{
    (void) state;
    disks l = { .unit = 1, .friction = 0.5, .threads = 1 };
    run a = disks_run (&l), b = disks_run (&l);
    for (int row = 0; row < 110; row++) advance (&a), advance (&b);
    double *d = pg_calloc (a.state->ndof, sizeof *d), friction, contact;
    assert_true (pg_solver_report (b.solver, b.state)->contact.touching > 0);
    memcpy (d, b.state->d, a.state->ndof * sizeof *d);
    friction = pg_solver_report (b.solver, b.state)->energy.friction;
    contact = pg_solver_report (b.solver, b.state)->energy.contact;
    /* a velocity that is not finite refuses the step */
    double v = b.state->v[0];
    b.state->v[0] = INFINITY;
    check_fails (pg_solver_step (b.solver, b.state, &b.step), PG_E_EQUILIBRIUM);
    b.state->v[0] = v;
    assert_memory_equal (d, b.state->d, a.state->ndof * sizeof *d);
    assert_true (pg_solver_report (b.solver, b.state)->energy.friction == friction
                 && pg_solver_report (b.solver, b.state)->energy.contact == contact);
    for (int row = 0; row < 20; row++) advance_alike (&a, &b);
    assert_true (pg_solver_report (a.solver, a.state)->energy.friction
                 == pg_solver_report (b.solver, b.state)->energy.friction);
    pg_free (d);
    clear (&a), clear (&b);
}

/* A quarter turn and another unit of length. */
static void units_and_directions_do_not_matter (void **state)
{
    (void) state;
    disks l = { .unit = 1, .friction = 0.3, .threads = 1 }, turned = l, small = l;
    turned.turn = 1.5707963267948966, small.unit = 1e-3;
    run a = disks_run (&l), b = disks_run (&turned), c = disks_run (&small);
    to_the_end (&a), to_the_end (&b), to_the_end (&c);
    const pg_statistics *s = pg_solver_report (a.solver, a.state), *t = pg_solver_report (b.solver, b.state),
                        *u = pg_solver_report (c.solver, c.state);
    check_relative (t->energy.friction, s->energy.friction, 1e-6);
    check_relative (t->contact.overlap_max, s->contact.overlap_max, 1e-8);
    check_relative (u->energy.friction, s->energy.friction * 1e-9, 1e-6);
    check_relative (u->contact.overlap_max, s->contact.overlap_max * 1e-3, 1e-8);
    clear (&a), clear (&b), clear (&c);
}

/* ---- nothing near, and what is refused ----------------------------------------------------------------- */
/* A pre-crack that closes bears load again: the far half of a cut bar that is pushed goes with the other one,
 * but for the bonds of three spacings across the cut that are missing. */
static void closed_cracks_bear_pressure (void **state)
{
    (void) state;
    double moved[2];
    for (int cut = 0; cut < 2; cut++) {
        run r = scene_of (1,
                          "dimension: 2\nplane: stress\nbody: [{add: {box: {low: [0, 0], high: [30, 8]}}}]\n"
                          "spacing: 1\nlattice: cells\n%smaterials: {m: {youngs_modulus: 1000, "
                          "poissons_ratio: "
                          "0.333333333333333, density: 1}}\nmethod: {force: bond, accept_inexact: yes}\n"
                          "%sboundary: [{name: push, set: left, velocity: {x: 0.02}, ramp: constant}]\n"
                          "solver: {kind: verlet, end: 1.2}\noutput: {at: {levels: 1, rows: 100}}\n",
                          cut ? "cracks: [{from: [15, -1], to: [15, 9]}]\n" : "",
                          cut ? "contact: {kind: normal, search: short_range, stiffness: 4}\n" : "");
        to_the_end (&r);
        moved[cut] = 0;
        for (size_t i = 0; i < r.problem->cloud.n; i++)
            moved[cut] += r.problem->cloud.x[2 * i] > 15 ? r.state->d[2 * i] / 120 : 0;
        clear (&r);
    }
    print_message ("the far half of a cut bar moves %.4f times as far as that of a whole one\n",
                   moved[1] / moved[0]);
    check_relative (moved[1], moved[0], 0.1);
}

/* 2 / sqrt (omega^2 + 2 c^2 / h^2), c being the speed of waves: one contact on either side of a point. */
static void the_time_step_counts_contact (void **state)
{
    (void) state;
    run r = bars (20, "verlet", 1, "");
    pg_solver_options o = r.options;
    pg_solver *without;
    o.contact.kind = PG_CONTACT_NONE;
    check_ok (pg_solver_create (&without, r.problem, &o));
    double bare = 2 / pg_solver_stable (without, NULL), both = 2 / pg_solver_stable (r.solver, NULL);
    check_relative (both * both, bare * bare + 2 * 100, 1e-12);
    /* by itself the step is half of it, so that the energy of what closes and opens is right */
    check_relative (pg_solver_settled (r.solver)->dt, 0.45 * 2 / both, 1e-2);
    pg_solver_free (&without);
    clear (&r);
}

static void nothing_near_is_skipped (void **state)
{
    (void) state;
    run r = bars (20, "verlet", 1, "");
    for (int k = 0; k < 3; k++) advance (&r);
    const pg_statistics *s = pg_solver_report (r.solver, r.state);
    int found = 0;
    for (size_t k = 0; k < s->nskipped; k++)
        found += strstr (s->skipped[k].what, "forces of contact in")
                 || strstr (s->skipped[k].what, "search for");
    assert_int_equal (found, 2);
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
    must_refuse ("contact: {kind: normal, search: short_range}\nmethod: {force: bond, accept_inexact: yes}\n"
                 "solver: {kind: static}\n", "use solver.kind: ");
    must_refuse ("contact: {kind: normal, distance: 1}\nsolver: {kind: static}\n",
                 "has a meaning with contact.search: short_range alone");
    must_refuse ("contact: {kind: friction, coefficient: 0.1, cohesion: 1, search: short_range}\nmethod: "
        "{force: "
                 "bond, accept_inexact: yes}\nsolver: {kind: verlet, end: 1}\n", "leave it out");
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (nothing_is_missed),
        cmocka_unit_test (the_skin_spares_searches),
        cmocka_unit_test (bars_exchange_velocities),
        cmocka_unit_test (disks_keep_momentum_and_energy),
        cmocka_unit_test (unknowns_of_shape_functions_collide),
        cmocka_unit_test (threads_shortcuts_and_stops_change_nothing),
        cmocka_unit_test (refused_steps_leave_no_trace),
        cmocka_unit_test (units_and_directions_do_not_matter),
        cmocka_unit_test (closed_cracks_bear_pressure),
        cmocka_unit_test (the_time_step_counts_contact),
        cmocka_unit_test (nothing_near_is_skipped),
        cmocka_unit_test (what_it_cannot_do_is_refused),
    };
    return cmocka_run_group_tests_name ("contact/short_range", tests, NULL, NULL);
}
