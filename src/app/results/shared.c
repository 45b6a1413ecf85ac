/* SPDX-License-Identifier: GPL-3.0-or-later
 * Results of a run that ranks share (perigal/ranks.h). Rows of history.csv are sums over the ranks, each of
 * which gives the contribution of its own points; rows of events.csv are collected on rank 0 and sorted as
 * one process would write them; fields are written in parts (fields.c). Rank 0 writes into the result folder,
 * the others into ranks/RANK below it, where each keeps the files from which it can continue. */
#include "results_private.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Writes the folder in which a rank keeps its tables and checkpoint. */
void pg_result_rank_folder (char *out, size_t size, const char *folder)
{
    if (pg_rank () == 0) snprintf (out, size, "%s", folder);
    else snprintf (out, size, "%s/ranks/%d", folder, pg_rank ());
}

/* ---- rows ---------------------------------------------------------------------------------------------- */
/* Returns a value that is equal on all ranks on rank 0, else 0, so that it counts once in sums over ranks. */
double pg_result_once (double value) { return pg_ranks_now () && pg_rank () ? 0 : value; }

/* ---- events -------------------------------------------------------------------------------------------- */
typedef struct { pg_broken broken; int64_t point, node; } event;

/* Compares two events for qsort, in the order in which one process would write them: by time, round, bond
 * set, its own point, its other point. */
static int earlier (const void *a, const void *b)
{
    const event *x = a, *y = b;
    if (x->broken.time != y->broken.time) return x->broken.time < y->broken.time ? -1 : 1;
    if (x->broken.round != y->broken.round) return x->broken.round < y->broken.round ? -1 : 1;
    if (x->broken.set != y->broken.set) return x->broken.set < y->broken.set ? -1 : 1;
    if (x->point != y->point) return x->point < y->point ? -1 : 1;
    return (x->node > y->node) - (x->node < y->node);
}

/* Collects the broken bonds of a step from all ranks on rank 0 (*broken: pg_free); on other ranks there are
 * none. */
pg_status pg_result_collect_broken (const pg_result *r, const pg_step *step, size_t *n, pg_broken **broken)
{
    pg_status status = PG_OK;
    const pg_problem *p = r->problem;
    event *mine = NULL;
    void *all = NULL;
    size_t bytes = 0;
    *n = 0, *broken = NULL;
    PG_ALLOC (mine, step->nbroken);
    for (size_t i = 0; i < step->nbroken; i++) {
        const pg_broken *b = &step->broken[i];
        int set;
        size_t point;
        pg_problem_locate (p, b->bond, &set, &point);
        size_t node = (size_t) p->bonds.rows[set].family.node[b->bond - p->bonds.first[set]];
        mine[i].broken = *b;
        mine[i].point = p->bonds.held[set].number[point], mine[i].node = p->cloud.subdomain->number[node];
    }
    PG_TRY (pg_ranks_collect (step->nbroken * sizeof *mine, mine, &bytes, &all));
    *n = bytes / sizeof *mine;
    event *list = all;
    if (*n) pg_sort (list, *n, sizeof *list, earlier);
    PG_ALLOC (*broken, *n);
    for (size_t i = 0; i < *n; i++) (*broken)[i] = list[i].broken;
done:
    pg_free (mine), pg_free (all);
    return status;
}

/* ---- report.json --------------------------------------------------------------------------------------- */
void pg_result_parts_json (pg_json *j, const pg_result *r)
{
    enum { OWNED, GHOSTS, NEIGHBOURS, SENT, PEAK, COUNT };
    static const char *const name[COUNT] = { "owned", "ghosts", "neighbours", "sent", "peak_bytes" };
    const pg_subdomain *s = r->problem->cloud.subdomain;
    size_t size = (size_t) pg_rank_count ();
    double *all = pg_calloc (size * COUNT, sizeof *all), *mine = all + (size_t) pg_rank () * COUNT,
           lost = all == NULL;
    if (pg_ranks_ask (1, &lost) != PG_OK || lost > 0) goto done;
    mine[OWNED] = (double) (s ? s->nowned : r->problem->cloud.n);
    mine[GHOSTS] = s ? (double) (s->n - s->nowned) : 0;
    mine[NEIGHBOURS] = s ? (double) s->halo.n : 0;
    mine[SENT] = s ? (double) s->halo.send_first[s->halo.n] : 0;
    mine[PEAK] = (double) pg_memory_process_peak ();
    if (pg_ranks_ask (size * COUNT, all) != PG_OK) goto done;
    pg_json_open (j, "parts", '[');
    for (size_t rank = 0; rank < size; rank++) {
        pg_json_open (j, NULL, '{');
        for (size_t k = 0; k < COUNT; k++) pg_json_count (j, name[k], (size_t) all[rank * COUNT + k]);
        pg_json_shut (j);
    }
    pg_json_shut (j);
done:
    pg_free (all);
}
