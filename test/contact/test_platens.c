/* SPDX-License-Identifier: GPL-3.0-or-later
 * Rigid platens: blocks between them that nothing else holds, against closed forms; forces, tilting seats,
 * friction, gaps; cylinders on planes (Hertz); units, mirrors and threads; checkpoints; what is refused. */
#include "refused.h"
#include "scene_runs/run.h"
#include "solve/tape.h"
#include "platens.h"

#define BLOCK(mode, size, unit, more) \
    "dimension: 2\nplane: " mode "\nthickness: 0.5\n" \
    "body: [{add: {box: {low: [0, 0], high: " size "}}}]\nspacing: " unit "\nlattice: cells\n" \
    "method: {integration: consistent}\nmaterials: {m: {youngs_modulus: 1000, poissons_ratio: 0.25}}\n" more

/* All pieces of a run bear this pressure and shear. */
static void check_pieces (const run *r, double pressure, double shear, double tolerance)
{
    size_t n;
    const pg_contact_values *v = pg_solver_contact (r->solver, &n);
    assert_true (n > 1);
    for (size_t k = 0; k < n; k++) {
        assert_true (v[k].platen > 0);
        check_scaled (v[k].pressure, pressure, tolerance, pressure);
        check_scaled (fabs (v[k].shear[0]), shear, tolerance, pressure);
    }
}

/* A block that two frictionless platens alone hold bears a uniform stress, whatever its points, and stores
 * all of the work; in plane strain it is stiffer. */
static void a_block_is_pressed_uniformly (void **state)
{
    (void) state;
    static const struct { const char *mode; double perturb, modulus; const char *stepping; } cases[] = {
        { "stress", 0, 1000, "fixed, steps: 2" },
        { "stress", 0.2, 1000, "event" },
        { "strain", 0.2, 1000 / (1 - 0.0625), "fixed, steps: 1" },
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        run r = scene_of (1,
            BLOCK ("%s", "[1, 2]", "0.1", "perturb: {amount: %g}\n")
            "platens:\n  - {name: base, point: [0.5, 0], normal: [0, 1]}\n"
            "  - {name: head, point: [0.5, 2], normal: [0, -3], displacement: {y: -0.02}}\n"
            "solver: {kind: static, stepping: %s}\noutput: {at: {levels: 1}}\n", cases[i].mode,
            cases[i].perturb, cases[i].stepping);
        to_the_end (&r);
        const pg_statistics *s = pg_solver_report_now (r.solver);
        double pressure = 0.01 * cases[i].modulus;
        check_pieces (&r, pressure, 0, 1e-10);
        assert_int_equal (s->contact.pieces, 10);      /* two spacings each */
        double mean = 0;                               /* what nothing resists leaves it in its place */
        for (size_t k = 0; k < r.problem->cloud.n; k++) mean += r.state->d[2*k];
        check_scaled (mean / (double) r.problem->cloud.n, 0, 1e-12, 0.02);
        check_relative (platen_of (&r, 0)->force[1], 0.5 * pressure, 1e-11);
        check_relative (platen_of (&r, 1)->force[1], -0.5 * pressure, 1e-11);
        check_scaled (platen_of (&r, 1)->force[0], 0, 1e-11, pressure);
        check_scaled (platen_of (&r, 1)->force[5], 0, 1e-11, pressure);
        check_relative (platen_of (&r, 1)->motion[1], -0.02, 1e-15);
        check_relative (s->energy.strain, 0.5 * 0.5 * pressure * 0.02, 1e-10);
        check_relative (s->energy.external, s->energy.strain, 1e-10);
        assert_true (s->nwarning == 0);
        clear (&r);
    }
}

/* Pressed by a force from a distance, by a platen that is slanted by 0.01 rad and may tilt: it comes, turns
 * until the moment about its seat is zero, and lies flat. One that is held presses one edge. */
