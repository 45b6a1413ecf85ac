/* SPDX-License-Identifier: GPL-3.0-or-later
 * Cut cells in whole runs: the pressed ring (Lame) converges at second order in 2D and 3D where the staircase
 * does not; linear fields under tractions and Nitsche's supports on arcs are found up to the quadrature,
 * order by order; slivers do not spoil the equations; reactions. */
#include "run.h"

static const double pi = 3.14159265358979323846;

/* ---- ring, inner radius 1 m, outer 2 m, 1 Pa inside, E 1 kPa, nu 0.3 ----------------------------------- */
/* u_r = ((1 - nu') r / 3 + (1 + nu') 4 / (3 r)) / E', in plane strain E' = E / (1 - nu^2), nu' = nu / (1 -
 * nu). */
static double radial (double r, int strain)
{
    double nu = strain ? 0.3 / 0.7 : 0.3, E = strain ? 1000 / 0.91 : 1000;
    return ((1 - nu) * r / 3 + (1 + nu) * 4 / (3 * r)) / E;
}

/* L2 error of the displacement at the points, relative. */
static double ring_error (const run *r, int strain)
{
    size_t dim = (size_t) r->problem->dim;
    double *u = field_of (r, NULL, "displacement", NULL), sum[2] = { 0 };
    for (size_t i = 0; i < r->problem->cloud.n; i++) {
        const double *x = r->problem->cloud.x + dim * i;
        double radius = hypot (x[0], x[1]), V = r->problem->cloud.volume[i], exact = radial (radius, strain),
               d = 0;
        for (size_t k = 0; k < dim; k++) d += pow (u[dim*i + k] - (k < 2 ? exact * x[k] / radius : 0), 2);
        sum[0] += V * d, sum[1] += V * exact * exact;
    }
    pg_free (u);
    return sqrt (sum[0] / sum[1]);
}

#define RING \
    "materials: {m: {youngs_modulus: 1000 Pa, poissons_ratio: 0.3}}\n" \
    "sets: {bore: {boundary: hole}, ax: {where: 'abs(x) < 1e-6'}, ay: {where: 'abs(y) < 1e-6'}}\n" \
    "method: {approximation: rkpm, integration: gauss, kernel: cubic_spline, horizon: 2 spacing}\n" \
    "solver: {kind: static}\noutput: {at: {levels: 1}}\n" \
    "boundary:\n  - {set: bore, pressure: 1 Pa}\n  - {set: ax, displacement: {x: 0}}\n  - {set: ay, " \
    "displacement: {y: 0}}\n"

static double plane_ring (double spacing, const char *plane, const char *cells)
{
    run r = scene_of (
        1,
        "dimension: 2\nplane: %s\ncells: %s\nspacing: %g\nbody: [{add: {disk: {center: [0, 0], radius: 2}}}, "
        "{subtract: {disk: {center: [0, 0], radius: 1}}}]\n" RING,
        plane, cells, spacing);
    to_the_end (&r);
    check_below (r.step.residual, 1e-10);
    double e = ring_error (&r, !strcmp (plane, "strain"));
    clear (&r);
    return e;
}

static void ring_in_plane (const char *plane)
{
    double e[3], stairs = plane_ring (0.05, plane, "staircase");
    for (int k = 0; k < 3; k++) e[k] = plane_ring (0.2 / (1 << k), plane, "cut");
    print_message ("ring, plane %s: %.2e, %.2e, %.2e (orders %.2f, %.2f); staircase %.2e\n", plane, e[0],
                   e[1], e[2], log2 (e[0] / e[1]), log2 (e[1] / e[2]), stairs);
    check_below (e[2], 2e-4);
    check_below (e[0], 2.5e-3);
    check_below (e[1], 2.5e-3 / 3.5);
    /* over both halvings, since what is left on the coarse lattice is a fifth less than that */
    check_below (e[2], e[0] / (3.5 * 3.5));
    check_below (e[2], e[1] / 3.5);
    assert_true (stairs > 50 * e[2]);
}

static void ring_in_plane_stress (void **state) { (void) state, ring_in_plane ("stress"); }
static void ring_in_plane_strain (void **state) { (void) state, ring_in_plane ("strain"); }

