/* SPDX-License-Identifier: GPL-3.0-or-later
 * Hot spots: points where the largest principal stress, averaged over a disc of one spacing, reaches the
 * strength at the smallest load factor, or the shear stress on some plane that of Coulomb. No crack through
 * such a point begins below it, so that most points need not be examined further. */
#include "facet_growth.h"
#include "hot_spot.h"
#include "perigal/vector.h"
#include <math.h>
#include <string.h>

enum { DISC = 7 };                                     /* sampling points of the disc */
static const double even = 0.02;  /* relative difference of load factors that counts as none */

double hot_strength_cap (double modulus, double energy, double h)
{
    return sqrt (modulus * energy / (8 * h));
}

int pg_strength_of (const pg_problem *p, size_t material, pg_strength *out)
{
    const pg_criterion *c = &p->criterion[material];
    const pg_material *m = &p->material[material];
    pg_fracture_limits limits = { .strength = NAN, .cohesion = NAN };
    double x[3] = { 0 }, modulus = p->dim == 3 ? m->E : m->modulus;
    if (!c->type || c->never || !pg_criterion_of_tips (c)) return 0;
    for (int k = 0; k < p->dim; k++) x[k] = 0.5 * (p->cloud.low[k] + p->cloud.high[k]);
    c->type->fracture (c, x, 0, &limits);
    out->asked = limits.strength, out->cohesion = limits.cohesion;
    out->in_use = fmin (limits.strength, hot_strength_cap (modulus, limits.energy, p->cloud.h));
    out->cohesion_in_use = fmin (limits.cohesion, hot_strength_cap (modulus, limits.shear, p->cloud.h));
    out->zone = modulus * limits.energy / (limits.strength * limits.strength);
    out->shear_zone = modulus * limits.shear / (limits.cohesion * limits.cohesion);
    return limits.strength > 0 || limits.cohesion > 0;
}

/* ---- stress -------------------------------------------------------------------------------------------- */
/* Smallest lambda >= 0 at which w m + R reaches f, m the mean of the principal stresses and R half their
 * difference, a linear polynomial and the root of a quadratic one, so that (f - w m)^2 = R^2 with w m <= f. w
 * = 1: the largest principal stress. */
static double strength_factor (const affine_stress *s, double f, double w)
{
    const double *c = s->constant, *d = s->slope;
    double m0 = 0.5 * w * (c[0] + c[1]), m1 = 0.5 * w * (d[0] + d[1]), d0 = 0.5 * (c[0] - c[1]),
           d1 = 0.5 * (d[0] - d[1]), t0 = c[2], t1 = d[2];
    double C = (f - m0) * (f - m0) - d0 * d0 - t0 * t0, B = -(f - m0) * m1 - d0 * d1 - t0 * t1,
           A = m1 * m1 - d1 * d1 - t1 * t1, least = INFINITY;
    if (m0 + hypot (d0, t0) >= f) return 0;
    double disc = B * B - A * C;                       /* discriminant of A lambda^2 + 2 B lambda + C */
    if (disc < 0) return INFINITY;
    double q = -(B + copysign (sqrt (disc), B));
    double root[2] = { A != 0 ? q / A : INFINITY, q != 0 ? C / q : INFINITY };
    for (int k = 0; k < 2; k++)
        if (root[k] > 0 && root[k] < least && m0 + root[k] * m1 <= f * (1 + 1e-9)) least = root[k];
    return least;
}

/* Load factor of shear failure: R + m sin phi = c cos phi on the planes at 45 degrees - phi/2 to the largest
 * pressure. */
double hot_shear_factor (const affine_stress *s, double c, double slope)
{
    double cosine = 1 / sqrt (1 + slope * slope);
    return strength_factor (s, c * cosine, slope * cosine);
}

/* Load factor at which tension or shear reaches its strength first; *slides 1: shear. */
static double reached (const affine_stress *s, const pg_fracture_limits *limits, int *slides)
{
    double tension = limits->strength > 0 ? strength_factor (s, limits->strength, 1) : INFINITY,
           shear = limits->cohesion > 0 ? hot_shear_factor (s, limits->cohesion, limits->slope) : INFINITY;
    *slides = shear < tension;
    return *slides ? shear : tension;
}

/* Angle (rad, from x) of a crack across the largest principal stress. */
static double crack_angle (const affine_stress *s, double lambda)
{
    double v[3];
    for (int k = 0; k < 3; k++) v[k] = s->constant[k] + lambda * s->slope[k];
    return 0.5 * atan2 (2 * v[2], v[0] - v[1]) + 0.5 * acos (-1);
}

/* Stress as a function of the load factor, constant + lambda slope, from the stresses of the fields (xx,
 * yy, xy): with two fields they are those at factors 0 and 1, with one the load is proportional. */
static affine_stress affine_of (const trial_fields *f, const double *first, const double *second)
{
    affine_stress s = { { 0 }, { 0 } };
    for (int k = 0; k < 3; k++) {
        if (f->n == 2) s.constant[k] = first[k], s.slope[k] = second[k] - first[k];
        else s.slope[k] = first[k];
    }
    return s;
}

