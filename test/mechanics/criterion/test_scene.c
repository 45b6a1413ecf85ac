/* SPDX-License-Identifier: GPL-3.0-or-later
 * Criteria as the scene describes them, and the faults of a wrong choice of keys. */
#include "check.h"
#include "perigal/criterion.h"

static const pg_criterion_setting setting = {
    .mode = PG_SOLID, .horizon = 0.06, .modulus = 30e9, .poisson = 0.2, .thickness = 1, .kernel = "constant"
};

/* Reads `failure: {...}`; the scene itself may already refuse. */
static pg_status reading (const char *failure, pg_criterion *c)
{
    pg_scene *s = NULL;
    char text[512];
    snprintf (text, sizeof text, "dimension: 3\n%s%s\n", failure ? "failure: " : "", failure ? failure : "");
    pg_status status = pg_scene_parse (&s, text, "f.yaml");
    if (status == PG_OK) status = pg_criterion_read (c, 1, s, &setting);
    pg_scene_free (&s);
    return status;
}

static void check_refused (const char *failure, const char *part)
{
    pg_criterion c;
    check_fails (reading (failure, &c), PG_E_SCENE);
    check_contains (pg_last_error (), part);
}

static void without_failure_nothing_breaks (void **state)
{
    (void) state;
    pg_criterion c;
    check_ok (reading (NULL, &c));
    assert_null (c.type);
    check_ok (reading ("{criterion: none, tensile_strength: 1 MPa}", &c));
    assert_null (c.type);
}

static void stretch_follows_from_the_fracture_energy (void **state)
{
    (void) state;
    pg_criterion c;
    char text[200];
    check_ok (reading ("{criterion: stretch, fracture_energy: 2160 J/m2}", &c));
    assert_string_equal (c.type->name, "stretch");
    check_relative (c.parameter[0], 1e-3, 1e-12);
    assert_true (c.parameter[1] == 0);
    c.type->describe (&c, text, sizeof text);
    check_contains (text, "linear stretch >= 0.001 (derived), fracture energy 2160 J/m2 (given)");
}

static void a_given_stretch_is_kept_and_its_energy_derived (void **state)
{
    (void) state;
    pg_criterion c;
    check_ok (reading ("{criterion: stretch, critical_stretch: 1e-3, stretch: finite}", &c));
    check_relative (c.parameter[0], 1e-3, 0);
    assert_true (c.parameter[1] == 1);
    check_relative (c.parameter[2], 2160, 1e-12);
}

static void stretch_wants_exactly_one_limit (void **state)
{
    (void) state;
    check_refused ("{criterion: stretch}",
                   "stretch needs either failure.critical_stretch or failure.fracture_energy");
    check_refused ("{criterion: stretch, critical_stretch: 1e-3, fracture_energy: 100 J/m2}",
                   "fracture_energy");
}

static void strengths_are_read_with_units (void **state)
{
    (void) state;
    pg_criterion c;
    check_ok (reading ("{criterion: principal_stress, tensile_strength: 2 MPa}", &c));
    check_relative (c.parameter[0], 2e6, 1e-15);
    check_ok (reading (
        "{criterion: mohr_coulomb, tensile_strength: 0.5 MPa, cohesion: 5 MPa, friction_angle: 40 deg,"
        " exclude: [left]}",
        &c));
    double s1 = 0, s3 = -21.4450692e6, f;
    const pg_bond_measures m = { .n = 1, .dim = 3, .s1 = &s1, .s3 = &s3 };
    c.type->factor (&c, &m, &f);
    check_relative (f, 1, 1e-8);
}

static void missing_keys_are_named (void **state)
{
    (void) state;
    check_refused ("{criterion: principal_stress}", "principal_stress needs failure.tensile_strength");
    check_refused ("{criterion: mohr_coulomb, tensile_strength: 1 MPa}",
                   "mohr_coulomb needs failure.cohesion");
    check_refused ("{criterion: mohr_coulomb, tensile_strength: 1 MPa}",
                   "mohr_coulomb needs failure.friction_angle");
    check_refused ("{tensile_strength: 1 MPa}", "failure.criterion");
}

static void keys_without_effect_are_faults (void **state)
{
    (void) state;
    check_refused ("{criterion: stretch, critical_stretch: 1e-3, cohesion: 5 MPa}",
                   "has no effect with the criterion stretch");
    check_refused ("{criterion: principal_stress, tensile_strength: 1 MPa, stretch: finite}", "f.yaml:2");
    check_refused ("{criterion: principal_stress, tensile_strength: 1 MPa, fracture_energy: 1 J/m2}",
                   "has no effect");
}

static void a_right_angle_of_friction_is_refused (void **state)
{
    (void) state;
    check_refused (
        "{criterion: mohr_coulomb, tensile_strength: 1 MPa, cohesion: 5 MPa, friction_angle: 90 deg}",
        "friction_angle");
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (without_failure_nothing_breaks),
        cmocka_unit_test (stretch_follows_from_the_fracture_energy),
        cmocka_unit_test (a_given_stretch_is_kept_and_its_energy_derived),
        cmocka_unit_test (stretch_wants_exactly_one_limit),
        cmocka_unit_test (strengths_are_read_with_units),
        cmocka_unit_test (missing_keys_are_named),
        cmocka_unit_test (keys_without_effect_are_faults),
        cmocka_unit_test (a_right_angle_of_friction_is_refused),
    };
    return cmocka_run_group_tests_name ("mechanics/criterion/scene", tests, NULL, NULL);
}
