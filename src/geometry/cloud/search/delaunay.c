/* SPDX-License-Identifier: GPL-3.0-or-later
 * The Delaunay triangulation by Qhull (Barber, Dobkin and Huhdanpaa 1996, doi 10.1145/235815.235821), which
 * finds it as the lower hull of the points lifted to a paraboloid. The library is loaded when it is first
 * needed (base/library.c). */
#include "delaunay.h"
#include "random.h"
#include <libqhull_r/libqhull_r.h>
#include <limits.h>
#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* List of the functions that are used of the library, for a macro X (name). */
#define CALLS(X) X (qh_zero) X (qh_new_qhull) X (qh_freeqhull) X (qh_memfreeshort)
static struct {
#define X(name) __typeof__ (name) *name;
    CALLS (X)
#undef X
} call;

static pg_status load (void)
{
    static const pg_library_function function[] = {
#define X(name) { #name, offsetof (__typeof__ (call), name) },
        CALLS (X)
#undef X
    };
    static pg_library qhull = { PG_QHULL_FILE, "libqhull-r8.0", "alpha shapes",
                                sizeof function / sizeof *function, function, &call, 0, 0 };
    return pg_library_load (&qhull);
}

/* ---- points on a line or in a plane -------------------------------------------------------------------- */
/* The largest distance of any point from the span of the origin x0 and `n` orthonormal directions; the
 * direction towards it, orthogonal to them, becomes direction n. */
static double farthest (int dim, size_t npoint, const double *x, int n, double direction[3][3])
{
    double most = -1;
    for (size_t i = 0; i < npoint; i++) {
        double r[3] = { 0, 0, 0 }, square = 0;
        for (int k = 0; k < dim; k++) r[k] = x[i * (size_t) dim + (size_t) k] - x[k];
        for (int d = 0; d < n; d++) {
            double along = 0;
            for (int k = 0; k < dim; k++) along += r[k] * direction[d][k];
            for (int k = 0; k < dim; k++) r[k] -= along * direction[d][k];
        }
        for (int k = 0; k < dim; k++) square += r[k] * r[k];
        if (!(square > most)) continue;
        most = square;
        for (int k = 0; k < dim; k++) direction[n][k] = square > 0 ? r[k] / sqrt (square) : 0;
    }
    return sqrt (fmax (most, 0));
}

static int by_value (const void *p, const void *q)
{
    const double *a = p, *b = q;
    return (*a > *b) - (*a < *b);
}

/* The median of n numbers; *regular: 1 if nine tenths of them lie within 1 % of each other, as the distances
 * in a lattice. */
static pg_status median (size_t n, const double *value, double *out, int *regular)
{
    pg_status status = PG_OK;
    double *sorted = NULL;
    PG_ALLOC (sorted, n);
    memcpy (sorted, value, n * sizeof *value);
    pg_sort (sorted, n, sizeof *sorted, by_value);
    *out = sorted[n / 2];
    *regular = sorted[n - 1 - n / 20] - sorted[n / 20] <= 0.01 * *out;
done:
    pg_free (sorted);
    return status;
}

/* Reports points on one line or in one plane (to 1e-3 of `usual`, the usual distance, m): they cannot be
 * triangulated. */
static pg_status refuse_flat (int dim, size_t n, const double *x, double usual)
{
    pg_status status = PG_OK;
    double direction[3][3] = { { 0 } };
    static const char *const where[] = { "at one place", "on one line", "in one plane" };
    if (n < (size_t) dim + 1)
        PG_FAIL (PG_E_USAGE, "%zu different point%s; %s needs %d or more", n, n == 1 ? "" : "s",
                 dim == 2 ? "a shape in the plane" : "a solid shape", dim + 1);
    for (int k = 0; k < dim; k++)
        if (!(farthest (dim, n, x, k, direction) > 1e-3 * usual))
            PG_FAIL (PG_E_USAGE, "all %zu points lie %s", n, where[k]);
done:
    return status;
}

/* ---- Qhull --------------------------------------------------------------------------------------------- */
/* Moves the points at random and scales them by the largest extent about the middle of their box, so that
 * Qhull gives the same result at any scale and position. */
