/* SPDX-License-Identifier: GPL-3.0-or-later
 * Cracks that grow by facets: load, path and energies of a clamped strip, whose energy release rate is
 * known in closed form (2 E U^2 / ((1 - nu^2) H) under an opening 2 U, far from both ends); kinks of
 * inclined cracks; loads with a constant part; energies of place and direction; imposed paths; cracks
 * that meet the surface and each other; fixed load steps; what is refused. */
#include <string.h>
#include "refused.h"
#include "run.h"
#include "solve/tape.h"
#include <math.h>

/* A strip 5 high and 1 long, n cells high, its crack 2 long and shifted against the points by part of a
 * spacing; G = 22500 J/m^2 at an opening of 2 mm, so that 100 J/m^2 are reached at 1/15 of it. */
#define STRIP \
    "dimension: 2\nplane: stress\nthickness: 1 m\nbody: [{add: {box: {low: [0, -0.5], high: [5, 0.5]}}}]\n" \
    "spacing: %.17g\nlattice: cells\ncracks: [{from: [-0.2, %.17g], to: [%.17g, %.17g]}]\n" \
    "materials: {m: {youngs_modulus: 10 GPa, poissons_ratio: 0.3333333333333333}}\n" \
    "failure: {%s}\nboundary:\n%ssolver: {kind: static%s}\noutput: {at: {levels: 1}}\nmethod: {%s}\n"
#define PULL \
    "  - {name: top, set: top, displacement: {x: 0, y: 1 mm}}\n" \
    "  - {name: bottom, set: bottom, displacement: {x: 0, y: -1 mm}}\n"
#define G0 "fracture_energy: 100 J/m2"

static run strip (int n, double dx, double dy, const char *failure, const char *boundary, const char *solver,
                  const char *method)
{
    double h = 1.0 / n, y = dy * h;
    return scene_of (1, STRIP, h, y, 2 + dx * h, y, failure, boundary, solver, method);
}

/* At most `most` steps that ended in an event; the sum of what they say. */
typedef struct { long events; double mean, low, high, dissipated, least; } course;

static course follow (run *r, double reference, long most)
{
    course c = { 0, 0, INFINITY, 0, 0, INFINITY };
    while (!pg_solver_done (r->solver, r->state) && c.events < most) {
        advance (r);
        c.least = fmin (c.least, r->step.dissipated);
        c.dissipated += r->step.dissipated;
        if (!r->step.event) continue;
        double share = r->state->factor / reference;
        c.events++, c.mean += share, c.low = fmin (c.low, share), c.high = fmax (c.high, share);
        for (size_t i = 0; i < r->step.nbroken; i++) assert_true (r->step.broken[i].kind == 'f');
    }
    c.mean /= (double) c.events;
    return c;
}

static const pg_tip *tip_of (const run *r, size_t i) { return &r->state->paths->tip[i]; }

/* Energies of the report balance, and what was dissipated is what the new area takes. */
static void check_energies (const run *r, const course *c, double tolerance)
{
    const pg_statistics *s = pg_solver_report_now (r->solver);
    check_relative (s->energy.external, s->energy.strain + s->energy.dissipated, 1e-10);
    check_relative (s->energy.dissipated, c->dissipated, 1e-9);
    check_relative (s->energy.dissipated, s->energy.fracture, tolerance);
    assert_true (c->least >= -1e-9 * s->energy.external);
}

static void a_strip_breaks_at_its_load_on_any_lattice (void **state)
{
    (void) state;
    static const struct { double dx, dy; const char *method; } lattices[] = {
        { 0, 0, "horizon: 2.01 spacing" },        { 0.37, 0.21, "" },
        { 0.37, 0.4, "integration: consistent" }, { 0.1, -0.45, "basis: quadratic, horizon: 3 spacing" },
    };
    for (size_t k = 0; k < sizeof lattices / sizeof *lattices; k++) {
        run r = strip (15, lattices[k].dx, lattices[k].dy, G0, PULL, "", lattices[k].method);
        assert_true (r.options.break_mode == PG_BREAK_FACET && r.options.event);       /* the defaults */
        course c = follow (&r, 1.0 / 15, 12);
        const pg_tip *tip = tip_of (&r, 0);
        print_message ("%zu: mean %.4f, single %.4f to %.4f, path off by %.3f h\n", k, c.mean, c.low, c.high,
                       15 * tip->x[1] - lattices[k].dy);
        check_relative (c.mean, 1, 0.005);
        check_below (fmax (c.high - 1, 1 - c.low), 0.02);
        check_below (fabs (15 * tip->x[1] - lattices[k].dy), 0.2);
        check_relative (tip->grown, 12 / 15.0, 1e-3);
        check_energies (&r, &c, 0.03);
        /* what was measured before the last facet: the limit was reached there */
        const pg_tip_values *v = pg_solver_tip (r.solver, tip->id);
        assert_non_null (v);
        check_relative (v->utilisation, 1, 1e-9);
        check_relative (v->J, 100, 0.01);
        check_below (fabs (v->K[1]), 0.05 * v->K[0]);
        clear (&r);
    }
}

