/* SPDX-License-Identifier: GPL-3.0-or-later
 * Supports beside each other: contradictions are faults with both lines, equal values are fine; sets with an
 * inside are held in all their points; those by elimination are counted. */
#include "scene_runs/run.h"

#define PLATE \
    "dimension: 2\nthickness: 1 m\nbody: [{add: {box: {low: [0, 0], high: [1 m, 1 m]}}}]\nspacing: 0.1 " \
    "m\nmaterials: {m: {youngs_modulus: 1 GPa, poissons_ratio: 0.3333333333333333}}\n"
#define BLOCK \
    "dimension: 3\nbody: [{add: {box: {low: [0, 0, 0], high: [1 m, 1 m, 1 m]}}}]\nspacing: 0.25 " \
    "m\nmaterials: {m: {youngs_modulus: 1 GPa, poissons_ratio: 0.25}}\n"

/* "": no fault */
static void said (const char *text, const char *part)
{
    pg_scene *scene;
    pg_problem *problem = NULL;
    check_ok (pg_scene_parse (&scene, text, "test.yaml"));
    pg_status status = pg_problem_build (&problem, scene, 1);
    if (status != (*part ? PG_E_SCENE : PG_OK))
        print_error ("%s\n%s\n", text, status == PG_OK ? "no fault" : pg_last_error ());
    assert_int_equal (status, *part ? PG_E_SCENE : PG_OK);
    if (*part) check_contains (pg_last_error (), part);
    pg_problem_free (&problem);
    pg_scene_free (&scene);
}

static void two_values_for_one_set_are_a_fault_with_both_lines (void **state)
{
    (void) state;
    static const char *const methods[] = {
        "", "method: {essential: transformation}\n", "method: {essential: penalty}\n",
        "method: {force: bond, horizon: 3 spacing}\n",
        "method: {approximation: nosb, integration: nodal, horizon: 2.5 spacing}\n"
    };
    char text[2048];
    for (int m = 0; m < 5; m++) {
#define SAID(loads, part) \
    (snprintf (text, sizeof text, PLATE "%sboundary:\n%s", methods[m], loads), said (text, part))
        int line = m ? 8 : 7;
        char both[200];
        snprintf (both, sizeof both,
                  "test.yaml:%d:31: boundary[1].displacement.x = 1 mm: contradicts "
                  "boundary[0].displacement.x (line %d): %s of left belong to left too",
                  line + 1, line, m ? "11 points" : "10 facets");
        SAID (" - {set: left, displacement: {x: 0, y: 0}}\n - {set: left, displacement: {x: 1 mm}}\n", both);
        SAID (" - {set: left, displacement: {x: 0}}\n - {set: left, displacement: {x: 1 mm}}\n",
              "is moved by 0 m there, by 0.001 m here");
        SAID (" - {set: left, displacement: {x: 0}}\n - {set: left, displacement: {y: 1 mm}}\n", "");
        SAID (" - {set: left, displacement: {x: 1 mm}}\n - {set: left, displacement: {x: 1e-3}}\n", "");
        SAID (" - {set: left, displacement: {x: '1e-3*(x + y)'}}\n - {set: bottom, displacement: {x: "
              "'1e-3*(y + x)'}}\n",
              "");
        /* equal at the end only */
        SAID (" - {set: left, displacement: {x: 1 mm}}\n - {set: left, displacement: {x: 1 mm}, table: [[0, "
              "0], [0.5, 2], [1, 1]]}\n",
              "contradicts");
        SAID (" - {set: left, displacement: {x: 1 mm}}\n - {set: left, traction: {x: 1 MPa}}\n", "");
        SAID (" - {set: left, displacement: {x: 0}}\n - {set: strip, displacement: {x: 1 mm}}\nsets: {strip: "
              "{where: x < 0.25 m}}\n",
              "contradicts boundary[0]");
        SAID (" - {set: strip, displacement: {x: 1 mm}}\n - {set: all, displacement: {x: 0}}\nsets: {strip: "
              "{where: x < 0.25 m}}\n",
              "contradicts boundary[0]");
    }
}

/* At a corner: points cannot be in two places, and the run says which one they are at; a weak form bears
 * it. */
