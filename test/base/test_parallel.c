/* SPDX-License-Identifier: GPL-3.0-or-later
 * Parallel ranges cover every item once, by threads of their own number; the clock does not go back. */
#include "check.h"
#include <pthread.h>

enum { MOST = 5000 };
typedef struct { unsigned char seen[MOST]; int thread[MOST]; pthread_t self[MOST]; int calls[64]; } traces;

static void trace (void *context, size_t first, size_t last, int thread)
{
    traces *t = context;
    t->calls[thread]++;
    for (size_t i = first; i < last; i++) t->seen[i]++, t->thread[i] = thread, t->self[i] = pthread_self ();
}

static void every_item_is_visited_once (void **state)
{
    (void) state;
    static traces t;
    const size_t sizes[] = { 0, 1, 2, 63, 64, 65, 100, 1000, 4999 };
    const int threads[] = { -3, 0, 1, 2, 3, 7, 16, 64, 1000 };
    for (size_t s = 0; s < sizeof sizes / sizeof *sizes; s++)
        for (size_t k = 0; k < sizeof threads / sizeof *threads; k++) {
            memset (&t, 0, sizeof t);
            pg_parallel (threads[k], sizes[s], trace, &t);
            for (size_t i = 0; i < sizes[s]; i++) assert_int_equal (t.seen[i], 1);
            for (size_t i = sizes[s]; i < MOST; i++) assert_int_equal (t.seen[i], 0);
            for (int c = 0; c < 64; c++) assert_true (t.calls[c] <= 1);
        }
}

static void a_thread_number_belongs_to_one_thread (void **state)
{
    (void) state;
    static traces t;
    memset (&t, 0, sizeof t);
    pg_parallel (4, MOST, trace, &t);
    for (size_t i = 0; i < MOST; i++) assert_in_range (t.thread[i], 0, 3);
    for (size_t i = 1; i < MOST; i++) {
        if (t.thread[i] == t.thread[i - 1]) assert_true (pthread_equal (t.self[i], t.self[i - 1]));
        else assert_int_equal (t.thread[i], t.thread[i - 1] + 1);
    }
    assert_int_equal (t.thread[MOST - 1], 3);
}

static void few_items_stay_on_one_thread (void **state)
{
    (void) state;
    static traces t;
    memset (&t, 0, sizeof t);
    pg_parallel (8, 63, trace, &t);
    for (size_t i = 0; i < 63; i++) assert_int_equal (t.thread[i], 0);
}

static void the_clock_runs_forward (void **state)
{
    (void) state;
    double last = pg_seconds ();
    for (int i = 0; i < 1000; i++) {
        double now = pg_seconds ();
        assert_true (now >= last);
        last = now;
    }
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (every_item_is_visited_once),
        cmocka_unit_test (a_thread_number_belongs_to_one_thread),
        cmocka_unit_test (few_items_stay_on_one_thread),
        cmocka_unit_test (the_clock_runs_forward),
    };
    return cmocka_run_group_tests_name ("base/parallel", tests, NULL, NULL);
}
