/* SPDX-License-Identifier: GPL-3.0-or-later
 * The jump of the displacement across a crack, as sums over nodal unknowns: one-sided shape functions of
 * a place on the crack, seen from a hair's breadth beside it on either side, one less the other. They have a
 * radius of their own: nodes beside a crack that passes close to their row see too little within that of the
 * body for a linear basis (they would lie on one line), and any functions that reproduce linear fields
 * serve. */
#include "jump.h"
#include <string.h>

/* How far beside the crack the place looks from, spacings: beyond what counts as on it (PG_NO_LENGTH). */
static const double BESIDE = 5 * PG_NO_LENGTH;

typedef struct {
    const pg_problem *p;
    const pg_cracks *cracks;
    const pg_rows *rows;
    const double *normal;
    double side;                                       /* 1: that the normal shows to; -1 */
    unsigned char *alive;
} looking;

/* Which nodes does each place see from its side? */
static void look (void *context, size_t first, size_t last, int thread)
{
    const looking *l = context;
    const pg_problem *p = l->p;
    size_t dim = (size_t) p->dim;
    (void) thread;
    for (size_t q = first; q < last; q++) {
        const double *x = l->rows->x + q * dim;
        double eye[3], away = l->side * BESIDE * pg_problem_spacing_at (p, x);
        for (size_t k = 0; k < dim; k++) eye[k] = x[k] + away * l->normal[q * dim + k];
        for (size_t e = l->rows->family.start[q]; e < l->rows->family.start[q + 1]; e++)
            l->alive[e] = !pg_cracks_cut (l->cracks, eye,
                                          p->cloud.x + (size_t) l->rows->family.node[e] * dim,
                                          1e-9 * p->cloud.h);
    }
}

/* Adds the functions of one side, times its sign, to the values of the rows; places whose basis is not the
 * whole one are marked. */
static pg_status add_side (const pg_approx *a, looking *l, pg_rows *rows, double *value,
                           unsigned char *poor)
{
    pg_status status = PG_OK;
    size_t n = rows->n;
    pg_parallel (l->p->threads, n, look, l);
    PG_TRY (a->type->evaluate (a, &l->p->cloud, rows, l->alive, n, NULL, l->p->threads));
    for (size_t q = 0; q < n; q++) {
        poor[q] |= rows->grade[q] != PG_GRADE_FULL;
        for (size_t e = rows->family.start[q]; e < rows->family.start[q + 1]; e++)
            value[e] += l->side * rows->N[e];
    }
done:
    return status;
}

pg_status jump_rows (const pg_problem *p, const pg_approx *by, const pg_state *state, size_t n,
                     const double *x, const double *normal, double radius, pg_jump_rows *out)
{
    pg_status status = PG_OK;
    pg_approx a = *by;
    pg_family_search *search = NULL;
    pg_rows rows = { 0 };
    unsigned char *poor = NULL;
    looking l = { .p = p, .cracks = pg_state_cracks (p, state), .rows = &rows, .normal = normal };
    memset (out, 0, sizeof *out);
    a.horizon = radius * p->cloud.h, a.order = 1, a.congruent = a.extrapolates = a.projected = 0;
    PG_TRY (pg_rows_search (&search, &a, &p->cloud));
    PG_TRY (pg_rows_place (&rows, search, p->dim, n, x, NULL, NULL, NULL, p->threads));
    size_t bonds = rows.family.start[n];
    PG_ALLOC (rows.N, bonds);
    PG_ALLOC (rows.grade, n);
    PG_ALLOC (l.alive, bonds);
    PG_ALLOC (poor, n);
    PG_ALLOC (out->value, bonds);
    PG_ALLOC (out->node, bonds);
    PG_ALLOC (out->start, n + 1);
    for (int side = 0; side < 2; side++) {
        l.side = side ? -1 : 1;
        PG_TRY (add_side (&a, &l, &rows, out->value, poor));
    }
    out->n = n;
    memcpy (out->start, rows.family.start, (n + 1) * sizeof *out->start);
    memcpy (out->node, rows.family.node, bonds * sizeof *out->node);
    for (size_t q = 0; q < n; q++) {
        if (!poor[q]) continue;
        out->poor++;
        for (size_t e = out->start[q]; e < out->start[q + 1]; e++) out->value[e] = 0;
    }
done:
    pg_family_search_free (&search);
    pg_rows_clear (&rows);
    pg_free (l.alive), pg_free (poor);
    if (status != PG_OK) pg_jump_rows_clear (out);
    return status;
}
