/* SPDX-License-Identifier: GPL-3.0-or-later
 * Utilisation and direction of a tip: of all directions the one in which the energy released is the
 * largest share of what the material takes there. With the same fracture energy in all directions that is
 * the direction of the largest hoop stress (Erdogan and Sih 1963), in closed form; else directions are
 * compared. Sliding is judged by the largest shear stress around the tip in the same way, where the scene
 * gives its energy. Along an imposed path both modes share the energy: J_I / G0 + J_II / G_II = 1 (Wu and
 * Reuter 1965). */
#include "facet_growth.h"
#include <math.h>

/* Length of the next facet. The first one of a closed crack, which turns away from it, is twice as long: a
 * ring that must end before the closed faces has no room around a shorter one. */
double facet_length (const facet_growth *g, const pg_tip_field *field)
{
    return (field->closed ? 2 : 1) * (g->length > 0 ? g->length : field->h);
}

/* Fracture limits at x, by the material of the nearest node; 0: no crack can grow there. */
int facet_limits (const break_loop *b, const double *x, double angle, pg_fracture_limits *out)
{
    const pg_problem *p = b->system.problem;
    long node = pg_nearest_find (b->growth->near, x, NULL, NULL);
    if (node < 0 || (p->bonds.exempt[PG_NODES] && p->bonds.exempt[PG_NODES][node])) return 0;
    const pg_criterion *c = &p->criterion[p->block[PG_NODES] ? p->block[PG_NODES][node] : 0];
    if (c->never || !c->type) return 0;
    c->type->fracture (c, x, angle, out);
    return out->energy > 0;
}

/* ---- directions ---------------------------------------------------------------------------------------- */
typedef struct {
    const break_loop *b;
    const pg_tip_field *field;
    double J, K[3], length;
    int    sliding;                                    /* 1: judged by the shear stress and its energy */
} view;

/* Square root of the energy released over that taken, for a facet at `theta` from e; the limits are those of
 * its middle. K_theta of the circumferential stress: cos (t/2) (K_I cos^2 (t/2) - 3/2 K_II sin t), of the
 * shear stress cos (t/2)/2 (K_I sin t + K_II (3 cos t - 1)). */
static double share (const view *v, double theta)
{
    const double *e = v->field->e, *K = v->K;
    double c = cos (0.5 * theta), angle = atan2 (e[1], e[0]) + theta, size = K[0] * K[0] + K[1] * K[1];
    double k = v->sliding ? fabs (0.5 * c * (K[0] * sin (theta) + K[1] * (3 * cos (theta) - 1)))
                          : c * (K[0] * c * c - 1.5 * K[1] * sin (theta));
    double x[3] = { v->field->x[0] + 0.5 * v->length * cos (angle),
                    v->field->x[1] + 0.5 * v->length * sin (angle), 0 };
    pg_fracture_limits limits;
    if (!(k > 0) || !(size > 0) || !(v->J > 0) || !facet_limits (v->b, x, angle, &limits)) return 0;
    double taken = v->sliding ? limits.shear : limits.energy;
    return taken > 0 ? sqrt (v->J * k * k / size / taken) : 0;
}

enum { LOOKS = 81, THIRDS = 40 };
/* half range of directions that are tried, rad */
static const double fan = 80.0 / 180 * 3.14159265358979323846;

/* Finds the best of the directions within 80 degrees to both sides, refined by golden sections; returns its
 * share. */
static double best (const view *v, double *theta)
{
    static const double golden = 0.61803398874989485;
    double top = 0, step = 2 * fan / (LOOKS - 1);
    *theta = 0;
    for (int k = 0; k < LOOKS; k++) {
        double at = -fan + k * step, value = share (v, at);
        if (value > top * (1 + 1e-12)) top = value, *theta = at;
    }
    double low = *theta - step, high = *theta + step, a = high - golden * step * 2,
           c = low + golden * step * 2;
    double fa = share (v, a), fc = share (v, c);
    for (int k = 0; top > 0 && k < THIRDS; k++) {
        if (fa > fc) high = c, c = a, fc = fa, a = high - golden * (high - low), fa = share (v, a);
        else low = a, a = c, fa = fc, c = low + golden * (high - low), fc = share (v, c);
    }
    if (fmax (fa, fc) > top) top = fmax (fa, fc), *theta = fa > fc ? a : c;
    return top;
}

/* May fracture limits depend on direction, by expressions or by materials? */
static int may_be_uneven (const pg_problem *p)
{
    int uneven = p->nmaterial > 1;
    for (size_t m = 0; m < p->nmaterial; m++)
        uneven |= p->criterion[m].type && p->criterion[m].type->uneven (&p->criterion[m]);
    return uneven;
}

/* Do they depend on it around this tip? Two materials that meet elsewhere, or have the same limits, change no
 * direction. */
static int is_uneven (const view *v)
{
    enum { ANGLES = 17 };
    double first = NAN;
    if (!may_be_uneven (v->b->system.problem)) return 0;
    for (int k = 0; k < ANGLES; k++) {
        const double *e = v->field->e;
        double angle = atan2 (e[1], e[0]) + fan * (2.0 * k / (ANGLES - 1) - 1);
        double x[3] = { v->field->x[0] + 0.5 * v->length * cos (angle),
                        v->field->x[1] + 0.5 * v->length * sin (angle), 0 };
        pg_fracture_limits limits = { 0 };
        double energy = facet_limits (v->b, x, angle, &limits) ? limits.energy : 0;
        if (k == 0) first = energy;
        if (fabs (energy - first) > 1e-12 * fabs (first)) return 1;
    }
    return 0;
}