/* Stress at n points (n x 2), averaged over each `count` successive ones that lie in the body; n / count
 * results. */
pg_status hot_stress (const search *g, size_t n, size_t count, const double *x, affine_stress *out)
{
    pg_status status = PG_OK;
    const pg_system *s = g->w->system;
    double *u = NULL, *stress[2] = { NULL, NULL };
    if (!s->force->sample)
        PG_FAIL (PG_E_USAGE, "the force %s tells no stress at a place", s->force->method.name);
    PG_ALLOC (u, 3 * n);
    for (int a = 0; a < g->f->n; a++) {
        PG_ALLOC (stress[a], 6 * n);
        PG_TRY (s->force->sample (s->self, g->state, g->f->d[a], n, x, u, stress[a], NULL));
    }
    for (size_t i = 0; i < n / count; i++) {
        double sum[2][3] = { { 0 } };
        int inside = 0;
        for (size_t q = i * count; q < (i + 1) * count; q++) {
            double place[3] = { x[2*q], x[2*q + 1], 0 };
            /* where none lies in the body the last one stands for all */
            int last = q + 1 == (i + 1) * count && !inside;
            if (!pg_problem_has_body (s->problem, place) && !last) continue;
            inside++;
            for (int a = 0; a < g->f->n; a++)
                sum[a][0] += stress[a][6*q], sum[a][1] += stress[a][6*q + 1], sum[a][2] += stress[a][6*q + 3];
        }
        for (int a = 0; a < 2; a++) for (int k = 0; k < 3; k++) sum[a][k] /= inside;
        out[i] = affine_of (g->f, sum[0], sum[1]);
    }
done:
    pg_free (u), pg_free (stress[0]), pg_free (stress[1]);
    return status;
}

/* Limits of a crack at that angle at x: energy in J/m^2, strength as far as the spacing resolves it; 0: none
 * can grow there, or no strength is given. */
int hot_resists (const search *g, const double *x, double angle, double h, double modulus,
                    pg_fracture_limits *out)
{
    if (!g->limits (g->context, x, angle, out) || !(out->strength > 0 || out->cohesion > 0)) return 0;
    if (out->strength > 0) out->strength = fmin (out->strength, hot_strength_cap (modulus, out->energy, h));
    if (out->cohesion > 0) out->cohesion = fmin (out->cohesion, hot_strength_cap (modulus, out->shear, h));
    return out->energy > 0;
}

/* ---- hot spots ----------------------------------------------------------------------------------------- */
int hot_excluded (const search *g, const double *x, double h)
{
    const pg_problem *p = g->w->system->problem;
    const pg_crack_paths *paths = g->state->paths;
    size_t n;
    const pg_front *front = pg_fronts_of_state (p, g->state, &n);
    for (size_t i = 0; paths && i < paths->ntip; i++) {
        const pg_tip *t = &paths->tip[i];
        if (t->open && hypot (x[0] - t->x[0], x[1] - t->x[1]) < HOT_APART * h) return 1;
    }
    for (size_t k = 0; k < n; k++)
        for (size_t i = 0; front[k].open && i < front[k].n; i++)
            if (pg_distance3 (x, front[k].x + 3*i) < HOT_APART * h) return 1;
    return pg_cracks_touch (pg_state_cracks (p, g->state), x, 1.5 * h) != NULL;
}

/* Load factor at which every node reaches its strength (n), by the stress at the node itself. */
static pg_status node_factors (const search *g, double *factor)
{
    pg_status status = PG_OK;
    const pg_system *s = g->w->system;
    const pg_problem *p = s->problem;
    double *stress[2] = { NULL, NULL };
    int components = 0;
    const char *unit;
    for (int a = 0; a < g->f->n; a++) {
        PG_ALLOC (stress[a], 6 * p->cloud.n);
        PG_TRY (s->force->field (s->self, g->state, g->f->d[a], "stress", &components, &unit, stress[a]));
    }
    size_t nv = (size_t) components;
    for (size_t i = 0; i < p->cloud.n; i++) {
        double x[3] = { p->cloud.x[2*i], p->cloud.x[2*i + 1], 0 }, h = pg_problem_spacing (p, PG_NODES, i);
        const double *first = stress[0] + nv * i, *second = g->f->n == 2 ? stress[1] + nv * i : first;
        pg_fracture_limits limits;
        int slides;
        factor[i] = INFINITY;
        affine_stress at = affine_of (g->f, first, second);
        if (p->bonds.exempt[PG_NODES][i]
            || !hot_resists (g, x, 0, h, pg_problem_law (p, PG_NODES, i)->modulus, &limits))
            continue;
        factor[i] = reached (&at, &limits, &slides);
        if (factor[i] < g->best && hot_excluded (g, x, h)) factor[i] = INFINITY;
    }
done:
    pg_free (stress[0]), pg_free (stress[1]);
    return status;
}

