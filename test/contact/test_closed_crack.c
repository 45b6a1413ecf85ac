/* SPDX-License-Identifier: GPL-3.0-or-later
 * Closed cracks in equilibrium: an inclined crack in a square that bears on its outline the tractions of the
 * infinite plate, so that K_II = (|tau| - mu sigma_n) sqrt (pi a) is exact; bending that closes a part of a
 * crack; loads that come, go and turn; units, places and threads; what is refused. */
#include "../../bench/closed_crack_scenes.h"
#include "refused.h"
#include "scene_runs/run.h"

static const double pi = 3.14159265358979323846;

static run plate_run (const closed_case *l, int threads)
{
    char *text = closed_text (l);
    assert_non_null (text);
    run r = prepare (threads, text);
    pg_free (text);
    to_the_end (&r);
    return r;
}

/* Away from the tips the mean pressure is the exact one, and does not swing from piece to piece: three
 * neighbours that count 1/4, 1/2, 1/4 are within a few per cent of it. */
static void check_pressures (const closed_case *l, const pg_solver *solver)
{
    size_t n;
    const pg_contact_values *v = pg_solver_contact (solver, &n);
    double sum = 0, exact = closed_exact_of (l).normal;
    if (n < 9) return;
    for (size_t k = 2; k + 2 < n; k++) {
        sum += v[k].pressure / (double) (n - 4);
        check_relative (0.25 * (v[k - 1].pressure + v[k + 1].pressure) + 0.5 * v[k].pressure, exact, 0.06);
    }
    check_relative (sum, exact, 0.03);
}

/* K_II at both tips over the exact one (of the free crack where it sticks). */
static void measure (const closed_case *l, int threads, double K[2], pg_statistics *report)
{
    run r = plate_run (l, threads);
    closed_exact e = closed_exact_of (l);
    double scale = fabs (e.free) > 1e-9 ? e.free : e.shear;
    for (int i = 0; i < 2; i++) {
        const pg_tip_values *v = pg_solver_tip (r.solver, r.state->paths->tip[i].id);
        assert_non_null (v);
        assert_true (v->K[0] == 0);
        K[i] = v->K[1] / (scale * sqrt (pi * l->unit));
    }
    *report = *pg_solver_report_now (r.solver);
    check_pressures (l, r.solver);
    clear (&r);
}

/* On all lattices of closed_lattices; short: the second load and the last, on two of five. */
static void a_closed_crack_slides_as_in_theory (void **state)
{
    (void) state;
    static const struct { double degrees, friction; } load[] = {
        { 45, 0 }, { 30, 0.3 }, { 45, 0.6 }, { 60, 0.6 }
    };
    for (size_t i = 0; i < sizeof load / sizeof *load; i++) {
        const size_t some = longer () ? 1 : 2;
        if (!longer () && i % 2 == 0) continue;
        double mean = 0;
        for (size_t k = some - 1; k < 5; k += some) {
            if (!longer () && load[i].degrees == 60 && k < 3) continue;
            double K[2];
            pg_statistics s;
            const closed_lattice *at = &closed_lattices[k];
            closed_case l = { .load = load[i].degrees * pi / 180,
                              .friction = load[i].friction, .turn = at->turn,
                              .shift = { at->shift[0], at->shift[1] }, .perturb = at->perturb,
                              .unit = 1, .n = 15 };
            measure (&l, 1, K, &s);
            print_message ("%g degrees, friction %g, lattice %zu: K_II %.3f %.3f; %ld open, %ld stick, "
                           "%ld slide, %ld passes\n", load[i].degrees, load[i].friction, k, K[0], K[1],
                           s.contact.open, s.contact.stick, s.contact.sliding, s.contact.passes);
            assert_int_equal (s.contact.open, 0);
            assert_int_equal (s.contact.pieces, 14);
            check_below (s.contact.overlap, 1e-13);    /* rounding: 1e-10 of a slip of some 1e-3 m */
            if (load[i].degrees == 60) {               /* tan 30 degrees < 0.6: it sticks */
                assert_true (s.contact.stick >= 12);
                check_below (fmax (fabs (K[0]), fabs (K[1])), 0.03);
                continue;
            }
            assert_int_equal (s.contact.stick, 0);
            check_relative (K[0], 1, 0.02), check_relative (K[1], 1, 0.02);
            mean += (some == 1 ? 0.1 : 0.25) * (K[0] + K[1]);
        }
        if (load[i].degrees < 60) check_relative (mean, 1, 0.01);
    }
}

