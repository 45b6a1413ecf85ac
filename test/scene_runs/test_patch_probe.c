/* SPDX-License-Identifier: GPL-3.0-or-later
 * What every run says of its own discretisation (pg_patch_probe) against what uniform tension then comes out
 * as. */
#define _DEFAULT_SOURCE                                 /* mkstemp */
#include "run.h"
#include <unistd.h>

/* of the patch error over that of the run */
typedef struct { const char *method, *more; int dim; double spacing, size[3], least, most; } tension;

/* Uniform tension along x on rollers, of length `unit` m a side. */
static pg_scene *scene_for (const tension *c, double unit, const char *more)
{
    static const char *const side[] = { "left", "bottom", "back" };
    pg_scene *scene = NULL;
    char text[2048];
    int at = snprintf (text, sizeof text, "dimension: %d\nspacing: %.17g\nbody: [{add: {box: {low: [", c->dim,
                       c->spacing * unit);
    for (int k = 0; k < c->dim; k++)
        at += snprintf (text + at, sizeof text - (size_t) at, "%s0", k ? ", " : "");
    at += snprintf (text + at, sizeof text - (size_t) at, "], high: [");
    for (int k = 0; k < c->dim; k++)
        at += snprintf (text + at, sizeof text - (size_t) at, "%s%.17g", k ? ", " : "", c->size[k] * unit);
    at += snprintf (
        text + at, sizeof text - (size_t) at,
        "]}}}]\n%smaterials: {m: {youngs_modulus: 1 GPa, poissons_ratio: %s}}\nmethod: {%s}\n%s%sboundary:\n",
        c->dim == 2 ? "thickness: 1\n" : "",
        c->dim == 2   ? "0.3333333333333333"
        : c->dim == 3 ? "0.25"
                      : "0",
        c->method, c->more, more);
    for (int k = 0; k < c->dim; k++)
        at += snprintf (text + at, sizeof text - (size_t) at,
                        "  - {name: hold%d, set: %s, displacement: {%c: 0}}\n", k, side[k], "xyz"[k]);
    snprintf (text + at, sizeof text - (size_t) at,
              "  - {name: pull, set: right, traction: {x: 1 MPa}}\nsolver: {kind: static}\n");
    check_ok (pg_scene_parse (&scene, text, "patch.yaml"));
    return scene;
}

/* plain: without shortcuts. */
static pg_patch measured_as (const tension *c, double unit, const char *more, int plain)
{
    pg_scene *scene = scene_for (c, unit, more);
    pg_problem *p = NULL;
    check_ok (pg_problem_build (&p, scene, 1));
    p->plain = plain;
    check_ok (pg_patch_probe (p));
    pg_patch out = p->quality.patch;
    assert_true (out.measured);
    pg_problem_free (&p);
    pg_scene_free (&scene);
    return out;
}

static pg_patch measured (const tension *c, double unit, const char *more)
{
    return measured_as (c, unit, more, 0);
}

/* Relative, root of mean square over the points */
static double tension_error (const tension *c)
{
    run r = { .scene = scene_for (c, 1, "") };
    build (&r, 1);
    to_the_end (&r);
    double *u = field_of (&r, NULL, "displacement", NULL), wrong = 0, all = 0,
           nu = c->dim == 1   ? 0
                : c->dim == 2 ? 1. / 3
                              : 0.25;
    for (size_t i = 0; i < r.problem->cloud.n; i++)
        for (int k = 0; k < c->dim; k++) {
            size_t at = i * (size_t) c->dim + (size_t) k;
            double exact = (k ? -nu : 1) * 1e-3 * r.problem->cloud.x[at], V = r.problem->cloud.volume[i];
            wrong += V * (u[at] - exact) * (u[at] - exact), all += V * exact * exact;
        }
    pg_free (u);
    clear (&r);
    return sqrt (wrong / all);
}

/* In full size (3 s): iterations that 3e8 visits of bonds do not bring to an end are not settled, and the
 * error is
 * said to be at least so much. */
