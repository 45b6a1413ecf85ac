/* SPDX-License-Identifier: GPL-3.0-or-later
 * A clock, and a parallel loop over disjoint ranges, by POSIX threads: the limit on OpenMP threads that
 * CHOLMOD needs does not bind them.
 *
 * Helper threads are started once and wait for a job: awake for some microseconds, then for some milliseconds
 * in which any other thread gets the processor first, then asleep. To wake a thread takes as long as many a
 * loop of conjugate gradients (with sleep after the first microseconds their solves take 8 % longer on two
 * threads). A part of a loop that no helper has begun when the calling thread is done with its own part, the
 * calling thread does itself: on a busy machine nobody waits for a helper that gets no processor. Loops
 * inside loops stay on their thread; a loop that finds the helpers busy with another loop starts threads of
 * its own. */
#include "perigal/base.h"
#include <pthread.h>
#include <sched.h>
#include <stdatomic.h>
#include <time.h>
#include <unistd.h>

/* Threads at most. How often a waiting thread looks at a variable: LOOKS times, some ten ns each, then YIELDS
 * times, some hundred ns each, after which it sleeps. */
enum { MAX_THREADS = 64, LOOKS = 1000, YIELDS = 5000 };

/* A part of a loop. */
typedef struct { pg_work work; void *context; size_t first, last; int thread; } job;

/* A helper thread and its present job. */
typedef struct {
    /* Number of the present job; a change means that there is one. On a cache line of its own. */
    _Alignas (64) atomic_uint turn;
    /* Number of the last job that somebody, the helper or the calling thread, has begun. */
    atomic_uint claimed;
    job       job;
    int       quit;
    pthread_t id;
    pthread_mutex_t lock;
    pthread_cond_t  wake;
} helper;

/* The threads of this process, and the one loop at a time that they work at. One for all: threads are a
 * resource of the process, and solvers that had threads of their own would get in each other's way. */
static struct {
    helper helper[MAX_THREADS];                        /* entries 1 .. started - 1 are in use */
    int    started;                                    /* threads there are, the caller's among them */
    int    looks;                                      /* how often to look before sleep; 0: one core */
    pthread_once_t  once;
    pthread_mutex_t gate;                              /* held during a loop */
    pthread_mutex_t end_lock;
    pthread_cond_t  end;                               /* the last thread has done its part */
    atomic_uint     unfinished;                        /* parts of the loop that other threads have to do */
} pool = { .started = 1, .looks = -1, .once = PTHREAD_ONCE_INIT, .gate = PTHREAD_MUTEX_INITIALIZER,
           .end_lock = PTHREAD_MUTEX_INITIALIZER, .end = PTHREAD_COND_INITIALIZER };
/* 1: this thread is running a part of a loop. */
static _Thread_local int inside;

double pg_seconds (void)
{
    struct timespec t;
    clock_gettime (CLOCK_MONOTONIC, &t);
    return (double) t.tv_sec + 1e-9 * (double) t.tv_nsec;
}

/* Runs a part of a loop; in the form of a thread's main function. */
static void *run (void *p)
{
    job *j = p;
    int outer = inside;
    inside = 1;
    j->work (j->context, j->first, j->last, j->thread);
    inside = outer;
    return NULL;
}

/* Tells the processor that this is a waiting loop. */
static void pause_briefly (void)
{
#ifdef __x86_64__
    __builtin_ia32_pause ();
#endif
}

/* 1: the caller has the job of this turn; exactly one thread gets it. */
static int claim (helper *h, unsigned turn)
{
    unsigned before = turn - 1;
    return atomic_compare_exchange_strong (&h->claimed, &before, turn);
}

/* Waits awake, for a while, for the variable to be something else than `from`; 0: it still is. */
static int watch (atomic_uint *variable, unsigned from)
{
    for (int k = 0; k < pool.looks; k++) {
        if (atomic_load_explicit (variable, memory_order_acquire) != from) return 1;
        if (k < LOOKS) pause_briefly ();
        else sched_yield ();
    }
    return 0;
}

/* ---- helper threads ------------------------------------------------------------------------------------ */
/* Main function of a helper. The lock is taken even where the job was seen without it, because `quit` and
 * `job` are written under it. */
static void *serve (void *p)
{
    helper *h = p;
    unsigned seen = 0;
    for (;;) {
        watch (&h->turn, seen);
        pthread_mutex_lock (&h->lock);
        while (atomic_load (&h->turn) == seen) pthread_cond_wait (&h->wake, &h->lock);
        seen = atomic_load (&h->turn);
        int quit = h->quit;
        pthread_mutex_unlock (&h->lock);
        if (quit) return NULL;
        if (!claim (h, seen)) continue;
        run (&h->job);
        if (atomic_fetch_sub (&pool.unfinished, 1) > 1) continue;
        pthread_mutex_lock (&pool.end_lock);
        pthread_cond_signal (&pool.end);
        pthread_mutex_unlock (&pool.end_lock);
    }
}

