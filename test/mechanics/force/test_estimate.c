/* SPDX-License-Identifier: GPL-3.0-or-later
 * The error estimate of the stress: nothing where the recovered polynomials hold the stress; not across
 * cracks and borders of materials; the size of the true error of three problems with a known solution
 * (effectivity = estimate / true error, both in the energy norm at the points of evaluation); the same for
 * any number of threads; no leak when memory ends. */
#include "../../scene_runs/run.h"
#include "mechanics/galerkin/weak_form/galerkin.h"

/* ---- exact solutions ----------------------------------------------------------------------------------- */
static void timoshenko (const double *at, double *s)
{
    double P = 1000, L = 48, D = 12, I = 144, x = at[0], y = at[1];
    s[0] = P * (L - x) * y / I, s[1] = 0, s[2] = -P / (2 * I) * (D * D / 4 - y * y);
}

/* Kirsch: a plate pulled along x by 1 MPa with a hole of radius 1 m about the origin */
static void kirsch (const double *at, double *s)
{
    double r = at[0] * at[0] + at[1] * at[1], t = atan2 (at[1], at[0]), a = 1 / r, b = a * a;
    s[0] = 1e6 * (1 - a * (1.5 * cos (2*t) + cos (4*t)) + 1.5 * b * cos (4*t));
    s[1] = 1e6 * (-a * (0.5 * cos (2*t) - cos (4*t)) - 1.5 * b * cos (4*t));
    s[2] = 1e6 * (-a * (0.5 * sin (2*t) + sin (4*t)) + 1.5 * b * sin (4*t));
}

static void uniform (const double *at, double *s) { (void) at, s[0] = 10.08e6, s[1] = 7.52e6, s[2] = -0.4e6; }

static const char cantilever_scene[] =
    "dimension: 2\nplane: stress\nthickness: 1 m\nbody: [{add: {box: {low: [0, -6], high: [48, "
    "6]}}}]\nspacing: %g\nperturb: {amount: %g}\n"
    "materials: {beam: {youngs_modulus: 3e7, poissons_ratio: 0.3}}\n"
    "method: {approximation: %s, integration: %s, gauss_points: %d, basis: %s, kernel: cubic_spline, "
    "horizon: %g spacing}\n"
    "boundary:\n"
    "  - {set: left, displacement: {x: \"1000 N * y / (6 * 3e7 Pa * 144 m^4) * 2.3 * (y^2 - 36 m^2)\",\n"
    "                               y: \"-1000 N / (6 * 3e7 Pa * 144 m^4) * 0.9 * 48 m * y^2\"}}\n"
    "  - {set: right, traction: {y: \"-1000 N / (2 * 144 m^4) * (36 m^2 - y^2)\"}}\n"
    "solver: {kind: static}\n";

#define RR "(x^2 + y^2)"
#define CC "(x^3 - 3*x*y^2)"
#define SS "(3*x^2*y - y^3)"
static const char kirsch_scene[] =
    "dimension: 2\nplane: stress\nthickness: 1 m\nbody: [{add: {box: {low: [1, 1], high: [3, "
    "3]}}}]\nspacing: %g\nperturb: {amount: %g}\n"
    "materials: {rock: {youngs_modulus: 10 GPa, poissons_ratio: 0.25}}\n"
    "method: {approximation: %s, integration: %s, gauss_points: %d, basis: %s, kernel: cubic_spline, "
    "horizon: %g spacing}\n"
    "boundary:\n"
    "  - {set: all, essential: nitsche, displacement: {x: \"3.125e-5*(3.2*x + 2 m^2*(3.2*x/" RR " + " CC
    "/" RR "^2) - 2 m^4*" CC "/" RR "^3)\",\n"
    "                              y: \"3.125e-5*(-0.8*y + 2 m^2*(-1.2*y/" RR " + " SS "/" RR
    "^2) - 2 m^4*" SS "/" RR "^3)\"}}\n"
    "solver: {kind: static}\n";

