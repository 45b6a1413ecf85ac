/* SPDX-License-Identifier: GPL-3.0-or-later
 * Contact of crack faces by event stepping where loads have a constant part, and in stages: the state at the
 * end of a path against the direct solution and against many small steps, energies around loops, stages that
 * end early, growth of closed cracks, checkpoints, units, cohesion. */
#include "scene_runs/run.h"
#include "solve/tape.h"

static const double pi = 3.14159265358979323846;

/* A plate of 4 by 4 m with an inclined crack; unit: m of its length unit; loads are stresses as given. */
typedef struct {
    double unit, spacing, turn;                        /* half lengths of the crack: 1 unit */
    const char *contact, *loads, *solver;
    const char *more, *gauges;
    int threads;
} plate;

static run plate_run (const plate *l)
{
    double u = l->unit > 0 ? l->unit : 1, c = cos (l->turn), s = sin (l->turn);
    return scene_of (l->threads ? l->threads : 1,
        "dimension: 2\nplane: stress\nthickness: %.17g\nbody: [{add: {box: {low: [%.17g, %.17g], high: "
        "[%.17g, %.17g]}}}]\nspacing: %.17g\nlattice: cells\n"
        "cracks: [{from: [%.17g, %.17g], to: [%.17g, %.17g]}]\n"
        "materials: {m: {youngs_modulus: 1000, poissons_ratio: 0.25}}\ncontact: %s\n"
        "sets: {a: {where: \"x < %.17g and y < %.17g\"}}\nboundary:\n"
        "  - {name: foot, set: bottom, displacement: {y: 0}}\n"
        "  - {name: pin, set: a, essential: penalty, displacement: {x: 0}}\n%s"
        "solver: {kind: static, %s}\noutput: {at: {levels: 1}%s}\n%s",
        u, -2 * u, -2 * u, 2 * u, 2 * u, l->spacing * u, -c * u, -s * u, c * u, s * u, l->contact,
        -2 * u + l->spacing * u, -2 * u + l->spacing * u, l->loads, l->solver, l->gauges ? l->gauges : "",
        l->more ? l->more : "");
}

#define CONFINE "  - {name: r, set: right, traction: {x: -1}}\n  - {name: l, set: left, traction: {x: 1}}\n"
#define HELD    "  - {name: r, set: right, traction: {x: -1}, ramp: constant}\n" \
                "  - {name: l, set: left, traction: {x: 1}, ramp: constant}\n"
#define HEAD(p) "  - {name: head, set: top, traction: {y: " p "}}\n"

static double largest (const run *r)
{
    double out = 0;
    for (size_t i = 0; i < r->state->ndof; i++) out = fmax (out, fabs (r->state->d[i]));
    return out;
}

static void same_state (const run *a, const run *b, double tolerance)
{
    double size = largest (b);
    for (size_t i = 0; i < a->state->ndof; i++)
        check_scaled (a->state->d[i], b->state->d[i], tolerance, size);
    size_t n, m;
    const pg_contact_values *v = pg_solver_contact (a->solver, &n), *w = pg_solver_contact (b->solver, &m);
    assert_int_equal (n, m);
    double p = 0, s = 0;
    for (size_t k = 0; k < n; k++) p = fmax (p, fabs (w[k].pressure)), s = fmax (s, fabs (w[k].slip[0]));
    for (size_t k = 0; k < n; k++) {
        check_scaled (v[k].pressure, w[k].pressure, 10 * tolerance, p);
        check_scaled (v[k].shear[0], w[k].shear[0], 10 * tolerance, p);
        check_scaled (v[k].slip[0], w[k].slip[0], 10 * tolerance, s);
    }
}

static void balances (const run *r, double tolerance)
{
    const pg_statistics *s = pg_solver_report_now (r->solver);
    check_scaled (s->energy.external - s->energy.strain - s->energy.friction, 0, tolerance,
                  fabs (s->energy.external) + fabs (s->energy.strain));
}

/* A confinement that is there from the start, then a growing load: pieces begin to slide one after the other,
 * and the end is the direct solution. */
static void a_ramp_ends_in_the_direct_solution (void **state)
{
    (void) state;
    static const char *const contact[] = { "{kind: normal}", "{kind: friction, coefficient: 0.3}",
                                           "{kind: friction, coefficient: 0.2, cohesion: 0.5}" };
    for (size_t i = 0; i < 3; i++) {
        plate l = { .spacing = 0.2, .turn = 0.8, .contact = contact[i], .loads = HELD HEAD ("-10"),
                    .solver = "stepping: event" };
        run event = plate_run (&l);
        while (!pg_solver_done (event.solver, event.state)) advance (&event), balances (&event, 1e-9);
        l.solver = "stepping: fixed, steps: 1";
        run direct = plate_run (&l);
        to_the_end (&direct);
        const pg_statistics *s = pg_solver_report_now (event.solver);
        print_message ("ramp, %s: %ld open %ld stick %ld slide, %ld changes, friction %.3g of the work\n",
                       contact[i], s->contact.open, s->contact.stick, s->contact.sliding, s->contact.changes,
                       s->energy.friction / s->energy.external);
        same_state (&event, &direct, 1e-10);
        check_below (s->contact.overlap, 1e-14);
        clear (&event), clear (&direct);
    }
}

