/* SPDX-License-Identifier: GPL-3.0-or-later
 * result.h: formats that hold fields beside a mesh (pg_mesh_result). A format: `knows` and `read` as of
 * mesh_format, and `fields`. */
#ifndef MESH_RESULT_H
#define MESH_RESULT_H
#include "builder.h"
#include "mesh_private.h"

typedef struct { size_t n, workspace; pg_mesh_field *field; double time; } mesh_fields;
/* Adds a field of `nnode` x components zeros and returns it (borrowed until the next call). */
pg_status fields_add (mesh_fields *f, size_t nnode, const char *name, int components, pg_mesh_field **field);
/* fields: of one step (-1: the last) at the nodes of `mesh`, made from the same file. */
typedef struct {
    const mesh_format *format;
    pg_status (*fields) (mesh_fields *out, const pg_mesh *mesh, const mesh_bytes *file, int step);
} result_format;
extern const mesh_format mesh_format_frd, mesh_format_exodus;
extern const result_format result_format_frd, result_format_exodus;
/* Fault that names the steps there are, or OK and `step` as a number from 0. */
pg_status result_step (const char *path, size_t steps, int step, size_t *out);
#endif
