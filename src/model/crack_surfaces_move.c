/* SPDX-License-Identifier: GPL-3.0-or-later
 * Where the vertices of a front go in a step, which of them are closed, and where the crack cuts behind
 * them. */
#include "crack_surfaces.h"
#include <string.h>

/* A part between closed vertices of so few vertices goes on, at most so many spacings, and is closed, too. */
enum { FEW = 1 };
/* What is seen from an end on the surface is looked at from so far inside, parts of the way to its
 * neighbour. */
#define INSIDE 1e-3
/* A loop that closes in on itself: shorter than so many spacings. */
#define LOOP 5.0

double stride_spacing (const stride *s, size_t i)
{
    return pg_problem_spacing_at (s->p, s->now.x + 3*i);
}

int stride_is_end (const stride *s, size_t i)
{
    return !s->old.closed && (i == 0 || i + 1 == s->old.n);
}

double front_offset_at (const pg_problem *p, const double *x)
{
    return p->tip_offset * pg_problem_spacing_at (p, x) / p->cloud.h;
}

long surfaces_next_id (const pg_crack_surfaces *w)
{
    long id = 1;
    for (size_t f = 0; f < w->nfront; f++) if (w->front[f].id >= id) id = w->front[f].id + 1;
    return id;
}

/* ---- 1: vertices --------------------------------------------------------------------------------------- */
void stride_shut (stride *s, size_t i, unsigned char meets)
{
    s->nshut += !s->shut[i];
    s->shut[i] = 1, s->now.meets[i] = meets;
}

/* Each vertex for itself; ends, which lie on the surface, see nothing ahead of them. */
static void move (stride *s, const double *d, const double *theta)
{
    for (size_t i = 0; i < s->old.n; i++) {
        const double *e = s->old.ahead + 3*i, *n = s->old.normal + 3*i;
        double *way = s->way + 3*i, *x = s->now.x + 3*i, a = theta ? theta[i] : 0, go = d ? d[i] : 0;
        memcpy (way, e, 3 * sizeof *way);
        if (!(go > 0)) continue;
        for (int k = 0; k < 3; k++) {
            way[k] = cos (a) * e[k] + sin (a) * n[k];
            s->now.normal[3*i + (size_t) k] = cos (a) * n[k] - sin (a) * e[k];
        }
        unsigned char meets = PG_MEETS_NOTHING;
        if (stride_is_end (s, i)) shift3 (s->old.x + 3*i, way, go, x);
        else space_way (s->p, s->w, s->number, i, way, go, &meets, x);
        if (meets != PG_MEETS_NOTHING) stride_shut (s, i, meets);
    }
}

/* An end that is closed goes along the surface: its way without what leads away from there, to its
 * neighbour. */
static void along_surface (stride *s, size_t end, size_t beside)
{
    double out[3], *way = s->way + 3*end;
    for (size_t k = 0; k < 3; k++) out[k] = s->old.x[3*end + k] - s->old.x[3*beside + k];
    if (s->old.meets[end] != PG_MEETS_SURFACE || !unit3 (out)) return;
    double inward = fmin (0, dot3 (way, out));
    for (int k = 0; k < 3; k++) way[k] -= inward * out[k];
    unit3 (way);
}

/* The end of a front goes back onto the surface, along the line from its neighbour. */
static void put_back (stride *s, size_t end, size_t beside)
{
    double *x = s->now.x + 3*end, *from = s->now.x + 3*beside, e[3];
    double h = stride_spacing (s, beside), length = apart3 (x, from);
    unsigned char meets;
    if (s->shut[beside]) {                             /* it goes as far as its neighbour */
        int goes = apart3 (x, s->old.x + 3*end) > 0 && s->now.meets[end] == PG_MEETS_SURFACE;
        along_surface (s, end, beside);
        shift3 (s->old.x + 3*end, s->way + 3*end, goes ? apart3 (from, s->old.x + 3*beside) : 0, x);
        stride_shut (s, end, s->now.meets[end]);
        return;
    }
    if (s->old.meets[end] == PG_MEETS_NOTHING || !(length > 0)) return;
    if (apart3 (x, s->old.x + 3*end) == 0 && apart3 (from, s->old.x + 3*beside) == 0) return;
    for (int k = 0; k < 3; k++) e[k] = (x[k] - from[k]) / length;
    double r = space_end (s->p, s->w, from, e, length + 2 * h, &meets);
    if (meets == PG_MEETS_NOTHING) return;
    shift3 (from, e, r, x);
    s->now.meets[end] = meets;
}

/* A loop that shrinks onto a point. */
static void close_loop (stride *s)
{
    double middle[3] = { 0 }, inward = 0;
    if (!s->old.closed) return;
    for (size_t i = 0; i < s->old.n; i++)
        for (size_t k = 0; k < 3; k++) middle[k] += s->now.x[3*i + k] / (double) s->old.n;
    for (size_t i = 0; i < s->old.n; i++)
        for (size_t k = 0; k < 3; k++)
            inward += s->old.ahead[3*i + k] * (middle[k] - s->now.x[3*i + k]);
    if (!(inward > 0 && front_length (&s->now) < LOOP * stride_spacing (s, 0))) return;
    for (size_t i = 0; i < s->old.n; i++) {
        memcpy (s->now.x + 3*i, middle, sizeof middle);
        stride_shut (s, i, PG_MEETS_CRACK);
    }
}

