/* SPDX-License-Identifier: GPL-3.0-or-later
 * Expressions: values, dimensions, errors with their column. */
#include "check.h"
#include "perigal/scene.h"

static const pg_place place = {
    .x = 0.03, .y = 0.04, .z = 0.2, .r = 0.05, .angle = 0.9272952180016122, .t = 0.5
};

static double value (const char *text, const char *unit)
{
    pg_expression *e = NULL;
    check_ok (pg_expression_compile (&e, text, unit));
    double v = pg_expression_value (e, &place);
    pg_expression_free (&e);
    assert_null (e);
    return v;
}

#define REFUSED(text, unit, words) \
    do { \
        pg_expression *e_ = NULL; \
        check_fails (pg_expression_compile (&e_, (text), (unit)), PG_E_SCENE); \
        assert_null (e_); \
        assert_string_equal (pg_last_error (), (words)); \
    } while (0)

static void arithmetic_follows_the_usual_order (void **state)
{
    (void) state;
    assert_true (value ("2 + 3*4", "1") == 14);
    assert_true (value ("-2^2", "1") == -4);
    assert_true (value ("2^3^2", "1") == 512);
    assert_true (value ("2^-1", "1") == 0.5);
    assert_true (value ("(2 + 3)*4 - 6/3/2", "1") == 19);
    assert_true (value ("1 - 2 - 3", "1") == -4);
    assert_true (value ("--3", "1") == 3);
}

static void functions_have_their_values (void **state)
{
    (void) state;
    check_relative (value ("sin(30 deg)", "1"), 0.5, 1e-15);
    check_relative (value ("cos (pi/3)", "1"), 0.5, 1e-15);
    check_relative (value ("tan(pi/4)", "1"), 1, 1e-15);
    check_relative (value ("exp(log(5))", "1"), 5, 1e-15);
    check_relative (value ("sqrt(x^2 + y^2)", "m"), 0.05, 1e-15);
    check_relative (value ("hypot(x, y)", "m"), 0.05, 1e-15);
    check_relative (value ("atan2(y, x)", "rad"), 0.9272952180016122, 1e-15);
    assert_true (value ("abs(-x)", "m") == 0.03);
    assert_true (value ("min(x, y, 10 mm)", "m") == 0.01);
    assert_true (value ("max(1, 3, 2)", "1") == 3);
    assert_true (value ("step(x - 30 mm)", "1") == 1 && value ("step(x - y)", "1") == 0);
}

static void variables_stand_for_the_place (void **state)
{
    (void) state;
    check_relative (value ("x + y + z + r", "m"), 0.32, 1e-15);
    check_relative (value ("angle", "rad"), 0.9272952180016122, 0);
    assert_true (value ("t", "s") == 0.5);
}

static void numbers_carry_units (void **state)
{
    (void) state;
    assert_true (value ("10 GPa", "Pa") == 1e10);
    assert_true (value ("x / 2 N/m * 4 N", "m2") == 0.03 / 2 * 4);  /* a unit is read as far as it goes */
    assert_true (value ("10 kN/m2", "Pa") == 1e4);
    check_relative (value ("10 kN/m * x", "N"), 300, 1e-15);
    check_relative (value ("5 % * y", "m"), 0.002, 1e-15);
    check_relative (value ("3 mm^2 * 2 MPa", "N"), 6, 1e-15);
    check_relative (value ("x/mm", "1"), 30, 1e-15);
    check_relative (value ("2 kN m / x", "N"), 2000 / 0.03, 1e-15);
    assert_true (value ("5 1/s", "1/s") == 5);
}

static void bare_numbers_fit_any_unit (void **state)
{
    (void) state;
    assert_true (value ("2e6", "Pa") == 2e6);
    assert_true (value ("x + 0.01", "m") == 0.04);
    assert_true (value ("2 * 3 + 1", "Pa") == 7);
    assert_true (value ("1e6 * t", "Pa") == 5e5);
    assert_true (value ("1e6 * sin(90 deg)", "Pa") == 1e6);
    assert_true (value ("x > 0", "bool") == 1);
}

