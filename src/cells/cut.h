/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: cells cut by the surfaces of the body. Every surface is a quadric psi (x) = x.A x + b.x + c = 0.
 * Within a cell all is done in local coordinates: the cell is [-1, 1]^dim. Files: cut_poly.c (roots),
 * cut_surface.c (the body as quadrics), cut_solve.c (where three quadrics meet), cut_split.c (where the shape
 * of a slice changes), cut_points.c (quadrature), cut_cells.c and cut_share.c (cells). */
#ifndef PERIGAL_CELLS_CUT_H
#define PERIGAL_CELLS_CUT_H
#include "perigal/cells.h"

typedef struct cut_work cut_work;
static const double cut_snap = 1e-10;  /* a surface so near to a face of the cell (local) lies on it */

typedef struct { double A[3][3], b[3], c; } cut_quadric;           /* A symmetric */
typedef struct {
    cut_quadric psi;                                   /* about `origin`; |grad psi| = 1 on the surface */
    double origin[3], low[3], high[3];                 /* m; box of the part that may bound the body */
    /* of the body, -1 a knife; a plane; end of a cylinder; normal axis or -1 */
    int    shape, flat, end, axis;
    int    part;                                       /* of the shape (parts.c) */
} cut_surface;
struct pg_cut {
    int dim;
    pg_body body;  /* its shapes are borrowed; of a mesh: as the lattice sees it */
    pg_shape *own;  /* then these are the shapes (body.n), NULL: there is no mesh */
    cut_surface *surface;  size_t n;
    size_t *start;  int *near;                         /* surfaces near each cell of pg_cells (n + 1) */
    int *part;                                         /* of each facet: on which sides of the knives */
    cut_work *work;
};
void cut_free (struct pg_cut *cut);
/* Facet `at` becomes that face (-x +x -y +y -z +z) of its cell, a lattice cell of these edges (m). */
void cells_put_face (pg_cells *out, size_t at, int face, const double *step);

/* ---- polynomials --------------------------------------------------------------------------------------- */
enum { CUT_DEGREE = 4 };
/* Real roots of sum c[k] x^k within [low, high], ascending; those that only touch zero (to rounding) too. */
int  cut_roots (int degree, const double *c, double low, double high, double *root);
void cut_gauss (int n, double *x, double *w);          /* Gauss-Legendre on [0, 1] */

/* ---- surfaces ------------------------------------------------------------------------------------------ */
/* Of the body, then the knives: half-planes along z that part facets and bound nothing. */
enum { CUT_KNIVES = 4 };                               /* in one cell at most */
pg_status cut_surfaces (struct pg_cut *cut, const pg_body *body, const pg_lattice *lattice, size_t nray,
                        const pg_ray *ray);
/* In the coordinates of the cell with this centre and these half edges, scaled to coefficients of size 1. */
cut_quadric cut_local (const cut_surface *s, int dim, const double *centre, const double *half);
double cut_value (const cut_quadric *q, const double *x);
void   cut_gradient (const cut_quadric *q, const double *x, double *g);
void   cut_restrict (cut_quadric *q, int axis, double at);         /* x[axis] = at; the axis drops out */
/* may be 0 in the box? */
int    cut_meets (const cut_quadric *q, const double *centre, const double *half, double slack);

/* ---- splits -------------------------------------------------------------------------------------------- */
/* Solutions of three quadrics = 0 in [-reach, reach]^3, at most CUT_MEETINGS of them (x: n x 3). */
enum { CUT_MEETINGS = 24 };
int cut_solve (const cut_quadric *q, double reach, double *x);

typedef struct { double *at; size_t n, capacity; } cut_list;
typedef struct {
    cut_list hard, soft;  /* soft: square roots begin here, also outside [-1, 1] */
    cut_quadric *q;                                    /* the surfaces, restricted to the slice */
} cut_level;
typedef struct {
    int    dim, axis[3];                               /* outermost first; the last is the height */
    size_t n, capacity;                                /* surfaces */
    int   *number;                                     /* of the surfaces in the body */
    double *low, *high;                                /* their boxes, local (n x 3) */
    cut_level level[3];
    double at[3];                                      /* where the walk is */
    pg_status status;
} cut_slices;
/* Values of x[axis[k]] between which nothing changes its order, for the slice level k < dim - 1. */
void cut_split (cut_slices *s, int k);
/* the part of surface i that may bound the body holds s->at? */
int  cut_within (const cut_slices *s, size_t i);

/* ---- quadrature ---------------------------------------------------------------------------------------- */
pg_status cut_work_create (cut_work **out, const struct pg_cut *cut, double thickness);
void      cut_work_free   (cut_work **work);
/* The cell low..high (m) and the surfaces near it. */
pg_status cut_work_cell   (cut_work *w, const double *low, const double *high, size_t n, const int *near);
/* Points within the body (surface < 0), or on that surface where it bounds the body, of one part between
 * knives; appended. */
pg_status cut_work_points (cut_work *w, int surface, int part, int order, pg_cut_points *out);
size_t    cut_work_knives (const cut_work *w);         /* in the cell: 2^knives parts */
/* Points of the face (-x +x -y +y -z +z) of the cell that lie in the body on both of its sides; weights
 * without normals. dim > 1. */
pg_status cut_work_face   (cut_work *w, int face, int order, pg_cut_points *out);
/* Size (thickness included), centroid and integral of the normal, to rounding. */
typedef struct { double size, centre[3], normal[3]; } cut_piece;
pg_status cut_work_piece  (cut_work *w, int surface, int part, cut_piece *piece);
#endif
