/* SPDX-License-Identifier: GPL-3.0-or-later
 * Partial volumes: the share of a neighbour's cell that lies inside the horizon (method.partial_volume;
 * theory A2). `none` and `linear` follow from the distance of the points alone. `overlap` is the intersection
 * of a box with a ball around the origin: length and area in closed form, volume by Gauss points over slices
 * between the positions where an edge enters or leaves the ball. A box that contains coordinate planes is
 * folded into the first octant before, so that its nearest and farthest points are corners. Means of a kernel
 * over the intersection follow from the volumes V (rho) of the intersections with all smaller balls: int k dV
 * = -int k' V d rho for k (1) = 0. */
#include "partial_volume.h"
#include "sums_private.h"
#include <math.h>
#include <string.h>

enum { POINTS = 16 };
static const double place[POINTS / 2] = { 0.0950125098376374, 0.2816035507792589, 0.4580167776572274,
                                          0.6178762444026438, 0.7554044083550030, 0.8656312023878318,
                                          0.9445750230732326, 0.9894009349916499 };
static const double weight[POINTS / 2] = { 0.1894506104550685, 0.1826034150449236, 0.1691565193950025,
                                           0.1495959888165767, 0.1246289712555339, 0.0951585116824928,
                                           0.0622535239386479, 0.0271524594117541 };

/* beta by the distance r (m) alone: 1 up to the horizon (none), or falling from 1 to 0 over the width of a
 * cell around it (linear); values as small as rounding become 0. */
double pg_sums_partial (pg_partial partial, double r, double horizon, double width)
{
    if (partial == PG_PARTIAL_NONE) return r <= horizon * (1 + 1e-9);
    double beta = (horizon - r) / width + 0.5;
    return beta >= 1 ? 1 : beta > PG_NO_LENGTH ? beta : 0;
}

/* ---- intersection of a box and a ball ------------------------------------------------------------------ */
typedef struct { int dim; double low[3], high[3]; } box;          /* in the first octant: 0 <= low < high */

/* Sets *x to point g of a quadrature rule on [a, b] that has more points near both ends, where integrands may
 * behave as a power of 3/2; returns its weight. */
static double rule_at (int g, double a, double b, double *x)
{
    int k = g < POINTS / 2 ? g : g - POINTS / 2;
    double t = 0.5 * (1 + (g < POINTS / 2 ? -place[k] : place[k]));
    *x = a + (b - a) * t * t * (3 - 2 * t);
    return 0.5 * weight[k] * 6 * t * (1 - t) * (b - a);
}

static double square (double x) { return x * x; }

/* Antiderivative of sqrt (R^2 - x^2) */
static double arc (double R, double x)
{
    double c = R * R - x * x;
    return 0.5 * (x * sqrt (c > 0 ? c : 0) + R * R * asin (fmin (1, x / R)));
}

/* Area of the intersection of a rectangle in the first quadrant with the disk of radius R: full height up to
 * where the circle crosses the top edge, the arc from there on. */
static double area (const double *low, const double *high, double R)
{
    if (square (low[0]) + square (low[1]) >= R * R) return 0;
    if (square (high[0]) + square (high[1]) <= R * R) return (high[0] - low[0]) * (high[1] - low[1]);
    /* up to here the top edge is inside */
    double full = high[1] < R ? sqrt ((R - high[1]) * (R + high[1])) : 0;
    double last = fmin (high[0], sqrt ((R - low[1]) * (R + low[1])));  /* beyond it, all is outside */
    double a = fmin (fmax (low[0], full), last), sum = (a - low[0]) * (high[1] - low[1]);
    return sum + arc (R, last) - arc (R, a) - (last - a) * low[1];
}

/* Inserts x into n ascending numbers; returns n + 1. */
static int insert (double *list, int n, double x)
{
    int k = n;
    for (; k > 0 && list[k - 1] > x; k--) list[k] = list[k - 1];
    list[k] = x;
    return n + 1;
}

