/* SPDX-License-Identifier: GPL-3.0-or-later
 * The key tables of all folders and of the entries of their catalogues, from list.h: gathered once, then
 * constant. */
#include "perigal/scene.h"
#include <pthread.h>
#include <string.h>

#define PG_KEYS(folder) extern const pg_key_table pg_keys_##folder;
#define PG_ENTRY_KEYS(folder) extern const pg_key_catalogue pg_entry_keys_##folder;
#include "list.h"
#undef PG_KEYS
#undef PG_ENTRY_KEYS

enum { MOST_TABLES = 96, MOST_TWINS = 64, NAMES = 240, TWIN_PATH = 96, TWIN_DOC = 160 };

static pg_key_table tables[MOST_TABLES];
static size_t ntable;
static pthread_once_t once = PTHREAD_ONCE_INIT;

/* Whose the table of the same number is: the rows as their entry declares them, its catalogue, and the names
 * of all entries that share the table, "adr|relax". A table of a folder has none of these. */
static struct {
    const pg_key *declared;
    const pg_key_catalogue *catalogue;
    char names[NAMES];
} owner[MOST_TABLES];

/* Rows once more for the second place at which a catalogue takes the keys of its entries
 * (pg_key_catalogue.also). */
static pg_key twin[MOST_TWINS];
static struct { char path[TWIN_PATH], doc[TWIN_DOC]; } twin_text[MOST_TWINS];
static size_t ntwin;

/* Beyond MOST_TABLES tables are dropped. */
static void add_table (const pg_key_table *table, const pg_key *declared, const pg_key_catalogue *catalogue,
                       const char *name)
{
    if (ntable == MOST_TABLES) return;
    owner[ntable].declared = declared, owner[ntable].catalogue = catalogue;
    snprintf (owner[ntable].names, NAMES, "%s", name);
    tables[ntable++] = *table;
}

/* "failure.cohesion" becomes "materials.{}.failure.cohesion". */
static pg_key_table twins_of (const pg_key_table *table, const pg_key_catalogue *catalogue)
{
    size_t first = ntwin;
    for (size_t k = 0; k < table->n && ntwin < MOST_TWINS; k++, ntwin++) {
        snprintf (twin_text[ntwin].path, TWIN_PATH, "%s%s", catalogue->also, table->key[k].path);
        snprintf (twin_text[ntwin].doc, TWIN_DOC, "As %s, %s.", table->key[k].path, catalogue->also_doc);
        twin[ntwin] = table->key[k];
        twin[ntwin].path = twin_text[ntwin].path, twin[ntwin].doc = twin_text[ntwin].doc;
    }
    return (pg_key_table) { table->folder, twin + first, ntwin - first };
}

/* Adds the table of an entry, or the entry's name to a table that it shares with one before; 1: it was
 * there. */
static int share_table (const pg_key_table *table, const char *name)
{
    int shared = 0;
    for (size_t t = 0; t < ntable; t++) {
        if (owner[t].declared != table->key) continue;
        size_t used = strlen (owner[t].names);
        snprintf (owner[t].names + used, NAMES - used, "|%s", name);
        shared = 1;
    }
    return shared;
}

/* Tables of one entry; twice: also below the second place of the catalogue. */
static void add_tables (pg_key_tables list, const pg_key_catalogue *catalogue, const char *name, int twice)
{
    for (; list && *list; list++) {
        if (share_table (*list, name)) continue;
        add_table (*list, (*list)->key, catalogue, name);
        if (!twice) continue;
        pg_key_table copy = twins_of (*list, catalogue);
        add_table (&copy, (*list)->key, catalogue, name);
    }
}

static void add_entries (const pg_key_catalogue *catalogue)
{
    const char *name;
    for (size_t i = 0; (name = catalogue->name (i)); i++) {
        if (catalogue->keys) add_tables (catalogue->keys (i), catalogue, name, 0);
        if (catalogue->keys_twice) add_tables (catalogue->keys_twice (i), catalogue, name, 1);
    }
}

static void gather (void)
{
#define PG_KEYS(folder) add_table (&pg_keys_##folder, NULL, NULL, "");
#define PG_ENTRY_KEYS(folder) add_entries (&pg_entry_keys_##folder);
#include "list.h"
#undef PG_KEYS
#undef PG_ENTRY_KEYS
}

/* Gathered on the first call, whichever thread makes it. */
const pg_key_table *pg_scene_tables (size_t *n)
{
    pthread_once (&once, gather);
    *n = ntable;
    return tables;
}

/* By the address of the row: rows are unique. */
const char *pg_key_entries (const pg_key *key, const char **selector)
{
    size_t n;
    const pg_key_table *table = pg_scene_tables (&n);
    for (size_t t = 0; t < n; t++)
        for (size_t k = 0; owner[t].catalogue && k < table[t].n; k++) {
            if (key != &table[t].key[k]) continue;
            if (selector) *selector = owner[t].catalogue->selector;
            return owner[t].names;
        }
    return NULL;
}
