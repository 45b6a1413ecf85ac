/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: the projected dilatation of the Galerkin force. Files: galerkin_dilatation.c (patches, their rows, stresses), galerkin_dilatation_facet.c
 * (what it adds to Nitsche's terms). */
#ifndef PG_GALERKIN_DILATATION_H
#define PG_GALERKIN_DILATATION_H
#include "galerkin.h"

typedef struct {                                       /* points of a patch that live bonds still join                   */
    int     terms;                                     /* polynomials: 1, or dim + 1                                     */
    double  centre[3], size, L[16];                    /* psi = L^-1 (1, (x - centre) / size); m                         */
    double *g;                                         /* sum_p w_p psi_m (p) grad N (p), of the patch's nodes (terms x nodes x dim) */
    double  amount[4];                                 /* g_m . d of the last measure                                    */
} galerkin_part;

typedef struct { size_t n, room, room_g; galerkin_part *part; double *g; } galerkin_patch;

struct galerkin_dilatation {
    pg_material    *plain;                             /* of every material: D without lambda                            */
    galerkin_patch *patch;
    int            *part_of;                           /* part of every evaluation point in its patch; -1: carries no stress */
    int            *stamp;                             /* scratch: per node                                              */
    unsigned char  *mark;                              /* patches that changed                                           */
    double         *amount, *share;                    /* scratch: per node                                              */
    long           *home;                              /* of every facet point: the evaluation point whose patch goes on there; -1: none */
    pg_family       facet_family;                      /* nodes of a facet point with pins and of its patch              */
    double         *facet_N, *facet_g;                 /* N and sum_m psi_m (x) g_m on these     (nnz, nnz x dim)        */
};

/* Polynomials at x of the part that evaluation point q belongs to (*a NULL: none). */
void galerkin_dilatation_polynomials (const galerkin *g, size_t q, const double *x, const galerkin_part **a, double *psi);
pg_status galerkin_dilatation_facets_create (galerkin *g);
void galerkin_dilatation_facets_free (galerkin *g);
void galerkin_dilatation_facets_update (galerkin *g, int all);      /* after the patches; marks rows of K                */
#endif
