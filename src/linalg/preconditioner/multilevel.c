/* SPDX-License-Identifier: GPL-3.0-or-later
 * The multilevel preconditioner: creation, choice of levels, the coarsest matrix and its factor.
 *
 * Grids double their step from level to level until some thousand unknowns remain, which a Cholesky
 * factorisation takes. */
#include "multilevel.h"
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

/* Most unknowns of a coarsest level, unless there are MOST_LEVELS of them. */
enum { DIRECT = 3000 };

/* Frees a level; positions, right-hand side and solution of the finest belong to the caller. */
static void level_clear (level *l, int finest)
{
    void *all[] = { l->start,
                    l->node,
                    l->value,
                    l->mask,
                    l->inverse,
                    l->coarse.cell,
                    l->coarse.cell_start,
                    l->coarse.cell_node,
                    l->coarse.first,
                    l->coarse.function,
                    l->coarse.weight,
                    l->coarse.at,
                    l->coarse.member,
                    l->coarse.share,
                    l->r,
                    l->d,
                    l->q,
                    finest ? NULL : l->b,
                    finest ? NULL : l->z,
                    l->places };
    for (size_t k = 0; k < sizeof all / sizeof *all; k++) pg_free (all[k]);
    pg_subdomain_free (&l->made);
    level_ranks_free (&l->ranks);
}

void pg_multilevel_free (pg_multilevel **multilevel)
{
    pg_multilevel *m = *multilevel;
    if (!m) return;
    if (m->factor) m->direct->free (&m->factor);
    if (m->shared) m->below->free (&m->shared);
    for (int k = 0; k < MOST_LEVELS; k++) level_clear (&m->at[k], k == 0);
    level_clear (&m->meet, 0);
    pg_free (m->whole), pg_free (m->slot), pg_free (m->total);
    pg_free (m);
    *multilevel = NULL;
}

/* ---- the coarsest matrix ------------------------------------------------------------------------------- */
/* Is unknown k of node i masked? */
static int masked (const level *l, size_t i, size_t k) { return l->mask[i] >> k & 1; }

/* Upper triangle of the coarsest matrix, identity at masked unknowns. `lift` times each diagonal entry is
 * added, because the matrix may be singular (loose fragments; functions that are sums of others); its
 * right-hand sides have nothing in those directions but rounding. */
static pg_status coarsest_matrix (pg_sparse *A, const level *l, double lift)
{
    pg_status status = PG_OK;
    size_t block = (size_t) l->block, nnz = 0;
    for (size_t i = 0; i < l->n; i++)
        for (size_t e = l->start[i]; e < l->start[i + 1] && (size_t) l->node[e] <= i; e++)
            nnz += block * block;
    PG_TRY (pg_sparse_create (A, l->ndof, l->ndof, nnz, 1));
    long at = 0;
    for (size_t i = 0; i < l->n; i++)
        for (size_t c = 0; c < block; c++) {
            for (size_t e = l->start[i]; e < l->start[i + 1] && (size_t) l->node[e] <= i; e++) {
                size_t j = (size_t) l->node[e];
                for (size_t a = 0; a < block && j * block + a <= i * block + c; a++) {
                    int own = j == i && a == c, out = masked (l, j, a) || masked (l, i, c);
                    A->row[at] = (long) (j * block + a);
                    A->value[at++] = out ? own : l->value[(e * block + c) * block + a] * (own ? 1 + lift : 1);
                }
            }
            A->start[i * block + c + 1] = at;
        }
done:
    return status;
}

/* Factors the coarsest matrix, with a lift of 1e-10, raised to 1e-4 at most while the factorisation fails. */
static pg_status factor_coarsest (pg_multilevel *m, level *l)
{
    pg_status status = PG_OK;
    pg_sparse A = { 0 };
    pg_linear_options o = { l->block, l->dim, 1, 0, 1 };
    m->direct = pg_linear_first (1, 1);
    for (double lift = 1e-10; ; lift *= 100) {
        pg_sparse_clear (&A);
        PG_TRY (coarsest_matrix (&A, l, lift));
        if (!m->factor) PG_TRY (m->direct->analyse (&m->factor, &A, &o));
        int threads = pg_linear_threads (1);
        pg_status now = m->direct->factor (m->factor, &A);
        pg_linear_threads (threads);
        if (now == PG_E_NOT_SPD && lift < 1e-5) continue;
        PG_TRY (now);
        break;
    }
done:
    pg_sparse_clear (&A);
    return status;
}

