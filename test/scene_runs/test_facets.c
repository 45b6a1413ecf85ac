/* SPDX-License-Identifier: GPL-3.0-or-later
 * Cracks that grow by facets, whole runs: load of growth, energy, path and kink against what is known, on
 * lattices that lie in several ways against the body. All bodies, lattices and methods: bench/fracture. */
#include "run.h"

#define FOLDER "data/fracture/"
static const double H = 0.005, G0 = 8;                 /* of these scenes: spacing, m; J/m^2 */

/* What a run has done. */
typedef struct {
    size_t events;
    double mean, low, high;                            /* load factors of the events over the theory */
    double energy, least;                              /* dissipated over G0 x area: all, and of one event */
    double off;                                        /* of the first tip from its line, m */
    double tip[4];                                     /* where the first two tips are at the end, m */
} grown;

/* Load factor at which a crack of that length (m) grows. */
typedef double (*theory) (double length);

/* Runs to the end. The line through the first tip has the direction `along`. */
static grown follow (run *r, theory known, double start, const double *along)
{
    grown g = { .low = 10, .least = 10 };
    double from[2] = { r->state->paths->tip[0].x[0], r->state->paths->tip[0].x[1] }, before = 0, sum = 0;
    while (!pg_solver_done (r->solver, r->state)) {
        advance (r);
        if (!r->step.event) continue;
        const pg_crack_paths *w = r->state->paths;
        double ratio = r->step.factor / known (start + before), area = w->length - before;
        g.events++, g.mean += ratio, sum += r->step.dissipated, before = w->length;
        g.low = fmin (g.low, ratio), g.high = fmax (g.high, ratio);
        g.least = fmin (g.least, r->step.dissipated / (G0 * area));
        double d[2] = { w->tip[0].x[0] - from[0], w->tip[0].x[1] - from[1] };
        g.off = fmax (g.off, fabs (along[0] * d[1] - along[1] * d[0]));
    }
    g.mean /= (double) g.events, g.energy = sum / (G0 * before);
    for (size_t i = 0; i < 2 && i < r->state->paths->ntip; i++)
        memcpy (g.tip + 2*i, r->state->paths->tip[i].x, 2 * sizeof (double));
    return g;
}

static void show (const char *name, const grown *g)
{
    print_message ("%-22s %2zu events, load %.4f (%.4f to %.4f), energy %.4f, least %.2f, off %.3f h\n", name,
                   g->events, g->mean, g->low, g->high, g->energy, g->least, g->off / H);
}

/* Full loads of the scenes are three times those of first growth. */
static double constant (double length) { (void) length; return 1.0 / 3; }

static const double along_x[2] = { 1, 0 };

/* The strip holds what is released exactly, whatever the lattice: the crack between two rows of points, and
 * elsewhere between them. Off the middle of the strip by y it is drawn back: K_II / K_I of a straight crack
 * there is .41 y over the height (finite elements, data/fracture_fem/reference.py, y of .02 and .05 of the
 * height), so that y' = - .82 y over the height, and .44 of y is left after 20 spacings, which are the
 * height. Found, in spacings, of .40 and -.45: .19 and -.19 (right: .18, -.20); with Gauss points .21 and
 * -.23. */
static void the_strip_takes_griffiths_load (void **state)
{
    static const double shift[][2] = { { 0, 0 }, { 0.37, 0.40 }, { 0.10, -0.45 } };
    (void) state;
    for (size_t k = longer () ? 0 : 1; k < sizeof shift / sizeof *shift; k++) {
        char from[64], to[64];
        snprintf (from, sizeof from, "cracks[0].from=[-0.02, %.17g]", shift[k][1] * H);
        snprintf (to, sizeof to, "cracks[0].to=[%.17g, %.17g]", 0.125 + shift[k][0] * H, shift[k][1] * H);
        const char *set[] = { from, to };
        run r = loaded (FOLDER "strip.yaml", 2, set);
        grown g = follow (&r, constant, 0, along_x);
        show ("strip", &g);
        assert_int_equal (g.events, 20);
        check_relative (g.mean, 1, 0.005);
        check_below (fmax (g.high - 1, 1 - g.low), 0.01);
        check_relative (g.energy, 1, 0.02);
        check_below (0.5, g.least);
        check_absolute (g.tip[1] / H, 0.44 * shift[k][1], 0.05);
        check_relative (r.state->paths->length, 20 * H, 1e-9);
        clear (&r);
    }
}