static void time_is_seconds_or_a_load_factor (void **state)
{
    (void) state;
    assert_true (value ("2 m/s * t", "m") == 1);
    assert_true (value ("-1 um * t", "m") == -0.5e-6);
    check_relative (value ("10 MPa * sin(2*pi*t/(2 s))", "Pa"), 1e7, 1e-15);
    assert_true (value ("t > 1 ms and t < 0.7", "bool") == 1);
    REFUSED ("x + t", "m", "column 3: cannot add m and s");
}

static void conditions_are_true_or_false (void **state)
{
    (void) state;
    assert_true (value ("r >= 48 mm and y >= 40 mm", "bool") == 1);
    assert_true (value ("x > 1 m or not y > 1 m", "bool") == 1);
    assert_true (value ("x < 1 mm or y < 1 mm and true", "bool") == 0);
    assert_true (value ("not (x == y) and x != y and x <= y", "bool") == 1);
    assert_true (value ("angle > 50 deg and angle < 60 deg", "bool") == 1);
    assert_true (value ("true", "bool") == 1 && value ("false", "bool") == 0);
}

static void dimensions_must_agree (void **state)
{
    (void) state;
    REFUSED ("x + 1 s", "m", "column 3: cannot add m and s");
    REFUSED ("x > 3 MPa", "bool", "column 3: cannot compare m and Pa");
    REFUSED ("x*y", "m", "column 1: the result is in m2, expected m");
    REFUSED ("1e6*x", "Pa", "column 1: the result is in m, expected Pa");
    REFUSED ("t", "Pa", "column 1: the result is in s, expected Pa");
    REFUSED ("72 mm", "Pa", "column 1: the result is in m, expected Pa");
    REFUSED ("sin(x)", "1", "column 5: sin needs a plain number or an angle, not m");
    REFUSED ("2^x", "1", "column 3: an exponent has no unit");
    REFUSED ("x^(y/x)", "m", "column 3: a quantity with a unit needs a constant exponent");
    REFUSED ("max(x, 1 Pa)", "m", "column 8: cannot compare m and Pa");
    REFUSED ("sqrt(x)", "m", "column 1: the result is in m^0.5, expected m");
}

static void conditions_and_numbers_do_not_mix (void **state)
{
    (void) state;
    REFUSED ("x > 1", "m", "column 1: this is a condition, expected a value in m");
    REFUSED ("x", "bool", "column 1: a condition is expected, for example x > 5 mm");
    REFUSED ("(x > 1)*2", "1", "column 1: a condition cannot be used as a number");
    REFUSED ("(x > 1) + 2", "1", "column 9: cannot add a condition");
    REFUSED ("x and y", "bool", "column 3: 'and' needs a condition on both sides");
    REFUSED ("not x", "bool", "column 1: 'not' needs a condition");
    REFUSED ("0 < x < 1", "bool", "column 7: join two comparisons with 'and'");
}

static void wrong_words_name_their_column (void **state)
{
    (void) state;
    REFUSED ("x > 5 && y > 3", "bool", "column 7: use the words and, or, not");
    REFUSED ("x = 5", "bool", "column 3: equality is written ==");
    REFUSED ("2 x", "m", "column 3: 'x' is a variable: write a sign before it, as in 2*x");
    REFUSED ("x + foo", "m", "column 5: unknown name 'foo'; variables are x, y, z, r, angle, t");
    REFUSED ("2*angel", "rad", "column 3: unknown name 'angel'; did you mean angle?");
    REFUSED ("sin 3", "1", "column 5: sin needs an argument in ( )");
    REFUSED ("sin(1, 2)", "1", "column 8: sin takes 1 argument");
    REFUSED ("hypot(x)", "m", "column 1: hypot takes 2 arguments");
    REFUSED ("min(x)", "m", "column 1: min takes at least 2 arguments");
    REFUSED ("(x + y", "m", "column 7: ')' is missing");
    REFUSED ("x + y)", "m", "column 6: ')' is not expected here");
    REFUSED ("", "m", "column 1: a number or a name is missing at the end");
    REFUSED ("x +", "m", "column 4: a number or a name is missing at the end");
    REFUSED ("x ** 2", "m2", "column 3: a power is written with ^");
    REFUSED ("* x", "m", "column 1: a number or a name is expected, not '*'");
    REFUSED ("x + 3 glob", "m", "column 6: unknown unit 'glob'");
    REFUSED ("1e999*x", "m", "column 1: the number is too large: in SI units at most 1e60");
    REFUSED ("x + 1e-300 m", "m", "column 5: the number is too small: in SI units 0, or at least 1e-60");
}

