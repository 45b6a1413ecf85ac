/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: what a reader of mesh files is, and how it walks through text. A new format is one file
 * src/io/mesh_files/NAME.c that ends in `const mesh_format mesh_format_NAME`, and one line in list.h.
 *
 * A reader hands nodes, elements and sets to the builder as the file gives them (pg_mesh_builder); the
 * builder resolves numbers, separates solid elements from those that only name a set, and checks the mesh.
 * Readers trust nothing in a file: counts are compared with the bytes that are left before memory is asked
 * for, and every fault names file and line, byte or element (PG_E_FILE). test/fuzz feeds them broken files.
 */
#ifndef MESH_FILES_FORMAT_H
#define MESH_FILES_FORMAT_H
#include "perigal/mesh_files.h"
#include <stdio.h>

/* A whole file in memory: its name for messages and its bytes; text[size] is 0. */
typedef struct { const char *path, *text; size_t size; } mesh_file;
/* The nodal fields of one step of a file, and the time of that step. */
typedef struct { size_t n, capacity; pg_mesh_field *field; double time; } mesh_fields;

/* An entry of the catalogue of formats. */
typedef struct {
    /* Name for messages: "Gmsh 4.1". */
    const char *name;
    /* Is this a file of this format? Decided by its content; text may hold only the beginning of the file. */
    int       (*knows)  (const mesh_file *file);
    /* Hands nodes, elements and sets to the builder. */
    pg_status (*read)   (pg_mesh_builder *m, const mesh_file *file);
    /* Adds the fields of one step (-1: the last) at the nodes of `mesh`, which was made from the same file.
     * NULL: the format has none. */
    pg_status (*fields) (mesh_fields *out, const pg_mesh *mesh, const mesh_file *file, int step);
} mesh_format;
/* The first format of list.h that recognises the file; NULL: none does. */
const mesh_format *mesh_format_of (const mesh_file *file);

/* Reads the mesh from a file that is in memory. */
pg_status mesh_parse (pg_mesh *out, const mesh_file *file);
/* Reads the mesh, and the nodal fields of one step (-1: the last) and its time, from a file in memory. */
pg_status mesh_parse_result (pg_mesh *out, const mesh_file *file, int step, size_t *nfield,
                             pg_mesh_field **fields, double *time);
/* Reads a whole file. `out` points into *bytes, which the caller frees (pg_free); NULL after a failure. */
pg_status mesh_load  (mesh_file *out, char **bytes, const char *path);
/* Appends a field of nnode x components zeros; *field is borrowed until the next call. */
pg_status mesh_fields_add (mesh_fields *f, size_t nnode, const char *name, int components,
                           pg_mesh_field **field);
/* Sets *out to the index of a time step, 0 .. steps - 1 (step -1: the last). PG_E_USAGE, with the range of
 * steps, if the file has no such step. */
pg_status mesh_fields_step (const char *path, size_t steps, int step, size_t *out);

/* ---- text ---------------------------------------------------------------------------------------------- */
/* A position in a text file: the next byte, the end, and the number of the last line read, from 1. */
typedef struct { const mesh_file *file; const char *at, *end; long line; } mesh_cursor;
/* A cursor at the beginning of the file, behind a byte order mark if there is one. */
mesh_cursor mesh_begin (const mesh_file *file);
/* Reads the next line [*first, *last) without its end (\n or \r\n), whose number c->line becomes; returns 0
 * at the end of the file. */
int mesh_line   (mesh_cursor *c, const char **first, const char **last);
/* Reads a number of a line, blanks before it skipped, and moves *at behind it; 0: there is none. mesh_real
 * also takes 1.5D3 for 1.5E3, but no nan or inf. */
int mesh_whole  (const char **at, const char *last, long *value);
int mesh_real   (const char **at, const char *last, double *value);
/* Fails with PG_E_FILE and a message that begins with file and line: "path, line 7: ...". */
#define MESH_FAIL(c, ...) do { char why_[400]; snprintf (why_, sizeof why_, __VA_ARGS__); \
    PG_FAIL (PG_E_FILE, "%.400s, line %ld: %s", (c)->file->path, (c)->line, why_); } while (0)
#endif
