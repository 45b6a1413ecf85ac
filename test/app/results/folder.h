/* SPDX-License-Identifier: GPL-3.0-or-later
 * folder.h: temporary result folders, files as text, cells of a CSV file, values of a JSON file. */
#ifndef PERIGAL_TEST_FOLDER_H
#define PERIGAL_TEST_FOLDER_H
#include "scene_runs/run.h"
#include <sys/stat.h>

static inline void make_folder (char folder[64])
{
    strcpy (folder, "/tmp/perigal_test_XXXXXX");
    assert_non_null (mkdtemp (folder));
}

static inline void remove_folder (const char *folder)
{
    char command[128];
    assert_int_equal (strncmp (folder, "/tmp/perigal_test_", 18), 0);
    snprintf (command, sizeof command, "rm -r %s", folder);
    assert_int_equal (system (command), 0);
}

static inline const char *inside (const char *folder, const char *name)
{
    static char path[256];
    snprintf (path, sizeof path, "%s/%s", folder, name);
    return path;
}

static inline long size_of (const char *path)
{
    struct stat s;
    return stat (path, &s) == 0 ? (long) s.st_size : -1;
}

static inline char *slurp (const char *path)           /* to be freed with pg_free */
{
    FILE *file = fopen (path, "r");
    if (!file) print_error ("no file %s\n", path);
    assert_non_null (file);
    char *text = pg_calloc ((size_t) size_of (path) + 1, 1);
    text[fread (text, 1, (size_t) size_of (path), file)] = 0;
    fclose (file);
    return text;
}

/* ---- CSV: row 0 is the header -------------------------------------------------------------------------- */
static inline size_t count_lines (const char *text)
{
    size_t n = 0;
    for (; *text; text++) n += *text == '\n';
    return n;
}

static inline const char *cell (const char *text, size_t row, size_t column)
{
    static char out[128];
    for (; row > 0; row--) text = strchr (text, '\n') + 1;
    for (; column > 0; column--) text += strcspn (text, ",\n") + 1;
    snprintf (out, sizeof out, "%.*s", (int) strcspn (text, ",\n"), text);
    return out;
}

static inline size_t column_of (const char *text, const char *name)
{
    size_t n = 1;
    for (const char *c = text; *c && *c != '\n'; c++) n += *c == ',';
    for (size_t k = 0; k < n; k++) if (strcmp (cell (text, 0, k), name) == 0) return k;
    print_error ("no column '%s'\n", name);
    fail ();
    return 0;
}

static inline double number_at (const char *text, size_t row, const char *column)
{
    return strtod (cell (text, row, column_of (text, column)), NULL);
}

/* ---- JSON: where the value of a key starts; the keys are unique in their map, map NULL: at the top ----- */
static inline const char *json_value (const char *text, const char *map, const char *key)
{
    char quoted[80];
    if (map) {
        snprintf (quoted, sizeof quoted, "\"%s\":", map);
        text = strstr (text, quoted);
        if (!text) return NULL;
    }
    snprintf (quoted, sizeof quoted, "\"%s\":", key);
    const char *at = strstr (text, quoted);
    return at ? at + strlen (quoted) + strspn (at + strlen (quoted), " \n") : NULL;
}

static inline double json_number (const char *text, const char *map, const char *key)
{
    const char *at = json_value (text, map, key);
    if (!at) print_error ("report.json lacks %s\n", key);
    assert_non_null (at);
    return strtod (at, NULL);
}
#endif