/* The last vertices of a ligament go straight on, as far as the surface is near. */
static void run_out (stride *s, size_t i)
{
    double h = stride_spacing (s, i), from[3];
    unsigned char meets;
    memcpy (from, s->old.x + 3*i, sizeof from);
    if (stride_is_end (s, i)) {                               /* from a little inside of the surface */
        size_t beside = i ? i - 1 : 1;
        along_surface (s, i, beside);
        for (size_t k = 0; k < 3; k++) from[k] += INSIDE * (s->old.x[3*beside + k] - from[k]);
    }
    double r = space_end (s->p, s->w, from, s->way + 3*i, surface_run_out * h, &meets);
    if (meets != PG_MEETS_NOTHING) shift3 (from, s->way + 3*i, r, s->now.x + 3*i);
    stride_shut (s, i, meets);
}

/* Few vertices beside closed ones are closed as well: too short to be a front. */
static void close_short (stride *s)
{
    size_t n = s->old.n;
    for (size_t i = 0; i < n && s->nshut && s->nshut < n; i++) {
        size_t m = 0;
        int before = i ? s->shut[i - 1] : s->old.closed && s->shut[n - 1];
        if (s->shut[i] || !(before || (i == 0 && !s->old.closed))) continue;
        while (m < n && !s->shut[(i + m) % n] && (s->old.closed || i + m < n)) m++;
        int alone = before + (s->old.closed || i + m < n ? 1 : 0);   /* closed vertices beside the part */
        /* ends on the surface are no vertices of their own */
        if (alone > 0 && m <= FEW + (alone < 2)) for (size_t k = 0; k < m; k++) run_out (s, (i + k) % n);
    }
}

/* Vertices of the same front near the place where another part of it has met it. */
static void close_met_here (stride *s)
{
    size_t n = s->old.n;
    for (size_t i = 0; i < n; i++) {
        if (!s->shut[i] || s->now.meets[i] != PG_MEETS_CRACK) continue;
        for (size_t j = 0; j < n; j++) {
            size_t ring = i > j ? i - j : j - i;
            if (s->old.closed && n - ring < ring) ring = n - ring;
            if (s->shut[j] || ring < 4 || dot3 (s->old.ahead + 3*i, s->old.ahead + 3*j) > 0
                || apart3 (s->old.x + 3*j, s->now.x + 3*i) > surface_met * stride_spacing (s, j))
                continue;
            memcpy (s->now.x + 3*j, s->old.x + 3*j, 3 * sizeof *s->now.x);
            stride_shut (s, j, PG_MEETS_CRACK);
        }
    }
}

/* ---- 2: where the crack cuts --------------------------------------------------------------------------- */
/* The place of the old rim nearest to where the crack has cut behind vertex i; NULL: there is none near. */
static const double *rim_at (const stride *s, size_t i, const double *place)
{
    const double *best = NULL;
    double least = 0.3 * stride_spacing (s, i);
    for (size_t r = 0; r < s->old.nrim; r++) {
        const double *x = s->w->vertex + 3 * s->old.rim[r];
        if (apart3 (x, place) <= least) least = apart3 (x, place), best = x;
    }
    return best;
}

/* Beyond a vertex that is closed. */
static double overshoot (const stride *s, size_t i, const double *way)
{
    double h = stride_spacing (s, i), *x = s->now.x + 3*i;
    if (s->now.meets[i] == PG_MEETS_SURFACE) return fmax (s->w->nothing, space_beyond (s->p, x, way));
    return s->now.meets[i] == PG_MEETS_CRACK ? surface_flap * h : s->w->nothing;
}

static void follow (stride *s, size_t i)
{
    const double *from = s->old.x + 3*i, *to = s->now.x + 3*i, *e = s->old.ahead + 3*i;
    double *way = s->way + 3*i, *c = s->c + 3*i, *bend = s->bend + 3*i, behind[3];
    double d = apart3 (from, to), before = s->old.offset[i], o;
    o = fmin (front_offset_at (s->p, to), before + 0.25 * d);
    s->moved[i] = d, s->now.grown[i] += d;
    if (d > 0) for (int k = 0; k < 3; k++) way[k] = (to[k] - from[k]) / d;
    memcpy (s->now.ahead + 3*i, way, 3 * sizeof *way);
    shift3 (from, e, -before, behind);
    if (s->shut[i]) {
        s->now.offset[i] = 0;
        shift3 (to, way, overshoot (s, i, way), c);
        memcpy (bend, from, 3 * sizeof *bend);
        return;
    }
    s->now.offset[i] = o;
    if (d >= o && d > 0) shift3 (to, way, -o, c), memcpy (bend, from, 3 * sizeof *bend);
    else {
        const double *rim = d > 0 ? NULL : rim_at (s, i, behind);
        shift3 (from, e, d > 0 ? d - o : -before, c);
        if (d == 0) s->now.offset[i] = before;
        if (rim) memcpy (c, rim, 3 * sizeof *c);
        memcpy (bend, c, 3 * sizeof *bend);
    }
}

void stride_move (stride *s, const double *d, const double *theta)
{
    size_t n = s->old.n;
    move (s, d, theta);
    if (!s->old.closed && n > 1) put_back (s, 0, 1), put_back (s, n - 1, n - 2);
    close_met_here (s);
    close_loop (s);
    close_short (s);
    for (size_t i = 0; i < n; i++) follow (s, i);
}
