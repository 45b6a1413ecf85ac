/* SPDX-License-Identifier: GPL-3.0-or-later
 * Points that lose all their bonds for good ("die") when their energy reaches its limit (theory B2). The
 * alive mask of the bonds is the only memory: a point that died has neither energy nor bonds. The energy that
 * decides is always the plain sum over the point's own bonds: it does not depend on how forces are summed,
 * nor on which points are checked (pairwise_tiles.c leaves out those that cannot have reached their limit).
 * */
#include "bond_force.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Returns the energy density (J/m^3) at which a point of this horizon ratio dies, from its utilisation at 1
 * J/m^3. */
static double limit_at (const pg_criterion *c, double ratio)
{
    double one = 1, u = 0;
    pg_bond_measures m = { .n = 1, .dim = 1, .reach = &ratio, .energy = &one };
    c->type->utilisation (c, &m, &u, NULL);
    return u > 0 ? 1 / (u * u) : INFINITY;
}

/* Makes the limits of energy, if the criterion needs energies; points of excluded sets never die. */
pg_status bond_force_energy_create (bond_force *b)
{
    pg_status status = PG_OK;
    const pg_problem *p = b->problem;
    if (b->node.critical || !p->criterion->type || !(p->criterion->type->needs & PG_NEEDS_ENERGY))
        return PG_OK;
    if (!b->node.density) PG_ALLOC (b->node.density, b->n);
    if (!b->node.dying) PG_ALLOC (b->node.dying, b->n);
    PG_ALLOC (b->node.critical, b->n);
    for (size_t i = 0; i < b->n; i++) {
        const pg_criterion *c = pg_problem_limit (p, PG_NODES, i);
        b->node.critical[i] = c->never || p->bonds.exempt[PG_NODES][i] ? INFINITY
                                                            : limit_at (c, pg_cloud_ratio (&p->cloud, i));
    }
done:
    return status;
}

void bond_force_energy_free (bond_force *b)
{
    pg_free (b->node.critical), pg_free (b->node.density), pg_free (b->node.dying);
}

/* ---- breaking ------------------------------------------------------------------------------------------ */
/* Returns the entry of the bond from j to i: families are sorted by node, so that bisection finds it. */
static size_t back_of (const pg_family *f, size_t i, size_t j)
{
    size_t low = f->start[j], high = f->start[j + 1];
    while (high - low > 1) {
        size_t middle = low + (high - low) / 2;
        if ((size_t) f->node[middle] <= i) low = middle;
        else high = middle;
    }
    return low;
}

/* Appends the intact bonds of dying points, both directions, ascending. */
static pg_status collect (const bond_force *b, pg_changes *out)
{
    pg_status status = PG_OK;
    const pg_family *f = b->family;
    size_t before = out->n;
    for (size_t i = 0; i < b->n; i++)
        for (size_t e = f->start[i]; b->node.dying[i] && e < f->start[i + 1]; e++) {
            size_t j = (size_t) f->node[e];
            if (!bond_force_lives (b, e)) continue;
            PG_GROW (out->bond, out->cap, out->n + 2);
            out->bond[out->n++] = e;
            if (!b->node.dying[j]) out->bond[out->n++] = back_of (f, i, j);
        }
    if (out->n > before) pg_sort (out->bond + before, out->n - before, sizeof *out->bond, pg_ascending_sizes);
done:
    if (status != PG_OK) out->n = before;
    return status;
}

/* Dying points are found once, before any bond of this step breaks: the order of points does not matter. */
pg_status bond_force_energy_kill (bond_force *b, const double *d, pg_changes *broken)
{
    pg_status status = PG_OK;
    size_t before = broken->n, dying = 0;
    PG_TRY (b->theory->find_dying (b, d, &dying));
    if (dying == 0) goto done;
    status = collect (b, broken);
    memset (b->node.dying, 0, b->n);
    PG_TRY (status);
    pg_changes fresh = { broken->n - before, 0, broken->bond + before };
    pg_bond_loop_update (b->loop, b->alive, &fresh);
done:
    return status;
}

/* ---- utilisation --------------------------------------------------------------------------------------- */
typedef struct { const bond_force *b; const unsigned char *alive; double *utilisation,
                 *factor; char *kind; } judging;

/* Utilisation of the bonds of points first .. last - 1: the larger one of their two ends, sqrt (W / limit).
 * */
static void spread_points (void *context, size_t first, size_t last, int thread)
{
    const judging *s = context;
    const pg_family *f = s->b->family;
    const double *u = s->b->node.density;
    (void) thread;
    for (size_t i = first; i < last; i++)
        for (size_t e = f->start[i]; e < f->start[i + 1]; e++) {
            double worse = s->alive[e] ? fmax (u[i], u[f->node[e]]) : 0;
            if (s->utilisation) s->utilisation[e] = worse;
            if (s->utilisation && s->kind) s->kind[e] = 'e';
            if (s->factor) s->factor[e] = worse > 0 ? 1 / worse : INFINITY;
        }
}

/* Fills b->node.density with the utilisation of points, then spreads it to their bonds. */
pg_status bond_force_energy_utilisation (bond_force *b, const pg_state *state, const double *d,
                                         double *utilisation,
                                   char *kind, double *factor)
{
    pg_status status = PG_OK;
    judging s = { b, state->alive, utilisation, factor, kind };
    PG_TRY (bond_force_energy_create (b));  /* in a plan the criterion may be set after the force is made */
    PG_TRY (pg_bond_loop_energies (b->loop, d, b->node.density));
    for (size_t i = 0; i < b->n; i++)
        b->node.density[i] = sqrt (fmax (0, b->node.density[i] / b->node.critical[i]));
    pg_parallel (b->threads, b->n, spread_points, &s);
done:
    return status;
}