static void a_seat_tilts_until_it_lies_flat (void **state)
{
    (void) state;
    for (int tilts = 0; tilts < 2; tilts++) {
        run r = scene_of (1,
            BLOCK ("stress", "[1, 1]", "0.1", "")
            "platens:\n  - {name: base, point: [0.5, 0], normal: [0, 1], friction: 0.5}\n"
            "  - {name: head, point: [0.5, 1.03], normal: [0.01, -1], force: {y: -5}, tilt: %s}\n"
            "solver: {kind: static, stepping: fixed, steps: 1}\noutput: {at: {levels: 1}}\n",
            tilts ? "free" : "held");
        to_the_end (&r);
        const pg_platen_values *head = platen_of (&r, 1);
        const pg_statistics *s = pg_solver_report_now (r.solver);
        check_relative (head->force[1], -5, 1e-11);
        check_relative (head->force[0], 0.05, 1e-9);   /* along its normal of the start */
        check_relative (s->energy.external, s->energy.strain + s->energy.friction, 1e-9);
        if (tilts) {
            size_t n;
            const pg_contact_values *v = pg_solver_contact (r.solver, &n);
            check_scaled (head->force[5], 0, 1e-11, 5);
            check_relative (head->motion[5], -0.01, 0.1);
            for (size_t k = 0; k < n; k++) assert_true (v[k].pressure > 5 && v[k].pressure < 15);
        } else assert_true (fabs (head->force[5]) > 0.1 && head->motion[5] == 0);
        clear (&r);
    }
}

/* A block is pressed between rough platens and dragged: they slide at mu times the force, the rougher one
 * sticks; the work of the drag is friction's and the strain's. */
static void platens_drag_by_friction (void **state)
{
    (void) state;
    run r = scene_of (1,
        BLOCK ("stress", "[2, 0.5]", "0.1", "")
        "platens:\n  - {name: base, point: [0, 0], normal: [0, 1], friction: 0.6}\n"
        "  - {name: head, point: [1, 0.5], normal: [0, -1], friction: 0.2, displacement: {x: 0.02}, "
        "force: {y: -10}, force_ramp: constant}\n"
        "solver: {kind: static, stepping: fixed, steps: 20}\noutput: {at: {levels: 1}}\n");
    double slid = 0, before = 0;
    while (!pg_solver_done (r.solver, r.state)) {
        advance (&r);
        const pg_statistics *s = pg_solver_report_now (r.solver);
        check_relative (platen_of (&r, 1)->force[1], -10, 1e-10);
        check_scaled (platen_of (&r, 0)->force[0], -platen_of (&r, 1)->force[0], 1e-10, 10);
        assert_true (platen_of (&r, 1)->force[0] <= 2 * (1 + 1e-9));
        assert_true (s->energy.friction >= before - 1e-12 * s->energy.external);
        before = s->energy.friction;
        slid = platen_of (&r, 1)->force[0];
    }
    const pg_statistics *s = pg_solver_report_now (r.solver);
    check_relative (slid, 2, 1e-8);
    assert_true (s->energy.friction > 0.1 * s->energy.external);
    check_scaled (s->energy.external - s->energy.strain - s->energy.friction, 0, 1e-2, s->energy.external);
    clear (&r);
}

/* The mean of x^2 under the pressure of the pieces, each of which bears it uniformly. */
static double mean_square (const pg_contact_values *v, size_t n, int axes, size_t *closed, double *peak)
{
    double force = 0, second = 0;
    *closed = 0, *peak = 0;
    for (size_t k = 0; k < n; k++) {
        double f = v[k].pressure * v[k].area, x2 = 0;
        for (int m = 0; m < axes; m++) x2 += v[k].x[m] * v[k].x[m] + v[k].length * v[k].length / 12;
        force += f, second += f * x2, *closed += f > 0, *peak = fmax (*peak, v[k].pressure);
    }
    return second / force;
}

/* A rigid cylinder of radius R pressed into a block twelve times as wide as what touches: the half width a of
 * contact under the force F a length is a^2 = 4 F R (1 - nu^2) / (pi E), the pressure p0 sqrt (1 - x^2 /
 * a^2), p0 = 2 F / (pi a). Smaller loads come closer to the half plane. */
