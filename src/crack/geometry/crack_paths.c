/* SPDX-License-Identifier: GPL-3.0-or-later
 * Growing 2D cracks of a state: straight pieces that continue the cracks of the scene, or start with a new
 * crack, up to the tips.
 *
 * A path cuts the bonds that cross it, but only up to a distance o behind an open tip, along the path, as
 * shape functions near a tip let the crack open beyond the cut bonds (pre_crack_tips.c gives o). When the tip
 * advances, the part behind is cut as well. Therefore the part of a crack of the scene that has cut nothing
 * yet must become sided when it grows: it is split off as a separate piece. */
#include "perigal/crack.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

/* Largest offset of a tip, as a fraction of the length of its path. */
#define OFFSET_OF_PATH 0.25

/* ---- walking along a path ------------------------------------------------------------------------------ */
/* Position of a walk along a path: a piece, the end at which it is entered, its length (m); it is left at the
 * other end. */
typedef struct { const pg_crack_paths *w; size_t piece; int end; double length; } walk;

static const double *vertex_of (const pg_crack_paths *w, size_t piece, int end)
{
    return w->cracks.crack[piece].vertex + 2 * end;
}

static double length_of (const pg_crack_paths *w, size_t piece)
{
    const double *a = vertex_of (w, piece, 0);
    return hypot (a[2] - a[0], a[3] - a[1]);
}

static walk walk_from (const pg_crack_paths *w, const pg_tip *t)
{
    return (walk) { w, t->segment, t->end, length_of (w, t->segment) };
}

/* Moves on to piece j if it begins where the present one ends; else returns 0. */
static int walk_onto (walk *at, size_t j)
{
    const double *x = vertex_of (at->w, at->piece, 1 - at->end);
    for (int end = 0; end < 2; end++) {
        /* all pieces of a path have the same direction, except cracks of the scene */
        int e = end ? 1 - at->end : at->end;
        if (j == at->piece || !pg_crack_paths_same (at->w, vertex_of (at->w, j, e), x)) continue;
        *at = (walk) { at->w, j, e, length_of (at->w, j) };
        return 1;
    }
    return 0;
}

/* Moves on to the parent of the piece, else to any piece attached to its end (a path that grows at both ends
 * is followed to the other end). Returns 0: the path ends. */
static int walk_on (walk *at)
{
    const pg_crack_paths *w = at->w;
    size_t from = at->piece, parent = w->parent[from];
    if (parent < w->cracks.n && walk_onto (at, parent)) return 1;
    for (size_t j = 0; j < w->cracks.n; j++)
        if (w->path[j] == w->path[from] && j != parent && walk_onto (at, j)) return 1;
    return 0;
}

void pg_tip_chord (const pg_crack_paths *w, size_t tip, double back, double *from, double *direction)
{
    const pg_tip *t = &w->tip[tip];
    walk at = walk_from (w, t);
    size_t left = w->cracks.n;
    while (back > at.length && --left) {
        double passed = at.length;
        if (!walk_on (&at)) break;
        back -= passed;
    }
    const double *a = vertex_of (w, at.piece, at.end), *b = vertex_of (w, at.piece, 1 - at.end);
    double share = fmin (back / at.length, 1), d[2];
    for (int k = 0; k < 2; k++) from[k] = a[k] + share * (b[k] - a[k]), d[k] = t->x[k] - from[k];
    double size = hypot (d[0], d[1]);
    for (int k = 0; k < 2; k++) direction[k] = d[k] / size;
}

/* Unit vector along the piece, opposite to the walk: towards the tip. */
static void heading (const walk *at, double *e)
{
    const double *a = vertex_of (at->w, at->piece, at->end), *b = vertex_of (at->w, at->piece, 1 - at->end);
    for (int k = 0; k < 2; k++) e[k] = (a[k] - b[k]) / at->length;
}

double pg_tip_straight (const pg_crack_paths *w, size_t tip, double angle)
{
    walk at = walk_from (w, &w->tip[tip]);
    double passed = at.length, e[2], f[2];
    for (size_t left = w->cracks.n; left > 0; left--, passed += at.length) {
        heading (&at, e);
        if (!walk_on (&at)) break;
        heading (&at, f);
        if (fabs (atan2 (e[0] * f[1] - e[1] * f[0], e[0] * f[0] + e[1] * f[1])) > angle) return passed;
    }
    return INFINITY;
}

