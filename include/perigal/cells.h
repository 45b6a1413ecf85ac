/* SPDX-License-Identifier: GPL-3.0-or-later
 * cells.h: background cells for integration, boundary facets with outward normals, and named sets of points
 * and facets.
 *
 * The cells tile the body. They come from a lattice of equal boxes, whole (`cells: staircase`) or cut
 * exactly along the surface of the body (`cells: cut`), or they are the elements of a mesh. Facets are the
 * pieces of the boundary: faces of whole cells, pieces of the exact surface in cut cells, or outer faces of
 * a mesh. Loads, supports and contact are integrated over facets, the weak form over cells. Volumes and
 * areas include the thickness (2D) or the cross section (1D), so they are m^3 and m^2 always. */
#ifndef PERIGAL_CELLS_H
#define PERIGAL_CELLS_H
#include "perigal/cloud.h"
#include "perigal/mesh.h"

PG_API_BEGIN

/* Kind of a cell or facet that the surface of the body crosses, beside the kinds of pg_element. Its
 * quadrature points come from `cut`. The nodes stored for such a cell are the corners of the uncut lattice
 * cell; such a facet has no nodes at all (facet_start does not advance). */
enum { PG_CUT = PG_ELEMENTS };
/* A named group of points and facets. Indices are ascending and refer to pg_cloud and pg_cells. */
typedef struct {
    char    name[64];
    /* Numbers of points and of facets in the set. */
    size_t  npoint, nfacet;
    /* Indices of points (npoint) and of facets (nfacet), ascending. */
    int    *point, *facet;
    /* Points of the set that belong to none of its facets (a facet's points are its own nodes or those of the
     * cell behind it; src/geometry/cells). A set that has an inside, such as a layer or `where: x < 1 mm`,
     * must constrain these points one by one, beside integrating over its facets. Not filled (0, NULL) where
     * the set was chosen by its faces. */
    size_t  ninner;  int *inner;
    /* Numbers of points, facets and inner points of the set on all MPI ranks together, facets at borders of
     * subdomains counted more than once (pg_set_points, pg_set_facets, pg_set_inner); only in parallel
     * runs. */
    size_t  all_points, all_facets, all_inner;
    /* 1: the set was chosen by its faces (a side, a part of a shape, `boundary`, a side set of a mesh), not
     * by a condition on positions: a total force is then spread over its area. */
    int     by_faces;
} pg_set;
/* Numbers of points and facets of the set on all ranks. */
static inline size_t pg_set_points (const pg_set *s) { return pg_ranks_now () ? s->all_points : s->npoint; }
static inline size_t pg_set_facets (const pg_set *s) { return pg_ranks_now () ? s->all_facets : s->nfacet; }

static inline size_t pg_set_inner  (const pg_set *s) { return pg_ranks_now () ? s->all_inner : s->ninner; }

/* The cells and facets of a body. Arrays of variable length per cell or facet are stored in compressed
 * form: the entries of item c are start[c] .. start[c + 1] - 1. */
typedef struct {
    /* Dimension of space, 1 to 3. */
    int     dim;
    /* Number of cells. */
    size_t  n;
    /* Kind of each cell: a value of pg_element, or PG_CUT (n). */
    unsigned char *kind;
    /* First node of each cell in `x` (n + 1). */
    size_t *start;
    /* Positions of the nodes, m, in the node order of Exodus (start[n] x dim). Cells share no nodes here:
     * each has copies of its own. */
    double *x;
    /* Volume of each cell, of a cut cell that of its part in the body; m^3, thickness included (n). */
    double *volume;
    /* Index of the mesh block that the cell belongs to; 0 in a lattice (n). */
    int    *block;
    /* Parallel runs of a body without a lattice only, else NULL: 1 for each cell that this rank owns, and the
     * number of each cell among those of all ranks (n). */
    unsigned char *owned;  int64_t *number;
    /* Number of facets. */
    size_t  nfacet;
    /* Kind of each facet: a value of pg_element of dimension dim - 1, or PG_CUT (nfacet). */
    unsigned char *facet_kind;
    /* First node of each facet in `facet_x` (nfacet + 1). */
    size_t *facet_start;
    /* Positions of the nodes of the facets, m (facet_start[nfacet] x dim). */
    double *facet_x;
    /* Centroid of each facet, m (nfacet x dim). */
    double *facet_centre;
    /* Mean outward normal of each facet, of unit length (nfacet x dim). */
    double *normal;
    /* Area of each facet, m^2, thickness included (nfacet). */
    double *area;
    /* The cell that each facet bounds (nfacet). */
    int    *facet_cell;
    /* Number (in `cut`) of the surface of the body of which the facet is a piece; -1: the facet is a face of
     * a whole cell or element (nfacet). */
    int    *facet_surface;
    /* Only with a mesh, else NULL: the point of the cloud at each node of the facets, -1 where the node is
     * no point (facet_start[nfacet]). */
    int    *facet_point;
    /* Sets defined by the mesh file (ngiven); none with a lattice. */
    pg_set *given;  size_t ngiven;
    /* Thickness in 2D (m), cross section in 1D (m^2), 1 in 3D. */
    double  thickness;
    /* Geometry of the cut cells, owned by this structure; NULL where no cell is cut. */
    struct pg_cut *cut;
    /* Least number of Gauss points per direction in cut cells and on cut facets, even if a caller asks for
     * fewer. */
    int     cut_order;
    /* How well volumes of cut cells and areas of cut facets are known: the largest change of one of them by
     * the last raise of the order, over the volume of a whole cell or the area of its largest face; 0: all
     * changed by less than 1e-13. given_up: number of searches for corners (intersections of surfaces) that
     * found too many positions (where surfaces share a curve, which does no harm, or are nearly tangent). */
    double  unsettled;
    size_t  given_up;
} pg_cells;
/* Allocates all arrays, zeroed, for n cells with nx nodes together and nfacet facets with nfx nodes
 * together, and sets dim and thickness. PG_E_LIMIT where a number exceeds the range of int; on failure
 * nothing remains. */
