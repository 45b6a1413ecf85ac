/* SPDX-License-Identifier: GPL-3.0-or-later
 * The fields of a run that ranks shared become one file when it has ended: rank 0 puts the parts of all ranks
 * (result.e.SIZE.RANK) together in the order in which one process lists the points, step by step, so that
 * result.e is the file that one process would have written. While the run goes on, and after one that was
 * interrupted, the parts are what there is. */
#include "results_private.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A point of the whole: its number, and which of all points of the parts it is. */
typedef struct { int64_t number; size_t at; } place;
/* The parts: their clouds, one behind the other; order of all points; steps. */
typedef struct { pg_cloud all; place *order; size_t nstep; double *time; } parts;

static int ascending (const void *a, const void *b)
{
    const place *x = a, *y = b;
    return (x->number > y->number) - (x->number < y->number);
}

/* The part of a rank, as pg_result_fields_path names it, seen from rank 0. */
static void part_path (const pg_result *r, int rank, char *out, size_t size)
{
    char digits[16];
    int width = snprintf (digits, sizeof digits, "%d", pg_rank_count ());
    snprintf (out, size, "%s/result.e.%d.%0*d", r->folder, pg_rank_count (), width, rank);
}

/* Points of all parts, in the order of the ranks; times are those of the first. */
static pg_status read_points (parts *p, const pg_result *r, const pg_cloud *own)
{
    pg_status status = PG_OK;
    pg_cloud one = { 0 };
    char path[4096];
    size_t dim = (size_t) own->dim, at = 0, nstep;
    double *x = p->all.x, *volume = p->all.volume;
    int *block = p->all.block;
    for (int k = 0; k < pg_rank_count (); k++) {
        part_path (r, k, path, sizeof path);
        PG_TRY (pg_exodus_points (path, &one, &nstep, k ? NULL : &p->time));
        if (at + one.n > p->all.n || (k && nstep != p->nstep))
            PG_FAIL (PG_E_FILE, "%s does not belong to the other parts", path);
        memcpy (x + at * dim, one.x, one.n * dim * sizeof *x);
        memcpy (volume + at, one.volume, one.n * sizeof *volume);
        memcpy (block + at, one.block, one.n * sizeof *block);
        at += one.n, p->nstep = nstep;
        pg_cloud_clear (&one);
    }
    if (at != p->all.n) PG_FAIL (PG_E_FILE, "%s: %zu points in all parts, not %zu", r->folder, at, p->all.n);
done:
    pg_cloud_clear (&one);
    return status;
}

/* What belongs to the points, `size` bytes each, in the order of the whole. */
static pg_status sort_by_place (const parts *p, size_t size, void **what)
{
    pg_status status = PG_OK;
    char *sorted = NULL, *from = *what;
    sorted = pg_calloc (p->all.n, size);
    if (!sorted) PG_FAIL (PG_E_MEMORY, "no memory for %zu points", p->all.n);
    for (size_t i = 0; i < p->all.n; i++) memcpy (sorted + i * size, from + p->order[i].at * size, size);
    pg_free (from);
    *what = sorted;
done:
    return status;
}

/* The cloud of the whole, from the parts and the numbers of their points. */
static pg_status make_whole (parts *p, const pg_result *r, const pg_cloud *own, const int64_t *number,
                             size_t n)
{
    pg_status status = PG_OK;
    size_t dim = (size_t) own->dim;
    void *x = NULL, *volume = NULL, *block = NULL;
    p->all = *own;
    p->all.x = p->all.volume = p->all.size = p->all.metric = NULL, p->all.block = NULL,
    p->all.subdomain = NULL;
    p->all.n = n;
    PG_ALLOC (p->all.x, n * dim);
    PG_ALLOC (p->all.volume, n);
    PG_ALLOC (p->all.block, n);
    PG_ALLOC (p->order, n);
    for (size_t i = 0; i < n; i++) p->order[i] = (place){ number[i], i };
    qsort (p->order, n, sizeof *p->order, ascending);
    PG_TRY (read_points (p, r, own));
    x = p->all.x, volume = p->all.volume, block = p->all.block;
    PG_TRY (sort_by_place (p, dim * sizeof (double), &x));
    p->all.x = x;
    PG_TRY (sort_by_place (p, sizeof (double), &volume));
    p->all.volume = volume;
    PG_TRY (sort_by_place (p, sizeof (int), &block));
    p->all.block = block;
done:
    return status;
}

