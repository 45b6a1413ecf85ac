/* SPDX-License-Identifier: GPL-3.0-or-later
 * Visibility between two points of the body. A straight line segment that leaves the body through one face
 * and comes back through a face with an opposed normal - across a slot, a gap, to another body, however
 * narrow - separates its ends; so does one that runs outside for more than half a spacing, unless it is the
 * chord of one smooth surface: there the normals at both ends of the part outside are nearly the same. A body
 * is the faces of its mesh, or shapes that are added and subtracted in turn.
 *
 * Points need not lie in the body exactly: the vertices of a lattice about cells whose centres do may lie
 * beyond its surface. Segments from such a point begin at the nearest position in the body, its `eye`, so
 * that it belongs to one side of a slot that it lies in. The eye of a mesh node lies slightly inside its
 * elements, which tells the two nodes apart that lie at one position on both sides of a seam. */
#include "between.h"
#include "geometry/cloud/body/shape.h"
#include "geometry/cloud/body/solid.h"
#include <float.h>
#include <math.h>
#include <string.h>

/* A shape, or the mesh that is the body (shape NULL); is it added to the body, is it convex; its box, m. */
typedef struct { const pg_shape *shape; between_faces *faces; int add, convex; double box[6]; } member;

struct pg_between {
    int     dim;
    /* 1: the body is one shape or mesh, so that a segment that meets no face is inside. */
    int     alone;
    /* Distance within which a point counts as on a surface, m: a share of the spacing, wherever the body
     * lies, and the rounding of coordinates far from the origin. */
    double  near;
    const pg_body *body;
    const pg_cloud *cloud;
    size_t  n;
    member *member;
    /* Search for the nearest point, where spacings differ; else NULL. */
    pg_nearest *nearest;
    /* Eye of each point, where its segments begin, m (cloud.n x dim); NULL: at the points themselves. */
    double *eye;
};

/* Cosines between the two normals of a gap: below AWAY (91 degrees) they are opposed, above SMOOTH (60
 * degrees) the gap is the chord of a smooth surface. Gaps longer than LONG spacings separate. */
static const double AWAY = -0.02, SMOOTH = 0.5, LONG = 0.5;
/* REACH: distance within which the body is searched from a point outside, in spacings. WITHIN: depth of its
 * eye in the body, in spacings. INWARD: share of the distance from a mesh node to the middle of its elements
 * by which its eye is moved. */
static const double REACH = 2, WITHIN = 1e-6, INWARD = 1e-5;
/* Distance from a point on the surface at which the body is tested beside it, in units of `near`. */
static const double BESIDE = 16;
/* Lengths and cosines that differ by less than this, relatively, differ by rounding only. */
static const double EQUAL = 1e-9;

/* ---- gaps along a segment ------------------------------------------------------------------------------ */
/* Drops the gaps of an alpha shape that its rim fills: those all of which lies within the rim's width of the
 * skin. */
static void fill_rim (between_gaps *g, const pg_shape *s, const between_way *w)
{
    double rim = pg_shape_alpha (s) ? pg_shape_alpha (s)->rim : 0;
    int kept = 0;
    for (int i = 0; i < g->n && rim > 0; i++) {
        double a = fmax (g->gap[i].t[0], 0), b = fmin (g->gap[i].t[1], 1), most = 0;
        for (int k = 1; k < 4; k++) {
            double x[3], t = a + 0.25 * k * (b - a);
            for (int c = 0; c < w->dim; c++) x[c] = w->x[c] + t * w->d[c];
            most = fmax (most, pg_skin_distance (s->solid->skin, x, 2 * rim, NULL));
        }
        g->gap[kept] = g->gap[i];
        kept += most > rim;
    }
    if (rim > 0) g->n = kept;
}

/* The gaps of a member. A segment that meets no face of a mesh is entirely inside or entirely outside of
 * it. */
