/* SPDX-License-Identifier: GPL-3.0-or-later
 * Background cells from a lattice without cutting: each kept box is a cell, each of its faces that borders
 * on no kept box is a facet with an outward normal. Their order is that of the lattice, x fastest, so that
 * facets of one cell follow one another. Also allocation and release of pg_cells, whatever built them. */
#include "cut.h"
#include <limits.h>
#include <string.h>

/* Corners in Exodus order as steps along x, y, z. */
static const unsigned char corner[8][3] = { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 },
                                            { 0, 0, 1 }, { 1, 0, 1 }, { 1, 1, 1 }, { 0, 1, 1 } };
/* Corners of the faces -x +x -y +y -z +z, by dimension, counter-clockwise seen from outside. */
static const unsigned char face[3][6][4] = {
    {{0}, {1}},
    {{3,0}, {1,2}, {0,1}, {2,3}},
    {{0,4,7,3}, {1,2,6,5}, {0,1,5,4}, {3,7,6,2}, {0,3,2,1}, {4,5,6,7}},
};

/* Is lattice cell i within the lattice and its centre in the body? Cells beyond the lattice of this rank that
 * other ranks hold count as kept: the end of a subdomain is no surface of the body. */
static int kept (const pg_lattice *l, const int *i)
{
    for (int k = 0; k < 3; k++)
        if (i[k] < 0 || i[k] >= l->count[k]) return l->whole[0] && pg_lattice_goes_on (l, i);
    return l
        ->in[((size_t) i[2] * (size_t) l->count[1] + (size_t) i[1]) * (size_t) l->count[0] + (size_t) i[0]];
}

/* Is face f of cell i part of the boundary? */
static int open_face (const pg_lattice *l, const int *i, int f)
{
    int beside[3] = {i[0], i[1], i[2]};
    beside[f / 2] += f % 2 ? 1 : -1;
    return !kept (l, beside);
}

/* Position (m) of corner c of cell i. */
static void corner_at (const pg_lattice *l, const int *i, int c, double *x)
{
    for (int k = 0; k < l->dim; k++) x[k] = pg_lattice_at (l, k, i[k] + corner[c][k]);
}

/* Is lattice cell i kept, and within the box `within` (indices in the whole lattice; NULL: no limit)? */
static int wanted (const pg_lattice *l, const int *i, const pg_box *within)
{
    for (int k = 0; within && k < l->dim; k++)
        if (i[k] + l->first[k] < within->low[k] || i[k] + l->first[k] >= within->high[k]) return 0;
    return kept (l, i);
}

/* Counts cells and facets, so that arrays can be allocated before they are filled. */
static void count (size_t *n, size_t *nfacet, const pg_lattice *l, const pg_box *within)
{
    int i[3];
    for (i[2] = 0; i[2] < l->count[2]; i[2]++)
        for (i[1] = 0; i[1] < l->count[1]; i[1]++)
            for (i[0] = 0; i[0] < l->count[0]; i[0]++) {
                if (!wanted (l, i, within)) continue;
                ++*n;
                for (int f = 0; f < 2 * l->dim; f++) *nfacet += (size_t) open_face (l, i, f);
            }
}

/* Writes nodes, kind and volume of lattice cell i as cell `at`. */
static void put_cell (pg_cells *out, size_t at, const pg_lattice *l, const int *i)
{
    static const pg_element kind[3] = {PG_BAR2, PG_QUAD4, PG_HEX8};
    size_t dim = (size_t) l->dim, corners = (size_t) 1 << dim;
    for (size_t c = 0; c < corners; c++) corner_at (l, i, (int) c, out->x + (at * corners + c) * dim);
    out->kind[at] = (unsigned char) kind[dim - 1];
    out->start[at + 1] = (at + 1) * corners;
    out->volume[at] = out->thickness;
    for (size_t k = 0; k < dim; k++) out->volume[at] *= l->step[k];
}

void cells_put_face (pg_cells *out, size_t at, int f, const double *step)
{
    static const pg_element kind[3] = {PG_POINT1, PG_BAR2, PG_QUAD4};
    size_t dim = (size_t) out->dim, corners = (size_t) 1 << (dim - 1);
    const double *cell = out->x + out->start[out->facet_cell[at]] * dim;
    double *x = out->facet_x + out->facet_start[at] * dim, *centre = out->facet_centre + at * dim,
           area = out->thickness;
    for (int k = 0; k < out->dim; k++) if (k != f / 2) area *= step[k];
    for (size_t c = 0; c < corners; c++)
        memcpy (x + c * dim, cell + face[dim - 1][f][c] * dim, dim * sizeof *x);
    for (size_t k = 0; k < dim; k++) {
        for (size_t c = 0; c < corners; c++) centre[k] += x[c * dim + k];
        centre[k] /= (double) corners;
    }
    out->facet_kind[at] = (unsigned char) kind[dim - 1];
    out->facet_start[at + 1] = out->facet_start[at] + corners;
    out->normal[at * dim + (size_t) f / 2] = f % 2 ? 1 : -1;
    out->area[at] = area;
}

