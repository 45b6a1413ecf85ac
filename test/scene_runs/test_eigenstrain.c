/* SPDX-License-Identifier: GPL-3.0-or-later
 * Temperature, shrinkage and pore pressure against closed forms: free bodies without stress, held ones, a
 * profile of temperature across a strip, cracks by restrained shrinkage, the balance of energies. */
#include <string.h>
#include "run.h"

#define MATERIAL \
    "materials: {rock: {youngs_modulus: 200 GPa, poissons_ratio: 0.3, density: 7800, " \
    "expansion: 1.2e-5 1/K, biot: 0.8}}\n"
static const double E = 200e9, nu = 0.3, free_strain = 1.2e-3;          /* of 100 K */

/* A box at the origin whose sides left, bottom and back are planes of symmetry, what the scene adds. unit: m
 * of
 * a length of 1 in `size`. */
static run box (const char *head, int dim, double unit, const char *more)
{
    char scene[200];
    snprintf (scene, sizeof scene,
              dim == 3 ? "body: [{add: {box: {low: [0, 0, 0], high: [%.17g, %.17g, %.17g]}}}]\n"
                       : "body: [{add: {box: {low: [0, 0], high: [%.17g, %.17g]}}}]\n",
              4 * unit, 3 * unit, 2 * unit);
    return scene_of (1,
                     "%sdimension: %d\n%sspacing: %.17g\n%s" MATERIAL
                     "boundary:\n  - {name: x, set: left, symmetry: on}\n  - {name: y, set: bottom, "
                     "symmetry: on}\n%s%s",
                     dim == 2 ? "thickness: 0.5\n" : "", dim, scene, 0.5 * unit, head,
                     dim == 3 ? "  - {name: z, set: back, symmetry: on}\n" : "", more);
}

static const char *const methods[] = {
    "method: {integration: gauss}\n",
    "method: {integration: gauss}\nperturb: {amount: 0.3}\n",
    "method: {approximation: nosb, integration: nodal, horizon: 2.5 spacing}\n",
    "method: {integration: consistent}\nperturb: {amount: 0.3}\n",
    "method: {integration: gauss, essential: transformation}\n",
    "method: {integration: gauss, basis: quadratic, horizon: 3.01 spacing}\n",
};

/* The largest stress at points over that which holding the body would make, and how far the displacement is
 * from the free one, over it. */
static void check_free (run *r, double strain, double tolerance)
{
    int nv;
    double *s = field_of (r, NULL, "stress", &nv), *u = field_of (r, NULL, "displacement", NULL), off = 0,
        most = 0;
    size_t dim = (size_t) r->problem->dim, n = r->problem->cloud.n;
    check_below (largest_of (s, n * (size_t) nv) / (E * fabs (strain)), tolerance);
    for (size_t i = 0; i < n * dim; i++) {
        double free = strain * r->problem->cloud.x[i];
        off = fmax (off, fabs (u[i] - free)), most = fmax (most, fabs (free));
    }
    check_below (off / most, tolerance);
    pg_free (s), pg_free (u);
}

static void a_free_body_has_no_stress (void **state)
{
    (void) state;
    for (size_t k = 0; k < sizeof methods / sizeof *methods; k++)
        for (int dim = 2; dim <= 3; dim++)
            for (int strain = 0; strain < (dim == 2 && k != 5 ? 2 : 1); strain++) {
                char head[200];
                if (dim == 3 && k == 5) continue;
                snprintf (head, sizeof head, "%s%s", methods[k], strain ? "plane: strain\n" : "");
                run r = box (head, dim, k == 1 ? 1e-3 : 1, "  - {temperature: 100 K}\nsolver: {steps: 2, "
                                                           "linear: cholmod}\n");
                to_the_end (&r);
                assert_false (r.options.event);
                check_free (&r, strain ? (1 + nu) * free_strain : free_strain, 1e-12 * (k == 1 ? 20 : 4));
                clear (&r);
            }
}

