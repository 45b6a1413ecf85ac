/* SPDX-License-Identifier: GPL-3.0-or-later
 * Fronts of 3D pre-cracks: the parts of the rim of a disc, or of the outline of a polygon, that lie inside
 * the body, have body ahead of them and lie on no other crack. They are found on the cracks as drawn.
 *
 * An outline is a closed curve x (s), s from 0 to 1, that runs with the tangent t = e x n (e outward in the
 * plane of the crack, n its normal; seen against n it runs clockwise). It is tested in steps of a quarter of
 * the spacing; ends of fronts are found by bisection. Parts of different cracks whose ends meet are joined
 * into one front. Vertices are then distributed about a spacing apart; sharp corners are kept. First vertex
 * of a loop: front_loops.c. */
#include "crack_surfaces.h"
#include <math.h>
#include <string.h>

/* Steps per spacing; of lines, per spacing; bisections; limit of steps. In spacings: distance ahead of an
 * edge at which body is required; distance of ends that are joined; least length of a front. */
enum { STEPS = 4, FINER = 8, HALVINGS = 44, MOST_STEPS = 20000 };
static const double ahead = 0.1, together = 0.05, shortest = 0.5;
static const double corner = 0.5;  /* rad: turns above are corners, whose vertex is kept */
static const double pi = 3.14159265358979323846;

/* ---- outlines ------------------------------------------------------------------------------------------ */
typedef struct {
    const pg_ground *p;
    const pg_cracks *cracks;                           /* all cracks */
    const pg_crack *crack;
    size_t number;                                     /* index of the crack */
    double length;                                     /* length of the outline, m */
} outline;

/* Length of edge i of a polygon, from vertex i to the next. */
static double edge_length (const pg_crack *c, size_t i)
{
    return pg_distance3 (c->vertex + 3*i, c->vertex + 3*((i + 1) % c->nvertex));
}

static double outline_length (const pg_crack *c)
{
    double length = 0;
    if (c->kind == PG_CRACK_DISC) return 2 * pi * c->radius;
    for (size_t i = 0; i < c->nvertex; i++) length += edge_length (c, i);
    return length;
}

/* Position x (m) at s (cyclic), and the outward unit vector e there; returns the edge. Vertices of polygons
 * are listed opposite to the tangent. */
static size_t outline_at (const outline *o, double s, double *x, double *e)
{
    const pg_crack *c = o->crack;
    s -= floor (s);
    if (c->kind == PG_CRACK_DISC) {
        double f[3], side[3], angle = -2 * pi * s;
        for (int k = 0; k < 3; k++) f[k] = (c->vertex[k] - c->centre[k]) / c->radius;
        pg_cross3 (c->normal, f, side);
        for (int k = 0; k < 3; k++) {
            e[k] = cos (angle) * f[k] + sin (angle) * side[k];
            x[k] = c->centre[k] + c->radius * e[k];
        }
        return 0;
    }
    double way = (1 - s) * o->length, edge;
    size_t i = 0;
    while (i + 1 < c->nvertex && way > (edge = edge_length (c, i))) way -= edge, i++;
    const double *a = c->vertex + 3*i, *b = c->vertex + 3*((i + 1) % c->nvertex);
    double along[3], share = fmin (1, way / edge_length (c, i));
    for (int k = 0; k < 3; k++) x[k] = a[k] + share * (b[k] - a[k]), along[k] = b[k] - a[k];
    pg_cross3 (along, c->normal, e);
    pg_unit3 (e);
    return i;
}

/* Returns 1: another crack passes through x. */
static int on_another (const outline *o, const double *x)
{
    for (size_t c = 0; c < o->cracks->n; c++)
        if (c != o->number && pg_crack_touches (&o->cracks->crack[c], 3, x, 1e-6 * o->p->cloud->h)) return 1;
    return 0;
}

/* Returns 1: the outline at s is part of a front; else *meets: PG_MEETS_... says why not. */
static int is_front (const outline *o, double s, unsigned char *meets)
{
    double x[3], e[3], place[3];
    outline_at (o, s, x, e);
    double h = pg_ground_spacing_at (o->p, x);
    *meets = PG_MEETS_SURFACE;
    for (int k = 0; k < 3; k++) place[k] = x[k] + ahead * h * e[k];
    if (!pg_ground_has_body (o->p, x) || !pg_ground_has_body (o->p, place)) return 0;
    *meets = on_another (o, x) ? PG_MEETS_CRACK : PG_MEETS_NOTHING;
    return *meets == PG_MEETS_NOTHING;
}

