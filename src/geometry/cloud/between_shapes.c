/* SPDX-License-Identifier: GPL-3.0-or-later
 * Where a line segment runs outside of a shape: in closed form, by clipping the segment at planes and at
 * round surfaces; for polygons by the edges that it crosses. And lists of gaps: their intersection and
 * union. */
#include "between.h"
#include "geometry/cloud/search/polygon.h"
#include <math.h>
#include <string.h>

/* ---- lists of gaps ------------------------------------------------------------------------------------- */
void between_gaps_add (between_gaps *g, const between_gap *gap)
{
    if (g->n == BETWEEN_GAPS) g->full = 1;
    else g->gap[g->n++] = *gap;
}

/* The larger of two starts, or the smaller of two ends (side 1), with its normal. */
static void later (between_gap *out, const between_gap *a, const between_gap *b, int side)
{
    const between_gap *from = (side ? b->t[1] < a->t[1] : b->t[0] > a->t[0]) ? b : a;
    out->t[side] = from->t[side];
    memcpy (out->normal[side], from->normal[side], sizeof out->normal[side]);
}

static double width (const between_gap *g) { return g->t[1] - g->t[0]; }

void between_gaps_both (between_gaps *out, const between_gaps *a, const between_gaps *b, double slack)
{
    out->n = 0, out->full = a->full | b->full;
    for (int i = 0; i < a->n; i++)
        for (int j = 0; j < b->n; j++) {
            between_gap g;
            const between_gap *p = &a->gap[i], *q = &b->gap[j];
            later (&g, p, q, 0), later (&g, p, q, 1);
            int narrow = width (p) <= slack || width (q) <= slack;
            if (width (&g) > slack || (narrow && width (&g) >= 0)) between_gaps_add (out, &g);
        }
}

void between_gaps_any (between_gaps *out, const between_gaps *a, const between_gaps *b)
{
    int i = 0, j = 0;
    out->n = 0, out->full = a->full | b->full;
    while (i < a->n || j < b->n) {
        const between_gap *next = j == b->n || (i < a->n && a->gap[i].t[0] <= b->gap[j].t[0]) ? &a->gap[i++]
                                                                                              : &b->gap[j++];
        between_gap *last = out->n ? &out->gap[out->n - 1] : NULL;
        if (!last || next->t[0] > last->t[1]) between_gaps_add (out, next);
        else if (next->t[1] > last->t[1]) {
            last->t[1] = next->t[1];
            memcpy (last->normal[1], next->normal[1], sizeof last->normal[1]);
        }
    }
}

void between_gaps_turn (between_gaps *out, const between_gaps *a)
{
    between_gap g = { .t = { -INFINITY, INFINITY } };
    out->n = 0, out->full = a->full;
    for (int i = 0; i <= a->n; i++) {
        g.t[1] = i < a->n ? a->gap[i].t[0] : INFINITY;
        for (int k = 0; k < 3; k++) g.normal[1][k] = i < a->n ? -a->gap[i].normal[0][k] : 0;
        if (width (&g) > 0) between_gaps_add (out, &g);
        if (i == a->n) break;
        g.t[0] = a->gap[i].t[1];
        for (int k = 0; k < 3; k++) g.normal[0][k] = -a->gap[i].normal[1][k];
    }
}

/* ---- shapes that are convex ---------------------------------------------------------------------------- */
/* The part of a segment inside a shape, from t[0] to t[1], with the normals of the shape there. */
typedef struct { double t[2], normal[2][3]; } chord;

static void clip_to (chord *c, int side, double t, const double *normal)
{
    if (side ? t >= c->t[1] : t <= c->t[0]) return;
    c->t[side] = t;
    memcpy (c->normal[side], normal, sizeof c->normal[side]);
}

/* Clips the chord to what lies behind the plane n.x = level (m), n a unit vector. */
static void clip_plane (chord *c, const between_way *w, const double *n, double level)
{
    double off = -level, rate = 0;
    for (int k = 0; k < w->dim; k++) off += n[k] * w->x[k], rate += n[k] * w->d[k];
    if (fabs (rate) > 1e-14 * w->length) clip_to (c, rate > 0, -off / rate, n);
    else if (off > 0) c->t[0] = INFINITY, c->t[1] = -INFINITY;
}

