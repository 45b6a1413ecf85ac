/* SPDX-License-Identifier: GPL-3.0-or-later
 * Boundary conditions of daily work: moments of all loads close, sets that turn, planes of symmetry, gravity,
 * forces at places, springs, nodal forces; against closed forms. */
#include <string.h>
#include "run.h"

static const char *const methods[] = {
    "",
    "method: {essential: transformation}\n",
    "method: {essential: penalty}\n",
    "method: {integration: consistent}\nperturb: {amount: 0.3}\n",
    "method: {force: bond}\n",
    "method: {force: lps}\nperturb: {amount: 0.2}\n",
    "method: {force: gmpd}\n",
};
enum { METHODS = sizeof methods / sizeof *methods };
#define PLATE \
    "dimension: 2\nthickness: 0.1\nbody: [{add: {box: {low: [1, 2], high: [3, 3]}}}]\nspacing: 0.1\n" \
    "materials: {rock: {youngs_modulus: 10 GPa, poissons_ratio: 0.3333333333333333, density: 2000}}\n"

/* Sum of the forces of all loads along axis k, of moments (all about the same place) about it. */
static double sum_of (const run *r, int k, int moments)
{
    double sum = 0;
    size_t n = r->problem->boundary.nload;
    for (size_t l = 0; l < n; l++) sum += r->step.reaction[3 * (l + (moments ? n : 0)) + (size_t) k];
    return sum;
}

/* The reactions of supports bear all forces, and their moments about the origin. */
static void forces_and_moments_close (void **state)
{
    (void) state;
    for (int k = 0; k < METHODS - 1; k++) {            /* rotations of gmpd bear moments of their own */
        run r = scene_of (1, "%s%sboundary:\n"
                             "  - {set: left, displacement: {x: 0, y: 0}, about: [0, 0]}\n"
                             "  - {set: right, force: {y: 3 kN, x: 1 kN}, about: [0, 0]}\n"
                             "  - {at: [2.23, 2.61], force: {x: 7 kN}, about: [0, 0]}\n"
                             "  - {gravity: [1 m/s2, -9.81 m/s2], about: [0, 0]}\n"
                             "  - {set: top, spring: {all: 1 MN/m}, spring_end: {x: 1 mm}, about: [0, 0]}\n"
                             "  - {set: bottom, turn: {z: 1e-4}, about: [0, 0]}\n",
                          PLATE, methods[k]);
        to_the_end (&r);
        double size = fabs (r.step.reaction[0]) + 1e3, turn = fabs (r.step.reaction[3 * 6 + 2]) + 1e3;
        for (int c = 0; c < 2; c++) check_below (fabs (sum_of (&r, c, 0)) / size, 2e-8);
        check_below (fabs (sum_of (&r, 2, 1)) / turn, 2e-8);
        clear (&r);
    }
}

/* Without a word the moment is about the centre of the set. */
static void moments_are_about_the_centre (void **state)
{
    (void) state;
    run r = scene_of (1, "%sboundary:\n  - {set: left, displacement: {x: 0, y: 0}}\n  - {set: right, "
                         "traction: {y: 1 MPa}}\n",
                      PLATE);
    to_the_end (&r);
    check_relative (r.problem->boundary.load[0].about[0], 1, 1e-14);
    check_relative (r.problem->boundary.load[0].about[1], 2.5, 1e-14);
    double F = 1e6 * 0.1;                              /* at an arm of 2 m */
    check_relative (r.step.reaction[3 * 2 + 2], -2 * F, 1e-8);
    check_below (fabs (r.step.reaction[3 * 3 + 2]) / F, 1e-9);
    clear (&r);
}

