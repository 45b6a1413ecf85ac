/* SPDX-License-Identifier: GPL-3.0-or-later
 * document.h: the scene itself, and reading one against any key tables (tests bring their own). */
#ifndef PG_SCENE_DOCUMENT_H
#define PG_SCENE_DOCUMENT_H
#include "schema.h"

struct pg_scene {
    char      *file, *source;                          /* as given */
    char       hash[65];
    char     **set;                                    /* overrides, "--set key=value" (nset) */
    size_t     nset;
    int        dimension;                              /* 0: not known */
    pg_schema  schema;
    pg_node    root;
    pg_node   *fallback;  /* default of each row; no text and no child: none (schema.n) */
    pg_faults *faults;                                 /* grows even in a const scene */
    int        partial;  /* it has faults beside its geometry (pg_scene_load_some) */
};

pg_status pg_scene_read (pg_scene **out, const char *text, size_t length, const char *name, size_t nset,
                         const char *const *set, const pg_key_table *table, size_t ntable);
/* "key=value" into the tree; what is wrong with it is a fault. */
pg_status pg_scene_override (pg_scene *s, const char *set, const char *origin);
/* Checks the tree and the defaults against the rows; faults are collected, only lack of memory or of the unit
 * database fails. */
pg_status pg_scene_check (pg_scene *s);
/* 0: the key is of entries of a catalogue, and another one is chosen in the map `node` of this pattern. */
int pg_key_wanted (const pg_scene *s, const pg_key *key, const pg_node *node, const char *pattern);
#endif