/* 1: the scene gives the energy of sliding; else no direction is tried for it. */
static int slides (const pg_problem *p, const double *x)
{
    int any = 0;
    for (size_t m = 0; m < p->nmaterial; m++) {
        const pg_criterion *c = &p->criterion[m];
        pg_fracture_limits limits = { 0 };
        if (!c->type || c->never) continue;
        c->type->fracture (c, x, 0, &limits);
        any |= limits.shear > 0;
    }
    return any;
}

/* Judges opening: closed form, or a comparison of directions. T: stress along the crack. Behind a kink the
 * load follows from the largest hoop stress, and the direction from the whole facet. */
static double opening (const view *v, int nfield, const double *l, double T, double *theta)
{
    double K_theta, G_theta;
    pg_fracture_limits limits;
    if (is_uneven (v)) return best (v, theta);
    if (!pg_kink (v->J, v->K[0], v->K[1], T, v->length, theta, &K_theta, &G_theta) || !(G_theta > 0))
        return 0;
    pg_kink_ahead (v->field, nfield, l, *theta, theta);
    double angle = atan2 (v->field->e[1], v->field->e[0]) + *theta;
    double x[3] = { v->field->x[0] + 0.5 * v->length * cos (angle),
                    v->field->x[1] + 0.5 * v->length * sin (angle), 0 };
    return facet_limits (v->b, x, angle, &limits) ? sqrt (G_theta / limits.energy) : 0;
}

/* ---- imposed path -------------------------------------------------------------------------------------- */
/* Follows the path over as many segments as the length needs; it ends with its last point. */
double facet_on_path (const double *path, size_t n, const double *x, const double *e, double length,
                      double *to, int *ends)
{
    size_t at = 0;
    double near = INFINITY, s = 0;
    for (size_t i = 0; i + 1 < n; i++) {
        double d, here = pg_segment_nearest (path + 2*i, path + 2*i + 2, x, NULL, &d);
        if (d < near) near = d, at = i, s = here;
    }
    const double *a = path + 2*at;
    int forward = (a[2] - a[0]) * e[0] + (a[3] - a[1]) * e[1] >= 0;
    to[0] = a[0] + s * (a[2] - a[0]), to[1] = a[1] + s * (a[3] - a[1]), to[2] = 0;
    *ends = 0;
    for (size_t next = forward ? at + 1 : at;; next += forward ? 1 : (size_t) -1) {
        double t[2] = { path[2*next] - to[0], path[2*next + 1] - to[1] }, d = hypot (t[0], t[1]);
        int last = forward ? next + 1 == n : next == 0;
        double part = d > length ? length / d : 1;
        to[0] += part * t[0], to[1] += part * t[1];
        length -= part * d;
        *ends = last && part >= 1;
        if (part < 1 || last || !(length > 0)) break;
    }
    return near;
}

/* Judges growth along the path: the energy of both modes is released along it, whatever direction the tip
 * would choose. */
static double along_path (const view *v, const double *path, size_t n, double *angle)
{
    double to[3];
    int ends;
    pg_fracture_limits limits;
    const double *x = v->field->x;
    facet_on_path (path, n, x, v->field->e, v->length, to, &ends);
    *angle = atan2 (to[1] - x[1], to[0] - x[0]);
    if (!(hypot (to[0] - x[0], to[1] - x[1]) > 1e-9 * v->length) || !(v->J > 0)) return 0;
    if (!facet_limits (v->b, to, *angle, &limits)) return 0;
    double size = v->K[0] * v->K[0] + v->K[1] * v->K[1], slide = size > 0 ? v->K[1] * v->K[1] / size : 0;
    double shear = limits.shear > 0 ? limits.shear : limits.energy;
    return sqrt (v->J * ((1 - slide) / limits.energy + slide / shear));
}

/* ---- a tip --------------------------------------------------------------------------------------------- */
double facet_judge (const break_loop *b, const pg_state *state, size_t tip, double factor, double *angle,
                    int *slide)
{
    const pg_problem *p = b->system.problem;
    const facet_growth *g = b->growth;
    const pg_tip_field *f = &g->field[tip];
    view v = { .b = b, .field = f, .length = facet_length (g, f) };
    double l[2], T, theta = 0, slip = 0, spare;
    int unused;
    size_t n;
    const double *path = p->criterion->type->path (p->criterion, &n);
    if (!angle) angle = &spare;
    if (!slide) slide = &unused;
    *angle = 0, *slide = 0;
    if (!state->paths->tip[tip].open || isnan (f->near)) return 0;
    pg_tip_combine (f, facet_factors (g, factor, l), l, &v.J, v.K, &T);
    if (path) return along_path (&v, path, n, angle);
    double top = opening (&v, g->nfield, l, T, &theta);
    v.sliding = 1;
    double sliding = slides (p, f->x) ? best (&v, &slip) : 0;
    if (sliding > top) top = sliding, theta = slip, *slide = 1;
    *angle = atan2 (f->e[1], f->e[0]) + theta;
    return top;
}
