/* SPDX-License-Identifier: GPL-3.0-or-later
 * Faces between cells and on the boundary, each once, with points and normals. A face is identified by the
 * coordinates of its corners, which cells that share nodes hold with the same bits; all faces are sorted by
 * these, so that equal ones become neighbours: n log n, without tables of nodes. */
#include "perigal/integration.h"
#include <stdlib.h>
#include <string.h>

/* One face of one cell, before faces are paired. */
typedef struct {
    /* Number of the face, counted cell by cell and side by side. */
    size_t at;
    /* Cell (-1: a facet of the boundary), side in the numbering of Exodus, number of corners. */
    int    cell, side, corners;
    /* The corners (up to 4 x 3), sorted, so that the order in which a cell lists them does not matter. */
    double corner[12];
} candidate;

/* Lexicographic order of two positions. */
static int compare_places (const void *a, const void *b)
{
    const double *x = a, *y = b;
    for (int k = 0; k < 3; k++) if (x[k] != y[k]) return x[k] < y[k] ? -1 : 1;
    return 0;
}

/* Order of two faces by number and position of their corners; 0: the same face. */
static int compare_corners (const candidate *c, const candidate *d)
{
    if (c->corners != d->corners) return c->corners < d->corners ? -1 : 1;
    for (int k = 0; k < 3 * c->corners; k++)
        if (c->corner[k] != d->corner[k]) return c->corner[k] < d->corner[k] ? -1 : 1;
    return 0;
}

/* Order of two faces by their corners, of equal ones by their numbers, so that the sorted order is unique. */
static int compare (const void *a, const void *b)
{
    const candidate *c = a, *d = b;
    int order = compare_corners (c, d);
    return order ? order : c->at < d->at ? -1 : 1;
}

/* The element that describes the shape of cell c: a cut cell has the faces of its lattice cell. */
static pg_element kind_of (const pg_cells *cells, size_t c)
{
    static const pg_element box[] = { PG_BAR2, PG_QUAD4, PG_HEX8 };
    return cells->kind[c] == PG_CUT ? box[cells->dim - 1] : (pg_element) cells->kind[c];
}

/* Number of faces of cell c. */
static int faces_of (const pg_cells *cells, size_t c) { return pg_element_types[kind_of (cells, c)].faces; }

/* Fills c with face `side` of a cell. Adding 0.0 turns -0 into +0, which compare equal but have different
 * bits. */
static void describe (candidate *c, const pg_cells *cells, size_t at, int cell, int side)
{
    size_t dim = (size_t) cells->dim;
    int node[9];
    const double *x = cells->x + cells->start[cell] * dim;
    pg_element face = pg_element_face (kind_of (cells, (size_t) cell), side, node);
    *c = (candidate) { .at = at, .cell = cell, .side = side, .corners = pg_element_types[face].corners };
    /* + 0.0 turns -0 into +0 */
    for (int i = 0; i < c->corners; i++)
        for (size_t k = 0; k < dim; k++) c->corner[3 * i + (int) k] = x[(size_t) node[i] * dim + k] + 0.0;
    pg_sort (c->corner, (size_t) c->corners, 3 * sizeof *c->corner, compare_places);
}

/* Fills c with facet f of the boundary, a face of an element; cell is -1, and no coordinate is -0. */
static void describe_facet (candidate *c, const pg_cells *cells, size_t at, size_t f)
{
    size_t dim = (size_t) cells->dim;
    const double *x = cells->facet_x + cells->facet_start[f] * dim;
    *c = (candidate) { .at = at, .cell = -1, .corners = pg_element_types[cells->facet_kind[f]].corners };
    for (int i = 0; i < c->corners; i++)
        for (size_t k = 0; k < dim; k++) c->corner[3 * i + (int) k] = x[(size_t) i * dim + k] + 0.0;
    pg_sort (c->corner, (size_t) c->corners, 3 * sizeof *c->corner, compare_places);
}

/* Sets partner[at] to the number of the same face of the other cell, or to -1 on the boundary (n faces).
 * Where a facet of the boundary lies at the same position, as along a seam of duplicated nodes, two faces are
 * not paired. */
