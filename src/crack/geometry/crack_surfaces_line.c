/* SPDX-License-Identifier: GPL-3.0-or-later
 * A front as a curve: tangents, frames of vertices, and redistribution of vertices. Between corners, which
 * are kept, new vertices lie on a cubic through the old ones (Hermite, with the slope of the parabola through
 * three neighbours), at equal lengths measured in local spacings. A part whose vertices are 0.6 to 1.5
 * spacings apart is unchanged. */
#include "crack_surfaces.h"
#include <string.h>

static const double nearest_apart = 0.6, farthest_apart = 1.5;
#define CORNER 0.64                                    /* cosine of the turn at a corner, 50 degrees */

/* ---- slopes -------------------------------------------------------------------------------------------- */
/* Index of the vertex `by` steps further along; -1: beyond the end. */
static long beside (const pg_front *f, size_t i, long by)
{
    long n = (long) f->n, j = (long) i + by;
    if (f->closed) return (j % n + n) % n;
    return j >= 0 && j < n ? j : -1;
}

/* Derivative of the values x (n x 3) with respect to the length s of the front at vertex i: from the parabola
 * through three vertices; at an end from the straight line to the neighbour. */
static void slope (const pg_front *f, const double *x, size_t i, double *out)
{
    long a = beside (f, i, -1), b = beside (f, i, 1);
    double l = a >= 0 ? pg_distance3 (f->x + 3*i, f->x + 3*a) : 0, r = b >= 0 ? pg_distance3 (f->x + 3*i,
                                                                                              f->x + 3*b) : 0;
    for (int k = 0; k < 3; k++) {
        double left = l > 0 ? (x[3*i + (size_t) k] - x[3*a + k]) / l : 0,
               right = r > 0 ? (x[3*b + k] - x[3*i + (size_t) k]) / r : 0;
        out[k] = l > 0 && r > 0 ? (left * r + right * l) / (l + r) : l > 0 ? left : right;
    }
}

/* Unit tangent; at an end from the parabola through the last three vertices. */
void front_tangent (const pg_front *f, size_t i, double *tangent)
{
    slope (f, f->x, i, tangent);
    if (!f->closed && f->n > 2 && (i == 0 || i + 1 == f->n)) {
        double next[3];
        slope (f, f->x, i ? i - 1 : 1, next);
        for (int k = 0; k < 3; k++) tangent[k] = 2 * tangent[k] - next[k];
    }
    if (!pg_unit3 (tangent)) pg_cross3 (f->ahead + 3*i, f->normal + 3*i, tangent);
}

/* Orthogonalises the frames, `ahead` first, then the normal, which keeps its side: t = e x n. */
void front_frames (pg_front *f)
{
    for (size_t i = 0; i < f->n; i++) {
        double t[3], n[3], *e = f->ahead + 3*i, *normal = f->normal + 3*i, e0[3];
        front_tangent (f, i, t);
        memcpy (e0, e, sizeof e0);
        double along = pg_dot3 (e, t);
        for (int k = 0; k < 3; k++) e[k] -= along * t[k];
        if (!pg_unit3 (e)) memcpy (e, e0, sizeof e0);
        pg_cross3 (t, e, n);
        if (pg_dot3 (n, normal) < 0) for (int k = 0; k < 3; k++) n[k] = -n[k];
        if (pg_unit3 (n)) memcpy (normal, n, sizeof n);
    }
}

double front_length (const pg_front *f)
{
    double length = 0;
    for (size_t i = 0; i + !f->closed < f->n; i++) length += pg_distance3 (f->x + 3*i,
                                                                           f->x + 3 * ((i + 1) % f->n));
    return length;
}

/* ---- distributing -------------------------------------------------------------------------------------- */
/* Cosine of the turn of the front at vertex i; 1 at an end. */
static double straightness (const pg_front *f, size_t i)
{
    long a = beside (f, i, -1), b = beside (f, i, 1);
    double u[3], v[3];
    if (a < 0 || b < 0) return 1;
    for (size_t k = 0; k < 3; k++)
        u[k] = f->x[3*i + k] - f->x[3 * (size_t) a + k], v[k] = f->x[3 * (size_t) b + k] - f->x[3*i + k];
    return pg_unit3 (u) && pg_unit3 (v) ? pg_dot3 (u, v) : 1;
}

