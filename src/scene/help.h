/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: writes help, manual and JSON schema of a table of keys, that of a scene or any other. */
#ifndef PG_SCENE_HELP_H
#define PG_SCENE_HELP_H
#include "schema.h"

/* The kind in words: "whole number". */
const char *pg_key_kind (const pg_key *key);
/* What a key is for, after the names of the entries that own it: "(adr, relax) Number of ...". */
void      pg_help_meaning (FILE *to, const pg_key *key);
/* Writes what is known of one key; writes the manual of all keys. */
pg_status pg_help_write   (FILE *to, const char *key, const pg_schema *s);
pg_status pg_manual_write (FILE *to, const pg_schema *s);
/* Writes the keys as a JSON schema. */
pg_status pg_json_schema_write (FILE *to, const pg_schema *s);
#endif
