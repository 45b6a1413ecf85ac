/* SPDX-License-Identifier: GPL-3.0-or-later
 * The table of solvers, what is true of each, and the keys of a scene that belong to each. */
#include "solve.h"
#include <stdio.h>
#include <string.h>

#define PG_SOLVER(name) extern const pg_solver_type pg_solver_##name;
#include "list.h"
#undef PG_SOLVER

static const pg_solver_type *const entries[] = {
#define PG_SOLVER(name) &pg_solver_##name,
#include "list.h"
#undef PG_SOLVER
};
enum { COUNT = sizeof entries / sizeof *entries };

const pg_solver_type *pg_solver_find (const char *name)
{
    for (size_t i = 0; i < COUNT; i++) if (strcmp (entries[i]->name, name) == 0) return entries[i];
    return NULL;
}

/* Without a kind the first of the list is meant, which is the default of solver.kind. */
unsigned pg_solver_flags (const char *kind)
{
    const pg_solver_type *type = kind ? pg_solver_find (kind) : entries[0];
    return type ? type->flags : 0;
}

int pg_solver_is (const char *kind, unsigned flags) { return (pg_solver_flags (kind) & flags) == flags; }

/* Appends a name to a list in a text of `size` bytes. */
static void append (char *text, size_t size, const char *joint, const char *name)
{
    size_t used = strlen (text);
    snprintf (text + used, size - used, "%s%s", used ? joint : "", name);
}

/* The names are joined once, when they are first asked for. */
const char *pg_solver_names (void)
{
    static char names[256];
    char text[256] = "";
    if (names[0]) return names;
    for (size_t i = 0; i < COUNT; i++) append (text, sizeof text, "|", entries[i]->name);
    memcpy (names, text, sizeof names);
    return names;
}

void solver_names_that (int (*fits) (const pg_solver_type *type, const void *context), const void *context,
                        char *text, size_t size)
{
    text[0] = '\0';
    for (size_t i = 0; i < COUNT; i++)
        if (fits (entries[i], context)) append (text, size, ", ", entries[i]->name);
}

/* ---- keys ---------------------------------------------------------------------------------------------- */
static const char *name_of (size_t i) { return i < COUNT ? entries[i]->name : NULL; }
static pg_key_tables keys_of (size_t i) { return entries[i]->keys; }
static unsigned flags_of (size_t i) { return entries[i]->flags; }

const pg_key_catalogue pg_entry_keys_solve = {
    .selector = "solver.kind", .name = name_of, .keys = keys_of, .flags = flags_of
};
