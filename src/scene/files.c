/* SPDX-License-Identifier: GPL-3.0-or-later
 * The files that a scene names: where they are, and a fingerprint of their content, by which a result can
 * be traced to its input. A file name is taken relative to the folder of the scene, not to that of the
 * program. */
#include "document.h"
#include "sha256.h"
#include <errno.h>
#include <string.h>
#include <sys/stat.h>

/* The folder of the scene is the part of its name before the last slash. */
pg_status pg_scene_beside (char **out, const pg_scene *s, const char *name)
{
    pg_status status = PG_OK;
    const char *slash = s->file ? strrchr (s->file, '/') : NULL;
    size_t folder = slash && name[0] != '/' ? (size_t) (slash - s->file) + 1 : 0, length = strlen (name) + 1;
    PG_ALLOC (*out, folder + length);
    if (folder) memcpy (*out, s->file, folder);
    memcpy (*out + folder, name, length);
done:
    return status;
}

/* SHA-256 of a regular file. */
static pg_status hash_file (const char *path, char hash[65])
{
    pg_status status = PG_OK;
    pg_sha256 sum;
    char part[16384];
    size_t got;
    struct stat s;
    FILE *f = NULL;
    if (stat (path, &s) == 0 && !S_ISREG (s.st_mode)) PG_FAIL (PG_E_FILE, "%s: is no regular file", path);
    f = fopen (path, "rb");
    if (!f) PG_FAIL (PG_E_FILE, "%s: %s", path, strerror (errno));
    pg_sha256_start (&sum);
    while ((got = fread (part, 1, sizeof part, f)) > 0) pg_sha256_add (&sum, part, got);
    if (ferror (f)) PG_FAIL (PG_E_FILE, "%s: %s", path, strerror (errno));
    pg_sha256_end (&sum, hash);
done:
    if (f) fclose (f);
    return status;
}

/* The list of files under construction. */
typedef struct { const pg_scene *scene; pg_named_file *file; size_t n, cap; } collection;

/* Adds the files that a node and its children name; path: of the node. */
static pg_status collect (collection *c, const pg_node *node, const char *path)
{
    pg_status status = PG_OK;
    char below[128];
    if (node->key && node->key->kind == PG_FILE && node->text && *node->text) {
        PG_GROW (c->file, c->cap, c->n + 1);
        pg_named_file *f = &c->file[c->n];
        memset (f, 0, sizeof *f);
        snprintf (f->key, sizeof f->key, "%.127s", path);
        PG_TRY (pg_scene_beside (&f->path, c->scene, node->text));
        c->n++;
        PG_TRY (hash_file (f->path, f->hash));
    }
    /* Children of a map have names, elements of a list have indices. */
    for (size_t k = 0; k < node->n; k++) {
        const pg_node *child = &node->child[k];
        if (child->name) snprintf (below, sizeof below, "%.60s%s%.63s", path, *path ? "." : "", child->name);
        else snprintf (below, sizeof below, "%.60s[%zu]", path, k);
        PG_TRY (collect (c, child, below));
    }
done:
    return status;
}

/* A file that cannot be read is a failure: a result without its fingerprint could not be traced. */
pg_status pg_scene_files (const pg_scene *s, size_t *n, pg_named_file **out)
{
    collection c = { .scene = s };
    pg_status status = collect (&c, &s->root, "");
    if (status != PG_OK) pg_scene_files_free (c.n, &c.file);
    *n = status == PG_OK ? c.n : 0, *out = c.file;
    return status;
}

void pg_scene_files_free (size_t n, pg_named_file **file)
{
    for (size_t k = 0; k < n; k++) pg_free ((*file)[k].path);
    pg_free (*file);
    *file = NULL;
}