/* Nor do places between two cracks that see too little for a strain: they carry no stress, warm or not. */
static void places_without_a_strain_have_no_free_one (void **state)
{
    (void) state;
    run r = box ("method: {integration: gauss}\n"
                 "cracks: [{from: [1, 1.56], to: [3, 1.56]}, {from: [1, 1.65], to: [3, 1.65]}]\n",
                 2, 1, "  - {temperature: 100 K}\nsolver: {steps: 2, linear: cholmod}\n");
    to_the_end (&r);
    assert_true (pg_solver_report_now (r.solver)->degenerate_points > 0);
    check_free (&r, free_strain, 1e-11);
    clear (&r);
}

/* Mean of component v of the stress over all points. */
static double mean_stress (run *r, int v)
{
    int nv;
    double *s = field_of (r, NULL, "stress", &nv), sum = 0;
    for (size_t i = 0; i < r->problem->cloud.n; i++) sum += s[i * (size_t) nv + (size_t) v];
    pg_free (s);
    return sum / (double) r->problem->cloud.n;
}

/* Held along x between two planes. */
static void a_held_bar_bears_what_it_may_not_grow (void **state)
{
    (void) state;
    static const struct { int dim; const char *head; double stress; } cases[] = {
        { 2, "method: {integration: consistent}\n", 1 },
        { 2, "method: {integration: consistent}\nperturb: {amount: 0.3}\nplane: strain\n", 1 / (1 - 0.3) },
        { 3, "method: {integration: consistent}\n", 1 },
    };
    for (size_t k = 0; k < 3; k++) {
        run r = box (cases[k].head, cases[k].dim, 1,
                     "  - {name: wall, set: right, symmetry: on}\n  - {temperature: 50 K, ramp: constant}\n"
                     "  - {shrinkage: -0.6e-3}\nsolver: {stepping: fixed, steps: 3}\n");
        to_the_end (&r);
        double want = -E * free_strain * cases[k].stress;
        check_relative (mean_stress (&r, 0), want, 1e-9);
        check_below (fabs (mean_stress (&r, 1)) / fabs (want), 1e-9);
        double area = r.problem->dim == 2 ? 3 * 0.5 : 3 * 2;
        size_t wall = (size_t) (r.problem->dim == 2 ? 2 : 3);
        check_relative (r.step.reaction[3 * wall], want * area, 1e-9);
        clear (&r);
    }
}

/* Pore pressure p in a body that may not grow anywhere: -b p; in a free one the strain b p / (3 K). */
static void pore_pressure_goes_by_biot (void **state)
{
    (void) state;
    run r = box ("method: {integration: consistent}\n", 3, 1, "  - {pore_pressure: 30 MPa}\n  - {set: "
                                                              "right, symmetry: on}\n  - {set: top, "
                                                              "symmetry: on}\n"
                           "  - {set: front, symmetry: on}\nsolver: {steps: 1}\n");
    to_the_end (&r);
    for (int v = 0; v < 3; v++) check_relative (mean_stress (&r, v), -0.8 * 30e6, 1e-9);
    clear (&r);
    r = box ("", 3, 1, "  - {pore_pressure: 30 MPa}\nsolver: {steps: 1}\n");
    to_the_end (&r);
    check_free (&r, 0.8 * 30e6 * (1 - 2 * nu) / E, 4e-12);
    clear (&r);
}

/* T = T1 (1 - (y / c)^2) in a long strip: sigma_xx = E alpha T1 ((y / c)^2 - 1/3) in its middle. */
static double strip_error (double spacing)
{
    run r = scene_of (1, "dimension: 2\nbody: [{add: {box: {low: [0, -1], high: [5, 1]}}}]\nspacing: "
                         "%g\n" MATERIAL
                         "boundary:\n  - {set: left, symmetry: on}\n"
                         "  - {set: pin, displacement: {y: 0}, essential: penalty}\n"
                         "  - {temperature: 100 K * (1 - (y / 1 m)^2)}\nsets: {pin: {where: 'x < 1e-3 and "
                         "abs (y) < 1e-3'}}\n"
                         "method: {integration: consistent}\nsolver: {steps: 1}\n", spacing);
    to_the_end (&r);
    int nv;
    double *s = field_of (&r, NULL, "stress", &nv), sum = 0, size = 0;
    for (size_t i = 0; i < r.problem->cloud.n; i++) {
        const double *x = r.problem->cloud.x + 2 * i;
        if (x[0] > 1.5) continue;
        double want = E * free_strain * (x[1] * x[1] - 1.0 / 3), off = s[3 * i] - want;
        sum += off * off * r.problem->cloud.volume[i], size += want * want * r.problem->cloud.volume[i];
    }
    pg_free (s), clear (&r);
    return sqrt (sum / size);
}

