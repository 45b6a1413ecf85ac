/* SPDX-License-Identifier: GPL-3.0-or-later
 * Facets behind a kink, whole runs: load and ratio of K_II to K_I against linear elastic fracture mechanics
 * on the path of the run (finite elements, bench/kinks.py; make fracture T=kinks has all bodies and
 * lattices), and what must not change them: how a load is divided, a second name of the material. */
#include "run.h"

#define GLASS "glass: {youngs_modulus: 70 GPa, poissons_ratio: 0.22}"
#define HEAD "dimension: 2\nplane: stress\nlattice: cells\nfailure: {criterion: energy_release, " \
             "fracture_energy: 8 J/m2}\nmethod: {integration: %s}\n"
#define NOTCH HEAD "body: [{add: {box: {low: [0, -50 mm], high: [100 mm, 50 mm]}}}]\nspacing: 5 mm\n" \
    "cracks: [{from: [-20 mm, 0], to: [50 mm, 0]}]\n%s" \
    "boundary:\n" \
    "  - {set: bottom, displacement: {x: 0, y: 0}}\n  - {set: top, displacement: {x: 30 um, y: 0}}\n" \
    "  - {set: left, displacement: {y: 0}}\n  - {set: right, displacement: {y: 0}}\n" \
    "solver: {kind: static, stepping: event, max_events: %d}\n"
#define ONE "materials: {" GLASS "}\n"

/* Load factor of event k, K_II / K_I and the uncertainty of the tip then. */
typedef struct { size_t n; double factor[8], ratio[8], off[8], tip[2]; } seen;

static seen follow (run *r, long tip)
{
    seen s = { 0 };
    while (!pg_solver_done (r->solver, r->state)) {
        advance (r);
        if (!r->step.event || s.n == 8) continue;
        const pg_tip_values *v = pg_solver_tip (r->solver, tip);
        s.factor[s.n] = r->step.factor, s.ratio[s.n] = v->K[1] / v->K[0], s.off[s.n++] = v->uncertainty;
    }
    memcpy (s.tip, r->state->paths->tip[tip - 1].x, sizeof s.tip);
    return s;
}

/* A notch in shear whose crack kinks by 70.5 degrees. The second facet needed 12 % too much, and its K_II /
 * K_I was .34. */
static void loads_behind_a_kink_are_those_of_fracture_mechanics (void **state)
{
    (void) state;
    static const char *const integration[] = { "gauss", "consistent" };
    static const double factor[] = { 0.2421, 0.2560, 0.2664, 0.2749 },
                        ratio[] = { 0.046, -0.003, 0.004, 0.005 };
    for (int i = 0; i < 2; i++) {
        run r = scene_of (1, NOTCH, integration[i], ONE, 5);
        seen s = follow (&r, 1);
        assert_int_equal (s.n, 5);
        for (int k = 0; k < 4; k++) {
            print_message ("%s, facet %d: load %.4f of the reference, K_II / K_I %.3f\n", integration[i],
                           k + 2, s.factor[k + 1] / factor[k], s.ratio[k + 1]);
            check_relative (s.factor[k + 1], factor[k], 0.02);
            check_absolute (s.ratio[k + 1], ratio[k], k ? 0.05 : 0.03);
            check_below (s.off[k + 1], 0.05);          /* two rings */
        }
        clear (&r);
    }
}

/* The same glass under two names, one of them four spacings away. */
static void a_second_name_of_the_material_changes_nothing (void **state)
{
    (void) state;
    run r = scene_of (1, NOTCH, "gauss", ONE, 3), two = scene_of (1, NOTCH, "gauss",
        "materials: {" GLASS ", other: {youngs_modulus: 70 GPa, poissons_ratio: 0.22}}\n"
        "blocks: [{material: glass, where: \"x == x\"}, {material: other, where: \"y > 20 mm\"}]\n", 3);
    seen a = follow (&r, 1), b = follow (&two, 1);
    assert_int_equal (a.n, b.n);
    for (size_t k = 0; k < a.n; k++) check_relative (b.factor[k], a.factor[k], 1e-9);
    check_relative (b.tip[0], a.tip[0], 1e-9), check_relative (b.tip[1], a.tip[1], 1e-9);
    clear (&r), clear (&two);
}

