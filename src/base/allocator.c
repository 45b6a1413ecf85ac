/* SPDX-License-Identifier: GPL-3.0-or-later
 * How glibc hands out memory. A run takes and returns large arrays all the time; by default glibc takes
 * each from the system anew, which clears it page by page: up to 40 % of a short run. Kept in the process,
 * and in large pages where the system grants them on request (transparent huge pages: madvise), pages are
 * cleared once. Results do not depend on it. With other C libraries these functions do little or nothing. */
#include "perigal/base.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
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

/* glibc reads GLIBC_TUNABLES when a program starts, so that this acts on programs started later. A setting
 * of the user's own is left alone. */
void pg_memory_large_pages (void)
{
    static const char large[] = "glibc.malloc.hugetlb=1";
    const char *given = getenv ("GLIBC_TUNABLES");
    char all[1024];
    if (given && (strstr (given, "glibc.malloc.hugetlb") || strlen (given) > 900)) return;
    snprintf (all, sizeof all, "%s%s%s", given ? given : "", given && *given ? ":" : "", large);
    setenv ("GLIBC_TUNABLES", all, 1);
}
