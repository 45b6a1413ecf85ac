/* SPDX-License-Identifier: GPL-3.0-or-later
 * What a run says of the tips of its pre-cracks: how well the opening of a crack is known that is few
 * spacings long. */
#include "scenes.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define BODY \
    "materials: {a: {youngs_modulus: 1, poissons_ratio: 0.25}}\nboundary: [{set: bottom, displacement: {x: " \
    "0, y: 0}}, {set: top, traction: {y: 1}}]\n"
#define SQUARE \
    "dimension: 2\nthickness: 1\nbody: [{add: {box: {low: [-1, -1], high: [1, 1]}}}]\nlattice: cells\n" BODY
#define CUBE \
    "dimension: 3\nbody: [{add: {box: {low: [-1, -1, -1], high: [1, 1, 1]}}}]\nlattice: cells\nspacing: " \
    "0.2\nmethod: {gauss_points: 1}\n" BODY
#define STATIC "solver: {kind: static}\n"

/* Per cent of the opening in the note; crack and spacings to its tip that it names. 0: no note. */
static double told (const char *scene, int *crack, double *spacings, int *warns)
{
    built b = build (scene);
    double percent = 0;
    for (size_t k = 0; k < b.problem->notes.n; k++) {
        const char *note = b.problem->notes.text[k], *at = strstr (note, "the opening of crack ");
        if (!at) continue;
        assert_true (percent == 0);                    /* one note */
        *crack = atoi (at + 21);
        *spacings = strtod (strchr (at, '(') + 1, NULL);
        percent = strtod (strstr (at, "+-") + 2, NULL);
        *warns = strncmp (note, PG_WARNING, strlen (PG_WARNING)) == 0;
        assert_int_equal (*warns, strstr (note, " m apart there make that 5 %") != NULL);
    }
    unbuild (&b);
    return percent;
}

static void check_told (const char *scene, double percent, double spacings, int warns)
{
    int crack = 0, warned = 0;
    double length = 0, share = told (scene, &crack, &length, &warned);
    check_relative (share, percent, 0.06);             /* two digits */
    check_relative (length, spacings, 0.03);
    assert_int_equal (crack, 1);
    assert_int_equal (warned, warns);
}

/* 0.2 spacing of a / length + 2 / ligament (inside the body: half length, 0.4 / ligament). */
static void short_cracks_are_told_with_a_number (void **state)
{
    (void) state;
    check_told (SQUARE STATIC "spacing: 0.1\ncracks: [{from: [-1.5, 0], to: [-0.6, 0]}]\n", 7.5, 4, 1);
    check_told (SQUARE STATIC "spacing: 0.1\ncracks: [{from: [-0.6, 0], to: [-1, 0]}]\n", 7.5, 4, 1);
    check_told (SQUARE STATIC
                "spacing: 0.1\nmethod: {tip_offset: 0}\ncracks: [{from: [-0.6, 0], to: [-1, 0]}]\n",
                7.5, 4, 1);
    check_told (SQUARE STATIC "spacing: 0.1\ncracks: [{from: [0.03, 0.4], to: [0.03, 1]}]\n", 6.2, 6, 1);
    check_told (SQUARE STATIC "spacing: 0.025\ncracks: [{from: [-1, 0], to: [-0.6, 0]}]\n", 1.9, 16, 0);
    check_told (SQUARE STATIC "spacing: 0.1\ncracks: [{from: [-0.2, 0.01], to: [0.2, 0.01]}]\n", 11, 2, 1);
    check_told (SQUARE STATIC "spacing: 0.1\nmethod: {basis: quadratic, horizon: 3 spacing}\ncracks: [{from: "
                              "[-0.2, 0.01], to: [0.2, 0.01]}]\n",
                15.9, 2, 1);
    check_told (
        SQUARE STATIC
        "spacing: 0.1\nmethod: {integration: nodal}\ncracks: [{from: [-0.2, 0.01], to: [0.2, 0.01]}]\n",
        41.2, 2, 1);
}