/* The same crack in mm, mirrored, on two threads: the same answer. */
static void units_and_mirrors_do_not_count (void **state)
{
    (void) state;
    double K[2], other[2];
    pg_statistics s, t;
    closed_case l = { .load = 0.7, .friction = 0.3, .shift = { 0.2, 0.1 }, .unit = 1, .n = 8 };
    measure (&l, 1, K, &s);
    assert_true (s.contact.sliding > 0);
    closed_case small = l, mirrored = l;
    small.unit = 1e-3;
    mirrored.mirrored = 1, mirrored.shift[0] = -0.2;
    measure (&small, 1, other, &t);
    for (int i = 0; i < 2; i++) check_relative (other[i], K[i], 1e-9);
    check_relative (t.energy.friction, s.energy.friction * 1e-9, 1e-9);
    measure (&mirrored, 1, other, &t);
    for (int i = 0; i < 2; i++) check_relative (other[i], K[1 - i], 1e-9);
    check_relative (t.energy.friction, s.energy.friction, 1e-9);
    measure (&l, 2, other, &t);
    for (int i = 0; i < 2; i++) assert_true (other[i] == K[i]);
}

/* Under proportional loads forces and slips scale with the load: a third of the load has a third of K, and a
 * ninth of the energies; events and fixed steps have the same state. Work of loads, strain energy and
 * friction balance. */
static void states_scale_with_the_load (void **state)
{
    (void) state;
    closed_case l = { .load = 0.7, .friction = 0.3, .unit = 1, .n = 8,
                      .more = "solver: {kind: static, stepping: fixed, steps: 3}\n" };
    run fixed = plate_run (&l, 1);
    l.more = "solver: {kind: static, stepping: event}\n";
    run event = plate_run (&l, 1);
    const pg_statistics *s = pg_solver_report_now (fixed.solver), *t = pg_solver_report_now (event.solver);
    double largest = 0;
    for (size_t i = 0; i < fixed.state->ndof; i++) largest = fmax (largest, fabs (fixed.state->d[i]));
    for (size_t i = 0; i < fixed.state->ndof; i++)
        check_scaled (event.state->d[i], fixed.state->d[i], 1e-9, largest);
    check_relative (t->energy.friction, s->energy.friction, 1e-9);
    assert_true (s->energy.friction > 0.01 * s->energy.strain);
    check_scaled (s->energy.external - s->energy.strain - s->energy.friction, 0, 1e-9, s->energy.external);
    check_scaled (t->energy.external - t->energy.strain - t->energy.friction, 0, 1e-9, t->energy.external);
    clear (&fixed), clear (&event);
}

/* Load, unload: without friction nothing is left; with it slip remains that the friction of both ways holds.
 * Energy balances all the time, and friction takes more on the way back. */
