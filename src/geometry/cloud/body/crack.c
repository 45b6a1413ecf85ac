/* SPDX-License-Identifier: GPL-3.0-or-later
 * Which bonds does a crack cut? One rule for crossing, touching and lying in the crack: the part of the
 * bond that lies within the tolerance of the crack's line or plane is compared with the crack there, grown
 * by the tolerance. The ends of a bond are put in a fixed order first, so that x - y and y - x have the
 * same bits.
 *
 * `retreat` removes strips along tips and fronts from a crack (mechanics/model/pre_crack_tips.c chooses their
 * widths): bonds that cross the crack there are not cut.
 *
 * For a sided segment or triangle every point lies on one of two sides: points on its line or plane count as
 * on the side that the normal points to, and a bond is cut if its ends lie on different sides and it crosses
 * the line or plane within the segment or triangle. */
#include "perigal/cloud.h"
#include "geometry/cloud/search/polygon.h"
#include "perigal/vector.h"
#include <math.h>
#include <string.h>

/* a + s (b - a); exactly b for s = 1. */
static void point_at (int dim, const double *a, const double *b, double s, double *out)
{
    for (int k = 0; k < dim; k++) out[k] = s == 1 ? b[k] : a[k] + s * (b[k] - a[k]);
}

/* ---- distances ----------------------------------------------------------------------------------------- */
/* Distance of p from the segment a b. */
static double distance_point (int dim, const double *p, const double *a, const double *b)
{
    double u[3] = { 0 }, w[3] = { 0 };
    for (int k = 0; k < dim; k++) u[k] = b[k] - a[k], w[k] = p[k] - a[k];
    double uu = pg_dot (dim, u, u), s = uu > 0 ? pg_dot (dim, u, w) / uu : 0;
    s = s < 0 ? 0 : s > 1 ? 1 : s;
    for (int k = 0; k < dim; k++) w[k] -= s * u[k];
    return sqrt (pg_dot (dim, w, w));
}

/* Distance of the segments a b and c d: the least distance of the ends or, where the lines are nearest
 * inside both, that of the lines. Parallel lines (determinant below 1e-14) are nearest at an end. */
static double distance_segments (const double *a, const double *b, const double *c, const double *d)
{
    double u[3], v[3], w[3];
    double p = fmin (distance_point (3, a, c, d), distance_point (3, b, c, d));
    double q = fmin (distance_point (3, c, a, b), distance_point (3, d, a, b)), least = fmin (p, q);
    for (int k = 0; k < 3; k++) u[k] = b[k] - a[k], v[k] = d[k] - c[k], w[k] = c[k] - a[k];
    /* Parameters of the nearest points of the two lines, by Cramer's rule. */
    double uu = pg_dot (3, u, u), vv = pg_dot (3, v, v), uv = pg_dot (3, u, v), det = uu*vv - uv*uv;
    if (!(det > 1e-14 * uu * vv)) return least;
    double s = (pg_dot (3, u, w) * vv - pg_dot (3, v, w) * uv) / det,
           t = (pg_dot (3, u, w) * uv - pg_dot (3, v, w) * uu) / det;
    if (s < 0 || s > 1 || t < 0 || t > 1) return least;
    for (int k = 0; k < 3; k++) w[k] += t * v[k] - s * u[k];
    return fmin (least, sqrt (pg_dot (3, w, w)));
}

double pg_segment_nearest (const double *a, const double *b, const double *x, double *place, double *distance)
{
    double t[2] = { b[0] - a[0], b[1] - a[1] }, size = t[0] * t[0] + t[1] * t[1];
    double s = size > 0 ? ((x[0] - a[0]) * t[0] + (x[1] - a[1]) * t[1]) / size : 0;
    s = fmin (1, fmax (0, s));
    double at[2] = { a[0] + s * t[0], a[1] + s * t[1] };
    if (place) place[0] = at[0], place[1] = at[1];
    if (distance) *distance = hypot (at[0] - x[0], at[1] - x[1]);
    return s;
}

