/* SPDX-License-Identifier: GPL-3.0-or-later
 * Classic netCDF files by the published layout ("NetCDF Classic Format Specification", Unidata): the header,
 * then the variables without records one behind the other, each padded to a multiple of four bytes; the
 * records begin where they end. All numbers have the most significant byte first.
 *
 * The header is built in memory twice: its length does not depend on the offsets in it, so that the first
 * pass finds where the values begin. Values are converted into a buffer, which is written when it is full or
 * when the next values belong elsewhere: a checkpoint of a hundred small variables costs one system call. */
#include "netcdf_write.h"
#include "disk.h"
#include <stdint.h>
#include <string.h>
#include <unistd.h>

/* Tags of the lists of the header; bytes that are collected before they are written. */
enum { DIMENSION = 10, VARIABLE = 11, ATTRIBUTE = 12, BUFFER = 1 << 20 };

/* A growing array of bytes: n are used, room are allocated. */
typedef struct { unsigned char *data; size_t n, room; } bytes;
/* A dimension, with its name. */
typedef struct { char name[PG_NC_NAME + 1]; size_t length; } dimension;
/* A list of n attributes, encoded as it will stand in the header. */
typedef struct { size_t n; bytes text; } attributes;
/* A variable. record: 1 if it has the record dimension; n, size: number and padded bytes of its values (of
 * one record if it has records); begin: offset of its first byte in the file. */
typedef struct {
    char       name[PG_NC_NAME + 1];
    int        type, record;
    size_t     ndim, n;
    int        dim[4];
    uint64_t   size, begin;
    attributes own;
} stored;

struct netcdf_writer {
    char   *path;
    int     file, version;
    /* First fault while something was defined. */
    pg_status status;
    size_t  ndim, nvar, dim_room, var_room;
    dimension *dim;
    stored *var;
    attributes all;
    /* Offset in the file at which the records begin. */
    uint64_t records;
    /* Values not yet written (fill bytes), and the offset in the file to which they belong. */
    unsigned char *buffer;
    size_t   fill;
    uint64_t at;
    /* Offset behind the last byte that has been written. */
    uint64_t top;
};

/* Bytes of one value; 0 for types that are not written. */
static size_t size_of (int type)
{
    switch (type) {
    case PG_NC_BYTE: case PG_NC_CHAR: return 1;
    case PG_NC_INT: case PG_NC_FLOAT: return 4;
    case PG_NC_DOUBLE: case PG_NC_INT64: return 8;
    default: return 0;
    }
}

/* ---- bytes of the header ------------------------------------------------------------------------------- */
/* Appends m bytes, and zeros up to a multiple of four. */
static void append (netcdf_writer *w, bytes *b, const void *data, size_t m)
{
    pg_status status = PG_OK;
    size_t padded = (m + 3) / 4 * 4;
    if (w->status != PG_OK) return;
    PG_GROW (b->data, b->room, b->n + padded);
    memset (b->data + b->n, 0, padded);
    memcpy (b->data + b->n, data, m);
    b->n += padded;
done:
    w->status = status;
}

/* Appends an integer of m bytes, the most significant byte first. */
static void append_whole (netcdf_writer *w, bytes *b, uint64_t value, size_t m)
{
    unsigned char text[8];
    for (size_t k = 0; k < m; k++) text[m - 1 - k] = (unsigned char) (value >> (8 * k));
    append (w, b, text, m);
}

/* Appends a count or a length: 8 bytes in version 5, otherwise 4. */
static void append_count (netcdf_writer *w, bytes *b, uint64_t value)
{
    append_whole (w, b, value, w->version == 5 ? 8 : 4);
}

static void append_name (netcdf_writer *w, bytes *b, const char *name)
{
    append_count (w, b, strlen (name));
    append (w, b, name, strlen (name));
}

/* ---- definitions --------------------------------------------------------------------------------------- */
pg_status netcdf_create (netcdf_writer **out, const char *path, int version)
{
    pg_status status = PG_OK;
    netcdf_writer *w = NULL;
    *out = NULL;
    PG_ALLOC (w, 1);
    w->file = -1, w->version = version;
    w->path = pg_strdup (path);
    if (!w->path) PG_FAIL (PG_E_MEMORY, "no memory for a path");
    PG_ALLOC (w->buffer, BUFFER);
    PG_TRY (pg_disk_create (path, &w->file));
    *out = w;
    w = NULL;
done:
    netcdf_abandon (&w);
    return status;
}

int netcdf_dimension_of (const netcdf_writer *w, const char *name)
{
    for (size_t k = 0; k < w->ndim; k++) if (strcmp (w->dim[k].name, name) == 0) return (int) k;
    return -1;
}

int netcdf_variable_of (const netcdf_writer *w, const char *name)
{
    for (size_t k = 0; k < w->nvar; k++) if (strcmp (w->var[k].name, name) == 0) return (int) k;
    return -1;
}

