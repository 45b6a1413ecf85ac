/* SPDX-License-Identifier: GPL-3.0-or-later
 * Writes JSON (RFC 8259) with two blanks per level and the keys in the order of the calls.
 * Faults are remembered and reported once, by pg_json_close, so that callers need not test
 * every line; only a text without fault is moved from PATH.tmp to PATH. The outermost braces
 * may be opened by the caller; otherwise the first key opens them. */
#include "perigal/output.h"
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Largest number of levels. */
enum { DEPTH = 32 };

/* A JSON text that is being written. misuse: 1 once a call was not allowed where it came; bracket: '{' or '['
 * of each open level (depth of them). */
struct pg_json {
    FILE *file;
    char *path, *temporary;
    int   depth, misuse;
    char  bracket[DEPTH];
    /* Members written so far on each level. */
    int   count[DEPTH + 1];
};

/* Length of a UTF-8 sequence by its first byte; 0: no sequence begins with it. */
static int length_of (unsigned char first)
{
    static const struct { unsigned char low, high; int length; } ranges[] = {
        { 0x00, 0x7f, 1 }, { 0xc2, 0xdf, 2 }, { 0xe0, 0xef, 3 }, { 0xf0, 0xf4, 4 }
    };
    for (size_t k = 0; k < sizeof ranges / sizeof *ranges; k++)
        if (first >= ranges[k].low && first <= ranges[k].high) return ranges[k].length;
    return 0;
}

/* Bytes of the valid UTF-8 sequence at p (RFC 3629), 0 when it is none. After four of the first bytes the
 * second one has a narrower range: shorter forms exist, or the code point would be a surrogate or beyond
 * U+10FFFF. */
static int sequence (const unsigned char *p)
{
    static const struct { unsigned char first, low, high; } second[] = {
        { 0xe0, 0xa0, 0xbf }, { 0xed, 0x80, 0x9f }, { 0xf0, 0x90, 0xbf }, { 0xf4, 0x80, 0x8f }
    };
    int n = length_of (p[0]);
    for (int k = 1; k < n; k++) if ((p[k] & 0xc0) != 0x80) return 0;
    for (size_t k = 0; k < sizeof second / sizeof *second; k++)
        if (p[0] == second[k].first && (p[1] < second[k].low || p[1] > second[k].high)) return 0;
    return n;
}

/* Writes a text in quotes with the escapes that JSON demands, and DEL; invalid UTF-8 becomes
 * U+FFFD, byte by byte. */
static void put_string (FILE *file, const char *text)
{
    fputc ('"', file);
    for (const unsigned char *p = (const unsigned char *) text; *p; ) {
        int n = sequence (p);
        const char *found = strchr ("\"\"\\\\\nn\tt\rr\bb\ff", *p);
        if (n == 0) fputs ("\\ufffd", file), n = 1;
        else if (*p == '"' || *p == '\\') fputc ('\\', file), fputc (*p, file);
        else if (*p < 0x20 && found) fputc ('\\', file), fputc (found[1], file);
        else if (*p < 0x20 || *p == 0x7f) fprintf (file, "\\u%04x", *p);
        else fwrite (p, 1, (size_t) n, file);
        p += n;
    }
    fputc ('"', file);
}

/* Writes what comes before a value: a comma unless it is the first one on its level, a new
 * line, the key. Returns 0 if no value may stand here: a key inside a list, none inside an
 * object, a second value at the top. */
static int begin (pg_json *j, const char *key)
{
    if (!j) return 0;
    if (j->depth == 0 && key && j->count[0] == 0) pg_json_open (j, NULL, '{');
    int in_map = j->depth > 0 && j->bracket[j->depth - 1] == '{';
    if (j->misuse || in_map != (key != NULL) || (j->depth == 0 && j->count[0] > 0)) {
        j->misuse = 1;
        return 0;
    }
    if (j->count[j->depth]++ > 0) fputc (',', j->file);
    if (j->depth > 0) fprintf (j->file, "\n%*s", 2 * j->depth, "");
    if (key) {
        put_string (j->file, key);
        fputs (": ", j->file);
    }
    return 1;
}

