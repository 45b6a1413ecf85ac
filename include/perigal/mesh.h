/* SPDX-License-Identifier: GPL-3.0-or-later
 * mesh.h: finite elements (shape functions, faces, quadrature), meshes, fields on them, and
 * search for the element that holds a place. Knows no scene: faults are returned as pg_error (PG_E_FILE) that
 * names file and line, or element. */
#ifndef PERIGAL_MESH_H
#define PERIGAL_MESH_H
#include "perigal/base.h"

PG_API_BEGIN

/* ---- elements ------------------------------------------------------------------------------------------ */
/* Nodes in the order of Exodus II: corners, then middles of edges, (QUAD9, HEX27) centre and faces. Reference
 * elements: bars, quads and hexes [-1, 1]^d; triangles and tets 0 <= xi, sum <= 1; wedges triangle x [-1,
 * 1]. */
typedef enum { PG_POINT1, PG_BAR2, PG_BAR3, PG_TRI3, PG_TRI6, PG_QUAD4, PG_QUAD8, PG_QUAD9, PG_TET4, PG_TET10,
               PG_HEX8, PG_HEX20, PG_HEX27, PG_WEDGE6, PG_WEDGE15, PG_ELEMENTS } pg_element;
enum { PG_ELEMENT_NODES = 27, PG_ELEMENT_POINTS = 125 };               /* at most */
typedef struct {
    const char *name;                                  /* "tri6" */
    int dim, nodes, corners, order;                    /* of its own space; order 1, 2 */
    int faces, edges;                                  /* faces: of dimension dim - 1 */
} pg_element_type;
extern const pg_element_type pg_element_types[PG_ELEMENTS];
/* Face f of an element: its kind, and its nodes (numbers within the element), so ordered that the normal
 * points outward: in 3D counter-clockwise seen from outside; in 2D the element lies to the left. Faces are
 * numbered as sides in Exodus (from 0). */
pg_element pg_element_face  (pg_element kind, int f, int node[9]);
/* xi of a node. */
void       pg_element_node  (pg_element kind, int node, double *xi);
/* Two corners of edge e (the middle node of a quadratic element: corners + e). */
void       pg_element_edge  (pg_element kind, int e, int node[2]);
/* N (nodes) and dN/dxi (nodes x dim of the element; may be NULL) at xi. */
void       pg_element_shape (pg_element kind, const double *xi, double *N, double *dN);
/* Quadrature on the reference element, all weights positive, symmetric under the symmetries of the element:
 * quads and hexes order^d Gauss points (the first axis runs fastest, degree 2 order - 1); triangles 1, 3, 7,
 * 12, 16 and tetrahedra 1, 4, 14, 24, 46 points, exact to degree 1, 2, 5, 6, 8; wedges the product of both.
 * order 1..5. Room for PG_ELEMENT_POINTS. Returns n. */
int        pg_element_rule  (pg_element kind, int order, double *xi /* n x dim */, double *weight);
/* Gauss-Legendre nodes and weights on [-1, 1], order 1..5. */
void       pg_gauss_rule    (int order, double *x, double *w);
/* Place, and size factor of the map of an element of dimension d into space of `dim` (length, area, volume;
 * signed where d = dim); normal (NULL, or dim): of an element with d = dim - 1, by the order of its nodes
 * outward as pg_element_face, unit length (a point in 1D: +1; other elements: 0). place, normal: NULL or dim
 * numbers. x: nodes x dim. */
double pg_element_map (pg_element kind, int dim, const double *x, const double *xi, double *place,
                       double *normal);
/* Newton: xi of a place in an element with d = dim; 0: it did not converge. Inside is for the caller to judge
 * (pg_element_outside). */
int        pg_element_invert  (pg_element kind, const double *x, const double *place, double *xi);
/* how far xi lies outside, reference units; <= 0: inside */
double     pg_element_outside (pg_element kind, const double *xi);

