/* SPDX-License-Identifier: GPL-3.0-or-later
 * Level 1 where ranks share the finest level (multilevel_ranks.c), in full on each of them: every rank gets
 * all functions and the contributions of all ranks to their rows, and sums these in the order of the ranks.
 * Functions are numbered by their vertices, as in one process, whatever the division. Coarser levels are the
 * work of one process, done by all ranks at once: no messages but one sum of the right-hand side. */
#include "multilevel.h"
#include <stdlib.h>
#include <string.h>

/* What is sent of a function: number, vertex (NAME numbers), position; of a row: function, number of
 * couplings (HEAD numbers), and of each coupling function and block. */
enum { NAME = 2, HEAD = 2 };

static int by_vertex (const void *a, const void *b)
{
    const function_of_all *x = a, *y = b;
    if (x->vertex != y->vertex) return x->vertex < y->vertex ? -1 : 1;
    return (x->key > y->key) - (x->key < y->key);
}

/* Lists the functions of all ranks, ascending by vertex and number. */
static pg_status list_functions (const function_of_all *held, size_t n, int dim, function_of_all **out,
                                 size_t *count)
{
    pg_status status = PG_OK;
    size_t wide = NAME + (size_t) dim, own = 0, total = 0;
    double *mine = NULL, *all = NULL;
    PG_ALLOC (mine, n * wide);
    for (size_t p = 0; p < n; p++) {
        if (held[p].owner != pg_rank ()) continue;
        double *to = mine + own++ * wide;
        to[0] = (double) held[p].key, to[1] = (double) held[p].vertex;
        memcpy (to + NAME, held[p].place, (size_t) dim * sizeof *to);
    }
    PG_TRY (pg_ranks_share (own * wide, mine, &total, &all));
    *count = total / wide;
    PG_ALLOC (*out, *count);
    for (size_t q = 0; q < *count; q++) {
        const double *from = all + q * wide;
        (*out)[q] = (function_of_all) { .key = (int64_t) from[0], .vertex = (int64_t) from[1] };
        memcpy ((*out)[q].place, from + NAME, (size_t) dim * sizeof *from);
    }
    if (*count) pg_sort (*out, *count, sizeof **out, by_vertex);
done:
    pg_free (mine), pg_free (all);
    return status;
}

/* Sets m->whole: index of each function held here in the list of all functions. */
static pg_status find_held (pg_multilevel *m, const function_of_all *held, const function_of_all *all,
                            size_t count)
{
    pg_status status = PG_OK;
    double lost = 0;
    PG_ALLOC (m->whole, m->meet.n);
    for (size_t p = 0; p < m->meet.n; p++) {
        const function_of_all *a = pg_search (&held[p], all, count, sizeof *all, by_vertex);
        if (a) m->whole[p] = (int) (a - all);
        else lost = 1;
    }
    PG_TRY (pg_ranks_most (1, &lost));
    if (lost > 0) PG_FAIL (PG_E_FILE, "ranks disagree about their coarse functions");
done:
    return status;
}

/* ---- rows ---------------------------------------------------------------------------------------------- */
/* Shares the rows to which owned nodes contribute: those of all ranks, one rank after the other. */
static pg_status share_rows (const pg_multilevel *m, const function_of_all *held, size_t *n, double **all)
{
    pg_status status = PG_OK;
    const level *c = &m->meet;
    size_t bb = (size_t) (c->block * c->block), at = 0, most = 0;
    double *mine = NULL, *value = NULL;
    int *node = NULL;
    PG_ALLOC (node, c->rows.widest);
    PG_ALLOC (value, c->rows.widest * bb);
    for (size_t p = 0; p < c->n; p++)
        most += held[p].touched ? HEAD + level_row (c, p, 0, node, NULL) * (1 + bb) : 0;
    PG_ALLOC (mine, most);
    for (size_t p = 0; p < c->n; p++) {
        if (!held[p].touched) continue;
        size_t count = level_row (c, p, 0, node, value);
        mine[at++] = m->whole[p], mine[at++] = (double) count;
        for (size_t e = 0; e < count; e++) {
            mine[at++] = m->whole[node[e]];
            memcpy (mine + at, value + e * bb, bb * sizeof *mine);
            at += bb;
        }
    }
    PG_TRY (pg_ranks_share (at, mine, n, all));
done:
    pg_free (mine), pg_free (value), pg_free (node);
    return status;
}

/* Sorts the rows of the list `all` by functions: those of function p begin at at[first[p]] ..
 * at[first[p + 1] - 1] in it, in the order of the ranks. */
