/* SPDX-License-Identifier: GPL-3.0-or-later
 * Motion of the vertices of a front in a step, closed vertices, and the edge of the cutting part behind
 * them. */
#include "crack_surfaces.h"
#include <string.h>

/* A part of at most so many vertices between closed ones advances to the surface and is closed, too. */
enum { FEW = 1 };
/* Rays from an end on the surface start this far inside, as a fraction of the distance to its neighbour. */
#define INSIDE 1e-3
/* A shrinking loop shorter than this is closed, spacings. */
#define LOOP 5.0

/* Range of the search for the surface beside the end of a front, from its neighbour, spacings. */
#define FOOT 8.0

double stride_spacing (const stride *s, size_t i)
{
    return pg_ground_spacing_at (s->p, s->now.x + 3*i);
}

int stride_is_end (const stride *s, size_t i)
{
    return !s->old.closed && (i == 0 || i + 1 == s->old.n);
}

double front_offset_at (const pg_ground *p, const double *x)
{
    return p->tip_offset * pg_ground_spacing_at (p, x) / p->cloud->h;
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

/* Moves each vertex separately; ends, which lie on the surface, are not tested for obstacles. */
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
        if (stride_is_end (s, i)) pg_shift3 (s->old.x + 3*i, way, go, x);
        else space_way (s->p, s->w, s->number, i, way, go, &meets, x);
        if (meets != PG_MEETS_NOTHING) stride_shut (s, i, meets);
    }
}

/* Finds the surface beside the end of a front: foot: its point nearest to the end's neighbour at `from` (m),
 * in the plane of its direction of motion and the tangent; along: direction of the surface in that plane,
 * forward. Returns 0: not found. */
static int surface_beside (const stride *s, size_t end, size_t beside, const double *from, const double *e,
                           const double *n, double *foot, double *along)
{
    double t[3], out[3], h = stride_spacing (s, beside);
    pg_cross3 (e, n, t);
    for (int k = 0; k < 3; k++)
        out[k] = s->old.x[3*end + (size_t) k] - s->old.x[3*beside + (size_t) k];
    if (!pg_unit3 (t)) return 0;
    if (pg_dot3 (t, out) < 0) for (int k = 0; k < 3; k++) t[k] = -t[k];
    if (!space_foot (s->p, from, t, e, FOOT * h, foot, along)) return 0;
    if (pg_dot3 (along, e) < 0) for (int k = 0; k < 3; k++) along[k] = -along[k];
    return 1;
}

/* Makes the direction of motion of a closed end parallel to the surface; if that is not found, removes its
 * component towards the neighbour. */
static void along_surface (stride *s, size_t end, size_t beside)
{
    double foot[3], along[3], out[3], *way = s->way + 3*end;
    const double *from = s->old.x + 3*beside;
    for (size_t k = 0; k < 3; k++) out[k] = s->old.x[3*end + k] - from[k];
    if (s->old.meets[end] != PG_MEETS_SURFACE || !pg_unit3 (out)) return;
    if (surface_beside (s, end, beside, from, s->old.ahead + 3*beside, s->old.normal + 3*beside, foot,
                        along)) {
        double side = pg_dot3 (along, way) < 0 ? -1 : 1;
        for (int k = 0; k < 3; k++) way[k] = side * along[k];
        return;
    }
    double inward = fmin (0, pg_dot3 (way, out));
    for (int k = 0; k < 3; k++) way[k] -= inward * out[k];
    pg_unit3 (way);
}

/* Moves the end of a front on the surface towards the point of the surface nearest to its neighbour in the
 * plane of the crack: a front meets a free surface about at a right angle, and its own slope over less than a
 * spacing is noise. It never moves backwards, and at most by 2 go (m). Returns 0: no such point. */
static int towards_foot (const stride *s, size_t end, size_t beside, double go, double *x)
{
    const double *was = s->old.x + 3*end;
    double foot[3], along[3], m[3];
    if (!surface_beside (s, end, beside, s->now.x + 3*beside, s->way + 3*beside, s->now.normal + 3*beside,
                         foot, along)) return 0;
    for (int k = 0; k < 3; k++) m[k] = foot[k] - was[k];
    double forward = pg_dot3 (m, along), share = forward > 0 ? fmin (1, 2 * go / forward) : 0;
    pg_shift3 (was, m, share, x);
    return 1;
}

