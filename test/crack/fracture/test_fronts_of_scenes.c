/* SPDX-License-Identifier: GPL-3.0-or-later
 * Fronts in space as the program solves them, on lattices that lie askew to them (aligned ones show
 * nothing): penny-shaped cracks of three to four spacings under the exact field of an infinite body, and a
 * semi-elliptical crack on the face of a plate. PERIGAL_TEST_SIZE=long: eight spacings. More of them: make
 * bench T=fronts. */
#include "../../../bench/front_scenes.h"
#include "check.h"

#define TURNED { 0.9659, 0, -0.2588, 0.0885, 0.9397, 0.3304, 0.2432, -0.3420, 0.9077 }
#define ALONG { 1, 0, 0, 0, 1, 0, 0, 0, 1 }
#define SHIFT { 0.37, 0.21, 0.3 }

typedef struct { double mean, scatter, K[3]; size_t extrapolated; } found;

/* Mean of the root of J over what is right and its standard deviation along the front; root of the mean
 * square error of K, of the largest K. */
static found look (const front_case *c)
{
    front_result r;
    found out = { 0 };
    double square = 0;
    check_ok (front_solve (c, &r));
    double size = sqrt (r.J / (1 - c->nu * c->nu)), n = 0;
    for (size_t i = 0; i < r.n; i++) {
        const double *K = r.K[i];
        double J = (1 - c->nu * c->nu) * (K[0] * K[0] + K[1] * K[1]) + (1 + c->nu) * K[2] * K[2];
        out.extrapolated += (size_t) r.field[i].extrapolated;
        assert_false (isnan (r.field[i].near));
        if (r.field[i].extrapolated) continue;
        double share = sqrt (r.field[i].J[0][0] / J);
        out.mean += share, square += share * share, n++;
        for (int k = 0; k < 3; k++) out.K[k] += pow ((r.field[i].K[k][0] - K[k]) / size, 2);
    }
    out.mean /= n, out.scatter = sqrt (fmax (0, square / n - out.mean * out.mean));
    for (int k = 0; k < 3; k++) out.K[k] = sqrt (out.K[k] / n);
    if (r.field[0].extrapolated)                       /* on the line through the second and third vertex */
        check_relative (r.field[0].J[0][0], 3 * r.field[2].J[0][0] - 2 * r.field[3].J[0][0], 1e-12);
    print_message ("%s a/h %g: sqrt (J) %.4f, scatter %.4f, K %.4f %.4f %.4f (%zu points, %.2f s, measured "
                   "in %.2f s)\n",
                   c->kind, c->a, out.mean, out.scatter, out.K[0], out.K[1], out.K[2], r.points, r.solve,
                   r.measure);
    front_result_clear (&r);
    return out;
}

/* Of a cube of four radii that is held all around: 5 processor seconds for 13 by iterations. */
static const char *solver (void) { return longer () ? NULL : "cholmod"; }

static void pennies_in_tension (void **state)
{
    (void) state;
    front_case c = { .kind = "penny", .a = longer () ? 8 : 3.5, .p = 1, .axes = TURNED, .shift = SHIFT,
                     .nu = 0.3, .unit = 1, .method = "horizon: 2.01 spacing", .linear = solver () };
    found f = look (&c);
    check_relative (f.mean, 1, 0.02);
    check_below (f.scatter, 0.015);
    check_below (f.K[0], 0.03);
    check_below (f.K[1], 0.02);
    check_below (f.K[2], 0.02);
}

static void inclined_pennies (void **state)
{
    (void) state;
    front_case c = { .kind = "penny", .a = longer () ? 8 : 3, .p = 0.5, .tau = 0.5, .axes = TURNED,
                     .shift = SHIFT, .nu = 0.3, .unit = 1e-3, .method = "horizon: 2.01 spacing",
                     .linear = solver () };
    found f = look (&c);
    check_relative (f.mean, 1, longer () ? 0.03 : 0.05);
    for (int k = 0; k < 3; k++) check_below (f.K[k], 0.05);
}

static void cracks_on_a_face (void **state)
{
    (void) state;
    front_case c = { .kind = "surface", .a = 4, .c = 5, .p = 1, .axes = ALONG, .shift = SHIFT, .nu = 0.3,
                     .unit = 1, .perturb = 0.2, .method = "horizon: 2.01 spacing" };
    found f = look (&c);
    check_relative (f.mean, 1, 0.05);
    check_below (f.scatter, 0.05);
    check_below (f.K[0], 0.06);
    assert_int_equal (f.extrapolated, 2);
}

int main (void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test (pennies_in_tension),
                                        cmocka_unit_test (inclined_pennies),
                                        cmocka_unit_test (cracks_on_a_face) };
    return cmocka_run_group_tests_name ("crack/fracture/fronts_of_scenes", tests, NULL, NULL);
}