static void slip_remembers_the_way (void **state)
{
    (void) state;
    double kept[2] = { 0, 0 }, top = 0;
    for (int k = 0; k < 2; k++) {
        run r = scene_of (1,
            "dimension: 2\nplane: stress\nthickness: 1\nbody: [{add: {box: {low: [-2, -2], high: [2, 2]}}}]\n"
            "spacing: 0.125\nlattice: cells\ncracks: [{from: [-0.7, -0.71], to: [0.7, 0.71]}]\n"
            "materials: {m: {youngs_modulus: 1000, poissons_ratio: 0.25}}\ncontact: %s\n"
            "boundary:\n  - {set: bottom, displacement: {x: 0, y: 0}}\n"
            "  - {set: top, traction: {y: \"-10*min(t, 1.05-t)\"}, ramp: \"1\"}\n"
            "  - {set: right, traction: {x: -1}, ramp: constant}\n"
            "  - {set: left, traction: {x: 1}, ramp: constant}\n"
            "solver: {kind: static, stepping: fixed, steps: 20}\noutput: {at: {levels: 1}}\n",
            k ? "{kind: friction, coefficient: 0.3}" : "{kind: normal}");
        double before = 0;
        while (!pg_solver_done (r.solver, r.state)) {
            advance (&r);
            const pg_statistics *s = pg_solver_report_now (r.solver);
            check_scaled (s->energy.external - s->energy.strain - s->energy.friction, 0, 1e-9,
                          fabs (s->energy.strain) + fabs (s->energy.external));
            assert_true (s->energy.friction >= before * (1 - 1e-9));
            before = s->energy.friction;
            top = fmax (top, s->energy.strain);
        }
        kept[k] = before;
        clear (&r);
    }
    check_scaled (kept[0], 0, 1e-12, top);
    assert_true (kept[1] > 1e-3 * top);
}

/* A crack along x under the stress sigma_yy = x of pure bending, with the tractions of the infinite plate:
 * it is closed at its left, and open from x = - a / 3 to its right tip, as one of length 4/3 a that closes
 * smoothly at its left end. PERIGAL_TEST_SIZE=long: in three plates, else in the last. */
static void bending_closes_a_part (void **state)
{
    (void) state;
    static const struct { int lattice; const char *plane; double nu; } plates[] = {
        { 0, "stress", 0.25 }, { 3, "stress", 0.25 }, { 1, "strain", 0.45 }
    };
    for (size_t k = longer () ? 0 : 2; k < sizeof plates / sizeof *plates; k++) {
        const closed_lattice *at = &closed_lattices[plates[k].lattice];
        closed_case l = { .bending = 1, .unit = 1, .n = 15, .plane = plates[k].plane, .nu = plates[k].nu,
                          .turn = at->turn, .shift = { at->shift[0], at->shift[1] }, .perturb = at->perturb };
        run r = plate_run (&l, 1);
        const pg_statistics *s = pg_solver_report_now (r.solver);
        const pg_tip_values *left = pg_solver_tip (r.solver, r.state->paths->tip[0].id),
                            *right = pg_solver_tip (r.solver, r.state->paths->tip[1].id);
        double theory = closed_right (&l);
        if (r.state->paths->tip[0].x[0] > 0) {
            const pg_tip_values *other = left;
            left = right, right = other;
        }
        print_message ("bending, plane %s, %s: K_I %.4f of the exact one, %ld of %ld open, %ld passes\n",
                       plates[k].plane, at->name, right->K[0] / theory, s->contact.open, s->contact.pieces,
                       s->contact.passes);
        assert_true (left->K[0] == 0);
        check_scaled (left->K[1], 0, 0.01, theory);
        check_scaled (right->K[1], 0, 0.02, theory);
        check_relative (right->K[0], theory, 0.01);
        /* open from -1/3 on: two thirds of the length, to half a piece */
        check_relative ((double) s->contact.open / (double) s->contact.pieces, 2.0 / 3, 0.06);
        check_below (s->contact.overlap, 1e-13);
        clear (&r);
    }
}

/* Wings of a crack at 45 degrees to the load: both leave it at 70.5 degrees, when K_II = sqrt (3) / 2 K_c,
 * turn towards the load, and take their energy, friction deducted. PERIGAL_TEST_SIZE=long: without friction,
 * too. */
