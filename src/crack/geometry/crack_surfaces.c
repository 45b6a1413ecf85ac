/* SPDX-License-Identifier: GPL-3.0-or-later
 * Surfaces of growing 3D cracks: triangles from the initial edge of the cutting part of a crack to the
 * present one, a distance o behind its fronts. A step of a front (doc/method.md, "Surfaces that grow"):
 *
 *   1 every vertex moves by d in its direction, or to an obstacle it meets; ends return to the surface;
 *   2 the edge of the cutting part follows each vertex at the distance o, along its path;
 *   3 vertices that met something are closed: the crack cuts to their end there, on the surface a spacing
 *     further; the parts between closed vertices become the new fronts, with vertices redistributed;
 *   4 triangles are added between the old and the new edge of the surface, bent at the old front
 *     where the crack kinks.
 *
 * A step that fails leaves the surfaces in an undefined state (crack_bonds.c works on a copy). */
#include "crack_surfaces.h"
#include <stdint.h>
#include <string.h>

/* Overlap of the first triangles with the part of the crack of the scene that cuts, spacings. */
#define OVERLAP 0.1
/* Smaller bends of the surface at the old front are neglected, spacings. */
#define BEND 0.01
/* Cosine of the angle between directions of two vertices above which they meet the same face of the body. */
#define SAME_FACE 0.9

/* Returns 1: the surface bends at the old front. */
static int bends (const stride *s)
{
    for (size_t i = 0; i < s->old.n; i++) {
        double behind[3], u[3], v[3], n[3], depth = s->old.offset[i];
        pg_shift3 (s->old.x + 3*i, s->old.ahead + 3*i, s->old.nrim ? -depth : -2 * depth, behind);
        for (int k = 0; k < 3; k++)
            u[k] = s->bend[3*i + (size_t) k] - behind[k], v[k] = s->c[3*i + (size_t) k] - behind[k];
        pg_cross3 (u, v, n);
        if (pg_size3 (v) > 0 && pg_size3 (n) > BEND * stride_spacing (s, i) * pg_size3 (v)) return 1;
    }
    return 0;
}

/* Area swept by the front, m^2 (inside the body, as ends are on its surface): for each pair of vertices the
 * mean of both triangulations of the quadrilateral. */
static double swept (const stride *s)
{
    double area = 0;
    for (size_t i = 0; i + !s->old.closed < s->old.n; i++) {
        size_t j = (i + 1) % s->old.n;
        const double *a = s->old.x + 3*i, *b = s->old.x + 3*j, *c = s->now.x + 3*i, *d = s->now.x + 3*j;
        area += 0.5 * (triangle_area3 (a, b, c) + triangle_area3 (b, d, c)
                       + triangle_area3 (a, d, c) + triangle_area3 (a, b, d));
    }
    return area;
}

/* ---- 3, 4: lines and triangles ------------------------------------------------------------------------- */
static pg_status begin_line (stride *s)
{
    pg_status status = PG_OK;
    s->nline = 0;
    PG_GROW (s->line, s->line_capacity, 8);
done:
    return status;
}

pg_status stride_to_line (stride *s, const double *x, const double *normal)
{
    pg_status status = PG_OK;
    size_t v = SIZE_MAX;
    for (size_t r = 0; r < s->old.nrim && v == SIZE_MAX; r++)
        if (pg_distance3 (s->w->vertex + 3 * s->old.rim[r], x) <= s->w->nothing) v = s->old.rim[r];
    if (v == SIZE_MAX) {
        PG_TRY (surfaces_reserve (s->w, s->w->cracks.n, s->w->nvertex + 1));
        v = surfaces_put_vertex (s->w, x);
    }
    PG_GROW (s->line, s->line_capacity, s->nline + 1);
    PG_GROW (s->side, s->side_capacity, 3 * (s->nline + 1));
    s->line[s->nline] = v;
    memcpy (s->side + 3 * s->nline++, normal, 3 * sizeof *normal);
done:
    return status;
}

pg_status stride_beyond_end (stride *s, unsigned char meets, const double *end, const double *beside,
                             const double *normal)
{
    pg_status status = PG_OK;
    double e[3], out[3], h = pg_ground_spacing_at (s->p, end);
    for (int k = 0; k < 3; k++) e[k] = end[k] - beside[k];
    if (meets == PG_MEETS_NOTHING || !pg_unit3 (e)) return PG_OK;
    double a = meets == PG_MEETS_SURFACE ? pg_ground_way_out (s->p, end, e, h) : surface_flap * h;
    pg_shift3 (end, e, a, out);
    if (meets == PG_MEETS_SURFACE && a < h) pg_shift3 (end, e, a + pg_ground_beyond (s->p, out, e), out);
    PG_TRY (stride_to_line (s, out, normal));
done:
    return status;
}

