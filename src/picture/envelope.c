/* SPDX-License-Identifier: GPL-3.0-or-later
 * The envelope of an equilibrium path that is driven event by event: what a test with steadily
 * rising displacement would show of it. Event stepping follows snap-back, where displacement
 * and force both fall; a testing machine that moves only forwards jumps over that part at
 * constant displacement.
 *
 *   a state i counts if        sign x_i > max over earlier states of sign x
 *   between two events         y = (y_i / x_i) x, a line through the origin (proportional loads)
 *
 * The header has the exact definition of what is returned. */
#include "perigal/picture.h"
#include <math.h>

/* The sign of the value farthest from zero: the way in which the test pulls. */
static double direction_of (size_t n, const double *x)
{
    double most = 0;
    for (size_t i = 0; i < n; i++) if (fabs (x[i]) > fabs (most)) most = x[i];
    return most < 0 ? -1 : 1;
}

/* Between two events all loads grow in proportion (linear = 1), so that the states lie on a line through
 * the origin: at the displacement of one event the curve falls to the line of the next state that counts. */
size_t pg_envelope (size_t n, const double *x, const double *y, int linear, double *ex, double *ey,
                    size_t *peak)
{
    double sign = direction_of (n, x), top = linear ? 0 : -INFINITY;
    size_t m = 0, last = n;
    if (linear) ex[0] = ey[0] = 0, m = 1;
    for (size_t i = 0; i < n; i++) {
        int fell = linear && last < n;
        if (!isfinite (x[i]) || !isfinite (y[i])) continue;
        if (sign * x[i] > top) {
            double line = fell ? y[i] / x[i] * ex[m - 1] : 0;
            if (fell && fabs (line - ey[m - 1]) > 1e-9 * fabs (ey[m - 1]))
                ex[m] = ex[m - 1], ey[m] = line, m++;
            ex[m] = x[i], ey[m] = y[i], m++;
            top = sign * x[i], last = i;
        } else if (fell && i + 1 == n && x[i] != 0) ex[m] = ex[m - 1], ey[m] = y[i] / x[i] * ex[m - 1], m++;
    }
    *peak = 0;
    for (size_t k = 0; k < m; k++) if (fabs (ey[k]) > fabs (ey[*peak])) *peak = k;
    return m;
}
