/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: sites of a lattice, and the part of them that a rank holds (subdomain.c). */
#ifndef PG_CLOUD_SUBDOMAIN_H
#define PG_CLOUD_SUBDOMAIN_H
#include "perigal/cloud.h"

/* The sites of a lattice: its vertices or cells. */
typedef struct {
    /* Sites along each axis. */
    size_t size[3];
    /* Number of all sites. */
    size_t n;
    /* Coordinate index of site 0: 0 for vertices, 0.5 for centres. */
    double shift;
    /* Number of cells counted around a site inside the body; only such sites may be perturbed. */
    int    whole;
    /* Kept cells around each site; 0: no point there (n). */
    unsigned char *around;
} sites;

/* Counts the kept cells around all sites (points.c). */
pg_status cloud_count_around (sites *s, const pg_lattice *l, int cells);
/* Divides the cells of the lattice among `size` ranks: one box of cells each (freed by pg_free). l: counts
 * and steps of the whole lattice. */
pg_status cloud_divide (pg_box **boxes, const pg_lattice *l, const pg_body *body, int size);
/* The cells that a rank holds which owns `cells`: those around the sites that it owns and around a layer of
 * ghosts of `width`, m. l: the whole lattice. */
pg_box    cloud_cells_held (const pg_box *cells, const pg_lattice *l, double width, int centred);
/* Number of site i in the whole lattice, from 0. */
int64_t   cloud_site_number (const sites *s, const pg_lattice *l, size_t i);
/* Builds the subdomain of rank `rank` of `size`: who owns the points at the sites, and what is exchanged with
 * whom; its `total` is left 0. */
pg_status cloud_subdomain (pg_subdomain **out, const sites *s, const pg_lattice *l, const pg_box *boxes,
                           double width, int rank, int size);
/* Division among ranks of points that stand on no lattice (subdomain_points.c): owner: the rank of each
 * point; box, width: of each rank the box of its points and the width of its layer of ghosts, m (size). */
typedef struct { double low[3], high[3]; } cloud_region;
typedef struct { int size, *owner; cloud_region *box; double *width; } cloud_division;
/* width: that of the layer of ghosts where the spacing is the nominal one, m. */
pg_status cloud_divide_points  (cloud_division *out, const pg_cloud *cloud, double width, int size);
void      cloud_division_clear (cloud_division *division);
/* Builds the subdomain of rank `rank` as cloud_subdomain does, from all points of the body. */
pg_status cloud_subdomain_of_points (pg_subdomain **out, const pg_cloud *cloud,
                                     const cloud_division *division, int rank);
/* Refuses (PG_E_LIMIT) a division in which some rank owns none of the `total` points (empty 1). */
pg_status cloud_count_owned (double total, int empty, int size);
#endif
