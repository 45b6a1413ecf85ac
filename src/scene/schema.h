/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: all key tables as one list of rows, and the patterns ("materials.{}.density") by which rows are
 * found. */
#ifndef PG_SCENE_SCHEMA_H
#define PG_SCENE_SCHEMA_H
#include "node.h"

/* Room for a pattern, and for the names of all keys of one level, in bytes. */
enum { PG_PATTERN = 256, PG_LEVEL_NAMES = 2000 };

/* Room for the names of entries that share a table, in bytes. */
enum { PG_OWNER_NAMES = 240 };

/* The catalogue entry that owns a table: its rows as the entry declares them, its catalogue, and the names of
 * all entries that share the table, "adr|relax". */
typedef struct {
    const pg_key *declared;
    const pg_key_catalogue *catalogue;
    char names[PG_OWNER_NAMES];
} pg_key_owner;

/* Key tables against which a scene is read. */
typedef struct {
    /* The tables (n). */
    size_t              n;
    const pg_key_table *table;
    /* The owner of each table (n); one without a catalogue: all scenes have these keys; NULL: this holds for
     * all tables. */
    const pg_key_owner *owner;
    /* Catalogues among whose entries keys of the scene choose (ncatalogue). */
    size_t              ncatalogue;
    const pg_key_catalogue *const *catalogue;
} pg_vocabulary;

/* All rows (n) of the tables; borrowed from them. */
typedef struct { const pg_vocabulary *from; const pg_key **row; size_t n; } pg_schema;

/* Makes one list of all rows of these tables; `from` is kept by reference. PG_E_MEMORY. */
pg_status pg_schema_create (pg_schema *s, const pg_vocabulary *from);
void      pg_schema_clear  (pg_schema *s);
/* The entries that own a row, "adr|relax", and in *selector (unless NULL) the key that chooses among them;
 * NULL: the row belongs to no entry. */
const char *pg_schema_entries (const pg_schema *s, const pg_key *row, const char **selector);
/* Appends `.name` to the pattern, or `.{}` where the user chooses names (returns 2); 0: no such key, the
 * pattern is unchanged. */
int  pg_schema_enter (const pg_schema *s, char pattern[PG_PATTERN], const char *name, size_t length);
/* Appends "[]" to the pattern; 0: there is no list at this pattern. */
int  pg_schema_item  (const pg_schema *s, char pattern[PG_PATTERN]);
/* The row of exactly this pattern that takes such a node, or any row of it; NULL: there is none. */
const pg_key *pg_schema_row (const pg_schema *s, const char *pattern, pg_node_shape shape);
const pg_key *pg_schema_any (const pg_schema *s, const char *pattern);
/* The next row of this pattern from row `from` on; s->n: there is none. */
size_t pg_schema_next (const pg_schema *s, const char *pattern, size_t from);
/* Does some path continue the pattern by `next`, '.' or '[' ? */
int  pg_schema_opens (const pg_schema *s, const char *pattern, char next);
/* Names one level below the pattern, "a|b|c", each once, without {}. */
void pg_schema_names (const pg_schema *s, const char *pattern, char names[PG_LEVEL_NAMES]);
/* The last word of the row's path, if it lies one level below the pattern and is no {} or []; else NULL. */
const char *pg_schema_below (const pg_key *row, const char *pattern);
/* What belongs at the pattern, in words: "a number with a unit of Pa, ...", "a map". */
void pg_schema_wanted (const pg_schema *s, const char *pattern, char *out, size_t n);
/* The values allowed for a key, "a|b"; NULL: any. */
const char *pg_key_choices (const pg_key *key);
/* The default as the user would write it, with PG_FIRST_CHOICE looked up (written to `name`); NULL:
 * required. */
const char *pg_key_default (const pg_key *key, char name[PG_LEVEL_NAMES]);
#endif
