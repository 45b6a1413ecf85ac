/* SPDX-License-Identifier: GPL-3.0-or-later
 * Springs on points in the tube around a front: their forces - k (u - g) are body forces at single places
 * (tip_springs.c), each in the cross section that it is nearest to, in equal shares where it is as near to
 * two, over the length of front that these stand for. */
#include "front.h"
#include "gradient_fit.h"
#include <math.h>
#include <string.h>

static const double pi = 3.14159265358979323846;

/* A point that a spring pulls. */
typedef struct {
    const pg_load *load;
    /* number within the set of the load; of cross sections */
    size_t at, section;
    double r, theta, size;                             /* in that section; radius of what belongs to it, m */
    double share;                                      /* of the force that acts in that section */
} pull;

/* Where x lies in the slice of a cross section; returns how far from its middle, INFINITY: not in it, or
 * outside its tube. */
static double place_in (const front_place *place, double h, const double *x, pull *out)
{
    double y[3] = { 0 };
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++) y[i] += place->frame[3*i + k] * (x[k] - place->x[k]);
    double r = hypot (y[0], y[1]);
    if (r >= front_radius[FRONT_RADII - 1] * h || fabs (y[2]) > 0.75 * place->speed / FRONT_SECTIONS)
        return INFINITY;
    out->r = r, out->theta = atan2 (y[1], y[0]);
    return hypot (r, y[2]);
}

/* Appends the pull on x in the section that is nearest, in equal shares where several are. */
static pg_status add_nearest (const front_springs *s, pull one, const double *x, pull **out, size_t *n,
                              size_t *cap)
{
    pg_status status = PG_OK;
    double nearest = INFINITY, same = pg_cloud_same (&s->p->cloud);
    size_t first = *n;
    for (size_t j = 0; j < s->n; j++) nearest = fmin (nearest, place_in (&s->place[j], s->h, x, &one));
    for (size_t j = 0; j < s->n && isfinite (nearest); j++) {
        if (place_in (&s->place[j], s->h, x, &one) > nearest + same) continue;
        PG_GROW (*out, *cap, *n + 1);
        one.section = j, (*out)[(*n)++] = one;
    }
    for (size_t k = first; k < *n; k++) (*out)[k].share = 1 / (double) (*n - first);
done:
    return status;
}

static pg_status find_pulls (const front_springs *s, pull **out, size_t *n)
{
    pg_status status = PG_OK;
    const pg_problem *p = s->p;
    size_t cap = 0;
    *n = 0;
    for (size_t l = 0; l < p->nload; l++) {
        const pg_load *load = &p->load[l];
        for (size_t i = 0; load->kind == PG_SPRING && i < load->set->npoint; i++) {
            size_t point = (size_t) load->set->point[i];
            pull one = { .load = load, .at = i, .size = cbrt (0.75 / pi * p->cloud.volume[point]) };
            if (!(pg_load_share (load, i) > 0)) continue;
            PG_TRY (add_nearest (s, one, p->cloud.x + 3 * point, out, n, &cap));
        }
    }
done:
    return status;
}

/* The gradient of an exact field around r, theta, as the mean over a disc that does not reach across the
 * crack. */
static void mean_gradient (int field, const tip_material *m, const pull *q, double *A)
{
    enum { RADII = 2, ANGLES = 8 };
    double x = q->r * cos (q->theta), y = q->r * sin (q->theta), at[RADII], w[RADII], H[9];
    memset (A, 0, 9 * sizeof *A);
    pg_gauss_rule (RADII, at, w);
    for (int i = 0; i < RADII; i++)
        for (int j = 0; j < ANGLES; j++) {
            double away = q->size * sqrt (0.5 * (1 + at[i])), angle = 2 * pi * (j + 0.5) / ANGLES;
            double a = x + away * cos (angle), b = y + away * sin (angle);
            if (a < 0 && b * y < 0) b = -b;
            front_near_field (field, m, hypot (a, b), atan2 (b, a), NULL, H, NULL);
            for (int k = 0; k < 9; k++) A[k] += 0.5 * w[i] / ANGLES * H[k];
        }
}