static const char patch_scene[] = "dimension: 2\nplane: stress\nthickness: 1 m\nbody: [{add: {box: {low: [0, "
                                  "0], high: [1, 1]}}}]\nspacing: %g\nperturb: {amount: %g}\n"
                                  "materials: {rock: {youngs_modulus: 10 GPa, poissons_ratio: 0.25}}\n"
                                  "method: {approximation: %s, integration: %s, gauss_points: %d, basis: %s, "
                                  "kernel: cubic_spline, horizon: %g spacing}\n"
                                  "boundary: [{set: all, essential: nitsche, displacement: {x: \"8.2e-4*x + "
                                  "1e-4*y\", y: \"-2e-4*x + 5e-4*y\"}}]\n"
                                  "solver: {kind: static}\n";

typedef struct {
    const char *name, *scene;
    void (*exact) (const double *x, double *stress);
    double spacing;
} known;
static const known cantilever = { "cantilever", cantilever_scene, timoshenko, 1 },
                   hole = { "hole", kirsch_scene, kirsch, 0.1 },
                   patch = { "patch", patch_scene, uniform, 0.1 };

/* s C s of plane stress */
static double twice_energy (const pg_material *m, const double *s)
{
    double E = m->E, nu = m->nu;
    return (s[0] * s[0] + s[1] * s[1] - 2 * nu * s[0] * s[1] + 2 * (1 + nu) * s[2] * s[2]) / E;
}

static galerkin *force_of (const run *r)
{
    void *self;
    pg_solver_force (r->solver, &self);
    return self;
}

static double effectivity (const known *k, const char *approximation, const char *integration,
                           const char *basis, double horizon, int points, double moved)
{
    run r = scene_of (1, k->scene, k->spacing, moved, approximation, integration, points, basis, horizon);
    pg_estimate e;
    double error = 0;
    to_the_end (&r);
    galerkin *g = force_of (&r);
    check_ok (galerkin_estimate (g, r.state->d, &e, NULL));
    for (size_t p = 0; p < g->rows[g->bulk].n; p++) {
        double s[3];
        k->exact (g->rows[g->bulk].x + 2 * p, s);
        for (int c = 0; c < 3; c++) s[c] -= g->measured.stress[g->bulk][3 * p + (size_t) c];
        error += g->rows[g->bulk].weight[p] * twice_energy (r.problem->material, s);
    }
    print_message (
        "%-10s %s %s %-9s %.1f h, %d points, moved %.2f: true %.2e, estimate %.2e, effectivity %.2f\n",
        k->name, approximation, integration, basis, horizon, points, moved, sqrt (error) / e.norm, e.relative,
        e.error / sqrt (error));
    assert_int_equal (e.points, g->rows[g->bulk].n);
    assert_int_equal (e.left_out, 0);
    check_relative (e.relative, e.error / hypot (e.error, e.norm), 1e-12);
    clear (&r);
    return e.error / sqrt (error);
}

static void within (double low, double value, double high)
{
    check_below (low, value);
    check_below (value, high);
}

static void the_estimate_is_of_the_size_of_the_error (void **state)
{
    (void) state;
    const known *all[] = { &cantilever, &hole };
    for (int k = 0; k < 2; k++)
        for (int m = 0; m < 2; m++) {
            within (0.5, effectivity (all[k], "rkpm", "gauss", "linear", 2.0, 2, 0.15 * m), 2);
            within (0.5, effectivity (all[k], "rkpm", "gauss", "linear", 1.5, 2, 0.15 * m), 2);
            within (0.5, effectivity (all[k], "rkpm", "gauss", "quadratic", 2.5, 3, 0.15 * m), 2);
        }
    within (0.5, effectivity (&patch, "rkpm", "gauss", "linear", 2.0, 2, 0.15), 2);
    within (0.5, effectivity (&patch, "rkpm", "gauss", "quadratic", 2.5, 3, 0.15), 2);
}

/* What the recovery cannot see: smooth errors of quadrature on regular points, derivatives that belong to no
 * displacement, and most of what goes wrong at nodes that are the points of evaluation. */
static void some_errors_are_seen_in_part_only (void **state)
{
    (void) state;
    within (0.2, effectivity (&cantilever, "rkpm", "gauss", "quadratic", 2.5, 2, 0), 0.5);
    within (0.2, effectivity (&hole, "rkpm", "gauss", "quadratic", 2.5, 2, 0), 0.5);
    within (0.2, effectivity (&patch, "rkpm", "gauss", "linear", 2.0, 2, 0), 0.5);
    within (0.2, effectivity (&cantilever, "pddo", "gauss", "linear", 2.0, 2, 0), 0.5);
    within (0.1, effectivity (&cantilever, "rkpm", "nodal", "linear", 2.0, 2, 0), 0.5);
    within (0.05, effectivity (&hole, "nosb", "nodal", "linear", 2.0, 2, 0), 0.5);
}

