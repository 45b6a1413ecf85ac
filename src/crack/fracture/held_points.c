/* SPDX-License-Identifier: GPL-3.0-or-later
 * Nodes constrained by intact bonds. A node between two cracks closer together than a horizon may keep bonds
 * in one direction only; its displacement across is then arbitrary. */
#include "held_points.h"

/* Returns 1: the intact bonds of node i span all directions, which central forces need: the tensor sum n n'
 * of their directions is positive definite, by the ratio of its least to its largest eigenvalue. */
static int spans (const pg_problem *p, const unsigned char *alive, size_t i)
{
    const double flat = 1e-9;
    const pg_family *f = &p->bonds.rows[PG_NODES].family;
    const double *x = p->cloud.x;
    size_t dim = (size_t) p->dim;
    double T[9] = { 0 }, lambda[3];
    for (size_t e = f->start[i]; e < f->start[i + 1]; e++) {
        size_t j = (size_t) f->node[e];
        double xi[3] = { 0 }, rr = 0;
        if (j == i || !alive[e]) continue;
        for (size_t k = 0; k < dim; k++) xi[k] = x[j * dim + k] - x[i * dim + k], rr += xi[k] * xi[k];
        for (size_t k = 0; k < dim; k++)
            for (size_t l = 0; l < dim; l++) T[k * dim + l] += xi[k] * xi[l] / rr;
    }
    pg_dense_eigen (p->dim, T, lambda, NULL);
    return lambda[dim - 1] > flat * lambda[0];
}

int point_is_held (const pg_problem *p, const pg_state *state, size_t i)
{
    const pg_family *f = &p->bonds.rows[PG_NODES].family;
    if (p->method->shape_functions && !p->form.integration->at_nodes) {
        const pg_crack *on = pg_cracks_touch (pg_state_cracks (p, state), p->cloud.x + i * (size_t) p->dim,
                                              pg_cloud_same (&p->cloud));
        return !(on && !on->sided);
    }
    if (!f->start) return 1;
    const unsigned char *alive = state->alive + p->bonds.first[PG_NODES];
    if (!p->method->shape_functions && pg_problem_rotations (p) == 0) return spans (p, alive, i);
    for (size_t e = f->start[i]; e < f->start[i + 1]; e++)
        if (alive[e] && (size_t) f->node[e] != i) return 1;
    return 0;
}
