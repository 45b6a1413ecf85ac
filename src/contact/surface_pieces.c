/* SPDX-License-Identifier: GPL-3.0-or-later
 * Divides surfaces of 3D cracks into pieces of about two by two spacings.
 *
 * A disc or polygon of the scene is sampled on a raster of four cells per spacing along its longest edge and
 * across. The part of a cell that cuts bonds and lies in the body gives a sampling point of the gap, at its
 * centroid. Rows of the raster are joined to strips two spacings wide, and strips cut across into pieces of
 * equal area; interrupted strips are treated as several, and ends of a surface too small for a strip are
 * merged with their neighbours.
 *
 * Grown triangles are divided into small ones, whose centroids are sampling points. Those in the plane of a
 * disc or polygon that cuts there itself are omitted; those within half a spacing beside it (where it ended
 * behind its front) join its pieces, as this strip is too narrow for pieces of its own. The others form
 * patches of triangles that share vertices without a sharp turn, and are clustered into pieces
 * (gather_dots.c).
 *
 * All areas that are compared are measured in local spacings. */
#include "pieces.h"
#include <math.h>
#include <string.h>

/* Grown points join a disc or polygon within BESIDE spacings of its points, OFF_PLANE spacings from its
 * plane, with a cosine between normals of at least SAME_PLANE. */
static const double BESIDE = 0.5, OFF_PLANE = 0.05, SAME_PLANE = 0.99;

/* Subdivisions of a raster cell in each direction. */
enum { PARTS = 3 };
static const double FULL = PG_CONTACT_PIECE * PG_CONTACT_PIECE;

typedef struct {
    const pg_problem *p;
    dot *dot;  size_t ndot, cap_dot;
    dot *grown;  size_t ngrown, cap_grown;             /* points of grown triangles */
    size_t npatch;
    size_t cap_x, cap_normal, cap_tangent, cap_weight, cap_piece, cap_first;
} surface;

/* ---- a plane crack on a raster ------------------------------------------------------------------------- */
/* Axes of a plane crack, and its extent along them from `origin`, m. */
typedef struct { double origin[3], axis[2][3], low[2], high[2]; } sheet;

/* Sets the axes: the first is along the longest edge (the first of equal ones), for a disc towards its first
 * vertex. */
static void lay_sheet (const pg_crack *c, sheet *s)
{
    const double *from = c->vertex;
    double longest = 0;
    memset (s, 0, sizeof *s);
    for (size_t i = 0; i < c->nvertex; i++) {
        const double *a = c->vertex + 3*i, *b = c->vertex + 3 * ((i + 1) % c->nvertex);
        double length = hypot (hypot (b[0] - a[0], b[1] - a[1]), b[2] - a[2]);
        if (c->kind == PG_CRACK_DISC) break;
        if (!(length > longest * (1 + 1e-9))) continue;
        longest = length, from = a;
        for (int k = 0; k < 3; k++) s->axis[0][k] = (b[k] - a[k]) / length;
    }
    if (c->kind == PG_CRACK_DISC) {
        for (int k = 0; k < 3; k++) s->axis[0][k] = (c->vertex[k] - c->centre[k]) / c->radius;
        from = c->centre;
        for (int a = 0; a < 2; a++) s->low[a] = -c->radius, s->high[a] = c->radius;
    }
    memcpy (s->origin, from, sizeof s->origin);
    pg_cross3 (c->normal, s->axis[0], s->axis[1]);
    for (size_t i = 0; c->kind != PG_CRACK_DISC && i < c->nvertex; i++)
        for (int a = 0; a < 2; a++) {
            double at = 0;
            for (int k = 0; k < 3; k++) at += s->axis[a][k] * (c->vertex[3*i + (size_t) k] - s->origin[k]);
            s->low[a] = fmin (s->low[a], at), s->high[a] = fmax (s->high[a], at);
        }
}

static void place (const sheet *s, double u, double v, double *x)
{
    for (int k = 0; k < 3; k++) x[k] = s->origin[k] + u * s->axis[0][k] + v * s->axis[1][k];
}

/* Least local spacing on the crack, m. */
static double finest (const surface *w, const sheet *s)
{
    enum { LOOK = 8 };
    double least = INFINITY, x[3];
    for (int i = 0; i <= LOOK; i++)
        for (int j = 0; j <= LOOK; j++) {
            place (s, s->low[0] + i * (s->high[0] - s->low[0]) / LOOK,
                   s->low[1] + j * (s->high[1] - s->low[1]) / LOOK, x);
            least = fmin (least, pg_problem_spacing_at (w->p, x));
        }
    return least;
}