/* Adds positions c of the vertices of a front, from index `first` on, to the line, extended beyond its ends
 * if starts, stops. */
static pg_status line_of (stride *s, const pg_front *f, const double *c, size_t first, int starts, int stops)
{
    pg_status status = PG_OK;
    size_t n = f->n, last = 3 * (n - 1);
    if (starts) PG_TRY (stride_beyond_end (s, f->meets[0], c, c + 3, f->normal));
    for (size_t i = first; i < n; i++) PG_TRY (stride_to_line (s, c + 3*i, f->normal + 3*i));
    if (stops)
        PG_TRY (stride_beyond_end (s, f->meets[n - 1], c + last, c + last - 3, f->normal + last));
done:
    return status;
}

/* Makes the line the rim of the old front, from which the next triangles start. */
static pg_status take_as_rim (stride *s)
{
    pg_status status = PG_OK;
    pg_front *f = &s->old;
    PG_GROW (f->rim, f->rim_capacity, s->nline);
    if (s->nline) memcpy (f->rim, s->line, s->nline * sizeof *f->rim);
    f->nrim = s->nline;
done:
    return status;
}

/* Adds triangles from the rim to the line, which becomes the new rim. */
static pg_status tile (stride *s)
{
    pg_status status = PG_OK;
    surface_line from = { s->old.nrim, s->old.rim, NULL, s->old.closed },
                 to = { s->nline, s->line, s->side, s->old.closed };
    PG_TRY (surfaces_zip (s->w, s->p, &from, &to, s->old.id));
    PG_TRY (take_as_rim (s));
done:
    return status;
}

/* Makes the first rim of a crack of the scene that begins to grow: behind its front, overlapping the part
 * that cuts; at corners along the bisector. */
static pg_status first_rim (stride *s)
{
    pg_status status = PG_OK;
    double *c = NULL;
    if (s->old.nrim) return PG_OK;
    PG_ALLOC (c, 3 * s->old.n);
    for (size_t i = 0; i < s->old.n; i++)
        pg_shift3 (s->old.x + 3*i, s->old.ahead + 3*i,
                   -2 * s->old.offset[i] - OVERLAP * stride_spacing (s, i),
               c + 3*i);
    PG_TRY (begin_line (s));
    PG_TRY (line_of (s, &s->old, c, 0, !s->old.closed, !s->old.closed));
    PG_TRY (take_as_rim (s));
done:
    pg_free (c);
    return status;
}

/* Makes a separate front of vertices first .. first + m - 1 (cyclic in a loop). */
static pg_status part_of (stride *s, size_t first, size_t m, pg_front *out, double **c)
{
    pg_status status = PG_OK;
    const pg_front *f = &s->now;
    PG_TRY (pg_front_reserve (out, m));
    PG_ALLOC (*c, 3 * m);
    out->id = f->id, out->of = f->of, out->open = 1, out->n = m, out->closed = f->closed && s->nshut == 0;
    for (size_t k = 0; k < m; k++) {
        size_t i = (first + k) % f->n;
        memcpy (out->x + 3*k, f->x + 3*i, 3 * sizeof *out->x);
        memcpy (out->normal + 3*k, f->normal + 3*i, 3 * sizeof *out->x);
        memcpy (out->ahead + 3*k, f->ahead + 3*i, 3 * sizeof *out->x);
        memcpy (*c + 3*k, s->c + 3*i, 3 * sizeof *out->x);
        out->offset[k] = s->shut[i] ? front_offset_at (s->p, f->x + 3*i) : f->offset[i];
        out->grown[k] = f->grown[i], out->meets[k] = f->meets[i];
    }
    PG_TRY (front_resample (out, s->p, c));
    front_frames (out);
done:
    return status;
}

pg_status stride_lay (stride *s, pg_front *f, const double *c, int shared, int starts, int stops)
{
    pg_status status = PG_OK;
    size_t first = s->nline - (size_t) shared;
    PG_TRY (line_of (s, f, c, (size_t) shared, starts, stops));
    f->nrim = s->nline - first;
    PG_GROW (f->rim, f->rim_capacity, f->nrim);
    memcpy (f->rim, s->line + first, f->nrim * sizeof *f->rim);
done:
    return status;
}

/* Stores a remaining part: the first one replaces the old front, further ones are appended as new fronts. */
static pg_status settle (stride *s, pg_front *part, size_t *parts)
{
    pg_status status = PG_OK;
    pg_crack_surfaces *w = s->w;
    size_t to = s->number;
    if ((*parts)++ > 0) {
        PG_TRY (surfaces_reserve_fronts (w, w->nfront + 1));
        part->id = surfaces_next_id (w);
        to = w->nfront++;
    }
    pg_front_clear (&w->front[to]);
    w->front[to] = *part;
    *part = (pg_front) { 0 };
done:
    return status;
}

