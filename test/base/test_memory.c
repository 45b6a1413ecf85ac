/* SPDX-License-Identifier: GPL-3.0-or-later
 * Memory: zero-filled, aligned, counted, safe against overflow, and able to fail on demand. */
#include "check.h"

static int all_zero (const unsigned char *p, size_t n)
{
    for (size_t i = 0; i < n; i++) if (p[i]) return 0;
    return 1;
}

static void blocks_are_zero_and_aligned (void **state)
{
    (void) state;
    for (size_t n = 1; n < 3000; n = 2 * n + 1) {
        unsigned char *p = pg_calloc (n, 3);
        assert_non_null (p);
        assert_int_equal ((uintptr_t) p % 64, 0);
        assert_true (all_zero (p, 3 * n));
        memset (p, 0xff, 3 * n);                       /* the next block may reuse this one */
        pg_free (p);
    }
}

static void a_product_that_overflows_gives_no_memory (void **state)
{
    (void) state;
    size_t used = pg_memory_used ();
    assert_null (pg_calloc (SIZE_MAX / 2, 3));
    assert_null (pg_calloc (SIZE_MAX / 16 + 1, 16));
    assert_null (pg_calloc (SIZE_MAX, 1));
    assert_null (pg_calloc (1, SIZE_MAX - 32));        /* the head in front of a block must not wrap around */
    char *p = pg_calloc (10, 1);
    memcpy (p, "perigal", 8);
    assert_null (pg_resize (p, SIZE_MAX / 4, 8));
    assert_string_equal (p, "perigal");
    pg_free (p);
    assert_int_equal (pg_memory_used (), used);
}

static void nothing_is_a_valid_block (void **state)
{
    (void) state;
    size_t used = pg_memory_used ();
    void *p = pg_calloc (0, 8);
    assert_non_null (p);
    p = pg_resize (p, 0, 8);
    assert_non_null (p);
    pg_free (p);
    pg_free (NULL);
    assert_int_equal (pg_memory_used (), used);
}

static void resize_keeps_the_old_and_zeroes_the_new (void **state)
{
    (void) state;
    int *p = pg_resize (NULL, 10, sizeof *p);
    for (int i = 0; i < 10; i++) p[i] = i + 1;
    p = pg_resize (p, 1000, sizeof *p);
    for (int i = 0; i < 10; i++) assert_int_equal (p[i], i + 1);
    for (int i = 10; i < 1000; i++) assert_int_equal (p[i], 0);
    p = pg_resize (p, 4, sizeof *p);
    for (int i = 0; i < 4; i++) assert_int_equal (p[i], i + 1);
    p = pg_resize (p, 8, sizeof *p);
    for (int i = 4; i < 8; i++) assert_int_equal (p[i], 0);
    pg_free (p);
}

static void bytes_in_use_and_their_peak_are_counted (void **state)
{
    (void) state;
    size_t used = pg_memory_used (), calls = pg_memory_calls ();
    char *a = pg_calloc (100, 10), *b = pg_calloc (1, 24);
    assert_int_equal (pg_memory_used (), used + 1024);
    a = pg_resize (a, 5000000, 1);
    assert_int_equal (pg_memory_used (), used + 5000024);
    assert_int_equal (pg_memory_calls (), calls + 3);
    pg_free (a);
    assert_int_equal (pg_memory_used (), used + 24);
    assert_true (pg_memory_peak () >= used + 5000024);
    pg_free (b);
    assert_int_equal (pg_memory_used (), used);
    assert_true (pg_memory_process_peak () > 100000);
}

static void exactly_the_chosen_allocation_fails (void **state)
{
    (void) state;
    for (size_t k = 1; k < 6; k++) {
        pg_memory_fail_at (k);
        for (size_t i = 1; i < 8; i++) {
            void *p = i % 2 ? pg_calloc (3, 3) : pg_resize (NULL, 5, 5);
            if (i == k) assert_null (p);
            else assert_non_null (p);
            pg_free (p);
        }
    }
    pg_memory_fail_at (1);
    pg_memory_fail_at (0);
    char *p = pg_calloc (1, 1);
    assert_non_null (p);
    pg_free (p);
}

static void a_failed_resize_leaves_the_block (void **state)
{
    (void) state;
    size_t used = pg_memory_used ();
    char *p = pg_strdup ("bond");
    assert_string_equal (p, "bond");
    pg_memory_fail_at (1);
    assert_null (pg_resize (p, 100, 1));
    pg_memory_fail_at (0);
    assert_string_equal (p, "bond");
    pg_free (p);
    pg_memory_fail_at (1);
    assert_null (pg_strdup ("bond"));
    pg_memory_fail_at (0);
    assert_int_equal (pg_memory_used (), used);
}

static pg_status grow_to (size_t n, size_t *cap)
{
    pg_status status = PG_OK;
    int *list = NULL;
    for (size_t i = 0; i < n; i++) {
        PG_GROW (list, *cap, i + 1);
        list[i] = (int) i;
    }
    for (size_t i = 0; i < n; i++) if (list[i] != (int) i) PG_FAIL (PG_E_USAGE, "entry %zu was lost", i);
done:
    pg_free (list);
    return status;
}

static void growing_doubles_and_reports_failure (void **state)
{
    (void) state;
    size_t calls = pg_memory_calls (), cap = 0, used = pg_memory_used ();
    check_ok (grow_to (100000, &cap));
    assert_in_range (cap, 100000, 300000);
    check_below ((double) (pg_memory_calls () - calls), 20);
    for (size_t k = 1; k < 6; k++) {
        cap = 0;
        pg_memory_fail_at (k);
        check_fails (grow_to (1000, &cap), PG_E_MEMORY);
        pg_memory_fail_at (0);
    }
    assert_int_equal (pg_memory_used (), used);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (blocks_are_zero_and_aligned),
        cmocka_unit_test (a_product_that_overflows_gives_no_memory),
        cmocka_unit_test (nothing_is_a_valid_block),
        cmocka_unit_test (resize_keeps_the_old_and_zeroes_the_new),
        cmocka_unit_test (bytes_in_use_and_their_peak_are_counted),
        cmocka_unit_test (exactly_the_chosen_allocation_fails),
        cmocka_unit_test (a_failed_resize_leaves_the_block),
        cmocka_unit_test (growing_doubles_and_reports_failure),
    };
    return cmocka_run_group_tests_name ("base/memory", tests, NULL, NULL);
}