static void variables_used_are_known (void **state)
{
    (void) state;
    pg_expression *e = NULL;
    check_ok (pg_expression_compile (&e, "1 MPa * t * sin(angle)", "Pa"));
    assert_true (pg_expression_uses (e, 't') && pg_expression_uses (e, 'a'));
    assert_false (pg_expression_uses (e, 'x') || pg_expression_uses (e, 'r') || pg_expression_uses (e, 'q'));
    pg_expression_free (&e);
    check_ok (pg_expression_compile (&e, "10 kN/m2", "Pa"));
    assert_false (pg_expression_uses (e, 't') || pg_expression_uses (e, 'x'));
    pg_expression_free (&e);
}

static void deep_and_long_texts_are_refused_not_fatal (void **state)
{
    (void) state;
    static char text[6000];
    pg_expression *e = NULL;
    static const char *const joint[] = { "(", "-", "not ", "sin(", "2^", "x^(" };
    for (size_t k = 0; k < sizeof joint / sizeof *joint; k++) {
        text[0] = '\0';
        for (int i = 0; i < 900; i++) strcat (text, joint[k]);
        strcat (text, "1");
        check_fails (pg_expression_compile (&e, text, "1"), PG_E_SCENE);
    }
    text[0] = '\0';
    for (int i = 0; i < 900; i++) strcat (text, "x+");
    strcat (text, "x");
    check_ok (pg_expression_compile (&e, text, "m"));
    check_relative (pg_expression_value (e, &place), 901 * 0.03, 1e-12);
    pg_expression_free (&e);
    memset (text, ' ', 5000);
    text[5000] = '\0';
    check_fails (pg_expression_compile (&e, text, "m"), PG_E_SCENE);
}

static void no_memory_leaks_no_block (void **state)
{
    (void) state;
    size_t before = pg_memory_used (), k = 1;
    pg_expression *e = NULL;
    for (;; k++) {
        pg_memory_fail_at (k);
        pg_status status = pg_expression_compile (&e, "1 MPa * t * sin(angle) + 3*(2 + x/mm)", "Pa");
        pg_memory_fail_at (0);
        if (status == PG_OK) break;
        assert_int_equal (status, PG_E_MEMORY);
        assert_null (e);
        assert_int_equal (pg_memory_used (), before);
    }
    assert_true (k > 1);
    pg_expression_free (&e);
    pg_expression_free (NULL);
    assert_int_equal (pg_memory_used (), before);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (arithmetic_follows_the_usual_order),
        cmocka_unit_test (functions_have_their_values),
        cmocka_unit_test (variables_stand_for_the_place),
        cmocka_unit_test (numbers_carry_units),
        cmocka_unit_test (bare_numbers_fit_any_unit),
        cmocka_unit_test (time_is_seconds_or_a_load_factor),
        cmocka_unit_test (conditions_are_true_or_false),
        cmocka_unit_test (dimensions_must_agree),
        cmocka_unit_test (conditions_and_numbers_do_not_mix),
        cmocka_unit_test (wrong_words_name_their_column),
        cmocka_unit_test (variables_used_are_known),
        cmocka_unit_test (deep_and_long_texts_are_refused_not_fatal),
        cmocka_unit_test (no_memory_leaks_no_block),
    };
    return cmocka_run_group_tests_name ("scene/expression", tests, NULL, NULL);
}
