/* SPDX-License-Identifier: GPL-3.0-or-later
 * Before the first step: can the points that a load acts on bear it? Without shape functions a traction acts
 * on the outermost points (or those down to its depth), and a few bonds hold these on the rest: less than
 * bear the same stress inside the body, and they may tear off in the first step. What they bear follows from
 * one force: the loaded points are moved rigidly along what acts on them, the others stay, until the first
 * bond between the two is at its limit. Bodies give way around the points as well, and corners hold less: a
 * plate of glass (test/defects) tears at 0.77 of that load in statics, at 0.57 where it comes at once. Event
 * stepping goes no further than it breaks. */
#include "solve/run/solve.h"
#include <math.h>
#include <string.h>

/* Warn if a load is above this share of what its points bear at most: quasi-static; dynamic. */
static const double AT_REST = 0.7, IN_MOTION = 0.5;

/* load: external forces at t, N (ndof); hold: forces that hold the loaded points when these have moved by d
 * (ndof); moved: how far, m. */
typedef struct {
    const pg_problem *p;
    size_t dim, stride;
    double *load, *hold, *d, moved;
} loaded;

static int is_loaded (const loaded *w, size_t i)
{
    double sum = 0;
    for (size_t k = 0; k < w->dim; k++) sum += fabs (w->load[i * w->stride + k]);
    return sum > 0;
}

/* The largest utilisation of the bonds of point i that lead to points without a load. */
static double utilisation (const loaded *w, size_t i)
{
    const pg_problem *p = w->p;
    const pg_family *f = &p->bonds.rows[PG_NODES].family;
    const pg_criterion *c = pg_problem_limit (p, PG_NODES, i);
    double top = 0;
    if (p->bonds.exempt[PG_NODES] && p->bonds.exempt[PG_NODES][i]) return 0;
    for (size_t e = f->start[i]; e < f->start[i + 1]; e++) {
        size_t j = (size_t) f->node[e];
        double xi[3], eta[3], one = 1, u = 0;
        if (is_loaded (w, j) || (p->bonds.exempt[PG_NODES] && p->bonds.exempt[PG_NODES][j])) continue;
        for (size_t k = 0; k < w->dim; k++) {
            xi[k] = p->cloud.x[j * w->dim + k] - p->cloud.x[i * w->dim + k];
            eta[k] = w->d[j * w->stride + k] - w->d[i * w->stride + k];
        }
        pg_bond_measures m = { .n = 1, .dim = p->dim, .xi = xi, .eta = eta, .reach = &one };
        c->type->utilisation (c, &m, &u, NULL);
        top = fmax (top, u);
    }
    return top;
}

/* Returns the load on the points of a set over what they can bear; *acts: the load, N. 0: nothing holds these
 * points alone, or nothing breaks. */
static double share_of (const loaded *w, const pg_load *load, double *acts)
{
    double holds = 0, top = 0;
    *acts = 0;
    for (size_t n = 0; n < load->set->npoint; n++) {
        size_t i = (size_t) load->set->point[n];
        if (!is_loaded (w, i)) continue;
        for (size_t k = 0; k < w->dim; k++) {
            double way = w->d[i * w->stride + k] / w->moved;
            *acts += w->load[i * w->stride + k] * way, holds -= w->hold[i * w->stride + k] * way;
        }
        top = fmax (top, utilisation (w, i));
    }
    return holds > 0 ? *acts * top / holds : 0;
}

/* Warns of a load, with an estimate for the inside of the body: Young's modulus times the stretch at which a
 * bond breaks. */
static void tell (pg_statistics *report, const pg_problem *p, const pg_load *load, double acts, double share)
{
    const pg_criterion *c = p->criterion;
    double area = 0, square, e = c->type->elongation ? c->type->elongation (c, 1, &square) : NAN;
    for (size_t n = 0; n < load->set->nfacet; n++) area += p->cells.area[load->set->facet[n]];
    if (!(area > 0)) return;
    pg_statistics_warn (report,
                        "%.30s pulls with %.3g Pa at points that bear about %.2g (inside, E times the "
                        "critical stretch is %.3g): their bonds break and they tear off; lower it, give it a "
                        "depth, or failure.exclude: [%.30s]",
                        load->name, acts / area, acts / area / share, 0.5 * p->material->modulus * e,
                        load->set->name);
}

pg_status doubt_loaded_rows (pg_solver *s)
{
    pg_status status = PG_OK;
    pg_system *sys = &s->break_loop.system;
    const pg_problem *p = s->problem;
    const int rests = (s->options.flags & PG_SOLVER_QUASI_STATIC) != 0;
    const double t = rests ? 1 : s->options.end, most = rests ? AT_REST : IN_MOTION;
    loaded w = { p, (size_t) p->dim, (size_t) sys->components, NULL, NULL, NULL, 1e-6 * p->cloud.h };
    double *rest = NULL, unused;
    size_t any = 0;
    for (size_t l = 0; l < p->boundary.nload; l++)
        any += p->boundary.load[l].kind == PG_TRACTION || p->boundary.load[l].kind == PG_PRESSURE;
    if (!any || s->options.event || p->method->shape_functions || !pg_criterion_of_bonds (p->criterion)
        || p->criterion->type->needs != PG_NEEDS_STRETCH || system_is_shared (sys))
        return PG_OK;
    PG_ALLOC (w.load, sys->ndof);
    PG_ALLOC (w.hold, sys->ndof);
    PG_ALLOC (w.d, sys->ndof);
    PG_ALLOC (rest, sys->ndof);
    PG_TRY (sys->force->balance (sys->self, t, w.d, w.load, &unused));
    memcpy (rest, w.load, sys->ndof * sizeof *rest);
    for (size_t i = 0; i < p->cloud.n; i++) {
        double size = 0;
        for (size_t k = 0; k < w.dim; k++) size = hypot (size, w.load[i * w.stride + k]);
        for (size_t k = 0; size > 0 && k < w.dim; k++)
            w.d[i * w.stride + k] = w.moved * w.load[i * w.stride + k] / size;
    }
    PG_TRY (sys->force->balance (sys->self, t, w.d, w.hold, &unused));
    for (size_t i = 0; i < sys->ndof; i++) w.hold[i] -= rest[i];
    for (size_t l = 0; l < p->boundary.nload; l++) {
        const pg_load *load = &p->boundary.load[l];
        if (load->kind != PG_TRACTION && load->kind != PG_PRESSURE) continue;
        double acts, share = share_of (&w, load, &acts);
        if (share > most) tell (&s->report, p, load, acts, share);
    }
done:
    pg_free (w.load), pg_free (w.hold), pg_free (w.d), pg_free (rest);
    return status;
}
