/* SPDX-License-Identifier: GPL-3.0-or-later
 * Quadrature in a cut cell and on the surfaces in it, by dimension reduction after Saye 2015 (SIAM J. Sci.
 * Comput. 37(2), A993-A1019, doi 10.1137/140966290).
 *
 * The cell [-1, 1]^dim is divided along its outermost axis at the values that cut_split finds (hard
 * splits); between them Gauss points; each Gauss point is a slice in which the same is done with the next
 * axis; on the innermost axis, the height, a line remains. A line is divided at its intersections with the
 * surfaces, and each piece that lies in the body gets Gauss points (volume), or each intersection that
 * bounds the body becomes one point (surface). All weights are positive, because they are products of
 * positive ones.
 *
 * Where a surface turns back along the height, the length of the lines begins like a square root at some e
 * (a soft split). The substitution x = e +- s^2 makes the integrand smooth again, so that the error falls
 * exponentially with the order there too. */
#include "cut.h"
#include <math.h>
#include <string.h>

/* Largest number of Gauss points per interval. */
enum { RULE = 40 };
/* A position this far off a face (local) lies on the other side of it for certain: farther than cut_snap. */
static const double beyond = 2e-7;

/* The workspace. It serves one cell and one quadrature (recursion over slices and lines) at a time. */
struct cut_work {
    const struct pg_cut *cut;
    /* Thickness in 2D or cross section in 1D; centre and half edges of the present cell, m. */
    double thickness, centre[3], half[3];
    /* Surfaces of the cell and state of the recursion. */
    cut_slices slices;
    /* Roots along the present line with the two ends of the line (2 n + 2), and the surface that each
     * belongs to. */
    double *node;  int *owner;
    /* The quadrature under way: index of its surface within slices.number, -1: the volume; Gauss points per
     * interval; the face of the cell to which it is confined, -1: none; the part between dividing
     * half-planes. */
    int    surface, order, face, part;
    /* Slices and pieces of lines thinner than this (local) are omitted (cut_work_leave_slivers). */
    double thin;
    /* Number of surfaces near the cell without and with the dividing half-planes, which come last. */
    size_t real, all;
    /* Receives the points. */
    pg_cut_points *out;
    /* Largest relative change of a size at which cut_work_piece gave up raising the order, over all calls:
     * see cut_work_unsettled. */
    double unsettled;
    /* Gauss points and weights on [0, 1] of all orders up to RULE, one behind the other. */
    double *x, *w;
};

void pg_cut_points_clear (pg_cut_points *p)
{
    pg_free (p->x), pg_free (p->weight), pg_free (p->normal);
    memset (p, 0, sizeof *p);
}

/* ---- Gauss rules --------------------------------------------------------------------------------------- */
/* Points and weights on [0, 1] of the Gauss rule of n points. */
static const double *rule_x (const cut_work *w, int n) { return w->x + n * (n - 1) / 2; }
static const double *rule_w (const cut_work *w, int n) { return w->w + n * (n - 1) / 2; }

/* ---- life cycle ---------------------------------------------------------------------------------------- */
/* All Gauss rules are computed once, here. */
pg_status cut_work_create (cut_work **out, const struct pg_cut *cut, double thickness)
{
    pg_status status = PG_OK;
    cut_work *w = NULL;
    PG_ALLOC (w, 1);
    w->cut = cut, w->thickness = thickness, w->face = -1;
    PG_ALLOC (w->x, RULE * (RULE + 1) / 2);
    PG_ALLOC (w->w, RULE * (RULE + 1) / 2);
    for (int n = 1; n <= RULE; n++) cut_gauss (n, w->x + n * (n - 1) / 2, w->w + n * (n - 1) / 2);
    *out = w;
    w = NULL;
done:
    cut_work_free (&w);
    return status;
}

