/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: the projected dilatation of the Galerkin force. Files: galerkin_dilatation.c (patches, their rows,
 * stresses), galerkin_dilatation_facet.c (what it adds to Nitsche's terms). */
#ifndef PG_GALERKIN_DILATATION_H
#define PG_GALERKIN_DILATATION_H
#include "galerkin.h"

typedef struct {                                       /* points of a patch that intact bonds still join */
    int     terms;                                     /* number of polynomials psi: 1, or dim + 1 */
    double  centre[3], size, L[16];                    /* psi = L^-1 (1, (x - centre) / size), m */
    double *g;  /* sum_p w_p psi_m (p) grad N (p) at the patch's nodes (terms x nodes x dim) */
    /* sum_f w_f psi_m (f) n_k N (f) over its supported facet points f (layout of g); NULL: none */
    double *s;
    double  amount[4];                                 /* g_m . d of the last measure */
    double  flux[4];                                   /* s_m . x of the last apply */
    double  gap[4];                                    /* c_m, galerkin_dilatation_facet.c */
} galerkin_part;

typedef struct { size_t n, workspace, room_g; galerkin_part *part; double *g; } galerkin_patch;

struct galerkin_dilatation {
    pg_material    *plain;                             /* materials with D less lambda */
    galerkin_patch *patch;
    /* number of the part of each entry of the patches; -1: its point carries no stress */
    int            *part_of;
    int            *stamp;                             /* scratch: a mark for each node (n) */
    unsigned char  *mark;                              /* patches that changed */
    double         *amount, *share;                   /* scratch: a pressure and a weight for each node (n) */
    /* Of every facet point: the evaluation point whose patch is continued to it; -1: none. */
    long           *home;
    size_t         *facet_start, *facet;               /* supported facet points of every patch */
    size_t         *facet_entry;                       /* the patch entry of each of them */
    pg_family       family;                            /* nodes of every patch and of its facet points */
};

/* psi (terms): polynomials of a part at position x, m. */
void galerkin_dilatation_polynomials (const galerkin *g, const galerkin_part *a, const double *x,
                                      double *psi);
pg_status galerkin_dilatation_facets_create (galerkin *g);
void galerkin_dilatation_facets_free (galerkin *g);
/* Computes a->s of a part. */
void galerkin_dilatation_facet_rows (const galerkin *g, size_t patch, int part, galerkin_part *a);
#endif
