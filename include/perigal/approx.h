/* SPDX-License-Identifier: GPL-3.0-or-later
 * approx.h: shape functions N and their derivatives at any position, from the points around it that are
 * joined to it by intact ("live") bonds. It is a catalogue: each approximation is
 * src/discretization/approx/<name>.c and one line in list.h.
 *
 *   z_j = (x_j - x) / a,   p (z) = (1, z_k [, z_k z_l]),   A = sum_j w_j p_j p_j'
 *   rkpm   N_j = p (0)' A^-1 p_j w_j,   dN_j its exact derivative
 *   pddo   N_j the same,                dN_j / dx_k = (1/a) e_k' A^-1 p_j w_j
 *   nosb   at a node: basis without the 1, N = 1 at the node itself, dN_j from the shape tensor
 *
 * Sources: Cui 2022, equations (4) to (19); doc/method.md D1, E1, E2, F3. nosb at a node expands about the
 * value of that node: the node itself is no neighbour (its alive bit does not matter and its w is 0) but must
 * be in its own family. At any other position nosb equals pddo. In the rows w is the influence times the
 * volume of the neighbour, w V, whatever weights the approximation uses. */
#ifndef PERIGAL_APPROX_H
#define PERIGAL_APPROX_H
#include "perigal/cloud.h"
#include "perigal/kernel.h"

PG_API_BEGIN

/* Quality of the shape functions at an evaluation point with the bonds that are intact there, from best to
 * worst.
 *
 *   FULL       the basis that was asked for
 *   LOWERED    quadratic was asked for, the linear basis is used
 *   PROJECTED  (degenerate: projected) the linear basis in the directions in which the neighbours spread:
 *              N is that of the point's projection onto their line or plane, gradients lie in it
 *   SHEPARD    fewer than dim + 1 neighbours, or the smallest eigenvalue of their centred second moment is
 *              below 1e-3 h^2: N = w / sum w and no gradient, so there is a displacement but no stress
 *   DEAD       no neighbour with an intact bond: N = 0
 *
 * A node of nosb that has lost all bonds keeps N = 1 at itself and counts as SHEPARD. */
enum { PG_GRADE_FULL, PG_GRADE_LOWERED, PG_GRADE_PROJECTED, PG_GRADE_SHEPARD, PG_GRADE_DEAD };

/* Evaluation points with their shape functions in compressed rows: entries family.start[i] to
 * family.start[i + 1] - 1 belong to point i; nnz is their total number. */
typedef struct {
    int     dim;
    size_t  n;
    /* Positions of the evaluation points, m (n x dim). */
    double *x;
    /* Integration weight of each point, m3; 0 where there is none (n). */
    double *weight;
    /* Index of the node that each point coincides with, or -1 (n). */
    int    *own;
    /* Background cell in which each point lies, or -1 (n). */
    int    *cell;
    /* Neighbours of each point: the nodes within its support, the node at the point itself included. */
    pg_family family;
    /* Shape functions, 0 on broken bonds (nnz). */
    double *N;
    /* Their derivatives, 1/m (nnz x dim). */
    double *dN;
    /* Influence times volume, m3, 0 on broken bonds (nnz). */
    double *w;
    /* Index in N, dN and w of the first bond of each point (n): points with congruent neighbourhoods share
     * values. NULL: family.start. See pg_rows_offset. Values of two points may not overlap while they are
     * evaluated. */
    size_t *at;
    /* Factor by which the support of each point is wider than usual (n); NULL: 1 everywhere
     * (pg_rows_widen). */
    double *wide;
    /* PG_GRADE_... (n). */
    unsigned char *grade;
    /* Number of points so far whose values were copied from points with congruent neighbourhoods; their
     * bonds. */
    size_t  copied, copied_bonds;
    /* eye: positions from which it is tested which nodes a point on the surface sees (nothing outside the
     * body lies between), m (n x dim); NULL: the points themselves. parted: number of nodes within supports
     * that are not seen (pg_between_sift), summed over all points. */
    double *eye;
    size_t  parted;
} pg_rows;

typedef struct pg_approx_type pg_approx_type;
/* An approximation with its choices. */
typedef struct {
    const pg_approx_type *type;
    const pg_kernel *kernel;
    /* Order of the basis: 1 linear, 2 quadratic. */
    int    order;
    /* PG_RADIAL: the influence is w (|z|); PG_TENSOR: the product of w (|z_k|). */
    int    shape;
    /* 1: the weights contain the volumes V_j (default of nosb and pddo); 0: V_j = 1 (rkpm). */
    int    use_volume;
    /* Radius of the support, m. */
    double horizon;
    /* 1: PG_GRADE_PROJECTED is allowed (linear basis only); 0: never. */
    int    projected;
    /* 1: an evaluation point that has lost no bond keeps the basis however little its neighbours spread, as
     * long as the moment matrix has a factor (used by consistent integration). */
    int    extrapolates;
    /* 1: evaluation points with all bonds intact and congruent neighbourhoods (to 2^-40 horizons) have the
     * same values to the last bit, and each kind is evaluated once: for points on a lattice, where there are
     * few kinds. */
    int    congruent;
    /* 1: N and dN are refined iteratively until they reproduce the basis to 1e-14, each point for itself with
     * bond vectors that are not rounded (consistent integration). Always done for points with wider supports,
     * and where the moment matrix is badly conditioned. */
    int    refined;
} pg_approx;

