/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tables as CSV (RFC 4180): one row a call, flushed, so that a killed run leaves whole lines. */
#include "perigal/output.h"
#include <errno.h>
#include <stdio.h>
#include <string.h>

struct pg_table { FILE *file; char *path; size_t n; };

static void put_cell (FILE *file, const char *text)
{
    if (!text) return;
    if (!strpbrk (text, ",\"\r\n")) {
        fputs (text, file);
        return;
    }
    fputc ('"', file);
    for (; *text; text++) {
        if (*text == '"') fputc ('"', file);
        fputc (*text, file);
    }
    fputc ('"', file);
}

static pg_status end_row (pg_table *t)
{
    pg_status status = PG_OK;
    errno = 0;
    fputc ('\n', t->file);
    if (fflush (t->file) != 0 || ferror (t->file)) {
        int reason = errno;
        clearerr (t->file);
        PG_FAIL (PG_E_FILE, "%s: %s", t->path, reason ? strerror (reason) : "write failed");
    }
done:
    return status;
}

pg_status pg_table_create (pg_table **out, const char *path, size_t n, const char *const *columns)
{
    pg_status status = PG_OK;
    pg_table *t = NULL;
    *out = NULL;
    PG_ALLOC (t, 1);
    t->n = n;
    t->path = pg_strdup (path);
    if (!t->path) PG_FAIL (PG_E_MEMORY, "no memory for a path");
    errno = 0;
    t->file = fopen (path, "w");
    if (!t->file) PG_FAIL (PG_E_FILE, "%s: %s", path, strerror (errno));
    PG_TRY (pg_table_line (t, columns));
    *out = t;
done:
    if (status != PG_OK) pg_table_close (&t);
    return status;
}

pg_status pg_table_row (pg_table *t, const double *values)
{
    for (size_t k = 0; k < t->n; k++) fprintf (t->file, "%s%.17g", k ? "," : "", values[k]);
    return end_row (t);
}

pg_status pg_table_line (pg_table *t, const char *const *values)
{
    for (size_t k = 0; k < t->n; k++) {
        if (k) fputc (',', t->file);
        put_cell (t->file, values[k]);
    }
    return end_row (t);
}

void pg_table_close (pg_table **table)
{
    if (!table || !*table) return;
    if ((*table)->file) fclose ((*table)->file);
    pg_free ((*table)->path);
    pg_free (*table);
    *table = NULL;
}
