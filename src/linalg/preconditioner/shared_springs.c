/* SPDX-License-Identifier: GPL-3.0-or-later
 * Stiff springs where ranks share the body: constraints cross the boundaries of subdomains, and W'W, which
 * is solved with twice in each iteration, couples all constraints of a set. As supports are a small part of
 * a body, every rank has all columns of W and the same factor of W'W, and a product W' x is a sum over
 * ranks. */
#include "shared_springs.h"
#include <stdlib.h>
#include <string.h>

/* What is sent of each spring: number of its entries, stiffness (HEAD numbers), then row and value of each.
 * */
enum { HEAD = 2 };

static pg_status gather (const pg_elements *e, const pg_subdomain *part, size_t *n, double **all)
{
    pg_status status = PG_OK;
    const pg_sparse *W = &e->W;
    size_t block = (size_t) e->Q.block, at = 0;
    double *mine = NULL;
    PG_ALLOC (mine, HEAD * W->ncol + 2 * (size_t) (W->ncol ? W->start[W->ncol] : 0));
    for (size_t c = 0; c < W->ncol; c++) {
        if (!part->owned[e->holds[c] / block]) continue;
        mine[at++] = (double) (W->start[c + 1] - W->start[c]), mine[at++] = e->held[c];
        for (long q = W->start[c]; q < W->start[c + 1]; q++) {
            size_t row = (size_t) W->row[q];
            mine[at++] = (double) (part->number[row / block] * (int64_t) block + (int64_t) (row % block));
            mine[at++] = W->value[q];
        }
    }
    PG_TRY (pg_ranks_share (at, mine, n, all));
done:
    pg_free (mine);
    return status;
}

/* Lists the rows that any spring has, ascending, each once. */
static pg_status list_rows (size_t n, const double *all, double **row, size_t *count)
{
    pg_status status = PG_OK;
    size_t m = 0, last = 0;
    PG_ALLOC (*row, n);
    for (size_t at = 0; at < n; at += HEAD + 2 * (size_t) all[at])
        for (size_t k = 0; k < (size_t) all[at]; k++) (*row)[m++] = all[at + HEAD + 2 * k];
    if (m) pg_sort (*row, m, sizeof **row, pg_ascending_numbers);
    for (size_t k = 0; k < m; k++) if (k == 0 || (*row)[k] != (*row)[last - 1]) (*row)[last++] = (*row)[k];
    *count = last;
done:
    return status;
}

static int by_number (const void *a, const void *b)
{
    int64_t x = *(const int64_t *) a, y = *(const int64_t *) b;
    return (x > y) - (x < y);
}

/* Returns the unknown of an owned node on this rank that has this row of the whole body; -1: there is none.
 * */
static long here (const pg_subdomain *part, size_t block, double row)
{
    int64_t number = (int64_t) row / (int64_t) block;
    const int64_t *found = pg_search (&number, part->number, part->n, sizeof number, by_number);
    if (!found || !part->owned[found - part->number]) return -1;
    return (long) (found - part->number) * (long) block + (long) ((int64_t) row % (int64_t) block);
}

static void put (pg_sparse *W, size_t *at, size_t row, double value)
{
    W->row[*at] = (long) row, W->value[(*at)++] = value;
}

pg_status springs_share (pg_elements *e, const pg_subdomain *part, pg_sparse *whole)
{
    pg_status status = PG_OK;
    pg_sparse own = { 0 };
    double *all = NULL, *row = NULL, *held = NULL;
    size_t n = 0, nrow = 0, count = 0, entries = 0, c = 0, i = 0, j = 0, block = (size_t) e->Q.block;
    PG_TRY (gather (e, part, &n, &all));
    for (size_t at = 0; at < n; at += HEAD + 2 * (size_t) all[at]) count++, entries += (size_t) all[at];
    PG_TRY (list_rows (n, all, &row, &nrow));
    PG_TRY (pg_sparse_create (whole, nrow, count, entries, 0));
    PG_TRY (pg_sparse_create (&own, part->n * block, count, entries, 0));
    PG_ALLOC (held, count);
    for (size_t at = 0; at < n; at += HEAD + 2 * (size_t) all[at], c++) {
        held[c] = all[at + 1];
        for (const double *q = all + at + HEAD; q < all + at + HEAD + 2 * (size_t) all[at]; q += 2) {
            const double *found = pg_search (q, row, nrow, sizeof *row, pg_ascending_numbers);
            long mine = here (part, block, q[0]);
            put (whole, &i, (size_t) (found - row), q[1]);
            if (mine >= 0) put (&own, &j, (size_t) mine, q[1]);
        }
        whole->start[c + 1] = (long) i, own.start[c + 1] = (long) j;
    }
    pg_sparse_clear (&e->W);
    e->W = own, memset (&own, 0, sizeof own);
    pg_free (e->held), pg_free (e->holds);
    e->held = held, e->holds = NULL, held = NULL;
done:
    pg_sparse_clear (&own);
    pg_free (all), pg_free (row), pg_free (held);
    return status;
}
