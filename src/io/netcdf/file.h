/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: an open netCDF file of either kind, as classic.c or library.c has filled it in. */
#ifndef PERIGAL_NETCDF_FILE_H
#define PERIGAL_NETCDF_FILE_H
#include "perigal/netcdf.h"
#include <stdint.h>

/* A dimension. */
typedef struct { char name[PG_NC_NAME + 1]; size_t length; } nc_dimension;
/* A variable. per: values of one record, or all where it has no records; begin: first byte (classic);
 * record: 1 if its first dimension is that of the records (classic). */
typedef struct { pg_netcdf_variable about; size_t per; uint64_t begin; int record; } nc_variable;
/* An attribute of a variable (-1: of the file): its n values lie at byte `at` of the header (classic). */
typedef struct { int variable, type; char name[PG_NC_NAME + 1]; size_t n, at; } nc_attribute;

struct pg_netcdf {
    char  *path;
    /* The bytes of the file; mapped: 1 if they are a mapping of our own. */
    const unsigned char *bytes;
    size_t size;
    int    mapped;
    /* Version 1, 2 or 5 of the classic format; 0: netCDF-4, open in the library under the number id. */
    int    version, id;
    /* Bytes from one record to the next, and number of records (classic). */
    uint64_t stride, records;
    size_t ndim, nvar, natt, dim_room, var_room, att_room;
    nc_dimension *dim;
    nc_variable  *var;
    nc_attribute *att;
};

/* Bytes of one value of a type, 1 to 11. */
size_t    nc_size_of (int type);
/* Fills in what the header says; f->bytes is known. */
pg_status nc_classic_parse (pg_netcdf *f);
/* Opens the bytes by the netCDF library and asks it for the same; values; end. */
pg_status nc_library_open  (pg_netcdf *f);
pg_status nc_library_doubles (const pg_netcdf *f, int variable, size_t first, size_t n, double *value);
pg_status nc_library_longs   (const pg_netcdf *f, int variable, size_t first, size_t n, long *value);
pg_status nc_library_chars   (const pg_netcdf *f, int variable, size_t first, size_t n, char *value);
int       nc_library_text    (const pg_netcdf *f, const nc_attribute *a, char *text);
int       nc_library_numbers (const pg_netcdf *f, const nc_attribute *a, double *value);
void      nc_library_close (pg_netcdf *f);
#endif