/* ---- within the line or plane of the crack ------------------------------------------------------------- */
/* Along the line of the crack: does the interval of a b overlap that of the crack without its retreats? */
static int meets_segment (const pg_crack *c, const double *a, const double *b, double tolerance)
{
    const double *p = c->vertex, *q = p + 2, t[2] = {c->normal[1], -c->normal[0]};
    double w[2] = {q[0] - p[0], q[1] - p[1]}, e = pg_dot (2, t, w);
    double r[2] = {a[0] - p[0], a[1] - p[1]}, s[2] = {b[0] - p[0], b[1] - p[1]};
    double i = pg_dot (2, t, r), j = pg_dot (2, t, s);
    double first = c->retreat ? c->retreat[0] : 0, last = c->retreat ? c->retreat[1] : 0;
    /* What the retreats leave of the crack, along its direction t. */
    double low = e > 0 ? first : e + last, high = e > 0 ? e - last : -first;
    return fmax (i, j) >= low - tolerance && fmin (i, j) <= high + tolerance;
}

/* Does the segment a b, in the plane of the disc, come within the disc, less its retreat? */
static int meets_disc (const pg_crack *c, const double *a, const double *b, double tolerance)
{
    return distance_point (3, c->centre, a, b) <= c->radius - (c->retreat ? c->retreat[0] : 0) + tolerance;
}

/* Is p, which lies in the plane of the polygon, inside? By crossing number in the projection along the axis
 * nearest to the normal. */
static int in_polygon (const pg_crack *c, const double *p)
{
    int k = 0, in = 0;
    for (int m = 1; m < 3; m++) if (fabs (c->normal[m]) > fabs (c->normal[k])) k = m;
    int i = (k + 1) % 3, j = (k + 2) % 3;
    for (size_t m = 0, l = c->nvertex - 1; m < c->nvertex; l = m++) {
        const double *a = c->vertex + 3*m, *b = c->vertex + 3*l;
        if ((a[j] > p[j]) == (b[j] > p[j])) continue;
        if (p[i] < a[i] + (b[i] - a[i]) * ((p[j] - a[j]) / (b[j] - a[j]))) in = !in;
    }
    return in;
}

/* ---- a polygon less the strips along its fronts -------------------------------------------------------- */
/* The part a b of a bond that lies in the plane of the polygon, and an edge from - to of the polygon. */
typedef struct { const double *a, *b, *from, *to; } chord;

/* Position at t in [0, 1] on the chord. */
static void along (const chord *h, double t, double *out)
{
    for (int k = 0; k < 3; k++) out[k] = h->a[k] + t * (h->b[k] - h->a[k]);
}

/* Distance of the position at t on the chord from the edge, m. */
static double away (const chord *h, double t)
{
    double x[3];
    along (h, t, x);
    return distance_point (3, x, h->from, h->to);
}

/* Where the chord is nearest to the edge, by ternary search: the distance from a segment is convex along a
 * line. */
static double nearest (const chord *h)
{
    double low = 0, high = 1;
    for (int i = 0; i < 80; i++) {
        double s = low + (high - low) / 3, t = high - (high - low) / 3;
        if (away (h, s) <= away (h, t)) high = t;
        else low = s;
    }
    return 0.5 * (low + high);
}

/* Where the chord comes within d of the edge, by bisection between `far`, which is farther away, and
 * `near`, which is not. The result is at least d away. */
static double crossing (const chord *h, double d, double far, double near)
{
    for (int i = 0; i < 60; i++) {
        double t = 0.5 * (far + near);
        if (away (h, t) >= d) far = t;
        else near = t;
    }
    return far;
}

/* Is all of the segment p q certainly farther than `reach` from the edge a b? The middles are farther apart
 * than reach and both half lengths together, (r + l + m)^2 <= 3 (r^2 + l^2 + m^2). */
static int far_from_edge (const double *p, const double *q, const double *a, const double *b, double reach)
{
    double middle = 0, length = 0;
    for (int k = 0; k < 3; k++) {
        double m = 0.5 * (p[k] + q[k]) - 0.5 * (a[k] + b[k]), l = b[k] - a[k], n = q[k] - p[k];
        middle += m * m, length += l * l + n * n;
    }
    return middle > 3.001 * (reach * reach + 0.25 * length);
}