static void pieces_that_meet_are_one_crack (void **state)
{
    (void) state;
    check_told (SQUARE STATIC "spacing: 0.05\ncracks: [{from: [-1, 0.01], to: [-0.4, 0.01]}, {from: [-0.4, "
                              "0.01], to: [-0.2, 0.01]}, {from: [0, 0.01], to: [-0.2, 0.01]}]\n",
                3, 20, 0);
    check_told (SQUARE STATIC "spacing: 0.1\ncracks: [{from: [-0.4, 0.3], to: [-0.2, 0.4]}, {from: [0.4, "
                              "-0.3], to: [0.2, -0.2]}, {from: [-0.2, 0.4], to: [0.2, -0.2]}]\n",
                4.5, 5.84, 0);
}

static void fronts_in_space (void **state)
{
    (void) state;
    check_told (CUBE STATIC "cracks: [{polygon: [[-1.2, 0.01, -1.2], [-0.2, 0.01, -1.2], [-0.2, 0.01, 1.2], "
                            "[-1.2, 0.01, 1.2]]}]\n",
                11.7, 4, 1);
    check_told (CUBE STATIC "cracks: [{disc: {center: [0, 0.01, 0], normal: [0, 1, 0], radius: 0.4}}]\n",
                12.7, 2, 1);
}

/* A wave needs its front only where it passes; forces straight between points cut what crosses the crack. */
static void others_say_nothing (void **state)
{
    int crack, warns;
    double spacings;
    (void) state;
    assert_true (told (SQUARE "spacing: 0.1\nsolver: {kind: verlet, end: 1 us}\ncracks: [{from: [-1, 0.01], "
                              "to: [-0.6, 0.01]}]\n",
                       &crack, &spacings, &warns)
                 == 0);
    assert_true (told (SQUARE STATIC
                       "spacing: 0.1\nmethod: {force: lps}\ncracks: [{from: [-1, 0.01], to: [-0.6, 0.01]}]\n",
                       &crack, &spacings, &warns)
                 == 0);
    assert_true (told (SQUARE STATIC "spacing: 0.1\ncracks: [{from: [-1.5, 0.01], to: [1.5, 0.01]}]\n",
                       &crack, &spacings, &warns)
                 == 0);
    assert_true (told (SQUARE STATIC "spacing: 0.1\n", &crack, &spacings, &warns) == 0);
}

/* Cracks of a scene, and whether a note says that one is there twice. */
static size_t cracks_of (const char *cracks, int *noted)
{
    char scene[1024];
    snprintf (scene, sizeof scene, SQUARE "spacing: 0.1\n" STATIC "cracks: [%s]\n", cracks);
    built b = build (scene);
    size_t n = b.problem->crack.given.n;
    *noted = 0;
    for (size_t k = 0; k < b.problem->notes.n; k++)
        *noted += strstr (b.problem->notes.text[k], "count as one") != NULL;
    unbuild (&b);
    return n;
}

static void a_crack_given_twice_is_one (void **state)
{
    static const struct { const char *cracks; size_t n; int noted; } scene[] = {
        { "{from: [-0.5, 0], to: [0.5, 0.1]}, {from: [-0.5, 0], to: [0.5, 0.1]}", 1, 1 },
        { "{from: [-0.5, 0], to: [0.5, 0.1]}, {from: [0.5, 0.1], to: [-0.5, 0]}", 1, 1 },
        { "{from: [-0.5, 0], to: [0.5, 0]}, {from: [-0.1, 0], to: [0.2, 0]}", 1, 1 },
        { "{from: [-0.1, 0], to: [0.2, 0]}, {from: [-0.5, 0], to: [0.5, 0]}", 1, 1 },
        { "{from: [-0.5, 0], to: [0.1, 0]}, {from: [0, 0], to: [0.5, 0]}", 1, 1 },
        { "{polyline: [[-0.5, 0], [0, 0.1], [0.5, 0]]}, {polyline: [[0.5, 0], [0, 0.1], [-0.5, 0]]}", 2, 1 },
        { "{from: [-0.5, 0], to: [0, 0]}, {from: [0, 0], to: [0.5, 0]}", 2, 0 },
        { "{from: [-0.5, 0], to: [0.5, 0]}, {from: [-0.5, 0.01], to: [0.5, 0.01]}", 2, 0 },
        { "{from: [-0.5, 0], to: [0.5, 0]}, {from: [0, -0.5], to: [0, 0.5]}", 2, 0 },
    };
    int noted;
    (void) state;
    for (size_t k = 0; k < sizeof scene / sizeof *scene; k++) {
        assert_int_equal (cracks_of (scene[k].cracks, &noted), scene[k].n);
        assert_int_equal (noted, scene[k].noted);
    }
}