static pg_status sort_rows (const level *l, size_t n, const double *all, size_t **first, size_t **at)
{
    pg_status status = PG_OK;
    size_t wide = 1 + (size_t) (l->block * l->block), count = 0;
    PG_ALLOC (*first, l->n + 2);
    for (size_t k = 0; k < n; k += HEAD + (size_t) all[k + 1] * wide, count++)
        (*first)[(size_t) all[k] + 2]++;
    for (size_t p = 0; p < l->n; p++) (*first)[p + 2] += (*first)[p + 1];
    PG_ALLOC (*at, count);
    for (size_t k = 0; k < n; k += HEAD + (size_t) all[k + 1] * wide)
        (*at)[(*first)[(size_t) all[k] + 1]++] = k;
done:
    return status;
}

/* Counts the different functions that a coarse function is coupled with, by its rows in the list `all`, at
 * *begin .. end[-1]; node: lists them (NULL: no). where[q] > mark: function q is counted already. */
static size_t couplings_of (const double *all, const size_t *begin, const size_t *end, size_t wide,
                            size_t mark, size_t *where, int *node)
{
    size_t m = 0;
    for (const size_t *k = begin; k < end; k++)
        for (size_t e = 0; e < (size_t) all[*k + 1]; e++) {
            int q = (int) all[*k + HEAD + e * wide];
            if (where[q] > mark) continue;
            where[q] = mark + 1;
            if (node) node[m] = q;
            m++;
        }
    return m;
}

/* Adds the rows of function p in the list into one row of the level, couplings ascending. */
static void add_row (level *l, size_t p, const double *all, const size_t *begin, const size_t *end,
                     size_t *where)
{
    size_t bb = (size_t) (l->block * l->block), wide = 1 + bb, from = l->start[p],
           m = couplings_of (all, begin, end, wide, from, where, l->node + from);
    if (m) pg_sort (l->node + from, m, sizeof *l->node, pg_ascending_ints);
    for (size_t e = from; e < from + m; e++) where[l->node[e]] = e + 1;
    for (const size_t *k = begin; k < end; k++)
        for (size_t e = 0; e < (size_t) all[*k + 1]; e++) {
            const double *add = all + *k + HEAD + e * wide;
            double *to = l->value + (where[(int) add[0]] - 1) * bb;
            for (size_t a = 0; a < bb; a++) to[a] += add[1 + a];
        }
}

static pg_status add_rows (level *l, size_t n, const double *all)
{
    pg_status status = PG_OK;
    size_t *first = NULL, *at = NULL, *where = NULL, bb = (size_t) (l->block * l->block);
    PG_TRY (sort_rows (l, n, all, &first, &at));
    PG_ALLOC (where, l->n);
    PG_ALLOC (l->start, l->n + 1);
    for (size_t p = 0; p < l->n; p++) {
        size_t m = couplings_of (all, at + first[p], at + first[p + 1], 1 + bb, p, where, NULL);
        l->start[p + 1] = l->start[p] + m;
        if (m > l->rows.widest) l->rows.widest = m;
    }
    memset (where, 0, l->n * sizeof *where);
    PG_ALLOC (l->node, l->start[l->n]);
    PG_ALLOC (l->value, l->start[l->n] * bb);
    for (size_t p = 0; p < l->n; p++) add_row (l, p, all, at + first[p], at + first[p + 1], where);
done:
    pg_free (first), pg_free (at), pg_free (where);
    return status;
}

pg_status multilevel_gather (pg_multilevel *m, const function_of_all *held)
{
    pg_status status = PG_OK;
    const level *c = &m->meet;
    level *l = &m->at[1];
    function_of_all *all = NULL;
    double *row = NULL;
    size_t count = 0, n = 0, dim = (size_t) c->dim;
    PG_TRY (list_functions (held, c->n, c->dim, &all, &count));
    PG_TRY (find_held (m, held, all, count));
    l->dim = c->dim, l->block = c->block, l->threads = c->threads, l->grid.aligned = c->grid.aligned,
    l->n = count;
    l->ndof = count * (size_t) c->block;
    memcpy (l->reach, c->reach, sizeof l->reach);
    memcpy (l->rows.lattice, c->rows.lattice, sizeof l->rows.lattice);
    PG_ALLOC (l->places, count * dim);
    for (size_t q = 0; q < count; q++) memcpy (l->places + q * dim, all[q].place, dim * sizeof *l->places);
    l->x = l->places;
    PG_TRY (share_rows (m, held, &n, &row));
    PG_TRY (add_rows (l, n, row));
    PG_TRY (level_diagonal (l, NULL));
done:
    pg_free (all), pg_free (row);
    return status;
}
