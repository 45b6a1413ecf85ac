/* SPDX-License-Identifier: GPL-3.0-or-later
 * schema.h: all key tables as one list of rows, and the patterns ("materials.{}.density") that lead through
 * it. */
#ifndef PG_SCENE_SCHEMA_H
#define PG_SCENE_SCHEMA_H
#include "node.h"

enum { PG_PATTERN = 256, PG_LEVEL_NAMES = 2000 };

typedef struct { const pg_key **row; size_t n; } pg_schema;

pg_status pg_schema_create (pg_schema *s, const pg_key_table *table, size_t ntable);
void      pg_schema_clear  (pg_schema *s);
/* Appends `.name`, or `.{}` where the user chooses names (gives 2); 0: no such key, pattern kept. */
int  pg_schema_enter (const pg_schema *s, char pattern[PG_PATTERN], const char *name, size_t length);
int  pg_schema_item  (const pg_schema *s, char pattern[PG_PATTERN]);           /* appends "[]" */
/* The row of exactly this pattern that takes such a node; NULL. */
const pg_key *pg_schema_row (const pg_schema *s, const char *pattern, pg_node_shape shape);
const pg_key *pg_schema_any (const pg_schema *s, const char *pattern);
/* 1 when some path goes on from the pattern with `next`: '.' or '['. */
int  pg_schema_opens (const pg_schema *s, const char *pattern, char next);
/* Names one level below the pattern, "a|b|c", each once, without {}. */
void pg_schema_names (const pg_schema *s, const char *pattern, char names[PG_LEVEL_NAMES]);
/* The last word of the row's path when it lies one level below the pattern and is no {} or []; NULL. */
const char *pg_schema_below (const pg_key *row, const char *pattern);
/* What belongs at the pattern: "a number with a unit of Pa, ...", "a map". */
void pg_schema_wanted (const pg_schema *s, const char *pattern, char *out, size_t n);
const char *pg_key_choices (const pg_key *key);        /* "a|b"; NULL: any */
#endif
