/* SPDX-License-Identifier: GPL-3.0-or-later
 * Nearest point of a set: a grid of cells over the points, searched in shells about the position until the
 * next shell lies farther away than the best found. Of equally near points the one with the lowest number
 * is taken, so that no answer depends on the grid. */
#include "perigal/cloud.h"
#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The grid. */
struct pg_nearest {
    int     dim;
    size_t  n;
    const double *x;
    long    count[3];
    /* Corner and width of the cells, m. */
    double  low[3], width[3];
    size_t *start;
    /* Points of each cell, ascending. */
    int    *item;
};

/* Cell index of coordinate x along axis k; outside: the nearest cell. */
static long cell_along (const pg_nearest *g, int k, double x)
{
    double c = floor ((x - g->low[k]) / g->width[k]);
    if (!(c > 0)) return 0;
    return c < (double) g->count[k] ? (long) c : g->count[k] - 1;
}

/* Number of the cell that holds x, x fastest. */
static size_t cell_of (const pg_nearest *g, const double *x)
{
    size_t c = 0;
    for (int k = g->dim; k-- > 0;) c = c * (size_t) g->count[k] + (size_t) cell_along (g, k, x[k]);
    return c;
}

/* About one point in each cell; axes along which the points have no extent have one cell. */
static void fit (pg_nearest *g)
{
    double length[3] = { 0 }, longest = 0, volume = 1;
    int flat = 0;
    for (int k = 0; k < g->dim; k++) {
        double high = -INFINITY;
        g->low[k] = INFINITY;
        for (size_t i = 0; i < g->n; i++) {
            double v = g->x[i * (size_t) g->dim + (size_t) k];
            g->low[k] = fmin (g->low[k], v), high = fmax (high, v);
        }
        length[k] = high - g->low[k];
        longest = fmax (longest, length[k]);
    }
    for (int k = 0; k < g->dim; k++) {
        if (length[k] > 1e-6 * longest) volume *= length[k];
        else flat++;
    }
    double edge = g->dim > flat ? pow (volume / (double) g->n, 1.0 / (g->dim - flat)) : 1;
    for (int k = 0; k < 3; k++) {
        double cells = k < g->dim && edge > 0 ? floor (length[k] / edge) : 1;
        g->count[k] = cells >= 1 ? (long) fmin (cells, 4 * (double) g->n + 1) : 1;
        g->width[k] = k < g->dim && length[k] > 0 ? length[k] / (double) g->count[k] : 1;
    }
}

/* Counting sort of the points. */
pg_status pg_nearest_create (pg_nearest **out, int dim, size_t n, const double *x)
{
    pg_status status = PG_OK;
    pg_nearest *g = NULL;
    size_t ncell = 1;
    *out = NULL;
    if (n == 0 || n > INT_MAX) PG_FAIL (PG_E_USAGE, "the nearest of %zu points is asked for", n);
    PG_ALLOC (g, 1);
    g->dim = dim, g->n = n, g->x = x;
    fit (g);
    for (int k = 0; k < 3; k++) ncell *= (size_t) g->count[k];
    PG_ALLOC (g->start, ncell + 2);
    PG_ALLOC (g->item, n);
    for (size_t i = 0; i < n; i++) g->start[cell_of (g, x + i * (size_t) dim) + 2]++;
    for (size_t c = 2; c < ncell + 2; c++) g->start[c] += g->start[c - 1];
    for (size_t i = 0; i < n; i++) g->item[g->start[cell_of (g, x + i * (size_t) dim) + 1]++] = (int) i;
    *out = g;
    g = NULL;
done:
    pg_nearest_free (&g);
    return status;
}

void pg_nearest_free (pg_nearest **nearest)
{
    pg_nearest *g = *nearest;
    if (!g) return;
    pg_free (g->start), pg_free (g->item);
    pg_free (g);
    *nearest = NULL;
}

/* A question and its best answer so far. */
typedef struct {
    const double *place;
    pg_refuse refuse;  void *context;
    long   found;
    /* Squared distance, m^2. */
    double best;
} query;

/* Looks at the points of one cell. A point is offered for refusal only if it would be the best. */
static void look (const pg_nearest *g, query *q, size_t cell)
{
    for (size_t e = g->start[cell]; e < g->start[cell + 1]; e++) {
        const double *x = g->x + (size_t) g->item[e] * (size_t) g->dim;
        double d = 0;
        for (int k = 0; k < g->dim; k++) d += (x[k] - q->place[k]) * (x[k] - q->place[k]);
        if (!(d < q->best || (d == q->best && g->item[e] < q->found))) continue;
        if (q->refuse && q->refuse (q->context, q->place, (size_t) g->item[e])) continue;
        q->best = d, q->found = g->item[e];
    }
}

/* Least distance from the position to any cell beyond the shell; < 0: there are none. */
static double beyond (const pg_nearest *g, const double *place, const long *at, long shell)
{
    double least = -1;
    for (int k = 0; k < g->dim; k++)
        for (int side = -1; side <= 1; side += 2) {
            long edge = side < 0 ? at[k] - shell : at[k] + shell + 1;
            if (side < 0 ? edge <= 0 : edge >= g->count[k]) continue;
            double d = fmax (0, (double) side * (g->low[k] + (double) edge * g->width[k] - place[k]));
            if (least < 0 || d < least) least = d;
        }
    return least;
}

/* Shell s has the cells at distance s (in the maximum norm) from the cell of the position. The search ends
 * when no cell beyond the shell can hold anything nearer, with a margin for rounding. */
long pg_nearest_find (const pg_nearest *g, const double *place, pg_refuse refuse, void *context)
{
    query q = { place, refuse, context, -1, INFINITY };
    long at[3] = { 0 }, a[3] = { 0 }, b[3] = { 0 };
    for (int k = 0; k < g->dim; k++) at[k] = cell_along (g, k, place[k]);
    /* The shell is visited as the cells of a growing box that lie at its surface. */
    for (long shell = 0;; shell++) {
        for (int k = 0; k < g->dim; k++) {
            a[k] = at[k] - shell < 0 ? 0 : at[k] - shell;
            b[k] = at[k] + shell >= g->count[k] ? g->count[k] - 1 : at[k] + shell;
        }
        for (long z = a[2]; z <= b[2]; z++)
            for (long y = a[1]; y <= b[1]; y++)
                for (long x = a[0]; x <= b[0]; x++) {
                    long far = labs (x - at[0]);
                    if (labs (y - at[1]) > far) far = labs (y - at[1]);
                    if (labs (z - at[2]) > far) far = labs (z - at[2]);
                    if (far == shell)
                        look (g, &q,
                              ((size_t) z * (size_t) g->count[1] + (size_t) y) * (size_t) g->count[0]
                                  + (size_t) x);
                }
        double rest = beyond (g, place, at, shell);
        if (rest < 0 || (q.found >= 0 && rest * rest > q.best * (1 + 1e-12))) return q.found;
    }
}