static void gaps_of (between_gaps *out, const pg_between *b, const member *m, const between_way *w)
{
    if (!m->faces && (!m->shape || pg_shape_meshed (m->shape))) {
        out->n = out->full = 0;                        /* no face can be met */
        return;
    }
    if (!m->faces) {
        between_shape (out, m->shape, w);
        return;
    }
    between_faces_gaps (out, m->faces, w);
    if (!m->shape) return;
    if (out->n == 0 && !b->alone
        && pg_shape_types[m->shape->kind].distance (m->shape, b->dim, w->x, w->near) > w->near) {
        between_gap all = { .t = { -INFINITY, INFINITY } };
        between_gaps_add (out, &all);
    }
    fill_rim (out, m->shape, w);
}

static int meets (const pg_between *b, const member *m, const double *low, const double *high)
{
    for (int k = 0; k < b->dim; k++)
        if (!(m->box[k] <= high[k] + b->near && low[k] - b->near <= m->box[3 + k])) return 0;
    return 1;
}

/* The gaps of the body along a segment; o: the members that can be met (NULL: all are tested). */
static void gaps_along (between_gaps *out, const pg_between *b, const pg_outlook *o, const between_way *w)
{
    double low[3], high[3];
    size_t n = o && !o->all ? (size_t) o->n : b->n;
    *out = (between_gaps) { .n = 1, .gap[0] = { .t = { -INFINITY, INFINITY } } };
    for (int k = 0; k < b->dim; k++)
        low[k] = fmin (w->x[k], w->x[k] + w->d[k]), high[k] = fmax (w->x[k], w->x[k] + w->d[k]);
    for (size_t i = 0; i < n; i++) {
        const member *m = &b->member[o && !o->all ? (size_t) o->member[i] : i];
        between_gaps own, inside, all;
        if (!meets (b, m, low, high)) continue;
        gaps_of (&own, b, m, w);
        if (m->add) between_gaps_both (&all, out, &own, w->near / w->length);
        else between_gaps_turn (&inside, &own), between_gaps_any (&all, out, &inside);
        *out = all;
    }
}

/* Does point x lie on a face of a mesh? */
static int on_face (const pg_between *b, const double *x)
{
    for (size_t i = 0; i < b->n; i++)
        if (b->member[i].faces && between_faces_touch (b->member[i].faces, x, 2 * b->near)) return 1;
    return 0;
}

static double spacing_at (const pg_between *b, const double *x)
{
    long i = b->nearest ? pg_nearest_find (b->nearest, x, NULL, NULL) : -1;
    return i < 0 ? b->cloud->h : b->cloud->size[i];
}

/* Depth by which the chord of a smooth surface is moved into the body: BELOW_RISE times the rise of the
 * surface over the chord plus BELOW times the length of the chord. */
static const double BELOW_RISE = 2, BELOW = 0.02;

/* Does the gap, moved into the body by `depth` (m) against the direction `outward`, cross a slot? */
static int crosses_below (const pg_between *b, const between_gap *g, const between_way *w,
                          const double *outward, double depth)
{
    between_way below = { .dim = w->dim, .near = w->near, .length = (g->t[1] - g->t[0]) * w->length };
    between_gaps met;
    double size = 0, slack = 4 * w->near / below.length;
    for (int k = 0; k < w->dim; k++) size += outward[k] * outward[k];
    for (int k = 0; k < w->dim; k++) {
        below.x[k] = w->x[k] + g->t[0] * w->d[k] - depth * outward[k] / sqrt (size);
        below.d[k] = (g->t[1] - g->t[0]) * w->d[k];
    }
    /* no outlook: its box does not hold the moved segment */
    gaps_along (&met, b, NULL, &below);
    for (int i = 0; i < met.n; i++) {
        const between_gap *m = &met.gap[i];
        double turn = 0;
        for (int k = 0; k < w->dim; k++) turn += m->normal[0][k] * m->normal[1][k];
        if (m->t[0] > -slack && m->t[1] < 1 + slack && turn < AWAY) return 1;
    }
    return 0;
}