static void the_length_of_a_facet_does_not_matter (void **state)
{
    (void) state;
    for (int k = 0; k < 2; k++) {
        run r = strip (15, 0.37, 0.21, G0, PULL, k ? ", facet: 2 spacing" : ", facet: 0.5 spacing", "");
        course c = follow (&r, 1.0 / 15, 6);
        check_relative (c.mean, 1, 0.01);
        check_relative (tip_of (&r, 0)->grown, 6 * (k ? 2 : 0.5) / 15, 1e-3);
        check_energies (&r, &c, 0.04);
        clear (&r);
    }
}

/* A constant part of the opening takes that much of the growing one, in either direction. */
static void constant_loads_count (void **state)
{
    (void) state;
    static const double constant[] = { 0.05, -0.2, 0.066 };
    for (size_t k = 0; k < sizeof constant / sizeof *constant; k++) {
        char boundary[400];
        snprintf (boundary, sizeof boundary,
                  "  - {name: top, set: top, displacement: {x: 0, y: %.17g + 2e-4 * t}, ramp: constant}\n"
                  "  - {name: bottom, set: bottom, displacement: {x: 0, y: -(%.17g + 2e-4 * t)}, ramp: "
                  "constant}\n",
                  1e-3 * constant[k], 1e-3 * constant[k]);
        run r = strip (15, 0.37, 0.21, G0, boundary, "", "");
        assert_true (r.options.event);                 /* without being asked for */
        double expected = (1.0 / 15 - constant[k]) / 0.2, dissipated = 0;
        int events = 0;
        while (events < (longer () ? 5 : 3)) {
            advance (&r);
            dissipated += r.step.dissipated;
            if (!r.step.event) continue;
            events++;
            check_absolute (r.state->factor, expected, 0.01 / 15 / 0.2);
            check_relative (r.step.utilisation, 1, 1e-9);
        }
        const pg_statistics *s = pg_solver_report_now (r.solver);
        check_relative (s->energy.external, s->energy.strain + s->energy.dissipated, 1e-10);
        check_relative (s->energy.dissipated, dissipated, 1e-9);
        check_relative (s->energy.dissipated, s->energy.fracture, 0.03);
        clear (&r);
    }
}

/* Load factor at which the largest hoop stress of K_0 + lambda K_1 reaches K_c, by trying. */
static double load_of (const double *K0, const double *K1, double Kc)
{
    double low = 0, high = 10;
    for (int k = 0; k < 60; k++) {
        double at = 0.5 * (low + high), top = 0;
        for (int i = -900; i <= 900; i++) {
            double t = i * 1e-3, c = cos (t / 2), one = K0[0] + at * K1[0], two = K0[1] + at * K1[1];
            top = fmax (top, c * (one * c * c - 1.5 * two * sin (t)));
        }
        if (top < Kc) low = at;
        else high = at;
    }
    return low;
}

/* An inclined crack under a constant pressure all around and a growing tension: K_I and K_II of the two parts
 * by themselves, each from a run of its own under tension, say when it grows. */