/* Is p in the polygon, or within the tolerance of its outline, and not in the strip along a front? */
static int in_what_is_left (const pg_crack *c, const double *p, double tolerance)
{
    int in = in_polygon (c, p);
    for (size_t m = 0; m < c->nvertex; m++) {
        const double *a = c->vertex + 3*m, *b = c->vertex + 3*((m + 1) % c->nvertex);
        if (far_from_edge (p, p, a, b, fmax (c->retreat[m], tolerance))) continue;
        double d = distance_point (3, p, a, b);
        if (c->retreat[m] > 0 && d < c->retreat[m] - tolerance) return 0;
        in |= d <= tolerance;
    }
    return in;
}

/* Does the chord a b meet what the strips leave of the polygon? Along the chord this can begin and end only
 * at the ends of the chord, at an edge, or where the chord enters the strip along an edge: these positions
 * are tested, of edges that it comes near. */
static int meets_what_is_left (const pg_crack *c, const double *a, const double *b, double tolerance)
{
    double length = 0;
    if (in_what_is_left (c, a, tolerance) || in_what_is_left (c, b, tolerance)) return 1;
    for (int k = 0; k < 3; k++) length = fmax (length, fabs (b[k] - a[k]));
    if (length <= 4 * tolerance) return 0;
    for (size_t m = 0; m < c->nvertex; m++) {
        chord h = { a, b, c->vertex + 3*m, c->vertex + 3*((m + 1) % c->nvertex) };
        if (far_from_edge (a, b, h.from, h.to, fmax (c->retreat[m], tolerance))) continue;
        double t = nearest (&h), d = c->retreat[m], x[3];
        double place[3] = { t, away (&h, t) < d && away (&h, 0) > d ? crossing (&h, d, 0, t) : t,
                            away (&h, t) < d && away (&h, 1) > d ? crossing (&h, d, 1, t) : t };
        for (int k = 0; k < 3; k++) {
            along (&h, place[k], x);
            if (in_what_is_left (c, x, tolerance)) return 1;
        }
    }
    return 0;
}

/* Does the chord a b meet the polygon? Without retreats: if an end lies inside, or an edge within the
 * tolerance. */
static int meets_polygon (const pg_crack *c, const double *a, const double *b, double tolerance)
{
    if (c->retreat) return meets_what_is_left (c, a, b, tolerance);
    if (in_polygon (c, a) || in_polygon (c, b)) return 1;
    /* Neither end inside: the chord can only meet the outline. */
    for (size_t m = 0, l = c->nvertex - 1; m < c->nvertex; l = m++)
        if (distance_segments (a, b, c->vertex + 3*l, c->vertex + 3*m) <= tolerance) return 1;
    return 0;
}

/* ---- outlines of slots --------------------------------------------------------------------------------- */
/* Does the bond x y pass through the inside of a 2D outline? The edges divide it; a part whose middle lies
 * deeper inside than the tolerance passes. Edges that it crosses are found one at a time, in order: the next
 * crossing behind s. */
static int passes_outline (const pg_crack *c, const double *x, const double *y, double tolerance)
{
    double s = 0;
    while (s < 1) {
        double next = 1;
        for (size_t i = 0, j = c->nvertex - 1; i < c->nvertex; j = i++) {
            const double *a = c->vertex + 2*j, *b = c->vertex + 2*i;
            double u[2] = { y[0] - x[0], y[1] - x[1] }, v[2] = { b[0] - a[0], b[1] - a[1] },
                   w[2] = { a[0] - x[0], a[1] - x[1] }, det = u[0] * v[1] - u[1] * v[0];
            if (det == 0) continue;
            double at = (w[0] * v[1] - w[1] * v[0]) / det, on = (w[0] * u[1] - w[1] * u[0]) / det;
            if (on >= -1e-9 && on <= 1 + 1e-9 && at > s + 1e-9 && at < next) next = at;
        }
        double middle[2];
        point_at (2, x, y, 0.5 * (s + next), middle);
        if (pg_polygon_distance (c->nvertex, c->vertex, middle) < -tolerance) return 1;
        s = next;
    }
    return 0;
}

