/* SPDX-License-Identifier: GPL-3.0-or-later
 * Stages of loading: closed forms of a bar that is squeezed, pulled, unloaded and reloaded, by events and by
 * fixed steps; the same events as without stages where the path is the same; every condition that ends a
 * stage early; energies; resume in every stage; what is no such stage. */
#include "refused.h"
#include "scene_runs/run.h"
#include "tape.h"

/* Plane stress, E = 10 GPa, nu = 0.25: uniform under a pressure p on both long sides (jacket) and the pull s
 * of the right end (pull): u_x = x (s + nu p) / E, since sigma_yy = -p. */
#define BAR \
    "dimension: 2\nplane: stress\nthickness: 1 m\nbody: [{add: {box: {low: [0, 0], high: [1, 0.4]}}}]\n" \
    "spacing: 0.1\nmaterials: {m: {youngs_modulus: 10 GPa, poissons_ratio: 0.25}}\n" \
    "method: {integration: consistent}\nboundary:\n - {set: left, displacement: {x: 0}}\n" \
    " - {set: foot, displacement: {y: 0}, essential: penalty}\n" \
    " - {name: jacket, set: sides, pressure: 4 MPa}\n - {name: pull, set: right, traction: {x: 2 MPa}}\n" \
    "sets: {foot: {where: 'x < 1 mm and abs (y - 0.2) < 1 mm'}, sides: {boundary: [bottom, top]}}\n"
#define GAUGE "gauges: [{name: length, from: [0.1, 0.2], to: [0.9, 0.2]}]"

static double at_the_end (const run *r)
{
    int components;
    double *u = field_of (r, NULL, "displacement", &components), most = 0;
    for (size_t i = 0; i < r->problem->cloud.n; i++)
        if (r->problem->cloud.x[2 * i] > 1 - 1e-9) most = u[2 * i];
    pg_free (u);
    return most;
}

/* Four stages of a body in which nothing breaks: u at the end of each, work of the loads, why they ended. */
static void a_bar_follows_its_stages (void **state)
{
    (void) state;
    /* u_x of the right end is (s + nu p) / E, s and p as they are at the end of each stage */
    const double p[] = { 4e6, 4e6, 4e6, 0 }, s[] = { 0, 2e6, -1e6, 0 };
    for (int fixed = 0; fixed < 2; fixed++) {
        run r = scene_of (1,
                          BAR "stages:\n - {name: confine, boundary: {jacket: 1}}\n"
                              " - {name: stretch, boundary: {pull: 1}}\n - {name: squeeze, boundary: {pull: "
                              "-0.5}}\n - {name: free, boundary: {pull: 0, jacket: 0}}\n"
                              "solver: {stepping: %s, steps: 3}\noutput: {at: {levels: 2}, " GAUGE "}\n",
                          fixed ? "fixed" : "event");
        size_t n;
        long last = 0;
        while (!pg_solver_done (r.solver, r.state)) {
            advance (&r);
            const pg_stage_record *record = pg_solver_stages (r.solver, &n);
            int at = (int) r.step.stage - 1;
            assert_true (n == 4 && at >= 0 && at < 4 && r.step.stage >= last);
            last = r.step.stage;
            if (!record[at].done) continue;
            double u = (s[at] + 0.25 * p[at]) / 10e9;
            check_absolute (at_the_end (&r), u, 1e-9 * 4e-4);
            check_absolute (record[at].gauge[0], 0.8 * u, 1e-9 * 4e-4);
            check_absolute (r.state->factor, at + 1, 1e-12);
            check_relative (record[at].share, 1, 1e-12);
            assert_string_equal (record[at].why, "loads reached");
            /* energy (s^2 + p^2 + 2 nu s p) / (2 E) per volume, volume 0.4 m^3; nothing is lost */
            double energy = 0.4 * (s[at] * s[at] + p[at] * p[at] + 0.5 * s[at] * p[at]) / 20e9;
            check_absolute (record[at].strain, energy, 1e-8 * 500);
            check_absolute (record[at].external, energy, 1e-8 * 500);
        }
        assert_true (last == 4 && r.state->step == (fixed ? 12 : 9));
        clear (&r);
    }
}

