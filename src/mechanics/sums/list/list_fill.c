/* SPDX-License-Identifier: GPL-3.0-or-later
 * Fills the slots of a list of bonds: how many each slice needs, ends, numbers and limits of bonds. */
#include "list.h"
#include <math.h>
#include <string.h>

typedef struct {
    bond_list *list;
    size_t  most;                                      /* bonds of the largest family */
    double *xi, *weight;  /* bonds of one family, for each thread (threads x most x dim; threads x most) */
} filler;

/* Returns how the bond from point i to point j is stored: 0 shared, at i; 1 at both; -1 shared, at j. Bonds
 * within a chunk can be shared, as one thread sums both ends; they are stored at the end of lower `before`.
 * */
static int sort_of (const bond_list *list, size_t i, size_t j)
{
    size_t p = (size_t) list->rank[i], q = (size_t) list->rank[j];
    if (!list->law.shared || p / list->chunk != q / list->chunk) return 1;
    return list->before[i] < list->before[j] ? 0 : -1;
}

/* Counts slots: a slice of eight points has as many slots of a sort as its point with most bonds of that sort
 * has bonds. start: number of slots before each slice. */
static void count_slots (bond_list *list)
{
    const pg_family *family = list->family;
    for (size_t p = 0; p < list->n; p++) {
        size_t i = (size_t) list->point[p], count[2] = { 0, 0 };
        for (size_t e = family->start[i]; e < family->start[i + 1]; e++) {
            int sort = sort_of (list, i, (size_t) family->node[e]);
            if (sort >= 0) count[sort]++;
        }
        for (int k = 0; k < 2; k++) {
            size_t *need = &list->slots[k].start[p / LIST_LANES + 1];
            if (count[k] > *need) *need = count[k];
        }
    }
    for (int k = 0; k < 2; k++)
        for (size_t s = 0; s < list->slices; s++) list->slots[k].start[s + 1] += list->slots[k].start[s];
}

/* Writes the offset of the record of point q into slots of point p (new numbers): 16 bits from the start of
 * the chunk for shared bonds, 32 bits from the first record for the others. */
static void set_end (const bond_list *list, bond_slots *slots, size_t at, size_t p, size_t q)
{
    size_t pitch = (size_t) list->pitch;
    if (slots->shared) slots->near[at] = (uint16_t) ((q - p / list->chunk * list->chunk) * pitch);
    else slots->far[at] = (uint32_t) (q * pitch);
}

/* Writes the bonds of point p (new number) to its lane: ends, numbers of the law, alive bits. xi (m), weight:
 * workspaces for the largest family. */
static void fill_lane (const filler *g, size_t p, double *xi, double *weight)
{
    bond_list *list = g->list;
    const pg_family *family = list->family;
    size_t i = (size_t) list->point[p], dim = (size_t) list->dim, used[2] = { 0, 0 };
    double term[LIST_TERMS];
    pg_sums_bonds (list->sums, family, i, xi, weight, NULL);
    for (size_t b = 0; b < family->start[i + 1] - family->start[i]; b++) {
        size_t j = (size_t) family->node[family->start[i] + b];
        int sort = sort_of (list, i, j);
        if (sort < 0) continue;
        bond_slots *slots = &list->slots[sort];
        size_t slot = slots->start[p / LIST_LANES] + used[sort]++, at = LIST_LANES * slot + p % LIST_LANES;
        set_end (list, slots, at, p, (size_t) list->rank[j]);
        list->law.term (list, i, j, xi + b * dim, weight[b], term);
        for (int t = 0; t < list->law.terms; t++) slots->term[t][at] = term[t];
        slots->alive[slot] |= (unsigned char) (1u << p % LIST_LANES);
    }
}

/* Fills the slices first .. last - 1. All lanes have their own point as other end at first, so that lanes
 * without a bond read valid memory. */
static void fill_slices (void *context, size_t first, size_t last, int thread)
{
    const filler *g = context;
    bond_list *list = g->list;
    double *xi = g->xi + (size_t) thread * g->most * (size_t) list->dim;
    double *weight = g->weight + (size_t) thread * g->most;
    for (size_t slice = first; slice < last; slice++) {
        for (int sort = 0; sort < 2; sort++) {         /* all lanes: the point itself, not alive */
            bond_slots *slots = &list->slots[sort];
            size_t end = LIST_LANES * slots->start[slice + 1];
            for (size_t at = LIST_LANES * slots->start[slice]; at < end; at++) {
                size_t own = slice * LIST_LANES + at % LIST_LANES;
                set_end (list, slots, at, own, own);
            }
        }
        for (size_t p = slice * LIST_LANES; p < (slice + 1) * LIST_LANES && p < list->n; p++)
            fill_lane (g, p, xi, weight);
    }
}

