/* SPDX-License-Identifier: GPL-3.0-or-later
 * A confined closed flaw on a lattice so coarse that the stress along its wings holds more energy in a
 * spacing than a spacing of crack takes: the loads are right, what facets dissipate is not, and the run
 * names that cause (data/confined_flaw). */
#include "run.h"

static void the_run_names_why_energies_are_out (void **unused)
{
    (void) unused;
    const char *set[] = { "boundary[0].pressure=2 MPa", "boundary[1].pressure=2 MPa", "spacing=2 mm",
                          "sets.corner.where=x < -38 mm and y < -58 mm", "output.pictures=[]" };
    run r = loaded ("data/confined_flaw/scene.yaml", 5, set);
    double first = 0;
    int told = 0;
    while (!pg_solver_done (r.solver, r.state)) {
        advance (&r);
        if (r.step.event && !(first > 0)) first = 20e6 * (r.step.factor - 1);
    }
    const pg_statistics *s = pg_solver_report (r.solver, r.state);
    double share = s->energy.dissipated / s->energy.fracture,
           theory = 2 * (sqrt (3) / 2 * sqrt (5.96e9 * 5 / (acos (-1) * 0.01)) + 0.3 * 2e6) / 0.7;
    print_message ("first wings at %.4g of the infinite plate's load, dissipated %.3f\n", first / theory,
                   share);
    check_relative (first, theory, 0.05);
    for (size_t k = 0; k < s->nwarning; k++) {
        told += strstr (s->warning[k], "how loads bend within a facet; take a smaller spacing") != NULL;
        assert_null (strstr (s->warning[k], "turns, or other cracks"));
    }
    assert_true (share < 0.85);                        /* else the scene no longer shows it */
    assert_int_equal (told, 1);
    clear (&r);
}

int main (void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test (the_run_names_why_energies_are_out) };
    return cmocka_run_group_tests (tests, NULL, NULL);
}
