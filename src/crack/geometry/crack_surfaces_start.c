/* SPDX-License-Identifier: GPL-3.0-or-later
 * A new 3D crack: a plane convex polygon. Its outline inside the body becomes one front, or several if
 * interrupted by the surface of the body; it cuts bonds up to the offset behind fronts, and to its outline
 * outside of the body. */
#include "crack_surfaces.h"
#include <string.h>

/* Largest offset of a front, as a fraction of the square root of the area. */
#define OFFSET_OF_SIZE 0.25
/* Vertices closer than this to the end of their front are omitted, spacings. */
#define NEAR_END 0.25
/* Bisections for the point where an edge leaves the body. */
enum { HALVINGS = 50 };

typedef struct {
    stride s;                                          /* surfaces, body, and the edge of the cutting part */
    size_t n;
    double *x;  /* the polygon, in the direction of fronts, m (n x 3) */
    const double *normal;
    double middle[3], offset;
    unsigned char *in;                                 /* 1: the vertex lies in the body (n) */
} patch;

/* Reads the polygon and orders it like fronts: tangent = ahead x normal, clockwise seen against the
 * normal. */
static pg_status read (patch *c, size_t n, const double *x)
{
    pg_status status = PG_OK;
    double turn[3], sum = 0;
    PG_ALLOC (c->x, 3 * n);
    PG_ALLOC (c->in, n);
    for (size_t i = 0; i < n; i++)
        for (size_t k = 0; k < 3; k++) c->middle[k] += x[3*i + k] / (double) n;
    for (size_t i = 0; i < n; i++) {
        double u[3], v[3];
        for (size_t k = 0; k < 3; k++)
            u[k] = x[3*i + k] - c->middle[k], v[k] = x[3 * ((i + 1) % n) + k] - c->middle[k];
        pg_cross3 (u, v, turn);
        sum += 0.5 * pg_dot3 (turn, c->normal);
    }
    if (!(fabs (sum) > c->s.w->nothing * c->s.w->nothing))
        PG_FAIL (PG_E_USAGE, "a crack cannot begin with an area of %g m^2", fabs (sum));
    c->n = n;
    c->offset = fmin (front_offset_at (c->s.p, c->middle), OFFSET_OF_SIZE * sqrt (fabs (sum)));
    for (size_t i = 0; i < n; i++) {
        memcpy (c->x + 3*i, x + 3 * (sum > 0 ? n - 1 - i : i), 3 * sizeof *x);
        c->in[i] = (unsigned char) pg_ground_has_body (c->s.p, c->x + 3*i);
    }
done:
    return status;
}

/* Finds where the edge from a vertex inside to one outside leaves the body. */
static void leave (const patch *c, size_t inside, size_t outside, double *place)
{
    const double *a = c->x + 3*inside, *b = c->x + 3*outside;
    double near = 0, far = 1;
    for (int i = 0; i < HALVINGS; i++) {
        double t = 0.5 * (near + far);
        for (int k = 0; k < 3; k++) place[k] = a[k] + t * (b[k] - a[k]);
        if (pg_ground_has_body (c->s.p, place)) near = t;
        else far = t;
    }
    for (int k = 0; k < 3; k++) place[k] = a[k] + near * (b[k] - a[k]);
}

static void put_vertex (const patch *c, pg_front *f, const double *x, unsigned char meets)
{
    size_t i = f->n++;
    memcpy (f->x + 3*i, x, 3 * sizeof *x);
    memcpy (f->normal + 3*i, c->normal, 3 * sizeof *x);
    for (size_t k = 0; k < 3; k++) f->ahead[3*i + k] = x[k] - c->middle[k];
    pg_unit3 (f->ahead + 3*i);
    f->offset[i] = c->offset, f->grown[i] = 0, f->meets[i] = meets;
}

