/* SPDX-License-Identifier: GPL-3.0-or-later
 * The end of a relaxation: reactions balance the loads to the imbalance asked for, not only the norm of what
 * points lack, which adds up over the body. */
#include "scene_runs/run.h"

static void reactions_balance_the_loads (void **state)
{
    (void) state;
    static const char *const kinds[] = { "adr", "relax" };
    for (size_t k = 0; k < 2; k++)
        for (int fine = 0; fine < 2; fine++) {
            double imbalance = fine ? 1e-7 : 1e-5;
            run r = scene_of (1, "dimension: 2\nthickness: 10 mm\nbody: [{add: {box: {low: [0, 0], high: "
                                 "[40 mm, 10 "
                                 "mm]}}}]\nspacing: 1 mm\nlattice: cells\nmaterials: {rock: "
                                 "{youngs_modulus: 10 GPa, "
                                 "poissons_ratio: 0.3333, density: 2500}}\nfailure: {criterion: "
                                 "none}\nmethod: {force: "
                                 "bond, accept_inexact: yes}\nboundary: [{set: left, displacement: {x: 0, "
                                 "y: 0}}, {set: "
                                 "right, traction: {x: 1 MPa}}]\nsolver: {kind: %s, stages: 1, imbalance: "
                                 "%g}\n"
                                 "output: {at: {levels: 1}}\n", kinds[k], imbalance);
            advance (&r);
            check_relative (r.step.reaction[3], 100, 1e-12);
            check_relative (-r.step.reaction[0], 100, 1.01 * imbalance);
            check_below (r.step.residual, imbalance);
            clear (&r);
        }
}

int main (void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test (reactions_balance_the_loads) };
    return cmocka_run_group_tests_name ("solve/relaxed_reactions", tests, NULL, NULL);
}
