/* SPDX-License-Identifier: GPL-3.0-or-later
 * Event stepping under loads with a constant part: closed forms, the proportional path, fixed steps, every
 * criterion, resume; a constant part that drives the crack by itself; what is no such load. */
#include "scene_runs/run.h"
#include "tape.h"

#define PLATE \
    "dimension: 2\nplane: stress\nthickness: 1 mm\nbody: [{add: {box: {low: [0, 0], high: [20 mm, 10 " \
    "mm]}}}]\nspacing: 1 mm\ncracks: [{from: [0, 5 mm], to: [6 mm, 5 mm]}]\n" \
    "materials: {glass: {youngs_modulus: 72 GPa, poissons_ratio: %s}}\n"
#define HELD "  - {set: bottom, displacement: {x: 0, y: 0}}\n"
#define PULL "  - {set: top, displacement: {y: 10 um}}\n"

/* A bar under a constant and a growing pull breaks where both make the strength. */
static void a_bar_breaks_in_closed_form (void **state)
{
    (void) state;
    static const struct { const char *limit; double expected;
    } laws[] = {
        { "criterion: principal_stress, tensile_strength: 2.5 MPa", 0.75 },
        { "criterion: stretch, critical_stretch: 2.5e-4, stretch: linear", 0.75 },
        { "criterion: stretch, critical_stretch: 2.5e-4, stretch: finite", 0.75 },
        { "criterion: mohr_coulomb, tensile_strength: 2.5 MPa, cohesion: 100 MPa, friction_angle: 30 deg",
          0.75 },
    };
    for (int l = 0; l < 4; l++)
        for (int way = 0; way < 2; way++) {
            static const char *const loads[] = { "  - {set: right, traction: {x: 1 MPa}, ramp: constant}\n  "
                                                 "- {set: right, traction: {x: 2 MPa}}\n",
                                                 "  - {set: right, traction: {x: 1 MPa}, ramp: 1 + 2*t}\n" };
            run r = scene_of (
                1,
                "dimension: 2\nplane: stress\nthickness: 1 m\nbody: [{add: {box: {low: [0, 0], high: [1, "
                "0.4]}}}]\nspacing: 0.1\nmaterials: {m: {youngs_modulus: 10 GPa, poissons_ratio: 0}}\n"
                "method: {integration: consistent}\nfailure: {%s, exclude: [left]}\nboundary:\n  - {set: "
                "left, displacement: {x: 0, y: 0}}\n%ssolver: {stepping: event, max_events: 1}\noutput: {at: "
                "{levels: 2}}\n",
                laws[l].limit, loads[way]);
            advance (&r);
            assert_true (r.state->factor == 0 && r.step.nbroken == 0 && r.step.level);
            check_relative (r.step.reaction[3], 0.4e6, 1e-12);
            check_relative (r.step.utilisation, 0.4, 1e-6);
            advance (&r);
            assert_true (r.state->factor == 0.5 && r.step.nbroken == 0);
            advance (&r);
            check_relative (r.state->factor, laws[l].expected, 1e-8);
            check_relative (r.step.utilisation, 1, 1e-11);
            assert_true (r.step.nbroken > 0);
            clear (&r);
        }
}

/* Two bodies, of which one is pulled apart while the other bears a constant load: what is left of the
 * stiffness
 * against the load that grows ends the run, as it does without the other one. */
