/* SPDX-License-Identifier: GPL-3.0-or-later
 * checkpoint.nc: what a run must remember in order to continue with the same bits. Each name
 * that the keeper is given becomes one variable of a netCDF file in the CDF-5 variant of the
 * classic format (doubles, 64-bit integers, bytes).
 *
 * The last variable, `checksum`, is a 64-bit FNV-1a hash over the names, types, lengths and
 * values of all others. It is compared before any value is used, and tells a whole file from
 * one that was cut off or changed. A checkpoint is trusted to restore the state of a run
 * exactly; a wrong value would otherwise go unnoticed. */
#include "disk.h"
#include "exodus.h"
#include "perigal/mesh_files.h"
#include <errno.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

/* What a checkpoint whose sum is right, but whose pieces are others, must be. */
#define OTHER_VERSION "another version of the program wrote it, and only that one can continue the run"

/* A checkpoint that is being written or read. open: the netCDF file is open; defining: this
 * visit defines variables and writes nothing yet; sum: the hash so far. */
typedef struct { const char *path; int ncid, open, defining, reading; uint64_t sum; } checkpoint;

/* Bytes of one value. */
static size_t size_of (nc_type type) { return type == NC_BYTE ? 1 : 8; }

/* Adds name, length and type of a variable to the sum. */
static void sum_head (checkpoint *c, const char *name, size_t n, nc_type type)
{
    const uint64_t head[2] = { (uint64_t) n, (uint64_t) type };
    c->sum = pg_fingerprint (pg_fingerprint (c->sum, name, strlen (name) + 1), head, sizeof head);
}

/* Defines a variable. Variables of equal length share one dimension, named after the length.
 * PG_E_USAGE: the same name twice. */
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

/* Finds the variable of a name; PG_E_FILE if its length or type is not the expected one. */
static pg_status find (const checkpoint *c, const char *name, size_t n, nc_type type, int *var)
{
    pg_status status = PG_OK;
    nc_type found;
    int ndim, dim[NC_MAX_VAR_DIMS];
    size_t m = 0;
    if (nc_inq_varid (c->ncid, name, var) != NC_NOERR)
        PG_FAIL (PG_E_FILE, "%s lacks '%s': " OTHER_VERSION, c->path, name);
    NC_TRY (c->path, nc_inq_var (c->ncid, *var, NULL, &found, &ndim, dim, NULL));
    if (ndim == 1) NC_TRY (c->path, nc_inq_dimlen (c->ncid, dim[0], &m));
    if (m != n || found != type)
        PG_FAIL (PG_E_FILE, "%s: '%s' has %zu values, not %zu: " OTHER_VERSION, c->path, name, m, n);
done:
    return status;
}

/* One piece of the checkpoint: defines it, writes it or reads it, depending on the visit.
 * While writing, the sum grows with each piece in its order; while reading it has been
 * compared before. Empty arrays are left out, because a dimension of length 0 would mean
 * "unlimited" to netCDF. */
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

/* The three functions that a keeper offers, for doubles, counts and bytes. */
/* netCDF has a 64-bit integer type but no `long`; the two are the same on all systems that
 * this library supports. */
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

/* Adds a variable of the file to the sum, read in pieces of 64 KiB. */
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

/* PG_E_FILE unless the last variable is the checksum of all those before it, in their order in
 * the file. */
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
                 "%s is damaged or cut off: its checksum is not that of its values; start anew with --force",
                 c->path);
done:
    return status;
}

/* One visit of everything, which starts the sum anew. When reading, the checksum is compared
 * first; when writing, it becomes the last variable. */
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

/* Writes the whole file and syncs it: first all definitions, then all values, as netCDF
 * demands. It is created by our own function first, whose message says why that fails;
 * nc__create then truncates it. 1 MiB of buffer keeps the number of system calls small. */
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

/* Syncs the folder of a path, so that the new name of the file is on the disk too. work:
 * strlen (path) + 1 bytes. */
static pg_status sync_folder_of (const char *path, char *work)
{
    const char *slash = strrchr (path, '/');
    size_t n = slash == path ? 1 : slash ? (size_t) (slash - path) : 1;
    memcpy (work, slash ? path : ".", n);
    work[n] = 0;
    return pg_disk_sync (work);
}

/* A run that is killed here leaves PATH.new at worst; the checkpoint before it stays valid.
 * Syncing the folder makes sure that the rename itself survives a power failure. */
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

/* The header is checked before netCDF opens the file, then the checksum, and only then are
 * values handed out. */
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
