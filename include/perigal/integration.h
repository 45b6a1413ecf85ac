/* SPDX-License-Identifier: GPL-3.0-or-later
 * integration.h: where the weak form is evaluated: quadrature points in cells and on facets, faces between
 * cells, corrected (consistent) derivatives, patches of the dilatation, and the stabilisation of nodal
 * integration. Cui 2022, section 2.5. A method of integration is an entry of the catalogue:
 * src/discretization/integration/NAME.c and one line in list.h. */
#ifndef PERIGAL_INTEGRATION_H
#define PERIGAL_INTEGRATION_H
#include "perigal/approx.h"
#include "perigal/cells.h"

PG_API_BEGIN

/* Quadrature points in cells or on facets. */
typedef struct {
    /* Number of points. */
    size_t  n;
    /* Positions, m (n x dim). */
    double *x;
    /* Weights, thickness included: m^3 in cells, m^2 on facets (n). */
    double *weight;
    /* Outward unit normals on facets; NULL for cells (n x dim). */
    double *normal;
    /* The cell, or the facet, that each point lies in; ascending (n). */
    int    *cell;
} pg_quadrature;
/* Frees the arrays and zeroes the structure. */
void pg_quadrature_clear (pg_quadrature *q);

/* A method of integration over the body: an entry of the catalogue for method.integration. */
typedef struct {
    /* The value of `method.integration` in a scene, and one line of description. */
    const char *name, *summary;
    /* 1: the evaluation points are the nodes themselves, and their weights the volumes of the nodes. */
    int at_nodes;
    /* 1: derivatives are corrected by pg_consistency. */
    int consistent;
    /* Makes the points in all cells with `order` Gauss points per direction; thickness (2D, m; 1D: cross
     * section, m^2). NULL where at_nodes is set. */
    pg_status (*points) (pg_quadrature *out, const pg_cells *cells, double thickness, int order);
} pg_integration_type;
/* The entry of that name, NULL: there is none; all names, separated by |. */
const pg_integration_type *pg_integration_find (const char *name);
const pg_integration_type *pg_integration_at_nodes (void);     /* the entry whose points are the nodes */
const char *pg_integration_names (void);
/* Chooses the integration for shape functions: that of the scene; else nodal integration for points without
 * cells, and, if `needed` (cells are cut, or cracks grow by facets), the consistent one, which is exact
 * there. Not for the quadratic basis, where it costs several times as much, nor for approximations that
 * interpolate: there, and where it is not needed, the first of the list. */
const pg_integration_type *pg_integration_of (const pg_scene *scene, int needed);

/* Gauss-Legendre points in every cell (order^dim in bars, quadrilaterals and hexahedra; in cut cells
 * within the body); cell holds the number of the cell, and the weights of each cell sum to its volume.
 * PG_E_MEMORY. */
pg_status pg_cell_points (pg_quadrature *out, const pg_cells *cells, double thickness, int order);
/* Gauss-Legendre points in the cells first .. last - 1, so that large bodies can be integrated in parts. */
pg_status pg_cell_points_of (pg_quadrature *out, const pg_cells *cells, double thickness, int order,
                             size_t first, size_t last);
/* Gauss points on every facet (order^(dim - 1) on bars and quadrilaterals), with normals; cell holds the
 * number of the facet, and the weights of each facet sum to its area. PG_E_MEMORY. */
pg_status pg_facet_points (pg_quadrature *out, const pg_cells *cells, int order);

/* ---- faces --------------------------------------------------------------------------------------------- */
/* The faces of cells, each once, with quadrature points: those between two cells first, then the facets
 * of the boundary. The divergence identity of consistent integration needs integrals over all faces of
 * a cell. */