static void wings_leave_a_closed_crack (void **state)
{
    (void) state;
    static const double friction[] = { 0, 0.3 };
    for (int k = !longer (); k < 2; k++) {
        run r = scene_of (1,
            "dimension: 2\nplane: stress\nthickness: 1\nbody: [{add: {box: {low: [-3, -3], high: [3, 3]}}}]\n"
            "spacing: 0.1\nlattice: cells\ncracks: [{from: [-0.7071, -0.7071], to: [0.7071, 0.7071]}]\n"
            "materials: {m: {youngs_modulus: 1000, poissons_ratio: 0.25}}\ncontact: %s\n"
            "sets: {a: {where: \"x < -2.9 and y < -2.9\"}, b: {where: \"x > 2.9 and y < -2.9\"}}\n"
            "boundary:\n  - {set: top, traction: {y: -10}}\n  - {set: bottom, traction: {y: 10}}\n"
            "  - {set: a, essential: penalty, displacement: {x: 0, y: 0}}\n"
            "  - {set: b, essential: penalty, displacement: {y: 0}}\n"
            "failure: {criterion: energy_release, fracture_energy: 1e-3}\n"
            "solver: {kind: static, stepping: event, max_events: 7}\noutput: {at: {levels: 1}}\n",
            k ? "{kind: friction, coefficient: 0.3}" : "{kind: normal}");
        double before = 0;
        while (!pg_solver_done (r.solver, r.state)) {
            advance (&r);
            const pg_tip_values *v = pg_solver_tip (r.solver, r.state->paths->tip[0].id);
            if (r.step.number == 1) {
                assert_true (v->K[0] == 0);
                check_relative (fabs (v->K[1]), sqrt (3) / 2, 0.03);   /* K_c = 1; tied with the other */
            } else assert_true (v->K[0] > 0.9);
            assert_true (r.step.factor > before);      /* wings are stable */
            before = r.step.factor;
        }
        const pg_crack_paths *w = r.state->paths;
        const pg_statistics *s = pg_solver_report (r.solver, r.state);
        double largest = largest_of (r.state->d, r.state->ndof);
        print_message ("overlap of faces %.2e of the largest displacement\n",
                       s->contact.overlap_max / largest);
        check_below (s->contact.overlap_max, 0.015 * largest);
        assert_true (s->contact.overlap_max > s->contact.overlap);
        const double *x = w->cracks.crack[1].vertex, crack = atan2 (1, 1);
        double first = atan2 (x[3] - x[1], x[2] - x[0]), turn = fmod (first - crack + 4 * pi, pi);
        print_message ("wings, friction %g: kink %.1f degrees, grown %.3f %.3f, dissipated %.3f of the "
                       "energy, friction %.3g of the work\n", friction[k], turn * 180 / pi, w->tip[0].grown,
                       w->tip[1].grown, s->energy.dissipated / s->energy.fracture,
                       s->energy.friction / s->energy.external);
        check_relative (turn * 180 / pi, 70.53, 0.02);
        check_relative (w->tip[0].grown, w->tip[1].grown, 1e-9);
        check_relative (s->energy.dissipated, s->energy.fracture, 0.08);  /* found: 0.95 */
        assert_true (k ? s->energy.friction > 0.01 * s->energy.external
                       : fabs (s->energy.friction) < 1e-12 * s->energy.external);
        for (int i = 0; i < 2; i++) {                  /* they end along the load */
            double e[2], from[2];
            pg_tip_chord (r.state->paths, (size_t) i, 0.25, from, e);
            assert_true (fabs (e[1]) > 0.85);
        }
        clear (&r);
    }
}

/* Two spacings behind the kink no ring fits between a wing and the closed faces: its K is that of the ring
 * around the kink, with the tractions of these faces. Displacement discontinuities on the same paths, in
 * units of the load and sqrt (pi c): build/release/bench/wing_cracks show 30 0 0 0 8 4. Rings around the tip
 * had .52 of K_I on one side, and three events later that wing had not grown. */
