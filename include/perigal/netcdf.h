/* SPDX-License-Identifier: GPL-3.0-or-later
 * netcdf.h: reads netCDF files, the container of Exodus meshes, results and checkpoints. Classic files
 * (versions 1, 2 and 5) are read here, from a mapping of the file; files of netCDF-4, which are HDF5 within,
 * by the netCDF library, which is loaded when the first of them is met. Both kinds give the same answers.
 * Classic files are written by output (netcdf_write.h). Knows no meshes and no fields. */
#ifndef PERIGAL_NETCDF_H
#define PERIGAL_NETCDF_H
#include "perigal/base.h"

PG_API_BEGIN

/* Types of values by their numbers in the format; those from PG_NC_UBYTE on exist in version 5 and in
 * netCDF-4. */
enum { PG_NC_BYTE = 1, PG_NC_CHAR, PG_NC_SHORT, PG_NC_INT, PG_NC_FLOAT, PG_NC_DOUBLE, PG_NC_UBYTE,
       PG_NC_USHORT, PG_NC_UINT, PG_NC_INT64, PG_NC_UINT64 };
/* Maximum length of a name, maximum number of dimensions of a variable. */
enum { PG_NC_NAME = 256, PG_NC_DIMENSIONS = 1024 };

/* An open file. */
typedef struct pg_netcdf pg_netcdf;
/* A variable: name, type, numbers of its dimensions (ndim), lengths of the first and the last of them, and
 * the number of all its values. */
typedef struct {
    char   name[PG_NC_NAME + 1];
    int    type;
    size_t ndim, first, last, n;
} pg_netcdf_variable;

/* Opens a file of either kind. Every count in its header is compared with the bytes that are left before
 * memory is asked for. PG_E_FILE: there is no such file, it is none of netCDF, or its header is broken, and
 * near which byte. */
pg_status pg_netcdf_open  (pg_netcdf **out, const char *path);
/* Opens a file whose bytes are in memory (borrowed) as pg_netcdf_open does. path: for messages. */
pg_status pg_netcdf_parse (pg_netcdf **out, const char *path, const void *bytes, size_t size);
void      pg_netcdf_close (pg_netcdf **file);

/* Length of a dimension; 0: there is none of that name. */
size_t    pg_netcdf_length (const pg_netcdf *file, const char *dimension);
/* Number of variables; index of the variable of that name, -1: there is none; properties of a variable. */
size_t    pg_netcdf_variables (const pg_netcdf *file);
int       pg_netcdf_find (const pg_netcdf *file, const char *name);
void      pg_netcdf_about (const pg_netcdf *file, int variable, pg_netcdf_variable *about);

/* Values first .. first + n - 1 of a variable in the order of the file (the last dimension runs fastest),
 * converted from any numeric type. PG_E_FILE: the file ends before them, there are not so many, the type is
 * none of numbers, or a value does not fit. */
pg_status pg_netcdf_doubles (const pg_netcdf *file, int variable, size_t first, size_t n, double *value);
pg_status pg_netcdf_longs   (const pg_netcdf *file, int variable, size_t first, size_t n, long *value);
/* Characters or bytes first .. first + n - 1 of a variable, as they are. PG_E_FILE: not so many, no text. */
pg_status pg_netcdf_chars   (const pg_netcdf *file, int variable, size_t first, size_t n, char *value);

/* The text of an attribute of a variable (-1: of the file); 0: there is none, it is no text, or it does not
 * fit into `size` bytes with its end. */
int       pg_netcdf_text    (const pg_netcdf *file, int variable, const char *name, char *text, size_t size);
/* The n numbers of an attribute; 0, and the values stay: there is none, or it has another length. */
int       pg_netcdf_numbers (const pg_netcdf *file, int variable, const char *name, size_t n, double *value);

/* Turns n numbers of `size` bytes (4, 8; others stay) from the order of the host into that of classic files,
 * the most significant byte first, or back. */
void      pg_netcdf_swap (void *value, size_t n, size_t size);

PG_API_END
#endif
