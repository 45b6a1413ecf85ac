/* SPDX-License-Identifier: GPL-3.0-or-later
 * The alive mask, state->alive: one byte per bond of all bond sets, 1: alive, 0: broken. Bond number
 * first_bond[set] + e is entry e of the neighbour lists of that set (bonds.c). Breaking a bond clears its
 * byte and nothing else; forces update their caches afterwards (refresh). The damage of a point is the
 * fraction of its bytes that are 0. */
#include "model.h"
#include <string.h>

/* Bonds are numbered set by set and within a set point by point, so that both are found by bisection. */
void pg_problem_locate (const pg_problem *p, size_t bond, int *set, size_t *point)
{
    *set = 0;
    while (bond >= p->bonds.first[*set + 1]) ++*set;
    const size_t *start = p->bonds.rows[*set].family.start;
    size_t e = bond - p->bonds.first[*set], lo = 0, hi = p->bonds.rows[*set].n;
    while (hi - lo > 1) {
        size_t mid = (lo + hi) / 2;
        if (start[mid] <= e) lo = mid;
        else hi = mid;
    }
    *point = lo;
}

/* Returns 1: no crack is as near to point q as its bonds reach; 0: not known. With equal spacings bonds are
 * shorter than the horizon plus half a spacing; twice the horizon (at least a spacing) is an upper bound. */
static int far_from_cracks (const pg_problem *p, const pg_rows *rows, size_t q)
{
    double low[3], high[3];
    if (p->method->shape_functions || p->cloud.size) return 0;
    for (size_t k = 0, dim = (size_t) p->dim; k < dim; k++) {
        low[k] = rows->x[dim * q + k] - 2 * p->form.approx.horizon;
        high[k] = rows->x[dim * q + k] + 2 * p->form.approx.horizon;
    }
    return !pg_cracks_near (pg_state_cracks (p, NULL), low, high)
           && !pg_cracks_near (&p->crack.slots, low, high);
}

/* Returns 0: by the bounding box of its bonds, no crack can cut a bond of point q. Saves most points of a
 * body the test of every bond. */
static int may_be_cut (const pg_problem *p, const pg_rows *rows, size_t q)
{
    double low[3], high[3], slack = 10 * pg_cloud_same (&p->cloud); /* larger than the tolerance of a cut */
    const pg_cracks *cracks = pg_state_cracks (p, NULL);
    size_t dim = (size_t) p->dim;
    if (cracks->n + p->crack.slots.n == 0 || far_from_cracks (p, rows, q)) return 0;
    for (size_t k = 0; k < dim; k++) low[k] = high[k] = rows->x[dim * q + k];
    for (size_t e = rows->family.start[q]; e < rows->family.start[q + 1]; e++)
        for (size_t k = 0; k < dim; k++) {
            double x = p->cloud.x[dim * (size_t) rows->family.node[e] + k];
            low[k] = x < low[k] ? x : low[k], high[k] = x > high[k] ? x : high[k];
        }
    for (size_t k = 0; k < dim; k++) low[k] -= slack, high[k] += slack;
    return pg_cracks_near (cracks, low, high) || pg_cracks_near (&p->crack.slots, low, high);
}

int pg_bond_cut_first (const pg_problem *p, const double *x, const double *y)
{
    double tolerance = pg_cloud_same (&p->cloud);
    return pg_cracks_cut (pg_state_cracks (p, NULL), x, y, tolerance)
           || pg_cracks_cut (&p->crack.slots, x, y, tolerance);
}

/* The initial alive mask of point q: 0 where the segment of a bond meets a pre-crack. The bond of a point
 * with itself is never cut. */
void pg_bonds_cut_at (const pg_problem *p, int set, size_t q, unsigned char *alive)
{
    const pg_rows *rows = &p->bonds.rows[set];
    size_t dim = (size_t) p->dim, first = rows->family.start[q], m = rows->family.start[q + 1] - first;
    memset (alive, 1, m);
    if (!may_be_cut (p, rows, q)) return;
    for (size_t e = 0; e < m; e++) {
        int j = rows->family.node[first + e];
        alive[e] = j == rows->own[q]
                   || !pg_bond_cut_first (p, rows->x + q * dim, p->cloud.x + (size_t) j * dim);
    }
}

void pg_bonds_cut (const pg_problem *p, unsigned char *alive)
{
    for (int s = 0; s < PG_BOND_SETS; s++)
        for (size_t q = 0; q < p->bonds.rows[s].n; q++)
            pg_bonds_cut_at (p, s, q, alive + p->bonds.first[s] + p->bonds.rows[s].family.start[q]);
}