#define STAGES "stages:\n  - {name: confine, boundary: {r: 1, l: 1}}\n" \
               "  - {name: compress, boundary: {head: 1}}\n" \
               "  - {name: unload, boundary: {head: 0}}\n  - {name: again, boundary: {head: 1}}\n"

/* Confine, compress, unload, compress again, take all away: pieces stick on the way back, then slide back, so
 * that friction takes work on every way; the second loading ends in the state of the first; energies balance
 * all the time; without loads there is the origin again. */
static void stages_go_around_a_loop (void **state)
{
    (void) state;
    plate l = { .spacing = 0.25, .turn = 0.8, .contact = "{kind: friction, coefficient: 0.3}",
                .loads = CONFINE HEAD ("-10"), .solver = "stepping: event",
                .more = STAGES "  - {name: away, boundary: {r: 0, l: 0, head: 0}}\n" };
    run event = plate_run (&l);
    size_t steps = 0;
    double friction[6] = { 0 }, slip[6] = { 0 }, strain[6] = { 0 }, size = 0;
    while (!pg_solver_done (event.solver, event.state)) {
        advance (&event), balances (&event, 1e-9), steps++;
        const pg_statistics *s = pg_solver_report_now (event.solver);
        size_t n;
        const pg_contact_values *v = pg_solver_contact (event.solver, &n);
        long k = (long) round (event.state->factor);
        friction[k] = s->energy.friction, slip[k] = v[n / 2].slip[0], strain[k] = s->energy.strain;
        size = fmax (size, largest (&event));
        print_message ("t %g: slip %.5g, friction %.5g, strain %.5g, %ld changes so far, balance %.1e\n",
                       event.state->factor, slip[k], friction[k], strain[k], s->contact.changes,
                       fabs (s->energy.external - s->energy.strain - s->energy.friction)
                           / fmax (s->energy.external, 1e-300));
    }
    assert_int_equal (steps, 6);                       /* changes of status are no steps of their own */
    check_relative (slip[4], slip[2], 1e-9);
    check_relative (strain[4], strain[2], 1e-9);
    for (int k = 1; k < 5; k++) assert_true (friction[k + 1] > friction[k]);
    assert_true (friction[3] > 1.3 * friction[2]);
    check_scaled (largest (&event), 0, 1e-10, size);
    assert_true (pg_solver_report_now (event.solver)->contact.changes >= 12);
    clear (&event);
}

/* On the way back, where pieces stick and slide against each other, the state is that of very many fixed
 * steps; so it is after a part of the load has come again, which begins where pieces stick. */
static void the_way_back_is_that_of_small_steps (void **state)
{
    (void) state;
    plate l = { .spacing = 0.25, .turn = 0.8, .contact = "{kind: friction, coefficient: 0.3}",
                .loads = CONFINE HEAD ("-10"), .solver = "stepping: event",
                .more = "stages:\n  - {name: confine, boundary: {r: 1, l: 1}}\n"
                        "  - {name: compress, boundary: {head: 1}}\n"
                        "  - {name: unload, boundary: {head: 0.5}}\n"
                        "  - {name: jacket, boundary: {r: 1.5, l: 1.5}}\n"
                        "  - {name: again, boundary: {head: 0.7}}\n" };
    run event = plate_run (&l);
    to_the_end (&event);
    l.solver = "stepping: fixed, steps: 300";
    run fixed = plate_run (&l);
    to_the_end (&fixed);
    same_state (&event, &fixed, 1e-3);
    const pg_statistics *s = pg_solver_report_now (event.solver), *t = pg_solver_report_now (fixed.solver);
    check_relative (s->energy.friction, t->energy.friction, 5e-3);
    clear (&event), clear (&fixed);
}

#define GROWS "failure: {criterion: energy_release, fracture_energy: 1e-3}\n"

/* The same growth whether the loads are proportional, and the way from event to event in closed form, or have
 * a constant part that happens to be zero: loads, energies, paths, also where the load falls after a facet.
 * (Where it falls so far that slips turn round, the closed form is no longer right.) */