static void confinement_adds_to_a_growing_load (void **state)
{
    (void) state;
    static const char *const load[] = {
        "{name: t, set: top, traction: {y: 10 MPa}}, {name: b, set: bottom, traction: {y: -10 MPa}}",
        "{set: left, pressure: -0.1 MPa}, {set: right, pressure: -0.1 MPa}, {set: top, pressure: -0.1 MPa}, "
        "{set: "
        "bottom, pressure: -0.1 MPa}",
        "{name: t, set: top, traction: {y: 10 MPa}}, {name: b, set: bottom, traction: {y: -10 MPa}}, {set: "
        "left, "
        "pressure: 0.1 MPa, ramp: constant}, {set: right, pressure: 0.1 MPa, ramp: constant}, {set: top, "
        "pressure: 0.1 "
        "MPa, ramp: constant}, {set: bottom, pressure: 0.1 MPa, ramp: constant}",
    };
    double K[2][2], Kc = sqrt (100 * 10e9);
    for (int k = 0; k < 3; k++) {
        run r = scene_of (
            1,
            "dimension: 2\nplane: stress\nthickness: 1 m\nbody: [{add: {box: {low: [-1, -1], high: [1, "
            "1]}}}]\n"
            "spacing: 0.05\nlattice: cells\ncracks: [{from: [-1.2, -0.613], to: [0.013, 0.007]}]\n"
            "materials: {m: {youngs_modulus: 10 GPa, poissons_ratio: 0.25}}\nfailure: {fracture_energy: "
            "%s}\n"
            "sets: {pin: {where: x > 0.94 and abs (y) < 0.06}}\nboundary: [%s, {name: pin, set: pin, "
            "displacement: {x: 0, y: 0}, essential: penalty}]\nsolver: {kind: static, max_events: 1}\n"
            "output: {at: {levels: 1}}\n",
            k < 2 ? "1e6 J/m2" : "100 J/m2", load[k]);
        to_the_end (&r);
        const pg_tip_values *v = pg_solver_tip (r.solver, 1);
        if (k < 2) {
            assert_true (r.state->factor == 1);
            K[k][0] = v->K[0], K[k][1] = v->K[1];
        } else {
            double none[2] = { 0, 0 }, all[2] = { -K[1][0], -K[1][1] }, first = load_of (all, K[0], Kc);
            print_message ("lambda %.5f, expected %.5f, without the pressure %.5f\n", r.state->factor, first,
                           load_of (none, K[0], Kc));
            assert_true (r.step.event);
            check_relative (r.state->factor, first, 0.02);
            assert_true (first > 1.2 * load_of (none, K[0], Kc));
        }
        clear (&r);
    }
}

/* Alone it is more than the crack bears: it runs at a held factor. */
static void a_constant_load_may_drive_the_crack (void **state)
{
    (void) state;
    run r = strip (
        15, 0.37, 0.21, G0,
        "  - {name: top, set: top, displacement: {x: 0, y: 0.07e-3 * (1 + t)}, ramp: constant}\n"
        "  - {name: bottom, set: bottom, displacement: {x: 0, y: -0.07e-3 * (1 + t)}, ramp: constant}\n",
        "", "");
    for (int k = 0; k < 3; k++) {
        advance (&r);
        assert_true (r.step.event && r.state->factor == 0);
    }
    const pg_statistics *s = pg_solver_report_now (r.solver);
    assert_true (s->nwarning > 0);
    check_contains (s->warning[s->nwarning - 1], "the constant loads drive the crack");
    clear (&r);
}

/* G0 (x) = 100 x / 2 m: the load follows it. */
static void the_energy_may_change_from_place_to_place (void **state)
{
    (void) state;
    run r = strip (15, 0.37, 0.21, "fracture_energy: 100 J/m2 * x / 2 m", PULL, "", "");
    for (int k = 0; k < 10; k++) {
        double x = tip_of (&r, 0)->x[0] + 0.5 / 15;
        advance (&r);
        check_relative (r.state->factor, sqrt (100 * x / 2 / 22500), 0.01);
    }
    check_below (fabs (15 * tip_of (&r, 0)->x[1] - 0.21), 0.2);
    clear (&r);
}

/* Less energy upwards: the crack turns to where cos^6 (t/2) / G0 (t) is the largest, 68.25 degrees here. */
static void the_energy_may_depend_on_the_direction (void **state)
{
    (void) state;
    run r = strip (15, 0.37, 0.21, "fracture_energy: 100 J/m2 * (1 - 0.9 * sin (angle))", PULL, "", "");
    double x[2] = { tip_of (&r, 0)->x[0], tip_of (&r, 0)->x[1] };
    advance (&r);
    const double *to = tip_of (&r, 0)->x;
    check_absolute (atan2 (to[1] - x[1], to[0] - x[0]) * 180 / acos (-1), 68.245, 1.5);
    check_relative (r.state->factor, 0.047602, 0.015);
    clear (&r);
}