/* ---- meshes -------------------------------------------------------------------------------------------- */
typedef struct { char name[64]; int id; size_t n; int *node; } pg_mesh_nodes;  /* node set, ascending */
/* faces of solid elements, side from 0 */
typedef struct { char name[64]; int id; size_t n; int *element, *side; } pg_mesh_sides;
typedef struct { char name[64]; int id; size_t n; } pg_mesh_block;  /* n: elements in it */
typedef struct {
    int     dim;                                       /* of the solid elements: 1, 2, 3 */
    size_t  nnode;
    double *x;                                         /* place, in units of the file (nnode x 3) */
    long   *node_id;                                   /* number in the file (nnode) */
    size_t  n;  /* solid elements (dimension dim), those of lower dimension become sets */
    unsigned char *kind;                               /* pg_element (n) */
    size_t *start;  int *node;                         /* nodes of e: node[start[e]..start[e+1]) (n + 1) */
    int    *block;                                     /* index into blocks (n) */
    long   *element_id;                                /* number in the file (n) */
    size_t  nblock, nnodes, nsides;
    pg_mesh_block *blocks;
    pg_mesh_nodes *nodes;  /* node sets: those of the file, and the nodes of every side set */
    pg_mesh_sides *sides;
} pg_mesh;
/* Frees what the mesh holds and zeroes it. */
void      pg_mesh_clear (pg_mesh *mesh);
/* A mesh under construction (readers, generators, tests). Nodes and elements have any numbers; the nodes of
 * an element come in the order of Exodus II (pg_element), whatever the order of the file. Faults are
 * PG_E_FILE and name `path`. */
typedef struct pg_mesh_builder pg_mesh_builder;
pg_status pg_mesh_builder_create  (pg_mesh_builder **out, const char *path);
void      pg_mesh_builder_free    (pg_mesh_builder **m);
pg_status pg_mesh_builder_node    (pg_mesh_builder *m, long id, const double *x);
/* group: number that names the block (elements of the highest dimension) or set (all others) this element
 * belongs to, 0: block "0", no set; names come by pg_mesh_builder_group, else the number is the name. line:
 * of the file, 0 unknown. An element of the highest dimension given again with the same nodes and another
 * group joins a node set of that group. */
pg_status pg_mesh_builder_element (pg_mesh_builder *m, long id, pg_element kind, const long *node, long group,
                                   long line);
pg_status pg_mesh_builder_group   (pg_mesh_builder *m, int dim, long group, const char *name);
/* a set; the next calls fill it */
pg_status pg_mesh_builder_nodeset (pg_mesh_builder *m, const char *name, long id);
pg_status pg_mesh_builder_nodeset_add (pg_mesh_builder *m, long node);
pg_status pg_mesh_builder_sideset (pg_mesh_builder *m, const char *name, long id);
pg_status pg_mesh_builder_sideset_add (pg_mesh_builder *m, long element,
                                       int side /* from 0, as pg_element_face */);
pg_status pg_mesh_builder_finish  (pg_mesh_builder *m, pg_mesh *out);  /* resolves ids, checks, sorts */
/* What the builder was given so far, in the numbers of the file; borrowed, until the next call that adds
 * to it. */
typedef struct {
    size_t nnode;                                      /* nodes */
    const long *node_id;                               /* their numbers (nnode) */
    size_t n;                                          /* elements of all dimensions */
    const long *element_id;                            /* their numbers (n) */
    const long *group;                                 /* as given by pg_mesh_builder_element (n) */
    const unsigned char *kind;                         /* pg_element (n) */
    /* nodes of element e: node[start[e]..start[e + 1])  (n + 1) */
    const size_t *start;
    const long *node;                                  /* numbers of nodes */
} pg_mesh_given;
pg_mesh_given pg_mesh_builder_given (const pg_mesh_builder *m);
/* Puts the element at place e of what was given into another group. */
void pg_mesh_builder_regroup (pg_mesh_builder *m, size_t e, long group);
/* Gives nodes and elements the numbers of a map, for files that first count them from 1 and then say how
 * they are called: what is called k becomes node[k - 1] or element[k - 1], in elements and sets as well.
 * NULL leaves the numbers as they are. A number beyond the map (nnode, n entries) leaves everything as it
 * is: the builder finds that fault when it finishes. */
void pg_mesh_builder_renumber (pg_mesh_builder *m, size_t nnode, const long *node, const long *element);

