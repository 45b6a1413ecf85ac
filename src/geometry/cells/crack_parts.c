/* SPDX-License-Identifier: GPL-3.0-or-later
 * Parts into which cracks divide a 2D cell. The pieces of crack segments within the cell are joined to chords
 * that lead from border to border; each chord divides the polygon that it runs through in two. A crack that
 * ends in the cell, branches or crosses another one there separates no polygon of its own: such a cell is not
 * divided, and the caller is told so by 0. */
#include "perigal/cells.h"
#include <math.h>
#include <string.h>

enum { PIECES = 12 };
/* The part of a segment in the cell; border: 1 where its end lies on the border of the cell. */
typedef struct { double end[2][2]; int border[2], used; } piece;
/* The cell as a polygon, counterclockwise, the n pieces of cracks in it, and a length that counts as zero,
 * m. */
typedef struct { pg_cell_part polygon; piece piece[PIECES]; int n; double nothing; } division;

static double cross (const double *a, const double *b, const double *c)
{
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

static double between (const double *a, const double *b) { return hypot (b[0] - a[0], b[1] - a[1]); }

/* Distance of x from the line through a and b, positive on its left. */
static double beside (const double *a, const double *b, const double *x)
{
    return cross (a, b, x) / between (a, b);
}

double pg_cell_part_area (const pg_cell_part *p)
{
    double sum = 0;
    for (int i = 1; i + 1 < p->n; i++) sum += 0.5 * cross (p->x[0], p->x[i], p->x[i + 1]);
    return sum;
}

/* Counts the crossings of the polygon's border with a horizontal ray from x to the right (even-odd rule). */
int pg_cell_part_holds (const pg_cell_part *p, const double *x)
{
    int in = 0;
    for (int i = 0; i < p->n; i++) {
        const double *a = p->x[i], *b = p->x[(i + 1) % p->n];
        if ((a[1] > x[1]) == (b[1] > x[1])) continue;
        if (x[0] < a[0] + (b[0] - a[0]) * ((x[1] - a[1]) / (b[1] - a[1]))) in = !in;
    }
    return in;
}

/* Writes the polygon of a cell that is a triangle or quadrilateral with straight sides; 0: it is another
 * kind. */
static int outline (pg_cell_part *out, const pg_cells *cells, size_t cell)
{
    int kind = cells->kind[cell];
    const double *x = cells->x + 2 * cells->start[cell];
    if (cells->dim != 2 || (kind != PG_QUAD4 && kind != PG_TRI3)) return 0;
    out->n = kind == PG_QUAD4 ? 4 : 3;
    for (int i = 0; i < out->n; i++) {
        memcpy (out->x[i], x + 2 * i, sizeof out->x[i]);
        out->side[i] = i, out->crack[i] = 0;
    }
    return pg_cell_part_area (out) > 0;
}

int pg_cell_clip (const pg_cells *cells, size_t cell, const double *a, const double *b, double nothing,
                  double share[2])
{
    pg_cell_part p;
    if (!outline (&p, cells, cell)) return 0;
    double length = between (a, b);
    share[0] = 0, share[1] = 1;
    for (int i = 0; i < p.n; i++) {
        const double *u = p.x[i], *v = p.x[(i + 1) % p.n];
        double d = beside (u, v, a), e = beside (u, v, b);
        if (fabs (d) < nothing) d = 0;
        if (fabs (e) < nothing) e = 0;
        if (d < 0 && e < 0) return 0;
        if (d <= 0 && e <= 0 && (d < 0 || e < 0)) return 0;
        if (d < 0) share[0] = fmax (share[0], d / (d - e));
        if (e < 0) share[1] = fmin (share[1], d / (d - e));
    }
    return (share[1] - share[0]) * length > 8 * nothing;
}

/* The side of the cell on which x lies, -1: none. */
static int side_at (const division *d, const double *x)
{
    const pg_cell_part *p = &d->polygon;
    for (int i = 0; i < p->n; i++)
        if (fabs (beside (p->x[i], p->x[(i + 1) % p->n], x)) < 2 * d->nothing) return i;
    return -1;
}

/* Stores the part of segment a b within the cell as a piece. A crack along a side must cover the whole side.
 * Returns 0 where this makes the cell impossible to divide. */
static int take (division *d, const pg_cells *cells, size_t cell, const double *a, const double *b)
{
    double share[2];
    pg_cell_part *p = &d->polygon;
    if (!pg_cell_clip (cells, cell, a, b, d->nothing, share)) return 1;
    if (d->n == PIECES) return 0;
    piece *k = &d->piece[d->n];
    for (int e = 0; e < 2; e++) {
        for (int m = 0; m < 2; m++)
            k->end[e][m] = share[e] == 0 ? a[m] : share[e] == 1 ? b[m] : a[m] + share[e] * (b[m] - a[m]);
        k->border[e] = side_at (d, k->end[e]) >= 0;
    }
    for (int i = 0; i < p->n; i++) {
        const double *u = p->x[i], *v = p->x[(i + 1) % p->n];
        if (fabs (beside (u, v, k->end[0])) > 2 * d->nothing
            || fabs (beside (u, v, k->end[1])) > 2 * d->nothing)
            continue;
        if (between (k->end[0], k->end[1]) < between (u, v) - 4 * d->nothing) return 0;
        p->crack[i] = 1;
        return 1;
    }
    k->used = 0, d->n++;
    return 1;
}

/* Do two pieces cross each other inside both? */
static int crossing (const piece *p, const piece *q, double nothing)
{
    double a = beside (p->end[0], p->end[1], q->end[0]), b = beside (p->end[0], p->end[1], q->end[1]),
           c = beside (q->end[0], q->end[1], p->end[0]), e = beside (q->end[0], q->end[1], p->end[1]);
    if (fabs (a) < nothing || fabs (b) < nothing || fabs (c) < nothing || fabs (e) < nothing) return 0;
    return (a > 0) != (b > 0) && (c > 0) != (e > 0);
}

/* Returns the only piece that continues from x, where piece `from` ends inside the cell; begins: which of its
 * ends lies at x. -1: there is none, or several. */
static int next_piece (const division *d, int from, const double *x, int *begins)
{
    int found = -1;
    for (int k = 0; k < d->n; k++)
        for (int e = 0; e < 2; e++) {
            if (k == from || between (d->piece[k].end[e], x) > 2 * d->nothing) continue;
            if (found >= 0 || d->piece[k].used) return -1;
            found = k, *begins = e;
        }
    return found;
}

/* Makes x a vertex of the polygon; its number, -1: it is not on the border, or there is no room. */
static int vertex_at (pg_cell_part *p, const double *x, double nothing)
{
    for (int i = 0; i < p->n; i++) if (between (p->x[i], x) < 4 * nothing) return i;
    for (int i = 0; i < p->n; i++) {
        const double *u = p->x[i], *v = p->x[(i + 1) % p->n];
        double along = (x[0] - u[0]) * (v[0] - u[0]) + (x[1] - u[1]) * (v[1] - u[1]);
        if (fabs (beside (u, v, x)) > 4 * nothing || along < 0 || along > between (u, v) * between (u, v))
            continue;
        if (p->n == PG_PART_EDGES) return -1;
        for (int k = p->n; k > i + 1; k--) {
            memcpy (p->x[k], p->x[k - 1], sizeof p->x[k]);
            p->side[k] = p->side[k - 1], p->crack[k] = p->crack[k - 1];
        }
        memcpy (p->x[i + 1], x, sizeof p->x[i + 1]);
        p->side[i + 1] = p->side[i], p->crack[i + 1] = p->crack[i], p->n++;
        return i + 1;
    }
    return -1;
}

/* Appends a vertex and the edge that begins at it; 0: there is no room. */
static int append (pg_cell_part *p, const double *x, int side, int crack)
{
    if (p->n == PG_PART_EDGES) return 0;
    memcpy (p->x[p->n], x, sizeof p->x[p->n]);
    p->side[p->n] = side, p->crack[p->n++] = crack;
    return 1;
}

/* The polygon from vertex i round to j, closed by the chord back to i; forward: the chord leads from i to
 * j. */
static int half (pg_cell_part *out, const pg_cell_part *p, int i, int j, int n, double chord[][2],
                 int forward)
{
    int good = 1;
    out->n = 0;
    for (int k = i; k != j; k = (k + 1) % p->n) good &= append (out, p->x[k], p->side[k], p->crack[k]);
    good &= append (out, p->x[j], -1, 1);
    for (int k = 1; k + 1 < n; k++) good &= append (out, chord[forward ? n - 1 - k : k], -1, 1);
    return good && pg_cell_part_area (out) > 0;
}

/* Divides the part that a chord runs through. */
static int split (pg_cell_parts *out, int n, double chord[][2], double nothing)
{
    double middle[2] = { 0.5 * (chord[0][0] + chord[1][0]), 0.5 * (chord[0][1] + chord[1][1]) };
    for (int k = 0; k < out->n; k++) {
        if (!pg_cell_part_holds (&out->part[k], middle)) continue;
        pg_cell_part p = out->part[k];
        if (out->n == PG_PARTS || vertex_at (&p, chord[0], nothing) < 0
            || vertex_at (&p, chord[n - 1], nothing) < 0)
            return 0;
        int i = vertex_at (&p, chord[0], nothing), j = vertex_at (&p, chord[n - 1], nothing);
        return i != j && half (&out->part[k], &p, i, j, n, chord, 1)
               && half (&out->part[out->n++], &p, j, i, n, chord, 0);
    }
    return 0;
}

/* Divides the cell by all chords; each is put together from pieces, beginning with one that starts on the
 * border. */
static int split_all (pg_cell_parts *out, division *d)
{
    for (int k = 0; k < d->n; k++)
        for (int e = 0; e < 2; e++) {
            double chord[PIECES + 1][2];
            int n = 0, at = k, begins = e;
            if (d->piece[k].used || !d->piece[k].border[e]) continue;
            memcpy (chord[n++], d->piece[k].end[e], sizeof *chord);
            for (;;) {
                piece *q = &d->piece[at];
                const double *end = q->end[1 - begins];
                q->used = 1;
                memcpy (chord[n++], end, sizeof *chord);
                if (q->border[1 - begins]) break;
                if ((at = next_piece (d, at, end, &begins)) < 0) return 0;
            }
            if (!split (out, n, chord, d->nothing)) return 0;
        }
    for (int k = 0; k < d->n; k++) if (!d->piece[k].used) return 0;
    return 1;
}

int pg_cell_divide (pg_cell_parts *out, const pg_cells *cells, size_t cell, const pg_cracks *cracks,
                    double nothing)
{
    division d = { .nothing = nothing };
    memset (out, 0, sizeof *out);
    if (!outline (&d.polygon, cells, cell)) return 0;
    for (size_t k = 0; k < cracks->n; k++) {
        const pg_crack *c = &cracks->crack[k];
        if (c->kind != PG_CRACK_SEGMENT || !take (&d, cells, cell, c->vertex, c->vertex + 2)) return 0;
    }
    for (int i = 0; i < d.n; i++)
        for (int k = 0; k < i; k++) if (crossing (&d.piece[i], &d.piece[k], nothing)) return 0;
    out->n = 1, out->part[0] = d.polygon;
    return split_all (out, &d);
}