/* A total force on a side is a traction there, whatever carries it and wherever the points lie. */
static void a_force_on_a_side_is_a_traction (void **state)
{
    (void) state;
    static const char *const loads[] = { "force: {x: 2 kN, y: 3 kN}", "traction: {x: 20 kPa, y: 30 kPa}" };
    for (int k = 0; k < METHODS - 1; k++)
        for (int cells = 0; cells < 2; cells++) {
            double strain[2];
            for (int l = 0; l < 2; l++) {
                run r = scene_of (1, "%s%slattice: %s\nboundary:\n"
                                     "  - {set: left, displacement: {x: 0, y: 0}}\n  - {set: right, %s}\n",
                                  PLATE, methods[k], cells ? "cells" : "nodes", loads[l]);
                to_the_end (&r);
                strain[l] = pg_solver_report (r.solver, r.state)->energy.strain;
                check_relative (r.step.reaction[3], 2e3, 1e-9);
                check_relative (r.step.reaction[4], 3e3, 1e-9);
                clear (&r);
            }
            check_relative (strain[0], strain[1], 1e-7);
        }
}

/* A force at a place between points: resultant and moment are exact, whatever carries it; also beside a
 * crack,
 * whose other side it does not reach. */
static void a_force_at_a_place_is_exact (void **state)
{
    (void) state;
    for (int k = 0; k < METHODS - 1; k++)
        for (int cracked = 0; cracked < 2; cracked++) {
            const double x[2] = { 2.234, 2.53 }, F[2] = { 3e3, -5e3 };
            run r = scene_of (1, "%s%s%sboundary:\n  - {set: left, displacement: {x: 0, y: 0}, about: [0, "
                                 "0]}\n"
                                 "  - {at: [%.17g, %.17g], force: {x: 3 kN, y: -5 kN}}\n",
                              PLATE, methods[k], cracked ? "cracks: [{from: [1.8, 2.48], to: [3.1, "
                                                           "2.48]}]\n" : "",
                              x[0], x[1]);
            to_the_end (&r);
            for (int c = 0; c < 2; c++) check_relative (r.step.reaction[c], -F[c], 1e-8);
            check_relative (r.step.reaction[3 * 2 + 2], -(x[0] * F[1] - x[1] * F[0]), 1e-8);
            check_below (fabs (r.step.reaction[3 * 3 + 2]), 1e-6);
            const pg_load *load = &r.problem->boundary.load[1];
            double sum = 0, centre = 0;
            for (size_t i = 0; i < load->set->npoint; i++) {
                const double *at = r.problem->cloud.x + 2 * (size_t) load->set->point[i];
                sum += load->share[i], centre += load->share[i] * at[1];
                if (cracked) assert_true (at[1] > 2.48);
            }
            check_relative (sum, 1, 1e-12);
            check_relative (centre, x[1], 1e-12);
            clear (&r);
        }
}

/* A column under its own weight: u = rho g (y L - y^2 / 2) / E, of two materials the weight of both. */
static void a_column_weighs (void **state)
{
    (void) state;
    for (int k = 0; k < METHODS; k++) {
        run r = scene_of (1, "dimension: 2\nthickness: 0.5\nbody: [{add: {box: {low: [0, 0], high: [1, "
                             "4]}}}]\n"
                             "spacing: 0.2\nmaterials:\n  light: {youngs_modulus: 1 GPa, poissons_ratio: "
                             "0.3333333333, density: "
                             "1000}\n  heavy: {youngs_modulus: 1 GPa, poissons_ratio: 0.3333333333, "
                             "density: 3000}\n"
                             "blocks: [{material: heavy, where: y < 2}, {material: light, where: y >= 2}]\n%s"
                             "boundary:\n  - {set: bottom, displacement: {y: 0}}\n  - {set: bottom, name: "
                             "pin, "
                             "displacement: {x: 0}}\n  - {gravity: [0, -10 m/s2], name: weight}\n",
                          methods[k]);
        to_the_end (&r);
        double weight = 0;
        for (size_t i = 0; i < r.problem->cloud.n; i++)
            weight += 10 * r.problem->cloud.volume[i]
                      * r.problem->material[r.problem->block[PG_NODES][i]].density;
        check_relative (r.step.reaction[1], -r.step.reaction[3 * 2 + 1], 1e-8);
        check_relative (r.step.reaction[1], k < 4 ? 40e3 : weight, k < 4 ? 0.03 : 1e-8);
        clear (&r);
    }
}