static pg_status pair_up (long *partner, size_t n, const pg_cells *cells)
{
    pg_status status = PG_OK;
    candidate *all = NULL;
    size_t at = 0;
    PG_ALLOC (all, n + cells->nfacet);
    for (size_t c = 0; c < cells->n; c++)
        for (int f = 0; f < faces_of (cells, c); f++, at++) describe (&all[at], cells, at, (int) c, f);
    for (size_t f = 0; f < cells->nfacet; f++)
        if (cells->facet_kind[f] != PG_CUT) describe_facet (&all[at], cells, at, f), at++;
    pg_sort (all, at, sizeof *all, compare);
    for (size_t i = 0; i < n; i++) partner[i] = -1;
    for (size_t i = 0, end = 0; i < at; i = end) {
        for (end = i + 1; end < at && !compare_corners (&all[i], &all[end]); end++) continue;
        if (end - i < 2 || all[end - 1].cell < 0) continue;      /* facets come last */
        partner[all[i].at] = (long) all[i + 1].at, partner[all[i + 1].at] = (long) all[i].at;
    }
done:
    pg_free (all);
    return status;
}

/* ---- points -------------------------------------------------------------------------------------------- */
/* The faces while they are built. */
typedef struct { pg_faces *out; size_t cap_x, cap_flux; const pg_cells *cells; int order; } builder;

/* Appends a quadrature point to the present face. */
static pg_status add_point (builder *b, const double *x, double weight, const double *normal)
{
    pg_status status = PG_OK;
    size_t dim = (size_t) b->out->dim;
    PG_GROW (b->out->x, b->cap_x, (b->out->npoint + 1) * dim);
    PG_GROW (b->out->flux, b->cap_flux, (b->out->npoint + 1) * dim);
    for (size_t k = 0; k < dim; k++)
        b->out->x[b->out->npoint * dim + k] = x[k],
                                         b->out->flux[b->out->npoint * dim + k] = weight * normal[k];
    b->out->npoint++;
done:
    return status;
}

/* Points on a whole face, by the rule of its element; thickness enters the weights. */
static pg_status whole_face (builder *b, size_t cell, int side)
{
    pg_status status = PG_OK;
    const pg_cells *cells = b->cells;
    size_t dim = (size_t) cells->dim;
    double xi[3 * PG_ELEMENT_POINTS], w[PG_ELEMENT_POINTS], place[27], x[3], normal[3];
    int node[9];
    const double *corner = cells->x + cells->start[cell] * dim;
    pg_element face = pg_element_face (kind_of (cells, cell), side, node);
    int n = pg_element_rule (face, b->order, xi, w), d = pg_element_types[face].dim;
    for (int i = 0; i < pg_element_types[face].nodes; i++)
        memcpy (place + (size_t) i * dim, corner + (size_t) node[i] * dim, dim * sizeof *corner);
    for (int q = 0; q < n; q++) {
        double size = pg_element_map (face, cells->dim, place, xi + q * d, x, normal);
        if (dim == 1) normal[0] = side ? 1 : -1;
        PG_TRY (add_point (b, x, w[q] * size * cells->thickness, normal));
    }
done:
    return status;
}

/* Points on the part of a face of a cut cell that has the body on both sides. Exodus numbers the sides of
 * quadrilaterals and hexahedra -y +x +y -x -z +z; the lattice -x +x -y +y -z +z. */
static pg_status cut_face (builder *b, size_t cell, int side)
{
    static const int lattice_side[] = { 2, 1, 3, 0, 4, 5 };
    pg_status status = PG_OK;
    pg_cut_points p = { 0 };
    double normal[3] = { 0, 0, 0 };
    int face = lattice_side[side];
    normal[face / 2] = face % 2 ? 1 : -1;
    PG_TRY (pg_cut_face (&p, b->cells, cell, face, b->order));
    for (size_t q = 0; q < p.n; q++)
        PG_TRY (add_point (b, p.x + q * (size_t) b->out->dim, p.weight[q], normal));
done:
    pg_cut_points_clear (&p);
    return status;
}

