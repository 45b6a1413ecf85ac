/* SPDX-License-Identifier: GPL-3.0-or-later
 * approx.h: shape functions N and their derivatives at any place, from the points around it
 * that are joined to it by live bonds. It is a catalogue: each approximation is
 * src/discretization/approx/<name>.c and one line in list.h.
 *
 *   z_j = (x_j - x) / a,   p (z) = (1, z_k [, z_k z_l]),   A = sum_j w_j p_j p_j'
 *   rkpm   N_j = p (0)' A^-1 p_j w_j,   dN_j its exact derivative
 *   pddo   N_j the same,                dN_j / dx_k = (1/a) e_k' A^-1 p_j w_j
 *   nosb   at a node: basis without the 1, N = 1 at the node itself, dN_j from the shape tensor
 *
 * Sources: Cui 2022, equations (4) to (19); doc/method.md D1, E1, E2, F3. nosb at a node
 * expands about the value of that node: the node itself is no neighbour (its alive bit does
 * not matter and its w is 0) but must be in its own family. At any other place nosb equals
 * pddo. In the rows w is the influence times the volume of the neighbour, w V, whatever
 * weights the approximation uses. */
#ifndef PERIGAL_APPROX_H
#define PERIGAL_APPROX_H
#include "perigal/cloud.h"
#include "perigal/kernel.h"

PG_API_BEGIN

/* What a place can still do with its live bonds, from best to worst.
 *
 *   FULL       the basis that was asked for
 *   LOWERED    quadratic was asked for, the linear basis is used
 *   PROJECTED  (degenerate: projected) the linear basis in the directions in which the neighbours spread:
 *              N belongs to the foot of the place on their line or plane, gradients lie in it
 *   SHEPARD    fewer than dim + 1 neighbours, or the smallest eigenvalue of their centred second moment is
 *              below 1e-3 h^2: N = w / sum w and no gradient, so there is a displacement but no stress
 *   DEAD       no live neighbour: N = 0
 *
 * A node of nosb that has lost all bonds keeps N = 1 at itself and counts as SHEPARD. */
enum { PG_GRADE_FULL, PG_GRADE_LOWERED, PG_GRADE_PROJECTED, PG_GRADE_SHEPARD, PG_GRADE_DEAD };

/* Evaluation points with their shape functions in compressed rows: entries family.start[i] to
 * family.start[i + 1] - 1 belong to point i; nnz is their total number. */
typedef struct {
    int     dim;
    size_t  n;
    /* Places, m (n x dim). */
    double *x;
    /* Integration weight, m3; 0 where there is none (n). */
    double *weight;
    /* The node that this place is, or -1 (n). */
    int    *own;
    /* The background cell that it lies in, or -1 (n). */
    int    *cell;
    /* Nodes seen from each place, the own node included. */
    pg_family family;
    /* Shape functions, 0 on dead bonds (nnz). */
    double *N;
    /* Their derivatives, 1/m (nnz x dim). */
    double *dN;
    /* Influence times volume, m3, 0 on dead bonds (nnz). */
    double *w;
    /* Where N, dN and w of each place begin, counted in bonds (n): places that see their nodes alike share
     * them. NULL: at the first bond of the place (by pg_rows_offset). Those of two places may not overlap
     * while they are evaluated. */
    size_t *at;
    /* How much wider than that of other places the support of each place is (n); NULL: none is wider
     * (pg_rows_widen). */
    double *wide;
    /* PG_GRADE_... (n). */
    unsigned char *grade;
    /* Places so far whose values were copied from others that see their nodes alike, and their bonds. */
    size_t  copied, copied_bonds;
    /* Where places on the surface look from, m (n x dim); NULL: from where they are. Nodes within the support
     * of a place that it does not see (pg_between_sift), over all places. */
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
    /* 1: a place that has lost no bond keeps the basis however little its neighbours spread,
     * as long as the moment matrix has a factor (used by consistent integration). */
    int    extrapolates;
    /* 1: places with all their bonds that see their nodes alike, to 2^-40 horizons, have the same values to
     * the last bit, and each kind is evaluated once: for points on a lattice, where there are few kinds. */
    int    congruent;
    /* 1: N and dN are improved by residuals of what they reproduce, to 1e-14, and belong to bonds that are
     * not rounded, each place for itself (consistent integration). Places with wider supports always are, and
     * those whose neighbours carry the basis by few digits. */
    int    refined;
} pg_approx;

