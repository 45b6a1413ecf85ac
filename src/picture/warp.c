/* SPDX-License-Identifier: GPL-3.0-or-later
 * The displaced body on pixels. A fine grid covers the undeformed body; its corners move with
 * the points around them, and each piece of the grid is filled with what the undeformed pixels
 * show there. So parts of neighbouring points stay joined along displaced lines, whatever
 * their shape.
 *
 *   displacement at x, seen from point o:   u(x) = sum_j w_j (u_j + grad u_j (x - x_j)) / sum_j w_j,
 *                                           w_j = (1 - |x - x_j| / reach)^2,   j not separated from o
 *
 * Two points have separated if a pre-crack passes between them or if their distance has
 * changed more than strain explains. On both sides of a crack o differs, so the two displaced
 * faces open. */
#include "tiles.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Largest numbers of points around a place, and of owners in one piece of the grid. */
enum { NEAR = 96, OWNERS = 24 };
/* The undeformed picture, the screen to fill, and the grid between them. */
typedef struct {
    pg_tiles *t;
    /* Owners of the pixels of the undeformed body. */
    const pg_screen *rest;
    pg_screen *screen;
    /* Lower corner of the grid and edge of a piece, m. */
    double origin[2], step;
    long   count[2];
} warp;

/* Relative displacement of two points over their distance: the strain that would explain it. */
static double strain_of (const pg_tiles *t, size_t i, size_t j)
{
    double dx = t->place[2*j] - t->place[2*i], dy = t->place[2*j + 1] - t->place[2*i + 1];
    return hypot (t->shift[2*j] - t->shift[2*i], t->shift[2*j + 1] - t->shift[2*i + 1]) / hypot (dx, dy);
}

/* Is one of the two points whole (damage below 0.1)? Damage that is not known says nothing. */
static int sound (const pg_tiles *t, size_t i, size_t j)
{
    return t->damage && fmin (t->damage[i], t->damage[j]) < 0.1;
}

/* 1 if two points have separated: a pre-crack passes between them, or neither is nearly whole
 * and their distance has changed by more than the limit. */
static int torn (const pg_tiles *t, size_t i, size_t j)
{
    if (i == j) return 0;
    if (t->cracked[i] && t->cracked[j] && pg_tiles_cut (t, t->place + 2 * i, t->place + 2 * j)) return 1;
    return !sound (t, i, j) && strain_of (t, i, j) > t->limit;
}

/* How much of a relative displacement is strain and no crack: three times the value that 95 of 100 pairs
 * of sound neighbours stay below. Where damage is not known, six times that of all pairs, and no less than
 * half a spacing on the picture. */