typedef struct {
    /* Dimension of space. */
    int     dim;
    /* Number of faces, and of points on all of them. */
    size_t  n, npoint;
    /* Positions of the points, m (npoint x dim). */
    double *x;
    /* Unit normal, outward of the first cell of the face, times the weight of the point, m^2 (npoint x
     * dim). */
    double *flux;
    /* Points of face f: start[f] .. start[f + 1] - 1 (n + 1). */
    size_t *start;
    /* The cells on the two sides of each face; the second is -1 on the boundary (n x 2). */
    int    *cell;
    /* Faces of cell c, ascending: face[of[c]] .. face[of[c + 1] - 1] (of: cells + 1). */
    size_t *of;  int *face;
} pg_faces;
/* Gauss points of that order on faces between cells (of cut cells on the part in the body), and the points
 * of pg_facet_points on the boundary. Two cells share a face where its corners are equal bit by bit.
 * PG_E_MEMORY. */
pg_status pg_faces_build (pg_faces *out, const pg_cells *cells, int order);
void      pg_faces_clear (pg_faces *faces);

/* ---- consistent derivatives --------------------------------------------------------------------------- */
/* Gauss points integrate the rational shape functions of irregular points badly: the weak form misses the
 * integration constraint int N_I,k dV = oint N_I n_k dS (Krongauz and Belytschko 1997), and a linear field
 * is no longer a solution. Here, in every whole cell, the derivatives of every shape function N_I at the
 * points g are corrected so that they obey the divergence identity for polynomials p,
 *
 *     sum_g w_g p (g) N_I,k (g) = oint p N_I n_k dS - sum_g w_g p,k (g) N_I (g),
 *
 * by the smallest change dN_I,k (g) += sum_m c_m p_m (g). p = 1, x, y, z and their products (2D: 1, x, y,
 * xy; fewer where a cell has fewer points). With as many points as polynomials nothing of the direct
 * derivatives remains. Linear fields are then solved exactly on any points, and K stays symmetric. Duan,
 * Li, Belytschko 2012 (quadratically consistent integration); Chen, Hillman, Rueter 2013 (variational
 * consistency). Tables that do not change while bonds break: */
typedef struct {
    /* The cells; borrowed. */
    const pg_cells *cells;
    /* All faces of the cells. */
    pg_faces  faces;
    /* Shape functions at the points of the faces, all bonds alive; values only, no derivatives. */
    pg_rows   face;
    /* The nodes that the points of each cell, or the points of its faces, see. */
    pg_family cell_family;
    /* Nodes of every evaluation point: the list of its cell in cell_family. */
    pg_family family;
    /* Evaluation points of cell c: first[c] .. first[c + 1] - 1 (cells + 1). */
    size_t   *first;
    /* The points of the cloud, borrowed; order of the basis. */
    const pg_cloud *cloud;
    int       order;
    /* amended: faces whose fluxes were changed so that the divergence theorem holds in their cells (faces);
     * uneven: cells whose quadrature would violate it otherwise, or may for products (cells). */
    unsigned char *amended, *uneven;
    /* A small cell keeps its direct derivatives, and its host obeys the identity of both: the hosts of each
     * cell, several where its neighbours have equal claims, the small cells of each host, and the share of
     * the identity of each of these that the host takes (in the layout of guests.node). */
    pg_family hosts, guests;
    double   *guest_share;
    /* The cells that must have all their bonds for the derivatives of a cell to be corrected: itself, its
     * neighbours, and the same for its guests (the small cells it hosts). opens: the inverse relation, the
     * cells no longer corrected when a cell loses a bond. */
    pg_family needs, opens;
    /* Points of faces with wider supports (face.wide), and points that still have too few neighbours. */
    pg_widened widened;
} pg_consistency;
/* Finds the faces (face_order Gauss points per direction), their shape functions, and the lists of nodes.
 * points: the evaluation points with their families. PG_E_MEMORY, and whatever the approximation reports. */
pg_status pg_consistency_create (pg_consistency **out, const pg_cells *cells, const pg_approx *approx,
                                 const pg_cloud *cloud, const pg_rows *points, int face_order, int threads);
void      pg_consistency_free   (pg_consistency **c);
/* Sets the normals (rows of facets x dim) of points on facets whose fluxes were changed to flux / weight, not
 * quite of unit length, so that loads, supports and the divergence identity use the same surface. c NULL:
 * nothing is changed. */