static void growth_is_that_of_proportional_loads (void **state)
{
    (void) state;
    plate l = { .spacing = 0.2, .turn = pi / 4, .contact = "{kind: friction, coefficient: 0.3}",
                .loads = HEAD ("-20"), .solver = "stepping: event, max_events: 5", .more = GROWS };
    run one = plate_run (&l);
    l.loads = HEAD ("-20") "  - {set: right, traction: {x: 0}, ramp: constant}\n";
    run two = plate_run (&l);
    advance (&two);
    assert_true (two.state->factor == 0);
    int falls = 0;
    double before = 0;
    while (!pg_solver_done (one.solver, one.state)) {
        advance (&one), advance (&two);
        check_relative (two.state->factor, one.state->factor, 1e-9);
        falls += one.state->factor < before, before = one.state->factor;
        const pg_statistics *s = pg_solver_report_now (one.solver), *t = pg_solver_report_now (two.solver);
        if (pg_solver_done (one.solver, one.state)) break;             /* it falls far after the last one */
        check_relative (t->energy.external, s->energy.external, 1e-9);
        check_relative (t->energy.friction, s->energy.friction, 1e-9);
        check_relative (t->energy.dissipated, s->energy.dissipated, 1e-8);
    }
    assert_true (falls >= 1);
    assert_int_equal (one.state->paths->cracks.n, two.state->paths->cracks.n);
    for (size_t i = 0; i < 2; i++)
        for (int k = 0; k < 2; k++)
            check_scaled (two.state->paths->tip[i].x[k], one.state->paths->tip[i].x[k], 1e-9, 1);
    clear (&one), clear (&two);
}

/* A stage ends where a gauge says so, between two changes of status as exactly as without contact; the run
 * goes on from there. */
static void a_gauge_ends_a_stage_between_changes (void **state)
{
    (void) state;
    plate l = { .spacing = 0.25, .turn = 0.8, .contact = "{kind: friction, coefficient: 0.3}",
                .loads = CONFINE HEAD ("-10"), .solver = "stepping: event",
                .gauges = ", gauges: [{name: g, from: [0, -1.9], to: [0, 1.9]}]",
                .more = "stages:\n  - {name: confine, boundary: {r: 1, l: 1}}\n"
                        "  - {name: compress, boundary: {head: 1}, until: {gauge: g, opening: -20 mm}}\n"
                        "  - {name: unload, boundary: {head: 0}, until: {gauge: g, opening: -9 mm}}\n" };
    run r = plate_run (&l);
    size_t n;
    const pg_stage_record *record = pg_solver_stages (r.solver, &n);
    while (!pg_solver_done (r.solver, r.state)) advance (&r), balances (&r, 1e-9);
    assert_int_equal (n, 3);
    for (int k = 1; k < 3; k++) {
        print_message ("stage %d: %s at share %.6f, opening %.9g\n", k + 1, record[k].why, record[k].share,
                       record[k].gauge[0]);
        assert_string_equal (record[k].why, "gauge");
        check_relative (record[k].gauge[0], k == 1 ? -20e-3 : -9e-3, 1e-9);
    }
    assert_true (pg_solver_report_now (r.solver)->contact.changes >= 2);
    clear (&r);
}

/* A checkpoint after every step, between stages and within them, with growth and without.
 * PERIGAL_TEST_SIZE=short: after every other step. */
static void a_resumed_run_goes_on_bit_by_bit (void **state)
{
    (void) state;
    static const char *const more[] = {
        "output: {at: {levels: 2}, gauges: [{name: g, from: [0, -1.9], to: [0, 1.9]}]}\n",
        "output: {at: {levels: 1}}\n" GROWS
    };
    for (int k = 0; k < 2; k++) {
        char text[3000];
        snprintf (text, sizeof text,
                  "dimension: 2\nplane: strain\nthickness: 1\n"
                  "body: [{add: {box: {low: [-2, -2], high: [2, 2]}}}]\n"
                  "spacing: 0.25\nlattice: cells\ncracks: [{from: [-0.7, -0.71], to: [0.7, 0.71]}]\n"
                  "materials: {m: {youngs_modulus: 1000, poissons_ratio: 0.25}}\n"
                  "contact: {kind: friction, coefficient: 0.3, cohesion: 0.01}\nboundary:\n"
                  "  - {name: foot, set: bottom, displacement: {x: 0, y: 0}}\n%s%s"
                  "stages:\n  - {name: confine, boundary: {r: 1, l: 1}}\n"
                  "  - {name: compress, boundary: {head: 1}, until: {%s}}\n"
                  "  - {name: unload, boundary: {head: 0.2}}\n"
                  "solver: {kind: static, stepping: event, max_events: 4}\n%s",
                  CONFINE, HEAD ("-8"), k ? "events: 2" : "gauge: g, opening: -15 mm", more[k]);
        run a = prepare (1, text);
        long steps = 0;
        for (int ended = 0; !ended; steps++) {
            advance (&a);
            ended = pg_solver_done (a.solver, a.state);
            if (!longer () && steps % 2 == 0) continue;
            run b = prepare (1, text), c = prepare (1, text);
            tape t = { 0 };
            keep (&a, &t, 0);
            keep (&b, &t, 1);
            for (long i = 0; i <= steps; i++) advance (&c);
            while (!pg_solver_done (c.solver, c.state)) {
                advance_alike (&c, &b);
                assert_true (pg_solver_report_now (b.solver)->energy.friction
                             == pg_solver_report_now (c.solver)->energy.friction);
            }
            clear (&b), clear (&c);
            pg_free (t.byte);
        }
        assert_true (steps >= 4);
        clear (&a);
    }
}

