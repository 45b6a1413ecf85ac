/* SPDX-License-Identifier: GPL-3.0-or-later
 * How the system hands out memory. A run takes and returns large arrays all the time; by default glibc takes
 * each from the system anew, which clears it page by page: up to 40 % of a short run. Kept in the process,
 * and in large pages where the system grants them on request (transparent huge pages: madvise), pages are
 * cleared once. Results do not depend on it. With other systems these functions do little or nothing. */
#define _DEFAULT_SOURCE                                /* madvise, sbrk */
#include "perigal/base.h"
#include <stdatomic.h>
#include <stdint.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <unistd.h>
#if defined (__GLIBC__)
#include <malloc.h>
#endif

/* Bytes by which the heap grows; bytes of a large page; the smallest block that asks for such pages. */
enum { HEAP_STEP = 64 << 20, PAGE = 1 << 21, LARGE = 1 << 16 };

/* Addresses, first and end, for which large pages were requested last: blocks between them do not ask again.
 * A thread may see the ends of two different requests: then it asks once too often, or pages stay small. */
static atomic_uintptr_t asked[2];

/* Blocks up to 1 GiB come from the heap, and the heap is not returned to the system. It grows by 64 MiB at a
 * time, and the first of these, where the small blocks of a run lie, are asked for in large pages: a page is
 * given when it is touched first, and a large one costs as much as ten of its small ones. */
void pg_memory_keep (void)
{
#if defined (__GLIBC__)
    mallopt (M_MMAP_THRESHOLD, 1 << 30);
    mallopt (M_TRIM_THRESHOLD, 1 << 30);
    mallopt (M_TOP_PAD, HEAP_STEP);
    void *first = malloc (1);
    if (first) pg_memory_large (first, HEAP_STEP);
    free (first);
#endif
}

/* The request covers all large pages that the block touches, and the heap behind the block, where small
 * blocks will lie. A heap that has grown since is asked for again. Whether the system grants large pages is
 * not checked, as nothing depends on it. */
void pg_memory_large (void *block, size_t bytes)
{
#if defined (MADV_HUGEPAGE)
    if (bytes < LARGE) return;
    const uintptr_t at = (uintptr_t) block, page = PAGE, top = (uintptr_t) sbrk (0);
    uintptr_t first = at & ~(page - 1), end = at + bytes;
    if (at >= atomic_load (&asked[0]) && end <= atomic_load (&asked[1])) return;
    /* the rest of the heap, which mostly is what it has just grown by */
    if (at < top && top - at < bytes + 2 * (uintptr_t) HEAP_STEP) end = top;
    atomic_store (&asked[0], first), atomic_store (&asked[1], end);
    (void) madvise ((void *) first, ((end + 4095) & ~(uintptr_t) 4095) - first, MADV_HUGEPAGE);
#else
    (void) block, (void) bytes;
#endif
}

void *pg_memory_malloc (size_t bytes)
{
    void *block = malloc (bytes);
    if (block) pg_memory_large (block, bytes);
    return block;
}

void *pg_memory_calloc (size_t n, size_t size)
{
    void *block = calloc (n, size);
    if (block) pg_memory_large (block, n * size);
    return block;
}

void *pg_memory_realloc (void *block, size_t bytes)
{
    void *moved = realloc (block, bytes);
    if (moved) pg_memory_large (moved, bytes);
    return moved;
}