void cut_work_free (cut_work **work)
{
    cut_work *w = *work;
    if (!w) return;
    for (int k = 0; k < 3; k++)
        pg_free (w->slices.level[k].hard.at), pg_free (w->slices.level[k].soft.at),
            pg_free (w->slices.level[k].q);
    pg_free (w->slices.number), pg_free (w->slices.low), pg_free (w->slices.high);
    pg_free (w->slices.facets), pg_free (w->slices.mute), pg_free (w->slices.edge);
    pg_free (w->slices.edge_of);
    pg_free (w->node), pg_free (w->owner), pg_free (w->x), pg_free (w->w);
    pg_free (w);
    *work = NULL;
}

/* Provides memory for n surfaces. All arrays of the workspace grow together. */
static pg_status widen (cut_work *w, size_t n)
{
    pg_status status = PG_OK;
    cut_slices *s = &w->slices;
    size_t cap[10];
    if (n <= s->capacity) return PG_OK;
    for (int k = 0; k < 10; k++) cap[k] = 0;
    for (int k = 0; k < 3; k++) PG_GROW (s->level[k].q, cap[k], n);
    PG_GROW (s->number, cap[3], n);
    PG_GROW (s->low, cap[4], 3 * n);
    PG_GROW (s->high, cap[5], 3 * n);
    PG_GROW (w->node, cap[6], 2 * n + 2);
    PG_GROW (w->owner, cap[7], 2 * n + 2);
    PG_GROW (s->facets, cap[8], n);
    PG_GROW (s->mute, cap[9], n);
    s->capacity = n;
done:
    return status;
}

/* Appends the edges of a region that come near the cell, in local coordinates. */
static pg_status add_edges (cut_work *w, int surface, const pg_facets *f, int region)
{
    pg_status status = PG_OK;
    cut_slices *s = &w->slices;
    size_t dim = (size_t) s->dim, size = (dim - 1) * dim;
    for (size_t e = f->edge_first[region]; e < f->edge_first[region + 1]; e++) {
        double at[6], low[3], high[3];
        int near = 1;
        for (size_t c = 0; c < size; c++) {
            size_t k = c % dim;
            at[c] = (f->edge[e * size + c] - w->centre[k]) / w->half[k];
            if (c < dim) low[k] = high[k] = at[c];
            low[k] = fmin (low[k], at[c]), high[k] = fmax (high[k], at[c]);
        }
        for (size_t k = 0; k < dim; k++) near &= low[k] <= 1 + 1e-9 && high[k] >= -1 - 1e-9;
        if (!near) continue;
        PG_GROW (s->edge, s->edge_room, 6 * (s->nedge + 1));
        PG_GROW (s->edge_of, s->edge_of_room, s->nedge + 1);
        memcpy (s->edge + 6 * s->nedge, at, size * sizeof *at);
        s->edge_of[s->nedge++] = surface;
    }
done:
    return status;
}

/* Restates the surfaces and their boxes in the local coordinates of the cell. */
pg_status cut_work_cell (cut_work *w, const double *low, const double *high, size_t n, const int *near)
{
    cut_slices *s = &w->slices;
    pg_status status = widen (w, n);
    if (status != PG_OK) return status;
    s->dim = w->cut->dim, s->n = n, s->status = PG_OK;
    w->all = w->real = n;
    /* half-planes come last */
    while (w->real > 0 && w->cut->surface[near[w->real - 1]].shape < 0) w->real--;
    for (int k = 0; k < s->dim; k++)
        w->centre[k] = 0.5 * (low[k] + high[k]), w->half[k] = 0.5 * (high[k] - low[k]);
    double least = w->half[0];
    for (int k = 1; k < s->dim; k++) least = fmin (least, w->half[k]);
    s->rounding = 1e-13 + w->cut->rounding / least;
    s->snap = cut_snap + s->rounding, s->equal = cut_equal + s->rounding;
    for (size_t i = 0; i < n; i++) {
        const cut_surface *f = &w->cut->surface[near[i]];
        s->number[i] = near[i];
        s->level[0].q[i] = cut_local (f, s->dim, w->centre, w->half);
        for (int k = 0; k < s->dim; k++) {
            s->low[3*i + (size_t) k] = (f->low[k] - w->centre[k]) / w->half[k];
            s->high[3*i + (size_t) k] = (f->high[k] - w->centre[k]) / w->half[k];
        }
        s->facets[i] = f->facets;
    }
    s->nedge = 0;
    for (size_t i = 0; i < n && status == PG_OK; i++)
        if (s->facets[i]) status = add_edges (w, (int) i, s->facets[i], w->cut->surface[near[i]].region);
    return status;
}

