/* SPDX-License-Identifier: GPL-3.0-or-later
 * The undeformed body on the pixels of its plane. Two questions are answered for each pixel:
 * is the body there, which its outline says, or the points alone where there is no outline;
 * and which point does it belong to: the nearest one that no pre-crack separates from it (a
 * Voronoi diagram that respects cracks).
 *
 * Irregular points without an outline are surrounded by discs of one and a quarter spacings,
 * which close all gaps; then the outline is moved inwards by an exact distance transform
 * (Felzenszwalb and Huttenlocher, Theory of Computing 8, 2012) until the area of what remains
 * is that of the points together. */
#include "tiles.h"
#include <math.h>
#include <string.h>

/* From coordinates of the picture's plane to a place in space. */
void pg_tiles_space (const pg_tiles *t, double a, double b, double *x)
{
    for (int k = 0; k < 3; k++)
        x[k] = t->dim == 2 ? (k == 0   ? a
                              : k == 1 ? b
                                       : 0)
                           : a * t->eye->right[k] + b * t->eye->up[k] + t->at * t->eye->toward[k];
}

/* ---- points in buckets --------------------------------------------------------------------------------- */
/* Bucket of a place along one axis; places outside count to the outermost bucket. */
static long bucket_of (const pg_tiles *t, int axis, double place)
{
    double k = floor ((place - t->low[axis]) / t->pitch);
    return k < 0 ? 0 : k >= t->buckets[axis] ? t->buckets[axis] - 1 : (long) k;
}

/* Sorts the points into square buckets of 1.6 times the largest spacing by counting: the first
 * pass counts, the second one fills each bucket from its end. */
static pg_status sort_points (pg_tiles *t)
{
    pg_status status = PG_OK;
    t->pitch = fmax (1.6 * t->widest, 1e-300);
    for (int a = 0; a < 2; a++) {
        double high = t->low[a] = t->place[a];
        for (size_t k = 0; k < t->n; k++)
            t->low[a] = fmin (t->low[a], t->place[2 * k + (size_t) a]),
            high = fmax (high, t->place[2 * k + (size_t) a]);
        t->buckets[a] = (long) fmin ((high - t->low[a]) / t->pitch + 1, 4096);
    }
    size_t all = (size_t) (t->buckets[0] * t->buckets[1]);
    PG_ALLOC (t->first, all + 1);
    PG_ALLOC (t->sorted, t->n);
    for (int pass = 0; pass < 2; pass++) {
        for (size_t k = 0; k < t->n; k++) {
            size_t b = (size_t) (bucket_of (t, 1, t->place[2 * k + 1]) * t->buckets[0]
                                 + bucket_of (t, 0, t->place[2 * k]));
            if (pass) t->sorted[--t->first[b + 1]] = (int) k;
            else t->first[b + 1]++;
        }
        for (size_t b = 0; !pass && b < all; b++) t->first[b + 1] += t->first[b];
        for (size_t b = 0; pass && b < all; b++) t->first[b] = t->first[b + 1];
        if (pass) t->first[all] = t->n;
    }
done:
    return status;
}

/* Looks into the buckets that the circle touches. */
size_t pg_tiles_near (const pg_tiles *t, const double *at, double reach, size_t most, int *out)
{
    size_t n = 0;
    long from[2], to[2];
    for (int a = 0; a < 2; a++)
        from[a] = bucket_of (t, a, at[a] - reach), to[a] = bucket_of (t, a, at[a] + reach);
    for (long j = from[1]; j <= to[1]; j++)
        for (long i = from[0]; i <= to[0]; i++)
            for (size_t s = t->first[j * t->buckets[0] + i]; s < t->first[j * t->buckets[0] + i + 1]; s++) {
                const double *p = t->place + 2 * (size_t) t->sorted[s];
                double dx = p[0] - at[0], dy = p[1] - at[1];
                if (dx * dx + dy * dy <= reach * reach && n < most) out[n++] = t->sorted[s];
            }
    return n;
}

/* ---- spacing ------------------------------------------------------------------------------------------- */
/* Replaces each spacing by the mean of those around it, so that the reach of neighbours does not jump. */
static pg_status smooth_spacing (pg_tiles *t)
{
    pg_status status = PG_OK;
    enum { MOST = 64 };
    int near[MOST];
    double *mean = NULL;
    PG_ALLOC (mean, t->n);
    for (size_t k = 0; k < t->n; k++) {
        size_t m = pg_tiles_near (t, t->place + 2 * k, 2 * t->spacing[k], MOST, near);
        for (size_t i = 0; i < m; i++) mean[k] += t->spacing[near[i]] / (double) m;
    }
    t->widest = 0;
    for (size_t k = 0; k < t->n; k++) t->spacing[k] = mean[k], t->widest = fmax (t->widest, mean[k]);
done:
    pg_free (mean);
    return status;
}