/* Does a gap like the chord of a smooth surface pass over the mouth of a slot, whose two sides are separated?
 * Moved into the body, below the surface, it then crosses the slot. same: cosine between the normals at its
 * ends; at the edge of a mouth one of them may be that of the slot. */
static int over_a_mouth (const pg_between *b, const between_gap *g, const between_way *w, double same)
{
    double length = (g->t[1] - g->t[0]) * w->length, mean[3] = { 0 };
    double rise = 0.5 * length * tan (0.25 * acos (fmax (-1, fmin (1, same))));
    double depth = BELOW_RISE * rise + BELOW * length + 8 * w->near;
    if (!(length > 8 * w->near)) return 0;
    for (int k = 0; k < w->dim; k++) mean[k] = g->normal[0][k] + g->normal[1][k];
    return crosses_below (b, g, w, mean, depth) || crosses_below (b, g, w, g->normal[0], depth)
           || crosses_below (b, g, w, g->normal[1], depth);
}

/* Does this gap separate the two ends of the segment? */
static int parts (const pg_between *b, const between_gap *g, const between_way *w)
{
    double slack = 4 * w->near / w->length, wide = (g->t[1] - g->t[0]) * w->length, same = 0, middle[3];
    if (!(g->t[0] >= -slack && g->t[1] <= 1 + slack)) return 0;
    if (wide <= 2 * w->near && !(g->t[0] > slack && g->t[1] < 1 - slack)) return 0;
    for (int k = 0; k < w->dim; k++) {
        same += g->normal[0][k] * g->normal[1][k];
        middle[k] = w->x[k] + 0.5 * (g->t[0] + g->t[1]) * w->d[k];
    }
    int narrow = same >= AWAY && wide <= (1 + EQUAL) * LONG * spacing_at (b, middle);
    if (same > SMOOTH - EQUAL || narrow) return over_a_mouth (b, g, w, same);
    /* A segment along a face runs in the body. */
    return wide <= 2 * w->near || !on_face (b, middle);
}

static int way_from (between_way *w, const pg_between *b, const double *x, const double *y)
{
    double size = 0;
    *w = (between_way) { .dim = b->dim, .near = b->near };
    for (int k = 0; k < b->dim; k++) w->x[k] = x[k], w->d[k] = y[k] - x[k], size += w->d[k] * w->d[k];
    w->length = sqrt (size);
    return w->length > 8 * b->near;
}

/* The segment always starts at the end with the smaller coordinates, so that x and y may be exchanged. */
int pg_between_parted (const pg_between *b, const pg_outlook *o, const double *x, const double *y)
{
    between_way w;
    between_gaps g;
    int k = 0;
    while (k < b->dim - 1 && x[k] == y[k]) k++;
    if (x[k] > y[k]) return pg_between_parted (b, o, y, x);
    if (!way_from (&w, b, x, y)) return 0;
    gaps_along (&g, b, o, &w);
    if (g.full) return 1;
    for (int i = 0; i < g.n; i++) if (parts (b, &g.gap[i], &w)) return 1;
    return 0;
}

int pg_between_outside (const pg_between *b, const double *x, const double *y, double after, double out[2])
{
    between_way w;
    between_gaps g;
    if (!way_from (&w, b, x, y)) return 0;
    gaps_along (&g, b, NULL, &w);
    for (int i = 0; i < g.n && !g.full; i++) {
        out[0] = fmax (after, g.gap[i].t[0]), out[1] = fmin (1, g.gap[i].t[1]);
        if (out[1] > out[0]) return 1;
    }
    return g.full ? -1 : 0;
}

/* ---- members that a segment in a box can meet ---------------------------------------------------------- */
/* Does this convex shape hold the whole box? */
static int holds (const pg_between *b, const member *m, const double *low, const double *high)
{
    for (int c = 0; c < 1 << b->dim; c++) {
        double x[3] = { 0 };
        for (int k = 0; k < b->dim; k++) x[k] = c >> k & 1 ? high[k] : low[k];
        if (pg_shape_types[m->shape->kind].distance (m->shape, b->dim, x, b->near) > 0) return 0;
    }
    return 1;
}