static void what_ends_a_run_is_the_growing_part (void **state)
{
    (void) state;
    for (int constant = 0; constant < 2; constant++) {
        run r = scene_of (
            1,
            "dimension: 2\nplane: stress\nthickness: 1 mm\nbody: [{add: {box: {low: [0, 0], high: [10 "
                "mm, 10 mm]}}}, "
            "{add: {box: {low: [20 mm, 0], high: [30 mm, 10 mm]}}}]\nspacing: 1.25 mm\nlattice: cells\n"
            "cracks: [{from: [-1 mm, 5 mm], to: [4 mm, 5 mm]}]\n"
            "materials: {glass: {youngs_modulus: 72 GPa, poissons_ratio: 0.3333333333333333}}\n"
            "method: {force: bond, horizon: 2.5 spacing}\nfailure: {criterion: stretch, "
                "critical_stretch: 1e-3, exclude: [other]}\n"
            "sets: {lid: {where: x < 15 mm and y > 8.7 mm}, other: {where: x > 15 mm}}\n"
            "boundary:\n  - {set: bottom, displacement: {x: 0, y: 0}}\n  - {set: lid, displacement: {y: "
                "40 um}}\n"
            "  - {set: right, traction: {x: 100 MPa}%s}\n"
            "solver: {stepping: event, stop: {stiffness: 20 %%}, max_events: 400}\noutput: {at: {levels: "
                "1}}\n",
            constant ? ", ramp: constant" : ", ramp: 0");
        int told = 0;
        to_the_end (&r);
        const pg_statistics *report = pg_solver_report_now (r.solver);
        for (size_t k = 0; k < report->nwarning; k++)
            told |= strstr (report->warning[k], "the body has separated") != NULL;
        print_message ("constant %d: %ld events, factor %g\n", constant, report->events, r.state->factor);
        assert_true (told && report->events < 400);
        clear (&r);
    }
}

/* Nothing breaks: zero, the levels, the end. */
static void a_run_without_events_ends_with_its_last_level (void **state)
{
    (void) state;
    run r =
        scene_of (1,
                  "dimension: 2\nplane: stress\nthickness: 1 m\nbody: [{add: {box: {low: [0, 0], high: [1, "
                  "0.4]}}}]\nspacing: 0.1\nmaterials: {m: {youngs_modulus: 10 GPa, poissons_ratio: 0}}\n"
                  "failure: {criterion: principal_stress, tensile_strength: 5 GPa}\nboundary:\n  - {set: "
                  "left, displacement: {x: 0, y: 0}}\n  - {set: right, traction: {x: 1 MPa}, ramp: 1 + 2*t}\n"
                  "solver: {stepping: event}\noutput: {at: {levels: 4}}\n");
    for (int level = 0; level <= 4; level++) {
        assert_false (pg_solver_done (r.solver, r.state));
        advance (&r);
        check_absolute (r.state->factor, 0.25 * level, 1e-12);
        assert_true (r.step.nbroken == 0 && r.step.level);
    }
    assert_true (pg_solver_done (r.solver, r.state));
    clear (&r);
}

static const struct { const char *nu, *keys;
} cases[] = {
    { "0.22", "failure: {criterion: principal_stress, tensile_strength: 30 MPa, exclude: [right]}\n" },
    { "0.22", "failure: {criterion: mohr_coulomb, tensile_strength: 30 MPa, cohesion: 60 MPa, "
              "friction_angle: 40 deg, exclude: [right]}\nmethod: {integration: nodal}\n" },
    { "0.22", "failure: {criterion: stretch, critical_stretch: 4e-4, exclude: [right]}\nmethod: {essential: "
              "transformation}\n" },
    { "0.22", "failure: {criterion: principal_stress, tensile_strength: 30 MPa, exclude: [right]}\nmethod: "
              "{approximation: nosb, integration: nodal, horizon: 2.5 spacing}\n" },
    { "0.3333333333333333", "failure: {criterion: stretch, critical_stretch: 4e-4, exclude: "
                            "[right]}\nmethod: {force: bond, horizon: 3 spacing}\n" },
    { "0.3333333333333333",
      "failure: {fracture_energy: 20 J/m2, exclude: [right]}\nmethod: {force: fcbm, horizon: 3 spacing}\n" },
    { "0.22", "failure: {criterion: stretch, critical_stretch: 4e-4, exclude: [right]}\nmethod: {force: lps, "
              "horizon: 3 spacing}\n" },
    { "0.22", "failure: {criterion: beam_limits, fracture_energy: 20 J/m2, exclude: [right]}\nmethod: "
              "{force: gmpd, horizon: 3 spacing}\n" },
};
enum { CASES = sizeof cases / sizeof *cases, EVENTS = 12 };

