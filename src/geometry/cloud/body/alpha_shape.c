/* SPDX-License-Identifier: GPL-3.0-or-later
 * The alpha shape of points (Edelsbrunner, Kirkpatrick and Seidel 1983, doi 10.1109/TIT.1983.1056714;
 * Edelsbrunner and Muecke 1994, doi 10.1145/174462.156635), as its part that has volume: the Delaunay
 * simplices whose circumscribed sphere is no larger than alpha. The empty space is what a ball of that radius
 * covers at positions where no point lies inside it. */
#include "perigal/cloud.h"
#include "geometry/cloud/search/delaunay.h"
#include "geometry/cloud/search/tree.h"
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Relative tolerance when radii are compared with alpha: points were moved by some 1e-4 of their
 * distances. */
static const double slack = 1e-3;
/* Automatic alpha, in units of the least radius for which every point belongs to the shape. */
static const double margin = 1.5;
/* Automatic alpha is refused if one point needs a radius this many times that of most points. */
static const double most_uneven = 30;
/* A region with less volume than this part of (spacing)^dim is neither a part nor a hole. */
static const double no_volume = 1e-3;

/* Work on one shape. */
typedef struct {
    int dim;
    size_t corners;
    const double *x;
    pg_delaunay d;
    /* Volume of each simplex, m^dim (d.n). */
    double *volume;
    /* 1: the simplex belongs to the shape (d.n). */
    unsigned char *in;
    /* Disjoint sets of simplices that share faces and are all inside the shape, or all outside; the last set
     * is the outside (d.n + 1). */
    int *region;
    /* Volume of each region, at the root of its set, m^dim (d.n + 1). */
    double *region_volume;
} work;

/* ---- removing repeated points -------------------------------------------------------------------------- */
/* A rounded position and the number of its point. */
typedef struct { double x[3]; size_t i; } place;

static int by_place (const void *p, const void *q)
{
    const place *a = p, *b = q;
    for (int k = 0; k < 3; k++) if (a->x[k] != b->x[k]) return a->x[k] < b->x[k] ? -1 : 1;
    return (a->i > b->i) - (a->i < b->i);
}

/* Copies the points that are no repetition of an earlier one, in their order: positions x (n x dim) of the
 * result, and numbers `from`. Positions are compared after rounding to 1e-9 of the mean distance. */
static pg_status drop_twins (double **out, long **from, size_t *left, size_t dim, size_t n, const double *x)
{
    pg_status status = PG_OK;
    place *p = NULL;
    unsigned char *twin = NULL;
    double size = 0;
    *left = 0;
    PG_ALLOC (p, n);
    PG_ALLOC (twin, n);
    PG_ALLOC (*out, n * dim);
    PG_ALLOC (*from, n);
    for (size_t i = dim; i < n * dim; i++) size = fmax (size, fabs (x[i] - x[i % dim]));
    double grain = 1e-9 * size / (1 + pow ((double) n, 1.0 / (double) dim));
    for (size_t i = 0; i < n; i++) {
        p[i].i = i;
        for (size_t k = 0; k < dim; k++) p[i].x[k] = grain > 0 ? rint ((x[i * dim + k] - x[k]) / grain) : 0;
    }
    pg_sort (p, n, sizeof *p, by_place);
    for (size_t i = 1; i < n; i++) twin[p[i].i] = !memcmp (p[i].x, p[i - 1].x, sizeof p->x);
    for (size_t i = 0; i < n; i++) {
        if (twin[i]) continue;
        memcpy (*out + *left * dim, x + i * dim, dim * sizeof *x);
        (*from)[(*left)++] = (long) i;
    }
done:
    pg_free (p), pg_free (twin);
    return status;
}

/* Arguments of measure_apart, which computes the distance of every point from its nearest neighbour (apart,
 * m). */
typedef struct { const pg_tree *tree; const double *x; double *apart; size_t self; } neighbours;

static int is_self (void *context, const double *at, size_t item)
{
    (void) at;
    return ((neighbours *) context)->self == item;
}