/* Force of a spring in field a, N, in the scene; u: displacement of its point. */
static void pull_of (const front_springs *s, const pull *q, int a, const double *x, const double *u,
                     double *force)
{
    const pg_load *load = q->load;
    const double *site = pg_load_site (load, x);
    for (int c = 0; c < 3; c++) {
        force[c] = 0;
        if (!(load->stiffness[c] > 0)) continue;
        double end = pg_load_value (load, c, 3, site, s->t[a]);
        if (a > 0) end -= pg_load_value (load, c, 3, site, s->t[0]);
        force[c] = -load->stiffness[c] * pg_load_share (load, q->at) * q->share * (u[c] - end);
    }
}

/* Adds one pull to the sums of its section; force and H (of each field) in the frame of that section. */
static void add_pull (const front_springs *s, const pull *q, const tip_material *m, double force[][3],
                      double H[][9])
{
    front_sums *out = &s->sums[q->section];
    double per_length = FRONT_SECTIONS / s->place[q->section].speed, A[FRONT_FIELDS][9];
    for (int x = 0; x < FRONT_FIELDS; x++) mean_gradient (x, m, q, A[x]);
    for (int i = 0; i < s->radii[q->section]; i++) {
        double Q = per_length * front_weight (q->r, s->h, front_radius[i] * s->h, NULL);
        for (int a = 0; a < s->nfield; a++) {
            for (int b = 0; b <= a; b++)
                for (int c = 0; c < 3; c++)
                    out->J[i][a][b] -= 0.5 * Q * (force[a][c] * H[b][3*c] + force[b][c] * H[a][3*c]);
            for (int x = 0; x < FRONT_FIELDS; x++)
                for (int c = 0; c < 3; c++) out->I[i][x][a] -= Q * force[a][c] * A[x][3*c];
        }
        out->J[i][0][1] = out->J[i][1][0];
    }
}

pg_status front_springs_add (const front_springs *s)
{
    pg_status status = PG_OK;
    pull *q = NULL;
    double *x = NULL, *u[TIP_FIELDS] = { NULL, NULL }, *gradient[TIP_FIELDS] = { NULL, NULL };
    size_t n;
    PG_TRY (find_pulls (s, &q, &n));
    if (!n) goto done;
    PG_ALLOC (x, 3 * n);
    for (size_t k = 0; k < n; k++)
        memcpy (x + 3*k, s->p->cloud.x + 3 * (size_t) q[k].load->set->point[q[k].at], 3 * sizeof *x);
    for (int a = 0; a < s->nfield; a++) {
        PG_ALLOC (u[a], 3 * n);
        PG_ALLOC (gradient[a], 9 * n);
        PG_TRY (gradient_sample (s->p, s->force, s->self, s->state, s->d[a].d, n, x, u[a], NULL,
                                 gradient[a]));
        for (size_t k = 0; k < n; k++) {
            double moved[3];
            mean_motion_at (&s->d[a], x + 3*k, 3, moved);
            for (size_t c = 0; c < 3; c++) u[a][3*k + c] += moved[c];
        }
    }
    for (size_t k = 0; k < n; k++) {
        const double *frame = s->place[q[k].section].frame;
        tip_material m = s->material (s->context, s->place[q[k].section].x);
        double force[TIP_FIELDS][3], H[TIP_FIELDS][9], pulled[3];
        for (int a = 0; a < s->nfield; a++) {
            pull_of (s, &q[k], a, x + 3*k, u[a] + 3*k, pulled);
            front_turn_vector (frame, pulled, force[a]);
            front_turn_tensor (frame, gradient[a] + 9*k, H[a]);
            s->part (s->context, a, q[k].section, &m, H[a]);
        }
        add_pull (s, &q[k], &m, force, H);
    }
done:
    pg_free (q), pg_free (x);
    for (int a = 0; a < TIP_FIELDS; a++) pg_free (u[a]), pg_free (gradient[a]);
    return status;
}
