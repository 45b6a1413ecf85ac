/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tips of pre-cracks. Shape functions of points beside a tip that lost some of their neighbours follow the crack further than the bonds were cut: a crack
 * that cuts every bond it meets acts as one that is longer by a share of the spacing. So it cuts only what crosses it some way behind its tips (in
 * space: its fronts). An end is no tip where the body ends, or where the crack meets another. */
#include "model.h"
#include <math.h>
#include <string.h>

/* Behind the tip, in spacings, by horizon (spacings): measured on the single edge notch with Gauss points, mean of 16 places of the lattice against the
 * tip, in the plane (doc/accuracy.md, "Cracks that are there before"). Approximate derivatives (pddo, nosb) follow a crack further. */
typedef struct { double horizon, offset; } row;
static const row exact[2][5] = { { { 1.6, 0.07 }, { 2, 0.26 }, { 2.5, 0.45 }, { 3, 0.69 }, { 3.5, 1 } }, { { 2, 0.04 }, { 2.5, 0.09 }, { 3, 0.19 }, { 3.5, 0.39 }, { 4, 0.61 } } };
static const row approximate[2][5] = { { { 1.6, 0.1 }, { 2, 0.32 }, { 2.5, 0.53 }, { 3, 0.84 }, { 3.5, 1.15 } }, { { 2, 0.3 }, { 2.6, 0.48 }, { 3, 0.66 }, { 3.5, 0.94 }, { 4, 1.2 } } };
enum { ROWS = 5 };
#define NODAL 0.25                                     /* evaluation at the points alone: +- 0.3 by where they lie        */

static double interpolated (const row *r, double horizon)
{
    size_t k = 1;
    while (k + 1 < ROWS && horizon > r[k].horizon) k++;
    double share = (horizon - r[k - 1].horizon) / (r[k].horizon - r[k - 1].horizon);
    return r[k - 1].offset + fmin (1, fmax (0, share)) * (r[k].offset - r[k - 1].offset);
}

/* In m where the local spacing is h. */
static double offset_of (const pg_problem *p, const pg_scene *scene)
{
    double horizon = p->approx.horizon / p->cloud.h;
    if (pg_scene_given (scene, "method.tip_offset")) return pg_scene_length (scene, p->cloud.h, "method.tip_offset");
    if (p->direct) return 0;
    if (p->integration->at_nodes) return NODAL * p->cloud.h;
    return p->cloud.h * interpolated ((strcmp (p->approx.type->name, "rkpm") == 0 ? exact : approximate)[p->approx.order == 2], horizon);
}

/* ---- where the body is ----------------------------------------------------------------------------------------------------- */
typedef struct {
    const pg_problem *p;
    pg_mesh_finder *finder;                            /* of a body that is a mesh                                       */
    pg_nearest *near;
    double offset;                                     /* where the local spacing is the nominal one, m                  */
} surroundings;

static double spacing_at (const surroundings *s, const double *x)
{
    long i = s->p->cloud.size ? pg_nearest_find (s->near, x, NULL, NULL) : -1;
    return i >= 0 ? s->p->cloud.size[i] : s->p->cloud.h;
}

/* Points of a file have no surface: a place beyond it has none nearer than those of a lattice lie at most. */
static int has_body (const surroundings *s, const double *x, double spacing)
{
    const pg_problem *p = s->p;
    double xi[3], d = 0;
    if (p->body.n) return pg_body_inside (&p->body, x, 0);
    if (s->finder) return pg_finder_find (s->finder, x, xi, NULL) >= 0;
    long i = pg_nearest_find (s->near, x, NULL, NULL);
    for (int k = 0; i >= 0 && k < p->dim; k++) d = hypot (d, p->cloud.x[(size_t) i * (size_t) p->dim + (size_t) k] - x[k]);
    return i >= 0 && d <= (p->dim == 3 ? 0.87 : 0.71) * spacing;
}

/* Does the crack end at x, and the body go on ahead, where no other crack takes over? */
static int is_tip (const surroundings *s, size_t crack, const double *x, const double *ahead)
{
    const pg_problem *p = s->p;
    double h = spacing_at (s, x), place[3] = { 0, 0, 0 }, reach = s->offset * h / p->cloud.h;
    for (size_t c = 0; c < p->cracks.n; c++) if (c != crack && pg_crack_touches (&p->cracks.crack[c], p->dim, x, reach)) return 0;
    for (int k = 0; k < p->dim; k++) place[k] = x[k] + (p->body.n || s->finder ? 0.5 : 1) * h * ahead[k];
    return has_body (s, place, h);
}