/* Volume of the intersection of a box in the first octant with the ball of radius R: areas of slices along
 * the first axis, by Gauss points between the positions where one of the four edges enters or leaves the
 * ball, where the area has a kink. */
static double volume (const box *b, double R)
{
    double low2 = 0, kink[6], sum = 0;
    int n = 0;
    for (int k = 0; k < 3; k++) low2 += square (b->low[k]);
    if (low2 >= R * R) return 0;
    /* rounding may carry the end of the slices beyond the ball */
    double first = b->low[0], last = fmin (fmin (b->high[0], R), sqrt (R * R - low2 + square (b->low[0])));
    n = insert (kink, n, first);
    n = insert (kink, n, last);
    for (int c = 0; c < 4; c++) {
        double d = R * R - square (c & 1 ? b->high[1] : b->low[1]) - square (c & 2 ? b->high[2] : b->low[2]);
        double x = d > 0 ? sqrt (d) : 0;
        if (x > first && x < last) n = insert (kink, n, x);
    }
    for (int k = 0; k + 1 < n; k++)
        for (int g = 0; g < POINTS; g++) {
            double x, w = rule_at (g, kink[k], kink[k + 1], &x);
            sum += w * area (b->low + 1, b->high + 1, sqrt ((R - x) * (R + x)));
        }
    return sum;
}

/* Length, area or volume of the intersection of a box with the ball of radius R around the origin. */
static double common (const box *b, double R)
{
    if (b->dim == 1) return fmax (0, fmin (b->high[0], R) - b->low[0]);
    return b->dim == 2 ? area (b->low, b->high, R) : volume (b, R);
}

/* Makes b, the cell at offset n folded into the first octant; returns its volume (of the folded part).
 * nearest, farthest: distances of its corners. */
static double fold (box *b, int dim, const int *n, const double *step, double *nearest, double *farthest)
{
    double size = 1, least = 0, most = 0;
    b->dim = dim;
    for (int k = 0; k < dim; k++) {
        b->low[k]  = n[k] ? (n[k] - 0.5) * step[k] : 0;
        b->high[k] = (n[k] + 0.5) * step[k];
        size *= b->high[k] - b->low[k];
        least += square (b->low[k]), most += square (b->high[k]);
    }
    *nearest = sqrt (least), *farthest = sqrt (most);
    return size;
}

/* Share of the cell at offset n (whole steps) within the ball of the horizon, 0 to 1. */
double pg_sums_overlap (int dim, const int *n, const double *step, double radius)
{
    box b;
    double nearest, farthest, size = fold (&b, dim, n, step, &nearest, &farthest);
    if (nearest >= radius) return 0;
    if (farthest <= radius) return 1;
    return fmin (1, common (&b, radius) / size);
}

/* Integral of the kernel over the part of the cell in the ball, over the volume of the cell: -int k' V d rho
 * / cell, piecewise between the radii at which corners enter. */
double pg_sums_overlap_mean (int dim, const int *n, const double *step, double radius,
                             const pg_kernel *kernel)
{
    box b;
    double nearest, farthest, size = fold (&b, dim, n, step, &nearest, &farthest), kink[11], sum = 0;
    int count = 0;
    if (nearest >= radius) return 0;
    count = insert (kink, count, nearest);
    count = insert (kink, count, radius);
    if (radius / 2 > nearest) count = insert (kink, count, radius / 2);          /* spline kernels: a knot */
    for (int c = 1; c < 1 << dim; c++) {
        double d = 0;
        for (int k = 0; k < dim; k++) d += square (c >> k & 1 ? b.high[k] : b.low[k]);
        if (d < radius * radius) count = insert (kink, count, sqrt (d));
    }
    for (int i = 0; i + 1 < count; i++)
        for (int g = 0; g < POINTS; g++) {
            double rho, w = rule_at (g, kink[i], kink[i + 1], &rho), q = rho / radius, k, slope;
            if (!(w > 0)) continue;
            kernel->value (1, &q, &k, &slope);
            sum -= w * slope / radius * (rho >= farthest ? size : common (&b, rho));
        }
    return sum / size;
}
