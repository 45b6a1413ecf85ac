/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: finite elements on the nodes of the Galerkin form, as a preconditioner, while they are made.
 * galerkin_elements_list.c chooses them, galerkin_elements.c sums up their matrices,
 * galerkin_elements_values.c makes the matrix N of shape functions; galerkin_hats.c makes elements on a
 * coarse grid. */
#ifndef PG_GALERKIN_ELEMENTS_H
#define PG_GALERKIN_ELEMENTS_H
#include "mechanics/galerkin/weak_form/galerkin.h"
#include "perigal/vector.h"

/* Kinds of elements besides those of meshes: NO_CELL: around an evaluation point; SPRINGS: springs of a
 * supported facet point. MOST_NODES: most nodes of an element. */
enum { MOST_NODES = 64, NO_CELL = -1, SPRINGS = -2 };

/* The list of elements: the nodes of each, the evaluation point or cell it belongs to, and its weight. */
typedef struct {
    galerkin *g;
    int set;                                           /* bond set of the points with elements of their own */
    pg_adjacency list;
    size_t cap_start, cap_node, cap_of, cap_cell, cap_weight;
    size_t *of;                                     /* number of its evaluation point, cell, or facet point */
    int    *cell;                                      /* kind of each element, or NO_CELL, SPRINGS */
    double *weight;                                 /* volume of a point, m^3; factor on a cell's matrix */
    double  reach;
    int     classes;                      /* 1: boxes are two steps wide and join nodes of one parity class */
    double *K, *last;                              /* matrix of the present element; of the last whole cell */
    double  shape[MOST_NODES * 3]; int shape_kind; const pg_material *shape_material;
} element_list;

/* Lists the elements of all cells and points, according to the bonds that are intact. */
pg_status elements_find (element_list *b);
/* N: values of the shape functions at the nodes, mixed with the unit matrix beside cracks; Q: stiffness of
 * the elements. */
pg_status elements_values (const galerkin *g, const pg_block_matrix *Q, pg_node_matrix *N);
/* Is a penalty so stiff that it is treated separately (pg_elements.W)? */
int       elements_stiff (const galerkin *g, const constraint *q);
/* galerkin_hats.c: 1: the preconditioner uses elements on a coarse grid; fills `out` with these, out->W being
 * known. */
int       galerkin_takes_hats (const galerkin *g);
pg_status galerkin_hats (galerkin *g, pg_elements *out);
/* Coordinates of a node, m (dim). */
static inline const double *place (const galerkin *g, int node)
{
    return g->problem->cloud.x + (size_t) node * (size_t) g->dim;
}
/* The node nearest to x in the family of point p; *d2: its squared distance, m^2. */
int       elements_nearest (const galerkin *g, const pg_rows *r, size_t p, const double *x, double *d2);
/* Is entry e of point p a broken bond? */
int       elements_broken (const galerkin *g, const pg_rows *r, size_t p, size_t e);
#endif
