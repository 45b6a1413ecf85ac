/* SPDX-License-Identifier: GPL-3.0-or-later
 * pg_mesh_read: loads a file, recognises its format by its content, never by its name, and builds the mesh.
 */
#include "format.h"
#include <errno.h>
#include <limits.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

/* Each pass over list.h gives the macro another meaning: declarations, then the table. */
#define PG_MESH_FORMAT(name) extern const mesh_format mesh_format_##name;
#include "list.h"
#undef PG_MESH_FORMAT
static const mesh_format *const formats[] = {
#define PG_MESH_FORMAT(name) &mesh_format_##name,
#include "list.h"
#undef PG_MESH_FORMAT
};
enum { FORMATS = sizeof formats / sizeof *formats };

pg_status mesh_load (mesh_file *out, char **bytes, const char *path)
{
    pg_status status = PG_OK;
    char *text = NULL;
    struct stat about;
    FILE *file = fopen (path, "rb");
    *out = (mesh_file) { path, NULL, 0 }, *bytes = NULL;
    if (!file || fstat (fileno (file), &about))
        PG_FAIL (PG_E_FILE, "%.400s: cannot be read: %s", path, strerror (errno));
    if (!S_ISREG (about.st_mode)) PG_FAIL (PG_E_FILE, "%.400s: is not a file", path);
    /* One byte more, which stays 0: text ends safely. */
    PG_ALLOC (text, (size_t) about.st_size + 1);
    out->size = fread (text, 1, (size_t) about.st_size, file);
    if (out->size < (size_t) about.st_size) PG_FAIL (PG_E_FILE, "%.400s: could not be read to its end", path);
done:
    if (file) fclose (file);
    if (status != PG_OK) pg_free (text), out->size = 0;
    else out->text = *bytes = text;
    return status;
}

/* Returns the fault of a file that no format recognises; the message lists the formats. */
static pg_status unknown (const mesh_file *file)
{
    char names[400] = "";
    for (size_t k = 0, at = 0; k < FORMATS && at < sizeof names; k++)
        at += (size_t) snprintf (names + at, sizeof names - at, "%s%s", k ? ", " : "", formats[k]->name);
    return pg_error (
        PG_E_FILE, PG_HERE,
        "%.400s: is none of the mesh files that are known: %s (perigal-mesh turns others into Gmsh files)",
        file->path, names);
}

/* The order of list.h counts where several would take a file. */
const mesh_format *mesh_format_of (const mesh_file *file)
{
    for (size_t k = 0; k < FORMATS; k++) if (formats[k]->knows (file)) return formats[k];
    return NULL;
}

/* The builder checks what the format cannot know: missing nodes, flat elements, repeated numbers. */
pg_status mesh_parse (pg_mesh *out, const mesh_file *file)
{
    pg_status status = PG_OK;
    pg_mesh_builder *m = NULL;
    memset (out, 0, sizeof *out);
    const mesh_format *format = mesh_format_of (file);
    /* A fault that lists the known formats. */
    if (!format) PG_TRY (unknown (file));
    PG_TRY (pg_mesh_builder_create (&m, file->path));
    PG_TRY (format->read (m, file));
    PG_TRY (pg_mesh_builder_finish (m, out));
done:
    pg_mesh_builder_free (&m);
    return status;
}

/* The bytes of the file are released after the mesh has been built. */
pg_status pg_mesh_read (pg_mesh *out, const char *path)
{
    mesh_file file;
    char *bytes;
    memset (out, 0, sizeof *out);
    pg_status status = mesh_load (&file, &bytes, path);
    if (status == PG_OK) status = mesh_parse (out, &file);
    pg_free (bytes);
    return status;
}
