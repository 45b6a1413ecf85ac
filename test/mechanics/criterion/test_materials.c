/* SPDX-License-Identifier: GPL-3.0-or-later
 * Limits of each material: its own before those of `failure`, constants derived from its own modulus, what is
 * missing or ignored. */
#include "check.h"
#include "perigal/criterion.h"

static const pg_criterion_setting setting[2] = { { .mode = PG_SOLID,
                                                   .horizon = 0.06,
                                                   .modulus = 30e9,
                                                   .poisson = 0.2,
                                                   .thickness = 1,
                                                   .kernel = "constant",
                                                   .material = "rock" },
                                                 { .mode = PG_SOLID,
                                                   .horizon = 0.06,
                                                   .modulus = 120e9,
                                                   .poisson = 0.3,
                                                   .thickness = 1,
                                                   .kernel = "constant",
                                                   .material = "iron" } };

/* Reads both materials; rock and iron: their maps `failure`, or "". */
static pg_status reading (pg_criterion *c, const char *failure, const char *rock, const char *iron)
{
    pg_scene *s = NULL;
    char text[1024];
    snprintf (text, sizeof text,
              "dimension: 3\nmaterials:\n  rock: {youngs_modulus: 30 GPa, poissons_ratio: 0.2%s%s}\n"
              "  iron: {youngs_modulus: 120 GPa, poissons_ratio: 0.3%s%s}\n%s%s\n",
              *rock ? ", failure: " : "", rock, *iron ? ", failure: " : "", iron, *failure ? "failure: " : "",
              failure);
    pg_status status = pg_scene_parse (&s, text, "f.yaml");
    if (status == PG_OK) status = pg_criterion_read (c, 2, s, setting);
    pg_scene_free (&s);
    return status;
}

static void refused_at (const char *failure, const char *rock, const char *iron, const char *message,
                        int line)
{
    pg_criterion c[2];
    pg_status status = reading (c, failure, rock, iron);
    if (status == PG_E_SCENE && strcmp (pg_last_error (), message) == 0) return;
    print_error ("%s: '%s', expected '%s'\n", pg_status_text (status), status ? pg_last_error () : "",
                 message);
    _fail (__FILE__, line);
}
#define check_refused(failure, rock, iron, message) refused_at (failure, rock, iron, message, __LINE__)

static void materials_share_the_limits_of_failure (void **state)
{
    (void) state;
    pg_criterion c[2];
    check_ok (reading (c, "{criterion: principal_stress, tensile_strength: 2 MPa}", "", ""));
    for (int m = 0; m < 2; m++) {
        assert_string_equal (c[m].type->name, "principal_stress");
        check_relative (c[m].parameter[0], 2e6, 1e-15);
        assert_int_equal (c[m].never, 0);
    }
}

static void own_limits_come_first (void **state)
{
    (void) state;
    pg_criterion c[2];
    check_ok (reading (
        c, "{criterion: mohr_coulomb, tensile_strength: 2 MPa, cohesion: 5 MPa, friction_angle: 30 deg}",
        "{cohesion: 7 MPa}", "{tensile_strength: 3 MPa, friction_angle: 0}"));
    check_relative (c[0].parameter[0], 2e6, 1e-15), check_relative (c[0].parameter[1], 7e6, 1e-15),
        check_relative (c[0].parameter[2], 0.52359877559829882, 1e-12);
    check_relative (c[1].parameter[0], 3e6, 1e-15), check_relative (c[1].parameter[1], 5e6, 1e-15),
        check_absolute (c[1].parameter[2], 0, 0);
}

static void limits_may_come_from_the_materials_alone (void **state)
{
    (void) state;
    pg_criterion c[2];
    check_ok (reading (c, "{criterion: principal_stress}", "{tensile_strength: 1 MPa}",
                       "{tensile_strength: 400 MPa}"));
    check_relative (c[0].parameter[0], 1e6, 1e-15), check_relative (c[1].parameter[0], 400e6, 1e-15);
}

/* s0^2 is proportional to G0 / E: one fracture energy, four times the modulus, half the stretch */
static void stretches_follow_from_each_modulus (void **state)
{
    (void) state;
    pg_criterion c[2];
    check_ok (reading (c, "{criterion: stretch, fracture_energy: 2160 J/m2}", "", ""));
    check_relative (c[0].parameter[0], 1e-3, 1e-12), check_relative (c[1].parameter[0], 0.5e-3, 1e-12);
}

