/* SPDX-License-Identifier: GPL-3.0-or-later
 * Positions of interfaces: a point is of the material of the nearest evaluation point, and an interface lies
 * where that changes. Evaluation points are no further from an interface along the edges of cells than half a
 * spacing, at equal distances on both sides, so that such an interface is found exactly. */
#include "hot_spot.h"
#include "interface_facet.h"
#include <math.h>
#include <string.h>

enum { HALVINGS = 40 };

static int bulk_of (const pg_problem *p) { return p->bonds.rows[PG_POINTS].n ? PG_POINTS : PG_NODES; }

pg_status interface_ready (trials *w, int *several)
{
    pg_status status = PG_OK;
    const pg_problem *p = w->system->problem;
    *several = p->nmaterial > 1;
    if (!*several || w->points) return PG_OK;
    const pg_rows *r = &p->bonds.rows[bulk_of (p)];
    PG_TRY (pg_nearest_create (&w->points, p->dim, r->n, r->x));
done:
    return status;
}

static int material_at (const trials *w, const double *x)
{
    const pg_problem *p = w->system->problem;
    long point = pg_nearest_find (w->points, x, NULL, NULL);
    return p->block[bulk_of (p)][point < 0 ? 0 : point];
}

/* A curve: a circle, along which s is an angle, or a line, along which it is a distance. */
typedef struct { const double *x, *direction; double radius; } curve;

static void place_on (const curve *c, double s, double *out)
{
    double r = c->direction ? s : c->radius;
    out[0] = c->x[0] + r * (c->direction ? c->direction[0] : cos (s));
    out[1] = c->x[1] + r * (c->direction ? c->direction[1] : sin (s));
    out[2] = 0;
}

/* Finds the crossing between two points (low, high) of different materials by bisection. */
static void halve (const trials *w, const curve *c, double low, double high, crossing *out)
{
    double x[3];
    place_on (c, low, x), out->material[0] = material_at (w, x);
    place_on (c, high, x), out->material[1] = material_at (w, x);
    for (int k = 0; k < HALVINGS; k++) {
        double middle = 0.5 * (low + high);
        place_on (c, middle, x);
        if (material_at (w, x) == out->material[0]) low = middle;
        else high = middle;
    }
    place_on (c, 0.5 * (low + high), out->x);
}

size_t interface_around (trials *w, const double *x, double radius, size_t most, crossing *out)
{
    enum { PARTS = 96 };
    const pg_problem *p = w->system->problem;
    curve c = { x, NULL, radius };
    double turn = 2 * acos (-1), at[3];
    size_t n = 0;
    int before = -1;
    for (int k = 0; k <= PARTS && n < most; k++) {
        /* starts at an angle where no interface along an axis lies */
        double s = turn * (k + 0.37) / PARTS;
        place_on (&c, s, at);
        int now = pg_problem_has_body (p, at) ? material_at (w, at) : -1;
        if (now >= 0 && before >= 0 && now != before) halve (w, &c, s - turn / PARTS, s, &out[n++]);
        before = now;
    }
    return n;
}

int interface_ahead (trials *w, const double *x, const double *direction, double limit, double *distance,
                     crossing *out)
{
    const pg_problem *p = w->system->problem;
    curve c = { x, direction, 0 };
    double step = 0.05 * p->cloud.h, at[3];
    int before = material_at (w, x);
    for (double s = step; s <= limit; s += step) {
        place_on (&c, s, at);
        if (!pg_problem_has_body (p, at)) return 0;
        if (material_at (w, at) == before) continue;
        halve (w, &c, s - step, s, out);
        *distance = hypot (out->x[0] - x[0], out->x[1] - x[1]);
        return 1;
    }
    return 0;
}

/* ---- where cracks may begin ---------------------------------------------------------------------------- */
/* 1: node i has a node of another material among its neighbours. */
static int is_beside (const pg_problem *p, size_t i)
{
    const pg_family *f = &p->bonds.rows[PG_NODES].family;
    for (size_t e = f->start[i]; e < f->start[i + 1]; e++)
        if (p->block[PG_NODES][f->node[e]] != p->block[PG_NODES][i]) return 1;
    return 0;
}

