/* SPDX-License-Identifier: GPL-3.0-or-later
 * approx.h: N and its derivatives at any point over live bonds. Catalogue: src/approx/<name>.c + one line in
 * list.h. nosb at a node expands about the node: N is 1 there, the own node is no neighbour (its alive bit
 * does not matter, its w is 0) and must be in the family; at any other point nosb equals pddo. On a point
 * without live bonds a node of nosb keeps N = 1 (PG_GRADE_SHEPARD). w in the rows is w V for every
 * approximation. Sources: Cui 2022 eqs (4)-(19); theory sections D1, E1, E2, F3; degenerate rule: F3. */
#ifndef PERIGAL_APPROX_H
#define PERIGAL_APPROX_H
#include "perigal/cloud.h"
#include "perigal/kernel.h"

PG_API_BEGIN

/* What a point could still do with its live bonds. */
enum { PG_GRADE_FULL,      /* the basis asked for */
       PG_GRADE_LOWERED,   /* quadratic asked, linear used */
       /* `projected`, and of the linear basis only the directions in which the neighbours still spread: N is
        * that of the foot of the point on their line or plane, gradients are along it */
       PG_GRADE_PROJECTED,
       /* fewer than dim + 1 live neighbours, or smallest eigenvalue of the centred second moment below 1e-3
        * h^2: N = w / sum w, gradients 0: carries no stress, keeps a displacement */
       PG_GRADE_SHEPARD,
       PG_GRADE_DEAD };    /* no live neighbour: N = 0 */

typedef struct {                                       /* evaluation points and their shape functions */
    int     dim;
    size_t  n;
    double *x;                                         /* m (n x dim) */
    double *weight;                                    /* integration weight, m^3; 0 where none (n) */
    int    *own;                                       /* the node that this point is, or -1 (n) */
    int    *cell;                                      /* background cell or -1 (n) */
    pg_family family;                                  /* nodes seen from each point (own node included) */
    double *N;                                         /* shape functions, 0 on dead bonds (nnz) */
    double *dN;                                        /* derivatives, 1/m (nnz x dim) */
    double *w;                                         /* influence w V (m^3), 0 on dead bonds (nnz) */
    unsigned char *grade;                              /* PG_GRADE_... (n) */
} pg_rows;

typedef struct pg_approx_type pg_approx_type;
typedef struct {
    const pg_approx_type *type;
    const pg_kernel *kernel;
    int    order;                                      /* basis: 1 linear, 2 quadratic */
    int    shape;                                      /* PG_RADIAL: w(|z|); PG_TENSOR: prod_k w(|z_k|) */
    int    use_volume;  /* V_j in the weights (default: nosb, pddo yes; rkpm no: V_j = 1) */
    double horizon;                                    /* support radius a, m */
    int    projected;  /* 1: PG_GRADE_PROJECTED is allowed (linear basis); 0: never */
    /* 1: a point that lost no bond keeps the basis however little its neighbours spread, as long as the
     * moment matrix has a factor (consistent integration) */
    int    extrapolates;
} pg_approx;

struct pg_approx_type {
    const char *name, *summary;
    int use_volume;                                    /* the default */
    int exact;                                         /* 1: derivatives are those of the shape functions */
    /* How far the tip of a crack may lie from where it is drawn, in spacings: the worst of eight places
     * among the points, with evaluation at Gauss points by the basis, and at the points alone
     * (src/model/tips.c). */
    struct { double linear, quadratic, nodal; } tip;
    /* 1: N of a node is 1 at that node and 0 at the others, so that values are coefficients */
    int interpolates;
    /* Re-evaluates rows list[0..count) (list NULL: rows 0..count) from `alive` (nnz, 0/1; NULL: all alive),
     * on `threads`. Of N, dN and w, those that are NULL are left out, the others and the grades are the same
     * bits. */
    pg_status (*evaluate) (const pg_approx *a, const pg_cloud *cloud, pg_rows *rows,
                           const unsigned char *alive, size_t count, const size_t *list, int threads);
};
const pg_approx_type *pg_approx_find (const char *name);
const char *pg_approx_names (void);
/* The approximation of `method` in the scene; spacing in m. */
pg_status pg_approx_read (pg_approx *out, const pg_scene *scene, double spacing);
/* The same for a force without shape functions, whose unknowns are displacements of points: kernel and
 * horizon of the scene, else those given (horizon: spacings); the expansion about a point serves to sample.
 */
pg_status pg_approx_read_points (pg_approx *out, const pg_scene *scene, double spacing, const char *kernel,
                                 double horizon);
/* Keys of forces with shape functions: approximation, basis, support, weights, degenerate. */
extern const pg_key_table pg_keys_shape_functions;

/* Rows at n points: copies x, searches families, allocates N, dN, w (zero until evaluated). own, cell, weight
 * may be NULL. */
pg_status pg_rows_create (pg_rows *out, const pg_approx *a, const pg_cloud *cloud, size_t n, const double *x,
                          const double *weight, const int *own, const int *cell);
void      pg_rows_clear  (pg_rows *rows);
size_t    pg_rows_count  (const pg_rows *rows, int grade);
PG_API_END
#endif