int pg_between_look (const pg_between *b, const double *low, const double *high, pg_outlook *o)
{
    o->n = o->all = 0;
    for (size_t i = 0; i < b->n; i++) {
        const member *m = &b->member[i];
        if (!meets (b, m, low, high)) continue;
        /* an added shape that fills the box makes all members before it irrelevant */
        if (m->add && m->convex && holds (b, m, low, high)) o->n = o->all = 0;
        if (o->n == PG_OUTLOOK) o->all = 1;
        else o->member[o->n++] = (int) i;
    }
    if (o->all || o->n > 1) return 1;
    if (o->n == 0) return 0;
    const member *m = &b->member[o->member[0]];
    if (m->faces) return between_faces_near (m->faces, low, high);
    return !m->convex;
}

/* ---- the eyes of points -------------------------------------------------------------------------------- */
/* Direction c of those along the axes and the diagonals, a unit vector. */
static void direction (int dim, int c, double *d)
{
    for (int k = 0; k < dim; k++)
        d[k] = c < 2 * dim ? (c / 2 == k) * (c % 2 ? 1 : -1)
                           : ((c - 2 * dim) >> k & 1 ? 1 : -1) / sqrt (dim);
}

static int directions (int dim) { return 2 * dim + (1 << dim); }

/* Has the body meshed shapes? Their distance function does not tell how deep inside them a point is. */
static int meshed (const pg_between *b)
{
    for (size_t i = 0; i < b->n; i++) if (b->member[i].faces) return 1;
    return 0;
}

/* Does point x lie in the body? If it lies on the surface, `eye` becomes a position just inside. In the end
 * of a bore or slot that is as long as the body is thick a point of the surface may have no body beside it:
 * it lies outside. */
static int stands (const pg_between *b, const double *x, double *eye)
{
    double sum[3] = { 0 }, size = 0, place[3];
    int beside = 0, dim = b->dim;
    if (!pg_body_inside (b->body, x, b->near)) return 0;
    if (meshed (b) || pg_body_inside (b->body, x, -b->near)) return 1;
    for (int c = 0; c < directions (dim); c++) {
        double d[3];
        direction (dim, c, d);
        for (int k = 0; k < dim; k++) place[k] = x[k] + BESIDE * b->near * d[k];
        if (!pg_body_inside (b->body, place, -b->near)) continue;
        beside = 1;
        for (int k = 0; k < dim; k++) sum[k] += d[k];
    }
    for (int k = 0; k < dim; k++) size += sum[k] * sum[k];
    if (!(size > 1e-6)) return beside;
    for (int k = 0; k < dim; k++) place[k] = x[k] + BESIDE * b->near * sum[k] / sqrt (size);
    if (pg_body_inside (b->body, place, -b->near)) memcpy (eye, place, (size_t) dim * sizeof *eye);
    return 1;
}

/* The positions in the body nearest to a point outside: distance of the nearest in units of REACH spacings,
 * one of the equally near ones, how many these are, and the sum of the vectors to them, m. */
typedef struct { double best, found[3], sum[3]; int n; } outcome;

/* Searches the body along the unit vector d from `from`, a position outside; x: the point whose eye is
 * sought. */