static void short_wings_have_the_intensities_of_their_path (void **state)
{
    (void) state;
    static const double right[3][2][2] = { { { 0.2537, 0.0608 }, { 0.2537, 0.0612 } },
                                           { { 0.2277, -0.0031 }, { 0.2279, -0.0211 } },
                                           { { 0.2015, -0.0022 }, { 0.2023, 0 } } };
    run r = scene_of (1,
        "dimension: 2\nplane: stress\nthickness: 1\nbody: [{add: {box: {low: [-3, -3], high: [3, 3]}}}]\n"
        "spacing: 0.125\nlattice: cells\n"
        "cracks: [{from: [-0.45375, -0.83977540378], to: [0.54625, 0.89227540378]}]\n"
        "materials: {m: {youngs_modulus: 1000, poissons_ratio: 0.25}}\ncontact: {kind: normal}\n"
        "sets: {a: {where: \"x < -2.875 and y < -2.875\"}, b: {where: \"x > 2.875 and y < -2.875\"}}\n"
        "boundary:\n  - {set: top, traction: {y: -1}}\n  - {set: bottom, traction: {y: 1}}\n"
        "  - {set: a, essential: penalty, displacement: {x: 0, y: 0}}\n"
        "  - {set: b, essential: penalty, displacement: {y: 0}}\n"
        "failure: {criterion: energy_release, fracture_energy: 2.5e-6}\n"
        "solver: {kind: static, stepping: event, max_events: 4}\noutput: {at: {levels: 1}}\n");
    for (int event = 0; event < 4; event++) {
        do advance (&r);
        while (!r.step.event);
        for (int i = 0; event && i < 2; i++) {
            const pg_tip_values *v = pg_solver_tip (r.solver, r.state->paths->tip[i].id);
            const double *k = right[event - 1][i], unit = r.step.factor * sqrt (pi);
            print_message ("event %d, wing %d: K_I %.4f of %.4f, K_II %.4f of %.4f\n", event + 1, i,
                           v->K[0] / unit, k[0], v->K[1] / unit, k[1]);
            check_relative (v->K[0] / unit, k[0], 0.05);           /* slip of the crack itself: 4 % */
            check_absolute (v->K[1] / unit, k[1], 0.05 * k[0]);
        }
    }
    check_relative (r.state->paths->tip[0].grown, r.state->paths->tip[1].grown, 1e-9);
    clear (&r);
}

/* A crack through a plate whose upper half is moved down and aside: the faces overlap by what it came down,
 * at all places of the crack, and by nothing where it was moved up. */
static void overlap_is_seen_on_the_faces (void **state)
{
    (void) state;
    static const double down[] = { 0.01, -0.01 };
    run r = scene_of (1,
        "dimension: 2\nplane: stress\nthickness: 1\nbody: [{add: {box: {low: [-1, -1], high: [1, 1]}}}]\n"
        "spacing: 0.1\nlattice: cells\nperturb: {amount: 0.2}\ncracks: [{from: [-2, -0.53], to: [2, 0.57]}]\n"
        "materials: {m: {youngs_modulus: 1000, poissons_ratio: 0.25}}\ncontact: {kind: normal}\n"
        "boundary: [{set: bottom, displacement: {x: 0, y: 0}}, {set: top, displacement: {x: 0, y: 0}}]\n"
        "solver: {kind: static, stepping: fixed, steps: 1}\noutput: {at: {levels: 1}}\n");
    void *self;
    const pg_force_type *force = pg_solver_force (r.solver, &self);
    const pg_crack *c = &r.problem->crack.given.crack[0];
    pg_contact_pieces pieces;
    refresh (&r, NULL);
    check_ok (pg_contact_pieces_create (&pieces, r.problem, r.state));
    assert_true (pieces.n > 5);
    for (int k = 0; k < 2; k++) {
        for (size_t i = 0; i < r.problem->cloud.n; i++) {
            const double *x = r.problem->cloud.x + 2*i;
            int above = (x[0] - c->vertex[0]) * c->normal[0] + (x[1] - c->vertex[1]) * c->normal[1] > 0;
            for (int m = 0; m < 2; m++)
                r.state->d[2*i + (size_t) m] = above * (0.02 * c->normal[1 - m] * (m ? -1 : 1)
                                                        - down[k] * c->normal[m]);
        }
        double overlap;
        check_ok (pg_contact_overlap (&overlap, &pieces, force, self, r.state, r.state->d));
        check_scaled (overlap, fmax (0, down[k]), 1e-9, 0.01);
    }
    pg_contact_pieces_clear (&pieces);
    clear (&r);
}

