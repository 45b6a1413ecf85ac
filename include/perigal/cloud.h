/* SPDX-License-Identifier: GPL-3.0-or-later
 * cloud.h: the body as shapes, points with volumes, families of neighbours, pre-cracks. */
#ifndef PERIGAL_CLOUD_H
#define PERIGAL_CLOUD_H
#include "perigal/scene.h"
#include "perigal/linalg.h"
#include "perigal/mesh.h"

PG_API_BEGIN

/* ---- shapes -------------------------------------------------------------------------------------------- */
enum { PG_BOX, PG_DISK, PG_CYLINDER, PG_SPHERE, PG_POLYGON, PG_PRISM, PG_MESH, PG_STAIRS };
typedef struct {
    int    kind, add;                                  /* add: 1 adds, 0 subtracts */
    /* name of its surface for `sets: {boundary: NAME}`: as given by `name:`, else "rim" (round, added),
     * "hole" (subtracted), "side" */
    char   boundary[32];
    double low[3], high[3];                            /* box, prism (along z): m */
    double centre[3], axis[3], radius, length;  /* disk, sphere; cylinder: axis from centre, length, m */
    double *vertex; size_t nvertex;                    /* polygon, prism: nvertex x 2, m */
    struct pg_solid *solid;  /* mesh: its elements and their surface; stairs: cells of a lattice */
} pg_shape;
/* A fictitious boundary layer: a box over one face of the bounding box of the shapes, outside of it; over all
 * of the face, or over its part from the first to the last place along each axis below which, half a cell
 * deep, the body lies. */
typedef struct {
    char   name[32];                                   /* of the layer, of its set and of its surface */
    int    side;  /* left right bottom top back front: 2 axis + (high side) */
    int    rows;                                       /* lattice cells across it */
    double face;                                       /* coordinate of that face, m */
} pg_layer;
typedef struct {
    int dim;
    pg_shape *shape; size_t n;                         /* those of `body`, then a box for each layer */
    double low[3], high[3];                            /* bounding box of the added shapes and layers, m */
    pg_layer *layer; size_t nlayer;
} pg_body;
/* body: list of {add|subtract: {...}}; layers: list of {name, side, thickness, over}, which become whole
 * cells of the lattice that pg_lattice_fit lays over the body without them at the scene's spacing: round
 * (thickness / step) of them. */
pg_status pg_body_read  (pg_body *out, const pg_scene *scene);
/* The layer that x lies in, beyond the face by more than `margin` (m); -1: none. */
long      pg_body_layer (const pg_body *body, const double *x, double margin);
void      pg_body_clear (pg_body *body);
/* shapes in order, tolerance in m */
int       pg_body_inside (const pg_body *body, const double *x, double tolerance);
/* Index of the shape whose surface is nearest to x, and its distance (m). */
size_t    pg_body_nearest (const pg_body *body, const double *x, double *distance);
const char *pg_shape_kind (const pg_shape *shape);      /* "box", "disk" ...: as the scene calls it */
/* Volume (2D: area, m^2) and surface (2D: length, m) in closed form; 0: known for one shape alone. */
int       pg_body_measure (const pg_body *body, double *volume, double *surface);
/* Shapes of kind PG_MESH: how many the body has. The side sets of their files are names of their parts: does
 * the surface nearest to x belong to that one? Name k of them, NULL: there are no more. */
size_t      pg_body_meshes   (const pg_body *body);
int         pg_shape_on_side (const pg_shape *shape, const double *x, const char *side);
const char *pg_shape_side    (const pg_shape *shape, size_t k);

/* ---- background lattice -------------------------------------------------------------------------------- */
typedef struct {
    int    dim, count[3];                              /* cells per axis (1 beyond dim) */
    /* m: corners of the lattice; step = L / round (L / spacing), L without layers */
    double origin[3], high[3], step[3];
    unsigned char *in;  /* count[0]*count[1]*count[2], x fastest: cell centre in the body */
} pg_lattice;
pg_status pg_lattice_fit (pg_lattice *out, const pg_body *body, double spacing,
                          const double *offset /* fraction of a step or NULL */);