/* The harder of two materials takes its own energy, and one that never breaks stops the crack. */
static void the_material_at_the_tip_decides (void **state)
{
    (void) state;
    for (int never = 0; never < 2; never++) {
        run r = scene_of (
            1,
            "dimension: 2\nplane: stress\nthickness: 1 m\nbody: [{add: {box: {low: [0, -0.5], high: [5, "
            "0.5]}}}]\n"
            "spacing: 0.06666666666666667\nlattice: cells\ncracks: [{from: [-0.2, 0.01], to: [2.02, "
            "0.01]}]\n"
            "materials:\n  m: {youngs_modulus: 10 GPa, poissons_ratio: 0.3333333333333333}\n"
            "  hard: {youngs_modulus: 10 GPa, poissons_ratio: 0.3333333333333333, failure: {%s}}\n"
            "blocks: [{material: hard, where: x > 2.3}, {material: m, where: x <= 2.3}]\nfailure: {" G0
            "}\nboundary:\n" PULL "solver: {kind: static}\noutput: {at: {levels: 1}}\n",
            never ? "never: on" : "fracture_energy: 400 J/m2");
        long soft = 0, hard = 0;
        while (!pg_solver_done (r.solver, r.state) && hard < 3) {
            advance (&r);
            if (!r.step.event) continue;
            if (fabs (15 * r.state->factor - 1) < 0.02) soft++;
            else if (fabs (15 * r.state->factor - 2) < 0.04) hard++;
        }
        assert_true (soft >= 3 && soft <= 5 && (never ? hard == 0 : hard == 3));
        check_below (fabs (tip_of (&r, 0)->x[1] - 0.01), 0.3 / 15);
        clear (&r);
    }
}

/* A bent path, and one below which the tip does not lie. */
static void a_crack_can_be_held_to_a_path (void **state)
{
    (void) state;
    run r = strip (15, 0.37, 0, G0 ", path: [[0, 0], [2.2, 0], [4, 0.4]]", PULL, "", "");
    follow (&r, 1, 12);
    const double *x = tip_of (&r, 0)->x;
    check_absolute (x[1], (x[0] - 2.2) * 0.4 / 1.8, 1e-12);
    check_relative (tip_of (&r, 0)->grown, 12 / 15.0, 0.01);
    clear (&r);
}

/* The angle of the first facet, of cracks inclined to the load by 60, 45 and 30 degrees (largest hoop
 * stress: -43.2, -53.1, -60.0 degrees). */
static void inclined_cracks_kink (void **state)
{
    (void) state;
    static const double kink[] = { 43.2, 53.1, 60.0 };
    for (int k = 0; k < 3; k++) {
        double b = (30 + 15 * k) * acos (-1) / 180, c = 0.3 * cos (b), s = 0.3 * sin (b);
        run r = scene_of (
            1,
            "dimension: 2\nplane: stress\nthickness: 1 m\nbody: [{add: {box: {low: [-1, -1], high: [1, "
            "1]}}}]\n"
            "spacing: 0.05\nlattice: cells\ncracks: [{from: [%.17g, %.17g], to: [%.17g, %.17g]}]\n"
            "materials: {m: {youngs_modulus: 10 GPa, poissons_ratio: 0.3333333333333333}}\nfailure: {" G0
            "}\n"
            "sets: {pin: {where: x > 0.94 and abs (y) < 0.06}}\nboundary:\n"
            "  - {name: top, set: top, traction: {y: 10 MPa}}\n  - {name: bottom, set: bottom, traction: "
            "{y: -10 MPa}}\n"
            "  - {name: pin, set: pin, displacement: {x: 0, y: 0}, essential: penalty}\n"
            "solver: {kind: static}\noutput: {at: {levels: 1}}\n",
            0.013 - c, 0.007 - s, 0.013 + c, 0.007 + s);
        double from[2][2];
        for (size_t i = 0; i < 2; i++) memcpy (from[i], tip_of (&r, i)->x, sizeof from[i]);
        advance (&r);
        assert_int_equal (r.state->paths->ntip, 2);
        for (size_t i = 0; i < 2; i++) {
            const pg_tip *tip = tip_of (&r, i);
            double along = from[i][0] > 0 ? b : b + acos (-1);
            if (!(tip->grown > 0)) continue;           /* off the lattice they need not tie */
            double turn = atan2 (tip->x[1] - from[i][1], tip->x[0] - from[i][0]) - along;
            turn = fabs (remainder (turn, 2 * acos (-1))) * 180 / acos (-1);
            print_message ("%d degrees, tip %zu: %.2f\n", 30 + 15 * k, i, turn);
            check_absolute (turn, kink[k], 3);
        }
        clear (&r);
    }
}