/* The opening of a gauge ends a stage, from below and from above; what follows starts from there. */
static void a_gauge_ends_a_stage (void **state)
{
    (void) state;
    for (int fixed = 0; fixed < 2; fixed++) {
        run r = scene_of (1,
                        BAR "stages:\n - {name: up, boundary: {pull: 1}, until: {gauge: length, opening: 0.1 "
                           "mm}}\n - {name: down, boundary: {pull: -1}, until: {gauge: length, opening: 0.05 "
                              "mm}}\n - {name: hold}\n - {name: squeeze, boundary: {jacket: 1}}\n"
                              "solver: {stepping: %s, steps: 1000}\noutput: {at: {levels: 1}, " GAUGE "}\n",
                          fixed ? "fixed" : "event");
        size_t n;
        const pg_stage_record *record = pg_solver_stages (r.solver, &n);
        to_the_end (&r);
        /* 0.8 m x 2 MPa / E = 0.16 mm at full pull; down from 0.625 to -1: half-way is 0.3125 */
        double near = fixed ? 1.1e-3 : 1e-9;
        check_absolute (record[0].share, 0.1 / 0.16, near);
        check_absolute (record[1].share, 0.3125 / 1.625, 2 * near);
        assert_string_equal (record[0].why, "gauge");
        check_absolute (record[0].gauge[0], 0.1e-3, 0.2e-3 * near);
        check_absolute (record[1].gauge[0], 0.05e-3, 0.4e-3 * near);
        check_absolute (record[2].gauge[0], 0.05e-3, 0.4e-3 * near);
        /* the pull is still what the second stage left: 0.05 + 0.8 nu p / E */
        check_absolute (record[3].gauge[0], 0.05e-3 + 0.8 * 0.25 * 4e6 / 10e9, 0.4e-3 * near);
        clear (&r);
    }
}

/* The force that a drop is measured from is the largest of the stage, not of one before it. */
static void a_drop_of_force_is_one_within_the_stage (void **state)
{
    (void) state;
    run r = scene_of (1,
                      BAR "stages:\n - {name: pull, boundary: {pull: 1}, until: {load: pull, drop: 60 %%}}\n"
                          " - {name: back, boundary: {pull: 0.2}}\n - {name: confine, boundary: {jacket: 1}, "
                          "until: {load: pull, drop: 60 %%}}\n - {name: off, boundary: {pull: 0}, until: "
                          "{load: pull, drop: 60 %%}}\noutput: {at: {levels: 10}}\n");
    size_t n;
    const pg_stage_record *record = pg_solver_stages (r.solver, &n);
    to_the_end (&r);
    for (int k = 0; k < 3; k++) assert_true (record[k].done && record[k].share == 1);
    /* the first level at which no more than 0.4 of it is left */
    check_relative (record[3].share, 0.6, 1e-9);
    assert_string_equal (record[3].why, "drop of force");
    clear (&r);
}

/* Confined, then loaded along x until the first bond breaks: uniform stress, so that it does at the strength
 * of Mohr and Coulomb, s_1 = 2 c cos phi / (1 - sin phi) + s_3 (1 + sin phi) / (1 - sin phi); the stress
 * along z lies between both. */
static void the_strength_under_confinement_is_that_of_mohr_coulomb (void **state)
{
    (void) state;
    double sine = sin (atan (1) * 4 / 6), cosine = cos (atan (1) * 4 / 6);      /* phi = 30 degrees */
    for (int k = 0; k < 5; k++) {
        double confined = 2.5e6 * k, strength = 2 * 5e6 * cosine / (1 - sine)
                                                + confined * (1 + sine) / (1 - sine);
        run r = scene_of (
            1,
            "dimension: 2\nplane: strain\nthickness: 1 m\nbody: [{add: {box: {low: [0, 0], high: [1, "
            "0.4]}}}]\nspacing: 0.1\nmaterials: {m: {youngs_modulus: 10 GPa, poissons_ratio: 0.25}}\n"
            "failure: {criterion: mohr_coulomb, tensile_strength: 3 MPa, cohesion: 5 MPa, friction_angle: 30 "
            "deg}\nmethod: {integration: consistent}\nboundary:\n - {set: left, displacement: {x: 0}}\n"
            " - {set: foot, displacement: {y: 0}, essential: penalty}\n"
            " - {name: jacket, set: sides, pressure: %.17g Pa}\n - {name: cell, set: right, pressure: %.17g "
            "Pa}\n - {name: piston, set: right, pressure: 100 MPa}\n"
            "sets: {foot: {where: 'x < 1 mm and abs (y - 0.2) < 1 mm'}, sides: {boundary: [bottom, top]}}\n"
            "stages: [{name: confine, boundary: {jacket: 1, cell: 1}}, {name: load, boundary: {piston: 1}}]\n"
            "solver: {stepping: event, max_events: 1}\noutput: {at: {levels: 1}}\n",
            confined, confined);
        while (!r.step.event) advance (&r);
        check_relative ((r.state->factor - 1) * 100e6, strength - confined, 1e-8);
        assert_int_equal (r.step.stage, 2);
        clear (&r);
    }
}

