/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tables as CSV (RFC 4180). A row, or several, is collected in memory and goes to the file in
 * one write; if that fails half-way, the file is cut back to the rows before, so that it always
 * ends with a whole row. */
#include "disk.h"
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

/* A table that is open for appending. */
struct pg_table {
    int    file;
    char  *path;
    size_t n;
    /* Rows without the header, and the bytes of all whole rows. */
    long   rows, bytes;
    /* Text of rows that are not written yet (length bytes), the last one perhaps incomplete; waiting: number
     * of complete rows in it. */
    char  *text;
    size_t length, cap;
    long   waiting;
};

/* Rows whose text exceeds this number of bytes do not wait any longer but are written. */
enum { ENOUGH = 1 << 16 };

/* Appends text to the rows that are being collected. */
static pg_status append (pg_table *t, const char *text, size_t length)
{
    pg_status status = PG_OK;
    PG_GROW (t->text, t->cap, t->length + length);
    memcpy (t->text + t->length, text, length);
    t->length += length;
done:
    return status;
}

/* Appends a cell; NULL is an empty one. It is put in quotes (and quotes in it doubled) if it
 * contains commas, quotes or line ends. */
static pg_status append_cell (pg_table *t, const char *text)
{
    pg_status status = PG_OK;
    if (!text) return PG_OK;
    if (!strpbrk (text, ",\"\r\n")) return append (t, text, strlen (text));
    PG_TRY (append (t, "\"", 1));
    for (; *text; text++) {
        if (*text == '"') PG_TRY (append (t, "\"", 1));
        PG_TRY (append (t, text, 1));
    }
    PG_TRY (append (t, "\"", 1));
done:
    return status;
}

/* Ends the row that is being collected. */
static pg_status end_row (pg_table *t)
{
    pg_status status = append (t, "\n", 1);
    if (status == PG_OK) t->waiting++;
    return status;
}

/* Writes all collected rows. If they cannot be written completely, the file is cut back to its previous
 * length. No rows wait afterwards, also after a failure. */
pg_status pg_table_write (pg_table *t)
{
    pg_status status = PG_OK;
    size_t written = 0;
    while (written < t->length) {
        ssize_t n = write (t->file, t->text + written, t->length - written);
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0)
            PG_FAIL (PG_E_FILE, "%s: %s", t->path, n < 0 ? strerror (errno) : "nothing could be written");
        written += (size_t) n;
    }
    t->bytes += (long) t->length, t->rows += t->waiting;
done:
    if (status != PG_OK && written > 0 && ftruncate (t->file, t->bytes) == 0)
        lseek (t->file, t->bytes, SEEK_SET);
    t->length = 0, t->waiting = 0;
    return status;
}

/* Writes the collected rows, or drops them if `status` says that collecting them has failed. */
static pg_status conclude (pg_table *t, pg_status status)
{
    if (status == PG_OK) return pg_table_write (t);
    t->length = 0, t->waiting = 0;
    return status;
}

/* Opens the file: created if `fresh`, else an existing one that is no symbolic link. After a
 * failure nothing is left open. */
static pg_status prepare (pg_table **out, const char *path, int fresh)
{
    pg_status status = PG_OK;
    pg_table *t = NULL;
    PG_ALLOC (t, 1);
    t->file = -1;
    t->path = pg_strdup (path);
    if (!t->path) PG_FAIL (PG_E_MEMORY, "no memory for a path");
    if (fresh) PG_TRY (pg_disk_create (path, &t->file));
    else if ((t->file = open (path, O_RDWR | O_NOFOLLOW | O_CLOEXEC)) < 0)
        PG_FAIL (PG_E_FILE, "%s: %s", path, strerror (errno));
    *out = t;
    t = NULL;
done:
    pg_table_close (&t);
    return status;
}

/* The header is written like a row of texts but does not count as one. */
pg_status pg_table_create (pg_table **out, const char *path, size_t n, const char *const *columns)
{
    pg_status status = PG_OK;
    pg_table *t = NULL;
    *out = NULL;
    PG_TRY (prepare (&t, path, 1));
    t->n = n;
    PG_TRY (pg_table_line (t, columns));
    t->rows = 0;
    *out = t;
done:
    if (status != PG_OK) pg_table_close (&t);
    return status;
}

/* Moves behind the header and `rows` rows and counts their bytes; line ends within quotes do
 * not count. The number of rows begins at -1, so that the header is row 0. PG_E_FILE if there
 * are fewer. */