static void a_profile_of_temperature_bends_nothing (void **state)
{
    (void) state;
    double coarse = strip_error (0.25), fine = strip_error (0.125);
    check_below (fine, 0.03);
    check_below (fine, 0.6 * coarse);
}

/* Restrained shrinkage: the first crack at the step at which E eps reaches the strength. */
static void shrinkage_breaks_at_the_strength (void **state)
{
    (void) state;
    run r = box ("failure: {criterion: principal_stress, tensile_strength: 100 MPa}\n", 2, 1,
                 "  - {set: right, symmetry: on}\n  - {shrinkage: 1e-3}\nsolver: {stepping: fixed, steps: "
                 "20, "
                 "break: all}\n");
    double first = NAN;
    while (!pg_solver_done (r.solver, r.state) && isnan (first)) {
        advance (&r);
        if (r.step.nbroken) first = r.step.factor;
    }
    check_relative (first, 0.5, 1e-9);                 /* E 1e-3 x 1/2 = 100 MPa */
    clear (&r);
}

/* By stretch: the free part of it counts for nothing. A free body that grows beyond its limit does not
 * break. */
static void a_free_stretch_breaks_nothing (void **state)
{
    (void) state;
    run r = box ("failure: {criterion: stretch, critical_stretch: 1e-4}\n", 2, 1,
                 "  - {temperature: 100 K}\nsolver: {stepping: fixed, steps: 2}\n");
    to_the_end (&r);
    assert_int_equal (r.state->broken, 0);
    clear (&r);
}

/* A heated body with springs and a held side: what heat and supports work is what is stored. */
static void energies_balance (void **state)
{
    (void) state;
    static const char *const more[] = { "", "plane: strain\n", "method: {integration: consistent}\n",
                                        ("method: {approximation: nosb, integration: nodal, horizon: 2.5 "
                                         "spacing}\n"),
                                        "method: {essential: transformation}\n" };
    for (size_t k = 0; k < 6; k++) {
        run r = box (k < 5 ? more[k] : "", k < 5 ? 2 : 3, 1,
                     "  - {set: right, displacement: {x: 1 mm, y: 0.3 mm}}\n  - {set: top, spring: {y: 100 "
                     "GN/m}}\n"
                     "  - {temperature: 100 K * x / 1 m + 30 K}\nsolver: {stepping: fixed, steps: 6}\n");
        to_the_end (&r);
        const pg_statistics *s = pg_solver_report (r.solver, r.state);
        check_relative (s->energy.external, s->energy.strain, 1e-9);
        assert_true (s->energy.strain > 0);
        clear (&r);
    }
}

/* Newmark's method with a load that rises slowly passes the same states. */
static void motion_knows_heat (void **state)
{
    (void) state;
    run r = box ("", 2, 1, "  - {set: right, symmetry: on}\n  - {temperature: 100 K}\n"
                           "solver: {kind: newmark, dt: 2 ms, end: 0.2, alpha: -0.1}\n");
    to_the_end (&r);
    check_relative (mean_stress (&r, 0), -E * free_strain, 1e-3);
    clear (&r);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (a_free_body_has_no_stress),
        cmocka_unit_test (places_without_a_strain_have_no_free_one),
        cmocka_unit_test (a_held_bar_bears_what_it_may_not_grow),
        cmocka_unit_test (pore_pressure_goes_by_biot),
        cmocka_unit_test (a_profile_of_temperature_bends_nothing),
        cmocka_unit_test (shrinkage_breaks_at_the_strength),
        cmocka_unit_test (a_free_stretch_breaks_nothing),
        cmocka_unit_test (energies_balance),
        cmocka_unit_test (motion_knows_heat),
    };
    return cmocka_run_group_tests (tests, NULL, NULL);
}