/* Returns 1: vertex i is a corner, which turns much more than its neighbours (small loops turn
 * everywhere). */
static int is_corner (const pg_front *f, size_t i)
{
    long a = beside (f, i, -1), b = beside (f, i, 1);
    double turn = acos (fmax (-1, fmin (1, straightness (f, i))));
    if (a < 0 || b < 0) return 1;
    return straightness (f, i) < CORNER && acos (fmax (-1, straightness (f, (size_t) a))) < 0.5 * turn
           && acos (fmax (-1, straightness (f, (size_t) b))) < 0.5 * turn;
}

/* Position of a new vertex: at the fraction t of the segment that starts at vertex `from`. */
typedef struct { size_t from; double t; } spot;

/* Length of segment i in local spacings (at its middle). */
static double spacings_of (const pg_front *f, const pg_ground *p, size_t i)
{
    const double *a = f->x + 3*i, *b = f->x + 3 * ((i + 1) % f->n);
    double middle[3] = { 0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1]), 0.5 * (a[2] + b[2]) };
    return pg_distance3 (a, b) / pg_ground_spacing_at (p, middle);
}

/* Vertices of the part from corner `first` over m segments, without the last one: unchanged, or redistributed
 * (*moved = 1). Returns their number. */
static size_t spots_of (const pg_front *f, const pg_ground *p, size_t first, size_t m, size_t least,
                        spot *out, size_t room, int *moved)
{
    double total = 0, shortest = INFINITY, longest = 0;
    for (size_t k = 0; k < m; k++) {
        double s = spacings_of (f, p, (first + k) % f->n);
        total += s, shortest = fmin (shortest, s), longest = fmax (longest, s);
    }
    size_t parts = (size_t) fmax ((double) least, floor (total + 0.5)), n = 0;
    int keep = (shortest >= nearest_apart && longest <= farthest_apart && m >= least)
               || (m == parts && m == 1);
    if (keep || parts > room) {
        for (size_t k = 0; k < m; k++) out[n++] = (spot) { (first + k) % f->n, 0 };
        return n;
    }
    *moved = 1;
    double passed = 0;
    for (size_t k = 0; k < m && n < parts; k++) {
        size_t i = (first + k) % f->n;
        double s = spacings_of (f, p, i);
        for (; n < parts; n++) {
            double goal = total * (double) n / (double) parts - passed;
            if (goal > s && k + 1 < m) break;
            out[n] = (spot) { i, s > 0 ? fmin (1, fmax (0, goal / s)) : 0 };
        }
        passed += s;
    }
    return n;
}

/* Vertices of a loop without corners: unchanged, or redistributed from the loop's first vertex (*moved =
 * 1). */
static size_t spots_of_loop (const pg_front *f, const pg_ground *p, spot *out, size_t room, int *moved)
{
    double total = 0, shortest = INFINITY, longest = 0, share;
    size_t first, parts = front_loop_start (f->n, f->x, &first, &share), n = 0;
    for (size_t i = 0; i < f->n; i++) {
        double s = spacings_of (f, p, i);
        total += s, shortest = fmin (shortest, s), longest = fmax (longest, s);
    }
    parts = front_loop_parts (total, parts);
    if ((shortest >= nearest_apart && longest <= farthest_apart) || parts > room) {
        for (; n < f->n; n++) out[n] = (spot) { n, 0 };
        return n;
    }
    *moved = 1;
    /* length from the first new vertex to the segment, spacings */
    double passed = -share * spacings_of (f, p, first);
    for (size_t k = 0; k <= f->n && n < parts; k++) {      /* the first segment is repeated at the end */
        size_t i = (first + k) % f->n;
        double s = spacings_of (f, p, i);
        for (; n < parts; n++) {
            double goal = total * (double) n / (double) parts - passed;
            if (goal > s && k < f->n) break;
            out[n] = (spot) { i, s > 0 ? fmin (1, fmax (0, goal / s)) : 0 };
        }
        passed += s;
    }
    return n;
}

