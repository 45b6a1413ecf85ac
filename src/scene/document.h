/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: the scene, that is the input file of a run as data, and reading one against any key tables (tests
 * have tables of their own). */
#ifndef PG_SCENE_DOCUMENT_H
#define PG_SCENE_DOCUMENT_H
#include "schema.h"

/* A scene. */
struct pg_scene {
    /* Path and text as given. */
    char      *file, *source;
    /* SHA-256 of text and overrides. */
    char       hash[65];
    /* Overrides as "--set key=value" (nset). */
    char     **set;
    size_t     nset;
    /* Dimension of space; 0: not known. */
    int        dimension;
    /* All rows of all key tables. */
    pg_schema  schema;
    /* The tree of what the user wrote. */
    pg_node    root;
    /* Default of each row, as a node; without text and children: the row has none (schema.n). */
    pg_node   *fallback;
    /* Errors in the scene found so far; the list grows even in a const scene. */
    pg_faults *faults;
    /* 1: it has faults in parts that do not concern the geometry (pg_scene_load_some). */
    int        partial;
};

/* Reads a scene from memory with overrides `set`, against these tables, which are kept. some: a scene whose
 * geometry has no fault is returned together with the faults it has (pg_scene_load_some). */
pg_status pg_scene_read (pg_scene **out, const char *text, size_t length, const char *name, size_t nset,
                         const char *const *set, const pg_vocabulary *words, int some);
/* Puts the override "key=value" into the tree; an error in it is added to the faults. */
pg_status pg_scene_override (pg_scene *s, const char *set, const char *origin);
/* override_seed.c: 1 for "random_field.seed=N", which gives all random fields of the scene other seeds. */
int       pg_scene_is_reseed (const char *set);
pg_status pg_scene_reseed    (pg_scene *s, const char *set, const char *origin);
/* Checks tree and defaults against the rows. Faults are collected; it fails only for lack of memory or of
 * the database of units. */
pg_status pg_scene_check (pg_scene *s);
/* Is the key in use in the map `node` of this pattern? 0: it belongs to entries of a catalogue, and another
 * entry is chosen there. */
int pg_key_wanted (const pg_scene *s, const pg_key *key, const pg_node *node, const char *pattern);
#endif