/* Appends a dot for the part of a raster cell that cuts bonds and lies in the body; cell: its sides, m. */
static pg_status add_cell (surface *w, const pg_crack *c, const sheet *s, const double cell[2], size_t row,
                           size_t column)
{
    pg_status status = PG_OK;
    dot d = { .area = cell[0] * cell[1] / (PARTS * PARTS), .row = row, .column = column };
    int in = 0;
    for (int i = 0; i < PARTS * PARTS; i++) {
        double x[3], u = (double) row + (i / PARTS + 0.5) / PARTS,
               v = (double) column + (i % PARTS + 0.5) / PARTS;
        place (s, s->low[0] + cell[0] * u, s->low[1] + cell[1] * v, x);
        if (!pg_crack_touches (c, 3, x, pg_cloud_same (&w->p->cloud))) continue;
        if (!pg_problem_has_body (w->p, x)) continue;
        in++;
        for (int k = 0; k < 3; k++) d.x[k] += x[k];
    }
    if (!in) return PG_OK;
    for (int k = 0; k < 3; k++) d.x[k] /= in, d.normal[k] = c->normal[k];
    double h = pg_problem_spacing_at (w->p, d.x);
    d.area *= in, d.size = d.area / (h * h), d.h = h;
    PG_GROW (w->dot, w->cap_dot, w->ndot + 1);
    w->dot[w->ndot++] = d;
done:
    return status;
}

/* Assigns n consecutive sizes to `parts` equal parts by their middles: part[i]; if a middle lies on a border,
 * part[far + i] is the next part, else the same. */
static void share_out (size_t n, const double *size, size_t parts, size_t far, size_t *part)
{
    double whole = 0, passed = 0, most = (double) parts - 1;
    for (size_t i = 0; i < n; i++) whole += size[i];
    for (size_t i = 0; i < n; i++) {
        double at = (passed + 0.5 * size[i]) / whole * (double) parts;
        part[i] = (size_t) fmin (most, fmax (0, floor (at - PG_NO_LENGTH)));
        part[far + i] = (size_t) fmin (most, fmax (0, floor (at + PG_NO_LENGTH)));
        passed += size[i];
    }
}

/* Divides a dot on a border in two halves, of which the second is appended. */
static pg_status halve (surface *w, size_t i)
{
    pg_status status = PG_OK;
    PG_GROW (w->dot, w->cap_dot, w->ndot + 1);
    w->dot[i].area *= 0.5, w->dot[i].size *= 0.5;
    w->dot[w->ndot++] = w->dot[i];
done:
    return status;
}

/* Computes the width of each row of the raster in local spacings (mean over its cells), and their sum
 * *all. */
static pg_status row_widths (const surface *w, size_t first, size_t rows, double cell, double *width,
                             double *all)
{
    pg_status status = PG_OK;
    double *cells = NULL;
    PG_ALLOC (cells, rows);
    for (size_t i = first; i < w->ndot; i++) {
        const dot *d = &w->dot[i];
        width[d->row] += cell * sqrt (d->size / d->area), cells[d->row]++;
    }
    *all = 0;
    for (size_t i = 0; i < rows; i++) width[i] = cells[i] > 0 ? width[i] / cells[i] : 0, *all += width[i];
done:
    pg_free (cells);
    return status;
}

/* Merges strips at the ends that are too small with the next ones, until one is large enough. */
static pg_status join_small (size_t rows, const double *area, size_t *strip, size_t count)
{
    pg_status status = PG_OK;
    double *held = NULL;
    PG_ALLOC (held, count);
    for (size_t i = 0; i < rows; i++) held[strip[i]] += area[i];
    for (size_t k = 0; k + 1 < count && held[k] < DOTS_LEAST * FULL; k++) {
        held[k + 1] += held[k];
        for (size_t i = 0; i < rows; i++) if (strip[i] == k) strip[i] = k + 1;
    }
    for (size_t k = count; k-- > 1 && held[k] < DOTS_LEAST * FULL;) {
        held[k - 1] += held[k];
        for (size_t i = 0; i < rows; i++) if (strip[i] == k) strip[i] = k - 1;
    }
done:
    pg_free (held);
    return status;
}

/* Assigns rows of the raster to strips; rows numbered from `rows` on are second halves of rows on a
 * border. */