static double retreat_at (const surroundings *s, const double *x) { return s->offset * spacing_at (s, x) / s->p->cloud.h; }

/* ---- kinds ------------------------------------------------------------------------------------------------------------------- */
static void retreat_segment (const surroundings *s, size_t k, pg_crack *c, double *out)
{
    double t[2] = { c->vertex[2] - c->vertex[0], c->vertex[3] - c->vertex[1] }, length = hypot (t[0], t[1]);
    for (int end = 0; end < 2; end++) {
        double ahead[3] = { (end ? 1 : -1) * t[0] / length, (end ? 1 : -1) * t[1] / length, 0 };
        const double *x = c->vertex + 2 * end;
        out[end] = is_tip (s, k, x, ahead) ? fmin (retreat_at (s, x), 0.25 * length) : 0;
    }
}

/* Outward in the plane, across an edge; and the area. */
static double outward (const pg_crack *c, const double *a, const double *b, double *out)
{
    double area = 0, length = 0;
    for (size_t i = 1; i + 1 < c->nvertex; i++)
        for (int k = 0; k < 3; k++) {
            const double *o = c->vertex, *u = o + 3*i, *v = u + 3;
            int m = (k + 1) % 3, n = (k + 2) % 3;
            area += 0.5 * c->normal[k] * ((u[m] - o[m]) * (v[n] - o[n]) - (u[n] - o[n]) * (v[m] - o[m]));
        }
    for (int k = 0; k < 3; k++) {
        int m = (k + 1) % 3, n = (k + 2) % 3;
        out[k] = (b[m] - a[m]) * c->normal[n] - (b[n] - a[n]) * c->normal[m];
        length = hypot (length, out[k]);
    }
    for (int k = 0; k < 3; k++) out[k] /= length;
    return area;
}

/* An edge is a front where the body goes on ahead of some of it. */
static void retreat_polygon (const surroundings *s, size_t k, pg_crack *c, double *out)
{
    enum { MOST = 200 };
    for (size_t i = 0; i < c->nvertex; i++) {
        const double *a = c->vertex + 3*i, *b = c->vertex + 3*((i + 1) % c->nvertex);
        double ahead[3], area = outward (c, a, b, ahead), length = 0, x[3];
        for (int m = 0; m < 3; m++) length = hypot (length, b[m] - a[m]);
        size_t n = (size_t) fmin (MOST, 3 + 2 * length / s->p->cloud.h);
        out[i] = 0;
        for (size_t q = 0; q < n && out[i] == 0; q++) {
            for (int m = 0; m < 3; m++) x[m] = a[m] + (0.5 + (double) q) / (double) n * (b[m] - a[m]);
            if (is_tip (s, k, x, ahead)) out[i] = fmin (retreat_at (s, x), 0.25 * sqrt (area));
        }
    }
}

pg_status pg_tips_retreat (pg_problem *p, const pg_scene *scene)
{
    pg_status status = PG_OK;
    surroundings s = { .p = p };
    double *out = NULL, **made = NULL;
    if (p->cracks.n == 0) return PG_OK;
    s.offset = offset_of (p, scene);
    if (!(s.offset > 0)) return PG_OK;
    if (p->part.mesh.n) PG_TRY (pg_finder_create (&s.finder, &p->part.mesh));
    PG_TRY (pg_nearest_create (&s.near, p->dim, p->cloud.n, p->cloud.x));
    PG_ALLOC (made, p->cracks.n);
    for (size_t k = 0; k < p->cracks.n; k++) {         /* all before any: an end on another crack is none of its own     */
        pg_crack *c = &p->cracks.crack[k];
        PG_ALLOC (out, c->nvertex);
        if (c->kind == PG_CRACK_SEGMENT) retreat_segment (&s, k, c, out);
        else if (c->kind == PG_CRACK_DISC) out[0] = fmin (retreat_at (&s, c->centre), 0.5 * c->radius);
        else retreat_polygon (&s, k, c, out);
        made[k] = out, out = NULL;
    }
    for (size_t k = 0; k < p->cracks.n; k++) p->cracks.crack[k].retreat = made[k], made[k] = NULL;
done:
    for (size_t k = 0; made && k < p->cracks.n; k++) pg_free (made[k]);
    pg_free (made), pg_free (out);
    pg_nearest_free (&s.near);
    pg_finder_free (&s.finder);
    return status;
}
