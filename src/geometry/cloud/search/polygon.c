/* SPDX-License-Identifier: GPL-3.0-or-later
 * Plane polygons: area 1/2 sum (x_i y_i+1 - x_i+1 y_i), inside by crossing number, signed distance, and
 * whether the outline is simple. */
#include "polygon.h"
#include <math.h>

/* Area as a fan of triangles from the first vertex: no digits are lost far from the origin. */
double pg_polygon_area (size_t n, const double *v)
{
    double sum = 0;
    for (size_t i = 1; i + 1 < n; i++) {
        const double *a = v + 2*i, *b = a + 2;
        sum += (a[0] - v[0]) * (b[1] - v[1]) - (b[0] - v[0]) * (a[1] - v[1]);
    }
    return 0.5 * sum;
}

/* Counts the edges that a ray from x along the x axis crosses. */
int pg_polygon_inside (size_t n, const double *v, const double *x)
{
    int in = 0;
    for (size_t i = 0, j = n - 1; i < n; j = i++) {
        const double *a = v + 2*i, *b = v + 2*j;
        if ((a[1] > x[1]) == (b[1] > x[1])) continue;
        if (x[0] < a[0] + (b[0] - a[0]) * ((x[1] - a[1]) / (b[1] - a[1]))) in = !in;
    }
    return in;
}

/* Distance of x from the edge a b. */
static double edge_distance (const double *a, const double *b, const double *x)
{
    double u[2] = {b[0] - a[0], b[1] - a[1]}, w[2] = {x[0] - a[0], x[1] - a[1]};
    double uu = u[0]*u[0] + u[1]*u[1], s = uu > 0 ? (u[0]*w[0] + u[1]*w[1]) / uu : 0;
    s = s < 0 ? 0 : s > 1 ? 1 : s;
    return hypot (w[0] - s*u[0], w[1] - s*u[1]);
}

/* The least distance from any edge; the sign by pg_polygon_inside. */
double pg_polygon_distance (size_t n, const double *v, const double *x)
{
    double least = INFINITY;
    for (size_t i = 0, j = n - 1; i < n; j = i++) {
        double d = edge_distance (v + 2*j, v + 2*i, x);
        if (d < least) least = d;
    }
    return pg_polygon_inside (n, v, x) ? -least : least;
}

/* -1, 0, 1: c lies right of, on, left of the line a b. */
static int side (const double *a, const double *b, const double *c)
{
    double s = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    return (s > 0) - (s < 0);
}

/* Does c, which lies on the line a b, lie between a and b? */
static int within (const double *a, const double *b, const double *c)
{
    return fmin (a[0], b[0]) <= c[0] && c[0] <= fmax (a[0], b[0]) && fmin (a[1], b[1]) <= c[1]
           && c[1] <= fmax (a[1], b[1]);
}

/* Do the segments a b and c d touch or cross? */
static int edges_meet (const double *a, const double *b, const double *c, const double *d)
{
    int p = side (a, b, c), q = side (a, b, d), r = side (c, d, a), s = side (c, d, b);
    if (p * q < 0 && r * s < 0) return 1;
    return (!p && within (a, b, c)) || (!q && within (a, b, d)) || (!r && within (c, d, a))
           || (!s && within (c, d, b));
}

/* Tests all pairs of edges; polygons of input files are small. */
const char *pg_polygon_fault (size_t n, const double *v)
{
    if (n < 3) return "needs three vertices or more";
    double low[2] = {v[0], v[1]}, high[2] = {v[0], v[1]};
    for (size_t i = 0; i < n; i++) {
        const double *a = v + 2*i, *b = v + 2*((i + 1) % n);
        if (a[0] == b[0] && a[1] == b[1]) return "has the same vertex twice in a row";
        for (int k = 0; k < 2; k++) low[k] = fmin (low[k], a[k]), high[k] = fmax (high[k], a[k]);
    }
    for (size_t i = 0; i < n; i++)
        for (size_t j = i + 2; j < n; j++) {
            /* The first and the last edge share a vertex. */
            if (i == 0 && j == n - 1) continue;
            if (edges_meet (v + 2 * i, v + 2 * (i + 1), v + 2 * j, v + 2 * ((j + 1) % n)))
                return "touches or crosses itself";
        }
    /* An area below 1e-9 of the square of the extent counts as zero. */
    double size = fmax (high[0] - low[0], high[1] - low[1]);
    return fabs (pg_polygon_area (n, v)) > 1e-9 * size * size ? NULL : "has no area";
}
