/* SPDX-License-Identifier: GPL-3.0-or-later
 * Fields as plain text, result.txt: a line a moment with its number, its time and the largest value of each
 * field. */
#include "disk.h"
#include "entries.h"
#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

typedef struct { const pg_field_request *request; int file; long bytes; char path[4096]; } text;

static void end (void **self)
{
    text *t = *self;
    if (t && t->file >= 0) close (t->file);
    pg_free (t);
    *self = NULL;
}

static pg_status begin (void **self, const pg_field_request *q, const pg_field_marks *at)
{
    pg_status status = PG_OK;
    text *t = NULL;
    PG_ALLOC (t, 1);
    *t = (text) { .request = q, .file = -1, .bytes = at ? at->keep : 0 };
    snprintf (t->path, sizeof t->path, "%.4000s/result.txt", q->folder);
    if (!at) PG_TRY (pg_disk_create (t->path, &t->file));
    else {
        t->file = open (t->path, O_RDWR | O_NOFOLLOW | O_CLOEXEC);
        if (t->file < 0) PG_FAIL (PG_E_FILE, "%s: %s", t->path, strerror (errno));
        PG_TRY (pg_disk_cut (t->path, t->file, at->keep));
    }
    *self = t, t = NULL;
done:
    if (t) end ((void *[]) { t });
    return status;
}

static pg_status write_line (void *self, long moment, double time, const pg_field_view *field)
{
    text *t = self;
    char line[1024];
    int n = snprintf (line, sizeof line, "%ld %.9g", moment, time);
    for (size_t k = 0; k < t->request->nfield; k++) {
        double most = 0;
        for (size_t i = 0; i < t->request->cloud->n * (size_t) field[k].components; i++)
            most = fmax (most, fabs (field[k].value[i]));
        n += snprintf (line + n, sizeof line - (size_t) n, " %s %.9g", field[k].name, most);
    }
    line[n++] = '\n';
    pg_status status = pg_disk_write (t->path, t->file, line, (size_t) n, t->bytes);
    if (status == PG_OK) t->bytes += n;
    return status;
}

static long length (const void *self) { return ((const text *) self)->bytes; }

const pg_writer pg_writer_plain = {
    .name = "plain",
    .summary = "result.txt: the largest value of each field",
    .file = "result.txt",
    .open = begin,
    .step = write_line,
    .keep = length,
    .close = end,
};
