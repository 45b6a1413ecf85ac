/* SPDX-License-Identifier: GPL-3.0-or-later
 * Supports, loads and work_balance of forces whose unknowns are the values of the points. Prescribed unknowns
 * are left out, d = T q + g with T the selection of the others; loads are sums of forces on points, computed
 * once where they are a pattern times a factor of t. */
#include "nodal.h"
#include <math.h>
#include <string.h>

/* ---- supports ------------------------------------------------------------------------------------------ */
static int prescribes (const pg_load *load, int k) { return pg_load_prescribes (load) && load->value[k]; }

enum { FREE = -1, IDLE = -2 };

/* First of the unknowns of a point that a load is about, and a unit of its values in theirs */
static int first_of (const nodal *s, const pg_load *load) { return pg_load_rotates (load) ? s->dim : 0; }
static double unit_of (const nodal *s, const pg_load *load)
{
    return load->kind == PG_ROTATION ? s->length : load->kind == PG_MOMENT ? 1 / s->length : 1;
}

/* The entry that prescribes each unknown, FREE: none, IDLE: nothing resists. */
static void claim (const nodal *s, const unsigned char *idle, int *by)
{
    const pg_problem *p = s->problem;
    size_t stride = (size_t) s->stride, dim = (size_t) s->dim;
    for (size_t i = 0; i < s->n * stride; i++)
        by[i] = idle && idle[i / stride] && i % stride >= dim ? IDLE : FREE;
    for (size_t l = p->nload; l-- > 0;)                /* the first entry wins */
        for (int k = 0; k < pg_load_components (&p->load[l], s->dim); k++)
            for (size_t i = 0; prescribes (&p->load[l], k) && i < p->load[l].set->npoint; i++)
                by[(size_t) p->load[l].set->point[i] * stride + (size_t) (first_of (s, &p->load[l]) + k)] =
                    (int) l;
}

static pg_status make_supports (nodal *s, const unsigned char *idle)
{
    pg_status status = PG_OK;
    const pg_problem *p = s->problem;
    size_t ndof = s->n * (size_t) s->stride;
    int *by = NULL;
    PG_ALLOC (by, ndof);
    claim (s, idle, by);
    for (size_t i = 0; i < ndof; i++) s->nsupport += by[i] != FREE;
    PG_ALLOC (s->support, s->nsupport);
    PG_ALLOC (s->goal, s->nsupport);
    size_t at = 0;
    for (size_t i = 0; i < ndof; i++) {
        if (by[i] == FREE) continue;
        size_t point = i / (size_t) s->stride;
        const pg_load *load = by[i] >= 0 ? &p->load[by[i]] : NULL;
        int k = (int) (i % (size_t) s->stride) - (load ? first_of (s, load) : s->dim);
        s->support[at] = (nodal_support) { i, point, load ? by[i] : -1, k };
        s->goal[at++] = load ? pg_load_pattern (load, k, s->dim, p->cloud.x + point * (size_t) s->dim)
                                   * unit_of (s, load)
                             : 0;
    }
    if (s->nsupport == 0) goto done;
    PG_TRY (pg_sparse_create (&s->T, ndof, ndof - s->nsupport, ndof - s->nsupport, 0));
    long column = 0;
    for (size_t i = 0; i < ndof; i++) {
        if (by[i] != FREE) continue;
        s->T.row[column] = (long) i, s->T.value[column] = 1;
        column++;
        s->T.start[column] = column;
    }
done:
    pg_free (by);
    return status;
}

static double goal_of (const nodal *s, size_t k, double t)
{
    if (s->support[k].load < 0) return 0;
    const pg_load *load = &s->problem->load[s->support[k].load];
    if (pg_load_separates (load)) return s->goal[k] * pg_load_factor (load, t);
    return pg_load_value (load, s->support[k].component, s->dim,
                          s->problem->cloud.x + s->support[k].point * (size_t) s->dim, t)
           * unit_of (s, load);
}

const pg_sparse *nodal_basis (const nodal *s) { return s->nsupport ? &s->T : NULL; }

void nodal_impose (const nodal *s, double t, double *d)
{
    for (size_t k = 0; k < s->nsupport; k++) d[s->support[k].dof] = goal_of (s, k, t);
}

/* ---- loads --------------------------------------------------------------------------------------------- */
/* The pattern at t, or at factor 1. */
static void evaluate (const nodal *s, nodal_load *l, double t)
{
    const pg_load *load = &s->problem->load[l->load];
    int pressure = load->kind == PG_PRESSURE;
    size_t dim = (size_t) l->components;
    double unit = unit_of (s, load);
    memset (l->pattern, 0, l->npoint * dim * sizeof *l->pattern);
    for (size_t i = 0; i < l->npart; i++) {
        const nodal_part *q = &l->part[i];
        for (size_t k = 0; k < dim; k++) {
            int c = pressure ? 0 : (int) k;
            double f = l->separates ? pg_load_pattern (load, c, s->dim, q->x)
                                    : pg_load_value (load, c, s->dim, q->x, t);
            l->pattern[q->at * dim + k] += q->weight * (pressure ? -f * q->normal[k] : f * unit);
        }
    }
    l->time = t;
}