/* ---- nothing to see ------------------------------------------------------------------------------------ */
static const char block_scene[] =
    "dimension: %d\n%s\nbody: [{add: {box: {low: %s, high: %s}}}]\nspacing: 1 mm\nperturb: {amount: "
    "0.1}\n%s\n"
    "method: {approximation: rkpm, integration: %s, basis: %s, kernel: cubic_spline, horizon: %g spacing}\n"
    "boundary: [{set: left, displacement: {x: 0}}]\nsolver: {kind: static}\n";
static const char one_rock[] = "materials: {rock: {youngs_modulus: 10 GPa, poissons_ratio: 0.25}}";

/* Coefficients of u = H x + quadratic terms of size q / m, the same polynomial for each half of a cut body
 * but for the factor of x > middle */
static double *polynomial_of (const pg_problem *p, double q, double middle, double factor)
{
    size_t dim = (size_t) p->dim;
    double *d = pg_calloc (p->cloud.n * dim, sizeof *d);
    for (size_t i = 0; i < p->cloud.n; i++) {
        const double *x = p->cloud.x + i * dim;
        double s = x[0] > middle ? factor : 1;
        for (size_t k = 0; k < dim; k++) {
            for (size_t l = 0; l < dim; l++)
                d[i * dim + k] += 1e-3 * (1 + 2 * (double) k - (double) l) * x[l]
                                  + q * (1 + (double) (k + l)) * x[l] * x[0];
            d[i * dim + k] *= s;
        }
    }
    return d;
}

static pg_estimate estimate_of (run *r, double q, double middle, double factor)
{
    pg_estimate e;
    double *d = polynomial_of (r->problem, q, middle, factor);
    refresh (r, NULL);
    check_ok (galerkin_estimate (force_of (r), d, &e, NULL));
    pg_free (d);
    return e;
}

static void a_stress_that_is_such_a_polynomial_has_no_error (void **state)
{
    (void) state;
    static const struct { int dim; const char *head, *low, *high;
    } body[] = { { 1, "", "[0]", "[20 mm]" },
                 { 2, "plane: strain", "[0, 0]", "[12 mm, 8 mm]" },
                 { 3, "", "[0, 0, 0]", "[6 mm, 5 mm, 5 mm]" } };
    for (int b = 0; b < 3; b++)
        for (int order = 1; order < 3; order++) {
            run r = scene_of (1, block_scene, body[b].dim, body[b].head, body[b].low, body[b].high, one_rock,
                              "gauss", order == 1 ? "linear" : "quadratic", order == 1 ? 2.0 : 2.6);
            pg_estimate e = estimate_of (&r, order == 1 ? 0 : 0.05, 1, 1),
                        bent = estimate_of (&r, 0.05, 1, 1);
            assert_true (e.norm > 0);
            check_below (e.relative, 1e-9);
            /* a quadratic field is none of a linear basis */
            if (order == 1) check_below (1e-4, bent.relative);
            clear (&r);
        }
}

static void materials_are_recovered_each_for_itself (void **state)
{
    (void) state;
    static const char two[] =
        "materials: {rock: {youngs_modulus: 10 GPa, poissons_ratio: 0.25}, clay: {youngs_modulus: 1 GPa, "
        "poissons_ratio: 0.25}}\n"
        "blocks: [{material: rock, where: \"x <= 5.5 mm\"}, {material: clay, where: \"x > 5.5 mm\"}]";
    run r = scene_of (1, block_scene, 2, "plane: stress", "[0, 0]", "[12 mm, 8 mm]", two, "gauss", "linear",
                      2.0);
    check_below (estimate_of (&r, 0, 1, 1).relative, 1e-9);
    clear (&r);
}

/* Two halves of different strain: as one body a large error, cut apart none, whatever becomes of the points
 * beside the cut. */
