/* SPDX-License-Identifier: GPL-3.0-or-later
 * Displacements at positions on faces, as sums over nodal unknowns, by shape functions of the nodes on one
 * side only: nodes that a crack hides from an eye slightly beside the face are left out.
 * Jump across a crack: the functions of one side minus those of the other. They have a radius of their own:
 * within that of the body nodes beside a crack that passes close to their row have too few neighbours for a
 * linear basis (all on one line), and any functions that reproduce linear fields serve. Where a side still
 * has too few, wider supports are tried, as in cut cells (pg_rows_widen): never across a crack, and never
 * across a slot or gap.
 * Trace on the surface of the body: the functions by which a traction acts there, so that forces at these
 * positions are tractions like any other. */
#include "one_sided.h"
#include <string.h>

/* Distance of the eye from the face, in spacings: beyond what counts as on the face (PG_NO_LENGTH). */
static const double BESIDE = 5 * PG_NO_LENGTH;

typedef struct {
    const pg_problem *p;
    const pg_cracks *cracks;
    const double *x, *normal;
    double side;                                /* 1: the side that the normal points to; -1: the other one */
    int    flat;   /* 1: nodes are told apart by the plane of the position where no crack passes through it */
    const pg_rows *rows;
    unsigned char *alive;
} looking;

/* What is wanted of the two sides, 1 and -1: the factor of their functions (0: not computed), the worst grade
 * of basis that is accepted, and `flat` of looking. surface: positions are on the surface of the body. */
typedef struct { double factor[2]; int worst, flat, surface; } sides;

/* Is the node on this side of position q, with no crack or slot between? On faces left by bonds that broke
 * one by one (flat) sides are told apart by the plane of the position. */
static int sees (void *context, size_t q, int node)
{
    const looking *l = context;
    const pg_problem *p = l->p;
    size_t dim = (size_t) p->dim;
    const double *x = l->x + q * dim, *normal = l->normal + q * dim, *to = p->cloud.x + (size_t) node * dim;
    double eye[3], off = 0, away = l->side * BESIDE * pg_problem_spacing_at (p, x);
    if (l->flat && !pg_cracks_touch (l->cracks, x, PG_NO_LENGTH * p->cloud.h)) {
        for (size_t k = 0; k < dim; k++) off += normal[k] * (to[k] - x[k]);
        return l->side * off > 0;
    }
    for (size_t k = 0; k < dim; k++) eye[k] = x[k] + away * normal[k];
    return !pg_cracks_cut (l->cracks, eye, to, pg_cloud_same (&p->cloud))
           && !pg_cracks_cut (&p->crack.slots, eye, to, pg_cloud_same (&p->cloud));
}

static void look (void *context, size_t first, size_t last, int thread)
{
    looking *l = context;
    const pg_family *f = &l->rows->family;
    (void) thread;
    for (size_t q = first; q < last; q++)
        for (size_t e = f->start[q]; e < f->start[q + 1]; e++) l->alive[e] = sees (l, q, f->node[e]) != 0;
}

/* Computes the shape functions of one side, 0 for nodes that are hidden from it; positions with too few
 * neighbours get wider supports (pg_rows_widen). */
static pg_status side_of (pg_rows *rows, const pg_approx *a, looking *l, size_t n, int surface)
{
    pg_status status = PG_OK;
    pg_family_search *search = NULL;
    pg_widened wide = { 0 };
    double *eye = NULL;
    const pg_cloud *cloud = &l->p->cloud;
    PG_TRY (pg_rows_search (&search, a, cloud));
    if (surface) PG_TRY (pg_rows_eyes (&eye, cloud, n, l->x, l->normal));
    PG_TRY (pg_rows_place (rows, search, cloud, n, l->x, NULL, NULL, NULL, eye, l->p->threads));
    PG_TRY (pg_rows_widen (rows, a, cloud, sees, l, l->p->threads, &wide));
    PG_ALLOC (rows->N, rows->family.start[n]);
    PG_ALLOC (rows->grade, n);
    PG_ALLOC (l->alive, rows->family.start[n]);
    l->rows = rows;
    pg_parallel (l->p->threads, n, look, l);
    PG_TRY (a->type->evaluate (a, cloud, rows, l->alive, n, NULL, l->p->threads));
done:
    pg_family_search_free (&search);
    pg_free (eye), pg_free (wide.blind), pg_free (l->alive), l->alive = NULL;
    return status;
}

