/* SPDX-License-Identifier: GPL-3.0-or-later
 * Assigns pixels to points drawn as cells: owner[pixel] is the point whose cell covers the
 * centre of the pixel, the nearest one where several do.
 *
 * Displaced cells leave narrow gaps. A pixel in a gap goes to the nearest point if it has
 * points on opposite sides, because then it lies within the body; a pixel with points on one
 * side only lies outside, so that the outline of the body does not grow. Which sides have
 * points is collected in a bit mask per pixel while the cells are drawn, so the cost is that
 * of drawing and does not depend on the order of the points.
 *
 * Irregular points have no cells: a pixel belongs to the nearest point if that is closer than
 * a quarter of its spacing, or closer than one spacing with points on about opposite sides. */
#include "picture_private.h"
#include <math.h>

/* Bits for the sides on which a pixel has a point: in the low four bits straight beside it, in
 * the high four bits near it in any direction. */
enum { LEFT = 1, RIGHT = 2, ABOVE = 4, BELOW = 8, ALL = 15 };

/* First pixel, and one past the last pixel, whose centre lies within `half` of `at`, limited
 * to [0, n). Both ends are rounded alike, so that cells side by side neither overlap nor leave
 * a pixel out. */
static void span (double at, double half, int n, int *first, int *last)
{
    double a = ceil (at - half - 0.5 - 1e-6), b = ceil (at + half - 0.5 - 1e-6);
    *first = a < 0 ? 0 : a > n ? n : (int) a;
    *last = b < 0 ? 0 : b > n ? n : (int) b;
}

/* Draws the cell of point k of a lattice, enlarged by `reach`, and notes for each pixel on
 * which sides it has this point. Distances are in cells. */
static void stamp (const pg_spots *s, size_t k, int width, int height, int *owner, float *distance,
                   unsigned short *seen)
{
    const double *at = s->place + 2 * k, *size = s->size;
    int x[2], y[2], ix[2], iy[2];
    if (!isfinite (at[0]) || !isfinite (at[1])) return;
    span (at[0], 0.5 * size[0], width, &ix[0], &ix[1]);
    span (at[1], 0.5 * size[1], height, &iy[0], &iy[1]);
    span (at[0], 0.5 * size[0] * s->reach, width, &x[0], &x[1]);
    span (at[1], 0.5 * size[1] * s->reach, height, &y[0], &y[1]);
    for (int j = y[0]; j < y[1]; j++)
        for (int i = x[0]; i < x[1]; i++) {
            size_t p = (size_t) j * (size_t) width + (size_t) i;
            double dx = (i + 0.5 - at[0]) / size[0], dy = (j + 0.5 - at[1]) / size[1];
            float d = (float) (dx * dx + dy * dy);
            int across = j >= iy[0] && j < iy[1], along = i >= ix[0] && i < ix[1];
            int level = dx > 0 ? LEFT : RIGHT, upright = dy > 0 ? ABOVE : BELOW;
            seen[p] |= (unsigned short) ((level | upright) << 4 | (across ? level : 0) | (along ? upright : 0)
                                         | (across && along ? ALL : 0));
            if (owner[p] < 0 || d < distance[p]) owner[p] = (int) k, distance[p] = d;
        }
}

/* 1 if the pixel lies in a cell, in a gap with points straight on two opposite sides, or has
 * points near it on all four sides. */
static int enclosed (unsigned short seen)
{
    return (seen & (LEFT | RIGHT)) == (LEFT | RIGHT) || (seen & (ABOVE | BELOW)) == (ABOVE | BELOW)
           || seen >> 4 == ALL;
}

/* ---- spots without a lattice --------------------------------------------------------------------------- */
/* Draws irregular point k: pixels within one and a half spacings note in which of 16 sectors
 * it lies. */
static void stamp_near (const pg_spots *s, size_t k, int width, int height, int *owner, float *distance,
                        unsigned short *seen)
{
    const double *at = s->place + 2 * k, reach = 1.5 * s->spacing[k];
    int x[2], y[2];
    if (!isfinite (at[0]) || !isfinite (at[1])) return;
    span (at[0], reach, width, &x[0], &x[1]);
    span (at[1], reach, height, &y[0], &y[1]);
    for (int j = y[0]; j < y[1]; j++)
        for (int i = x[0]; i < x[1]; i++) {
            size_t p = (size_t) j * (size_t) width + (size_t) i;
            double dx = at[0] - i - 0.5, dy = at[1] - j - 0.5, r = hypot (dx, dy);
            if (r > reach) continue;
            seen[p] |= (unsigned short) (1 << (int) (8 * (1 + atan2 (dy, dx) / 3.141592653589794)));
            if (owner[p] < 0 || r < distance[p]) owner[p] = (int) k, distance[p] = (float) r;
        }
}

/* 1 if a pixel has points on about opposite sides: in sectors that are seven to nine of the
 * sixteen apart. */
static int between (unsigned short seen)
{
    for (int k = 0; k < 16; k++)
        for (int apart = 7; apart <= 9; apart++) if (seen >> k & 1 && seen >> (k + apart) % 16 & 1) return 1;
    return 0;
}

/* Takes from irregular points the pixels that are neither near nor between points; the outline
 * of the body grows by a quarter of a spacing at most. */
static void keep_near (const pg_spots *s, size_t n, const unsigned short *seen, const float *distance,
                       int *owner)
{
    for (size_t p = 0; p < n; p++) {
        if (owner[p] < 0) continue;
        double r = distance[p] / s->spacing[owner[p]];
        if (!(r <= 0.25 || (r <= 1 && between (seen[p])))) owner[p] = -1;
    }
}

/* Lattice cells and irregular points share the arrays but not the rule that decides which
 * pixels stay. */
pg_status pg_raster (const pg_spots *spots, int width, int height, int *owner)
{
    pg_status status = PG_OK;
    size_t n = (size_t) width * (size_t) height;
    float *distance = NULL;
    unsigned short *seen = NULL;
    PG_ALLOC (distance, n);
    PG_ALLOC (seen, n);
    for (size_t p = 0; p < n; p++) owner[p] = -1;
    for (size_t k = 0; k < spots->n; k++)
        (spots->spacing ? stamp_near : stamp) (spots, k, width, height, owner, distance, seen);
    if (spots->spacing) keep_near (spots, n, seen, distance, owner);
    for (size_t p = 0; p < n && !spots->spacing; p++) if (!enclosed (seen[p])) owner[p] = -1;
done:
    pg_free (seen);
    pg_free (distance);
    return status;
}
