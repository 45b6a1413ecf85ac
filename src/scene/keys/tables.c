/* SPDX-License-Identifier: GPL-3.0-or-later
 * The key tables of all folders and of the entries of their catalogues, from list.h: gathered once, then
 * constant. */
#include "keys.h"
#include <pthread.h>
#include <string.h>

#define PG_KEYS(folder) extern const pg_key_table pg_keys_##folder;
#define PG_ENTRY_KEYS(folder) extern const pg_key_catalogue pg_entry_keys_##folder;
#include "list.h"
#undef PG_KEYS
#undef PG_ENTRY_KEYS

/* Largest numbers of tables, catalogues and copied rows; room for the texts of copied rows, in bytes. A limit
 * that is too small is an error of the program, reported whenever a scene is read: raise the one that the
 * message names. */
enum { MOST_TABLES = 96, MOST_CATALOGUES = 16, MOST_TWINS = 64, TWIN_PATH = 96, TWIN_DOC = 160 };

/* All tables: filled once, on the first request, and constant from then on. twin: copies of rows for the
 * second path at which a catalogue takes the keys of its entries (pg_key_catalogue.also). */
static struct {
    pthread_once_t once;
    pg_vocabulary words;
    pg_key_table table[MOST_TABLES];
    pg_key_owner owner[MOST_TABLES];
    const pg_key_catalogue *catalogue[MOST_CATALOGUES];
    size_t       ntwin;
    pg_key       twin[MOST_TWINS];
    struct { char path[TWIN_PATH], doc[TWIN_DOC]; } twin_text[MOST_TWINS];
    const char  *fault;                                /* the limit that was too small; NULL: none */
} all = { .once = PTHREAD_ONCE_INIT };

/* Does a number or the length of a text exceed its limit? Then 1, and the name of the first such limit is
 * stored. */
static int exceeds (size_t value, size_t limit, const char *name)
{
    if (value <= limit) return 0;
    if (!all.fault) all.fault = name;
    return 1;
}

/* Adds a table and its owner: the catalogue, and the name of the entry. */
static void add_table (const pg_key_table *table, const pg_key *declared, const pg_key_catalogue *catalogue,
                       const char *name)
{
    if (exceeds (all.words.n + 1, MOST_TABLES, "MOST_TABLES")) return;
    pg_key_owner *owner = &all.owner[all.words.n];
    owner->declared = declared, owner->catalogue = catalogue;
    int length = snprintf (owner->names, PG_OWNER_NAMES, "%s", name);
    exceeds ((size_t) length, PG_OWNER_NAMES - 1, "PG_OWNER_NAMES");
    all.table[all.words.n++] = *table;
}

/* Copies the rows of a table to the second path of their catalogue: "failure.cohesion" becomes
 * "materials.{}.failure.cohesion". */
static pg_key_table twins_of (const pg_key_table *table, const pg_key_catalogue *catalogue)
{
    size_t first = all.ntwin;
    for (size_t k = 0; k < table->n && !exceeds (all.ntwin + 1, MOST_TWINS, "MOST_TWINS"); k++, all.ntwin++) {
        pg_key *twin = &all.twin[all.ntwin];
        char *path = all.twin_text[all.ntwin].path, *doc = all.twin_text[all.ntwin].doc;
        const char *declared = table->key[k].path;
        int length = snprintf (path, TWIN_PATH, "%s%s", catalogue->also, declared);
        exceeds ((size_t) length, TWIN_PATH - 1, "TWIN_PATH");
        length = snprintf (doc, TWIN_DOC, "As %s, %s.", declared, catalogue->also_doc);
        exceeds ((size_t) length, TWIN_DOC - 1, "TWIN_DOC");
        *twin = table->key[k];
        twin->path = path, twin->doc = doc;
    }
    return (pg_key_table) { table->folder, all.twin + first, all.ntwin - first };
}

/* Adds the entry's name to a table that it shares with an earlier entry; 1: there is such a table. */
static int share_table (const pg_key_table *table, const char *name)
{
    int shared = 0;
    for (size_t t = 0; t < all.words.n; t++) {
        if (all.owner[t].declared != table->key) continue;
        size_t used = strlen (all.owner[t].names);
        int more = snprintf (all.owner[t].names + used, PG_OWNER_NAMES - used, "|%s", name);
        exceeds (used + (size_t) more, PG_OWNER_NAMES - 1, "PG_OWNER_NAMES");
        shared = 1;
    }
    return shared;
}

/* Adds the tables of one entry; twice 1: also at the second path of the catalogue. */
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

/* Adds the tables of all entries of a catalogue. */
static void add_entries (const pg_key_catalogue *catalogue)
{
    const char *name;
    if (exceeds (all.words.ncatalogue + 1, MOST_CATALOGUES, "MOST_CATALOGUES")) return;
    all.catalogue[all.words.ncatalogue++] = catalogue;
    for (size_t i = 0; (name = catalogue->name (i)); i++) {
        if (catalogue->keys) add_tables (catalogue->keys (i), catalogue, name, 0);
        if (catalogue->keys_twice) add_tables (catalogue->keys_twice (i), catalogue, name, 1);
    }
}

/* Adds the tables of all folders and catalogues, in the order of list.h. */
static void gather (void)
{
    all.words = (pg_vocabulary) { .table = all.table, .owner = all.owner, .catalogue = all.catalogue };
#define PG_KEYS(folder) add_table (&pg_keys_##folder, NULL, NULL, "");
#define PG_ENTRY_KEYS(folder) add_entries (&pg_entry_keys_##folder);
#include "list.h"
#undef PG_KEYS
#undef PG_ENTRY_KEYS
}

/* Gathered on the first call, whichever thread makes it. */
pg_status pg_keys_of_all (const pg_vocabulary **out)
{
    pthread_once (&all.once, gather);
    *out = &all.words;
    return !all.fault ? PG_OK
                      : pg_error (PG_E_LIMIT, PG_HERE,
                                  "this build has more keys than their tables hold: raise %s in "
                                  "src/scene/keys/tables.c", all.fault);
}

const pg_key *pg_scene_key (size_t k)
{
    const pg_vocabulary *words;
    if (pg_keys_of_all (&words) != PG_OK) return NULL;
    for (size_t t = 0; t < words->n; k -= words->table[t++].n)
        if (k < words->table[t].n) return &words->table[t].key[k];
    return NULL;
}