static void a_cylinder_is_pressed_in_as_hertz_has_it (void **state)
{
    (void) state;
    const double pi = 3.14159265358979323846, R = 100;
    static const struct { double F, h; } cases[] = { { 8, 0.1 }, { 2, 0.1 }, { 2, 0.05 }, { 2, 1.0 / 30 } };
    for (size_t i = 0; i < (longer () ? 4 : 1); i++) {
        const double F = cases[i].F, h = cases[i].h, a = sqrt (4 * F * R * (1 - 0.0625) / (pi * 1000));
        run r = scene_of (1,
            "dimension: 2\nplane: strain\nthickness: 1\n"
            "body: [{add: {box: {low: [-6, -6], high: [6, 0]}}}]\nspacing: %.17g\nlattice: cells\n"
            "materials: {m: {youngs_modulus: 1000, poissons_ratio: 0.25}}\n"
            "boundary: [{set: bottom, displacement: {x: 0, y: 0}}]\n"
            "platens: [{name: roll, shape: cylinder, point: [0, 100], radius: 100, force: {y: -%g}}]\n"
            "solver: {kind: static, stepping: fixed, steps: 1}\noutput: {at: {levels: 1}}\n", h, F);
        to_the_end (&r);
        double peak;
        size_t count, closed;
        const pg_contact_values *v = pg_solver_contact (r.solver, &count);
        double width = 2 * sqrt (mean_square (v, count, 1, &closed, &peak));   /* its mean is a^2 / 4 */
        check_relative (platen_of (&r, 0)->force[1], -F, 1e-11);
        print_message ("Hertz, a / depth %.3f, a / h %.1f: width %.4f, pressure %.4f of theory, %zu pieces "
                       "of %zu closed\n", a / 6, a / h, width / a, peak / (2 * F / (pi * a)), closed, count);
        check_relative (width, a, 0.2 * h / a);
        check_relative (peak, 2 * F / (pi * a), 0.2 * h / a);
        clear (&r);
    }
}

/* A disk, its cells cut, between flat platens and between jaws of one and a half times its radius: by Hertz
 * these touch it along sqrt (3) times the width. It rests on what touches it alone. */
static void curved_jaws_touch_along_a_wider_arc (void **state)
{
#define JAW "shape: cylinder, concave: true, radius: 1.5, "
    (void) state;
    double width[2];
    for (int k = 0; k < 2; k++) {
        run r = scene_of (1,
            "dimension: 2\nplane: stress\nthickness: 1\n"
            "body: [{add: {disk: {center: [0, 0], radius: 1}}}]\nspacing: 0.04\nlattice: cells\ncells: cut\n"
            "materials: {m: {youngs_modulus: 1000, poissons_ratio: 0.25}}\n"
            "platens: [{name: foot, friction: 0.2, %s}, {name: head, friction: 0.2, %s, force: {y: -20}}]\n"
            "solver: {kind: static, stepping: fixed, steps: 1}\noutput: {at: {levels: 1}}\n",
            k ? JAW "point: [0, 0.5]" : "point: [0, -1], normal: [0, 1]",
            k ? JAW "point: [0, -0.5]" : "point: [0, 1], normal: [0, -1]");
        to_the_end (&r);
        size_t count, closed;
        double peak;
        const pg_contact_values *v = pg_solver_contact (r.solver, &count);
        width[k] = 2 * sqrt (mean_square (v, count, 1, &closed, &peak));
        check_relative (platen_of (&r, 0)->force[1], 20, 1e-10);
        check_scaled (platen_of (&r, 0)->force[0], 0, 1e-9, 20);
        print_message ("disk, %s: half width %.4f of Hertz\n", k ? "curved jaws" : "flat platens",
                       width[k] / sqrt (4 * 20 * (k ? 3 : 1) / (3.14159265358979 * 1000)));
        clear (&r);
    }
    check_relative (width[1] / width[0], sqrt (3), 0.1);
}

/* In space: a block between platens that alone hold it, one of which tilts. */
static void platens_press_in_space (void **state)
{
    (void) state;
    run r = scene_of (1,
        "dimension: 3\nbody: [{add: {box: {low: [0, 0, 0], high: [1, 1, 1]}}}]\nspacing: 0.25\n"
        "lattice: cells\n"
        "method: {integration: consistent}\nmaterials: {m: {youngs_modulus: 1000, poissons_ratio: 0.25}}\n"
        "platens:\n  - {name: base, point: [0.5, 0.5, 0], normal: [0, 0, 1], friction: 0.3}\n"
        "  - {name: head, point: [0.5, 0.5, 1.1], normal: [0, 0, -1], force: {z: -10}, tilt: free}\n"
        "solver: {kind: static, stepping: fixed, steps: 1}\noutput: {at: {levels: 1}}\n");
    to_the_end (&r);
    const pg_platen_values *head = platen_of (&r, 1);
    check_relative (head->force[2], -10, 1e-10);
    check_relative (platen_of (&r, 0)->force[2], 10, 1e-10);
    for (int k = 0; k < 3; k++) {
        if (k < 2) check_scaled (head->force[k], 0, 1e-10, 10);
        if (k < 2) check_scaled (platen_of (&r, 0)->force[k], 0, 1e-10, 10);
        check_scaled (head->force[3 + k], 0, 1e-9, 10);
        check_scaled (head->motion[3 + k], 0, 1e-6, 1);
    }
    check_relative (head->motion[2], -0.1 - 0.01, 0.02);       /* friction of the base stiffens it */
    clear (&r);
}

