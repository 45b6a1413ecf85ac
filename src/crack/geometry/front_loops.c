/* SPDX-License-Identifier: GPL-3.0-or-later
 * First vertex of a front that is a loop without corners. Vertices divide the loop equally; the choice of the
 * first must follow from the loop and the lattice alone, so that a scene rotated by right angles or mirrored
 * has the rotated or mirrored vertices.
 *
 * A set of 4 m vertices has the mirror symmetries of the loop about lines through its middle and a vertex.
 * The first vertex therefore lies in the direction, projected into the plane of the loop, of the lattice axis
 * most inclined to the normal. If two axes are equally inclined, the third is taken, which is symmetric to
 * both; if that is the normal itself, the two are at right angles, and 4 m vertices suit both. If all three
 * are equally inclined, their projections are 60 degrees apart (with opposites): 12 m vertices. Of a
 * direction and its opposite, and of equivalent directions, the one is taken in which the loop extends
 * farthest. */
#include "crack_surfaces.h"
#include <string.h>

/* Axes whose components of the normal differ by less than `alike` are equally inclined; an axis nearer to the
 * normal than no_direction (sine of the angle) has no projection. */
static const double alike = 0.05, no_direction = 1e-3;
enum { FEW = 4, MANY = 12 };

/* Appends the unit projection of axis k into the plane with this unit normal, and its opposite; returns their
 * number. */
static int put_axis (const double *normal, int k, double direction[][3], int n)
{
    double *a = direction[n], *b = direction[n + 1];
    for (int c = 0; c < 3; c++) a[c] = (c == k) - normal[k] * normal[c];
    pg_unit3 (a);
    for (int c = 0; c < 3; c++) b[c] = -a[c];
    return n + 2;
}

int front_loop_directions (const double *normal, double direction[LOOP_DIRECTIONS][3], size_t *parts)
{
    int order[3] = { 0, 1, 2 };
    for (int i = 0; i < 2; i++)                        /* sorted by |component of the normal|, ascending */
        for (int j = 0; j < 2; j++)
            if (fabs (normal[order[j]]) > fabs (normal[order[j + 1]])) {
                int swap = order[j];
                order[j] = order[j + 1], order[j + 1] = swap;
            }
    double least = fabs (normal[order[0]]), middle = fabs (normal[order[1]]), most = fabs (normal[order[2]]);
    *parts = most - least < alike ? MANY : FEW;
    if (*parts == MANY)
        return put_axis (normal, 2, direction,
                         put_axis (normal, 1, direction, put_axis (normal, 0, direction, 0)));
    if (middle - least >= alike) return put_axis (normal, order[0], direction, 0);
    if (hypot (least, middle) > no_direction) return put_axis (normal, order[2], direction, 0);
    return put_axis (normal, order[1], direction, put_axis (normal, order[0], direction, 0));
}

void pg_plane_axis (const double *normal, double *along)
{
    double direction[LOOP_DIRECTIONS][3];
    size_t parts;
    front_loop_directions (normal, direction, &parts);
    memcpy (along, direction[0], sizeof direction[0]);
}

size_t front_loop_parts (double length, size_t parts)
{
    return parts * (size_t) fmax (1, floor (length / (double) parts + 0.5));
}

/* Centroid of a closed line of n points (m), and the unit normal of its area. */
static void middle_of (size_t n, const double *x, double *middle, double *normal)
{
    double total = 0;
    for (int k = 0; k < 3; k++) middle[k] = normal[k] = 0;
    for (size_t i = 0; i < n; i++) {
        const double *a = x + 3*i, *b = x + 3 * ((i + 1) % n);
        double s = pg_distance3 (a, b);
        for (int k = 0; k < 3; k++) middle[k] += 0.5 * s * (a[k] + b[k]);
        total += s;
    }
    for (int k = 0; k < 3; k++) middle[k] /= total;
    for (size_t i = 0; i < n; i++) {
        double a[3], b[3], c[3];
        pg_shift3 (x + 3*i, middle, -1, a), pg_shift3 (x + 3 * ((i + 1) % n), middle, -1, b);
        pg_cross3 (a, b, c);
        for (int k = 0; k < 3; k++) normal[k] += c[k];
    }
    pg_unit3 (normal);
}

/* Largest distance, m, from the middle at which the line crosses the ray in a direction; -1: nowhere. *from,
 * *share: segment and fraction of the crossing. */
static double reach (size_t n, const double *x, const double *middle, const double *direction,
                     const double *normal, size_t *from, double *share)
{
    double side[3], best = -1;
    pg_cross3 (normal, direction, side);
    for (size_t i = 0; i < n; i++) {
        double a[3], b[3];
        pg_shift3 (x + 3*i, middle, -1, a), pg_shift3 (x + 3 * ((i + 1) % n), middle, -1, b);
        double u = pg_dot3 (a, side), v = pg_dot3 (b, side);
        if ((u >= 0) == (v >= 0)) continue;
        double t = u / (u - v), r = (1 - t) * pg_dot3 (a, direction) + t * pg_dot3 (b, direction);
        if (r > best) best = r, *from = i, *share = t;
    }
    return best;
}

size_t front_loop_start (size_t n, const double *x, size_t *from, double *share)
{
    double middle[3], normal[3], direction[LOOP_DIRECTIONS][3], best = 0;
    size_t parts, at = 0;
    middle_of (n, x, middle, normal);
    int many = front_loop_directions (normal, direction, &parts);
    *from = 0, *share = 0;
    for (int d = 0; d < many; d++) {
        double t = 0, r = reach (n, x, middle, direction[d], normal, &at, &t);
        if (r > best) best = r, *from = at, *share = t;
    }
    return parts;
}