static pg_status move_points (double **out, int dim, size_t n, const double *x, const double *apart,
                              double *unit)
{
    pg_status status = PG_OK;
    size_t d = (size_t) dim;
    double middle[3], size = 0;
    PG_ALLOC (*out, n * d);
    for (size_t k = 0; k < d; k++) {
        double low = INFINITY, high = -INFINITY;
        for (size_t i = 0; i < n; i++) low = fmin (low, x[i * d + k]), high = fmax (high, x[i * d + k]);
        middle[k] = low / 2 + high / 2, size = fmax (size, high - low);
    }
    for (size_t i = 0; i < n; i++)
        for (size_t k = 0; k < d; k++) {
            double shift = 1e-4 * apart[i] * pg_place_shift (1, i, (int) k);
            (*out)[i * d + k] = (x[i * d + k] - middle[k] + shift) / size;
        }
    *unit = size;
done:
    return status;
}

/* Radius of the circle through a triangle, from the edges that leave its first vertex; *sign: orientation. */
static double radius_of_triangle (const double e[3][3], double *sign)
{
    const double *a = e[0], *b = e[1];
    double cross = a[0] * b[1] - a[1] * b[0];
    *sign = cross;
    return hypot (a[0], a[1]) * hypot (b[0], b[1]) * hypot (a[0] - b[0], a[1] - b[1]) / (2 * fabs (cross));
}

/* Radius of the sphere through a tetrahedron, from the edges a, b, c that leave its first vertex:
 * |a^2 (b x c) + b^2 (c x a) + c^2 (a x b)| / (2 |a . b x c|); *sign: orientation. */
static double radius_of_tetrahedron (const double e[3][3], double *sign)
{
    double sum[3] = { 0, 0, 0 }, volume = 0;
    for (int k = 0; k < 3; k++) {
        const double *a = e[k], *b = e[(k + 1) % 3], *c = e[(k + 2) % 3];
        double square = a[0] * a[0] + a[1] * a[1] + a[2] * a[2];
        for (int i = 0; i < 3; i++) {
            double cross = b[(i + 1) % 3] * c[(i + 2) % 3] - b[(i + 2) % 3] * c[(i + 1) % 3];
            sum[i] += square * cross;
            if (k == 0) volume += a[i] * cross;
        }
    }
    *sign = volume;
    return sqrt (sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2]) / (2 * fabs (volume));
}

/* Radius of a simplex whose points lie at x, from the edges that leave its first vertex; *sign:
 * orientation. */
static double radius_of (int dim, const double *const *x, double *sign)
{
    double e[3][3] = { { 0 } };
    for (int k = 0; k < dim; k++) for (int a = 0; a < dim; a++) e[k][a] = x[k + 1][a] - x[0][a];
    return dim == 2 ? radius_of_triangle (e, sign) : radius_of_tetrahedron (e, sign);
}

/* Makes one simplex from a facet of the lower hull. Its orientation is that of the moved points, its radius
 * that of the points themselves unless it is nearly flat: then that of the moved points. */
static void take_facet (pg_delaunay *d, size_t s, qhT *qh, facetT *facet, const int *number, double unit,
                        const double *given)
{
    int dim = d->dim, corners = dim + 1, *vertex = d->vertex + s * (size_t) corners,
        *beside = d->beside + s * (size_t) corners;
    double sign, true_sign;
    const double *x[4] = { NULL }, *own[4] = { NULL };
    for (int k = 0; k < corners; k++) {
        facetT *neighbour = SETelemt_ (facet->neighbors, k, facetT);
        x[k] = SETelemt_ (facet->vertices, k, vertexT)->point;
        vertex[k] = (int) ((x[k] - qh->first_point) / qh->hull_dim);
        own[k] = given + (size_t) vertex[k] * (size_t) dim;
        beside[k] = neighbour->upperdelaunay ? -1 : number[neighbour->id];
    }
    d->radius[s] = unit * radius_of (dim, x, &sign);
    double radius = radius_of (dim, own, &true_sign);
    /* Not flat: its volume is no less than 1/20 of that of its sphere's cube. */
    if (true_sign * sign > 0 && fabs (true_sign) > 0.05 * pow (radius, dim)) d->radius[s] = radius;
    if (sign < 0) {
        int swap = vertex[0];
        vertex[0] = vertex[1], vertex[1] = swap;
        swap = beside[0], beside[0] = beside[1], beside[1] = swap;
    }
}

