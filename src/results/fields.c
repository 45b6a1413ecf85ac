/* SPDX-License-Identifier: GPL-3.0-or-later
 * The fields of a run and their writer, an entry of the catalogue (output.format). Ranks that divide the body
 * write those of the points that they own, as parts of the whole; where every rank holds the whole body the
 * first one writes. */
#include "results_private.h"
#include <stdio.h>
#include <string.h>

/* How many points each block has on all ranks together; before files are opened, where one rank alone may
 * fail. */
static pg_status count_blocks (pg_result *r)
{
    pg_status status = PG_OK;
    const pg_subdomain *s = r->problem->cloud.subdomain;
    const int *block = r->problem->cloud.block;
    double most = 0, *count = NULL;
    for (size_t i = 0; i < s->n; i++) if (s->owned[i] && block[i] > most) most = block[i];
    PG_TRY (pg_ranks_most (1, &most));
    size_t n = r->share.nblock = (size_t) most + 1;
    PG_ALLOC (count, n);
    PG_ALLOC (r->in_block, n);
    r->share.in_block = r->in_block;
    for (size_t i = 0; i < s->n; i++) if (s->owned[i]) count[block[i]]++;
    PG_TRY (pg_ranks_sum (n, count));
    for (size_t k = 0; k < n; k++) r->in_block[k] = (int64_t) count[k];
done:
    pg_free (count);
    return status;
}

/* Points of the body above which one rank should not hold the values of all. */
static const double most_joined = 2e7;

int pg_result_joins (const pg_scene *scene, double points)
{
    const pg_writer *writer = pg_writer_find (pg_scene_text (scene, "output.format"));
    const char *join = pg_scene_text (scene, "output.join");
    return writer->parts == PG_PARTS_JOIN
        && (strcmp (join, "yes") == 0 || (strcmp (join, "no") != 0 && points <= most_joined));
}

void pg_result_fields_check (const pg_scene *scene)
{
    static const char *const key = "output.format";
    const pg_writer *writer = pg_writer_find (pg_scene_text (scene, key));
    if (pg_ranks_now () && writer && writer->parts == PG_PARTS_NONE)
        pg_scene_fault (scene, key, "ranks that divide the body cannot write it: use another format, or one "
                                    "process");
}

pg_status pg_result_fields_prepare (pg_result *r, const pg_scene *scene)
{
    pg_status status = PG_OK;
    const pg_cloud *cloud = &r->problem->cloud;
    r->writer = pg_writer_find (pg_scene_text (scene, "output.format"));
    snprintf (r->whole, sizeof r->whole, "%s%s", r->folder, pg_rank () ? "/../.." : "");
    r->request = (pg_field_request) { .folder = r->whole,
                                      .title = r->problem->title,
                                      .cloud = cloud,
                                      .nfield = r->nfield,
                                      .field = r->field };
    if (!cloud->subdomain) return PG_OK;
    r->share = (pg_field_share) { .part = pg_rank (),
                                  .size = pg_rank_count (),
                                  .joined = pg_result_joins (scene, (double) cloud->subdomain->total),
                                  .total = cloud->subdomain->total };
    r->request.cloud = &r->own, r->request.share = &r->share;
    PG_TRY (count_blocks (r));
done:
    return status;
}

/* The points that this process owns, and their numbers in the whole. */
static pg_status copy_own (pg_result *r, int64_t **number)
{
    pg_status status = PG_OK;
    const pg_cloud *all = &r->problem->cloud;
    const pg_subdomain *s = all->subdomain;
    size_t dim = (size_t) all->dim, n = 0;
    pg_cloud *own = &r->own;
    *own = *all;
    own->x = own->volume = own->size = own->metric = NULL, own->block = NULL, own->subdomain = NULL;
    own->n = s->nowned;
    PG_ALLOC (own->x, own->n * dim);
    PG_ALLOC (own->volume, own->n);
    PG_ALLOC (own->block, own->n);
    PG_ALLOC (*number, own->n);
    for (size_t i = 0; i < all->n; i++) {
        if (!s->owned[i]) continue;
        memcpy (own->x + n * dim, all->x + i * dim, dim * sizeof *own->x);
        (*number)[n] = s->number[i];
        own->volume[n] = all->volume[i], own->block[n++] = all->block[i];
    }
done:
    return status;
}

pg_status pg_result_fields_open (pg_result *r, const result_marks *from)
{
    pg_status status = PG_OK;
    int64_t *number = NULL;
    const pg_field_marks at = from ? (pg_field_marks) { from->moments, from->keep } : (pg_field_marks) { 0 };
    if (pg_rank () && !r->request.share) return PG_OK;
    if (r->request.share) PG_TRY (copy_own (r, &number));
    r->share.number = number;
    PG_TRY (r->writer->open (&r->output, &r->request, from ? &at : NULL));
done:
    r->share.number = NULL;
    pg_free (number);
    return status;
}

/* Values of all points become those of the points that are owned, one after the other. */
void pg_result_keep_own (const pg_result *r, size_t components, double *value)
{
    const pg_subdomain *s = r->problem->cloud.subdomain;
    size_t n = 0;
    for (size_t i = 0; s && i < s->n; i++) {
        if (!s->owned[i]) continue;
        memmove (value + n * components, value + i * components, components * sizeof *value);
        n++;
    }
}

/* What one rank cannot write no rank has written. */
pg_status pg_result_fields_write (pg_result *r, double time)
{
    pg_status status = r->output ? r->writer->step (r->output, r->moments, time, r->field) : PG_OK;
    PG_TRY (pg_ranks_agree (status));
    r->moments++;
    r->time = time;
done:
    return status;
}

pg_status pg_result_fields_sync (const pg_result *r)
{
    char path[4096];
    if (!r->output) return PG_OK;
    return r->writer->sync ? r->writer->sync (r->output)
                           : pg_file_sync (pg_result_path (r, r->writer->file, path, sizeof path));
}

/* All have written their last moment. */
pg_status pg_result_fields_complete (pg_result *r, const pg_state *state)
{
    pg_status status = PG_OK;
    pg_crack_face *face = NULL;
    size_t n = 0;
    int more = r->output && r->writer->prepare;
    PG_TRY (pg_ranks_agree (more ? pg_result_paths_faces (r, state, &n, &face) : PG_OK));
    PG_TRY (pg_ranks_agree (more ? r->writer->prepare (r->output, n, face) : PG_OK));
done:
    pg_free (face);
    return status;
}

pg_status pg_result_fields_finish (const pg_result *r, int done)
{
    if (!r->output || !r->writer->finish) return PG_OK;
    return r->writer->finish (r->request.folder, r->request.share, done);
}
