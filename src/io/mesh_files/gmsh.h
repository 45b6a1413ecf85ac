/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: what versions 2.2 and 4.1 of Gmsh's format share: header, sections, names of groups, types of
 * elements, binary numbers. A section begins with a line $Name and ends with $EndName. */
#ifndef MESH_GMSH_H
#define MESH_GMSH_H
#include "format.h"
#include <stdio.h>

/* State of a reader; copies serve to look ahead. */
typedef struct {
    /* Position in the file. */
    mesh_cursor    c;
    /* Receives nodes, elements and groups. */
    pg_mesh_builder *m;
    /* Version of the format. */
    double         version;
    /* binary: numbers are bytes; swap: in the other byte order. */
    int            binary, swap;
} gmsh_reader;
/* An element type; order[k]: position in Gmsh's node list of node k in the order of Exodus. known 0: such
 * elements are skipped; nodes: how many they have, 0: unknown. */
typedef struct { int known; pg_element kind; const signed char *order; int nodes; } gmsh_type;

/* Writes the present position in the file to text and returns it: "line 7" or "byte 1200". */
const char *gmsh_at (const gmsh_reader *g, char text[40]);
#define GMSH_FAIL(g, ...) do { char why_[400], at_[40]; snprintf (why_, sizeof why_, __VA_ARGS__); \
    PG_FAIL (PG_E_FILE, "%.400s, %s: %s", (g)->c.file->path, gmsh_at ((g), at_), why_); } while (0)

/* 1 if the file begins like a Gmsh file; *version: the version of its format. */
int       gmsh_knows   (const mesh_file *file, double *version);
/* Reads the header up to and with $EndMeshFormat. */
pg_status gmsh_open    (gmsh_reader *g, pg_mesh_builder *m, const mesh_file *file);
/* Finds the next line "$Name"; 0: the end of the file. */
int       gmsh_section (gmsh_reader *g, char name[64]);
/* gmsh_skip moves behind "$EndName"; gmsh_end fails unless "$EndName" comes next; gmsh_names reads the body
 * of $PhysicalNames. */
pg_status gmsh_skip    (gmsh_reader *g, const char *name);
pg_status gmsh_end     (gmsh_reader *g, const char *name);
pg_status gmsh_names   (gmsh_reader *g);
/* Reads the next line that is not blank; a fault names `what` was expected there. */
pg_status gmsh_line    (gmsh_reader *g, const char *what, const char **at, const char **last);
/* Reads n whole numbers from one line of text. */
pg_status gmsh_wholes  (gmsh_reader *g, const char *what, int n, long *value);
/* Reads the three coordinates of a node from a line of text. */
pg_status gmsh_place   (gmsh_reader *g, const char **at, const char *last, double x[3]);
/* Looks up an element type by its number. Of an unknown one the builder is told the number of the first such
 * element and its group (a group of dimension dim; 0: of any dimension). */
pg_status gmsh_kind    (gmsh_reader *g, long type, long element, int dim, long group, gmsh_type *out);
/* Hands an element to the builder, with its nodes in the order of Exodus. */
pg_status gmsh_element (gmsh_reader *g, const gmsh_type *type, long id, const long *node, long group,
                        long line);
/* A fault unless n records of `size` bytes are left. */
pg_status gmsh_has_left    (gmsh_reader *g, const char *what, size_t n, size_t size);
/* Read a binary number of 4 or 8 bytes; gmsh_has_left must have found that it is there. */
int       gmsh_int     (gmsh_reader *g);
long      gmsh_long    (gmsh_reader *g);
double    gmsh_double  (gmsh_reader *g);
#endif