static void seek_along (const pg_between *b, const double *x, const double *from, const double *d, double h,
                        outcome *o)
{
    between_way w = { .dim = b->dim, .near = b->near, .length = REACH * h };
    between_gaps g;
    for (int k = 0; k < b->dim; k++) w.x[k] = from[k], w.d[k] = d[k] * w.length;
    gaps_along (&g, b, NULL, &w);
    for (int i = 0; i < g.n; i++) {
        double t = g.gap[i].t[1], place[3];
        if (g.gap[i].t[0] > 0 || !(t >= 0 && t <= 1) || !(t <= o->best * (1 + EQUAL))) continue;
        for (int k = 0; k < b->dim; k++) place[k] = from[k] + (t + WITHIN / REACH) * w.d[k];
        if (!meshed (b) && !pg_body_inside (b->body, place, -b->near)) continue;
        if (t < o->best * (1 - EQUAL)) {
            *o = (outcome) { .best = t };
            memcpy (o->found, place, (size_t) b->dim * sizeof *place);
        }
        for (int k = 0; k < b->dim; k++) o->sum[k] += place[k] - x[k];
        o->n++;
    }
}

/* Searches the body along all axes and diagonals. */
static void seek (const pg_between *b, const double *x, const double *from, double h, outcome *o)
{
    for (int c = 0; c < directions (b->dim); c++) {
        double d[3];
        direction (b->dim, c, d);
        seek_along (b, x, from, d, h, o);
    }
}

/* Of several equally near positions none is preferred by its direction, or by rounding: the one along the sum
 * of the vectors to them is taken, such as a corner between two faces. On opposite sides, as from the middle
 * of a slot, the sum vanishes: the first one stays. */
static void settle (const pg_between *b, const double *x, double h, outcome *o)
{
    double size = 0, d[3];
    outcome middle = { .best = INFINITY };
    for (int k = 0; k < b->dim; k++) size += o->sum[k] * o->sum[k];
    size = sqrt (size);
    if (o->n < 2 || !(size > 1e-3 * h * o->best)) return;
    for (int k = 0; k < b->dim; k++) d[k] = o->sum[k] / size;
    seek_along (b, x, x, d, h, &middle);
    if (middle.best <= 1) *o = middle;
}

void pg_between_eye (const pg_between *b, const double *x, double *eye)
{
    outcome o = { .best = INFINITY };
    double h;
    memcpy (eye, x, (size_t) b->dim * sizeof *x);
    if (!b->body || stands (b, x, eye)) return;
    h = spacing_at (b, x);
    if (!pg_body_inside (b->body, x, b->near)) seek (b, x, x, h, &o), settle (b, x, h, &o);
    else
        for (int c = 0; c < directions (b->dim); c++) {
            double from[3];
            direction (b->dim, c, from);
            for (int k = 0; k < b->dim; k++) from[k] = x[k] + BESIDE * b->near * from[k];
            seek (b, x, from, h, &o);
        }
    if (o.best <= 1) memcpy (eye, o.found, (size_t) b->dim * sizeof *x);
}

const double *pg_between_eye_of (const pg_between *b, size_t i)
{
    return (b->eye ? b->eye : b->cloud->x) + i * (size_t) b->dim;
}

/* Moves the eyes of nodes on the faces of a mesh slightly inside their elements. */
static pg_status look_inward (pg_between *b, const pg_mesh_body *part)
{
    pg_status status = PG_OK;
    const pg_mesh *m = &part->mesh;
    const pg_cloud *c = b->cloud;
    size_t dim = (size_t) b->dim;
    double *sum = NULL;
    int *held = NULL;
    PG_ALLOC (b->eye, c->n * dim);
    PG_ALLOC (sum, m->nnode * 4);
    /* by number in the whole body: the point on this rank, from 1; 0: other ranks hold it */
    PG_ALLOC (held, m->nnode);
    for (size_t i = 0; i < c->n; i++) held[pg_cloud_number (c, i)] = (int) i + 1;
    for (size_t e = 0; e < m->n; e++) {
        double centre[3] = { 0 }, corners = pg_element_types[m->kind[e]].corners;
        const int *node = m->node + m->start[e];
        for (int v = 0; v < (int) corners; v++)
            for (size_t k = 0; k < dim; k++) centre[k] += m->x[3 * (size_t) node[v] + k] / corners;
        for (size_t i = 0; i < m->start[e + 1] - m->start[e]; i++) {
            for (size_t k = 0; k < dim; k++) sum[4 * (size_t) node[i] + k] += centre[k];
            sum[4 * (size_t) node[i] + 3]++;
        }
    }
    memcpy (b->eye, c->x, c->n * dim * sizeof *b->eye);
    for (size_t i = 0; i < m->nnode; i++) {
        const double *x = m->x + 3*i;
        int at = part->point[i] < 0 ? 0 : held[part->point[i]];
        if (!at || !between_faces_touch (b->member->faces, x, b->near)) continue;
        for (size_t k = 0; k < dim; k++)
            b->eye[(size_t) (at - 1) * dim + k] += INWARD * (sum[4*i + k] / sum[4*i + 3] - x[k]);
    }
done:
    pg_free (sum), pg_free (held);
    return status;
}