#define PLATE HEAD "body: [{add: {box: {low: [-30 mm, -30 mm], high: [30 mm, 30 mm]}}}]\nspacing: 2 mm\n" \
    "cracks: [{from: [-7.07 mm, -7.07 mm], to: [7.07 mm, 7.07 mm]}]\n" ONE \
    "sets: {pin: {where: \"hypot (x + 29 mm, y) < 2.1 mm\"}}\nboundary:\n%s" \
    "  - {set: pin, displacement: {x: 0, y: 0}, essential: penalty}\n" \
    "solver: {kind: static, stepping: event, max_events: 3}\n"
#define PULL(y, more) "  - {set: bottom, traction: {y: -" #y " MPa}" more "}\n" \
    "  - {set: top, traction: {y: " #y " MPa}" more "}\n"

/* A tenth of the full load that is there from the start takes a tenth off every load factor. */
static void loads_in_two_parts_are_one (void **state)
{
    (void) state;
    run r = scene_of (1, PLATE, "gauss", PULL (10, "")),
        two = scene_of (1, PLATE, "gauss", PULL (10, "") PULL (1, ", ramp: constant"));
    seen a = follow (&r, 1), b = follow (&two, 1);
    assert_int_equal (a.n, b.n);
    for (size_t k = 0; k < a.n; k++) {
        check_absolute (b.factor[k] + 0.1, a.factor[k], 1e-6);
        check_absolute (b.ratio[k], a.ratio[k], 1e-6);
    }
    check_relative (b.tip[0], a.tip[0], 1e-6), check_relative (b.tip[1], a.tip[1], 1e-6);
    clear (&r), clear (&two);
}

/* A crack that cuts only up to four spacings behind its tip: rings of 3 and 8 spacings do not agree. */
static void a_release_that_is_not_known_is_told (void **state)
{
    (void) state;
    for (int wrong = 0; wrong < 2; wrong++) {
        run r = scene_of (1, PLATE, wrong ? "gauss, tip_offset: 4 spacing" : "gauss", PULL (10, ""));
        advance (&r);
        while (!pg_solver_done (r.solver, r.state) && !r.step.event) advance (&r);
        const pg_statistics *report = pg_solver_report_now (r.solver);
        int told = 0;
        for (size_t k = 0; k < report->nwarning; k++)
            told |= strstr (report->warning[k], "energy release rate of crack tip") != NULL;
        assert_int_equal (told, wrong);
        clear (&r);
    }
}

/* In space the next strips behind a sharp turn are not known well: said when a straight front in shear turns
 * by 70 degrees, and not of one that goes straight on. */
static void a_front_that_turns_is_told (void **state)
{
    (void) state;
    for (int turns = 0; turns < 2; turns++) {
        run r = scene_of (1, "dimension: 3\nlattice: cells\nspacing: 10 mm\nmaterials: {" GLASS "}\n"
            "failure: {criterion: energy_release, fracture_energy: 8 J/m2}\n"
            "body: [{add: {box: {low: [0, -60 mm, 0], high: [120 mm, 60 mm, 40 mm]}}}]\n"
            "cracks: [{polygon: [[-20 mm, 0, -9 mm], [60 mm, 0, -9 mm], [60 mm, 0, 49 mm], "
            "[-20 mm, 0, 49 mm]]}]\n"
            "boundary:\n  - {set: bottom, displacement: {x: 0, y: 0, z: 0}}\n"
            "  - {set: top, displacement: {x: %s, y: %s, z: 0}}\n"
            "solver: {kind: static, stepping: event, max_events: 1}\n",
            turns ? "60 um" : "0", turns ? "0" : "60 um");
        to_the_end (&r);
        const pg_statistics *report = pg_solver_report_now (r.solver);
        int told = 0;
        for (size_t k = 0; k < report->nwarning; k++) told |= strstr (report->warning[k], "turns by") != NULL;
        assert_int_equal (r.state->events, 1);
        assert_int_equal (told, turns);
        clear (&r);
    }
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (loads_behind_a_kink_are_those_of_fracture_mechanics),
        cmocka_unit_test (a_second_name_of_the_material_changes_nothing),
        cmocka_unit_test (loads_in_two_parts_are_one),
        cmocka_unit_test (a_release_that_is_not_known_is_told),
        cmocka_unit_test (a_front_that_turns_is_told)
    };
    return cmocka_run_group_tests_name ("scene_runs/kinks", tests, NULL, NULL);
}