void      pg_consistency_normals (const pg_consistency *c, const pg_rows *facets, double *normal);
/* Writes wide->N and wide->dN (in the layout of c->family) for the cells list[0..count), or for all cells
 * where list is NULL, from the uncorrected values in `points`: corrected in cells with whole[cell] set,
 * copied in others. face: N at the points of faces, in the layout of c->face (NULL: those of the intact
 * body). Each cell writes only its own points, so that results do not depend on the number of threads. */
pg_status pg_consistency_apply (const pg_consistency *c, const pg_rows *points, pg_rows *wide,
                                const unsigned char *whole, const double *face, size_t count,
                                const size_t *list, int threads);

/* ---- patches of the dilatation ------------------------------------------------------------------------ */
/* Near Poisson's ratio 1/2 a condition on the dilatation at every evaluation point leaves the displacement
 * too little freedom (volumetric locking). The dilatation that carries the pressure is then the mean over
 * patches of about 2 cells, or 3 points of nodal integration, per axis. Patches are of one material each,
 * and none has less than 0.4 of the full volume where there is a neighbour to join. They are disjoint but
 * where what joins has several neighbours that are as near: each takes an equal share of its points. */
typedef struct {
    /* Number of patches. */
    size_t  n;
    /* Evaluation points of patch c, ascending: point[i] for its entries i = first[c] .. first[c + 1] - 1;
     * share[i]: how much of the weight of the point counts there; of[i]: c. */
    size_t *first, *point, *of;
    double *share;
    /* Entries of point p, whose shares sum to 1: entry[start[p]] .. entry[start[p + 1] - 1]; none where its
     * material needs no projection. */
    size_t *start, *entry;
    /* The nodes that the points of each patch see. */
    pg_family family;
    /* Volume that a complete patch has there, m^3 (less where the body is thinner than a patch) (n). */
    double *full;
    /* First Lame constant of every material, Pa; 0: the dilatation is taken at the points (materials). */
    double *lambda;
} pg_patches;

/* What patches are made from; everything is borrowed. */
typedef struct {
    /* Evaluation points: positions, weights, cells. */
    const pg_rows    *points;
    /* The nodes that the evaluation points see. */
    const pg_family  *family;
    /* The nodes. */
    const pg_cloud   *cloud;
    /* Background cells; NULL: the evaluation points are the nodes. */
    const pg_cells   *cells;
    /* The lattice; NULL: irregular points, or a mesh. */
    const pg_lattice *lattice;
    /* 1: the nodes lie at the centres of the cells of the lattice. */
    int               centred;
    /* Material of every evaluation point. */
    const int        *block;
    /* Local spacing at every evaluation point, m; NULL: that of the cloud. */
    const double     *spacing;
    /* Cells, or points, per axis of a patch. */
    int               across;
    /* Number of materials. */
    size_t            materials;
    /* First Lame constant of every material, Pa; 0: not projected. */
    const double     *lambda;
} pg_patch_source;
/* Forms the patches. They depend neither on axes (a mirrored or rotated body has mirrored or rotated patches)
 * nor on the order of cells or, but for points that nothing else tells apart, of nodes. PG_E_MEMORY. */
pg_status pg_patches_create (pg_patches **out, const pg_patch_source *source);
void      pg_patches_free   (pg_patches **patches);

/* Stabilisation of nodally integrated NOSB (Silling 2017; doc/method.md D3a). Adds S_ab times the unit
 * matrix to the blocks (dim x dim each) of the nodes b = 0 .. m - 1 of point p against its node a (local
 * numbers within the family of p). The energy is (1/2) sum_ab S_ab d_a . d_b; it vanishes for linear
 * fields. modulus: Gs mu (Pa); volume: that of the point (m^3). */
void pg_silling_add (const pg_rows *rows, const pg_cloud *cloud, size_t p, size_t a, size_t m, double modulus,
                     double volume, double *blocks);
PG_API_END
#endif