static pg_status find_strips (surface *w, size_t first, size_t rows, double cell, size_t *strip,
                              size_t *count)
{
    pg_status status = PG_OK;
    double *width = NULL, *area = NULL, all = 0;
    PG_ALLOC (width, rows);
    PG_ALLOC (area, 2 * rows);
    PG_TRY (row_widths (w, first, rows, cell, width, &all));
    *count = pieces_of (&w->p->cloud, all, PG_CONTACT_PIECE);
    share_out (rows, width, *count, rows, strip);
    for (size_t i = first, last = w->ndot; i < last; i++) {
        size_t row = w->dot[i].row;
        if (strip[row] == strip[rows + row]) continue;
        PG_TRY (halve (w, i));
        w->dot[w->ndot - 1].row += rows;
    }
    for (size_t i = first; i < w->ndot; i++) area[w->dot[i].row] += w->dot[i].size;
    PG_TRY (join_small (2 * rows, area, strip, *count));
done:
    pg_free (width), pg_free (area);
    return status;
}

/* Cuts a strip into pieces: each run of columns without a gap is divided into pieces of equal area. *next:
 * number of the next piece. */
static pg_status cut_strip (surface *w, size_t first, const size_t *strip, size_t number, size_t columns,
                            size_t *next)
{
    pg_status status = PG_OK;
    double *area = NULL;
    size_t *piece = NULL;
    PG_ALLOC (area, columns);
    PG_ALLOC (piece, 2 * columns);
    for (size_t i = first; i < w->ndot; i++)
        if (strip[w->dot[i].row] == number) area[w->dot[i].column] += w->dot[i].size;
    for (size_t from = 0, to; from < columns; from = to) {
        double whole = 0;
        for (to = from; to < columns && (area[to] > 0) == (area[from] > 0); to++) whole += area[to];
        if (!(whole > 0)) continue;
        size_t parts = pieces_of (&w->p->cloud, whole, FULL);
        share_out (to - from, area + from, parts, columns, piece + from);
        for (size_t j = from; j < to; j++) piece[j] += *next, piece[columns + j] += *next;
        *next += parts;
    }
    for (size_t i = first, last = w->ndot; i < last; i++) {
        size_t column = w->dot[i].column;
        if (strip[w->dot[i].row] != number) continue;
        w->dot[i].piece = piece[column];
        if (piece[columns + column] == piece[column]) continue;
        PG_TRY (halve (w, i));
        w->dot[w->ndot - 1].piece = piece[columns + column];
    }
done:
    pg_free (area), pg_free (piece);
    return status;
}

/* ---- pieces from dots ---------------------------------------------------------------------------------- */
/* Appends dots from `first` on, which belong to the pieces 0 to count - 1, as pieces of one path. along:
 * approximate direction of the first tangent; NULL: the coordinate axis nearest to the plane of each
 * piece. */
static pg_status put_pieces (surface *w, pg_contact_pieces *out, size_t first, size_t count,
                             const double *along)
{
    pg_status status = PG_OK;
    size_t points = out->npoint + w->ndot - first;
    PG_GROW (out->piece, w->cap_piece, out->n + count);
    PG_GROW (out->first, w->cap_first, out->n + count + 1);
    PG_GROW (out->x, w->cap_x, 3 * points);
    PG_GROW (out->normal, w->cap_normal, 3 * points);
    PG_GROW (out->tangent, w->cap_tangent, 6 * points);
    PG_GROW (out->weight, w->cap_weight, points);
    for (size_t k = 0; k < count; k++) {
        pg_contact_piece *piece = &out->piece[out->n];
        const size_t begins = out->npoint;
        double size;
        memset (piece, 0, sizeof *piece);
        for (size_t i = first; i < w->ndot; i++) {
            const dot *d = &w->dot[i];
            if (d->piece != k) continue;
            memcpy (out->x + 3 * out->npoint, d->x, sizeof d->x);
            memcpy (out->normal + 3 * out->npoint, d->normal, sizeof d->normal);
            out->weight[out->npoint++] = d->area;
            piece->area += d->area;
            for (int c = 0; c < 3; c++)
                piece->x[c] += d->area * d->x[c], piece->normal[c] += d->area * d->normal[c];
        }
        size = sqrt (pg_dot3 (piece->normal, piece->normal));
        if (out->npoint == begins || !(size > 0)) continue;
        for (int c = 0; c < 3; c++) piece->x[c] /= piece->area, piece->normal[c] /= size;
        piece_tangents (piece->normal, along, piece->tangent[0]);
        for (size_t q = begins; q < out->npoint; q++)
            piece_tangents (out->normal + 3*q, piece->tangent[0], out->tangent + 6*q);
        piece->length = sqrt (piece->area), piece->path = w->npatch;
        out->first[++out->n] = out->npoint;
    }
    w->npatch++;
done:
    return status;
}