/* ---- numbers of a file --------------------------------------------------------------------------------- */
/* Where in a list does a number stand? In constant time: by a table where the numbers are dense, else by
 * hash. */
typedef struct { long low; size_t range, n; int *direct; const long *id; unsigned mask; } pg_id_table;
/* Table of n numbers, borrowed; a number given twice is found as *twice (its second place; n: none). */
pg_status pg_id_table_build (pg_id_table *t, size_t n, const long *id, size_t *twice);
long      pg_id_table_find  (const pg_id_table *t, long id);                           /* -1: not there */
void      pg_id_table_clear (pg_id_table *t);

/* Faces that belong to one solid element only: n, element and side (pg_free both). */
pg_status pg_mesh_surface (const pg_mesh *mesh, size_t *n, int **element, int **side);

/* ---- fields -------------------------------------------------------------------------------------------- */
/* at nodes: nnode x components; tensors xx yy zz xy yz zx */
typedef struct { char name[32]; int components; double *value; } pg_mesh_field;
void      pg_mesh_fields_clear (size_t n, pg_mesh_field **fields);
/* Plane elements that CalculiX made solid: a mesh one element thick between two planes z = const becomes the
 * plane mesh between them, its nodes named as those at the lower z, x and y and fields the mean of both sides
 * (vectors: without z). PG_E_USAGE: it is not one. */
pg_status pg_mesh_flatten (pg_mesh *mesh, size_t nfield, pg_mesh_field *fields);
/* Field at xi of an element: out[components]. */
void pg_mesh_value (const pg_mesh *mesh, const pg_mesh_field *field, size_t element, const double *xi,
                    double *out);
/* Its gradient, out[components x dim] = d value_c / d x_a; 0: the element is turned inside out there. */
int pg_mesh_gradient (const pg_mesh *mesh, const pg_mesh_field *field, size_t element, const double *xi,
                      double *out);

/* ---- search -------------------------------------------------------------------------------------------- */
typedef struct pg_mesh_locator pg_mesh_locator;  /* a tree of boxes over the elements; borrows the mesh */
pg_status pg_mesh_locator_create (pg_mesh_locator **out, const pg_mesh *mesh);
void      pg_mesh_locator_free   (pg_mesh_locator **locator);
/* Element that holds the place (dim of the mesh) and its xi (dim); of several, on a face between them, the
 * lowest. A place is in an element up to 1e-9 of its reference element. Outside: the element nearest to it,
 * xi of the nearest place in it, *away the distance from there in sizes of that element (longest side of the
 * box of its corners; 0 inside). -1: none is as near as its own size. away NULL: -1 for every place outside,
 * which is quicker. Thread-safe. */
long pg_mesh_locator_find (const pg_mesh_locator *locator, const double *place, double *xi, double *away);
/* How deep a place lies in an element, in units of its reference element: the largest of all elements whose
 * boxes hold it, or the first that is `enough`; negative: outside of them, -HUGE_VAL: far from all. Quick: no
 * search for the nearest. */
double    pg_mesh_locator_depth  (const pg_mesh_locator *locator, const double *place, double enough);

/* ---- distance to the surface --------------------------------------------------------------------------- */
typedef struct pg_mesh_skin pg_mesh_skin;  /* the faces of pg_mesh_surface in a tree; borrows the mesh */
pg_status pg_skin_create (pg_mesh_skin **out, const pg_mesh *mesh);
void      pg_skin_free   (pg_mesh_skin **skin);
/* Distance (no sign) to the surface where that is at most `reach`, else HUGE_VAL; *face: the number of the
 * nearest face (NULL, or -1 where there is none; of equals the lowest). Straight and plane faces to rounding,
 * curved ones by Newton's method from their middle. Thread-safe. */
double    pg_skin_distance (const pg_mesh_skin *skin, const double *place, double reach, long *face);
/* Element and side of a face. low, high (dim): box of the surface, curved faces to 1/1000 of their height.
 * Its size (length, area). */
void      pg_skin_face   (const pg_mesh_skin *skin, size_t face, int *element, int *side);
void      pg_skin_box    (const pg_mesh_skin *skin, double *low, double *high);
double    pg_skin_size   (const pg_mesh_skin *skin);
PG_API_END
#endif