/* Spacings of the points: the given ones; else the step of the lattice; else, for irregular
 * points, the distance of the third nearest neighbour, searched in circles that double until
 * three are found. */
static pg_status measure_spacing (pg_tiles *t)
{
    pg_status status = PG_OK;
    int *near = NULL;
    enum { MOST = 512 };
    PG_ALLOC (near, MOST);
    PG_ALLOC (t->spacing, t->n);
    for (size_t k = 0; k < t->n; k++) t->spacing[k] = t->size ? t->size[k] : fmax (t->step[0], t->step[1]);
    for (size_t k = 0; k < t->n; k++) t->widest = fmax (t->widest, t->spacing[k]);
    PG_TRY (sort_points (t));
    if (!t->loose || t->size) goto done;
    for (size_t k = 0; k < t->n; k++) {
        double third[3] = { INFINITY, INFINITY, INFINITY }, reach = t->spacing[k];
        for (int more = 0; more < 6 && !isfinite (third[2]); more++, reach *= 2) {
            size_t m = pg_tiles_near (t, t->place + 2 * k, reach, MOST, near);
            third[0] = third[1] = third[2] = INFINITY;
            for (size_t i = 0; i < m; i++) {
                double d = hypot (t->place[2 * (size_t) near[i]] - t->place[2 * k],
                                  t->place[2 * (size_t) near[i] + 1] - t->place[2 * k + 1]);
                if (!(d > 0) || d >= third[2]) continue;
                third[2] = d;
                for (int s = 1; s >= 0 && third[s] > third[s + 1]; s--)
                    d = third[s], third[s] = third[s + 1], third[s + 1] = d;
            }
        }
        if (isfinite (third[2])) t->spacing[k] = third[2];
    }
    PG_TRY (smooth_spacing (t));
    pg_free (t->first), pg_free (t->sorted), t->first = NULL, t->sorted = NULL;
    PG_TRY (sort_points (t));
done:
    pg_free (near);
    return status;
}

/* Values of pg_tiles.cracked. */
enum { NEAR_CRACK = 1, ON_CRACK };

/* ---- cracks -------------------------------------------------------------------------------------------- */
/* Does a pre-crack cross the straight line from a to b? */
int pg_tiles_cut (const pg_tiles *t, const double *a, const double *b)
{
    double x[3], y[3];
    pg_tiles_space (t, a[0], a[1], x), pg_tiles_space (t, b[0], b[1], y);
    return t->cracks && pg_cracks_cut (t->cracks, x, y, 0);
}

/* Does the point lie on a crack itself? Then it belongs to both sides; of a crack that is sided it does
 * not. */
static int on_crack (const pg_tiles *t, size_t k)
{
    double x[3];
    pg_tiles_space (t, t->place[2*k], t->place[2*k + 1], x);
    for (size_t c = 0; c < t->cracks->n; c++) {
        const pg_crack *crack = &t->cracks->crack[c];
        if (!crack->sided && pg_crack_touches (crack, t->dim, x, 1e-9 * t->spacing[k])) return 1;
    }
    return 0;
}

/* Marks the points with a pre-crack within about two spacings, found by 16 rays. Only these
 * need the costly question whether a crack lies between a pixel and a point. In the plane the
 * box about the rays tells of most points that no crack can be near. */
static pg_status find_cracked (pg_tiles *t)
{
    pg_status status = PG_OK;
    enum { RAYS = 16 };
    double ray[RAYS][2];
    PG_ALLOC (t->cracked, t->n);
    for (int s = 0; s < RAYS; s++)
        ray[s][0] = cos (0.39269908 * s + 0.1), ray[s][1] = sin (0.39269908 * s + 0.1);
    for (size_t k = 0; t->cracks && t->cracks->n && k < t->n; k++) {
        const double *at = t->place + 2 * k;
        double r = 2.1 * t->spacing[k], low[2] = { at[0] - r, at[1] - r }, high[2] = { at[0] + r, at[1] + r };
        if (t->dim == 2 && !pg_cracks_near (t->cracks, low, high)) continue;
        for (int s = 0; s < RAYS && !t->cracked[k]; s++) {
            double end[2] = { at[0] + r * ray[s][0], at[1] + r * ray[s][1] };
            t->cracked[k] = (unsigned char) pg_tiles_cut (t, at, end);
        }
        if (t->cracked[k] && on_crack (t, k)) t->cracked[k] = ON_CRACK;
    }
done:
    return status;
}