static void either_limit_of_a_material_replaces_both_of_failure (void **state)
{
    (void) state;
    pg_criterion c[2];
    check_ok (reading (c, "{criterion: stretch, fracture_energy: 2160 J/m2, stretch: finite}",
                       "{critical_stretch: 4e-3}", ""));
    check_relative (c[0].parameter[0], 4e-3, 1e-15), check_relative (c[0].parameter[2], 16 * 2160, 1e-12);
    check_relative (c[1].parameter[0], 0.5e-3, 1e-12);
    assert_true (c[0].parameter[1] == 1 && c[1].parameter[1] == 1);
}

static void what_never_breaks_needs_no_limit (void **state)
{
    (void) state;
    pg_criterion c[2];
    char text[200];
    check_ok (reading (c, "{criterion: principal_stress}", "{tensile_strength: 1 MPa}", "{never: yes}"));
    assert_true (!c[0].never && c[1].never && c[1].type == c[0].type);
    pg_criterion_describe (&c[1], text, sizeof text);
    assert_string_equal (text, "never breaks");
    pg_criterion_describe (&c[0], text, sizeof text);
    assert_string_equal (text, "principal stress >= 1e+06 Pa (mean of both ends)");
}

static void nothing_breaks_without_a_criterion (void **state)
{
    (void) state;
    pg_criterion c[2];
    char text[200];
    check_ok (reading (c, "{criterion: none}", "{tensile_strength: 1 MPa}", ""));
    assert_true (!c[0].type && !c[1].type);
    pg_criterion_describe (&c[0], text, sizeof text);
    assert_string_equal (text, "none: nothing breaks");
}

static void a_limit_that_one_material_lacks_is_named (void **state)
{
    (void) state;
    check_refused ("{criterion: principal_stress}", "", "{tensile_strength: 1 MPa}",
                   "f.yaml:3:3: materials.rock: principal_stress needs failure.tensile_strength, or the same "
                   "in materials.rock.failure");
    check_refused ("{criterion: stretch}", "{critical_stretch: 1e-3}", "",
                   "f.yaml:4:3: materials.iron: stretch needs either failure.critical_stretch "
                   "or failure.fracture_energy, or the same in materials.iron.failure");
}

static void a_limit_that_all_lack_is_one_fault (void **state)
{
    (void) state;
    check_refused (
        "{criterion: principal_stress}", "", "",
        "f.yaml:5:11: failure.criterion = principal_stress: principal_stress needs failure.tensile_strength");
}

static void limits_without_effect_are_faults (void **state)
{
    (void) state;
    check_refused (
        "{criterion: stretch, critical_stretch: 1e-3}", "", "{cohesion: 1 MPa}",
        "f.yaml:4:66: materials.iron.failure.cohesion = 1 MPa: has no effect with the criterion stretch");
    check_refused ("{criterion: principal_stress, tensile_strength: 1 MPa}",
                   "{never: on, tensile_strength: 1 MPa}", "",
                   "f.yaml:3:76: materials.rock.failure.tensile_strength = 1 MPa: has no effect: bonds of "
                   "this material never break");
    check_refused ("", "{never: on}", "",
                   "f.yaml:3:55: materials.rock.failure: has no effect without failure.criterion, which all "
                   "materials share");
}

static void only_one_of_two_stretch_limits_per_material (void **state)
{
    (void) state;
    pg_criterion c[2];
    check_fails (reading (c, "{criterion: stretch, critical_stretch: 1e-3}",
                          "{critical_stretch: 1e-3, fracture_energy: 3}", ""),
                 PG_E_SCENE);
    check_contains (pg_last_error (), "give at most one of critical_stretch, fracture_energy");
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (materials_share_the_limits_of_failure),
        cmocka_unit_test (own_limits_come_first),
        cmocka_unit_test (limits_may_come_from_the_materials_alone),
        cmocka_unit_test (stretches_follow_from_each_modulus),
        cmocka_unit_test (either_limit_of_a_material_replaces_both_of_failure),
        cmocka_unit_test (what_never_breaks_needs_no_limit),
        cmocka_unit_test (nothing_breaks_without_a_criterion),
        cmocka_unit_test (a_limit_that_one_material_lacks_is_named),
        cmocka_unit_test (a_limit_that_all_lack_is_one_fault),
        cmocka_unit_test (limits_without_effect_are_faults),
        cmocka_unit_test (only_one_of_two_stretch_limits_per_material),
    };
    return cmocka_run_group_tests_name ("mechanics/criterion/materials", tests, NULL, NULL);
}