/* The descriptor of an approximation. */
struct pg_approx_type {
    const char *name, *summary;
    /* Default of pg_approx.use_volume. */
    int use_volume;
    /* 1: dN are the derivatives of the shape functions themselves (rkpm); 0: of a fit. */
    int exact;
    /* How far from where it is drawn the tip of a crack may lie, in spacings: the worst of
     * eight places among the points, for Gauss points with the linear and the quadratic basis,
     * and for nodal integration (src/mechanics/model/pre_crack_tips.c). */
    struct { double linear, quadratic, nodal; } tip;
    /* 1: N of a node is 1 at that node and 0 at the others, so that coefficients are
     * displacements. */
    int interpolates;
    /* Evaluates the rows list[0] to list[count - 1] (list NULL: the rows 0 to count - 1)
     * again, with the live bonds of `alive` (nnz, 0 or 1; NULL: all), on `threads` threads. Of
     * N, dN and w those that are NULL are left out; the others and the grades then have the
     * same bits as if all were computed. A row depends on its own bonds only, so order and
     * threads do not matter. */
    pg_status (*evaluate) (const pg_approx *a, const pg_cloud *cloud, pg_rows *rows,
                           const unsigned char *alive, size_t count, const size_t *list, int threads);
};
/* The approximation of a name, NULL if there is none. */
const pg_approx_type *pg_approx_find (const char *name);
/* All names, separated by |. */
const char *pg_approx_names (void);
/* The first line of list.h: what a scene gets that names none. */
const pg_approx_type *pg_approx_first (void);
/* Reads the approximation of the section `method` of a scene for a force with shape functions;
 * spacing in m. A horizon below one spacing is a fault of the scene. */
pg_status pg_approx_read (pg_approx *out, const pg_scene *scene, double spacing);
/* Reads the approximation of a force without shape functions (unknowns: values at points). kernel and horizon
 * (spacings): defaults, which the scene may replace. PG_E_SCENE: a horizon below one spacing (m). */
pg_status pg_approx_read_points (pg_approx *out, const pg_scene *scene, double spacing, const char *kernel,
                                 double horizon);
/* Keys of forces with shape functions: approximation, basis, support, weights, degenerate. */
extern const pg_key_table pg_keys_shape_functions;

/* Makes rows at n places: copies x, searches the families and allocates N, dN and w, which are
 * zero until they are evaluated. weight, own and cell may be NULL. */
pg_status pg_rows_create (pg_rows *out, const pg_approx *a, const pg_cloud *cloud, size_t n, const double *x,
                          const double *weight, const int *own, const int *cell);
void      pg_rows_clear  (pg_rows *rows);
/* pg_rows_create in steps, for large bodies and for several lots of places. pg_rows_search sorts the cloud's
 * points (and borrows it; pg_family_search_free); pg_rows_place finds the families of places on any number
 * of threads; pg_rows_values adds the memory for shape functions and grades. Nodes that a place does not see
 * (pg_between_sift: cloud->between) are not in its family. eye: where places on the surface look from
 * (n x dim, pg_rows_eyes); NULL: from where they are. */
pg_status pg_rows_search (pg_family_search **out, const pg_approx *a, const pg_cloud *cloud);
pg_status pg_rows_place  (pg_rows *out, const pg_family_search *search, const pg_cloud *cloud, size_t n,
                          const double *x, const double *weight, const int *own, const int *cell,
                          const double *eye, int threads);
pg_status pg_rows_values (pg_rows *rows);
/* What pg_rows_widen did: number of places whose support is wider now, and the widest, over the usual one;
 * places that still see too little, ascending (nblind; whoever asked frees them). */
typedef struct { size_t widened, nblind, *blind; double widest; } pg_widened;
/* Says whether a node is seen from a place (its number in the rows): 0: a crack lies between. Called by
 * several threads. */
typedef int (*pg_sight) (void *context, size_t place, int node);
/* Gives places that see too little, such as those in the corner of a cut cell or beside a crack, the first
 * support of PG_WIDEST_SUPPORT at most that shows them enough: for the basis that was asked for, without
 * extrapolation (sum |N| at most 6, sum |dN| h at most 25, of a quadratic basis 20 and 60). Other places keep
 * families and bits. Pairs of places and wider families come from pg_family_search, as all others, so that
 * what lies between two points is asked there. sees: NULL: all nodes of a family are seen. Before values. */
#define PG_WIDEST_SUPPORT 2.5
pg_status pg_rows_widen (pg_rows *rows, const pg_approx *a, const pg_cloud *cloud, pg_sight sees,
                         void *context, int threads, pg_widened *out);
/* Places a little way inside of places x on the surface with outward normals (n x dim, of any length;
 * zero: the place itself), so that each sees its own side only: *eye (pg_free); NULL where nothing parts
 * the points. */
pg_status pg_rows_eyes   (double **eye, const pg_cloud *cloud, size_t n, const double *x,
                          const double *normal);
/* Values of entry e of place i are entries e + offset of N, dN and w (unsigned numbers, which may wrap
 * around). */
static inline size_t pg_rows_offset (const pg_rows *rows, size_t i)
{
    return rows->at ? rows->at[i] - rows->family.start[i] : 0;
}
/* Number of places with that grade. */
size_t    pg_rows_count  (const pg_rows *rows, int grade);
PG_API_END
#endif
