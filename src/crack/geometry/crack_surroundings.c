/* SPDX-License-Identifier: GPL-3.0-or-later
 * Distances from a 2D tip to its surroundings: the surface of the body, found by rays (body_search.c), and
 * other cracks. */
#include "perigal/crack.h"
#include <math.h>
#include <string.h>

/* Number of rays of a search all around, and of bisections of the angle between two of them. */
enum { RAYS = 48, ANGLES = 30 };

/* Distance along the ray at which it meets the segment a - b, widened by `slack` at both ends (m); INFINITY:
 * nowhere. */
static double ray_to_segment (const double *x, const double *e, const double *a, const double *b,
                              double slack)
{
    double t[2] = { b[0] - a[0], b[1] - a[1] }, w[2] = { a[0] - x[0], a[1] - x[1] };
    double length = hypot (t[0], t[1]), det = e[0] * t[1] - e[1] * t[0];
    if (!(fabs (det) > 1e-12 * length)) return INFINITY;
    double r = (w[0] * t[1] - w[1] * t[0]) / det, s = (w[0] * e[1] - w[1] * e[0]) / det;
    return r >= -slack && s * length >= -slack && (s - 1) * length <= slack ? fmax (r, 0) : INFINITY;
}

/* All pieces but the one that ends in the tip are tested: a path may also meet itself. */
double pg_tip_ahead (const pg_ground *p, const pg_crack_paths *w, size_t tip, const double *e, double limit,
                     int *what)
{
    const pg_tip *t = &w->tip[tip];
    double r = pg_ground_way_out (p, t->x, e, limit);
    int met = r < limit ? PG_MEETS_SURFACE : PG_MEETS_NOTHING;
    for (size_t c = 0; c < w->cracks.n; c++) {
        const double *a = w->cracks.crack[c].vertex;
        if (c == t->segment) continue;
        double d = ray_to_segment (t->x, e, a, a + 2, w->nothing);
        /* the previous piece shares the vertex if the last one is negligibly short */
        if (w->path[c] == w->path[t->segment] && d <= w->nothing) continue;
        if (d < r) r = d, met = PG_MEETS_CRACK;
    }
    if (what) *what = met;
    return r;
}

/* The surface in one direction from a point: angle (rad), distance (m), position (m). */
typedef struct { double angle, way, place[2]; } sight;

static sight look (const pg_ground *p, const double *x, double angle, double limit)
{
    const double e[3] = { cos (angle), sin (angle), 0 };
    double way = pg_ground_way_out (p, x, e, limit);
    return (sight) { angle, way, { x[0] + way * e[0], x[1] + way * e[1] } };
}

/* Finds the nearest surface within `turn` (rad) of a direction by bisection of the angle, symmetrically. */
static sight closer (const pg_ground *p, const double *x, sight best, double turn, double limit)
{
    for (int i = 0; i < ANGLES; i++) {
        turn *= 0.5;
        sight left = look (p, x, best.angle + turn, limit), right = look (p, x, best.angle - turn, limit);
        const sight *less = left.way < right.way ? &left : &right;
        if (less->way < best.way) best = *less;
    }
    return best;
}

/* Direction (rad) of the nearest surface of the shapes, which may be the end of a slot missed by rays: minus
 * the gradient of the distance. Returns 0: none. */
static int towards_shapes (const pg_ground *p, const double *x, double *angle)
{
    double d[4], step = 1e-3 * pg_ground_spacing_at (p, x);
    for (int i = 0; i < 4; i++) {
        double at[3] = { x[0], x[1], 0 };
        at[i / 2] += i % 2 ? step : -step;
        pg_body_nearest (p->body, at, &d[i]);
    }
    *angle = atan2 (d[2] - d[3], d[0] - d[1]);
    return hypot (d[1] - d[0], d[3] - d[2]) > 0;
}

/* Keeps the nearer of two surface points; if equally near (to rounding), the one farther ahead; if also
 * equally far ahead, the surface point in the direction between them, such as a corner between two faces. */
static void keep_sight (const pg_ground *p, const double *x, const double *e, double limit, sight *best,
                        sight s)
{
    double same = pg_cloud_same (p->cloud), sum[2], farther = 0;
    if (s.way < best->way - same || s.way > best->way + same) {
        if (s.way < best->way) *best = s;
        return;
    }
    for (int k = 0; k < 2; k++)
        farther += (s.place[k] - best->place[k]) * e[k], sum[k] = s.place[k] + best->place[k] - 2 * x[k];
    if (farther > same) *best = s;
    if (fabs (farther) > same || !(hypot (sum[0], sum[1]) > same)) return;
    sight middle = look (p, x, atan2 (sum[1], sum[0]), limit);
    if (middle.way < limit) memcpy (best->place, middle.place, sizeof best->place);
}