/* ---- points on a line ---------------------------------------------------------------------------------- */
/* Is the position at height z on the present line in the body? For quadrature on a face: is the body on both
 * sides of the face there? */
static int inside (const cut_work *w, double z)
{
    const cut_slices *s = &w->slices;
    double x[3] = {0, 0, 0};
    for (int k = 0; k < s->dim; k++)
        x[k] = w->centre[k] + w->half[k] * (k == s->axis[s->dim - 1] ? z : s->at[k]);
    if (w->face < 0) return pg_body_inside (&w->cut->body, x, 0);
    double *across = &x[w->face / 2], at = *across, step = beyond * w->half[w->face / 2];
    *across = at - step;
    if (!pg_body_inside (&w->cut->body, x, 0)) return 0;
    *across = at + step;
    return pg_body_inside (&w->cut->body, x, 0);
}

/* On which sides of the dividing half-planes a local position lies: bit i is set where it is on the
 * positive side of half-plane i. */
static int side_of_half_planes (const cut_work *w, const double *at)
{
    int part = 0;
    for (size_t i = w->real; i < w->all && i < w->real + CUT_HALF_PLANES; i++)
        part |= (cut_value (&w->slices.level[0].q[i], at) > w->slices.equal) << (i - w->real);
    return part;
}

/* Appends a point at height z of the present line. A failed allocation is noted in slices.status, which ends
 * the recursion. */
static void emit (cut_work *w, double z, double weight, const double *normal)
{
    pg_status status = PG_OK;
    cut_slices *s = &w->slices;
    pg_cut_points *p = w->out;
    size_t dim = (size_t) s->dim;
    s->at[s->axis[dim - 1]] = z;
    if (p->n == p->capacity) {
        size_t a = p->capacity, b = a, c = a;
        PG_GROW (p->weight, a, p->n + 1);
        size_t wide = dim * b, tall = dim * c;
        PG_GROW (p->x, wide, dim * a);
        PG_GROW (p->normal, tall, dim * a);
        p->capacity = a;
    }
    for (size_t k = 0; k < dim; k++) {
        p->x[p->n * dim + k] = w->centre[k] + w->half[k] * s->at[k];
        p->normal[p->n * dim + k] = normal ? normal[k] : 0;
    }
    p->weight[p->n++] = weight;
done:
    if (status != PG_OK) s->status = status;
}

/* Intersections of the present line with all surfaces, ascending in node[1..m] with their owners; those
 * within s->snap of an end are moved onto it. node[0] = -1 and node[m + 1] = 1 are the ends. Returns m. */
static int line_roots (cut_work *w, const cut_quadric *q)
{
    cut_slices *s = &w->slices;
    int z = s->axis[s->dim - 1], m = 0;
    for (size_t i = 0; i < s->n; i++) {
        if (s->mute[i]) continue;
        double c[3] = {q[i].c, q[i].b[z], q[i].A[z][z]}, root[2];
        int n = cut_roots (2, c, s->rounding, -1 - s->snap, 1 + s->snap, root);
        for (int r = 0; r < n; r++) {
            double t = fabs (root[r]) >= 1 - s->snap ? copysign (1, root[r]) : root[r];
            s->at[z] = t;
            if (s->facets[i] && !cut_within (s, i)) continue;
            int k = ++m;
            for (; k > 1 && w->node[k - 1] > t; k--)
                w->node[k] = w->node[k - 1], w->owner[k] = w->owner[k - 1];
            w->node[k] = t, w->owner[k] = (int) i;
        }
    }
    w->node[0] = -1, w->node[m + 1] = 1;
    return m;
}

/* Gauss points on the piece from..to of the line; nothing where it is empty, or thin. */
static void fill_piece (cut_work *w, double from, double to, double weight)
{
    for (int g = 0; to - from > w->thin && g < w->order; g++)
        emit (w, from + (to - from) * rule_x (w, w->order)[g], weight * (to - from) * rule_w (w, w->order)[g],
              NULL);
}