/* ---- growing cracks ------------------------------------------------------------------------------------ */
#define PLATE \
    "dimension: 2\nplane: strain\nthickness: 1 mm\nbody: [{add: {box: {low: [0, 0], high: [20 mm, 20 " \
    "mm]}}}]\nspacing: 1 mm\nlattice_offset: [0, 0.5]\ncracks: [{from: [0, 10 mm], to: [6 mm, 10 mm]}]\n" \
    "materials: {rock: {youngs_modulus: 40 GPa, poissons_ratio: 0.25}}\n"
#define HELD " - {set: bottom, displacement: {x: 0, y: 0}}\n"
static const struct { const char *keys; int most;
} laws[] = {
    { "failure: {criterion: energy_release, fracture_energy: 20 J/m2}\n", 4 },
    { "failure: {criterion: principal_stress, tensile_strength: 20 MPa, exclude: [top, bottom]}\n", 12 },
    { "failure: {criterion: stretch, critical_stretch: 4e-4, exclude: [top, bottom]}\nmethod: {force: bond, "
      "horizon: 3 spacing}\n", 12 },
};
enum { LAWS = sizeof laws / sizeof *laws };

/* Confine, then pull: the events, one load factor later, are those of a pull under a constant confinement,
 * whose closed form test_affine.c has. */
static void confinement_and_a_ramp_is_an_affine_run (void **state)
{
    (void) state;
    for (int l = 0; l < LAWS; l++) {
        run a = scene_of (1,
                          PLATE "%sboundary:\n" HELD " - {set: top, displacement: {y: 20 um}}\n"
                                " - {set: right, pressure: 2 MPa, ramp: constant}\n"
                                "solver: {stepping: event, max_events: %d}\noutput: {at: {levels: 1}}\n",
                          laws[l].keys, laws[l].most),
            b = scene_of (1,
                          PLATE "%sboundary:\n" HELD " - {name: platen, set: top, displacement: {y: 20 um}}\n"
                                " - {name: jacket, set: right, pressure: 2 MPa}\n"
                                "stages: [{name: confine, boundary: {jacket: 1}}, {name: pull, boundary: "
                                "{platen: 1}}]\nsolver: {stepping: event, max_events: %d}\noutput: {at: "
                                "{levels: 1}}\n",
                          laws[l].keys, laws[l].most);
        advance (&a), advance (&b), advance (&b);
        assert_true (a.state->factor == 0 && b.state->factor == 1 && b.step.nbroken == 0);
        assert_int_equal (b.step.stage, 1);
        check_relative (pg_solver_report_now (b.solver)->energy.external,
                        pg_solver_report_now (a.solver)->energy.external, 1e-9);
        while (!pg_solver_done (a.solver, a.state)) {
            advance (&a), advance (&b);
            check_relative (b.state->factor - 1, a.state->factor, 1e-9);
            assert_true (a.step.nbroken == b.step.nbroken && a.step.nbroken > 0 && b.step.stage == 2);
            for (size_t k = 0; k < a.step.nbroken; k++)
                assert_int_equal (a.step.broken[k].bond, b.step.broken[k].bond);
            double other = pg_solver_report_now (a.solver)->energy.external;
            check_relative (pg_solver_report_now (b.solver)->energy.external, other, 1e-8);
            check_scaled (b.step.dissipated, a.step.dissipated, 1e-8, other);
        }
        clear (&a), clear (&b);
    }
}