static void what_iterations_have_not_found_is_a_bound (void **state)
{
    (void) state;
    tension c = { .method = "approximation: nosb, integration: nodal, horizon: 3.01 spacing",
                  .more = "perturb: {amount: 0.3}\n", .dim = 3, .spacing = 0.05, .size = { 1, 1, 1 } };
    if (!longer ()) c.spacing = 0.125;
    pg_patch p = measured (&c, 1, "");
    print_message ("  spacing %g: error %g, settled %d after %d iterations\n", c.spacing, p.error,
                   p.settled, (int) p.iterations);
    assert_int_equal (p.settled, c.spacing > 0.1);
}

#define MOVED "perturb: {amount: 0.2}\n"
static const tension cases[] = {
    { "force: bond", "lattice: cells\n", 2, 0.1, { 1, 0.1, 0 }, 0.9, 1.5 },
    { "force: bond", "lattice: cells\n", 2, 0.1, { 1, 0.3, 0 }, 0.9, 3.5 },
    { "force: bond", "", 2, 0.1, { 1, 1, 0 }, 0.9, 2 },
    { "force: bond", "", 2, 0.025, { 1, 1, 0 }, 0.9, 2 },
    { "force: bond", MOVED, 2, 0.1, { 1, 1, 0 }, 0.9, 2 },
    { "force: bond", "", 3, 0.2, { 1, 1, 1 }, 0.9, 2 },
    { "force: bond", "", 1, 0.05, { 1, 0, 0 }, 0.9, 2 },
    { "force: lps", "", 2, 0.1, { 1, 1, 0 }, 0.9, 2 },
    { "force: gmpd", "", 2, 0.1, { 1, 1, 0 }, 0.9, 2 },
    { "force: gmpd, volumetric: on", "", 3, 0.2, { 1, 1, 1 }, 0.9, 2 },
    { "approximation: nosb, horizon: 2.5 spacing", "", 2, 0.1, { 1, 1, 0 }, 0.9, 2 },
    { "approximation: pddo, horizon: 3 spacing", "", 2, 0.1, { 1, 1, 0 }, 0.9, 2 },
    { "approximation: pddo, integration: nodal", MOVED, 2, 0.1, { 1, 1, 0 }, 0.9, 2 },
    { "approximation: nosb, integration: nodal", MOVED, 2, 0.1, { 1, 1, 0 }, 0.9, 2 },
    { "approximation: nosb, integration: consistent, horizon: 6 spacing", "", 1, 0.1, { 1, 0, 0 }, 0.9, 2 },
    { "approximation: nosb, integration: consistent, horizon: 4.5 spacing", "", 2, 0.1, { 1, 1, 0 }, 0.9, 6 },
    { "kernel: constant", MOVED, 2, 0.1, { 1, 1, 0 }, 0.9, 2 },
    { "kernel: linear_r", "", 3, 0.2, { 1, 1, 1 }, 0.9, 2 },
};

static void it_tells_what_uniform_tension_comes_out_as (void **state)
{
    (void) state;
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        pg_patch p = measured (&cases[k], 1, "");
        double error = tension_error (&cases[k]);
        print_message ("  %dD, h %g, %-45s patch error %.3g (%+.2g), tension %.3g: ratio %.2f\n",
                       cases[k].dim, cases[k].spacing, cases[k].method, p.error, p.compliance, error,
                       p.error / error);
        assert_true (p.settled);
        assert_true (p.error / error > cases[k].least && p.error / error < cases[k].most);
    }
}

static void sound_ones_are_told_to_be (void **state)
{
    (void) state;
    static const tension sound[] = {
        { "horizon: 2 spacing", MOVED, 2, 0.1, { 1, 1, 0 }, 0, 0.01 },
        { "basis: quadratic, horizon: 2.8 spacing", "", 3, 0.2, { 1, 1, 1 }, 0, 0.01 },
        { "integration: consistent", MOVED, 2, 0.1, { 1, 1, 0 }, 0, 1e-12 },
        { "integration: consistent", MOVED, 3, 0.2, { 1, 1, 1 }, 0, 1e-12 },
        { "approximation: nosb, integration: consistent, essential: nitsche, horizon: 4.5 spacing",
          "",
          2,
          0.1,
          { 1, 1, 0 },
          0,
          1e-12 },
        { "integration: consistent", "plane: strain\n", 2, 0.1, { 1, 1, 0 }, 0, 1e-12 },
        { "integration: consistent", "", 1, 0.1, { 1, 0, 0 }, 0, 1e-12 },
    };
    for (size_t k = 0; k < sizeof sound / sizeof *sound; k++) {
        pg_patch p = measured (&sound[k], 1, "");
        print_message ("  %dD, %-30s patch error %.3g\n", sound[k].dim, sound[k].method, p.error);
        check_below (p.error, sound[k].most);
        check_below (p.rigid, 1e-6);
    }
}