/* A constant part of nothing changes nothing: the same bonds at the same factors. */
static void without_a_constant_part_the_events_are_the_same (void **state)
{
    (void) state;
    for (int c = 0; c < CASES; c++) {
        run a = scene_of (1,
                          PLATE "%sboundary:\n" HELD PULL
                                "solver: {stepping: event, max_events: %d}\noutput: {at: {levels: 1}}\n",
                          cases[c].nu, cases[c].keys, EVENTS),
            b = scene_of (1,
                          PLATE "%sboundary:\n" HELD PULL
                                "  - {set: right, force: {x: 0}, ramp: constant}\nsolver: {stepping: event, "
                                "max_events: %d}\noutput: {at: {levels: 1}}\n",
                          cases[c].nu, cases[c].keys, EVENTS);
        assert_true (!PG_OWN (pg_static_options, &a.options)->affine
                     && PG_OWN (pg_static_options, &b.options)->affine);
        advance (&b);
        for (int e = 0; e < EVENTS; e++) {
            advance (&a), advance (&b);
            check_relative (b.state->factor, a.state->factor, 1e-8);
            assert_true (a.step.nbroken == b.step.nbroken && a.step.nbroken > 0);
            for (size_t k = 0; k < a.step.nbroken; k++)
                assert_int_equal (a.step.broken[k].bond, b.step.broken[k].bond);
            check_scaled (pg_solver_report_now (b.solver)->energy.external,
                          pg_solver_report_now (a.solver)->energy.external, 1e-6,
                          pg_solver_report_now (a.solver)->energy.external);
        }
        clear (&a), clear (&b);
    }
}

/* With one: no live bond over its limit in any accepted state, forces and energies those of a fixed step to
 * the same factor, and no factor before the first event breaks a bond. */
static void states_under_a_constant_part_are_admitted (void **state)
{
    (void) state;
    for (int c = 0; c < CASES; c++) {
        static const char *const side = "  - {set: right, traction: {x: 3 MPa}, ramp: constant}\n";
        run r = scene_of (1,
                          PLATE "%sboundary:\n" HELD PULL
                                "%ssolver: {stepping: event, max_events: %d}\noutput: {at: {levels: 1}}\n",
                          cases[c].nu, cases[c].keys, side, EVENTS);
        advance (&r), advance (&r);
        double first = r.state->factor, reaction = r.step.reaction[4], constant = r.step.reaction[6];
        assert_true (first > 0 && r.step.nbroken > 0);
        check_relative (constant, 3e6 * 1e-5, 1e-9);
        while (!pg_solver_done (r.solver, r.state)) {
            advance (&r);
            check_below (r.step.utilisation, 1 + 1.0001e-4);
            check_below (r.step.residual, 1e-8);
        }
        assert_int_equal (pg_solver_report_now (r.solver)->bonds_over_limit, 0);
        clear (&r);
        for (int beyond = 0; beyond < 2; beyond++) {  /* one fixed step to just before, just behind that */
            run f = scene_of (1,
                              PLATE "%sboundary:\n" HELD
                                    "  - {set: top, displacement: {y: %.17g um}}\n%ssolver: {stepping: "
                                    "fixed, steps: 1}\noutput: {at: {levels: 1}}\n",
                              cases[c].nu, cases[c].keys, 10 * first * (beyond ? 1 + 1e-6 : 1 - 1e-6), side);
            advance (&f);
            assert_int_equal (f.step.nbroken > 0, beyond);
            if (!beyond) check_relative (f.step.reaction[4], reaction, 1e-5);
            clear (&f);
        }
    }
}

