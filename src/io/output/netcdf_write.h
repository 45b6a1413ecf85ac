/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: writes classic netCDF files. First everything is defined, dimensions, variables and attributes;
 * netcdf_end_header then lays out the file and writes its header; then come the values. A fault while
 * something is defined is kept and returned by netcdf_end_header, so that the definitions need no checks. */
#ifndef PERIGAL_OUTPUT_NETCDF_WRITE_H
#define PERIGAL_OUTPUT_NETCDF_WRITE_H
#include "perigal/output.h"
#include "perigal/netcdf.h"

typedef struct netcdf_writer netcdf_writer;
/* Creates the file. version: 2 for offsets of 64 bits, or 5 for counts of 64 bits and types of 8 bytes. */
pg_status netcdf_create (netcdf_writer **out, const char *path, int version);
/* Defines a dimension (length 0: the record dimension) and returns its number. */
int       netcdf_define_dimension (netcdf_writer *w, const char *name, size_t length);
/* Defines a variable over ndim dimensions, the record dimension first if it has it, and returns its number.
 * A second variable of the same name is a fault (PG_E_USAGE). */
int       netcdf_define_variable (netcdf_writer *w, const char *name, int type, size_t ndim, const int *dim);
/* Define an attribute of a variable (-1: of the file): a text, or n numbers (float, double or int). */
void      netcdf_define_text    (netcdf_writer *w, int variable, const char *name, const char *text);
void      netcdf_define_numbers (netcdf_writer *w, int variable, const char *name, int type, size_t n,
                                 const void *value);
/* The number of the dimension or of the variable of that name; -1: there is none. */
int       netcdf_dimension_of (const netcdf_writer *w, const char *name);
int       netcdf_variable_of  (const netcdf_writer *w, const char *name);
/* Ends the definitions and writes the header; returns the first fault of a definition. */
pg_status netcdf_end_header (netcdf_writer *w);
/* Writes values first .. first + n - 1 of a variable without records, given as the C type of the variable:
 * double, int, long (INT64) or char. Adjacent values are collected and written together. */
pg_status netcdf_put (netcdf_writer *w, int variable, size_t first, size_t n, const void *value);
/* Writes the values still collected and closes the file, also after a failure; values that were never put are
 * zero. *w may be NULL. */
pg_status netcdf_finish (netcdf_writer **w);
/* Closes the file after a fault, as it is. */
void      netcdf_abandon (netcdf_writer **w);
#endif
