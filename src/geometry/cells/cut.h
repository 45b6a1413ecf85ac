/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: cells of a lattice that the surface of the body cuts.
 *
 * Every surface of the body is a quadric psi (x) = x.A x + b.x + c = 0 (planes, cylinders, spheres). Within
 * a cell all computation is in local coordinates in which the cell is the cube [-1, 1]^dim; tolerances are
 * relative to that. Quadrature is by dimension reduction (Saye 2015, doi 10.1137/140966290): the cell is
 * divided into slices along one axis, slices into lines along the next, and lines into pieces at their
 * intersections with the surfaces; Gauss points on every piece.
 *
 * Files: cut_poly.c (roots of polynomials), cut_surface.c (the body as quadrics), cut_solve.c (points where
 * three quadrics meet), cut_split.c (positions at which slices change their topology), cut_points.c (the
 * quadrature), cut_cells.c (which cells are cut, their facets).
 *
 * Beside the surfaces of the body there are dividing half-planes parallel to z (in 2D: rays). They bound
 * nothing, but divide facets into parts, so that a named set can end inside a cell. */
#ifndef PERIGAL_CELLS_CUT_H
#define PERIGAL_CELLS_CUT_H
#include "perigal/cells.h"

typedef struct cut_work cut_work;
/* A surface this near to a face of the cell, in local coordinates, counts as lying on it: far above the
 * rounding of the computation, far below any length that matters. The rounding of coordinates is added. */
static const double cut_snap = 1e-10;

/* Numbers of size 1 that differ by less are equal but for rounding. */
static const double cut_equal = 1e-9;

/* The quadratic function x.A x + b.x + c; A is symmetric, entries beyond dim are zero. */
typedef struct { double A[3][3], b[3], c; } cut_quadric;

/* One surface: a quadric, and the box of the part of it that may bound the body. */
typedef struct {
    /* Taken about `origin`, so that no digits are lost far from zero; scaled so that |grad psi| = 1 where
     * psi = 0. */
    cut_quadric psi;
    /* Reference point; corners of the box that holds the part of the surface that can bound the body. m. */
    double origin[3], low[3], high[3];
    /* shape: index of the shape of the body, -1 for a dividing half-plane. flat: it is a plane. end: it is
     * a flat end of a cylinder. axis: the coordinate axis that the plane is normal to, -1: none. */
    int    shape, flat, end, axis;
    /* Which part of the shape it is, numbered as in parts.c. */
    int    part;
    /* facets, region: the surface is this plane region of a mesh or an alpha shape; NULL: it is no such
     * region. A region ends at its own edges, not where other surfaces cross it. */
    const pg_facets *facets;  int region;
} cut_surface;

/* Everything that the quadrature of cut cells needs; part of pg_cells. */
struct pg_cut {
    int dim;
    /* The body; its shapes are borrowed. A shape from a mesh is replaced by its cells of the lattice
     * (PG_STAIRS). */
    pg_body body;
    /* The shapes after that replacement (body.n); NULL where the body has no mesh. */
    pg_shape *own;
    /* All surfaces, those of the body first, dividing half-planes last. */
    cut_surface *surface;  size_t n;
    /* Numbers of the surfaces that come near each cell of pg_cells, ascending (compressed rows: start has n
     * + 1 entries). */
    size_t *start;  int *near;
    /* For each facet: on which sides of the dividing half-planes of its cell it lies, one bit each. */
    int *part;
    /* Rounding of the coordinates of body and lattice, m. */
    double rounding;
    /* Workspace of the quadrature, shared by all calls: hence not thread-safe. */
    cut_work *work;
};
/* Frees all of it; NULL is allowed. */
void cut_free (struct pg_cut *cut);
/* Makes facet `at` a whole face (number -x +x -y +y -z +z) of its cell (facet_cell must be set), a lattice
 * cell with the edges `step` (m): nodes, centroid, normal and area. */
void cells_put_face (pg_cells *out, size_t at, int face, const double *step);

/* ---- polynomials --------------------------------------------------------------------------------------- */
/* Degree of the polynomials that arise at most: the resultant of two conics has degree 4. */
enum { CUT_DEGREE = 4 };
/* Real roots of sum_k c[k] x^k within [low, high], ascending; also double roots that only touch zero: of
 * degree 2 where the discriminant is below `rounding` of its terms. Returns how many; `root` has room for
 * degree + 2. */
