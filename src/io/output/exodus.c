/* SPDX-License-Identifier: GPL-3.0-or-later
 * Writes result.e so that it can be read at any instant: while the run goes on, after it was
 * killed, and after the disk was full.
 *
 * exodus_layout.c writes the header, the points and the variables without steps to PATH.new,
 * which is renamed to PATH when it is complete. Each step is one record appended to the file, by
 * the published layout of the classic format: one value of time_whole, then n values for each
 * vals_nod_var<k>, each the most significant byte first.
 * The values are written first, time_whole next, and last the number of records, 4 or 8 bytes
 * from byte 4 of the file on; readers see the step only then. A step that cannot be written
 * whole is cut off again. */
#include "disk.h"
#include "entries.h"
#include "exodus.h"
#include "perigal/netcdf.h"
#include <errno.h>
#include <fcntl.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* A file that is open for appending. */
struct pg_exodus {
    /* File descriptor; dimension of the points; wide: 1 for CDF-5, whose counts have 8 bytes,
     * 0 for 64-bit offsets with 4. */
    int     file, dim, wide;
    /* First byte of the steps and bytes of one step. */
    long    begin, record;
    /* Numbers of points, of steps written, of fields of the caller, of components of all fields. */
    size_t  n, step, nfield, nvar;
    /* 1: volume is not among the caller's fields and is written as one more. */
    int     extra;
    char   *path;
    /* The fields as they were requested (nfield + 1); only the extra one has values. */
    pg_field_view *field;
    /* Volumes of the points, and scratch space for one component (n each). */
    double *volume, *buffer;
};

/* PG_E_USAGE: no points or more than a 32-bit count holds, a bad dimension, fields without a
 * name or with a bad number of components, or two of one name, which readers could not tell
 * apart. */
static pg_status check_request (const char *path, const pg_cloud *cloud, size_t nfield,
                                const pg_field_view *fields)
{
    pg_status status = PG_OK;
    if (cloud->n == 0 || cloud->n >= 0x7fffffff) PG_FAIL (PG_E_USAGE, "%s: %zu points", path, cloud->n);
    if (cloud->dim < 1 || cloud->dim > 3) PG_FAIL (PG_E_USAGE, "%s: dimension %d", path, cloud->dim);
    for (size_t v = 0; v < nfield; v++) {
        if (fields[v].components < 1 || fields[v].components > EXODUS_COMPONENTS || !fields[v].name[0])
            PG_FAIL (PG_E_USAGE, "%s: field '%.31s' has %d components", path, fields[v].name,
                     fields[v].components);
        for (size_t w = 0; w < v; w++)
            if (strcmp (fields[v].name, fields[w].name) == 0)
                PG_FAIL (PG_E_USAGE, "%s: two fields '%.31s'", path, fields[v].name);
    }
done:
    return status;
}

/* Copies what later steps are checked against and computes the size of a record: the time and
 * n values for each component, 8 bytes each. */
static pg_status copy_request (pg_exodus *f, const char *path, const pg_cloud *cloud, size_t nfield,
                               const pg_field_view *fields)
{
    pg_status status = PG_OK;
    f->file = -1;
    f->dim = cloud->dim, f->n = cloud->n;
    f->path = pg_strdup (path);
    if (!f->path) PG_FAIL (PG_E_MEMORY, "no memory for a path");
    PG_ALLOC (f->field, nfield + 1);
    PG_ALLOC (f->volume, f->n);
    PG_ALLOC (f->buffer, f->n);
    if (cloud->volume) memcpy (f->volume, cloud->volume, f->n * sizeof (double));
    f->nfield = nfield;
    f->extra = 1;
    for (size_t v = 0; v < nfield; v++) {
        f->field[v] = fields[v];
        f->field[v].value = NULL;
        f->nvar += (size_t) fields[v].components;
        if (strcmp (fields[v].name, "volume") == 0) f->extra = 0;
    }
    f->field[nfield] = (pg_field_view) { "volume", "m3", 1, f->volume };
    f->nvar += (size_t) f->extra;
    f->record = (long) (sizeof (double) * (1 + f->n * f->nvar));
done:
    return status;
}

/* Opens the file (f->path) and checks that it begins as a classic netCDF file of the two kinds that we
 * write. O_NOFOLLOW: symbolic links are refused. */
