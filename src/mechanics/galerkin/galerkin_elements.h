/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: finite elements on the nodes of the Galerkin form while they are made. galerkin_elements_list.c
 * finds them, galerkin_elements.c sums up their matrices, galerkin_elements_values.c makes N; galerkin_hats.c
 * makes those on a coarse grid. */
#ifndef PG_GALERKIN_ELEMENTS_H
#define PG_GALERKIN_ELEMENTS_H
#include "mechanics/galerkin/weak_form/galerkin.h"
#include "perigal/vector.h"

/* Kinds of elements besides those of meshes: around an evaluation point; springs of a supported facet
 * point. */
enum { MOST_NODES = 64, NO_CELL = -1, SPRINGS = -2 };

/* The elements while they are listed: nodes of each, the evaluation point or cell it belongs to, and the
 * share of the weight of the point. */
typedef struct {
    galerkin *g;
    int set;                                           /* bond set of the points with elements of their own */
    pg_adjacency list;
    size_t cap_start, cap_node, cap_of, cap_cell, cap_weight;
    size_t *of;                                        /* evaluation point, cell, or facet point */
    int    *cell;                                      /* kind of element, NO_CELL: of a point, SPRINGS */
    double *weight;                                    /* of the point */
    double  reach;
    int     classes;                                   /* boxes join nodes of one class, two steps apart */
    double *K, *last;                                  /* matrix of an element; of the last whole cell */
    double  shape[MOST_NODES * 3]; int shape_kind; const pg_material *shape_material;
} element_list;

/* Lists the elements of all cells and points, of the bonds that live. */
pg_status elements_find (element_list *b);
/* Values of the shape functions at the nodes, tempered beside cracks; Q: stiffness of the elements. */
pg_status elements_values (const galerkin *g, const pg_block_matrix *Q, pg_node_matrix *N);
/* Is a penalty so stiff that it is taken on its own (pg_elements.W)? */
int       elements_stiff (const galerkin *g, const constraint *q);
/* galerkin_hats.c: is it elements on a coarse grid that precondition? They, of a body whose W is known. */
int       galerkin_takes_hats (const galerkin *g);
pg_status galerkin_hats (galerkin *g, pg_elements *out);
/* Coordinates of a node, m (dim). */
static inline const double *place (const galerkin *g, int node)
{
    return g->problem->cloud.x + (size_t) node * (size_t) g->dim;
}
/* The node nearest to x among those that point p sees, *d2 its squared distance. */
int       elements_nearest (const galerkin *g, const pg_rows *r, size_t p, const double *x, double *d2);
/* Is entry e of point p a broken bond? */
int       elements_broken (const galerkin *g, const pg_rows *r, size_t p, size_t e);
#endif
