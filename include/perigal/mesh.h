/* SPDX-License-Identifier: GPL-3.0-or-later
 * mesh.h: finite elements (shape functions, faces, quadrature), meshes, fields on their nodes, and search for
 * the element that contains a position. Knows no scene: errors are returned by pg_error (PG_E_FILE) with file
 * and line, or the element. */
#ifndef PERIGAL_MESH_H
#define PERIGAL_MESH_H
#include "perigal/base.h"

PG_API_BEGIN

/* ---- elements ------------------------------------------------------------------------------------------ */
/* Kinds of elements, nodes in the order of Exodus II: corners, then middles of edges, then (QUAD9, HEX27)
 * centre and middles of faces. Reference elements, coordinates xi: bars, quadrilaterals and hexahedra [-1,
 * 1]^d; triangles and tetrahedra xi >= 0, sum <= 1; wedges triangle x [-1, 1]; pyramids 0 <= z <= 1,
 * |x|, |y| <= 1 - z. */
typedef enum { PG_POINT1, PG_BAR2, PG_BAR3, PG_TRI3, PG_TRI6, PG_QUAD4, PG_QUAD8, PG_QUAD9, PG_TET4, PG_TET10,
               PG_HEX8, PG_HEX20, PG_HEX27, PG_WEDGE6, PG_WEDGE15, PG_PYRAMID5,
               PG_ELEMENTS } pg_element;
/* Maximum numbers of nodes of an element, of points of a quadrature rule. */
enum { PG_ELEMENT_NODES = 27, PG_ELEMENT_POINTS = 125 };

/* Properties of a kind of element. */
typedef struct {
    /* Name as in messages: "tri6". */
    const char *name;
    /* Dimension of the element itself; numbers of nodes and of corners; degree of the shape functions, 1 or
     * 2. */
    int dim, nodes, corners, order;
    /* Numbers of faces (of dimension dim - 1) and of edges. */
    int faces, edges;
} pg_element_type;
/* Indexed by pg_element. */
extern const pg_element_type pg_element_types[PG_ELEMENTS];
/* Face f of an element (numbered from 0 as the sides of Exodus): returns its kind, and its nodes as numbers
 * within the element, in an order that makes its normal point outward: in 3D counter-clockwise seen from
 * outside; in 2D the element lies to the left. */
pg_element pg_element_face  (pg_element kind, int f, int node[9]);
/* Reference coordinates of a node. */
void       pg_element_node  (pg_element kind, int node, double *xi);
/* The two corners of edge e; the middle node of a quadratic element has the number corners + e. */
void       pg_element_edge  (pg_element kind, int e, int node[2]);
/* Shape functions N (nodes) and, unless dN is NULL, their derivatives dN/dxi (nodes x dim of the element)
 * at xi. */
void       pg_element_shape (pg_element kind, const double *xi, double *N, double *dN);
/* Quadrature on the reference element, order 1 to 5: points xi (n x dim), weights (n), room for
 * PG_ELEMENT_POINTS; returns n. Weights are positive, and the rules have the symmetries of the element.
 * Quadrilaterals and hexahedra: order^d Gauss points, the first axis fastest, exact to degree 2 order - 1.
 * Triangles 1, 3, 7, 12, 16 and tetrahedra 1, 4, 14, 24, 46 points, exact to degree 1, 2, 5, 6, 8. Wedges:
 * the product of both. Pyramids: order^3 points, exact to degree 2 order - 1. */
int        pg_element_rule  (pg_element kind, int order, double *xi /* n x dim */, double *weight);
/* Gauss-Legendre points and weights on [-1, 1], order 1 to 5 (other orders are moved into that range). */
void       pg_gauss_rule    (int order, double *x, double *w);
/* The isoparametric map of an element of dimension d into space of dimension `dim`: returns its size factor
 * at xi (length, area, volume per reference unit; signed where d = dim). x: nodes x dim. place and normal
 * may be NULL, else dim numbers. normal: unit normal of an element with d = dim - 1, outward by the order
 * of nodes of pg_element_face (a point in 1D: +1); zero for other elements. */
