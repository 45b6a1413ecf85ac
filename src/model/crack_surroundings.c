/* SPDX-License-Identifier: GPL-3.0-or-later
 * What lies around the tip of a crack in the plane: the surface of the body, other cracks. Shapes, meshes and
 * points all answer one question only, whether a place has body (body_search.c): along a ray the first place
 * without is found in steps of an eighth of the spacing, and then by bisection. */
#include "model.h"
#include <math.h>

/* Steps of a ray in a spacing; halvings of the last one: 2^-44 of it is rounding. Rays of a search all
 * around: the nearest place of a straight surface lies between two of them, and golden sections find it. */
enum { STEPS = 8, HALVINGS = 44, RAYS = 48, SECTIONS = 30 };

/* The place at distance r in direction e. */
static void ray_at (const double *x, const double *e, double r, double *out)
{
    for (int k = 0; k < 2; k++) out[k] = x[k] + r * e[k];
    out[2] = 0;
}

/* Distance to the first place without body, at most `limit`. A tip within rounding of the surface has some
 * body to one side only, so the first step counts as a whole. */
static double ray_to_surface (const pg_problem *p, const double *x, const double *e, double limit)
{
    double step = pg_problem_spacing_at (p, x) / STEPS, near = 0, far, place[3];
    for (long i = 1; near < limit; i++, near = far) {
        far = fmin ((double) i * step, limit);
        ray_at (x, e, far, place);
        if (pg_problem_has_body (p, place)) continue;
        for (int k = 0; k < HALVINGS; k++) {
            double middle = 0.5 * (near + far);
            ray_at (x, e, middle, place);
            if (pg_problem_has_body (p, place)) near = middle;
            else far = middle;
        }
        return near;
    }
    return limit;
}

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
double pg_tip_ahead (const pg_problem *p, const pg_state *s, size_t tip, const double *e, double limit,
                     int *what)
{
    const pg_crack_paths *w = s->paths;
    const pg_tip *t = &w->tip[tip];
    double r = ray_to_surface (p, t->x, e, limit);
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

/* Distance to the surface at an angle. */
static double surface_at (const pg_problem *p, const double *x, double angle, double limit, double *place)
{
    double e[2] = { cos (angle), sin (angle) }, at[3], r = ray_to_surface (p, x, e, limit);
    ray_at (x, e, r, at);
    place[0] = at[0], place[1] = at[1];
    return r;
}

/* The nearest place of the surface: rays all around, then golden sections about the shortest of them. Rays
 * begin in direction e, so that a body that is turned with its crack gives the same. */
static double nearest_of_surface (const pg_problem *p, const double *x, const double *e, double limit,
                                  double *place)
{
    double first = atan2 (e[1], e[0]), turn = 2 * acos (-1) / RAYS, best = limit, at = 0, try[2];
    double middle[2] = { x[0], x[1] }, away;
    /* shapes know at once that their surface is far away */
    if (p->body.n && (pg_body_nearest (&p->body, middle, &away), away >= limit)) return limit;
    for (int i = 0; i < RAYS; i++) {
        double r = surface_at (p, x, first + i * turn, best, try);
        if (r < best) best = r, at = first + i * turn, place[0] = try[0], place[1] = try[1];
    }
    if (!(best < limit)) return limit;
    double low = at - turn, high = at + turn;
    for (int i = 0; i < SECTIONS; i++) {
        static const double golden = 0.3819660112501051;
        double l = low + golden * (high - low), h = high - golden * (high - low), other[2];
        double far = fmin (limit, 2 * best);
        double u = surface_at (p, x, l, far, try), v = surface_at (p, x, h, far, other);
        if (u < best) best = u, place[0] = try[0], place[1] = try[1];
        if (v < best) best = v, place[0] = other[0], place[1] = other[1];
        if (u <= v) high = h;
        else low = l;
    }
    return best;
}

/* What is found around a place. */
typedef struct { double distance, place[2]; int what; } found;

static void keep_nearer (found *f, double distance, const double *place, int what)
{
    if (!(distance < f->distance)) return;
    *f = (found) { distance, { place[0], place[1] }, what };
}

/* Other paths, other open tips, the surface. Of the tip's own path what lies behind does not count, and
 * branches of it as asked. */
static found nearest_about (const pg_problem *p, const pg_state *s, size_t tip, const double *x, double limit,
                            int branches)
{
    const pg_crack_paths *w = s->paths;
    const pg_tip *t = &w->tip[tip];
    found best = { limit, { x[0], x[1] }, PG_MEETS_NOTHING };
    double q[2] = { 0 }, from[2], e[2], d;
    for (size_t c = 0; c < w->cracks.n; c++) {
        const double *a = w->cracks.crack[c].vertex;
        int own = w->path[c] == w->path[t->segment];
        if (own && !branches) continue;
        pg_segment_nearest (a, a + 2, x, q, &d);
        if (own && (!(d < best.distance) || pg_tip_passes (s, tip, c))) continue;
        keep_nearer (&best, d, q, PG_MEETS_CRACK);
    }
    for (size_t i = 0; i < w->ntip; i++) {
        const pg_tip *o = &w->tip[i];
        if (i != tip && o->open)
            keep_nearer (&best, hypot (o->x[0] - x[0], o->x[1] - x[1]), o->x, PG_MEETS_CRACK);
    }
    pg_tip_chord (s, tip, w->nothing, from, e);
    d = nearest_of_surface (p, x, e, best.distance, q);
    keep_nearer (&best, d, q, PG_MEETS_SURFACE);
    return best;
}

double pg_tip_nearest (const pg_problem *p, const pg_state *s, size_t tip, double limit, double *place,
                       int *what)
{
    found f = nearest_about (p, s, tip, s->paths->tip[tip].x, limit, 0);
    if (place) place[0] = f.place[0], place[1] = f.place[1];
    if (what) *what = f.what;
    return f.distance;
}

double pg_path_room (const pg_problem *p, const pg_state *s, size_t tip, const double *x, double limit)
{
    return nearest_about (p, s, tip, x, limit, 1).distance;
}

double pg_tip_room (const pg_problem *p, const pg_state *s, size_t tip, double limit)
{
    return pg_tip_nearest (p, s, tip, limit, NULL, NULL);
}
