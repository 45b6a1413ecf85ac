/* SPDX-License-Identifier: GPL-3.0-or-later
 * Costs of linear solves of forces with shape functions: by a factor of K, and by conjugate gradients with
 * finite elements on the same nodes as preconditioner. Estimated in seconds from stored rates and numbers of
 * points, bonds and unknowns, not measured, as a run must not depend on the clock. The solver chooses by
 * these costs, and the forecast of a run by the same. */
#include "model.h"
#include <math.h>

/* Operations of a factor. Nested dissection cuts a body across its longest axis by separators as thick as the
 * largest distance of coupled nodes, 2 horizons. With s unknowns of the largest separator the factor costs
 * about 3 s^3 operations (solids of n1 >= n2 >= n3 nodes along the axes: s^3 n1 / n2), in 2D 10 s^3. The
 * numbers 3 and 10 were fitted to few bodies: a rough estimate, for choices between methods whose costs
 * differ by factors. */
static double factor_flops (const pg_solve_counts *c)
{
    double n[3] = { c->edge[0], c->edge[1], c->edge[2] };
    for (int k = 0; k < 2; k++)
        for (int l = k + 1; l < 3; l++)
            if (n[l] > n[k]) {
                double swap = n[k];
                n[k] = n[l], n[l] = swap;
            }
    double separator = 2 * c->reach * c->components * n[1] * (c->dim > 2 ? n[2] : 1);
    return (c->dim > 2 ? 3 : 10) * separator * separator * separator * fmax (1, n[0] / n[1]);
}

/* Seconds of assembly, which visits every pair of nodes of every evaluation point. */
double pg_solve_assembly_cost (const pg_solve_counts *c)
{
    return 8e-9 * (c->evaluation > 0 ? 0.5 * c->bonds * c->bonds / c->evaluation : 0);
}

double pg_solve_direct_cost (const pg_solve_counts *c)
{
    return pg_solve_assembly_cost (c) + 5e-6 * c->points * c->components + factor_flops (c) / 20e9;
}

/* 1: the finite elements are on a coarse grid, for scattered nodes with narrow supports: K x is cheap then,
 * and the grid complements the diagonal. With wider supports modes that alternate from node to node have too
 * little energy. */
int pg_solve_on_grid (const pg_solve_counts *c)
{
    return c->scattered && !c->interpolates && !c->projected && c->reach <= (c->order == 2 ? 2.7 : 2.2);
}

/* Iterations to a tolerance of 1e-9, from experience: more for wide supports and projected dilatation, which
 * differ much from finite elements. */
static double iterations (const pg_solve_counts *c)
{
    double count = 35;
    if (pg_solve_on_grid (c)) return c->order == 2 ? 220 : 150;
    if (c->interpolates) count = 30;
    else if (c->order == 2) count = c->reach > 2.7 ? 150 : 60;
    else if (c->reach > 2.2) count = c->reach > 2.7 ? 1000 : 70;
    return count * (c->projected ? 3 : 1) * (c->behind ? 6 : 1);
}

/* Set-up counts as 20 iterations; besides K x an iteration takes 0.9 us for each node: products with the
 * element matrix and its coarse levels, and with the polynomial; on a coarse grid 0.1 us. */
static double iterations_cost (const pg_solve_counts *c, double solves)
{
    double beside = pg_solve_on_grid (c) ? 0.1e-6 : 0.9e-6;
    return (solves * iterations (c) + 20) * (pg_solve_apply_rate * c->bonds + beside * c->points);
}

double pg_solve_elements_cost (const pg_solve_counts *c) { return iterations_cost (c, 1); }

/* A factor that serves many events pays for itself up to here in 3D (unknowns), and fits into memory: some 5
 * GB for a cube. Iterations take some 70 for every event in a block with a crack, which is four times the
 * seconds of an event by a factor at 41 000 unknowns. */
enum { EVENTS_FACTOR = 80000 };
/* Dynamics: number of solves that a factor of k K + m M is assumed to serve, as it remains valid while
 * nothing breaks and is updated for broken bonds. A plate of 55 488 unknowns, seven nodes thick: 8 s for the
 * factor, then 0.1 s a solve, where elements take 1 s; a cube of as many would need ten times the factor. */
enum { MOTION_SERVES = 20 };

int pg_solve_by_elements (const pg_solve_counts *c, int available, int events, int motion)
{
    double unknowns = c->points * c->components;
    if (c->dim < 3) return 0;
    if (motion)
        return available
               && (unknowns > EVENTS_FACTOR
                   || MOTION_SERVES * pg_solve_elements_cost (c) < pg_solve_direct_cost (c));
    if (events && unknowns <= EVENTS_FACTOR) return 0;
    /* a factor solves all at little extra cost */
    double solves = unknowns <= EVENTS_FACTOR ? 1 + c->columns : 1;
    if (available && iterations_cost (c, solves) < pg_solve_direct_cost (c)) return 1;
    return unknowns > 200000;
}

/* Returns 1: the points lie at the centres of the cells, inside the surface: as many points as cells, or,
 * with cut cells, by the first point of a regular lattice. */
static int stands_behind (const pg_problem *p)
{
    if (!p->lattice.dim || p->cells.n == p->cloud.n) return p->lattice.dim > 0;
    if (!p->cloud.regular || !p->cloud.n) return 0;
    double at = (p->cloud.x[0] - p->lattice.origin[0]) / p->lattice.step[0];
    return fabs (at - floor (at) - 0.5) < 0.25;
}

/* Counts for the cost estimates; edge: nodes along the axes of a box with the body's proportions and as many
 * nodes. All zero without shape functions. */
pg_solve_counts pg_solve_count (const pg_problem *p)
{
    if (!p->form.approx.type || !p->form.integration) return (pg_solve_counts) { .dim = p->dim };
    int set = p->form.integration->at_nodes ? PG_NODES : PG_POINTS;
    double low[3] = { 0 }, high[3] = { 0 }, box = 1;
    pg_solve_counts c = { .dim = p->dim,
                          .components = pg_problem_unknowns (p),
                          .order = p->form.approx.order,
                          .interpolates = p->form.approx.type->interpolates,
                          .projected = p->form.patches != NULL,
                          .behind = stands_behind (p),
                          .scattered = p->form.integration->at_nodes && !p->cloud.regular,
                          .points = (double) p->cloud.n,
                          .evaluation = (double) p->bonds.rows[set].n,
                          .bonds = (double) (p->bonds.first[set + 1] - p->bonds.first[set]),
                          .reach = p->form.approx.horizon / p->cloud.h,
                          .edge = { 1, 1, 1 } };
    pg_problem_box (p, low, high);
    for (int k = 0; k < p->dim; k++) box *= c.edge[k] = fmax (high[k] - low[k], p->cloud.h);
    for (int k = 0; k < p->dim; k++) c.edge[k] *= pow (c.points / box, 1.0 / p->dim);
    return c;
}