/* The descriptor of an approximation. */
struct pg_approx_type {
    const char *name, *summary;
    /* Default of pg_approx.use_volume. */
    int use_volume;
    /* 1: dN are the derivatives of the shape functions themselves (rkpm); 0: of a fit. */
    int exact;
    /* Error of the effective position of a crack's tip, in spacings: the worst of eight positions of the tip
     * among the points, for Gauss points with the linear and the quadratic basis, and for nodal integration
     * (src/mechanics/model/pre_crack_tips.c). */
    struct { double linear, quadratic, nodal; } tip;
    /* 1: N of a node is 1 at that node and 0 at the others, so that coefficients are
     * displacements. */
    int interpolates;
    /* Evaluates the rows list[0] to list[count - 1] (list NULL: the rows 0 to count - 1) again, with the
     * intact bonds marked in `alive` (nnz, 0 or 1; NULL: all), on `threads` threads. Arrays N, dN and w that
     * are NULL are left out; the others and the grades then have the same bits as if all were computed. A row
     * depends on its own bonds only, so order and threads do not matter. */
    pg_status (*evaluate) (const pg_approx *a, const pg_cloud *cloud, pg_rows *rows,
                           const unsigned char *alive, size_t count, const size_t *list, int threads);
};
/* The approximation of a name, NULL if there is none. */
const pg_approx_type *pg_approx_find (const char *name);
/* All names, separated by |. */
const char *pg_approx_names (void);
/* The first approximation of list.h: the default of a scene that names none. */
const pg_approx_type *pg_approx_first (void);
/* Reads the approximation of the section `method` of a scene for a force with shape functions; spacing in m.
 * A horizon below one spacing is reported as an error of the scene. */
pg_status pg_approx_read (pg_approx *out, const pg_scene *scene, double spacing);
/* Reads the approximation of a force without shape functions (unknowns: values at points). kernel and horizon
 * (spacings): defaults, which the scene may replace. PG_E_SCENE: a horizon below one spacing (m). */
pg_status pg_approx_read_points (pg_approx *out, const pg_scene *scene, double spacing, const char *kernel,
                                 double horizon);
/* Keys of forces with shape functions: approximation, basis, support, weights, degenerate. */
extern const pg_key_table pg_keys_shape_functions;

/* Makes rows at n positions x: copies x, searches their neighbours and allocates N, dN and w, which are zero
 * until they are evaluated. weight, own and cell may be NULL. */
pg_status pg_rows_create (pg_rows *out, const pg_approx *a, const pg_cloud *cloud, size_t n, const double *x,
                          const double *weight, const int *own, const int *cell);
void      pg_rows_clear  (pg_rows *rows);
/* pg_rows_create in steps, for large bodies and for several sets of evaluation points. pg_rows_search sorts
 * the cloud's points (and borrows it; pg_family_search_free); pg_rows_place finds the neighbours of n
 * positions x on any number of threads; pg_rows_values allocates shape functions and grades. Nodes that a
 * position does not see (pg_between_sift: cloud->between) are no neighbours. eye: where visibility of points
 * on the surface is tested from (n x dim, pg_rows_eyes); NULL: from x. */
pg_status pg_rows_search (pg_family_search **out, const pg_approx *a, const pg_cloud *cloud);
pg_status pg_rows_place  (pg_rows *out, const pg_family_search *search, const pg_cloud *cloud, size_t n,
                          const double *x, const double *weight, const int *own, const int *cell,
                          const double *eye, int threads);
pg_status pg_rows_values (pg_rows *rows);
/* What pg_rows_widen did: number of evaluation points whose support is wider now, and the widest support over
 * the usual one; points that still have too few neighbours, ascending (nblind; the caller frees them). */
typedef struct { size_t widened, nblind, *blind; double widest; } pg_widened;
/* Returns 1: the node is seen from evaluation point `place` (its number in the rows), 0: a crack lies
 * between. Called by several threads. */
typedef int (*pg_sight) (void *context, size_t place, int node);
/* Gives evaluation points with too few neighbours, such as those in the corner of a cut cell or beside a
 * crack, the smallest support, at most PG_WIDEST_SUPPORT times the usual one, that has enough: for the basis
 * that was asked for, without extrapolation (sum |N| at most 6, sum |dN| h at most 25, of a quadratic basis
 * 20 and 60). Other points keep neighbours and bits. The wider neighbourhoods, too, come from
 * pg_family_search, so that visibility is tested there. sees: NULL: all nodes of a family are seen. To be
 * called before pg_rows_values. */
#define PG_WIDEST_SUPPORT 2.5
pg_status pg_rows_widen (pg_rows *rows, const pg_approx *a, const pg_cloud *cloud, pg_sight sees,
                         void *context, int threads, pg_widened *out);
/* Computes positions slightly inside the body from positions x on the surface with outward normals (n x dim,
 * of any length; zero: x itself), so that each sees nodes of its own side only: *eye (n x dim, m; pg_free);
 * NULL where no gap or slot separates the points. */
pg_status pg_rows_eyes   (double **eye, const pg_cloud *cloud, size_t n, const double *x,
                          const double *normal);
/* Offset by which N, dN and w of bond e of evaluation point i stand at e + offset (unsigned, may wrap
 * around). */
static inline size_t pg_rows_offset (const pg_rows *rows, size_t i)
{
    return rows->at ? rows->at[i] - rows->family.start[i] : 0;
}
/* Number of evaluation points with that grade (PG_GRADE_...). */
size_t    pg_rows_count  (const pg_rows *rows, int grade);
PG_API_END
#endif
