/* SPDX-License-Identifier: GPL-3.0-or-later
 * x = P' L'^-1 L^-1 P b by the supernodal factor P A P' = L L' of CHOLMOD, for right-hand sides that are
 * zero but for a few entries. Columns of L with the same rows below are a supernode, a dense block: L11 (a
 * triangle) over L21. Forward,
 *
 *     y_1 = L11^-1 y_1,    y_2 = y_2 - L21 y_1,
 *
 * a supernode has something to do only if y_1 is not zero: those on the paths from the supernodes of the
 * entries that are not zero to the root, where the parent of a supernode is that of the first row of L21 (the
 * theorem on paths of the elimination tree: Gilbert, SIAM J. Matrix Anal. Appl. 15, 1994, 62-79). Of a large
 * 2D body they are a small part of the factor. There the half solve ends: b_i . A^-1 b_j = y_i . y_j.
 * Backward, y_1 = L11'^-1 (y_1 - L21' y_2) takes all supernodes, as the solution is nowhere zero. Right-hand
 * sides lie side by side (Y [position][right-hand side]), so that scattered rows are gathered and scattered
 * in contiguous pieces. */
#include "supernodal.h"
#include <string.h>

void supernodal_clear (supernodal_solver *s)
{
    pg_free (s->place), pg_free (s->parent), pg_free (s->of), pg_free (s->reached);
    pg_free (s->Y), pg_free (s->E), pg_free (s->interval);
    memset (s, 0, sizeof *s);
}

/* CHOLMOD's arrays of a supernode: its columns first .. first + m - 1, its `rows` rows of which the first m
 * are its own, and the block, column by column. */
typedef struct { long first; int m, rows; const SuiteSparse_long *row; const double *block; } supernode;
static supernode take (const cholmod_factor *L, size_t k)
{
    const SuiteSparse_long *super = L->super, *pi = L->pi, *px = L->px, *row = L->s;
    const double *x = L->x;
    return (supernode) { super[k], (int) (super[k + 1] - super[k]), (int) (pi[k + 1] - pi[k]), row + pi[k],
                         x + px[k] };
}

/* Finds positions, supernodes and parents, once for a factor: its pattern does not change. */
static pg_status prepare (const cholmod_factor *L, supernodal_solver *s)
{
    pg_status status = PG_OK;
    const SuiteSparse_long *perm = L->Perm;
    if (s->reached) return PG_OK;
    PG_ALLOC (s->place, L->n);
    PG_ALLOC (s->of, L->n);
    PG_ALLOC (s->parent, L->nsuper);
    PG_ALLOC (s->reached, L->nsuper);
    for (size_t i = 0; i < L->n; i++) s->place[perm[i]] = (long) i;
    for (size_t k = 0; k < L->nsuper; k++) {
        supernode n = take (L, k);
        for (int i = 0; i < n.m; i++) s->of[n.first + i] = (long) k;
    }
    for (size_t k = 0; k < L->nsuper; k++) {
        supernode n = take (L, k);
        s->parent[k] = n.rows > n.m ? s->of[n.row[n.m]] : -1;
    }
done:
    return status;
}

/* Y = P b; marks the supernodes that the forward solve reaches. At the others Y is not set unless `all`. */
static void permute (const cholmod_factor *L, supernodal_solver *s, size_t nrhs, const double *b, int all)
{
    memset (s->reached, 0, L->nsuper);
    for (size_t j = 0; j < nrhs; j++)
        for (size_t i = 0; i < L->n; i++) {
            if (b[j * L->n + i] == 0) continue;
            for (long k = s->of[s->place[i]]; k >= 0 && !s->reached[k]; k = s->parent[k]) s->reached[k] = 1;
        }
    for (size_t k = 0; k < L->nsuper; k++) {
        supernode n = take (L, k);
        if (all || s->reached[k])
            memset (s->Y + (size_t) n.first * nrhs, 0, (size_t) n.m * nrhs * sizeof *s->Y);
    }
    for (size_t j = 0; j < nrhs; j++)
        for (size_t i = 0; i < L->n; i++) {
            double value = b[j * L->n + i];
            if (value != 0) s->Y[(size_t) s->place[i] * nrhs + j] = value;
        }
}