/* Puts the end of a front back onto the surface, along the line from its neighbour. */
static void put_back (stride *s, size_t end, size_t beside)
{
    double *x = s->now.x + 3*end, *from = s->now.x + 3*beside, e[3];
    double h = stride_spacing (s, beside), own = pg_distance3 (x, s->old.x + 3*end),
           other = pg_distance3 (from, s->old.x + 3*beside);
    unsigned char meets;
    if (s->shut[beside]) {  /* the neighbour is closed: the end moves as far as the neighbour */
        int goes = own > 0 && s->now.meets[end] == PG_MEETS_SURFACE;
        along_surface (s, end, beside);
        pg_shift3 (s->old.x + 3*end, s->way + 3*end, goes ? other : 0, x);
        stride_shut (s, end, s->now.meets[end]);
        return;
    }
    if (s->old.meets[end] == PG_MEETS_NOTHING || (own == 0 && other == 0)) return;
    if (s->old.meets[end] == PG_MEETS_SURFACE) towards_foot (s, end, beside, fmax (own, other), x);
    for (int k = 0; k < 3; k++) e[k] = x[k] - from[k];
    double length = pg_size3 (e);
    if (!pg_unit3 (e)) return;
    double r = space_end (s->p, s->w, from, e, length + 2 * h, &meets);
    if (meets == PG_MEETS_NOTHING) return;
    pg_shift3 (from, e, r, x);
    s->now.meets[end] = meets;
}

/* Position k of a run of m vertices from `first` on; cyclic in a loop; beyond the ends of an open run by
 * point reflection, which preserves straight lines. */
static void run_place (const double *x, size_t n, size_t first, size_t m, int loop, long k, double *out)
{
    long last = (long) m - 1, inside = loop ? k : k < 0 ? -k : k > last ? 2 * last - k : k;
    const double *at = x + 3 * ((first + n + (size_t) (inside + (long) n)) % n);
    memcpy (out, at, 3 * sizeof *out);
    if (loop || inside == k) return;
    const double *end = x + 3 * ((first + (size_t) (k < 0 ? 0 : last)) % n);
    for (int c = 0; c < 3; c++) out[c] = 2 * end[c] - out[c];
}

/* Smooths a run of the moved front: removes waves of a length of two vertices, and keeps longer ones: a
 * sixteenth of the fourth difference, x - delta^4 x / 16, keeps 1 - sin^4 (pi h / L) of a wave of length L
 * (Shapiro 1970). Only normal to the crack surface, and by at most half of the distance that a vertex moved.
 * Integrals over hats of three vertices do not detect such waves, which kinking would amplify. */
static pg_status fair_run (stride *s, size_t first, size_t m, int loop)
{
    pg_status status = PG_OK;
    size_t n = s->old.n;
    double *old = NULL;
    if (m < 4) return PG_OK;
    PG_ALLOC (old, 3 * n);
    memcpy (old, s->now.x, 3 * n * sizeof *old);
    for (size_t k = loop ? 0 : 1; k + !loop < m; k++) {
        size_t i = (first + k) % n;
        double at[5][3], shift[3], t[3], e[3], out[3], d = pg_distance3 (old + 3*i, s->old.x + 3*i);
        for (long j = 0; j < 5; j++) run_place (old, n, first, m, loop, (long) k + j - 2, at[j]);
        for (int c = 0; c < 3; c++) {
            shift[c] = -(at[0][c] - 4 * at[1][c] + 6 * at[2][c] - 4 * at[3][c] + at[4][c]) / 16;
            t[c] = at[3][c] - at[1][c];
        }
        if (!pg_unit3 (t) || !(d > 0)) continue;
        for (int c = 0; c < 3; c++) e[c] = old[3*i + (size_t) c] - s->old.x[3*i + (size_t) c];
        pg_cross3 (t, e, out);
        if (!pg_unit3 (out)) continue;
        double off = pg_dot3 (shift, out);
        for (int c = 0; c < 3; c++) shift[c] = off * out[c];
        double size = pg_size3 (shift), share = fmin (1, d / stride_spacing (s, i));
        if (size > 0) pg_shift3 (old + 3*i, shift, share * fmin (1, 0.5 * d / size), s->now.x + 3*i);
    }
done:
    pg_free (old);
    return status;
}

/* Smooths all runs between closed vertices. */
static pg_status fair (stride *s)
{
    pg_status status = PG_OK;
    size_t n = s->old.n;
    if (s->old.closed && s->nshut == 0) return fair_run (s, 0, n, 1);
    for (size_t i = 0; i < n; i++) {
        size_t m = 0;
        int begins = !s->shut[i] && (i ? s->shut[i - 1] : !s->old.closed || s->shut[n - 1]);
        while (begins && m < n && !s->shut[(i + m) % n] && (s->old.closed || i + m < n)) m++;
        if (m) PG_TRY (fair_run (s, i, m, 0));
    }
done:
    return status;
}

/* Closes a loop that has shrunk to a small size at its centre. */
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

/* Moves a last vertex of a ligament straight on to the surface, if that is near, and closes it. */
static void run_out (stride *s, size_t i)
{
    double h = stride_spacing (s, i), from[3];
    unsigned char meets;
    memcpy (from, s->old.x + 3*i, sizeof from);
    if (stride_is_end (s, i)) {                               /* starts slightly inside the surface */
        size_t beside = i ? i - 1 : 1;
        along_surface (s, i, beside);
        for (size_t k = 0; k < 3; k++) from[k] += INSIDE * (s->old.x[3*beside + k] - from[k]);
    }
    double r = space_end (s->p, s->w, from, s->way + 3*i, surface_run_out * h, &meets);
    if (meets != PG_MEETS_NOTHING) pg_shift3 (from, s->way + 3*i, r, s->now.x + 3*i);
    stride_shut (s, i, meets);
}