/* ---- levels -------------------------------------------------------------------------------------------- */
/* Allocates the vectors of the cycle. */
static pg_status make_vectors (level *l, int finest)
{
    pg_status status = PG_OK;
    PG_ALLOC (l->r, l->ndof);
    PG_ALLOC (l->d, l->ndof);
    PG_ALLOC (l->q, l->ndof);
    if (finest) goto done;
    PG_ALLOC (l->b, l->ndof);
    PG_ALLOC (l->z, l->ndof);
done:
    return status;
}

/* Makes all that is below the finest level l where ranks share it (multilevel_meet). */
static pg_status meet (pg_multilevel *m, const level *l)
{
    pg_status status = PG_OK;
    PG_TRY (level_coarsen (&m->meet, l));
    PG_TRY (make_vectors (&m->meet, 0));
    PG_TRY (multilevel_meet (m, l));
done:
    return status;
}

/* Makes the levels from the finest down. The smoother of a level needs a bound of its spectrum. */
static pg_status make_levels (pg_multilevel *m, double step)
{
    pg_status status = PG_OK;
    for (;; step *= 2) {
        level *l = &m->at[m->count++];
        PG_TRY (make_vectors (l, m->count == 1));
        if (m->count > 1 && (l->ndof <= DIRECT || m->count == MOST_LEVELS)) {
            PG_TRY (factor_coarsest (m, l));
            break;
        }
        PG_TRY (level_bound (l));
        PG_TRY (level_space (l, step));
        PG_TRY (l->part ? meet (m, l) : level_coarsen (&m->at[m->count], l));
        if (m->shared) break;
    }
done:
    return status;
}

/* Grid steps below the reach of the couplings would give coarse matrices as full as the fine one: 4/3 of
 * the reach by default. */
pg_status pg_multilevel_create (pg_multilevel **out, const pg_multilevel_setting *s)
{
    pg_status status = PG_OK;
    pg_multilevel *m = NULL;
    *out = NULL;
    if (s->dim < 1 || s->dim > 3 || s->block < 1 || s->block > MOST_BLOCK)
        PG_FAIL (PG_E_USAGE, "a preconditioner of %d dimensions with %d unknowns a node: there is none",
                 s->dim, s->block);
    if (!(s->rows.reach > 0) || s->n == 0)
        PG_FAIL (PG_E_USAGE, "a preconditioner needs nodes and how far their couplings reach (%g m)",
                 s->rows.reach);
    PG_ALLOC (m, 1);
    m->degree = s->degree > 0 ? s->degree : 2;
    level *l = &m->at[0];
    l->dim = s->dim, l->block = s->block, l->threads = s->threads > 1 ? s->threads : 1, l->n = s->n,
    l->ndof = s->n * (size_t) s->block;
    l->x = s->x, l->grid.aligned = s->aligned;
    l->A = s->A, l->rows = s->rows, l->part = s->subdomain;
    for (int k = 0; k < 3; k++) l->reach[k] = s->rows.reach;
    double step = (s->step > 0 ? s->step : 4.0 / 3) * s->rows.reach;
    PG_TRY (level_diagonal (l, s->fixed));
    PG_TRY (level_join (l, &step));
    PG_TRY (make_levels (m, step));
    *out = m, m = NULL;
done:
    pg_multilevel_free (&m);
    return status;
}

/* z = M r: one V-cycle that starts from zero. */
static pg_status solve (void *context, const double *r, double *z)
{
    pg_multilevel *m = context;
    m->applications++;
    return multilevel_cycle (m, 0, r, z);
}

pg_preconditioner pg_multilevel_preconditioner (pg_multilevel *m)
{
    return (pg_preconditioner){ m, solve, m->at[0].threads };
}

/* The coarsest level has no functions and no bound. */
void pg_multilevel_describe (const pg_multilevel *m, pg_multilevel_info *info)
{
    *info = (pg_multilevel_info) { .levels = m->count, .degree = m->degree, .applications = m->applications };
    for (int k = 0; k < m->count && k < 8; k++)
        info->unknowns[k] = m->at[k].ndof, info->top[k] = m->at[k].top;
    for (size_t h = 0; m->count > 1 && h < m->at[0].grid.nvertex; h++)
        info->split += m->at[0].coarse.first[h + 1] - m->at[0].coarse.first[h] > 1;
}

void pg_multilevel_describe_shared (const pg_multilevel *m, char *text, size_t size)
{
    size_t at = (size_t) snprintf (text, size, "%.0f unknowns, then ", m->unknowns);
    if (at >= size) return;
    if (m->shared) m->below->describe (m->shared, text + at, size - at);
    else at += (size_t) snprintf (text + at, size - at, "on every rank");
    for (int k = 1; k < m->count && at < size; k++)
        at += (size_t) snprintf (text + at, size - at, "%s%zu", k > 1 ? ", " : " ", m->at[k].ndof);
}