static void cracks_are_not_smoothed_over (void **state)
{
    (void) state;
    static const char cut[] = "materials: {rock: {youngs_modulus: 10 GPa, poissons_ratio: 0.25}}\ncracks: "
                              "[{from: [5.5 mm, -1 mm], to: [5.5 mm, 9 mm]}]";
    run whole = scene_of (1, block_scene, 2, "plane: stress", "[0, 0]", "[12 mm, 8 mm]", one_rock, "gauss",
                          "linear", 2.0);
    run halves = scene_of (1, block_scene, 2, "plane: stress", "[0, 0]", "[12 mm, 8 mm]", cut, "gauss",
                           "linear", 2.0);
    pg_estimate a = estimate_of (&whole, 0, 5.5e-3, 2), b = estimate_of (&halves, 0, 5.5e-3, 2);
    check_below (0.05, a.relative);
    check_below (b.relative, 1e-9);
    assert_int_equal (b.points + b.left_out, a.points);
    clear (&whole);
    clear (&halves);
}

/* Every bond of a corner of the body dead: its points are left out, the rest is as exact as before. */
static void degenerate_points_are_left_out (void **state)
{
    (void) state;
    run r = scene_of (1, block_scene, 2, "plane: stress", "[0, 0]", "[12 mm, 8 mm]", one_rock, "gauss",
                      "linear", 2.0);
    const pg_rows *rows = &r.problem->bonds.rows[PG_POINTS];
    size_t dead = 0;
    for (size_t p = 0; p < rows->n; p++) {
        if (rows->x[2 * p] > 2e-3) continue;
        dead++;
        for (size_t e = rows->family.start[p]; e < rows->family.start[p + 1]; e++)
            r.state->alive[r.problem->bonds.first[PG_POINTS] + e] = 0;
    }
    pg_estimate e = estimate_of (&r, 0, 1, 1);
    assert_true (dead > 0);
    assert_int_equal (e.left_out, dead);
    check_below (e.relative, 1e-9);
    clear (&r);
}

/* ---- the field ----------------------------------------------------------------------------------------- */
static void the_map_shows_where_and_threads_change_nothing (void **state)
{
    (void) state;
    double *value[2], last = 0;
    for (int k = 0; k < 2; k++) {
        run r = scene_of (1 + 2 * k, cantilever_scene, 2.0, 0.1, "rkpm", "gauss", 2, "linear", 2.0);
        int components;
        to_the_end (&r);
        value[k] = field_of (&r, NULL, "error_estimate", &components);
        assert_int_equal (components, 1);
        size_t worst = 0, n = r.problem->cloud.n;
        for (size_t i = 0; i < n; i++) if (value[k][i] > value[k][worst]) worst = i;
        check_below (r.problem->cloud.x[2 * worst], 8);            /* near the clamp */
        pg_estimate e;
        check_ok (galerkin_estimate (force_of (&r), r.state->d, &e, NULL));
        if (k) assert_memory_equal (value[0], value[1], n * sizeof *value[0]);
        if (k) assert_memory_equal (&last, &e.error, sizeof last);
        last = e.error;
        clear (&r);
    }
    pg_free (value[0]), pg_free (value[1]);
}

static void memory_may_end (void **state)
{
    (void) state;
    run r = scene_of (1, patch_scene, 0.2, 0.1, "rkpm", "gauss", 2, "linear", 2.0);
    pg_estimate e;
    to_the_end (&r);
    size_t used, k;
    pg_status status = PG_E_MEMORY;
    double *value = pg_calloc (r.problem->cloud.n, sizeof *value);
    used = pg_memory_used ();
    for (k = 1; k < 20 && status == PG_E_MEMORY; k++) {
        pg_memory_fail_at (k);
        status = galerkin_estimate (force_of (&r), r.state->d, &e, value);
        pg_memory_fail_at (0);
        assert_int_equal (pg_memory_used (), used);
    }
    check_ok (status);
    assert_true (k > 4);
    pg_free (value);
    clear (&r);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (the_estimate_is_of_the_size_of_the_error),
        cmocka_unit_test (some_errors_are_seen_in_part_only),
        cmocka_unit_test (a_stress_that_is_such_a_polynomial_has_no_error),
        cmocka_unit_test (materials_are_recovered_each_for_itself),
        cmocka_unit_test (cracks_are_not_smoothed_over),
        cmocka_unit_test (degenerate_points_are_left_out),
        cmocka_unit_test (the_map_shows_where_and_threads_change_nothing),
        cmocka_unit_test (memory_may_end),
    };
    return cmocka_run_group_tests_name ("mechanics/force/estimate", tests, NULL, NULL);
}