/* Finds the nearest point of the surface, m: rays all around, refined about each local minimum. Rays start in
 * direction e, so that results do not depend on rotations of the body. */
static double nearest_of_surface (const pg_ground *p, const double *x, const double *e, double limit,
                                  double *place)
{
    double first = atan2 (e[1], e[0]), turn = 2 * acos (-1) / RAYS, away, angle;
    const double middle[3] = { x[0], x[1], 0 };
    sight ray[RAYS], best = { .way = limit };
    /* quick test for shapes: the surface is far away */
    if (p->body->n && (pg_body_nearest (p->body, middle, &away), away >= limit)) return limit;
    for (int i = 0; i < RAYS; i++) ray[i] = look (p, x, first + i * turn, limit);
    for (int i = 0; i < RAYS; i++) {
        double beside = fmin (ray[(i + 1) % RAYS].way, ray[(i + RAYS - 1) % RAYS].way);
        if (ray[i].way < limit && ray[i].way <= beside)
            keep_sight (p, x, e, limit, &best, closer (p, x, ray[i], turn, limit));
    }
    if (p->body->n && towards_shapes (p, x, &angle)) {
        sight shape = look (p, x, angle, limit);
        if (shape.way < limit) keep_sight (p, x, e, limit, &best, closer (p, x, shape, turn, limit));
    }
    if (best.way < limit) memcpy (place, best.place, sizeof best.place);
    return best.way;
}

/* The nearest obstacle found around a point: distance and position, m; what: PG_MEETS_.... */
typedef struct { double distance, place[2]; int what; } found;

/* Keeps the nearer of two obstacles; if equally near (within `same`, m), the one farther ahead. */
static void keep_nearer (found *f, const double *e, double same, double distance, const double *place,
                         int what)
{
    double farther = (place[0] - f->place[0]) * e[0] + (place[1] - f->place[1]) * e[1];
    int as_near = fabs (distance - f->distance) <= same && f->what != PG_MEETS_NOTHING;
    if (as_near ? farther > same : distance < f->distance)
        *f = (found) { fmin (distance, f->distance), { place[0], place[1] }, what };
}

/* Nearest of other paths, other open tips, and the surface. The tip's own path is excluded; its branches are
 * included if branches = 1. */
static found nearest_about (const pg_ground *p, const pg_crack_paths *w, size_t tip, const double *x,
                            double limit, int branches)
{
    const pg_tip *t = &w->tip[tip];
    found best = { limit, { x[0], x[1] }, PG_MEETS_NOTHING };
    double q[2] = { 0 }, from[2], e[2], d, same = pg_cloud_same (p->cloud);
    pg_tip_chord (w, tip, w->nothing, from, e);
    for (size_t c = 0; c < w->cracks.n; c++) {
        const double *a = w->cracks.crack[c].vertex;
        int own = w->path[c] == w->path[t->segment];
        if (own && !branches) continue;
        pg_segment_nearest (a, a + 2, x, q, &d);
        if (own && (!(d < best.distance + same) || pg_tip_passes (w, tip, c))) continue;
        keep_nearer (&best, e, same, d, q, PG_MEETS_CRACK);
    }
    for (size_t i = 0; i < w->ntip; i++) {
        const pg_tip *o = &w->tip[i];
        if (i != tip && o->open)
            keep_nearer (&best, e, same, hypot (o->x[0] - x[0], o->x[1] - x[1]), o->x, PG_MEETS_CRACK);
    }
    d = nearest_of_surface (p, x, e, fmin (limit, best.distance + 2 * same), q);
    if (d < fmin (limit, best.distance + 2 * same)) keep_nearer (&best, e, same, d, q, PG_MEETS_SURFACE);
    return best;
}

double pg_tip_nearest (const pg_ground *p, const pg_crack_paths *w, size_t tip, double limit, double *place,
                       int *what)
{
    found f = nearest_about (p, w, tip, w->tip[tip].x, limit, 0);
    if (place) place[0] = f.place[0], place[1] = f.place[1];
    if (what) *what = f.what;
    return f.distance;
}

double pg_path_room (const pg_ground *p, const pg_crack_paths *w, size_t tip, const double *x, double limit)
{
    return nearest_about (p, w, tip, x, limit, 1).distance;
}
