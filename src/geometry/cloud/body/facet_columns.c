/* SPDX-License-Identifier: GPL-3.0-or-later
 * Rays along the axes through a surface of flat pieces. Projected along an axis the pieces lie in columns as
 * wide as the cells of a lattice; a ray tests those of one column.
 *
 * A point is inside where the sum over the pieces above it is positive: a piece through which the ray leaves
 * the shape counts +1, one through which it enters -1, so that meshes may overlap or touch without sharing
 * nodes. A ray so near to an edge that its side is uncertain gives no answer; the next axis is tried then. */
#include "shape.h"
#include "solid.h"
#include <math.h>
#include <string.h>

/* A ray nearer to an edge than this share of the piece gives no answer. */
static const double edge_on = 1e-10;

/* ---- columns ------------------------------------------------------------------------------------------- */
/* The axes other than `axis`: the first *p, in 3D also the second *q (else the same). */
static void across (int dim, int axis, int *p, int *q)
{
    *p = (axis + 1) % dim, *q = dim > 2 ? (axis + 2) % dim : *p;
}

/* Number of the column at cells a, b along the other two axes. */
static size_t column_at (const pg_facets *f, int axis, int a, int b)
{
    int p, q;
    across (f->dim, axis, &p, &q);
    return f->dim > 2 ? (size_t) b * (size_t) f->lattice.count[p] + (size_t) a : (size_t) a;
}

/* The cells from *first to *last of the lattice along k that lie within low .. high. */
static void range (const pg_lattice *l, int k, double low, double high, int *first, int *last)
{
    double a = floor ((low - l->origin[k]) / l->step[k] - 1e-9),
           b = floor ((high - l->origin[k]) / l->step[k] + 1e-9);
    *first = (int) fmin (fmax (a, 0), l->count[k] - 1), *last = (int) fmin (fmax (b, 0), l->count[k] - 1);
}

/* Enters piece i in the columns that its box meets; write: 0: counts, into the entry after that of each
 * column; 1: writes, and moves the start of the column on. */
static void enter (pg_facets *f, int axis, size_t i, int write)
{
    int p, q, first[2], last[2], across_of[2];
    size_t dim = (size_t) f->dim;
    across (f->dim, axis, &p, &q);
    across_of[0] = p, across_of[1] = q;
    for (int s = 0; s < 2; s++) {
        double low = HUGE_VAL, high = -HUGE_VAL;
        for (size_t c = 0; c < dim; c++) {
            double v = f->x[(i * dim + c) * dim + (size_t) across_of[s]];
            low = fmin (low, v), high = fmax (high, v);
        }
        range (&f->lattice, across_of[s], low, high, &first[s], &last[s]);
    }
    if (f->dim < 3) first[1] = last[1] = 0;
    for (int b = first[1]; b <= last[1]; b++)
        for (int a = first[0]; a <= last[0]; a++) {
            size_t c = column_at (f, axis, a, b);
            if (write) f->column[axis][f->column_first[axis][c]++] = (int) i;
            else f->column_first[axis][c + 1]++;
        }
}

/* Sorts the pieces into columns: counts, sums, writes, and moves the starts back by one entry. */
pg_status facets_columns (pg_facets *f)
{
    pg_status status = PG_OK;
    for (int axis = 0; axis < f->dim; axis++) {
        int p, q;
        across (f->dim, axis, &p, &q);
        size_t n = (size_t) f->lattice.count[p] * (size_t) (f->dim > 2 ? f->lattice.count[q] : 1);
        PG_ALLOC (f->column_first[axis], n + 1);
        size_t *first = f->column_first[axis];
        for (size_t i = 0; i < f->n; i++) enter (f, axis, i, 0);
        for (size_t c = 0; c < n; c++) first[c + 1] += first[c];
        PG_ALLOC (f->column[axis], first[n]);
        for (size_t i = 0; i < f->n; i++) enter (f, axis, i, 1);
        for (size_t c = n; c > 0; c--) first[c] = first[c - 1];
        first[0] = 0;
    }
done:
    return status;
}

/* The column along the axis that holds x; -1: x lies beyond the lattice. */
static long column_of (const pg_facets *f, int axis, const double *x)
{
    int p, q, i[2] = { 0, 0 };
    const pg_lattice *l = &f->lattice;
    across (f->dim, axis, &p, &q);
    for (int s = 0; s < f->dim - 1; s++) {
        int k = s ? q : p;
        double at = (x[k] - l->origin[k]) / l->step[k];
        if (!(at > -1e-3 && at < l->count[k] + 1e-3)) return -1;
        i[s] = (int) fmin (fmax (floor (at), 0), l->count[k] - 1);
    }
    return (long) column_at (f, axis, i[0], i[1]);
}

/* ---- rays ---------------------------------------------------------------------------------------------- */
/* Does the line through x along the axis miss the box of piece i by more than a tolerance? */
static int misses (const pg_facets *f, size_t i, int axis, const double *x)
{
    size_t dim = (size_t) f->dim;
    const double *corner = f->x + i * dim * dim;
    for (size_t s = 1; s < dim; s++) {
        size_t k = ((size_t) axis + s) % dim, below = 0, above = 0;
        double slack = 1e-9 * f->lattice.step[k];
        for (size_t c = 0; c < dim; c++)
            below += corner[c * dim + k] < x[k] - slack, above += corner[c * dim + k] > x[k] + slack;
        if (below == dim || above == dim) return 1;
    }
    return 0;
}

