/* SPDX-License-Identifier: GPL-3.0-or-later
 * The only file that calls malloc: blocks that are zero-filled, counted and checked for overflow, and a
 * switch for tests that makes one allocation fail. Counters are atomic, as threads allocate too. */
#include "perigal/base.h"
#include <stdatomic.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

/* Bytes in front of each block that hold its size; 64, so that the block keeps the alignment. */
#define HEAD 64

/* Counters of the whole process. */
static struct {
    atomic_size_t used, peak;                          /* bytes held now, and at most so far */
    atomic_size_t calls;                               /* allocations so far */
    atomic_size_t fail_at;                             /* the k-th from now fails; 0: none */
} memory;

/* Counts an allocation; 1 if it is the one that is to fail. */
static int must_fail (void)
{
    atomic_fetch_add (&memory.calls, 1);
    size_t k = atomic_load (&memory.fail_at);
    if (k == 0) return 0;
    return atomic_fetch_sub (&memory.fail_at, 1) == 1;
}

/* Updates the bytes held and their maximum. */
static void count (size_t add, size_t drop)
{
    size_t now = atomic_fetch_add (&memory.used, add - drop) + add - drop, top = atomic_load (&memory.peak);
    while (now > top && !atomic_compare_exchange_weak (&memory.peak, &top, now)) continue;
}

/* A block with its size written in front, not cleared; NULL: overflow or no memory. */
static char *fresh (size_t bytes)
{
    size_t whole = (bytes + HEAD + 63) / 64 * 64;
    char *block = whole < bytes ? NULL : aligned_alloc (64, whole);
    if (!block) return NULL;
    pg_memory_large (block, whole);
    memcpy (block, &bytes, sizeof bytes);
    return block;
}

/* Sizes above half of the address space are refused before they can wrap around. */
void *pg_calloc (size_t n, size_t size)
{
    if (n == 0) n = 1;
    if (must_fail () || (size && n > (SIZE_MAX / 2) / size)) return NULL;
    char *block = fresh (n * size);
    if (!block) return NULL;
    memset (block + HEAD, 0, n * size);
    count (n * size, 0);
    return block + HEAD;
}

/* Allocates anew and copies, so that the old block is untouched on failure and the new part is zero. */
void *pg_resize (void *p, size_t n, size_t size)
{
    if (!p) return pg_calloc (n, size);
    if (n == 0) n = 1;
    if (must_fail () || (size && n > (SIZE_MAX / 2) / size)) return NULL;
    size_t old;
    memcpy (&old, (char *) p - HEAD, sizeof old);
    char *block = fresh (n * size);
    if (!block) return NULL;
    size_t keep = old < n * size ? old : n * size;
    memcpy (block + HEAD, p, keep);
    memset (block + HEAD + keep, 0, n * size - keep);
    count (n * size, old);
    free ((char *) p - HEAD);
    return block + HEAD;
}

/* The size of the block stands in front of it. */
void pg_free (void *p)
{
    if (!p) return;
    size_t old;
    memcpy (&old, (char *) p - HEAD, sizeof old);
    count (0, old);
    free ((char *) p - HEAD);
}

char *pg_strdup (const char *text)
{
    size_t n = strlen (text) + 1;
    char *copy = pg_calloc (n, 1);
    if (copy) memcpy (copy, text, n);
    return copy;
}

size_t pg_memory_used (void)  { return atomic_load (&memory.used); }
size_t pg_memory_peak (void)  { return atomic_load (&memory.peak); }
size_t pg_memory_calls (void) { return atomic_load (&memory.calls); }
void pg_memory_fail_at (size_t k) { atomic_store (&memory.fail_at, k); }

size_t pg_memory_process_peak (void)
{
    struct rusage usage;
    if (getrusage (RUSAGE_SELF, &usage) != 0) return 0;
    return (size_t) usage.ru_maxrss * 1024;
}
