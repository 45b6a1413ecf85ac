/* SPDX-License-Identifier: GPL-3.0-or-later
 * Discs and ellipses in space that grow by their fronts, whole runs: ellipses become round, tilted discs grow
 * wings. Straight fronts: test_front_growth.c. */
#include "run.h"

static const double G0 = 8, E = 70e9, NU = 0.22;

/* A cube of 2 L in tension along y, a disc of a radius with a normal in it; scale: m a spacing. */
static run cube (double L, const char *crack, double scale, double amount, int events)
{
    return scene_of (1, "dimension: 3\nspacing: %.17g m\nperturb: {amount: %g, seed: 3}\n"
                        "body: [{add: {box: {low: [%.17g, %.17g, %.17g], high: [%.17g, %.17g, %.17g]}}}]\n"
                        "cracks: [%s]\nmaterials: {glass: {youngs_modulus: %g, poissons_ratio: %g}}\n"
                        "boundary: [{set: bottom, displacement: {y: %.17g}}, {set: top, "
                        "displacement: {y: %.17g}}, "
                        "{set: left, displacement: {x: 0}}, {set: back, displacement: {z: 0}}]\n"
                        "method: {horizon: 2.01 spacing}\n"
                        "failure: {criterion: energy_release, fracture_energy: %g}\n"
                        "solver: {max_events: %d}\n", scale, amount, -L * scale, -L * scale, -L * scale,
                            L * scale,
                     L * scale, L * scale, crack, E, NU, -L * scale * 1e-3, L * scale * 1e-3, G0 * scale,
                         events);
}

/* Least and largest distance of the vertices of the one front from a place. */
typedef struct { double low, high; size_t n; } radii;

static radii radii_of (const run *r, const double *c)
{
    size_t nfront;
    const pg_front *front = pg_fronts_of_state (r->problem, r->state, &nfront);
    radii s = { .low = INFINITY, .n = front->n };
    assert_true (nfront == 1 && front->open);
    for (size_t i = 0; i < front->n; i++) {
        const double *x = front->x + 3*i;
        double v = hypot (hypot (x[0] - c[0], x[1] - c[1]), x[2] - c[2]);
        s.low = fmin (s.low, v), s.high = fmax (s.high, v);
    }
    return s;
}

/* An ellipse of 3.2 by 5.4 spacings, as a polygon, in a plane that lies in none of the lattice's.
 * PERIGAL_TEST_SIZE=long. */
static void an_ellipse_becomes_round (void **state)
{
    (void) state;
    if (!longer ()) return;
    enum { SIDES = 28 };
    char crack[4000] = "{polygon: [";
    const double c[3] = { 0.2, 0.31, 0.1 };
    size_t at = strlen (crack);
    for (int k = 0; k < SIDES; k++) {
        double t = 2 * acos (-1) * k / SIDES, a = 5.4 * cos (t), b = 3.2 * sin (t), turn = 0.35;
        at += (size_t) snprintf (crack + at, sizeof crack - at, "%s[%.9g, %.9g, %.9g]", k ? ", " : "",
                                 c[0] + a * cos (turn) - b * sin (turn), c[1],
                                 c[2] + a * sin (turn) + b * cos (turn));
    }
    snprintf (crack + at, sizeof crack - at, "]}");
    run r = cube (11.5, crack, 1, 0.1, 4);
    double spent = 0;
    while (!pg_solver_done (r.solver, r.state)) {
        advance (&r);
        if (!r.step.event) continue;
        radii s = radii_of (&r, c);
        spent += r.step.dissipated;
        print_message ("radii %.3f to %.3f, %zu vertices, energy %.3f\n", s.low, s.high, s.n,
                       spent / (G0 * r.state->surfaces->area));
    }
    radii s = radii_of (&r, c);
    check_below (s.high / s.low, 1.15);
    check_relative (spent, G0 * r.state->surfaces->area, 0.06);
    clear (&r);
}

/* The ends of the one front along the steepest line of a disc, and how far they are off its plane, in m. */
typedef struct { double at[2], off[2]; } wings;

static wings wings_of (const run *r, double m)
{
    wings w = { .at = { 0, 0 } };
    size_t nfront;
    const pg_front *front = pg_fronts_of_state (r->problem, r->state, &nfront);
    assert_int_equal (nfront, 1);
    for (size_t i = 0; i < front->n; i++) {
        const double *x = front->x + 3*i;
        /* along the steepest line (1, -1, 0) and across the disc (1, 1, 0) */
        double s = (x[0] / m - 0.2 - x[1] / m + 0.31) / sqrt (2),
               n = (x[0] / m - 0.2 + x[1] / m - 0.31) / sqrt (2);
        if (s > w.at[1]) w.at[1] = s, w.off[1] = n;
        if (s < w.at[0]) w.at[0] = s, w.off[0] = n;
    }
    print_message ("ends at %.3f %.3f, off the plane by %.3f %.3f\n", w.at[0], w.at[1], w.off[0], w.off[1]);
    return w;
}

/* A disc tilted by 45 degrees: at the ends of the steepest line it kinks towards the plane across the load,
 * at the sides it does not; both ends alike. PERIGAL_TEST_SIZE=long: a larger one, in two events, and the
 * same with millimetres for metres; else in one event. */
static void a_tilted_disc_grows_wings (void **state)
{
    (void) state;
    const int events = longer () ? 2 : 1;
    const double radius = longer () ? 4.5 : 3, L = longer () ? 8 : 5.5;
    wings w[2][2];
    for (int unit = 0; unit <= longer (); unit++) {
        double m = unit ? 1e-3 : 1;
        char crack[200];
        snprintf (crack, sizeof crack, "{disc: {center: [%.17g, %.17g, %.17g], normal: [1, 1, 0], "
                                       "radius: %.17g}}",
                  0.2 * m, 0.31 * m, 0.1 * m, radius * m);
        run r = cube (L, crack, m, 0, events);
        for (int event = 0; !pg_solver_done (r.solver, r.state); ) {
            advance (&r);
            if (r.step.event) w[unit][event++] = wings_of (&r, m);
        }
        for (int event = 0; unit && event < events; event++)
            for (int q = 0; q < 2; q++) check_relative (w[1][event].off[q], w[0][event].off[q], 1e-3);
        clear (&r);
    }
    const wings *last = &w[0][events - 1];
    check_below (radius + 0.25 * events, last->at[1]);
    check_below (last->at[0], -radius - 0.25 * events);
    /* from (1, -1) towards (1, 0): n > 0 there */
    check_below (0.3, last->off[1]);
    check_below (last->off[0], -0.3);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (a_tilted_disc_grows_wings),
        cmocka_unit_test (an_ellipse_becomes_round),
    };
    return cmocka_run_group_tests_name ("scene_runs/disc_growth", tests, NULL, NULL);
}
