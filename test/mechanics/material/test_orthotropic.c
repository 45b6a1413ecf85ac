/* SPDX-License-Identifier: GPL-3.0-or-later
 * Orthotropic elasticity against closed forms: moduli along any direction, invariance of energy, positive
 * definiteness, wave speeds, and what a scene may get wrong. */
#include "check.h"
#include "perigal/material.h"
#include <string.h>

#define SHEET \
    "youngs_modulus_1: 12 GPa, youngs_modulus_2: 3 GPa, poissons_ratio_12: 0.4, shear_modulus_12: 1.1 GPa"
#define THIRD "youngs_modulus_3: 2 GPa, poissons_ratio_13: 0.35, poissons_ratio_23: 0.5"
#define SOLID SHEET ", " THIRD ", shear_modulus_13: 0.9 GPa, shear_modulus_23: 0.4 GPa"
static const double E1 = 12e9, E2 = 3e9, E3 = 2e9, nu12 = 0.4, nu13 = 0.35, nu23 = 0.5, G12 = 1.1e9;

static pg_material wood (pg_mode mode, const char *constants)
{
    pg_scene *scene = NULL;
    pg_material m;
    char text[700];
    snprintf (text, sizeof text, "dimension: %d\nmaterials: {wood: {model: orthotropic, density: 500, %s}}\n",
              mode == PG_SOLID ? 3 : 2, constants);
    check_ok (pg_scene_parse (&scene, text, "wood.yaml"));
    check_ok (pg_material_read (&m, scene, "wood", mode));
    check_ok (pg_scene_verdict (scene));
    pg_scene_free (&scene);
    return m;
}

/* The strain of a uniaxial stress 1 along the unit vector n. */
static void strain_of_pull (const pg_material *m, const double *n, double *e)
{
    int nv = m->mode == PG_SOLID ? 6 : 3;
    double D[36];
    memcpy (D, m->D, sizeof D);
    if (nv == 3) e[0] = n[0] * n[0], e[1] = n[1] * n[1], e[2] = n[0] * n[1];
    else {
        for (int k = 0; k < 3; k++) e[k] = n[k] * n[k];
        e[3] = n[0] * n[1], e[4] = n[1] * n[2], e[5] = n[2] * n[0];
    }
    assert_int_equal (pg_dense_cholesky (nv, D, 1e-14), 0);
    pg_dense_solve (nv, D, e);
}

/* 1 / E (theta) = cos^4 / E1 + (1 / G12 - 2 nu12 / E1) sin^2 cos^2 + sin^4 / E2, theta from axis 1 */
static void a_sheet_has_the_modulus_of_its_direction (void **state)
{
    (void) state;
    for (int turn = 0; turn < 24; turn++) {
        double angle = 0.3 * turn - 2, n[2] = { cos (0.7), sin (0.7) }, e[3], theta = 0.7 - angle;
        char text[400];
        snprintf (text, sizeof text, SHEET ", angle: %.17g", angle);
        pg_material m = wood (PG_PLANE_STRESS, text);
        double c = cos (theta), s = sin (theta), along;
        strain_of_pull (&m, n, e);
        along = e[0] * n[0] * n[0] + e[1] * n[1] * n[1] + e[2] * n[0] * n[1];
        check_relative (along, pow (c, 4) / E1 + (1 / G12 - 2 * nu12 / E1) * s * s * c * c + pow (s, 4) / E2,
                        1e-12);
    }
}