/* The body and its loads turned by 30 degrees against the lattice. */
static void turning_the_strip_changes_nothing (void **state)
{
    static const double corner[][2] = { { 0, -0.05 }, { 0.35, -0.05 }, { 0.35, 0.05 }, { 0, 0.05 } };
    const double turn = 0.52359877559829887, c = cos (turn), s = sin (turn);
    /* G = E / (1 - nu^2) (2 u)^2 / (2 height), at a third of the full load */
    const double u = 3 * 0.5 * sqrt (2 * G0 * 0.1 * (1 - 0.22 * 0.22) / 70e9);
    char outline[512] = "";
    (void) state;
    for (int k = 0; k < 4; k++)
        snprintf (outline + strlen (outline), sizeof outline - strlen (outline), "%s[%.15g, %.15g]",
                  k ? ", " : "", c * corner[k][0] - s * corner[k][1],
                  s * corner[k][0] + c * corner[k][1]);
    run r = scene_of (1,
                      "dimension: 2\nthickness: 1\nbody: [{add: {polygon: {vertices: [%s]}}}]\n"
                      "spacing: 0.005\nlattice: cells\nlattice_offset: [0.13, 0.29]\n"
                      "cracks: [{from: [%.15g, %.15g], to: [%.15g, %.15g]}]\n"
                      "materials: {glass: {youngs_modulus: 70 GPa, poissons_ratio: 0.22}}\n"
                      "failure: {criterion: energy_release, fracture_energy: 8}\nboundary:\n"
                      "  - {set: polygon.edge 1, displacement: {x: %.15g, y: %.15g}}\n"
                      "  - {set: polygon.edge 3, displacement: {x: %.15g, y: %.15g}}\n"
                      "solver: {kind: static, max_events: 20}\noutput: {at: {levels: 1}}\n",
                      outline, -0.02 * c, -0.02 * s, 0.125 * c, 0.125 * s, s * u, -c * u, -s * u, c * u);
    const double along[2] = { c, s };
    grown g = follow (&r, constant, 0, along);
    show ("strip turned by 30", &g);
    assert_int_equal (g.events, 20);
    check_relative (g.mean, 1, 0.01);
    check_below (fmax (g.high - 1, 1 - g.low), 0.02);
    check_relative (g.energy, 1, 0.03);
    check_below (g.off, 0.2 * H);
    clear (&r);
}

/* K of an edge notch (Tada, Paris, Irwin), width 1. */
static double notch_shape (double a)
{
    double half = 1.5707963267948966 * a;
    return sqrt (3.14159265358979324 * a * tan (half) / half)
           * (0.752 + 2.02 * a + 0.37 * pow (1 - sin (half), 3)) / cos (half);
}

static double notch (double length) { return notch_shape (0.4) / notch_shape (length / 0.1) / 3; }

/* The load falls to a third while the notch grows from 0.4 to 0.7 of the width: snap-back. */
static void the_notch_follows_the_handbook (void **state)
{
    (void) state;
    run r = loaded (FOLDER "edge_notch.yaml", 0, NULL);
    grown g = follow (&r, notch, 0.04, along_x);
    show ("edge notch", &g);
    assert_int_equal (g.events, 6);
    check_relative (g.mean, 1, 0.03);
    check_below (fmax (g.high - 1, 1 - g.low), 0.05);
    check_relative (g.energy, 1, 0.04);
    check_below (g.off, 0.1 * H);
    clear (&r);
}

