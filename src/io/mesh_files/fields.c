/* SPDX-License-Identifier: GPL-3.0-or-later
 * pg_mesh_result: a mesh and the nodal fields of one step. The mesh is built first; the format then reads
 * the fields at its nodes, by their numbers in the file. */
#include "format.h"
#include <stdio.h>
#include <string.h>

/* Names are cut at 31 bytes. */
pg_status mesh_fields_add (mesh_fields *f, size_t nnode, const char *name, int components,
                           pg_mesh_field **field)
{
    pg_status status = PG_OK;
    PG_GROW (f->field, f->capacity, f->n + 1);
    pg_mesh_field *new = &f->field[f->n];
    memset (new, 0, sizeof *new);
    snprintf (new->name, sizeof new->name, "%.31s", name);
    new->components = components;
    PG_ALLOC (new->value, nnode * (size_t) components);
    f->n++;
    *field = new;
done:
    return status;
}

/* A file without steps is a fault of the file (PG_E_FILE), not of the caller. */
pg_status mesh_fields_step (const char *path, size_t steps, int step, size_t *out)
{
    pg_status status = PG_OK;
    if (steps == 0) PG_FAIL (PG_E_FILE, "%.400s holds a mesh and no results at nodes", path);
    /* A step that does not exist is a fault of the caller's, not of the file. */
    if (step < -1 || (step >= 0 && (size_t) step >= steps))
        PG_FAIL (PG_E_USAGE, "%.400s has no step %d; its steps are 0 to %zu", path, step, steps - 1);
    *out = step < 0 ? steps - 1 : (size_t) step;
done:
    return status;
}

/* In a 2D mesh vectors keep two of their three components. */
static void flatten_vectors (const pg_mesh *mesh, mesh_fields *f)
{
    for (size_t k = 0; k < f->n && mesh->dim == 2; k++) {
        pg_mesh_field *v = &f->field[k];
        if (v->components != 3) continue;
        for (size_t i = 0; i < mesh->nnode; i++)
            v->value[2 * i] = v->value[3 * i], v->value[2 * i + 1] = v->value[3 * i + 1];
        v->components = 2;
    }
}

/* On failure neither mesh nor fields remain. */
pg_status mesh_parse_result (pg_mesh *out, const mesh_file *file, int step, size_t *nfield,
                             pg_mesh_field **fields, double *time)
{
    pg_status status = PG_OK;
    mesh_fields found = { 0 };
    memset (out, 0, sizeof *out);
    const mesh_format *format = mesh_format_of (file);
    if (!format || !format->fields)
        PG_FAIL (PG_E_FILE, "%.400s holds no fields of a kind that is known: CalculiX .frd, Exodus",
                 file->path);
    PG_TRY (mesh_parse (out, file));
    PG_TRY (format->fields (&found, out, file, step));
    flatten_vectors (out, &found);
    *nfield = found.n, *fields = found.field;
    if (time) *time = found.time;
done:
    if (status != PG_OK) {
        pg_mesh_fields_clear (found.n, &found.field);
        pg_mesh_clear (out);
    }
    return status;
}

/* The file is loaded once for mesh and fields. */
pg_status pg_mesh_result (pg_mesh *out, const char *path, int step, size_t *nfield, pg_mesh_field **fields,
                          double *time)
{
    mesh_file file;
    char *bytes;
    memset (out, 0, sizeof *out);
    *nfield = 0, *fields = NULL;
    pg_status status = mesh_load (&file, &bytes, path);
    if (status == PG_OK) status = mesh_parse_result (out, &file, step, nfield, fields, time);
    pg_free (bytes);
    return status;
}
