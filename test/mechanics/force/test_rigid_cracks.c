/* SPDX-License-Identifier: GPL-3.0-or-later
 * A rigid motion strains nothing beside cracks: polylines of 2 to 5 vertices, kinks of up to 80 degrees,
 * segments of 1 to 3 spacings, on lattices with random offsets or of points moved at random, some with a
 * vertex on a side of a cell, on a corner or on a point of evaluation. "Strain" is the largest at any point
 * of evaluation, for a translation by one spacing and for a turn by one radian. A point that sees too little
 * for a strain has none (degenerate_points). Few cracks as a rule, more with PERIGAL_TEST_SIZE=long;
 * PERIGAL_SEED: others. */
#include <math.h>
#include "scene_runs/run.h"
#include "mechanics/galerkin/weak_form/galerkin.h"

static double between (unsigned *seed, double low, double high)
{
    *seed = *seed * 1664525u + 1013904223u;
    return low + (high - low) * (*seed >> 8) / (double) (1u << 24);
}

enum { VERTICES = 5 };

/* A random polyline; snapped: its second vertex lies on a side of a cell. */
static int polyline (unsigned *seed, const double *offset, int snapped, double x[VERTICES][2])
{
    int n = 2 + (int) between (seed, 0, 3.999);
    double angle = between (seed, 0, 2 * M_PI);
    x[0][0] = between (seed, -0.1, 0.1), x[0][1] = between (seed, -0.1, 0.1);
    for (int k = 1; k < n; k++) {
        double length = 0.1 * between (seed, 1, 3);
        x[k][0] = x[k - 1][0] + length * cos (angle), x[k][1] = x[k - 1][1] + length * sin (angle);
        if (k == 1 && snapped)
            for (int c = 0; c < snapped; c++) x[k][c] = 0.1 * (round (x[k][c] / 0.1 - offset[c]) + offset[c]);
        angle += between (seed, -1.4, 1.4);
    }
    return n;
}

/* The largest strain of the evaluation points under a translation and a turn. */
static double largest (const galerkin *g, int turn)
{
    double worst = 0, h = g->problem->cloud.h;
    const pg_rows *r = &g->sums;
    for (size_t p = 0; p < r->n; p++) {
        double G[4] = { 0 };
        size_t offset = pg_rows_offset (r, p);
        for (size_t e = r->family.start[p]; e < r->family.start[p + 1]; e++) {
            const double *x = g->problem->cloud.x + 2 * (size_t) r->family.node[e];
            double u[2] = { turn ? -x[1] : h, turn ? x[0] : h };
            for (size_t k = 0; k < 4; k++) G[k] += r->dN[2 * (e + offset) + k % 2] * u[k / 2];
        }
        worst = fmax (worst, fmax (fmax (fabs (G[0]), fabs (G[3])), fabs (G[1] + G[2]) / 2));
    }
    return worst;
}

/* The largest strain beside a crack (vertices in YAML). */
static double strain (const char *integration, const char *crack, const double *offset, const char *moved)
{
    run r = scene_of (1, "dimension: 2\nbody: [{add: {box: {low: [-0.9, -0.9], high: [0.9, 0.9]}}}]\n"
                         "spacing: 0.1\nlattice: cells\nlattice_offset: [%.15g, %.15g]\n%s"
                         "cracks: [{polyline: [%s]}]\n"
                         "materials: {m: {youngs_modulus: 1, poissons_ratio: 0.3}}\n"
                         "method: {approximation: rkpm, integration: %s}\n"
                         "boundary: [{set: left, displacement: {x: 0, y: 0}}]\n"
                         "solver: {kind: static, steps: 1, stepping: fixed}\n",
                      offset[0], offset[1], moved, crack, integration);
    void *self;
    const pg_force_type *force = pg_solver_force (r.solver, &self);
    check_ok (force->refresh (self, r.state, NULL));
    double worst = fmax (largest (self, 0), largest (self, 1));
    if (worst > 1e-9)
        print_message ("  %s: %.2e at offset %.15g %.15g, %s crack %s\n", integration, worst, offset[0],
                       offset[1], moved, crack);
    clear (&r);
    return worst;
}

static double any_crack (const char *integration, unsigned *seed, int snapped)
{
    char crack[400] = "", moved[60] = "";
    double x[VERTICES][2], offset[2] = { between (seed, 0, 1), between (seed, 0, 1) };
    int n = polyline (seed, offset, snapped, x), used = 0;
    if (between (seed, 0, 1) < 0.3)
        snprintf (moved, sizeof moved, "perturb: {amount: 0.2, seed: %d}\n", (int) between (seed, 1, 999));
    for (int k = 0; k < n; k++)
        used += snprintf (crack + used, sizeof crack - (size_t) used, "%s[%.15g, %.15g]", k ? ", " : "",
                          x[k][0], x[k][1]);
    return strain (integration, crack, offset, moved);
}

