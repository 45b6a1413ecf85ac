/* SPDX-License-Identifier: GPL-3.0-or-later
 * Draws the undeformed body on the pixels of its plane. Two questions are answered for each pixel:
 * is the body there, which its outline says, or the points alone where there is no outline;
 * and which point does it belong to: the nearest one that no pre-crack separates from it (a
 * Voronoi diagram that respects cracks).
 *
 * Points of a lattice without an outline have the pixels of their cells. Irregular ones are
 * surrounded by discs of one and a quarter spacings, which close all gaps; then the outline is
 * moved inwards until the area of what remains is that of the points together. */
#include "tiles.h"
#include <math.h>
#include <string.h>

/* Converts the coordinates (a, b) of the picture's plane to a point x of space (all m). */
void pg_tiles_space (const pg_tiles *t, double a, double b, double *x)
{
    for (int k = 0; k < 3; k++)
        x[k] = t->dim == 2 ? (k == 0   ? a
                              : k == 1 ? b
                                       : 0)
                           : a * t->eye->right[k] + b * t->eye->up[k] + t->at * t->eye->toward[k];
}

/* Spacings of the points: the given ones, else the step of the lattice. */
static pg_status take_spacing (pg_tiles *t)
{
    pg_status status = PG_OK;
    double step = fmax (t->step[0], t->step[1]);
    PG_ALLOC (t->spacing, t->n);
    for (size_t k = 0; k < t->n; k++) {
        t->spacing[k] = t->size && t->size[k] > 0 && isfinite (t->size[k]) ? t->size[k] : step;
        t->widest = fmax (t->widest, t->spacing[k]);
    }
done:
    return status;
}

/* Values of pg_tiles.cracked; owner of a pixel whose point has not been found yet. */
enum { NEAR_CRACK = 1, ON_CRACK, UNKNOWN = -10 };

/* ---- cracks -------------------------------------------------------------------------------------------- */
/* Does a pre-crack cross the straight line from a to b? */
int pg_tiles_cut (const pg_tiles *t, const double *a, const double *b)
{
    double x[3], y[3];
    pg_tiles_space (t, a[0], a[1], x), pg_tiles_space (t, b[0], b[1], y);
    return t->cracks && pg_cracks_cut (t->cracks, x, y, 0);
}

/* 1 if point k lies on a crack itself and so belongs to both of its sides; at a crack that is `sided` a point
 * belongs to one side. */
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
 * need the costly test whether a crack lies between a pixel and a point. In 2D a test of the box
 * around the rays excludes most points at once. */
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
    PG_TRY (take_spacing (t));
    PG_TRY (find_cracked (t));
done:
    return status;
}

void pg_tiles_close (pg_tiles *t)
{
    pg_free (t->spacing), pg_free (t->cracked), pg_free (t->gradient);
    pg_family_clear (&t->near);
    t->spacing = t->gradient = NULL, t->cracked = NULL;
}

/* ---- the outline --------------------------------------------------------------------------------------- */
/* 1 if a point x of space lies in a cell of the lattice that belongs to the body; the upper faces
 * of the lattice belong to the last cells. */
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

/* Fills the pixels of a 2D element as a fan of triangles through its nodes in their order
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

/* 1 if the point `at` of the plane lies in the shapes or lattice cells of the outline, or there are none. */
int pg_tiles_inside (const pg_tiles *t, const double *at)
{
    const pg_outline *o = t->outline;
    double x[3];
    if (!o || o->mesh) return 1;
    pg_tiles_space (t, at[0], at[1], x);
    return o->lattice && o->lattice->dim ? in_lattice (o->lattice, x)
                                         : pg_body_inside (o->body, x, 1e-6 * t->widest);
}

/* 1: all pixels of a square are in the body, 0: none is, -1: unknown. The centre decides if it lies inside or
 * outside by more than half of the diagonal (`half`, m); only shapes, not lattices, give that depth. */
static int whole_square (const pg_tiles *t, const double *middle, double half)
{
    const pg_outline *o = t->outline;
    double tolerance = 1e-6 * t->widest, x[3];
    if (o->lattice && o->lattice->dim) return -1;
    pg_tiles_space (t, middle[0], middle[1], x);
    if (!pg_body_inside (o->body, x, tolerance + half)) return 0;
    return pg_body_inside (o->body, x, tolerance - half) ? 1 : -1;
}

/* Empties the pixels whose centre does not lie in the body of shapes or lattice cells, square by square. */
static void keep_inside (const pg_tiles *t, pg_screen *s)
{
    enum { SIDE = 12 };
    int wide = (s->width + SIDE - 1) / SIDE, high = (s->height + SIDE - 1) / SIDE;
    for (int k = 0; k < wide * high; k++) {
        int left = k % wide * SIDE, top = k / wide * SIDE;
        double at[2] = { s->left + (left + 0.5 * SIDE) / s->scale, s->top - (top + 0.5 * SIDE) / s->scale };
        int in = whole_square (t, at, 0.5 * sqrt (2) * SIDE / s->scale);
        for (int j = top; j < top + SIDE && j < s->height; j++)
            for (int i = left; i < left + SIDE && i < s->width; i++) {
                double place[2] = { s->left + (i + 0.5) / s->scale, s->top - (j + 0.5) / s->scale };
                if (!(in < 0 ? pg_tiles_inside (t, place) : in))
                    s->owner[(size_t) j * (size_t) s->width + (size_t) i] = PG_EMPTY;
            }
    }
}

