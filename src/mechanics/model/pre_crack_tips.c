/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tips of pre-cracks. Near a tip, shape functions of points that lost some neighbours let the crack open
 * beyond the cut bonds: a crack that cuts every bond it meets acts as one that is longer by a fraction of the
 * spacing. Therefore bonds are cut only from a distance behind the tips (3D: fronts) on. An end where the
 * body ends, or where the crack meets another, is no tip. */
#include "model.h"
#include "perigal/vector.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

/* Distance behind the tip without cut bonds, in spacings, by horizon (in spacings), for linear [0] and
 * quadratic [1] basis: measured in 2D on the single edge notch with Gauss points, mean of 16 positions of the
 * lattice relative to the tip (doc/accuracy.md, "Cracks that are there before"). Larger for approximate
 * derivatives (pddo, nosb). */
typedef struct { double horizon, offset; } row;
static const row exact[2][5] = { { { 1.6, 0.07 }, { 2, 0.26 }, { 2.5, 0.45 }, { 3, 0.69 }, { 3.5, 1 } },
                                 { { 2, 0.04 }, { 2.5, 0.09 }, { 3, 0.19 }, { 3.5, 0.39 }, { 4, 0.61 } } };
static const row approximate[2][5] = {
    { { 1.6, 0.1 }, { 2, 0.32 }, { 2.5, 0.53 }, { 3, 0.84 }, { 3.5, 1.15 } },
    { { 2, 0.3 }, { 2.6, 0.48 }, { 3, 0.66 }, { 3.5, 0.94 }, { 4, 1.2 } }
};
enum { ROWS = 5 };
#define WORTH_A_WARNING 0.05                           /* relative uncertainty of the crack opening */
#define BETWEEN_POINTS 0.15  /* spacings; bond, lps, gmpd: from K of an edge crack, +- 1.5 % at 20 spacings */
#define NODAL 0.25  /* spacings; nodal integration: +- 0.3 depending on positions of points */

/* Offset at a horizon (in spacings): linear between rows, constant beyond them. */
static double interpolated (const row *r, size_t rows, double horizon)
{
    size_t k = 1;
    while (k + 1 < rows && horizon > r[k].horizon) k++;
    double share = (horizon - r[k - 1].horizon) / (r[k].horizon - r[k - 1].horizon);
    return r[k - 1].offset + fmin (1, fmax (0, share)) * (r[k].offset - r[k - 1].offset);
}

/* Offsets of closed tips, in spacings, linear basis. Near a tip, shape functions let crack faces slide more
 * than open, so that a closed tip acts as one that is still longer. Measured by K_II of a closed inclined
 * crack of 15 spacings from its middle to its tip, 12 tips on six lattices (doc/method.md, "Contact of crack
 * faces"): without friction it is then 0.8 % too high, with much friction right, as the pressure on the
 * shorter contact line is a little too high. Quadratic basis: 0.5 spacings more than an open tip; other
 * methods: as an open tip. */
static const row sliding[4] = { { 1.6, 1.23 }, { 2, 0.7 }, { 2.5, 1.19 }, { 3, 1.89 } };

static double closed_offset_of (const pg_problem *p, const pg_scene *scene)
{
    double horizon = p->form.approx.horizon / p->cloud.h;
    if (pg_scene_given (scene, "method.tip_offset") || !p->method->shape_functions
        || p->form.integration->at_nodes || !p->form.approx.type->exact)
        return p->crack.tip_offset;
    if (p->form.approx.order == 2) return p->crack.tip_offset + 0.5 * p->cloud.h;
    return fmax (p->crack.tip_offset, p->cloud.h * interpolated (sliding, 4, horizon));
}

/* Offset of open tips, m, where the local spacing is cloud.h. */
static double offset_of (const pg_problem *p, const pg_scene *scene)
{
    double horizon = p->form.approx.horizon / p->cloud.h;
    if (pg_scene_given (scene, "method.tip_offset"))
        return pg_scene_length (scene, p->cloud.h, "method.tip_offset");
    if (!p->method->shape_functions)
        return pg_problem_grows (p) && p->method->tip_offset ? p->method->tip_offset (p) * p->cloud.h : 0;
    if (p->form.integration->at_nodes) return NODAL * p->cloud.h;
    return p->cloud.h
           * interpolated ((p->form.approx.type->exact ? exact : approximate)[p->form.approx.order == 2],
                           ROWS, horizon);
}

