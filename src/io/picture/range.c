/* SPDX-License-Identifier: GPL-3.0-or-later
 * The range of values of a picture: all finite ones, or without the few that lie far from the
 * rest. A quantile alone would always cut something; the outer values are left out only if
 * this shortens the range considerably (pg_picture_range in the header). */
#include "picture_private.h"
#include <math.h>

/* The values are sorted, and as many are left out at the lower as at the upper end. */
pg_status pg_picture_range (size_t n, const double *value, double excess, double *low, double *high,
                            int *found)
{
    pg_status status = PG_OK;
    double *finite = NULL;
    size_t m = 0;
    *found = pg_range_of (n, value, 0, low, high);
    if (!*found || !(excess > 0)) goto done;
    PG_ALLOC (finite, n);
    for (size_t i = 0; i < n; i++) if (isfinite (value[i])) finite[m++] = value[i];
    size_t cut = m / 100 ? m / 100 : m >= 50;
    pg_sort (finite, m, sizeof *finite, pg_ascending_numbers);
    double from = finite[cut], to = finite[m - 1 - cut];
    if (to > from && *high - *low > excess * (to - from)) *low = from, *high = to;
done:
    pg_free (finite);
    return status;
}