pg_status pg_tip_vertices (const pg_crack_paths *w, size_t tip, size_t *n, double **x)
{
    static const double turn = 1e-6;                   /* rad: smaller turns are ignored */
    pg_status status = PG_OK;
    walk at = walk_from (w, &w->tip[tip]);
    double e[2], f[2];
    *n = 0, *x = NULL;
    PG_ALLOC (*x, 2 * (w->cracks.n + 1));
    memcpy (*x, vertex_of (w, at.piece, at.end), 2 * sizeof **x);
    for (size_t left = w->cracks.n; left > 0; left--) {
        const double *v = vertex_of (w, at.piece, 1 - at.end);
        heading (&at, e);
        if (*n == 0 || fabs (e[0] * f[1] - e[1] * f[0]) > turn || e[0] * f[0] + e[1] * f[1] < 0) ++*n;
        memcpy (*x + 2 * *n, v, 2 * sizeof **x), memcpy (f, e, sizeof f);
        if (!walk_on (&at)) break;
    }
    ++*n;
done:
    return status;
}

int pg_tip_passes (const pg_crack_paths *w, size_t tip, size_t piece)
{
    walk at = walk_from (w, &w->tip[tip]);
    for (size_t left = w->cracks.n; left > 0; left--) {
        if (at.piece == piece) return 1;
        if (!walk_on (&at)) break;
    }
    return 0;
}

double pg_tip_behind (const pg_crack_paths *w, size_t tip, double limit)
{
    walk at = walk_from (w, &w->tip[tip]);
    double passed = at.length;
    for (size_t left = w->cracks.n; left > 0 && passed < limit && walk_on (&at); left--) passed += at.length;
    return fmin (passed, limit);
}

/* ---- pieces -------------------------------------------------------------------------------------------- */
/* Appends a sided piece (memory must be reserved); returns its index. */
static size_t append (pg_crack_paths *w, const pg_ground *p, const double *from, const double *to,
                      size_t parent, long owner)
{
    size_t k = w->cracks.n++;
    pg_crack *c = &w->cracks.crack[k];
    double *store = w->store + 6*k;
    memset (c, 0, sizeof *c);
    *c = (pg_crack) { .kind = PG_CRACK_SEGMENT, .vertex = store, .nvertex = 2, .retreat = store + 4,
                      .sided = 1, .width = PG_NO_LENGTH * pg_ground_spacing_at (p, to) };
    memcpy (store, from, 2 * sizeof *store), memcpy (store + 2, to, 2 * sizeof *store);
    store[4] = store[5] = 0;
    pg_crack_orient (c);
    w->parent[k] = parent, w->path[k] = parent < k ? w->path[parent] : k, w->owner[k] = owner;
    return k;
}

/* When a crack of the scene begins to grow: splits off the part that has cut no bonds as a sided piece. */
static void split_first (pg_crack_paths *w, const pg_ground *p, pg_tip *t)
{
    pg_crack *c = &w->cracks.crack[t->segment];
    double length = length_of (w, t->segment), *end = c->vertex + 2 * t->end, at[2];
    const double *other = c->vertex + 2 * (1 - t->end);
    if (c->sided || !(c->retreat[t->end] > w->nothing)) return;
    for (int k = 0; k < 2; k++) at[k] = end[k] + c->retreat[t->end] / length * (other[k] - end[k]);
    memcpy (end, at, sizeof at);
    c->retreat[t->end] = 0;
    size_t k = t->end ? append (w, p, at, t->x, t->segment, 0) : append (w, p, t->x, at, t->segment, 0);
    t->segment = k;
}

/* Offset of a tip, m: proportional to the local spacing, at most OFFSET_OF_PATH of the path's length. slides:
 * 1: the faces are in contact and slide. */
static double offset_at (const pg_crack_paths *w, const pg_ground *p, size_t tip, int slides)
{
    double o = (slides ? p->closed_tip_offset : p->tip_offset)
               * pg_ground_spacing_at (p, w->tip[tip].x) / p->cloud->h;
    return fmin (o, OFFSET_OF_PATH * pg_tip_behind (w, tip, o / OFFSET_OF_PATH));
}

/* Sets the retreats of pieces so that the path cuts no bonds within `offset` (m) behind its tip (negative:
 * cuts beyond it). Pieces up to `far` (m) behind the tip are updated and marked. */
static void set_retreats (pg_crack_paths *w, const pg_tip *t, double offset, double far,
                          unsigned char *changed)
{
    walk at = walk_from (w, t);
    double passed = 0;
    for (size_t left = w->cracks.n; left > 0; left--) {
        double rest = offset - passed, *retreat = &w->cracks.crack[at.piece].retreat[at.end];
        /* a piece that lies wholly within the offset cuts nothing at all */
        *retreat = passed == 0 && rest < 0 ? rest : rest >= at.length ? 2 * at.length : fmax (rest, 0);
        changed[at.piece] = 1;
        passed += at.length;
        if (passed > far || !w->cracks.crack[at.piece].sided || !walk_on (&at)) break;
    }
}

