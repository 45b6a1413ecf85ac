/* SPDX-License-Identifier: GPL-3.0-or-later
 * Cracks of forces between points that grow by facets, on lattices that lie aslant under the body: the load
 * of growth along a strip, whose energy release rate is exact, and the first kink of inclined cracks. Grown
 * bond by bond the same cracks follow the rows of the lattice and need 1.2 to 1.4 times the energy.
 * PERIGAL_TEST_SIZE=long: all forces, directions and inclinations. */
#include "run.h"
#include <stdlib.h>

/* Poisson's ratio and force. */
typedef struct { const char *nu, *method; } theory;
static const theory theories[] = { { "0.3333333333333333", "force: bond" },
                                   { "0.25", "force: lps" },
                                   { "0.25", "force: gmpd" },
                                   { "0.3333333333333333", "force: bond, horizon: 4.015 spacing" } };
enum { THEORIES = sizeof theories / sizeof *theories };

/* A box that lies `turn` degrees aslant on its lattice of steps 1: x' from 0 to length, y' from -half to
 * half, and strips of `grip` beyond, which are displaced by +-1 along y'. crack: x', y' of both ends. */
static run box (const theory *t, double turn, double length, double half, double grip, const double *crack,
                const char *more)
{
    double a = turn * acos (-1) / 180, c = cos (a), s = sin (a), x[8];
    const double corner[4][2] = { { 0, -half - grip }, { length, -half - grip }, { length, half + grip },
                                  { 0, half + grip } };
    for (int k = 0; k < 4; k++)
        x[2 * k] = c * corner[k][0] - s * corner[k][1], x[2 * k + 1] = s * corner[k][0] + c * corner[k][1];
    return scene_of (
        1,
        "dimension: 2\nplane: stress\nthickness: 1\nbody: [{add: {polygon: {vertices: [[%.12g, %.12g], "
        "[%.12g, %.12g], [%.12g, %.12g], [%.12g, %.12g]]}}}]\nspacing: 1\nlattice: cells\ncells: staircase\n"
        "lattice_offset: [0.13, 0.21]\ncracks: [{from: [%.12g, %.12g], to: [%.12g, %.12g]}]\n"
        "materials: {m: {youngs_modulus: 1, poissons_ratio: %s}}\nmethod: {%s}\n"
        "sets: {up: {where: '%.12g * y - %.12g * x > %g'}, down: {where: '%.12g * y - %.12g * x < %g'}}\n"
        "boundary: [{set: up, displacement: {x: %.12g, y: %.12g}}, {set: down, displacement: {x: %.12g, y: "
        "%.12g}}]\n%s",
        x[0], x[1], x[2], x[3], x[4], x[5], x[6], x[7], c * crack[0] - s * crack[1],
        s * crack[0] + c * crack[1], c * crack[2] - s * crack[3], s * crack[2] + c * crack[3], t->nu,
        t->method, c, s, half, c, s, -half, -s, c, s, -c, more);
}

/* Stored energy of a strip at load factor 1, its crack as long as that. */
static double stored (const theory *t, double turn, double tip)
{
    const double crack[4] = { -2, 0, tip, 0 };
    run r = box (t, turn, 60, 10, 5, crack, "solver: {kind: static}\noutput: {at: {levels: 1}}\n");
    to_the_end (&r);
    double U = pg_solver_report_now (r.solver)->energy.strain;
    clear (&r);
    return U;
}

/* G needs no theory: minus dU/da of two strips whose tips lie 15 apart. */
static void a_strip_grows_at_the_fracture_energy (void **state)
{
    static const double turn[] = { 30, 0, 15, 45 };
    enum { EVENTS = 8 };
    (void) state;
    for (size_t k = 0; k < (longer () ? THEORIES : 3); k++)
        for (size_t a = 0; a < (longer () ? 4 : 1); a++) {
            const theory *t = &theories[k];
            const double crack[4] = { -2, 0, 20, 0 };
            double G = (stored (t, turn[a], 20) - stored (t, turn[a], 35)) / 15, sum = 0, off = 0;
            run r = box (t, turn[a], 60, 10, 5, crack,
                         "failure: {criterion: energy_release, fracture_energy: 1e-3}\n"
                         "solver: {kind: static, max_events: 8}\n");
            while (!pg_solver_done (r.solver, r.state)) {
                advance (&r);
                if (!r.step.event) continue;
                double load = r.step.factor * sqrt (G / 1e-3), *x = r.state->paths->tip[0].x,
                       along = turn[a] * acos (-1) / 180;
                assert_in_range (100 * load, 97, 103);
                sum += load / EVENTS, off = fmax (off, fabs (cos (along) * x[1] - sin (along) * x[0]));
            }
            print_message ("%-38s %2g degrees: load %.4f, off the middle by %.2f\n", t->method, turn[a],
                           sum, off);
            assert_int_equal (r.state->events, EVENTS);
            assert_true (fabs (sum - 1) < 0.02);
            assert_true (off < 0.3);
            clear (&r);
        }
}