/* Stores the status of a failed definition in w->status unless an earlier one has failed. */
static void keep (netcdf_writer *w, pg_status status) { if (w->status == PG_OK) w->status = status; }

/* Copies a name to `out`. PG_E_USAGE: it is empty, too long, or in use already (known >= 0). */
static pg_status take_name (netcdf_writer *w, const char *what, const char *name, int known, char *out)
{
    pg_status status = PG_OK;
    if (known >= 0 || !name[0] || strlen (name) > PG_NC_NAME)
        PG_FAIL (PG_E_USAGE, "%s: %s '%.60s' %s", w->path, what, name,
                 known >= 0 ? "is there twice" : "has a name that does not fit");
    memcpy (out, name, strlen (name) + 1);
done:
    return status;
}

int netcdf_define_dimension (netcdf_writer *w, const char *name, size_t length)
{
    pg_status status = PG_OK;
    if (w->status != PG_OK) return -1;
    PG_GROW (w->dim, w->dim_room, w->ndim + 1);
    PG_TRY (take_name (w, "dimension", name, netcdf_dimension_of (w, name), w->dim[w->ndim].name));
    if (w->version != 5 && length > 0x7fffffff)
        PG_FAIL (PG_E_LIMIT, "%s: dimension '%s' of %zu is too long", w->path, name, length);
    w->dim[w->ndim++].length = length;
done:
    keep (w, status);
    return (int) w->ndim - 1;
}

int netcdf_define_variable (netcdf_writer *w, const char *name, int type, size_t ndim, const int *dim)
{
    pg_status status = PG_OK;
    if (w->status != PG_OK) return -1;
    PG_GROW (w->var, w->var_room, w->nvar + 1);
    stored *v = &w->var[w->nvar];
    memset (v, 0, sizeof *v);
    PG_TRY (take_name (w, "variable", name, netcdf_variable_of (w, name), v->name));
    if (ndim > sizeof v->dim / sizeof *v->dim || !size_of (type))
        PG_FAIL (PG_E_USAGE, "%s: variable '%s' has %zu dimensions and type %d", w->path, name, ndim, type);
    v->type = type, v->ndim = ndim, v->n = 1;
    for (size_t k = 0; k < ndim; k++) {
        size_t length = w->dim[dim[k]].length;
        v->dim[k] = dim[k];
        if (length) v->n *= length;
        else v->record = 1;
    }
    v->size = ((uint64_t) v->n * size_of (type) + 3) / 4 * 4;
    w->nvar++;
done:
    keep (w, status);
    return (int) w->nvar - 1;
}

/* The attribute list of a variable (-1: of the file); NULL: an earlier definition has failed. */
static attributes *list_of (netcdf_writer *w, int variable)
{
    return w->status != PG_OK ? NULL : variable < 0 ? &w->all : &w->var[variable].own;
}

/* Appends the head of an attribute to a list: name, type, number of values. */
static void append_head (netcdf_writer *w, attributes *list, const char *name, int type, size_t n)
{
    list->n++;
    append_name (w, &list->text, name);
    append_whole (w, &list->text, (uint64_t) type, 4);
    append_count (w, &list->text, n);
}

void netcdf_define_text (netcdf_writer *w, int variable, const char *name, const char *text)
{
    attributes *list = list_of (w, variable);
    if (!list) return;
    append_head (w, list, name, PG_NC_CHAR, strlen (text));
    append (w, &list->text, text, strlen (text));
}

void netcdf_define_numbers (netcdf_writer *w, int variable, const char *name, int type, size_t n,
                            const void *value)
{
    attributes *list = list_of (w, variable);
    size_t size = size_of (type);
    unsigned char one[8];
    if (!list) return;
    append_head (w, list, name, type, n);
    /* the numeric types used here have 4 or 8 bytes, so that append adds no padding between values */
    for (size_t k = 0; k < n; k++) {
        memcpy (one, (const char *) value + k * size, size);
        pg_netcdf_swap (one, 1, size);
        append (w, &list->text, one, size);
    }
}

/* ---- the header ---------------------------------------------------------------------------------------- */
/* Appends the head of a list: its tag and the number of its items, two zeros if the list is empty. */
static void append_list (netcdf_writer *w, bytes *b, int tag, size_t n)
{
    append_whole (w, b, n ? (uint64_t) tag : 0, 4);
    append_count (w, b, n);
}

static void append_attributes (netcdf_writer *w, bytes *b, const attributes *list)
{
    append_list (w, b, ATTRIBUTE, list->n);
    if (list->n) append (w, b, list->text.data, list->text.n);
}

/* Appends the header entry of a variable. A size that does not fit into a count is written as all ones, by
 * the specification; readers compute it from the dimensions. */
