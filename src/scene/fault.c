/* SPDX-License-Identifier: GPL-3.0-or-later
 * Faults of a scene: collected, then reported together in the order of the file. Faults in overrides come
 * after those of the file. Control characters in texts of the user are shown as ?, so that each fault is one
 * line. */
#include "node.h"
#include <ctype.h>
#include <limits.h>
#include <string.h>

/* SHOWN: most faults in a message. KEPT: most faults stored (more are only counted). LINE, VALUE: most bytes
 * of a line and of a value in it. */
enum { SHOWN = 50, KEPT = 1000, LINE = 1200, VALUE = 60 };

/* Copies at most `most` bytes of a text, control characters as ?, cut between characters of UTF-8. */
static void printable (char *out, size_t most, const char *text)
{
    size_t n = 0, length = strlen (text);
    if (length > most) {
        /* Back to the beginning of a character of UTF-8. */
        for (length = most - 3; length > 0 && ((unsigned char) text[length] & 0xC0) == 0x80; length--)
            continue;
    }
    for (; n < length; n++) out[n] = iscntrl ((unsigned char) text[n]) ? '?' : text[n];
    snprintf (out + n, 4, "%s", text[n] ? "..." : "");
}

/* Writes the text of a fault: "file:line:column: key = value: reason", or with the origin of the value
 * (--set) in place of the file. */
static void write_fault (char text[2 * LINE], const char *file, const pg_node *at, const char *path,
                         int with_value, const char *reason)
{
    char value[VALUE + 4] = "", origin[VALUE + 4], clean[LINE + 4], name[LINE / 3 + 4];
    size_t used;
    printable (clean, LINE, reason);
    printable (name, LINE / 3, path);
    if (with_value && at && at->shape == PG_SCALAR && at->text) printable (value, VALUE, at->text);
    if (at && at->origin) {
        printable (origin, VALUE, at->origin);
        used = (size_t) snprintf (text, 2 * LINE, "%s: ", origin);
    } else
        used = (size_t) snprintf (text, 2 * LINE, "%.300s:%d:%d: ", file, at && at->line ? at->line : 1,
                                  at && at->column ? at->column : 1);
    snprintf (text + used, 2 * LINE - used, "%s%s%s%s%s", name, *value ? " = " : "", value, *name ? ": " : "",
              clean);
}

/* If there is no memory for a fault, the verdict becomes PG_E_MEMORY, so that a wrong scene never passes. */
void pg_faults_add_v (pg_faults *f, const char *file, const pg_node *at, const char *path, int with_value,
                      const char *format, va_list args)
{
    char text[2 * LINE], reason[LINE];
    pg_status status = PG_OK;
    if (!path) path = "";
    if (f->n == KEPT) {
        f->more++;
        return;
    }
    vsnprintf (reason, sizeof reason, format, args);
    write_fault (text, file, at, path, with_value, reason);
    PG_GROW (f->fault, f->cap, f->n + 1);
    pg_fault *fault = &f->fault[f->n];
    /* faults of overrides come after those of the file */
    *fault = (pg_fault) { .text = pg_strdup (text), .line = at && at->line ? at->line : 1,
                          .column = at && at->column ? at->column : 1 };
    if (at && at->origin) fault->line = INT_MAX;
    snprintf (fault->top, sizeof fault->top, "%.*s", (int) strcspn (path, ".["), path);
    if (fault->text) f->n++;
    else f->lost = 1;
done:
    if (status != PG_OK) f->lost = 1;
}

void pg_faults_add (pg_faults *f, const char *file, const pg_node *at, const char *path, int with_value,
                    const char *format, ...)
{
    va_list args;
    va_start (args, format);
    pg_faults_add_v (f, file, at, path, with_value, format, args);
    va_end (args);
}

/* Order of faults: by line, then by column. */
static int before (const pg_fault *a, const pg_fault *b)
{
    return a->line != b->line ? a->line < b->line : a->column < b->column;
}

/* Stable insertion sort. */
static void sort (pg_fault *fault, size_t n)
{
    for (size_t i = 1; i < n; i++) {
        pg_fault moving = fault[i];
        size_t k = i;
        for (; k > 0 && before (&moving, &fault[k - 1]); k--) fault[k] = fault[k - 1];
        fault[k] = moving;
    }
}

/* One line per fault, as many as fit. */
pg_status pg_faults_verdict (const pg_faults *f)
{
    char text[15000];
    size_t used = 0, k = 0;
    if (f->lost) return pg_error (PG_E_MEMORY, PG_HERE, "no memory for the faults of the scene");
    if (f->n == 0) return PG_OK;
    sort (f->fault, f->n);
    /* Faults are shown as long as they fit into the message, SHOWN at most. */
    for (; k < f->n && k < SHOWN; k++) {
        size_t length = strlen (f->fault[k].text);
        if (used + length + 2 > sizeof text) break;
        used += (size_t) snprintf (text + used, sizeof text - used, "%s%s", k ? "\n" : "", f->fault[k].text);
    }
    if (k < f->n) return pg_error (PG_E_SCENE, PG_HERE, "%s\n... and %zu more", text, f->n - k + f->more);
    return pg_error (PG_E_SCENE, PG_HERE, "%s", text);
}

void pg_faults_clear (pg_faults *f)
{
    for (size_t k = 0; k < f->n; k++) pg_free (f->fault[k].text);
    pg_free (f->fault);
    *f = (pg_faults) { 0 };
}