static pg_status find_limit (pg_tiles *t)
{
    pg_status status = PG_OK;
    double *strain = NULL;
    size_t m = 0, room = 0;
    int near[NEAR];
    for (size_t i = 0; i < t->n; i++) {
        size_t k = pg_tiles_near (t, t->place + 2 * i, 1.2 * t->spacing[i], NEAR, near);
        for (size_t s = 0; s < k; s++) {
            size_t j = (size_t) near[s];
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

/* Gradient of the shift at each point, by least squares over the neighbours that hold to it; 0 where they
 * do not span the plane. */
static pg_status find_gradients (pg_tiles *t)
{
    pg_status status = PG_OK;
    int near[NEAR];
    PG_ALLOC (t->gradient, 4 * t->n);
    for (size_t i = 0; i < t->n; i++) {
        double A[3] = { 0 }, B[4] = { 0 };
        size_t k = pg_tiles_near (t, t->place + 2 * i, 1.6 * t->spacing[i], NEAR, near);
        for (size_t s = 0; s < k; s++) {
            size_t j = (size_t) near[s];
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

/* Radius of averaging at a place: one and a half spacings of the point nearest to it, so that
 * all pieces that share a corner compute the same displacement there. */
static double reach_at (const pg_tiles *t, size_t o, const double *at)
{
    int near[NEAR];
    double least = INFINITY, reach = 1.5 * t->spacing[o];
    size_t k = pg_tiles_near (t, at, reach, NEAR, near);
    for (size_t s = 0; s < k; s++) {
        size_t j = (size_t) near[s];
        double d = hypot (at[0] - t->place[2*j], at[1] - t->place[2*j + 1]);
        if (d < least) least = d, reach = 1.5 * t->spacing[j];
    }
    return reach;
}

/* Shift of a place as the points that hold to point o see it: their own shifts, carried on by their
 * gradients and weighed by nearness. */
static void shift_at (const pg_tiles *t, size_t o, const double *at, double *out)
{
    int near[NEAR];
    double sum = 0, reach = reach_at (t, o, at);
    size_t k = pg_tiles_near (t, at, reach, NEAR, near);
    out[0] = out[1] = 0;
    for (size_t s = 0; s <= k; s++) {
        size_t j = s < k ? (size_t) near[s] : o;
        if (s == k ? sum > 0 : torn (t, o, j)) continue;
        double x = at[0] - t->place[2 * j], y = at[1] - t->place[2 * j + 1], far = 1 - hypot (x, y) / reach,
               w = s < k ? fmax (far * far, 1e-9) : 1;
        for (size_t c = 0; c < 2; c++)
            out[c] += w
                      * (t->shift[2 * j + c] + t->gradient[4 * j + 2 * c] * x
                         + t->gradient[4 * j + 2 * c + 1] * y);
        sum += w;
    }
    out[0] /= sum, out[1] /= sum;
}

/* ---- faces of pre-cracks ------------------------------------------------------------------------------- */
/* The nearest point within two spacings that no pre-crack separates from a place; -1 where there is none. */
static long beside (const pg_tiles *t, const double *place)
{
    int near[NEAR];
    long best = -1;
    double least = INFINITY;
    size_t k = pg_tiles_near (t, place, 2 * t->widest, NEAR, near);
    for (size_t s = 0; s < k; s++) {
        double d = hypot (t->place[2 * (size_t) near[s]] - place[0],
                          t->place[2 * (size_t) near[s] + 1] - place[1]);
        if (d < least && !pg_tiles_cut (t, t->place + 2 * (size_t) near[s], place)) least = d, best = near[s];
    }
    return best;
}

/* Where n places along one face of a crack from a to b (m) are now: side 1: on the left of that direction, 0:
 * on the right; out: n x 2, m; NAN outside the body.
 * Places are taken a thousandth of a spacing beside the crack, on the side that is asked for,
 * so that they see the points of that side only. */
static void face_of (const pg_tiles *t, const double *a, const double *b, int side, size_t n, double *out)
{
    double dx = b[0] - a[0], dy = b[1] - a[1], length = hypot (dx, dy),
           off = (side ? 1e-3 : -1e-3) * t->widest;
    for (size_t k = 0; k < n; k++) {
        double s = (double) k / (double) (n - 1),
               at[2] = { a[0] + s * dx - off * dy / length, a[1] + s * dy + off * dx / length }, u[2];
        long o = pg_tiles_inside (t, at) ? beside (t, at) : -1;
        out[2*k] = out[2*k + 1] = NAN;
        if (o < 0) continue;
        shift_at (t, (size_t) o, at, u);
        out[2*k] = at[0] + u[0], out[2*k + 1] = at[1] + u[1];
    }
}

/* Five places in a spacing of a short piece, none behind them. */
pg_status pg_tiles_faces (const pg_tiles *t, double **face, size_t *n, size_t *cap)
{
    pg_status status = PG_OK;
    *n = 0;
    if (!t->shift || t->dim != 2 || !t->cracks) goto done;
    for (size_t c = 0; c < t->cracks->n; c++)
        for (int side = 0; side < 2; side++) {
            const double *v = t->cracks->crack[c].vertex;
            double places = 5 * hypot (v[2] - v[0], v[3] - v[1]) / t->widest;
            size_t m = places > 0.75 * PG_FACE ? PG_FACE : (size_t) fmax (places, 0) + 4;
            PG_GROW (*face, *cap, 2 * PG_FACE * (*n + 1));
            double *out = *face + 2 * PG_FACE * (*n)++;
            face_of (t, v, v + 2, side, m, out);
            for (size_t k = 2 * m; k < 2 * PG_FACE; k++) out[k] = NAN;
        }
done:
    return status;
}

/* ---- pieces -------------------------------------------------------------------------------------------- */
/* Owner of the pixel at rest that holds a place. */
static int rest_at (const warp *w, double a, double b)
{
    double i = floor ((a - w->rest->left) * w->rest->scale), j = floor ((w->rest->top - b) * w->rest->scale);
    if (!(i >= 0 && i < w->rest->width && j >= 0 && j < w->rest->height)) return PG_EMPTY;
    return w->rest->owner[(size_t) j * (size_t) w->rest->width + (size_t) i];
}

/* A triangle with its corners in the undeformed body (a, m) and on the screen (v, pixels):
 * gives to o the pixels that come from pixels of o. Triangles overlap by 3 % of their size,
 * which closes gaps between pieces of different owners. */
static void fill (const warp *w, const double a[3][2], const double v[3][2], int o)
{
    pg_screen *s = w->screen;
    double area = (v[1][0] - v[0][0]) * (v[2][1] - v[0][1]) - (v[2][0] - v[0][0]) * (v[1][1] - v[0][1]);
    int first[2], last[2], most[2] = { s->width, s->height };
    if (!(fabs (area) > 1e-9)) return;
    for (int c = 0; c < 2; c++) {
        double low = ceil (fmin (fmin (v[0][c], v[1][c]), v[2][c]) - 0.5 - 1e-6),
               high = floor (fmax (fmax (v[0][c], v[1][c]), v[2][c]) - 0.5 + 1e-6);
        first[c] = low < 0 ? 0 : low < most[c] ? (int) low : most[c];
        last[c] = high < 0 ? -1 : high < most[c] ? (int) high : most[c] - 1;
    }
    for (int j = first[1]; j <= last[1]; j++)
        for (int i = first[0]; i <= last[0]; i++) {
            double x = i + 0.5, y = j + 0.5, b[3];
            for (int k = 0; k < 3; k++) {
                const double *p = v[(k + 1) % 3], *q = v[(k + 2) % 3];
                b[k] = ((p[0] - x) * (q[1] - y) - (q[0] - x) * (p[1] - y)) / area;
            }
            if (b[0] < -0.03 || b[1] < -0.03 || b[2] < -0.03) continue;  /* neighbours overlap a little */
            if (rest_at (w, b[0] * a[0][0] + b[1] * a[1][0] + b[2] * a[2][0],
                         b[0] * a[0][1] + b[1] * a[1][1] + b[2] * a[2][1])
                == o)
                s->owner[(size_t) j * (size_t) s->width + (size_t) i] = o;
        }
}

/* The owners of the undeformed pixels in one piece of the grid and one pixel around it;
 * returns their number. */
static int owners_in (const warp *w, const double *low, int *owner)
{
    int n = 0;
    int from[2] = { (int) floor ((low[0] - w->rest->left) * w->rest->scale) - 1,
                    (int) floor ((w->rest->top - low[1] - w->step) * w->rest->scale) - 1 };
    int more = (int) ceil (w->step * w->rest->scale) + 2;
    for (int j = from[1]; j <= from[1] + more; j++)
        for (int i = from[0]; i <= from[0] + more; i++) {
            if (i < 0 || j < 0 || i >= w->rest->width || j >= w->rest->height) continue;
            int o = w->rest->owner[(size_t) j * (size_t) w->rest->width + (size_t) i], k = 0;
            if (o < 0) continue;
            while (k < n && owner[k] != o) k++;
            if (k == n && n < OWNERS) owner[n++] = o;
        }
    return n;
}

/* Moves the corners of one piece of the grid as point o sees them, and fills it with the pixels of o. */
static void draw_piece (const warp *w, const double *low, int o)
{
    static const int round[4][2] = { { 0, 0 }, { 1, 0 }, { 1, 1 }, { 0, 1 } };
    double a[4][2], v[4][2];
    for (int k = 0; k < 4; k++) {
        double u[2];
        for (int c = 0; c < 2; c++) a[k][c] = low[c] + round[k][c] * w->step;
        shift_at (w->t, (size_t) o, a[k], u);
        v[k][0] = (a[k][0] + u[0] - w->screen->left) * w->screen->scale,
        v[k][1] = (w->screen->top - a[k][1] - u[1]) * w->screen->scale;
        if (!isfinite (v[k][0]) || !isfinite (v[k][1])) return;
    }
    for (int half = 0; half < 2; half++) {
        double b[3][2], x[3][2];
        for (int k = 0; k < 3; k++) {
            int corner = k == 0 ? 0 : half + k;
            memcpy (b[k], a[corner], sizeof b[k]), memcpy (x[k], v[corner], sizeof x[k]);
        }
        fill (w, (const double (*)[2]) b, (const double (*)[2]) x, o);
    }
}

/* The undeformed body on a screen of its own, 1.5 times as fine as the picture (its longer
 * side at most 3000 pixels), with an edge wider than what the points reach. */
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

/* Every piece of the grid, once for each point that owns a part of it. */
static void displace (const warp *w)
{
    for (long j = 0; j < w->count[1]; j++)
        for (long i = 0; i < w->count[0]; i++) {
            double low[2] = { w->origin[0] + (double) i * w->step, w->origin[1] + (double) j * w->step };
            int owner[OWNERS], n = owners_in (w, low, owner);
            for (int k = 0; k < n; k++) draw_piece (w, low, owner[k]);
        }
}

/* Without displacements the screen shows the body at rest. */
static void copy (const warp *w)
{
    pg_screen *s = w->screen;
    for (int j = 0; j < s->height; j++)
        for (int i = 0; i < s->width; i++)
            s->owner[(size_t) j * (size_t) s->width + (size_t) i] = rest_at (w,
                                                                             s->left + (i + 0.5) / s->scale,
                                                                             s->top - (j + 0.5) / s->scale);
}

/* The grid is as fine as half a spacing or three pixels, with at most 2000 pieces along its longer side. */
pg_status pg_tiles_draw (pg_tiles *t, pg_screen *screen)
{
    pg_status status = PG_OK;
    pg_screen rest = { 0 };
    if (!t->shift && t->outline) return pg_tiles_rest (t, screen);
    PG_TRY (open_rest (t, screen, &rest));
    warp w = {
        .t = t, .rest = &rest, .screen = screen, .origin = { rest.left, rest.top - rest.height / rest.scale }
    };
    if (!t->shift) {
        copy (&w);
        goto done;
    }
    PG_TRY (find_limit (t));
    PG_TRY (find_gradients (t));
    double least = t->widest;
    for (size_t k = 0; k < t->n; k++) least = fmin (least, t->spacing[k]);
    w.step = fmax (fmax (0.5 * least, 3 / rest.scale), fmax (rest.width, rest.height) / rest.scale / 2000);
    for (int c = 0; c < 2; c++)
        w.count[c] = (long) ceil ((c ? rest.height : rest.width) / rest.scale / w.step);
    displace (&w);
done:
    pg_screen_close (&rest);
    return status;
}
