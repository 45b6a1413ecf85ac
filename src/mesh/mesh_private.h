/* SPDX-License-Identifier: GPL-3.0-or-later
 * mesh_private.h: what a reader of mesh files is, and how it walks through text. A new format: one file
 * src/mesh/<name>.c that ends in `const mesh_format mesh_format_<name>`, and one line in list.h. */
#ifndef MESH_PRIVATE_H
#define MESH_PRIVATE_H
#include "perigal/mesh.h"

/* A file: its name for messages, its bytes; text[size] is 0. */
typedef struct { const char *path, *text; size_t size; } mesh_bytes;
typedef struct {
    const char *name;                                  /* "Gmsh 4.1" */
    /* told by content; text may hold the beginning of the file only */
    int       (*knows) (const mesh_bytes *file);
    pg_status (*read)  (pg_mesh_builder *m, const mesh_bytes *file);
} mesh_format;
/* Mesh from bytes (pg_mesh_read after the file is in memory). */
pg_status mesh_parse (pg_mesh *out, const mesh_bytes *file);
/* Mesh and fields from bytes (pg_mesh_result). */
pg_status mesh_parse_result (pg_mesh *out, const mesh_bytes *file, int step, size_t *nfield,
                             pg_mesh_field **fields, double *time);
/* Bytes of a whole file; pg_free (text). */
pg_status mesh_load  (mesh_bytes *out, const char *path);

/* ---- text ---------------------------------------------------------------------------------------------- */
typedef struct { const mesh_bytes *file; const char *at, *end; long line; } mesh_cursor;   /* line: from 1 */
mesh_cursor mesh_begin (const mesh_bytes *file);
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
