/* SPDX-License-Identifier: GPL-3.0-or-later
 * The header of classic netCDF files, by the published grammar of the format ("NetCDF Classic Format
 * Specification", Unidata): magic and number of records, then lists of dimensions, attributes and variables,
 * all numbers with the high byte first. Version 1 has counts of 4 bytes and offsets of 4, version 2 counts
 * of 4 and offsets of 8, version 5 both of 8.
 *
 * Nothing in a file is trusted: every count must fit into the bytes that are left before memory is asked for,
 * so that a few changed bytes cannot ask for gigabytes. */
#include "file.h"
#include <string.h>

/* Tags that begin the three kinds of lists in the header. */
enum { DIMENSION = 10, VARIABLE = 11, ATTRIBUTE = 12 };
/* The header while it is parsed. at: offset of the next byte; broken: 1 once the header proves invalid. */
typedef struct { pg_netcdf *f; size_t at; int broken; } walker;

/* The types from 7 on (unsigned and 64-bit integers) exist in version 5 only. */
size_t nc_size_of (int type)
{
    static const unsigned char size[] = { 0, 1, 1, 2, 4, 4, 8, 1, 2, 4, 8, 8 };
    return type > 0 && type < (int) sizeof size ? size[type] : 0;
}

/* Reads an unsigned integer of `bytes` bytes, high byte first; w->broken is set if the file ends before. */
static uint64_t whole (walker *w, size_t bytes)
{
    uint64_t value = 0;
    if (w->broken || w->f->size - w->at < bytes) return w->broken = 1, 0;
    for (size_t k = 0; k < bytes; k++) value = value << 8 | w->f->bytes[w->at + k];
    w->at += bytes;
    return value;
}

/* Reads a count or a length: 8 bytes in version 5, otherwise 4. */
static uint64_t number (walker *w) { return whole (w, w->f->version == 5 ? 8 : 4); }

/* Reads a count of items of at least `least` bytes each; w->broken if the file is too short for them. */
static size_t count (walker *w, size_t least)
{
    uint64_t n = number (w);
    if (n > (w->f->size - w->at) / least) w->broken = 1;
    return w->broken ? 0 : (size_t) n;
}

/* Skips bytes, padded to a multiple of four. */
static void skip (walker *w, uint64_t bytes)
{
    uint64_t padded = (bytes + 3) / 4 * 4;
    if (w->broken || padded > w->f->size - w->at) w->broken = 1;
    else w->at += padded;
}

/* Reads a name: its length and its letters. */
static void name (walker *w, char out[PG_NC_NAME + 1])
{
    size_t n = count (w, 1);
    const unsigned char *text = w->f->bytes + w->at;
    out[0] = 0;
    if (n == 0 || n > PG_NC_NAME || memchr (text, 0, n)) w->broken = 1;
    skip (w, n);
    if (w->broken) return;
    memcpy (out, text, n);
    out[n] = 0;
}

/* Reads the type of the values of a variable or an attribute: 1 to 6, in version 5 up to 11. */
static int type (walker *w)
{
    uint64_t t = whole (w, 4);
    if (t < 1 || t > (w->f->version == 5 ? 11 : 6)) w->broken = 1;
    return w->broken ? 1 : (int) t;
}

/* Reads the head of a list, its tag and its number of items (both 0: no list), and returns that number.
 * least: smallest number of bytes of an item. */
static size_t list (walker *w, uint64_t tag, size_t least)
{
    uint64_t got = whole (w, 4);
    size_t n = count (w, least);
    if (got != tag && (got != 0 || n != 0)) w->broken = 1;
    return w->broken ? 0 : n;
}

/* Reads the attributes of a variable (-1: of the file); of their values only the offsets are stored. */
static pg_status attributes (walker *w, int variable)
{
    pg_status status = PG_OK;
    pg_netcdf *f = w->f;
    for (size_t n = list (w, ATTRIBUTE, 12); n > 0 && !w->broken; n--) {
        PG_GROW (f->att, f->att_room, f->natt + 1);
        nc_attribute *a = &f->att[f->natt];
        a->variable = variable;
        name (w, a->name);
        a->type = type (w);
        a->n = count (w, nc_size_of (a->type));
        a->at = w->at;
        skip (w, a->n * nc_size_of (a->type));
        f->natt++;
    }
done:
    return status;
}