/* A quarter of a sphere of radius R pressed into a quarter of a block: contact of the radius a, a^3 = 3 F R
 * (1 - nu^2) / (4 E), pressure 3 F / (2 pi a^2) in the middle. */
static void a_sphere_is_pressed_in_as_hertz_has_it (void **state)
{
    (void) state;
    const double pi = 3.14159265358979323846, R = 20, F = 30, a = cbrt (0.75 * F * R * (1 - 0.0625) / 1000);
    for (int n = 4; n <= (longer () ? 8 : 4); n *= 2) {
        run r = scene_of (1,
            "dimension: 3\nbody: [{add: {box: {low: [0, 0, -2.5], high: [2.5, 2.5, 0]}}}]\n"
            "spacing: %.17g\nlattice: cells\n"
            "materials: {m: {youngs_modulus: 1000, poissons_ratio: 0.25}}\n"
            "boundary: [{set: back, displacement: {x: 0, y: 0, z: 0}}, {set: left, displacement: {x: 0}}, "
            "{set: bottom, displacement: {y: 0}}]\n"
            "platens: [{name: ball, shape: sphere, point: [0, 0, 20], radius: 20, force: {z: -7.5}}]\n"
            "solver: {kind: static, stepping: fixed, steps: 1}\noutput: {at: {levels: 1}}\n", 1.0 / n);
        to_the_end (&r);
        double peak;
        size_t count, closed;
        const pg_contact_values *v = pg_solver_contact (r.solver, &count);
        double radius = sqrt (2.5 * mean_square (v, count, 2, &closed, &peak));    /* its mean is 2 a^2 / 5 */
        check_relative (platen_of (&r, 0)->force[2], -F / 4, 1e-10);
        print_message ("Hertz in space, a / h %.1f: radius %.4f, pressure %.4f of theory, %zu pieces of %zu "
                       "closed\n", a * n, radius / a, peak / (1.5 * F / (pi * a * a)), closed, count);
        check_relative (radius, a, 0.6 / n);
        clear (&r);
    }
}

/* What does not go together is told with words; so is a body that nothing holds. */
static void the_rest_is_refused (void **state)
{
    (void) state;
#define PLATE(more) \
    BLOCK ("stress", "[1, 1]", "0.25", more) "boundary: [{set: bottom, displacement: {x: 0, y: 0}}]\n"
#define HEAD "platens: [{name: head, point: [0.5, 1], normal: [0, -1], displacement: {y: -0.01}}]\n"
    static const struct { const char *scene, *words; } wrong[] = {
        { PLATE ("") "platens: [{name: head, point: [0.5, 1], displacement: {y: -0.01}}]\n",
          "shape: plane needs it" },
        { PLATE ("") "platens: [{name: head, shape: cylinder, point: [0.5, 1]}]\n", "cylinder needs it" },
        { PLATE ("") "platens: [{name: head, shape: sphere, radius: 1, point: [0.5, 2]}]\n", "use cylinder" },
        { PLATE ("") "platens: [{name: a, point: [0, 1], normal: [0, -1]}, {name: a, point: [0, 1], normal: "
          "[0, -1]}]\n", "has this name too" },
        { PLATE ("") "platens: [{name: a, point: [0, 1], normal: [0, -1], displacement: {y: \"-0.1*x\"}}]\n",
          "an expression of t alone" },
        { PLATE ("") "platens: [{name: a, point: [0, 1], normal: [0, -1], displacement: {y: -1}, force: "
          "{y: -1}}]\n",
          "leave one of them out" },
        { PLATE ("") HEAD "solver: {kind: static, stepping: event}\nfailure: {criterion: principal_stress, "
          "tensile_strength: 1}\n", "single bonds" },
        { PLATE ("") "platens: [{name: head, shape: cylinder, radius: 1, point: [0.5, 2], displacement: {y: "
          "-0.01}}]\nsolver: {kind: static, stepping: event}\n", "face to face" },
    };
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
        check_refused (wrong[i].scene, wrong[i].words);
    static const struct { const char *platens, *words; } loose[] = {
        { "{name: base, point: [0.5, 0], normal: [0, 1]}, {name: side, point: [0, 0.5], normal: [1, 0], "
          "force: {x: 1}}", "without end" },
        { "{name: base, point: [0.5, 0], normal: [0, 1]}]\nboundary: [{set: right, traction: {x: 1}}",
          "held neither by prescribed displacements nor by what it touches" },
    };
    for (size_t i = 0; i < sizeof loose / sizeof *loose; i++) {
        run r = scene_of (1, BLOCK ("stress", "[1, 1]", "0.25", "") "platens: [%s]\n"
                          "solver: {kind: static, stepping: fixed, steps: 1}\n", loose[i].platens);
        assert_int_equal (pg_solver_step (r.solver, r.state, &r.step), PG_E_EQUILIBRIUM);
        check_contains (pg_last_error (), loose[i].words);
        clear (&r);
    }
}