/* Unloading to nothing brings the body back to where it was, and all work that is not stored was taken by the
 * crack; reloading does not grow it before the load at which it stopped. */
static void unloading_returns_to_the_origin (void **state)
{
    (void) state;
    for (int l = 0; l < LAWS; l++) {
        run r = scene_of (1,
                          PLATE "%sboundary:\n" HELD " - {name: platen, set: top, displacement: {y: 20 um}}\n"
                                "stages: [{name: pull, boundary: {platen: 1}, until: {events: 3}}, {name: "
                               "unload, boundary: {platen: 0}}, {name: reload, boundary: {platen: 1}, until: "
                                "{events: 1}}]\nsolver: {stepping: event}\noutput: {at: {levels: 1}}\n",
                          laws[l].keys);
        size_t n;
        double most = 0, stored = 0;
        const pg_stage_record *record = pg_solver_stages (r.solver, &n);
        while (!record[0].done) {
            advance (&r);
            most = fmax (most, largest_of (r.state->d, r.state->ndof));
            stored = fmax (stored, pg_solver_report_now (r.solver)->energy.strain);
        }
        assert_true (record[0].events >= 3 && r.state->events == record[0].events);
        assert_string_equal (record[0].why, "events");
        double reached = record[0].share, dissipated = record[0].dissipated;
        while (!record[1].done) advance (&r);
        check_below (largest_of (r.state->d, r.state->ndof), 1e-9 * most);
        check_below (fabs (record[1].strain), 1e-12 * stored);
        check_scaled (record[1].external, dissipated, 1e-9, stored);
        while (!record[2].done && r.state->events == record[0].events) advance (&r);
        assert_true (r.step.event && r.state->factor - 2 >= reached * (1 - 1e-9));
        to_the_end (&r);
        assert_true (record[2].events >= 1);
        clear (&r);
    }
}

/* A stage that ends with a crack at its limit is followed by one that changes no load: rounding alone, by
 * which that limit may be passed, drives nothing, whatever state the stage before has ended in. */
static void a_stage_without_new_loads_leaves_the_crack (void **state)
{
    (void) state;
    static const int drops[] = { 8, 12, 16, 20, 25, 30 };
    for (int l = 0; l < LAWS; l++)
        for (size_t c = longer () ? 0 : (size_t) l % 2; c < sizeof drops / sizeof *drops;
             c += longer () ? 1 : 2) {
            run r = scene_of (1,
                              PLATE "%sboundary:\n" HELD
                                    " - {name: platen, set: top, displacement: {y: 20 um}}\n"
                                    "stages: [{name: pull, boundary: {platen: 1}, until: {load: platen, "
                                    "drop: %d %%}}, {name: hold}]\nsolver: {stepping: event}\n"
                                    "output: {at: {levels: 3}}\n",
                              laws[l].keys, drops[c]);
            size_t n;
            const pg_stage_record *record = pg_solver_stages (r.solver, &n);
            while (!record[0].done) advance (&r);
            long events = r.state->events;
            double before = r.step.reaction[4], share = r.state->factor;
            assert_true (events > 0 && record[0].share < 1);
            to_the_end (&r);
            assert_int_equal (r.state->events, events);
            check_relative (r.step.reaction[4], before, 1e-9);
            assert_true (isfinite (r.state->factor) && r.state->factor >= share);
            clear (&r);
        }
}

/* Growth and a fall of force end a stage in a state that bears its load; the rest of the path is that of the
 * loads that were reached. */
