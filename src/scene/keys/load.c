/* SPDX-License-Identifier: GPL-3.0-or-later
 * Reads scenes against the keys of all folders, from a file or from memory. */
#include "keys.h"
#include <errno.h>
#include <string.h>
#include <sys/stat.h>

/* Largest number of bytes of a scene file. */
enum { LARGEST = 1 << 28 };

pg_status pg_scene_parse_with (pg_scene **out, const char *text, const char *name, size_t nset,
                               const char *const *set)
{
    pg_status status = PG_OK;
    const pg_vocabulary *words;
    *out = NULL;
    PG_TRY (pg_keys_of_all (&words));
    PG_TRY (pg_scene_read (out, text, strlen (text), name, nset, set, words, 0));
done:
    return status;
}

pg_status pg_scene_parse (pg_scene **out, const char *text, const char *name)
{
    return pg_scene_parse_with (out, text, name, 0, NULL);
}

/* Reads a regular file. A pipe would block, and would be empty when it is read again. */
static pg_status read_file (char **text, size_t *length, const char *path)
{
    pg_status status = PG_OK;
    size_t cap = 0, n = 0, more;
    struct stat s;
    FILE *f = NULL;
    /* Folders have their own message. */
    if (stat (path, &s) == 0 && !S_ISREG (s.st_mode))
        PG_FAIL (PG_E_FILE, "%s: cannot be read: %s", path,
                 S_ISDIR (s.st_mode) ? strerror (EISDIR) : "a scene is a regular file, no pipe or device");
    f = fopen (path, "rb");
    if (!f) PG_FAIL (PG_E_FILE, "%s: cannot be opened: %s", path, strerror (errno));
    do {
        PG_GROW (*text, cap, n + 4096);
        more = fread (*text + n, 1, cap - n, f);
        n += more;
        if (n > LARGEST) PG_FAIL (PG_E_LIMIT, "%s: a scene has at most %d bytes", path, LARGEST);
    } while (more);
    if (ferror (f)) PG_FAIL (PG_E_FILE, "%s: cannot be read: %s", path, strerror (errno));
    *length = n;
done:
    if (f) fclose (f);
    return status;
}

/* Reads a scene from a file; some: 1: as pg_scene_load_some does. */
static pg_status load (pg_scene **out, const char *path, size_t nset, const char *const *set, int some)
{
    pg_status status = PG_OK;
    char *text = NULL;
    size_t length = 0;
    const pg_vocabulary *words;
    *out = NULL;
    PG_TRY (pg_keys_of_all (&words));
    PG_TRY (read_file (&text, &length, path));
    PG_TRY (pg_scene_read (out, text, length, path, nset, set, words, some));
done:
    pg_free (text);
    return status;
}

pg_status pg_scene_load_with (pg_scene **out, const char *path, size_t nset, const char *const *set)
{
    return load (out, path, nset, set, 0);
}
pg_status pg_scene_load_some (pg_scene **out, const char *path, size_t nset, const char *const *set)
{
    return load (out, path, nset, set, 1);
}
pg_status pg_scene_load (pg_scene **out, const char *path) { return pg_scene_load_with (out, path, 0, NULL); }