/* Both segments at a kink on a side of a cell lie beyond that side: they divide the cell there, and not this
 * one, whose side has two parts beyond it. */
static void a_kink_on_a_side_divides_the_side (void **state)
{
    static const struct { double offset[2]; const char *moved, *crack; } known[] = {
        { { 0.70777815580368, 0.704961657524109 }, "",
          "[0.015526, 0.0776185], [-0.029222184419632, -0.187460292327799], [0.170933, -0.305223], "
          "[0.210154, -0.57057]" },
        { { 0.293294548988342, 0.433972299098969 }, "perturb: {amount: 0.2, seed: 367}\n",
          "[-0.004432857, 0.0639147], [0.129329454898834, -0.186774202054426], [0.00886049, -0.286466647], "
          "[-0.015164, -0.3982033], [0.04783, -0.555005]" },
        { { 0, 0 }, "", "[-0.46602, -0.2], [-0.033975, 0], [0.4, -0.2]" },
    };
    (void) state;
    for (size_t k = 0; k < sizeof known / sizeof *known; k++)
        check_below (strain ("consistent", known[k].crack, known[k].offset, known[k].moved), 1e-9);
}

static void rigid_motions_strain_nothing (void **state)
{
    const char *given = getenv ("PERIGAL_SEED");
    int times = longer () ? 600 : 24, wrong = 0;
    unsigned seed = given ? (unsigned) strtoul (given, NULL, 10) : 1;
    (void) state;
    for (int k = 0; k < times; k++)
        wrong += any_crack (k % 4 == 3 ? "gauss" : "consistent", &seed, k % 3) > 1e-9;
    print_message ("  %d of %d cracks\n", wrong, times);
    assert_int_equal (wrong, 0);
}

/* A coarse body with cracks, held where `held` says and moved as a rigid one by that support alone: the
 * energy of its strains over that of a strain as large as the turn. *few: share of the points of evaluation
 * that see too little. */
static double energy_of_turn (int dim, const char *method, double spacing, const char *lattice,
                              const char *cracks, const char *held, double *few)
{
    run r = scene_of (1, "dimension: %d\nbody: [{add: {box: {low: [0, 0%s], high: [1, 0.8%s]}}}]\n"
                         "spacing: %.15g\n%scracks: [%s]\n"
                         "materials: {m: {youngs_modulus: 1, poissons_ratio: 0.3}}\n"
                         "method: {%s}\nsets: {held: {boundary: [all], where: \"%s\"}}\n"
                         "boundary: [{set: held, displacement: {x: \"0.002 m - 0.001*y\", "
                         "y: \"-0.001 m + 0.001*x\"%s}}]\nsolver: {kind: static}\n",
                      dim, dim == 3 ? ", 0" : "", dim == 3 ? ", 0.6" : "", spacing, lattice, cracks, method,
                      held, dim == 3 ? ", z: 0.003" : "");
    to_the_end (&r);
    const pg_statistics *s = pg_solver_report (r.solver, r.state);
    double energy = s->energy.strain / (0.5 * 1e-6);
    *few = (double) s->degenerate_points / (double) r.problem->bonds.rows[PG_POINTS].n;
    if (energy > 1e-12)
        print_message ("  %dD %s: %.1e at spacing %g, %scracks: %s held: %s\n", dim, method, energy, spacing,
                       lattice, cracks, held);
    clear (&r);
    return energy;
}

/* One to three cracks anywhere in a body of 1 x 0.8 (x 0.6), of two segments (in space: a triangle) each. */
static void random_cracks (unsigned *seed, int dim, char *out, size_t size)
{
    int n = 1 + (int) between (seed, 0, 2.999), used = 0;
    for (int k = 0; k < n; k++) {
        used += snprintf (out + used, size - (size_t) used, "%s{%s: [", k ? ", " : "",
                          dim == 3 ? "polygon" : "polyline");
        double x[3] = { between (seed, 0.1, 0.9), between (seed, 0.1, 0.7), between (seed, 0.1, 0.5) };
        for (int v = 0; v < 3; v++) {
            used += snprintf (out + used, size - (size_t) used, "%s[%.15g, %.15g", v ? ", " : "", x[0], x[1]);
            used += snprintf (out + used, size - (size_t) used, dim == 3 ? ", %.15g]" : "]", x[2]);
            for (int c = 0; c < 3; c++) x[c] += between (seed, -0.35, 0.35);
        }
        used += snprintf (out + used, size - (size_t) used, "]}");
    }
}

