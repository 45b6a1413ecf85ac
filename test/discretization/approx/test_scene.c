/* SPDX-License-Identifier: GPL-3.0-or-later
 * The approximation as the scene describes it. */
#include "check.h"
#include "perigal/approx.h"

static pg_status reading (const char *method, pg_approx *a)
{
    pg_scene *s = NULL;
    char text[512];
    snprintf (text, sizeof text, "dimension: 2\n%s%s\n", method ? "method: " : "", method ? method : "");
    pg_status status = pg_scene_parse (&s, text, "m.yaml");
    if (status == PG_OK) status = pg_approx_read (a, s, 2e-3);
    pg_scene_free (&s);
    return status;
}

static void defaults_are_the_linear_reproducing_kernel (void **state)
{
    (void) state;
    pg_approx a;
    check_ok (reading (NULL, &a));
    assert_string_equal (a.type->name, "rkpm");
    assert_string_equal (a.kernel->name, "cubic_spline");
    assert_int_equal (a.order, 1);
    assert_int_equal (a.shape, PG_RADIAL);
    assert_int_equal (a.use_volume, 0);
    check_relative (a.horizon, 4e-3, 1e-15);
}

static void every_key_arrives (void **state)
{
    (void) state;
    pg_approx a;
    check_ok (
        reading ("{approximation: pddo, basis: quadratic, kernel: gaussian, horizon: 7 mm, support: tensor}",
                 &a));
    assert_string_equal (a.type->name, "pddo");
    assert_string_equal (a.kernel->name, "gaussian");
    assert_int_equal (a.order, 2);
    assert_int_equal (a.shape, PG_TENSOR);
    assert_int_equal (a.use_volume, 1);
    check_relative (a.horizon, 7e-3, 1e-15);
}

static void weights_override_the_default (void **state)
{
    (void) state;
    pg_approx a;
    check_ok (reading ("{approximation: pddo, weights: unit}", &a));
    assert_int_equal (a.use_volume, 0);
    check_ok (reading ("{approximation: rkpm, weights: volume}", &a));
    assert_int_equal (a.use_volume, 1);
    check_ok (reading ("{approximation: nosb, weights: auto}", &a));
    assert_int_equal (a.use_volume, 1);
}

static void a_horizon_within_the_spacing_is_refused (void **state)
{
    (void) state;
    pg_approx a;
    check_fails (reading ("{horizon: 1 mm}", &a), PG_E_SCENE);
    check_contains (pg_last_error (), "method.horizon");
    check_contains (pg_last_error (), "0.5 spacings");
}

static void an_unknown_approximation_is_refused (void **state)
{
    (void) state;
    pg_approx a;
    check_fails (reading ("{approximation: rkmp}", &a), PG_E_SCENE);
    check_contains (pg_last_error (), "rkpm");
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (defaults_are_the_linear_reproducing_kernel),
        cmocka_unit_test (every_key_arrives),
        cmocka_unit_test (weights_override_the_default),
        cmocka_unit_test (a_horizon_within_the_spacing_is_refused),
        cmocka_unit_test (an_unknown_approximation_is_refused),
    };
    return cmocka_run_group_tests_name ("discretization/approx/scene", tests, NULL, NULL);
}
