/* SPDX-License-Identifier: GPL-3.0-or-later
 * Joins the parts of a result that ranks have written, result.e.SIZE.RANK, to one file with the points in the
 * order of a run by one process: the bytes that it would have written. The parts hold all that is needed
 * (exodus_layout.c), so that any program can do it, also after the run was killed; steps that not all parts
 * have are left out. */
#include "exodus.h"
#include "perigal/netcdf.h"
#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

/* A point: its number in the whole, and its index when the points are listed part by part. */
typedef struct { double number; size_t at; } place;
/* The parts, `size` of them. all: the points, part by part, then sorted; order: the points by ascending
 * number in the whole; nstep: the steps that all parts have; time: of each step; name: of each field. */
typedef struct {
    const char *folder;
    int     size;
    pg_cloud all;
    place  *order;
    size_t  nstep, nfield;
    double *time;
    char  (*name)[32], title[256];
} parts;

static int ascending (const void *a, const void *b)
{
    const place *x = a, *y = b;
    return (x->number > y->number) - (x->number < y->number);
}

void pg_exodus_part_path (char *out, size_t size, const char *folder, int count, int part)
{
    char digits[16];
    int width = snprintf (digits, sizeof digits, "%d", count);
    snprintf (out, size, "%s/result.e.%d.%0*d", folder, count, width, part);
}

/* 1 if a file name is that of a part, result.e.COUNT.PART; *count and *part are read from it. */
static int is_part (const char *name, int *count, int *part)
{
    char own[64];
    int used = 0;
    if (sscanf (name, "result.e.%d.%d%n", count, part, &used) != 2 || name[used] || *count < 1) return 0;
    pg_exodus_part_path (own, sizeof own, ".", *count, *part);
    return strcmp (own + 2, name) == 0;
}

/* Returns the number of parts of the newest divided result in the folder; 0: there are no parts. *when: time
 * of the last change of a part. */
static int find_parts (const char *folder, struct timespec *when)
{
    int size = 0;
    struct dirent *entry;
    DIR *dir = opendir (folder);
    *when = (struct timespec) { 0 };
    while (dir && (entry = readdir (dir))) {
        int n, part;
        char path[4096];
        struct stat s;
        if (!is_part (entry->d_name, &n, &part)) continue;
        snprintf (path, sizeof path, "%s/%s", folder, entry->d_name);
        if (stat (path, &s) != 0) continue;
        if (s.st_mtim.tv_sec < when->tv_sec
            || (s.st_mtim.tv_sec == when->tv_sec && s.st_mtim.tv_nsec < when->tv_nsec))
            continue;
        *when = s.st_mtim, size = n;
    }
    if (dir) closedir (dir);
    return size;
}

void pg_exodus_drop_parts (const char *folder, int keep)
{
    struct dirent *entry;
    DIR *dir = opendir (folder);
    while (dir && (entry = readdir (dir))) {
        int n, part;
        char path[4096];
        if (!is_part (entry->d_name, &n, &part) || (n == keep && part < n)) continue;
        snprintf (path, sizeof path, "%s/%s", folder, entry->d_name);
        remove (path);
    }
    if (dir) closedir (dir);
}

/* How many points a part has. */
static pg_status count_points (const char *path, size_t *n)
{
    pg_status status = PG_OK;
    pg_netcdf *file = NULL;
    PG_TRY (pg_netcdf_open (&file, path));
    *n = pg_netcdf_length (file, "num_nodes");
done:
    pg_netcdf_close (&file);
    return status;
}

/* Reads the numbers that the n points of a part have in the whole, and the title of the file. */
static pg_status read_header (parts *p, const char *path, size_t n, double *number)
{
    pg_status status = PG_OK;
    pg_netcdf *file = NULL;
    PG_TRY (pg_netcdf_open (&file, path));
    int map = pg_netcdf_find (file, "point_number");
    if (map < 0) map = pg_netcdf_find (file, "node_num_map");
    if (map < 0) PG_FAIL (PG_E_FILE, "%s does not say which points of the whole it has", path);
    PG_TRY (pg_netcdf_doubles (file, map, 0, n, number));
    if (!pg_netcdf_text (file, -1, "title", p->title, sizeof p->title)) p->title[0] = 0;
done:
    pg_netcdf_close (&file);
    return status;
}

