/* SPDX-License-Identifier: GPL-3.0-or-later
 * checkpoint.nc: each name of a pg_keeper's walk is one variable of a CDF-5 file (doubles, 64-bit integers,
 * bytes); the last one, `checksum` over all names, types, lengths and values, tells a whole file from one
 * that was cut off or changed, before a value is used. A first walk defines, a second writes; reading is one
 * walk. */
#include "disk.h"
#include "exodus.h"
#include "perigal/mesh_files.h"
#include <errno.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

typedef struct { const char *path; int ncid, open, defining, reading; uint64_t sum; } checkpoint;

static size_t size_of (nc_type type) { return type == NC_BYTE ? 1 : 8; }

static void sum_head (checkpoint *c, const char *name, size_t n, nc_type type)
{
    const uint64_t head[2] = { (uint64_t) n, (uint64_t) type };
    c->sum = pg_fingerprint (pg_fingerprint (c->sum, name, strlen (name) + 1), head, sizeof head);
}

static pg_status define (checkpoint *c, const char *name, size_t n, nc_type type)
{
    pg_status status = PG_OK;
    char length[40];
    int dim, var;
    snprintf (length, sizeof length, "length_%zu", n);
    if (nc_inq_dimid (c->ncid, length, &dim) != NC_NOERR)
        NC_TRY (c->path, nc_def_dim (c->ncid, length, n, &dim));
    int code = nc_def_var (c->ncid, name, type, 1, &dim, &var);
    if (code != NC_NOERR) PG_FAIL (PG_E_USAGE, "%s: '%s': %s", c->path, name, nc_strerror (code));
done:
    return status;
}

/* Variable of a name; its length and type must be those of the walk. */
static pg_status find (const checkpoint *c, const char *name, size_t n, nc_type type, int *var)
{
    pg_status status = PG_OK;
    nc_type found;
    int ndim, dim[NC_MAX_VAR_DIMS];
    size_t m = 0;
    if (nc_inq_varid (c->ncid, name, var) != NC_NOERR) PG_FAIL (PG_E_FILE, "%s lacks '%s'", c->path, name);
    NC_TRY (c->path, nc_inq_var (c->ncid, *var, NULL, &found, &ndim, dim, NULL));
    if (ndim == 1) NC_TRY (c->path, nc_inq_dimlen (c->ncid, dim[0], &m));
    if (m != n || found != type) PG_FAIL (PG_E_FILE, "%s: '%s' has %zu values, not %zu", c->path, name, m, n);
done:
    return status;
}

static pg_status keep (checkpoint *c, const char *name, size_t n, nc_type type, void *value)
{
    pg_status status = PG_OK;
    int var;
    if (n == 0) goto done;                             /* netCDF knows no empty dimension */
    if (c->defining) {
        status = define (c, name, n, type);
        goto done;
    }
    PG_TRY (find (c, name, n, type, &var));
    NC_TRY (c->path, c->reading ? nc_get_var (c->ncid, var, value) : nc_put_var (c->ncid, var, value));
    if (c->reading) goto done;
    sum_head (c, name, n, type);
    c->sum = pg_fingerprint (c->sum, value, n * size_of (type));
done:
    return status;
}

_Static_assert (sizeof (long) == sizeof (int64_t), "counts are kept as 64-bit integers");
static pg_status keep_numbers (void *c, const char *name, size_t n, double *value)
{
    return keep (c, name, n, NC_DOUBLE, value);
}
static pg_status keep_counts (void *c, const char *name, size_t n, long *value)
{
    return keep (c, name, n, NC_INT64, value);
}
static pg_status keep_bytes (void *c, const char *name, size_t n, void *value)
{
    return keep (c, name, n, NC_BYTE, value);
}

/* The same sum from the file, piece by piece. */
static pg_status sum_variable (checkpoint *c, int var)
{
    pg_status status = PG_OK;
    enum { PIECE = 1 << 13 };
    uint64_t part[PIECE];
    char name[NC_MAX_NAME + 1];
    int ndim, dim[NC_MAX_VAR_DIMS];
    nc_type type;
    size_t n = 0;
    NC_TRY (c->path, nc_inq_var (c->ncid, var, name, &type, &ndim, dim, NULL));
    if (ndim != 1 || (type != NC_BYTE && type != NC_DOUBLE && type != NC_INT64))
        PG_FAIL (PG_E_FILE, "%s: '%s' is none of a checkpoint", c->path, name);
    NC_TRY (c->path, nc_inq_dimlen (c->ncid, dim[0], &n));
    sum_head (c, name, n, type);
    for (size_t from = 0; from < n; from += PIECE) {
        size_t count = n - from < PIECE ? n - from : PIECE;
        NC_TRY (c->path, nc_get_vara (c->ncid, var, &from, &count, part));
        c->sum = pg_fingerprint (c->sum, part, count * size_of (type));
    }
done:
    return status;
}