double pg_element_map (pg_element kind, int dim, const double *x, const double *xi, double *place,
                       double *normal);
/* Isoparametric map as pg_element_map, from given N and dN at xi (pg_element_shape), which elements of a kind
 * share. */
double pg_element_map_by (pg_element kind, int dim, const double *x, const double *N, const double *dN,
                          double *place, double *normal);
/* Reference coordinates of a place in an element with d = dim, by Newton's method; 0: it did not converge.
 * Whether the place is inside is for the caller to judge (pg_element_outside). */
int        pg_element_invert  (pg_element kind, const double *x, const double *place, double *xi);
/* How far xi lies outside of the reference element, in its units; <= 0: inside. */
double     pg_element_outside (pg_element kind, const double *xi);

/* ---- meshes -------------------------------------------------------------------------------------------- */
/* A node set: its nodes, ascending. */
typedef struct { char name[64]; int id; size_t n; int *node; } pg_mesh_nodes;
/* A side set: faces of solid elements, sides numbered from 0. */
typedef struct { char name[64]; int id; size_t n; int *element, *side; } pg_mesh_sides;
/* A block: a group of n elements, usually of one material. */
typedef struct { char name[64]; int id; size_t n; } pg_mesh_block;

/* Something that the reader of a file ignored ("*MATERIAL", "section $NodeData"), and how often. */
typedef struct { char what[96]; size_t n; } pg_mesh_passed;
/* Elements of a type that is not known, which are not in the mesh: what to say of them (file, line, type),
 * and the block that they belong to ("" for none). */
typedef struct { char block[64], words[400]; } pg_mesh_foreign;

/* A mesh. Solid elements are those of the highest dimension in the file; elements of lower dimension become
 * sets. */
typedef struct {
    /* Dimension of the solid elements, 1 to 3. */
    int     dim;
    /* Number of nodes. */
    size_t  nnode;
    /* Positions of the nodes, in units of the file (nnode x 3). */
    double *x;
    /* Number of each node in the file (nnode). */
    long   *node_id;
    /* Number of solid elements. */
    size_t  n;
    /* Kind of each, a pg_element (n). */
    unsigned char *kind;
    /* Nodes of element e: node[start[e]] .. node[start[e + 1] - 1] (start: n + 1). */
    size_t *start;  int *node;
    /* Index into blocks (n). */
    int    *block;
    /* Number of each element in the file (n). */
    long   *element_id;
    /* Numbers of blocks, node sets and side sets. */
    size_t  nblock, nnodes, nsides;
    pg_mesh_block *blocks;
    /* Node sets: those of the file, and the nodes of every side set. */
    pg_mesh_nodes *nodes;
    pg_mesh_sides *sides;
    /* Content of the file that is not in the mesh: what was ignored, and elements of unknown type (foreign),
     * which leave holes where they belong to the body: the user of the mesh checks whether their blocks are
     * needed. */
    size_t  npassed, nforeign;
    pg_mesh_passed  *passed;
    pg_mesh_foreign *foreign;
    /* First element type of the file that stands for plane strain (CPE4); "": there is none. */
    char    plane_strain[32];
} pg_mesh;
/* Frees what the mesh holds and zeroes it. */
void      pg_mesh_clear (pg_mesh *mesh);
/* A mesh under construction, for readers, generators and tests. Nodes and elements may have any numbers;
 * the nodes of an element come in the order of Exodus II (pg_element), whatever the order in the file.
 * Faults are PG_E_FILE and name `path`. */
typedef struct pg_mesh_builder pg_mesh_builder;
pg_status pg_mesh_builder_create  (pg_mesh_builder **out, const char *path);
void      pg_mesh_builder_free    (pg_mesh_builder **m);
/* Adds a node at x (3 coordinates). */
pg_status pg_mesh_builder_node    (pg_mesh_builder *m, long id, const double *x);
/* Adds an element. group: number of the block (elements of the highest dimension) or set (others) that the
 * element belongs to; 0: block "0", or no set. Names come by pg_mesh_builder_group, else the number is the
 * name. line: of the file, 0: unknown. An element of the highest dimension that is given again with the
 * same nodes and another group joins a node set of that group. */