/* The kink of a tip that moved from `from` to `to`, degrees from the direction `ahead` (rad) of a crack about
 * the place `middle`, the same sign at both ends. */
static double kink_of (const double *middle, double ahead, const double *from, const double *to)
{
    double c = cos (ahead), s = sin (ahead), d[2] = { to[0] - from[0], to[1] - from[1] };
    int far = (from[0] - middle[0]) * c + (from[1] - middle[1]) * s > 0;
    double kink = atan2 (c * d[1] - s * d[0], c * d[0] + s * d[1]) * 180 / acos (-1);
    return far ? kink : remainder (kink - 180, 360);
}

/* A crack inside a plate, half length 10; the angle of its first facet. By the largest hoop stress and the
 * field of a plate without end, K_II / K_I = cot (angle from the load): -60.0, -53.1, -43.2 degrees. */
static void inclined_cracks_kink_as_they_should (void **state)
{
    static const struct { double incline, kink; } cases[] = { { 45, -53.1 }, { 30, -60 }, { 60, -43.2 } };
    static const double turn[] = { 30, 0, 15, 45 };
    double degree = acos (-1) / 180;
    (void) state;
    for (size_t k = 0; k < (longer () ? THEORIES : 3); k++)
        for (size_t n = 0; n < (longer () ? 12 : 1); n++) {
            double to = (90 - cases[n % 3].incline) * degree, lattice = turn[n / 3] * degree, start[2][2];
            const double half[2] = { 10 * cos (to), 10 * sin (to) },
                         crack[4] = { 40 - half[0], -half[1], 40 + half[0], half[1] },
                         middle[2] = { 40 * cos (lattice), 40 * sin (lattice) };
            int grown = 0;
            run r = box (&theories[k], turn[n / 3], 80, 50, 4, crack,
                         "failure: {criterion: energy_release, fracture_energy: 1e-3}\n"
                         "solver: {kind: static, max_events: 1}\n");
            assert_int_equal (r.state->paths->ntip, 2);
            for (size_t t = 0; t < 2; t++) memcpy (start[t], r.state->paths->tip[t].x, sizeof start[t]);
            to_the_end (&r);
            for (size_t t = 0; t < 2; t++) {
                if (!(r.state->paths->tip[t].grown > 0)) continue;
                double kink = kink_of (middle, to + lattice, start[t], r.state->paths->tip[t].x);
                print_message ("%-38s lattice %2g, crack %2g degrees from the load: kink %.1f\n",
                               theories[k].method, turn[n / 3], cases[n % 3].incline, kink);
                assert_true (fabs (kink - cases[n % 3].kink) < 3);
                grown++;
            }
            assert_true (grown > 0);
            clear (&r);
        }
}

/* Bond by bond, with limits that allow for growth: the energy between the first spacings of growth, in which
 * the drawn tip becomes a grown one, and the seventh, over the fracture energy times the length by which the
 * crack of the strip has grown as its stiffness shows. bench/single_bonds in small. */
static double consumed (const theory *t, double turn, const char *failure)
{
    const double crack[4] = { -2, 0, 20, 0 };
    double first = stored (t, turn, 20), G = (first - stored (t, turn, 35)) / 15, before = first, work = 0,
           length = 0, grown = 0;
    char text[256];
    snprintf (text, sizeof text, "failure: {%s, fracture_energy: 1e-3, exclude: [up, down]}\n"
                                 "solver: {kind: static, max_events: 3000}\n", failure);
    run r = box (t, turn, 60, 10, 5, crack, text);
    while (!pg_solver_done (r.solver, r.state) && grown < 7) {
        advance (&r);
        double factor = r.step.factor, after = pg_solver_report_now (r.solver)->energy.strain;
        after /= factor * factor;
        if (grown > 2) work += factor * factor * (before - after), length += (before - after) / G;
        grown += (before - after) / G, before = after;
    }
    assert_true (length > 4);
    clear (&r);
    return work / length / 1e-3;
}

static void cracks_that_grow_bond_by_bond_consume_it (void **state)
{
    static const double turn[] = { 30, 0, 15, 45 };
    static const char *const failure[] = { "criterion: stretch", "criterion: stretch",
                                          "criterion: beam_limits" };
    int all = longer ();
    (void) state;
    for (int k = 0; k < (all ? 3 : 1); k++) {
        double mean = 0;
        for (int a = 0; a < (all ? 4 : 1); a++) {
            double share = consumed (&theories[k], turn[a], failure[k]);
            print_message ("%-12s %2g degrees, bond by bond: %.3f of the fracture energy\n",
                           theories[k].method, turn[a], share);
            assert_true (fabs (share - 1) < 0.15);
            mean += share / (all ? 4 : 1);
        }
        if (all) assert_true (fabs (mean - 1) < 0.05);
    }
}

int main (void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test (a_strip_grows_at_the_fracture_energy),
                                        cmocka_unit_test (cracks_that_grow_bond_by_bond_consume_it),
                                        cmocka_unit_test (inclined_cracks_kink_as_they_should) };
    return cmocka_run_group_tests (tests, NULL, NULL);
}