pg_status pg_cells_reserve (pg_cells *out, int dim, double thickness, size_t n, size_t nx, size_t nfacet,
                            size_t nfx);
/* Cells from those boxes of the lattice whose centre lies in the body: bars, quadrilaterals or hexahedra;
 * facets from their faces that border on none (a staircase). An empty lattice (points from a file) gives no
 * cells. */
pg_status pg_cells_from_lattice (pg_cells *out, const pg_lattice *lattice, double thickness);
/* Makes the cells and facets of pg_cells_from_lattice for the boxes in `within` only (indices in the whole
 * lattice, of which `lattice` may be a part); there are no facets towards boxes of the body beyond
 * `within`. */
pg_status pg_cells_from_part (pg_cells *out, const pg_lattice *lattice, double thickness,
                              const pg_box *within);
/* A ray in the xy plane (in 3D a half-plane parallel to z) from `centre` (m) in the unit vector
 * `direction`. */
typedef struct { double centre[2], direction[2]; } pg_ray;
/* Cells of the lattice, cut by the exact surface of the body. A box that the surface crosses becomes a cell
 * of kind PG_CUT; it is kept while its share of the volume of a whole box exceeds 1e-13, wherever its centre
 * lies. Facets are pieces of the surface, one for each pair of cell and surface, divided further along the
 * rays given (ends of the angle ranges of sets, so that every facet is wholly inside or outside a range). The
 * shapes of the body are borrowed and must outlive the cells. Where nothing is cut the result is that of
 * pg_cells_from_lattice. */
pg_status pg_cells_cut (pg_cells *out, const pg_body *body, const pg_lattice *lattice, double thickness,
                        size_t nray, const pg_ray *ray);
/* The rays at the ends of the angle ranges of all sets of the scene, for pg_cells_cut; the caller frees
 * *out by pg_free. They start at the centre of the body's bounding box. */
pg_status pg_sets_rays (pg_ray **out, size_t *n, const pg_scene *scene, const pg_body *body);
/* Returns 1 and writes a warning into text (size bytes) where cells->unsettled is more than 1e-6. */
int       pg_cells_doubt (const pg_cells *cells, char *text, size_t size);
/* Recomputes the volumes of the points from cut cells: each cell is shared equally among its points (its
 * vertices, or its centre). A cell without any gives its volume to the nearest point, in equal parts to all
 * those equally near. Does nothing where no cell is cut: the volumes from the lattice are exact then. */
pg_status pg_cells_share (pg_cloud *cloud, const pg_cells *cells, const pg_lattice *lattice);
/* Cells and facets from the elements and the surface of a mesh, after pg_mesh_body_cloud has numbered the
 * points. Side sets become sets of facets and of all nodes of their faces; their faces inside the body are
 * left out as facets. Node sets become sets of points and of those facets whose nodes all belong to the
 * set. */
pg_status pg_cells_from_mesh (pg_cells *out, const pg_mesh_body *body, double thickness);
/* Parallel runs of a body without a lattice: keeps of the cells of the whole body those within `reach` (m) of
 * the box of the points that this rank owns, and all cells that it owns (a cell belongs to the rank of the
 * point nearest to its middle). whole: all points (pg_cloud_divide), owner: rank of each; afterwards points
 * are numbered among those stored on this rank. PG_E_MEMORY. */
pg_status pg_cells_keep (pg_cells *cells, const pg_cloud *whole, const int *owner, double reach);
/* Converts the name of a set of a mesh file into the one by which a scene refers to it: characters other than
 * letters, digits, - and _ become _; at most 56 bytes; "all" becomes mesh_all, an empty name mesh_set. */
void      pg_set_name (char out[57], const char *name);
void      pg_cells_clear (pg_cells *cells);

/* ---- cut cells ----------------------------------------------------------------------------------------- */
/* Quadrature points in the part of a cell that lies in the body: positions x (m, n x dim), weights (m^3 in
 * cells, m^2 on facets, thickness included) and, on facets, outward unit normals (n x dim; zero in cells).
 * Method: dimension reduction after Saye 2015, doi 10.1137/140966290 (src/geometry/cells/cut_points.c).
 * All weights
 * are positive; as the boundary is curved, their sum equals the volume only to the accuracy of the order. */
