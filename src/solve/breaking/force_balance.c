/* SPDX-License-Identifier: GPL-3.0-or-later
 * Do forces and moments balance? Loads and reactions, with inertia and damping, should add up to nothing, and
 * so should their moments, since no motion of the body as a whole strains it: what they miss is what the
 * solver has left, or an error of the method. Sums are over loads and supports as the force tells them
 * (pg_work_balance) and over what else acts on nodes: inertia, damping, contact. They are compared with the
 * sum of the sizes of all these forces; where these are next to none (a load that has returned to zero, free
 * strains that nothing hinders) with what the residual is compared with (refinement.c). */
#include "solve/run/solve.h"
#include "perigal/vector.h"
#include <float.h>
#include <math.h>

/* Dynamics: one in so many steps is measured. */
enum { EVERY = 16 };
/* Forces that balance to this share of them, by a direct solver, are in balance. */
static const double BALANCED = 1e-10;

/* N, N m; size: sum of the sizes of forces; length: diagonal of the body, m. */
typedef struct { double force[3], moment[3], size, length; } sums;

/* Adds loads and supports, whose moments are about points of their own. */
static void add_loads (const pg_problem *p, const pg_work_balance *w, sums *s)
{
    for (size_t l = 0; l < p->boundary.nload; l++) {
        const pg_load *load = &p->boundary.load[l];
        const double *R = w->reaction + 3 * l, *M = w->reaction + 3 * (p->boundary.nload + l),
                     *at = load->about;
        if (load->kind == PG_ROTATION || load->kind == PG_MOMENT) continue;
        for (int k = 0; k < 3; k++) {
            int next = (k + 1) % 3, last = (k + 2) % 3;
            s->force[k] += R[k];
            s->moment[k] += M[k] + at[next] * R[last] - at[last] * R[next];
        }
    }
    for (size_t k = 0; k < w->npair; k++) s->size += fabs (w->force[k]);
}

/* Adds inertia, damping and contact, whose forces at nodes act on the coefficients of shape functions that
 * reproduce 1 and x. */
static void add_forces (const pg_system *s, const double *f, sums *out)
{
    const pg_cloud *c = &s->problem->cloud;
    size_t dim = (size_t) c->dim, stride = (size_t) s->components;
    for (size_t i = 0; i < c->n; i++) {
        double x[3] = { 0 }, F[3] = { 0 };
        if (!pg_cloud_owns (c, i)) continue;
        for (size_t k = 0; k < dim; k++) x[k] = c->x[i * dim + k], F[k] = f[i * stride + k];
        for (int k = 0; k < 3; k++) {
            int next = (k + 1) % 3, last = (k + 2) % 3;
            out->force[k] += F[k], out->size += fabs (F[k]);
            out->moment[k] += x[next] * F[last] - x[last] * F[next];
        }
    }
}

/* What rounding leaves in the sum of the forces of the material at points, N: each is a difference of
 * forces as large as that of a displacement over a spacing, E u V / h^2, and roundings add up as squares.
 * Entries of K are up to some ten times larger, as are those of Nitsche's method at supports. */
static double rounding (const pg_system *s, const double *d)
{
    const pg_problem *p = s->problem;
    size_t dim = (size_t) p->dim;
    double sum = 0;
    for (size_t i = 0; i < p->cloud.n; i++) {
        double u = 0, h = pg_problem_spacing (p, PG_NODES, i);
        if (!pg_cloud_owns (&p->cloud, i)) continue;
        for (size_t k = 0; k < dim; k++) u = fmax (u, fabs (d[i * (size_t) s->components + k]));
        double f = pg_problem_law (p, PG_NODES, i)->modulus * u * p->cloud.volume[i] / (h * h);
        sum += f * f;
    }
    if (pg_cloud_sum (&p->cloud, 1, &sum) != PG_OK) return NAN;
    return 50 * DBL_EPSILON * sqrt (sum);
}

int force_balance_due (const pg_system *s)
{
    return s->report->steps < EVERY || s->report->steps % EVERY == 0;
}

void force_balance (pg_system *s, const double *d, const pg_work_balance *w, const double *f)
{
    const pg_problem *p = s->problem;
    sums all = { .length = 0 };
    double square = 0;
    if (!w->reaction || !p->method) return;            /* no method: a force of the user, without materials */
    for (int k = 0; k < p->dim; k++) square += pow (p->cloud.high[k] - p->cloud.low[k], 2);
    add_loads (p, w, &all);
    if (f) add_forces (s, f, &all);
    if (pg_cloud_sum (&p->cloud, 7, (double *) &all) != PG_OK) return;
    all.length = sqrt (square);
    double size = all.size + rounding (s, d) / BALANCED;
    if (!(size > 0)) return;
    double missed = fmax (pg_size (3, all.force), pg_size (3, all.moment) / all.length);
    if (missed > BALANCED * size) size = fmax (size, fmax (s->balance.reference, s->balance.borne));
    /* moments are left out where lever arms change with finite displacements */
    pg_statistics *r = s->report;
    r->balance.states++;
    r->balance.force = fmax (r->balance.force, pg_size (3, all.force) / size);
    if (p->method->shape_functions)
        r->balance.moment = fmax (r->balance.moment, pg_size (3, all.moment) / (size * all.length));
}

double pg_balance_allowed (const pg_statistics *r, const pg_problem *p)
{
    double penalty = 0;
    for (size_t l = 0; l < p->boundary.nload; l++)
        if (pg_load_prescribes (&p->boundary.load[l])
            && p->boundary.load[l].essential == PG_ESSENTIAL_PENALTY)
            penalty = fmax (penalty, p->boundary.load[l].penalty);
    return fmax (fmax (BALANCED, 10 * r->residual_max), 1e-14 * penalty);
}

void force_balance_warn (pg_statistics *r, const pg_problem *p)
{
    double allowed = pg_balance_allowed (r, p);
    if (r->balance.states == 0 || !(fmax (r->balance.force, r->balance.moment) > allowed)) return;
    pg_statistics_warn (r, "forces miss balance by %.2g, moments by %.2g of the loads (the solver leaves "
                           "%.2g): loads, reactions, inertia and contact do not add up to nothing",
                        r->balance.force, r->balance.moment, allowed / 10);
}