static void sets_that_share_a_corner (void **state)
{
    (void) state;
    static const char *const methods[] = { "", "method: {essential: transformation}\n",
                                           "method: {essential: penalty}\n",
                                           "method: {force: bond, horizon: 3 spacing}\n" };
    char text[2048];
    for (int m = 0; m < 4; m++) {
        run r = scene_of (1,
                          PLATE "%sboundary:\n - {set: left, displacement: {x: 0, y: 0}}\n - {set: top, "
                                "displacement: {x: 1 mm}}\n",
                          methods[m]);
        const pg_statistics *report = pg_solver_report_now (r.solver);
        int told = 0;
        for (size_t k = 0; k < report->nwarning; k++)
            told |= strcmp (report->warning[k],
                            "1 point of top, such as (0, 1) m, belongs to left too, which moves them by 0 m, "
                            "not 0.001: boundary[0].displacement.x comes first and holds them")
                    == 0;
        assert_int_equal (told, m > 0);
        clear (&r);
    }
    run weak = scene_of (1, PLATE
                         "sets: {strip: {where: y > 0.85 m}}\nboundary:\n - {set: left, displacement: {x: 0, "
                         "y: 0}}\n - {set: strip, essential: penalty, displacement: {x: 1 mm}}\n");
    /* the face is held weakly: its corner goes with the points */
    const pg_statistics *now = pg_solver_report_now (weak.solver);
    for (size_t k = 0; k < now->nwarning; k++) assert_null (strstr (now->warning[k], "belong to left too"));
    clear (&weak);
    snprintf (text, sizeof text,
              PLATE "sets: {pin: {where: x < 0.01 m and y > 0.99 m}}\nboundary:\n - {set: left, "
                    "displacement: {x: 0}}\n - {set: pin, displacement: {x: 1 mm}}\n");
    said (text, "1 point of pin belongs to left too");
}

static void solids_and_motions_are_looked_at_alike (void **state)
{
    (void) state;
    said (BLOCK "boundary:\n - {set: left, displacement: {x: 0, z: 1 mm}}\n - {set: left, displacement: {x: "
                "0, z: 2 mm}}\n",
          "boundary[1].displacement.z = 2 mm: contradicts boundary[0].displacement.z (line 6)");
    said (BLOCK "method: {force: gmpd, horizon: 3 spacing}\nboundary:\n - {set: left, rotation: {x: 0, z: "
                "1e-3}}\n - {set: left, rotation: {z: 2e-3}}\n",
          "by 0.001 rad there, by 0.002 rad here");
    said (BLOCK "method: {force: gmpd, horizon: 3 spacing}\nboundary:\n - {set: left, rotation: {x: 1e-3}}\n "
                "- {set: left, displacement: {x: 2e-3}}\n",
          "");
    said ("dimension: 2\nthickness: 1 m\nbody: [{add: {box: {low: [0, 0], high: [1 m, 1 m]}}}]\nspacing: 0.1 "
          "m\nmaterials: {m: {youngs_modulus: 1 GPa, poissons_ratio: 0.3, density: 2500 kg/m3}}\n"
          "boundary:\n - {set: left, velocity: {x: 1 m/s}}\n - {set: left, displacement: {x: 1 mm}, ramp: "
          "linear}\nsolver: {kind: newmark, dt: 1 us, end: 1 ms}\n",
          "");
    said ("dimension: 2\nthickness: 1 m\nbody: [{add: {box: {low: [0, 0], high: [1 m, 1 m]}}}]\nspacing: 0.1 "
          "m\nmaterials: {m: {youngs_modulus: 1 GPa, poissons_ratio: 0.3, density: 2500 kg/m3}}\n"
          "boundary:\n - {set: left, velocity: {x: 1 m/s}}\n - {set: left, displacement: {x: 1 mm}, ramp: "
          "linear}\nsolver: {kind: newmark, dt: 1 us, end: 2 ms}\n",
          "contradicts boundary[0].velocity.x");
}

static double field_largest (const run *r)
{
    double *u = field_of (r, NULL, "displacement", NULL), top = largest_of (u, 2 * r->problem->cloud.n);
    pg_free (u);
    return top;
}

