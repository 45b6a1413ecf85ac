/* SPDX-License-Identifier: GPL-3.0-or-later
 * The criterion of tips: limits by material, an energy of place and direction, an imposed path, what is
 * refused. */
#include "check.h"
#include "perigal/criterion.h"
#include <math.h>

enum { MOST = 2 };
static const char *const names[MOST] = { "soft", "hard" };

static pg_status reading (const char *failure, const char *soft, int nmaterial, pg_criterion *c)
{
    pg_scene *s = NULL;
    char text[1024];
    pg_criterion_setting setting[MOST];
    for (int m = 0; m < MOST; m++)
        setting[m] = (pg_criterion_setting) { .mode = PG_PLANE_STRESS,
                                              .horizon = 0.06,
                                              .modulus = 30e9,
                                              .poisson = 0.2,
                                              .thickness = 1,
                                              .kernel = "constant",
                                              .material = names[m] };
    snprintf (text, sizeof text,
              "dimension: 2\nmaterials:\n  soft: {youngs_modulus: 30 GPa, poissons_ratio: 0.2%s%s}\n"
              "  hard: {youngs_modulus: 30 GPa, poissons_ratio: 0.2}\nfailure: %s\n",
              *soft ? ", failure: " : "", soft, failure);
    pg_status status = pg_scene_parse (&s, text, "f.yaml");
    if (status == PG_OK) status = pg_criterion_read (c, (size_t) nmaterial, s, setting);
    pg_scene_free (&s);
    return status;
}

static void check_refused (const char *failure, const char *part)
{
    pg_criterion c[MOST];
    memset (c, 0, sizeof c);
    check_fails (reading (failure, "", 1, c), PG_E_SCENE);
    check_contains (pg_last_error (), part);
    pg_criterion_clear (c, MOST);
}

static pg_fracture_limits limits_of (const pg_criterion *c, double x, double y, double angle)
{
    pg_fracture_limits out;
    double at[3] = { x, y, 0 };
    c->type->fracture (c, at, angle, &out);
    return out;
}

static void limits_are_those_of_the_material (void **state)
{
    (void) state;
    pg_criterion c[MOST];
    char text[200];
    check_ok (
        reading ("{criterion: energy_release, fracture_energy: 100 J/m2, shear_fracture_energy: 300 J/m2}",
                 "{fracture_energy: 7 J/m2, tensile_strength: 2 MPa}", 2, c));
    assert_true (pg_criterion_of_tips (c) && !pg_criterion_of_bonds (c));
    pg_fracture_limits soft = limits_of (&c[0], 1, 2, 0.3), hard = limits_of (&c[1], 1, 2, 0.3);
    assert_true (soft.energy == 7 && hard.energy == 100 && soft.shear == 300 && hard.shear == 300);
    assert_true (soft.strength == 2e6 && isnan (hard.strength));
    assert_true (!c->type->uneven (&c[0]));
    c->type->describe (&c[1], text, sizeof text);
    check_contains (text, "energy release >= 100 J/m^2, sliding 300 J/m^2");
    pg_criterion_clear (c, 2);
}

static void an_energy_may_depend_on_place_and_direction (void **state)
{
    (void) state;
    pg_criterion c[MOST];
    check_ok (reading (
        "{criterion: energy_release, fracture_energy: 100 J/m2 * (1 + x / 2 m) * (2 - cos (angle)^2)}", "",
        1, c));
    assert_true (c->type->uneven (c));
    check_relative (limits_of (c, 0, 5, 0).energy, 100, 1e-14);
    check_relative (limits_of (c, 2, 5, 0).energy, 200, 1e-14);
    check_relative (limits_of (c, 2, 5, acos (-1) / 2).energy, 400, 1e-14);
    /* the direction, not the polar angle of the place; in [0, 2 pi) */
    check_relative (limits_of (c, 0, 5, -acos (-1) / 3).energy, 175, 1e-13);
    pg_criterion_clear (c, 1);
    check_ok (reading ("{criterion: energy_release, fracture_energy: 1 J/m2 * angle / 1 rad}", "", 1, c));
    check_relative (limits_of (c, 0, 5, -acos (-1) / 2).energy, 1.5 * acos (-1), 1e-13);
    pg_criterion_clear (c, 1);
    check_refused ("{criterion: energy_release, fracture_energy: 100 J/m2 * (1 + t)}", "not on t");
    check_refused ("{criterion: stretch, fracture_energy: 100 J/m2 * (1 + x / 2 m)}",
                   "must be one number here: an expression of place and direction goes with criterion: "
                   "energy_release");
}

static void a_path_is_a_list_of_places (void **state)
{
    (void) state;
    pg_criterion c[MOST];
    size_t n;
    check_ok (reading (
        "{criterion: energy_release, fracture_energy: 1 J/m2, path: [[0, 0], [1 cm, 0], [2 cm, 3]]}", "", 2,
        c));
    const double *path = c->type->path (c, &n);
    assert_true (n == 3 && path[2] == 0.01 && path[5] == 3);
    assert_non_null (c->type->path (&c[1], &n));
    pg_criterion_clear (c, 2);
    check_ok (reading ("{criterion: energy_release, fracture_energy: 1 J/m2}", "", 1, c));
    assert_true (c->type->path (c, &n) == NULL && n == 0);
    pg_criterion_clear (c, 1);
    check_refused ("{criterion: energy_release, fracture_energy: 1 J/m2, path: [[0, 0]]}",
                   "two places or more");
    check_refused ("{criterion: energy_release, fracture_energy: 1 J/m2, path: [[0, 0], [0, 0]]}", "are one");
}

static void what_is_missing_or_has_no_effect_is_refused (void **state)
{
    (void) state;
    check_refused ("{criterion: energy_release}", "energy_release needs failure.fracture_energy");
    check_refused ("{criterion: energy_release, tensile_strength: 1 MPa}", "needs failure.fracture_energy");
    check_refused ("{criterion: energy_release, fracture_energy: 1 J/m2, cohesion: 1 MPa}",
                   "cracks begin in shear by a cohesion with failure.friction_angle");
    check_refused ("{criterion: energy_release, fracture_energy: 1 J/m2, wc_factor: 1}", "has no effect");
    check_refused ("{criterion: energy_release, fracture_energy: 0 J/m2}", "must lie in (0, inf)");
    check_refused ("{criterion: energy_release, fracture_energy: 1 J}", "J");
}

int main (void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test (limits_are_those_of_the_material),
                                        cmocka_unit_test (an_energy_may_depend_on_place_and_direction),
                                        cmocka_unit_test (a_path_is_a_list_of_places),
                                        cmocka_unit_test (what_is_missing_or_has_no_effect_is_refused) };
    return cmocka_run_group_tests_name ("mechanics/criterion/energy_release", tests, NULL, NULL);
}