static void measure_apart (void *context, size_t first, size_t last, int thread)
{
    neighbours own = *(neighbours *) context;
    size_t dim = (size_t) own.tree->dim;
    (void) thread;
    for (own.self = first; own.self < last; own.self++) {
        const double *at = own.x + own.self * dim;
        long j = pg_tree_nearest (own.tree, at, is_self, &own, NULL);
        double square = 0;
        for (size_t k = 0; j >= 0 && k < dim; k++) square += pow (own.x[(size_t) j * dim + k] - at[k], 2);
        own.apart[own.self] = sqrt (square);
    }
}

/* ---- choice of simplices ------------------------------------------------------------------------------- */
/* The triple product of three edges. */
static double triple (double e[3][3])
{
    return e[0][0] * (e[1][1] * e[2][2] - e[1][2] * e[2][1])
           - e[0][1] * (e[1][0] * e[2][2] - e[1][2] * e[2][0])
           + e[0][2] * (e[1][0] * e[2][1] - e[1][1] * e[2][0]);
}

/* Volume of simplex s, from the points themselves: flat ones have none, perhaps with the wrong sign. */
static double volume_of (const work *w, size_t s)
{
    const int *v = w->d.vertex + s * w->corners;
    size_t dim = (size_t) w->dim;
    double e[3][3] = { { 0 } };
    for (size_t k = 0; k < dim; k++)
        for (size_t a = 0; a < dim; a++)
            e[k][a] = w->x[(size_t) v[k + 1] * dim + a] - w->x[(size_t) v[0] * dim + a];
    if (dim == 2) return (e[0][0] * e[1][1] - e[0][1] * e[1][0]) / 2;
    return triple (e) / 6;
}

static int by_value (const void *p, const void *q)
{
    const double *a = p, *b = q;
    return (*a > *b) - (*a < *b);
}

/* Sets alpha to `margin` times the least radius at which every point is a corner of some simplex of the
 * shape. */
static pg_status choose_alpha (const work *w, pg_alpha_shape *out, size_t n, const long *from)
{
    pg_status status = PG_OK;
    double *radius = NULL, largest;
    size_t worst = 0;
    PG_ALLOC (radius, n);
    for (size_t i = 0; i < n; i++) radius[i] = INFINITY;
    for (size_t k = 0; k < w->d.n * w->corners; k++) {
        double *r = &radius[w->d.vertex[k]];
        *r = fmin (*r, w->d.radius[k / w->corners]);
    }
    for (size_t i = 1; i < n; i++) if (radius[i] > radius[worst]) worst = i;
    largest = radius[worst];
    pg_sort (radius, n, sizeof *radius, by_value);
    out->uneven = largest / radius[n / 2];
    if (!(out->uneven < most_uneven)) {
        const double *x = w->x + worst * (size_t) w->dim;
        char third[32] = "";
        if (w->dim > 2) snprintf (third, sizeof third, ", %.6g", x[2]);
        PG_FAIL (PG_E_USAGE, "no radius fits all points: point %ld at (%.6g, %.6g%s) m lies so far from the "
                             "others that it needs %.3g m, %.3g times what most points need (%.3g m); remove "
                             "it, or give alpha",
                 from[worst] + 1, x[0], x[1], third, largest, out->uneven, radius[n / 2]);
    }
    out->alpha = margin * largest;
done:
    pg_free (radius);
    return status;
}

/* Joins simplices that share a face and are both inside or both outside; outer ones at the hull join the
 * outside. */
static void find_regions (work *w)
{
    int outside = (int) w->d.n;
    pg_disjoint_start (w->region, w->d.n + 1);
    for (size_t k = 0; k < w->d.n * w->corners; k++) {
        size_t s = k / w->corners;
        int other = w->d.beside[k];
        if (other < 0) {
            if (!w->in[s]) pg_disjoint_join (w->region, (int) s, outside);
        } else if (w->in[s] == w->in[other]) pg_disjoint_join (w->region, (int) s, other);
    }
    memset (w->region_volume, 0, (w->d.n + 1) * sizeof *w->region_volume);
    for (size_t s = 0; s < w->d.n; s++)
        w->region_volume[pg_disjoint_root (w->region, (int) s)] += fabs (w->volume[s]);
}

/* Regions without volume are turned from inside to outside or back: flat simplices in the midst of the shape
 * whose radius exceeds alpha by rounding, and flat ones outside. Then parts and holes are counted. */
