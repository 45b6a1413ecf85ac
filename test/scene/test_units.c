/* SPDX-License-Identifier: GPL-3.0-or-later
 * Numbers with units: values, refusals and their words. */
#include "check.h"
#include "scene/quantity/unit.h"

static double value (const char *text, const char *unit)
{
    double v = NAN;
    check_ok (pg_unit_parse (&v, text, unit));
    return v;
}

#define REFUSED(text, unit, words) \
    do { \
        double v_ = 7; \
        check_fails (pg_unit_parse (&v_, (text), (unit)), PG_E_SCENE); \
        assert_string_equal (pg_last_error (), (words)); \
        assert_true (v_ == 7); \
    } while (0)

static void usual_units_become_si (void **state)
{
    (void) state;
    static const struct { const char *text, *unit; double si;
    } row[] = {
        { "10 GPa", "Pa", 1e10 },     { "0.5MPa", "Pa", 5e5 },    { "2500 kg/m3", "kg/m3", 2500 },
        { "-1 um", "m", -1e-6 },      { "3 mm", "m", 0.003 },     { "72 mm", "m", 0.072 },
        { "1 \xC2\xB5m", "m", 1e-6 }, { "4 1/s", "1/s", 4 },      { "4 Hz", "1/s", 4 },
        { "100 J/m2", "N/m", 100 },   { "100 N/m", "J/m2", 100 }, { "2 m/s", "m/s", 2 },
        { "0.1 ms", "s", 1e-4 },      { "5 %", "1", 0.05 },       { "5%", "1", 0.05 },
        { "1 kN m", "J", 1000 },      { "3 N/mm^2", "Pa", 3e6 },  { "3 N/mm2", "Pa", 3e6 },
        { "1e-3", "m", 1e-3 },        { ".5", "1", 0.5 },         { "+2.", "m", 2 },
        { "1E3 N", "N", 1000 },       { "  7 m  ", "m", 7 },      { "2 m s-1", "m/s", 2 },
        { "12", "Pa", 12 },           { "1 h", "s", 3600 },
    };
    for (size_t k = 0; k < sizeof row / sizeof *row; k++) {
        double v = value (row[k].text, row[k].unit);
        if (v != row[k].si) print_error ("%s for %s\n", row[k].text, row[k].unit);
        assert_true (v == row[k].si);                  /* exactly: 3 mm and 0.003 are one number */
    }
}

/* Of a key that counts in another unit than the SI's. */
static void values_count_in_the_unit_of_their_key (void **state)
{
    (void) state;
    check_relative (value ("2 m", "mm"), 2000, 1e-15);
    check_relative (value ("0.5 GPa", "MPa"), 500, 1e-15);
    check_relative (value ("90 min", "h"), 1.5, 1e-15);
}

/* The second spelling is one that only the database knows. */
static void common_units_are_those_of_the_database (void **state)
{
    (void) state;
    static const char *const pair[][2] = { { "m", "meter" },      { "mm", "mm^1" },     { "m2", "meter2" },
                                           { "m3", "meter3" },    { "kg", "kilogram" }, { "s", "second" },
                                           { "1/s", "s-1" },      { "m/s", "m s-1" },   { "m/s2", "m s-2" },
                                           { "N", "N^1" },        { "kN", "kN^1" },     { "J", "J^1" },
                                           { "Pa", "Pa^1" },      { "MPa", "MPa^1" },   { "GPa", "GPa^1" },
                                           { "N/m", "N m-1" },    { "J/m2", "J m-2" },  { "N/m3", "N m-3" },
                                           { "kg/m3", "kg m-3" }, { "%", "percent" },   { "min", "minute" },
                                           { "cm", "cm^1" },      { "um", "um^1" },     { "ms", "ms^1" },
                                           { "us", "us^1" },      { "m^2", "meter^2" }, { "m^3", "meter3" },
                                           { "m^4", "meter^4" },  { "m4", "meter4" },   { "mm/s", "mm s-1" },
                                           { "kPa", "kPa^1" },    { "N/m2", "N m-2" },  { "rad", "radian" },
                                           { "deg", "arc_degree" } };
    for (size_t k = 0; k < sizeof pair / sizeof *pair; k++) {
        pg_measure a, b;
        check_ok (pg_measure_read (&a, pair[k][0], strlen (pair[k][0])));
        check_ok (pg_measure_read (&b, pair[k][1], strlen (pair[k][1])));
        if (a.factor != b.factor || a.angle != b.angle || memcmp (a.power, b.power, sizeof a.power) != 0)
            fail_msg ("%s is not %s", pair[k][0], pair[k][1]);
    }
}

static void degrees_are_angles (void **state)
{
    (void) state;
    check_relative (value ("40 deg", "rad"), 40 * 3.14159265358979323846 / 180, 1e-15);
    check_relative (value ("1 rad", "rad"), 1, 0);
    REFUSED ("40 deg", "1", "'deg' does not fit: expected a plain number or %, for example 0.25");
    REFUSED ("5 %", "rad", "'%' does not fit: expected rad, for example 40 deg");
}

