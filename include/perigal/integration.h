/* SPDX-License-Identifier: GPL-3.0-or-later
 * integration.h: where the weak form is evaluated. Catalogue: src/integration/<name>.c + one line in list.h.
 * Cui 2022 section 2.5. (Consistent, SCNI, NSNI and VC integration are entries to come.) */
#ifndef PERIGAL_INTEGRATION_H
#define PERIGAL_INTEGRATION_H
#include "perigal/approx.h"
#include "perigal/cells.h"

typedef struct {
    size_t  n;
    double *x;                                         /* m                                  (n x dim)                   */
    double *weight;                                    /* m^3, of facets m^2, thickness included     (n)                 */
    double *normal;                                    /* outward unit normal of facets; NULL for cells  (n x dim)       */
    int    *cell;                                      /* cell or facet                      (n)                         */
} pg_quadrature;
void pg_quadrature_clear (pg_quadrature *q);

typedef struct {
    const char *name, *summary;
    int at_nodes;                                      /* 1: the evaluation points are the nodes, weight = volume        */
    pg_status (*points) (pg_quadrature *out, const pg_cells *cells, double thickness, int order);   /* unless at_nodes   */
} pg_integration_type;
const pg_integration_type *pg_integration_find (const char *name);
const char *pg_integration_names (void);

/* Gauss-Legendre nodes and weights on [-1, 1], order 1..5. */
void pg_gauss_rule (int order, double *x, double *w);
/* Points on each facet (order^(dim-1) on bars and quads); cell holds the facet's number; the weights of a facet sum to its area. */
pg_status pg_facet_points (pg_quadrature *out, const pg_cells *cells, int order);

/* Silling 2017 stabilisation of nodally integrated NOSB (theory D3a): adds S_ab I to the blocks (dim x dim each) of local nodes
 * b = 0..m-1 against a, the energy of point p being (1/2) sum_ab S_ab d_a.d_b; modulus = Gs mu (Pa), volume of the point (m^3). */
void pg_silling_add (const pg_rows *rows, const pg_cloud *cloud, size_t p, size_t a, size_t m, double modulus, double volume, double *blocks);
#endif