static pg_status open_file (pg_exodus *f, long *bytes)
{
    pg_status status = PG_OK;
    struct stat s;
    char magic[4];
    f->file = open (f->path, O_RDWR | O_NOFOLLOW | O_CLOEXEC);
    if (f->file < 0 || fstat (f->file, &s) != 0) PG_FAIL (PG_E_FILE, "%s: %s", f->path, strerror (errno));
    if (pread (f->file, magic, 4, 0) != 4 || memcmp (magic, "CDF", 3) != 0
        || (magic[3] != 2 && magic[3] != 5))
        PG_FAIL (PG_E_FILE, "%s: not a file that this program can append to", f->path);
    f->wide = magic[3] == 5;
    *bytes = (long) s.st_size;
done:
    return status;
}

/* Writes the header under PATH.new and renames it, so that PATH appears whole or not at all.
 * The steps begin at the end of this file, whose length is therefore kept (f->begin). */
static pg_status create_file (pg_exodus *f, const pg_cloud *cloud, const char *title,
                              const pg_field_share *share)
{
    pg_status status = PG_OK;
    char *fresh = NULL;
    PG_TRY (pg_disk_fresh (&fresh, f->path));
    exodus_layout layout = {
        fresh, cloud, title, f->nfield + (size_t) f->extra, f->nvar, f->field, f->volume, 0, NULL, share
    };
    PG_TRY (pg_exodus_layout_write (&layout));
    if (rename (fresh, f->path) != 0) PG_FAIL (PG_E_FILE, "%s: %s", f->path, strerror (errno));
    PG_TRY (open_file (f, &f->begin));
done:
    if (status != PG_OK && fresh) remove (fresh);
    pg_free (fresh);
    return status;
}

/* The request is checked before the file is touched. */
pg_status pg_exodus_create (pg_exodus **out, const char *path, const pg_cloud *cloud, const char *title,
                            size_t nfield, const pg_field_view *fields, const pg_field_share *share)
{
    pg_status status = PG_OK;
    pg_exodus *f = NULL;
    *out = NULL;
    PG_TRY (check_request (path, cloud, nfield, fields));
    PG_ALLOC (f, 1);
    PG_TRY (copy_request (f, path, cloud, nfield, fields));
    PG_TRY (create_file (f, cloud, title, share));
    *out = f;
    f = NULL;
done:
    pg_exodus_close (&f);
    return status;
}

/* Writes the number of steps into the header, the most significant byte first. */
static pg_status count_records (pg_exodus *f, size_t count)
{
    uint64_t bytes = count;
    size_t m = f->wide ? 8 : 4;
    pg_netcdf_swap (&bytes, 1, sizeof bytes);
    return pg_disk_write (f->path, f->file, (const char *) &bytes + sizeof bytes - m, m, 4);
}

/* PG_E_FILE unless the file was made for the same number of points and components: otherwise
 * steps would be appended in another layout. */
static pg_status check_sizes (const pg_exodus *f)
{
    pg_status status = PG_OK;
    pg_netcdf *file = NULL;
    PG_TRY (pg_netcdf_open (&file, f->path));
    size_t n = pg_netcdf_length (file, "num_nodes"), m = pg_netcdf_length (file, "num_nod_var");
    if (n != f->n || m != f->nvar)
        PG_FAIL (PG_E_FILE, "%s holds %zu values at %zu points, not %zu at %zu: it is of another run",
                 f->path, m, n, f->nvar, f->n);
done:
    pg_netcdf_close (&file);
    return status;
}

/* The steps begin where `steps` records before byte `bytes` end up; the third condition
 * demands that this leaves at least one byte for the header. */
pg_status pg_exodus_open (pg_exodus **out, const char *path, const pg_cloud *cloud, size_t nfield,
                          const pg_field_view *fields, long steps, long bytes)
{
    pg_status status = PG_OK;
    pg_exodus *f = NULL;
    long present;
    *out = NULL;
    PG_TRY (check_request (path, cloud, nfield, fields));
    PG_ALLOC (f, 1);
    PG_TRY (copy_request (f, path, cloud, nfield, fields));
    PG_TRY (open_file (f, &present));
    PG_TRY (check_sizes (f));
    if (steps < 0 || bytes < 0 || steps >= bytes / f->record + (bytes % f->record > 0))
        PG_FAIL (PG_E_USAGE, "%s: %ld steps in %ld bytes", path, steps, bytes);
    if (present < bytes)
        PG_FAIL (PG_E_FILE, "%s has %ld bytes, %ld are missing: it was changed since", path, present,
                 bytes - present);
    f->begin = bytes - steps * f->record;
    f->step = (size_t) steps;
    PG_TRY (count_records (f, f->step));
    PG_TRY (pg_disk_cut (path, f->file, bytes));
    pg_exodus_drop_pieces (path);                      /* PATH.new of a run that was killed at its end */
    *out = f;
    f = NULL;
done:
    pg_exodus_close (&f);
    return status;
}

