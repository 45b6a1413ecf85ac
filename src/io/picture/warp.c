/* SPDX-License-Identifier: GPL-3.0-or-later
 * Draws the displaced body: the pixels of each point, as they are in the undeformed body, are moved by
 *
 *   u(x) = u_o + grad u_o (x - x_o),
 *
 * where grad u_o is fitted to the displacements of the neighbours of point o that have not separated from it.
 * At the boundary between two neighbours their formulas agree up to third differences of u, which leaves a
 * pixel or two to be closed near the tips of cracks.
 *
 * Two points have separated if a pre-crack passes between them or if their distance has
 * changed more than strain explains. Their pixels move apart, so that faces open. */
#include "tiles.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Relative displacement of two points over their distance: the strain that would explain it. */
static double strain_of (const pg_tiles *t, size_t i, size_t j)
{
    double dx = t->place[2*j] - t->place[2*i], dy = t->place[2*j + 1] - t->place[2*i + 1];
    return hypot (t->shift[2*j] - t->shift[2*i], t->shift[2*j + 1] - t->shift[2*i + 1]) / hypot (dx, dy);
}

/* 1 if one of the two points is nearly intact (damage below 0.1); 0 too if the damage is unknown. */
static int sound (const pg_tiles *t, size_t i, size_t j)
{
    return t->damage && fmin (t->damage[i], t->damage[j]) < 0.1;
}

/* 1 if two points have separated: a pre-crack passes between them, or neither is nearly intact and
 * their relative displacement exceeds t->limit times their distance. */
static int torn (const pg_tiles *t, size_t i, size_t j)
{
    if (i == j) return 0;
    if (t->cracked[i] && t->cracked[j] && pg_tiles_cut (t, t->place + 2 * i, t->place + 2 * j)) return 1;
    return !sound (t, i, j) && strain_of (t, i, j) > t->limit;
}

/* Sets t->limit, up to which relative displacement over distance counts as strain and not as a crack: three
 * times the value that 95 of 100 pairs of nearly intact neighbours stay below, at least 0.02. Where damage is
 * unknown: six times that of all pairs, at least 0.5. */
static pg_status find_limit (pg_tiles *t)
{
    pg_status status = PG_OK;
    double *strain = NULL;
    size_t m = 0, room = 0;
    for (size_t i = 0; i < t->n; i++) {
        for (size_t s = t->near.start[i]; s < t->near.start[i + 1]; s++) {
            size_t j = (size_t) t->near.node[s];
            if (j <= i || (t->damage && !sound (t, i, j)) || !(isfinite (strain_of (t, i, j)))) continue;
            if (t->cracked[i] && t->cracked[j] && pg_tiles_cut (t, t->place + 2 * i, t->place + 2 * j))
                continue;
            PG_GROW (strain, room, m + 1);
            strain[m++] = strain_of (t, i, j);
        }
    }
    if (m) pg_sort (strain, m, sizeof *strain, pg_ascending_numbers);
    double usual = m ? strain[(size_t) (0.95 * (double) (m - 1))] : 0;
    t->limit = t->damage ? fmax (3 * usual, 0.02) : fmax (6 * usual, 0.5);
done:
    pg_free (strain);
    return status;
}

/* Computes the gradient of the displacement (t->shift) at each point by least squares over the neighbours
 * that have not separated from it; 0 where they do not span the plane. */