pg_status pg_tiles_open (pg_tiles *t)
{
    pg_status status = PG_OK;
    PG_TRY (measure_spacing (t));
    PG_TRY (find_cracked (t));
done:
    return status;
}

void pg_tiles_close (pg_tiles *t)
{
    pg_free (t->spacing), pg_free (t->first), pg_free (t->sorted), pg_free (t->cracked),
        pg_free (t->gradient);
    t->spacing = t->gradient = NULL, t->first = NULL, t->sorted = NULL, t->cracked = NULL;
}

/* ---- the outline --------------------------------------------------------------------------------------- */
/* 1 if a place lies in a cell of the lattice that belongs to the body; the upper faces belong
 * to the last cells. */
static int in_lattice (const pg_lattice *l, const double *x)
{
    size_t at = 0, stride = 1;
    for (int k = 0; k < l->dim; k++) {
        double t = (x[k] - l->origin[k]) / l->step[k],
               i = t >= l->count[k] && t < l->count[k] + 1e-6 ? l->count[k] - 1 : floor (t + 1e-9);
        if (!(i >= 0 && i < l->count[k])) return 0;
        at += stride * (size_t) i, stride *= (size_t) l->count[k];
    }
    return l->in[at];
}

/* Fills the pixels of a plane element as a fan of triangles through its nodes in their order
 * around it; the sides of quadratic elements become two straight pieces. */
static void fill_element (const pg_mesh *m, size_t e, pg_screen *s)
{
    static const unsigned char round[3][9] = { { 0, 3, 1, 4, 2, 5 },
                                               { 0, 4, 1, 5, 2, 6, 3, 7 },
                                               { 0, 1, 2, 3 } };
    const pg_element_type *type = &pg_element_types[m->kind[e]];
    const unsigned char *order = round[type->order == 2 ? type->corners == 4 : 2];
    int last = (type->order == 2 ? 2 * type->corners : type->corners) - 1;
    double v[3][3] = { { 0 } };
    for (int k = 1; k < last; k++) {
        const int corner[3] = { order[0], order[k], order[k + 1] };
        for (int i = 0; i < 3; i++) {
            const double *x = m->x + 3 * (size_t) m->node[m->start[e] + (size_t) corner[i]];
            v[i][0] = (x[0] - s->left) * s->scale, v[i][1] = (s->top - x[1]) * s->scale;
        }
        pg_triangle (s, (const double (*)[3]) v, 0, 1, NULL);
    }
}

/* Is the place in the body, as far as an outline says? */
int pg_tiles_inside (const pg_tiles *t, const double *at)
{
    const pg_outline *o = t->outline;
    double x[3];
    if (!o || o->mesh) return 1;
    pg_tiles_space (t, at[0], at[1], x);
    return o->lattice && o->lattice->dim ? in_lattice (o->lattice, x)
                                         : pg_body_inside (o->body, x, 1e-6 * t->widest);
}

/* Pixels first[0] .. last[0] - 1 of the rows first[1] .. last[1] - 1. */
typedef struct { int first[2], last[2]; } pixels;

/* Sets the mask of pixels by the shapes of a body. All pixels of a rectangle are in it where its middle is by
 * more than half of its diagonal, and none is where the middle is not within that distance; else it is
 * halved. */
static void mask_by_shapes (const pg_tiles *t, const pg_screen *s, pixels p, unsigned char *mask)
{
    enum { SMALL = 3 };
    int wide = p.last[0] - p.first[0], high = p.last[1] - p.first[1], axis = high > wide, in = -1;
    double at[2] = { s->left + 0.5 * (p.first[0] + p.last[0]) / s->scale,
                     s->top - 0.5 * (p.first[1] + p.last[1]) / s->scale }, x[3];
    double tolerance = 1e-6 * t->widest, half = 0.5 * hypot (wide, high) / s->scale;
    if (wide > SMALL || high > SMALL) {
        pg_tiles_space (t, at[0], at[1], x);
        if (!pg_body_inside (t->outline->body, x, tolerance + half)) in = 0;
        else if (pg_body_inside (t->outline->body, x, tolerance - half)) in = 1;
    }
    if (in < 0 && (wide > SMALL || high > SMALL)) {
        pixels part[2] = { p, p };
        part[0].last[axis] = part[1].first[axis] = p.first[axis] + (axis ? high : wide) / 2;
        for (int k = 0; k < 2; k++) mask_by_shapes (t, s, part[k], mask);
        return;
    }
    for (int j = p.first[1]; j < p.last[1]; j++)
        for (int i = p.first[0]; i < p.last[0]; i++) {
            double centre[2] = { s->left + (i + 0.5) / s->scale, s->top - (j + 0.5) / s->scale };
            mask[(size_t) j * (size_t) s->width + (size_t) i] =
                (unsigned char) (in >= 0 ? in : pg_tiles_inside (t, centre));
        }
}