/* Returns the limit of the bond of points p and q (new numbers) for the law; INFINITY if either is exempt. */
static double bond_limit (const bond_list *list, size_t p, size_t q)
{
    const unsigned char *exempt = list->setting.exempt;
    size_t i = (size_t) list->point[p], j = (size_t) list->point[q];
    if (exempt && (exempt[i] || exempt[j])) return INFINITY;
    return list->law.limit (list, i, j);
}

/* Are the first eight limits of the list all equal to `limit`, so that a slice can share them? */
static int first_eight (const bond_list *list, double limit)
{
    int same = list->limits > 0;
    for (int k = 0; same && k < LIST_LANES; k++) same = list->limit[k] == limit;
    return same;
}

/* Writes the limits of one slice: eight if all are equal, or none if these are the first eight of the list;
 * else all. */
static pg_status fill_limits (bond_list *list, bond_slots *slots, size_t slice)
{
    pg_status status = PG_OK;
    size_t first = slots->start[slice], n = slots->start[slice + 1] - first, end = list->limits;
    PG_GROW (list->limit, list->limit_cap, (end + n + 1) * LIST_LANES);
    double *limit = list->limit + end * LIST_LANES, low = INFINITY, high = -INFINITY;
    for (size_t k = 0; k < n * LIST_LANES; k++) {
        if (!(slots->alive[first + k / LIST_LANES] >> k % LIST_LANES & 1)) { limit[k] = INFINITY; continue; }
        limit[k] = bond_limit (list, slice * LIST_LANES + k % LIST_LANES,
                               pg_list_end (list, slots, slice, first * LIST_LANES + k));
        low = fmin (low, limit[k]), high = fmax (high, limit[k]);
    }
    slots->limit_at[slice] = 0;
    if (n == 0 && list->limits > 0) return PG_OK;
    if (low < high) {
        slots->limit_at[slice] = end, slots->limit_step[slice] = LIST_LANES, list->limits += n;
    } else if (!first_eight (list, low)) {
        for (int k = 0; k < LIST_LANES; k++) limit[k] = low;
        slots->limit_at[slice] = end, list->limits++;
    }
done:
    return status;
}

/* Allocates the arrays of bonds of one sort, once their slots are counted. */
static pg_status alloc_slots (bond_slots *slots, size_t slices, int terms)
{
    pg_status status = PG_OK;
    size_t n = slots->start[slices];
    if (slots->shared) PG_ALLOC (slots->near, n * LIST_LANES);
    else               PG_ALLOC (slots->far, n * LIST_LANES);
    for (int t = 0; t < terms; t++) PG_ALLOC (slots->term[t], n * LIST_LANES);
    PG_ALLOC (slots->alive, n);
    PG_ALLOC (slots->lost, n);
    PG_ALLOC (slots->limit_at, slices);
    PG_ALLOC (slots->limit_step, slices);
done:
    return status;
}

/* Counts slots, allocates, fills slices by threads (each by one), then writes limits, slice after slice, as
 * where they are stored depends on the former ones. */
pg_status pg_list_fill (bond_list *list)
{
    pg_status status = PG_OK;
    filler g = { .list = list };
    const size_t *start = list->family->start;
    for (size_t i = 0; i < list->n; i++)
        if (start[i + 1] - start[i] > g.most) g.most = start[i + 1] - start[i];
    PG_ALLOC (g.xi, (size_t) list->threads * g.most * (size_t) list->dim);
    PG_ALLOC (g.weight, (size_t) list->threads * g.most);
    for (int k = 0; k < 2; k++) PG_ALLOC (list->slots[k].start, list->slices + 1);
    count_slots (list);
    for (int k = 0; k < 2; k++) PG_TRY (alloc_slots (&list->slots[k], list->slices, list->law.terms));
    pg_parallel (list->threads, list->slices, fill_slices, &g);
    for (int k = 0; list->setting.limit && k < 2; k++)
        for (size_t s = 0; s < list->slices; s++) PG_TRY (fill_limits (list, &list->slots[k], s));
done:
    pg_free (g.xi);
    pg_free (g.weight);
    return status;
}
