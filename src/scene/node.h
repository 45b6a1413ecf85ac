/* SPDX-License-Identifier: GPL-3.0-or-later
 * node.h: the tree a YAML text becomes, each node with its place, and the list of faults found in it. */
#ifndef PG_SCENE_NODE_H
#define PG_SCENE_NODE_H
#include "perigal/scene.h"
#include <stdarg.h>

typedef enum { PG_SCALAR, PG_SEQUENCE, PG_MAPPING } pg_node_shape;

typedef struct pg_node pg_node;
struct pg_node {
    pg_node_shape shape;
    int           plain;                               /* a scalar without quotes */
    int           line, column;  /* of the key or the list element, from 1; 0: not in the file */
    const char   *origin;  /* "--set ..." or "default of ..."; NULL: the file (borrowed) */
    char         *name;                                /* key in the map above; NULL in lists */
    char         *text;                                /* of a scalar */
    const pg_key *key;                                 /* the row it was checked against */
    double        value;  /* of numbers, SI; NAN for an expression with variables */
    int           spacing;                             /* value counts point spacings */
    pg_node      *child;
    size_t        n, cap;
};

/* top: first word of the key it is about */
typedef struct { char *text; int line, column; char top[24]; } pg_fault;
typedef struct {
    pg_fault *fault;
    size_t    n, cap, more;                            /* more: counted only */
    int       lost;                                    /* no memory for one of them */
    size_t    passed;                                  /* so many are no reason to stop (pg_scene_pass) */
} pg_faults;

/* One YAML document into `root`. A wrong text is a fault, not a failure; *good tells. */
pg_status pg_node_read (pg_node *root, const char *text, size_t length, const char *origin, const char *file,
                        pg_faults *faults, int *good);
/* A scalar without place. */
pg_status pg_node_word  (pg_node *node, const char *text, const char *origin);
pg_status pg_node_add   (pg_node **child, pg_node *parent, const char *name);  /* zeroed; children may move */
pg_node  *pg_node_child (const pg_node *parent, const char *name, size_t length);
int       pg_node_null  (const pg_node *node);         /* nothing written, or ~ */
void      pg_node_clear (pg_node *node);

/* "file:line:column: path = value: text"; `at` NULL: the start of the file; path NULL: none. */
void pg_faults_add (pg_faults *f, const char *file, const pg_node *at, const char *path, int with_value,
                    const char *format, ...) __attribute__ ((format (printf, 6, 7)));
void pg_faults_add_v (pg_faults *f, const char *file, const pg_node *at, const char *path, int with_value,
                      const char *format, va_list args);
pg_status pg_faults_verdict (const pg_faults *f);
void pg_faults_clear (pg_faults *f);
#endif
