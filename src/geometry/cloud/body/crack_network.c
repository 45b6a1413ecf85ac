/* SPDX-License-Identifier: GPL-3.0-or-later
 * Statistics of the cracks of an input file: number, sizes, directions, distances, and how much of them the
 * body holds. */
#include "crack.h"
#include "geometry/cloud/search/crack_distance.h"
#include "geometry/cloud/search/polygon.h"
#include <math.h>
#include <string.h>

/* Number of positions that are tested for lying in the body: of the body's bounding box, along a 2D crack,
 * and along a direction of a 3D crack. */
enum { BODY_PLACES = 200000, CRACK_PLACES = 200, AREA_PLACES = 24 };

/* The measure in closed form, or by counting the middles of equal boxes over the bounding box. */
pg_status crack_body_measure (double *out, const pg_body *body)
{
    pg_status status = PG_OK;
    pg_lattice l = { 0 };
    double surface, volume = 1, inside = 0, cells = 1;
    *out = 0;
    if (body->n == 0 || pg_body_measure (body, out, &surface)) return PG_OK;
    for (int k = 0; k < body->dim; k++) volume *= body->high[k] - body->low[k];
    PG_TRY (pg_lattice_fit (&l, body, pow (volume / BODY_PLACES, 1.0 / body->dim), NULL));
    for (int k = 0; k < 3; k++) cells *= l.count[k];
    for (size_t i = 0; i < (size_t) cells; i++) inside += l.in[i];
    *out = volume * inside / cells;
done:
    pg_lattice_clear (&l);
    return status;
}

/* Fraction of a crack that lies in the body, 0 to 1: by sampling positions along a segment, or in the plane
 * of a polygon. */
static double part_inside (const pg_crack *c, const pg_body *body)
{
    double all = 0, in = 0, x[3] = { 0 };
    const double *v = c->vertex;
    if (body->dim == 2) {
        size_t edges = c->kind == PG_CRACK_SEGMENT ? 1 : c->nvertex;
        for (size_t i = 0; i < edges; i++)
            for (int n = 0; n < CRACK_PLACES; n++) {
                double s = (n + 0.5) / CRACK_PLACES;
                const double *a = v + 2*i, *b = v + 2 * ((i + 1) % c->nvertex);
                for (int k = 0; k < 2; k++) x[k] = a[k] + s * (b[k] - a[k]);
                all++, in += pg_body_inside (body, x, 0);
            }
        return in / all;
    }
    /* a fan of triangles about the first corner, each with the same number of positions, weighted by its
     * area */
    for (size_t i = 1; i + 1 < c->nvertex; i++) {
        double u[3], w[3], area = 0;
        for (int k = 0; k < 3; k++) u[k] = v[3*i + (size_t) k] - v[k], w[k] = v[3*i + 3 + (size_t) k] - v[k];
        for (int k = 0; k < 3; k++) {
            int p = (k + 1) % 3, q = (k + 2) % 3;
            area += (u[p] * w[q] - u[q] * w[p]) * c->normal[k];
        }
        for (int n = 0; n < AREA_PLACES; n++)
            for (int m = 0; n + m < AREA_PLACES; m++) {
                for (int k = 0; k < 3; k++)
                    x[k] = v[k] + (n + 1.0 / 3) / AREA_PLACES * u[k] + (m + 1.0 / 3) / AREA_PLACES * w[k];
                all += fabs (area), in += fabs (area) * pg_body_inside (body, x, 0);
            }
    }
    return all > 0 ? in / all : 0;
}

/* Do the cracks i and j follow each other on one polyline? They share a vertex then. */
static int of_one_polyline (const pg_cracks *all, size_t i, size_t j)
{
    if (all->crack[i].entry != all->crack[j].entry) return 0;
    for (size_t k = i + 1; k <= j; k++) if (!all->crack[k].bend) return 0;
    return j > i;
}

