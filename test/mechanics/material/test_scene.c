/* SPDX-License-Identifier: GPL-3.0-or-later
 * Materials as the scene describes them. */
#include "check.h"
#include "perigal/material.h"

#define GLASS \
    "dimension: 2\nmaterials:\n  glass: {youngs_modulus: 72 GPa, poissons_ratio: 0.22, density: 2440 " \
    "kg/m3}\n"

static void a_material_is_read_with_units_and_default_model (void **state)
{
    (void) state;
    pg_scene *s = NULL;
    pg_material m;
    double D[9];
    check_ok (pg_scene_parse (&s, GLASS, "glass.yaml"));
    check_ok (pg_material_read (&m, s, "glass", PG_PLANE_STRAIN));
    assert_string_equal (m.name, "glass");
    assert_string_equal (m.type->name, "elastic");
    assert_int_equal (m.mode, PG_PLANE_STRAIN);
    check_relative (m.modulus, 72e9, 1e-15);
    check_relative (m.E, 72e9, 1e-15);
    check_relative (m.nu, 0.22, 1e-15);
    check_relative (m.density, 2440, 1e-15);
    pg_elastic_tangent (PG_PLANE_STRAIN, 72e9, 0.22, D);
    for (int k = 0; k < 9; k++) check_scaled (m.D[k], D[k], 1e-15, 72e9);
    check_relative (m.out_of_plane[0], D[1], 1e-15);
    check_scaled (m.out_of_plane[2], 0, 0, 1);
    pg_scene_free (&s);
}

static void only_plane_strain_has_stress_across (void **state)
{
    (void) state;
    const pg_mode modes[3] = { PG_LINE, PG_PLANE_STRESS, PG_SOLID };
    pg_scene *s = NULL;
    pg_material m;
    check_ok (pg_scene_parse (&s, GLASS, "glass.yaml"));
    for (int t = 0; t < 3; t++) {
        check_ok (pg_material_read (&m, s, "glass", modes[t]));
        for (int k = 0; k < 6; k++) assert_true (m.out_of_plane[k] == 0);
    }
    pg_scene_free (&s);
}

static void density_may_be_left_out (void **state)
{
    (void) state;
    pg_scene *s = NULL;
    pg_material m;
    check_ok (pg_scene_parse (
        &s, "dimension: 3\nmaterials: {a: {model: elastic, youngs_modulus: 1, poissons_ratio: 0}}\n",
        "a.yaml"));
    check_ok (pg_material_read (&m, s, "a", PG_SOLID));
    check_absolute (m.density, 0, 0);
    pg_scene_free (&s);
}

static void an_unknown_material_is_named (void **state)
{
    (void) state;
    pg_scene *s = NULL;
    pg_material m;
    check_ok (pg_scene_parse (&s, GLASS, "glass.yaml"));
    check_fails (pg_material_read (&m, s, "steel", PG_SOLID), PG_E_SCENE);
    check_contains (pg_last_error (), "no material 'steel'");
    pg_scene_free (&s);
}

static void a_name_that_no_scene_can_hold_is_unknown (void **state)
{
    (void) state;
    char name[200] = "";
    memset (name, 'q', 100);
    pg_scene *s = NULL;
    pg_material m;
    check_ok (pg_scene_parse (&s, GLASS, "glass.yaml"));
    check_fails (pg_material_read (&m, s, name, PG_SOLID), PG_E_SCENE);
    check_contains (pg_last_error (), "no material 'qqq");
    pg_scene_free (&s);
}

static void incompressible_and_missing_constants_are_faults (void **state)
{
    (void) state;
    pg_scene *s = NULL;
    check_fails (
        pg_scene_parse (&s, "dimension: 3\nmaterials: {a: {youngs_modulus: 1 Pa, poissons_ratio: 0.5}}\n",
                        "a.yaml"),
        PG_E_SCENE);
    check_contains (pg_last_error (), "poissons_ratio");
    check_fails (pg_scene_parse (&s, "dimension: 3\nmaterials: {a: {poissons_ratio: 0.3}}\n", "a.yaml"),
                 PG_E_SCENE);
    check_contains (pg_last_error (), "youngs_modulus");
    check_fails (
        pg_scene_parse (
            &s, "dimension: 3\nmaterials: {a: {model: plastic, youngs_modulus: 1 Pa, poissons_ratio: 0.3}}\n",
            "a.yaml"),
        PG_E_SCENE);
    check_contains (pg_last_error (), "plastic");
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (a_material_is_read_with_units_and_default_model),
        cmocka_unit_test (only_plane_strain_has_stress_across),
        cmocka_unit_test (density_may_be_left_out),
        cmocka_unit_test (an_unknown_material_is_named),
        cmocka_unit_test (a_name_that_no_scene_can_hold_is_unknown),
        cmocka_unit_test (incompressible_and_missing_constants_are_faults),
    };
    return cmocka_run_group_tests_name ("mechanics/material/scene", tests, NULL, NULL);
}