/* The number is that of the body without cracks, in any unit. */
static void units_and_cracks_leave_it_as_it_is (void **state)
{
    (void) state;
    static const tension of[] = {
        { "force: bond", "", 2, 0.1, { 1, 1, 0 }, 0, 0 },
        { "approximation: pddo, horizon: 3 spacing", "", 2, 0.1, { 1, 1, 0 }, 0, 0 }
    };
    for (size_t k = 0; k < 2; k++) {
        pg_patch p = measured (&of[k], 1, ""),
                 cracked = measured (&of[k], 1, "cracks: [{from: [-0.1, 0.53], to: [0.5, 0.53]}]\n");
        check_relative (cracked.error, p.error, 1e-12);
        for (double unit = 1e-9; unit < 1e4; unit *= 1e6)
            check_relative (measured (&of[k], unit, "").error, p.error, 2e-3);
    }
}

/* Points of a file have no surface: the rim is held as the uniform strain moves it, and the points inside
 * tell. */
static void points_without_a_surface_are_measured_inside (void **state)
{
    (void) state;
    char name[] = "/tmp/perigal_patch_XXXXXX", text[600];
    unsigned seed = 3;
    int file = mkstemp (name);
    FILE *f = fdopen (file, "w");
    assert_non_null (f);
    fputs ("x,y,volume,block\n", f);
    for (int i = 0; i < 400; i++) {
        double move[2];
        for (int k = 0; k < 2; k++)
            seed = seed * 1664525u + 1013904223u, move[k] = 0.01 * ((double) (seed >> 8) / 8388608.0 - 1);
        fprintf (f, "%.17g,%.17g,0.0025,0\n", 0.05 * (i % 20) + move[0], 0.05 * (i / 20) + move[1]);
    }
    assert_int_equal (fclose (f), 0);
    snprintf (text, sizeof text,
              "dimension: 2\nthickness: 1\npoints: %s\nmaterials: {m: {youngs_modulus: 1 GPa, "
              "poissons_ratio: 0.3333333333333333}}\nmethod: {force: bond, horizon: 0.15}\n",
              name);
    pg_scene *scene;
    pg_problem *p;
    check_ok (pg_scene_parse (&scene, text, "patch.yaml"));
    check_ok (pg_problem_build (&p, scene, 1));
    check_ok (pg_patch_probe (p));
    print_message ("  points of a file: %g, %zu iterations\n", p->quality.patch.error,
                   p->quality.patch.iterations);
    assert_true (p->quality.patch.held && p->quality.patch.measured && isnan (p->quality.patch.compliance));
    assert_true (p->quality.patch.error > 1e-3 && p->quality.patch.error < 0.2);
    pg_problem_free (&p);
    pg_scene_free (&scene);
    unlink (name);
}

/* What unit forces find of it is a number of the method: as large for few points as for many, in any unit. */
static void softness_is_a_pure_number (void **state)
{
    (void) state;
    static const tension few = { "integration: consistent", "", 2, 0.1, { 1, 1, 0 }, 0, 0 },
                         many = { "integration: consistent", "", 2, 0.04, { 1, 1, 0 }, 0, 0 },
                         bonds = { "force: bond", "", 2, 0.1, { 1, 1, 0 }, 0, 0 };
    double a = measured (&few, 1, "").softness, b = measured (&many, 1, "").softness,
           c = measured (&few, 1e-9, "").softness, d = measured (&bonds, 1, "").softness;
    print_message ("  softness %g, %g, %g, %g\n", a, b, c, d);
    assert_true (a > 0.3 && a < 30 && d > 0.3 && d < 30);
    assert_true (b > 0.5 * a && b < 2 * a);
    check_relative (c, a, 1e-3);
}

/* A factor of K finds what iterations find: the same errors, and as much softness, also where
 * next to nothing resists some motion. `plain` asks for the iterations. */