/* A small roll pressed in deep comes to places that were far from it at the start: they become pairs, so that
 * no piece overlaps. */
static void far_places_become_pairs (void **state)
{
    (void) state;
    run r = scene_of (1,
        "dimension: 2\nplane: strain\nthickness: 1\nbody: [{add: {box: {low: [-3, -2], high: [3, 0]}}}]\n"
        "spacing: 0.1\nlattice: cells\nmaterials: {m: {youngs_modulus: 1000, poissons_ratio: 0.25}}\n"
        "boundary: [{set: bottom, displacement: {x: 0, y: 0}}]\n"
        "platens: [{name: roll, shape: cylinder, point: [0, 1], radius: 1, force: {y: -400}}]\n"
        "solver: {kind: static, stepping: fixed, steps: 1}\noutput: {at: {levels: 1}}\n");
    to_the_end (&r);
    size_t count;
    double touched = 0;
    const pg_contact_values *v = pg_solver_contact (r.solver, &count);
    for (size_t k = 0; k < count; k++) {
        check_scaled (fmin (0, v[k].gap), 0, 1e-12, 1);
        if (v[k].pressure > 0) touched = fmax (touched, fabs (v[k].x[0]));
    }
    /* at first those within sqrt (2 R h) = .45 are pairs; Hertz: .69 */
    print_message ("roll pressed in deep: touches up to %.2f\n", touched);
    assert_true (touched > 0.55);
    clear (&r);
}

/* A platen in the body is refused, and so is one that nothing faces; a roll that is dragged along the surface
 * is told that its normals are those of the start. */
static void doubtful_platens_are_told (void **state)
{
    (void) state;
    static const struct { const char *platen, *words; pg_status status; } cases[] = {
        { "shape: cylinder, radius: 1, point: [0.5, 1.9], displacement: {y: -0.1}", "overlaps the body by",
          PG_E_SCENE },
        { "point: [0.5, 1], normal: [0, 1]", "overlaps the body by 1", PG_E_SCENE },
        { "point: [5, 1], normal: [0, -1], width: 1", "nothing of the body's surface faces", PG_E_SCENE },
        { "shape: cylinder, radius: 1, point: [0.5, 2], displacement: {x: 0.3, y: -0.02}",
          "slides along the curved platen", PG_OK },
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        run r = { 0 };
        char text[2000];
        snprintf (text, sizeof text, BLOCK ("stress", "[1, 1]", "0.1", "")
                  "boundary: [{set: bottom, displacement: {x: 0, y: 0}}]\nplatens: [{name: head, %s}]\n"
                  "solver: {kind: static, stepping: fixed, steps: 1}\noutput: {at: {levels: 1}}\n",
                  cases[i].platen);
        check_ok (pg_scene_parse (&r.scene, text, "test.yaml"));
        check_ok (pg_problem_build (&r.problem, r.scene, 1));
        check_ok (pg_solver_options_read (&r.options, r.problem, r.scene));
        assert_int_equal (pg_solver_create (&r.solver, r.problem, &r.options), cases[i].status);
        if (cases[i].status == PG_OK) {
            check_ok (pg_state_create (&r.state, r.problem, pg_solver_components (r.solver)));
            advance (&r);
            const pg_statistics *s = pg_solver_report_now (r.solver);
            size_t k = 0;
            while (k < s->nwarning && !strstr (s->warning[k], cases[i].words)) k++;
            assert_true (k < s->nwarning);
        } else check_contains (pg_last_error (), cases[i].words);
        clear (&r);
    }
}

