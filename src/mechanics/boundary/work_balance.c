/* SPDX-License-Identifier: GPL-3.0-or-later
 * Work of the boundary: pairs of force and displacement whose product is work, and reactions of supports,
 * for forces whose unknowns are the values of the points. */
#include "point_boundary.h"
#include <string.h>

/* Adds the force on one unknown of a point, and its moment about pg_load.about, to the reactions of a load.
 * For rotations the force is a moment already and has no lever arm. */
static void add_reaction (const point_boundary *s, double *reaction, int load, int component, size_t point,
                          double force)
{
    const pg_problem *p = s->problem;
    const pg_load *l = &p->boundary.load[load];
    double unit = boundary_unit (s, l);
    if (l->kind == PG_MOMENT) unit = 1 / unit;
    reaction[3 * load + component] += force * unit;
    if (!pg_load_rotates (l))
        pg_load_add_moment (l, s->dim, p->cloud.x + point * (size_t) s->dim, component, force,
                            reaction + 3 * (p->boundary.nload + (size_t) load));
}

/* Allocates the arrays on the first call; pairs of supports come first, then those of loads, then those of
 * springs. Forces on ghost points count on the rank that owns these. */
pg_status boundary_work_balance (point_boundary *s, double t, const double *d, const double *residual,
                              pg_work_balance *out)
{
    pg_status status = PG_OK;
    size_t at = s->nsupport, count = s->nsupport;
    const pg_cloud *cloud = &s->problem->cloud;
    for (size_t k = 0; k < s->nload; k++) count += s->load[k].npoint * (size_t) s->load[k].components;
    count += s->nspring;
    if (!out->force) {
        out->npair = count;
        PG_ALLOC (out->force, count);
        PG_ALLOC (out->displacement, count);
        PG_ALLOC (out->reaction, PG_REACTIONS * s->problem->boundary.nload);
    }
    memset (out->reaction, 0, PG_REACTIONS * s->problem->boundary.nload * sizeof *out->reaction);
    boundary_goals (s, t, out->displacement);
    for (size_t k = 0; k < s->nsupport; k++) {
        const boundary_support *q = &s->support[k];
        out->force[k] = pg_cloud_owns (cloud, q->point) ? -residual[q->dof] : 0;
        if (q->load >= 0) add_reaction (s, out->reaction, q->load, q->component, q->point, out->force[k]);
    }
    for (size_t k = 0; k < s->nload; k++) {
        boundary_load *l = &s->load[k];
        double factor = boundary_bring_to (s, l, t);
        for (size_t i = 0; i < l->npoint; i++)
            for (size_t c = 0; c < (size_t) l->components; c++, at++) {
                out->force[at] = pg_cloud_owns (cloud, (size_t) l->point[i])
                                     ? factor * l->pattern[i * (size_t) l->components + c] : 0;
                out->displacement[at] = d[(size_t) l->point[i] * (size_t) s->stride + (size_t) l->first + c];
                add_reaction (s, out->reaction, l->load, (int) c, (size_t) l->point[i], out->force[at]);
            }
    }
    for (size_t k = 0; k < s->nspring; k++, at++) {
        const boundary_spring *q = &s->spring[k];
        out->displacement[at] = boundary_spring_goal (s, q, t);
        double gap = d[q->dof] - out->displacement[at];
        out->force[at] = pg_cloud_owns (cloud, q->point) ? -q->stiffness * gap : 0;
        add_reaction (s, out->reaction, q->load, q->component, q->point, out->force[at]);
    }
done:
    return status;
}

/* Frees the arrays; may be called for ones that were never filled. */
void pg_work_balance_clear (pg_work_balance *work_balance)
{
    pg_free (work_balance->force), pg_free (work_balance->displacement), pg_free (work_balance->reaction);
    memset (work_balance, 0, sizeof *work_balance);
}