/* Where the line through x along the axis meets piece i: *at, the coordinate along the axis, and the sense of
 * its outward normal there: +1 or -1; 0: it passes beside the piece, or along it; 2: too near to its edge. */
static int meet (const pg_facets *f, size_t i, int axis, const double *x, double *at)
{
    size_t dim = (size_t) f->dim;
    const double *corner = f->x + i * dim * dim;
    double share[3] = { 0, 0, 0 }, size = 0, least = HUGE_VAL;
    int p, q;
    if (misses (f, i, axis, x)) return 0;
    across (f->dim, axis, &p, &q);
    if (dim == 2) {
        /* From corner a to b the outward normal is (dy, -dx). */
        double a = corner[p] - x[p], b = corner[2 + p] - x[p];
        size = axis == 1 ? a - b : b - a;
        share[0] = axis == 1 ? -b : b, share[1] = axis == 1 ? a : -a;
    } else
        for (int c = 0; c < 3; c++) {
            const double *a = corner + 3 * ((c + 1) % 3), *b = corner + 3 * ((c + 2) % 3);
            share[c] = (a[p] - x[p]) * (b[q] - x[q]) - (a[q] - x[q]) * (b[p] - x[p]);
            size += share[c];
        }
    double wide = 0;
    for (size_t c = 0; c < dim; c++)
        wide = fmax (wide, fmax (fabs (corner[c * dim + (size_t) p] - corner[(size_t) p]),
                                 fabs (corner[c * dim + (size_t) q] - corner[(size_t) q])));
    /* The piece is parallel to the ray: its neighbours report a ray that is too near. */
    if (!(fabs (size) > 1e-12 * (dim == 2 ? f->lattice.step[p] : wide * f->lattice.step[p]))) return 0;
    *at = 0;
    for (size_t c = 0; c < dim; c++)
        share[c] /= size, least = fmin (least, share[c]),
            *at += share[c] * corner[c * dim + (size_t) axis];
    if (least < -edge_on) return 0;
    return least < edge_on ? 2 : size > 0 ? 1 : -1;
}

/* Is x inside, by a ray along one axis? -1: it passes too near to an edge. */
static int inside_along (const pg_facets *f, int axis, const double *x)
{
    long column = column_of (f, axis, x);
    int turns = 0;
    if (column < 0) return 0;
    for (size_t k = f->column_first[axis][column]; k < f->column_first[axis][column + 1]; k++) {
        double at;
        int sense = meet (f, (size_t) f->column[axis][k], axis, x, &at);
        if (sense == 2) return -1;
        if (sense && at > x[axis]) turns += sense;
    }
    return turns > 0;
}

/* Is x inside? Where the rays along all axes fail, x is moved by far less than any length that matters. */
int pg_facets_inside (const pg_facets *f, const double *x)
{
    static const double aside[3] = { 0.7548, 0.5698, -0.8192 };
    double y[3] = { x[0], x[1], f->dim > 2 ? x[2] : 0 };
    for (int round = 0; round < 8; round++) {
        for (int axis = f->dim; axis-- > 0;) {
            int in = inside_along (f, axis, y);
            if (in >= 0) return in;
        }
        for (int k = 0; k < f->dim; k++) y[k] = x[k] + 1e-10 * f->lattice.step[k] * (round + 1) * aside[k];
    }
    return 0;
}

int pg_facets_meets (const pg_facets *f, int region, const double *x, int axis)
{
    long column = column_of (f, axis, x);
    if (column < 0) return 0;
    for (size_t k = f->column_first[axis][column]; k < f->column_first[axis][column + 1]; k++) {
        double at;
        int i = f->column[axis][k];
        if (f->region[i] == region && meet (f, (size_t) i, axis, x, &at)) return 1;
    }
    return 0;
}

int pg_facets_line (const pg_facets *f, const double *x, int axis, int most, double *at, int *sense)
{
    long column = column_of (f, axis, x);
    int n = 0;
    if (column < 0) return 0;
    for (size_t k = f->column_first[axis][column]; k < f->column_first[axis][column + 1]; k++) {
        double where;
        int s = meet (f, (size_t) f->column[axis][k], axis, x, &where), i = n;
        if (s == 2 || (s && n == most)) return -1;
        if (!s) continue;
        for (; i > 0 && at[i - 1] > where; i--) at[i] = at[i - 1], sense[i] = sense[i - 1];
        at[i] = where, sense[i] = s, n++;
    }
    return n;
}

/* The distance is infinite, as only its sign is used. */
double shape_facets_distance (const pg_shape *s, int dim, const double *x, double reach)
{
    (void) dim;
    (void) reach;
    return pg_facets_inside (&s->solid->facets, x) ? -HUGE_VAL : HUGE_VAL;
}
