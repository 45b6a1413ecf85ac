/* SPDX-License-Identifier: GPL-3.0-or-later
 * Checks of a rule of bonds, and the median over whole families, to which calibrations refer. */
#include "sums_private.h"
#include <math.h>

static const double whole_family = 0.8;                /* least volume of a whole family over the largest */

/* Refuses rules that would divide by zero or sum over the wrong dimension, before anything is summed. */
pg_status pg_sums_check_rule (const pg_sum_rule *rule, int dim)
{
    pg_status status = PG_OK;
    int wanted = rule->mode == PG_LINE ? 1 : rule->mode == PG_SOLID ? 3 : 2;
    if (wanted != dim)
        PG_FAIL (PG_E_USAGE, "bonds of a body of %d dimensions cannot have a mode of %d", dim, wanted);
    if (!(rule->horizon > 0) || !isfinite (rule->horizon))
        PG_FAIL (PG_E_USAGE, "horizon %g m of bonds must be positive", rule->horizon);
done:
    return status;
}

/* Ranks that share the points contribute the values of the points that they own. */
pg_status pg_sums_median (double *out, const pg_cloud *cloud, const double *volume, const double *value)
{
    pg_status status = PG_OK;
    double most = 0, *mine = NULL, *all = NULL;
    void *collected = NULL;
    size_t m = 0, bytes = 0;
    *out = 0;
    for (size_t i = 0; i < cloud->n; i++)
        if (pg_cloud_owns (cloud, i)) most = fmax (most, volume[i]);
    PG_TRY (pg_ranks_most (1, &most));
    PG_ALLOC (mine, cloud->n);
    for (size_t i = 0; i < cloud->n; i++)
        if (pg_cloud_owns (cloud, i) && volume[i] >= whole_family * most) mine[m++] = value[i];
    PG_TRY (pg_ranks_collect (m * sizeof *mine, mine, &bytes, &collected));
    all = collected, m = bytes / sizeof *all;
    if (m) {
        pg_sort (all, m, sizeof *all, pg_ascending_numbers);
        *out = m % 2 ? all[m / 2] : 0.5 * (all[m / 2 - 1] + all[m / 2]);
    }
    PG_TRY (pg_ranks_sum (1, out));                    /* only rank 0 has the values, the others have 0 */
done:
    pg_free (mine), pg_free (collected);
    return status;
}