/* A spring in series with a bar: F = u / (1 / k + L / (E A)), both for a machine that yields and at rest. */
static double spring_error (const char *method, double spacing, double *balance)
{
    const double k = 2e8, EA = 10e9 * 0.1, u = 1e-3, want = u / (1 / k + 2 / EA);
    run r = scene_of (1, "dimension: 2\nthickness: 0.1\nbody: [{add: {box: {low: [1, 2], high: [3, "
                         "3]}}}]\nspacing: %g\n"
                         "materials: {rock: {youngs_modulus: 10 GPa, poissons_ratio: 0.3333333333333333}}\n%s"
                         "boundary:\n  - {set: left, symmetry: on}\n  - {set: bottom, symmetry: on}\n"
                         "  - {set: right, spring: {x: %g}, spring_end: {x: %g}}\n", spacing, method, k, u);
    to_the_end (&r);
    const pg_statistics *s = pg_solver_report (r.solver, r.state);
    *balance = fabs (s->energy.strain - s->energy.external) / s->energy.strain;
    check_relative (r.step.reaction[0], -r.step.reaction[3 * 2], 1e-8);
    double error = fabs (r.step.reaction[3 * 2] / want - 1);
    check_relative (s->energy.strain, 0.5 * r.step.reaction[3 * 2] * u, 1e-7);
    clear (&r);
    return error;
}

static void a_spring_in_series (void **state)
{
    (void) state;
    for (int k = 0; k < METHODS; k++) {
        double balance, coarse = spring_error (methods[k], 0.2, &balance),
                        fine = spring_error (methods[k], 0.1, &balance);
        check_below (balance, 1e-7);
        check_below (fine, k < 4 ? 2e-3 : 0.15);       /* bonds: the surface is softer */
        check_below (fine, 0.75 * coarse + 1e-9);
    }
}

/* What hangs in springs alone and is pushed: F / k. At a place as well as at a set. */
static void springs_alone_hold_a_body (void **state)
{
    (void) state;
    for (int k = 0; k < METHODS - 1; k++) {
        run r = scene_of (1, "%s%sboundary:\n  - {set: left, spring: {all: 1 MN/m}}\n"
                             "  - {at: [2, 2.5], spring: {x: 3 MN/m}}\n  - {gravity: [5 m/s2, 0]}\n"
                             "solver: {tolerance: 1e-7}\n", PLATE, methods[k]);
        to_the_end (&r);
        double F = r.step.reaction[3 * 2];
        check_relative (F, 2000 * 5 * 2 * 0.1, k == 3 || k == 5 ? 1e-2 : 1e-9);
        double *u = field_of (&r, NULL, "displacement", NULL), mean = 0;
        for (size_t i = 0; i < r.problem->cloud.n; i++) mean += u[2 * i] / (double) r.problem->cloud.n;
        check_relative (mean, F / 4e6, 2e-2);          /* the body itself is 400 times as stiff */
        check_relative (r.step.reaction[0] + r.step.reaction[3], -F, 1e-6);
        pg_free (u), clear (&r);
    }
}

/* Saint-Venant's torsion of a square bar: G 0.1406 a^4 theta / L. */
static double torque_error (double spacing)
{
    run r = scene_of (1, "dimension: 3\nbody: [{add: {box: {low: [-1, -1, 0], high: [1, 1, "
                         "4]}}}]\nspacing: %g\n"
                         "materials: {rock: {youngs_modulus: 10, poissons_ratio: 0.25}}\nboundary:\n"
                         "  - {set: back, turn: {z: 0}}\n  - {set: front, turn: {z: 0.01}}\n"
                         "  - {set: pin, displacement: {z: 0}, essential: penalty}\n"
                         "sets: {pin: {where: 'hypot (x, y) < 1e-3 and z < 1e-3'}}\n", spacing);
    to_the_end (&r);
    double want = 0.140577 * 4 * 16 * 0.01 / 4;        /* G = 4 */
    check_relative (r.step.reaction[3 * (3 + 1) + 2], -r.step.reaction[3 * 3 + 2], 1e-7);
    double error = fabs (r.step.reaction[3 * (3 + 1) + 2] / want - 1);
    clear (&r);
    return error;
}

