/* SPDX-License-Identifier: GPL-3.0-or-later
 * Fronts of pre-cracks in space: which parts of their outlines, where vertices lie, and their frames. */
#include "mechanics/model/scenes.h"
#include <math.h>

static const double pi = 3.14159265358979323846;

#define MATERIAL \
    "materials: {a: {youngs_modulus: 1, poissons_ratio: 0.25}}\nboundary: [{set: bottom, displacement: {x: " \
    "0, y: 0, z: 0}}]\nmethod: {gauss_points: 1}\nsolver: {kind: static}\n"

/* A cube of half width 1 unit about the origin, with 10 spacings across it. */
static built cube (double unit, const char *cracks)
{
    char text[2000];
    snprintf (text, sizeof text,
              "dimension: 3\nbody: [{add: {box: {low: [%.17g, %.17g, %.17g], high: [%.17g, %.17g, "
              "%.17g]}}}]\nlattice: cells\nspacing: %.17g\ncracks: [%s]\n" MATERIAL,
              -unit, -unit, -unit, unit, unit, unit, 0.2 * unit, cracks);
    return build (text);
}

static double dot (const double *a, const double *b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/* Frames are orthonormal, run along ahead x normal, and vertices lie about a spacing apart. */
static void check_front (const pg_front *f, double h)
{
    for (size_t i = 0; i < f->n; i++) {
        const double *x = f->x + 3*i, *n = f->normal + 3*i, *e = f->ahead + 3*i;
        check_relative (dot (n, n), 1, 1e-12), check_relative (dot (e, e), 1, 1e-12);
        check_absolute (dot (n, e), 0, 1e-9);
        if (i + 1 == f->n && !f->closed) continue;
        const double *y = f->x + 3*((i + 1) % f->n);
        double t[3] = { e[1]*n[2] - e[2]*n[1], e[2]*n[0] - e[0]*n[2], e[0]*n[1] - e[1]*n[0] },
               step[3] = { y[0] - x[0], y[1] - x[1], y[2] - x[2] }, size = sqrt (dot (step, step));
        check_relative (size, h, 0.5);
        assert_true (dot (step, t) > 0.5 * size);
    }
}

static void rims_of_discs (void **state)
{
    (void) state;
    for (int k = -1; k <= 1; k++) {
        double unit = pow (1000, k), radius = 0.62 * unit, centre[3] = { 0.1 * unit, 0, -0.1 * unit };
        char crack[200];
        snprintf (crack, sizeof crack,
                  "{disc: {center: [%.17g, 0, %.17g], normal: [1, 2, 2], radius: %.17g}}",
                  centre[0], centre[2], radius);
        built b = cube (unit, crack);
        assert_int_equal (b.problem->crack.nfront, 1);
        size_t n;
        const pg_front *f = pg_fronts_of_state (b.problem, NULL, &n);
        assert_int_equal (n, 1), assert_ptr_equal (f, b.problem->crack.front);
        assert_int_equal (f->closed, 1), assert_int_equal (f->open, 1), assert_int_equal (f->id, 1);
        /* a multiple of four of them, so that both sides of the disc are alike */
        assert_int_equal (f->n, 4 * lround (2 * pi * radius / (4 * 0.2 * unit)));
        check_front (f, 0.2 * unit);
        for (size_t i = 0; i < f->n; i++) {
            double r[3];
            for (int c = 0; c < 3; c++) r[c] = (f->x[3*i + (size_t) c] - centre[c]) / radius;
            check_relative (dot (r, r), 1, 1e-9), check_relative (dot (r, f->ahead + 3*i), 1, 1e-9);
            check_absolute (dot (r, f->normal + 3*i), 0, 1e-9);
            check_relative (f->normal[3*i], 1.0 / 3, 1e-12);
            check_relative (f->offset[i], b.problem->crack.given.crack[0].retreat[0], 1e-12);
            assert_int_equal (f->meets[i], PG_MEETS_NOTHING);
        }
        unbuild (&b);
    }
}

/* Half of a disc about a place on the face x = -1: a front of half the rim, its ends on the face. */
static void rims_that_leave_the_body (void **state)
{
    (void) state;
    built b = cube (1, "{disc: {center: [-1, 0.1, 0.05], normal: [0, 0, 1], radius: 0.7}}");
    assert_int_equal (b.problem->crack.nfront, 1);
    const pg_front *f = b.problem->crack.front;
    assert_int_equal (f->closed, 0), assert_int_equal (f->n, lround (0.7 * pi / 0.2) + 1);
    check_front (f, 0.2);
    for (size_t i = 0; i < f->n; i++) {
        check_relative (hypot (f->x[3*i] + 1, f->x[3*i + 1] - 0.1), 0.7, 1e-6);
        assert_int_equal (f->meets[i], i == 0 || i + 1 == f->n ? PG_MEETS_SURFACE : PG_MEETS_NOTHING);
    }
    check_absolute (f->x[0], -1, 1e-9), check_absolute (f->x[3 * (f->n - 1)], -1, 1e-9);
    check_relative (f->x[1], 0.8, 1e-9);               /* seen against the normal it runs clockwise */
    unbuild (&b);
}

/* A cut from the face x = -1 all through the body: one straight front, whatever of the polygon lies outside
 * and wherever its list begins. */
static void straight_fronts (void **state)
{
    (void) state;
    static const char *const crack[] = {
        "{polygon: [[-2, -3, 0], [0.1, -3, 0], [0.1, 3, 0], [-2, 3, 0]]}",
        "{polygon: [[0.1, 0.2, 0], [0.1, 3, 0], [-2, 3, 0], [-2, -3, 0], [0.1, -3, 0]]}",
        "{polygon: [[0.1, 3, 0], [0.1, -3, 0], [-2, -3, 0], [-2, 3, 0]]}",
    };
    for (int k = 0; k < 3; k++) {
        built b = cube (1, crack[k]);
        double side = k == 2 ? -1 : 1;
        assert_int_equal (b.problem->crack.nfront, 1);
        const pg_front *f = b.problem->crack.front;
        assert_int_equal (f->closed, 0), assert_int_equal (f->n, 11);
        check_front (f, 0.2);
        for (size_t i = 0; i < f->n; i++) {
            check_absolute (f->x[3*i], 0.1, 1e-12);
            check_absolute (f->x[3*i + 1], side * (1 - 0.2 * (double) i), 1e-9);
            check_absolute (f->ahead[3*i], 1, 1e-12), check_absolute (f->normal[3*i + 2], side, 1e-12);
        }
        assert_int_equal (f->meets[0], PG_MEETS_SURFACE), assert_int_equal (f->meets[10], PG_MEETS_SURFACE);
        unbuild (&b);
    }
    built b = cube (1, "{polygon: [[-2, -3, 0], [2, -3, 0], [2, 3, 0], [-2, 3, 0]]}");
    assert_int_equal (b.problem->crack.nfront, 0);           /* cuts the body in two */
    unbuild (&b);
}

/* Corners keep their vertices; a square of four squares, whose inner edges are no fronts, has the front of
 * one square, also where two of them show their other side. */
static void corners_and_joints (void **state)
{
    (void) state;
    static const char *const crack[] = {
        "{polygon: [[-0.5, -0.5, 0], [0.5, -0.5, 0], [0.5, 0.5, 0], [-0.5, 0.5, 0]]}",
        "{polygon: [[-0.5, -0.5, 0], [0, -0.5, 0], [0, 0, 0], [-0.5, 0, 0]]}, "
        "{polygon: [[0, -0.5, 0], [0, 0, 0], [0.5, 0, 0], [0.5, -0.5, 0]]}, "
        "{polygon: [[0, 0, 0], [0.5, 0, 0], [0.5, 0.5, 0], [0, 0.5, 0]]}, "
        "{polygon: [[-0.5, 0, 0], [-0.5, 0.5, 0], [0, 0.5, 0], [0, 0, 0]]}"
    };
    for (int k = 0; k < 2; k++) {
        built b = cube (1, crack[k]);
        int corners = 0;
        assert_int_equal (b.problem->crack.nfront, 1);
        const pg_front *f = b.problem->crack.front;
        assert_int_equal (f->closed, 1), assert_int_equal (f->n, 20);
        check_front (f, 0.2);
        for (size_t i = 0; i < f->n; i++) {
            check_relative (fmax (fabs (f->x[3*i]), fabs (f->x[3*i + 1])), 0.5, 1e-6);
            if (fabs (fabs (f->x[3*i]) - fabs (f->x[3*i + 1])) > 1e-6) continue;
            corners++;
            check_relative (fabs (f->ahead[3*i]), sqrt (0.5), 1e-6);
        }
        assert_int_equal (corners, 4);
        unbuild (&b);
    }
}

/* A crack that ends on the face of another has no front there, and the ends of its front meet a crack. */
static void fronts_that_meet_cracks (void **state)
{
    (void) state;
    built b = cube (1, "{polygon: [[-2, -3, 0], [0.1, -3, 0], [0.1, 3, 0], [-2, 3, 0]]}, "
                       "{polygon: [[-0.5, -0.5, 0], [-0.5, 0.5, 0], [-0.5, 0.5, 0.4], [-0.5, -0.5, 0.4]]}");
    assert_int_equal (b.problem->crack.nfront, 2);
    const pg_front *f = &b.problem->crack.front[1];
    assert_int_equal (f->closed, 0), assert_int_equal (f->n, 10);
    assert_int_equal (f->meets[0], PG_MEETS_CRACK), assert_int_equal (f->meets[9], PG_MEETS_CRACK);
    check_front (f, 0.2);
    unbuild (&b);
}

static void memory_may_run_out (void **state)
{
    (void) state;
    each_allocation_may_fail (
        "dimension: 3\nbody: [{add: {box: {low: [-1, -1, -1], high: [1, 1, 1]}}}]\nlattice: cells\nspacing: "
        "0.5\ncracks: [{disc: {center: [-1, 0, 0.1], normal: [0, 0, 1], radius: 0.8}}]\n" MATERIAL);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (rims_of_discs),           cmocka_unit_test (rims_that_leave_the_body),
        cmocka_unit_test (straight_fronts),         cmocka_unit_test (corners_and_joints),
        cmocka_unit_test (fronts_that_meet_cracks), cmocka_unit_test (memory_may_run_out),
    };
    return cmocka_run_group_tests_name ("mechanics/model/fronts", tests, NULL, NULL);
}
