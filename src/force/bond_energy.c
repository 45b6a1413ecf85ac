/* SPDX-License-Identifier: GPL-3.0-or-later
 * Points that die by their energy (theory B2): at or over its limit a point loses all its bonds, for good.
 * Bits of bonds are the only memory: a dead point stores nothing and has none left to lose. The energy that
 * decides is always the plain sum over the point's own bonds: it does not depend on how sums are evaluated,
 * and neither on which points are looked at (bond_tiles.c leaves out those that cannot have reached their
 * limit). */
#include "bond.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The energy density at which a point like this one dies: the criterion's own answer for one of 1 J/m^3. */
static double limit_at (const pg_criterion *c, double ratio)
{
    double one = 1, u = 0;
    pg_bond_measures m = { .n = 1, .dim = 1, .reach = &ratio, .energy = &one };
    c->type->utilisation (c, &m, &u, NULL);
    return u > 0 ? 1 / (u * u) : INFINITY;
}

pg_status bond_energy_create (bond *b)
{
    pg_status status = PG_OK;
    const pg_problem *p = b->problem;
    if (b->critical || !p->criterion->type || !(p->criterion->type->needs & PG_NEEDS_ENERGY)) return PG_OK;
    if (!b->density) PG_ALLOC (b->density, b->n);
    if (!b->dying) PG_ALLOC (b->dying, b->n);
    PG_ALLOC (b->critical, b->n);
    for (size_t i = 0; i < b->n; i++) {
        const pg_criterion *c = &p->criterion[p->block[PG_NODES][i]];
        b->critical[i] = c->never || p->exempt[PG_NODES][i] ? INFINITY
                                                            : limit_at (c, pg_cloud_ratio (&p->cloud, i));
    }
done:
    return status;
}

void bond_energy_free (bond *b)
{
    bond_tiles_free (&b->tiles);
    pg_free (b->critical), pg_free (b->density), pg_free (b->dying);
}

/* ---- energy of a point --------------------------------------------------------------------------------- */
/* Half the energy of each live bond: linear 1/4 kappa (xi . eta)^2, finite 1/4 kappa r^2 (|xi + eta| -
 * r)^2. */
double bond_energy_at (const bond *b, size_t i, int thread, const double *d)
{
    size_t dim = (size_t) b->dim;
    int finite = b->problem->sums->rule.finite;
    double sum = 0, r;
    point_bonds s;
    point_bonds_at (b, i, thread, &s);
    for (size_t e = 0; e < s.m; e++) {
        if (!bond_lives (b, s.first + e)) continue;
        const double *xi = s.xi + e * dim, *far = d + (size_t) s.node[e] * dim;
        double kappa = bond_kappa (b, i, &s, e, &r), along = 0, square = 0;
        for (size_t a = 0; a < dim; a++) {
            double eta = far[a] - d[i * dim + a];
            along += xi[a] * eta, square += eta * eta;
        }
        double grown = 2 * along + square,
               longer = finite ? r * grown / (sqrt (fmax (0, r * r + grown)) + r) : along;
        sum += kappa * (longer * longer);
    }
    return sum / (4 * b->problem->cloud.volume[i]);
}

/* ---- breaking ------------------------------------------------------------------------------------------ */
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

static int ascending (const void *a, const void *b)
{
    size_t x = *(const size_t *) a, y = *(const size_t *) b;
    return x < y ? -1 : x > y;
}

/* Both directions of the live bonds of dying points. */
static pg_status collect (const bond *b, pg_changes *out)
{
    pg_status status = PG_OK;
    const pg_family *f = b->family;
    size_t before = out->n;
    for (size_t i = 0; i < b->n; i++)
        for (size_t e = f->start[i]; b->dying[i] && e < f->start[i + 1]; e++) {
            size_t j = (size_t) f->node[e];
            if (!bond_lives (b, e)) continue;
            PG_GROW (out->bond, out->cap, out->n + 2);
            out->bond[out->n++] = e;
            if (!b->dying[j]) out->bond[out->n++] = back_of (f, i, j);
        }
    if (out->n > before) qsort (out->bond + before, out->n - before, sizeof *out->bond, ascending);
done:
    if (status != PG_OK) out->n = before;
    return status;
}

pg_status bond_energy_kill (bond *b, const double *d, pg_changes *broken)
{
    pg_status status = PG_OK;
    size_t before = broken->n, dying = 0;
    if (b->dilation) PG_TRY (lps_look (b, d, &dying));
    else PG_TRY (bond_tiles_look (b, d, &dying));
    if (dying == 0) goto done;
    status = collect (b, broken);
    memset (b->dying, 0, b->n);
    PG_TRY (status);
    pg_changes fresh = { broken->n - before, 0, broken->bond + before };
    pg_bond_loop_update (b->sweep, b->alive, &fresh);
done:
    return status;
}

/* ---- utilisation --------------------------------------------------------------------------------------- */
typedef struct { const bond *b; const unsigned char *alive; double *utilisation, *factor; char *kind; } sweep;

static void spread_points (void *context, size_t first, size_t last, int thread)
{
    const sweep *s = context;
    const pg_family *f = s->b->family;
    const double *u = s->b->density;
    (void) thread;
    for (size_t i = first; i < last; i++)
        for (size_t e = f->start[i]; e < f->start[i + 1]; e++) {
            double worse = s->alive[e] ? fmax (u[i], u[f->node[e]]) : 0;
            if (s->utilisation) s->utilisation[e] = worse;
            if (s->utilisation && s->kind) s->kind[e] = 'e';
            if (s->factor) s->factor[e] = worse > 0 ? 1 / worse : INFINITY;
        }
}

pg_status bond_energy_utilisation (bond *b, const pg_state *state, const double *d, double *utilisation,
                                   char *kind, double *factor)
{
    pg_status status = PG_OK;
    sweep s = { b, state->alive, utilisation, factor, kind };
    PG_TRY (bond_energy_create (b));  /* a plan asks of a problem whose criterion comes later */
    PG_TRY (pg_bond_loop_energies (b->sweep, d, b->density));
    for (size_t i = 0; i < b->n; i++) b->density[i] = sqrt (fmax (0, b->density[i] / b->critical[i]));
    pg_parallel (b->threads, b->n, spread_points, &s);
done:
    return status;
}
