/* SPDX-License-Identifier: GPL-3.0-or-later
 * Which points carry a load: the force on a facet goes to the points nearest to its centre, in equal parts to
 * those equally near, or to those of the column below it, by their volumes; a total force to all points of
 * its set alike; a force per volume to every point by its volume. */
#include "point_boundary.h"
#include "perigal/vector.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A load while its points are collected; index: position of each point of the cloud in out->point, -1: not
 * there yet */
typedef struct { boundary_load *out; size_t cap, cap_point; int *index; } gathering;

/* Adds a share of a quadrature point of the load for one point. Points are collected once each in the order
 * in which they come; boundary_shares sorts them when all are there. */
static pg_status add_part (gathering *g, int point, boundary_share part)
{
    pg_status status = PG_OK;
    boundary_load *l = g->out;
    PG_GROW (l->part, g->cap, l->npart + 1);
    if (g->index[point] < 0) {
        PG_GROW (l->point, g->cap_point, l->npoint + 1);
        g->index[point] = (int) l->npoint;
        l->point[l->npoint++] = point;
    }
    part.at = (size_t) point;                     /* number of the point itself until boundary_shares sorts */
    l->part[l->npart++] = part;
done:
    return status;
}

/* ---- facets -------------------------------------------------------------------------------------------- */
enum { MOST_TIES = 16 };

/* The points found so far for a facet, which pg_nearest_find is to skip. */
typedef struct { const int *found; size_t n; } known;

/* Refuses points that have been found already (pg_refuse). */
static int is_known (void *context, const double *place, size_t point)
{
    const known *k = context;
    (void) place;
    for (size_t i = 0; i < k->n; i++) if (k->found[i] == (int) point) return 1;
    return 0;
}

/* All points equally near to a facet's centre, at most MOST_TIES: on a lattice a face has several, and to
 * take one of them would break its symmetry. Returns how many. */
static size_t nearest_points (const point_boundary *s, const pg_nearest *grid, const double *centre,
                              int *found)
{
    const pg_cloud *c = &s->problem->cloud;
    known k = { found, 0 };
    double first = 0;
    while (k.n < MOST_TIES) {
        long j = pg_nearest_find (grid, centre, is_known, &k);
        if (j < 0) break;
        double away = pg_distance (s->dim, centre, c->x + (size_t) j * (size_t) s->dim);
        if (k.n == 0) first = away;
        else if (away > first + 1e-6 * c->h) break;
        found[k.n++] = (int) j;
    }
    return k.n;
}

/* Is value in the ascending list? */
static int member (const int *list, size_t n, int value)
{
    return n && pg_search (&value, list, n, sizeof *list, pg_ascending_ints) != NULL;
}

/* ---- columns below facets ------------------------------------------------------------------------------ */
typedef struct {
    const pg_load *load;
    pg_family near;  /* points around the middle of the column below each facet of its set */
    unsigned char *below;                              /* 1: the point is in the column (entries of near) */
    int *columns;                                      /* number of columns that hold each point (n) */
} columns;

/* Is point j in the column below the facet: not deeper than `depth` (m), and within half a lattice step of
 * the column's axis? The column of a facet is as wide as a cell, so that each point of a lattice lies in one
 * column, or on the border of two. */
static int is_below (const point_boundary *s, size_t facet, int j, double depth)
{
    const pg_cloud *c = &s->problem->cloud;
    size_t dim = (size_t) s->dim;
    const double *normal = s->problem->cells.normal + facet * dim,
                 *centre = s->problem->cells.facet_centre + facet * dim, *x = c->x + (size_t) j * dim;
    double down = 0;
    for (size_t k = 0; k < dim; k++) down -= (x[k] - centre[k]) * normal[k];
    if (down > depth + 1e-6 * c->h || down < -0.5 * c->h) return 0;  /* perturbed points may lie above */
    for (size_t k = 0; k < dim; k++)
        if (fabs (x[k] - centre[k] + down * normal[k]) > (0.5 + 1e-6) * c->step[k]) return 0;
    return 1;
}

/* Distributes the force at one quadrature point of a facet to the points of its column by their volumes;
 * *found 0: there are none. A point that lies in two columns belongs to each with half its volume, so that no
 * force is counted twice. */
static pg_status column_parts (gathering *g, const point_boundary *s, const columns *c, int facet,
                               boundary_share part,
                               int *found)
{
    pg_status status = PG_OK;
    const double *volume = s->problem->cloud.volume;
    const int *at = pg_search (&facet, c->load->set->facet, c->load->set->nfacet, sizeof facet,
                               pg_ascending_ints);
    double sum = 0, weight = part.weight;
    size_t first = c->near.start[at - c->load->set->facet],
           last = c->near.start[at - c->load->set->facet + 1];
    for (size_t k = first; k < last; k++)
        if (c->below[k]) sum += volume[c->near.node[k]] / c->columns[c->near.node[k]];
    *found = sum > 0;
    for (size_t k = first; k < last && sum > 0; k++) {
        int j = c->near.node[k];
        if (!c->below[k]) continue;
        part.weight = weight * (volume[j] / c->columns[j] / sum);
        PG_TRY (add_part (g, j, part));
    }
done:
    return status;
}

/* Frees what find_columns made. */
static void clear_columns (columns *c)
{
    pg_family_clear (&c->near);
    pg_free (c->below), pg_free (c->columns);
}