/* Copies the lower hull: facets are numbered first, so that neighbours are known by their numbers. */
static pg_status take_hull (pg_delaunay *d, qhT *qh, double unit, const double *given)
{
    pg_status status = PG_OK;
    int *number = NULL;
    size_t n = 0, corners = (size_t) d->dim + 1;
    PG_ALLOC (number, (size_t) qh->facet_id + 1);
    for (facetT *f = qh->facet_list; f && f->next; f = f->next) {
        if (f->upperdelaunay) continue;
        if (!f->simplicial || n >= INT_MAX / 4)
            PG_FAIL (PG_E_LIMIT, "Qhull could not divide the points into simplices: their distances differ "
                                 "by too many orders of magnitude; remove points that lie far away");
        number[f->id] = (int) n++;
    }
    PG_ALLOC (d->vertex, n * corners);
    PG_ALLOC (d->beside, n * corners);
    PG_ALLOC (d->radius, n);
    d->n = 0;
    for (facetT *f = qh->facet_list; f && f->next; f = f->next)
        if (!f->upperdelaunay) take_facet (d, d->n++, qh, f, number, unit, given);
done:
    pg_free (number);
    return status;
}

/* The first line that Qhull wrote, without its code such as QH6154. */
static void first_line (char *out, size_t size, const char *text)
{
    text += strspn (text, "\n ");
    if (!strncmp (text, "QH", 2)) text += strcspn (text, " "), text += strspn (text, " ");
    snprintf (out, size, "%.*s", (int) strcspn (text, "\n"), text);
}

/* Option QJ: where the random moves did not suffice, Qhull begins again with larger ones of its own, until
 * every facet is a simplex; on a lattice of a million points that takes six attempts from its least move, and
 * none from 5e-3 of the spacing. Option Qbb: the lifted coordinate has the extent of the others. */
pg_status pg_delaunay_create (pg_delaunay *out, int dim, size_t n, const double *x, const double *apart)
{
    pg_status status = PG_OK;
    char command[64] = "qhull d QJ Qbb", said[400] = "", why[160];
    double *moved = NULL, unit = 1, usual = 0;
    FILE *errors = NULL;
    qhT *qh = NULL;
    int started = 0, regular = 0, a, b;
    memset (out, 0, sizeof *out);
    out->dim = dim;
    if (n > INT_MAX / 8) PG_FAIL (PG_E_LIMIT, "%zu points, more than %d", n, INT_MAX / 8);
    PG_TRY (median (n, apart, &usual, &regular));
    PG_TRY (refuse_flat (dim, n, x, usual));
    PG_TRY (load ());
    PG_TRY (move_points (&moved, dim, n, x, apart, &unit));
    if (regular) snprintf (command, sizeof command, "qhull d QJ%.3g Qbb", 5e-3 * usual / unit);
    PG_ALLOC (qh, 1);
    errors = fmemopen (said, sizeof said - 1, "w");
    if (!errors) PG_FAIL (PG_E_MEMORY, "no memory for the messages of Qhull");
    call.qh_zero (qh, errors);
    started = 1;
    int failed = call.qh_new_qhull (qh, dim, (int) n, moved, 0, command, NULL, errors);
    fflush (errors);
    if (failed == qh_ERRmem) PG_FAIL (PG_E_MEMORY, "no memory for the triangulation of %zu points", n);
    if (failed) {
        first_line (why, sizeof why, said);
        PG_FAIL (PG_E_LIMIT, "Qhull could not triangulate the points (%s): their distances differ by too "
                             "many orders of magnitude; remove points that lie far away", why);
    }
    PG_TRY (take_hull (out, qh, unit, x));
done:
    if (started) call.qh_freeqhull (qh, !qh_ALL), call.qh_memfreeshort (qh, &a, &b);
    if (errors) fclose (errors);
    pg_free (qh), pg_free (moved);
    if (status != PG_OK) pg_delaunay_clear (out);
    return status;
}

void pg_delaunay_clear (pg_delaunay *d)
{
    pg_free (d->vertex), pg_free (d->beside), pg_free (d->radius);
    memset (d, 0, sizeof *d);
}