static void settle_regions (work *w, pg_alpha_shape *out)
{
    double least = no_volume * pow (out->spacing, w->dim);
    find_regions (w);
    int outside = pg_disjoint_root (w->region, (int) w->d.n);
    for (size_t s = 0; s < w->d.n; s++) {
        int root = pg_disjoint_root (w->region, (int) s);
        if (root != outside && w->region_volume[root] < least) w->in[s] = !w->in[s];
    }
    find_regions (w);
    outside = pg_disjoint_root (w->region, (int) w->d.n);
    for (size_t s = 0; s < w->d.n; s++) {
        int root = pg_disjoint_root (w->region, (int) s);
        if (root != (int) s || root == outside) continue;
        if (w->in[s]) out->parts++;
        else out->holes++;
    }
}

/* Solid angle of a tetrahedron at its corner k over the full one (Van Oosterom and Strackee 1983,
 * doi 10.1109/TBME.1983.325207). */
static double solid_angle (const work *w, const int *v, int k)
{
    double e[3][3], length[3], below = 1, dot[3] = { 0, 0, 0 };
    for (int i = 0; i < 3; i++) {
        const double *x = w->x + 3 * (size_t) v[(k + 1 + i) % 4], *o = w->x + 3 * (size_t) v[k];
        for (int a = 0; a < 3; a++) e[i][a] = x[a] - o[a];
        length[i] = sqrt (e[i][0] * e[i][0] + e[i][1] * e[i][1] + e[i][2] * e[i][2]);
        below *= length[i];
    }
    for (int i = 0; i < 3; i++) {
        const double *a = e[i], *b = e[(i + 1) % 3];
        for (int m = 0; m < 3; m++) dot[i] += a[m] * b[m];
    }
    for (int i = 0; i < 3; i++) below += dot[i] * length[(i + 2) % 3];
    return 2 * atan2 (fabs (triple (e)), below) / (4 * acos (-1));
}

/* Spacing of the points: the volume of the shape over the number of its points, each counted by the part of
 * the full angle about it that lies in the shape, to the power 1/dim. On a lattice this is its step. The
 * angles of a triangle are half a full one together. */
static void measure_spacing (const work *w, pg_alpha_shape *out)
{
    double volume = 0, points = 0;
    for (size_t s = 0; s < w->d.n; s++) {
        if (!w->in[s]) continue;
        volume += w->volume[s];
        if (w->dim == 2) points += 0.5;
        for (int k = 0; w->dim == 3 && k < 4; k++) points += solid_angle (w, w->d.vertex + 4 * s, k);
    }
    out->volume = volume, out->spacing = points > 0 && volume > 0 ? pow (volume / points, 1.0 / w->dim) : 0;
}

/* ---- the shape as a mesh ------------------------------------------------------------------------------- */
/* Points become nodes, whose node_id are their numbers in the cloud; simplices of the shape elements. */
static pg_status fill_mesh (const work *w, pg_alpha_shape *out, size_t n, const long *from)
{
    pg_status status = PG_OK;
    pg_mesh *m = &out->mesh;
    size_t dim = (size_t) w->dim, at = 0;
    unsigned char *used = NULL;
    m->dim = w->dim, m->nnode = n;
    for (size_t s = 0; s < w->d.n; s++) m->n += w->in[s];
    PG_ALLOC (used, n);
    PG_ALLOC (m->x, 3 * n);
    PG_ALLOC (m->node_id, n);
    PG_ALLOC (m->kind, m->n);
    PG_ALLOC (m->start, m->n + 1);
    PG_ALLOC (m->node, m->n * w->corners);
    PG_ALLOC (m->block, m->n);
    PG_ALLOC (m->element_id, m->n);
    PG_ALLOC (m->blocks, 1);
    for (size_t i = 0; i < n; i++) {
        memcpy (m->x + 3 * i, w->x + i * dim, dim * sizeof *w->x);
        m->node_id[i] = from[i] + 1;
    }
    for (size_t s = 0; s < w->d.n; s++) {
        if (!w->in[s]) continue;
        m->kind[at] = dim == 2 ? PG_TRI3 : PG_TET4, m->element_id[at] = (long) at + 1;
        memcpy (m->node + at * w->corners, w->d.vertex + s * w->corners, w->corners * sizeof *m->node);
        for (size_t k = 0; k < w->corners; k++) used[w->d.vertex[s * w->corners + k]] = 1;
        at++, m->start[at] = at * w->corners;
    }
    m->nblock = 1, m->blocks[0] = (pg_mesh_block) { .name = "cloud", .id = 1, .n = m->n };
    for (size_t i = 0; i < n; i++) {
        out->loose += !used[i];
        if (!used[i] && out->first_loose < 0) out->first_loose = from[i];
    }
done:
    pg_free (used);
    return status;
}

