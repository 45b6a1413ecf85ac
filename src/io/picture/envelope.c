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

/* The sign of the value farthest from zero: the direction in which the test loads the body. */
static double direction_of (size_t n, const double *x)
{
    double most = 0;
    for (size_t i = 0; i < n; i++) if (fabs (x[i]) > fabs (most)) most = x[i];
    return most < 0 ? -1 : 1;
}

/* The envelope so far: m points (x, y), largest sign x (top), last state that counted (n: none yet). */
typedef struct { double *x, *y, sign, top; size_t m, last; } envelope;

/* Appends a state that goes beyond all before. Between two events all loads grow in proportion (linear),
 * so that the states lie on a line through the origin: at the displacement of one event the curve falls to
 * the line of the next. */
static void append (envelope *e, double x, double y, int fell)
{
    double line = fell ? y / x * e->x[e->m - 1] : 0;
    if (fell && fabs (line - e->y[e->m - 1]) > 1e-9 * fabs (e->y[e->m - 1]))
        e->x[e->m] = e->x[e->m - 1], e->y[e->m] = line, e->m++;
    e->x[e->m] = x, e->y[e->m] = y, e->m++;
    e->top = e->sign * x;
}

size_t pg_envelope (size_t n, const double *x, const double *y, int linear, double *ex, double *ey,
                    size_t *peak)
{
    envelope e = { .x = ex, .y = ey, .sign = direction_of (n, x), .top = linear ? 0 : -INFINITY, .last = n };
    if (linear) ex[0] = ey[0] = 0, e.m = 1;
    for (size_t i = 0; i < n; i++) {
        int fell = linear && e.last < n;
        if (!isfinite (x[i]) || !isfinite (y[i])) continue;
        if (e.sign * x[i] > e.top) append (&e, x[i], y[i], fell), e.last = i;
        else if (fell && i + 1 == n && x[i] != 0)      /* final drop to the line of the last state */
            ex[e.m] = ex[e.m - 1], ey[e.m] = y[i] / x[i] * ex[e.m - 1], e.m++;
    }
    *peak = 0;
    for (size_t k = 0; k < e.m; k++) if (fabs (ey[k]) > fabs (ey[*peak])) *peak = k;
    return e.m;
}