/* ---- sets with an inside ------------------------------------------------------------------------------- */
/* Force of a plate between rigid grips 0.5 m wide, 1 mm apart, N. */
static double grips (int dim, double spacing, const char *method, const char *solver, const char *essential)
{
    run r = scene_of (
        1,
        "dimension: %d\n%sbody: [{add: {box: {low: [0, 0%s], high: [1 m, 3 m%s]}}}]\nspacing: %.17g "
        "m\nmaterials: {m: {youngs_modulus: 1 GPa, poissons_ratio: 0.3, density: 2500 kg/m3}}\n"
        "sets: {low: {where: y < 0.501 m}, high: {where: y > 2.499 m}}\n%sboundary:\n - {set: low, "
        "%sdisplacement: {x: 0, y: 0%s}}\n - {set: high, %sdisplacement: {x: 0, y: 1 mm%s}}\n"
        "%soutput: {at: {levels: 1}}\n",
        dim, dim == 2 ? "thickness: 1 m\n" : "", dim == 3 ? ", 0" : "", dim == 3 ? ", 1 m" : "", spacing,
        method, essential, dim == 3 ? ", z: 0" : "", essential, dim == 3 ? ", z: 0" : "", solver);
    to_the_end (&r);
    double force = r.step.reaction[4], other = r.step.reaction[1];
    if (!*solver) check_scaled (other, -force, 1e-6, force);
    double *u = field_of (&r, NULL, "displacement", NULL), off = 0;
    for (size_t i = 0; i < r.problem->cloud.n; i++) {
        double y = r.problem->cloud.x[(size_t) dim * i + 1], goal = y < 0.501 ? 0 : y > 2.499 ? 1e-3 : NAN;
        for (int k = 0; k < dim && !isnan (goal); k++)
            off = fmax (off, fabs (u[(size_t) dim * i + (size_t) k] - (k == 1) * goal));
    }
    check_below (off, 1e-8);
    pg_free (u);
    clear (&r);
    return force;
}

static void wide_grips_are_held_in_all_their_points (void **state)
{
    (void) state;
    static const struct { const char *method; double first;
    } methods[] = {
        { "", 0.008 },
        { "method: {integration: consistent}\n", 0.008 },
        { "method: {integration: nodal}\n", 0.01 },
        { "method: {approximation: pddo}\n", 0.011 },
        { "method: {basis: quadratic, horizon: 3 spacing}\n", 0.014 },
    };
    const double clamped = 506198;  /* the 2 m between them, clamped: quadratic basis at 1/64 m */
    for (int m = 0; m < 5; m++) {
        double coarse = grips (2, 0.1, methods[m].method, "", "") / clamped - 1,
               fine = grips (2, 0.05, methods[m].method, "", "") / clamped - 1;
        print_message ("grips, %s: %+.2e, %+.2e\n", methods[m].method, coarse, fine);
        check_below (fabs (coarse), methods[m].first);
        /* the first free row lies a part of a spacing off */
        check_below (fabs (fine), 0.65 * fabs (coarse));
    }
    check_relative (grips (3, 0.25, "", "", ""), grips (3, 0.25, "", "", "essential: transformation, "),
                    1e-5);
}

static void forces_are_those_of_penalty_on_every_point (void **state)
{
    (void) state;
    assert_true (grips (2, 0.1, "", "", "") == grips (2, 0.1, "", "", "essential: penalty, "));
    check_relative (grips (2, 0.1, "", "", "essential: transformation, "),
                    grips (2, 0.1, "", "", "essential: penalty, "), 1e-5);
}

/* Asked for by name, nitsche holds the facets of a grip only: the rest of it may strain, which is told. */
static void grips_held_by_their_facets_only_are_told (void **state)
{
    (void) state;
    static const char *const hows[] = { "", ", essential: penalty", ", essential: transformation",
                                        ", essential: nitsche" };
    for (int k = 0; k < 4; k++) {
        run r = scene_of (1,
                          PLATE
                          "sets: {low: {where: y < 0.35}}\nboundary: [{name: grip, set: low, displacement: "
                          "{x: 0, y: 0}%s}, {set: top, displacement: {y: 1 mm}, essential: nitsche}]\n",
                          hows[k]);
        const pg_statistics *report = pg_solver_report_now (r.solver);
        int told = 0;
        for (size_t w = 0; w < report->nwarning; w++)
            told +=
                strncmp (
                    report->warning[w],
                    "grip: essential: nitsche holds the 16 facets of low and leaves free 27 of its points",
                    84)
                == 0;
        assert_int_equal (told, k == 3);
        clear (&r);
    }
}