int  cut_roots (int degree, const double *c, double rounding, double low, double high, double *root);
/* Gauss-Legendre points and weights on [0, 1]. */
void cut_gauss (int n, double *x, double *w);

/* ---- surfaces ------------------------------------------------------------------------------------------ */
/* At most so many dividing half-planes take part in one cell. Where more come near, its facets are not
 * divided by all of them, and sets that take some of these facets by their angle are refused (sets.c). */
enum { CUT_HALF_PLANES = 4 };
/* The number of dividing half-planes near the cell of a facet; 0 without cut cells. */
size_t cut_half_planes_near (const pg_cells *cells, size_t facet);
/* Fills cut->surface from the shapes of the body, followed by one dividing half-plane for each ray. */
pg_status cut_surfaces (struct pg_cut *cut, const pg_body *body, const pg_lattice *lattice, size_t nray,
                        const pg_ray *ray);
/* The surface in the local coordinates of the cell with this centre and these half edges (m), scaled so
 * that its largest coefficient is about 1. */
cut_quadric cut_local (const cut_surface *s, int dim, const double *centre, const double *half);
/* Value and gradient of the quadric at x (3 numbers). */
double cut_value (const cut_quadric *q, const double *x);
void   cut_gradient (const cut_quadric *q, const double *x, double *g);
/* Sets x[axis] = at: the function of the remaining coordinates, in which the axis no longer occurs. */
void   cut_restrict (cut_quadric *q, int axis, double at);
/* Can the quadric vanish in the box (centre, half edges)? 0 only if it certainly cannot: a bound from
 * value, gradient and second derivatives at the centre. slack widens the answer. */
int    cut_meets (const cut_quadric *q, const double *centre, const double *half, double slack);

/* ---- splits -------------------------------------------------------------------------------------------- */
/* At most so many points are returned by cut_solve. */
enum { CUT_MEETINGS = 24 };
/* All points in [-reach, reach]^3 where the three quadrics q[0..2] vanish (x: n x 3). Returns n, at most
 * CUT_MEETINGS; only isolated solutions are meant. given_up: 1: there are more, or they are not isolated. */
int cut_solve (const cut_quadric *q, double reach, double *x, int *given_up);

/* A growing list of coordinates. */
typedef struct { double *at; size_t n, capacity; } cut_list;
/* One level of the recursion from the cell to slices to lines. */
typedef struct {
    /* Coordinates that divide the level's axis. hard: the interval of integration ends here, in [-1, 1].
     * soft: near here the height of a surface behaves like a square root, also a little outside [-1, 1];
     * the quadrature of the neighbouring interval substitutes it away. */
    cut_list hard, soft;
    /* The surfaces, restricted to the present slice. */
    cut_quadric *q;
} cut_level;
/* State of the recursion over one cell. */
typedef struct {
    /* axis: order of the coordinate axes, outermost first; the last one is the height, along which lines
     * run. */
    int    dim, axis[3];
    /* Number of surfaces that take part, and for how many there is memory. */
    size_t n, capacity;
    /* Number of each of these surfaces within pg_cut.surface (n). */
    int   *number;
    /* Corners of the box of each surface, local coordinates (n x 3). */
    double *low, *high;
    /* facets: the pg_facets that each surface is a region of, NULL: none. mute: 1: the quadrature under way
     * leaves the surface out (n each). */
    const pg_facets **facets;
    unsigned char *mute;
    /* Tolerances in local coordinates: points nearer than `rounding` are one, a surface nearer than `snap` to
     * a face of the cell lies on it, numbers of size 1 that differ by less than `equal` are equal. Each
     * includes the rounding of coordinates. */
    double rounding, snap, equal;
    /* 1: all surfaces are planes normal to a coordinate axis, so that each divides the whole cell. */
    int square;
    /* edge: edges of regions of pg_facets near the cell, local coordinates: two end points (2D: one), 6
     * numbers per edge. edge_of: the surface that each edge bounds. */
    double *edge;  int *edge_of;  size_t nedge, edge_room, edge_of_room;
    cut_level level[3];
    /* The present position, local. */
    double at[3];
    /* First failure of the recursion (out of memory). */
    pg_status status;
    /* Searches by cut_solve that were given up. */
    size_t given_up;
} cut_slices;
/* Fills level[k].hard and .soft, k < dim - 1: the values of x[axis[k]] between which the intersections of
 * the surfaces with the slice keep their number and order. */
