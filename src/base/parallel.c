/* SPDX-License-Identifier: GPL-3.0-or-later
 * A clock and a parallel loop over disjoint ranges (plain threads: the OpenMP limit that CHOLMOD needs does not bind them). */
#include "perigal/base.h"
#include <pthread.h>
#include <time.h>

enum { MAX_THREADS = 64 };

typedef struct { pg_work work; void *context; size_t first, last; int thread; } job;

double pg_seconds (void)
{
    struct timespec t;
    clock_gettime (CLOCK_MONOTONIC, &t);
    return (double) t.tv_sec + 1e-9 * (double) t.tv_nsec;
}

static void *run (void *p)
{
    job *j = p;
    j->work (j->context, j->first, j->last, j->thread);
    return NULL;
}

void pg_parallel (int threads, size_t n, pg_work work, void *context) { pg_parallel_heavy (n < 64 ? 1 : threads, n, work, context); }

void pg_parallel_heavy (int threads, size_t n, pg_work work, void *context)
{
    if (threads > MAX_THREADS) threads = MAX_THREADS;
    if (threads < 1) threads = 1;
    if ((size_t) threads > n) threads = n > 0 ? (int) n : 1;
    job jobs[MAX_THREADS];
    pthread_t id[MAX_THREADS];
    int started[MAX_THREADS] = { 0 };
    for (int k = 0; k < threads; k++)
        jobs[k] = (job) { work, context, n * (size_t) k / (size_t) threads, n * (size_t) (k + 1) / (size_t) threads, k };
    for (int k = 1; k < threads; k++) started[k] = pthread_create (&id[k], NULL, run, &jobs[k]) == 0;
    run (&jobs[0]);
    for (int k = 1; k < threads; k++) {
        if (started[k]) pthread_join (id[k], NULL);
        else run (&jobs[k]);
    }
}
