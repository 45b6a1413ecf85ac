/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: the keys of all folders together, against which scenes (input files) are read, and texts written
 * from any table of keys: help, manual and JSON schema. */
#ifndef PG_SCENE_KEYS_H
#define PG_SCENE_KEYS_H
#include "scene/document.h"

/* Returns the key tables of all folders and of the entries of all catalogues. PG_E_LIMIT: there are more than
 * the arrays of tables.c hold. */
pg_status pg_keys_of_all (const pg_vocabulary **out);
/* The kind of a key in words: "whole number". */
const char *pg_key_kind (const pg_key *key);
/* Writes what a key means, after the names of the catalogue entries that own it: "(adr, relax) Number of
 * ...". */
void      pg_help_meaning (FILE *to, const pg_schema *s, const pg_key *key);
/* Write the help for one key; write the manual of all keys. */
pg_status pg_help_write   (FILE *to, const char *key, const pg_schema *s);
pg_status pg_manual_write (FILE *to, const pg_schema *s);
/* Writes the keys as a JSON schema. */
pg_status pg_json_schema_write (FILE *to, const pg_schema *s);
#endif
