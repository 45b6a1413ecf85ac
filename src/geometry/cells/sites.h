/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: the sites of a lattice (its vertices, or the centres of its cells) and the numbers of the points
 * that stand on them. Points of a cloud on a lattice are numbered in the order of the lattice, so that the
 * numbers can be found again from the lattice alone. */
#ifndef PERIGAL_CELLS_SITES_H
#define PERIGAL_CELLS_SITES_H
#include "perigal/cells.h"

/* Sites of a lattice. Arrays over them have the index (iz, iy, ix), x fastest. */
typedef struct {
    const pg_lattice *l;
    /* 1: points stand at the centres of cells; 0: at vertices. */
    int     centred;
    /* Number of sites along each axis, 1 beyond dim. */
    int     size[3];
    /* Number of the point at each site, -1: none. */
    int    *number;
    /* How many kept cells touch each vertex (at most 2^dim); of a centred site, whether its cell is kept. */
    unsigned char *around;
} cells_sites;
/* Whether points are centred follows from their number. PG_E_MEMORY. */
pg_status cells_sites_create (cells_sites *out, const pg_lattice *l, const pg_cloud *cloud);
void      cells_sites_clear  (cells_sites *s);
/* Indices i[3] of the lattice cell whose low corner is at `low` (m). */
void      cells_sites_cell   (const cells_sites *s, const double *low, int *i);
/* The points of lattice cell i: those at its vertices, or at its centre. outer: only vertices with fewer
 * than 2^dim kept cells around them (for centres: the cell's own point or, if it has none, those of the
 * neighbours across its faces). Returns how many, at most 8. */
int       cells_sites_points (const cells_sites *s, const int *i, int outer, int *point);
/* The point at the vertex at x (m); -1: there is none, or points are centres. */
int       cells_sites_at     (const cells_sites *s, const double *x);
#endif