/* ---- where the body is --------------------------------------------------------------------------------- */
/* Dimensions of a crack inside the body, from which the effect of an uncertain tip position is estimated. */
typedef struct {
    double size, front;  /* 2D: length, m, and number of tips; 3D: area, m^2, and length of fronts, m */
    double ligament;                                   /* least length of body ahead of its tips, m */
    double spacing;                                    /* largest local spacing at its tips, m */
    int open;                                          /* 1: the crack reaches the surface */
    size_t group;                                      /* first crack of the group of connected cracks */
    /* Bounding box of the crack, m, to exclude cracks that cannot touch. */
    double low[3], high[3];
} extent;

typedef struct {
    pg_problem *p;
    double offset;                                     /* offset of open tips at nominal spacing, m */
    extent *extent;                                    /* dimensions of each crack */
} surroundings;

/* Returns 1: another crack passes through x (within the offset). */
static int meets_other (const surroundings *s, size_t crack, const double *x)
{
    const pg_problem *p = s->p;
    double reach = fmax (s->offset, 1e-6 * p->cloud.h) * pg_problem_spacing_at (s->p, x) / p->cloud.h;
    for (size_t c = 0; c < p->crack.given.n; c++)
        if (c != crack && pg_crack_touches (&p->crack.given.crack[c], p->dim, x, reach)) return 1;
    return 0;
}

/* Returns 1: the crack's end x is a tip: the body continues ahead, and no other crack passes through x. */
static int is_tip (const surroundings *s, size_t crack, const double *x, const double *ahead)
{
    const pg_problem *p = s->p;
    double h = pg_problem_spacing_at (s->p, x), place[3] = { 0, 0, 0 };
    if (meets_other (s, crack, x)) return 0;
    for (int k = 0; k < p->dim; k++) place[k] = x[k] + (p->body.n || p->part.mesh.n ? 0.5 : 1) * h * ahead[k];
    if (pg_problem_has_body (s->p, place)) return 1;
    s->extent[crack].open = 1;
    return 0;
}

/* Length of the segment a - b inside the body, m. */
static double length_inside (const surroundings *s, const double *a, const double *b)
{
    enum { PLACES = 100 };
    size_t in = 0;
    for (size_t q = 0; q < PLACES; q++) {
        double t = (0.5 + (double) q) / PLACES,
               x[3] = { a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]), 0 };
        in += (size_t) pg_problem_has_body (s->p, x);
    }
    return hypot (b[0] - a[0], b[1] - a[1]) * (double) in / PLACES;
}

/* Signed area of the triangle of the first vertex of a polygon with its edge from vertex i to the next, m^2;
 * those of a polygon that is not convex cancel in the sum over i = 1 .. nvertex - 2. */
static double triangle_area (const pg_crack *c, size_t i)
{
    double u[3], v[3], n[3];
    pg_shift3 (c->vertex + 3*i, c->vertex, -1, u), pg_shift3 (c->vertex + 3*i + 3, c->vertex, -1, v);
    pg_cross3 (u, v, n);
    return 0.5 * pg_dot3 (c->normal, n);
}

/* Area of a polygon inside the body, m^2, from signed triangles of its first vertex and each edge. */
static double area_inside (const surroundings *s, const pg_crack *c)
{
    const double *x = c->vertex;
    const pg_ground ground = pg_problem_ground (s->p);
    double area = 0;
    for (size_t i = 1; i + 1 < c->nvertex; i++)
        area += pg_ground_area_inside (&ground, x, x + 3*i, x + 3*i + 3, triangle_area (c, i));
    return area;
}