/* Returns the pg_facets of which all surfaces near the cell are regions; NULL: there are other surfaces too,
 * or none. */
static const pg_facets *only_facets (const cut_work *w)
{
    const cut_slices *s = &w->slices;
    for (size_t i = 1; i < s->n; i++) if (s->facets[i] != s->facets[0]) return NULL;
    return s->n ? s->facets[0] : NULL;
}

/* Volume points on the present line where only one shape of pg_facets comes near the cell: the body is then
 * the same wherever that shape is inside, and wherever it is outside, so that two tests of the body suffice.
 * Returns 0 where this does not apply. */
static int line_between_facets (cut_work *w, double weight)
{
    enum { CROSSINGS = 64 };
    const cut_slices *s = &w->slices;
    const pg_facets *f = w->face < 0 ? only_facets (w) : NULL;
    int z = s->axis[s->dim - 1], sense[CROSSINGS], above = 0, known[2] = { -1, -1 };
    double x[3] = { 0, 0, 0 }, at[CROSSINGS], from = 0, to = -3, low = -1;
    if (!f) return 0;
    for (int k = 0; k < s->dim; k++)
        x[k] = w->centre[k] + w->half[k] * (k == z ? 0 : s->at[k]), weight *= w->half[k];
    int n = pg_facets_line (f, x, z, CROSSINGS, at, sense);
    if (n < 0) return 0;
    for (int i = 0; i < n; i++) above += sense[i];
    for (int i = 0; i <= n; i++) {
        double high = i < n ? fmin (1, fmax (-1, (at[i] - w->centre[z]) / w->half[z])) : 1;
        int in = above > 0;
        if (fabs (high) >= 1 - s->snap) high = copysign (1, high);
        if (high - low > s->rounding) {
            if (known[in] < 0) known[in] = inside (w, 0.5 * (low + high));
            if (known[in]) {
                if (!(low - to <= s->rounding)) fill_piece (w, from, to, weight), from = low;
                to = high;
            }
        }
        low = fmax (low, high);
        if (i < n) above -= sense[i];
    }
    fill_piece (w, from, to, weight);
    return 1;
}

/* Volume points on the present line. Neighbouring pieces that both lie in the body are joined, as no surface
 * of the body separates them, only the continuation of one; fewer points suffice then. Pieces between planes
 * normal to the axes are not joined, as their points must not depend on the order of axes. */
static void line_volume (cut_work *w, const cut_quadric *q, double weight)
{
    if (line_between_facets (w, weight)) return;
    int m = line_roots (w, q), dim = w->slices.dim;
    double from = 0, to = -3, rounding = w->slices.rounding;
    for (int k = 0; k < dim; k++) weight *= w->half[k];
    for (int k = 0; k <= m; k++) {
        double a = w->node[k], b = w->node[k + 1];
        if (b - a <= rounding || !inside (w, 0.5 * (a + b))) continue;
        if (!(a - to <= rounding) || w->slices.square) fill_piece (w, from, to, weight), from = a;
        to = b;
    }
    fill_piece (w, from, to, weight);
}

/* Does surface i extend to the position s->at? Judged by its box; for a region of pg_facets by its
 * triangles. */
static int reaches (const cut_work *w, size_t i)
{
    const cut_slices *s = &w->slices;
    double x[3] = { 0, 0, 0 };
    if (!cut_within (s, i)) return 0;
    if (!s->facets[i]) return 1;
    for (int k = 0; k < s->dim; k++) x[k] = w->centre[k] + w->half[k] * s->at[k];
    return pg_facets_meets (s->facets[i], w->cut->surface[s->number[i]].region, x, s->axis[s->dim - 1]);
}

/* Is root k (of m) an intersection with the surface under quadrature, within its box, and the first surface
 * that claims this position? Coincident surfaces would count twice otherwise. */
