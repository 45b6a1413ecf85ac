/* SPDX-License-Identifier: GPL-3.0-or-later
 * Essential conditions of forces whose unknowns are the values of the points: prescribed unknowns are
 * eliminated, d = T q + g, where T selects the free ones. */
#include "point_boundary.h"

/* Is component k prescribed by the load? */
static int prescribes (const pg_load *load, int k) { return pg_load_prescribes (load) && load->value[k]; }

enum { FREE = -1, IDLE = -2 };

/* Holds rotations in a plane of symmetry at 0 except those about its normal, unless a load prescribes
 * them. */
static void hold_rotations (const point_boundary *s, const pg_load *load, int *by)
{
    int dim = s->dim;
    for (size_t i = 0; i < load->set->npoint; i++)
        for (int k = dim; k < s->stride; k++) {
            int *of = &by[load->set->point[i] * s->stride + k];
            if (*of == FREE && (dim == 2 || k - dim != load->symmetry - 1)) *of = IDLE;
        }
}

/* by: number of the entry of `boundary` that prescribes each unknown; FREE: none; IDLE: a rotation without
 * stiffness, held at 0 so that K is regular. */
static void claim (const point_boundary *s, const unsigned char *idle, int *by)
{
    const pg_problem *p = s->problem;
    size_t stride = (size_t) s->stride, dim = (size_t) s->dim;
    for (size_t i = 0; i < s->n * stride; i++)
        by[i] = idle && idle[i / stride] && i % stride >= dim ? IDLE : FREE;
    for (size_t l = p->boundary.nload; l-- > 0;)                /* the first entry wins */
        for (int k = 0; k < pg_load_components (&p->boundary.load[l], s->dim); k++)
            for (size_t i = 0; prescribes (&p->boundary.load[l], k) && i < p->boundary.load[l].set->npoint;
                 i++)
                by[(size_t) p->boundary.load[l].set->point[i] * stride + (size_t) (boundary_first (s,
                        &p->boundary.load[l]) + k)] =
                    (int) l;
    for (size_t l = 0; l < p->boundary.nload; l++)
        if (p->boundary.load[l].symmetry) hold_rotations (s, &p->boundary.load[l], by);
}

/* Makes the list of supports, ascending by unknown, and T, whose columns are the free unknowns, with one 1 in
 * each column. */
pg_status boundary_make_supports (point_boundary *s, const unsigned char *idle)
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
    PG_ALLOC (s->factor, p->boundary.nload);
    PG_ALLOC (s->separates, p->boundary.nload);
    for (size_t l = 0; l < p->boundary.nload; l++)
        s->separates[l] = pg_load_prescribes (&p->boundary.load[l])
                          && pg_load_separates (&p->boundary.load[l]);
    size_t at = 0;
    for (size_t i = 0; i < ndof; i++) {
        if (by[i] == FREE) continue;
        size_t point = i / (size_t) s->stride;
        const pg_load *load = by[i] >= 0 ? &p->boundary.load[by[i]] : NULL;
        int k = (int) (i % (size_t) s->stride) - (load ? boundary_first (s, load) : s->dim);
        s->support[at] = (boundary_support) { i, point, load ? by[i] : -1, k };
        s->goal[at++] = load ? pg_load_pattern (load, k, s->dim, p->cloud.x + point * (size_t) s->dim)
                                   * boundary_unit (s, load)
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

/* What all supports prescribe at time t, m (rotations times s->length), at out[k] or, if dof is set, at
 * out[unknown of support k]. Separable loads are a stored pattern times a factor of t, which all supports of
 * the load share; others are evaluated anew; an idle rotation is 0. */
static void find_goals (const point_boundary *s, double t, int dof, double *out)
{
    const pg_problem *p = s->problem;
    for (size_t l = 0; l < p->boundary.nload; l++)
        if (s->separates[l]) s->factor[l] = pg_load_factor (&p->boundary.load[l], t);
    for (size_t k = 0; k < s->nsupport; k++) {
        const boundary_support *q = &s->support[k];
        double *goal = out + (dof ? q->dof : k);
        if (q->load < 0) *goal = 0;
        else if (s->separates[q->load]) *goal = s->goal[k] * s->factor[q->load];
        else
            *goal = pg_load_value (&p->boundary.load[q->load], q->component, s->dim,
                                   p->cloud.x + q->point * (size_t) s->dim, t)
                    * boundary_unit (s, &p->boundary.load[q->load]);
    }
}

void boundary_goals (const point_boundary *s, double t, double *out) { find_goals (s, t, 0, out); }

/* The matrix T that selects the free unknowns; NULL: all are free. */
const pg_sparse *boundary_basis (const point_boundary *s) { return s->nsupport ? &s->T : NULL; }

/* Sets d at prescribed unknowns; the others stay as they are. */
void boundary_impose (const point_boundary *s, double t, double *d) { find_goals (s, t, 1, d); }

/* ---- creation and release ------------------------------------------------------------------------------ */
/* Makes the supports first, then the loads that prescribe no displacement, then the springs. */
pg_status boundary_create (point_boundary *s, const pg_problem *problem, int stride, double length,
                        const unsigned char *idle)
{
    pg_status status = PG_OK;
    *s = (point_boundary){
        .problem = problem, .dim = problem->dim, .stride = stride, .length = length, .n = problem->cloud.n
    };
    PG_TRY (boundary_make_supports (s, idle));
    PG_ALLOC (s->load, problem->boundary.nload);
    for (size_t l = 0; l < problem->boundary.nload; l++)
        if (!pg_load_prescribes (&problem->boundary.load[l]) && problem->boundary.load[l].kind != PG_SPRING)
            PG_TRY (boundary_make_load (s, &s->load[s->nload++], (int) l));
    PG_TRY (boundary_make_springs (s));
done:
    return status;
}

/* Frees what boundary_create made, also where it failed halfway; *s is zero afterwards. */
void boundary_free (point_boundary *s)
{
    for (size_t k = 0; k < s->nload; k++)
        pg_free (s->load[k].point), pg_free (s->load[k].part), pg_free (s->load[k].pattern);
    pg_free (s->load), pg_free (s->support), pg_free (s->goal), pg_free (s->spring), pg_free (s->hold),
        pg_free (s->factor), pg_free (s->separates);
    pg_nearest_free (&s->near);
    pg_sparse_clear (&s->T);
    *s = (point_boundary) { 0 };
}
