/* SPDX-License-Identifier: GPL-3.0-or-later
 * Checks the header of classic netCDF files by the published grammar of the format: lists of dimensions,
 * attributes and variables. The netCDF library trusts the counts in a header, so that a few changed bytes
 * could make it ask for gigabytes; here every count must fit into the bytes that are left. */
#include "format.h"
#include <errno.h>
#include <fcntl.h>
#include <stdint.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

/* Tags of the lists; most dimensions of a variable. */
enum { DIMENSION = 10, VARIABLE = 11, ATTRIBUTE = 12, MOST_DIMENSIONS = 1024 };
/* The header; at: next byte; ndim: number of dimensions; kind: version of the format (1, 2, 5). */
typedef struct { const unsigned char *text; size_t size, at, ndim; int kind; } walker;

/* A whole number of that many bytes, high byte first; 0: the file ends before. */
static int whole (walker *w, size_t bytes, uint64_t *value)
{
    if (w->size - w->at < bytes) return 0;
    *value = 0;
    for (size_t k = 0; k < bytes; k++) *value = *value << 8 | w->text[w->at + k];
    w->at += bytes;
    return 1;
}

/* A count of things of at least `least` bytes each, which the rest of the file can hold. */
static int count (walker *w, size_t least, uint64_t *n)
{
    return whole (w, w->kind == 5 ? 8 : 4, n) && *n <= (w->size - w->at) / least;
}

/* Skips bytes, padded to a multiple of four. */
static int skip (walker *w, uint64_t bytes)
{
    uint64_t padded = (bytes + 3) / 4 * 4;
    if (padded > w->size - w->at) return 0;
    w->at += padded;
    return 1;
}

/* A name: length and letters. */
static int name (walker *w)
{
    uint64_t n;
    return count (w, 1, &n) && n > 0 && n <= 256 && !memchr (w->text + w->at, 0, n) && skip (w, n);
}

/* A type of values, and the size of one. */
static int type (walker *w, size_t *bytes)
{
    /* Bytes of the types 1 to 11 of the format; those from 7 on exist in version 5 only. */
    static const unsigned char size[] = { 0, 1, 1, 2, 4, 4, 8, 1, 2, 4, 8, 8 };
    uint64_t t;
    if (!whole (w, 4, &t) || t < 1 || t > (w->kind == 5 ? 11 : 6)) return 0;
    *bytes = size[t];
    return 1;
}

/* The head of a list: its tag and count, or zeros where there is none. least: bytes of an item, at least. */
static int list (walker *w, uint64_t tag, size_t least, uint64_t *n)
{
    uint64_t got;
    return whole (w, 4, &got) && count (w, least, n) && (got == tag || (got == 0 && *n == 0));
}

/* A list of attributes; then of dimensions. */
static int attributes (walker *w)
{
    uint64_t n, values;
    size_t bytes;
    if (!list (w, ATTRIBUTE, 12, &n)) return 0;
    for (; n > 0; n--)
        if (!name (w) || !type (w, &bytes) || !count (w, bytes, &values) || !skip (w, values * bytes))
            return 0;
    return 1;
}

static int dimensions (walker *w)
{
    uint64_t n, length;
    if (!list (w, DIMENSION, 8, &n)) return 0;
    /* Variables refer to dimensions by number. */
    for (w->ndim = n; n > 0; n--)
        if (!name (w) || !whole (w, w->kind == 5 ? 8 : 4, &length) || length >> 62) return 0;
    return 1;
}

/* One variable: name, dimensions, attributes, type, size, offset. */
static int variable (walker *w)
{
    uint64_t n, id, bytes, begin;
    size_t size;
    if (!name (w) || !count (w, 4, &n) || n > MOST_DIMENSIONS) return 0;
    /* Dimensions of the variable, by number. */
    for (; n > 0; n--) if (!whole (w, w->kind == 5 ? 8 : 4, &id) || id >= w->ndim) return 0;
    return attributes (w) && type (w, &size) && whole (w, w->kind == 5 ? 8 : 4, &bytes)
           && whole (w, w->kind == 1 ? 4 : 8, &begin) && !(begin >> 62);
}

/* The whole header. */
static int header (walker *w)
{
    uint64_t n;
    if (!whole (w, w->kind == 5 ? 8 : 4, &n) || !dimensions (w) || !attributes (w)
        || !list (w, VARIABLE, 24, &n))
        return 0;
    for (; n > 0; n--) if (!variable (w)) return 0;
    return 1;
}

/* Files that are no classic netCDF have no such header and pass. */
pg_status mesh_netcdf_check_header (const mesh_file *file)
{
    walker w = { .text = (const unsigned char *) file->text, .size = file->size, .at = 4 };
    if (file->size < 4 || memcmp (file->text, "CDF", 3)) return PG_OK;
    w.kind = file->text[3];
    return header (&w)
               ? PG_OK
               : pg_error (
                   PG_E_FILE, PG_HERE,
                   "%.400s: the header of this netCDF file is broken near byte %zu: it was cut or changed",
                   file->path, w.at);
}

/* The file is mapped into memory: of a result of gigabytes only the pages of the header are read. */
pg_status pg_netcdf_check_header (const char *path)
{
    pg_status status = PG_OK;
    struct stat about;
    void *text = MAP_FAILED;
    int file = open (path, O_RDONLY | O_NONBLOCK);
    if (file < 0 || fstat (file, &about) != 0) PG_FAIL (PG_E_FILE, "%.400s: %s", path, strerror (errno));
    if (!S_ISREG (about.st_mode)) PG_FAIL (PG_E_FILE, "%.400s: is no file", path);
    if (about.st_size == 0) PG_FAIL (PG_E_FILE, "%.400s: is empty", path);
    text = mmap (NULL, (size_t) about.st_size, PROT_READ, MAP_PRIVATE, file, 0);
    if (text == MAP_FAILED) PG_FAIL (PG_E_FILE, "%.400s: %s", path, strerror (errno));
    PG_TRY (mesh_netcdf_check_header (&(mesh_file) { path, text, (size_t) about.st_size }));
done:
    if (text != MAP_FAILED) munmap (text, (size_t) about.st_size);
    if (file >= 0) close (file);
    return status;
}
