/* SPDX-License-Identifier: GPL-3.0-or-later
 * forked.h: several processes that are ranks of one run, without MPI: they share a page of memory and wait
 * for each other at a barrier. A rank that waits longer than ten seconds for the others ends as one that
 * failed. */
#ifndef PERIGAL_TEST_FORKED_H
#define PERIGAL_TEST_FORKED_H
#include "check.h"
#include "perigal/ranks.h"
#include <pthread.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

enum { MOST_RANKS = 6, ROOM = 4096 };
typedef struct {
    pthread_barrier_t barrier;
    size_t n[MOST_RANKS];
    double value[MOST_RANKS][ROOM];
    double halo[MOST_RANKS][MOST_RANKS][ROOM / 8];     /* from, to */
} forked_memory;
typedef struct { pg_ranks ranks; forked_memory *memory; } forked_rank;

static void forked_wait (const forked_rank *r) { pthread_barrier_wait (&r->memory->barrier); }

/* Each puts its numbers where all can read them; nobody writes again before all have read. */
static void forked_put (const forked_rank *r, size_t n, const double *value)
{
    if (n > ROOM) abort ();
    if (n) memcpy (r->memory->value[r->ranks.rank], value, n * sizeof *value);
    r->memory->n[r->ranks.rank] = n;
    forked_wait (r);
}

static pg_status forked_sum (void *context, size_t n, double *value)
{
    const forked_rank *r = context;
    forked_put (r, n, value);
    for (size_t k = 0; k < n; k++) {
        value[k] = 0;
        for (int i = 0; i < r->ranks.size; i++) value[k] += r->memory->value[i][k];
    }
    forked_wait (r);
    return PG_OK;
}

static pg_status forked_most (void *context, size_t n, double *value)
{
    const forked_rank *r = context;
    forked_put (r, n, value);
    for (size_t k = 0; k < n; k++)
        for (int i = 0; i < r->ranks.size; i++) value[k] = fmax (value[k], r->memory->value[i][k]);
    forked_wait (r);
    return PG_OK;
}

static pg_status forked_exchange (void *context, const pg_halo *h, size_t components, double *value)
{
    const forked_rank *r = context;
    for (size_t k = 0; k < h->n; k++)
        for (size_t i = h->send_first[k]; i < h->send_first[k + 1]; i++)
            memcpy (r->memory->halo[r->ranks.rank][h->rank[k]] + (i - h->send_first[k]) * components,
                    value + (size_t) h->send[i] * components, components * sizeof *value);
    forked_wait (r);
    for (size_t k = 0; k < h->n; k++)
        for (size_t i = h->receive_first[k]; i < h->receive_first[k + 1]; i++)
            memcpy (value + (size_t) h->receive[i] * components,
                    r->memory->halo[h->rank[k]][r->ranks.rank] + (i - h->receive_first[k]) * components,
                    components * sizeof *value);
    forked_wait (r);
    return PG_OK;
}

static pg_status forked_share (void *context, size_t n, const double *mine, size_t *n_all, double **all)
{
    const forked_rank *r = context;
    pg_status status = PG_OK;
    forked_put (r, n, mine);
    *n_all = 0;
    for (int i = 0; i < r->ranks.size; i++) *n_all += r->memory->n[i];
    PG_ALLOC (*all, *n_all);
    for (size_t i = 0, at = 0; i < (size_t) r->ranks.size; at += r->memory->n[i], i++)
        memcpy (*all + at, r->memory->value[i], r->memory->n[i] * sizeof **all);
    forked_wait (r);
done:
    return status;
}

/* Runs a function in so many processes, each of them a rank; it returns 0 where all is well. How many did. */
static int forked (int size, int (*run) (void))
{
    FILE *file = tmpfile ();                           /* memory that all share */
    assert_true (file && ftruncate (fileno (file), sizeof (forked_memory)) == 0);
    forked_memory *memory = mmap (NULL, sizeof *memory, PROT_READ | PROT_WRITE, MAP_SHARED, fileno (file), 0);
    pthread_barrierattr_t shared;
    pid_t child[MOST_RANKS];
    int well = 0;
    assert_true (memory != MAP_FAILED && size <= MOST_RANKS);
    pthread_barrierattr_init (&shared);
    pthread_barrierattr_setpshared (&shared, PTHREAD_PROCESS_SHARED);
    pthread_barrier_init (&memory->barrier, &shared, (unsigned) size);
    fflush (NULL);
    for (int i = 0; i < size; i++) {
        if ((child[i] = fork ()) != 0) continue;
        forked_rank own = { { .rank = i, .size = size, .sum = forked_sum, .most = forked_most,
                              .exchange = forked_exchange, .share = forked_share }, memory };
        own.ranks.context = &own;
        alarm (10);
        pg_ranks_join (&own.ranks);
        int bad = run ();
        fflush (NULL);
        _exit (bad);
    }
    for (int i = 0, how; i < size; i++)
        well += child[i] > 0 && waitpid (child[i], &how, 0) == child[i] && WIFEXITED (how)
                && WEXITSTATUS (how) == 0;
    munmap (memory, sizeof *memory);
    fclose (file);
    return well;
}

/* In a rank: what must be true. */
#define SEE(what) do { \
        if (what) break; \
        print_error ("rank %d: %s:%d: not so: %s\n", pg_rank (), __FILE__, __LINE__, #what); \
        return 1; \
    } while (0)
#endif