/* Clips the chord to what lies within `radius` (m) of a point or, with an axis, of a line. */
static void clip_round (chord *c, const between_way *w, const double *centre, const double *axis,
                        double radius)
{
    double r[3] = { 0 }, d[3] = { 0 }, along = 0, turn = 0, A = 0, B = 0, C = -radius * radius;
    for (int k = 0; k < w->dim; k++) {
        r[k] = w->x[k] - centre[k], d[k] = w->d[k];
        if (axis) along += r[k] * axis[k], turn += d[k] * axis[k];
    }
    for (int k = 0; k < w->dim; k++) {
        if (axis) r[k] -= along * axis[k], d[k] -= turn * axis[k];
        A += d[k] * d[k], B += r[k] * d[k], C += r[k] * r[k];
    }
    double root = B * B - A * C;
    if (!(A > 1e-28 * w->length * w->length)) {
        if (C > 0) c->t[0] = INFINITY, c->t[1] = -INFINITY;
        return;
    }
    if (!(root > 0)) {
        c->t[0] = INFINITY, c->t[1] = -INFINITY;
        return;
    }
    for (int side = 0; side < 2; side++) {
        double t = (-B + (side ? 1 : -1) * sqrt (root)) / A, n[3] = { 0 };
        for (int k = 0; k < w->dim; k++) n[k] = (r[k] + t * d[k]) / radius;
        clip_to (c, side, t, n);
    }
}

/* ---- polygons ------------------------------------------------------------------------------------------ */
/* Is the polygon convex? */
static int polygon_convex (const pg_shape *s)
{
    int left = 0, right = 0;
    for (size_t i = 0; i < s->nvertex; i++) {
        const double *a = s->vertex + 2 * i, *b = s->vertex + 2 * ((i + 1) % s->nvertex),
                     *c = s->vertex + 2 * ((i + 2) % s->nvertex);
        double turn = (b[0] - a[0]) * (c[1] - b[1]) - (b[1] - a[1]) * (c[0] - b[0]);
        left |= turn > 0, right |= turn < 0;
    }
    return !(left && right);
}

/* Gaps of a polygon along the segment in its plane, moved sideways by `off` (m). */
static void polygon_gaps (between_gaps *out, const pg_shape *s, const between_way *w, double off)
{
    double length = hypot (w->d[0], w->d[1]), sense = pg_polygon_area (s->nvertex, s->vertex) > 0 ? 1 : -1;
    between_gaps inside = { 0 };
    struct { double t, n[2]; } met[2 * BETWEEN_GAPS];
    int n = 0;
    for (size_t i = 0; i < s->nvertex; i++) {
        const double *a = s->vertex + 2 * i, *b = s->vertex + 2 * ((i + 1) % s->nvertex);
        double e[2] = { b[0] - a[0], b[1] - a[1] }, size = hypot (e[0], e[1]),
               p = ((a[1] - w->x[1]) * w->d[0] - (a[0] - w->x[0]) * w->d[1]) / length - off,
               q = ((b[1] - w->x[1]) * w->d[0] - (b[0] - w->x[0]) * w->d[1]) / length - off;
        if ((p >= 0) == (q >= 0)) continue;
        if (n == 2 * BETWEEN_GAPS) {
            inside.full = 1;
            break;
        }
        double f = p / (p - q), t = 0;
        for (int k = 0; k < 2; k++) t += (a[k] + f * e[k] - w->x[k]) * w->d[k] / (length * length);
        int at = n++;
        for (; at > 0 && met[at - 1].t > t; at--) met[at] = met[at - 1];
        met[at].t = t, met[at].n[0] = sense * e[1] / size, met[at].n[1] = -sense * e[0] / size;
    }
    for (int k = 0; k + 1 < n; k += 2) {
        between_gap g = { .t = { met[k].t, met[k + 1].t } };
        for (int side = 0; side < 2; side++)
            for (int c = 0; c < 2; c++) g.normal[side][c] = -met[k + side].n[c];
        between_gaps_add (&inside, &g);
    }
    between_gaps_turn (out, &inside);
}

/* Gaps of a polygon. If the segment lies on an edge, both sides of it are tried and the body is favoured. */
static void polygon (between_gaps *out, const pg_shape *s, const between_way *w)
{
    between_gaps a, b;
    if (hypot (w->d[0], w->d[1]) <= 1e-14 * w->length) {
        between_gap all = { .t = { -INFINITY, INFINITY } };
        out->n = out->full = 0;
        if (pg_polygon_distance (s->nvertex, s->vertex, w->x) > (s->add ? w->near : -w->near))
            between_gaps_add (out, &all);
        return;
    }
    polygon_gaps (&a, s, w, w->near), polygon_gaps (&b, s, w, -w->near);
    if (s->add) between_gaps_both (out, &a, &b, 0);
    else between_gaps_any (out, &a, &b);
}

