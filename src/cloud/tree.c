/* SPDX-License-Identifier: GPL-3.0-or-later
 * A balanced tree without pointers: the item in the middle of a range divides it along one axis, and the
 * axes take turns (a k-d tree). */
#include "tree.h"
#include <string.h>

/* Ranges of this length are not divided further. */
enum { LEAF = 8 };

/* Coordinate of the item at a place of the list. */
static double along (const pg_tree *t, size_t place, int axis)
{
    return t->x[t->item[place] * (size_t) t->dim + (size_t) axis];
}

static void swap (size_t *a, size_t *b)
{
    size_t c = *a;
    *a = *b, *b = c;
}

/* Quickselect: puts at `middle` the item that a sorted range first .. last - 1 would have there, smaller
 * ones before it, larger ones behind. */
static void part (pg_tree *t, size_t first, size_t last, size_t middle, int axis)
{
    while (last - first > 1) {
        double pivot = along (t, first + (last - first) / 2, axis);
        size_t less = first, more = last, i = first;
        while (i < more) {
            double v = along (t, i, axis);
            if (v < pivot) swap (&t->item[i++], &t->item[less++]);
            else if (v > pivot) swap (&t->item[i], &t->item[--more]);
            else i++;
        }
        if (middle < less) last = less;
        else if (middle >= more) first = more;
        else return;
    }
}

/* Divides a range and its two parts. */
static void halve (pg_tree *t, size_t first, size_t last, int axis)
{
    if (last - first <= LEAF) return;
    size_t middle = first + (last - first) / 2;
    part (t, first, last, middle, axis);
    halve (t, first, middle, (axis + 1) % t->dim);
    halve (t, middle + 1, last, (axis + 1) % t->dim);
}

/* O(n log n) on average; equal coordinates do no harm. */
pg_status pg_tree_build (pg_tree *out, int dim, size_t n, const double *x)
{
    pg_status status = PG_OK;
    *out = (pg_tree) { dim, n, NULL, x };
    PG_ALLOC (out->item, n);
    for (size_t i = 0; i < n; i++) out->item[i] = i;
    halve (out, 0, n, 0);
done:
    return status;
}

void pg_tree_clear (pg_tree *tree)
{
    pg_free (tree->item);
    memset (tree, 0, sizeof *tree);
}

typedef struct { const double *at; double reach; pg_tree_teller tell; void *context; } question;

/* Both parts of a range where the interval of the search reaches across the dividing item. */
static void visit (const pg_tree *t, const question *q, size_t first, size_t last, int axis)
{
    if (last - first <= LEAF) {
        for (size_t i = first; i < last; i++) q->tell (q->context, t->item[i]);
        return;
    }
    size_t middle = first + (last - first) / 2;
    double ahead = q->at[axis] - along (t, middle, axis);
    if (ahead <= q->reach) visit (t, q, first, middle, (axis + 1) % t->dim);
    if (ahead <= q->reach && ahead >= -q->reach) q->tell (q->context, t->item[middle]);
    if (ahead >= -q->reach) visit (t, q, middle + 1, last, (axis + 1) % t->dim);
}

/* Only coordinates decide here: the caller tests the distance. */
void pg_tree_near (const pg_tree *tree, const double *at, double reach, pg_tree_teller tell, void *context)
{
    question q = { at, reach, tell, context };
    visit (tree, &q, 0, tree->n, 0);
}
