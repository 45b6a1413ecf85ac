/* SPDX-License-Identifier: GPL-3.0-or-later
 * What a result folder says about its run: the scene that it was made with, and the row of
 * history.csv that belongs to a step of result.e. `perigal run` copies the scene into the
 * folder and appends comment lines with its origin and with the --set options; both are taken
 * off here and applied again. */
#include "app/compare/compare.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Largest number of --set options that are read back. */
enum { MOST_SETTINGS = 64 };

/* ---- scene --------------------------------------------------------------------------------------------- */
/* Value of four hexadecimal digits, as after \u; -1: there are none. */
static long four_digits (const char *s)
{
    long value = 0;
    for (int k = 0; k < 4; k++) {
        const char *digits = "0123456789abcdef", *found = s[k] ? strchr (digits, s[k] | 0x20) : NULL;
        if (!found) return -1;
        value = 16 * value + (found - digits);
    }
    return value;
}

/* Writes a code point in UTF-8 (RFC 3629); returns the number of bytes, 1 to 4. */
static size_t put_code (char *out, long code)
{
    size_t n = code < 0x80 ? 1 : code < 0x800 ? 2 : code < 0x10000 ? 3 : 4;
    static const unsigned char first[] = { 0, 0x00, 0xc0, 0xe0, 0xf0 };
    for (size_t k = n; k-- > 1; code >>= 6) out[k] = (char) (0x80 | (code & 0x3f));
    out[0] = (char) (first[n] | code);
    return n;
}

/* Returns the code point of a JSON escape (RFC 8259 section 7): \n, \u00e9, or two \u that are a surrogate
 * pair. *s is behind the backslash and is moved behind the escape. -1: JSON has no such escape. */
static long escape (const char **s)
{
    static const char letters[] = "\"\\/bfnrt", meant[] = "\"\\/\b\f\n\r\t";
    char letter = *(*s)++;
    const char *found = letter ? strchr (letters, letter) : NULL;
    if (found) return meant[found - letters];
    long code = letter == 'u' ? four_digits (*s) : -1;
    if (code < 0) return -1;
    *s += 4;
    if (code < 0xd800 || code > 0xdfff) return code;
    long low = (*s)[0] == '\\' && (*s)[1] == 'u' ? four_digits (*s + 2) : -1;
    if (code > 0xdbff || low < 0xdc00 || low > 0xdfff) return -1;
    *s += 6;
    return 0x10000 + ((code - 0xd800) << 10) + (low - 0xdc00);
}

/* Decodes a JSON string that begins at s, after its quote. 0: it is no such string, holds a zero byte, or
 * does not fit. */
static int unescape (const char *s, char *out, size_t size)
{
    size_t n = 0;
    while (*s != '"') {
        long code = -1;
        if (*s != '\\') code = (unsigned char) *s;
        if (code == 0 || n + 5 > size) return 0;
        if (code > 0) {
            out[n++] = *s++;                           /* UTF-8 passes byte by byte */
            continue;
        }
        s++;
        code = escape (&s);
        if (code <= 0) return 0;
        n += put_code (out + n, code);
    }
    out[n] = 0;
    return 1;
}

/* Value of a text key of report.json at any level, "" if there is none or no such file. This is no JSON
 * reader: it relies on the form that our own writer gives ("key": "value"). A quote inside a string has a
 * backslash before it, so that no text of the report looks like a key. */
static pg_status report_text (const char *folder, const char *key, char *out, size_t size)
{
    pg_status status = PG_OK;
    char path[4096], wanted[64], *text = NULL;
    out[0] = 0;
    snprintf (path, sizeof path, "%s/report.json", folder);
    status = pg_compare_load_text (path, &text);
    if (status != PG_OK) return status == PG_E_FILE ? PG_OK : status;
    snprintf (wanted, sizeof wanted, "\"%s\": \"", key);
    const char *s = strstr (text, wanted);
    if (s && !unescape (s + strlen (wanted), out, size))
        PG_FAIL (PG_E_FILE, "%s: the text of \"%s\" is no text of JSON, or too long", path, key);
done:
    pg_free (text);
    return status;
}

/* If the last line of the text begins with the mark, cuts it off the text and returns what
 * follows the mark; otherwise NULL. The returned text stays inside the buffer. */
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

/* Removes what `perigal run` appended to the text: *from becomes the path of the original
 * scene (NULL if not noted), set the --set options in the order in which they were given.
 * Lines are removed from the end, so the order is reversed at last. Returns the number of
 * options. */
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

/* Loads the scene of a result folder. The copy is parsed as if it stood in the folder of the original, to
 * which relative file names in it refer: noted in the copy, or in older folders in report.json; the copy
 * itself is the last resort. */
pg_status pg_stored_scene (pg_scene **out, const char *folder)
{
    pg_status status = PG_OK;
    char path[4096], name[3072], *text = NULL, *set[MOST_SETTINGS];
    const char *from;
    *out = NULL;
    snprintf (path, sizeof path, "%s/scene.yaml", folder);
    PG_TRY (pg_compare_load_text (path, &text));
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
/* Reads the last row of history.csv that is not later than `stamp`; its rows are in the order of time. */
pg_status pg_compare_history (const char *folder, const char *key, double stamp, double *load_factor,
                              double *time, double *broken)
{
    pg_status status = PG_OK;
    char path[4096];
    static const char *const names[3] = { "load_factor", "time", "broken" };
    double *const out[3] = { load_factor, time, broken };
    pg_csv csv = { 0 };
    snprintf (path, sizeof path, "%s/history.csv", folder);
    PG_TRY (pg_csv_read (&csv, path));
    long at = pg_csv_column (&csv, key);
    if (at < 0) PG_FAIL (PG_E_FILE, "%s has no column %s", path, key);
    for (size_t r = 0; r < csv.nrow; r++) {
        const double *row = csv.value + r * csv.ncolumn;
        if (row[at] > stamp + 1e-12 * fabs (stamp)) break;
        for (int k = 0; k < 3; k++) {
            long c = pg_csv_column (&csv, names[k]);
            if (c >= 0) *out[k] = row[c];
        }
    }
done:
    pg_csv_clear (&csv);
    return status;
}
