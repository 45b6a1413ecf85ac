/* SPDX-License-Identifier: GPL-3.0-or-later
 * The k-d tree of tree.h: sorting by quickselect, O(n log n); searches that skip the half of a range that its
 * dividing point shows to be out of reach. */
#include "tree.h"
#include <math.h>
#include <string.h>

/* ---- sorting ------------------------------------------------------------------------------------------- */
/* What is sorted: points x (n x dim) and their numbers together, so that a range under work is one block
 * of memory. */
typedef struct { size_t *item; double *x; size_t dim; } sorter;

/* Coordinate along an axis of the point at a position of the sorted order. */
static double along (const sorter *s, size_t place, size_t axis) { return s->x[place * s->dim + axis]; }

static void swap (const sorter *s, size_t a, size_t b)
{
    size_t item = s->item[a];
    s->item[a] = s->item[b], s->item[b] = item;
    for (size_t k = 0; k < s->dim; k++) {
        double x = s->x[a * s->dim + k];
        s->x[a * s->dim + k] = s->x[b * s->dim + k], s->x[b * s->dim + k] = x;
    }
}

/* Quickselect: puts at `middle` the item that a sorted range first .. last - 1 would have there, smaller
 * ones before it, larger ones behind. Items equal to the pivot are collected in the middle, so that many
 * equal coordinates do not slow it down. */
static void part (sorter *s, size_t first, size_t last, size_t middle, size_t axis)
{
    while (last - first > 1) {
        double pivot = along (s, first + (last - first) / 2, axis);
        size_t less = first, more = last, i = first;
        while (i < more) {
            double v = along (s, i, axis);
            if (v < pivot) swap (s, i++, less++);
            else if (v > pivot) swap (s, i, --more);
            else i++;
        }
        if (middle < less) last = less;
        else if (middle >= more) first = more;
        else return;
    }
}

/* Divides a range by its middle item along one axis, then both parts along the next. */
static void halve (sorter *s, size_t first, size_t last, size_t axis)
{
    if (last - first <= PG_TREE_LEAF) return;
    size_t middle = first + (last - first) / 2, next = (axis + 1) % s->dim;
    part (s, first, last, middle, axis);
    halve (s, first, middle, next);
    halve (s, middle + 1, last, next);
}

pg_status pg_tree_build (pg_tree *out, int dim, size_t n, const double *x)
{
    pg_status status = PG_OK;
    size_t d = (size_t) dim;
    *out = (pg_tree) { .dim = dim, .n = n };
    PG_ALLOC (out->item, n);
    PG_ALLOC (out->x, n * d);
    for (size_t i = 0; i < n; i++) out->item[i] = i;
    if (n > 0) memcpy (out->x, x, n * d * sizeof *x);   /* without points there may be no array */
    halve (&(sorter) { out->item, out->x, d }, 0, n, 0);
done:
    if (status != PG_OK) pg_tree_clear (out);
    return status;
}

void pg_tree_clear (pg_tree *tree)
{
    pg_free (tree->item), pg_free (tree->x);
    memset (tree, 0, sizeof *tree);
}

/* ---- all points near a position ------------------------------------------------------------------------ */
/* State of a search for all points near a position. */
typedef struct { const double *at; double reach; pg_tree_visit visit; void *context; } vicinity;

/* Visits the points of a range that may be within reach. A part of the range is skipped where the dividing
 * point is farther than `reach` on its other side. */
static void visit_near (const pg_tree *t, const vicinity *v, size_t first, size_t last, int axis)
{
    if (last - first <= PG_TREE_LEAF) {
        v->visit (v->context, first, last);
        return;
    }
    size_t middle = first + (last - first) / 2;
    int next = axis + 1 == t->dim ? 0 : axis + 1;
    double ahead = v->at[axis] - t->x[middle * (size_t) t->dim + (size_t) axis];
    if (ahead <= v->reach) visit_near (t, v, first, middle, next);
    if (ahead <= v->reach && ahead >= -v->reach) v->visit (v->context, middle, middle + 1);
    if (ahead >= -v->reach) visit_near (t, v, middle + 1, last, next);
}

void pg_tree_near (const pg_tree *tree, const double *at, double reach, pg_tree_visit visit, void *context)
{
    vicinity v = { at, reach, visit, context };
    visit_near (tree, &v, 0, tree->n, 0);
}

/* ---- the nearest point --------------------------------------------------------------------------------- */
/* State of a search for the nearest point. */
typedef struct {
    const double *at;
    pg_tree_refuse refuse;  void *context;
    /* Number of the nearest so far, -1: none. */
    long   found;
    /* Square of the distance of that point, m^2. */
    double best;
} query;

/* Compares the points of a range with the nearest so far. A point is offered for refusal only if it would
 * win. */
static void consider (const pg_tree *t, query *q, size_t first, size_t last)
{
    for (size_t e = first; e < last; e++) {
        const double *x = t->x + e * (size_t) t->dim;
        long item = (long) t->item[e];
        double d = 0;
        for (int k = 0; k < t->dim; k++) d += (x[k] - q->at[k]) * (x[k] - q->at[k]);
        if (!(d < q->best || (d == q->best && item < q->found))) continue;
        if (q->refuse && q->refuse (q->context, q->at, (size_t) item)) continue;
        q->best = d, q->found = item;
    }
}

/* Searches the half that holds the position first; the other one only where the plane between them is no
 * farther than the nearest point so far. The margin keeps points that are equally near but for rounding. */
static void visit_nearest (const pg_tree *t, query *q, size_t first, size_t last, int axis)
{
    if (last - first <= PG_TREE_LEAF) {
        consider (t, q, first, last);
        return;
    }
    size_t middle = first + (last - first) / 2;
    int next = axis + 1 == t->dim ? 0 : axis + 1;
    double ahead = q->at[axis] - t->x[middle * (size_t) t->dim + (size_t) axis];
    if (ahead < 0) visit_nearest (t, q, first, middle, next);
    else visit_nearest (t, q, middle + 1, last, next);
    if (ahead * ahead > q->best * (1 + 1e-12)) return;
    consider (t, q, middle, middle + 1);
    if (ahead < 0) visit_nearest (t, q, middle + 1, last, next);
    else visit_nearest (t, q, first, middle, next);
}

/* The test `refuse` may be expensive (is a crack between?), and where all points of the half that holds the
 * position are refused, every one of them would be tested before the other half: the search goes out in rings
 * from the nearest point of all, each 3 times as wide. */
long pg_tree_nearest (const pg_tree *tree, const double *at, pg_tree_refuse refuse, void *context,
                      double *away)
{
    enum { RINGS = 10 };
    query all = { at, NULL, NULL, -1, INFINITY };
    visit_nearest (tree, &all, 0, tree->n, 0);
    if (away) *away = sqrt (all.best);
    if (!refuse || all.found < 0 || !refuse (context, at, (size_t) all.found)) return all.found;
    double square = all.best;
    query q = { at, refuse, context, -1, INFINITY };
    for (int ring = 0; ring < RINGS && square > 0 && q.found < 0; ring++) {
        q.best = square *= 9;
        visit_nearest (tree, &q, 0, tree->n, 0);
    }
    if (q.found < 0) q.best = INFINITY, visit_nearest (tree, &q, 0, tree->n, 0);
    if (away) *away = sqrt (q.best);
    return q.found;
}
