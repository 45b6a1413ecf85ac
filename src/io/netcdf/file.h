/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: an open netCDF file of either kind, as classic.c or library.c has filled it in. */
#ifndef PERIGAL_NETCDF_FILE_H
#define PERIGAL_NETCDF_FILE_H
#include "perigal/netcdf.h"
#include <stdint.h>

/* A dimension. */
typedef struct { char name[PG_NC_NAME + 1]; size_t length; } nc_dimension;
/* A variable. per: number of values in one record, or of all values if it has no record dimension; classic
 * files only: begin: offset of its first byte; record: 1 if its first dimension is the record dimension. */
typedef struct { pg_netcdf_variable about; size_t per; uint64_t begin; int record; } nc_variable;
/* An attribute. variable: index of the variable that has it, -1: the file; its n values begin at byte `at` of
 * the file (classic files only). */
typedef struct { int variable, type; char name[PG_NC_NAME + 1]; size_t n, at; } nc_attribute;

struct pg_netcdf {
    char  *path;
    /* The bytes of the file; mapped: 1 if pg_netcdf_open has mapped them, so that closing unmaps them. */
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

/* Bytes of one value of a netCDF type, 1 to 11; 0: there is no such type. */
size_t    nc_size_of (int type);
/* Parses the header of a classic file (f->bytes) into the dimensions, variables and attributes of f. */
pg_status nc_classic_parse (pg_netcdf *f);
/* netCDF-4 files, by the netCDF library: open the bytes and list dimensions, variables and attributes; read n
 * values of a variable from value `first` on; read an attribute (0: failed); close. */
pg_status nc_library_open  (pg_netcdf *f);
pg_status nc_library_doubles (const pg_netcdf *f, int variable, size_t first, size_t n, double *value);
pg_status nc_library_longs   (const pg_netcdf *f, int variable, size_t first, size_t n, long *value);
pg_status nc_library_chars   (const pg_netcdf *f, int variable, size_t first, size_t n, char *value);
int       nc_library_text    (const pg_netcdf *f, const nc_attribute *a, char *text);
int       nc_library_numbers (const pg_netcdf *f, const nc_attribute *a, double *value);
void      nc_library_close (pg_netcdf *f);
#endif