/* End of a front between s = in (part of it) and s = out (not), by bisection. */
static double end_between (const outline *o, double in, double out, unsigned char *meets)
{
    unsigned char why;
    for (int i = 0; i < HALVINGS; i++) {
        double middle = 0.5 * (in + out);
        if (is_front (o, middle, &why)) in = middle;
        else out = middle, *meets = why;
    }
    return in;
}

/* ---- lines: parts of outlines as dense points ---------------------------------------------------------- */
typedef struct {
    pg_front f;                                        /* points, normals, offsets; closed */
    int used;
    size_t parts;                                      /* loops: the number of vertices is a multiple of it */
    unsigned char first, last;                         /* PG_MEETS_... at the ends */
} line;

static pg_status put (pg_front *f, const double *x, const double *normal, double offset)
{
    pg_status status = PG_OK;
    PG_TRY (pg_front_reserve (f, f->n + 1));
    memcpy (f->x + 3 * f->n, x, 3 * sizeof *x);
    memcpy (f->normal + 3 * f->n, normal, 3 * sizeof *x);
    f->offset[f->n] = offset, f->grown[f->n] = 0, f->meets[f->n] = PG_MEETS_NOTHING;
    f->n++;
done:
    return status;
}

/* Parameter s of the first vertex on a disc whose whole rim is a front. */
static double disc_start (const pg_crack *c)
{
    double direction[LOOP_DIRECTIONS][3], f[3], side[3];
    size_t parts;
    front_loop_directions (c->normal, direction, &parts);
    for (int k = 0; k < 3; k++) f[k] = (c->vertex[k] - c->centre[k]) / c->radius;
    pg_cross3 (c->normal, f, side);
    return -atan2 (pg_dot3 (direction[0], side), pg_dot3 (direction[0], f)) / (2 * pi);
}

/* Number of vertices on the whole rim of a disc, a multiple of *parts. */
static size_t disc_parts (const outline *o, size_t *parts)
{
    double direction[LOOP_DIRECTIONS][3];
    front_loop_directions (o->crack->normal, direction, parts);
    return front_loop_parts (o->length / o->p->cloud->h, *parts);
}

/* Draws the part of an outline from s to s + length: for a polygon its vertices, for a disc equal parts. */
static pg_status draw (line *l, const outline *o, double s, double length, const double *retreat)
{
    pg_status status = PG_OK;
    const pg_crack *c = o->crack;
    double x[3], e[3], h = o->p->cloud->h;
    size_t n = FINER * (size_t) fmax (1, round (length * o->length / h)), edge;
    if (l->f.closed && c->kind == PG_CRACK_DISC) n = FINER * disc_parts (o, &l->parts);
    if (c->kind == PG_CRACK_DISC) {
        for (size_t i = 0; i + l->f.closed <= n; i++) {
            outline_at (o, s + length * (double) i / (double) n, x, e);
            PG_TRY (put (&l->f, x, c->normal, retreat ? retreat[0] : 0));
        }
        goto done;
    }
    edge = outline_at (o, s, x, e);
    if (!l->f.closed) PG_TRY (put (&l->f, x, c->normal, retreat ? retreat[edge] : 0));
    /* vertices with s < s_i < s + length; goes around twice, as the part may pass s = 1 */
    for (size_t round = 0, m = c->nvertex; round < 2 * m; round++) {
        double behind = 0;                             /* s of vertex i, counted from the end of the list */
        size_t i = m - 1 - round % m;
        for (size_t j = i; j < m; j++) behind += edge_length (c, j) / o->length;
        double at = behind + (double) (round / m), tiny = 1e-9 * h / o->length;
        if (at < s + tiny || at > s + length + (l->f.closed ? tiny : -tiny)) continue;
        size_t next = (i + m - 1) % m;  /* the edge that begins at vertex i, in reverse order */
        double offset = retreat ? fmax (retreat[i], retreat[next]) : 0;
        PG_TRY (put (&l->f, c->vertex + 3*i, c->normal, offset));
    }
    edge = outline_at (o, s + length, x, e);
    if (!l->f.closed) PG_TRY (put (&l->f, x, c->normal, retreat ? retreat[edge] : 0));
done:
    return status;
}

typedef struct { line *line; size_t n, capacity; } lines;

static pg_status add_line (lines *all, const outline *o, double s, double length, unsigned char first,
                           unsigned char last, int closed, const double *retreat)
{
    pg_status status = PG_OK;
    PG_GROW (all->line, all->capacity, all->n + 1);
    line *l = &all->line[all->n++];
    *l = (line) { .f = { .closed = closed }, .first = first, .last = last, .parts = 1 };
    PG_TRY (draw (l, o, s, length, retreat));
done:
    return status;
}