/* Held to its path, a crack in shear takes the load of mode II. */
static void a_path_in_shear_takes_its_energy (void **state)
{
    (void) state;
    run r = loaded (FOLDER "shear_strip.yaml", 0, NULL);
    grown g = follow (&r, constant, 0, along_x);
    show ("strip in shear", &g);
    check_relative (g.mean, 1, 0.02);
    check_relative (g.energy, 1, 0.04);
    check_below (g.off, 1e-9 * H);
    clear (&r);
}

/* Without a path it kinks by 70.5 degrees at once. */
static void without_a_path_shear_kinks (void **state)
{
    const char *set[] = { "failure={criterion: energy_release, fracture_energy: 8}", "solver.max_events=1" };
    (void) state;
    run r = loaded (FOLDER "shear_strip.yaml", 2, set);
    grown g = follow (&r, constant, 0, along_x);
    double angle = atan2 (g.tip[1], g.tip[0] - 0.125) / 0.017453292519943295;
    print_message ("first facet at %.1f degrees\n", angle);
    check_below (fabs (fabs (angle) - 70.5), 3);
    clear (&r);
}

/* Both tips of a crack at 45 degrees to the load turn by 53 degrees towards the way across it. */
static void an_inclined_crack_turns (void **state)
{
    const char *set[] = { "solver.max_events=2" };
    (void) state;
    run r = loaded (FOLDER "inclined_45.yaml", 1, set);
    pg_tip before[2] = { r.state->paths->tip[0], r.state->paths->tip[1] };
    follow (&r, constant, 0, along_x);
    int moved = 0;
    for (int i = 0; i < 2; i++) {
        const pg_tip *now = &r.state->paths->tip[i];
        double sign = before[i].x[0] > before[1 - i].x[0] ? 1 : -1, turn;
        if (!(now->grown > 0)) continue;
        moved++;
        const pg_crack *first = NULL;                  /* the facet that leaves this tip */
        for (size_t k = 0; k < r.state->paths->cracks.n && !first; k++) {
            const pg_crack *c = &r.state->paths->cracks.crack[k];
            for (int e = 0; e < 2; e++)
                if (r.state->paths->owner[k] == now->id
                    && hypot (c->vertex[2*e] - before[i].x[0], c->vertex[2*e + 1] - before[i].x[1]) < 1e-9)
                    first = c;
        }
        assert_non_null (first);
        int e = hypot (first->vertex[0] - before[i].x[0], first->vertex[1] - before[i].x[1]) < 1e-9;
        turn = atan2 (sign * (first->vertex[2*e + 1] - before[i].x[1]),
                      sign * (first->vertex[2*e] - before[i].x[0]));
        turn = turn / 0.017453292519943295 - 45;
        print_message ("tip %d turns by %.1f degrees\n", i + 1, turn);
        check_below (fabs (turn + 53.1), 3);
    }
    assert_true (moved > 0);
    clear (&r);
}

static double doubled (double length) { return (length < 0.175 - 1e-9 ? 1 : sqrt (2)) / 3; }

/* Across an interface beyond which the fracture energy is twice as large the load grows by the root of 2. */
static void an_interface_is_crossed (void **state)
{
    (void) state;
    run r = loaded (FOLDER "across.yaml", 0, NULL);
    grown g = follow (&r, doubled, 0.125, along_x);
    show ("across an interface", &g);
    assert_int_equal (g.events, 20);
    check_relative (g.mean, 1, 0.02);
    check_below (fmax (g.high - 1, 1 - g.low), 0.05);
    clear (&r);
}

int main (void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test (the_strip_takes_griffiths_load),
                                        cmocka_unit_test (turning_the_strip_changes_nothing),
                                        cmocka_unit_test (the_notch_follows_the_handbook),
                                        cmocka_unit_test (a_path_in_shear_takes_its_energy),
                                        cmocka_unit_test (without_a_path_shear_kinks),
                                        cmocka_unit_test (an_inclined_crack_turns),
                                        cmocka_unit_test (an_interface_is_crossed) };
    return cmocka_run_group_tests_name ("scene_runs/facets", tests, NULL, NULL);
}
