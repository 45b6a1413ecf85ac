/* SPDX-License-Identifier: GPL-3.0-or-later
 * Where interfaces run: a place is of the material of the nearest evaluation point, and an interface lies
 * where that changes. Points of evaluation are no further from an interface along the edges of cells than
 * half a spacing, at equal distances on both sides, so that such an interface is found exactly. */
#include "interface_facet.h"
#include <math.h>
#include <string.h>

enum { HALVINGS = 40 };

static int bulk_of (const pg_problem *p) { return p->rows[PG_POINTS].n ? PG_POINTS : PG_NODES; }

pg_status interface_ready (trials *w, int *several)
{
    pg_status status = PG_OK;
    const pg_problem *p = w->system->problem;
    *several = p->nmaterial > 1;
    if (!*several || w->points) return PG_OK;
    const pg_rows *r = &p->rows[bulk_of (p)];
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

/* A place on a curve: at an angle on a circle, or at a distance along a line. */
typedef struct { const double *x, *direction; double radius; } curve;

static void place_on (const curve *c, double s, double *out)
{
    double r = c->direction ? s : c->radius;
    out[0] = c->x[0] + r * (c->direction ? c->direction[0] : cos (s));
    out[1] = c->x[1] + r * (c->direction ? c->direction[1] : sin (s));
    out[2] = 0;
}

/* Between two places of different materials. */
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
        /* begins where no interface along an axis lies */
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