static double slice (double spacing)
{
    run r = scene_of (
        2,
        "dimension: 3\nspacing: %g\nbody: [{add: {cylinder: {center: [0, 0, 0], radius: 2, length: %g}}}, "
        "{subtract: {cylinder: {center: [0, 0, 0], radius: 1, length: %g}}}]\n" RING
        "  - {set: back, displacement: {z: 0}}\n  - {set: front, displacement: {z: 0}}\n",
        spacing, 2 * spacing, 2 * spacing);
    to_the_end (&r);
    check_below (r.step.residual, 1e-9);
    double e = ring_error (&r, 1);
    clear (&r);
    return e;
}

static void slice_of_a_thick_cylinder (void **state)
{
    (void) state;
    double e[2] = { slice (0.25), slice (0.125) };
    print_message ("thick cylinder, slice in 3D: %.2e, %.2e (order %.2f)\n", e[0], e[1], log2 (e[0] / e[1]));
    check_below (e[1], 2e-3);
    check_below (e[1], e[0] / 3);
}

/* ---- linear fields: u = (x, -0.3 y) / E under sigma_xx = 1 --------------------------------------------- */
static double linear_error (const run *r)
{
    double *u = field_of (r, NULL, "displacement", NULL), worst = 0;
    for (size_t i = 0; i < r->problem->cloud.n; i++) {
        const double *x = r->problem->cloud.x + 2 * i;
        worst = fmax (worst, fmax (fabs (u[2*i] - 1e-3 * x[0]), fabs (u[2*i + 1] + 0.3e-3 * x[1])));
    }
    pg_free (u);
    return worst / 1e-3;
}

#define PATCH \
    "dimension: 2\ncells: %s\nspacing: 0.13\nmaterials: {m: {youngs_modulus: 1000 Pa, poissons_ratio: " \
    "0.3}}\n" \
    "method: {approximation: rkpm, integration: gauss, gauss_points: %d, kernel: cubic_spline, horizon: 2 " \
    "spacing}\nsolver: {kind: static}\noutput: {at: {levels: 1}}\n"
#define HELD \
    "  - {set: ax, displacement: {x: '0.001 * x'}}\n  - {set: ay, displacement: {y: '-0.0003 * y'}}\n"
static const char *const patches[3] = {
    /* tractions on the rim of a disk */
    PATCH "body: [{add: {disk: {center: [0, 0], radius: 1}}}]\nsets: {around: {boundary: rim}, ax: {where: "
          "'abs(x) < 1e-6'}, ay: {where: 'abs(y) < 1e-6'}}\n"
          "boundary:\n  - {set: around, traction: {x: '1 Pa * x / (1 m)'}}\n" HELD,
    /* plate with a hole whose wall carries what it would without one */
    PATCH "body: [{add: {box: {low: [-1, -1], high: [1, 1]}}}, {subtract: {disk: {center: [0.2, 0.1], "
          "radius: 0.37}}}]\n"
          "sets: {bore: {boundary: hole}, ax: {where: 'abs(x) < 0.01'}, ay: {where: 'abs(y) < 0.01'}}\n"
          "boundary:\n  - {set: left, displacement: {x: '-0.001 * (1 m)', y: '-0.0003 * y'}}\n  - {set: "
          "right, traction: {x: 1 Pa}}\n"
          "  - {set: bore, traction: {x: '-1 Pa * (x - 0.2 m) / (0.37 m)'}}\n",
    /* Nitsche on the whole rim */
    PATCH "body: [{add: {disk: {center: [0, 0], radius: 1}}}]\nsets: {around: {boundary: rim}}\n"
          "boundary:\n  - {set: around, displacement: {x: '0.001 * x', y: '-0.0003 * y'}}\n"
};