/* Through the body: its energy is that of the ligament, all of it; nothing is left to carry. */
static void a_crack_runs_through (void **state)
{
    (void) state;
    run r = strip (15, 0.37, 0.21, G0, PULL, ", stop: {stiffness: 0.01}", "");
    course c = follow (&r, 1.0 / 15, 1000);
    const pg_statistics *s = pg_solver_report_now (r.solver);
    assert_true (!tip_of (&r, 0)->open);
    check_absolute (tip_of (&r, 0)->x[0], 5, 1e-6);
    check_contains (s->warning[s->nwarning - 1], "the body has separated");
    check_relative (s->energy.fracture, 100 * (3 - 0.37 / 15), 2e-3);
    check_energies (&r, &c, 0.02);
    check_below (s->energy.strain, 1e-3);
    clear (&r);
}

/* Two cracks on two lines run towards each other and meet: no tip is left. */
static void cracks_meet (void **state)
{
    (void) state;
    run r = scene_of (1, "dimension: 2\nplane: stress\nthickness: 1 m\nbody: [{add: {box: {low: [-1, -0.5], "
                         "high: [1, 0.5]}}}]\n"
                         "spacing: 0.06666666666666667\nlattice: cells\ncracks: [{from: [-2, 0.01], to: "
                         "[-0.3, 0.01]}, {from: [0.3, "
                         "0.03], to: [2, 0.03]}]\nmaterials: {m: {youngs_modulus: 10 GPa, poissons_ratio: "
                         "0.3333333333333333}}\n"
                         "failure: {" G0 "}\nboundary:\n" PULL
                         "solver: {kind: static}\noutput: {at: {levels: 1}}\n");
    course c = follow (&r, 1, 100);
    assert_true (!tip_of (&r, 0)->open && !tip_of (&r, 1)->open);
    double grown = tip_of (&r, 0)->grown + tip_of (&r, 1)->grown;
    check_relative (grown, 0.6, 0.05);
    check_energies (&r, &c, 0.05);
    clear (&r);
}

/* At fixed loads: after every step no tip is over its limit. Under dead loads below it nothing happens. */
static void fixed_steps_grow_until_all_tips_rest (void **state)
{
    (void) state;
    run r = scene_of (
        1,
        "dimension: 2\nplane: stress\nthickness: 1 m\nbody: [{add: {box: {low: [0, -0.5], high: [2, "
        "0.5]}}}]\n"
        "spacing: 0.06666666666666667\nlattice: cells\ncracks: [{from: [-0.2, 0.01], to: [0.62, 0.01]}]\n"
        "materials: {m: {youngs_modulus: 10 GPa, poissons_ratio: 0.3333333333333333}}\nfailure: {" G0 "}\n"
        "sets: {up: {where: x < 0.07 and y > 0.43}, down: {where: x < 0.07 and y < -0.43}}\nboundary:\n"
        "  - {name: up, set: up, displacement: {x: 0, y: 1 mm}}\n  - {name: down, set: down, displacement: "
        "{x: 0, y: -1 "
        "mm}}\nsolver: {kind: static, stepping: fixed, steps: 6}\noutput: {at: {levels: 1}}\n");
    double grown = 0;
    for (int k = 0; k < 6; k++) {
        advance (&r);
        assert_true (r.step.utilisation <= 1);
        assert_true (r.step.nbroken > 0 ? tip_of (&r, 0)->grown > grown : tip_of (&r, 0)->grown == grown);
        grown = tip_of (&r, 0)->grown;
    }
    const pg_statistics *s = pg_solver_report_now (r.solver);
    assert_true (grown > 0.2 && tip_of (&r, 0)->open);
    /* the load was over the limit at first */
    assert_true (s->energy.dissipated > s->energy.fracture);
    clear (&r);
}

