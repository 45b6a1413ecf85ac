/* SPDX-License-Identifier: GPL-3.0-or-later
 * Which point does each pixel belong to? owner[pixel] is the spot whose cell covers the pixel's centre,
 * the nearest one where several do. Points that have moved leave narrow gaps between their cells: a pixel
 * in such a gap goes to the nearest spot if there are spots on opposite sides of it, so that gaps inside
 * the body close and its outline does not grow. Spots that lie on no lattice own the pixels nearest to
 * them, as far as their neighbours are away. */
#include "picture_private.h"
#include <math.h>

/* Sides on which a pixel has a spot: straight beside it (low four bits), or near in any direction (high four
 * bits). */
enum { LEFT = 1, RIGHT = 2, ABOVE = 4, BELOW = 8, ALL = 15 };

/* First and one past the last pixel whose centre lies within `half` of `at`, cut to [0, n). Written so that
 * cells side by side neither overlap nor leave a pixel out. */
static void span (double at, double half, int n, int *first, int *last)
{
    double a = ceil (at - half - 0.5 - 1e-6), b = ceil (at + half - 0.5 - 1e-6);
    *first = a < 0 ? 0 : a > n ? n : (int) a;
    *last = b < 0 ? 0 : b > n ? n : (int) b;
}

/* Offers spot k to all pixels within its reach, and notes for each pixel on which sides the spot lies. */
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

/* In a cell, or in a gap with spots straight on two opposite sides, or near on all four. */
static int enclosed (unsigned short seen)
{
    return (seen & (LEFT | RIGHT)) == (LEFT | RIGHT) || (seen & (ABOVE | BELOW)) == (ABOVE | BELOW)
           || seen >> 4 == ALL;
}

/* ---- spots without a lattice --------------------------------------------------------------------------- */
/* The 16 sectors in which a pixel has spots within one and a half of their spacings. */
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

/* Spots on about opposite sides: sectors seven to nine apart. */
static int between (unsigned short seen)
{
    for (int k = 0; k < 16; k++)
        for (int apart = 7; apart <= 9; apart++) if (seen >> k & 1 && seen >> (k + apart) % 16 & 1) return 1;
    return 0;
}

/* Near its spot, or not far and between others: the outline grows by a quarter of a spacing. */
static void keep_near (const pg_spots *s, size_t n, const unsigned short *seen, const float *distance,
                       int *owner)
{
    for (size_t p = 0; p < n; p++) {
        if (owner[p] < 0) continue;
        double r = distance[p] / s->spacing[owner[p]];
        if (!(r <= 0.25 || (r <= 1 && between (seen[p])))) owner[p] = -1;
    }
}

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