/* Adds a tip, or a piece of front of this length (m) around x, to the dimensions of a crack. */
static void add_front (const surroundings *s, size_t crack, const double *x, const double *ahead,
                       double length)
{
    enum { FAR = 200 };
    extent *e = &s->extent[crack];
    double h = pg_problem_spacing_at (s->p, x), place[3] = { 0 };
    int steps = 0;
    do for (int k = 0; k < s->p->dim; k++) place[k] = x[k] + (0.25 + 0.5 * steps) * h * ahead[k];
    while (pg_problem_has_body (s->p, place) && ++steps < FAR);
    double ligament = 0.5 * h * fmax (steps, 0.5);     /* half a spacing is the resolution */
    e->ligament = e->front > 0 ? fmin (e->ligament, ligament) : ligament;
    e->spacing = fmax (e->spacing, h);
    e->front += length;
}

/* Offset at x, m: proportional to the local spacing. */
static double retreat_at (const surroundings *s, const double *x)
{
    return s->offset * pg_problem_spacing_at (s->p, x) / s->p->cloud.h;
}

/* ---- kinds --------------------------------------------------------------------------------------------- */
/* Finds the tips of a segment and their offsets out[2] (m); a short crack keeps half its length. */
static void retreat_segment (const surroundings *s, size_t k, pg_crack *c, double *out)
{
    double t[2] = { c->vertex[2] - c->vertex[0], c->vertex[3] - c->vertex[1] }, length = hypot (t[0], t[1]);
    s->extent[k].size = length_inside (s, c->vertex, c->vertex + 2);
    for (int end = 0; end < 2; end++) {
        double ahead[3] = { (end ? 1 : -1) * t[0] / length, (end ? 1 : -1) * t[1] / length, 0 };
        const double *x = c->vertex + 2 * end;
        int tip = is_tip (s, k, x, ahead);
        out[end] = tip ? fmin (retreat_at (s, x), 0.25 * length) : 0;
        if (!tip) continue;
        add_front (s, k, x, ahead, 1);
        s->p->crack.tip[s->p->crack.ntip] = (pg_tip){ .id = (long) s->p->crack.ntip + 1,
                                                      .segment = k,
                                                      .end = end,
                                                      .open = 1,
                                                      .x = { x[0], x[1] },
                                                      .offset = out[end] };
        s->p->crack.ntip++;
    }
}

/* The unit vector in the plane of a polygon that points outward across its edge from a to b. */
static void outward (const pg_crack *c, const double *a, const double *b, double *out)
{
    double along[3];
    pg_shift3 (b, a, -1, along);
    pg_cross3 (along, c->normal, out);
    pg_unit3 (out);
}

/* Finds the offset of each edge of a polygon, out (nvertex, m), if the body continues ahead of a part of
 * it. */
static void retreat_polygon (const surroundings *s, size_t k, pg_crack *c, double *out)
{
    enum { MOST = 200 };
    double area = 0;
    for (size_t i = 1; i + 1 < c->nvertex; i++) area += triangle_area (c, i);
    for (size_t i = 0; i < c->nvertex; i++) {
        const double *a = c->vertex + 3*i, *b = c->vertex + 3*((i + 1) % c->nvertex);
        double ahead[3], length = pg_distance3 (a, b), x[3];
        outward (c, a, b, ahead);
        size_t n = (size_t) fmin (MOST, 3 + 2 * length / s->p->cloud.h);
        out[i] = 0;
        for (size_t q = 0; q < n; q++) {
            for (int m = 0; m < 3; m++) x[m] = a[m] + (0.5 + (double) q) / (double) n * (b[m] - a[m]);
            if (!is_tip (s, k, x, ahead)) continue;
            out[i] = fmax (out[i], fmin (retreat_at (s, x), 0.25 * sqrt (area)));
            add_front (s, k, x, ahead, length / (double) n);
        }
    }
    s->extent[k].size = area_inside (s, c);
}

/* Finds the common offset of the rim of a disc, out[0] (m): the mean over its vertices in the body. */
static void retreat_disc (const surroundings *s, size_t k, const pg_crack *c, double *out)
{
    double rim[3], sum = 0, n = 0;
    for (size_t i = 0; i < c->nvertex; i++) {
        const double *x = c->vertex + 3*i;
        if (pg_problem_has_body (s->p, x)) sum += retreat_at (s, x), n++;
    }
    out[0] = fmin (n > 0 ? sum / n : retreat_at (s, c->centre), 0.5 * c->radius);
    for (size_t i = 0; i < c->nvertex; i++) {
        const double *x = c->vertex + 3*i;
        for (int m = 0; m < 3; m++) rim[m] = (x[m] - c->centre[m]) / c->radius;
        if (is_tip (s, k, x, rim)) add_front (s, k, x, rim, 2 * acos (-1) * c->radius / (double) c->nvertex);
    }
    s->extent[k].size = area_inside (s, c);
}