/* Empties the pixels that no element of a 2D mesh covers. */
static pg_status keep_covered (const pg_mesh *mesh, pg_screen *s)
{
    pg_status status = PG_OK;
    pg_screen m = { .left = s->left, .top = s->top, .scale = s->scale };
    PG_TRY (pg_screen_open (&m, s->width, s->height));
    for (size_t e = 0; e < mesh->n; e++) fill_element (mesh, e, &m);
    for (size_t p = 0; p < (size_t) s->width * (size_t) s->height; p++)
        if (m.owner[p] < 0) s->owner[p] = PG_EMPTY;
done:
    pg_screen_close (&m);
    return status;
}

/* ---- owners -------------------------------------------------------------------------------------------- */
/* Offers point k to the pixels within `far` (m): the nearest point owns a pixel, and a point across a
 * pre-crack only where there is no other; a point on a crack is on both sides of it. On a lattice with
 * unequal steps distances are measured in steps, so that a pixel belongs to the cell that it lies in; without
 * an outline, points own no pixels outside of their cells. The cells of displaced points are a little wider,
 * to close gaps that strain opens. s->depth holds the squares of distances. */
static void stamp (const pg_tiles *t, size_t k, double far, pg_screen *s)
{
    const double *at = t->place + 2 * k, ratio = t->loose ? 1 : t->step[0] / t->step[1];
    double middle[2] = { (at[0] - s->left) * s->scale, (s->top - at[1]) * s->scale }, r = far * s->scale;
    double half = t->outline || t->loose ? INFINITY : t->moved ? 0.575 : 0.5 + 1e-6;
    int from[2], to[2], most[2] = { s->width, s->height };
    for (int a = 0; a < 2; a++)
        from[a] = (int) fmin (fmax (floor (middle[a] - r), 0), most[a]),
        to[a] = (int) fmin (fmax (ceil (middle[a] + r), 0), most[a]);
    for (int j = from[1]; j < to[1]; j++)
        for (int i = from[0]; i < to[0]; i++) {
            size_t p = (size_t) j * (size_t) s->width + (size_t) i;
            double place[2] = { s->left + (i + 0.5) / s->scale, s->top - (j + 0.5) / s->scale };
            double dx = place[0] - at[0], dy = (place[1] - at[1]) * ratio, d = dx * dx + dy * dy;
            if (fabs (dx) > half * t->step[0] || fabs (dy) > half * t->step[0]) continue;
            if (d > far * far || d >= s->depth[p]) continue;
            if (t->cracked[k] == NEAR_CRACK && pg_tiles_cut (t, at, place)) d += 1e6 * t->widest * t->widest;
            if (d < s->depth[p]) s->owner[p] = (int) k, s->depth[p] = (float) d;
        }
}

/* Gives pixels that no point has reached to the nearest point. */
static pg_status adopt (const pg_tiles *t, pg_screen *s)
{
    pg_status status = PG_OK;
    pg_nearest *nearest = NULL;
    for (size_t p = 0; p < (size_t) s->width * (size_t) s->height; p++) {
        if (s->owner[p] != UNKNOWN) continue;
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
/* Distance in pixels from every owned pixel to the nearest one without an owner: first in its column, then
 * over the columns beside it, until these are further away than what has been found. */
static pg_status distance_to_nothing (const pg_screen *s, float *f)
{
    pg_status status = PG_OK;
    int w = s->width, h = s->height;
    float *column = NULL;
    PG_ALLOC (column, w * h);
    for (int p = 0; p < w * h; p++)
        column[p] = s->owner[p] < 0 ? 0 : p < w ? (float) (w + h) : column[p - w] + 1;
    for (int p = w * h - w - 1; p >= 0; p--) column[p] = fminf (column[p], column[p + w] + 1);
    for (int p = 0; p < w * h; p++) {
        float best = column[p] * column[p];
        for (int k = 1; (float) k * (float) k < best && k < w; k++)
            for (int side = -k; side <= k; side += 2 * k) {
                if (p % w + side < 0 || p % w + side >= w) continue;
                best = fminf (best, (float) (k * k) + column[p + side] * column[p + side]);
            }
        f[p] = sqrtf (best);
    }
done:
    pg_free (column);
    return status;
}

/* Radius of the discs that close the gaps, in spacings. */
static const double grown = 1.25;
/* Returns how many pixels lie inside an outline that is `rim` spacings outside the outer points; drop 1: the
 * other pixels lose their owner. inward: distances in pixels from distance_to_nothing. */
static double kept (const pg_tiles *t, const pg_screen *s, const float *inward, double rim, int drop)
{
    double n = 0;
    for (size_t p = 0; p < (size_t) s->width * (size_t) s->height; p++) {
        if (s->owner[p] < 0) continue;
        int in = inward[p] >= (grown - rim) * t->spacing[s->owner[p]] * s->scale;
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

pg_status pg_tiles_rest (const pg_tiles *t, pg_screen *s)
{
    pg_status status = PG_OK;
    size_t n = (size_t) s->width * (size_t) s->height;
    const pg_outline *o = t->outline;
    for (size_t p = 0; p < n; p++) s->depth[p] = INFINITY, s->owner[p] = o ? UNKNOWN : PG_EMPTY;
    for (size_t k = 0; k < t->n; k++) {
        /* a cell of a lattice ends within 0.71 spacings; beside a crack the nearest may be further away */
        double reach = !o ? grown : t->loose || t->cracked[k] ? 1.5 : 0.75;
        stamp (t, k, reach * t->spacing[k], s);
    }
    if (!o && t->loose) PG_TRY (close_gaps (t, s));
    else if (o && o->mesh) PG_TRY (keep_covered (o->mesh, s));
    else if (o) keep_inside (t, s);
    if (o) PG_TRY (adopt (t, s));
done:
    for (size_t p = 0; p < n; p++) s->depth[p] = -INFINITY;
    return status;
}