/* Finds the dot of a plane crack (from `first` on) nearest to a grown dot; returns the squared distance in
 * local spacings; INFINITY: the grown dot is not in its plane. */
static double nearest_of_sheet (const surface *w, const dot *grown, size_t first, size_t *nearest)
{
    double least = INFINITY, h2 = grown->area / grown->size, off = 0;
    const double *normal = w->dot[first].normal;
    for (int k = 0; k < 3; k++) off += (grown->x[k] - w->dot[first].x[k]) * normal[k];
    if (fabs (pg_dot3 (grown->normal, normal)) < SAME_PLANE || off * off > OFF_PLANE * OFF_PLANE * h2)
        return INFINITY;
    for (size_t i = first; i < w->ndot; i++) {
        double far = 0;
        for (int k = 0; k < 3; k++)
            far += (w->dot[i].x[k] - grown->x[k]) * (w->dot[i].x[k] - grown->x[k]);
        if (far / h2 < least) least = far / h2, *nearest = i;
    }
    return least;
}

/* Treats grown dots in the plane of crack c (own dots from `first` on): omits those where c itself cuts, and
 * assigns those beside it to the nearest piece. */
static pg_status join_grown (surface *w, const pg_crack *c, size_t first)
{
    pg_status status = PG_OK;
    size_t last = w->ndot, near = first;
    for (size_t g = 0; g < w->ngrown; g++) {
        dot *d = &w->grown[g];
        if (d->triangle == SIZE_MAX) continue;
        surface own = { .dot = w->dot, .ndot = last };
        if (nearest_of_sheet (&own, d, first, &near) > BESIDE * BESIDE) continue;
        d->triangle = SIZE_MAX;
        if (pg_crack_touches (c, 3, d->x, OFF_PLANE * sqrt (d->area / d->size))) continue;
        PG_GROW (w->dot, w->cap_dot, w->ndot + 1);
        w->dot[w->ndot] = *d, w->dot[w->ndot].piece = w->dot[near].piece;
        memcpy (w->dot[w->ndot++].normal, w->dot[near].normal, sizeof d->normal);
    }
done:
    return status;
}

static pg_status divide_sheet (surface *w, pg_contact_pieces *out, const pg_crack *c)
{
    pg_status status = PG_OK;
    size_t first = w->ndot, n[2], *strip = NULL, strips = 0, count = 0;
    double cell[2], h;
    sheet s;
    lay_sheet (c, &s);
    h = finest (w, &s);
    for (int a = 0; a < 2; a++) {
        double length = s.high[a] - s.low[a];
        n[a] = pg_cloud_pieces (&w->p->cloud, length, h / PG_CONTACT_POINTS_SPACE);
        cell[a] = length / (double) n[a];
    }
    for (size_t i = 0; i < n[0]; i++)
        for (size_t j = 0; j < n[1]; j++) PG_TRY (add_cell (w, c, &s, cell, i, j));
    if (w->ndot == first) return PG_OK;
    PG_ALLOC (strip, 2 * n[0]);
    PG_TRY (find_strips (w, first, n[0], cell[0], strip, &strips));
    for (size_t k = 0; k < strips; k++) PG_TRY (cut_strip (w, first, strip, k, n[1], &count));
    PG_TRY (join_grown (w, c, first));
    PG_TRY (put_pieces (w, out, first, count, s.axis[0]));
done:
    pg_free (strip);
    return status;
}

/* ---- triangles that have grown ------------------------------------------------------------------------- */
/* Divides a grown triangle into parts^2 small ones, with sides shorter than the distance of sampling points,
 * and appends their centroids. */