/* Interpolates values x (n x 3) at a spot by the Hermite cubic. */
static void value_at (const pg_front *f, const double *x, spot q, double *out)
{
    size_t i = q.from, j = (i + 1) % f->n;
    double a[3], b[3], t = q.t, l = pg_distance3 (f->x + 3*i, f->x + 3*j);
    if (t == 0 || !(l > 0)) { memcpy (out, x + 3*i, 3 * sizeof *out); return; }
    /* at corners the slope is that of the segment itself */
    if (is_corner (f, i)) for (size_t k = 0; k < 3; k++) a[k] = (x[3*j + k] - x[3*i + k]) / l;
    else slope (f, x, i, a);
    if (is_corner (f, j)) for (size_t k = 0; k < 3; k++) b[k] = (x[3*j + k] - x[3*i + k]) / l;
    else slope (f, x, j, b);
    double h00 = (1 + 2*t) * (1 - t) * (1 - t), h10 = t * (1 - t) * (1 - t), h01 = t * t * (3 - 2*t),
           h11 = t * t * (t - 1);
    for (size_t k = 0; k < 3; k++)
        out[k] = h00 * x[3*i + k] + h10 * l * a[k] + h01 * x[3*j + k] + h11 * l * b[k];
}

/* Replaces the vertices of a front, with all their data and *c, by those at the spots q. */
static pg_status move_to (pg_front *f, double **c, const spot *q, size_t n)
{
    pg_status status = PG_OK;
    pg_front g = { .id = f->id, .of = f->of, .closed = f->closed, .open = f->open, .n = n };
    double *d = NULL;
    PG_TRY (pg_front_reserve (&g, n));
    PG_ALLOC (d, 3 * n);
    for (size_t m = 0; m < n; m++) {
        size_t i = q[m].from, j = (i + 1) % f->n;
        double t = q[m].t;
        value_at (f, f->x, q[m], g.x + 3*m), value_at (f, *c, q[m], d + 3*m);
        for (size_t k = 0; k < 3; k++) {
            g.normal[3*m + k] = (1 - t) * f->normal[3*i + k] + t * f->normal[3*j + k];
            g.ahead[3*m + k] = (1 - t) * f->ahead[3*i + k] + t * f->ahead[3*j + k];
        }
        pg_unit3 (g.normal + 3*m), pg_unit3 (g.ahead + 3*m);
        g.offset[m] = (1 - t) * f->offset[i] + t * f->offset[j];
        g.grown[m] = (1 - t) * f->grown[i] + t * f->grown[j];
        g.meets[m] = t == 0 ? f->meets[i] : t == 1 ? f->meets[j] : PG_MEETS_NOTHING;
    }
    g.rim = f->rim, g.nrim = f->nrim, g.rim_capacity = f->rim_capacity;
    f->rim = NULL;
    pg_front_clear (f);
    *f = g, g = (pg_front) { 0 };
    pg_free (*c);
    *c = d, d = NULL;
done:
    pg_front_clear (&g);
    pg_free (d);
    return status;
}

pg_status front_resample (pg_front *f, const pg_ground *p, double **c)
{
    pg_status status = PG_OK;
    spot *q = NULL;
    size_t n = 0, corners = 0, first = 0, room = 4 * f->n + 64;
    int moved = 0;
    double finest = INFINITY;
    if (f->n < 2) return PG_OK;
    for (size_t i = 0; i < f->n; i++) {
        if (is_corner (f, i) && corners++ == 0) first = i;
        finest = fmin (finest, pg_ground_spacing_at (p, f->x + 3*i));
    }
    room += 2 * (size_t) (front_length (f) / finest);
    PG_ALLOC (q, room + 2);
    size_t segments = f->n - !f->closed, begin = first;
    if (corners == 0) n = spots_of_loop (f, p, q, room, &moved);
    for (size_t k = 1; corners && k <= segments; k++) {
        size_t i = (first + k) % f->n;
        if (k < segments && !is_corner (f, i)) continue;
        size_t m = (i + f->n - begin) % f->n;
        if (m == 0) m = f->n;
        n += spots_of (f, p, begin, m, corners == 2 && !f->closed ? 2 : 1, q + n, room - n, &moved);
        begin = i;
    }
    if (!f->closed) q[n++] = (spot) { f->n - 2, 1 };
    if (moved) PG_TRY (move_to (f, c, q, n));
done:
    pg_free (q);
    return status;
}