static void supports_turn_coarse_bodies (void **state)
{
    static const char *const held[] = { "x > -1", "x < 0.3", "y < 0.2", "x > 0.99" },
                      *const plane[] = { "integration: consistent, horizon: 1.6 spacing",
                                         "integration: consistent", "integration: gauss" };
    const char *given = getenv ("PERIGAL_SEED");
    int times = longer () ? 300 : 24, wrong = 0;
    unsigned seed = given ? (unsigned) strtoul (given, NULL, 10) : 1;
    double few = 0;
    (void) state;
    for (int k = 0; k < times; k++) {
        char cracks[700] = "", lattice[100] = "lattice: cells\n";
        int dim = k % 3 == 2 ? 3 : 2;
        double share, h = 1 / between (&seed, dim == 3 ? 5 : 7, dim == 3 ? 7 : 14);
        random_cracks (&seed, dim, cracks, sizeof cracks);
        if (between (&seed, 0, 1) < 0.4)
            snprintf (lattice, sizeof lattice, "lattice: cells\nlattice_offset: [%.15g, %.15g%s]\n",
                      between (&seed, 0, 1), between (&seed, 0, 1), dim == 3 ? ", 0.3" : "");
        wrong += !(energy_of_turn (dim, plane[k % 4 % 3], h, lattice, cracks,
                                   held[(int) between (&seed, 0, 3.999)], &share) <= 1e-12);
        few += share / times;
    }
    print_message ("  %d of %d bodies; %.2g of the points see too little\n", wrong, times, few);
    assert_int_equal (wrong, 0);
    check_below (few, 0.006);
}

/* Cracks of a coarse body grow by facets, three events or as many as there are: a rigid motion strains
 * nothing afterwards, and derivatives are to the last bit those that are evaluated anew for the grown
 * cracks. */
static void grown_cracks_strain_nothing (void **state)
{
    const char *given = getenv ("PERIGAL_SEED");
    unsigned seed = given ? (unsigned) strtoul (given, NULL, 10) : 7;
    int times = longer () ? 60 : 6, grown = 0;
    (void) state;
    for (int k = 0; k < times; k++) {
        char crack[400] = "";
        double x[VERTICES][2], offset[2] = { between (&seed, 0, 1), between (&seed, 0, 1) };
        int n = polyline (&seed, offset, 0, x), used = 0;
        for (int v = 0; v < n; v++)
            used += snprintf (crack + used, sizeof crack - (size_t) used, "%s[%.15g, %.15g]", v ? ", " : "",
                              0.8 + 1.5 * x[v][0], 0.8 + 1.5 * x[v][1]);
        run r = scene_of (1, "dimension: 2\nbody: [{add: {box: {low: [0, 0], high: [1.6, 1.6]}}}]\n"
                             "spacing: 0.1\nlattice: cells\nlattice_offset: [%.15g, %.15g]\n"
                             "cracks: [{polyline: [%s]}]\n"
                             "materials: {m: {youngs_modulus: 1e9, poissons_ratio: 0.3}}\n"
                             "failure: {criterion: energy_release, fracture_energy: 10}\n"
                             "method: {integration: consistent, horizon: 1.6 spacing}\n"
                             "boundary: [{set: bottom, displacement: {x: 0, y: 0}}, "
                             "{set: top, displacement: {x: 0.0004, y: 0.001}}]\nsolver: {max_events: 3}\n",
                          offset[0], offset[1], crack);
        void *self;
        const pg_force_type *force = pg_solver_force (r.solver, &self);
        const galerkin *g = self;
        to_the_end (&r);
        grown += r.state->events > 0;
        size_t numbers = 2 * g->sums.family.start[g->sums.n];
        double *before = pg_calloc (numbers, sizeof *before);
        memcpy (before, g->sums.dN, numbers * sizeof *before);
        check_below (fmax (largest (g, 0), largest (g, 1)), 1e-9);
        check_ok (force->refresh (self, r.state, NULL));
        assert_memory_equal (before, g->sums.dN, numbers * sizeof *before);
        pg_free (before);
        clear (&r);
    }
    print_message ("  %d of %d cracks have grown\n", grown, times);
    assert_true (2 * grown >= times);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (rigid_motions_strain_nothing),
        cmocka_unit_test (a_kink_on_a_side_divides_the_side),
        cmocka_unit_test (supports_turn_coarse_bodies),
        cmocka_unit_test (grown_cracks_strain_nothing),
    };
    return cmocka_run_group_tests_name ("mechanics/force/rigid_cracks", tests, NULL, NULL);
}