/* Finds all parts of one outline that are fronts. */
static pg_status find_lines (lines *all, const outline *o, const double *retreat)
{
    pg_status status = PG_OK;
    unsigned char *in = NULL, why, first = 0, last = 0;
    size_t n = (size_t) fmin (MOST_STEPS, 16 + ceil (STEPS * o->length / o->p->cloud->h)), start = 0;
    double step = 1.0 / (double) n;
    PG_ALLOC (in, n);
    for (size_t i = 0; i < n; i++) in[i] = (unsigned char) is_front (o, ((double) i + 0.5) * step, &why);
    while (start < n && in[start]) start++;
    if (start == n) {                                  /* the whole outline is a front */
        double from = o->crack->kind == PG_CRACK_DISC ? disc_start (o->crack) : 0;
        PG_TRY (add_line (all, o, from, 1, 0, 0, 1, retreat));
        goto done;
    }
    for (size_t i = start; i < start + n;) {
        if (!in[i % n]) { i++; continue; }
        size_t j = i;
        while (in[j % n]) j++;
        double from = ((double) i + 0.5) * step, to = ((double) j - 0.5) * step;
        double low = end_between (o, from, from - step, &first), high = end_between (o, to, to + step, &last);
        if ((high - low) * o->length > shortest * o->p->cloud->h)
            PG_TRY (add_line (all, o, low - floor (low), high - low, first, last, 0, retreat));
        i = j;
    }
done:
    pg_free (in);
    return status;
}

/* ---- joining ------------------------------------------------------------------------------------------- */
/* Reverses a line, with its ends and normals. */
static void reverse (line *l)
{
    pg_front *f = &l->f;
    for (size_t i = 0, j = f->n - 1; i < j; i++, j--) {
        double spare;
        for (size_t k = 0; k < 3; k++) {
            spare = f->x[3*i + k], f->x[3*i + k] = f->x[3*j + k], f->x[3*j + k] = spare;
            spare = f->normal[3*i + k], f->normal[3*i + k] = f->normal[3*j + k], f->normal[3*j + k] = spare;
        }
        spare = f->offset[i], f->offset[i] = f->offset[j], f->offset[j] = spare;
    }
    for (size_t i = 0; i < 3 * f->n; i++) f->normal[i] = -f->normal[i];
    unsigned char end = l->first;
    l->first = l->last, l->last = end;
}

/* Appends line b to line a, which ends where b begins. */
static pg_status append (line *a, const line *b)
{
    pg_status status = PG_OK;
    for (size_t i = 1; i < b->f.n; i++)
        PG_TRY (put (&a->f, b->f.x + 3*i, b->f.normal + 3*i, b->f.offset[i]));
    a->last = b->last;
done:
    return status;
}

/* Joins lines of different cracks whose ends meet (within `near`, m); a line whose ends meet becomes a
 * loop. */
static pg_status join (lines *all, double near)
{
    pg_status status = PG_OK;
    for (size_t i = 0; i < all->n; i++) {
        line *a = &all->line[i];
        for (size_t j = 0; !a->used && !a->f.closed && j < all->n; j++) {
            line *b = &all->line[j];
            if (b == a || b->used || b->f.closed || a->last != PG_MEETS_CRACK) continue;
            const double *end = a->f.x + 3 * (a->f.n - 1);
            if (b->last == PG_MEETS_CRACK && pg_distance3 (end, b->f.x + 3 * (b->f.n - 1)) < near)
                reverse (b);
            if (b->first != PG_MEETS_CRACK || !(pg_distance3 (end, b->f.x) < near)) continue;
            PG_TRY (append (a, b));
            b->used = 1, j = (size_t) -1;              /* look again from the new end */
        }
        if (!a->used && !a->f.closed && a->f.n > 3 && a->first == PG_MEETS_CRACK && a->last == PG_MEETS_CRACK
            && pg_distance3 (a->f.x, a->f.x + 3 * (a->f.n - 1)) < near)
            a->f.closed = 1, a->f.n--;
    }
done:
    return status;
}

/* ---- vertices ------------------------------------------------------------------------------------------ */
/* Point i of a line, cyclic. */
static const double *at (const pg_front *l, size_t i) { return l->x + 3 * (i % l->n); }

/* Returns 1: the line has a corner or an end at point i. */
static int is_corner (const pg_front *l, size_t i)
{
    double u[3], v[3];
    if (!l->closed && (i == 0 || i + 1 >= l->n)) return 1;
    const double *before = at (l, i + l->n - 1), *here = at (l, i), *after = at (l, i + 1);
    for (int k = 0; k < 3; k++) u[k] = here[k] - before[k], v[k] = after[k] - here[k];
    pg_unit3 (u), pg_unit3 (v);
    return pg_dot3 (u, v) < cos (corner);
}

