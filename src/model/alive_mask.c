/* SPDX-License-Identifier: GPL-3.0-or-later
 * The alive mask, state->alive: one byte per bond of all bond sets, 1: alive, 0: broken. Bond number
 * first_bond[set] + e is entry e of the neighbour lists of that set (bonds.c). Breaking a bond clears its
 * byte and nothing else; forces bring their caches in line afterwards (refresh). Damage is the share of
 * cleared bytes of a point. */
#include "model.h"

/* Bonds are numbered set by set and within a set point by point, so that both are found by bisection. */
void pg_problem_locate (const pg_problem *p, size_t bond, int *set, size_t *point)
{
    *set = 0;
    while (bond >= p->first_bond[*set + 1]) ++*set;
    const size_t *start = p->rows[*set].family.start;
    size_t e = bond - p->first_bond[*set], lo = 0, hi = p->rows[*set].n;
    while (hi - lo > 1) {
        size_t mid = (lo + hi) / 2;
        if (start[mid] <= e) lo = mid;
        else hi = mid;
    }
    *point = lo;
}

/* The mask at the start of a run: 0 where the segment of a bond meets a pre-crack. The bond of a point with
 * itself is never cut. */
void pg_bonds_cut (const pg_problem *p, unsigned char *alive)
{
    const pg_cracks *cracks = pg_state_cracks (p, NULL);
    size_t dim = (size_t) p->dim;
    for (int s = 0; s < PG_BOND_SETS; s++) {
        const pg_rows *rows = &p->rows[s];
        for (size_t q = 0; q < rows->n; q++)
            for (size_t e = rows->family.start[q]; e < rows->family.start[q + 1]; e++) {
                int j = rows->family.node[e];
                alive[p->first_bond[s] + e] =
                    j == rows->own[q] || !pg_cracks_cut (cracks, p->dim, rows->x + q * dim,
                                                         p->cloud.x + (size_t) j * dim, 1e-9 * p->cloud.h);
            }
    }
}