static void growth_and_a_drop_of_force_end_a_stage (void **state)
{
    (void) state;
    static const char *const until[] = { "crack_length: 2.5 mm", "load: platen, drop: 25 %" };
    for (int c = 0; c < 2; c++) {
        run r = scene_of (1,
                          PLATE "%sboundary:\n" HELD " - {name: platen, set: top, displacement: {y: 20 um}}\n"
                                "stages: [{name: pull, boundary: {platen: 1}, until: {%s}}, {name: hold}]\n"
                                "solver: {stepping: event}\noutput: {at: {levels: 1}}\n",
                          laws[0].keys, until[c]);
        size_t n;
        double peak = 0, before = 0, now = 0;
        const pg_stage_record *record = pg_solver_stages (r.solver, &n);
        while (!record[0].done) {
            before = now;
            advance (&r);
            now = fabs (r.step.reaction[4]), peak = fmax (peak, now);
        }
        check_below (r.step.utilisation, 1 + 1e-9);
        assert_true (r.step.event == 0 && record[0].share < 1 && record[0].growth > 0);
        if (c == 0) check_relative (record[0].growth, 3e-3, 1e-9);
        else assert_true (now <= 0.75 * peak && before > 0.75 * peak);
        double factor = record[0].share;
        to_the_end (&r);
        check_relative (fabs (r.step.reaction[4]), now, 1e-9);
        /* the platen stays where it was, not where it was to go */
        int components;
        double *u = field_of (&r, NULL, "displacement", &components);
        check_relative (u[2 * (r.problem->cloud.n - 1) + 1], factor * 20e-6, 0.05);
        pg_free (u);
        clear (&r);
    }
}

/* A checkpoint in every step (short: in every third one and the last), in the middle of stages and between
 * them. Short: two of the laws by one kind of steps each. */
static void a_resumed_run_goes_on_bit_by_bit (void **state)
{
    (void) state;
    const int every = longer () ? 1 : 3;
    for (int l = 0; l < LAWS; l++)
        for (int fixed = 0; fixed < 2; fixed++) {
            if (!longer () && fixed == l - 1) continue;
            char text[2048];
            snprintf (text, sizeof text,
                      PLATE "%sboundary:\n" HELD " - {name: platen, set: top, displacement: {x: 0, y: %s}}\n"
                            " - {name: jacket, set: right, pressure: 2 MPa}\n"
                           "stages: [{name: confine, boundary: {jacket: 1}}, {name: pull, boundary: {platen: "
                            "1}, until: {events: 2}}, {name: back, boundary: {platen: 0.1}}]\n"
                            "solver: {stepping: %s, steps: 4}\noutput: {at: {levels: 2}}\n",
                      laws[l].keys, fixed ? "5 um" : "12 um", fixed ? "fixed" : "event");
            run a = prepare (1, text);
            int ended = 0;
            for (int step = 0; !ended; step++) {
                advance (&a);
                ended = pg_solver_done (a.solver, a.state);
                if (step % every != every - 1 && !ended) continue;
                run b = prepare (1, text), c = prepare (1, text);
                tape t = { 0 };
                keep (&a, &t, 0);
                keep (&b, &t, 1);
                for (int k = 0; k <= step; k++) advance (&c);
                if (!pg_solver_done (c.solver, c.state)) {
                    advance_alike (&c, &b);
                    assert_true (b.step.stage == c.step.stage);
                }
                size_t n;
            const pg_stage_record *one = pg_solver_stages (b.solver, &n), *other = pg_solver_stages (c.solver,
                                                                                                       &n);
                for (size_t k = 0; k < n; k++)
                    assert_true (one[k].done == other[k].done && one[k].share == other[k].share
                                 && one[k].external == other[k].external);
                pg_free (t.byte);
                clear (&b), clear (&c);
            }
            clear (&a);
        }
}

/* ---- excavation ---------------------------------------------------------------------------------------- */
#define ROCK \
    "dimension: 2\nplane: strain\nthickness: 1 m\nbody: [{add: {box: {low: [-4, -4], high: [4, 4]}}}]\n" \
    "spacing: 0.5\nmaterials: {m: {youngs_modulus: 10 GPa, poissons_ratio: 0.25, density: 2500 kg/m3}}\n" \
    "sets: {tunnel: {where: 'r < 1.1'}}\noutput: {at: {levels: 2}, gauges: [{name: convergence, from: [0, " \
    "-2.5], to: [0, 2.5]}]}\nboundary:\n - {set: bottom, displacement: {x: 0, y: 0}}\n" \
    " - {name: top, set: top, traction: {y: -8 MPa, x: 1 MPa}}\n - {name: side, set: right, pressure: 3 " \
    "MPa}\n"