/* More than the strength from the start: it runs at a held factor, and says so. */
static void a_constant_part_that_drives_the_crack_is_told (void **state)
{
    (void) state;
    run r = scene_of (1,
                      PLATE
                      "failure: {criterion: principal_stress, tensile_strength: 30 MPa}\nboundary:\n" HELD
                      "  - {set: top, displacement: {y: 10 um}, ramp: constant}\n"
                      "  - {set: right, traction: {x: 1 MPa}}\nsolver: {stepping: event, max_events: "
                      "20}\noutput: {at: {levels: 1}}\n",
                      "0.22");
    advance (&r);
    assert_true (r.state->factor == 0 && r.step.nbroken > 0);
    while (!pg_solver_done (r.solver, r.state)) advance (&r);
    const pg_statistics *report = pg_solver_report_now (r.solver);
    int told = 0;
    for (size_t k = 0; k < report->nwarning; k++)
        told |= strstr (report->warning[k], "the constant loads drive the crack") != NULL;
    assert_true (told);
    clear (&r);
}

static void a_resumed_run_goes_on_bit_by_bit (void **state)
{
    (void) state;
    static const char *const keys =
        "failure: {criterion: principal_stress, tensile_strength: 30 MPa}\nboundary:\n" HELD PULL
        "  - {set: right, traction: {x: 3 MPa}, ramp: constant}\nsolver: {stepping: event, max_events: "
        "12}\noutput: {at: {levels: 3}}\n";
    run a = scene_of (1, PLATE "%s", "0.22", keys), b = scene_of (1, PLATE "%s", "0.22", keys);
    tape t = { 0 };
    for (int step = 0; step < 6; step++) advance (&a);
    keep (&a, &t, 0);
    keep (&b, &t, 1);
    while (!pg_solver_done (a.solver, a.state)) {
        advance_alike (&a, &b);
    }
    pg_free (t.byte);
    clear (&a), clear (&b);
}

static void other_loads_are_refused (void **state)
{
    (void) state;
    static const struct { const char *load; int fine;
    } loads[] = {
        { "traction: {x: 1 MPa}, ramp: t^2", 0 },
        { "traction: {x: 1 MPa}, table: [[0, 0], [0.5, 1], [1, 0]]", 0 },
        { "traction: {x: 1 MPa}, table: [[0, 0.2], [1, 0.9]]", 1 },
        { "traction: {x: 1 MPa}, ramp: 0.3 + 0.4*t", 1 },
        { "displacement: {x: '1 um * sin (3*t)'}", 0 },
        { "displacement: {x: '1 um * (1 + t)', y: 0}, ramp: constant", 1 },
        { "displacement: {x: '1 um * (1 + t)', y: 0}", 0 },
    };
    for (int k = 0; k < 7; k++) {
        char text[1024];
        pg_scene *scene;
        pg_problem *problem;
        pg_solver_options options;
        snprintf (text, sizeof text,
                  PLATE "boundary:\n" HELD "  - {set: right, %s}\nsolver: {stepping: event}\n", "0.22",
                  loads[k].load);
        check_ok (pg_scene_parse (&scene, text, "test.yaml"));
        check_ok (pg_problem_build (&problem, scene, 1));
        check_fails (pg_solver_options_read (&options, problem, scene), loads[k].fine ? PG_OK : PG_E_SCENE);
        if (!loads[k].fine)
            check_contains (
                pg_last_error (),
                "solver.stepping = event: event stepping needs loads that grow with the load factor");
        pg_problem_free (&problem);
        pg_scene_free (&scene);
    }
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (a_bar_breaks_in_closed_form),
        cmocka_unit_test (what_ends_a_run_is_the_growing_part),
        cmocka_unit_test (a_run_without_events_ends_with_its_last_level),
        cmocka_unit_test (without_a_constant_part_the_events_are_the_same),
        cmocka_unit_test (states_under_a_constant_part_are_admitted),
        cmocka_unit_test (a_constant_part_that_drives_the_crack_is_told),
        cmocka_unit_test (a_resumed_run_goes_on_bit_by_bit),
        cmocka_unit_test (other_loads_are_refused),
    };
    return cmocka_run_group_tests_name ("solve/affine", tests, NULL, NULL);
}