/* ---- does a crack cut a bond? -------------------------------------------------------------------------- */
/* One function for each kind of crack. */
static int (*const meets[]) (const pg_crack *, const double *, const double *, double) = {
    [PG_CRACK_SEGMENT] = meets_segment, [PG_CRACK_POLYGON] = meets_polygon, [PG_CRACK_DISC] = meets_disc,
};

/* Order of the ends of a bond, lexicographic. */
static int after (int dim, const double *x, const double *y)
{
    for (int k = 0; k < dim; k++)
        if (x[k] != y[k]) return x[k] > y[k];
    return 0;
}

/* Does the bond x y cross a sided segment or triangle? d, e: distances of the ends from its line or plane,
 * positive on the side that the normal points to, clipped at zero for an end on that side: a point there
 * within the crack's width then crosses at its own projection. */
static int crosses_sided (const pg_crack *c, int dim, const double *x, const double *y, double tolerance)
{
    const double *p = c->vertex;
    double d = 0, e = 0, at[3];
    for (int k = 0; k < dim; k++) d += c->normal[k] * (x[k] - p[k]), e += c->normal[k] * (y[k] - p[k]);
    if ((d >= -c->width) == (e >= -c->width)) return 0;
    if (d >= -c->width) d = fmax (d, 0);
    else e = fmax (e, 0);
    point_at (dim, x, y, d / (d - e), at);
    return meets[c->kind] (c, at, at, tolerance);
}

/* Does the bond x y cross the crack? d, e: distances of its ends from the plane of the crack; s, t: the ends
 * of the part of the bond within the tolerance. */
static int crosses (const pg_crack *crack, int dim, const double *x, const double *y, double tolerance)
{
    const double *p = crack->kind == PG_CRACK_DISC ? crack->centre : crack->vertex;
    double from[3], to[3], d = 0, e = 0, s = 0, t = 1;
    for (int k = 0; k < dim; k++)
        d += crack->normal[k] * (x[k] - p[k]), e += crack->normal[k] * (y[k] - p[k]);
    if ((d > tolerance && e > tolerance) || (d < -tolerance && e < -tolerance)) return 0;
    if (fabs (d) > tolerance) s = (copysign (tolerance, d) - d) / (e - d);
    if (fabs (e) > tolerance) t = (copysign (tolerance, e) - d) / (e - d);
    point_at (dim, x, y, s, from);
    point_at (dim, x, y, t, to);
    return meets[crack->kind] (crack, from, to, tolerance);
}

int pg_crack_cuts (const pg_crack *crack, int dim, const double *x, const double *y, double tolerance)
{
    if (after (dim, x, y)) {
        const double *swap = x;
        x = y, y = swap;
    }
    if (crack->kind == PG_CRACK_OUTLINE) return passes_outline (crack, x, y, tolerance);
    return crack->sided ? crosses_sided (crack, dim, x, y, tolerance) : crosses (crack, dim, x, y, tolerance);
}

/* Does x lie on the crack? Tested as a bond of zero length at x. */
int pg_crack_touches (const pg_crack *crack, int dim, const double *x, double tolerance)
{
    if (crack->kind == PG_CRACK_OUTLINE)
        return fabs (pg_polygon_distance (crack->nvertex, crack->vertex, x)) <= tolerance;
    return crosses (crack, dim, x, x, tolerance);
}

void pg_crack_orient (pg_crack *c)
{
    double t[2] = { c->vertex[2] - c->vertex[0], c->vertex[3] - c->vertex[1] }, size = hypot (t[0], t[1]);
    c->normal[0] = -t[1] / size, c->normal[1] = t[0] / size;
}

void pg_cracks_clear (pg_cracks *cracks)
{
    for (size_t i = 0; cracks->crack && i < cracks->n; i++)
        pg_free (cracks->crack[i].vertex), pg_free (cracks->crack[i].retreat);
    pg_free (cracks->crack), pg_cracks_clear_index (cracks);
    memset (cracks, 0, sizeof *cracks);
}
