/* SPDX-License-Identifier: GPL-3.0-or-later
 * What a result folder says about its run: the scene it was made with, and the row of history.csv that
 * belongs to a step of result.e. */
#include "compare.h"
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_SETTINGS = 64 };

pg_status compare_load_text (const char *path, char **text)
{
    pg_status status = PG_OK;
    size_t size = 0, cap = 0, got = 0;
    FILE *f = fopen (path, "rb");
    *text = NULL;
    if (!f) PG_FAIL (PG_E_FILE, "%s: %s", path, strerror (errno));
    do {
        PG_GROW (*text, cap, size + 65537);
        got = fread (*text + size, 1, 65536, f);
        if (memchr (*text + size, 0, got)) PG_FAIL (PG_E_FILE, "%s is not a text file", path);
        size += got;
    } while (got > 0);
    if (ferror (f)) PG_FAIL (PG_E_FILE, "%s: %s", path, strerror (errno));
    (*text)[size] = 0;
done:
    if (f) fclose (f);
    if (status != PG_OK) pg_free (*text), *text = NULL;
    return status;
}

/* ---- scene --------------------------------------------------------------------------------------------- */
/* Value of a text key of report.json; "" when there is none. */
static pg_status report_text (const char *folder, const char *key, char *out, size_t size)
{
    char path[4096], wanted[64], *text = NULL;
    size_t n = 0;
    out[0] = 0;
    snprintf (path, sizeof path, "%s/report.json", folder);
    pg_status status = compare_load_text (path, &text);
    if (status != PG_OK) return status == PG_E_FILE ? PG_OK : status;
    snprintf (wanted, sizeof wanted, "\"%s\": \"", key);
    const char *s = strstr (text, wanted);
    for (s = s ? s + strlen (wanted) : ""; *s && *s != '"' && n + 1 < size; s++) {
        if (*s == '\\' && s[1]) s++;
        out[n++] = *s;
    }
    out[n] = 0;
    pg_free (text);
    return PG_OK;
}

/* The last line of the text, cut off it, if it begins with the mark: what follows that; NULL. */
static char *cut_line (char *text, const char *mark)
{
    size_t length = strlen (text);
    if (length && text[length - 1] == '\n') length--;
    size_t start = length;
    while (start > 0 && text[start - 1] != '\n') start--;
    if (strncmp (text + start, mark, strlen (mark)) != 0) return NULL;
    text[length] = 0;
    text[start] = 0;                                   /* the line before ends here */
    return text + start + strlen (mark);
}

/* Takes what a run added off its copy of a scene: where that was (NULL: not said), settings in the order of
 * the file. */
static size_t cut_settings (char *text, char **set, const char **from)
{
    size_t n = 0;
    while (n < MOST_SETTINGS && (set[n] = cut_line (text, "# --set "))) n++;
    while (cut_line (text, "# with ")) continue;
    if ((*from = cut_line (text, "# copied by perigal run from "))) {
        size_t length = strlen (text);
        if (length) text[length - 1] = 0;              /* the line end before the mark */
    }
    for (size_t k = 0; k < n / 2; k++) {
        char *other = set[k];
        set[k] = set[n - 1 - k], set[n - 1 - k] = other;
    }
    return n;
}

pg_status pg_stored_scene (pg_scene **out, const char *folder)
{
    pg_status status = PG_OK;
    char path[4096], name[3072], *text = NULL, *set[MOST_SETTINGS];
    const char *from;
    *out = NULL;
    snprintf (path, sizeof path, "%s/scene.yaml", folder);
    PG_TRY (compare_load_text (path, &text));
    PG_TRY (report_text (folder, "scene", name, sizeof name));
    size_t n = cut_settings (text, set, &from);
    PG_TRY (pg_scene_parse_with (out, text,
                                 from      ? from
                                 : name[0] ? name
                                           : path,
                                 n, (const char *const *) set));
done:
    pg_free (text);
    return status;
}

/* ---- history ------------------------------------------------------------------------------------------- */
static const char *cell_of (const char *row, size_t column)
{
    for (; column > 0; column--) {
        row += strcspn (row, ",\n");
        if (*row != ',') return "";
        row++;
    }
    return row;
}

static long column_of (const char *header, const char *name)
{
    const char *s = header;
    for (long k = 0;; k++) {
        if (strncmp (s, name, strlen (name)) == 0 && s[strlen (name)] == ' ') return k;
        s += strcspn (s, ",\n");
        if (*s++ != ',') return -1;
    }
}

pg_status compare_history (const char *folder, const char *key, double stamp, double *load_factor,
                           double *time, double *broken)
{
    pg_status status = PG_OK;
    char path[4096], *text = NULL;
    static const char *const names[3] = { "load_factor", "time", "broken" };
    double *const out[3] = { load_factor, time, broken };
    snprintf (path, sizeof path, "%s/history.csv", folder);
    PG_TRY (compare_load_text (path, &text));
    long at = column_of (text, key);
    if (at < 0) PG_FAIL (PG_E_FILE, "%s has no column %s", path, key);
    for (const char *row = strchr (text, '\n'); row && row[1]; row = strchr (row + 1, '\n')) {
        if (strtod (cell_of (row + 1, (size_t) at), NULL) > stamp + 1e-12 * fabs (stamp)) break;
        for (int k = 0; k < 3; k++) {
            long c = column_of (text, names[k]);
            if (c >= 0) *out[k] = strtod (cell_of (row + 1, (size_t) c), NULL);
        }
    }
done:
    pg_free (text);
    return status;
}