static void a_square_bar_is_twisted (void **state)
{
    (void) state;
    double coarse = torque_error (0.5), middle = torque_error (1.0 / 3), fine = torque_error (0.25);
    check_below (fine, 6e-3);
    check_below (middle, 0.7 * coarse);
    check_below (fine, 0.7 * middle);
}

/* With finite stretch a turn is a rotation: a body that turns as a whole has no stretch, however far. */
static void finite_turns_are_rotations (void **state)
{
    (void) state;
    run r = scene_of (1, "%smethod: {force: bond, stretch: finite}\nboundary:\n  - {set: left, turn: {z: "
                         "30 deg}, about: [2, "
                         "2.5]}\nsolver: {kind: verlet, end: 1 us}\n", PLATE);
    const pg_load *load = &r.problem->boundary.load[0];
    double place[2] = { 3, 2.5 };
    assert_int_equal (load->finite, 1);
    check_relative (pg_load_value (load, 0, 2, place, 1e-6), cos (3.14159265358979323846 / 6) - 1, 1e-12);
    check_relative (pg_load_value (load, 1, 2, place, 1e-6), 0.5, 1e-12);
    clear (&r);
    r = scene_of (1, "%sboundary:\n  - {set: left, turn: {z: 30 deg}, about: [2, 2.5]}\n", PLATE);
    assert_int_equal (r.problem->boundary.load[0].finite, 0);
    check_relative (pg_load_value (&r.problem->boundary.load[0], 1, 2, place, 1), 3.14159265358979323846 / 6,
                    1e-12);
    assert_true (r.options.event);
    clear (&r);
}

/* A quarter of a plate with a hole, and all of it: the same displacement. */
static double quarter_error (const char *method, double spacing, int penalty)
{
    const char *head = "subtract: {disk: {center: [0, 0], radius: 1}}\n",
               *rock = "materials: {rock: {youngs_modulus: 1e5, poissons_ratio: 0.3333333333333333}}\n",
               *by = penalty ? ", essential: penalty" : "";
    run part = scene_of (1, "dimension: 2\nbody:\n  - add: {box: {low: [0, 0], high: [4, 4]}}\n  - "
                            "%sspacing: %g\n%s%s"
                            "boundary:\n  - {set: right, traction: {x: 1 Pa}}\n  - {set: left, symmetry: "
                            "on}\n"
                            "  - {set: bottom, symmetry: on}\n", head, spacing, rock, method),
        whole = scene_of (1, "dimension: 2\nbody:\n  - add: {box: {low: [-4, -4], high: [4, 4]}}\n  - "
                             "%sspacing: %g\n%s%s"
                             "boundary:\n  - {set: right, traction: {x: 1 Pa}}\n  - {set: left, traction: "
                             "{x: -1 Pa}}\n"
                             "  - {set: up, displacement: {x: 0}%s}\n  - {set: side, displacement: {y: "
                             "0}%s}\n"
                             "sets: {up: {where: 'abs (x) < 1e-3 and abs (y) > 3.9'}, side: {where: 'abs "
                             "(y) < 1e-3 and "
                             "abs (x) > 3.9'}}\n", head, spacing, rock, method, by, by);
    to_the_end (&part), to_the_end (&whole);
    double *u = field_of (&part, NULL, "displacement", NULL), *v = field_of (&whole, NULL, "displacement",
            NULL),
           off = 0, size = 0;
    size_t found = 0;
    for (size_t i = 0; i < part.problem->cloud.n; i++)
        for (size_t j = 0; j < whole.problem->cloud.n; j++) {
            const double *x = part.problem->cloud.x + 2 * i, *y = whole.problem->cloud.x + 2 * j;
            if (hypot (x[0] - y[0], x[1] - y[1]) > 1e-6) continue;
            off = fmax (off, hypot (u[2 * i] - v[2 * j], u[2 * i + 1] - v[2 * j + 1]));
            size = fmax (size, hypot (v[2 * j], v[2 * j + 1])), found++;
        }
    assert_int_equal (found, part.problem->cloud.n);
    pg_free (u), pg_free (v), clear (&part), clear (&whole);
    return off / size;
}