void      pg_lattice_clear (pg_lattice *lattice);
/* Coordinate (m) of vertex i along an axis, i + 0.5: of a cell centre. Corners exact, mirror symmetric about
 * the middle. */
double    pg_lattice_at    (const pg_lattice *lattice, int axis, double i);
/* m: a centre so near to the surface lies on it */
double    pg_lattice_tolerance (const pg_lattice *lattice);
/* A mesh as a lattice sees it (kind PG_STAIRS, made from one of kind PG_MESH): every place of a cell is
 * inside or outside as its centre is. */
pg_status pg_stairs_create (pg_shape *out, const pg_shape *mesh, const pg_lattice *lattice);
void      pg_stairs_clear  (pg_shape *stairs);
/* 1: cell i of the lattice and the one beyond its face (-x +x -y +y -z +z) are not both inside, not both
 * outside. */
int       pg_stairs_step   (const pg_shape *stairs, const int *i, int face);

/* ---- points -------------------------------------------------------------------------------------------- */
typedef struct {
    int     dim;
    size_t  n;
    double *x;                                         /* position, m (n x dim) */
    double *volume;                                    /* m^3: 2D area*thickness, 1D length*area (n) */
    int    *block;                                     /* block number, 0 unless given (n) */
    double *size;                                      /* local spacing, m; NULL: h everywhere (n) */
    double  h;  /* nominal spacing, m: (volume of a lattice cell)^(1/dim) */
    double  step[3];                                   /* lattice step per axis, m */
    double  thickness;                                 /* 2D m; 1D cross-section m^2; 3D 1 */
    double  low[3], high[3];                           /* bounding box, m */
} pg_cloud;
/* Points of the scene: lattice: nodes (grid vertices, boundary included) | cells (cell centres), kept where
 * in the body (nodes: vertices of kept cells); cell volume shared equally by its vertices (nodes). Then
 * perturbed (reproducibly; only points whose surrounding cells are all kept move), or read from `points:
 * FILE`. The lattice is returned as well (empty: dim = 0, for points from a file). */
pg_status pg_cloud_build (pg_cloud *out, pg_lattice *lattice, const pg_body *body, const pg_scene *scene);
void      pg_cloud_clear (pg_cloud *cloud);
/* Local spacing of point i over the nominal one: the support of node i is `horizon` times this. Exactly 1
 * where size is NULL or h. */
double    pg_cloud_ratio (const pg_cloud *cloud, size_t i);
double    pg_cloud_finest (const pg_cloud *cloud);     /* smallest local spacing, m */

/* ---- points of a mesh ---------------------------------------------------------------------------------- */
typedef struct {  /* the body as a mesh; mesh.n = 0: the scene has none */
    pg_mesh mesh;                                      /* the blocks in use, in metres */
    char    file[256];                                 /* as the scene names it */
    double  unit;                                      /* m per unit of the file */
    double *volume;                                    /* of every element, m^dim (mesh.n) */
    double  smallest, largest;                         /* elements' size, volume^(1/dim), m */
    double  quality;  /* worst scaled Jacobian at a corner: 1 best, 0 flat; of the straight element */
    size_t  worst;                                     /* the element that has it */
    int    *point;  /* point of the cloud at each node, -1: none (mesh.nnode) */
} pg_mesh_body;
/* `mesh` of the scene: file, unit, blocks. A file that cannot be read, another dimension, unknown blocks and
 * elements whose map turns inside out somewhere are faults of the scene. */
pg_status pg_mesh_body_read  (pg_mesh_body *out, const pg_scene *scene);
/* Points at the nodes (`mesh.points`: all or corners). Volumes: integrals of the shape functions, in elements
 * where one is not positive (tri6, tet10, quad8 ...) in the ratio of the integrals of their squares; the sum
 * is that of the elements. size: mean length of the edges at a node (half of it where middle nodes are
 * points), and so large that each end of an edge lies in the support of the other from a horizon of 1.7
 * spacings on; h: its mean. Fills body->point. */
