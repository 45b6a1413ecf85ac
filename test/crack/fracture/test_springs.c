/* SPDX-License-Identifier: GPL-3.0-or-later
 * Springs on points around a tip, against what growth of the crack makes of the energy of body and springs:
 * under forces J is what the work of the forces gains per length of crack, under springs whose ends move
 * what the energy loses. Springs far too soft to matter change nothing. */
#include <math.h>
#include "first_tip.h"

static const double h = 1.0 / 40, thickness = 0.3;

/* Of the lattice, in spacings; [0.3, 0.5] puts points on the crack, where none sees another. */
static const char *offset = "[0.3, 0.4]";

typedef struct { double J, K[2], uncertainty, work; } answer;

/* An edge crack of length a in a plate 40 spacings wide and twice as high (short: a fifth higher). */
static answer edge (double a, const char *method, const char *boundary)
{
    run r = scene_of (1,
                      "dimension: 2\nplane: stress\nthickness: %g\nbody: [{add: {box: {low: [0, %g], high: "
                      "[1, %g]}}}]\nspacing: %.17g\nlattice: cells\nlattice_offset: %s\n"
                      "cracks: [{from: [-0.1, 0], to: [%.17g, 0]}]\n"
                      "materials: {m: {youngs_modulus: 7, poissons_ratio: 0.3}}\nmethod: {%s}\n"
                      "sets: {pin: {where: x > %.17g and abs(y) < %.17g}, beyond: {where: x > 0.45}}\n"
                      "boundary: [%s, {set: pin, displacement: {x: 0, y: 0}, essential: penalty}]\n"
                      "solver: {kind: static}\noutput: {at: {levels: 1}}\n",
                      thickness, longer () ? -1 : -0.6, longer () ? 1 : 0.6, h, offset, a, method,
                      1 - 1.01 * h, 1.01 * h, boundary);
    answer out;
    const double one = 1;
    to_the_end (&r);
    pg_tip_field f = first_tip (&r);
    out = (answer){ f.J[0][0], { f.K_wide[0][0], f.K_wide[1][0] }, pg_tip_uncertainty (&f, 1, &one),
                    pg_solver_report_now (r.solver)->energy.external };
    clear (&r);
    return out;
}

#define TENSION "{set: top, traction: {y: 1}}, {set: bottom, traction: {y: -1}}"

/* J of an edge crack among bonds, on a row of points, whose plate is pulled and turned by an angle. */
static double turned (double angle)
{
    run r = scene_of (1,
                      "dimension: 2\nplane: stress\nthickness: 1\nspacing: 0.1\nlattice: nodes\n"
                      "body: [{add: {box: {low: [0, -0.5], high: [1, 0.5]}}}, "
                      "{subtract: {box: {low: [0.5, 0], high: [1.1, 0.6]}}}]\n"
                      "cracks: [{from: [-0.1, 0], to: [0.35, 0]}]\n"
                      "materials: {m: {youngs_modulus: 7, poissons_ratio: 0.3333333333333333}}\n"
                      "method: {force: bond, accept_inexact: yes}\nboundary:\n"
                      "  - {set: bottom, displacement: {x: \"%g*y\", y: \"%g*x\"}}\n"
                      "  - {set: top, displacement: {x: \"%g*y\", y: \"1e-3 m + %g*x\"}}\n"
                      "solver: {kind: static}\noutput: {at: {levels: 1}}\n", -angle, angle, -angle, angle);
    to_the_end (&r);
    pg_tip_field f = first_tip (&r);
    clear (&r);
    return f.J[0][0];
}

/* Points on a crack see no other one and stay where they are; what moves around them is no less rigid. */
static void points_alone_do_not_count (void **state)
{
    (void) state;
    double J = turned (0);
    assert_true (J > 0);
    check_relative (turned (0.05), J, 1e-9);
}

/* Beds as stiff as the body: on all points, on those of one side that begins within the ring, at one place
 * 3.2 spacings from the tip, and a bed that pulls. sign: of the energy's change with the length. */
static void energy_of_springs_is_in_J (void **state)
{
    static const struct { const char *name, *boundary; double sign; } scene[] = {
        { "bed on all", TENSION ", {set: all, spring: {all: 30}}", 1 },
        { "bed on the right half", TENSION ", {set: beyond, spring: {y: 15}}", 1 },
        { "one place", TENSION ", {at: [0.56, 0.105], spring: {all: 0.5}}", 1 },
        { "bed whose ends move",
          "{set: all, spring: {all: 30}, spring_end: {x: 0, y: 0.1 * y}}", -1 },
    };
    (void) state;
    for (size_t k = 0; k < sizeof scene / sizeof *scene; k++) {
        answer at = edge (0.5, "", scene[k].boundary), less = edge (0.5 - h, "", scene[k].boundary),
               more = edge (0.5 + h, "", scene[k].boundary);
        double J = scene[k].sign * (more.work - less.work) / (2 * h * thickness);
        print_message ("%-24s J %.6g, of the energy %.6g (%+.2f %%), K %.4g %.4g: E' J / K^2 %.4f\n",
            scene[k].name,
                       at.J, J, 100 * (at.J / J - 1), at.K[0], at.K[1],
                       7 * at.J / (at.K[0] * at.K[0] + at.K[1] * at.K[1]));
        check_relative (at.J, J, 0.02);
        check_relative (7 * at.J, at.K[0] * at.K[0] + at.K[1] * at.K[1], 0.02);
    }
}

