/* SPDX-License-Identifier: GPL-3.0-or-later
 * checkpoint.nc: what a run must remember in order to continue with the same bits. Each named
 * array that is passed to the keeper (pg_keeper, base.h) becomes one variable of a netCDF file in
 * the CDF-5 variant of the classic format (doubles, 64-bit integers, bytes).
 *
 * The last variable, `checksum`, is a 64-bit FNV-1a hash over the names, types, lengths and
 * values of all others. It is compared before any value is used, and tells a whole file from
 * one that was cut off or changed. A checkpoint is trusted to restore the state of a run
 * exactly; a wrong value would otherwise go unnoticed. */
#include "disk.h"
#include "netcdf_write.h"
#include <errno.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

/* Message for a checkpoint whose checksum is right but whose variables are not those expected. */
#define OTHER_VERSION "another version of the program wrote it, and only that one can continue the run"

/* A checkpoint that is being written (to) or read (from; keeper.reading is then 1). defining: 1 during the
 * first pass, which defines the variables and writes no values; sum: the checksum so far. */
struct pg_checkpoint {
    char          *path;
    netcdf_writer *to;
    pg_netcdf     *from;
    pg_keeper keeper;
    int       defining;
    uint64_t  sum;
};
typedef struct pg_checkpoint checkpoint;

/* Bytes of one value. */
static size_t size_of (int type) { return type == PG_NC_BYTE ? 1 : 8; }

/* Adds name, length and type of a variable to the checksum. */
static void sum_head (checkpoint *c, const char *name, size_t n, int type)
{
    const uint64_t head[2] = { (uint64_t) n, (uint64_t) type };
    c->sum = pg_fingerprint (pg_fingerprint (c->sum, name, strlen (name) + 1), head, sizeof head);
}

/* Defines a variable. Variables of equal length share one dimension, named after the length. */
static void define (checkpoint *c, const char *name, size_t n, int type)
{
    char length[40];
    snprintf (length, sizeof length, "length_%zu", n);
    int dim = netcdf_dimension_of (c->to, length);
    if (dim < 0) dim = netcdf_define_dimension (c->to, length, n);
    netcdf_define_variable (c->to, name, type, 1, &dim);
}

/* Finds the variable of a name; PG_E_FILE if its length or type is not the expected one. */
static pg_status find (const checkpoint *c, const char *name, size_t n, int type, int *var)
{
    pg_status status = PG_OK;
    pg_netcdf_variable about;
    *var = pg_netcdf_find (c->from, name);
    if (*var < 0) PG_FAIL (PG_E_FILE, "%s lacks '%s': " OTHER_VERSION, c->path, name);
    pg_netcdf_about (c->from, *var, &about);
    size_t m = about.ndim == 1 ? about.n : 0;
    if (m != n || about.type != type)
        PG_FAIL (PG_E_FILE, "%s: '%s' has %zu values, not %zu: " OTHER_VERSION, c->path, name, m, n);
done:
    return status;
}

/* Reads n values of a variable from value `first` on, in memory as in the file: double, long or char. */
static pg_status get (const checkpoint *c, int var, int type, size_t first, size_t n, void *value)
{
    switch (type) {
    case PG_NC_DOUBLE: return pg_netcdf_doubles (c->from, var, first, n, value);
    case PG_NC_INT64: return pg_netcdf_longs (c->from, var, first, n, value);
    default: return pg_netcdf_chars (c->from, var, first, n, value);
    }
}

/* Defines, writes or reads one named array of the checkpoint, depending on the pass. While
 * writing, the checksum grows with each array in its order; while reading it has been compared
 * before. Empty arrays are left out, because a dimension of length 0 would mean
 * "unlimited" to netCDF. */
static pg_status keep (checkpoint *c, const char *name, size_t n, int type, void *value)
{
    pg_status status = PG_OK;
    int var;
    if (n == 0) goto done;                             /* netCDF knows no empty dimension */
    if (c->defining) {
        define (c, name, n, type);
        goto done;
    }
    if (c->keeper.reading) {
        PG_TRY (find (c, name, n, type, &var));
        PG_TRY (get (c, var, type, 0, n, value));
        goto done;
    }
    PG_TRY (netcdf_put (c->to, netcdf_variable_of (c->to, name), 0, n, value));
    sum_head (c, name, n, type);
    c->sum = pg_fingerprint (c->sum, value, n * size_of (type));
done:
    return status;
}

/* The three functions that a keeper offers, for doubles, counts and bytes. The format has a 64-bit integer
 * type; `long` is the same on all systems that this library supports. */
_Static_assert (sizeof (long) == sizeof (int64_t), "counts are kept as 64-bit integers");
static pg_status keep_numbers (void *c, const char *name, size_t n, double *value)
{
    return keep (c, name, n, PG_NC_DOUBLE, value);
}
static pg_status keep_counts (void *c, const char *name, size_t n, long *value)
{
    return keep (c, name, n, PG_NC_INT64, value);
}
static pg_status keep_bytes (void *c, const char *name, size_t n, void *value)
{
    return keep (c, name, n, PG_NC_BYTE, value);
}
static pg_keeper keeper_of (checkpoint *c, int reading)
{
    return (pg_keeper) { c, reading, keep_numbers, keep_counts, keep_bytes };
}

/* Adds a variable of the file, read in pieces of 8192 values, to the checksum. */
static pg_status sum_variable (checkpoint *c, int var)
{
    pg_status status = PG_OK;
    enum { PIECE = 1 << 13 };
    uint64_t part[PIECE];
    pg_netcdf_variable v;
    pg_netcdf_about (c->from, var, &v);
    if (v.ndim != 1 || (v.type != PG_NC_BYTE && v.type != PG_NC_DOUBLE && v.type != PG_NC_INT64))
        PG_FAIL (PG_E_FILE, "%s: '%s' is none of a checkpoint", c->path, v.name);
    sum_head (c, v.name, v.n, v.type);
    for (size_t from = 0; from < v.n; from += PIECE) {
        size_t count = v.n - from < PIECE ? v.n - from : PIECE;
        PG_TRY (get (c, var, v.type, from, count, part));
        c->sum = pg_fingerprint (c->sum, part, count * size_of (v.type));
    }
done:
    return status;
}

