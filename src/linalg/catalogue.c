/* SPDX-License-Identifier: GPL-3.0-or-later
 * The catalogue of linear solvers: the entries of list.h as a table and as a string of names. */
#include "failed_row.h"
#include "perigal/linalg.h"
#include <stdio.h>
#include <string.h>

/* Each pass over list.h gives the macro another meaning: declarations, table, names. */
#define PG_LINEAR(name) extern const pg_linear_type pg_linear_##name;
#include "list.h"
#undef PG_LINEAR

static const pg_linear_type *const entries[] = {
#define PG_LINEAR(name) &pg_linear_##name,
#include "list.h"
#undef PG_LINEAR
};

/* The solver that a program has added (NULL: none), and the names of all solvers, this one first. */
static const pg_linear_type *added;
static char all_names[200];

const pg_linear_type *pg_linear_usual (int symmetric, int factors)
{
    if (added && added->symmetric == symmetric && added->factors == factors) return added;
    return pg_linear_first (symmetric, factors);
}

const pg_linear_type *pg_linear_find (const char *name)
{
    if (name && added && strcmp (added->name, name) == 0) return added;
    for (size_t i = 0; i < sizeof entries / sizeof *entries; i++)
        if (name && strcmp (entries[i]->name, name) == 0) return entries[i];
    return NULL;
}

const pg_linear_type *pg_linear_first (int symmetric, int factors)
{
    for (size_t i = 0; i < sizeof entries / sizeof *entries; i++)
        if (entries[i]->symmetric == symmetric && entries[i]->factors == factors) return entries[i];
    return NULL;
}

/* The unknown at which the last failed factorisation on this thread stopped, for messages; -1: none has. */
static _Thread_local long failed_row = -1;
long pg_linear_failed_row (void) { return failed_row; }
void linear_failed_at (long row) { failed_row = row; }

/* "auto" is no entry: the solver of the scene chooses one. */
static const char names[] = ""
#define PG_LINEAR(name) #name "|"
#include "list.h"
#undef PG_LINEAR
    "auto";

void pg_linear_add (const pg_linear_type *type)
{
    added = type;
    if (added) snprintf (all_names, sizeof all_names, "%s|%s", added->name, names);
}

const char *pg_linear_names (void) { return added ? all_names : names; }