pg_status pg_mesh_body_cloud (pg_cloud *out, pg_mesh_body *body, const pg_scene *scene);
void      pg_mesh_body_clear (pg_mesh_body *body);
/* 1: there are elements with points in the middle of their edges, half an edge apart: they want finer
 * quadrature. */
int       pg_mesh_body_halved (const pg_mesh_body *body);
/* Index of the block of that name, or else of that number; -1: there is none. All names as a|b|c. */
int       pg_mesh_body_block  (const pg_mesh *mesh, const char *name);
void      pg_mesh_body_blocks (const pg_mesh *mesh, char *out, size_t size);

/* ---- families ------------------------------------------------------------------------------------------ */
/* The nodes that each of n centres sees. */
typedef pg_adjacency pg_family;
enum { PG_RADIAL, PG_TENSOR };  /* ball |x_j - c| | cube max_k |x_jk - c_k| */
/* Cloud points within `reach` of each of n centres; where the cloud has local spacings, point j is within
 * reach * size[j] / h: a node may see another that does not see it. closed: a distance of exactly reach
 * counts (to 1e-9); else not. A point at the centre is included. */
pg_status pg_family_build (pg_family *out, const pg_cloud *cloud, size_t n, const double *centre,
                           double reach, int shape, int closed);
void      pg_family_clear (pg_family *family);

/* ---- nearest point ------------------------------------------------------------------------------------- */
typedef struct pg_nearest pg_nearest;                  /* a grid over points; x is borrowed */
/* 1: this point does not count */
typedef int (*pg_refuse) (void *context, const double *place, size_t point);
pg_status pg_nearest_create (pg_nearest **out, int dim, size_t n, const double *x /* n x dim, m */);
void      pg_nearest_free   (pg_nearest **nearest);
/* The nearest point that is not refused (refuse NULL: none is); of equals the lowest number; -1: all are
 * refused. Thread-safe. */
long      pg_nearest_find   (const pg_nearest *nearest, const double *place, pg_refuse refuse, void *context);

#define PG_NO_LENGTH 1e-6  /* of the local spacing: what is no further apart is at one place */

/* ---- pre-cracks ---------------------------------------------------------------------------------------- */
enum { PG_CRACK_SEGMENT, PG_CRACK_POLYGON, PG_CRACK_DISC };
typedef struct {
    int    kind;
    double *vertex; size_t nvertex;  /* segment: 2 x 2; polygon: n x 3, planar (disc: as drawn, 64-gon) */
    double centre[3], normal[3], radius;  /* disc; normal of polygon, unit normal of segment (2D) */
    /* m: how far behind a tip or front bonds cross that are cut; of the two ends of a segment, of the edges
     * of a polygon (edge i from vertex i to the next), of a disc one; NULL: 0 */
    double *retreat;
} pg_crack;
typedef struct { int dim; pg_crack *crack; size_t n; } pg_cracks;
pg_status pg_cracks_read  (pg_cracks *out, const pg_scene *scene);
void      pg_cracks_clear (pg_cracks *cracks);
/* Does the bond x - y meet crack c, less the strip along its tips and fronts that `retreat` says (a touch
 * within `tolerance` m counts)? The answer is the same for y - x. */
int pg_crack_cuts (const pg_crack *crack, int dim, const double *x, const double *y, double tolerance);
/* x lies on the crack */
int pg_crack_touches (const pg_crack *crack, int dim, const double *x, double tolerance);
/* The same asked of several cracks: the first of them that the bond x - y meets, or that x lies on; NULL:
 * none does. */
const pg_crack *pg_cracks_cut (const pg_cracks *cracks, int dim, const double *x, const double *y,
                               double tolerance);
const pg_crack *pg_cracks_touch (const pg_cracks *cracks, int dim, const double *x, double tolerance);
PG_API_END
#endif