static void soft_springs_do_nothing (void **state)
{
    static const char *const method[] = { "", "force: bond" };
    (void) state;
    for (int k = 0; k < 4; k++) {
        offset = k < 2 ? "[0.3, 0.4]" : "[0.3, 0.5]";
        answer free = edge (0.5, method[k % 2], TENSION),
               held = edge (0.5, method[k % 2], TENSION ", {set: all, spring: {all: 1e-9}}");
        check_relative (held.J, free.J, 1e-6);
        check_relative (held.K[0], free.K[0], 1e-6);
    }
    offset = "[0.3, 0.4]";
}

/* ---- in space ------------------------------------------------------------------------------------------ */
/* A round crack of radius a spacings in the middle of a plate, in tension; J: mean over the front. */
static answer round_crack (double a, const char *boundary)
{
    run r = scene_of (1,
                      "dimension: 3\nbody: [{add: {box: {low: [-7, -7, -5], high: [7, 7, 5]}}}]\nspacing: 1\n"
                      "lattice: cells\ncracks: [{disc: {center: [0, 0, 0], normal: [0, 0, 1], radius: "
                      "%.17g}}]\n"
                      "materials: {m: {youngs_modulus: 7, poissons_ratio: 0.25}}\n"
                      "sets: {pin: {where: 'abs (z) < 1 and abs (x) > 6'}}\n"
                      "boundary: [{set: front, traction: {z: 1}}, {set: back, traction: {z: -1}}, %s "
                      "{set: pin, displacement: {x: 0, y: 0, z: 0}, essential: penalty}]\n"
                      "solver: {kind: static}\noutput: {at: {levels: 1}}\n",
                      a, boundary);
    void *self;
    answer out = { 0 };
    const double one = 1, *d;
    to_the_end (&r);
    d = r.state->d;
    const pg_force_type *force = pg_solver_force (r.solver, &self);
    size_t n = r.problem->crack.front[0].n;
    pg_tip_field *f = pg_calloc (n, sizeof *f);
    check_ok (pg_front_measure (f, r.problem, force, self, r.state, 0, 1, &d, &one, NULL));
    for (size_t i = 0; i < n; i++) {
        assert_true (f[i].wide > 2);                  /* springs end no tube */
        out.J += f[i].J[0][0] / (double) n, out.K[0] += f[i].K[0][0] / (double) n;
    }
    out.work = pg_solver_report_now (r.solver)->energy.external;
    pg_free (f);
    clear (&r);
    return out;
}

/* PERIGAL_TEST_SIZE=long: the same share of what the energy gains as without springs. */
static void fronts_know_springs (void **state)
{
    const char *bed = "{set: all, spring: {all: 200}},";
    answer free = round_crack (3.5, ""), held = round_crack (3.5, bed),
           soft = round_crack (3.5, "{set: all, spring: {all: 1e-6}},");
    (void) state;
    print_message ("J %.6g, with a bed %.6g, E' J / K^2 %.4f, %.4f\n", free.J, held.J,
                   7 / (1 - 0.0625) * free.J / (free.K[0] * free.K[0]),
                   7 / (1 - 0.0625) * held.J / (held.K[0] * held.K[0]));
    check_relative (soft.J, free.J, 1e-5);
    check_relative (held.J / (held.K[0] * held.K[0]), free.J / (free.K[0] * free.K[0]), 0.03);
    check_below (held.J, 0.7 * free.J);
    if (!longer ()) return;
    double share[2] = { 0 };
    for (int k = 0; k < 2; k++)
        share[k] = (round_crack (4, k ? bed : "").work - round_crack (3, k ? bed : "").work)
                   / (k ? held.J : free.J);
    print_message ("energy gained over J: %.4f, with a bed %.4f\n", share[0], share[1]);
    check_relative (share[1], share[0], 0.03);
}

int main (void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test (energy_of_springs_is_in_J),
                                        cmocka_unit_test (soft_springs_do_nothing),
                                        cmocka_unit_test (points_alone_do_not_count),
                                        cmocka_unit_test (fronts_know_springs) };
    return cmocka_run_group_tests_name ("crack/fracture/springs", tests, NULL, NULL);
}
