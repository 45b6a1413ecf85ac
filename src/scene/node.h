/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: the tree that a YAML text becomes, each node with its line and column, and the list of faults
 * found in it.
 * */
#ifndef PG_SCENE_NODE_H
#define PG_SCENE_NODE_H
#include "perigal/scene.h"
#include <stdarg.h>

typedef enum { PG_SCALAR, PG_SEQUENCE, PG_MAPPING } pg_node_shape;

typedef struct pg_node pg_node;

/* A node of the tree. */
struct pg_node {
    pg_node_shape shape;
    /* 1: a single value without quotes. */
    int           plain;
    /* Position of the key or list element in the file, from 1; 0: not in the file. */
    int           line, column;
    /* Where the node comes from: "--set ..." or "default"; NULL: from the file. Borrowed. */
    const char   *origin;
    /* Key of the node in its parent map; NULL in lists. */
    char         *name;
    /* Text of a single value. */
    char         *text;
    /* The row of the key table that the node was checked against. */
    const pg_key *key;
    /* Numbers: the value in SI; NAN for an expression with variables. */
    double        value;
    /* 1: the value is a multiple of the point spacing. */
    int           spacing;
    /* Elements of a list, entries of a map (n). */
    pg_node      *child;
    size_t        n, cap;
    /* Hash table that finds entries of a large map by name: indices into child + 1, 0: empty (slots, a power
     * of 2). */
    unsigned     *slot;
    size_t        slots;
};

/* A fault: its message, its line and column, and the first word of the key concerned. */
typedef struct { char *text; int line, column; char top[24]; } pg_fault;

/* All faults of a scene. */
typedef struct {
    pg_fault *fault;
    /* Number, capacity, and how many more were only counted. */
    size_t    n, cap, more;
    /* 1: a fault could not be stored for lack of memory. */
    int       lost;
    /* Number of faults that do not stop later checks (pg_scene_pass). */
    size_t    passed;
} pg_faults;

/* Reads one YAML document into `root`. An error in the text becomes a fault, the status stays PG_OK, and
 * *good = 0. */
pg_status pg_node_read (pg_node *root, const char *text, size_t length, const char *origin, const char *file,
                        pg_faults *faults, int *good);
/* Makes a node a single value without line and column. */
pg_status pg_node_word  (pg_node *node, const char *text, const char *origin);
/* Appends a zeroed child; other children may move. */
pg_status pg_node_add   (pg_node **child, pg_node *parent, const char *name);
/* The first child of that name (length bytes) of a map; NULL: there is none. */
pg_node  *pg_node_child (const pg_node *parent, const char *name, size_t length);
/* Is the value empty, or ~ ? */
int       pg_node_null  (const pg_node *node);
void      pg_node_clear (pg_node *node);

/* Adds the fault "file:line:column: path = value: text". at NULL: the beginning of the file; path NULL:
 * none. */
void pg_faults_add (pg_faults *f, const char *file, const pg_node *at, const char *path, int with_value,
                    const char *format, ...) __attribute__ ((format (printf, 6, 7)));
void pg_faults_add_v (pg_faults *f, const char *file, const pg_node *at, const char *path, int with_value,
                      const char *format, va_list args);
/* PG_OK, or PG_E_SCENE with all messages in pg_last_error. */
pg_status pg_faults_verdict (const pg_faults *f);
void pg_faults_clear (pg_faults *f);
#endif