/* Nothing is visible under PATH before pg_json_close has succeeded. */
pg_status pg_json_create (pg_json **out, const char *path)
{
    pg_status status = PG_OK;
    pg_json *j = NULL;
    size_t size = strlen (path) + 5;
    *out = NULL;
    PG_ALLOC (j, 1);
    PG_ALLOC (j->temporary, size);
    j->path = pg_strdup (path);
    if (!j->path) PG_FAIL (PG_E_MEMORY, "no memory for a path");
    snprintf (j->temporary, size, "%s.tmp", path);
    PG_TRY (pg_file_create (&j->file, j->temporary));
    *out = j;
    j = NULL;
done:
    if (j) pg_free (j->path), pg_free (j->temporary), pg_free (j);
    return status;
}

/* Levels are counted from 1; bracket[depth - 1] is the innermost one. */
void pg_json_open (pg_json *j, const char *key, char bracket)
{
    if (!begin (j, key)) return;
    if (j->depth == DEPTH || (bracket != '{' && bracket != '[')) {
        j->misuse = 1;
        return;
    }
    fputc (bracket, j->file);
    j->bracket[j->depth++] = bracket;
    j->count[j->depth] = 0;
}

/* An empty list or object stays on one line. One call too many is a fault of use. */
void pg_json_shut (pg_json *j)
{
    if (!j || j->misuse) return;
    if (j->depth == 0) {
        j->misuse = 1;
        return;
    }
    int empty = j->count[j->depth--] == 0;
    if (!empty) fprintf (j->file, "\n%*s", 2 * j->depth, "");
    fputc (j->bracket[j->depth] == '{' ? '}' : ']', j->file);
}

/* 15 digits are enough for most doubles; 17 always give the same double back. */
void pg_json_number (pg_json *j, const char *key, double value)
{
    char text[40];
    if (!begin (j, key)) return;
    if (!isfinite (value)) {
        fputs ("null", j->file);
        return;
    }
    for (int digits = 15; digits <= 17; digits++) {
        snprintf (text, sizeof text, "%.*g", digits, value);
        if (strtod (text, NULL) == value) break;
    }
    fputs (text, j->file);
}

/* Counts are written as integers, never with an exponent. */
void pg_json_count (pg_json *j, const char *key, size_t value)
{
    if (begin (j, key)) fprintf (j->file, "%zu", value);
}

/* NULL becomes null, so that optional texts need no test. */
void pg_json_text (pg_json *j, const char *key, const char *value)
{
    if (!begin (j, key)) return;
    if (value) put_string (j->file, value);
    else fputs ("null", j->file);
}

/* Brackets that are still open are closed. The text is synced to the disk before the rename:
 * otherwise a crash of the system could leave an empty file under the final name. After any
 * fault PATH.tmp is removed and PATH is what it was. */
pg_status pg_json_close (pg_json **json)
{
    pg_status status = PG_OK;
    if (!json || !*json) return PG_OK;
    pg_json *j = *json;
    while (j->depth > 0 && !j->misuse) pg_json_shut (j);
    fputc ('\n', j->file);
    errno = 0;
    int bad = fflush (j->file) != 0 || ferror (j->file);
    if (!bad) fsync (fileno (j->file));
    int reason = errno;
    if (fclose (j->file) != 0 && !bad) bad = 1, reason = errno;
    if (j->misuse) PG_FAIL (PG_E_USAGE, "%s: brackets, keys or lists do not match", j->path);
    if (bad) PG_FAIL (PG_E_FILE, "%s: %s", j->temporary, reason ? strerror (reason) : "write failed");
    if (rename (j->temporary, j->path) != 0) PG_FAIL (PG_E_FILE, "%s: %s", j->path, strerror (errno));
done:
    if (status != PG_OK) remove (j->temporary);
    pg_free (j->path);
    pg_free (j->temporary);
    pg_free (j);
    *json = NULL;
    return status;
}