static void a_quarter_equals_the_whole (void **state)
{
    (void) state;
    check_below (quarter_error ("", 0.25, 1), 7e-3);
    check_below (quarter_error ("method: {essential: transformation}\n", 0.25, 1), 7e-3);
    check_below (quarter_error ("method: {integration: consistent}\n", 0.25, 1), 7e-3);
    /* what bonds miss across the plane is a layer, which goes with the spacing */
    double coarse = quarter_error ("method: {force: lps}\n", 0.25, 0),
           fine = quarter_error ("method: {force: lps}\n", 0.125, 0);
    check_below (fine, 0.13);
    check_below (fine, 0.6 * coarse);
}

/* Points with rotations turn about the normal of the plane alone: in the plane not at all. */
static void symmetry_holds_rotations (void **state)
{
    (void) state;
    run r = scene_of (1, "dimension: 2\nbody: [{add: {box: {low: [1, 2], high: [3, 3]}}}]\nspacing: 0.1\n"
                         "materials: {rock: {youngs_modulus: 10 GPa, poissons_ratio: 0.2}}\nmethod: "
                         "{force: gmpd}\n"
                         "boundary:\n  - {set: left, symmetry: on}\n  - {set: pin, displacement: {y: 0}}\n"
                         "  - {set: right, traction: {x: 1 MPa/m * (y - 2.5 m) + 0.1 MPa, y: 0.1 MPa}}\n"
                         "sets: {pin: {where: 'hypot (x - 1 m, y - 2.5 m) < 1e-3'}}\n");
    to_the_end (&r);
    double *w = field_of (&r, NULL, "rotation", NULL);
    for (size_t i = 0; i < r.problem->cloud.n; i++)
        assert_true ((w[i] == 0) == (r.problem->cloud.x[2 * i] < 1 + 1e-6));
    pg_free (w), clear (&r);
}

/* Nodal forces are what supports and loads exert; elsewhere they vanish at rest. */
static void nodal_forces_are_those_of_the_boundary (void **state)
{
    (void) state;
    for (int k = 0; k < METHODS - 1; k++) {
        run r = scene_of (1, "%s%sboundary:\n  - {set: left, displacement: {x: 0, y: 0}}\n  - {set: right, "
                             "force: {y: 3 kN}}\n",
                          PLATE, methods[k]);
        to_the_end (&r);
        double *f = field_of (&r, NULL, "nodal_force", NULL), pushed = 0, sum = 0, inside = 0;
        for (size_t i = 0; i < r.problem->cloud.n; i++) {
            double x = r.problem->cloud.x[2 * i];
            sum += f[2 * i + 1];
            if (x > 2) pushed += f[2 * i + 1];
            if (x > 1.7 && x < 2.3) inside = fmax (inside, fabs (f[2 * i + 1]));
        }
        check_relative (pushed, 3e3, 1e-7);
        check_below (fabs (sum), 1e-3);
        check_below (inside, 1e-3);
        pg_free (f), clear (&r);
    }
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (forces_and_moments_close),
        cmocka_unit_test (moments_are_about_the_centre),
        cmocka_unit_test (a_force_on_a_side_is_a_traction),
        cmocka_unit_test (a_force_at_a_place_is_exact),
        cmocka_unit_test (a_column_weighs),
        cmocka_unit_test (a_spring_in_series),
        cmocka_unit_test (springs_alone_hold_a_body),
        cmocka_unit_test (a_square_bar_is_twisted),
        cmocka_unit_test (finite_turns_are_rotations),
        cmocka_unit_test (a_quarter_equals_the_whole),
        cmocka_unit_test (symmetry_holds_rotations),
        cmocka_unit_test (nodal_forces_are_those_of_the_boundary),
    };
    return cmocka_run_group_tests (tests, NULL, NULL);
}