/* Selects the simplices with radii up to alpha (m), which is chosen automatically where 0 is given. */
static pg_status select_simplices (work *w, pg_alpha_shape *out, double alpha, size_t n, const long *from)
{
    pg_status status = PG_OK;
    double least = INFINITY;
    PG_ALLOC (w->in, w->d.n);
    PG_ALLOC (w->volume, w->d.n);
    PG_ALLOC (w->region, w->d.n + 1);
    PG_ALLOC (w->region_volume, w->d.n + 1);
    if (alpha > 0) out->alpha = alpha;
    else PG_TRY (choose_alpha (w, out, n, from));
    for (size_t s = 0; s < w->d.n; s++) {
        w->volume[s] = volume_of (w, s);
        w->in[s] = w->d.radius[s] <= out->alpha * (1 + slack);
        least = fmin (least, w->d.radius[s]);
    }
    measure_spacing (w, out);
    if (!(out->spacing > 0))
        PG_FAIL (PG_E_USAGE, "no %s is as small as alpha = %g m: the smallest %s through neighbours has a "
                             "radius of %.3g m",
                 w->dim == 2 ? "triangle" : "tetrahedron", alpha, w->dim == 2 ? "circle" : "sphere", least);
    settle_regions (w, out);
    measure_spacing (w, out);
done:
    return status;
}

/* Coordinates are checked first: a NaN or infinity would be lost when positions are rounded. */
pg_status pg_alpha_shape_create (pg_alpha_shape *out, int dim, size_t n, const double *x, double alpha)
{
    pg_status status = PG_OK;
    work w = { .dim = dim, .corners = (size_t) dim + 1 };
    double *points = NULL, *apart = NULL;
    long *from = NULL;
    size_t left = 0;
    pg_tree tree = { 0 };
    memset (out, 0, sizeof *out);
    out->dim = dim, out->first_loose = -1;
    if (dim < 2 || dim > 3) PG_FAIL (PG_E_USAGE, "an alpha shape needs 2 or 3 dimensions, not %d", dim);
    for (size_t i = 0; i < n * (size_t) dim; i++)
        if (!isfinite (x[i]))
            PG_FAIL (PG_E_USAGE, "point %zu has a coordinate that is not finite", i / (size_t) dim + 1);
    if (n == 0) PG_FAIL (PG_E_USAGE, "no points");
    PG_TRY (drop_twins (&points, &from, &left, (size_t) dim, n, x));
    out->twins = n - left, w.x = points;
    PG_ALLOC (apart, left);
    PG_TRY (pg_tree_build (&tree, dim, left, points));
    neighbours all = { .tree = &tree, .x = points, .apart = apart };
    pg_parallel (1, left, measure_apart, &all);
    pg_tree_clear (&tree);
    PG_TRY (pg_delaunay_create (&w.d, dim, left, points, apart));
    PG_TRY (select_simplices (&w, out, alpha, left, from));
    PG_TRY (fill_mesh (&w, out, left, from));
done:
    pg_tree_clear (&tree), pg_delaunay_clear (&w.d);
    pg_free (points), pg_free (apart), pg_free (from);
    pg_free (w.in), pg_free (w.volume), pg_free (w.region), pg_free (w.region_volume);
    if (status != PG_OK) pg_mesh_clear (&out->mesh);
    return status;
}

void pg_alpha_shape_clear (pg_alpha_shape *shape)
{
    pg_mesh_clear (&shape->mesh);
    memset (shape, 0, sizeof *shape);
}