static int owned (cut_work *w, int k, int m)
{
    cut_slices *s = &w->slices;
    int z = s->axis[s->dim - 1];
    if (w->owner[k] != w->surface) return 0;
    s->at[z] = w->node[k];
    if (!reaches (w, (size_t) w->surface)) return 0;
    for (int i = k; i-- > 1 && w->node[k] - w->node[i] < s->rounding;)
        if (w->owner[i] < w->surface && reaches (w, (size_t) w->owner[i])) return 0;
    for (int i = k + 1; i <= m && w->node[i] - w->node[k] < s->rounding; i++)
        if (w->owner[i] < w->surface && reaches (w, (size_t) w->owner[i])) return 0;
    return 1;
}

/* Emits the point of the surface at height t on the present line; `under`: the body lies below it. The
 * element of area is that of the projection on the plane normal to the height, divided by the cosine between
 * normal and height. */
static void emit_surface (cut_work *w, double t, int under, double weight)
{
    const cut_slices *s = &w->slices;
    int z = s->axis[s->dim - 1];
    double n[3], size = 0, at[3] = { s->at[0], s->at[1], s->at[2] };
    at[z] = t;
    if (side_of_half_planes (w, at) != w->part) return;
    cut_gradient (&s->level[0].q[w->surface], at, n);
    double steep = fabs (n[z]) / w->half[z], sign = (n[z] > 0) == under ? 1 : -1;
    double scale = weight * w->thickness;
    for (int i = 0; i < s->dim; i++) {
        n[i] *= sign / w->half[i], size += n[i] * n[i];
        if (i != z) scale *= w->half[i];
    }
    size = sqrt (size);
    for (int i = 0; i < s->dim; i++) n[i] /= size;
    emit (w, t, scale * size / steep, n);
    w->slices.at[z] = at[z];
}

/* Surface points on the present line: intersections with the surface under quadrature that have the body on
 * exactly one side. A root at an end of the line lies on a face between two cells: it counts for the cell
 * that has the body. */
static void line_surface (cut_work *w, const cut_quadric *q, double weight)
{
    int m = line_roots (w, q);
    const double *t = w->node, rounding = w->slices.rounding;
    for (int k = 1; k <= m; k++) {
        int a = k, b = k;
        if (!owned (w, k, m)) continue;
        while (a > 0 && t[k] - t[a] < rounding) a--;
        while (b < m + 1 && t[b] - t[k] < rounding) b++;
        double low = 0.5 * (t[k] + (t[k] - t[a] < rounding ? -1 - beyond : t[a])),
               high = 0.5 * (t[k] + (t[b] - t[k] < rounding ? 1 + beyond : t[b]));
        /* Other regions of the same pg_facets are not among the roots and may lie near: the body is tested
         * close by. */
        if (w->slices.facets[w->surface]) low = t[k] - beyond, high = t[k] + beyond;
        int under = inside (w, low), over = inside (w, high);
        if (under == over || (t[k] == -1 && under) || (t[k] == 1 && over)) continue;
        emit_surface (w, t[k], under, weight);
    }
}

/* ---- recursion over slices ----------------------------------------------------------------------------- */
/* Quadrature over level k of the recursion, k = 0 first; weight: product of the weights so far. */
static void walk (cut_work *w, int k, double weight);

/* Fixes the coordinate of level k and descends into that slice. */
static void go_on (cut_work *w, int k, double at, double weight)
{
    cut_slices *s = &w->slices;
    s->at[s->axis[k]] = at;
    for (size_t i = 0; i < s->n; i++) {
        s->level[k + 1].q[i] = s->level[k].q[i];
        cut_restrict (&s->level[k + 1].q[i], s->axis[k], at);
    }
    walk (w, k + 1, weight);
}

/* Visits the Gauss points on [a, b] of level k. root: NAN, or a soft split at a or below, or at b or above;
 * then x = root +- s^2, with half as many points again, because the substitution doubles the degree. */
static void interval (cut_work *w, int k, double a, double b, double root, double weight)
{
    int order = w->order, rooted = !isnan (root), up = rooted && root <= a;
    if (rooted) order = order + 1 + order / 2;
    if (order > RULE) order = RULE;
    double from = !rooted ? a : sqrt (fmax (0, up ? a - root : root - b)),
           to = !rooted ? b : sqrt (up ? b - root : root - a);
    for (int g = 0; g < order; g++) {
        double t = from + (to - from) * rule_x (w, order)[g], v = weight * (to - from) * rule_w (w, order)[g];
        if (!rooted) go_on (w, k, t, v);
        else go_on (w, k, up ? root + t * t : root - t * t, 2 * t * v);
    }
}

