/* SPDX-License-Identifier: GPL-3.0-or-later
 * Opens netCDF files, finds dimensions, variables and attributes by name and converts their values. A file is
 * mapped, not read: of a result of gigabytes only the pages that are used come from the disk. */
#include "file.h"
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

/* 1 for classic files. */
static int is_classic (const unsigned char *bytes, size_t size)
{
    return size >= 4 && memcmp (bytes, "CDF", 3) == 0 && (bytes[3] == 1 || bytes[3] == 2 || bytes[3] == 5);
}

/* 1 for files of netCDF-4: the signature of HDF5 at the beginning. */
static int is_hdf5 (const unsigned char *bytes, size_t size)
{
    return size >= 8 && memcmp (bytes, "\x89HDF\r\n\x1a\n", 8) == 0;
}

/* Parses a file whose bytes are in memory, as classic netCDF or netCDF-4 by its signature. */
static pg_status recognise (pg_netcdf *f)
{
    if (is_classic (f->bytes, f->size)) return nc_classic_parse (f);
    if (is_hdf5 (f->bytes, f->size)) return nc_library_open (f);
    return pg_error (PG_E_FILE, PG_HERE, "%.400s: is no netCDF file", f->path);
}

pg_status pg_netcdf_parse (pg_netcdf **out, const char *path, const void *bytes, size_t size)
{
    pg_status status = PG_OK;
    pg_netcdf *f = NULL;
    *out = NULL;
    PG_ALLOC (f, 1);
    f->id = -1;
    f->bytes = bytes, f->size = size;
    f->path = pg_strdup (path);
    if (!f->path) PG_FAIL (PG_E_MEMORY, "no memory for a path");
    PG_TRY (recognise (f));
    *out = f;
    f = NULL;
done:
    pg_netcdf_close (&f);
    return status;
}