/* A field of a step from all parts. */
static pg_status read_field (const parts *p, const pg_result *r, size_t field, size_t step, double **out)
{
    pg_status status = PG_OK;
    const pg_field_view *f = &r->field[field];
    size_t m = (size_t) f->components, at = 0, n;
    double *one = NULL;
    void *all = NULL;
    char path[4096];
    int components;
    PG_ALLOC (*out, p->all.n * m);
    for (int k = 0; k < pg_rank_count (); k++) {
        part_path (r, k, path, sizeof path);
        PG_TRY (pg_exodus_read (path, f->name, (int) step, &n, &components, &one));
        if (at + n > p->all.n || (size_t) components != m)
            PG_FAIL (PG_E_FILE, "%s does not belong to the other parts", path);
        memcpy (*out + at * m, one, n * m * sizeof *one);
        at += n;
        pg_free (one), one = NULL;
    }
    all = *out;
    PG_TRY (sort_by_place (p, m * sizeof **out, &all));
    *out = all;
done:
    pg_free (one);
    return status;
}

/* Rank 0 alone: result.e, step by step. */
static pg_status write_whole (const parts *p, const pg_result *r)
{
    pg_status status = PG_OK;
    pg_exodus *file = NULL;
    pg_field_view view[MOST_FIELDS];
    double *value[MOST_FIELDS] = { NULL };
    char path[4096];
    memcpy (view, r->field, sizeof view);
    snprintf (path, sizeof path, "%s/result.e", r->folder);
    PG_TRY (pg_exodus_create (&file, path, &p->all, r->problem->title, r->nfield, view));
    for (size_t s = 0; s < p->nstep; s++) {
        for (size_t k = 0; k < r->nfield; k++) {
            pg_free (value[k]), value[k] = NULL;
            PG_TRY (read_field (p, r, k, s, &value[k]));
            view[k].value = value[k];
        }
        PG_TRY (pg_exodus_write (file, p->time[s], view));
    }
done:
    pg_exodus_close (&file);
    for (size_t k = 0; k < MOST_FIELDS; k++) pg_free (value[k]);
    return status;
}

/* All ranks call; where one fails, the parts stay. */
pg_status pg_result_join_fields (pg_result *r)
{
    pg_status status = PG_OK;
    const pg_subdomain *s = r->problem->cloud.subdomain;
    const pg_cloud *own;
    parts p = { .nstep = 0 };
    int64_t *mine = NULL;
    void *all = NULL;
    size_t n = 0, bytes = 0;
    char path[4096];
    if (!s) return PG_OK;
    pg_exodus_close (&r->file);
    PG_TRY (pg_result_own_cloud (r, &own));
    PG_ALLOC (mine, s->nowned);
    for (size_t i = 0; i < s->n; i++) if (s->owned[i]) mine[n++] = s->number[i];
    PG_TRY (pg_ranks_collect (n * sizeof *mine, mine, &bytes, &all));
    if (pg_rank () == 0) {
        status = make_whole (&p, r, own, all, bytes / sizeof (int64_t));
        if (status == PG_OK) status = write_whole (&p, r);
    }
    PG_TRY (pg_ranks_agree (status));
    pg_result_fields_path (r, path, sizeof path);
    remove (path);
done:
    pg_free (mine), pg_free (all), pg_free (p.order), pg_free (p.time);
    pg_cloud_clear (&p.all);
    return status;
}