/* Moves the eyes of points outside the body or on its surface into it, if there are such points. */
static pg_status draw_back (pg_between *b)
{
    pg_status status = PG_OK;
    const pg_cloud *c = b->cloud;
    size_t dim = (size_t) b->dim;
    for (size_t i = 0; i < c->n; i++) {
        double eye[3];
        const double *x = c->x + i * dim;
        pg_between_eye (b, x, eye);
        if (!memcmp (eye, x, dim * sizeof *x)) continue;
        if (!b->eye) {
            PG_ALLOC (b->eye, c->n * dim);
            memcpy (b->eye, c->x, c->n * dim * sizeof *eye);
        }
        memcpy (b->eye + i * dim, eye, dim * sizeof *eye);
    }
done:
    return status;
}

/* ---- creation ------------------------------------------------------------------------------------------ */
static pg_status add_shapes (pg_between *b, const pg_body *body)
{
    pg_status status = PG_OK;
    b->alone = body->n == 1, b->body = body;
    PG_ALLOC (b->member, body->n);
    for (size_t i = 0; i < body->n; i++) {
        const pg_shape *s = &body->shape[i];
        member *m = &b->member[b->n++];
        *m = (member) { .shape = s, .add = s->add, .convex = between_convex (s) };
        pg_shape_types[s->kind].box (s, body->dim, m->box, m->box + 3);
        const pg_alpha_shape *points = pg_shape_alpha (s);
        if (pg_shape_meshed (s))
            PG_TRY (between_faces_create (&m->faces, points ? &points->mesh : &s->solid->part.mesh,
                                          b->alone && !(points && points->rim > 0)));
    }
done:
    return status;
}

static pg_status add_mesh (pg_between *b, const pg_mesh *mesh)
{
    pg_status status = PG_OK;
    b->alone = 1;
    PG_ALLOC (b->member, 1);
    b->n = 1;
    b->member->add = 1;
    for (int k = 0; k < 3; k++) b->member->box[k] = -INFINITY, b->member->box[3 + k] = INFINITY;
    PG_TRY (between_faces_create (&b->member->faces, mesh, 1));
done:
    return status;
}

int pg_body_parts (const pg_body *body, const pg_mesh_body *part)
{
    if (!body->n && !part->mesh.n) return -1;
    return part->mesh.n > 0 || body->n > 1 || !between_convex (body->shape);
}

pg_status pg_between_create (pg_between **out, const pg_body *body, const pg_mesh_body *part,
                             const pg_cloud *cloud)
{
    pg_status status = PG_OK;
    pg_between *b = NULL;
    *out = NULL;
    if (pg_body_parts (body, part) <= 0) return PG_OK;
    PG_ALLOC (b, 1);
    b->dim = cloud->dim, b->cloud = cloud;
    b->near = pg_cloud_same (cloud);
    if (part->mesh.n) PG_TRY (add_mesh (b, &part->mesh));
    else PG_TRY (add_shapes (b, body));
    if (!b->member->shape && !b->member->faces) goto done;
    if (cloud->size) PG_TRY (pg_nearest_create (&b->nearest, cloud->dim, cloud->n, cloud->x));
    if (part->mesh.n) PG_TRY (look_inward (b, part));
    else PG_TRY (draw_back (b));
    *out = b, b = NULL;
done:
    pg_between_free (&b);
    return status;
}

