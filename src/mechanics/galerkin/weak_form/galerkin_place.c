/* SPDX-License-Identifier: GPL-3.0-or-later
 * Effective position of a point for loads and supports. Shape functions that reproduce linear fields give
 * the displacement at the point itself. Where a point has too few neighbours, or neighbours on a line or
 * plane, they reproduce constants only, and of a linear field they give the value at the weighted mean
 * position of these nodes, sum N_j x_j. Prescribed values are therefore taken there, and moments of forces
 * too: supports that move as a rigid body then cause no strain, and forces and moments balance, whatever
 * nodes cracks have left to a point. A point without any neighbour does not move, and cannot be
 * constrained. */
#include "galerkin.h"
#include <string.h>

const double *galerkin_place (const galerkin *g, int set, size_t point, double *at)
{
    const pg_rows *r = &g->rows[set];
    size_t dim = (size_t) g->dim;
    double sum = 0;
    if (r->grade[point] <= PG_GRADE_LOWERED || r->grade[point] == PG_GRADE_DEAD) return r->x + point * dim;
    memset (at, 0, 3 * sizeof *at);
    for (size_t e = r->family.start[point]; e < r->family.start[point + 1]; e++) {
        double N = r->N[e + pg_rows_offset (r, point)];
        sum += N;
        for (size_t k = 0; k < dim; k++)
            at[k] += N * (g->problem->cloud.x[(size_t) r->family.node[e] * dim + k] - r->x[point * dim + k]);
    }
    for (size_t k = 0; k < dim; k++) at[k] = r->x[point * dim + k] + (sum > 0 ? at[k] / sum : 0);
    return at;
}

double galerkin_prescribed (const galerkin *g, const constraint *q, int set, double t)
{
    double at[3];
    size_t point = set == PG_FACETS ? q->point : (size_t) g->supports.penalty_node[q->point];
    if (g->rows[set].grade[point] == PG_GRADE_DEAD) return 0;
    return pg_load_value (&g->problem->boundary.load[q->load], q->component, g->dim,
                          galerkin_place (g, set, point, at), t);
}
