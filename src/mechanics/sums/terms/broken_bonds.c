/* SPDX-License-Identifier: GPL-3.0-or-later
 * Lists of bonds that break while they are summed: each thread has its own; they are merged in ascending
 * order. */
#include "bond_loop.h"
#include <string.h>

/* Broken bonds are appended in ascending order, in whatever order threads found them, so that the files of a
 * run do not depend on threads. */
pg_status pg_changes_append (pg_changes *to, size_t n, size_t *bond)
{
    pg_status status = PG_OK;
    if (n == 0) return PG_OK;
    pg_sort (bond, n, sizeof *bond, pg_ascending_sizes);
    PG_GROW (to->bond, to->cap, to->n + n);
    memcpy (to->bond + to->n, bond, n * sizeof *bond);
    to->n += n;
done:
    return status;
}

/* Gathers the lists of all threads in the first one, and appends that to `to`. A thread without memory has
 * left its status in `failed`: then the sums must not be used. */
pg_status pg_changes_collect (pg_changes *to, int threads, pg_changes *found, pg_status *failed)
{
    pg_status status = PG_OK;
    for (int t = 0; t < threads; t++) if (failed[t] != PG_OK) status = failed[t], failed[t] = PG_OK;
    if (status != PG_OK) PG_FAIL (status, "no memory to note the bonds that broke");
    for (int t = 1; t < threads; t++) {
        if (found[t].n == 0) continue;
        PG_GROW (found->bond, found->cap, found->n + found[t].n);
        memcpy (found->bond + found->n, found[t].bond, found[t].n * sizeof *found->bond);
        found->n += found[t].n;
    }
    PG_TRY (pg_changes_append (to, found->n, found->bond));
done:
    for (int t = 0; t < threads; t++) found[t].n = 0;
    return status;
}