static pg_status make_load (nodal *s, nodal_load *l, int load)
{
    pg_status status = PG_OK;
    l->load = load, l->separates = pg_load_separates (&s->problem->load[load]), l->time = NAN;
    l->first = first_of (s, &s->problem->load[load]),
    l->components = pg_load_components (&s->problem->load[load], s->dim);
    PG_TRY (nodal_parts (l, s, load));
    PG_ALLOC (l->pattern, l->npoint * (size_t) l->components);
    if (!l->separates) goto done;
    evaluate (s, l, 0);
    pg_free (l->part);
    l->part = NULL, l->npart = 0;
done:
    return status;
}

/* Factor of the pattern as it is now. */
static double bring_to (const nodal *s, nodal_load *l, double t)
{
    if (l->separates) return pg_load_factor (&s->problem->load[l->load], t);
    if (!(l->time == t)) evaluate (s, l, t);
    return 1;
}

void nodal_add (nodal *s, double t, double *P)
{
    size_t stride = (size_t) s->stride;
    for (size_t k = 0; k < s->nload; k++) {
        nodal_load *l = &s->load[k];
        size_t dim = (size_t) l->components;
        double factor = bring_to (s, l, t);
        for (size_t i = 0; i < l->npoint; i++)
            for (size_t c = 0; c < dim; c++)
                P[(size_t) l->point[i] * stride + (size_t) l->first + c] += factor * l->pattern[i * dim + c];
    }
}

pg_status nodal_surface (const nodal *s, int load, const double *stress, double *P)
{
    pg_status status = PG_OK;
    nodal_load l = { .load = load };
    PG_TRY (nodal_parts (&l, s, load));
    for (size_t i = 0; i < l.npart; i++) {
        const nodal_part *q = &l.part[i];
        double *p = P + (size_t) l.point[q->at] * (size_t) s->stride;
        for (int k = 0; k < s->dim; k++)
            for (int c = 0; c < s->dim; c++)
                p[k] += q->weight * stress[pg_voigt_at (s->dim, k, c)] * q->normal[c];
    }
done:
    pg_free (l.point), pg_free (l.part);
    return status;
}

/* A point under several loads counts once for each: a size, no more. */
double nodal_size (nodal *s, double t)
{
    double sum = 0;
    for (size_t k = 0; k < s->nload; k++) {
        double factor = bring_to (s, &s->load[k], t), square = 0;
        for (size_t i = 0; i < s->load[k].npoint * (size_t) s->load[k].components; i++)
            square += s->load[k].pattern[i] * s->load[k].pattern[i];
        sum += factor * factor * square;
    }
    return sqrt (sum);
}

/* ---- work_balance -------------------------------------------------------------------------------------- */
pg_status nodal_work_balance (nodal *s, double t, const double *d, const double *residual,
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
        const nodal_support *q = &s->support[k];
        out->force[k] = -residual[q->dof], out->displacement[k] = goal_of (s, k, t);
        if (q->load >= 0)
            out->reaction[q->load * 3 + q->component] -= residual[q->dof]
                                                         * unit_of (s, &s->problem->load[q->load]);
    }
    for (size_t k = 0; k < s->nload; k++) {
        nodal_load *l = &s->load[k];
        double factor = bring_to (s, l, t);
        for (size_t i = 0; i < l->npoint; i++)
            for (size_t c = 0; c < (size_t) l->components; c++, at++) {
                out->force[at] = factor * l->pattern[i * (size_t) l->components + c];
                out->displacement[at] = d[(size_t) l->point[i] * (size_t) s->stride + (size_t) l->first + c];
                out->reaction[(size_t) l->load * 3 + c] += out->force[at]
                                                           / unit_of (s, &s->problem->load[l->load]);
            }
    }
done:
    return status;
}

/* ---- life ---------------------------------------------------------------------------------------------- */
pg_status nodal_create (nodal *s, const pg_problem *problem, int stride, double length,
                        const unsigned char *idle)
{
    pg_status status = PG_OK;
    *s = (nodal){
        .problem = problem, .dim = problem->dim, .stride = stride, .length = length, .n = problem->cloud.n
    };
    PG_TRY (make_supports (s, idle));
    PG_ALLOC (s->load, problem->nload);
    for (size_t l = 0; l < problem->nload; l++)
        if (!pg_load_prescribes (&problem->load[l])) PG_TRY (make_load (s, &s->load[s->nload++], (int) l));
done:
    return status;
}

void nodal_free (nodal *s)
{
    for (size_t k = 0; k < s->nload; k++)
        pg_free (s->load[k].point), pg_free (s->load[k].part), pg_free (s->load[k].pattern);
    pg_free (s->load), pg_free (s->support), pg_free (s->goal);
    pg_sparse_clear (&s->T);
    *s = (nodal) { 0 };
}