/* ---- growing ------------------------------------------------------------------------------------------- */
/* Moves the tip to `to` by appending a facet. */
static void move (pg_crack_paths *w, const pg_ground *p, pg_tip *t, const double *to, double length)
{
    t->segment = t->end ? append (w, p, t->x, to, t->segment, t->id)
                        : append (w, p, to, t->x, t->segment, t->id);
    t->x[0] = to[0], t->x[1] = to[1];
    t->grown += length, w->length += length;
}

/* Closes a tip: its path then cuts to its end, and slightly beyond, so that no bonds are missed by
 * rounding. */
static void close_tip (pg_crack_paths *w, const pg_ground *p, size_t tip, unsigned char *changed)
{
    pg_tip *t = &w->tip[tip];
    walk at = walk_from (w, t);
    double e[2], before = t->offset;
    heading (&at, e);
    t->open = 0, t->offset = 0;
    set_retreats (w, t, -fmax (w->nothing, pg_ground_beyond (p, t->x, e)), before + w->nothing, changed);
}

/* Closes tips of other paths whose uncut part contains the end of this tip. */
static void close_met (pg_crack_paths *w, const pg_ground *p, size_t tip, unsigned char *changed)
{
    const pg_tip *own = &w->tip[tip];
    for (size_t i = 0; i < w->ntip; i++) {
        pg_tip *t = &w->tip[i];
        if (i == tip || !t->open || hypot (t->x[0] - own->x[0], t->x[1] - own->x[1]) > t->offset + w->nothing)
            continue;
        split_first (w, p, t);
        close_tip (w, p, i, changed);
    }
}

pg_status pg_paths_grow (pg_crack_paths *w, const pg_ground *p, size_t tip, const double *to, int close,
                      unsigned char *changed)
{
    pg_status status = PG_OK;
    if (tip >= w->ntip || !w->tip[tip].open) PG_FAIL (PG_E_USAGE, "there is no open tip %zu", tip + 1);
    pg_tip *t = &w->tip[tip];
    double length = hypot (to[0] - t->x[0], to[1] - t->x[1]), before = t->offset;
    if (!(length > w->nothing) && !close) PG_FAIL (PG_E_USAGE, "a crack cannot grow by %g m", length);
    split_first (w, p, t);
    if (length > w->nothing) move (w, p, t, to, length);
    if (close) {
        t->offset = length + before;
        close_tip (w, p, tip, changed);
        close_met (w, p, tip, changed);
    } else {
        t->offset = offset_at (w, p, tip, 0);
        set_retreats (w, t, t->offset, length + before + t->offset, changed);
    }
done:
    return status;
}

/* Adds a tip at end `at` of a new crack, piece k. */
static void add_tip (pg_crack_paths *w, size_t k, int at)
{
    const double *x = vertex_of (w, k, at);
    long id = 1;
    for (size_t i = 0; i < w->ntip; i++) if (w->tip[i].id >= id) id = w->tip[i].id + 1;
    w->tip[w->ntip++] = (pg_tip) { .id = id, .segment = k, .end = at, .open = 1, .x = { x[0], x[1] } };
}

pg_status pg_paths_start (pg_crack_paths *w, const pg_ground *p, const double *from, const double *to,
                          int open, unsigned char *changed)
{
    pg_status status = PG_OK;
    double length = hypot (to[0] - from[0], to[1] - from[1]);
    if (!(length > w->nothing)) PG_FAIL (PG_E_USAGE, "a crack cannot begin with %g m", length);
    size_t k = append (w, p, from, to, SIZE_MAX, 0);
    w->length += length, changed[k] = 1;
    for (int at = 0; at < 2; at++) {
        double e[2] = { at ? to[0] - from[0] : from[0] - to[0], at ? to[1] - from[1] : from[1] - to[1] };
        double *retreat = &w->cracks.crack[k].retreat[at];
        if (open & 1 << at) {
            add_tip (w, k, at);
            pg_tip *t = &w->tip[w->ntip - 1];
            *retreat = t->offset = offset_at (w, p, w->ntip - 1, open & PG_START_SLIDES);
        } else {
            for (int m = 0; m < 2; m++) e[m] /= length;
            *retreat = -fmax (w->nothing, pg_ground_beyond (p, vertex_of (w, k, at), e));
        }
    }
done:
    return status;
}

/* Increases the offset of a tip that has not grown. The index remains valid, as the crack cuts less. */
int pg_paths_draw_back (pg_crack_paths *w, size_t tip, double offset)
{
    pg_tip *t = &w->tip[tip];
    offset = fmin (offset, OFFSET_OF_PATH * pg_tip_behind (w, tip, offset / OFFSET_OF_PATH));
    double *retreat = &w->cracks.crack[t->segment].retreat[t->end];
    if (t->grown > 0 || !t->open || !(offset > *retreat)) return 0;
    *retreat = t->offset = offset;
    return 1;
}