void pg_between_free (pg_between **between)
{
    pg_between *b = *between;
    if (!b) return;
    for (size_t i = 0; i < b->n; i++) between_faces_free (&b->member[i].faces);
    pg_free (b->member), pg_free (b->eye);
    pg_nearest_free (&b->nearest);
    pg_free (b);
    *between = NULL;
}

/* ---- removing separated points from families ----------------------------------------------------------- */
typedef struct {
    const pg_between *b;
    pg_family *f;
    const double *centre, *eye;
    const int *own;
    size_t *kept;
} sifting;

/* Bounding box of `place`, the position or eye of centre i, and of its family: of the points or (eyes 1) of
 * their eyes. */
static void box_of (const sifting *s, size_t i, const double *place, int eyes, double *low, double *high)
{
    size_t dim = (size_t) s->b->dim;
    memcpy (low, place, dim * sizeof *low), memcpy (high, low, dim * sizeof *high);
    for (size_t e = s->f->start[i]; e < s->f->start[i + 1]; e++) {
        size_t node = (size_t) s->f->node[e];
        const double *x = eyes ? pg_between_eye_of (s->b, node) : s->b->cloud->x + node * dim;
        for (size_t k = 0; k < dim; k++) low[k] = fmin (low[k], x[k]), high[k] = fmax (high[k], x[k]);
    }
}

/* Removes the separated points from the families of centres first .. last - 1; each writes into its own part
 * of the list. */
static void sift_those (void *context, size_t first, size_t last, int thread)
{
    const sifting *s = context;
    size_t dim = (size_t) s->b->dim;
    (void) thread;
    for (size_t i = first; i < last; i++) {
        double low[3], high[3], eye[3];
        pg_outlook o;
        size_t begin = s->f->start[i], n = begin;
        s->kept[i] = s->f->start[i + 1] - begin;
        box_of (s, i, s->centre + i * dim, 0, low, high);
        double reach = REACH * spacing_at (s->b, s->centre + i * dim);
        for (size_t k = 0; k < dim; k++) low[k] -= reach, high[k] += reach;
        if (!pg_between_look (s->b, low, high, &o)) continue;
        if (s->own && s->own[i] >= 0)
            memcpy (eye, pg_between_eye_of (s->b, (size_t) s->own[i]), dim * sizeof *eye);
        else pg_between_eye (s->b, (s->eye ? s->eye : s->centre) + i * dim, eye);
        /* all that a segment between any two of them can meet, so that the answer is the same from either
         * end */
        box_of (s, i, eye, 1, low, high);
        if (!pg_between_look (s->b, low, high, &o)) continue;
        for (size_t e = begin; e < s->f->start[i + 1]; e++) {
            int j = s->f->node[e];
            s->f->node[n] = j;
            n += (s->own && s->own[i] == j)
                 || !pg_between_parted (s->b, &o, eye, pg_between_eye_of (s->b, (size_t) j));
        }
        s->kept[i] = n - begin;
    }
}

pg_status pg_between_sift (const pg_between *b, pg_family *f, const double *centre, const double *eye,
                           const int *own, int threads, size_t *parted)
{
    pg_status status = PG_OK;
    sifting s = { b, f, centre, eye, own, NULL };
    size_t at = 0;
    *parted = 0;
    if (!b) return PG_OK;
    PG_ALLOC (s.kept, f->n);
    pg_parallel (threads, f->n, sift_those, &s);
    for (size_t i = 0, begin = 0; i < f->n; i++) {
        size_t end = f->start[i + 1];
        memmove (f->node + at, f->node + begin, s.kept[i] * sizeof *f->node);
        at += s.kept[i], *parted += end - begin - s.kept[i];
        f->start[i + 1] = at, begin = end;
    }
done:
    pg_free (s.kept);
    return status;
}
