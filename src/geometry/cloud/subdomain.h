/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: sites of a lattice, and the part of them that a rank holds (subdomain.c). */
#ifndef PG_CLOUD_SUBDOMAIN_H
#define PG_CLOUD_SUBDOMAIN_H
#include "perigal/cloud.h"

/* The sites of a lattice: its vertices or cells. */
typedef struct {
    /* Sites along each axis. */
    size_t size[3];
    /* All of them. */
    size_t n;
    /* Coordinate index of site 0: 0 for vertices, 0.5 for centres. */
    double shift;
    /* Number of cells around a site inside the body, which may be moved. */
    int    whole;
    /* Kept cells around each site; 0: no point there (n). */
    unsigned char *around;
} sites;

/* Counts the kept cells around all sites (points.c). */
pg_status cloud_count_around (sites *s, const pg_lattice *l, int cells);
/* The cells of each of `size` ranks (boxes: pg_free). l: counts and steps of the whole lattice. */
pg_status cloud_divide (pg_box **boxes, const pg_lattice *l, const pg_body *body, int size);
/* The cells that a rank with these cells of its own holds: those around the sites that it owns and around a
 * layer of ghosts of `width`, m. l: the whole lattice. */
pg_box    cloud_cells_held (const pg_box *cells, const pg_lattice *l, double width, int centred);
/* Number of site i in the whole lattice, from 0. */
int64_t   cloud_site_number (const sites *s, const pg_lattice *l, size_t i);
/* Who owns the points at the sites, and what is exchanged with whom, as rank `rank` of `size` sees it; total
 * is left 0. */
pg_status cloud_subdomain (pg_subdomain **out, const sites *s, const pg_lattice *l, const pg_box *boxes,
                           double width, int rank, int size);
/* How points that no lattice gives are divided (subdomain_points.c): which rank owns each of them; of each
 * rank the box of its points and the width of its layer of ghosts, m (size). */
typedef struct { double low[3], high[3]; } cloud_region;
typedef struct { int size, *owner; cloud_region *box; double *width; } cloud_division;
/* width: of the layer where the spacing is the nominal one. */
pg_status cloud_divide_points  (cloud_division *out, const pg_cloud *cloud, double width, int size);
void      cloud_division_clear (cloud_division *division);
/* As cloud_subdomain, of all points of the body. */
pg_status cloud_subdomain_of_points (pg_subdomain **out, const pg_cloud *cloud,
                                     const cloud_division *division, int rank);
/* empty: some rank owns none of the `total` points, which is refused: PG_E_LIMIT. */
pg_status cloud_count_owned (double total, int empty, int size);
#endif
