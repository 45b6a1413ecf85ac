/* SPDX-License-Identifier: GPL-3.0-or-later
 * Springs of `boundary`, for forces whose unknowns are the values of the points: each point of the set has
 * its share of the stiffness. */
#include "point_boundary.h"

/* Makes the list of springs, and their stiffness at every unknown (hold), for K. */
pg_status boundary_make_springs (point_boundary *s)
{
    pg_status status = PG_OK;
    const pg_problem *p = s->problem;
    size_t count = 0, stride = (size_t) s->stride;
    for (size_t l = 0; l < p->boundary.nload; l++)
        if (p->boundary.load[l].kind == PG_SPRING) count += p->boundary.load[l].set->npoint * (size_t) s->dim;
    if (count == 0) goto done;
    PG_ALLOC (s->spring, count);
    PG_ALLOC (s->hold, s->n * stride);
    for (size_t l = 0; l < p->boundary.nload; l++) {
        const pg_load *load = &p->boundary.load[l];
        for (size_t i = 0; load->kind == PG_SPRING && i < load->set->npoint; i++)
            for (int k = 0; k < s->dim; k++) {
                double stiffness = load->stiffness[k] * pg_load_share (load, i);
                size_t point = (size_t) load->set->point[i], dof = point * stride + (size_t) k;
                if (!(stiffness > 0)) continue;
                s->spring[s->nspring++] = (boundary_spring) { dof, point, (int) l, k, stiffness };
                s->hold[dof] += stiffness;
            }
    }
done:
    return status;
}

/* Prescribed displacement of the far end of a spring, m. */
double boundary_spring_goal (const point_boundary *s, const boundary_spring *q, double t)
{
    const pg_load *load = &s->problem->boundary.load[q->load];
    const double *x = pg_load_site (load, s->problem->cloud.x + q->point * (size_t) s->dim);
    return pg_load_value (load, q->component, s->dim, x, t);
}

void boundary_pull (const point_boundary *s, double t, const double *d, double *residual)
{
    for (size_t i = 0; i < s->nspring; i++) {
        const boundary_spring *q = &s->spring[i];
        residual[q->dof] -= q->stiffness * (d[q->dof] - boundary_spring_goal (s, q, t));
    }
}

void boundary_hold (const point_boundary *s, const double *x, double *y)
{
    for (size_t i = 0; i < s->nspring; i++) {
        const boundary_spring *q = &s->spring[i];
        y[q->dof] += q->stiffness * x[q->dof];
    }
}

double boundary_spring_energy (const point_boundary *s, double t, const double *d)
{
    double sum = 0;
    for (size_t i = 0; i < s->nspring; i++) {
        const boundary_spring *q = &s->spring[i];
        double gap = d[q->dof] - boundary_spring_goal (s, q, t);
        if (pg_cloud_owns (&s->problem->cloud, q->point)) sum += 0.5 * q->stiffness * gap * gap;
    }
    return sum;
}