pg_status pg_mesh_builder_element (pg_mesh_builder *m, long id, pg_element kind, const long *node, long group,
                                   long line);
/* Names the group of that number and dimension; an empty name is ignored. */
pg_status pg_mesh_builder_group   (pg_mesh_builder *m, int dim, long group, const char *name);
/* Begins a node set; the following calls fill it. Without a name its number is the name. */
pg_status pg_mesh_builder_nodeset (pg_mesh_builder *m, const char *name, long id);
pg_status pg_mesh_builder_nodeset_add (pg_mesh_builder *m, long node);
/* Begins a side set called `name` (NULL, "": `id`); its sides are numbered from 0 as by pg_element_face. */
pg_status pg_mesh_builder_sideset (pg_mesh_builder *m, const char *name, long id);
pg_status pg_mesh_builder_sideset_add (pg_mesh_builder *m, long element,
                                       int side /* from 0, as pg_element_face */);
/* Records that something in the file is ignored; equal texts are counted. */
pg_status pg_mesh_builder_pass    (pg_mesh_builder *m, const char *format, ...)
    __attribute__ ((format (printf, 2, 3)));
/* Records elements of an unknown type that are left out, in this block ("": none); words: message about them,
 * kept for the first of a type and block. */
pg_status pg_mesh_builder_foreign (pg_mesh_builder *m, const char *type, const char *block,
                                   const char *words);
/* Records that elements of this type stand for plane strain. */
void      pg_mesh_builder_plane_strain (pg_mesh_builder *m, const char *type);
/* The name of a group that has got one, else its number; dim 0: of any dimension. */
void      pg_mesh_builder_group_name (const pg_mesh_builder *m, int dim, long group, char name[64]);
/* Resolves numbers, checks everything and sorts; `out` becomes the mesh. On failure nothing remains in it. */
pg_status pg_mesh_builder_finish  (pg_mesh_builder *m, pg_mesh *out);

/* What a builder was given so far, in the numbers of the file; borrowed, until the next call that adds to
 * it. */
typedef struct {
    /* Number of nodes. */
    size_t nnode;
    /* Their numbers (nnode). */
    const long *node_id;
    /* Number of elements of all dimensions. */
    size_t n;
    /* Their numbers (n). */
    const long *element_id;
    /* Groups as given (n). */
    const long *group;
    /* Kinds, pg_element (n). */
    const unsigned char *kind;
    /* Nodes of element e: node[start[e]] .. node[start[e + 1] - 1] (start: n + 1). */
    const size_t *start;
    /* Numbers of nodes. */
    const long *node;
    /* Kinds of elements that were left out, as they are not known. */
    size_t nforeign;
} pg_mesh_given;
pg_mesh_given pg_mesh_builder_given (const pg_mesh_builder *m);
/* Moves element e of pg_mesh_builder_given into another group. */
void pg_mesh_builder_regroup (pg_mesh_builder *m, size_t e, long group);
/* Renumbers nodes and elements, for files that give their numbers at the end: number k becomes node[k - 1] or
 * element[k - 1], in elements and sets as well. NULL leaves the numbers. Where a number lies beyond the map
 * (nnode entries) nothing is changed: the builder finds that fault when it finishes. */
void pg_mesh_builder_renumber (pg_mesh_builder *m, size_t nnode, const long *node, const long *element);

/* ---- numbers of a file --------------------------------------------------------------------------------- */
/* Finds the index of a number in a list in constant time: by a table where the numbers are dense, else by a
 * hash table. */
typedef struct { long low; size_t range, n; int *direct; const long *id; unsigned mask; } pg_id_table;
/* Builds the table of n numbers (borrowed). *twice: the second index of a number that occurs twice; n: none
 * does. */
pg_status pg_id_table_build (pg_id_table *t, size_t n, const long *id, size_t *twice);
/* Index of a number in the list; -1: it is not in it. */
long      pg_id_table_find  (const pg_id_table *t, long id);
void      pg_id_table_clear (pg_id_table *t);

