/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: what belongs to a shape that consists of elements, a mesh or an alpha shape. */
#ifndef PERIGAL_CLOUD_SOLID_H
#define PERIGAL_CLOUD_SOLID_H
#include "mesh_body.h"

struct pg_solid {
    /* The elements of a mesh; for an alpha shape this stays empty. */
    pg_mesh_body part;
    pg_alpha_shape cloud;
    /* Search for the element at a position, and for the nearest face. */
    pg_mesh_locator *locator;
    pg_mesh_skin *skin;
    /* For PG_STAIRS: the lattice, without its array `in`. */
    pg_lattice lattice;
    /* Sign of the distance at the centre of each cell; 0: on the surface. */
    signed char *sign;
    /* The surface as flat pieces. */
    pg_facets facets;
};
/* Frees the arrays of facets. */
void      facets_clear   (pg_facets *facets);
/* Sorts the pieces of facets into columns along each axis (facet_columns.c). PG_E_MEMORY. */
pg_status facets_columns (pg_facets *facets);
#endif