/* Appends the points of a part to p->all, behind the *at points of the parts before it, and reduces p->nstep
 * to the number of steps of this part if it has fewer. */
static pg_status add_points (parts *p, int part, size_t *at)
{
    pg_status status = PG_OK;
    pg_cloud one = { 0 }, *all = &p->all;
    double *number = NULL;
    char path[4096];
    size_t nstep, dim = (size_t) all->dim;
    pg_exodus_part_path (path, sizeof path, p->folder, p->size, part);
    PG_TRY (pg_exodus_points (path, &one, &nstep, NULL));
    if (one.dim != all->dim || *at + one.n > all->n)
        PG_FAIL (PG_E_FILE, "%s does not belong to the other parts", path);
    PG_ALLOC (number, one.n);
    PG_TRY (read_header (p, path, one.n, number));
    memcpy (all->x + *at * dim, one.x, one.n * dim * sizeof *one.x);
    memcpy (all->volume + *at, one.volume, one.n * sizeof *one.volume);
    memcpy (all->block + *at, one.block, one.n * sizeof *one.block);
    for (size_t i = 0; i < one.n; i++) p->order[*at + i] = (place) { number[i], *at + i };
    *at += one.n, p->nstep = nstep < p->nstep ? nstep : p->nstep;
done:
    pg_free (number);
    pg_free (one.x), pg_free (one.volume), pg_free (one.block);
    return status;
}

/* Sorts an array with `size` bytes per point from the order part by part to that of the whole. */
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

/* Reads the points of all parts into p->all, in the order of the whole, and the steps and names of fields. */
static pg_status read_whole (parts *p)
{
    pg_status status = PG_OK;
    size_t n = 0, at = 0, one;
    char path[4096];
    pg_cloud *all = &p->all;
    for (int k = 0; k < p->size; k++) {
        struct stat s;
        pg_exodus_part_path (path, sizeof path, p->folder, p->size, k);
        if (stat (path, &s) != 0)
            PG_FAIL (PG_E_FILE, "result.e of %d ranks cannot be put together: %s is missing", p->size, path);
        PG_TRY (count_points (path, &one));
        n += one;
    }
    pg_exodus_part_path (path, sizeof path, p->folder, p->size, 0);
    PG_TRY (pg_exodus_points (path, all, &p->nstep, &p->time));
    PG_TRY (pg_exodus_fields (path, &p->name, &p->nfield));
    pg_free (all->x), pg_free (all->volume), pg_free (all->block);
    all->x = all->volume = NULL, all->block = NULL, all->n = n;
    PG_ALLOC (all->x, n * (size_t) all->dim);
    PG_ALLOC (all->volume, n);
    PG_ALLOC (all->block, n);
    PG_ALLOC (p->order, n);
    for (int k = 0; k < p->size; k++) PG_TRY (add_points (p, k, &at));
    pg_sort (p->order, n, sizeof *p->order, ascending);
    for (size_t i = 1; i < n; i++)
        if (p->order[i].number == p->order[i - 1].number)
            PG_FAIL (PG_E_FILE, "%s: two parts have the same point", p->folder);
    void *x = all->x, *volume = all->volume, *block = all->block;
    PG_TRY (sort_by_place (p, (size_t) all->dim * sizeof (double), &x));
    all->x = x;
    PG_TRY (sort_by_place (p, sizeof (double), &volume));
    all->volume = volume;
    PG_TRY (sort_by_place (p, sizeof (int), &block));
    all->block = block;
    if (p->nfield && strcmp (p->name[p->nfield - 1], "volume") == 0) p->nfield--;   /* always added */
done:
    return status;
}