static void wrong_dimension_names_unit_and_example (void **state)
{
    (void) state;
    REFUSED ("72 mm", "Pa", "'mm' does not fit: expected Pa, for example 10 GPa");
    /* a reciprocal is another unit */
    REFUSED ("1 s", "1/s", "'s' does not fit: expected 1/s, for example 100 1/s");
    REFUSED ("1 Pa", "m|spacing", "'Pa' does not fit: expected m or spacing, for example 5 mm or 2 spacing");
    REFUSED ("1 Pa", "J/m2", "'Pa' does not fit: expected J/m2, for example 100 J/m2");
}

static void nonsense_is_refused (void **state)
{
    (void) state;
    REFUSED ("10 Gpa", "Pa", "unknown unit 'Gpa'; did you mean GPa?");
    REFUSED ("10 furlongwise", "Pa", "unknown unit 'furlongwise'");
    REFUSED ("fast", "Pa", "must be a number with a unit of Pa, for example 10 GPa");
    REFUSED ("", "1", "must be a number, for example 0.25");
    REFUSED ("0,5", "1", "is not a number: the decimal mark is a point");
    REFUSED ("1e999", "1", "is too large for a number: in SI units at most 1e60");
    REFUSED ("1e306 GPa", "Pa", "is too large for a number: in SI units at most 1e60");
    REFUSED ("-1e58 GPa", "Pa", "is too large for a number: in SI units at most 1e60");
    REFUSED ("1e-61", "1", "is too small for a number: in SI units 0, or at least 1e-60");
    REFUSED ("1e-309 us", "s", "is too small for a number: in SI units 0, or at least 1e-60");
    REFUSED ("2 spacing", "m", "spacing is not a unit here");
    REFUSED ("inf", "m", "must be a number with a unit of m, for example 5 mm");
    REFUSED ("nan", "m", "must be a number with a unit of m, for example 5 mm");
    REFUSED ("0x10", "1", "unknown unit 'x10'");
    static const char *const odd[] = { "5 m)",    "5 m from 3",   "5 m @ 3", "5 degC",
                                       "10 20 m", "5 m^0.5",      "5 m--2",  "5 m/",
                                       "5 /m",    "5 lg(re 1 m)", "5 m\n/",  "5 m 5" };
    for (size_t k = 0; k < sizeof odd / sizeof *odd; k++) {
        double v;
        if (pg_unit_parse (&v, odd[k], "m") == PG_OK) print_error ("accepted %s\n", odd[k]);
        check_fails (pg_unit_parse (&v, odd[k], "m"), PG_E_SCENE);
    }
}

static void spacing_is_kept_as_a_multiple (void **state)
{
    (void) state;
    double v;
    int spacing;
    check_ok (pg_quantity_read (&v, &spacing, "2.0 spacing", "m|spacing"));
    assert_true (v == 2 && spacing == 1);
    check_ok (pg_quantity_read (&v, &spacing, "4 mm", "m|spacing"));
    assert_true (v == 0.004 && spacing == 0);
}

static void ranges_hold_their_ends_as_written (void **state)
{
    (void) state;
    int wrong;
    assert_true (pg_range_holds ("[0, 0.5)", 0, &wrong) && !pg_range_holds ("[0, 0.5)", 0.5, &wrong)
                 && !wrong);
    assert_true (!pg_range_holds ("(0, inf)", 0, &wrong) && pg_range_holds ("(0, inf)", 1e300, &wrong)
                 && !wrong);
    assert_true (pg_range_holds ("[0, pi/2)", 1.57, &wrong) && !pg_range_holds ("[0, pi/2)", 1.58, &wrong)
                 && !wrong);
    assert_true (pg_range_holds ("(-inf, 2 pi]", 6.28, &wrong) && !pg_range_holds ("(-1, 0.5]", -1, &wrong)
                 && !wrong);
    static const char *const bad[] = { "", "0, 1", "[0 1]", "[1, 0]", "[0, 1", "[a, b]", "[0, 1] " };
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
        pg_range_holds (bad[k], 0, &wrong);
        assert_true (wrong);
    }
}

static void parse_many (void *context, size_t first, size_t last, int thread)
{
    int *wrong = context;
    (void) thread;
    for (size_t k = first; k < last; k++) {
        double v = 0;
        static const char *const text[] = { "10 GPa", "3 MPa", "7 N/mm2", "1 bar" };
        static const double si[] = { 1e10, 3e6, 7e6, 1e5 };
        if (pg_unit_parse (&v, text[k % 4], "Pa") != PG_OK || v != si[k % 4]) wrong[k]++;
    }
}

static void threads_may_parse_together (void **state)
{
    (void) state;
    static int wrong[4000];
    pg_parallel (4, 4000, parse_many, wrong);
    for (size_t k = 0; k < 4000; k++) assert_int_equal (wrong[k], 0);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (threads_may_parse_together),
        cmocka_unit_test (usual_units_become_si),
        cmocka_unit_test (values_count_in_the_unit_of_their_key),
        cmocka_unit_test (common_units_are_those_of_the_database),
        cmocka_unit_test (degrees_are_angles),
        cmocka_unit_test (wrong_dimension_names_unit_and_example),
        cmocka_unit_test (nonsense_is_refused),
        cmocka_unit_test (spacing_is_kept_as_a_multiple),
        cmocka_unit_test (ranges_hold_their_ends_as_written),
    };
    return cmocka_run_group_tests_name ("scene/units", tests, NULL, NULL);
}