static pg_status find_gradients (pg_tiles *t)
{
    pg_status status = PG_OK;
    PG_ALLOC (t->gradient, 4 * t->n);
    for (size_t i = 0; i < t->n; i++) {
        double A[3] = { 0 }, B[4] = { 0 };
        for (size_t s = t->near.start[i]; s < t->near.start[i + 1]; s++) {
            size_t j = (size_t) t->near.node[s];
            if (j == i || torn (t, i, j)) continue;
            double x = t->place[2*j] - t->place[2*i], y = t->place[2*j + 1] - t->place[2*i + 1];
            A[0] += x * x, A[1] += x * y, A[2] += y * y;
            for (size_t c = 0; c < 2; c++) {
                double du = t->shift[2*j + c] - t->shift[2*i + c];
                B[2*c] += du * x, B[2*c + 1] += du * y;
            }
        }
        double det = A[0] * A[2] - A[1] * A[1];
        if (!(det > 1e-3 * (A[0] + A[2]) * (A[0] + A[2]))) continue;
        for (size_t c = 0; c < 2; c++) {
            t->gradient[4*i + 2*c] = (B[2*c] * A[2] - B[2*c + 1] * A[1]) / det;
            t->gradient[4*i + 2*c + 1] = (B[2*c + 1] * A[0] - B[2*c] * A[1]) / det;
        }
    }
done:
    return status;
}

/* Displaces a position x in the part of point o to `to` (both 2, m). */
static void move (const pg_tiles *t, size_t o, const double *x, double *to)
{
    const double *g = t->gradient + 4 * o, dx = x[0] - t->place[2*o], dy = x[1] - t->place[2*o + 1];
    for (size_t c = 0; c < 2; c++) to[c] = x[c] + t->shift[2*o + c] + g[2*c] * dx + g[2*c + 1] * dy;
}

/* ---- faces of pre-cracks ------------------------------------------------------------------------------- */
/* 1 if a pre-crack separates a point from a position `place` of the plane. */
static int separated (void *context, const double *place, size_t point)
{
    const pg_tiles *t = context;
    return pg_tiles_cut (t, t->place + 2 * point, place);
}

/* Computes the displaced positions of n places along one face of a crack from a to b (m). side 1: the face on
 * the left of that direction, 0: on the right; out: n x 2, m; NAN outside the body. The places lie a
 * thousandth of a spacing beside the crack, so that they move with the points of that side only. */
static void face_of (pg_tiles *t, const pg_nearest *nearest, const double *a, const double *b, int side,
                     size_t n, double *out)
{
    double dx = b[0] - a[0], dy = b[1] - a[1], length = hypot (dx, dy),
           off = (side ? 1e-3 : -1e-3) * t->widest;
    for (size_t k = 0; k < n; k++) {
        double s = (double) k / (double) (n - 1),
               at[2] = { a[0] + s * dx - off * dy / length, a[1] + s * dy + off * dx / length };
        long o = pg_tiles_inside (t, at) ? pg_nearest_find (nearest, at, separated, t) : -1;
        out[2*k] = out[2*k + 1] = NAN;
        if (o < 0 || hypot (at[0] - t->place[2*o], at[1] - t->place[2*o + 1]) > 2 * t->widest) continue;
        move (t, (size_t) o, at, out + 2*k);
    }
}

/* A short crack gets about five places per spacing; the rest of its PG_FACE places are NAN. */
pg_status pg_tiles_faces (pg_tiles *t, double **face, size_t *n, size_t *cap)
{
    pg_status status = PG_OK;
    *n = 0;
    pg_nearest *nearest = NULL;
    if (!t->shift || t->dim != 2 || !t->cracks || !t->cracks->n) goto done;
    PG_TRY (pg_nearest_create (&nearest, 2, t->n, t->place));
    for (size_t c = 0; c < t->cracks->n; c++)
        for (int side = 0; side < 2; side++) {
            const double *v = t->cracks->crack[c].vertex;
            double places = 5 * hypot (v[2] - v[0], v[3] - v[1]) / t->widest;
            size_t m = places > 0.75 * PG_FACE ? PG_FACE : (size_t) fmax (places, 0) + 4;
            PG_GROW (*face, *cap, 2 * PG_FACE * (*n + 1));
            double *out = *face + 2 * PG_FACE * (*n)++;
            face_of (t, nearest, v, v + 2, side, m, out);
            for (size_t k = 2 * m; k < 2 * PG_FACE; k++) out[k] = NAN;
        }
done:
    pg_nearest_free (&nearest);
    return status;
}