/* Finds the outer faces (of one solid element only): n of them, element and side of each (free both by
 * pg_free), ordered by element and side. PG_E_MEMORY, PG_E_LIMIT. */
pg_status pg_mesh_surface (const pg_mesh *mesh, size_t *n, int **element, int **side);

/* ---- fields -------------------------------------------------------------------------------------------- */
/* A field at the nodes (nnode x components); tensors in the order xx yy zz xy yz zx. */
typedef struct { char name[32]; int components; double *value; } pg_mesh_field;
void      pg_mesh_fields_clear (size_t n, pg_mesh_field **fields);
/* Turns a mesh one element thick between two planes of constant z, as CalculiX makes of plane elements,
 * into the plane mesh: nodes keep the numbers of those at the lower z; x, y and fields become the means of
 * both sides (vectors lose their z). PG_E_USAGE: it is not such a mesh; nothing is changed then. */
pg_status pg_mesh_flatten (pg_mesh *mesh, size_t nfield, pg_mesh_field *fields);
/* Value of a field at xi of an element: out (components). */
void pg_mesh_value (const pg_mesh *mesh, const pg_mesh_field *field, size_t element, const double *xi,
                    double *out);
/* Gradient of a field at xi of an element: out (components x dim), d value_c / d x_a, per unit of x. 0: the
 * element is turned inside out there, and out is zero. */
int pg_mesh_gradient (const pg_mesh *mesh, const pg_mesh_field *field, size_t element, const double *xi,
                      double *out);

/* ---- search -------------------------------------------------------------------------------------------- */
/* Search for elements: a tree of boxes over the elements; borrows the mesh. All questions are thread-safe. */
typedef struct pg_mesh_locator pg_mesh_locator;
/* Builds the tree, O(n log n). PG_E_USAGE: no elements; PG_E_MEMORY. */
pg_status pg_mesh_locator_create (pg_mesh_locator **out, const pg_mesh *mesh);
void      pg_mesh_locator_free   (pg_mesh_locator **locator);
/* The element that holds a place (dim coordinates) and its xi there; of several, on a face between them,
 * the lowest. A place counts as inside to 1e-9 of the reference element. Outside: the nearest element, xi
 * of the nearest place in it, and *away, the distance in sizes of that element (longest edge of the box of
 * its corners; 0 inside); -1 where none is as near as its own size. away NULL: -1 for every place outside,
 * which is quicker. */
long pg_mesh_locator_find (const pg_mesh_locator *locator, const double *place, double *xi, double *away);
/* How deep a place lies in an element, in units of its reference element: the largest depth over all
 * elements whose boxes hold the place, or the first one that reaches `enough`. Negative: outside of these;
 * -HUGE_VAL: in no box. No search for the nearest element. */
double    pg_mesh_locator_depth  (const pg_mesh_locator *locator, const double *place, double enough);

/* ---- distance to the surface --------------------------------------------------------------------------- */
/* The faces of pg_mesh_surface in a tree, for distances; borrows the mesh. */
typedef struct pg_mesh_skin pg_mesh_skin;
/* Finds the surface and builds its tree. PG_E_MEMORY, PG_E_LIMIT; PG_E_USAGE: there are no faces. */
pg_status pg_skin_create (pg_mesh_skin **out, const pg_mesh *mesh);
void      pg_skin_free   (pg_mesh_skin **skin);
/* Distance (without sign) to the surface where that is at most `reach`, else HUGE_VAL. *face: number of the
 * nearest face, of equals the lowest, -1: none; may be NULL. Exact to rounding for straight and plane
 * faces; curved ones by Newton's method from their middle. Thread-safe. */
double    pg_skin_distance (const pg_mesh_skin *skin, const double *place, double reach, long *face);
/* Element and side of a face; box of the surface (low, high: dim), curved faces to 1/1000 of their height;
 * its length (2D) or area (3D). */
void      pg_skin_face   (const pg_mesh_skin *skin, size_t face, int *element, int *side);
void      pg_skin_box    (const pg_mesh_skin *skin, double *low, double *high);
double    pg_skin_size   (const pg_mesh_skin *skin);
PG_API_END
#endif