/* A checkpoint stores both numbers, so that a restart can cut the file back to these steps. */
void pg_exodus_size (const pg_exodus *f, long *steps, long *bytes)
{
    *steps = (long) f->step;
    *bytes = f->begin + (long) f->step * f->record;
}

/* Writes the components of one field one behind the other from byte *at on, and moves *at
 * behind them. The file has one array per component, the caller one per field. */
static pg_status write_view (pg_exodus *f, const pg_field_view *view, long *at)
{
    pg_status status = PG_OK;
    size_t m = (size_t) view->components, bytes = f->n * sizeof (double);
    for (size_t c = 0; c < m; c++, *at += (long) bytes) {
        for (size_t i = 0; i < f->n; i++) f->buffer[i] = view->value[i * m + c];
        pg_netcdf_swap (f->buffer, f->n, sizeof *f->buffer);
        PG_TRY (pg_disk_write (f->path, f->file, f->buffer, bytes, *at));
    }
done:
    return status;
}

/* Writes one step in the order that keeps the file readable at any instant: first the values,
 * which lie behind the counted records, then the time, then the count, after which readers see
 * the step. */
static pg_status write_record (pg_exodus *f, double time, const pg_field_view *fields)
{
    pg_status status = PG_OK;
    long start = f->begin + (long) f->step * f->record, at = start + (long) sizeof time;
    for (size_t v = 0; v < f->nfield; v++) PG_TRY (write_view (f, &fields[v], &at));
    if (f->extra) PG_TRY (write_view (f, &f->field[f->nfield], &at));
    pg_netcdf_swap (&time, 1, sizeof time);
    PG_TRY (pg_disk_write (f->path, f->file, &time, sizeof time, start));
    PG_TRY (count_records (f, f->step + 1));
done:
    return status;
}

/* The fields must be those of the creation, in their order. If cutting off a failed step fails
 * as well, its bytes stay behind the counted records, where readers ignore them and the next
 * step overwrites them. */
pg_status pg_exodus_write (pg_exodus *f, double time, const pg_field_view *fields)
{
    pg_status status = PG_OK;
    for (size_t v = 0; v < f->nfield; v++)
        if (strcmp (fields[v].name, f->field[v].name) != 0 || fields[v].components != f->field[v].components
            || !fields[v].value)
            PG_FAIL (PG_E_USAGE, "%s: field %zu is '%s' with %d values a point, expected '%s' with %d",
                     f->path, v + 1, fields[v].name, fields[v].value ? fields[v].components : 0,
                     f->field[v].name, f->field[v].components);
    status = write_record (f, time, fields);
    if (status == PG_OK) f->step++;
    else {
        int cut = ftruncate (f->file, f->begin + (long) f->step * f->record);
        (void) cut;                                    /* if it failed: readers ignore uncounted records */
    }
done:
    return status;
}

/* ---- faces of cracks (pieces) -------------------------------------------------------------------------- */
/* Copies the next record of f to the file with m crack faces: behind the n values of each component those at
 * the corners of the faces, taken from their points; at the end, for each face, 1 if it exists at that time,
 * else 0. old, new: space for one record of each file. Values stay in the byte order of the file. */