/* Mode I under compression: said, and nothing grows. */
static void a_crack_that_closes_is_said_to (void **state)
{
    (void) state;
    run r = strip (15, 0.37, 0.21, G0,
                   "  - {name: top, set: top, displacement: {x: 0, y: -1 mm}}\n"
                   "  - {name: bottom, set: bottom, displacement: {x: 0, y: 1 mm}}\n", "", "");
    to_the_end (&r);
    const pg_statistics *s = pg_solver_report_now (r.solver);
    size_t found = 0;
    for (size_t k = 0; k < s->nwarning; k++)
        found += strstr (s->warning[k], "contact is not modelled") != NULL;
    assert_true (found && r.state->events == 0 && r.state->factor == 1);
    clear (&r);
}

/* The same K as tension on the whole outside, also after the crack has grown: new faces are pressed on
 * too. The stress along the crack differs by the pressure. The work is that of the volume which opens. */
static void pressure_in_cracks_is_tension_outside (void **state)
{
    (void) state;
    static const char *const load[] = {
        "{set: cracks, pressure: 5 MPa}",
        "{set: left, pressure: -5 MPa}, {set: right, pressure: -5 MPa}, {set: top, "
        "pressure: -5 MPa}, {set: bottom, pressure: -5 MPa}"
    };
    for (int strain = 0; strain < 2; strain++) {
        run r[2];
        for (int k = 0; k < 2; k++)
            r[k] = scene_of (
                1,
                "dimension: 2\nplane: %s\nthickness: 1 m\nbody: [{add: {box: {low: [-1, -1], high: [1, "
                "1]}}}]\n"
                "spacing: 0.05\nlattice: cells\ncracks: [{from: [-1.2, 0.007], to: [0.013, 0.007]}]\n"
                "materials: {m: {youngs_modulus: 10 GPa, poissons_ratio: 0.25}}\nfailure: {" G0 "}\n"
                "sets: {pin: {where: x > 0.94 and abs (y) < 0.06}}\nboundary: [%s, {name: pin, set: pin, "
                "displacement: {x: 0, y: 0}, essential: penalty}]\nsolver: {kind: static, max_events: 4}\n"
                "output: {at: {levels: 1}}\n",
                strain ? "strain" : "stress", load[k]);
        for (int event = 0; event < (longer () ? 4 : 2); event++) {
            for (int k = 0; k < 2; k++) advance (&r[k]);
            const pg_tip_values *in = pg_solver_tip (r[0].solver, 1), *out = pg_solver_tip (r[1].solver, 1);
            check_relative (r[0].state->factor, r[1].state->factor, 2e-3);
            check_relative (in->K[0], out->K[0], 1e-3);
            check_absolute ((in->T - out->T) / (5e6 * r[0].state->factor), -1, 0.03);
        }
        for (int k = 0; k < 2; k++) {
            const pg_statistics *s = pg_solver_report_now (r[k].solver);
            check_relative (s->energy.external, s->energy.strain + s->energy.dissipated, 1e-10);
            check_relative (s->energy.dissipated, s->energy.fracture, 0.04);
            clear (&r[k]);
        }
    }
}

/* In the middle of a run with loads of both kinds and a crack at either end. */
static void a_resumed_run_goes_on_bit_by_bit (void **state)
{
    (void) state;
    static const char *const boundary[] = {
        PULL, "  - {name: top, set: top, displacement: {x: 0, y: 2e-5 + 1e-4 * t}, ramp: constant}\n"
              "  - {name: bottom, set: bottom, displacement: {x: 0, y: 0}}\n"
    };
    for (int k = 0; k < 3; k++) {
        const char *method = k == 2 ? "integration: consistent" : "";
        run a = strip (15, 0.37, 0.21, G0, boundary[k % 2], ", max_events: 9", method),
            b = strip (15, 0.37, 0.21, G0, boundary[k % 2], ", max_events: 9", method);
        tape t = { 0 };
        for (int step = 0; step < 4; step++) advance (&a);
        keep (&a, &t, 0);
        keep (&b, &t, 1);
        for (int step = 0; step < (longer () ? 9 : 3) && !pg_solver_done (a.solver, a.state); step++) {
            advance_alike (&a, &b);
            assert_memory_equal (tip_of (&a, 0)->x, tip_of (&b, 0)->x, sizeof tip_of (&a, 0)->x);
        }
        assert_true (pg_solver_report_now (a.solver)->energy.fracture
                     == pg_solver_report_now (b.solver)->energy.fracture);
        pg_free (t.byte);
        clear (&a), clear (&b);
    }
}

