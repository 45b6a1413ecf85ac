/* SPDX-License-Identifier: GPL-3.0-or-later
 * Which points carry a load: the force on a facet goes to the points nearest to its centre, in equal parts to those equally near; a total force to
 * all points of its set alike; a force per volume to every point by its volume. */
#include "nodal.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct { nodal_load *out; size_t cap, cap_point; int *index; } gathering;     /* index: of each point, -1: not yet  */

static pg_status add_part (gathering *g, int point, nodal_part part)
{
    pg_status status = PG_OK;
    nodal_load *l = g->out;
    PG_GROW (l->part, g->cap, l->npart + 1);
    if (g->index[point] < 0) {
        PG_GROW (l->point, g->cap_point, l->npoint + 1);
        g->index[point] = (int) l->npoint;
        l->point[l->npoint++] = point;
    }
    part.at = (size_t) point;                          /* the point itself until all are there                           */
    l->part[l->npart++] = part;
done:
    return status;
}

static int ascending (const void *a, const void *b) { return *(const int *) a - *(const int *) b; }

/* ---- facets -------------------------------------------------------------------------------------------------------------------- */
static double distance (const double *a, const double *b, int dim)
{
    double sum = 0;
    for (int k = 0; k < dim; k++) sum += (a[k] - b[k]) * (a[k] - b[k]);
    return sqrt (sum);
}

enum { MOST_TIES = 16 };

/* Points as near to a facet's centre as the nearest one, to a millionth of the spacing; others are refused until only they are left. */
typedef struct { const int *found; size_t n; } known;

static int is_known (void *context, const double *place, size_t point)
{
    const known *k = context;
    (void) place;
    for (size_t i = 0; i < k->n; i++) if (k->found[i] == (int) point) return 1;
    return 0;
}

static size_t nearest_points (const nodal *s, const pg_nearest *grid, const double *centre, int *found)
{
    const pg_cloud *c = &s->problem->cloud;
    known k = { found, 0 };
    double first = 0;
    while (k.n < MOST_TIES) {
        long j = pg_nearest_find (grid, centre, is_known, &k);
        if (j < 0) break;
        double away = distance (centre, c->x + (size_t) j * (size_t) s->dim, s->dim);
        if (k.n == 0) first = away;
        else if (away > first + 1e-6 * c->h) break;
        found[k.n++] = (int) j;
    }
    return k.n;
}

static int member (const int *list, size_t n, int value)
{
    return n && bsearch (&value, list, n, sizeof *list, ascending) != NULL;
}

static pg_status facet_parts (gathering *g, const nodal *s, const pg_load *load)
{
    pg_status status = PG_OK;
    const pg_cells *cells = &s->problem->cells;
    pg_quadrature q = { 0 };
    pg_nearest *grid = NULL;
    size_t dim = (size_t) s->dim, count = 0;
    int found[MOST_TIES], of = -1;
    PG_TRY (pg_nearest_create (&grid, s->dim, s->n, s->problem->cloud.x));
    PG_TRY (pg_facet_points (&q, cells, 2));
    for (size_t i = 0; i < q.n; i++) {
        if (!member (load->set->facet, load->set->nfacet, q.cell[i])) continue;
        if (of != q.cell[i]) count = nearest_points (s, grid, cells->facet_centre + (size_t) q.cell[i] * dim, found), of = q.cell[i];
        nodal_part part = { .weight = q.weight[i] / (double) count };
        memcpy (part.x, q.x + i * dim, dim * sizeof *part.x);
        memcpy (part.normal, q.normal + i * dim, dim * sizeof *part.normal);
        for (size_t k = 0; k < count; k++) PG_TRY (add_part (g, found[k], part));
    }
done:
    pg_nearest_free (&grid);
    pg_quadrature_clear (&q);
    return status;
}

/* ---- points -------------------------------------------------------------------------------------------------------------------- */
static pg_status point_parts (gathering *g, const nodal *s, const pg_load *load)
{
    pg_status status = PG_OK;
    const pg_cloud *c = &s->problem->cloud;
    for (size_t i = 0; i < load->set->npoint; i++) {
        int j = load->set->point[i];
        nodal_part part = { .weight = load->kind == PG_BODY_FORCE ? c->volume[j] : 1 / (double) load->set->npoint };
        memcpy (part.x, c->x + (size_t) j * (size_t) s->dim, (size_t) s->dim * sizeof *part.x);
        PG_TRY (add_part (g, j, part));
    }
done:
    return status;
}

pg_status nodal_parts (nodal_load *out, const nodal *s, int load)
{
    pg_status status = PG_OK;
    const pg_load *l = &s->problem->load[load];
    gathering g = { .out = out };
    PG_ALLOC (g.index, s->n);
    for (size_t i = 0; i < s->n; i++) g.index[i] = -1;
    if (l->kind == PG_TRACTION || l->kind == PG_PRESSURE) PG_TRY (facet_parts (&g, s, l));
    else PG_TRY (point_parts (&g, s, l));
    if (out->npoint) qsort (out->point, out->npoint, sizeof *out->point, ascending);
    for (size_t k = 0; k < out->npoint; k++) g.index[out->point[k]] = (int) k;
    for (size_t k = 0; k < out->npart; k++) out->part[k].at = (size_t) g.index[out->part[k].at];
done:
    pg_free (g.index);
    return status;
}