/* Adds the functions of one side at position q, times a factor, to row q of the list, which is the last
 * one. */
static pg_status add_place (pg_jump_rows *out, size_t cap[2], const pg_rows *rows, size_t q, double factor)
{
    pg_status status = PG_OK;
    size_t from = out->start[q], end = out->start[q + 1];
    for (size_t e = rows->family.start[q]; e < rows->family.start[q + 1]; e++) {
        size_t at = from;
        if (rows->N[e] == 0) continue;
        while (at < end && out->node[at] != rows->family.node[e]) at++;
        if (at == end) {
            PG_GROW (out->node, cap[0], end + 1);
            PG_GROW (out->value, cap[1], end + 1);
            out->node[end] = rows->family.node[e], out->value[end++] = 0;
        }
        out->value[at] += factor * rows->N[e];
    }
    out->start[q + 1] = end;
done:
    return status;
}

static pg_status find (const pg_problem *p, const pg_approx *a, const pg_state *state, size_t n,
                       const double *x, const double *normal, const sides *wanted, pg_jump_rows *out)
{
    pg_status status = PG_OK;
    pg_rows rows[2] = { { 0 }, { 0 } };
    size_t cap[2] = { 0 };
    looking l = { .p = p, .cracks = pg_state_cracks (p, state), .x = x, .normal = normal,
                  .flat = wanted->flat };
    memset (out, 0, sizeof *out);
    out->n = n;
    PG_ALLOC (out->start, n + 1);
    for (int side = 0; side < 2; side++) {
        l.side = side ? -1 : 1;
        if (wanted->factor[side] != 0) PG_TRY (side_of (&rows[side], a, &l, n, wanted->surface));
    }
    for (size_t q = 0; q < n; q++) {
        int poor = 0;
        out->start[q + 1] = out->start[q];
        for (int side = 0; side < 2; side++)
            poor |= wanted->factor[side] != 0 && rows[side].grade[q] > wanted->worst;
        out->poor += (size_t) poor;
        for (int side = 0; side < 2 && !poor; side++)
            if (wanted->factor[side] != 0)
                PG_TRY (add_place (out, cap, &rows[side], q, wanted->factor[side]));
    }
    /* lists without any entry are allocated all the same */
    PG_GROW (out->node, cap[0], out->start[n] + 1);
    PG_GROW (out->value, cap[1], out->start[n] + 1);
done:
    for (int side = 0; side < 2; side++) pg_rows_clear (&rows[side]);
    if (status != PG_OK) pg_jump_rows_clear (out);
    return status;
}

pg_status jump_rows (const pg_problem *p, const pg_approx *by, const pg_state *state, size_t n,
                     const double *x, const double *normal, double radius, int flat, pg_jump_rows *out)
{
    const sides both = { { 1, -1 }, PG_GRADE_FULL, flat, 0 };
    pg_approx a = *by;
    a.horizon = radius * p->cloud.h, a.order = 1, a.congruent = a.extrapolates = a.projected = 0;
    return find (p, &a, state, n, x, normal, &both, out);
}

pg_status trace_rows (const pg_problem *p, const pg_approx *by, const pg_state *state, size_t n,
                      const double *x, const double *normal, pg_jump_rows *out)
{
    const sides inner = { { 0, 1 }, PG_GRADE_LOWERED, 0, 1 };
    pg_approx a = *by;
    a.congruent = 0;
    return find (p, &a, state, n, x, normal, &inner, out);
}

/* Frees the lists; may be called for ones that were never filled. */
void pg_jump_rows_clear (pg_jump_rows *rows)
{
    pg_free (rows->start), pg_free (rows->node), pg_free (rows->value);
    memset (rows, 0, sizeof *rows);
}