/* Smooth platens hold a block across them only; rough ones hold it; one that goes away holds nothing. */
static void what_nothing_holds_is_told (void **state)
{
    (void) state;
    static const struct { const char *friction, *way, *words; } cases[] = {
        { "0", "-0.01", "can move in 1 way that nothing resists" },
        { "0.3", "-0.01", NULL },
        { "0.3", "0.01", "no platen touches the body" },
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char text[2000];
        snprintf (text, sizeof text, BLOCK ("stress", "[1, 1]", "0.1", "")
                  "platens:\n  - {name: base, point: [0.5, 0], normal: [0, 1], friction: %s}\n"
                  "  - {name: head, point: [0.5, 1], normal: [0, -1], friction: %s, displacement: {y: %s}}\n"
                  "solver: {kind: static, stepping: fixed, steps: 1}\noutput: {at: {levels: 1}}\n",
                  cases[i].friction, cases[i].friction, cases[i].way);
        run r = prepare (1, text);
        to_the_end (&r);
        int found = 0;
        for (int twice = 0; twice < 2; twice++) {      /* told once, however often the report is asked for */
            const pg_statistics *s = pg_solver_report (r.solver, r.state);
            found = 0;
            for (size_t k = 0; k < s->nwarning; k++)
                found += strstr (s->warning[k], cases[i].words ? cases[i].words : "nothing resists") != NULL;
            assert_int_equal (found, cases[i].words != NULL);
        }
        clear (&r);
    }
}

/* Event stepping relies on equilibria that grow with the load: a platen that touches a step of the surface
 * from the start and comes to the next one on its way is told to take fixed steps. */
static void a_platen_that_comes_later_needs_fixed_steps (void **state)
{
    (void) state;
    for (int k = 0; k < 2; k++) {
        run r = scene_of (1,
            "dimension: 2\nplane: stress\nthickness: 1\nbody: [{add: {box: {low: [0, 0], high: [1, 1]}}}, "
            "{add: {box: {low: [0.5, 1], high: [1, 1.1]}}}]\nspacing: 0.1\nlattice: cells\n"
            "materials: {m: {youngs_modulus: 1000, poissons_ratio: 0.25}}\n"
            "boundary: [{set: bottom, displacement: {x: 0, y: 0}}]\n"
            "platens: [{name: head, point: [0.5, 1.1], normal: [0, -1], displacement: {y: -%g}}]\n"
            "solver: {kind: static, stepping: event}\noutput: {at: {levels: 1}}\n", k ? 0.2 : 0.02);
        pg_status status = pg_solver_step (r.solver, r.state, &r.step);
        assert_int_equal (status, k ? PG_E_USAGE : PG_OK);
        if (k) check_contains (pg_last_error (), "use solver.stepping: fixed");
        clear (&r);
    }
}

/* The same disk between a jaw and a slanted platen, in metres or millimetres, mirrored, by two threads. */
static void units_and_mirrors_do_not_count (void **state)
{
    (void) state;
    double first[3] = { 0 };
    for (int k = 0; k < 4; k++) {
        const double u = k == 1 ? 1e-3 : 1, m = k == 2 ? -1 : 1;
        run r = scene_of (k == 3 ? 2 : 1,
            "dimension: 2\nplane: strain\nthickness: %g\n"
            "body: [{add: {disk: {center: [0, 0], radius: %g}}}]\nspacing: %g\nlattice: cells\ncells: cut\n"
            "materials: {m: {youngs_modulus: 1000, poissons_ratio: 0.25}}\n"
            "platens: [{name: foot, friction: 0.4, shape: cylinder, concave: true, radius: %g, point: [0, "
            "%g]},\n  {name: head, friction: 0.4, point: [0, %.17g], normal: [%.17g, -1], force: {y: %.17g}, "
            "tilt: free}]\n"
            "solver: {kind: static, stepping: fixed, steps: 2}\noutput: {at: {levels: 1}}\n", u, u, 0.1 * u,
            1.5 * u, 0.5 * u, 1.01 * u, 0.02 * m, -20 * u * u);
        to_the_end (&r);
        const pg_platen_values *head = platen_of (&r, 1);
        const double now[3] = { head->motion[1] / u, m * head->motion[5], m * head->force[0] / (u * u) };
        for (int i = 0; i < 3; i++) {
            if (k == 0) first[i] = now[i];
            check_relative (now[i], first[i], k == 3 ? 1e-15 : 1e-7);
        }
        clear (&r);
    }
}

