/* SPDX-License-Identifier: GPL-3.0-or-later
 * abaqus.h: what the files of the .inp reader share: element types (abaqus_type.c), what was read before it
 * is resolved (abaqus.c fills it), and the way from there into a mesh (abaqus_sets.c). */
#ifndef MESH_ABAQUS_H
#define MESH_ABAQUS_H
#include "format.h"

/* ---- abaqus_type.c ------------------------------------------------------------------------------------- */
typedef struct {
    pg_element kind;
    int  nodes;                                        /* on the lines of the file */
    int  shell;                                        /* its faces 1, 2 are not sides of the plane element */
} abaqus_type;
/* 0: unknown (near: the nearest known name); 1: an element; 2: one without extent (springs, masses ...), to
 * be passed over. */
int abaqus_find_type (const char *name, abaqus_type *type, char near[32]);
/* order[k]: which node of the file is node k of the element. */
void abaqus_node_order (pg_element kind, int order[PG_ELEMENT_NODES]);
/* Side from 0 of a face as in *SURFACE (S1, P2, E3), -1: the element has none such, -2: face of a shell
 * (SPOS, SNEG, S1, S2). */
int abaqus_side (pg_element kind, int shell, const char *face);

/* ---- what the lines say -------------------------------------------------------------------------------- */
enum { ABAQUS_NAME = 64 };
typedef struct { long first, last, step, line; } abaqus_range;  /* line: of entries that must exist, else 0 */
/* step: of numbers first, first + step ... last; or one of these: all of set number `first`, the nodes of
 * element set number `first`. */
enum { ABAQUS_SET = 0, ABAQUS_NODES_OF = -1 };
/* named: by *ELEMENT: a block */
typedef struct { char name[ABAQUS_NAME]; size_t n, capacity; abaqus_range *range; int named; } abaqus_set;
typedef struct { size_t n, capacity; abaqus_set *set; } abaqus_sets;
typedef struct { long element, line; int set; char face[8]; } abaqus_face;  /* set -1: one element */
typedef struct { char name[ABAQUS_NAME]; size_t n, capacity; abaqus_face *face; } abaqus_surface;
typedef struct {
    pg_mesh_builder *builder;
    const char *path;
    int    included;                                   /* files by *INCLUDE so far */
    size_t capacity;  unsigned char *shell;                /* of every element of the builder */
    abaqus_sets nset, elset;
    /* element sets of *SOLID SECTION, in their order */
    size_t nsection, section_capacity;  int *section;
    size_t nsurface, surface_capacity;  abaqus_surface *surface;
} abaqus;

/* ---- abaqus.c, abaqus_data.c: a file being read -------------------------------------------------------- */
enum { ABAQUS_DEEPEST = 8, ABAQUS_PARAMETERS = 24, ABAQUS_WORD = 256 };
typedef enum {
    ABAQUS_SKIP,
    ABAQUS_NODE_LINES,
    ABAQUS_ELEMENT_LINES,
    ABAQUS_NODE_SET,
    ABAQUS_ELEMENT_SET,
    ABAQUS_SURFACE,
    ABAQUS_NODE_SURFACE,
    ABAQUS_INSTANCE
} abaqus_mode;
/* line: the one now, up to its end */
typedef struct { char *path; mesh_file bytes; mesh_cursor c; const char *line, *end; } abaqus_file;
typedef struct { char key[32], value[ABAQUS_WORD]; } abaqus_parameter;
typedef struct {
    abaqus      data;
    abaqus_file file[ABAQUS_DEEPEST];  /* file[0]: the main one; the others by *INCLUDE */
    int         depth;                                 /* files open - 1 */
    abaqus_mode mode;
    char        keyword[32];                           /* capitals, no blanks */
    int         nparameter;
    abaqus_parameter parameter[ABAQUS_PARAMETERS];
    int         set, generate, surface;                /* what data lines fill */
    abaqus_type type;
    int         order[PG_ELEMENT_NODES];
    long        element, element_line, node[PG_ELEMENT_NODES];   /* element whose nodes are being read */
    int         have;                                  /* of its nodes; -1: no element begun */
    int         parts, instances;
    char        instance[ABAQUS_WORD];
} abaqus_reader;
/* Records "file, line: why". */
#define ABAQUS_WRONG(r, ...) abaqus_wrong ((r), PG_HERE, __VA_ARGS__)
pg_status abaqus_wrong (const abaqus_reader *r, const char *where, const char *format, ...)
    __attribute__ ((format (printf, 3, 4)));
/* Copies [s, end) without blanks at its ends and without quotes. */
void      abaqus_trim  (char *to, size_t size, const char *s, const char *end);
pg_status abaqus_data  (abaqus_reader *r);  /* one data line behind the keyword that r->mode stands for */

/* ---- abaqus_sets.c ------------------------------------------------------------------------------------- */
int       abaqus_set_find (const abaqus_sets *sets, const char *name);  /* -1: none; case does not count */
pg_status abaqus_set_get  (abaqus_sets *sets, const char *name, int *set);  /* made where there is none */
pg_status abaqus_set_add  (abaqus_set *set, abaqus_range range);
void      abaqus_sets_free (abaqus_sets *sets);
pg_status abaqus_resolve (abaqus *a);  /* elements, blocks, sets and surfaces into the builder */
#endif
