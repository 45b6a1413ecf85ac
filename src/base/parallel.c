/* SPDX-License-Identifier: GPL-3.0-or-later
 * A clock and a parallel loop over disjoint ranges (plain threads: the OpenMP limit that CHOLMOD needs does
 * not bind them). The threads are started once and wait, awake for some microseconds, then asleep. What a
 * thread has not begun when the caller is done with its own part, the caller does itself: on a busy machine
 * nobody waits for a thread that gets no processor. Loops inside loops stay on their thread; a loop that
 * finds the threads busy with another's starts some of its own. */
#include "perigal/base.h"
#include <pthread.h>
#include <stdatomic.h>
#include <time.h>
#include <unistd.h>

enum { MAX_THREADS = 64, LOOKS = 1000 };  /* LOOKS at a word, some ten ns each, before going to sleep */

typedef struct { pg_work work; void *context; size_t first, last; int thread; } job;
typedef struct {
    _Alignas (64) atomic_uint turn;                    /* goes up: there is a job */
    atomic_uint claimed;                               /* turn whose job somebody has begun */
    job       job;
    int       quit;
    pthread_t id;
    pthread_mutex_t lock;
    pthread_cond_t  wake;
} helper;

static helper helpers[MAX_THREADS];                    /* 1 .. started - 1 */
static int started = 1, looks = -1;
/* gate: held during a loop */
static pthread_mutex_t gate = PTHREAD_MUTEX_INITIALIZER, end_lock = PTHREAD_MUTEX_INITIALIZER;
static pthread_cond_t end = PTHREAD_COND_INITIALIZER;
static atomic_int unfinished;
static pthread_once_t once = PTHREAD_ONCE_INIT;
static _Thread_local int inside;                       /* this thread runs a part of a loop */

double pg_seconds (void)
{
    struct timespec t;
    clock_gettime (CLOCK_MONOTONIC, &t);
    return (double) t.tv_sec + 1e-9 * (double) t.tv_nsec;
}

static void *run (void *p)
{
    job *j = p;
    int outer = inside;
    inside = 1;
    j->work (j->context, j->first, j->last, j->thread);
    inside = outer;
    return NULL;
}

static void pause_briefly (void)
{
#ifdef __x86_64__
    __builtin_ia32_pause ();
#endif
}

static int claim (helper *h, unsigned turn)            /* 1: the job of this turn is the caller's */
{
    unsigned before = turn - 1;
    return atomic_compare_exchange_strong (&h->claimed, &before, turn);
}

/* ---- threads that wait --------------------------------------------------------------------------------- */
static void *serve (void *p)
{
    helper *h = p;
    unsigned seen = 0;
    for (;;) {
        for (int k = 0; k < looks && atomic_load_explicit (&h->turn, memory_order_acquire) == seen; k++)
            pause_briefly ();
        pthread_mutex_lock (&h->lock);
        while (atomic_load (&h->turn) == seen) pthread_cond_wait (&h->wake, &h->lock);
        seen = atomic_load (&h->turn);
        int quit = h->quit;
        pthread_mutex_unlock (&h->lock);
        if (quit) return NULL;
        if (!claim (h, seen)) continue;
        run (&h->job);
        if (atomic_fetch_sub (&unfinished, 1) > 1) continue;
        pthread_mutex_lock (&end_lock);
        pthread_cond_signal (&end);
        pthread_mutex_unlock (&end_lock);
    }
}

static void give_turn (helper *h, int quit)
{
    pthread_mutex_lock (&h->lock);
    h->quit = quit;
    atomic_fetch_add (&h->turn, 1);
    pthread_mutex_unlock (&h->lock);
    pthread_cond_signal (&h->wake);
}

static void forget (void)                              /* a child of fork has none of these threads */
{
    started = 1;
    inside = 0;
    pthread_mutex_init (&gate, NULL);
    pthread_mutex_init (&end_lock, NULL);
    pthread_cond_init (&end, NULL);
}

static void prepare (void)
{
    pthread_atfork (NULL, NULL, forget);
    looks = sysconf (_SC_NPROCESSORS_ONLN) > 1 ? LOOKS : 0;
}

/* At exit and where the library is unloaded: no thread may be left in its code. */
__attribute__ ((destructor)) static void dismiss (void)
{
    if (pthread_mutex_trylock (&gate) != 0) return;    /* exit from within a loop */
    for (int k = 1; k < started; k++) give_turn (&helpers[k], 1);
    for (int k = 1; k < started; k++) pthread_join (helpers[k].id, NULL);
    started = 1;
    pthread_mutex_unlock (&gate);
}

static void hire (int threads)
{
    pthread_once (&once, prepare);
    for (; started < threads; started++) {
        helper *h = &helpers[started];
        atomic_store (&h->turn, 0);
        atomic_store (&h->claimed, 0);
        h->quit = 0;
        pthread_mutex_init (&h->lock, NULL);
        pthread_cond_init (&h->wake, NULL);
        if (pthread_create (&h->id, NULL, serve, h) != 0) return;
    }
}

static void run_with_helpers (int threads, job *jobs)
{
    hire (threads);
    int given = threads < started ? threads : started;
    atomic_store (&unfinished, given - 1);
    for (int k = 1; k < given; k++) helpers[k].job = jobs[k], give_turn (&helpers[k], 0);
    run (&jobs[0]);
    for (int k = given; k < threads; k++) run (&jobs[k]);
    for (int k = 1; k < given; k++) {
        if (!claim (&helpers[k], atomic_load (&helpers[k].turn))) continue;
        run (&jobs[k]);
        atomic_fetch_sub (&unfinished, 1);
    }
    for (int k = 0; k < looks && atomic_load_explicit (&unfinished, memory_order_acquire) > 0; k++)
        pause_briefly ();
    if (atomic_load (&unfinished) == 0) return;
    pthread_mutex_lock (&end_lock);
    while (atomic_load (&unfinished) > 0) pthread_cond_wait (&end, &end_lock);
    pthread_mutex_unlock (&end_lock);
}

/* ---- loops --------------------------------------------------------------------------------------------- */
static void run_with_own (int threads, job *jobs)
{
    pthread_t id[MAX_THREADS];
    int running[MAX_THREADS] = { 0 };
    for (int k = 1; k < threads; k++) running[k] = pthread_create (&id[k], NULL, run, &jobs[k]) == 0;
    run (&jobs[0]);
    for (int k = 1; k < threads; k++) {
        if (running[k]) pthread_join (id[k], NULL);
        else run (&jobs[k]);
    }
}

void pg_parallel (int threads, size_t n, pg_work work, void *context)
{
    pg_parallel_heavy (n < 64 ? 1 : threads, n, work, context);
}

void pg_parallel_heavy (int threads, size_t n, pg_work work, void *context)
{
    if (threads > MAX_THREADS) threads = MAX_THREADS;
    if (threads < 1) threads = 1;
    if ((size_t) threads > n) threads = n > 0 ? (int) n : 1;
    job jobs[MAX_THREADS];
    for (int k = 0; k < threads; k++)
        jobs[k] = (job){ work, context, n * (size_t) k / (size_t) threads,
                         n * (size_t) (k + 1) / (size_t) threads, k };
    if (threads == 1) work (context, 0, n, 0);         /* loops within may use threads */
    else if (inside) {
        for (int k = 0; k < threads; k++) run (&jobs[k]);
    } else if (pthread_mutex_trylock (&gate) == 0) {
        run_with_helpers (threads, jobs);
        pthread_mutex_unlock (&gate);
    } else run_with_own (threads, jobs);
}
