/* SPDX-License-Identifier: GPL-3.0-or-later
 * Bodies of an orthotropic material under the Galerkin force: uniform stress to rounding at any angle, a
 * turned scene has the turned result, forces made of bonds refuse it, fracture energies too. */
#include "scenes.h"
#include <string.h>

#define BODY "thickness: 1\nspacing: 0.1\nbody: [{add: {box: {low: [-0.5, -0.5], high: [0.5, 0.5]}}}]\n"
#define WOOD \
    "model: orthotropic, youngs_modulus_1: 12 GPa, youngs_modulus_2: 3 GPa, youngs_modulus_3: 2 GPa, " \
    "poissons_ratio_12: 0.4, poissons_ratio_13: 0.3, poissons_ratio_23: 0.3, shear_modulus_12: 1.1 GPa"

/* Displacement at n places of the equilibrium of a scene. */
static void solve (const char *text, size_t n, const double *x, double *u)
{
    pg_solver *solver = NULL;
    pg_state *at = NULL;
    pg_solver_options o;
    pg_step step;
    void *self;
    built b = build (text);
    check_ok (pg_solver_options_read (&o, b.problem, b.scene));
    check_ok (pg_solver_create (&solver, b.problem, &o));
    check_ok (pg_state_create (&at, b.problem, pg_solver_components (solver)));
    check_ok (pg_solver_step (solver, at, &step));
    const pg_force_type *force = pg_solver_force (solver, &self);
    check_ok (force->sample (self, at, at->d, n, x, u, NULL, NULL));
    pg_state_free (&at), pg_solver_free (&solver), unbuild (&b);
}

/* Under a uniform traction along x: u_x = e_xx (x + 1/2), u_y = e_yy (y + 1/2) + g_xy (x + 1/2), from the
 * stiffness. */
static void uniform_stress_is_exact_at_any_angle (void **state)
{
    (void) state;
    static const char *const planes[] = { "stress", "strain" }, *const bases[] = { "linear", "quadratic" };
    for (int k = 0; k < 8; k++) {
        double angle = 0.5 + 0.9 * k, e[3] = { 1e6, 0, 0 }, D[9], x[2] = { 0.31, -0.12 }, u[3];
        char text[1400];
        snprintf (text, sizeof text,
                  "dimension: 2\nplane: %s\n" BODY "materials: {wood: {" WOOD ", angle: %.17g}}\n",
                  planes[k % 2], angle);
        built b = build (text);
        memcpy (D, b.problem->material->D, sizeof D);
        unbuild (&b);
        assert_int_equal (pg_dense_cholesky (3, D, 1e-14), 0);
        pg_dense_solve (3, D, e);
        size_t used = strlen (text);
        snprintf (text + used, sizeof text - used,
                  "method: {integration: consistent, basis: %s}\nsolver: {kind: static}\noutput: {at: "
                  "{levels: 1}}\nboundary:\n"
                  "  - {name: l, set: left, displacement: {x: 0}}\n  - {name: b, set: bottom, displacement: "
                  "{y: %.17g * (x + 0.5)}}\n"
                  "  - {name: r, set: right, traction: {x: 1 MPa}}\n",
                  bases[k / 2 % 2], e[2]);
        solve (text, 1, x, u);
        check_relative (u[0], e[0] * (x[0] + 0.5), 1e-7);
        check_scaled (u[1], e[1] * (x[1] + 0.5) + e[2] * (x[0] + 0.5), 1e-7,
                      fabs (e[0]) + fabs (e[1]) + fabs (e[2]));
    }
}

static void a_turned_scene_has_the_turned_result (void **state)
{
    (void) state;
    static const char scene[] = "dimension: 2\nplane: stress\n" BODY "materials: {wood: {" WOOD
                                ", angle: %g deg}}\n"
                                "cracks: [{from: [%g, %g], to: [%g, %g]}]\nsolver: {kind: static}\noutput: "
                                "{at: {levels: 1}}\nboundary:\n"
                                "  - {name: a, set: %s, displacement: {x: 0, y: 0}}\n  - {name: b, set: %s, "
                                "displacement: {x: %g, y: %g}}\n";
    char text[2][1400];
    double x[2][6] = { { 0.2, 0.3, -0.4, -0.1, 0.05, 0.45 } }, u[2][9];
    for (int i = 0; i < 3; i++) x[1][2 * i] = -x[0][2 * i + 1], x[1][2 * i + 1] = x[0][2 * i];
    snprintf (text[0], sizeof text[0], scene, 30.0, -0.5, 0.02, -0.03, 0.02, "bottom", "top", 1e-4, 1e-3);
    snprintf (text[1], sizeof text[1], scene, 120.0, -0.02, -0.5, -0.02, -0.03, "right", "left", -1e-3, 1e-4);
    for (int k = 0; k < 2; k++) solve (text[k], 3, x[k], u[k]);
    for (int i = 0; i < 3; i++) {
        check_scaled (u[1][3 * i], -u[0][3 * i + 1], 1e-9, 1e-3);
        check_scaled (u[1][3 * i + 1], u[0][3 * i], 1e-9, 1e-3);
    }
}

static void what_cannot_carry_it_says_why (void **state)
{
    (void) state;
    static const char *const forces[] = { "bond", "fcbm", "lps", "gmpd" };
    char text[1400];
    for (size_t k = 0; k < sizeof forces / sizeof *forces; k++) {
        snprintf (text, sizeof text,
                  "dimension: 2\n" BODY "materials: {wood: {" WOOD "}}\nmethod: {force: %s}\n", forces[k]);
        check_refused (text, "cannot carry a material that depends on the direction: use force: galerkin");
    }
    check_refused ("dimension: 2\n" BODY "materials: {wood: {" WOOD
                   "}}\nfailure: {criterion: stretch, fracture_energy: 100}\n",
                   "gives no critical stretch: that takes one Young's modulus, and the stiffness of this "
                   "material depends on "
                   "the direction: give critical_stretch");
    built b = build ("dimension: 2\n" BODY "materials: {wood: {" WOOD
                     "}}\nfailure: {criterion: stretch, critical_stretch: 1e-3}\n");
    pg_criterion_describe (b.problem->criterion, text, sizeof text);
    check_contains (text, "fracture energy not known: it depends on the direction");
    unbuild (&b);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (uniform_stress_is_exact_at_any_angle),
        cmocka_unit_test (a_turned_scene_has_the_turned_result),
        cmocka_unit_test (what_cannot_carry_it_says_why),
    };
    return cmocka_run_group_tests_name ("mechanics/model/orthotropic_body", tests, NULL, NULL);
}
