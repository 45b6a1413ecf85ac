/* SPDX-License-Identifier: GPL-3.0-or-later
 * Cells of a rank where a body that stands on no lattice is divided among ranks (perigal/ranks.h): of all
 * cells of the body, those around the points that the rank owns. A cell belongs to the rank that owns the
 * point nearest to its middle; every rank has read all points and finds the same. */
#include "cut.h"
#include <math.h>
#include <string.h>

/* State while cells are chosen and copied. */
typedef struct {
    const pg_cells *from;
    const pg_cloud *whole;
    /* owned: of each cell: does this rank own it? cell (from->n), point (whole->n), facet (from->nfacet):
     * number on this rank of each cell, point and facet of the whole body, -1: not kept. */
    unsigned char *owned;
    int *cell, *point, *facet;
    /* Numbers of cells kept, of their nodes, of facets kept and of their nodes. */
    size_t n, nx, nfacet, nfx;
} choice;

/* ---- choice of cells ----------------------------------------------------------------------------------- */
/* Bounding box of the points that this rank owns, widened by `reach` (m). */
static void region_of (const pg_cloud *c, const int *owner, double reach, double *low, double *high)
{
    for (int k = 0; k < c->dim; k++) low[k] = INFINITY, high[k] = -INFINITY;
    for (size_t i = 0; i < c->n; i++)
        for (int k = 0; k < c->dim && owner[i] == pg_rank (); k++) {
            double x = c->x[i * (size_t) c->dim + (size_t) k];
            low[k] = fmin (low[k], x - reach), high[k] = fmax (high[k], x + reach);
        }
}

/* Does the box of the nodes of a cell meet the region? middle: mean position of the nodes, m. */
static int meets (const pg_cells *c, size_t cell, const double *low, const double *high, double *middle)
{
    int yes = 1;
    for (size_t k = 0, dim = (size_t) c->dim; k < dim; k++) {
        double least = INFINITY, most = -INFINITY;
        middle[k] = 0;
        for (size_t v = c->start[cell]; v < c->start[cell + 1]; v++) {
            double x = c->x[v * dim + k];
            least = fmin (least, x), most = fmax (most, x);
            middle[k] += x / (double) (c->start[cell + 1] - c->start[cell]);
        }
        yes = yes && most >= low[k] && least <= high[k];
    }
    return yes;
}

static pg_status choose (choice *w, const int *owner, double reach)
{
    pg_status status = PG_OK;
    const pg_cells *c = w->from;
    pg_nearest *near = NULL;
    double low[3], high[3], middle[3];
    PG_ALLOC (w->owned, c->n);
    PG_ALLOC (w->cell, c->n);
    PG_ALLOC (w->facet, c->nfacet);
    PG_TRY (pg_nearest_create (&near, c->dim, w->whole->n, w->whole->x));
    region_of (w->whole, owner, reach, low, high);
    for (size_t e = 0; e < c->n; e++) {
        int in = meets (c, e, low, high, middle);
        long i = pg_nearest_find (near, middle, NULL, NULL);
        w->owned[e] = i >= 0 && owner[i] == pg_rank ();
        w->cell[e] = in || w->owned[e] ? (int) w->n++ : -1;
        if (w->cell[e] >= 0) w->nx += c->start[e + 1] - c->start[e];
    }
    for (size_t f = 0; f < c->nfacet; f++) {
        w->facet[f] = w->cell[c->facet_cell[f]] >= 0 ? (int) w->nfacet++ : -1;
        if (w->facet[f] >= 0) w->nfx += c->facet_start[f + 1] - c->facet_start[f];
    }
done:
    pg_nearest_free (&near);
    return status;
}

/* Finds the number on this rank of each point of the whole body, -1: the rank does not hold it. */
static pg_status number_points (choice *w)
{
    pg_status status = PG_OK;
    const pg_subdomain *s = w->whole->subdomain;
    PG_ALLOC (w->point, w->whole->n);
    for (size_t i = 0; i < w->whole->n; i++) w->point[i] = -1;
    for (size_t i = 0; i < s->n; i++) w->point[s->number[i]] = (int) i;
done:
    return status;
}