/* mask = 1 for each pixel whose centre lies in the body (width x height). */
pg_status pg_tiles_mask (const pg_tiles *t, const pg_screen *s, unsigned char *mask)
{
    pg_status status = PG_OK;
    const pg_outline *o = t->outline;
    pg_screen m = { .left = s->left, .top = s->top, .scale = s->scale };
    if (!o->mesh && !(o->lattice && o->lattice->dim)) {
        mask_by_shapes (t, s, (pixels) { { 0, 0 }, { s->width, s->height } }, mask);
        return PG_OK;
    }
    if (o->mesh) {
        PG_TRY (pg_screen_open (&m, s->width, s->height));
        for (size_t e = 0; e < o->mesh->n; e++) fill_element (o->mesh, e, &m);
    }
    for (int j = 0; j < s->height; j++)
        for (int i = 0; i < s->width; i++) {
            size_t p = (size_t) j * (size_t) s->width + (size_t) i;
            double at[2] = { s->left + (i + 0.5) / s->scale, s->top - (j + 0.5) / s->scale };
            mask[p] = o->mesh ? m.owner[p] >= 0 : pg_tiles_inside (t, at);
        }
done:
    pg_screen_close (&m);
    return status;
}

/* ---- owners -------------------------------------------------------------------------------------------- */
/* Distance of a place from point k, m. On a lattice with unequal steps it is measured in
 * steps, so that a pixel belongs to the cell that it lies in. */
static double distance_to (const pg_tiles *t, size_t k, double a, double b)
{
    double dx = a - t->place[2*k], dy = b - t->place[2*k + 1];
    if (!t->loose) dy *= t->step[0] / t->step[1];
    return sqrt (dx * dx + dy * dy);
}

/* A square of a distance that is so many times that of another belongs to the larger distance, rounding of
 * both, one of them to a float, allowed for. */
static const double sure = 1 + 1e-6;

/* May one of eight pixels of a row go to a point that is `dx` (m, of the first; the next ones `step` further
 * each) and `dy` away? Of most the answer is no by the square of the distance alone: it is above those of the
 * points they have (squared `far`: none yet). */
enum { LANES = 8 };
static inline __attribute__ ((always_inline)) int some_nearer (const float *has, double dx, double step,
                                                               double dy, double far)
{
    int some = 0;
    for (int l = 0; l < LANES; l++) {
        double x = dx + l * step, limit = has[l] < far ? (double) has[l] : far;
        some |= x * x + dy * dy <= sure * limit * limit;
    }
    return some;
}

/* Gives pixel (i, j) to point k if that is nearer than the pixel's owner. */
static void offer (const pg_tiles *t, size_t k, double far, int i, int j, pg_screen *s)
{
    size_t p = (size_t) j * (size_t) s->width + (size_t) i;
    double place[2] = { s->left + (i + 0.5) / s->scale, s->top - (j + 0.5) / s->scale },
           d = distance_to (t, k, place[0], place[1]);
    if (d > far || (s->owner[p] >= 0 && d >= s->depth[p])) return;
    if (t->cracked[k] == NEAR_CRACK && pg_tiles_cut (t, t->place + 2 * k, place)) d += 1e3 * t->widest;
    if (s->owner[p] < 0 || d < s->depth[p]) s->owner[p] = (int) k, s->depth[p] = (float) d;
}

/* Gives eight pixels of a row, from (i, j) on, to point k where it is nearer than their owner, as `offer`
 * does for one; no crack is near, pixels without owner have infinite depth. dy: from the point, m. */
