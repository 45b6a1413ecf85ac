/* SPDX-License-Identifier: GPL-3.0-or-later
 * gmsh.h: what versions 2.2 and 4.1 of Gmsh's format share: header, sections, names of groups, types of
 * elements, binary numbers. */
#ifndef MESH_GMSH_H
#define MESH_GMSH_H
#include "format.h"
#include <stdio.h>

typedef struct {
    mesh_cursor    c;
    pg_mesh_builder *m;
    double         version;
    int            binary, swap;                       /* swap: the other byte order */
} gmsh_reader;
/* order[k]: place in Gmsh's list of node k in the order of Exodus. */
typedef struct { int known; pg_element kind; const signed char *order; } gmsh_type;

/* Place in the file: "line 7" or "byte 1200". */
const char *gmsh_at (const gmsh_reader *g, char text[40]);
#define GMSH_FAIL(g, ...) do { char why_[400], at_[40]; snprintf (why_, sizeof why_, __VA_ARGS__); \
    PG_FAIL (PG_E_FILE, "%.400s, %s: %s", (g)->c.file->path, gmsh_at ((g), at_), why_); } while (0)

int       gmsh_knows   (const mesh_file *file, double *version);
/* up to and with $EndMeshFormat */
pg_status gmsh_open    (gmsh_reader *g, pg_mesh_builder *m, const mesh_file *file);
int       gmsh_section (gmsh_reader *g, char name[64]);  /* next "$Name"; 0: end of file */
pg_status gmsh_skip    (gmsh_reader *g, const char *name);  /* past "$EndName" */
pg_status gmsh_end     (gmsh_reader *g, const char *name);  /* here must be "$EndName" */
pg_status gmsh_names   (gmsh_reader *g);  /* body of $PhysicalNames */
/* Next line that is not blank; a fault names what was awaited. */
pg_status gmsh_line    (gmsh_reader *g, const char *what, const char **at, const char **last);
/* n whole numbers of one line of text. */
pg_status gmsh_wholes  (gmsh_reader *g, const char *what, int n, long *value);
/* Number, place: "number x y z". */
pg_status gmsh_place   (gmsh_reader *g, const char **at, const char *last, double x[3]);
pg_status gmsh_kind    (gmsh_reader *g, long type, long element, gmsh_type *out);
pg_status gmsh_element (gmsh_reader *g, const gmsh_type *type, long id, const long *node, long group,
                        long line);
/* Are there n records of `size` bytes left? */
pg_status gmsh_has_left    (gmsh_reader *g, const char *what, size_t n, size_t size);
int       gmsh_int     (gmsh_reader *g);  /* after gmsh_has_left */
long      gmsh_long    (gmsh_reader *g);
double    gmsh_double  (gmsh_reader *g);
#endif