static pg_status put_vertex (pg_front *f, const pg_front *l, size_t i, double share)
{
    const double *a = at (l, i), *b = at (l, i + 1), *m = l->normal + 3 * (i % l->n),
                 *n = l->normal + 3 * ((i + 1) % l->n);
    double x[3], normal[3];
    for (size_t k = 0; k < 3; k++)
        x[k] = a[k] + share * (b[k] - a[k]), normal[k] = m[k] + share * (n[k] - m[k]);
    pg_unit3 (normal);
    return put (f, x, normal, (1 - share) * l->offset[i % l->n] + share * l->offset[(i + 1) % l->n]);
}

/* Adds vertices between points `from` and `to` of a line, about a local spacing apart, without the last;
 * their number is a multiple of `parts`. */
static pg_status divide (pg_front *f, const pg_front *l, const pg_ground *p, size_t from, size_t to,
                         size_t parts)
{
    pg_status status = PG_OK;
    double total = 0, *way = NULL;                     /* length from the start, in spacings */
    PG_ALLOC (way, to - from + 1);
    for (size_t i = from; i < to; i++) {
        double middle[3];
        for (int k = 0; k < 3; k++) middle[k] = 0.5 * (at (l, i)[k] + at (l, i + 1)[k]);
        total += pg_distance3 (at (l, i), at (l, i + 1)) / pg_ground_spacing_at (p, middle);
        way[i - from + 1] = total;
    }
    size_t n = front_loop_parts (total, parts), i = from;
    for (size_t k = 0; k < n; k++) {
        double target = total * (double) k / (double) n;
        while (i + 1 < to && way[i - from + 1] <= target * (1 - 1e-12)) i++;
        double piece = way[i - from + 1] - way[i - from],
               share = piece > 0 ? (target - way[i - from]) / piece : 0;
        PG_TRY (put_vertex (f, l, i, fmin (1, fmax (0, share))));
    }
done:
    pg_free (way);
    return status;
}

/* Computes the unit vectors ahead: normal to the line and in the plane of the crack. */
static void frame (pg_front *f)
{
    for (size_t i = 0; i < f->n; i++) {
        size_t low = i ? i - 1 : f->closed ? f->n - 1 : 0,
               high = i + 1 < f->n ? i + 1 : f->closed ? 0 : f->n - 1;
        double t[3], u[3], v[3], *n = f->normal + 3*i, *e = f->ahead + 3*i;
        for (size_t k = 0; k < 3; k++)
            u[k] = f->x[3*i + k] - f->x[3*low + k], v[k] = f->x[3*high + k] - f->x[3*i + k];
        pg_unit3 (u), pg_unit3 (v);                    /* at corners: the bisector */
        for (int k = 0; k < 3; k++) t[k] = u[k] + v[k];
        pg_cross3 (n, t, e);
        pg_unit3 (e);
    }
}

static pg_status make_front (pg_front *f, const line *from, const pg_ground *p)
{
    pg_status status = PG_OK;
    const pg_front *l = &from->f;
    size_t first = 0, end = l->closed ? l->n : l->n - 1, parts = 1;
    while (l->closed && first < l->n && !is_corner (l, first)) first++;
    if (first == l->n) first = 0, parts = from->parts; /* a loop without corners */
    for (size_t i = first, next; i < first + end; i = next) {
        next = i + 1;
        while (next < first + end && !is_corner (l, next % l->n)) next++;
        PG_TRY (divide (f, l, p, i, next, parts));
    }
    if (!l->closed) {
        PG_TRY (put_vertex (f, l, l->n - 2, 1));
        f->meets[0] = from->first, f->meets[f->n - 1] = from->last;
    }
    f->closed = l->closed, f->open = 1;
    frame (f);
done:
    return status;
}

pg_status pg_fronts_find (const pg_ground *p, const pg_cracks *cracks, double *const *retreat, pg_front **out,
                          size_t *n)
{
    pg_status status = PG_OK;
    lines all = { 0 };
    for (size_t c = 0; c < cracks->n; c++) {
        outline o = { p, cracks, &cracks->crack[c], c, outline_length (&cracks->crack[c]) };
        PG_TRY (find_lines (&all, &o, retreat ? retreat[c] : NULL));
    }
    PG_TRY (join (&all, together * p->cloud->h));
    PG_ALLOC (*out, all.n + 1);
    for (size_t i = 0; i < all.n; i++) {
        if (all.line[i].used) continue;
        pg_front *f = &(*out)[(*n)++];
        f->id = f->of = (long) *n;
        PG_TRY (make_front (f, &all.line[i], p));
    }
done:
    for (size_t i = 0; i < all.n; i++) pg_front_clear (&all.line[i].f);
    pg_free (all.line);
    return status;
}
