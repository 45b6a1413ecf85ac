/* SPDX-License-Identifier: GPL-3.0-or-later
 * The table of solvers, the flags of each, and the keys of a scene that belong to each. */
#include "solve/run/solve.h"
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

/* The flags of a kind; NULL: of the first in the list, which is the default of solver.kind. */
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

#define ROW PG_SOLVER_KEY
static const pg_key keys[] = {
    { "solver.kind", PG_NAME, NULL, NULL, PG_FIRST_CHOICE, NULL, pg_solver_names, NULL,
      "The method that advances the state." },
    ROW ("solver.max_events", PG_INTEGER, NULL, "[1, 1000000000]", "1000000", NULL,
         "Event stepping ends after so many events; explicit dynamics after so many time steps with "
         "breaking bonds."),
    ROW ("solver.plain", PG_BOOL, NULL, NULL, "off", NULL,
         "Switches every shortcut off that spares work without changing the answer (what a run skips, it "
         "says): slower, for comparison. perigal run --plain is the same."),
    ROW ("solver.stop.set", PG_NAME, NULL, NULL, "", "sets.{}|left|right|bottom|top|back|front|all",
         "The run ends when the crack arrives at a point of this set."),
    ROW ("solver.stop.damage", PG_NUMBER, "1", "(0, 1]", "50 %", NULL,
         "Damage of a point of stop.set that counts as arrival."),
    ROW ("output.at.levels", PG_INTEGER, NULL, "[1, 1000000]", "20", NULL,
         "Fields are written at this many equal levels of load (quasi-static solvers) or time."),
    ROW ("output.at.rows", PG_INTEGER, NULL, "[1, 1000000]", "", NULL,
         "Explicit dynamics, and hold: off: largest number of rows of history.csv (at least one for each "
         "level); if not given one for every ten time steps, 100 to 1000."),
};
const pg_key_table pg_keys_solve = { "solve", keys, sizeof keys / sizeof *keys };