/* Writes face f of cell number `cell` as facet `at`. */
static void put_facet (pg_cells *out, size_t at, const pg_lattice *l, int f, size_t cell)
{
    out->facet_cell[at] = (int) cell, out->facet_surface[at] = -1;
    cells_put_face (out, at, f, l->step);
}

/* Writes the cells wanted and their facets, in the order in which `count` counts them. */
static void fill (pg_cells *out, const pg_lattice *l, const pg_box *within)
{
    size_t cell = 0, facet = 0;
    int i[3];
    for (i[2] = 0; i[2] < l->count[2]; i[2]++)
        for (i[1] = 0; i[1] < l->count[1]; i[1]++)
            for (i[0] = 0; i[0] < l->count[0]; i[0]++) {
                if (!wanted (l, i, within)) continue;
                put_cell (out, cell, l, i);
                for (int f = 0; f < 2 * l->dim; f++)
                    if (open_face (l, i, f)) put_facet (out, facet++, l, f, cell);
                cell++;
            }
}

pg_status pg_cells_reserve (pg_cells *out, int dim, double thickness, size_t n, size_t nx, size_t nfacet,
                            size_t nfx)
{
    pg_status status = PG_OK;
    size_t d = (size_t) dim;
    memset (out, 0, sizeof *out);
    if (n > INT_MAX || nfacet > INT_MAX)
        PG_FAIL (PG_E_LIMIT, "%zu cells with %zu facets are too many", n, nfacet);
    PG_ALLOC (out->kind, n);
    PG_ALLOC (out->start, n + 1);
    PG_ALLOC (out->x, nx * d);
    PG_ALLOC (out->volume, n);
    PG_ALLOC (out->block, n);
    PG_ALLOC (out->facet_kind, nfacet);
    PG_ALLOC (out->facet_start, nfacet + 1);
    PG_ALLOC (out->facet_x, nfx * d);
    PG_ALLOC (out->facet_centre, nfacet * d);
    PG_ALLOC (out->normal, nfacet * d);
    PG_ALLOC (out->area, nfacet);
    PG_ALLOC (out->facet_cell, nfacet);
    PG_ALLOC (out->facet_surface, nfacet);
    out->dim = dim, out->n = n, out->nfacet = nfacet;
    out->thickness = dim == 3 ? 1 : thickness;
done:
    if (status != PG_OK) pg_cells_clear (out);
    return status;
}

/* The numbers of nodes follow from 2^dim corners of a box and half as many of a face. */
pg_status pg_cells_from_part (pg_cells *out, const pg_lattice *lattice, double thickness,
                              const pg_box *within)
{
    size_t n = 0, nfacet = 0, corners = (size_t) 1 << lattice->dim;
    memset (out, 0, sizeof *out);
    /* Points from a file have no lattice. */
    if (lattice->dim == 0) return PG_OK;
    count (&n, &nfacet, lattice, within);
    pg_status status = pg_cells_reserve (out, lattice->dim, thickness, n, n * corners, nfacet,
                                         nfacet * corners / 2);
    if (status == PG_OK) fill (out, lattice, within);
    return status;
}

pg_status pg_cells_from_lattice (pg_cells *out, const pg_lattice *lattice, double thickness)
{
    return pg_cells_from_part (out, lattice, thickness, NULL);
}

void pg_cells_clear (pg_cells *c)
{
    pg_free (c->kind), pg_free (c->start), pg_free (c->x), pg_free (c->volume), pg_free (c->block);
    pg_free (c->facet_kind), pg_free (c->facet_start), pg_free (c->facet_x), pg_free (c->facet_centre);
    cut_free (c->cut);
    pg_free (c->normal), pg_free (c->area), pg_free (c->facet_cell), pg_free (c->facet_surface),
        pg_free (c->facet_point);
    for (size_t i = 0; i < c->ngiven; i++) pg_free (c->given[i].point), pg_free (c->given[i].facet);
    pg_free (c->given), pg_free (c->owned), pg_free (c->number);
    memset (c, 0, sizeof *c);
}