void cut_split (cut_slices *s, int k);
/* Is s->at within the box of surface i, to 1e-7 of the cell? */
int  cut_within (const cut_slices *s, size_t i);

/* Orders of the axes for the quadrature of the cell (surface -1) or of that surface in it, outermost first;
 * returns how many, and sets s->square. The height is the axis that the normals follow most, so that surfaces
 * are graphs over the other axes as far as possible; the axis they follow least is outermost. Of two that
 * they follow equally the surfaces are less bent along the inner one. Equal ones come in every order, so that
 * neither rounding nor the numbers of the axes choose: each order gets its share of the weight. If all
 * surfaces are planes normal to the axes, any order gives the same points. fixed: the axis that comes first
 * in a face of the cell, and its side; -1: none. */
int  cut_axes (cut_slices *s, const struct pg_cut *cut, int surface, int fixed, int side, int order[6][3]);
/* Does surface i come near that face of the cell? The two cells at a face get the same answer. */
int  cut_on_face (const cut_slices *s, size_t i, int axis, int side);
/* Are surfaces i and j regions of the same pg_facets? Such surfaces meet only at their own edges. */
int  cut_same_facets (const cut_slices *s, size_t i, size_t j);

/* ---- quadrature ---------------------------------------------------------------------------------------- */
/* Creates and frees the workspace. PG_E_MEMORY. */
pg_status cut_work_create (cut_work **out, const struct pg_cut *cut, double thickness);
void      cut_work_free   (cut_work **work);
/* Prepares for the cell low..high (m) and the n surfaces `near` it, dividing half-planes last. */
pg_status cut_work_cell   (cut_work *w, const double *low, const double *high, size_t n, const int *near);
/* Appends quadrature points: surface < 0: within the body; else on that surface, where it bounds the body,
 * only of the given part between the dividing half-planes. */
pg_status cut_work_points (cut_work *w, int surface, int part, int order, pg_cut_points *out);
/* Number of dividing half-planes that take part in this cell: its facets have 2^number parts. */
size_t    cut_work_half_planes (const cut_work *w);
/* Appends points on a face (-x +x -y +y -z +z) of the cell where the body lies on both of its sides. dim >
 * 1; normals stay zero. */
pg_status cut_work_face   (cut_work *w, int face, int order, pg_cut_points *out);
/* Measure (volume or area, thickness included), centroid and integral of the outward normal. */
typedef struct { double size, centre[3], normal[3]; } cut_piece;
/* Computes size, centroid and normal of the body in the cell (surface < 0) or of one part of a surface, by
 * raising the order until the size changes by less than 1e-13 of the cell. */
pg_status cut_work_piece  (cut_work *w, int surface, int part, cut_piece *piece);
/* The size of the present cell, thickness included, from its corners as they are rounded, m^3. */
double    cut_work_size      (const cut_work *w);
/* Over all pieces so far whose quadrature did not converge: the largest change of a size when the order was
 * last raised (27 to 40 points), relative to a whole cell (surfaces: to its largest face); 0: all
 * converged. */
double    cut_work_unsettled (const cut_work *w);
/* Does a surface that is a region of facets come near this cell? */
int       cut_work_faceted (const cut_work *w);
/* Replaces many points in a cell by fewer with the same moments: sum w p for all polynomials p of degree 3.
 * The new points are the centroids of the points in each box of a grid, the weights positive; a mirrored cell
 * gets the mirrored points. Where this fails the points stay as they are. PG_E_MEMORY. */
pg_status cut_compress    (pg_cut_points *points, size_t first, int dim);
/* leave 1: quadrature from now on omits slices and pieces of lines at most a hundred times as thick as the
 * rounding of coordinates, which decides whether such pieces exist at all. 0: nothing is omitted. */
void      cut_work_leave_slivers (cut_work *w, int leave);
/* How often the search for points where three surfaces meet was given up (cut_solve). Surfaces that share a
 * curve meet along all of it, and nothing is lost there; lost corners show in cut_work_unsettled. */
size_t    cut_work_given_up (const cut_work *w);
#endif