/* Confined by a pressure, pressed by a platen, unloaded: stages move platens by their names, friction takes
 * work on both ways, and the platen lets go of what it does not press. */
static void stages_move_platens (void **state)
{
    (void) state;
    run r = scene_of (1,
        BLOCK ("stress", "[1, 1]", "0.1", "")
        "sets: {sides: {boundary: [left, right]}}\nboundary: [{name: jacket, set: sides, pressure: 2}]\n"
        "platens:\n  - {name: foot, point: [0.5, 0], normal: [0, 1], friction: 0.1}\n"
        "  - {name: head, point: [0.5, 1], normal: [0, -1], friction: 0.1, displacement: {y: -0.02}}\n"
        "stages:\n  - {name: press, boundary: {head: 1}}\n  - {name: confine, boundary: {jacket: 1}}\n"
        "  - {name: unload, boundary: {head: 0, jacket: 0}}\n"
        "solver: {kind: static, stepping: fixed, steps: 4}\noutput: {at: {levels: 1}}\n");
    double force[13] = { 0 }, friction = 0;
    for (int k = 1; k <= 12; k++) {
        advance (&r);
        const pg_statistics *s = pg_solver_report_now (r.solver);
        force[k] = -platen_of (&r, 1)->force[1];
        check_relative (platen_of (&r, 0)->force[1], force[k] > 0 ? force[k] : 1, force[k] > 0 ? 1e-9 : 1);
        assert_true (s->energy.friction >= friction - 1e-12 * s->energy.strain);
        friction = s->energy.friction;
    }
    check_relative (force[4], 10, 0.02);               /* half the thickness times E times 2 %, a bit more */
    assert_true (force[8] > force[4] + 0.1 && friction > 0);   /* confined: nu times the pressure more */
    check_scaled (force[12], 0, 1e-2, force[8]);
    clear (&r);
}

/* Wings of a closed flaw in a plate that two smooth platens press, and nothing else holds, grow as between
 * supports, event by event, and take the same energy of the platens. */
static void cracks_grow_between_platens (void **state)
{
    (void) state;
    double factor[2] = { 0 }, energy[2] = { 0 };
    for (int k = 0; k < 2; k++) {
        run r = scene_of (1,
            "dimension: 2\nplane: stress\nthickness: 1\nbody: [{add: {box: {low: [-3, -4], high: [3, 4]}}}]\n"
            "spacing: 0.125\nlattice: cells\ncracks: [{from: [-0.7071, -0.7071], to: [0.7071, 0.7071]}]\n"
            "materials: {m: {youngs_modulus: 1000, poissons_ratio: 0.25}}\n"
            "contact: {kind: friction, coefficient: 0.2}\n"
            "failure: {criterion: energy_release, fracture_energy: 1e-3}\n%s"
            "solver: {kind: static, stepping: event, max_events: 3}\noutput: {at: {levels: 1}}\n",
            k ? "platens:\n  - {name: foot, point: [0, -4], normal: [0, 1]}\n"
                "  - {name: head, point: [0, 4], normal: [0, -1], displacement: {y: -0.1}}\n"
              : "sets: {pin: {where: \"x < -2.9 and y < -3.9\"}}\nboundary:\n"
                "  - {set: bottom, displacement: {y: 0}}\n  - {set: top, displacement: {y: -0.1}}\n"
                "  - {set: pin, essential: penalty, displacement: {x: 0}}\n");
        to_the_end (&r);
        const pg_statistics *s = pg_solver_report_now (r.solver);
        assert_int_equal (s->events, 3);
        check_relative (r.state->paths->tip[0].grown, r.state->paths->tip[1].grown, 1e-9);
        factor[k] = r.state->factor, energy[k] = s->energy.dissipated;
        clear (&r);
    }
    check_relative (factor[1], factor[0], 1e-3);
    check_relative (energy[1], energy[0], 1e-3);
}