static void append_variable (netcdf_writer *w, bytes *b, const stored *v)
{
    append_name (w, b, v->name);
    append_count (w, b, v->ndim);
    for (size_t k = 0; k < v->ndim; k++) append_count (w, b, (uint64_t) v->dim[k]);
    append_attributes (w, b, &v->own);
    append_whole (w, b, (uint64_t) v->type, 4);
    append_count (w, b, w->version != 5 && v->size > 0xfffffffcu ? 0xffffffffu : v->size);
    append_whole (w, b, v->begin, 8);
}

/* Builds the whole header in b, with a record count of 0. */
static void build (netcdf_writer *w, bytes *b)
{
    const unsigned char magic[4] = { 'C', 'D', 'F', (unsigned char) w->version };
    b->n = 0;
    append (w, b, magic, 4);
    append_count (w, b, 0);
    append_list (w, b, DIMENSION, w->ndim);
    for (size_t k = 0; k < w->ndim; k++) {
        append_name (w, b, w->dim[k].name);
        append_count (w, b, w->dim[k].length);
    }
    append_attributes (w, b, &w->all);
    append_list (w, b, VARIABLE, w->nvar);
    for (size_t k = 0; k < w->nvar; k++) append_variable (w, b, &w->var[k]);
}

/* Sets the offsets of the variables: from byte `at` on those without records, then the first record. */
static void lay_out (netcdf_writer *w, uint64_t at)
{
    for (int record = 0; record < 2; record++) {
        if (record) w->records = at;
        for (size_t k = 0; k < w->nvar; k++)
            if (w->var[k].record == record) w->var[k].begin = at, at += w->var[k].size;
    }
}

pg_status netcdf_end_header (netcdf_writer *w)
{
    pg_status status = PG_OK;
    bytes b = { 0 };
    build (w, &b);
    PG_TRY (w->status);
    lay_out (w, b.n);
    build (w, &b);
    PG_TRY (w->status);
    PG_TRY (pg_disk_write (w->path, w->file, b.data, b.n, 0));
    w->top = b.n;
done:
    pg_free (b.data);
    return status;
}

/* ---- values -------------------------------------------------------------------------------------------- */
/* Writes the buffered values to the file and empties the buffer. */
static pg_status flush (netcdf_writer *w)
{
    pg_status status = w->fill ? pg_disk_write (w->path, w->file, w->buffer, w->fill, (long) w->at) : PG_OK;
    w->at += w->fill, w->fill = 0;
    if (w->at > w->top) w->top = w->at;
    return status;
}

pg_status netcdf_put (netcdf_writer *w, int variable_number, size_t first, size_t n, const void *value)
{
    pg_status status = PG_OK;
    const stored *v = &w->var[variable_number];
    size_t size = size_of (v->type);
    uint64_t to = v->begin + first * size;
    if (v->record || first > v->n || n > v->n - first)
        PG_FAIL (PG_E_USAGE, "%s: '%s' has no values %zu to %zu", w->path, v->name, first, first + n);
    /* a gap of up to 3 bytes is padding behind the previous variable: zeros are buffered for it, no flush */
    uint64_t gap = to - (w->at + w->fill), most = first == 0 ? 3 : 0;
    if (to < w->at + w->fill || gap > most || gap > BUFFER - w->fill) {
        PG_TRY (flush (w));
        w->at = to;
    } else memset (w->buffer + w->fill, 0, gap), w->fill += gap;
    for (size_t done = 0, part; done < n; done += part) {
        part = (BUFFER - w->fill) / size;
        if (part > n - done) part = n - done;
        memcpy (w->buffer + w->fill, (const char *) value + done * size, part * size);
        pg_netcdf_swap (w->buffer + w->fill, part, size);
        w->fill += part * size;
        if (BUFFER - w->fill < 8) PG_TRY (flush (w));
    }
done:
    return status;
}

/* The file is extended, if need be, to the offset at which the records begin. */
pg_status netcdf_finish (netcdf_writer **writer)
{
    pg_status status = PG_OK;
    netcdf_writer *w = *writer;
    static const unsigned char zero = 0;
    if (!w) return PG_OK;
    PG_TRY (flush (w));
    if (w->top < w->records) PG_TRY (pg_disk_write (w->path, w->file, &zero, 1, (long) w->records - 1));
done:
    netcdf_abandon (writer);
    return status;
}

void netcdf_abandon (netcdf_writer **writer)
{
    netcdf_writer *w = *writer;
    if (!w) return;
    if (w->file >= 0) close (w->file);
    for (size_t k = 0; k < w->nvar; k++) pg_free (w->var[k].own.text.data);
    pg_free (w->all.text.data);
    pg_free (w->dim), pg_free (w->var), pg_free (w->buffer), pg_free (w->path);
    pg_free (w);
    *writer = NULL;
}