static pg_status skip_rows (pg_table *t, long rows)
{
    pg_status status = PG_OK;
    char part[4096];
    ssize_t n;
    int quoted = 0;
    t->rows = -1;
    while (t->rows < rows && (n = read (t->file, part, sizeof part)) > 0)
        for (ssize_t k = 0; k < n && t->rows < rows; k++, t->bytes++) {
            if (part[k] == '"') quoted = !quoted;
            t->rows += part[k] == '\n' && !quoted;
        }
    if (t->rows < rows)
        PG_FAIL (PG_E_FILE, "%s has %ld rows of the %ld it had: it was changed since", t->path,
                 t->rows < 0 ? 0 : t->rows, rows);
done:
    return status;
}

/* Collects a row of texts; NULL is an empty cell. */
static pg_status collect (pg_table *t, const char *const *values)
{
    pg_status status = PG_OK;
    for (size_t k = 0; k < t->n; k++) {
        if (k) PG_TRY (append (t, ",", 1));
        PG_TRY (append_cell (t, values[k]));
    }
    PG_TRY (end_row (t));
done:
    return status;
}

/* Compares the first bytes of the file with the header that these columns would have. Rows of other columns
 * behind it would be read under wrong names. */
static pg_status check_header (pg_table *t, const char *const *columns)
{
    pg_status status = PG_OK;
    char *found = NULL;
    size_t n = 0;
    ssize_t got;
    PG_TRY (collect (t, columns));
    PG_ALLOC (found, t->length);
    while (n < t->length && (got = pread (t->file, found + n, t->length - n, (off_t) n)) > 0)
        n += (size_t) got;
    if (n < t->length || memcmp (found, t->text, n) != 0)
        PG_FAIL (PG_E_FILE, "the columns of %s are not those that this run writes (%zu, the first is %s): it "
                            "was changed since, or is of another run", t->path, t->n, columns[0]);
done:
    pg_free (found);
    t->length = 0, t->waiting = 0;
    return status;
}

/* Nothing is cut off before header and rows have been found to be right. */
pg_status pg_table_open (pg_table **out, const char *path, size_t n, const char *const *columns, long rows)
{
    pg_status status = PG_OK;
    pg_table *t = NULL;
    *out = NULL;
    PG_TRY (prepare (&t, path, 0));
    t->n = n;
    PG_TRY (check_header (t, columns));
    PG_TRY (skip_rows (t, rows));
    PG_TRY (pg_disk_cut (path, t->file, t->bytes));
    if (lseek (t->file, t->bytes, SEEK_SET) < 0) PG_FAIL (PG_E_FILE, "%s: %s", path, strerror (errno));
    *out = t;
done:
    if (status != PG_OK) pg_table_close (&t);
    return status;
}

long pg_table_rows (const pg_table *t) { return t->rows; }

/* 17 digits bring every double back as it was, bit for bit. value == value is false for NaN only, which
 * becomes an empty cell. Infinities are written as inf, which readers of CSV understand. */
pg_status pg_table_row (pg_table *t, const double *values)
{
    pg_status status = PG_OK;
    char cell[40];
    for (size_t k = 0; k < t->n; k++) {
        if (k) PG_TRY (append (t, ",", 1));
        if (values[k] == values[k])
            PG_TRY (append (t, cell, (size_t) snprintf (cell, sizeof cell, "%.17g", values[k])));
    }
    PG_TRY (end_row (t));
done:
    return conclude (t, status);
}

/* Writes a row of texts; NULL is an empty cell. */
pg_status pg_table_line (pg_table *t, const char *const *values) { return conclude (t, collect (t, values)); }

/* Rows wait in memory because a system call costs more than the text of a row. */
pg_status pg_table_line_later (pg_table *t, const char *const *values)
{
    pg_status status = collect (t, values);
    return status != PG_OK || t->length > ENOUGH ? conclude (t, status) : PG_OK;
}

pg_status pg_table_sync (const pg_table *t) { return pg_file_sync (t->path); }

/* Rows that still wait are dropped: they belong to output that has failed before it was complete. */
void pg_table_close (pg_table **table)
{
    if (!table || !*table) return;
    if ((*table)->file >= 0) close ((*table)->file);
    pg_free ((*table)->text);
    pg_free ((*table)->path);
    pg_free (*table);
    *table = NULL;
}
