/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: the keys of all folders together, by which scenes are read, and what is written of them: help,
 * manual and JSON schema of any table of keys. */
#ifndef PG_SCENE_KEYS_H
#define PG_SCENE_KEYS_H
#include "scene/document.h"

/* The key tables of all folders and of the entries of all catalogues. PG_E_LIMIT: the build has more than
 * tables.c holds. */
pg_status pg_keys_of_all (const pg_vocabulary **out);
/* The kind in words: "whole number". */
const char *pg_key_kind (const pg_key *key);
/* What a key is for, after the names of the entries that own it: "(adr, relax) Number of ...". */
void      pg_help_meaning (FILE *to, const pg_schema *s, const pg_key *key);
/* Writes what is known of one key; writes the manual of all keys. */
pg_status pg_help_write   (FILE *to, const char *key, const pg_schema *s);
pg_status pg_manual_write (FILE *to, const pg_schema *s);
/* Writes the keys as a JSON schema. */
pg_status pg_json_schema_write (FILE *to, const pg_schema *s);
#endif
