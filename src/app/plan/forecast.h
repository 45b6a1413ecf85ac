/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private to the forecast: counting on a lattice (tally.c), the factor by nested dissection (forecast.c). */
#ifndef PG_FORECAST_PRIVATE_H
#define PG_FORECAST_PRIVATE_H
#include "perigal/plan.h"

typedef struct {
    const pg_lattice *lattice;
    const pg_approx  *approx;
    /* 1: points at cell centres; 1: nodal integration; Gauss points per direction */
    int centred, nodal, order;
    /* its surface cuts cells; NULL: cells stay whole (staircase) */
    const pg_body *body;
    const pg_stencil *bonds;  /* without shape functions: the bonds of a point; else NULL */
} pg_counting;
typedef struct {                                       /* counts on the lattice of pg_counting */
    double cells, points, open[6];                     /* open faces -x +x -y +y -z +z */
    double crossed;  /* open faces whose centre is off the body's surface: about the number of cut cells */
    /* bonds of nodes; Gauss points, 0 if nodal; bonds of Gauss points */
    double node_bonds, evaluation, point_bonds;
    /* pairs of nodes that share an evaluation point, (i, i) included */
    double pairs;
    double coupled;  /* largest number of nodes coupled to one node, itself included */
    int    sampled;                                    /* 1: bonds are extrapolated from a sample */
} pg_tally;
void forecast_factor (pg_forecast *f);                 /* estimate, unless an analysis has counted */
pg_status pg_tally_count (pg_tally *out, const pg_counting *how);
#endif