/* PG_E_FILE unless the last variable is the checksum of all those before it, in their order in
 * the file. */
static pg_status check_sum (checkpoint *c)
{
    pg_status status = PG_OK;
    int n = (int) pg_netcdf_variables (c->from), last = pg_netcdf_find (c->from, "checksum");
    c->sum = PG_FINGERPRINT;
    long found = 0;
    if (last < 0 || last != n - 1)
        PG_FAIL (PG_E_FILE, "%s is no checkpoint, or not complete: it has no checksum", c->path);
    PG_TRY (find (c, "checksum", 1, PG_NC_INT64, &last));
    for (int var = 0; var < last; var++) PG_TRY (sum_variable (c, var));
    PG_TRY (pg_netcdf_longs (c->from, last, 0, 1, &found));
    if (found != (long) c->sum)
        PG_FAIL (PG_E_FILE,
                 "%s is damaged or cut off: its checksum is not that of its values; start anew with --force",
                 c->path);
done:
    return status;
}

/* One pass over all arrays: calls `walk` with a new checksum, which becomes the last variable. */
static pg_status make_walk (checkpoint *c, pg_keep walk, void *context)
{
    pg_status status = PG_OK;
    c->sum = PG_FINGERPRINT;
    PG_TRY (walk (context, &c->keeper));
    long sum = (long) c->sum;
    PG_TRY (keep_counts (c, "checksum", 1, &sum));
done:
    return status;
}

/* Writes the whole file and syncs it: first all definitions, then all values, in the order of
 * the format. */
static pg_status write_file (char *path, pg_keep walk, void *context)
{
    pg_status status = PG_OK;
    checkpoint c = { .path = path, .defining = 1 };
    c.keeper = keeper_of (&c, 0);
    PG_TRY (netcdf_create (&c.to, path, 5));
    PG_TRY (make_walk (&c, walk, context));
    PG_TRY (netcdf_end_header (c.to));
    c.defining = 0;
    PG_TRY (make_walk (&c, walk, context));
    PG_TRY (netcdf_finish (&c.to));
    PG_TRY (pg_file_sync (path));
done:
    netcdf_abandon (&c.to);
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
    return pg_file_sync (work);
}

/* A run that is killed here leaves PATH.new at worst; the checkpoint before it stays valid.
 * Syncing the folder makes sure that the rename itself survives a power failure. */
pg_status pg_checkpoint_write (const char *path, pg_keep walk, void *context)
{
    pg_status status = PG_OK;
    PG_TRY (pg_checkpoint_prepare (path, walk, context));
    PG_TRY (pg_checkpoint_commit (path));
done:
    return status;
}

pg_status pg_checkpoint_prepare (const char *path, pg_keep walk, void *context)
{
    pg_status status = PG_OK;
    char *fresh = NULL;
    PG_TRY (pg_disk_fresh (&fresh, path));
    status = write_file (fresh, walk, context);
    if (status != PG_OK) remove (fresh);
done:
    pg_free (fresh);
    return status;
}

pg_status pg_checkpoint_commit (const char *path)
{
    pg_status status = PG_OK;
    char *fresh = NULL;
    PG_TRY (pg_disk_fresh (&fresh, path));
    if (rename (fresh, path) != 0) {
        status = pg_error (PG_E_FILE, PG_HERE, "%s: %s", path, strerror (errno));
        remove (fresh);
        goto done;
    }
    PG_TRY (sync_folder_of (path, fresh));
done:
    pg_free (fresh);
    return status;
}

void pg_checkpoint_drop (const char *path)
{
    char *fresh = NULL;
    if (pg_disk_fresh (&fresh, path) == PG_OK) remove (fresh);
    pg_free (fresh);
}

pg_status pg_checkpoint_open (pg_checkpoint **out, const char *path)
{
    pg_status status = PG_OK;
    checkpoint *c = NULL;
    PG_ALLOC (c, 1);
    PG_ALLOC (c->path, strlen (path) + 1);
    strcpy (c->path, path);
    c->keeper = keeper_of (c, 1);
    PG_TRY (pg_netcdf_open (&c->from, path));
    *out = c, c = NULL;
done:
    pg_checkpoint_close (&c);
    return status;
}

const pg_keeper *pg_checkpoint_keeper (const pg_checkpoint *c) { return &c->keeper; }

size_t pg_checkpoint_length (const pg_checkpoint *c, const char *name)
{
    pg_netcdf_variable about;
    int var = pg_netcdf_find (c->from, name);
    if (var < 0) return 0;
    pg_netcdf_about (c->from, var, &about);
    return about.ndim == 1 ? about.n : 0;
}

void pg_checkpoint_close (pg_checkpoint **file)
{
    checkpoint *c = *file;
    if (!c) return;
    pg_netcdf_close (&c->from);
    pg_free (c->path);
    pg_free (c);
    *file = NULL;
}

/* The header is checked first, then the checksum, and only then are values handed out. */
pg_status pg_checkpoint_read (const char *path, pg_keep walk, void *context)
{
    pg_status status = PG_OK;
    checkpoint *c = NULL;
    PG_TRY (pg_checkpoint_open (&c, path));
    PG_TRY (check_sum (c));
    PG_TRY (walk (context, &c->keeper));
done:
    pg_checkpoint_close (&c);
    return status;
}
