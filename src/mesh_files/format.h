/* SPDX-License-Identifier: GPL-3.0-or-later
 * format.h: what a reader of mesh files is, and how it walks through text. A new format: one file
 * src/mesh_files/<name>.c that ends in `const mesh_format mesh_format_<name>`, and one line in list.h. */
#ifndef MESH_FILES_FORMAT_H
#define MESH_FILES_FORMAT_H
#include "perigal/mesh_files.h"
#include <stdio.h>

/* A file in memory: its name for messages, and its bytes; text[size] is 0. */
typedef struct { const char *path, *text; size_t size; } mesh_file;
/* The nodal fields of one step of a file. */
typedef struct { size_t n, capacity; pg_mesh_field *field; double time; } mesh_fields;

typedef struct {
    const char *name;                                  /* "Gmsh 4.1" */
    /* Is this a file of this format? By its content; text may hold the beginning of the file only. */
    int       (*knows)  (const mesh_file *file);
    /* Hands nodes, elements and sets to the builder. */
    pg_status (*read)   (pg_mesh_builder *m, const mesh_file *file);
    /* Fields of one step (-1: the last) at the nodes of `mesh`, which was made from the same file; NULL:
     * the format holds none. */
    pg_status (*fields) (mesh_fields *out, const pg_mesh *mesh, const mesh_file *file, int step);
} mesh_format;
/* The first format of list.h that knows the file; NULL: none does. */
const mesh_format *mesh_format_of (const mesh_file *file);

/* Mesh from bytes (pg_mesh_read after the file is in memory). */
pg_status mesh_parse (pg_mesh *out, const mesh_file *file);
/* Mesh and fields from bytes (pg_mesh_result). */
pg_status mesh_parse_result (pg_mesh *out, const mesh_file *file, int step, size_t *nfield,
                             pg_mesh_field **fields, double *time);
/* Bytes of a whole file; pg_free (text). */
pg_status mesh_load  (mesh_file *out, const char *path);
/* Adds a field of `nnode` x components zeros and returns it (borrowed until the next call). */
pg_status mesh_fields_add (mesh_fields *f, size_t nnode, const char *name, int components,
                           pg_mesh_field **field);
/* A fault that names the steps there are, or PG_OK and `step` as a number from 0. */
pg_status mesh_fields_step (const char *path, size_t steps, int step, size_t *out);
/* pg_netcdf_check_header of a file in memory. */
pg_status mesh_netcdf_check_header (const mesh_file *file);

/* ---- text ---------------------------------------------------------------------------------------------- */
typedef struct { const mesh_file *file; const char *at, *end; long line; } mesh_cursor;   /* line: from 1 */
mesh_cursor mesh_begin (const mesh_file *file);
/* Next line [*first, *last) without its end (\n or \r\n); 0 at the end of the file. `line` is then that of
 * this line. */
int mesh_line   (mesh_cursor *c, const char **first, const char **last);
/* One number of a line, blanks before it skipped; 0: there is none. mesh_real takes 1.5D3 for 1.5E3; no nan,
 * no inf. */
int mesh_whole  (const char **at, const char *last, long *value);
int mesh_real   (const char **at, const char *last, double *value);
/* Fault "path, line 7: ...". */
#define MESH_FAIL(c, ...) do { char why_[400]; snprintf (why_, sizeof why_, __VA_ARGS__); \
    PG_FAIL (PG_E_FILE, "%.400s, line %ld: %s", (c)->file->path, (c)->line, why_); } while (0)
#endif