/* Adds a front of m vertices inside the body from index `first` on (m = n: a loop). */
static pg_status add_front (patch *c, size_t first, size_t m)
{
    pg_status status = PG_OK;
    size_t n = c->n;
    pg_front f = { .open = 1, .closed = m == n };
    double *cut = NULL, place[3];
    PG_TRY (pg_front_reserve (&f, m + 2));
    if (!f.closed) leave (c, first, (first + n - 1) % n, place), put_vertex (c, &f, place, PG_MEETS_SURFACE);
    for (size_t k = 0; k < m; k++) {                   /* a first vertex too near to the end is omitted */
        const double *x = c->x + 3 * ((first + k) % n);
        if (k > 0 || f.closed || pg_distance3 (x, place) > NEAR_END * pg_ground_spacing_at (c->s.p, x))
            put_vertex (c, &f, x, PG_MEETS_NOTHING);
    }
    if (!f.closed) {
        leave (c, (first + m - 1) % n, (first + m) % n, place);
        if (f.n > 2 && pg_distance3 (f.x + 3 * (f.n - 1), place) <= NEAR_END * pg_ground_spacing_at (c->s.p,
                                                                                                      place))
            f.n--;
        put_vertex (c, &f, place, PG_MEETS_SURFACE);
    }
    front_frames (&f);
    PG_ALLOC (cut, 3 * f.n);
    for (size_t i = 0; i < 3 * f.n; i++) cut[i] = f.x[i] - c->offset * f.ahead[i];
    PG_TRY (front_resample (&f, c->s.p, &cut));
    front_frames (&f);
    PG_TRY (stride_lay (&c->s, &f, cut, 0, !f.closed, !f.closed));
    PG_TRY (surfaces_reserve_fronts (c->s.w, c->s.w->nfront + 1));
    f.id = f.of = surfaces_next_id (c->s.w);
    c->s.w->front[c->s.w->nfront++] = f;
    f = (pg_front) { 0 };
done:
    pg_front_clear (&f);
    pg_free (cut);
    return status;
}

/* Goes around the outline: adds fronts inside the body, and vertices outside to the line. */
static pg_status add_fronts (patch *c)
{
    pg_status status = PG_OK;
    size_t n = c->n, begin = 0;
    while (begin < n && c->in[begin]) begin++;
    if (begin == n) {
        PG_TRY (add_front (c, 0, n));
        goto done;
    }
    for (size_t k = 0; k < n; ) {
        size_t i = (begin + k) % n, m = 0;
        while (k + m < n && c->in[(i + m) % n]) m++;
        if (m) PG_TRY (add_front (c, i, m));
        else PG_TRY (stride_to_line (&c->s, c->x + 3*i, c->normal));
        k += m ? m : 1;
    }
done:
    return status;
}

pg_status pg_surfaces_start (pg_crack_surfaces *w, const pg_ground *p, size_t n, const double *x,
                          const double *normal)
{
    pg_status status = PG_OK;
    patch c = { .s = { .w = w, .p = p }, .normal = normal };
    if (n < 3) PG_FAIL (PG_E_USAGE, "a crack cannot begin with %zu vertices", n);
    PG_TRY (read (&c, n, x));
    size_t fronts = w->nfront;
    PG_TRY (add_fronts (&c));
    if (w->nfront == fronts) PG_FAIL (PG_E_USAGE, "a crack cannot begin outside of the body");
    PG_TRY (surfaces_reserve (w, w->cracks.n, w->nvertex + 1));
    size_t middle = surfaces_put_vertex (w, c.middle);
    surface_line apex = { 1, &middle, normal, 0 }, outline = { c.s.nline, c.s.line, c.s.side, 1 };
    PG_TRY (surfaces_zip (w, p, &apex, &outline, w->front[fronts].id));
    for (size_t i = 0; i < n; i++) {
        const double *u = c.x + 3*i, *v = c.x + 3 * ((i + 1) % n);
        w->area += pg_ground_area_inside (p, c.middle, u, v, triangle_area3 (c.middle, u, v));
    }
done:
    pg_free (c.x), pg_free (c.in), pg_free (c.s.line), pg_free (c.s.side);
    return status;
}