static pg_status check_sum (checkpoint *c)
{
    pg_status status = PG_OK;
    int n, last;
    int64_t found = 0;
    NC_TRY (c->path, nc_inq_nvars (c->ncid, &n));
    if (n < 1 || nc_inq_varid (c->ncid, "checksum", &last) != NC_NOERR || last != n - 1)
        PG_FAIL (PG_E_FILE, "%s is no checkpoint, or not complete: it has no checksum", c->path);
    PG_TRY (find (c, "checksum", 1, NC_INT64, &last));
    for (int var = 0; var < last; var++) PG_TRY (sum_variable (c, var));
    NC_TRY (c->path, nc_get_var (c->ncid, last, &found));
    if (found != (int64_t) c->sum)
        PG_FAIL (PG_E_FILE,
                 "%s is damaged or cut off: its checksum is not that of its values; begin anew with --force",
                 c->path);
done:
    return status;
}

static pg_status make_walk (checkpoint *c, pg_keep walk, void *context)
{
    pg_status status = PG_OK;
    pg_keeper keeper = { c, c->reading, keep_numbers, keep_counts, keep_bytes };
    c->sum = PG_FINGERPRINT;
    if (c->reading) PG_TRY (check_sum (c));
    PG_TRY (walk (context, &keeper));
    long sum = (long) c->sum;
    if (!c->reading) PG_TRY (keep_counts (c, "checksum", 1, &sum));
done:
    return status;
}

static pg_status write_file (checkpoint *c, pg_keep walk, void *context)
{
    pg_status status = PG_OK;
    int before;
    size_t buffer = 1 << 20;
    FILE *probe;                                       /* netCDF does not always tell the system's reason */
    PG_TRY (pg_file_create (&probe, c->path));
    fclose (probe);
    NC_TRY (c->path, nc__create (c->path, NC_CLOBBER | NC_64BIT_DATA, 0, &buffer, &c->ncid));
    c->open = 1;
    NC_TRY (c->path, nc_set_fill (c->ncid, NC_NOFILL, &before));
    c->defining = 1;
    PG_TRY (make_walk (c, walk, context));
    NC_TRY (c->path, nc_enddef (c->ncid));
    c->defining = 0;
    PG_TRY (make_walk (c, walk, context));
    c->open = 0;
    NC_TRY (c->path, nc_close (c->ncid));
    PG_TRY (pg_disk_sync (c->path));
done:
    if (c->open) nc_close (c->ncid);
    return status;
}

static pg_status sync_folder_of (const char *path, char *work)
{
    const char *slash = strrchr (path, '/');
    size_t n = slash == path ? 1 : slash ? (size_t) (slash - path) : 1;
    memcpy (work, slash ? path : ".", n);
    work[n] = 0;
    return pg_disk_sync (work);
}

pg_status pg_checkpoint_write (const char *path, pg_keep walk, void *context)
{
    pg_status status = PG_OK;
    checkpoint c = { 0 };
    char *fresh = NULL;
    int moved = 0;
    size_t size = strlen (path) + 5;
    PG_ALLOC (fresh, size);
    snprintf (fresh, size, "%s.new", path);
    c.path = fresh;
    PG_TRY (write_file (&c, walk, context));
    if (rename (fresh, path) != 0) PG_FAIL (PG_E_FILE, "%s: %s", path, strerror (errno));
    moved = 1;
    PG_TRY (sync_folder_of (path, fresh));
done:
    if (fresh && !moved) remove (fresh);
    pg_free (fresh);
    return status;
}

pg_status pg_checkpoint_read (const char *path, pg_keep walk, void *context)
{
    pg_status status = PG_OK;
    checkpoint c = { .path = path, .reading = 1 };
    PG_TRY (pg_netcdf_check_header (path));
    NC_TRY (path, nc_open (path, NC_NOWRITE, &c.ncid));
    c.open = 1;
    PG_TRY (make_walk (&c, walk, context));
done:
    if (c.open) nc_close (c.ncid);
    return status;
}