/* Between two closed vertices on different faces of the body lies an edge or corner of the body that a
 * straight line would not cut: adds a vertex beyond it, and the area to the swept area. */
static pg_status around_edge (stride *s, size_t i, size_t j)
{
    pg_status status = PG_OK;
    double middle[3], way[3], out[3], h = stride_spacing (s, i);
    const double *a = s->way + 3*i, *b = s->way + 3*j, *x = s->now.x + 3*i, *y = s->now.x + 3*j;
    if (s->now.meets[i] != PG_MEETS_SURFACE || s->now.meets[j] != PG_MEETS_SURFACE
        || pg_dot3 (a, b) > SAME_FACE)
        return PG_OK;
    for (int k = 0; k < 3; k++) middle[k] = 0.5 * (x[k] + y[k]), way[k] = a[k] + b[k];
    if (!pg_unit3 (way) || !pg_ground_has_body (s->p, middle)) return PG_OK;
    double r = pg_ground_way_out (s->p, middle, way, surface_run_out * h);
    pg_shift3 (middle, way, r, out);
    s->w->area += triangle_area3 (x, out, y);
    pg_shift3 (out, way, pg_ground_beyond (s->p, out, way), out);
    PG_TRY (stride_to_line (s, out, s->now.normal + 3*i));
done:
    return status;
}

/* Makes the new fronts between closed vertices, and the new line through all vertices. */
static pg_status divide (stride *s)
{
    pg_status status = PG_OK;
    pg_front part = { 0 };
    double *c = NULL;
    size_t n = s->old.n, begin = 0, parts = 0;
    int loop = s->old.closed;
    PG_TRY (begin_line (s));
    if (s->nshut == 0) {
        PG_TRY (part_of (s, 0, n, &part, &c));
        PG_TRY (stride_lay (s, &part, c, 0, !loop, !loop));
        PG_TRY (settle (s, &part, &parts));
        goto done;
    }
    /* a loop starts at a closed vertex preceded by an open one, so that neighbouring closed vertices stay
     * together */
    while (loop && begin < n && !(s->shut[begin] && !s->shut[(begin + n - 1) % n])) begin++;
    if (begin == n) begin = 0;
    size_t steps = n + (size_t) loop;                  /* in a loop the first vertex is also the last */
    for (size_t k = 0; k < steps; ) {
        size_t i = (begin + k) % n, m = 0;
        int left = k > 0;  /* 1: the part begins with a closed vertex already in the line */
        if (s->shut[i] && k > 0 && s->shut[(i + n - 1) % n]) PG_TRY (around_edge (s, (i + n - 1) % n, i));
        if (s->shut[i] && !(loop && k == n)) {
            int last = !loop && k + 1 == n;
            const double *normal = s->now.normal + 3*i, *at = s->c + 3*i;
            if (k == 0 && !loop) PG_TRY (stride_beyond_end (s, s->now.meets[0], at, s->c + 3, normal));
            PG_TRY (stride_to_line (s, at, normal));
            if (last) PG_TRY (stride_beyond_end (s, s->now.meets[i], at, s->c + 3 * (i - 1), normal));
        }
        if (s->shut[i]) { k++; continue; }
        while (k + m < steps && !s->shut[(begin + k + m) % n]) m++;
        int right = k + m < steps;
        PG_TRY (part_of (s, (i + n - (size_t) left) % n, m + (size_t) left + (size_t) right, &part, &c));
        PG_TRY (stride_lay (s, &part, c, left, !left, !right));
        PG_TRY (settle (s, &part, &parts));
        pg_free (c), c = NULL;
        k += m + (size_t) right;  /* the closed vertex on the right is already in the line */
    }
    if (parts == 0) s->w->front[s->number].open = 0, s->w->front[s->number].nrim = 0;
    /* the last part of a loop repeats the first vertex of the line; duplicates would break the mirror
     * symmetry of triangles */
    if (loop && s->nline > 1
        && pg_distance3 (s->w->vertex + 3 * s->line[0], s->w->vertex + 3 * s->line[s->nline - 1])
               <= s->w->nothing)
        s->nline--;
done:
    pg_front_clear (&part);
    pg_free (c);
    return status;
}

/* ---- a step -------------------------------------------------------------------------------------------- */
static void clear_stride (stride *s)
{
    pg_front_clear (&s->old), pg_front_clear (&s->now);
    pg_free (s->c), pg_free (s->bend), pg_free (s->way), pg_free (s->moved), pg_free (s->shut);
    pg_free (s->line), pg_free (s->side);
}