/* Confine, compress, unload, compress again, with friction: on the way back the faces stick before they slide
 * the other way, so that work is taken on both ways; the second loading ends in the state of the first, and
 * the energies of all of it balance. */
static void stages_go_around_a_loop (void **state)
{
    (void) state;
    run r = scene_of (1,
        "dimension: 2\nplane: stress\nthickness: 1\nbody: [{add: {box: {low: [-2, -2], high: [2, 2]}}}]\n"
        "spacing: 0.2\nlattice: cells\ncracks: [{from: [-0.7, -0.71], to: [0.7, 0.71]}]\n"
        "materials: {m: {youngs_modulus: 1000, poissons_ratio: 0.25}}\n"
        "contact: {kind: friction, coefficient: 0.3}\nboundary:\n"
        "  - {name: foot, set: bottom, displacement: {x: 0, y: 0}}\n"
        "  - {name: head, set: top, traction: {y: -10}}\n  - {name: r, set: right, traction: {x: -1}}\n"
        "  - {name: l, set: left, traction: {x: 1}}\nstages:\n  - {name: confine, boundary: {r: 1, l: 1}}\n"
        "  - {name: compress, boundary: {head: 1}}\n  - {name: unload, boundary: {head: 0}}\n"
        "  - {name: again, boundary: {head: 1}}\n"
        "solver: {kind: static, stepping: fixed, steps: 6}\noutput: {at: {levels: 1}}\n");
    enum { PIECES = 16 };
    double slip[25] = { 0 }, friction[25] = { 0 }, strain[25] = { 0 };
    long sticks = 0;
    for (size_t step = 1; !pg_solver_done (r.solver, r.state); step++) {
        advance (&r);
        size_t n;
        const pg_contact_values *v = pg_solver_contact (r.solver, &n);
        const pg_statistics *s = pg_solver_report_now (r.solver);
        assert_true (step < 25 && n > 2 && n < PIECES);
        slip[step] = v[n / 2].slip[0], friction[step] = s->energy.friction, strain[step] = s->energy.strain;
        check_below (fabs (v[n / 2].shear[0]), 0.3 * v[n / 2].pressure * (1 + 1e-9));
        assert_true (friction[step] >= friction[step - 1] * (1 - 1e-12));
        check_scaled (s->energy.external - s->energy.strain - s->energy.friction, 0, 1e-9, 1);
        sticks += v[n / 2].status == PG_CONTACT_STICK;
        if (v[n / 2].status == PG_CONTACT_STICK) check_relative (slip[step], slip[step - 1], 1e-9);
    }
    assert_true (sticks >= 2);
    check_relative (slip[24], slip[12], 1e-9);
    check_relative (strain[24], strain[12], 1e-9);
    assert_true (friction[18] > 1.1 * friction[12] && friction[24] > 1.1 * friction[18]);
    clear (&r);
}

