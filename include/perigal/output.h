/* SPDX-License-Identifier: GPL-3.0-or-later
 * output.h: files from plain arrays: Exodus, CSV, JSON, checkpoints. Knows columns, fields and points, no
 * method. */
#ifndef PERIGAL_OUTPUT_H
#define PERIGAL_OUTPUT_H
#include "perigal/cloud.h"
#include "perigal/mesh.h"
#include <stdio.h>

PG_API_BEGIN

/* ---- fields on points ---------------------------------------------------------------------------------- */
typedef struct {
    char   name[32];                                   /* "displacement", "damage", "stress" */
    char   unit[16];                                   /* "m", "Pa", "" */
    int    components;                                 /* 1; dim (vector); nv (Voigt) */
    const double *value;                               /* n x components */
} pg_field_view;

/* ---- result.e: Exodus layout in classic netCDF, one SPHERE element and one node per point -------------- */
typedef struct pg_exodus pg_exodus;
pg_status pg_exodus_create (pg_exodus **out, const char *path, const pg_cloud *cloud, const char *title,
                            size_t nfield, const pg_field_view *fields /* values ignored */);
/* To go on: later steps than `steps` are cut off; `steps` and `bytes` as pg_exodus_size told. */
pg_status pg_exodus_open (pg_exodus **out, const char *path, const pg_cloud *cloud, size_t nfield,
                          const pg_field_view *fields, long steps, long bytes);
/* Appends a step; refused, the file stays as it was. */
pg_status pg_exodus_write  (pg_exodus *file, double time, const pg_field_view *fields);
void      pg_exodus_size   (const pg_exodus *file, long *steps, long *bytes);
pg_status pg_exodus_sync   (const pg_exodus *file);  /* to the disk itself */
void      pg_exodus_close  (pg_exodus **file);
/* Reads a field back: step -1 is the last. *value is n x *components, to be freed with pg_free. */
pg_status pg_exodus_read (const char *path, const char *field, int step, size_t *n, int *components,
                          double **value);
pg_status pg_exodus_points (const char *path, pg_cloud *cloud /* x, n, dim, volume, box, h filled */,
                            size_t *nstep, double **time);
pg_status pg_exodus_fields (const char *path, char (**names)[32], size_t *n);    /* base names as written */
pg_status pg_exodus_unit   (const char *path, const char *field, char unit[16]);  /* "" when there is none */

/* and those above it; one that is there is no error; PG_E_FILE */
pg_status pg_folder_make (const char *path);

/* Made anew for writing: what is in its place is removed first, a symbolic link too; PG_E_FILE. To be closed
 * with fclose. */
pg_status pg_file_create (FILE **out, const char *path);

/* ---- tables -------------------------------------------------------------------------------------------- */
/* CSV: header "name [unit]" per column, one row a call, at once in the file or not at all; numbers with 17
 * digits. */
typedef struct pg_table pg_table;
pg_status pg_table_create (pg_table **out, const char *path, size_t n, const char *const *columns);
/* to go on: later rows are cut off */
pg_status pg_table_open   (pg_table **out, const char *path, size_t n, long rows);
long      pg_table_rows   (const pg_table *table);     /* without the header */
pg_status pg_table_sync   (const pg_table *table);     /* to the disk itself */
/* NaN: the cell stays empty, it was not measured */
pg_status pg_table_row    (pg_table *table, const double *values);
pg_status pg_table_line   (pg_table *table, const char *const *values);
void      pg_table_close  (pg_table **table);
/* A table read back, whole: names as the header has them, with their units, and the rows as numbers. */
typedef struct {
    size_t  ncolumn, nrow;
    char  **name;                                      /* "force [N]" (ncolumn) */
    double *value;                                     /* NAN: empty, or no number (nrow x ncolumn) */
    char   *text;                                      /* holds the names */
} pg_csv;
pg_status pg_csv_read   (pg_csv *csv, const char *path);
void      pg_csv_clear  (pg_csv *csv);
/* Column of a name, given as in the header or without its unit; -1: there is none. */
long      pg_csv_column (const pg_csv *csv, const char *wanted);
size_t    pg_csv_name   (const char *column);          /* length of the name alone, without " [unit]" */

/* ---- checkpoint.nc: what a run must remember, in classic netCDF ---------------------------------------- */
typedef pg_status (*pg_keep) (void *context, const pg_keeper *keeper);
/* The walk is made twice, with the same names and lengths: to define and to write. At any instant `path` is
 * the old file or the whole new one (written as PATH.new, synced, moved). */
pg_status pg_checkpoint_write (const char *path, pg_keep walk, void *context);
/* The same walk; a name that the file lacks or has in another length is PG_E_FILE. */
pg_status pg_checkpoint_read  (const char *path, pg_keep walk, void *context);

/* ---- JSON ---------------------------------------------------------------------------------------------- */
typedef struct pg_json pg_json;                        /* written to PATH.tmp, renamed on close */
pg_status pg_json_create (pg_json **out, const char *path);
/* '{' or '[' ; key NULL inside lists */
void      pg_json_open   (pg_json *j, const char *key, char bracket);
void      pg_json_shut   (pg_json *j);
void      pg_json_number (pg_json *j, const char *key, double value);     /* NaN and infinities become null */
void      pg_json_count  (pg_json *j, const char *key, size_t value);
void      pg_json_text   (pg_json *j, const char *key, const char *value);
pg_status pg_json_close  (pg_json **j);
PG_API_END
#endif
