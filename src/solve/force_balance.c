/* SPDX-License-Identifier: GPL-3.0-or-later
 * Do forces and moments balance? Loads and reactions, with inertia and damping, should add up to nothing, and
 * so should their moments, since no motion of the body as a whole strains it: what they miss is what the
 * solver has left, or an error of the method. Sums are over loads and supports as the force tells them
 * (pg_work_balance), and are compared with the sum of the sizes of all forces at points. */
#include "solve.h"
#include <math.h>
#include <string.h>

/* Forces are also compared with this share of what a displacement of the size at hand would bear if it were
 * strain: of a motion as a whole nothing is left but rounding. In motion every so many steps are measured. */
static const double NOTHING = 1e-3;
enum { EVERY = 16 };

/* N, N m; size: sum of the sizes of forces; length: diagonal of the body, m. */
typedef struct { double force[3], moment[3], size, length; } sums;

static double norm (const double *v) { return sqrt (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }

/* Loads and supports; moments are told about places of their own. */
static void add_loads (const pg_problem *p, const pg_work_balance *w, sums *s)
{
    for (size_t l = 0; l < p->nload; l++) {
        const pg_load *load = &p->load[l];
        const double *R = w->reaction + 3 * l, *M = w->reaction + 3 * (p->nload + l), *at = load->about;
        if (load->kind == PG_ROTATION || load->kind == PG_MOMENT) continue;
        for (int k = 0; k < 3; k++) {
            int next = (k + 1) % 3, last = (k + 2) % 3;
            s->force[k] += R[k];
            s->moment[k] += M[k] + at[next] * R[last] - at[last] * R[next];
        }
    }
    for (size_t k = 0; k < w->npair; k++) s->size += fabs (w->force[k]);
}

/* Inertia and damping, whose forces at nodes act on the coefficients of shape functions that reproduce 1 and
 * x. */
static void add_resistance (const pg_system *s, const double *f, sums *out)
{
    const pg_cloud *c = &s->problem->cloud;
    size_t dim = (size_t) c->dim;
    for (size_t i = 0; i < c->n; i++) {
        double x[3] = { 0 }, F[3] = { 0 };
        if (!pg_owns (c->subdomain, i)) continue;
        for (size_t k = 0; k < dim; k++) x[k] = c->x[i * dim + k], F[k] = f[i * dim + k];
        for (int k = 0; k < 3; k++) {
            int next = (k + 1) % 3, last = (k + 2) % 3;
            out->force[k] += F[k], out->size += fabs (F[k]);
            out->moment[k] += x[next] * F[last] - x[last] * F[next];
        }
    }
}

/* What the largest displacement would bear as a strain: E u / L on the mean section, N; and L, m. */
static double elastic (const pg_system *s, const double *d, double *length)
{
    const pg_problem *p = s->problem;
    double square = 0, most[2] = { 0, 0 }, volume = 0;
    for (int k = 0; k < p->dim; k++) square += pow (p->cloud.high[k] - p->cloud.low[k], 2);
    *length = sqrt (square);
    for (size_t i = 0; i < s->ndof; i++) most[0] = fmax (most[0], fabs (d[i]));
    for (size_t m = 0; m < p->nmaterial; m++) most[1] = fmax (most[1], p->material[m].modulus);
    for (size_t i = 0; i < p->cloud.n; i++)
        if (pg_owns (p->cloud.subdomain, i)) volume += p->cloud.volume[i];
    if (p->cloud.subdomain && (pg_ranks_most (1, most) != PG_OK || pg_ranks_sum (1, &volume) != PG_OK))
        return NAN;
    return most[1] * most[0] / *length * volume / *length;
}

void force_balance (pg_system *s, const double *d, const pg_work_balance *w, const dynamics *dyn)
{
    const pg_problem *p = s->problem;
    sums all = { .length = 0 };
    long steps = s->report->steps;
    if (!w->reaction || pg_problem_rotations (p) || (dyn && !dyn->whole)) return;
    if (p->nplaten || s->excavated || (dyn && steps >= EVERY && steps % EVERY)) return;
    add_loads (p, w, &all);
    if (dyn) {
        memset (s->full, 0, s->ndof * sizeof *s->full);
        dyn->resist (dyn->context, d, s->full);
        add_resistance (s, s->full, &all);
    }
    if (p->cloud.subdomain && pg_ranks_sum (7, (double *) &all) != PG_OK) return;
    double size = all.size + NOTHING * elastic (s, d, &all.length);
    if (!(size > 0)) return;
    /* arms of forces that turn with finite displacements are not those of the places at rest */
    pg_statistics *r = s->report;
    r->balances++;
    r->balance_force = fmax (r->balance_force, norm (all.force) / size);
    if (p->method->shape_functions)
        r->balance_moment = fmax (r->balance_moment, norm (all.moment) / (size * all.length));
}

double pg_balance_allowed (const pg_statistics *r, const pg_problem *p)
{
    double penalty = 0;
    for (size_t l = 0; l < p->nload; l++)
        if (pg_load_prescribes (&p->load[l]) && p->load[l].essential == PG_ESSENTIAL_PENALTY)
            penalty = fmax (penalty, p->load[l].penalty);
    return fmax (fmax (1e-10, 10 * r->residual_max), 1e-14 * penalty);
}

void force_balance_warn (pg_statistics *r, const pg_problem *p)
{
    double allowed = pg_balance_allowed (r, p);
    if (r->balances == 0 || !(fmax (r->balance_force, r->balance_moment) > allowed)) return;
    pg_statistics_warn (r, "forces miss balance by %.2g, moments by %.2g of the loads (the solver leaves "
                           "%.2g): loads, reactions and inertia do not add up to nothing",
                        r->balance_force, r->balance_moment, allowed / 10);
}
