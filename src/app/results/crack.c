/* SPDX-License-Identifier: GPL-3.0-or-later
 * Area of new crack, estimated from the broken bonds. A plane with the normal n that cuts all bonds across it
 * cuts, per area, as many bonds of the points around it as sum_j |xi_j . n| / V_i (V_i volume of such a
 * point, xi_j its bonds). So each broken bond of point i stands for the area V_i / sum_j |xi_j . n|, and with
 * a normal of any direction |xi . n| is |xi| times its mean: 1, 2/pi, 1/2 in 1, 2, 3 dimensions. It is exact
 * for one plane on average over its directions, and parallel or smeared cracks count as often as they are. If
 * points fail, with all their bonds, a crack is a band of them, and the bonds that reach into it from either
 * side are cut as well: their count is that of several cracks. The band is about a horizon wide, which also
 * defines the energy that a point can store (mechanics/criterion/node_energy.c), so that a failed point
 * stands for the area V_i / horizon. */
#include "results_private.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

/* Area of the crack, m2, by the bonds of one point of a bond set that have broken since `before` (1 intact,
 * for its own bonds). */
static double area_of (const pg_problem *p, int set, size_t i, double volume, const unsigned char *before,
                       const unsigned char *now)
{
    static const double mean[] = { 0, 1, 0.63661977236758134, 0.5 };
    const pg_family *f = &p->bonds.rows[set].family;
    size_t dim = (size_t) p->dim, broken = 0;
    double sum = 0;
    for (size_t b = f->start[i]; b < f->start[i + 1]; b++) {
        double square = 0;
        for (size_t k = 0; k < dim; k++) {
            double xi = p->cloud.x[(size_t) f->node[b] * dim + k] - p->bonds.rows[set].x[i * dim + k];
            square += xi * xi;
        }
        sum += sqrt (square);
        broken += before[b - f->start[i]] && !now[p->bonds.first[set] + b];
    }
    return sum > 0 ? volume * (double) broken / (mean[dim] * sum) : 0;
}

/* Area, m2, that point i stands for if it has failed: it had bonds at the start and has none now. */
static double area_of_point (const pg_problem *p, size_t i, const unsigned char *before,
                             const unsigned char *now)
{
    const pg_family *f = &p->bonds.rows[PG_NODES].family;
    size_t first = f->start[i], n = f->start[i + 1] - first;
    if (!memchr (before, 1, n) || memchr (now + p->bonds.first[PG_NODES] + first, 1, n)) return 0;
    return p->cloud.volume[i] / (p->form.approx.horizon * pg_cloud_ratio (&p->cloud, i));
}

/* Measures the area of new crack. Uses the bonds of evaluation points where there are some, else those of the
 * points themselves. Which bonds pre-cracks cut at the start is found again for points with broken bonds. */
pg_status pg_result_crack_measure (pg_result *r, const pg_state *state)
{
    pg_status status = PG_OK;
    const pg_problem *p = r->problem;
    unsigned char *start = NULL;
    size_t widest = 0;
    int points = p->criterion->type && (p->criterion->type->needs & PG_NEEDS_ENERGY),
        set = p->bonds.rows[PG_POINTS].n && !points ? PG_POINTS : PG_NODES;
    double area = 0;
    r->crack = (result_crack) { .length = NAN, .dissipated = NAN };
    if (pg_problem_removes (p)) return PG_OK;              /* bonds of removed points are no crack */
    if (r->tips.grows && state->paths) {                        /* known from the facets, not estimated */
        r->crack.length = state->paths->length, r->crack.area = r->crack.length * p->cloud.thickness;
        r->crack.found = r->crack.area > 0;
        if (r->crack.found)
            r->crack.dissipated = pg_solver_report_now (r->solver)->energy.dissipated / r->crack.area;
        return PG_OK;
    }
    if (r->tips.grows && state->surfaces) {
        r->crack.area = state->surfaces->area, r->crack.found = r->crack.area > 0;
        if (r->crack.found)
            r->crack.dissipated = pg_solver_report_now (r->solver)->energy.dissipated / r->crack.area;
        return PG_OK;
    }
    if (!p->criterion->type || (state->broken == 0 && !pg_ranks_now ())) return PG_OK;
    const size_t *first = p->bonds.rows[set].family.start;
    for (size_t i = 0; i < p->bonds.rows[set].n; i++)
        widest = first[i + 1] - first[i] > widest ? first[i + 1] - first[i] : widest;
    PG_ALLOC (start, widest + 1);
    for (size_t i = 0; i < p->bonds.rows[set].n; i++) {
        if (set == PG_NODES && !pg_cloud_owns (&p->cloud, i)) continue;
        if (!memchr (state->alive + p->bonds.first[set] + first[i], 0, first[i + 1] - first[i])) continue;
        pg_bonds_cut_at (p, set, i, start);
        if (points) area += area_of_point (p, i, start, state->alive);
        else
            area += area_of (p, set, i, set == PG_NODES ? p->cloud.volume[i] : p->bonds.rows[set].weight[i],
                             start, state->alive);
    }
    PG_TRY (pg_ranks_sum (1, &area));
    r->crack.found = area > 0;
    r->crack.area = area;
    if (p->dim == 2) r->crack.length = area / p->cloud.thickness;
    if (area > 0) r->crack.dissipated = pg_solver_report_now (r->solver)->energy.dissipated / area;
done:
    pg_free (start);
    return status;
}

size_t pg_result_crack_columns (const pg_result *r) { return r->counting && !r->tips.grows; }

void pg_result_crack_column (const pg_result *r, char *out, size_t size)
{
    snprintf (out, size, r->problem->dim == 3 ? "crack.area [m^2]" : "crack.length [m]");
}

/* Measures the crack of the state at a row: 0 while nothing has broken. */
pg_status pg_result_crack_row (pg_result *r, const pg_state *state, double *row)
{
    pg_status status = PG_OK;
    if (!pg_result_crack_columns (r)) return PG_OK;
    PG_TRY (pg_result_crack_measure (r, state));
    if (pg_problem_removes (r->problem)) *row = NAN;
    else if (!r->crack.found) *row = 0;
    else *row = r->problem->dim == 3 ? r->crack.area : r->crack.length;
done:
    return status;
}