static inline __attribute__ ((always_inline)) void offer_eight (const double *at, size_t k, double far, int i,
                                                                double dy, double left, double scale,
                                                                int *owner, float *depth)
{
    double d[LANES];
    for (int l = 0; l < LANES; l++) {
        double dx = left + (i + l + 0.5) / scale - at[0];
        d[l] = sqrt (dx * dx + dy * dy);
    }
    for (int l = 0; l < LANES; l++) {
        int takes = d[l] <= far && d[l] < depth[l];
        owner[l] = takes ? (int) k : owner[l], depth[l] = takes ? (float) d[l] : depth[l];
    }
}

/* Offers point k to the pixels within `reach` spacings: the nearest point owns a pixel, and one across a
 * pre-crack only where there is no other. What lies on a crack is on both sides of it. Pixels without an
 * owner have an infinite depth. Groups of eight may end behind the range: pixels there are too far away by
 * half a pixel or more. */
PG_WIDE static void stamp (const pg_tiles *t, size_t k, double reach, pg_screen *s)
{
    const double *at = t->place + 2 * k;
    int from[2], to[2], most[2] = { s->width, s->height };
    for (int a = 0; a < 2; a++) {
        double middle = a ? (s->top - at[1]) * s->scale : (at[0] - s->left) * s->scale,
               r = reach * t->spacing[k] * s->scale;
        from[a] = (int) fmin (fmax (floor (middle - r), 0), most[a]),
        to[a] = (int) fmin (fmax (ceil (middle + r), 0), most[a]);
    }
    double far = reach * t->spacing[k], step = 1 / s->scale, ratio = t->loose ? 1 : t->step[0] / t->step[1];
    for (int j = from[1]; j < to[1]; j++) {
        double dy = (s->top - (j + 0.5) * step - at[1]) * ratio;
        size_t row = (size_t) j * (size_t) s->width;
        double exact = (s->top - (j + 0.5) / s->scale - at[1]) * ratio;
        for (int i = from[0]; i < to[0]; i += LANES) {
            double dx = s->left + (i + 0.5) * step - at[0];
            int whole = i + LANES <= s->width, end = i + LANES < to[0] ? i + LANES : to[0];
            if (whole && !some_nearer (s->depth + row + i, dx, step, dy, far)) continue;
            if (whole && t->cracked[k] != NEAR_CRACK)
                offer_eight (at, k, far, i, exact, s->left, s->scale, s->owner + row + i, s->depth + row + i);
            else for (int c = i; c < end; c++) offer (t, k, far, c, j, s);
        }
    }
}

/* Pixels of the body beyond the reach of every point take the nearest one; pixels outside are
 * emptied. */
static pg_status adopt (const pg_tiles *t, const unsigned char *mask, pg_screen *s)
{
    pg_status status = PG_OK;
    pg_nearest *nearest = NULL;
    for (size_t p = 0; p < (size_t) s->width * (size_t) s->height; p++) {
        if (!mask[p]) s->owner[p] = PG_EMPTY;
        if (!mask[p] || s->owner[p] >= 0) continue;
        double place[2] = { s->left + ((double) (p % (size_t) s->width) + 0.5) / s->scale,
                            s->top - ((double) (p / (size_t) s->width) + 0.5) / s->scale };
        if (!nearest) PG_TRY (pg_nearest_create (&nearest, 2, t->n, t->place));
        s->owner[p] = (int) pg_nearest_find (nearest, place, NULL, NULL);
    }
done:
    pg_nearest_free (&nearest);
    return status;
}

/* ---- clouds without an outline ------------------------------------------------------------------------- */
/* One pass of the exact distance transform along n values, `step` apart: replaces f(q) by min
 * over r of (q - r)^2 + f(r), which is the lower envelope of parabolas. v (n) and z (n + 1)
 * hold the parabolas of the envelope and their borders, out (n) the result. */
static void transform_line (float *f, size_t step, int n, float *out, int *v, double *z)
{
    int k = 0;
    v[0] = 0, z[0] = -INFINITY, z[1] = INFINITY;
    for (int q = 1; q < n; q++) {
        double s;
        for (;;) {
            int r = v[k];
            s = ((f[(size_t) q * step] + (double) q * q) - (f[(size_t) r * step] + (double) r * r))
                / (2.0 * (q - r));
            if (s > z[k] || k == 0) break;
            k--;
        }
        if (s <= z[k]) v[k] = q, z[k + 1] = INFINITY;
        else k++, v[k] = q, z[k] = s, z[k + 1] = INFINITY;
    }
    for (int q = 0, e = 0; q < n; q++) {
        while (z[e + 1] < q) e++;
        out[q] = (float) ((double) (q - v[e]) * (q - v[e]) + f[(size_t) v[e] * step]);
    }
    for (int q = 0; q < n; q++) f[(size_t) q * step] = out[q];
}

