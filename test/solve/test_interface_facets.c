/* SPDX-License-Identifier: GPL-3.0-or-later
 * Interfaces with an energy of their own: along one a crack takes that energy; one that meets an interface
 * goes on along it if that is weak enough, else across; and what is wrong with the keys is said. */
#include "scene_runs/run.h"

static const double E = 70e9, nu = 0.22, G0 = 8;

/* A strip of height 1 m, 20 spacings, its grips moved apart so that G = 4 G0 at full load. */
static run strip (const char *where, const char *energy, double shift, int events)
{
    double u = sqrt (2 * G0 * (1 - nu * nu) / E);
    return scene_of (1, "dimension: 2\nplane: stress\nspacing: 0.05 m\nlattice: cells\n"
                        "lattice_offset: [%g, 0]\nbody: [{add: {box: {low: [0, 0], high: [3 m, 1 m]}}}]\n"
                        "cracks: [{from: [-0.1, 0.5], to: [1.25, 0.5]}]\n"
                        "materials: {a: {youngs_modulus: %.17g, poissons_ratio: %g}, "
                        "b: {youngs_modulus: %.17g, poissons_ratio: %g}}\n"
                        "blocks: [{material: a, where: x == x}, {material: b, where: %s}]\n"
                        "boundary: [{set: bottom, displacement: {x: 0, y: %.17g}}, "
                        "{set: top, displacement: {x: 0, y: %.17g}}]\n"
                        "failure: {criterion: energy_release, fracture_energy: %g, "
                        "interfaces: [{between: [b, a], fracture_energy: %s}]}\n"
                        "solver: {max_events: %d}\n", shift, E, nu, E, nu, where, -u, u, G0, energy, events);
}

static void along_an_interface_its_energy_counts (void **state)
{
    (void) state;
    static const double energy[2] = { 2, 7 };
    for (int k = 0; k < 2; k++) {
        run r = strip ("y > 0.5", k ? "7" : "2", 0, 6);
        while (!pg_solver_done (r.solver, r.state)) {
            advance (&r);
            if (r.step.event) check_relative (r.step.factor, 0.5 * sqrt (energy[k] / G0), 0.01);
        }
        const pg_tip *tip = r.state->paths->tip;
        assert_true (tip->grown > 0.29);
        check_below (fabs (tip->x[1] - 0.5), 1e-9);
        clear (&r);
    }
}

/* Of equal materials a crack is deflected by an interface of less than about a quarter of their energy (He,
 * Hutchinson 1989); facets of a spacing decide within some percent of that. */
static void a_weak_interface_deflects_a_crack (void **state)
{
    (void) state;
    for (int weak = 0; weak < 2; weak++)
        for (int shifted = 0; shifted < 2; shifted++) {
            run r = strip ("x > 1.5", weak ? "1" : "4", shifted ? 0.37 : 0, 9);
            to_the_end (&r);
            const pg_tip *tip = r.state->paths->tip;
            if (weak) {
                check_below (fabs (tip->x[0] - 1.5), 0.02);
                assert_true (fabs (tip->x[1] - 0.5) > 0.09);
            } else {
                assert_true (tip->x[0] > 1.6);
                check_below (fabs (tip->x[1] - 0.5), 0.02);
            }
            clear (&r);
        }
}

/* A bar in even tension parts at the interface where that is weaker than the bodies, at its strength; else
 * anywhere. */