/* A run that is stopped in its middle and read back goes on bit by bit. */
static void a_run_goes_on_from_its_checkpoint (void **state)
{
    (void) state;
#define DRAGGED \
    BLOCK ("stress", "[1, 0.5]", "0.1", "") \
    "platens:\n  - {name: base, point: [0.5, 0], normal: [0, 1], friction: 0.6}\n" \
    "  - {name: head, shape: cylinder, radius: 2, point: [0.5, 2.501], friction: 0.2, " \
    "displacement: {x: 0.02}, force: {y: -10}}\n" \
    "solver: {kind: static, stepping: fixed, steps: 6}\noutput: {at: {levels: 1}}\n"
    run a = scene_of (1, "%s", DRAGGED), b = scene_of (1, "%s", DRAGGED);
    static tape t;
    for (int k = 0; k < 3; k++) advance (&a);
    keep (&a, &t, 0), keep (&b, &t, 1);
    for (int k = 0; k < 3; k++) {
        advance_alike (&a, &b);
        size_t n;
        const pg_platen_values *u = pg_solver_platens (a.solver, &n), *v = pg_solver_platens (b.solver, &n);
        assert_memory_equal (u, v, n * sizeof *u);
    }
    assert_true (pg_solver_report_now (a.solver)->energy.external
                 == pg_solver_report_now (b.solver)->energy.external);
    clear (&a), clear (&b);
}

/* Builds a cut block between platens and makes two steps. */
static pg_status press_a_cut_block (void)
{
    pg_status status = PG_OK;
    run r = { 0 };
    PG_TRY (pg_scene_parse (&r.scene,
        BLOCK ("stress", "[1, 1]", "0.2", "cracks: [{from: [-0.1, 0.5], to: [1.1, 0.5]}]\n")
        "contact: {kind: friction, coefficient: 0.5}\n"
        "platens:\n  - {name: base, point: [0.5, 0], normal: [0, 1], friction: 0.3}\n"
        "  - {name: head, shape: cylinder, radius: 4, point: [0.5, 5.01], force: {y: -5}, tilt: free}\n"
        "solver: {kind: static, stepping: fixed, steps: 2}\noutput: {at: {levels: 1}}\n", "test.yaml"));
    PG_TRY (pg_problem_build (&r.problem, r.scene, 1));
    PG_TRY (pg_solver_options_read (&r.options, r.problem, r.scene));
    PG_TRY (pg_solver_create (&r.solver, r.problem, &r.options));
    PG_TRY (pg_state_create (&r.state, r.problem, pg_solver_components (r.solver)));
    while (!pg_solver_done (r.solver, r.state)) PG_TRY (pg_solver_step (r.solver, r.state, &r.step));
done:
    clear (&r);
    return status;
}

/* Whichever allocation fails: it is told, and nothing is left behind. */
static void memory_may_run_out (void **state)
{
    (void) state;
    check_ok (press_a_cut_block ());                   /* what is allocated once */
    size_t used = pg_memory_used (), calls = pg_memory_calls ();
    check_ok (press_a_cut_block ());
    calls = pg_memory_calls () - calls;
    for (size_t k = calls / 2; k <= calls; k += longer () ? 1 : 1 + calls / 60) {
        pg_memory_fail_at (k);
        pg_status status = press_a_cut_block ();
        pg_memory_fail_at (0);
        if (status != PG_E_MEMORY && status != PG_OK)
            print_error ("allocation %zu: %s\n", k, pg_last_error ());
        assert_true (status == PG_E_MEMORY || status == PG_OK);
        assert_int_equal (pg_memory_used (), used);
    }
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (a_block_is_pressed_uniformly),
        cmocka_unit_test (a_seat_tilts_until_it_lies_flat),
        cmocka_unit_test (platens_drag_by_friction),
        cmocka_unit_test (a_cylinder_is_pressed_in_as_hertz_has_it),
        cmocka_unit_test (curved_jaws_touch_along_a_wider_arc),
        cmocka_unit_test (platens_press_in_space),
        cmocka_unit_test (a_sphere_is_pressed_in_as_hertz_has_it),
        cmocka_unit_test (the_rest_is_refused),
        cmocka_unit_test (units_and_mirrors_do_not_count),
        cmocka_unit_test (far_places_become_pairs),
        cmocka_unit_test (doubtful_platens_are_told),
        cmocka_unit_test (what_nothing_holds_is_told),
        cmocka_unit_test (a_platen_that_comes_later_needs_fixed_steps),
        cmocka_unit_test (stages_move_platens),
        cmocka_unit_test (cracks_grow_between_platens),
        cmocka_unit_test (a_run_goes_on_from_its_checkpoint),
        cmocka_unit_test (memory_may_run_out),
    };
    return cmocka_run_group_tests (tests, NULL, NULL);
}
