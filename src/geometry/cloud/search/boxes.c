/* SPDX-License-Identifier: GPL-3.0-or-later
 * The boxes of boxes.h: sorting by counting, O(n), and finding the points near a position, row by row. */
#include "boxes.h"
#include <math.h>
#include <string.h>

#define INLINE static inline __attribute__ ((always_inline))

/* Largest number of boxes: so many for each point, and a number that is always allowed. A cloud without empty
 * space has about one box for each point. */
enum { BOXES_A_POINT = 16, BOXES_AT_LEAST = 4096 };

/* ---- sorting ------------------------------------------------------------------------------------------- */
/* The box that a coordinate lies in along one axis. The same expression finds boxes for points and for the
 * ends of a neighbourhood; it never decreases with the coordinate, so that rounding loses no point. */
INLINE size_t box_along (const pg_boxes *b, int axis, double x)
{
    double at = (x - b->low[axis]) * b->inverse[axis];
    if (!(at > 0)) return 0;
    return at >= (double) b->count[axis] ? b->count[axis] - 1 : (size_t) at;
}

/* The box of a position, x fastest. */
static size_t box_of (const pg_boxes *b, const double *x)
{
    size_t box = 0;
    for (int k = b->dim - 1; k >= 0; k--) box = box * b->count[k] + box_along (b, k, x[k]);
    return box;
}

/* Lays boxes of this width over the points, half a box beyond them, so that each layer of a lattice lies in
 * the middle of a layer of boxes. 0: there would be too many boxes. */
static int lay (pg_boxes *b, const pg_cloud *cloud, const int *list, const double *width)
{
    double boxes = 1, most = BOXES_A_POINT * (double) b->n + BOXES_AT_LEAST;
    size_t dim = (size_t) b->dim;
    for (size_t k = 0; k < 3; k++) b->count[k] = 1;
    for (size_t k = 0; k < dim; k++) {
        double low = INFINITY, high = -INFINITY;
        for (size_t i = 0; i < b->n; i++) {
            double x = cloud->x[(size_t) list[i] * dim + k];
            low = fmin (low, x), high = fmax (high, x);
        }
        if (!(width[k] > 0) || !((high - low) / width[k] < most)) return 0;
        b->low[k] = low - 0.5 * width[k], b->inverse[k] = 1 / width[k];
        b->count[k] = (size_t) ((high - low) / width[k] + 0.5) + 1;
        boxes *= (double) b->count[k];
    }
    return boxes <= most;
}

pg_status pg_boxes_create (pg_boxes *out, int *fits, const pg_cloud *cloud, size_t n, const int *list,
                           const double *width, double reach)
{
    pg_status status = PG_OK;
    size_t dim = (size_t) cloud->dim, boxes, *next = NULL;
    *out = (pg_boxes) { .dim = cloud->dim, .n = n, .reach = reach };
    *fits = n == 0 || lay (out, cloud, list, width);
    if (n == 0 || !*fits) return PG_OK;
    boxes = out->count[0] * out->count[1] * out->count[2];
    PG_ALLOC (out->start, boxes + 1);
    PG_ALLOC (next, boxes);
    PG_ALLOC (out->item, n);
    for (size_t i = 0; i < n; i++) next[box_of (out, cloud->x + (size_t) list[i] * dim)]++;
    for (size_t b = 0; b < boxes; b++) {
        out->start[b + 1] = out->start[b] + next[b];
        next[b] = out->start[b];
    }
    for (size_t i = 0; i < n; i++) {
        size_t box = box_of (out, cloud->x + (size_t) list[i] * dim);
        out->item[next[box]++] = list[i];
    }
done:
    pg_free (next);
    if (status != PG_OK) pg_boxes_clear (out);
    return status;
}

void pg_boxes_clear (pg_boxes *b)
{
    pg_free (b->start), pg_free (b->item);
    memset (b, 0, sizeof *b);
}

/* ---- points near a position ---------------------------------------------------------------------------- */
/* Distance along an axis between layer `at` of boxes and the interval low .. high, m; 0 where they meet.
 * Slightly reduced, as the borders of boxes are rounded. */
static double gap (const pg_boxes *b, int axis, size_t at, double low, double high)
{
    double step = 1 / b->inverse[axis], from = b->low[axis] + (double) at * step, to = from + step,
           away = high < from ? from - high : low > to ? low - to : 0;
    away -= 1e-6 * step;
    return away > 0 ? away : 0;
}

/* Visits row after row of boxes within reach; for balls each row is cut to the range that they can reach. */
size_t pg_boxes_near (const pg_boxes *b, const double *low, const double *high, int ball, int *item)
{
    size_t found = 0, first[3] = { 0 }, last[3] = { 0 };
    double reach = b->reach;
    if (b->n == 0) return 0;
    for (int k = 1; k < b->dim; k++)
        first[k] = box_along (b, k, low[k] - reach), last[k] = box_along (b, k, high[k] + reach);
    for (size_t z = first[2]; z <= last[2]; z++) {
        double dz = b->dim > 2 ? gap (b, 2, z, low[2], high[2]) : 0;
        for (size_t y = first[1]; y <= last[1]; y++) {
            double dy = b->dim > 1 ? gap (b, 1, y, low[1], high[1]) : 0,
                   half = reach * reach - dy * dy - dz * dz;
            if (ball && !(half >= 0)) continue;
            half = ball ? sqrt (half) : reach;
            size_t row = (z * b->count[1] + y) * b->count[0],
                   from = b->start[row + box_along (b, 0, low[0] - half)],
                   to = b->start[row + box_along (b, 0, high[0] + half) + 1];
            if (item) for (size_t e = from; e < to; e++) item[found + e - from] = b->item[e];
            found += to - from;
        }
    }
    return found;
}