static void a_body_held_everywhere_is_told (void **state)
{
    (void) state;
    static const char *const loads[] = {
        "{set: all, displacement: {x: 1e-3*x, y: 0}}",
        "{set: all, essential: nitsche, displacement: {x: 1e-3*x, y: 0}}",
        "{set: skin, displacement: {x: 1e-3*x, y: 0}}",
        "{set: all, displacement: {x: 1e-3*x}}, {set: bottom, displacement: {y: 0}}"
    };
    for (int k = 0; k < 4; k++) {
        run r = scene_of (1, PLATE "sets: {skin: {boundary: all}}\nboundary: [%s]\n", loads[k]);
        const pg_statistics *report = pg_solver_report_now (r.solver);
        int told = 0;
        for (size_t w = 0; w < report->nwarning; w++)
            told |= strstr (report->warning[w], "nothing is left to solve") != NULL;
        assert_int_equal (told, k == 0);
        to_the_end (&r);
        check_relative (field_largest (&r), 1e-3, 1e-4);
        clear (&r);
    }
}

/* Faces have no inside; points of a set without facets are eliminated as before. */
static void sides_and_boundaries_have_no_inside (void **state)
{
    (void) state;
    run r = scene_of (1, PLATE "sets: {jaw: {boundary: all, angle: [[40 deg, 95 deg]]}, row: {where: abs(y - "
                               "0.5) < 0.01}, core: {where: 'max(abs(x - 0.5), abs(y - 0.5)) < 0.26'}}\n"
                               "boundary:\n - {set: left, displacement: {x: 0}}\n - {set: jaw, displacement: "
                               "{y: 0}}\n - {set: core, displacement: {x: 1 mm}}\n");
    assert_int_equal (pg_sets_find (&r.problem->sets, "left")->ninner, 0);
    assert_int_equal (pg_sets_find (&r.problem->sets, "jaw")->ninner, 0);
    assert_int_equal (pg_sets_find (&r.problem->sets, "all")->ninner, 81);
    assert_int_equal (r.problem->boundary.load[0].essential, PG_ESSENTIAL_NITSCHE);
    assert_int_equal (r.problem->boundary.load[1].essential, PG_ESSENTIAL_NITSCHE);
    assert_int_equal (r.problem->boundary.load[2].essential, PG_ESSENTIAL_TRANSFORMATION);
    clear (&r);
}

static void too_many_points_to_eliminate_are_told (void **state)
{
    (void) state;
    static const char *const big =
        "dimension: 2\nthickness: 1 m\nbody: [{add: {box: {low: [0, 0], high: [1 m, 1 m]}}}]\nspacing: 0.011 "
        "m\nmaterials: {m: {youngs_modulus: 1 GPa, poissons_ratio: 0.3}}\n"
        "sets: {grip: {where: 'max(abs(x - 0.5), abs(y - 0.5)) < 0.45'}}\n%sboundary:\n - {set: grip, "
        "displacement: {x: 0, y: 0}}\n - {set: right, traction: {x: 1 MPa}}\n";
    char text[1024];
    snprintf (text, sizeof text, big, "method: {essential: transformation}\n");
    said (text, "boundary[0].set = grip: essential: transformation would eliminate 6724 points along x, at "
                "most 6000: its matrices are full. Take essential: penalty");
    snprintf (text, sizeof text,
              "dimension: 2\nthickness: 1 m\nbody: [{add: {box: {low: [0, 0], high: [1 m, 1 m]}}}]\nspacing: "
              "0.011 m\nmaterials: {m: {youngs_modulus: 1 GPa, poissons_ratio: 0.3}}\n"
              "sets: {low: {where: 'y < 0.35'}, high: {where: 'y > 0.6'}}\nmethod: {essential: "
              "transformation}\nboundary:\n - {set: low, displacement: {x: 0}}\n - {set: high, displacement: "
              "{x: 1e-3, y: 0}}\n");
    /* two supports, of 2944 and 3404 */
    said (text, "boundary[1].set = high: essential: transformation would eliminate 6348 points along x");
    run r = scene_of (1, big, "");
    assert_int_equal (r.problem->boundary.load[0].essential, PG_ESSENTIAL_PENALTY);
    clear (&r);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (two_values_for_one_set_are_a_fault_with_both_lines),
        cmocka_unit_test (sets_that_share_a_corner),
        cmocka_unit_test (solids_and_motions_are_looked_at_alike),
        cmocka_unit_test (wide_grips_are_held_in_all_their_points),
        cmocka_unit_test (forces_are_those_of_penalty_on_every_point),
        cmocka_unit_test (grips_held_by_their_facets_only_are_told),
        cmocka_unit_test (a_body_held_everywhere_is_told),
        cmocka_unit_test (sides_and_boundaries_have_no_inside),
        cmocka_unit_test (too_many_points_to_eliminate_are_told),
    };
    return cmocka_run_group_tests_name ("mechanics/model/supports", tests, NULL, NULL);
}