/* Closes parts between closed vertices that have too few vertices for a front. */
static void close_short (stride *s)
{
    size_t n = s->old.n;
    for (size_t i = 0; i < n && s->nshut && s->nshut < n; i++) {
        size_t m = 0;
        int before = i ? s->shut[i - 1] : s->old.closed && s->shut[n - 1];
        if (s->shut[i] || !(before || (i == 0 && !s->old.closed))) continue;
        while (m < n && !s->shut[(i + m) % n] && (s->old.closed || i + m < n)) m++;
        int alone = before + (s->old.closed || i + m < n ? 1 : 0);  /* number of sides with a closed vertex */
        /* a part with an end on the surface may have one vertex more */
        if (alone > 0 && m <= FEW + (alone < 2)) for (size_t k = 0; k < m; k++) run_out (s, (i + k) % n);
    }
}

/* Closes vertices of the same front near a point where another part of it has met it. */
static void close_met_here (stride *s)
{
    size_t n = s->old.n;
    for (size_t i = 0; i < n; i++) {
        if (!s->shut[i] || s->now.meets[i] != PG_MEETS_CRACK) continue;
        for (size_t j = 0; j < n; j++) {
            size_t ring = i > j ? i - j : j - i;
            if (s->old.closed && n - ring < ring) ring = n - ring;
            if (s->shut[j] || ring < 4 || pg_dot3 (s->old.ahead + 3*i, s->old.ahead + 3*j) > 0
                || pg_distance3 (s->old.x + 3*j, s->now.x + 3*i) > surface_met * stride_spacing (s, j))
                continue;
            memcpy (s->now.x + 3*j, s->old.x + 3*j, 3 * sizeof *s->now.x);
            stride_shut (s, j, PG_MEETS_CRACK);
        }
    }
}

/* ---- 2: edge of the cutting part ----------------------------------------------------------------------- */
/* Vertex of the old rim nearest to `place`, within 0.3 spacings; NULL: none. */
static const double *rim_at (const stride *s, size_t i, const double *place)
{
    const double *best = NULL;
    double least = 0.3 * stride_spacing (s, i);
    for (size_t r = 0; r < s->old.nrim; r++) {
        const double *x = s->w->vertex + 3 * s->old.rim[r];
        if (pg_distance3 (x, place) <= least) least = pg_distance3 (x, place), best = x;
    }
    return best;
}

/* Distance by which the crack cuts beyond a closed vertex, m. */
static double overshoot (const stride *s, size_t i, const double *way)
{
    double h = stride_spacing (s, i), *x = s->now.x + 3*i;
    if (s->now.meets[i] == PG_MEETS_SURFACE) return fmax (s->w->nothing, pg_ground_beyond (s->p, x, way));
    return s->now.meets[i] == PG_MEETS_CRACK ? surface_flap * h : s->w->nothing;
}

static void follow (stride *s, size_t i)
{
    const double *from = s->old.x + 3*i, *to = s->now.x + 3*i, *e = s->old.ahead + 3*i;
    double *way = s->way + 3*i, *c = s->c + 3*i, *bend = s->bend + 3*i, behind[3];
    double d = pg_distance3 (from, to), before = s->old.offset[i], o;
    if (d <= s->w->nothing) d = 0;                     /* motion by rounding only, of an end put back */
    o = fmin (front_offset_at (s->p, to), before + 0.25 * d);
    s->moved[i] = d, s->now.grown[i] += d;
    if (d > 0) for (int k = 0; k < 3; k++) way[k] = (to[k] - from[k]) / d;
    memcpy (s->now.ahead + 3*i, way, 3 * sizeof *way);
    pg_shift3 (from, e, -before, behind);
    if (s->shut[i]) {
        s->now.offset[i] = 0;
        pg_shift3 (to, way, overshoot (s, i, way), c);
        memcpy (bend, from, 3 * sizeof *bend);
        return;
    }
    s->now.offset[i] = o;
    if (d >= o && d > 0) pg_shift3 (to, way, -o, c), memcpy (bend, from, 3 * sizeof *bend);
    else {
        const double *rim = d > 0 ? NULL : rim_at (s, i, behind);
        pg_shift3 (from, e, d > 0 ? d - o : -before, c);
        if (d == 0) s->now.offset[i] = before;
        if (rim) memcpy (c, rim, 3 * sizeof *c);
        memcpy (bend, c, 3 * sizeof *bend);
    }
}

pg_status stride_move (stride *s, const double *d, const double *theta)
{
    pg_status status = PG_OK;
    size_t n = s->old.n;
    move (s, d, theta);
    PG_TRY (fair (s));
    if (!s->old.closed && n > 1) put_back (s, 0, 1), put_back (s, n - 1, n - 2);
    close_met_here (s);
    close_loop (s);
    close_short (s);
    for (size_t i = 0; i < n; i++) follow (s, i);
done:
    return status;
}