static void linear_fields_are_found_to_the_quadrature (void **state)
{
    static const char *const name[3] = { "traction on a disk", "plate with a hole", "Nitsche on a disk" };
    (void) state;
    for (int k = 0; k < 3; k++) {
        double e[3], stairs;
        for (int i = 0; i < 4; i++) {
            char text[2000];
            snprintf (text, sizeof text, patches[k], i == 3 ? "staircase" : "cut",
                      i == 0   ? 2
                      : i == 1 ? 3
                               : 5);
            run r = prepare (1, text);
            to_the_end (&r);
            check_below (r.step.residual, 1e-10);
            if (i < 3) e[i] = linear_error (&r);
            else stairs = linear_error (&r);
            clear (&r);
        }
        print_message ("%-20s: %.2e, %.2e, %.2e (2, 3, 5 Gauss points); staircase %.2e (5)\n", name[k], e[0],
                       e[1], e[2], stairs);
        check_below (e[0], 3e-3);
        check_below (e[2], 2e-4);
        assert_true (e[1] < 0.5 * e[0] && e[2] < 0.3 * e[1]);
    }
}

/* A hole that leaves slivers of every size in the cells: the residual stays at rounding. */
static void slivers_do_no_harm (void **state)
{
    double worst = 0;
    (void) state;
    for (int k = 0; k < 8; k++) {
        double radius = 0.3 + pow (10, -1 - k);
        run r = scene_of (1,
                          "dimension: 2\nspacing: 0.1\nbody: [{add: {box: {low: [-1, -1], high: [1, 1]}}}, "
                          "{subtract: {disk: {center: [0, 0], radius: %.17g}}}]\n"
                          "materials: {m: {youngs_modulus: 1000 Pa, poissons_ratio: 0.3}}\nmethod: "
                          "{approximation: rkpm, integration: gauss, horizon: 2 spacing}\n"
                          "boundary: [{set: left, displacement: {x: 0, y: 0}}, {set: right, displacement: "
                          "{x: 1 mm, y: 0}}]\nsolver: {kind: static}\noutput: {at: {levels: 1}}\n",
                          radius);
        to_the_end (&r);
        worst = fmax (worst, r.step.residual);
        check_relative (r.step.reaction[0], -r.step.reaction[3], 1e-9);
        clear (&r);
    }
    print_message ("slivers down to 1e-8 m: largest residual %.1e\n", worst);
    check_below (worst, 1e-11);
}

/* The force of a pressure on a wall is p times its shadow. */
static void pressure_on_an_arc_carries_its_shadow (void **state)
{
    (void) state;
    run r = scene_of (1, "dimension: 2\nspacing: 0.13\nbody: [{add: {disk: {center: [0, 0], radius: 1}}}]\n"
                         "materials: {m: {youngs_modulus: 1000 Pa, poissons_ratio: 0.3}}\nmethod: "
                         "{approximation: rkpm, integration: gauss, horizon: 2 spacing}\n"
                         "sets: {up: {boundary: rim, where: 'y > 0'}, low: {boundary: rim, where: 'y < 0'}}\n"
                         "boundary: [{set: up, pressure: 1 Pa}, {set: low, displacement: {x: 0, y: "
                         "0}}]\nsolver: {kind: static}\noutput: {at: {levels: 1}}\n");
    double shadow = 0, length = 0;
    const pg_set *up = r.problem->boundary.load[0].set;
    for (size_t k = 0; k < up->nfacet; k++) {
        shadow += r.problem->cells.area[up->facet[k]] * r.problem->cells.normal[2 * up->facet[k] + 1];
        length += r.problem->cells.area[up->facet[k]];
    }
    to_the_end (&r);
    check_relative (length, pi, 0.05);
    check_relative (r.step.reaction[1], -shadow, 2e-3);
    check_relative (r.step.reaction[4], -r.step.reaction[1], 1e-9);
    clear (&r);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (ring_in_plane_stress),
        cmocka_unit_test (ring_in_plane_strain),
        cmocka_unit_test (slice_of_a_thick_cylinder),
        cmocka_unit_test (linear_fields_are_found_to_the_quadrature),
        cmocka_unit_test (slivers_do_no_harm),
        cmocka_unit_test (pressure_on_an_arc_carries_its_shadow),
    };
    return cmocka_run_group_tests_name ("scene_runs/cut_cells", tests, NULL, NULL);
}