/* ---- copying what is kept ------------------------------------------------------------------------------ */
static pg_status copy_cells (pg_cells *out, const choice *w)
{
    pg_status status = PG_OK;
    const pg_cells *c = w->from;
    size_t dim = (size_t) c->dim;
    PG_ALLOC (out->owned, w->n);
    PG_ALLOC (out->number, w->n);
    for (size_t e = 0; e < c->n; e++) {
        if (w->cell[e] < 0) continue;
        size_t k = (size_t) w->cell[e], nodes = c->start[e + 1] - c->start[e];
        out->kind[k] = c->kind[e], out->volume[k] = c->volume[e], out->block[k] = c->block[e];
        out->owned[k] = w->owned[e], out->number[k] = (int64_t) e;
        out->start[k + 1] = out->start[k] + nodes;
        memcpy (out->x + out->start[k] * dim, c->x + c->start[e] * dim, nodes * dim * sizeof *c->x);
    }
done:
    return status;
}

static pg_status copy_facets (pg_cells *out, const choice *w)
{
    pg_status status = PG_OK;
    const pg_cells *c = w->from;
    size_t dim = (size_t) c->dim;
    if (c->facet_point) PG_ALLOC (out->facet_point, w->nfx);
    for (size_t f = 0; f < c->nfacet; f++) {
        if (w->facet[f] < 0) continue;
        size_t k = (size_t) w->facet[f], first = c->facet_start[f], nodes = c->facet_start[f + 1] - first;
        out->facet_kind[k] = c->facet_kind[f], out->area[k] = c->area[f];
        out->facet_cell[k] = w->cell[c->facet_cell[f]], out->facet_surface[k] = c->facet_surface[f];
        memcpy (out->facet_centre + k * dim, c->facet_centre + f * dim, dim * sizeof *c->facet_centre);
        memcpy (out->normal + k * dim, c->normal + f * dim, dim * sizeof *c->normal);
        out->facet_start[k + 1] = out->facet_start[k] + nodes;
        memcpy (out->facet_x + out->facet_start[k] * dim, c->facet_x + first * dim,
                nodes * dim * sizeof *c->facet_x);
        for (size_t i = 0; c->facet_point && i < nodes; i++) {
            int p = c->facet_point[first + i];
            out->facet_point[out->facet_start[k] + i] = p < 0 ? -1 : w->point[p];
        }
    }
done:
    return status;
}

/* Reduces to the kept cells and facets, in place: the surfaces near each cell and the part of each facet. */
static void keep_cut (struct pg_cut *cut, const choice *w)
{
    size_t at = 0;
    for (size_t e = 0; e < w->from->n; e++) {
        if (w->cell[e] < 0) continue;
        size_t k = (size_t) w->cell[e], first = cut->start[e], count = cut->start[e + 1] - first;
        memmove (cut->near + at, cut->near + first, count * sizeof *cut->near);
        cut->start[k] = at, at += count;
    }
    cut->start[w->n] = at;
    for (size_t f = 0; f < w->from->nfacet; f++) if (w->facet[f] >= 0) cut->part[w->facet[f]] = cut->part[f];
}

/* Replaces the numbers in a list by those on this rank and drops those not kept; both ascend. */
static void keep_numbers (int *list, size_t *n, const int *number)
{
    size_t kept = 0;
    for (size_t k = 0; k < *n; k++) if (number[list[k]] >= 0) list[kept++] = number[list[k]];
    *n = kept;
}

pg_status pg_cells_keep (pg_cells *cells, const pg_cloud *whole, const int *owner, double reach)
{
    pg_status status = PG_OK;
    choice w = { .from = cells, .whole = whole };
    pg_cells out = { 0 };
    PG_TRY (choose (&w, owner, reach));
    PG_TRY (number_points (&w));
    PG_TRY (pg_cells_reserve (&out, cells->dim, cells->thickness, w.n, w.nx, w.nfacet, w.nfx));
    PG_TRY (copy_cells (&out, &w));
    PG_TRY (copy_facets (&out, &w));
    if (cells->cut) keep_cut (cells->cut, &w);
    for (size_t i = 0; i < cells->ngiven; i++) {
        keep_numbers (cells->given[i].point, &cells->given[i].npoint, w.point);
        keep_numbers (cells->given[i].facet, &cells->given[i].nfacet, w.facet);
    }
    out.given = cells->given, out.ngiven = cells->ngiven, out.cut = cells->cut;
    out.cut_order = cells->cut_order, out.unsettled = cells->unsettled, out.given_up = cells->given_up;
    cells->given = NULL, cells->ngiven = 0, cells->cut = NULL;
    pg_cells_clear (cells);
    *cells = out, memset (&out, 0, sizeof out);
done:
    pg_cells_clear (&out);
    pg_free (w.owned), pg_free (w.cell), pg_free (w.point), pg_free (w.facet);
    return status;
}
