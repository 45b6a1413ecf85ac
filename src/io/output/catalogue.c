/* SPDX-License-Identifier: GPL-3.0-or-later
 * The catalogue of writers of fields: the entries of list.h as a table and as a string of names. */
#include "entries.h"
#include <stdio.h>
#include <string.h>
#include <unistd.h>

static const pg_writer *const table[] = {
#define PG_WRITER(name) &pg_writer_##name,
#include "list.h"
#undef PG_WRITER
};
enum { COUNT = sizeof table / sizeof *table };

static const char names[] =
#define PG_WRITER(name) "|" #name
#include "list.h"
#undef PG_WRITER
    ;

const pg_writer *pg_writer_find (const char *name)
{
    for (size_t i = 0; name && i < COUNT; i++) if (strcmp (table[i]->name, name) == 0) return table[i];
    return NULL;
}

const char *pg_writer_names (void) { return names + 1; }

void pg_writer_clear (const pg_writer *own, const char *folder, int keep)
{
    char path[4096];
    for (size_t i = 0; i < COUNT; i++) {
        snprintf (path, sizeof path, "%s/%s", folder, table[i]->file);
        if (table[i]->clear) table[i]->clear (folder, table[i] == own ? keep : -1);
        else if (table[i] != own) remove (path);
    }
}

pg_status pg_writer_readable (const char *folder)
{
    char path[4096];
    for (size_t i = 0; i < COUNT; i++) {
        snprintf (path, sizeof path, "%.3800s/%s", folder, table[i]->file);
        if (!table[i]->read && access (path, F_OK) == 0)
            return pg_error (PG_E_USAGE, PG_HERE,
                             "%s is for other programs (output.format: %s), and this one cannot read it: run "
                             "the scene with output.format: %s", path, table[i]->name, table[0]->name);
    }
    return PG_OK;
}

pg_status pg_writer_complete (const char *folder)
{
    pg_status status = PG_OK;
    for (size_t i = 0; i < COUNT; i++)
        if (table[i]->finish) PG_TRY (table[i]->finish (folder, NULL, 1));
done:
    return status;
}
