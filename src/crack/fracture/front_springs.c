/* SPDX-License-Identifier: GPL-3.0-or-later
 * Springs that act on points within the rings of a tip, or in the tube around a front. A spring of stiffness
 * k whose other end is at g pulls a point with the force - k (u - g): a body force that follows the
 * displacement, so that it has the term of body forces in J and in the interaction integrals, summed over the
 * points instead of integrated. It needs the displacement and its gradient at the points. In 3D each point
 * contributes to the nearest cross section (equally to several equally near ones), divided by the length of
 * front of that section.
 *
 * The exact fields grow without bound towards the tip, where a point may lie. Therefore the force of a point
 * is spread over a disc of the size of the point's volume. */
#include "front.h"
#include <math.h>
#include <string.h>

enum { DISC_RADII = 2, DISC_ANGLES = 8 };              /* integration points of a disc */
static const double pi = 3.14159265358979323846;

/* A point with a spring: load and index in its set; size: radius of the point's volume, m. */
typedef struct { const pg_load *load; size_t at; double size; } pull;

/* All points with springs, as points of cross sections; area: share over the length of front, 1/m. A point
 * with several springs appears several times. */
typedef struct { front_places q; pull *pull; size_t capacity; } pulls;

static size_t point_of (const pull *one) { return (size_t) one->load->set->point[one->at]; }

/* Polar coordinates of x in the slice of a cross section; returns the distance from its centre, m; INFINITY:
 * outside the slice or the tube. */
static double place_in (const measuring *m, const cross_section *s, const double *x, double *r, double *theta)
{
    double y[3] = { 0 };
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < m->p->dim; k++) y[i] += s->at.frame[3*i + k] * (x[k] - s->at.x[k]);
    double most = m->radius[m->p->dim == 3 ? FRONT_RADII - 1 : s->radii - 1];
    *r = hypot (y[0], y[1]), *theta = atan2 (y[1], y[0]);
    return *r >= most || fabs (y[2]) > 0.75 * s->length ? INFINITY : hypot (*r, y[2]);
}

/* Appends a spring to the nearest cross sections; only counts if the arrays are not yet allocated. */
static void add_nearest (const measuring *m, const pull *one, pulls *out)
{
    const double *x = m->p->cloud.x + point_of (one) * (size_t) m->p->dim;
    double nearest = INFINITY, same = pg_cloud_same (&m->p->cloud), r, theta;
    size_t first = out->q.n;
    for (size_t j = 0; j < m->n; j++)
        nearest = fmin (nearest, place_in (m, &m->section[j], x, &r, &theta));
    for (size_t j = 0; j < m->n && isfinite (nearest); j++) {
        if (place_in (m, &m->section[j], x, &r, &theta) > nearest + same) continue;
        size_t k = out->q.n++;
        if (k >= out->capacity) continue;
        out->q.r[k] = r, out->q.theta[k] = theta, out->q.of[k] = j, out->pull[k] = *one;
        memcpy (out->q.x + k * (size_t) m->p->dim, x, (size_t) m->p->dim * sizeof *x);
    }
    for (size_t k = first; k < out->q.n && k < out->capacity; k++)
        out->q.area[k] = 1 / ((double) (out->q.n - first) * m->section[out->q.of[k]].length);
}

static void add_all (const measuring *m, pulls *out)
{
    const pg_problem *p = m->p;
    out->q.n = 0;
    for (size_t l = 0; l < p->boundary.nload; l++) {
        pull one = { .load = &p->boundary.load[l] };
        if (one.load->kind != PG_SPRING) continue;
        for (; one.at < one.load->set->npoint; one.at++) {
            double volume = p->cloud.volume[point_of (&one)];
            one.size = p->dim == 3 ? cbrt (0.75 / pi * volume) : sqrt (volume / (pi * p->cloud.thickness));
            if (pg_load_share (one.load, one.at) > 0) add_nearest (m, &one, out);
        }
    }
}

/* Gradient of an exact field at r, theta, as the mean over a disc, mirrored at the crack so that it does not
 * cross it. */
static void mean_gradient (int field, const tip_material *m, double r, double theta, double size, double *A)
{
    double x = r * cos (theta), y = r * sin (theta), at[DISC_RADII], w[DISC_RADII], H[9];
    memset (A, 0, 9 * sizeof *A);
    if (!front_has (m, field)) return;
    pg_gauss_rule (DISC_RADII, at, w);
    for (int i = 0; i < DISC_RADII; i++)
        for (int j = 0; j < DISC_ANGLES; j++) {
            /* points equidistant in the square of the radius represent equal areas */
            double away = size * sqrt (0.5 * (1 + at[i])), angle = 2 * pi * (j + 0.5) / DISC_ANGLES;
            double a = x + away * cos (angle), b = y + away * sin (angle);
            if (a < 0 && b * y < 0) b = -b;
            front_near_field (field, m, hypot (a, b), atan2 (b, a), NULL, H, NULL);
            for (int k = 0; k < 9; k++) A[k] += 0.5 * w[i] / DISC_ANGLES * H[k];
        }
}

