/* SPDX-License-Identifier: GPL-3.0-or-later
 * Loads of forces whose unknowns are the values of the points, as forces on points: computed once where they
 * are a pattern times a factor of t. */
#include "point_boundary.h"
#include <math.h>
#include <string.h>

/* Computes the forces on the points of a load, N (moments over s->length): its pattern if it is a pattern
 * times a factor of t, else its values at t. A pressure has one component, along the normal. */
static void evaluate (const point_boundary *s, boundary_load *l, double t)
{
    const pg_load *load = &s->problem->boundary.load[l->load];
    int pressure = load->kind == PG_PRESSURE;
    size_t dim = (size_t) l->components;
    double unit = boundary_unit (s, load);
    memset (l->pattern, 0, l->npoint * dim * sizeof *l->pattern);
    for (size_t i = 0; i < l->npart; i++) {
        const boundary_share *q = &l->part[i];
        for (size_t k = 0; k < dim; k++) {
            int c = pressure ? 0 : (int) k;
            double f = l->separates ? pg_load_pattern (load, c, s->dim, q->x)
                                    : pg_load_value (load, c, s->dim, q->x, t);
            l->pattern[q->at * dim + k] += q->weight * (pressure ? -f * q->normal[k] : f * unit);
        }
    }
    l->time = t;
}

/* Prepares a load: the shares of its points. If the load is a pattern times a factor of t, the forces of the
 * pattern replace the shares for good: a step then costs one product a point. */
pg_status boundary_make_load (point_boundary *s, boundary_load *l, int load)
{
    pg_status status = PG_OK;
    l->load = load, l->separates = pg_load_separates (&s->problem->boundary.load[load]), l->time = NAN;
    l->first = boundary_first (s, &s->problem->boundary.load[load]),
    l->components = pg_load_components (&s->problem->boundary.load[load], s->dim);
    PG_TRY (boundary_shares (l, s, load));
    PG_ALLOC (l->pattern, l->npoint * (size_t) l->components);
    if (!l->separates) goto done;
    evaluate (s, l, 0);
    pg_free (l->part);
    l->part = NULL, l->npart = 0;
done:
    return status;
}

/* Returns the factor of the pattern at t. Loads that are not a pattern times a factor are evaluated at t,
 * once per t, and return 1. */
double boundary_bring_to (const point_boundary *s, boundary_load *l, double t)
{
    if (l->separates) return pg_load_factor (&s->problem->boundary.load[l->load], t);
    if (!(l->time == t)) evaluate (s, l, t);
    return 1;
}

/* P += forces of all loads at t, N. */
void boundary_add (point_boundary *s, double t, double *P)
{
    size_t stride = (size_t) s->stride;
    for (size_t k = 0; k < s->nload; k++) {
        boundary_load *l = &s->load[k];
        size_t dim = (size_t) l->components;
        double factor = boundary_bring_to (s, l, t);
        for (size_t i = 0; i < l->npoint; i++)
            for (size_t c = 0; c < dim; c++)
                P[(size_t) l->point[i] * stride + (size_t) l->first + c] += factor * l->pattern[i * dim + c];
    }
}

/* P += tractions sigma n of a uniform stress (Voigt order, Pa) on every facet of a load, distributed to
 * points as the force of the load itself is: the loading of the patch test. */
pg_status boundary_surface (point_boundary *s, int load, const double *stress, double *P)
{
    pg_status status = PG_OK;
    boundary_load l = { .load = load };
    PG_TRY (boundary_shares (&l, s, load));
    for (size_t i = 0; i < l.npart; i++) {
        const boundary_share *q = &l.part[i];
        double *p = P + (size_t) l.point[q->at] * (size_t) s->stride;
        for (int k = 0; k < s->dim; k++)
            for (int c = 0; c < s->dim; c++)
                p[k] += q->weight * stress[pg_voigt_at (s->dim, k, c)] * q->normal[c];
    }
done:
    pg_free (l.point), pg_free (l.part);
    return status;
}

/* Reference for residuals, N: the root of the sum of squares of all loads, or, if larger, of the internal
 * forces (inside: sum of their squares on this rank, N^2). A point under several loads counts once for each.
 * Summed over all ranks that share the body. */
double boundary_reference (point_boundary *s, double t, double inside)
{
    double sum[2] = { inside, 0 };
    for (size_t k = 0; k < s->nload; k++) {
        double factor = boundary_bring_to (s, &s->load[k], t), square = 0;
        size_t m = (size_t) s->load[k].components;
        for (size_t i = 0; i < s->load[k].npoint * m; i++)
            if (pg_cloud_owns (&s->problem->cloud, (size_t) s->load[k].point[i / m]))
                square += s->load[k].pattern[i] * s->load[k].pattern[i];
        sum[1] += factor * factor * square;
    }
    if (pg_cloud_sum (&s->problem->cloud, 2, sum) != PG_OK) return NAN;
    return fmax (sqrt (sum[0]), sqrt (sum[1]));
}
