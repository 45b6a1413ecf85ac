/* SPDX-License-Identifier: GPL-3.0-or-later
 * Obstacles ahead of a vertex of a 3D front: the surface of the body, a crack, another front. As in 2D
 * (solve/growth/facet_place.c), a vertex that would end within 1.5 spacings of the surface moves straight on
 * to it, as integrals around it have no room; one that would end within 0.6 spacings of a crack or front
 * moves there. */
#include "crack_surfaces.h"
#include <string.h>

static const double to_surface = 1.5, to_crack = 0.6;  /* spacings */
/* Range of the search for an oblique surface, spacings. */
static const double seen_to = 10;
/* Nearer hits, in spacings, belong to the vertex's own crack: redistributed vertices lie up to t (1 - t)^2 /
 * 2 = 0.074 behind the drawn outline of the crack, by the overshoot of the cubic. Another crack cannot be so
 * near, as vertices that would end within 0.6 spacings of it move there. */
static const double own = 0.15;

/* Distance, m, at which a ray meets the whole of a plane crack (without retreat); INFINITY: not within
 * `limit`, or parallel. */
static double ray_to_crack (const pg_crack *c, const double *x, const double *e, double limit, double h)
{
    const double *o = c->kind == PG_CRACK_DISC ? c->centre : c->vertex;
    double slope = pg_dot3 (c->normal, e), w[3], place[3];
    if (!(fabs (slope) > 1e-6)) return INFINITY;
    pg_shift3 (o, x, -1, w);
    double r = pg_dot3 (c->normal, w) / slope;
    if (!(r > own * h && r <= limit)) return INFINITY;
    pg_shift3 (x, e, r, place);
    pg_crack whole = *c;
    whole.retreat = NULL;
    return pg_crack_touches (&whole, 3, place, PG_NO_LENGTH * h) ? r : INFINITY;
}

/* Distance, m, to the first crack that a ray meets; bounding boxes exclude most cracks. */
static double ray_to_cracks (const pg_cracks *c, const double *x, const double *e, double limit, double h)
{
    double best = INFINITY;
    for (size_t k = 0; k < c->n; k++) {
        const double *box = c->box ? c->box + 6*k : NULL;
        int away = 0;
        for (int a = 0; a < 3 && box && !away; a++)
            away = fmin (x[a], x[a] + limit * e[a]) > box[3 + a] || fmax (x[a], x[a] + limit * e[a]) < box[a];
        if (!away) best = fmin (best, ray_to_crack (&c->crack[k], x, e, limit, h));
    }
    return best;
}

/* Finds the point of the segment a - b nearest to x; returns the distance, m. */
static double nearest_of (const double *a, const double *b, const double *x, double *place)
{
    double t[3], v[3];
    pg_shift3 (b, a, -1, t), pg_shift3 (x, a, -1, v);
    double size = pg_dot3 (t, t), s = size > 0 ? fmin (1, fmax (0, pg_dot3 (t, v) / size)) : 0;
    pg_shift3 (a, t, s, place);
    return pg_distance3 (place, x);
}

/* Returns 1: two segments of one front are near each other along it, or advance in similar directions, so
 * that they cannot meet. */
static int same_stretch (const pg_front *f, size_t i, size_t j, size_t next)
{
    size_t ring = i > j ? i - j : j - i;
    if (f->closed && f->n - ring < ring) ring = f->n - ring;
    return ring < 4 || pg_dot3 (f->ahead + 3*i, f->ahead + 3*j) > 0
           || pg_dot3 (f->ahead + 3*i, f->ahead + 3*next) > 0;
}

/* Finds the point ahead, of another front or another part of the vertex's own, nearest to `goal`; returns its
 * distance, m. */
