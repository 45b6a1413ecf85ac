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

/* The cells of every rank (boxes: pg_free), and those that this one holds: the cells around the sites that it
 * owns and around a layer of ghosts of `width`, m. l: counts and steps of the whole lattice. */
pg_status cloud_divide (pg_box **boxes, pg_box *held, const pg_lattice *l, const pg_body *body, double width,
                        int centred);
/* Number of site i in the whole lattice, from 0. */
int64_t   cloud_site_number (const sites *s, const pg_lattice *l, size_t i);
/* Who owns the points at the sites, and what is exchanged with whom. */
pg_status cloud_subdomain (pg_subdomain **out, const sites *s, const pg_lattice *l, const pg_box *boxes,
                           double width);
#endif