/* ---- shapes -------------------------------------------------------------------------------------------- */
/* The gaps before and after a chord. */
static void gaps_of (between_gaps *out, const chord *c)
{
    between_gaps inside = { 0 };
    between_gap g = { .t = { c->t[0], c->t[1] } };
    for (int side = 0; side < 2; side++)
        for (int k = 0; k < 3; k++) g.normal[side][k] = -c->normal[side][k];
    if (c->t[1] > c->t[0]) between_gaps_add (&inside, &g);
    between_gaps_turn (out, &inside);
}

/* Gaps of a prism: of a polygon and of two planes normal to the axis z. */
static void prism (between_gaps *out, const pg_shape *s, const between_way *w, double low, double high)
{
    chord c = { .t = { -INFINITY, INFINITY } };
    between_gaps a, b;
    clip_plane (&c, w, (const double[3]) { 0, 0, -1 }, -low);
    clip_plane (&c, w, (const double[3]) { 0, 0, 1 }, high);
    gaps_of (&a, &c);
    polygon (&b, s, w);
    between_gaps_any (out, &a, &b);
}

/* Gaps of a plate as of a prism in its own axes: along, across, and normal to it. */
static void plate (between_gaps *out, const pg_shape *s, const between_way *w)
{
    double axis[3][3], grow = s->add ? w->near : -w->near;
    between_way turned = { .dim = 3, .length = w->length, .near = w->near };
    for (int k = 0; k < 3; k++) {
        int p = (k + 1) % 3, q = (k + 2) % 3;
        axis[0][k] = s->along[k], axis[2][k] = s->axis[k];
        axis[1][k] = s->axis[p] * s->along[q] - s->axis[q] * s->along[p];
    }
    for (int r = 0; r < 3; r++)
        for (int k = 0; k < 3; k++)
            turned.x[r] += axis[r][k] * (w->x[k] - s->centre[k]), turned.d[r] += axis[r][k] * w->d[k];
    prism (out, s, &turned, -0.5 * s->length - grow, 0.5 * s->length + grow);
    for (int i = 0; i < out->n; i++)
        for (int side = 0; side < 2; side++) {
            double n[3] = { 0 };
            for (int k = 0; k < 3; k++)
                for (int r = 0; r < 3; r++) n[k] += axis[r][k] * out->gap[i].normal[side][r];
            memcpy (out->gap[i].normal[side], n, sizeof n);
        }
}

void between_shape (between_gaps *out, const pg_shape *s, const between_way *w)
{
    chord c = { .t = { -INFINITY, INFINITY } };
    double grow = s->add ? w->near : -w->near;
    if (s->kind == PG_POLYGON) {
        polygon (out, s, w);
        return;
    }
    if (s->kind == PG_PRISM) {
        prism (out, s, w, s->low[2] - grow, s->high[2] + grow);
        return;
    }
    if (s->kind == PG_PLATE) {
        plate (out, s, w);
        return;
    }
    if (s->kind == PG_BOX)
        for (int k = 0; k < w->dim; k++) {
            double n[3] = { 0 };
            n[k] = -1, clip_plane (&c, w, n, grow - s->low[k]);
            n[k] = 1, clip_plane (&c, w, n, s->high[k] + grow);
        }
    else clip_round (&c, w, s->centre, s->kind == PG_CYLINDER ? s->axis : NULL, s->radius + grow);
    if (s->kind == PG_CYLINDER) {
        double from = 0, back[3];
        for (int k = 0; k < 3; k++) from += s->axis[k] * s->centre[k], back[k] = -s->axis[k];
        clip_plane (&c, w, back, grow - from);
        clip_plane (&c, w, s->axis, from + s->length + grow);
    }
    gaps_of (out, &c);
}

int between_convex (const pg_shape *s)
{
    if (s->kind == PG_POLYGON || s->kind == PG_PRISM) return polygon_convex (s);
    return s->kind == PG_BOX || s->kind == PG_DISK || s->kind == PG_CYLINDER || s->kind == PG_SPHERE;
}