static void equal_constants_are_isotropic_at_any_angle (void **state)
{
    (void) state;
    static const double E = 72e9, nu = 0.22;
    static const pg_mode modes[] = { PG_PLANE_STRESS, PG_PLANE_STRAIN, PG_SOLID };
    for (int k = 0; k < 3; k++) {
        pg_material plain = { .mode = modes[k] };
        pg_elastic_set (&plain, E, nu);
        char text[600];
        snprintf (text, sizeof text,
                  "youngs_modulus_1: 72 GPa, youngs_modulus_2: 72 GPa, youngs_modulus_3: 72 GPa, "
                  "poissons_ratio_12: 0.22, poissons_ratio_13: 0.22, poissons_ratio_23: 0.22, "
                  "shear_modulus_12: %.17g, shear_modulus_13: %.17g, shear_modulus_23: %.17g, %s",
                  plain.mu, plain.mu, plain.mu,
                  modes[k] == PG_SOLID ? "axis_1: [1, 2, 3], axis_2: [0, 1, 0]" : "angle: 25 deg");
        pg_material m = wood (modes[k], text);
        for (int i = 0; i < 36; i++) check_scaled (m.D[i], plain.D[i], 1e-12, E);
        for (int i = 0; i < 3; i++) check_scaled (m.out_of_plane[i], plain.out_of_plane[i], 1e-12, E);
    }
}

/* Young's modulus along n of a solid whose axis 1 is n itself is E1, along axis 2 E2, and Poisson's ratios
 * are those given. */
static void axes_by_two_vectors (void **state)
{
    (void) state;
    pg_material m = wood (PG_SOLID, SOLID ", axis_1: [2, 2, 1], axis_2: [-1, 0, 0]");
    /* axis 2: what [-1, 0, 0] has across axis 1; axis 3 = axis 1 x axis 2 */
    double a[3][3] = { { 2 / 3.0, 2 / 3.0, 1 / 3.0 }, { -5 / 9.0, 4 / 9.0, 2 / 9.0 } }, size = sqrt (45) / 9,
           e[6];
    for (int k = 0; k < 3; k++) a[1][k] /= size;
    for (int k = 0; k < 3; k++)
        a[2][k] = a[0][(k + 1) % 3] * a[1][(k + 2) % 3] - a[0][(k + 2) % 3] * a[1][(k + 1) % 3];
    static const double E[3] = { 12e9, 3e9, 2e9 };
    const double across[3][3] = { { 1, -nu12, -nu13 },
                                  { -nu12 * E2 / E1, 1, -nu23 },
                                  { -nu13 * E3 / E1, -nu23 * E3 / E2, 1 } };
    for (int i = 0; i < 3; i++) {
        strain_of_pull (&m, a[i], e);
        for (int j = 0; j < 3; j++) {
            const double *n = a[j];
            double along = e[0] * n[0] * n[0] + e[1] * n[1] * n[1] + e[2] * n[2] * n[2] + e[3] * n[0] * n[1]
                           + e[4] * n[1] * n[2] + e[5] * n[2] * n[0];
            check_scaled (along * E[i], across[i][j], 1e-12, 1);
        }
    }
}

/* Plane strain is the solid whose strain across the plane is held at zero. */
static void plane_strain_is_a_solid_held_across (void **state)
{
    (void) state;
    static const int plane[3] = { 0, 1, 3 };
    pg_material flat = wood (PG_PLANE_STRAIN, SHEET ", " THIRD ", angle: 0.4"),
                solid = wood (PG_SOLID, SOLID
                              ", axis_1: [0.92106099400288510, 0.38941834230865049, 0], axis_2: [0, 1, 0]");
    for (int a = 0; a < 3; a++) {
        for (int b = 0; b < 3; b++)
            check_scaled (flat.D[3 * a + b], solid.D[6 * plane[a] + plane[b]], 1e-12, E1);
        check_scaled (flat.out_of_plane[a], solid.D[6 * 2 + plane[a]], 1e-12, E1);
    }
    double strain[3] = { 1e-3, -2e-3, 3e-3 }, stress[3], zz, full[6] = { 1e-3, -2e-3, 0, 3e-3, 0, 0 },
           whole[6];
    flat.type->stress (&flat, 1, strain, stress, &zz);
    solid.type->stress (&solid, 1, full, whole, NULL);
    check_relative (stress[0], whole[0], 1e-12), check_relative (stress[2], whole[3], 1e-12);
    check_relative (zz, whole[2], 1e-12);
}

/* Along an axis of symmetry waves are pure: rho c^2 is a diagonal entry of D. The fastest wave of this sheet
 * runs along axis 1 whatever its angle. */