/* A plate in mm, and two threads: the same. */
static void units_and_threads_do_not_count (void **state)
{
    (void) state;
    plate l = { .spacing = 0.2, .turn = 0.8, .contact = "{kind: friction, coefficient: 0.3}",
                .loads = CONFINE HEAD ("-10"), .solver = "stepping: event",
                .more = STAGES };
    run one = plate_run (&l);
    to_the_end (&one);
    l.unit = 1e-3;
    run small = plate_run (&l);
    to_the_end (&small);
    l.unit = 1, l.threads = 2;
    run two = plate_run (&l);
    to_the_end (&two);
    double size = largest (&one);
    for (size_t i = 0; i < one.state->ndof; i++) {
        check_scaled (1e3 * small.state->d[i], one.state->d[i], 1e-9, size);
        assert_true (two.state->d[i] == one.state->d[i]);
    }
    const pg_statistics *s = pg_solver_report_now (one.solver), *t = pg_solver_report_now (small.solver);
    check_relative (t->energy.friction, 1e-9 * s->energy.friction, 1e-9);
    assert_int_equal (s->contact.changes, t->contact.changes);
    clear (&one), clear (&small), clear (&two);
}

static int within (double a, double b, double tolerance) { return fabs (a - b) <= tolerance * fabs (b); }

/* The first wing of a confined crack leaves where K_II of the shear that friction does not bear says so.
 * PERIGAL_TEST_SIZE=long: under two confinements, else under the larger one. */
static void confinement_holds_wings_back (void **state)
{
    (void) state;
    double first[3];
    for (int k = 0; k < 3; k += longer () ? 1 : 2) {
        char loads[512];
        snprintf (loads, sizeof loads,
                  "  - {set: right, traction: {x: %g}, ramp: constant}\n"
                  "  - {set: left, traction: {x: %g}, ramp: constant}\n"
                  "  - {set: top, traction: {y: %g}, ramp: constant}\n" HEAD ("-30"),
                  -0.5 * k, 0.5 * k, -0.5 * k);
        plate l = { .spacing = 0.2, .turn = pi / 4, .contact = "{kind: friction, coefficient: 0.3}",
                    .loads = loads, .solver = "stepping: event, max_events: 4", .more = GROWS };
        run r = plate_run (&l);
        first[k] = 0;
        while (!pg_solver_done (r.solver, r.state)) {
            advance (&r);
            if (r.state->events == 1 && first[k] == 0) first[k] = 30 * r.state->factor;
        }
        const pg_statistics *s = pg_solver_report_now (r.solver);
        print_message ("confined by %g: first wing at %.5g, %ld events, dissipated %.3f of the energy\n",
                       0.5 * k, first[k], s->events, s->energy.dissipated / s->energy.fracture);
        assert_int_equal (s->events, 4);
        clear (&r);
    }
    /* (q / 2) - mu (q / 2 + s) is what slides: q grows by 2 mu s / (1 - mu) */
    for (int k = longer () ? 1 : 2; k < 3; k++)
        assert_true (within (first[k] - first[0], 2 * 0.3 * 0.5 * k / 0.7, 0.05));
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (a_ramp_ends_in_the_direct_solution),
        cmocka_unit_test (stages_go_around_a_loop),
        cmocka_unit_test (the_way_back_is_that_of_small_steps),
        cmocka_unit_test (growth_is_that_of_proportional_loads),
        cmocka_unit_test (a_gauge_ends_a_stage_between_changes),
        cmocka_unit_test (a_resumed_run_goes_on_bit_by_bit),
        cmocka_unit_test (units_and_threads_do_not_count),
        cmocka_unit_test (confinement_holds_wings_back),
    };
    return cmocka_run_group_tests (tests, NULL, NULL);
}
