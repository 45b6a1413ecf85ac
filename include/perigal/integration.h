/* SPDX-License-Identifier: GPL-3.0-or-later
 * integration.h: where the weak form is evaluated. Catalogue: src/integration/<name>.c + one line in list.h.
 * Cui 2022 section 2.5. (SCNI, NSNI and VC integration are entries to come.) */
#ifndef PERIGAL_INTEGRATION_H
#define PERIGAL_INTEGRATION_H
#include "perigal/approx.h"
#include "perigal/cells.h"

PG_API_BEGIN

typedef struct {
    size_t  n;
    double *x;                                         /* m (n x dim) */
    double *weight;                                    /* m^3, of facets m^2, thickness included (n) */
    double *normal;  /* outward unit normal of facets; NULL for cells (n x dim) */
    int    *cell;                                      /* cell or facet (n) */
} pg_quadrature;
void pg_quadrature_clear (pg_quadrature *q);

typedef struct {
    const char *name, *summary;
    int at_nodes;  /* 1: the evaluation points are the nodes, weight = volume */
    int consistent;                                    /* 1: derivatives are corrected by pg_consistency */
    /* unless at_nodes */
    pg_status (*points) (pg_quadrature *out, const pg_cells *cells, double thickness, int order);
} pg_integration_type;
const pg_integration_type *pg_integration_find (const char *name);
const char *pg_integration_names (void);

/* Points on each facet (order^(dim-1) on bars and quads); cell holds the facet's number; the weights of a
 * facet sum to its area. */
pg_status pg_facet_points (pg_quadrature *out, const pg_cells *cells, int order);

/* ---- faces --------------------------------------------------------------------------------------------- */
/* Faces of the cells, each once, with their points: those between two cells, and the facets of the
 * boundary. */
typedef struct {
    int     dim;
    size_t  n, npoint;
    double *x;                                         /* m (npoint x dim) */
    double *flux;  /* normal times weight, outward of cell[0], m^2 (npoint x dim) */
    size_t *start;                                     /* points of face f: start[f]..start[f + 1] (n + 1) */
    int    *cell;  /* the cells on both sides, second -1 on the boundary (n x 2) */
    size_t *of;  int *face;                            /* faces of cell c: face[of[c]..of[c + 1]) */
} pg_faces;
/* Gauss points of `order` on faces between cells (of cut cells: on what lies in the body), those of
 * pg_facet_points on the boundary. Two cells share a face when its corners are the same, bit by bit. */
pg_status pg_faces_build (pg_faces *out, const pg_cells *cells, int order);
void      pg_faces_clear (pg_faces *faces);

/* ---- consistent derivatives
 * ------------------------------------------------------------------------------------------------ In a whole
 * cell the derivatives of every shape function are so corrected that they obey the divergence identity for
 * polynomials p,
 *     sum_g w_g p (g) N_I,k (g) = oint p N_I n_k dS - sum_g w_g p,k (g) N_I (g), by the smallest change
 *       dN_I,k (g) += sum_m c_m p_m (g); with as many points as polynomials nothing of the direct derivatives
 *       is left. p = 1, x, y, z and their products (1, x, xy; fewer for fewer points). Then linear fields are
 *       solved exactly on any points and K stays symmetric. Duan, Li, Belytschko 2012 (quadratically
 *       consistent integration); Chen, Hillman, Rueter 2013. */
typedef struct {
    const pg_cells *cells;                             /* borrowed */
    pg_faces  faces;
    pg_rows   face;                                    /* N at the points of the faces, all bonds alive */
    pg_family cell_family;  /* nodes that the points of a cell, or of its faces, see */
    pg_family family;                                  /* of the evaluation points: that of their cell */
    size_t   *first;                                   /* points of cell c: first[c]..first[c + 1] */
} pg_consistency;
pg_status pg_consistency_create (pg_consistency **out, const pg_cells *cells, const pg_approx *approx,
                                 const pg_cloud *cloud, const pg_rows *points, int face_order, int threads);
void      pg_consistency_free   (pg_consistency **c);
/* wide->N, wide->dN (family of c) of cells list[0..count) (NULL: all) from the direct values of `points`:
 * corrected where whole[cell], copied elsewhere. */
pg_status pg_consistency_apply (const pg_consistency *c, const pg_rows *points, pg_rows *wide,
                                const unsigned char *whole, size_t count, const size_t *list, int threads);

/* ---- patches of the dilatation
 * -------------------------------------------------------------------------------------------- Near Poisson's
 * ratio 1/2 a condition on the dilatation at every evaluation point leaves the displacement too little
 * freedom (locking). The dilatation that carries the pressure is then that of patches of about 2 cells, or 3
 * points of nodal integration, per axis: of one material, disjoint, none of less than 0.4 of that volume
 * where there is a neighbour to join. */
typedef struct {
    size_t  n;                                         /* patches */
    size_t *first, *point;  /* points of patch c, ascending: point[first[c]..first[c + 1]) */
    long   *of;  /* patch of an evaluation point; -1: none (its material has no lambda) */
    pg_family family;                                  /* nodes that the points of a patch see */
    double *full;  /* volume of so many cells at the patch, m^3 (fewer where the body is thinner) (n) */
    double *lambda;  /* of every material, Pa; 0: dilatation at the points */
} pg_patches;
typedef struct {                                       /* all borrowed */
    const pg_rows    *points;                          /* of evaluation: places, weights, cells */
    const pg_family  *family;                          /* nodes that they see */
    const pg_cloud   *cloud;
    const pg_cells   *cells;                           /* NULL: the points are the nodes */
    const pg_lattice *lattice;                         /* NULL: none */
    int               centred;  /* the nodes lie in the middle of the cells of the lattice */
    const int        *block;                           /* material of every point */
    const double     *spacing;                         /* local, of every point, m; NULL: the cloud's */
    int               across;                          /* cells or points of a patch per axis */
    size_t            materials;
    const double     *lambda;                          /* of every material, Pa; 0: not projected */
} pg_patch_source;
pg_status pg_patches_create (pg_patches **out, const pg_patch_source *source);
void      pg_patches_free   (pg_patches **patches);

/* Silling 2017 stabilisation of nodally integrated NOSB (theory D3a): adds S_ab I to the blocks (dim x dim
 * each) of local nodes b = 0..m-1 against a, the energy of point p being (1/2) sum_ab S_ab d_a.d_b; modulus =
 * Gs mu (Pa), volume of the point (m^3). */
void pg_silling_add (const pg_rows *rows, const pg_cloud *cloud, size_t p, size_t a, size_t m, double modulus,
                     double volume, double *blocks);
PG_API_END
#endif