static const struct { const char *keys; double near;
} kinds[] = {
    { "", 1e-9 },
    { "method: {integration: consistent}\n", 1e-9 },
    { "method: {essential: transformation}\n", 1e-9 },
    { "method: {force: bond, horizon: 3 spacing}\n", 1e-8 },
    { "method: {force: lps, horizon: 3 spacing}\n", 1e-8 },
};

/* Loaded and then excavated, half-way and in the end, beside excavated and then loaded: the body is linear,
 * so that the end is the same, and half-way there is half-way in all. What is removed bears nothing. */
static void excavation_ends_where_a_body_with_the_hole_is (void **state)
{
    (void) state;
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++)
        for (int fixed = 0; fixed < 2; fixed++) {
            const char *stepping = fixed ? "fixed" : "event";
            run a = scene_of (1,
                              ROCK "stages: [{name: load, boundary: {top: 1, side: 1}}, {name: excavate, "
                                   "remove: tunnel}, {name: hold}]\n%ssolver: {stepping: %s, steps: 2}\n",
                              kinds[k].keys, stepping),
                b = scene_of (1,
                              ROCK "stages: [{name: excavate, remove: tunnel}, {name: load, boundary: {top: "
                                   "1, side: 1}}]\n%ssolver: {stepping: %s, steps: 2}\n",
                              kinds[k].keys, stepping);
            size_t n;
            const pg_stage_record *one = pg_solver_stages (a.solver, &n);
            const pg_stage_record *other = pg_solver_stages (b.solver, &n);
            double half = NAN;
            while (!pg_solver_done (a.solver, a.state)) {
                advance (&a);
                if (fabs (a.state->factor - 1.5) < 1e-9) {
                    void *self;
                    double u[2][3];
                    const pg_force_type *force = pg_solver_force (a.solver, &self);
                    for (int end = 0; end < 2; end++)
                        check_ok (force->sample (self, a.state, a.state->d, 1,
                                                 end ? a.problem->boundary.gauge->to
                                                     : a.problem->boundary.gauge->from,
                                                 u[end], NULL, NULL));
                    half = u[1][1] - u[0][1];
                }
            }
            to_the_end (&b);
            double size = fabs (other[1].gauge[0]);
            /* the hole makes a difference, and no force of it is left */
            assert_true (fabs (one[1].gauge[0] - one[0].gauge[0]) > 0.1 * size);
            check_scaled (one[1].gauge[0], other[1].gauge[0], kinds[k].near, size);
            check_scaled (one[2].gauge[0], other[1].gauge[0], kinds[k].near, size);
            check_scaled (half, 0.5 * (one[0].gauge[0] + one[1].gauge[0]), kinds[k].near, size);
            check_scaled (one[1].strain, other[1].strain, 1e-7, other[1].strain);
            /* the rest of the loads' work was stored in the hole, or given back by its edge: positive */
            assert_true (one[1].dissipated > 0 && fabs (other[1].dissipated) < 1e-8 * other[1].strain);
            assert_true (a.state->broken == 0 && pg_solver_report_now (a.solver)->energy.dissipated > 0);
            int components;
            double *stress = field_of (&a, NULL, "stress", &components);
            const pg_set *tunnel = a.problem->boundary.stage[1].remove;
            for (size_t i = 0; i < tunnel->npoint; i++)
                for (int c = 0; c < components; c++)
                    assert_true (stress[(size_t) tunnel->point[i] * (size_t) components + (size_t) c] == 0);
            pg_free (stress);
            clear (&a), clear (&b);
        }
}

/* A checkpoint before, within and after an excavation. */
static void a_resumed_excavation_goes_on_bit_by_bit (void **state)
{
    (void) state;
    for (int fixed = 0; fixed < 2; fixed++) {
        char text[2048];
        snprintf (text, sizeof text,
                ROCK "failure: {criterion: principal_stress, tensile_strength: 1 MPa}\nstages: [{name: load, "
                       "boundary: {top: 0.1, side: 0.1}}, {name: excavate, remove: tunnel}, {name: more, "
                       "boundary: {top: 0.2}}]\nsolver: {stepping: %s, steps: 3, max_events: 30}\n",
                  fixed ? "fixed" : "event");
        run a = prepare (1, text);
        for (int step = 0; step < (fixed ? 8 : 7); step++) {
            run b = prepare (1, text), c = prepare (1, text);
            tape t = { 0 };
            advance (&a);
            keep (&a, &t, 0), keep (&b, &t, 1);
            for (int k = 0; k <= step; k++) advance (&c);
            for (int k = 0; k < 2 && !pg_solver_done (c.solver, c.state); k++) advance_alike (&c, &b);
            pg_free (t.byte);
            clear (&b), clear (&c);
        }
        clear (&a);
    }
}

