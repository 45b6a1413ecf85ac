/* SPDX-License-Identifier: GPL-3.0-or-later
 * The range of values of a picture: all finite ones, or without the few that lie far from the
 * rest. A quantile alone would always cut something; the outer values are left out only if
 * this shortens the range considerably (pg_picture_range in the header). */
#include "picture_private.h"
#include <math.h>
#include <stddef.h>

/* The value at place k of n in ascending order, 0 the first; those before it come before (Hoare's selection):
 * only the part that holds the place is ordered further, so that it costs a few passes, where sorting all
 * would cost a tenth of a picture. */
static double select_value (double *a, ptrdiff_t n, ptrdiff_t k)
{
    ptrdiff_t low = 0, high = n - 1;
    while (low < high) {
        double pivot = a[low + (high - low) / 2];
        ptrdiff_t i = low, j = high;
        while (i <= j) {
            while (a[i] < pivot) i++;
            while (a[j] > pivot) j--;
            if (i > j) break;
            double t = a[i];
            a[i++] = a[j], a[j--] = t;
        }
        if (k <= j) high = j;
        else if (k >= i) low = i;
        else break;
    }
    return a[k];
}

/* Places from both ends are counted in ascending order. */
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
    double from = select_value (finite, (ptrdiff_t) m, (ptrdiff_t) cut),
           to = select_value (finite + cut, (ptrdiff_t) (m - cut), (ptrdiff_t) (m - 1 - 2 * cut));
    if (to > from && *high - *low > excess * (to - from)) *low = from, *high = to;
done:
    pg_free (finite);
    return status;
}
