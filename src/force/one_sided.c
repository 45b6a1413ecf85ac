/* SPDX-License-Identifier: GPL-3.0-or-later
 * Displacements at places on faces, as sums over nodal unknowns, by shape functions that see one side only:
 * from a hair's breadth beside the face, nodes behind a crack are not seen.
 *
 * Jump across a crack: the functions of one side less those of the other. They have a radius of their own:
 * nodes beside a crack that passes close to their row see too little within that of the body for a linear
 * basis (they would lie on one line), and any functions that reproduce linear fields serve.
 *
 * Trace on the surface of the body: the functions by which a traction acts there, so that forces at these
 * places are tractions like any other. */
#include "one_sided.h"
#include <string.h>

/* How far beside the face the place looks from, spacings: beyond what counts as on it (PG_NO_LENGTH). */
static const double BESIDE = 5 * PG_NO_LENGTH;

typedef struct {
    const pg_problem *p;
    const pg_cracks *cracks;
    const pg_rows *rows;
    const double *normal;
    double side;                                       /* 1: that the normal shows to; -1 */
    int    flat;                                       /* 1: places beside all cracks are on planes */
    unsigned char *alive;
} looking;

/* What is wanted of the two sides, 1 and -1: the factor of their functions (0: not looked at), the least good
 * basis that still counts, and `flat` of looking. */
typedef struct { double factor[2]; int worst, flat; } sides;

/* Nodes on that side of the plane of a place. */
static void look_flat (const looking *l, size_t q)
{
    size_t dim = (size_t) l->p->dim;
    for (size_t e = l->rows->family.start[q]; e < l->rows->family.start[q + 1]; e++) {
        const double *x = l->p->cloud.x + (size_t) l->rows->family.node[e] * dim;
        double off = 0;
        for (size_t k = 0; k < dim; k++) off += l->normal[q * dim + k] * (x[k] - l->rows->x[q * dim + k]);
        l->alive[e] = l->side * off > 0;
    }
}

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
        if (l->flat && !pg_cracks_touch (l->cracks, x, PG_NO_LENGTH * p->cloud.h)) {
            look_flat (l, q);
            continue;
        }
        for (size_t e = l->rows->family.start[q]; e < l->rows->family.start[q + 1]; e++)
            l->alive[e] = !pg_cracks_cut (l->cracks, eye,
                                          p->cloud.x + (size_t) l->rows->family.node[e] * dim,
                                          1e-9 * p->cloud.h);
    }
}

/* Adds the functions of one side, times their factor, to the values of the rows; places whose basis is not
 * good enough are marked. */
static pg_status add_side (const pg_approx *a, looking *l, pg_rows *rows, double factor, int worst,
                           double *value, unsigned char *poor)
{
    pg_status status = PG_OK;
    size_t n = rows->n;
    pg_parallel (l->p->threads, n, look, l);
    PG_TRY (a->type->evaluate (a, &l->p->cloud, rows, l->alive, n, NULL, l->p->threads));
    for (size_t q = 0; q < n; q++) {
        poor[q] |= rows->grade[q] > worst;
        for (size_t e = rows->family.start[q]; e < rows->family.start[q + 1]; e++)
            value[e] += factor * rows->N[e];
    }
done:
    return status;
}

static pg_status find (const pg_problem *p, const pg_approx *a, const pg_state *state, size_t n,
                       const double *x, const double *normal, const sides *wanted, pg_jump_rows *out)
{
    pg_status status = PG_OK;
    pg_family_search *search = NULL;
    pg_rows rows = { 0 };
    unsigned char *poor = NULL;
    looking l = { .p = p, .cracks = pg_state_cracks (p, state), .rows = &rows, .normal = normal,
                  .flat = wanted->flat };
    memset (out, 0, sizeof *out);
    PG_TRY (pg_rows_search (&search, a, &p->cloud));
    PG_TRY (pg_rows_place (&rows, search, &p->cloud, n, x, NULL, NULL, NULL, NULL, p->threads));
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
        if (wanted->factor[side] == 0) continue;
        PG_TRY (add_side (a, &l, &rows, wanted->factor[side], wanted->worst, out->value, poor));
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

pg_status jump_rows (const pg_problem *p, const pg_approx *by, const pg_state *state, size_t n,
                     const double *x, const double *normal, double radius, int flat, pg_jump_rows *out)
{
    const sides both = { { 1, -1 }, PG_GRADE_FULL, flat };
    pg_approx a = *by;
    a.horizon = radius * p->cloud.h, a.order = 1, a.congruent = a.extrapolates = a.projected = 0;
    return find (p, &a, state, n, x, normal, &both, out);
}

pg_status trace_rows (const pg_problem *p, const pg_approx *by, const pg_state *state, size_t n,
                      const double *x, const double *normal, pg_jump_rows *out)
{
    const sides inner = { { 0, 1 }, PG_GRADE_LOWERED, 0 };
    pg_approx a = *by;
    a.congruent = 0;
    return find (p, &a, state, n, x, normal, &inner, out);
}
