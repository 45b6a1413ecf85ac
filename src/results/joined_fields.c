/* SPDX-License-Identifier: GPL-3.0-or-later
 * The fields of a run that ranks shared. Each writes those of the points that it owns, as a part of the whole
 * (result.e.SIZE.RANK, which other programs can show as one); when the run has ended rank 0 puts the parts
 * together (output/exodus_join.c), so that result.e is the file that one process would have written. While
 * the run goes on, and after one that was interrupted, the parts are what there is. */
#include "results_private.h"
#include <stdio.h>
#include <string.h>

/* How many points each block has on all ranks together; before files are opened, where one rank alone may
 * fail. */
pg_status pg_result_count_blocks (pg_result *r)
{
    pg_status status = PG_OK;
    const pg_subdomain *s = r->problem->cloud.subdomain;
    const int *block = r->problem->cloud.block;
    double most = 0, *count = NULL;
    if (!s) return PG_OK;
    for (size_t i = 0; i < s->n; i++) if (s->owned[i] && block[i] > most) most = block[i];
    PG_TRY (pg_ranks_most (1, &most));
    r->nblock = (size_t) most + 1;
    PG_ALLOC (count, r->nblock);
    PG_ALLOC (r->in_block, r->nblock);
    for (size_t i = 0; i < s->n; i++) if (s->owned[i]) count[block[i]]++;
    PG_TRY (pg_ranks_sum (r->nblock, count));
    for (size_t k = 0; k < r->nblock; k++) r->in_block[k] = (int64_t) count[k];
done:
    pg_free (count);
    return status;
}

/* The file of the fields of this process, new. */
pg_status pg_result_create_fields (pg_result *r)
{
    pg_status status = PG_OK;
    const pg_cloud *own;
    const pg_subdomain *s = r->problem->cloud.subdomain;
    int64_t *number = NULL;
    size_t n = 0;
    char path[4096];
    PG_TRY (pg_result_own_cloud (r, &own));
    pg_result_fields_path (r, path, sizeof path);
    if (!s) return pg_exodus_create (&r->file, path, own, r->problem->title, r->nfield, r->field);
    PG_ALLOC (number, own->n);
    for (size_t i = 0; i < s->n; i++) if (s->owned[i]) number[n++] = s->number[i];
    pg_exodus_share share = { pg_rank (), pg_rank_count (), number, s->total, r->nblock, r->in_block };
    PG_TRY (pg_exodus_create_part (&r->file, path, own, r->problem->title, r->nfield, r->field, &share));
done:
    pg_free (number);
    return status;
}

/* Points of the body above which one rank should not hold the values of all. */
static const double most_joined = 2e7;

int pg_result_joins (const char *join, double points)
{
    return strcmp (join, "yes") == 0 || (strcmp (join, "no") != 0 && points <= most_joined);
}

int pg_result_in_parts (const pg_result *r, const char *join)
{
    const pg_subdomain *s = r->problem->cloud.subdomain;
    return s && !pg_result_joins (join, (double) s->total);
}

/* All ranks call. The parts stay until the run is finished. */
pg_status pg_result_join_fields (pg_result *r)
{
    pg_status status = PG_OK;
    if (!r->problem->cloud.subdomain || r->in_parts) return PG_OK;
    PG_TRY (pg_ranks_agree (PG_OK));                   /* all have written their last step */
    if (pg_rank () == 0) status = pg_exodus_join (r->folder, 1);
    PG_TRY (pg_ranks_agree (status));
done:
    return status;
}
