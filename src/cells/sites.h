/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: which sites of a lattice (vertices, or centres of cells) are points, and their numbers. */
#ifndef PERIGAL_CELLS_SITES_H
#define PERIGAL_CELLS_SITES_H
#include "perigal/cells.h"

typedef struct {
    const pg_lattice *l;
    int     centred;                                   /* sites are the cells, else the vertices */
    int     size[3];                                   /* per axis */
    int    *number;                                    /* of the point at each site, -1: none */
    unsigned char *around;                             /* kept cells around each vertex */
} cells_sites;
pg_status cells_sites_create (cells_sites *out, const pg_lattice *l, const pg_cloud *cloud);
void      cells_sites_clear  (cells_sites *s);
/* Lattice cell whose low corner is at x. */
void      cells_sites_cell   (const cells_sites *s, const double *low, int *i);
/* The points of a lattice cell: its vertices, or its centre; outer: only those not surrounded by kept cells
 * (a centre: itself, or where it is no point those across its faces). Returns how many (at most 8). */
int       cells_sites_points (const cells_sites *s, const int *i, int outer, int *point);
/* The point at a vertex; -1: none, or points are centres. */
int       cells_sites_at     (const cells_sites *s, const double *x);
#endif
