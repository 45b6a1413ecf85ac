/* SPDX-License-Identifier: GPL-3.0-or-later
 * What the boundary does: pairs of force and displacement whose product is work, reactions of supports, of
 * forces whose unknowns are the values of the points. */
#include "point_boundary.h"
#include <string.h>

/* Arrays are sized on the first call; pairs of supports come first, those of loads follow. */
pg_status boundary_work_balance (point_boundary *s, double t, const double *d, const double *residual,
                              pg_work_balance *out)
{
    pg_status status = PG_OK;
    size_t at = s->nsupport, count = s->nsupport;
    for (size_t k = 0; k < s->nload; k++) count += s->load[k].npoint * (size_t) s->load[k].components;
    if (!out->force) {
        out->npair = count;
        PG_ALLOC (out->force, count);
        PG_ALLOC (out->displacement, count);
        PG_ALLOC (out->reaction, 3 * s->problem->nload);
    }
    memset (out->reaction, 0, 3 * s->problem->nload * sizeof *out->reaction);
    for (size_t k = 0; k < s->nsupport; k++) {
        const boundary_support *q = &s->support[k];
        out->force[k] = -residual[q->dof], out->displacement[k] = boundary_goal (s, k, t);
        if (q->load >= 0)
            out->reaction[q->load * 3 + q->component] -= residual[q->dof]
                                                         * boundary_unit (s, &s->problem->load[q->load]);
    }
    for (size_t k = 0; k < s->nload; k++) {
        boundary_load *l = &s->load[k];
        double factor = boundary_bring_to (s, l, t);
        for (size_t i = 0; i < l->npoint; i++)
            for (size_t c = 0; c < (size_t) l->components; c++, at++) {
                out->force[at] = factor * l->pattern[i * (size_t) l->components + c];
                out->displacement[at] = d[(size_t) l->point[i] * (size_t) s->stride + (size_t) l->first + c];
                out->reaction[(size_t) l->load * 3 + c] += out->force[at]
                                                           / boundary_unit (s, &s->problem->load[l->load]);
            }
    }
done:
    return status;
}

/* May be called on one that was never filled. */
void pg_work_balance_clear (pg_work_balance *work_balance)
{
    pg_free (work_balance->force), pg_free (work_balance->displacement), pg_free (work_balance->reaction);
    memset (work_balance, 0, sizeof *work_balance);
}