/* Announces a new job to a helper, or that it is to end. */
static void give_turn (helper *h, int quit)
{
    pthread_mutex_lock (&h->lock);
    h->quit = quit;
    atomic_fetch_add (&h->turn, 1);
    pthread_mutex_unlock (&h->lock);
    pthread_cond_signal (&h->wake);
}

/* Called in a child of fork, where no helper thread exists: resets the pool to its state at the start. */
static void forget (void)
{
    pool.started = 1;
    inside = 0;
    pthread_mutex_init (&pool.gate, NULL);
    pthread_mutex_init (&pool.end_lock, NULL);
    pthread_cond_init (&pool.end, NULL);
}

/* Runs once per process. With one processor, waiting awake would only take time from the other threads. */
static void prepare (void)
{
    pthread_atfork (NULL, NULL, forget);
    pool.looks = sysconf (_SC_NPROCESSORS_ONLN) > 1 ? LOOKS + YIELDS : 0;
}

/* Ends all helpers at exit, and when the library is unloaded: no thread may be left in its code. */
__attribute__ ((destructor)) static void dismiss (void)
{
    /* The process exits from within a loop: threads are still at work. */
    if (pthread_mutex_trylock (&pool.gate) != 0) return;
    for (int k = 1; k < pool.started; k++) give_turn (&pool.helper[k], 1);
    for (int k = 1; k < pool.started; k++) pthread_join (pool.helper[k].id, NULL);
    pool.started = 1;
    pthread_mutex_unlock (&pool.gate);
}

/* Starts helpers until there are as many as wanted, or the system gives no more. */
static void hire (int threads)
{
    pg_signals before;
    pthread_once (&pool.once, prepare);
    pg_signals_hold (&before);                         /* a new thread inherits the signal mask */
    for (; pool.started < threads; pool.started++) {
        helper *h = &pool.helper[pool.started];
        atomic_store (&h->turn, 0);
        atomic_store (&h->claimed, 0);
        h->quit = 0;
        pthread_mutex_init (&h->lock, NULL);
        pthread_cond_init (&h->wake, NULL);
        if (pthread_create (&h->id, NULL, serve, h) != 0) break;
    }
    pg_signals_release (&before);
}

/* Gives a part to each helper, runs its own, takes back those that no helper has begun, and waits for the
 * rest. */
static void run_with_helpers (int threads, job *jobs)
{
    hire (threads);
    int given = threads < pool.started ? threads : pool.started;
    atomic_store (&pool.unfinished, (unsigned) given - 1);
    for (int k = 1; k < given; k++) pool.helper[k].job = jobs[k], give_turn (&pool.helper[k], 0);
    run (&jobs[0]);
    for (int k = given; k < threads; k++) run (&jobs[k]);
    for (int k = 1; k < given; k++) {
        if (!claim (&pool.helper[k], atomic_load (&pool.helper[k].turn))) continue;
        run (&jobs[k]);
        atomic_fetch_sub (&pool.unfinished, 1);
    }
    unsigned left = atomic_load (&pool.unfinished);
    while (left > 0 && watch (&pool.unfinished, left)) left = atomic_load (&pool.unfinished);
    if (left == 0) return;
    pthread_mutex_lock (&pool.end_lock);
    while (atomic_load (&pool.unfinished) > 0) pthread_cond_wait (&pool.end, &pool.end_lock);
    pthread_mutex_unlock (&pool.end_lock);
}

/* ---- loops --------------------------------------------------------------------------------------------- */
/* Runs the first part here, each other one on a thread started for this loop only, or here if none starts. */
static void run_with_own (int threads, job *jobs)
{
    pthread_t id[MAX_THREADS];
    int running[MAX_THREADS] = { 0 };
    pg_signals before;
    pg_signals_hold (&before);
    for (int k = 1; k < threads; k++) running[k] = pthread_create (&id[k], NULL, run, &jobs[k]) == 0;
    pg_signals_release (&before);
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

/* Part k begins at n k / threads, whichever thread runs it. */
void pg_parallel_heavy (int threads, size_t n, pg_work work, void *context)
{
    if (threads > MAX_THREADS) threads = MAX_THREADS;
    if (threads < 1) threads = 1;
    if ((size_t) threads > n) threads = n > 0 ? (int) n : 1;
    job jobs[MAX_THREADS];
    for (int k = 0; k < threads; k++)
        jobs[k] = (job){ work, context, n * (size_t) k / (size_t) threads,
                         n * (size_t) (k + 1) / (size_t) threads, k };
    /* One part only: loops inside it may use other threads. */
    if (threads == 1) work (context, 0, n, 0);
    else if (inside) {
        for (int k = 0; k < threads; k++) run (&jobs[k]);
    } else if (pthread_mutex_trylock (&pool.gate) == 0) {
        run_with_helpers (threads, jobs);
        pthread_mutex_unlock (&pool.gate);
    } else run_with_own (threads, jobs);
}