/* Ends the present face: its points are those appended since the last one ended. */
static void close_face (pg_faces *out, int cell, int other)
{
    out->cell[2 * out->n] = cell, out->cell[2 * out->n + 1] = other;
    out->start[++out->n] = out->npoint;
}

/* Appends the faces between two cells, with points on the side of the first of the two. */
static pg_status add_inner (builder *b, const long *partner, const int *owner)
{
    pg_status status = PG_OK;
    const pg_cells *cells = b->cells;
    size_t at = 0;
    for (size_t c = 0; c < cells->n; c++)
        for (int f = 0; f < faces_of (cells, c); f++, at++) {
            if (partner[at] < (long) at) continue;
            size_t other = (size_t) owner[partner[at]];
            int cut = cells->kind[c] == PG_CUT || cells->kind[other] == PG_CUT;
            PG_TRY (cut && cells->dim > 1 ? cut_face (b, c, f) : whole_face (b, c, f));
            close_face (b->out, (int) c, (int) other);
        }
done:
    return status;
}

/* Appends the facets of the boundary with the points that loads use as well: the boundary terms of the
 * identity then equal the work of tractions. */
static pg_status add_boundary (builder *b)
{
    pg_status status = PG_OK;
    pg_quadrature q = { 0 };
    size_t dim = (size_t) b->out->dim, k = 0;
    PG_TRY (pg_facet_points (&q, b->cells, b->order));
    for (size_t f = 0; f < b->cells->nfacet; f++) {
        for (; k < q.n && q.cell[k] == (int) f; k++)
            PG_TRY (add_point (b, q.x + k * dim, q.weight[k], q.normal + k * dim));
        close_face (b->out, b->cells->facet_cell[f], -1);
    }
done:
    pg_quadrature_clear (&q);
    return status;
}

/* Lists the faces of each cell, ascending, in compressed rows. */
static pg_status sort_faces (pg_faces *out, size_t cells)
{
    pg_status status = PG_OK;
    size_t *next = NULL;
    PG_ALLOC (out->of, cells + 1);
    PG_ALLOC (out->face, 2 * out->n);
    PG_ALLOC (next, cells);
    for (size_t k = 0; k < 2 * out->n; k++) if (out->cell[k] >= 0) out->of[out->cell[k] + 1]++;
    for (size_t c = 0; c < cells; c++) out->of[c + 1] += out->of[c], next[c] = out->of[c];
    for (size_t k = 0; k < 2 * out->n; k++)
        if (out->cell[k] >= 0) out->face[next[out->cell[k]]++] = (int) (k / 2);
done:
    pg_free (next);
    return status;
}

/* Faces are paired first, because their number decides how much memory is needed. */
pg_status pg_faces_build (pg_faces *out, const pg_cells *cells, int order)
{
    pg_status status = PG_OK;
    size_t n = 0, at = 0, inner = 0;
    long *partner = NULL;
    int *owner = NULL;
    builder b = { .out = out, .cells = cells, .order = order };
    *out = (pg_faces) { .dim = cells->dim };
    for (size_t c = 0; c < cells->n; c++) n += (size_t) faces_of (cells, c);
    PG_ALLOC (partner, n);
    PG_ALLOC (owner, n);
    for (size_t c = 0; c < cells->n; c++) for (int f = 0; f < faces_of (cells, c); f++) owner[at++] = (int) c;
    PG_TRY (pair_up (partner, n, cells));
    for (size_t k = 0; k < n; k++) inner += partner[k] > (long) k;
    PG_ALLOC (out->cell, 2 * (inner + cells->nfacet));
    PG_ALLOC (out->start, inner + cells->nfacet + 1);
    PG_TRY (add_inner (&b, partner, owner));
    PG_TRY (add_boundary (&b));
    PG_TRY (sort_faces (out, cells->n));
done:
    pg_free (partner), pg_free (owner);
    if (status != PG_OK) pg_faces_clear (out);
    return status;
}

void pg_faces_clear (pg_faces *f)
{
    pg_free (f->x), pg_free (f->flux), pg_free (f->start), pg_free (f->cell), pg_free (f->of),
        pg_free (f->face);
    *f = (pg_faces) { 0 };
}
