/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: what the files of the .inp reader share: element types (abaqus_type.c), what was read before
 * names and numbers are resolved (filled by abaqus.c and abaqus_data.c), and the functions that turn this
 * into a mesh (abaqus_sets.c).
 *
 * An .inp file may name sets before their members exist, and sets of sets, so that resolving has to wait
 * for the end. Only one part with at most one instance can be read, because numbers are unique within a
 * part only. */
#ifndef MESH_ABAQUS_H
#define MESH_ABAQUS_H
#include "format.h"

/* ---- abaqus_type.c ------------------------------------------------------------------------------------- */
/* An element type of Abaqus or CalculiX. */
typedef struct {
    pg_element kind;
    /* Number of nodes on the lines of the file. */
    int  nodes;
    /* 1: a shell or membrane: its faces 1 and 2 are its top and bottom, not edges of the 2D element. */
    int  shell;
} abaqus_type;
/* Looks up a type. 0: unknown (near: the nearest known name, or ""); 1: an element; 2: one without extent
 * (springs, masses ...), which is skipped. */
int abaqus_find_type (const char *name, abaqus_type *type, char near[32]);
/* order[k]: position, on the lines of the file, of the node that is node k in the order of Exodus. */
void abaqus_node_order (pg_element kind, int order[PG_ELEMENT_NODES]);
/* Side, from 0, of a face as *SURFACE names it (S1, P2, E3); -1: the element has none such; -2: a face of a
 * shell (SPOS, SNEG, S1, S2). */
int abaqus_side (pg_element kind, int shell, const char *face);

/* ---- what the lines say -------------------------------------------------------------------------------- */
/* Bytes of the name of a set or surface, with the final zero. */
enum { ABAQUS_NAME = 64 };
/* Members of a set: the numbers first, first + step, ... last. line: number of the line that names them, if a
 * member that does not exist is a fault, else 0. */
typedef struct { long first, last, step, line; } abaqus_range;
/* Special values of abaqus_range.step: members of set number `first`; nodes of element set `first`. */
enum { ABAQUS_SET = 0, ABAQUS_NODES_OF = -1 };
/* A set; named: 1 if *ELEMENT or a section names it, so that it is a block. */
typedef struct { char name[ABAQUS_NAME]; size_t n, capacity; abaqus_range *range; int named; } abaqus_set;
/* All node sets, or all element sets. */
typedef struct { size_t n, capacity; abaqus_set *set; } abaqus_sets;
/* A line of *SURFACE: an element (set = -1) or an element set, and the face. */
typedef struct { long element, line; int set; char face[8]; } abaqus_face;
/* A surface: its lines. */
typedef struct { char name[ABAQUS_NAME]; size_t n, capacity; abaqus_face *face; } abaqus_surface;

/* All that was read. */
typedef struct {
    /* Receives nodes and elements at once, sets at the end. */
    pg_mesh_builder *builder;
    /* The main file, for messages. */
    const char *path;
    /* Number of files read by *INCLUDE. */
    int    included;
    /* 1 for each element of the builder that is a shell. */
    size_t capacity;  unsigned char *shell;
    /* Node sets and element sets. */
    abaqus_sets nset, elset;
    /* Element sets of *SOLID SECTION and the like, in their order. */
    size_t nsection, section_capacity;  int *section;
    size_t nsurface, surface_capacity;  abaqus_surface *surface;
    /* Numbers of elements that are passed over; sets may name them. */
    abaqus_set skipped;
} abaqus;

/* ---- abaqus.c, abaqus_data.c: a file being read -------------------------------------------------------- */
/* Largest depth of files that include one another, number of parameters of a keyword, bytes of a word. */
enum { ABAQUS_DEEPEST = 8, ABAQUS_PARAMETERS = 24, ABAQUS_WORD = 256 };

/* What data lines mean at present. */
typedef enum {
    ABAQUS_SKIP,
    ABAQUS_SKIPPED_ELEMENTS,
    ABAQUS_NODE_LINES,
    ABAQUS_ELEMENT_LINES,
    ABAQUS_NODE_SET,
    ABAQUS_ELEMENT_SET,
    ABAQUS_SURFACE,
    ABAQUS_NODE_SURFACE,
    ABAQUS_INSTANCE
} abaqus_mode;
/* A file that is open; owned: its bytes, NULL for the main file; line .. end: the present line. */
typedef struct { char *path, *owned; mesh_file bytes; mesh_cursor c; const char *line, *end; } abaqus_file;
/* A parameter KEY=VALUE of a keyword line. */
typedef struct { char key[32], value[ABAQUS_WORD]; } abaqus_parameter;

/* State of the reader. */
typedef struct {
    /* What has been read. */
    abaqus      data;
    /* file[0] is the main file, the others are included. */
    abaqus_file file[ABAQUS_DEEPEST];
    /* Number of open files - 1. */
    int         depth;
    /* What data lines mean at present. */
    abaqus_mode mode;
    /* The present keyword in capitals, without blanks. */
    char        keyword[32];
    /* Parameters of the present keyword line. */
    int         nparameter;
    abaqus_parameter parameter[ABAQUS_PARAMETERS];
    /* What data lines fill: index of the set, 1 if by ranges (GENERATE), index of the surface. */
    int         set, generate, surface;
    /* Type of the elements that data lines give. */
    abaqus_type type;
    /* order[k]: position on the lines of the node that is node k of the element. */
    int         order[PG_ELEMENT_NODES];
    /* The element whose nodes are being read, and the line where it begins. */
    long        element, element_line, node[PG_ELEMENT_NODES];
    /* How many nodes of the present element have been read; -1: no element has begun. */
    int         have;
    /* 1: the last line ended with a comma, so that this one continues an element that is skipped. */
    int         goes_on;
    /* Numbers of *PART and *INSTANCE so far; name of the one instance. */
    int         parts, instances;
    char        instance[ABAQUS_WORD];
} abaqus_reader;
/* Records "file, line: why". */
#define ABAQUS_WRONG(r, ...) abaqus_wrong ((r), PG_HERE, __VA_ARGS__)
/* Records a fault at the present line. */
pg_status abaqus_wrong (const abaqus_reader *r, const char *where, const char *format, ...)
    __attribute__ ((format (printf, 3, 4)));
/* Copies [s, end) without blanks at its ends and without quotes. */
void      abaqus_trim  (char *to, size_t size, const char *s, const char *end);
/* Reads one data line behind the present keyword. */
pg_status abaqus_data  (abaqus_reader *r);

/* ---- abaqus_sets.c ------------------------------------------------------------------------------------- */
/* Index of the set of that name, without regard to case; -1: there is none. abaqus_set_get creates a set that
 * does not exist. */
int       abaqus_set_find (const abaqus_sets *sets, const char *name);
pg_status abaqus_set_get  (abaqus_sets *sets, const char *name, int *set);
/* Appends members; sets hold ranges, not single numbers. */
pg_status abaqus_set_add  (abaqus_set *set, abaqus_range range);
/* Releases all sets. */
void      abaqus_sets_free (abaqus_sets *sets);
/* Gives blocks, sets and surfaces to the builder. */
pg_status abaqus_resolve (abaqus *a);
#endif
