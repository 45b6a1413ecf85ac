/* SPDX-License-Identifier: GPL-3.0-or-later
 * Slots of a list of bonds: how many each slice needs, their ends, coefficients and limits. */
#include "list.h"
#include <math.h>
#include <string.h>

typedef struct {
    bond_list *list;
    const pg_bond_loop_setting *setting;
    size_t  most;                                      /* bonds of the largest family */
    double *xi, *weight;  /* of one family, for each thread (threads x most x dim, x most) */
} filler;

/* Sort of the bond from point i to point j: 0 shared and kept by i, 1 between chunks, -1: kept by j. */
static int sort_of (const bond_list *list, size_t i, size_t j)
{
    if ((size_t) list->rank[i] / list->chunk != (size_t) list->rank[j] / list->chunk) return 1;
    return list->before[i] < list->before[j] ? 0 : -1;
}

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

static double pair_modulus (const double *c, size_t i, size_t j)
{
    if (c[i] == c[j]) return c[i];
    return c[i] + c[j] > 0 ? 2 * (c[i] * c[j]) / (c[i] + c[j]) : 0;
}

/* Bonds of point p of the new order, into its lane. */
static void fill_lane (const filler *g, size_t p, double *xi, double *weight)
{
    bond_list *list = g->list;
    const pg_family *family = list->family;
    const double *V = list->sums->cloud->volume;
    size_t i = (size_t) list->point[p], dim = (size_t) list->dim, slice = p / LIST_LANES,
           lane = p % LIST_LANES, used[2] = { 0, 0 };
    pg_sums_bonds (list->sums, family, i, xi, weight, NULL);
    for (size_t b = 0; b < family->start[i + 1] - family->start[i]; b++) {
        size_t j = (size_t) family->node[family->start[i] + b];
        int sort = sort_of (list, i, j);
        if (sort < 0) continue;
        bond_slots *slots = &list->slots[sort];
        size_t slot = slots->start[slice] + used[sort]++, at = LIST_LANES * slot + lane;
        size_t to = (size_t) list->rank[j] * (size_t) list->pitch;
        if (sort == 0)
            slots->near[at] = (uint16_t) (to - p / list->chunk * list->chunk * (size_t) list->pitch);
        else           slots->far[at] = (uint32_t) to;
        double rr = 0;
        for (size_t c = 0; c < dim; c++) rr += xi[b*dim + c] * xi[b*dim + c];
        double pull = pair_modulus (g->setting->modulus, i, j) * weight[b] * (V[i] * V[j]) / sqrt (rr);
        slots->a[at] = list->finite ? pull * list->unit : pull / rr * (list->unit * list->unit);
        slots->alive[slot] |= (unsigned char) (1u << lane);
    }
}

static void fill_slices (void *context, size_t first, size_t last, int thread)
{
    const filler *g = context;
    bond_list *list = g->list;
    for (size_t slice = first; slice < last; slice++) {
        for (int sort = 0; sort < 2; sort++) {         /* lanes without a bond: the point itself, dead */
            bond_slots *slots = &list->slots[sort];
            for (size_t at = LIST_LANES * slots->start[slice]; at < LIST_LANES * slots->start[slice + 1];
                 at++) {
                size_t own = (slice * LIST_LANES + at % LIST_LANES) * (size_t) list->pitch;
                if (sort == 0)
                    slots->near[at] = (uint16_t) (own
                                                  - slice * LIST_LANES / list->chunk * list->chunk
                                                        * (size_t) list->pitch);
                else           slots->far[at] = (uint32_t) own;
            }
        }
        for (size_t p = slice * LIST_LANES; p < (slice + 1) * LIST_LANES && p < list->n; p++)
            fill_lane (g, p, g->xi + (size_t) thread * g->most * (size_t) list->dim,
                       g->weight + (size_t) thread * g->most);
    }
}

static double pair_limit (const bond_list *list, const pg_bond_loop_setting *setting, size_t p, size_t q)
{
    size_t i = (size_t) list->point[p], j = (size_t) list->point[q];
    if (setting->exempt && (setting->exempt[i] || setting->exempt[j])) return INFINITY;
    double s0 = fmin (setting->limit[i], setting->limit[j]);
    return list->finite ? s0 * (2 + s0) : s0 * list->unit;
}

/* Are the first eight limits all this one? */
static int first_eight (const bond_list *list, double limit)
{
    int same = list->limits > 0;
    for (int k = 0; same && k < LIST_LANES; k++) same = list->limit[k] == limit;
    return same;
}

/* Limits of one slice: where all are the same, eight of them; most slices share those of the first one. */
static pg_status fill_limits (bond_list *list, bond_slots *slots, const pg_bond_loop_setting *setting,
                              size_t slice)
{
    pg_status status = PG_OK;
    size_t first = slots->start[slice], n = slots->start[slice + 1] - first, end = list->limits;
    PG_GROW (list->limit, list->limit_cap, (end + n + 1) * LIST_LANES);
    double *limit = list->limit + end * LIST_LANES, low = INFINITY, high = -INFINITY;
    for (size_t k = 0; k < n * LIST_LANES; k++) {
        if (!(slots->alive[first + k / LIST_LANES] >> k % LIST_LANES & 1)) { limit[k] = INFINITY; continue; }
        limit[k] = pair_limit (list, setting, slice * LIST_LANES + k % LIST_LANES,
                               bond_list_end (list, slots, slice, first * LIST_LANES + k));
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

static pg_status alloc_slots (bond_slots *slots, size_t slices)
{
    pg_status status = PG_OK;
    size_t n = slots->start[slices];
    if (slots->shared) PG_ALLOC (slots->near, n * LIST_LANES);
    else               PG_ALLOC (slots->far, n * LIST_LANES);
    PG_ALLOC (slots->a, n * LIST_LANES);
    PG_ALLOC (slots->alive, n);
    PG_ALLOC (slots->lost, n);
    PG_ALLOC (slots->limit_at, slices);
    PG_ALLOC (slots->limit_step, slices);
done:
    return status;
}

pg_status bond_list_fill (bond_list *list, const pg_bond_loop_setting *setting)
{
    pg_status status = PG_OK;
    filler g = { .list = list, .setting = setting };
    const size_t *start = list->family->start;
    for (size_t i = 0; i < list->n; i++)
        if (start[i + 1] - start[i] > g.most) g.most = start[i + 1] - start[i];
    PG_ALLOC (g.xi, (size_t) list->threads * g.most * (size_t) list->dim);
    PG_ALLOC (g.weight, (size_t) list->threads * g.most);
    for (int k = 0; k < 2; k++) PG_ALLOC (list->slots[k].start, list->slices + 1);
    count_slots (list);
    for (int k = 0; k < 2; k++) PG_TRY (alloc_slots (&list->slots[k], list->slices));
    pg_parallel (list->threads, list->slices, fill_slices, &g);
    for (int k = 0; setting->limit && k < 2; k++)
        for (size_t s = 0; s < list->slices; s++) PG_TRY (fill_limits (list, &list->slots[k], setting, s));
done:
    pg_free (g.xi);
    pg_free (g.weight);
    return status;
}