/* ---- what is no such stage ----------------------------------------------------------------------------- */
static void wrong_stages_are_faults (void **state)
{
    (void) state;
    static const struct { const char *load, *stages, *solver, *message;
    } cases[] = {
        { "", "{name: a, boundary: {pul: 1}}", "", "no entry of boundary has this name; there are" },
        { "", "{name: a, boundary: {pull: 1}}, {name: a}", "", "stages[0] has this name too" },
        { "", "{name: a}", "", "no stage names this load (pull), so that it would never act" },
        { ", ramp: t^2", "{name: a, boundary: {pull: 1}}", "", "the stages say how loads grow" },
        { ", table: [[0, 0], [1, 1]]", "{name: a, boundary: {pull: 1}}", "",
          "the stages say how loads grow" },
        { ", ramp: constant", "{name: a, boundary: {pull: 1}}", "", "has ramp: constant" },
        { "", "{name: a, boundary: {pull: 1}, until: {gauge: no, opening: 1 mm}}", "",
          "there is no entry of output.gauges of this name" },
        { "", "{name: a, boundary: {pull: 1}, until: {opening: 1 mm}}", "", "goes with until.gauge" },
        { "", "{name: a, boundary: {pull: 1}, until: {load: pull}}", "", "goes with until.drop" },
        { "", "{name: a, boundary: {pull: 1}, until: {crack_length: 1 mm}}", "",
          "is for cracks that grow by facets" },
        { "", "{name: a, boundary: {pull: 1}}, {name: b, remove: left}", "",
          "shares points with the load" },
        { "", "{name: a, boundary: {pull: 1}}, {name: b, remove: top, until: {events: 1}}", "",
          "what is removed goes wholly" },
        { "", "{name: a, boundary: {pull: 1}}", "solver: {kind: newmark, dt: 1 us, end: 1 ms}\n",
          "does not know stages of loading so far" },
        { "", "{name: a, boundary: {pull: 1}}", "solver: {kind: adr}\n",
          "does not know stages of loading so far" },
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        char text[2048];
        snprintf (text, sizeof text,
                "dimension: 2\nthickness: 1 m\nbody: [{add: {box: {low: [0, 0], high: [1, 0.4]}}}]\nspacing: "
                  "0.1\nmaterials: {m: {youngs_modulus: 10 GPa, poissons_ratio: 0.25, density: 2500 kg/m3}}\n"
                  "boundary:\n - {set: left, displacement: {x: 0, y: 0}}\n - {name: pull, set: right, "
                  "traction: {x: 2 MPa}%s}\nstages: [%s]\n%s",
                  cases[k].load, cases[k].stages, cases[k].solver);
        check_refused (text, cases[k].message);
    }
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (a_bar_follows_its_stages),
        cmocka_unit_test (a_gauge_ends_a_stage),
        cmocka_unit_test (a_drop_of_force_is_one_within_the_stage),
        cmocka_unit_test (the_strength_under_confinement_is_that_of_mohr_coulomb),
        cmocka_unit_test (confinement_and_a_ramp_is_an_affine_run),
        cmocka_unit_test (unloading_returns_to_the_origin),
        cmocka_unit_test (growth_and_a_drop_of_force_end_a_stage),
        cmocka_unit_test (a_stage_without_new_loads_leaves_the_crack),
        cmocka_unit_test (a_resumed_run_goes_on_bit_by_bit),
        cmocka_unit_test (excavation_ends_where_a_body_with_the_hole_is),
        cmocka_unit_test (a_resumed_excavation_goes_on_bit_by_bit),
        cmocka_unit_test (wrong_stages_are_faults),
    };
    return cmocka_run_group_tests_name ("solve/stages", tests, NULL, NULL);
}
