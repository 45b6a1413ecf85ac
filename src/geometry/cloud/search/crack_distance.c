/* SPDX-License-Identifier: GPL-3.0-or-later
 * Distances between cracks: of segments and outlines in 2D, of plane polygons in 3D; and their sizes. */
#include "crack_distance.h"
#include "polygon.h"
#include "perigal/vector.h"
#include <math.h>
#include <string.h>

/* Vertex i as a 3D position, m: z = 0 in 2D. */
static void vertex_of (const pg_crack *c, int dim, size_t i, double *x)
{
    x[2] = 0;
    for (int k = 0; k < dim; k++) x[k] = c->vertex[(size_t) dim * i + (size_t) k];
}

/* Number of edges: one for a segment, else as many as vertices. */
static size_t edges_of (const pg_crack *c) { return c->kind == PG_CRACK_SEGMENT ? 1 : c->nvertex; }

static void edge_of (const pg_crack *c, int dim, size_t i, double *a, double *b)
{
    vertex_of (c, dim, i, a), vertex_of (c, dim, (i + 1) % c->nvertex, b);
}

/* Distance of the segments a b and c d (Ericson 2004, section 5.1.9): parameters s and t on both, clamped to
 * their ends one after the other. */
static double between_edges (const double *a, const double *b, const double *c, const double *d)
{
    double u[3], v[3], w[3];
    for (int k = 0; k < 3; k++) u[k] = b[k] - a[k], v[k] = d[k] - c[k], w[k] = a[k] - c[k];
    double uu = pg_dot3 (u, u), vv = pg_dot3 (v, v), uv = pg_dot3 (u, v), uw = pg_dot3 (u, w),
           vw = pg_dot3 (v, w),
           det = uu * vv - uv * uv,
           s = det > 1e-14 * uu * vv ? fmin (1, fmax (0, (uv * vw - uw * vv) / det)) : 0;
    double t = vv > 0 ? (uv * s + vw) / vv : 0;
    if (t < 0 || t > 1) {
        t = t < 0 ? 0 : 1;
        s = uu > 0 ? fmin (1, fmax (0, (uv * t - uw) / uu)) : 0;
    }
    for (int k = 0; k < 3; k++) w[k] += s * u[k] - t * v[k];
    return sqrt (pg_dot3 (w, w));
}

/* Does x, projected onto the plane of the polygon, lie inside it? By crossing number in the projection along
 * the axis nearest to the normal. */
static int foot_inside (const pg_crack *c, const double *x)
{
    int k = 0, in = 0;
    for (int m = 1; m < 3; m++) if (fabs (c->normal[m]) > fabs (c->normal[k])) k = m;
    int i = (k + 1) % 3, j = (k + 2) % 3;
    double off = 0, p[3];
    for (int m = 0; m < 3; m++) off += c->normal[m] * (x[m] - c->vertex[m]);
    for (int m = 0; m < 3; m++) p[m] = x[m] - off * c->normal[m];
    for (size_t m = 0, l = c->nvertex - 1; m < c->nvertex; l = m++) {
        const double *a = c->vertex + 3*m, *b = c->vertex + 3*l;
        if ((a[j] > p[j]) == (b[j] > p[j])) continue;
        if (p[i] < a[i] + (b[i] - a[i]) * ((p[j] - a[j]) / (b[j] - a[j]))) in = !in;
    }
    return in;
}

/* Least distance of the edges of a from the area of b: a corner above it, or an edge that goes through it. */
static double edges_to_area (const pg_crack *a, const pg_crack *b)
{
    double least = INFINITY;
    for (size_t i = 0; i < a->nvertex; i++) {
        double p[3], q[3], d = 0, e = 0, through[3];
        edge_of (a, 3, i, p, q);
        for (int k = 0; k < 3; k++)
            d += b->normal[k] * (p[k] - b->vertex[k]), e += b->normal[k] * (q[k] - b->vertex[k]);
        if (fabs (d) < least && foot_inside (b, p)) least = fabs (d);
        if ((d > 0) == (e > 0) || d == e) continue;
        for (int k = 0; k < 3; k++) through[k] = p[k] + d / (d - e) * (q[k] - p[k]);
        if (foot_inside (b, through)) return 0;
    }
    return least;
}

