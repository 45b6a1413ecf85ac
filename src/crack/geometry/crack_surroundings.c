/* SPDX-License-Identifier: GPL-3.0-or-later
 * What lies around the tip of a crack in the plane: the surface of the body, which is met by rays
 * (body_search.c), and other cracks. */
#include "perigal/crack.h"
#include <math.h>
#include <string.h>

/* Rays of a search all around, and halvings of the angle between two of them. */
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

/* The piece that ends in the tip does not count, all others do: a path may also meet itself. */
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
        /* the piece before hangs on the same vertex when the last one has no length to speak of */
        if (w->path[c] == w->path[t->segment] && d <= w->nothing) continue;
        if (d < r) r = d, met = PG_MEETS_CRACK;
    }
    if (what) *what = met;
    return r;
}

/* What the surface is seen at in one direction: the angle, the way to it and the place. */
typedef struct { double angle, way, place[2]; } sight;

static sight look (const pg_ground *p, const double *x, double angle, double limit)
{
    const double e[3] = { cos (angle), sin (angle), 0 };
    double way = pg_ground_way_out (p, x, e, limit);
    return (sight) { angle, way, { x[0] + way * e[0], x[1] + way * e[1] } };
}

/* The nearest place within `turn` of a direction, by halves to both sides alike. */
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

/* The direction in which the nearest surface of the shapes lies, which may be the end of a slot that rays
 * pass by: against the slope of the distance. 0: there is none. */
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

/* Of places as near, but for rounding, the one that lies farther ahead counts; of two as far ahead what lies
 * along the sum of the ways to them, such as the corner between two faces, if there is anything. */
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

/* The nearest place of the surface: rays all around, then closer in about each that is shorter than the two
 * beside it. Rays begin in direction e, so that a body that is turned with its crack gives the same. */
static double nearest_of_surface (const pg_ground *p, const double *x, const double *e, double limit,
                                  double *place)
{
    double first = atan2 (e[1], e[0]), turn = 2 * acos (-1) / RAYS, away, angle;
    const double middle[3] = { x[0], x[1], 0 };
    sight ray[RAYS], best = { .way = limit };
    /* shapes know at once that their surface is far away */
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

/* What is found around a place. */
typedef struct { double distance, place[2]; int what; } found;

/* Of places as near, but for `same`, the one that lies farther ahead counts. */
static void keep_nearer (found *f, const double *e, double same, double distance, const double *place,
                         int what)
{
    double farther = (place[0] - f->place[0]) * e[0] + (place[1] - f->place[1]) * e[1];
    int as_near = fabs (distance - f->distance) <= same && f->what != PG_MEETS_NOTHING;
    if (as_near ? farther > same : distance < f->distance)
        *f = (found) { fmin (distance, f->distance), { place[0], place[1] }, what };
}

/* Other paths, other open tips, the surface. Of the tip's own path what lies behind does not count, and
 * branches of it as asked. */
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
