/* SPDX-License-Identifier: GPL-3.0-or-later
 * The catalogue of influence functions: the entries of list.h as a table and as a string of names. */
#include "entries.h"
#include <string.h>

static const pg_kernel *const table[] = {
#define PG_KERNEL(name) &pg_kernel_##name,
#include "list.h"
#undef PG_KERNEL
};

static const char names[] =
#define PG_KERNEL(name) "|" #name
#include "list.h"
#undef PG_KERNEL
    ;

const pg_kernel *pg_kernel_entry (size_t i)
{
    return i < sizeof table / sizeof *table ? table[i] : NULL;
}

const pg_kernel *pg_kernel_find (const char *name)
{
    for (size_t i = 0; name && pg_kernel_entry (i); i++)
        if (strcmp (table[i]->name, name) == 0) return table[i];
    return NULL;
}

const char *pg_kernel_names (void) { return names + 1; }
