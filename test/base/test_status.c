/* SPDX-License-Identifier: GPL-3.0-or-later
 * Status texts and the message of the last failure. */
#include "check.h"
#include <pthread.h>
#include <stdlib.h>

static void every_status_has_its_own_text (void **state)
{
    (void) state;
    for (int a = 0; a < PG_STATUS_COUNT; a++) {
        assert_true (strlen (pg_status_text ((pg_status) a)) > 1);
        for (int b = 0; b < a; b++)
            assert_string_not_equal (pg_status_text ((pg_status) a), pg_status_text ((pg_status) b));
    }
    assert_string_equal (pg_status_text (PG_STATUS_COUNT), "unknown status");
    assert_string_equal (pg_status_text ((pg_status) -1), "unknown status");
}

static pg_status fail_with (int number)
{
    pg_status status = PG_OK;
    PG_FAIL (PG_E_LIMIT, "number %d is too large", number);
done:
    return status;
}

static pg_status pass_on (int number)
{
    pg_status status = PG_OK;
    PG_TRY (fail_with (number));
    status = PG_E_USAGE;
done:
    return status;
}

static void a_failure_keeps_message_and_place (void **state)
{
    (void) state;
    assert_int_equal (pass_on (17), PG_E_LIMIT);
    assert_string_equal (pg_last_error (), "number 17 is too large");
    check_contains (pg_last_error_where (), "test_status.c:");
    assert_int_equal (pass_on (18), PG_E_LIMIT);
    assert_string_equal (pg_last_error (), "number 18 is too large");
}

static void a_message_may_quote_the_last_one (void **state)
{
    (void) state;
    fail_with (3);
    for (int k = 0; k < 3; k++)
        assert_int_equal (pg_error (PG_E_FILE, PG_HERE, "file: %s", pg_last_error ()), PG_E_FILE);
    assert_string_equal (pg_last_error (), "file: file: file: number 3 is too large");
}

static void a_long_message_is_cut_not_overrun (void **state)
{
    (void) state;
    size_t n = 100000;
    char *text = malloc (n + 1);
    memset (text, 'a', n);
    text[n] = 0;
    pg_error (PG_E_SCENE, text, "%s", text);
    assert_in_range (strlen (pg_last_error ()), 1000, n - 1);
    assert_in_range (strlen (pg_last_error_where ()), 1, 1000);
    free (text);
}

static void *fail_elsewhere (void *seen)
{
    *(int *) seen = *pg_last_error () == 0;            /* a new thread has no message */
    fail_with (99);
    return NULL;
}

static void each_thread_has_its_own_message (void **state)
{
    (void) state;
    int empty = 0;
    pthread_t thread;
    fail_with (5);
    assert_int_equal (pthread_create (&thread, NULL, fail_elsewhere, &empty), 0);
    pthread_join (thread, NULL);
    assert_true (empty);
    assert_string_equal (pg_last_error (), "number 5 is too large");
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (every_status_has_its_own_text),
        cmocka_unit_test (a_failure_keeps_message_and_place),
        cmocka_unit_test (a_message_may_quote_the_last_one),
        cmocka_unit_test (a_long_message_is_cut_not_overrun),
        cmocka_unit_test (each_thread_has_its_own_message),
    };
    return cmocka_run_group_tests_name ("base/status", tests, NULL, NULL);
}
