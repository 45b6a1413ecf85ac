/* SPDX-License-Identifier: GPL-3.0-or-later
 * The bonds with the largest utilisation, where that of all bonds is known. Ranks judge the bonds that they
 * own, and agree on the largest value. */
#include "perigal/force.h"
#include "perigal/ranks.h"
#include <math.h>

pg_status pg_worst_bonds (const pg_problem *p, const pg_state *state, const double *utilisation, double from,
                          double *top, pg_changes *over)
{
    pg_status status = PG_OK;
    double most = 0;
    over->n = 0;
    for (int set = 0; set < PG_BOND_SETS; set++) {
        const pg_family *f = &p->bonds.rows[set].family;
        size_t base = p->bonds.first[set];
        for (size_t k = 0; k < f->n; k++)
            for (size_t i = base + f->start[k]; i < base + f->start[k + 1]; i++) {
                if (!(utilisation[i] > 0) || !pg_problem_owns (p, set, k)) continue;
                most = fmax (most, utilisation[i]);
                if (!state->alive[i] || !(utilisation[i] >= from)) continue;
                PG_GROW (over->bond, over->cap, over->n + 1);
                over->bond[over->n++] = i;
            }
    }
    PG_TRY (pg_cloud_most (&p->cloud, 1, &most));
    *top = most;
    if (!(*top > 1)) over->n = 0;
done:
    return status;
}