/* A centre crack on a lattice that mirrors it, held so that neither end is favoured: both tips go
 * together. */
static void tips_that_tie_grow_together (void **state)
{
    (void) state;
    run r = scene_of (1, "dimension: 2\nplane: stress\nthickness: 1 m\nbody: [{add: {box: {low: [-1, -0.5], "
                         "high: [1, 0.5]}}}]\n"
                         "spacing: 0.05\nlattice: cells\ncracks: [{from: [-0.31, 0], to: [0.31, 0]}]\n"
                         "materials: {m: {youngs_modulus: 10 GPa, poissons_ratio: 0.3333333333333333}}\n"
                         "failure: {" G0 "}\nboundary:\n" PULL
                         "solver: {kind: static, max_events: 4}\noutput: {at: {levels: 1}}\n");
    to_the_end (&r);
    for (size_t i = 0; i < 2; i++) check_relative (tip_of (&r, i)->grown, 0.2, 1e-3);
    check_absolute (tip_of (&r, 0)->x[0], -tip_of (&r, 1)->x[0], 1e-6);
    check_absolute (tip_of (&r, 0)->x[1], tip_of (&r, 1)->x[1], 1e-6);
    clear (&r);
}

static void strip_refused (const char *failure, const char *solver, const char *method, const char *words)
{
    char text[4096];
    int other = strcmp (solver, "adr") == 0;
    snprintf (text, sizeof text, STRIP, 0.2, 0.01, 2.0, 0.01, failure, PULL, other ? "" : solver, method);
    char *kind = strstr (text, "kind: static");
    if (other) memcpy (kind, "kind: adr   ", strlen ("kind: static"));
    check_refused (text, words);
}

static void what_does_not_go_together_is_refused (void **state)
{
    (void) state;
    strip_refused ("criterion: energy_release, " G0, ", break: worst", "",
                   "judges tips, not bonds: use facet");
    strip_refused ("criterion: stretch, critical_stretch: 1e-3", ", break: facet", "",
                   "facet needs a criterion that judges");
    strip_refused (G0, ", facet: 5 spacing", "", "must lie in [0.25, 4] spacings");
    strip_refused (G0 ", path: [[0, 0.3], [3, 0.3]]", "", "", "the path must run through every tip");
    strip_refused ("criterion: energy_release, " G0, "adr", "", "judges tips in equilibrium");
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (a_strip_breaks_at_its_load_on_any_lattice),
        cmocka_unit_test (the_length_of_a_facet_does_not_matter),
        cmocka_unit_test (constant_loads_count),
        cmocka_unit_test (confinement_adds_to_a_growing_load),
        cmocka_unit_test (a_constant_load_may_drive_the_crack),
        cmocka_unit_test (the_energy_may_change_from_place_to_place),
        cmocka_unit_test (the_energy_may_depend_on_the_direction),
        cmocka_unit_test (the_material_at_the_tip_decides),
        cmocka_unit_test (a_crack_can_be_held_to_a_path),
        cmocka_unit_test (inclined_cracks_kink),
        cmocka_unit_test (a_crack_runs_through),
        cmocka_unit_test (cracks_meet),
        cmocka_unit_test (fixed_steps_grow_until_all_tips_rest),
        cmocka_unit_test (a_crack_that_closes_is_said_to),
        cmocka_unit_test (pressure_in_cracks_is_tension_outside),
        cmocka_unit_test (a_resumed_run_goes_on_bit_by_bit),
        cmocka_unit_test (tips_that_tie_grow_together),
        cmocka_unit_test (what_does_not_go_together_is_refused),
    };
    return cmocka_run_group_tests_name ("scene_runs/facet_growth", tests, NULL, NULL);
}
