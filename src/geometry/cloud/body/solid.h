/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: what belongs to a shape that consists of elements, a mesh or an alpha shape. */
#ifndef PERIGAL_CLOUD_SOLID_H
#define PERIGAL_CLOUD_SOLID_H
#include "mesh_body.h"

struct pg_solid {
    /* Mesh: its elements. Alpha shape: `cloud` has them, and this stays empty. */
    pg_mesh_body part;
    pg_alpha_shape cloud;
    /* The search for elements and for faces. */
    pg_mesh_locator *locator;
    pg_mesh_skin *skin;
    /* Stairs: the lattice, without `in`. */
    pg_lattice lattice;
    /* Sign of the distance at the centre of each cell; 0: on the surface. */
    signed char *sign;
    /* Flat pieces of the surface. */
    pg_facets facets;
};
/* Frees the arrays of facets. */
void      facets_clear   (pg_facets *facets);
/* Sorts their pieces into columns along each axis (facet_columns.c). PG_E_MEMORY. */
pg_status facets_columns (pg_facets *facets);
#endif