/* Reads field f->name of a step from all parts into *out, in the order of the whole. */
static pg_status read_field (const parts *p, size_t step, pg_field_view *f, double **out)
{
    pg_status status = PG_OK;
    size_t at = 0, n;
    double *one = NULL;
    void *all = NULL;
    char path[4096];
    int components;
    pg_free (*out), *out = NULL;
    for (int k = 0; k < p->size; k++) {
        pg_exodus_part_path (path, sizeof path, p->folder, p->size, k);
        PG_TRY (pg_exodus_read (path, f->name, (int) step, &n, &components, &one));
        if (!*out) {
            f->components = components;
            PG_ALLOC (*out, p->all.n * (size_t) components);
        }
        if (at + n > p->all.n || components != f->components)
            PG_FAIL (PG_E_FILE, "%s does not belong to the other parts", path);
        memcpy (*out + at * (size_t) components, one, n * (size_t) components * sizeof *one);
        at += n;
        pg_free (one), one = NULL;
    }
    all = *out;
    PG_TRY (sort_by_place (p, (size_t) f->components * sizeof **out, &all));
    f->value = *out = all;
done:
    pg_free (one);
    return status;
}

/* Writes the joined file step by step as result.e.whole, which is renamed to result.e when it is complete. */
static pg_status write_whole (const parts *p)
{
    pg_status status = PG_OK;
    pg_exodus *file = NULL;
    pg_field_view *view = NULL;
    double **value = NULL;
    char path[4096], fresh[4096];
    PG_ALLOC (view, p->nfield + 1);
    PG_ALLOC (value, p->nfield + 1);
    snprintf (path, sizeof path, "%s/result.e", p->folder);
    snprintf (fresh, sizeof fresh, "%s/result.e.whole", p->folder);
    for (size_t s = 0; s < p->nstep; s++) {
        for (size_t k = 0; k < p->nfield; k++) {
            snprintf (view[k].name, sizeof view[k].name, "%s", p->name[k]);
            PG_TRY (read_field (p, s, &view[k], &value[k]));
            if (s > 0) continue;
            char first[4096];
            pg_exodus_part_path (first, sizeof first, p->folder, p->size, 0);
            PG_TRY (pg_exodus_unit (first, p->name[k], view[k].unit));
        }
        if (!file) PG_TRY (pg_exodus_create (&file, fresh, &p->all, p->title, p->nfield, view, NULL));
        PG_TRY (pg_exodus_write (file, p->time[s], view));
    }
    if (!file) PG_FAIL (PG_E_FILE, "%s: the parts of result.e hold no step yet", p->folder);
    if (rename (fresh, path) != 0) PG_FAIL (PG_E_FILE, "%s: %s", path, strerror (errno));
done:
    if (status != PG_OK && file) remove (fresh);
    pg_exodus_close (&file);
    for (size_t k = 0; value && k < p->nfield; k++) pg_free (value[k]);
    pg_free (value), pg_free (view);
    return status;
}

pg_status pg_exodus_join (const char *folder, int again)
{
    pg_status status = PG_OK;
    parts p = { .folder = folder };
    struct timespec when;
    struct stat s;
    char path[4096];
    p.size = find_parts (folder, &when);
    if (p.size == 0) return PG_OK;
    snprintf (path, sizeof path, "%s/result.e", folder);
    int there = stat (path, &s) == 0;
    int older = there && (s.st_mtim.tv_sec < when.tv_sec
                          || (s.st_mtim.tv_sec == when.tv_sec && s.st_mtim.tv_nsec < when.tv_nsec));
    if (there && !older && !again) return PG_OK;
    PG_TRY (read_whole (&p));
    PG_TRY (write_whole (&p));
done:
    pg_free (p.order), pg_free (p.time), pg_free (p.name);
    pg_free (p.all.x), pg_free (p.all.volume), pg_free (p.all.block);
    return status;
}
