/* SPDX-License-Identifier: GPL-3.0-or-later
 * Parallel ranges cover every item once, by threads of their own number; the clock does not go back. */
#include "check.h"
#include <pthread.h>
#include <stdatomic.h>
#include <time.h>
#include <sys/wait.h>
#include <unistd.h>

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

/* The caller goes on when the slowest part is done, asleep meanwhile: parts of other threads take longer than
 * it looks at a word. */
typedef struct { _Atomic int begun; int done[8]; } slow;

static void work_slowly (void *context, size_t first, size_t last, int thread)
{
    slow *w = context;
    const struct timespec little = { 0, 1000000 }, long_ = { 0, 50000000 };
    (void) first, (void) last;
    w->begun++;
    /* the others have all begun */
    for (int k = 0; thread == 0 && w->begun < 4 && k < 500; k++) nanosleep (&little, NULL);
    if (thread > 0) nanosleep (&long_, NULL);
    w->done[thread] = 1;
}

static void the_caller_waits_for_all_parts (void **state)
{
    (void) state;
    for (int round = 0; round < 3; round++) {
        slow w = { 0 };
        pg_parallel_heavy (4, 4, work_slowly, &w);
        for (int k = 0; k < 4; k++) assert_int_equal (w.done[k], 1);
    }
}

/* A loop inside a loop keeps its ranges and stays on its thread. */
typedef struct { int sum[8], calls[8][3]; pthread_t self[8]; int strayed; } nest;
typedef struct { nest *all; int outer; } nested;

static void inner (void *context, size_t first, size_t last, int thread)
{
    nested *n = context;
    if (!pthread_equal (n->all->self[n->outer], pthread_self ())) n->all->strayed = 1;
    n->all->calls[n->outer][thread]++;
    for (size_t i = first; i < last; i++) n->all->sum[n->outer] += (int) i;
}

static void outer (void *context, size_t first, size_t last, int thread)
{
    (void) thread;
    for (size_t i = first; i < last; i++) {
        nested n = { context, (int) i };
        n.all->self[i] = pthread_self ();
        pg_parallel_heavy (3, 100, inner, &n);
    }
}

static void loops_may_be_nested (void **state)
{
    (void) state;
    for (int round = 0; round < 100; round++) {
        nest all = { 0 };
        pg_parallel_heavy (4, 8, outer, &all);
        assert_int_equal (all.strayed, 0);
        for (int i = 0; i < 8; i++) {
            assert_int_equal (all.sum[i], 4950);
            for (int k = 0; k < 3; k++) assert_int_equal (all.calls[i][k], 1);
        }
    }
}

/* Loops from several threads at once, one after the other without a pause */
typedef struct { unsigned char seen[500]; int wrong; } burst;
static void touch (void *context, size_t first, size_t last, int thread)
{
    (void) thread;
    for (size_t i = first; i < last; i++) ((burst *) context)->seen[i]++;
}

static void *many_loops (void *p)
{
    burst *b = p;
    for (int round = 0; round < 300; round++) {
        memset (b->seen, 0, sizeof b->seen);
        pg_parallel (2 + round % 3, sizeof b->seen, touch, b);
        for (size_t i = 0; i < sizeof b->seen; i++) b->wrong += b->seen[i] != 1;
    }
    return NULL;
}

static void several_threads_may_call (void **state)
{
    (void) state;
    static burst b[3];
    pthread_t id[3];
    for (int k = 0; k < 3; k++) assert_int_equal (pthread_create (&id[k], NULL, many_loops, &b[k]), 0);
    for (int k = 0; k < 3; k++) assert_int_equal (pthread_join (id[k], NULL), 0);
    for (int k = 0; k < 3; k++) assert_int_equal (b[k].wrong, 0);
}

static void a_child_of_fork_may_call (void **state)
{
    (void) state;
    static burst b;
    pg_parallel (3, sizeof b.seen, touch, &b);
    pid_t child = fork ();
    assert_true (child >= 0);
    if (child == 0) {
        alarm (20);  /* waiting for threads that are not there must not last */
        many_loops (&b);
        _exit (b.wrong ? 1 : 0);
    }
    int result = -1;
    assert_int_equal (waitpid (child, &result, 0), child);
    assert_true (WIFEXITED (result));
    assert_int_equal (WEXITSTATUS (result), 0);
    many_loops (&b);
    assert_int_equal (b.wrong, 0);
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
        cmocka_unit_test (the_caller_waits_for_all_parts),
        cmocka_unit_test (loops_may_be_nested),
        cmocka_unit_test (several_threads_may_call),
        cmocka_unit_test (a_child_of_fork_may_call),
        cmocka_unit_test (the_clock_runs_forward),
    };
    return cmocka_run_group_tests_name ("base/parallel", tests, NULL, NULL);
}