/* Distance in pixels from every owned pixel to the nearest one without an owner, by the exact distance
 * transform (columns, then rows). */
static pg_status distance_to_nothing (const pg_screen *s, float *f)
{
    pg_status status = PG_OK;
    int w = s->width, h = s->height, n = w > h ? w : h, *v = NULL;
    double *z = NULL;
    float *out = NULL;
    PG_ALLOC (v, n + 1);
    PG_ALLOC (z, n + 2);
    PG_ALLOC (out, n);
    for (int p = 0; p < w * h; p++) f[p] = s->owner[p] < 0 ? 0 : 1e12f;
    for (int i = 0; i < w; i++) transform_line (f + i, (size_t) w, h, out, v, z);
    for (int j = 0; j < h; j++) transform_line (f + (size_t) j * (size_t) w, 1, w, out, v, z);
    for (int p = 0; p < w * h; p++) f[p] = sqrtf (f[p]);
done:
    pg_free (v), pg_free (z), pg_free (out);
    return status;
}

/* Radius of the discs that close the gaps, in quarters of a spacing. */
enum { GROWN = 5 };                                    /* quarters of a spacing */
/* How many pixels stay when the outline is drawn `rim` spacings outside the outer points; drop: the others
 * lose their owner. */
static double kept (const pg_tiles *t, const pg_screen *s, const float *inward, double rim, int drop)
{
    double n = 0;
    for (size_t p = 0; p < (size_t) s->width * (size_t) s->height; p++) {
        if (s->owner[p] < 0) continue;
        int in = inward[p] >= (0.25 * GROWN - rim) * t->spacing[s->owner[p]] * s->scale;
        n += in;
        if (drop && !in) s->owner[p] = PG_EMPTY;
    }
    return n;
}

/* Finds by bisection the outline that encloses the area of the points. Where that is not
 * known, the outline lies 0.4 spacings outside of the outer points. */
static pg_status close_gaps (const pg_tiles *t, pg_screen *s)
{
    pg_status status = PG_OK;
    float *inward = NULL;
    double low = 0, high = 0.75, rim = 0.4;
    PG_ALLOC (inward, (size_t) s->width * (size_t) s->height);
    PG_TRY (distance_to_nothing (s, inward));
    for (int k = 0; k < 16 && t->area > 0; k++) {
        rim = 0.5 * (low + high);
        if (kept (t, s, inward, rim, 0) / (s->scale * s->scale) < t->area) low = rim;
        else high = rim;
    }
    kept (t, s, inward, rim, 1);
done:
    pg_free (inward);
    return status;
}

/* Points of a lattice of which nothing else is known: their rectangular cells. */
static pg_status lay_cells (const pg_tiles *t, pg_screen *s)
{
    pg_status status = PG_OK;
    pg_spots spots = { .n = t->n, .size = { t->step[0] * s->scale, t->step[1] * s->scale }, .reach = 1.9 };
    PG_ALLOC (spots.place, 2 * t->n);
    for (size_t k = 0; k < t->n; k++)
        spots.place[2 * k] = (t->place[2 * k] - s->left) * s->scale,
                        spots.place[2 * k + 1] = (s->top - t->place[2 * k + 1]) * s->scale;
    PG_TRY (pg_raster (&spots, s->width, s->height, s->owner));
done:
    pg_free (spots.place);
    return status;
}

/* With an outline the body is what the outline says; without one, a lattice is its cells, and loose points
 * are closed to one body whose area is that of their volumes. */
pg_status pg_tiles_rest (const pg_tiles *t, pg_screen *s)
{
    pg_status status = PG_OK;
    unsigned char *mask = NULL;
    if (!t->outline && !t->loose) return lay_cells (t, s);
    for (size_t p = 0; p < (size_t) s->width * (size_t) s->height; p++) s->depth[p] = INFINITY;
    for (size_t k = 0; k < t->n; k++) stamp (t, k, t->outline ? 1.5 : 0.25 * GROWN, s);
    if (!t->outline) {
        PG_TRY (close_gaps (t, s));
        goto done;
    }
    PG_ALLOC (mask, (size_t) s->width * (size_t) s->height);
    PG_TRY (pg_tiles_mask (t, s, mask));
    PG_TRY (adopt (t, mask, s));
done:
    pg_free (mask);
    for (size_t p = 0; p < (size_t) s->width * (size_t) s->height; p++) s->depth[p] = -INFINITY;
    return status;
}