/* ---- pixels -------------------------------------------------------------------------------------------- */
/* Owner of the pixel that holds the position (a, b) of the plane (m); PG_EMPTY outside the screen. */
static int owner_at (const pg_screen *s, double a, double b)
{
    double i = floor ((a - s->left) * s->scale), j = floor ((s->top - b) * s->scale);
    if (!(i >= 0 && i < s->width && j >= 0 && j < s->height)) return PG_EMPTY;
    return s->owner[(size_t) j * (size_t) s->width + (size_t) i];
}

/* Distance from a point, in spacings, up to which it may take over pixels of its neighbours. */
static const double beyond = 1.1;

/* 1 if point o may have a pixel that comes from the undeformed position x in the part of point `other`, which
 * closes gaps between neighbours: they have not separated, and x lies within `beyond` spacings of o. */
static int lends (const pg_tiles *t, size_t o, const double *x, int other)
{
    double dx = fabs (x[0] - t->place[2*o]), dy = fabs (x[1] - t->place[2*o + 1]);
    return other >= 0 && fmax (dx, dy) < beyond * t->spacing[o] && !torn (t, o, (size_t) other);
}

/* Finds the box of pixels, from .. to, that the square of half edge r (m) around point o moves to; 0: the
 * displaced square is not finite. */
static int box_of (const pg_tiles *t, const pg_screen *s, size_t o, double r, int from[2], int to[2])
{
    double low[2] = { INFINITY, INFINITY }, high[2] = { -INFINITY, -INFINITY }, at[2];
    int most[2] = { s->width, s->height };
    for (int k = 0; k < 4; k++) {
        const double x[2] = { t->place[2*o] + (k & 1 ? r : -r), t->place[2*o + 1] + (k & 2 ? r : -r) };
        move (t, o, x, at);
        at[0] = (at[0] - s->left) * s->scale, at[1] = (s->top - at[1]) * s->scale;
        for (int c = 0; c < 2; c++) low[c] = fmin (low[c], at[c]), high[c] = fmax (high[c], at[c]);
    }
    for (int c = 0; c < 2; c++)
        from[c] = (int) fmin (fmax (floor (low[c]), 0), most[c]),
        to[c] = (int) fmin (fmax (ceil (high[c]), 0), most[c]);
    return isfinite (low[0] + low[1] + high[0] + high[1]);
}

/* Gives point o the pixels of the screen whose undeformed position, found by the inverse of `move`, belongs
 * to it on the screen `rest`, within r (m) of it. spare 1: it gets pixels without owner that come from the
 * parts of its neighbours. */
static void move_part (const pg_tiles *t, const pg_screen *rest, size_t o, double r, int spare, pg_screen *s)
{
    const double *g = t->gradient + 4 * o, *at = t->place + 2 * o, *u = t->shift + 2 * o;
    double det = (1 + g[0]) * (1 + g[3]) - g[1] * g[2], x[2];
    int from[2], to[2];
    if (!box_of (t, s, o, r, from, to) || !(fabs (det) > 1e-6)) return;
    for (int j = from[1]; j < to[1]; j++)
        for (int i = from[0]; i < to[0]; i++) {
            double dx = s->left + (i + 0.5) / s->scale - at[0] - u[0],
                   dy = s->top - (j + 0.5) / s->scale - at[1] - u[1];
            int *owner = &s->owner[(size_t) j * (size_t) s->width + (size_t) i], own;
            if (spare && *owner >= 0) continue;
            x[0] = at[0] + ((1 + g[3]) * dx - g[1] * dy) / det;
            x[1] = at[1] + ((1 + g[0]) * dy - g[2] * dx) / det;
            own = owner_at (rest, x[0], x[1]);
            if (spare ? lends (t, o, x, own) : own == (int) o) *owner = (int) o;
        }
}

