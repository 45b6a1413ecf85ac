/* SPDX-License-Identifier: GPL-3.0-or-later
 * Background cells of the kept lattice cells, and the facets between a kept cell and none, with outward normals. */
#include "perigal/cells.h"
#include <limits.h>
#include <string.h>

/* Corners in Exodus order as steps along x, y, z. */
static const unsigned char corner[8][3] = {{0,0,0}, {1,0,0}, {1,1,0}, {0,1,0}, {0,0,1}, {1,0,1}, {1,1,1}, {0,1,1}};
/* Corners of the faces -x +x -y +y -z +z, by dimension, counter-clockwise seen from outside. */
static const unsigned char face[3][6][4] = {
    {{0}, {1}},
    {{3,0}, {1,2}, {0,1}, {2,3}},
    {{0,4,7,3}, {1,2,6,5}, {0,1,5,4}, {3,7,6,2}, {0,3,2,1}, {4,5,6,7}},
};

static int kept (const pg_lattice *l, const int *i)
{
    for (int k = 0; k < 3; k++) if (i[k] < 0 || i[k] >= l->count[k]) return 0;
    return l->in[((size_t) i[2] * (size_t) l->count[1] + (size_t) i[1]) * (size_t) l->count[0] + (size_t) i[0]];
}

static int open_face (const pg_lattice *l, const int *i, int f)
{
    int beside[3] = {i[0], i[1], i[2]};
    beside[f / 2] += f % 2 ? 1 : -1;
    return !kept (l, beside);
}

static void corner_at (const pg_lattice *l, const int *i, int c, double *x)
{
    for (int k = 0; k < l->dim; k++) x[k] = pg_lattice_at (l, k, i[k] + corner[c][k]);
}

static void count (pg_cells *out, const pg_lattice *l)
{
    int i[3];
    for (i[2] = 0; i[2] < l->count[2]; i[2]++)
        for (i[1] = 0; i[1] < l->count[1]; i[1]++)
            for (i[0] = 0; i[0] < l->count[0]; i[0]++) {
                if (!kept (l, i)) continue;
                out->n++;
                for (int f = 0; f < 2 * l->dim; f++) out->nfacet += (size_t) open_face (l, i, f);
            }
}

static void put_facet (pg_cells *out, size_t at, const pg_lattice *l, const int *i, int f, double thickness, size_t cell)
{
    size_t dim = (size_t) l->dim, corners = (size_t) out->facet_corners;
    double area = l->dim == 3 ? 1 : thickness;
    for (int k = 0; k < l->dim; k++) if (k != f / 2) area *= l->step[k];
    for (size_t c = 0; c < corners; c++) corner_at (l, i, face[dim - 1][f][c], out->facet_x + (at * corners + c) * dim);
    out->normal[at * dim + (size_t) f / 2] = f % 2 ? 1 : -1;
    out->area[at] = area;
    out->facet_cell[at] = (int) cell;
}

static void fill (pg_cells *out, const pg_lattice *l, double thickness)
{
    size_t cell = 0, facet = 0, dim = (size_t) l->dim, corners = (size_t) out->corners;
    int i[3];
    for (i[2] = 0; i[2] < l->count[2]; i[2]++)
        for (i[1] = 0; i[1] < l->count[1]; i[1]++)
            for (i[0] = 0; i[0] < l->count[0]; i[0]++) {
                if (!kept (l, i)) continue;
                for (size_t c = 0; c < corners; c++) corner_at (l, i, (int) c, out->x + (cell * corners + c) * dim);
                for (int f = 0; f < 2 * l->dim; f++)
                    if (open_face (l, i, f)) put_facet (out, facet++, l, i, f, thickness, cell);
                cell++;
            }
}

pg_status pg_cells_from_lattice (pg_cells *out, const pg_lattice *lattice, double thickness)
{
    pg_status status = PG_OK;
    memset (out, 0, sizeof *out);
    out->dim = lattice->dim;
    if (lattice->dim == 0) return PG_OK;                   /* points from a file: no cells */
    size_t dim = (size_t) lattice->dim, corners = (size_t) 1 << dim, per_facet = corners / 2;
    out->corners = (int) corners, out->facet_corners = (int) per_facet;
    count (out, lattice);
    if (out->n > INT_MAX || out->nfacet > INT_MAX) PG_FAIL (PG_E_LIMIT, "%zu cells with %zu facets are too many", out->n, out->nfacet);
    PG_ALLOC (out->x, out->n * corners * dim);
    PG_ALLOC (out->facet_x, out->nfacet * per_facet * dim);
    PG_ALLOC (out->normal, out->nfacet * dim);
    PG_ALLOC (out->area, out->nfacet);
    PG_ALLOC (out->facet_cell, out->nfacet);
    fill (out, lattice, thickness);
done:
    if (status != PG_OK) pg_cells_clear (out);
    return status;
}

void pg_cells_clear (pg_cells *cells)
{
    pg_free (cells->x);
    pg_free (cells->facet_x);
    pg_free (cells->normal);
    pg_free (cells->area);
    pg_free (cells->facet_cell);
    memset (cells, 0, sizeof *cells);
}