static void a_factor_finds_what_iterations_find (void **state)
{
    (void) state;
    static const tension list[] = {
        { "integration: nodal, stabilization: none", MOVED, 2, 0.1, { 1, 1, 0 }, 0, 0 },
        { "approximation: pddo, horizon: 3 spacing", MOVED, 2, 0.1, { 1, 2, 0 }, 0, 0 },
        { "integration: gauss, basis: quadratic, horizon: 2.6 spacing", MOVED, 2, 0.06, { 2, 1, 0 }, 0, 0 },
        /* on a small lattice too, and in space */
        { "approximation: pddo, horizon: 3 spacing", "", 2, 0.1, { 1, 2, 0 }, 0, 0 },
        { "integration: gauss", "", 3, 0.2, { 1.4, 0.8, 1 }, 0, 0 },
        { "integration: gauss, kernel: linear_r", MOVED, 3, 0.2, { 1, 0.8, 1 }, 0, 0 },
    };
    for (size_t k = 0; k < sizeof list / sizeof *list; k++) {
        pg_patch a = measured (&list[k], 1, ""), b = measured_as (&list[k], 1, "", 1);
        print_message ("  %s: error %g, %g (%zu, %zu iterations), softness %g, %g\n", list[k].method,
                       a.error, b.error, a.iterations, b.iterations, a.softness, b.softness);
        assert_true (a.iterations == 0 && b.iterations > 0 && a.settled && b.settled);
        check_relative (a.error, b.error, 0.04);
        check_absolute (a.compliance, b.compliance, 0.1 * b.error);
        check_relative (log (a.softness), log (b.softness), 0.1);
        assert_int_equal (a.state, b.state);
    }
    /* products with K are cheap on a large lattice */
    static const tension lattice = { "integration: nodal", "", 2, 0.02, { 1, 1, 0 }, 0, 0 };
    assert_true (measured (&lattice, 1, "").iterations > 0);
}

/* Where the linear field is the answer to rounding nothing has to be solved for: iterations are those of the
 * softness alone. */
static void nothing_is_solved_where_nothing_is_missing (void **state)
{
    (void) state;
    static const tension exact = { "integration: consistent", "", 3, 0.2, { 1, 1, 1 }, 0, 0 },
                         other = { "integration: gauss", "", 3, 0.2, { 1, 1, 1 }, 0, 0 };
    pg_patch a = measured_as (&exact, 1, "", 1), b = measured_as (&other, 1, "", 1);
    print_message ("  %zu iterations where it is exact, %zu where it is not\n", a.iterations, b.iterations);
    check_below (a.error, 1e-12);
    assert_true (a.iterations > 0 && a.iterations + 6 * 6 <= b.iterations && b.error > 1e-4);
}

static void refused (const tension *c, const char *more, const char *const *words)
{
    pg_scene *scene = scene_for (c, 1, more);
    pg_problem *p = NULL;
    pg_status status = pg_problem_build (&p, scene, 1);
    if (status == PG_OK) status = pg_patch_probe (p);
    if (status == PG_OK) status = pg_patch_refuse (p, scene);
    assert_int_equal (status, PG_E_SCENE);
    for (; *words; words++) check_contains (pg_last_error (), *words);
    pg_problem_free (&p);
    pg_scene_free (&scene);
}

static void too_wrong_is_refused (void **state)
{
    (void) state;
    static const tension
        bar = { "force: bond", "lattice: cells\n", 2, 0.1, { 1, 0.1, 0 }, 0, 0 },
        wide = { "approximation: nosb, horizon: 4.5 spacing", "", 2, 0.1, { 1, 1, 0 }, 0, 0 },
        accepted = { "approximation: nosb, horizon: 4.5 spacing, accept_inexact: yes",
                     "",
                     2,
                     0.1,
                     { 1, 1, 0 },
                     0,
                     0 },
        blind = {
            "basis: quadratic, horizon: 1.01 spacing, accept_inexact: yes", "", 2, 0.1, { 1, 1, 0 }, 0, 0
        };
    refused (&bar, "",
             (const char *const[]){ "patch.yaml:", "under uniform stress", "too soft",
                                    "points across, four horizons, and this body has 1", "accept_inexact",
                                    NULL });
    refused (&wide, "", (const char *const[]) { "under uniform stress", "integration: consistent", NULL });
    refused (&blind, "",
             (const char *const[]){ "method.horizon", "400 of 900 evaluation points, such as that at",
                                    NULL });
    pg_scene *scene = scene_for (&accepted, 1, "");
    pg_problem *p = NULL;
    pg_solver_options o;
    pg_statistics doubts = { 0 };
    check_ok (pg_problem_build (&p, scene, 1));
    check_ok (pg_patch_probe (p));
    check_ok (pg_patch_refuse (p, scene));
    check_ok (pg_solver_options_read (&o, p, scene));
    pg_solver_doubts (&doubts, p, &o);
    assert_int_equal (doubts.nwarning, 1);
    check_contains (doubts.warning[0], "under uniform stress");
    pg_problem_free (&p);
    pg_scene_free (&scene);
}