typedef struct { size_t n, capacity; double *x, *weight, *normal; } pg_cut_points;
/* Append quadrature points of a cell or a facet of kind PG_CUT to `out` (zero at first), with `order` Gauss
 * points per direction, at least cells->cut_order. The only error is PG_E_MEMORY. Not thread-safe: all calls
 * for one pg_cells share a workspace. */
pg_status pg_cut_cell   (pg_cut_points *out, const pg_cells *cells, size_t cell, int order);
pg_status pg_cut_facet  (pg_cut_points *out, const pg_cells *cells, size_t facet, int order);
/* Appends quadrature points of that part of a face (0 .. 5: -x +x -y +y -z +z) of a lattice cell of any kind
 * that has the body on both sides, where two cells are connected. dim > 1; normals stay zero. */
pg_status pg_cut_face   (pg_cut_points *out, const pg_cells *cells, size_t cell, int face, int order);
void      pg_cut_points_clear (pg_cut_points *points);
/* Index of the shape of the body to which a surface (cells.facet_surface >= 0) belongs; 1: it is one of the
 * two flat ends of a cylinder. */
int       pg_cut_shape  (const struct pg_cut *cut, int surface);
int       pg_cut_is_end (const struct pg_cut *cut, int surface);

/* ---- cells that cracks divide -------------------------------------------------------------------------- */
/* Part of a 2D cell as a polygon, counterclockwise: vertices, m; for the edge that starts at each vertex the
 * side of the cell on which it lies (Exodus numbers less 1; -1: inside the cell), and 1 if it lies on a
 * crack. */
enum { PG_PART_EDGES = 24, PG_PARTS = 4 };
typedef struct {
    int n;
    double x[PG_PART_EDGES][2];
    int side[PG_PART_EDGES], crack[PG_PART_EDGES];
} pg_cell_part;
typedef struct { int n; pg_cell_part part[PG_PARTS]; } pg_cell_parts;
/* Divides a 2D cell along the cracks (segments; lengths below `nothing`, m, count as zero). Returns 1: `out`
 * has the parts, one where no crack runs through the cell; 0: a crack ends, branches or crosses another one
 * in the cell, covers a part of a side, the cell has too many parts, or its sides are not straight. */
int    pg_cell_divide (pg_cell_parts *out, const pg_cells *cells, size_t cell, const pg_cracks *cracks,
                       double nothing);
/* Finds where the segment a - b enters and leaves a 2D cell, as fractions (0 to 1) of its length; returns 0:
 * it does not meet the cell. A segment along a side is in both cells. Sides of the cell must be straight. */
int    pg_cell_clip   (const pg_cells *cells, size_t cell, const double *a, const double *b, double nothing,
                       double share[2]);
double pg_cell_part_area  (const pg_cell_part *part);  /* area, m^2 */
int    pg_cell_part_holds (const pg_cell_part *part, const double *x);

/* Named sets of a scene: `sets: NAME: {boundary: ..., angle: ..., where: ...}`. For every set NAME there are
 * also NAME.left, .right, .bottom, .top, .back and .front, its halves on the left, right ... of the centre of
 * the body's bounding box. */
typedef struct {
    pg_set *set; size_t n;
    /* Coordinates, m, of the planes of the bounding box, in the order left right bottom top back front; NAN
     * for sides that this dimension does not have. */
    double plane[6];
    /* Names SHAPE.PART of all parts of shapes, for messages. */
    char   parts[320];
} pg_sets;
/* Builds all named sets, in this order:
 * - the predefined sides left right bottom top back front (facets in the planes of the bounding box and their
 * points; for a body without facets the points within half their spacing of the planes) and all;
 * - the sets of the mesh, which take the place of predefined ones of the same name;
 * - boundary layers; the sets of the scene; the parts of shapes (SHAPE.PART) that loads, averages,
 * `failure.exclude` and `solver.stop` name.
 *
 * Each comes with its halves. Sides that the dimension lacks do not exist. An empty set of the scene is an
 * error; an empty predefined set or half is not. Also with PG_E_SCENE all sets are built, so that the caller
 * can look for further errors of the scene; it clears them. */
pg_status pg_sets_build (pg_sets *out, const pg_scene *scene, const pg_body *body, const pg_lattice *lattice,
                         const pg_cloud *cloud, const pg_cells *cells);
/* The set of that name, NULL: there is none. */
const pg_set *pg_sets_find  (const pg_sets *sets, const char *name);
/* 1: the set is a predefined side in whose plane the body has no face (the top of a disk), hence empty. */
int           pg_sets_empty_side (const pg_sets *sets, const pg_set *set);
/* Finds the set of a name that the scene gives under the key `path`; an unknown name is reported as an error
 * of the scene that suggests the nearest one, an empty side as an error that says what to name instead. */
const pg_set *pg_sets_named (const pg_sets *sets, const pg_scene *scene, const char *path, const char *name);
void          pg_sets_clear (pg_sets *sets);
PG_API_END
#endif