/* Distances of all pairs whose balls are near enough to matter; crossing cracks are marked. */
static void measure_pairs (pg_network *out, const pg_cracks *all, double *ball, unsigned char *meets)
{
    out->nearest = INFINITY;
    for (size_t i = 0; i < all->n; i++) crack_ball (&all->crack[i], all->dim, ball + 4*i, ball + 4*i + 3);
    for (size_t i = 0; i < all->n; i++)
        for (size_t j = i + 1; j < all->n; j++) {
            const double *a = ball + 4*i, *b = ball + 4*j;
            double d[3] = { a[0] - b[0], a[1] - b[1], a[2] - b[2] },
                   gap = sqrt (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]) - a[3] - b[3];
            /* Passes over pairs whose balls are apart and no nearer than the nearest pair so far. */
            if ((gap > 0 && gap >= out->nearest) || of_one_polyline (all, i, j)) continue;
            double apart = crack_distance (&all->crack[i], &all->crack[j], all->dim);
            out->nearest = fmin (out->nearest, apart);
            /* zero to the rounding of their size */
            if (apart <= 1e-12 * (a[3] + b[3])) meets[i] = meets[j] = 1;
        }
    for (size_t i = 0; i < all->n; i++) out->crossing += meets[i];
}

/* Mean axis of the cracks and its order: the largest eigenvalue of the mean of a a' tells how far the axes a
 * agree: 1 / dim: random directions, 1: all parallel. */
static void measure_axes (pg_network *out, const pg_cracks *all)
{
    double mean[9] = { 0 }, lambda[3], V[9], a[3], weight = 0;
    int dim = all->dim;
    for (size_t i = 0; i < all->n; i++) {
        double w = pg_crack_size (&all->crack[i], dim);
        crack_axis (&all->crack[i], dim, a);
        for (int k = 0; k < dim; k++) for (int l = 0; l < dim; l++) mean[dim * k + l] += w * a[k] * a[l];
        weight += w;
    }
    for (int k = 0; k < dim * dim; k++) mean[k] /= weight;
    pg_dense_eigen (dim, mean, lambda, V);
    for (int k = 0; k < dim; k++) out->axis[k] = V[dim * k];
    out->order = fmax (0, (lambda[0] * dim - 1) / (dim - 1));
}

/* Statistics of the lengths of cracks, m; the pieces of a polyline count together as one crack. */
static void measure_lengths (pg_network *out, const pg_cracks *all)
{
    double sum = 0, squares = 0;
    out->least = INFINITY;
    for (size_t i = 0, last; i < all->n; i = last) {
        double length = 0;
        for (last = i; last < all->n && (last == i || of_one_polyline (all, i, last)); last++)
            length += crack_length (&all->crack[last], all->dim);
        out->n++, sum += length, squares += length * length;
        out->least = fmin (out->least, length), out->most = fmax (out->most, length);
        out->slots += (size_t) pg_crack_is_slot (&all->crack[i]);
    }
    out->mean = sum / (double) out->n;
    out->deviation = out->n > 1 ? sqrt (fmax (0, (squares - sum * out->mean) / (double) (out->n - 1))) : 0;
}

pg_status pg_network_measure (pg_network *out, const pg_cracks *all, const pg_scene *scene)
{
    pg_status status = PG_OK;
    pg_body body = { 0 };
    double *ball = NULL;
    unsigned char *meets = NULL;
    memset (out, 0, sizeof *out);
    out->nearest = INFINITY;
    if (all->n == 0) return PG_OK;
    PG_ALLOC (ball, 4 * all->n);
    PG_ALLOC (meets, all->n);
    PG_TRY (pg_body_read_uncut (&body, scene));
    body.n -= body.nlayer;                             /* layers are no part of the body */
    if (body.nlayer == 0) PG_TRY (crack_body_measure (&out->body, &body));
    else {
        pg_body bare = body;
        bare.nlayer = 0;
        for (size_t i = 0; i < body.nlayer; i++) {
            const pg_layer *l = &body.layer[i];
            *(l->side % 2 ? &bare.high[l->side / 2] : &bare.low[l->side / 2]) = l->face;
        }
        PG_TRY (crack_body_measure (&out->body, &bare));
    }
    for (size_t i = 0; i < all->n; i++) {
        out->vain += (size_t) all->crack[i].vain;
        double size = pg_crack_size (&all->crack[i], all->dim),
               part = body.n ? part_inside (&all->crack[i], &body) : 1;
        out->size += size, out->inside += part * size,
            out->removed += crack_removed (&all->crack[i], all->dim);
        out->leaving += part < 1 && part > 0, out->outside += part == 0;
    }
    measure_lengths (out, all);
    measure_axes (out, all);
    measure_pairs (out, all, ball, meets);
done:
    body.n += body.nlayer;
    pg_body_clear (&body);
    pg_free (ball), pg_free (meets);
    return status;
}