static pg_status begin_stride (stride *s, pg_crack_surfaces *w, const pg_ground *p, size_t front)
{
    pg_status status = PG_OK;
    size_t n = w->front[front].n;
    s->w = w, s->p = p, s->number = front;
    PG_TRY (pg_front_copy (&s->old, &w->front[front]));
    PG_TRY (pg_front_copy (&s->now, &s->old));
    PG_ALLOC (s->c, 3 * n);
    PG_ALLOC (s->bend, 3 * n);
    PG_ALLOC (s->way, 3 * n);
    PG_ALLOC (s->moved, n);
    PG_ALLOC (s->shut, n);
done:
    return status;
}

/* Code of a vertex that ends where it is: END_OF + PG_MEETS_...; 0: it does not end. */
enum { END_OF = 1 };

/* Step of one front. ends: codes END_OF of vertices that end where they are, or NULL. met: codes of vertices
 * of all fronts (front g from start[g] on) that this step has run into; NULL: not wanted. */
static pg_status step (pg_crack_surfaces *w, const pg_ground *p, size_t front, const double *d,
                       const double *theta, const unsigned char *ends, unsigned char *met,
                       const size_t *start, size_t nfront)
{
    pg_status status = PG_OK;
    stride s = { 0 };
    PG_TRY (begin_stride (&s, w, p, front));
    size_t n = s.old.n;
    for (size_t i = 0; i < n; i++)
        if (ends && ends[i])
            stride_shut (&s, i, s.old.meets[i] ? s.old.meets[i] : (unsigned char) (ends[i] - END_OF));
    PG_TRY (stride_move (&s, d, theta));
    w->area += swept (&s);
    PG_TRY (first_rim (&s));
    if (bends (&s)) {
        PG_TRY (begin_line (&s));
        PG_TRY (line_of (&s, &s.old, s.bend, 0, !s.old.closed, !s.old.closed));
        PG_TRY (tile (&s));
    }
    PG_TRY (divide (&s));
    PG_TRY (tile (&s));
    for (size_t i = 0; met && i < n; i++) {
        if (!s.shut[i] || s.now.meets[i] != PG_MEETS_CRACK) continue;
        for (size_t g = 0; g < nfront; g++)
            for (size_t j = 0; g != front && w->front[g].open && j < w->front[g].n; j++)
                if (pg_distance3 (w->front[g].x + 3*j, s.now.x + 3*i) <= surface_met * stride_spacing (&s, i))
                    met[start[g] + j] = END_OF + PG_MEETS_CRACK;
    }
done:
    clear_stride (&s);
    return status;
}

/* Step of a front, then of fronts that it has met, which end there. */
static pg_status step_all (pg_crack_surfaces *w, const pg_ground *p, size_t front, const double *d,
                           const double *theta, const unsigned char *ends)
{
    pg_status status = PG_OK;
    size_t nfront = w->nfront, *start = NULL;
    unsigned char *met = NULL;
    PG_ALLOC (start, nfront + 1);
    for (size_t g = 0; g < nfront; g++) start[g + 1] = start[g] + w->front[g].n;
    PG_ALLOC (met, start[nfront] + 1);
    PG_TRY (step (w, p, front, d, theta, ends, met, start, nfront));
    for (size_t g = 0; g < nfront; g++) {
        if (g == front || !memchr (met + start[g], END_OF + PG_MEETS_CRACK, w->front[g].n)) continue;
        PG_TRY (pg_cracks_index (&w->cracks));         /* to include the new triangles */
        PG_TRY (step (w, p, g, NULL, NULL, met + start[g], NULL, start, nfront));
    }
done:
    pg_free (start), pg_free (met);
    return status;
}

pg_status pg_surfaces_advance (pg_crack_surfaces *w, const pg_ground *p, size_t front, const double *d,
                            const double *theta)
{
    pg_status status = PG_OK;
    unsigned char *ends = NULL;
    double most = 0;
    if (front >= w->nfront || !w->front[front].open)
        PG_FAIL (PG_E_USAGE, "there is no open front %zu", front + 1);
    size_t n = w->front[front].n;
    for (size_t i = 0; d && i < n; i++)
        most = d[i] >= 0 && isfinite (theta[i]) ? fmax (most, d[i]) : INFINITY;
    if (d && !(most > w->nothing && isfinite (most)))
        PG_FAIL (PG_E_USAGE, "a front cannot advance by %g m", most);
    if (!d) PG_ALLOC (ends, n);
    if (!d) memset (ends, END_OF + PG_MEETS_NOTHING, n);
    PG_TRY (step_all (w, p, front, d, theta, ends));
done:
    pg_free (ends);
    return status;
}