/* Y' is a matrix of nrhs rows: Y_1' = Y_1' L11'^-1, E' = Y_1' L21', Y_2' = Y_2' - E'. */
static void forward (const supernode *n, int nrhs, double *Y, double *E)
{
    static const double one = 1, zero = 0;
    int below = n->rows - n->m;
    double *own = Y + n->first * nrhs;
    dtrsm_ ("R", "L", "T", "N", &nrhs, &n->m, &one, n->block, &n->rows, own, &nrhs);
    if (below == 0) return;
    dgemm_ ("N", "T", &nrhs, &below, &n->m, &one, own, &nrhs, n->block + n->m, &n->rows, &zero, E, &nrhs);
    for (int i = 0; i < below; i++) {
        double *to = Y + n->row[n->m + i] * nrhs;
        for (int j = 0; j < nrhs; j++) to[j] -= E[(size_t) i * (size_t) nrhs + (size_t) j];
    }
}

/* Y_1' = (Y_1' - Y_2' L21) L11^-1 */
static void backward (const supernode *n, int nrhs, double *Y, double *E)
{
    static const double one = 1, minus = -1;
    int below = n->rows - n->m;
    double *own = Y + n->first * nrhs;
    for (int i = 0; i < below; i++)
        memcpy (E + (size_t) i * (size_t) nrhs, Y + n->row[n->m + i] * nrhs, (size_t) nrhs * sizeof *E);
    if (below > 0)
        dgemm_ ("N", "N", &nrhs, &n->m, &below, &minus, E, &nrhs, n->block + n->m, &n->rows, &one, own,
                &nrhs);
    dtrsm_ ("R", "L", "N", "N", &nrhs, &n->m, &one, n->block, &n->rows, own, &nrhs);
}

/* Allocates Y and E and solves forward, Y = L^-1 P b. */
static pg_status go_forward (const cholmod_factor *L, supernodal_solver *s, size_t nrhs, const double *b,
                             int all)
{
    pg_status status = PG_OK;
    PG_TRY (prepare (L, s));
    PG_GROW (s->Y, s->room_Y, L->n * nrhs);
    PG_GROW (s->E, s->room_E, L->maxesize * nrhs);
    permute (L, s, nrhs, b, all);
    for (size_t k = 0; k < L->nsuper; k++) {
        supernode n = take (L, k);
        if (s->reached[k]) forward (&n, (int) nrhs, s->Y, s->E);
    }
done:
    return status;
}

pg_status supernodal_solve_few (const cholmod_factor *L, supernodal_solver *s, size_t nrhs, const double *b,
                                double *x)
{
    pg_status status = PG_OK;
    PG_TRY (go_forward (L, s, nrhs, b, 1));
    for (size_t k = L->nsuper; k-- > 0;) {
        supernode n = take (L, k);
        backward (&n, (int) nrhs, s->Y, s->E);
    }
    for (size_t i = 0; i < L->n; i++) {
        const double *from = s->Y + (size_t) s->place[i] * nrhs;
        for (size_t j = 0; j < nrhs; j++) x[j * L->n + i] = from[j];
    }
done:
    return status;
}

/* Supernodes that follow one another make one interval. */
pg_status supernodal_half_few (const cholmod_factor *L, supernodal_solver *s, size_t nrhs, const double *b,
                               double *const *y, size_t *count, const size_t **first)
{
    pg_status status = PG_OK;
    size_t n = 0;
    PG_TRY (go_forward (L, s, nrhs, b, 0));
    for (size_t k = 0; k < L->nsuper; k++) {
        supernode node = take (L, k);
        size_t from = (size_t) node.first, end = from + (size_t) node.m;
        if (!s->reached[k]) continue;
        s->half_flops += (double) nrhs * node.m * (2.0 * node.rows - node.m);
        for (size_t j = 0; j < nrhs; j++)
            for (size_t i = from; i < end; i++) y[j][i] = s->Y[i * nrhs + j];
        PG_GROW (s->interval, s->room_interval, n + 2);
        if (n && s->interval[n - 1] == from) s->interval[n - 1] = end;
        else s->interval[n] = from, s->interval[n + 1] = end, n += 2;
    }
    *count = n / 2, *first = s->interval;
done:
    return status;
}