static void an_interface_parts_at_its_strength (void **state)
{
    (void) state;
    for (int weak = 0; weak < 2; weak++) {
        double f = sqrt (E * G0 / 0.4);                /* E G0/f^2 is eight spacings */
        run r = scene_of (1, "dimension: 2\nplane: stress\nspacing: 0.05 m\nlattice: cells\n"
                             "body: [{add: {box: {low: [0, 0], high: [2 m, 1 m]}}}]\n"
                             "materials: {a: {youngs_modulus: %.17g, poissons_ratio: %g}, "
                             "b: {youngs_modulus: %.17g, poissons_ratio: %g}}\n"
                             "blocks: [{material: a, where: x == x}, {material: b, where: x > 1.4}]\n"
                             "sets: {pin: {where: \"hypot (x - 1, y - 0.5) < 0.06\"}}\n"
                             "boundary: [{set: left, traction: {x: %.17g}}, "
                             "{set: right, traction: {x: %.17g}}, "
                             "{set: pin, displacement: {x: 0, y: 0}, essential: penalty}]\n"
                             "failure: {criterion: energy_release, fracture_energy: %g, "
                             "tensile_strength: %.17g, interfaces: [{between: [a, b], "
                             "fracture_energy: %g, tensile_strength: %.17g}]}\n"
                             "solver: {max_events: 1}\n", E, nu, E, nu, -2 * f, 2 * f, G0, f,
                          weak ? 0.25 * G0 : 4 * G0, weak ? 0.5 * f : 2 * f);
        while (r.state->events == 0 && !pg_solver_done (r.solver, r.state)) advance (&r);
        assert_int_equal (r.state->events, 1);
        check_relative (r.step.factor, weak ? 0.25 : 0.5, 0.03);
        double x = r.state->paths->tip[0].x[0];
        if (weak) check_below (fabs (x - 1.4), 0.01);
        else assert_true (fabs (x - 1.4) > 0.01);
        clear (&r);
    }
}

/* E G/f^2 of 0.4 m, eight spacings, belongs to 0.37 MPa at 0.8 J/m^2. */
static void a_strength_beyond_the_points_is_said (void **state)
{
    (void) state;
    for (int strong = 0; strong < 2; strong++) {
        const char *limits = strong ? "0.8, tensile_strength: 0.4 MPa" : "0.8, tensile_strength: 0.35 MPa";
        run r = strip ("x > 1.5", limits, 0, 1);
        advance (&r);
        const pg_statistics *report = pg_solver_report_now (r.solver);
        int said = 0;
        for (size_t k = 0; k < report->nwarning; k++)
            said |= strstr (report->warning[k], "interface of b and a") != NULL;
        assert_int_equal (said, strong);
        clear (&r);
    }
}

static void wrong_interfaces_are_refused (void **state)
{
    (void) state;
    static const struct { const char *failure, *message; } cases[] = {
        { "criterion: energy_release, fracture_energy: 8, "
          "interfaces: [{between: [a, a], fracture_energy: 1}]",
          "two different materials" },
        { "criterion: energy_release, fracture_energy: 8, "
          "interfaces: [{between: [a, b, a], fracture_energy: 1}]",
          "two different materials" },
        { "criterion: energy_release, fracture_energy: 8, "
          "interfaces: [{between: [a], fracture_energy: 1}]",
          "two materials" },
        { "criterion: stretch, critical_stretch: 1e-4, interfaces: [{between: [a, b], fracture_energy: 1}]",
          "judges tips" },
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        char text[1200];
        pg_scene *scene = NULL;
        pg_problem *problem = NULL;
        snprintf (text, sizeof text,
                  "dimension: 2\nspacing: 0.1 m\nbody: [{add: {box: {low: [0, 0], high: [1 m, 1 m]}}}]\n"
                  "materials: {a: {youngs_modulus: 1 GPa, poissons_ratio: 0.2}, "
                  "b: {youngs_modulus: 1 GPa, poissons_ratio: 0.2}}\n"
                  "blocks: [{material: a, where: x == x}, {material: b, where: x > 0.5}]\n"
                  "boundary: [{set: bottom, displacement: {x: 0, y: 0}}]\nfailure: {%s}\n", cases[k].failure);
        check_ok (pg_scene_parse (&scene, text, "test.yaml"));
        check_fails (pg_problem_build (&problem, scene, 1), PG_E_SCENE);
        check_contains (pg_last_error (), cases[k].message);
        pg_problem_free (&problem);
        pg_scene_free (&scene);
    }
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (along_an_interface_its_energy_counts),
        cmocka_unit_test (a_weak_interface_deflects_a_crack),
        cmocka_unit_test (an_interface_parts_at_its_strength),
        cmocka_unit_test (a_strength_beyond_the_points_is_said),
        cmocka_unit_test (wrong_interfaces_are_refused),
    };
    return cmocka_run_group_tests (tests, NULL, NULL);
}