/* Averages the stress over a disc about a point, and finds the load factor at which that reaches the
 * strength. */
static pg_status average (const search *g, size_t node, hot_spot *out)
{
    pg_status status = PG_OK;
    const pg_problem *p = g->w->system->problem;
    double x[2 * DISC], sixth = acos (-1) / 3;
    pg_fracture_limits limits;
    for (int k = 0; k < DISC; k++) {
        /* the centre and six points around it */
        double r = k ? 0.35 * out->h : 0;
        x[2*k] = out->x[0] + r * cos (k * sixth), x[2*k + 1] = out->x[1] + r * sin (k * sixth);
    }
    PG_TRY (hot_stress (g, DISC, DISC, x, &out->stress));
    out->factor = INFINITY;
    out->material = pg_problem_law (p, PG_NODES, node), out->modulus = out->material->modulus;
    if (!hot_resists (g, out->x, 0, out->h, out->modulus, &limits)) goto done;
    out->factor = reached (&out->stress, &limits, &out->slides), out->slope = limits.slope;
    out->angle = isfinite (out->factor) ? crack_angle (&out->stress, out->factor) : 0;
done:
    return status;
}

/* Finds the point near a node that reaches its strength first, by averaged stresses: the best of the nodes
 * around, the middle of those that are equal. */
static pg_status settle (const search *g, size_t node, const double *factor, hot_spot *out)
{
    pg_status status = PG_OK;
    const pg_problem *p = g->w->system->problem;
    double h = pg_problem_spacing (p, PG_NODES, node), sum[2] = { 0, 0 };
    hot_spot best = { .factor = INFINITY };
    size_t equal = 0, near = node;
    for (int pass = 0; pass < 2; pass++)
        for (size_t j = 0; j < p->cloud.n; j++) {
            const double *x = p->cloud.x + 2*j, *y = p->cloud.x + 2 * node;
            hot_spot here = { .x = { x[0], x[1], 0 }, .h = h };
            if (hypot (x[0] - y[0], x[1] - y[1]) > 1.1 * h || isinf (factor[j])) continue;
            PG_TRY (average (g, j, &here));
            if (pass == 0 && here.factor < best.factor) best = here, near = j;
            if (pass == 0 || here.factor > best.factor * (1 + facet_tie)) continue;
            sum[0] += x[0], sum[1] += x[1], equal++;
        }
    *out = best;
    if (equal > 1) {
        out->x[0] = sum[0] / (double) equal, out->x[1] = sum[1] / (double) equal;
        PG_TRY (average (g, near, out));
    }
done:
    return status;
}

/* The node with the smallest factor below the best that is not near one of the spots; -1: none. Nodes at the
 * surface, where the same stress releases more energy, come first among about equal ones. */
static long next_node (const search *g, const double *factor, const unsigned char *rim, size_t n,
                       const hot_spot *spot)
{
    const pg_problem *p = g->w->system->problem;
    long found = -1;
    double least = INFINITY;
    for (size_t i = 0; i < p->cloud.n; i++) {
        const double *x = p->cloud.x + 2*i;
        double key = rim[i] ? (1 - 2 * even) * factor[i] : factor[i];
        int near = 0;
        if (!(factor[i] < g->best) || !(key < least)) continue;
        for (size_t k = 0; k < n && !near; k++)
            near = hypot (x[0] - spot[k].x[0], x[1] - spot[k].x[1]) < HOT_APART * spot[k].h;
        if (!near) least = key, found = (long) i;
    }
    return found;
}

/* 1: the body ends within a spacing h of a node, along one of the four axis directions. */
static int is_rim (const pg_problem *p, size_t i)
{
    double h = pg_problem_spacing (p, PG_NODES, i), quarter = 0.5 * acos (-1);
    for (int k = 0; k < 4; k++) {
        double x[3] = { p->cloud.x[2*i] + h * cos (k * quarter),
                        p->cloud.x[2*i + 1] + h * sin (k * quarter) };
        if (!pg_problem_has_body (p, x)) return 1;
    }
    return 0;
}

/* Finds up to `most` points with load factors below the best known one, each the first to reach its strength
 * among those around it, none within HOT_APART spacings of another. */
pg_status hot_spots (const search *g, size_t most, hot_spot *out, size_t *n)
{
    pg_status status = PG_OK;
    const pg_problem *p = g->w->system->problem;
    double *factor = NULL;
    unsigned char *rim = NULL;
    *n = 0;
    PG_ALLOC (factor, p->cloud.n);
    PG_ALLOC (rim, p->cloud.n);
    PG_TRY (node_factors (g, factor));
    for (size_t i = 0; i < p->cloud.n; i++) rim[i] = factor[i] < g->best && is_rim (p, i);
    while (*n < most) {
        long node = next_node (g, factor, rim, *n, out);
        if (node < 0) break;
        PG_TRY (settle (g, (size_t) node, factor, &out[*n]));
        ++*n;
    }
done:
    pg_free (factor), pg_free (rim);
    return status;
}