/* Moves the parts of all points, then closes gaps between parts of neighbours that have not separated. */
static pg_status move_all (const pg_tiles *t, const pg_screen *rest, pg_screen *s)
{
    pg_status status = PG_OK;
    double *far = NULL;
    PG_ALLOC (far, t->n);
    for (size_t p = 0; p < (size_t) rest->width * (size_t) rest->height; p++) {
        size_t o = rest->owner[p] < 0 ? 0 : (size_t) rest->owner[p];
        double x = rest->left + ((double) (p % (size_t) rest->width) + 0.5) / rest->scale,
               y = rest->top - ((double) (p / (size_t) rest->width) + 0.5) / rest->scale,
               d = fmax (fabs (x - t->place[2*o]), fabs (y - t->place[2*o + 1])) + 1 / rest->scale;
        if (rest->owner[p] >= 0 && d > far[o]) far[o] = d;
    }
    for (size_t k = 0; k < t->n; k++) if (far[k] > 0) move_part (t, rest, k, far[k], 0, s);
    for (size_t k = 0; k < t->n; k++) move_part (t, rest, k, beyond * t->spacing[k], 1, s);
done:
    pg_free (far);
    return status;
}

/* Draws the undeformed body on a screen of its own, 1.5 times as fine as the picture (its longer
 * side at most 3000 pixels), with a margin of 1.6 spacings around the points. */
static pg_status open_rest (const pg_tiles *t, const pg_screen *screen, pg_screen *rest)
{
    pg_status status = PG_OK;
    double low[2], high[2];
    for (int c = 0; c < 2; c++) {
        low[c] = high[c] = t->place[c];
        for (size_t k = 0; k < t->n; k++)
            low[c] = fmin (low[c], t->place[2 * k + (size_t) c]),
            high[c] = fmax (high[c], t->place[2 * k + (size_t) c]);
        low[c] -= 1.6 * t->widest, high[c] += 1.6 * t->widest;
    }
    double size = fmax (high[0] - low[0], high[1] - low[1]);
    *rest = (pg_screen) { .left = low[0], .top = high[1], .scale = fmin (1.5 * screen->scale, 3000 / size) };
    PG_TRY (pg_screen_open (rest, (int) ceil ((high[0] - low[0]) * rest->scale),
                            (int) ceil ((high[1] - low[1]) * rest->scale)));
    PG_TRY (pg_tiles_rest (t, rest));
done:
    return status;
}

/* Copies the undeformed body to the screen of the picture, for pictures without displacements. */
static void copy (const pg_screen *rest, pg_screen *s)
{
    for (int j = 0; j < s->height; j++)
        for (int i = 0; i < s->width; i++)
            s->owner[(size_t) j * (size_t) s->width + (size_t) i] =
                owner_at (rest, s->left + (i + 0.5) / s->scale, s->top - (j + 0.5) / s->scale);
}

/* Points on no lattice are drawn on a larger screen first, as the discs that close their gaps may reach
 * beyond the picture. */
pg_status pg_tiles_draw (pg_tiles *t, pg_screen *screen)
{
    pg_status status = PG_OK;
    pg_screen rest = { 0 };
    if (!t->shift && (t->outline || !t->loose)) return pg_tiles_rest (t, screen);
    PG_TRY (open_rest (t, screen, &rest));
    if (!t->shift) {
        copy (&rest, screen);
        goto done;
    }
    pg_cloud points = { .dim = 2, .n = t->n, .x = t->place, .h = t->widest,
                        .size = t->loose ? t->spacing : NULL };
    PG_TRY (pg_family_build (&t->near, &points, t->n, t->place, 1.6 * t->widest, PG_RADIAL, 0));
    PG_TRY (find_limit (t));
    PG_TRY (find_gradients (t));
    PG_TRY (move_all (t, &rest, screen));
done:
    pg_screen_close (&rest);
    return status;
}