/* The soft split nearest to the end `at` of an interval, on its outer side (before: below it) and no
 * farther away than the interval is long; NAN: none. Farther ones leave the integrand smooth enough. */
static double nearest (const cut_list *soft, double at, int before, double length, double rounding)
{
    double best = NAN;
    for (size_t i = 0; i < soft->n; i++) {
        double gap = before ? at - soft->at[i] : soft->at[i] - at;
        if (gap < -fmax (1e-12, rounding) || gap > length + cut_equal + rounding) continue;
        double root = gap < rounding ? at : soft->at[i];
        if (isnan (best) || fabs (root - at) < fabs (best - at)) best = root;
    }
    return best;
}

/* Insertion sort: lists are short. */
static void sort (cut_list *list)
{
    for (size_t i = 1; i < list->n; i++) {
        double v = list->at[i];
        size_t k = i;
        for (; k > 0 && list->at[k - 1] > v; k--) list->at[k] = list->at[k - 1];
        list->at[k] = v;
    }
}

/* An interval with soft splits at both ends is halved, so that each half has one. */
static void walk (cut_work *w, int k, double weight)
{
    cut_slices *s = &w->slices;
    if (s->status != PG_OK) return;
    if (k == s->dim - 1) {
        if (w->surface < 0) line_volume (w, s->level[k].q, weight);
        else line_surface (w, s->level[k].q, weight);
        return;
    }
    cut_split (s, k);
    if (s->status != PG_OK) return;
    sort (&s->level[k].hard);
    double a = -1;
    for (size_t i = 0; i <= s->level[k].hard.n; i++) {
        double b = i < s->level[k].hard.n ? s->level[k].hard.at[i] : 1;
        /* a split within the tolerance of the face lies on it */
        if (1 - b < s->snap) b = 1;
        if (b - a < fmax (w->thin, a == -1 ? s->snap : fmax (1e-12, s->rounding))) continue;
        double left = nearest (&s->level[k].soft, a, 1, b - a, s->rounding),
               right = nearest (&s->level[k].soft, b, 0, b - a, s->rounding), middle = 0.5 * (a + b);
        if (!isnan (left) && !isnan (right)) {
            interval (w, k, a, middle, left, weight);
            interval (w, k, middle, b, right, weight);
        } else interval (w, k, a, b, isnan (left) ? right : left, weight);
        a = b;
    }
}

size_t cut_work_half_planes (const cut_work *w)
{
    return w->all - w->real < CUT_HALF_PLANES ? w->all - w->real : CUT_HALF_PLANES;
}

void cut_work_leave_slivers (cut_work *w, int leave)
{
    const double sliver = 100;                         /* thickness, in units of the rounding */
    w->thin = leave ? sliver * w->slices.rounding : 0;
}

pg_status cut_work_points (cut_work *w, int surface, int part, int order, pg_cut_points *out)
{
    cut_slices *s = &w->slices;
    w->part = part, s->n = surface < 0 ? w->real : w->all;
    w->surface = -1, w->out = out, w->order = order < 1 ? 1 : order > RULE ? RULE : order;
    for (size_t i = 0; i < s->n && surface >= 0; i++) if (s->number[i] == surface) w->surface = (int) i;
    if (surface >= 0 && w->surface < 0) return PG_OK;
    /* A region of pg_facets ends at its own edges: the other regions are left out. */
    for (size_t i = 0; i < s->n; i++)
        s->mute[i] = w->surface >= 0 && (int) i != w->surface && cut_same_facets (s, i, (size_t) w->surface);
    int order_of[6][3], orders = cut_axes (s, w->cut, w->surface, -1, 0, order_of);
    for (int k = 0; k < orders && s->status == PG_OK; k++) {
        memcpy (s->axis, order_of[k], sizeof s->axis);
        walk (w, 0, (w->surface < 0 ? w->thickness : 1) / orders);
    }
    return s->status;
}

