/* SPDX-License-Identifier: GPL-3.0-or-later
 * A single edge notch in tension, drawn as a pre-crack: the opening of its mouth wherever the lattice lies,
 * against finite elements of high order. PERIGAL_TEST_SIZE=long: all shifts and the finer spacing. */
#include "run.h"
#include <stdlib.h>

/* of the mouth, in stress x width / modulus: half the width deep, half height 2 widths */
#define OPENING 9.88090
static const double shift[][2] = { { 0.37, 0.21 }, { 0, 0 },    { 0.1, 0.45 }, { 0.5, 0 },
                                   { 0.25, 0 },    { 0.75, 0 }, { 0, 0.25 },   { 0.37, 0.4 } };
enum { SHIFTS = sizeof shift / sizeof *shift };

/* Opening of the mouth over OPENING. */
static double opening (int n, const double *by, const char *method)
{
    double h = 1.0 / n, a[3], b[3], low[2] = { 0, -1e-6 }, high[2] = { 0, 1e-6 };
    void *self;
    run r =
        scene_of (1,
                  "dimension: 2\nplane: stress\nthickness: 1\nbody: [{add: {box: {low: [0, -2], high: [1, "
                  "2]}}}]\nspacing: %.17g\nlattice: cells\nlattice_offset: [%g, %g]\n"
                  "cracks: [{from: [-0.1, 0], to: [0.5, 0]}]\nmaterials: {m: {youngs_modulus: 1, "
                  "poissons_ratio: 0.3333333333333333}}\nsets: {pin: {where: x > %.17g and abs(y) < %.17g}}\n"
                  "boundary: [{name: top, set: top, traction: {y: 1}}, {name: bottom, set: bottom, traction: "
                  "{y: -1}}, {name: pin, set: pin, displacement: {x: 0, y: 0}, essential: penalty}]\n"
                  "method: {%s}\nsolver: {kind: static}\noutput: {at: {levels: 1}}\n",
                  h, by[0], by[1], 1 - 1.01 * h, 1.01 * h, method);
    to_the_end (&r);
    const pg_force_type *force = pg_solver_force (r.solver, &self);
    check_ok (force->sample (self, r.state, r.state->d, 1, low, a, NULL, NULL));
    check_ok (force->sample (self, r.state, r.state->d, 1, high, b, NULL, NULL));
    clear (&r);
    return (b[1] - a[1]) / OPENING;
}

/* Before bonds were cut behind the tip only, W/20 was 3 to 15 % off; consistent integration -39 and -41 %
 * where the first two shifts cut a row without points. */
static void the_mouth_opens_right_wherever_the_lattice_lies (void **state)
{
    static const struct { const char *name, *method;
    } methods[] = { { "linear, gauss", "integration: gauss" },
                    { "linear, consistent", "integration: consistent" },
                    { "quadratic, gauss", "basis: quadratic, horizon: 3 spacing" },
                    { "quadratic, consistent",
                      "basis: quadratic, horizon: 3 spacing, integration: consistent" } };
    size_t most = longer () ? SHIFTS : 3;
    (void) state;
    for (int n = 20; n <= (longer () ? 40 : 20); n *= 2)
        for (size_t m = 0; m < sizeof methods / sizeof *methods; m++) {
            double worst = 0;
            print_message ("W/%d %-22s", n, methods[m].name);
            for (size_t k = 0; k < most; k++) {
                double error = opening (n, shift[k], methods[m].method) - 1;
                print_message (" %+5.2f %%", 100 * error);
                worst = fmax (worst, fabs (error));
            }
            print_message ("\n");
            check_below (worst, (m < 2 ? 1.15 : 1.75) / n);  /* 0.17 and 0.25 spacings of crack length */
        }
}

/* The crack acts as one with another tip: with twice the points the error falls. */
static void what_remains_falls_with_the_spacing (void **state)
{
    double coarse = opening (20, shift[1], "integration: gauss") - 1,
           fine = opening (40, shift[1], "integration: gauss") - 1;
    (void) state;
    check_below (fabs (fine), 0.75 * fabs (coarse));
    assert_true (opening (20, shift[1], "tip_offset: 0") > 1.1);       /* what it was */
}

int main (void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test (the_mouth_opens_right_wherever_the_lattice_lies),
                                        cmocka_unit_test (what_remains_falls_with_the_spacing) };
    return cmocka_run_group_tests_name ("scene_runs/notch", tests, NULL, NULL);
}
