/* SPDX-License-Identifier: GPL-3.0-or-later
 * How the system hands out memory. A run takes and returns large arrays all the time; by default glibc takes
 * each from the system anew, which clears it page by page: up to 40 % of a short run. Kept in the process,
 * and in large pages where the system grants them on request (transparent huge pages: madvise), pages are
 * cleared once. Results do not depend on it. With other systems these functions do little or nothing. */
#define _DEFAULT_SOURCE                                /* madvise */
#include "perigal/base.h"
#include <stdint.h>
#include <stdlib.h>
#include <sys/mman.h>
#if defined (__GLIBC__)
#include <malloc.h>
#endif

/* Blocks up to 1 GiB come from the heap, and the heap is not returned to the system. */
void pg_memory_keep (void)
{
#if defined (__GLIBC__)
    mallopt (M_MMAP_THRESHOLD, 1 << 30);
    mallopt (M_TRIM_THRESHOLD, 1 << 30);
#endif
}

/* The request covers all large pages that the block touches: those at its ends hold small blocks of the heap
 * besides, which profit too. A part that is not mapped makes madvise report a fault, but it has then done the
 * rest; whether pages are granted is the system's affair, so that the answer is not looked at. */
void pg_memory_large (void *block, size_t bytes)
{
#if defined (MADV_HUGEPAGE)
    const uintptr_t page = (uintptr_t) 1 << 21, first = (uintptr_t) block & ~(page - 1),
                    end = ((uintptr_t) block + bytes + page - 1) & ~(page - 1);
    /* Smaller ones would not be worth a call of the system. */
    if (bytes >= page / 2) (void) madvise ((void *) first, end - first, MADV_HUGEPAGE);
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