/* Finds the point of an interface near a node, with its direction and entry; 0: none with a strength. */
static int lies_near (trials *w, size_t node, hot_spot *out)
{
    const pg_problem *p = w->system->problem;
    double x[3] = { p->cloud.x[2 * node], p->cloud.x[2 * node + 1], 0 };
    crossing way[3];
    *out = (hot_spot) { .h = pg_problem_spacing (p, PG_NODES, node), .factor = INFINITY };
    if (interface_around (w, x, 0.8 * out->h, 3, way) < 2) return 0;
    out->interface = pg_problem_interface (p, way[0].material[0], way[0].material[1]);
    if (!out->interface || !(out->interface->strength > 0)) return 0;
    for (int k = 0; k < 2; k++) out->x[k] = 0.5 * (way[0].x[k] + way[1].x[k]);
    out->angle = atan2 (way[1].x[1] - way[0].x[1], way[1].x[0] - way[0].x[0]);
    const int *m = out->interface->material;
    out->modulus = fmin (p->material[m[0]].modulus, p->material[m[1]].modulus);
    return 1;
}

/* Load factor at which the tension across the interface reaches its strength. */
static double factor_across (const hot_spot *s, const affine_stress *stress)
{
    double a = -sin (s->angle), b = cos (s->angle), across[3] = { a * a, b * b, 2 * a * b };
    double f = fmin (s->interface->strength, hot_strength_cap (s->modulus, s->interface->energy, s->h)),
           constant = 0, slope = 0;
    for (int k = 0; k < 3; k++) {
        constant += across[k] * stress->constant[k];
        slope += across[k] * stress->slope[k];
    }
    if (constant >= f) return 0;
    return slope > 0 ? (f - constant) / slope : INFINITY;
}

/* Keeps the best of the points that lie apart from those already kept. */
static void keep_apart (size_t count, const hot_spot *all, double limit, size_t most, hot_spot *out,
                        size_t *n)
{
    for (*n = 0; *n < most; ++*n) {
        size_t best = count;
        for (size_t i = 0; i < count; i++) {
            int near = 0;
            for (size_t k = 0; k < *n && !near; k++)
                near = hypot (all[i].x[0] - out[k].x[0], all[i].x[1] - out[k].x[1]) < HOT_APART * all[i].h;
            if (near || !(all[i].factor < limit)) continue;
            if (best == count || all[i].factor < all[best].factor) best = i;
        }
        if (best == count) break;
        out[*n] = all[best];
    }
}

/* Finds hot spots of interfaces; stresses are averaged over two points, a quarter of a spacing to both
 * sides. */
pg_status hot_interfaces (const search *g, size_t most, hot_spot *out, size_t *n)
{
    pg_status status = PG_OK;
    const pg_problem *p = g->w->system->problem;
    size_t count = 0, cap = 0;
    hot_spot *all = NULL, one;
    double *x = NULL;
    affine_stress *stress = NULL;
    int several;
    *n = 0;
    PG_TRY (interface_ready (g->w, &several));
    if (!several || p->at.ninterface == 0) goto done;
    for (size_t i = 0; i < p->cloud.n; i++) {
        if (p->bonds.exempt[PG_NODES][i] || !is_beside (p, i) || !lies_near (g->w, i, &one)) continue;
        if (hot_excluded (g, one.x, one.h)) continue;
        PG_GROW (all, cap, count + 1);
        all[count++] = one;
    }
    PG_ALLOC (x, 4 * count);
    PG_ALLOC (stress, count);
    for (size_t i = 0; i < count; i++)
        for (int side = 0; side < 2; side++) {
            double s = (side ? 0.25 : -0.25) * all[i].h;
            x[4*i + 2 * (size_t) side] = all[i].x[0] - s * sin (all[i].angle);
            x[4*i + 2 * (size_t) side + 1] = all[i].x[1] + s * cos (all[i].angle);
        }
    if (count) PG_TRY (hot_stress (g, 2 * count, 2, x, stress));
    for (size_t i = 0; i < count; i++) all[i].factor = factor_across (&all[i], &stress[i]);
    keep_apart (count, all, g->best, most, out, n);
done:
    pg_free (all), pg_free (x), pg_free (stress);
    return status;
}
