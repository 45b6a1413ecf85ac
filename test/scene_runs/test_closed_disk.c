/* SPDX-License-Identifier: GPL-3.0-or-later
 * The Brazilian disk whose crack lies at 45 degrees to the load, its faces in contact (data/cui_disk_plane):
 * K_I = 0, K_II as for two point loads, and first growth where the largest hoop stress of mode II alone says.
 */
#include "run.h"

static const double pi = 3.14159265358979323846;

/* K_I and K_II over P sqrt (a) / (sqrt (pi) R B) of a crack of 2 a = 0.6 R in a disk under point loads at 45
 * degrees: the first two terms of C. Atkinson, R. E. Smelser, J. Sanchez, Int. J. Fract. 18 (1982) 279,
 * with their coefficients for a / R = 0.3. */
static const double open_I  = -1.135551 - 4 * 0.243714 * 0.09,
                    open_II = 2 * (1.089702 - 0.522272 * 0.09);

/* Closed faces bear what would be K_I < 0; friction takes that times its coefficient off K_II. */
static void grows_by_sliding (double friction)
{
    const char *set[] = { friction > 0 ? "contact.coefficient=0.5" : "contact={kind: normal}",
                          "solver.max_events=1" };
    run r = loaded ("data/cui_disk_plane/scene_contact.yaml", 2, set);
    const double c = sqrt (0.015 / pi) / (0.05 * 0.01), toughness = sqrt (10e9 * 20);
    size_t steps = 0, events = 0;
    while (!pg_solver_done (r.solver, r.state)) {
        advance (&r);
        double P = fabs (r.step.reaction[1]);
        if (r.step.event) {
            const pg_tip_values *v = pg_solver_tip (r.solver, r.state->paths->tip[0].id);
            double hoop = -v->K[1] / (sqrt (3) / 2 * toughness);
            print_message ("friction %g: grows at %.4g N, K_II / (sqrt (3) / 2 K_c) %.4f\n", friction, P,
                           hoop);
            check_relative (hoop, 1, 0.015);
            events++;
        } else
            for (size_t i = 0; i < 2; i++, steps++) {
                const pg_tip_values *v = pg_solver_tip (r.solver, r.state->paths->tip[i].id);
                double exact = (open_II + friction * open_I) * P * c;
                assert_non_null (v);
                assert_true (v->K[0] == 0);
                if (steps < 2) print_message ("K_II over that of point loads %.4f\n", -v->K[1] / exact);
                check_relative (-v->K[1], exact, 0.06);
            }
    }
    assert_true (steps > 0 && events == 1);
    clear (&r);
}

static void smooth_faces (void **unused) { (void) unused; grows_by_sliding (0); }
static void faces_with_friction (void **unused) { (void) unused; grows_by_sliding (0.5); }

int main (void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test (smooth_faces),
                                        cmocka_unit_test (faces_with_friction) };
    return cmocka_run_group_tests (tests, NULL, NULL);
}
