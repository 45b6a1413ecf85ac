/* SPDX-License-Identifier: GPL-3.0-or-later
 * The displacement at places on the surface of the body, as sums over nodal coefficients, by the shape
 * functions by which a traction acts there: forces at these places are then tractions like any other. Nodes
 * behind a crack are not seen, from a hair's breadth inside the body. */
#include "galerkin.h"
#include <string.h>

/* How far below the surface the place looks from, spacings: beyond what counts as on a crack. */
static const double BELOW = 5 * PG_NO_LENGTH;

typedef struct {
    const galerkin *g;
    const pg_cracks *cracks;
    const pg_rows *rows;
    const double *normal;
    unsigned char *alive;
} looking;

static void look (void *context, size_t first, size_t last, int thread)
{
    const looking *l = context;
    const pg_problem *p = l->g->problem;
    size_t dim = (size_t) p->dim;
    (void) thread;
    for (size_t q = first; q < last; q++) {
        const double *x = l->rows->x + q * dim;
        double eye[3], below = BELOW * pg_problem_spacing_at (p, x);
        for (size_t k = 0; k < dim; k++) eye[k] = x[k] - below * l->normal[q * dim + k];
        for (size_t e = l->rows->family.start[q]; e < l->rows->family.start[q + 1]; e++)
            l->alive[e] = !pg_cracks_cut (l->cracks, eye,
                                          p->cloud.x + (size_t) l->rows->family.node[e] * dim,
                                          1e-9 * p->cloud.h);
    }
}

pg_status galerkin_trace (void *self, const pg_state *state, size_t n, const double *x, const double *normal,
                          pg_jump_rows *out)
{
    pg_status status = PG_OK;
    const galerkin *g = self;
    const pg_problem *p = g->problem;
    pg_approx a = p->approx;
    pg_family_search *search = NULL;
    pg_rows rows = { 0 };
    looking l = { .g = g, .cracks = pg_state_cracks (p, state), .rows = &rows, .normal = normal };
    memset (out, 0, sizeof *out);
    a.congruent = 0;
    PG_TRY (pg_rows_search (&search, &a, &p->cloud));
    PG_TRY (pg_rows_place (&rows, search, p->dim, n, x, NULL, NULL, NULL, g->threads));
    size_t bonds = rows.family.start[n];
    PG_ALLOC (rows.N, bonds);
    PG_ALLOC (rows.grade, n);
    PG_ALLOC (l.alive, bonds);
    PG_ALLOC (out->value, bonds);
    PG_ALLOC (out->node, bonds);
    PG_ALLOC (out->start, n + 1);
    pg_parallel (g->threads, n, look, &l);
    PG_TRY (a.type->evaluate (&a, &p->cloud, &rows, l.alive, n, NULL, g->threads));
    out->n = n;
    memcpy (out->start, rows.family.start, (n + 1) * sizeof *out->start);
    memcpy (out->node, rows.family.node, bonds * sizeof *out->node);
    for (size_t q = 0; q < n; q++) {
        int good = rows.grade[q] <= PG_GRADE_LOWERED;
        out->poor += !good;
        for (size_t e = out->start[q]; e < out->start[q + 1]; e++) out->value[e] = good ? rows.N[e] : 0;
    }
done:
    pg_family_search_free (&search);
    pg_rows_clear (&rows);
    pg_free (l.alive);
    if (status != PG_OK) pg_jump_rows_clear (out);
    return status;
}
