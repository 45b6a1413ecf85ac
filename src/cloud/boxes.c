/* SPDX-License-Identifier: GPL-3.0-or-later
 * The boxes of boxes.h: sorting by counting, O(n); reading off what a place sees, row by row. */
#include "boxes.h"
#include <math.h>
#include <string.h>

#define INLINE static inline __attribute__ ((always_inline))

/* Boxes at most, for each point and in all: a cloud that fills its surroundings has about one for each. */
enum { BOXES_A_POINT = 16, BOXES_AT_LEAST = 4096 };

/* ---- sorting ------------------------------------------------------------------------------------------- */
/* The box that a coordinate lies in along one axis. The same expression finds boxes for points and for the
 * ends of what a place sees; it never decreases with the coordinate, so that rounding loses no point. */
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

/* Lays boxes of this width over the points, half a box beyond them, so that the layers of a lattice lie in
 * the middle of theirs. 0: they would be too many. */
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
                           const double *width, const double *reach, double all, pg_nearness near)
{
    pg_status status = PG_OK;
    size_t dim = (size_t) cloud->dim, boxes, *next = NULL;
    *out = (pg_boxes) { .dim = cloud->dim, .n = n };
    *fits = n == 0 || lay (out, cloud, list, width);
    if (n == 0 || !*fits) return PG_OK;
    boxes = out->count[0] * out->count[1] * out->count[2];
    PG_ALLOC (out->start, boxes + 1);
    PG_ALLOC (next, boxes);
    PG_ALLOC (out->item, n);
    PG_ALLOC (out->x, n * dim);
    if (reach) PG_ALLOC (out->own, n);
    for (size_t i = 0; i < n; i++) next[box_of (out, cloud->x + (size_t) list[i] * dim)]++;
    for (size_t b = 0; b < boxes; b++) {
        out->start[b + 1] = out->start[b] + next[b];
        next[b] = out->start[b];
    }
    out->limit = near.shape == PG_RADIAL ? all * all : all;
    for (size_t i = 0; i < n; i++) {
        const double *x = cloud->x + (size_t) list[i] * dim;
        size_t place = next[box_of (out, x)]++;
        double far = reach ? reach[i] : all;
        out->item[place] = list[i];
        memcpy (out->x + place * dim, x, dim * sizeof *x);
        if (reach) out->own[place] = near.shape == PG_RADIAL ? far * far : far;
        out->reach = fmax (out->reach, far * (1 + 1e-7));
    }
done:
    pg_free (next);
    if (status != PG_OK) pg_boxes_clear (out);
    return status;
}

void pg_boxes_clear (pg_boxes *b)
{
    pg_free (b->start), pg_free (b->item), pg_free (b->x), pg_free (b->own);
    memset (b, 0, sizeof *b);
}

/* ---- what a place sees --------------------------------------------------------------------------------- */
/* Distance of a coordinate from the layer of boxes `at` along an axis, m; 0 inside. A little less than it is,
 * for the borders of boxes are rounded. */
INLINE double gap (const pg_boxes *b, int axis, size_t at, double x)
{
    double step = 1 / b->inverse[axis], low = b->low[axis] + (double) at * step,
           away = x < low ? low - x : x > low + step ? x - low - step : 0;
    away -= 1e-6 * step;
    /* the outermost layers hold whatever lies beyond them */
    return away > 0 ? away : 0;
}

/* Members of one stretch of points; `far`: whether each has its own reach. */
INLINE size_t members (const pg_boxes *b, int dim, int shape, int closed, int far, const double *at,
                       size_t first, size_t last, size_t most, size_t found, int *out)
{
    for (size_t e = first; e < last && found < most; e++) {
        const double *x = b->x + e * (size_t) dim;
        double d = 0, limit = far ? b->own[e] : b->limit;
        for (int k = 0; k < dim; k++) {
            double z = fabs (x[k] - at[k]);
            d = shape == PG_RADIAL ? d + z * z : z > d ? z : d;
        }
        if (out) out[found] = b->item[e];
        found += closed ? d <= limit : d < limit;
    }
    return found;
}

/* Row after row of boxes that come within reach; of a ball each row gives the chord that it cuts. */
INLINE size_t rows (const pg_boxes *b, int dim, int shape, int closed, int far, const double *at, size_t most,
                    int *out)
{
    size_t found = 0, first[3] = { 0 }, last[3] = { 0 };
    double reach = b->reach;
    for (int k = 1; k < dim; k++)
        first[k] = box_along (b, k, at[k] - reach), last[k] = box_along (b, k, at[k] + reach);
    for (size_t z = first[2]; z <= last[2] && found < most; z++) {
        double dz = dim > 2 ? gap (b, 2, z, at[2]) : 0;
        for (size_t y = first[1]; y <= last[1] && found < most; y++) {
            double dy = dim > 1 ? gap (b, 1, y, at[1]) : 0, half = reach * reach - dy * dy - dz * dz;
            if (shape == PG_RADIAL && !(half >= 0)) continue;
            half = shape == PG_RADIAL ? sqrt (half) : reach;
            size_t row = (z * b->count[1] + y) * b->count[0], low = box_along (b, 0, at[0] - half),
                   high = box_along (b, 0, at[0] + half);
            found = members (b, dim, shape, closed, far, at, b->start[row + low], b->start[row + high + 1],
                             most, found, out);
        }
    }
    return found;
}

/* The loops for every dimension, their lengths known. */
INLINE size_t search (const pg_boxes *b, int shape, int closed, const double *at, size_t most, int *out)
{
    if (b->n == 0) return 0;
    if (b->own) return rows (b, b->dim, shape, closed, 1, at, most, out);
    if (b->dim == 3) return rows (b, 3, shape, closed, 0, at, most, out);
    if (b->dim == 2) return rows (b, 2, shape, closed, 0, at, most, out);
    return rows (b, 1, shape, closed, 0, at, most, out);
}

size_t pg_boxes_list (const pg_boxes *b, const double *at, pg_nearness near, size_t most, int *out)
{
    if (near.shape != PG_RADIAL) return search (b, PG_TENSOR, near.closed, at, most, out);
    return near.closed ? search (b, PG_RADIAL, 1, at, most, out) : search (b, PG_RADIAL, 0, at, most, out);
}

size_t pg_boxes_count (const pg_boxes *b, const double *at, pg_nearness near)
{
    return pg_boxes_list (b, at, near, b->n, NULL);
}