/* The first warning of a scene of the unit square, or "". */
static void remark (const char *more, const char *expected)
{
    pg_scene *scene = NULL;
    pg_problem *p = NULL;
    pg_solver_options o;
    pg_statistics doubts = { 0 };
    char text[2048];
    snprintf (text, sizeof text,
              "dimension: 2\nbody: [{add: {box: {low: [0, 0], high: [1, 1]}}}]\n%s"
              "boundary: [{set: left, displacement: {x: 0, y: 0}}, {set: right, traction: {x: 1 "
              "MPa}}]\nsolver: {kind: static}\n",
              more);
    check_ok (pg_scene_parse (&scene, text, "patch.yaml"));
    check_ok (pg_problem_build (&p, scene, 1));
    check_ok (pg_patch_probe (p));
    check_ok (pg_solver_options_read (&o, p, scene));
    pg_solver_doubts (&doubts, p, &o);
    assert_int_equal (p->quality.thickness_assumed, 1);
    assert_int_equal (doubts.nwarning, *expected ? 1 : 0);
    if (*expected) check_contains (doubts.warning[0], expected);
    pg_problem_free (&p);
    pg_scene_free (&scene);
}

#define ONE "materials: {m: {youngs_modulus: 1 GPa, poissons_ratio: 0.3}}\n"
#define TWO(E) \
    "materials: {m: {youngs_modulus: 1 GPa, poissons_ratio: 0}, hard: {youngs_modulus: " E \
    ", poissons_ratio: 0}}\n" \
    "blocks: [{material: m, where: 'x <= 0.5'}, {material: hard, where: 'x > 0.5'}]\n"

static void what_was_hardly_meant_is_said (void **state)
{
    (void) state;
    remark (ONE "spacing: 0.1\n", "");
    remark (ONE "spacing: 2\n", "the spacing, 2 m, is larger than the body, which measures 1 m along x");
    remark (ONE "spacing: 0.02\ncracks: [{from: [-0.1, 0.53], to: [0.5, 0.53]}]\n", "");
    remark (ONE "spacing: 0.1\ncracks: [{from: [-0.1, 0.53], to: [1.1, 0.53]}]\n",
            "the cracks cut the body into 2 parts: 55 of its 121 points");
    remark (TWO ("1e11 Pa") "spacing: 0.1\n", "");
    remark (TWO ("1e15 Pa") "spacing: 0.1\n",
            "material hard is 1e+06 times as stiff as m, and sees 36 % of it");
    remark (TWO ("1e15 Pa") "spacing: 0.02\n", "sees 7.8 % of it");
    remark (TWO ("1e15 Pa") "spacing: 0.01\n", "");
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (it_tells_what_uniform_tension_comes_out_as),
        cmocka_unit_test (what_iterations_have_not_found_is_a_bound),
        cmocka_unit_test (sound_ones_are_told_to_be),
        cmocka_unit_test (units_and_cracks_leave_it_as_it_is),
        cmocka_unit_test (points_without_a_surface_are_measured_inside),
        cmocka_unit_test (softness_is_a_pure_number),
        cmocka_unit_test (a_factor_finds_what_iterations_find),
        cmocka_unit_test (nothing_is_solved_where_nothing_is_missing),
        cmocka_unit_test (too_wrong_is_refused),
        cmocka_unit_test (what_was_hardly_meant_is_said),
    };
    return cmocka_run_group_tests (tests, NULL, NULL);
}