static pg_status widen_record (const pg_exodus *f, pg_exodus *wide, size_t m, const pg_crack_face *piece,
                               double *old, double *new)
{
    pg_status status = PG_OK;
    size_t k = wide->step, each = (size_t) f->dim;
    if (pread (f->file, old, (size_t) f->record, f->begin + (long) k * f->record) != f->record)
        PG_FAIL (PG_E_FILE, "%s: %s", f->path, errno ? strerror (errno) : "it has become shorter");
    double time = old[0], *to = new + 1;
    pg_netcdf_swap (&time, 1, sizeof time);               /* from the byte order of the file to the host's */
    new[0] = old[0];
    for (size_t v = 0; v < f->nvar; v++) {
        const double *from = old + 1 + v * f->n;
        memcpy (to, from, f->n * sizeof *to);
        to += f->n;
        /* the last component may be the volume, which is 0 at the corners of crack faces */
        int none = f->extra && v + 1 == f->nvar;
        for (size_t i = 0; i < each * m; i++) *to++ = none ? 0 : from[piece[i / each].point[i % each]];
    }
    for (size_t i = 0; i < m; i++) to[i] = time >= piece[i].since;
    pg_netcdf_swap (to, m, sizeof *to);
    PG_TRY (pg_disk_write (wide->path, wide->file, new, (size_t) wide->record,
                           wide->begin + (long) k * wide->record));
    wide->step++;
done:
    return status;
}

/* Copies all records of f, widened by crack faces, into the new file, which has only a header so far. */
static pg_status copy_records (const pg_exodus *f, pg_exodus *wide, size_t m, const pg_crack_face *piece)
{
    pg_status status = PG_OK;
    double *old = NULL, *new = NULL;
    PG_TRY (open_file (wide, &wide->begin));
    wide->record = f->record + (long) (sizeof (double) * ((size_t) f->dim * m * f->nvar + m));
    PG_ALLOC (old, (size_t) f->record / sizeof *old);
    PG_ALLOC (new, (size_t) wide->record / sizeof *new);
    for (size_t k = 0; k < f->step; k++) PG_TRY (widen_record (f, wide, m, piece, old, new));
    PG_TRY (count_records (wide, wide->step));
    PG_TRY (pg_file_sync (wide->path));
done:
    pg_free (old), pg_free (new);
    return status;
}

pg_status pg_exodus_prepare_pieces (const pg_exodus *f, const pg_cloud *cloud, const char *title, size_t n,
                                    const pg_crack_face *piece)
{
    pg_status status = PG_OK;
    pg_exodus wide = { .file = -1 };
    char *fresh = NULL;
    if (n == 0) return PG_OK;
    size_t each = (size_t) f->dim;
    for (size_t i = 0; i < each * n; i++)
        if (piece[i / each].point[i % each] >= f->n)
            PG_FAIL (PG_E_USAGE, "%s: a piece of a crack hangs on point %zu of %zu", f->path,
                     piece[i / each].point[i % each], f->n);
    PG_TRY (pg_disk_fresh (&fresh, f->path));
    wide = (pg_exodus) { .file = -1, .dim = f->dim, .path = fresh };
    exodus_layout layout = {
        fresh, cloud, title, f->nfield + (size_t) f->extra, f->nvar, f->field, f->volume, n, piece, NULL
    };
    PG_TRY (pg_exodus_layout_write (&layout));
    PG_TRY (copy_records (f, &wide, n, piece));
done:
    if (wide.file >= 0) close (wide.file);
    if (status != PG_OK && fresh) remove (fresh);
    pg_free (fresh);
    return status;
}

pg_status pg_exodus_commit_pieces (const char *path)
{
    pg_status status = PG_OK;
    char *fresh = NULL;
    PG_TRY (pg_disk_fresh (&fresh, path));
    if (rename (fresh, path) != 0 && errno != ENOENT) PG_FAIL (PG_E_FILE, "%s: %s", fresh, strerror (errno));
done:
    pg_free (fresh);
    return status;
}

void pg_exodus_drop_pieces (const char *path)
{
    char *fresh = NULL;
    if (pg_disk_fresh (&fresh, path) == PG_OK) remove (fresh);
    pg_free (fresh);
}

pg_status pg_exodus_sync (const pg_exodus *f) { return pg_file_sync (f->path); }

/* Nothing is left to write: every step was complete when its call returned. */
void pg_exodus_close (pg_exodus **file)
{
    if (!file || !*file) return;
    pg_exodus *f = *file;
    if (f->file >= 0) close (f->file);
    pg_free (f->buffer);
    pg_free (f->volume);
    pg_free (f->field);
    pg_free (f->path);
    pg_free (f);
    *file = NULL;
}

/* ---- the entry of the catalogue ------------------------------------------------------------------------ */
/* Path of result.e, or, if the points are divided (share), of the part of this process. */
static void path_of (char *out, size_t size, const char *folder, const pg_field_share *share)
{
    if (share) pg_exodus_part_path (out, size, folder, share->size, share->part);
    else snprintf (out, size, "%s/result.e", folder);
}