/* Finds the points within the depth below each facet of a load's set, and the number of columns that each of
 * them lies in. The search is around the middle of each column; in graded clouds its radius is divided by the
 * finest relative spacing, since families scale theirs by it. */
static pg_status find_columns (columns *out, const point_boundary *s, const pg_load *load)
{
    pg_status status = PG_OK;
    const pg_cells *cells = &s->problem->cells;
    const pg_cloud *c = &s->problem->cloud;
    size_t dim = (size_t) s->dim;
    double *middle = NULL, wide = 0;
    PG_ALLOC (middle, load->set->nfacet * dim);
    for (size_t i = 0; i < load->set->nfacet * dim; i++) {
        size_t facet = (size_t) load->set->facet[i / dim] * dim + i % dim;
        middle[i] = cells->facet_centre[facet] - 0.5 * load->depth * cells->normal[facet];
    }
    for (size_t k = 0; k < dim; k++) wide += c->step[k] * c->step[k];
    double reach = (0.5 * load->depth + c->h + sqrt (wide)) * c->h / pg_cloud_finest (c);
    PG_TRY (pg_family_build (&out->near, c, load->set->nfacet, middle, reach, PG_RADIAL, 1));
    out->load = load;
    PG_ALLOC (out->below, out->near.start[out->near.n]);
    PG_ALLOC (out->columns, c->n);
    for (size_t i = 0; i < out->near.n; i++)
        for (size_t k = out->near.start[i]; k < out->near.start[i + 1]; k++) {
            out->below[k] = (unsigned char) is_below (s, (size_t) load->set->facet[i], out->near.node[k],
                                                      load->depth);
            out->columns[out->near.node[k]] += out->below[k];
        }
done:
    pg_free (middle);
    return status;
}

/* Distributes the force at every quadrature point of the facets (two Gauss points a direction, so that
 * tractions may vary): to the column below where the load has a depth and there are points, else to the
 * points nearest to the facet's centre. */
static pg_status facet_parts (gathering *g, point_boundary *s, const pg_load *load)
{
    pg_status status = PG_OK;
    const pg_cells *cells = &s->problem->cells;
    pg_quadrature q = { 0 };
    columns below = { 0 };
    size_t dim = (size_t) s->dim, count = 0;
    int found[MOST_TIES], of = -1, shared;
    if (!s->near) PG_TRY (pg_nearest_create (&s->near, s->dim, s->n, s->problem->cloud.x));
    PG_TRY (pg_facet_points (&q, cells, 2));
    if (load->depth > 0) PG_TRY (find_columns (&below, s, load));
    for (size_t i = 0; i < q.n; i++) {
        if (!member (load->set->facet, load->set->nfacet, q.cell[i])) continue;
        boundary_share part = { .weight = q.weight[i] };
        memcpy (part.x, q.x + i * dim, dim * sizeof *part.x);
        memcpy (part.normal, q.normal + i * dim, dim * sizeof *part.normal);
        if (load->depth > 0) {
            PG_TRY (column_parts (g, s, &below, q.cell[i], part, &shared));
            if (shared) continue;
        }
        if (of != q.cell[i])
            count = nearest_points (s, s->near, cells->facet_centre + (size_t) q.cell[i] * dim, found),
            of = q.cell[i];
        part.weight /= (double) count;
        for (size_t k = 0; k < count; k++) PG_TRY (add_part (g, found[k], part));
    }
done:
    clear_columns (&below);
    pg_quadrature_clear (&q);
    return status;
}

/* ---- points -------------------------------------------------------------------------------------------- */
/* Shares of loads that act on points: a total force has equal shares (1), a force per volume shares by volume
 * (m^3). */
static pg_status point_parts (gathering *g, const point_boundary *s, const pg_load *load)
{
    pg_status status = PG_OK;
    const pg_cloud *c = &s->problem->cloud;
    for (size_t i = 0; i < load->set->npoint; i++) {
        int j = load->set->point[i];
        boundary_share part = { .weight = load->kind == PG_BODY_FORCE
                                              ? c->volume[j]
                                                    * pg_load_density (s->problem, load, PG_NODES, (size_t) j)
                                              : pg_load_share (load, i) };
        memcpy (part.x, pg_load_site (load, c->x + (size_t) j * (size_t) s->dim),
                (size_t) s->dim * sizeof *part.x);
        PG_TRY (add_part (g, j, part));
    }
done:
    return status;
}

/* Computes all shares of a load, according to what it acts on, and sorts its points: the order of a sum must
 * not depend on the order of facets. */
pg_status boundary_shares (boundary_load *out, point_boundary *s, int load)
{
    pg_status status = PG_OK;
    const pg_load *l = &s->problem->boundary.load[load];
    gathering g = { .out = out };
    PG_ALLOC (g.index, s->n);
    for (size_t i = 0; i < s->n; i++) g.index[i] = -1;
    if (l->kind == PG_TRACTION || l->kind == PG_PRESSURE) PG_TRY (facet_parts (&g, s, l));
    else PG_TRY (point_parts (&g, s, l));
    if (out->npoint) pg_sort (out->point, out->npoint, sizeof *out->point, pg_ascending_ints);
    for (size_t k = 0; k < out->npoint; k++) g.index[out->point[k]] = (int) k;
    for (size_t k = 0; k < out->npart; k++) out->part[k].at = (size_t) g.index[out->part[k].at];
done:
    pg_free (g.index);
    return status;
}
