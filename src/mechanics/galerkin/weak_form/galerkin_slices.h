/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: slices of the evaluation points, shared by the loops over all of them (galerkin_sum.c: forces;
 * galerkin_measure.c: strains and stresses), and the strain of one point. */
#ifndef PG_GALERKIN_SLICES_H
#define PG_GALERKIN_SLICES_H
#include "galerkin.h"

enum { SLICES = 16 };

#define INLINE static inline __attribute__ ((always_inline))

/* Nodes from .. to - 1. */
typedef struct { size_t from, to; } interval;

struct galerkin_slices {
    size_t  first[SLICES + 1];                         /* slice k: points first[k] .. first[k + 1] - 1 */
    size_t  low[SLICES], high[SLICES];                 /* range of the nodes in their families */
    /* intervals of the nodes in their families, without wide gaps */
    interval *seen[SLICES]; size_t nseen[SLICES];
    double *sum[SLICES];                         /* sums of forces: per node of the range, 4 numbers or dim */
    double *x;                                         /* nodal values, 4 numbers a node or dim */
    /* Runs of points with the same shape functions in each slice; sums of their forces, and nodal values, an
     * array for each component. has_runs: 0 in 1D and in runs without shortcuts. */
    int     has_runs;
    galerkin_run_list runs[SLICES];
    double *part[SLICES][3], *component[3];
    int     quiet[SLICES];                             /* 1: no block of the slice is active in this sum */
    /* Number of bonds of points summed in runs, over the products so far. */
    double  alike;
};

/* Nodal values in the layout that loops over points use: four numbers a node in 3D, in `x` of the slices,
 * else dim. */
const double *galerkin_widened (galerkin *g, const double *d);
/* Copies nodal values into `component`, an array for each component, where there are runs. */
void galerkin_split (galerkin *g, const double *x);

/* u (m; NULL: not wanted) and strain e of point p in 3D; x: displacements, 4 numbers a node. */
INLINE void strain_solid (const pg_rows *r, size_t p, const double *x, double *u, double *e)
{
    four h0 = { 0 }, h1 = { 0 }, h2 = { 0 }, s = { 0 };
    const int *node = r->family.node;
    size_t offset = pg_rows_offset (r, p);
    for (size_t k = r->family.start[p]; k < r->family.start[p + 1]; k++) {
        four d = *(const four *) (x + 4 * (size_t) node[k]);
        const double *q = r->dN + 3 * (k + offset);
        h0 += q[0] * d, h1 += q[1] * d, h2 += q[2] * d;
        if (u) s += r->N[k + offset] * d;
    }
    e[0] = h0[0], e[1] = h1[1], e[2] = h2[2], e[3] = h1[0] + h0[1], e[4] = h2[1] + h1[2],
    e[5] = h2[0] + h0[2];
    for (int c = 0; u && c < 3; c++) u[c] = s[c];
}

/* u (m; NULL: not wanted) and strain e of point p in 1D or 2D, (xx) or (xx, yy, 2 xy); x: dim numbers a
 * node. */
INLINE void strain_flat (int dim, const pg_rows *r, size_t p, const double *x, double *u, double *e)
{
    size_t offset = pg_rows_offset (r, p);
    double u0 = 0, u1 = 0, e0 = 0, e1 = 0, e2 = 0;
    for (size_t k = r->family.start[p]; k < r->family.start[p + 1]; k++) {
        if (dim == 1) {
            double d = x[r->family.node[k]];
            u0 += r->N[k + offset] * d, e0 += r->dN[k + offset] * d;
        } else {
            const double *d = x + 2 * (size_t) r->family.node[k], *q = r->dN + 2 * (k + offset);
            u0 += r->N[k + offset] * d[0], u1 += r->N[k + offset] * d[1];
            e0 += q[0] * d[0], e1 += q[1] * d[1], e2 += q[1] * d[0] + q[0] * d[1];
        }
    }
    e[0] = e0;
    if (dim == 2) e[1] = e1, e[2] = e2;
    if (u) u[0] = u0;
    if (u && dim == 2) u[1] = u1;
}

#endif