static pg_status add_triangle (surface *w, const pg_crack *c, size_t number)
{
    pg_status status = PG_OK;
    double u[3], v[3], n[3], longest = 0, least = INFINITY;
    for (int k = 0; k < 3; k++)
        u[k] = c->vertex[3 + k] - c->vertex[k], v[k] = c->vertex[6 + k] - c->vertex[k];
    pg_cross3 (u, v, n);
    for (size_t i = 0; i < 3; i++) {
        const double *a = c->vertex + 3*i, *b = c->vertex + 3 * ((i + 1) % 3);
        longest = fmax (longest, hypot (hypot (b[0] - a[0], b[1] - a[1]), b[2] - a[2]));
        least = fmin (least, pg_problem_spacing_at (w->p, a));
    }
    size_t parts = pg_cloud_pieces (&w->p->cloud, longest, least / PG_CONTACT_POINTS_SPACE);
    double area = 0.5 * sqrt (pg_dot3 (n, n)) / (double) (parts * parts);
    PG_GROW (w->grown, w->cap_grown, w->ngrown + parts * parts);
    for (size_t i = 0; i < parts; i++)
        for (size_t j = 0; j < 2 * (parts - i) - 1; j++) {
            /* even j: upright triangles, odd j: inverted ones between them */
            double third = j % 2 ? 2.0 / 3 : 1.0 / 3, s = ((double) i + third) / (double) parts,
                   t = ((double) (j / 2) + third) / (double) parts, h;
            dot *d = &w->grown[w->ngrown];
            memset (d, 0, sizeof *d);
            for (int k = 0; k < 3; k++)
                d->x[k] = c->vertex[k] + s * u[k] + t * v[k], d->normal[k] = c->normal[k];
            if (!pg_problem_has_body (w->p, d->x)) continue;
            h = pg_problem_spacing_at (w->p, d->x);
            d->area = area, d->size = area / (h * h), d->h = h, d->triangle = number, w->ngrown++;
        }
done:
    return status;
}

/* Returns 1: two triangles share a vertex without a sharp turn. */
static int goes_on (const pg_crack_surfaces *s, size_t a, size_t b)
{
    if (pg_dot3 (s->cracks.crack[s->nfirst + a].normal, s->cracks.crack[s->nfirst + b].normal)
        < cos (PG_CONTACT_TURN)) return 0;
    for (int i = 0; i < 9; i++)
        if (s->corner[3*a + (size_t) (i / 3)] == s->corner[3*b + (size_t) (i % 3)]) return 1;
    return 0;
}

/* Appends the remaining dots of a triangle to the current patch. */
static pg_status take_triangle (surface *w, size_t number)
{
    pg_status status = PG_OK;
    for (size_t g = 0; g < w->ngrown; g++) {
        if (w->grown[g].triangle != number) continue;
        PG_GROW (w->dot, w->cap_dot, w->ndot + 1);
        w->dot[w->ndot++] = w->grown[g];
    }
done:
    return status;
}

/* Divides the grown triangles into pieces, patch by patch of connected triangles. */
static pg_status divide_grown (surface *w, pg_contact_pieces *out, const pg_crack_surfaces *s)
{
    pg_status status = PG_OK;
    size_t n = s->cracks.n - s->nfirst, *list = NULL;
    unsigned char *used = NULL;
    PG_ALLOC (list, n);
    PG_ALLOC (used, n);
    for (size_t from = 0; from < n; from++) {
        size_t first = w->ndot, listed = 0;
        double whole = 0;
        if (used[from]) continue;
        used[from] = 1, list[listed++] = from;
        for (size_t at = 0; at < listed; at++) {
            PG_TRY (take_triangle (w, list[at]));
            for (size_t b = 0; b < n; b++)
                if (!used[b] && goes_on (s, list[at], b)) used[b] = 1, list[listed++] = b;
        }
        for (size_t i = first; i < w->ndot; i++) whole += w->dot[i].size;
        if (w->ndot == first) continue;
        size_t count = (size_t) fmax (1, round (whole / FULL));
        PG_TRY (gather_dots (w->dot + first, w->ndot - first, FULL, &count));
        PG_TRY (put_pieces (w, out, first, count, NULL));
    }
done:
    pg_free (list), pg_free (used);
    return status;
}

pg_status surface_pieces_create (pg_contact_pieces *out, const pg_problem *p, const pg_state *state)
{
    pg_status status = PG_OK;
    surface w = { .p = p, .cap_first = 1 };
    const pg_crack_surfaces *grown = state ? state->surfaces : NULL;
    const pg_cracks *cracks = pg_state_cracks (p, state);
    for (size_t k = grown ? grown->nfirst : cracks->n; k < cracks->n; k++)
        PG_TRY (add_triangle (&w, &cracks->crack[k], k - grown->nfirst));
    for (size_t k = 0; k < (grown ? grown->nfirst : cracks->n); k++)
        if (cracks->crack[k].kind != PG_CRACK_SEGMENT) PG_TRY (divide_sheet (&w, out, &cracks->crack[k]));
    if (grown) PG_TRY (divide_grown (&w, out, grown));
done:
    pg_free (w.dot), pg_free (w.grown);
    return status;
}