/* The rim of a disc retreats by the spacing there, not by that at its centre: points that are coarse around
 * the centre and fine at the rim. */
static void a_disc_in_graded_points_retreats_by_its_rim (void **state)
{
    (void) state;
    enum { N = 12 };
    char folder[] = "/tmp/perigal_tips_XXXXXX", points[64], path[64];
    assert_non_null (mkdtemp (folder));
    snprintf (points, sizeof points, "%s/p.csv", folder);
    snprintf (path, sizeof path, "%s/disc.yaml", folder);
    FILE *f = fopen (points, "w");
    assert_non_null (f);
    fprintf (f, "x,y,z,volume,block,spacing\n");
    for (int i = 0; i < N * N * N; i++) {
        double h = 2.0 / N, x = (i % N + 0.5) * h - 1, y = (i / N % N + 0.5) * h - 1,
               z = (i / N / N + 0.5) * h - 1;
        fprintf (f, "%.17g,%.17g,%.17g,%.17g,0,%.17g\n", x, y, z, h * h * h,
                 hypot (x, hypot (y, z)) < 0.3 ? 1.4 * h : h);
    }
    fclose (f);
    f = fopen (path, "w");
    assert_non_null (f);
    fprintf (f, "dimension: 3\npoints: p.csv\n"
                "materials: {a: {youngs_modulus: 1, poissons_ratio: 0.25}}\n"
                "sets: {low: {where: \"y < -0.9\"}, high: {where: \"y > 0.9\"}}\n"
                "boundary: [{set: low, displacement: {x: 0, y: 0, z: 0}}, "
                "{set: high, displacement: {y: 1e-3}}]\n"
                "cracks: [{disc: {center: [0, 0.01, 0], normal: [0, 1, 0], radius: 0.6}}]\n" STATIC);
    fclose (f);
    built b = { 0 };
    check_ok (pg_scene_load (&b.scene, path));
    check_ok (pg_problem_build (&b.problem, b.scene, 1));
    const pg_problem *p = b.problem;
    const pg_crack *c = &p->crack.given.crack[0];
    double rim = 0, centre = pg_problem_spacing_at (p, c->centre);
    for (size_t i = 0; i < c->nvertex; i++)
        rim += pg_problem_spacing_at (p, c->vertex + 3*i) / (double) c->nvertex;
    assert_true (centre > 1.3 * rim && p->crack.tip_offset > 0);
    assert_non_null (c->retreat);
    check_relative (c->retreat[0], p->crack.tip_offset * rim / p->cloud.h, 1e-9);
    unbuild (&b);
    unlink (points), unlink (path), rmdir (folder);
}

int main (void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test (short_cracks_are_told_with_a_number),
                                        cmocka_unit_test (pieces_that_meet_are_one_crack),
                                        cmocka_unit_test (fronts_in_space),
                                        cmocka_unit_test (others_say_nothing),
                                        cmocka_unit_test (a_crack_given_twice_is_one),
                                        cmocka_unit_test (a_disc_in_graded_points_retreats_by_its_rim) };
    return cmocka_run_group_tests_name ("mechanics/model/tips", tests, NULL, NULL);
}
