/* SPDX-License-Identifier: GPL-3.0-or-later
 * The fields of a run and their writer, an entry of the catalogue (output.format). Ranks that divide the body
 * write the fields at the points that they own, as parts of the whole; where every rank holds the whole body
 * the first one writes. */
#include "results_private.h"
#include <stdio.h>
#include <string.h>

/* Counts the points of each block on all ranks together; this precedes the opening of files, in which one
 * rank alone may fail. */
static pg_status count_blocks (pg_result *r)
{
    result_fields *f = &r->fields;
    pg_status status = PG_OK;
    const pg_subdomain *s = r->problem->cloud.subdomain;
    const int *block = r->problem->cloud.block;
    double most = 0, *count = NULL;
    for (size_t i = 0; i < s->n; i++) if (s->owned[i] && block[i] > most) most = block[i];
    PG_TRY (pg_ranks_most (1, &most));
    size_t n = f->share.nblock = (size_t) most + 1;
    PG_ALLOC (count, n);
    PG_ALLOC (f->in_block, n);
    f->share.in_block = f->in_block;
    for (size_t i = 0; i < s->n; i++) if (s->owned[i]) count[block[i]]++;
    PG_TRY (pg_ranks_sum (n, count));
    for (size_t k = 0; k < n; k++) f->in_block[k] = (int64_t) count[k];
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
    result_fields *f = &r->fields;
    pg_status status = PG_OK;
    const pg_cloud *cloud = &r->problem->cloud;
    f->writer = pg_writer_find (pg_scene_text (scene, "output.format"));
    snprintf (r->whole, sizeof r->whole, "%s%s", r->folder, pg_rank () ? "/../.." : "");
    f->request = (pg_field_request) { .folder = r->whole,
                                      .title = r->problem->title,
                                      .cloud = cloud,
        .nfield = f->nfield,
        .field = f->field };
    if (!cloud->subdomain) return PG_OK;
    f->share = (pg_field_share) { .part = pg_rank (),
                                  .size = pg_rank_count (),
                                  .joined = pg_result_joins (scene, (double) cloud->subdomain->total),
                                  .total = cloud->subdomain->total };
    f->request.cloud = &f->own, f->request.share = &f->share;
    PG_TRY (count_blocks (r));
done:
    return status;
}

/* Copies the points that this process owns, with their numbers in the whole body. */
static pg_status copy_own (pg_result *r, int64_t **number)
{
    pg_status status = PG_OK;
    const pg_cloud *all = &r->problem->cloud;
    const pg_subdomain *s = all->subdomain;
    size_t dim = (size_t) all->dim, n = 0;
    pg_cloud *own = &r->fields.own;
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
    result_fields *f = &r->fields;
    pg_status status = PG_OK;
    int64_t *number = NULL;
    const pg_field_marks at = from ? (pg_field_marks) { from->moments, from->keep } : (pg_field_marks) { 0 };
    if (pg_rank () && !f->request.share) return PG_OK;
    if (f->request.share) PG_TRY (copy_own (r, &number));
    f->share.number = number;
    PG_TRY (f->writer->open (&f->output, &f->request, from ? &at : NULL));
done:
    f->share.number = NULL;
    pg_free (number);
    return status;
}

/* Keeps of an array with values of all points only those of owned points, one after the other. */
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

/* Writes a moment; if one rank fails all ranks fail, and the moment does not count. */
pg_status pg_result_fields_write (pg_result *r, double time)
{
    result_fields *f = &r->fields;
    pg_status status = f->output ? f->writer->step (f->output, f->moments, time, f->field) : PG_OK;
    PG_TRY (pg_ranks_agree (status));
    f->moments++;
    f->time = time;
done:
    return status;
}

pg_status pg_result_fields_sync (const pg_result *r)
{
    const result_fields *f = &r->fields;
    char path[4096];
    if (!f->output) return PG_OK;
    return f->writer->sync ? f->writer->sync (f->output)
                           : pg_file_sync (pg_result_path (r, f->writer->file, path, sizeof path));
}

/* Lets the writer prepare what a finished result has in addition, such as crack faces; all ranks have written
 * their last moment. */
pg_status pg_result_fields_complete (pg_result *r, const pg_state *state)
{
    result_fields *f = &r->fields;
    pg_status status = PG_OK;
    pg_crack_face *face = NULL;
    size_t n = 0;
    int more = f->output && f->writer->prepare;
    PG_TRY (pg_ranks_agree (more ? pg_result_paths_faces (r, state, &n, &face) : PG_OK));
    PG_TRY (pg_ranks_agree (more ? f->writer->prepare (f->output, n, face) : PG_OK));
done:
    pg_free (face);
    return status;
}

pg_status pg_result_fields_finish (const pg_result *r, int done)
{
    const result_fields *f = &r->fields;
    if (!f->output || !f->writer->finish) return PG_OK;
    return f->writer->finish (f->request.folder, f->request.share, done);
}