/* State of this writer: the open file, and the request, which prepare_result needs again at the end. */
typedef struct { pg_exodus *file; const pg_field_request *request; } result;

static void close_result (void **self)
{
    result *r = *self;
    if (!r) return;
    pg_exodus_close (&r->file);
    pg_free (r);
    *self = NULL;
}

static pg_status open_result (void **self, const pg_field_request *q, const pg_field_marks *at)
{
    pg_status status = PG_OK;
    result *r = NULL;
    char path[4096];
    path_of (path, sizeof path, q->folder, q->share);
    PG_ALLOC (r, 1);
    r->request = q;
    PG_TRY (at ? pg_exodus_open (&r->file, path, q->cloud, q->nfield, q->field, at->moments, at->keep)
               : pg_exodus_create (&r->file, path, q->cloud, q->title, q->nfield, q->field, q->share));
done:
    if (status != PG_OK) pg_free (r), r = NULL;
    *self = r;
    return status;
}

static pg_status write_moment (void *self, long moment, double time, const pg_field_view *field)
{
    (void) moment;
    return pg_exodus_write (((result *) self)->file, time, field);
}

static long keep_length (const void *self)
{
    long steps, bytes;
    pg_exodus_size (((const result *) self)->file, &steps, &bytes);
    return bytes;
}

static pg_status sync_result (void *self) { return pg_exodus_sync (((result *) self)->file); }

/* One process: writes a copy of the file with the n crack faces. Several: rank 0 joins the parts if the user
 * wants that; the parts stay. */
static pg_status prepare_result (void *self, size_t n, const pg_crack_face *face)
{
    const result *r = self;
    const pg_field_request *q = r->request;
    if (!q->share) return pg_exodus_prepare_pieces (r->file, q->cloud, q->title, n, face);
    return q->share->joined && q->share->part == 0 ? pg_exodus_join (q->folder, 1) : PG_OK;
}

/* With joined parts each rank removes its own part; a single process also removes parts that ranks killed
 * before this have left beside a complete result.e. */
static pg_status finish_result (const char *folder, const pg_field_share *share, int done)
{
    pg_status status = PG_OK;
    char path[4096];
    path_of (path, sizeof path, folder, share);
    if (!done) pg_exodus_drop_pieces (path);
    else if (share && share->joined) remove (path);
    else if (!share) {
        PG_TRY (pg_exodus_commit_pieces (path));
        if (access (path, F_OK) == 0) pg_exodus_drop_parts (folder, 0);
    }
done:
    return status;
}

static void clear_results (const char *folder, int keep)
{
    static const char *const whole[] = { "result.e", "result.e.new", "result.e.whole" };
    char path[4096];
    pg_exodus_drop_parts (folder, keep > 0 ? keep : 0);
    for (size_t k = 0; keep != 0 && k < sizeof whole / sizeof *whole; k++) {
        snprintf (path, sizeof path, "%s/%s", folder, whole[k]);
        remove (path);
    }
}

static pg_status read_times (const char *folder, int size, size_t *n, double **time)
{
    const pg_field_share first = { .size = size };
    pg_cloud cloud;
    char path[4096];
    path_of (path, sizeof path, folder, size ? &first : NULL);
    pg_status status = pg_exodus_points (path, &cloud, n, time);
    pg_cloud_clear (&cloud);
    return status;
}

static pg_status read_moment (const char *folder, int size, int part, long moment, const char *field,
                              size_t *n, int *components, double **value)
{
    const pg_field_share one = { .size = size, .part = part };
    char path[4096];
    path_of (path, sizeof path, folder, size ? &one : NULL);
    return pg_exodus_read (path, field, (int) moment, n, components, value);
}

const pg_writer pg_writer_exodus = {
    .name = "exodus",
    .summary = "result.e, Exodus in classic netCDF: one file, which this program reads as well",
    .file = "result.e",
    .parts = PG_PARTS_JOIN,
    .open = open_result,
    .step = write_moment,
    .keep = keep_length,
    .close = close_result,
    .sync = sync_result,
    .prepare = prepare_result,
    .finish = finish_result,
    .clear = clear_results,
    .times = read_times,
    .read = read_moment,
};