/* The face's axis becomes the outermost, fixed at the face; the quadrature covers the other axes. The weight
 * of the outermost axis, half an edge, is divided out again. */
pg_status cut_work_face (cut_work *w, int face, int order, pg_cut_points *out)
{
    cut_slices *s = &w->slices;
    int axis = face / 2, side = face % 2 ? 1 : -1, order_of[6][3];
    s->n = w->real;
    for (size_t i = 0; i < s->n; i++) s->mute[i] = (unsigned char) !cut_on_face (s, i, axis, side);
    w->surface = -1, w->out = out, w->order = order < 1 ? 1 : order > RULE ? RULE : order;
    int orders = cut_axes (s, w->cut, -1, axis, side, order_of);
    w->face = face;
    for (int k = 0; k < orders && s->dim > 1 && s->status == PG_OK; k++) {
        memcpy (s->axis, order_of[k], sizeof s->axis);
        go_on (w, 0, side, w->thickness / w->half[axis] / orders);
    }
    w->face = -1;
    return s->status;
}

double cut_work_size (const cut_work *w)
{
    double size = w->thickness;
    for (int k = 0; k < w->cut->dim; k++) size *= 2 * w->half[k];
    return size;
}

double cut_work_unsettled (const cut_work *w) { return w->unsettled; }
size_t cut_work_given_up (const cut_work *w) { return w->slices.given_up; }

/* ---- sizes to rounding accuracy ------------------------------------------------------------------------ */
/* Sum of weights, their centroid and the integral of the normal. */
static cut_piece sum_up (const pg_cut_points *p, size_t dim)
{
    cut_piece s = {0, {0, 0, 0}, {0, 0, 0}};
    for (size_t i = 0; i < p->n; i++) {
        s.size += p->weight[i];
        for (size_t k = 0; k < dim; k++) {
            s.centre[k] += p->weight[i] * p->x[i * dim + k];
            s.normal[k] += p->weight[i] * p->normal[i * dim + k];
        }
    }
    for (size_t k = 0; k < dim && s.size > 0; k++) s.centre[k] /= s.size;
    return s;
}

/* Are all surfaces of the cell flat, and some of them regions of facets? */
static int is_polyhedron (const cut_work *w)
{
    int faceted = 0;
    for (size_t i = 0; i < w->real; i++) {
        const cut_surface *f = &w->cut->surface[w->slices.number[i]];
        if (!f->flat) return 0;
        faceted |= f->facets != NULL;
    }
    return faceted;
}

int cut_work_faceted (const cut_work *w)
{
    for (size_t i = 0; i < w->real; i++) if (w->slices.facets[i]) return 1;
    return 0;
}

/* The orders grow by a factor of about 1.5; convergence is relative to the cell (for a surface: to its
 * largest face). Between planes two Gauss points are exact: orders 3 and 5 only confirm it. */
pg_status cut_work_piece (cut_work *w, int surface, int part, cut_piece *piece)
{
    static const int orders[] = {2, 3, 5, 8, 12, 18, 27, 40};
    pg_status status = PG_OK;
    pg_cut_points p = {0};
    double whole = cut_work_size (w), before = NAN, change = NAN;
    if (surface >= 0)
        whole /= 2
                 * fmin (w->half[0], fmin (w->cut->dim > 1 ? w->half[1] : INFINITY,
                                           w->cut->dim > 2 ? w->half[2] : INFINITY));
    int flat = is_polyhedron (w);
    for (size_t i = !flat; i < (flat ? 3 : sizeof orders / sizeof *orders); i++) {
        p.n = 0;
        PG_TRY (cut_work_points (w, surface, part, orders[i], &p));
        *piece = sum_up (&p, (size_t) w->cut->dim);
        change = fabs (piece->size - before);
        if (change <= 1e-13 * whole) break;
        before = piece->size;
    }
    if (!(change <= 1e-13 * whole)) w->unsettled = fmax (w->unsettled, change / whole);
done:
    pg_cut_points_clear (&p);
    return status;
}