/* ---- how well a tip is known --------------------------------------------------------------------------- */
/* Returns 1: two cracks touch at a vertex of either. */
static int joined (const pg_problem *p, const pg_crack *a, const pg_crack *b)
{
    size_t dim = (size_t) p->dim;
    for (size_t i = 0; i < a->nvertex; i++)
        if (pg_crack_touches (b, p->dim, a->vertex + i * dim, 1e-6 * p->cloud.h)) return 1;
    for (size_t i = 0; i < b->nvertex; i++)
        if (pg_crack_touches (a, p->dim, b->vertex + i * dim, 1e-6 * p->cloud.h)) return 1;
    return 0;
}

/* Bounding box of a crack, m, enlarged by the tolerance of touching, and by the distance of the sides of a
 * disc's polygon from its rim. */
static void box_of (const pg_problem *p, const pg_crack *c, extent *e)
{
    double slack = 1e-5 * p->cloud.h + (c->kind == PG_CRACK_DISC ? 0.01 * c->radius : 0);
    for (int a = 0; a < 3; a++) e->low[a] = a < p->dim ? INFINITY : 0, e->high[a] = -e->low[a];
    for (size_t i = 0; i < c->nvertex; i++)
        for (int a = 0; a < p->dim; a++) {
            double x = c->vertex[i * (size_t) p->dim + (size_t) a];
            e->low[a] = fmin (e->low[a], x - slack), e->high[a] = fmax (e->high[a], x + slack);
        }
}

static int boxes_meet (const extent *a, const extent *b)
{
    return a->low[0] <= b->high[0] && b->low[0] <= a->high[0] && a->low[1] <= b->high[1]
           && b->low[1] <= a->high[1] && a->low[2] <= b->high[2] && b->low[2] <= a->high[2];
}

/* Merges the dimensions of connected cracks into those of the first crack of the group. */
static void join (const pg_problem *p, extent *e)
{
    for (size_t k = 0; k < p->crack.given.n; k++) e[k].group = k, box_of (p, &p->crack.given.crack[k], &e[k]);
    for (size_t k = 1; k < p->crack.given.n; k++)
        for (size_t j = 0; j < k; j++) {
            size_t from = e[k].group, to = e[j].group;
            if (from == to || !boxes_meet (&e[k], &e[j])
                || !joined (p, &p->crack.given.crack[k], &p->crack.given.crack[j]))
                continue;
            for (size_t i = 0; i <= k; i++)
                if (e[i].group == from || e[i].group == to) e[i].group = from < to ? from : to;
        }
    for (size_t k = 1; k < p->crack.given.n; k++) {
        extent *first = &e[e[k].group];
        if (first == &e[k]) continue;
        if (e[k].front > 0)
            first->ligament = first->front > 0 ? fmin (first->ligament, e[k].ligament) : e[k].ligament;
        first->spacing = fmax (first->spacing, e[k].spacing), first->size += e[k].size,
        first->front += e[k].front, first->open |= e[k].open;
    }
}

/* Characteristic length of a crack, m: length to a tip (half of an internal crack), depth to a front, radius
 * of a disc. */
static double length_of (const extent *e, int dim)
{
    return (dim == 3 && !e->open ? 2 : 1) * e->size / e->front;
}

/* Relative change of the crack opening per advance of all tips, 1/m: 1 / length of a short crack, 2 /
 * ligament of a deep notch in tension, in between about the sum (to a sixth); internal cracks depend less on
 * the ligament. */
static double sensitivity (const extent *e, int dim)
{
    return 1 / length_of (e, dim) + (e->open ? 2 : 0.4) / e->ligament;
}

