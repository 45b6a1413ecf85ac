/* SPDX-License-Identifier: GPL-3.0-or-later
 * Libraries that are loaded when they are needed: the table is filled once; one that is missing, or lacks a
 * function, is refused with the package to install. */
#include "check.h"
#include <math.h>
#include <stddef.h>

/* Two functions of the mathematical library of C. */
typedef struct { double (*cos) (double), (*sin) (double); } table;

static void a_library_fills_its_table (void **state)
{
    (void) state;
    table t = { NULL, NULL };
    const pg_library_function function[] = { { "cos", offsetof (table, cos) },
                                             { "sin", offsetof (table, sin) } };
    pg_library l = { "libm.so.6", "libc6", "angles", 2, function, &t, 0, 0 };
    check_ok (pg_library_load (&l));
    assert_int_equal (l.ready, 1);
    double angle = 0.5;
    assert_true (t.cos (angle) == cos (angle) && t.sin (angle) == sin (angle));
    /* what is loaded is not loaded again: the table is left alone */
    t.cos = NULL;
    check_ok (pg_library_load (&l));
    assert_null (t.cos);
}

static void a_missing_library_is_named_with_its_package (void **state)
{
    (void) state;
    table t = { NULL, NULL };
    const pg_library_function function[] = { { "cos", offsetof (table, cos) } };
    pg_library l = { "libperigal-no-such.so.9", "libnosuch9", "angles", 1, function, &t, 0, 0 };
    assert_int_equal (pg_library_load (&l), PG_E_FILE);
    assert_non_null (strstr (pg_last_error (), "angles need the library libperigal-no-such.so.9"));
    assert_non_null (strstr (pg_last_error (), "install the Debian package libnosuch9"));
    assert_int_equal (l.ready, 0);
    /* and again: a fault is not taken for success later */
    assert_int_equal (pg_library_load (&l), PG_E_FILE);
}

static void a_missing_function_is_named (void **state)
{
    (void) state;
    table t = { NULL, NULL };
    const pg_library_function function[] = { { "cos", offsetof (table, cos) },
                                             { "cosine_of_nothing", offsetof (table, sin) } };
    pg_library l = { "libm.so.6", "libc6", "angles", 2, function, &t, 0, 0 };
    assert_int_equal (pg_library_load (&l), PG_E_FILE);
    assert_non_null (strstr (pg_last_error (), "with the function cosine_of_nothing"));
    assert_int_equal (l.ready, 0);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (a_library_fills_its_table),
        cmocka_unit_test (a_missing_library_is_named_with_its_package),
        cmocka_unit_test (a_missing_function_is_named),
    };
    return cmocka_run_group_tests (tests, NULL, NULL);
}