/* A pipe would make `open` wait, therefore O_NONBLOCK. The mapping outlives the file descriptor. */
pg_status pg_netcdf_open (pg_netcdf **out, const char *path)
{
    pg_status status = PG_OK;
    struct stat about;
    void *bytes = MAP_FAILED;
    *out = NULL;
    int file = open (path, O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    if (file < 0 || fstat (file, &about) != 0) PG_FAIL (PG_E_FILE, "%.400s: %s", path, strerror (errno));
    if (!S_ISREG (about.st_mode)) PG_FAIL (PG_E_FILE, "%.400s: is no file", path);
    if (about.st_size == 0) PG_FAIL (PG_E_FILE, "%.400s: is empty", path);
    bytes = mmap (NULL, (size_t) about.st_size, PROT_READ, MAP_PRIVATE, file, 0);
    if (bytes == MAP_FAILED) PG_FAIL (PG_E_FILE, "%.400s: %s", path, strerror (errno));
    PG_TRY (pg_netcdf_parse (out, path, bytes, (size_t) about.st_size));
    (*out)->mapped = 1;
    bytes = MAP_FAILED;
done:
    if (bytes != MAP_FAILED) munmap (bytes, (size_t) about.st_size);
    if (file >= 0) close (file);
    return status;
}

void pg_netcdf_close (pg_netcdf **file)
{
    pg_netcdf *f = *file;
    if (!f) return;
    if (f->id >= 0) nc_library_close (f);
    /* the cast removes const: munmap takes a non-const pointer */
    if (f->mapped) munmap ((void *) (uintptr_t) f->bytes, f->size);
    pg_free (f->dim), pg_free (f->var), pg_free (f->att), pg_free (f->path);
    pg_free (f);
    *file = NULL;
}

/* ---- by name ------------------------------------------------------------------------------------------- */
size_t pg_netcdf_length (const pg_netcdf *file, const char *dimension)
{
    for (size_t k = 0; k < file->ndim; k++)
        if (strcmp (file->dim[k].name, dimension) == 0) return file->dim[k].length;
    return 0;
}

size_t pg_netcdf_variables (const pg_netcdf *file) { return file->nvar; }

int pg_netcdf_find (const pg_netcdf *file, const char *name)
{
    for (size_t k = 0; k < file->nvar; k++)
        if (strcmp (file->var[k].about.name, name) == 0) return (int) k;
    return -1;
}

void pg_netcdf_about (const pg_netcdf *file, int variable, pg_netcdf_variable *about)
{
    *about = file->var[variable].about;
}

/* The attribute of that name; NULL: there is none. */
static const nc_attribute *attribute (const pg_netcdf *f, int variable, const char *name)
{
    for (size_t k = 0; k < f->natt; k++)
        if (f->att[k].variable == variable && strcmp (f->att[k].name, name) == 0) return &f->att[k];
    return NULL;
}

/* ---- values -------------------------------------------------------------------------------------------- */
/* The bits of a value of `bytes` bytes, high byte first. */
static uint64_t bits_at (const unsigned char *at, size_t bytes)
{
    uint64_t bits = 0;
    for (size_t k = 0; k < bytes; k++) bits = bits << 8 | at[k];
    return bits;
}

/* One value as a double. */
static double double_at (const unsigned char *at, int type)
{
    uint64_t bits = bits_at (at, nc_size_of (type));
    uint32_t half = (uint32_t) bits;
    double d;
    float s;
    switch (type) {
    case PG_NC_BYTE: return (int8_t) bits;
    case PG_NC_SHORT: return (int16_t) bits;
    case PG_NC_INT: return (int32_t) bits;
    case PG_NC_INT64: return (double) (int64_t) bits;
    case PG_NC_FLOAT: memcpy (&s, &half, sizeof s); return (double) s;
    case PG_NC_DOUBLE: memcpy (&d, &bits, sizeof d); return d;
    default: return (double) bits;
    }
}

/* One value as a whole number; 0: it does not fit. */
static int long_at (const unsigned char *at, int type, long *value)
{
    uint64_t bits = bits_at (at, nc_size_of (type));
    double d;
    switch (type) {
    case PG_NC_BYTE: *value = (int8_t) bits; return 1;
    case PG_NC_SHORT: *value = (int16_t) bits; return 1;
    case PG_NC_INT: *value = (int32_t) bits; return 1;
    case PG_NC_INT64: *value = (long) (int64_t) bits; return 1;
    case PG_NC_FLOAT:
    case PG_NC_DOUBLE:
        d = double_at (at, type);
        *value = d > -9e18 && d < 9e18 ? (long) d : 0;
        return d > -9e18 && d < 9e18;
    default: *value = (long) bits; return bits <= LONG_MAX;
    }
}

/* Reverses the bytes of each of n values of 4 or 8 bytes in place if the machine is little-endian. */
void pg_netcdf_swap (void *value, size_t n, size_t size)
{
#if __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__
    for (size_t i = 0; size == 8 && i < n; i++) {
        uint64_t wide;
        memcpy (&wide, (char *) value + 8 * i, 8);
        wide = __builtin_bswap64 (wide);
        memcpy ((char *) value + 8 * i, &wide, 8);
    }
    for (size_t i = 0; size == 4 && i < n; i++) {
        uint32_t half;
        memcpy (&half, (char *) value + 4 * i, 4);
        half = __builtin_bswap32 (half);
        memcpy ((char *) value + 4 * i, &half, 4);
    }
#else
    (void) value, (void) n, (void) size;
#endif
}

/* Converts n contiguous values from a netCDF type into the array `to`; 0: one of them does not fit. */
typedef int converting (const unsigned char *at, int type, size_t n, void *to);

static int to_doubles (const unsigned char *at, int type, size_t n, void *to)
{
    double *value = to;
    size_t size = nc_size_of (type);
    if (type == PG_NC_DOUBLE) pg_netcdf_swap (memcpy (value, at, n * size), n, size);
    else for (size_t i = 0; i < n; i++) value[i] = double_at (at + i * size, type);
    return 1;
}

static int to_longs (const unsigned char *at, int type, size_t n, void *to)
{
    long *value = to;
    size_t size = nc_size_of (type);
    int fits = 1;
    if (type == PG_NC_INT64) pg_netcdf_swap (memcpy (value, at, n * size), n, size);
    else for (size_t i = 0; i < n && fits; i++) fits = long_at (at + i * size, type, &value[i]);
    return fits;
}

static int to_chars (const unsigned char *at, int type, size_t n, void *to)
{
    (void) type;
    memcpy (to, at, n);
    return 1;
}

/* Finds the address *at of value k of a classic variable and the number *row <= n of values that are
 * contiguous from there on (the rest of a record). PG_E_FILE: the file ends before them. */
static pg_status place (const pg_netcdf *f, const nc_variable *v, size_t k, size_t n,
                        const unsigned char **at, size_t *row)
{
    pg_status status = PG_OK;
    size_t size = nc_size_of (v->about.type), record = v->record ? k / v->per : 0, in = k - record * v->per;
    *row = v->per - in < n ? v->per - in : n;
    /* record * stride cannot overflow: it is compared with the size of the file before it is computed. */
    uint64_t from = v->begin + in * size;
    if (record > 0 && f->stride > (f->size - 1) / record) from = f->size;
    else from += record * f->stride;
    if (from > f->size || *row > (f->size - from) / size)
        PG_FAIL (PG_E_FILE, "%.400s: '%s' lies behind the end of the file: it was cut off", f->path,
                 v->about.name);
    *at = f->bytes + from;
done:
    return status;
}

/* PG_E_FILE unless values first .. first + n - 1 exist and are text (text 1) or numbers (text 0). */
static pg_status check_range (const pg_netcdf *f, int variable, size_t first, size_t n, int text)
{
    pg_status status = PG_OK;
    const nc_variable *v = &f->var[variable];
    int is_text = v->about.type == PG_NC_CHAR, bytes = v->about.type == PG_NC_BYTE;
    if (text ? !is_text && !bytes : is_text)
        PG_FAIL (PG_E_FILE, "%.400s: '%s' holds %s", f->path, v->about.name, text ? "no text" : "text");
    if (first > v->about.n || n > v->about.n - first)
        PG_FAIL (PG_E_FILE, "%.400s: '%s' has %zu values", f->path, v->about.name, v->about.n);
done:
    return status;
}

/* Reads n values of a classic variable from value `first` on by the converter to_those, which makes `bytes`
 * bytes of each. The range has been checked. */
static pg_status convert (const pg_netcdf *file, int variable, size_t first, size_t n, converting *to_those,
                          size_t bytes, void *value)
{
    pg_status status = PG_OK;
    const unsigned char *at = NULL;
    const nc_variable *v = &file->var[variable];
    size_t row;
    for (size_t k = 0; k < n; k += row) {
        PG_TRY (place (file, v, first + k, n - k, &at, &row));
        if (!to_those (at, v->about.type, row, (char *) value + k * bytes))
            PG_FAIL (PG_E_FILE, "%.400s: '%s' has values too large for a whole number", file->path,
                     v->about.name);
    }
done:
    return status;
}

pg_status pg_netcdf_doubles (const pg_netcdf *file, int variable, size_t first, size_t n, double *value)
{
    pg_status status = check_range (file, variable, first, n, 0);
    if (status != PG_OK) return status;
    if (!file->version) return nc_library_doubles (file, variable, first, n, value);
    return convert (file, variable, first, n, to_doubles, sizeof *value, value);
}

pg_status pg_netcdf_longs (const pg_netcdf *file, int variable, size_t first, size_t n, long *value)
{
    pg_status status = check_range (file, variable, first, n, 0);
    if (status != PG_OK) return status;
    if (!file->version) return nc_library_longs (file, variable, first, n, value);
    return convert (file, variable, first, n, to_longs, sizeof *value, value);
}

pg_status pg_netcdf_chars (const pg_netcdf *file, int variable, size_t first, size_t n, char *value)
{
    pg_status status = check_range (file, variable, first, n, 1);
    if (status != PG_OK) return status;
    if (!file->version) return nc_library_chars (file, variable, first, n, value);
    return convert (file, variable, first, n, to_chars, sizeof *value, value);
}

/* ---- attributes ---------------------------------------------------------------------------------------- */
int pg_netcdf_text (const pg_netcdf *file, int variable, const char *name, char *text, size_t size)
{
    const nc_attribute *a = attribute (file, variable, name);
    if (!a || a->type != PG_NC_CHAR || a->n >= size) return 0;
    if (!file->version && !nc_library_text (file, a, text)) return 0;
    if (file->version) memcpy (text, file->bytes + a->at, a->n);
    text[a->n] = 0;
    return 1;
}

int pg_netcdf_numbers (const pg_netcdf *file, int variable, const char *name, size_t n, double *value)
{
    const nc_attribute *a = attribute (file, variable, name);
    if (!a || a->type == PG_NC_CHAR || a->n != n) return 0;
    if (!file->version) return nc_library_numbers (file, a, value);
    size_t size = nc_size_of (a->type);
    for (size_t k = 0; k < n; k++) value[k] = double_at (file->bytes + a->at + k * size, a->type);
    return 1;
}