static void waves_do_not_depend_on_the_angle (void **state)
{
    (void) state;
    pg_material m = wood (PG_PLANE_STRESS, SHEET);
    pg_waves w = pg_material_waves (&m);
    check_relative (w.pressure, sqrt (m.D[0] / 500), 1e-3);
    check_relative (w.shear, sqrt (G12 / 500), 1e-3);
    pg_material turned = wood (PG_PLANE_STRESS, SHEET ", angle: 1");
    pg_waves v = pg_material_waves (&turned);
    check_relative (v.pressure, w.pressure, 1e-4);
    check_relative (v.shear, w.shear, 1e-4);
    pg_material solid = wood (PG_SOLID, SOLID);
    w = pg_material_waves (&solid);
    check_relative (w.pressure, sqrt (solid.D[0] / 500), 1e-3);
    check_relative (w.shear, sqrt (0.4e9 / 500), 2e-3);
    assert_true (isnan (w.lambda) && w.rayleigh == 0 && isnan (solid.E) && isnan (solid.nu));
}

static void refused (pg_mode mode, const char *constants, const char *message)
{
    pg_scene *scene = NULL;
    pg_material m;
    char text[700];
    snprintf (text, sizeof text, "dimension: %d\nmaterials: {wood: {model: orthotropic, %s}}\n",
              mode == PG_SOLID ? 3 : mode == PG_LINE ? 1 : 2, constants);
    if (pg_scene_parse (&scene, text, "wood.yaml") == PG_OK) {
        pg_material_read (&m, scene, "wood", mode);
        check_fails (pg_scene_verdict (scene), PG_E_SCENE);
    }
    check_contains (pg_last_error (), message);
    pg_scene_free (&scene);
}

static void what_a_scene_may_get_wrong (void **state)
{
    (void) state;
    refused (PG_PLANE_STRESS, "youngs_modulus_1: 1, poissons_ratio_12: 0, shear_modulus_12: 1",
             "materials.wood.youngs_modulus_2: is missing");
    refused (PG_PLANE_STRAIN, SHEET,
             "youngs_modulus_3 is missing, which model: orthotropic needs in plane strain");
    refused (PG_SOLID, SHEET ", " THIRD,
             "shear_modulus_13 is missing, which model: orthotropic needs in three dimensions");
    refused (PG_PLANE_STRESS, SHEET ", youngs_modulus: 1",
             "is no key of model: orthotropic, which reads youngs_modulus_1, ");
    refused (PG_PLANE_STRESS,
             "youngs_modulus_1: 1, youngs_modulus_2: 4, poissons_ratio_12: 0.5, shear_modulus_12: 1",
             "poissons_ratio_12 = 0.5: must lie between -0.5 and 0.5, the root of youngs_modulus_1 / "
             "youngs_modulus_2");
    refused (PG_PLANE_STRAIN,
             "youngs_modulus_1: 1, youngs_modulus_2: 1, youngs_modulus_3: 1, poissons_ratio_12: 0.6, "
             "poissons_ratio_13: 0.6, poissons_ratio_23: 0.6, shear_modulus_12: 1",
             "the compliance is not positive definite");
    refused (PG_PLANE_STRESS, SHEET ", axis_1: [1, 0]",
             "materials.wood.axis_1: is for three dimensions: give angle");
    refused (PG_SOLID, SOLID ", angle: 1", "is for two dimensions: give axis_1 and axis_2");
    refused (PG_SOLID, SOLID ", axis_1: [0, 3, 0]", "axis_1 and axis_2 point the same way");
    refused (PG_LINE, SHEET, "a bar has one modulus: use model: elastic");
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (a_sheet_has_the_modulus_of_its_direction),
        cmocka_unit_test (equal_constants_are_isotropic_at_any_angle),
        cmocka_unit_test (axes_by_two_vectors),
        cmocka_unit_test (plane_strain_is_a_solid_held_across),
        cmocka_unit_test (waves_do_not_depend_on_the_angle),
        cmocka_unit_test (what_a_scene_may_get_wrong),
    };
    return cmocka_run_group_tests_name ("mechanics/material/orthotropic", tests, NULL, NULL);
}