double crack_distance (const pg_crack *a, const pg_crack *b, int dim)
{
    double least = INFINITY, p[3], q[3], r[3], s[3];
    if (dim == 3) least = fmin (edges_to_area (a, b), edges_to_area (b, a));
    /* of two outlines one may lie inside the other */
    if (a->kind == PG_CRACK_OUTLINE && pg_polygon_inside (a->nvertex, a->vertex, b->vertex)) return 0;
    if (b->kind == PG_CRACK_OUTLINE && pg_polygon_inside (b->nvertex, b->vertex, a->vertex)) return 0;
    for (size_t i = 0; i < edges_of (a) && least > 0; i++) {
        edge_of (a, dim, i, p, q);
        for (size_t j = 0; j < edges_of (b); j++) {
            edge_of (b, dim, j, r, s);
            least = fmin (least, between_edges (p, q, r, s));
        }
    }
    return least;
}

void crack_ball (const pg_crack *c, int dim, double *middle, double *radius)
{
    double x[3];
    memset (middle, 0, 3 * sizeof *middle);
    for (size_t i = 0; i < c->nvertex; i++) {
        vertex_of (c, dim, i, x);
        for (int k = 0; k < 3; k++) middle[k] += x[k] / (double) c->nvertex;
    }
    *radius = 0;
    for (size_t i = 0; i < c->nvertex; i++) {
        vertex_of (c, dim, i, x);
        for (int k = 0; k < 3; k++) x[k] -= middle[k];
        *radius = fmax (*radius, sqrt (pg_dot3 (x, x)));
    }
}

double crack_length (const pg_crack *c, int dim)
{
    double most = 0, x[3], y[3];
    if (c->kind == PG_CRACK_DISC) return 2 * c->radius;
    for (size_t i = 0; i < c->nvertex; i++)
        for (size_t j = 0; j < i; j++) {
            vertex_of (c, dim, i, x), vertex_of (c, dim, j, y);
            for (int k = 0; k < 3; k++) x[k] -= y[k];
            most = fmax (most, sqrt (pg_dot3 (x, x)));
        }
    return most;
}

/* Area of a plane polygon in 3D by its area vector, m^2. */
static double area_of (const pg_crack *c)
{
    double sum[3] = { 0 };
    for (size_t i = 1; i + 1 < c->nvertex; i++) {
        const double *o = c->vertex, *a = o + 3*i, *b = a + 3;
        for (int k = 0; k < 3; k++) {
            int p = (k + 1) % 3, q = (k + 2) % 3;
            sum[k] += 0.5 * ((a[p] - o[p]) * (b[q] - o[q]) - (a[q] - o[q]) * (b[p] - o[p]));
        }
    }
    return sqrt (pg_dot3 (sum, sum));
}

double pg_crack_size (const pg_crack *c, int dim)
{
    if (dim == 2) return crack_length (c, 2);
    return c->kind == PG_CRACK_DISC ? 3.14159265358979323846 * c->radius * c->radius : area_of (c);
}

double crack_removed (const pg_crack *c, int dim)
{
    if (c->kind == PG_CRACK_OUTLINE) return fabs (pg_polygon_area (c->nvertex, c->vertex));
    return c->slot > 0 ? c->slot * pg_crack_size (c, dim) : 0;
}

void crack_axis (const pg_crack *c, int dim, double *axis)
{
    double most = -1;
    memcpy (axis, c->normal, 3 * sizeof *axis);
    if (dim == 3) return;
    for (size_t i = 0; i < c->nvertex; i++)
        for (size_t j = 0; j < i; j++) {
            double t[2] = { c->vertex[2*i] - c->vertex[2*j], c->vertex[2*i + 1] - c->vertex[2*j + 1] },
                   size = sqrt (t[0] * t[0] + t[1] * t[1]);
            if (!(size > most * (1 + 1e-12))) continue;
            most = size, axis[0] = t[0] / size, axis[1] = t[1] / size, axis[2] = 0;
        }
}