/* Uncertainty of tip positions, in spacings, due to their positions among the points. It is larger with nodal
 * integration, which is less stiff against the crack opening. */
static double known_to (const pg_problem *p)
{
    if (!p->method->shape_functions) return BETWEEN_POINTS;
    const pg_approx_type *a = p->form.approx.type;
    return p->form.integration->at_nodes ? a->tip.nodal
           : p->form.approx.order == 2   ? a->tip.quadratic
                                         : a->tip.linear;
}

/* Notes the uncertainty of the crack with the most uncertain opening; a warning from 5 % on. */
static void tell (pg_problem *p, const pg_scene *scene, extent *e)
{
    double spacings = known_to (p), worst = 0;
    size_t at = 0;
    char remedy[80] = "";
    if (!pg_scene_entry_is (scene, "solver.kind", PG_SOLVER_STATIC)) return;
    join (p, e);
    for (size_t k = 0; k < p->crack.given.n; k++) {
        if (e[k].group != k || !(e[k].front > 0) || !(e[k].size > 0)) continue;
        double share = spacings * e[k].spacing * sensitivity (&e[k], p->dim);
        if (share > worst) worst = share, at = k;
    }
    if (!(worst > 0)) return;
    if (worst > WORTH_A_WARNING)
        snprintf (remedy, sizeof remedy, "; points %.2g m apart there make that 5 %%",
                  e[at].spacing * WORTH_A_WARNING / worst);
    const char *end = p->dim == 3 ? "front" : "tip";
    pg_problem_note (p,
                     "%sthe opening of crack %zu (%.3g spacings to its %s) is known to about +-%.2g %%: "
                     "where its %s lies among the points is worth +-%g spacing%s",
                     worst > WORTH_A_WARNING ? PG_WARNING : "", at + 1,
                     length_of (&e[at], p->dim) / e[at].spacing, end, 100 * worst, end, spacings, remedy);
}

/* Finds all tips and fronts, then sets the offsets behind them (crack.retreat). */
pg_status pg_tips_retreat (pg_problem *p, const pg_scene *scene)
{
    pg_status status = PG_OK;
    surroundings s = { .p = p };
    double *out = NULL, **made = NULL;
    s.offset = p->crack.tip_offset = offset_of (p, scene);
    p->crack.closed_tip_offset = closed_offset_of (p, scene);
    if (p->crack.given.n == 0) return PG_OK;
    const pg_ground ground = pg_problem_ground (p);
    if (p->dim == 2) PG_ALLOC (p->crack.tip, 2 * p->crack.given.n);
    if (p->dim == 3 && !p->method->shape_functions && !(s.offset > 0))
        return pg_fronts_find (&ground, &p->crack.given, NULL, &p->crack.front, &p->crack.nfront);
    PG_ALLOC (made, p->crack.given.n);
    PG_ALLOC (s.extent, p->crack.given.n);
    /* first all cracks are examined as drawn, then offsets are set */
    for (size_t k = 0; k < p->crack.given.n; k++) {
        pg_crack *c = &p->crack.given.crack[k];
        PG_ALLOC (out, c->nvertex);
        if (c->kind == PG_CRACK_SEGMENT) retreat_segment (&s, k, c, out);
        else if (c->kind == PG_CRACK_DISC) retreat_disc (&s, k, c, out);
        else retreat_polygon (&s, k, c, out);
        made[k] = out, out = NULL;
    }
    /* cracks as drawn, before offsets are set */
    if (p->method->shape_functions || pg_problem_grows (p)) tell (p, scene, s.extent);
    if (p->dim == 3)
        PG_TRY (pg_fronts_find (&ground, &p->crack.given, s.offset > 0 ? made : NULL, &p->crack.front,
                                &p->crack.nfront));
    for (size_t k = 0; s.offset > 0 && k < p->crack.given.n; k++)
        p->crack.given.crack[k].retreat = made[k], made[k] = NULL;
    PG_TRY (pg_cracks_index (&p->crack.given));             /* as a segment may cut beyond its ends */
done:
    for (size_t k = 0; made && k < p->crack.given.n; k++) pg_free (made[k]);
    pg_free (made), pg_free (out), pg_free (s.extent);
    return status;
}
