/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private to the forecast: counting on a lattice (tally.c), the factor by nested dissection (forecast.c). */
#ifndef PG_FORECAST_PRIVATE_H
#define PG_FORECAST_PRIVATE_H
#include "perigal/plan.h"

typedef struct {
    const pg_lattice *lattice;
    const pg_approx  *approx;
    int centred, nodal, order;  /* points at cell centres; Gauss points per direction */
    const pg_body *body;                               /* cells are cut by its surface; NULL: staircase */
    const pg_stencil *bonds;  /* without shape functions: the bonds of a point; else NULL */
} pg_counting;
typedef struct {                                       /* of the lattice given */
    double cells, points, open[6];                     /* open faces -x +x -y +y -z +z */
    double crossed;  /* open faces off the surface: about as many cells are cut */
    double node_bonds, evaluation, point_bonds;        /* evaluation: Gauss points, 0 if nodal */
    double pairs;                                      /* as in pg_forecast */
    double coupled;  /* most nodes that a node shares points with, itself included */
    int    sampled;                                    /* 1: bonds are extrapolated from a sample */
} pg_tally;
void forecast_factor (pg_forecast *f);                 /* unless it is analysed */
pg_status pg_tally_count (pg_tally *out, const pg_counting *how);
#endif
