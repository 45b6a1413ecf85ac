/* SPDX-License-Identifier: GPL-3.0-or-later
 * Isotropic elasticity in all modes against Hooke's law written in compliances. */
#include "check.h"
#include "perigal/material.h"

static const double E = 72e9, nu = 0.22;

/* As a scene gives it: constants across the plane are the library's own. */
static pg_material glass (pg_mode mode)
{
    pg_scene *scene = NULL;
    pg_material m;
    check_ok (pg_scene_parse (
        &scene,
        "dimension: 3\nmaterials: {glass: {youngs_modulus: 72 GPa, poissons_ratio: 0.22, density: 2440}}\n",
        "glass.yaml"));
    check_ok (pg_material_read (&m, scene, "glass", mode));
    check_relative (m.density, 2440, 1e-15);
    check_relative (m.modulus, E, 1e-15);
    pg_scene_free (&scene);
    return m;
}

static void the_catalogue_knows_elastic (void **state)
{
    (void) state;
    assert_non_null (pg_material_find ("elastic"));
    assert_null (pg_material_find ("plastic"));
    assert_string_equal (pg_material_names (), "elastic|orthotropic");
}

static void voigt_sizes (void **state)
{
    (void) state;
    assert_int_equal (pg_voigt_size (1), 1);
    assert_int_equal (pg_voigt_size (2), 3);
    assert_int_equal (pg_voigt_size (3), 6);
}

static void a_bar_has_stress_modulus_times_strain (void **state)
{
    (void) state;
    pg_material m = glass (PG_LINE);
    double strain = 1e-3, stress, zz;
    m.type->stress (&m, 1, &strain, &stress, &zz);
    check_relative (stress, 72e6, 1e-15);
    check_scaled (zz, 0, 1e-300, 1);
}

static void solid_stress_inverts_the_compliance (void **state)
{
    (void) state;
    pg_material m = glass (PG_SOLID);
    const double want[6] = { 3e6, -1e6, 2e6, 4e5, -7e5, 9e5 };
    double G = E / (2 * (1 + nu)), strain[6], stress[6];
    for (int k = 0; k < 3; k++) strain[k] = ((1 + nu) * want[k] - nu * (want[0] + want[1] + want[2])) / E;
    for (int k = 3; k < 6; k++) strain[k] = want[k] / G;
    m.type->stress (&m, 1, strain, stress, NULL);
    for (int k = 0; k < 6; k++) check_scaled (stress[k], want[k], 1e-14, 3e6);
}

static void plane_stress_leaves_no_stress_across (void **state)
{
    (void) state;
    pg_material m = glass (PG_PLANE_STRESS);
    const double want[3] = { 3e6, -1e6, 4e5 };
    double G = E / (2 * (1 + nu)), stress[3], zz;
    const double strain[3] = { (want[0] - nu * want[1]) / E, (want[1] - nu * want[0]) / E, want[2] / G };
    m.type->stress (&m, 1, strain, stress, &zz);
    for (int k = 0; k < 3; k++) check_scaled (stress[k], want[k], 1e-14, 3e6);
    check_scaled (zz, 0, 1e-300, 1);
}

static void plane_strain_equals_a_solid_held_across (void **state)
{
    (void) state;
    pg_material flat = glass (PG_PLANE_STRAIN), full = glass (PG_SOLID);
    const double e2[6] = { 1e-3, -4e-4, 3e-4, 2e-4, 5e-4, -6e-4 };
    double s2[6], s3[6], zz[2];
    flat.type->stress (&flat, 2, e2, s2, zz);
    for (int i = 0; i < 2; i++) {
        const double e3[6] = { e2[3*i], e2[3*i + 1], 0, e2[3*i + 2], 0, 0 };
        full.type->stress (&full, 1, e3, s3, NULL);
        check_relative (s2[3*i], s3[0], 1e-14);
        check_relative (s2[3*i + 1], s3[1], 1e-14);
        check_relative (s2[3*i + 2], s3[3], 1e-14);
        check_relative (zz[i], s3[2], 1e-14);
        check_relative (zz[i], nu * (s2[3*i] + s2[3*i + 1]), 1e-13);
    }
}

static void tangents_are_symmetric (void **state)
{
    (void) state;
    const pg_mode modes[4] = { PG_LINE, PG_PLANE_STRESS, PG_PLANE_STRAIN, PG_SOLID };
    const int size[4] = { 1, 3, 3, 6 };
    for (int t = 0; t < 4; t++) {
        pg_material m = glass (modes[t]);
        for (int a = 0; a < size[t]; a++)
            for (int b = 0; b < size[t]; b++) assert_true (m.D[a*size[t] + b] == m.D[b*size[t] + a]);
    }
}

/* State-based moduli give back the energy of Hooke's law: uniform dilatation A theta^2 / (2 d) + B theta^2 /
 * (2 d^2) (all e.eta = r theta / d), uniform shear gamma^2 / 2 of B mean ((2 x y)^2) / 4 with mean (x^2 y^2)
 * = 1 / (d (d + 2)). */
static void state_based_moduli_store_the_energy_of_hooke (void **state)
{
    (void) state;
    static const pg_mode modes[3] = { PG_PLANE_STRESS, PG_PLANE_STRAIN, PG_SOLID };
    double A, B;
    for (int k = 0; k < 3; k++) {
        pg_material m = glass (modes[k]);
        double d = modes[k] == PG_SOLID ? 3 : 2, bulk = 0;
        int nv = modes[k] == PG_SOLID ? 6 : 3;
        pg_state_moduli (modes[k], E, nu, &A, &B);
        for (int a = 0; a < (int) d; a++) for (int b = 0; b < (int) d; b++) bulk += m.D[a * nv + b] / (d * d);
        check_relative (A / (2 * d) + B / (2 * d * d), bulk / 2, 1e-13);
        check_relative (B / (d * (d + 2)), m.D[nv * nv - 1], 1e-13);
    }
    pg_state_moduli (PG_LINE, E, nu, &A, &B);
    assert_true (A == 0 && B == E);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (the_catalogue_knows_elastic),
        cmocka_unit_test (voigt_sizes),
        cmocka_unit_test (a_bar_has_stress_modulus_times_strain),
        cmocka_unit_test (solid_stress_inverts_the_compliance),
        cmocka_unit_test (plane_stress_leaves_no_stress_across),
        cmocka_unit_test (plane_strain_equals_a_solid_held_across),
        cmocka_unit_test (tangents_are_symmetric),
        cmocka_unit_test (state_based_moduli_store_the_energy_of_hooke),
    };
    return cmocka_run_group_tests_name ("mechanics/material/elastic", tests, NULL, NULL);
}