/* Force of the springs of point i at x with displacement u, N, in the frame. */
static void pull_of (const measuring *m, const pg_load *load, size_t i, const double *x, const double *u,
                     int at, const double *frame, double *force)
{
    const double *site = pg_load_site (load, x);
    double scene[3] = { 0 };
    for (int c = 0; c < m->p->dim; c++) {
        if (!(load->stiffness[c] > 0)) continue;
        double end = pg_load_value (load, c, m->p->dim, site, m->t[at]);
        if (at > 0) end -= pg_load_value (load, c, m->p->dim, site, m->t[0]);
        scene[c] = -load->stiffness[c] * pg_load_share (load, i) * (u[c] - end);
    }
    front_turn_vector (frame, scene, force);
}

/* Returns 1 and zeroes the fields: the point has no neighbours (on a crack) and no gradient, so that its
 * spring force does not act on the body. */
static int is_alone (front_sample *f, size_t k)
{
    double sum = f->excess ? f->excess[k] : 0;
    for (size_t c = 0; c < 3; c++) sum += f->u[3*k + c];
    for (size_t c = 0; c < 9; c++) sum += f->H[9*k + c] + f->S[9*k + c];
    if (isfinite (sum)) return 0;
    memset (f->u + 3*k, 0, 3 * sizeof *f->u);
    memset (f->H + 9*k, 0, 9 * sizeof *f->H), memset (f->S + 9*k, 0, 9 * sizeof *f->S);
    if (f->excess) f->excess[k] = 0;
    return 1;
}

pg_status springs_add (const measuring *m)
{
    pg_status status = PG_OK;
    pulls s = { .pull = NULL };
    front_places *q = &s.q;
    add_all (m, &s);
    size_t n = q->n;
    if (!n) return PG_OK;
    PG_TRY (places_create (q, n));
    PG_ALLOC (s.pull, n);
    s.capacity = n;
    add_all (m, &s);
    for (int a = 0; a < m->nfield; a++) {
        front_sample *f = &q->field[a];
        PG_ALLOC (f->load, 3 * n);
        PG_TRY (places_sample (q, m, a));
        for (size_t k = 0; k < n; k++) {
            if (!is_alone (f, k))
                pull_of (m, s.pull[k].load, s.pull[k].at, q->x + k * (size_t) m->p->dim, f->u + 3*k, a,
                         m->section[q->of[k]].at.frame, f->load + 3*k);
            places_part (q, m, a, k);
        }
    }
    for (size_t k = 0; k < n; k++) {
        cross_section *at = &m->section[q->of[k]];
        double A[FRONT_FIELDS][9];
        for (int x = 0; x < FRONT_FIELDS; x++)
            mean_gradient (x, &at->material, q->r[k], q->theta[k], s.pull[k].size, A[x]);
        front_force_integrals (&at->sums, m, at, q, k, A);
    }
done:
    places_clear (q);
    pg_free (s.pull);
    return status;
}

/* ---- as a body force ----------------------------------------------------------------------------------- */
pg_status springs_spread (front_places *q, const measuring *m, int at)
{
    pg_status status = PG_OK;
    const pg_problem *p = m->p;
    front_sample *f = &q->field[at];
    size_t springs = 0, *of = NULL;
    pg_nearest *near = NULL;
    for (size_t l = 0; l < p->boundary.nload; l++) springs += p->boundary.load[l].kind == PG_SPRING;
    if (!springs) return PG_OK;
    PG_TRY (pg_nearest_create (&near, p->dim, p->cloud.n, p->cloud.x));
    PG_ALLOC (of, p->cloud.n);
    if (!f->load) PG_ALLOC (f->load, 3 * q->capacity);
    for (size_t l = 0; l < p->boundary.nload; l++) {
        const pg_load *load = &p->boundary.load[l];
        if (load->kind != PG_SPRING) continue;
        memset (of, 0, p->cloud.n * sizeof *of);       /* 1 + index in the set */
        for (size_t i = 0; i < load->set->npoint; i++) of[load->set->point[i]] = 1 + i;
        for (size_t k = 0; k < q->n; k++) {
            size_t node = (size_t) pg_nearest_find (near, q->x + 2*k, NULL, NULL);
            double force[3];
            if (!of[node]) continue;
            pull_of (m, load, of[node] - 1, q->x + 2*k, f->u + 3*k, at, m->section->at.frame, force);
            for (size_t c = 0; c < 2; c++) f->load[3*k + c] += force[c] / p->cloud.volume[node];
        }
    }
done:
    pg_nearest_free (&near), pg_free (of);
    return status;
}