/* Reads the list of dimensions; one of length 0 is the record dimension. */
static pg_status dimensions (walker *w)
{
    pg_status status = PG_OK;
    pg_netcdf *f = w->f;
    for (size_t n = list (w, DIMENSION, 8); n > 0 && !w->broken; n--) {
        PG_GROW (f->dim, f->dim_room, f->ndim + 1);
        nc_dimension *d = &f->dim[f->ndim];
        name (w, d->name);
        uint64_t length = number (w);
        if (length >> 48) w->broken = 1;
        d->length = (size_t) length;
        f->ndim++;
    }
done:
    return status;
}

/* Reads the `more` dimension numbers of a variable; v->per becomes the product of their lengths without the
 * record dimension (length 0), which may only be first. w->broken if that product exceeds 2^48. */
static void extents (walker *w, nc_variable *v, size_t more)
{
    v->per = 1;
    for (size_t k = 0; k < more && !w->broken; k++) {
        uint64_t id = number (w);
        if (w->broken || id >= w->f->ndim) { w->broken = 1; return; }
        size_t length = w->f->dim[id].length;
        if (k == 0) v->about.first = length, v->record = length == 0;
        else if (length == 0) w->broken = 1;
        v->about.last = length;
        if (length == 0) continue;
        if (v->per > ((size_t) 1 << 48) / length) w->broken = 1;
        else v->per *= length;
    }
}

/* Reads one variable: name, dimensions, attributes, type, size (ignored: it follows from the dimensions, and
 * its field is too narrow for large variables), offset. */
static pg_status variable (walker *w)
{
    pg_status status = PG_OK;
    pg_netcdf *f = w->f;
    PG_GROW (f->var, f->var_room, f->nvar + 1);
    nc_variable *v = &f->var[f->nvar];
    name (w, v->about.name);
    v->about.ndim = count (w, 4);
    if (v->about.ndim > PG_NC_DIMENSIONS) w->broken = 1;
    extents (w, v, v->about.ndim);
    PG_TRY (attributes (w, (int) f->nvar));
    v->about.type = type (w);
    (void) number (w);
    v->begin = whole (w, f->version == 1 ? 4 : 8);
    if (v->begin >> 62) w->broken = 1;
    f->nvar++;
done:
    return status;
}

/* Computes f->stride, the bytes of a record: the values of all variables with records, each padded to a
 * multiple of four unless it is the only one. Then stores the number of records as a dimension's length. */
static void settle_records (walker *w)
{
    pg_netcdf *f = w->f;
    size_t with = 0;
    uint64_t bare = 0;
    for (size_t k = 0; k < f->nvar; k++) {
        const nc_variable *v = &f->var[k];
        if (!v->record) continue;
        bare = (uint64_t) v->per * nc_size_of (v->about.type);
        f->stride += (bare + 3) / 4 * 4;
        with++;
    }
    if (with == 1) f->stride = bare;
    /* A record count of all ones is an unknown one; it is computed from the size of the file. */
    uint64_t unknown = f->version == 5 ? ~(uint64_t) 0 : 0xffffffffu;
    if (f->records == unknown) f->records = f->stride ? (f->size - w->at) / f->stride : 0;
    if (f->records > f->size) w->broken = 1;
    for (size_t k = 0; k < f->ndim && !w->broken; k++)
        if (f->dim[k].length == 0) f->dim[k].length = (size_t) f->records;
    for (size_t k = 0; k < f->nvar && !w->broken; k++) {
        nc_variable *v = &f->var[k];
        v->about.n = v->per * (v->record ? (size_t) f->records : 1);
        /* the values of one record, or all, would need more bytes than the file has */
        if (v->about.n > 0 && v->per > f->size / nc_size_of (v->about.type)) w->broken = 1;
        if (!v->record) continue;
        v->about.first = (size_t) f->records;
        if (v->about.ndim == 1) v->about.last = (size_t) f->records;
    }
}

pg_status nc_classic_parse (pg_netcdf *f)
{
    pg_status status = PG_OK;
    walker w = { f, 4, 0 };
    f->version = f->bytes[3];
    f->records = number (&w);
    PG_TRY (dimensions (&w));
    PG_TRY (attributes (&w, -1));
    for (size_t n = list (&w, VARIABLE, 24); n > 0 && !w.broken; n--) PG_TRY (variable (&w));
    if (!w.broken) settle_records (&w);
    if (w.broken)
        PG_FAIL (PG_E_FILE,
                 "%.400s: the header of this netCDF file is broken near byte %zu: it was cut or changed",
                 f->path, w.at);
done:
    return status;
}
