/* SPDX-License-Identifier: GPL-3.0-or-later
 * Platens bear from where they touch first, whatever the spacing, and a body that one of them only pushes
 * along until it meets another is in balance. */
#include "scene_runs/run.h"
#include "contact/platens.h"

#define ROCK "materials: {rock: {youngs_modulus: 50 GPa, poissons_ratio: 0.25}}\nfailure: {criterion: none}\n"
#define DISK \
    "dimension: 2\nthickness: 25 mm\nbody: [{add: {disk: {center: [0, 0], diameter: 50 mm}}}]\n" \
    "spacing: 2.5 mm\n" ROCK

/* Two jaws that close on a disk: mean distances of their nearest pieces are .16 mm, more than they go. */
static void jaws_bear_from_the_start (void **state)
{
    (void) state;
    run r = scene_of (1, DISK "platens:\n"
                              "  - {name: upper, point: [0, 25 mm], normal: [0, -1], displacement: {y: "
                              "-0.1 mm}}\n"
                              "  - {name: lower, point: [0, -25 mm], normal: [0, 1], displacement: {y: "
                              "0.1 mm}}\n"
                              "solver: {stepping: fixed, steps: 4}\n");
    double first = 0;
    for (int k = 1; k <= 4; k++) {
        advance (&r);
        double force = -platen_of (&r, 0)->force[1];
        if (k == 1) first = force;
        check_relative (platen_of (&r, 1)->force[1], force, 1e-9);
        /* the contact widens, and stiffens with it */
        assert_true (force >= 0.99 * k * first && force < 1.5 * k * first);
    }
    assert_true (first > 5e3);
    clear (&r);
}

/* Rollers of five spacings under a bar. */
static void rollers_bear_from_the_start (void **state)
{
    (void) state;
    run r = scene_of (1, "dimension: 2\nthickness: 50 mm\nbody: [{add: {box: {low: [-30 mm, 0], high: [30 "
                         "mm, 12 "
                         "mm]}}}]\nspacing: 2 mm\nlattice: cells\n" ROCK
                         "platens:\n"
                         "  - {name: load, shape: cylinder, point: [0, 22 mm], radius: 10 mm, friction: 0.2, "
                         "displacement: {y: -20 um}}\n"
                         "  - {name: left, shape: cylinder, point: [-20 mm, -10 mm], radius: 10 mm, "
                         "friction: "
                         "0.2}\n"
                         "  - {name: right, shape: cylinder, point: [20 mm, -10 mm], radius: 10 mm, "
                         "friction: "
                         "0.2}\nsolver: {stepping: fixed, steps: 5}\n");
    double first = 0;
    for (int k = 1; k <= 5; k++) {
        advance (&r);
        if (k == 1) first = -platen_of (&r, 0)->force[1];
    }
    double force = -platen_of (&r, 0)->force[1];
    assert_true (first > 0 && force > 5 * first && force < 8 * first);
    check_relative (platen_of (&r, 1)->force[1] + platen_of (&r, 2)->force[1], force, 1e-9);
    clear (&r);
}

/* The upper jaw pushes the disk along without a force until it lies on the lower one. */
static void a_body_that_is_pushed_along_is_in_balance (void **state)
{
    (void) state;
    run r = scene_of (1, DISK "platens:\n"
                              "  - {name: upper, point: [0, 25 mm], normal: [0, -1], friction: 0.2, "
                              "displacement: "
                              "{y: -0.4 mm}}\n"
                              "  - {name: lower, point: [0, -25.2 mm], normal: [0, 1], friction: 0.2}\n"
                              "solver: {stepping: fixed, steps: 8}\n");
    for (int k = 1; k <= 8; k++) {
        advance (&r);
        double force = -platen_of (&r, 0)->force[1];
        check_scaled (platen_of (&r, 1)->force[1], force, 1e-9, 1e3);
        if (k < 4) check_below (fabs (force), 1e-6);
        if (k > 4) assert_true (force > 1e3 * (k - 4));
    }
    clear (&r);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (jaws_bear_from_the_start),
        cmocka_unit_test (rollers_bear_from_the_start),
        cmocka_unit_test (a_body_that_is_pushed_along_is_in_balance),
    };
    return cmocka_run_group_tests_name ("contact/first_touch", tests, NULL, NULL);
}
