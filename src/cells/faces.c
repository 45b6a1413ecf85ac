/* SPDX-License-Identifier: GPL-3.0-or-later
 * The faces between cells and on the boundary, each once, with points and normals: what the divergence identity of consistent
 * integration needs. A face is known by its corners, which cells that share nodes hold with the same bits. */
#include "perigal/cells.h"
#include <stdlib.h>
#include <string.h>

typedef struct {
    size_t at;                                         /* which face of which cell, counted cell by cell                 */
    int    cell, side, corners;
    double corner[12];                                 /* sorted                                                         */
} candidate;

static int compare_places (const void *a, const void *b)
{
    const double *x = a, *y = b;
    for (int k = 0; k < 3; k++) if (x[k] != y[k]) return x[k] < y[k] ? -1 : 1;
    return 0;
}

static int compare_corners (const candidate *c, const candidate *d)
{
    if (c->corners != d->corners) return c->corners < d->corners ? -1 : 1;
    for (int k = 0; k < 3 * c->corners; k++) if (c->corner[k] != d->corner[k]) return c->corner[k] < d->corner[k] ? -1 : 1;
    return 0;
}

static int compare (const void *a, const void *b)
{
    const candidate *c = a, *d = b;
    int order = compare_corners (c, d);
    return order ? order : c->at < d->at ? -1 : 1;
}

static void describe (candidate *c, const pg_cells *cells, size_t at, int cell, int side)
{
    size_t dim = (size_t) cells->dim;
    int node[9];
    const double *x = cells->x + cells->start[cell] * dim;
    pg_element face = pg_element_face ((pg_element) cells->kind[cell], side, node);
    *c = (candidate) { .at = at, .cell = cell, .side = side, .corners = pg_element_types[face].corners };
    for (int i = 0; i < c->corners; i++)
        for (size_t k = 0; k < dim; k++) c->corner[3 * i + (int) k] = x[(size_t) node[i] * dim + k] + 0.0;      /* no -0 */
    qsort (c->corner, (size_t) c->corners, 3 * sizeof *c->corner, compare_places);
}

/* partner[at]: the same face of the other cell, or -1 */
static pg_status pair_up (long *partner, size_t n, const pg_cells *cells)
{
    pg_status status = PG_OK;
    candidate *all = NULL;
    size_t at = 0;
    PG_ALLOC (all, n);
    for (size_t c = 0; c < cells->n; c++)
        for (int f = 0; f < pg_element_types[cells->kind[c]].faces; f++, at++) describe (&all[at], cells, at, (int) c, f);
    qsort (all, n, sizeof *all, compare);
    for (size_t i = 0; i < n; i++) partner[i] = -1;
    for (size_t i = 0; i + 1 < n; i++) {
        if (compare_corners (&all[i], &all[i + 1])) continue;
        partner[all[i].at] = (long) all[i + 1].at, partner[all[i + 1].at] = (long) all[i].at;
        i++;
    }
done:
    pg_free (all);
    return status;
}

/* Appends the points of a face of a cell. */
static pg_status add_points (pg_faces *out, size_t *cap_x, size_t *cap_flux, const pg_cells *cells, size_t cell, int side, int order)
{
    pg_status status = PG_OK;
    size_t dim = (size_t) cells->dim;
    double xi[3 * PG_ELEMENT_POINTS], w[PG_ELEMENT_POINTS], place[27], normal[3];
    int node[9];
    const double *x = cells->x + cells->start[cell] * dim;
    pg_element face = pg_element_face ((pg_element) cells->kind[cell], side, node);
    int n = pg_element_rule (face, order, xi, w), d = pg_element_types[face].dim;
    for (int i = 0; i < pg_element_types[face].nodes; i++) memcpy (place + (size_t) i * dim, x + (size_t) node[i] * dim, dim * sizeof *x);
    PG_GROW (out->x, *cap_x, (out->npoint + (size_t) n) * dim);
    PG_GROW (out->flux, *cap_flux, (out->npoint + (size_t) n) * dim);
    for (int q = 0; q < n; q++, out->npoint++) {
        double size = pg_element_map (face, cells->dim, place, xi + q * d, out->x + out->npoint * dim, normal);
        if (dim == 1) normal[0] = side ? 1 : -1;
        for (size_t k = 0; k < dim; k++) out->flux[out->npoint * dim + k] = w[q] * size * cells->thickness * normal[k];
    }
done:
    return status;
}

pg_status pg_faces_build (pg_faces *out, const pg_cells *cells, int order)
{
    pg_status status = PG_OK;
    size_t n = 0, at = 0, cap_x = 0, cap_flux = 0;
    long *partner = NULL;
    *out = (pg_faces) { .dim = cells->dim };
    for (size_t c = 0; c < cells->n; c++) n += (size_t) pg_element_types[cells->kind[c]].faces;
    PG_ALLOC (partner, n);
    PG_ALLOC (out->of, cells->n + 1);
    PG_ALLOC (out->face, n);
    PG_ALLOC (out->cell, 2 * n);
    PG_ALLOC (out->start, n + 1);
    PG_TRY (pair_up (partner, n, cells));
    for (size_t c = 0; c < cells->n; c++) {
        for (int f = 0; f < pg_element_types[cells->kind[c]].faces; f++, at++) {
            if (partner[at] >= 0 && (size_t) partner[at] < at) {
                out->face[at] = out->face[partner[at]];
                out->cell[2 * out->face[at] + 1] = (int) c;
                continue;
            }
            PG_TRY (add_points (out, &cap_x, &cap_flux, cells, c, f, order));
            out->cell[2 * out->n] = (int) c, out->cell[2 * out->n + 1] = -1;
            out->face[at] = (int) out->n++;
            out->start[out->n] = out->npoint;
        }
        out->of[c + 1] = at;
    }
done:
    pg_free (partner);
    if (status != PG_OK) pg_faces_clear (out);
    return status;
}

void pg_faces_clear (pg_faces *f)
{
    pg_free (f->x), pg_free (f->flux), pg_free (f->start), pg_free (f->cell), pg_free (f->of), pg_free (f->face);
    *f = (pg_faces) { 0 };
}