/* A stage at whose end nothing loads the body any more: what is left is rounding, and no reason to refuse. */
static void a_load_returns_to_zero (void **state)
{
    (void) state;
    static const char *const pull[] = { "0.01", "-0.01" };
    for (size_t k = 0; k < 2; k++) {
        run r = scene_of (1,
            "dimension: 2\nplane: stress\nthickness: 1\nbody: [{add: {box: {low: [-2, -2], high: [2, 2]}}}]\n"
            "spacing: 0.2\nlattice: cells\ncracks: [{from: [-0.7, -0.71], to: [0.7, 0.71]}]\n"
            "materials: {m: {youngs_modulus: 1000, poissons_ratio: 0.25}}\ncontact: {kind: normal}\n"
            "boundary:\n  - {name: foot, set: bottom, displacement: {x: 0, y: 0}}\n"
            "  - {name: head, set: top, displacement: {x: 0.003, y: %s}}\n"
            "stages:\n  - {name: there, boundary: {head: 1}}\n  - {name: back, boundary: {head: 0}}\n"
            "solver: {kind: static}\noutput: {at: {levels: 2}}\n", pull[k]);
        double most = 0;
        while (!pg_solver_done (r.solver, r.state)) {
            advance (&r);
            most = fmax (most, pg_solver_report_now (r.solver)->energy.strain);
        }
        assert_true (r.options.event && most > 0);
        check_below (pg_solver_report_now (r.solver)->energy.strain / most, 1e-12);
        clear (&r);
    }
}

/* What is not built is refused with words. */
static void the_rest_is_refused (void **state)
{
    (void) state;
#define PLATE "body: [{add: {box: {low: [-2, -2], high: [2, 2]}}}]\nspacing: 0.25\nlattice: cells\n" \
              "materials: {m: {youngs_modulus: 1000, poissons_ratio: 0.25, density: 1}}\n" \
              "boundary: [{set: bottom, displacement: {x: 0, y: 0}}, {set: top, displacement: {y: -0.1}}"
#define FLAT  "dimension: 2\nplane: stress\nthickness: 1\ncracks: [{from: [-1, 0.1], to: [1, 0.1]}]\n" PLATE
    static const struct { const char *scene, *words; } wrong[] = {
        { FLAT "]\nmethod: {force: bond, stretch: finite}\ncontact: {kind: normal}\n"
          "solver: {kind: adr}\n", "small displacements" },
        { FLAT "]\nsolver: {kind: verlet, end: 1}\ncontact: {kind: normal}\n", "forces by bonds" },
        { FLAT ", {set: top, displacement: {x: 0.01}, ramp: constant}]\nmethod: {force: bond}\n"
          "contact: {kind: normal}\nfailure: {criterion: stretch, critical_stretch: 1e-3}\n"
          "solver: {stepping: event}\n", "faces that single broken bonds leave" },
        { FLAT "]\nsolver: {kind: newmark, dt: 1, end: 2, alpha: -0.1}\ncontact: {kind: normal}\n",
          "impulses of contact" },
        { FLAT "]\ncontact: {kind: friction}\n", "kind: friction needs it" },
        { FLAT "]\ncontact: {kind: normal, coefficient: 0.3}\n", "kind: friction alone" },
        { FLAT "]\nmethod: {force: bond}\ncontact: {kind: normal}\n"
          "failure: {criterion: energy_release, fracture_energy: 1, tensile_strength: 1}\n",
          "with a strength" },
        { FLAT "]\ncontact: {kind: normal}\nfailure: {criterion: principal_stress, tensile_strength: 1}\n",
          "not those of single broken bonds" },
    };
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
        check_refused (wrong[i].scene, wrong[i].words);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (a_closed_crack_slides_as_in_theory),
        cmocka_unit_test (units_and_mirrors_do_not_count),
        cmocka_unit_test (states_scale_with_the_load),
        cmocka_unit_test (slip_remembers_the_way),
        cmocka_unit_test (bending_closes_a_part),
        cmocka_unit_test (wings_leave_a_closed_crack),
        cmocka_unit_test (short_wings_have_the_intensities_of_their_path),
        cmocka_unit_test (overlap_is_seen_on_the_faces),
        cmocka_unit_test (stages_go_around_a_loop),
        cmocka_unit_test (a_load_returns_to_zero),
        cmocka_unit_test (the_rest_is_refused),
    };
    return cmocka_run_group_tests (tests, NULL, NULL);
}