static double to_fronts (const pg_crack_surfaces *w, size_t front, size_t i, const double *e,
                         const double *goal, double limit, double *place)
{
    const double *x = w->front[front].x + 3*i;
    double best = INFINITY, try[3], way[3];
    for (size_t g = 0; g < w->nfront; g++) {
        const pg_front *f = &w->front[g];
        for (size_t j = 0; f->open && j + !f->closed < f->n; j++) {
            size_t next = (j + 1) % f->n;
            if (g == front && same_stretch (f, i, j, next)) continue;
            double d = nearest_of (f->x + 3*j, f->x + 3*next, goal, try);
            pg_shift3 (try, x, -1, way);
            if (!(d <= limit && d < best) || !(pg_dot3 (way, e) > 0)) continue;
            best = d, memcpy (place, try, sizeof try);
        }
    }
    return best;
}

/* Approximates the line in which the surface cuts the plane of e and u by the ends of two rays from x at 30
 * degrees to both sides of e. foot: the point of that line nearest to x; along: its direction (unit, towards
 * u). Returns 0: a ray does not end within `limit`. */
int space_foot (const pg_ground *p, const double *x, const double *e, const double *u, double limit,
                double *foot, double *along)
{
    double c = sqrt (0.75), hit[2][3], way[3], d[3];
    for (int side = 0; side < 2; side++) {
        for (int k = 0; k < 3; k++) way[k] = c * e[k] + (side ? 0.5 : -0.5) * u[k];
        double r = pg_ground_way_out (p, x, way, limit);
        if (!(r < limit)) return 0;
        pg_shift3 (x, way, r, hit[side]);
    }
    pg_shift3 (hit[1], hit[0], -1, along), pg_shift3 (x, hit[0], -1, d);
    if (!pg_unit3 (along)) return 0;
    pg_shift3 (hit[0], along, pg_dot3 (d, along), foot);
    return 1;
}

/* Returns 1: vertex i passes the surface rather than approaching it: the surface is inclined by less than 45
 * degrees to e, or not found. */
static int passes_by (const pg_ground *p, const pg_front *f, size_t i, const double *e, double limit)
{
    double u[3], foot[3], along[3];
    pg_cross3 (f->ahead + 3*i, f->normal + 3*i, u);
    if (!pg_unit3 (u)) return 0;
    return !space_foot (p, f->x + 3*i, e, u, limit, foot, along) || fabs (pg_dot3 (along, e)) > sqrt (0.5);
}

double space_way (const pg_ground *p, const pg_crack_surfaces *w, size_t front, size_t i, const double *e,
                  double d, unsigned char *meets, double *place)
{
    const double *x = w->front[front].x + 3*i;
    double h = pg_ground_spacing_at (p, x), way = d, goal[3];
    *meets = PG_MEETS_NOTHING;
    double a = pg_ground_way_out (p, x, e, d + to_surface * h);
    if (a < d + to_surface * h && (a <= d || !passes_by (p, &w->front[front], i, e, seen_to * h)))
        way = a, *meets = PG_MEETS_SURFACE;
    double r = ray_to_cracks (&w->cracks, x, e, d + to_crack * h, h);
    if (r < way || (*meets == PG_MEETS_NOTHING && r <= d + to_crack * h)) way = r, *meets = PG_MEETS_CRACK;
    pg_shift3 (x, e, way, place);
    if (*meets != PG_MEETS_NOTHING) return way;
    memcpy (goal, place, sizeof goal);
    if (to_fronts (w, front, i, e, goal, to_crack * h, place) <= to_crack * h) *meets = PG_MEETS_CRACK;
    return pg_distance3 (place, x);
}

double space_end (const pg_ground *p, const pg_crack_surfaces *w, const double *x, const double *e,
                  double limit, unsigned char *meets)
{
    double h = pg_ground_spacing_at (p, x), a = pg_ground_way_out (p, x, e, limit);
    double r = ray_to_cracks (&w->cracks, x, e, limit, h);
    *meets = r < a ? PG_MEETS_CRACK : a < limit ? PG_MEETS_SURFACE : PG_MEETS_NOTHING;
    return fmin (r, a);
}
